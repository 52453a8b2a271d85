//! Disk of the docking unit: search for its edge at the position predicted by cross and marks.

use contract::docking::{Outline, TargetModel};
use nalgebra::Vector2;

use crate::docking::cross_and_circle::circle::{self, CircleFit};
use crate::docking::cross_and_circle::marks::Plane;
use crate::docking::preprocessing::view::{Lens, View};

/// Side of the target in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Side of the docking unit by the model.
    Nominal,
    /// A quarter turn from nominal, clockwise in the image.
    Quarter,
    /// Opposite to nominal.
    Opposite,
    /// Three quarters of a turn from nominal, clockwise in the image.
    ThreeQuarters,
}

impl Side {
    pub(crate) const OTHERS: [Self; 3] = [Self::Quarter, Self::Opposite, Self::ThreeQuarters];

    fn turn(self, offset: Vector2<f64>) -> Vector2<f64> {
        match self {
            Self::Nominal => offset,
            Self::Quarter => Vector2::new(-offset.y, offset.x),
            Self::Opposite => -offset,
            Self::ThreeQuarters => Vector2::new(offset.y, -offset.x),
        }
    }
}

/// Number of rays around the circle on which an edge is searched for.
const RAYS: usize = 48;

/// Predicts the circle of an outline in the ideal image, from the plane and the cross's parallax. A point at
/// height h over the plane is seen at V + (O − V) d3/(d3 − h), with V the vanishing point of the plane's
/// normal; the cross's height gives V.
pub(crate) fn predict(
    model: &TargetModel,
    outline: &Outline,
    focal_px: f64,
    plane: &Plane,
    cross_centre: Vector2<f64>,
    side: Side,
) -> (Vector2<f64>, f64) {
    let (d3, b) = (focal_px / plane.scale_px_m, model.cross.height_m);
    let from_vanishing = (cross_centre - plane.centre) * ((d3 - b) / b);
    let shrink = d3 / (d3 + outline.depth_m);
    let offset = side.turn(plane.project(outline.centre_m) - plane.centre);
    let centre = plane.centre + offset * shrink + from_vanishing * (shrink - 1.0);
    (centre, outline.radius_m * plane.scale_px_m * shrink)
}

/// Edge found near a predicted circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DiskEdge {
    /// Circle through the edge's points; `None` when they do not lie on a circle.
    pub(crate) circle: Option<CircleFit>,
    /// Number of points on the circle or arc.
    pub(crate) points: u32,
    /// Share of the directions in the image, 0 to 1, in which the strongest edge lies on the circle or on an
    /// arc of it.
    pub(crate) share: f64,
    /// Share of all directions, 0 to 1, in which the edge would be in the image.
    pub(crate) in_field: f64,
}

/// Searches for a circular edge of at least `min_step` grey values within a seventh of the radius of its
/// predicted position. Where less than two thirds of it is in the image, searches for an arc within a
/// fortieth of the radius.
pub(crate) fn find(
    view: &View<'_>,
    lens: &Lens,
    (centre, radius): (Vector2<f64>, f64),
    min_step: f64,
) -> DiskEdge {
    let wide = rays(view, lens, (centre, radius), (0.14 * radius).max(3.0), min_step);
    if wide.in_field < 2 * RAYS / 3 {
        return arc(&rays(view, lens, (centre, radius), (0.025 * radius).max(3.0), min_step), radius);
    }
    let Rays { edges, in_field, reach, step } = wide;
    let nothing = DiskEdge { circle: None, points: 0, share: 0.0, in_field: in_field as f64 / RAYS as f64 };
    if edges.len() < 8 {
        return nothing;
    }
    let points: Vec<Vector2<f64>> =
        edges.iter().map(|(direction, offset)| centre + direction * (radius + offset)).collect();
    let tolerance = (0.015 * radius).max(1.5 * step);
    let Some((fit, _)) = circle::fit_robustly(&points, tolerance) else { return nothing };
    let on_it = points.iter().filter(|p| fit.residual(p).abs() <= tolerance).count();
    let plausible = (fit.centre - centre).norm() < reach && (fit.radius / radius - 1.0).abs() < 0.1;
    if !plausible {
        return nothing;
    }
    DiskEdge { circle: Some(fit), points: on_it as u32, share: on_it as f64 / in_field as f64, ..nothing }
}

/// Strongest edges along rays across a predicted circle.
struct Rays {
    /// Direction of a ray from the centre, and distance of its strongest edge outside the predicted circle,
    /// px.
    edges: Vec<(Vector2<f64>, f64)>,
    /// Number of rays in the image.
    in_field: usize,
    /// Distance to either side of the circle within which an edge is searched for, px.
    reach: f64,
    /// Distance between samples, px.
    step: f64,
}

fn rays(
    view: &View<'_>,
    lens: &Lens,
    (centre, radius): (Vector2<f64>, f64),
    reach: f64,
    min_step: f64,
) -> Rays {
    // An edge is a difference over two blurs, and rows of a field are two pixels apart.
    let step = (reach / 12.0).max(1.0);
    let count = (2.0 * reach / step).ceil() as usize + 1;
    let mut found = Rays { edges: Vec::with_capacity(RAYS), in_field: 0, reach, step };
    let mut values = Vec::with_capacity(count);
    for ray in 0..RAYS {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * ray as f64 / RAYS as f64);
        let direction = Vector2::new(cos, sin);
        values.clear();
        values.extend((0..count).map_while(|i| {
            view.sample(lens.to_camera(centre + direction * (radius - reach + step * i as f64))?)
        }));
        if values.len() < count {
            continue;
        }
        found.in_field += 1;
        let strongest = (1..count - 1)
            .map(|i| (i, (values[i + 1] - values[i - 1]).abs()))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, height)) = strongest
            && height >= min_step
        {
            found.edges.push((direction, step * i as f64 - reach));
        }
    }
    found
}

/// Evaluates the visible arc. The arc is too short to fit a circle, so it must be concentric with the
/// prediction.
fn arc(rays: &Rays, radius: f64) -> DiskEdge {
    let nothing =
        DiskEdge { circle: None, points: 0, share: 0.0, in_field: rays.in_field as f64 / RAYS as f64 };
    let mut offsets: Vec<f64> = rays.edges.iter().map(|(_, offset)| *offset).collect();
    offsets.sort_by(f64::total_cmp);
    let Some(&middle) = offsets.get(offsets.len() / 2) else { return nothing };
    let tolerance = (0.008 * radius).max(1.5 * rays.step);
    let on_it = offsets.iter().filter(|offset| (*offset - middle).abs() <= tolerance).count();
    DiskEdge { points: on_it as u32, share: on_it as f64 / rays.in_field as f64, ..nothing }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::synthetic::{self, Scene};
    use contract::docking::Lines;

    #[test]
    fn the_disk_is_found_below_and_not_above() {
        let scene = Scene {
            range_m: 10.0,
            disk_px: Vector2::new(0.0, -20.0),
            parallax_px: Vector2::zeros(),
            ..Scene::default()
        };
        let field = scene.field(Lines::Even);
        let (view, lens, model) = (View::new(&field), synthetic::lens(), synthetic::target());
        // The synthetic scene has the unit in the plane of the disk.
        let unit = Outline { depth_m: 0.0, ..model.docking_unit };
        let look = |side| {
            let predicted =
                predict(&model, &unit, lens.focal_px(), &scene.plane(), scene.cross().centre, side);
            find(&view, &lens, predicted, 15.0)
        };
        let below = look(Side::Nominal);
        assert!(below.share > 0.8, "{below:?}");
        let circle = below.circle.unwrap();
        let radius = 0.66 * scene.plane().scale_px_m;
        assert!((circle.radius - radius).abs() < 1.0, "{} and {radius}", circle.radius);
        for side in Side::OTHERS {
            assert!(look(side).share < 0.5, "{side:?}: {:?}", look(side));
        }
    }

    #[test]
    fn a_point_behind_the_plane_moves_towards_the_vanishing_point() {
        // Camera 1 m to the right of the target's axis at 10 m, without rotation: pinhole projection by hand.
        let (f, d3, d1) = (1000.0, 10.0, 1.0);
        let model = synthetic::target();
        let plane = Plane { centre: Vector2::new(-f * d1 / d3, 0.0), scale_px_m: f / d3, roll_rad: 0.0 };
        let cross = Vector2::new(-f * d1 / (d3 - model.cross.height_m), 0.0);
        let outline = Outline { centre_m: [0.5, -1.0], radius_m: 0.7, depth_m: 0.4 };
        let (centre, radius) = predict(&model, &outline, f, &plane, cross, Side::Nominal);
        assert!((centre - Vector2::new(f * (0.5 - d1) / 10.4, f * 1.0 / 10.4)).norm() < 1e-9, "{centre:?}");
        assert!((radius - f * 0.7 / 10.4).abs() < 1e-9);
    }

    #[test]
    fn an_empty_image_has_no_disk() {
        let field = synthetic::drawn(Lines::Odd, |_, _| 80);
        let found = find(&View::new(&field), &synthetic::lens(), (Vector2::zeros(), 100.0), 10.0);
        assert_eq!((found.circle, found.points), (None, 0));
        let nowhere = find(&View::new(&field), &synthetic::lens(), (Vector2::zeros(), f64::NAN), 10.0);
        assert_eq!(nowhere.circle, None);
    }
}
