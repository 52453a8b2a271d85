//! Constants of nature that several parts share.

/// Kilometres in an astronomical unit (IAU 2012 Resolution B2, exact).
pub(crate) const AU_KM: f64 = 149_597_870.7;

/// The speed of light, km/s (exact by the definition of the metre).
pub(crate) const LIGHT_SPEED_KM_S: f64 = 299_792.458;
