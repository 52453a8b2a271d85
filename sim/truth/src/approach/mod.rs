//! Approach to a docking target: pose of the camera and its rates as functions of time.

mod oscillation;
mod segment;

use contract::OutOfRange;
use contract::bounds::{self, require};
use contract::docking::Pose;
use nalgebra::{Matrix3, Rotation3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::SimError;
pub use oscillation::OscillationConfig;
pub use segment::SegmentConfig;
use segment::{AxialMotion, D3_M};

/// Motion of the camera relative to the target. The frames are those of [`Pose`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ApproachConfig {
    /// Motion at constant rates: d = d0 + v t, φ = φ0 + ω t, exactly.
    ConstantVelocity(ConstantVelocityConfig),
    /// Segments flown in sequence.
    Segments(SegmentedConfig),
}

/// Motion at constant rates: d = d0 + v t, φ = φ0 + ω t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstantVelocityConfig {
    /// d at the start, m, each from −20000 to 20000; d3 must be at least 0.05, also at the end.
    #[schemars(inner(range(min = -20000, max = 20000)))]
    pub position_m: [f64; 3],
    /// Velocity, m/s, each from −100 to 100.
    #[serde(default)]
    #[schemars(inner(range(min = -100, max = 100)))]
    pub velocity_m_s: [f64; 3],
    /// φ at the start, degrees, each from −60 to 60, also at the end.
    #[serde(default)]
    #[schemars(inner(range(min = -60, max = 60)))]
    pub phi_deg: [f64; 3],
    /// dφ/dt, degrees per second, each from −60 to 60.
    #[serde(default)]
    #[schemars(inner(range(min = -60, max = 60)))]
    pub phi_rate_deg_s: [f64; 3],
    /// Duration, s, 0 to 1e5; 0 is a single field.
    #[schemars(range(min = 0, max = 1e5))]
    pub duration_s: f64,
}

/// Segments flown in sequence; velocity is continuous.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SegmentedConfig {
    /// d3 at the start, m, 0.05 to 20000 and greater than the target's contact distance.
    #[schemars(range(min = 0.05, max = 20000))]
    pub start_d3_m: f64,
    /// d1 and d2 at the start, m, −1000 to 1000. They change linearly with d3 to their values at contact:
    /// guidance holds a line of sight, so lateral offsets shrink with the distance.
    #[serde(default)]
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub lateral_at_start_m: [f64; 2],
    /// d1 and d2 at contact, m, −1000 to 1000.
    #[serde(default)]
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub lateral_at_contact_m: [f64; 2],
    /// Mean φ, degrees, each from −30 to 30.
    #[serde(default)]
    #[schemars(inner(range(min = -30, max = 30)))]
    pub phi_deg: [f64; 3],
    /// Duration of the change of speed from one segment to the next, s, 0.01 to 1000.
    #[serde(default = "default_ramp_s")]
    #[schemars(range(min = 0.01, max = 1000))]
    pub ramp_s: f64,
    /// Limit cycle of the control system, over the whole approach.
    #[serde(default)]
    pub limit_cycle: OscillationConfig,
    /// Segments, at least one; the first segment begins at its own speed.
    #[schemars(length(min = 1, max = 1000))]
    pub segments: Vec<SegmentConfig>,
}

fn default_ramp_s() -> f64 {
    3.0
}

impl ConstantVelocityConfig {
    fn check(&self) -> Result<(), OutOfRange> {
        let ends_m = [0.0, self.duration_s].map(|t_s| self.position_m[2] + self.velocity_m_s[2] * t_s);
        for (path, d3_m) in
            ["approach.position_m", "approach.velocity_m_s (d3 at the end)"].into_iter().zip(ends_m)
        {
            require(path, d3_m, "0.05 to 20000", |d3_m| D3_M.contains(&d3_m))?;
        }
        for (phi, rate) in self.phi_deg.into_iter().zip(self.phi_rate_deg_s) {
            let end = phi + rate * self.duration_s;
            require("approach.phi_rate_deg_s (phi at the end)", end, "-60 to 60", |phi| phi.abs() <= 60.0)?;
        }
        Ok(())
    }
}

impl SegmentedConfig {
    fn check(&self, contact_distance_m: f64) -> Result<(), OutOfRange> {
        let expected = "greater than the target's contact distance";
        require("approach.start_d3_m", self.start_d3_m, expected, |d| d > contact_distance_m)
    }
}

/// Pose of the camera and its rates at one time; the derivatives are exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApproachState {
    /// Position d and angles φ.
    pub pose: Pose,
    /// dd/dt, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
}

impl ApproachState {
    /// Range ρ = |d|, m (docking paper, 3.2).
    pub fn range_m(&self) -> f64 {
        self.pose.position_m.norm()
    }

    /// Range rate u = dρ/dt, m/s: negative when closing.
    pub fn range_rate_m_s(&self) -> f64 {
        self.pose.position_m.dot(&self.velocity_m_s) / self.range_m()
    }

    /// Passive pitch α = atan2(d2, √(d1² + d3²)), rad.
    pub fn passive_pitch_rad(&self) -> f64 {
        let d = self.pose.position_m;
        libm::atan2(d.y, libm::hypot(d.x, d.z))
    }

    /// Passive yaw β = atan2(d1, d3), rad.
    pub fn passive_yaw_rad(&self) -> f64 {
        libm::atan2(self.pose.position_m.x, self.pose.position_m.z)
    }
}

/// Rotation matrix A = diag(1, −1, −1) exp(\[φ\]×): y = d + A x transforms a point from the camera frame to
/// the target frame.
pub fn target_from_camera(pose: &Pose) -> Matrix3<f64> {
    let turned = Rotation3::from_scaled_axis(pose.phi_rad);
    Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)) * turned.matrix()
}

/// Checked approach.
#[derive(Debug, Clone, PartialEq)]
pub struct Approach {
    course: Course,
}

#[derive(Debug, Clone, PartialEq)]
enum Course {
    Constant(ConstantVelocityConfig),
    Segmented { config: SegmentedConfig, axial: AxialMotion, contact_distance_m: f64 },
}

impl Approach {
    /// Checks an approach to a target with contact at d3 = `contact_distance_m`.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for the first value that is not allowed.
    pub fn new(config: &ApproachConfig, contact_distance_m: f64) -> Result<Self, SimError> {
        bounds::check(config, "approach")?;
        let course = match config {
            ApproachConfig::ConstantVelocity(constant) => {
                constant.check()?;
                Course::Constant(*constant)
            }
            ApproachConfig::Segments(segmented) => {
                segmented.check(contact_distance_m)?;
                let axial = AxialMotion::new(
                    &segmented.segments,
                    segmented.start_d3_m,
                    contact_distance_m,
                    segmented.ramp_s,
                )?;
                Course::Segmented { config: segmented.clone(), axial, contact_distance_m }
            }
        };
        Ok(Self { course })
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        match &self.course {
            Course::Constant(config) => config.duration_s,
            Course::Segmented { axial, .. } => axial.end_s(),
        }
    }

    /// State of the camera `time_s` after the start.
    pub fn state_at(&self, time_s: f64) -> ApproachState {
        match &self.course {
            Course::Constant(config) => constant_velocity(config, time_s),
            Course::Segmented { config, axial, contact_distance_m } => {
                segmented(config, axial, *contact_distance_m, time_s)
            }
        }
    }
}

fn constant_velocity(config: &ConstantVelocityConfig, time_s: f64) -> ApproachState {
    let velocity_m_s = Vector3::from(config.velocity_m_s);
    let phi_rate_rad_s = Vector3::from(config.phi_rate_deg_s.map(f64::to_radians));
    ApproachState {
        pose: Pose {
            position_m: Vector3::from(config.position_m) + velocity_m_s * time_s,
            phi_rad: Vector3::from(config.phi_deg.map(f64::to_radians)) + phi_rate_rad_s * time_s,
        },
        velocity_m_s,
        phi_rate_rad_s,
    }
}

fn segmented(
    config: &SegmentedConfig,
    axial: &AxialMotion,
    contact_distance_m: f64,
    time_s: f64,
) -> ApproachState {
    let (d3_m, rate_m_s) = axial.range_and_rate_at(time_s);
    let span_m = config.start_d3_m - contact_distance_m;
    let lateral = |i: usize| {
        let slope = (config.lateral_at_start_m[i] - config.lateral_at_contact_m[i]) / span_m;
        (config.lateral_at_contact_m[i] + slope * (d3_m - contact_distance_m), slope * rate_m_s)
    };
    let [(d1_m, d1_rate), (d2_m, d2_rate)] = [lateral(0), lateral(1)];
    let mut state = ApproachState {
        pose: Pose {
            position_m: Vector3::new(d1_m, d2_m, d3_m),
            phi_rad: Vector3::from(config.phi_deg.map(f64::to_radians)),
        },
        velocity_m_s: Vector3::new(d1_rate, d2_rate, rate_m_s),
        phi_rate_rad_s: Vector3::zeros(),
    };
    state.add(&config.limit_cycle.displacement_at(time_s));
    let index = axial.begin_s().partition_point(|begin_s| *begin_s <= time_s).saturating_sub(1);
    if let Some(SegmentConfig::Oscillation { duration_s, swing }) = config.segments.get(index) {
        let since_s = time_s - axial.begin_s()[index];
        let (value, rate) = oscillation::window(since_s, *duration_s, config.ramp_s);
        state.add(&swing.displacement_at(since_s).windowed(value, rate));
    }
    state
}

impl ApproachState {
    fn add(&mut self, displacement: &oscillation::Displacement) {
        let (lateral, rate) = (displacement.lateral_m, displacement.lateral_rate_m_s);
        self.pose.position_m += Vector3::new(lateral.x, lateral.y, 0.0);
        self.velocity_m_s += Vector3::new(rate.x, rate.y, 0.0);
        self.pose.phi_rad += displacement.phi_rad;
        self.phi_rate_rad_s += displacement.phi_rate_rad_s;
    }
}

#[cfg(test)]
mod tests;
