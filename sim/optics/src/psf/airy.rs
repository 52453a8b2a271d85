//! Diffraction image of a circular aperture with a central obscuration.
//!
//! I(r) = π (1 − ε²)/(4 λ²N²) [(2 J₁(v)/v − ε² 2 J₁(εv)/(εv))/(1 − ε²)]², v = πr/λN, of unit flux over the
//! whole plane (Born & Wolf 1999, Sec. 8.5.2; with the obscuration ε, Rivolta 1986, Appl. Opt. 25, 2404). Its
//! rings fall as r⁻³: 2/π²·λN/r of the flux is beyond r.

use std::f64::consts::PI;

use super::cumulative_flux::CumulativeFlux;

/// Radius to which the rings are tabulated, px, limited by `REACH_LAMBDA_N`.
const REACH_PX: f64 = 32.0;
/// Minimum and maximum of the tabulated radius, λN, so that wide images are complete and tables small.
const REACH_LAMBDA_N: (f64, f64) = (12.0, 50.0);
/// Number of table nodes per λN. The image has no spatial frequency above 1/λN: ten nodes per period of the
/// highest frequency.
const NODES: f64 = 10.0;

/// Creates the shape for λN over the pixel's width and height, px.
pub(super) fn airy(lambda_n_px: [f64; 2], obscuration: f64) -> CumulativeFlux {
    let open = 1.0 - obscuration * obscuration;
    // 2 J₁(v)/v, replaced by its series where it would be 0/0.
    let jinc = |v: f64| if v < 1e-4 { 1.0 - v * v / 8.0 } else { 2.0 * libm::j1(v) / v };
    let density = |radius: f64| {
        let v = PI * radius;
        let amplitude = (jinc(v) - obscuration * obscuration * jinc(obscuration * v)) / open;
        0.25 * PI * open * amplitude * amplitude
    };
    let [x, y] = lambda_n_px;
    let radius = (REACH_PX / x.min(y)).clamp(REACH_LAMBDA_N.0, REACH_LAMBDA_N.1);
    CumulativeFlux::radial(density, 1.0 / NODES, radius, lambda_n_px)
}
