//! The Moon in the field of view: a sunlit, resolved sphere.
//!
//! The surface scatters by the Lommel–Seeliger reflectance, radiance ∝ μ₀/(μ₀ + μ) with the cosines of
//! incidence and emission (Hapke 1963, J. Geophys. Res. 68, 4571; Fairbairn 2005, JRASC 99, 92): the full
//! Moon is uniform up to its limb, as the real Moon is and a Lambert sphere is not. The total flux of the
//! disk follows [`moon::moon_magnitude`].

use contract::{CameraFrame, Direction, Icrs, PixelPoint, Rotation};
use nalgebra::{Vector2, Vector3};
use optics::{ImagePoint, Projection, Radiometry};
use truth::constants::{AU_KM, LIGHT_SPEED_KM_S};
use truth::moon::{self, MOON_B_V, MOON_MEAN_DISTANCE_KM, MOON_RADIUS_KM};
use truth::{ObjectKind, Observer, State, aberrate, shadow};

use super::aberration::ABERRATION_MARGIN_RAD;
use super::disk::Disk;
use super::star_field::is_within;
use super::{CameraMotion, Source};

/// Angle from the antisolar direction within which the Earth's shadow may fall on the Moon, rad: seen from
/// the Earth, the penumbra extends 1.3° from that direction at most, and the Moon 0.3°.
const ECLIPSE_RAD: f64 = 2.0 * std::f64::consts::PI / 180.0;
/// Number of cells across the disk for its visible fraction of flux, when the Earth or its shadow may hide a
/// part.
const FRACTION_CELLS: usize = 128;
/// Minimum number of samples along the diameter: few, because the Moon's image is large in any camera that
/// resolves bodies.
const SAMPLES_ACROSS: f64 = 4.0;

/// The Moon as seen by an observer at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct LitMoon {
    /// Geometric position of the Moon's centre relative to the observer, km, ICRS axes.
    centre_km: Vector3<f64>,
    /// Unit vectors: towards the Moon's centre, and two perpendicular to it that span the tangent plane of
    /// the sky.
    towards: Vector3<f64>,
    across: [Vector3<f64>; 2],
    /// Tangent of the apparent radius.
    tan_radius: f64,
    /// Cosine of the sum of the disk's radius and [`ABERRATION_MARGIN_RAD`].
    cos_near: f64,
    /// Unit vector from the Moon's centre towards the Sun.
    sun: Vector3<f64>,
    /// Positions of the observer and of the Sun relative to the Earth's centre, km.
    observer_km: Vector3<f64>,
    earth_to_sun_km: Vector3<f64>,
    /// True if the Earth's shadow may fall on the Moon.
    near_shadow: bool,
    /// Cosine of the Earth's apparent radius, if the Earth is nearer than the Moon.
    earth_cos: Option<f64>,
    phase_rad: f64,
    astrometric: Direction<Icrs>,
    apparent: Direction<Icrs>,
    /// Magnitude of the whole sunlit part, without occultation and without shadow.
    bare_magnitude: f64,
}

impl LitMoon {
    /// Returns the Moon at `tdb_j2000_s` as seen from `chaser`, whose position and motion are also in
    /// `observer`; `None` from inside the Moon.
    ///
    /// The aberration includes light time. The Moon moves about the Sun with the Earth, at 30 km/s, and its
    /// displacement of 20″ during the light time cancels the aberration due to the Earth's motion. The Moon's
    /// motion about the Earth during the light time (0.7″) is also included. The geometry of illumination and
    /// shadow is that of one instant.
    pub fn new(tdb_j2000_s: f64, chaser: &State, observer: &Observer) -> Option<Self> {
        let centre_km = moon::moon_position_km(tdb_j2000_s) - chaser.position_km;
        let distance_km = centre_km.norm();
        if distance_km <= MOON_RADIUS_KM {
            return None;
        }
        let light_s = distance_km / LIGHT_SPEED_KM_S;
        let velocity_km_s = observer.barycentric_velocity_km_s();
        let earth_km_s = velocity_km_s - chaser.velocity_km_s;
        let retarded_km =
            moon::moon_position_km(tdb_j2000_s - light_s) - chaser.position_km - earth_km_s * light_s;
        let astrometric = Direction::from_vector(retarded_km).ok()?;

        let towards = centre_km / distance_km;
        // The first perpendicular vector is derived from a coordinate axis well away from the Moon's
        // direction.
        let axis = if towards.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = towards.cross(&axis).normalize();
        let sun_km = observer.sun_km() - centre_km;
        let earth_to_sun_km = chaser.position_km + observer.sun_km();
        let earth_to_moon_km = chaser.position_km + centre_km;
        let sine = MOON_RADIUS_KM / distance_km;
        let earth_sine = shadow::EARTH_RADIUS_KM / chaser.position_km.norm();
        let phase_rad = angle(&sun_km, &-centre_km);
        let far = distance_km / MOON_MEAN_DISTANCE_KM * (sun_km.norm() / AU_KM);
        Some(Self {
            centre_km,
            towards,
            across: [first, towards.cross(&first)],
            tan_radius: sine / (1.0 - sine * sine).sqrt(),
            cos_near: libm::cos(libm::asin(sine) + ABERRATION_MARGIN_RAD),
            sun: sun_km.normalize(),
            observer_km: chaser.position_km,
            earth_to_sun_km,
            near_shadow: angle(&earth_to_moon_km, &-earth_to_sun_km) < ECLIPSE_RAD,
            earth_cos: (chaser.position_km.norm() < distance_km)
                .then(|| (1.0 - earth_sine * earth_sine).max(0.0).sqrt()),
            phase_rad,
            astrometric,
            // No light deflection: the Moon is so near that its light does not pass the Sun.
            apparent: aberrate(astrometric, &(velocity_km_s / LIGHT_SPEED_KM_S)),
            bare_magnitude: moon::moon_magnitude(phase_rad.to_degrees()) + 5.0 * libm::log10(far),
        })
    }

    /// Magnitude of the visible part; infinite if no part is visible.
    fn magnitude(&self) -> f64 {
        self.bare_magnitude - 2.5 * libm::log10(self.visible_fraction())
    }

    /// Returns the Moon as a source at the position of its disk's centre. `None` if no flux reaches the
    /// camera, or if the image lies off the detector; the image is wider than the disk by `reach_px` of the
    /// electrons per second.
    pub fn source(
        &self,
        camera: &CameraMotion,
        projection: &Projection,
        radiometry: &Radiometry,
        reach_px: impl Fn(f64) -> f64,
    ) -> Option<Source> {
        let position = projection.project(&(camera.middle * self.apparent))?;
        let [half_width, half_height] = self.disk(camera.middle, projection).half_sides_px()?;
        let side_px = half_width.max(half_height) + camera.reach_px(projection);
        let electrons_per_s = |magnitude: f64| radiometry.star(magnitude, Some(MOON_B_V), None);
        let is_near =
            |electrons_per_s: f64| is_within(position, projection, side_px + reach_px(electrons_per_s));
        // The visible fraction is slow to compute, and the Moon is seldom in the field of view.
        if !is_near(electrons_per_s(self.bare_magnitude)) {
            return None;
        }
        let magnitude = self.magnitude();
        if !magnitude.is_finite() {
            return None;
        }
        let electrons_per_s = electrons_per_s(magnitude);
        is_near(electrons_per_s).then(|| Source {
            kind: ObjectKind::Moon,
            id: 0,
            position,
            ends: camera.ends.map(|end| projection.project(&(end * self.apparent)).unwrap_or(position)),
            astrometric: Some(self.astrometric),
            magnitude: Some(magnitude),
            electrons_per_s,
        })
    }

    /// Returns true if the Moon may hide a distant source with this astrometric direction. This test is much
    /// faster than the computation of the apparent direction.
    pub fn is_near(&self, astrometric: &Direction<Icrs>) -> bool {
        self.apparent.vector().dot(astrometric.vector()) > self.cos_near
    }

    /// Returns true if the Moon hides a distant source that an ideal camera sees in the direction `apparent`.
    pub fn hides(&self, apparent: &Direction<Icrs>) -> bool {
        angle(self.apparent.vector(), apparent.vector()) < libm::atan(self.tan_radius)
    }

    /// Appends the points of the undistorted image: the visible sunlit part, about `count_limit` points at
    /// most. Their shares add up to 1, except for the share of points without an image. Appends nothing if no
    /// flux reaches the camera.
    pub fn image(
        &self,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        count_limit: usize,
        points: &mut Vec<ImagePoint>,
    ) {
        self.disk(camera_from_icrs, projection).image(|at| self.visible_radiance(at), count_limit, points);
    }

    /// Returns the disk on the plane tangent to the sky at its centre, aberration included. The variation of
    /// the aberration over the disk, 0.1″, is negligible.
    fn disk<'a>(
        &'a self,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &'a Projection,
    ) -> Disk<impl Fn(Vector2<f64>) -> Option<PixelPoint> + 'a> {
        let to_image = move |at: Vector2<f64>| {
            let direction = self.apparent.vector() + self.across[0] * at.x + self.across[1] * at.y;
            projection.project(&(camera_from_icrs * Direction::from_vector(direction).ok()?))
        };
        let lit = 0.5 * (1.0 + libm::cos(self.phase_rad));
        Disk { to_image, radius: self.tan_radius, lit, samples_across: SAMPLES_ACROSS }
    }

    /// Fraction of the disk's flux that remains after occultation by the Earth and after its shadow.
    fn visible_fraction(&self) -> f64 {
        let separation = angle(&self.towards, &-self.observer_km);
        let apart = self
            .earth_cos
            .is_none_or(|cos| separation > libm::acos(cos.min(1.0)) + libm::atan(self.tan_radius));
        if apart && !self.near_shadow {
            return 1.0;
        }
        let coordinate = |i: usize| self.tan_radius * (2.0 * (i as f64 + 0.5) / FRACTION_CELLS as f64 - 1.0);
        let (mut seen, mut all) = (0.0, 0.0);
        for j in 0..FRACTION_CELLS {
            for i in 0..FRACTION_CELLS {
                let at = Vector2::new(coordinate(i), coordinate(j));
                all += self.radiance(&at).map_or(0.0, |(radiance, _)| radiance);
                seen += self.visible_radiance(&at);
            }
        }
        if all > 0.0 { seen / all } else { 0.0 }
    }

    /// Radiance at a point of the tangent plane, after occultation by the Earth and after its shadow.
    fn visible_radiance(&self, at: &Vector2<f64>) -> f64 {
        let Some((radiance, point_km)) = self.radiance(at) else { return 0.0 };
        let nadir = point_km.dot(&-self.observer_km) / (point_km.norm() * self.observer_km.norm());
        if self.earth_cos.is_some_and(|cos| nadir > cos) {
            return 0.0;
        }
        if self.near_shadow {
            return radiance * shadow::sunlit_fraction(&(self.observer_km + point_km), &self.earth_to_sun_km);
        }
        radiance
    }

    /// μ₀/(μ₀ + μ) at a point of the tangent plane, and the surface point visible there, km from the
    /// observer; `None` off the sunlit part of the disk. Equal areas of the plane have equal solid angles to
    /// within 1e-5.
    fn radiance(&self, at: &Vector2<f64>) -> Option<(f64, Vector3<f64>)> {
        let ray = (self.towards + self.across[0] * at.x + self.across[1] * at.y).normalize();
        let along_km = ray.dot(&self.centre_km);
        let depth2 = along_km * along_km - self.centre_km.norm_squared() + MOON_RADIUS_KM * MOON_RADIUS_KM;
        if depth2 < 0.0 {
            return None;
        }
        let point_km = ray * (along_km - depth2.sqrt());
        let normal = (point_km - self.centre_km) / MOON_RADIUS_KM;
        let (incidence, emission) = (normal.dot(&self.sun), -normal.dot(&ray));
        (incidence > 0.0).then(|| (incidence / (incidence + emission.max(0.0)), point_km))
    }
}

/// Angle between two vectors, rad.
fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Camera;
    use optics::{Psf, PsfConfig, Stamp};
    use truth::clock;
    use truth::moon::lommel_seeliger_phase;

    /// Returns the Moon at `utc` as seen from a point 7000 km from the Earth's centre, `degrees` away from
    /// the direction towards the Moon.
    fn seen_from(utc: &str, degrees: f64) -> LitMoon {
        let time = clock::parse_utc(utc).unwrap();
        let towards = moon::moon_position_km(clock::tdb_j2000_s(time)).normalize();
        let across = towards.cross(&Vector3::z()).normalize();
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let chaser = State {
            position_km: (towards * cos + across * sin) * 7_000.0,
            velocity_km_s: towards.cross(&across) * 7.5,
        };
        let observer = Observer::new(time, chaser.position_km, chaser.velocity_km_s).unwrap();
        LitMoon::new(clock::tdb_j2000_s(time), &chaser, &observer).unwrap()
    }

    /// Returns the Moon's disk with the Sun at phase angle `phase_deg`.
    fn at_phase(phase_deg: f64) -> LitMoon {
        let moon = seen_from("2020-01-01T00:00:00Z", 90.0);
        let (sin, cos) = libm::sincos(phase_deg.to_radians());
        let sun = moon.across[0] * sin - moon.towards * cos;
        LitMoon { sun, phase_rad: phase_deg.to_radians(), ..moon }
    }

    /// Returns the image points of the Moon in a camera of 200 × 200 pixels that points at it and in which
    /// the disk has radius `radius_px`.
    fn drawn(moon: &LitMoon, radius_px: f64, count_limit: usize) -> Vec<ImagePoint> {
        let camera = Camera {
            columns: 200,
            rows: 200,
            focal_length_mm: radius_px / moon.tan_radius * 0.01,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 99.7,
            principal_y_px: 100.1,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        };
        let to_icrs = [moon.across[0], moon.across[1], *moon.apparent.vector()];
        let matrix = nalgebra::Matrix3::from_columns(&to_icrs).transpose();
        let turn = nalgebra::UnitQuaternion::from_matrix(&matrix);
        let camera_from_icrs = Rotation::from_wxyz([turn.w, turn.i, turn.j, turn.k]).unwrap();
        let mut points = Vec::new();
        moon.image(camera_from_icrs, &Projection::new(&camera).unwrap(), count_limit, &mut points);
        points
    }

    #[test]
    fn the_earths_motion_about_the_sun_does_not_move_the_moon() {
        let moon = seen_from("2020-01-01T00:00:00Z", 90.0);
        let geometric = Direction::from_vector(moon.centre_km).unwrap();
        // 5.2″ from the orbital motion, 0.7″ from the Moon's own motion.
        let apparent = geometric.separation(&moon.apparent).arcsec();
        assert!((4.0..6.0).contains(&apparent), "{apparent}″");
        // Light time in the Sun's frame: up to 20.5″.
        assert!(geometric.separation(&moon.astrometric).arcsec() < 21.5);
        assert!(moon.apparent.separation(&moon.astrometric).arcsec() > 3.0);
    }

    /// The flux of the disk at a phase angle, relative to the full disk, equals the closed form for a distant
    /// observer.
    #[test]
    fn the_disk_is_a_lommel_seeliger_sphere() {
        let light = |moon: &LitMoon| {
            let n = 1000;
            let coordinate = |i: i32| moon.tan_radius * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
            (0..n * n)
                .filter_map(|i| moon.radiance(&Vector2::new(coordinate(i % n), coordinate(i / n))))
                .map(|(radiance, _)| radiance)
                .sum::<f64>()
        };
        let full = light(&at_phase(0.0));
        for phase_deg in [20.0, 60.0, 90.0, 130.0] {
            let ratio = light(&at_phase(phase_deg)) / full;
            let expected = lommel_seeliger_phase(f64::to_radians(phase_deg));
            // The Moon is seen from a distance of 220 radii, so 0.3° of the surface at the limb is invisible.
            assert!((ratio / expected - 1.0).abs() < 0.015, "{phase_deg}°: {ratio}, expected {expected}");
        }
    }

    #[test]
    fn the_points_add_up_to_one_at_every_phase_and_size() {
        for phase_deg in [0.0, 30.0, 90.0, 150.0, 175.0] {
            for radius_px in [0.05, 0.7, 10.4, 90.0] {
                let points = drawn(&at_phase(phase_deg), radius_px, 1 << 18);
                let sum: f64 = points.iter().map(|point| point.share).sum();
                assert!((sum - 1.0).abs() < 1e-9, "{phase_deg}°, {radius_px} px: {sum}");
            }
        }
    }

    #[test]
    fn the_full_disk_is_even_and_as_large_as_it_should_be() {
        let points = drawn(&at_phase(0.0), 30.0, 1 << 18);
        let mut stamp = Stamp::new();
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 0.4 }).unwrap();
        psf.stamp_extended(&points, 1.0, 1e-12, (200, 200), &mut stamp);
        let level = 1.0 / (std::f64::consts::PI * 900.0);
        let mut lit = 0.0;
        for (x, y, row) in stamp.rows() {
            for (i, &share) in row.iter().enumerate() {
                let radius = libm::hypot((x + i) as f64 - 99.7, y as f64 - 100.1);
                // Deviation of 2e-3: for a distant Sun and a near Moon, sunlight and line of sight differ by
                // 0.3° at the limb, which brightens it.
                assert!(radius > 27.0 || (share / level - 1.0).abs() < 4e-3, "{}", share / level);
                lit += (share / level).min(1.0);
            }
        }
        assert!((lit / (std::f64::consts::PI * 900.0) - 1.0).abs() < 2e-3, "{lit} px");
    }

    #[test]
    fn a_large_disk_keeps_to_its_number_of_points() {
        for (phase_deg, radius_px) in [(0.0, 150.0), (90.0, 150.0), (0.0, 900.0)] {
            let points = drawn(&at_phase(phase_deg), radius_px, 10_000).len();
            // Partly lit cells at the rim count as whole points.
            assert!((1_000..11_500).contains(&points), "{points} points");
        }
    }

    #[test]
    fn behind_the_earth_its_flux_is_zero_and_at_the_limb_half() {
        let full = seen_from("2020-01-01T00:00:00Z", 90.0);
        assert_eq!(full.visible_fraction(), 1.0);
        assert_eq!(seen_from("2020-01-01T00:00:00Z", 180.0).magnitude(), f64::INFINITY);
        let limb_deg = 180.0 - libm::asin(shadow::EARTH_RADIUS_KM / 7_000.0).to_degrees();
        // The offset corrects for the parallax of 7000 km, so that the Moon is at the limb.
        let mut moon = seen_from("2020-01-01T00:00:00Z", limb_deg - 0.95);
        moon.sun = -moon.towards;
        let disk =
            shadow::visible_fraction(&moon.observer_km, &(moon.observer_km + moon.centre_km), MOON_RADIUS_KM);
        assert!((0.02..0.98).contains(&disk), "{disk}");
        assert!((moon.visible_fraction() - disk).abs() < 0.01, "{} {disk}", moon.visible_fraction());
    }

    /// Espenak & Meeus, Five Millennium Catalog of Lunar Eclipses: total eclipse at 2018-07-27 20:21:44 UTC;
    /// partial eclipse at 2019-07-16 21:30:44 UTC, umbral magnitude 0.653.
    #[test]
    fn eclipses_are_those_of_the_catalogue() {
        assert_eq!(seen_from("2018-07-27T20:21:44Z", 90.0).magnitude(), f64::INFINITY);
        let partial = seen_from("2019-07-16T21:30:44Z", 90.0);
        let to_axis = -partial.earth_to_sun_km.normalize();
        let axis = Vector2::new(partial.across[0].dot(&to_axis), partial.across[1].dot(&to_axis));
        // The shadow is centred opposite to the Sun as seen from the Earth's centre, not from 7000 km beside
        // it.
        let parallax = Vector2::new(
            partial.across[0].dot(&partial.observer_km),
            partial.across[1].dot(&partial.observer_km),
        ) / partial.centre_km.norm();
        let along = (axis - parallax).normalize() * partial.tan_radius;
        let dark = (0..1000)
            .filter(|i| partial.visible_radiance(&(along * (f64::from(*i) / 499.5 - 1.0) * 0.9999)) == 0.0)
            .count();
        // The catalogue's shadow is 1 to 2 % larger because of the atmosphere: 0.03 of the Moon's diameter.
        // An ephemeris error of 0.02° is 0.04 of the diameter.
        assert!((dark as f64 / 1000.0 - 0.653).abs() < 0.08, "{dark}");
        let bright = seen_from("2019-07-15T21:30:44Z", 90.0).magnitude();
        assert!(partial.magnitude() > bright + 0.5 && partial.magnitude().is_finite());
    }

    #[test]
    fn the_new_moon_is_next_to_nothing() {
        // New Moon on 2020-01-24 at 21:42 UTC, 3° from the Sun.
        let new = seen_from("2020-01-24T21:42:00Z", 90.0);
        assert!(new.phase_rad.to_degrees() > 174.0);
        assert!(new.magnitude() > -3.5, "{}", new.magnitude());
    }
}
