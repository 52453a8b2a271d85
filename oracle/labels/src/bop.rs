//! BOP: poses, boxes and masks of all objects (bop_toolkit, `docs/bop_datasets_format.md`, scenewise).
//!
//! Boxes are [x, y, width, height] with x, y the first pixel and width, height the differences between last
//! and first pixel, as `scripts/calc_gt_info.py` computes them. `cam_K` is for pixel centres, lengths are
//! mm.

use std::path::{Path, PathBuf};

use contract::Frame;
use files::{AtomicFile, FileError, write_png_of_depth};
use nalgebra::Vector3;
use serde_json::{Map, Value, json};
use sim::vector::RowSpans;

use crate::json_file::JsonFile;
use crate::writer::create_folder;
use crate::{FrameLabels, LabelSet, ObjectLabel};

/// Folder of the scene below the folder of all labels.
const SCENE: &str = "bop/train/000000";
const MODELS: &str = "bop/models";
/// Files of a scene, with their opening.
const FILES: [&str; 3] = ["scene_gt.json", "scene_gt_info.json", "scene_camera.json"];
/// Millimetres per metre.
const MM: f64 = 1000.0;
/// Value of a pixel of the mask; 0 elsewhere.
const MASK_DN: u16 = 255;

/// Writers of the scene's files.
pub(crate) struct BopFiles {
    poses: JsonFile,
    info: JsonFile,
    cameras: JsonFile,
}

impl BopFiles {
    pub(crate) fn create(folder: &Path, set: &LabelSet) -> Result<Self, FileError> {
        let (scene, models) = (folder.join(SCENE), folder.join(MODELS));
        for inner in [scene.join("mask"), scene.join("mask_visib"), models.clone()] {
            create_folder(&inner)?;
        }
        AtomicFile::with_text(&models.join("models_info.json"), &models_info(set))?.commit_new()?;
        let [poses, info, cameras] = FILES;
        Ok(Self {
            poses: JsonFile::create(&scene.join(poses), "{")?,
            info: JsonFile::create(&scene.join(info), "{")?,
            cameras: JsonFile::create(&scene.join(cameras), "{")?,
        })
    }

    pub(crate) fn add(&mut self, set: &LabelSet, frame: &FrameLabels) -> Result<(), FileError> {
        let Some(view) = set.views.get(frame.view) else { return Ok(()) };
        let number = frame.number;
        let poses = Value::from_iter(frame.objects.iter().map(pose));
        let info = Value::from_iter(frame.objects.iter().map(info));
        let camera = json!({ "cam_K": view.camera.matrix(), "depth_scale": 1.0 });
        self.poses.entry(&format!("\"{number}\": {poses}"))?;
        self.info.entry(&format!("\"{number}\": {info}"))?;
        self.cameras.entry(&format!("\"{number}\": {camera}"))
    }

    pub(crate) fn finish(self) -> Result<(), FileError> {
        [self.poses, self.info, self.cameras].into_iter().try_for_each(|file| file.finish("}"))
    }
}

/// Paths of the tables below the folder of all labels.
pub(crate) fn files() -> Vec<PathBuf> {
    let tables = FILES.iter().map(|name| Path::new(SCENE).join(name));
    tables.chain([Path::new(MODELS).join("models_info.json")]).collect()
}

/// Writes the masks of a frame: `mask/` with the whole silhouettes in the picture, `mask_visib/` with their
/// visible parts, a PNG per object.
pub(crate) fn write_masks(folder: &Path, frame: &FrameLabels, size: (usize, usize)) -> Result<(), FileError> {
    let scene = folder.join(SCENE);
    for (index, object) in frame.objects.iter().enumerate() {
        let name = format!("{:06}_{index:06}.png", frame.number);
        for (kind, mask) in [("mask", &object.silhouette), ("mask_visib", &object.visible)] {
            write_mask(&scene.join(kind).join(&name), mask, size)?;
        }
    }
    Ok(())
}

fn write_mask(path: &Path, mask: &RowSpans, (columns, rows): (usize, usize)) -> Result<(), FileError> {
    let mut pixels = vec![0; columns * rows];
    for span in mask.spans() {
        let row = span.row.unsigned_abs() as usize * columns;
        let of_span = row + span.start.unsigned_abs() as usize..row + span.end.unsigned_abs() as usize;
        pixels.get_mut(of_span).into_iter().flatten().for_each(|pixel| *pixel = MASK_DN);
    }
    let image = Frame::new(0, columns, rows, 8, pixels, None);
    write_png_of_depth(path, &image.map_err(|error| FileError::format(path, "mask", error))?)
}

fn pose(object: &ObjectLabel) -> Value {
    let pose = object.pose.as_ref();
    let rotation: Option<Vec<f64>> =
        pose.map(|pose| pose.camera_from_object.transpose().iter().copied().collect());
    let position_mm: Option<[f64; 3]> = pose.map(|pose| (pose.position_m * MM).into());
    json!({ "obj_id": object.class + 1, "cam_R_m2c": rotation, "cam_t_m2c": position_mm })
}

fn info(object: &ObjectLabel) -> Value {
    let visible_px = object.visible.count();
    let of_visible = |bounds: &[std::ops::Range<i32>; 2]| match visible_px {
        0 => [-1; 4],
        _ => box_of(bounds),
    };
    json!({
        "bbox_obj": of_visible(&object.whole_bounds),
        "bbox_visib": object.visible.bounds().map_or([-1; 4], |bounds| box_of(&bounds)),
        "px_count_all": object.whole_px,
        // Every pixel has a true depth: there is no depth sensor that could miss it.
        "px_count_valid": object.silhouette.count(),
        "px_count_visib": visible_px,
        "visib_fract": visible_px as f64 / object.whole_px.max(1) as f64,
    })
}

/// Returns [x, y, width, height] of pixels, with the differences of `calc_2d_bbox`.
fn box_of([columns, rows]: &[std::ops::Range<i32>; 2]) -> [i32; 4] {
    [columns.start, rows.start, columns.end - 1 - columns.start, rows.end - 1 - rows.start]
}

fn models_info(set: &LabelSet) -> String {
    let mut models = Map::new();
    for (index, class) in set.classes.iter().enumerate() {
        let Some(model) = class.model else { continue };
        let (low_mm, size_mm): (Vector3<f64>, Vector3<f64>) = (model.low_m() * MM, model.size_m() * MM);
        models.insert(
            (index + 1).to_string(),
            json!({
                "diameter": model.diameter_m() * MM,
                "min_x": low_mm.x,
                "min_y": low_mm.y,
                "min_z": low_mm.z,
                "size_x": size_mm.x,
                "size_y": size_mm.y,
                "size_z": size_mm.z,
            }),
        );
    }
    format!("{:#}\n", Value::Object(models))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ObjectPose;
    use nalgebra::UnitQuaternion;
    use sim::vector::Span;

    /// By hand with the formulas of `calc_gt_info.py`: pixels in columns −2 to 4 and rows 1 to 3, of which
    /// columns 0 to 2 of row 1 are visible.
    #[test]
    fn boxes_and_counts_are_those_of_the_published_script() {
        let spans = |list: &[[i32; 3]]| {
            RowSpans::from_spans(list.iter().map(|&[row, start, end]| Span { row, start, end }).collect())
        };
        let whole = spans(&[[1, -2, 5], [2, -2, 5], [3, -2, 5]]);
        let label = ObjectLabel::in_picture(2, (8, 6), &whole, &spans(&[[1, -2, 3]]), None).unwrap();
        let expected = json!({
            "bbox_obj": [-2, 1, 6, 2],
            "bbox_visib": [0, 1, 2, 0],
            "px_count_all": 21,
            "px_count_valid": 15,
            "px_count_visib": 3,
            "visib_fract": 3.0 / 21.0,
        });
        assert_eq!(info(&label), expected);
        let hidden = ObjectLabel { visible: RowSpans::default(), ..label };
        assert_eq!(info(&hidden)["bbox_obj"], json!([-1, -1, -1, -1]));
    }

    /// By hand: a quarter turn about z, whose matrix by rows is (0 −1 0, 1 0 0, 0 0 1).
    #[test]
    fn a_matrix_is_written_by_rows_and_a_position_in_millimetres() {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let pixel = RowSpans::from_spans(vec![Span { row: 0, start: 0, end: 1 }]);
        let mut label = ObjectLabel::in_picture(0, (8, 6), &pixel, &pixel, None).unwrap();
        label.pose = Some(ObjectPose::from_quaternion(turn, Vector3::new(0.5, 0.0, 2.0)));
        let written = pose(&label);
        let matrix: Vec<f64> = serde_json::from_value(written["cam_R_m2c"].clone()).unwrap();
        let expected = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        assert!(matrix.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-15));
        assert_eq!((&written["cam_t_m2c"], &written["obj_id"]), (&json!([500.0, 0.0, 2000.0]), &json!(1)));
    }
}
