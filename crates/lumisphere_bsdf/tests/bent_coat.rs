//! A clear coat with a normal of its own: energy, density and what is left where the normals are one.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::albedo::directional_albedo;
use lumisphere_bsdf::material::{BentCoat, Surface};
use lumisphere_bsdf::{AlbedoTables, Bsdf, BsdfSample, Material, PerceptualRoughness, Rgb};
use lumisphere_sphere::{Frame, Vec3};
use lumisphere_testkit::{Random, SampleCells};

/// What the material promises of a white furnace, and with a stretched lobe.
const FURNACE: f64 = 2e-3;
const STRETCHED: f64 = 6e-3;
/// The order of sums, and frames that are turned and turned back.
const ROUNDING: f64 = 1e-12;
/// Of all chi-square tests together.
const SIGNIFICANCE: f64 = 1e-3;
const TESTS: usize = 100;
const PILOT_SAMPLES: usize = 16_000;
const SAMPLES: usize = 100_000;
const CELLS: usize = 128;
/// Of the integral of a density by quadrature.
const QUADRATURE: f64 = 3e-4;
/// Standard errors of a mean.
const ERRORS: f64 = 4.0;

fn p(value: f64) -> PerceptualRoughness {
    PerceptualRoughness::new(value).unwrap()
}

fn direction(angle: f64, azimuth: f64) -> Vec3 {
    let ((s, c), (sin, cos)) = (angle.to_radians().sin_cos(), azimuth.sin_cos());
    [s * cos, s * sin, c]
}

/// Coated, white and with every layer under the coat.
fn materials() -> [Material; 5] {
    let plastic = Material {
        metallic: 0.0,
        perceptual_roughness: p(0.4),
        clearcoat: 0.8,
        clearcoat_perceptual_roughness: p(0.25),
        ..Material::default()
    };
    let metal = Material { metallic: 1.0, clearcoat: 1.0, clearcoat_perceptual_roughness: p(0.5), ..plastic };
    let brushed = Material { anisotropy: 0.7, anisotropy_rotation: 0.6, ..metal };
    let cloth = Material { sheen_color: [0.6; 3], sheen_perceptual_roughness: p(0.4), ..plastic };
    let pane = Material { transmission: 0.7, ..plastic };
    [plastic, metal, brushed, cloth, pane]
}

/// No view below is hidden from any of these coats.
fn coats() -> [Frame; 3] {
    [(3.0, 0.4), (20.0, 2.0), (32.0, -1.0)].map(|(angle, azimuth)| Frame::from_normal(direction(angle, azimuth)))
}

fn views() -> [Vec3; 3] {
    [(0.0, 0.0), (35.0, 0.7), (55.0, 3.5)].map(|(angle, azimuth)| direction(angle, azimuth))
}

/// f cos θ of both layers.
fn scattered(bent: &BentCoat, frame: &Frame, wo: Vec3, wi: Vec3) -> Rgb {
    let coat = bent.coat(wo, wi) * frame.local_from_world(wi)[2].max(0.0);
    bent.under(wo, wi).map(|f| f * wi[2].abs() + coat)
}

fn cube(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| random.unit())
}

#[test]
fn one_normal_is_the_surface() {
    let tables = AlbedoTables::compute();
    let mut random = Random::new(7);
    let z = [0.0, 0.0, 1.0];
    let turned = Frame {
        tangent: direction(90.0, 0.8),
        bitangent: direction(90.0, 0.8 + std::f64::consts::FRAC_PI_2),
        normal: z,
    };
    for (material, frame) in materials().into_iter().flat_map(|m| [(m, Frame::from_normal(z)), (m, turned)]) {
        let surface = material.surface(&tables);
        let bent = BentCoat::new(&surface, &frame);
        let near = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() <= ROUNDING * expected.abs(),
                "{found}, expected {expected}: {material:?}"
            );
        };
        for _ in 0..300 {
            let wo = direction(80.0 * random.unit(), 6.3 * random.unit());
            let wi = lumisphere_sphere::warp::UniformSphere.sample(random.square());
            let (found, expected) = (scattered(&bent, &frame, wo, wi), surface.eval(wo, wi));
            (0..3).for_each(|c| near(found[c], expected[c] * wi[2].abs()));
            near(bent.pdf(wo, wi), surface.pdf(wo, wi));
        }
    }
}

/// With the same frame the same numbers lead to the same directions.
#[test]
fn one_frame_samples_alike() {
    let tables = AlbedoTables::compute();
    let mut random = Random::new(8);
    let frame = Frame::from_normal([0.0, 0.0, 1.0]);
    for material in materials() {
        let surface = material.surface(&tables);
        let bent = BentCoat::new(&surface, &frame);
        for (wo, u) in (0..300).map(|i| (views()[i % 3], cube(&mut random))) {
            assert_eq!(bent.sample(wo, u), surface.sample(wo, u).map(|sample| sample.wi), "{material:?}");
        }
    }
}

/// One layer about its own normal, for the quadrature of albedos.
struct Layer<'a> {
    bent: BentCoat<'a>,
    surface: &'a Surface,
    /// The coat's, or the surface's own for what lies under it.
    frame: Frame,
    of: Part,
}

#[derive(Clone, Copy)]
enum Part {
    Coat,
    Under,
}

impl Bsdf for Layer<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let [wo, wi] = [wo, wi].map(|w| self.frame.world_from_local(w));
        match self.of {
            Part::Coat => [self.bent.coat(wo, wi); 3],
            Part::Under => self.bent.under(wo, wi),
        }
    }

    /// For the places of the peaks alone.
    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        self.surface.sample(wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.surface.pdf(wo, wi)
    }
}

/// What the coat takes, and only that, is taken from what is under it, about whatever normals: all light leaves.
#[test]
fn layers_keep_the_furnace() {
    let tables = AlbedoTables::compute();
    for material in materials() {
        let surface = material.surface(&tables);
        for (frame, wo) in coats().into_iter().flat_map(|f| views().map(|v| (f, v))) {
            let bent = BentCoat::new(&surface, &frame);
            let total = |frame: Frame, of: Part| {
                let layer = Layer { bent, surface: &surface, frame, of };
                directional_albedo(&layer, frame.local_from_world(wo)).total()[0]
            };
            let (coat, under) = (total(frame, Part::Coat), total(Frame::from_normal([0.0, 0.0, 1.0]), Part::Under));
            let limit = if material.anisotropy > 0.0 { STRETCHED } else { FURNACE };
            assert!((coat + under - 1.0).abs() < limit, "{coat} + {under} at {wo:?}: {frame:?}, {material:?}");
            assert!(coat > 0.02, "{coat}");

            // The mean weight of the sampler is the same.
            let mut random = Random::new(11);
            let weight = |u: [f64; 3]| {
                let wi = bent.sample(wo, u)?;
                Some(scattered(&bent, &frame, wo, wi)[0] / bent.pdf(wo, wi))
            };
            let weights: Vec<f64> = (0..20_000).map(|_| weight(cube(&mut random)).unwrap_or(0.0)).collect();
            let mean = |of: &dyn Fn(f64) -> f64| weights.iter().map(|&w| of(w)).sum::<f64>() / weights.len() as f64;
            let found = mean(&|w| w);
            let error = (mean(&|w| (w - found).powi(2)) / weights.len() as f64).sqrt();
            assert!(error < 0.01, "too noisy to tell: {error}");
            assert!(
                (found - coat - under).abs() < ERRORS * error + 1e-4,
                "{found} ± {error}, expected {coat} + {under}"
            );
        }
    }
}

#[test]
fn samples_have_their_density() {
    let tables = AlbedoTables::compute();
    let report = |surface: &Surface, [frame, stated]: [&Frame; 2], wo: Vec3| {
        let (bent, stated) = (BentCoat::new(surface, frame), BentCoat::new(surface, stated));
        let mut random = Random::new(5);
        let mut sample = || bent.sample(wo, cube(&mut random));
        let pilot: Vec<Vec3> = (0..PILOT_SAMPLES).filter_map(|_| sample()).collect();
        let cells = SampleCells::learn(&pilot, CELLS);
        cells.chi_square((0..SAMPLES).map(|_| sample()), |wi| stated.pdf(wo, wi))
    };
    for material in materials() {
        let surface = material.surface(&tables);
        for (frame, wo) in coats().into_iter().zip(views()) {
            let found = report(&surface, [&frame; 2], wo);
            assert!(found.passes(SIGNIFICANCE, TESTS), "{found:?}: {wo:?}, {frame:?}, {material:?}");
            assert!(found.pdf_integral <= 1.0 + QUADRATURE, "{found:?}");
            let lost = found.lost_samples as f64 / SAMPLES as f64;
            let spread = (lost * (1.0 - lost) / SAMPLES as f64).sqrt();
            assert!((found.pdf_integral + lost - 1.0).abs() < 5.0 * spread + QUADRATURE, "{found:?}");
        }
        // A density about the wrong normal is refused.
        let wrong = Frame::from_normal(direction(25.0, 0.4));
        assert!(!report(&surface, [&coats()[0], &wrong], views()[1]).passes(SIGNIFICANCE, TESTS), "{material:?}");
    }
}

#[test]
fn viewers_below_either_normal_see_nothing() {
    let tables = AlbedoTables::compute();
    let surface = materials()[4].surface(&tables);
    let frame = Frame::from_normal(direction(60.0, 0.0));
    let bent = BentCoat::new(&surface, &frame);
    let wi = direction(10.0, 0.0);
    for wo in [direction(60.0, std::f64::consts::PI), direction(100.0, 0.0), [1.0, 0.0, 0.0]] {
        assert_eq!((bent.coat(wo, wi), bent.under(wo, wi), bent.pdf(wo, wi)), (0.0, [0.0; 3], 0.0), "{wo:?}");
        assert_eq!(bent.sample(wo, [0.5; 3]), None);
    }
    // At the horizon of either, and with both directions one, all is finite.
    for (wo, wi) in [(direction(30.0, 0.0), direction(150.0, 0.0)), (wi, wi), (wi, [1.0, 0.0, 0.0])] {
        let values = [bent.coat(wo, wi), bent.under(wo, wi)[0], bent.pdf(wo, wi)];
        assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{values:?}");
    }
}
