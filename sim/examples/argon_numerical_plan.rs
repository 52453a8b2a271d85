//! Plans the approach of the scenario `argon-numerical`: prints its tables `[orbit]` and `[trajectory]` as
//! TOML.
//!
//! ```text
//! cargo run --release -p boresight-sim --example argon_numerical_plan
//! ```
//!
//! Events, waypoints and sizes of the relative ellipse are those of `scenarios/argon_plan.py`. The plan is
//! flown ground-in-the-loop in the numerical truth, execution errors included: at each event a pair of
//! impulses half an orbit apart follows from linear theory (D'Amico 2010, Ch. 2), and their sum is corrected
//! until the along-track separation at the next event is that of the waypoint. Relative elements are
//! osculating ones, fitted by a line over two revolutions, which removes their short-period terms.

#![allow(clippy::unwrap_used, reason = "a refused plan stops the program with its message")]

use boresight_sim::truth::{
    DragConfig, EarthOrientationConfig, Elements, ElementsConfig, GravityConfig, GroupConfig,
    ManoeuvreConfig, ManoeuvreErrorsConfig, ManoeuvreReportsConfig, NumericalConfig, OrbitConfig,
    RadiationConfig, RelativeElements, Schedule, Trajectory, TrajectorySource, clock,
};
use hifitime::{Duration, Epoch};
use serde::Serialize;

const SEED: u64 = 20_120_423;
const DAY_S: f64 = 86_400.0;

/// Time, s; waypoint of aδλ at the next event, m; size of the relative eccentricity and inclination vectors
/// after the event, m.
const EVENTS: [(f64, f64, f64, Option<f64>); 5] = [
    (8.0 * 3600.0, -27_000.0, 385.0, None),
    (DAY_S, -20_000.0, 350.0, Some(350.0)),
    (2.0 * DAY_S, -13_600.0, 310.0, Some(300.0)),
    (2.0 * DAY_S + 22.0 * 3600.0, -7_000.0, 265.0, Some(250.0)),
    (4.0 * DAY_S, -3_000.0, 225.0, Some(210.0)),
];
const END_S: f64 = 5.0 * DAY_S;

#[derive(Serialize)]
struct Tables<'a> {
    orbit: &'a OrbitConfig,
    trajectory: TrajectoryTable<'a>,
}

#[derive(Serialize)]
struct TrajectoryTable<'a> {
    kind: &'static str,
    #[serde(flatten)]
    forces: &'a NumericalConfig,
}

fn forces() -> NumericalConfig {
    NumericalConfig {
        gravity: GravityConfig { degree: 36, order: 36 },
        // 2012 April 25 (IERS 14 C04, as in Celestrak's EOP-All.csv).
        earth: EarthOrientationConfig { ut1_minus_utc_s: -0.5394, pole_arcsec: [0.0013, 0.3618] },
        // Assumed: 150 kg and 0.8 m², 40 kg and 0.5 m², drag coefficient 2.3, radiation pressure coefficient
        // 1.3.
        drag: Some(DragConfig { chaser_m2_kg: 0.012, target_m2_kg: 0.029, exponent: 6.0 }),
        radiation: Some(RadiationConfig { chaser_m2_kg: 0.007, target_m2_kg: 0.016 }),
        ..NumericalConfig::default()
    }
}

fn start() -> OrbitConfig {
    OrbitConfig {
        epoch_utc: "2012-04-23T00:00:00Z".into(),
        target: ElementsConfig {
            semi_major_axis_km: 7139.0,
            eccentricity: 0.003,
            inclination_deg: 98.28,
            raan_deg: 126.4,
            argument_of_perigee_deg: 90.0,
            mean_anomaly_deg: 270.0,
        },
        relative: RelativeElements {
            a_dlambda_m: -30_000.0,
            a_dey_m: 400.0,
            a_diy_m: 400.0,
            ..Default::default()
        },
        manoeuvres: Vec::new(),
        execution: Some(ManoeuvreErrorsConfig { size_sigma: 0.01, direction_sigma_deg: 0.5 }),
        reports: Some(ManoeuvreReportsConfig { delay_s: 600.0, size_sigma: 0.02, direction_sigma_deg: 1.0 }),
    }
}

struct Flight {
    trajectory: Trajectory,
}

impl Flight {
    fn new(orbit: &OrbitConfig) -> Self {
        let day = GroupConfig {
            name: "days".into(),
            start_utc: orbit.epoch_utc.clone(),
            cadence_s: END_S,
            count: 2,
        };
        let schedule = Schedule::new(&[day]).unwrap();
        let source = TrajectorySource::Numerical(orbit.clone(), forces());
        Self { trajectory: Trajectory::from_source(&source, SEED, &schedule).unwrap() }
    }

    fn at(&self, time_s: f64) -> Epoch {
        self.trajectory.epoch() + Duration::from_seconds(time_s)
    }

    fn target(&self, time_s: f64) -> Elements {
        Elements::from_state(&self.trajectory.states_at_seconds(time_s).target).unwrap()
    }

    /// Mean relative elements over an interval, m: aδa, aδλ (at `at_s`), aδex, aδey, aδix, aδiy.
    fn mean(&self, from_s: f64, to_s: f64, at_s: f64) -> [f64; 6] {
        let n = 240;
        let rows: Vec<(f64, [f64; 6])> = (0..n)
            .map(|k| {
                let time_s = from_s + (to_s - from_s) * (f64::from(k) + 0.5) / f64::from(n);
                let r = self.trajectory.relative_elements(self.at(time_s)).unwrap();
                (time_s - at_s, [r.a_da_m, r.a_dlambda_m, r.a_dex_m, r.a_dey_m, r.a_dix_m, r.a_diy_m])
            })
            .collect();
        let mean_t = rows.iter().map(|row| row.0).sum::<f64>() / f64::from(n);
        let spread = rows.iter().map(|row| (row.0 - mean_t) * (row.0 - mean_t)).sum::<f64>();
        std::array::from_fn(|i| {
            let mean = rows.iter().map(|row| row.1[i]).sum::<f64>() / f64::from(n);
            // A slope only where it is a drift: aδλ.
            let slope = rows.iter().map(|row| (row.0 - mean_t) * (row.1[i] - mean)).sum::<f64>() / spread;
            if i == 1 { mean - slope * mean_t } else { mean }
        })
    }
}

fn main() {
    let mut orbit = start();
    let n = Flight::new(&orbit).target(0.0).mean_motion_rad_s();
    let period_s = 2.0 * std::f64::consts::PI / n;
    let window_s = 2.0 * period_s;

    // The chaser rests at 30 km until the first event.
    for _ in 0..5 {
        let flight = Flight::new(&orbit);
        let (early, late) = (
            flight.mean(0.0, window_s, 0.0),
            flight.mean(8.0 * 3600.0 - window_s, 8.0 * 3600.0, 8.0 * 3600.0),
        );
        orbit.relative.a_da_m += (late[1] - early[1]) / (1.5 * n * 8.0 * 3600.0);
        orbit.relative.a_dlambda_m += -30_000.0 - early[1];
        orbit.relative.a_dey_m += 400.0 - early[3];
        orbit.relative.a_dex_m -= early[2];
        orbit.relative.a_diy_m += 400.0 - early[5];
        orbit.relative.a_dix_m -= early[4];
    }
    let rounded = |x: f64| (x * 1000.0).round() / 1000.0;
    let r = &mut orbit.relative;
    for x in
        [&mut r.a_da_m, &mut r.a_dlambda_m, &mut r.a_dex_m, &mut r.a_dey_m, &mut r.a_dix_m, &mut r.a_diy_m]
    {
        *x = rounded(*x);
    }

    for (index, &(not_before_s, waypoint_m, de_m, di_m)) in EVENTS.iter().enumerate() {
        let flight = Flight::new(&orbit);
        let latitude = flight.target(not_before_s).mean_argument_of_latitude_rad();
        let half = std::f64::consts::PI;
        let t1 = (not_before_s + (half / 2.0 - latitude).rem_euclid(half) / n).round();
        let t2 = (t1 + period_s / 2.0).round();
        let next_s = EVENTS.get(index + 1).map_or(END_S, |event| event.0);
        let sign = libm::sin(flight.target(t1).mean_argument_of_latitude_rad()).signum();
        let now = flight.mean(t1 - window_s, t1, t1);
        let mut total_m = -now[0];
        let planned = orbit.manoeuvres.len();
        for _ in 0..5 {
            orbit.manoeuvres.truncate(planned);
            let split_m = sign * (de_m - now[3]);
            let normal_m_s = di_m.map_or(0.0, |di_m| sign * n * (di_m - now[5]));
            for (time_s, transverse_m_s, normal_m_s) in
                [(t1, 0.25 * n * (total_m + split_m), normal_m_s), (t2, 0.25 * n * (total_m - split_m), 0.0)]
            {
                let dv = |x: f64| (x * 1e5).round() / 1e5 + 0.0;
                orbit.manoeuvres.push(ManoeuvreConfig {
                    time_utc: clock::format_utc(flight.at(time_s)).replace(".000000000", ""),
                    dv_rtn_m_s: [0.0, dv(transverse_m_s), dv(normal_m_s)],
                    duration_s: 10.0,
                });
            }
            let miss_m = waypoint_m - Flight::new(&orbit).mean(next_s - window_s, next_s, next_s)[1];
            total_m -= miss_m / (1.5 * n * (next_s - 0.5 * (t1 + t2)));
            eprintln!("event {index}: miss {miss_m:.1} m");
        }
    }

    let flight = Flight::new(&orbit);
    for hours in (0..=120).step_by(6) {
        let time_s = f64::from(hours) * 3600.0;
        let states = flight.trajectory.states_at_seconds(time_s);
        let from_s = time_s.min(END_S - period_s);
        let mean = flight.mean(from_s, from_s + period_s, time_s).map(|x| x.round());
        eprintln!("{hours:3} h {:9.1} m {mean:?}", states.range_km() * 1000.0);
    }
    let trajectory = TrajectoryTable { kind: "numerical", forces: &forces() };
    println!("{}", toml::to_string(&Tables { orbit: &orbit, trajectory }).unwrap());
}
