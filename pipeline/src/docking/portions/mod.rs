//! Motion, reported at the end of each portion of fields.
//!
//! - [`PaperPortions`]: the two stages of the docking paper's (3.2), on cross and circle, linear in time. The
//!   previous portion is a prior that is down-weighted by a forgetting factor. The standard deviations are as
//!   printed.
//! - [`MotionTracker`]: from poses with their full covariance and the ranges by the station's outline, field
//!   by field, with acceleration.

mod filters;
mod inverse;
mod paper;
mod scatter;
mod tracker;

pub use filters::MotionConfig;
pub(in crate::docking) use filters::OutlineRange;
pub(in crate::docking) use inverse::inverse;
pub use paper::{PaperPortionConfig, PaperPortions};
pub use tracker::{Continuity, MotionTracker};

#[cfg(test)]
pub(in crate::docking) mod tests {
    use contract::docking::Pose;
    use nalgebra::Vector3;

    /// Returns the pose of a glide: 0.3 m/s from 6 m, slow lateral and angular motion.
    pub(super) fn approach(t: f64) -> Pose {
        Pose {
            position_m: Vector3::new(0.1 - 0.01 * t, -0.05 + 0.02 * t, 6.0 - 0.3 * t),
            phi_rad: Vector3::new(0.01 + 0.002 * t, -0.005 + 0.001 * t, 0.02 - 0.003 * t),
        }
    }

    /// Returns the uniform random number in (0, 1) of an address: SplitMix64 (Steele, Lea & Flood 2014).
    pub(in crate::docking) fn uniform(address: u64) -> f64 {
        let mut z = address.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + 1e-17
    }

    /// Returns the standard normal random number of an address (Box & Muller).
    pub(in crate::docking) fn normal(address: u64) -> f64 {
        let (u, v) = (uniform(2 * address), uniform(2 * address + 1));
        (-2.0 * libm::log(u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
    }
}
