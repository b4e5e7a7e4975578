//! Engine targets: what each engine loads, and the files of it as bytes.
//!
//! A [`Target`] is a value that says which files an engine wants, in which container and texel format, turned how, with
//! which roughness at which level and with its diffuse light in which form. [`targets`] is the table of them.
//! [`Target::chain_settings`] tells the baker what to bake; [`files`] makes the files of a [`Lighting`]. One bake can
//! serve many targets. Nothing here touches a file system.
//!
//! Axes and units are stated once, in the project's CONVENTIONS.md.

mod dfg_source;
mod error;
mod filament_text;
mod files;
mod fit_source;
mod gltf;
mod gltf_model;
mod lighting;
mod overrides;
mod sh_json;
mod table;
mod target;

pub use dfg_source::{Language, dfg_source};
pub use error::TargetError;
pub use filament_text::nine_text;
pub use files::{TargetFile, files};
pub use fit_source::fit_source;
pub use gltf::embed;
pub use gltf_model::GltfModel;
pub use lighting::{Lighting, panorama, turned_harmonics};
pub use overrides::{Container, Overrides};
pub use sh_json::{Coefficients, Named, SH_KIND, ShJson, ShWindow, WindowRecord};
pub use table::{target, targets};
pub use target::{
    Content, FilePlan, FlatFile, FlatLayout, Form, IrradianceUnit, Target, TexelChoice, TextureContainer,
};
