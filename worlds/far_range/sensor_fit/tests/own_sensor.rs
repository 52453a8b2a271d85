//! Figures of sensors whose frames the simulator makes: uniform light, its own charge and readout.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

use boresight_sensor_fit::{Finding, FrameStack, SensorFigures, SensorFrames, fit_sensor};
use sim::draw::ExpectedImage;
use sim::sensor::{
    ExposureInterval, FixedPatternConfig, FrameCharge, HotPixelConfig, LineNoiseConfig, Sensor, SensorConfig,
};

const COLUMNS: usize = 320;
const ROWS: usize = 240;

/// Returns a stack of frames; `first` is the number of its first frame.
fn stack(sensor: &Sensor, seed: u64, first: u64, frames: u64, time_s: f64, light_e: f64) -> FrameStack {
    let seed = draws::Seed { seed, case: 0 };
    let mut sampler = sensor.new_sampler();
    let mut image: ExpectedImage = sensor.new_expected();
    let read = |number: u64| {
        image.clear(light_e);
        let interval = ExposureInterval { seed, middle_s: number as f64, exposure_s: time_s };
        let charge = sensor.collect(&mut image, &interval);
        let mut raw = sensor.new_raw();
        let collected = FrameCharge { charge: &charge, seed, frame: number };
        sensor.read_out(&collected, &mut sampler, &mut raw).unwrap();
        raw.dn().to_vec()
    };
    FrameStack {
        name: format!("{time_s} s"),
        time_s,
        light: if light_e > 0.0 { 1.0 } else { 0.0 },
        names: vec![],
        frames: (first..first + frames).map(read).collect(),
    }
}

/// Returns bias, darks of 2 s and 10 s, and flats up to 1.2 times `end_e`.
fn frames(config: &SensorConfig, seed: u64, end_e: f64, levels: u64) -> SensorFrames {
    let sensor = Sensor::new(config, COLUMNS, ROWS).unwrap();
    let flat = |level: u64| {
        let time_s = 0.1 * (level + 1) as f64;
        let light_e = 1.2 * end_e * (level + 1) as f64 / levels as f64;
        stack(&sensor, seed, 100 + 10 * level, 2, time_s, light_e)
    };
    SensorFrames {
        columns: COLUMNS,
        rows: ROWS,
        stored_bits: 16,
        bias: Some(stack(&sensor, seed, 0, 4, 0.0, 0.0)),
        darks: vec![stack(&sensor, seed, 20, 3, 2.0, 0.0), stack(&sensor, seed, 30, 3, 10.0, 0.0)],
        flats: (0..levels).map(flat).collect(),
    }
}

/// Sensor of a star camera with every effect that uniform frames show.
fn star_camera() -> SensorConfig {
    SensorConfig {
        bit_depth: 14,
        gain_e_per_dn: 2.4,
        bias_dn: 120.3,
        full_well_e: 30_000.0,
        read_noise_e: 9.0,
        dark_current_e_per_s: 25.0,
        non_linearity: 0.03,
        hot_pixels: HotPixelConfig {
            count: 120,
            seed: 5,
            median_e_per_s: 900.0,
            spread: 0.5,
            ..HotPixelConfig::default()
        },
        fixed_pattern: FixedPatternConfig {
            seed: 8,
            prnu_fraction: 0.012,
            dsnu_fraction: 0.3,
            column_offset_e: 4.0,
            dead_pixels: 30,
            dead_columns: 1,
            ..FixedPatternConfig::default()
        },
        line_noise: LineNoiseConfig { row_e: 2.5, column_e: 0.0 },
        ..SensorConfig::default()
    }
}

/// Errors of the figures of a sensor in standard deviations.
fn errors(figures: &SensorFigures, config: &SensorConfig) -> Vec<(&'static str, f64)> {
    let truth: [(&'static str, &Finding, f64); 10] = [
        ("gain", &figures.gain_e_per_dn, config.gain_e_per_dn),
        ("bias", &figures.bias_dn, config.bias_dn),
        ("read noise", &figures.read_noise_e, config.read_noise_e),
        ("dark current", &figures.dark_current_e_per_s, config.dark_current_e_per_s),
        (
            "dark spread",
            &figures.dark_current_spread_e_per_s,
            config.fixed_pattern.dsnu_fraction * config.dark_current_e_per_s,
        ),
        ("PRNU", &figures.prnu_fraction, config.fixed_pattern.prnu_fraction),
        ("columns", &figures.column_offset_e, config.fixed_pattern.column_offset_e),
        ("rows", &figures.row_noise_e, config.line_noise.row_e),
        ("full well", &figures.full_well_e, config.full_well_e),
        ("non-linearity", &figures.non_linearity, config.non_linearity),
    ];
    truth
        .into_iter()
        .filter_map(|(name, finding, truth)| match finding {
            Finding::Value { value, sigma } => Some((name, (value - truth) / sigma)),
            _ => None,
        })
        .collect()
}

#[test]
fn figures_of_the_simulator_are_recovered_with_honest_errors() {
    let config = star_camera();
    let mut all = Vec::new();
    for seed in 1..=6 {
        let fixed_pattern = FixedPatternConfig { seed, ..config.fixed_pattern.clone() };
        let config = SensorConfig { fixed_pattern, ..config.clone() };
        let figures = fit_sensor(&frames(&config, seed, config.full_well_e, 10)).unwrap();
        let errors = errors(&figures, &config);
        println!("{errors:.1?}");
        assert_eq!(errors.len(), 10, "{figures:?}");
        // The column offsets of 320 columns have a mean of their own, which the bias contains.
        assert!(errors.iter().all(|(name, error)| *name == "bias" || error.abs() < 4.0), "{errors:?}");
        all.extend(errors.into_iter().filter(|(name, _)| *name != "bias").map(|(_, error)| error));
        assert!(figures.defects.hot.unwrap().abs_diff(120) < 12, "{:?}", figures.defects);
        assert_eq!((figures.defects.dead, figures.defects.dead_columns), (Some(30), Some(1)));
        let hot = figures.defects.hot_currents.unwrap();
        assert!((hot.median_e_per_s / 900.0 - 1.0).abs() < 0.2 && (hot.spread - 0.5).abs() < 0.12, "{hot:?}");
    }
    // χ² of 54 errors: 0.5 to 1.6 with a probability of 99.8 %.
    let nees = all.iter().map(|error| error * error).sum::<f64>() / all.len() as f64;
    println!("NEES per dimension {nees:.2} over {}", all.len());
    assert!((0.5..1.6).contains(&nees), "{nees}");
}

#[test]
fn a_converter_that_ends_first_gives_no_full_well() {
    let config = SensorConfig {
        bit_depth: 10,
        gain_e_per_dn: 12.0,
        bias_dn: 20.0,
        full_well_e: 50_000.0,
        hot_pixels: HotPixelConfig::default(),
        ..star_camera()
    };
    let figures = fit_sensor(&frames(&config, 3, 12_000.0, 8)).unwrap();
    assert_eq!(figures.bit_depth, (10, true));
    assert!(matches!(&figures.full_well_e, Finding::Missing(reason) if reason.contains("converter")));
    let errors = errors(&figures, &SensorConfig { non_linearity: 0.0, ..config });
    let known = errors.iter().filter(|(name, _)| !["bias", "non-linearity"].contains(name));
    assert!(known.clone().count() >= 5 && known.clone().all(|(_, error)| error.abs() < 4.0), "{errors:?}");
}

#[test]
fn figures_that_frames_do_not_determine_have_a_reason() {
    let config = star_camera();
    let all = frames(&config, 4, config.full_well_e, 6);
    let missing = |finding: &Finding, part: &str| {
        assert!(matches!(finding, Finding::Missing(reason) if reason.contains(part)), "{finding:?}");
    };
    let without_dark = fit_sensor(&SensorFrames { darks: vec![], ..all.clone() }).unwrap();
    missing(&without_dark.dark_current_e_per_s, "dark frames");
    assert!(without_dark.defects.hot.is_none() && without_dark.gain_e_per_dn.value().is_some());
    let one_level = fit_sensor(&SensorFrames { flats: all.flats[1..2].to_vec(), ..all.clone() }).unwrap();
    missing(&one_level.linearity_error_percent, "1 levels");
    missing(&one_level.non_linearity, "levels of light");
    let only_bias = fit_sensor(&SensorFrames { darks: vec![], flats: vec![], ..all.clone() }).unwrap();
    missing(&only_bias.gain_e_per_dn, "flat frames");
    assert!(only_bias.read_noise_dn.value().is_some() && only_bias.bias_dn.value().is_some());
    let only_full = fit_sensor(&SensorFrames { flats: all.flats[5..].to_vec(), ..all.clone() }).unwrap();
    assert!(only_full.full_well_e.value().is_none(), "{:?}", only_full.full_well_e);
    let only_flats = fit_sensor(&SensorFrames { bias: None, darks: vec![], ..all }).unwrap();
    missing(&only_flats.read_noise_e, "bias");
    missing(&only_flats.prnu_fraction, "bias");
}
