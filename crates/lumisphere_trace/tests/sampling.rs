//! Light asked at the lights, met from the surfaces, or both: one mean.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::{Material, PerceptualRoughness};
use lumisphere_scene::SceneMaterial;
use lumisphere_testkit::noise_with_sun;
use lumisphere_trace::{LightPaths, LightSampling, TraceSettings, World};
use worlds::*;

/// Of the difference of two estimates, in its standard errors.
const ERRORS: f64 = 4.0;

#[test]
fn all_ways_have_the_same_mean() {
    let tables = tables();
    let glossy = Material {
        base_color: [0.9, 0.6, 0.3],
        perceptual_roughness: PerceptualRoughness::clamped(0.35),
        ..Material::default()
    };
    for (name, material, sun) in [("Lambert", matt(0.7), 2e2), ("glossy", glossy, 10.0)] {
        let scene = scene(vec![ground()], SceneMaterial::plain(name, material));
        let sky = environment(noise_with_sun(64, 32, 3, sun).unwrap());
        let world = World::new(&scene, Some(sky), &tables).unwrap();
        let camera = spot_camera([2.0, 2.0, 1.0], [0.0; 3]);
        let by = |sampling, samples| {
            let settings = TraceSettings { light_paths: LightPaths::Environment, ..independent(samples) };
            estimate(&world, &camera, 16, with_sampling(settings, sampling))
        };
        let both = by(LightSampling::Combined, 256);
        for other in [LightSampling::Lights, LightSampling::Surfaces] {
            let one = by(other, 256);
            for c in 0..3 {
                let error = both.error[c].hypot(one.error[c]);
                let ratio = (one.error[c] / both.error[c]).powi(2);
                let difference = one.mean[c] - both.mean[c];
                let found = format!(
                    "{name}, {other:?}, channel {c}: {} ± {}, combined {} ± {}, {ratio:.1} times its variance",
                    one.mean[c], one.error[c], both.mean[c], both.error[c]
                );
                assert!(error < 0.05 * both.mean[c], "too noisy to tell: {found}");
                assert!(difference.abs() < ERRORS * error, "{found}");
                // The power heuristic is at worst a few times worse than the better one (Veach 1997, theorem 9.2).
                assert!(ratio > 0.25, "{found}");
            }
        }
    }
}
