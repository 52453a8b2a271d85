//! Diffusely reflecting sphere in sunlight: the distribution of radiance over its disk.

use std::f64::consts::PI;

use contract::PixelPoint;
use nalgebra::{Vector2, Vector3};
use optics::ImagePoint;

use super::body::gather;
use crate::disk::Disk;

/// Radius of the disk below which it is drawn as one point at its centre of brightness, px: this reduces the
/// variance of the image by 2.5e-5 px².
const ONE_POINT_RADIUS_PX: f64 = 0.01;
/// Minimum number of samples along the diameter: the centre of brightness is then accurate to 2e-3 of the
/// radius for every position of the limb on the grid.
const SAMPLES_ACROSS: f64 = 128.0;

/// The illuminated sphere at one instant, in the axes of the target's body frame, its centre at the origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LitSphere {
    radius_m: f64,
    distance_m: f64,
    /// Unit vectors: towards the camera, and two perpendicular to it that span a plane.
    towards_eye: Vector3<f64>,
    across: [Vector3<f64>; 2],
    /// Unit vector towards the Sun.
    sun: Vector3<f64>,
    phase_rad: f64,
}

impl LitSphere {
    /// Returns a sphere seen from `eye_m` and lit from the direction `sun` (a unit vector); `None` from
    /// inside the sphere.
    pub(super) fn new(radius_m: f64, eye_m: Vector3<f64>, sun: Vector3<f64>) -> Option<Self> {
        let distance_m = eye_m.norm();
        if distance_m <= radius_m {
            return None;
        }
        let towards_eye = eye_m / distance_m;
        // The first perpendicular vector is derived from a coordinate axis well away from the line of sight.
        let axis = if towards_eye.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = towards_eye.cross(&axis).normalize();
        let phase_rad = libm::atan2(towards_eye.cross(&sun).norm(), towards_eye.dot(&sun));
        let across = [first, towards_eye.cross(&first)];
        Some(Self { radius_m, distance_m, towards_eye, across, sun, phase_rad })
    }

    /// Appends the points of the undistorted image, about `count_limit` at most. `project` maps the body
    /// frame, m, to the image. The shares add up to 1, except for the share of points without an image.
    pub(super) fn image(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        count_limit: usize,
        points: &mut Vec<ImagePoint>,
    ) {
        let disk = self.disk(project);
        let first = points.len();
        if disk.radius_px().is_some_and(|radius_px| radius_px >= ONE_POINT_RADIUS_PX) {
            disk.image(|at| self.radiance_at(at), count_limit, points);
            gather(points, first);
        }
        // A crescent may be too thin for the grid.
        if points.len() == first {
            let position = project(&self.centre_of_brightness_m());
            points.extend(position.map(|position| ImagePoint { position, share: 1.0 }));
        }
    }

    /// Estimates the share of the flux in the brightest pixel, where a point source has the share `psf_share`
    /// in its brightest pixel: the share of one pixel at the brightest point of the disk, at most
    /// `psf_share`.
    pub(super) fn peak_share(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        psf_share: f64,
    ) -> Option<f64> {
        let radius_px = self.disk(project).radius_px()?;
        // Beyond 90° the subsolar point is behind the limb, and the limb towards the Sun is brightest.
        let brightest = if self.phase_rad < 0.5 * PI { 1.0 } else { libm::sin(self.phase_rad) };
        let all = 2.0 / 3.0 * PI * lambert_phase(self.phase_rad) * radius_px * radius_px;
        // `min` ignores a NaN.
        Some((brightest / all).min(psf_share))
    }

    /// Returns the disk on the plane through the sphere's centre, m. Rays tangent to the sphere meet the
    /// plane outside the sphere.
    fn disk(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
    ) -> Disk<impl Fn(Vector2<f64>) -> Option<PixelPoint>> {
        let sine = self.radius_m / self.distance_m;
        Disk {
            to_image: |at: Vector2<f64>| project(&(self.across[0] * at.x + self.across[1] * at.y)),
            radius: self.radius_m / (1.0 - sine * sine).sqrt(),
            lit: 0.5 * (1.0 + libm::cos(self.phase_rad)),
            samples_across: SAMPLES_ACROSS,
        }
    }

    /// Flux towards the camera per unit area of the plane: the cosine of incidence at the surface point
    /// visible there (Lambert), times the solid angle of the area relative to that at the centre.
    fn radiance_at(&self, at: &Vector2<f64>) -> f64 {
        let on_plane = self.across[0] * at.x + self.across[1] * at.y;
        let ray = on_plane - self.towards_eye * self.distance_m;
        let length = ray.norm();
        // Point of the ray nearest to the sphere's centre. It is computed from the ray's intersection with
        // the plane, because the difference of two squared distances from the camera would lose the radius to
        // rounding.
        let nearest = on_plane - ray * (at.norm_squared() / (length * length));
        let depth2 = self.radius_m * self.radius_m - nearest.norm_squared();
        if depth2 < 0.0 {
            return 0.0;
        }
        let point = nearest - ray * (depth2.sqrt() / length);
        let cos = self.distance_m / length;
        (point.dot(&self.sun) / self.radius_m).max(0.0) * (cos * cos * cos)
    }

    /// Centre of brightness as seen from afar. Its offset from the sphere's centre towards the Sun is R ·
    /// 3π/16 · sin α (1 + cos α)/(sin α + (π − α) cos α), from the integrals of (n·x)(n·s)(n·o) and
    /// (n·s)(n·o) over the sunlit visible part.
    fn centre_of_brightness_m(&self) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(self.phase_rad);
        let light = sin + (PI - self.phase_rad) * cos;
        // Towards π, numerator and denominator vanish with the third power of π − α; their ratio tends to
        // 3/2.
        let ratio = if light > 1e-10 { sin * (1.0 + cos) / light } else { 1.5 };
        let towards_sun = self.sun - self.towards_eye * self.sun.dot(&self.towards_eye);
        let direction = towards_sun.try_normalize(1e-12).unwrap_or_else(Vector3::zeros);
        direction * (self.radius_m * 3.0 * PI / 16.0 * ratio)
    }
}

/// Phase function of a Lambert sphere, 1 at full phase, 0 at π: (sin α + (π − α) cos α)/π (Russell 1916, ApJ
/// 43, 173).
pub(super) fn lambert_phase(phase_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(phase_rad);
    ((sin + (PI - phase_rad) * cos) / PI).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS_M: f64 = 0.5;

    /// Returns the sphere at a phase angle, seen from a distance of `radii` radii with the Sun towards x, and
    /// the projection of a camera in which its radius is `radius_px` pixels.
    fn seen(
        phase_deg: f64,
        radii: f64,
        radius_px: f64,
    ) -> (LitSphere, impl Fn(&Vector3<f64>) -> Option<PixelPoint>) {
        let (sin, cos) = libm::sincos(phase_deg.to_radians());
        let distance_m = radii * RADIUS_M;
        let focal_px = radius_px * radii;
        let sphere =
            LitSphere::new(RADIUS_M, Vector3::z() * distance_m, Vector3::new(sin, 0.0, cos)).unwrap();
        let project = move |point: &Vector3<f64>| {
            let depth = distance_m - point.z;
            Some(PixelPoint::new(50.3 + focal_px * point.x / depth, 40.1 + focal_px * point.y / depth))
        };
        (sphere, project)
    }

    fn points(phase_deg: f64, radii: f64, radius_px: f64) -> Vec<ImagePoint> {
        let (sphere, project) = seen(phase_deg, radii, radius_px);
        let mut points = Vec::new();
        sphere.image(&project, 1 << 16, &mut points);
        points
    }

    /// Flux-weighted mean position relative to the disk's centre, in radii.
    fn mean(points: &[ImagePoint], radius_px: f64) -> (f64, f64) {
        let sum = |value: &dyn Fn(&ImagePoint) -> f64| points.iter().map(value).sum::<f64>();
        let all = sum(&|p| p.share);
        (
            sum(&|p| p.share * (p.position.x - 50.3)) / all / radius_px,
            sum(&|p| p.share * (p.position.y - 40.1)) / all / radius_px,
        )
    }

    #[test]
    fn at_half_phase_the_centre_of_brightness_is_off_by_three_sixteenths_of_pi() {
        for radius_px in [0.005, 0.05, 0.3, 1.0, 7.3, 40.0] {
            let (x, y) = mean(&points(90.0, 1e4, radius_px), radius_px);
            // With 128 samples across, the limb of the disk is accurate to 2e-3 of its radius.
            assert!((x - 3.0 * PI / 16.0).abs() < 2e-3 && y.abs() < 2e-3, "{radius_px} px: {x}, {y}");
        }
    }

    #[test]
    fn the_centre_of_brightness_is_that_of_its_closed_form_at_every_phase() {
        for phase_deg in [0.0, 20.0, 60.0, 120.0, 150.0, 170.0] {
            let (sphere, _) = seen(phase_deg, 1e4, 1.0);
            let expected = sphere.centre_of_brightness_m().x / RADIUS_M;
            let (x, _) = mean(&points(phase_deg, 1e4, 20.0), 20.0);
            assert!((x - expected).abs() < 2e-3, "{phase_deg}°: {x}, expected {expected}");
        }
        // The limit for a thin crescent, on both sides of the switch to it.
        for phase_deg in [179.9, 179.99, 180.0 - 1e-6] {
            let (sphere, _) = seen(phase_deg, 1e4, 1.0);
            let x = sphere.centre_of_brightness_m().x / RADIUS_M;
            assert!((x - 9.0 * PI / 32.0).abs() < 1e-3, "{phase_deg}°: {x}");
        }
    }

    /// The flux of the disk relative to a sphere at full phase, (2/3) π R² from afar, equals Russell's phase
    /// function.
    #[test]
    fn the_flux_of_the_disk_follows_the_phase_law() {
        for phase_deg in [0.0, 45.0, 90.0, 135.0] {
            let (sphere, _) = seen(phase_deg, 1e4, 1.0);
            let n = 800;
            let step = 2.0 * RADIUS_M / f64::from(n);
            let coordinate = |i: i32| (f64::from(i) + 0.5) * step - RADIUS_M;
            let sum: f64 = (0..n * n)
                .map(|i| sphere.radiance_at(&Vector2::new(coordinate(i % n), coordinate(i / n))))
                .sum();
            let ratio = sum * step * step / (2.0 / 3.0 * PI * RADIUS_M * RADIUS_M);
            let expected = lambert_phase(f64::to_radians(phase_deg));
            assert!((ratio / expected - 1.0).abs() < 1e-3, "{phase_deg}°: {ratio}, expected {expected}");
        }
    }

    #[test]
    fn the_shares_add_up_to_one_and_nothing_lies_off_the_disk() {
        for phase_deg in [0.0, 30.0, 90.0, 150.0, 179.0] {
            for radius_px in [1e-9, 0.02, 0.7, 10.4, 60.0] {
                let points = points(phase_deg, 50.0, radius_px);
                let sum: f64 = points.iter().map(|point| point.share).sum();
                assert!((sum - 1.0).abs() < 1e-9, "{phase_deg}°, {radius_px} px: {sum}");
                let at = |p: &ImagePoint| libm::hypot(p.position.x - 50.3, p.position.y - 40.1);
                // Four points with the moments of a small disk may lie slightly outside the disk.
                let limit = if radius_px < 0.1 { 1.5 } else { 1.001 };
                assert!(points.iter().all(|point| at(point) < limit * radius_px + 1e-9));
            }
        }
    }

    #[test]
    fn with_the_range_its_image_changes_without_a_jump() {
        let moments = |radius_px: f64| {
            let points = points(70.0, 1e4, radius_px);
            let (x, y) = mean(&points, 1.0);
            let variance: f64 =
                points.iter().map(|p| p.share * libm::pow(p.position.x - 50.3 - x, 2.0)).sum();
            (x, y, variance)
        };
        let mut radius_px = 0.004;
        while radius_px < 4.0 {
            let (near, far) = (moments(radius_px * 1.0001), moments(radius_px));
            // A single point reduces the variance by 2.5e-5 px²; sampling of the limb moves the mean by 1e-3
            // of a radius.
            let shift_px = libm::hypot(near.0 - far.0, near.1 - far.1);
            assert!(shift_px < 2e-3 * radius_px + 1e-6, "{radius_px} px: moved by {shift_px} px");
            let widened = (near.2 - far.2).abs();
            assert!(
                widened < 3e-5 + 2e-3 * radius_px * radius_px,
                "{radius_px} px: widened by {widened} px²"
            );
            radius_px *= 1.013;
        }
    }

    #[test]
    fn a_near_sphere_is_seen_no_farther_than_its_horizon() {
        // From a distance of two radii the limb is 60° from the point below the camera; the disk's radius is
        // 1/cos 30° times the sphere's.
        let (sphere, project) = seen(0.0, 2.0, 30.0);
        let disk_px = sphere.disk(&project).radius_px().unwrap();
        assert!((disk_px - 30.0 / libm::cos(PI / 6.0)).abs() < 1e-2, "{disk_px}");
        assert!((sphere.radiance_at(&Vector2::zeros()) - 1.0).abs() < 1e-12);
        // At the horizon the Sun is 60° from the zenith, and the area is 30° off the axis.
        let limb = sphere.radiance_at(&Vector2::new(0.999999 * RADIUS_M / libm::cos(PI / 6.0), 0.0));
        let cos = libm::cos(PI / 6.0);
        assert!((limb - 0.5 * cos * cos * cos).abs() < 2e-3, "{limb}");
        assert!(LitSphere::new(RADIUS_M, Vector3::z() * 0.4, Vector3::x()).is_none());
    }

    #[test]
    fn the_brightest_pixel_of_a_resolved_sphere_is_at_its_brightest_point() {
        for (phase_deg, radius_px) in [(0.0, 15.0), (60.0, 15.0), (120.0, 40.0)] {
            let (sphere, project) = seen(phase_deg, 1e4, radius_px);
            let share = sphere.peak_share(&project, 0.2).unwrap();
            let mut pixels = std::collections::BTreeMap::new();
            for point in points(phase_deg, 1e4, radius_px) {
                let pixel = (point.position.x.round() as i64, point.position.y.round() as i64);
                *pixels.entry(pixel).or_insert(0.0) += point.share;
            }
            let peak = pixels.into_values().fold(0.0, f64::max);
            assert!(peak < 1.01 * share && peak > 0.8 * share, "{phase_deg}°: {peak}, estimated {share}");
        }
        let (sphere, project) = seen(40.0, 1e6, 0.01);
        assert_eq!(sphere.peak_share(&project, 0.2), Some(0.2));
    }
}
