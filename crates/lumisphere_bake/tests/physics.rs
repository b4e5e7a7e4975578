//! What the physics says a bake must be: closed forms, furnaces, energy, symmetry, and inputs at the edge.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use lumisphere_bake::{
    BakeError, BakeSettings, BakedEnvironment, ChainSettings, Engine, Outputs, RoughnessCurve, bake,
};
use lumisphere_bsdf::{LobeShape, LobeWeight, Masking, PerceptualRoughness, dfg::ggx_average_albedo};
use lumisphere_image::{Builtin, Environment, Rgb, resample};
use lumisphere_sh::packed::{FilamentNine, IrradianceMatrix, SevenVectors, irradiance};
use lumisphere_sphere::vector::{dot, normalize};
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use lumisphere_testkit::{constant, noise_with_sun, one_hot_texel, relative_rms_rgb};
use std::f64::consts::{FRAC_PI_2, PI};

const ENGINES: [Engine; 3] = [Engine::Spectral, Engine::MonteCarlo, Engine::Quadrature];
/// The contract's accuracy of a level.
const LEVEL_TOLERANCE: f64 = 1e-4;

fn small(size: usize, levels: usize, curve: RoughnessCurve) -> BakeSettings {
    let outputs = Outputs { dfg: false, ..Outputs::ALL };
    let chain = ChainSettings { size, level_count: Some(levels), curve, ..ChainSettings::default() };
    let mut settings =
        BakeSettings { chains: vec![chain], irradiance_size: (size / 2).max(1), outputs, ..BakeSettings::preview() };
    settings.monte_carlo.samples = 128;
    settings
}

fn baked(environment: &Environment, settings: &BakeSettings) -> BakedEnvironment {
    bake(environment.clone(), settings, &|_| ()).unwrap()
}

fn level(baked: &BakedEnvironment, lod: usize) -> &Environment {
    &baked.chains[0].levels[lod]
}

fn grid(projection: Projection, width: usize, height: usize) -> Grid {
    Grid::new(projection, width, height).unwrap()
}

fn directions(cube: &Environment) -> Vec<Vec3> {
    let (grid, n) = (cube.grid(), cube.grid().width());
    (0..6 * n * n).map(|i| grid.texel_direction(i / (n * n), i % n, i / n % n).unwrap()).collect()
}

/// Every image of a bake.
fn images(baked: &BakedEnvironment) -> Vec<&Environment> {
    let chain = baked.chains.iter().flat_map(|c| &c.levels);
    chain.chain(&baked.irradiance).chain(&baked.skybox).collect()
}

/// Two levels, the mirror and one of this p.
fn level_1_at(p: f64) -> RoughnessCurve {
    RoughnessCurve::Levels(vec![0.0, p])
}

#[test]
fn the_roughest_level_is_irradiance_over_pi() {
    // At α = 1 with v = n, D is constant: K is the clamped cosine.
    let environment = noise_with_sun(64, 32, 1, 1e4).unwrap();
    for engine in [Engine::Spectral, Engine::Quadrature] {
        let worst = |weight: LobeWeight| {
            let bake = baked(&environment, &BakeSettings { engine, weight, ..small(32, 2, level_1_at(1.0)) });
            let pairs = level(&bake, 1).texels().iter().zip(bake.irradiance.as_ref().unwrap().texels());
            pairs.map(|(l, e)| (f64::from(l[0]) * PI / f64::from(e[0]) - 1.0).abs()).fold(0.0, f64::max)
        };
        assert!(worst(LobeWeight::NDotL) < LEVEL_TOLERANCE, "{engine:?} {:e}", worst(LobeWeight::NDotL));
        // Negative control: without the cosine the level is no irradiance.
        assert!(worst(LobeWeight::None) > 0.1, "{engine:?} {}", worst(LobeWeight::None));
    }
}

#[test]
fn a_white_furnace_stays_white() {
    let shapes = [LobeShape::Ggx, LobeShape::Beckmann, LobeShape::BlinnPhong, LobeShape::Phong, LobeShape::Charlie];
    let mut failures = Vec::new();
    for engine in ENGINES {
        for lobe in shapes {
            for weight in [LobeWeight::None, LobeWeight::NDotL, LobeWeight::Full] {
                for value in [1.0_f32, 0.18] {
                    let settings = BakeSettings { engine, lobe, weight, ..small(8, 4, RoughnessCurve::Linear) };
                    failures.extend(furnace_errors(
                        &baked(&constant(16, 8, [value; 3]).unwrap(), &settings),
                        value,
                        &settings,
                    ));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}\n{}", failures.len(), failures.join("\n"));
}

/// The images that are not `value`, to 1e-4 from both sides.
fn furnace_errors(baked: &BakedEnvironment, value: f32, settings: &BakeSettings) -> Vec<String> {
    let name = format!("{:?} {:?} {:?} {value}", settings.engine, settings.lobe, settings.weight);
    let levels = settings.chains[0].levels();
    let mut failures = Vec::new();
    for (i, image) in images(baked).into_iter().enumerate() {
        let scale = f64::from(value) * if i == levels { PI } else { 1.0 };
        let ratios = image.texels().iter().flatten().map(|v| f64::from(*v) / scale);
        let (low, high) = ratios.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)));
        if !(low >= 1.0 - LEVEL_TOLERANCE && high <= 1.0 + LEVEL_TOLERANCE) {
            failures.push(format!("{name} image {i}: 1 {:+.1e} {:+.1e}", low - 1.0, high - 1.0));
        }
    }
    let l00 = baked.sh.values()[0][0] / (4.0 * PI).sqrt() / f64::from(value);
    if (l00 - 1.0).abs() > LEVEL_TOLERANCE {
        failures.push(format!("{name} L00: {l00}"));
    }
    failures
}

#[test]
fn furnaces_of_any_size_stay_white() {
    let mut failures = Vec::new();
    for (width, height) in [(1, 1), (2, 1), (3, 2), (8, 4), (17, 9), (32, 16), (64, 32), (128, 64)] {
        let settings = BakeSettings { irradiance_size: 16, ..small(16, 5, RoughnessCurve::Linear) };
        let bake = baked(&constant(width, height, [1.0; 3]).unwrap(), &settings);
        let errors = furnace_errors(&bake, 1.0, &settings);
        failures.extend(errors.into_iter().map(|e| format!("{width}x{height} {e}")));
    }
    assert!(failures.is_empty(), "{}\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn harmonics_of_a_furnace_are_one_constant() {
    let sh = baked(&constant(512, 256, [0.18; 3]).unwrap(), &small(8, 2, RoughnessCurve::Linear)).sh;
    for (i, v) in sh.values().iter().enumerate() {
        let expected = if i == 0 { f64::from(0.18_f32) * (4.0 * PI).sqrt() } else { 0.0 };
        assert!((v[1] - expected).abs() < LEVEL_TOLERANCE * 0.18, "{i} {v:?}");
    }
}

#[test]
fn multiple_scattering_closes_the_albedo() {
    // Kulla and Conty (SIGGRAPH course 2017): (1 - E(v)) (1 - E(l)) / (π (1 - E_avg)) adds what the first bounce loses.
    const SIZE: usize = 128;
    let mut settings = BakeSettings { dfg_size: SIZE, ..small(8, 2, RoughnessCurve::Linear) };
    settings.outputs.dfg = true;
    let table = baked(&constant(8, 4, [1.0; 3]).unwrap(), &settings).dfg.unwrap();
    assert_eq!((table.size(), table.masking()), (SIZE, Masking::SmithGgxCorrelated));
    for row in (SIZE / 4..SIZE).step_by(5) {
        let (_, p) = table.texel_centre(0, row);
        let albedo: Vec<f64> =
            table.texels()[row * SIZE..(row + 1) * SIZE].iter().map(|t| f64::from(t[0] + t[1])).collect();
        // 2 ∫ (1 - E(l)) l dl by the midpoint rule over the table's own columns.
        let centre = |x: usize| (x as f64 + 0.5) / SIZE as f64;
        let lost: f64 = (0..SIZE).map(|x| 2.0 * (1.0 - albedo[x]) * centre(x) / SIZE as f64).sum();
        let share = lost / (1.0 - ggx_average_albedo(p.to_alpha(), Masking::SmithGgxCorrelated));
        for (x, e) in albedo.iter().enumerate() {
            let closed = e + (1.0 - e) * share;
            assert!((closed - 1.0).abs() < LEVEL_TOLERANCE, "p {} n·v {} {closed}", p.value(), centre(x));
            assert!(*e <= 1.0 + LEVEL_TOLERANCE);
        }
    }
    // Without the second term the furnace is open (NUMBERS: E(1) = 1 - ln 2 at α = 1).
    let last = table.texels()[SIZE * SIZE - 1];
    assert!((f64::from(last[0] + last[1]) - (1.0 - 2.0_f64.ln())).abs() < 0.01);
}

/// A polynomial of degree 3, positive: a cube's texels integrate it exactly, for no harmonic of degree 1 to 3 has the
/// symmetry of the cube.
fn cubic([x, y, z]: Vec3) -> Rgb {
    [1.0 + 0.4 * x + 0.3 * y * z, 1.2 + 0.3 * x * y * z - 0.3 * z, 1.0 + 0.4 * (y * y - 1.0 / 3.0) + 0.2 * x * z]
        .map(|v| v as f32)
}

#[test]
fn every_level_holds_the_light_of_the_environment() {
    let environment = Environment::from_fn(grid(Projection::LatLong, 256, 128), cubic);
    let mean = environment.mean();
    let turned = Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9);
    for engine in ENGINES {
        let levels = if engine == Engine::Quadrature {
            RoughnessCurve::Levels(vec![0.0, 0.7, 0.8, 0.9])
        } else {
            RoughnessCurve::Linear
        };
        let settings = BakeSettings { engine, rotation: turned, ..small(16, 4, levels) };
        let bake = baked(&environment, &settings);
        for (lod, image) in images(&bake).into_iter().enumerate() {
            let scale = if lod == 4 { PI } else { 1.0 };
            // What the texels' steps add at degree 4 is of order h², 6e-4, times the cube's error there, below 1e-2 of it.
            // Monte Carlo has 128 samples in another frame at each texel.
            let tolerance = if engine == Engine::MonteCarlo { 2e-3 } else { 2e-5 };
            for c in 0..3 {
                let ratio = image.mean()[c] / (scale * mean[c]);
                assert!((ratio - 1.0).abs() < tolerance, "{engine:?} image {lod}: {ratio}");
            }
        }
    }
}

#[test]
fn the_light_of_one_texel_is_whole_in_every_level() {
    // Negative and positive at once: the mean of each level is the light over 4π. Levels are sampled at texel centres:
    // the narrowest lobe, α = 0.25, is 0.5 wide, 20 texels of a 64² face; the midpoint error is below 1e-3.
    let environment = Builtin::OneTexel.render(64);
    for p in [level_1_at(1.0), level_1_at(0.5), level_1_at(0.7)] {
        let bake = baked(&environment, &small(128, 2, p));
        let light = level(&bake, 1).mean()[0] * 4.0 * PI;
        assert!((light - 1.0).abs() < 1e-3, "{light}");
        // Energy of level 0: contract.
        assert!((level(&bake, 0).mean()[0] * 4.0 * PI - 1.0).abs() < 1e-3);
    }
}

#[test]
fn irradiance_of_one_texel_is_a_clamped_cosine() {
    // E = Ω L max(cos θ, 0), peak Ω L.
    const TOLERANCE: f64 = 1e-5;
    let (width, height, x, y) = (1024, 512, 391, 180);
    let environment = one_hot_texel(width, height, x, y, [3e4; 3]).unwrap();
    let lat_long = environment.grid();
    let peak = lat_long.texel_solid_angle(0, x, y) * 3e4;
    let sun = lat_long.texel_direction(0, x, y).unwrap();
    let mut settings = small(32, 2, level_1_at(1.0));
    settings.chains.clear();
    let irradiance = baked(&environment, &settings).irradiance.unwrap();
    let mut worst = [0.0_f64; 2];
    for (d, e) in directions(&irradiance).into_iter().zip(irradiance.texels()) {
        let expected = dot(d, sun).max(0.0);
        let error = (f64::from(e[2]) / peak - expected).abs();
        worst[usize::from(expected > 0.0)] = worst[usize::from(expected > 0.0)].max(error);
    }
    println!("behind {:.1e}, before {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < TOLERANCE && worst[1] < TOLERANCE, "behind {:e}, before {:e}", worst[0], worst[1]);
}

#[test]
fn harmonics_of_one_texel_light_as_the_published_polynomial() {
    // Unit irradiance from x = n·l: 3/32 + x/2 + 15 x²/32. The texel's radiance is f32: 6e-8. 256 rows are not cut finer.
    let environment = Builtin::OneTexel.render(256);
    let at = environment.texels().iter().position(|t| t[0] > 0.0).unwrap();
    let sun = environment.grid().texel_direction(0, at % 512, at / 512).unwrap();
    let rotation = Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9);
    let mut settings = BakeSettings { rotation, ..small(8, 1, RoughnessCurve::Linear) };
    settings.outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    let sh = baked(&environment, &settings).sh;
    let sun = rotation.apply(sun);
    let probe = baked(&constant(4, 2, [1.0; 3]).unwrap(), &small(4, 1, RoughnessCurve::Linear)).skybox.unwrap();
    for n in directions(&probe).into_iter().chain([sun, sun.map(|v| -v)]) {
        let x = dot(n, sun);
        let expected = 3.0 / 32.0 + x / 2.0 + 15.0 * x * x / 32.0;
        let found = [
            irradiance(&sh).evaluate(n)[0],
            IrradianceMatrix::from_radiance(&sh).evaluate(n)[0],
            SevenVectors::from_radiance(&sh).evaluate(n)[0] * PI,
            FilamentNine::from_radiance(&sh).evaluate(n)[0] * PI,
        ];
        for f in found {
            assert!((f - expected).abs() < 1e-6, "x {x}: {found:?} for {expected}");
        }
    }
    let peak = irradiance(&sh).evaluate(sun)[0];
    assert!((peak - 1.0625).abs() < 1e-6, "{peak}");
}

/// Smooth, no symmetry, slopes below 0.1: a grid of 512 rows steps by 6e-3 radians, so its texels stand within 3e-4 of it.
fn gentle([x, y, z]: Vec3) -> Rgb {
    [1.0 + 0.06 * x + 0.03 * y * z, 1.0 + 0.05 * z - 0.04 * x * y, 1.0 - 0.05 * y + 0.04 * (1.5 * x).sin()]
        .map(|v| v as f32)
}

#[test]
fn turning_the_settings_turns_the_environment() {
    let lat_long = grid(Projection::LatLong, 1024, 512);
    let environment = Environment::from_fn(lat_long, gentle);
    // α = 0.0081 is split, the next levels are not.
    let curve = RoughnessCurve::Levels(vec![0.0, 0.09, 0.3, 0.8]);
    for rotation in
        [Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9), Rotation::from_axis_angle([1.0, 0.0, 0.0], FRAC_PI_2)]
    {
        let back = rotation.inverse();
        let turned = baked(&Environment::from_fn(lat_long, |d| gentle(back.apply(d))), &small(32, 4, curve.clone()));
        let found = baked(&environment, &BakeSettings { rotation, ..small(32, 4, curve.clone()) });
        let wrong = baked(&environment, &BakeSettings { rotation: back, ..small(32, 4, curve.clone()) });
        for (i, image) in images(&turned).into_iter().enumerate() {
            let error = relative_rms_rgb(images(&found)[i].texels(), image.texels());
            println!("image {i} {error:.1e}");
            assert!(error < 1e-4, "image {i} {error:e}");
            // Negative control: the inverse.
            assert!(relative_rms_rgb(images(&wrong)[i].texels(), image.texels()) > 3e-3, "image {i}");
        }
        for (a, b) in found.sh.values().iter().flatten().zip(turned.sh.values().iter().flatten()) {
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
    }
}

#[test]
fn turning_by_whole_columns_moves_the_columns() {
    // About +Y by k columns the texels themselves move: nothing but rounding is left, noise, sun, split level and all.
    let (width, height, k) = (128, 64, 37);
    let environment = noise_with_sun(width, height, 3, 1e3).unwrap();
    // Right-handed about +Y takes +Z to +X: towards the left of the picture, whose centre is +X and whose +Z lies right.
    let rotation = Rotation::from_axis_angle([0.0, 1.0, 0.0], 2.0 * PI * k as f64 / width as f64);
    let moved: Vec<Rgb> =
        (0..width * height).map(|i| environment.texel(0, (i % width + k) % width, i / width)).collect();
    let moved = Environment::new(environment.grid(), moved).unwrap();
    let settings = small(16, 3, RoughnessCurve::Levels(vec![0.0, 0.09, 0.4]));
    let (found, expected) =
        (baked(&environment, &BakeSettings { rotation, ..settings.clone() }), baked(&moved, &settings));
    for (i, image) in images(&expected).into_iter().enumerate() {
        let error = relative_rms_rgb(images(&found)[i].texels(), image.texels());
        println!("image {i} {error:.1e}");
        // A turned cube is interpolated on another grid: the split level to 3e-4, the rest to 2e-5.
        assert!(error < if i == 1 { 3e-4 } else { 4e-5 }, "image {i} {error:e}");
    }
}

#[test]
fn twice_the_light_is_twice_the_bake() {
    let environment = noise_with_sun(64, 32, 4, 1e4).unwrap();
    let mut twice = environment.clone();
    twice.texels_mut().iter_mut().flatten().for_each(|v| *v *= 2.0);
    for engine in ENGINES {
        let settings = BakeSettings { engine, ..small(8, 4, RoughnessCurve::Linear) };
        let (one, two) = (baked(&environment, &settings), baked(&twice, &settings));
        for (a, b) in images(&one).into_iter().zip(images(&two)) {
            // Doubling is exact in floating point.
            assert!(a.texels().iter().flatten().zip(b.texels().iter().flatten()).all(|(a, b)| 2.0 * a == *b));
        }
        assert_eq!(one.sh.scale(2.0), two.sh);
    }
}

#[test]
fn lights_add_up() {
    let (a, b) = (noise_with_sun(64, 32, 5, 1e4).unwrap(), Builtin::Studio.render(32));
    let sum = a.texels().iter().zip(b.texels()).map(|(a, b)| std::array::from_fn(|c| a[c] + b[c])).collect();
    let sum = Environment::new(a.grid(), sum).unwrap();
    let settings = small(16, 5, RoughnessCurve::Linear);
    let [a, b, sum] = [a, b, sum].map(|e| baked(&e, &settings));
    for (i, image) in images(&sum).into_iter().enumerate() {
        let parts = images(&a)[i].texels().iter().zip(images(&b)[i].texels());
        let parts: Vec<Rgb> = parts.map(|(a, b)| std::array::from_fn(|c| a[c] + b[c])).collect();
        // Which texels count as suns differs: each way is within the band's 2e-5, times two.
        let error = relative_rms_rgb(image.texels(), &parts);
        assert!(error < LEVEL_TOLERANCE, "image {i} {error:e}");
    }
}

#[test]
fn any_projection_bakes_to_the_same() {
    let settings = small(16, 4, RoughnessCurve::Linear);
    let expected = baked(&Environment::from_fn(grid(Projection::LatLong, 256, 128), cubic), &settings);
    for from in [
        grid(Projection::AngularMap, 160, 160),
        grid(Projection::Cube, 64, 64),
        grid(Projection::Octahedral, 128, 128),
        grid(Projection::MirrorBall, 160, 160),
        grid(Projection::DualParaboloid, 256, 128),
        grid(Projection::HorizontalCross, 256, 192),
        grid(Projection::VerticalCross, 192, 256),
    ] {
        let found = baked(&Environment::from_fn(from, cubic), &settings);
        for (i, image) in images(&expected).into_iter().enumerate() {
            let error = relative_rms_rgb(images(&found)[i].texels(), image.texels());
            println!("{:?} image {i} {error:.1e}", from.projection());
            // Texels hold the value at their centre: h²/24 times curvature, 1e-4 at h = 0.03. Level 0 and the skybox
            // see the steps themselves where a texel's edge cuts them: h/2 times a slope of 0.5, over 10 texels.
            let blurred = (1..=4).contains(&i);
            assert!(error < if blurred { 5e-4 } else { 3e-3 }, "{from:?} image {i} {error:e}");
        }
    }
}

#[test]
fn tiny_environments_and_sizes_bake() {
    let sources = [
        (Projection::LatLong, 1, 1),
        (Projection::LatLong, 2, 1),
        (Projection::LatLong, 1, 2),
        (Projection::LatLong, 3, 2),
        (Projection::LatLong, 5, 3),
        (Projection::Cube, 1, 1),
        (Projection::Octahedral, 2, 2),
        (Projection::AngularMap, 2, 2),
        (Projection::HorizontalCross, 4, 3),
    ];
    for (projection, width, height) in sources {
        let environment = Environment::from_fn(grid(projection, width, height), cubic);
        for engine in ENGINES {
            for size in [1, 2, 8] {
                let levels = (size as f64).log2() as usize + 1;
                let settings = BakeSettings { engine, ..small(size, levels, RoughnessCurve::Linear) };
                let bake = baked(&environment, &settings);
                assert_eq!(bake.chains[0].levels.len(), levels);
                for (i, image) in images(&bake).into_iter().enumerate() {
                    // Means of values between 0.5 and 1.7, irradiance up to 1.7 π.
                    let inside = |v: &f32| (0.4..6.0).contains(v);
                    let all = image.texels().iter().flatten().all(inside);
                    assert!(
                        all,
                        "{projection:?} {width}x{height} {engine:?} size {size} image {i}: {:?}",
                        image.texels()
                    );
                }
                assert!(bake.sh.values().iter().flatten().all(|v| v.is_finite()));
            }
        }
    }
}

#[test]
fn whole_sphere_texels_bake_to_their_constant() {
    let mut failures = Vec::new();
    for projection in [Projection::LatLong, Projection::Octahedral, Projection::AngularMap, Projection::MirrorBall] {
        let environment = Environment::filled(grid(projection, 1, 1), [0.5; 3]);
        let bake = baked(&environment, &small(4, 3, RoughnessCurve::Linear));
        for (lod, tolerance) in [(0, 1e-6), (1, LEVEL_TOLERANCE)] {
            let worst =
                level(&bake, lod).texels().iter().flatten().map(|v| f64::from(v / 0.5 - 1.0).abs()).fold(0.0, f64::max);
            if worst > tolerance {
                failures.push(format!("{projection:?} level {lod} off by {worst:.1e}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn black_stays_black() {
    for engine in ENGINES {
        for (w, h) in [(64, 32), (1, 1)] {
            let settings = BakeSettings { engine, ..small(8, 4, RoughnessCurve::Quadratic) };
            let bake = baked(&constant(w, h, [0.0; 3]).unwrap(), &settings);
            for image in images(&bake) {
                assert!(image.texels().iter().flatten().all(|v| *v == 0.0), "{engine:?}");
            }
            assert!(bake.sh.values().iter().flatten().all(|v| *v == 0.0));
        }
    }
}

#[test]
fn texels_that_are_no_radiance_are_refused() {
    for bad in [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -f32::MIN_POSITIVE] {
        for projection in [Projection::LatLong, Projection::Cube] {
            let lat_long = projection == Projection::LatLong;
            let mut environment = Environment::filled(grid(projection, if lat_long { 16 } else { 8 }, 8), [1.0; 3]);
            environment.texels_mut()[5][2] = bad;
            environment.texels_mut()[9] = [bad; 3];
            let error = bake(environment, &small(8, 2, level_1_at(1.0)), &|_| ()).unwrap_err();
            assert_eq!(error, BakeError::Unclean { count: 2 });
            assert_eq!(error.to_string(), "the environment has 2 texels that are negative or not finite");
        }
    }
}

#[test]
fn settings_out_of_range_are_refused_with_what_was_found_and_expected() {
    type Change = fn(&mut BakeSettings);
    let cases: [(Change, &str, &str); 14] = [
        (|s| s.chains[0].size = 0, "size", "0"),
        (|s| s.chains[0].size = 48, "size", "48"),
        (|s| s.chains[0].size = 16384, "size", "16384"),
        (|s| s.irradiance_size = 0, "irradiance size", "0"),
        (|s| s.skybox_size = Some(9000), "skybox size", "9000"),
        (|s| s.dfg_size = 0, "DFG size", "0"),
        (|s| s.chains[0].level_count = Some(0), "level count", "0"),
        (|s| s.chains[0].level_count = Some(5), "level count", "5"),
        (|s| s.sh_bands = 0, "SH band count", "0"),
        (|s| s.sh_bands = 33, "SH band count", "33"),
        (|s| s.lobe = LobeShape::Cosine, "lobe", "cosine"),
        (|s| s.monte_carlo.samples = 0, "sample count", "0"),
        (|s| s.monte_carlo.locality = 1.5, "locality", "1.5"),
        (|s| s.monte_carlo.locality = f64::NAN, "locality", "NaN"),
    ];
    for (change, name, found) in cases {
        let mut settings = small(8, 2, level_1_at(1.0));
        change(&mut settings);
        let error = bake(constant(8, 4, [1.0; 3]).unwrap(), &settings, &|_| ()).unwrap_err();
        let BakeError::Setting { name: named, found: said, expected } = &error else { panic!("{error}") };
        assert_eq!((*named, said.as_str()), (name, found));
        let text = error.to_string();
        assert!(
            text.contains(name) && text.contains(found) && text.contains(expected) && !expected.is_empty(),
            "{text}"
        );
    }
}

#[test]
fn a_single_level_is_the_resampled_picture() {
    let environment = noise_with_sun(32, 16, 6, 100.0).unwrap();
    let rotation = Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9);
    let bake = baked(&environment, &BakeSettings { rotation, ..small(8, 1, RoughnessCurve::Linear) });
    let expected = resample(&environment, grid(Projection::Cube, 8, 8), &rotation);
    assert_eq!(level(&bake, 0), &expected);
    assert_eq!(bake.skybox.as_ref(), Some(&expected));
    assert_eq!(bake.chains[0].roughness, [PerceptualRoughness::clamped(0.0)]);
    // The texel towards a direction R s holds the light from s.
    let sun = normalize(environment.grid().texel_direction(0, 20, 4).unwrap());
    let at = expected.grid().position(rotation.apply(sun));
    let brightest = expected.texels().iter().enumerate().max_by(|a, b| a.1[0].total_cmp(&b.1[0])).unwrap().0;
    let apart = directions(&expected)[brightest];
    assert!(dot(apart, rotation.apply(sun)) > 0.95, "{at:?} {apart:?}");
}
