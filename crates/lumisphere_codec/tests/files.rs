//! Real and damaged files.
#![allow(clippy::unwrap_used)]

mod common;

use common::{data, files};
use lumisphere_codec::{CodecError, Limits, decode_picture};
use lumisphere_image::Picture;
use lumisphere_sphere::Projection;
use std::path::Path;

fn read(path: impl AsRef<Path>) -> Result<Picture, CodecError> {
    decode_picture(&std::fs::read(path).unwrap(), &Limits::default())
}

fn extreme(picture: &Picture) -> (f32, f32) {
    picture.texels.iter().flatten().fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &v| (lo.min(v), hi.max(v)))
}

#[test]
fn damaged_files_give_an_error() {
    let Some(data) = data("damaged_files_give_an_error") else { return };
    for kind in ["hdr", "exr", "ktx2"] {
        for path in files(&data.join("bad").join(kind)) {
            let error = read(&path).expect_err(&path.to_string_lossy());
            // A message says something; the exact words are tested beside each reader.
            assert!(error.to_string().len() > 15, "{path:?}: {error}");
        }
    }
}

#[test]
fn good_files_are_read() {
    let Some(data) = data("good_files_are_read") else { return };
    for folder in ["hdri", "probe", "exr_odd", "hdr_odd"] {
        for path in files(&data.join(folder)) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match read(&path) {
                Ok(picture) => {
                    assert_ne!(name, "tinydeep.exr");
                    assert_eq!(picture.texels.len(), picture.width * picture.height, "{name}");
                }
                Err(error) => {
                    assert_eq!(name, "tinydeep.exr", "{error}");
                    assert!(error.to_string().contains("deep data is not supported"), "{error}");
                }
            }
        }
    }
}

#[test]
fn axis_orders_and_exposure_agree() {
    let Some(data) = data("axis_orders_and_exposure_agree") else { return };
    let read = |name: &str| read(data.join("hdr_odd").join(name)).unwrap();
    let reference = read("ref_mY_pX.hdr");
    for name in ["mY_mX.hdr", "pX_mY.hdr"] {
        assert_eq!(read(name).texels, reference.texels, "{name}");
    }
    // EXPOSURE 0.5 · 2 and COLORCORR 1 0.5 1: green is doubled, exactly.
    let exposed = read("exposure_0p5.hdr");
    let expected: Vec<_> = reference.texels.iter().map(|t| [t[0], 2.0 * t[1], t[2]]).collect();
    assert_eq!(exposed.texels, expected);
}

#[test]
fn known_maxima_are_found() {
    let Some(data) = data("known_maxima_are_found") else { return };
    // From the inputs' own list, which rounds: maximum and relative tolerance.
    for (name, width, height, max, tolerance) in [
        ("lightroom_14b.hdr", 2048, 1024, 54.0, 0.01),
        ("qwantani_afternoon_puresky_1k.hdr", 1024, 512, 109_568.0, 1e-6),
        ("empty_warehouse_01_1k.hdr", 1024, 512, 430.0, 0.01),
        ("potsdamer_platz_1k.hdr", 1024, 512, 11.8, 0.01),
        ("spot1Lux.hdr", 1024, 512, 26_368.0, 1e-6),
    ] {
        let picture = read(data.join("hdri").join(name)).unwrap();
        assert_eq!((picture.width, picture.height), (width, height), "{name}");
        let found = extreme(&picture).1;
        assert!((found / max - 1.0).abs() < tolerance, "{name}: {found}");
    }
    let apartment = read(data.join("hdri/pmndrs_apartment_half_dwab_negatives.exr")).unwrap();
    assert!((extreme(&apartment).0 + 0.57).abs() < 0.005, "{:?}", extreme(&apartment));
    let scale = read(data.join("hdr_odd/scale.hdr")).unwrap();
    assert!((extreme(&scale).1 / 1.7e38 - 1.0).abs() < 0.01, "{:?}", extreme(&scale));
    let rings = read(data.join("exr_odd/BrightRingsNanInf.exr")).unwrap();
    assert!(rings.texels.iter().flatten().any(|v| v.is_nan()));
    assert!(rings.texels.iter().flatten().any(|v| v.is_infinite()));
}

#[test]
fn luminance_chroma_is_reconstructed() {
    let Some(data) = data("luminance_chroma_is_reconstructed") else { return };
    let picture = read(data.join("exr_odd/Rec709_YC.exr")).unwrap();
    assert_eq!((picture.width, picture.height), (610, 406));
    // A photograph: all components near [0, 1], and not grey.
    let (low, high) = extreme(&picture);
    assert!(low > -0.5 && high < 20.0, "{low} {high}");
    let saturated = picture.texels.iter().filter(|t| (t[0] - t[2]).abs() > 0.3 * t[1].abs()).count();
    assert!(saturated > picture.texels.len() / 50, "{saturated}");
}

#[test]
fn data_windows_are_placed() {
    let Some(data) = data("data_windows_are_placed") else { return };
    let picture = read(data.join("exr_odd/t08_datawindow_offset.exr")).unwrap();
    assert_eq!((picture.width, picture.height), (501, 401));
    let inside = |i: usize| (30..=429).contains(&(i % 501)) && (40..=339).contains(&(i / 501));
    let lit = |t: &[f32; 3]| *t != [0.0; 3];
    assert!(picture.texels.iter().enumerate().all(|(i, t)| inside(i) || !lit(t)));
    let edge = |x: usize, y: usize| lit(&picture.texels[y * 501 + x]);
    assert!((30..430).any(|x| edge(x, 40)) && (30..430).any(|x| edge(x, 339)));
    assert!((40..340).any(|y| edge(30, y)) && (40..340).any(|y| edge(429, y)));
}

/// The value at a direction of a lat-long or cube picture, nearest texel, by the table of CONVENTIONS.md (written out
/// here again, so that the test does not lean on the code it is for).
fn look(picture: &Picture, d: [f64; 3]) -> [f32; 3] {
    let texel = |u: f64, size: usize| ((u * size as f64) as usize).min(size - 1);
    let [x, y, z] = d;
    let (column, row) = if picture.projection == Some(Projection::Cube) {
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let (face, sc, tc, ma) = if ax >= ay && ax >= az {
            if x > 0.0 { (0, -z, -y, ax) } else { (1, z, -y, ax) }
        } else if ay >= az {
            if y > 0.0 { (2, x, z, ay) } else { (3, x, -z, ay) }
        } else if z > 0.0 {
            (4, x, -y, az)
        } else {
            (5, -x, -y, az)
        };
        let n = picture.width;
        (texel((sc / ma + 1.0) / 2.0, n), face * n + texel((tc / ma + 1.0) / 2.0, n))
    } else {
        let u = 0.5 + z.atan2(x) / std::f64::consts::TAU;
        (texel(u, picture.width), texel(y.acos() / std::f64::consts::PI, picture.height))
    };
    picture.texels[row * picture.width + column]
}

/// Mean over a patch of 9 x 9 directions, two degrees across: wider than a stroke of the letters, so that neither the
/// pictures' different resolutions nor OpenEXR's half texel matters.
fn look_around(picture: &Picture, d: [f64; 3], turn: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 3] {
    let side = if d[1].abs() < 0.9 { [d[2], 0.0, -d[0]] } else { [0.0, d[2], -d[1]] };
    let side = unit(side);
    let up = [d[1] * side[2] - d[2] * side[1], d[2] * side[0] - d[0] * side[2], d[0] * side[1] - d[1] * side[0]];
    let mut sum = [0.0; 3];
    for i in -4..=4 {
        for j in -4..=4 {
            let (s, t) = (f64::from(i) * 0.0044, f64::from(j) * 0.0044);
            let near = unit(std::array::from_fn(|c| d[c] + s * side[c] + t * up[c]));
            let texel = look(picture, turn(near));
            (0..3).for_each(|c| sum[c] += f64::from(texel[c]) / 81.0);
        }
    }
    sum
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

/// Share of directions on a spiral over the sphere where two pictures differ by more than a tenth.
fn disagreement(a: &Picture, b: &Picture, turn: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    let count = 10_000;
    let different = (0..count)
        .filter(|&i| {
            let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
            let phi = f64::from(i) * 2.399_963_229_728_653; // the golden angle
            let r = (1.0 - y * y).sqrt();
            let d = [r * phi.cos(), y, r * phi.sin()];
            let (a, b) = (look_around(a, d, |d| d), look_around(b, d, &turn));
            (0..3).any(|c| (a[c] - b[c]).abs() > 0.1)
        })
        .count();
    different as f64 / f64::from(count)
}

#[test]
fn the_two_environment_map_layouts_show_one_world() {
    let Some(data) = data("the_two_environment_map_layouts_show_one_world") else { return };
    let cube = read(data.join("exr_odd/OrientationCube.exr")).unwrap();
    let latlong = read(data.join("exr_odd/OrientationLatLong.exr")).unwrap();
    assert_eq!((cube.width, cube.height, cube.projection), (512, 3072, Some(Projection::Cube)));
    assert_eq!((latlong.width, latlong.height, latlong.projection), (1024, 512, Some(Projection::LatLong)));
    let same = disagreement(&cube, &latlong, |d| d);
    // The controls: any other turn or mirror image must disagree more.
    let wrong = [
        disagreement(&cube, &latlong, |[x, y, z]| [-x, y, z]),
        disagreement(&cube, &latlong, |[x, y, z]| [x, y, -z]),
        disagreement(&cube, &latlong, |[x, y, z]| [x, -y, z]),
        disagreement(&cube, &latlong, |[x, y, z]| [-x, y, -z]),
        disagreement(&cube, &latlong, |[x, y, z]| [z, y, -x]),
        disagreement(&cube, &latlong, |[x, y, z]| [z, y, x]),
    ];
    let least = wrong.into_iter().fold(f64::INFINITY, f64::min);
    assert!(same < 0.02, "{same} against {wrong:?}");
    assert!(least > 4.0 * same, "{same} against {wrong:?}");
}
