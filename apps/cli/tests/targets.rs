//! Targets, overrides, many environments and resuming, as a user sees them.
#![allow(clippy::unwrap_used)]

mod common;
use common::{SMALL, data, fail, names, run, stderr, stdout, succeed};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

const AXES: &str = "builtin:axes?height=256";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn record(folder: &Path) -> Value {
    json(&std::fs::read_to_string(folder.join("bake.json")).unwrap())
}

fn bake(folder: &Path, arguments: &[&str]) -> String {
    let all: Vec<&str> = ["bake"].iter().chain(arguments).chain(&SMALL).copied().collect();
    succeed(folder, &all)
}

fn all_targets(folder: &Path) -> Vec<Value> {
    json(&succeed(folder, &["targets", "--json"])).as_array().unwrap().clone()
}

#[test]
fn one_bake_serves_every_target_with_what_the_list_promises() {
    let folder = tempdir().unwrap();
    let targets = all_targets(folder.path());
    let words: Vec<&str> = targets.iter().map(|t| t["name"].as_str().unwrap()).collect();
    for engine in ["khronos", "bevy", "filament", "three", "babylon", "unity", "unreal", "godot", "gltf", "raw"] {
        assert!(words.contains(&engine), "{words:?}");
    }
    bake(folder.path(), &[AXES, "-t", &words.join(","), "-o", "all"]);
    for target in &targets {
        let own = folder.path().join("all").join(target["name"].as_str().unwrap());
        let mut expected: Vec<String> = vec!["USE.md".into(), "bake.json".into()];
        expected.extend(target["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap().to_owned()));
        expected.sort();
        assert_eq!(names(&own), expected);
        let record = record(&own);
        assert_eq!(record["settings"]["target"], target["name"]);
        assert_eq!(record["settings"]["turn"], target["turn"]);
        assert_eq!(record["settings"]["overrides"].as_array().map(Vec::len), Some(1), "size alone: {record}");
        let usage = std::fs::read_to_string(own.join("USE.md")).unwrap();
        let engine = target["engine"].as_str().unwrap();
        assert!(usage.contains(engine) && usage.contains("```"), "{usage}");
    }
}

#[test]
fn a_target_is_the_same_alone_and_among_others() {
    let folder = tempdir().unwrap();
    bake(folder.path(), &[AXES, "-t", "khronos,filament", "-o", "both"]);
    for (target, file) in [("khronos", "specular.ktx2"), ("filament", "environment_ibl.ktx")] {
        bake(folder.path(), &[AXES, "-t", target, "-o", target]);
        let read = |path: &str| std::fs::read(folder.path().join(path)).unwrap();
        assert!(read(&format!("both/{target}/{file}")) == read(&format!("{target}/{file}")), "{target}");
    }
}

#[test]
fn choices_by_hand_replace_those_of_the_target_and_are_recorded() {
    let folder = tempdir().unwrap();
    let by_hand = ["--curve", "linear", "--turn", "z y -x", "--format", "rgb9e5", "--only", "specular"];
    bake(folder.path(), &[&[AXES, "-t", "filament", "-o", "out"][..], &by_hand].concat());
    let out = folder.path().join("out");
    assert_eq!(names(&out), ["USE.md", "bake.json", "environment_ibl.ktx"]);
    let settings = &record(&out)["settings"];
    let overrides: Vec<&str> = settings["overrides"].as_array().unwrap().iter().map(|o| o.as_str().unwrap()).collect();
    assert_eq!(overrides, ["size", "curve", "turn", "format", "only"]);
    assert_eq!((&settings["turn"], &settings["curve"]), (&"z y -x".into(), &"linear".into()));
    let inspected = json(&succeed(folder.path(), &["inspect", "out/environment_ibl.ktx", "--json"]));
    assert!(inspected["format"].as_str().unwrap().contains("Rgb9e5"), "{inspected}");
    assert_eq!(record(&out)["levels"][1]["perceptual_roughness"], 0.5);
}

#[test]
fn listed_roughness_is_what_the_levels_stand_for() {
    let folder = tempdir().unwrap();
    bake(folder.path(), &[AXES, "-o", "out", "--roughness", "0,0.2,0.5,1"]);
    let levels = record(&folder.path().join("out"))["levels"].clone();
    let p: Vec<f64> = levels.as_array().unwrap().iter().map(|l| l["perceptual_roughness"].as_f64().unwrap()).collect();
    assert_eq!(p, [0.0, 0.2, 0.5, 1.0]);
    let message = fail(folder.path(), &["bake", AXES, "--roughness", "0.1,1", "--size", "32"]);
    assert!(message.contains("listed roughness"), "{message}");
}

#[test]
fn an_unknown_target_is_told_the_nearest() {
    let folder = tempdir().unwrap();
    let message = fail(folder.path(), &["bake", AXES, "-t", "filamnet"]);
    assert!(message.contains("did you mean \"filament\""), "{message}");
    assert!(fail(folder.path(), &["bake", AXES, "-t", "raw,raw"]).contains("twice"));
    assert!(fail(folder.path(), &["bake", AXES, "--turn", "x x z"]).contains("expected x, y and z"));
}

#[test]
fn every_arrangement_and_every_form_of_the_table_is_written() {
    let folder = tempdir().unwrap();
    for (arrange, first) in [
        ("lat-long", "specular.exr"),
        ("octahedral", "specular.exr"),
        ("strip", "specular_level0.exr"),
        ("column", "specular_level2.exr"),
        ("horizontal-cross", "specular_level0.exr"),
        ("vertical-cross", "specular_level1.exr"),
        ("faces", "specular_level0_px.exr"),
        ("faces-inside", "specular_level1_nz.exr"),
    ] {
        let only = ["--only", "specular,skybox"];
        bake(folder.path(), &[&[AXES, "-o", arrange, "--container", "exr", "--arrange", arrange][..], &only].concat());
        assert!(names(&folder.path().join(arrange)).contains(&first.to_owned()), "{arrange}");
    }
    for (dfg, name) in [
        ("ktx2", "dfg.ktx2"),
        ("dds", "dfg.dds"),
        ("exr", "dfg.exr"),
        ("png", "dfg.png"),
        ("glsl", "dfg.glsl"),
        ("hlsl", "dfg.hlsl"),
        ("wgsl", "dfg.wgsl"),
        ("c", "dfg.h"),
        ("rust", "dfg.rs"),
    ] {
        bake(folder.path(), &[AXES, "-o", "dfg", "--dfg", dfg, "--only", "dfg"]);
        assert!(names(&folder.path().join("dfg")).contains(&name.to_owned()), "{dfg}");
    }
}

#[test]
fn six_faces_are_read_back_as_the_cube_they_were() {
    let folder = tempdir().unwrap();
    let faces = ["--container", "exr", "--arrange", "faces-inside", "--only", "skybox", "--skybox-size", "64"];
    bake(folder.path(), &[&[AXES, "-o", "faces"][..], &faces].concat());
    bake(folder.path(), &["faces/skybox_nx.exr", "-o", "again", "--only", "skybox", "--skybox-size", "64"]);
    bake(folder.path(), &[AXES, "-o", "straight", "--only", "skybox", "--skybox-size", "64"]);
    assert_eq!(record(&folder.path().join("again"))["input"]["layout"], "cube");
    let texels = |name: &str| {
        let bytes = std::fs::read(folder.path().join(name).join("skybox.ktx2")).unwrap();
        lumisphere_codec::decode_texture(&bytes, &lumisphere_codec::Limits::default()).unwrap().levels.remove(0)
    };
    let difference = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        let sum: f32 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).sum();
        sum / (4 * a.len()) as f32
    };
    // The cube goes through a lat-long picture twice as fine: edges between colours are a little softer.
    assert!(difference(&texels("again"), &texels("straight")) < 0.01);
    bake(
        folder.path(),
        &["faces/skybox_px.exr", "-o", "wrong", "--faces", "stored", "--only", "skybox", "--skybox-size", "64"],
    );
    assert!(difference(&texels("wrong"), &texels("straight")) > 0.05);
}

/// A folder with two pictures and one that is damaged.
fn three_pictures(folder: &Path) {
    bake(folder, &[AXES, "-t", "godot", "-o", "first", "--only", "panorama"]);
    bake(folder, &["builtin:studio?height=64", "-t", "unreal", "-o", "second", "--only", "panorama"]);
    std::fs::create_dir(folder.join("pictures")).unwrap();
    std::fs::copy(folder.join("first/panorama.exr"), folder.join("pictures/a.exr")).unwrap();
    std::fs::copy(folder.join("second/environment.hdr"), folder.join("pictures/c.hdr")).unwrap();
    std::fs::write(folder.join("pictures/b.hdr"), b"#?RADIANCE\nnothing more").unwrap();
    std::fs::write(folder.join("pictures/notes.txt"), b"no picture").unwrap();
}

#[test]
fn a_failure_does_not_stop_the_others_and_is_told_at_the_end() {
    let folder = tempdir().unwrap();
    three_pictures(folder.path());
    let arguments: Vec<&str> = ["bake", "pictures", "-o", "out"].iter().chain(&SMALL).copied().collect();
    let output = run(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(names(&folder.path().join("out")), ["a", "c"]);
    let errors = stderr(&output);
    let lines: Vec<&str> = errors.lines().collect();
    assert!(lines.len() == 2 && lines[0].contains("b.hdr") && lines[1].contains("1 of 3"), "{errors}");
    assert_eq!(stdout(&output).lines().count(), 3);
}

#[test]
fn resuming_leaves_out_what_is_done_and_nothing_else() {
    let folder = tempdir().unwrap();
    three_pictures(folder.path());
    std::fs::remove_file(folder.path().join("pictures/b.hdr")).unwrap();
    let states = |more: &[&str]| -> Vec<String> {
        let output = bake(folder.path(), &[&["pictures", "-o", "out", "--resume", "--json"][..], more].concat());
        let all = json(&output)["environments"].as_array().unwrap().clone();
        all.iter().map(|e| e["status"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(states(&[]), ["baked", "baked"]);
    assert_eq!(states(&[]), ["up to date", "up to date"]);
    // Another picture of the same name.
    std::fs::copy(folder.path().join("first/panorama.exr"), folder.path().join("pictures/c.hdr")).unwrap();
    assert_eq!(states(&[]), ["up to date", "baked"]);
    // A file that has gone.
    std::fs::remove_file(folder.path().join("out/a/sh.json")).unwrap();
    assert_eq!(states(&[]), ["baked", "up to date"]);
    // Another setting.
    assert_eq!(states(&["--exposure", "1"]), ["baked", "baked"]);
    assert_eq!(states(&["--exposure", "1"]), ["up to date", "up to date"]);
}

#[test]
fn a_model_carries_its_light() {
    let folder = tempdir().unwrap();
    let message = fail(folder.path(), &["bake", AXES, "--model", "x.glb"]);
    assert!(message.contains("--target gltf"), "{message}");
    let Some(data) = data("a_model_carries_its_light") else { return };
    let model = data.join("gltf/BoxVertexColors.glb").display().to_string();
    bake(folder.path(), &[AXES, "-t", "gltf", "--model", &model, "-o", "out"]);
    let bytes = std::fs::read(folder.path().join("out/environment.glb")).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let asset = json(std::str::from_utf8(&bytes[20..20 + length]).unwrap());
    assert!(asset["meshes"].as_array().is_some_and(|m| !m.is_empty()));
    assert!(asset["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"].is_array());
}

#[test]
fn fitted_levels_are_what_verify_expects_of_them() {
    let folder = tempdir().unwrap();
    let environment = "builtin:studio?height=256";
    bake(
        folder.path(),
        &[environment, "-t", "filament", "--fit", "--format", "rgba32f", "--only", "specular", "-o", "out"],
    );
    let verify = ["verify", "out", "--env", environment, "--texels", "24", "--json"];
    let report = json(&succeed(folder.path(), &verify));
    assert_eq!(report["passed"], true, "{report}");
    // Negative control: against exact lobes they are as far off as the fit moved them.
    let path = folder.path().join("out/bake.json");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"fit\": true", "\"fit\": false")).unwrap();
    assert_eq!(run(folder.path(), &verify).status.code(), Some(1));
}

#[test]
fn a_format_by_hand_reaches_every_texture_and_claims_nothing() {
    let folder = tempdir().unwrap();
    let texels = |name: &str, file: &str| record(&folder.path().join(name))["files"][file]["texels"].clone();
    let said = bake(folder.path(), &[AXES, "-o", "floats", "--format", "rgba32f"]);
    assert_eq!((texels("floats", "specular.ktx2"), texels("floats", "dfg.ktx2")), ("Rgba32F".into(), "Rg32F".into()));
    // Nothing of the axes is above 65504.
    assert!(!said.contains("65504"), "{said}");
    bake(folder.path(), &[AXES, "-o", "auto", "-t", "khronos", "--format", "auto"]);
    assert_eq!(texels("auto", "specular.ktx2"), "Rgba16F");
    // Negative control: where it is the picture that asks for floats, that is said.
    let said = bake(folder.path(), &[AXES, "-o", "bright", "--exposure", "20"]);
    assert_eq!(texels("bright", "dfg.ktx2"), "Rg32F");
    assert!(said.contains("65504"), "{said}");
}

#[test]
fn an_arrangement_without_a_picture_is_refused() {
    let folder = tempdir().unwrap();
    let message = fail(folder.path(), &["bake", AXES, "--size", "32", "--arrange", "strip"]);
    assert!(message.contains("--container hdr or exr"), "{message}");
    bake(folder.path(), &[AXES, "-o", "out", "--arrange", "column", "--container", "hdr", "--only", "specular"]);
    let overrides = record(&folder.path().join("out"))["settings"]["overrides"].clone();
    assert_eq!(overrides, serde_json::json!(["size", "container", "arrange", "only"]));
}
