//! Traces a built-in scene under a sky and writes a PPM: `picture NAME WIDTH HEIGHT SAMPLES OUT`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
use lumisphere_bsdf::AlbedoTables;
use lumisphere_image::Builtin as Sky;
use lumisphere_scene::Builtin;
use lumisphere_sphere::Rotation;
use lumisphere_trace::{EnvironmentFilter, EnvironmentLight, Render, TraceSettings, World};
use std::ops::ControlFlow;
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |i: usize| arguments[i].parse::<usize>().unwrap();
    let scene = Builtin::from_name(&arguments[1]).unwrap().build();
    let (width, height, samples) = (number(2), number(3), number(4));
    let tables = AlbedoTables::compute();
    let start = Instant::now();
    let sky = Sky::from_name("studio").unwrap().render(256);
    let sky = EnvironmentLight::new(sky, EnvironmentFilter::Bilinear, Rotation::IDENTITY).unwrap();
    let world = World::new(&scene, Some(sky), &tables).unwrap();
    println!("{} triangles made ready in {:.3} s", scene.triangle_count(), start.elapsed().as_secs_f64());
    let mut settings = TraceSettings::standard();
    settings.target.samples = samples as u32;
    let mut render =
        Render::new(&world, &scene.camera(width as f64 / height as f64), [width, height], settings).unwrap();
    let start = Instant::now();
    render.run(|_| ControlFlow::Continue(()));
    let seconds = start.elapsed().as_secs_f64();
    println!("{:.3e} samples a second, noise {:.4}", (width * height * samples) as f64 / seconds, render.error());
    let picture = render.picture();
    let byte = |c: f32| {
        let c = c.clamp(0.0, 1.0);
        let encoded = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0 + 0.5) as u8
    };
    let mut bytes = format!("P6 {width} {height} 255\n").into_bytes();
    bytes.extend(picture.radiance.iter().flatten().map(|&c| byte(c)));
    std::fs::write(&arguments[5], bytes).unwrap();
}
