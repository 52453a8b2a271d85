//! A dataset from writing to reading, and the invalid inputs that are rejected.

use std::fs;
use std::path::Path;

use boresight::far_range::rows::{CameraFile, Dataset, TelemetryLine, TelemetryRow, TelemetryWriter};
use boresight::files::{FrameHeader, ImageFormat, RunDirectory, parse_utc, write_frame};
use contract::{
    AttitudeKnowledge, Calibration, Camera, Frame, Mounting, PsfCalibration, Readout, Rotation, Telemetry,
    Window,
};
use hifitime::Unit;
use nalgebra::Vector3;
use tempfile::{TempDir, tempdir};

fn camera_file() -> CameraFile {
    CameraFile {
        bit_depth: 10,
        magnitude_limit: 7.0,
        star_epoch_utc: None,
        readout: Some(Readout {
            gain_e_per_dn: 10.0,
            bias_dn: 40.3,
            read_noise_e: 15.0,
            saturation_dn: 1020,
        }),
        calibration: Calibration {
            psf: Some(PsfCalibration { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.0434 }),
            full_well_e: Some(41_000.5),
            target: Some(contract::TargetCalibration { radius_m: 0.5, e_per_s_at_1_km: 1e9 }),
            attitude: Some(AttitudeKnowledge {
                white_arcsec: [53.5; 3],
                slow_arcsec: [20.0, 0.1, 0.0],
                slow_period_s: 3100.0,
                constant_arcsec: [180.6, 180.0, 181.1],
            }),
            ..Calibration::default()
        },
        zero_suppression_dn: Some(40),
        camera: Camera {
            columns: 24,
            rows: 16,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 12.0,
            principal_y_px: 8.0,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [0.0; 2],
        },
        mounting: Mounting { phi_deg: 1.0, theta_deg: -2.0, psi_deg: 0.1 },
        far_range: Default::default(),
    }
}

fn frame(number: u64) -> Frame {
    let dn = (0..24 * 16).map(|i| ((i + number * 31) % 1024) as u16).collect();
    let windows = (number % 2 == 1).then(|| vec![Window { x: 3, y: 4, columns: 8, rows: 8 }]);
    Frame::new(number, 24, 16, 10, dn, windows).unwrap()
}

fn row(number: u64, format: ImageFormat) -> TelemetryRow {
    TelemetryRow {
        frame: number,
        file: Some(RunDirectory::frame_name(number, format)),
        telemetry: Telemetry {
            time: parse_utc("2012-04-25T12:00:00Z").unwrap() + Unit::Second * (15 * number as i64),
            exposure_s: 0.25,
            body_from_icrs: Rotation::from_rotation_vector(Vector3::new(0.1, number as f64, 2.0)),
            velocity_km_s: None,
        },
        windows: frame(number).windows().map(<[Window]>::to_vec),
    }
}

const NUMBERS: [u64; 3] = [3, 4, 9];

/// Writes a dataset with a gap between its frames.
fn dataset(format: ImageFormat) -> (TempDir, RunDirectory) {
    let parent = tempdir().unwrap();
    let run = RunDirectory::create(&parent.path().join("set")).unwrap();
    camera_file().write(&run.camera()).unwrap();
    let mut telemetry = TelemetryWriter::create(&run.telemetry()).unwrap();
    for number in NUMBERS {
        let row = row(number, format);
        telemetry.line(&TelemetryLine::from(&row)).unwrap();
        let header = FrameHeader {
            time: row.telemetry.time,
            exposure_s: row.telemetry.exposure_s,
            gain_e_per_dn: None,
            seed: 1,
            version: "0.1.0".to_owned(),
            configuration_hash: String::new(),
            observer_velocity_km_s: None,
            wcs: None,
        };
        write_frame(&run.frame(number, format), format, &frame(number), &header).unwrap();
    }
    telemetry.finish().unwrap();
    (parent, run)
}

fn refusal(directory: &Path) -> String {
    Dataset::open(directory).unwrap_err().to_string()
}

/// Replaces a text in a file that contains it.
fn edit(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{text}");
    fs::write(path, text.replace(from, to)).unwrap();
}

#[test]
fn a_dataset_of_every_format_round_trips() {
    for format in ImageFormat::ALL {
        let (_parent, run) = dataset(format);
        let dataset = Dataset::open(run.path()).unwrap();
        assert_eq!(dataset.camera(), &camera_file());
        assert_eq!(dataset.star_epoch(), Some(row(3, format).telemetry.time));
        assert_eq!(dataset.frames().len(), NUMBERS.len());
        for (entry, number) in dataset.frames().iter().zip(NUMBERS) {
            assert_eq!(entry.telemetry(), &row(number, format).telemetry);
            assert_eq!(dataset.read(entry).unwrap(), frame(number));
        }
    }
}

#[test]
fn a_missing_image_is_named_with_its_frame() {
    let (_parent, run) = dataset(ImageFormat::Png);
    fs::remove_file(run.frame(4, ImageFormat::Png)).unwrap();
    let message = refusal(run.path());
    assert!(
        message.contains("line 3") && message.contains("`frames/000004.png` of frame 4 is missing"),
        "{message}"
    );
}

#[test]
fn an_image_that_is_not_named_is_an_error() {
    let (_parent, run) = dataset(ImageFormat::Png);
    edit(&run.telemetry(), "frames/000004.png", "");
    assert!(refusal(run.path()).contains("of frame 4 is not named"));
}

#[test]
fn a_run_without_images_is_refused_with_the_remedy() {
    let (_parent, run) = dataset(ImageFormat::Png);
    for number in NUMBERS {
        edit(&run.telemetry(), &format!("frames/{number:06}.png"), "");
    }
    let message = refusal(run.path());
    assert!(
        message.contains("`file` is `empty in every row`") && message.contains("--save-frames"),
        "{message}"
    );
}

#[test]
fn no_image_outside_the_directory_is_read() {
    let elsewhere = ["../secret.png", "/etc/hostname", "frames/../../secret.png"];
    for outside in elsewhere {
        let (parent, run) = dataset(ImageFormat::Png);
        fs::copy(run.frame(4, ImageFormat::Png), parent.path().join("secret.png")).unwrap();
        edit(&run.telemetry(), "frames/000004.png", outside);
        assert!(refusal(run.path()).contains("outside the dataset's directory"));
    }
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_outside_is_not_followed() {
    let (parent, run) = dataset(ImageFormat::Png);
    let (inside, outside) = (run.frame(4, ImageFormat::Png), parent.path().join("secret.png"));
    fs::rename(&inside, &outside).unwrap();
    std::os::unix::fs::symlink(&outside, &inside).unwrap();
    assert!(refusal(run.path()).contains("outside the dataset's directory"));
}

#[test]
fn an_image_of_another_size_is_refused() {
    let (_parent, run) = dataset(ImageFormat::Png);
    edit(&run.camera(), "rows = 16", "rows = 17");
    let dataset = Dataset::open(run.path()).unwrap();
    let message = dataset.read(&dataset.frames()[0]).unwrap_err().to_string();
    assert!(message.contains("`24 × 16`, expected 24 × 17"), "{message}");
}

#[test]
fn a_bad_camera_file_names_the_field() {
    let check = |from: &str, to: &str, part: &str| {
        let (_parent, run) = dataset(ImageFormat::Png);
        edit(&run.camera(), from, to);
        let message = refusal(run.path());
        assert!(message.contains("camera.toml") && message.contains(part), "{message}");
    };
    check("bit_depth = 10", "bit_depth = 17", "bit_depth: is 17, expected 1 to 16");
    check("bit_depth = 10", "", "missing field `bit_depth`");
    check("bit_depth = 10", "bit_dept = 10", "unknown field `bit_dept`");
    check("magnitude_limit = 7.0", "magnitude_limit = nan", "magnitude_limit");
    check("magnitude_limit = 7.0", "magnitude_limit = 7.0\nstar_epoch_utc = 'now'", "star_epoch_utc");
    check("focal_length_mm = 20.187", "focal_length_mm = -1.0", "camera.focal_length_mm");
    check("phi_deg = 1.0", "phi_deg = inf", "mounting.phi_deg");
    check("full_well_e = 41000.5", "full_well_e = 0.0", "calibration.full_well_e");
    check("full_well_e = 41000.5", "full_wel_e = 41000.5", "unknown field `full_wel_e`");
    check("sigma_px = 0.8", "sigma_px = nan", "calibration.psf.sigma_px");
    check("radius_m = 0.5", "radius_m = -0.5", "calibration.target.radius_m");
}

#[test]
fn a_directory_without_a_dataset_is_reported_with_the_missing_file() {
    let empty = tempdir().unwrap();
    assert!(refusal(empty.path()).contains("camera.toml"));
}
