//! YOLO: a text file per image with the boxes, and another with boxes and keypoints
//! (<https://docs.ultralytics.com/datasets/detect/>, <https://docs.ultralytics.com/datasets/pose/>).
//!
//! Coordinates are fractions of the image's width and height from its upper left corner. Boxes enclose the
//! visible pixels.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use files::{AtomicFile, FileError, create_new};

use crate::writer::create_folder;
use crate::{FrameLabels, LabelSet, ObjectLabel};

/// Variants: the folder of each, and true if it has keypoints.
const VARIANTS: [(&str, bool); 2] = [("yolo/detect", false), ("yolo/pose", true)];

/// Creates the folders.
pub(crate) fn create_folders(folder: &Path) -> Result<(), FileError> {
    VARIANTS.iter().try_for_each(|(variant, _)| create_folder(&folder.join(variant).join("labels")))
}

/// Writes the labels of an image; the files of an image without objects are empty.
pub(crate) fn write_image(folder: &Path, set: &LabelSet, frame: &FrameLabels) -> Result<(), FileError> {
    let Some(view) = set.views.get(frame.view) else { return Ok(()) };
    for (variant, has_keypoints) in VARIANTS {
        let keypoints = if has_keypoints { Some(most_keypoints(set)) } else { None };
        let lines = frame.objects.iter().filter_map(|object| line(object, view.camera.size(), keypoints));
        let path = folder.join(variant).join("labels").join(format!("{:06}.txt", frame.number));
        let mut file = create_new(&path)?;
        let text: String = lines.collect();
        file.write_all(text.as_bytes()).map_err(|source| FileError::io(&path, "write", source))?;
    }
    Ok(())
}

/// Writes `data.yaml` of each variant, last: it marks the labels as complete.
pub(crate) fn finish(folder: &Path, set: &LabelSet) -> Result<(), FileError> {
    for (variant, has_keypoints) in VARIANTS {
        let path = folder.join(variant).join("data.yaml");
        AtomicFile::with_text(&path, &data_yaml(set, has_keypoints))?.commit_new()?;
    }
    Ok(())
}

/// Paths of the descriptions below the folder of all labels.
pub(crate) fn files() -> Vec<PathBuf> {
    VARIANTS.iter().map(|(variant, _)| Path::new(variant).join("data.yaml")).collect()
}

/// Number of keypoints of every line: the format has one number for all classes.
fn most_keypoints(set: &LabelSet) -> usize {
    set.classes.iter().map(|class| class.keypoints.len()).max().unwrap_or(0)
}

/// Returns the line of an object, with this number of keypoints if it has any; `None` without a visible
/// pixel.
fn line(object: &ObjectLabel, size: (usize, usize), keypoints: Option<usize>) -> Option<String> {
    let [columns, rows] = object.visible.bounds()?;
    let (width, height) = (size.0 as f64, size.1 as f64);
    let middle = |range: &std::ops::Range<i32>| 0.5 * f64::from(range.start + range.end);
    let mut line = format!(
        "{} {} {} {} {}",
        object.class,
        middle(&columns) / width,
        middle(&rows) / height,
        columns.len() as f64 / width,
        rows.len() as f64 / height
    );
    for index in 0..keypoints.unwrap_or(0) {
        let labelled = object.keypoints.get(index).filter(|point| point.code() > 0);
        let written = match labelled {
            // From the centre of the first pixel to its corner.
            Some(point) => write!(
                line,
                " {} {} {}",
                (point.position.x + 0.5) / width,
                (point.position.y + 0.5) / height,
                point.code()
            ),
            None => write!(line, " 0 0 0"),
        };
        // Writing to a string cannot fail.
        written.ok()?;
    }
    line.push('\n');
    Some(line)
}

fn data_yaml(set: &LabelSet, has_keypoints: bool) -> String {
    let mut text = "# The images are apart from the labels. Link their folder beside labels/:\n\
        #   ln -s ../../../../frames images\n\
        train: images\n\
        val: images\n"
        .to_owned();
    if has_keypoints {
        text.push_str(&format!("kpt_shape: [{}, 3]\n", most_keypoints(set)));
    }
    text.push_str("names:\n");
    for (index, class) in set.classes.iter().enumerate() {
        text.push_str(&format!("  {index}: {}\n", class.name));
    }
    if has_keypoints {
        text.push_str("kpt_names:\n");
        for (index, class) in set.classes.iter().enumerate() {
            text.push_str(&format!("  {index}: [{}]\n", class.keypoints.join(", ")));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KeypointLabel;
    use contract::PixelPoint;
    use sim::vector::{RowSpans, Span};

    /// By hand: columns 2 to 4 and row 3 of an image of 8 × 4 pixels; a keypoint at the centre of pixel (3,
    /// 3).
    #[test]
    fn boxes_and_keypoints_are_fractions_from_the_corner_of_the_image() {
        let pixels = RowSpans::from_spans(vec![Span { row: 3, start: 2, end: 5 }]);
        let mut label = ObjectLabel::in_picture(1, (8, 4), &pixels, &pixels, None).unwrap();
        label.keypoints = vec![KeypointLabel::new(Some(PixelPoint::new(3.0, 3.0)), true, (8, 4))];
        assert_eq!(line(&label, (8, 4), None).unwrap(), "1 0.4375 0.875 0.375 0.25\n");
        let pose = "1 0.4375 0.875 0.375 0.25 0.4375 0.875 1 0 0 0\n";
        assert_eq!(line(&label, (8, 4), Some(2)).unwrap(), pose);
    }
}
