//! Tables of any model: layout, accuracy, errors.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::albedo::directional_albedo;
use lumisphere_bsdf::model::Range;
use lumisphere_bsdf::{AlbedoTable, AlbedoTables, MODELS, model_named};

/// The contract of the directional albedo.
const ACCURACY: f64 = 1e-4;

fn over(name: &str, parameter: &str, size: usize) -> AlbedoTable {
    let model = model_named(name).unwrap();
    let index = model.parameters.iter().position(|p| p.name == parameter).unwrap();
    AlbedoTable::compute(model, &model.defaults(), index, size, &AlbedoTables::compute()).unwrap()
}

#[test]
fn rough_diffuse_rows_meet_the_closed_form() {
    // EON paper, equation for the single scattering of Fujii's model.
    let table = over("oren-nayar-improved", "sigma", 8);
    let pi = std::f64::consts::PI;
    for (index, texel) in table.texels().iter().enumerate() {
        let (mu, sigma) = table.texel_centre(index % 8, index / 8);
        assert_eq!((mu, sigma), (((index % 8) as f64 + 0.5) / 8.0, ((index / 8) as f64 + 0.5) / 8.0));
        let s = (1.0 - mu * mu).sqrt();
        let g = (s * (mu.acos() - s * mu) + 2.0 / 3.0 * (s / mu * (1.0 - s * s * s) - s)) / pi;
        let expected = (1.0 + sigma * g) / (1.0 + (0.5 - 2.0 / (3.0 * pi)) * sigma);
        assert!((texel.reflected[0] - expected).abs() < ACCURACY, "{mu} {sigma}: {texel:?}, expected {expected}");
        assert_eq!(texel.transmitted, [0.0; 3]);
    }
}

#[test]
fn rows_stand_for_the_whole_range() {
    let table = over("lambert", "albedo", 4);
    let first: Vec<f64> = table.texels().iter().step_by(4).map(|texel| texel.reflected[1]).collect();
    for (found, expected) in first.iter().zip([0.125, 0.375, 0.625, 0.875]) {
        assert!((found - expected).abs() < 1e-9, "{first:?}");
    }
    assert_eq!((table.size(), table.model().name, table.parameter()), (4, "lambert", 0));
}

#[test]
fn every_model_has_a_table_over_each_number() {
    let tables = AlbedoTables::compute();
    for model in MODELS {
        for (index, parameter) in model.parameters.iter().enumerate() {
            let found = AlbedoTable::compute(model, &model.defaults(), index, 2, &tables);
            let Range::Number(min, max) = parameter.range else {
                assert!(found.unwrap_err().to_string().contains(parameter.name), "{}", model.name);
                continue;
            };
            let mut values = model.defaults();
            values[index] = min + 0.75 * (max - min);
            let bsdf = model.build(&values, &tables).unwrap();
            let expected = directional_albedo(&*bsdf, [(1.0f64 - 0.0625).sqrt(), 0.0, 0.25]);
            assert_eq!(found.unwrap().texels()[2], expected, "{} {}", model.name, parameter.name);
        }
    }
}

#[test]
fn impossible_tables_are_refused() {
    let (model, tables) = (model_named("lambert").unwrap(), AlbedoTables::compute());
    for size in [0, 1 << 20] {
        assert!(
            AlbedoTable::compute(model, &[0.5], 0, size, &tables)
                .unwrap_err()
                .to_string()
                .contains("expected 1 to 4096")
        );
    }
    assert!(AlbedoTable::compute(model, &[2.0], 0, 4, &tables).is_err());
    assert!(AlbedoTable::compute(model, &[0.5], 1, 4, &tables).unwrap_err().to_string().contains("no table over 1"));
}
