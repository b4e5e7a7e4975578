//! Every warp of lumisphere_sphere against its density, and a wrong density of each as the negative control.

use lumisphere_sphere::warp::{BeckmannNormals, CosineHemisphere, GgxNormals, UniformHemisphere, UniformSphere};
use lumisphere_testkit::{ChiSquareSettings, chi_square};

/// Of all tests of this file together.
const SIGNIFICANCE: f64 = 0.01;
const ALPHAS: [f64; 5] = [0.05, 0.1, 0.3, 0.6, 1.0];
const TESTS: usize = 3 + 2 * ALPHAS.len();

#[test]
fn uniform_and_cosine_warps_have_their_densities() {
    let settings = ChiSquareSettings::standard(11);
    let reports = [
        chi_square(|u| Some(UniformSphere.sample(u)), |d| UniformSphere.pdf(d), &settings),
        chi_square(|u| Some(UniformHemisphere.sample(u)), |d| UniformHemisphere.pdf(d), &settings),
        chi_square(|u| Some(CosineHemisphere.sample(u)), |d| CosineHemisphere.pdf(d), &settings),
    ];
    for report in reports {
        assert!(report.passes(SIGNIFICANCE, TESTS), "{report:?}");
    }
}

#[test]
fn half_vector_warps_have_their_densities() {
    for (seed, alpha) in ALPHAS.into_iter().enumerate() {
        let settings = ChiSquareSettings::narrow(seed as u64, 0.5 * alpha);
        let (ggx, beckmann) = (GgxNormals { alpha }, BeckmannNormals { alpha });
        let reports = [
            chi_square(|u| Some(ggx.sample(u)), |d| ggx.pdf(d), &settings),
            chi_square(|u| Some(beckmann.sample(u)), |d| beckmann.pdf(d), &settings),
        ];
        for report in reports {
            assert!(report.passes(SIGNIFICANCE, TESTS), "alpha {alpha}: {report:?}");
            assert!((report.pdf_integral - 1.0).abs() < 1e-7, "alpha {alpha}: {report:?}");
            assert!(report.degrees_of_freedom > 200, "the cells must resolve the lobe: {report:?}");
        }
    }
}

#[test]
fn wrong_densities_are_rejected() {
    for (seed, alpha) in ALPHAS.into_iter().enumerate() {
        let settings = ChiSquareSettings::narrow(seed as u64, 0.5 * alpha);
        let (ggx, beckmann) = (GgxNormals { alpha }, BeckmannNormals { alpha });
        let wrong_alpha = GgxNormals { alpha: 1.02 * alpha };
        // A width 2 % off, and the neighbouring model.
        assert!(!chi_square(|u| Some(ggx.sample(u)), |d| wrong_alpha.pdf(d), &settings).passes(SIGNIFICANCE, TESTS));
        assert!(!chi_square(|u| Some(beckmann.sample(u)), |d| ggx.pdf(d), &settings).passes(SIGNIFICANCE, TESTS));
    }
}
