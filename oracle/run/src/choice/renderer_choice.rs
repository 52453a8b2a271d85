//! Choice of the renderer: that of the world, or another.

use std::any::Any;
use std::fmt;

/// A renderer with its options; a world refuses a renderer that cannot draw its scenes.
#[derive(Default)]
pub enum RendererChoice {
    /// Renderer of the world.
    #[default]
    BuiltIn,
    /// A renderer that some worlds support.
    Other {
        /// Name on the command line.
        word: &'static str,
        /// Options, of a type that the world knows.
        options: Box<dyn Any + Send>,
    },
}

impl RendererChoice {
    /// Returns the name on the command line; `None` for the renderer of the world.
    pub fn word(&self) -> Option<&'static str> {
        match self {
            Self::BuiltIn => None,
            Self::Other { word, .. } => Some(word),
        }
    }
}

impl fmt::Debug for RendererChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word().unwrap_or("built-in"))
    }
}
