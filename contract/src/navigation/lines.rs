//! Lines exchanged with a navigator in another process: JSON, one object per line, UTF-8.
//!
//! Setup, to the process: `{"setup": {…}}`. The process answers `{"boresight_navigator": 1, "name": "…",
//! "mode": "batch"}` or `"sequential"`. Then events, without an answer, and requests:
//! ```json
//! {"line_of_sight": {"frame": 12, "time_utc": "2012-04-25T00:00:00.000000000Z", "los_j2000": [1, 0, 0],
//!  "q_cam_j2000": [1, 0, 0, 0], "sigma_ra_deg": 0.01, "sigma_dec_deg": 0.01, "correlation_ra_dec": 0,
//!  "attitude_source": "stars"}}
//! {"manoeuvre": {"time_utc": "…", "dv_rtn_m_s": [0, 0.01, 0], "sigma_rtn_m_s": [0, 0, 0]}}
//! {"estimate": ["2012-04-25T00:00:00.000000000Z"]}
//! ```
//! A request is answered by one line with an entry per epoch, in order, either an estimate or a reason
//! ([`NoEstimate`]):
//! ```json
//! {"estimates": [{"position_rtn_m": [0, -3e4, 0], "velocity_rtn_m_s": [0, 0, 0], "covariance": [["…"]],
//!  "elements_m": [0, -3e4, 0, 0, 0, 0], "elements_covariance": [["…"]]}, {"no_estimate": "no_measurements"}]}
//! ```
//! Covariances are lists of six rows; absent values are absent keys. An unknown key makes a line unusable.
//! Times are written and read by functions of the caller, because UTC needs a table of leap seconds.

use hifitime::Epoch;
use nalgebra::{Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::{
    Answer, ChaserOrbit, Covariance6, DifferentialDrag, Event, LineOfSightErrors, LineOfSightMeasurement,
    ManoeuvreReport, MeanElements, Mode, NavigationSetup, NoEstimate, PriorOrbit, RelativeElements,
    RelativeEstimate, ReportedState,
};
use crate::{AttitudeSource, Covariance2, Direction, Rotation};

/// Version of the lines.
pub const VERSION: u32 = 1;

/// Tolerance of the norm of a direction.
const UNIT_TOLERANCE: f64 = 1e-5;

/// Writer of an instant as text, `Z` at its end.
pub type WriteTime<'a> = &'a dyn Fn(Epoch) -> String;

/// Reader of the text of an instant; the error states the fault.
pub type ReadTime<'a> = &'a dyn Fn(&str) -> Result<Epoch, String>;

/// A line to a navigator, as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Line {
    /// First line.
    Setup(Box<SetupLine>),
    /// Event.
    LineOfSight(LineOfSightLine),
    /// Event.
    Manoeuvre(ManoeuvreLine),
    /// Request for estimates at these times.
    Estimate(Vec<String>),
}

/// [`NavigationSetup`] as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetupLine {
    boresight_navigator: u32,
    epoch_utc: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    chaser_mean_elements: Option<MeanElements>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    chaser_states: Vec<StateLine>,
    q_cam_sc: [f64; 4],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    prior: Option<PriorLine>,
    errors: LineOfSightErrors,
    drag: DifferentialDrag,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StateLine {
    time_utc: String,
    position_km: [f64; 3],
    velocity_km_s: [f64; 3],
    position_sigma_m: f64,
    velocity_sigma_m_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PriorLine {
    elements_m: [f64; 6],
    covariance: [[f64; 6]; 6],
}

/// [`LineOfSightMeasurement`] as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineOfSightLine {
    frame: u64,
    time_utc: String,
    los_j2000: [f64; 3],
    q_cam_j2000: [f64; 4],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sigma_ra_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sigma_dec_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    correlation_ra_dec: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    attitude_source: Option<String>,
}

/// [`ManoeuvreReport`] as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreLine {
    time_utc: String,
    dv_rtn_m_s: [f64; 3],
    sigma_rtn_m_s: [f64; 3],
}

/// Answer to the setup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GreetingAnswer {
    /// Version of the lines: [`VERSION`].
    pub boresight_navigator: u32,
    /// Name for tables and logs.
    pub name: String,
    /// Mode, `batch` or `sequential`.
    pub mode: Mode,
}

/// Answer to a request for estimates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EstimatesLine {
    estimates: Vec<EstimateLine>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum EstimateLine {
    None(NoEstimateLine),
    Some(Box<SomeEstimateLine>),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoEstimateLine {
    no_estimate: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SomeEstimateLine {
    position_rtn_m: [f64; 3],
    velocity_rtn_m_s: [f64; 3],
    covariance: [[f64; 6]; 6],
    elements_m: [f64; 6],
    elements_covariance: [[f64; 6]; 6],
}

impl SetupLine {
    /// Converts a setup.
    pub fn new(setup: &NavigationSetup, write: WriteTime<'_>) -> Self {
        let state = |state: &ReportedState| StateLine {
            time_utc: write(state.time),
            position_km: state.position_km.into(),
            velocity_km_s: state.velocity_km_s.into(),
            position_sigma_m: state.position_sigma_m,
            velocity_sigma_m_s: state.velocity_sigma_m_s,
        };
        let (chaser_mean_elements, chaser_states) = match &setup.chaser_orbit {
            ChaserOrbit::Mean(elements) => (Some(*elements), Vec::new()),
            ChaserOrbit::States(states) => (None, states.iter().map(state).collect()),
        };
        Self {
            boresight_navigator: VERSION,
            epoch_utc: write(setup.epoch),
            chaser_mean_elements,
            chaser_states,
            q_cam_sc: setup.camera_from_body.wxyz(),
            prior: setup.prior.map(|prior| PriorLine {
                elements_m: prior.elements.vector().into(),
                covariance: rows(&prior.covariance),
            }),
            errors: setup.errors.clone(),
            drag: setup.drag,
        }
    }

    /// Converts back.
    ///
    /// # Errors
    /// The key, its value and the expected one.
    pub fn setup(&self, read: ReadTime<'_>) -> Result<NavigationSetup, String> {
        if self.boresight_navigator != VERSION {
            return Err(format!("boresight_navigator is {}, expected {VERSION}", self.boresight_navigator));
        }
        let state = |line: &StateLine| -> Result<ReportedState, String> {
            Ok(ReportedState {
                time: read(&line.time_utc)?,
                position_km: line.position_km.into(),
                velocity_km_s: line.velocity_km_s.into(),
                position_sigma_m: line.position_sigma_m,
                velocity_sigma_m_s: line.velocity_sigma_m_s,
            })
        };
        let chaser_orbit = match (&self.chaser_mean_elements, self.chaser_states.is_empty()) {
            (Some(elements), true) => ChaserOrbit::Mean(*elements),
            (None, false) => {
                ChaserOrbit::States(self.chaser_states.iter().map(state).collect::<Result<_, _>>()?)
            }
            _ => return Err("expected either chaser_mean_elements or chaser_states".to_owned()),
        };
        let prior = self.prior.as_ref().map(|prior| -> Result<PriorOrbit, String> {
            Ok(PriorOrbit {
                elements: RelativeElements::from_vector(&Vector6::from(prior.elements_m)),
                covariance: covariance("prior.covariance", &prior.covariance)?,
            })
        });
        let setup = NavigationSetup {
            epoch: read(&self.epoch_utc)?,
            chaser_orbit,
            camera_from_body: Rotation::from_wxyz(self.q_cam_sc)
                .map_err(|error| format!("q_cam_sc: {error}"))?,
            prior: prior.transpose()?,
            errors: self.errors.clone(),
            drag: self.drag,
        };
        setup.check().map_err(|error| error.to_string())?;
        Ok(setup)
    }
}

impl Line {
    /// Converts an event.
    pub fn from_event(event: &Event, write: WriteTime<'_>) -> Self {
        match event {
            Event::LineOfSight(measurement) => {
                let degrees = measurement.covariance.map(|covariance| covariance.degrees());
                Self::LineOfSight(LineOfSightLine {
                    frame: measurement.frame,
                    time_utc: write(measurement.time),
                    los_j2000: (*measurement.line_of_sight.vector()).into(),
                    q_cam_j2000: measurement.camera_from_icrs.wxyz(),
                    sigma_ra_deg: degrees.map(|[sigma, _, _]| sigma),
                    sigma_dec_deg: degrees.map(|[_, sigma, _]| sigma),
                    correlation_ra_dec: degrees.map(|[_, _, correlation]| correlation),
                    attitude_source: measurement.attitude_source.map(|source| source.code().to_owned()),
                })
            }
            Event::Manoeuvre(manoeuvre) => Self::Manoeuvre(ManoeuvreLine {
                time_utc: write(manoeuvre.time),
                dv_rtn_m_s: manoeuvre.dv_rtn_m_s.into(),
                sigma_rtn_m_s: manoeuvre.sigma_rtn_m_s.into(),
            }),
        }
    }

    /// Returns the event of the line, `None` for a setup or a request.
    ///
    /// # Errors
    /// The key, its value and the expected one.
    pub fn event(&self, read: ReadTime<'_>) -> Result<Option<Event>, String> {
        match self {
            Self::Setup(_) | Self::Estimate(_) => Ok(None),
            Self::LineOfSight(line) => line.measurement(read).map(|m| Some(Event::LineOfSight(m))),
            Self::Manoeuvre(line) => {
                let manoeuvre = ManoeuvreReport {
                    time: read(&line.time_utc)?,
                    dv_rtn_m_s: line.dv_rtn_m_s.into(),
                    sigma_rtn_m_s: line.sigma_rtn_m_s.into(),
                };
                manoeuvre.check().map_err(|error| error.to_string())?;
                Ok(Some(Event::Manoeuvre(manoeuvre)))
            }
        }
    }
}

impl LineOfSightLine {
    fn measurement(&self, read: ReadTime<'_>) -> Result<LineOfSightMeasurement, String> {
        let los = Vector3::from(self.los_j2000);
        let line_of_sight = Direction::from_vector(los)
            .ok()
            .filter(|_| (los.norm() - 1.0).abs() < UNIT_TOLERANCE)
            .ok_or_else(|| format!("los_j2000 is {:?}, expected a unit vector", self.los_j2000))?;
        let covariance = match (self.sigma_ra_deg, self.sigma_dec_deg, self.correlation_ra_dec) {
            (None, None, None) => None,
            (Some(x), Some(y), Some(correlation)) => {
                let covariance = Covariance2::from_degrees([x, y, correlation]);
                Some(covariance.map_err(|error| format!("the covariance of a line of sight: {error}"))?)
            }
            _ => {
                return Err("only some of sigma_ra_deg, sigma_dec_deg, correlation_ra_dec are stated, \
                            expected all three or none"
                    .to_owned());
            }
        };
        let source = |code: &String| {
            AttitudeSource::parse(code).ok_or_else(|| {
                format!(
                    "attitude_source is `{code}`, expected one of stars, too_few_stars, no_stars, no_match"
                )
            })
        };
        Ok(LineOfSightMeasurement {
            frame: self.frame,
            time: read(&self.time_utc)?,
            line_of_sight,
            camera_from_icrs: Rotation::from_wxyz(self.q_cam_j2000)
                .map_err(|error| format!("q_cam_j2000: {error}"))?,
            covariance,
            attitude_source: self.attitude_source.as_ref().map(source).transpose()?,
        })
    }
}

impl EstimatesLine {
    /// Converts answers.
    pub fn new(answers: &[Answer]) -> Self {
        let line = |answer: &Answer| match answer {
            Err(reason) => EstimateLine::None(NoEstimateLine { no_estimate: reason.to_string() }),
            Ok(estimate) => EstimateLine::Some(Box::new(SomeEstimateLine {
                position_rtn_m: estimate.position_m.into(),
                velocity_rtn_m_s: estimate.velocity_m_s.into(),
                covariance: rows(&estimate.covariance),
                elements_m: estimate.elements.vector().into(),
                elements_covariance: rows(&estimate.elements_covariance),
            })),
        };
        Self { estimates: answers.iter().map(line).collect() }
    }

    /// Converts back to the answers for `epochs`.
    ///
    /// # Errors
    /// The entry and its fault, or a wrong number of entries.
    pub fn answers(&self, epochs: &[Epoch]) -> Result<Vec<Answer>, String> {
        if self.estimates.len() != epochs.len() {
            return Err(format!("{} estimates, expected {}", self.estimates.len(), epochs.len()));
        }
        let answer = |(index, (line, time)): (usize, (&EstimateLine, &Epoch))| match line {
            EstimateLine::None(NoEstimateLine { no_estimate }) => {
                NoEstimate::parse(no_estimate).map(Err).ok_or_else(|| {
                    format!("estimates[{index}].no_estimate is `{no_estimate}`, an unknown reason")
                })
            }
            EstimateLine::Some(line) => {
                line.estimate(*time).map(Ok).map_err(|error| format!("estimates[{index}]: {error}"))
            }
        };
        self.estimates.iter().zip(epochs).enumerate().map(answer).collect()
    }
}

impl SomeEstimateLine {
    fn estimate(&self, time: Epoch) -> Result<RelativeEstimate, String> {
        let vectors =
            [("position_rtn_m", &self.position_rtn_m), ("velocity_rtn_m_s", &self.velocity_rtn_m_s)];
        for (key, vector) in vectors {
            if !vector.iter().all(|x| x.is_finite()) {
                return Err(format!("{key} is {vector:?}, expected finite numbers"));
            }
        }
        if !self.elements_m.iter().all(|x| x.is_finite()) {
            return Err(format!("elements_m is {:?}, expected finite numbers", self.elements_m));
        }
        Ok(RelativeEstimate {
            time,
            position_m: self.position_rtn_m.into(),
            velocity_m_s: self.velocity_rtn_m_s.into(),
            covariance: covariance("covariance", &self.covariance)?,
            elements: RelativeElements::from_vector(&Vector6::from(self.elements_m)),
            elements_covariance: covariance("elements_covariance", &self.elements_covariance)?,
        })
    }
}

fn rows(covariance: &Covariance6) -> [[f64; 6]; 6] {
    // Columns of the transposed matrix are rows.
    covariance.matrix().transpose().into()
}

fn covariance(key: &str, rows: &[[f64; 6]; 6]) -> Result<Covariance6, String> {
    Covariance6::from_matrix(Matrix6::from(*rows).transpose()).map_err(|error| format!("{key}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::navigation::{AngleErrors, SlowDisplacement, SlowError};

    fn write(time: Epoch) -> String {
        format!("{}", (time - origin()).total_nanoseconds())
    }

    fn read(text: &str) -> Result<Epoch, String> {
        let nanoseconds: i64 = text.parse().map_err(|_| format!("time_utc is `{text}`, expected a time"))?;
        Ok(origin() + hifitime::Unit::Nanosecond * nanoseconds)
    }

    fn origin() -> Epoch {
        Epoch::from_gregorian_utc_at_midnight(2012, 4, 23)
    }

    fn measurement() -> LineOfSightMeasurement {
        LineOfSightMeasurement {
            frame: 12,
            time: origin() + hifitime::Unit::Second * 15,
            line_of_sight: Direction::from_vector(Vector3::new(0.6, 0.0, 0.8)).unwrap(),
            camera_from_icrs: Rotation::identity(),
            covariance: Some(Covariance2::from_degrees([0.01, 0.02, 0.25]).unwrap()),
            attitude_source: Some(AttitudeSource::Stars),
        }
    }

    fn setup() -> NavigationSetup {
        let slow = SlowError { sigma_arcsec: [20.0, 15.0], memory_s: 1e5, period_s: Some(5930.0) };
        let errors = AngleErrors {
            white_arcsec: [50.0, 40.0],
            slow: vec![slow, SlowError { period_s: None, ..slow }],
            constant_arcsec: [1.0, 2.0, 3.0],
        };
        let displacement = SlowDisplacement { sigma_m: [0.1, 0.2], memory_s: 1e6, period_s: Some(5930.0) };
        NavigationSetup {
            epoch: origin(),
            chaser_orbit: ChaserOrbit::States(vec![0, 60].into_iter().map(state).collect()),
            camera_from_body: Rotation::identity(),
            prior: Some(PriorOrbit {
                elements: RelativeElements { a_dlambda_m: -3e4, ..RelativeElements::default() },
                covariance: Covariance6::from_sigmas([1.0, 1e3, 30.0, 30.0, 30.0, 30.0]).unwrap(),
            }),
            errors: LineOfSightErrors {
                with_stars: AngleErrors::default(),
                without_stars: errors,
                displacements: vec![displacement, SlowDisplacement { period_s: None, ..displacement }],
            },
            drag: DifferentialDrag { a_da_rate_m_per_day: -0.5, sigma_m_per_day: 1.0 },
        }
    }

    fn state(seconds: i64) -> ReportedState {
        ReportedState {
            time: origin() + hifitime::Unit::Second * seconds,
            position_km: Vector3::new(7130.0, 0.0, 0.0),
            velocity_km_s: Vector3::new(0.0, 1.1, 7.4),
            position_sigma_m: 5.0,
            velocity_sigma_m_s: 0.02,
        }
    }

    #[test]
    fn setup_and_events_come_back_through_their_lines() {
        let line = Line::Setup(Box::new(SetupLine::new(&setup(), &write)));
        let Line::Setup(back) = serde_json::from_str(&serde_json::to_string(&line).unwrap()).unwrap() else {
            panic!("a setup")
        };
        assert_eq!(back.setup(&read).unwrap(), setup());
        let manoeuvre = ManoeuvreReport {
            time: origin(),
            dv_rtn_m_s: Vector3::new(0.0, -0.013, 0.05),
            sigma_rtn_m_s: Vector3::repeat(1e-4),
        };
        let without = LineOfSightMeasurement { covariance: None, attitude_source: None, ..measurement() };
        for event in [Event::Manoeuvre(manoeuvre), Event::LineOfSight(without)] {
            let text = serde_json::to_string(&Line::from_event(&event, &write)).unwrap();
            let back: Line = serde_json::from_str(&text).unwrap();
            assert_eq!(back.event(&read), Ok(Some(event)), "{text}");
        }
        let text =
            serde_json::to_string(&Line::from_event(&Event::LineOfSight(measurement()), &write)).unwrap();
        let back: Line = serde_json::from_str(&text).unwrap();
        let Ok(Some(Event::LineOfSight(back))) = back.event(&read) else { panic!("{text}") };
        // Degrees and back: a last digit.
        let sigma = back.covariance.unwrap().sigma_x() / measurement().covariance.unwrap().sigma_x();
        assert!((sigma - 1.0).abs() < 1e-15);
    }

    #[test]
    fn answers_come_back_through_their_line() {
        let estimate = RelativeEstimate {
            time: origin(),
            position_m: Vector3::new(1.0, -3e4, 2.0),
            velocity_m_s: Vector3::new(0.1, 0.2, 0.3),
            covariance: Covariance6::from_sigmas([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap(),
            elements: RelativeElements { a_dex_m: 7.0, ..RelativeElements::default() },
            elements_covariance: Covariance6::from_sigmas([6.0, 5.0, 4.0, 3.0, 2.0, 1.0]).unwrap(),
        };
        let answers = [Ok(estimate), Err(NoEstimate::Failed("no light".to_owned()))];
        let text = serde_json::to_string(&EstimatesLine::new(&answers)).unwrap();
        let back: EstimatesLine = serde_json::from_str(&text).unwrap();
        assert_eq!(back.answers(&[origin(); 2]).unwrap(), answers);
        assert!(back.answers(&[origin()]).unwrap_err().contains("2 estimates, expected 1"));
    }

    #[test]
    fn unusable_lines_state_their_fault() {
        let refused = |change: fn(&mut LineOfSightLine)| {
            let Line::LineOfSight(mut line) = Line::from_event(&Event::LineOfSight(measurement()), &write)
            else {
                panic!("a line of sight")
            };
            change(&mut line);
            Line::LineOfSight(line).event(&read).unwrap_err()
        };
        assert!(refused(|line| line.los_j2000 = [1.0, 1.0, 0.0]).contains("unit vector"));
        assert!(refused(|line| line.sigma_ra_deg = None).contains("all three or none"));
        assert!(refused(|line| line.sigma_ra_deg = Some(-1.0)).contains("positive"));
        assert!(refused(|line| line.attitude_source = Some("moon".into())).contains("attitude_source"));
        assert!(refused(|line| line.time_utc = "noon".into()).contains("time_utc"));
        let unknown = serde_json::from_str::<Line>(r#"{"estimate": [], "more": 1}"#);
        assert!(unknown.is_err());
        let mut line = SetupLine::new(&setup(), &write);
        line.chaser_states.clear();
        assert!(line.setup(&read).unwrap_err().contains("chaser_states"));
        let estimates: EstimatesLine =
            serde_json::from_str(r#"{"estimates": [{"no_estimate": "rain"}]}"#).unwrap();
        assert!(estimates.answers(&[origin()]).unwrap_err().contains("unknown reason"));
    }
}
