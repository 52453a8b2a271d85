//! Data that the labels of all frames share: classes of objects, cameras, origin.

use contract::Camera;
use files::Failure;
use nalgebra::Vector3;

use crate::{LabelFormat, LabelFormats};

/// Classes and cameras of a set of labelled images.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelSet {
    /// Description of the origin: program, version, scenario, seed.
    pub description: String,
    /// Classes of objects, the main one first: it is the object of SPEED.
    pub classes: Vec<LabelClass>,
    /// Cameras of the images.
    pub views: Vec<LabelView>,
    /// Sentence for the user about a limitation of these labels, such as a target without extent.
    pub note: Option<String>,
}

/// Class of objects; an image has at most one object of a class.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelClass {
    /// Name.
    pub name: String,
    /// Names of its keypoints.
    pub keypoints: Vec<String>,
    /// Extent of its model; `None` for a class without orientation, whose pose is unknown.
    pub model: Option<ModelExtent>,
}

/// Extent of a model in its body frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelExtent {
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
    diameter_m: f64,
}

impl ModelExtent {
    /// Returns the extent of the vertices of a model, m; `None` without vertices.
    pub fn from_vertices(vertices_m: &[Vector3<f64>]) -> Option<Self> {
        let first = vertices_m.first()?;
        let low_m = vertices_m.iter().fold(*first, |low, vertex| low.inf(vertex));
        let high_m = vertices_m.iter().fold(*first, |high, vertex| high.sup(vertex));
        Some(Self { low_m, high_m, diameter_m: diameter(vertices_m, &(0.5 * (low_m + high_m))) })
    }

    /// Least coordinates, m.
    pub fn low_m(&self) -> &Vector3<f64> {
        &self.low_m
    }

    /// Sizes along the axes, m.
    pub fn size_m(&self) -> Vector3<f64> {
        self.high_m - self.low_m
    }

    /// Largest distance between two vertices, m.
    pub fn diameter_m(&self) -> f64 {
        self.diameter_m
    }
}

/// Returns the largest distance between two of some points, m. Points are visited from the farthest to the
/// nearest of `centre`: two points are no farther apart than the sum of their distances from it.
fn diameter(points_m: &[Vector3<f64>], centre: &Vector3<f64>) -> f64 {
    let mut points: Vec<(f64, &Vector3<f64>)> =
        points_m.iter().map(|point| ((point - centre).norm(), point)).collect();
    points.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let mut largest = 0.0_f64;
    for (index, (radius, point)) in points.iter().enumerate() {
        for (other_radius, other) in points.iter().skip(index + 1) {
            if radius + other_radius <= largest {
                break;
            }
            largest = largest.max((*point - *other).norm());
        }
    }
    largest
}

/// Camera under a name of lower-case letters, digits and hyphens.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelView {
    /// Name.
    pub name: String,
    /// Camera of the images.
    pub camera: ImageCamera,
}

/// Camera rows that an image holds: `first`, `first` + `step` and so on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowSampling {
    /// First camera row.
    pub first: usize,
    /// Camera rows from one image row to the next.
    pub step: usize,
    /// Number of image rows.
    pub rows: usize,
}

impl RowSampling {
    /// Returns the image row of a camera row, both counted from 0 at the centre of the first.
    pub fn image_row(&self, camera_row: f64) -> f64 {
        (camera_row - self.first as f64) / self.step as f64
    }
}

/// Camera as the pixels of its images show it: an image of a field has every second row of the camera.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageCamera {
    camera: Camera,
    sampling: RowSampling,
}

impl ImageCamera {
    /// Creates the camera of images that hold the given rows.
    pub fn new(camera: &Camera, sampling: RowSampling) -> Self {
        Self { camera: camera.clone(), sampling }
    }

    /// Columns and rows of an image.
    pub fn size(&self) -> (usize, usize) {
        (self.camera.columns, self.sampling.rows)
    }

    /// Width and height of a pixel of the image, µm.
    pub fn pixel_um(&self) -> [f64; 2] {
        [self.camera.pixel_width_um, self.camera.pixel_height_um * self.sampling.step as f64]
    }

    /// Focal length, mm.
    pub fn focal_length_mm(&self) -> f64 {
        self.camera.focal_length_mm
    }

    /// Focal lengths along columns and along rows, px of the image.
    pub fn focal_px(&self) -> [f64; 2] {
        let [width_um, height_um] = self.pixel_um();
        [self.camera.focal_length_mm * 1000.0 / width_um, self.camera.focal_length_mm * 1000.0 / height_um]
    }

    /// Principal point, px of the image; the centre of the first pixel is (0, 0).
    pub fn principal_px(&self) -> [f64; 2] {
        [self.camera.principal_x_px, self.sampling.image_row(self.camera.principal_y_px)]
    }

    /// Matrix K for pixel centres, row by row: the centre of the first pixel is (0, 0). Without distortion, a
    /// point (X, Y, Z) of the camera frame is at K (X, Y, Z)/Z.
    pub fn matrix(&self) -> [f64; 9] {
        let ([fx, fy], [cx, cy]) = (self.focal_px(), self.principal_px());
        [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
    }

    /// Returns true if the lens bends straight lines.
    pub fn is_distorted(&self) -> bool {
        self.camera.radial != [0.0; 3] || self.camera.tangential != [0.0; 2]
    }

    /// Distortion coefficients k1, k2, p1, p2, k3 of OpenCV, which apply to x' = X/Z and y' = Y/Z. `None`
    /// for a distorted camera whose pixels are not square: its coefficients apply to pixels, which OpenCV's
    /// formula cannot express. Rows that an image omits do not count: they scale the image after the
    /// distortion.
    pub fn distortion(&self) -> Option<[f64; 5]> {
        if !self.is_distorted() {
            return Some([0.0; 5]);
        }
        let (focal_px, focal_y_px) = self.camera.focal_length_px();
        let ([k1, k2, k3], [p1, p2]) = (self.camera.radial, self.camera.tangential);
        let f2 = focal_px * focal_px;
        // Coefficients in px become those of x' by a factor of the focal length for each power of px.
        let scaled = [k1 * f2, k2 * f2 * f2, p1 * focal_px, p2 * focal_px, k3 * f2 * f2 * f2];
        ((focal_px / focal_y_px - 1.0).abs() < 1e-9).then_some(scaled)
    }
}

impl LabelSet {
    /// Refuses formats that cannot express these labels.
    ///
    /// # Errors
    /// [`Failure::Usage`] for SPEED or BOP without an orientation, and for SPEED with distorted pixels that
    /// are not square.
    pub fn check(&self, formats: &LabelFormats) -> Result<(), Failure> {
        for format in [LabelFormat::Speed, LabelFormat::Bop].into_iter().filter(|f| formats.contains(*f)) {
            let without_pose = self.classes.iter().find(|class| class.model.is_none());
            if let Some(class) = without_pose {
                return Err(Failure::Usage(format!(
                    "--labels {formats}: {} states a pose, expected a {} with an orientation (plates or a mesh); \
                     coco and yolo need none",
                    format.code(),
                    class.name
                )));
            }
        }
        let bent = self.views.iter().find(|view| view.camera.distortion().is_none());
        match bent {
            Some(view) if formats.contains(LabelFormat::Speed) => Err(Failure::Usage(format!(
                "--labels {formats}: camera.json of speed cannot express the distortion of camera `{}`, expected \
                 square pixels or no distortion; coco, bop and yolo have no such limit",
                view.name
            ))),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Camera of 8 × 6 pixels, square, 100 px focal length, without distortion.
    pub(crate) fn camera() -> Camera {
        Camera {
            columns: 8,
            rows: 6,
            focal_length_mm: 1.0,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 3.5,
            principal_y_px: 2.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    fn set(camera: &Camera, model: Option<ModelExtent>) -> LabelSet {
        let sampling = RowSampling { first: 0, step: 1, rows: camera.rows };
        LabelSet {
            description: String::new(),
            classes: vec![LabelClass { name: "target".to_owned(), keypoints: Vec::new(), model }],
            views: vec![LabelView { name: "a".to_owned(), camera: ImageCamera::new(camera, sampling) }],
            note: None,
        }
    }

    /// The odd rows of a camera: row 1 is row 0 of the image, and the principal point (row 2.5) is at 0.75.
    #[test]
    fn a_field_has_half_the_focal_length_along_its_rows() {
        let field = ImageCamera::new(&camera(), RowSampling { first: 1, step: 2, rows: 3 });
        assert_eq!(field.matrix(), [100.0, 0.0, 3.5, 0.0, 50.0, 0.75, 0.0, 0.0, 1.0]);
        assert_eq!((field.size(), field.pixel_um()), ((8, 3), [10.0, 20.0]));
    }

    /// A point at x' = 0.02, y' = 0.01 is at (2, 1) px without distortion: r² = 5 px².
    #[test]
    fn distortion_per_pixel_becomes_that_of_opencv() {
        let bent = Camera { radial: [1e-3, 2e-5, 3e-7], tangential: [4e-4, 5e-4], ..camera() };
        let whole = RowSampling { first: 0, step: 1, rows: 6 };
        let [k1, k2, p1, p2, k3] = ImageCamera::new(&bent, whole).distortion().unwrap();
        let (x, y, r2) = (0.02, 0.01, 5e-4);
        let radial = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        let opencv = [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ];
        let radial = 1.0 + 1e-3 * 5.0 + 2e-5 * 25.0 + 3e-7 * 125.0;
        let ours = [
            2.0 * radial + 2.0 * 4e-4 * 2.0 + 5e-4 * (5.0 + 8.0),
            radial + 4e-4 * (5.0 + 2.0) + 2.0 * 5e-4 * 2.0,
        ];
        for (opencv, ours) in opencv.into_iter().zip(ours) {
            assert!((100.0 * opencv - ours).abs() < 1e-12, "{opencv} {ours}");
        }
    }

    #[test]
    fn formats_that_cannot_express_the_labels_are_refused() {
        let cube = [Vector3::zeros(), Vector3::new(1.0, 2.0, 2.0)];
        let model = ModelExtent::from_vertices(&cube);
        assert_eq!(model.unwrap().diameter_m(), 3.0);
        let all = "coco,speed,bop,yolo".parse().unwrap();
        set(&camera(), model).check(&all).unwrap();
        let message = set(&camera(), None).check(&"bop".parse().unwrap()).unwrap_err().to_string();
        assert!(message.contains("--labels bop: bop states a pose, expected a target with"), "{message}");
        set(&camera(), None).check(&"coco,yolo".parse().unwrap()).unwrap();
        let oblong = Camera { pixel_height_um: 8.0, radial: [1e-6, 0.0, 0.0], ..camera() };
        let message = set(&oblong, model).check(&all).unwrap_err().to_string();
        assert!(message.contains("distortion of camera `a`, expected square pixels"), "{message}");
        set(&oblong, model).check(&"coco,bop,yolo".parse().unwrap()).unwrap();
    }

    #[test]
    fn the_diameter_is_the_largest_distance_of_all_pairs() {
        let points: Vec<Vector3<f64>> = (0..60_i32)
            .map(|i| Vector3::new(f64::from(i * 37 % 11), f64::from(i * 53 % 17), f64::from(i * 29 % 7)))
            .collect();
        let pairs = points.iter().flat_map(|a| points.iter().map(move |b| (a - b).norm()));
        let largest = pairs.fold(0.0, f64::max);
        assert_eq!(ModelExtent::from_vertices(&points).unwrap().diameter_m(), largest);
    }
}
