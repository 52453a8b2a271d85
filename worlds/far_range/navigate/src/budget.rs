//! Error budget of a navigation: its inputs are replaced by the truth, one at a time.
//!
//! The covariances stay, so that a batch weighs its measurements as before and its errors are nearly the sum
//! of their parts; the remainder is the interaction. With every input true, the error of the navigator's own
//! dynamics remains.

use std::collections::HashMap;
use std::path::Path;

use contract::navigation::{ChaserOrbit, Event, LineOfSightMeasurement};
use contract::{Body, CameraFrame, ContractError, Direction, Icrs, Rotation};
use far_range::FarRangeScenario;
use far_range::rows::{FrameTruthRow, ObjectTruthRow, read_telemetry};
use files::{Failure, TableReader};
use nalgebra::{Vector2, Vector3};
use scenario::run_file::RunFile;
use serde::{Deserialize, Serialize};
use sim::truth::ObjectKind;

use crate::campaign::Campaign;
use crate::estimator::navigate_with;
use crate::navigator_choice::NavigatorChoice;
use crate::row::NavigationRow;

/// Fraction of the target's electrons outside the transmitted regions above which its image counts as cut.
const MIN_CUT: f64 = 0.1;

/// Input of a navigation that is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Input {
    Detector,
    RegionCut,
    CentreOfBrightness,
    Attitude,
    Mounting,
    Manoeuvres,
    Prior,
    ChaserOrbit,
}

impl Input {
    const ALL: [Self; 8] = [
        Self::Detector,
        Self::RegionCut,
        Self::CentreOfBrightness,
        Self::Attitude,
        Self::Mounting,
        Self::Manoeuvres,
        Self::Prior,
        Self::ChaserOrbit,
    ];

    fn code(self) -> &'static str {
        match self {
            Self::Detector => "detector",
            Self::RegionCut => "region_cut",
            Self::CentreOfBrightness => "centre_of_brightness",
            Self::Attitude => "attitude",
            Self::Mounting => "mounting",
            Self::Manoeuvres => "manoeuvre_knowledge",
            Self::Prior => "prior",
            Self::ChaserOrbit => "chaser_orbit",
        }
    }
}

/// Part of the error of the position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BudgetPart {
    /// Cause: `detector`, `region_cut`, `centre_of_brightness`, `attitude`, `mounting`,
    /// `manoeuvre_knowledge`, `prior`, `chaser_orbit`, `dynamics` or `interaction`.
    pub cause: String,
    /// Root mean square of the part along R, T, N, m.
    pub rms_m: [f64; 3],
    /// Sum of the products of part and error over the sum of the squared errors, along R, T, N: the shares of
    /// all parts add up to 1. Negative for a part that reduces the error.
    pub share: [f64; 3],
}

/// Error budget of a navigation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NavigationBudget {
    /// Name of the scenario.
    pub scenario: String,
    /// Hash of the run's scenario.
    pub hash: String,
    /// Name of the navigator.
    pub navigator: String,
    /// Number of estimates.
    pub estimates: u64,
    /// Root mean square of the error of the position along R, T, N, m.
    pub rms_m: [f64; 3],
    /// Parts, the last of which are `dynamics` (the error that remains with every input true) and
    /// `interaction`.
    pub parts: Vec<BudgetPart>,
    /// Sum of the shares without the interaction, along R, T, N.
    pub share_without_interaction: [f64; 3],
}

/// Computes the error budget of a navigation on a run, from the truth of the run's directory.
///
/// # Errors
/// [`Failure::Usage`] without an estimate, or if an estimate is missing with a true input; those of
/// [`navigate_with`]; a [`Failure`] for truth that cannot be read.
pub fn navigation_budget(
    directory: &Path,
    campaign: &Campaign,
    choice: &NavigatorChoice,
    scratch: &Path,
    every_s: f64,
) -> Result<NavigationBudget, Failure> {
    let run: RunFile<FarRangeScenario> = RunFile::read(&directory.join("run.toml"))?;
    let sources = Sources::read(directory, &run, campaign)?;
    let errors = |injected: &[Input]| -> Result<Vec<[f64; 3]>, Failure> {
        let campaign = sources.inject(campaign, injected)?;
        let factory = choice.factory(&campaign, scratch)?;
        let rows = navigate_with(&campaign, factory.as_ref(), &choice.word, every_s)?.rows;
        let of_row = |row: &NavigationRow| {
            row.position_error_m.ok_or_else(|| {
                let names: Vec<&str> = injected.iter().map(|input| input.code()).collect();
                Failure::Usage(format!(
                    "no estimate at {} with true [{}] ({}), expected one at every time of an error budget",
                    row.time_utc,
                    names.join(", "),
                    row.status
                ))
            })
        };
        rows.iter().map(of_row).collect()
    };
    let total = errors(&[])?;
    let mut rest = total.clone();
    let mut parts = Vec::new();
    let mut add = |cause: &str, part: Vec<[f64; 3]>| {
        subtract(&mut rest, &part);
        parts.push(BudgetPart::new(cause, &part, &total));
    };
    for input in Input::ALL {
        let mut part = total.clone();
        subtract(&mut part, &errors(&[input])?);
        add(input.code(), part);
    }
    add("dynamics", errors(&Input::ALL)?);
    let interaction = BudgetPart::new("interaction", &rest, &total);
    let share_without_interaction = interaction.share.map(|share| 1.0 - share);
    parts.push(interaction);
    Ok(NavigationBudget {
        scenario: campaign.name.clone(),
        hash: campaign.hash.clone(),
        navigator: choice.word.clone(),
        estimates: total.len() as u64,
        rms_m: sums(&total, &total).map(|sum| (sum / total.len().max(1) as f64).sqrt()),
        parts,
        share_without_interaction,
    })
}

impl BudgetPart {
    fn new(cause: &str, part: &[[f64; 3]], total: &[[f64; 3]]) -> Self {
        let squares = sums(total, total);
        let mut share = sums(part, total);
        share.iter_mut().zip(squares).for_each(|(sum, square)| {
            *sum = if square > 0.0 { *sum / square } else { 0.0 };
        });
        let count = part.len().max(1) as f64;
        let rms_m = sums(part, part).map(|sum| (sum / count).sqrt());
        Self { cause: cause.to_owned(), rms_m, share }
    }
}

/// Returns the sums of the products along R, T, N.
fn sums(a: &[[f64; 3]], b: &[[f64; 3]]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (a, b) in a.iter().zip(b) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums
}

fn subtract(from: &mut [[f64; 3]], what: &[[f64; 3]]) {
    for (from, what) in from.iter_mut().zip(what) {
        from.iter_mut().zip(what).for_each(|(from, what)| *from -= what);
    }
}

/// True and measured values of the inputs.
struct Sources {
    frames: HashMap<u64, FrameSource>,
}

/// True and measured values of a frame.
struct FrameSource {
    true_camera_from_icrs: Rotation<CameraFrame, Icrs>,
    true_body_from_icrs: Rotation<Body, Icrs>,
    reported_body_from_icrs: Rotation<Body, Icrs>,
    line_of_sight: Direction<Icrs>,
    /// Centre of brightness minus line of sight, as tangents across columns and rows.
    brightness: Vector2<f64>,
    is_cut: bool,
}

impl Sources {
    fn read(directory: &Path, run: &RunFile<FarRangeScenario>, campaign: &Campaign) -> Result<Self, Failure> {
        let camera = &run.scenario.camera;
        let tangent =
            Vector2::new(camera.pixel_width_um, camera.pixel_height_um) * 1e-3 / camera.focal_length_mm;
        let mut targets = HashMap::new();
        for frame in TableReader::<ObjectTruthRow>::open(&directory.join("truth/objects.parquet"))? {
            let (number, objects) = frame?;
            let target =
                objects.into_iter().map(|row| row.0).find(|object| object.kind == ObjectKind::Target);
            targets.extend(target.map(|target| (number, target)));
        }
        let mut frames = HashMap::new();
        let mut telemetry = read_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
        for rows in TableReader::<FrameTruthRow>::open(&directory.join("truth/frames.parquet"))? {
            for FrameTruthRow(truth) in rows?.1 {
                while telemetry.next_if(|row| row.frame < truth.frame).is_some() {}
                let Some(row) = telemetry.next_if(|row| row.frame == truth.frame) else { continue };
                let target = targets.get(&truth.frame);
                let offset = target.zip(truth.target_position).map(|(target, position)| {
                    let (x, y) = (target.position.x - position.x, target.position.y - position.y);
                    Vector2::new(x, y).component_mul(&tangent)
                });
                let source = FrameSource {
                    true_camera_from_icrs: truth.camera_from_icrs,
                    true_body_from_icrs: truth.body_from_icrs,
                    reported_body_from_icrs: row.telemetry.body_from_icrs,
                    line_of_sight: truth.line_of_sight,
                    brightness: offset.unwrap_or_default(),
                    is_cut: target.is_some_and(|target| target.cut > MIN_CUT),
                };
                frames.insert(truth.frame, source);
            }
        }
        let missing = campaign.arrivals.iter().find_map(|arrival| match &arrival.event {
            Event::LineOfSight(measurement) if !frames.contains_key(&measurement.frame) => {
                Some(measurement.frame)
            }
            _ => None,
        });
        if let Some(frame) = missing {
            return Err(Failure::Usage(format!(
                "{}: no row for frame {frame}, expected one for every measurement",
                directory.join("truth/frames.parquet").display()
            )));
        }
        Ok(Self { frames })
    }

    /// Returns the campaign with true inputs.
    fn inject(&self, campaign: &Campaign, inputs: &[Input]) -> Result<Campaign, Failure> {
        let mut injected = campaign.clone();
        let has = |input: Input| inputs.contains(&input);
        for arrival in &mut injected.arrivals {
            match &mut arrival.event {
                Event::LineOfSight(measurement) => {
                    if let Some(source) = self.frames.get(&measurement.frame) {
                        measurement.line_of_sight =
                            source.line_of_sight(measurement, campaign.attitude_of_images, &has)?;
                    }
                }
                Event::Manoeuvre(manoeuvre) if has(Input::Manoeuvres) => {
                    let mut flown = campaign.truth.trajectory().manoeuvres().iter();
                    if let Some(truth) = flown.find(|flown| flown.report.time == manoeuvre.time) {
                        manoeuvre.dv_rtn_m_s = Vector3::from(truth.executed_dv_rtn_m_s);
                    }
                }
                Event::Manoeuvre(_) => {}
            }
        }
        if has(Input::Prior) {
            let elements = campaign.truth.elements(campaign.epoch())?;
            injected.setup.prior.iter_mut().for_each(|prior| prior.elements = elements);
        }
        if has(Input::ChaserOrbit)
            && let ChaserOrbit::States(states) = &mut injected.setup.chaser_orbit
        {
            for state in states {
                let truth = campaign.truth.trajectory().states_at(state.time).chaser;
                state.position_km = truth.position_km;
                state.velocity_km_s = truth.velocity_km_s;
            }
        }
        Ok(injected)
    }
}

impl FrameSource {
    /// Returns the line of sight with the true values of some inputs. With `is_of_images` the attitude is
    /// that of the image alone; otherwise it is that of telemetry with a mounting.
    fn line_of_sight(
        &self,
        measurement: &LineOfSightMeasurement,
        is_of_images: bool,
        has: &dyn Fn(Input) -> bool,
    ) -> Result<Direction<Icrs>, ContractError> {
        let measured = measurement.camera_from_icrs;
        let mut at = tangents(&(measured * measurement.line_of_sight));
        if has(if self.is_cut { Input::RegionCut } else { Input::Detector }) {
            at = tangents(&(self.true_camera_from_icrs * self.line_of_sight)) + self.brightness;
        }
        if has(Input::CentreOfBrightness) {
            at -= self.brightness;
        }
        let camera_from_icrs = if is_of_images {
            if has(Input::Attitude) { self.true_camera_from_icrs } else { measured }
        } else {
            let mounting = if has(Input::Mounting) {
                self.true_camera_from_icrs * self.true_body_from_icrs.inverse()
            } else {
                measured * self.reported_body_from_icrs.inverse()
            };
            let has_attitude = has(Input::Attitude);
            mounting * if has_attitude { self.true_body_from_icrs } else { self.reported_body_from_icrs }
        };
        let direction = Direction::<CameraFrame>::from_vector(Vector3::new(at.x, at.y, 1.0))?;
        Ok(camera_from_icrs.inverse() * direction)
    }
}

/// Returns the tangents of the angles across columns and across rows.
fn tangents(direction: &Direction<CameraFrame>) -> Vector2<f64> {
    let vector = direction.vector();
    Vector2::new(vector.x, vector.y) / vector.z
}
