//! What a bake leaves behind.
#![allow(clippy::unwrap_used)]

mod common;
use common::{ALL_FILES, bake, command, fail, names, run, stdout, succeed};
use lumisphere::image::AXIS_COLOURS;
use lumisphere_codec::{Limits, decode_picture, ktx2};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_bake_is_complete_readable_and_within_the_contract() {
    let folder = tempdir().unwrap();
    // No -o: the folder is named after the environment.
    succeed(folder.path(), &["bake", "--size", "32"]);
    let out = folder.path().join("bake/studio");
    assert_eq!(names(&out), ALL_FILES);
    for name in ALL_FILES.into_iter().filter(|name| *name != "USE.md") {
        let path = format!("bake/studio/{name}");
        assert!(succeed(folder.path(), &["inspect", &path]).contains(name));
        json(&succeed(folder.path(), &["inspect", &path, "--json"]));
    }
    let table = succeed(folder.path(), &["verify", "bake/studio", "--env", "builtin:studio", "--texels", "64"]);
    assert!(table.contains("PASS") && !table.contains("FAIL"), "{table}");
}

#[test]
fn adjustments_and_formats_are_redone_by_verify() {
    let folder = tempdir().unwrap();
    let adjusted =
        ["--rotate", "30,-20,10", "--exposure", "-1.5", "--lower-hemisphere", "0.1,0.2,0.3", "--format", "rgba32f"];
    bake(
        folder.path(),
        "builtin:studio?height=64",
        "out",
        &[&adjusted[..], &["--sh-bands", "4", "--compress", "zstd"]].concat(),
    );
    let text =
        succeed(folder.path(), &["verify", "out", "--env", "builtin:studio?height=64", "--texels", "32", "--json"]);
    assert_eq!(json(&text)["passed"], true, "{text}");
}

#[test]
fn lighting_of_another_environment_fails() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:studio?height=64", "a", &[]);
    bake(folder.path(), "builtin:axes?height=64", "b", &[]);
    let verify = ["verify", "a", "--env", "builtin:studio?height=64", "--texels", "16", "--json"];
    for name in ["specular.ktx2", "irradiance.ktx2", "sh.json"] {
        let place = folder.path().join("a").join(name);
        let own = std::fs::read(&place).unwrap();
        std::fs::copy(folder.path().join("b").join(name), &place).unwrap();
        let output = run(folder.path(), &verify);
        assert_eq!(output.status.code(), Some(1), "{name}: {}", stdout(&output));
        assert_eq!(json(&stdout(&output))["passed"], false);
        std::fs::write(&place, own).unwrap();
    }
    assert_eq!(run(folder.path(), &verify).status.code(), Some(0));
}

#[test]
fn a_table_of_another_masking_fails() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:furnace?height=16", "a", &[]);
    bake(folder.path(), "builtin:furnace?height=16", "b", &["--masking", "v-cavity"]);
    std::fs::copy(folder.path().join("b/dfg.ktx2"), folder.path().join("a/dfg.ktx2")).unwrap();
    let output = run(folder.path(), &["verify", "a", "--env", "builtin:furnace?height=16", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let report = json(&stdout(&output));
    assert_eq!((&report["dfg"]["passed"], &report["sh"]["passed"]), (&Value::Bool(false), &Value::Bool(true)));
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:sky?height=64", "one", &["--threads", "1"]);
    bake(folder.path(), "builtin:sky?height=64", "two", &["--threads", "2"]);
    for name in ALL_FILES {
        let read = |run: &str| std::fs::read(folder.path().join(run).join(name)).unwrap();
        let (mut one, mut two) = (read("one"), read("two"));
        if name == "bake.json" {
            let without_timings = |bytes: &[u8]| {
                let mut record: Value = serde_json::from_slice(bytes).unwrap();
                assert!(record.as_object_mut().unwrap().remove("timings").is_some());
                record.to_string().into_bytes()
            };
            (one, two) = (without_timings(&one), without_timings(&two));
        }
        assert!(one == two, "{name}");
    }
}

#[test]
fn only_makes_what_is_asked_for() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:studio?height=32", "out", &["--only", "sh,dfg"]);
    assert_eq!(names(&folder.path().join("out")), ["USE.md", "bake.json", "dfg.ktx2", "sh.json"]);
    succeed(folder.path(), &["verify", "out", "--env", "builtin:studio?height=32"]);
    bake(folder.path(), "builtin:studio?height=32", "picture", &["--only", "preview"]);
    assert_eq!(names(&folder.path().join("picture")), ["USE.md", "bake.json", "preview.png"]);
}

#[test]
fn json_holds_the_record() {
    let folder = tempdir().unwrap();
    let said = json(&bake(folder.path(), "builtin:one-texel?height=64", "out", &["--json"]));
    assert_eq!(said["directory"], "out");
    assert_eq!(said["levels"].as_array().unwrap().len(), said["settings"]["level_count"].as_u64().unwrap() as usize);
    let stored = json(&std::fs::read_to_string(folder.path().join("out/bake.json")).unwrap());
    assert_eq!(said["files"], stored["files"]);
    assert_eq!(stored["input"]["statistics"]["brightest"]["share"], 1.0);
}

#[test]
fn too_bright_for_halves_goes_to_floats_and_says_so() {
    let folder = tempdir().unwrap();
    let summary = bake(folder.path(), "builtin:furnace?height=16", "out", &["--exposure", "17"]);
    assert!(summary.contains("rgba32f") && summary.contains("65504"), "{summary}");
    assert!(succeed(folder.path(), &["inspect", "out/skybox.ktx2"]).contains("Rgba32F"));
    // Asked for, halves are used, and what they cannot hold is counted.
    let clamped = bake(folder.path(), "builtin:furnace?height=16", "out", &["--exposure", "17", "--format", "rgba16f"]);
    assert!(clamped.contains("clamped"), "{clamped}");
}

#[test]
fn the_skybox_has_each_axis_on_its_face() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:axes?height=256", "out", &["--format", "rgba32f", "--skybox-size", "128"]);
    let texture = read_ktx2(&folder.path().join("out/skybox.ktx2"));
    let size = texture.width;
    for (face, colour) in AXIS_COLOURS.into_iter().enumerate() {
        let found = texture.levels[0][(face * size + size / 2) * size + size / 2];
        // Between sign and letter the label leaves the middle free; the mean of equal texels is exact to rounding.
        assert!((0..3).all(|c| (found[c] - colour[c]).abs() < 1e-6), "face {face}: {found:?} {colour:?}");
    }
}

#[test]
fn a_turn_by_a_quarter_moves_the_axes() {
    let folder = tempdir().unwrap();
    // +90° about +Y takes +X to -Z and +Z to +X.
    bake(
        folder.path(),
        "builtin:axes?height=256",
        "out",
        &["--format", "rgba32f", "--skybox-size", "128", "--rotate", "90"],
    );
    let texture = read_ktx2(&folder.path().join("out/skybox.ktx2"));
    let size = texture.width;
    for (face, source) in [(5, 0), (0, 4), (2, 2)] {
        let found = texture.levels[0][(face * size + size / 2) * size + size / 2];
        assert!((0..3).all(|c| (found[c] - AXIS_COLOURS[source][c]).abs() < 1e-6), "{face} {found:?}");
    }
}

fn read_ktx2(path: &Path) -> lumisphere_codec::DecodedTexture {
    ktx2::decode(&std::fs::read(path).unwrap(), &Limits::default()).unwrap()
}

#[test]
fn the_preview_shows_the_panorama_the_right_way_round() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:axes?height=256", "out", &[]);
    let picture =
        decode_picture(&std::fs::read(folder.path().join("out/preview.png")).unwrap(), &Limits::default()).unwrap();
    let at = |x: usize, y: usize| picture.texels[y * picture.width + x];
    // The panorama's middle row, 240 rows below its top at 32: -Z, +X, +Z at a quarter, a half and three quarters.
    let colour_at = |u: f64| at(32 + (u * 960.0) as usize, 272);
    assert!(colour_at(0.5)[0] > 5.0 * colour_at(0.5)[2], "+X is red");
    assert!(colour_at(0.75)[2] > 5.0 * colour_at(0.75)[0], "+Z is blue");
    assert!(
        colour_at(0.25)[0] > 5.0 * colour_at(0.25)[2] && colour_at(0.25)[1] > 5.0 * colour_at(0.25)[2],
        "-Z is yellow"
    );
}

#[test]
fn a_folder_that_is_a_file_is_refused() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("out"), b"mine").unwrap();
    let message = fail(folder.path(), &["bake", "builtin:furnace?height=16", "-o", "out", "--size", "8"]);
    assert!(message.starts_with("error: out: "), "{message}");
    assert_eq!(std::fs::read(folder.path().join("out")).unwrap(), b"mine");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_all_files_or_none() {
    use std::time::Duration;
    let folder = tempdir().unwrap();
    let (mut whole, mut interrupted) = (0, 0);
    for attempt in 0..12_u64 {
        let name = format!("out{attempt}");
        let arguments = ["bake", "builtin:studio?height=128", "-o", &name, "--size", "64", "--quiet"];
        let mut child = command(folder.path(), &arguments).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(20 + attempt * 25));
        let _ = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let status = child.wait().unwrap();
        let out = folder.path().join(&name);
        if out.exists() {
            assert_eq!(names(&out), ALL_FILES, "{status:?}");
            whole += 1;
        } else {
            assert!(!status.success(), "{status:?}");
            interrupted += 1;
        }
    }
    assert!(interrupted > 0, "no attempt was interrupted: {whole} were whole");
}
