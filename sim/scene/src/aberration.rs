//! Limit of the angle between apparent and geometric directions.

/// Margin of 0.1°, more than aberration (26″ from an orbit about the Earth) and the Sun's deflection (2″)
/// move a star.
pub(super) const ABERRATION_MARGIN_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;
