//! Stratification and convergence of the sequences, against random points as the negative control.

use lumisphere_sphere::sequence::{OwenSobol, SOBOL_DIMENSIONS, halton, hammersley, r2, radical_inverse, sobol};
use std::collections::HashSet;

/// Random points by SplitMix64 (G. Steele et al. 2014): the negative control.
fn random(seed: u64) -> impl FnMut(u32) -> [f64; 2] {
    let mut state = seed;
    let mut next = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    move |_| [next(), next()]
}

/// Whether each elementary interval 2^-a x 2^-(m-a) holds exactly one of the 2^m points from `first` on.
fn is_net(points: &[[f64; 2]]) -> bool {
    let m = points.len().trailing_zeros();
    (0..=m).all(|a| {
        let (columns, rows) = (1_u64 << a, 1_u64 << (m - a));
        let cells: HashSet<u64> =
            points.iter().map(|p| (p[0] * columns as f64) as u64 * rows + (p[1] * rows as f64) as u64).collect();
        cells.len() == points.len()
    })
}

#[test]
fn sobol_is_stratified_in_every_elementary_interval() {
    for m in 0..=12 {
        for block in [0, 1, 5] {
            let range = (block << m)..((block + 1) << m);
            let plain: Vec<[f64; 2]> = range.clone().map(|i| [sobol(i)[0], sobol(i)[1]]).collect();
            assert!(is_net(&plain), "2^{m} points, block {block}");
            for seed in [0, 1, 77, u32::MAX] {
                let scrambled: Vec<[f64; 2]> = range.clone().map(|i| OwenSobol::new(seed).point(i)).collect();
                assert!(is_net(&scrambled), "2^{m} points, block {block}, seed {seed}");
            }
        }
    }
    // Later pairs of the padded sequence are nets too.
    let padded: Vec<[f64; 2]> =
        (0..1024).map(|i| [OwenSobol::new(3).coordinate(i, 4), OwenSobol::new(3).coordinate(i, 5)]).collect();
    assert!(is_net(&padded));
    let hammersley: Vec<[f64; 2]> = (0..1024).map(|i| hammersley(i, 1024)).collect();
    assert!(is_net(&hammersley));
    let control: Vec<[f64; 2]> = (0..16).map(random(9)).collect();
    assert!(!is_net(&control), "random points must fail");
}

#[test]
fn each_dimension_is_stratified_at_2_pow_24() {
    // 2^24 strata as a bit set: each dimension must fill all of them.
    const COUNT: u32 = 1 << 24;
    let sequence = OwenSobol::new(12);
    for dimension in [0, 3] {
        let mut seen = vec![0_u64; COUNT as usize / 64];
        for i in 0..COUNT {
            let cell = (sequence.coordinate(i, dimension) * f64::from(COUNT)) as usize;
            seen[cell / 64] |= 1 << (cell % 64);
        }
        assert!(seen.iter().all(|&word| word == u64::MAX), "dimension {dimension}");
    }
}

/// Sobol's property A, which Joe and Kuo's numbers have: of 2^d points, one falls into each of the 2^d halves-cells of
/// the first d dimensions. A wrong direction number would break it.
#[test]
fn direction_numbers_have_property_a() {
    for d in 1..=SOBOL_DIMENSIONS {
        for block in 0..4_u32 {
            let cells: HashSet<u32> = (block << d..(block + 1) << d)
                .map(|i| sobol(i)[..d].iter().fold(0, |cell, &x| 2 * cell + u32::from(x >= 0.5)))
                .collect();
            assert_eq!(cells.len(), 1 << d, "{d} dimensions, block {block}");
        }
    }
    for dimension in 0..SOBOL_DIMENSIONS {
        let strata: HashSet<u32> = (0..4096).map(|i| (sobol(i)[dimension] * 4096.0) as u32).collect();
        assert_eq!(strata.len(), 4096, "dimension {dimension}");
    }
}

#[test]
fn known_first_points() {
    let third: [f64; 4] = std::array::from_fn(|k| sobol(3)[k]);
    assert_eq!(third, [0.75, 0.25, 0.25, 0.25]);
    assert_eq!(sobol(0), [0.0; SOBOL_DIMENSIONS]);
    assert_eq!([halton(1), halton(2)], [[0.5, 1.0 / 3.0], [0.25, 2.0 / 3.0]]);
    assert!((radical_inverse(10, 1234) - 0.4321).abs() < 1e-15);
    assert_eq!(r2(0), [0.5, 0.5]);
    assert!((r2(1)[0] - 0.254_877_666_246_692_8).abs() < 1e-15 && (r2(1)[1] - 0.069_840_290_998_053_3).abs() < 1e-15);
    for i in [u64::MAX, u64::MAX - 1, 1 << 63] {
        for value in [radical_inverse(2, i), radical_inverse(3, i), radical_inverse(7, i), r2(i)[0], r2(i)[1]] {
            assert!((0.0..1.0).contains(&value));
        }
    }
}

/// Largest | share of points below a corner - area |, over the corners that the points make.
fn star_discrepancy(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mut worst = 0.0_f64;
    let edges = |axis: usize| points.iter().map(move |p| p[axis]).chain([1.0]);
    for x in edges(0) {
        let mut column: Vec<f64> = points.iter().filter(|p| p[0] < x).map(|p| p[1]).collect();
        let mut closed: Vec<f64> = points.iter().filter(|p| p[0] <= x).map(|p| p[1]).collect();
        column.sort_by(f64::total_cmp);
        closed.sort_by(f64::total_cmp);
        for y in edges(1) {
            let open_count = column.partition_point(|&v| v < y) as f64;
            let closed_count = closed.partition_point(|&v| v <= y) as f64;
            worst = worst.max(x * y - open_count / n).max(closed_count / n - x * y);
        }
    }
    worst
}

#[test]
fn discrepancy_is_far_below_that_of_random_points() {
    const COUNT: u32 = 512;
    let of = |f: &mut dyn FnMut(u32) -> [f64; 2]| star_discrepancy(&(0..COUNT).map(f).collect::<Vec<_>>());
    // (log2 N)² / N would be 0.16, log2 N / N 0.018: the sequences lie near the second, random points near 1/sqrt(N) = 0.044.
    let limit = 0.018;
    let found = [
        ("sobol", of(&mut |i| [sobol(i)[0], sobol(i)[1]])),
        ("owen", of(&mut |i| OwenSobol::new(5).point(i))),
        ("halton", of(&mut |i| halton(u64::from(i)))),
        ("hammersley", of(&mut |i| hammersley(u64::from(i), u64::from(COUNT)))),
        ("r2", of(&mut |i| r2(u64::from(i)))),
    ];
    for (name, discrepancy) in found {
        assert!(discrepancy < limit, "{name} {discrepancy}");
    }
    let control = of(&mut random(1));
    assert!(control > limit, "random points must fail: {control}");
}

/// RMS error over 32 seeds of the mean of a smooth function.
fn rms_error(count: u32, mut point: impl FnMut(u32, u32) -> [f64; 2]) -> f64 {
    let truth = (1.0_f64.exp() - 1.0) * 1.0_f64.sin();
    let mut sum = 0.0;
    for seed in 0..32 {
        let mean = (0..count).map(|i| point(seed, i)).map(|p| p[0].exp() * p[1].cos()).sum::<f64>() / f64::from(count);
        sum += (mean - truth).powi(2);
    }
    (sum / 32.0).sqrt()
}

#[test]
fn owen_scrambling_converges_as_its_theory_says() {
    let slope = |coarse: f64, fine: f64| (fine / coarse).log2() / 6.0;
    let owen = slope(
        rms_error(64, |seed, i| OwenSobol::new(seed).point(i)),
        rms_error(4096, |seed, i| OwenSobol::new(seed).point(i)),
    );
    // Owen 1997: N^-1.5 up to logarithms for smooth functions.
    assert!((-1.8..-1.3).contains(&owen), "slope {owen}");
    let control = |count: u32| {
        let mut seed_of = u32::MAX;
        let mut source = random(0);
        rms_error(count, |seed, i| {
            if seed != seed_of {
                (seed_of, source) = (seed, random(u64::from(seed) << 20));
            }
            source(i)
        })
    };
    let random_slope = slope(control(64), control(4096));
    assert!((-0.75..-0.3).contains(&random_slope), "random points converge as N^-0.5: {random_slope}");
}

#[test]
fn unscrambled_sequences_beat_the_square_root() {
    const COUNT: u32 = 1 << 16;
    let truth = (1.0_f64.exp() - 1.0) * 1.0_f64.sin();
    let error = |f: &dyn Fn(u32) -> [f64; 2]| {
        ((0..COUNT).map(f).map(|p| p[0].exp() * p[1].cos()).sum::<f64>() / f64::from(COUNT) - truth).abs()
    };
    // The integrand's standard deviation is about 0.5: random points err by 2e-3.
    for (name, e) in [
        ("sobol", error(&|i| [sobol(i)[0], sobol(i)[1]])),
        ("halton", error(&|i| halton(u64::from(i)))),
        ("hammersley", error(&|i| hammersley(u64::from(i), u64::from(COUNT)))),
        ("r2", error(&|i| r2(u64::from(i)))),
    ] {
        assert!(e < 1e-4, "{name} {e:e}");
    }
}

#[test]
fn seeds_and_dimensions_are_independent() {
    let values: HashSet<u64> = (0..100)
        .flat_map(|seed| (0..12).map(move |dimension| OwenSobol::new(seed).coordinate(7, dimension).to_bits()))
        .collect();
    assert!(values.len() > 1195, "{}", values.len());
    // Over many seeds one point is uniform: the mean of the products of two coordinates is 1/4.
    for (a, b) in [(0, 1), (0, 4), (1, 5), (2, 3), (3, 7)] {
        let seeds = 20_000;
        let mean = (0..seeds).map(OwenSobol::new).map(|s| s.coordinate(3, a) * s.coordinate(3, b)).sum::<f64>()
            / f64::from(seeds);
        // The standard deviation of a product is sqrt(1/9 - 1/16) = 0.22; five of them over sqrt(20000) are 0.0078.
        assert!((mean - 0.25).abs() < 0.0078, "dimensions {a} and {b}: {mean}");
    }
    // Over the points of one sequence, coordinates of different groups do not run together either.
    for (a, b) in [(0, 4), (1, 4), (0, 8), (2, 6)] {
        let sequence = OwenSobol::new(9);
        let mean = (0..16384).map(|i| sequence.coordinate(i, a) * sequence.coordinate(i, b)).sum::<f64>() / 16384.0;
        assert!((mean - 0.25).abs() < 0.0087, "dimensions {a} and {b}: {mean}");
    }
}
