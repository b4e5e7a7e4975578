//! `lumisphere brdf`: pictures, tables, mistakes, and the plots on the pages of the models.
#![allow(clippy::unwrap_used)]

mod common;
use common::{fail, names, succeed};
use lumisphere::bsdf::MODELS;
use lumisphere_codec::{Limits, decode_picture};
use resvg::usvg::{Options, Tree};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

/// Width of the sheet in pixels; the PNG has twice as many.
const WIDTH: usize = 1180;
/// The sheet is about as high as this at least, and at most.
const HEIGHTS: std::ops::Range<f32> = 400.0..1600.0;
/// Most bytes of the plot on the page of a model.
const PLOT_BYTES: usize = 12 * 1024;
/// Units by which a fresh plot may differ from the committed one, a tenth of a pixel each: mathematical functions differ in their
/// last place from one system to another, which can move a rounded coordinate by one.
const PLOT_UNITS: f64 = 1.0;

fn tree(path: &Path) -> Tree {
    Tree::from_str(&std::fs::read_to_string(path).unwrap(), &Options::default()).unwrap()
}

#[test]
fn a_picture_is_made_where_the_program_stands_and_a_png_shows_the_same() {
    let folder = tempdir().unwrap();
    let said = succeed(folder.path(), &["brdf", "lambert"]);
    assert!(said.contains("brdf-lambert.svg"), "{said}");
    assert_eq!(names(folder.path()), ["brdf-lambert.svg"]);
    let svg = folder.path().join("brdf-lambert.svg");
    let size = tree(&svg).size();
    assert_eq!(size.width(), WIDTH as f32);
    assert!(HEIGHTS.contains(&size.height()), "{size:?}");
    let text = std::fs::read_to_string(svg).unwrap();
    for part in ["Lambert", "albedo = 1", "sr⁻¹", "view 60°", "directional albedo", "data:image/png;base64,"] {
        assert!(text.contains(part), "{part}");
    }

    succeed(folder.path(), &["brdf", "lambert", "-o", "made/a.png"]);
    let bytes = std::fs::read(folder.path().join("made/a.png")).unwrap();
    let picture = decode_picture(&bytes, &Limits::default()).unwrap();
    assert_eq!((picture.width, picture.height), (2 * WIDTH, 2 * size.height() as usize));
    // White paper at the corner, and the ball on the right: grey in its middle.
    let texel = |x: usize, y: usize| picture.texels[y * picture.width + x];
    assert_eq!(texel(0, 0), [1.0; 3]);
    let ball = texel(picture.width - 2 * (28 + 108), 2 * 250);
    assert!(ball.iter().all(|c| (0.02..0.98).contains(c)), "{ball:?}");
}

#[test]
fn models_are_compared_under_their_names() {
    let folder = tempdir().unwrap();
    let others = "oren-nayar:sigma=0.3,lambert:albedo=0.25";
    let said = succeed(folder.path(), &["brdf", "lambert", "--compare", others, "--view", "0,60"]);
    assert!(said.contains("brdf-lambert-oren-nayar-lambert.svg"), "{said}");
    let svg = folder.path().join("brdf-lambert-oren-nayar-lambert.svg");
    let text = std::fs::read_to_string(&svg).unwrap();
    for part in ["lambert", "oren-nayar", "sigma = 0.3", "albedo = 0.25", "view 0°", "view 60°"] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(text.matches("<image ").count(), 3, "a ball each");
    assert_eq!(tree(&svg).size().width(), WIDTH as f32);
}

/// What the table prints of an albedo that is exactly known, and how well it is computed (`lumisphere_bsdf::albedo`).
const ALBEDO_ERROR: f64 = 1e-4;

#[test]
fn the_albedo_of_lambert_is_its_parameter() {
    let folder = tempdir().unwrap();
    let text = succeed(folder.path(), &["brdf", "lambert", "--table"]);
    let rows: Vec<&str> = text.lines().filter(|l| l.contains("0.3183")).collect();
    assert_eq!(rows.len(), 9, "{text}");
    assert!(rows.iter().all(|row| row.split_whitespace().nth(1) == Some("1.0000")), "{text}");
    assert!(names(folder.path()).is_empty(), "a table alone draws nothing");
    let json = succeed(folder.path(), &["brdf", "lambert", "albedo=0.25", "--json", "--view", "10,80"]);
    let models: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(models[0]["parameters"]["albedo"], 0.25);
    let views = models[0]["views"].as_array().unwrap();
    assert_eq!(views.len(), 2);
    let reflected = views.iter().map(|v| &v["albedo"]).chain([&models[0]["average"]]);
    for shares in reflected {
        assert!((shares["reflected"][1].as_f64().unwrap() - 0.25).abs() < ALBEDO_ERROR, "{shares}");
        assert!(shares["transmitted"][1].as_f64().unwrap().abs() < ALBEDO_ERROR, "{shares}");
    }
}

#[test]
fn every_model_is_listed_with_its_parameters() {
    let folder = tempdir().unwrap();
    let text = succeed(folder.path(), &["brdf", "--list"]);
    let json: Value = serde_json::from_str(&succeed(folder.path(), &["brdf", "--list", "--json"])).unwrap();
    assert_eq!(json.as_array().unwrap().len(), MODELS.len());
    for (model, json) in MODELS.iter().zip(json.as_array().unwrap()) {
        assert!(text.contains(model.title), "{}", model.name);
        assert_eq!(json["name"], model.name);
        assert_eq!(json["parameters"].as_array().unwrap().len(), model.parameters.len());
        assert!(model.parameters.iter().all(|p| text.contains(p.meaning)), "{}", model.name);
    }
    let page = succeed(folder.path(), &["brdf", "lambert", "--page"]);
    assert!(page.contains("f = ρ / π") && !page.contains("<svg"), "{page}");
}

#[test]
fn mistakes_are_met_with_what_was_meant_on_one_line() {
    let folder = tempdir().unwrap();
    let cases: [(&[&str], &str); 9] = [
        (&["lambrt"], "did you mean `lambert`?"),
        (&["lambert", "albdo=1"], "did you mean `albedo`?"),
        (&["lambert", "albedo=2"], "0 to 1"),
        (&["lambert", "albedo"], "name=value"),
        (&["lambert", "--compare", "eonn"], "did you mean `eon`?"),
        (&["lambert", "--compare", "eon:sgma=0.3"], "did you mean `sigma`?"),
        (&["lambert", "-o", "a.pdf"], ".svg or .png"),
        (&["lambert", "--view", "1,2,3,4,5,6,7,8,9"], "8 at most"),
        (&["lambrt", "--page"], "did you mean `lambert`?"),
    ];
    for (more, hint) in cases {
        let arguments: Vec<&str> = ["brdf"].iter().chain(more).copied().collect();
        let message = fail(folder.path(), &arguments);
        assert!(message.contains(hint), "{more:?}: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    for more in [&["lambert", "--view", "90"][..], &[], &["--list", "lambert"]] {
        let arguments: Vec<&str> = ["brdf"].iter().chain(more).copied().collect();
        assert!(fail(folder.path(), &arguments).contains("error:"), "{more:?}");
    }
    assert!(names(folder.path()).is_empty());
}

fn committed_plots() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates/lumisphere_bsdf/plots")
}

/// Text with its numbers left out, and the numbers.
fn numbers(text: &str) -> (String, Vec<f64>) {
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    let rest = text.chars().filter(|c| !is_number(*c)).collect();
    (rest, text.split(|c| !is_number(c)).filter_map(|n| n.parse().ok()).collect())
}

/// Whether two plots are the same to [`PLOT_UNITS`].
fn alike(a: &str, b: &str) -> bool {
    let ((rest_a, a), (rest_b, b)) = (numbers(a), numbers(b));
    rest_a == rest_b && a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= PLOT_UNITS)
}

#[test]
fn the_plots_on_the_pages_are_those_of_the_models() {
    let folder = tempdir().unwrap();
    succeed(folder.path(), &["brdf", "--thumbnails", "plots"]);
    let fresh = folder.path().join("plots");
    let again = "run `lumisphere brdf --thumbnails crates/lumisphere_bsdf/plots`";
    assert_eq!(names(&fresh), names(&committed_plots()), "a plot for each model; {again}");
    assert_eq!(names(&fresh).len(), MODELS.len());
    for name in names(&fresh) {
        let made = std::fs::read_to_string(fresh.join(&name)).unwrap();
        let committed = std::fs::read_to_string(committed_plots().join(&name)).unwrap();
        assert!(alike(&made, &committed), "{name} is stale; {again}");
        assert!(made.len() <= PLOT_BYTES, "{name}: {} bytes", made.len());
        assert!(made.lines().all(|line| !line.trim().is_empty()), "{name}: a blank line ends HTML in Markdown");
        assert!(!made.contains(" id="), "{name}: ids clash on one page");
        let svg = made.trim().trim_start_matches("<div>").trim_end_matches("</div>");
        assert!(Tree::from_str(svg.trim(), &Options::default()).is_ok(), "{name}");
    }
}

#[test]
fn a_changed_plot_is_noticed() {
    let names = names(&committed_plots());
    let plot = std::fs::read_to_string(committed_plots().join(&names[0])).unwrap();
    assert!(alike(&plot, &plot));
    let at = plot.find("points=\"").unwrap() + "points=\"".len();
    let (head, tail) = plot.split_at(at);
    let (number, tail) = tail.split_once(',').unwrap();
    let moved = format!("{head}{},{tail}", number.parse::<i32>().unwrap() + 3);
    assert!(!alike(&plot, &moved));
}

#[test]
fn every_page_shows_its_plot() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates/lumisphere_bsdf/src");
    let files = walk(&models);
    for model in MODELS {
        let line = format!("plots/{}.svg\")]", model.name);
        let shown = files.iter().filter(|file| std::fs::read_to_string(file).unwrap().contains(&line)).count();
        assert_eq!(shown, 1, "{}: files with #![doc = include_str!(\"../../plots/{}.svg\")]", model.name, model.name);
    }
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}
