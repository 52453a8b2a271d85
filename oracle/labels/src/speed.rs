//! SPEED and SPEED+: pose of one object per image (European Space Agency, Kelvins, pose estimation
//! challenges).
//!
//! VBS is our camera frame (x along columns, y along rows, z along the boresight), TANGO the body frame of
//! the main object. The published reader projects a point p of TANGO by K (Cᵀ p + r) with the direction
//! cosine matrix C of `q_vbs2tango`; C of a quaternion is the transpose of Hamilton's R. So p is R p + r in
//! VBS, and the quaternion is our `q_cam_target`, scalar first. One folder per camera: `camera.json`
//! describes one.

use std::path::{Path, PathBuf};

use files::{AtomicFile, FileError};
use serde_json::json;

use crate::json_file::JsonFile;
use crate::writer::{create_folder, image_name};
use crate::{FrameLabels, LabelSet, LabelView, ObjectPose};

/// Writers of `labels.json`, one per camera.
pub(crate) struct SpeedFiles {
    files: Vec<JsonFile>,
}

impl SpeedFiles {
    pub(crate) fn create(folder: &Path, set: &LabelSet) -> Result<Self, FileError> {
        let mut files = Vec::with_capacity(set.views.len());
        for view in &set.views {
            let view_folder = folder.join(folder_of(view));
            create_folder(&view_folder)?;
            AtomicFile::with_text(&view_folder.join("camera.json"), &camera(view))?.commit_new()?;
            files.push(JsonFile::create(&view_folder.join("labels.json"), "[")?);
        }
        Ok(Self { files })
    }

    /// Adds a frame in which the main object is visible.
    pub(crate) fn add(&mut self, frame: &FrameLabels) -> Result<(), FileError> {
        let main = frame.objects.iter().find(|object| object.class == 0 && object.visible.count() > 0);
        let pose = main.and_then(|object| object.pose);
        match (pose, self.files.get_mut(frame.view)) {
            (Some(pose), Some(file)) => file.entry(&record(frame.number, &pose).to_string()),
            _ => Ok(()),
        }
    }

    pub(crate) fn finish(self) -> Result<(), FileError> {
        self.files.into_iter().try_for_each(|file| file.finish("]"))
    }
}

/// Paths of the files below the folder of all labels.
pub(crate) fn files(set: &LabelSet) -> Vec<PathBuf> {
    let of_view = |view: &LabelView| ["camera.json", "labels.json"].map(|name| folder_of(view).join(name));
    set.views.iter().flat_map(of_view).collect()
}

fn folder_of(view: &LabelView) -> PathBuf {
    Path::new("speed").join(&view.name)
}

/// Returns the record of an image, with the keys of SPEED and those of SPEED+.
fn record(number: u64, pose: &ObjectPose) -> serde_json::Value {
    let position_m: [f64; 3] = pose.position_m.into();
    json!({
        "filename": image_name(number),
        "q_vbs2tango": pose.wxyz(),
        "q_vbs2tango_true": pose.wxyz(),
        "r_Vo2To_vbs_true": position_m,
    })
}

/// Returns `camera.json` of SPEED+: focal lengths and pixels in metres, the principal point and the matrix
/// for pixel centres.
fn camera(view: &LabelView) -> String {
    let camera = &view.camera;
    let (columns, rows) = camera.size();
    let [ppx, ppy] = camera.pixel_um().map(|size_um| size_um * 1e-6);
    let focal_m = camera.focal_length_mm() * 1e-3;
    let [ccx, ccy] = camera.principal_px();
    let [a, b, c, d, e, f, g, h, i] = camera.matrix();
    let camera = json!({
        "Nu": columns,
        "Nv": rows,
        "ppx": ppx,
        "ppy": ppy,
        "fx": focal_m,
        "fy": focal_m,
        "ccx": ccx,
        "ccy": ccy,
        "cameraMatrix": [[a, b, c], [d, e, f], [g, h, i]],
        "distCoeffs": camera.distortion().unwrap_or_default(),
    });
    format!("{camera:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

    /// Direction cosine matrix of the published reader (`quat2dcm`,
    /// <https://gitlab.com/EuropeanSpaceAgency/speed-utils>), with its formula for each element.
    fn published_matrix([q0, q1, q2, q3]: [f64; 4]) -> Matrix3<f64> {
        Matrix3::new(
            2.0 * q0 * q0 - 1.0 + 2.0 * q1 * q1,
            2.0 * q1 * q2 + 2.0 * q0 * q3,
            2.0 * q1 * q3 - 2.0 * q0 * q2,
            2.0 * q1 * q2 - 2.0 * q0 * q3,
            2.0 * q0 * q0 - 1.0 + 2.0 * q2 * q2,
            2.0 * q2 * q3 + 2.0 * q0 * q1,
            2.0 * q1 * q3 + 2.0 * q0 * q2,
            2.0 * q2 * q3 - 2.0 * q0 * q1,
            2.0 * q0 * q0 - 1.0 + 2.0 * q3 * q3,
        )
    }

    /// The published reader maps a point p of the body by the transpose of its matrix.
    #[test]
    fn the_published_reader_places_a_point_where_the_pose_does() {
        let quaternion = UnitQuaternion::from_quaternion(Quaternion::new(-0.5, 0.1, -0.7, 0.3));
        let pose = ObjectPose::from_quaternion(quaternion, Vector3::new(0.1, -0.2, 9.0));
        let point = Vector3::new(0.3, 0.5, -0.2);
        let read = published_matrix(pose.wxyz()).transpose() * point + pose.position_m;
        assert!((read - (pose.camera_from_object * point + pose.position_m)).norm() < 1e-15);
        assert!(pose.wxyz()[0] > 0.0);
    }

    /// By hand: a quarter turn about z takes the body's x to the camera's y. Its quaternion is (√½, 0, 0,
    /// √½).
    #[test]
    fn a_quarter_turn_about_the_boresight_has_its_quaternion() {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let pose = ObjectPose::from_quaternion(turn, Vector3::new(0.0, 0.0, 5.0));
        let root = std::f64::consts::FRAC_1_SQRT_2;
        for (found, expected) in pose.wxyz().into_iter().zip([root, 0.0, 0.0, root]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert!((pose.camera_from_object * Vector3::x() - Vector3::y()).norm() < 1e-15);
    }
}
