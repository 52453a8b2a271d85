//! Figures of a sensor.

/// A figure: determined, limited, or neither.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// Value with its standard deviation.
    Value {
        /// Value.
        value: f64,
        /// Standard deviation.
        sigma: f64,
    },
    /// Too small to be seen: the value is below this limit (two standard deviations).
    Below(f64),
    /// Not determined, with the reason and the frames that would determine it.
    Missing(String),
}

impl Finding {
    pub(crate) fn missing(reason: impl Into<String>) -> Self {
        Self::Missing(reason.into())
    }

    /// Square root of a variance: a limit where the variance is below two standard deviations.
    pub(crate) fn root_of_variance([variance, sigma]: [f64; 2]) -> Self {
        if variance > 2.0 * sigma && variance > 0.0 {
            let value = variance.sqrt();
            Self::Value { value, sigma: 0.5 * sigma / value }
        } else {
            Self::Below((variance.max(0.0) + 2.0 * sigma).sqrt())
        }
    }

    /// Multiplies by a factor with a standard deviation, which is independent of the figure.
    pub(crate) fn times(self, factor: [f64; 2]) -> Self {
        match self {
            Self::Value { value, sigma } => {
                let parts = [sigma * factor[0], value * factor[1]];
                let sigma = (parts[0] * parts[0] + parts[1] * parts[1]).sqrt();
                Self::Value { value: value * factor[0], sigma }
            }
            Self::Below(limit) => Self::Below(limit * (factor[0] + 2.0 * factor[1])),
            missing @ Self::Missing(_) => missing,
        }
    }

    /// Value, if it is determined.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Value { value, .. } => Some(*value),
            _ => None,
        }
    }
}

/// Dark currents of hot pixels above that of an ordinary one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HotPixels {
    /// Median, electrons per second.
    pub median_e_per_s: f64,
    /// Standard deviation of the natural logarithm.
    pub spread: f64,
    /// Smallest excess that counts as hot, electrons per second.
    pub threshold_e_per_s: f64,
}

/// Numbers of defects.
#[derive(Debug, Clone, PartialEq)]
pub struct DefectCounts {
    /// Pixels of the sensor.
    pub pixels: usize,
    /// Pixels with a high dark current; `None` without dark frames.
    pub hot: Option<usize>,
    /// Their dark currents; `None` without dark frames, gain, or hot pixels.
    pub hot_currents: Option<HotPixels>,
    /// Pixels that respond with less than half of the mean, dead columns not included; `None` without flat
    /// frames.
    pub dead: Option<usize>,
    /// Columns of which nine tenths are dead; `None` without flat frames.
    pub dead_columns: Option<usize>,
    /// Pixels of another response than the distribution of the others has; `None` without flat frames.
    pub odd_response: Option<usize>,
    /// Pixels whose temporal noise or offset is outside of the distribution of the others.
    pub noisy: usize,
}

/// What ends the response to light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SaturationLimit {
    /// The full wells of the pixels.
    FullWell,
    /// The largest digital number of the converter.
    Converter,
}

/// Moments of a stack, as used.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelSummary {
    /// Name of the stack.
    pub name: String,
    /// Kind: `bias`, `dark` or `flat`.
    pub kind: &'static str,
    /// Exposure time, s.
    pub time_s: f64,
    /// Relative light.
    pub light: f64,
    /// Number of frames.
    pub frames: usize,
    /// Mean, DN.
    pub mean_dn: f64,
    /// Temporal variance of a pixel, DN².
    pub variance_dn2: f64,
    /// Use: `used`, or why the stack takes no part in the photon transfer.
    pub state: &'static str,
}

/// Figures of a sensor. Electrons need the gain, and are missing without it.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorFigures {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Bits of the converter, and true if a saturated level shows them.
    pub bit_depth: (u8, bool),
    /// Low bits that are zero in all files, by which the numbers were shifted down.
    pub shifted_bits: u32,
    /// Electrons per digital number, at low signals.
    pub gain_e_per_dn: Finding,
    /// Digital number without charge.
    pub bias_dn: Finding,
    /// Temporal noise of a pixel without light, DN, without rounding, rows and columns.
    pub read_noise_dn: Finding,
    /// The same in electrons.
    pub read_noise_e: Finding,
    /// Temporal noise common to a row, electrons.
    pub row_noise_e: Finding,
    /// Temporal noise common to a column, electrons.
    pub column_noise_e: Finding,
    /// Dark current of an ordinary pixel, electrons per second.
    pub dark_current_e_per_s: Finding,
    /// Standard deviation of the dark currents of ordinary pixels, electrons per second.
    pub dark_current_spread_e_per_s: Finding,
    /// DSNU1288: standard deviation of the offsets of pixels, rows and columns included, electrons.
    pub dsnu_e: Finding,
    /// Part of it that is common to a column, electrons.
    pub column_offset_e: Finding,
    /// Part of it that is common to a row, electrons.
    pub row_offset_e: Finding,
    /// PRNU1288: standard deviation of the response as a fraction of its mean, after a smooth surface.
    pub prnu_fraction: Finding,
    /// Full well, electrons.
    pub full_well_e: Finding,
    /// Saturation of EMVA 1288: mean of the level with the largest temporal variance, DN.
    pub saturation_dn: Finding,
    /// The same in electrons.
    pub saturation_e: Finding,
    /// Mean of the brightest level whose variance is that of the photon transfer to 5 %, DN.
    pub largest_linear_dn: Finding,
    /// Electrons at the full well or, where none is seen, at the largest number of the converter; `None`
    /// without a gain.
    pub end_e: Option<f64>,
    /// What ends the response, if a level shows it.
    pub limit: Option<SaturationLimit>,
    /// Linearity error LE of EMVA 1288, percent.
    pub linearity_error_percent: Finding,
    /// Share of its signal that a pixel loses at `end_e`; the response is taken as a parabola.
    pub non_linearity: Finding,
    /// Relative change of the light between frames of one level beyond the noise; 0 if there is none.
    pub light_drift: f64,
    /// Defects.
    pub defects: DefectCounts,
    /// Stacks.
    pub levels: Vec<LevelSummary>,
    /// Statements about the frames.
    pub notes: Vec<String>,
}
