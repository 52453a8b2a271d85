//! Shutter control: the exposure time as a function of the brightest object, without memory.

use contract::OutOfRange;
use contract::bounds::{self, require};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Method of choosing the exposure time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum ShutterConfig {
    /// Constant exposure time.
    Fixed {
        /// Exposure time, s, 1e-6 to 1000.
        #[schemars(range(min = 1e-6, max = 1000))]
        exposure_s: f64,
    },
    /// Exposure time that is reduced as the brightest object grows, so that its over-exposure does not exceed
    /// a level.
    Automatic {
        /// Shortest exposure time, s, 1e-6 to `max_s`.
        #[schemars(range(min = 1e-6, max = 1000))]
        min_s: f64,
        /// Longest exposure time, s, up to 1000.
        #[schemars(range(min = 1e-6, max = 1000))]
        max_s: f64,
        /// Level that the brightest object's peak pixel may reach, as a fraction of saturation, above 0, at
        /// most 1000. With a level above 1 the object may be over-exposed by that factor before the exposure
        /// time is reduced.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
        target_level: f64,
        /// Ratio of neighbouring exposure times of the ladder that the camera can command, 1.001 to 100.
        #[schemars(range(min = 1.001, max = 100))]
        step_factor: f64,
        /// Age of the brightness to which the control responds, s, 0 to 1e5.
        #[schemars(range(min = 0, max = 1e5))]
        lag_s: f64,
    },
}

impl ShutterConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "shutter")?;
        match *self {
            Self::Fixed { .. } => Ok(()),
            Self::Automatic { min_s, max_s, .. } => {
                require("shutter.min_s", min_s, "1e-6 to shutter.max_s", |v| v <= max_s)
            }
        }
    }
}

/// Shutter control without memory. A real control acts on an earlier measurement; this control receives the
/// brightness at the time of the frame minus [`Shutter::lag_s`], so that any frame can be computed
/// independently.
#[derive(Debug, Clone, PartialEq)]
pub struct Shutter {
    config: ShutterConfig,
    saturation_e: f64,
}

impl Shutter {
    /// Creates the control of a camera whose pixels saturate at `saturation_e` electrons.
    ///
    /// # Errors
    /// [`OutOfRange`] for a number out of range.
    pub fn new(config: &ShutterConfig, saturation_e: f64) -> Result<Self, OutOfRange> {
        config.check()?;
        require("sensor.bias_dn", saturation_e, "below full scale (value: electrons at saturation)", |v| {
            v > 0.0
        })?;
        Ok(Self { config: config.clone(), saturation_e })
    }

    /// Time before a frame at which the brightness is measured, s; 0 for a fixed exposure.
    pub fn lag_s(&self) -> f64 {
        match self.config {
            ShutterConfig::Fixed { .. } => 0.0,
            ShutterConfig::Automatic { lag_s, .. } => lag_s,
        }
    }

    /// Longest exposure time that the control may choose, s.
    pub fn longest_s(&self) -> f64 {
        match self.config {
            ShutterConfig::Fixed { exposure_s } => exposure_s,
            ShutterConfig::Automatic { max_s, .. } => max_s,
        }
    }

    /// Shortest exposure time that the control may choose, s.
    pub fn shortest_s(&self) -> f64 {
        match self.config {
            ShutterConfig::Fixed { exposure_s } => exposure_s,
            ShutterConfig::Automatic { min_s, .. } => min_s,
        }
    }

    /// Refuses exposures longer than `interval_s`, the time from one frame to the next: exposures cannot
    /// overlap.
    ///
    /// # Errors
    /// [`OutOfRange`] for the longest exposure.
    pub fn check_interval(&self, interval_s: f64) -> Result<(), OutOfRange> {
        let path = match self.config {
            ShutterConfig::Fixed { .. } => "shutter.exposure_s",
            ShutterConfig::Automatic { .. } => "shutter.max_s",
        };
        let expected =
            format!("at most the shortest time from one frame to the next, {interval_s} s (schedule)");
        require(path, self.longest_s(), expected, |v| v <= interval_s)
    }

    /// Exposure time, s, for the expected electrons per second in the peak pixel of the brightest object in
    /// the field at the time that the control uses; `None` if there is no object.
    ///
    /// It is the longest of the ladder max_s/factor^n that keeps the peak at or below its level, within
    /// [min_s, max_s].
    pub fn exposure_s(&self, peak_rate_e_per_s: Option<f64>) -> f64 {
        match self.config {
            ShutterConfig::Fixed { exposure_s } => exposure_s,
            ShutterConfig::Automatic { min_s, max_s, target_level, step_factor, .. } => {
                let rate = peak_rate_e_per_s.unwrap_or(0.0);
                // Zero flux and NaN select the longest exposure.
                let over_exposed = rate * max_s > target_level * self.saturation_e;
                if !over_exposed {
                    return max_s;
                }
                let ideal_s = target_level * self.saturation_e / rate;
                let rungs = (libm::log(max_s / ideal_s) / libm::log(step_factor)).ceil();
                (max_s * libm::pow(step_factor, -rungs)).max(min_s)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn automatic() -> ShutterConfig {
        ShutterConfig::Automatic {
            min_s: 0.001,
            max_s: 1.0,
            target_level: 0.8,
            step_factor: libm::pow(2.0, 0.25),
            lag_s: 30.0,
        }
    }

    fn exposure_s(rate: f64) -> f64 {
        Shutter::new(&automatic(), 40_000.0).unwrap().exposure_s(Some(rate))
    }

    #[test]
    fn the_peak_stays_below_its_level_and_within_a_step_of_it() {
        let mut rate = 32_001.0;
        while rate < 3e7 {
            let peak = rate * exposure_s(rate);
            // Rounding of pow and log: 1e-12 of the level.
            assert!(peak <= 32_000.0 * (1.0 + 1e-12), "{rate}: {peak}");
            assert!(peak > 32_000.0 / 1.19, "{rate}: {peak}");
            rate *= 1.037;
        }
    }

    #[test]
    fn exposures_lie_on_the_ladder() {
        for rate in [4e4, 1e5, 7.7e5, 9e6] {
            let rungs = -4.0 * libm::log2(exposure_s(rate));
            assert!((rungs - rungs.round()).abs() < 1e-9, "{rungs}");
        }
    }

    #[test]
    fn the_limits_hold() {
        assert_eq!(exposure_s(0.0), 1.0);
        assert_eq!(exposure_s(100.0), 1.0);
        assert_eq!(exposure_s(1e12), 0.001);
        assert_eq!(exposure_s(f64::INFINITY), 0.001);
        assert_eq!(exposure_s(f64::NAN), 1.0);
        assert_eq!(Shutter::new(&automatic(), 4e4).unwrap().exposure_s(None), 1.0);
    }

    #[test]
    fn a_fixed_shutter_is_fixed() {
        let shutter = Shutter::new(&ShutterConfig::Fixed { exposure_s: 0.4 }, 4e4).unwrap();
        assert_eq!((shutter.exposure_s(Some(1e9)), shutter.lag_s()), (0.4, 0.0));
    }

    #[test]
    fn a_shortest_exposure_above_the_longest_is_refused() {
        let config = ShutterConfig::Automatic {
            min_s: 2.0,
            max_s: 1.0,
            target_level: 0.5,
            step_factor: 2.0,
            lag_s: 0.0,
        };
        assert!(config.check().unwrap_err().to_string().contains("shutter.min_s"));
    }
}
