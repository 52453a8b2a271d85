//! Labels of one image.

use contract::PixelPoint;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use sim::vector::{RowSpans, Span};

/// Labels of the objects in one image. All pixels are those of the image file, with the centre of the first
/// pixel at (0, 0): for a field, its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameLabels {
    /// Number of the frame.
    pub number: u64,
    /// Index of its camera in [`crate::LabelSet::views`].
    pub view: usize,
    /// Objects that cover part of the picture, in the order of their classes.
    pub objects: Vec<ObjectLabel>,
}

/// Label of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectLabel {
    /// Index of its class in [`crate::LabelSet::classes`].
    pub class: usize,
    /// Number of pixels of the whole silhouette, also beyond the picture by up to its size on each side.
    pub whole_px: u64,
    /// Columns and rows of these pixels.
    pub whole_bounds: [std::ops::Range<i32>; 2],
    /// Pixels of the silhouette in the picture, hidden by other objects or not.
    pub silhouette: RowSpans,
    /// Those of these pixels that no other object hides.
    pub visible: RowSpans,
    /// True if the object covers the centre of no pixel: its mask is the pixel of its origin.
    pub is_point: bool,
    /// Keypoints, in the order of the class.
    pub keypoints: Vec<KeypointLabel>,
    /// Pose; `None` for an object without orientation.
    pub pose: Option<ObjectPose>,
}

impl ObjectLabel {
    /// Creates the label of an object in a picture of `size` (columns, rows), with neither keypoints nor
    /// pose; `None` if it covers no part of the picture. An object too small to cover the centre of a pixel
    /// covers the pixel `anchor` (column, row), in which its origin lies.
    pub fn in_picture(
        class: usize,
        size: (usize, usize),
        whole: &RowSpans,
        visible: &RowSpans,
        anchor: Option<[i32; 2]>,
    ) -> Option<Self> {
        let (columns, rows) = (size.0 as i32, size.1 as i32);
        let pixel =
            anchor.map(|[start, row]| RowSpans::from_spans(vec![Span { row, start, end: start + 1 }]));
        let is_point = whole.count() == 0;
        let (whole, visible) = match &pixel {
            Some(pixel) if is_point => (pixel, pixel),
            _ => (whole, visible),
        };
        let silhouette = whole.within(columns, rows);
        let is_in_picture = silhouette.count() > 0;
        let whole_bounds = whole.bounds().filter(|_| is_in_picture)?;
        Some(Self {
            class,
            whole_px: whole.count(),
            whole_bounds,
            silhouette,
            visible: visible.within(columns, rows),
            is_point,
            keypoints: Vec::new(),
            pose: None,
        })
    }
}

/// Visibility of a keypoint, with the code of COCO and YOLO.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visibility {
    /// Outside the picture: 0.
    Outside,
    /// In the picture, and hidden by an object: 1.
    Hidden,
    /// Visible: 2.
    Visible,
}

/// Label of a keypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeypointLabel {
    /// Position, px of the image; (0, 0) is the centre of the first pixel.
    pub position: PixelPoint,
    /// Visibility; outside the picture the position is meaningless.
    pub visibility: Visibility,
}

impl KeypointLabel {
    /// Creates the label of a point of the image, if it has an image, in a picture of `size` (columns, rows).
    pub fn new(position: Option<PixelPoint>, is_hidden: bool, size: (usize, usize)) -> Self {
        match position.filter(|position| position.is_on_detector(size.0, size.1)) {
            None => Self { position: PixelPoint::new(0.0, 0.0), visibility: Visibility::Outside },
            Some(position) if is_hidden => Self { position, visibility: Visibility::Hidden },
            Some(position) => Self { position, visibility: Visibility::Visible },
        }
    }

    /// Returns the code of the visibility.
    pub(crate) fn code(&self) -> u8 {
        match self.visibility {
            Visibility::Outside => 0,
            Visibility::Hidden => 1,
            Visibility::Visible => 2,
        }
    }
}

/// Pose of an object: a point p of its body frame is R p + t in the camera frame (x along columns, y along
/// rows, z along the boresight).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObjectPose {
    /// R.
    pub camera_from_object: Matrix3<f64>,
    /// Hamilton's quaternion of R.
    pub quaternion: UnitQuaternion<f64>,
    /// t, m.
    pub position_m: Vector3<f64>,
}

impl ObjectPose {
    /// Creates a pose from its quaternion and its position, m.
    pub fn from_quaternion(quaternion: UnitQuaternion<f64>, position_m: Vector3<f64>) -> Self {
        Self { camera_from_object: *quaternion.to_rotation_matrix().matrix(), quaternion, position_m }
    }

    /// Returns the quaternion, scalar first, with a scalar that is not negative.
    pub(crate) fn wxyz(&self) -> [f64; 4] {
        let q = self.quaternion;
        let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
        [sign * q.w, sign * q.i, sign * q.j, sign * q.k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(list: &[[i32; 3]]) -> RowSpans {
        RowSpans::from_spans(list.iter().map(|&[row, start, end]| Span { row, start, end }).collect())
    }

    #[test]
    fn an_object_without_a_pixel_has_that_of_its_origin() {
        let none = RowSpans::default();
        let label = ObjectLabel::in_picture(0, (8, 6), &none, &none, Some([7, 5])).unwrap();
        assert_eq!((label.whole_px, label.silhouette.spans()), (1, spans(&[[5, 7, 8]]).spans()));
        assert_eq!(label.visible, label.silhouette);
        assert!(ObjectLabel::in_picture(0, (8, 6), &none, &none, None).is_none());
    }

    #[test]
    fn an_object_beyond_the_picture_has_no_label_and_a_truncated_one_its_whole_size() {
        let left = spans(&[[2, -5, -1]]);
        assert!(ObjectLabel::in_picture(0, (8, 6), &left, &left, Some([3, 3])).is_none());
        let (whole, seen) = (spans(&[[2, -5, 4], [3, -5, 4]]), spans(&[[2, -5, 4]]));
        let label = ObjectLabel::in_picture(0, (8, 6), &whole, &seen, None).unwrap();
        assert_eq!((label.whole_px, label.whole_bounds.clone()), (18, [-5..4, 2..4]));
        assert_eq!((label.silhouette.count(), label.visible.count()), (8, 4));
    }

    #[test]
    fn a_keypoint_outside_the_picture_has_no_position() {
        let at = |x, y, hidden| KeypointLabel::new(Some(PixelPoint::new(x, y)), hidden, (8, 6));
        assert_eq!(at(-0.4, 0.0, false).code(), 2);
        assert_eq!(at(7.4, 5.4, true).code(), 1);
        assert_eq!(at(7.6, 5.0, false), KeypointLabel::new(None, false, (8, 6)));
    }
}
