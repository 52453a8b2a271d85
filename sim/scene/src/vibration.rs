//! Vibration of the camera within an exposure: a blur of all images.

use contract::{Angle, Body, CameraFrame, Direction, OutOfRange, PixelPoint, Rotation};
use nalgebra::{Matrix2, Vector2, Vector3};
use optics::{ImagePoint, Projection};

/// Largest blur, px, one standard deviation. A wider one is a motion, which the guidance or the drift of a
/// scenario describes.
const MAX_BLUR_PX: f64 = 4.0;
/// Distance h between the points of a blur, in standard deviations and in pixels: the smaller counts. Sum and
/// integral differ by 2 exp(−2π² s²/h²) of the peak, where 1/s² = 1/σ² + 1/p² and p is the width of the
/// point-spread function with that of a pixel, 0.29 px: 4e-4 for a Gaussian of 0.4 px, less for wider ones.
const SPACING_SIGMA: f64 = 0.8;
const SPACING_PX: f64 = 0.6;
/// Distance from the centre up to which a blur has points, standard deviations.
const REACH_SIGMA: f64 = 4.0;

/// Vibration about the body axes with periods much shorter than the exposure. During an exposure the rotation
/// of the camera is distributed as N(0, σ²) about each axis, independently, so an image is the convolution of
/// the image without vibration with a Gaussian. Its covariance is Σ dᵢ dᵢᵀ, where dᵢ is the displacement of
/// the image by a rotation of σᵢ about axis i; rotation about the boresight blurs the edge of the field more
/// than its centre. To second order an arc also moves the mean of an image inwards, by σ²/2 of its distance
/// from the axis: 5e-4 of the distance at 2°.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Rotation vectors of one standard deviation about each body axis, in the camera frame, rad.
    turns_rad: [Vector3<f64>; 3],
}

impl Vibration {
    /// Creates a vibration of these standard deviations about the body axes, rad; `None` if all are zero.
    ///
    /// # Errors
    /// [`OutOfRange`] for a blur of more than 4 px on the detector.
    pub fn new(
        sigma_rad: Vector3<f64>,
        camera_from_body: &Rotation<CameraFrame, Body>,
        projection: &Projection,
    ) -> Result<Option<Self>, OutOfRange> {
        if sigma_rad == Vector3::zeros() {
            return Ok(None);
        }
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let turn = |axis: usize| camera_from_body.rotate(&(axes[axis] * sigma_rad[axis]));
        let vibration = Self { turns_rad: [turn(0), turn(1), turn(2)] };
        let longest_px = vibration.longest_px(projection);
        if longest_px > MAX_BLUR_PX {
            let arcsec = Angle::from_radians(sigma_rad.max()).arcsec();
            return Err(OutOfRange::new(
                "attitude.control.vibration_arcsec",
                arcsec,
                format!("a blur of at most {MAX_BLUR_PX} px on the detector ({longest_px:.3} px)"),
            ));
        }
        Ok(Some(vibration))
    }

    /// Returns the largest rotation that the blur takes into account.
    pub fn reach(&self) -> Angle {
        let [a, b, c] = self.turns_rad.map(|turn| turn.norm_squared());
        Angle::from_radians(REACH_SIGMA * (a + b + c).sqrt())
    }

    /// Writes the points of the blur at a position of the detector to `points`, as displacements, px. Their
    /// shares add up to 1.
    pub fn points(&self, position: PixelPoint, projection: &Projection, points: &mut Vec<ImagePoint>) {
        points.clear();
        let Blur { mean_px, axes, sigma_px: [long_px, short_px] } = self.blur(position, projection);
        let (along, across) = (nodes(long_px), nodes(short_px));
        for a in &along {
            for b in &across {
                let moved = mean_px + axes[0] * a.at_px + axes[1] * b.at_px;
                points.push(ImagePoint {
                    position: PixelPoint::new(moved.x, moved.y),
                    share: a.share * b.share,
                });
            }
        }
    }

    /// Returns the widest blur in the middle and at the corners of the detector, px, one standard deviation.
    fn longest_px(&self, projection: &Projection) -> f64 {
        let (columns, rows) = projection.detector();
        let (right, bottom) = (columns as f64 - 1.0, rows as f64 - 1.0);
        let places = [(0.5 * right, 0.5 * bottom), (0.0, 0.0), (right, 0.0), (0.0, bottom), (right, bottom)];
        let mut longest_px: f64 = 0.0;
        for (x, y) in places {
            let [at_place_px, _] = self.blur(PixelPoint::new(x, y), projection).sigma_px;
            longest_px = longest_px.max(at_place_px);
        }
        longest_px
    }

    /// Returns the blur of a point at a position of the detector.
    fn blur(&self, position: PixelPoint, projection: &Projection) -> Blur {
        let mut covariance = Matrix2::zeros();
        let mut mean_px = Vector2::zeros();
        for turn in &self.turns_rad {
            let Some(moved) = displacement(position, turn, projection) else { continue };
            covariance += moved.half_difference_px * moved.half_difference_px.transpose();
            mean_px += moved.mean_px;
        }
        Blur { mean_px, ..Blur::from_covariance(&covariance) }
    }
}

/// Displacement of a point of the image by a rotation of the camera and by its opposite.
struct Displacement {
    half_difference_px: Vector2<f64>,
    mean_px: Vector2<f64>,
}

/// Returns the displacement of a point of the image by a rotation vector of the camera, to second order in
/// the angle; `None` where a direction has no image.
fn displacement(
    position: PixelPoint,
    turn_rad: &Vector3<f64>,
    projection: &Projection,
) -> Option<Displacement> {
    let direction = *projection.unproject(position)?.vector();
    let moved = turn_rad.cross(&direction);
    let bent = direction + 0.5 * turn_rad.cross(&moved);
    let ahead = projection.project(&Direction::from_vector(bent + moved).ok()?)?;
    let behind = projection.project(&Direction::from_vector(bent - moved).ok()?)?;
    Some(Displacement {
        half_difference_px: Vector2::new(0.5 * (ahead.x - behind.x), 0.5 * (ahead.y - behind.y)),
        mean_px: Vector2::new(
            0.5 * (ahead.x + behind.x) - position.x,
            0.5 * (ahead.y + behind.y) - position.y,
        ),
    })
}

/// Gaussian blur of a point.
struct Blur {
    /// Mean displacement, px.
    mean_px: Vector2<f64>,
    /// Directions of the axes of the ellipse.
    axes: [Vector2<f64>; 2],
    /// Standard deviations along the axes, px, the larger first.
    sigma_px: [f64; 2],
}

impl Blur {
    /// Returns the blur with this covariance, px².
    fn from_covariance(covariance: &Matrix2<f64>) -> Self {
        let (xx, xy, yy) = (covariance.m11, covariance.m12, covariance.m22);
        let middle = 0.5 * (xx + yy);
        let half_difference = (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt();
        let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
        let (sine, cosine) = libm::sincos(angle);
        Self {
            mean_px: Vector2::zeros(),
            axes: [Vector2::new(cosine, sine), Vector2::new(-sine, cosine)],
            sigma_px: [middle + half_difference, middle - half_difference].map(|v| v.max(0.0).sqrt()),
        }
    }
}

/// Node of a Gaussian along one axis.
struct Node {
    at_px: f64,
    share: f64,
}

/// Returns equally spaced nodes of a Gaussian; a single one for a width that changes no image.
fn nodes(sigma_px: f64) -> Vec<Node> {
    /// Width below which a blur changes no pixel by 1e-4 of the peak.
    const POINT_PX: f64 = 0.003;
    if sigma_px < POINT_PX {
        return vec![Node { at_px: 0.0, share: 1.0 }];
    }
    let spacing_px = (SPACING_SIGMA * sigma_px).min(SPACING_PX);
    let count = (REACH_SIGMA * sigma_px / spacing_px).ceil() as i32;
    let mut nodes = Vec::with_capacity(2 * count as usize + 1);
    let mut sum = 0.0;
    for index in -count..=count {
        let at_px = f64::from(index) * spacing_px;
        let share = libm::exp(-0.5 * (at_px / sigma_px) * (at_px / sigma_px));
        sum += share;
        nodes.push(Node { at_px, share });
    }
    for node in &mut nodes {
        node.share /= sum;
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Camera;

    fn projection() -> Projection {
        Projection::new(&Camera {
            columns: 101,
            rows: 101,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            focal_length_mm: 100.0,
            principal_x_px: 50.0,
            principal_y_px: 50.0,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        })
        .unwrap()
    }

    fn vibration(x: f64, y: f64, z: f64) -> Vibration {
        let none = Rotation::from_rotation_vector(Vector3::zeros());
        Vibration::new(Vector3::new(x, y, z), &none, &projection()).unwrap().unwrap()
    }

    /// Mean and covariance of points.
    fn moments(points: &[ImagePoint]) -> (Vector2<f64>, Matrix2<f64>) {
        let mut mean = Vector2::zeros();
        let mut square = Matrix2::zeros();
        for point in points {
            let at = Vector2::new(point.position.x, point.position.y);
            mean += at * point.share;
            square += at * at.transpose() * point.share;
        }
        (mean, square - mean * mean.transpose())
    }

    #[test]
    fn points_have_the_moments_of_the_rotations() {
        // 1e-4 rad are one pixel at a focal length of 10,000 px; about the boresight, 50 px from the centre
        // move by 50 times the angle.
        let mut points = Vec::new();
        vibration(2e-4, 5e-5, 0.0).points(PixelPoint::new(50.0, 50.0), &projection(), &mut points);
        let (mean, covariance) = moments(&points);
        assert!(mean.norm() < 1e-5 && (points.iter().map(|p| p.share).sum::<f64>() - 1.0).abs() < 1e-12);
        // Rotation about x moves rows, about y columns.
        assert!((covariance.m22 - 4.0).abs() < 0.01 && (covariance.m11 - 0.25).abs() < 0.001, "{covariance}");
        vibration(0.0, 0.0, 0.02).points(PixelPoint::new(100.0, 50.0), &projection(), &mut points);
        let (_, covariance) = moments(&points);
        assert!((covariance.m22 - 1.0).abs() < 0.003 && covariance.m11 < 1e-4, "{covariance}");
        // The mean over an arc of radius R and normally distributed angles is R exp(−σ²/2).
        let (mean, _) = moments(&points);
        assert!((mean.x - 50.0 * (libm::exp(-0.0002) - 1.0)).abs() < 1e-5 && mean.y.abs() < 1e-9, "{mean}");
    }

    #[test]
    fn no_vibration_is_none_and_a_wide_one_is_refused() {
        let none = Rotation::from_rotation_vector(Vector3::zeros());
        assert_eq!(Vibration::new(Vector3::zeros(), &none, &projection()).unwrap(), None);
        let error = Vibration::new(Vector3::new(1e-3, 0.0, 0.0), &none, &projection()).unwrap_err();
        assert!(error.to_string().starts_with("attitude.control.vibration_arcsec is 206."), "{error}");
        assert!(error.to_string().contains("at most 4 px"), "{error}");
        // About the boresight the corners, 71 px away, are blurred most.
        assert!(Vibration::new(Vector3::new(0.0, 0.0, 0.05), &none, &projection()).is_ok());
        assert!(Vibration::new(Vector3::new(0.0, 0.0, 0.07), &none, &projection()).is_err());
    }
}
