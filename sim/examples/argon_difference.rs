//! Difference between the true motion of the scenarios `argon` (mean elements) and `argon-numerical`, day by
//! day: prints the table of `docs/evidence/argon.md`.
//!
//! ```text
//! cargo run --release -p boresight-sim --example argon_difference
//! ```
//!
//! Both approach through the same waypoints with plans of their own. Positions of the chaser are along the
//! target's R, T, N; lines of sight are along the chaser's R, T, N, the frame of the camera.

#![allow(clippy::unwrap_used, reason = "a scenario that cannot be read stops the program with its message")]

use boresight_sim::truth::{
    GroupConfig, NumericalConfig, OrbitConfig, Schedule, States, Trajectory, TrajectorySource,
};
use hifitime::Duration;
use nalgebra::Vector3;
use serde::Deserialize;

#[derive(Deserialize)]
struct Fragment {
    seed: u64,
    orbit: OrbitConfig,
    trajectory: Option<toml::Table>,
    schedule: Vec<GroupConfig>,
}

fn trajectory(text: &str) -> (Trajectory, Schedule) {
    let fragment: Fragment = toml::from_str(text).unwrap();
    let source = match fragment.trajectory {
        None => TrajectorySource::MeanElements(fragment.orbit),
        Some(mut table) => {
            table.remove("kind");
            let forces: NumericalConfig = table.try_into().unwrap();
            TrajectorySource::Numerical(fragment.orbit, forces)
        }
    };
    let schedule = Schedule::new(&fragment.schedule).unwrap();
    (Trajectory::from_source(&source, fragment.seed, &schedule).unwrap(), schedule)
}

/// Direction to the target along the chaser's R, T, N.
fn line_of_sight(states: &States) -> Vector3<f64> {
    states.chaser.rtn_from_icrs().rotate(&states.line_of_sight_km().normalize())
}

fn main() {
    let (mean, _) = trajectory(include_str!("../../scenarios/argon.toml"));
    let (numerical, _) = trajectory(include_str!("../../scenarios/argon-numerical.toml"));
    println!("| day | R, m | T, m | N, m | line of sight, mrad | largest, mrad |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let (mut all, mut count, mut largest_of_all) = (nalgebra::Vector4::<f64>::zeros(), 0.0, 0.0_f64);
    let row = |name: &str, sums: nalgebra::Vector4<f64>, count: f64, largest: f64| {
        let rms = sums.map(|sum| (sum / count).sqrt());
        println!(
            "| {name} | {:.0} | {:.0} | {:.0} | {:.1} | {:.1} |",
            rms.x,
            rms.y,
            rms.z,
            rms.w * 1e3,
            largest * 1e3
        );
    };
    for day in 0..5 {
        let (mut sums, mut largest) = (nalgebra::Vector4::<f64>::zeros(), 0.0_f64);
        let minutes = 24 * 60;
        for minute in 0..minutes {
            let since = Duration::from_seconds(60.0 * f64::from(day * minutes + minute));
            let [a, b] = [&mean, &numerical].map(|t| t.states_at(t.epoch() + since));
            let offset_m = (b.chaser_rtn_km() - a.chaser_rtn_km()) * 1e3;
            let angle = line_of_sight(&a).angle(&line_of_sight(&b));
            sums += nalgebra::Vector4::new(offset_m.x, offset_m.y, offset_m.z, angle).map(|x| x * x);
            largest = largest.max(angle);
        }
        row(&(day + 1).to_string(), sums, f64::from(minutes), largest);
        all += sums;
        count += f64::from(minutes);
        largest_of_all = largest_of_all.max(largest);
    }
    row("1–5", all, count, largest_of_all);
}
