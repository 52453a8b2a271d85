//! Cases of golden/docking: the scenes of the images. Shared by the test and by the program that renders the
//! images.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use contract::Camera;
use contract::docking::Pose;
use nalgebra::{Matrix3, Rotation3, Vector3};
use serde::Deserialize;
use sim::mitsuba::Crop;
use sim::scene::docking::{Floodlight, Lighting, Sun, TargetFile};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cases {
    #[allow(dead_code, reason = "read by the program that makes the images")]
    pub(crate) samples: u32,
    light: Light,
    lamp: Lamp,
    camera: BTreeMap<String, Lens>,
    pub(crate) case: Vec<Case>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Case {
    pub(crate) name: String,
    camera: String,
    d_m: [f64; 3],
    phi_deg: [f64; 3],
    sun_deg: Option<[f64; 2]>,
    #[serde(default)]
    lamp: bool,
    crop_m: f64,
    #[serde(default)]
    crop_centre_m: [f64; 2],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Light {
    irradiance: f64,
    fill_radiance: f64,
    sky_radiance: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Lamp {
    offset_m: [f64; 3],
    intensity: f64,
    inner_half_angle_deg: f64,
    outer_half_angle_deg: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Lens {
    focal_length_px: f64,
    principal_px: [f64; 2],
}

/// Returns the directory golden/docking of the repository; this module is compiled in the root package and in
/// `research`.
pub(crate) fn folder() -> PathBuf {
    let mut above =
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("golden/docking"));
    above.find(|folder| folder.is_dir()).expect("the tests run in a checkout")
}

/// Reads the cases and their target.
pub(crate) fn load() -> (Cases, TargetFile) {
    let read = |name: &str| fs::read_to_string(folder().join(name)).unwrap();
    (toml::from_str(&read("cases.toml")).unwrap(), toml::from_str(&read("target.toml")).unwrap())
}

/// Returns the matrix A: from the camera's axes to the target frame.
pub(crate) fn target_from_camera(pose: &Pose) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))
        * Rotation3::from_scaled_axis(pose.phi_rad).matrix()
}

impl Case {
    pub(crate) fn camera(&self, cases: &Cases) -> Camera {
        let lens = &cases.camera[&self.camera];
        Camera {
            columns: 768,
            rows: 576,
            focal_length_mm: lens.focal_length_px / 100.0,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: lens.principal_px[0],
            principal_y_px: lens.principal_px[1],
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    pub(crate) fn pose(&self) -> Pose {
        let phi_rad = Vector3::from(self.phi_deg.map(f64::to_radians));
        Pose { position_m: Vector3::from(self.d_m), phi_rad }
    }

    pub(crate) fn lighting(&self, cases: &Cases) -> Lighting {
        let sun = self.sun_deg.map(|angles_deg| {
            let [(sin_e, cos_e), (sin_a, cos_a)] = angles_deg.map(|deg| libm::sincos(deg.to_radians()));
            Sun {
                towards: Vector3::new(cos_e * cos_a, cos_e * sin_a, sin_e),
                irradiance: cases.light.irradiance,
            }
        });
        let floodlight = self.lamp.then(|| {
            let (pose, lamp) = (self.pose(), &cases.lamp);
            let axes = target_from_camera(&pose);
            Floodlight {
                position_m: pose.position_m + axes * Vector3::from(lamp.offset_m),
                axis: axes * Vector3::z(),
                intensity: lamp.intensity,
                inner_half_angle_rad: lamp.inner_half_angle_deg.to_radians(),
                outer_half_angle_rad: lamp.outer_half_angle_deg.to_radians(),
            }
        });
        let Light { fill_radiance, sky_radiance, .. } = cases.light;
        Lighting { sun, floodlight, fill_radiance, sky_radiance }
    }

    /// Returns a square around the image of a point of the disk, limited to the part within the image.
    pub(crate) fn crop(&self, cases: &Cases) -> Crop {
        let (camera, pose) = (self.camera(cases), self.pose());
        let (focal_px, _) = camera.focal_length_px();
        let [y1, y2] = self.crop_centre_m;
        let point = Vector3::new(y1, y2, 0.0);
        let centre = target_from_camera(&pose).transpose() * (point - pose.position_m);
        let half_px = focal_px * self.crop_m / centre.z;
        let span = |middle: f64, side: usize| {
            let low = (middle - half_px).round().max(0.0) as usize;
            let high = ((middle + half_px).round().max(0.0) as usize).min(side);
            (low, high - low)
        };
        let (x, columns) = span(camera.principal_x_px + focal_px * centre.x / centre.z, camera.columns);
        let (y, rows) = span(camera.principal_y_px + focal_px * centre.y / centre.z, camera.rows);
        Crop { x, y, columns, rows }
    }
}
