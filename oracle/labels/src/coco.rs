//! COCO: one JSON file with images, categories and annotations (<https://cocodataset.org/#format-data>).
//!
//! Boxes are [x, y, width, height] px from the upper left corner of the image, and enclose the visible
//! pixels. Keypoints are pixel indices: the centre of the first pixel is (0, 0). Masks are run lengths down
//! the columns that begin with the background.

use std::path::Path;

use files::FileError;
use serde_json::{Value, json};
use sim::vector::RowSpans;

use crate::json_file::JsonFile;
use crate::writer::image_name;
use crate::{FrameLabels, LabelSet, ObjectLabel};

/// Path of the file below the folder of all labels.
pub(crate) const FILE: &str = "coco/annotations.json";

/// Writer of the file.
pub(crate) struct CocoFile {
    file: JsonFile,
    images: Vec<Value>,
    annotations: u64,
}

impl CocoFile {
    pub(crate) fn create(folder: &Path) -> Result<Self, FileError> {
        let file = JsonFile::create(&folder.join(FILE), "{\"annotations\": [")?;
        Ok(Self { file, images: Vec::new(), annotations: 0 })
    }

    pub(crate) fn add(&mut self, set: &LabelSet, frame: &FrameLabels) -> Result<(), FileError> {
        let Some(view) = set.views.get(frame.view) else { return Ok(()) };
        let (columns, rows) = view.camera.size();
        self.images.push(json!({
            "id": frame.number,
            "file_name": image_name(frame.number),
            "width": columns,
            "height": rows,
        }));
        for object in &frame.objects {
            // The identifiers begin with 1: evaluations treat 0 as the absence of a match.
            if let Some(annotation) = annotation(object, self.annotations + 1, frame.number, (columns, rows))
            {
                self.annotations += 1;
                self.file.entry(&annotation.to_string())?;
            }
        }
        Ok(())
    }

    pub(crate) fn finish(self, set: &LabelSet) -> Result<(), FileError> {
        let category = |(index, class): (usize, &crate::LabelClass)| {
            json!({
                "id": index + 1,
                "name": class.name,
                "supercategory": "spacecraft",
                "keypoints": class.keypoints,
                "skeleton": [],
            })
        };
        let categories: Vec<Value> = set.classes.iter().enumerate().map(category).collect();
        let info = json!({ "description": set.description });
        let (images, categories) = (Value::from(self.images), Value::from(categories));
        self.file
            .finish(&format!("],\n\"categories\": {categories},\n\"images\": {images},\n\"info\": {info}}}"))
    }
}

/// Returns the annotation of an object; `None` without a visible pixel.
fn annotation(object: &ObjectLabel, id: u64, image: u64, size: (usize, usize)) -> Option<Value> {
    let [columns, rows] = object.visible.bounds()?;
    let keypoints: Vec<Value> = object
        .keypoints
        .iter()
        .flat_map(|point| [json!(point.position.x), json!(point.position.y), json!(point.code())])
        .collect();
    let labelled = object.keypoints.iter().filter(|point| point.code() > 0).count();
    Some(json!({
        "id": id,
        "image_id": image,
        "category_id": object.class + 1,
        "bbox": [columns.start, rows.start, columns.len(), rows.len()],
        "area": object.visible.count(),
        "iscrowd": 0,
        "segmentation": { "size": [size.1, size.0], "counts": run_lengths(&object.visible, size) },
        "keypoints": keypoints,
        "num_keypoints": labelled,
    }))
}

/// Returns the lengths of runs of equal pixels down the columns of an image of `size` (columns, rows), column
/// by column: first background (possibly none), then mask, and so on.
fn run_lengths(mask: &RowSpans, size: (usize, usize)) -> Vec<u64> {
    let (columns, rows) = size;
    let mut pixels = vec![false; columns * rows];
    for span in mask.spans() {
        let row = span.row.unsigned_abs() as usize;
        for column in span.start.unsigned_abs() as usize..span.end.unsigned_abs() as usize {
            pixels.get_mut(column * rows + row).into_iter().for_each(|pixel| *pixel = true);
        }
    }
    let mut lengths = Vec::new();
    let (mut is_mask, mut length) = (false, 0);
    for pixel in pixels {
        if pixel != is_mask {
            lengths.push(length);
            (is_mask, length) = (pixel, 0);
        }
        length += 1;
    }
    lengths.push(length);
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::vector::Span;

    fn mask(list: &[[i32; 3]]) -> RowSpans {
        RowSpans::from_spans(list.iter().map(|&[row, start, end]| Span { row, start, end }).collect())
    }

    /// The comment of the format's interface, `cocoapi/PythonAPI/pycocotools/mask.py`: M = [0 0 1 1 1 0 1]
    /// has the counts [2 3 1 1], and M = [1 1 1 1 1 1 0] the counts [0 6 1]. M is read down the columns.
    #[test]
    fn run_lengths_are_those_of_the_published_examples() {
        let column = |rows: &[i32]| mask(&rows.iter().map(|row| [*row, 0, 1]).collect::<Vec<_>>());
        assert_eq!(run_lengths(&column(&[2, 3, 4, 6]), (1, 7)), [2, 3, 1, 1]);
        assert_eq!(run_lengths(&column(&[0, 1, 2, 3, 4, 5]), (1, 7)), [0, 6, 1]);
    }

    /// By hand: an image of 4 columns and 3 rows with a mask in columns 1 and 2 of rows 1 and 2. Down the
    /// columns: 4 pixels of background, 2 of mask, 1, 2, 3.
    #[test]
    fn a_rectangle_runs_down_its_columns_and_its_box_begins_at_its_corner() {
        let label = ObjectLabel::in_picture(
            0,
            (4, 3),
            &mask(&[[1, 1, 3], [2, 1, 3]]),
            &mask(&[[1, 1, 3], [2, 1, 3]]),
            None,
        );
        let annotation = annotation(&label.unwrap(), 1, 7, (4, 3)).unwrap();
        assert_eq!(annotation["segmentation"], json!({ "size": [3, 4], "counts": [4, 2, 1, 2, 3] }));
        assert_eq!(annotation["bbox"], json!([1, 1, 2, 2]));
        assert_eq!((&annotation["area"], &annotation["image_id"]), (&json!(4), &json!(7)));
    }

    #[test]
    fn a_run_continues_from_the_foot_of_a_column_to_the_head_of_the_next() {
        assert_eq!(run_lengths(&mask(&[[0, 1, 2], [1, 0, 1]]), (2, 2)), [1, 2, 1]);
        assert_eq!(run_lengths(&mask(&[]), (2, 2)), [4]);
        assert_eq!(run_lengths(&mask(&[[0, 0, 2], [1, 0, 2]]), (2, 2)), [0, 4]);
    }
}
