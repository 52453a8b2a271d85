//! Sensor file: a [sensor] table of a camera or scenario.

use std::path::Path;

use config::toml_file;
use files::{Failure, FileError};
use sensor_fit::{Finding, SensorFigures};
use serde::{Deserialize, Serialize};
use sim::sensor::SensorConfig;

use super::sensor_text::finding_text;

/// Content of a sensor file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SensorTables {
    sensor: SensorConfig,
}

/// A sensor with the text that it was read from.
#[derive(Debug, Clone)]
pub(super) struct SensorSource {
    /// Sensor.
    pub(super) sensor: SensorConfig,
    text: String,
}

impl SensorSource {
    /// Reads a sensor file.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first mistake.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let text = toml_file::read_text(path).map_err(|source| FileError::io(path, "read", source))?;
        let SensorTables { sensor } = toml_file::parse(path, &text)?;
        sensor.check().map_err(|error| Failure::from(toml_file::out_of_range(path, &text, &error)))?;
        Ok(Self { sensor, text })
    }

    /// Returns the tables with another light of the sky, with the comments of the file where possible.
    pub(super) fn tables(&self, background_e_per_s: f64, origin: &str) -> Result<String, Failure> {
        let key = "background_e_per_s";
        let line = format!("{key} = {background_e_per_s:.4} # {origin}");
        let is_key = |text: &&str| {
            text.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='))
        };
        if self.text.lines().filter(is_key).count() == 1 {
            let lines = self.text.lines().map(|text| if is_key(&text) { line.as_str() } else { text });
            return Ok(lines.collect::<Vec<_>>().join("\n"));
        }
        let tables = SensorTables { sensor: SensorConfig { background_e_per_s, ..self.sensor.clone() } };
        toml::to_string(&tables).map_err(|error| Failure::Usage(format!("--sensor: {error}")))
    }
}

/// A value of the file with the comment of its origin.
fn value_line(key: &str, finding: &Finding, otherwise: f64, remark: &str) -> String {
    let (value, origin) = match finding {
        Finding::Value { value, .. } => (*value, finding_text(finding)),
        Finding::Below(limit) => (otherwise, format!("assumed; not seen: below {limit:.2e}")),
        Finding::Missing(reason) => (otherwise, format!("assumed: not determined, {reason}")),
    };
    format!("{key} = {} # {origin}{remark}\n", number(value))
}

/// Returns a number of seven digits as TOML has it.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}

/// Returns a sensor file with the origin of each value in a comment.
///
/// # Errors
/// [`Failure::Usage`] if a figure is outside the range that the simulator takes.
pub(super) fn sensor_toml(figures: &SensorFigures) -> Result<String, Failure> {
    let (bits, is_seen) = figures.bit_depth;
    // The end of the converter stands for a full well that no frame shows.
    let end_e = figures.end_e.unwrap_or(1e5);
    let half = |finding: &Finding| if let Finding::Below(limit) = finding { 0.5 * limit } else { 0.0 };
    let mut text = format!(
        "# Sensor measured from bias, dark and flat frames ({} stacks). ± is one standard deviation.\n\
         [sensor]\n\
         bit_depth = {bits} # {}\n",
        figures.levels.len(),
        if is_seen { "a level reaches the largest number" } else { "assumed: of the files" },
    );
    text.push_str(&value_line("gain_e_per_dn", &figures.gain_e_per_dn, 1.0, ", photon transfer"));
    text.push_str(&value_line("bias_dn", &figures.bias_dn, 0.0, ""));
    text.push_str(&value_line("full_well_e", &figures.full_well_e, end_e, ""));
    text.push_str(&value_line(
        "read_noise_e",
        &figures.read_noise_e,
        half(&figures.read_noise_e),
        ", of a pixel",
    ));
    text.push_str(&value_line(
        "dark_current_e_per_s",
        &figures.dark_current_e_per_s,
        0.0,
        ", at the temperature of the frames",
    ));
    text.push_str("background_e_per_s = 0.0 # assumed: light of the sky, not of the sensor\n");
    text.push_str(&value_line("non_linearity", &figures.non_linearity, 0.0, ", at the full well above"));
    text.push_str("frame_transfer_s = 0.0 # assumed: uniform frames do not show smear\n");
    text.push_str("\n[sensor.line_noise]\n");
    text.push_str(&value_line("row_e", &figures.row_noise_e, 0.0, ""));
    text.push_str(&value_line("column_e", &figures.column_noise_e, 0.0, ""));
    text.push_str(&fixed_pattern(figures));
    text.push_str(&hot_pixels(figures));
    let tables: SensorTables =
        toml::from_str(&text).map_err(|error| Failure::Usage(format!("--out: {error}")))?;
    tables.sensor.check().map_err(|error| {
        Failure::Usage(format!("--out: the simulator does not take a figure of this sensor: {error}"))
    })?;
    Ok(text)
}

fn fixed_pattern(figures: &SensorFigures) -> String {
    let mut text =
        "\n[sensor.fixed_pattern]\nseed = 1 # assumed: any detector with these figures\n".to_owned();
    text.push_str(&value_line("prnu_fraction", &figures.prnu_fraction, 0.0, ""));
    let dark = figures.dark_current_e_per_s.value();
    let relative = match (&figures.dark_current_spread_e_per_s, dark) {
        (Finding::Value { value, sigma }, Some(dark)) => {
            Finding::Value { value: value / dark, sigma: sigma / dark }
        }
        (Finding::Below(limit), Some(dark)) => Finding::Below(limit / dark),
        (Finding::Missing(reason), _) => Finding::Missing(reason.clone()),
        (_, None) => Finding::Missing("needs a dark current".to_owned()),
    };
    text.push_str(&value_line("dsnu_fraction", &relative, 0.0, ", of the dark current"));
    text.push_str(&value_line("column_offset_e", &figures.column_offset_e, 0.0, ""));
    let defects = &figures.defects;
    for (key, count) in [("dead_pixels", defects.dead), ("dead_columns", defects.dead_columns)] {
        let origin = if count.is_some() { "counted" } else { "assumed: not determined without flats" };
        text.push_str(&format!("{key} = {} # {origin}\n", count.unwrap_or(0)));
    }
    text
}

fn hot_pixels(figures: &SensorFigures) -> String {
    let defects = &figures.defects;
    let mut text = "\n[sensor.hot_pixels]\n".to_owned();
    match (defects.hot, defects.hot_currents) {
        (Some(count), Some(hot)) => text.push_str(&format!(
            "count = {count} # counted, from {:.0} e-/s on\nseed = 1 # assumed\nmedian_e_per_s = {} # of those counted\n\
             spread = {} # of those counted\n",
            hot.threshold_e_per_s,
            number(hot.median_e_per_s),
            number(hot.spread.min(5.0)),
        )),
        (count, _) => text.push_str(&format!(
            "count = 0 # {}\nseed = 1 # assumed\nmedian_e_per_s = 0.0\nspread = 0.0\n",
            if count.is_some() { "none found" } else { "assumed: not determined without dark frames" }
        )),
    }
    text
}
