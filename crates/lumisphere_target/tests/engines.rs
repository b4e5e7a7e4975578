//! Every target read as its engine reads it, by the engine's published formulas, against a plain sum over the picture.
//!
//! Sources of the formulas: bevy_pbr 0.20.1 `environment_map.wesl`; Filament 1.53 `surface_light_indirect.fs`; three.js
//! 0.187 `cube_uv_reflection_fragment.glsl.js`, `WebGLMaterials.js`; Babylon.js 9.34 `pbrHelperFunctions`,
//! `lodBasedMicroSurface`; Unity `UnityImageBasedLighting.cginc`, `UnityCG.cginc`, glTFast `Jobs.cs`; Unreal
//! `ReflectionEnvironmentShared.ush`, `TextureCompressorModule.cpp`; Godot `sky.glsl`; glTF sample renderer `ibl.glsl`.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Light, difference, lod_inverse};
use lumisphere_codec::{DecodedTexture, Limits, decode_picture, decode_texture, env};
use lumisphere_image::{CubeLayout, Environment, FaceSide, cube_from_flat};
use lumisphere_sphere::{Grid, Projection};
use lumisphere_target::{Content, ShJson, TargetFile};

type Vec3 = [f64; 3];

/// How an engine gets from our world to a value of its cube.
struct Reader {
    target: &'static str,
    /// What its glTF importer makes of our axes.
    import: fn(Vec3) -> Vec3,
    /// What it turns an imported direction into before it fetches from a cube.
    fetch: fn(Vec3) -> Vec3,
    /// Level for perceptual roughness, of n levels from this size on.
    lod: fn(f64, usize, usize) -> f64,
}

const fn reader(
    target: &'static str,
    import: fn(Vec3) -> Vec3,
    fetch: fn(Vec3) -> Vec3,
    lod: fn(f64, usize, usize) -> f64,
) -> Reader {
    Reader { target, import, fetch, lod }
}

fn same(d: Vec3) -> Vec3 {
    d
}

fn negate_x([x, y, z]: Vec3) -> Vec3 {
    [-x, y, z]
}

fn negate_z([x, y, z]: Vec3) -> Vec3 {
    [x, y, -z]
}

fn z_up([x, y, z]: Vec3) -> Vec3 {
    [x, z, y]
}

fn linear(p: f64, n: usize, _: usize) -> f64 {
    p * (n - 1) as f64
}

fn quadratic(p: f64, n: usize, _: usize) -> f64 {
    (n - 1) as f64 * p * (2.0 - p)
}

fn babylon(p: f64, _: usize, size: usize) -> f64 {
    0.8 * ((p * p + 0.0005) * size as f64).log2()
}

fn unity(p: f64, _: usize, _: usize) -> f64 {
    p * (1.7 - 0.7 * p) * 6.0
}

/// `ComputeReflectionCaptureMipFromRoughness`, whose last level is n - 1.
fn unreal(p: f64, n: usize, _: usize) -> f64 {
    let from_roughest = 1.0 - 1.2 * p.max(0.001).log2();
    (n - 1) as f64 - from_roughest
}

const READERS: [Reader; 9] = [
    reader("raw", same, same, linear),
    reader("khronos", same, same, linear),
    reader("godot", same, same, linear),
    reader("bevy", same, negate_z, linear),
    reader("filament", same, same, quadratic),
    reader("three", same, negate_x, quadratic),
    reader("babylon", negate_x, same, babylon),
    reader("unity", negate_x, same, unity),
    reader("unreal", z_up, same, unreal),
];

/// Half a step of the coarsest format (blue of B10G11R11), and what the baker's patches differ from points.
const TOLERANCE: f64 = 0.02;
/// A wrong turn changes the picture by at least this: the negative control.
const WRONG: f64 = 0.1;

/// The chain of the target's files.
fn chain(files: &[TargetFile], target: &lumisphere_target::Target) -> DecodedTexture {
    let file = files.iter().find(|f| target.files[f.plan].content == Content::Specular).unwrap();
    decode_texture(&file.encoded.bytes, &Limits::default()).unwrap()
}

fn level(texture: &DecodedTexture, lod: usize) -> Environment {
    let size = (texture.width >> lod).max(1);
    let grid = Grid::new(Projection::Cube, size, size).unwrap();
    Environment::new(grid, texture.levels[lod].iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()).unwrap()
}

/// Relative RMS over some texels of a level between the file and the light at the world direction whose fetch it is.
fn level_error(light: &Light, level: &Environment, p: f64, world: impl Fn(Vec3) -> Vec3) -> f64 {
    let grid = level.grid();
    let places = grid.texel_count();
    let texel = |i: usize| {
        let (face, x, y) = (i / (grid.width() * grid.width()), i % grid.width(), i / grid.width() % grid.width());
        let direction = world(grid.texel_direction(face, x, y).unwrap());
        (level.texel(face, x, y).map(f64::from), light.prefiltered(p, direction))
    };
    difference((0..places).step_by((places / 48).max(1)).map(texel))
}

/// The inverse of maps that only permute and negate.
fn inverse(map: impl Fn(Vec3) -> Vec3) -> impl Fn(Vec3) -> Vec3 {
    let columns = [map([1.0, 0.0, 0.0]), map([0.0, 1.0, 0.0]), map([0.0, 0.0, 1.0])];
    move |d| std::array::from_fn(|i| (0..3).map(|k| columns[i][k] * d[k]).sum())
}

#[test]
fn every_engine_finds_the_light_where_and_as_rough_as_it_is() {
    let light = Light::new();
    for reader in READERS {
        let (target, files) = light.baked(reader.target);
        let texture = chain(&files, &target);
        let n = texture.levels.len();
        let fetch = |d| (reader.fetch)((reader.import)(d));
        let world = inverse(fetch);
        for lod in 1..n {
            let Some(p) = lod_inverse(|p| (reader.lod)(p, n, texture.width), lod as f64) else {
                // The engine never gets here: what lies there is p = 1, for filtering.
                assert!(level_error(&light, &level(&texture, lod), 1.0, &world) < TOLERANCE, "{} {lod}", target.name);
                continue;
            };
            let error = level_error(&light, &level(&texture, lod), p, &world);
            assert!(error < TOLERANCE, "{} level {lod} of {n}, p = {p:.3}: {error:.4}", target.name);
        }
        // Negative controls: the mirrored world, and the light at another roughness.
        let first = level(&texture, 1);
        let p = lod_inverse(|p| (reader.lod)(p, n, texture.width), 1.0).unwrap();
        assert!(level_error(&light, &first, p, |d| negate_x(world(d))) > WRONG, "{}", target.name);
        assert!(level_error(&light, &first, p, |d| negate_z(world(d))) > WRONG, "{}", target.name);
        assert!(level_error(&light, &first, (p + 0.4).min(1.0), &world) > 2.0 * TOLERANCE, "{}", target.name);
    }
}

#[test]
fn diffuse_light_is_right_in_every_packing() {
    let light = Light::new();
    for (name, fetch) in [("khronos", same as fn(Vec3) -> Vec3), ("bevy", negate_z), ("raw", same)] {
        let (target, files) = light.baked(name);
        let is_diffuse = |c: Content| matches!(c, Content::Irradiance(_));
        let file = files.iter().find(|f| is_diffuse(target.files[f.plan].content)).unwrap();
        let cube = level(&decode_texture(&file.encoded.bytes, &Limits::default()).unwrap(), 0);
        // E/pi for the engines, E for raw.
        let unit = if name == "raw" { std::f64::consts::PI } else { 1.0 };
        let world = inverse(fetch);
        let grid = cube.grid();
        let pairs = (0..6).map(|face| {
            let d = world(grid.texel_direction(face, 3, 5).unwrap());
            (cube.texel(face, 3, 5).map(f64::from), light.form_factor(d).map(|v| v * unit))
        });
        assert!(difference(pairs) < TOLERANCE, "{name}");
    }
}

/// Directions whose harmonics are compared.
fn normals() -> Vec<Vec3> {
    let unit = |[x, y, z]: Vec3| [x, y, z].map(|v: f64| v / (x * x + y * y + z * z).sqrt());
    [[1.0, 0.2, 0.1], [-0.4, 1.0, 0.3], [0.2, -0.3, 1.0], [-1.0, -0.5, 0.2], [0.3, -1.0, -0.6], [0.1, 0.2, -1.0]]
        .map(unit)
        .to_vec()
}

/// Order 2 leaves out 3.3 % of the irradiance of the test's light; a turned one is four times as far off.
const ORDER_2: f64 = 0.035;
const TURNED: f64 = 0.13;

#[test]
fn filament_sums_its_nine_to_the_form_factor() {
    let light = Light::new();
    let (_, files) = light.baked("filament");
    let text = String::from_utf8(files.iter().find(|f| f.name == "sh.txt").unwrap().encoded.bytes.clone()).unwrap();
    let key = decode_texture(&files[0].encoded.bytes, &Limits::default()).unwrap();
    assert_eq!(key.text("sh"), Some(text.as_str()));
    // As `createIblFromKtx1` splits it.
    let numbers: Vec<f64> = text.split(char::is_whitespace).take(27).map(|n| n.parse().unwrap()).collect();
    let sh = |i: usize| [numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]];
    let evaluated = |[x, y, z]: Vec3| -> Vec3 {
        let basis = [1.0, y, z, x, y * x, y * z, 3.0 * z * z - 1.0, z * x, x * x - y * y];
        std::array::from_fn(|c| (0..9).map(|i| basis[i] * sh(i)[c]).sum())
    };
    let error = difference(normals().into_iter().map(|n| (evaluated(n), light.form_factor(n))));
    assert!(error < ORDER_2, "{error}");
    let mirrored = difference(normals().into_iter().map(|n| (evaluated(negate_x(n)), light.form_factor(n))));
    assert!(mirrored > TURNED, "{mirrored}");
}

#[test]
fn babylon_evaluates_its_polynomial_to_the_form_factor() {
    let light = Light::new();
    let (_, files) = light.baked("babylon");
    let file = env::decode(&files[0].encoded.bytes, &Limits::default()).unwrap();
    assert_eq!(file.lod_generation_scale, 0.8);
    let [px, py, pz, xx, yy, zz, yz, zx, xy] = file.spherical_polynomial.unwrap();
    // `SphericalHarmonics.FromPolynomial`, `preScaleForRendering` and `computeEnvironmentIrradiance`: the squares of a
    // constant come back once, band 1 by 3/2, band 2 by 4.
    let evaluated = |[x, y, z]: Vec3| -> Vec3 {
        std::array::from_fn(|c| {
            let mean = (xx[c] + yy[c] + zz[c]) / 3.0;
            let linear = px[c] * x + py[c] * y + pz[c] * z;
            let squares = (xx[c] - mean) * x * x + (yy[c] - mean) * y * y + (zz[c] - mean) * z * z;
            mean + 1.5 * linear + 4.0 * (squares + yz[c] * y * z + zx[c] * z * x + xy[c] * x * y)
        })
    };
    let error = difference(normals().into_iter().map(|n| (evaluated(negate_x(n)), light.form_factor(n))));
    assert!(error < ORDER_2, "{error}");
    let unturned = difference(normals().into_iter().map(|n| (evaluated(n), light.form_factor(n))));
    assert!(unturned > TURNED, "{unturned}");
}

/// `ShadeSH9` of UnityCG.cginc.
#[test]
fn unity_shades_with_its_seven_vectors() {
    let light = Light::new();
    let (_, files) = light.baked("unity");
    let json: ShJson =
        serde_json::from_slice(&files.iter().find(|f| f.name == "sh.json").unwrap().encoded.bytes).unwrap();
    let v = json.seven_vectors.values.map(|row| row.map(f64::from));
    let shade = |[x, y, z]: Vec3| -> Vec3 {
        let a = [x, y, z, 1.0];
        let b = [x * y, y * z, z * z, z * x];
        let dot = |row: [f64; 4], by: [f64; 4]| (0..4).map(|i| row[i] * by[i]).sum::<f64>();
        std::array::from_fn(|c| dot(v[c], a) + dot(v[3 + c], b) + v[6][c] * (x * x - y * y))
    };
    let error = difference(normals().into_iter().map(|n| (shade(negate_x(n)), light.form_factor(n))));
    assert!(error < ORDER_2, "{error}");
}

/// One direction for another.
type Map = fn(Vec3) -> Vec3;
/// (u, v) of an imported direction, v = 0 at the top.
type LatLong = fn(Vec3) -> [f64; 2];

#[test]
fn panoramas_lie_as_each_engine_looks_them_up() {
    use std::f64::consts::PI;
    let three: LatLong = |[x, y, z]| [z.atan2(x) / (2.0 * PI) + 0.5, 0.5 - y.asin() / PI];
    // LookupLongLat with D = (X, Z, Y) of Unreal's axes.
    let unreal: LatLong = |[x, y, z]| [(1.0 + x.atan2(-y) / PI) / 2.0, z.acos() / PI];
    let godot: LatLong = |[x, y, z]| [(x.atan2(-z) / (2.0 * PI)).rem_euclid(1.0), y.acos() / PI];
    let light = Light::new();
    let engines: [(&str, Map, LatLong); 3] = [("three", same, three), ("unreal", z_up, unreal), ("godot", same, godot)];
    for (name, import, lookup) in engines {
        let (target, files) = light.baked(name);
        let file = files.iter().find(|f| target.files[f.plan].content == Content::Panorama).unwrap();
        let picture = decode_picture(&file.encoded.bytes, &Limits::default()).unwrap();
        let read = |d: Vec3| {
            let [u, v] = lookup(d);
            let x = ((u * picture.width as f64) as usize).min(picture.width - 1);
            let y = ((v * picture.height as f64) as usize).min(picture.height - 1);
            picture.texels[y * picture.width + x].map(f64::from)
        };
        let error = difference(normals().into_iter().map(|d| (read(import(d)), light.radiance(d))));
        // The nearest texel is up to half a texel off.
        assert!(error < 0.1, "{name}: {error}");
        let mirrored = difference(normals().into_iter().map(|d| (read(import(negate_x(d))), light.radiance(d))));
        assert!(mirrored > 0.3, "{name}: {mirrored}");
    }
}

#[test]
fn unitys_strip_is_the_faces_of_its_axes() {
    let light = Light::new();
    let (target, files) = light.baked("unity");
    let file = files.iter().find(|f| target.files[f.plan].content == Content::Skybox).unwrap();
    let picture = decode_picture(&file.encoded.bytes, &Limits::default()).unwrap();
    assert_eq!(picture.width, 6 * picture.height);
    let cube = cube_from_flat(&picture, CubeLayout::Strip, FaceSide::Stored).unwrap();
    let size = cube.grid().width();
    let pairs = |turn: fn(Vec3) -> Vec3| {
        let texel = |face| {
            let d = turn(cube.grid().texel_direction(face, size / 3, size / 4).unwrap());
            (cube.texel(face, size / 3, size / 4).map(f64::from), light.radiance(d))
        };
        difference((0..6).map(texel))
    };
    assert!(pairs(negate_x) < 0.02, "{}", pairs(negate_x));
    assert!(pairs(same) > 0.3);
}
