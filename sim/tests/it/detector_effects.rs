//! Detector effects, measured from outside: in digital numbers and in the truth table.

use boresight_sim::scene::TargetConfig;
use boresight_sim::sensor::{
    CosmicRayConfig, ExposureInterval, FixedPatternConfig, FrameCharge, HotPixelConfig, LineNoiseConfig,
    Sensor, SensorConfig, SouthAtlanticConfig, TelegraphConfig,
};
use boresight_sim::truth::{ObjectKind, geographic};
use boresight_sim::{Exposure, Simulation};
use draws::Seed;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::small_scene::{cosmic_rays, defective, restless, simulator, still};

/// Five standard deviations: exceeded by chance in one of 1.7 million tests; the seeds are fixed.
const FIVE_SIGMA: f64 = 5.0;

/// Returns frames of a flat sky as deviations from the bias, electrons.
fn flat_frames(config: &SensorConfig, size: usize, frames: u64, exposure_s: f64) -> Vec<Vec<f64>> {
    let sensor = Sensor::new(config, size, size).unwrap();
    let (mut image, mut raw, mut sampler) = (sensor.new_expected(), sensor.new_raw(), sensor.new_sampler());
    let seed = Seed { seed: 17, case: 0 };
    (0..frames)
        .map(|frame| {
            image.clear(sensor.sky_electrons(exposure_s));
            let charge = sensor
                .collect(&mut image, &ExposureInterval { seed, middle_s: 10.0 * frame as f64, exposure_s });
            let collected = FrameCharge { charge: &charge, seed, frame };
            sensor.read_out(&collected, &mut sampler, &mut raw).unwrap();
            raw.dn().iter().map(|dn| (f64::from(*dn) - config.bias_dn) * config.gain_e_per_dn).collect()
        })
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (values.len() - 1) as f64
}

/// Returns half the variance of the difference of two frames: fixed patterns cancel.
fn temporal_variance(a: &[f64], b: &[f64]) -> f64 {
    0.5 * variance(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// Returns the mean of each column (`true`) or row of a square frame.
fn line_means(frame: &[f64], size: usize, columns: bool) -> Vec<f64> {
    let (step, stride) = if columns { (size, 1) } else { (1, size) };
    (0..size).map(|i| (0..size).map(|j| frame[i * stride + j * step]).sum::<f64>() / size as f64).collect()
}

fn quiet() -> SensorConfig {
    SensorConfig { gain_e_per_dn: 2.0, bias_dn: 100.0, full_well_e: 100_000.0, ..SensorConfig::default() }
}

#[test]
fn variance_over_mean_of_frame_differences_is_the_gain_at_any_prnu() {
    let config = SensorConfig {
        gain_e_per_dn: 4.0,
        read_noise_e: 8.0,
        background_e_per_s: 1000.0,
        fixed_pattern: FixedPatternConfig { seed: 1, prnu_fraction: 0.02, ..FixedPatternConfig::default() },
        ..quiet()
    };
    let moments = |exposure_s: f64| {
        let frames = flat_frames(&config, 512, 4, exposure_s);
        let dn = |e: f64| e / 4.0;
        let variance =
            0.5 * (temporal_variance(&frames[0], &frames[1]) + temporal_variance(&frames[2], &frames[3]));
        (dn(mean(&frames.concat())), dn(dn(variance)), dn(dn(self::variance(&frames[0]))))
    };
    let ((low, low_variance, _), (high, high_variance, spatial)) = (moments(0.1), moments(8.0));
    let slope = (high_variance - low_variance) / (high - low);
    // Half a million differences determine a variance to 0.2 %; the tolerance of half a percent is two and a
    // half times as large.
    assert!((slope * 4.0 - 1.0).abs() < 0.005, "slope {slope}");
    // Within one frame, PRNU adds (2 % of 8000 e⁻)² to 8000 e⁻ + 8²; uncertainty 0.3 %, and 0.5 % from the
    // pattern itself.
    let expected = (8000.0 + 64.0 + 160.0 * 160.0) / 16.0 + 1.0 / 12.0;
    assert!((spatial / expected - 1.0).abs() < 0.015, "{spatial} and {expected}");
}

#[test]
fn dark_frames_have_the_mean_the_pattern_and_the_noise_of_their_figures() {
    let config = SensorConfig {
        gain_e_per_dn: 0.5,
        read_noise_e: 3.0,
        dark_current_e_per_s: 25.0,
        fixed_pattern: FixedPatternConfig { seed: 1, dsnu_fraction: 0.4, ..FixedPatternConfig::default() },
        ..quiet()
    };
    let frames = flat_frames(&config, 256, 2, 4.0);
    // 100 e⁻ with a spread of 40 from pixel to pixel: the uncertainty of the mean is 40/256.
    assert!((mean(&frames[0]) - 100.0).abs() < FIVE_SIGMA * 40.0 / 256.0, "{}", mean(&frames[0]));
    let temporal = temporal_variance(&frames[0], &frames[1]);
    // Dark shot noise, read noise, rounding to half an electron; uncertainty 0.55 %, and the mean of the
    // pattern as above.
    assert!((temporal / (100.0 + 9.0 + 0.25 / 12.0) - 1.0).abs() < 0.03, "{temporal}");
    let covariance = variance(&frames[0]) - temporal;
    // A log-normal pattern of 40 %: its fourth moment makes the variance uncertain by roughly 1.5 %.
    assert!((covariance / 1600.0 - 1.0).abs() < 0.06, "{covariance}");
}

/// The built-in cameras, cropped to 96 × 96 pixels, without hot pixels, in darkness for ten seconds: at their
/// nominal temperature, and at the higher temperature, in kelvin, that doubles the dark current.
#[test]
fn dark_frames_of_every_built_in_camera_have_the_mean_and_the_noise_of_its_figures() {
    let (size, n, frames, exposure_s) = (96, 96.0 * 96.0, 16, 10.0);
    let mut cameras = 0;
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/cameras")).unwrap() {
        let path = entry.unwrap().path();
        let table: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        let mut config: SensorConfig = table["sensor"].clone().try_into().unwrap();
        config.hot_pixels = HotPixelConfig::default();
        // A converter whose step exceeds the noise rounds most pixels to the same number: its mean says
        // nothing. The noise then gets a finer one.
        if config.read_noise_e < config.gain_e_per_dn {
            (config.bit_depth, config.gain_e_per_dn) = (16, 0.5 * config.read_noise_e);
        }
        for doublings in [0.0, 1.0] {
            config.temperature.temperature_c += doublings * config.temperature.doubling_k;
            let temperature = config.temperature;
            let warmth = (temperature.temperature_c - temperature.reference_c) / temperature.doubling_k;
            let dark_e = config.dark_current_e_per_s * exposure_s * libm::pow(2.0, warmth);
            let (line, pattern) = (config.line_noise, &config.fixed_pattern);
            let sample = flat_frames(&config, size, frames, exposure_s);

            // Shot noise of the dark current, read noise, rounding; row and column noise are shared within a
            // line.
            let pixel = dark_e
                + config.read_noise_e * config.read_noise_e
                + config.gain_e_per_dn * config.gain_e_per_dn / 12.0;
            let lines = line.row_e * line.row_e + line.column_e * line.column_e;
            let dsnu_e = pattern.dsnu_fraction * dark_e;
            let offsets = pattern.column_offset_e * pattern.column_offset_e / size as f64;
            let error =
                ((pixel + lines * size as f64) / (n * frames as f64) + dsnu_e * dsnu_e / n + offsets).sqrt();
            // Reduction by the non-linearity: β e²/full well for the mean and for the spread.
            let bend =
                config.non_linearity * (dark_e * dark_e + dsnu_e * dsnu_e + pixel) / config.full_well_e;
            let got = mean(&sample.concat());
            assert!((got + bend - dark_e).abs() < FIVE_SIGMA * error, "{path:?}: mean {got} e⁻ for {dark_e}");

            let pairs: Vec<f64> =
                sample.chunks_exact(2).map(|pair| temporal_variance(&pair[0], &pair[1])).collect();
            // Eight pairs of 9216 pixels determine a variance to 0.5 %. The variance of 96 rows in each pair
            // adds 0.4 % where it is a tenth of the total; the mean of the pattern adds 0.3 %. Five percent
            // is more than five times their sum.
            let got = mean(&pairs);
            assert!((got / (pixel + lines) - 1.0).abs() < 0.05, "{path:?}: {got} e⁻² for {}", pixel + lines);
        }
        cameras += 1;
    }
    assert!(cameras >= 3, "{cameras} cameras");
}

#[test]
fn rows_and_columns_have_the_noise_that_they_share() {
    let size = 200;
    let config = SensorConfig {
        read_noise_e: 4.0,
        line_noise: LineNoiseConfig { row_e: 6.0, column_e: 3.0 },
        fixed_pattern: FixedPatternConfig { seed: 6, column_offset_e: 9.0, ..FixedPatternConfig::default() },
        background_e_per_s: 500.0,
        ..quiet()
    };
    let frames = flat_frames(&config, size, 20, 1.0);
    // Variance that remains in the mean over a line: from the noise of its pixels, 500 + 4² + 2²/12 e⁻² per
    // pixel, and from the crossing lines.
    let chi2 = |values: &[f64], expected: f64| {
        let n = values.len() as f64;
        ChiSquared::new(n - 1.0).unwrap().sf(variance(values) * (n - 1.0) / expected)
    };
    let pixel = (500.0 + 16.0 + 4.0 / 12.0) / size as f64;
    for frame in &frames {
        let rows = chi2(&line_means(frame, size, false), 36.0 + pixel);
        assert!((1e-4..1.0 - 1e-4).contains(&rows), "rows: {rows}");
    }
    let columns: Vec<Vec<f64>> = frames.iter().map(|frame| line_means(frame, size, true)).collect();
    for pair in columns.chunks_exact(2) {
        let difference: Vec<f64> = pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).collect();
        let temporal = chi2(&difference, 2.0 * (9.0 + pixel));
        assert!((1e-4..1.0 - 1e-4).contains(&temporal), "columns in time: {temporal}");
    }
    let fixed: Vec<f64> =
        (0..size).map(|x| columns.iter().map(|frame| frame[x]).sum::<f64>() / 20.0).collect();
    let fixed = chi2(&fixed, 81.0 + (9.0 + pixel) / 20.0);
    assert!((1e-4..1.0 - 1e-4).contains(&fixed), "fixed columns: {fixed}");
}

#[test]
fn frames_of_lines_and_patterns_still_have_shot_and_read_noise() {
    let lines = SensorConfig {
        read_noise_e: 4.0,
        line_noise: LineNoiseConfig { row_e: 1e-9, column_e: 0.0 },
        background_e_per_s: 500.0,
        ..quiet()
    };
    let frames = flat_frames(&lines, 256, 2, 1.0);
    let got = temporal_variance(&frames[0], &frames[1]);
    // The uncertainty from 65,536 differences is 0.55 %.
    assert!((got / (516.0 + 4.0 / 12.0) - 1.0).abs() < 0.0275, "{got}");
}

fn one(simulation: &Simulation, frame: u64) -> Exposure {
    simulator(simulation).camera().unwrap().expose(frame).unwrap()
}

#[test]
fn a_defective_frame_alone_is_the_frame_of_the_run() {
    let simulation = defective(restless());
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let run: Vec<Exposure> = (0..6).map(|frame| camera.expose(frame).unwrap()).collect();
    assert_eq!(one(&simulation, 5), run[5]);
    assert!(run.iter().flat_map(|e| &e.objects).any(|object| object.kind == ObjectKind::CosmicRay));
}

/// Photometric closure: the expected image equals the truth table plus the background, which is known in
/// closed form.
#[test]
fn the_electrons_of_the_frame_are_those_of_the_truth_table() {
    // Without smear, whose signal the table excludes, and without DSNU and PRNU, which would change the
    // background.
    let mut simulation = defective(still());
    simulation.sensor.frame_transfer_s = 0.0;
    (simulation.sensor.fixed_pattern.prnu_fraction, simulation.sensor.fixed_pattern.dsnu_fraction) =
        (0.0, 0.0);
    simulation.sensor.fixed_pattern.dead_pixels = 1500;
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    for frame in 0..10 {
        let exposure = camera.expose(frame).unwrap();
        let image = camera.expected();
        let in_table: f64 = exposure.objects.iter().map(|object| object.electrons).sum();
        let dead = image.iter().filter(|&electrons| electrons == 0.0).count() as f64;
        // 1500 dead pixels, and two columns of 120 pixels, with some overlap.
        assert!((1690.0..=1740.0).contains(&dead), "{dead} dead pixels");
        let expected = in_table + image.flat_e() * (160.0 * 120.0 - dead);
        let got: f64 = image.iter().sum();
        assert!((got / expected - 1.0).abs() < 1e-9, "frame {frame}: {got} and {expected}");
    }
}

/// With smear, a frame has more signal than its objects and its background: the excess equals the smear in
/// the frame truth.
#[test]
fn with_the_smear_of_the_truth_the_electrons_are_complete() {
    let mut simulation = still();
    simulation.sensor.frame_transfer_s = 0.005;
    simulation.sensor.cosmic_rays = Some(cosmic_rays(1000.0));
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    for frame in 0..10 {
        let exposure = camera.expose(frame).unwrap();
        let pixels = 160.0 * 120.0;
        let in_table: f64 = exposure.objects.iter().map(|object| object.electrons).sum();
        let got: f64 = camera.expected().iter().sum();
        let expected = in_table + (camera.expected().flat_e() + exposure.truth.smear_e_per_px) * pixels;
        assert!((got / expected - 1.0).abs() < 1e-9, "frame {frame}: {got} and {expected}");
        // The transfer takes a fiftieth of the exposure: 60 e⁻/s of sky for 0.25 s give 119/120 of 0.3 e⁻,
        // and stars add to this.
        assert!(exposure.truth.smear_e_per_px > 0.29, "{}", exposure.truth.smear_e_per_px);
    }
    assert_eq!(one(&still(), 0).truth.smear_e_per_px, 0.0);
}

/// With all other effects that change the signal enabled, the table holds the contribution of each object:
/// the difference between images with and without it.
#[test]
fn with_all_effects_the_table_holds_the_electrons_of_each_object() {
    let mut with = defective(still());
    with.sensor.frame_transfer_s = 0.0;
    let mut without = with.clone();
    without.target = TargetConfig::LambertSphere { radius_m: 0.1, albedo: 0.0 };
    let sum = |simulation: &Simulation| {
        let simulator = simulator(simulation);
        let mut camera = simulator.camera().unwrap();
        let exposure = camera.expose(3).unwrap();
        (camera.expected().iter().sum::<f64>(), exposure)
    };
    let ((all, exposure), (rest, other)) = (sum(&with), sum(&without));
    let target = &exposure.objects[0];
    assert_eq!(target.kind, ObjectKind::Target);
    assert!(
        (all - rest - target.electrons).abs() < 1e-6 * target.electrons,
        "{} {}",
        all - rest,
        target.electrons
    );
    assert_eq!(exposure.objects[1..], other.objects);
}

#[test]
fn the_digital_numbers_scatter_about_the_expectation_with_every_pattern_on() {
    let mut simulation = defective(still());
    let sensor = &mut simulation.sensor;
    // Effects that vary in time or make the mean non-linear are off.
    (sensor.non_linearity, sensor.cosmic_rays, sensor.hot_pixels.telegraph) = (0.0, None, None);
    (sensor.line_noise, sensor.fixed_pattern.column_offset_e) = (LineNoiseConfig::default(), 0.0);
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let (mut chi2, mut n) = (0.0, 0.0);
    for frame in 0..10 {
        let exposure = camera.expose(frame).unwrap();
        for (dn, mean_e) in exposure.frame.dn().iter().zip(camera.expected().iter()) {
            if mean_e < 20_000.0 {
                let error_e = (f64::from(*dn) - 40.3) * 10.0 - mean_e;
                chi2 += error_e * error_e / (mean_e + 225.0 + 100.0 / 12.0);
                n += 1.0;
            }
        }
    }
    // The square of a standard normal variable has variance 2.
    assert!((chi2 - n).abs() < FIVE_SIGMA * (2.0 * n).sqrt(), "{}", chi2 / n);
}

#[test]
fn telegraphs_in_the_table_have_two_levels_and_the_occupancy_of_their_dwell_times() {
    let mut simulation = still();
    simulation.schedule[0].cadence_s = 60.0;
    simulation.sensor.hot_pixels = HotPixelConfig {
        count: 200,
        median_e_per_s: 10_000.0,
        spread: 0.0,
        telegraph: Some(TelegraphConfig { fraction: 1.0, low_level: 0.25, high_s: 30.0, low_s: 90.0 }),
        ..simulation.sensor.hot_pixels.clone()
    };
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let (mut high, mut n, mut between) = (0.0, 0.0, 0.0);
    for frame in 0..20 {
        for object in camera.expose(frame).unwrap().objects {
            if object.kind == ObjectKind::HotPixel {
                n += 1.0;
                high += f64::from(u8::from((object.electrons - 2500.0).abs() < 1e-6));
                between += f64::from(u8::from(object.electrons > 625.001 && object.electrons < 2499.999));
            }
        }
    }
    // A quarter is in the high state; frames 60 s apart share exp(−60/22.5) = 7 % of their state, hence 1.15
    // times the binomial error.
    assert!((high / n - 0.25).abs() < 1.15 * FIVE_SIGMA * (0.1875_f64 / n).sqrt(), "{}", high / n);
    // A switch falls into about 0.25 s of every 60 s.
    assert!(between / n < 0.02);
}

#[test]
fn the_anomaly_is_felt_where_it_is_and_only_there() {
    let mut simulation = still();
    simulation.schedule[0].cadence_s = 120.0;
    simulation.sensor.cosmic_rays =
        Some(CosmicRayConfig { south_atlantic: Some(SouthAtlanticConfig::default()), ..cosmic_rays(1.0) });
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    let (mut inside, mut outside) = ((0, 0), (0, 0));
    // One day of passes.
    for frame in (0..720).step_by(2) {
        let exposure = camera.expose(frame).unwrap();
        let (latitude, longitude) = geographic(exposure.truth.time, &exposure.truth.position_km);
        let (u, v) = ((latitude.degrees() + 26.0) / 9.0, (longitude.degrees() + 53.0) / 18.0);
        let hits = exposure.objects.iter().filter(|object| object.kind == ObjectKind::CosmicRay).count();
        match u * u + v * v {
            d if d < 2.0 => inside = (inside.0 + hits, inside.1 + 1),
            d if d > 16.0 => outside = (outside.0 + hits, outside.1 + 1),
            _ => {}
        }
    }
    // 0.35 s on 0.0137 cm²: 0.005 hits per frame outside the anomaly, 2 to 5.3 inside.
    assert!(inside.1 > 5 && outside.1 > 200, "{inside:?}, {outside:?}");
    assert!(inside.0 as f64 / inside.1 as f64 > 1.0 && (outside.0 as f64) < 0.05 * outside.1 as f64);
}
