//! Camera model of the simulator: pinhole with Brown's distortion, exact forwards and by Newton's method
//! backwards.
//!
//! The distortion maps the undistorted offset (u, v) from the principal point to the distorted offset. In the
//! form given at [`contract::Camera`] its Jacobian is symmetric, so the map is the gradient of a potential:
//! where the Jacobian is positive definite on a convex set, the potential is strictly convex there and no two
//! points share an image. This identifies a camera whose distortion folds inside the detector.

use std::f64::consts::PI;

use contract::{Angle, Camera, CameraFrame, Direction, OutOfRange, PixelPoint};
use nalgebra::Vector3;
use truth::SimError;

/// Maps directions in the camera frame to pixels and back.
///
/// ```
/// use boresight_optics::Projection;
/// use contract::{Camera, Direction};
/// let camera = Camera {
///     columns: 752, rows: 580, focal_length_mm: 20.187, pixel_width_um: 8.6, pixel_height_um: 8.3,
///     principal_x_px: 395.0, principal_y_px: 288.0, radial: [2.6e-8, 0.0, 0.0], tangential: [0.0, 0.0],
/// };
/// let projection = Projection::new(&camera)?;
/// let boresight = projection.project(&Direction::z()).ok_or("behind the camera")?;
/// assert_eq!((boresight.x, boresight.y), (395.0, 288.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Projection {
    columns: usize,
    rows: usize,
    /// Focal length, px, along columns and along rows.
    focal_x_px: f64,
    focal_y_px: f64,
    principal: PixelPoint,
    distortion: Distortion,
    /// Radius of undistorted offsets, px, within which the distortion is verified to be one-to-one.
    domain_px: f64,
    half_diagonal: Angle,
}

impl Projection {
    /// Limit of the distortion's domain, as a multiple of the distance of the detector's farthest corner.
    const DOMAIN_FACTOR: f64 = 3.0;
    /// Number of points on each side of the detector's border that are checked on construction, corners
    /// included.
    const BORDER_POINTS: usize = 129;

    /// Creates the model of a camera.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a number out of range, and if the distortion folds inside the detector,
    /// so that a pixel has no direction or more than one.
    pub fn new(camera: &Camera) -> Result<Self, SimError> {
        camera.check()?;
        let (focal_x_px, focal_y_px) = camera.focal_length_px();
        let principal = PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
        let distortion = Distortion { radial: camera.radial, tangential: camera.tangential };
        let (right, bottom) = (camera.columns as f64 - 0.5, camera.rows as f64 - 0.5);
        let corner_px = [(-0.5, -0.5), (right, -0.5), (-0.5, bottom), (right, bottom)]
            .into_iter()
            .map(|(x, y)| principal.distance(PixelPoint::new(x, y)))
            .fold(1.0, f64::max);
        let mut projection = Self {
            columns: camera.columns,
            rows: camera.rows,
            focal_x_px,
            focal_y_px,
            principal,
            distortion,
            domain_px: distortion.one_to_one_radius(Self::DOMAIN_FACTOR * corner_px),
            half_diagonal: Angle::ZERO,
        };
        projection.half_diagonal = projection.border_angle().ok_or_else(|| {
            OutOfRange::new(
                "camera.radial, camera.tangential",
                format!("{:?}, {:?}", camera.radial, camera.tangential),
                format!(
                    "a distortion that is one-to-one on the detector: this one folds back {:.0} px from the \
                     principal point",
                    projection.distortion.distort(Offset { u: projection.domain_px, v: 0.0 }).length()
                ),
            )
        })?;
        Ok(projection)
    }

    /// Returns the pixel position of a direction. The point may lie off the detector.
    ///
    /// `None` behind the camera (z ≤ 0), and so far off the detector (more than three times its half
    /// diagonal, or beyond a fold) that the distortion polynomial is meaningless: there it could map a star
    /// from outside the field back into it.
    pub fn project(&self, direction: &Direction<CameraFrame>) -> Option<PixelPoint> {
        let vector = direction.vector();
        if vector.z <= 0.0 {
            return None;
        }
        let offset =
            Offset { u: self.focal_x_px * (vector.x / vector.z), v: self.focal_y_px * (vector.y / vector.z) };
        if !self.is_one_to_one_at(offset) {
            return None;
        }
        let distorted = self.distortion.distort(offset);
        Some(PixelPoint::new(self.principal.x + distorted.u, self.principal.y + distorted.v))
    }

    /// Returns the direction that is projected to a point: the inverse of [`Projection::project`], to 1e-12
    /// px and the rounding of the coordinates. `None` if there is no such direction; never on the detector.
    pub fn unproject(&self, point: PixelPoint) -> Option<Direction<CameraFrame>> {
        let distorted = Offset { u: point.x - self.principal.x, v: point.y - self.principal.y };
        let offset = self.distortion.undistort(distorted)?;
        if !self.is_one_to_one_at(offset) {
            return None;
        }
        let vector = Vector3::new(offset.u / self.focal_x_px, offset.v / self.focal_y_px, 1.0);
        Direction::from_vector(vector).ok()
    }

    /// Pixel position of an undistorted offset from the principal point, px, for outlines that extend beyond
    /// the detector.
    ///
    /// Beyond the radius within which the distortion is verified to be one-to-one it is continued in
    /// proportion along the ray, so that no point from there returns into the image.
    pub fn pixel_position(&self, u: f64, v: f64) -> PixelPoint {
        let radius = Offset { u, v }.length();
        let scale = if radius > self.domain_px { self.domain_px / radius } else { 1.0 };
        let distorted = self.distortion.distort(Offset { u: u * scale, v: v * scale });
        PixelPoint::new(self.principal.x + distorted.u / scale, self.principal.y + distorted.v / scale)
    }

    /// Returns true if the distortion bends straight lines.
    pub fn is_distorted(&self) -> bool {
        self.domain_px.is_finite()
    }

    /// Largest angle between the boresight and a direction on the detector: the radius of the cone that holds
    /// the whole field, distortion included.
    pub fn half_diagonal(&self) -> Angle {
        self.half_diagonal
    }

    /// Width and height of the field through the principal point.
    pub fn field(&self) -> Option<[Angle; 2]> {
        let (right, bottom) = (self.columns as f64 - 0.5, self.rows as f64 - 0.5);
        let PixelPoint { x, y } = self.principal;
        let across = |a: PixelPoint, b: PixelPoint| Some(self.unproject(a)?.separation(&self.unproject(b)?));
        Some([
            across(PixelPoint::new(-0.5, y), PixelPoint::new(right, y))?,
            across(PixelPoint::new(x, -0.5), PixelPoint::new(x, bottom))?,
        ])
    }

    /// Plate scale at the boresight, pixels per radian, along columns and along rows.
    pub fn plate_scale_px_per_rad(&self) -> (f64, f64) {
        (self.focal_x_px, self.focal_y_px)
    }

    /// Number of columns and rows of the detector.
    pub fn detector(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Returns true if the distortion is one-to-one at an undistorted offset; false if the offset has
    /// overflowed to NaN.
    fn is_one_to_one_at(&self, offset: Offset) -> bool {
        offset.length() <= self.domain_px
    }

    /// Largest angle to the boresight on the detector's border; `None` if a point of the border has no
    /// direction.
    ///
    /// The disk on which the distortion is one-to-one has an image without holes, so if the image contains
    /// the border it contains the detector. An angle to the boresight has no maximum inside, so the largest
    /// angle is on the border.
    fn border_angle(&self) -> Option<Angle> {
        let (width, height) = (self.columns as f64, self.rows as f64);
        let mut largest = 0.0_f64;
        for i in 0..Self::BORDER_POINTS {
            let t = i as f64 / (Self::BORDER_POINTS - 1) as f64;
            for (across, down) in [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)] {
                let point = PixelPoint::new(across * width - 0.5, down * height - 0.5);
                let direction = self.unproject(point)?;
                largest = largest.max(direction.separation(&Direction::z()).radians());
            }
        }
        Some(Angle::from_radians(largest))
    }
}

/// Offset from the principal point, px.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Offset {
    u: f64,
    v: f64,
}

impl Offset {
    fn length(self) -> f64 {
        (self.u * self.u + self.v * self.v).sqrt()
    }
}

/// Symmetric Jacobian of the distortion.
struct Jacobian {
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Jacobian {
    fn determinant(&self) -> f64 {
        self.uu * self.vv - self.uv * self.uv
    }

    /// Returns the offset that the Jacobian maps to `image`.
    fn solve(&self, image: Offset) -> Offset {
        let determinant = self.determinant();
        Offset {
            u: (self.vv * image.u - self.uv * image.v) / determinant,
            v: (self.uu * image.v - self.uv * image.u) / determinant,
        }
    }

    fn is_positive_definite(&self) -> bool {
        self.uu > 0.0 && self.determinant() > 0.0
    }
}

/// Brown's radial and tangential distortion on pixel offsets (formula at [`contract::Camera`]).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Distortion {
    radial: [f64; 3],
    tangential: [f64; 2],
}

impl Distortion {
    /// Numbers of rings and rays on which the Jacobian is checked.
    const RINGS: usize = 256;
    const RAYS: usize = 64;
    /// Limit of Newton steps. Each step doubles the digits; even with the halved steps of a bad start the
    /// number stays far below this limit.
    const MAX_STEPS: usize = 100;

    /// Returns the distorted offset from the principal point, px, of an undistorted one. The coefficients are
    /// those of powers of pixels.
    fn distort(&self, Offset { u, v }: Offset) -> Offset {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = u * u + v * v;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        Offset {
            u: u * radial + 2.0 * p1 * u * v + p2 * (r2 + 2.0 * u * u),
            v: v * radial + p1 * (r2 + 2.0 * v * v) + 2.0 * p2 * u * v,
        }
    }

    fn jacobian(&self, Offset { u, v }: Offset) -> Jacobian {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = u * u + v * v;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        // Twice the derivative of the radial factor with respect to r².
        let slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));
        Jacobian {
            uu: radial + u * u * slope + 2.0 * p1 * v + 6.0 * p2 * u,
            uv: u * v * slope + 2.0 * p1 * u + 2.0 * p2 * v,
            vv: radial + v * v * slope + 6.0 * p1 * v + 2.0 * p2 * u,
        }
    }

    /// Returns the undistorted offset, by Newton's method with halved steps; `None` if the method does not
    /// converge.
    fn undistort(&self, distorted: Offset) -> Option<Offset> {
        let residual_at = |at: Offset| {
            let image = self.distort(at);
            Offset { u: distorted.u - image.u, v: distorted.v - image.v }
        };
        let mut at = distorted;
        let mut residual = residual_at(at);
        for _ in 0..Self::MAX_STEPS {
            if residual == (Offset { u: 0.0, v: 0.0 }) {
                break;
            }
            // A singular Jacobian gives a step that is not a number, which never reduces the residual.
            let step = self.jacobian(at).solve(residual);
            let mut shorter = (0..20).map(|halvings| 1.0 / f64::from(1_u32 << halvings)).map(|part| {
                let next = Offset { u: at.u + part * step.u, v: at.v + part * step.v };
                (next, residual_at(next))
            });
            // No step reduces the residual: either the last bit is reached, or there is no inverse.
            match shorter.find(|(_, left)| left.length() < residual.length()) {
                Some((next, left)) => (at, residual) = (next, left),
                None => break,
            }
        }
        (residual.length() <= Self::tolerance_px(distorted)).then_some(at)
    }

    /// Residual that the inverse of an offset may leave: the rounding of its coordinates.
    fn tolerance_px(distorted: Offset) -> f64 {
        1e-12 + 8.0 * f64::EPSILON * distorted.length()
    }

    /// Largest radius up to `limit_px` on whose disk the Jacobian is positive definite at every point of a
    /// polar grid; infinity without distortion.
    fn one_to_one_radius(&self, limit_px: f64) -> f64 {
        if self.radial == [0.0; 3] && self.tangential == [0.0; 2] {
            return f64::INFINITY;
        }
        let mut radius = 0.0;
        for ring in 1..=Self::RINGS {
            let next = limit_px * ring as f64 / Self::RINGS as f64;
            let holds = (0..Self::RAYS).all(|ray| {
                let (sin, cos) = libm::sincos(2.0 * PI * ray as f64 / Self::RAYS as f64);
                self.jacobian(Offset { u: next * cos, v: next * sin }).is_positive_definite()
            });
            if !holds {
                break;
            }
            radius = next;
        }
        radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Camera of the far-range paper, Table 1, with its principal point counted from zero.
    fn table_1() -> Camera {
        Camera {
            columns: 752,
            rows: 580,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 395.0,
            principal_y_px: 288.0,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [0.0, 0.0],
        }
    }

    fn direction(x: f64, y: f64, z: f64) -> Direction<CameraFrame> {
        Direction::from_vector(Vector3::new(x, y, z)).unwrap()
    }

    #[test]
    fn without_distortion_the_projection_follows_similar_triangles() {
        let camera = Camera {
            focal_length_mm: 10.0,
            pixel_width_um: 10.0,
            pixel_height_um: 5.0,
            radial: [0.0; 3],
            ..table_1()
        };
        let point = Projection::new(&camera).unwrap().project(&direction(0.1, -0.05, 1.0)).unwrap();
        // f/pixel is 1000 and 2000 px: 395 + 100, 288 − 100.
        assert!(point.distance(PixelPoint::new(495.0, 188.0)) < 1e-10);
    }

    #[test]
    fn the_far_corner_of_table_1_is_displaced_by_3_1_px() {
        let camera = table_1();
        let straight = Camera { radial: [0.0; 3], ..camera.clone() };
        let corner = Projection::new(&straight).unwrap().unproject(PixelPoint::new(0.0, 0.0)).unwrap();
        let seen = Projection::new(&camera).unwrap().project(&corner).unwrap();
        let displaced = seen.distance(PixelPoint::new(0.0, 0.0));
        // k1 r³ with r² = 395² + 288².
        assert!((displaced - 2.6e-8 * libm::pow(488.845, 3.0)).abs() < 1e-4, "{displaced}");
        assert!((displaced - 3.1).abs() < 0.1, "{displaced}");
    }

    #[test]
    fn tangential_distortion_has_the_sign_of_its_formula() {
        let camera = Camera { radial: [0.0; 3], tangential: [1e-5, -2e-5], ..table_1() };
        let projection = Projection::new(&camera).unwrap();
        let (fx, fy) = camera.focal_length_px();
        let point = projection.project(&direction(100.0 / fx, 50.0 / fy, 1.0)).unwrap();
        // u = 100, v = 50, r² = 12500.
        let u = 100.0 + 2.0 * 1e-5 * 5000.0 - 2e-5 * (12500.0 + 20000.0);
        let v = 50.0 + 1e-5 * (12500.0 + 5000.0) - 2.0 * 2e-5 * 5000.0;
        assert!(point.distance(PixelPoint::new(395.0 + u, 288.0 + v)) < 1e-10);
    }

    /// All five coefficients at once; the expected values are exact rational numbers.
    const BENT: Distortion = Distortion { radial: [3e-8, -2e-14, 5e-21], tangential: [2e-6, -3e-6] };

    #[test]
    fn the_distortion_is_that_of_its_formula() {
        for (u, v, x, y) in
            [(300.0, -200.0, 299.901_895_5, -199.934_597), (-1200.0, 700.0, -1_241.006_742, 724.403_099_5)]
        {
            let bent = BENT.distort(Offset { u, v });
            assert!((bent.u - x).abs() < 1e-9 && (bent.v - y).abs() < 1e-9, "{bent:?}");
            let back = BENT.undistort(Offset { u: x, v: y }).unwrap();
            assert!((back.u - u).abs() < 1e-9 && (back.v - v).abs() < 1e-9, "{back:?}");
        }
    }

    /// Newton's method would find the inverse even with wrong slopes, in more steps, so the slopes are
    /// compared with finite differences.
    #[test]
    fn the_jacobian_is_that_of_the_distortion() {
        let strong = Distortion { radial: [3e-7, -2e-12, 4e-18], tangential: [5e-5, -8e-5] };
        for (u, v) in [(310.0, -200.0), (-250.0, 120.0), (40.0, 390.0)] {
            let h = 1e-3;
            let difference = |du: f64, dv: f64| {
                let above = strong.distort(Offset { u: u + du, v: v + dv });
                let below = strong.distort(Offset { u: u - du, v: v - dv });
                ((above.u - below.u) / (2.0 * h), (above.v - below.v) / (2.0 * h))
            };
            let ((uu, vu), (uv, vv)) = (difference(h, 0.0), difference(0.0, h));
            let jacobian = strong.jacobian(Offset { u, v });
            for (slope, expected) in
                [(jacobian.uu, uu), (jacobian.uv, uv), (jacobian.uv, vu), (jacobian.vv, vv)]
            {
                assert!((slope - expected).abs() < 1e-8, "{u} {v}: {slope}, expected {expected}");
            }
        }
    }

    /// r + k1 r³ turns back at r = 1/√(3 |k1|) = 577.35, v + 3 p1 v² at −1/(6 p1) = −166.67; the result is
    /// the last ring before it, on a grid of 256 rings.
    #[test]
    fn the_distortion_is_one_to_one_up_to_its_fold() {
        let radial = Distortion { radial: [-1e-6, 0.0, 0.0], tangential: [0.0; 2] };
        let tangential = Distortion { radial: [0.0; 3], tangential: [1e-3, 0.0] };
        let swapped = Distortion { radial: [0.0; 3], tangential: [0.0, -1e-3] };
        for (distortion, fold_px) in [(radial, 577.35), (tangential, 166.67), (swapped, 166.67)] {
            let radius = distortion.one_to_one_radius(1000.0);
            assert!(radius <= fold_px && radius > fold_px - 1000.0 / 256.0, "{radius}, fold at {fold_px}");
        }
        assert_eq!(radial.one_to_one_radius(500.0), 500.0);
        let none = Distortion { radial: [0.0; 3], tangential: [0.0; 2] };
        assert_eq!(none.one_to_one_radius(500.0), f64::INFINITY);
    }

    /// 2 · 3 + 1 · (−4) = 2 and 1 · 3 + 5 · (−4) = −17.
    #[test]
    fn two_equations_are_solved() {
        let solved = Jacobian { uu: 2.0, uv: 1.0, vv: 5.0 }.solve(Offset { u: 2.0, v: -17.0 });
        assert_eq!(solved, Offset { u: 3.0, v: -4.0 });
    }

    /// r (1 + 1e-6 r² + 3.6e-12 r⁴ − 1.25e-17 r⁶) grows up to 600 px; Newton's method starts at 580, where
    /// its full step does not reduce the residual.
    #[test]
    fn steps_that_go_too_far_are_halved() {
        let distortion = Distortion { radial: [1e-6, 3.6e-12, -1.25e-17], tangential: [0.0; 2] };
        let back = distortion.undistort(distortion.distort(Offset { u: 462.0, v: 0.0 })).unwrap();
        assert!((back.u - 462.0).abs() < 1e-9 && back.v == 0.0, "{back:?}");
    }

    /// r − 1e-6 r³ is 384.9 px at most: points beyond have no inverse, however close they are to this limit.
    #[test]
    fn a_position_that_no_direction_maps_to_has_no_inverse() {
        let folded = Distortion { radial: [-1e-6, 0.0, 0.0], tangential: [0.0; 2] };
        assert!(folded.undistort(Offset { u: 384.5, v: 0.0 }).is_some());
        assert_eq!(folded.undistort(Offset { u: 385.5, v: 0.0 }), None);
        // 1e-12 px and 1.776e-15 of 1000 px.
        assert!((Distortion::tolerance_px(Offset { u: 600.0, v: -800.0 }) - 2.776e-12).abs() < 1e-15);
    }

    /// A saddle has a positive slope along one axis and reverses the other axis.
    #[test]
    fn a_jacobian_is_positive_definite_when_both_its_eigenvalues_are() {
        assert_eq!(Jacobian { uu: 2.0, uv: 3.0, vv: 4.0 }.determinant(), -1.0);
        let is_positive = |uu, uv, vv| Jacobian { uu, uv, vv }.is_positive_definite();
        assert!(is_positive(1.0, 0.5, 2.0) && is_positive(2.0, -1.0, 1.0));
        // Eigenvalues of opposite signs, both negative, and one of them zero.
        assert!(!is_positive(1.0, 2.0, 1.0) && !is_positive(1.0, 0.0, -1.0) && !is_positive(-1.0, 0.5, -1.0));
        assert!(!is_positive(1.0, 1.0, 1.0) && !is_positive(0.0, 0.0, 1.0));
    }

    /// The farthest corner of Table 1 is 395.5 px to the left of the principal point and 291.5 px below it.
    #[test]
    fn a_direction_is_projected_up_to_three_times_the_half_diagonal() {
        let camera = table_1();
        let projection = Projection::new(&camera).unwrap();
        let (fx, fy) = camera.focal_length_px();
        let along = |u: f64, v: f64| direction(u / fx, v / fy, 1.0);
        let limit = 3.0 * libm::hypot(395.5, 291.5);
        for (u, v) in [(1.0, 0.0), (0.0, -1.0), (-0.6, 0.8)] {
            let inside = along(0.999 * limit * u, 0.999 * limit * v);
            assert!(projection.project(&inside).is_some(), "{u} {v}");
            assert_eq!(projection.project(&along(1.001 * limit * u, 1.001 * limit * v)), None, "{u} {v}");
        }
        // The inverse of a point so far away does not exist either.
        let pixel = projection.pixel_position(0.999 * limit, 0.0);
        assert!(projection.unproject(pixel).is_some());
        assert_eq!(projection.unproject(PixelPoint::new(pixel.x + 10.0, pixel.y)), None);
    }

    #[test]
    fn an_outline_continues_linearly_beyond_the_distortion() {
        let camera = Camera { radial: [-1e-7, 0.0, 0.0], ..table_1() };
        let projection = Projection::new(&camera).unwrap();
        let (fx, fy) = camera.focal_length_px();
        let offset = |pixel: PixelPoint| (pixel.x - 395.0, pixel.y - 288.0);
        for (u, v) in [(300.0, 100.0), (-0.6, 0.8), (-200.0, -120.0)] {
            let seen = projection.project(&direction(u / fx, v / fy, 1.0)).unwrap();
            assert!(projection.pixel_position(u, v).distance(seen) < 1e-9);
        }
        let (x, y) =
            offset(projection.pixel_position(-0.6 * projection.domain_px, 0.8 * projection.domain_px));
        let far = projection.pixel_position(-1.8 * projection.domain_px, 2.4 * projection.domain_px);
        assert!((offset(far).0 - 3.0 * x).abs() < 1e-6 && (offset(far).1 - 3.0 * y).abs() < 1e-6, "{far:?}");
        assert!(projection.is_distorted());
        let straight = Projection::new(&Camera { radial: [0.0; 3], ..camera }).unwrap();
        assert!(!straight.is_distorted());
        assert_eq!(offset(straight.pixel_position(1e6, -2e6)), (1e6, -2e6));
    }

    #[test]
    fn the_plate_scale_is_the_focal_length_in_pixels() {
        let projection = Projection::new(&table_1()).unwrap();
        let (along_columns, along_rows) = projection.plate_scale_px_per_rad();
        // 20.187 mm over 8.6 and 8.3 µm.
        assert!((along_columns - 2_347.325_581).abs() < 1e-6 && (along_rows - 2_432.168_675).abs() < 1e-6);
        assert_eq!(projection.detector(), (752, 580));
    }

    #[test]
    fn nothing_behind_the_camera_is_projected() {
        let projection = Projection::new(&table_1()).unwrap();
        assert_eq!(projection.project(&direction(0.0, 0.0, -1.0)), None);
        assert_eq!(projection.project(&direction(1.0, 0.0, 0.0)), None);
    }

    /// Barrel distortion of this strength maps directions beyond its fold at r = 1/sqrt(3 |k1|) = 1826 px
    /// back into the image.
    #[test]
    fn a_star_beyond_the_fold_does_not_come_back_into_the_field() {
        let camera = Camera { radial: [-1e-7, 0.0, 0.0], ..table_1() };
        let projection = Projection::new(&camera).unwrap();
        let (fx, _) = camera.focal_length_px();
        assert!(projection.project(&direction(400.0 / fx, 0.0, 1.0)).is_some());
        // 3100 px (1 − 0.961) = 121 px: on the detector, if the polynomial were applied there.
        assert_eq!(projection.project(&direction(3100.0 / fx, 0.0, 1.0)), None);
    }

    #[test]
    fn a_distortion_that_folds_inside_the_detector_is_refused() {
        for (radial, tangential) in
            [([-4e-6, 0.0, 0.0], [0.0; 2]), ([0.0, 0.0, -1e-15], [0.0; 2]), ([0.0; 3], [5e-3, 0.0])]
        {
            let camera = Camera { radial, tangential, ..table_1() };
            let error = Projection::new(&camera).unwrap_err().to_string();
            assert!(error.contains("fold"), "{error}");
        }
    }

    #[test]
    fn the_half_diagonal_reaches_every_pixel_and_no_farther() {
        let projection = Projection::new(&table_1()).unwrap();
        let half_diagonal = projection.half_diagonal().radians();
        let mut largest = 0.0_f64;
        for x in 0..752 {
            for y in [-0.5, 100.0, 288.0, 579.5] {
                let at = projection.unproject(PixelPoint::new(f64::from(x), y)).unwrap();
                largest = largest.max(at.separation(&Direction::z()).radians());
            }
        }
        assert!(largest <= half_diagonal);
        // Table 1 has its farthest corner at the lower left: half a pixel (0.0002 rad) from the last point
        // tried.
        assert!(half_diagonal - largest < 3e-4);
        // Half of the diagonal of 18.2° × 13.6° is 11.4°; the principal point is 24 px from the centre.
        assert!((projection.half_diagonal().degrees() - 11.7).abs() < 0.1);
    }

    /// For a corner of the detector to the right of and below the principal point the last point of each side
    /// is required.
    #[test]
    fn the_half_diagonal_is_that_of_the_farthest_corner_wherever_it_is() {
        for (x, y, corner) in
            [(10.0, 20.0, (751.5, 579.5)), (700.0, 20.0, (-0.5, 579.5)), (10.0, 500.0, (751.5, -0.5))]
        {
            let camera = Camera { principal_x_px: x, principal_y_px: y, radial: [0.0; 3], ..table_1() };
            let (fx, fy) = camera.focal_length_px();
            let expected = libm::atan(libm::hypot((corner.0 - x) / fx, (corner.1 - y) / fy));
            let actual = Projection::new(&camera).unwrap().half_diagonal().radians();
            assert!((actual - expected).abs() < 1e-12, "{x} {y}: {actual}, expected {expected}");
        }
    }

    proptest! {
        #[test]
        fn the_round_trip_holds_over_the_whole_field(
            x in -0.5..751.5_f64, y in -0.5..579.5_f64,
            k1 in -5e-8..5e-8_f64, k2 in -1e-14..1e-14_f64, k3 in -1e-20..1e-20_f64,
            p1 in -1e-6..1e-6_f64, p2 in -1e-6..1e-6_f64,
        ) {
            let camera = Camera { radial: [k1, k2, k3], tangential: [p1, p2], ..table_1() };
            let projection = Projection::new(&camera).unwrap();
            let point = PixelPoint::new(x, y);
            let back = projection.project(&projection.unproject(point).unwrap()).unwrap();
            // Tolerance of 1e-9 px: Newton's 1e-12 px, and the rounding of a unit vector times f = 2400 px
            // (5e-13 px).
            prop_assert!(back.distance(point) < 1e-9, "{back:?}");
        }
    }
}
