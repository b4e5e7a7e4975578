//! `verify` on bakes for every target, and on files that other tools baked.
#![allow(clippy::unwrap_used)]

mod common;
use common::{bake, data, fail, run, stdout, succeed};
use serde_json::Value;
use std::ops::Range;
use std::path::Path;
use tempfile::{TempDir, tempdir};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The report of a verify that may fail.
fn report(folder: &Path, arguments: &[&str]) -> Value {
    let all: Vec<&str> = ["verify"].iter().chain(arguments).chain(&["--json"]).copied().collect();
    let output = run(folder, &all);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {}", common::stderr(&output));
    let report = json(&stdout(&output));
    assert_eq!(report["passed"], output.status.success(), "{report}");
    report
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

fn in_range(what: &str, value: &Value, range: Range<f64>) {
    assert!(range.contains(&number(value)), "{what}: {value} is not in {range:?}");
}

const SMALL: &str = "builtin:studio?height=64";

#[test]
fn bakes_for_several_targets_pass_and_those_of_another_picture_fail() {
    let folder = tempdir().unwrap();
    let targets = ["--target", "bevy,filament,babylon,unreal"];
    bake(folder.path(), SMALL, "all", &targets);
    let found = report(folder.path(), &["all", "--env", SMALL, "--texels", "16"]);
    assert_eq!(found["passed"], true, "{found:#}");
    let bakes = found["bakes"].as_array().unwrap();
    assert_eq!(bakes.len(), 4);
    for bake in bakes {
        assert_eq!(bake["unmeasured"], Value::Array(Vec::new()), "{bake}");
        assert!(!bake["levels"].as_array().unwrap().is_empty(), "{bake}");
    }
    let of = |name: &str| bakes.iter().find(|b| b["target"] == name).unwrap();
    assert!(of("filament")["irradiance_sh"]["passed"] == true && of("babylon")["irradiance_sh"]["passed"] == true);
    assert!(of("unreal")["panorama"]["passed"] == true && of("unreal")["sh"]["passed"] == true);
    assert!(of("bevy")["skybox"]["passed"] == true && of("bevy")["irradiance"]["passed"] == true);
    // One of them, by its own path, is cut like its siblings.
    assert_eq!(report(folder.path(), &["all/filament", "--env", SMALL, "--texels", "16"])["passed"], true);
    for name in ["all/bevy", "all/unreal"] {
        let wrong = report(folder.path(), &[name, "--env", "builtin:axes?height=64", "--texels", "4"]);
        assert_eq!(wrong["passed"], false, "{wrong:#}");
        assert!(wrong["levels"].as_array().unwrap().iter().all(|level| level["passed"] == false), "{wrong:#}");
    }
}

#[test]
fn pictures_of_chains_are_read_back() {
    let folder = tempdir().unwrap();
    for (name, container, arrange) in [
        ("a", "exr", "horizontal-cross"),
        ("b", "hdr", "vertical-cross"),
        ("c", "exr", "strip"),
        ("d", "exr", "lat-long"),
        ("e", "hdr", "octahedral"),
    ] {
        bake(folder.path(), SMALL, name, &["--container", container, "--arrange", arrange]);
        let found = report(folder.path(), &[name, "--env", SMALL, "--texels", "16"]);
        assert_eq!(found["passed"], true, "{arrange}: {found:#}");
        // Irradiance that is read between the texels of a cube is not what a texel sum is held against.
        let in_one_piece = matches!(arrange, "lat-long" | "octahedral");
        assert_eq!(found["unmeasured"].as_array().unwrap().len(), usize::from(in_one_piece), "{arrange}");
        assert_eq!((found["irradiance"].is_object(), found["skybox"].is_object()), (!in_one_piece, true));
        assert_eq!(found["levels"].as_array().unwrap().len(), 3);
    }
    bake(folder.path(), SMALL, "f", &["--container", "exr", "--arrange", "faces"]);
    let text = succeed(folder.path(), &["verify", "f", "--env", SMALL, "--texels", "16"]);
    assert!(text.contains("not measured"), "{text}");
}

#[test]
fn a_turn_that_is_not_the_record_s_fails() {
    let folder = tempdir().unwrap();
    bake(folder.path(), SMALL, "a", &["--turn", "y z x"]);
    bake(folder.path(), SMALL, "b", &[]);
    for name in ["specular.ktx2", "irradiance.ktx2", "skybox.ktx2"] {
        assert_eq!(report(folder.path(), &["a", "--env", SMALL, "--texels", "16"])["passed"], true);
        let place = folder.path().join("a").join(name);
        let own = std::fs::read(&place).unwrap();
        std::fs::copy(folder.path().join("b").join(name), &place).unwrap();
        assert_eq!(report(folder.path(), &["a", "--env", SMALL, "--texels", "16"])["passed"], false, "{name}");
        std::fs::write(&place, own).unwrap();
    }
}

#[test]
fn a_file_that_is_missing_is_named() {
    let folder = tempdir().unwrap();
    bake(folder.path(), SMALL, "a", &[]);
    std::fs::remove_file(folder.path().join("a/irradiance.ktx2")).unwrap();
    let message = fail(folder.path(), &["verify", "a", "--env", SMALL]);
    assert!(message.contains("irradiance.ktx2") && message.contains("bake.json lists it"), "{message}");
}

/// Our own files as if another tool had made them: without the record.
#[test]
fn single_files_are_measured_and_their_turn_is_found() {
    let folder = tempdir().unwrap();
    let p = folder.path();
    bake(p, SMALL, "out", &["--curve", "quadratic", "--container", "ktx1", "--format", "rgb9e5"]);
    let check = |arguments: &[&str]| {
        let all: Vec<&str> = arguments.iter().chain(&["--env", SMALL, "--texels", "16"]).copied().collect();
        report(p, &all)
    };
    // Our metadata tells the roughness.
    let found = check(&["out/specular.ktx"]);
    assert_eq!(found["passed"], true, "{found:#}");
    assert_eq!(found["harmonics"]["passed"], true);
    assert_eq!(check(&["out/irradiance.ktx", "--holds", "irradiance"])["passed"], true);
    assert_eq!(check(&["out/skybox.ktx", "--holds", "skybox"])["passed"], true);
    assert_eq!(check(&["out/specular.ktx", "--curve", "linear"])["passed"], false);
    // The wrong unit is noticed.
    let wrong = check(&["out/irradiance.ktx", "--holds", "form-factor"]);
    assert!(wrong["passed"] == false && wrong["hints"][0].as_str().unwrap().contains("--holds irradiance"), "{wrong}");

    // DDS says nothing of itself.
    succeed(p, &["convert", "out/specular.ktx", "turned.dds", "--turn", "-z y x"]);
    let straight = check(&["turned.dds", "--target", "filament"]);
    assert_eq!((&straight["passed"], &straight["orientation"]["given_is_wrong"]), (&false.into(), &true.into()));
    assert_eq!(straight["orientation"]["best"], "-z y x", "{straight:#}");
    let told = check(&["turned.dds", "--target", "filament", "--turn", "-z y x"]);
    assert_eq!((&told["passed"], &told["orientation"]["given_is_wrong"]), (&true.into(), &false.into()), "{told:#}");
}

#[test]
fn what_cannot_be_measured_is_one_line() {
    let folder = tempdir().unwrap();
    let p = folder.path();
    bake(p, "builtin:furnace?height=16", "out", &[]);
    succeed(p, &["convert", "out/specular.ktx2", "silent.dds"]);
    let cases: [(&[&str], &str); 7] = [
        (&["out/preview.png"], "folder of a bake"),
        (&["out/bake.json"], "another kind of file"),
        (&["out/dfg.ktx2"], "expected a cube"),
        (&["out/skybox.ktx2"], "--holds"),
        (&["silent.dds"], "--curve"),
        (&["silent.dds", "--target", "filamnt"], "did you mean"),
        (&["out", "--turn", "x y z"], "bake.json"),
    ];
    for (arguments, hint) in cases {
        let all: Vec<&str> =
            ["verify"].iter().chain(arguments).chain(&["--env", "builtin:furnace?height=16"]).copied().collect();
        let message = fail(p, &all);
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.contains(hint), "{arguments:?}: {message}");
    }
}

/// The room that cmgen baked, small enough for a test: the figures below are those of the full picture, 2048x1024, within
/// the ranges.
fn room(data: &Path) -> TempDir {
    let folder = tempdir().unwrap();
    let picture = data.join("hdri/lightroom_14b.hdr");
    let picture = picture.to_str().unwrap();
    succeed(folder.path(), &["convert", picture, "room.exr", "--arrange", "lat-long", "--size", "128"]);
    folder
}

#[test]
fn the_faults_of_cmgen_show_in_the_figures() {
    let Some(data) = data("the_faults_of_cmgen_show_in_the_figures") else { return };
    let folder = room(&data);
    let file = data.join("baked/B_lightroom_filament/default_env_ibl.ktx");
    let file = file.to_str().unwrap();
    let arguments = [file, "--env", "room.exr", "--target", "filament", "--turn", "z y -x", "--texels", "256"];
    let found = report(folder.path(), &arguments);
    assert_eq!((&found["passed"], &found["orientation"]["given_is_wrong"]), (&false.into(), &false.into()));
    // Half a texel of shift: some percent at each level, ten times what the texel format leaves.
    for level in found["levels"].as_array().unwrap().iter().skip(1) {
        in_range("level", &level["relative_rms"], 0.03..0.2);
        in_range("format", &level["format_rms"], 0.003..0.007);
        in_range("energy", &level["energy"], 0.9..1.06);
    }
    // Its window of the fourth power of sinc; the brightness of the whole is half a percent off.
    let bands = found["harmonics"]["bands"].as_array().unwrap();
    in_range("band 0", &bands[0]["factor"], 1.003..1.007);
    in_range("band 1", &bands[1]["factor"], 0.960..0.968);
    in_range("band 2", &bands[2]["factor"], 0.848..0.858);
    in_range("the rest of band 2", &bands[2]["rest"], 0.0..0.02);
    assert_eq!(found["harmonics"]["orientation"]["best"], "z y -x");
    // Not told how it is turned, both the cube and the harmonics tell.
    let straight = report(folder.path(), &[file, "--env", "room.exr", "--target", "filament", "--texels", "16"]);
    assert_eq!(straight["orientation"]["best"], "z y -x");
    assert_eq!(straight["harmonics"]["orientation"]["best"], "z y -x");
    in_range("wrong turn", &straight["levels"][2]["relative_rms"], 0.5..100.0);
}

#[test]
fn the_faults_of_the_gltf_sampler_show_in_the_figures() {
    let Some(data) = data("the_faults_of_the_gltf_sampler_show_in_the_figures") else { return };
    let folder = tempdir().unwrap();
    let place = data.join("baked/A_pisa_ktx2_gltfIBLSampler");
    let path = |name: &str| place.join(name).to_str().unwrap().to_owned();
    let (file, panorama) = (path("pisa_diffuse_rgb9e5_zstd.ktx2"), path("source_latlong_probulator_pisa.hdr"));
    let face = path("source_cube_faces_threejs/px.hdr");
    let check = |environment: &str, more: &[&str]| {
        let all: Vec<&str> = [file.as_str(), "--env", environment].iter().chain(more).copied().collect();
        report(folder.path(), &all)
    };
    let found = check(&panorama, &["--holds", "form-factor"]);
    // Samples and no solid angles: 2 % of error, ten times the texel format's, and 1 % too bright.
    in_range("relative RMS", &found["irradiance"]["relative_rms"], 0.01..0.03);
    in_range("energy", &found["irradiance"]["energy"], 1.005..1.02);
    in_range("format", &found["irradiance"]["format_rms"], 0.0005..0.0015);
    assert_eq!((&found["orientation"]["best"], &found["passed"]), (&"x y z".into(), &false.into()));
    // The same cube from its six faces, seen from inside; as graphics APIs store them, the world is mirrored.
    assert_eq!(check(&face, &["--holds", "form-factor"])["orientation"]["best"], "x y z");
    let stored = check(&face, &["--holds", "form-factor", "--faces", "stored"]);
    assert_eq!(
        (&stored["orientation"]["best"], &stored["orientation"]["given_is_wrong"]),
        (&"x y -z".into(), &true.into())
    );
    // E/pi taken for E.
    let unit = check(&panorama, &["--holds", "irradiance"]);
    assert!(unit["hints"][0].as_str().unwrap().contains("--holds form-factor"), "{unit}");
    in_range("energy of the wrong unit", &unit["irradiance"]["energy"], 0.31..0.33);
}
