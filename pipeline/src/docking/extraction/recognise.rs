//! Recognition of the target in a field: by tracking from a prediction, or by a search without one.

use contract::docking::{MarkUse, NoPose, TargetModel};
use nalgebra::Vector2;

use super::candidates::{self, ALL_SCALES, Candidate};
use super::self_check;
use crate::docking::config::DockingConfig;
use crate::docking::cross_and_circle::circle::{self, CircleFit};
use crate::docking::cross_and_circle::cross::{self, CrossFit, CrossSeed};
use crate::docking::cross_and_circle::marks::{MarkSearch, MarkShape, MarksFit, Plane};
use crate::docking::preprocessing::region::Prediction;
use crate::docking::preprocessing::view::{Lens, Overview, View};

/// Cross, marks and mark circle of one target.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TargetFeatures {
    pub(crate) cross: CrossFit,
    pub(crate) marks: MarksFit,
    pub(crate) circle: MarkCircle,
}

impl TargetFeatures {
    /// Returns true if both sights are of the same target.
    fn repeats(&self, other: &Self) -> bool {
        let (one, two) = (&self.cross.seed, &other.cross.seed);
        (one.centre - two.centre).norm() <= one.half_length_px.min(two.half_length_px)
    }

    /// Returns true if the cross agrees with the expected one.
    fn is_near(&self, expected: &CrossSeed) -> bool {
        let seed = &self.cross.seed;
        let scale = seed.half_length_px / expected.half_length_px;
        (seed.centre - expected.centre).norm() <= 0.5 * expected.half_length_px && (0.9..1.1).contains(&scale)
    }
}

/// Circle of the marks, ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MarkCircle {
    pub(crate) raw_centre: Vector2<f64>,
    pub(crate) centre: Vector2<f64>,
    pub(crate) radius_px: f64,
    pub(crate) points: u32,
}

/// Inputs to the recognition in one field.
pub(crate) struct Recognition<'a> {
    pub(crate) view: &'a View<'a>,
    pub(crate) lens: &'a Lens,
    pub(crate) model: &'a TargetModel,
    pub(crate) shapes: &'a [MarkShape],
    pub(crate) config: &'a DockingConfig,
}

/// Largest distance of the marks from their positions predicted by the previous field, as a share of the
/// radius of their circle.
const TRACKING_REACH: f64 = 0.04;

/// Search radius for the disk's centre about the cross in a field without prior knowledge, as a share of the
/// radius of the marks' circle: a parallax of some 15° and errors of the cross.
const SEARCH_REACH: f64 = 0.32;

impl Recognition<'_> {
    /// Finds the target near its predicted position.
    ///
    /// # Errors
    /// The reason why the target is not there.
    pub(crate) fn track(&self, seed: &CrossSeed, plane: &Plane) -> Result<TargetFeatures, NoPose> {
        let cross = self.cross(seed).ok_or(NoPose::NoTarget)?;
        let start = Plane {
            // The prediction is assumed to have the same error for the disk as for the cross.
            centre: plane.centre + (cross.seed.centre - seed.centre),
            roll_rad: libm::atan(cross.seed.slope),
            ..*plane
        };
        let reach = TRACKING_REACH * self.model.mark_circle_radius_m * plane.scale_px_m + 1.5;
        self.complete(cross, &start, reach, 0.02)
    }

    /// Finds the one target in the field. If there are several, takes the predicted one.
    ///
    /// The methods of finding candidates are tried in turn, fastest first, until one of them finds a target.
    ///
    /// # Errors
    /// The reason why there is no target, or more than one.
    pub(crate) fn search(
        &self,
        overview: &Overview,
        predicted: Option<&Prediction>,
    ) -> Result<TargetFeatures, NoPose> {
        // The fastest way first; the others see a target that it misses.
        let ways: [&dyn Fn() -> Vec<Candidate>; 3] = [
            &|| candidates::by_regions(overview, self.lens),
            &|| candidates::by_edges(overview, self.lens, &self.config.edges),
            &|| candidates::by_structure(overview, self.lens, self.config.min_contrast, ALL_SCALES),
        ];
        self.first_success(&ways, predicted)
    }

    /// Finds the one target within a station's outline, which determines the target's size.
    ///
    /// # Errors
    /// The reason why there is no target, or more than one.
    pub(crate) fn search_within(
        &self,
        overview: &Overview,
        outline: &CircleFit,
        mark_circle_px: f64,
    ) -> Result<TargetFeatures, NoPose> {
        let centre = self.lens.to_camera(outline.centre).ok_or(NoPose::NoTarget)?;
        let part = overview.around(centre, outline.radius);
        let half_px = mark_circle_px * self.model.cross.half_length_m / self.model.mark_circle_radius_m;
        let scales = 0.8 * half_px..1.25 * half_px;
        let ways: [&dyn Fn() -> Vec<Candidate>; 2] = [&|| candidates::by_regions(&part, self.lens), &|| {
            candidates::by_structure(&part, self.lens, self.config.min_contrast, scales.clone())
        }];
        self.first_success(&ways, None)
    }

    /// Returns the target that the first successful way finds. A prediction selects one of several targets;
    /// without it, several are an error.
    fn first_success(
        &self,
        ways: &[&dyn Fn() -> Vec<Candidate>],
        predicted: Option<&Prediction>,
    ) -> Result<TargetFeatures, NoPose> {
        let mut reason = NoPose::NoTarget;
        for way in ways {
            if let Some(target_features) = self.examine(way(), predicted, &mut reason)? {
                return Ok(target_features);
            }
        }
        Err(reason)
    }

    /// Selects by structure: the candidate with a cross's bars and with marks around it.
    fn examine(
        &self,
        found: Vec<Candidate>,
        predicted: Option<&Prediction>,
        reason: &mut NoPose,
    ) -> Result<Option<TargetFeatures>, NoPose> {
        let mut sights: Vec<TargetFeatures> = Vec::new();
        let mut examined = 0;
        for candidate in found {
            if examined >= self.config.max_candidates {
                break;
            }
            if !self.in_window(candidate.seed.centre) {
                continue;
            }
            examined += 1;
            match self.target_at(&candidate.seed) {
                Ok(target_features) if !sights.iter().any(|other| other.repeats(&target_features)) => {
                    sights.push(target_features)
                }
                Ok(_) | Err(NoPose::NoTarget) => {}
                Err(why) => *reason = why,
            }
        }
        if sights.len() > 1 {
            sights.retain(|target_features| {
                predicted.is_some_and(|prediction| target_features.is_near(&prediction.cross))
            });
            if sights.len() != 1 {
                return Err(NoPose::AmbiguousTarget);
            }
        }
        Ok(sights.pop())
    }

    fn in_window(&self, centre: Vector2<f64>) -> bool {
        let Some(window) = &self.config.region.window else { return true };
        self.lens.to_camera(centre).is_some_and(|point| window.contains(point))
    }

    fn cross(&self, seed: &CrossSeed) -> Option<CrossFit> {
        cross::measure(self.view, self.lens, &self.model.cross, seed, self.config.min_contrast)
    }

    /// Returns the target at a candidate.
    fn target_at(&self, seed: &CrossSeed) -> Result<TargetFeatures, NoPose> {
        let cross = self.cross(seed).ok_or(NoPose::NoTarget)?;
        let (model, focal_px) = (self.model, self.lens.focal_px());
        let d3 = focal_px * model.cross.half_length_m / cross.seed.half_length_px + model.cross.height_m;
        let plane = Plane {
            centre: cross.seed.centre,
            scale_px_m: focal_px / d3,
            roll_rad: libm::atan(cross.seed.slope),
        };
        let radius_px = model.mark_circle_radius_m * plane.scale_px_m;
        match self.complete(cross, &plane, SEARCH_REACH * radius_px, 0.07) {
            Ok(target_features)
                if target_features.marks.count(MarkUse::Used) >= self.least_marks(&target_features) =>
            {
                self_check::on_station(
                    self.view,
                    self.lens,
                    model,
                    &target_features.cross,
                    &target_features.marks.plane,
                )?;
                Ok(target_features)
            }
            Ok(_) => Err(NoPose::NoTarget),
            // A cross without marks is not specific to the target, unless its marks are outside the image.
            Err(NoPose::TooFewFeatures) => Err(NoPose::NoTarget),
            Err(NoPose::OutOfField) if radius_px < 0.2 * self.view.columns() as f64 => Err(NoPose::NoTarget),
            Err(why) => Err(why),
        }
    }

    /// Returns the smallest number of marks that distinguishes a target from chance: a third of those in the
    /// field, at least five.
    fn least_marks(&self, target_features: &TargetFeatures) -> usize {
        let in_field = target_features.marks.marks.len() - target_features.marks.count(MarkUse::OutOfField);
        // A shadow hides some marks; chance does not produce a third of them.
        in_field.div_ceil(3).max(self_check::MIN_MARKS_TO_FIND)
    }

    /// Adds marks, circle and checks to a cross.
    fn complete(
        &self,
        cross: CrossFit,
        start: &Plane,
        reach_px: f64,
        stretch: f64,
    ) -> Result<TargetFeatures, NoPose> {
        let search = MarkSearch {
            view: self.view,
            lens: self.lens,
            shapes: self.shapes,
            plate_radius_m: self.model.plate_radius_m,
            levels: cross.levels,
        };
        let coarse = search.coarse(start, reach_px, stretch);
        let Some(marks) = search.measure(&coarse) else {
            let outside = self
                .shapes
                .iter()
                .filter(|shape| {
                    !self
                        .lens
                        .to_camera(coarse.project(shape.centre_m))
                        .is_some_and(|point| self.view.contains(point, 0.0))
                })
                .count();
            return Err(if 2 * outside > self.shapes.len() {
                NoPose::OutOfField
            } else {
                NoPose::TooFewFeatures
            });
        };
        self_check::cross_and_marks(self.model, self.lens.focal_px(), &cross, &marks)?;
        let circle = self.circle(&marks);
        Ok(TargetFeatures { cross, marks, circle })
    }

    /// Returns the circle through the marks' centroids. Where the used marks cover less than half of it,
    /// returns the circle of the plane fitted to all used marks.
    fn circle(&self, marks: &MarksFit) -> MarkCircle {
        let r = self.model.mark_circle_radius_m;
        let on_it: Vec<(Vector2<f64>, [f64; 2])> = marks
            .marks
            .iter()
            .filter(|seen| seen.mark.usage == MarkUse::Used)
            .filter_map(|seen| Some((seen.ideal, self.shapes.get(seen.mark.index as usize)?)))
            .filter(|(_, shape)| (shape.radius_m() / r - 1.0).abs() < 0.03)
            .map(|(ideal, shape)| (ideal, shape.centre_m))
            .collect();
        let points: Vec<Vector2<f64>> = on_it.iter().map(|(ideal, _)| *ideal).collect();
        let plane = &marks.plane;
        let around = largest_gap(on_it.iter().map(|(_, y)| libm::atan2(y[1], y[0])).collect());
        if points.len() >= 4
            && around <= std::f64::consts::PI
            && let Some(guess) = circle::first_guess(&points)
            && let Some(CircleFit { centre, radius, .. }) = circle::refine(&points, &guess)
        {
            return MarkCircle {
                raw_centre: guess.centre,
                centre,
                radius_px: radius,
                points: points.len() as u32,
            };
        }
        MarkCircle {
            raw_centre: plane.centre,
            centre: plane.centre,
            radius_px: r * plane.scale_px_m,
            points: marks.count(MarkUse::Used) as u32,
        }
    }
}

/// Returns the largest angle without a mark, rad.
fn largest_gap(mut angles: Vec<f64>) -> f64 {
    angles.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return std::f64::consts::TAU };
    let wrapped = first + std::f64::consts::TAU - last;
    angles.windows(2).map(|pair| pair[1] - pair[0]).fold(wrapped, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_gap_is_found_across_the_wrap() {
        assert!((largest_gap(vec![3.0, -3.0, 0.0]) - 3.0).abs() < 1e-12);
        assert!((largest_gap(vec![0.5, -0.5]) - (std::f64::consts::TAU - 1.0)).abs() < 1e-12);
        assert_eq!(largest_gap(vec![]), std::f64::consts::TAU);
    }
}
