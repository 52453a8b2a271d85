//! Apparent positions of stars as seen from the spacecraft: space motion, parallax, light deflection,
//! aberration.
//!
//! The chain is that of the IAU's SOFA collection for an observer in space, catalogue to proper direction
//! (ICRS to GCRS axes): straight space motion and parallax, deflection of light by the Sun, exact
//! relativistic aberration. It was written from the papers and is compared with ERFA (`golden/apparent`).
//! Neglected: deflection by planets (16 mas at Jupiter's limb, under 1 mas from 6′ on) and by the Earth (0.4
//! mas at its limb from a low orbit).

use contract::bounds::require;
use contract::{Direction, Icrs, OutOfRange};
use hifitime::Epoch;
use nalgebra::Vector3;

use super::{clock, ephemeris};
use crate::catalog::CatalogStar;
use crate::constants::{AU_KM, LIGHT_SPEED_KM_S};

/// Julian year, s.
const YEAR_S: f64 = 365.25 * 86_400.0;
/// Light time of one astronomical unit, Julian years.
const AU_LIGHT_YEARS: f64 = AU_KM / LIGHT_SPEED_KM_S / YEAR_S;
/// Schwarzschild radius of the Sun, 2GM/c², au.
const SUN_SCHWARZSCHILD_AU: f64 = 1.97412574336e-8;
/// Catalogue epoch J1991.25, s since J2000.0.
const CATALOG_EPOCH_S: f64 = -8.75 * YEAR_S;
const RADIANS_PER_MAS: f64 = std::f64::consts::PI / (180.0 * 3_600.0 * 1_000.0);
/// Maximum distance of an observer from the Earth, km: well inside the Earth's distance from the Sun.
const FARTHEST_KM: f64 = 1e7;
/// Maximum speed of an observer relative to the Earth, km/s.
const FASTEST_KM_S: f64 = 1e3;

/// Position and motion of a star as vectors, computed once per catalogue.
///
/// Epoch J1991.25 (TDB; the catalogue's TT differs by less than 2 ms), ICRS axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarMotion {
    /// Unit vector towards the star at the epoch.
    unit_vector: Vector3<f64>,
    /// Space velocity divided by distance at the epoch, rad per Julian year. Its transverse component is the
    /// proper motion; its radial component is the relative change of distance.
    motion_per_yr: Vector3<f64>,
    /// Parallax, rad.
    parallax: f64,
}

impl StarMotion {
    /// Converts catalogue values. A negative parallax is measurement noise; the star is then assumed to be at
    /// infinity.
    pub fn new(star: &CatalogStar) -> Self {
        let (sin_ra, cos_ra) = libm::sincos(star.ra_rad);
        let (sin_dec, cos_dec) = libm::sincos(star.dec_rad);
        let unit_vector = Vector3::new(cos_ra * cos_dec, sin_ra * cos_dec, sin_dec);
        let east = Vector3::new(-sin_ra, cos_ra, 0.0);
        let north = Vector3::new(-cos_ra * sin_dec, -sin_ra * sin_dec, cos_dec);
        let parallax = star.parallax_mas.max(0.0) * RADIANS_PER_MAS;
        // Distance equals 1 au divided by the parallax, so radial velocity in au/yr times parallax is the
        // relative change per year.
        let radial = star.radial_velocity_km_s * (YEAR_S / AU_KM) * parallax;
        let motion_per_yr = east * (star.pm_ra_mas_per_yr * RADIANS_PER_MAS)
            + north * (star.pm_dec_mas_per_yr * RADIANS_PER_MAS)
            + unit_vector * radial;
        Self { unit_vector, motion_per_yr, parallax }
    }
}

/// Position and velocity of an observer of stars, with all quantities that do not depend on the star.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// TDB since the catalogue's epoch, Julian years.
    years: f64,
    /// Position relative to the barycentre of the Solar System, au.
    position_au: Vector3<f64>,
    /// Velocity relative to the barycentre of the Solar System, in units of the speed of light.
    beta: Vector3<f64>,
    inverse_gamma: f64,
    /// Unit vector from the Sun to the observer.
    from_sun: Vector3<f64>,
    sun_distance_au: f64,
}

impl Observer {
    /// Creates the observer at `time`, at `position_km` relative to the Earth's centre and with the velocity
    /// `velocity_km_s` relative to it, ICRS axes.
    ///
    /// # Errors
    /// [`OutOfRange`] if the time is outside [`ephemeris::COVERAGE`], or the observer is farther from the
    /// Earth than 10⁷ km or faster than 1000 km/s, or a number is not finite.
    ///
    /// ```
    /// use boresight_truth::{Observer, clock};
    /// use nalgebra::Vector3;
    ///
    /// let time = clock::parse_utc("2012-04-25T12:18:54.5Z")?;
    /// let observer = Observer::new(time, Vector3::new(7_100.0, 0.0, 0.0), Vector3::new(0.0, 0.0, 7.5))?;
    /// // The Earth carries the spacecraft along at 30 km/s.
    /// assert!((20.0..40.0).contains(&observer.barycentric_velocity_km_s().norm()));
    /// # Ok::<(), boresight_truth::SimError>(())
    /// ```
    pub fn new(
        time: Epoch,
        position_km: Vector3<f64>,
        velocity_km_s: Vector3<f64>,
    ) -> Result<Self, OutOfRange> {
        require("observer.position_km", position_km.norm(), "a length of at most 1e7", |d| d <= FARTHEST_KM)?;
        require("observer.velocity_km_s", velocity_km_s.norm(), "a length of at most 1000", |v| {
            v <= FASTEST_KM_S
        })?;
        let tdb_s = clock::tdb_j2000_s(time);
        let earth = ephemeris::earth(tdb_s)
            .ok_or_else(|| OutOfRange::new("time", clock::format_utc(time), ephemeris::COVERAGE_TEXT))?;

        let from_sun_km = earth.position_km + position_km - earth.sun_position_km;
        let sun_distance_km = from_sun_km.norm();
        let beta = (earth.velocity_km_s + velocity_km_s) / LIGHT_SPEED_KM_S;
        Ok(Self {
            years: (tdb_s - CATALOG_EPOCH_S) / YEAR_S,
            position_au: (earth.position_km + position_km) / AU_KM,
            beta,
            inverse_gamma: (1.0 - beta.norm_squared()).sqrt(),
            from_sun: from_sun_km / sun_distance_km,
            sun_distance_au: sun_distance_km / AU_KM,
        })
    }

    /// Position relative to the barycentre of the Solar System, au, ICRS axes.
    pub fn barycentric_position_au(&self) -> Vector3<f64> {
        self.position_au
    }

    /// Velocity relative to the barycentre of the Solar System, km/s, ICRS axes.
    pub fn barycentric_velocity_km_s(&self) -> Vector3<f64> {
        self.beta * LIGHT_SPEED_KM_S
    }

    /// Direction to the centre of the Sun: geometric, without light time and aberration (20″ from the
    /// apparent direction).
    pub fn sun(&self) -> Direction<Icrs> {
        Direction::from_unit(-self.from_sun)
    }

    /// Position of the Sun relative to the observer, km: geometric, like [`Observer::sun`].
    pub fn sun_km(&self) -> Vector3<f64> {
        -self.from_sun * (self.sun_distance_au * AU_KM)
    }

    /// Distance to the centre of the Sun, au.
    pub fn sun_distance_au(&self) -> f64 {
        self.sun_distance_au
    }

    /// Returns the geometric direction to a star: space motion in a straight line (proper motion and its
    /// perspective change), then parallax.
    ///
    /// Murray, Vectorial Astrometry (1983); Urban & Seidelmann, Explanatory Supplement (2013), Sec. 7.2. The
    /// Roemer delay, by which the light reaches the observer earlier than the barycentre, is computed along
    /// the catalogued direction. Not modelled: the relativistic terms of a star's own motion (in 2044, 0.20
    /// mas for Kapteyn's star, 0.10 mas for Barnard's).
    pub fn astrometric(&self, star: &StarMotion) -> Direction<Icrs> {
        Direction::from_unit(self.coordinate_direction(star))
    }

    /// Returns the direction in which an ideal camera sees a star: [`Observer::astrometric`] with deflection
    /// by the Sun ([`deflect`]) and aberration ([`aberrate`], with the Sun's potential added: 0.4 µas,
    /// Klioner 2003, Eq. 7).
    pub fn apparent(&self, star: &StarMotion) -> Direction<Icrs> {
        self.apparent_from_astrometric(self.astrometric(star))
    }

    /// Returns the direction in which an ideal camera sees a distant source with the astrometric direction
    /// `astrometric`; see [`Observer::apparent`].
    pub fn apparent_from_astrometric(&self, astrometric: Direction<Icrs>) -> Direction<Icrs> {
        let natural = bend(astrometric.vector(), &self.from_sun, self.sun_distance_au);
        let potential = SUN_SCHWARZSCHILD_AU / self.sun_distance_au;
        Direction::from_unit(boost(&natural, &self.beta, self.inverse_gamma, potential))
    }

    fn coordinate_direction(&self, star: &StarMotion) -> Vector3<f64> {
        let years = self.years + star.unit_vector.dot(&self.position_au) * AU_LIGHT_YEARS;
        (star.unit_vector + star.motion_per_yr * years - self.position_au * star.parallax).normalize()
    }
}

/// Returns the direction after deflection of light by the Sun, for a source far behind it.
///
/// `p + 2GM/(c² d) · (e − (p·e) p) / (1 + p·e)`, with p the direction to the star, e the unit vector from the
/// Sun to the observer, d the distance of the Sun: Klioner (2003), Astron. J. 125, 1580, Eq. 70. 4.07 mas at
/// 90° from the Sun, 1.75″ at its limb. Within 4.9′ of the Sun's centre (behind its disk) the deflection is
/// reduced, to zero at the centre, as in SOFA.
pub fn deflect(direction: Direction<Icrs>, sun: Direction<Icrs>, sun_distance_au: f64) -> Direction<Icrs> {
    Direction::from_unit(bend(direction.vector(), &-sun.vector(), sun_distance_au).normalize())
}

/// Returns the direction seen by an observer that moves with `beta` (velocity divided by the speed of light,
/// |β| < 1).
///
/// Exact aberration of special relativity: `u′ = (u/γ + β (1 + u·β/(1 + 1/γ))) / (1 + u·β)` (Urban &
/// Seidelmann 2013, Eq. 7.40). [`unaberrate`] is its inverse.
pub fn aberrate(direction: Direction<Icrs>, beta: &Vector3<f64>) -> Direction<Icrs> {
    let inverse_gamma = (1.0 - beta.norm_squared()).sqrt();
    Direction::from_unit(boost(direction.vector(), beta, inverse_gamma, 0.0))
}

/// Returns the direction whose aberrated direction is `apparent`: the exact inverse of [`aberrate`], equal to
/// the aberration for the opposite velocity.
pub fn unaberrate(apparent: Direction<Icrs>, beta: &Vector3<f64>) -> Direction<Icrs> {
    aberrate(apparent, &-beta)
}

/// Deflection formula of [`deflect`]. The result is not normalised: its length is 1 within 1e-11.
fn bend(direction: &Vector3<f64>, from_sun: &Vector3<f64>, sun_distance_au: f64) -> Vector3<f64> {
    let cosine = direction.dot(from_sun);
    // 1 + p·e is half the square of the angle from the Sun; SOFA limits it to at least 1e-6 (4.9′ at 1 au).
    let limiter = 1e-6 / (sun_distance_au * sun_distance_au).max(1.0);
    let strength = SUN_SCHWARZSCHILD_AU / sun_distance_au / (1.0 + cosine).max(limiter);
    direction + (from_sun - direction * cosine) * strength
}

/// Aberration formula of [`aberrate`]; `potential` is twice the Sun's potential over c², positive.
fn boost(natural: &Vector3<f64>, beta: &Vector3<f64>, inverse_gamma: f64, potential: f64) -> Vector3<f64> {
    let along = natural.dot(beta);
    let forward = 1.0 + along / (1.0 + inverse_gamma) + potential;
    (natural * (inverse_gamma - potential * along) + beta * forward).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Angle;
    use proptest::prelude::*;

    fn direction(x: f64, y: f64, z: f64) -> Direction<Icrs> {
        Direction::from_vector(Vector3::new(x, y, z)).unwrap()
    }

    fn star() -> CatalogStar {
        CatalogStar {
            id: 1,
            ra_rad: 1.0,
            dec_rad: 0.5,
            parallax_mas: 0.0,
            pm_ra_mas_per_yr: 0.0,
            pm_dec_mas_per_yr: 0.0,
            radial_velocity_km_s: 0.0,
            hp_mag: 5.0,
            b_v: None,
            v_i: None,
        }
    }

    fn observer(utc: &str) -> Observer {
        Observer::new(clock::parse_utc(utc).unwrap(), Vector3::zeros(), Vector3::zeros()).unwrap()
    }

    #[test]
    fn aberration_obeys_the_cosine_law_of_special_relativity() {
        // Einstein 1905, §7: cos θ′ = (cos θ + β)/(1 + β cos θ), towards the motion.
        for beta in [1e-4, 0.01, 0.6] {
            for degrees in [0.0, 10.0, 60.0, 90.0, 135.0, 180.0] {
                let angle = Angle::from_degrees(degrees).radians();
                let seen =
                    aberrate(direction(libm::sin(angle), 0.0, libm::cos(angle)), &(Vector3::z() * beta));
                let cosine = (libm::cos(angle) + beta) / (1.0 + beta * libm::cos(angle));
                assert!((seen.vector().z - cosine).abs() < 1e-15, "{beta} {degrees}");
            }
        }
    }

    #[test]
    fn the_orbital_speed_of_the_earth_shifts_a_star_across_by_the_constant_of_aberration() {
        // κ = 20.49552″ corresponds to the mean orbital speed 29.7847 km/s (corrected for e): β = tan κ.
        let kappa = Angle::from_arcsec(20.49552);
        let seen = aberrate(direction(1.0, 0.0, 0.0), &(Vector3::y() * libm::tan(kappa.radians())));
        let shift = seen.separation(&direction(1.0, 0.0, 0.0));
        // Perpendicular to the motion the sine of the shift is β exactly, so with β = tan κ the shift exceeds
        // κ by κ³/2, 1e-7″.
        assert!((shift.arcsec() - 20.49552).abs() < 1e-5, "{}", shift.arcsec());
        assert!(seen.vector().y > 0.0, "towards the motion");
    }

    #[test]
    fn light_is_bent_by_the_angles_of_general_relativity() {
        let sun = direction(0.0, 0.0, 1.0);
        // Einstein 1916: 2GM/(c² d) cot(θ/2): 1.7505″ at the limb (959.63″) and 4.072 mas at 90°.
        for (angle, expected_mas, tolerance_mas) in
            [(Angle::from_arcsec(959.63), 1_750.5, 0.5), (Angle::from_degrees(90.0), 4.072, 1e-3)]
        {
            let (s, c) = libm::sincos(angle.radians());
            let star = direction(s, 0.0, c);
            let seen = deflect(star, sun, 1.0);
            let outward = (seen.separation(&sun).arcsec() - star.separation(&sun).arcsec()) * 1e3;
            assert!((outward - expected_mas).abs() < tolerance_mas, "{outward} mas at {}″", angle.arcsec());
        }
        assert_eq!(deflect(sun, sun, 1.0), sun);
        assert!(
            deflect(direction(0.0, 0.0, -1.0), sun, 1.0).separation(&direction(0.0, 0.0, -1.0)).arcsec()
                < 1e-12
        );
    }

    /// ERFA's `eraAb`, p/γ + (1 + p·v/(1 + 1/γ)) v + w (v − (p·v) p), with p = (0.6, 0.8, 0), v = (0, 0.5, 0)
    /// and w = a tenth in place of the Sun's value at 1 au: x = 0.6 · 0.826025 and y = 0.8 · 0.826025 + 0.5 ·
    /// 1.314359.
    #[test]
    fn the_potential_of_the_sun_adds_to_aberration() {
        let beta = Vector3::new(0.0, 0.5, 0.0);
        let seen = boost(&Vector3::new(0.6, 0.8, 0.0), &beta, 0.75_f64.sqrt(), 0.1);
        assert!((seen.y / seen.x - 2.659_321).abs() < 1e-6, "{seen}");
        assert!((seen.norm() - 1.0).abs() < 1e-15 && seen.z == 0.0);
    }

    /// The Earth's mean speed is 29.8 km/s and varies by 1.7 % along the orbit; the Sun's own speed is 0.02
    /// km/s.
    #[test]
    fn an_observer_at_rest_on_the_earth_moves_with_it() {
        let observer = observer("2012-04-25T12:00:00Z");
        let speed = observer.barycentric_velocity_km_s().norm();
        assert!((29.2..30.4).contains(&speed), "{speed}");
        let sun_au = observer.sun().vector() * observer.sun_distance_au();
        assert!((observer.sun_km() / AU_KM - sun_au).norm() < 1e-12);
        // Astronomical Almanac, low-precision formulae: 1.00014 − 0.01671 cos g − 0.00014 cos 2g, with g =
        // 110.76°.
        assert!((observer.sun_distance_au() - 1.006_17).abs() < 5e-4, "{}", observer.sun_distance_au());
    }

    #[test]
    fn a_star_without_motion_stays_where_it_is_catalogued() {
        let still = star();
        let seen = observer("2030-01-01T00:00:00Z").astrometric(&StarMotion::new(&still));
        assert!(seen.separation(&still.direction()).arcsec() < 1e-10);
    }

    #[test]
    fn a_year_of_proper_motion_is_its_catalogued_amount_in_its_direction() {
        let mut moving = star();
        moving.pm_ra_mas_per_yr = 1_000.0;
        moving.pm_dec_mas_per_yr = -500.0;
        // 20 Julian years after J1991.25 (1991-04-02.5625 TT): 2011-04-02 13:30 TT.
        let seen = observer("2011-04-02T13:28:53.816Z").astrometric(&StarMotion::new(&moving));
        let east_mas =
            (seen.ra().arcsec() - moving.ra_rad.to_degrees() * 3_600.0) * libm::cos(moving.dec_rad) * 1e3;
        let north_mas = (seen.dec().arcsec() - moving.dec_rad.to_degrees() * 3_600.0) * 1e3;
        // The Roemer delay (up to 500 s: 0.02 mas) and the curvature of the parallel (20″² tan δ: 1 mas)
        // remain.
        assert!((east_mas - 20_000.0).abs() < 2.0, "{east_mas}");
        assert!((north_mas + 10_000.0).abs() < 2.0, "{north_mas}");
    }

    #[test]
    fn an_approaching_star_moves_ever_faster() {
        // Perspective acceleration: μ̇ = −2 μ v_r π / (1 au/yr) (van de Kamp 1967), 1.25 mas/yr² for
        // Barnard's star.
        let mut barnard = star();
        barnard.parallax_mas = 548.31;
        barnard.pm_dec_mas_per_yr = 10_358.0;
        let at = |rv: f64, utc: &str| {
            let star = CatalogStar { radial_velocity_km_s: rv, ..barnard };
            observer(utc).astrometric(&StarMotion::new(&star))
        };
        let utc = "2041-04-02T00:00:00Z";
        let ahead_mas = at(-110.5, utc).separation(&at(0.0, utc)).arcsec() * 1e3;
        let acceleration = 2.0 * 10_358.0 * 110.5 / 4.740_470_5 * 548.31 * RADIANS_PER_MAS / 1.0;
        // Half the acceleration times 50 years squared: 1600 mas; cubic terms are 50 yr × 6e-5/yr of that.
        assert!((ahead_mas / (0.5 * acceleration * 2_500.0) - 1.0).abs() < 0.02, "{ahead_mas} mas");
    }

    #[test]
    fn parallax_swings_a_star_towards_the_sun() {
        let mut near = star();
        near.parallax_mas = 1_000.0;
        let observer = observer("2012-04-25T12:00:00Z");
        let far = observer.astrometric(&StarMotion::new(&star()));
        let seen = observer.astrometric(&StarMotion::new(&near));
        let angle = far.separation(&observer.sun()).radians();
        // sin θ arcsec at 1 au; the Sun is up to 0.01 au from the barycentre, and the Earth's distance
        // differs from 1 au by up to 1.7 %.
        assert!((seen.separation(&far).arcsec() / libm::sin(angle) - 1.0).abs() < 0.03);
        assert!(seen.separation(&observer.sun()).radians() < angle);
        near.parallax_mas = -1_000.0;
        assert_eq!(observer.astrometric(&StarMotion::new(&near)), far);
    }

    #[test]
    fn an_observer_outside_the_ephemeris_is_refused_with_the_time_named() {
        for utc in ["1989-12-31T00:00:00Z", "2050-01-06T00:00:00Z"] {
            let error = Observer::new(clock::parse_utc(utc).unwrap(), Vector3::zeros(), Vector3::zeros())
                .unwrap_err();
            assert!(error.to_string().contains("from 1990-01-01 to 2050-01-05"), "{error}");
        }
        let time = clock::parse_utc("2012-04-25T00:00:00Z").unwrap();
        assert!(Observer::new(time, Vector3::x() * f64::NAN, Vector3::zeros()).is_err());
        assert!(Observer::new(time, Vector3::x() * 2e8, Vector3::zeros()).is_err());
        assert!(Observer::new(time, Vector3::zeros(), Vector3::x() * 3e5).is_err());
    }

    proptest! {
        #[test]
        fn unaberration_undoes_aberration(
            u in prop::array::uniform3(-1.0..1.0_f64),
            b in prop::array::uniform3(-0.5..0.5_f64),
        ) {
            prop_assume!(Vector3::from(u).norm() > 1e-3);
            let star = Direction::from_vector(Vector3::from(u)).unwrap();
            let beta = Vector3::from(b);
            let back = unaberrate(aberrate(star, &beta), &beta);
            // Rounding, amplified by the Doppler factor, up to 5 at |β| = 0.87.
            prop_assert!((back.vector() - star.vector()).norm() < 1e-14);
        }
    }
}
