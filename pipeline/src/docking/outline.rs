//! Before the target is resolved: the range from the station's outline alone.

use contract::docking::{Circle, DockingSolution, Features, NoPose, TargetModel};

use super::contour;
use super::evidence::camera_circle;
use super::histogram::Histogram;
use super::region::Rectangle;
use super::view::{Lens, Overview, View};

/// A field whose hundredths differ by less than this many grey values is empty.
const EMPTY_RANGE: f64 = 12.0;

/// The range from the station's outline alone, or why there is none.
pub(crate) fn range(
    view: &View<'_>,
    overview: &Overview,
    lens: &Lens,
    target: &TargetModel,
    features: &mut Features,
    region: &mut Rectangle,
    reason: NoPose,
) -> Result<DockingSolution, NoPose> {
    let Some(outline) = contour::find(view, overview, lens) else {
        // The thousandths hold a small target before an empty sky; a field is empty when they hold nothing.
        let whole = Histogram::of(view, &Rectangle::ALL);
        let range = whole.quantile(0.999) - whole.quantile(0.01);
        return Err(if reason == NoPose::NoTarget && range < EMPTY_RANGE {
            NoPose::EmptyField
        } else {
            reason
        });
    };
    let circle = camera_circle(lens, outline.circle.centre, outline.circle.radius);
    if let Some((centre, radius_px)) = circle {
        features.station = Some(Circle { centre, raw_centre: centre, radius_px, points: outline.points });
        *region = Rectangle::about(centre, radius_px);
    }
    // A station that is nearer than the target can be resolved is something else, or hides its target. Farther away, what
    // made a candidate inconsistent was none.
    let radius_px = outline.circle.radius;
    let resolved = RESOLVED_CIRCLE_PX / target.mark_circle_radius_m * target.station.radius_m;
    match contour::range(&target.station, lens.focal_px(), radius_px, outline.sigma_px) {
        Some((range_m, sigma_m)) if radius_px < resolved && reason != NoPose::AmbiguousTarget => {
            Ok(DockingSolution::RangeOnly { range_m, sigma_m })
        }
        _ => Err(reason),
    }
}

/// Radius of the circle of the marks above which a target that is not found is missing, px.
const RESOLVED_CIRCLE_PX: f64 = 15.0;
