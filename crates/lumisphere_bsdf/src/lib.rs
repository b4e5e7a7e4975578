//! Reflectance: [`Bsdf`], the triad `eval / sample / pdf` of every model, and what image-based lighting needs of them:
//! normal distributions, masking-shadowing, Fresnel, prefilter lobes and
//! directional albedo (the DFG table).
//!
//! | module | what it holds |
//! |---|---|
//! | [`roughness`] | [`PerceptualRoughness`] p and [`Alpha`] α = p² |
//! | [`ndf`] | normal distributions: GGX, Beckmann, Blinn-Phong, Charlie |
//! | [`visibility`] | masking-shadowing as V = G / (4 n·l n·v), for metals and dielectrics and for sheen |
//! | [`facets`] | anisotropic GGX and Beckmann facets: density, masking, samplers of normals |
//! | [`fresnel`] | Fresnel reflectance: Schlick, exact dielectric and conductor, F82-tint; their averages |
//! | [`lobe`] | the zonal lobes that prefilter an environment for v = n = r |
//! | [`presets`] | materials by name: F0, tint or index, each with its source |
//! | [`model`] | every reflectance model by name, with its parameters and claims |
//! | [`material`] | the layered metallic-roughness material |
//! | [`albedo`] | directional and average albedo of any model, by quadrature and by its sampler |
//! | [`albedo_fit`] | the albedo as functions that need no table, for shaders |
//! | [`albedo_table`] | the albedo of any model tabulated over n·v and one of its parameters |
//! | [`dfg`] | directional and average albedo by deterministic quadrature |
//! | [`dfg_table`] | the albedo tabulated over n·v and perceptual roughness |
//!
//! Everything is f64, isotropic and free of state. The functions are total: out-of-range roughness cannot be built
//! (see [`Alpha::new`]), and α = 0 is computed as α = [`ndf::MIN_ALPHA`].

pub mod albedo;
pub mod albedo_fit;
pub mod albedo_table;
mod bsdf;
pub mod dfg;
pub mod dfg_table;
mod error;
pub mod facets;
pub mod fresnel;
mod half_vector_rule;
pub mod lobe;
pub mod material;
mod microfacet;
pub mod model;
pub mod ndf;
pub mod presets;
mod rough_dielectric;
pub mod roughness;
mod special;
pub mod visibility;
mod visible_beckmann;
mod visible_ggx;

pub use albedo::Albedo;
pub use albedo_table::AlbedoTable;
pub use bsdf::{Bsdf, BsdfSample, Rgb};
pub use dfg::DfgTerms;
pub use dfg_table::DfgTable;
pub use error::BsdfError;
pub use facets::{FacetShape, Facets, NormalSampling};
pub use fresnel::Fresnel;
pub use lobe::{Lobe, LobeShape, LobeWeight};
pub use material::{AlbedoTables, Material};
pub use microfacet::Microfacet;
pub use model::{MODELS, Model, model_named};
pub use ndf::Ndf;
pub use presets::{PRESETS, Preset, preset_named};
pub use rough_dielectric::RoughDielectric;
pub use roughness::{Alpha, PerceptualRoughness};
pub use visibility::{Cosines, Masking, SheenMasking};
