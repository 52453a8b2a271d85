//! One camera design, and the probability of meeting a demand according to the analytic detection model.

pub(crate) mod binding;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod inverse;
use std::cell::OnceCell;

use contract::OutOfRange;
use files::Failure;
use sim::SimError;

use crate::camera::{CameraConfig, CameraModel};
use crate::detection_model::detection::DetectionCurve;
use crate::requirement::definition::Requirements;
use crate::requirement::{
    Demand, DetectionRule, MotionGuidance, MotionTable, Parameter, SkyStatistic, TargetLight,
};
use crate::sky::Sky;
use crate::sky::star_count::{Curves, StarCount, over_sky, star_trail_px};
use crate::target::{
    Aspect, TargetModel, TargetObservation, longest_unsaturated_exposures_s, longest_with_probability,
};

/// Number of ranges that are evaluated within an interval, both ends included.
const RANGES: usize = 7;
/// Smallest detection probability at the longest exposure of a star that the sky includes.
const MIN_PROBABILITY: f64 = 1e-4;
/// Factor that lowers the smallest flux of the stars in the sky, for backgrounds that raise a pixel towards a
/// threshold in digital numbers.
const FAINT_FLUX_FACTOR: f64 = 0.5;

/// A camera, its motion, and the sky that it observes.
pub struct Design<'a> {
    requirements: &'a Requirements,
    /// Model of the camera.
    pub camera: CameraModel,
    /// Motion of the camera.
    pub motion: MotionTable,
    /// Rule for counting an object as detected.
    pub rule: DetectionRule,
    target: Option<TargetModel>,
    pointings: usize,
    longest_s: f64,
    sky: OnceCell<Sky>,
    background_e_per_s: OnceCell<f64>,
}

/// Result of a design for a demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignPerformance {
    /// Probability under the worst conditions of the demand.
    pub probability: f64,
    /// Exposure at which this probability is reached, s.
    pub exposure_s: f64,
    /// Range with the smallest probability, km.
    pub range_km: Option<f64>,
}

/// Aspects that are evaluated together: their mean probability must reach the required one.
#[derive(Debug, Clone, PartialEq)]
pub struct AspectGroup {
    /// Smallest and largest phase angle, degrees.
    pub phases_deg: [f64; 2],
    /// Aspects of the group, all equally likely.
    pub aspects: Vec<Aspect>,
}

impl<'a> Design<'a> {
    /// Creates a design for these requirements, evaluated at `pointings` boresights, with exposures up to
    /// `longest_s`.
    ///
    /// # Errors
    /// A [`Failure`] for a camera or a target that cannot be created.
    pub fn new(
        requirements: &'a Requirements,
        camera: &CameraConfig,
        pointings: usize,
        longest_s: f64,
    ) -> Result<Self, Failure> {
        let file = &requirements.file;
        let target = match (&requirements.target, &file.target) {
            (Some(body), Some(table)) => {
                Some(TargetModel::new(body, &table.light, requirements.scenario.as_ref())?)
            }
            _ => None,
        };
        Ok(Self {
            requirements,
            camera: CameraModel::new(camera)?,
            motion: file.motion,
            rule: file.detection,
            target,
            pointings,
            longest_s: longest_s.max(file.exposure.max_s),
            sky: OnceCell::new(),
            background_e_per_s: OnceCell::new(),
        })
    }

    /// Returns the same design with about `count` of its boresights, evenly spread: every n-th point of a
    /// Fibonacci lattice is itself evenly spread.
    ///
    /// # Errors
    /// The errors of [`Design::new`].
    pub fn thinned(&self, count: usize) -> Result<Self, Failure> {
        let thin = Self::new(self.requirements, &self.camera.config, self.pointings, self.longest_s)?;
        let step = self.pointings.div_ceil(count.max(1));
        let fields = self.sky()?.fields.iter().step_by(step).cloned().collect();
        // The sky of the new design has not been computed yet.
        let _ = thin.sky.set(Sky { fields });
        Ok(thin)
    }

    /// Returns true if the design's sky was made for exposures as long as this one.
    pub fn covers(&self, exposure_s: f64) -> bool {
        exposure_s <= self.longest_s
    }

    /// Returns the same design without smear: on an extremely wide orbit, neither stars nor target move in
    /// the image.
    #[must_use]
    pub fn without_smear(mut self) -> Self {
        self.motion.semi_major_axis_km = 1e15;
        // The sky is still that of the original orbit.
        self
    }

    /// Returns the sky that the camera observes, and computes it at the first call.
    ///
    /// # Errors
    /// [`SimError`] when the catalogue cannot be read.
    pub fn sky(&self) -> Result<&Sky, SimError> {
        if self.sky.get().is_none() {
            let file = &self.requirements.file;
            // The longest exposure detects the faintest stars, unless its background hides them.
            let faintest = |exposure_s: f64| {
                let trail_px = star_trail_px(&self.camera, &self.motion, exposure_s);
                let curve = DetectionCurve::new(&self.camera, &self.rule, trail_px, exposure_s, 0.0);
                curve.electrons_for(MIN_PROBABILITY).map_or(1e12, |electrons| electrons / exposure_s)
            };
            let exposures = between(file.exposure.min_s, self.longest_s, 9);
            let least_e_per_s = FAINT_FLUX_FACTOR * exposures.map(faintest).fold(1e12, f64::min);
            let sky = Sky::new(&self.camera, &file.motion, &file.sky, self.pointings, least_e_per_s)?;
            // No other thread can have set the sky: the design is not shared.
            let _ = self.sky.set(sky);
        }
        self.sky.get().ok_or_else(|| OutOfRange::new("sky", "none", "a sky").into())
    }

    /// Returns the median background over the boresights that count, electrons per second and pixel.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn background_e_per_s(&self) -> Result<f64, SimError> {
        if let Some(known) = self.background_e_per_s.get() {
            return Ok(*known);
        }
        let mut all: Vec<f64> = self.sky()?.usable_fields().map(|field| field.background_e_per_s).collect();
        all.sort_by(f64::total_cmp);
        Ok(*self.background_e_per_s.get_or_init(|| all.get(all.len() / 2).copied().unwrap_or(0.0)))
    }

    /// Returns the detection statistics of the stars at every boresight that counts.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn stars(&self, exposure_s: f64, n_min: u32) -> Result<Vec<StarCount>, SimError> {
        let sky = self.sky()?;
        let curves = Curves::from_sky(&self.camera, &self.rule, &self.motion, exposure_s, sky);
        Ok(curves.count_stars_over_sky(sky, n_min as usize))
    }

    /// Returns P(N ≥ n_min) over the sky.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn stars_chance(&self, exposure_s: f64, n_min: u32, over: SkyStatistic) -> Result<f64, SimError> {
        Ok(over_sky(&self.stars(exposure_s, n_min)?, over))
    }

    /// Returns the detection curve of stars over the median background.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn curve(&self, exposure_s: f64) -> Result<DetectionCurve, SimError> {
        let trail_px = star_trail_px(&self.camera, &self.motion, exposure_s);
        let background_e_per_s = self.background_e_per_s()?;
        Ok(DetectionCurve::new(&self.camera, &self.rule, trail_px, exposure_s, background_e_per_s))
    }

    /// Returns the V magnitude of a star of mean colour, on the boresight, that is detected with a given
    /// probability; `None` when no star is.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn limiting_magnitude(&self, exposure_s: f64, probability: f64) -> Result<Option<f64>, SimError> {
        Ok(self.limit_of(&self.curve(exposure_s)?, exposure_s, probability))
    }

    /// Returns [`Design::limiting_magnitude`] from an existing curve.
    pub fn limit_of(&self, curve: &DetectionCurve, exposure_s: f64, probability: f64) -> Option<f64> {
        let of_zero_e = self.camera.radiometry.star(0.0, None, None) * exposure_s;
        let electrons = curve.electrons_for(probability);
        electrons.map(|electrons| -2.5 * libm::log10(electrons / of_zero_e))
    }

    /// Returns the target, if there is one.
    pub fn target(&self) -> Option<&TargetModel> {
        self.target.as_ref()
    }

    /// Returns the aspects of the target up to a phase angle, in one group per phase angle, or in a single
    /// group for all instants of an orbit.
    pub fn groups(&self, phase_max_deg: Option<f64>) -> Vec<AspectGroup> {
        let aspects = self.target.as_ref().map_or_else(Vec::new, |target| target.aspects(phase_max_deg));
        let light = self.requirements.file.target.as_ref().map(|target| &target.light);
        let mut groups: Vec<AspectGroup> = Vec::new();
        for aspect in aspects {
            let phase = aspect.phase_deg;
            let together = |group: &AspectGroup| {
                matches!(light, Some(TargetLight::Orbit { .. })) || group.phases_deg[0] == phase
            };
            match groups.last_mut().filter(|group| together(group)) {
                Some(group) => {
                    let [low, high] = group.phases_deg;
                    group.phases_deg = [low.min(phase), high.max(phase)];
                    group.aspects.push(aspect);
                }
                None => groups.push(AspectGroup { phases_deg: [phase; 2], aspects: vec![aspect] }),
            }
        }
        groups
    }

    /// Returns the probability that the target is detected from a range, the smallest over the groups of
    /// aspects, and the index of this group.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn target_chance(
        &self,
        groups: &[AspectGroup],
        range_km: f64,
        exposure_s: f64,
    ) -> Result<(f64, usize), SimError> {
        let Some(target) = &self.target else { return Ok((0.0, 0)) };
        let watch = TargetObservation {
            camera: &self.camera,
            rule: &self.rule,
            motion: &self.motion,
            background_e_per_s: self.background_e_per_s()?,
        };
        let chances = groups.iter().map(|group| watch.chance(target, &group.aspects, range_km, exposure_s));
        let least = chances.enumerate().map(|(i, chance)| (chance, i)).min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(least.unwrap_or((0.0, 0)))
    }

    /// Returns the longest exposure that does not over-expose the target with a given probability at a range,
    /// s, in every group; not limited to the exposures that the camera can command.
    pub fn longest_unsaturated_s(&self, groups: &[AspectGroup], range_km: f64, probability: f64) -> f64 {
        let Some(target) = &self.target else { return f64::INFINITY };
        let exposure = &self.requirements.file.exposure;
        let longest = groups.iter().map(|group| {
            let sorted =
                longest_unsaturated_exposures_s(&self.camera, target, &group.aspects, range_km, exposure);
            longest_with_probability(&sorted, probability)
        });
        longest.fold(f64::INFINITY, f64::min)
    }

    /// Returns the probability of meeting a demand under its worst conditions. `exposure_s` replaces the
    /// exposure of the demand.
    ///
    /// # Errors
    /// The errors of [`Design::sky`].
    pub fn reached(&self, demand: &Demand, exposure_s: Option<f64>) -> Result<DesignPerformance, SimError> {
        let file = &self.requirements.file;
        let exposure_of = |own: &Option<f64>| exposure_s.or(*own).unwrap_or(file.exposure.nominal_s);
        match demand {
            Demand::Stars { n_min, exposure_s: own, over, .. } => {
                let exposure_s = exposure_of(own);
                let probability = self.stars_chance(exposure_s, n_min.unwrap_or(file.n_min), *over)?;
                Ok(DesignPerformance { probability, exposure_s, range_km: None })
            }
            Demand::LimitingMagnitude { magnitude, exposure_s: own, .. } => {
                let exposure_s = exposure_of(own);
                let electrons = self.camera.radiometry.star(*magnitude, None, None) * exposure_s;
                Ok(DesignPerformance {
                    probability: self.curve(exposure_s)?.probability(electrons),
                    exposure_s,
                    range_km: None,
                })
            }
            Demand::TargetDetected { from_km, to_km, phase_max_deg, exposure_s: own, .. } => {
                let (exposure_s, groups) = (exposure_of(own), self.groups(*phase_max_deg));
                let mut worst = DesignPerformance { probability: 2.0, exposure_s, range_km: None };
                for range_km in between(*from_km, *to_km, RANGES) {
                    let (probability, _) = self.target_chance(&groups, range_km, exposure_s)?;
                    if probability < worst.probability {
                        worst = DesignPerformance { probability, exposure_s, range_km: Some(range_km) };
                    }
                }
                Ok(worst)
            }
            Demand::ExposureWindow { from_km, to_km, phase_max_deg, n_min, probability } => {
                let groups = self.groups(*phase_max_deg);
                let required = probability.unwrap_or(file.probability);
                let ranges = between(*from_km, *to_km, RANGES)
                    .map(|r| (self.longest_unsaturated_s(&groups, r, required), r));
                let (longest_s, range_km) =
                    ranges.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, *from_km));
                if longest_s < file.exposure.min_s {
                    return Ok(DesignPerformance {
                        probability: 0.0,
                        exposure_s: longest_s,
                        range_km: Some(range_km),
                    });
                }
                // A longer exposure detects more stars unless smear outweighs the gain: a half or a quarter
                // of it may be better.
                let mut best = DesignPerformance {
                    probability: 0.0,
                    exposure_s: file.exposure.min_s,
                    range_km: Some(range_km),
                };
                for part in [1.0, 0.5, 0.25] {
                    let exposure_s = (part * longest_s.min(file.exposure.max_s)).max(file.exposure.min_s);
                    let chance =
                        self.stars_chance(exposure_s, n_min.unwrap_or(file.n_min), SkyStatistic::Sky)?;
                    if chance > best.probability {
                        best = DesignPerformance { probability: chance, exposure_s, ..best };
                    }
                    if self.motion.guidance == MotionGuidance::Inertial {
                        break;
                    }
                }
                Ok(best)
            }
        }
    }
}

impl Demand {
    /// Returns the required probability; `of_file` if the demand states none.
    pub fn probability(&self, of_file: f64) -> f64 {
        let (Self::Stars { probability, .. }
        | Self::LimitingMagnitude { probability, .. }
        | Self::TargetDetected { probability, .. }
        | Self::ExposureWindow { probability, .. }) = self;
        probability.unwrap_or(of_file)
    }
}

/// Creates a design for a value of a parameter, and returns the exposure if it is the parameter.
///
/// # Errors
/// The errors of [`Design::new`].
pub(crate) fn design_with<'a>(
    requirements: &'a Requirements,
    parameter: Parameter,
    value: f64,
    pointings: usize,
) -> Result<(Design<'a>, Option<f64>), Failure> {
    let exposure_s = (parameter == Parameter::ExposureS).then_some(value);
    let camera = requirements.camera.with(parameter, value);
    Ok((Design::new(requirements, &camera, pointings, exposure_s.unwrap_or(0.0))?, exposure_s))
}

/// Returns `count` numbers from one to another, both included, in equal ratios.
pub fn between(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    let ratio = to / from;
    let count = if ratio == 1.0 { 1 } else { count };
    let last = count.saturating_sub(1).max(1) as f64;
    // The ends are exact.
    (0..count).map(move |i| match i {
        0 => from,
        i if i + 1 == count => to,
        i => from * libm::pow(ratio, i as f64 / last),
    })
}
