//! Structure of a requirement file: a camera, its detection rule, exposures and motion, and the demands on
//! it.

pub(crate) mod definition;

use contract::OutOfRange;
use contract::bounds::{self, require};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::optics::{OpticsConfig, PsfConfig, RadiometryConfig};
use sim::scene::{BackgroundConfig, TargetConfig};
use sim::sensor::SensorConfig;

/// A requirement file. Key names contain the units; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RequirementFile {
    /// Title of the requirements, in one line.
    pub title: String,
    /// Seed of the confirming simulations.
    #[serde(default)]
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Camera under evaluation.
    pub camera: CameraTable,
    /// Rule for counting an object as detected.
    pub detection: DetectionRule,
    /// Exposures that the camera can command.
    pub exposure: ExposureTable,
    /// Required number of stars in a frame, unless a requirement states another, 1 to 1000.
    #[schemars(range(min = 1, max = 1000))]
    pub n_min: u32,
    /// Required probability, unless a requirement states another, in (0, 1).
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub probability: f64,
    /// Motion of the camera.
    pub motion: MotionTable,
    /// Directions and times of the observations.
    #[serde(default)]
    pub sky: SkyTable,
    /// Target body; absent: only stars are evaluated.
    pub target: Option<TargetTable>,
    /// Confirmation of results by simulation.
    #[serde(default)]
    pub confirm: ConfirmTable,
    /// Requirements on the camera.
    #[serde(default)]
    pub requirements: Vec<Requirement>,
}

/// Source of the camera, and the values that differ from it. A scenario provides the entire camera; a preset
/// provides or replaces geometry and detector; each other key replaces one item.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CameraTable {
    /// A built-in far-range scenario, or the path of a scenario file, relative to the directory of this file.
    pub scenario: Option<String>,
    /// A built-in camera (`boresight scenario camera`): geometry and detector, and without a scenario also
    /// point-spread function and radiometry.
    pub preset: Option<String>,
    /// Focal length, mm, 0.01 to 1e6.
    #[schemars(range(min = 0.01, max = 1e6))]
    pub focal_length_mm: Option<f64>,
    /// Diameter of the aperture, mm, greater than 0, at most 10000; only for a spectral radiometry.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 10000))]
    pub aperture_diameter_mm: Option<f64>,
    /// Point-spread function, px.
    pub psf: Option<PsfConfig>,
    /// Optical effects that vary over the field.
    pub optics: Option<OpticsConfig>,
    /// Conversion of magnitudes to photoelectrons.
    pub radiometry: Option<RadiometryConfig>,
    /// Background without a source in the field.
    pub background: Option<BackgroundConfig>,
    /// Detector of the camera.
    pub sensor: Option<SensorConfig>,
}

/// Rule for counting an object as detected: at least one of its pixels is above I2, as in the far-range
/// method (adjacent pixels above I1 belong to the same cluster and move its centre, but do not affect
/// detection).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum DetectionRule {
    /// Thresholds in digital numbers, as in a camera that transmits regions around bright pixels.
    Dn {
        /// I1, DN, 0 to `high_dn`.
        low_dn: u16,
        /// I2, DN, less than full scale.
        high_dn: u16,
    },
    /// Thresholds above the background in standard deviations of its noise: a signal-to-noise ratio of the
    /// brightest pixel.
    Sigmas {
        /// I1, standard deviations, 0 to `high`.
        #[schemars(range(min = 0, max = 1000))]
        low: f64,
        /// I2, standard deviations, up to 1000.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
        high: f64,
    },
}

/// Exposures of a camera.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExposureTable {
    /// Exposure of curves, and of requirements that state none, s, `min_s` to `max_s`.
    #[schemars(range(min = 1e-6, max = 1000))]
    pub nominal_s: f64,
    /// Shortest exposure, s, 1e-6 to `max_s`.
    #[schemars(range(min = 1e-6, max = 1000))]
    pub min_s: f64,
    /// Longest exposure, s, at most 1000.
    #[schemars(range(min = 1e-6, max = 1000))]
    pub max_s: f64,
    /// Largest expected level of the target's brightest pixel, as a fraction of saturation, above 0, at most
    /// 1000: at 1 the target is just not over-exposed.
    #[serde(default = "default_level")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub target_level: f64,
}

fn default_level() -> f64 {
    1.0
}

/// Motion of the camera on a circular orbit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionTable {
    /// Objects that are at rest in the image.
    pub guidance: MotionGuidance,
    /// Semi-major axis of the orbit, km, 6500 to 100000; the mean motion smears objects that are not at rest.
    #[schemars(range(min = 6500, max = 100000))]
    pub semi_major_axis_km: f64,
}

/// Objects that are at rest in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionGuidance {
    /// Stars are at rest; a target along the orbit drifts.
    Inertial,
    /// A target ahead along the orbit is at rest; the stars drift along the rows.
    LocalOrbital,
}

/// Directions and times of the observations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SkyTable {
    /// Number of boresights over the whole sky, each representing an equal area, 100 to 1000000.
    #[schemars(range(min = 100, max = 1000000))]
    pub pointings: u32,
    /// Times of the observations.
    pub when: SkyTime,
    /// Smallest angle to the Sun at which a pointing counts, degrees, 0 to 180.
    #[schemars(range(min = 0, max = 180))]
    pub sun_exclusion_deg: f64,
    /// Smallest angle to the Moon at which a pointing counts, degrees, 0 to 180.
    #[schemars(range(min = 0, max = 180))]
    pub moon_exclusion_deg: f64,
    /// Smallest angle to the limb of the Earth at which a pointing counts, degrees, 0 to 180. With inertial
    /// guidance the camera waits until the Earth is behind it.
    #[schemars(range(min = 0, max = 180))]
    pub earth_exclusion_deg: f64,
}

impl Default for SkyTable {
    fn default() -> Self {
        Self {
            pointings: 10_000,
            when: SkyTime::Year { year: 2012 },
            sun_exclusion_deg: 0.0,
            moon_exclusion_deg: 0.0,
            earth_exclusion_deg: 0.0,
        }
    }
}

/// Times of the observations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum SkyTime {
    /// A single epoch.
    Epoch {
        /// Epoch, UTC, as in 2012-04-26T12:00:00Z.
        utc: String,
    },
    /// A whole year: each pointing has a different time, evenly spread.
    Year {
        /// Year, 1980 to 2040.
        #[schemars(range(min = 1980, max = 2040))]
        year: i32,
    },
}

/// Target of the camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetTable {
    /// Target body; absent: that of the scenario.
    pub body: Option<TargetConfig>,
    /// Illumination of the body by the Sun.
    pub light: TargetLight,
    /// Nearest and farthest range of the curves, km, in ascending order, 0.01 to 1e5.
    #[schemars(inner(range(min = 0.01, max = 1e5)))]
    pub ranges_km: [f64; 2],
}

/// Illumination of the body by the Sun, and its attitude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TargetLight {
    /// Given phase angles, at 1 au, outside any shadow; a body of plates or a mesh in any attitude, all
    /// equally likely.
    Phases {
        /// Angles Sun–target–camera, degrees, in ascending order, 0 to 170.
        #[schemars(length(min = 1, max = 50), inner(range(min = 0, max = 170)))]
        phases_deg: Vec<f64>,
        /// Number of attitudes of a body of plates or a mesh, 1 to 1000.
        #[serde(default = "attitudes")]
        #[schemars(range(min = 1, max = 1000))]
        attitudes: u32,
    },
    /// Illumination along the orbit of the scenario, at times spread over its schedule, with the attitude
    /// that the scenario gives the body; the camera is purely along the track, behind or ahead as in the
    /// scenario. Times in the Earth's shadow do not count.
    Orbit {
        /// Number of times, 1 to 1000.
        #[schemars(range(min = 1, max = 1000))]
        moments: u32,
    },
}

fn attitudes() -> u32 {
    64
}

/// Confirmation of results by simulation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConfirmTable {
    /// Number of frames simulated for each result, 0 to 100000; 0: no simulation.
    #[schemars(range(min = 0, max = 100000))]
    pub frames: u32,
    /// Confidence of the one-sided bounds of simulated rates, 0.5 to 0.9999.
    #[schemars(range(min = 0.5, max = 0.9999))]
    pub confidence: f64,
}

impl Default for ConfirmTable {
    fn default() -> Self {
        Self { frames: 200, confidence: 0.95 }
    }
}

/// A requirement on the camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Unique name of the requirement, as in REQ-STAR-01.
    pub id: String,
    /// Text of the requirement.
    pub text: String,
    /// Demand of the requirement.
    pub demand: Demand,
    /// Parameter to find that meets the requirement; absent: the given camera is verified.
    pub find: Option<FindTable>,
}

/// Demand on a camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Demand {
    /// At least a number of stars is detected, with a probability, over the sky or at every pointing.
    Stars {
        /// Number of stars, 1 to 1000; absent: that of the file.
        #[schemars(range(min = 1, max = 1000))]
        n_min: Option<u32>,
        /// Probability; absent: that of the file.
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        probability: Option<f64>,
        /// Exposure, s; absent: the nominal one.
        #[schemars(range(min = 1e-6, max = 1000))]
        exposure_s: Option<f64>,
        /// Meaning of the probability: over the whole sky together, or at each pointing.
        #[serde(default)]
        over: SkyStatistic,
    },
    /// A star of a given magnitude, with the mean colour of the catalogue, is detected with a probability.
    LimitingMagnitude {
        /// Johnson V magnitude, −2 to 15.
        #[schemars(range(min = -2, max = 15))]
        magnitude: f64,
        /// Probability; absent: that of the file.
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        probability: Option<f64>,
        /// Exposure, s; absent: the nominal one.
        #[schemars(range(min = 1e-6, max = 1000))]
        exposure_s: Option<f64>,
    },
    /// The target is detected with a probability at every range and phase angle of an interval.
    TargetDetected {
        /// Nearest range, km.
        #[schemars(range(min = 0.01, max = 1e5))]
        from_km: f64,
        /// Farthest range, km.
        #[schemars(range(min = 0.01, max = 1e5))]
        to_km: f64,
        /// Largest phase angle, degrees, 0 to 180; absent: all phase angles of the target's light.
        #[schemars(range(min = 0, max = 180))]
        phase_max_deg: Option<f64>,
        /// Probability; absent: that of the file.
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        probability: Option<f64>,
        /// Exposure, s; absent: the nominal one.
        #[schemars(range(min = 1e-6, max = 1000))]
        exposure_s: Option<f64>,
    },
    /// At every range of an interval there is an exposure that does not over-expose the target and that
    /// detects enough stars, each with a probability.
    ExposureWindow {
        /// Nearest range, km.
        #[schemars(range(min = 0.01, max = 1e5))]
        from_km: f64,
        /// Farthest range, km.
        #[schemars(range(min = 0.01, max = 1e5))]
        to_km: f64,
        /// Largest phase angle, degrees, 0 to 180; absent: all phase angles of the target's light.
        #[schemars(range(min = 0, max = 180))]
        phase_max_deg: Option<f64>,
        /// Number of stars; absent: that of the file.
        #[schemars(range(min = 1, max = 1000))]
        n_min: Option<u32>,
        /// Probability; absent: that of the file.
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        probability: Option<f64>,
    },
}

/// Meaning of a probability over the sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SkyStatistic {
    /// Probability for a boresight that is uniformly distributed over the sky.
    #[default]
    Sky,
    /// Probability for every boresight, including the worst.
    EveryPointing,
}

/// Search for a parameter value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FindTable {
    /// Parameter to find.
    pub parameter: Parameter,
    /// Choice among the values that meet the requirement; absent: the smallest exposure and aperture, and the
    /// shortest focal length (the widest field).
    #[serde(default)]
    pub want: Extreme,
    /// Smallest value of the search, in the parameter's unit.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub from: f64,
    /// Largest value of the search, in the parameter's unit.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub to: f64,
}

/// Parameter of a camera that can be searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Exposure, s.
    ExposureS,
    /// Diameter of the aperture, mm.
    ApertureDiameterMm,
    /// Focal length, mm; the size of the point-spread function in pixels does not change.
    FocalLengthMm,
}

impl Parameter {
    /// Returns name and unit of the parameter.
    pub fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Self::ExposureS => ("exposure", "s"),
            Self::ApertureDiameterMm => ("aperture", "mm"),
            Self::FocalLengthMm => ("focal length", "mm"),
        }
    }
}

/// Choice among the values that meet a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Extreme {
    /// The smallest value.
    #[default]
    Smallest,
    /// The largest value.
    Largest,
}

impl RequirementFile {
    /// Checks every number, and the conditions between several numbers.
    ///
    /// # Errors
    /// The first value that is not allowed.
    pub(crate) fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        let ExposureTable { nominal_s, min_s, max_s, .. } = self.exposure;
        require("exposure.min_s", min_s, "1e-6 to exposure.max_s", |v| v <= max_s)?;
        self.check_exposure("exposure.nominal_s", Some(nominal_s))?;
        if let DetectionRule::Sigmas { low, high } = self.detection {
            require("detection.low", low, "0 to detection.high", |v| v <= high)?;
        }
        self.target.as_ref().map_or(Ok(()), TargetTable::check)?;
        let mut ids: Vec<&str> = Vec::new();
        for (i, requirement) in self.requirements.iter().enumerate() {
            let at = format!("requirements[{i}]");
            if requirement.id.trim().is_empty() || ids.contains(&requirement.id.as_str()) {
                let value = format!("`{}`", requirement.id);
                return Err(OutOfRange::new(format!("{at}.id"), value, "a unique name"));
            }
            ids.push(&requirement.id);
            self.check_demand(requirement, &at)?;
        }
        Ok(())
    }

    fn check_demand(&self, requirement: &Requirement, at: &str) -> Result<(), OutOfRange> {
        match requirement.demand {
            Demand::Stars { exposure_s, .. } | Demand::LimitingMagnitude { exposure_s, .. } => {
                self.check_exposure(&format!("{at}.demand.exposure_s"), exposure_s)?;
            }
            Demand::TargetDetected { from_km, to_km, exposure_s, .. } => {
                self.check_ranges(at, from_km, to_km)?;
                self.check_exposure(&format!("{at}.demand.exposure_s"), exposure_s)?;
            }
            Demand::ExposureWindow { from_km, to_km, .. } => self.check_ranges(at, from_km, to_km)?,
        }
        let Some(FindTable { parameter, from, to, want: _ }) = requirement.find else { return Ok(()) };
        let path = |field: &str| format!("{at}.find.{field}");
        let (limit, expected) = match parameter {
            Parameter::ExposureS => ([1e-6, 1000.0], "1e-6 to 1000 s"),
            Parameter::ApertureDiameterMm => ([0.01, 10_000.0], "0.01 to 10000 mm"),
            Parameter::FocalLengthMm => ([0.01, 1e6], "0.01 to 1e6 mm"),
        };
        require(path("from"), from, expected, |v| (limit[0]..=limit[1]).contains(&v))?;
        require(path("to"), to, "more than `from`, within the parameter's range", |v| {
            v > from && v <= limit[1]
        })?;
        let by_exposure = parameter == Parameter::ExposureS;
        if by_exposure && matches!(requirement.demand, Demand::ExposureWindow { .. }) {
            let expected = "another parameter: this requirement already varies the exposure";
            return Err(OutOfRange::new(path("parameter"), "\"exposure_s\"", expected));
        }
        Ok(())
    }

    fn check_exposure(&self, path: &str, exposure_s: Option<f64>) -> Result<(), OutOfRange> {
        let ExposureTable { min_s, max_s, .. } = self.exposure;
        exposure_s.map_or(Ok(()), |exposure_s| {
            require(path, exposure_s, "exposure.min_s to exposure.max_s", |v| (min_s..=max_s).contains(&v))
        })
    }

    fn check_ranges(&self, at: &str, from_km: f64, to_km: f64) -> Result<(), OutOfRange> {
        if self.target.is_none() {
            let expected = "the table [target] in the file";
            return Err(OutOfRange::new(format!("{at}.demand.kind"), "about a target", expected));
        }
        require(format!("{at}.demand.to_km"), to_km, "demand.from_km to 1e5", |v| v >= from_km)
    }
}

impl TargetTable {
    fn check(&self) -> Result<(), OutOfRange> {
        let [near, far] = self.ranges_km;
        require("target.ranges_km[1]", far, "a second number above the first, at most 1e5", |v| v > near)?;
        match &self.light {
            TargetLight::Phases { phases_deg, .. } if !phases_deg.is_sorted_by(|a, b| a < b) => {
                Err(OutOfRange::new("target.light.phases_deg", "not ascending", "ascending angles"))
            }
            TargetLight::Phases { .. } | TargetLight::Orbit { .. } => Ok(()),
        }
    }
}
