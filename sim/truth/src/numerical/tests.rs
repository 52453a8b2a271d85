use super::*;
use crate::clock::parse_utc;
use crate::manoeuvre::{ManoeuvreAxes, ManoeuvreConfig};
use crate::orbit::Elements;
use crate::states::{OrbitConfig, burns};

fn orbit() -> OrbitConfig {
    toml::from_str(include_str!("../../tests/it/eclipsed_orbit.toml")).unwrap()
}

fn initial(orbit: &OrbitConfig) -> InitialStates {
    let (epoch, chaser, target) = orbit.initial_elements().unwrap();
    let at_epoch = |elements: Elements, path| InitialState { time_s: 0.0, state: elements.state(), path };
    InitialStates {
        epoch,
        epoch_path: "orbit.epoch_utc",
        chaser: at_epoch(chaser, "orbit.relative"),
        target: at_epoch(target, "orbit.target"),
    }
}

fn all_forces() -> NumericalConfig {
    NumericalConfig {
        drag: Some(DragConfig { chaser_m2_kg: 0.02, target_m2_kg: 0.025, exponent: 6.0 }),
        radiation: Some(RadiationConfig { chaser_m2_kg: 0.02, target_m2_kg: 0.03 }),
        ..NumericalConfig::default()
    }
}

/// Integration without the cache.
fn integrated(orbit: &OrbitConfig, config: &NumericalConfig, days: f64) -> NumericalStates {
    let epoch = parse_utc(&orbit.epoch_utc).unwrap();
    let burns = burns(orbit, &orbit.manoeuvres, epoch).unwrap();
    NumericalStates::integrate(&initial(orbit), config, &burns, [-MARGIN_S, days * 86_400.0]).unwrap()
}

fn largest_difference_m(a: &NumericalStates, b: &NumericalStates, days: f64) -> (f64, f64) {
    let (mut absolute, mut relative) = (0.0_f64, 0.0_f64);
    for k in 0..=1000 {
        let time_s = days * 86.4 * f64::from(k);
        let (a, b) = (a.states_at(time_s), b.states_at(time_s));
        absolute = absolute.max((a.target.position_km - b.target.position_km).norm() * 1e3);
        relative = relative.max((a.chaser_rtn_km() - b.chaser_rtn_km()).norm() * 1e3);
    }
    (absolute, relative)
}

#[test]
fn half_the_step_changes_positions_by_less_than_a_millimetre_in_five_days() {
    let config = all_forces();
    let half = NumericalConfig { step_s: 22.5, ..config.clone() };
    let a = integrated(&orbit(), &config, 5.0);
    let b = integrated(&orbit(), &half, 5.0);
    let (absolute_m, relative_m) = largest_difference_m(&a, &b, 5.0);
    assert!(absolute_m < 1e-3 && relative_m < 1e-3, "{absolute_m} {relative_m}");
}

#[test]
fn a_state_is_the_same_bits_in_a_shorter_run() {
    let (short, long) = (integrated(&orbit(), &all_forces(), 0.2), integrated(&orbit(), &all_forces(), 0.5));
    for k in 0..200 {
        let time_s = -1000.0 + 90.7 * f64::from(k);
        if time_s < 0.2 * 86_400.0 {
            assert_eq!(short.states_at(time_s), long.states_at(time_s), "{time_s}");
        }
    }
}

#[test]
fn the_cache_returns_the_same_orbits() {
    let (initial, config) = (initial(&orbit()), NumericalConfig::default());
    let get = || NumericalStates::compute(&initial, &config, vec![], [initial.epoch; 2]).unwrap();
    assert!(std::sync::Arc::ptr_eq(&get(), &get()));
}

/// Between the knots position and velocity belong together, and the acceleration is that of the forces.
#[test]
fn the_velocity_is_the_derivative_of_the_position() {
    let states = integrated(&orbit(), &all_forces(), 0.2);
    for k in 0..300 {
        let time_s = 31.7 * f64::from(k);
        let at = |offset_s: f64| states.states_at(time_s + offset_s).target;
        let slope = (at(0.5).position_km - at(-0.5).position_km) / 1.0;
        // The difference quotient has an error of ω² v h²/24 = 3e-7 of 1e-6 km/s, and the polynomial 1e-9
        // km/s.
        let error = (slope - at(0.0).velocity_km_s).norm();
        assert!(error < 1e-6, "{time_s}: {error}");
    }
}

/// Closed form: without forces other than the point mass the orbit is Keplerian and returns.
#[test]
fn a_point_mass_gives_the_ellipse_of_kepler() {
    let config = NumericalConfig {
        gravity: GravityConfig { degree: 0, order: 0 },
        sun: Switch::Off,
        moon: Switch::Off,
        ..NumericalConfig::default()
    };
    let states = integrated(&orbit(), &config, 5.0);
    let (_, _, target) = orbit().initial_elements().unwrap();
    for k in 0..100 {
        let time_s = 4_321.0 * f64::from(k);
        let mean_anomaly_rad = target.mean_anomaly_rad + target.mean_motion_rad_s() * time_s;
        let expected = Elements { mean_anomaly_rad, ..target }.state();
        let error_m = (states.states_at(time_s).target.position_km - expected.position_km).norm() * 1e3;
        // The mean anomaly of 460 rad has a rounding of 6e-14 rad, 0.4 µm; the steps contribute the rest.
        assert!(error_m < 1e-3, "{time_s}: {error_m}");
    }
}

fn with_manoeuvre(duration_s: f64) -> OrbitConfig {
    let manoeuvre = ManoeuvreConfig {
        time_utc: "2012-04-23T02:00:00Z".into(),
        dv_rtn_m_s: [0.0, 0.02, 0.01],
        duration_s,
    };
    OrbitConfig { manoeuvres: vec![manoeuvre], ..orbit() }
}

#[test]
fn a_finite_burn_acts_like_an_impulse_at_its_middle() {
    let config = NumericalConfig::default();
    let none = integrated(&orbit(), &config, 0.3);
    let impulse = integrated(&with_manoeuvre(0.0), &config, 0.3);
    let burn = integrated(&with_manoeuvre(60.0), &config, 0.3);
    let jump = |states: &NumericalStates, before_s: f64, after_s: f64| {
        let at = |time_s| {
            states.states_at(time_s).chaser.velocity_km_s - none.states_at(time_s).chaser.velocity_km_s
        };
        (at(after_s) - at(before_s)).norm() * 1e3
    };
    let size = libm::hypot(0.02, 0.01);
    assert!((jump(&impulse, 7_199.999, 7_200.0) - size).abs() < 1e-8);
    // During a minute gravity turns the difference by (ω t)²/2 = 2e-3 of it.
    assert!((jump(&burn, 7_169.9, 7_230.1) / size - 1.0).abs() < 5e-3);
    assert!((jump(&burn, 7_169.9, 7_200.0) / size - 0.5).abs() < 5e-3);
    let after_s = 20_000.0;
    let effect_m = |states: &NumericalStates| {
        (states.states_at(after_s).chaser.position_km - none.states_at(after_s).chaser.position_km) * 1e3
    };
    // Second order in the duration: (ω 60 s)²/24 = 2e-4 of the effect.
    let (a, b) = (effect_m(&impulse), effect_m(&burn));
    assert!(a.norm() > 400.0 && (a - b).norm() < 5e-4 * a.norm(), "{a} {b}");
    // The target does not feel the chaser's manoeuvres.
    assert_eq!(impulse.states_at(after_s).target, none.states_at(after_s).target);
    assert_eq!(burn.target, none.target);
}

/// The states of an orbit at two later instants, one for each spacecraft, lead to the same orbits.
#[test]
fn orbits_continue_from_states_at_different_times() {
    let config = all_forces();
    let whole = integrated(&orbit(), &config, 0.4);
    let (chaser_s, target_s) = (9_000.0, 12_345.678);
    let from = initial(&orbit());
    let initial = InitialStates {
        chaser: InitialState { time_s: chaser_s, state: whole.states_at(chaser_s).chaser, ..from.chaser },
        target: InitialState { time_s: target_s, state: whole.states_at(target_s).target, ..from.target },
        ..from
    };
    let span_s = [-MARGIN_S, 0.4 * 86_400.0];
    let continued = NumericalStates::integrate(&initial, &config, &[], span_s).unwrap();
    let (absolute_m, relative_m) = largest_difference_m(&whole, &continued, 0.4);
    // Steps at other times; the interpolated states are within 1e-5 m and, in velocity, 1e-6 m/s.
    assert!(absolute_m < 2e-3 && relative_m < 2e-3, "{absolute_m} {relative_m}");
}

/// T is along the velocity and W along N, so that an impulse along T, N or W equals one along known R, T, N.
#[test]
fn impulses_along_celestial_axes_and_tnw_are_those_along_rtn() {
    let config = NumericalConfig::default();
    let rtn = Vector3::new(0.003, 0.02, 0.01);
    let start_s = 7_200.0;
    let before = integrated(&orbit(), &config, 0.3).states_at(start_s).chaser;
    let icrs = before.rtn_from_icrs().inverse().rotate(&rtn);
    let along = before.velocity_km_s.normalize();
    let normal = before.position_km.cross(&before.velocity_km_s).normalize();
    // N completes T, W: in the orbital plane, away from the Earth's centre on a circular orbit.
    let in_plane = along.cross(&normal);
    assert!(in_plane.dot(&before.position_km) > 0.0);
    let tnw = Vector3::new(icrs.dot(&along), icrs.dot(&in_plane), icrs.dot(&normal));
    let after = |axes, dv_m_s: Vector3<f64>| {
        let burn = Burn { start_s, duration_s: 0.0, axes, dv_km_s: dv_m_s * 1e-3 };
        let span_s = [-MARGIN_S, 0.3 * 86_400.0];
        let states = NumericalStates::integrate(&initial(&orbit()), &config, &[burn], span_s).unwrap();
        states.states_at(start_s).chaser.velocity_km_s - before.velocity_km_s
    };
    let expected = icrs * 1e-3;
    for (axes, dv) in [(ManoeuvreAxes::Rtn, rtn), (ManoeuvreAxes::Icrs, icrs), (ManoeuvreAxes::Tnw, tnw)] {
        assert!((after(axes, dv) - expected).norm() < 1e-14, "{axes:?}");
    }
}

#[test]
fn bad_values_are_refused_by_name() {
    let refusal = |config: NumericalConfig| config.check("trajectory").unwrap_err().to_string();
    let base = NumericalConfig::default;
    assert!(refusal(NumericalConfig { step_s: 0.0, ..base() }).contains("trajectory.step_s"));
    let gravity = GravityConfig { degree: 4, order: 5 };
    assert!(refusal(NumericalConfig { gravity, ..base() }).contains("trajectory.gravity.order is 5"));
    let gravity = GravityConfig { degree: 37, order: 5 };
    assert!(refusal(NumericalConfig { gravity, ..base() }).contains("trajectory.gravity.degree"));
    let drag = DragConfig { chaser_m2_kg: f64::NAN, target_m2_kg: 0.0, exponent: 6.0 };
    assert!(refusal(NumericalConfig { drag: Some(drag), ..base() }).contains("trajectory.drag.chaser_m2_kg"));

    let mut low = orbit();
    low.target.semi_major_axis_km = 6_550.0;
    let drag = DragConfig { chaser_m2_kg: 0.0, target_m2_kg: 10.0, exponent: 6.0 };
    let epoch = parse_utc(&low.epoch_utc).unwrap();
    let compute = |orbit: &OrbitConfig, config: NumericalConfig, days: f64| {
        let last = epoch + hifitime::Duration::from_seconds(days * 86_400.0);
        let ends = [epoch.min(last), epoch.max(last)];
        NumericalStates::compute(&initial(orbit), &config, vec![], ends).unwrap_err().to_string()
    };
    let falling = NumericalConfig { drag: Some(drag), ..base() };
    let message = compute(&low, falling.clone(), 5.0);
    assert!(message.contains("orbit.target") && message.contains(" s after the epoch"), "{message}");
    // An ellipse whose perigee is before the epoch: it is integrated backwards.
    let mut low = orbit();
    (low.target.semi_major_axis_km, low.target.eccentricity) = (6_900.0, 0.061);
    let message = compute(&low, base(), -0.2);
    assert!(message.contains("below 100 km ") && message.contains(" s before the epoch"), "{message}");
    assert!(compute(&orbit(), base(), 101.0).contains("within 100 days"));
}
