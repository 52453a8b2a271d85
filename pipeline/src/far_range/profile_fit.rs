//! A circular image fitted to pixels: maximum likelihood by Fisher scoring.
//!
//! The expected electrons of a pixel are b + Σ a_k P_k, P_k the share of a circular Gaussian of width s·σ_k about the common
//! centre that falls on the pixel: a product of two differences of error functions. With one Gaussian it is the image of a
//! point; with several, fluxes free, any circular image, of which the pixels need not show all: what is cut away or saturated
//! is simply not among them, and the symmetry of what is left finds the centre.
//!
//! A pixel's electrons n plus the variance r² of readout and rounding, taken for a Poisson variable of mean m + r², have the
//! mean and the variance of the true law (Snyder, Hammoud & White 1993). The likelihood of that law is maximised; its Fisher
//! information is Σ ∂m ∂mᵀ/(m + r²), whose inverse is the covariance told.

/// Gaussians of a profile at most.
pub(super) const MAX_COMPONENTS: usize = 4;

/// Centre, background, width, fluxes.
const MAX_PARAMETERS: usize = 4 + MAX_COMPONENTS;
const X: usize = 0;
const Y: usize = 1;
const BACKGROUND: usize = 2;
const FIRST_FLUX: usize = 3;

type Vector = [f64; MAX_PARAMETERS];
type Matrix = [[f64; MAX_PARAMETERS]; MAX_PARAMETERS];

/// One pixel that is believed: transmitted, not saturated, nobody else's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// Column and row, counted from the first of the window.
    pub(super) column: usize,
    pub(super) row: usize,
    /// Electrons: digital number without bias, times the gain.
    pub(super) electrons: f64,
}

/// The form that is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape {
    /// Standard deviations σ_k of the Gaussians, px; the first `components` of them.
    pub(super) sigmas_px: [f64; MAX_COMPONENTS],
    pub(super) components: usize,
    /// Whether the common factor s of the widths is fitted too; 1 if not.
    pub(super) is_width_free: bool,
}

impl Shape {
    fn parameters(&self) -> usize {
        FIRST_FLUX + self.components + usize::from(self.is_width_free)
    }
}

/// Where a fit starts. Places count from the centre of the window's first pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Start {
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    pub(super) background_e: f64,
    pub(super) flux_e: f64,
}

/// The maximum of the likelihood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    /// Centre, counted from that of the window's first pixel, px.
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    /// Standard deviations of the centre, px: the Cramér–Rao bound at the fitted values, the other parameters free.
    pub(super) sigma_x_px: f64,
    pub(super) sigma_y_px: f64,
    /// Deviance a degree of freedom: 1 where the form is that of the image.
    pub(super) misfit: f64,
}

/// Pixels beyond the number of parameters below which a fit is not tried.
const LEAST_FREEDOM: usize = 3;

/// Steps, accepted or not; a fit that converges takes five to ten, a profile of several Gaussians up to forty.
const MAX_STEPS: usize = 100;

/// Decrement gᵀF⁻¹g at which the maximum counts as found: the centre is then within a thousandth of its standard deviation.
const DECREMENT: f64 = 1e-6;

/// A step moves the centre no farther than this, px: beyond it the Gaussian is not nearly linear in it.
const LONGEST_STEP_PX: f64 = 0.5;

/// A step changes the logarithm of the width no more than this.
const LARGEST_LOG_STEP: f64 = 0.2;

/// Range of the free factor s of the widths.
const WIDTH_FACTOR: (f64, f64) = (0.4, 4.0);

/// Damping (Levenberg's λ, relative to the diagonal): at first, the largest before giving up, and the largest at which a
/// small decrement is that of Fisher scoring itself.
const FIRST_DAMPING: f64 = 1e-3;
const LARGEST_DAMPING: f64 = 1e9;
const UNDAMPED: f64 = 1e-2;

/// Added to the unit diagonal of the scaled Fisher matrix: two Gaussians that the pixels cannot tell apart share their flux
/// instead of being undetermined. Far below any information that counts.
const RIDGE: f64 = 1e-9;

/// Fits profiles; owns its buffers.
#[derive(Debug, Default)]
pub(super) struct ProfileFit {
    across: Vec<[Share; MAX_COMPONENTS]>,
    down: Vec<[Share; MAX_COMPONENTS]>,
}

/// Share of a Gaussian that falls on a column or row, and its derivatives with respect to the centre and to ln s.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    value: f64,
    by_centre: f64,
    by_log_width: f64,
}

/// Deviance, its gradient (towards greater likelihood) and the Fisher matrix at some parameters.
struct Evaluation {
    deviance: f64,
    gradient: Vector,
    fisher: Matrix,
}

impl ProfileFit {
    /// The maximum-likelihood fit of `shape` to the samples of a window of `columns` × `rows`; `noise_e2` is r², the variance
    /// of readout and rounding of a pixel, above 0. `None` when there are too few pixels, when no maximum is found inside the
    /// window, or when there is no light.
    pub(super) fn fit(
        &mut self,
        samples: &[Sample],
        (columns, rows): (usize, usize),
        noise_e2: f64,
        shape: &Shape,
        start: Start,
    ) -> Option<Fitted> {
        let n = shape.parameters();
        if samples.len() < n + LEAST_FREEDOM {
            return None;
        }
        let mut at: Vector = [0.0; MAX_PARAMETERS];
        (at[X], at[Y], at[BACKGROUND]) = (start.x_px, start.y_px, start.background_e);
        for flux in &mut at[FIRST_FLUX..FIRST_FLUX + shape.components] {
            *flux = start.flux_e / shape.components as f64;
        }
        self.across.resize(columns, Default::default());
        self.down.resize(rows, Default::default());

        let mut here = self.evaluate(samples, noise_e2, shape, &at);
        let mut damping = FIRST_DAMPING;
        for _ in 0..MAX_STEPS {
            let step = solve(&here.fisher, &here.gradient, n, damping)?;
            let decrement: f64 = (0..n).map(|i| step[i] * here.gradient[i]).sum();
            if decrement < DECREMENT && damping <= UNDAMPED {
                return self.finish(samples.len(), (columns, rows), shape, &at, &here);
            }
            let next = moved(&at, &step, shape);
            let there = self.evaluate(samples, noise_e2, shape, &next);
            if there.deviance <= here.deviance {
                (at, here) = (next, there);
                damping *= 0.1;
            } else {
                damping *= 10.0;
                // Written so that a NaN ends it too.
                if damping.is_nan() || damping > LARGEST_DAMPING {
                    return None;
                }
            }
        }
        None
    }

    fn finish(
        &self,
        samples: usize,
        (columns, rows): (usize, usize),
        shape: &Shape,
        at: &Vector,
        here: &Evaluation,
    ) -> Option<Fitted> {
        let n = shape.parameters();
        let variance = |i: usize| {
            let mut unit = [0.0; MAX_PARAMETERS];
            unit[i] = 1.0;
            solve(&here.fisher, &unit, n, 0.0).map(|column| column[i])
        };
        let fitted = Fitted {
            x_px: at[X],
            y_px: at[Y],
            sigma_x_px: variance(X)?.sqrt(),
            sigma_y_px: variance(Y)?.sqrt(),
            misfit: here.deviance / (samples - n) as f64,
        };
        let inside = |v: f64, n: usize| v >= -0.5 && v <= n as f64 - 0.5;
        let flux: f64 = at[FIRST_FLUX..FIRST_FLUX + shape.components].iter().sum();
        let is_sound = inside(fitted.x_px, columns)
            && inside(fitted.y_px, rows)
            && fitted.sigma_x_px.is_finite()
            && fitted.sigma_y_px.is_finite()
            && fitted.misfit.is_finite()
            // The flux of a profile whose core is not seen may be anything.
            && (flux > 0.0 || shape.components > 1);
        is_sound.then_some(fitted)
    }

    fn evaluate(&mut self, samples: &[Sample], noise_e2: f64, shape: &Shape, at: &Vector) -> Evaluation {
        let n = shape.parameters();
        let count = shape.components;
        let factor = if shape.is_width_free { libm::exp(at[n - 1]) } else { 1.0 };
        for (shares, centre) in [(&mut self.across, at[X]), (&mut self.down, at[Y])] {
            for (i, shares) in shares.iter_mut().enumerate() {
                for (share, sigma) in shares.iter_mut().zip(&shape.sigmas_px[..count]) {
                    *share = Share::of(i as f64 - centre, factor * sigma);
                }
            }
        }
        // A model below its own readout noise means nothing; the floor keeps the logarithm defined.
        let least = 0.05 * noise_e2;
        let mut got = Evaluation {
            deviance: 0.0,
            gradient: [0.0; MAX_PARAMETERS],
            fisher: [[0.0; MAX_PARAMETERS]; MAX_PARAMETERS],
        };
        for sample in samples {
            let (across, down) = (&self.across[sample.column], &self.down[sample.row]);
            let mut by: Vector = [0.0; MAX_PARAMETERS];
            let (mut model, mut by_log_width) = (at[BACKGROUND], 0.0);
            by[BACKGROUND] = 1.0;
            for k in 0..count {
                let (x, y, flux) = (&across[k], &down[k], at[FIRST_FLUX + k]);
                by[FIRST_FLUX + k] = x.value * y.value;
                model += flux * x.value * y.value;
                by[X] += flux * x.by_centre * y.value;
                by[Y] += flux * x.value * y.by_centre;
                by_log_width += flux * (x.by_log_width * y.value + x.value * y.by_log_width);
            }
            if shape.is_width_free {
                by[n - 1] = by_log_width;
            }
            let expected = (model + noise_e2).max(least);
            let measured = (sample.electrons + noise_e2).max(0.0);
            got.deviance += 2.0 * (expected - measured);
            if measured > 0.0 {
                got.deviance += 2.0 * measured * libm::log(measured / expected);
            }
            let residual = (measured - expected) / expected;
            for i in 0..n {
                got.gradient[i] += by[i] * residual;
                for j in 0..=i {
                    got.fisher[i][j] += by[i] * by[j] / expected;
                }
            }
        }
        got
    }
}

impl Share {
    /// Of a Gaussian of width `sigma` on the pixel whose centre is `offset` from that of the Gaussian.
    fn of(offset: f64, sigma: f64) -> Self {
        let (left, right) = ((offset - 0.5) / sigma, (offset + 0.5) / sigma);
        let cumulative = |t: f64| 0.5 * libm::erf(t * std::f64::consts::FRAC_1_SQRT_2);
        let density = |t: f64| {
            0.5 * std::f64::consts::FRAC_2_SQRT_PI * std::f64::consts::FRAC_1_SQRT_2 * libm::exp(-0.5 * t * t)
        };
        let (at_left, at_right) = (density(left), density(right));
        Self {
            value: cumulative(right) - cumulative(left),
            by_centre: (at_left - at_right) / sigma,
            by_log_width: left * at_left - right * at_right,
        }
    }
}

/// The parameters a step farther, no farther than a step may go.
fn moved(at: &Vector, step: &Vector, shape: &Shape) -> Vector {
    let n = shape.parameters();
    let mut longest = 1.0_f64.max(step[X].abs().max(step[Y].abs()) / LONGEST_STEP_PX);
    if shape.is_width_free {
        longest = longest.max(step[n - 1].abs() / LARGEST_LOG_STEP);
    }
    let mut next = *at;
    for i in 0..n {
        next[i] += step[i] / longest;
    }
    if shape.is_width_free {
        next[n - 1] = next[n - 1].clamp(libm::log(WIDTH_FACTOR.0), libm::log(WIDTH_FACTOR.1));
    }
    next
}

/// Solves (F + λ diag F) s = g for the first `n` parameters by Cholesky's method, F scaled to a unit diagonal; only the lower
/// triangle of F is read. `None` when F is not positive definite.
fn solve(fisher: &Matrix, right: &Vector, n: usize, damping: f64) -> Option<Vector> {
    let mut scale = [0.0; MAX_PARAMETERS];
    for i in 0..n {
        if !(fisher[i][i] > 0.0 && fisher[i][i].is_finite()) {
            return None;
        }
        scale[i] = 1.0 / fisher[i][i].sqrt();
    }
    let mut lower: Matrix = [[0.0; MAX_PARAMETERS]; MAX_PARAMETERS];
    for i in 0..n {
        for j in 0..=i {
            let diagonal = if i == j { damping + RIDGE } else { 0.0 };
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = fisher[i][j] * scale[i] * scale[j] + diagonal - known;
            lower[i][j] = if i > j {
                rest / lower[j][j]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    let mut solution = [0.0; MAX_PARAMETERS];
    for i in 0..n {
        let known: f64 = (0..i).map(|k| lower[i][k] * solution[k]).sum();
        solution[i] = (right[i] * scale[i] - known) / lower[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| lower[k][i] * solution[k]).sum();
        solution[i] = (solution[i] - known) / lower[i][i];
    }
    for i in 0..n {
        solution[i] *= scale[i];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE_E2: f64 = 225.0;
    const SIZE: usize = 13;

    fn shape(sigmas_px: &[f64], is_width_free: bool) -> Shape {
        let mut all = [0.0; MAX_COMPONENTS];
        all[..sigmas_px.len()].copy_from_slice(sigmas_px);
        Shape { sigmas_px: all, components: sigmas_px.len(), is_width_free }
    }

    /// The image without noise: a Gaussian integrated by the rule of midpoints, 40 × 40 points a pixel.
    fn image(x: f64, y: f64, sigma: f64, flux: f64, background: f64) -> Vec<Sample> {
        let mut samples = Vec::new();
        for row in 0..SIZE {
            for column in 0..SIZE {
                let mut sum = 0.0;
                for i in 0..1600 {
                    let at = |cell: usize, n: usize| cell as f64 - 0.5 + (n as f64 + 0.5) / 40.0;
                    let (dx, dy) = (at(column, i % 40) - x, at(row, i / 40) - y);
                    sum += libm::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
                }
                let share = sum / 1600.0 / (std::f64::consts::TAU * sigma * sigma);
                samples.push(Sample { column, row, electrons: background + flux * share });
            }
        }
        samples
    }

    fn fit(samples: &[Sample], shape: &Shape, x_px: f64, y_px: f64) -> Option<Fitted> {
        let start = Start { x_px, y_px, background_e: 30.0, flux_e: 5000.0 };
        ProfileFit::default().fit(samples, (SIZE, SIZE), NOISE_E2, shape, start)
    }

    #[test]
    fn a_noiseless_point_is_found_where_it_is() {
        for (x, y) in [(6.0, 6.0), (6.5, 6.5), (5.8, 6.31)] {
            for shape in [shape(&[0.8], false), shape(&[0.8], true), shape(&[1.3], true)] {
                let got = fit(&image(x, y, 0.8, 9000.0, 50.0), &shape, 6.0, 6.0).unwrap();
                // The rule of midpoints is good to 1e-5 of a pixel; the fit stops a thousandth of its error (0.01 px) before.
                assert!((got.x_px - x).abs() < 5e-5 && (got.y_px - y).abs() < 5e-5, "{got:?}");
                assert!(got.misfit < 1e-3, "{got:?}");
            }
        }
    }

    #[test]
    fn the_error_told_is_that_of_a_gaussian_in_background_noise() {
        // Background-limited, well sampled: σ_x = √(8π) σ² √v / flux with v the variance of a pixel (King 1983).
        let sigma = 1.2;
        let got = fit(&image(6.0, 6.0, sigma, 500.0, 10_000.0), &shape(&[sigma], false), 6.0, 6.0).unwrap();
        let expected = libm::sqrt(8.0 * std::f64::consts::PI) * sigma * sigma * libm::sqrt(10_225.0) / 500.0;
        // The finite pixel widens the image, σ² + 1/12, and costs a factor of about 1.06; the star's own noise 1 %.
        assert!((got.sigma_x_px / expected - 1.05).abs() < 0.04, "{} {expected}", got.sigma_x_px);
        assert!((got.sigma_x_px - got.sigma_y_px).abs() < 1e-6);
    }

    #[test]
    fn half_an_image_without_its_core_has_the_same_centre() {
        // Rows below 7 are not transmitted, the core is saturated; a halo that no single Gaussian follows.
        let (core, halo) = (image(5.7, 6.2, 0.8, 1.0e6, 50.0), image(5.7, 6.2, 3.0, 5.0e4, 0.0));
        let left: Vec<Sample> = core
            .iter()
            .zip(&halo)
            .map(|(core, halo)| Sample { electrons: core.electrons + halo.electrons, ..*core })
            .filter(|sample| sample.electrons < 40_000.0 && sample.row <= 7)
            .collect();
        let got = fit(&left, &shape(&[0.8, 1.6, 3.2, 6.4], false), 6.0, 5.0).unwrap();
        assert!((got.x_px - 5.7).abs() < 0.01 && (got.y_px - 6.2).abs() < 0.05, "{got:?}");
    }

    #[test]
    fn too_few_pixels_and_no_light_are_no_fit() {
        let samples = image(6.0, 6.0, 0.8, 9000.0, 50.0);
        assert_eq!(fit(&samples[..6], &shape(&[0.8], false), 6.0, 6.0), None);
        let dark: Vec<Sample> = samples.iter().map(|s| Sample { electrons: 0.0, ..*s }).collect();
        assert!(fit(&dark, &shape(&[0.8], false), 6.0, 6.0).is_none_or(|got| got.sigma_x_px > 1.0));
        let not_a_number: Vec<Sample> =
            samples.iter().map(|s| Sample { electrons: f64::NAN, ..*s }).collect();
        assert_eq!(fit(&not_a_number, &shape(&[0.8], false), 6.0, 6.0), None);
    }
}
