//! Moffat profile as a mixture of Gaussians.
//!
//! I(r) = (β − 1)/(πα²) (1 + r²/α²)^−β, of unit flux over the whole plane (Moffat 1969, A&A 3, 455; Trujillo
//! et al. 2001, MNRAS 328, 977, Eq. 1). It has no closed integral over a pixel, but by Euler's integral of
//! the gamma function
//!
//! (1 + r²/α²)^−β = 1/Γ(β) ∫₀^∞ t^(β−1) e^(−t (1 + r²/α²)) dt
//!
//! it is a mixture of Gaussians of σ² = α²/2t (Andrews & Mallows 1974, J. R. Stat. Soc. B 36, 99). In s = ln
//! t the integrand is smooth and vanishes at both ends, where the trapezoidal rule converges geometrically
//! (Trefethen & Weideman 2014, SIAM Review 56, 385): its error is 2 |Γ(β + 2πi/h)|/Γ(β) of I at the step h,
//! an equal fraction in core and wings. Every component is integrated exactly over the pixels, so the sum is
//! as accurate as the profile.

use super::gaussians::{Component, Gaussians};

/// Distance from the centre to which the wings are accurate, px; beyond, they fall off like the widest
/// Gaussian.
const REACH_PX: f64 = 200.0;
/// Largest fraction of the profile that the components omitted at both ends of the sum would contribute.
const MAX_OMITTED_FRACTION: f64 = 1e-7;

/// Creates the mixture for a full width at half maximum 2α (2^(1/β) − 1)^½.
pub(super) fn moffat(fwhm_px: f64, beta: f64) -> Gaussians {
    let alpha_px = 0.5 * fwhm_px / (libm::pow(2.0, 1.0 / beta) - 1.0).sqrt();
    // The first limit keeps the error of the trapezoidal rule below 1e-5 for small β, the second for large β,
    // where the integrand narrows as β^−½.
    let step = 0.5_f64.min(0.9 / beta.sqrt());
    let log_gamma = libm::lgamma(beta);
    // The integrand at r, relative to I(r), equals that at the centre with t (1 + r²/α²) in place of t.
    let part = |log_t: f64| step * libm::exp(beta * log_t - libm::exp(log_t) - log_gamma);
    let widening = libm::log(1.0 + (REACH_PX / alpha_px) * (REACH_PX / alpha_px));
    let peak = libm::log(beta);
    let mut last = (peak / step).ceil();
    while part(last * step) > MAX_OMITTED_FRACTION {
        last += 1.0;
    }
    let mut first = ((peak - widening) / step).floor();
    while part(first * step + widening) > MAX_OMITTED_FRACTION {
        first -= 1.0;
    }
    let log_gamma_flux = libm::lgamma(beta - 1.0);
    let count = (last - first) as usize + 1;
    let components = (0..count).map(|i| {
        let log_t = (last - i as f64) * step;
        let t = libm::exp(log_t);
        let weight = step * libm::exp((beta - 1.0) * log_t - t - log_gamma_flux);
        Component::new(weight, alpha_px / (2.0 * t).sqrt())
    });
    Gaussians::mixture(components.collect())
}
