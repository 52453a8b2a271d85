//! The batch against least squares over numerically integrated states by SciPy and by Orekit
//! (`golden/navigation`).

use boresight_navigation::{Batch, BatchConfig};
use contract::navigation::{
    AngleErrors, ChaserOrbit, DifferentialDrag, Event, LineOfSightErrors, LineOfSightMeasurement,
    ManoeuvreReport, NavigationSetup, Navigator, ReportedState,
};
use contract::{Direction, Rotation};
use nalgebra::Vector3;

use crate::simulator::{at, epoch};

fn table(name: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/../golden/navigation/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let row = |line: &str| line.split(',').map(|value| value.parse().expect("a number")).collect();
    text.lines().skip(1).map(row).collect()
}

fn vector(row: &[f64], first: usize) -> Vector3<f64> {
    Vector3::new(row[first], row[first + 1], row[first + 2])
}

#[test]
fn the_estimate_is_that_of_scipy_and_of_orekit() {
    let states = table("chaser.csv");
    let states = states.iter().map(|row| ReportedState {
        time: at(row[0]),
        position_km: vector(row, 1),
        velocity_km_s: vector(row, 4),
        position_sigma_m: 1.0,
        velocity_sigma_m_s: 0.001,
    });
    let without_stars = AngleErrors { white_arcsec: [30.0; 2], slow: Vec::new(), constant_arcsec: [20.0; 3] };
    let setup = NavigationSetup {
        epoch: epoch(),
        chaser_orbit: ChaserOrbit::States(states.collect()),
        camera_from_body: Rotation::identity(),
        prior: None,
        errors: LineOfSightErrors { without_stars, ..LineOfSightErrors::default() },
        drag: DifferentialDrag::default(),
    };
    let mut batch = Batch::new(&setup, &BatchConfig::default()).unwrap();
    for (frame, row) in (0..).zip(table("sights.csv")) {
        batch.receive(&Event::LineOfSight(LineOfSightMeasurement {
            frame,
            time: at(row[0]),
            line_of_sight: Direction::from_vector(vector(&row, 1)).unwrap(),
            camera_from_icrs: Rotation::from_axes(&vector(&row, 4), &vector(&row, 7), &vector(&row, 10)),
            covariance: None,
            attitude_source: None,
        }));
    }
    // Those of golden/navigation/make.py.
    for (seconds, dv) in
        [(9_000.0, [0.0, -0.05, 0.02]), (40_000.0, [0.02, 0.03, -0.04]), (62_000.0, [0.0, -0.04, 0.0])]
    {
        batch.receive(&Event::Manoeuvre(ManoeuvreReport {
            time: at(seconds),
            dv_rtn_m_s: dv.into(),
            sigma_rtn_m_s: Vector3::zeros(),
        }));
    }
    for row in table("estimates.csv").into_iter().chain(table("orekit.csv")) {
        let estimate = batch.estimates(&[at(row[0])]).remove(0).unwrap();
        let (expected, expected_sigma) = (vector(&row, 1), vector(&row, 4));
        let sigma = estimate.covariance.sigmas().fixed_rows::<3>(0).into_owned();
        let difference = (estimate.position_m - expected).component_div(&expected_sigma);
        assert!(difference.abs().max() < 0.2, "{} s: {difference} sigma", row[0]);
        let ratio = sigma.component_div(&expected_sigma);
        assert!(ratio.iter().all(|ratio| (0.9..1.1).contains(ratio)), "{} s: {ratio}", row[0]);
        // R and N include the accuracy of the model, which T, a hundred times larger, does not show.
        assert!((0.99..1.01).contains(&ratio[1]), "{} s: {ratio}", row[0]);
    }
}
