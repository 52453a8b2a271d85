//! Files in the shapes of OpenCV, ROS and Kalibr, and files that are refused.

use std::path::Path;

use proptest::prelude::*;

use super::*;

const PATH: &str = "c.yaml";

fn read(text: &str, name: Option<&str>) -> Result<LensCalibration, String> {
    parse_calibration(Path::new(PATH), text, name).map_err(|error| error.to_string())
}

fn refused(text: &str, name: Option<&str>, parts: &[&str]) {
    let message = read(text, name).unwrap_err();
    assert!(message.starts_with(PATH), "{message}");
    for part in parts {
        assert!(message.contains(part), "`{part}` in {message}\n{text}");
    }
}

/// The calibration that all files of the tests have.
fn expected() -> LensCalibration {
    LensCalibration {
        size_px: Some([640, 480]),
        focal_px: [657.5, 658.25],
        principal_px: [319.5, 239.25],
        radial: [-0.25, 0.125, 0.0],
        tangential: [1e-3, -2e-3],
    }
}

const MATRIX: &str = "[ 6.575e+02, 0., 3.195e+002, 0.,\n       658.25, 239.25, 0., 0., 1. ]";

fn opencv(coefficients: &str) -> String {
    let count = coefficients.split(',').count();
    format!(
        "%YAML:1.0\n---\ncalibration_time: \"Thu Jan  1 00:00:00 2026\"\nimage_width: 640\nimage_height: 480\n\
         camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: {MATRIX}\n\
         distortion_coefficients: !!opencv-matrix\n   rows: {count}\n   cols: 1\n   dt: d\n   \
         data: [ {coefficients} ]\navg_reprojection_error: 0.3\n"
    )
}

fn camchain(change: impl Fn(&str) -> String) -> String {
    change(
        "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [-0.25, 0.125, 0.001, -0.002]\n  \
         distortion_model: radtan\n  intrinsics: [657.5, 658.25, 319.5, 239.25]\n  resolution: [640, 480]\n",
    )
}

#[test]
fn a_calibration_of_opencv_is_read() {
    assert_eq!(read(&opencv("-0.25, .125, 1e-03, -2e-003"), None), Ok(expected()));
    assert_eq!(read(&opencv("-0.25, .125, 1e-03, -2e-3, 0., 0., 0., 0."), None), Ok(expected()));
    let with_k3 = LensCalibration { radial: [-0.25, 0.125, 0.5], ..expected() };
    assert_eq!(read(&opencv("-0.25, .125, 1e-03, -2e-3, 0.5"), None), Ok(with_k3));
    let json = "{ \"imageSize\": [640, 480], \"cameraMatrix\": [[657.5, 0, 319.5], [0, 658.25, 239.25], [0, 0, 1]],\n\
                \"distCoeffs\": [[-0.25, 0.125, 0.001, -0.002, 0]] }";
    assert_eq!(read(json, None), Ok(expected()));
}

#[test]
fn one_of_several_cameras_is_selected() {
    let other = "[1, 0, 2, 0, 3, 4, 0, 0, 1]";
    let stereo = format!(
        "M1: {{rows: 3, cols: 3, data: {other}}}\nD1: [0, 0, 0, 0]\nM2: {{rows: 3, cols: 3, data: {MATRIX}}}\nD2: \
         {{data: [-0.25, 0.125, 0.001, -0.002]}}\nR: [1, 0, 0]\nimage_size: [640, 480]\n"
    );
    assert_eq!(read(&stereo, Some("2")), Ok(expected()));
    assert_eq!(read(&stereo, Some("1")).unwrap().focal_px, [1.0, 3.0]);
    refused(&stereo, None, &["several cameras", "--name: 1, 2"]);
    refused(&stereo, Some("left"), &["no camera of the name", "1, 2"]);
    let sides =
        format!("K_left: {MATRIX}\nD_left: [0, 0, 0, 0]\nRIGHT.K: {MATRIX}\nRIGHT.D: [0, 0, 0, 0, 0]\n");
    assert_eq!(read(&sides, Some("left")).unwrap().focal_px, expected().focal_px);
    assert_eq!(read(&sides, Some("right")).unwrap().size_px, None);
    let chain = camchain(|cam0| format!("{cam0}{}", cam0.replace("cam0", "cam1").replace("pinhole", "omni")));
    // A camera of a model that is refused does not hinder the others.
    assert_eq!(read(&chain, Some("cam0")), Ok(expected()));
    refused(&chain, Some("cam1"), &["line 10", "cam1.camera_model", "omni", "ds and eucm"]);
    refused(&chain, None, &["several cameras", "cam0, cam1"]);
    assert_eq!(
        read(&format!("[{{sensors: {{a: {{k: {MATRIX}, d: []}}}}}}]"), Some("0.sensors.a")).unwrap().radial,
        [0.0; 3]
    );
}

#[test]
fn camera_info_of_ros_is_read() {
    let message = "header:\n  frame_id: cam\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nd:\n- -0.25\n- 0.125\n\
                   - 0.001\n- -0.002\n- 0.0\nk: [657.5, 0.0, 319.5, 0.0, 658.25, 239.25, 0.0, 0.0, 1.0]\nr: [1, 0]\n\
                   binning_x: 0\nroi:\n  x_offset: 0\n  do_rectify: false\n---\n";
    assert_eq!(read(message, None), Ok(expected()));
    refused(&message.replace("x_offset: 0", "x_offset: 8"), None, &["roi.x_offset", "full image"]);
    refused(&message.replace("binning_x: 0", "binning_x: 2"), None, &["binning_x", "full image"]);
    refused(&message.replace("plumb_bob", "equidistant"), None, &["equidistant", "plumb_bob, radtan"]);
    let rational = message.replace("plumb_bob", "rational_polynomial");
    assert_eq!(read(&rational, None), Ok(expected()));
}

#[test]
fn a_camchain_of_kalibr_is_read() {
    assert_eq!(read(&camchain(str::to_owned), None), Ok(expected()));
    // The camera of a data set's sensor.yaml, at the root.
    let sensor = camchain(|text| {
        text.replace("cam0:\n", "")
            .replace("\n  ", "\n")
            .replace("  cam_", "cam_")
            .replace("radtan", "radial-tangential")
    });
    assert_eq!(read(&sensor, None), Ok(expected()));
    for model in ["equidistant", "fov"] {
        refused(
            &camchain(|text| text.replace("radtan", model)),
            None,
            &["cam0.distortion_model", model, "radtan"],
        );
    }
    for model in ["omni", "ds", "eucm"] {
        refused(
            &camchain(|text| text.replace("pinhole", model)),
            None,
            &["cam0.camera_model", model, "pinhole"],
        );
    }
    refused(&camchain(|text| text.replace("[657.5, ", "[")), None, &["cam0.intrinsics", "four numbers"]);
    refused(
        &camchain(|text| text.replace("[640, 480]", "[640]")),
        None,
        &["cam0.resolution", "columns and rows"],
    );
}

#[test]
fn models_that_boresight_lacks_are_refused_by_name() {
    refused(&opencv("-0.25, 0.1, 0, 0, 0, 0.01, 0, 0"), None, &["line 12", "k4", "0.01", "rational model"]);
    refused(&opencv("0, 0, 0, 0, 0, 0, 0, 0, 0, 1e-3, 0, 0"), None, &["s2", "thin prism model"]);
    refused(&opencv("0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0"), None, &["τx", "tilted sensor"]);
    let good = opencv("0, 0, 0, 0");
    refused(&good.replace("---\n", "---\nfisheye_model: 1\n"), None, &["fisheye_model", "lacks fisheye"]);
    assert!(read(&good.replace("---\n", "---\nfisheye_model: 0\n"), None).is_ok());
    refused(&good.replace("---\n", "---\nxi: 1.2\n"), None, &["xi", "omnidirectional"]);
    refused(&good.replace("6.575e+02, 0.,", "6.575e+02, 0.5,"), None, &["skew", "0.5", "without skew"]);
}

#[test]
fn wrong_values_are_named_with_line_and_field() {
    let good = opencv("0, 0, 0, 0");
    refused(&good.replace("239.25, 0., 0., 1.", "239.25, 0., 0., 2."), None, &["row 2, column 2", "`2`"]);
    refused(&good.replace("658.25", "-658.25"), None, &["fy", "above 0"]);
    refused(&good.replace("658.25", ".Nan"), None, &["line 11", "camera_matrix.data", ".Nan", "finite"]);
    refused(&good.replace("658.25", "1e999"), None, &["1e999", "finite"]);
    refused(
        &good.replace("658.25, ", ""),
        None,
        &["camera_matrix.data", "a list of 8", "rows times columns"],
    );
    refused(
        &good.replace("image_width: 640", "image_width: 0"),
        None,
        &["line 4", "image_width", "1 to 16384"],
    );
    refused(&good.replace("image_width: 640", "image_width: wide"), None, &["image_width", "wide"]);
    refused(&opencv("0, 0, 0"), None, &["a list of 3", "4, 5, 8, 12 or 14"]);
    refused(&good[..good.find("distortion").unwrap()], None, &["distortion_coefficients", "missing"]);
    refused("a: 1\n", None, &["no camera", "keys found: a"]);
    refused("[1, 2, 3]", None, &["no camera", "keys found: none"]);
    refused(&good, Some("cam0"), &["no name"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn written_calibrations_are_read_unchanged(
        focal in 1e-3..1e6_f64, ratio in 0.5..2.0_f64, centre in -1e4..1e4_f64,
        radial in prop::array::uniform3(-1e9..1e9_f64), tangential in prop::array::uniform2(-1e-9..1e-9_f64),
    ) {
        let lens = LensCalibration {
            size_px: Some([1280, 960]), focal_px: [focal, focal * ratio], principal_px: [centre, 0.0], radial, tangential,
        };
        let path = Path::new(PATH);
        for format in [CalibrationFormat::OpenCvYaml, CalibrationFormat::OpenCvJson, CalibrationFormat::Ros] {
            let text = calibration_text(path, &lens, format).unwrap();
            prop_assert_eq!(read(&text, None), Ok(lens.clone()), "{}", text);
        }
        let message = calibration_text(path, &lens, CalibrationFormat::Kalibr).unwrap_err().to_string();
        prop_assert!(message.contains("k3") && message.contains("radtan"), "{}", message);
        let lens = LensCalibration { radial: [radial[0], radial[1], 0.0], ..lens };
        let text = calibration_text(path, &lens, CalibrationFormat::Kalibr).unwrap();
        prop_assert_eq!(read(&text, Some("cam0")), Ok(lens));
    }
}

#[test]
fn a_format_that_needs_the_size_refuses_a_calibration_without_it() {
    let lens = LensCalibration { size_px: None, ..expected() };
    for format in [CalibrationFormat::Kalibr, CalibrationFormat::Ros] {
        let message = calibration_text(Path::new(PATH), &lens, format).unwrap_err().to_string();
        assert!(message.contains("`size` is `missing`"), "{message}");
    }
    let text = calibration_text(Path::new(PATH), &lens, CalibrationFormat::OpenCvYaml).unwrap();
    assert_eq!(read(&text, None), Ok(lens));
}

#[test]
fn exponents_have_a_point_and_a_sign() {
    for (number, text) in
        [(1e-7, "1.0e-7"), (1.5e21, "1.5e+21"), (0.0, "0.0"), (-657.5, "-657.5"), (1e16, "1.0e+16")]
    {
        assert_eq!(decimal(number), text);
        assert_eq!(text.parse::<f64>().unwrap(), number);
    }
}
