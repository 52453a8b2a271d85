//! Position errors of tiny-skia's edges and the cost of its pictures, at several oversamplings, beside the
//! fast renderer: the figures behind the choice in ARCHITECTURE.md.
//!
//! `cargo run --release -p boresight-research --bin rasterisers`
#![allow(clippy::unwrap_used, reason = "fails by panicking, like a test")]

// The scenes refer to the simulator by the name that its own tests use.
extern crate sim as boresight_sim;

#[allow(dead_code, reason = "uses only a part of the module")]
#[path = "../../../sim/tests/it/vector_scene.rs"]
mod vector_scene;

use std::time::Instant;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use sim::scene::docking::TargetFile;
use sim::vector::{Drawer, RadianceImage};
use tiny_skia::{Color, FillRule, Mask, Paint, Path, PathBuilder, Pixmap, Transform};
use vector_scene::{
    Point, area_in_pixel, camera, draw, flat, part, plain, pose, random_pose, scene, seen, small, sunlit,
};

const CORNERS: [[f64; 2]; 4] = [[-0.31, -0.22], [0.35, -0.27], [0.24, 0.3], [-0.2, 0.33]];

fn path(polygons: &[Vec<[f64; 2]>], oversampling: usize) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for polygon in polygons {
        for (i, [x, y]) in polygon.iter().enumerate() {
            let point = [x + 0.5, y + 0.5].map(|along| (along * oversampling as f64) as f32);
            if i == 0 { builder.move_to(point[0], point[1]) } else { builder.line_to(point[0], point[1]) }
        }
        builder.close();
    }
    builder.finish()
}

/// Returns the largest error of a pixel's coverage at 100 poses, for tiny-skia and for the fast renderer. For
/// an edge through the pixel it equals the error of the edge's position, px.
fn worst(oversampling: usize, smooth: bool) -> (f64, f64) {
    let camera = small();
    let scene = scene(vec![part("plate", vec![flat(&CORNERS, 0.0, 1.0)])]);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let (mut theirs, mut ours) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        let pose = random_pose(&mut random);
        let polygon = CORNERS.map(|[x, y]| seen(&camera, &pose, &Vector3::new(x, y, 0.0))).to_vec();
        let width = camera.columns * oversampling;
        let mut mask = Mask::new(width as u32, (camera.rows * oversampling) as u32).unwrap();
        let path = path(std::slice::from_ref(&polygon), oversampling).unwrap();
        mask.fill_path(&path, FillRule::Winding, smooth, Transform::identity());
        let image = draw(&camera, &scene, &plain(), &pose);
        for i in 0..camera.columns * camera.rows {
            let (row, column) = (i / camera.columns, i % camera.columns);
            let area = area_in_pixel(&polygon, column, row);
            let samples = (0..oversampling * oversampling).map(|s| {
                let (down, across) =
                    (row * oversampling + s / oversampling, column * oversampling + s % oversampling);
                f64::from(mask.data()[down * width + across]) / 255.0
            });
            let coverage = samples.sum::<f64>() / (oversampling * oversampling) as f64;
            theirs = theirs.max((coverage - area).abs());
            ours = ours.max((f64::from(image.radiance[i]) - area).abs());
        }
    }
    (theirs, ours)
}

/// Least of three times that tiny-skia takes for the facets of the target at 5 m, without shadows, in bands
/// of 16 rows, and for the box filter, ms.
fn milliseconds(oversampling: usize, smooth: bool) -> f64 {
    const BAND: usize = 16;
    let camera = camera(1055.0);
    let pose = pose([0.3, -0.4, 5.0], [0.03, -0.01, 0.05]);
    let scene = TargetFile::built_in("progress").unwrap().scene();
    let facets: Vec<(Vec<Vec<[f64; 2]>>, f64)> = scene
        .parts
        .iter()
        .flat_map(|part| &part.facets)
        .filter(|facet| facet.normal.dot(&(pose.position_m - facet.outer[0])) > 0.0)
        .map(|facet| {
            let polygon =
                |points: &Vec<Point>| points.iter().map(|point| seen(&camera, &pose, point)).collect();
            (std::iter::once(&facet.outer).chain(&facet.holes).map(polygon).collect(), facet.reflectance)
        })
        .collect();
    let mut radiance = vec![0.0_f32; camera.columns * camera.rows];
    let width = camera.columns * oversampling;
    let mut band = Pixmap::new(width as u32, (BAND * oversampling) as u32).unwrap();
    let mut picture = || {
        let start = Instant::now();
        for top in (0..camera.rows).step_by(BAND) {
            band.fill(Color::BLACK);
            let shift = Transform::from_translate(0.0, -((top * oversampling) as f32));
            for (polygons, reflectance) in &facets {
                let mut rows = polygons[0].iter().map(|point| point[1]);
                if rows.clone().all(|y| y < top as f64 - 1.0) || rows.all(|y| y > (top + BAND) as f64) {
                    continue;
                }
                let mut paint = Paint { anti_alias: smooth, ..Paint::default() };
                let shade = *reflectance as f32;
                paint.set_color(Color::from_rgba(shade, shade, shade, 1.0).unwrap());
                band.fill_path(
                    &path(polygons, oversampling).unwrap(),
                    &paint,
                    FillRule::Winding,
                    shift,
                    None,
                );
            }
            let shades = band.pixels();
            for row in 0..BAND {
                for column in 0..camera.columns {
                    let mut sum = 0_u32;
                    for down in 0..oversampling {
                        let start = (row * oversampling + down) * width + column * oversampling;
                        sum += shades[start..start + oversampling]
                            .iter()
                            .map(|shade| u32::from(shade.red()))
                            .sum::<u32>();
                    }
                    radiance[(top + row) * camera.columns + column] =
                        sum as f32 / (255 * oversampling * oversampling) as f32;
                }
            }
        }
        std::hint::black_box(&radiance);
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..3).map(|_| picture()).fold(f64::INFINITY, f64::min)
}

/// Least time of the fast renderer for an image of the target, ms: with a fixed Sun, with a Sun that moves
/// from image to image, and with a moving lamp and no Sun.
fn ours(range: f64) -> [f64; 3] {
    const IMAGES: usize = 60;
    let scene = TargetFile::built_in("progress").unwrap().scene();
    let mut drawer = Drawer::new(&camera(1055.0)).unwrap();
    let mut image = RadianceImage::default();
    let seen_from = pose([0.06 * range, -0.08 * range, range], [0.03, -0.01, 0.05]);
    let sun = sunlit([0.5, 0.6, 0.8]);
    let mut lamp = sun;
    lamp.sun = None;
    lamp.floodlight = Some(boresight_sim::scene::docking::Floodlight {
        position_m: seen_from.position_m + Vector3::new(0.5, 0.5, 0.0),
        axis: -Vector3::z(),
        intensity: 30.0,
        inner_half_angle_rad: 0.2,
        outer_half_angle_rad: 0.4,
    });
    let mut time = |light: &dyn Fn(usize) -> boresight_sim::scene::docking::Lighting| {
        drawer.draw(&scene, &light(0), &seen_from, &mut image);
        let time_of = |i: usize| {
            let start = Instant::now();
            drawer.draw(&scene, &light(i), &seen_from, &mut image);
            start.elapsed().as_secs_f64() * 1e3
        };
        (0..IMAGES).map(time_of).fold(f64::INFINITY, f64::min)
    };
    let moving = |i: usize| {
        let mut light = lamp;
        light.floodlight.as_mut().unwrap().position_m.x += 1e-3 * i as f64;
        light
    };
    [time(&|_| sun), time(&|i| sunlit([0.5, 0.6, 0.8 + 1e-4 * i as f64])), time(&moving)]
}

fn main() {
    println!("oversampling  smooth  worst edge px  ms an image");
    for oversampling in [1, 4, 8, 16] {
        for smooth in [false, true] {
            let (error, _) = worst(oversampling, smooth);
            println!(
                "{oversampling:12}  {smooth:6}  {error:13.4}  {:11.1}",
                milliseconds(oversampling, smooth)
            );
        }
    }
    println!("exact areas: worst edge {:.1e} px", worst(1, true).1);
    println!("range m  Sun ms  moving Sun ms  moving lamp ms");
    for range in [500.0, 20.0, 5.0, 2.0, 1.0] {
        let [sun, moving, lamp] = ours(range);
        println!("{range:7}  {sun:6.2}  {moving:13.2}  {lamp:14.2}");
    }
}
