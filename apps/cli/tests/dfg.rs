//! `lumisphere dfg` as a user sees it.
#![allow(clippy::unwrap_used)]

mod common;
use common::{fail, names, succeed};
use std::path::Path;
use tempfile::tempdir;

/// What half floats leave of a number up to 1, and 16 bits of a PNG.
const HALF: f64 = 2.5e-4;

fn numbers(folder: &Path, file: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|word| word.parse().unwrap()).collect()).collect()
}

#[test]
fn the_default_is_the_table_that_bake_writes() {
    let folder = tempdir().unwrap();
    let said = succeed(folder.path(), &["dfg", "--size", "16"]);
    assert!(said.starts_with("dfg.ktx2: 16x16, directional albedo E = F0 red + green"), "{said}");
    succeed(
        folder.path(),
        &["bake", "builtin:axes?height=64", "--only", "dfg", "--dfg-size", "16", "-o", "baked", "-q"],
    );
    let read = |path: &str| std::fs::read(folder.path().join(path)).unwrap();
    assert_eq!(read("dfg.ktx2"), read("baked/dfg.ktx2"));
}

#[test]
fn every_extension_is_written() {
    let folder = tempdir().unwrap();
    let all = ["ktx2", "dds", "exr", "png", "csv", "glsl", "hlsl", "wgsl", "h", "rs"];
    for extension in all {
        succeed(folder.path(), &["dfg", "--size", "4", "-o", &format!("split.{extension}")]);
    }
    for extension in &all[..5] {
        succeed(folder.path(), &["dfg", "lambert", "--size", "4", "-o", &format!("own/lambert.{extension}")]);
    }
    assert_eq!(names(folder.path()).len(), 11);
    assert_eq!(names(&folder.path().join("own")).len(), 5);
    let rows = numbers(folder.path(), "own/lambert.csv");
    assert_eq!(rows.len(), 16);
    for row in rows {
        assert!(
            (row[2] - row[1]).abs() < HALF && row[5..].iter().all(|v| *v == 0.0),
            "albedo is the parameter: {row:?}"
        );
    }
}

#[test]
fn parameters_and_axis_are_taken() {
    let folder = tempdir().unwrap();
    let said = succeed(
        folder.path(),
        &["dfg", "oren-nayar-improved", "alb=0.5", "--over", "sigma", "--size", "2", "-o", "fon.csv"],
    );
    assert!(said.contains("directional albedo of oren-nayar-improved; u = n.v, v = sigma"), "{said}");
    let rows = numbers(folder.path(), "fon.csv");
    assert_eq!([rows[3][0], rows[3][1]], [0.75, 0.75]);
    // Half of what albedo 1 has, which falls with sigma.
    assert!(rows.iter().all(|row| (0.35..0.5).contains(&row[2])), "{rows:?}");
    assert!(rows[3][2] < rows[1][2], "{rows:?}");
}

#[test]
fn fits_are_printed_in_every_language() {
    let folder = tempdir().unwrap();
    for (language, opening) in [
        ("glsl", "vec2 ggx_albedo_pair(float n_dot_v, float p) {"),
        ("hlsl", "float2 ggx_albedo_pair(float n_dot_v, float p) {"),
        ("wgsl", "fn ggx_albedo_pair(n_dot_v: f32, p: f32) -> vec2f {"),
        ("c", "static inline void ggx_albedo_pair(float n_dot_v, float p, float result[2]) {"),
        ("rust", "pub fn ggx_albedo_pair(n_dot_v: f32, p: f32) -> [f32; 2] {"),
    ] {
        let text = succeed(folder.path(), &["dfg", "--fit", language]);
        assert!(text.contains(opening) && text.contains("absolute error at most"), "{text}");
        assert!(text.contains("ggx_average_albedo"), "{text}");
    }
    let eon = succeed(folder.path(), &["dfg", "eon", "--fit", "glsl"]);
    assert!(eon.contains("float eon_albedo(float n_dot_v, float sigma, float albedo) {"), "{eon}");
    assert!(eon.contains("    float s = sqrt((1.0 - n_dot_v) * (1.0 + n_dot_v));"), "{eon}");
    assert_eq!(names(folder.path()), Vec::<String>::new(), "nothing is written");
}

#[test]
fn errors_say_what_was_meant() {
    let folder = tempdir().unwrap();
    for (arguments, expected) in [
        (&["dfg", "lambertt"] as &[&str], "did you mean `lambert`?"),
        (&["dfg", "lambert", "colour=1"], "it has albedo"),
        (&["dfg", "lambert", "albedo=2"], "expected 0 to 1"),
        (&["dfg", "lambert", "albedo"], "expected NAME=VALUE"),
        (&["dfg", "lambert", "--over", "sigma"], "it has albedo"),
        (&["dfg", "lambert", "--size", "0"], "expected 1 to 4096"),
        (&["dfg", "lambert", "-o", "x.hdr"], "expected one of ktx2, dds, exr, png, csv"),
        (&["dfg", "-o", "x.hdr"], "csv, glsl, hlsl, wgsl, h, rs"),
        (&["dfg", "--over", "f0"], "name a MODEL"),
        (&["dfg", "lambert", "--fit", "glsl"], "has no fit"),
        (&["dfg", "burley", "--size", "8", "-o", "x.png"], ".exr and .ktx2 hold it"),
    ] {
        let said = fail(folder.path(), arguments);
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    assert_eq!(names(folder.path()), Vec::<String>::new());
}
