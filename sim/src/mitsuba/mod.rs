//! Docking scenes in the words of Mitsuba 3, the renderer that judges the fast one ([`crate::vector`]).
//!
//! Text and meshes, in memory: no process is started here and no file is written. Light adds, so each kind of light is
//! an image of its own ([`Layer`]); their sum is what [`crate::vector::Drawer`] draws.
//!
//! What Mitsuba is told differs from what the fast renderer does in nothing but method: the same facets and the same
//! light, sampled by rays. Every visible part casts shadows, because a body cannot do otherwise. A part that no camera sees
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
