//! The layered material and the albedo tables it needs.

/// Directional albedo over n·v and perceptual roughness for the layers of a material.
#[derive(Debug, Clone)]
pub struct AlbedoTables {}

impl AlbedoTables {
    /// Computes them.
    pub fn compute() -> Self {
        Self {}
    }
}
