//! A straight edge of a feature in the image, blurred.

use super::gaussian::Gaussian;
use crate::docking::geometry::Seen;

/// Variance of the lens and of the video along columns and rows, px²: the pixel's own box is not in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Blur {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Share of the blur that acts on pixels instead of on light.
    grid: f64,
    /// Weights of a sampled Gaussian at 0, 1 … px along columns and rows.
    taps: [[f64; TAPS]; 2],
}

/// Weights of the sampled Gaussian on one side, with that of the centre.
const TAPS: usize = 6;

/// Above this variance a sampled Gaussian is as good as a continuous one, px².
const SMOOTH_PX2: f64 = 1.5;

impl Blur {
    /// A continuous blur.
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y, grid: 0.0, taps: [[0.0; TAPS]; 2] }
    }

    /// A blur of which a share acts on pixels: a sampled Gaussian on what the pixels have integrated already, as a digital
    /// filter has it.
    pub(super) fn on_grid(x: f64, y: f64, share: f64) -> Self {
        let taps = [x, y].map(|variance| {
            let mut taps = [0.0; TAPS];
            for (k, tap) in taps.iter_mut().enumerate() {
                *tap = libm::exp(-0.5 * (k * k) as f64 / variance);
            }
            let sum = 2.0 * taps.iter().sum::<f64>() - taps[0];
            taps.map(|tap| tap / sum)
        });
        Self { x, y, grid: share, taps }
    }
}

/// Step and slope of an edge along the other axis, blurred by a sampled Gaussian of the pixels, at a distance in px: linear
/// between the pixels' borders.
fn sampled_step(taps: &[f64; TAPS], distance: f64) -> (f64, f64) {
    let x = distance.abs();
    let place = x + 0.5;
    if place.is_nan() || place >= TAPS as f64 {
        return (if distance > 0.0 { 1.0 } else { 0.0 }, 0.0);
    }
    let k = place as usize;
    // From the middle of the centre's pixel: half of it, all between, and a part of the last.
    let half = if k == 0 {
        taps[0] * x
    } else {
        0.5 * taps[0] + taps[1..k].iter().sum::<f64>() + taps[k] * (place - k as f64)
    };
    (0.5 + half.copysign(distance), taps[k])
}

/// Variance of a pixel's box along a side, px².
pub(super) const BOX_VARIANCE: f64 = 1.0 / 12.0;

/// Pose, blur x and y, the share of it on pixels, brightness of the side faces towards +y1, −y1, +y2, −y2.
pub(super) const GLOBALS: usize = 13;
/// The first globals are the pose.
pub(super) const POSE: usize = 6;
/// After it the variance along columns, then along rows.
pub(super) const BLUR: usize = 6;
/// The share of the blur that acts on pixels.
pub(super) const GRID: usize = 8;
/// After it the side faces.
pub(super) const SIDES: usize = 9;

/// Derivatives with respect to the globals.
pub(super) type ByGlobals = [f64; GLOBALS];

/// A straight line through the images of two points, its inside, and how it is blurred.
///
/// Blurring by a Gaussian of variances (x, y) and a pixel's box turns the step across the line into F(z), z the distance over
/// σ, σ² = n_x² (x + 1/12) + n_y² (y + 1/12). F is Φ with the next term of its Edgeworth series, for the box, whose fourth
/// cumulant along the normal is −(n_x⁴ + n_y⁴)/120.
///
/// A Gaussian sampled on the pixels has images of its spectrum about whole cycles a pixel. Across an edge along rows they make
/// the profile a chain of straight pieces; for an edge off that axis they fade by exp(−2π² σ² n²), n the normal's other component
/// (the product of the Gaussians G(f n_x − 1) G(f n_y) is that times G(f − n_x)). How much of the blur is of that kind is one
/// of the globals.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Edge {
    normal: (f64, f64),
    offset: f64,
    along: (f64, f64),
    along_offset: f64,
    /// Derivative of the distance with respect to the pose, where the line passes the first and the second point.
    by_pose: [[f64; POSE]; 2],
    per_sigma: f64,
    /// dz/d(variance) over z.
    by_blur: (f64, f64),
    kurtosis: f64,
    sampled: [Sampled; 2],
}

/// What a sampled blur adds to an edge almost along an axis.
#[derive(Debug, Clone, Copy, Default)]
struct Sampled {
    /// 0 far off the axis, 1 along it.
    fading: f64,
    share: f64,
    /// Distance along the axis over distance across the line; the continuous blur's 1/σ and kurtosis on the axis; σ of the line.
    stretch: f64,
    per_sigma: f64,
    kurtosis: f64,
    slope: f64,
    taps: [f64; TAPS],
}

/// Below this fading the sampled blur is the continuous one.
const LEAST_FADING: f64 = 0.01;

impl Sampled {
    fn new(
        along: f64,
        other: f64,
        variances: (f64, f64),
        blur: &Blur,
        taps: &[f64; TAPS],
        sigma: f64,
    ) -> Self {
        let (variance, other_variance) = variances;
        if taps[0] == 0.0 || variance.max(other_variance) > SMOOTH_PX2 {
            return Self::default();
        }
        let tau = std::f64::consts::TAU;
        let fading = libm::exp(-0.5 * tau * tau * other_variance * other * other);
        if fading < LEAST_FADING {
            return Self::default();
        }
        let full = variance + BOX_VARIANCE;
        Self {
            fading,
            share: blur.grid,
            stretch: 1.0 / along.abs(),
            per_sigma: 1.0 / full.sqrt(),
            kurtosis: 1.0 / (2880.0 * full * full),
            slope: sigma / along.abs(),
            taps: *taps,
        }
    }

    /// Sampled over continuous step, and the same of their slopes by z, at a distance across the line.
    fn over(&self, gaussian: &Gaussian, distance: f64) -> (f64, f64) {
        let x = distance * self.stretch;
        let z = x * self.per_sigma;
        let (below, density) = gaussian.at(z);
        let (step, slope) = sampled_step(&self.taps, x);
        let smooth = below + self.kurtosis * z * (z * z - 3.0) * density;
        (self.fading * (step - smooth), self.fading * self.slope * (slope - density * self.per_sigma))
    }
}

/// The blurred step at a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Step {
    z: f64,
    /// F: 0 far outside, 1 far inside.
    pub(super) inside: f64,
    /// dF/dz.
    pub(super) density: f64,
    /// dF/d(share of the blur on pixels).
    by_grid: f64,
}

impl Edge {
    /// The line through a and b; `inside` is any point on its inner side.
    pub(super) fn through(a: &Seen, b: &Seen, inside: (f64, f64), blur: Blur) -> Self {
        let (du, dv) = (b.u - a.u, b.v - a.v);
        let length2 = (du * du + dv * dv).max(f64::MIN_POSITIVE);
        let length = length2.sqrt();
        let (mut nx, mut ny) = (-dv / length, du / length);
        if nx * (inside.0 - a.u) + ny * (inside.1 - a.v) < 0.0 {
            (nx, ny) = (-nx, -ny);
        }
        let mut by_pose = [[0.0; POSE]; 2];
        for (slopes, point) in by_pose.iter_mut().zip([a, b]) {
            for (i, slope) in slopes.iter_mut().enumerate() {
                *slope = -nx * point.by_pose[(0, i)] - ny * point.by_pose[(1, i)];
            }
        }
        let variance = nx * nx * (blur.x + BOX_VARIANCE) + ny * ny * (blur.y + BOX_VARIANCE);
        Self {
            normal: (nx, ny),
            offset: -nx * a.u - ny * a.v,
            along: (du / length2, dv / length2),
            along_offset: -(du * a.u + dv * a.v) / length2,
            by_pose,
            per_sigma: 1.0 / variance.sqrt(),
            by_blur: (-0.5 * nx * nx / variance, -0.5 * ny * ny / variance),
            kurtosis: (nx * nx * nx * nx + ny * ny * ny * ny) / (2880.0 * variance * variance),
            sampled: [
                Sampled::new(nx, ny, (blur.x, blur.y), &blur, &blur.taps[0], variance.sqrt()),
                Sampled::new(ny, nx, (blur.y, blur.x), &blur, &blur.taps[1], variance.sqrt()),
            ],
        }
    }

    /// The step at an ideal image point.
    pub(super) fn step(&self, gaussian: &Gaussian, u: f64, v: f64) -> Step {
        let distance = self.normal.0 * u + self.normal.1 * v + self.offset;
        let z = distance * self.per_sigma;
        let (below, density) = gaussian.at(z);
        let mut step =
            Step { z, inside: below + self.kurtosis * z * (z * z - 3.0) * density, density, by_grid: 0.0 };
        for sampled in &self.sampled {
            if sampled.fading > 0.0 {
                let (value, slope) = sampled.over(gaussian, distance);
                step.inside += sampled.share * value;
                step.density += sampled.share * slope;
                step.by_grid += value;
            }
        }
        step
    }

    /// Adds `weight` × the derivative of the step.
    pub(super) fn add_derivative(&self, step: &Step, u: f64, v: f64, weight: f64, sum: &mut ByGlobals) {
        let slope = weight * step.density;
        sum[GRID] += weight * step.by_grid;
        if slope == 0.0 {
            return;
        }
        let tau = self.along.0 * u + self.along.1 * v + self.along_offset;
        let (a, b) = (slope * self.per_sigma * (1.0 - tau), slope * self.per_sigma * tau);
        for (sum, (by_a, by_b)) in sum.iter_mut().zip(self.by_pose[0].iter().zip(&self.by_pose[1])) {
            *sum += a * by_a + b * by_b;
        }
        sum[BLUR] += slope * step.z * self.by_blur.0;
        sum[BLUR + 1] += slope * step.z * self.by_blur.1;
    }

    /// Correlation of two edges' blurs: n·Σ·m/(σ_n σ_m), with normals inwards.
    pub(super) fn correlation(&self, other: &Self, blur: Blur) -> f64 {
        (self.normal.0 * other.normal.0 * (blur.x + BOX_VARIANCE)
            + self.normal.1 * other.normal.1 * (blur.y + BOX_VARIANCE))
            * self.per_sigma
            * other.per_sigma
    }

    /// How far a change of the pose moves the line at its two points, px, the larger.
    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.by_pose
            .iter()
            .map(|slopes| slopes.iter().zip(by).map(|(slope, d)| slope * d).sum::<f64>().abs())
            .fold(0.0, f64::max)
    }
}
