//! A surface whose clear coat has a normal of its own.

use super::Surface;
use crate::Rgb;
use lumisphere_sphere::{Frame, Vec3};

/// A [`Surface`] whose clear coat lies about another normal than what is under it (KHR_materials_clearcoat, normal textures).
///
/// Directions are in the frame of what lies under the coat, z its normal. Each layer has its own cosine, so their f come apart:
///
/// ```text
/// f cos θ = c f_coat cos θ_coat + (1 - c E_coat(v)) f_under |cos θ|
/// ```
///
/// with f_coat, E_coat and θ_coat about the coat's normal and f_under as [`Surface`] has it. In a white furnace the two add up to 1 as
/// there, whatever the normals. Where the frames are one it is the surface itself. Black for a viewer below either normal; the coat
/// reflects light above its own normal only.
#[derive(Debug, Clone, Copy)]
pub struct BentCoat<'s> {
    surface: &'s Surface,
    frame: &'s Frame,
}

impl<'s> BentCoat<'s> {
    /// `frame` is that of the coat, orthonormal; how it is turned about its normal does not matter.
    pub fn new(surface: &'s Surface, frame: &'s Frame) -> Self {
        Self { surface, frame }
    }

    /// c f_coat in sr⁻¹, for the cosine about the coat's normal.
    pub fn coat(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.seen(wo).map_or(0.0, |over| self.surface.coat(over, self.frame.local_from_world(wi)))
    }

    /// (1 - c E_coat(v)) f_under in sr⁻¹, for the cosine about the normal of what lies under the coat.
    pub fn under(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.seen(wo).map_or([0.0; 3], |over| self.surface.under(wo, wi, self.surface.coat_albedo(over)))
    }

    /// A direction to go on for a random point of the unit cube: of the coat or of what is under it, as often as [`Surface`] has it for
    /// the coat's view of `wo`. `None` where the sampler fails.
    pub fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<Vec3> {
        let over = self.seen(wo)?;
        let odds = self.surface.odds(wo, self.surface.coat_albedo(over));
        if u[2] < odds.coat {
            self.surface.sample_coat(over, u).map(|wi| self.frame.world_from_local(wi))
        } else {
            self.surface.sample_under(wo, u, &odds)
        }
    }

    /// The density of [`BentCoat::sample`] per steradian: both layers', each about its normal.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        let Some(over) = self.seen(wo) else { return 0.0 };
        let odds = self.surface.odds(wo, self.surface.coat_albedo(over));
        let coat = self.surface.pdf_coat(over, self.frame.local_from_world(wi), &odds);
        coat + self.surface.pdf_under(wo, wi, &odds)
    }

    /// The viewer about the coat's normal.
    fn seen(&self, wo: Vec3) -> Option<Vec3> {
        let over = self.frame.local_from_world(wo);
        (wo[2] > 0.0 && over[2] > 0.0).then_some(over)
    }
}
