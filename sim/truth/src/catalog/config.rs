//! Catalogue settings of a scenario.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use contract::{OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Selection of the stars that a scenario draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CatalogConfig {
    /// `hipparcos2` for the embedded Hipparcos-2 (the default), or the path of a file: hip2.dat (CDS I/311),
    /// hip_main.dat (CDS I/239) or a CSV file with named columns. A relative path starts at the scenario.
    #[serde(default)]
    pub source: CatalogSource,
    /// Faintest star drawn, Johnson V, mag, −2 to 30; without a limit all stars are drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -2, max = 30))]
    pub magnitude_limit: Option<f64>,
    /// Cone of the drawn stars; absent: the whole sky.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cone: Option<ConeConfig>,
}

/// Circle on the sky at the catalogue's epoch, J1991.25, including its boundary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeConfig {
    /// Right ascension of the centre, ICRS, degrees, 0 to 360.
    #[schemars(range(min = 0, max = 360))]
    pub ra_deg: f64,
    /// Declination of the centre, ICRS, degrees, −90 to 90.
    #[schemars(range(min = -90, max = 90))]
    pub dec_deg: f64,
    /// Angular radius, degrees, 0 to 180.
    #[schemars(range(min = 0, max = 180))]
    pub radius_deg: f64,
}

/// Source of the stars, written as one string in a file.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum CatalogSource {
    /// The embedded Hipparcos-2.
    #[default]
    Hipparcos2,
    /// Catalogue file of the user.
    File(String),
}

const HIPPARCOS2: &str = "hipparcos2";

impl From<String> for CatalogSource {
    fn from(text: String) -> Self {
        if text == HIPPARCOS2 { Self::Hipparcos2 } else { Self::File(text) }
    }
}

impl From<CatalogSource> for String {
    fn from(source: CatalogSource) -> Self {
        match source {
            CatalogSource::Hipparcos2 => HIPPARCOS2.to_owned(),
            CatalogSource::File(path) => path,
        }
    }
}

// Written by hand: the derive cannot express that the enum is one string in a file.
impl JsonSchema for CatalogSource {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CatalogSource".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string", "minLength": 1 })
    }
}

impl CatalogConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        if self.source == CatalogSource::File(String::new()) {
            return Err(OutOfRange::new("catalog.source", "empty", "`hipparcos2` or the path of a file"));
        }
        bounds::check(self, "catalog")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone(ra_deg: f64, dec_deg: f64, radius_deg: f64) -> CatalogConfig {
        CatalogConfig { cone: Some(ConeConfig { ra_deg, dec_deg, radius_deg }), ..CatalogConfig::default() }
    }

    #[test]
    fn a_number_outside_its_range_is_named() {
        let message = |config: CatalogConfig| config.check().unwrap_err().to_string();
        assert!(message(cone(361.0, 0.0, 1.0)).contains("catalog.cone.ra_deg is 361"));
        assert!(message(cone(0.0, f64::NAN, 1.0)).contains("catalog.cone.dec_deg is NaN"));
        assert!(message(cone(0.0, 0.0, -1.0)).contains("catalog.cone.radius_deg is -1"));
        let limit = CatalogConfig { magnitude_limit: Some(99.0), ..CatalogConfig::default() };
        assert!(message(limit).contains("catalog.magnitude_limit is 99"));
        let source = CatalogConfig { source: CatalogSource::File(String::new()), ..CatalogConfig::default() };
        assert!(message(source).contains("catalog.source"));
    }

    #[test]
    fn a_scenario_may_state_none_some_or_all_keys() {
        let read = |text: &str| serde_json::from_str::<CatalogConfig>(text);
        assert_eq!(read("{}").unwrap(), CatalogConfig::default());
        let text = r#"{"source":"mine.csv","magnitude_limit":6.5,"cone":{"ra_deg":1.0,"dec_deg":2.0,"radius_deg":3.0}}"#;
        let config = read(text).unwrap();
        assert_eq!(config.source, CatalogSource::File("mine.csv".to_owned()));
        assert_eq!(serde_json::to_string(&config).unwrap(), text);
        assert!(read(r#"{"magnitude":6.5}"#).is_err());
    }

    #[test]
    fn the_source_is_one_string() {
        for (text, source) in [
            ("hipparcos2", CatalogSource::Hipparcos2),
            ("stars/mine.csv", CatalogSource::File("stars/mine.csv".to_owned())),
        ] {
            assert_eq!(CatalogSource::from(text.to_owned()), source);
            assert_eq!(String::from(source), text);
        }
    }
}
