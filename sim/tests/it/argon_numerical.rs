//! Approach planned for the scenario `argon-numerical`, as the numerical truth flies it.

use boresight_sim::truth::{
    GroupConfig, NumericalConfig, OrbitConfig, Schedule, Trajectory, TrajectorySource,
};
use hifitime::Duration;
use serde::Deserialize;

#[derive(Deserialize)]
struct Fragment {
    seed: u64,
    orbit: OrbitConfig,
    trajectory: toml::Table,
    schedule: Vec<GroupConfig>,
}

fn fragment() -> (Fragment, TrajectorySource, Schedule) {
    let mut fragment: Fragment =
        toml::from_str(include_str!("../../../scenarios/argon-numerical.toml")).unwrap();
    assert_eq!(fragment.trajectory.remove("kind").unwrap().as_str(), Some("numerical"));
    let forces: NumericalConfig = fragment.trajectory.clone().try_into().unwrap();
    let schedule = Schedule::new(&fragment.schedule).unwrap();
    let source = TrajectorySource::Numerical(fragment.orbit.clone(), forces);
    (fragment, source, schedule)
}

fn trajectory() -> (Trajectory, Schedule) {
    let (fragment, source, schedule) = fragment();
    let trajectory = Trajectory::from_source(&source, fragment.seed, &schedule).unwrap();
    (trajectory, schedule)
}

/// From 30 km to 3 km; the separation across the flight direction keeps the size of the relative ellipse.
#[test]
fn the_chaser_follows_the_waypoints_on_a_relative_ellipse() {
    let (trajectory, _) = trajectory();
    let period_s = 5_980.0;
    for (hours, along_m, eccentricity_m) in [
        (6.0, -30_000.0, 400.0),
        (23.0, -27_000.0, 385.0),
        (47.0, -20_000.0, 350.0),
        (69.0, -13_600.0, 310.0),
        (95.0, -7_000.0, 265.0),
        (118.0, -3_200.0, 225.0),
    ] {
        let rows: Vec<_> = (0..100)
            .map(|k| trajectory.states_at_seconds(hours * 3600.0 + period_s * f64::from(k) / 100.0))
            .map(|states| states.chaser_rtn_km() * 1000.0)
            .collect();
        let mean_m = rows.iter().map(|rtn| rtn.y).sum::<f64>() / 100.0;
        // The revolution lies up to an hour and a half beside the waypoint, at 300 m an hour.
        assert!((mean_m - along_m).abs() < 700.0, "{hours} h: {mean_m}");
        let radial_m = rows.iter().map(|rtn| rtn.x).fold(f64::NEG_INFINITY, f64::max)
            - rows.iter().map(|rtn| rtn.x).fold(f64::INFINITY, f64::min);
        // R swings by aδe to both sides; δe turns with the perigee, which adds up to 10 % in the end.
        assert!((radial_m / (2.0 * eccentricity_m) - 1.0).abs() < 0.2, "{hours} h: {radial_m}");
        let across_m = rows.iter().map(|rtn| libm::hypot(rtn.x, rtn.z)).fold(f64::INFINITY, f64::min);
        assert!(across_m > 0.5 * eccentricity_m, "{hours} h: {across_m}");
    }
}

/// The field of ±6.8° by ±9.1° is centred on T: see argon_plan.rs.
#[test]
fn the_target_is_in_the_field_of_view_in_every_frame() {
    let (trajectory, schedule) = trajectory();
    for frame in (0..schedule.frame_count()).step_by(7) {
        let (_, time) = schedule.frame(frame).unwrap();
        let states = trajectory.states_at(time);
        let seen = states.chaser.rtn_from_icrs().rotate(&states.line_of_sight_km());
        let angles = [seen.x, seen.z].map(|x| libm::atan2(x, seen.y).to_degrees().abs());
        assert!(angles[0] < 9.1 && angles[1] < 6.8, "frame {frame}: {angles:?}");
    }
}

/// Frame N alone: the trajectory of a schedule that ends with it has the same states.
#[test]
fn a_frame_alone_has_the_states_of_the_run() {
    let (fragment, source, _) = fragment();
    let (run, schedule) = trajectory();
    let first_day = Schedule::new(&fragment.schedule[..1]).unwrap();
    let alone = Trajectory::from_source(&source, fragment.seed, &first_day).unwrap();
    for frame in [0, 700, 1633] {
        let (_, time) = schedule.frame(frame).unwrap();
        assert_eq!(alone.states_at(time), run.states_at(time));
    }
}

#[test]
fn reports_are_late_and_differ_from_the_executed_manoeuvres() {
    let (fragment, ..) = fragment();
    let executed = fragment.orbit.executed_manoeuvres(fragment.seed);
    let (trajectory, _) = trajectory();
    assert_eq!(trajectory.manoeuvres().len(), fragment.orbit.manoeuvres.len());
    for ((planned, executed), manoeuvre) in
        fragment.orbit.manoeuvres.iter().zip(&executed).zip(trajectory.manoeuvres())
    {
        assert_eq!(manoeuvre.planned_dv_rtn_m_s, planned.dv_rtn_m_s);
        assert_eq!(manoeuvre.executed_dv_rtn_m_s, executed.dv_rtn_m_s);
        let report = manoeuvre.report;
        assert_eq!(report.reported - report.time, Duration::from_seconds(605.0));
        let [begin, end] = manoeuvre.ends();
        assert_eq!(
            (end - begin, end + Duration::from_seconds(600.0)),
            (Duration::from_seconds(10.0), report.reported)
        );
        let norm = |dv: [f64; 3]| (dv[0] * dv[0] + dv[1] * dv[1] + dv[2] * dv[2]).sqrt();
        let sizes = [planned.dv_rtn_m_s, executed.dv_rtn_m_s, report.dv_rtn_m_s].map(norm);
        // Five standard deviations of 1 % and 2 %.
        assert!(sizes[0] != sizes[1] && (sizes[1] / sizes[0] - 1.0).abs() < 0.05, "{sizes:?}");
        assert!(sizes[1] != sizes[2] && (sizes[2] / sizes[1] - 1.0).abs() < 0.10, "{sizes:?}");
    }
    // Another seed, other errors.
    assert_ne!(executed, fragment.orbit.executed_manoeuvres(fragment.seed + 1));
}

/// The limit of ±100 m/s is that of the planned manoeuvre: the drawn error may exceed it.
#[test]
fn a_manoeuvre_at_the_limit_is_flown_with_the_errors_of_any_seed() {
    let (fragment, _, schedule) = fragment();
    let mut orbit = fragment.orbit;
    orbit.manoeuvres.truncate(1);
    (orbit.manoeuvres[0].duration_s, orbit.manoeuvres[0].dv_rtn_m_s) = (0.0, [0.0, 100.0, 0.0]);
    let source = TrajectorySource::MeanElements(orbit.clone());
    let executed_m_s = |seed| -> f64 {
        let trajectory = Trajectory::from_source(&source, seed, &schedule).unwrap();
        trajectory.manoeuvres()[0].executed_dv_rtn_m_s[1]
    };
    let beyond = (0..20).filter(|seed| executed_m_s(*seed) > 100.0).count();
    assert!((1..20).contains(&beyond), "{beyond}");
    orbit.manoeuvres[0].dv_rtn_m_s[1] = 100.1;
    let refused = Trajectory::from_source(&TrajectorySource::MeanElements(orbit), 1, &schedule).unwrap_err();
    assert!(refused.to_string().contains("orbit.manoeuvres[0].dv_rtn_m_s[1] is 100.1"), "{refused}");
}
