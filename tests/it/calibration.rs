//! The best mode with a calibration that is wrong by a fifth: its own estimates do not depend on the
//! calibration.

use serde_json::Value;

use crate::support::{Bench, figure};

/// Score of a hundred and twenty frames of the third day of ARGON, in which regions begin to truncate the
/// image, with a calibration that differs from the truth.
fn score(bench: &Bench, run: &str, calibration: &str) -> Value {
    let file = format!("{run}.toml");
    bench.scenario(&file, "argon", |scenario| {
        let mode = "mode = 'best'".parse::<toml::Table>().unwrap();
        scenario.insert("far_range".into(), mode.into());
        let calibration = calibration.parse::<toml::Table>().unwrap();
        scenario.insert("calibration".into(), calibration.into());
    });
    bench.boresight(&format!("run {file} --frames 7000..7120 --no-report --json --out {run}")).done().json()
}

#[test]
fn a_calibration_that_is_wrong_by_a_fifth_loses_no_target() {
    let bench = Bench::new();
    let attitude = |factor: f64| {
        let sigmas = |arcsec: f64| format!("[{0}, {0}, {0}]", arcsec * factor);
        format!(
            "attitude = {{ white_arcsec = {}, slow_arcsec = {}, slow_period_s = 3100.0, constant_arcsec = {} }}",
            sigmas(53.5),
            sigmas(20.0),
            sigmas(180.0)
        )
    };
    let cases = [
        ("right", String::new()),
        ("sharp", "psf = { sigma_px = 0.64, halo_sigma_px = 4.0, halo_fraction = 0.0434 }".to_owned()),
        ("soft", "psf = { sigma_px = 0.96, halo_sigma_px = 4.0, halo_fraction = 0.0434 }".to_owned()),
        ("halo", "psf = { sigma_px = 0.8, halo_sigma_px = 4.8, halo_fraction = 0.052 }".to_owned()),
        ("small-well", "full_well_e = 48000.0".to_owned()),
        ("large-well", "full_well_e = 72000.0".to_owned()),
        ("spills-less", "spill_fraction = 0.8".to_owned()),
        ("calm", attitude(0.8)),
        ("restless", attitude(1.2)),
        ("bright", "zero_magnitude_e_per_s = 1.8e6".to_owned()),
        ("unknown", "response_sigma = 0.012".to_owned()),
    ];
    for (run, calibration) in cases {
        let score = score(&bench, run, &calibration);
        let of = |name: &str| figure(&score, name);
        let (correct, y_px) = (of("correct_rate"), of("centroid_y_rms_px"));
        let (centroid, line_of_sight) = (of("centroid_nees_mean"), of("line_of_sight_nees_mean"));
        println!("{run}: correct {correct}, y {y_px:.4} px, NEES {centroid:.2} and {line_of_sight:.2}");
        assert_eq!(correct, 1.0, "{run}");
        assert!(y_px < 0.05, "{run}: {y_px} px");
        assert!(centroid < 2.0 && line_of_sight < 2.0, "{run}: NEES {centroid}, {line_of_sight}");
    }
}
