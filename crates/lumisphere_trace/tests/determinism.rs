//! The same bytes for any number of threads, any division into passes, and after a stop.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::{AlbedoTables, Material};
use lumisphere_scene::{AlphaMode, Camera, LightShape, Scene, SceneMaterial};
use lumisphere_testkit::noise_with_sun;
use lumisphere_trace::{Ended, PixelFilter, Render, TraceError, TraceSettings, TracedPicture, World};
use std::ops::ControlFlow;
use worlds::*;

fn cluttered() -> Scene {
    let mut scene = scene(sides([0.4, 0.5, 0.3], 1.0), SceneMaterial::plain("box", Material::default()));
    scene.materials.push(SceneMaterial {
        alpha_mode: AlphaMode::Blend,
        base_alpha: 0.4,
        double_sided: true,
        ..SceneMaterial::plain("veil", matt(0.5))
    });
    add(&mut scene, quad([0.0, 0.0, 0.7], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), 1);
    add(&mut scene, quad([0.0, -0.5, 0.0], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]), 0);
    scene.lights.push(light(LightShape::Sphere { center: [1.0, 1.5, 0.5], radius: 0.2, luminance: [9.0; 3] }));
    scene
}

fn camera() -> Camera {
    Camera::looking_at([1.0, 1.0, 3.0], [0.0; 3], 0.8)
}

const SIZE: [usize; 2] = [37, 21];

fn settings() -> TraceSettings {
    TraceSettings { filter: PixelFilter::Gaussian { deviation: 0.5 }, bounces: Some(5), seed: 4, ..stratified(12) }
}

fn with_world<T>(f: impl FnOnce(&World) -> T) -> T {
    let (scene, tables) = (cluttered(), AlbedoTables::compute());
    let sky = environment(noise_with_sun(32, 16, 1, 50.0).unwrap());
    f(&World::new(&scene, Some(sky), &tables).unwrap())
}

fn whole(world: &World) -> TracedPicture {
    let mut render = Render::new(world, &camera(), SIZE, settings()).unwrap();
    assert_eq!(render.run(|_| ControlFlow::Continue(())), Ended::Samples);
    render.picture()
}

#[test]
fn threads_and_passes_do_not_matter() {
    with_world(|world| {
        let expected = whole(world);
        assert!(expected.radiance.iter().flatten().all(|c| c.is_finite()));
        assert!(expected.radiance.iter().any(|c| c[0] > 0.0) && expected.depth.iter().any(|d| *d > 0.0));
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| whole(world)), expected, "{threads} threads");
        }
        let mut render = Render::new(world, &camera(), SIZE, settings()).unwrap();
        [1, 4, 7].into_iter().for_each(|count| render.pass(count));
        assert_eq!(render.picture(), expected);
        let other = TraceSettings { seed: 5, ..settings() };
        let mut render = Render::new(world, &camera(), SIZE, other).unwrap();
        render.pass(12);
        assert_ne!(render.picture().radiance, expected.radiance);
    });
}

#[test]
fn a_stopped_picture_goes_on_as_if_it_had_not() {
    with_world(|world| {
        let expected = whole(world);
        let mut first = Render::new(world, &camera(), SIZE, settings()).unwrap();
        let stop = |samples| if samples >= 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        assert_eq!(first.run(|p| stop(p.samples)), Ended::Stopped);
        assert_eq!(first.samples(), 4);
        let bytes = first.checkpoint();
        let mut second = Render::resume(world, &camera(), SIZE, settings(), &bytes).unwrap();
        second.run(|_| ControlFlow::Continue(()));
        assert_eq!(second.picture(), expected);
        assert_eq!(second.checkpoint(), {
            let mut render = Render::new(world, &camera(), SIZE, settings()).unwrap();
            render.pass(12);
            render.checkpoint()
        });
    });
}

#[test]
fn checkpoints_of_other_pictures_and_damaged_ones_are_refused() {
    with_world(|world| {
        let mut render = Render::new(world, &camera(), SIZE, settings()).unwrap();
        render.pass(1);
        let bytes = render.checkpoint();
        let resume = |size, settings, bytes: &[u8]| {
            let refused = Render::resume(world, &camera(), size, settings, bytes).err();
            assert!(matches!(refused, Some(TraceError::Checkpoint { .. })), "{refused:?}");
        };
        resume([21, 37], settings(), &bytes);
        resume([37, 20], settings(), &bytes);
        resume(SIZE, TraceSettings { seed: 5, ..settings() }, &bytes);
        resume(SIZE, settings(), b"");
        resume(SIZE, settings(), &bytes[..bytes.len() - 1]);
        for place in [0, 9, 17, 30, 500, bytes.len() - 3] {
            let mut damaged = bytes.clone();
            damaged[place] ^= 4;
            resume(SIZE, settings(), &damaged);
        }
        let (mut moved, tables) = (cluttered(), AlbedoTables::compute());
        moved.meshes[0].positions[2][1] += 1e-3;
        let sky = environment(noise_with_sun(32, 16, 1, 50.0).unwrap());
        let other = World::new(&moved, Some(sky), &tables).unwrap();
        assert!(Render::resume(&other, &camera(), SIZE, settings(), &bytes).is_err());
        // Another target is no other picture.
        let mut longer = settings();
        longer.target.samples = 99;
        assert!(Render::resume(world, &camera(), SIZE, longer, &bytes).is_ok());
    });
}

#[test]
fn targets_end_a_run() {
    with_world(|world| {
        let mut by_error = settings();
        (by_error.target.samples, by_error.target.error) = (4096, Some(0.2));
        let mut render = Render::new(world, &camera(), [8, 8], by_error).unwrap();
        assert_eq!(render.run(|_| ControlFlow::Continue(())), Ended::Error);
        assert!(render.samples() >= 16 && render.error() <= 0.2);
        let mut by_time = settings();
        (by_time.target.samples, by_time.target.seconds) = (u32::MAX, Some(1e-3));
        let mut render = Render::new(world, &camera(), [8, 8], by_time).unwrap();
        assert_eq!(render.run(|_| ControlFlow::Continue(())), Ended::Time);
        for bad in [
            TraceSettings { bounces: Some(0), ..settings() },
            TraceSettings { filter: PixelFilter::Gaussian { deviation: f64::NAN }, ..settings() },
        ] {
            assert!(Render::new(world, &camera(), SIZE, bad).is_err());
        }
        assert!(Render::new(world, &camera(), [0, 4], settings()).is_err());
    });
}
