//! EXT_lights_image_based, from files made here.
#![allow(clippy::unwrap_used)]

mod common;

use common::{read, with_pieces};
use image::{DynamicImage, ImageFormat, RgbImage, RgbaImage};
use lumisphere_image::{Environment, sample_nearest};
use lumisphere_scene::{Scene, SceneError, Summary};
use lumisphere_sphere::{Projection, Vec3};

const SIZE: u32 = 4;
const AXES: [Vec3; 6] =
    [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
const NO_LIGHT: &str = "[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]";

fn png(picture: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Faces of one byte each, by column, row and face.
fn faces(value: impl Fn(usize, u32, u32) -> u8) -> Vec<Vec<u8>> {
    let face = |face| RgbImage::from_fn(SIZE, SIZE, |x, y| image::Rgb([value(face, x, y); 3]));
    (0..6).map(|i| png(face(i))).collect()
}

/// A scene of a light with these pictures; `rest` goes into the light.
fn file(pictures: &[Vec<u8>], levels: &str, rest: &str) -> Vec<u8> {
    let images: Vec<String> = (0..pictures.len()).map(|i| format!(r#"{{"bufferView":{i}}}"#)).collect();
    let json = format!(
        r#""images":[{}],"scene":0,"scenes":[{{"nodes":[],"extensions":{{"EXT_lights_image_based":{{"light":0}}}}}}],
        "extensions":{{"EXT_lights_image_based":{{"lights":[{{"name":"sky",{rest},"specularImages":{levels}}}]}}}}"#,
        images.join(",")
    );
    let pieces: Vec<&[u8]> = pictures.iter().map(Vec::as_slice).collect();
    with_pieces(&pieces, &json)
}

fn plain(more: &str) -> String {
    format!(r#""specularImageSize":{SIZE},"irradianceCoefficients":[[1,1,1],{NO_LIGHT}]{more}"#)
}

fn environment(scene: &Scene) -> &Environment {
    &scene.environment.as_ref().unwrap().radiance
}

#[test]
fn each_face_is_what_lies_along_its_axis_in_the_loaders_frame() {
    let scene =
        read(&file(&faces(|face, _, _| [0, 255, 128, 10, 50, 90][face]), "[[0,1,2,3,4,5]]", &plain(""))).unwrap();
    let environment = environment(&scene);
    assert_eq!((environment.projection(), environment.grid().width()), (Projection::Cube, SIZE as usize));
    for (axis, byte) in AXES.into_iter().zip([255u8, 0, 128, 10, 50, 90]) {
        // The sRGB curve of IEC 61966-2-1.
        let x = f64::from(byte) / 255.0;
        let expected = if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
        assert!((f64::from(sample_nearest(environment, axis)[1]) - expected).abs() < 1e-6, "{axis:?}");
    }
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    let summary = Summary::of(&scene).environment.unwrap();
    assert_eq!((summary.name.as_str(), summary.properties[0].0), ("sky", "from"));
    assert!(summary.properties[0].1.contains("4 x 4 texels with 1 levels"), "{summary:?}");
}

#[test]
fn faces_are_those_of_a_cube_map_with_rows_reversed_and_x_negated() {
    let (right, top) = (|_, x, _| if x >= SIZE / 2 { 255 } else { 0 }, |_, _, y| if y < SIZE / 2 { 255 } else { 0 });
    let of = |value: &dyn Fn(usize, u32, u32) -> u8| read(&file(&faces(value), "[[0,1,2,3,4,5]]", &plain(""))).unwrap();
    let (right, top) = (of(&right), of(&top));
    let lit = |scene: &Scene, d: Vec3| sample_nearest(environment(scene), d)[1] > 0.5;
    // The table of cube maps has (1, -t, -s), (-1, -t, s), (s, 1, t), (s, -1, -t), (s, -t, 1), (-s, -t, -1) with s to the right and t
    // down; here the first row of a picture is t = 1, and x is negated.
    let sides: [(Vec3, Vec3, Vec3); 6] = [
        (AXES[1], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]),
        (AXES[0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]),
        (AXES[2], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (AXES[3], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        (AXES[4], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
        (AXES[5], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
    ];
    for (forward, to_right, to_top) in sides {
        let beside = |side: Vec3, sign: f64| std::array::from_fn(|i| forward[i] + 0.5 * sign * side[i]);
        assert!(lit(&right, beside(to_right, 1.0)) && !lit(&right, beside(to_right, -1.0)), "{forward:?}");
        assert!(lit(&top, beside(to_top, 1.0)) && !lit(&top, beside(to_top, -1.0)), "{forward:?}");
    }
}

#[test]
fn alpha_divides() {
    let face = |alpha| png(RgbaImage::from_pixel(SIZE, SIZE, image::Rgba([255, 0, 128, alpha])));
    let pictures: Vec<Vec<u8>> = [255, 51, 1, 0, 255, 255].map(face).into();
    let scene = read(&file(&pictures, "[[0,1,2,3,4,5]]", &plain(""))).unwrap();
    for (axis, divisor) in AXES.into_iter().zip([0.2, 1.0, 1.0 / 255.0, 1.0 / 255.0]) {
        let [r, g, b] = sample_nearest(environment(&scene), axis).map(f64::from);
        let blue = (128.0 / 255.0f64).powf(2.2) / divisor;
        assert!((r * divisor - 1.0).abs() < 1e-6 && g == 0.0 && (b / blue - 1.0).abs() < 1e-6, "{axis:?}: {r} {b}");
    }
}

#[test]
fn a_light_without_pictures_is_what_its_coefficients_say() {
    // E = 2 π everywhere is a radiance of 2; coefficient 0 is E times 2 sqrt(π).
    let constant = 4.0 * std::f64::consts::PI.powf(1.5);
    let rest = format!(r#""specularImageSize":0,"intensity":3,"irradianceCoefficients":[[{constant},0,0],{NO_LIGHT}]"#);
    let scene = read(&file(&[vec![0]], "[]", &rest)).unwrap();
    for axis in AXES {
        let [r, g, _] = sample_nearest(environment(&scene), axis);
        assert!((r - 2.0).abs() < 1e-6 && g == 0.0, "{r}");
    }
    let light = scene.environment.as_ref().unwrap();
    assert_eq!((light.intensity, light.level_count), (3.0, 0));
    // Coefficient 3 is that of -x, and x is negated.
    let rest = r#""specularImageSize":0,"irradianceCoefficients":[[1,1,1],[0,0,0],[0,0,0],[1,1,1],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]"#;
    let scene = read(&file(&[vec![0]], "[]", rest)).unwrap();
    let [right, left] = [AXES[0], AXES[1]].map(|d| sample_nearest(environment(&scene), d)[0]);
    assert!(right > left && left == 0.0, "{right} {left}");
}

#[test]
fn damaged_lights_are_refused() {
    let good = faces(|_, _, _| 9);
    let wrong = |pictures: &[Vec<u8>], levels: &str, rest: &str, text: &str| {
        let error: SceneError = read(&file(pictures, levels, rest)).unwrap_err();
        assert!(error.to_string().contains(text), "{error}");
    };
    wrong(&good, "[[0,1,2,3,4,6]]", &plain(""), "image 6, expected below 6");
    wrong(&good, "[[0,1,2,3,4]]", &plain(""), "EXT_lights_image_based light 0");
    wrong(&good, "[[0,1,2,3,4,5]]", &plain(r#","intensity":-1"#), "at least 0");
    let of_size = |size: &str| format!(r#""specularImageSize":{size},"irradianceCoefficients":[[1,1,1],{NO_LIGHT}]"#);
    wrong(&good, "[[0,1,2,3,4,5]]", &of_size("8"), "image 0 is 4 x 4, expected 8 x 8");
    wrong(&good, "[[0,1,2,3,4,5]]", &of_size("0"), "specularImageSize");
    wrong(&good, "[[0,1,2,3,4,5]]", &of_size("4294967296"), "needs");
    wrong(&[b"GIF89a".to_vec()], "[[0,0,0,0,0,0]]", &plain(""), "cannot be decoded");
}
