//! All triangles of a scene in the world, and what rays meet among them.

use crate::TraceError;
use crate::rays::{Hit, Ray, TRIANGLE_LIMIT, TriangleBvh, hit_point};
use crate::sampler::stray_number;
use lumisphere_scene::{Instance, Mesh, Scene, SceneMaterial, SurfacePoint};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{cross, dot, scale, sub, try_normalize};

/// Vertices of all instances: an index has 32 bits.
const VERTEX_LIMIT: usize = u32::MAX as usize;

/// The instances of a scene as one list of triangles in world space.
#[derive(Debug)]
pub(crate) struct Geometry<'s> {
    scene: &'s Scene,
    bvh: TriangleBvh,
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    parts: Vec<Part<'s>>,
    /// The part of each triangle.
    part_of: Vec<u32>,
    /// Whether no ray passes any triangle that it meets.
    solid: bool,
}

/// One instance.
#[derive(Debug)]
pub(crate) struct Part<'s> {
    pub(crate) mesh: &'s Mesh,
    pub(crate) instance: &'s Instance,
    pub(crate) material: &'s SceneMaterial,
    /// Its first triangle.
    pub(crate) first: usize,
    /// -1 where triangles run clockwise seen from outside.
    pub(crate) orientation: f64,
    /// The normals of the world are these three, each times a component of that of the mesh.
    normals: [Vec3; 3],
    /// Whether rays that meet it from behind go on.
    one_sided: bool,
}

impl<'s> Geometry<'s> {
    pub(crate) fn new(scene: &'s Scene) -> Result<Self, TraceError> {
        check_counts(scene)?;
        let mut parts = Vec::with_capacity(scene.instances.len());
        let (mut positions, mut triangles, mut part_of) = (Vec::new(), Vec::new(), Vec::new());
        for (index, instance) in scene.instances.iter().enumerate() {
            let part = Part::new(scene, index, instance, triangles.len())?;
            let base = positions.len() as u32;
            let map = &instance.world_from_local;
            positions.extend(part.mesh.positions.iter().map(|p| map.point(p.map(f64::from)).map(|c| c as f32)));
            triangles.extend(part.mesh.triangles.iter().map(|t| t.map(|i| i.saturating_add(base))));
            part_of.resize(triangles.len(), index as u32);
            parts.push(part);
        }
        let solid = parts.iter().all(|p| !p.one_sided && !p.material.has_holes());
        let bvh = TriangleBvh::build(&positions, &triangles)?;
        Ok(Self { scene, bvh, positions, triangles, parts, part_of, solid })
    }

    pub(crate) fn parts(&self) -> &[Part<'s>] {
        &self.parts
    }

    pub(crate) fn part_index(&self, triangle: u32) -> usize {
        self.part_of[triangle as usize] as usize
    }

    pub(crate) fn part(&self, triangle: u32) -> &Part<'s> {
        &self.parts[self.part_index(triangle)]
    }

    pub(crate) fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.triangles[triangle as usize].map(|i| self.positions[i as usize])
    }

    pub(crate) fn point(&self, triangle: u32, [u, v]: [f32; 2]) -> [f32; 3] {
        hit_point(self.corners(triangle), u, v)
    }

    /// Twice the area times the outward normal.
    #[inline]
    pub(crate) fn area_vector(&self, triangle: u32) -> Vec3 {
        area_vector(self.corners(triangle), self.part(triangle).orientation)
    }

    /// A point of a triangle and its outward unit normal; +Y for a triangle without area.
    #[inline]
    pub(crate) fn point_and_normal(&self, triangle: u32, [u, v]: [f32; 2]) -> ([f32; 3], Vec3) {
        let corners = self.corners(triangle);
        let area = area_vector(corners, self.part(triangle).orientation);
        (hit_point(corners, u, v), try_normalize(area).unwrap_or([0.0, 1.0, 0.0]))
    }

    /// What the vertices carry, in the space of the mesh.
    pub(crate) fn surface_point(&self, triangle: u32, [u, v]: [f32; 2]) -> SurfacePoint {
        let part = self.part(triangle);
        part.mesh.surface_point(triangle as usize - part.first, [f64::from(u), f64::from(v)])
    }

    /// The interpolated normal in the world, not normalised.
    #[inline]
    pub(crate) fn smooth_normal(&self, triangle: u32, [u, v]: [f32; 2]) -> Vec3 {
        let part = self.part(triangle);
        let [u, v] = [u, v].map(f64::from);
        let [a, b, c] =
            part.mesh.triangles[triangle as usize - part.first].map(|i| part.mesh.normals[i as usize].map(f64::from));
        let [x, y, z]: Vec3 = std::array::from_fn(|i| (1.0 - u - v) * a[i] + u * b[i] + v * c[i]);
        std::array::from_fn(|i| part.normals[0][i] * x + part.normals[1][i] * y + part.normals[2][i] * z)
    }

    /// The nearest triangle that is there for a ray; holes are drawn by `key`.
    pub(crate) fn closest(&self, ray: &Ray, t_max: f32, key: u64) -> Option<Hit> {
        if self.solid {
            return self.bvh.closest_hit(ray, t_max);
        }
        self.bvh.closest_hit_if(ray, t_max, |triangle, u, v| self.stops(ray, triangle, [u, v], key))
    }

    /// Whether any triangle but `target` is in the way.
    pub(crate) fn occluded(&self, ray: &Ray, t_max: f32, target: Option<u32>, key: u64) -> bool {
        self.bvh.occluded_if(ray, t_max, |triangle, u, v| {
            Some(triangle) != target && (self.solid || self.stops(ray, triangle, [u, v], key))
        })
    }

    fn stops(&self, ray: &Ray, triangle: u32, at: [f32; 2], key: u64) -> bool {
        let part = self.part(triangle);
        if part.one_sided && dot(self.area_vector(triangle), ray.direction.map(f64::from)) >= 0.0 {
            return false;
        }
        if !part.material.has_holes() {
            return true;
        }
        stray_number(key, triangle) < self.alpha(triangle, at)
    }

    /// The share of the surface that is there.
    pub(crate) fn alpha(&self, triangle: u32, at: [f32; 2]) -> f64 {
        let point = self.surface_point(triangle, at);
        self.part(triangle).material.alpha_at(&self.scene.textures, &point.uv, point.color[3])
    }
}

impl<'s> Part<'s> {
    fn new(scene: &'s Scene, index: usize, instance: &'s Instance, first: usize) -> Result<Self, TraceError> {
        let missing = |what: &str, found, count: usize| TraceError::Scene {
            what: format!("{what} of instance {index}"),
            found,
            expected: format!("one of {count}"),
        };
        let mesh =
            scene.meshes.get(instance.mesh).ok_or_else(|| missing("the mesh", instance.mesh, scene.meshes.len()))?;
        let material = scene
            .materials
            .get(instance.material)
            .ok_or_else(|| missing("the material", instance.material, scene.materials.len()))?;
        expect_vertex_data(mesh, index)?;
        let orientation = if instance.world_from_local.is_mirrored() { -1.0 } else { 1.0 };
        let one_sided = !material.double_sided && material.factors.transmission <= 0.0;
        let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|n| instance.world_from_local.normal(n));
        Ok(Self { mesh, instance, material, first, orientation, normals, one_sided })
    }
}

#[inline]
fn area_vector(corners: [[f32; 3]; 3], orientation: f64) -> Vec3 {
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    scale(cross(sub(b, a), sub(c, a)), orientation)
}

/// Triangles and vertices of all instances together, before any of them is copied.
fn check_counts(scene: &Scene) -> Result<(), TraceError> {
    let (triangles, vertices) = (scene.triangle_count(), scene.vertex_count());
    if triangles > TRIANGLE_LIMIT {
        return Err(TraceError::TooManyTriangles { found: triangles, limit: TRIANGLE_LIMIT });
    }
    if vertices > VERTEX_LIMIT {
        let (what, expected) = ("the number of vertices".to_owned(), format!("at most {VERTEX_LIMIT}"));
        return Err(TraceError::Scene { what, found: vertices, expected });
    }
    Ok(())
}

/// The lists of a mesh are as long as its positions, or may be empty, and its triangles name its own vertices.
fn expect_vertex_data(mesh: &Mesh, instance: usize) -> Result<(), TraceError> {
    let count = mesh.positions.len();
    let optional = [mesh.tangents.len(), mesh.uv[0].len(), mesh.uv[1].len(), mesh.colors.len()];
    if let Some(found) = mesh.triangles.iter().flatten().find(|&&i| i as usize >= count) {
        let what = format!("a vertex of a triangle of the mesh of instance {instance}");
        return Err(TraceError::Scene { what, found: *found as usize, expected: format!("below {count}") });
    }
    let bad = optional.into_iter().filter(|&n| n != 0).chain([mesh.normals.len()]).find(|&n| n != count);
    bad.map_or(Ok(()), |found| {
        Err(TraceError::Scene {
            what: format!("the length of a list of the mesh of instance {instance}"),
            found,
            expected: format!("{count}, one for each position"),
        })
    })
}
