//! Boresights over the whole sky, and the stars in the camera's field at each of them.

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
pub(crate) mod star_count;

use contract::{Angle, CameraFrame, Direction, Icrs, OutOfRange, Rotation};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use rayon::prelude::*;
use sim::SimError;
use sim::catalog::{Catalog, CatalogConfig};
use sim::scene::{CameraMotion, StarField};
use sim::truth::shadow::EARTH_RADIUS_KM;
use sim::truth::{Observer, clock, moon};

use crate::camera::{CameraModel, mean_motion_rad_s};
use crate::requirement::{MotionGuidance, MotionTable, SkyTable, SkyTime};

/// Golden ratio minus 1: rotation between neighbours of the lattice, in turns.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// Irrational number without a common multiple with [`SQRT_3`] and the golden ratio, which decorrelates the
/// time and roll of a pointing from its position.
const SQRT_2: f64 = std::f64::consts::SQRT_2 - 1.0;
const SQRT_3: f64 = 0.732_050_807_568_877_2;

/// Reason for excluding a pointing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exclusion {
    /// The angle to the Sun is too small.
    Sun,
    /// The angle to the Moon is too small.
    Moon,
    /// The angle to the limb of the Earth is too small.
    Earth,
}

impl Exclusion {
    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Moon => "moon",
            Self::Earth => "earth",
        }
    }
}

/// A pointing of the camera at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Pointing {
    /// Direction of the boresight.
    pub boresight: Direction<Icrs>,
    /// Attitude of the camera.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Time of the pointing.
    pub time: Epoch,
    /// Position of the camera relative to the centre of the Earth, km.
    pub position_km: Vector3<f64>,
    /// Reason for excluding the pointing; `None` if it counts.
    pub excluded: Option<Exclusion>,
}

impl Pointing {
    /// Returns boresight `index` of `count` on a spherical Fibonacci lattice, each of which represents an
    /// equal area (Swinbank & Purser 2006, Q. J. R. Meteorol. Soc. 132, 1769): z = 1 − (2 i + 1)/n, right
    /// ascension i golden turns.
    pub fn from_lattice(
        index: usize,
        count: usize,
        motion: &MotionTable,
        sky: &SkyTable,
    ) -> Result<Self, SimError> {
        let i = index as f64;
        let z = 1.0 - (2.0 * i + 1.0) / count as f64;
        let (sin_ra, cos_ra) = libm::sincos(std::f64::consts::TAU * (i * GOLDEN).fract());
        let across = (1.0 - z * z).max(0.0).sqrt();
        let boresight = Vector3::new(across * cos_ra, across * sin_ra, z);
        let east = Vector3::new(-sin_ra, cos_ra, 0.0);
        let (sin_roll, cos_roll) = libm::sincos(std::f64::consts::TAU * (i * SQRT_3).fract());
        // Perpendicular to the boresight, at any roll: the direction of the image's x axis.
        let x = east * cos_roll + boresight.cross(&east) * sin_roll;
        let time = observation_time(&sky.when, (i * SQRT_2).fract())?;
        Self::new(boresight, x, time, motion, sky)
    }

    /// Creates the pointing of a camera with the given `boresight` and the x axis of the image along `x`, two
    /// perpendicular unit vectors. With local orbital guidance, x points away from the Earth and the
    /// boresight along the orbit; otherwise the Earth is behind the camera.
    fn new(
        boresight: Vector3<f64>,
        x: Vector3<f64>,
        time: Epoch,
        motion: &MotionTable,
        sky: &SkyTable,
    ) -> Result<Self, SimError> {
        let up = match motion.guidance {
            MotionGuidance::LocalOrbital => x,
            MotionGuidance::Inertial => boresight,
        };
        let mut pointing = Self {
            boresight: Direction::from_vector(boresight)?,
            camera_from_icrs: Rotation::from_axes(&x, &boresight.cross(&x), &boresight),
            time,
            position_km: up * motion.semi_major_axis_km,
            excluded: None,
        };
        let observer = pointing.observer(motion)?;
        pointing.excluded = pointing.exclusion(&observer, sky);
        Ok(pointing)
    }

    /// Returns the rotation from the image with north up.
    pub fn roll(&self) -> Angle {
        let (sin_ra, cos_ra) = libm::sincos(self.boresight.ra().radians());
        let east = Vector3::new(-sin_ra, cos_ra, 0.0);
        let x = self.camera_from_icrs.inverse().rotate(&Vector3::x());
        // At roll 0, x points to the west; a roll turns it towards y, down the rows.
        let down = -self.boresight.vector().cross(&east);
        Angle::from_radians(libm::atan2(x.dot(&down), x.dot(&-east)))
    }

    /// Returns the observer at the position of the camera.
    pub fn observer(&self, motion: &MotionTable) -> Result<Observer, OutOfRange> {
        let speed_km_s = mean_motion_rad_s(motion.semi_major_axis_km) * motion.semi_major_axis_km;
        let along = match motion.guidance {
            MotionGuidance::LocalOrbital => *self.boresight.vector(),
            MotionGuidance::Inertial => self.camera_from_icrs.inverse().rotate(&Vector3::x()),
        };
        Observer::new(self.time, self.position_km, along * speed_km_s)
    }

    fn exclusion(&self, observer: &Observer, sky: &SkyTable) -> Option<Exclusion> {
        let degrees_from = |other: &Vector3<f64>| {
            let boresight = self.boresight.vector();
            libm::atan2(boresight.cross(other).norm(), boresight.dot(other)).to_degrees()
        };
        if degrees_from(observer.sun().vector()) < sky.sun_exclusion_deg {
            return Some(Exclusion::Sun);
        }
        let moon_km = moon::moon_position_km(clock::tdb_j2000_s(self.time)) - self.position_km;
        if degrees_from(&moon_km) < sky.moon_exclusion_deg {
            return Some(Exclusion::Moon);
        }
        let limb_deg = libm::asin((EARTH_RADIUS_KM / self.position_km.norm()).min(1.0)).to_degrees();
        (degrees_from(&-self.position_km) - limb_deg < sky.earth_exclusion_deg).then_some(Exclusion::Earth)
    }

    /// Returns the mean background over the detector, electrons per second and pixel.
    pub fn background_e_per_s(&self, camera: &CameraModel, observer: &Observer) -> f64 {
        camera.background.as_ref().map_or(0.0, |background| {
            let sun_km = observer.sun_km();
            background.field(self.time, &self.position_km, &sun_km, self.camera_from_icrs).mean_e_per_s()
        })
    }
}

/// Returns the time at the fraction `share` of the observed time span.
fn observation_time(when: &SkyTime, share: f64) -> Result<Epoch, OutOfRange> {
    match when {
        SkyTime::Epoch { utc } => clock::parse_utc(utc),
        SkyTime::Year { year } => {
            Ok(clock::parse_utc(&format!("{year}-01-01T00:00:00Z"))? + share * 365.25 * Unit::Day)
        }
    }
}

/// Star on the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyStar {
    /// Natural logarithm of the electrons per second, after the losses of the optics at the star's position.
    pub ln_e_per_s: f64,
    /// Johnson V magnitude.
    pub magnitude: f64,
}

/// Content of the camera's field at one boresight.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Pointing of the camera.
    pub pointing: Pointing,
    /// Background, electrons per second and pixel, mean over the detector.
    pub background_e_per_s: f64,
    /// Stars on the detector, brightest first.
    pub stars: Vec<SkyStar>,
}

/// The whole sky as the camera observes it, field by field.
#[derive(Debug, Clone, PartialEq)]
pub struct Sky {
    /// Fields at all boresights, including excluded ones (without stars).
    pub fields: Vec<Field>,
}

impl Sky {
    /// Computes the fields at `count` boresights. Stars with fewer electrons per second than `least_e_per_s`
    /// are left out.
    ///
    /// # Errors
    /// [`SimError`] when the catalogue cannot be read, or a time is not covered by the ephemeris.
    pub fn new(
        camera: &CameraModel,
        motion: &MotionTable,
        sky: &SkyTable,
        count: usize,
        least_e_per_s: f64,
    ) -> Result<Self, SimError> {
        let catalog = catalog_to(camera, least_e_per_s)?;
        let stars = StarField::new(&catalog, &camera.radiometry);
        let ln_least = libm::log(least_e_per_s.max(1e-30));
        let fields = (0..count)
            .into_par_iter()
            .map(|index| {
                let pointing = Pointing::from_lattice(index, count, motion, sky)?;
                if pointing.excluded.is_some() {
                    return Ok(Field { pointing, background_e_per_s: 0.0, stars: Vec::new() });
                }
                let observer = pointing.observer(motion)?;
                let mut sources = Vec::new();
                let still = CameraMotion::still(pointing.camera_from_icrs);
                stars.add_visible(&observer, &still, &camera.projection, |_| 0.0, &mut sources);
                let mut seen: Vec<SkyStar> = sources
                    .iter()
                    .map(|source| {
                        let rate = source.electrons_per_s * camera.vignetting.transmission(source.position);
                        SkyStar { ln_e_per_s: libm::log(rate), magnitude: source.magnitude.unwrap_or(99.0) }
                    })
                    .filter(|star| star.ln_e_per_s >= ln_least)
                    .collect();
                seen.sort_by(|a, b| b.ln_e_per_s.total_cmp(&a.ln_e_per_s));
                let background_e_per_s = pointing.background_e_per_s(camera, &observer);
                Ok(Field { pointing, background_e_per_s, stars: seen })
            })
            .collect::<Result<Vec<_>, SimError>>()?;
        Ok(Self { fields })
    }

    /// Returns the fields at the boresights that count.
    pub fn usable_fields(&self) -> impl Iterator<Item = &Field> {
        self.fields.iter().filter(|field| field.pointing.excluded.is_none())
    }
}

/// Returns the stars of the camera's catalogue that can give at least `least_e_per_s`, for any colour.
fn catalog_to(camera: &CameraModel, least_e_per_s: f64) -> Result<Catalog, SimError> {
    let config = &camera.config.catalog;
    // At a given V magnitude, the reddest stars give the most electrons.
    let zero_e_per_s = camera
        .radiometry
        .zero_point_e_per_s(Some(2.0), Some(9.0))
        .max(camera.radiometry.zero_point_e_per_s(Some(-0.4), None));
    let faintest = (-2.5 * libm::log10(least_e_per_s.max(1e-30) / zero_e_per_s)).clamp(-2.0, 30.0);
    let limited = CatalogConfig {
        magnitude_limit: Some(config.magnitude_limit.map_or(faintest, |limit| limit.min(faintest))),
        ..config.clone()
    };
    limited.check()?;
    // Paths are absolute, or relative to the current directory.
    Ok(Catalog::load(&limited, std::path::Path::new(""))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: MotionTable =
        MotionTable { guidance: MotionGuidance::Inertial, semi_major_axis_km: 7130.0 };

    fn lattice(count: usize, sky: &SkyTable) -> Vec<Pointing> {
        (0..count).map(|i| Pointing::from_lattice(i, count, &MOTION, sky).unwrap()).collect()
    }

    /// A cap of radius r contains the fraction (1 − cos r)/2 of an equal-area lattice, at any position.
    #[test]
    fn the_lattice_has_equal_areas() {
        let pointings = lattice(10_000, &SkyTable::default());
        for (ra, dec, radius) in
            [(0.0, 0.0, 20.0), (77.0, 90.0, 15.0), (200.0, -60.0, 30.0), (10.0, 45.0, 8.0)]
        {
            let centre: Direction<Icrs> =
                Direction::from_ra_dec(Angle::from_degrees(ra), Angle::from_degrees(dec));
            let inside =
                pointings.iter().filter(|p| p.boresight.separation(&centre).degrees() < radius).count();
            let expected = 5_000.0 * (1.0 - libm::cos(f64::to_radians(radius)));
            // The count of a lattice errs only at the rim of the cap: far less than the square root of the
            // number, as a random lattice would.
            assert!((inside as f64 - expected).abs() < 0.25 * expected.sqrt() + 3.0, "{inside} {expected}");
        }
    }

    /// The fraction of the sky within 40° of the Sun is (1 − cos 40°)/2 = 11.7 %, at one epoch as well as
    /// throughout the year.
    #[test]
    fn the_sun_takes_its_cap_of_the_sky() {
        let when = SkyTime::Epoch { utc: "2012-04-26T12:00:00Z".to_owned() };
        for when in [when, SkyTime::Year { year: 2012 }] {
            let sky = SkyTable { sun_exclusion_deg: 40.0, when, ..SkyTable::default() };
            let out = lattice(4000, &sky).iter().filter(|p| p.excluded == Some(Exclusion::Sun)).count();
            assert!((out as f64 / 4000.0 - 0.11698).abs() < 0.004, "{out}");
        }
    }

    /// Boresight along the orbit: the centre of the Earth is at 90° and its limb at 90° − asin(6378.1/7130) =
    /// 26.55°.
    #[test]
    fn the_earth_excludes_a_camera_along_the_orbit_by_its_limb() {
        let motion = MotionTable { guidance: MotionGuidance::LocalOrbital, ..MOTION };
        for (earth_exclusion_deg, excluded) in [(26.5, None), (26.6, Some(Exclusion::Earth))] {
            let sky = SkyTable { earth_exclusion_deg, ..SkyTable::default() };
            assert_eq!(Pointing::from_lattice(17, 1000, &motion, &sky).unwrap().excluded, excluded);
        }
    }
}
