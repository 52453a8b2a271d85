//! The target as a body of plates, in whole frames: position and amount of its signal, and its truth.

use boresight_sim::scene::TargetConfig;
use boresight_sim::truth::{ObjectKind, ObjectTruth, TargetAttitudeConfig};
use boresight_sim::{Exposure, Simulation};

use crate::small_scene::{orbit_of, simulator, still};

/// The scenario fragment from the documentation.
fn tango() -> TargetConfig {
    #[derive(serde::Deserialize)]
    struct Fragment {
        target: TargetConfig,
    }
    let fragment: Fragment = toml::from_str(include_str!("../../../examples/tango.toml")).unwrap();
    fragment.target
}

/// The mesh of the scenario fragment from the documentation, whose paths start from `scenarios/`.
fn smallsat() -> TargetConfig {
    #[derive(serde::Deserialize)]
    struct Fragment {
        target: TargetConfig,
    }
    let fragment: Fragment = toml::from_str(include_str!("../../../examples/smallsat.toml")).unwrap();
    let mut target = fragment.target;
    for (_, path) in target.paths() {
        *path = format!("{}/../scenarios/{path}", env!("CARGO_MANIFEST_DIR"));
    }
    target
}

/// TANGO at `range_m` ahead, as the only object in the sky.
fn ahead(range_m: f64, target: TargetConfig) -> Simulation {
    let mut simulation = still();
    let scale = range_m / 10_000.0;
    orbit_of(&mut simulation).relative.a_dlambda_m *= scale;
    orbit_of(&mut simulation).relative.a_dey_m *= scale;
    orbit_of(&mut simulation).relative.a_diy_m *= scale;
    simulation.catalog.magnitude_limit = Some(-2.0);
    simulation.sensor.hot_pixels.count = 0;
    simulation.target = target;
    simulation
}

fn one(simulation: &Simulation, frame: u64) -> Exposure {
    simulator(simulation).camera().unwrap().expose(frame).unwrap()
}

fn target(exposure: &Exposure) -> &ObjectTruth {
    exposure.objects.iter().find(|object| object.kind == ObjectKind::Target).unwrap()
}

#[test]
fn the_fragments_of_the_documentation_are_targets() {
    tango().check().unwrap();
    smallsat().check().unwrap();
}

#[test]
fn a_resolved_body_has_the_flux_of_its_magnitude_in_the_image_and_in_the_table() {
    // TANGO spans 30 px, 6 px, 0.2 px and 0.06 px, the mesh five times as many.
    let ranges_m = [60.0, 300.0, 9_000.0, 30_000.0];
    for (range_m, body) in
        ranges_m.into_iter().flat_map(|range_m| [(range_m, tango()), (5.0 * range_m, smallsat())])
    {
        let simulation = ahead(range_m, body);
        let simulator = simulator(&simulation);
        let mut camera = simulator.camera().unwrap();
        let exposure = camera.expose(0).unwrap();
        let target = target(&exposure);
        let expected = 1.5e6 * libm::pow(10.0, -0.4 * target.magnitude.unwrap()) * 0.25;
        // Loss at the floor of the stamp: slightly more than 2π · 16 px² · 0.01 electrons.
        assert!((target.electrons - expected).abs() < 2.0 + 1e-9 * expected, "at {range_m} m");
        let (mut sum, mut x, mut y) = (0.0, 0.0, 0.0);
        for (index, electrons) in camera.expected().signal().into_iter().enumerate() {
            sum += electrons;
            x += electrons * (index % 160) as f64;
            y += electrons * (index / 160) as f64;
        }
        assert!((sum / target.electrons - 1.0).abs() < 1e-9);
        let away = libm::hypot(x / sum - target.position.x, y / sum - target.position.y);
        // The S-curve of pixel sampling at a width of 0.8 px, and the loss at the floor.
        assert!(away < 1e-3, "{away} px at {range_m} m");
    }
}

#[test]
fn the_offset_of_the_centre_of_brightness_is_inverse_to_the_range() {
    let offset = |range_m: f64| {
        let exposure = one(&ahead(range_m, tango()), 0);
        let turn = exposure.truth.target_from_icrs;
        assert!(turn.is_some(), "the attitude is told");
        target(&exposure).position.distance(exposure.truth.target_position.unwrap())
    };
    let (near, far) = (offset(100.0), offset(1_000.0));
    // For a body of 0.4 m at 2350 px per radian: some pixels at 100 m. Perspective changes the offset by 1 %.
    assert!((0.5..10.0).contains(&near), "{near}");
    assert!((near / far / 10.0 - 1.0).abs() < 0.05, "{near} {far}");
}

#[test]
fn a_tumbling_body_has_its_period_in_the_light_curve() {
    let TargetConfig::Plates { boxes, plates, .. } = tango() else { panic!("a body of plates") };
    // One rotation in 8 frames; frames are 0.25 s apart.
    let attitude = TargetAttitudeConfig::Tumbling {
        phi_deg: 0.0,
        theta_deg: 0.0,
        psi_deg: 0.0,
        axis: [1.0, 2.0, 0.5],
        rate_deg_per_s: 180.0,
    };
    let simulation = ahead(2_000.0, TargetConfig::Plates { attitude, boxes, plates });
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let mut light = |frame: u64| {
        let exposure = camera.expose(frame).unwrap();
        exposure.objects.iter().find(|o| o.kind == ObjectKind::Target).map_or(0.0, |o| o.electrons)
    };
    let curve: Vec<f64> = (0..24).map(&mut light).collect();
    let brightest = curve.iter().copied().fold(0.0, f64::max);
    let faintest = curve.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(brightest > 1.5 * faintest + 100.0, "{curve:?}");
    for (i, electrons) in curve[..16].iter().enumerate() {
        // In 2 s the directions to the Sun and to the chaser, as seen from the target, change by 0.12°: a few
        // per cent of a glint.
        assert!((curve[i + 8] - electrons).abs() < 0.05 * brightest, "frame {i}: {curve:?}");
    }
    assert!((0..16).any(|i| (curve[i + 4] - curve[i]).abs() > 0.2 * brightest), "no shorter period");
}
