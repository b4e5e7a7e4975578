//! A scene in both programs.

use crate::judge::{Job, Picture, folder};
use crate::paint::{Paint, rgb};
use lumisphere_bsdf::{AlbedoTables, Bsdf};
use lumisphere_codec::{Limits, decode_picture};
use lumisphere_image::Environment;
use lumisphere_scene::{Affine, Camera, Instance, Light, LightShape, Mesh, Scene};
use lumisphere_sphere::vector::{add, length, normalize};
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use lumisphere_trace::{EnvironmentFilter, EnvironmentLight, Render, Sequence, TraceSettings, TracedPicture, World};
use serde_json::{Map, Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// The same scene twice.
pub(crate) struct Twin {
    pub name: String,
    pub scene: Scene,
    models: Vec<(usize, Arc<dyn Bsdf>)>,
    environment: Option<EnvironmentLight>,
    camera: Camera,
    size: [usize; 2],
    theirs: Map<String, Value>,
}

impl Twin {
    /// Seen from the first of two points towards the second under a vertical angle.
    pub(crate) fn new(name: &str, [eye, target]: [Vec3; 2], degrees: f64, size: [usize; 2]) -> Self {
        let camera = Camera::looking_at(eye, target, degrees.to_radians());
        let film = json!({
            "type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": { "type": "box" },
            "pixel_format": "rgb", "component_format": "float32",
        });
        let sensor = json!({
            "type": "perspective", "fov": degrees, "fov_axis": "y", "near_clip": 0.01, "far_clip": 1000.0,
            "film": film, "sampler": { "type": "independent" },
            "to_world": matrix(&facing(&camera.world_from_camera)),
        });
        let mut theirs = Map::new();
        theirs.insert("type".into(), "scene".into());
        theirs.insert("integrator".into(), json!({ "type": "path", "max_depth": -1 }));
        theirs.insert("sensor".into(), sensor);
        let (scene, models) = (Scene::default(), Vec::new());
        Self { name: name.into(), scene, models, environment: None, camera, size, theirs }
    }

    /// A thing of a paint.
    pub(crate) fn put(&mut self, mesh: Mesh, at: Affine, paint: Paint) {
        self.put_lit(mesh, at, paint, None);
    }

    /// A thing that may shine.
    pub(crate) fn put_lit(&mut self, mesh: Mesh, at: Affine, paint: Paint, emitter: Option<Value>) {
        let index = self.scene.instances.len();
        let file = folder().join(format!("{}-{index}.ply", self.name));
        std::fs::write(&file, ply(&mesh, &at)).unwrap();
        let mut theirs = json!({ "type": "ply", "filename": file, "bsdf": paint.theirs });
        if let Some(emitter) = emitter {
            theirs["emitter"] = emitter;
        }
        self.theirs.insert(format!("thing{index}"), theirs);
        self.models.extend(paint.model.map(|model| (index, model)));
        self.scene.meshes.push(mesh);
        self.scene.materials.push(paint.material);
        let place = Instance { name: String::new(), mesh: index, material: index, world_from_local: at };
        self.scene.instances.push(place);
    }

    pub(crate) fn shine(&mut self, shape: LightShape) {
        self.theirs.insert(format!("light{}", self.scene.lights.len()), their_light(&shape));
        self.scene.lights.push(Light { name: String::new(), shape });
    }

    /// The environment of texels, each told to the other as numbers.
    pub(crate) fn under(&mut self, picture: Environment, intensity: f64, degrees: f64) {
        let file = folder().join(format!("{}.f32", self.name));
        let bytes: Vec<u8> = picture.texels().iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        std::fs::write(&file, bytes).unwrap();
        self.lit(picture, json!({ "texels": file, "intensity": intensity, "turn": degrees }), intensity, degrees);
    }

    /// The environment of a file, which either program reads for itself.
    pub(crate) fn under_file(&mut self, file: &Path, intensity: f64, degrees: f64) {
        let picture = decode_picture(&std::fs::read(file).unwrap(), &Limits::default()).unwrap();
        let grid = Grid::new(Projection::LatLong, picture.width, picture.height).unwrap();
        let picture = Environment::new(grid, picture.texels).unwrap();
        self.lit(picture, json!({ "file": file, "intensity": intensity, "turn": degrees }), intensity, degrees);
    }

    fn lit(&mut self, mut picture: Environment, mut told: Value, intensity: f64, degrees: f64) {
        told["height"] = picture.grid().height().into();
        picture.texels_mut().iter_mut().flatten().for_each(|c| *c = (f64::from(*c) * intensity) as f32);
        let turn = Rotation::from_axis_angle([0.0, 1.0, 0.0], degrees.to_radians());
        self.environment = Some(EnvironmentLight::new(picture, EnvironmentFilter::Bilinear, turn).unwrap());
        self.theirs.insert("environment".into(), told);
    }

    /// What Mitsuba is told, changed: for what must be found.
    pub(crate) fn told(mut self, change: impl Fn(&mut Map<String, Value>)) -> Self {
        change(&mut self.theirs);
        self
    }

    /// Ours with independent samples.
    pub(crate) fn ours(&self, tables: &AlbedoTables, samples: u32) -> Picture {
        let world = self.world(tables);
        let settings = TraceSettings { sequence: Sequence::Independent, seed: 1, ..TraceSettings::reference() };
        let start = Instant::now();
        let picture = self.traced(&world, settings, samples);
        let wide = |pixels: &[[f32; 3]]| pixels.iter().map(|p| p.map(f64::from)).collect();
        let seconds = [start.elapsed().as_secs_f64(); 2];
        Picture { mean: wide(&picture.radiance), variance: wide(&picture.variance), seconds }
    }

    pub(crate) fn world<'a>(&'a self, tables: &'a AlbedoTables) -> World<'a> {
        let world = World::new(&self.scene, self.environment.clone(), tables).unwrap();
        self.models.iter().fold(world, |world, (material, model)| world.with_bsdf(*material, model.clone()))
    }

    /// What Mitsuba is asked for.
    pub(crate) fn job(&self, [passes, samples, seed]: [u32; 3]) -> Job {
        Job { name: self.name.clone(), scene: self.theirs.clone().into(), passes, samples, seed }
    }

    /// Ours.
    pub(crate) fn traced(&self, world: &World, settings: TraceSettings, samples: u32) -> TracedPicture {
        let mut render = Render::new(world, &self.camera, self.size, settings).unwrap();
        render.pass(samples);
        render.picture()
    }
}

/// Ours looks along -Z with +X to the right, Mitsuba's along +Z with +X to the left.
fn facing(camera: &Affine) -> Affine {
    let [x, y, z] = camera.columns;
    Affine { columns: [x.map(|c| -c), y, z.map(|c| -c)], ..*camera }
}

/// Row by row.
fn matrix(map: &Affine) -> Vec<f64> {
    let row = |i: usize| [map.columns[0][i], map.columns[1][i], map.columns[2][i], map.translation[i]];
    (0..3).flat_map(row).chain([0.0, 0.0, 0.0, 1.0]).collect()
}

/// Candela are W/sr, lux W/m² and nit W/(sr m²) with an efficacy of 1 lm/W: the same numbers.
fn their_light(shape: &LightShape) -> Value {
    let toward =
        |at: Vec3, direction: Vec3| matrix(&facing(&Affine::looking_at(at, add(at, direction), [0.0, 1.0, 0.0])));
    match *shape {
        LightShape::Point { position, intensity } => {
            json!({ "type": "point", "position": position, "intensity": rgb(intensity) })
        }
        LightShape::Spot { position, direction, intensity, inner_angle, outer_angle } => json!({
            "type": "spot", "to_world": toward(position, direction), "intensity": rgb(intensity),
            "falloff": [inner_angle, outer_angle],
        }),
        LightShape::Directional { direction, illuminance } => {
            json!({ "type": "directional", "direction": direction, "irradiance": rgb(illuminance) })
        }
        LightShape::Sphere { center, radius, luminance } => json!({
            "type": "sphere", "center": center, "radius": radius,
            "emitter": { "type": "area", "radiance": rgb(luminance) }, "bsdf": black(),
        }),
        LightShape::Rectangle { center, half_edges: [a, b], luminance } => {
            let normal = shape.rectangle_normal().unwrap();
            assert!(length(normal) > 0.5);
            json!({
                "type": "rectangle", "to_world": matrix(&Affine { columns: [a, b, normal], translation: center }),
                "emitter": { "type": "area", "radiance": rgb(luminance) }, "bsdf": black(),
            })
        }
    }
}

fn black() -> Value {
    json!({ "type": "diffuse", "reflectance": rgb([0.0; 3]) })
}

/// The mesh in the world.
fn ply(mesh: &Mesh, at: &Affine) -> Vec<u8> {
    let properties: String = ["x", "y", "z", "nx", "ny", "nz"].map(|p| format!("property float {p}\n")).concat();
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let (p, n) = (at.point(p.map(f64::from)), normalize(at.normal(n.map(f64::from))));
        bytes.extend(p.iter().chain(&n).flat_map(|c| (*c as f32).to_le_bytes()));
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}
