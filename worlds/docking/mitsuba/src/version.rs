//! The version of Mitsuba.

/// The required version; any other is refused, because its images could differ.
pub const VERSION: &str = "3.9.1";

/// The required variant: it gives the same bits on all machines of a kind, without a compiler or a graphics
/// card.
pub const VARIANT: &str = "scalar_rgb";
