//! Fixed differences between pixels: offsets, dark currents, response.

use libm::sqrt;
use nalgebra::{DMatrix, DVector};

use crate::moments::{GoodPixels, LineVariances, PixelMaps, StackMoments, Variance, line_variances};

/// Degree of the surface that is taken out of flat frames: the shape of the light and of the lens.
const SURFACE_DEGREE: usize = 3;

/// A stack with its maps and moments.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasuredStack<'a> {
    pub(crate) time_s: f64,
    pub(crate) maps: &'a PixelMaps,
    pub(crate) moments: &'a StackMoments,
}

/// Dark signal of each pixel: offset and, with two or more exposure times, its rise with time.
#[derive(Debug, Clone)]
pub(crate) struct DarkSignal {
    /// Coefficients of the stacks whose sum is the offset, and of those whose sum is the rise per second.
    offset_weights: Vec<f64>,
    rise_weights: Option<Vec<f64>>,
    /// Offset of each pixel at time 0 (or at the only exposure time), DN.
    pub(crate) offset: Vec<f32>,
    /// Rise of each pixel, DN/s.
    pub(crate) rise: Option<Vec<f32>>,
}

impl DarkSignal {
    /// Fits a line in time to every pixel, with weights by the noise of the stacks; `None` without a stack.
    pub(crate) fn new(stacks: &[MeasuredStack<'_>]) -> Option<Self> {
        let first = stacks.first()?;
        // One set of weights for all pixels keeps the noise of a pixel's line the same for all.
        let weights: Vec<f64> = stacks
            .iter()
            .map(|stack| stack.moments.frames as f64 / stack.moments.pixel[0].max(1e-3))
            .collect();
        let sum = weights.iter().sum::<f64>();
        let mean_time = stacks.iter().zip(&weights).map(|(s, w)| w * s.time_s).sum::<f64>() / sum;
        let spread = stacks
            .iter()
            .zip(&weights)
            .map(|(s, w)| w * (s.time_s - mean_time) * (s.time_s - mean_time))
            .sum::<f64>();
        let has_rise = stacks.iter().any(|stack| stack.time_s != first.time_s) && spread > 0.0;
        let rise_weights: Option<Vec<f64>> = has_rise
            .then(|| stacks.iter().zip(&weights).map(|(s, w)| w * (s.time_s - mean_time) / spread).collect());
        let offset_weights: Vec<f64> = weights
            .iter()
            .enumerate()
            .map(|(i, w)| w / sum - rise_weights.as_ref().map_or(0.0, |rise| mean_time * rise[i]))
            .collect();
        let combine = |weights: &[f64]| combined(stacks, weights);
        Some(Self {
            offset: combine(&offset_weights),
            rise: rise_weights.as_deref().map(combine),
            offset_weights,
            rise_weights,
        })
    }

    /// Dark signal of a pixel after a time, DN.
    fn at(&self, pixel: usize, time_s: f64) -> f64 {
        f64::from(self.offset[pixel]) + self.rise.as_ref().map_or(0.0, |rise| time_s * f64::from(rise[pixel]))
    }

    /// Coefficients of the stacks in the sum over several times, with weights.
    fn weights_of_sum(&self, times: &[(f64, f64)]) -> Vec<f64> {
        let (weight, weighted_time) =
            times.iter().fold((0.0, 0.0), |(w, wt), (time_s, weight)| (w + weight, wt + weight * time_s));
        let rise = |i: usize| self.rise_weights.as_ref().map_or(0.0, |rise| rise[i]);
        self.offset_weights
            .iter()
            .enumerate()
            .map(|(i, offset)| weight * offset + weighted_time * rise(i))
            .collect()
    }
}

/// Sum of the mean images of stacks with weights.
fn combined(stacks: &[MeasuredStack<'_>], weights: &[f64]) -> Vec<f32> {
    let pixels = stacks.first().map_or(0, |stack| stack.maps.mean.len());
    let mut sum = vec![0.0_f64; pixels];
    for (stack, weight) in stacks.iter().zip(weights) {
        sum.iter_mut().zip(&stack.maps.mean).for_each(|(sum, mean)| *sum += weight * f64::from(*mean));
    }
    sum.into_iter().map(|value| value as f32).collect()
}

/// Variances of fixed patterns: rows, columns, pixels, and their sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PatternVariances {
    pub(crate) row: Variance,
    pub(crate) column: Variance,
    pub(crate) pixel: Variance,
}

impl PatternVariances {
    /// Sum of the three: spatial variance of EMVA 1288.
    pub(crate) fn total(&self) -> Variance {
        let parts = [self.row, self.column, self.pixel];
        let sigma = sqrt(parts.iter().map(|[_, sigma]| sigma * sigma).sum());
        [parts.iter().map(|[variance, _]| variance.max(0.0)).sum(), sigma]
    }

    /// Divides all variances by the square of a signal.
    pub(crate) fn over(self, signal: f64) -> Self {
        let scaled = |variance: Variance| variance.map(|value| value / (signal * signal));
        Self { row: scaled(self.row), column: scaled(self.column), pixel: scaled(self.pixel) }
    }
}

/// Splits the variance of an image and subtracts the temporal noise that its frames leave: `stacks` with the
/// weights by which their mean images are in it.
fn without_noise(
    image: Vec<f32>,
    good: &GoodPixels,
    stacks: &[(&StackMoments, f64)],
) -> (PatternVariances, LineVariances) {
    let lines = line_variances(&mut std::iter::once(image), good, 1.0);
    let [mut row, mut column, mut pixel] = lines.components();
    for (moments, weight) in stacks {
        // Variance of a mean of n frames, and of its estimate.
        let share = weight * weight / moments.frames as f64;
        let subtract = |pattern: &mut Variance, noise: Variance| {
            pattern[0] -= share * noise[0];
            pattern[1] = sqrt(pattern[1] * pattern[1] + share * share * noise[1] * noise[1]);
        };
        subtract(&mut pixel, moments.pixel);
        subtract(&mut row, [moments.row[0].max(0.0), moments.row[1]]);
        subtract(&mut column, [moments.column[0].max(0.0), moments.column[1]]);
    }
    (PatternVariances { row, column, pixel }, lines)
}

/// Variances of the offsets of a stack, DN².
pub(crate) fn offset_pattern(stack: &MeasuredStack<'_>, good: &GoodPixels) -> PatternVariances {
    without_noise(stack.maps.mean.clone(), good, &[(stack.moments, 1.0)]).0
}

/// Variances of the rise of the dark signal, DN²/s²; `None` with one exposure time.
pub(crate) fn rise_pattern(
    dark: &DarkSignal,
    stacks: &[MeasuredStack<'_>],
    good: &GoodPixels,
) -> Option<PatternVariances> {
    let weights = dark.rise_weights.as_ref()?;
    let noise: Vec<(&StackMoments, f64)> =
        stacks.iter().zip(weights).map(|(stack, weight)| (stack.moments, *weight)).collect();
    Some(without_noise(dark.rise.clone()?, good, &noise).0)
}

/// Sum of the flats above the dark signal, each weighted by its frames, which are those of shot noise.
pub(crate) fn response_sum(dark: &DarkSignal, flats: &[MeasuredStack<'_>]) -> Vec<f32> {
    let pixels = flats.first().map_or(0, |flat| flat.maps.mean.len());
    let mut sum = vec![0.0_f64; pixels];
    for flat in flats {
        let frames = flat.moments.frames as f64;
        for (pixel, sum) in sum.iter_mut().enumerate() {
            *sum += frames * (f64::from(flat.maps.mean[pixel]) - dark.at(pixel, flat.time_s));
        }
    }
    sum.into_iter().map(|value| value as f32).collect()
}

/// Variances of the response as fractions of the signal after a smooth surface; `signal` is the sum of the
/// flats' signals, as by [`response_sum`], times the slope of the response at them.
pub(crate) fn response_pattern(
    dark: &DarkSignal,
    dark_stacks: &[MeasuredStack<'_>],
    flats: &[MeasuredStack<'_>],
    good: &GoodPixels,
    signal: f64,
) -> PatternVariances {
    let mut sum = response_sum(dark, flats);
    let surface = smooth_surface(&sum, good);
    let mean = surface.iter().map(|value| f64::from(*value)).sum::<f64>() / surface.len() as f64;
    for (value, surface) in sum.iter_mut().zip(&surface) {
        // The response is the ratio to the surface, in units of the mean signal.
        let surface = f64::from(*surface);
        *value = if surface > 0.1 * mean { ((f64::from(*value) / surface - 1.0) * mean) as f32 } else { 0.0 };
    }
    let times: Vec<(f64, f64)> = flats.iter().map(|flat| (flat.time_s, flat.moments.frames as f64)).collect();
    let mut noise: Vec<(&StackMoments, f64)> =
        flats.iter().map(|flat| (flat.moments, flat.moments.frames as f64)).collect();
    let of_dark = dark.weights_of_sum(&times);
    noise.extend(dark_stacks.iter().zip(of_dark).map(|(stack, weight)| (stack.moments, weight)));
    without_noise(sum, good, &noise).0.over(signal)
}

/// Surface of the third degree in columns and rows, fitted to the good pixels by least squares.
pub(crate) fn smooth_surface(image: &[f32], good: &GoodPixels) -> Vec<f32> {
    let terms = |pixel: usize| {
        let x = 2.0 * (pixel % good.columns) as f64 / good.columns as f64 - 1.0;
        let y = 2.0 * (pixel / good.columns) as f64 / good.rows as f64 - 1.0;
        let mut terms = Vec::with_capacity(10);
        for of_x in 0..=SURFACE_DEGREE {
            for of_y in 0..=SURFACE_DEGREE - of_x {
                terms.push(power(x, of_x) * power(y, of_y));
            }
        }
        terms
    };
    let size = (SURFACE_DEGREE + 1) * (SURFACE_DEGREE + 2) / 2;
    let mut normal = DMatrix::zeros(size, size);
    let mut right = DVector::zeros(size);
    for (pixel, value) in image.iter().enumerate().filter(|(pixel, _)| good.is_good[*pixel]) {
        let terms = DVector::from_vec(terms(pixel));
        normal.ger(1.0, &terms, &terms, 1.0);
        right.axpy(f64::from(*value), &terms, 1.0);
    }
    let Some(coefficients) = normal.cholesky().map(|cholesky| cholesky.solve(&right)) else {
        return vec![0.0; image.len()];
    };
    (0..image.len())
        .map(|pixel| terms(pixel).iter().zip(coefficients.iter()).map(|(t, c)| t * c).sum::<f64>() as f32)
        .collect()
}

fn power(base: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_takes_the_shape_and_leaves_the_pixels() {
        let (columns, rows) = (60, 50);
        let good = GoodPixels { columns, rows, is_good: vec![true; columns * rows] };
        let shape = |pixel: usize| {
            let (x, y) = ((pixel % columns) as f64 / 60.0, (pixel / columns) as f64 / 50.0);
            1000.0 - 300.0 * x * x + 200.0 * x * y * y
        };
        let image: Vec<f32> = (0..columns * rows)
            .map(|pixel| (shape(pixel) + if pixel % 2 == 0 { 5.0 } else { -5.0 }) as f32)
            .collect();
        let surface = smooth_surface(&image, &good);
        let worst = surface
            .iter()
            .enumerate()
            .map(|(pixel, value)| (f64::from(*value) - shape(pixel)).abs())
            .fold(0.0, f64::max);
        assert!(worst < 1.0, "{worst}");
    }

    #[test]
    fn dark_lines_of_pixels_are_those_of_their_means() {
        let moments = StackMoments {
            frames: 4,
            mean: 0.0,
            mean_sigma: 0.1,
            pixel: [4.0, 0.1],
            row: [0.0, 0.1],
            column: [0.0, 0.1],
            total: [4.0, 0.1],
            frame_mean: [0.0, 0.0],
            share_at_top: 0.0,
            share_at_zero: 0.0,
        };
        let map = |time_s: f32| PixelMaps {
            mean: vec![100.0 + 2.0 * time_s, 101.0 + 3.0 * time_s],
            variance: vec![4.0; 2],
        };
        let maps = [map(0.0), map(1.0), map(5.0)];
        let stacks: Vec<MeasuredStack<'_>> = maps
            .iter()
            .zip([0.0, 1.0, 5.0])
            .map(|(maps, time_s)| MeasuredStack { time_s, maps, moments: &moments })
            .collect();
        let dark = DarkSignal::new(&stacks).unwrap();
        let rise = dark.rise.clone().unwrap();
        assert!((rise[0] - 2.0).abs() < 1e-4 && (rise[1] - 3.0).abs() < 1e-4);
        assert!((dark.at(1, 10.0) - 131.0).abs() < 1e-3);
        assert!((dark.weights_of_sum(&[(0.0, 1.0), (2.0, 3.0)]).iter().sum::<f64>() - 4.0).abs() < 1e-9);
        assert!(DarkSignal::new(&stacks[..1]).unwrap().rise.is_none());
    }
}
