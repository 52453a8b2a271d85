//! The target, lit or not, hides the stars behind it, and a camera inside the target is rejected. Other
//! impossible flights are rejected too.

use std::path::Path;

use boresight_sim::onboard::ShutterConfig;
use boresight_sim::scene::TargetConfig;
use boresight_sim::truth::{ObjectKind, ObjectTruth};
use boresight_sim::{Exposure, SimError, Simulation, Simulator};
use contract::PixelPoint;

use crate::small_scene::{START_UTC, orbit_of, simulator, still};

fn first(simulation: &Simulation) -> Exposure {
    simulator(simulation).camera().unwrap().expose(0).unwrap()
}

fn with(target: TargetConfig) -> Simulation {
    Simulation { target, ..still() }
}

/// A point target with almost no flux, which hides nothing.
const POINT: TargetConfig = TargetConfig::Beacon { magnitude_at_1_km: 30.0 };

/// A black sphere: hidden stars are thereby distinguished from outshone stars.
fn black_sphere(radius_m: f64) -> TargetConfig {
    TargetConfig::LambertSphere { radius_m, albedo: 0.0 }
}

/// A black box of 200 m around the origin.
fn black_box() -> TargetConfig {
    let surface = "{ diffuse = 0.0 }";
    toml::from_str(&format!(
        "kind = \"plates\"\nattitude = {{ mode = \"inertial\" }}\n\
         boxes = [{{ size_m = [200.0, 200.0, 200.0], surface = {surface} }}]"
    ))
    .unwrap()
}

fn stars(exposure: &Exposure) -> Vec<ObjectTruth> {
    exposure.objects.iter().filter(|object| object.kind == ObjectKind::Star).cloned().collect()
}

#[test]
fn stars_are_seen_beside_it_and_none_behind_it() {
    let seen = first(&with(POINT));
    let centre: PixelPoint = seen.truth.target_position.unwrap();
    let hidden = first(&with(black_sphere(100.0)));
    // A radius of 100 m at this range, in columns of 8.6 µm and rows of 8.3 µm.
    let sine = 0.1 / seen.truth.range_km;
    let (across_px, along_px) = (20.187 / 0.0086 * sine, 20.187 / 0.0083 * sine);
    let left = stars(&hidden);
    let (mut behind, mut beside) = (0, 0);
    for star in stars(&seen) {
        let (x, y) = (star.position.x - centre.x, star.position.y - centre.y);
        let radius = libm::hypot(x / across_px, y / along_px);
        if radius < 0.97 {
            assert!(left.iter().all(|other| other.id != star.id), "star {} shines through", star.id);
            behind += 1;
        } else if radius > 1.03 {
            assert!(left.contains(&star), "star {} is hidden", star.id);
            beside += 1;
        }
    }
    assert!(behind >= 2 && beside > 10, "{behind} behind, {beside} beside");
    // The shape does not matter: the box contains the sphere.
    let boxed = stars(&first(&with(black_box())));
    assert!(boxed.len() < left.len() + 1 && boxed.iter().all(|star| left.contains(star)), "{boxed:?}");
    assert!(boxed.len() > 5);
}

#[test]
fn the_shutter_does_not_follow_a_star_that_is_hidden() {
    let shutter = ShutterConfig::Automatic {
        min_s: 1e-6,
        max_s: 0.25,
        target_level: 1e-4,
        step_factor: 1.1,
        lag_s: 0.0,
    };
    let exposure_s = |target: TargetConfig| {
        first(&Simulation { shutter: shutter.clone(), ..with(target) }).truth.exposure_s
    };
    assert!(exposure_s(POINT) < 0.2);
    // The sphere covers the whole field.
    assert_eq!(exposure_s(black_sphere(1000.0)), 0.25);
}

fn refusal(simulation: &Simulation) -> String {
    match Simulator::new(simulation, Path::new("")) {
        Err(SimError::OutOfRange(error)) => error.to_string(),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("nothing was refused"),
    }
}

#[test]
fn no_camera_is_inside_of_it_in_any_frame() {
    // The chaser drifts past below the target, 500 m from the target's centre in the middle, 1.1 km and more
    // at both ends.
    let mut simulation = still();
    orbit_of(&mut simulation).epoch_utc = START_UTC.into();
    let relative = &mut orbit_of(&mut simulation).relative;
    (relative.a_da_m, relative.a_dlambda_m, relative.a_dey_m, relative.a_diy_m) = (-500.0, -1000.0, 0.0, 0.0);
    (simulation.schedule[0].cadence_s, simulation.schedule[0].count) = (60.0, 60);
    simulation.target = black_sphere(450.0);
    simulator(&simulation);
    simulation.target = black_sphere(600.0);
    let message = refusal(&simulation);
    assert!(
        message.starts_with("orbit.relative is 5") && message.contains("m from the target's centre"),
        "{message}"
    );
    assert!(message.ends_with("expected a camera outside the target"), "{message}");
    simulation.target = black_box();
    simulator(&simulation);
    let relative = &mut orbit_of(&mut simulation).relative;
    (relative.a_da_m, relative.a_dlambda_m) = (-50.0, -140.0);
    assert!(refusal(&simulation).contains("outside the target"));
}

#[test]
fn exposures_hits_and_epochs_that_cannot_be_are_refused() {
    let mut simulation = still();
    simulation.shutter = ShutterConfig::Fixed { exposure_s: 0.26 };
    let message = refusal(&simulation);
    assert!(
        message.contains("shutter.exposure_s is 0.26") && message.contains("0.25 s (schedule)"),
        "{message}"
    );
    // A single frame may last for any time; two groups are separated by less than their cadence.
    simulation.schedule[0].count = 1;
    simulator(&simulation);
    let mut second = simulation.schedule[0].clone();
    (second.name, second.start_utc) = ("second".into(), "2012-04-25T12:00:00.2Z".into());
    simulation.schedule.push(second);
    assert!(refusal(&simulation).contains("0.2 s (schedule)"));

    let mut simulation = still();
    simulation.sensor.cosmic_rays = Some(crate::small_scene::cosmic_rays(1e4));
    simulator(&simulation);
    simulation.sensor.cosmic_rays.as_mut().unwrap().readout_s = 1000.0;
    let message = refusal(&simulation);
    assert!(message.contains("sensor.cosmic_rays.rate_per_cm2_s is 10000 (1.371e5 hits"), "{message}");
    assert!(message.contains("expected at most 1e5 hits per frame"), "{message}");

    for epoch in ["1989-12-31T00:00:00Z", "2051-01-01T00:00:00Z"] {
        let mut simulation = still();
        orbit_of(&mut simulation).epoch_utc = epoch.into();
        let message = refusal(&simulation);
        assert!(message.contains(epoch) && message.contains("from 1990-01-01 to 2050-01-05"), "{message}");
    }
}

/// In the truth table, stars brighter than the limit have at least the requested signal-to-noise ratio;
/// fainter stars have less.
#[test]
fn the_limiting_magnitude_is_that_of_the_truth_table() {
    let simulation = with(POINT);
    let limit = simulator(&simulation).limiting_magnitude(0.25, 5.0).unwrap();
    let stars = stars(&first(&simulation));
    let inside = |star: &&ObjectTruth| {
        (8.0..152.0).contains(&star.position.x) && (8.0..112.0).contains(&star.position.y)
    };
    let (mut brighter, mut fainter) = (0, 0);
    for star in stars.iter().filter(inside) {
        // The position of a star within its pixel, and its trail, account for a quarter of a magnitude.
        let magnitude = star.magnitude.unwrap();
        if magnitude < limit - 0.3 {
            assert!(star.snr > 5.0, "{magnitude} of {limit}: {}", star.snr);
            brighter += 1;
        } else if magnitude > limit + 0.3 {
            assert!(star.snr < 5.0, "{magnitude} of {limit}: {}", star.snr);
            fainter += 1;
        }
    }
    assert!(brighter > 2 && fainter > 2, "{limit}: {brighter}, {fainter}");
    assert_eq!(simulator(&simulation).limiting_magnitude(0.0, 5.0), None);
}
