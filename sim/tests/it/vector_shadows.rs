//! Illumination and cast shadows of the fast renderer, compared with closed forms.

use std::f64::consts::PI;

use boresight_sim::scene::docking::{Facet, Floodlight, Lighting};
use contract::Camera;
use nalgebra::Vector3;

use crate::vector_scene::{
    camera, circle, cross, draw, flat, moments, part, plain, pose, prism, scene, seen, sunlit,
};

fn sheet(half: f64, height: f64, reflectance: f64) -> Facet {
    flat(&[[-half, -half], [half, -half], [half, half], [-half, half]], height, reflectance)
}

/// Signal that a shadow caster removes from a plate below it: flux and centroid, px.
fn lost(caster: Vec<Facet>, camera: &Camera, lighting: &Lighting) -> (f64, [f64; 2]) {
    lost_to_parts(vec![caster], camera, lighting)
}

/// Signal that the shadow casters of several parts remove from a plate below them: flux and centroid, px.
fn lost_to_parts(casters: Vec<Vec<Facet>>, camera: &Camera, lighting: &Lighting) -> (f64, [f64; 2]) {
    let view = pose([0.2, 0.1, 4.0], [0.03, 0.02, 0.1]);
    let plate = part("plate", vec![sheet(3.0, 0.0, 1.0)]);
    let mut parts = vec![plate.clone()];
    for facets in casters {
        let mut caster = part("caster", facets);
        caster.visible = false;
        parts.push(caster);
    }
    let free = draw(camera, &scene(vec![plate]), lighting, &view);
    let mut shaded = draw(camera, &scene(parts), lighting, &view);
    for (value, free) in shaded.radiance.iter_mut().zip(&free.radiance) {
        *value = free - *value;
    }
    moments(&shaded, [0, 768], [0, 576])
}

/// Flux and centroid of a polygon at y3 = 0 as seen by the camera of [`lost`], by sums over its edges.
fn closed_form(camera: &Camera, polygon: &[[f64; 2]], radiance: f64) -> (f64, [f64; 2]) {
    let view = pose([0.2, 0.1, 4.0], [0.03, 0.02, 0.1]);
    let points: Vec<[f64; 2]> =
        polygon.iter().map(|[x, y]| seen(camera, &view, &Vector3::new(*x, *y, 0.0))).collect();
    let (mut area, mut sums) = (0.0, [0.0; 2]);
    for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
        let turn = 0.5 * (a[0] * b[1] - b[0] * a[1]);
        area += turn;
        sums[0] += turn * (a[0] + b[0]) / 3.0;
        sums[1] += turn * (a[1] + b[1]) / 3.0;
    }
    (area.abs() * radiance, sums.map(|sum| sum / area))
}

#[test]
fn the_shadow_of_the_cross_lies_where_the_sun_puts_it() {
    let camera = camera(1055.0);
    let sun = Vector3::new(0.4, -0.3, 0.8).normalize();
    let (flux, centroid) = lost(vec![flat(&cross(0.15, 0.03), 0.3, 0.8)], &camera, &sunlit([0.4, -0.3, 0.8]));
    let shift = [-0.3 * sun.x / sun.z, -0.3 * sun.y / sun.z];
    let shadow: Vec<[f64; 2]> = cross(0.15, 0.03).iter().map(|[x, y]| [x + shift[0], y + shift[1]]).collect();
    let expected = closed_form(&camera, &shadow, sun.z);
    // Required: 0.02 px. The shadow is drawn with the same exact areas as an outline.
    for axis in 0..2 {
        assert!((centroid[axis] - expected.1[axis]).abs() < 1e-3, "{centroid:?} {expected:?}");
    }
    assert!((flux / expected.0 - 1.0).abs() < 1e-4, "{flux} {expected:?}");
}

#[test]
fn a_sheet_that_the_sun_sees_from_behind_casts_the_same_shadow() {
    let camera = camera(1055.0);
    let mut back = flat(&cross(0.15, 0.03), 0.3, 0.8);
    back.outer.reverse();
    back.normal = -back.normal;
    let front = lost(vec![flat(&cross(0.15, 0.03), 0.3, 0.8)], &camera, &sunlit([0.4, -0.3, 0.8]));
    let back = lost(vec![back], &camera, &sunlit([0.4, -0.3, 0.8]));
    assert!((front.0 - back.0).abs() < 1e-4 * front.0, "{front:?} {back:?}");
}

#[test]
fn a_box_casts_the_shadow_of_its_outline_once() {
    let camera = camera(1055.0);
    let (half, height, thickness) = (0.1, 0.5, 0.2);
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    // With the Sun in the plane y2 = 0 at 45°, the shadow is a square of side 2 half, extended along y1 by
    // the thickness.
    let (flux, centroid) = lost(prism(&corners, height, thickness, 1.0), &camera, &sunlit([1.0, 0.0, 1.0]));
    let (low, high) = (-half - height, half - height + thickness);
    let outline = [[low, -half], [high, -half], [high, half], [low, half]];
    let expected = closed_form(&camera, &outline, libm::sqrt(0.5));
    assert!((flux / expected.0 - 1.0).abs() < 1e-4, "{flux} {expected:?}");
    assert!((centroid[0] - expected.1[0]).abs() < 1e-3, "{centroid:?} {expected:?}");
}

#[test]
fn the_cross_casts_on_the_plate_and_on_the_marks() {
    let camera = camera(1055.0);
    let view = pose([0.0, 0.0, 3.0], [0.0; 3]);
    let mark = |centre: [f64; 2]| {
        let (x, y) = (centre[0], centre[1]);
        flat(
            &[[x - 0.02, y - 0.02], [x + 0.02, y - 0.02], [x + 0.02, y + 0.02], [x - 0.02, y + 0.02]],
            0.0,
            0.8,
        )
    };
    let mut marks = part("marks", vec![mark([-0.3, 0.0]), mark([0.3, 0.0])]);
    marks.casts_shadow = false;
    let scene = scene(vec![
        part("plate", vec![flat(&circle([0.0, 0.0], 0.5, 64), 0.0, 0.04)]),
        marks,
        part("cross", prism(&cross(0.15, 0.2), 0.3, 0.01, 0.8)),
    ]);
    let image = draw(&camera, &scene, &sunlit([1.0, 0.0, 1.0]), &view);
    let at = |x: f64| image.radiance[288 * 768 + (383.5 + 1055.0 * x / 3.0).round() as usize];
    let light = libm::sqrt(0.5) as f32;
    assert!((at(0.3) - 0.8 * light).abs() < 1e-6, "the mark in the Sun: {}", at(0.3));
    assert!((at(0.4) - 0.04 * light).abs() < 1e-6, "the plate in the Sun: {}", at(0.4));
    assert!(at(-0.3).abs() < 1e-6, "the mark in shadow: {}", at(-0.3));
    assert!(at(-0.35).abs() < 1e-6, "the plate in shadow: {}", at(-0.35));
}

#[test]
fn nothing_below_a_plane_casts_on_it() {
    let camera = camera(1055.0);
    let view = pose([0.0, 0.0, 4.0], [0.0; 3]);
    let above = draw(
        &camera,
        &scene(vec![part("below", vec![sheet(1.0, -0.5, 0.3)]), part("plate", vec![sheet(0.4, 0.0, 1.0)])]),
        &sunlit([0.0, 0.0, 1.0]),
        &view,
    );
    assert_eq!(above.radiance[288 * 768 + 384], 1.0);
}

#[test]
fn irradiance_follows_the_cosine_and_the_fill_casts_no_shadow() {
    let camera = camera(1055.0);
    let view = pose([0.0, 0.0, 4.0], [0.0; 3]);
    let mut lighting = sunlit([0.0, 1.0, 1.0]);
    lighting.fill_radiance = 0.25;
    let plate = part("plate", vec![sheet(0.5, 0.0, 0.4)]);
    let middle = |image: &boresight_sim::vector::RadianceImage| image.radiance[288 * 768 + 384];
    let free = draw(&camera, &scene(vec![plate.clone()]), &lighting, &view);
    assert!((middle(&free) - 0.4 * (0.25 + libm::sqrt(0.5) as f32)).abs() < 1e-6);
    let mut roof = part("roof", vec![sheet(9.0, 9.0, 1.0)]);
    roof.visible = false;
    let shaded = draw(&camera, &scene(vec![plate, roof]), &lighting, &view);
    assert!((middle(&shaded) - 0.4 * 0.25).abs() < 1e-6);
    let night = draw(&camera, &scene(vec![part("plate", vec![sheet(0.5, 0.0, 0.4)])]), &plain(), &view);
    assert_eq!(middle(&night), 0.4);
}

fn lamp(position: [f64; 3]) -> Lighting {
    let floodlight = Floodlight {
        position_m: position.into(),
        axis: -Vector3::z(),
        intensity: 2.0 * PI,
        inner_half_angle_rad: 0.2,
        outer_half_angle_rad: 0.3,
    };
    Lighting { sun: None, floodlight: Some(floodlight), fill_radiance: 0.0, sky_radiance: 0.0 }
}

#[test]
fn a_lamp_lights_by_distance_cosine_and_its_cone() {
    // Also with distortion, because the map from pixel to plane inverts it.
    for radial in [0.0, -2e-7] {
        let camera = Camera { radial: [radial, 0.0, 0.0], ..camera(1055.0) };
        let view = pose([0.0, 0.0, 3.0], [0.0; 3]);
        let image = draw(
            &camera,
            &scene(vec![part("wall", vec![sheet(9.0, 0.0, 0.5)])]),
            &lamp([0.3, 0.0, 3.0]),
            &view,
        );
        for (row, column) in [(288, 384), (288, 500), (200, 450), (100, 490), (288, 100), (500, 650)] {
            let distorted = [column as f64 - 383.5, row as f64 - 287.5];
            let mut offset = distorted;
            for _ in 0..50 {
                let r2 = offset[0] * offset[0] + offset[1] * offset[1];
                offset = distorted.map(|along| along / (1.0 + radial * r2));
            }
            let point = Vector3::new(offset[0] * 3.0 / 1055.0, -offset[1] * 3.0 / 1055.0, 0.0);
            let way = point - Vector3::new(0.3, 0.0, 3.0);
            let angle = libm::acos(-way.z / way.norm());
            let share = ((0.3 - angle) / 0.1).clamp(0.0, 1.0);
            let expected = 0.5 * 2.0 * share * libm::cos(angle) / way.norm_squared();
            let drawn = f64::from(image.radiance[row * 768 + column]);
            // The illumination is linear over 16 px, here 0.045 m at 3 m: error 1e-3 at the kink at the
            // cone's edge, smaller elsewhere.
            assert!((drawn - expected).abs() < 1e-3 * 0.11, "{row} {column}: {drawn} {expected}");
        }
    }
}

#[test]
fn a_lamp_casts_shadows_from_its_position() {
    let camera = camera(1055.0);
    let half = 0.05;
    let square = flat(&[[-half, -half], [half, -half], [half, half], [-half, half]], 1.0, 1.0);
    let (_, centroid) = lost(vec![square], &camera, &lamp([0.4, 0.2, 4.0]));
    // From (0.4, 0.2, 4) through (0, 0, 1) to y3 = 0: a third of the distance beyond the square, with 4/3 of
    // its side. The illumination is uniform enough over 0.13 m for the centroid.
    let shadow = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| [-0.4 / 3.0 + x * half * 4.0 / 3.0, -0.2 / 3.0 + y * half * 4.0 / 3.0]);
    let expected = closed_form(&camera, &shadow, 1.0).1;
    for axis in 0..2 {
        assert!((centroid[axis] - expected[axis]).abs() < 0.05, "{centroid:?} {expected:?}");
    }
}

/// The rim of a cross is a tube: the lamp sees slightly more of its dark side than of its lit side.
#[test]
fn a_cross_with_a_separate_rim_casts_the_shadow_of_a_whole_one() {
    let camera = camera(1055.0);
    let mut front = prism(&cross(0.15, 0.03), 0.3, 0.01, 0.8);
    let whole = lost(front.clone(), &camera, &lamp([0.4, 0.3, 4.0]));
    let rim = front.split_off(2);
    front.truncate(1);
    let parts = lost_to_parts(vec![front, rim], &camera, &lamp([0.4, 0.3, 4.0]));
    // Single precision of the image; the shadow of the dark side would remove 1 % more.
    assert!((parts.0 / whole.0 - 1.0).abs() < 1e-4, "{parts:?} {whole:?}");
    for axis in 0..2 {
        assert!((parts.1[axis] - whole.1[axis]).abs() < 1e-3, "{parts:?} {whole:?}");
    }
}
