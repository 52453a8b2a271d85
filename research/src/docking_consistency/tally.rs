//! Errors compared with the stated covariances.

use boresight::docking::scoring::ApproachParameters;
use boresight::docking::scoring::consistency::{nees, within_3_sigma};
use contract::docking::{Motion, PoseEstimate};
use nalgebra::{Matrix6, Vector3, Vector6};
use sim::truth::approach::ApproachState;

use super::approaches::{Estimator, MeasuredApproach};

/// Parameters of a motion, in the order of [`Errors`].
pub const NAMES: [&str; 16] =
    ["d1", "d2", "d3", "d1'", "d2'", "d3'", "φ1", "φ2", "φ3", "φ1'", "φ2'", "φ3'", "ρ", "u", "α", "β"];

/// Groups of parameters: (d, d'), (φ, φ'), (d, φ).
pub const GROUPS: [&str; 3] = ["position", "attitude", "joint"];

/// First portion that is judged: the portion before it has no prior.
const FIRST_PORTION: u64 = 1;

/// Errors of one motion and its stated standard deviations.
#[derive(Debug, Clone)]
pub struct Errors {
    /// Stated standard deviations.
    pub sigmas: [f64; 16],
    within: [Option<bool>; 16],
    nees: [Option<f64>; 3],
}

impl Errors {
    /// Computes the errors of a motion; `None` where ρ, α or β have no derivatives.
    pub fn from_motion(motion: &Motion, truth: &ApproachState) -> Option<Self> {
        let reported = ApproachParameters::from_motion(&motion.pose, &motion.velocity_m_s);
        let true_values = ApproachParameters::from_motion(&truth.pose, &truth.velocity_m_s);
        let shown: [f64; 7] = reported.difference(&true_values).into();
        let shown_sigmas = ApproachParameters::sigmas(motion)?;
        let d = motion.pose.position_m - truth.pose.position_m;
        let d_rate = motion.velocity_m_s - truth.velocity_m_s;
        let phi = motion.pose.phi_rad - truth.pose.phi_rad;
        let phi_rate = motion.phi_rate_rad_s - truth.phi_rate_rad_s;
        let (position, attitude) = (stacked(&d, &d_rate), stacked(&phi, &phi_rate));
        let (of_position, of_attitude) = (&motion.position_covariance, &motion.attitude_covariance);
        let errors: [f64; 16] = std::array::from_fn(|i| match i {
            0..6 => position[i],
            6..12 => attitude[i - 6],
            _ => shown[i - 12],
        });
        let sigmas: [f64; 16] = std::array::from_fn(|i| match i {
            0..6 => of_position[(i, i)].sqrt(),
            6..12 => of_attitude[(i - 6, i - 6)].sqrt(),
            _ => shown_sigmas[i - 12],
        });
        Some(Self {
            sigmas,
            within: std::array::from_fn(|i| within_3_sigma(errors[i], sigmas[i])),
            nees: [
                nees(&position, of_position),
                nees(&attitude, of_attitude),
                nees(&stacked(&d, &phi), &pose_covariance(motion)),
            ],
        })
    }
}

fn stacked(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Covariance of (d, φ).
fn pose_covariance(motion: &Motion) -> Matrix6<f64> {
    let mut covariance = Matrix6::zeros();
    covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&motion.position_covariance.fixed_view::<3, 3>(0, 0));
    covariance.fixed_view_mut::<3, 3>(3, 3).copy_from(&motion.attitude_covariance.fixed_view::<3, 3>(0, 0));
    covariance.fixed_view_mut::<3, 3>(0, 3).copy_from(&motion.cross_covariance);
    covariance.fixed_view_mut::<3, 3>(3, 0).copy_from(&motion.cross_covariance.transpose());
    covariance
}

/// NEES of a field's pose, divided by 6.
fn field_nees(truth: &ApproachState, estimate: &PoseEstimate) -> Option<f64> {
    let d = estimate.pose.position_m - truth.pose.position_m;
    let phi = estimate.pose.phi_rad - truth.pose.phi_rad;
    nees(&stacked(&d, &phi), &estimate.covariance)
}

/// Mean over approaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Mean value.
    pub value: f64,
    /// Standard error, from the scatter between approaches: portions of one approach are not independent.
    pub error: f64,
}

impl Mean {
    /// Computes the mean from the sum and the count of each approach; `None` if all counts are 0.
    fn from_values(approaches: &[(f64, f64)]) -> Option<Self> {
        let (sum, count) = approaches.iter().fold((0.0, 0.0), |(s, n), (a, b)| (s + a, n + b));
        if count <= 0.0 {
            return None;
        }
        let value = sum / count;
        let scatter: f64 = approaches.iter().map(|(s, n)| (s - n * value) * (s - n * value)).sum();
        Some(Self { value, error: scatter.sqrt() / count })
    }
}

/// Statistics of one estimator over a set of approaches, from the second portion on.
#[derive(Debug, Clone)]
pub struct Tally {
    /// Number of portions.
    pub portions: usize,
    /// Share of errors within 3σ, by parameter.
    pub within: [Option<Mean>; 16],
    /// Share of errors within 3σ, of all parameters together.
    pub within_all: Option<Mean>,
    /// NEES over its dimension, by group.
    pub nees: [Option<Mean>; 3],
    /// NEES over its dimension, of a field's pose.
    pub field_nees: Option<Mean>,
}

impl Tally {
    /// Computes the statistics of one estimator over these approaches.
    pub fn from_approaches(approaches: &[MeasuredApproach], estimator: Estimator) -> Self {
        let errors: Vec<Vec<Errors>> =
            approaches.iter().map(|approaches| errors(approaches, estimator)).collect();
        let mean = |of: &dyn Fn(&Errors) -> Option<f64>| {
            let sums: Vec<(f64, f64)> = errors
                .iter()
                .map(|portions| {
                    portions.iter().filter_map(of).fold((0.0, 0.0), |(s, n), value| (s + value, n + 1.0))
                })
                .collect();
            Mean::from_values(&sums)
        };
        let share = |within: Option<bool>| within.map(|within| f64::from(u8::from(within)));
        let fields: Vec<(f64, f64)> = approaches
            .iter()
            .map(|approaches| {
                let values =
                    approaches.fields.iter().filter_map(|(truth, reported)| field_nees(truth, reported));
                values.fold((0.0, 0.0), |(s, n), value| (s + value, n + 1.0))
            })
            .collect();
        Self {
            portions: errors.iter().map(Vec::len).sum(),
            within: std::array::from_fn(|i| mean(&|e| share(e.within[i]))),
            within_all: mean(&|e| {
                let reported: Vec<f64> = e.within.iter().filter_map(|within| share(*within)).collect();
                (!reported.is_empty()).then(|| reported.iter().sum::<f64>() / reported.len() as f64)
            }),
            nees: std::array::from_fn(|i| mean(&|e| e.nees[i])),
            field_nees: Mean::from_values(&fields),
        }
    }
}

/// Errors of the judged portions of an approach.
pub fn errors(approaches: &MeasuredApproach, estimator: Estimator) -> Vec<Errors> {
    approaches
        .portions
        .iter()
        .filter(|portion| portion.number >= FIRST_PORTION)
        .filter_map(|portion| Errors::from_motion(portion.motion(estimator)?, &portion.truth))
        .collect()
}

/// Longest time between two reports, s.
pub fn longest_interval_s(approaches: &[MeasuredApproach]) -> f64 {
    approaches
        .iter()
        .flat_map(|approaches| &approaches.portions)
        .map(|portion| portion.interval_s)
        .fold(0.0, f64::max)
}
