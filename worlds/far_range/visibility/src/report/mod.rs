//! Verdicts and curves of requirements: the content of `visibility.json`.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod curves;
pub(crate) mod write;

use std::borrow::Cow;

use files::table;
use scenario::run_file::FileDigests;
use serde::{Deserialize, Serialize};

/// Report on a file of requirements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VisibilityReport {
    /// Name of the requirements file.
    pub name: String,
    /// Title of the requirements.
    pub title: String,
    /// Version of Boresight that computed the report.
    pub version: String,
    /// SHA-256 of each file that the camera reads, by role, as in `run.toml`.
    #[serde(default, skip_serializing_if = "FileDigests::is_empty")]
    pub files: FileDigests,
    /// Figures of the camera.
    pub camera: CameraFigures,
    /// Verification table.
    pub requirements: Vec<Verdict>,
    /// Detection probability against magnitude at the nominal exposure.
    pub detection: Vec<DetectionPoint>,
    /// Simulated detection rate against magnitude at the nominal exposure.
    pub detection_simulated: Vec<SimulatedPoint>,
    /// Limiting magnitude against exposure.
    pub limiting_magnitude: Vec<LimitPoint>,
    /// Stars in the field over the whole sky at the nominal exposure.
    pub sky: SkySummary,
    /// Exposures against range; empty without a target.
    pub exposure_window: Vec<WindowPoint>,
    /// Ranges below which too few stars remain during an approach; `None` without a target.
    pub stars_lost: Option<StarsLost>,
    /// Greatest range of the target by phase angle; empty without a target.
    pub target_range: Vec<RangeByPhase>,
}

/// Figures of the camera, as in a data sheet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CameraFigures {
    /// Width and height of the field, degrees; absent where a corner has no direction.
    pub field_deg: Option<[f64; 2]>,
    /// Photoelectrons per second of a star of V = 0 and mean colour.
    pub zero_point_e_per_s: f64,
    /// Electrons at which a pixel saturates.
    pub saturation_e: f64,
    /// I2 over the median background at the nominal exposure, DN.
    pub threshold_dn: f64,
    /// Median background, electrons per second and pixel.
    pub background_e_per_s: f64,
    /// Trail of the stars in the nominal exposure, px.
    pub star_trail_px: f64,
    /// Required number of stars.
    pub n_min: u32,
    /// Required probability.
    pub probability: f64,
    /// Nominal exposure, s.
    pub nominal_s: f64,
}

/// Status of a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Met according to the analytic model and to the lower bound of the simulated rate.
    MetSimulated,
    /// Met according to the analytic model only: nothing was simulated, or too few frames to show it even if
    /// all of them met it.
    // `met_law` is the status in reports of earlier versions.
    #[serde(alias = "met_law")]
    MetModel,
    /// Not met according to the model or to the upper bound of the simulated rate.
    NotMet,
    /// Met according to the model, but the required probability lies between the bounds of the simulated
    /// rate.
    NotDecided,
    /// The requirement is met at no value of the bracket.
    Impossible,
}

impl Status {
    /// Returns true if the requirement is met, at least according to the model.
    pub fn is_met(self) -> bool {
        matches!(self, Self::MetSimulated | Self::MetModel)
    }

    /// Returns the status in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::MetSimulated => "met (simulated)",
            Self::MetModel => "met (model)",
            Self::NotMet => "not met",
            Self::NotDecided => "not decided",
            Self::Impossible => "impossible",
        }
    }
}

/// Row of the verification table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Name of the requirement.
    pub id: String,
    /// Text of the requirement.
    pub text: String,
    /// Status of the requirement.
    pub status: Status,
    /// Required probability.
    pub asked: f64,
    /// Probability according to the analytic model, under the worst conditions of the demand.
    pub reached: f64,
    /// Margin, in the unit `margin_unit`; negative if the requirement is not met.
    pub margin: Option<f64>,
    /// Unit of the margin.
    pub margin_unit: Cow<'static, str>,
    /// Description of the conditions evaluated and of the simulation.
    pub evidence: String,
    /// Simulated rate.
    pub simulated: Option<SimulatedRate>,
    /// Result of the search for a parameter value, if the requirement states one.
    pub found: Option<SearchResult>,
    /// Binding constraint, if the requirement is not met.
    pub binds: Option<String>,
}

/// Simulated rate with the one-sided bounds of Clopper & Pearson.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SimulatedRate {
    /// Number of frames that meet the requirement.
    pub count: u64,
    /// Number of frames.
    pub of: u64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Confidence of each bound.
    pub confidence: f64,
}

/// A value that meets a requirement, and one that fails it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchResult {
    /// Name of the parameter.
    pub parameter: Cow<'static, str>,
    /// Unit of the parameter.
    pub unit: Cow<'static, str>,
    /// Value that meets the requirement with enough margin for the simulation to show it.
    pub value: f64,
    /// Probability at this value according to the analytic model.
    pub probability: f64,
    /// Target probability of the search: the required one, or the higher one that the simulated frames need
    /// to show it.
    pub aimed: f64,
    /// Value at which the analytic probability equals the required one.
    pub threshold_value: f64,
    /// Simulated rate at the found value.
    pub simulated: Option<SimulatedRate>,
    /// Value a step beyond the threshold; `None` when all evaluated values meet the requirement.
    pub failing_value: Option<f64>,
    /// Probability at the failing value according to the analytic model.
    pub failing_probability: Option<f64>,
    /// Simulated rate at the failing value.
    pub failing_simulated: Option<SimulatedRate>,
    /// True if all values beyond the found one, to the other end, meet the requirement.
    pub is_monotone: bool,
}

/// Point of the detection curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DetectionPoint {
    /// Johnson V magnitude of a star of mean colour.
    pub magnitude: f64,
    /// Electrons of the star.
    pub electrons: f64,
    /// Probability of detection.
    pub probability: f64,
}

/// Stars of simulated frames near a magnitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SimulatedPoint {
    /// Centre of the magnitude interval.
    pub magnitude: f64,
    /// Number of stars that the detector found.
    pub count: u64,
    /// Number of stars in the frames.
    pub of: u64,
    /// Lower limit of the rate, 95 % two-sided (Wilson).
    pub low: f64,
    /// Upper limit of the rate, 95 % two-sided (Wilson).
    pub high: f64,
    /// Mean probability of these stars according to the analytic model.
    pub analytic: f64,
}

table! {
    /// Point of the curve of limiting magnitude.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct LimitPoint: csv {
        /// exposure, s
        exposure_s: f64,
        /// V magnitude at which half of the stars are detected; none if fewer are at any magnitude
        half: Option<f64> = ["magnitude_half"],
        /// V magnitude at which stars are detected with the required probability; none if there is none
        asked: Option<f64> = ["magnitude_asked"],
        /// expected number of stars detected per boresight, mean over the sky
        stars: f64,
        /// probability that enough stars are detected, over the sky
        probability: f64,
    }
}

/// Figures of the sky.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SkySummary {
    /// Number of boresights.
    pub pointings: u64,
    /// Number of boresights that count.
    pub counted: u64,
    /// Number of boresights excluded by the Sun, by the Moon, by the limb of the Earth; each is counted under
    /// the first that applies.
    pub excluded: [u64; 3],
    /// Number of stars detected, mean over the sky.
    pub stars: f64,
    /// 1, 10 and 50 % quantiles of the number of stars detected, over the sky.
    pub quantiles: [f64; 3],
    /// P(N ≥ n_min), mean over the sky.
    pub probability: f64,
    /// Fraction of the pointings at which P(N ≥ n_min) is at least the required probability.
    pub share: f64,
    /// Pointings with the fewest stars.
    pub worst: Vec<PointingStars>,
    /// All pointings, in the order of the lattice; only in `sky.csv`.
    #[serde(skip)]
    pub map: Vec<PointingStars>,
}

table! {
    /// Stars at one pointing.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PointingStars: csv {
        /// right ascension of the boresight, 0 to 360
        ra_deg: f64,
        /// declination of the boresight, −90 to 90
        dec_deg: f64,
        /// roll, −180 to 180: the rotation from the image with north up, as in a scenario's inertial guidance
        roll_deg: f64,
        /// time, UTC
        time_utc: String,
        /// object that excludes the pointing: `sun`, `moon`, `earth`; none if the pointing counts
        excluded: Option<Cow<'static, str>>,
        /// background, electrons per second and pixel
        background_e_per_s: f64,
        /// number of stars in the field down to the limiting magnitude of the required probability
        in_field: u64,
        /// expected number of stars detected
        stars: f64,
        /// probability that enough stars are detected
        probability: f64,
    }
}

table! {
    /// Exposures at one range.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct WindowPoint: csv {
        /// range of the target
        range_km: f64,
        /// longest exposure that does not over-expose the target, with the required probability; at most the
        /// camera's longest exposure
        longest_s: f64,
        /// longest exposure that does not over-expose the target in half of the aspects, within the camera's
        /// exposures
        median_s: f64,
        /// shortest exposure with enough stars, with the required probability; none if there is none
        shortest_s: Option<f64>,
        /// true if an exposure meets both conditions
        is_open: bool,
        /// number of stars detected at the median exposure, mean over the sky
        stars: f64,
        /// probability that enough stars are detected at the median exposure
        probability: f64,
    }
}

/// Ranges below which too few stars remain during an approach.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StarsLost {
    /// Required number of stars.
    pub n_min: u32,
    /// Range at which the window of exposures closes, km: nearer than this, enough stars are not detected
    /// with the required probability. `None` when the window is open, or closed, at all ranges:
    /// [`WindowPoint::is_open`].
    pub window_closes_km: Option<f64>,
    /// Range within which fewer than `n_min` stars are detected in half of the frames at the median exposure,
    /// km. `None` when it is so at no range or at all ranges: [`WindowPoint::probability`].
    pub half_of_frames_km: Option<f64>,
}

table! {
    /// Greatest range by phase angle.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct RangeByPhase: csv {
        /// smallest and largest phase angle
        phases_deg: [f64; 2] = ["phase_low_deg", "phase_high_deg"],
        /// greatest range at which the target is detected with the required probability at the nominal
        /// exposure; none if it is not detected at 10 m
        nominal_km: Option<f64>,
        /// greatest range at which the target is detected with the required probability at the longest
        /// exposure; none if it is not detected at 10 m
        longest_km: Option<f64>,
    }
}
