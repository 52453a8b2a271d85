//! The written files read with independent readers: astropy, pyarrow, Pillow.

use std::process::Command;

use boresight::far_range::rows::{
    FrameTruthRow, ObjectTruthRow, TelemetryLine, TelemetryRow, TelemetryWriter,
};
use boresight::files::{FrameHeader, ImageFormat, RunDirectory, TableWriter, TanSip, parse_utc, write_frame};
use contract::{Angle, Body, CameraFrame, Direction, Frame, Icrs, PixelPoint, Rotation, Telemetry, Window};
use hifitime::Unit;
use nalgebra::Vector3;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
use tempfile::tempdir;

const COLUMNS: usize = 752;
const ROWS: usize = 580;
const PRINCIPAL: PixelPoint = PixelPoint::new(395.0, 288.0);
const OBSERVER_KM_S: Vector3<f64> = Vector3::new(-17.0, 22.0, 9.5);

/// The camera of Table 1, with first-order aberration: the complete projection from the sky to the detector.
fn pixel(camera_from_icrs: &Rotation<CameraFrame, Icrs>, sky: &Direction<Icrs>) -> Option<PixelPoint> {
    let v = camera_from_icrs.rotate(&(sky.vector() + OBSERVER_KM_S / 299_792.458).normalize());
    let (x, y) = (20_187.0 / 8.6 * v.x / v.z, 20_187.0 / 8.3 * v.y / v.z);
    let factor = 1.0 + 2.6e-8 * (x * x + y * y);
    (v.z > 0.0).then(|| PixelPoint::new(PRINCIPAL.x + factor * x, PRINCIPAL.y + factor * y))
}

/// Camera attitude for a given direction, with an arbitrary roll angle.
fn camera_from_icrs(ra_deg: f64, dec_deg: f64) -> Rotation<CameraFrame, Icrs> {
    let z = *Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg)).vector();
    let x = z.cross(&Vector3::new(0.3, -0.2, 0.5)).normalize();
    Rotation::from_axes(&x, &z.cross(&x), &z)
}

/// Stars on a grid of the sky around the boresight, including those off the detector; dense enough for some
/// near the centre.
fn stars(number: u64, camera_from_icrs: &Rotation<CameraFrame, Icrs>) -> Vec<ObjectTruth> {
    let directions = (0..41 * 41).filter_map(|i| {
        let (x, y) = (f64::from(i % 41 - 20) / 20.0 * 0.17, f64::from(i / 41 - 20) / 20.0 * 0.13);
        let in_camera: Direction<CameraFrame> = Direction::from_vector(Vector3::new(x, y, 1.0)).ok()?;
        Some(camera_from_icrs.inverse() * in_camera)
    });
    let star = |(id, sky): (u32, Direction<Icrs>)| {
        Some(ObjectTruth {
            frame: number,
            kind: ObjectKind::Star,
            id,
            position: pixel(camera_from_icrs, &sky)?,
            astrometric: Some(sky),
            magnitude: Some(5.0),
            electrons: 1e4,
            peak_electrons: 1e3,
            snr: 20.0,
            radius_px: 1.5,
            bloom_px: 0.0,
            cut: 0.0,
        })
    };
    (0..).zip(directions).filter_map(star).collect()
}

fn frame_truth(row: &TelemetryRow, camera_from_icrs: Rotation<CameraFrame, Icrs>) -> FrameTruth {
    FrameTruth {
        frame: row.frame,
        group: "day 1".to_owned(),
        time: row.telemetry.time,
        exposure_s: row.telemetry.exposure_s,
        body_from_icrs: row.telemetry.body_from_icrs,
        camera_from_icrs,
        position_km: Vector3::new(7000.0, 0.0, 0.0),
        velocity_km_s: Vector3::new(0.0, 7.5, 0.0),
        line_of_sight: Direction::from_unit(Vector3::x()),
        range_km: 30.0,
        sun: Direction::from_unit(Vector3::y()),
        phase_deg: 90.0,
        shadow: Shadow::Sunlit,
        sunlit_fraction: 1.0,
        background_e_per_s: 0.0,
        smear_e_per_px: 0.0,
        target_from_icrs: None,
        target_position: None,
        target_visibility: Visibility::Invisible,
    }
}

#[test]
#[ignore = "needs Python with tests/python/requirements.txt; BORESIGHT_PYTHON names it, python3 otherwise"]
fn astropy_agrees_with_every_file() {
    let parent = tempdir().unwrap();
    let run = RunDirectory::create(&parent.path().join("set")).unwrap();
    let mut telemetry = TelemetryWriter::create(&run.telemetry()).unwrap();
    let mut frames = TableWriter::create(&run.truth_frames()).unwrap();
    let mut objects = TableWriter::create(&run.truth_objects()).unwrap();
    let pointings = [(0.001, 0.0), (120.0, 55.0), (300.0, -89.9), (45.0, 89.0)];
    for (number, (ra, dec)) in (1_u64..).zip(pointings) {
        let camera = camera_from_icrs(ra, dec);
        let row = TelemetryRow {
            frame: number,
            file: Some(RunDirectory::frame_name(number, ImageFormat::Fits)),
            telemetry: Telemetry {
                time: parse_utc("2012-04-25T12:00:00.123456789Z").unwrap()
                    + Unit::Second * (15 * number as i64),
                exposure_s: 0.25,
                body_from_icrs: Rotation::<Body, Icrs>::identity(),
                velocity_km_s: None,
            },
            windows: None,
        };
        let boresight = camera.inverse() * Direction::z();
        let header = FrameHeader {
            time: row.telemetry.time,
            exposure_s: row.telemetry.exposure_s,
            gain_e_per_dn: Some(12.5),
            seed: u64::MAX,
            version: "0.1.0".to_owned(),
            configuration_hash: "0123456789abcdef".repeat(4),
            observer_velocity_km_s: Some(OBSERVER_KM_S),
            wcs: Some(TanSip::fit(COLUMNS, ROWS, PRINCIPAL, boresight, |sky| pixel(&camera, sky)).unwrap()),
        };
        let dn = (0..COLUMNS * ROWS).map(|i| (i as u64 * 7919 * number % 65536) as u16).collect();
        let windows = vec![Window { x: 1, y: 2, columns: 64, rows: 64 }; number as usize];
        let frame = Frame::new(number, COLUMNS, ROWS, 16, dn, Some(windows)).unwrap();
        for format in [ImageFormat::Fits, ImageFormat::Png] {
            write_frame(&run.frame(number, format), format, &frame, &header).unwrap();
        }
        telemetry.line(&TelemetryLine::from(&row)).unwrap();
        frames.write([FrameTruthRow(frame_truth(&row, camera))]).unwrap();
        objects.write(stars(number, &camera).into_iter().map(ObjectTruthRow)).unwrap();
    }
    telemetry.finish().unwrap();
    frames.finish().unwrap();
    objects.finish().unwrap();

    let python = std::env::var("BORESIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/python/check_fits.py");
    let output = Command::new(python).arg(script).arg(run.path()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    println!("{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{text}");
    assert!(text.contains("4 frames compared with PNG"), "{text}");
}
