//! The fast renderer on the scene of a target: compared with pictures sampled by tiny-skia, and from
//! viewpoints without anything in view.

use boresight_sim::scene::docking::{DockingScene, Floodlight, TargetFile};
use boresight_sim::vector::{Drawer, RadianceImage};
use contract::Camera;
use contract::docking::Pose;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use tiny_skia::{FillRule, Mask, PathBuilder, Transform};

use crate::vector_scene::{camera, draw, plain, pose, random_pose, seen, small, sunlit};

fn target() -> DockingScene {
    TargetFile::built_in("progress").unwrap().scene()
}

/// The scene without light sources, with 16 × 16 samples per pixel: each sample is the reflectance of the
/// last facet that contains it.
fn sampled(camera: &Camera, scene: &DockingScene, pose: &Pose) -> Vec<f32> {
    const SAMPLES: usize = 16;
    let (width, height) = (camera.columns * SAMPLES, camera.rows * SAMPLES);
    let mut fine = vec![0.0_f32; width * height];
    for part in scene.parts.iter().filter(|part| part.visible) {
        for facet in &part.facets {
            if facet.normal.dot(&(pose.position_m - facet.outer[0])) <= 0.0 {
                continue;
            }
            let mut builder = PathBuilder::new();
            for polygon in std::iter::once(&facet.outer).chain(&facet.holes) {
                let mut points = polygon.iter().map(|point| {
                    let [x, y] = seen(camera, pose, point);
                    [(x + 0.5) as f32 * SAMPLES as f32, (y + 0.5) as f32 * SAMPLES as f32]
                });
                let first = points.next().unwrap();
                builder.move_to(first[0], first[1]);
                points.for_each(|[x, y]| builder.line_to(x, y));
                builder.close();
            }
            let Some(path) = builder.finish() else { continue };
            let mut mask = Mask::new(width as u32, height as u32).unwrap();
            mask.fill_path(&path, FillRule::Winding, false, Transform::identity());
            for (value, covered) in fine.iter_mut().zip(mask.data()) {
                if *covered > 127 {
                    *value = facet.reflectance as f32;
                }
            }
        }
    }
    let pixel = |row: usize, column: usize| {
        let samples = (0..SAMPLES * SAMPLES)
            .map(|i| fine[(row * SAMPLES + i / SAMPLES) * width + column * SAMPLES + i % SAMPLES]);
        samples.sum::<f32>() / (SAMPLES * SAMPLES) as f32
    };
    (0..camera.rows * camera.columns).map(|i| pixel(i / camera.columns, i % camera.columns)).collect()
}

#[test]
fn pictures_agree_with_tiny_skia_at_16_by_16_samples() {
    let scene = target();
    // Windows of a camera's image: the cross in front of the plate, the docking ring with its wall, and, at
    // low resolution, the whole station.
    for (focal_px, d, phi, limit) in [
        (1055.0, [0.5, 0.3, 5.0], [-0.064, -0.106, 0.3], 2e-3),
        (1055.0, [-0.4, -0.2, 4.0], [-0.256, 0.244, -0.2], 2e-3),
        (130.0, [0.3, 0.2, 5.0], [0.05, 0.02, 0.3], 6e-3),
    ] {
        let mut camera = small();
        camera.focal_length_mm = focal_px * 8.3e-3;
        let pose = pose(d, phi);
        let image = draw(&camera, &scene, &plain(), &pose);
        let witness = sampled(&camera, &scene, &pose);
        let square: f32 = image.radiance.iter().zip(&witness).map(|(a, b)| (a - b) * (a - b)).sum();
        let rms = (square / witness.len() as f32).sqrt();
        println!("f = {focal_px} px: rms against 16 x 16 samples {rms:.2e}");
        // With 16 × 16 samples, the uncertainty at an edge is about 0.4 % of its contrast. In the picture at
        // low resolution nearly every pixel has an edge, and blankets end where the rim begins: there the
        // face behind both shows through.
        assert!(rms < limit, "{rms}");
    }
}

#[test]
fn an_empty_view_shows_the_sky() {
    let mut lighting = sunlit([0.3, 0.2, 0.9]);
    lighting.sky_radiance = 0.125;
    for (d, phi) in [
        // Behind the station, turned away from it, and beside it.
        ([0.0, 0.0, -60.0], [0.0; 3]),
        ([0.0, 0.0, 5.0], [0.0, std::f64::consts::PI, 0.0]),
        ([500.0, 0.0, 5.0], [0.0; 3]),
    ] {
        let image = draw(&small(), &target(), &lighting, &pose(d, phi));
        assert!(image.radiance.iter().all(|value| *value == 0.125), "{d:?}");
    }
    let empty = draw(&small(), &DockingScene::default(), &lighting, &pose([0.0; 3], [0.0; 3]));
    assert!(empty.radiance.iter().all(|value| *value == 0.125));
}

#[test]
fn a_camera_among_the_facets_draws_finite_radiance() {
    let mut lighting = sunlit([0.3, 0.2, 0.9]);
    for radial in [0.0, -2e-6] {
        let camera = Camera { radial: [radial, 0.0, 0.0], ..small() };
        for d in [[0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [0.3, 0.01, -0.2], [0.1, -1.25, -0.45], [0.5, 0.0, -3.0]]
        {
            for phi in [[0.0; 3], [1.5, 0.2, 0.0], [0.4, -1.6, 2.0]] {
                lighting.floodlight = Some(Floodlight {
                    position_m: Vector3::from(d),
                    axis: -Vector3::z(),
                    intensity: 1.0,
                    inner_half_angle_rad: 0.3,
                    outer_half_angle_rad: 0.3,
                });
                let image = draw(&camera, &target(), &lighting, &pose(d, phi));
                assert_eq!(image.radiance.len(), 96 * 72);
                assert!(image.radiance.iter().all(|value| value.is_finite()), "{d:?} {phi:?}");
            }
        }
    }
    let lost = pose([f64::NAN, f64::INFINITY, 1.0], [f64::NAN; 3]);
    let image = draw(&small(), &target(), &lighting, &lost);
    assert_eq!(image.radiance.len(), 96 * 72);
}

#[test]
fn radiance_is_never_negative() {
    // With the Sun in many directions: overlapping shadows remove the light of a facet only once.
    let scene = target();
    let mut drawer = Drawer::new(&camera(1055.0)).unwrap();
    let mut image = RadianceImage::default();
    for i in 0..8 {
        let (sin, cos) = libm::sincos(0.8 * f64::from(i));
        let height = 0.1 + 0.1 * f64::from(i);
        drawer.draw(&scene, &sunlit([cos, sin, height]), &pose([0.3, -0.4, 6.0], [0.0; 3]), &mut image);
        let (least, most) = image
            .radiance
            .iter()
            .fold((f32::INFINITY, 0.0_f32), |(least, most), &value| (least.min(value), most.max(value)));
        assert!(least >= 0.0 && most > 0.1, "{i}: {least} to {most}");
    }
}

#[test]
fn an_image_is_independent_of_earlier_images() {
    let (camera, scene) = (small(), target());
    let mut other = scene.clone();
    other.parts.truncate(2);
    let (sun, later_sun) = (sunlit([0.3, 0.2, 0.9]), sunlit([-0.3, 0.2, 0.9]));
    let mut drawer = Drawer::new(&camera).unwrap();
    let mut image = RadianceImage::default();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    for _ in 0..5 {
        let pose = random_pose(&mut random);
        drawer.draw(&other, &sun, &pose, &mut image);
        drawer.draw(&scene, &later_sun, &pose, &mut image);
        drawer.draw(&scene, &sun, &pose, &mut image);
        assert_eq!(image, draw(&camera, &scene, &sun, &pose));
    }
}
