//! Sinusoids about a trajectory: the limit cycle of a control system, or a separate manoeuvre.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sinusoid on each axis: amplitude × sin(2π t/period + phase). All zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OscillationConfig {
    /// Amplitudes of d1 and d2, m, 0 to 100.
    #[schemars(inner(range(min = 0, max = 100)))]
    pub lateral_amplitude_m: [f64; 2],
    /// Periods of d1 and d2, s, 0.1 to 1e5.
    #[schemars(inner(range(min = 0.1, max = 1e5)))]
    pub lateral_period_s: [f64; 2],
    /// Phases of d1 and d2 at the start, degrees.
    #[schemars(inner(range(min = -3600, max = 3600)))]
    pub lateral_phase_deg: [f64; 2],
    /// Amplitudes of φ1, φ2, φ3, degrees, 0 to 30.
    #[schemars(inner(range(min = 0, max = 30)))]
    pub angular_amplitude_deg: [f64; 3],
    /// Periods of φ1, φ2, φ3, s, 0.1 to 1e5.
    #[schemars(inner(range(min = 0.1, max = 1e5)))]
    pub angular_period_s: [f64; 3],
    /// Phases of φ1, φ2, φ3 at the start, degrees.
    #[schemars(inner(range(min = -3600, max = 3600)))]
    pub angular_phase_deg: [f64; 3],
}

impl Default for OscillationConfig {
    fn default() -> Self {
        Self {
            lateral_amplitude_m: [0.0; 2],
            lateral_period_s: [60.0; 2],
            lateral_phase_deg: [0.0; 2],
            angular_amplitude_deg: [0.0; 3],
            angular_period_s: [60.0; 3],
            angular_phase_deg: [0.0; 3],
        }
    }
}

impl OscillationConfig {
    /// Displacement and its rate `time_s` after the start.
    pub(super) fn displacement_at(&self, time_s: f64) -> Displacement {
        let lateral = [0, 1].map(|i| {
            sinusoid(self.lateral_amplitude_m[i], self.lateral_period_s[i], self.lateral_phase_deg[i], time_s)
        });
        let angular = [0, 1, 2].map(|i| {
            let amplitude_rad = self.angular_amplitude_deg[i].to_radians();
            sinusoid(amplitude_rad, self.angular_period_s[i], self.angular_phase_deg[i], time_s)
        });
        Displacement {
            lateral_m: Vector2::from(lateral.map(|(value, _)| value)),
            lateral_rate_m_s: Vector2::from(lateral.map(|(_, rate)| rate)),
            phi_rad: Vector3::from(angular.map(|(value, _)| value)),
            phi_rate_rad_s: Vector3::from(angular.map(|(_, rate)| rate)),
        }
    }
}

fn sinusoid(amplitude: f64, period_s: f64, phase_deg: f64, time_s: f64) -> (f64, f64) {
    let frequency = 2.0 * PI / period_s;
    let (sin, cos) = libm::sincos(frequency * time_s + phase_deg.to_radians());
    (amplitude * sin, amplitude * frequency * cos)
}

/// Displacement from the trajectory by an oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Displacement {
    pub(super) lateral_m: Vector2<f64>,
    pub(super) lateral_rate_m_s: Vector2<f64>,
    pub(super) phi_rad: Vector3<f64>,
    pub(super) phi_rate_rad_s: Vector3<f64>,
}

impl Displacement {
    /// Returns the displacement multiplied by a window with the value `window`, which changes by `rate` per
    /// second.
    pub(super) fn windowed(&self, window: f64, rate: f64) -> Self {
        Self {
            lateral_m: self.lateral_m * window,
            lateral_rate_m_s: self.lateral_rate_m_s * window + self.lateral_m * rate,
            phi_rad: self.phi_rad * window,
            phi_rate_rad_s: self.phi_rate_rad_s * window + self.phi_rad * rate,
        }
    }
}

/// Window that rises from 0 at the start to 1 and falls back to 0 at the end, with continuous rate: 3 s² − 2
/// s³ over `ramp_s` at each end. Returns value and rate.
pub(super) fn window(time_s: f64, duration_s: f64, ramp_s: f64) -> (f64, f64) {
    let ramp_s = ramp_s.min(0.5 * duration_s);
    let (s, sign) = if time_s <= 0.5 * duration_s {
        (time_s / ramp_s, 1.0)
    } else {
        ((duration_s - time_s) / ramp_s, -1.0)
    };
    if s <= 0.0 {
        (0.0, 0.0)
    } else if s < 1.0 {
        (s * s * (3.0 - 2.0 * s), sign * 6.0 * s * (1.0 - s) / ramp_s)
    } else {
        (1.0, 0.0)
    }
}
