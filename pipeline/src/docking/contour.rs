//! The station's outline: a circle from the contour of its region, and the range from it before the target is resolved.

use contract::docking::Outline;
use imageproc::contours::{BorderType, find_contours};
use imageproc::image::{GrayImage, Luma};
use nalgebra::Vector2;

use super::circle::{self, CircleFit};
use super::paper_pose::range_from_outline;
use super::view::{Lens, Overview};
use super::{binarise, components};

/// The station's outline in a field, ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StationOutline {
    pub(crate) circle: CircleFit,
    /// How many points of the contour lie on it.
    pub(crate) points: u32,
    /// Standard deviation of its radius, px.
    pub(crate) sigma_px: f64,
}

/// Smallest region that can be a station, overview pixels.
const MIN_AREA_PX: u32 = 30;

/// Share of the circle that must be seen as an edge: less of an arc does not fix its radius against tiles, panels and
/// shadows.
const MIN_ARC: f64 = 0.3;

/// The outline of the largest bright region, if that is a circle; `None` when there is none, or when too much of it is
/// outside the image.
pub(crate) fn find(overview: &Overview, lens: &Lens) -> Option<StationOutline> {
    let binary = binarise::above(&overview.grey, binarise::level(&overview.grey));
    let (regions, labels) = components::find(&binary);
    let station = regions.iter().max_by_key(|region| region.area).filter(|r| r.area >= MIN_AREA_PX)?;
    let alone = GrayImage::from_fn(binary.width(), binary.height(), |x, y| {
        Luma([if labels.get_pixel(x, y).0[0] == station.label { 255 } else { 0 }])
    });
    let contour = find_contours::<u32>(&alone)
        .into_iter()
        .filter(|contour| contour.border_type == BorderType::Outer)
        .max_by_key(|contour| contour.points.len())?;
    // Where the region is cut by the border of the image there is no outline.
    let (right, bottom) = (binary.width().saturating_sub(2), binary.height().saturating_sub(2));
    let middle = Vector2::new(station.middle().0, station.middle().1);
    let points: Vec<Vector2<f64>> = contour
        .points
        .iter()
        .filter(|p| p.x > 1 && p.y > 1 && p.x < right && p.y < bottom)
        .filter_map(|p| {
            // The border runs through the centres of the region's outer pixels, half a pixel inside the outline.
            let place = Vector2::new(f64::from(p.x), f64::from(p.y));
            let outwards = (place - middle).try_normalize(1e-9).unwrap_or_else(Vector2::zeros);
            let place = place + 0.5 * outwards;
            lens.to_ideal(overview.to_camera(place.x, place.y))
        })
        .collect();
    let size = station.extent().0.max(station.extent().1) * Overview::PIXEL;
    let fit = most_agreed(&points, size)?;
    let tolerance = tolerance(fit.radius);
    let on_it: Vec<Vector2<f64>> =
        points.iter().filter(|p| fit.residual(p).abs() <= tolerance).copied().collect();
    let arc = arc_share(&on_it, &fit);
    if arc < MIN_ARC {
        return None;
    }
    // Neighbouring points of a contour err together: about one in four counts. The shorter the arc, the more the
    // radius moves with the centre.
    let independent = (on_it.len() as f64 / 4.0).max(1.0);
    let sigma_px = (fit.rms.max(0.5) / independent.sqrt()) * (1.0 / arc) + 0.01 * fit.radius;
    Some(StationOutline { circle: fit, points: on_it.len() as u32, sigma_px })
}

/// How far from the circle its points may be, px.
fn tolerance(radius: f64) -> f64 {
    (0.03 * radius).max(1.5)
}

/// The circle that most points agree with: each of a fixed set of triples spread over the contour proposes one, and the
/// best is refined on its points. Panels and antennas bring as many points as the body; only the body's are on one
/// circle.
fn most_agreed(points: &[Vector2<f64>], size: f64) -> Option<CircleFit> {
    const TRIPLES: usize = 120;
    let n = points.len();
    if n < 12 {
        return None;
    }
    let counted = (n / 300).max(1);
    let agreed = |fit: &CircleFit| {
        let limit = tolerance(fit.radius);
        points.iter().step_by(counted).filter(|p| fit.residual(p).abs() <= limit).count()
    };
    let mut best: Option<(usize, CircleFit)> = None;
    for i in 0..TRIPLES {
        // Low-discrepancy triples: golden-ratio steps along the contour, a quarter to a half apart.
        let start = (i as f64 * 0.618_033_988_749_895).fract();
        let spread = 0.12 + 0.2 * (i as f64 * 0.754_877_666_246_693).fract();
        let pick = |share: f64| points[((share.fract() * n as f64) as usize).min(n - 1)];
        let triple = [pick(start), pick(start + spread), pick(start + 2.0 * spread)];
        let Some(fit) = circle::first_guess(&triple) else { continue };
        if fit.radius > 2.0 * size || fit.radius < 0.1 * size {
            continue;
        }
        let count = agreed(&fit);
        if best.as_ref().is_none_or(|(most, _)| count > *most) {
            best = Some((count, fit));
        }
    }
    let (_, mut fit) = best?;
    for _ in 0..5 {
        let limit = tolerance(fit.radius);
        let near: Vec<Vector2<f64>> =
            points.iter().filter(|p| fit.residual(p).abs() <= limit).copied().collect();
        fit = circle::refine(&near, &fit)?;
    }
    Some(fit)
}

/// Share of the circle's 36 sectors in which there are points.
fn arc_share(points: &[Vector2<f64>], fit: &CircleFit) -> f64 {
    let mut sectors = [false; 36];
    for point in points {
        let away = point - fit.centre;
        let turn = libm::atan2(away.y, away.x) / std::f64::consts::TAU + 0.5;
        sectors[((turn * 36.0) as usize).min(35)] = true;
    }
    sectors.iter().filter(|seen| **seen).count() as f64 / 36.0
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
            let found = find(&View::new(&field).overview(), &synthetic::lens()).unwrap();
            let error = found.circle.radius - radius;
            assert!(error.abs() < 3.0 * found.sigma_px, "{radius}: {found:?}");
            assert!(error.abs() < 1.0 + 0.02 * radius, "{radius}: {error}");
        }
    }

    #[test]
    fn a_body_cut_by_the_border_is_measured_on_what_is_left() {
        let field =
            synthetic::drawn(Lines::Odd, |x, y| if disk(x, y, (380.0, 400.0), 220.0) { 140 } else { 8 });
        let found = find(&View::new(&field).overview(), &synthetic::lens()).unwrap();
        assert!((found.circle.radius - 220.0).abs() < 3.0, "{found:?}");
    }

    #[test]
    fn nothing_is_found_where_there_is_no_circle() {
        let look = |grey: &dyn Fn(usize, usize) -> u16| {
            find(&View::new(&synthetic::drawn(Lines::Odd, grey)).overview(), &synthetic::lens())
        };
        assert_eq!(look(&|_, _| 30), None);
        assert_eq!(look(&|x, _| if x < 300 { 30 } else { 200 }), None);
        assert_eq!(look(&|x, y| if x == 300 && y < 20 { 200 } else { 10 }), None);
    }
}
