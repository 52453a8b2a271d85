//! Answers of a navigator.

use std::fmt;

use hifitime::Epoch;
use nalgebra::{Vector3, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Covariance6;

/// Relative orbital elements of the chaser with respect to the target, multiplied by the target's semi-major
/// axis a, m (D'Amico 2010, chapter 2): δa = (a_c − a)/a, δλ = u_c − u + (Ω_c − Ω) cos i, δe = e_c (cos ω_c,
/// sin ω_c) − e (cos ω, sin ω), δi = (i_c − i, (Ω_c − Ω) sin i), with u = ω + M; letters without index are
/// the target's. All are mean elements.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelativeElements {
    /// aδa: difference of the semi-major axes, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_da_m: f64,
    /// aδλ: mean along-track separation, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dlambda_m: f64,
    /// aδex: relative eccentricity vector towards the node, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dex_m: f64,
    /// aδey: relative eccentricity vector 90° from the node, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dey_m: f64,
    /// aδix: relative inclination vector, difference of the inclinations, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dix_m: f64,
    /// aδiy: relative inclination vector, difference of the nodes times sin i, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_diy_m: f64,
}

impl RelativeElements {
    /// Names of the elements in order, as in files.
    pub const NAMES: [&'static str; 6] =
        ["a_da_m", "a_dlambda_m", "a_dex_m", "a_dey_m", "a_dix_m", "a_diy_m"];

    /// Returns the elements in order, m.
    pub fn vector(&self) -> Vector6<f64> {
        Vector6::new(self.a_da_m, self.a_dlambda_m, self.a_dex_m, self.a_dey_m, self.a_dix_m, self.a_diy_m)
    }

    /// Creates the elements from a vector in order, m.
    pub fn from_vector(vector: &Vector6<f64>) -> Self {
        let [a_da_m, a_dlambda_m, a_dex_m, a_dey_m, a_dix_m, a_diy_m] = (*vector).into();
        Self { a_da_m, a_dlambda_m, a_dex_m, a_dey_m, a_dix_m, a_diy_m }
    }
}

/// Estimate of the relative orbit at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeEstimate {
    /// Time of the estimate; at a manoeuvre, just after it.
    pub time: Epoch,
    /// Position of the chaser relative to the target along the target's R, T, N axes, m.
    pub position_m: Vector3<f64>,
    /// Velocity of the chaser relative to the target as seen in the rotating R, T, N frame, m/s: the
    /// components of v_c − v_t along the axes, minus ω × position with ω = |r_t × v_t|/r_t² about N.
    pub velocity_m_s: Vector3<f64>,
    /// Covariance of position (R, T, N), m, and velocity (R, T, N), m/s.
    pub covariance: Covariance6,
    /// Mean relative elements.
    pub elements: RelativeElements,
    /// Covariance of the elements, in the order of the fields, m².
    pub elements_covariance: Covariance6,
}

/// Reason why there is no estimate.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoEstimate {
    /// No usable measurement has been received.
    NoMeasurements,
    /// No prior was given, and the measurements do not determine an initial orbit.
    NoInitialOrbit,
    /// The requested time is outside the times for which the chaser's orbit is known.
    NoChaserOrbit,
    /// The estimation did not converge.
    NoConvergence,
    /// The navigator failed, with the reason as text.
    Failed(String),
}

impl NoEstimate {
    const PLAIN: [Self; 4] =
        [Self::NoMeasurements, Self::NoInitialOrbit, Self::NoChaserOrbit, Self::NoConvergence];

    /// Returns the name used in files.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoMeasurements => "no_measurements",
            Self::NoInitialOrbit => "no_initial_orbit",
            Self::NoChaserOrbit => "no_chaser_orbit",
            Self::NoConvergence => "no_convergence",
            Self::Failed(_) => "failed",
        }
    }

    /// Parses the output of [`fmt::Display`], or `failed` without a reason; `None` for an unknown text.
    pub fn parse(text: &str) -> Option<Self> {
        let failed = || if text == "failed" { Some(text) } else { text.strip_prefix("failed: ") };
        let plain = Self::PLAIN.into_iter().find(|reason| reason.code() == text);
        plain.or_else(|| failed().map(|reason| Self::Failed(reason.to_owned())))
    }
}

impl fmt::Display for NoEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(reason) => write!(f, "failed: {reason}"),
            other => f.write_str(other.code()),
        }
    }
}

/// Answer to one requested epoch.
pub type Answer = Result<RelativeEstimate, NoEstimate>;

/// Use of a received measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// The measurement contributed to the estimate.
    Used,
    /// The residual was too large for the covariance.
    Outlier,
    /// A measurement of the same frame and time had been received before.
    Duplicate,
    /// The measurement arrived too late to be used.
    TooLate,
    /// The chaser's orbit is unknown at the time of the measurement.
    NoChaserOrbit,
    /// The measurement or its covariance is not usable: not finite, or the target is behind the camera.
    Unusable,
    /// The measurement waits for an initial orbit.
    Waiting,
}

impl Use {
    /// All variants.
    pub const ALL: [Self; 7] = [
        Self::Used,
        Self::Outlier,
        Self::Duplicate,
        Self::TooLate,
        Self::NoChaserOrbit,
        Self::Unusable,
        Self::Waiting,
    ];

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Outlier => "outlier",
            Self::Duplicate => "duplicate",
            Self::TooLate => "too_late",
            Self::NoChaserOrbit => "no_chaser_orbit",
            Self::Unusable => "unusable",
            Self::Waiting => "waiting",
        }
    }

    /// Parses the result of [`Use::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|used| used.code() == code)
    }
}

/// Use of one measurement, with its residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disposition {
    /// Number of the frame.
    pub frame: u64,
    /// Time of the measurement.
    pub time: Epoch,
    /// Use of the measurement.
    pub used: Use,
    /// Measured minus predicted angles atan2(X, Z) across columns and atan2(Y, Z) across rows in the camera
    /// frame, rad; `None` if not computed.
    pub residual_rad: Option<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_and_uses_come_back_through_their_text() {
        let reasons = [NoEstimate::PLAIN.to_vec(), vec![NoEstimate::Failed("no light".to_owned())]].concat();
        for reason in reasons {
            assert_eq!(NoEstimate::parse(&reason.to_string()), Some(reason));
        }
        assert_eq!(NoEstimate::parse("failed"), Some(NoEstimate::Failed("failed".to_owned())));
        assert_eq!(NoEstimate::parse("nothing"), None);
        for used in Use::ALL {
            assert_eq!(Use::parse(used.code()), Some(used));
        }
    }

    #[test]
    fn elements_come_back_through_their_vector() {
        let vector = Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        assert_eq!(RelativeElements::from_vector(&vector).vector(), vector);
    }
}
