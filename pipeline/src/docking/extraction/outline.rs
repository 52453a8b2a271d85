//! Before the target is resolved: the station's outline from field to field, and the range from it alone.

use contract::docking::{Circle, DockingSolution, Features, NoPose, TargetModel};

use super::contour::{self, StationOutline};
use super::evidence::camera_circle;
use crate::docking::cross_and_circle::circle::CircleFit;
use crate::docking::preprocessing::histogram::Histogram;
use crate::docking::preprocessing::region::Rectangle;
use crate::docking::preprocessing::view::{Lens, View};

/// A field whose hundredths differ by less than this many grey values is empty.
const EMPTY_RANGE: f64 = 12.0;

/// The circle of the marks, px, from which on a target that is not found is missing.
pub(crate) const RESOLVED_CIRCLE_PX: f64 = 15.0;

/// The circle of the marks, px, from which on a target is looked for within an outline: a bar of the cross is then 1.5 px wide,
/// less than a line of a field, and in fewer pixels a pose is that of noise.
pub(crate) const SMALLEST_CIRCLE_PX: f64 = 12.0;

/// An outline that is followed is looked for anew in the whole field after this time, s: what was taken for it must not be so for
/// ever.
const RENEW_S: f64 = 1.0;

/// Radius of the circle of the marks when the station has this outline, px.
pub(crate) fn mark_circle_px(target: &TargetModel, lens: &Lens, outline: &CircleFit) -> Option<f64> {
    let (range_m, _) = contour::range(&target.station, lens.focal_px(), outline.radius, 0.0)?;
    Some(lens.focal_px() * target.mark_circle_radius_m / range_m)
}

/// The range that an outline gives, or the reason why it gives none; what was seen goes to `features` and `region`.
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
    // A station that is nearer than the target can be resolved is something else, or hides its target. Farther away, what
    // made a candidate inconsistent was none.
    let radius_px = outline.circle.radius;
    let resolved = RESOLVED_CIRCLE_PX / target.mark_circle_radius_m * target.station.radius_m;
    match contour::range(&target.station, lens.focal_px(), radius_px, outline.sigma_px()) {
        Some((range_m, sigma_m)) if radius_px < resolved && reason != NoPose::AmbiguousTarget => {
            Ok(DockingSolution::RangeOnly { range_m, sigma_m })
        }
        _ => Err(reason),
    }
}

/// Why there is nothing in a field without an outline. The thousandths hold a small target before an empty sky; a field is empty
/// when they hold nothing.
pub(crate) fn no_outline_reason(view: &View<'_>, reason: NoPose) -> NoPose {
    let whole = Histogram::from_region(view, &Rectangle::ALL);
    let range = whole.quantile(0.999) - whole.quantile(0.01);
    if reason == NoPose::NoTarget && range < EMPTY_RANGE { NoPose::EmptyField } else { reason }
}

/// An outline in a field.
#[derive(Debug, Clone, Copy)]
struct OutlineObservation {
    time_s: f64,
    camera: usize,
    circle: CircleFit,
    /// When it was found in a whole field.
    found_s: f64,
}

/// The outline of the field before: far away it moves by less than a pixel a field.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutlineTrack {
    last: Option<OutlineObservation>,
}

impl OutlineTrack {
    /// The outline about where it was; `None` when it is not there, or when it is time to look at the whole field.
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

    /// Takes an outline that was found in a whole field.
    pub(crate) fn restart(&mut self, (time_s, camera): (f64, usize), outline: &StationOutline) {
        self.last = Some(OutlineObservation { time_s, camera, circle: outline.circle, found_s: time_s });
    }
}
