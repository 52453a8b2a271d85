//! All parameters of the far-range method.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attitude::{AttitudeConfig, StarWeights};
use super::centroid::CentroidConfig;
use super::detect::Weights;
use super::hotspots::HotspotConfig;
use super::identify::IdentificationConfig;
use super::threshold::ThresholdConfig;
use super::track::TrackingConfig;
use crate::PipelineError;
use crate::error::require;

/// Parameters of the far-range method; every one has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FarRangeConfig {
    /// Thresholds I1 and I2 of detection.
    pub thresholds: ThresholdConfig,
    /// What weights the pixels of a cluster: `intensity` as in the paper, or `above_background`.
    pub weights: Weights,
    /// How the centre of a cluster is measured: `brightness` as in the paper, or `fit`.
    pub centroid: CentroidConfig,
    /// Most clusters kept in a frame, those of the largest weighted size, 1 to 2000. Bounds the time of linking, which
    /// grows with the cube of the clusters that could all be linked with each other.
    pub max_clusters: u32,
    /// Identification of stars.
    pub identification: IdentificationConfig,
    /// Linking of clusters from frame to frame.
    pub tracking: TrackingConfig,
    /// Hotspots of the detector.
    pub hotspots: HotspotConfig,
    /// The camera's attitude from stars.
    pub attitude: AttitudeConfig,
    /// Whether the attitude from stars is corrected for aberration.
    pub aberration: AberrationConfig,
    /// Longest time between two frames that are linked, s, above 0 to 1e9. After a longer gap, or when time does
    /// not advance, tracking starts anew.
    pub max_gap_s: f64,
}

/// Whether aberration is corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AberrationConfig {
    /// Eqs. 18 to 24.
    #[default]
    Correct,
    /// Left in the attitude.
    Ignore,
}

impl Default for FarRangeConfig {
    fn default() -> Self {
        Self {
            thresholds: ThresholdConfig::default(),
            weights: Weights::default(),
            centroid: CentroidConfig::default(),
            max_clusters: 500,
            identification: IdentificationConfig::default(),
            tracking: TrackingConfig::default(),
            hotspots: HotspotConfig::default(),
            attitude: AttitudeConfig::default(),
            aberration: AberrationConfig::default(),
            max_gap_s: 600.0,
        }
    }
}

impl FarRangeConfig {
    /// Checks every parameter.
    ///
    /// # Errors
    /// [`PipelineError::Parameter`] for the first one outside its range, by its path.
    pub fn check(&self) -> Result<(), PipelineError> {
        self.thresholds.check()?;
        self.centroid.check()?;
        require("max_clusters", f64::from(self.max_clusters), "1 to 2000", |v| (1.0..=2000.0).contains(&v))?;
        self.identification.check()?;
        self.tracking.check()?;
        self.hotspots.check()?;
        self.attitude.check()?;
        if self.attitude.weights == StarWeights::InverseVariance
            && self.centroid == CentroidConfig::Brightness
        {
            return Err(PipelineError::Parameter {
                field: "attitude.weights",
                value: "inverse_variance".to_owned(),
                expected: "equal, unless centroid.mode is fit: a brightness centre does not know its error",
            });
        }
        require("max_gap_s", self.max_gap_s, "above 0 to 1e9", |v| v > 0.0 && v <= 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed() {
        FarRangeConfig::default().check().unwrap();
    }

    #[test]
    fn an_empty_document_is_the_defaults() {
        assert_eq!(serde_json::from_str::<FarRangeConfig>("{}").unwrap(), FarRangeConfig::default());
    }

    #[test]
    fn a_refusal_names_path_value_and_expectation() {
        let refusal = |json: &str| {
            serde_json::from_str::<FarRangeConfig>(json).unwrap().check().unwrap_err().to_string()
        };
        let expected = "attitude.filter_lambda is 1, expected 0 to below 1";
        assert_eq!(refusal(r#"{"attitude": {"filter_lambda": 1.0}}"#), expected);
        assert_eq!(refusal(r#"{"max_clusters": 0}"#), "max_clusters is 0, expected 1 to 2000");
        assert!(
            refusal(r#"{"tracking": {"weight_size": 0, "weight_displacement": 0}}"#).contains("weight_size")
        );
    }

    #[test]
    fn unknown_keys_are_refused() {
        assert!(serde_json::from_str::<FarRangeConfig>(r#"{"max_cluster": 3}"#).is_err());
        assert!(serde_json::from_str::<FarRangeConfig>(r#"{"tracking": {"speed": 3}}"#).is_err());
    }

    #[test]
    fn the_schema_describes_every_parameter() {
        let schema = serde_json::to_value(schemars::schema_for!(FarRangeConfig)).unwrap();
        for (name, property) in schema["properties"].as_object().unwrap() {
            assert!(property["description"].is_string(), "{name} has no description");
        }
    }
}
