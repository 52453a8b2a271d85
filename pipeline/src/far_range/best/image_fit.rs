//! Image of a point, and of known neighbours, fitted to pixels with priors: maximum a posteriori by Fisher
//! scoring.
//!
//! Expected electrons of a pixel: m = b + F [(1 − h) G(σ) + h G(σ_h)] + Σ F_k G_k, with G the share of a
//! circular Gaussian on the pixel (a product of two differences of error functions; the core may be wider
//! along rows than along columns by a factor) and the sum over neighbours at known positions. Variance of a
//! pixel: v = m + r² + (ρ m)², of photons, of readout and rounding, and of the response of single pixels. The
//! fit solves the score equations Σ ∂m (n − m)/v = 0 of the quasi-likelihood (McCullagh & Nelder 1989,
//! Generalized Linear Models, Sec. 9.2) by Fisher scoring with weights 1/v that follow the model; the
//! information is Σ ∂m ∂mᵀ/v. Priors are normal.
//!
//! The fit excludes pixels that were not transmitted, that are saturated or that contain spilt charge: a
//! truncated image is fitted to its transmitted part.

use super::normal_equations::{MAX_PARAMETERS, NormalEquations, Vector};

/// Pixel of a fit, counted from the first pixel of its window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pixel {
    pub(super) column: usize,
    pub(super) row: usize,
    /// Electrons: digital number without bias, times the gain.
    pub(super) electrons: f64,
}

/// Noise of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelNoise {
    /// Variance of readout and rounding, e².
    pub(super) readout_e2: f64,
    /// Variance of the response of single pixels, relative.
    pub(super) response: f64,
}

impl PixelNoise {
    /// Returns the variance of a pixel of mean `mean_e`, e²; at least a twentieth of that of the readout.
    #[inline(always)]
    fn variance(&self, mean_e: f64) -> f64 {
        (mean_e + self.readout_e2 + self.response * mean_e * mean_e).max(0.05 * self.readout_e2).max(1e-9)
    }
}

/// Normal prior of a parameter. An infinite variance means a free parameter, a variance of 0 a fixed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prior {
    pub(super) mean: f64,
    pub(super) variance: f64,
}

impl Prior {
    /// Creates a free parameter with initial value `start`.
    pub(super) fn free(start: f64) -> Self {
        Self { mean: start, variance: f64::INFINITY }
    }

    /// Creates a fixed parameter.
    pub(super) fn fixed(value: f64) -> Self {
        Self { mean: value, variance: 0.0 }
    }

    /// Creates a parameter with a mean and a standard deviation.
    pub(super) fn normal(mean: f64, sigma: f64) -> Self {
        Self { mean, variance: sigma * sigma }
    }
}

/// Image of a point: widths of core and halo, and trail lengths along columns and rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PointImage {
    /// Standard deviation of the core, px.
    pub(super) sigma_px: f64,
    /// Standard deviation of the halo, px.
    pub(super) halo_sigma_px: f64,
    /// Share of the flux in the halo.
    pub(super) halo_fraction: f64,
    /// Length of the trail during the exposure along columns and rows, px.
    pub(super) trail_px: [f64; 2],
}

impl PointImage {
    /// Returns the share of the flux on the pixel whose centre is at the offset (dx, dy) from the image's
    /// centre.
    pub(super) fn share(&self, dx: f64, dy: f64) -> f64 {
        let of = |sigma: f64| {
            let along = |offset: f64, trail: f64| Share::from_offset(offset, smeared(sigma, trail)).value;
            along(dx, self.trail_px[0]) * along(dy, self.trail_px[1])
        };
        (1.0 - self.halo_fraction) * of(self.sigma_px) + self.halo_fraction * of(self.halo_sigma_px)
    }

    /// Returns Σ k², with the shares k of the flux on the pixels of an image centred on a pixel.
    pub(super) fn sum_of_squares(&self) -> f64 {
        let reach = (3.0 * self.sigma_px).ceil().clamp(2.0, 12.0) as i32;
        let mut sum = 0.0;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let share = self.share(f64::from(dx), f64::from(dy));
                sum += share * share;
            }
        }
        sum
    }

    /// Returns the share of the flux on the central pixel of an image centred on it.
    pub(super) fn central_share(&self) -> f64 {
        self.share(0.0, 0.0)
    }
}

/// Source at a known position in the window of the fitted source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Neighbour {
    /// Position, counted from the first pixel of the window, px.
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    /// Flux, electrons.
    pub(super) flux_e: Prior,
    pub(super) image: PointImage,
}

/// Model of a fit: priors of the parameters, and known neighbours.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageModel<'a> {
    /// Position, counted from the first pixel of the window, px.
    pub(super) x_px: Prior,
    pub(super) y_px: Prior,
    /// Flux, electrons.
    pub(super) flux_e: Prior,
    /// Background of a pixel, electrons.
    pub(super) background_e: Prior,
    /// Natural logarithm of the ratio of the core's width to that of `image`.
    pub(super) log_width: Prior,
    /// Natural logarithm of the ratio of the core's widths along rows and along columns. Accounts for bodies
    /// that are not circular.
    pub(super) log_elongation: Prior,
    /// Share of the flux in the halo.
    pub(super) halo_fraction: Prior,
    pub(super) image: PointImage,
    /// Known neighbours, at most [`MAX_NEIGHBOURS`].
    pub(super) neighbours: &'a [Neighbour],
}

/// Largest number of neighbours of a fit.
pub(super) const MAX_NEIGHBOURS: usize = MAX_PARAMETERS - OWN_PARAMETERS;

/// Number of parameters of the fitted source: position, flux, background, width, halo, elongation.
const OWN_PARAMETERS: usize = 7;
const X: usize = 0;
const Y: usize = 1;
const FLUX: usize = 2;
const BACKGROUND: usize = 3;
const LOG_WIDTH: usize = 4;
const HALO: usize = 5;
const ELONGATION: usize = 6;

/// Maximum of the posterior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FittedImage {
    /// Position, counted from the first pixel of the window, px.
    pub(super) x_px: f64,
    pub(super) y_px: f64,
    /// Covariance of the position, (xx, xy, yy), px²: the inverse of the Fisher information, including
    /// priors.
    pub(super) covariance_px2: [f64; 3],
    /// Flux, electrons, and its standard deviation.
    pub(super) flux_e: f64,
    pub(super) flux_sigma_e: f64,
    pub(super) background_e: f64,
    /// Width of the core relative to the calibrated one.
    pub(super) width: f64,
    /// Share of the flux in the halo.
    pub(super) halo_fraction: f64,
    /// Σ (n − m)²/v over the pixels.
    pub(super) chi_squared: f64,
    /// Number of pixels minus number of free parameters.
    pub(super) freedom: usize,
}

impl FittedImage {
    /// Returns χ² per degree of freedom: near 1 if the model agrees with the image.
    pub(super) fn misfit(&self) -> f64 {
        self.chi_squared / self.freedom.max(1) as f64
    }
}

/// Largest number of steps, accepted or not.
const MAX_STEPS: usize = 60;

/// Decrement gᵀF⁻¹g below which the fit has converged: the position is then within 0.03 of its standard
/// deviation.
const DECREMENT: f64 = 1e-3;

/// Initial damping (Levenberg's λ, relative to the diagonal), and the damping at which the fit gives up.
const FIRST_DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e6;

/// Largest damping at which a small decrement counts as that of undamped Fisher scoring.
const UNDAMPED_LIMIT: f64 = 1e-2;

/// Largest steps of the position, px, and of the logarithm of the width.
const MAX_STEP_PX: f64 = 0.7;
const MAX_LOG_STEP: f64 = 0.2;

/// Largest distance of the centre of a truncated image outside the window, px.
const BEYOND_PX: f64 = 8.0;

/// Range of the width relative to the calibrated one.
const WIDTHS: (f64, f64) = (0.3, 12.0);

/// Fitter of images. Buffers the shares of Gaussians on the columns and rows of a window, with their
/// derivatives.
#[derive(Debug, Default)]
pub(super) struct ImageFitter {
    core: [Vec<Share>; 2],
    halo: [Vec<Share>; 2],
    /// Electrons on each pixel of the fit from each neighbour with unit flux, neighbour after neighbour.
    neighbours: Vec<f64>,
    /// Weights 1/v of the pixels at the current parameters, and at those of the last evaluation.
    weights: Vec<f64>,
    next_weights: Vec<f64>,
}

/// Share of a Gaussian on a column or row, and its derivatives with respect to the centre and to the
/// logarithm of the width.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    value: f64,
    by_centre: f64,
    by_log_width: f64,
}

struct Evaluation {
    /// Σ (n − m)²/v plus the priors' part, with the weights of the current parameters.
    objective: f64,
    prior_part: f64,
    /// Σ (n − m)²/v with the weights of the evaluated parameters.
    chi_squared: f64,
    equations: NormalEquations,
}

impl ImageFitter {
    /// Fits `model` to the pixels of a window of `columns` × `rows`. Returns `None` with too few pixels, or
    /// if no maximum is found within eight pixels of the window.
    pub(super) fn fit(
        &mut self,
        pixels: &[Pixel],
        (columns, rows): (usize, usize),
        noise: PixelNoise,
        model: &ImageModel<'_>,
    ) -> Option<FittedImage> {
        let priors = model.priors();
        // Fixed parameters come last.
        let parameters = OWN_PARAMETERS + model.neighbours.len();
        let n = priors.iter().take(parameters).position(|prior| prior.variance <= 0.0).unwrap_or(parameters);
        if pixels.len() < n.min(4) {
            return None;
        }
        for axis in [&mut self.core, &mut self.halo] {
            axis[0].resize(columns, Share::default());
            axis[1].resize(rows, Share::default());
        }
        self.draw_neighbours(pixels, model);
        let mut at: Vector = [0.0; MAX_PARAMETERS];
        for (value, prior) in at.iter_mut().zip(&priors) {
            *value = prior.mean;
        }
        self.weights.clear();
        let mut here = self.evaluate(pixels, noise, model, &priors, n, &at);
        std::mem::swap(&mut self.weights, &mut self.next_weights);
        let mut damping = FIRST_DAMPING;
        for _ in 0..MAX_STEPS {
            let step = here.equations.step(damping)?;
            let decrement: f64 = (0..n).map(|i| step[i] * here.equations.score[i]).sum();
            if decrement < DECREMENT && damping <= UNDAMPED_LIMIT {
                break;
            }
            let next = moved(&at, &step, n);
            let there = self.evaluate(pixels, noise, model, &priors, n, &next);
            if there.objective <= here.objective {
                at = next;
                here = Evaluation { objective: there.chi_squared + there.prior_part, ..there };
                std::mem::swap(&mut self.weights, &mut self.next_weights);
                damping = (damping * 0.1).max(1e-9);
            } else {
                damping *= 10.0;
                if damping.is_nan() || damping > MAX_DAMPING {
                    return None;
                }
            }
        }
        if n <= FLUX {
            return None;
        }
        let covariance_px2 = here.equations.covariance(X, Y)?;
        let flux_sigma_e = here.equations.covariance(FLUX, FLUX)?[0].sqrt();
        let inside = |v: f64, n: usize| v >= -0.5 - BEYOND_PX && v <= n as f64 - 0.5 + BEYOND_PX;
        let is_sound = inside(at[X], columns)
            && inside(at[Y], rows)
            && covariance_px2.iter().all(|element| element.is_finite())
            && here.chi_squared.is_finite();
        is_sound.then(|| FittedImage {
            x_px: at[X],
            y_px: at[Y],
            covariance_px2,
            flux_e: at[FLUX],
            flux_sigma_e,
            background_e: at[BACKGROUND],
            width: libm::exp(at[LOG_WIDTH]),
            halo_fraction: at[HALO],
            chi_squared: here.chi_squared,
            freedom: pixels.len().saturating_sub(n),
        })
    }

    fn draw_neighbours(&mut self, pixels: &[Pixel], model: &ImageModel<'_>) {
        self.neighbours.clear();
        for neighbour in model.neighbours {
            let PointImage { sigma_px, halo_sigma_px, halo_fraction, trail_px } = neighbour.image;
            for (axis, centre) in [neighbour.x_px, neighbour.y_px].into_iter().enumerate() {
                fill(&mut self.core[axis], centre, smeared(sigma_px, trail_px[axis]));
                fill(&mut self.halo[axis], centre, smeared(halo_sigma_px, trail_px[axis]));
            }
            let (core, halo) = (&self.core, &self.halo);
            self.neighbours.extend(pixels.iter().map(|pixel| {
                let of =
                    |shares: &[Vec<Share>; 2]| shares[0][pixel.column].value * shares[1][pixel.row].value;
                (1.0 - halo_fraction) * of(core) + halo_fraction * of(halo)
            }));
        }
    }

    fn evaluate(
        &mut self,
        pixels: &[Pixel],
        noise: PixelNoise,
        model: &ImageModel<'_>,
        priors: &[Prior; MAX_PARAMETERS],
        n: usize,
        at: &Vector,
    ) -> Evaluation {
        let sigma_px = model.image.sigma_px * libm::exp(at[LOG_WIDTH]);
        let sigmas_px = [sigma_px, sigma_px * libm::exp(at[ELONGATION])];
        let has_halo = at[HALO] > 0.0 || n > HALO;
        for axis in [0, 1] {
            let (centre, trail_px) = (at[axis], model.image.trail_px[axis]);
            fill(&mut self.core[axis], centre, smeared(sigmas_px[axis], trail_px));
            if has_halo {
                fill(&mut self.halo[axis], centre, smeared(model.image.halo_sigma_px, trail_px));
            }
        }
        let mut got = Evaluation {
            objective: 0.0,
            prior_part: 0.0,
            chi_squared: 0.0,
            equations: NormalEquations::new(n),
        };
        let (flux_e, halo) = (at[FLUX], at[HALO]);
        let mut by: Vector = [0.0; MAX_PARAMETERS];
        self.next_weights.clear();
        for (i, pixel) in pixels.iter().enumerate() {
            let (core_x, core_y) = (&self.core[0][pixel.column], &self.core[1][pixel.row]);
            let (halo_x, halo_y) = (&self.halo[0][pixel.column], &self.halo[1][pixel.row]);
            let (core, wide) = (core_x.value * core_y.value, halo_x.value * halo_y.value);
            let shape = (1.0 - halo) * core + halo * wide;
            let mut mean = at[BACKGROUND] + flux_e * shape;
            by[X] = flux_e
                * ((1.0 - halo) * core_x.by_centre * core_y.value + halo * halo_x.by_centre * halo_y.value);
            by[Y] = flux_e
                * ((1.0 - halo) * core_x.value * core_y.by_centre + halo * halo_x.value * halo_y.by_centre);
            by[FLUX] = shape;
            by[BACKGROUND] = 1.0;
            by[LOG_WIDTH] = flux_e
                * (1.0 - halo)
                * (core_x.by_log_width * core_y.value + core_x.value * core_y.by_log_width);
            by[HALO] = flux_e * (wide - core);
            by[ELONGATION] = flux_e * (1.0 - halo) * core_x.value * core_y.by_log_width;
            for k in 0..model.neighbours.len() {
                let share = self.neighbours[k * pixels.len() + i];
                mean += at[OWN_PARAMETERS + k] * share;
                by[OWN_PARAMETERS + k] = share;
            }
            let variance = noise.variance(mean);
            let residual = pixel.electrons - mean;
            let squared = residual * residual / variance;
            got.chi_squared += squared;
            got.objective += residual * residual * self.weights.get(i).copied().unwrap_or(1.0 / variance);
            self.next_weights.push(1.0 / variance);
            got.equations.add(residual, &by, 1.0 / variance);
        }
        for (i, Prior { mean, variance }) in priors.iter().take(n).copied().enumerate() {
            if variance.is_finite() {
                let residual = mean - at[i];
                got.prior_part += residual * residual / variance;
                got.equations.add_prior(i, residual, variance);
            }
        }
        got.objective += got.prior_part;
        got
    }
}

impl ImageModel<'_> {
    fn priors(&self) -> [Prior; MAX_PARAMETERS] {
        let mut priors = [Prior::fixed(0.0); MAX_PARAMETERS];
        priors[X] = self.x_px;
        priors[Y] = self.y_px;
        priors[FLUX] = self.flux_e;
        priors[BACKGROUND] = self.background_e;
        priors[LOG_WIDTH] = self.log_width;
        priors[HALO] = self.halo_fraction;
        priors[ELONGATION] = self.log_elongation;
        for (prior, neighbour) in priors[OWN_PARAMETERS..].iter_mut().zip(self.neighbours) {
            *prior = neighbour.flux_e;
        }
        priors
    }
}

/// Returns the first `n` parameters after one step, shortened to the largest allowed step.
fn moved(at: &Vector, step: &Vector, n: usize) -> Vector {
    let longest_of = |parameter: usize| match parameter {
        X | Y => MAX_STEP_PX,
        LOG_WIDTH | ELONGATION => MAX_LOG_STEP,
        _ => f64::INFINITY,
    };
    let steps = || step.iter().take(n).enumerate();
    let shrink = steps().map(|(i, step)| step.abs() / longest_of(i)).fold(1.0, f64::max);
    let mut next = *at;
    for (i, step) in steps() {
        next[i] += step / shrink;
    }
    next[LOG_WIDTH] = next[LOG_WIDTH].clamp(libm::log(WIDTHS.0), libm::log(WIDTHS.1));
    next[HALO] = next[HALO].clamp(0.0, 0.9);
    next
}

/// Returns the width of a Gaussian smeared over a trail, by adding the variance of a uniform distribution.
fn smeared(sigma_px: f64, trail_px: f64) -> f64 {
    (sigma_px * sigma_px + trail_px * trail_px / 12.0).sqrt()
}

/// Computes the shares of a Gaussian of width `sigma` about `centre` on all pixels of an axis, with one error
/// function per edge.
fn fill(shares: &mut [Share], centre: f64, sigma: f64) {
    let mut left = Edge::from_offset(-0.5 - centre, sigma);
    for (i, share) in shares.iter_mut().enumerate() {
        let right = Edge::from_offset(i as f64 + 0.5 - centre, sigma);
        *share = Share::between(&left, &right, sigma);
        left = right;
    }
}

/// Distance in widths beyond which a Gaussian is negligible, to 1e-9 of its total.
const GAUSSIAN_REACH: f64 = 6.0;

/// Distance of an edge in widths, and cumulative distribution and density there.
struct Edge {
    t: f64,
    cumulative: f64,
    density: f64,
}

impl Edge {
    fn from_offset(offset: f64, sigma: f64) -> Self {
        let t = offset / sigma;
        if t.abs() > GAUSSIAN_REACH {
            return Self { t, cumulative: 0.5_f64.copysign(t), density: 0.0 };
        }
        Self {
            t,
            cumulative: 0.5 * libm::erf(t * std::f64::consts::FRAC_1_SQRT_2),
            density: 0.5
                * std::f64::consts::FRAC_2_SQRT_PI
                * std::f64::consts::FRAC_1_SQRT_2
                * libm::exp(-0.5 * t * t),
        }
    }
}

impl Share {
    fn from_offset(offset: f64, sigma: f64) -> Self {
        Self::between(&Edge::from_offset(offset - 0.5, sigma), &Edge::from_offset(offset + 0.5, sigma), sigma)
    }

    fn between(left: &Edge, right: &Edge, sigma: f64) -> Self {
        Self {
            value: right.cumulative - left.cumulative,
            by_centre: (left.density - right.density) / sigma,
            by_log_width: left.t * left.density - right.t * right.density,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::lost_in_space::tests::Random;
    use super::*;

    const SIDE: usize = 25;

    fn noise() -> PixelNoise {
        PixelNoise { readout_e2: 225.0, response: 0.0 }
    }

    /// Returns a model with free position, flux and background, and a Gaussian image of known width.
    fn model(x_px: f64, y_px: f64, flux_e: f64, background_e: f64, sigma_px: f64) -> ImageModel<'static> {
        ImageModel {
            x_px: Prior::free(x_px),
            y_px: Prior::free(y_px),
            flux_e: Prior::free(flux_e),
            background_e: Prior::free(background_e),
            log_width: Prior::fixed(0.0),
            log_elongation: Prior::fixed(0.0),
            halo_fraction: Prior::fixed(0.0),
            image: PointImage { sigma_px, halo_sigma_px: 4.0, halo_fraction: 0.0, trail_px: [0.0; 2] },
            neighbours: &[],
        }
    }

    /// Returns the expected pixels of a Gaussian source on a background.
    fn expected(x_px: f64, y_px: f64, flux_e: f64, background_e: f64, sigma_px: f64) -> Vec<Pixel> {
        let share = |pixel: usize, centre: f64| {
            let cumulative =
                |edge: f64| 0.5 * libm::erf((edge - centre) / (sigma_px * std::f64::consts::SQRT_2));
            cumulative(pixel as f64 + 0.5) - cumulative(pixel as f64 - 0.5)
        };
        let electrons = |column, row| background_e + flux_e * share(column, x_px) * share(row, y_px);
        (0..SIDE * SIDE)
            .map(|i| (i % SIDE, i / SIDE))
            .map(|(column, row)| Pixel { column, row, electrons: electrons(column, row) })
            .collect()
    }

    fn fit(pixels: &[Pixel], model: &ImageModel<'_>) -> Option<FittedImage> {
        ImageFitter::default().fit(pixels, (SIDE, SIDE), noise(), model)
    }

    #[test]
    fn fewer_than_four_pixels_are_no_fit() {
        let pixels = expected(12.2, 11.9, 9000.0, 50.0, 0.8);
        let core = [(12, 12), (13, 12), (12, 11), (11, 12)].map(|(column, row)| pixels[row * SIDE + column]);
        let free = model(12.0, 12.0, 8000.0, 50.0, 0.8);
        let with_priors = ImageModel {
            x_px: Prior::normal(12.0, 1.0),
            y_px: Prior::normal(12.0, 1.0),
            background_e: Prior::normal(50.0, 5.0),
            ..free
        };
        for model in [free, with_priors] {
            assert!(fit(&core, &model).is_some());
            for count in 0..4 {
                assert_eq!(fit(&core[..count], &model), None, "{count} pixels");
            }
        }
    }

    /// A model without flux has no derivative by the position. From an initial flux, the fit may end at a
    /// flux near 0, with a position that is uncertain by more than the window.
    #[test]
    fn no_light_gives_no_position() {
        let dark = expected(12.0, 12.0, 0.0, 50.0, 0.8);
        assert_eq!(fit(&dark, &model(12.0, 12.0, 0.0, 50.0, 0.8)), None);
        for flux_e in [1.0, 300.0, 8000.0] {
            if let Some(found) = fit(&dark, &model(12.3, 11.8, flux_e, 50.0, 0.8)) {
                let [xx, _, yy] = found.covariance_px2;
                assert!(xx.min(yy).sqrt() > SIDE as f64, "from {flux_e} e: {found:?}");
                assert!(found.flux_e.abs() < 0.1 * found.flux_sigma_e, "from {flux_e} e: {found:?}");
            }
        }
    }

    #[test]
    fn a_centre_over_eight_pixels_outside_the_window_is_no_fit() {
        let found =
            |x_px: f64| fit(&expected(x_px, 12.0, 1e6, 50.0, 4.0), &model(x_px, 12.0, 1e6, 50.0, 4.0));
        assert!(found(-8.3).is_some_and(|found| (found.x_px + 8.3).abs() < 1e-6));
        assert_eq!(found(-8.7), None);
    }

    /// The variance v of a pixel is uniform if the background dominates. For a well-sampled Gaussian
    /// G = exp(−r²/2σ²)/(2πσ²), the Fisher information of the centre along x is
    /// (F²/v) ∫ (x/σ²)² G² dx dy = (F²/v) (1/4π²σ⁸) (πσ⁴/2) = F²/(8πσ⁴v), so σ_x = √(8π) σ² √v/F (King 1983,
    /// PASP 95, 163). Integration over pixels widens the image: σ² + 1/12 px² replaces σ².
    #[test]
    fn the_sigma_of_a_centre_in_background_noise_is_that_of_king_1983() {
        const DRAWS: u32 = 1000;
        let background_e = 1e6;
        let mut random = Random(1983);
        for (sigma_px, x_px, y_px) in [(1.2, 12.0, 12.0), (1.2, 12.3, 11.6), (2.0, 12.4, 12.1)] {
            // The brightest pixel is 0.7 % above the background, and σ_x is 0.12 px: the fit is linear.
            let flux_e = 42_000.0 * sigma_px * sigma_px;
            let variance = background_e + noise().readout_e2;
            let closed =
                (8.0 * std::f64::consts::PI * variance).sqrt() * (sigma_px * sigma_px + 1.0 / 12.0) / flux_e;
            let model = model(x_px, y_px, flux_e, background_e, sigma_px);
            let pixels = expected(x_px, y_px, flux_e, background_e, sigma_px);
            let [xx, xy, yy] = fit(&pixels, &model).unwrap().covariance_px2;
            // Tolerance: the source's own noise, at most 0.35 % of σ, and higher orders of the pixel's size.
            for sigma in [xx.sqrt(), yy.sqrt()] {
                assert!((sigma / closed - 1.0).abs() < 0.01, "{sigma_px} px: {sigma} {closed}");
            }
            assert!(xy.abs() < 0.01 * xx, "{xy} {xx}");
            let mut squares = 0.0;
            for _ in 0..DRAWS {
                let drawn: Vec<Pixel> = pixels
                    .iter()
                    .map(|p| Pixel { electrons: p.electrons + variance.sqrt() * random.normal(), ..*p })
                    .collect();
                let found = fit(&drawn, &model).unwrap();
                squares +=
                    (found.x_px - x_px) * (found.x_px - x_px) + (found.y_px - y_px) * (found.y_px - y_px);
            }
            // The RMS of 2,000 errors is uncertain by 1.6 %.
            let rms = (squares / f64::from(2 * DRAWS)).sqrt();
            println!("{sigma_px} px: {} {}", xx.sqrt() / closed, rms / closed);
            assert!((rms / closed - 1.0).abs() < 0.05, "{sigma_px} px: {rms} {closed}");
        }
    }
}
