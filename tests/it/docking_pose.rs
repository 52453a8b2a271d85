//! The docking pose compared with the numbers in the scenario: without an intermediate truth table, and with
//! every sign distinguishable.

use crate::support::Bench;

/// d (m) and φ (deg) of a camera at rest: six different values, no two of them opposite.
const POSE: [f64; 6] = [0.06, -0.09, 8.0, 0.4, -0.7, 3.0];
/// The test examines the signs of small angles and offsets; accuracy is covered by
/// docs/evidence/docking-accuracy.md.
const TOLERANCE: [f64; 6] = [0.01, 0.01, 0.02, 0.1, 0.1, 0.1];

#[test]
fn a_camera_at_rest_is_measured_where_the_scenario_has_it() {
    let bench = Bench::new();
    bench.scenario("rest.toml", "docking", |scenario| {
        let rest = format!(
            "kind = 'constant_velocity'\nposition_m = {:?}\nvelocity_m_s = [0.0, 0.0, 0.0]\n\
             phi_deg = {:?}\nphi_rate_deg_s = [0.0, 0.0, 0.0]\nduration_s = 0.2\n",
            &POSE[..3],
            &POSE[3..]
        );
        scenario.insert("approach".to_owned(), toml::Value::Table(rest.parse().unwrap()));
    });
    bench.boresight("run rest.toml --no-report --out run").done();
    let rows = bench.csv("run/measurements.csv");
    let measured: Vec<_> = rows.iter().filter(|row| row["status"] == "measured").collect();
    assert!(measured.len() >= 8, "{} of {} fields are measured", measured.len(), rows.len());
    for row in measured {
        for (i, name) in ["d1_m", "d2_m", "d3_m", "phi1_deg", "phi2_deg", "phi3_deg"].into_iter().enumerate()
        {
            let value: f64 = row[name].parse().unwrap();
            assert!((value - POSE[i]).abs() < TOLERANCE[i], "field {}: {name} is {value}", row["field"]);
        }
    }
}
