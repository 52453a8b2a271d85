//! Who draws a scene: the renderer of its world, or another.
#[cfg(feature = "mitsuba")]
use mitsuba::MitsubaOptions;

/// A renderer by its name and options; a world refuses one that cannot draw its scenes.
#[derive(Debug, Default)]
pub enum RendererChoice {
    /// That of the world.
    #[default]
    BuiltIn,
    /// Mitsuba 3.
    #[cfg(feature = "mitsuba")]
    Mitsuba(Box<MitsubaOptions>),
}

impl RendererChoice {
    /// The word of the command line; `None` for the renderer of the world.
    pub fn word(&self) -> Option<&'static str> {
        match self {
            Self::BuiltIn => None,
            #[cfg(feature = "mitsuba")]
            Self::Mitsuba(_) => Some("mitsuba"),
        }
    }
}
