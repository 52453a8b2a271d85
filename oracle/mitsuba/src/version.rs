//! Which Mitsuba is used.

/// The version that is used; another one is refused, because its images could differ.
pub const VERSION: &str = "3.9.1";

/// The variant that is used: the same bits on every machine of a kind, without a compiler or a graphics card.
pub const VARIANT: &str = "scalar_rgb";
