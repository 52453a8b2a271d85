//! Numerical trajectories compared with Orekit: each force alone and all together, over five days.

use std::fs;

use boresight_truth::Switch;
use boresight_truth::{
    DragConfig, GravityConfig, GroupConfig, NumericalConfig, OrbitConfig, RadiationConfig, Schedule,
    Trajectory, TrajectorySource,
};
use nalgebra::Vector3;

/// The orbits of golden/orbits/make.py.
fn orbit() -> OrbitConfig {
    toml::from_str(include_str!("eclipsed_orbit.toml")).unwrap()
}

/// The forces of a case of golden/orbits/make.py.
fn forces(case: &str) -> NumericalConfig {
    let every = case == "all";
    let on = |name| if every || case == name { Switch::On } else { Switch::Off };
    let degree = match case {
        "gravity" => 36,
        "all" => 20,
        _ => 0,
    };
    NumericalConfig {
        gravity: GravityConfig { degree, order: degree },
        sun: on("sun"),
        moon: on("moon"),
        drag: (on("drag") == Switch::On).then_some(DragConfig {
            chaser_m2_kg: 0.02,
            target_m2_kg: 0.025,
            exponent: 6.0,
        }),
        radiation: (on("radiation") == Switch::On)
            .then_some(RadiationConfig { chaser_m2_kg: 0.02, target_m2_kg: 0.03 }),
        ..NumericalConfig::default()
    }
}

#[test]
fn each_force_moves_the_spacecraft_as_orekit_has_it() {
    let path = format!("{}/../../golden/orbits/orbits.csv", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).unwrap();
    let five_days = GroupConfig {
        name: "five days".into(),
        start_utc: "2012-04-23T00:00:00Z".into(),
        cadence_s: 432_000.0,
        count: 2,
    };
    let schedule = Schedule::new(&[five_days]).unwrap();
    let mut failures = Vec::new();
    for case in ["point_mass", "gravity", "sun", "moon", "drag", "radiation", "all"] {
        let source = TrajectorySource::Numerical(orbit(), forces(case));
        let trajectory = Trajectory::from_source(&source, 1, &schedule).unwrap();
        let (mut rows, mut absolute_m, mut relative_m) = (0, 0.0_f64, Vector3::zeros());
        for line in text.lines().filter(|line| line.split(',').next() == Some(case)) {
            let numbers: Vec<f64> = line.split(',').skip(1).map(|number| number.parse().unwrap()).collect();
            let states = trajectory.states_at_seconds(numbers[0]);
            let target_m = Vector3::new(numbers[1], numbers[2], numbers[3]);
            let chaser_m = Vector3::new(numbers[4], numbers[5], numbers[6]);
            let target_error = states.target.position_km * 1e3 - target_m;
            let chaser_error = states.chaser.position_km * 1e3 - chaser_m;
            absolute_m = absolute_m.max(target_error.norm()).max(chaser_error.norm());
            let rtn = states.target.rtn_from_icrs();
            relative_m = rtn.rotate(&(chaser_error - target_error)).abs().sup(&relative_m);
            rows += 1;
        }
        assert_eq!(rows, 21, "{case}");
        println!("{case}: {absolute_m:.5} m; relative R, T, N {:.5?} m", relative_m.as_slice());
        if absolute_m > 1.0 || relative_m.max() > 0.01 {
            failures.push(format!("{case}: {absolute_m} m, relative {relative_m:?} m"));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}
