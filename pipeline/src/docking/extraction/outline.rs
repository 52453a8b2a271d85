//! Station's outline before the target is resolved: tracking from field to field, and the range from the
//! outline only.

use contract::docking::{Circle, DockingSolution, Features, NoPose, TargetModel};

use super::contour::{self, StationOutline};
use super::evidence::camera_circle;
use crate::docking::cross_and_circle::circle::CircleFit;
use crate::docking::preprocessing::histogram::Histogram;
use crate::docking::preprocessing::region::Rectangle;
use crate::docking::preprocessing::view::{Lens, View};

/// Largest range of grey values, between the quantiles 0.01 and 0.999, of an empty field.
const EMPTY_RANGE: f64 = 12.0;

/// Radius of the circle of the marks, px, from which on a target that is not found counts as missing.
pub(crate) const RESOLVED_CIRCLE_PX: f64 = 15.0;

/// Radius of the circle of the marks, px, from which on a target is searched for within an outline. A bar of
/// the cross is then 1.5 px wide, less than a line of a field; in fewer pixels a pose would be that of noise.
pub(crate) const MIN_CIRCLE_PX: f64 = 12.0;

/// Time after which a tracked outline is searched for again in the whole field, s. Limits how long another
/// object can be mistaken for the outline.
const RENEW_S: f64 = 1.0;

/// Returns the radius of the circle of the marks for a station with this outline, px.
pub(crate) fn mark_circle_px(target: &TargetModel, lens: &Lens, outline: &CircleFit) -> Option<f64> {
    let (range_m, _) = contour::range(&target.station, lens.focal_px(), outline.radius, 0.0)?;
    Some(lens.focal_px() * target.mark_circle_radius_m / range_m)
}

/// Returns the range by an outline, or the reason why there is none. Writes the outline to `features` and
/// `region`.
pub(crate) fn range(
    lens: &Lens,
    target: &TargetModel,
    outline: &StationOutline,
    features: &mut Features,
    region: &mut Rectangle,
    reason: NoPose,
) -> Result<DockingSolution, NoPose> {
    let circle = camera_circle(lens, outline.circle.centre, outline.circle.radius);
    if let Some((centre, radius_px)) = circle {
        features.station = Some(Circle { centre, raw_centre: centre, radius_px, points: outline.points });
        *region = Rectangle::square(centre, radius_px);
    }
    // An outline this large belongs to a station so near that its target can be resolved: it is another
    // object, or hides its target. Farther away, an inconsistent candidate was not a target.
    let radius_px = outline.circle.radius;
    let resolved = RESOLVED_CIRCLE_PX / target.mark_circle_radius_m * target.station.radius_m;
    match contour::range(&target.station, lens.focal_px(), radius_px, outline.sigma_px()) {
        Some((range_m, sigma_m)) if radius_px < resolved && reason != NoPose::AmbiguousTarget => {
            Ok(DockingSolution::RangeOnly { range_m, sigma_m })
        }
        _ => Err(reason),
    }
}

/// Returns the reason for the absence of a target in a field without an outline. The brightest thousandth
/// holds a small target against an empty sky; when it holds nothing, the field is empty.
pub(crate) fn no_outline_reason(view: &View<'_>, reason: NoPose) -> NoPose {
    let whole = Histogram::from_region(view, &Rectangle::ALL);
    let range = whole.quantile(0.999) - whole.quantile(0.01);
    if reason == NoPose::NoTarget && range < EMPTY_RANGE { NoPose::EmptyField } else { reason }
}

/// Outline in a field.
#[derive(Debug, Clone, Copy)]
struct OutlineObservation {
    time_s: f64,
    camera: usize,
    circle: CircleFit,
    /// Time at which the outline was found in a whole field, s.
    found_s: f64,
}

/// Outline of the previous field. Far away, it moves by less than a pixel per field.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutlineTrack {
    last: Option<OutlineObservation>,
}

impl OutlineTrack {
    /// Finds the outline near its last position. Returns `None` when it is not there, or when a search of the
    /// whole field is due.
    pub(crate) fn follow(
        &mut self,
        view: &View<'_>,
        lens: &Lens,
        (time_s, camera): (f64, usize),
        max_gap_s: f64,
    ) -> Option<StationOutline> {
        let before = self.last.take()?;
        let elapsed_s = time_s - before.time_s;
        let is_due = time_s - before.found_s > RENEW_S;
        if before.camera != camera || !(elapsed_s > 0.0 && elapsed_s <= max_gap_s) || is_due {
            return None;
        }
        let outline = contour::follow(view, lens, &before.circle)?;
        self.last = Some(OutlineObservation { time_s, circle: outline.circle, ..before });
        Some(outline)
    }

    /// Stores an outline that was found in a whole field.
    pub(crate) fn restart(&mut self, (time_s, camera): (f64, usize), outline: &StationOutline) {
        self.last = Some(OutlineObservation { time_s, camera, circle: outline.circle, found_s: time_s });
    }
}
