//! The station's outline: the circle of its end face among the edges of the field, and the range from it before the
//! target is resolved.

use contract::docking::Outline;
use imageproc::image::GrayImage;
use nalgebra::Vector2;

use super::circle::{self, CircleFit};
use super::paper_pose::range_from_outline;
use super::view::{Lens, Overview, View};

/// The station's outline in a field, ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StationOutline {
    pub(crate) circle: CircleFit,
    /// How many points of its edge lie on it.
    pub(crate) points: u32,
    /// Standard deviation of its radius, px.
    pub(crate) sigma_px: f64,
}

/// Smallest radius that is looked for, overview pixels.
const MIN_RADIUS_PX: f64 = 4.5;

/// From one radius of the search to the next.
const RADIUS_STEP: f64 = 1.08;

/// Circles of the search that are measured.
const MEASURED: usize = 16;

/// Rays from a circle's centre along which its edge is looked for.
const RAYS: usize = 72;

/// Share of the rays that must meet the edge on the circle: less does not tell a circle from panels and shadows …
const MIN_SHARE: f64 = 0.6;

/// … nor, below [`SMALL_RADIUS_PX`], from the end of a bar.
const MIN_SMALL_SHARE: f64 = 0.7;

/// Share of a predicted outline that must be in the image to say whether it is there.
const MIN_INSIDE: f64 = 0.45;

/// A circle of fewer pixels fits many things.
const SMALL_RADIUS_PX: f64 = 30.0;

/// Least height of an edge, grey values, and as a multiple of the median difference of neighbours, which is the noise.
const MIN_STEP: (f64, f64) = (8.0, 3.0);

/// The outline of a bright round face; `None` when there is none, or when too much of it is outside the image.
///
/// The face stands before structure that is now darker, now as bright: no threshold cuts it out. Each edge votes for the
/// centres of the circles that it may belong to, bright inside (Kimme, Ballard and Sklansky 1975); the circles with most votes
/// are measured on the field, ray by ray, and the largest one that is whole enough is the outline.
pub(crate) fn find(view: &View<'_>, overview: &Overview, lens: &Lens) -> Option<StationOutline> {
    let min_step = MIN_STEP.0.max(MIN_STEP.1 * noise(&overview.grey));
    let mut proposals = propose(&overview.grey, min_step);
    proposals.sort_by(|a, b| b.share.total_cmp(&a.share));
    let mut kept: Vec<Proposal> = Vec::new();
    for proposal in proposals {
        let repeats = |other: &Proposal| {
            libm::hypot(other.x - proposal.x, other.y - proposal.y) < 0.15 * other.radius
                && (proposal.radius / other.radius - 1.0).abs() < 0.1
        };
        if kept.len() < MEASURED && !kept.iter().any(repeats) {
            kept.push(proposal);
        }
    }
    kept.iter()
        .filter_map(|proposal| {
            let centre = lens.to_ideal(overview.to_camera(proposal.x, proposal.y))?;
            let radius = proposal.radius * Overview::PIXEL;
            let share = if radius < SMALL_RADIUS_PX { MIN_SMALL_SHARE } else { MIN_SHARE };
            measure(view, lens, (centre, radius), min_step, [MIN_SHARE, share])
        })
        .max_by(|a, b| a.circle.radius.total_cmp(&b.circle.radius))
}

/// A circle that edges voted for, overview pixels.
struct Proposal {
    x: f64,
    y: f64,
    radius: f64,
    /// Votes over the circle's circumference.
    share: f64,
}

/// Median difference of horizontal neighbours, grey values.
fn noise(grey: &GrayImage) -> f64 {
    let width = grey.width() as usize;
    if width < 2 {
        return 0.0;
    }
    let mut counts = [0u32; 256];
    let mut total = 0;
    for row in grey.as_raw().chunks_exact(width) {
        for pair in row.windows(2) {
            counts[usize::from(pair[0].abs_diff(pair[1]))] += 1;
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

/// The best circles of each radius.
fn propose(grey: &GrayImage, min_step: f64) -> Vec<Proposal> {
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    if width < 16 || height < 16 {
        return Vec::new();
    }
    let edges = edges(grey, min_step);
    let mut found = Vec::new();
    let mut radius = MIN_RADIUS_PX;
    let mut votes: Vec<u16> = Vec::new();
    while radius < 0.5 * width.min(height) as f64 {
        // The direction of an edge is known to a tenth or so: centres of large circles scatter.
        let cell = (0.10 * radius).max(1.0);
        let (columns, rows) = ((width as f64 / cell) as usize + 1, (height as f64 / cell) as usize + 1);
        votes.clear();
        votes.resize(columns * rows, 0);
        for edge in &edges {
            let (x, y) =
                ((edge.x + radius * edge.inwards.x) / cell, (edge.y + radius * edge.inwards.y) / cell);
            if x >= 0.0 && y >= 0.0 && (x as usize) < columns && (y as usize) < rows {
                let place = y as usize * columns + x as usize;
                votes[place] = votes[place].saturating_add(1);
            }
        }
        let circumference = std::f64::consts::TAU * radius;
        // Two by two cells, so that a centre on the border between cells is no worse than one within.
        let mut best: Vec<Proposal> = Vec::new();
        for row in 1..rows {
            for column in 1..columns {
                let at = row * columns + column;
                let sum = votes[at] + votes[at - 1] + votes[at - columns] + votes[at - columns - 1];
                let share = f64::from(sum) / circumference;
                if share > 0.3 && best.last().is_none_or(|last| best.len() < 4 || share > last.share) {
                    let proposal = Proposal { x: column as f64 * cell, y: row as f64 * cell, radius, share };
                    let place = best.partition_point(|other| other.share >= share);
                    best.insert(place, proposal);
                    best.truncate(4);
                }
            }
        }
        found.append(&mut best);
        radius *= RADIUS_STEP;
    }
    found
}

/// A place on an edge, overview pixels.
struct Edge {
    x: f64,
    y: f64,
    /// Unit vector towards the brighter side.
    inwards: Vector2<f64>,
}

/// The places of steep gradient (Sobel).
fn edges(grey: &GrayImage, min_step: f64) -> Vec<Edge> {
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let pixels = grey.as_raw();
    let mut found = Vec::new();
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let at = |dx: usize, dy: usize| i32::from(pixels[(y + dy - 1) * width + x + dx - 1]);
            let gx = at(2, 0) + 2 * at(2, 1) + at(2, 2) - at(0, 0) - 2 * at(0, 1) - at(0, 2);
            let gy = at(0, 2) + 2 * at(1, 2) + at(2, 2) - at(0, 0) - 2 * at(1, 0) - at(2, 0);
            let square = f64::from(gx * gx + gy * gy);
            // A step of this height has four times its height in Sobel's sum.
            if square >= 16.0 * min_step * min_step {
                let length = square.sqrt();
                let inwards = Vector2::new(f64::from(gx), f64::from(gy)) / length;
                found.push(Edge { x: x as f64, y: y as f64, inwards });
            }
        }
    }
    found
}

/// Whether the outline is seen where `centre` and `radius` predict it; `None` when too much of it is outside the image to
/// say. A tenth of the radius is what tilt and parallax may move it by.
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
                .is_some_and(|place| view.holds(place, 2.0))
        })
        .count();
    let inside = inside as f64 / RAYS as f64;
    if inside < MIN_INSIDE {
        return None;
    }
    // Shadows and what stands behind may hide half of it.
    let seen = measure(view, lens, (centre, radius), min_step, [0.25 * inside, 0.45 * inside]);
    Some(seen.is_some_and(|seen| (seen.circle.radius / radius - 1.0).abs() < 0.12))
}

/// The circle through the steepest falls of brightness on rays from a centre, twice, the second time about the first; on it
/// must be the given shares of the rays.
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
    // An edge is the difference of the means of some samples on either side: tiles and seams are narrower.
    let side = ((0.02 * radius).max(2.0) / step).round().max(1.0) as usize;
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
            // The vertex of the parabola through three falls.
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
    // Neighbouring rays of a small circle meet the same pixels. The rim's own shape, its shading and what shows behind it
    // move the edge together on all rays: by a part of the width of the blur and of the rim.
    let independent = (on_it.len() as f64).min(3.0 * circle.radius);
    let common_px = 0.15 + 0.004 * circle.radius;
    let sigma_px = (circle.rms * circle.rms / independent / share + common_px * common_px).sqrt();
    Some(StationOutline { circle, points: on_it.len() as u32, sigma_px })
}

/// d3 and its standard deviation, m: Rs = f r_s/(d3 + h_s). `None` unless it is positive.
pub(crate) fn range(outline: &Outline, focal_px: f64, radius_px: f64, sigma_px: f64) -> Option<(f64, f64)> {
    let range_m = range_from_outline(focal_px, outline.radius_m, outline.depth_m, radius_px)?;
    let sigma_m = (range_m + outline.depth_m) * sigma_px / radius_px;
    sigma_m.is_finite().then_some((range_m, sigma_m))
}

#[cfg(test)]
mod tests {
    use super::super::synthetic;
    use super::super::view::View;
    use super::*;
    use contract::docking::Lines;

    fn look_at(field: &contract::docking::Field) -> Option<StationOutline> {
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
            let found = look_at(&field).unwrap();
            let error = found.circle.radius - radius;
            assert!(error.abs() < 3.0 * found.sigma_px, "{radius}: {found:?}");
            assert!(error.abs() < 1.0 + 0.02 * radius, "{radius}: {error}");
        }
    }

    #[test]
    fn a_body_cut_by_the_border_is_measured_on_what_is_left() {
        let field =
            synthetic::drawn(Lines::Odd, |x, y| if disk(x, y, (380.0, 400.0), 220.0) { 140 } else { 8 });
        let found = look_at(&field).unwrap();
        assert!((found.circle.radius - 220.0).abs() < 3.0, "{found:?}");
    }

    #[test]
    fn nothing_is_found_where_there_is_no_circle() {
        let look = |grey: &dyn Fn(usize, usize) -> u16| look_at(&synthetic::drawn(Lines::Odd, grey));
        assert_eq!(look(&|_, _| 30), None);
        assert_eq!(look(&|x, _| if x < 300 { 30 } else { 200 }), None);
        assert_eq!(look(&|x, y| if x == 300 && y < 20 { 200 } else { 10 }), None);
    }
}
