//! Approach planned for the scenario `argon`, propagated by the simulator.
//!
//! The plan comes from scenarios/argon_plan.py, which has an independent implementation of the orbit
//! mathematics in another language and serves as the reference here.

use boresight_sim::truth::{GroupConfig, Guidance, OrbitConfig, Schedule, Trajectory};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use serde::Deserialize;

#[derive(Deserialize)]
struct Fragment {
    orbit: OrbitConfig,
    schedule: Vec<GroupConfig>,
}

fn fragment() -> Fragment {
    toml::from_str(include_str!("../../../scenarios/argon.toml"))
        .expect("the scenario has orbit and schedule")
}

fn noon(day: u8) -> Epoch {
    Epoch::from_gregorian_utc_hms(2012, 4, 22 + day, 12, 0, 0)
}

/// Reference positions of the chaser in the target's RTN frame at noon of days 1 to 5, m, computed by
/// argon_plan.py.
const WITNESS_RTN_M: [[f64; 3]; 5] = [
    [-442.439, -29696.272, -122.0644],
    [94.3429, -23025.033, 278.9088],
    [-80.9696, -17081.6289, -301.2459],
    [-165.7409, -9483.2788, 212.604],
    [154.709, -5310.4995, -79.9585],
];

#[test]
fn two_implementations_fly_the_same_plan() {
    let trajectory = Trajectory::new(&fragment().orbit).unwrap();
    for (day, expected) in (1..).zip(WITNESS_RTN_M) {
        let got = trajectory.states_at(noon(day)).chaser_rtn_km() * 1000.0;
        // Printed to 0.1 mm. The manoeuvres pass through elements with rounding 1e-15, which is 1e-8 m of
        // semi-major axis and, at 10 rad of drift per day, far less than 1 mm at the end.
        assert!((got - Vector3::from(expected)).norm() < 1e-3, "day {day}: {got} {expected:?}");
    }
}

/// The mean range is taken over the orbit around noon; within one orbit the range swings by ±2 aδe, up to 0.8
/// km.
#[test]
fn the_mean_range_at_noon_goes_down_as_planned() {
    let trajectory = Trajectory::new(&fragment().orbit).unwrap();
    for (day, expected_km) in [(1, 29.4), (2, 23.5), (3, 16.5), (4, 10.0), (5, 5.0)] {
        let ranges = (-50..50).map(|minute| {
            trajectory.states_at(noon(day) + Duration::from_seconds(60.0 * f64::from(minute))).range_km()
        });
        let mean_km = ranges.sum::<f64>() / 100.0;
        assert!((mean_km / expected_km - 1.0).abs() < 0.1, "day {day}: {mean_km} km");
    }
}

#[test]
fn the_approach_begins_at_30_km_and_ends_at_3_km() {
    let trajectory = Trajectory::new(&fragment().orbit).unwrap();
    let lambda = |epoch: Epoch| trajectory.relative_elements(epoch).unwrap().a_dlambda_m;
    assert!((lambda(trajectory.epoch()) + 30_000.0).abs() < 1.0);
    let end = Epoch::from_gregorian_utc_hms(2012, 4, 28, 0, 0, 0);
    // Each impulse is rounded to 0.01 mm/s, which is 1.4 m per day; the rounding accumulates over four days
    // to the last waypoint.
    assert!((lambda(end) + 3_000.0).abs() < 20.0, "{}", lambda(end));
    // Approximately 16 km on 25 April from 11:30 to 13:00 (paper, Fig. 2).
    let overlay = Epoch::from_gregorian_utc_hms(2012, 4, 25, 12, 15, 0);
    assert!((lambda(overlay) + 16_000.0).abs() < 500.0, "{}", lambda(overlay));
}

#[test]
fn the_schedule_has_the_papers_counts_and_its_sample_image() {
    let schedule = Schedule::new(&fragment().schedule).unwrap();
    let counts: Vec<_> = schedule.sequences().map(|s| s.frames.end - s.frames.start).collect();
    assert_eq!(counts, [1634, 2978, 3319, 5415, 2731]);
    assert_eq!(schedule.frame_count(), 16_077);
    let sample = Epoch::from_gregorian_utc_hms(2012, 4, 25, 12, 18, 54);
    assert_eq!(schedule.frame(1634 + 2978 + 1516), Some(("day 3", sample)));
}

/// Half field of view of the camera: 9.1° along columns, 6.8° along rows.
#[test]
fn the_target_is_in_the_field_of_view_in_every_frame() {
    let Fragment { orbit, schedule } = fragment();
    let (trajectory, schedule) = (Trajectory::new(&orbit).unwrap(), Schedule::new(&schedule).unwrap());
    let guidance = Guidance::LocalOrbital { phi_deg: 0.0, theta_deg: 0.0, psi_deg: 0.0 };
    let mut widest = [0.0_f64; 2];
    for n in 0..schedule.frame_count() {
        let (_, time) = schedule.frame(n).unwrap();
        let states = trajectory.states_at(time);
        let seen = guidance.camera_from_icrs(&states).rotate(&states.line_of_sight_km());
        for (most, component) in widest.iter_mut().zip([seen.x, seen.y]) {
            *most = most.max(libm::atan2(component.abs(), seen.z).to_degrees());
        }
    }
    assert!(widest[0] < 9.1 && widest[1] < 6.8, "{widest:?}");
    // The motion finally covers a large part of the field, as in Fig. 3 of the paper.
    assert!(widest[0] > 3.0 && widest[1] > 3.0, "{widest:?}");
}
