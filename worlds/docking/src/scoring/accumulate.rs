//! Accumulation of fields into figures.

use std::collections::BTreeMap;

use contract::docking::{DockingOutcome, DockingSetup, FailedCheck, Motion, MotionReport};
use score::{Better, Figure, FigureSpec, FigureTerms, ScoreError, UnitTable, UnitVerdict, WARM_UP, counts};

use super::bins::{bin, group_name, lens_names};
use super::cause::MissCause;
use super::consistency::{nees, within_3_sigma};
use super::errors::{PoseErrors, phi_error};
use super::field_verdict::FieldVerdict;
use super::figures::definitions;
use super::imaging_geometry::ImagingGeometry;
use super::portions::{MotionVerdict, PortionVerdict};
use super::report::{DockingGroup, DockingScore, names};
use super::truth::{TargetVisibility, TrueField};
use super::verdict::{GrossError, Verdict, gross};

/// Inputs of the score of a docking run besides the fields.
#[derive(Debug, Clone)]
pub struct DockingContext {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of Boresight.
    pub version: String,
    /// Renderer of the scene: `fast` or `mitsuba`.
    pub renderer: String,
    /// Number of field numbers, from the first field on, in which the pipeline starts up: their verdicts form
    /// a separate group ([`WARM_UP`]), and all other figures except the latency exclude them.
    pub warm_up_frames: u64,
    /// True cameras, and the target's true dimensions.
    pub setup: DockingSetup,
}

/// Scores the fields of a docking run one after the other.
pub struct DockingScorer {
    context: DockingContext,
    geometry: ImagingGeometry,
    verdicts: Vec<FieldVerdict>,
    last_field: Option<u64>,
    portions: PortionClock,
}

/// Start of the current portion and end of the previous one.
#[derive(Debug, Default)]
struct PortionClock {
    /// True if the best estimator, or the paper's, has already reported a motion.
    has_best: bool,
    has_paper: bool,
    /// Number of fields from the portion's first measured one on, including it; 0 before that field.
    fields: u64,
    /// Time of the first measured field, s.
    begin_s: Option<f64>,
    last_report_s: Option<f64>,
}

/// Longest time between two reports, s (docking paper, section 2), plus a microsecond for the rounding of
/// times.
const RENEWAL_S: f64 = 1.0 + 1e-6;

impl PortionClock {
    /// Returns true if the last report is at most a second old; `None` until a second after the first
    /// measured field.
    fn is_renewed(&self, time_s: f64) -> Option<bool> {
        let renewed = |since_s: f64| time_s - since_s <= RENEWAL_S;
        self.begin_s.filter(|begin_s| !renewed(*begin_s))?;
        Some(self.last_report_s.is_some_and(renewed))
    }
}

impl DockingScorer {
    /// Creates a scorer without fields.
    pub fn new(context: DockingContext) -> Self {
        let geometry = ImagingGeometry::new(&context.setup);
        let portions = PortionClock::default();
        Self { context, geometry, verdicts: Vec::new(), last_field: None, portions }
    }

    /// Scores the next field; `outcome` is `None` when the measurements have no row for the field.
    ///
    /// # Errors
    /// [`ScoreError::Order`] unless the field number is larger than the previous one. The field is then not
    /// counted.
    pub fn add(&mut self, truth: &TrueField, outcome: Option<&DockingOutcome>) -> Result<(), ScoreError> {
        self.add_with_report(truth, outcome, outcome.and_then(|outcome| outcome.motion.as_ref()))
    }

    /// Scores the next field like [`DockingScorer::add`], with a report that is separate from the outcome, as
    /// in files.
    ///
    /// # Errors
    /// Those of [`DockingScorer::add`].
    pub fn add_with_report(
        &mut self,
        truth: &TrueField,
        outcome: Option<&DockingOutcome>,
        report: Option<&MotionReport>,
    ) -> Result<(), ScoreError> {
        if let Some(previous) = self.last_field.filter(|previous| *previous >= truth.field) {
            return Err(ScoreError::Order { previous, frame: truth.field });
        }
        self.last_field = Some(truth.field);
        let verdict = Verdict::from_outcome(&self.geometry, truth, outcome);
        let measurement = outcome.and_then(DockingOutcome::measurement);
        let success = measurement.filter(|_| matches!(verdict, Verdict::Success { .. }));
        let error = success.map(|measurement| {
            let (best, truth) = (&measurement.best.pose, &truth.pose);
            let (d, phi) = (best.position_m - truth.position_m, phi_error(best, truth));
            (nalgebra::Vector6::new(d.x, d.y, d.z, phi.x, phi.y, phi.z), &measurement.best.covariance)
        });
        let paper = outcome
            .and_then(DockingOutcome::any_measurement)
            .and_then(|measurement| measurement.paper)
            .map(|pose| PoseErrors::new(&pose, &truth.pose));
        let range_m = truth.pose.position_m.norm();
        let portion = self.judge_portion(truth, measurement.is_some(), report);
        let is_resolved = self.geometry.resolves(truth.camera, &truth.pose);
        let is_clear = truth.visibility == TargetVisibility::Full && is_resolved;
        let first = self.verdicts.first().map_or(truth.field, |first| first.field);
        let is_warm_up = truth.field - first < self.context.warm_up_frames;
        self.verdicts.push(FieldVerdict {
            field: truth.field,
            group: (!is_warm_up).then(|| (bin(range_m), truth.camera)),
            range_m,
            is_clear,
            is_renewed: self.portions.is_renewed(truth.time_s).filter(|_| is_clear),
            is_measured: measurement.is_some(),
            is_asked: is_resolved || measurement.is_some(),
            verdict,
            nees: error.and_then(|(error, covariance)| nees(&error, covariance)),
            within: error.map(|(error, covariance)| {
                std::array::from_fn(|i| within_3_sigma(error[i], covariance[(i, i)].sqrt()))
            }),
            paper,
            paper_is_wrong: paper.is_some_and(|errors| gross(&self.geometry, truth, &errors).is_some()),
            portion,
        });
        Ok(())
    }

    /// Counts a field of the current portion, and judges the motion that it reports, which ends the portion.
    fn judge_portion(
        &mut self,
        truth: &TrueField,
        is_measured: bool,
        report: Option<&MotionReport>,
    ) -> Option<PortionVerdict> {
        let clock = &mut self.portions;
        // A portion begins with its first measured field.
        let has_begun = clock.fields > 0;
        if has_begun || is_measured {
            clock.fields += 1;
        }
        if is_measured {
            clock.begin_s.get_or_insert(truth.time_s);
        }
        let report = report?;
        let geometry = &self.geometry;
        let judge = |motion: Option<&Motion>, has_one: &mut bool| {
            let is_led = *has_one;
            *has_one |= motion.is_some();
            motion.map(|motion| MotionVerdict::from_motion(geometry, truth, motion, is_led))
        };
        let verdict = PortionVerdict {
            best: judge(report.best.as_ref(), &mut clock.has_best),
            paper: judge(report.paper.as_ref(), &mut clock.has_paper),
            fields: clock.fields,
        };
        clock.fields = 0;
        clock.last_report_s = Some(truth.time_s);
        Some(verdict)
    }

    /// Returns every field with its contributions to each figure, except the latency, which is defined only
    /// for a complete sequence.
    pub fn units(&self) -> UnitTable {
        let lenses = lens_names(&self.context.setup.cameras);
        let unit = |field: &FieldVerdict| {
            let (verdict, cause) = match &field.verdict {
                Verdict::Success { .. } => ("success", None),
                Verdict::RangeOnly { .. } => ("range_only", None),
                Verdict::Doubtful { doubt, .. } => ("doubtful", Some(doubt.code())),
                Verdict::Wrong { gross } => ("wrong", Some(gross.code())),
                Verdict::Missed { cause } => ("missed", Some(cause.code())),
            };
            UnitVerdict {
                number: field.field,
                group: group_key(field.group, &lenses),
                verdict: verdict.to_owned(),
                cause: cause.map(str::to_owned),
            }
        };
        UnitTable {
            units: self.verdicts.iter().map(unit).collect(),
            figures: definitions()
                .iter()
                .map(|figure| {
                    FigureTerms::from_counted_units(figure, &self.verdicts, |field| field.group.is_some())
                })
                .collect(),
        }
    }

    /// Returns the figures over all fields. For the statistics a bin of range and lens is one sequence, even
    /// if another bin interrupts it.
    pub fn score(&self) -> DockingScore {
        // The warm-up, with the key `None`, sorts before all bins.
        let mut groups: BTreeMap<Option<(usize, usize)>, Vec<&FieldVerdict>> = BTreeMap::new();
        for verdict in &self.verdicts {
            groups.entry(verdict.group).or_default().push(verdict);
        }
        let counted = groups.iter().filter(|(group, _)| group.is_some());
        let sequences: Vec<&[&FieldVerdict]> = counted.map(|(_, fields)| fields.as_slice()).collect();
        let mut all = group_score(&sequences);
        let latency = Figure::mean(&[latency(&self.verdicts).into_iter().collect()]);
        all.figures.insert(names::LATENCY_FIELDS.to_owned(), latency);
        let lenses = lens_names(&self.context.setup.cameras);
        DockingScore {
            world: "docking".to_owned(),
            scenario: self.context.scenario.clone(),
            seed: self.context.seed,
            version: self.context.version.clone(),
            renderer: self.context.renderer.clone(),
            warm_up_frames: self.context.warm_up_frames,
            frames: all.frames,
            portions: all.portions,
            figures: all.figures,
            groups: groups
                .iter()
                .map(|(group, fields)| (group_key(*group, &lenses), group_score(&[fields])))
                .collect(),
            misses: all.misses,
            wrong: all.wrong,
            doubtful: all.doubtful,
        }
    }
}

fn group_key(group: Option<(usize, usize)>, lenses: &[String]) -> String {
    let Some((bin, camera)) = group else { return WARM_UP.to_owned() };
    let lens = lenses.get(camera).cloned().unwrap_or_else(|| format!("camera {camera}"));
    group_name(bin, &lens)
}

/// Returns the figures of every score, in order.
pub fn figures() -> Vec<FigureSpec> {
    let latency = FigureSpec::amount(names::LATENCY_FIELDS, "latency fields", Better::Less);
    definitions().into_iter().map(|definition| definition.figure).chain([latency]).collect()
}

/// Returns the number of fields from the first clear one to the first success at or after it; `None` if
/// either is missing.
fn latency(verdicts: &[FieldVerdict]) -> Option<f64> {
    let after = &verdicts[verdicts.iter().position(|field| field.is_clear)?..];
    let waited = after.iter().position(|field| matches!(field.verdict, Verdict::Success { .. }))?;
    Some(waited as f64)
}

/// Returns the score of several sequences of fields taken together.
fn group_score(sequences: &[&[&FieldVerdict]]) -> DockingGroup {
    let fields = || sequences.iter().copied().flatten();
    let misses = fields().filter_map(|field| match &field.verdict {
        Verdict::Missed { cause } => Some(cause.code()),
        _ => None,
    });
    let wrong = fields().filter_map(|field| match field.verdict {
        Verdict::Wrong { gross } => Some(gross.code()),
        _ => None,
    });
    let doubtful = fields().filter_map(|field| match field.verdict {
        Verdict::Doubtful { doubt, .. } => Some(doubt.code()),
        _ => None,
    });
    DockingGroup {
        frames: fields().count() as u64,
        portions: fields().filter(|field| field.portion.is_some()).count() as u64,
        figures: definitions()
            .iter()
            .map(|definition| (definition.figure.name.clone(), definition.figure(sequences)))
            .collect(),
        misses: counts(&MissCause::CODES, misses),
        wrong: counts(&GrossError::ALL.map(GrossError::code), wrong),
        doubtful: counts(&FailedCheck::ALL.map(FailedCheck::code), doubtful),
    }
}

#[cfg(test)]
mod tests;
