//! Response of the video line after an edge: ringing, smear and echoes.
//!
//! A channel of limited bandwidth repeats a part of each pixel in the pixels after it: v(x) = s(x) + Σ_k c_k
//! (s(x − k) − s(x)), with k = 1 … [`LAGS`] pixels along the line. Such a response shifts edges along the
//! line, and by different amounts the edges of wide and of narrow features: at near range a ringing of 5 %
//! shifts the cross against the marks by 0.01 px, several σ of the noise. The coefficients c are therefore
//! unknowns of the fit, with information from previous fields. Terms b_k (s(x − k) + s(x + k) − 2 s(x)),
//! which are symmetric, are unknowns beside them: a blur of another shape than the model's would otherwise be
//! taken for a response.
//!
//! The size of the coefficients is unknown too. Its distribution is estimated from the same sums (empirical
//! Bayes; Carlin and Louis, *Bayes and Empirical Bayes Methods*, 2000), so a video without ringing keeps the
//! covariance of its noise.
//!
//! The pixels s contain noise, and an estimate that ignores it is biased (errors in variables; Fuller,
//! *Measurement Error Models*, 1987). Its moments are measured on pixels without an edge nearby: after a blur
//! or a rotation of the image, the noise is correlated along the line.

use contract::Frame;
use nalgebra::{SMatrix, SVector};

use super::groups::GroupedPixel;
use super::samples::{Patch, Sample};
use super::unknowns::{GLOBALS, GlobalMatrix, Globals, LOCALS};
use crate::docking::portions::inverse;

/// Number of coefficients of the response: the largest delay, px.
const LAGS: usize = 6;

/// Number of symmetric terms.
const SYMMETRIC: usize = 2;

/// Number of unknowns: coefficients of the response, then symmetric terms.
const UNKNOWNS: usize = LAGS + SYMMETRIC;

/// Prior standard deviation of the symmetric terms.
const SYMMETRIC_PRIOR: f64 = 0.05;

/// Standard deviations of the coefficient of the first delay that are weighted by their evidence; all are
/// equally probable before the first field. An edge with a ringing of 6 %, much for a video link, has 0.04.
const SIZES: [f64; 6] = [0.0005, 0.0025, 0.005, 0.01, 0.02, 0.04];

/// Delay over which the coefficients fade by a factor of e, px.
const FADING_PX: f64 = 4.0;

/// Share of the information from previous fields that is kept per field.
const RETENTION: f64 = 0.9;

/// Smallest number of pixels without an edge that determine the noise.
const MIN_FLAT_PIXELS: f64 = 200.0;

/// Smallest difference between a pixel and one of its predecessors that counts as an edge, in σ of the noise.
const EDGE_SIGMA: f64 = 4.0;

type Coefficients = SVector<f64, UNKNOWNS>;
type CoefficientMatrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Information on the coefficients, and its product with their estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineResponse {
    information: CoefficientMatrix,
    weighted: Coefficients,
}

impl Default for LineResponse {
    fn default() -> Self {
        Self { information: CoefficientMatrix::zeros(), weighted: Coefficients::zeros() }
    }
}

impl LineResponse {
    /// Returns the knowledge that remains for the next field. The response of a video changes slowly.
    pub(super) fn decayed(&self) -> Self {
        Self { information: self.information * RETENTION, weighted: self.weighted * RETENTION }
    }

    /// Returns mean and covariance of the coefficients: a mixture over [`SIZES`], weighted by the evidence.
    /// Returns `None` if a number is not finite.
    fn distribution(&self) -> Option<(Coefficients, CoefficientMatrix)> {
        let mut candidates = Vec::with_capacity(SIZES.len());
        for size in SIZES {
            let sigma = Coefficients::from_fn(|k, _| {
                if k < LAGS { size * libm::exp(-(k as f64) / FADING_PX) } else { SYMMETRIC_PRIOR }
            });
            let prior = sigma.map(|sigma| 1.0 / (sigma * sigma));
            let cholesky = (self.information + CoefficientMatrix::from_diagonal(&prior)).cholesky()?;
            let mean = cholesky.solve(&self.weighted);
            // Logarithm of the evidence, without terms common to all sizes.
            let diagonal = cholesky.l_dirty().diagonal();
            let log_determinant: f64 =
                diagonal.iter().zip(&prior).map(|(l, prior)| libm::log(l * l / prior)).sum();
            let evidence = 0.5 * (self.weighted.dot(&mean) - log_determinant);
            candidates.push((evidence, mean, cholesky.inverse()));
        }
        let best = candidates.iter().map(|(evidence, ..)| *evidence).fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = candidates.iter().map(|(evidence, ..)| libm::exp(evidence - best)).collect();
        let sum: f64 = weights.iter().sum();
        let mean: Coefficients =
            weights.iter().zip(&candidates).map(|(w, (_, mean, _))| mean * (w / sum)).sum();
        let covariance: CoefficientMatrix = weights
            .iter()
            .zip(&candidates)
            .map(|(w, (_, of_size, within))| {
                let off = of_size - mean;
                (within + off * off.transpose()) * (w / sum)
            })
            .sum();
        mean.iter().chain(&covariance).all(|v| v.is_finite()).then_some((mean, covariance))
    }
}

/// Returns the change of a pixel by a unit of each coefficient, DN.
fn effects(line: &[u16], column: usize, expected_dn: f64) -> Coefficients {
    let off = |column: Option<usize>| {
        column.and_then(|column| line.get(column)).map_or(0.0, |dn| f64::from(*dn) - expected_dn)
    };
    let mut effects = Coefficients::zeros();
    for k in 0..LAGS {
        effects[k] = off(column.checked_sub(k + 1));
    }
    for k in 0..SYMMETRIC {
        effects[LAGS + k] = effects[k] + off(column.checked_add(k + 1));
    }
    effects
}

/// Sums over the pixels of one line.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Σ e r: e is the change of a pixel by a unit of each coefficient, r the residual.
    seen: Coefficients,
    /// Σ e eᵀ.
    squares: CoefficientMatrix,
}

impl Default for Line {
    fn default() -> Self {
        Self { seen: Coefficients::zeros(), squares: CoefficientMatrix::zeros() }
    }
}

/// Sums over a field, with reusable buffers.
#[derive(Debug)]
pub(super) struct LineResponseSums {
    lines: Vec<Line>,
    pixels: f64,
    /// Sums over the pixels without an edge nearby, whose residuals and effects are noise alone.
    flat: Line,
    flat_pixels: f64,
    /// Σ e eᵀ, minus the part absorbed by the patches' levels.
    squares: CoefficientMatrix,
    /// Σ J eᵀ: change of the gradient by a unit of each coefficient.
    scores: SMatrix<f64, GLOBALS, UNKNOWNS>,
    /// Sums of the current patch: Σ l eᵀ over the levels, Σ J eᵀ before the levels absorb a part.
    by_levels: SMatrix<f64, LOCALS, UNKNOWNS>,
    by_globals: SMatrix<f64, GLOBALS, UNKNOWNS>,
}

impl Default for LineResponseSums {
    fn default() -> Self {
        Self {
            lines: Vec::new(),
            pixels: 0.0,
            flat: Line::default(),
            flat_pixels: 0.0,
            squares: SMatrix::zeros(),
            scores: SMatrix::zeros(),
            by_levels: SMatrix::zeros(),
            by_globals: SMatrix::zeros(),
        }
    }
}

/// Change of the globals by the response, with its covariance and the updated knowledge of the response.
pub(super) struct Correction {
    pub(super) change: Globals,
    pub(super) covariance: GlobalMatrix,
    pub(super) response: LineResponse,
}

impl LineResponseSums {
    pub(super) fn clear(&mut self) {
        *self = Self { lines: std::mem::take(&mut self.lines), ..Self::default() };
        self.lines.clear();
    }

    /// Adds a pixel of the current patch. `noise_dn` is the noise of a pixel.
    pub(super) fn add(&mut self, image: &Frame, pixel: &Sample, grouped: &GroupedPixel, noise_dn: f64) {
        let GroupedPixel { residual, slopes, levels, .. } = grouped;
        let effects = effects(image.row(pixel.row), pixel.column, pixel.dn - residual);
        if effects.amax() < EDGE_SIGMA * noise_dn {
            self.flat.seen += effects * *residual;
            self.flat.squares += effects * effects.transpose();
            self.flat_pixels += 1.0;
            return;
        }
        if self.lines.len() <= pixel.row {
            self.lines.resize(pixel.row + 1, Line::default());
        }
        let line = &mut self.lines[pixel.row];
        line.seen += effects * *residual;
        line.squares += effects * effects.transpose();
        self.pixels += 1.0;
        self.by_levels += levels * effects.transpose();
        self.by_globals += slopes * effects.transpose();
    }

    /// Closes a patch: subtracts the part of the sums that the patch's levels absorb.
    pub(super) fn close(&mut self, patch: &Patch) {
        let level = patch.levels[LOCALS - 1];
        self.squares -= self.by_levels.transpose() * patch.levels_inverse * self.by_levels;
        self.scores += (self.by_globals - patch.levels_by_globals.transpose() * self.by_levels) * level;
        self.by_levels = SMatrix::zeros();
        self.by_globals = SMatrix::zeros();
    }

    /// Estimates the response and the change of the globals that it causes. `inverse_information` is the
    /// inverse of the globals' information, `variance` the variance of a pixel, `correlated_lines` the number
    /// of lines with the same noise.
    pub(super) fn estimate(
        &self,
        inverse_information: &GlobalMatrix,
        variance: f64,
        correlated_lines: f64,
        known: &LineResponse,
    ) -> Option<Correction> {
        let of_lines: CoefficientMatrix = self.lines.iter().map(|line| line.squares).sum();
        let noise = self.noise_of_pixel(variance);
        let seen: Coefficients =
            self.lines.iter().map(|line| line.seen).sum::<Coefficients>() - noise.seen * self.pixels;
        let by_globals = inverse_information * self.scores;
        let mut response = *known;
        let alone = of_lines + self.squares - self.scores.transpose() * by_globals;
        if let Some(spread) = self.dispersion(&of_lines, &seen, variance) {
            // The noise of the pixels in e adds to the squares and explains no residual: with A = Σ e eᵀ and
            // A' without noise, the estimate A'⁻¹ Σ e r has the covariance σ² A'⁻¹ A A'⁻¹ (Fuller,
            // *Measurement Error Models*, 1987, chapter 1).
            let signal = positive(&(alone - noise.squares * self.pixels));
            let gain = signal * inverse(&(positive(&alone) + ridge(&of_lines)))?;
            let variance = variance * spread.max(1.0) * correlated_lines;
            response.information += positive(&(gain * signal)) / variance;
            response.weighted += gain * seen / variance;
        }
        let (mean, covariance) = response.distribution()?;
        let change = by_globals * -mean;
        let covariance = by_globals * covariance * by_globals.transpose();
        change.iter().chain(&covariance).all(|v| v.is_finite()).then_some(Correction {
            change,
            covariance,
            response,
        })
    }

    /// Returns the part of the sums that one pixel's noise adds, for noise of the given variance if there are
    /// too few pixels without an edge to measure it.
    fn noise_of_pixel(&self, variance: f64) -> Line {
        if self.flat_pixels < MIN_FLAT_PIXELS {
            return Line { seen: Coefficients::zeros(), squares: noise_squares() * variance };
        }
        Line { seen: self.flat.seen / self.flat_pixels, squares: self.flat.squares / self.flat_pixels }
    }

    /// Returns the ratio of the scatter of lines to that of independent noise. Lines that come a little early
    /// or late scatter more than their pixels. Returns `None` if the coefficients are not determined.
    fn dispersion(&self, squares: &CoefficientMatrix, seen: &Coefficients, variance: f64) -> Option<f64> {
        let inverse = inverse(&(squares + ridge(squares)))?;
        let estimate = inverse * seen;
        let scatter: f64 = self
            .lines
            .iter()
            .map(|line| {
                let off = line.seen - line.squares * estimate;
                off.dot(&(inverse * off))
            })
            .sum();
        let spread = scatter / (variance * UNKNOWNS as f64);
        (squares.trace() > 0.0 && spread.is_finite()).then_some(spread)
    }
}

/// Returns the covariance of the noise in the effects of one pixel, for noise of variance 1.
fn noise_squares() -> CoefficientMatrix {
    let mut squares = CoefficientMatrix::identity();
    for k in 0..SYMMETRIC {
        squares[(LAGS + k, LAGS + k)] = 2.0;
        squares[(k, LAGS + k)] = 1.0;
        squares[(LAGS + k, k)] = 1.0;
    }
    squares
}

/// Returns a small multiple of the identity, so that sums without an edge have an inverse.
fn ridge(squares: &CoefficientMatrix) -> CoefficientMatrix {
    CoefficientMatrix::identity() * (1e-9 * squares.trace() / UNKNOWNS as f64)
}

/// Returns the nearest positive semidefinite matrix: differences of sums can have eigenvalues below zero.
fn positive(matrix: &CoefficientMatrix) -> CoefficientMatrix {
    let mut eigen = ((matrix + matrix.transpose()) * 0.5).symmetric_eigen();
    eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(0.0));
    eigen.recompose()
}
