//! Every container through `convert`, and what `inspect` and `formats` say of the outcome.
#![allow(clippy::unwrap_used)]

mod common;
use common::{bake, data, fail, names, succeed};
use lumisphere::image::Rgb;
use lumisphere_codec::{DecodedTexture, Limits, decode_picture, decode_texture};
use serde_json::Value;
use std::path::Path;
use tempfile::{TempDir, tempdir};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// A chain of floats down to one texel, with harmonics in the file.
fn chain() -> TempDir {
    let folder = tempdir().unwrap();
    let more = ["--levels", "6", "--container", "ktx1", "--format", "rgba32f", "--only", "specular"];
    bake(folder.path(), "builtin:studio?height=64", "out", &more);
    folder
}

fn texture(path: &Path) -> DecodedTexture {
    decode_texture(&std::fs::read(path).unwrap(), &Limits::default()).unwrap()
}

fn rgb(level: &[[f32; 4]]) -> Vec<Rgb> {
    level.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

/// Largest error of a channel over the brightest one of its texel.
fn worst(found: &[Rgb], exact: &[Rgb]) -> f32 {
    assert_eq!(found.len(), exact.len());
    let texel = |(f, e): (&Rgb, &Rgb)| {
        let scale = e.iter().fold(1e-6, |a: f32, v| a.max(*v));
        (0..3).map(|c| (f[c] - e[c]).abs() / scale).fold(0.0, f32::max)
    };
    found.iter().zip(exact).map(texel).fold(0.0, f32::max)
}

#[test]
fn every_container_and_format_keeps_the_levels_within_its_precision() {
    let folder = chain();
    let source = texture(&folder.path().join("out/specular.ktx"));
    assert_eq!(source.levels.len(), 6);
    // Half of the last place of the mantissa, of the brightest channel.
    let cases = [
        ("a.ktx", "rgba32f", 0.0),
        ("a.ktx2", "rgb32f", 0.0),
        ("a.dds", "rgba32f", 0.0),
        ("b.ktx", "rgb16f", 2f32.powi(-11)),
        ("b.ktx2", "rgba16f", 2f32.powi(-11)),
        ("b.dds", "rgba16f", 2f32.powi(-11)),
        ("c.ktx", "rgb9e5", 2f32.powi(-9)),
        ("c.ktx2", "rgb9e5", 2f32.powi(-9)),
        ("c.dds", "rgb9e5", 2f32.powi(-9)),
        ("d.ktx", "b10g11r11", 2f32.powi(-6)),
        ("d.ktx2", "b10g11r11", 2f32.powi(-6)),
        ("d.dds", "b10g11r11", 2f32.powi(-6)),
    ];
    for (name, format, limit) in cases {
        succeed(folder.path(), &["convert", "out/specular.ktx", name, "--format", format]);
        let found = texture(&folder.path().join(name));
        assert_eq!(found.levels.len(), 6, "{name}");
        let errors = found.levels.iter().zip(&source.levels).map(|(f, s)| worst(&rgb(f), &rgb(s)));
        let error = errors.fold(0.0, f32::max);
        assert!(error <= limit, "{name} {format}: {error} {limit}");
        assert!(limit == 0.0 || error > limit / 64.0, "{name} {format} is suspiciously exact: {error}");
    }
}

#[test]
fn containers_in_a_ring_give_the_first_file_back() {
    let folder = chain();
    for (from, to) in [("out/specular.ktx", "1.ktx2"), ("1.ktx2", "2.dds"), ("2.dds", "3.ktx2"), ("3.ktx2", "4.ktx")] {
        succeed(folder.path(), &["convert", from, to]);
        assert_eq!(texture(&folder.path().join(to)).levels, texture(&folder.path().join(from)).levels, "{to}");
    }
    let compressed = ["convert", "4.ktx", "5.ktx2", "--compress", "zstd"];
    succeed(folder.path(), &compressed);
    assert_eq!(texture(&folder.path().join("5.ktx2")).levels, texture(&folder.path().join("4.ktx")).levels);
}

#[test]
fn babylon_environments_carry_the_harmonics_of_filament_and_back() {
    let folder = chain();
    succeed(folder.path(), &["convert", "out/specular.ktx", "sky.env"]);
    succeed(folder.path(), &["convert", "sky.env", "back.ktx", "--format", "rgba32f"]);
    let sh = |name: &str| -> Vec<f64> {
        let file = texture(&folder.path().join(name));
        file.text("sh").unwrap().split_whitespace().map(|n| n.parse().unwrap()).collect()
    };
    let (before, after) = (sh("out/specular.ktx"), sh("back.ktx"));
    assert_eq!(before.len(), 27);
    // Nine decimals, twice.
    assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 3e-9), "{before:?} {after:?}");
    let (exact, found) = (texture(&folder.path().join("out/specular.ktx")), texture(&folder.path().join("back.ktx")));
    // 8 bits to the power of 2.2: 2.2 · 0.5/128 of a channel in the upper half; the darkest texels have fewer steps.
    let error = worst(&rgb(&found.levels[0]), &rgb(&exact.levels[0]));
    assert!(error < 0.03 && error > 1e-4, "{error}");
    // A picture has no chain down to one texel.
    let message = fail(folder.path(), &["convert", "builtin:sky?height=16", "x.env"]);
    assert!(message.contains("level count"), "{message}");
}

#[test]
fn cubes_lie_flat_and_stand_up_again() {
    let folder = chain();
    let p = folder.path();
    succeed(p, &["convert", "out/specular.ktx", "mirror.ktx2", "--level", "0"]);
    let exact = texture(&p.join("mirror.ktx2"));
    assert_eq!(exact.levels.len(), 1);
    let cases = [
        ("horizontal-cross", "stored"),
        ("vertical-cross", "inside"),
        ("strip", "stored"),
        ("column", "stored"),
        ("faces", "stored"),
        ("faces-inside", "inside"),
    ];
    for (arrange, side) in cases {
        let name = format!("{arrange}.exr");
        succeed(p, &["convert", "mirror.ktx2", &name, "--arrange", arrange]);
        let back = if arrange.starts_with("faces") { format!("{arrange}_px.exr") } else { name };
        let out = format!("{arrange}.ktx2");
        succeed(p, &["convert", &back, &out, "--faces", side, "--format", "rgba32f"]);
        let found = texture(&p.join(&out));
        let error = worst(&rgb(&found.levels[0]), &rgb(&exact.levels[0]));
        assert!(error <= 2f32.powi(-11), "{arrange}: {error}");
    }
    // The other side is another world.
    succeed(p, &["convert", "strip.exr", "wrong.ktx2", "--faces", "inside", "--format", "rgba32f"]);
    assert!(worst(&rgb(&texture(&p.join("wrong.ktx2")).levels[0]), &rgb(&exact.levels[0])) > 0.1);
}

#[test]
fn light_is_kept_between_cube_and_panorama() {
    let folder = tempdir().unwrap();
    let p = folder.path();
    succeed(p, &["convert", "builtin:sky?height=128", "sky.exr"]);
    succeed(p, &["convert", "sky.exr", "cube.ktx2", "--size", "32", "--format", "rgba32f"]);
    succeed(p, &["convert", "cube.ktx2", "flat.exr", "--arrange", "octahedral"]);
    succeed(p, &["convert", "cube.ktx2", "panorama.hdr"]);
    let mean = |arguments: &[&str]| {
        let report = json(&succeed(p, arguments));
        let statistics =
            if report["levels"].is_array() { &report["levels"][0]["statistics"] } else { &report["statistics"] };
        statistics["green"]["sphere_mean"].as_f64().unwrap()
    };
    let exact = mean(&["inspect", "sky.exr", "--json"]);
    // The sun is most of the light and a few texels: half of the last place of halves, and of RGBE.
    for (name, layout, limit) in
        [("cube.ktx2", "cube", 1e-5), ("flat.exr", "octahedral", 5e-4), ("panorama.hdr", "lat-long", 4e-3)]
    {
        let found = mean(&["inspect", name, "--json", "--layout", layout]);
        assert!((found / exact - 1.0).abs() < limit, "{name}: {found} {exact}");
    }
    let panorama = decode_picture(&std::fs::read(p.join("panorama.hdr")).unwrap(), &Limits::default()).unwrap();
    assert_eq!((panorama.width, panorama.height), (128, 64));
}

#[test]
fn a_turn_and_its_inverse_leave_everything_in_place() {
    let folder = chain();
    let p = folder.path();
    succeed(p, &["convert", "out/specular.ktx", "turned.ktx", "--turn", "y z -x"]);
    succeed(p, &["convert", "turned.ktx", "back.ktx", "--turn", "-z x y"]);
    let read = |name: &str| texture(&p.join(name));
    assert_ne!(read("turned.ktx").levels[0], read("out/specular.ktx").levels[0]);
    assert_eq!(read("back.ktx").levels, read("out/specular.ktx").levels);
    assert_eq!(read("turned.ktx").text("lumisphere.turn"), Some("y z -x"));
    assert_eq!(read("back.ktx").text("lumisphere.turn"), None);
}

#[test]
fn what_does_not_fit_is_counted() {
    let folder = tempdir().unwrap();
    let p = folder.path();
    bake(p, "builtin:furnace?height=16", "out", &["--exposure", "17", "--only", "skybox", "--format", "rgba32f"]);
    let report = json(&succeed(p, &["convert", "out/skybox.ktx2", "x.dds", "--format", "rgba16f", "--json"]));
    assert_eq!(report["clamped"], 32 * 32 * 6 * 3, "{report}");
    let report = json(&succeed(p, &["convert", "out/skybox.ktx2", "x.dds", "--json"]));
    assert_eq!((&report["clamped"], &report["texels"]), (&0.into(), &"Rgba32F".into()), "{report}");
}

#[test]
fn requests_that_make_no_sense_are_one_line() {
    let folder = chain();
    let p = folder.path();
    let before = names(p);
    let cases: [(&[&str], &str); 9] = [
        (&["out/specular.ktx", "x.png"], ".hdr or .exr"),
        (&["out/specular.ktx", "x.jpg"], "ktx2"),
        (&["out/specular.ktx", "x.hdr", "--format", "rgb9e5"], "--format"),
        (&["out/specular.ktx", "x.dds", "--compress", "zstd"], ".ktx2"),
        (&["out/specular.ktx", "x.dds", "--arrange", "strip"], "--arrange"),
        (&["out/specular.ktx", "x.dds", "--format", "rgb16f"], "cannot write DDS"),
        (&["out/specular.ktx", "x.dds", "--level", "6"], "from 0 to 5"),
        (&["out/specular.ktx", "x.dds", "--size", "8"], "--level"),
        (&["missing.ktx", "x.dds"], "missing.ktx"),
    ];
    for (arguments, hint) in cases {
        let all: Vec<&str> = ["convert"].iter().chain(arguments).copied().collect();
        let message = fail(p, &all);
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.contains(hint), "{arguments:?}: {message}");
    }
    assert_eq!(names(p), before);
}

#[test]
fn formats_lists_bytes_and_errors_of_each() {
    let folder = tempdir().unwrap();
    let report = json(&succeed(folder.path(), &["formats", "builtin:studio?height=64", "--size", "32", "--json"]));
    let row = |container: &str, texels: &str, compression: &str| {
        let rows = report["rows"].as_array().unwrap();
        let found = rows
            .iter()
            .find(|r| r["container"] == container && r["texels"] == texels && r["compression"] == compression);
        found.unwrap_or_else(|| panic!("{container} {texels} {compression}: {report}")).clone()
    };
    let texels = 6.0 * (1024.0 + 256.0 + 64.0 + 16.0 + 4.0 + 1.0);
    assert_eq!(report["texels"], texels as usize);
    let number = |value: &Value| value.as_f64().unwrap();
    // Headers and descriptors take less than 2 KiB.
    for (texels_name, bytes) in [("Rgba32F", 16.0), ("Rgba16F", 8.0), ("Rgb9e5", 4.0), ("B10g11r11", 4.0)] {
        for container in ["KTX1", "KTX2", "DDS"] {
            let found = number(&row(container, texels_name, "")["bytes"]);
            assert!((bytes * texels..bytes * texels + 2048.0).contains(&found), "{container} {texels_name}: {found}");
        }
    }
    let rms = |texels: &str| number(&row("KTX2", texels, "")["relative_rms"]);
    assert_eq!(rms("Rgba32F"), 0.0);
    let order = [rms("Rgba16F"), rms("Rgb9e5"), rms("B10g11r11")];
    assert!(order[0] > 0.0 && order[0] < order[1] && order[1] < order[2] && order[2] < 0.02, "{order:?}");
    assert!(number(&row("KTX2", "Rgba16F", "zstd")["bytes"]) < number(&row("KTX2", "Rgba16F", "")["bytes"]));
    let env = row("Babylon.js .env", "Rgbd8", "");
    assert!(number(&env["relative_rms"]) < 0.01 && env["clamped"] == 0, "{env}");
    // A sun is more than 255.
    let sky = json(&succeed(folder.path(), &["formats", "builtin:sky?height=64", "--size", "32", "--json"]));
    let env = sky["rows"].as_array().unwrap().iter().find(|r| r["texels"] == "Rgbd8").unwrap();
    assert!(number(&env["clamped"]) > 0.0, "{env}");
    assert!(succeed(folder.path(), &["formats", "builtin:furnace?height=16", "--size", "8"]).contains("Rgb9e5"));
}

#[test]
fn everything_that_others_baked_is_inspected() {
    let Some(data) = data("everything_that_others_baked_is_inspected") else { return };
    let folder = tempdir().unwrap();
    let mut seen = 0;
    let mut folders = vec![data.join("baked")];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let extension = path.extension().unwrap().to_str().unwrap();
            if ["ktx", "ktx2", "hdr", "exr"].contains(&extension) {
                let path = path.to_str().unwrap();
                assert!(succeed(folder.path(), &["inspect", path]).contains(path));
                json(&succeed(folder.path(), &["inspect", path, "--json"]));
                seen += 1;
            }
        }
    }
    assert!(seen >= 13, "{seen}");
    let filament = data.join("baked/B_lightroom_filament/default_env_ibl.ktx");
    let report = json(&succeed(folder.path(), &["inspect", filament.to_str().unwrap(), "--json"]));
    assert_eq!((&report["container"], &report["format"]), (&"KTX1".into(), &"B10g11r11".into()));
    assert_eq!(report["levels"].as_array().unwrap().len(), 5);
    assert_eq!(report["form_factor_nine"].as_array().unwrap().len(), 9);
    let face = data.join("baked/A_pisa_ktx2_gltfIBLSampler/source_cube_faces_threejs/px.hdr");
    let report = json(&succeed(folder.path(), &["inspect", face.to_str().unwrap(), "--json"]));
    assert_eq!(report["files"].as_array().unwrap().len(), 6);
    let cts = data.join("baked/D_ktx2_cube_formats/output_R16G16B16A16_SFLOAT_CUBE_MIP.ktx2");
    let report = json(&succeed(folder.path(), &["inspect", cts.to_str().unwrap(), "--json"]));
    assert!(report["levels"][0]["statistics"]["nan"].as_u64().unwrap() > 0, "{report}");
}

#[test]
fn damaged_textures_give_one_line_each() {
    let Some(data) = data("damaged_textures_give_one_line_each") else { return };
    let folder = tempdir().unwrap();
    let mut count = 0;
    let mut folders = vec![data.join("bad")];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "ktx2" || e == "ktx" || e == "dds") {
                let message = fail(folder.path(), &["convert", path.to_str().unwrap(), "x.dds"]);
                assert_eq!(message.lines().count(), 1, "{message}");
                count += 1;
            }
        }
    }
    assert!(count > 0);
    assert!(names(folder.path()).is_empty());
}
