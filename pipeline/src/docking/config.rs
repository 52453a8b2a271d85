//! Parameters of the docking method.

use contract::{OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::portions::{MotionConfig, PaperPortionConfig};
use super::preprocessing::edges::EdgeConfig;
use super::preprocessing::histogram::AutoContrastConfig;
use super::preprocessing::region::RegionConfig;

/// Parameters of the docking method; every one has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DockingConfig {
    /// Region in which the target is searched for: a window given externally, and prediction from field to
    /// field.
    pub region: RegionConfig,
    /// Automatic contrast and brightness of the digitiser.
    pub auto_contrast: AutoContrastConfig,
    /// Thresholds of the edge-based method.
    pub edges: EdgeConfig,
    /// Smallest difference between cross and plate, in 255ths of full scale, 2 to 200.
    #[schemars(range(min = 2, max = 200))]
    pub min_contrast: f64,
    /// Largest number of candidates for the cross that are examined in a field, 1 to 200.
    #[schemars(range(min = 1, max = 200))]
    pub max_candidates: u32,
    /// Number of fields in a portion, measured or not, 3 to 1000; ten in the paper.
    #[schemars(range(min = 3, max = 1000))]
    pub portion_fields: u32,
    /// Motion estimation from the poses of the best estimator.
    pub motion: MotionConfig,
    /// Motion estimation by portions, with the paper's formulas.
    pub paper_portions: PaperPortionConfig,
}

impl Default for DockingConfig {
    fn default() -> Self {
        Self {
            region: RegionConfig::default(),
            auto_contrast: AutoContrastConfig::default(),
            edges: EdgeConfig::default(),
            min_contrast: 10.0,
            max_candidates: 24,
            portion_fields: 10,
            motion: MotionConfig::default(),
            paper_portions: PaperPortionConfig::default(),
        }
    }
}

impl DockingConfig {
    /// Checks every parameter.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first parameter outside its range, with its path.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "")?;
        self.region.check()?;
        self.edges.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_are_the_empty_document() {
        DockingConfig::default().check().unwrap();
        assert_eq!(serde_json::from_str::<DockingConfig>("{}").unwrap(), DockingConfig::default());
    }

    #[test]
    fn a_refusal_names_path_value_and_expectation() {
        let refusal = |json: &str| {
            serde_json::from_str::<DockingConfig>(json).unwrap().check().unwrap_err().to_string()
        };
        assert_eq!(refusal(r#"{"min_contrast": 1.0}"#), "min_contrast is 1, expected 2 to 200");
        assert!(refusal(r#"{"edges": {"low": 200.0, "high": 100.0}}"#).contains("edges.high"));
        assert!(
            refusal(r#"{"auto_contrast": {"bright_level": 2.0}}"#).contains("auto_contrast.bright_level")
        );
        assert!(refusal(r#"{"region": {"max_gap_s": 0.0}}"#).contains("region.max_gap_s"));
    }

    #[test]
    fn unknown_keys_are_refused() {
        assert!(serde_json::from_str::<DockingConfig>(r#"{"min_contras": 3}"#).is_err());
    }

    #[test]
    fn the_schema_describes_every_parameter() {
        let schema = serde_json::to_value(schemars::schema_for!(DockingConfig)).unwrap();
        let properties = schema["properties"].as_object().unwrap();
        assert!(properties.len() > 5, "{} parameters", properties.len());
        for (name, property) in properties {
            assert!(property["description"].is_string(), "{name} has no description");
        }
    }
}
