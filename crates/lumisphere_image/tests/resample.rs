//! What area-exact resampling promises: constants, energy, sign, linear functions, the sense of rotation, threads.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use lumisphere_image::{Environment, Rgb, resample, sample_nearest};
use lumisphere_sphere::Projection::{
    AngularMap, Cube, DualParaboloid, HorizontalCross, LatLong, MirrorBall, Octahedral, VerticalCross,
};
use lumisphere_sphere::vector::{add, angle_between, cross, dot, normalize, scale};
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The contract for the light of one texel.
const ENERGY_TOLERANCE: f64 = 1e-3;

fn grid(projection: Projection, width: usize, height: usize) -> Grid {
    Grid::new(projection, width, height).unwrap()
}

/// Every projection at two sizes, one of them odd in each cell or disc.
fn grids() -> Vec<Grid> {
    [
        (LatLong, 7, 5),
        (LatLong, 16, 8),
        (Cube, 5, 5),
        (Cube, 8, 8),
        (Octahedral, 7, 7),
        (Octahedral, 12, 12),
        (DualParaboloid, 10, 5),
        (DualParaboloid, 16, 8),
        (AngularMap, 9, 9),
        (AngularMap, 16, 16),
        (MirrorBall, 11, 11),
        (MirrorBall, 16, 16),
        (HorizontalCross, 12, 9),
        (HorizontalCross, 16, 12),
        (VerticalCross, 15, 20),
        (VerticalCross, 12, 16),
    ]
    .map(|(p, w, h)| grid(p, w, h))
    .to_vec()
}

fn rotations() -> [Rotation; 3] {
    [
        Rotation::IDENTITY,
        Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9),
        Rotation::from_axis_angle([1.0, 0.0, 0.0], FRAC_PI_2),
    ]
}

/// (face, x, y) of every texel, in memory order.
fn places(grid: Grid) -> impl Iterator<Item = (usize, usize, usize)> {
    let (w, h) = (grid.width(), grid.height());
    (0..grid.texel_count()).map(move |i| (i / (w * h), i % w, i / w % h))
}

/// Σ radiance times exact solid angle, of the first channel.
fn energy(environment: &Environment) -> f64 {
    let grid = environment.grid();
    places(grid).map(|(f, x, y)| f64::from(environment.texel(f, x, y)[0]) * grid.texel_solid_angle(f, x, y)).sum()
}

/// Black but for one texel of 1e4.
fn one_texel(grid: Grid, place: (usize, usize, usize)) -> Environment {
    let texels = places(grid).map(|p| if p == place { [1e4; 3] } else { [0.0; 3] }).collect();
    Environment::new(grid, texels).unwrap()
}

/// The texel that a direction falls into.
fn texel_towards(grid: Grid, direction: Vec3) -> (usize, usize, usize) {
    let at = grid.position(direction);
    (at.face, (at.x as usize).min(grid.width() - 1), (at.y as usize).min(grid.height() - 1))
}

/// Texels at both poles, on the seam, at a cube's corners and edges and in the open.
fn hot_texels(grid: Grid) -> Vec<(usize, usize, usize)> {
    let directions = [
        [0.013, 1.0, 0.007],
        [-0.011, -1.0, 0.017],
        [-1.0, 0.02, 1e-6],
        [-1.0, -0.3, -1e-6],
        [1.0, 0.999, 0.998],
        [-0.998, -1.0, 0.999],
        [0.999, -1.0, -0.3],
        [0.48, 0.59, -0.65],
        [0.02, -0.013, 1.0],
    ];
    let mut texels: Vec<_> = directions.map(|d| texel_towards(grid, normalize(d))).to_vec();
    texels.sort_unstable();
    texels.dedup();
    texels.retain(|&(f, x, y)| grid.texel_solid_angle(f, x, y) > 0.0);
    texels
}

/// The pairs of the energy tests: the lat-long and the cube against everything, and two that pass through a hub.
fn energy_pairs() -> Vec<(Grid, Grid)> {
    let mut pairs = Vec::new();
    for other in grids() {
        for hub in [grid(LatLong, 32, 16), grid(Cube, 8, 8)] {
            pairs.extend([(hub, other), (other, hub)]);
        }
    }
    pairs.push((grid(AngularMap, 16, 16), grid(Octahedral, 12, 12)));
    pairs.push((grid(Octahedral, 7, 7), grid(MirrorBall, 16, 16)));
    pairs.retain(|(a, b)| a != b);
    pairs
}

/// Calls `check(source, target grid, rotation, place)` for every case of the energy tests.
fn for_each_hot_texel(mut check: impl FnMut(&Environment, Grid, &Rotation, (usize, usize, usize))) {
    for (from, to) in energy_pairs() {
        for place in hot_texels(from) {
            let source = one_texel(from, place);
            for rotation in rotations() {
                check(&source, to, &rotation, place);
            }
        }
    }
}

#[test]
fn constant_stays_constant() {
    // Every weight is multiplied by 1 and the sum divided by the same sum: not even rounding is left.
    let mut failures = Vec::new();
    for from in grids() {
        let source = Environment::from_fn(from, |_| [1.0, 1.0, 0.0]);
        for to in grids() {
            for rotation in rotations() {
                let target = resample(&source, to, &rotation);
                let wrong = places(to)
                    .filter(|&(f, x, y)| {
                        let inside = to.texel_solid_angle(f, x, y) > 0.0;
                        target.texel(f, x, y) != if inside { [1.0, 1.0, 0.0] } else { [0.0; 3] }
                    })
                    .count();
                if wrong > 0 {
                    let first = places(to)
                        .map(|(f, x, y)| (f, x, y, to.texel_solid_angle(f, x, y), target.texel(f, x, y)))
                        .find(|t| t.4 != if t.3 > 0.0 { [1.0, 1.0, 0.0] } else { [0.0; 3] });
                    failures.push(format!("{from:?} -> {to:?} {rotation:?}: {wrong} texels, {first:?}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} pairs\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn one_texel_keeps_its_energy() {
    let mut worst = (0.0, String::new());
    let mut cases = 0;
    for_each_hot_texel(|source, to, rotation, place| {
        cases += 1;
        let error = (energy(&resample(source, to, rotation)) / energy(source) - 1.0).abs();
        if !error.is_finite() || error > worst.0 {
            worst = (error, format!("{:?} {place:?} -> {to:?} {rotation:?}", source.grid()));
        }
    });
    println!("{cases} cases, worst energy error {:.2e}: {}", worst.0, worst.1);
    assert!(worst.0 <= ENERGY_TOLERANCE, "{:.3e} for {}", worst.0, worst.1);
}

#[test]
fn nothing_turns_negative() {
    let mut worst = (0.0_f32, String::new());
    for_each_hot_texel(|source, to, rotation, place| {
        let least = resample(source, to, rotation).texels().iter().map(|t| t[0]).fold(0.0, f32::min);
        if least < worst.0 || least.is_nan() {
            worst = (least, format!("{:?} {place:?} -> {to:?} {rotation:?}", source.grid()));
        }
    });
    assert!(worst.0 >= 0.0, "{:e} of a light of 1e4 for {}", worst.0, worst.1);
}

#[test]
fn the_nearest_texel_does_not_keep_energy() {
    // Negative control of `one_texel_keeps_its_energy`: the same cases, texels read at target centres.
    let (mut cases, mut failed) = (0, 0);
    for_each_hot_texel(|source, to, rotation, _| {
        let back = rotation.inverse();
        let nearest = Environment::from_fn(to, |d| sample_nearest(source, back.apply(d)));
        cases += 1;
        failed += usize::from((energy(&nearest) / energy(source) - 1.0).abs() > ENERGY_TOLERANCE);
    });
    // Some texels coincide with a target texel; nearly all do not.
    assert!(failed * 10 > cases * 8, "{failed} of {cases}");
}

/// ∫ ω dω over a polygon of great circles: ½ Σ θ n over its sides, θ the side and n its plane's normal
/// (J. H. Lambert 1760; J. Arvo, "Applications of Irradiance Tensors", SIGGRAPH 1995).
fn direction_integral(outline: &[Vec3]) -> Vec3 {
    let mut sum = [0.0; 3];
    for i in 0..outline.len() {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        let normal = cross(a, b);
        if dot(normal, normal) > 1e-24 {
            sum = add(sum, scale(normalize(normal), 0.5 * angle_between(a, b)));
        }
    }
    sum
}

/// Each lat-long texel holds the mean of 2 + d over it, in closed form.
fn linear_source(height: usize) -> Environment {
    let grid = grid(LatLong, 2 * height, height);
    let step = PI / height as f64;
    let texels = places(grid).map(|(_, x, y)| {
        let (top, bottom) = (step * y as f64, step * (y as f64 + 1.0));
        let (left, right) = (step * x as f64 - PI, step * (x as f64 + 1.0) - PI);
        let sin_squared = 0.5 * (bottom - top) - 0.25 * ((2.0 * bottom).sin() - (2.0 * top).sin());
        let integral = [
            sin_squared * (right.sin() - left.sin()),
            0.5 * (bottom.sin().powi(2) - top.sin().powi(2)) * step,
            sin_squared * (left.cos() - right.cos()),
        ];
        integral.map(|v| (2.0 + v / grid.texel_solid_angle(0, x, y)) as f32)
    });
    Environment::new(grid, texels.collect()).unwrap()
}

/// Worst difference between a target texel and the mean of 2 + R⁻¹ d over its outline.
fn linear_error(source: &Environment, to: Grid, rotation: &Rotation) -> f64 {
    let target = resample(source, to, rotation);
    let back = rotation.inverse();
    let mut worst = 0.0_f64;
    for (f, x, y) in places(to).filter(|&(f, x, y)| to.texel_solid_angle(f, x, y) > 0.0) {
        let integral = direction_integral(&to.texel_outline(f, x, y, 1e-3));
        let mean = back.apply(scale(integral, 1.0 / to.texel_solid_angle(f, x, y)));
        let found = target.texel(f, x, y).map(f64::from);
        worst = (0..3).map(|c| (found[c] - 2.0 - mean[c]).abs()).fold(worst, f64::max);
    }
    worst
}

#[test]
fn a_linear_function_stays_linear() {
    // Source texels wholly inside a target texel carry their exact mean. Those the outline cuts are off by at most half
    // their size h times the slope 1, with signs that alternate along it; they are 4 h/H of a target texel of size H.
    // The outline's own error (1e-3 texels) moves the mean by at most that share of H.
    let sources = [linear_source(32), linear_source(256)];
    let mut failures = Vec::new();
    for to in grids().into_iter().filter(|g| g.projection() != LatLong) {
        for (turn, rotation) in rotations().iter().enumerate() {
            let size = (4.0 * PI / to.texel_count() as f64).sqrt();
            let bound = |height: usize| {
                let h = PI / height as f64;
                2.0 * h * h / size + 1e-3 * size
            };
            let (coarse, fine) = (linear_error(&sources[0], to, rotation), linear_error(&sources[1], to, rotation));
            if !(coarse < bound(32) && fine < bound(256) && fine < coarse / 4.0) {
                failures.push(format!(
                    "{to:?} rotation {turn}: {coarse:.1e} of {:.1e} falls to {fine:.1e} of {:.1e}",
                    bound(32),
                    bound(256)
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_shifted_linear_function_is_noticed() {
    // Negative control: turned by a tenth of a target texel about +Y.
    let to = grid(Cube, 8, 8);
    let turn = Rotation::from_axis_angle([0.0, 1.0, 0.0], 0.1 * FRAC_PI_2 / 8.0);
    let source = linear_source(256);
    let (shifted, straight) = (resample(&source, to, &turn), resample(&source, to, &Rotation::IDENTITY));
    let worst = shifted.texels().iter().zip(straight.texels()).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
    assert!(f64::from(worst) > 10.0 * linear_error(&source, to, &Rotation::IDENTITY), "{worst:e}");
}

/// Mean direction of the light.
fn centroid(environment: &Environment) -> Vec3 {
    let grid = environment.grid();
    let mut sum = [0.0; 3];
    for (f, x, y) in places(grid) {
        let light = f64::from(environment.texel(f, x, y)[0]);
        if light > 0.0 {
            let integral = direction_integral(&grid.texel_outline(f, x, y, 0.05));
            sum = add(sum, scale(integral, light));
        }
    }
    normalize(sum)
}

#[test]
fn light_turns_with_the_rotation() {
    let quarter = Rotation::from_axis_angle([0.0, 1.0, 0.0], FRAC_PI_2);
    // CONVENTIONS: right-handed. +X goes to -Z.
    assert!(angle_between(quarter.apply([1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]) < 1e-12);
    for (from, to) in energy_pairs() {
        let plus_x = normalize([1.0, 0.01, -0.01]);
        let source = one_texel(from, texel_towards(from, plus_x));
        for rotation in [quarter, rotations()[1], rotations()[2], Rotation::IDENTITY] {
            let target = resample(&source, to, &rotation);
            let expected = rotation.apply(centroid(&source));
            let texel = |g: Grid| 4.0 * (4.0 * PI / g.texel_count() as f64).sqrt();
            // Light moves by at most the diagonal of the texel it lands in; a texel at the rim of a mirror ball is long.
            let tolerance = texel(to).max(0.5 * texel(from)).min(0.9);
            let apart = angle_between(centroid(&target), expected);
            assert!(apart < tolerance, "{from:?} -> {to:?}: {apart} of {tolerance}");
        }
    }
}

#[test]
fn a_fine_picture_turns_the_right_way() {
    // Texels of 1.4° and a turn of 90°: no tolerance hides the inverse.
    let source = one_texel(grid(LatLong, 256, 128), texel_towards(grid(LatLong, 256, 128), [1.0, 0.01, 0.01]));
    for rotation in rotations().into_iter().chain([Rotation::from_axis_angle([0.0, 1.0, 0.0], FRAC_PI_2)]) {
        for to in [grid(LatLong, 256, 128), grid(Cube, 64, 64), grid(Octahedral, 128, 128), grid(AngularMap, 160, 160)]
        {
            let apart = angle_between(centroid(&resample(&source, to, &rotation)), rotation.apply(centroid(&source)));
            assert!(apart < 0.02, "{to:?} {rotation:?} {apart}");
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let noise = |d: Vec3| -> Rgb {
        [0.0, 1.0, 2.0]
            .map(|k| (((d[0] * 12.98 + d[1] * 78.23 + d[2] * 37.7 + k).sin() * 43758.5).fract().abs()) as f32)
    };
    for (from, to) in [
        (grid(LatLong, 128, 64), grid(Cube, 32, 32)),
        (grid(Cube, 32, 32), grid(LatLong, 90, 45)),
        (grid(AngularMap, 64, 64), grid(Octahedral, 50, 50)),
    ] {
        let source = Environment::from_fn(from, noise);
        let bits = |threads: usize| -> Vec<[u32; 3]> {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let target = pool.install(|| resample(&source, to, &rotations()[1]));
            target.texels().iter().map(|t| t.map(f32::to_bits)).collect()
        };
        let one = bits(1);
        assert_eq!(one, bits(2));
        assert_eq!(one, bits(3));
    }
}

/// Errors of a constant and of one texel between every two grids and turned every way.
fn light_errors(sources: &[Grid], targets: &[Grid]) -> Vec<String> {
    let mut failures = Vec::new();
    for &from in sources {
        for &to in targets {
            for (turn, rotation) in rotations().iter().enumerate() {
                let constant = resample(&Environment::from_fn(from, |_| [1.0; 3]), to, rotation);
                let texel = one_texel(from, texel_towards(from, normalize([0.48, 0.59, -0.65])));
                let off = [
                    (energy(&constant) / (2.0 * TAU) - 1.0).abs(),
                    (energy(&resample(&texel, to, rotation)) / energy(&texel) - 1.0).abs(),
                ];
                if !(off[0] < 1e-6 && off[1] < ENERGY_TOLERANCE) {
                    failures.push(format!(
                        "{from:?} -> {to:?} rotation {turn}: constant off by {:.1e}, texel by {:.1e}",
                        off[0], off[1]
                    ));
                }
            }
        }
    }
    failures
}

#[test]
fn tiny_grids_keep_constants_and_energy() {
    let tiny = [
        grid(LatLong, 3, 2),
        grid(LatLong, 4, 2),
        grid(Cube, 1, 1),
        grid(MirrorBall, 2, 2),
        grid(HorizontalCross, 4, 3),
        grid(VerticalCross, 3, 4),
        grid(LatLong, 8, 4),
    ];
    let failures = light_errors(&tiny, &tiny);
    assert!(failures.is_empty(), "{}\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn texels_as_large_as_a_hemisphere_keep_constants_and_energy() {
    let huge = [
        grid(LatLong, 1, 1),
        grid(LatLong, 2, 1),
        grid(LatLong, 1, 2),
        grid(Octahedral, 1, 1),
        grid(DualParaboloid, 2, 1),
        grid(AngularMap, 1, 1),
        grid(MirrorBall, 1, 1),
    ];
    let plain = [grid(LatLong, 8, 4), grid(Cube, 4, 4)];
    let mut failures = light_errors(&huge, &plain);
    failures.extend(light_errors(&plain, &huge));
    assert!(failures.is_empty(), "{}\n{}", failures.len(), failures.join("\n"));
}
