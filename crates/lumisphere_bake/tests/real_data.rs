//! Bakes of real files against one another and against what other tools made of them.
#![allow(clippy::unwrap_used)]

mod common_data;

use common_data::ktx1::CubeFile;
use common_data::measure::*;
use common_data::turn::{Turn, ranked};
use common_data::{cube_of_files, data, environment, mirrored, say};
use lumisphere_bake::{BakeSettings, BakedEnvironment, Outputs, RoughnessCurve, bake};
use lumisphere_bsdf::{Alpha, Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_image::{Environment, Rgb, sample_nearest};
use lumisphere_sh::packed::{FilamentNine, form_factor};
use lumisphere_sh::{RowWeights, Sh, ShRgb, Spectrum, zonal};
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3, cube};
use std::f64::consts::PI;

fn small() -> BakeSettings {
    let outputs = Outputs { specular: true, irradiance: true, skybox: false, dfg: false };
    BakeSettings { size: 64, level_count: Some(3), outputs, ..BakeSettings::standard() }
}

fn baked(environment: Environment, settings: &BakeSettings) -> BakedEnvironment {
    bake(environment, settings, &|_| {}).unwrap()
}

fn level(b: &BakedEnvironment, i: usize) -> &Environment {
    &b.specular.as_ref().unwrap().levels.levels()[i]
}

fn flat(sh: &ShRgb) -> Vec<f64> { sh.values().iter().flatten().copied().collect() }

const EUC: [[f64; 3]; 9] = [
    [0.3783264, 0.4260425, 0.4504587],
    [0.2887813, 0.3586803, 0.4147053],
    [0.0379030, 0.0295216, 0.0098567],
    [-0.1033028, -0.1031690, -0.0884924],
    [-0.0621750, -0.0554432, -0.0396779],
    [0.0077820, -0.0148312, -0.0471301],
    [-0.0935561, -0.1254260, -0.1525629],
    [-0.0572703, -0.0502192, -0.0363410],
    [0.0203348, -0.0044201, -0.0452180],
];

#[test]
fn eucalyptus() {
    let Some(data) = data("eucalyptus") else { return };
    let t = std::time::Instant::now();
    let probe = environment(data.join("probe/rnl_probe.hdr"), Projection::AngularMap);
    let cross = environment(data.join("probe/rnl_cross.hdr"), Projection::VerticalCross);
    say(&format!("means {:?} {:?} diff {:e}", probe.mean(), cross.mean(), mean_difference(&probe, &cross)));
    let wrong = mirrored(&cross);
    let s = small();
    let [p, c, w] = [probe, cross, wrong].map(|e| { let b = baked(e, &s); say(&format!("{:?}", t.elapsed())); b });
    for (n, b) in [("cross", &c), ("mirrored", &w)] {
        say(&format!("{n}: sh {:e} rms {:e}", harmonics_difference(&b.sh, &p.sh), harmonics_rms(&b.sh, &p.sh)));
        for i in 0..3 { say(&format!("level {i} {:e}", difference(level(b, i), level(&p, i)))); }
        say(&format!("irr {:e}", difference(b.irradiance.as_ref().unwrap(), p.irradiance.as_ref().unwrap())));
    }
    let euc = ShRgb::new(3, EUC.to_vec()).unwrap();
    for (n, b) in [("probe", &p), ("cross", &c)] {
        let r = ranked(|t| -alignment(&flat(&euc), &flat(&turned(&b.sh, |d| t.apply(d)))));
        for (t, m) in &r[..4] {
            let u = flat(&turned(&b.sh, |d| t.apply(d)));
            let e = flat(&euc);
            let f = e.iter().zip(&u).map(|(a, b)| a*b).sum::<f64>() / u.iter().map(|a| a*a).sum::<f64>();
            say(&format!("{n} {} {m} scale {f}", t.name()));
            if t.name() == r[0].0.name() { for i in 0..9 { say(&format!("{:?} {:?}", euc.values()[i], turned(&b.sh, |d| t.apply(d)).values()[i].map(|v| v*f))); } }
        }
    }
}

fn form(sh: &ShRgb) -> ShRgb { form_factor(sh) }

fn rank_print(name: &str, theirs: &ShRgb, ours: &ShRgb) -> Turn {
    let r = ranked(|t| harmonics_rms(theirs, &turned(ours, |d| t.apply(d))));
    for (t, m) in &r[..4] { say(&format!("{name}: {} {m:e}", t.name())); }
    r[0].0
}

#[test]
fn uffizi() {
    let Some(data) = data("uffizi") else { return };
    let probe = environment(data.join("probe/uffizi_probe-128.exr"), Projection::AngularMap);
    let theirs = environment(data.join("probe/uffizi_latlong_env-128.exr"), Projection::LatLong);
    say(&format!("{:?} {:?}", probe.grid(), theirs.grid()));
    say(&format!("means {:?} {:?} {:e}", probe.mean(), theirs.mean(), mean_difference(&theirs, &probe)));
    let (a, b) = (harmonics(&theirs, 3), harmonics(&probe, 3));
    let turn = rank_print("uffizi", &a, &b);
    // ours as world: theirs(d) = ours(turn d)
    let p = baked(probe, &small());
    // inverse: bake of theirs turned so that it holds probe's frame: W'(d) = theirs(turn^-1 d)
    let inverse = Turn::all().into_iter().find(|t| { let d = [0.1, 0.5, 0.86]; let e = t.apply(turn.apply(d)); (0..3).all(|c| (d[c]-e[c]).abs() < 1e-9) }).unwrap();
    let (world, rotation) = inverse.before_bake(&theirs);
    let l = baked(world, &BakeSettings { rotation, ..small() });
    say(&format!("sh {:e}", harmonics_difference(&l.sh, &p.sh)));
    for i in 0..3 { say(&format!("level {i} {:e} shape {:?}", difference(level(&l, i), level(&p, i)), shape_difference(level(&l, i), level(&p, i)))); }
    say(&format!("irr {:e}", difference(l.irradiance.as_ref().unwrap(), p.irradiance.as_ref().unwrap())));
}

#[test]
fn filament() {
    let Some(data) = data("filament") else { return };
    let source = environment(data.join("hdri/lightroom_14b.hdr"), Projection::LatLong);
    let file = CubeFile::parse(&std::fs::read(data.join("baked/B_lightroom_filament/default_env_ibl.ktx")).unwrap());
    say(&format!("{:?}", file.values));
    let theirs4 = harmonics(&file.levels[4], 3);
    let spectrum = Spectrum::forward(source.texels(), source.grid().width(), 512, RowWeights::TexelSolidAngle);
    let sh = spectrum.to_sh(3);
    let lobe = |p: f64| Lobe::new(LobeShape::Ggx, LobeWeight::NDotL, PerceptualRoughness::clamped(p).to_alpha());
    let kernel = |l: &Lobe| zonal::zonal_coefficients(512, &|s| l.kernel_at_sin2_half(s), l.support_cos(), l.characteristic_angle()).unwrap().coefficients;
    let k4 = kernel(&lobe(1.0));
    let turn = rank_print("filament p=1", &theirs4, &Sh::new(3, sh.values().iter().enumerate().map(|(i, v)| v.map(|v| v * k4[(i as f64).sqrt() as usize])).collect()).unwrap());
    let r = ranked(|t| { let f = FilamentNine::from_radiance(&turned(&sh, |d| t.apply(d))); let th = file.colours("sh"); alignment(&f.values.iter().flatten().copied().collect::<Vec<_>>(), &th.iter().flatten().copied().collect::<Vec<_>>()) * -1.0 });
    for (t, m) in &r[..3] { say(&format!("nine {} {m}", t.name())); }
    let nine = FilamentNine::from_radiance(&turned(&sh, |d| r[0].0.apply(d)));
    for (a, b) in nine.values.iter().zip(file.colours("sh")) { say(&format!("{} {} ratio {}", a[0], b[0], b[0]/a[0])); }
    for (i, level) in file.levels.iter().enumerate() {
        let t = texels(level);
        say(&format!("level {i} mean {:?} source {:?}", level.mean(), source.mean()));
        if i == 0 {
            continue;
        }
        let step = (t.len() / 3000).max(1);
        let some: Vec<_> = t.iter().step_by(step).copied().collect();
        let dirs: Vec<Vec3> = some.iter().map(|s| turn.apply(s.0)).collect();
        let misfit = |p: f64| {
            let v = spectrum.evaluate(&kernel(&lobe(p)), &dirs);
            let (mut e, mut q) = (0.0, 0.0);
            for (v, s) in v.iter().zip(&some) { e += s.1 * (v[0] - s.2[0]).powi(2); q += s.1 * v[0] * v[0]; }
            (e / q).sqrt()
        };
        let nominal = 1.0 - (1.0 - i as f64 / 4.0).sqrt();
        let mut best = (0.0, f64::INFINITY);
        for k in 1..=50 { let p = k as f64 * 0.02; let m = misfit(p); if m < best.1 { best = (p, m); } }
        for k in -9..=9 { let p = best.0 + k as f64 * 0.002; if p <= 1.0 { let m = misfit(p); if m < best.1 { best = (p, m); } } }
        say(&format!("level {i}: nominal {nominal:.4} misfit {:.4}; best p {:.4} misfit {:.4}", misfit(nominal), best.0, best.1));
        // shift
        let n = level.grid().width() as f64;
        for (dx, dy) in [(0.5, 0.5), (-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5)] {
            let dirs: Vec<Vec3> = some.iter().map(|s| { let (f, u, v) = cube::uv(s.0); turn.apply(cube::direction(f, u + dx / n, v + dy / n)) }).collect();
            let v = spectrum.evaluate(&kernel(&lobe(nominal)), &dirs);
            let (mut e, mut q) = (0.0, 0.0);
            for (v, s) in v.iter().zip(&some) { e += s.1 * (v[0] - s.2[0]).powi(2); q += s.1 * v[0] * v[0]; }
            say(&format!("   shift {dx} {dy}: {:.4}", (e / q).sqrt()));
        }
    }
}

#[test]
fn materialx() {
    let Some(data) = data("materialx") else { return };
    let f = data.join("baked/C_sangiuseppe_materialx");
    let source = environment(f.join("source_2048x1024_half_piz.exr"), Projection::LatLong);
    let theirs = environment(f.join("irradiance_256x128.hdr"), Projection::LatLong);
    say(&format!("means {:?} {:?}", source.mean(), theirs.mean()));
    let st = lumisphere_image::statistics(&source);
    say(&format!("{:?} neg {} nan {}", st.brightest, st.negative, st.nan));
    compare_diffuse("C", &source, &theirs);
}

fn compare_diffuse(name: &str, source: &Environment, theirs: &Environment) {
    let spectrum = Spectrum::forward(source.texels(), source.grid().width(), 64, RowWeights::TexelSolidAngle);
    let ours = form(&spectrum.to_sh(3));
    let a = harmonics(theirs, 3);
    let turn = rank_print(name, &a, &ours);
    let t = turned(&ours, |d| turn.apply(d));
    for i in 0..9 { say(&format!("{:?} {:?} ratio {:.4}", a.values()[i], t.values()[i], a.values()[i][1] / t.values()[i][1])); }
    let a8 = harmonics(theirs, 9);
    let k: Vec<f64> = zonal::clamped_cosine(64).iter().map(|v| v / PI).collect();
    let o8 = spectrum.to_sh(9);
    let t8 = turned(&o8, |d| turn.apply(d));
    for l in 0..9 {
        let e = |s: &ShRgb| s.band(l).iter().flatten().map(|v| v * v).sum::<f64>().sqrt();
        say(&format!("band {l}: theirs {:.3e} ours {:.3e}", e(&a8), e(&t8) * k[l].abs()));
    }
    let all = texels(theirs);
    let dirs: Vec<Vec3> = all.iter().map(|s| turn.apply(s.0)).collect();
    for (n, b) in [("full", 64), ("order 2", 3)] {
        let v = spectrum.evaluate(&k[..b], &dirs);
        let (mut num, mut den) = ([0.0; 3], [0.0; 3]);
        for (v, s) in v.iter().zip(&all) { for c in 0..3 { num[c] += s.1 * s.2[c]; den[c] += s.1 * v[c]; } }
        let factor = [0, 1, 2].map(|c| num[c] / den[c]);
        let rms = relative_rms(theirs, |i, _| v[i]);
        let fit = relative_rms(theirs, |i, _| [0, 1, 2].map(|c| v[i][c] * factor[c]));
        say(&format!("{name} {n}: rms {rms:e}, energy {factor:?}, after energy {fit:e}"));
    }
}

#[test]
fn pisa() {
    let Some(data) = data("pisa") else { return };
    let f = data.join("baked/A_pisa_ktx2_gltfIBLSampler");
    let theirs = environment(f.join("pisa_diffuse_rgb9e5_zstd.ktx2"), Projection::Cube);
    let faces = cube_of_files(&f.join("source_cube_faces_threejs"), ["px.hdr", "nx.hdr", "py.hdr", "ny.hdr", "pz.hdr", "nz.hdr"]);
    let latlong = environment(f.join("source_latlong_probulator_pisa.hdr"), Projection::LatLong);
    say(&format!("means {:?} {:?} {:?}", theirs.mean(), faces.mean(), latlong.mean()));
    let (hf, hl) = (harmonics(&faces, 3), harmonics(&latlong, 3));
    rank_print("faces against latlong", &hf, &hl);
    let ll = Grid::new(Projection::LatLong, 512, 256).unwrap();
    let faces_ll = lumisphere_image::resample(&faces, ll, &Rotation::IDENTITY);
    compare_diffuse("A faces", &faces_ll, &theirs);
    compare_diffuse("A latlong", &latlong, &theirs);
}
