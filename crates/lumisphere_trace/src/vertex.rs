//! A place on a surface that a path has come to.

use crate::finish::{Finish, Scatter};
use crate::world::World;
use lumisphere_bsdf::{Bsdf, Rgb};
use lumisphere_scene::SceneMaterial;
use lumisphere_sphere::vector::{cross, dot, scale, sub, try_normalize};
use lumisphere_sphere::{Frame, Vec3};
use std::borrow::Cow;

/// Where a ray met a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) triangle: u32,
    pub(crate) at: [f32; 2],
    pub(crate) distance: f64,
}

/// The surface at a place, with what is needed to scatter there.
#[derive(Debug)]
pub(crate) struct Vertex<'w> {
    pub(crate) place: Place,
    pub(crate) point: [f32; 3],
    /// Unit normal of the triangle: outwards, or to the viewer for a surface without an inside.
    pub(crate) normal: Vec3,
    pub(crate) material: &'w SceneMaterial,
    /// Of shading: its normal is on the viewer's side just where `normal` is.
    pub(crate) frame: Frame,
    /// That of a clear coat that the viewer sees, in `frame`, where it is another; its normal is on the viewer's side too.
    coat: Option<Frame>,
    /// To the viewer, in `frame`.
    pub(crate) wo: Vec3,
    pub(crate) finish: Cow<'w, Finish>,
}

/// Cosine of the viewer to a shading normal that would turn away from it, after it has been bent back.
const BENT: f64 = 1e-3;

impl<'w> Vertex<'w> {
    /// What a ray that came along the unit `direction` sees.
    pub(crate) fn new(world: &'w World, place: Place, direction: Vec3) -> Self {
        let geometry = world.geometry();
        let part = geometry.part(place.triangle);
        let (point, outward) = geometry.point_and_normal(place.triangle, place.at);
        let wo = scale(direction, -1.0);
        let (finish, textured) = match world.constant_finish(part.instance.material) {
            Some(finish) if part.mesh.tangents.is_empty() => (Cow::Borrowed(finish), None),
            _ => {
                let local = geometry.surface_point(place.triangle, place.at);
                let (finish, bumps) = world.finish(part.instance.material, &local);
                (finish, local.tangent.map(|tangent| (tangent, bumps)))
            }
        };
        let turned = !matches!(finish.scatter, Scatter::Body(_)) && dot(outward, wo) < 0.0;
        let side = if turned { -1.0 } else { 1.0 };
        let normal = scale(outward, side);
        let smooth = try_normalize(geometry.smooth_normal(place.triangle, place.at)).unwrap_or(outward);
        let (unbent, coat) = match textured {
            None => (Frame::from_normal(smooth), None),
            Some(([x, y, z, w], bumps)) => {
                let tangent = part.instance.world_from_local.vector([x, y, z]);
                let bent = |bump| shading_frame(smooth, (tangent, w * part.orientation), bump);
                let coat = bumps.and_then(|bumps| bumps.coat).filter(|_| finish.scatter.is_coated());
                (bent(bumps.map(|bumps| bumps.base)), coat.map(|bump| bent(Some(bump))))
            }
        };
        let faced = |unbent: Frame| {
            let outer = Frame { normal: scale(unbent.normal, side), ..unbent };
            facing(outer, wo, dot(normal, wo))
        };
        let (frame, coat) = (faced(unbent), coat.map(faced));
        let wo = frame.local_from_world(wo);
        let coat = coat.filter(|_| wo[2] > 0.0).map(|coat| seen_from(&frame, &coat));
        Self { place, point, normal, material: part.material, wo, frame, coat, finish }
    }

    /// f |cos θ| for light from `wi`, and the density with which [`Vertex::sample`] goes there; `None` where the sides of shading and
    /// of the triangle differ, so that no light leaks.
    pub(crate) fn scattered(&self, wi: Vec3) -> Option<(Rgb, f64)> {
        if let Some(coat) = &self.coat {
            return self.scattered_by_layers(coat, wi);
        }
        let local = self.local(wi)?;
        let f = self.finish.scatter.eval(self.wo, local);
        let cosine = local[2].abs();
        Some((f.map(|f| f * cosine), self.finish.scatter.pdf(self.wo, local)))
    }

    /// A direction to go on, f |cos θ| / pdf, and the density.
    pub(crate) fn sample(&self, u: [f64; 3]) -> Option<(Vec3, Rgb, f64)> {
        if let Some(coat) = &self.coat {
            return self.sample_layers(coat, u);
        }
        let sample = self.finish.scatter.sample(self.wo, u)?;
        let wi = try_normalize(self.frame.world_from_local(sample.wi))?;
        self.local(wi)?;
        Some((wi, sample.weight, sample.pdf))
    }

    /// Whether the viewer is inside the body that this surface bounds.
    pub(crate) fn seen_from_inside(&self) -> bool {
        self.wo[2] < 0.0 && matches!(self.finish.scatter, Scatter::Body(_))
    }

    fn local(&self, wi: Vec3) -> Option<Vec3> {
        let local = self.frame.local_from_world(wi);
        (local[2] * dot(self.normal, wi) > 0.0).then_some(local)
    }

    /// [`Vertex::scattered`] of a coat with a frame of its own: each layer scatters where its side and the triangle's are one. The
    /// density is that of all ways to come to `wi`, of those too whose layer does not scatter there.
    fn scattered_by_layers(&self, coat: &Frame, wi: Vec3) -> Option<(Rgb, f64)> {
        let local = self.frame.local_from_world(wi);
        let outside = dot(self.normal, wi);
        let cosine = |z: f64| if z * outside > 0.0 { z.abs() } else { 0.0 };
        let (under, over) = (cosine(local[2]), cosine(coat.local_from_world(local)[2]));
        if under + over == 0.0 {
            return None;
        }
        let [f_under, f_coat] = self.finish.scatter.layers(coat, self.wo, local);
        let scattered = std::array::from_fn(|c| f_under[c] * under + f_coat[c] * over);
        Some((scattered, self.finish.scatter.layers_pdf(coat, self.wo, local)))
    }

    fn sample_layers(&self, coat: &Frame, u: [f64; 3]) -> Option<(Vec3, Rgb, f64)> {
        let local = self.finish.scatter.sample_layers(coat, self.wo, u)?;
        let wi = try_normalize(self.frame.world_from_local(local))?;
        let (scattered, pdf) = self.scattered_by_layers(coat, wi)?;
        (pdf > 0.0 && pdf.is_finite()).then(|| (wi, scattered.map(|s| s / pdf), pdf))
    }
}

/// The frame of shading about the outer normal: tangents along those of the mesh, the normal bent by `bump`.
fn shading_frame(normal: Vec3, (tangent, handedness): (Vec3, f64), bump: Option<Vec3>) -> Frame {
    let frame = frame_along(normal, tangent, handedness);
    match bump.and_then(|bump| try_normalize(frame.world_from_local(bump))) {
        Some(normal) => frame_along(normal, frame.tangent, handedness),
        None => frame,
    }
}

/// The frame whose tangent is nearest to `tangent`.
fn frame_along(normal: Vec3, tangent: Vec3, handedness: f64) -> Frame {
    match try_normalize(sub(tangent, scale(normal, dot(normal, tangent)))) {
        Some(tangent) => Frame { tangent, bitangent: scale(cross(normal, tangent), handedness), normal },
        None => Frame::from_normal(normal),
    }
}

/// The frame with its normal bent so that the viewer is on the same side of it as of the triangle, whose cosine is `side`.
fn facing(frame: Frame, wo: Vec3, side: f64) -> Frame {
    let wanted = BENT.copysign(side);
    let cosine = dot(frame.normal, wo);
    if cosine * wanted >= BENT * BENT {
        return frame;
    }
    let bent = sub(frame.normal, scale(wo, cosine - wanted));
    try_normalize(bent).map_or(frame, |normal| frame_along(normal, frame.tangent, handedness(&frame)))
}

/// The second frame in the first.
fn seen_from(frame: &Frame, other: &Frame) -> Frame {
    let [tangent, bitangent, normal] =
        [other.tangent, other.bitangent, other.normal].map(|axis| frame.local_from_world(axis));
    Frame { tangent, bitangent, normal }
}

fn handedness(frame: &Frame) -> f64 {
    1.0_f64.copysign(dot(cross(frame.normal, frame.tangent), frame.bitangent))
}
