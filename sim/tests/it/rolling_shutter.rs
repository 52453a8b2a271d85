//! Rolling shutter: each row shows the scene at its own time, and the truth table says where an object is.

use std::collections::BTreeMap;

use boresight_sim::draw::ExpectedImage;
use boresight_sim::onboard::ShutterConfig;
use boresight_sim::optics::RadiometryConfig;
use boresight_sim::scene::TargetConfig;
use boresight_sim::sensor::{RollingShutterConfig, Switch};
use boresight_sim::truth::{ControlConfig, ObjectKind, ObjectTruth};
use boresight_sim::{Exposure, Simulation, Simulator};

use crate::small_scene::{orbit_of, restless, simulator};

const COLUMNS: usize = 160;
const ROWS: usize = 120;

/// Time from row to row: the field moves by 3 px while the detector is read.
const ROLLING: RollingShutterConfig = RollingShutterConfig { row_time_s: 0.01 };

/// Number of short exposures whose sum is an exposure of a row.
const PARTS: u32 = 59;

/// A camera fixed in the orbital frame, which turns by 2.5 px/s, with drift and a resolved background.
fn turning() -> Simulation {
    let mut simulation = restless();
    simulation.shutter = ShutterConfig::Fixed { exposure_s: 0.25 };
    orbit_of(&mut simulation).manoeuvres.clear();
    simulation.roi = None;
    simulation.sensor.hot_pixels.count = 0;
    simulation
}

/// The scene with its first frame `offset_s` later.
fn shifted(mut simulation: Simulation, offset_s: f64) -> Simulation {
    let second_s = 30.0 + offset_s;
    simulation.schedule[0].start_utc = format!("2012-04-25T12:00:{second_s:012.9}Z");
    simulation
}

fn rolling(mut simulation: Simulation, row_time_s: f64) -> Simulation {
    simulation.sensor.rolling_shutter = Some(RollingShutterConfig { row_time_s });
    simulation
}

fn expose(simulator: &Simulator) -> (Exposure, ExpectedImage) {
    let mut camera = simulator.camera().unwrap();
    let exposure = camera.expose(0).unwrap();
    (exposure, camera.expected().clone())
}

fn pixels(image: &ExpectedImage) -> Vec<f64> {
    image.iter().collect()
}

/// A pixel's electrons from the sum of [`PARTS`] short exposures, without any motion during each, at the time
/// of the pixel's row, for the rows from `top` to `bottom`.
fn sum_of_short_exposures(simulation: &Simulation, top: usize, bottom: usize) -> Vec<f64> {
    let mut short = simulation.clone();
    short.attitude.motion_smear = Switch::Off;
    let exposure_s = 0.25;
    short.shutter = ShutterConfig::Fixed { exposure_s: exposure_s / f64::from(PARTS) };
    let mut flying = simulator(&shifted(short.clone(), 0.0));
    let mut sum = vec![0.0; COLUMNS * ROWS];
    for row in top..bottom {
        for part in 0..PARTS {
            let within_s = exposure_s * ((f64::from(part) + 0.5) / f64::from(PARTS) - 0.5);
            let time_s = ROLLING.offset_s(row as f64, ROWS) + within_s;
            flying.fly(&shifted(short.clone(), time_s)).unwrap();
            let (_, image) = expose(&flying);
            for (column, electrons) in image.iter().skip(row * COLUMNS).take(COLUMNS).enumerate() {
                sum[row * COLUMNS + column] += electrons;
            }
        }
    }
    sum
}

/// Electron-weighted mean position of the pixels of a window above the background `level`.
fn centroid(image: &[f64], x: std::ops::Range<usize>, y: std::ops::Range<usize>, level: f64) -> [f64; 2] {
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    for row in y {
        for column in x.clone() {
            let electrons = image[row * COLUMNS + column] - level;
            sum += electrons;
            moment[0] += electrons * column as f64;
            moment[1] += electrons * row as f64;
        }
    }
    moment.map(|moment| moment / sum)
}

/// A scene whose only object is the star of frame 0 that is brightest among those well inside the detector.
fn one_star() -> (Simulation, ObjectTruth) {
    let mut simulation = turning();
    simulation.target = TargetConfig::LambertSphere { radius_m: 0.1, albedo: 0.0 };
    simulation.attitude.control = ControlConfig::default();
    simulation.sensor.background_e_per_s = 0.0;
    simulation.sensor.dark_current_e_per_s = 0.0;
    // The floor of a stamp then cuts off no visible part of a short exposure.
    simulation.radiometry = RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1.5e8, colour_term: 0.0 };
    let (frame, _) = expose(&simulator(&shifted(simulation.clone(), 0.0)));
    let is_inside = |object: &&ObjectTruth| {
        object.kind == ObjectKind::Star
            && (15.0..145.0).contains(&object.position.x)
            && (15.0..105.0).contains(&object.position.y)
    };
    let inside = frame.objects.iter().filter(is_inside);
    let star = inside.max_by(|a, b| a.electrons.total_cmp(&b.electrons)).unwrap();
    (simulation, star.clone())
}

/// Witness: a sum of a thousand exposures, each of a hundredth of the time and without motion.
#[test]
fn an_image_equals_the_sum_of_a_thousand_short_exposures() {
    let (simulation, star) = one_star();
    let (frame, image) = expose(&simulator(&rolling(shifted(simulation.clone(), 0.0), 0.01)));
    let image = pixels(&image);
    let seen = frame.objects.iter().find(|object| (object.kind, object.id) == (star.kind, star.id)).unwrap();
    let (x, y) = (seen.position.x.round() as usize, seen.position.y.round() as usize);
    let (top, bottom) = (y - 8, y + 9);
    let sum = sum_of_short_exposures(&simulation, top, bottom);
    let peak = sum.iter().copied().fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for row in top..bottom {
        for column in x - 9..x + 10 {
            worst = worst.max((image[row * COLUMNS + column] - sum[row * COLUMNS + column]).abs());
        }
    }
    assert!(worst < 1e-3 * peak, "{worst} of {peak}");
    let [of_image, of_sum] = [&image, &sum].map(|pixels| centroid(pixels, x - 9..x + 10, top..bottom, 0.0));
    let off_px = libm::hypot(of_image[0] - of_sum[0], of_image[1] - of_sum[1]);
    assert!(off_px < 0.002, "{of_image:?} and {of_sum:?}");
    // The truth is where the star is in the image, and not where it is at the time of the frame: it moves as
    // the image moves, its neighbours with it.
    let (_, plain) = expose(&simulator(&shifted(simulation, 0.0)));
    let of_plain = centroid(&pixels(&plain), x - 9..x + 10, top..bottom, 0.0);
    let (moved_x, moved_y) = (of_sum[0] - of_plain[0], of_sum[1] - of_plain[1]);
    let off_x = seen.position.x - star.position.x - moved_x;
    let off_y = seen.position.y - star.position.y - moved_y;
    assert!(libm::hypot(off_x, off_y) < 0.005, "{off_x} {off_y}: {seen:?} {star:?}");
    assert!(libm::hypot(moved_x, moved_y) > 0.1, "{moved_x} {moved_y}");
}

/// Asserts that every row of a scene under the rolling shutter is that of a frame at the row's time.
fn check_rows(simulation: &Simulation) {
    let (frame, image) = expose(&simulator(&rolling(shifted(simulation.clone(), 0.0), 0.01)));
    let image = pixels(&image);
    let peak = frame.objects.iter().map(|object| object.peak_electrons).fold(0.0, f64::max);
    let mut flying = simulator(&shifted(simulation.clone(), 0.0));
    let mut worst: f64 = 0.0;
    for row in 0..ROWS {
        flying.fly(&shifted(simulation.clone(), ROLLING.offset_s(row as f64, ROWS))).unwrap();
        let (_, at_row) = expose(&flying);
        for (column, electrons) in at_row.iter().skip(row * COLUMNS).take(COLUMNS).enumerate() {
            worst = worst.max((image[row * COLUMNS + column] - electrons).abs());
        }
    }
    assert!(worst < 1e-3 * peak, "{worst} of {peak}");
}

/// Background included.
#[test]
fn each_row_equals_that_of_a_frame_at_its_time() {
    check_rows(&turning());
}

/// Trails of 20 px along the columns: within the rows of an image the scene moves by a pixel.
#[test]
fn each_row_of_a_long_trail_equals_that_of_a_frame_at_its_time() {
    let mut simulation = turning();
    simulation.mounting.actual.psi_deg += 90.0;
    simulation.shutter = ShutterConfig::Fixed { exposure_s: 8.0 };
    let star_at = |offset_s: f64| {
        let (frame, _) = expose(&simulator(&shifted(simulation.clone(), offset_s)));
        let stars = frame.objects.into_iter().filter(|object| object.kind == ObjectKind::Star);
        stars.map(|star| (star.id, star.position)).collect::<BTreeMap<_, _>>()
    };
    let (before, after) = (star_at(-4.0), star_at(4.0));
    let (id, from) = before.iter().find(|(id, _)| after.contains_key(id)).unwrap();
    let to = after[id];
    assert!((to.y - from.y).abs() > 15.0 && (to.x - from.x).abs() < 8.0, "{from:?} {to:?}");
    check_rows(&simulation);
}

#[test]
fn the_last_row_may_be_first() {
    let (simulation, star) = one_star();
    let position = |row_time_s: f64| {
        let (frame, _) = expose(&simulator(&rolling(shifted(simulation.clone(), 0.0), row_time_s)));
        let seen = frame.objects.into_iter().find(|object| (object.kind, object.id) == (star.kind, star.id));
        seen.unwrap().position
    };
    let (down, up) = (position(0.005), position(-0.005));
    // To first order, the displacements are opposite.
    let middle = 0.5 * (down.x + up.x);
    assert!((middle - star.position.x).abs() < 0.05 * (down.x - up.x).abs() + 1e-3, "{down:?} {up:?}");
    assert!(down.distance(up) > 0.05, "{down:?} {up:?}");
}

#[test]
fn rows_at_the_same_time_are_a_global_shutter() {
    let simulation = shifted(turning(), 0.0);
    let (plain, of_plain) = expose(&simulator(&simulation));
    let (same, of_same) = expose(&simulator(&rolling(simulation, 0.0)));
    assert_eq!((pixels(&of_same), same), (pixels(&of_plain), plain));
}
