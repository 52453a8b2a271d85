//! Choice of the renderer: that of the world, or another.
#[cfg(feature = "mitsuba")]
use mitsuba::MitsubaOptions;

/// A renderer with its options; a world refuses a renderer that cannot draw its scenes.
#[derive(Debug, Default)]
pub enum RendererChoice {
    /// Renderer of the world.
    #[default]
    BuiltIn,
    /// Mitsuba 3.
    #[cfg(feature = "mitsuba")]
    Mitsuba(Box<MitsubaOptions>),
}

impl RendererChoice {
    /// Returns the name on the command line; `None` for the renderer of the world.
    pub fn word(&self) -> Option<&'static str> {
        match self {
            Self::BuiltIn => None,
            #[cfg(feature = "mitsuba")]
            Self::Mitsuba(_) => Some("mitsuba"),
        }
    }
}
