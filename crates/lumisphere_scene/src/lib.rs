//! Scenes: meshes, metallic-roughness materials, lights with photometric units, cameras; from glTF, from OBJ, or made in code.
//!
//! A [`Scene`] is plain data. [`read_gltf`] and [`read_obj`] read files as bytes and ask a closure for the files beside them;
//! [`Builtin`] makes scenes without any. Axes and units are those of CONVENTIONS.md; light is photometric ([`photometry`]).
//!
//! ```
//! use lumisphere_scene::{Builtin, Summary};
//! let scene = Builtin::from_name("spheres").expect("one of Builtin::names()").build();
//! let camera = scene.camera(16.0 / 9.0);
//! assert!(camera.ray([0.5, 0.5], 16.0 / 9.0).direction[2] < 0.0);
//! assert_eq!(Summary::of(&scene).instance_count, 33);
//! ```

mod affine;
mod bounds;
mod builtin;
mod camera;
mod error;
mod exposure;
mod framing;
mod gltf;
mod interior;
mod light;
mod limits;
mod material;
mod mesh;
mod normals;
mod note;
mod obj;
pub mod photometry;
mod scene;
mod split;
mod summary;
mod tangents;
mod texture;
mod texture_slot;

pub use affine::Affine;
pub use bounds::Bounds;
pub use builtin::Builtin;
pub use camera::{Camera, Lens, Ray};
pub use error::{ResolveError, SceneError};
pub use exposure::Exposure;
pub use framing::Movement;
pub use gltf::{GLTF_EXTENSIONS, read_gltf};
pub use interior::Interior;
pub use light::{Brightness, Light, LightShape};
pub use limits::Limits;
pub use material::{AlphaMode, MaterialPoint, MaterialTextures, SceneMaterial, Volume};
pub use mesh::{Mesh, SurfacePoint};
pub use note::Note;
pub use obj::read_obj;
pub use scene::{ImageBasedLight, Instance, Scene};
pub use summary::{Described, Summary};
pub use tangents::shading_frame;
pub use texture::{Encoding, Texture};
pub use texture_slot::{Filter, TextureSlot, UvTransform, Wrap};
