//! Edge positions of the fast renderer, compared with coverage in closed form that is computed independently.

use boresight_sim::vector::RadianceImage;
use contract::Camera;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::vector_scene::{
    area_in_pixel, camera, circle, cross, draw, flat, moments, part, plain, pose, random_pose, scene, seen,
    shoelace, small,
};

/// Largest difference of a pixel's coverage from its closed form. For an edge that crosses a pixel from side
/// to side, the position error in px equals the coverage error.
fn worst_coverage(image: &RadianceImage, polygon: &[[f64; 2]]) -> f64 {
    let mut worst = 0.0_f64;
    for row in 0..image.rows {
        for column in 0..image.columns {
            let drawn = f64::from(image.radiance[row * image.columns + column]);
            worst = worst.max((drawn - area_in_pixel(polygon, column, row)).abs());
        }
    }
    worst
}

#[test]
fn edges_are_where_the_closed_form_has_them_at_100_poses() {
    let camera = small();
    let corners = [[-0.31, -0.22], [0.35, -0.27], [0.24, 0.3], [-0.2, 0.33]];
    let scene = scene(vec![part("plate", vec![flat(&corners, 0.0, 1.0)])]);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut worst = 0.0_f64;
    for _ in 0..100 {
        let pose = random_pose(&mut random);
        let image = draw(&camera, &scene, &plain(), &pose);
        let polygon = corners.map(|[x, y]| seen(&camera, &pose, &Vector3::new(x, y, 0.0)));
        worst = worst.max(worst_coverage(&image, &polygon));
    }
    println!("worst edge position error at 100 poses: {worst:.1e} px");
    // Required: 0.01 px. The areas are exact; the remaining error is the rounding of single precision, about
    // 1e-7 per edge.
    assert!(worst < 2e-6, "{worst}");
}

#[test]
fn the_flux_of_a_facet_is_its_area_in_closed_form() {
    let camera = camera(1055.0);
    let pose = pose([0.1, -0.05, 5.0], [0.02, -0.03, 0.4]);
    let outline = cross(0.15, 0.03);
    let scene = scene(vec![part("cross", vec![flat(&outline, 0.3, 1.0)])]);
    let image = draw(&camera, &scene, &plain(), &pose);
    let polygon: Vec<[f64; 2]> =
        outline.iter().map(|[x, y]| seen(&camera, &pose, &Vector3::new(*x, *y, 0.3))).collect();
    let (flux, _) = moments(&image, [0, 768], [0, 576]);
    let area = shoelace(&polygon).abs();
    assert!((flux / area - 1.0).abs() < 1e-6, "{flux} {area}");
}

#[test]
fn centre_and_radius_of_a_circle_are_those_of_its_moments() {
    let camera = camera(1055.0);
    let (d, sides) = ([0.06, 0.04, 5.0], 256);
    let image = draw(
        &camera,
        &scene(vec![part("disk", vec![flat(&circle([0.0, 0.0], 0.3, sides), 0.0, 1.0)])]),
        &plain(),
        &pose(d, [0.0; 3]),
    );
    let (flux, centroid) = moments(&image, [0, 768], [0, 576]);
    // A polygon with n sides has n/(2π) sin(2π/n) of the circle's area.
    let share =
        sides as f64 / (2.0 * std::f64::consts::PI) * libm::sin(2.0 * std::f64::consts::PI / sides as f64);
    let radius = (flux / share / std::f64::consts::PI).sqrt();
    assert!((radius - 1055.0 * 0.3 / 5.0).abs() < 1e-4, "{radius}");
    assert!((centroid[0] - (383.5 - 1055.0 * d[0] / d[2])).abs() < 1e-4, "{centroid:?}");
    assert!((centroid[1] - (287.5 + 1055.0 * d[1] / d[2])).abs() < 1e-4, "{centroid:?}");
}

#[test]
fn the_parallax_of_the_cross_follows_its_height() {
    let camera = camera(2917.0);
    let (d, b) = ([0.05, -0.03, 5.0], 0.3);
    let image = draw(
        &camera,
        &scene(vec![
            part("plate", vec![flat(&circle([0.0, 0.0], 0.3, 96), 0.0, 0.0)]),
            part("cross", vec![flat(&cross(0.15, 0.03), b, 1.0)]),
        ]),
        &plain(),
        &pose(d, [0.0; 3]),
    );
    let (_, centroid) = moments(&image, [0, 768], [0, 576]);
    // docking paper, 3.1: Xc − Xo = −f b d1/(d3 (d3 − b)) with the disk's centre at −f d1/d3.
    let expected = [383.5 - 2917.0 * d[0] / (d[2] - b), 287.5 + 2917.0 * d[1] / (d[2] - b)];
    for axis in 0..2 {
        // A pixel's flux counts at the pixel centre: along vertical edges, 186 px out of 6600 px² on each
        // side, with an error of 1/8 px at worst.
        assert!((centroid[axis] - expected[axis]).abs() < 4e-3, "{centroid:?} {expected:?}");
    }
}

#[test]
fn a_part_in_many_facets_is_the_part_in_one() {
    let camera = camera(1055.0);
    let pose = pose([0.1, 0.2, 3.0], [0.1, -0.05, 0.3]);
    let whole = scene(vec![
        part("behind", vec![flat(&[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]], -1.0, 0.1)]),
        part("sheet", vec![flat(&[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], 0.0, 0.7)]),
    ]);
    let mut cut = whole.clone();
    let coordinate = |i: usize| -0.5 + i as f64 / 7.0;
    cut.parts[1].facets = (0..49)
        .map(|i| {
            let (x, y) =
                ([coordinate(i % 7), coordinate(i % 7 + 1)], [coordinate(i / 7), coordinate(i / 7 + 1)]);
            flat(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], 0.0, 0.7)
        })
        .collect();
    let (one, many) = (draw(&camera, &whole, &plain(), &pose), draw(&camera, &cut, &plain(), &pose));
    let worst = one.radiance.iter().zip(&many.radiance).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Rounding of single precision over 16 consecutive edges.
    assert!(worst < 3e-6, "{worst}");
}

#[test]
fn nothing_shows_between_parts_that_share_an_edge() {
    let camera = camera(1055.0);
    let pose = pose([0.1, 0.2, 3.0], [0.1, -0.05, 0.3]);
    let behind = part("behind", vec![flat(&[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]], -1.0, 0.0)]);
    let left = flat(&[[-0.5, -0.5], [0.1, -0.5], [0.1, 0.5], [-0.5, 0.5]], 0.0, 0.7);
    let right = flat(&[[0.1, -0.5], [0.5, -0.5], [0.5, 0.5], [0.1, 0.5]], 0.0, 0.7);
    let apart =
        scene(vec![behind.clone(), part("left", vec![left.clone()]), part("right", vec![right.clone()])]);
    let whole = scene(vec![behind, part("sheet", vec![left, right])]);
    let (one, two) = (draw(&camera, &whole, &plain(), &pose), draw(&camera, &apart, &plain(), &pose));
    let worst = one.radiance.iter().zip(&two.radiance).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst < 3e-6, "{worst}");
}

#[test]
fn a_hole_shows_the_part_behind_it() {
    let camera = camera(1055.0);
    let mut ring = flat(&circle([0.0, 0.0], 0.6, 64), 0.0, 1.0);
    ring.holes
        .push(circle([0.0, 0.0], 0.4, 64).iter().rev().map(|[x, y]| Vector3::new(*x, *y, 0.0)).collect());
    let behind = flat(&[[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]], -1.0, 0.25);
    let scene = scene(vec![part("behind", vec![behind]), part("ring", vec![ring])]);
    let image = draw(&camera, &scene, &plain(), &pose([0.0, 0.0, 4.0], [0.0; 3]));
    let at = |x: f64| image.radiance[288 * 768 + (383.5 + 1055.0 * x / 4.0) as usize];
    assert_eq!((at(0.0), at(0.5), at(0.8)), (0.25, 1.0, 0.25));
}

#[test]
fn a_line_bends_as_in_the_camera_model() {
    let camera = Camera { radial: [-2.5e-7, 0.0, 0.0], tangential: [1e-6, -2e-6], ..camera(1055.0) };
    // A half-plane whose straight edge crosses the field above the middle.
    let corners = [[-8.0, 0.6], [8.0, 0.9], [8.0, 9.0], [-8.0, 9.0]];
    let scene = scene(vec![part("edge", vec![flat(&corners, 0.0, 1.0)])]);
    let pose = pose([0.0, 0.0, 4.0], [0.0; 3]);
    let image = draw(&camera, &scene, &plain(), &pose);
    let distorted = |y1: f64| {
        let point = Vector3::new(y1, 0.75 + 0.15 * y1 / 8.0, 0.0);
        let [x, y] = seen(&camera, &pose, &point);
        let (u, v) = (x - camera.principal_x_px, y - camera.principal_y_px);
        let r2 = u * u + v * v;
        let radial = 1.0 + camera.radial[0] * r2;
        let [p1, p2] = camera.tangential;
        [
            camera.principal_x_px + u * radial + 2.0 * p1 * u * v + p2 * (r2 + 2.0 * u * u),
            camera.principal_y_px + v * radial + p1 * (r2 + 2.0 * v * v) + 2.0 * p2 * u * v,
        ]
    };
    // The mean position of the edge over a column equals the column's flux above the edge; computed by
    // Simpson's rule over the column.
    let edge_at = |column: f64| {
        let (mut low, mut high) = (-4.0, 4.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if distorted(middle)[0] < column { low = middle } else { high = middle }
        }
        distorted(low)[1]
    };
    let mut bend = 0.0_f64;
    for column in [3, 100, 250, 384, 500, 640, 764] {
        let flux: f32 = (0..576).map(|row| image.radiance[row * 768 + column]).sum();
        let x = column as f64;
        let expected = (edge_at(x - 0.5) + 4.0 * edge_at(x) + edge_at(x + 0.5)) / 6.0;
        // The chords are within 0.001 px of the curve.
        assert!((f64::from(flux) - 0.5 - expected).abs() < 1.5e-3, "{column}: {flux} {expected}");
        let chord = edge_at(3.0) + (x - 3.0) / 761.0 * (edge_at(764.0) - edge_at(3.0));
        bend = bend.max((chord - expected).abs());
    }
    assert!(bend > 3.0, "the line does not bend: {bend}");
}
