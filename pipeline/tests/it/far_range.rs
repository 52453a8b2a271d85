//! The far-range pipeline on short synthetic sequences: stars that move with the attitude, a target that
//! creeps, a stationary hotspot.

use boresight_pipeline::far_range::{
    AberrationConfig, AttitudeConfig, FarRangeConfig, FarRangeFactory, FarRangePipeline, HotspotConfig,
    Identity, Mode, Overrides, Weights,
};
use contract::{
    AttitudeSource, Body, Camera, CameraFrame, Direction, FarRange, Frame, Icrs, Label, ListedStar,
    NoSolution, Outcome, Pipeline, PipelineFactory, PixelPoint, Readout, Rotation, Setup, Solution,
    Telemetry, Window, conformance,
};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;

use crate::table_1::{COLUMNS, ROWS, camera, pixel};

const INTERVAL_S: f64 = 15.0;
/// Pixel between two columns of stars, which stream along y: neither stars nor the target merge with the
/// hotspot.
const HOTSPOT: (usize, usize) = (660, 100);

fn ray(point: PixelPoint) -> Vector3<f64> {
    let (fx, fy) = (20.187e3 / 8.6, 20.187e3 / 8.3);
    Vector3::new((point.x - 395.0) / fx, (point.y - 288.0) / fy, 1.0).normalize()
}

fn nominal() -> Rotation<CameraFrame, Body> {
    Rotation::from_rotation_vector(Vector3::new(0.1, -0.2, 0.3))
}

/// True mounting, 0.03° from the nominal mounting: about 1.3 px.
fn mounting() -> Rotation<CameraFrame, Body> {
    Rotation::from_rotation_vector(Vector3::new(4e-4, -3e-4, 2e-4)) * nominal()
}

/// Attitude at frame `i`: the camera turns about its x axis by 0.3° (12 px) per frame.
fn camera_from_icrs(i: u64) -> Rotation<CameraFrame, Icrs> {
    Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(Vector3::new(0.0053 * i as f64, 0.0, 0.0))
        * Rotation::from_rotation_vector(Vector3::new(0.7, -0.4, 1.1))
}

/// Sixty stars on a jittered grid of the sky ahead, in a strip long enough for the whole sequence.
fn stars() -> Vec<ListedStar> {
    (0..60)
        .map(|k| {
            let (column, row) = (f64::from(k % 6), f64::from(k / 6));
            let jitter = |salt: u32| f64::from((k * 7919 + salt * 104_729) % 97) / 97.0;
            let x = -0.13 + 0.052 * column + 0.02 * jitter(1);
            let y = -0.30 + 0.045 * row + 0.02 * jitter(2);
            let icrs =
                camera_from_icrs(0).inverse() * Direction::from_vector(Vector3::new(x, y, 1.0)).unwrap();
            ListedStar { id: 1000 + k, direction: icrs, magnitude: 3.0 + 3.0 * jitter(3) }
        })
        .collect()
}

fn target(i: u64) -> PixelPoint {
    PixelPoint::new(290.3 + 0.8 * i as f64, 250.7 - 0.5 * i as f64)
}

/// Adds the Gaussian image of a point source, σ 0.8 px, to a frame.
fn add_point(dn: &mut [f64], at: PixelPoint, total_dn: f64) {
    for y in (at.y - 5.0).max(0.0) as usize..(at.y + 6.0).clamp(0.0, ROWS as f64) as usize {
        for x in (at.x - 5.0).max(0.0) as usize..(at.x + 6.0).clamp(0.0, COLUMNS as f64) as usize {
            let r2 = (x as f64 - at.x) * (x as f64 - at.x) + (y as f64 - at.y) * (y as f64 - at.y);
            dn[y * COLUMNS + x] += total_dn / (std::f64::consts::TAU * 0.64) * libm::exp(-r2 / (2.0 * 0.64));
        }
    }
}

fn telemetry(i: u64) -> Telemetry {
    Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25) + Unit::Second * (INTERVAL_S * i as f64),
        exposure_s: 0.25,
        body_from_icrs: mounting().inverse() * camera_from_icrs(i),
        velocity_km_s: Some(Vector3::new(7.5, 0.0, 0.0)),
    }
}

fn image(i: u64) -> Vec<u16> {
    // Background of 100 ± 1 DN in a fixed pattern that forms no cluster.
    let mut dn: Vec<f64> =
        (0..COLUMNS * ROWS).map(|k| 100.0 + ((k * 31 + i as usize) % 3) as f64 - 1.0).collect();
    for star in stars() {
        let seen = camera_from_icrs(i).rotate(star.direction.vector());
        let at = pixel(seen);
        if seen.z > 0.0 && at.is_on_detector(COLUMNS, ROWS) {
            add_point(&mut dn, at, 4000.0 * libm::pow(10.0, -0.4 * (star.magnitude - 3.0)) + 1000.0);
        }
    }
    add_point(&mut dn, target(i), 3000.0);
    dn[HOTSPOT.1 * COLUMNS + HOTSPOT.0] += 1500.0;
    dn.iter().map(|v| v.round().min(4095.0) as u16).collect()
}

fn frame(i: u64) -> Frame {
    Frame::new(i, COLUMNS, ROWS, 12, image(i), None).unwrap()
}

fn flat(i: u64, level: u16) -> Frame {
    Frame::new(i, COLUMNS, ROWS, 12, vec![level; COLUMNS * ROWS], None).unwrap()
}

fn setup() -> Setup {
    Setup {
        camera: camera(),
        camera_from_body: nominal(),
        bit_depth: 12,
        readout: Some(READOUT),
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: stars(),
    }
}

const READOUT: Readout =
    Readout { gain_e_per_dn: 10.0, bias_dn: 90.0, read_noise_e: 10.0, saturation_dn: 4095 };

/// Configuration of the best mode.
fn best() -> FarRangeConfig {
    FarRangeConfig { mode: Mode::Best, ..config() }
}

/// Configuration of the paper's mode. The hotspot is listed; the sequence has no aberration.
fn config() -> FarRangeConfig {
    FarRangeConfig {
        mode: Mode::Paper,
        weights: Weights::AboveBackground,
        hotspots: HotspotConfig::List { pixels: vec![(HOTSPOT.0 as u32, HOTSPOT.1 as u32)] },
        aberration: AberrationConfig::Ignore,
        ..FarRangeConfig::default()
    }
}

fn pipeline(config: FarRangeConfig, setup: &Setup) -> Box<dyn Pipeline<FarRange>> {
    FarRangeFactory::new(config).unwrap().build(setup).unwrap()
}

fn run(config: FarRangeConfig, frames: u64) -> Vec<Outcome> {
    let mut pipeline = pipeline(config, &setup());
    (0..frames).map(|i| pipeline.process(&frame(i), &telemetry(i))).collect()
}

fn is_target(outcome: &Outcome, i: u64) -> bool {
    outcome.measurement().is_some_and(|measurement| measurement.position.distance(target(i)) < 0.5)
}

fn none(outcome: &Outcome) -> Option<&NoSolution> {
    match &outcome.solution {
        Solution::NoSolution(reason) => Some(reason),
        Solution::Detected(_) => None,
    }
}

fn label_at(outcome: &Outcome, at: PixelPoint) -> Option<Label> {
    outcome.clusters.iter().find(|cluster| cluster.position.distance(at) < 1.0).map(|cluster| cluster.label)
}

#[test]
fn the_target_is_found_in_every_frame_but_the_first() {
    let outcomes = run(config(), 8);
    assert_eq!(none(&outcomes[0]), Some(&NoSolution::NoPreviousFrame));
    for (outcome, i) in outcomes.iter().zip(0..).skip(1) {
        let measurement =
            outcome.measurement().unwrap_or_else(|| panic!("frame {i}: {:?}", outcome.solution));
        // The threshold cuts off the tails of the image in steps of a pixel: an error of a few hundredths of
        // a pixel.
        let error = measurement.position.distance(target(i));
        assert!(error < 0.05, "frame {i}: {error} px");
        assert_eq!(label_at(outcome, target(i)), Some(Label::Target));
        let hotspot = PixelPoint::new(HOTSPOT.0 as f64, HOTSPOT.1 as f64);
        assert_eq!(label_at(outcome, hotspot), Some(Label::Hotspot));
    }
}

#[test]
fn every_star_in_the_frame_gets_its_own_number() {
    for (outcome, i) in run(config(), 4).iter().zip(0..) {
        let mut well_inside = 0;
        for star in stars() {
            let at = pixel(camera_from_icrs(i).rotate(star.direction.vector()));
            if (4.0..COLUMNS as f64 - 5.0).contains(&at.x) && (4.0..ROWS as f64 - 5.0).contains(&at.y) {
                assert_eq!(label_at(outcome, at), Some(Label::Star(star.id)), "frame {i} at {at:?}");
                well_inside += 1;
            }
        }
        assert!(well_inside > 20, "a sequence without stars says nothing");
        assert!(outcome.n_stars >= Some(well_inside));
    }
}

#[test]
fn the_stars_take_the_error_out_of_the_mounting() {
    for (outcome, i) in run(config(), 4).iter().zip(0..) {
        assert_eq!(outcome.attitude_source, Some(AttitudeSource::Stars));
        let attitude = outcome.camera_from_icrs.unwrap();
        // The mounting is off by 111″. Centroids are accurate to some hundredths of a pixel of 87″, over 20
        // stars; roll is ten times worse, by the inverse of the field.
        assert!(attitude.angle_to(&camera_from_icrs(i)).arcsec() < 10.0);
        // The first frame has no previous frame by which to identify the target.
        if i > 0 {
            let measurement = outcome.measurement().unwrap();
            let truth = camera_from_icrs(i).inverse() * Direction::from_unit(ray(target(i)));
            let error = measurement.line_of_sight.unwrap().separation(&truth);
            assert!(error.arcsec() < 5.0, "{}″", error.arcsec());
        }
    }
}

#[test]
fn without_enough_stars_the_nominal_mounting_is_used() {
    let few = FarRangeConfig {
        attitude: AttitudeConfig { min_stars: 1000, ..AttitudeConfig::default() },
        ..config()
    };
    let no_list = Setup { stars: Vec::new(), ..setup() };
    let cases = [
        (pipeline(few, &setup()), AttitudeSource::TooFewStars),
        (pipeline(config(), &no_list), AttitudeSource::NoStars),
    ];
    for (mut pipeline, source) in cases {
        let outcome = pipeline.process(&frame(0), &telemetry(0));
        assert_eq!(outcome.attitude_source, Some(source));
        let expected = nominal() * telemetry(0).body_from_icrs;
        assert_eq!(outcome.camera_from_icrs, Some(expected));
    }
}

#[test]
fn a_hotspot_wins_until_it_is_old_enough_to_be_known() {
    let hotspots =
        HotspotConfig::Automatic { n_min: 3, v_min_px_per_s: 0.001, n_max: Some(10), keep_pixels: true };
    let outcomes = run(FarRangeConfig { hotspots, ..config() }, 8);
    // Stars move by 12 px, the target by 0.9 px, the hotspot by 0: the hotspot differs most. At frame 4 it is
    // linked back over four frames, N = 4 > 3.
    for (outcome, i) in outcomes.iter().zip(0..) {
        assert_eq!(is_target(outcome, i), i >= 4, "frame {i}: {:?}", outcome.solution);
    }
}

#[test]
fn an_empty_or_saturated_frame_is_reported_and_tracks_continue_across_it() {
    for (level, reason) in
        [(0, NoSolution::EmptyFrame), (300, NoSolution::EmptyFrame), (4095, NoSolution::SaturatedFrame)]
    {
        let mut pipeline = pipeline(config(), &setup());
        pipeline.process(&frame(0), &telemetry(0));
        assert_eq!(none(&pipeline.process(&flat(1, level), &telemetry(1))), Some(&reason));
        let next = pipeline.process(&frame(2), &telemetry(2));
        assert!(is_target(&next, 2), "{:?}", next.solution);
    }
}

#[test]
fn tracking_starts_anew_after_a_gap_and_when_time_does_not_advance() {
    let hours = Telemetry { time: telemetry(0).time + Unit::Hour * 5, ..telemetry(1) };
    let before = Telemetry { time: telemetry(0).time - Unit::Hour * 5, ..telemetry(1) };
    let same = Telemetry { time: telemetry(0).time, ..telemetry(1) };
    for told in [hours, before, same] {
        let mut pipeline = pipeline(config(), &setup());
        pipeline.process(&frame(0), &telemetry(0));
        assert_eq!(none(&pipeline.process(&frame(1), &told)), Some(&NoSolution::NoPreviousFrame));
    }
}

#[test]
fn a_frame_of_another_camera_fails() {
    let mut pipeline = pipeline(config(), &setup());
    let small = Frame::new(0, 10, 10, 12, vec![0; 100], None).unwrap();
    let outcome = pipeline.process(&small, &telemetry(0));
    assert_eq!(none(&outcome).unwrap().code(), "failed");
}

#[test]
fn telemetry_that_is_not_a_number_does_no_harm() {
    let mut pipeline =
        pipeline(FarRangeConfig { aberration: AberrationConfig::Correct, ..config() }, &setup());
    let velocity = Telemetry { velocity_km_s: Some(Vector3::repeat(f64::NAN)), ..telemetry(0) };
    let outcome = pipeline.process(&frame(0), &velocity);
    assert!(outcome.camera_from_icrs.unwrap().quaternion().norm().is_finite());
    let not_a_number =
        nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 0.0));
    let attitude = Telemetry { body_from_icrs: Rotation::from_unit_quaternion(not_a_number), ..telemetry(1) };
    assert_eq!(none(&pipeline.process(&frame(1), &attitude)).unwrap().code(), "failed");
    assert!(is_target(&pipeline.process(&frame(2), &telemetry(2)), 2));
}

#[test]
fn windows_alone_are_enough() {
    let mut pipeline = pipeline(config(), &setup());
    let windowed = |i: u64| {
        let full = image(i);
        let mut centres: Vec<PixelPoint> =
            stars().iter().map(|star| pixel(camera_from_icrs(i).rotate(star.direction.vector()))).collect();
        centres.push(target(i));
        let windows: Vec<Window> = centres
            .iter()
            .filter(|at| {
                at.x > 12.0 && at.y > 12.0 && at.x < COLUMNS as f64 - 12.0 && at.y < ROWS as f64 - 12.0
            })
            .map(|at| Window { x: at.x as usize - 10, y: at.y as usize - 10, columns: 21, rows: 21 })
            .collect();
        let sent = |k: usize| windows.iter().any(|window| window.contains(k % COLUMNS, k / COLUMNS));
        let dn = full.iter().enumerate().map(|(k, &dn)| if sent(k) { dn } else { 0 }).collect();
        Frame::new(i, COLUMNS, ROWS, 12, dn, Some(windows)).unwrap()
    };
    for i in 0..3 {
        let outcome = pipeline.process(&windowed(i), &telemetry(i));
        assert_eq!(outcome.attitude_source, Some(AttitudeSource::Stars));
        assert_eq!(is_target(&outcome, i), i > 0, "frame {i}: {:?}", outcome.solution);
    }
}

#[test]
fn the_far_range_pipeline_keeps_the_contract() {
    for hotspots in [HotspotConfig::default(), HotspotConfig::Off] {
        let factory = FarRangeFactory::new(FarRangeConfig { hotspots, ..config() }).unwrap();
        assert_eq!(conformance::check(&factory, &setup()), Ok(()));
        let distorted = Camera { radial: [2.6e-8, 0.0, 0.0], ..camera() };
        assert_eq!(conformance::check(&factory, &Setup { camera: distorted, ..setup() }), Ok(()));
        let tiny = Camera { columns: 1, rows: 1, principal_x_px: 0.0, principal_y_px: 0.0, ..camera() };
        assert_eq!(conformance::check(&factory, &Setup { camera: tiny, bit_depth: 1, ..setup() }), Ok(()));
    }
}

#[test]
fn the_best_mode_finds_the_same_targets_more_accurately() {
    let (paper, best) = (run(config(), 6), run(best(), 6));
    let worst = |outcomes: &[Outcome]| {
        (1..6).fold(0.0, |most: f64, i| {
            let measurement = outcomes[i as usize].measurement();
            most.max(measurement.map_or(f64::INFINITY, |found| found.position.distance(target(i))))
        })
    };
    // These images are sampled at pixel centres, not integrated over pixels; with a free width this makes no
    // difference. The remaining error comes from the pattern of ±1 DN and the rounding.
    assert!(worst(&best) < 0.01 && worst(&best) < 0.5 * worst(&paper), "{} {}", worst(&best), worst(&paper));
    for (best, i) in best.iter().zip(0..) {
        // In the first frame no motion distinguishes it from a star that the list lacks.
        assert_eq!(is_target(best, i), i > 0, "frame {i}: {:?}", best.solution);
        let error = best.camera_from_icrs.unwrap().angle_to(&camera_from_icrs(i)).arcsec();
        assert!(error < 0.5, "frame {i}: {error}″");
        if let Some(measurement) = best.measurement() {
            let covariance = measurement.line_of_sight_covariance.unwrap();
            assert!(covariance.sigma_x().to_degrees() * 3600.0 < 1.0, "{covariance:?}");
        }
    }
}

#[test]
fn the_best_mode_keeps_the_contract() {
    let factory = FarRangeFactory::new(FarRangeConfig { hotspots: HotspotConfig::Off, ..best() }).unwrap();
    assert_eq!(conformance::check(&factory, &setup()), Ok(()));
    let tiny = Camera { columns: 1, rows: 1, principal_x_px: 0.0, principal_y_px: 0.0, ..camera() };
    assert_eq!(conformance::check(&factory, &Setup { camera: tiny, bit_depth: 1, ..setup() }), Ok(()));
}

#[test]
fn a_calibration_that_cannot_be_is_refused_by_name() {
    let wrong = Setup { readout: Some(Readout { gain_e_per_dn: 0.0, ..READOUT }), ..setup() };
    let error = FarRangePipeline::new(best(), &wrong).unwrap_err().to_string();
    assert_eq!(error, "readout.gain_e_per_dn is 0, expected 0.001 to 1e6");
    let calibration = contract::Calibration { full_well_e: Some(0.0), ..Default::default() };
    let error = FarRangePipeline::new(best(), &Setup { calibration, ..setup() }).unwrap_err().to_string();
    assert_eq!(error, "calibration.full_well_e is 0, expected 1 to 1e9");
}

#[test]
fn a_given_attitude_predicts_tracks_and_points_instead_of_the_mounting() {
    let mut pipeline = FarRangePipeline::new(config(), &setup()).unwrap();
    for i in 0..3 {
        // Telemetry attitude wrong by 18°, more than the height of the field: it allows no identification and
        // no tracking.
        let wrong = Telemetry { body_from_icrs: telemetry(60).body_from_icrs, ..telemetry(i) };
        let overrides = Overrides { camera_from_icrs: Some(camera_from_icrs(i)), ..Overrides::default() };
        let outcome = pipeline.process_with(&frame(i), &wrong, &overrides);
        assert_eq!(outcome.camera_from_icrs, Some(camera_from_icrs(i)));
        assert!(outcome.n_stars > Some(20));
        assert_eq!(is_target(&outcome, i), i > 0, "frame {i}: {:?}", outcome.solution);
        if let Some(measurement) = outcome.measurement() {
            let expected = camera_from_icrs(i).inverse() * Direction::from_unit(ray(measurement.position));
            assert!(measurement.line_of_sight.unwrap().separation(&expected).arcsec() < 1e-6);
        }
    }
}

#[test]
fn given_identities_and_centres_replace_those_of_the_pipeline() {
    let mut pipeline =
        FarRangePipeline::new(FarRangeConfig { hotspots: HotspotConfig::Off, ..config() }, &setup()).unwrap();
    for i in 0..3 {
        // The target is declared a hotspot, and the hotspot neither star nor hotspot: the pipeline then
        // reports the hotspot as the target.
        let identity = |centre: PixelPoint| {
            if centre.distance(target(i)) < 1.0 {
                Identity::Hotspot
            } else if centre.distance(PixelPoint::new(HOTSPOT.0 as f64, HOTSPOT.1 as f64)) < 1.0 {
                Identity::Neither
            } else {
                Identity::Star(1)
            }
        };
        let moved = |centre: PixelPoint| (centre.distance(target(i)) < 1.0).then(|| target(i));
        let overrides =
            Overrides { identity: Some(&identity), centroid: Some(&moved), ..Overrides::default() };
        let outcome = pipeline.process_with(&frame(i), &telemetry(i), &overrides);
        assert_eq!(outcome.clusters.iter().find(|c| c.position == target(i)).unwrap().label, Label::Hotspot);
        let found = outcome.measurement().map(|found| found.position.x.round() as usize);
        assert_eq!(found, (i > 0).then_some(HOTSPOT.0));
    }
}

#[test]
fn given_apparent_positions_are_not_corrected_for_aberration() {
    let setup = setup();
    let corrected = FarRangeConfig { aberration: AberrationConfig::Correct, ..config() };
    let apparent = |star: &ListedStar| star.direction;
    let overrides = Overrides { apparent: Some(&apparent), ..Overrides::default() };
    let process = |config: &FarRangeConfig, overrides: &Overrides<'_>| {
        FarRangePipeline::new(config.clone(), &setup).unwrap().process_with(
            &frame(0),
            &telemetry(0),
            overrides,
        )
    };
    let ignored = process(&config(), &Overrides::default());
    assert_eq!(process(&corrected, &overrides), ignored);
    assert_ne!(process(&corrected, &Overrides::default()), ignored);
}
