//! Verification of requirements, each by the analytic detection model and by simulated frames.
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;

use files::{Failure, file_sha256};
use scenario::run_file::FileDigests;
use sim::catalog::CatalogSource;
use sim::optics::PsfConfig;
use statistics::clopper_pearson;

use crate::confirm::{Bench, StarFrame};
use crate::design::binding::binding_of;
use crate::design::inverse::{Search, search};
use crate::design::{Design, DesignPerformance, design_with};
use crate::report::{SearchResult, SimulatedRate, Status, Verdict, VisibilityReport, curves};
use crate::requirement::definition::Requirements;
use crate::requirement::{Demand, Extreme, FindTable, Parameter, Requirement, SkyStatistic};
use crate::sky::Pointing;

/// Factor by which a found value is changed per step while the full set of boresights does not meet the
/// requirement; [`POLISH_STEPS`] is the largest number of steps.
const POLISH: f64 = 1.005;
const POLISH_STEPS: usize = 8;

/// Verifies all requirements and computes the curves. `progress` is called with the name of each item before
/// it is computed.
///
/// # Errors
/// A [`Failure`] when the camera, the target or a simulation cannot be created.
pub fn assess(requirements: &Requirements, progress: impl Fn(&str)) -> Result<VisibilityReport, Failure> {
    let file = &requirements.file;
    let pointings = file.sky.pointings as usize;
    // All exposures use the same sky.
    let finds = file.requirements.iter().filter_map(|requirement| requirement.find.as_ref());
    let exposures = finds.filter(|find| find.parameter == Parameter::ExposureS).map(|find| find.to);
    let longest_s = exposures.fold(file.exposure.max_s, f64::max);
    let design = Design::new(requirements, &requirements.camera, pointings, longest_s)?;
    progress("the sky");
    let sky = curves::sky(requirements, &design)?;
    if sky.counted == 0 {
        let [sun, moon, earth] = sky.excluded;
        return Err(Failure::Usage(format!(
            "`{}`: the exclusion angles of [sky] exclude all {} pointings (Sun {sun}, Moon {moon}, limb of \
             the Earth {earth}), expected smaller angles that leave some pointings to verify",
            requirements.name, sky.pointings
        )));
    }
    let assessment = Assessment::new(requirements, &design);
    let mut verdicts = Vec::new();
    for requirement in &file.requirements {
        progress(&requirement.id);
        verdicts.push(match &requirement.find {
            None => assessment.as_it_is(requirement)?,
            Some(find) => assessment.find(requirement, find)?,
        });
    }
    progress("curves");
    let detection = curves::detection(requirements, &design)?;
    let frames = assessment.star_frames(file.exposure.nominal_s)?;
    let (exposure_window, stars_lost) = curves::exposure_window(requirements, &design)?;
    Ok(VisibilityReport {
        name: requirements.name.clone(),
        title: file.title.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        files: digests(requirements)?,
        camera: curves::camera_figures(requirements, &design)?,
        requirements: verdicts,
        detection_simulated: curves::detection_simulated(&frames, &detection),
        detection,
        limiting_magnitude: curves::limiting_magnitude(requirements, &design)?,
        sky,
        exposure_window,
        stars_lost,
        target_range: curves::target_range(requirements, &design)?,
    })
}

struct Assessment<'a> {
    requirements: &'a Requirements,
    design: &'a Design<'a>,
    /// Simulated frames over the sky, with their exposures, kept for reuse.
    frames: RefCell<Vec<(f64, Rc<Vec<StarFrame>>)>>,
}

/// Confidence of each bound outside which a simulated rate disagrees with the model: random variation causes
/// this in one of five hundred results.
const DISAGREEMENT: f64 = 0.999;

/// Describes the simulated rate where the model predicts `model`, including whether the two disagree.
fn simulation_text(simulated: Option<&SimulatedRate>, model: f64) -> String {
    let Some(s) = simulated else { return "not simulated".to_owned() };
    let (low, high) = clopper_pearson(s.count, s.of, DISAGREEMENT);
    let remark = if (low..=high).contains(&model) { "" } else { ", which DISAGREES with the model" };
    format!(
        "simulated {} of {} frames ({:.1} to {:.1} %){remark}",
        s.count,
        s.of,
        100.0 * s.low,
        100.0 * s.high
    )
}

/// Binding limit when the model meets a requirement but the frames do not.
const REFUTED: &str = "simulation: fewer frames meet the requirement than the detection model predicts";
/// Largest number of frames for which the number needed for a decision is computed.
const MAX_FRAMES: u64 = 10_000;

/// Returns the combined result of model and simulation: the simulation may refute or confirm the model at its
/// confidence.
fn status(asked: f64, reached: f64, simulated: Option<&SimulatedRate>) -> Status {
    match simulated {
        _ if reached < asked => Status::NotMet,
        None => Status::MetModel,
        Some(s) if s.high < asked => Status::NotMet,
        Some(s) if s.low >= asked => Status::MetSimulated,
        Some(s) if cannot_show(asked, s) => Status::MetModel,
        Some(_) => Status::NotDecided,
    }
}

/// Returns true if the lower bound would be below the required rate even if all simulated frames met it.
fn cannot_show(asked: f64, simulated: &SimulatedRate) -> bool {
    clopper_pearson(simulated.of, simulated.of, simulated.confidence).0 < asked
}

/// Describes the number of frames needed to show that the requirement is met; empty if the simulated frames
/// are enough.
fn frames_in_words(status: Status, asked: f64, reached: f64, simulated: Option<&SimulatedRate>) -> String {
    let Some(s) = simulated else { return String::new() };
    if !(status == Status::NotDecided || status == Status::MetModel) {
        return String::new();
    }
    let shows = |frames: u64| {
        let count = (reached * frames as f64).floor() as u64;
        clopper_pearson(count, frames, s.confidence).0 >= asked
    };
    let enough = std::iter::successors(Some(s.of.max(1)), |frames| Some(frames + frames.div_ceil(10)))
        .take_while(|frames| *frames <= MAX_FRAMES)
        .find(|frames| shows(*frames));
    let too_few = "too few frames for a proof";
    enough.map_or_else(|| format!(", {too_few}"), |frames| format!(", {too_few}: about {frames} needed"))
}

impl<'a> Assessment<'a> {
    fn new(requirements: &'a Requirements, design: &'a Design<'a>) -> Self {
        Self { requirements, design, frames: RefCell::default() }
    }

    /// Determines whether the given camera, unchanged, meets a requirement.
    fn as_it_is(&self, requirement: &Requirement) -> Result<Verdict, Failure> {
        let file = &self.requirements.file;
        let demand = &requirement.demand;
        let asked = demand.probability(file.probability);
        let reached = self.design.reached(demand, None)?;
        let simulated = self.simulate(demand, &reached, None)?;
        let status = status(asked, reached.probability, simulated.as_ref());
        let binds = match status {
            Status::NotMet if reached.probability < asked => {
                Some(binding_of(self.design, self.requirements, demand, None, asked)?)
            }
            Status::NotMet => Some(REFUTED.to_owned()),
            _ => None,
        };
        let (margin, margin_unit) = self.margin(demand, &reached, asked)?;
        Ok(Verdict {
            id: requirement.id.clone(),
            text: requirement.text.clone(),
            status,
            asked,
            reached: reached.probability,
            margin,
            margin_unit: margin_unit.into(),
            evidence: format!(
                "{}; {}{}",
                self.reached_in_words(demand, &reached, asked),
                simulation_text(simulated.as_ref(), reached.probability),
                frames_in_words(status, asked, reached.probability, simulated.as_ref())
            ),
            simulated,
            found: None,
            binds,
        })
    }

    /// Finds the value of a parameter that meets a requirement.
    fn find(&self, requirement: &Requirement, find: &FindTable) -> Result<Verdict, Failure> {
        let file = &self.requirements.file;
        let demand = &requirement.demand;
        let asked = demand.probability(file.probability);
        let (parameter, unit) = find.parameter.name_and_unit();
        let verdict = Verdict {
            id: requirement.id.clone(),
            text: requirement.text.clone(),
            status: Status::Impossible,
            asked,
            reached: 0.0,
            margin: None,
            margin_unit: unit.into(),
            evidence: String::new(),
            simulated: None,
            found: None,
            binds: None,
        };
        let found = match search(self.requirements, self.design, demand, find)? {
            Search::Impossible { best_value, best_probability, binds } => {
                return Ok(Verdict {
                    reached: best_probability,
                    evidence: format!(
                        "{parameter} {} to {} {unit}: at most {:.1} %, at {} {unit}",
                        digits(find.from),
                        digits(find.to),
                        100.0 * best_probability,
                        digits(best_value)
                    ),
                    binds: Some(binds),
                    ..verdict
                });
            }
            Search::Found(found) => found,
        };

        // The value itself, and the next one that fails.
        let value = self.polished(demand, find, found.value, asked)?;
        let (reached, simulated) = self.at_value(demand, find.parameter, value)?;
        let (failing_probability, failing_simulated) = match found.failing_value {
            Some(failing) => {
                let (reached, simulated) = self.at_value(demand, find.parameter, failing)?;
                (Some(reached.probability), simulated)
            }
            None => (None, None),
        };
        let result = SearchResult {
            parameter: parameter.into(),
            unit: unit.into(),
            value,
            probability: reached.probability,
            aimed: found.goal,
            threshold_value: found.threshold_value,
            simulated,
            failing_value: found.failing_value,
            failing_probability,
            failing_simulated,
            is_monotone: found.is_monotone,
        };

        // The margin is that of the given camera.
        let own = match find.parameter {
            Parameter::ExposureS => Some(file.exposure.nominal_s),
            other => self.requirements.camera.value(other),
        };
        let margin = own.map(|own| if find.want == Extreme::Largest { value - own } else { own - value });
        let status = status(asked, reached.probability, simulated.as_ref());
        Ok(Verdict {
            status,
            reached: reached.probability,
            margin,
            evidence: found_in_words(&result, status, asked, file.confirm.frames),
            simulated,
            binds: (status == Status::NotMet).then(|| REFUTED.to_owned()),
            found: Some(result),
            ..verdict
        })
    }

    /// Changes a value found with a subset of the boresights, by at most a few steps, until the detection
    /// model meets the requirement over all boresights.
    fn polished(&self, demand: &Demand, find: &FindTable, found: f64, asked: f64) -> Result<f64, Failure> {
        let inwards = if find.want == Extreme::Largest { 1.0 / POLISH } else { POLISH };
        let mut value = found;
        for _ in 0..POLISH_STEPS {
            if self.model_at(demand, find.parameter, value)?.probability >= asked {
                break;
            }
            value = (value * inwards).clamp(find.from, find.to);
        }
        Ok(value)
    }

    /// Returns the result of the detection model for a value of a parameter.
    fn model_at(
        &self,
        demand: &Demand,
        parameter: Parameter,
        value: f64,
    ) -> Result<DesignPerformance, Failure> {
        if parameter == Parameter::ExposureS && self.design.covers(value) {
            return Ok(self.design.reached(demand, Some(value))?);
        }
        let pointings = self.requirements.file.sky.pointings as usize;
        let (design, exposure_s) = design_with(self.requirements, parameter, value, pointings)?;
        Ok(design.reached(demand, exposure_s)?)
    }

    /// Returns the results of detection model and simulation for a value of a parameter.
    fn at_value(
        &self,
        demand: &Demand,
        parameter: Parameter,
        value: f64,
    ) -> Result<(DesignPerformance, Option<SimulatedRate>), Failure> {
        if parameter == Parameter::ExposureS && self.design.covers(value) {
            let reached = self.design.reached(demand, Some(value))?;
            let simulated = self.simulate(demand, &reached, Some(value))?;
            return Ok((reached, simulated));
        }
        let pointings = self.requirements.file.sky.pointings as usize;
        let (design, exposure_s) = design_with(self.requirements, parameter, value, pointings)?;
        let reached = design.reached(demand, exposure_s)?;
        let at = Assessment::new(self.requirements, &design);
        let simulated = at.simulate(demand, &reached, exposure_s)?;
        Ok((reached, simulated))
    }

    /// Simulates the frames that a demand concerns, at its worst conditions. A limiting magnitude has no
    /// separate frames: the stars in the frames of the sky are shown beside the detection curve.
    fn simulate(
        &self,
        demand: &Demand,
        reached: &DesignPerformance,
        exposure_s: Option<f64>,
    ) -> Result<Option<SimulatedRate>, Failure> {
        let file = &self.requirements.file;
        let frames = file.confirm.frames;
        if frames == 0 {
            return Ok(None);
        }
        let exposure_s = exposure_s.unwrap_or(reached.exposure_s);
        let count = match demand {
            Demand::LimitingMagnitude { .. } => return Ok(None),
            Demand::Stars { n_min, over, .. } => {
                self.enough_stars(exposure_s, n_min.unwrap_or(file.n_min), *over)?
            }
            Demand::ExposureWindow { n_min, .. } if reached.exposure_s >= file.exposure.min_s => {
                self.enough_stars(reached.exposure_s, n_min.unwrap_or(file.n_min), SkyStatistic::Sky)?
            }
            Demand::ExposureWindow { .. } => return Ok(None),
            Demand::TargetDetected { phase_max_deg, .. } => {
                let (Some(body), Some(range_km)) = (&self.requirements.target, reached.range_km) else {
                    return Ok(None);
                };
                let groups = self.design.groups(*phase_max_deg);
                let (_, worst) = self.design.target_chance(&groups, range_km, exposure_s)?;
                let Some(group) = groups.get(worst) else { return Ok(None) };
                let scenario = self.requirements.scenario.as_ref();
                Some(self.bench().target(body, scenario, &group.aspects, range_km, exposure_s, frames)?)
            }
        };
        let confidence = file.confirm.confidence;
        Ok(count.map(|count| {
            let of = u64::from(frames);
            let (low, high) = clopper_pearson(count, of, confidence);
            SimulatedRate { count, of, low, high, confidence }
        }))
    }

    /// Returns the number of frames with enough stars; `None` when no pointing counts.
    fn enough_stars(&self, exposure_s: f64, n_min: u32, over: SkyStatistic) -> Result<Option<u64>, Failure> {
        let frames = match over {
            SkyStatistic::Sky => self.star_frames(exposure_s)?,
            SkyStatistic::EveryPointing => Rc::new(self.frames_of_the_worst(exposure_s, n_min)?),
        };
        let enough = frames.iter().filter(|frame| frame.detected >= n_min).count() as u64;
        Ok((!frames.is_empty()).then_some(enough))
    }

    /// Simulates frames of stars at pointings that count, spread over the sky.
    fn star_frames(&self, exposure_s: f64) -> Result<Rc<Vec<StarFrame>>, Failure> {
        if let Some((_, known)) = self.frames.borrow().iter().find(|(known, _)| *known == exposure_s) {
            return Ok(Rc::clone(known));
        }
        let count = self.requirements.file.confirm.frames as usize;
        let counted: Vec<&Pointing> =
            self.design.sky()?.usable_fields().map(|field| &field.pointing).collect();
        let places = if counted.is_empty() { 0..0 } else { 0..count };
        let pointings: Vec<Pointing> =
            places.map(|k| counted[(2 * k + 1) * counted.len() / (2 * count)].clone()).collect();
        let frames = Rc::new(self.bench().stars(&pointings, exposure_s)?);
        self.frames.borrow_mut().push((exposure_s, Rc::clone(&frames)));
        Ok(frames)
    }

    /// Simulates frames of stars, all at the pointing with the smallest probability of enough stars.
    fn frames_of_the_worst(&self, exposure_s: f64, n_min: u32) -> Result<Vec<StarFrame>, Failure> {
        let seen = self.design.stars(exposure_s, n_min)?;
        let counted = self.design.sky()?.usable_fields().zip(&seen);
        let worst = counted.min_by(|(_, a), (_, b)| a.chance.total_cmp(&b.chance));
        let Some((field, _)) = worst else { return Ok(Vec::new()) };
        let pointings = vec![field.pointing.clone(); self.requirements.file.confirm.frames as usize];
        self.bench().stars(&pointings, exposure_s)
    }

    fn bench(&self) -> Bench<'_> {
        let file = &self.requirements.file;
        Bench {
            camera: &self.design.camera.config,
            rule: &file.detection,
            motion: &file.motion,
            seed: file.seed,
        }
    }

    /// Returns the margin of the given camera, with its unit: percentage points, magnitudes or kilometres.
    fn margin(
        &self,
        demand: &Demand,
        reached: &DesignPerformance,
        asked: f64,
    ) -> Result<(Option<f64>, &'static str), Failure> {
        Ok(match demand {
            Demand::Stars { .. } => (Some(100.0 * (reached.probability - asked)), "points"),
            Demand::LimitingMagnitude { magnitude, .. } => {
                let limit = self.design.limiting_magnitude(reached.exposure_s, asked)?;
                (limit.map(|limit| limit - magnitude), "mag")
            }
            Demand::TargetDetected { to_km, phase_max_deg, .. } => {
                let groups = self.design.groups(*phase_max_deg);
                let greatest = curves::greatest_range_km(self.design, &groups, reached.exposure_s, asked)?;
                (greatest.map(|greatest| greatest - to_km), "km")
            }
            Demand::ExposureWindow { .. } => (Some(100.0 * (reached.probability - asked)), "points"),
        })
    }

    fn reached_in_words(&self, demand: &Demand, reached: &DesignPerformance, asked: f64) -> String {
        let DesignPerformance { probability, exposure_s, range_km } = *reached;
        let percent = format!("{:.1} % ({:.1} % required)", 100.0 * probability, 100.0 * asked);
        let exposure = format!("{} s", digits(exposure_s));
        match (demand, range_km) {
            (Demand::Stars { n_min, over, .. }, _) => {
                let n_min = n_min.unwrap_or(self.requirements.file.n_min);
                let place = match over {
                    SkyStatistic::Sky => "over the sky",
                    SkyStatistic::EveryPointing => "at the worst pointing",
                };
                format!("{n_min} stars at {exposure} {place}: {percent}")
            }
            (Demand::LimitingMagnitude { magnitude, .. }, _) => {
                format!("V = {magnitude} at {exposure}: {percent}")
            }
            (_, Some(range_km)) => format!("at {} km and {exposure}: {percent}", digits(range_km)),
            (_, None) => percent,
        }
    }
}

/// Returns the evidence of a value that a search found, in words. `frames` is the number of simulated frames
/// that confirm it.
fn found_in_words(found: &SearchResult, status: Status, asked: f64, frames: u32) -> String {
    let SearchResult { parameter, unit, probability, simulated, .. } = found;
    let mut words = format!(
        "{parameter} {} {unit}: {:.1} %, {}{}",
        digits(found.value),
        100.0 * probability,
        simulation_text(simulated.as_ref(), *probability),
        frames_in_words(status, asked, *probability, simulated.as_ref())
    );
    if found.aimed > asked {
        let (aimed, asked) = (100.0 * found.aimed, 100.0 * asked);
        words.push_str(&format!(
            "; searched for {aimed:.1} %, at which {frames} frames prove the required {asked:.1} %"
        ));
    }
    if let (Some(value), Some(probability)) = (found.failing_value, found.failing_probability) {
        let simulated = simulation_text(found.failing_simulated.as_ref(), probability);
        let percent = 100.0 * probability;
        words.push_str(&format!("; {} {unit}: {percent:.1} %, {simulated}", digits(value)));
    }
    if !found.is_monotone {
        words.push_str("; not met everywhere beyond this value");
    }
    words
}

/// Formats a number to three significant digits.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{value}");
    }
    let places = (2.0 - libm::log10(size).floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.places$}")
}

/// Returns the SHA-256 of each file that a camera reads.
fn digests(requirements: &Requirements) -> Result<FileDigests, Failure> {
    let mut digests = FileDigests::new();
    let catalog = match &requirements.camera.catalog.source {
        CatalogSource::File(path) => Some(("catalog.source", path)),
        CatalogSource::Hipparcos2 => None,
    };
    let psf = match &requirements.camera.psf {
        PsfConfig::Sampled { path, .. } => Some(("psf.path", path)),
        _ => None,
    };
    for (role, path) in catalog.into_iter().chain(psf) {
        digests.extend(file_sha256(Path::new(path))?.map(|sha256| (role.to_owned(), sha256)));
    }
    Ok(digests)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simulated(count: u64, of: u64) -> SimulatedRate {
        let confidence = 0.95;
        let (low, high) = clopper_pearson(count, of, confidence);
        SimulatedRate { count, of, low, high, confidence }
    }

    #[test]
    fn model_and_simulation_are_distinguished() {
        let of = |reached, count, frames| status(0.9, reached, Some(&simulated(count, frames)));
        assert_eq!(status(0.9, 0.95, None), Status::MetModel);
        assert_eq!(status(0.9, 0.85, None), Status::NotMet);
        // 0.9^28 = 0.052, 0.9^29 = 0.047.
        assert_eq!(of(0.95, 28, 28), Status::MetModel);
        assert_eq!(of(0.95, 29, 29), Status::MetSimulated);
        assert_eq!(of(0.95, 27, 29), Status::NotDecided);
        assert_eq!(of(0.95, 15, 29), Status::NotMet);
        assert_eq!(of(0.85, 29, 29), Status::NotMet);
    }

    #[test]
    fn the_frames_that_would_decide_are_named() {
        let words = |reached| frames_in_words(Status::NotDecided, 0.9, reached, Some(&simulated(27, 29)));
        assert!(words(1.0).contains("about 29 needed"), "{}", words(1.0));
        assert_eq!(words(0.9), ", too few frames for a proof");
    }
}
