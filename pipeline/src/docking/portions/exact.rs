//! Portions of poses: position and attitude together, with the covariance that forgetting leaves.

use contract::docking::{Motion, PoseEstimate};
use contract::{OutOfRange, bounds};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::inverse;
use crate::PipelineError;
use crate::docking::pose::geometry::{to_pose, to_vector};

/// (d, φ, d', φ').
type State = SVector<f64, 12>;
type Square = SMatrix<f64, 12, 12>;

/// Forgetting and gates of the portions of poses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExactPortionConfig {
    /// What is left of the weight of a portion one portion later, 0 to 1: near 1 gives small standard deviations on a
    /// straight glide, smaller values follow oscillations.
    #[schemars(range(min = 0, max = 1))]
    pub forgetting: f64,
    /// A field is left out when its pose is off the motion by more than this normalised square (chi-square of 6 degrees of
    /// freedom), above 0 to 1e12; where the portion's fields scatter more than they say, by as much more.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub field_gate: f64,
    /// The prior is dropped, and the motion begins anew, when it is off the portion's own motion by more than this normalised
    /// square (chi-square of 12 degrees of freedom), above 0 to 1e12: a manoeuvre, not noise.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub prior_gate: f64,
}

impl Default for ExactPortionConfig {
    /// Five portions of memory; gates that noise passes once in 10⁷ fields and 10⁷ portions.
    fn default() -> Self {
        Self { forgetting: 0.8, field_gate: 45.0, prior_gate: 58.0 }
    }
}

impl ExactPortionConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first one outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "portions")
    }
}

/// Fields below which a portion says nothing.
const LEAST_FIELDS: usize = 3;

/// Median of a chi-square of 6 degrees of freedom.
const MEDIAN_CHI_SQUARE_6: f64 = 5.348;

/// What a portion leaves to the next, time counted from its end.
///
/// With measurements of covariance S_i, a portion minimises (z − z⁻)ᵀ q B⁻ (z − z⁻) + Σ |m_i − H_i z|² in the metric of
/// S_i⁻¹, so B = q B⁻ + Σ Hᵀ S⁻¹ H. B is a weight, not an information: the prior counts for q, its covariance is what it
/// was. The gradient's covariance is M = q² M⁻ + Σ Hᵀ S⁻¹ H, and that of z is B⁻¹ M B⁻¹. With q = 1, M = B.
#[derive(Debug, Clone)]
struct Ended {
    time_s: f64,
    z: State,
    weight: Square,
    gradient_covariance: Square,
}

/// Linear motions of portions of poses, one after the other.
#[derive(Debug, Clone)]
pub struct ExactPortions {
    config: ExactPortionConfig,
    last: Option<Ended>,
}

/// A field of a portion.
struct Observation {
    t: f64,
    pose: Vector6<f64>,
    covariance: Matrix6<f64>,
    information: Matrix6<f64>,
}

/// Sums over the fields of a portion: Σ Hᵀ S⁻¹ H and Σ Hᵀ S⁻¹ m.
struct Sums {
    normal: Square,
    right: State,
}

impl ExactPortions {
    /// No portion yet.
    ///
    /// # Errors
    /// Those of [`ExactPortionConfig::check`].
    pub fn new(config: ExactPortionConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self { config, last: None })
    }

    /// Ends a portion with the poses that were measured in it, in order: their times (s) and estimates. `None` when they do
    /// not determine a motion; what was known before then stays the prior.
    pub fn end(&mut self, fields: &[(f64, PoseEstimate)]) -> Option<Motion> {
        let time_s = fields.last()?.0;
        let mut observations: Vec<Observation> = fields
            .iter()
            .filter_map(|(at_s, estimate)| {
                Some(Observation {
                    t: at_s - time_s,
                    pose: to_vector(&estimate.pose),
                    covariance: estimate.covariance,
                    information: inverse(&estimate.covariance)?,
                })
            })
            .collect();
        let least = LEAST_FIELDS.max(observations.len().div_ceil(2));
        loop {
            if observations.len() < least {
                return None;
            }
            match self.worst(&observations)? {
                Some(index) => drop(observations.remove(index)),
                None => break,
            }
        }
        let sums = Sums::over(&observations);
        let own_covariance = inverse(&sums.normal)?;
        let own = own_covariance * sums.right;
        let prior = self.last.as_ref().map(|last| carried(last, time_s));
        let prior = prior.filter(|prior| self.agrees(prior, &own, &own_covariance));

        let q = self.config.forgetting;
        let ended = match prior {
            Some(prior) => {
                let weight = prior.weight * q + sums.normal;
                let right = prior.weight * prior.z * q + sums.right;
                Ended {
                    time_s,
                    z: inverse(&weight)? * right,
                    weight,
                    gradient_covariance: prior.gradient_covariance * (q * q) + sums.normal,
                }
            }
            None => Ended { time_s, z: own, weight: sums.normal, gradient_covariance: sums.normal },
        };
        let motion = ended.motion(observations.len() as u32)?;
        self.last = Some(ended);
        Some(motion)
    }

    /// The field that is farthest off the motion through the others, if beyond the gate; the outer `None` when they do not
    /// determine one.
    fn worst(&self, observations: &[Observation]) -> Option<Option<usize>> {
        let sums = Sums::over(observations);
        let covariance = inverse(&sums.normal)?;
        let z = covariance * sums.right;
        let squares: Vec<f64> = observations
            .iter()
            .map(|field| {
                let residual = field.pose - at(&z, field.t);
                // Of a residual of the fit itself: S − H P Hᵀ.
                let own = field.covariance - covariance_at(&covariance, field.t);
                match inverse(&own) {
                    Some(inverse) => (residual.transpose() * inverse * residual)[0],
                    None => (residual.transpose() * field.information * residual)[0],
                }
            })
            .collect();
        let mut sorted = squares.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted.get(sorted.len() / 2)? / MEDIAN_CHI_SQUARE_6;
        let gate = self.config.field_gate * usual.max(1.0);
        let worst = squares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        Some(worst.filter(|(_, square)| **square > gate).map(|(index, _)| index))
    }

    /// Whether the prior and the portion's own motion are two measurements of one thing.
    fn agrees(&self, prior: &Ended, own: &State, own_covariance: &Square) -> bool {
        let Some(covariance) = prior.covariance() else { return false };
        let off = own - prior.z;
        inverse(&(covariance + own_covariance))
            .is_some_and(|inverse| (off.transpose() * inverse * off)[0] <= self.config.prior_gate)
    }
}

impl Sums {
    fn over(observations: &[Observation]) -> Self {
        let (mut normal, mut right) = (Square::zeros(), State::zeros());
        for Observation { t, pose, information, .. } in observations {
            let weighted = information * pose;
            for (i, a) in [(0, 1.0), (6, *t)] {
                let mut rows = right.fixed_rows_mut::<6>(i);
                rows += weighted * a;
                for (j, b) in [(0, 1.0), (6, *t)] {
                    let mut block = normal.fixed_view_mut::<6, 6>(i, j);
                    block += information * (a * b);
                }
            }
        }
        Self { normal, right }
    }
}

impl Ended {
    /// B⁻¹ M B⁻¹.
    fn covariance(&self) -> Option<Square> {
        let inverse = inverse(&self.weight)?;
        let covariance = inverse * self.gradient_covariance * inverse;
        Some((covariance + covariance.transpose()) * 0.5)
    }

    fn motion(&self, fields: u32) -> Option<Motion> {
        let covariance = self.covariance()?;
        let pick = |first: usize| {
            let place = |i: usize| if i < 3 { first + i } else { first + i + 3 };
            Matrix6::from_fn(|i, j| covariance[(place(i), place(j))])
        };
        Some(Motion {
            time_s: self.time_s,
            pose: to_pose(&self.z),
            velocity_m_s: self.z.fixed_rows::<3>(6).into(),
            phi_rate_rad_s: self.z.fixed_rows::<3>(9).into(),
            position_covariance: pick(0),
            attitude_covariance: pick(3),
            cross_covariance: covariance.fixed_view::<3, 3>(0, 3).into(),
            fields,
        })
    }
}

/// The same motion and the same weights, time counted from `time_s`.
fn carried(last: &Ended, time_s: f64) -> Ended {
    let t = time_s - last.time_s;
    let (mut forth, mut back) = (Square::identity(), Square::identity());
    for i in 0..6 {
        forth[(i, i + 6)] = t;
        back[(i, i + 6)] = -t;
    }
    Ended {
        time_s,
        z: forth * last.z,
        weight: back.transpose() * last.weight * back,
        gradient_covariance: back.transpose() * last.gradient_covariance * back,
    }
}

fn at(z: &State, t: f64) -> Vector6<f64> {
    z.fixed_rows::<6>(0) + z.fixed_rows::<6>(6) * t
}

fn covariance_at(covariance: &Square, t: f64) -> Matrix6<f64> {
    covariance.fixed_view::<6, 6>(0, 0)
        + (covariance.fixed_view::<6, 6>(0, 6) + covariance.fixed_view::<6, 6>(6, 0)) * t
        + covariance.fixed_view::<6, 6>(6, 6) * (t * t)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{approach, normal};
    use super::*;
    use nalgebra::Cholesky;

    /// Covariance of a field: metres beside radians, and lateral position with attitude as strongly correlated as they are.
    fn field_covariance() -> Matrix6<f64> {
        let mut shape = Matrix6::identity();
        shape[(0, 4)] = 0.98;
        shape[(4, 0)] = 0.98;
        shape[(1, 3)] = -0.98;
        shape[(3, 1)] = -0.98;
        let sigma = Vector6::new(4e-3, 4e-3, 2e-3, 8e-4, 8e-4, 1e-4);
        Matrix6::from_fn(|i, j| shape[(i, j)] * sigma[i] * sigma[j])
    }

    fn fields(first: u32, last: u32, seed: u64, noise: f64) -> Vec<(f64, PoseEstimate)> {
        let covariance = field_covariance() * (noise * noise);
        let root = Cholesky::new(field_covariance()).unwrap().l() * noise;
        (first..last)
            .map(|k| {
                let t = f64::from(k) * 0.02;
                let draw = Vector6::from_fn(|i, _| normal(seed * 1_000_003 + u64::from(k) * 16 + i as u64));
                let pose = to_pose(&(to_vector(&approach(t)) + root * draw));
                (t, PoseEstimate { pose, covariance })
            })
            .collect()
    }

    fn portions(forgetting: f64) -> ExactPortions {
        ExactPortions::new(ExactPortionConfig { forgetting, ..Default::default() }).unwrap()
    }

    /// NEES of all twelve parameters.
    fn nees(motion: &Motion, portions: &ExactPortions) -> f64 {
        let truth = |t: f64| to_vector(&approach(t));
        let (now, rate) = (truth(motion.time_s), (truth(1.0) - truth(0.0)));
        let ended = portions.last.as_ref().unwrap();
        let error = State::from_fn(|i, _| ended.z[i] - if i < 6 { now[i] } else { rate[i - 6] });
        (error.transpose() * inverse(&ended.covariance().unwrap()).unwrap() * error)[0]
    }

    #[test]
    fn errors_are_as_large_as_sigma_says_whatever_is_forgotten() {
        // 250 approaches, the fifth portion: mean NEES/12 has a standard error of √(2/12/250) = 0.026.
        for q in [0.5, 0.8, 1.0] {
            let n = 250;
            let mean = (0..n)
                .map(|seed| {
                    let mut portions = portions(q);
                    let mut last = None;
                    for portion in 0..5 {
                        last = portions.end(&fields(10 * portion, 10 * portion + 10, seed, 1.0));
                    }
                    nees(&last.unwrap(), &portions) / 12.0
                })
                .sum::<f64>()
                / n as f64;
            assert!((0.9..=1.1).contains(&mean), "q = {q}: {mean}");
        }
    }

    #[test]
    fn the_inverse_of_the_weight_would_not_be_the_covariance() {
        let mut portions = portions(0.8);
        for portion in 0..20 {
            portions.end(&fields(10 * portion, 10 * portion + 10, 1, 1.0)).unwrap();
        }
        let ended = portions.last.as_ref().unwrap();
        // Measurements of d3 alone would approach (1 − q)/(1 − q²) = 0.56 of B⁻¹; rates change it a little.
        let ratio = ended.covariance().unwrap()[(2, 2)] / inverse(&ended.weight).unwrap()[(2, 2)];
        assert!((0.4..0.8).contains(&ratio), "{ratio}");
    }

    #[test]
    fn with_q_1_portions_equal_the_batch() {
        let all = ExactPortionConfig { forgetting: 1.0, ..Default::default() };
        let mut recursive = ExactPortions::new(all).unwrap();
        recursive.end(&fields(0, 10, 2, 1.0)).unwrap();
        recursive.end(&fields(10, 20, 2, 1.0)).unwrap();
        let parts = recursive.end(&fields(20, 30, 2, 1.0)).unwrap();
        let batch = ExactPortions::new(all).unwrap().end(&fields(0, 30, 2, 1.0)).unwrap();
        // Both are the same linear least squares: rounding alone, in matrices of condition 1e6.
        assert!((parts.pose.position_m - batch.pose.position_m).norm() < 1e-9);
        assert!((parts.velocity_m_s - batch.velocity_m_s).norm() < 1e-8);
        let relative = (parts.position_covariance - batch.position_covariance).abs().max()
            / batch.position_covariance.abs().max();
        assert!(relative < 1e-6, "{relative}");
    }

    #[test]
    fn doubled_noise_doubles_sigma() {
        let run = |noise: f64| {
            let mut portions = portions(0.8);
            portions.end(&fields(0, 10, 3, noise)).unwrap();
            portions.end(&fields(10, 20, 3, noise)).unwrap()
        };
        let (once, twice) = (run(1.0), run(2.0));
        let ratio = twice.attitude_covariance.component_div(&once.attitude_covariance);
        assert!((ratio[(0, 0)] - 4.0).abs() < 1e-6 && (ratio[(5, 5)] - 4.0).abs() < 1e-6);
    }

    #[test]
    fn a_wrong_field_is_left_out() {
        let mut wrong = fields(0, 10, 4, 1.0);
        wrong[4].1.pose.position_m.z += 0.5;
        let motion = portions(0.8).end(&wrong).unwrap();
        assert_eq!(motion.fields, 9);
        assert!((motion.pose.position_m.z - approach(motion.time_s).position_m.z).abs() < 0.01);
    }

    #[test]
    fn a_manoeuvre_begins_the_motion_anew() {
        let mut portions = portions(0.8);
        for portion in 0..5 {
            portions.end(&fields(10 * portion, 10 * portion + 10, 5, 1.0)).unwrap();
        }
        // Ten times the portion's own σ of the velocity.
        let mut pushed = fields(50, 60, 5, 1.0);
        for (t, estimate) in &mut pushed {
            estimate.pose.position_m.z += 0.3 * (*t - 1.0);
        }
        let motion = portions.end(&pushed).unwrap();
        let alone = ExactPortions::new(ExactPortionConfig::default()).unwrap().end(&pushed).unwrap();
        assert_eq!(motion, alone);
    }

    #[test]
    fn too_few_fields_or_one_moment_say_nothing() {
        assert!(portions(0.8).end(&[]).is_none());
        assert!(portions(0.8).end(&fields(0, 2, 0, 1.0)).is_none());
        let mut same = fields(0, 5, 0, 1.0);
        same.iter_mut().for_each(|field| field.0 = 1.0);
        assert!(portions(0.8).end(&same).is_none());
    }
}
