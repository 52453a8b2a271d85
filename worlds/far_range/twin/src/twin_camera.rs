//! Detector, optics and brightness scale of a twin.

use camera_fit::{FLUX_REACH_PX, ProfileKind, StarProfile};

use crate::FrameSet;
use crate::likeness::background::FrameBackground;
use crate::likeness::hot_pixels::hot_pixels;
use crate::likeness::{Comparison, centred, covariance, variance_of_offsets};

/// Electrons of a pixel at full scale that are assumed where the gain is unknown: the full well of a small
/// pixel.
const ASSUMED_FULL_SCALE_E: f64 = 20_000.0;

/// Largest noise of a twin, e⁻: below the limit of a scenario. A noisier camera is given a smaller gain.
const MAX_NOISE_E: f64 = 450.0;

/// Variance of the rounding to whole numbers, DN².
const ROUNDING_VARIANCE: f64 = 1.0 / 12.0;

/// Limits of the exponent of the distribution of hot pixels.
const MIN_HOT_INDEX: f64 = 0.3;
const MAX_HOT_INDEX: f64 = 10.0;

/// Variance of the offsets of rows or columns in standard deviations from which a twin has them.
const MIN_OFFSET_SIGMAS: f64 = 3.0;

/// Width of the stars that is assumed where no star gives it, px.
const ASSUMED_WIDTH_PX: f64 = 0.8;

/// What the frames tell of detector and optics, in the terms of the simulator.
#[derive(Debug, Clone, PartialEq)]
pub struct TwinCamera {
    /// Bits of the digital numbers, 8 to 16: the fewest that hold the saturation level.
    pub bit_depth: u8,
    /// True if the values were corrected by the frames of the twin.
    pub is_corrected: bool,
    /// Measured sensor; `None`: the values below are its own.
    pub sensor: Option<MeasuredSensor>,
    /// Electrons per DN; assumed where no sensor was measured.
    pub gain_e_per_dn: f64,
    /// Level of the background, DN.
    pub bias_dn: f64,
    /// Noise of a pixel without the rounding and the offsets of rows and columns, DN.
    pub read_noise_dn: f64,
    /// Standard deviation of the offsets of rows that change from frame to frame, DN; 0 where none is seen.
    pub row_dn: f64,
    /// Standard deviation of the offsets of columns that change from frame to frame, DN.
    pub column_dn: f64,
    /// Standard deviation of the offsets of columns that stay, DN.
    pub fixed_column_dn: f64,
    /// Hot pixels; `None` for fewer than three frames at different pointings.
    pub hot_pixels: Option<HotPixels>,
    /// Profile of the stars.
    pub profile: StarProfile,
    /// False if the profile is assumed.
    pub has_profile: bool,
    /// DN per exposure of a star of V = 0 and B−V = 0, and the colour term, mag per mag of B−V; `None` with
    /// too few stars.
    pub zero_point_dn: Option<[f64; 2]>,
}

/// A sensor that was measured from bias, dark and flat frames.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSensor {
    /// Electrons per DN.
    pub gain_e_per_dn: f64,
    /// Tables `[sensor]` of a scenario, with comments.
    pub tables: String,
}

/// Hot pixels above a limit: P(height > h) = (limit/h)^index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HotPixels {
    /// Number.
    pub count: usize,
    /// Smallest height above the background, DN.
    pub limit_dn: f64,
    /// Exponent, 0.3 to 10.
    pub index: f64,
}

impl TwinCamera {
    /// Measures the frames; `sensor` replaces what they say of the detector.
    pub fn of(set: &FrameSet, sensor: Option<MeasuredSensor>) -> Self {
        let fit = &set.fit;
        let backgrounds = set.backgrounds(fit.noise_dn);
        let (row_dn, _) = offsets(&backgrounds, |frame| &frame.row_offsets);
        let (column_dn, fixed_column_dn) = offsets(&backgrounds, |frame| &frame.column_offsets);
        let noises: Vec<f64> = backgrounds.iter().map(|frame| frame.noise.value).collect();
        let noise_dn = mean(&noises).unwrap_or(fit.noise_dn);
        let levels: Vec<f64> = backgrounds.iter().map(|frame| frame.level.value).collect();
        let bit_depth = bits(fit.saturation_dn);
        let assumed = StarProfile {
            kind: ProfileKind::Gaussian { sigma_px: fit.width_px.unwrap_or(ASSUMED_WIDTH_PX) },
            width_error: f64::NAN,
            growth: [0.0; 2],
            stars: 0,
        };
        let largest_noise_dn = noise_dn.max(row_dn).max(column_dn).max(fixed_column_dn);
        Self {
            bit_depth,
            gain_e_per_dn: sensor
                .as_ref()
                .map_or(assumed_gain(fit.saturation_dn, largest_noise_dn), |sensor| sensor.gain_e_per_dn),
            is_corrected: false,
            sensor,
            bias_dn: mean(&levels).unwrap_or(fit.background_dn).max(0.0),
            read_noise_dn: (noise_dn * noise_dn - ROUNDING_VARIANCE).max(0.0).sqrt(),
            row_dn,
            column_dn,
            fixed_column_dn,
            hot_pixels: measured_hot_pixels(set),
            profile: fit.profile.unwrap_or(assumed),
            has_profile: fit.profile.is_some(),
            zero_point_dn: fit.photometry.map(|light| {
                // The measured flux is that of a square about the star.
                let share = fit.profile.map_or(1.0, |profile| profile.share_within(FLUX_REACH_PX));
                [libm::pow(10.0, 0.4 * light.zero_point[0]) / share, light.colour_term[0]]
            }),
        }
    }

    /// Converts the figures of a camera whose images are the means of the two green pixels of each square of
    /// two by two to those of the pixels of the mosaic, whose saturation is `saturation_dn`.
    pub fn convert_to_mosaic(&mut self, saturation_dn: f64) {
        // Of the mean of two pixels, the variance is half of theirs, and that of the rounding a
        // twenty-fourth.
        self.read_noise_dn = (2.0 * self.read_noise_dn * self.read_noise_dn + ROUNDING_VARIANCE).sqrt();
        for offset_dn in [&mut self.row_dn, &mut self.column_dn, &mut self.fixed_column_dn] {
            *offset_dn *= std::f64::consts::SQRT_2;
        }
        if let Some(hot) = &mut self.hot_pixels {
            // A square shows the hot pixels of its green half, each at half of its height.
            hot.count *= 2;
            hot.limit_dn *= 2.0;
        }
        if let Some([zero_point_dn, _]) = &mut self.zero_point_dn {
            // The squares of a star are a quarter of its pixels.
            *zero_point_dn *= 4.0;
        }
        self.profile.kind = narrowed(self.profile.kind, 2.0);
        self.bit_depth = bits(saturation_dn);
        if self.sensor.is_none() {
            let largest_dn =
                self.read_noise_dn.max(self.row_dn).max(self.column_dn).max(self.fixed_column_dn);
            self.gain_e_per_dn = assumed_gain(saturation_dn, largest_dn);
        }
    }

    /// Corrects the twin by a comparison of its frames with those of the camera: level, noise, offsets,
    /// brightness and width where they differ, each by its difference. Faint stars, for example, are part of
    /// the noise that was measured, and the simulator draws them, too.
    ///
    /// Returns true if it changed.
    pub fn correct(&mut self, comparison: &Comparison) -> bool {
        let before = self.clone();
        for figure in &comparison.figures {
            // The tables of a measured sensor are as they were measured.
            let is_of_sensor = !matches!(figure.code, "star_flux" | "star_width");
            if figure.is_indistinguishable() || (is_of_sensor && self.sensor.is_some()) {
                continue;
            }
            let squares = |value: Option<f64>| value.map_or(0.0, |value| value * value);
            match figure.code {
                "background" => self.bias_dn = (self.bias_dn - figure.difference).max(0.0),
                "noise" => {
                    let excess = squares(figure.twin) - squares(figure.camera);
                    self.read_noise_dn = less_variance(self.read_noise_dn, excess);
                }
                "row_noise" => self.row_dn = less_variance(self.row_dn, figure.difference),
                // Which of the two columns have is not known: the part that changes is corrected.
                "column_noise" => self.column_dn = less_variance(self.column_dn, figure.difference),
                "star_flux" => {
                    if let Some([zero_point_dn, _]) = &mut self.zero_point_dn {
                        *zero_point_dn /= 1.0 + 0.01 * figure.difference;
                    }
                }
                "star_width" => {
                    self.profile.kind = narrowed(self.profile.kind, 1.0 / (1.0 + 0.01 * figure.difference))
                }
                _ => {}
            }
        }
        let is_changed = *self != before;
        self.is_corrected |= is_changed;
        is_changed
    }
}

/// Returns a standard deviation whose variance is less by `excess`, not below 0.
fn less_variance(sigma: f64, excess: f64) -> f64 {
    (sigma * sigma - excess).max(0.0).sqrt()
}

/// Returns a profile whose width is multiplied by `factor`.
fn narrowed(kind: ProfileKind, factor: f64) -> ProfileKind {
    match kind {
        ProfileKind::Gaussian { sigma_px } => ProfileKind::Gaussian { sigma_px: sigma_px * factor },
        ProfileKind::Moffat { fwhm_px, beta } => ProfileKind::Moffat { fwhm_px: fwhm_px * factor, beta },
    }
}

/// Returns the gain that is assumed, with which the noise is one that a scenario can have.
fn assumed_gain(saturation_dn: f64, largest_noise_dn: f64) -> f64 {
    (ASSUMED_FULL_SCALE_E / saturation_dn).min(MAX_NOISE_E / largest_noise_dn)
}

/// Returns the fewest bits, 8 to 16, whose largest number is not below a value.
fn bits(largest_dn: f64) -> u8 {
    (8..16).find(|bits| f64::from((1_u32 << bits) - 1) >= largest_dn).unwrap_or(16)
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns the standard deviations of the offsets that change from frame to frame, and of those that stay,
/// DN: beyond what the noise of the pixels gives. The mean covariance of two frames is the variance of what
/// stays.
fn offsets(backgrounds: &[FrameBackground], pick: fn(&FrameBackground) -> &Vec<f64>) -> (f64, f64) {
    let lists: Vec<Vec<f64>> = backgrounds.iter().map(|frame| centred(pick(frame))).collect();
    let Some(variance) = variance_of_offsets(&lists) else { return (0.0, 0.0) };
    let mut of_noise = 0.0;
    for frame in backgrounds {
        // The other axis has as many pixels as the mean of an offset.
        let other = frame.row_offsets.len() * frame.column_offsets.len() / pick(frame).len().max(1);
        of_noise += frame.noise.value * frame.noise.value / other.max(1) as f64 / backgrounds.len() as f64;
    }
    if variance.value - of_noise < MIN_OFFSET_SIGMAS * variance.sigma {
        return (0.0, 0.0);
    }
    let (mut fixed, mut pairs) = (0.0, 0.0);
    for (index, first) in lists.iter().enumerate() {
        for second in &lists[index + 1..] {
            fixed += covariance(first, second);
            pairs += 1.0;
        }
    }
    let fixed = if pairs > 0.0 { (fixed / pairs).max(0.0) } else { 0.0 };
    // A part below the error of the whole counts as the other.
    let fixed = if fixed < variance.sigma { 0.0 } else { fixed };
    ((variance.value - of_noise - fixed).max(0.0).sqrt(), fixed.sqrt())
}

/// Returns the hot pixels, with the exponent of greatest likelihood n/Σ ln(height/limit) (Hill 1975).
fn measured_hot_pixels(set: &FrameSet) -> Option<HotPixels> {
    let (heights, limit_dn) = hot_pixels(set)?;
    let sum: f64 = heights.iter().map(|height| libm::log(height / limit_dn)).sum();
    let index = (heights.len() as f64 / sum.max(1e-9)).clamp(MIN_HOT_INDEX, MAX_HOT_INDEX);
    Some(HotPixels { count: heights.len(), limit_dn, index })
}
