//! The world: simulator, pipeline, closed loop of the exposure, score.

use contract::{Frame, OutOfRange, Readout};
use files::Failure;
use run::plain::{PlainPipeline, PlainWorld, Scored};
use score::{Better, Definition, Reduction};

use crate::imager::Imager;
use crate::pipeline::{LimbPipeline, MiddleRangeSetup};
use crate::rows::{Answer, Truth};
use crate::scenario::MiddleRangeScenario;

/// Largest error of a correct answer: of the centre, px and fraction of the disk's radius (whichever is
/// larger), and of the range, fraction.
const CENTRE_PX: f64 = 2.0;
const CENTRE_RADII: f64 = 0.1;
const RANGE_SHARE: f64 = 0.2;

/// Radius from which a body counts as resolved, px.
const RESOLVED_PX: f64 = 2.0;

/// Fraction of errors within three standard deviations, for a normal distribution.
const WITHIN_3_SIGMA: f64 = 0.9973;

/// A body that the camera resolves, at kilometres to tens of metres.
pub struct MiddleRange {
    scenario: MiddleRangeScenario,
    imager: Imager,
}

impl MiddleRange {
    /// Returns the range of a frame, km.
    #[cfg(feature = "monitor")]
    pub(crate) fn range_km(&self, frame: u64) -> f64 {
        self.imager.range_km(frame)
    }

    /// Returns the directions from the camera to the body and from the body to the Sun, in the camera's
    /// frame.
    #[cfg(feature = "monitor")]
    pub(crate) fn directions(&self, frame: u64) -> ([f64; 3], [f64; 3]) {
        self.imager.directions(frame)
    }
}

impl PlainWorld for MiddleRange {
    const SETUP_FILE: &'static str = "middle.toml";

    type Scenario = MiddleRangeScenario;
    type Setup = MiddleRangeSetup;
    type Truth = Truth;
    type Answer = Answer;
    /// Exposure time of the next frame, s; none before the first answer.
    type State = Option<f64>;

    fn new(scenario: &MiddleRangeScenario) -> Result<Self, OutOfRange> {
        scenario.check()?;
        Ok(Self { imager: Imager::new(scenario)?, scenario: scenario.clone() })
    }

    fn setup(&self) -> MiddleRangeSetup {
        let sensor = &self.scenario.sensor;
        let full_dn =
            sensor.bias_dn + (sensor.full_well_e - 5.0 * sensor.read_noise_e) / sensor.gain_e_per_dn;
        MiddleRangeSetup {
            radius_m: self.scenario.body.radius_m,
            readout: Readout {
                gain_e_per_dn: sensor.gain_e_per_dn,
                bias_dn: sensor.bias_dn,
                read_noise_e: sensor.read_noise_e,
                saturation_dn: full_dn.clamp(1.0, f64::from(sensor.full_scale_dn())) as u16,
            },
            camera: self.scenario.camera.clone(),
            middle_range: self.scenario.middle_range,
        }
    }

    fn frame_count(&self) -> u64 {
        self.scenario.approach.frames
    }

    fn expose(&self, frame: u64, exposure_s: &Option<f64>) -> Result<(Frame, Truth), Failure> {
        self.imager.expose(frame, exposure_s.unwrap_or(self.scenario.exposure.first_s))
    }

    /// Scales the exposure so that the brightest pixel would have reached its target; a saturated image is
    /// shortened to a quarter.
    fn advance(&self, exposure_s: Option<f64>, answer: &Answer) -> Option<f64> {
        let (control, sensor) = (&self.scenario.exposure, &self.scenario.sensor);
        let full_dn = f64::from(sensor.full_scale_dn()) - sensor.bias_dn;
        let signal_dn = (answer.peak_dn - sensor.bias_dn).max(0.01 * full_dn);
        let factor = if signal_dn >= 0.98 * full_dn { 0.25 } else { control.target * full_dn / signal_dn };
        let last_s = exposure_s.unwrap_or(control.first_s);
        Some((last_s * factor.clamp(0.25, 4.0)).clamp(control.min_s, control.max_s))
    }

    fn pipeline(setup: &MiddleRangeSetup) -> Result<Box<dyn PlainPipeline<Answer>>, OutOfRange> {
        Ok(Box::new(LimbPipeline::new(setup)?))
    }

    fn judge(scored: &Scored<Self>) -> (&'static str, Option<String>) {
        let truth = &scored.truth;
        let missed = |cause: &str| ("missed", Some(cause.to_owned()));
        let Some((centre_px, range)) = centre_error_px(scored).zip(range_error(scored)) else {
            return match truth {
                Truth { centre: None, .. } => missed("outside_the_field"),
                Truth { is_whole: false, .. } => missed("cut_by_the_border"),
                Truth { radius_px, .. } if *radius_px < RESOLVED_PX => missed("not_resolved"),
                _ => missed("no_limb"),
            };
        };
        if centre_px > CENTRE_PX.max(CENTRE_RADII * truth.radius_px) {
            ("wrong", Some("centre".to_owned()))
        } else if range.abs() > RANGE_SHARE {
            ("wrong", Some("range".to_owned()))
        } else {
            ("correct", None)
        }
    }

    fn figures() -> Vec<Definition<'static, Scored<Self>>> {
        let word = |scored: &Scored<Self>| Self::judge(scored).0;
        let within = |scored: &Scored<Self>| range_over_sigma(scored).map(|ratio| ratio.abs() <= 3.0);
        vec![
            Definition::rate("wrong_rate", "wrong rate", move |scored| Some(word(scored) == "wrong"))
                .with_direction(Better::Less),
            Definition::amount("centre_rms_px", "centre RMS", "px", Reduction::Rms, centre_error_px),
            Definition::amount(
                "range_rms_percent",
                "range RMS",
                "%",
                Reduction::Rms,
                |scored: &Scored<Self>| Some(100.0 * range_error(scored)?),
            ),
            Definition::amount(
                "range_bias_mean_percent",
                "range bias mean",
                "%",
                Reduction::Mean,
                |scored: &Scored<Self>| Some(100.0 * range_error(scored)?),
            )
            .with_direction(Better::Near(0.0)),
            Definition::rate("range_within_3_sigma", "range within 3 σ", within)
                .with_direction(Better::Near(WITHIN_3_SIGMA)),
        ]
    }
}

/// Distance of the measured centre from the true one, px.
pub(crate) fn centre_error_px(scored: &Scored<MiddleRange>) -> Option<f64> {
    let (truth, [x, y]) = (scored.truth.centre?, scored.answer.as_ref()?.centre?);
    Some(libm::hypot(x - truth.x, y - truth.y))
}

/// Error of the measured range over the true one.
pub(crate) fn range_error(scored: &Scored<MiddleRange>) -> Option<f64> {
    Some(scored.answer.as_ref()?.range_km? / scored.truth.range_km - 1.0)
}

/// Error of the measured range over its standard deviation.
fn range_over_sigma(scored: &Scored<MiddleRange>) -> Option<f64> {
    let answer = scored.answer.as_ref()?;
    Some((answer.range_km? - scored.truth.range_km) / answer.sigma_range_km?)
}
