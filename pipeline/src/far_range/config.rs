//! Parameters of the far-range method.

use contract::{OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attitude::AttitudeConfig;
use super::best::BestConfig;
use super::detect::Weights;
use super::hotspots::HotspotConfig;
use super::identify::IdentificationConfig;
use super::threshold::ThresholdConfig;
use super::track::TrackingConfig;

/// Parameters of the far-range method; all have defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FarRangeConfig {
    /// Method: `best`, or `paper` as published.
    pub mode: Mode,
    /// Parameters of the best mode.
    pub best: BestConfig,
    /// Thresholds I1 and I2 of detection.
    pub thresholds: ThresholdConfig,
    /// Weights of the pixels of a cluster: `intensity` as in the paper, or `above_background`.
    pub weights: Weights,
    /// Largest number of clusters kept in a frame, those of the largest weighted size, 1 to 2000. Bounds the
    /// time of linking, which increases with the cube of the number of clusters that could all be linked with
    /// each other.
    #[schemars(range(min = 1, max = 2000))]
    pub max_clusters: u32,
    /// Identification of stars.
    pub identification: IdentificationConfig,
    /// Linking of clusters from frame to frame.
    pub tracking: TrackingConfig,
    /// Hotspots of the detector.
    pub hotspots: HotspotConfig,
    /// Camera attitude from stars.
    pub attitude: AttitudeConfig,
    /// Aberration correction of the attitude from stars: `correct` or `ignore`.
    pub aberration: AberrationConfig,
    /// Longest time between two linked frames, s, above 0 to 1e9. After a longer gap, or when time does not
    /// advance, tracking starts anew.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub max_gap_s: f64,
}

/// Method of the far-range pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Attitude from prior and stars, hypotheses for the target, fitted images (docs/evidence/best-mode.md).
    #[default]
    Best,
    /// Method of the paper.
    Paper,
}

/// Treatment of aberration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AberrationConfig {
    /// Corrected by Eqs. 18 to 24.
    #[default]
    Correct,
    /// Not corrected: remains in the attitude.
    Ignore,
}

impl Default for FarRangeConfig {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            best: BestConfig::default(),
            thresholds: ThresholdConfig::default(),
            weights: Weights::default(),
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
    /// [`OutOfRange`] for the first parameter outside its range, with its path.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        self.thresholds.check()?;
        self.tracking.check()?;
        self.hotspots.check()?;
        Ok(())
    }

    /// Checks that zero suppression, which transmits pixels up to `zero_suppression_dn` as 0, affects no
    /// pixel that the pipeline uses.
    ///
    /// # Errors
    /// [`OutOfRange`] for the conflicting parameter.
    pub fn check_suppression(
        &self,
        zero_suppression_dn: Option<u16>,
        bit_depth: u8,
    ) -> Result<(), OutOfRange> {
        let Some(floor_dn) = zero_suppression_dn else { return Ok(()) };
        let refused = |path, value: &str, expected| Err(OutOfRange::new(path, value, expected));
        if self.weights == Weights::AboveBackground {
            let expected = "intensity with zero_suppression_dn, because the background is not transmitted";
            return refused("weights", "above_background", expected);
        }
        if self.mode == Mode::Best {
            let expected =
                "paper with zero_suppression_dn, because the fit also uses the faint pixels of an image";
            return refused("mode", "best", expected);
        }
        match self.thresholds {
            ThresholdConfig::Automatic { .. } => {
                let expected = "constant with zero_suppression_dn, because the background is not transmitted";
                refused("thresholds.mode", "automatic", expected)
            }
            ThresholdConfig::Constant { low, .. } => {
                let full_scale = f64::from(u32::MAX >> (32 - u32::from(bit_depth.clamp(1, 16))));
                if (low * full_scale).floor() < f64::from(floor_dn) {
                    let value = format!("{low}, {} DN", (low * full_scale).floor());
                    let expected = "zero_suppression_dn or more, because fainter pixels are transmitted as 0";
                    return refused("thresholds.low", &value, expected);
                }
                Ok(())
            }
        }
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
    fn a_threshold_below_the_suppression_is_refused_and_never_a_wrong_answer() {
        let checked = |json: &str| {
            let config = serde_json::from_str::<FarRangeConfig>(json).unwrap();
            config.check_suppression(Some(67), 12).map_err(|error| error.to_string())
        };
        let constant = |low: f64, more: &str| {
            format!(
                r#"{{"mode": "paper", "thresholds": {{"mode": "constant", "low": {low}, "high": 0.03}}{more}}}"#
            )
        };
        // Full scale is 4095: 0.0165 is 67.6 DN, so a pixel passes from 68 on.
        assert_eq!(checked(&constant(0.0165, "")), Ok(()));
        let expected = "thresholds.low is 0.016, 65 DN, expected zero_suppression_dn or more, because \
                        fainter pixels are transmitted as 0";
        assert_eq!(checked(&constant(0.016, "")), Err(expected.to_owned()));
        for (json, field) in [
            (r#"{"mode": "paper"}"#.to_owned(), "thresholds.mode is automatic"),
            (constant(0.0165, r#", "weights": "above_background""#), "weights is above_background"),
            ("{}".to_owned(), "mode is best"),
        ] {
            assert!(checked(&json).unwrap_err().starts_with(field), "{json}");
        }
        assert_eq!(FarRangeConfig::default().check_suppression(None, 12), Ok(()));
    }

    #[test]
    fn unknown_keys_are_refused() {
        assert!(serde_json::from_str::<FarRangeConfig>(r#"{"max_cluster": 3}"#).is_err());
        assert!(serde_json::from_str::<FarRangeConfig>(r#"{"tracking": {"speed": 3}}"#).is_err());
    }

    #[test]
    fn the_schema_describes_every_parameter() {
        let schema = serde_json::to_value(schemars::schema_for!(FarRangeConfig)).unwrap();
        let properties = schema["properties"].as_object().unwrap();
        assert!(properties.len() > 5, "{} parameters", properties.len());
        for (name, property) in properties {
            assert!(property["description"].is_string(), "{name} has no description");
        }
    }
}
