//! The planets: their positions and magnitudes.
//!
//! Positions are from Keplerian elements that drift linearly: Standish & Williams, Keplerian Elements for
//! Approximate Positions of the Major Planets (JPL, Table 1, 1800 to 2050). Compared with DE421, the
//! direction from the Earth has errors of up to 0.3′ (Mercury, Venus), 1.5′ (Mars), 7.4′ (Jupiter), 10.4′
//! (Saturn), 1.9′ (Uranus) and 1′ (Neptune); see `golden/planets`. Image and truth share the error: each
//! planet is drawn at its position in the truth.
//!
//! Magnitudes are from Mallama & Hilton 2018, Astron. Comput. 25, 10 (used in the Astronomical Almanac),
//! without the terms of rotation (Mars, 0.1 mag) and of the latitude of Uranus (0.07 mag); Saturn includes
//! its rings.

use contract::{Direction, Icrs};
use nalgebra::Vector3;

use super::apparent::Observer;
use super::kepler::eccentric_anomaly;
use crate::constants::{AU_KM, LIGHT_SPEED_KM_S};

/// Light time of one astronomical unit, s.
const AU_LIGHT_S: f64 = AU_KM / LIGHT_SPEED_KM_S;
/// Julian century, s.
const CENTURY_S: f64 = 36_525.0 * 86_400.0;
/// Obliquity of the ecliptic at J2000.0 for these elements, degrees.
const OBLIQUITY_DEG: f64 = 23.43928;
/// Saturn's north pole at J2000.0, the normal of the ring plane: right ascension and declination, degrees
/// (IAU Working Group on Cartographic Coordinates 2015).
const SATURN_POLE_DEG: (f64, f64) = (40.589, 83.537);

/// Planet other than the Earth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Planet {
    /// Number 1.
    Mercury,
    /// Number 2.
    Venus,
    /// Number 4.
    Mars,
    /// Number 5.
    Jupiter,
    /// Number 6.
    Saturn,
    /// Number 7.
    Uranus,
    /// Number 8.
    Neptune,
}

/// Direction, distance and magnitude of a planet for an observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApparentPlanet {
    /// Astrometric direction: light time applied, no aberration, no deflection.
    pub astrometric: Direction<Icrs>,
    /// Distance from the observer, au.
    pub distance_au: f64,
    /// Visual magnitude.
    pub magnitude: f64,
}

/// Elements at J2000.0 and their change per Julian century: a (au), e, I, L, ϖ, Ω (degrees).
type Elements = [[f64; 6]; 2];

impl Planet {
    /// All planets except the Earth, from the Sun outwards.
    pub const ALL: [Self; 7] =
        [Self::Mercury, Self::Venus, Self::Mars, Self::Jupiter, Self::Saturn, Self::Uranus, Self::Neptune];

    /// Number of the planet, counted from the Sun outwards with the Earth as 3: 1 to 8.
    pub fn number(self) -> u32 {
        match self {
            Self::Mercury => 1,
            Self::Venus => 2,
            Self::Mars => 4,
            Self::Jupiter => 5,
            Self::Saturn => 6,
            Self::Uranus => 7,
            Self::Neptune => 8,
        }
    }

    /// Colour index B−V of the planet (Cox 2000, Allen's Astrophysical Quantities, Table 12.6, as in the
    /// Astronomical Almanac).
    pub fn b_v(self) -> f64 {
        match self {
            Self::Mercury => 0.93,
            Self::Venus => 0.82,
            Self::Mars => 1.36,
            Self::Jupiter => 0.83,
            Self::Saturn => 1.04,
            Self::Uranus => 0.56,
            Self::Neptune => 0.41,
        }
    }

    /// Returns the planet as seen by the observer, at `tdb_j2000_s` seconds of TDB since J2000.0; `None` for
    /// an observer at the planet's centre.
    pub fn apparent(self, tdb_j2000_s: f64, observer: &Observer) -> Option<ApparentPlanet> {
        // The Sun moves by 13 m/s during the light time, which is negligible at this accuracy.
        let sun_au = observer.sun_km() / AU_KM;
        let mut light_s = 0.0;
        let mut heliocentric = Vector3::zeros();
        let mut from_observer = Vector3::zeros();
        // A planet moves by 48 km/s at most: a third step changes the distance by a relative 1e-12.
        for _ in 0..3 {
            heliocentric = self.heliocentric_au(tdb_j2000_s - light_s);
            from_observer = sun_au + heliocentric;
            light_s = from_observer.norm() * AU_LIGHT_S;
        }
        Some(ApparentPlanet {
            astrometric: Direction::from_vector(from_observer).ok()?,
            distance_au: from_observer.norm(),
            magnitude: self.magnitude(&heliocentric, &from_observer, tdb_j2000_s),
        })
    }

    /// Position relative to the Sun, au, ICRS axes.
    fn heliocentric_au(self, tdb_j2000_s: f64) -> Vector3<f64> {
        let centuries = tdb_j2000_s / CENTURY_S;
        let [at_epoch, rates] = self.elements();
        let element = |i: usize| at_epoch[i] + rates[i] * centuries;
        let (axis, eccentricity) = (element(0), element(1));
        let [inclination, longitude, perihelion, node] = [2, 3, 4, 5].map(|i| element(i).to_radians());
        let anomaly = eccentric_anomaly(longitude - perihelion, eccentricity);
        let (sin_e, cos_e) = libm::sincos(anomaly);
        let x = axis * (cos_e - eccentricity);
        let y = axis * (1.0 - eccentricity * eccentricity).sqrt() * sin_e;
        // Rotation from the orbital plane, with x towards the perihelion, to the ecliptic and then to the
        // equator.
        let (sin_w, cos_w) = libm::sincos(perihelion - node);
        let (sin_n, cos_n) = libm::sincos(node);
        let (sin_i, cos_i) = libm::sincos(inclination);
        let (along, across) = (cos_w * x - sin_w * y, sin_w * x + cos_w * y);
        let (ecliptic_x, ecliptic_y, ecliptic_z) =
            (cos_n * along - sin_n * cos_i * across, sin_n * along + cos_n * cos_i * across, sin_i * across);
        let (sin_o, cos_o) = libm::sincos(OBLIQUITY_DEG.to_radians());
        Vector3::new(
            ecliptic_x,
            cos_o * ecliptic_y - sin_o * ecliptic_z,
            sin_o * ecliptic_y + cos_o * ecliptic_z,
        )
    }

    /// V magnitude for the position relative to the Sun and relative to the observer, au.
    fn magnitude(self, from_sun: &Vector3<f64>, from_observer: &Vector3<f64>, tdb_j2000_s: f64) -> f64 {
        let (sun_au, observer_au) = (from_sun.norm(), from_observer.norm());
        let phase_rad = libm::atan2(from_sun.cross(from_observer).norm(), from_sun.dot(from_observer));
        let a = phase_rad.to_degrees();
        let own = match self {
            Self::Mercury => {
                let terms = [-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12];
                polynomial(&terms, a)
            }
            Self::Venus if a < 163.7 => polynomial(&[-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9], a),
            Self::Venus => polynomial(&[236.05828, -2.81914, 8.39034e-3], a),
            Self::Mars if a <= 50.0 => polynomial(&[-1.601, 2.267e-2, -1.302e-4], a),
            Self::Mars => polynomial(&[-0.367, -2.573e-2, 3.445e-4], a),
            Self::Jupiter if a <= 12.0 => polynomial(&[-9.395, -3.7e-4, 6.16e-4], a),
            Self::Jupiter => {
                let share = polynomial(&[1.0, -1.507, -0.363, -0.062, 2.809, -1.876], a / 180.0);
                -9.428 - 2.5 * libm::log10(share)
            }
            Self::Saturn => {
                // Opening of the rings: geometric mean of the latitudes of Sun and observer; zero if they are
                // on opposite sides.
                let (ra, dec) = SATURN_POLE_DEG;
                let (sin_ra, cos_ra) = libm::sincos(ra.to_radians());
                let (sin_dec, cos_dec) = libm::sincos(dec.to_radians());
                let pole = Vector3::new(cos_ra * cos_dec, sin_ra * cos_dec, sin_dec);
                let latitude = |to: &Vector3<f64>| libm::asin(-pole.dot(&to.normalize()));
                let opening = libm::sin((latitude(from_sun) * latitude(from_observer)).max(0.0).sqrt());
                -8.914 - 1.825 * opening + 0.026 * a - 0.378 * opening * libm::exp(-2.25 * a)
            }
            Self::Uranus => polynomial(&[-7.110, 6.587e-3, 1.045e-4], if a > 3.1 { a } else { 0.0 }),
            Self::Neptune => {
                // Neptune brightened from 1980 to 2000.
                let year = 2000.0 + tdb_j2000_s / CENTURY_S * 100.0;
                (-6.89 - 0.0054 * (year - 1980.0)).clamp(-7.00, -6.89)
            }
        };
        own + 5.0 * libm::log10(sun_au * observer_au)
    }

    /// Elements from Standish & Williams, Table 1.
    #[rustfmt::skip]
    fn elements(self) -> Elements {
        match self {
            Self::Mercury => [
                [0.38709927, 0.20563593, 7.00497902, 252.25032350, 77.45779628, 48.33076593],
                [0.00000037, 0.00001906, -0.00594749, 149472.67411175, 0.16047689, -0.12534081],
            ],
            Self::Venus => [
                [0.72333566, 0.00677672, 3.39467605, 181.97909950, 131.60246718, 76.67984255],
                [0.00000390, -0.00004107, -0.00078890, 58517.81538729, 0.00268329, -0.27769418],
            ],
            Self::Mars => [
                [1.52371034, 0.09339410, 1.84969142, -4.55343205, -23.94362959, 49.55953891],
                [0.00001847, 0.00007882, -0.00813131, 19140.30268499, 0.44441088, -0.29257343],
            ],
            Self::Jupiter => [
                [5.20288700, 0.04838624, 1.30439695, 34.39644051, 14.72847983, 100.47390909],
                [-0.00011607, -0.00013253, -0.00183714, 3034.74612775, 0.21252668, 0.20469106],
            ],
            Self::Saturn => [
                [9.53667594, 0.05386179, 2.48599187, 49.95424423, 92.59887831, 113.66242448],
                [-0.00125060, -0.00050991, 0.00193609, 1222.49362201, -0.41897216, -0.28867794],
            ],
            Self::Uranus => [
                [19.18916464, 0.04725744, 0.77263783, 313.23810451, 170.95427630, 74.01692503],
                [-0.00196176, -0.00004397, -0.00242939, 428.48202785, 0.40805281, 0.04240589],
            ],
            Self::Neptune => [
                [30.06992276, 0.00859048, 1.77004347, -55.12002969, 44.96476227, 131.78422574],
                [0.00026291, 0.00005105, 0.00035372, 218.45945325, -0.32241464, -0.00508664],
            ],
        }
    }
}

/// Evaluates a polynomial by Horner's rule, the constant term first.
fn polynomial(terms: &[f64], x: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| sum * x + term)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock;

    /// Magnitude for distances from Sun and observer, au, and a phase angle, degrees.
    fn magnitude_at(planet: Planet, sun_au: f64, observer_au: f64, phase_deg: f64) -> f64 {
        let (sin, cos) = libm::sincos(phase_deg.to_radians());
        planet.magnitude(&(Vector3::x() * sun_au), &(Vector3::new(cos, sin, 0.0) * observer_au), 3e8)
    }

    /// Worked examples that Mallama & Hilton supply with their program.
    #[test]
    fn magnitudes_are_those_of_the_published_examples() {
        for (planet, sun_au, observer_au, phase_deg, expected) in [
            (Planet::Mercury, 0.310295423552, 1.32182643625754, 1.1677, -2.477),
            (Planet::Mercury, 0.413629222334, 0.92644808718613, 90.1662, 0.181),
            (Planet::Mercury, 0.448947624811, 0.56004973217883, 178.7284, 7.167),
            (Planet::Venus, 0.722722540169, 1.71607489554051, 1.3232, -3.917),
            (Planet::Venus, 0.721480714554, 0.37762511206278, 124.1348, -4.916),
            (Planet::Venus, 0.726166592736, 0.28889582420642, 179.1845, -3.090),
            (Planet::Jupiter, 5.446231815414, 6.44985867459088, 0.2446, -1.667),
            (Planet::Jupiter, 4.957681473205, 3.95393078136013, 0.3431, -2.934),
            (Planet::Jupiter, 5.227587855371, 5.23501920009381, 147.0989, 0.790),
        ] {
            let got = magnitude_at(planet, sun_au, observer_au, phase_deg);
            assert!((got - expected).abs() < 6e-4, "{planet:?}: {got}, expected {expected}");
        }
    }

    /// Formulae of Mallama & Hilton with positions of DE421, 2021-10-04 0 h TT, from the geocentre.
    #[test]
    fn every_planet_has_its_magnitude_of_a_known_day() {
        let time = clock::parse_utc("2021-10-03T23:58:50.816Z").unwrap();
        let observer = Observer::new(time, Vector3::zeros(), Vector3::zeros()).unwrap();
        let expected = [2.393, -4.278, 1.592, -2.693, 0.508, 5.701, 7.690];
        for (planet, expected) in Planet::ALL.into_iter().zip(expected) {
            let got = planet.apparent(clock::tdb_j2000_s(time), &observer).unwrap().magnitude;
            // The reference uses the barycentre in place of the Sun: 0.5° in the phase of Venus and Mercury.
            // Terms omitted here: Uranus 0.05, Mars 0.1.
            let tolerance = 0.1;
            assert!((got - expected).abs() < tolerance, "{planet:?}: {got}, expected {expected}");
        }
    }

    #[test]
    fn the_curve_of_venus_has_no_step_where_its_two_pieces_meet() {
        let (before, after) =
            (magnitude_at(Planet::Venus, 0.72, 0.3, 163.69), magnitude_at(Planet::Venus, 0.72, 0.3, 163.71));
        // The two published pieces agree to 0.02 mag at the junction.
        assert!((before - after).abs() < 0.02, "{before} {after}");
    }
}
