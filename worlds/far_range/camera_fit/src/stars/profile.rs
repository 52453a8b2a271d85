//! Profile of the stars: a Gaussian or a Moffat function, whose width may grow towards the corners.
//!
//! All stars are fitted together. A star's pixels are b + F P(x, y) + F dx ∂P/∂x + F dy ∂P/∂y, linear in its
//! background b, its flux F and the small shift (dx, dy) of its measured position; these four are eliminated
//! (variable projection: Golub & Pereyra 1973), so that the unknowns of the adjustment are those of the
//! profile alone: its width, 1/β of a Moffat function (0: a Gaussian), and the growth a: at ρ, the distance
//! from the principal point over that of the farthest corner, the width is 1 + a ρ² times that of the centre.

use contract::{Camera, PixelPoint};
use files::GreyImage;
use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

/// Distance from the pixel of the maximum up to which a star's pixels are used, px.
const REACH_PX: i64 = 6;

/// Number of pixels of a star.
const PIXELS: usize = ((2 * REACH_PX + 1) * (2 * REACH_PX + 1)) as usize;

/// Smallest number of stars of a profile, and largest: the brightest are used.
const MIN_STARS: usize = 5;
const MAX_STARS: usize = 120;

/// Smallest significance of a star of a profile, standard deviations.
const MIN_SIGNIFICANCE: f64 = 15.0;

/// Error of the model as a share of a pixel's value: keeps the brightest stars from outweighing all others.
const MODEL_ERROR: f64 = 0.03;

/// Largest number of steps, and change of the unknowns below which they end.
const MAX_STEPS: usize = 40;
const MIN_STEP: f64 = 1e-6;

/// Steps of the numerical derivatives: of the unknowns, and of a position, px.
const UNKNOWN_STEP: f64 = 1e-4;
const POSITION_STEP_PX: f64 = 1e-3;

/// Limits of the width, px: of the standard deviation of a Gaussian of the same full width at half maximum.
const MIN_WIDTH_PX: f64 = 0.15;
const MAX_WIDTH_PX: f64 = 4.0;

/// Limits of 1/β: a Moffat function with the smaller one cannot be told from a Gaussian.
const MIN_INVERSE_BETA: f64 = 0.05;
const MAX_INVERSE_BETA: f64 = 0.8;

/// Growth in standard deviations below which the width is that of the centre everywhere, and its limits.
const GROWTH_SIGMAS: f64 = 3.0;
const MIN_GROWTH: f64 = -0.5;
const MAX_GROWTH: f64 = 5.0;

/// Nodes and weights of Gauss–Legendre integration with three points over a pixel.
const NODES: [f64; 3] = [-0.387_298_334_620_741_7, 0.0, 0.387_298_334_620_741_7];
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

/// Full width at half maximum of a Gaussian over its standard deviation, 2 √(2 ln 2).
const FWHM_PER_SIGMA: f64 = 2.354_820_045_030_949_3;

/// Function of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProfileKind {
    /// Gaussian with this standard deviation, px.
    Gaussian {
        /// Standard deviation at the principal point, px.
        sigma_px: f64,
    },
    /// Moffat function.
    Moffat {
        /// Full width at half maximum at the principal point, px.
        fwhm_px: f64,
        /// Exponent β, 1.25 to 20.
        beta: f64,
    },
}

/// Profile of the stars of a camera, before its integration over the pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarProfile {
    /// Function.
    pub kind: ProfileKind,
    /// Relative error of its width, one standard deviation.
    pub width_error: f64,
    /// Growth a of the width towards the corners, with its standard deviation: the width at ρ is 1 + a ρ²
    /// times that of the centre. 0 where the stars do not show one.
    pub growth: [f64; 2],
    /// Number of stars.
    pub stars: usize,
}

impl StarProfile {
    /// Returns the share of the flux of a star at the principal point that lies within `reach` pixels of its
    /// central pixel along both axes; the star is centred on that pixel.
    pub fn share_within(&self, reach: u32) -> f64 {
        let unknowns = self.unknowns();
        let reach = reach as i32;
        let mut sum = 0.0;
        for y in -reach..=reach {
            for x in -reach..=reach {
                sum += unknowns.pixel(0.0, f64::from(x), f64::from(y));
            }
        }
        sum
    }

    fn unknowns(&self) -> Unknowns {
        let [growth, _] = self.growth;
        match self.kind {
            ProfileKind::Gaussian { sigma_px } => {
                Unknowns { lg_width: libm::log(sigma_px), inverse_beta: 0.0, growth }
            }
            ProfileKind::Moffat { fwhm_px, beta } => {
                Unknowns { lg_width: libm::log(fwhm_px / FWHM_PER_SIGMA), inverse_beta: 1.0 / beta, growth }
            }
        }
    }
}

/// A star whose pixels are used.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProfileStar<'image> {
    /// Image.
    pub(crate) image: &'image GreyImage,
    /// Noise of a pixel of the background, DN.
    pub(crate) noise_dn: f64,
    /// Measured position, px.
    pub(crate) position: PixelPoint,
    /// Pixel of the maximum.
    pub(crate) peak: [usize; 2],
    /// Height above the noise, standard deviations.
    pub(crate) significance: f64,
}

/// Fits a profile to stars, of which the brightest are used; `None` if there are too few.
pub(crate) fn star_profile(camera: &Camera, stars: &[ProfileStar<'_>]) -> Option<StarProfile> {
    let cuts = cut_stars(camera, stars);
    if cuts.len() < MIN_STARS {
        return None;
    }
    let gaussian = fit(&cuts, &Unknowns { lg_width: libm::log(0.8), inverse_beta: 0.0, growth: 0.0 })?;
    let start = Unknowns { inverse_beta: 0.25, ..gaussian.unknowns };
    let moffat = fit(&cuts, &start).filter(|moffat| moffat.unknowns.inverse_beta > MIN_INVERSE_BETA);
    // Schwarz's criterion: the third unknown must lower n ln Σ by more than ln n.
    let count = (cuts.len() * PIXELS) as f64;
    let is_better = |moffat: &Fitted| count * libm::log(gaussian.sum / moffat.sum) > libm::log(count);
    let best = moffat.filter(is_better).unwrap_or(gaussian);
    Some(best.profile(cuts.len()))
}

/// Unknowns of a profile.
#[derive(Debug, Clone, Copy)]
struct Unknowns {
    /// Natural logarithm of the width in px: full width at half maximum over [`FWHM_PER_SIGMA`].
    lg_width: f64,
    /// 1/β; 0 for a Gaussian.
    inverse_beta: f64,
    /// Growth a.
    growth: f64,
}

impl Unknowns {
    /// Returns the unknowns that are adjusted: 1/β only of a Moffat function.
    fn free(&self) -> usize {
        if self.inverse_beta > 0.0 { 3 } else { 2 }
    }

    /// Returns the unknowns with one of them changed.
    fn changed(mut self, index: usize, step: f64) -> Self {
        match index {
            0 => self.lg_width += step,
            1 => self.growth += step,
            _ => self.inverse_beta += step,
        }
        self
    }

    /// Returns the unknowns after a step, within their limits.
    fn after(self, step: &DVector<f64>, share: f64) -> Self {
        let mut next = self;
        for (index, change) in step.iter().enumerate() {
            next = next.changed(index, share * change);
        }
        next.lg_width = next.lg_width.clamp(libm::log(MIN_WIDTH_PX), libm::log(MAX_WIDTH_PX));
        next.growth = next.growth.clamp(MIN_GROWTH, MAX_GROWTH);
        if self.inverse_beta > 0.0 {
            next.inverse_beta = next.inverse_beta.clamp(MIN_INVERSE_BETA, MAX_INVERSE_BETA);
        }
        next
    }

    /// Returns the flux of a star of unit flux at (dx, dy) px from the centre of a pixel, in that pixel.
    fn pixel(&self, rho2: f64, dx: f64, dy: f64) -> f64 {
        let width = libm::exp(self.lg_width) * (1.0 + self.growth * rho2);
        if self.inverse_beta <= 0.0 {
            return gaussian_share(dx, width) * gaussian_share(dy, width);
        }
        let beta = 1.0 / self.inverse_beta;
        // FWHM = 2 α √(2^(1/β) − 1).
        let alpha = 0.5 * FWHM_PER_SIGMA * width / (libm::exp2(self.inverse_beta) - 1.0).sqrt();
        let peak = (beta - 1.0) / (std::f64::consts::PI * alpha * alpha);
        let mut sum = 0.0;
        for (y, weight_y) in NODES.into_iter().zip(WEIGHTS) {
            for (x, weight_x) in NODES.into_iter().zip(WEIGHTS) {
                let (u, v) = ((dx + x) / alpha, (dy + y) / alpha);
                sum += weight_x * weight_y * libm::pow(1.0 + u * u + v * v, -beta);
            }
        }
        peak * sum
    }
}

/// Returns the part of a Gaussian line of unit area that lies within half a pixel of `offset` from its
/// centre.
fn gaussian_share(offset: f64, sigma: f64) -> f64 {
    let scale = std::f64::consts::FRAC_1_SQRT_2 / sigma;
    0.5 * (libm::erf((offset + 0.5) * scale) - libm::erf((offset - 0.5) * scale))
}

/// Pixels of a star.
struct Cut {
    /// Values, DN.
    values: Vec<f64>,
    /// Weights, DN⁻².
    weights: Vec<f64>,
    /// Position of each pixel from the measured position of the star, px.
    offsets: Vec<[f64; 2]>,
    /// ρ² of the star.
    rho2: f64,
}

/// Returns the pixels of the most significant stars.
fn cut_stars(camera: &Camera, stars: &[ProfileStar<'_>]) -> Vec<Cut> {
    let mut order: Vec<&ProfileStar<'_>> =
        stars.iter().filter(|star| star.significance >= MIN_SIGNIFICANCE).collect();
    order.sort_by(|a, b| b.significance.total_cmp(&a.significance));
    order.truncate(MAX_STARS);
    order.into_iter().filter_map(|star| cut(camera, star)).collect()
}

/// Returns the pixels of a star; `None` at the edge of the image.
fn cut(camera: &Camera, star: &ProfileStar<'_>) -> Option<Cut> {
    let [column, row] = star.peak.map(|pixel| pixel as i64);
    let image = star.image;
    let is_inside = column >= REACH_PX
        && row >= REACH_PX
        && column + REACH_PX < image.columns as i64
        && row + REACH_PX < image.rows as i64;
    if !is_inside {
        return None;
    }
    let mut cut = Cut {
        values: Vec::with_capacity(PIXELS),
        weights: Vec::with_capacity(PIXELS),
        offsets: Vec::with_capacity(PIXELS),
        rho2: rho2(camera, star.position),
    };
    for y in row - REACH_PX..=row + REACH_PX {
        for x in column - REACH_PX..=column + REACH_PX {
            cut.values.push(image.at(x as usize, y as usize));
            cut.offsets.push([x as f64 - star.position.x, y as f64 - star.position.y]);
        }
    }
    let lowest = cut.values.iter().copied().fold(f64::INFINITY, f64::min);
    for value in &cut.values {
        let model_dn = MODEL_ERROR * (value - lowest);
        cut.weights.push(1.0 / (star.noise_dn * star.noise_dn + model_dn * model_dn));
    }
    Some(cut)
}

/// Returns ρ²: the square of the distance from the principal point over that of the farthest corner.
fn rho2(camera: &Camera, at: PixelPoint) -> f64 {
    let principal = PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
    let (right, bottom) = (camera.columns as f64 - 0.5, camera.rows as f64 - 0.5);
    let corners = [(-0.5, -0.5), (right, -0.5), (-0.5, bottom), (right, bottom)];
    let mut farthest = f64::MIN_POSITIVE;
    for (x, y) in corners {
        farthest = principal.distance(PixelPoint::new(x, y)).max(farthest);
    }
    let share = principal.distance(at) / farthest;
    share * share
}

/// Returns the weighted residuals of a star after the best background, flux and shift; zeros if these are not
/// determined.
fn projected_residuals(cut: &Cut, unknowns: &Unknowns) -> Vec<f64> {
    let mut rows: Vec<Vector4<f64>> = Vec::with_capacity(cut.values.len());
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for (index, &[dx, dy]) in cut.offsets.iter().enumerate() {
        let pixel = |x: f64, y: f64| unknowns.pixel(cut.rho2, x, y);
        let along_x = pixel(dx + POSITION_STEP_PX, dy) - pixel(dx - POSITION_STEP_PX, dy);
        let along_y = pixel(dx, dy + POSITION_STEP_PX) - pixel(dx, dy - POSITION_STEP_PX);
        let row = Vector4::new(
            1.0,
            pixel(dx, dy),
            along_x / (2.0 * POSITION_STEP_PX),
            along_y / (2.0 * POSITION_STEP_PX),
        );
        normal += cut.weights[index] * row * row.transpose();
        right += cut.weights[index] * cut.values[index] * row;
        rows.push(row);
    }
    let solution = normal.cholesky().map(|factor| factor.solve(&right)).unwrap_or_default();
    let mut residuals = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        residuals.push((cut.values[index] - row.dot(&solution)) * cut.weights[index].sqrt());
    }
    residuals
}

/// A fitted profile.
struct Fitted {
    unknowns: Unknowns,
    /// Sum of the squares of the weighted residuals.
    sum: f64,
    covariance: DMatrix<f64>,
}

impl Fitted {
    fn profile(&self, stars: usize) -> StarProfile {
        let unknowns = &self.unknowns;
        let width_px = libm::exp(unknowns.lg_width);
        let kind = if unknowns.inverse_beta > 0.0 {
            ProfileKind::Moffat { fwhm_px: FWHM_PER_SIGMA * width_px, beta: 1.0 / unknowns.inverse_beta }
        } else {
            ProfileKind::Gaussian { sigma_px: width_px }
        };
        StarProfile {
            kind,
            width_error: self.covariance[(0, 0)].sqrt(),
            growth: [unknowns.growth, self.covariance[(1, 1)].sqrt()],
            stars,
        }
    }
}

/// Fits the unknowns by Gauss–Newton steps, halved until the sum decreases. A growth that the stars do not
/// show is set to 0, and the width fitted again.
fn fit(cuts: &[Cut], start: &Unknowns) -> Option<Fitted> {
    let fitted = fit_free(cuts, start, start.free())?;
    let sigma = fitted.covariance[(1, 1)].sqrt();
    if fitted.unknowns.growth.abs() > GROWTH_SIGMAS * sigma {
        return Some(fitted);
    }
    let mut uniform = fit_uniform(cuts, &Unknowns { growth: 0.0, ..fitted.unknowns })?;
    uniform.covariance[(1, 1)] = sigma * sigma;
    Some(uniform)
}

/// Fits width and 1/β with the width of the centre everywhere.
fn fit_uniform(cuts: &[Cut], start: &Unknowns) -> Option<Fitted> {
    let centred: Vec<Cut> = cuts
        .iter()
        .map(|cut| Cut {
            values: cut.values.clone(),
            weights: cut.weights.clone(),
            offsets: cut.offsets.clone(),
            rho2: 0.0,
        })
        .collect();
    fit_free(&centred, start, start.free())
}

fn fit_free(cuts: &[Cut], start: &Unknowns, free: usize) -> Option<Fitted> {
    let mut unknowns = *start;
    let mut equations = Equations::of(cuts, &unknowns, free);
    for _ in 0..MAX_STEPS {
        let step = equations.step()?;
        let mut share = 1.0;
        let mut next = None;
        while share > 1e-3 && next.is_none() {
            let tried = unknowns.after(&step, share);
            next = (sum_of_squares(cuts, &tried) < equations.sum).then_some(tried);
            share *= 0.5;
        }
        let Some(found) = next else { break };
        unknowns = found;
        equations = Equations::of(cuts, &unknowns, free);
        if 2.0 * share * step.amax() < MIN_STEP {
            break;
        }
    }
    Some(Fitted { unknowns, sum: equations.sum, covariance: equations.covariance()? })
}

fn sum_of_squares(cuts: &[Cut], unknowns: &Unknowns) -> f64 {
    cuts.iter().map(|cut| projected_residuals(cut, unknowns).iter().map(|r| r * r).sum::<f64>()).sum()
}

/// Normal equations of the unknowns.
struct Equations {
    normal: DMatrix<f64>,
    right: DVector<f64>,
    /// Sum of the squares of the stars' gradients (White 1980).
    scatter: DMatrix<f64>,
    sum: f64,
}

impl Equations {
    fn of(cuts: &[Cut], unknowns: &Unknowns, free: usize) -> Self {
        let mut equations = Self {
            normal: DMatrix::zeros(free, free),
            right: DVector::zeros(free),
            scatter: DMatrix::zeros(free, free),
            sum: 0.0,
        };
        for cut in cuts {
            equations.add(cut, unknowns);
        }
        // A growth has no effect where all stars are taken at the centre: a tiny prior keeps it at 0.
        for index in 0..free {
            equations.normal[(index, index)] += 1e-9;
        }
        equations
    }

    /// Adds the pixels of a star.
    fn add(&mut self, cut: &Cut, unknowns: &Unknowns) {
        let residuals = DVector::from_vec(projected_residuals(cut, unknowns));
        let free = self.right.len();
        let mut jacobian = DMatrix::zeros(residuals.len(), free);
        for index in 0..free {
            let changed = unknowns.changed(index, UNKNOWN_STEP);
            let after = DVector::from_vec(projected_residuals(cut, &changed));
            // Minus the derivative of the residuals: that of the model.
            jacobian.set_column(index, &((&residuals - after) / UNKNOWN_STEP));
        }
        let gradient = jacobian.transpose() * &residuals;
        self.normal += jacobian.transpose() * &jacobian;
        self.scatter += &gradient * gradient.transpose();
        self.right += gradient;
        self.sum += residuals.norm_squared();
    }

    fn step(&self) -> Option<DVector<f64>> {
        self.normal.clone().cholesky().map(|factor| factor.solve(&self.right))
    }

    /// Returns N⁻¹ S N⁻¹.
    fn covariance(&self) -> Option<DMatrix<f64>> {
        let inverse = self.normal.clone().cholesky()?.inverse();
        Some(&inverse * &self.scatter * &inverse)
    }
}

#[cfg(test)]
mod tests {
    use files::PixelConversion;

    use super::*;

    const SIDE: usize = 600;

    fn camera() -> Camera {
        Camera {
            columns: SIDE,
            rows: SIDE,
            focal_length_mm: 20.0,
            pixel_width_um: 5.0,
            pixel_height_um: 5.0,
            principal_x_px: 299.5,
            principal_y_px: 299.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    /// Draws stars by sums over 20 × 20 points of a pixel, with noise of σ = 2 DN.
    fn draw(profile: impl Fn(f64, f64, f64) -> f64) -> (GreyImage, Vec<PixelPoint>) {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut values = vec![0.0_f32; SIDE * SIDE];
        for value in &mut values {
            // Sum of twelve uniform numbers: nearly a normal one.
            let normal: f64 = (0..12).map(|_| random()).sum::<f64>() - 6.0;
            *value = (100.0 + 2.0 * normal) as f32;
        }
        let mut places = Vec::new();
        for i in 0..100 {
            let at = PixelPoint::new(
                30.0 + 60.0 * f64::from(i % 10) + random(),
                30.0 + 60.0 * f64::from(i / 10) + random(),
            );
            let flux = 1000.0 + 4000.0 * random();
            let rho2 = rho2(&camera(), at);
            let (column, row) = (at.x.round() as i64, at.y.round() as i64);
            for y in row - 12..=row + 12 {
                for x in column - 12..=column + 12 {
                    let mut sum = 0.0;
                    for step in 0..400 {
                        let sub_x = f64::from(step % 20) / 20.0 - 0.475;
                        let sub_y = f64::from(step / 20) / 20.0 - 0.475;
                        let (dx, dy) = (x as f64 + sub_x - at.x, y as f64 + sub_y - at.y);
                        sum += profile(rho2, libm::hypot(dx, dy), flux) / 400.0;
                    }
                    values[y as usize * SIDE + x as usize] += sum as f32;
                }
            }
            places.push(at);
        }
        let image = GreyImage {
            columns: SIDE,
            rows: SIDE,
            values,
            full_scale: 65535.0,
            conversion: PixelConversion::None,
        };
        (image, places)
    }

    fn fitted(image: &GreyImage, places: &[PixelPoint]) -> StarProfile {
        let stars: Vec<ProfileStar<'_>> = places
            .iter()
            .map(|at| ProfileStar {
                image,
                noise_dn: 2.0,
                // Measured positions are wrong by some hundredths of a pixel.
                position: PixelPoint::new(at.x + 0.02, at.y - 0.02),
                peak: [at.x.round() as usize, at.y.round() as usize],
                significance: 100.0,
            })
            .collect();
        star_profile(&camera(), &stars).unwrap()
    }

    #[test]
    fn a_gaussian_that_grows_is_found() {
        let (image, places) = draw(|rho2, r, flux| {
            let sigma = 0.8 * (1.0 + 0.4 * rho2);
            flux / (std::f64::consts::TAU * sigma * sigma) * libm::exp(-0.5 * r * r / (sigma * sigma))
        });
        let found = fitted(&image, &places);
        let ProfileKind::Gaussian { sigma_px } = found.kind else { panic!("{found:?}") };
        assert!((sigma_px / 0.8 - 1.0).abs() < 4.0 * found.width_error, "{found:?}");
        assert!((found.growth[0] - 0.4).abs() < 4.0 * found.growth[1], "{found:?}");
        assert!(found.width_error < 0.02 && found.stars == 100, "{found:?}");
    }

    #[test]
    fn a_moffat_function_is_distinguished_from_a_gaussian() {
        let (fwhm, beta) = (2.0, 2.8);
        let alpha = 0.5 * fwhm / (libm::exp2(1.0 / beta) - 1.0_f64).sqrt();
        let (image, places) = draw(|_, r, flux| {
            let peak = (beta - 1.0) / (std::f64::consts::PI * alpha * alpha);
            flux * peak * libm::pow(1.0 + r * r / (alpha * alpha), -beta)
        });
        let found = fitted(&image, &places);
        let ProfileKind::Moffat { fwhm_px, beta: found_beta } = found.kind else { panic!("{found:?}") };
        assert!((fwhm_px / fwhm - 1.0).abs() < 5.0 * found.width_error.max(0.002), "{found:?}");
        assert!((found_beta / beta - 1.0).abs() < 0.1, "{found:?}");
        // Within a circle of r the share is 1 − (1 + r²/α²)^(1 − β); the square of 9 × 9 pixels has the area
        // of a circle of 5.08 px.
        let within = 1.0 - libm::pow(1.0 + 5.08 * 5.08 / (alpha * alpha), 1.0 - beta);
        assert!((found.share_within(4) - within).abs() < 0.01, "{} {within}", found.share_within(4));
        assert_eq!(found.growth[0], 0.0, "{found:?}");
    }

    #[test]
    fn four_stars_have_no_profile() {
        let (image, places) = draw(|_, r, flux| flux * libm::exp(-r * r));
        let stars: Vec<ProfileStar<'_>> = places[..4]
            .iter()
            .map(|at| ProfileStar {
                image: &image,
                noise_dn: 2.0,
                position: *at,
                peak: [at.x.round() as usize, at.y.round() as usize],
                significance: 100.0,
            })
            .collect();
        assert_eq!(star_profile(&camera(), &stars), None);
    }
}
