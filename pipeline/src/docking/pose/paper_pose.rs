//! Pose of a field by the paper's formulas (3.1): small angles, the image of the circle assumed to be a
//! circle.

use contract::docking::{NoPose, Pose, TargetModel};
use nalgebra::Vector3;

use super::geometry::{exponential, phi_from_rotation, target_from_camera};

/// Inputs of 3.1: cross and circle in the image without distortion, relative to the principal point.
///
/// Coordinates are (f x1/x3, f x2/x3) with one f, the focal length along columns: pixels that are not square
/// are stretched along rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperMeasurement {
    /// Focal length f, px.
    pub focal_px: f64,
    /// Centre of the cross (Xc, Yc), px.
    pub cross: [f64; 2],
    /// Slope a of the horizontal bar, rows over columns.
    pub slope: f64,
    /// Centre of the circle (Xo, Yo), px.
    pub circle: [f64; 2],
    /// Radius R of the circle, px.
    pub radius_px: f64,
}

/// Dimensions of the target for 3.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperTarget {
    /// Radius r of the circle, m.
    pub radius_m: f64,
    /// Height b of the cross over the circle's plane, m.
    pub height_m: f64,
}

impl PaperTarget {
    /// Returns the dimensions of a target. The circle is that of the marks.
    pub fn from_model(target: &TargetModel) -> Self {
        Self { radius_m: target.mark_circle_radius_m, height_m: target.cross.height_m }
    }
}

impl PaperMeasurement {
    /// Computes range, then position from the parallax of the cross, then attitude (3.1).
    ///
    /// d3 = f r/R; d1 = −(Xc − Xo) d3 (d3 − b)/(f b), d2 = (Yc − Yo) d3 (d3 − b)/(f b); φ1 = Yo/f − d2/d3, φ2
    /// = −Xo/f − d1/d3, φ3 = −a.
    ///
    /// # Errors
    /// [`NoPose::Inconsistent`] when the numbers put the camera at or behind the cross, or are not finite.
    pub fn pose(&self, target: &PaperTarget) -> Result<Pose, NoPose> {
        let (f, b) = (self.focal_px, target.height_m);
        let d3 = f * target.radius_m / self.radius_px;
        let per_px = d3 * (d3 - b) / (f * b);
        let d1 = -(self.cross[0] - self.circle[0]) * per_px;
        let d2 = (self.cross[1] - self.circle[1]) * per_px;
        let pose = Pose {
            position_m: Vector3::new(d1, d2, d3),
            phi_rad: Vector3::new(self.circle[1] / f - d2 / d3, -self.circle[0] / f - d1 / d3, -self.slope),
        };
        let is_sound = d3 > b
            && self.radius_px > 0.0
            && pose.position_m.iter().chain(pose.phi_rad.iter()).all(|value| value.is_finite());
        if is_sound { Ok(pose) } else { Err(NoPose::Inconsistent) }
    }

    /// Computes the pose of 3.1, then rotates it until the exact projection of the cross coincides with the
    /// measured cross.
    ///
    /// The formulas assume small angles. At 3° of roll and of tilt, both cross and circle are 4 px off with a
    /// narrow lens (φ is a rotation vector; φ3 × φ1/2 turns the line of sight), which is too far for a fit to
    /// converge.
    ///
    /// # Errors
    /// Those of [`PaperMeasurement::pose`].
    pub fn aimed_pose(&self, target: &PaperTarget) -> Result<Pose, NoPose> {
        let pose = self.pose(target)?;
        let attitude = target_from_camera(&pose.phi_rad);
        let cross = Vector3::new(0.0, 0.0, target.height_m);
        let expected = (attitude.transpose() * (cross - pose.position_m)).normalize();
        let seen = Vector3::new(self.cross[0], self.cross[1], self.focal_px).normalize();
        // Small rotation from the measured to the expected direction.
        let turn = exponential(&seen.cross(&expected));
        let aimed = Pose { phi_rad: phi_from_rotation(&(attitude * turn)), ..pose };
        if aimed.phi_rad.iter().all(|value| value.is_finite()) {
            Ok(aimed)
        } else {
            Err(NoPose::Inconsistent)
        }
    }

    /// Returns the measurement of a target at a known range that faces the camera: without the parallax of
    /// the cross, and with the radius of the circle at that range. For a circle of a few pixels this is
    /// closer to the truth than its measured centre and radius.
    pub(crate) fn facing_at(&self, target: &PaperTarget, range_m: f64) -> Self {
        Self { circle: self.cross, radius_px: self.focal_px * target.radius_m / range_m, ..*self }
    }

    /// Returns the measurement expected from 3.1 at a pose: by its simplified forms, not the exact
    /// projection.
    pub fn expected(pose: &Pose, target: &PaperTarget, focal_px: f64) -> Self {
        let (d, phi, f, b) = (&pose.position_m, &pose.phi_rad, focal_px, target.height_m);
        let at = |depth: f64| [-f * d.x / depth - f * phi.y, f * d.y / depth + f * phi.x];
        Self {
            focal_px,
            cross: at(d.z - b),
            slope: -phi.z,
            circle: at(d.z),
            radius_px: f * target.radius_m / d.z,
        }
    }
}

/// Returns d3 from the outline of the station, used when the target is not resolved yet: Rs = f r_s/(d3 +
/// h_s), so d3 = f r_s/Rs − h_s. Returns `None` unless this is a range in front of the target.
///
/// h_s, the distance of the outline behind the target's plane, is an assumption: the paper only states that
/// these data "are used in another way".
pub fn range_from_outline(
    focal_px: f64,
    outline_radius_m: f64,
    outline_depth_m: f64,
    radius_px: f64,
) -> Option<f64> {
    let range_m = focal_px * outline_radius_m / radius_px - outline_depth_m;
    (range_m.is_finite() && range_m > 0.0 && radius_px > 0.0).then_some(range_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::pose::geometry;
    use crate::docking::preprocessing::view::Lens;
    use contract::{Camera, PixelPoint};

    const TARGET: PaperTarget = PaperTarget { radius_m: 0.25, height_m: 0.30 };
    const NARROW_PX: f64 = 2917.0;

    fn camera(radial: [f64; 3], pixel_height_um: f64) -> Camera {
        Camera {
            columns: 768,
            rows: 576,
            focal_length_mm: NARROW_PX * 0.01,
            pixel_width_um: 10.0,
            pixel_height_um,
            principal_x_px: 383.5,
            principal_y_px: 287.5,
            radial,
            tangential: [0.0; 2],
        }
    }

    fn pose(d: [f64; 3], phi_deg: [f64; 3]) -> Pose {
        Pose { position_m: d.into(), phi_rad: Vector3::from(phi_deg) * (std::f64::consts::PI / 180.0) }
    }

    /// Returns the exact image of a point of the target without distortion, relative to the principal point.
    fn exact(camera: &Camera, pose: &Pose, point_m: [f64; 3]) -> PixelPoint {
        let lens = Lens::new(camera).unwrap();
        let seen = geometry::project(lens.model(), pose, &point_m.into()).unwrap();
        let ideal = lens.to_ideal(seen).unwrap();
        PixelPoint::new(ideal.x, ideal.y)
    }

    #[test]
    fn an_aimed_pose_shows_the_cross_where_it_is_seen() {
        let truth = pose([0.0, 0.0, 18.0], [3.0, -3.0, 3.0]);
        let camera = camera([0.0; 3], 10.0);
        let (centre, radius_px) = exact_circle(&camera, &truth);
        let cross = exact(&camera, &truth, [0.0, 0.0, TARGET.height_m]);
        let right = exact(&camera, &truth, [0.1, 0.0, TARGET.height_m]);
        let seen = PaperMeasurement {
            focal_px: NARROW_PX,
            cross: [cross.x, cross.y],
            slope: (right.y - cross.y) / (right.x - cross.x),
            circle: [centre.x, centre.y],
            radius_px,
        };
        let off = |pose: &Pose| exact(&camera, pose, [0.0, 0.0, TARGET.height_m]).distance(cross);
        // The residual from using the sine of the rotation angle is of third order.
        let (before, after) = (off(&seen.pose(&TARGET).unwrap()), off(&seen.aimed_pose(&TARGET).unwrap()));
        assert!(before > 3.0 && after < 1e-3, "{before} {after}");
    }

    #[test]
    fn a_target_that_faces_the_camera_has_the_pose_of_its_range_and_cross() {
        // A circle of 13 px, measured 0.7 px too large and 0.5 px aside: 5 % of the range, several degrees.
        let seen = PaperMeasurement {
            focal_px: NARROW_PX,
            cross: [120.0, -80.0],
            slope: 0.01,
            circle: [120.5, -79.6],
            radius_px: NARROW_PX * TARGET.radius_m / 56.0 + 0.7,
        };
        let (measured, facing) =
            (seen.pose(&TARGET).unwrap(), seen.facing_at(&TARGET, 56.0).pose(&TARGET).unwrap());
        assert!(measured.position_m.z < 54.0 && measured.position_m.xy().norm() > 1.0, "{measured:?}");
        assert!(
            (facing.position_m.z - 56.0).abs() < 1e-9 && facing.position_m.xy().norm() < 1e-9,
            "{facing:?}"
        );
        assert!(
            (facing.phi_rad.y + 120.0 / NARROW_PX).abs() < 1e-9 && (facing.phi_rad.z + 0.01).abs() < 1e-12
        );
    }

    /// Least-squares circle through the exact images of 72 points of the mark circle.
    fn exact_circle(camera: &Camera, pose: &Pose) -> (PixelPoint, f64) {
        let points: Vec<PixelPoint> = (0..72)
            .map(|k| {
                let (s, c) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 72.0);
                exact(camera, pose, [0.25 * c, 0.25 * s, 0.0])
            })
            .collect();
        let n = points.len() as f64;
        let mut centre = PixelPoint::new(
            points.iter().map(|p| p.x).sum::<f64>() / n,
            points.iter().map(|p| p.y).sum::<f64>() / n,
        );
        let mut radius = 0.0;
        for _ in 0..50 {
            radius = points.iter().map(|p| p.distance(centre)).sum::<f64>() / n;
            let pull = |get: fn(&PixelPoint) -> f64, c: f64| {
                points.iter().map(|p| (get(p) - c) * (1.0 - radius / p.distance(centre))).sum::<f64>() / n
            };
            let (dx, dy) = (pull(|p| p.x, centre.x), pull(|p| p.y, centre.y));
            centre = PixelPoint::new(centre.x + 2.0 * dx, centre.y + 2.0 * dy);
        }
        (centre, radius)
    }

    /// Returns the inputs of 3.1 at a pose, with a slope of −φ3.
    fn measured(camera: &Camera, pose: &Pose) -> PaperMeasurement {
        let (circle, radius_px) = exact_circle(camera, pose);
        let cross = exact(camera, pose, [0.0, 0.0, TARGET.height_m]);
        PaperMeasurement {
            focal_px: NARROW_PX,
            cross: [cross.x, cross.y],
            slope: -pose.phi_rad.z,
            circle: [circle.x, circle.y],
            radius_px,
        }
    }

    #[test]
    fn the_formulas_invert_their_own_projection() {
        let truth = pose([0.4, -0.7, 12.0], [1.0, -2.0, 3.0]);
        let found = PaperMeasurement::expected(&truth, &TARGET, NARROW_PX).pose(&TARGET).unwrap();
        assert!((geometry::to_vector(&found) - geometry::to_vector(&truth)).abs().max() < 1e-11);
    }

    #[test]
    fn on_the_axis_the_formulas_are_exact() {
        let model = camera([0.0; 3], 10.0);
        let truth = pose([0.0, 0.0, 5.0], [0.0; 3]);
        let found = measured(&model, &truth).pose(&TARGET).unwrap();
        assert!((geometry::to_vector(&found) - geometry::to_vector(&truth)).abs().max() < 1e-9);
    }

    #[test]
    fn the_slope_of_the_horizontal_bar_is_minus_the_roll() {
        let model = camera([0.0; 3], 10.0);
        let truth = pose([0.0, 0.0, 5.0], [0.0, 0.0, 2.0]);
        let end = |y1: f64| exact(&model, &truth, [y1, 0.0, 0.3]);
        let slope = (end(0.15).y - end(-0.15).y) / (end(0.15).x - end(-0.15).x);
        let m = PaperMeasurement::expected(&truth, &TARGET, NARROW_PX);
        // tan φ and φ differ by φ³/3 = 1.4e-5.
        assert!((m.slope - slope).abs() < 2e-5, "{} and {slope}", m.slope);
    }

    /// The image of a tilted circle is an ellipse whose centre is not the image of the circle's centre: in
    /// the direction of the tilt, by f tan(tilt) (r/d3)² to leading order. The figures are those of
    /// `docs/evidence/docking-method.md`.
    #[test]
    fn a_tilt_biases_the_circles_centre_as_documented() {
        let model = camera([0.0; 3], 10.0);
        for (tilt_deg, documented_px) in [(1.0, 0.13), (5.0, 0.63)] {
            let tilt = f64::to_radians(tilt_deg);
            // The camera sees the disk's centre from the side: d1 = d3 tan(tilt).
            let (s, c) = libm::sincos(tilt);
            let truth = pose([5.0 * s, 0.0, 5.0 * c], [0.0, -tilt_deg, 0.0]);
            let (centre, _) = exact_circle(&model, &truth);
            let true_centre = exact(&model, &truth, [0.0; 3]);
            let bias = centre.distance(true_centre);
            let closed = NARROW_PX * libm::tan(tilt) * 0.05 * 0.05;
            assert!((bias - documented_px).abs() < 0.006, "{tilt_deg}°: {bias} px");
            assert!((bias - closed).abs() < 0.01 * closed, "{tilt_deg}°: {bias} px and {closed} px");
        }
    }

    /// Errors of the approximations: all of 3.1 on exact images, narrow lens, 5 m. The figures are those of
    /// `docs/evidence/docking-method.md`.
    #[test]
    fn the_approximations_have_their_documented_errors() {
        let model = camera([0.0; 3], 10.0);
        // (d1, m; φ2, °; worst lateral error, mm; worst range error, %; worst attitude error, °)
        for (d1, phi2_deg, lateral_mm, range_percent, attitude_deg) in
            [(0.05, 0.0, 1e-6, 1e-6, 1e-6), (0.1, 1.0, 3.5, 0.076, 0.043), (0.4, -4.0, 15.0, 0.48, 0.17)]
        {
            let truth = pose([d1, 0.0, 5.0], [0.0, phi2_deg, 0.0]);
            let found = measured(&model, &truth).pose(&TARGET).unwrap();
            let error = geometry::to_vector(&found) - geometry::to_vector(&truth);
            let measured = (error[0].abs() * 1e3, error[2].abs() / 5.0 * 100.0, error[4].abs().to_degrees());
            let documented = (lateral_mm, range_percent, attitude_deg);
            for (m, d) in [(measured.0, documented.0), (measured.1, documented.1), (measured.2, documented.2)]
            {
                assert!(m <= d, "d1 {d1} m, φ2 {phi2_deg}°: {measured:?}, documented {documented:?}");
            }
        }
    }

    /// The cross and the points of the circle are undistorted individually, in square pixels. The inputs to
    /// 3.1 are then those of a camera without distortion.
    #[test]
    fn distortion_and_pixels_that_are_not_square_are_undone() {
        let truth = pose([0.1, -0.2, 5.0], [0.3, 0.2, 1.0]);
        let ideal = measured(&camera([0.0; 3], 10.0), &truth);
        // The distortion moves the rim by only 0.1 px.
        let met = measured(&camera([2.6e-8, 0.0, 0.0], 9.0), &truth);
        let off = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        // The inverse of the distortion is iterated to 1e-9 px.
        assert!(off(met.cross, ideal.cross) < 1e-6, "{:?} {:?}", met.cross, ideal.cross);
        assert!(off(met.circle, ideal.circle) < 1e-6, "{:?} {:?}", met.circle, ideal.circle);
        assert!((met.radius_px - ideal.radius_px).abs() < 1e-6, "{} {}", met.radius_px, ideal.radius_px);
    }

    #[test]
    fn numbers_that_make_no_pose_are_refused() {
        let good = PaperMeasurement::expected(&pose([0.0, 0.0, 5.0], [0.0; 3]), &TARGET, NARROW_PX);
        for radius_px in [0.0, -10.0, f64::NAN, 1e5] {
            assert_eq!(PaperMeasurement { radius_px, ..good }.pose(&TARGET), Err(NoPose::Inconsistent));
        }
        assert_eq!(PaperMeasurement { slope: f64::NAN, ..good }.pose(&TARGET), Err(NoPose::Inconsistent));
    }

    #[test]
    fn the_stations_outline_gives_the_range() {
        // r_s = 2.05 m, 0.45 m behind the target's plane, seen from 200 m.
        let radius_px = 2917.0 * 2.05 / 200.45;
        assert!((range_from_outline(2917.0, 2.05, 0.45, radius_px).unwrap() - 200.0).abs() < 1e-9);
        assert_eq!(range_from_outline(2917.0, 2.05, 0.45, 0.0), None);
        assert_eq!(range_from_outline(2917.0, 2.05, 0.45, 1e9), None);
    }
}
