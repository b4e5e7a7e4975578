//! A decoded picture that nobody has laid over a sphere yet.

use crate::environment::Rgb;
use lumisphere_sphere::Projection;

/// What a decoder returns: linear Rec.709 radiance, top row first, left texel first.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width in texels.
    pub width: usize,
    /// Height in texels.
    pub height: usize,
    /// `width * height` texels.
    pub texels: Vec<Rgb>,
    /// The file's own word for its layout, such as OpenEXR's `envmap` attribute.
    pub projection: Option<Projection>,
    /// Facts worth telling a user: format, compression, exposure divided out, channels ignored.
    pub notes: Vec<String>,
}
