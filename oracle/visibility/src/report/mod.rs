//! What is told of requirements: verdicts and curves, as `visibility.json` holds them.

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

/// The answer to a file of requirements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VisibilityReport {
    /// Name of the file.
    pub name: String,
    /// What it is about.
    pub title: String,
    /// Version of Boresight that answered.
    pub version: String,
    /// The files that the camera reads: SHA-256 by role, as in `run.toml`.
    #[serde(default, skip_serializing_if = "FileDigests::is_empty")]
    pub files: FileDigests,
    /// The camera, in figures.
    pub camera: CameraFigures,
    /// The verification table.
    pub requirements: Vec<Verdict>,
    /// Detection probability against magnitude at the nominal exposure.
    pub detection: Vec<DetectionPoint>,
    /// The same, simulated.
    pub detection_simulated: Vec<SimulatedPoint>,
    /// Limiting magnitude against exposure.
    pub limiting_magnitude: Vec<LimitPoint>,
    /// Stars in the field over the whole sky at the nominal exposure.
    pub sky: SkySummary,
    /// Exposures against range; empty without a target.
    pub exposure_window: Vec<WindowPoint>,
    /// From which range on, approaching, enough stars no longer remain; `None` without a target.
    pub stars_lost: Option<StarsLost>,
    /// Greatest range of the target by phase angle; empty without a target.
    pub target_range: Vec<RangeByPhase>,
}

/// The camera, in figures that are looked for in a data sheet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CameraFigures {
    /// Width and height of the field, degrees; absent where a corner has no direction.
    pub field_deg: Option<[f64; 2]>,
    /// Photoelectrons a second of a star of V = 0 and mean colour.
    pub zero_point_e_per_s: f64,
    /// Electrons at which a pixel saturates.
    pub saturation_e: f64,
    /// I2 over the median background at the nominal exposure, DN.
    pub threshold_dn: f64,
    /// Median light of the background, electrons a second and pixel.
    pub background_e_per_s: f64,
    /// Trail of the stars in the nominal exposure, px.
    pub star_trail_px: f64,
    /// Stars that are needed.
    pub n_min: u32,
    /// Probability that is asked for.
    pub probability: f64,
    /// The nominal exposure, s.
    pub nominal_s: f64,
}

/// Whether a requirement is met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The analytic detection model says so, and the lower bound of the simulated rate too.
    MetSimulated,
    /// The analytic detection model says so alone: nothing was simulated, or too few frames to show it even if all of them met it.
    #[serde(rename = "met_law")]
    MetModel,
    /// The detection model or the upper bound of the simulated rate says that it is not.
    NotMet,
    /// The detection model says so, and the bounds of the simulated rate are on either side of what is asked for.
    NotDecided,
    /// No value that was to be looked at meets it.
    Impossible,
}

impl Status {
    /// Whether it is met, by the detection model at least.
    pub fn is_met(self) -> bool {
        matches!(self, Self::MetSimulated | Self::MetModel)
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::MetSimulated => "met (simulated)",
            Self::MetModel => "met (law)",
            Self::NotMet => "not met",
            Self::NotDecided => "not decided",
            Self::Impossible => "impossible",
        }
    }
}

/// One row of the verification table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Name of the requirement.
    pub id: String,
    /// What it says.
    pub text: String,
    /// Whether it is met.
    pub status: Status,
    /// Probability that is asked for.
    pub asked: f64,
    /// Probability by the analytic detection model, at the worst of what is demanded.
    pub reached: f64,
    /// Room, in the unit beside it; negative where it is not met.
    pub margin: Option<f64>,
    /// Unit of the margin.
    pub margin_unit: Cow<'static, str>,
    /// In words: what was looked at, and what was simulated.
    pub evidence: String,
    /// What was simulated.
    pub simulated: Option<SimulatedRate>,
    /// What was looked for, and found.
    pub found: Option<SearchResult>,
    /// What binds, where it is not met.
    pub binds: Option<String>,
}

/// A simulated rate with the one-sided bounds of Clopper & Pearson.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SimulatedRate {
    /// Frames of which it is true.
    pub count: u64,
    /// Frames.
    pub of: u64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Confidence of either bound.
    pub confidence: f64,
}

/// A value that meets a requirement, and one that does not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchResult {
    /// Name of the parameter.
    pub parameter: Cow<'static, str>,
    /// Its unit.
    pub unit: Cow<'static, str>,
    /// The value that meets the requirement, with room enough for the simulation to show it.
    pub value: f64,
    /// Probability by the analytic detection model there.
    pub probability: f64,
    /// The probability that the search aimed at: what is asked for, or as much more as the simulated frames need to show that.
    pub aimed: f64,
    /// Where the analytic probability is just what is asked for.
    pub threshold_value: f64,
    /// What was simulated at the value.
    pub simulated: Option<SimulatedRate>,
    /// The value a step beyond the threshold; `None` when all that was looked at meets the requirement.
    pub failing_value: Option<f64>,
    /// Probability by the analytic detection model there.
    pub failing_probability: Option<f64>,
    /// What was simulated there.
    pub failing_simulated: Option<SimulatedRate>,
    /// Whether all values beyond the found one, to the other end, meet the requirement.
    pub is_monotone: bool,
}

/// A point of the detection curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DetectionPoint {
    /// Johnson V of a star of mean colour.
    pub magnitude: f64,
    /// Its electrons.
    pub electrons: f64,
    /// Probability of detection.
    pub probability: f64,
}

/// Stars of simulated frames about a magnitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SimulatedPoint {
    /// Middle of the magnitudes.
    pub magnitude: f64,
    /// Stars that the detector found.
    pub count: u64,
    /// Stars in the frames.
    pub of: u64,
    /// Lower limit of the rate, 95 % two-sided (Wilson).
    pub low: f64,
    /// Upper limit.
    pub high: f64,
    /// Mean probability of the very same stars by the analytic detection model.
    pub analytic: f64,
}

table! {
    /// A point of the limiting magnitude.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct LimitPoint: csv {
        /// exposure, s
        exposure_s: f64,
        /// V of the stars of which half are detected; none when fewer are
        half: Option<f64> = ["magnitude_half"],
        /// V of the stars detected with the probability that is asked for
        asked: Option<f64> = ["magnitude_asked"],
        /// stars detected at a boresight, mean over the sky
        stars: f64,
        /// probability of enough of them, over the sky
        probability: f64,
    }
}

/// The sky in figures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SkySummary {
    /// Boresights.
    pub pointings: u64,
    /// Those that count.
    pub counted: u64,
    /// Excluded by the Sun, by the Moon, by the limb of the Earth: the first that applies.
    pub excluded: [u64; 3],
    /// Stars detected, mean over the sky.
    pub stars: f64,
    /// The 1, 10 and 50 % quantiles of that number over the sky.
    pub quantiles: [f64; 3],
    /// P(N ≥ n_min), mean over the sky.
    pub probability: f64,
    /// Share of the pointings at which it is at least what is asked for.
    pub share: f64,
    /// The pointings with the fewest stars.
    pub worst: Vec<PointingStars>,
    /// All pointings, in the order of the lattice; in `sky.csv` alone.
    #[serde(skip)]
    pub map: Vec<PointingStars>,
}

table! {
    /// The stars at one pointing.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PointingStars: csv {
        /// right ascension of the boresight, 0 to 360
        ra_deg: f64,
        /// its declination, −90 to 90
        dec_deg: f64,
        /// roll, −180 to 180: the turn from the image with north up, as in a scenario's inertial guidance
        roll_deg: f64,
        /// time, UTC
        time_utc: String,
        /// what excludes the pointing: `sun`, `moon`, `earth`; none when it counts
        excluded: Option<Cow<'static, str>>,
        /// background, electrons per second and pixel
        background_e_per_s: f64,
        /// stars in the field down to the limiting magnitude of the probability that is asked for
        in_field: u64,
        /// expected number of stars detected
        stars: f64,
        /// probability of enough of them
        probability: f64,
    }
}

table! {
    /// Exposures at one range.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct WindowPoint: csv {
        /// range of the target
        range_km: f64,
        /// longest exposure that does not over-expose the target with the probability that is asked for, at most the camera's longest
        longest_s: f64,
        /// the same for half of the aspects
        median_s: f64,
        /// shortest exposure with enough stars at that probability; none where there is none
        shortest_s: Option<f64>,
        /// whether an exposure does both
        is_open: bool,
        /// stars detected at the median exposure, mean over the sky
        stars: f64,
        /// probability of enough of them at the median exposure
        probability: f64,
    }
}

/// From where on, approaching, stars are too few.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StarsLost {
    /// Stars that are needed.
    pub n_min: u32,
    /// Range at which the window of exposures closes, km: nearer, enough stars are no longer had with the probability that is
    /// asked for. `None` when it is open, or closed, at all ranges.
    pub window_closes_km: Option<f64>,
    /// Range within which fewer than `n_min` stars are detected in half of the frames at the median exposure, km.
    pub half_of_frames_km: Option<f64>,
}

table! {
    /// Greatest range by phase angle.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct RangeByPhase: csv {
        /// smallest and largest phase angle
        phases_deg: [f64; 2] = ["phase_low_deg", "phase_high_deg"],
        /// greatest range at which the target is detected with the probability that is asked for at the nominal exposure;
        /// none where it is not detected at 10 m
        nominal_km: Option<f64>,
        /// the same at the longest exposure
        longest_km: Option<f64>,
    }
}
