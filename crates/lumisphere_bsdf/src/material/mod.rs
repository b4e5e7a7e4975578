//! The layered metallic-roughness material: what it is, and how it is evaluated.
//!
//! | file | what it holds |
//! |---|---|
//! | `definition` | [`Material`]: glTF's parameters |
//! | `choices` | [`Compensation`], [`DiffuseCoupling`]: where the textbooks differ |
//! | `surface` | [`Surface`]: the layers together, `eval / sample / pdf` |
//! | `bent_coat` | [`BentCoat`]: the same with a normal of the coat's own |
//! | `base` | metal and dielectric, mixed |
//! | `specular`, `sheen` | their lobes |
//! | `compensation` | multiple scattering between facets |
//! | `balance` | what keeps the energy of the diffuse lobe |
//! | `specular_albedo`, `nodes` | directional albedo over the view |
//! | `albedo_tables` | [`AlbedoTables`]: what each layer leaves for those below |

mod albedo_tables;
mod balance;
mod base;
mod bent_coat;
mod choices;
mod compensation;
mod definition;
mod nodes;
mod sheen;
mod specular;
mod specular_albedo;
mod surface;

pub use albedo_tables::AlbedoTables;
pub use bent_coat::BentCoat;
pub use choices::{Compensation, DiffuseCoupling};
pub use definition::Material;
pub use surface::Surface;
