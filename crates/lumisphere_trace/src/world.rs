//! A scene made ready for paths.

use crate::TraceError;
use crate::finish::{Finish, Model, Scatter, varies};
use crate::geometry::Geometry;
use crate::light::{Arriving, Density, EnvironmentLight, LightTable, Source, shape};
use crate::rays::{Ray, offset_origin};
use crate::vertex::{Place, Vertex};
use lumisphere_bsdf::{AlbedoTables, Bsdf, Rgb};
use lumisphere_scene::photometry::luminance;
use lumisphere_scene::{Light, Scene, SurfacePoint};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{cross, dot, length, scale, sub, try_normalize};
use std::borrow::Cow;
use std::f64::consts::PI;
use std::sync::Arc;

/// A scene with its environment, ready for rays: triangles sorted, materials prepared, lights weighed.
///
/// What a path tracer needs beyond what the scene says:
/// - Triangles of materials that are neither double-sided nor transmit are seen from outside only; a ray that meets them from behind
///   goes on, as a renderer that culls back faces has it. All rays do so alike, those to lights too, so that light asked at the lights
///   is light that is met. Such a triangle is a one-way mirror: what lies before its front is shaded by it and sees it, even where the
///   eye looks through its back.
/// - A material with a volume bounds a body that light passes, with the index of the material; without one it is thin.
/// - Sphere and rectangle lights are seen, and stop what meets their shining side; the back of a rectangle is not there.
/// - The clear coat has the normal of its own texture, or the interpolated one of the vertices; what lies under it has its own
///   (KHR_materials_clearcoat).
#[derive(Debug)]
pub struct World<'a> {
    scene: &'a Scene,
    tables: &'a AlbedoTables,
    environment: Option<EnvironmentLight>,
    geometry: Geometry<'a>,
    /// Of each material; `None` where it depends on the place.
    finishes: Vec<Option<Finish>>,
    lights: LightTable,
}

/// Normals of textures in the frame of tangent, bitangent and normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bumps {
    pub(crate) base: Vec3,
    /// The clear coat's, where it is another.
    pub(crate) coat: Option<Vec3>,
}

/// What a ray meets.
#[derive(Debug)]
pub(crate) enum Meeting {
    /// Nothing: the environment.
    Nothing,
    /// One of the scene's lights.
    Light { index: usize, radiance: Rgb },
    /// A surface.
    Surface(Place),
}

/// Samples along each side of a triangle for the mean of what it emits.
const EMISSION_STEPS: usize = 4;
/// A ray to a light ends this much before it, relatively: neighbours of a triangle in its plane are no obstacle.
const SHORTENED: f64 = 1.0 - 1e-4;

impl<'a> World<'a> {
    /// Sorts the triangles of all instances and prepares the materials.
    ///
    /// # Errors
    /// Indices out of range, lists of other lengths than a mesh's positions, coordinates that are not finite, too many triangles.
    pub fn new(
        scene: &'a Scene,
        environment: Option<EnvironmentLight>,
        tables: &'a AlbedoTables,
    ) -> Result<Self, TraceError> {
        let geometry = Geometry::new(scene)?;
        let mut painted = vec![false; scene.materials.len()];
        for part in geometry.parts() {
            painted[part.instance.material] |= !part.mesh.colors.is_empty();
        }
        let finish = |index: usize| {
            let material = &scene.materials[index];
            let constant = !varies(material) && !painted[index];
            constant.then(|| Finish::new(&material.factors, material.volume.as_ref(), tables))
        };
        let finishes = (0..scene.materials.len()).map(finish).collect();
        let mut world = Self { scene, tables, environment, geometry, finishes, lights: LightTable::default() };
        let shapes: Vec<_> = scene.lights.iter().map(|light| light.shape).collect();
        let power = world.environment.as_ref().map_or(0.0, EnvironmentLight::power);
        world.lights = LightTable::new(&shapes, &world.emitting_triangles(), power);
        Ok(world)
    }

    /// The same world with a model of reflectance in the place of a material's: its numbers and textures count no more, but for
    /// emission, alpha and normals. Nothing happens where there is no such material.
    pub fn with_bsdf(mut self, material: usize, bsdf: Arc<dyn Bsdf>) -> Self {
        if let (Some(finish), Some(replaced)) = (self.finishes.get_mut(material), self.scene.materials.get(material)) {
            *finish = Some(Finish { scatter: Scatter::Model(Model(bsdf)), base_color: replaced.factors.base_color });
        }
        self
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The environment.
    pub fn environment(&self) -> Option<&EnvironmentLight> {
        self.environment.as_ref()
    }

    pub(crate) fn geometry(&self) -> &Geometry<'a> {
        &self.geometry
    }

    pub(crate) fn lights(&self) -> &LightTable {
        &self.lights
    }

    /// The nearest thing along a ray whose holes are drawn by `key`.
    pub(crate) fn meet(&self, ray: &Ray, key: u64) -> Meeting {
        let hit = self.geometry.closest(ray, f32::MAX, key);
        let end = hit.map_or(f64::INFINITY, |hit| f64::from(hit.t));
        match (self.nearest_light(ray), hit) {
            (Some((t, index, radiance)), _) if t < end => Meeting::Light { index, radiance },
            (_, Some(hit)) => {
                Meeting::Surface(Place { triangle: hit.triangle, at: [hit.u, hit.v], distance: f64::from(hit.t) })
            }
            _ => Meeting::Nothing,
        }
    }

    /// Distance, index and radiance.
    fn nearest_light(&self, ray: &Ray) -> Option<(f64, usize, Rgb)> {
        if self.scene.lights.is_empty() {
            return None;
        }
        let origin = ray.origin.map(f64::from);
        let direction = try_normalize(ray.direction.map(f64::from))?;
        let met = |(index, light): (usize, &Light)| {
            shape::meet(&light.shape, origin, direction).map(|(t, radiance)| (t, index, radiance))
        };
        self.scene.lights.iter().enumerate().filter_map(met).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether light from `arriving` reaches a point of a surface with this outer normal.
    pub(crate) fn reaches(&self, point: [f32; 3], normal: Vec3, source: Source, arriving: &Arriving, key: u64) -> bool {
        let ray = leaving(point, normal, arriving.wi);
        let (target, own) = match source {
            Source::Triangle(triangle) => (Some(triangle), None),
            Source::Shape(index) => (None, Some(index)),
            Source::Environment => (None, None),
        };
        let end = arriving.distance * SHORTENED;
        let (origin, direction) = (ray.origin.map(f64::from), arriving.wi);
        let in_the_way = |(index, light): (usize, &Light)| {
            Some(index) != own && shape::meet(&light.shape, origin, direction).is_some_and(|(t, _)| t < end)
        };
        let t_max = if end < f64::from(f32::MAX) { end as f32 } else { f32::MAX };
        !self.scene.lights.iter().enumerate().any(in_the_way) && !self.geometry.occluded(&ray, t_max, target, key)
    }

    /// Light that arrives at `point` from `source`.
    pub(crate) fn arriving(&self, source: Source, point: Vec3, u: [f64; 2]) -> Option<Arriving> {
        match source {
            Source::Shape(index) => shape::sample(&self.scene.lights.get(index)?.shape, point, u),
            Source::Triangle(triangle) => self.arriving_from_triangle(triangle, point, u),
            Source::Environment => {
                let sample = self.environment.as_ref()?.sample(u)?;
                let density = Density::Spread(sample.pdf);
                Some(Arriving { wi: sample.wi, distance: f64::INFINITY, light: sample.radiance, density })
            }
        }
    }

    /// The density of [`World::arriving`] from a triangle, per steradian, at a place that was met.
    pub(crate) fn triangle_pdf(&self, vertex: &Vertex, wi: Vec3) -> f64 {
        let area_vector = self.geometry.area_vector(vertex.place.triangle);
        let facing = 0.5 * dot(area_vector, wi).abs();
        if facing > 0.0 { vertex.place.distance * vertex.place.distance / facing } else { 0.0 }
    }

    /// Radiance that leaves a place of a triangle along `away`, where its surface is there.
    pub(crate) fn emitted(&self, triangle: u32, at: [f32; 2], away: Vec3) -> Rgb {
        let part = self.geometry.part(triangle);
        let outside = dot(self.geometry.area_vector(triangle), away);
        if !part.material.emits() || !(outside > 0.0 || part.material.double_sided && outside < 0.0) {
            return [0.0; 3];
        }
        self.emission(triangle, at)
    }

    /// The material that is the same everywhere, normals too.
    #[inline]
    pub(crate) fn constant_finish(&self, material: usize) -> Option<&Finish> {
        let textures = &self.scene.materials[material].textures;
        self.finishes[material].as_ref().filter(|_| textures.normal.is_none() && textures.clearcoat_normal.is_none())
    }

    /// The material at a place, and the normals of its textures.
    pub(crate) fn finish(&self, material: usize, point: &SurfacePoint) -> (Cow<'_, Finish>, Option<Bumps>) {
        let (index, material) = (material, &self.scene.materials[material]);
        if let Some(finish) = self.constant_finish(index) {
            return (Cow::Borrowed(finish), None);
        }
        let found = material.at(&self.scene.textures, &point.uv, point.color);
        let made = || Cow::Owned(Finish::new(&found.material, material.volume.as_ref(), self.tables));
        let coat = Some(found.clearcoat_normal).filter(|coat| *coat != found.normal);
        let bumps = Bumps { base: found.normal, coat };
        (self.finishes[index].as_ref().map_or_else(made, Cow::Borrowed), Some(bumps))
    }

    fn emission(&self, triangle: u32, at: [f32; 2]) -> Rgb {
        let material = self.geometry.part(triangle).material;
        let radiance = material.factors.emitted_radiance();
        match &material.textures.emissive {
            None => radiance,
            Some(slot) => {
                let point = self.geometry.surface_point(triangle, at);
                let texel = slot.sample(&self.scene.textures, &point.uv);
                std::array::from_fn(|c| radiance[c] * texel[c])
            }
        }
    }

    fn arriving_from_triangle(&self, triangle: u32, point: Vec3, u: [f64; 2]) -> Option<Arriving> {
        let at = in_triangle(u);
        let way = sub(self.geometry.point(triangle, at).map(f64::from), point);
        let (wi, distance) = (try_normalize(way)?, length(way));
        let facing = 0.5 * dot(self.geometry.area_vector(triangle), wi).abs();
        let there =
            if self.geometry.part(triangle).material.has_holes() { self.geometry.alpha(triangle, at) } else { 1.0 };
        let light = self.emitted(triangle, at, scale(wi, -1.0)).map(|c| c * there);
        let density = Density::Spread(distance * distance / facing);
        (facing > 0.0 && luminance(light) > 0.0).then_some(Arriving { wi, distance, light, density })
    }

    /// Triangles that emit and their luminous flux.
    fn emitting_triangles(&self) -> Vec<(u32, f64)> {
        let emitting = self.geometry.parts().iter().filter(|part| part.material.emits());
        let triangles =
            emitting.flat_map(|part| (part.first..part.first + part.mesh.triangles.len()).map(|t| t as u32));
        triangles.map(|t| (t, self.flux(t))).filter(|t| t.1 > 0.0).collect()
    }

    fn flux(&self, triangle: u32) -> f64 {
        let material = self.geometry.part(triangle).material;
        let [a, b, c] = self.geometry.corners(triangle).map(|p| p.map(f64::from));
        let area = 0.5 * length(cross(sub(b, a), sub(c, a)));
        let sides = if material.double_sided { 2.0 } else { 1.0 };
        let mean = if material.textures.emissive.is_none() {
            luminance(self.emission(triangle, [0.0; 2]))
        } else {
            let step = |i: usize| (i as f64 + 0.5) / EMISSION_STEPS as f64;
            let value = |i: usize| {
                luminance(self.emission(triangle, in_triangle([step(i / EMISSION_STEPS), step(i % EMISSION_STEPS)])))
            };
            (0..EMISSION_STEPS * EMISSION_STEPS).map(value).sum::<f64>() / (EMISSION_STEPS * EMISSION_STEPS) as f64
        };
        PI * area * sides * mean
    }
}

/// A ray that leaves a point of a surface with this outer normal.
pub(crate) fn leaving(point: [f32; 3], normal: Vec3, direction: Vec3) -> Ray {
    let [normal, direction] = [normal, direction].map(|v| v.map(|c| c as f32));
    Ray { origin: offset_origin(point, normal, direction), direction }
}

/// Barycentric weights of the second and third corner, all places alike.
fn in_triangle(u: [f64; 2]) -> [f32; 2] {
    let root = u[0].sqrt();
    [(root * (1.0 - u[1])) as f32, (root * u[1]) as f32]
}
