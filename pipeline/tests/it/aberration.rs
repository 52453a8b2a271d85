//! Correction of aberration, tested on an image of stars displaced according to special relativity.

use boresight_pipeline::far_range::{AberrationConfig, FarRangeConfig, FarRangeFactory, Mode, Weights};
use contract::{
    AttitudeSource, CameraFrame, Direction, Frame, Icrs, ListedStar, PipelineFactory, Rotation, Setup,
    Telemetry,
};
use hifitime::Epoch;
use nalgebra::Vector3;

use crate::table_1::{COLUMNS, ROWS, camera, pixel};

/// Attitude with the boresight along the x axis of the sky, perpendicular to the motion of the Earth at the
/// time of [`telemetry`].
fn camera_from_icrs() -> Rotation<CameraFrame, Icrs> {
    Rotation::from_axes(&Vector3::y(), &Vector3::z(), &Vector3::x())
}

/// Grid of stars over the field, each displaced by up to a quarter of a step so that the pattern is unique.
fn stars() -> Vec<ListedStar> {
    let jitter = |k: u32, salt: u32| f64::from((k * 7919 + salt * 104_729) % 97) / 97.0 - 0.5;
    let direction = |k: u32| {
        let x = 0.04 * (f64::from(k % 7) - 3.0 + 0.5 * jitter(k, 1));
        let y = 0.035 * (f64::from(k / 7) - 2.5 + 0.5 * jitter(k, 2));
        camera_from_icrs().inverse() * Direction::from_vector(Vector3::new(x, y, 1.0)).unwrap()
    };
    (0..42).map(|k| ListedStar { id: k, direction: direction(k), magnitude: 4.0 }).collect()
}

/// Telemetry at the March equinox of 2012: the Sun appears at the ecliptic longitude 0, so that the Earth
/// moves towards 270°.
fn telemetry() -> Telemetry {
    Telemetry {
        time: Epoch::from_gregorian_utc(2012, 3, 20, 5, 14, 0, 0),
        exposure_s: 0.25,
        body_from_icrs: Rotation::from_unit_quaternion(*camera_from_icrs().quaternion()),
        velocity_km_s: Some(Vector3::new(0.0, -7.0, 3.0)),
    }
}

/// Velocity of the camera from the Earth's mean speed of 29.78 km/s and the obliquity of 23.44°.
fn velocity_km_s() -> Vector3<f64> {
    telemetry().velocity_km_s.unwrap() - 29.78 * Vector3::new(0.0, 0.9175, 0.3978)
}

/// Image with the stars at their apparent positions: s + v/c, normalised, correct to the square of v/c (2
/// mas).
fn image() -> Vec<u16> {
    let mut dn = vec![100.0; COLUMNS * ROWS];
    for star in stars() {
        let seen = (star.direction.vector() + velocity_km_s() / 299_792.458).normalize();
        let at = pixel(camera_from_icrs().rotate(&seen));
        for y in at.y as usize - 5..at.y as usize + 7 {
            for x in at.x as usize - 5..at.x as usize + 7 {
                let (dx, dy) = (x as f64 - at.x, y as f64 - at.y);
                dn[y * COLUMNS + x] += 600.0 * libm::exp(-(dx * dx + dy * dy) / (2.0 * 0.64));
            }
        }
    }
    dn.iter().map(|value| value.round() as u16).collect()
}

/// Angle between the boresight that the pipeline finds and the true boresight, arcsec.
fn error_arcsec(aberration: AberrationConfig) -> f64 {
    let config = FarRangeConfig {
        mode: Mode::Paper,
        aberration,
        weights: Weights::AboveBackground,
        ..FarRangeConfig::default()
    };
    let setup = Setup {
        camera: camera(),
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: stars(),
    };
    let mut pipeline = FarRangeFactory::new(config).unwrap().build(&setup).unwrap();
    let outcome = pipeline.process(&Frame::new(0, COLUMNS, ROWS, 12, image(), None).unwrap(), &telemetry());
    assert_eq!(outcome.attitude_source, Some(AttitudeSource::Stars));
    let found = outcome.camera_from_icrs.unwrap().inverse() * Direction::z();
    found.separation(&(camera_from_icrs().inverse() * Direction::z())).arcsec()
}

#[test]
fn the_correction_takes_the_aberration_out_and_without_it_the_boresight_is_off_by_v_over_c() {
    // Errors: the brightness centres of 42 stars, some hundredths of 87″ each; the Earth's speed, up to 1.7 %
    // (0.3″) from its mean; its direction, up to 1° (0.4″) from that of a circular orbit.
    let tolerance_arcsec = 1.5;
    let across = velocity_km_s() - Vector3::x() * velocity_km_s().x;
    let expected = (across.norm() / 299_792.458).to_degrees() * 3600.0;
    let ignored = error_arcsec(AberrationConfig::Ignore);
    assert!((ignored - expected).abs() < tolerance_arcsec, "{ignored}″, expected {expected}″");
    let corrected = error_arcsec(AberrationConfig::Correct);
    assert!(corrected < tolerance_arcsec, "{corrected}″ of {expected}″ are left");
}
