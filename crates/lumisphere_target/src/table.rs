//! The table of targets.
//!
//! Each row was read from the engine's own source or measured on its output; where the engine runs in our tests, the
//! tests hold its picture against ours (`cargo xtask test-engines`).

use crate::target::{
    Content, FilePlan, FlatFile, FlatLayout, Form, IrradianceUnit, Target, TexelChoice, TextureContainer,
};
use lumisphere_bake::RoughnessCurve;
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx2::Supercompression;
use lumisphere_image::{CubeLayout, FaceSide};
use lumisphere_sphere::AxisTurn;

/// Zstandard level: 3 is quick, and slow levels gain little on light.
const ZSTD: Supercompression = Supercompression::Zstd(3);

/// Every target, in the order in which they are listed.
pub fn targets() -> Vec<Target> {
    vec![raw(), khronos(), bevy(), filament(), three(), babylon(), gltf(), unity(), unreal(), godot()]
}

/// The target of a name.
pub fn target(name: &str) -> Option<Target> {
    targets().into_iter().find(|t| t.name == name)
}

/// Engines whose glTF importer negates x, or that fetch with x negated.
const MIRROR_X: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn plan(stem: &str, content: Content, form: Form) -> FilePlan {
    FilePlan { stem: stem.to_owned(), content, form }
}

fn ktx2(texels: TexelChoice, compression: Supercompression) -> Form {
    Form::Texture { container: TextureContainer::Ktx2, texels, compression }
}

/// Shared exponents, compressed: less than half the bytes of plain half floats, an error of .2 % of the brightest channel at
/// most (`lumisphere formats`).
fn small_ktx2() -> Form {
    ktx2(TexelChoice::Exactly(TexelFormat::Rgb9e5), ZSTD)
}

fn plain(container: TextureContainer, format: TexelFormat) -> Form {
    Form::Texture { container, texels: TexelChoice::Exactly(format), compression: Supercompression::None }
}

fn lat_long(file: FlatFile) -> Form {
    Form::Flat { file, layout: FlatLayout::LatLong }
}

const FORM_FACTOR: Content = Content::Irradiance(IrradianceUnit::FormFactor);

/// What all targets share unless they say otherwise.
fn common() -> Target {
    Target {
        name: "",
        engine: "",
        needs: "",
        turn: AxisTurn::IDENTITY,
        panorama_turn: AxisTurn::IDENTITY,
        curve: RoughnessCurve::Linear,
        size: 256,
        smallest_face: 8,
        files: Vec::new(),
        proven_by: "",
        usage: "",
    }
}

fn raw() -> Target {
    let auto = ktx2(TexelChoice::Auto, Supercompression::None);
    Target {
        name: "raw",
        engine: "your own renderer",
        needs: "our conventions, every choice yours",
        files: vec![
            plan("specular", Content::Specular, auto),
            plan("irradiance", Content::Irradiance(IrradianceUnit::Irradiance), auto),
            plan("skybox", Content::Skybox, auto),
            plan("sh", Content::Harmonics, Form::ShJson),
            plan("dfg", Content::Dfg, auto),
        ],
        proven_by: "`verify` against the sum over every texel; round trips of every container",
        usage: include_str!("usage/raw.md"),
        ..common()
    }
}

fn khronos() -> Target {
    Target {
        name: "khronos",
        engine: "glTF sample renderer and what follows it",
        needs: "KTX2 cubes, p = lod/m; diffuse cube E/pi",
        files: vec![
            plan("specular", Content::Specular, small_ktx2()),
            plan("diffuse", FORM_FACTOR, small_ktx2()),
            plan("dfg", Content::Dfg, ktx2(TexelChoice::Exactly(TexelFormat::Rg16F), Supercompression::None)),
        ],
        proven_by: "its published formulas",
        usage: include_str!("usage/khronos.md"),
        ..common()
    }
}

fn bevy() -> Target {
    Target {
        name: "bevy",
        engine: "Bevy 0.20",
        needs: "two KTX2 cubes, p = lod/m, fetched with z negated; diffuse cube E/pi",
        // environment_map.wesl and skybox.wesl of bevy_pbr 0.20.1 negate z of every fetch.
        turn: AxisTurn::MIRROR_Z,
        files: vec![
            plan("specular", Content::Specular, small_ktx2()),
            plan("diffuse", FORM_FACTOR, small_ktx2()),
            plan("skybox", Content::Skybox, small_ktx2()),
        ],
        proven_by: "its own loader (texels); its shader's formulas (orientation, levels)",
        usage: include_str!("usage/bevy.md"),
        ..common()
    }
}

fn filament() -> Target {
    let small = plain(TextureContainer::Ktx1, TexelFormat::B10g11r11);
    Target {
        name: "filament",
        engine: "Filament 1.53",
        needs: "KTX1 cube with the key `sh`, lod = m p (2 - p)",
        // Fetched with the world's direction. cmgen's own cubes are turned by a quarter, "z y -x", against this.
        curve: RoughnessCurve::Quadratic,
        files: vec![
            plan("environment_ibl", Content::Specular, small),
            plan("environment_skybox", Content::Skybox, small),
            plan("sh", Content::Harmonics, Form::FilamentText),
        ],
        proven_by: "the engine (wasm): orientation, brightness, levels; cmgen's own files",
        usage: include_str!("usage/filament.md"),
        ..common()
    }
}

/// A matrix of signed units as a turn; rows that are none leave everything in place, which the tests of the table would
/// notice.
fn turn(rows: [[f64; 3]; 3]) -> AxisTurn {
    AxisTurn::from_matrix(rows).unwrap_or(AxisTurn::IDENTITY)
}

fn three() -> Target {
    let specular = if cfg!(feature = "uastc-hdr") {
        ktx2(TexelChoice::Exactly(TexelFormat::UastcHdr4x4), ZSTD)
    } else {
        ktx2(TexelChoice::Exactly(TexelFormat::Rgba16F), Supercompression::None)
    };
    Target {
        name: "three",
        engine: "three.js r187",
        needs: "prefiltered KTX2 cube, lod = m p (2 - p), last level p = 1; or a lat-long that it filters itself",
        // Loaded cubes are fetched at (-x, y, z).
        turn: turn(MIRROR_X),
        curve: RoughnessCurve::Quadratic,
        files: vec![
            plan("specular", Content::Specular, specular),
            plan("environment", Content::Panorama, lat_long(FlatFile::Hdr)),
        ],
        proven_by: "the engine: orientation, brightness, levels",
        usage: if cfg!(feature = "uastc-hdr") {
            include_str!("usage/three_uastc.md")
        } else {
            include_str!("usage/three.md")
        },
        ..common()
    }
}

fn babylon() -> Target {
    Target {
        name: "babylon",
        engine: "Babylon.js 9",
        needs: ".env: RGBD faces down to 1x1, alpha = 2^(lod/0.8)/size, SphericalPolynomial",
        // Left-handed by default: glTF models come in with x negated.
        turn: turn(MIRROR_X),
        curve: RoughnessCurve::Babylon,
        smallest_face: 1,
        files: vec![plan("environment", Content::Specular, Form::BabylonEnv)],
        proven_by: "the engine: orientation, brightness, levels",
        usage: include_str!("usage/babylon.md"),
        ..common()
    }
}

fn gltf() -> Target {
    Target {
        name: "gltf",
        engine: "EXT_lights_image_based, as Babylon.js 9 loads it",
        needs: "a .glb with RGBD faces, alpha = size^(lod/m - 1), nine irradiance coefficients",
        // As the babylon target, whose loader is the one that reads the extension.
        turn: turn(MIRROR_X),
        curve: RoughnessCurve::GltfLights,
        files: vec![plan("environment", Content::Specular, Form::Glb)],
        proven_by: "the engine: orientation, brightness, levels",
        usage: include_str!("usage/gltf.md"),
        ..common()
    }
}

fn unity() -> Target {
    let strip = Form::Flat { file: FlatFile::Exr, layout: FlatLayout::Cube(CubeLayout::Strip, FaceSide::Stored) };
    Target {
        name: "unity",
        engine: "Unity",
        needs: "strip of six faces that it filters on import; for own pipelines a DDS cube, lod = 6 p (1.7 - 0.7 p), and SH",
        // glTFast and UnityGLTF negate x.
        turn: turn(MIRROR_X),
        curve: RoughnessCurve::Unity,
        files: vec![
            plan("environment", Content::Skybox, strip),
            plan("specular", Content::Specular, plain(TextureContainer::Dds, TexelFormat::Rgba16F)),
            plan("sh", Content::Harmonics, Form::ShJson),
        ],
        proven_by: "its published formulas",
        usage: include_str!("usage/unity.md"),
        ..common()
    }
}

fn unreal() -> Target {
    Target {
        name: "unreal",
        engine: "Unreal Engine",
        needs: "lat-long .hdr that it filters on import; for own pipelines a DDS cube, lod = m - 2 + 1.2 log2 p, and SH",
        // Z is up: its importer makes (x, z, y) of glTF's (x, y, z). A lat-long's centre lies along its -Y.
        turn: turn([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
        panorama_turn: turn([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
        curve: RoughnessCurve::Unreal,
        files: vec![
            plan("environment", Content::Panorama, lat_long(FlatFile::Hdr)),
            plan("specular", Content::Specular, plain(TextureContainer::Dds, TexelFormat::Rgba16F)),
            plan("sh", Content::Harmonics, Form::ShJson),
        ],
        proven_by: "its published formulas",
        usage: include_str!("usage/unreal.md"),
        ..common()
    }
}

fn godot() -> Target {
    Target {
        name: "godot",
        engine: "Godot 4",
        needs: "panorama that it filters itself; for own shaders a DDS cube",
        // Its panorama's centre lies along +Z.
        panorama_turn: turn([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]),
        files: vec![
            plan("panorama", Content::Panorama, lat_long(FlatFile::Exr)),
            plan("specular", Content::Specular, plain(TextureContainer::Dds, TexelFormat::Rgba16F)),
        ],
        proven_by: "its published formulas",
        usage: include_str!("usage/godot.md"),
        ..common()
    }
}
