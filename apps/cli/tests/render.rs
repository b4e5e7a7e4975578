//! `lumisphere render` and `lumisphere inspect` of scenes.
#![allow(clippy::unwrap_used)]

mod common;
use common::{data, fail, names, succeed};
use lumisphere::image::Picture;
use lumisphere_codec::{Limits, decode_picture, exr};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

/// A white surface in a uniform environment of 1: what the layered material and 64 samples in each of 24² pixels leave.
const FURNACE_ERROR: f64 = 5e-3;
/// A white ball of radius 0.7 or so: an octahedron is convex, and that is all the furnace asks for.
const WHITE_OBJ: &str = "mtllib white.mtl
v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1
usemtl white
f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6
";

fn picture(path: &Path) -> Picture {
    decode_picture(&std::fs::read(path).unwrap(), &Limits::default()).unwrap()
}

fn layer(path: &Path, name: &str) -> Picture {
    exr::decode_layer(&std::fs::read(path).unwrap(), name, &Limits::default()).unwrap().unwrap()
}

/// `render` with few samples.
fn render(folder: &Path, scene: &str, more: &[&str]) -> String {
    let arguments: Vec<&str> =
        ["render", scene, "--reference", "--size", "24x16", "--samples", "4"].iter().chain(more).copied().collect();
    succeed(folder, &arguments)
}

#[test]
fn a_picture_is_made_in_each_format_with_layers_beside() {
    let folder = tempdir().unwrap();
    let said = render(folder.path(), "builtin:sphere", &["--aov", "normal,albedo,depth,variance"]);
    assert!(said.contains("builtin:studio, as the scene has no light of its own"), "{said}");
    let last = said.lines().last().unwrap();
    for part in ["wrote     sphere.png (24x16, exposure ", "4 samples, noise ", " s, ", "samples/s"] {
        assert!(last.contains(part), "{part} in {last}");
    }
    let layers = ["sphere.albedo.exr", "sphere.depth.exr", "sphere.normal.exr", "sphere.png", "sphere.variance.exr"];
    assert_eq!(names(folder.path()), layers);
    for name in layers {
        let picture = picture(&folder.path().join(name));
        assert_eq!((picture.width, picture.height), (24, 16), "{name}");
    }
    // The middle of the ball of radius 1 is seen from 6 m away, head on.
    let middle = |name: &str| picture(&folder.path().join(name)).texels[8 * 24 + 12];
    assert!((middle("sphere.depth.exr")[0] - 5.0).abs() < 0.05, "{:?}", middle("sphere.depth.exr"));
    assert!(middle("sphere.normal.exr")[2] > 0.98, "{:?}", middle("sphere.normal.exr"));
    assert!(middle("sphere.albedo.exr").iter().all(|c| (c - 0.5).abs() < 1e-6));
    assert!(middle("sphere.variance.exr")[1] > 0.0);

    for name in ["in/a.exr", "in/a.hdr"] {
        render(folder.path(), "builtin:sphere", &["-o", name]);
        assert_eq!(picture(&folder.path().join(name)).width, 24);
    }
    let (exr, hdr) = (picture(&folder.path().join("in/a.exr")), picture(&folder.path().join("in/a.hdr")));
    // RGBE keeps 8 bits of the largest channel.
    let near = |(a, b): (&[f32; 3], &[f32; 3])| (a[1] - b[1]).abs() <= a.iter().fold(0.0_f32, |m, c| m.max(*c)) / 128.0;
    assert!(exr.texels.iter().zip(&hdr.texels).all(near));
}

#[test]
fn an_exr_holds_its_layers_itself_and_its_variance_is_found_there() {
    let folder = tempdir().unwrap();
    let all = ["--aov", "normal,albedo,depth,variance"];
    render(folder.path(), "builtin:sphere", &[&all[..], &["-o", "a.exr"]].concat());
    render(folder.path(), "builtin:sphere", &[&all[..], &["-o", "b.hdr"]].concat());
    let beside = ["b.albedo.exr", "b.depth.exr", "b.hdr", "b.normal.exr", "b.variance.exr"];
    assert_eq!(names(folder.path()), [&["a.exr"][..], &beside].concat());
    let path = |name: &str| folder.path().join(name);
    for name in ["normal", "albedo", "depth", "variance"] {
        assert_eq!(layer(&path("a.exr"), name).texels, picture(&path(&format!("b.{name}.exr"))).texels, "{name}");
    }
    // The picture itself is what it is without layers.
    render(folder.path(), "builtin:sphere", &["-o", "c.exr"]);
    assert_eq!(picture(&path("a.exr")).texels, picture(&path("c.exr")).texels);
    // Another seed differs by its noise alone, whether the variance is a layer or a file.
    render(folder.path(), "builtin:sphere", &[&all[..], &["-o", "d.exr", "--seed", "1"]].concat());
    let tested = |variance: [&str; 2]| {
        let fixed = ["compare", "a.exr", "d.exr", "--metric", "z-test", "--json", "--variance", variance[0]];
        succeed(folder.path(), &[&fixed[..], &["--variance-b", variance[1]]].concat())
    };
    assert_eq!(tested(["a.exr", "d.exr"]), tested(["b.variance.exr", "d.exr"]));
}

/// An interrupt ends a run with a checkpoint after the pass; the next run goes on.
#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_is_there() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};
    let folder = tempdir().unwrap();
    let fixed = ["render", "builtin:sphere", "--reference", "--size", "16x16", "-o", "a.png", "--checkpoint", "state"];
    let mut child = common::command(folder.path(), &[&fixed[..], &["--samples", "100000000"]].concat())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    // From the first line on interrupts are caught.
    said.read_line(&mut line).unwrap();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    said.read_to_string(&mut line).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(common::stderr(&output).contains("the same command goes on from the checkpoint"));
    assert!(line.contains("wrote     a.png"), "{line}");
    assert_eq!(names(folder.path()), ["a.png", "state"]);
    let done: u32 = line.split(" samples").next().unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    let more = (done + 3).to_string();
    let said = succeed(folder.path(), &[&fixed[..], &["--samples", &more]].concat());
    assert!(said.contains(&format!("{more} samples ({done} from the checkpoint)")), "{said}");
}

#[test]
fn tone_maps_and_exposures_change_the_display_picture_alone() {
    let folder = tempdir().unwrap();
    let shown = |more: &[&str]| {
        render(folder.path(), "builtin:sphere", &[more, &["-o", "a.png"]].concat());
        std::fs::read(folder.path().join("a.png")).unwrap()
    };
    let neutral = shown(&["--exposure", "0"]);
    assert_eq!(neutral, shown(&["--exposure", "0", "--tonemap", "neutral"]));
    for map in ["agx", "aces", "reinhard", "linear"] {
        assert_ne!(neutral, shown(&["--exposure", "0", "--tonemap", map]), "{map}");
    }
    assert_ne!(neutral, shown(&["--exposure", "-1"]));
}

#[test]
fn bytes_do_not_depend_on_threads_but_on_the_seed() {
    let folder = tempdir().unwrap();
    let traced = |more: &[&str]| {
        render(folder.path(), "builtin:cornell", &[more, &["-o", "a.exr", "--bounces", "3"]].concat());
        std::fs::read(folder.path().join("a.exr")).unwrap()
    };
    let one = traced(&["--threads", "1"]);
    assert_eq!(one, traced(&["--threads", "2"]));
    assert_ne!(one, traced(&["--threads", "2", "--seed", "1"]));
}

#[test]
fn a_checkpoint_goes_on_where_it_ended_and_fits_its_own_picture_only() {
    let folder = tempdir().unwrap();
    let traced = |samples: &str, more: &[&str]| {
        let fixed = ["render", "builtin:sphere", "--reference", "--size", "16x16", "-o", "a.exr", "--samples", samples];
        let said = succeed(folder.path(), &[&fixed[..], more].concat());
        (said, std::fs::read(folder.path().join("a.exr")).unwrap())
    };
    let (_, whole) = traced("12", &[]);
    let (_, half) = traced("5", &["--checkpoint", "state"]);
    assert_ne!(half, whole);
    let (said, resumed) = traced("12", &["--checkpoint", "state"]);
    assert!(said.contains("12 samples (5 from the checkpoint)"), "{said}");
    assert!(resumed == whole, "the same bytes as without a stop");
    let (said, again) = traced("12", &["--checkpoint", "state"]);
    assert!(said.contains("12 samples (12 from the checkpoint)") && again == whole, "{said}");

    let fixed = ["render", "builtin:sphere", "--reference", "-o", "a.exr", "--checkpoint", "state", "--samples", "20"];
    for more in [["--size", "16x15"], ["--seed", "3"], ["--env", "builtin:sky"]] {
        let size = if more[0] == "--size" { &[][..] } else { &["--size", "16x16"][..] };
        let error = fail_after_light(folder.path(), &[&fixed[..], size, &more[..]].concat());
        assert!(error.starts_with("error: state (remove it to begin anew): checkpoint: found "), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    std::fs::write(folder.path().join("state"), b"something else").unwrap();
    let error = fail_after_light(folder.path(), &[&fixed[..], &["--size", "16x16"]].concat());
    assert!(error.contains("found another file"), "{error}");
    assert_eq!(std::fs::read(folder.path().join("state")).unwrap(), b"something else");
}

/// Fails after the line on the light.
fn fail_after_light(folder: &Path, arguments: &[&str]) -> String {
    let output = common::run(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    common::stderr(&output)
}

#[test]
fn noise_and_time_end_a_run() {
    let folder = tempdir().unwrap();
    let fixed = ["render", "builtin:plane", "--reference", "--size", "16x9", "-o", "a.exr", "--env", "builtin:furnace"];
    // A matt plane in uniform light: 16 samples, the least that are believed, are enough.
    let said = succeed(folder.path(), &[&fixed[..], &["--error", "0.5"]].concat());
    assert!(said.contains(": 16 samples, noise "), "{said}");
    let said = succeed(folder.path(), &[&fixed[..], &["--time", "0.000001"]].concat());
    assert!(said.contains(": 1 samples, noise unknown"), "{said}");
}

#[test]
fn white_vanishes_in_a_furnace_and_grey_does_not() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("white.obj"), WHITE_OBJ).unwrap();
    std::fs::write(folder.path().join("white.mtl"), "newmtl white\nKd 1 1 1\nNs 20\n").unwrap();
    let traced = |scene: &str, more: &[&str]| {
        let fixed = ["render", scene, "--reference", "--env", "builtin:furnace", "--size", "24x24", "--samples", "64"];
        let fov = ["--camera", "eye=0.5,0.3,4:target=0,0,0:fov=40", "-o", "a.exr", "--aov", "depth"];
        succeed(folder.path(), &[&fixed[..], &fov, more].concat());
        let hits = layer(&folder.path().join("a.exr"), "depth").texels;
        let texels = picture(&folder.path().join("a.exr")).texels;
        let on: Vec<f64> =
            texels.iter().zip(&hits).filter(|(_, depth)| depth[0] > 0.0).map(|(c, _)| f64::from(c[1])).collect();
        assert!((100..300).contains(&on.len()), "{} pixels of the thing", on.len());
        (on.iter().sum::<f64>() / on.len() as f64, texels[0][1])
    };
    for more in [&[][..], &["--light-paths", "environment", "--no-shadows"], &["--turn-env", "77"]] {
        let (white, background) = traced("white.obj", more);
        assert!((white - 1.0).abs() < FURNACE_ERROR, "{more:?}: {white}");
        assert!((background - 1.0).abs() < 1e-6, "{background}");
    }
    let (half, _) = traced("white.obj", &["--env-intensity", "0.5"]);
    assert!((half - 0.5).abs() < FURNACE_ERROR, "{half}");
    // Base colour 0.5 below a reflecting layer, and open sky between: darker than the sky, by less than half.
    let (grey, _) = traced("builtin:sphere", &[]);
    assert!((0.45..0.75).contains(&grey), "{grey}");
}

#[test]
fn a_turntable_is_a_sequence_that_turns() {
    let folder = tempdir().unwrap();
    let said = render(folder.path(), "builtin:teapots", &["--turntable", "3", "-o", "t.png", "--aov", "depth"]);
    assert_eq!(said.lines().filter(|l| l.contains("wrote")).count(), 3, "{said}");
    let expected = ["t-000.depth.exr", "t-000.png", "t-001.depth.exr", "t-001.png", "t-002.depth.exr", "t-002.png"];
    assert_eq!(names(folder.path()), expected);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_ne!(bytes("t-000.depth.exr"), bytes("t-001.depth.exr"));
    render(folder.path(), "builtin:teapots", &["-o", "one.png", "--aov", "depth"]);
    assert_eq!(bytes("t-000.depth.exr"), bytes("one.depth.exr"), "the first is the picture without a turn");
}

#[test]
fn mistakes_are_one_line_and_leave_nothing() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("bad.gltf"), b"{").unwrap();
    let cases: [(&[&str], &str); 16] = [
        (&["builtin:spere"], "did you mean `sphere`?"),
        (&["spheres"], "did you mean `builtin:spheres`?"),
        (&["a.hdr"], "expected a name that ends in .gltf, .glb or .obj"),
        (&["gone.glb"], "gone.glb: "),
        (&["bad.gltf"], "bad.gltf: the glTF's JSON cannot be read"),
        (&["builtin:sphere", "--camera", "top"], "no camera \"top\"; expected one of 0"),
        (&["builtin:sphere", "--camera", "1"], "no camera \"1\""),
        (&["builtin:sphere", "-o", "a.jpg"], "expected a name that ends in .png, .exr or .hdr"),
        (&["builtin:sphere", "--env", "builtin:studoi"], "did you mean `studio`?"),
        (&["builtin:sphere", "--light-paths", "direct", "--bounces", "2"], "--bounces"),
        (&["builtin:sphere", "--no-shadows"], "--no-shadows"),
        (&["builtin:sphere", "--light-paths", "environment", "--env", "none"], "found no environment"),
        (&["builtin:cornell", "--light-paths", "environment"], "found no environment"),
        (&["builtin:sphere", "--camera", "eye=1,2,3:target=1,2,3"], "the same point for eye and target"),
        (&["builtin:sphere", "--camera", "eye=0,0,0"], "the same point for eye and target"),
        (&["builtin:sphere", "-o", "/dev/null/a.png"], "/dev/null: cannot make files there"),
    ];
    for (arguments, expected) in cases {
        let error = fail(folder.path(), &[&["render", "--reference"], arguments].concat());
        assert!(error.contains(expected), "{arguments:?}: {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    assert_eq!(names(folder.path()), ["bad.gltf"]);
    let error = fail(folder.path(), &["render", "builtin:sphere"]);
    assert!(error.contains("add --reference") && error.lines().count() == 1, "{error}");
}

#[test]
fn inspect_lists_what_is_in_a_scene() {
    let folder = tempdir().unwrap();
    let text = succeed(folder.path(), &["inspect", "builtin:room"]);
    for part in [
        "triangles in 13 instances of 10 meshes",
        "bounds",
        "\"gold\": base color 1 0.782 0.344",
        "rectangle",
        "cameras",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    std::fs::write(folder.path().join("white.obj"), WHITE_OBJ).unwrap();
    let json: Value = serde_json::from_str(&succeed(folder.path(), &["inspect", "white.obj", "--json"])).unwrap();
    assert_eq!((json["type"].as_str(), json["triangles"].as_u64()), (Some("scene"), Some(8)));
    assert_eq!(json["bounds"]["max"], serde_json::json!([1.0, 1.0, 1.0]));
    let note = json["notes"][0]["text"].as_str().unwrap();
    assert!(note.contains("white.mtl"), "the library is not there: {note}");
    assert!(fail(folder.path(), &["inspect", "builtin:rom"]).contains("did you mean `room`?"));
    // An environment is still one.
    assert!(fail(folder.path(), &["inspect", "gone.hdr"]).starts_with("error: gone.hdr: "));
}

#[test]
fn every_model_has_a_picture() {
    let Some(folder) = data("every_model_has_a_picture") else { return };
    let made = tempdir().unwrap();
    for name in ["BoxVertexColors.glb", "CornellBox.glb", "Suzanne/Suzanne.gltf", "roughness-scale/scene.gltf"] {
        let path = folder.join("gltf").join(name);
        render(made.path(), path.to_str().unwrap(), &["-o", "a.exr"]);
        let picture = picture(&made.path().join("a.exr"));
        let lit = picture.texels.iter().filter(|c| c[1] > 0.0 && c.iter().all(|c| c.is_finite())).count();
        assert!(lit > 24 * 16 / 8, "{name}: {lit} lit pixels");
    }
}

#[test]
fn what_does_not_fit_into_memory_is_one_line() {
    let folder = tempdir().unwrap();
    let large = ["render", "builtin:sphere", "--reference", "--size", "65536x65536"];
    assert!(fail(folder.path(), &large).contains("--max-memory"));
    let small = ["render", "builtin:teapots", "--reference", "--size", "8x8", "--max-memory", "1MiB"];
    assert!(fail(folder.path(), &small).contains("builtin:teapots takes about"));
}
