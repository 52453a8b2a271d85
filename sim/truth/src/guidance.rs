//! Intended pointing of the camera.
//!
//! Camera axes: z along the boresight, x along increasing column, y along increasing row.

use contract::{Angle, CameraFrame, Direction, Icrs, Rotation};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::states::States;

/// Guidance mode of the chaser's attitude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum Guidance {
    /// Fixed direction in the sky. At roll 0 north is up in the image (−y) and east is to the left (−x).
    Inertial {
        /// Right ascension of the boresight, degrees, −360 to 360.
        #[schemars(range(min = -360, max = 360))]
        ra_deg: f64,
        /// Declination of the boresight, degrees, −90 to 90.
        #[schemars(range(min = -90, max = 90))]
        dec_deg: f64,
        /// Rotation of the camera about its boresight from x towards y, degrees, −360 to 360.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        roll_deg: f64,
    },
    /// Fixed in the chaser's local orbital frame: boresight along T (the velocity on a circular orbit),
    /// columns along R (x = R: the zenith is to the right), rows opposite to the orbit normal (y = −N). Stars
    /// drift along +x at the orbital rate. The offsets then rotate the camera from these axes.
    LocalOrbital {
        /// Offset φ, degrees, −180 to 180: Euler angles 123 from these axes to the camera.
        #[serde(default)]
        #[schemars(range(min = -180, max = 180))]
        phi_deg: f64,
        /// Offset θ, degrees, −180 to 180.
        #[serde(default)]
        #[schemars(range(min = -180, max = 180))]
        theta_deg: f64,
        /// Offset ψ, degrees, −180 to 180.
        #[serde(default)]
        #[schemars(range(min = -180, max = 180))]
        psi_deg: f64,
    },
    /// Attitude of the body from an attitude ephemeris message (CCSDS 504.0-B, KVN or XML), interpolated as
    /// it states; the errors of `control` are added.
    Aem {
        /// File of the chaser's attitude, relative to the scenario.
        file: String,
    },
    /// Boresight towards the target; y as close as possible to −N (opposite to the orbit normal).
    TargetPointing {},
}

impl Guidance {
    /// Returns the camera attitude that guidance commands; ICRS axes for [`Guidance::Aem`], whose attitude is
    /// not a function of the states.
    pub fn camera_from_icrs(&self, states: &States) -> Rotation<CameraFrame, Icrs> {
        match *self {
            Self::Aem { .. } => Rotation::identity(),
            Self::Inertial { ra_deg, dec_deg, roll_deg } => {
                let ra = Angle::from_degrees(ra_deg);
                let z = *Direction::from_ra_dec(ra, Angle::from_degrees(dec_deg)).vector();
                // East at the boresight; also defined at the poles, where it depends only on the right
                // ascension.
                let east = Vector3::new(-libm::sin(ra.radians()), libm::cos(ra.radians()), 0.0);
                let unrolled: Rotation<CameraFrame, Icrs> = Rotation::from_axes(&-east, &east.cross(&z), &z);
                let roll = Rotation::<CameraFrame, CameraFrame>::from_euler_123(
                    Angle::ZERO,
                    Angle::ZERO,
                    Angle::from_degrees(roll_deg),
                );
                roll * unrolled
            }
            Self::LocalOrbital { phi_deg, theta_deg, psi_deg } => {
                let (radial, transverse, normal) = local_axes(states);
                let aligned: Rotation<CameraFrame, Icrs> =
                    Rotation::from_axes(&radial, &-normal, &transverse);
                let offset = Rotation::<CameraFrame, CameraFrame>::from_euler_123(
                    Angle::from_degrees(phi_deg),
                    Angle::from_degrees(theta_deg),
                    Angle::from_degrees(psi_deg),
                );
                offset * aligned
            }
            Self::TargetPointing {} => {
                let (radial, transverse, normal) = local_axes(states);
                // A target at the position of the chaser, or exactly along the orbit normal, defines no
                // attitude; another axis is then used.
                let z = states.line_of_sight_km().try_normalize(1e-9).unwrap_or(transverse);
                let x = z.cross(&normal).try_normalize(1e-9).unwrap_or(radial);
                // With x = y × z and y close to −N, x lies along z × N.
                Rotation::from_axes(&x, &z.cross(&x), &z)
            }
        }
    }
}

/// Radial, transverse and normal axes of the chaser's orbit, ICRS.
fn local_axes(states: &States) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
    let radial = states.chaser.position_km.normalize();
    let normal = states.chaser.position_km.cross(&states.chaser.velocity_km_s).normalize();
    (radial, normal.cross(&radial), normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::Elements;
    use crate::relative::RelativeElements;

    fn states(time_s: f64, relative: RelativeElements) -> States {
        let target = Elements {
            semi_major_axis_km: 7130.0,
            eccentricity: 0.0,
            inclination_rad: 1.7153,
            raan_rad: 2.0,
            argument_of_perigee_rad: 0.0,
            mean_anomaly_rad: 0.4,
        };
        let chaser = relative.chaser(&target);
        States { time_s, chaser: chaser.propagate(time_s).state(), target: target.propagate(time_s).state() }
    }

    fn behind() -> RelativeElements {
        RelativeElements { a_dlambda_m: -10_000.0, ..Default::default() }
    }

    const LOCAL: Guidance = Guidance::LocalOrbital { phi_deg: 0.0, theta_deg: 0.0, psi_deg: 0.0 };

    #[test]
    fn a_target_ahead_is_on_the_boresight_of_the_local_orbital_frame() {
        let states = states(0.0, behind());
        let line_of_sight = LOCAL.camera_from_icrs(&states).rotate(&states.line_of_sight_km());
        assert!(line_of_sight.z > 9.99);
        // The chord of 10 km dips below T by half the arc: 10/(2·7130) rad.
        let expected_x = -10.0 / (2.0 * 7130.0);
        assert!((line_of_sight.x / line_of_sight.z - expected_x).abs() < 1e-7);
        assert!((line_of_sight.y / line_of_sight.z).abs() < 1e-12);
    }

    #[test]
    fn a_target_above_is_to_the_right_and_one_along_the_normal_is_up() {
        // A chaser 300 m lower sees the target higher; then the chaser lies below along N (u = 0.4 rad, θ =
        // 0.4 + 90°: N < 0).
        let lower = RelativeElements { a_da_m: -300.0, ..behind() };
        let (sin, cos) = libm::sincos(0.4 + std::f64::consts::FRAC_PI_2);
        let below = RelativeElements { a_dix_m: 300.0 * cos, a_diy_m: 300.0 * sin, ..behind() };
        let seen = |relative| {
            let states = states(0.0, relative);
            LOCAL.camera_from_icrs(&states).rotate(&states.line_of_sight_km())
        };
        assert!(seen(lower).x > 0.25);
        assert!(seen(below).y < -0.25);
    }

    #[test]
    fn stars_drift_along_the_columns_at_the_orbital_rate() {
        let (t, dt) = (500.0, 1.0);
        let now = LOCAL.camera_from_icrs(&states(t, behind()));
        let star = now.inverse() * Direction::z();
        let later = LOCAL.camera_from_icrs(&states(t + dt, behind())) * star;
        // n = 1.04862e-3 rad/s for 7130 km; the oblateness changes the rate of u by a relative 1e-3.
        assert!((later.vector().x / 1.04862e-3 - 1.0).abs() < 2e-3, "{later:?}");
        assert!(later.vector().y.abs() < 1e-6);
    }

    #[test]
    fn target_pointing_puts_the_target_on_the_boresight_and_the_normal_up() {
        let relative = RelativeElements { a_dey_m: 400.0, a_diy_m: 400.0, ..behind() };
        let states = states(1234.0, relative);
        let camera_from_icrs = Guidance::TargetPointing {}.camera_from_icrs(&states);
        let line_of_sight = camera_from_icrs.rotate(&states.line_of_sight_km());
        assert!(line_of_sight.xy().norm() < 1e-12 * line_of_sight.z);
        let normal = camera_from_icrs.rotate(&local_axes(&states).2);
        assert!(normal.x.abs() < 1e-12 && normal.y < -0.99);
    }

    #[test]
    fn target_pointing_is_a_rotation_even_where_it_is_degenerate() {
        let mut states = states(0.0, behind());
        let normal = local_axes(&states).2;
        for position_km in [states.chaser.position_km, states.chaser.position_km + normal] {
            states.target.position_km = position_km;
            let matrix = Guidance::TargetPointing {}.camera_from_icrs(&states).matrix();
            assert!((matrix.determinant() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn inertial_guidance_has_north_up_and_east_left() {
        let guidance = |roll_deg| Guidance::Inertial { ra_deg: 30.0, dec_deg: 20.0, roll_deg };
        let at = |ra, dec| Direction::from_ra_dec(Angle::from_degrees(ra), Angle::from_degrees(dec));
        let states = states(0.0, behind());
        let unrolled = guidance(0.0).camera_from_icrs(&states);
        assert!((unrolled * at(30.0, 20.0)).separation(&Direction::z()).radians() < 1e-15);
        assert!((unrolled * at(30.0, 21.0)).vector().y < -0.01);
        assert!((unrolled * at(31.0, 20.0)).vector().x < -0.01);
        // Rotated by 90° from x towards y, the camera has the former y direction (south) along its x axis.
        let rolled = guidance(90.0).camera_from_icrs(&states);
        assert!((rolled * at(30.0, 19.0)).vector().x > 0.01);
    }

    #[test]
    fn an_offset_moves_the_boresight() {
        let states = states(0.0, behind());
        // θ > 0 rotates z towards x: the boresight points upwards (towards R), so R is closer to z.
        let up = Guidance::LocalOrbital { phi_deg: 0.0, theta_deg: 5.0, psi_deg: 0.0 };
        let boresight = up.camera_from_icrs(&states).inverse() * Direction::z();
        let radial = local_axes(&states).0;
        assert!((boresight.vector().dot(&radial) - libm::sin(5.0_f64.to_radians())).abs() < 1e-12);
    }

    #[test]
    fn a_mode_is_read_by_its_name_and_unknown_keys_are_refused() {
        let read = |text: &str| toml::from_str::<Guidance>(text);
        assert_eq!(read("mode = 'local_orbital'").unwrap(), LOCAL);
        assert_eq!(read("mode = 'target_pointing'").unwrap(), Guidance::TargetPointing {});
        for wrong in ["mode = 'target_pointing'\nra_deg = 1.0", "mode = 'inertial'", "mode = 'spin'"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_declination_past_the_pole_is_refused() {
        let guidance = Guidance::Inertial { ra_deg: 0.0, dec_deg: 91.0, roll_deg: 0.0 };
        assert!(
            contract::bounds::check(&guidance, "attitude.guidance")
                .unwrap_err()
                .to_string()
                .contains("dec_deg")
        );
    }
}
