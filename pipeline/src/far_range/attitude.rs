//! Camera attitude from stars, and the filtered mounting (section 2.4, Eqs. 14 to 16).

use contract::{Body, CameraFrame, Direction, Icrs, Rotation};
use nalgebra::{Matrix3, Matrix4, Quaternion, SymmetricEigen, UnitQuaternion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the calibration of the camera's mounting with stars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AttitudeConfig {
    /// Smallest number of identified stars for a solution (n_min), 2 to 1000000; 10 in the paper.
    #[schemars(range(min = 2, max = 1000000))]
    pub min_stars: u32,
    /// Weight λ of the old estimate in Eq. 16, 0 to below 1. Values near 1 average over about 1/(1 − λ)
    /// solutions; 0 uses each solution unfiltered. (The paper's text contradicts its equation.)
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1))]
    pub filter_lambda: f64,
}

impl Default for AttitudeConfig {
    fn default() -> Self {
        Self { min_stars: 10, filter_lambda: 0.9 }
    }
}

/// Star direction in the camera and in the list, with its weight ω, above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StarPair {
    pub(super) camera: Direction<CameraFrame>,
    pub(super) icrs: Direction<Icrs>,
    pub(super) weight: f64,
}

/// Smallest gap between the two largest eigenvalues, per unit of weight. Below it, all directions coincide
/// and the rotation about them is undetermined. Stars one pixel apart (4e-4 rad) give about 1e-7.
const MIN_EIGENVALUE_GAP: f64 = 1e-10;

/// Returns the rotation A that minimises J(A) = Σ ω ‖r_cam − A r_icrs‖² (Eq. 14), by Davenport's q-method;
/// `None` when the stars do not determine it.
///
/// Σ ω r_cam · (q r_icrs q*) is the quadratic form qᵀ K q; on unit quaternions, it is largest at the
/// eigenvector of K's largest eigenvalue.
pub(super) fn solve_q_method(stars: &[StarPair]) -> Option<Rotation<CameraFrame, Icrs>> {
    let b: Matrix3<f64> =
        stars.iter().map(|star| star.camera.vector() * star.weight * star.icrs.vector().transpose()).sum();
    // z = Σ ω r_icrs × r_cam.
    let z = [b[(2, 1)] - b[(1, 2)], b[(0, 2)] - b[(2, 0)], b[(1, 0)] - b[(0, 1)]];
    let trace = b.trace();
    // Scalar first.
    let k = Matrix4::from_fn(|row, column| match (row, column) {
        (0, 0) => trace,
        (0, i) | (i, 0) => z[i - 1],
        (i, j) => b[(i - 1, j - 1)] + b[(j - 1, i - 1)] - if i == j { trace } else { 0.0 },
    });
    // The limit on the sweeps prevents an endless loop if a direction is NaN.
    let eigen = SymmetricEigen::try_new(k, f64::EPSILON, 1000)?;
    let mut order = [0, 1, 2, 3];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let gap = eigen.eigenvalues[order[0]] - eigen.eigenvalues[order[1]];
    if gap.is_nan() || gap <= MIN_EIGENVALUE_GAP * stars.iter().map(|star| star.weight).sum::<f64>() {
        return None;
    }
    let q = eigen.eigenvectors.column(order[0]);
    Some(Rotation::from_unit_quaternion(UnitQuaternion::new_normalize(Quaternion::new(
        q[0], q[1], q[2], q[3],
    ))))
}

/// Estimate of the camera's mounting: nominal until the first solution, filtered afterwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct MountingFilter {
    camera_from_body: Rotation<CameraFrame, Body>,
    lambda: f64,
    has_solution: bool,
}

impl MountingFilter {
    pub(super) fn new(nominal: Rotation<CameraFrame, Body>, lambda: f64) -> Self {
        Self { camera_from_body: nominal, lambda, has_solution: false }
    }

    /// Returns the current estimate.
    pub(super) fn camera_from_body(&self) -> Rotation<CameraFrame, Body> {
        self.camera_from_body
    }

    /// Updates the estimate with a camera attitude solved from stars: Eq. 15, then Eq. 16.
    ///
    /// The first solution replaces the nominal mounting, because filtering would keep the error of the ground
    /// calibration for 1/(1 − λ) solutions.
    pub(super) fn update(
        &mut self,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        body_from_icrs: Rotation<Body, Icrs>,
    ) {
        let new = camera_from_icrs * body_from_icrs.inverse();
        self.camera_from_body = if self.has_solution {
            mix(self.camera_from_body, new, self.lambda)
        } else {
            self.has_solution = true;
            new
        };
    }
}

/// Computes Eq. 16: λ q + (1 − λ) q_new, normalised. A quaternion and its negative are the same rotation, so
/// the new one is first given the sign of the old one.
fn mix(
    old: Rotation<CameraFrame, Body>,
    new: Rotation<CameraFrame, Body>,
    lambda: f64,
) -> Rotation<CameraFrame, Body> {
    let (q, q_new) = (old.quaternion().quaternion(), new.quaternion().quaternion());
    let sign = if q.dot(q_new) < 0.0 { -1.0 } else { 1.0 };
    Rotation::from_unit_quaternion(UnitQuaternion::new_normalize(
        q * lambda + q_new * (sign * (1.0 - lambda)),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn direction<F>(x: f64, y: f64, z: f64) -> Direction<F> {
        Direction::from_vector(Vector3::new(x, y, z)).unwrap()
    }

    fn pairs(attitude: Rotation<CameraFrame, Icrs>, seen: &[[f64; 2]]) -> Vec<StarPair> {
        seen.iter()
            .map(|&[x, y]| {
                let camera: Direction<CameraFrame> = direction(x, y, 1.0);
                StarPair { camera, icrs: attitude.inverse() * camera, weight: 1.0 }
            })
            .collect()
    }

    #[test]
    fn numbers_out_of_range_are_refused_by_name() {
        let good = AttitudeConfig::default();
        assert!(contract::bounds::check(&good, "attitude").is_ok());
        for (field, bad) in [
            ("min_stars", AttitudeConfig { min_stars: 1, ..good.clone() }),
            ("filter_lambda", AttitudeConfig { filter_lambda: 1.0, ..good.clone() }),
            ("filter_lambda", AttitudeConfig { filter_lambda: -0.1, ..good.clone() }),
        ] {
            assert!(
                contract::bounds::check(&bad, "attitude").unwrap_err().to_string().contains(field),
                "{field}"
            );
        }
    }

    fn unit_quaternion() -> impl Strategy<Value = [f64; 4]> {
        proptest::array::uniform4(-1.0..1.0f64)
            .prop_filter("not near zero", |q| q.iter().map(|v| v * v).sum::<f64>() > 0.01)
            .prop_map(|q| {
                let norm = q.iter().map(|v| v * v).sum::<f64>().sqrt();
                q.map(|v| v / norm)
            })
    }

    proptest! {
        #[test]
        fn the_q_method_recovers_a_rotation(
            q in unit_quaternion(),
            seen in proptest::collection::vec(proptest::array::uniform2(-0.16..0.16f64), 8..20),
        ) {
            // Field of view of the paper's camera: ±9°.
            let attitude = Rotation::from_wxyz(q).unwrap();
            let got = solve_q_method(&pairs(attitude, &seen)).unwrap();
            // Rounding (2e-16) over the relative gap of eigenvalues of such a field (about 1e-2).
            prop_assert!(got.angle_to(&attitude).radians() < 1e-12, "{}", got.angle_to(&attitude).radians());
        }
    }

    #[test]
    fn noise_is_averaged_in_the_least_squares_sense() {
        // Opposite errors of opposite stars are a roll, equal errors a tilt; the tilt is the mean of the
        // errors.
        let truth = Rotation::identity();
        let mut stars = pairs(truth, &[[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1], [0.0, -0.1]]);
        for star in &mut stars {
            let v = *star.camera.vector();
            star.camera = direction(v.x + 1e-4, v.y, v.z);
        }
        let got = solve_q_method(&stars).unwrap();
        // A tilt about +y moves z towards x.
        let tilt = got.rotate(&Vector3::z()).x;
        assert!((tilt - 1e-4).abs() < 3e-6, "{tilt}");
    }

    #[test]
    fn a_star_counts_as_much_as_its_weight() {
        // Four stars, two of them off: the tilt is the weighted mean.
        let mut stars = pairs(Rotation::identity(), &[[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1], [0.0, -0.1]]);
        for (star, weight) in stars.iter_mut().zip([3.0, 3.0, 1.0, 1.0]) {
            star.weight = weight;
        }
        // The pair with large weight agrees on a tilt of 1e-4 towards x, the pair with small weight on zero.
        for star in &mut stars[..2] {
            let v = *star.camera.vector();
            star.camera = direction(v.x + 1e-4, v.y, v.z);
        }
        let tilt = solve_q_method(&stars).unwrap().rotate(&Vector3::z()).x;
        // Weighted mean 0.75e-4; the curvature of the field (1 %) is neglected.
        assert!((tilt - 0.75e-4).abs() < 2e-6, "{tilt}");
    }

    #[test]
    fn one_direction_determines_no_attitude() {
        assert_eq!(solve_q_method(&[]), None);
        assert_eq!(solve_q_method(&pairs(Rotation::identity(), &[[0.1, 0.0]])), None);
        assert_eq!(solve_q_method(&pairs(Rotation::identity(), &[[0.1, 0.0]; 5])), None);
    }

    fn mounting(x: f64) -> Rotation<CameraFrame, Body> {
        Rotation::from_rotation_vector(Vector3::new(x, 0.0, 0.0))
    }

    #[test]
    fn eq_15_takes_the_body_out() {
        let body_from_icrs = Rotation::from_rotation_vector(Vector3::new(0.4, 0.5, -0.6));
        let mut filter = MountingFilter::new(mounting(0.0), 0.9);
        filter.update(mounting(0.3) * body_from_icrs, body_from_icrs);
        assert!(filter.camera_from_body().angle_to(&mounting(0.3)).radians() < 1e-15);
    }

    #[test]
    fn eq_16_keeps_lambda_of_the_old_estimate() {
        let identity: Rotation<Body, Icrs> = Rotation::identity();
        let mut filter = MountingFilter::new(mounting(0.5), 0.75);
        filter.update(mounting(0.0) * identity, identity);
        filter.update(mounting(0.004) * identity, identity);
        // For small angles the mean of quaternions is the mean of angles.
        assert!((filter.camera_from_body().angle_to(&mounting(0.0)).radians() - 0.001).abs() < 1e-8);
    }

    #[test]
    fn a_quaternion_and_its_negative_are_averaged_alike() {
        let new = mounting(0.2);
        let [w, x, y, z] = new.wxyz();
        let opposite = Rotation::from_wxyz([-w, -x, -y, -z]).unwrap();
        assert_eq!(mix(mounting(0.1), new, 0.5), mix(mounting(0.1), opposite, 0.5));
    }
}
