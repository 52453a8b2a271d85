//! How far what is seen may be from where it is.

/// More than aberration (26″ from an orbit about the Earth) and the Sun's deflection (2″) move a star: 0.1°.
pub(super) const ABERRATION_MARGIN_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;
