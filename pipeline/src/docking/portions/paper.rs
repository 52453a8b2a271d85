//! The paper's portions: position by Gauss–Newton on cross and circle, then attitude by three regressions.

use contract::docking::{Motion, Pose};
use contract::{OutOfRange, bounds};
use nalgebra::{Matrix2, Matrix3, Matrix6, Vector2, Vector3, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::inverse;
use crate::PipelineError;
use crate::docking::pose::paper_pose::{PaperMeasurement, PaperTarget};

/// Weights and forgetting of the paper's portions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PaperPortionConfig {
    /// Weights w1, w2, w3 of the squared differences of Xc − Xo, Yc − Yo and R, each above 0 to 1e12.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0, "maximum": 1e12 }))]
    pub weights: [f64; 3],
    /// Factor q by which the weight of a portion's position decreases per portion, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub forgetting_position: f64,
    /// Factor q' by which the weight of a portion's attitude decreases per portion, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub forgetting_attitude: f64,
}

impl Default for PaperPortionConfig {
    /// Returns equal weights. The forgetting factors are assumed, because the paper gives none: five
    /// portions, about a second.
    fn default() -> Self {
        Self { weights: [1.0; 3], forgetting_position: 0.8, forgetting_attitude: 0.8 }
    }
}

impl PaperPortionConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "paper_portions")
    }
}

/// Smallest number of fields in a portion that determines a motion: two define a line but leave no residuals
/// to judge it by.
const MIN_FIELDS: usize = 3;

const MAX_STEPS: usize = 30;

/// Step relative to the range below which Gauss–Newton has converged.
const CONVERGED_STEP: f64 = 1e-12;

/// Motion at the end of a portion, with time counted from there, and the normal matrices passed to the next
/// portion.
#[derive(Debug, Clone)]
struct PortionState {
    time_s: f64,
    /// (d1, d2, d3, d1', d2', d3').
    z: Vector6<f64>,
    normal: Matrix6<f64>,
    /// φi and φi' of each axis i.
    v: [Vector2<f64>; 3],
    normal_attitude: Matrix2<f64>,
}

/// Result of stage two: three regressions with one normal matrix.
struct Attitude {
    v: [Vector2<f64>; 3],
    normal: Matrix2<f64>,
    /// Sum of squared residuals of each regression.
    squares: [f64; 3],
}

/// Successive portions by the paper's method.
///
/// σ_n is as printed: Ψ_n/(3 (K_n − K_{n−1}) − 6) also for n > 1, where Ψ_n has six terms of the prior and so
/// 3 (K_n − K_{n−1}) degrees of freedom; for portions of 10 fields it is about 12 % high (√(30/24)). This
/// also applies to the attitude. B_n⁻¹ as the covariance also treats the down-weighted prior as an
/// independent measurement of that weight.
#[derive(Debug, Clone)]
pub struct PaperPortions {
    config: PaperPortionConfig,
    target: PaperTarget,
    last: Option<PortionState>,
}

impl PaperPortions {
    /// Creates the method without any portion.
    ///
    /// # Errors
    /// Those of [`PaperPortionConfig::check`].
    pub fn new(config: PaperPortionConfig, target: PaperTarget) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config, target, last: None })
    }

    /// Ends a portion with its measured fields in order of time: times (s) and measurements. Returns `None`
    /// when the fields do not determine a motion; the previous prior is then kept.
    pub fn end(&mut self, fields: &[(f64, PaperMeasurement)]) -> Option<Motion> {
        let time_s = fields.last()?.0;
        if fields.len() < MIN_FIELDS {
            return None;
        }
        let prior = self.last.as_ref().map(|last| propagated(last, time_s));
        let (z, normal, psi) = self.position(fields, time_s, prior.as_ref())?;
        let Attitude { v, normal: normal_attitude, squares } =
            self.attitude(fields, time_s, &z, prior.as_ref())?;

        let k = fields.len() as f64;
        let variance = psi / (3.0 * k - 6.0);
        let position_covariance = inverse(&normal)? * variance;
        let spread = inverse(&normal_attitude)?;
        let mut attitude_covariance = Matrix6::zeros();
        for (i, square) in squares.into_iter().enumerate() {
            let variance = square / (k - 2.0);
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                attitude_covariance[(i + 3 * a, i + 3 * b)] = spread[(a, b)] * variance;
            }
        }
        self.last = Some(PortionState { time_s, z, normal, v, normal_attitude });
        Some(Motion {
            time_s,
            pose: Pose {
                position_m: z.fixed_rows::<3>(0).into(),
                phi_rad: Vector3::new(v[0].x, v[1].x, v[2].x),
            },
            velocity_m_s: z.fixed_rows::<3>(3).into(),
            phi_rate_rad_s: Vector3::new(v[0].y, v[1].y, v[2].y),
            position_covariance,
            attitude_covariance,
            cross_covariance: Matrix3::zeros(),
            fields: fields.len() as u32,
        })
    }

    /// Stage one: returns z, its normal matrix B and Ψ.
    fn position(
        &self,
        fields: &[(f64, PaperMeasurement)],
        time_s: f64,
        prior: Option<&PortionState>,
    ) -> Option<(Vector6<f64>, Matrix6<f64>, f64)> {
        let mut z = match prior {
            Some(prior) => prior.z,
            None => self.first_guess(fields, time_s)?,
        };
        for _ in 0..MAX_STEPS {
            let (normal, gradient, _) = self.normal_equations(fields, time_s, prior, &z)?;
            let step = inverse(&normal)? * gradient;
            z += step;
            if !(z.iter().all(|value| value.is_finite()) && z[2] > self.target.height_m) {
                return None;
            }
            if step.amax() <= CONVERGED_STEP * z[2] {
                break;
            }
        }
        let (normal, _, psi) = self.normal_equations(fields, time_s, prior, &z)?;
        Some((z, normal, psi))
    }

    /// Returns B, the step's right-hand side and Ψ at z.
    fn normal_equations(
        &self,
        fields: &[(f64, PaperMeasurement)],
        time_s: f64,
        prior: Option<&PortionState>,
        z: &Vector6<f64>,
    ) -> Option<(Matrix6<f64>, Vector6<f64>, f64)> {
        let (mut normal, mut gradient, mut psi) = match prior {
            Some(prior) => {
                let weight = prior.normal * self.config.forgetting_position;
                let off = prior.z - z;
                (weight, weight * off, (off.transpose() * weight * off)[0])
            }
            None => (Matrix6::zeros(), Vector6::zeros(), 0.0),
        };
        for (at_s, measured) in fields {
            let t = at_s - time_s;
            let d = position_at(z, t);
            if d.z <= self.target.height_m {
                return None;
            }
            for (residual, by_d, weight) in self.residuals(measured, &d) {
                // The residual is r(z); ∂r/∂z = (∂r/∂d, t ∂r/∂d).
                let row = Vector6::new(by_d.x, by_d.y, by_d.z, t * by_d.x, t * by_d.y, t * by_d.z);
                normal += row * row.transpose() * weight;
                gradient -= row * (weight * residual);
                psi += weight * residual * residual;
            }
        }
        Some((normal, gradient, psi))
    }

    /// Returns the three terms of A_k, their derivatives with respect to d, and their weights.
    fn residuals(&self, m: &PaperMeasurement, d: &Vector3<f64>) -> [(f64, Vector3<f64>, f64); 3] {
        let (f, b, r) = (m.focal_px, self.target.height_m, self.target.radius_m);
        let [w1, w2, w3] = self.config.weights;
        let product = d.z * (d.z - b);
        let gain = f * b / product;
        let by_d3 = -gain * (2.0 * d.z - b) / product;
        [
            (m.cross[0] - m.circle[0] + gain * d.x, Vector3::new(gain, 0.0, by_d3 * d.x), w1),
            (m.cross[1] - m.circle[1] - gain * d.y, Vector3::new(0.0, -gain, -by_d3 * d.y), w2),
            (m.radius_px - f * r / d.z, Vector3::new(0.0, 0.0, f * r / (d.z * d.z)), w3),
        ]
    }

    /// Returns lines fitted to the positions of the single fields.
    fn first_guess(&self, fields: &[(f64, PaperMeasurement)], time_s: f64) -> Option<Vector6<f64>> {
        let (mut normal, mut sums) = (Matrix2::zeros(), [Vector2::zeros(); 3]);
        for (at_s, measured) in fields {
            let Ok(pose) = measured.pose(&self.target) else { continue };
            let row = Vector2::new(1.0, at_s - time_s);
            normal += row * row.transpose();
            for (sum, d) in sums.iter_mut().zip(pose.position_m.iter()) {
                *sum += row * *d;
            }
        }
        let inverse = inverse(&normal)?;
        let [x, y, z] = sums.map(|sum| inverse * sum);
        Some(Vector6::new(x.x, y.x, z.x, x.y, y.y, z.y))
    }

    /// Stage two: attitude by three regressions.
    fn attitude(
        &self,
        fields: &[(f64, PaperMeasurement)],
        time_s: f64,
        z: &Vector6<f64>,
        prior: Option<&PortionState>,
    ) -> Option<Attitude> {
        let weight = prior
            .map_or_else(Matrix2::zeros, |prior| prior.normal_attitude * self.config.forgetting_attitude);
        let mut normal = weight;
        let mut sums = prior.map_or([Vector2::zeros(); 3], |prior| prior.v.map(|v| weight * v));
        let angles = |at_s: f64, m: &PaperMeasurement| {
            let d = position_at(z, at_s - time_s);
            [m.circle[1] / m.focal_px - d.y / d.z, -m.circle[0] / m.focal_px - d.x / d.z, -m.slope]
        };
        for (at_s, measured) in fields {
            let row = Vector2::new(1.0, at_s - time_s);
            normal += row * row.transpose();
            for (sum, angle) in sums.iter_mut().zip(angles(*at_s, measured)) {
                *sum += row * angle;
            }
        }
        let spread = inverse(&normal)?;
        let v = sums.map(|sum| spread * sum);
        let mut squares = [0.0; 3];
        for (i, square) in squares.iter_mut().enumerate() {
            if let Some(prior) = prior {
                let off = v[i] - prior.v[i];
                *square += (off.transpose() * weight * off)[0];
            }
            for (at_s, measured) in fields {
                let residual = angles(*at_s, measured)[i] - v[i].x - v[i].y * (at_s - time_s);
                *square += residual * residual;
            }
        }
        Some(Attitude { v, normal, squares })
    }
}

/// Returns the same motion and information with time counted from `time_s`: with z' = T z, B' = T⁻ᵀ B T⁻¹.
fn propagated(last: &PortionState, time_s: f64) -> PortionState {
    let t = time_s - last.time_s;
    let mut back = Matrix6::identity();
    for i in 0..3 {
        back[(i, i + 3)] = -t;
    }
    let mut forth = Matrix6::identity();
    for i in 0..3 {
        forth[(i, i + 3)] = t;
    }
    let back_attitude = Matrix2::new(1.0, -t, 0.0, 1.0);
    PortionState {
        time_s,
        z: forth * last.z,
        normal: back.transpose() * last.normal * back,
        v: last.v.map(|v| Vector2::new(v.x + v.y * t, v.y)),
        normal_attitude: back_attitude.transpose() * last.normal_attitude * back_attitude,
    }
}

fn position_at(z: &Vector6<f64>, t: f64) -> Vector3<f64> {
    z.fixed_rows::<3>(0) + z.fixed_rows::<3>(3) * t
}

#[cfg(test)]
mod tests {
    use super::super::tests::{approach, normal};
    use super::*;

    const TARGET: PaperTarget = PaperTarget { radius_m: 0.25, height_m: 0.30 };
    const FOCAL_PX: f64 = 2917.0;

    /// Returns the fields first..last of an approach, by the paper's geometry, with noise of `sigma_px`.
    fn fields(first: u32, last: u32, seed: u64, sigma_px: f64) -> Vec<(f64, PaperMeasurement)> {
        (first..last)
            .map(|k| {
                let t = f64::from(k) * 0.02;
                let mut m = PaperMeasurement::expected(&approach(t), &TARGET, FOCAL_PX);
                let noise = |place: u64| sigma_px * normal(seed * 1_000_003 + u64::from(k) * 16 + place);
                m.cross = [m.cross[0] + noise(0), m.cross[1] + noise(1)];
                m.circle = [m.circle[0] + noise(2), m.circle[1] + noise(3)];
                m.radius_px += noise(4);
                m.slope += noise(5) / 90.0;
                (t, m)
            })
            .collect()
    }

    fn portions(q: f64) -> PaperPortions {
        let config =
            PaperPortionConfig { forgetting_position: q, forgetting_attitude: q, ..Default::default() };
        PaperPortions::new(config, TARGET).unwrap()
    }

    #[test]
    fn without_noise_the_motion_is_found() {
        let mut portions = portions(0.8);
        for n in 0..3 {
            let motion = portions.end(&fields(10 * n, 10 * n + 10, 0, 0.0)).unwrap();
            let truth = approach(motion.time_s);
            assert!((motion.pose.position_m - truth.position_m).norm() < 1e-9, "{motion:?}");
            assert!((motion.pose.phi_rad - truth.phi_rad).norm() < 1e-11);
            assert!((motion.velocity_m_s.z + 0.3).abs() < 1e-8);
            assert!((motion.phi_rate_rad_s.x - 2e-3).abs() < 1e-9);
            assert_eq!(motion.fields, 10);
        }
    }

    #[test]
    fn with_q_1_portions_equal_the_batch() {
        let mut recursive = portions(1.0);
        recursive.end(&fields(0, 10, 1, 0.05)).unwrap();
        recursive.end(&fields(10, 20, 1, 0.05)).unwrap();
        let parts = recursive.end(&fields(20, 30, 1, 0.05)).unwrap();
        let batch = portions(1.0).end(&fields(0, 30, 1, 0.05)).unwrap();
        // Each portion is linearised at its own solution: a noise of 0.05 px changes the second-derivative
        // terms by 1e-4 σ.
        for i in 0..3 {
            let sigma = batch.position_covariance[(i, i)].sqrt();
            assert!((parts.pose.position_m[i] - batch.pose.position_m[i]).abs() < 0.02 * sigma);
        }
        // Pitch and yaw use the position from stage one of the same portion or batch, so they differ; roll is
        // linear.
        assert!((parts.pose.phi_rad.z - batch.pose.phi_rad.z).abs() < 1e-12);
        let rate = parts.velocity_m_s.z - batch.velocity_m_s.z;
        assert!(rate.abs() < 0.02 * batch.position_covariance[(5, 5)].sqrt());
    }

    #[test]
    fn with_q_0_a_portion_forgets_everything() {
        let mut recursive = portions(0.0);
        recursive.end(&fields(0, 10, 2, 0.05)).unwrap();
        let second = recursive.end(&fields(10, 20, 2, 0.05)).unwrap();
        let alone = portions(0.5).end(&fields(10, 20, 2, 0.05)).unwrap();
        assert!((second.pose.position_m - alone.pose.position_m).norm() < 1e-8);
        assert!((second.pose.phi_rad - alone.pose.phi_rad).norm() < 1e-10);
    }

    #[test]
    fn the_first_portions_covariance_is_that_of_its_errors() {
        // Errors of d3 over 300 draws against the stated covariance. The weights of both stages match the
        // noise (Xc − Xo has twice the variance of R).
        let config = PaperPortionConfig { weights: [0.5, 0.5, 1.0], ..Default::default() };
        let (mut sum, n) = (0.0, 300);
        for seed in 0..n {
            let motion =
                PaperPortions::new(config, TARGET).unwrap().end(&fields(0, 10, 10 + seed, 0.05)).unwrap();
            let error = motion.pose.position_m - approach(motion.time_s).position_m;
            sum += error.z * error.z / motion.position_covariance[(2, 2)];
        }
        // σ² is estimated from 24 residuals, so the ratio is F(1, 24) with mean 24/22 and standard error
        // √2.5/√300 = 0.09.
        let mean = sum / n as f64;
        assert!((mean - 24.0 / 22.0).abs() < 0.3, "{mean}");
    }

    #[test]
    fn later_portions_sigma_is_about_12_percent_high_as_printed() {
        // Ψ2 has 30 degrees of freedom with q = 1 and is divided by 24.
        let config =
            PaperPortionConfig { weights: [0.5, 0.5, 1.0], forgetting_position: 1.0, ..Default::default() };
        let (mut sum, n) = (0.0, 400);
        for seed in 0..n {
            let mut portions = PaperPortions::new(config, TARGET).unwrap();
            portions.end(&fields(0, 10, 1000 + seed, 0.05)).unwrap();
            let motion = portions.end(&fields(10, 20, 1000 + seed, 0.05)).unwrap();
            let normal = portions.last.as_ref().unwrap().normal;
            // σ2² = P B in any component.
            sum += motion.position_covariance[(2, 2)] / inverse(&normal).unwrap()[(2, 2)];
        }
        let ratio = (sum / n as f64).sqrt() / 0.05;
        // √(30/24) = 1.118; 400 draws of 30 degrees of freedom: 0.6 %.
        assert!((ratio - 1.118).abs() < 0.03, "{ratio}");
    }

    #[test]
    fn too_few_fields_or_a_single_time_determine_no_motion() {
        assert!(portions(0.8).end(&[]).is_none());
        assert!(portions(0.8).end(&fields(0, 2, 0, 0.0)).is_none());
        let mut same = fields(0, 5, 0, 0.0);
        same.iter_mut().for_each(|field| field.0 = 1.0);
        assert!(portions(0.8).end(&same).is_none());
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let portions = portions(0.8);
        let m = fields(0, 1, 3, 0.5)[0].1;
        let at = Vector3::new(0.4, -0.3, 5.0);
        for i in 0..3 {
            let step = Vector3::ith(i, 1e-6);
            let (plus, minus) = (portions.residuals(&m, &(at + step)), portions.residuals(&m, &(at - step)));
            for k in 0..3 {
                let numeric = (plus[k].0 - minus[k].0) / 2e-6;
                assert!((portions.residuals(&m, &at)[k].1[i] - numeric).abs() < 1e-5, "{k} {i}");
            }
        }
    }
}
