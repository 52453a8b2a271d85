//! Camera model of the pipelines: the map h and its inverse.

use contract::{Camera, CameraFrame, ContractError, Direction, PixelPoint};
use nalgebra::Vector3;

/// The map h from directions in the camera frame to pixels, and its inverse (far-range paper, section 2.1 and
/// Table 1; formula at [`Camera`]).
///
/// A strong distortion folds the image back on itself far outside the field. The model computes the radius of
/// this fold and rejects directions beyond it, which would otherwise appear at a wrong position.
#[derive(Debug, Clone)]
pub struct CameraModel {
    columns: usize,
    rows: usize,
    focal_x_px: f64,
    focal_y_px: f64,
    principal: PixelPoint,
    radial: [f64; 3],
    tangential: [f64; 2],
    /// Largest undistorted radius at which the distorted radius still increases, px; infinite without a fold.
    fold_radius_px: f64,
}

/// Largest number of steps of Newton's method, which doubles its digits at each step: a start that needs more
/// does not converge.
const MAX_NEWTON_STEPS: usize = 30;

/// Largest residual of an accepted inverse, px: a millionth of the error of the best centroid.
const RESIDUAL_PX: f64 = 1e-8;

impl CameraModel {
    /// Creates the model of a camera.
    ///
    /// # Errors
    /// The errors of [`Camera::check`].
    pub fn new(camera: &Camera) -> Result<Self, ContractError> {
        camera.check()?;
        let (focal_x_px, focal_y_px) = camera.focal_length_px();
        let principal = PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
        let corner_px = farthest_corner_px((camera.columns, camera.rows), principal);
        Ok(Self {
            columns: camera.columns,
            rows: camera.rows,
            focal_x_px,
            focal_y_px,
            principal,
            radial: camera.radial,
            tangential: camera.tangential,
            fold_radius_px: fold_radius_px(camera.radial, corner_px),
        })
    }

    /// Returns the image position of a direction, on the detector or beside it; `None` behind the camera and
    /// beyond the fold of the distortion.
    pub fn project(&self, direction: &Direction<CameraFrame>) -> Option<PixelPoint> {
        self.project_vector(direction.vector())
    }

    /// Projects a vector of any length, as [`CameraModel::project`] does a direction.
    pub fn project_vector(&self, r: &Vector3<f64>) -> Option<PixelPoint> {
        if r.z.is_nan() || r.z <= 0.0 {
            return None;
        }
        self.pixel_from_ideal(self.focal_x_px * (r.x / r.z), self.focal_y_px * (r.y / r.z))
    }

    /// Returns the direction of a pixel position, h⁻¹; `None` when the distortion has no inverse there.
    pub fn back_project(&self, point: PixelPoint) -> Option<Direction<CameraFrame>> {
        let (x, y) = (point.x - self.principal.x, point.y - self.principal.y);
        let (u, v) = self.undistort(x, y)?;
        Direction::from_vector(Vector3::new(u / self.focal_x_px, v / self.focal_y_px, 1.0)).ok()
    }

    /// Returns the camera with its focal length multiplied by `ratio`, greater than 0. The distortion, a map
    /// of pixels, stays.
    pub(crate) fn with_focal_ratio(&self, ratio: f64) -> Self {
        Self { focal_x_px: self.focal_x_px * ratio, focal_y_px: self.focal_y_px * ratio, ..self.clone() }
    }

    /// Returns the camera with its radial distortion k1 increased by `added`, px⁻².
    pub(crate) fn with_added_radial(&self, added: f64) -> Self {
        let [k1, k2, k3] = self.radial;
        let radial = [k1 + added, k2, k3];
        let corner_px = farthest_corner_px((self.columns, self.rows), self.principal);
        let fold_radius_px = match radial {
            // Without other terms 1 + 3 k1 r² = 0 is solved at once: hypotheses are made by the thousand.
            [k1, 0.0, 0.0] if k1 >= 0.0 || -48.0 * k1 * corner_px * corner_px < 1.0 => f64::INFINITY,
            [k1, 0.0, 0.0] => (-1.0 / (3.0 * k1)).sqrt(),
            _ => fold_radius_px(radial, corner_px),
        };
        Self { radial, fold_radius_px, ..self.clone() }
    }

    /// Returns the focal length along columns and along rows, px.
    pub(crate) fn focal_px(&self) -> (f64, f64) {
        (self.focal_x_px, self.focal_y_px)
    }

    /// Removes the distortion from a pixel position; the result is relative to the principal point: (f x1/x3,
    /// f x2/x3), px. In this plane straight lines of space are straight. `None` when the distortion has no
    /// inverse there.
    pub(crate) fn to_ideal(&self, point: PixelPoint) -> Option<(f64, f64)> {
        self.undistort(point.x - self.principal.x, point.y - self.principal.y)
    }

    /// Returns the inverse of [`CameraModel::to_ideal`]; `None` beyond the fold of the distortion.
    pub(crate) fn pixel_from_ideal(&self, u: f64, v: f64) -> Option<PixelPoint> {
        if u * u + v * v > self.fold_radius_px * self.fold_radius_px {
            return None;
        }
        let (du, dv) = self.distort(u, v);
        let point = PixelPoint::new(self.principal.x + du, self.principal.y + dv);
        (point.x.is_finite() && point.y.is_finite()).then_some(point)
    }

    /// Returns true if a point lies in the image domain Ω, including the borders of the outer pixels.
    pub fn is_on_detector(&self, point: PixelPoint) -> bool {
        point.is_on_detector(self.columns, self.rows)
    }

    /// Returns the numbers of columns and rows of the detector.
    pub fn size_px(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Returns the cosine of the half-angle of a cone about the boresight that contains the whole detector; 0
    /// when a corner of the detector has no direction.
    pub(crate) fn cos_half_field(&self) -> f64 {
        let (right, bottom) = (self.columns as f64 - 0.5, self.rows as f64 - 0.5);
        [(-0.5, -0.5), (right, -0.5), (-0.5, bottom), (right, bottom)]
            .into_iter()
            .map(|(x, y)| self.back_project(PixelPoint::new(x, y)).map_or(0.0, |corner| corner.vector().z))
            .fold(1.0, f64::min)
    }

    /// Returns the distorted offset for an undistorted one, px.
    fn distort(&self, u: f64, v: f64) -> (f64, f64) {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = u * u + v * v;
        let scale = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        (
            u * scale + 2.0 * p1 * u * v + p2 * (r2 + 2.0 * u * u),
            v * scale + p1 * (r2 + 2.0 * v * v) + 2.0 * p2 * u * v,
        )
    }

    /// Returns the derivatives of [`CameraModel::distort`]: ∂x/∂u, ∂x/∂v = ∂y/∂u, and ∂y/∂v.
    pub(crate) fn slopes(&self, u: f64, v: f64) -> (f64, f64, f64) {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = u * u + v * v;
        let scale = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        // d(scale)/d(r²), hence d(scale)/du = 2 u slope.
        let slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
        (
            scale + 2.0 * u * u * slope + 2.0 * p1 * v + 6.0 * p2 * u,
            2.0 * u * v * slope + 2.0 * p1 * u + 2.0 * p2 * v,
            scale + 2.0 * v * v * slope + 6.0 * p1 * v + 2.0 * p2 * u,
        )
    }

    /// Inverts [`CameraModel::distort`] by Newton's method, started at the distorted offset.
    fn undistort(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let (mut u, mut v) = (x, y);
        for _ in 0..MAX_NEWTON_STEPS {
            let (du, dv) = self.distort(u, v);
            let (rx, ry) = (x - du, y - dv);
            if rx.abs() + ry.abs() <= newton_tolerance_px(x, y) {
                break;
            }
            let (step_u, step_v) = solve(self.slopes(u, v), (rx, ry));
            u += step_u;
            v += step_v;
        }
        let (du, dv) = self.distort(u, v);
        let found = (x - du).abs() + (y - dv).abs() <= RESIDUAL_PX
            && u * u + v * v <= self.fold_radius_px * self.fold_radius_px;
        found.then_some((u, v))
    }
}

/// Returns the largest residual at which Newton's method ends for the offset (x, y), px.
fn newton_tolerance_px(x: f64, y: f64) -> f64 {
    1e-13 * (1.0 + x.abs() + y.abs())
}

/// Solves a x + b y = p, b x + d y = q for (x, y).
fn solve((a, b, d): (f64, f64, f64), (p, q): (f64, f64)) -> (f64, f64) {
    let determinant = a * d - b * b;
    ((d * p - b * q) / determinant, (a * q - b * p) / determinant)
}

/// Returns the distance of the detector's farthest corner from the principal point, px.
fn farthest_corner_px((columns, rows): (usize, usize), principal: PixelPoint) -> f64 {
    let farthest = |n: usize, c: f64| (c + 0.5).abs().max((n as f64 - 0.5 - c).abs());
    libm::hypot(farthest(columns, principal.x), farthest(rows, principal.y))
}

/// Returns the first radius where d/dr (r + k1 r³ + k2 r⁵ + k3 r⁷) is not positive, searched up to four times
/// the distance of the detector's farthest corner: directions beyond a farther fold are not imaged and cannot
/// return to the detector.
fn fold_radius_px([k1, k2, k3]: [f64; 3], corner: f64) -> f64 {
    const STEPS: u32 = 4000;
    (1..=STEPS)
        .map(|step| 4.0 * corner * f64::from(step) / f64::from(STEPS))
        .find(|r| {
            let r2 = r * r;
            1.0 + r2 * (3.0 * k1 + r2 * (5.0 * k2 + r2 * 7.0 * k3)) <= 0.0
        })
        .unwrap_or(f64::INFINITY)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fold_of(camera: &Camera) -> f64 {
        CameraModel::new(camera).unwrap().fold_radius_px
    }

    /// Returns the camera of Table 1 of the far-range paper.
    pub(crate) fn argon_camera() -> Camera {
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

    pub(crate) fn argon() -> CameraModel {
        CameraModel::new(&argon_camera()).unwrap()
    }

    #[test]
    fn an_added_distortion_is_that_of_a_camera_with_it() {
        let camera = argon_camera();
        for added in [-4e-7, -3e-8, 0.0, 2e-8] {
            let [k1, k2, k3] = camera.radial;
            let expected = CameraModel::new(&Camera { radial: [k1 + added, k2, k3], ..camera.clone() });
            let expected = expected.unwrap();
            let found = CameraModel::new(&camera).unwrap().with_added_radial(added);
            // The search for the fold has steps of a thousandth of the corner.
            let is_same_fold = found.fold_radius_px == expected.fold_radius_px
                || (found.fold_radius_px - expected.fold_radius_px).abs() < 1.0;
            assert!(is_same_fold, "{added}: {} {}", found.fold_radius_px, expected.fold_radius_px);
            assert_eq!(found.distort(100.0, -50.0), expected.distort(100.0, -50.0));
        }
    }

    #[test]
    fn the_boresight_is_seen_at_the_principal_point() {
        assert_eq!(argon().project(&Direction::z()), Some(PixelPoint::new(395.0, 288.0)));
    }

    #[test]
    fn the_field_of_view_is_the_papers() {
        // 18.2° × 13.6°, each rounded in the paper, without distortion.
        let half = |pixels: f64, focal_px: f64| 2.0 * libm::atan(pixels / 2.0 / focal_px).to_degrees();
        let (fx, fy) = argon_camera().focal_length_px();
        assert!((half(752.0, fx) - 18.2).abs() < 0.05);
        assert!((half(580.0, fy) - 13.6).abs() < 0.05);
    }

    #[test]
    fn the_far_corner_is_moved_by_three_pixels() {
        let model = argon();
        let seen = model.back_project(PixelPoint::new(0.0, 579.0)).unwrap();
        let without = CameraModel::new(&Camera { radial: [0.0; 3], ..argon_camera() }).unwrap();
        let moved = without.project(&seen).unwrap().distance(PixelPoint::new(0.0, 579.0));
        // Expected shift: k1 r³ with r = 490 px.
        assert!((moved - 3.0).abs() < 0.2, "{moved} px");
    }

    #[test]
    fn nothing_behind_the_camera_is_seen() {
        let model = argon();
        for z in [-1.0, 0.0, f64::NAN] {
            assert_eq!(model.project_vector(&Vector3::new(0.0, 0.0, z)), None);
        }
    }

    #[test]
    fn a_direction_beyond_the_fold_is_not_seen() {
        let camera = Camera { radial: [-1e-6, 0.0, 0.0], ..argon_camera() };
        let model = CameraModel::new(&camera).unwrap();
        // The radial map r − 1e-6 r³ folds at r = 577 px; a direction at 1000 px would return to 0.
        let beyond = Vector3::new(1000.0 / camera.focal_length_px().0, 0.0, 1.0);
        assert_eq!(model.project_vector(&beyond), None);
        // The fold is a circle: on its diagonal it is at 408 px in each coordinate.
        assert!(
            model.pixel_from_ideal(400.0, 400.0).is_some() && model.pixel_from_ideal(420.0, 420.0).is_none()
        );
        // The largest radius in the distorted image is 385 px.
        assert!(model.back_project(PixelPoint::new(395.0 - 384.0, 288.0)).is_some());
        assert!(model.back_project(PixelPoint::new(395.0 - 386.0, 288.0)).is_none());
    }

    /// Beyond the fold, on the axes and between them, Newton's method ends at an arbitrary point: near the
    /// fold without a solution, or at the solution of r − 1e-6 r³ on the other side of the fold.
    #[test]
    fn beyond_the_fold_no_radius_has_a_direction() {
        let camera = Camera { radial: [-1e-6, 0.0, 0.0], ..argon_camera() };
        let model = CameraModel::new(&camera).unwrap();
        let oblique = std::f64::consts::FRAC_1_SQRT_2;
        for radius in 386..900 {
            for (x, y) in [(1.0, 0.0), (0.0, 1.0), (oblique, oblique), (oblique, -oblique)] {
                let point = PixelPoint::new(395.0 + f64::from(radius) * x, 288.0 + f64::from(radius) * y);
                assert_eq!(model.back_project(point), None, "{point:?}");
            }
        }
    }

    #[test]
    fn two_equations_are_solved() {
        // 2 · 3 + 1 · (−4) = 2 and 1 · 3 + 5 · (−4) = −17.
        assert_eq!(solve((2.0, 1.0, 5.0), (2.0, -17.0)), (3.0, -4.0));
    }

    /// Zeros at 400 px of 1 + 3 k1 r², 1 + 5 k2 r⁴ and 1 + 7 k3 r⁶, and of 1 + 3 k1 r² + 5 k2 r⁴ + 7 k3 r⁶
    /// with terms of 1, −1 and −1.
    #[test]
    fn the_fold_is_where_the_radius_stops_growing() {
        let r2 = 400.0 * 400.0;
        let (k1, k2, k3) = (1.0 / (3.0 * r2), 1.0 / (5.0 * r2 * r2), 1.0 / (7.0 * r2 * r2 * r2));
        for radial in [[-k1, 0.0, 0.0], [0.0, -k2, 0.0], [0.0, 0.0, -k3], [k1, -k2, -k3], [k1, -3.0 * k2, k3]]
        {
            let fold = fold_of(&Camera { radial, ..argon_camera() });
            // The search has steps of 0.5 px.
            assert!((fold - 400.0).abs() < 0.5, "{radial:?}: {fold}");
        }
        assert_eq!(fold_of(&argon_camera()), f64::INFINITY);
    }

    /// The search extends to four times the distance of the corner farthest from the principal point, at any
    /// position of this point.
    #[test]
    fn a_fold_is_looked_for_as_far_as_four_times_the_farthest_corner() {
        let camera = |x: f64, y: f64, fold_px: f64| Camera {
            columns: 100,
            rows: 100,
            principal_x_px: x,
            principal_y_px: y,
            radial: [-1.0 / (3.0 * fold_px * fold_px), 0.0, 0.0],
            ..argon_camera()
        };
        for (x, y, corner_px) in [
            (10.0, 10.0, libm::hypot(89.5, 89.5)),
            (99.0, 99.0, libm::hypot(99.5, 99.5)),
            (99.0, 0.0, libm::hypot(99.5, 99.5)),
            (-5.0, 120.0, libm::hypot(104.5, 120.5)),
        ] {
            assert!(fold_of(&camera(x, y, 3.99 * corner_px)).is_finite(), "{x} {y}");
            assert_eq!(fold_of(&camera(x, y, 4.01 * corner_px)), f64::INFINITY, "{x} {y}");
        }
    }

    #[test]
    fn a_position_with_an_overflowing_coordinate_is_none() {
        assert!(argon().pixel_from_ideal(1e3, 1.0).is_some());
        assert_eq!(argon().pixel_from_ideal(1e110, 1.0), None);
    }

    /// x = u s + 2 p1 u v + p2 (r² + 2 u²), y = v s + p1 (r² + 2 v²) + 2 p2 u v with s = 1 + k1 r² + k2 r⁴ +
    /// k3 r⁶, computed independently of this code.
    #[test]
    fn the_distortion_is_that_of_its_formula() {
        let camera = Camera { radial: [3e-8, -2e-13, 4e-19], tangential: [5e-7, -8e-7], ..argon_camera() };
        let model = CameraModel::new(&camera).unwrap();
        for ((u, v), (x, y)) in [
            ((300.0, -200.0), (695.111_640_000_000, 87.921_240_000_000)),
            ((-250.0, 120.0), (144.481_934_839_100, 408.257_591_677_232)),
        ] {
            let pixel = model.pixel_from_ideal(u, v).unwrap();
            assert!(pixel.distance(PixelPoint::new(x, y)) < 1e-9, "{pixel:?}");
            let ideal = model.to_ideal(pixel).unwrap();
            assert!((ideal.0 - u).abs() < 1e-8 && (ideal.1 - v).abs() < 1e-8, "{ideal:?}");
            let (fx, fy) = model.focal_px();
            let direction = Direction::from_vector(Vector3::new(u / fx, v / fy, 1.0)).unwrap();
            assert!(model.project(&direction).unwrap().distance(pixel) < 1e-9);
        }
        assert_eq!(model.focal_px(), camera.focal_length_px());
    }

    /// Wrong slopes give the same inverse, in more steps; the slopes are therefore compared with finite
    /// differences.
    #[test]
    fn the_slopes_are_those_of_the_distortion() {
        let camera = Camera { radial: [3e-7, -2e-12, 4e-18], tangential: [5e-5, -8e-5], ..argon_camera() };
        let model = CameraModel::new(&camera).unwrap();
        for (u, v) in [(310.0, -200.0), (-250.0, 120.0), (40.0, 390.0)] {
            let h = 1e-3;
            let difference = |step: (f64, f64)| {
                let (above, below) =
                    (model.distort(u + step.0, v + step.1), model.distort(u - step.0, v - step.1));
                ((above.0 - below.0) / (2.0 * h), (above.1 - below.1) / (2.0 * h))
            };
            let ((xu, yu), (xv, yv)) = (difference((h, 0.0)), difference((0.0, h)));
            let (a, b, d) = model.slopes(u, v);
            for (slope, expected) in [(a, xu), (b, yu), (b, xv), (d, yv)] {
                assert!((slope - expected).abs() < 1e-8, "{u} {v}: {slope}, expected {expected}");
            }
        }
    }

    #[test]
    fn the_detector_ends_at_the_borders_of_its_outer_pixels() {
        let model = argon();
        assert_eq!(model.size_px(), (752, 580));
        for (x, y, is_on) in
            [(-0.5, -0.5, true), (751.5, 579.5, true), (-0.6, 3.0, false), (3.0, 579.6, false)]
        {
            assert_eq!(model.is_on_detector(PixelPoint::new(x, y)), is_on, "{x} {y}");
        }
    }

    #[test]
    fn the_cone_ends_at_the_corner_that_is_farthest() {
        let plain = Camera { radial: [0.0; 3], pixel_width_um: 8.0, pixel_height_um: 8.0, ..argon_camera() };
        let f_px = plain.focal_length_px().0;
        // With the principal point in each quadrant, the opposite corner is the farthest, 500 by 400 px away.
        for (x, y) in [(499.5, 399.5), (251.5, 399.5), (499.5, 179.5), (251.5, 179.5)] {
            let camera = Camera { principal_x_px: x, principal_y_px: y, ..plain.clone() };
            let cos = CameraModel::new(&camera).unwrap().cos_half_field();
            let expected = f_px / (f_px * f_px + 500.0 * 500.0 + 400.0 * 400.0).sqrt();
            assert!((cos - expected).abs() < 1e-12, "{x} {y}: {cos}");
        }
        let folded = Camera { radial: [-1e-6, 0.0, 0.0], ..argon_camera() };
        assert_eq!(CameraModel::new(&folded).unwrap().cos_half_field(), 0.0);
    }

    #[test]
    fn the_cone_holds_every_pixel() {
        let model = argon();
        let cos = model.cos_half_field();
        for (x, y) in [(0.0, 0.0), (751.0, 0.0), (0.0, 579.0), (751.0, 579.0), (300.0, 100.0)] {
            assert!(model.back_project(PixelPoint::new(x, y)).unwrap().vector().z >= cos);
        }
    }

    proptest! {
        #[test]
        fn the_inverse_undoes_the_projection(
            x in -0.5..751.5f64, y in -0.5..579.5f64,
            k1 in -5e-8..5e-8f64, k2 in -1e-14..1e-14f64,
            p1 in -1e-6..1e-6f64, p2 in -1e-6..1e-6f64,
        ) {
            let camera = Camera { radial: [k1, k2, 0.0], tangential: [p1, p2], ..argon_camera() };
            let model = CameraModel::new(&camera).unwrap();
            let point = PixelPoint::new(x, y);
            let direction = model.back_project(point).unwrap();
            let again = model.project(&direction).unwrap();
            // Tolerance for the rounding of coordinates of a few hundred pixels.
            prop_assert!(again.distance(point) < 1e-9, "{:?} and {:?}", again, point);
        }
    }
}
