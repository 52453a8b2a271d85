//! Television chain: from radiance in the focal plane to a video signal, and to digital numbers.
//!
//! In the order of the signal: veiling glare and bloom in the lens and the tube, gain, bandwidth and ringing,
//! jitter and loss of lines, their levels, noise, and the overlay. Each effect has a separate file, a
//! separate switch (it is on if its section is present) and separate draws: all other draws are the same with
//! and without it.

mod auto_gain;
mod bloom;
mod drift;
mod glyphs;
mod line_filter;
mod line_jitter;
mod line_level;
mod lost_lines;
mod noise;
mod overlay;
mod sun_glare;
mod video;

use contract::docking::Lines;
use contract::{OutOfRange, bounds};
use draws::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Ziggurat;
pub use auto_gain::AutoGainConfig;
use bloom::Bloom;
pub use bloom::BloomConfig;
pub use drift::DriftConfig;
use line_filter::LineFilter;
pub use line_filter::{BandwidthConfig, RingingConfig};
pub use line_jitter::LineJitterConfig;
pub use line_level::LineLevelConfig;
pub use lost_lines::LostLinesConfig;
pub use noise::VideoNoiseConfig;
pub use overlay::Caption;
use overlay::Overlay;
pub use overlay::OverlayConfig;
pub use sun_glare::{SunGlareConfig, SunImage};
pub use video::{BIT_DEPTH, VideoField};

/// Maximum signal of a pixel in the automatic gain's mean, in units of the white level: the Sun must not
/// darken the whole picture.
const METER_LIMIT: f32 = 4.0;
/// Number of columns summed in parallel by the automatic gain.
const METER_LANES: usize = 16;

/// Rows that are exposed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interlace {
    /// Two fields per frame, at times half a frame period apart; the first holds rows 0, 2, 4, …
    #[default]
    TopFirst,
    /// Two fields per frame; the first holds rows 1, 3, 5, …
    BottomFirst,
    /// Progressive: all rows at one time.
    Off,
}

impl Interlace {
    /// Returns the rows of the field with this number.
    pub fn lines(self, field: u64) -> Lines {
        match (self, field.is_multiple_of(2)) {
            (Self::Off, _) => Lines::All,
            (Self::TopFirst, true) | (Self::BottomFirst, false) => Lines::Even,
            (Self::TopFirst, false) | (Self::BottomFirst, true) => Lines::Odd,
        }
    }

    /// Number of fields per frame: 1 or 2.
    pub fn fields_a_frame(self) -> u32 {
        match self {
            Self::TopFirst | Self::BottomFirst => 2,
            Self::Off => 1,
        }
    }
}

/// Television chain. An effect is on if its section is present; noise is always present and may be 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TelevisionConfig {
    /// Rows that are exposed together: top_first, bottom_first, off.
    pub interlace: Interlace,
    /// Frame rate, Hz, 1 to 1000; the field rate is twice as high when interlaced.
    #[schemars(range(min = 1, max = 1000))]
    pub frame_rate_hz: f64,
    /// Radiance of the white level at a gain of 1, in the units of the lighting (a white surface that faces
    /// the Sun has irradiance/π), 1e-6 to 1e6.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub white_radiance: f64,
    /// Signal of a black scene, in units of the white level, −0.5 to 0.5; a value above 0 avoids clipping of
    /// the noise.
    #[schemars(range(min = -0.5, max = 0.5))]
    pub pedestal: f64,
    /// Signal at which the camera clips, in units of the white level, 1 to 10.
    #[schemars(range(min = 1, max = 10))]
    pub clip_level: f64,
    /// Noise of the video signal.
    pub noise: VideoNoiseConfig,
    /// Slow drift of contrast and brightness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift: Option<DriftConfig>,
    /// Automatic gain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub auto_gain: Option<AutoGainConfig>,
    /// Halo around pixels brighter than white.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bloom: Option<BloomConfig>,
    /// Glare of the Sun when it is in the field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_glare: Option<SunGlareConfig>,
    /// Limited bandwidth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bandwidth: Option<BandwidthConfig>,
    /// Ringing after edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ringing: Option<RingingConfig>,
    /// Shifts of lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line_jitter: Option<LineJitterConfig>,
    /// Loss of lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lost_lines: Option<LostLinesConfig>,
    /// Hum, and random levels of lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line_level: Option<LineLevelConfig>,
    /// Reticle and text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlay: Option<OverlayConfig>,
}

impl Default for TelevisionConfig {
    /// Interlace and noise only: for studies of accuracy.
    fn default() -> Self {
        Self {
            interlace: Interlace::TopFirst,
            frame_rate_hz: 25.0,
            white_radiance: 1.0,
            pedestal: 0.05,
            clip_level: 1.3,
            noise: VideoNoiseConfig::default(),
            drift: None,
            auto_gain: None,
            bloom: None,
            sun_glare: None,
            bandwidth: None,
            ringing: None,
            line_jitter: None,
            lost_lines: None,
            line_level: None,
            overlay: None,
        }
    }
}

impl TelevisionConfig {
    /// Returns the chain with every effect at its default strength.
    pub fn all() -> Self {
        Self {
            drift: Some(DriftConfig::default()),
            auto_gain: Some(AutoGainConfig::default()),
            bloom: Some(BloomConfig::default()),
            sun_glare: Some(SunGlareConfig::default()),
            bandwidth: Some(BandwidthConfig::default()),
            ringing: Some(RingingConfig::default()),
            line_jitter: Some(LineJitterConfig::default()),
            lost_lines: Some(LostLinesConfig::default()),
            line_level: Some(LineLevelConfig::default()),
            overlay: Some(OverlayConfig::default()),
            ..Self::default()
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "television")?;
        self.drift.as_ref().map_or(Ok(()), DriftConfig::check)
    }

    /// Fields (or progressive frames) per second.
    pub fn field_rate_hz(&self) -> f64 {
        self.frame_rate_hz * f64::from(self.interlace.fields_a_frame())
    }
}

/// Returns true if the overlay can write a text.
pub fn can_be_written(text: &str) -> bool {
    text.chars().all(glyphs::supports)
}

/// Data of a field that the chain needs in addition to its radiance.
#[derive(Debug, Clone, Copy)]
pub struct FieldLabel<'a> {
    /// Number of the field.
    pub number: u64,
    /// Time since the beginning, s.
    pub time_s: f64,
    /// Rows of the field.
    pub lines: Lines,
    /// Image of the Sun, if it is in the field.
    pub sun: Option<SunImage>,
    /// Texts of the overlay.
    pub caption: Caption<'a>,
}

/// Effects of the chain on a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VideoTruth {
    /// Signal above the pedestal for the radiance of the white level: automatic gain × drift of contrast.
    pub contrast: f64,
    /// Signal of a black scene: pedestal + drift of brightness.
    pub brightness: f64,
    /// Number of lines lost in transmission.
    pub lost_lines: u32,
}

/// Checked chain with the buffers that its fields reuse. One per thread.
#[derive(Debug, Clone)]
pub struct Television {
    config: TelevisionConfig,
    seed: Seed,
    columns: usize,
    ziggurat: Ziggurat,
    bloom: Bloom,
    filter: Option<LineFilter>,
    overlay: Option<Overlay>,
    padded: Vec<f32>,
}

impl Television {
    /// Creates a chain for cameras of `columns` × `rows`; `config` must have been checked.
    pub fn new(config: &TelevisionConfig, seed: Seed, columns: usize, rows: usize) -> Self {
        Self {
            config: config.clone(),
            seed,
            columns,
            ziggurat: Ziggurat::default(),
            bloom: Bloom::default(),
            filter: LineFilter::new(config.bandwidth.as_ref(), config.ringing.as_ref()),
            overlay: config.overlay.as_ref().map(|overlay| Overlay::new(overlay, columns, rows)),
            padded: Vec::new(),
        }
    }

    /// Converts the radiance of a field's rows to its video signal, in place.
    pub fn transmit(&mut self, field: &FieldLabel<'_>, signal: &mut [f32]) -> VideoTruth {
        let (config, seed, columns) = (&self.config, &self.seed, self.columns);
        let (number, time_s, lines) = (field.number, field.time_s, field.lines);
        let per_white = (1.0 / config.white_radiance) as f32;
        signal.iter_mut().for_each(|s| *s *= per_white);
        if let (Some(glare), Some(sun)) = (&config.sun_glare, &field.sun) {
            sun_glare::add(glare, sun, signal, columns, lines);
        }
        if let Some(bloom) = &config.bloom {
            self.bloom.add(bloom, signal, columns, lines.step());
        }
        let (contrast, brightness) =
            config.drift.as_ref().map_or((1.0, 0.0), |drift| drift.contrast_and_brightness_at(seed, time_s));
        let gain = config.auto_gain.map_or(1.0, |auto| auto.gain(metered_mean(signal, columns)));
        let truth =
            VideoTruth { contrast: gain * contrast, brightness: config.pedestal + brightness, lost_lines: 0 };
        let (slope, offset) = (truth.contrast as f32, truth.brightness as f32);
        let clip = config.clip_level as f32;
        signal.iter_mut().for_each(|s| *s = (slope * *s + offset).min(clip));

        if let Some(filter) = &mut self.filter {
            filter.apply(signal, columns);
        }
        if let Some(jitter) = &config.line_jitter {
            jitter.apply(seed, number, lines, signal, columns, &mut self.padded);
        }
        let lost_lines = config.lost_lines.map_or(0, |lost| lost.apply(seed, number, lines, signal, columns));
        if let Some(level) = &config.line_level {
            level.apply(seed, number, time_s, lines, signal, columns);
        }
        config.noise.apply(&self.ziggurat, seed, number, lines, signal, columns);
        if let (Some(overlay), Some(config)) = (&self.overlay, &config.overlay) {
            let caption = config.measured(seed, time_s, &field.caption);
            overlay.draw(&caption, lines, signal);
        }
        VideoTruth { lost_lines, ..truth }
    }
}

/// Mean of a field as measured by the automatic gain.
fn metered_mean(signal: &[f32], columns: usize) -> f64 {
    // Parallel sums, so no sum waits for the result of the preceding addition.
    let mut sums = [0.0_f32; METER_LANES];
    let mut sum = 0.0;
    for row in signal.chunks(columns) {
        let blocks = row.chunks_exact(METER_LANES);
        let rest: f32 = blocks.remainder().iter().map(|s| s.min(METER_LIMIT)).sum();
        sums.fill(0.0);
        for block in blocks {
            for (sum, s) in sums.iter_mut().zip(block) {
                *sum += if *s < METER_LIMIT { *s } else { METER_LIMIT };
            }
        }
        sum += f64::from(rest) + sums.iter().map(|sum| f64::from(*sum)).sum::<f64>();
    }
    sum / signal.len().max(1) as f64
}

#[cfg(test)]
mod tests;
