//! Docking scenes for Mitsuba 3, the reference renderer for the fast one ([`crate::vector`]).
//!
//! The module creates text and meshes in memory: it starts no process and writes no file. Light adds, so each
//! kind of light is a separate image ([`Layer`]); their sum is the image that [`crate::vector::Drawer`]
//! draws.
//!
//! The two renderers differ only in method: Mitsuba receives the same facets and the same light, and samples
//! them by rays. Every visible part casts shadows, because a body cannot do otherwise. An invisible part
//! shades sunlight from behind the camera, and is left out of the other layers.

mod layer;
mod matrix;
mod mesh;
mod scene_xml;
mod settings;

pub use layer::Layer;
pub use mesh::Mesh;
pub use scene_xml::SceneFiles;
pub use settings::{Crop, Settings};
