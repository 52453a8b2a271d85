//! Blurred straight edge of a feature in the image.

use super::blur::{BOX_VARIANCE, Blur};
use super::chunk::{IdealPositions, Steps};
use super::gaussian::LIMIT;
use super::sampled::{SampledProfiles, Tables};
use super::unknowns::{BLUR, ByGlobals, GLOBALS, GRID, POSE};
use crate::docking::pose::geometry::ProjectedPoint;

/// Straight line through the images of two points, with its inner side and its blur.
///
/// Blurring by a Gaussian of variances (x, y) and a pixel's box turns the step across the line into F(z),
/// with z the distance over σ and σ² = n_x² (x + 1/12) + n_y² (y + 1/12). F is Φ with the next term of its
/// Edgeworth series, for the box, whose fourth cumulant along the normal is −(n_x⁴ + n_y⁴)/120.
///
/// A blur that acts on pixel values rather than on the optical image has a different profile (`sampled.rs`).
/// The share of such blur is one of the globals.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Edge {
    normal: (f64, f64),
    offset: f64,
    along: (f64, f64),
    along_offset: f64,
    /// Derivatives of the distance with respect to the pose, at the first and at the second point of the
    /// line.
    by_pose: [[f64; POSE]; 2],
    per_sigma: f64,
    /// dz/d(variance), divided by z.
    by_blur: (f64, f64),
    kurtosis: f64,
    sigma: f64,
    /// Table of the sampled profile, and its share.
    sampled: Option<usize>,
    share: f64,
}

impl Edge {
    /// Returns the line through a and b; `inside` is any point on its inner side.
    pub(super) fn from_points(
        a: &ProjectedPoint,
        b: &ProjectedPoint,
        inside: (f64, f64),
        blur: Blur,
        profiles: &SampledProfiles,
    ) -> Self {
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
            sigma: variance.sqrt(),
            sampled: if blur.taps[0][0] > 0.0 { profiles.find((nx, ny), &blur) } else { None },
            share: blur.grid,
        }
    }

    /// Computes the step at pixels.
    #[inline(always)]
    pub(super) fn steps<const N: usize>(
        &self,
        tables: &Tables,
        at: &IdealPositions<N>,
        steps: &mut Steps<N>,
    ) {
        let mut distance = [0.0; N];
        for l in 0..N {
            distance[l] = self.normal.0 * at.u[l] + self.normal.1 * at.v[l] + self.offset;
            steps.z[l] = distance[l] * self.per_sigma;
        }
        steps.is_near = steps.z.iter().filter(|z| z.abs() < LIMIT).count() > 0;
        if !steps.is_near {
            // Most edges are far from most pixels.
            for l in 0..N {
                steps.inside[l] = if steps.z[l] > 0.0 { 1.0 } else { 0.0 };
            }
            return;
        }
        let (below, density) = tables.gaussian.cdfs_and_pdfs(steps.z);
        for l in 0..N {
            let z = steps.z[l];
            steps.inside[l] = below[l] + self.kurtosis * z * (z * z - 3.0) * density[l];
        }
        steps.density = density;
        match self.sampled {
            Some(table) => {
                let (value, slope) = tables.profiles.step_and_slope(table, &distance);
                for l in 0..N {
                    steps.inside[l] += self.share * value[l];
                    steps.density[l] += self.share * slope[l] * self.sigma;
                }
                steps.by_grid = value;
            }
            None => steps.by_grid = [0.0; N],
        }
        for l in 0..N {
            let z = steps.z[l];
            let is_near = z.abs() < LIMIT;
            let far = if z > 0.0 { 1.0 } else { 0.0 };
            steps.inside[l] = if is_near { steps.inside[l] } else { far };
            steps.density[l] = if is_near { steps.density[l] } else { 0.0 };
            steps.by_grid[l] = if is_near { steps.by_grid[l] } else { 0.0 };
        }
    }

    /// Adds `weight` × the derivative of the step, which must be near.
    #[inline(always)]
    pub(super) fn add_derivatives<const N: usize>(
        &self,
        steps: &Steps<N>,
        at: &IdealPositions<N>,
        weight: &[f64; N],
        sum: &mut [[f64; N]; GLOBALS],
    ) {
        let (mut slope, mut a, mut b) = ([0.0; N], [0.0; N], [0.0; N]);
        for l in 0..N {
            slope[l] = weight[l] * steps.density[l];
            let tau = self.along.0 * at.u[l] + self.along.1 * at.v[l] + self.along_offset;
            a[l] = slope[l] * self.per_sigma * (1.0 - tau);
            b[l] = slope[l] * self.per_sigma * tau;
        }
        for (sum, (by_a, by_b)) in sum.iter_mut().zip(self.by_pose[0].iter().zip(&self.by_pose[1])) {
            for l in 0..N {
                sum[l] += a[l] * by_a + b[l] * by_b;
            }
        }
        for (k, by_blur) in [self.by_blur.0, self.by_blur.1].into_iter().enumerate() {
            let sum = &mut sum[BLUR + k];
            for l in 0..N {
                sum[l] += slope[l] * steps.z[l] * by_blur;
            }
        }
        let sum = &mut sum[GRID];
        for l in 0..N {
            sum[l] += weight[l] * steps.by_grid[l];
        }
    }

    /// Returns the correlation of two edges' blurs: n·Σ·m/(σ_n σ_m), with normals inwards.
    pub(super) fn correlation(&self, other: &Self, blur: Blur) -> f64 {
        (self.normal.0 * other.normal.0 * (blur.x + BOX_VARIANCE)
            + self.normal.1 * other.normal.1 * (blur.y + BOX_VARIANCE))
            * self.per_sigma
            * other.per_sigma
    }

    pub(super) fn normal(&self) -> (f64, f64) {
        self.normal
    }

    /// Returns the larger displacement of the line's two points under a change of the pose, px.
    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.by_pose
            .iter()
            .map(|slopes| slopes.iter().zip(by).map(|(slope, d)| slope * d).sum::<f64>().abs())
            .fold(0.0, f64::max)
    }
}
