//! Positions, directions and shapes of every projection.
#![allow(clippy::unwrap_used)]

use lumisphere_sphere::vector::{Vec3, angle_between, dot, normalize, sub};
use lumisphere_sphere::{Grid, GridError, Projection, TexelPosition, guess_projection};

const ALL: [Projection; 8] = [
    Projection::LatLong,
    Projection::Cube,
    Projection::Octahedral,
    Projection::DualParaboloid,
    Projection::AngularMap,
    Projection::MirrorBall,
    Projection::HorizontalCross,
    Projection::VerticalCross,
];

fn grid(projection: Projection, n: usize) -> Grid {
    let (width, height) = match projection {
        Projection::LatLong | Projection::DualParaboloid => (2 * n, n),
        Projection::HorizontalCross => (4 * n, 3 * n),
        Projection::VerticalCross => (3 * n, 4 * n),
        _ => (n, n),
    };
    Grid::new(projection, width, height).unwrap()
}

/// Points spread over the sphere, with the axes, the cube's corners and edge middles added.
fn directions() -> Vec<Vec3> {
    let mut all = Vec::new();
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            for z in [-1.0, 0.0, 1.0] {
                if [x, y, z] != [0.0; 3] {
                    all.push(normalize([x, y, z]));
                }
            }
        }
    }
    for i in 0..3000 {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 3000.0;
        let (s, c) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let r = (1.0 - z * z).sqrt();
        all.push([r * c, z, r * s]);
    }
    all
}

#[test]
fn direction_of_position_is_the_direction() {
    for projection in ALL {
        // 1 - r is quadratic in the angle from the mirror ball's rim: half of the digits are not in the picture.
        let tolerance = if projection == Projection::MirrorBall { 1e-7 } else { 1e-13 };
        for n in [1, 3, 8, 256] {
            let grid = grid(projection, n);
            for d in directions() {
                let at = grid.position(d);
                let back = grid.direction(at).unwrap_or_else(|| panic!("{projection:?} {n} {d:?} {at:?}"));
                assert!(angle_between(d, back) < tolerance, "{projection:?} {n} {d:?} {at:?} {back:?}");
                assert!((dot(back, back) - 1.0).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn a_direction_falls_into_a_texel_with_a_solid_angle() {
    for projection in ALL {
        for n in [1, 2, 5, 64] {
            let grid = grid(projection, n);
            for d in directions() {
                let at = grid.position(d);
                let (x, y) = ((at.x as usize).min(grid.width() - 1), (at.y as usize).min(grid.height() - 1));
                // Rim points of a disc may round into a texel that only touches it.
                if grid.texel_solid_angle(at.face, x, y) == 0.0 {
                    let rim_only = matches!(
                        projection,
                        Projection::DualParaboloid | Projection::AngularMap | Projection::MirrorBall
                    );
                    let on_rim = d[1].abs() < 1e-9 || angle_between(d, [0.0, 0.0, 1.0]) < 1e-6;
                    assert!(rim_only && on_rim, "{projection:?} {n} {d:?} {at:?}");
                }
            }
        }
    }
}

#[test]
fn texel_centres_return_to_their_texels() {
    for projection in ALL {
        for n in [1, 2, 3, 5, 8, 37] {
            let grid = grid(projection, n);
            for face in 0..grid.face_count() {
                for y in 0..grid.height() {
                    for x in 0..grid.width() {
                        let Some(d) = grid.texel_direction(face, x, y) else {
                            assert_eq!(grid.texel_solid_angle(face, x, y), 0.0, "{projection:?} {n} {x} {y}");
                            continue;
                        };
                        assert!(grid.texel_solid_angle(face, x, y) > 0.0, "{projection:?} {n} {x} {y}");
                        let at = grid.position(d);
                        assert_eq!(
                            (at.face, at.x as usize, at.y as usize),
                            (face, x, y),
                            "{projection:?} {n} {x} {y} {d:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn orientation_is_the_documented_one() {
    let at = |projection, x, y| grid(projection, 8).direction(TexelPosition { face: 0, x, y }).unwrap();
    let near = |a: Vec3, b: Vec3| assert!(dot(sub(a, b), sub(a, b)) < 1e-24, "{a:?} is not {b:?}");
    let (px, py, pz) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let (nx, ny, nz) = ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]);
    // Octahedral: +Y in the middle, +X at the right edge's middle, +Z at the bottom's, -Y in the corners.
    for (x, y, d) in [(4.0, 4.0, py), (8.0, 4.0, px), (0.0, 4.0, nx), (4.0, 8.0, pz), (4.0, 0.0, nz), (0.0, 8.0, ny)] {
        near(at(Projection::Octahedral, x, y), d);
    }
    for (x, y, d) in [(4.0, 4.0, py), (12.0, 4.0, ny), (7.999_999_999_999_999, 4.0, px), (12.0, 8.0, pz)] {
        near(at(Projection::DualParaboloid, x, y), d);
    }
    // Half the radius of the angular map is a quarter turn; of the mirror ball, sqrt(1/2) is.
    for (x, y, d) in [(4.0, 4.0, nz), (6.0, 4.0, px), (4.0, 2.0, py), (8.0, 4.0, pz), (4.0, 6.0, ny)] {
        near(at(Projection::AngularMap, x, y), d);
    }
    let quarter = 4.0 * f64::sqrt(0.5);
    for (x, y, d) in [(4.0, 4.0, nz), (4.0 + quarter, 4.0, px), (4.0, 4.0 - quarter, py), (4.0, 8.0, pz)] {
        near(at(Projection::MirrorBall, x, y), d);
    }
    for (x, y, d) in
        [(4.0, 12.0, nx), (12.0, 12.0, pz), (20.0, 12.0, px), (28.0, 12.0, nz), (12.0, 4.0, py), (12.0, 20.0, ny)]
    {
        near(at(Projection::HorizontalCross, x, y), d);
    }
    for (x, y, d) in
        [(4.0, 12.0, nx), (12.0, 12.0, nz), (20.0, 12.0, px), (12.0, 28.0, pz), (12.0, 4.0, py), (12.0, 20.0, ny)]
    {
        near(at(Projection::VerticalCross, x, y), d);
    }
}

#[test]
fn horizontal_cross_holds_the_cube_faces_as_stored() {
    let (cube, sheet) = (grid(Projection::Cube, 6), grid(Projection::HorizontalCross, 6));
    let cells = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];
    for (face, (column, row)) in cells.into_iter().enumerate() {
        for (x, y) in [(0, 0), (5, 1), (2, 4)] {
            let a = cube.texel_direction(face, x, y).unwrap();
            let b = sheet.texel_direction(0, column * 6 + x, row * 6 + y).unwrap();
            assert!(angle_between(a, b) < 1e-15, "face {face}");
        }
    }
}

/// Neighbouring texels of a cross show neighbouring directions, across the borders of cells too.
#[test]
fn crosses_are_continuous() {
    for projection in [Projection::HorizontalCross, Projection::VerticalCross] {
        let grid = grid(projection, 32);
        // A texel at a face's centre is 2/32 rad wide; nothing in the sheet is wider.
        let widest = 2.0 / 32.0 * 1.001;
        let mut pairs = 0;
        for y in 0..grid.height() {
            for x in 0..grid.width() {
                let Some(d) = grid.texel_direction(0, x, y) else { continue };
                for (nx, ny) in [(x + 1, y), (x, y + 1)] {
                    let inside = nx < grid.width() && ny < grid.height();
                    if inside && let Some(e) = grid.texel_direction(0, nx, ny) {
                        assert!(angle_between(d, e) < widest, "{projection:?} ({x}, {y}) ({nx}, {ny})");
                        pairs += 1;
                    }
                }
            }
        }
        // Inside the six cells, and across the five folds.
        assert_eq!(pairs, 6 * 2 * 31 * 32 + 5 * 32, "{projection:?}");
    }
}

#[test]
fn outside_the_domain_there_is_no_direction() {
    let none = |projection, x, y| {
        assert_eq!(grid(projection, 8).direction(TexelPosition { face: 0, x, y }), None, "{projection:?} {x} {y}");
    };
    for projection in [Projection::AngularMap, Projection::MirrorBall, Projection::DualParaboloid] {
        none(projection, 0.5, 0.5);
        none(projection, 7.5, 7.5);
    }
    none(Projection::DualParaboloid, 15.5, 0.5);
    none(Projection::Octahedral, 8.5, 4.0);
    none(Projection::HorizontalCross, 1.0, 1.0);
    none(Projection::HorizontalCross, 20.0, 20.0);
    none(Projection::VerticalCross, 1.0, 30.0);
    none(Projection::VerticalCross, f64::NAN, 1.0);
}

#[test]
fn impossible_shapes_are_refused() {
    let wrong = [
        (Projection::Octahedral, 4, 2),
        (Projection::AngularMap, 4, 5),
        (Projection::MirrorBall, 1, 2),
        (Projection::DualParaboloid, 4, 4),
        (Projection::DualParaboloid, 1, usize::MAX),
        (Projection::HorizontalCross, 5, 3),
        (Projection::HorizontalCross, 6, 8),
        (Projection::VerticalCross, 8, 6),
        (Projection::VerticalCross, 3, 8),
        (Projection::Cube, 1, 6),
    ];
    for (projection, width, height) in wrong {
        let found = Grid::new(projection, width, height);
        assert!(matches!(found, Err(GridError::Shape { .. })), "{projection:?} {width}x{height}");
    }
    for projection in ALL {
        assert!(matches!(Grid::new(projection, 0, 4), Err(GridError::Empty { .. })));
    }
}

#[test]
fn shapes_suggest_projections() {
    let cases = [
        (2048, 1024, Some(Projection::LatLong)),
        (900, 900, Some(Projection::AngularMap)),
        (1024, 768, Some(Projection::HorizontalCross)),
        (768, 1024, Some(Projection::VerticalCross)),
        (64, 384, Some(Projection::Cube)),
        (640, 480, Some(Projection::HorizontalCross)),
        (1920, 1080, None),
        (7, 5, None),
        (0, 0, None),
        (0, 4, None),
        (usize::MAX, usize::MAX - 1, None),
    ];
    for (width, height, expected) in cases {
        assert_eq!(guess_projection(width, height), expected, "{width}x{height}");
    }
}
