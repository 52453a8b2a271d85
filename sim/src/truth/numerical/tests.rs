use super::*;
use crate::truth::RelativeElements;
use crate::truth::clock::parse_utc;
use crate::truth::manoeuvre::ManoeuvreConfig;
use crate::truth::orbit::ElementsConfig;
use crate::truth::states::burns;

/// ARGON's orbit with an eclipse in each revolution.
fn orbit() -> OrbitConfig {
    OrbitConfig {
        epoch_utc: "2012-04-23T00:00:00Z".into(),
        target: ElementsConfig {
            semi_major_axis_km: 7130.0,
            eccentricity: 0.003,
            inclination_deg: 98.28,
            raan_deg: 40.0,
            argument_of_perigee_deg: 90.0,
            mean_anomaly_deg: 270.0,
        },
        relative: RelativeElements {
            a_dlambda_m: -10_000.0,
            a_dey_m: 400.0,
            a_diy_m: 300.0,
            ..Default::default()
        },
        manoeuvres: vec![],
        execution: None,
        reports: None,
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
    let burns = burns(&orbit.manoeuvres, epoch).unwrap();
    NumericalStates::integrate(orbit, config, &burns, [-MARGIN_S, days * 86_400.0]).unwrap()
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
    let (orbit, config) = (orbit(), NumericalConfig::default());
    let epoch = parse_utc(&orbit.epoch_utc).unwrap();
    let get = || NumericalStates::compute(&orbit, &config, vec![], [epoch; 2]).unwrap();
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
        let expected = crate::truth::Elements { mean_anomaly_rad, ..target }.state();
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

#[test]
fn bad_values_are_refused_by_name() {
    let refusal = |config: NumericalConfig| config.check().unwrap_err().to_string();
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
        NumericalStates::compute(orbit, &config, vec![], [epoch, last]).unwrap_err().to_string()
    };
    let message = compute(&low, NumericalConfig { drag: Some(drag), ..base() }, 5.0);
    assert!(message.contains("orbit.target") && message.contains("below 100 km"), "{message}");
    assert!(compute(&orbit(), base(), 101.0).contains("within 100 days"));
}
