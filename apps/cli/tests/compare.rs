//! `compare`: figures, exit codes, the picture of a difference.
#![allow(clippy::unwrap_used)]

mod common;
use common::{fail, names, run, stdout, succeed};
use lumisphere_codec::{Limits, exr, hdr, png};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

const WIDTH: usize = 40;
const HEIGHT: usize = 30;

/// sRGB bytes of a gradient, all channels brighter by an offset.
fn write_png(folder: &Path, name: &str, offset: u8) {
    let byte = |i: usize| (i % WIDTH) as u8 * 4 + 20 + offset;
    let samples: Vec<u8> = (0..WIDTH * HEIGHT).flat_map(|i| [byte(i); 3]).collect();
    std::fs::write(folder.join(name), png::encode_rgb8(WIDTH, HEIGHT, &samples).unwrap()).unwrap();
}

fn write_exr(folder: &Path, name: &str, width: usize, radiance: impl Fn(usize) -> f32) {
    let texels: Vec<[f32; 3]> = (0..width * HEIGHT).map(|i| [radiance(i); 3]).collect();
    let file = exr::encode(width, HEIGHT, &texels, exr::SampleFormat::Float, None).unwrap();
    std::fs::write(folder.join(name), file.bytes).unwrap();
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let arguments: Vec<&str> = ["compare"].iter().chain(arguments).chain(&["--json"]).copied().collect();
    serde_json::from_str(&succeed(folder, &arguments)).unwrap()
}

fn value(report: &Value, metric: &str) -> f64 {
    let all = report["metrics"].as_array().unwrap();
    all.iter().find(|m| m["metric"] == metric).unwrap()["value"].as_f64().unwrap()
}

#[test]
fn a_picture_against_itself_has_no_error() {
    let folder = tempdir().unwrap();
    write_png(folder.path(), "a.png", 0);
    let report = json(folder.path(), &["a.png", "a.png", "--max", "flip=0", "--max", "rmse=0", "--min", "psnr=200"]);
    assert_eq!(["rmse", "relative-mse", "flip"].map(|m| value(&report, m)), [0.0; 3]);
    // JSON knows no infinity.
    assert!(report["metrics"][2]["value"].is_null() && report["passed"] == true);
    assert!(report["metrics"].as_array().unwrap().iter().all(|m| m["metric"] != "hdr-flip"), "not of PNGs");
}

#[test]
fn an_offset_has_its_closed_form_and_a_limit_decides_the_exit_code() {
    let folder = tempdir().unwrap();
    write_png(folder.path(), "a.png", 5);
    write_png(folder.path(), "b.png", 0);
    let report = json(folder.path(), &["a.png", "b.png"]);
    // 20 lg(255/5); codes pass through linear f32.
    assert!((value(&report, "psnr") - 20.0 * 51.0_f64.log10()).abs() < 1e-4, "{report}");
    let flip = value(&report, "flip");
    assert!((0.01..0.3).contains(&flip), "{flip}");

    let over = run(folder.path(), &["compare", "a.png", "b.png", "--max", "flip=0.001", "--metric", "rmse"]);
    assert_eq!(over.status.code(), Some(1));
    assert!(stdout(&over).contains("beyond the limit"), "{}", stdout(&over));
    let under = run(folder.path(), &["compare", "a.png", "b.png", "--min", "psnr=60", "-o", "d.png"]);
    assert_eq!((under.status.code(), folder.path().join("d.png").exists()), (Some(1), true));
    let kept = succeed(folder.path(), &["compare", "a.png", "b.png", "--max", "flip=0.5", "--min", "psnr=30"]);
    assert_eq!(kept.matches("keeps the limit").count(), 2, "{kept}");
}

#[test]
fn radiance_gets_every_metric_and_exposure_scales_it() {
    let folder = tempdir().unwrap();
    let radiance = |i: usize| (i % WIDTH) as f32 / 8.0 + 0.5;
    write_exr(folder.path(), "b.exr", WIDTH, radiance);
    write_exr(folder.path(), "a.exr", WIDTH, |i| radiance(i) + 0.25);
    write_exr(folder.path(), "v.exr", WIDTH, |_| 0.01);
    let plain = json(folder.path(), &["a.exr", "b.exr", "--variance", "v.exr"]);
    assert!((value(&plain, "rmse") - 0.25).abs() < 1e-6, "{plain}");
    let bright = json(folder.path(), &["a.exr", "b.exr", "--exposure", "2", "--tonemap", "neutral"]);
    assert!((value(&bright, "rmse") - 1.0).abs() < 1e-6, "{bright}");
    assert_eq!(value(&bright, "hdr-flip"), value(&plain, "hdr-flip"));
    assert_ne!(value(&bright, "flip"), value(&plain, "flip"));
    // 2.5 standard errors: p = 0.012 for a channel, 0.037 for a pixel. Everyone passes, and the mean shows the bias.
    let z = plain["metrics"].as_array().unwrap().last().unwrap();
    assert!(z["metric"] == "z-test" && z["value"] == 0.0 && z["details"]["accepted"] == true, "{z}");
    assert!((z["details"]["mean_z"].as_f64().unwrap() - 2.5).abs() < 1e-5, "{z}");
    write_exr(folder.path(), "w.exr", WIDTH, |_| 0.001);
    let arguments = ["compare", "a.exr", "b.exr", "--variance-a", "w.exr", "--max", "z-test=0.0025"];
    let biased = run(folder.path(), &arguments);
    assert_eq!((biased.status.code(), stdout(&biased).contains("different pictures")), (Some(1), true));
    let texels: Vec<[f32; 3]> = (0..WIDTH * HEIGHT).map(|i| [radiance(i); 3]).collect();
    std::fs::write(folder.path().join("b.hdr"), hdr::encode(WIDTH, HEIGHT, &texels).unwrap().bytes).unwrap();
    // RGBE keeps eight bits: half a step of the largest exponent, 4 / 256.
    assert!(value(&json(folder.path(), &["b.hdr", "b.exr"]), "rmse") < 4.0 / 256.0);
}

#[test]
fn the_picture_has_the_size_of_the_map_and_a_scale_below() {
    let folder = tempdir().unwrap();
    write_exr(folder.path(), "b.exr", 500, |_| 1.0);
    write_exr(folder.path(), "a.exr", 500, |i| if i % 500 < 250 { 1.5 } else { 0.5 });
    let report = json(folder.path(), &["a.exr", "b.exr", "--metric", "rmse", "-o", "out/d.png"]);
    assert_eq!((&report["picture"]["metric"], &report["picture"]["range"][1]), (&"rmse".into(), &0.5.into()));
    let limits = Limits::default();
    let drawn = png::decode(&std::fs::read(folder.path().join("out/d.png")).unwrap(), &limits).unwrap();
    assert!(drawn.width == 500 && (HEIGHT + 40..HEIGHT + 120).contains(&drawn.height), "{}", drawn.height);
    let (left, right) = (drawn.texels[10], drawn.texels[490]);
    assert!(left[0] > 4.0 * left[2] && right[2] > 4.0 * right[0], "red where A is brighter, blue where darker");
    let scale = &drawn.texels[(HEIGHT + 18) * 500..][..500];
    assert!(scale[13][2] > 4.0 * scale[13][0] && scale[486][0] > 4.0 * scale[486][2] && scale[250][1] > 0.8);
    let seen = json(folder.path(), &["a.exr", "b.exr", "-o", "e.png", "--show", "flip"]);
    assert_eq!(seen["picture"]["metric"], "flip");
    let seen = json(folder.path(), &["a.exr", "b.exr", "-o", "e.png"]);
    assert_eq!((&seen["picture"]["metric"], &seen["picture"]["range"]), (&"hdr-flip".into(), &vec![0.0, 1.0].into()));
}

#[test]
fn what_cannot_be_compared_is_one_error() {
    let folder = tempdir().unwrap();
    write_png(folder.path(), "a.png", 0);
    write_exr(folder.path(), "narrow.exr", WIDTH / 2, |_| 1.0);
    write_exr(folder.path(), "holed.exr", WIDTH, |i| if i == 7 { f32::NAN } else { 1.0 });
    write_exr(folder.path(), "fine.exr", WIDTH, |_| 1.0);
    write_exr(folder.path(), "below.exr", WIDTH, |_| -1.0);
    std::fs::write(folder.path().join("no.hdr"), b"nothing").unwrap();
    let before = names(folder.path());
    let cases: [(&[&str], &str); 12] = [
        (&["a.png", "narrow.exr"], "a.png and narrow.exr: expected pictures of one size, found 40 x 30 and 20 x 30"),
        (&["holed.exr", "fine.exr"], "1 pixels of the test picture with NaN"),
        (&["fine.exr", "missing.exr"], "error: missing.exr: "),
        (&["no.hdr", "fine.exr"], "error: no.hdr: "),
        (&["a.png", "a.png", "-o", "d.jpg"], "expected .png"),
        (&["a.png", "a.png", "--metric", "z-test"], "found no variance"),
        (&["fine.exr", "fine.exr", "--variance", "narrow.exr"], "one size"),
        (&["fine.exr", "fine.exr", "--variance-b", "below.exr"], "at least 0"),
        (&["a.png", "a.png", "--max", "psnr=3"], "--min psnr=3"),
        (&["a.png", "a.png", "--max", "flop=3"], "relative-mse"),
        (&["a.png", "a.png", "--ppd", "0"], "pixels per degree"),
        (&["a.png", "a.png", "--tonemap", "filmic"], "neutral"),
    ];
    for (arguments, hint) in cases {
        let arguments: Vec<&str> = ["compare"].iter().chain(arguments).copied().collect();
        let message = fail(folder.path(), &arguments);
        assert!(message.contains(hint), "{arguments:?}: {message}");
    }
    assert_eq!(names(folder.path()), before);
}
