//! The best mode without a prior attitude, on synthetic images: the stars give the attitude, independently of
//! the telemetry.

use boresight_pipeline::far_range::{
    AberrationConfig, AttitudePrior, BestConfig, FarRangeConfig, FarRangePipeline, Mode,
};
use contract::{
    AttitudeSource, CameraFrame, Direction, Frame, Icrs, ListedStar, Outcome, Pipeline, Rotation, Setup,
    Telemetry,
};
use hifitime::Epoch;
use nalgebra::Vector3;

use crate::table_1::{COLUMNS, ROWS, camera, pixel};

/// Star list of 20,000 stars on a spiral from pole to pole (Saff & Kuijlaars 1997), jittered; magnitudes 2 to
/// 7, with more faint stars than bright ones.
fn sky() -> Vec<ListedStar> {
    let fraction = |v: f64| v - v.floor();
    (0..20_000_u32)
        .map(|k| {
            let n = f64::from(k);
            let (a, b, c) = (
                fraction(n * 0.754_877_666),
                fraction(n * n * 0.569_840_291),
                fraction(n * n * 0.618_033_989),
            );
            let (z, angle) = (1.0 - 2.0 * (n + a) / 20_000.0, std::f64::consts::TAU * b);
            let (sin, cos) = libm::sincos(angle);
            let across = (1.0 - z * z).max(0.0).sqrt();
            let direction = Direction::from_vector(Vector3::new(across * cos, across * sin, z)).unwrap();
            ListedStar { id: k, direction, magnitude: 2.0 + 5.0 * c.sqrt() }
        })
        .collect()
}

fn setup() -> Setup {
    Setup {
        camera: camera(),
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: sky(),
    }
}

fn pipeline(prior: AttitudePrior) -> FarRangePipeline {
    let config = FarRangeConfig {
        mode: Mode::Best,
        aberration: AberrationConfig::Ignore,
        best: BestConfig { sequence: false, prior, ..BestConfig::default() },
        ..FarRangeConfig::default()
    };
    FarRangePipeline::new(config, &setup()).unwrap()
}

/// Frame with Gaussian stars of σ 0.8 px on a background of 40 and 41 DN.
fn image(attitude: Rotation<CameraFrame, Icrs>) -> Frame {
    let mut dn: Vec<f64> = (0..COLUMNS * ROWS).map(|i| 40.0 + (i * 7919 % 2) as f64).collect();
    for star in sky() {
        let seen = attitude * star.direction;
        let Some(centre) = (seen.vector().z > 0.8).then(|| pixel(*seen.vector())) else { continue };
        let flux = 4e5 * libm::pow(10.0, -0.4 * star.magnitude);
        for y in (centre.y - 5.0).ceil().max(0.0) as usize..(centre.y + 5.0).clamp(0.0, ROWS as f64) as usize
        {
            for x in (centre.x - 5.0).ceil().max(0.0) as usize
                ..(centre.x + 5.0).clamp(0.0, COLUMNS as f64) as usize
            {
                let (dx, dy) = ((x as f64 - centre.x) / 0.8, (y as f64 - centre.y) / 0.8);
                dn[y * COLUMNS + x] +=
                    flux * libm::exp(-0.5 * (dx * dx + dy * dy)) / (0.64 * std::f64::consts::TAU);
            }
        }
    }
    let dn = dn.into_iter().map(|dn| dn.round().min(4095.0) as u16).collect();
    Frame::new(0, COLUMNS, ROWS, 12, dn, None).unwrap()
}

fn process(prior: AttitudePrior, frame: &Frame) -> Outcome {
    let telemetry = Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
        exposure_s: 0.25,
        body_from_icrs: Rotation::identity(),
        velocity_km_s: None,
    };
    pipeline(prior).process(frame, &telemetry)
}

fn attitudes() -> impl Iterator<Item = Rotation<CameraFrame, Icrs>> {
    (0..6).map(|k| {
        let k = f64::from(k);
        Rotation::from_rotation_vector(Vector3::new(0.4 + 0.9 * k, 1.3 - 0.5 * k, 2.0 - 0.3 * k))
    })
}

#[test]
fn the_stars_give_the_attitude_that_telemetry_does_not() {
    for attitude in attitudes() {
        let outcome = process(AttitudePrior::None, &image(attitude));
        assert_eq!(outcome.attitude_source, Some(AttitudeSource::Stars));
        let error = outcome.camera_from_icrs.unwrap().angle_to(&attitude).degrees() * 3600.0;
        // Twelve stars with an error of 0.05 px each, about 200 px from the image centre: 15″ about the
        // boresight.
        assert!(error < 45.0, "{error} arcsec");
    }
}

/// Confirms that the attitudes of the test above are not those of the telemetry.
#[test]
fn about_a_false_prior_the_same_images_have_no_true_attitude() {
    for attitude in attitudes() {
        let outcome = process(AttitudePrior::Telemetry, &image(attitude));
        // Many listed stars must have an image about the prior, and none has: no attitude is stated.
        assert_eq!((outcome.camera_from_icrs, outcome.n_stars), (None, Some(0)), "{attitude:?}");
        assert_eq!(outcome.attitude_source, Some(AttitudeSource::NoMatch));
    }
}

#[test]
fn a_frame_without_stars_has_no_attitude() {
    let mut dn: Vec<u16> = (0..COLUMNS * ROWS).map(|i| 40 + (i * 7919 % 2) as u16).collect();
    // Three sources of 3 × 3 pixels each.
    for (x, y) in [(100, 100), (400, 300), (600, 200)] {
        for i in 0..9 {
            dn[(y + i / 3) * COLUMNS + x + i % 3] = 300;
        }
    }
    let outcome = process(AttitudePrior::None, &Frame::new(0, COLUMNS, ROWS, 12, dn, None).unwrap());
    assert_eq!(outcome.attitude_source, Some(AttitudeSource::TooFewStars));
    assert_eq!((outcome.camera_from_icrs, outcome.n_stars), (None, Some(0)));
    if let contract::Solution::Detected(target) = outcome.solution {
        assert_eq!((target.line_of_sight, target.line_of_sight_covariance), (None, None));
    }
}
