//! Physical constants that several modules share.

/// Kilometres per astronomical unit (IAU 2012 Resolution B2, exact).
pub const AU_KM: f64 = 149_597_870.7;

/// Speed of light, km/s (exact by the definition of the metre).
pub const LIGHT_SPEED_KM_S: f64 = 299_792.458;
