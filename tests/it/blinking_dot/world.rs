//! A complete world: a dot that blinks on a line of pixels.

use boresight::files::{Failure, table};
use boresight::run::plain::{PlainPipeline, PlainWorld, Scored};
use boresight::scenario::scenario_file;
use boresight::score::{Definition, Reduction};
use contract::{Frame, OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub(super) const SCENARIO: &str = "world = \"blinking_dot\"\ntitle = \"A dot that blinks\"\nseed = 1\nframes = 300\nnoise_dn = 40\n\n[blinking_dot]\nthreshold_dn = 50\n";

/// The scenario. The dot has 90 DN in two of three frames, and the noise is at most `noise_dn`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Scene {
    world: String,
    title: String,
    seed: u64,
    #[schemars(range(min = 1, max = 100_000))]
    frames: u64,
    noise_dn: u8,
    /// True if the dot moves on by a column after each frame in which the pipeline finds it.
    #[serde(default)]
    flees: bool,
    blinking_dot: Detector,
}

scenario_file!(Scene, "blinking_dot", SCENARIO);

/// Parameters of the built-in pipeline, which measures the brightest pixel above a threshold.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Detector {
    threshold_dn: u16,
}

table! {
    /// Truth of a frame.
    #[derive(Debug, Clone)]
    pub(super) struct Dot: parquet(frame) {
        /// number of the frame
        frame: u64,
        /// column of the dot; none where it is off
        column: Option<u32>,
    }
}

table! {
    /// Answer of a pipeline.
    #[derive(Debug, Clone, PartialEq, Deserialize)]
    pub(super) struct Found: csv {
        /// column of the dot; none where it is off
        found_column: Option<u32>,
    }
}

impl PlainPipeline<Found> for Detector {
    fn process(&mut self, frame: &Frame) -> Found {
        let brightest = (0..).zip(frame.dn()).max_by_key(|(_, dn)| **dn);
        Found { found_column: brightest.filter(|(_, dn)| **dn > self.threshold_dn).map(|(column, _)| column) }
    }
}

pub(super) struct BlinkingDot(Scene);

impl PlainWorld for BlinkingDot {
    const SETUP_FILE: &'static str = "dot.toml";
    type Scenario = Scene;
    type Setup = Detector;
    type Truth = Dot;
    type Answer = Found;
    /// Number of columns that the dot has fled.
    type State = u64;

    fn new(scene: &Scene) -> Result<Self, OutOfRange> {
        bounds::check(scene, "").map(|()| Self(scene.clone()))
    }

    fn setup(&self) -> Detector {
        self.0.blinking_dot
    }

    fn frame_count(&self) -> u64 {
        self.0.frames
    }

    fn expose(&self, frame: u64, fled: &u64) -> Result<(Frame, Dot), Failure> {
        let hash = |place: u64| (self.0.seed + place + 97 * frame).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
        let column = (!frame.is_multiple_of(3)).then_some(((frame * 7 + fled) % 6) as u32);
        let noise = |place: u64| (hash(place) % (u64::from(self.0.noise_dn) + 1)) as u16;
        let light = |place: u64| if column == Some(place as u32) { 90 } else { 0 };
        let pixels_dn = (0..6).map(|place| noise(place) + light(place)).collect();
        Ok((Frame::new(frame, 6, 1, 8, pixels_dn, None)?, Dot { frame, column }))
    }

    fn advance(&self, fled: u64, answer: &Found) -> u64 {
        fled + u64::from(self.0.flees && answer.found_column.is_some())
    }

    fn pipeline(detector: &Detector) -> Result<Box<dyn PlainPipeline<Found>>, OutOfRange> {
        Ok(Box::new(*detector))
    }

    fn judge(Scored { truth, answer }: &Scored<Self>) -> (&'static str, Option<String>) {
        let is_right = answer.as_ref().is_some_and(|answer| answer.found_column == truth.column);
        (if is_right { "correct" } else { "wrong" }, None)
    }

    fn figures() -> Vec<Definition<'static, Scored<Self>>> {
        let error_px = |scored: &Scored<Self>| {
            Some(f64::from(scored.truth.column?) - f64::from(scored.answer.as_ref()?.found_column?))
        };
        vec![Definition::amount("column_rms_px", "column RMS", "px", Reduction::Rms, error_px)]
    }
}
