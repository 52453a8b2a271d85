//! Flux fractions of a Gaussian in pixels, from a table over the position of its centre within a pixel.
//!
//! Along one axis the fraction in a pixel is the difference of two error functions. Stars evaluate hundreds
//! of them each, at positions that differ by integer pixels except for one number, the phase of the centre. A
//! table of a few phases, with the derivatives there, gives the fractions of a whole row of pixels by one
//! polynomial in the phase, for neighbouring pixels in parallel.

use pulp::Simd;

use crate::simd_kernel::{F64x8, LANES};

/// Number of coefficients of a polynomial of degree 5.
const TERMS: usize = 6;
/// Number of phases per width σ: the next term is at most (1/50)⁶ · 5/6! = 4e-13, with 5 for twice the
/// largest value of |He₅(u) φ(u)|.
const PHASES_PER_SIGMA: f64 = 25.0;
/// Smallest width with a table, px: narrower Gaussians need too many phases.
const MIN_WIDTH_PX: f64 = 0.1;
/// Largest width with a table, px: wider Gaussians need too many pixels.
const MAX_WIDTH_PX: f64 = 100.0;
/// Half width of the table, in units of σ; beyond it a fraction is below 2e-17.
const REACH_SIGMAS: f64 = 8.5;

/// Flux fractions along an axis, for one width.
#[derive(Debug, PartialEq)]
pub(super) struct ShareTable {
    /// `TERMS` rows of `width` pixels per phase.
    coefficients: Vec<f64>,
    /// Number of intervals between phases in a pixel.
    intervals: f64,
    /// Number of pixels in a row: twice `reach` plus one, and room for the padding of a stamp.
    width: usize,
    /// Number of pixels on either side of the pixel that holds the centre.
    reach: usize,
}

impl ShareTable {
    /// Creates the table of a Gaussian of width `sigma_px`; `None` if the width is too small or too large for
    /// a table.
    pub(super) fn new(sigma_px: f64) -> Option<Self> {
        if !(MIN_WIDTH_PX..=MAX_WIDTH_PX).contains(&sigma_px) {
            return None;
        }
        let reach = (REACH_SIGMAS * sigma_px).ceil() as usize + LANES;
        let width = 2 * reach + 1 + LANES;
        let intervals = (PHASES_PER_SIGMA / sigma_px).ceil();
        let mut coefficients = Vec::with_capacity((intervals as usize + 1) * TERMS * width);
        for phase in (0..=intervals as usize).map(|k| k as f64 / intervals - 0.5) {
            let edges: Vec<[f64; TERMS]> =
                (0..=width).map(|i| cumulative(i as f64 - reach as f64 - 0.5 - phase, sigma_px)).collect();
            for term in 0..TERMS {
                coefficients.extend(edges.windows(2).map(|pair| pair[1][term] - pair[0][term]));
            }
        }
        Some(Self { coefficients, intervals, width, reach })
    }

    /// Computes the fractions of pixels from `first` on, a multiple of [`LANES`] pixels, along an axis with
    /// the centre at `centre`. Zero outside the table.
    #[inline(always)]
    pub(super) fn fill<S: Simd>(&self, simd: S, centre: f64, first: usize, shares: &mut [f64]) {
        let nearest = centre.round();
        let phase = centre - nearest;
        let node = ((phase + 0.5) * self.intervals).round();
        let d = phase - (node / self.intervals - 0.5);
        // A distant centre contributes nothing here.
        let from = (first as f64 - nearest + self.reach as f64).clamp(-1e9, 1e9) as isize;
        let rows = &self.coefficients[node as usize * TERMS * self.width..][..TERMS * self.width];
        let Some(from) = usize::try_from(from).ok().filter(|from| from + shares.len() <= self.width) else {
            return self.fill_clipped(rows, d, from, shares);
        };
        let row = |term: usize| rows[term * self.width + from..][..shares.len()].as_chunks::<LANES>().0;
        let rows: [_; TERMS] = std::array::from_fn(row);
        let d = F64x8::splat(simd, d);
        for (i, shares) in shares.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            let mut sum = F64x8::from_array(simd, &rows[TERMS - 1][i]);
            for row in rows.iter().rev().skip(1) {
                sum = F64x8::from_array(simd, &row[i]).plus(d.times(sum));
            }
            sum.store(shares);
        }
    }

    /// Performs [`ShareTable::fill`] for pixels that are partly outside the table; they have no share of the
    /// flux. `offset` is that of the phase from the nearest node.
    #[cold]
    fn fill_clipped(&self, rows: &[f64], offset: f64, from: isize, shares: &mut [f64]) {
        for (share, at) in shares.iter_mut().zip(from..) {
            *share = match usize::try_from(at) {
                Ok(at) if at < self.width => {
                    (0..TERMS).rev().fold(0.0, |sum, term| sum * offset + rows[term * self.width + at])
                }
                _ => 0.0,
            };
        }
    }
}

/// Half the error function of t/(σ√2), and the coefficients of its polynomial in φ for t reduced by φ. Its
/// derivatives are those of the normal density: Hermite polynomials of t/σ times the density.
fn cumulative(t: f64, sigma_px: f64) -> [f64; TERMS] {
    let u = t / sigma_px;
    let density = libm::exp(-0.5 * u * u) / (sigma_px * (2.0 * std::f64::consts::PI).sqrt());
    let u2 = u * u;
    let s = sigma_px;
    let hermite = [1.0, u, u2 - 1.0, (u2 - 3.0) * u, (u2 - 6.0) * u2 + 3.0];
    let over = [1.0, 2.0 * s, 6.0 * s * s, 24.0 * s * s * s, 120.0 * s * s * s * s];
    let [a, b, c, d, e] = std::array::from_fn(|n| -density * hermite[n] / over[n]);
    [0.5 * libm::erf(u / std::f64::consts::SQRT_2), a, b, c, d, e]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_the_error_function() {
        for sigma_px in [0.1, 0.35, 0.8, 4.0, 30.0] {
            let table = ShareTable::new(sigma_px).unwrap();
            let scale = 1.0 / (sigma_px * std::f64::consts::SQRT_2);
            for step in 0..2000 {
                let centre = 100.0 + step as f64 * 0.000_737;
                let reach = (7.0 * sigma_px).ceil() as usize + 1;
                let first = 100_usize.saturating_sub(reach);
                let mut shares = vec![9.0; (2 * reach + 2).next_multiple_of(LANES)];
                table.fill(pulp::Scalar::new(), centre, first, &mut shares);
                for (share, i) in shares.iter().zip(first..) {
                    let edge = |side: f64| libm::erf((i as f64 + side - centre) * scale);
                    let exact = 0.5 * (edge(0.5) - edge(-0.5));
                    assert!((share - exact).abs() < 1e-12, "σ {sigma_px}, {i} − {centre}: {share}, {exact}");
                }
            }
        }
    }

    #[test]
    fn distant_pixels_have_no_share() {
        let table = ShareTable::new(0.8).unwrap();
        for (centre, first) in [(1e300, 0), (-1e300, 0), (5.0, 4000), (4000.0, 5), (5.0, usize::MAX)] {
            let mut shares = [9.0; LANES];
            table.fill(pulp::Scalar::new(), centre, first, &mut shares);
            assert!(shares.iter().all(|share| share.abs() < 1e-15), "{centre}, {first}: {shares:?}");
        }
    }

    #[test]
    fn very_narrow_and_very_wide_ones_have_no_table() {
        assert_eq!(ShareTable::new(0.05), None);
        assert_eq!(ShareTable::new(1e3), None);
        assert_eq!(ShareTable::new(f64::NAN), None);
    }
}
