//! Interlaced readout: alternate rows show the scene at two different times, and the truth table accounts for
//! both.

use boresight_sim::draw::ExpectedImage;
use boresight_sim::onboard::ShutterConfig;
use boresight_sim::scene::TargetConfig;
use boresight_sim::sensor::{InterlaceConfig, RowParity, Switch, TelegraphConfig};
use boresight_sim::truth::{ControlConfig, ObjectKind, ObjectTruth};
use boresight_sim::{Exposure, Simulation};

use crate::small_scene::{START_UTC, orbit_of, restless, simulator, still};

const COLUMNS: usize = 160;

/// Interval in which the field of the small scene rotates by 5 px: 2 s at one rotation per orbit.
const INTERVAL_S: f64 = 2.0;

fn interlaced(mut simulation: Simulation, field_interval_s: f64, first_field: RowParity) -> Simulation {
    simulation.sensor.interlace = Some(InterlaceConfig { field_interval_s, first_field });
    simulation
}

/// A camera fixed in the orbital frame, with jitter, drift and background, and with the same exposure time in
/// every frame.
fn turning() -> Simulation {
    let mut simulation = restless();
    simulation.shutter = ShutterConfig::Fixed { exposure_s: 0.25 };
    orbit_of(&mut simulation).manoeuvres.clear();
    simulation.roi = None;
    simulation.background.zodiacal = Switch::On;
    simulation
}

/// A pinhole camera with the same motion, and with the brightest star of the field as the only object.
fn one_star() -> Simulation {
    let mut simulation = turning();
    simulation.camera.radial = [0.0; 3];
    simulation.camera.tangential = [0.0; 2];
    simulation.target = TargetConfig::LambertSphere { radius_m: 0.1, albedo: 0.0 };
    simulation.background.zodiacal = Switch::Off;
    simulation.attitude.control = ControlConfig::default();
    simulation.sensor.background_e_per_s = 0.0;
    simulation.sensor.dark_current_e_per_s = 0.0;
    simulation.sensor.hot_pixels.count = 0;
    let stars = expose(&simulation, 0).0.objects;
    let brightest = stars.into_iter().max_by(|a, b| a.electrons.total_cmp(&b.electrons)).unwrap();
    simulation.catalog.magnitude_limit = brightest.magnitude;
    simulation
}

/// The progressive scene with its first frame shifted by some seconds.
fn shifted(mut simulation: Simulation, seconds: i32) -> Simulation {
    simulation.schedule[0].start_utc = match seconds {
        -1 => "2012-04-25T11:59:59Z".into(),
        1 => "2012-04-25T12:00:01Z".into(),
        _ => START_UTC.into(),
    };
    simulation
}

fn expose(simulation: &Simulation, frame: u64) -> (Exposure, ExpectedImage) {
    let simulator = simulator(simulation);
    let mut camera = simulator.camera().unwrap();
    let exposure = camera.expose(frame).unwrap();
    (exposure, camera.expected().clone())
}

fn rows<T>(image: impl Iterator<Item = T>, parity: usize) -> Vec<T> {
    image.enumerate().filter(|(index, _)| index / COLUMNS % 2 == parity).map(|(_, value)| value).collect()
}

fn find(objects: &[ObjectTruth], like: &ObjectTruth) -> Option<ObjectTruth> {
    objects.iter().find(|object| (object.kind, object.id) == (like.kind, like.id)).cloned()
}

/// Definition: each field equals, bit by bit, that of a progressive frame half an interval before or after.
#[test]
fn each_field_equals_the_progressive_frame_at_its_time() {
    let (before, after) = (expose(&shifted(turning(), -1), 0), expose(&shifted(turning(), 1), 0));
    for (first_field, even, odd) in [(RowParity::Even, &before, &after), (RowParity::Odd, &after, &before)] {
        let (frame, expected) = expose(&interlaced(turning(), INTERVAL_S, first_field), 0);
        for (parity, (progressive, light)) in [even, odd].into_iter().enumerate() {
            assert_eq!(rows(expected.iter(), parity), rows(light.iter(), parity), "{first_field:?}");
            assert_eq!(
                rows(frame.frame.dn().iter(), parity),
                rows(progressive.frame.dn().iter(), parity),
                "{first_field:?}"
            );
        }
        assert_ne!(rows(expected.iter(), 0), rows(odd.1.iter(), 0));
        // The position of an object is the mean of its positions in both fields.
        let mut compared = 0;
        for object in &frame.objects {
            let (Some(a), Some(b)) = (find(&before.0.objects, object), find(&after.0.objects, object)) else {
                continue;
            };
            assert_eq!(object.position.x, 0.5 * (a.position.x + b.position.x), "{object:?}");
            assert_eq!(object.position.y, 0.5 * (a.position.y + b.position.y), "{object:?}");
            compared += usize::from(object.kind != ObjectKind::HotPixel);
        }
        assert!(compared > 10, "{compared} objects");
    }
}

/// Electron-weighted mean column of the rows of one parity around an object.
fn mean_column(image: &ExpectedImage, about: &ObjectTruth, parity: usize) -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    for (index, electrons) in image.iter().enumerate() {
        let (x, y) = ((index % COLUMNS) as f64, index / COLUMNS);
        let near = (x - about.position.x).abs() < 14.0 && (y as f64 - about.position.y).abs() < 14.0;
        if near && y % 2 == parity {
            sum += electrons;
            moment += electrons * x;
        }
    }
    moment / sum
}

#[test]
fn even_and_odd_rows_are_displaced_by_rate_times_interval() {
    for (first_field, sign) in [(RowParity::Even, 1.0), (RowParity::Odd, -1.0)] {
        let simulation = interlaced(one_star(), INTERVAL_S, first_field);
        let (exposure, image) = expose(&simulation, 0);
        let truth = &exposure.truth;
        // The boresight rotates at |r × v|/r² about the orbit's normal.
        let rate_rad_s =
            truth.position_km.cross(&truth.velocity_km_s).norm() / truth.position_km.norm_squared();
        let normal = truth.position_km.cross(&truth.velocity_km_s).normalize();
        // Stars move in the opposite sense, −ω × s; the pinhole projection converts this to the motion of the
        // image.
        let [star] = &exposure.objects[..] else { unreachable!("one star was asked for") };
        let seen = |s: &nalgebra::Vector3<f64>| truth.camera_from_icrs.rotate(s);
        let s = seen(star.astrometric.unwrap().vector());
        let motion = -seen(&normal).cross(&s) * rate_rad_s;
        let focal_px = simulation.camera.focal_length_mm * 1000.0 / simulation.camera.pixel_width_um;
        let speed_px_s = focal_px * (motion.x * s.z - s.x * motion.z) / (s.z * s.z);
        let displaced_px = mean_column(&image, star, 1) - mean_column(&image, star, 0);
        assert!(speed_px_s.abs() > 2.4, "{speed_px_s} px/s");
        // The precession of the orbit adds 1e-3 of the rate, 0.005 px; the part of the halo outside the box
        // accounts for 0.003 px.
        let expected_px = sign * speed_px_s * INTERVAL_S;
        assert!((displaced_px - expected_px).abs() < 0.01, "{displaced_px} px, expected {expected_px}");
    }
}

/// The table contains all signal, including that of objects at the edge that are visible in only one field.
#[test]
fn the_electrons_of_the_table_are_those_of_the_image() {
    let mut simulation = interlaced(turning(), INTERVAL_S, RowParity::Even);
    simulation.background.zodiacal = Switch::Off;
    simulation.sensor.background_e_per_s = 0.0;
    simulation.sensor.dark_current_e_per_s = 0.0;
    simulation.sensor.hot_pixels.telegraph = Some(telegraph());
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let (mut in_one_field, mut seen) = (0, 0);
    for frame in 0..8 {
        let objects = camera.expose(frame).unwrap().objects;
        let table: f64 = objects.iter().map(|object| object.electrons).sum();
        let image: f64 = camera.expected().iter().sum();
        // Rounding of sums of about 1e5 numbers.
        assert!((table / image - 1.0).abs() < 1e-10, "frame {frame}: {table} and {image}");
        let stars = objects.iter().filter(|object| object.kind == ObjectKind::Star);
        // Half the displacement is 2.5 px: such a star is on the detector in one field and off it in the
        // other.
        in_one_field += stars.clone().filter(|star| star.position.x.abs() < 2.0).count();
        seen += stars.count();
    }
    assert!(in_one_field > 0 && seen > 100, "{in_one_field} of {seen}");
}

fn telegraph() -> TelegraphConfig {
    TelegraphConfig { fraction: 1.0, low_level: 0.1, high_s: 1.0, low_s: 1.0 }
}

#[test]
fn the_truth_of_the_frame_is_that_of_its_middle() {
    let (progressive, _) = expose(&turning(), 3);
    let (frame, _) = expose(&interlaced(turning(), INTERVAL_S, RowParity::Odd), 3);
    assert_eq!(frame.truth, progressive.truth);
    assert_eq!(frame.telemetry, progressive.telemetry);
    let mut compared = 0;
    for object in &frame.objects {
        // At the edge an object may be visible in only one field.
        let Some(one) = find(&progressive.objects, object) else { continue };
        assert_eq!((object.astrometric, object.magnitude), (one.astrometric, one.magnitude));
        // The path of a star is curved by x²/f² · 5 px, and drift adds seconds of arc.
        assert!(object.position.distance(one.position) < 0.02, "{object:?} and {one:?}");
        compared += usize::from(object.kind == ObjectKind::Star);
    }
    assert!(compared > 10, "{compared} stars");
}

#[test]
fn without_an_interval_the_frame_is_the_progressive_one() {
    for first_field in [RowParity::Even, RowParity::Odd] {
        for simulation in [turning(), restless()] {
            assert_eq!(expose(&interlaced(simulation.clone(), 0.0, first_field), 2), expose(&simulation, 2));
        }
    }
}

#[test]
fn a_still_scene_is_the_progressive_one() {
    let (frame, expected) = expose(&interlaced(still(), 0.02, RowParity::Even), 1);
    let (progressive, light) = expose(&still(), 1);
    for (index, (a, b)) in expected.iter().zip(light.iter()).enumerate() {
        // Stars are stationary to 1e-6 px (aberration); the target, 10 km ahead, moves by about 1e-3 rad/s ·
        // 0.01 s · 2347 px = 0.025 px, and the tolerance is this fraction of its electrons.
        let target = &progressive.objects[0];
        let at = contract::PixelPoint::new((index % COLUMNS) as f64, (index / COLUMNS) as f64);
        let allowed = if at.distance(target.position) < 25.0 { 0.03 * target.electrons } else { 1e-4 * a };
        assert!((a - b).abs() <= allowed, "pixel {index}: {a} and {b}");
    }
    assert_eq!(frame.objects.len(), progressive.objects.len());
}

#[test]
fn an_interlaced_frame_alone_is_that_of_the_run() {
    let simulation = interlaced(restless(), 0.02, RowParity::Even);
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let run: Vec<Exposure> = (0..5).map(|frame| camera.expose(frame).unwrap()).collect();
    for frame in [4, 1, 3] {
        assert_eq!(expose(&simulation, frame).0, run[frame as usize]);
        assert_eq!(camera.expose(frame).unwrap(), run[frame as usize]);
    }
}

/// Each switching hot pixel is evaluated during the exposure of its own field.
#[test]
fn hot_pixels_switch_at_the_moment_of_their_row() {
    let mut simulation = turning();
    simulation.sensor.hot_pixels.count = 400;
    simulation.sensor.hot_pixels.telegraph = Some(telegraph());
    let [before, after] = [-1, 1].map(|seconds| expose(&shifted(simulation.clone(), seconds), 0).0.objects);
    let (frame, _) = expose(&interlaced(simulation, INTERVAL_S, RowParity::Even), 0);
    let mut different = 0;
    for pixel in frame.objects.iter().filter(|object| object.kind == ObjectKind::HotPixel) {
        let is_even = (pixel.id as usize / COLUMNS).is_multiple_of(2);
        let (own, other) = if is_even { (&before, &after) } else { (&after, &before) };
        let (own, other) = (find(own, pixel).unwrap(), find(other, pixel).unwrap());
        // Time since J2000 is accurate to 6e-8 s, compared with an exposure of 0.25 s.
        assert!((pixel.electrons / own.electrons - 1.0).abs() < 1e-5, "{pixel:?} and {own:?}");
        different += usize::from((pixel.electrons / other.electrons - 1.0).abs() > 1e-2);
    }
    assert!(different > 100, "{different}");
}
