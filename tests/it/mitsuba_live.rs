//! Mitsuba itself compared with closed forms: positions of points, and radiance of surfaces. Needs Mitsuba
//! 3.9.1; run with `cargo test --test it mitsuba_live:: -- --ignored`, with its command in
//! `BORESIGHT_MITSUBA` if it is not on the PATH.

use std::f64::consts::PI;

use boresight::mitsuba::{MitsubaOptions, MitsubaRenderer};
use contract::docking::Pose;
use contract::{Camera, Direction, PixelPoint};
use nalgebra::{Matrix3, Rotation3, Vector3};
use sim::mitsuba::{Crop, Settings};
use sim::optics::Projection;
use sim::scene::docking::{Assembly, DockingScene, Facet, Floodlight, Lighting, Part, Sun};
use sim::vector::RadianceImage;

fn camera(focal_length_px: f64) -> Camera {
    Camera {
        columns: 384,
        rows: 288,
        focal_length_mm: focal_length_px / 100.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 196.3,
        principal_y_px: 139.1,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

fn square(centre: Vector3<f64>, half: f64, reflectance: f64) -> Facet {
    let corner = |x: f64, y: f64| centre + Vector3::new(x * half, y * half, 0.0);
    let outer = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    Facet { outer, holes: Vec::new(), normal: Vector3::z(), reflectance }
}

fn scene(facets: Vec<Facet>) -> DockingScene {
    let part = Part {
        name: "squares".to_owned(),
        assembly: Assembly::Station,
        facets,
        casts_shadow: true,
        visible: true,
    };
    DockingScene { parts: vec![part] }
}

fn renderer(samples: u32) -> MitsubaRenderer {
    let settings = Settings { samples, crop: None };
    MitsubaRenderer::new(MitsubaOptions { settings, ..MitsubaOptions::default() }).unwrap()
}

const NIGHT: Lighting = Lighting { sun: None, floodlight: None, fill_radiance: 0.0, sky_radiance: 0.0 };

/// Pixel positions of the corners by the project's projection.
fn projected(facet: &Facet, pose: &Pose, camera: &Camera) -> Vec<PixelPoint> {
    let ideal = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let camera_from_target = (ideal * Rotation3::from_scaled_axis(pose.phi_rad).matrix()).transpose();
    let projection = Projection::new(camera).unwrap();
    let place = |corner: &Vector3<f64>| {
        let direction = Direction::from_vector(camera_from_target * (corner - pose.position_m)).unwrap();
        projection.project(&direction).unwrap()
    };
    facet.outer.iter().map(place).collect()
}

/// Centroid of a polygon (the surveyor's formula).
fn centroid(polygon: &[PixelPoint]) -> PixelPoint {
    let (mut area, mut x, mut y) = (0.0, 0.0, 0.0);
    for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let cross = p.x * q.y - q.x * p.y;
        area += cross / 2.0;
        x += (p.x + q.x) * cross / 6.0;
        y += (p.y + q.y) * cross / 6.0;
    }
    PixelPoint::new(x / area, y / area)
}

/// Centroid of the radiance in a box around a polygon.
fn centre_of_light(image: &RadianceImage, polygon: &[PixelPoint]) -> PixelPoint {
    let range = |of: fn(&PixelPoint) -> f64| {
        let low = polygon.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        (low - 2.0).round() as usize..=(high + 2.0).round() as usize
    };
    let (mut sum, mut sx, mut sy) = (0.0, 0.0, 0.0);
    for row in range(|p| p.y) {
        for column in range(|p| p.x) {
            let light = f64::from(image.radiance[row * image.columns + column]);
            sum += light;
            sx += light * column as f64;
            sy += light * row as f64;
        }
    }
    PixelPoint::new(sx / sum, sy / sum)
}

/// Half a pixel, a mirrored axis, or a wrong sign of the principal point or of an angle would each cause 0.5
/// px or more.
#[test]
#[ignore = "needs Mitsuba 3.9.1"]
fn squares_at_known_positions_agree_with_the_projection() {
    let renderer = renderer(64);
    let mut facets = Vec::new();
    for (row, y) in [-0.36, 0.0, 0.36].into_iter().enumerate() {
        for (column, x) in [-0.5, -0.17, 0.17, 0.5].into_iter().enumerate() {
            // All heights differ: depth becomes visible by parallax.
            let height = 0.08 * (4 * row + column) as f64 - 0.4;
            facets.push(square(Vector3::new(x, y, height), 0.035, 0.8));
        }
    }
    let scene = scene(facets);
    let lighting = Lighting { fill_radiance: 1.0, ..NIGHT };
    let (mut sum, mut count) = (0.0, 0);
    for (d, phi, focal) in [
        ([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 1055.0),
        ([0.1, -0.15, 5.0], [0.0, 0.0, 0.0], 1055.0),
        ([0.0, 0.0, 5.0], [0.03, 0.0, 0.0], 1055.0),
        ([0.0, 0.0, 5.0], [0.0, -0.03, 0.0], 1055.0),
        ([0.0, 0.0, 5.0], [0.0, 0.0, 0.3], 1055.0),
        ([1.0, 0.4, 4.5], [0.08, -0.21, -0.05], 1055.0),
        ([0.05, -0.1, 15.0], [0.0, 0.0, 0.0], 2917.0),
        ([-0.4, 0.3, 15.0], [0.02, 0.027, 0.15], 2917.0),
        ([0.0, 0.0, 2.5], [0.0, 0.0, 0.0], 420.0),
    ] {
        let pose = Pose { position_m: Vector3::from(d), phi_rad: Vector3::from(phi) };
        let camera = camera(focal);
        let image = renderer.radiance(&scene, &lighting, &pose, &camera).unwrap();
        let mut worst = 0.0_f64;
        for facet in &scene.parts[0].facets {
            let polygon = projected(facet, &pose, &camera);
            let inside = |p: &PixelPoint| p.x > 4.0 && p.y > 4.0 && p.x < 379.0 && p.y < 283.0;
            if polygon.iter().all(inside) {
                let off = centroid(&polygon).distance(centre_of_light(&image, &polygon));
                worst = worst.max(off);
                sum += off * off;
                count += 1;
            }
        }
        println!("d = {d:?} m, phi = {phi:?}: worst {worst:.4} px");
    }
    let rms = (sum / f64::from(count)).sqrt();
    println!("{count} squares in nine poses: rms {rms:.4} px");
    assert!(count > 80, "{count}");
    // Mitsuba uses 32-bit matrices: 0.002 to 0.005 px.
    assert!(rms < 0.01, "{rms}");
}

#[test]
#[ignore = "needs Mitsuba 3.9.1"]
fn sun_lamp_fill_and_sky_are_as_bright_as_their_closed_forms() {
    let camera = camera(1055.0);
    let pose = Pose { position_m: Vector3::new(0.0, 0.0, 5.0), phi_rad: Vector3::zeros() };
    let plate = scene(vec![square(Vector3::zeros(), 0.3, 0.45)]);
    let sun = Sun { towards: Vector3::new(0.6, 0.48, 0.64), irradiance: 2.5 };
    let lamp = Floodlight {
        position_m: Vector3::new(0.3, -0.2, 4.8),
        axis: (Vector3::new(0.1, 0.1, 0.0) - Vector3::new(0.3, -0.2, 4.8)).normalize(),
        intensity: 20.0,
        inner_half_angle_rad: 0.01,
        outer_half_angle_rad: 0.12,
    };
    let renderer = renderer(16);
    let radiance = |lighting: &Lighting| renderer.radiance(&plate, lighting, &pose, &camera).unwrap();
    let of = |image: &RadianceImage, x: usize, y: usize| f64::from(image.radiance[y * image.columns + x]);
    let close = |seen: f64, expected: f64, what: &str| {
        println!("{what}: {seen:.6}, expected {expected:.6}");
        assert!((seen / expected - 1.0).abs() < 1e-3, "{what}: {seen} {expected}");
    };
    let sunlit = radiance(&Lighting { sun: Some(sun), ..NIGHT });
    close(of(&sunlit, 196, 139), 0.45 * 2.5 * 0.64 / PI, "sun");
    assert_eq!(of(&sunlit, 5, 5), 0.0);
    let filled = radiance(&Lighting { fill_radiance: 0.2, sky_radiance: 0.03, ..NIGHT });
    close(of(&filled, 196, 139), 0.45 * 0.2, "fill");
    close(of(&filled, 5, 5), 0.03, "sky");
    // Without fill the plate hides the sky.
    assert_eq!(of(&radiance(&Lighting { sky_radiance: 0.03, ..NIGHT }), 196, 139), 0.0);
    let lit = radiance(&Lighting { floodlight: Some(lamp), ..NIGHT });
    for (x, y) in [(196_usize, 139_usize), (215, 120), (160, 150)] {
        // Point of the plate, y3 = 0, on the ray of the pixel centre, from d3 = 5.
        let place = Vector3::new((x as f64 - 196.3) * 5.0 / 1055.0, -(y as f64 - 139.1) * 5.0 / 1055.0, 0.0);
        let ray = place - lamp.position_m;
        let off_axis = libm::acos(ray.normalize().dot(&lamp.axis));
        let share = ((lamp.outer_half_angle_rad - off_axis)
            / (lamp.outer_half_angle_rad - lamp.inner_half_angle_rad))
            .clamp(0.0, 1.0);
        let cosine = -ray.z / ray.norm();
        close(of(&lit, x, y), 0.45 / PI * 20.0 * share * cosine / ray.norm_squared(), "lamp");
    }
}

#[test]
#[ignore = "needs Mitsuba 3.9.1"]
fn a_crop_is_the_part_of_the_whole_image_that_it_names() {
    let camera = camera(1055.0);
    let pose = Pose { position_m: Vector3::new(0.1, 0.0, 5.0), phi_rad: Vector3::new(0.01, 0.0, 0.1) };
    let plate = scene(vec![square(Vector3::zeros(), 0.3, 0.45)]);
    let lighting = Lighting { fill_radiance: 1.0, ..NIGHT };
    let whole = renderer(64).radiance(&plate, &lighting, &pose, &camera).unwrap();
    let crop = Crop { x: 100, y: 60, columns: 120, rows: 100 };
    let settings = Settings { samples: 64, crop: Some(crop) };
    let cut = MitsubaRenderer::new(MitsubaOptions { settings, ..MitsubaOptions::default() }).unwrap();
    let cut = cut.radiance(&plate, &lighting, &pose, &camera).unwrap();
    assert_eq!((cut.columns, cut.rows), (120, 100));
    for row in 0..crop.rows {
        for column in 0..crop.columns {
            let here = cut.radiance[row * crop.columns + column];
            let there = whole.radiance[(crop.y + row) * whole.columns + crop.x + column];
            // Different samples of the same edge: eight standard deviations for 64 stratified samples.
            assert!((here - there).abs() < 0.03, "({column}, {row}): {here} {there}");
        }
    }
}
