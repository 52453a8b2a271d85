//! Outline of the station: the circle of its end face among the edges of the field, and the range from it
//! before the target is resolved.

use contract::docking::Outline;
use nalgebra::Vector2;

use super::votes::{self, Proposal};
use crate::docking::cross_and_circle::circle::{self, CircleFit};
use crate::docking::portions::OutlineRange;
use crate::docking::pose::paper_pose::range_from_outline;
use crate::docking::preprocessing::histogram::Histogram;
use crate::docking::preprocessing::region::Rectangle;
use crate::docking::preprocessing::view::{Lens, Overview, View};

/// Outline of the station in a field, ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StationOutline {
    pub(crate) circle: CircleFit,
    /// Number of edge points on the circle.
    pub(crate) points: u32,
    /// Part of the radius's standard deviation that is independent from field to field, px; `common_px` is
    /// the part common to many fields.
    pub(crate) noise_px: f64,
    common_px: f64,
}

impl StationOutline {
    /// Returns the standard deviation of the radius, px.
    pub(crate) fn sigma_px(&self) -> f64 {
        libm::hypot(self.noise_px, self.common_px)
    }

    /// Returns the range by the outline, with its standard deviation from field to field.
    pub(crate) fn range(&self, outline: &Outline, focal_px: f64) -> Option<OutlineRange> {
        let radius_px = self.circle.radius;
        let (range_m, sigma_m) = range(outline, focal_px, radius_px, self.noise_px)?;
        Some(OutlineRange { range_m, sigma_m, radius_px })
    }
}

/// Number of proposed circles that are measured.
const MEASURED_CIRCLES: usize = 16;

/// Number of rays from a circle's centre along which its edge is searched for.
const RAYS: usize = 72;

/// Smallest share of the rays that must meet the edge on the circle. A smaller share does not distinguish a
/// circle from panels and shadows.
const MIN_SHARE: f64 = 0.6;

/// Smallest share of the rays for circles below [`SMALL_RADIUS_PX`]. A smaller share does not distinguish a
/// circle from the end of a bar or a character of an overlay.
const MIN_SMALL_SHARE: f64 = 0.8;

/// Largest root mean square of the edge's distances from the circle, relative to the radius. Characters of 8
/// to 11 px have 0.055 to 0.13, a station of 12 px has 0.05.
const MAX_RMS: f64 = 0.054;

/// Share of a predicted outline that must be in the image to decide if it is present.
const MIN_INSIDE: f64 = 0.45;

/// Radius, px, below which a circle fits many objects.
const SMALL_RADIUS_PX: f64 = 30.0;

/// Smallest height of an edge: in grey values, and as a multiple of the noise, which is the median difference
/// of neighbours.
const MIN_STEP: (f64, f64) = (8.0, 3.0);

/// Finds the outline of a bright round face. Returns `None` when there is none, or when too much of it is
/// outside the image.
///
/// The structure behind the face is in parts darker, in parts as bright, so no threshold separates them. The
/// circles with most votes are measured on the field, ray by ray, and the largest sufficiently complete
/// circle is the outline.
pub(crate) fn find(view: &View<'_>, overview: &Overview, lens: &Lens) -> Option<StationOutline> {
    let min_step = least_step(view);
    let mut proposals = votes::propose(&overview.grey, min_step);
    proposals.sort_by(|a, b| b.share.total_cmp(&a.share));
    let mut kept: Vec<Proposal> = Vec::new();
    for proposal in proposals {
        let repeats = |other: &Proposal| {
            libm::hypot(other.x - proposal.x, other.y - proposal.y) < 0.15 * other.radius
                && (proposal.radius / other.radius - 1.0).abs() < 0.1
        };
        if kept.len() < MEASURED_CIRCLES && !kept.iter().any(repeats) {
            kept.push(proposal);
        }
    }
    let measured: Vec<StationOutline> = kept
        .iter()
        .filter_map(|proposal| {
            let centre = lens.to_ideal(overview.to_camera(proposal.x, proposal.y))?;
            let radius = proposal.radius * Overview::PIXEL;
            measure(view, lens, (centre, radius), min_step, [MIN_SHARE, least_share(radius)])
        })
        .filter(StationOutline::is_round)
        .collect();
    let largest = measured.iter().map(|outline| outline.circle.radius).fold(0.0, f64::max);
    // Several proposals lead to the same circle through different points. The largest of these circles would
    // be too large, so the best fit is taken.
    measured
        .into_iter()
        .filter(|outline| outline.circle.radius > 0.93 * largest)
        .min_by(|a, b| a.circle.rms.total_cmp(&b.circle.rms))
}

/// Finds the outline near its position in the previous field. Returns `None` when it is not there.
pub(crate) fn follow(view: &View<'_>, lens: &Lens, before: &CircleFit) -> Option<StationOutline> {
    let predicted = (before.centre, before.radius);
    let share = least_share(before.radius);
    let reach = (0.07 * before.radius).max(3.0);
    fit(view, lens, predicted, reach, least_step(view), share).filter(StationOutline::is_round)
}

impl StationOutline {
    fn is_round(&self) -> bool {
        self.circle.rms <= MAX_RMS * self.circle.radius
    }
}

/// Returns the share of the rays on which a circle of this radius must have its edge.
fn least_share(radius_px: f64) -> f64 {
    if radius_px < SMALL_RADIUS_PX { MIN_SMALL_SHARE } else { MIN_SHARE }
}

/// Returns the smallest height of an edge in this field, grey values.
fn least_step(view: &View<'_>) -> f64 {
    MIN_STEP.0.max(MIN_STEP.1 * noise(view))
}

/// Returns the median difference of horizontal neighbours, grey values. Each neighbour is the mean of two
/// pixels; every fourth row is used.
fn noise(view: &View<'_>) -> f64 {
    let mut counts = [0u32; 256];
    let mut total = 0;
    for row in (0..view.rows()).step_by(4) {
        let mean = |pair: usize| (view.grey_at(2 * pair, row) + view.grey_at(2 * pair + 1, row)) / 2.0;
        for pair in 1..view.columns() / 2 {
            counts[((mean(pair) - mean(pair - 1)).abs() + 0.5).min(View::WHITE) as usize] += 1;
            total += 1;
        }
    }
    let mut below = 0;
    counts
        .iter()
        .position(|count| {
            below += count;
            2 * below >= total
        })
        .unwrap_or(0) as f64
}

/// Distances from a circle's centre at which sky is searched for, radii: beyond the structure behind the end
/// face.
const SKY_AT: [f64; 2] = [1.35, 1.6];

/// Smallest share of the directions with sky. Modules and panels leave 0.39 and more at 1.35 radii. The
/// docking unit is surrounded by the end face; without this limit its ring would be mistaken for a station
/// three times as far away.
const MIN_SKY: f64 = 0.33;

/// Largest brightness of sky over the darkest hundredths of the field, as a share of the disk's brightness
/// over them.
const SKY_LEVEL: f64 = 0.25;

/// Returns true if a circle is the outline of a body against the sky, and not a ring on its face. Returns
/// false if too little around the circle is in the image.
pub(crate) fn stands_before_sky(view: &View<'_>, lens: &Lens, circle: &CircleFit) -> bool {
    let around = |radii: f64| -> Vec<f64> {
        (0..RAYS)
            .filter_map(|ray| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * ray as f64 / RAYS as f64);
                view.sample(lens.to_camera(circle.centre + radii * circle.radius * Vector2::new(cos, sin))?)
            })
            .collect()
    };
    let mut inside: Vec<f64> = [0.8, 0.86, 0.92].into_iter().flat_map(around).collect();
    inside.sort_by(f64::total_cmp);
    let Some(&face) = inside.get(inside.len() / 2) else { return false };
    let darkest = Histogram::from_region(view, &Rectangle::ALL).quantile(0.02);
    let sky = darkest + SKY_LEVEL * (face - darkest);
    SKY_AT.into_iter().all(|radii| {
        let outside = around(radii);
        let dark = outside.iter().filter(|value| **value <= sky).count();
        outside.len() as f64 >= MIN_INSIDE * RAYS as f64 && dark as f64 >= MIN_SKY * outside.len() as f64
    })
}

/// Returns true if the outline is found where `centre` and `radius` predict it, or `None` when too much of it
/// is outside the image to decide. Tilt and parallax may change the outline by a tenth of the radius.
pub(crate) fn confirms(
    view: &View<'_>,
    lens: &Lens,
    (centre, radius): (Vector2<f64>, f64),
    min_step: f64,
) -> Option<bool> {
    let inside = (0..RAYS)
        .filter(|ray| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * *ray as f64 / RAYS as f64);
            lens.to_camera(centre + 1.2 * radius * Vector2::new(cos, sin))
                .is_some_and(|predicted| view.contains(predicted, 2.0))
        })
        .count();
    let inside = inside as f64 / RAYS as f64;
    if inside < MIN_INSIDE {
        return None;
    }
    // Shadows and structure behind may hide half of it.
    let seen = measure(view, lens, (centre, radius), min_step, [0.25 * inside, 0.45 * inside]);
    Some(seen.is_some_and(|seen| (seen.circle.radius / radius - 1.0).abs() < 0.12))
}

/// Measures the outline at its predicted position. Returns `None` unless most of it is seen.
pub(crate) fn measure_at(
    view: &View<'_>,
    lens: &Lens,
    predicted: (Vector2<f64>, f64),
    min_step: f64,
) -> Option<StationOutline> {
    measure(view, lens, predicted, min_step, [MIN_SHARE, MIN_SHARE]).filter(StationOutline::is_round)
}

/// Fits a circle to the steepest falls of brightness on rays from a centre, then repeats this from the fitted
/// circle. The edge must lie on the circle on the given shares of the rays, one share per pass.
fn measure(
    view: &View<'_>,
    lens: &Lens,
    (centre, radius): (Vector2<f64>, f64),
    min_step: f64,
    [first_share, share]: [f64; 2],
) -> Option<StationOutline> {
    let reach = (0.15 * radius).max(3.5);
    let first = fit(view, lens, (centre, radius), reach, min_step, first_share)?;
    let CircleFit { centre, radius, .. } = first.circle;
    fit(view, lens, (centre, radius), (0.07 * radius).max(3.0), min_step, share)
}

fn fit(
    view: &View<'_>,
    lens: &Lens,
    (centre, radius): (Vector2<f64>, f64),
    reach: f64,
    min_step: f64,
    min_share: f64,
) -> Option<StationOutline> {
    let step = (reach / 12.0).max(0.5);
    let count = (2.0 * reach / step).ceil() as usize + 1;
    // An edge is the difference of the means of some samples on either side, because tiles and seams are
    // narrower. With longer sides, a rim that is brighter than the area inside moves the steepest fall
    // farther out.
    let side = ((0.01 * radius).max(1.0) / step).round().max(1.0) as usize;
    let mut points = Vec::with_capacity(RAYS);
    let mut values = Vec::with_capacity(count);
    for ray in 0..RAYS {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * ray as f64 / RAYS as f64);
        let direction = Vector2::new(cos, sin);
        values.clear();
        values.extend((0..count + 2 * side).map_while(|i| {
            let distance = radius - reach + step * (i as f64 - side as f64);
            view.sample(lens.to_camera(centre + direction * distance)?)
        }));
        if values.len() < count + 2 * side {
            continue;
        }
        let fall = |i: usize| -> f64 {
            let sum = |part: &[f64]| part.iter().sum::<f64>();
            (sum(&values[i..i + side]) - sum(&values[i + side + 1..i + 2 * side + 1])) / side as f64
        };
        let steepest = (0..count - 1).map(|i| (i, fall(i))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, height)) = steepest
            && height >= min_step
            && i > 0
            && i + 2 < count
        {
            // Vertex of the parabola through three falls.
            let (before, after) = (fall(i - 1), fall(i + 1));
            let bend = before - 2.0 * height + after;
            let shift = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
            points.push(centre + direction * (radius - reach + step * (i as f64 + shift)));
        }
    }
    if points.len() < 8 || (points.len() as f64) < min_share * RAYS as f64 {
        return None;
    }
    let tolerance = (0.012 * radius).max(1.0);
    let (circle, _) = circle::fit_robustly(&points, tolerance)?;
    if (circle.centre - centre).norm() > reach || (circle.radius - radius).abs() > reach {
        return None;
    }
    let on_it: Vec<Vector2<f64>> =
        points.iter().filter(|p| circle.residual(p).abs() <= 2.0 * tolerance).copied().collect();
    let share = on_it.len() as f64 / RAYS as f64;
    if share < min_share {
        return None;
    }
    let circle = circle::refine(&on_it, &circle)?;
    // Neighbouring rays of a small circle meet the same pixels. The rim's shape, its shading and the
    // structure behind it move the edge on all rays together, by a part of the width of the blur and of the
    // rim.
    let independent = (on_it.len() as f64).min(3.0 * circle.radius);
    let common_px = 0.15 + 0.004 * circle.radius;
    let noise_px = circle.rms / (independent * share).sqrt();
    Some(StationOutline { circle, points: on_it.len() as u32, noise_px, common_px })
}

/// Returns d3 and its standard deviation, m, from Rs = f r_s/(d3 + h_s). Returns `None` unless d3 is
/// positive.
pub(crate) fn range(outline: &Outline, focal_px: f64, radius_px: f64, sigma_px: f64) -> Option<(f64, f64)> {
    let range_m = range_from_outline(focal_px, outline.radius_m, outline.depth_m, radius_px)?;
    let sigma_m = (range_m + outline.depth_m) * sigma_px / radius_px;
    sigma_m.is_finite().then_some((range_m, sigma_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::preprocessing::view::View;
    use crate::docking::synthetic;
    use contract::docking::Lines;

    fn find_outline(field: &contract::docking::Field) -> Option<StationOutline> {
        let view = View::new(field);
        find(&view, &view.overview(), &synthetic::lens())
    }

    fn disk(x: usize, y: usize, centre: (f64, f64), radius: f64) -> bool {
        libm::hypot(x as f64 - centre.0, y as f64 - centre.1) <= radius
    }

    #[test]
    fn the_range_is_that_of_the_formula() {
        let outline = synthetic::target().station;
        // f r_s/(d3 + h_s) at 100 m.
        let radius = 1055.0 * 2.05 / 100.45;
        let (range_m, sigma_m) = range(&outline, 1055.0, radius, 0.1).unwrap();
        assert!((range_m - 100.0).abs() < 1e-9);
        assert!((sigma_m - 100.45 * 0.1 / radius).abs() < 1e-9);
        assert_eq!(range(&outline, 1055.0, 1e9, 0.1), None);
        assert_eq!(range(&outline, 1055.0, 0.0, 0.1), None);
    }

    #[test]
    fn the_body_is_measured_and_its_panels_are_not() {
        for radius in [12.0, 40.0, 150.0] {
            let centre = (400.2, 290.7);
            let field = synthetic::drawn(Lines::Even, |x, y| {
                let panel =
                    (x as f64 - centre.0).abs() < 3.0 * radius && (y as f64 - centre.1).abs() < 0.15 * radius;
                if panel || disk(x, y, centre, radius) { 140 } else { 8 }
            });
            let found = find_outline(&field).unwrap();
            let error = found.circle.radius - radius;
            assert!(error.abs() < 3.0 * found.sigma_px(), "{radius}: {found:?}");
            assert!(error.abs() < 1.0 + 0.02 * radius, "{radius}: {error}");
        }
    }

    #[test]
    fn a_ring_on_a_bright_face_does_not_stand_before_the_sky() {
        let centre = (384.0, 288.0);
        let circle = |field: &contract::docking::Field| {
            let view = View::new(field);
            let lens = synthetic::lens();
            let middle = lens.to_ideal(contract::PixelPoint::new(centre.0, centre.1)).unwrap();
            let predicted = (middle, 80.0);
            stands_before_sky(&view, &lens, &measure_at(&view, &lens, predicted, 8.0).unwrap().circle)
        };
        let body = |x, y| if disk(x, y, centre, 80.0) { 140 } else { 8 };
        assert!(circle(&synthetic::drawn(Lines::Even, body)));
        // Ring of the same size on the face of a station three times as large, with sky in one corner.
        let on_face = |x, y| match () {
            () if disk(x, y, centre, 80.0) => 140,
            () if disk(x, y, centre, 250.0) => 90,
            () => 8,
        };
        assert!(!circle(&synthetic::drawn(Lines::Even, on_face)));
    }

    #[test]
    fn a_body_cut_by_the_border_is_measured_on_its_visible_part() {
        let field =
            synthetic::drawn(Lines::Odd, |x, y| if disk(x, y, (380.0, 400.0), 220.0) { 140 } else { 8 });
        let found = find_outline(&field).unwrap();
        assert!((found.circle.radius - 220.0).abs() < 3.0, "{found:?}");
    }

    #[test]
    fn nothing_is_found_where_there_is_no_circle() {
        let outline_in =
            |grey: &dyn Fn(usize, usize) -> u16| find_outline(&synthetic::drawn(Lines::Odd, grey));
        assert_eq!(outline_in(&|_, _| 30), None);
        assert_eq!(outline_in(&|x, _| if x < 300 { 30 } else { 200 }), None);
        assert_eq!(outline_in(&|x, y| if x == 300 && y < 20 { 200 } else { 10 }), None);
    }
}
