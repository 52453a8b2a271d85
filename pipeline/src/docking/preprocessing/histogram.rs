//! Brightness histogram of a region, and the digitiser setting derived from it.

use contract::docking::Digitiser;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::region::Rectangle;
use super::view::View;

/// Histogram of the grey values of a region, with 256 levels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Histogram {
    counts: [u32; 256],
    total: u32,
}

impl Histogram {
    /// Counts the pixels inside `region`, at most about 50 000 of them.
    pub(crate) fn from_region(view: &View<'_>, region: &Rectangle) -> Self {
        let clamp = |v: f64, n: usize| v.clamp(0.0, n as f64) as usize;
        let columns = clamp(region.first_column.ceil(), view.columns())
            ..clamp(region.last_column.floor() + 1.0, view.columns());
        let rows = clamp(view.image_row(region.first_row).ceil(), view.rows())
            ..clamp(view.image_row(region.last_row).floor() + 1.0, view.rows());
        let stride = (columns.len() * rows.len() / 50_000).max(1);
        let mut histogram = Self { counts: [0; 256], total: 0 };
        for row in rows {
            // The start changes with the row, so the stride does not select a fixed set of columns.
            let first = columns.start + row % stride;
            for level in view.line(row, first..columns.end, stride) {
                histogram.counts[usize::from(level as u8)] += 1;
            }
        }
        histogram.total = histogram.counts.iter().sum();
        histogram
    }

    /// Returns the grey level that a share of the pixels does not exceed; 0 for an empty region.
    pub(crate) fn quantile(&self, share: f64) -> f64 {
        let wanted = share * f64::from(self.total);
        let mut below = 0.0;
        for (level, &count) in self.counts.iter().enumerate() {
            below += f64::from(count);
            if below >= wanted && below > 0.0 {
                return level as f64;
            }
        }
        0.0
    }

    /// Returns the share of the pixels at full scale.
    pub(crate) fn saturated_share(&self) -> f64 {
        f64::from(self.counts[255]) / f64::from(self.total.max(1))
    }

    /// Returns the share of the pixels at zero.
    pub(crate) fn clipped_share(&self) -> f64 {
        f64::from(self.counts[0]) / f64::from(self.total.max(1))
    }
}

/// Automatic contrast and brightness of the digitiser.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AutoContrastConfig {
    /// Mode: `adjust` the digitiser, or `leave` it unchanged.
    pub mode: AutoContrastMode,
    /// Desired level of the region's darkest hundredth, share of full scale, 0 to 0.4.
    #[schemars(range(min = 0, max = 0.4))]
    pub dark_level: f64,
    /// Desired level of the region's brightest fiftieth, share of full scale, 0.5 to 0.95.
    #[schemars(range(min = 0.5, max = 0.95))]
    pub bright_level: f64,
    /// Tolerated deviation from the two levels, share of full scale, 0.01 to 0.3.
    #[schemars(range(min = 0.01, max = 0.3))]
    pub tolerance: f64,
    /// Largest requested contrast, 0.1 to 20. Noise increases with contrast.
    #[schemars(range(min = 0.1, max = 20))]
    pub max_contrast: f64,
}

/// Mode of the automatic contrast.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoContrastMode {
    /// The levels are adjusted to their desired values.
    #[default]
    Adjust,
    /// The digitiser remains unchanged.
    Leave,
}

impl Default for AutoContrastConfig {
    fn default() -> Self {
        Self {
            mode: AutoContrastMode::Adjust,
            dark_level: 0.06,
            bright_level: 0.80,
            tolerance: 0.10,
            max_contrast: 6.0,
        }
    }
}

impl AutoContrastConfig {
    /// Returns the setting that brings the region's levels to their desired values. Returns `None` when the
    /// setting is good, or when the region has no contrast. Each request makes half of the change, so the
    /// loop remains stable with a lag of a field or two.
    pub(crate) fn recommend(&self, histogram: &Histogram, now: &Digitiser) -> Option<Digitiser> {
        if self.mode == AutoContrastMode::Leave || now.check().is_err() {
            return None;
        }
        let dark = histogram.quantile(0.01) / View::WHITE;
        let bright = histogram.quantile(0.98) / View::WHITE;
        // Clipped levels only determine the direction of the change.
        let (clipped_low, clipped_high) =
            (histogram.clipped_share() > 0.02, histogram.saturated_share() > 0.02);
        let good = |level: f64, wanted: f64| (level - wanted).abs() <= self.tolerance;
        if !clipped_low && !clipped_high && good(dark, self.dark_level) && good(bright, self.bright_level) {
            return None;
        }
        // Signal levels, by the inverse of DN = contrast × signal + brightness.
        let signal = |level: f64| (level - now.brightness) / now.contrast;
        let low = signal(dark) - if clipped_low { 0.1 / now.contrast } else { 0.0 };
        let high = signal(bright) + if clipped_high { 0.25 / now.contrast } else { 0.0 };
        if high - low < 1e-6 {
            return None;
        }
        let contrast = ((self.bright_level - self.dark_level) / (high - low)).clamp(0.1, self.max_contrast);
        let contrast = now.contrast + 0.5 * (contrast - now.contrast);
        // Brings the mean of the two levels to its desired value at the requested contrast.
        let wanted = (self.dark_level + self.bright_level) / 2.0 - contrast * (low + high) / 2.0;
        let brightness = (now.brightness + 0.5 * (wanted - now.brightness)).clamp(-10.0, 10.0);
        let moved =
            (contrast / now.contrast - 1.0).abs() > 0.01 || (brightness - now.brightness).abs() > 0.005;
        let digitiser = Digitiser { contrast, brightness };
        (moved && digitiser.check().is_ok()).then_some(digitiser)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Frame;
    use contract::docking::{Field, Lines};

    /// Returns a digitised image whose signal is a ramp from `low` to `high`.
    fn ramp(low: f64, high: f64, digitiser: &Digitiser) -> Field {
        let (columns, rows) = (200, 100);
        let dn = (0..columns * rows)
            .map(|i| {
                let signal = low + (high - low) * (i % columns) as f64 / (columns - 1) as f64;
                let level = digitiser.contrast * signal + digitiser.brightness;
                (255.0 * level).round().clamp(0.0, 255.0) as u16
            })
            .collect();
        Field::new(Frame::new(0, columns, rows, 8, dn, None).unwrap(), Lines::All, rows).unwrap()
    }

    fn settle(low: f64, high: f64) -> (Vec<Digitiser>, f64, f64) {
        let config = AutoContrastConfig::default();
        let mut settings = vec![Digitiser::default()];
        for _ in 0..40 {
            let now = *settings.last().unwrap();
            let field = ramp(low, high, &now);
            let histogram = Histogram::from_region(&View::new(&field), &Rectangle::ALL);
            match config.recommend(&histogram, &now) {
                Some(wish) => settings.push(wish),
                None => {
                    return (settings, histogram.quantile(0.01) / 255.0, histogram.quantile(0.98) / 255.0);
                }
            }
        }
        panic!("the loop does not settle: {settings:?}");
    }

    #[test]
    fn the_loop_settles_at_the_requested_levels() {
        let config = AutoContrastConfig::default();
        for (low, high) in [(0.02, 0.25), (0.1, 0.95), (0.3, 1.3), (0.5, 0.9), (0.0, 0.15)] {
            let (settings, dark, bright) = settle(low, high);
            assert!(settings.len() < 30, "{low} to {high}: {settings:?}");
            assert!((dark - config.dark_level).abs() <= config.tolerance, "{low} to {high}: dark at {dark}");
            assert!((bright - config.bright_level).abs() <= config.tolerance, "{low}, {high}: {bright}");
        }
    }

    #[test]
    fn no_setting_is_requested_in_a_flat_field_or_if_disabled() {
        let flat = ramp(0.3, 0.3, &Digitiser::default());
        let histogram = Histogram::from_region(&View::new(&flat), &Rectangle::ALL);
        assert_eq!(AutoContrastConfig::default().recommend(&histogram, &Digitiser::default()), None);
        let dim = ramp(0.0, 0.1, &Digitiser::default());
        let histogram = Histogram::from_region(&View::new(&dim), &Rectangle::ALL);
        let leave = AutoContrastConfig { mode: AutoContrastMode::Leave, ..Default::default() };
        assert_eq!(leave.recommend(&histogram, &Digitiser::default()), None);
    }

    #[test]
    fn quantiles_of_a_ramp_are_its_levels() {
        let field = ramp(0.0, 1.0, &Digitiser::default());
        let histogram = Histogram::from_region(&View::new(&field), &Rectangle::ALL);
        assert!((histogram.quantile(0.5) - 127.0).abs() <= 2.0);
        assert_eq!(histogram.quantile(1.0), 255.0);
    }

    #[test]
    fn a_region_outside_the_image_is_empty() {
        let field = ramp(0.0, 1.0, &Digitiser::default());
        let far = Rectangle::square(PixelPoint::new(1e6, 1e6), 10.0);
        assert_eq!(Histogram::from_region(&View::new(&field), &far).quantile(0.5), 0.0);
    }

    use contract::PixelPoint;
}
