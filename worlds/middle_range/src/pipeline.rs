//! Built-in pipeline: a circle through the lit limb, and the range from its radius.

use contract::{Camera, Frame, OutOfRange, Readout, bounds};
use nalgebra::{Matrix3, Vector3};
use run::plain::PlainPipeline;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rows::Answer;

/// Smallest number of limb points of a fit.
const MIN_POINTS: usize = 8;
/// Distance from outside the body at which a line of pixels has the level of its edge, px.
const DEPTH: isize = 3;
/// Steps of the geometric fit.
const STEPS: usize = 12;
/// Limb points farther from the circle than this many standard deviations are left out.
const OUTLIER_SIGMAS: f64 = 3.0;

/// Parameters of the pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LimbConfig {
    /// Threshold of the limb above the bias, in standard deviations of the read noise, 3 to 1000.
    #[schemars(range(min = 3, max = 1000))]
    pub threshold_sigma: f64,
    /// Systematic error of the limb's place, px, 0.01 to 10: pixels, and the darkness of the limb of a
    /// Lambert sphere.
    #[schemars(range(min = 0.01, max = 10))]
    pub limb_error_px: f64,
}

impl Default for LimbConfig {
    fn default() -> Self {
        Self { threshold_sigma: 8.0, limb_error_px: 0.35 }
    }
}

/// What a pipeline receives before the first frame: the file `middle.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MiddleRangeSetup {
    /// Radius of the body, m.
    pub radius_m: f64,
    /// Conversion of electrons to digital numbers.
    pub readout: Readout,
    /// Geometry of the camera.
    pub camera: Camera,
    /// Parameters of the built-in pipeline.
    #[serde(default)]
    pub middle_range: LimbConfig,
}

/// Fits a circle to the lit limb of a sphere.
pub(crate) struct LimbPipeline {
    setup: MiddleRangeSetup,
    threshold_dn: f64,
}

/// A circle with the covariance of its centre and radius.
struct Circle {
    centre: [f64; 2],
    radius: f64,
    variance_of_radius: f64,
}

impl LimbPipeline {
    pub(crate) fn new(setup: &MiddleRangeSetup) -> Result<Self, OutOfRange> {
        bounds::check(&setup.middle_range, "middle_range")?;
        setup.camera.check().map_err(|error| error.under("camera"))?;
        let Readout { gain_e_per_dn, bias_dn, read_noise_e, .. } = setup.readout;
        let noise_dn = read_noise_e / gain_e_per_dn;
        let threshold_dn = bias_dn + setup.middle_range.threshold_sigma * noise_dn.max(0.5);
        Ok(Self { setup: setup.clone(), threshold_dn })
    }

    /// Returns the points where rows and columns enter and leave the body, on a scale on which its disk is
    /// round: rows are multiplied by [`LimbPipeline::row_scale`].
    fn limb(&self, frame: &Frame) -> Vec<[f64; 2]> {
        let (mut points, scale) = (Vec::new(), self.row_scale());
        for y in 0..frame.rows() {
            let row: Vec<f64> = frame.row(y).iter().map(|dn| f64::from(*dn)).collect();
            points.extend(self.ends(&row).into_iter().flatten().map(|x| [x, y as f64 * scale]));
        }
        for x in 0..frame.columns() {
            let column: Vec<f64> = (0..frame.rows()).map(|y| f64::from(frame.dn_at(x, y))).collect();
            points.extend(self.ends(&column).into_iter().flatten().map(|y| [x as f64, y * scale]));
        }
        points
    }

    /// Returns the ends of the longest run above the threshold in a line of pixels; a run at the border of
    /// the image has no end there.
    fn ends(&self, line: &[f64]) -> [Option<f64>; 2] {
        let mut longest = 0..0;
        let mut start = 0;
        for (i, dn) in line.iter().chain([&f64::NEG_INFINITY]).enumerate() {
            if *dn <= self.threshold_dn {
                if i - start > longest.len() {
                    longest = start..i;
                }
                start = i + 1;
            }
        }
        // A single pixel may be a hot one.
        if longest.len() < 2 {
            return [None, None];
        }
        let first = longest.start.checked_sub(1).and_then(|outside| self.edge(line, outside, 1));
        let last = self.edge(line, longest.end, -1);
        [first, last]
    }

    /// Returns where a line of pixels reaches half the level of the body's edge, from the pixel `outside` in
    /// steps of `step`, between pixels by linear interpolation. The level is that of the pixel [`DEPTH`]
    /// steps inside.
    fn edge(&self, line: &[f64], outside: usize, step: isize) -> Option<f64> {
        let at = |steps: isize| line.get(outside.checked_add_signed(steps * step)?).copied();
        let background_dn = self.setup.readout.bias_dn;
        let half = background_dn + 0.5 * (at(DEPTH)? - background_dn);
        for steps in 0..DEPTH {
            let (low, high) = (at(steps)?, at(steps + 1)?);
            if low < half && half <= high {
                let share = (half - low) / (high - low);
                return Some(outside as f64 + (steps as f64 + share) * step as f64);
            }
        }
        None
    }

    /// Returns the points of the limb that the Sun illuminates: those on the side of the light's centre, seen
    /// from the middle of the points. At full phase, all are.
    fn lit(&self, frame: &Frame, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let n = points.len().max(1) as f64;
        let middle = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / n);
        let mut light = [0.0; 3];
        for y in 0..frame.rows() {
            for (x, dn) in frame.row(y).iter().enumerate() {
                let weight = (f64::from(*dn) - self.threshold_dn).max(0.0);
                let row = y as f64 * self.row_scale();
                light = [light[0] + weight * x as f64, light[1] + weight * row, light[2] + weight];
            }
        }
        let sun = [0, 1].map(|axis| light[axis] / light[2].max(1.0) - middle[axis]);
        let reach =
            points.iter().map(|p| libm::hypot(p[0] - middle[0], p[1] - middle[1])).fold(0.0, f64::max);
        if libm::hypot(sun[0], sun[1]) < 0.03 * reach {
            return points.to_vec();
        }
        let is_lit = |p: &&[f64; 2]| (p[0] - middle[0]) * sun[0] + (p[1] - middle[1]) * sun[1] > 0.0;
        points.iter().filter(is_lit).copied().collect()
    }

    /// Columns per row of the same angle.
    fn row_scale(&self) -> f64 {
        let (across, along) = self.setup.camera.focal_length_px();
        across / along
    }

    /// Range to the centre of the body from the radius of its disk in columns, km: d = R / sin(atan(r / f)).
    fn range_km(&self, radius_px: f64) -> f64 {
        let (across, _) = self.setup.camera.focal_length_px();
        let angle = libm::atan(radius_px / across);
        1e-3 * self.setup.radius_m / libm::sin(angle)
    }
}

impl PlainPipeline<Answer> for LimbPipeline {
    fn process(&mut self, frame: &Frame) -> Answer {
        let peak_dn = frame.dn().iter().max().copied().map_or(0.0, f64::from);
        let none = Answer { centre: None, radius_px: None, range_km: None, sigma_range_km: None, peak_dn };
        let points = self.limb(frame);
        let lit = self.lit(frame, &points);
        let Some(circle) = Circle::fit(&lit) else { return none };
        let longest_px = (frame.columns() + frame.rows()) as f64;
        if !(0.5..longest_px).contains(&circle.radius) {
            return none;
        }
        let range_km = self.range_km(circle.radius);
        let limb_px = self.setup.middle_range.limb_error_px;
        let sigma_px = (circle.variance_of_radius + limb_px * limb_px).sqrt();
        Answer {
            centre: Some([circle.centre[0], circle.centre[1] / self.row_scale()]),
            radius_px: Some(circle.radius),
            range_km: Some(range_km),
            sigma_range_km: Some(range_km * sigma_px / circle.radius),
            ..none
        }
    }
}

impl Circle {
    /// Fits a circle to points: algebraically (Kåsa 1976), then by the least squares of the distances,
    /// without outliers. `None` for too few points, or points on a line.
    fn fit(points: &[[f64; 2]]) -> Option<Self> {
        let mut kept = points.to_vec();
        let mut circle = Self::algebraic(&kept)?;
        for _ in 0..STEPS {
            if kept.len() < MIN_POINTS {
                return None;
            }
            circle = circle.step(&kept)?;
            let rms = circle.rms(&kept).max(0.05);
            kept =
                points.iter().filter(|p| circle.distance(p).abs() < OUTLIER_SIGMAS * rms).copied().collect();
        }
        Some(circle)
    }

    /// Minimises Σ (x² + y² − 2 a x − 2 b y − c)², with c = r² − a² − b².
    fn algebraic(points: &[[f64; 2]]) -> Option<Self> {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for &[x, y] in points {
            let row = Vector3::new(2.0 * x, 2.0 * y, 1.0);
            normal += row * row.transpose();
            right += row * (x * x + y * y);
        }
        let [a, b, c]: [f64; 3] = normal.cholesky()?.solve(&right).into();
        let square = c + a * a + b * b;
        let is_circle = points.len() >= MIN_POINTS && square > 0.0;
        is_circle.then(|| Self { centre: [a, b], radius: square.sqrt(), variance_of_radius: 0.0 })
    }

    /// One step of Gauss and Newton on the distances of the points from the circle.
    fn step(&self, points: &[[f64; 2]]) -> Option<Self> {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for point in points {
            let [dx, dy] = [point[0] - self.centre[0], point[1] - self.centre[1]];
            let length = libm::hypot(dx, dy).max(1e-9);
            let row = Vector3::new(dx / length, dy / length, 1.0);
            normal += row * row.transpose();
            right += row * (length - self.radius);
        }
        let solved = normal.cholesky()?;
        let change = solved.solve(&right);
        let moved = Self {
            centre: [self.centre[0] + change.x, self.centre[1] + change.y],
            radius: self.radius + change.z,
            variance_of_radius: 0.0,
        };
        let variance = moved.rms(points) * moved.rms(points);
        Some(Self { variance_of_radius: variance * solved.inverse()[(2, 2)], ..moved })
    }

    fn distance(&self, point: &[f64; 2]) -> f64 {
        libm::hypot(point[0] - self.centre[0], point[1] - self.centre[1]) - self.radius
    }

    fn rms(&self, points: &[[f64; 2]]) -> f64 {
        let squares: f64 = points.iter().map(|point| self.distance(point) * self.distance(point)).sum();
        (squares / points.len().max(1) as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_through_half_of_its_points_is_found_among_outliers() {
        let mut points: Vec<[f64; 2]> = (0..40)
            .map(|i| {
                let angle = std::f64::consts::PI * f64::from(i) / 40.0;
                [20.0 + 7.0 * libm::cos(angle), 30.0 + 7.0 * libm::sin(angle)]
            })
            .collect();
        points.push([22.0, 33.0]);
        let circle = Circle::fit(&points).unwrap();
        assert!((circle.radius - 7.0).abs() < 1e-6 && (circle.centre[0] - 20.0).abs() < 1e-6);
        assert!(Circle::fit(&points[..4]).is_none());
        let line: Vec<[f64; 2]> = (0..20).map(|i| [f64::from(i), 3.0]).collect();
        assert!(Circle::fit(&line).is_none_or(|circle| circle.radius > 1e3));
    }
}
