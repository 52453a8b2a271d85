//! Time scales, Earth and Sun, and apparent positions, compared with ERFA, astropy and JPL DE421:
//! golden/README.md.

use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use boresight_truth::catalog::CatalogStar;
use boresight_truth::{Observer, StarMotion, clock, ephemeris};
use nalgebra::Vector3;

const MAS_PER_RADIAN: f64 = 180.0 * 3_600.0 * 1_000.0 / std::f64::consts::PI;

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../golden/apparent").join(name)
}

fn read(name: &str) -> Vec<u8> {
    fs::read(golden(name)).unwrap_or_else(|error| panic!("the reference {name} is missing: {error}"))
}

fn rows<T: FromStr>(name: &str) -> Vec<Vec<T>>
where
    T::Err: std::fmt::Debug,
{
    let text = String::from_utf8(read(name)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// Content of apparent.bin, whose layout is documented in golden/apparent/make.py.
struct Apparent {
    observers: Vec<Observer>,
    stars: Vec<CatalogStar>,
    /// Unit vectors, indexed by epoch, then by star.
    places: Vec<Vec<Vector3<f64>>>,
}

impl Apparent {
    fn read() -> Self {
        let bytes = read("apparent.bin");
        assert_eq!(&bytes[..8], b"APPARENT");
        let count = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (stars, epochs) = (count(8), count(12));
        let words: Vec<f64> =
            bytes[16..].chunks_exact(8).map(|word| f64::from_le_bytes(word.try_into().unwrap())).collect();
        assert_eq!(words.len(), 7 * epochs + 7 * stars + 2 * stars * epochs);
        let (observers, rest) = words.split_at(7 * epochs);
        let (stars_at, places) = rest.split_at(7 * stars);
        Self {
            observers: observers
                .chunks_exact(7)
                .map(|w| {
                    let (position, velocity) =
                        (Vector3::new(w[1], w[2], w[3]), Vector3::new(w[4], w[5], w[6]));
                    Observer::new(clock::from_tt_j2000_s(w[0]), position, velocity).unwrap()
                })
                .collect(),
            stars: stars_at.chunks_exact(7).map(star).collect(),
            places: places
                .chunks_exact(2 * stars)
                .map(|epoch| epoch.chunks_exact(2).map(|p| unit(p[0], p[1])).collect())
                .collect(),
        }
    }
}

fn star(words: &[f64]) -> CatalogStar {
    CatalogStar {
        id: words[0] as u32,
        ra_rad: words[1],
        dec_rad: words[2],
        parallax_mas: words[3],
        pm_ra_mas_per_yr: words[4],
        pm_dec_mas_per_yr: words[5],
        radial_velocity_km_s: words[6],
        hp_mag: 8.0,
        b_v: None,
        v_i: None,
    }
}

fn unit(ra_rad: f64, dec_rad: f64) -> Vector3<f64> {
    let ((sin_ra, cos_ra), (sin_dec, cos_dec)) = (libm::sincos(ra_rad), libm::sincos(dec_rad));
    Vector3::new(cos_ra * cos_dec, sin_ra * cos_dec, sin_dec)
}

/// Collects differences, and reports the largest.
#[derive(Default)]
struct Worst {
    seen: usize,
    value: f64,
    place: String,
}

impl Worst {
    fn see(&mut self, value: f64, place: impl Fn() -> String) {
        self.seen += 1;
        // Negated, to make NaN the largest of all.
        if !value.le(&self.value) {
            (self.value, self.place) = (value, place());
        }
    }

    fn check(&self, what: &str, limit: f64) {
        println!("{what}: largest of {} differences {:.3e} at {}", self.seen, self.value, self.place);
        assert!(self.seen > 0, "{what}: nothing was compared");
        assert!(self.value <= limit, "{what}: {:.3e} at {}, allowed {limit:.1e}", self.value, self.place);
    }
}

#[test]
fn apparent_positions_are_those_of_erfa() {
    let golden = Apparent::read();
    assert_eq!((golden.stars.len(), golden.observers.len()), (2_000, 4));
    let mut worst = Worst::default();
    for (epoch, (observer, places)) in golden.observers.iter().zip(&golden.places).enumerate() {
        for (star, expected) in golden.stars.iter().zip(places) {
            let seen = observer.apparent(&StarMotion::new(star));
            let difference_mas = (seen.vector() - expected).norm() * MAS_PER_RADIAN;
            worst.see(difference_mas, || format!("HIP {}, epoch {epoch}", star.id));
        }
    }
    // The simulator's Earth is within 3 mm/s of ERFA's (2 µas), its TDB within 10 µs; a user needs 1 mas.
    worst.check("apparent place, mas", 0.01);
}

#[test]
fn the_golden_stars_hold_the_hard_cases() {
    let golden = Apparent::read();
    let barnard = golden.stars.iter().find(|star| star.id == 87_937).expect("Barnard's star");
    assert_eq!(barnard.radial_velocity_km_s, -110.5);
    for hip in [70_890, 71_681, 71_683] {
        assert!(golden.stars.iter().any(|star| star.id == hip && star.parallax_mas > 700.0), "HIP {hip}");
    }
    assert!(golden.stars.iter().any(|star| star.dec_rad.to_degrees() > 89.0));
    assert!(golden.stars.iter().any(|star| star.dec_rad.to_degrees() < -89.0));
    assert!(golden.stars.iter().any(|star| star.parallax_mas < 0.0));
    for (epoch, observer) in golden.observers.iter().enumerate() {
        let near_sun = |limit_arcmin: f64| {
            golden
                .stars
                .iter()
                .filter(|star| star.direction().separation(&observer.sun()).arcsec() < limit_arcmin * 60.0)
                .count()
        };
        // Stars inside the limit of the deflection (4.9′), and stars around the Sun.
        assert!(near_sun(4.5) >= 1 && near_sun(180.0) >= 20, "epoch {epoch}");
    }
}

#[test]
fn straight_motion_agrees_with_relativistic_space_motion() {
    let golden = Apparent::read();
    let mut worst = Worst::default();
    for row in rows::<f64>("space_motion.csv") {
        let [epoch, hip, ra_deg, dec_deg] = row[..] else { panic!("a row of {} cells", row.len()) };
        let star = golden.stars.iter().find(|star| f64::from(star.id) == hip).unwrap();
        let seen = golden.observers[epoch as usize].apparent(&StarMotion::new(star));
        let difference = (seen.vector() - unit(ra_deg.to_radians(), dec_deg.to_radians())).norm();
        worst.see(difference * MAS_PER_RADIAN, || format!("HIP {hip}, epoch {epoch}"));
    }
    // Relativistic terms of the star's motion, which the simulator omits: 0.20 mas for Kapteyn's star (245
    // km/s, 8.6″ per year) after 54 years.
    worst.check("place by space motion, mas", 0.3);
}

fn check_earth(name: &str, position_km: f64, velocity_km_s: f64, sun_km: f64, sun_direction_arcsec: f64) {
    let [mut position, mut velocity, mut sun, mut direction] = std::array::from_fn(|_| Worst::default());
    let states = rows::<f64>(name);
    assert_eq!(states.len(), 200);
    for row in states {
        let vector = |at: usize| Vector3::new(row[at], row[at + 1], row[at + 2]);
        let state = ephemeris::earth(row[0]).unwrap();
        let place = || format!("TDB {} s", row[0]);
        position.see((state.position_km - vector(1)).norm(), place);
        velocity.see((state.velocity_km_s - vector(4)).norm(), place);
        sun.see((state.sun_position_km - vector(7)).norm(), place);
        let expected = (vector(7) - vector(1)).normalize();
        let seen = state.sun_geocentric_km().normalize();
        direction.see((seen - expected).norm() * MAS_PER_RADIAN / 1e3, place);
    }
    position.check(&format!("{name}: Earth, km"), position_km);
    velocity.check(&format!("{name}: velocity of the Earth, km/s"), velocity_km_s);
    sun.check(&format!("{name}: Sun, km"), sun_km);
    direction.check(&format!("{name}: direction of the Sun, arcsec"), sun_direction_arcsec);
}

#[test]
fn earth_and_sun_are_those_of_epv00() {
    // Residuals of the polynomials (printed by sim/data/make_earth.py). 0.4 km at 1 au are 0.0006″.
    check_earth("earth_erfa.csv", 0.3, 4e-6, 0.1, 0.001);
}

#[test]
fn earth_and_sun_are_those_of_a_numerical_integration() {
    // epv00 is within 13.4 km and 4.9 mm/s of DE405, which differs by some km from DE421; the velocity also
    // has the simulator's error of 3 mm/s. 8e-6 km/s are 6 µas of aberration; 20 km at 1 au are 0.03″.
    check_earth("earth_de421.csv", 20.0, 8e-6, 20.0, 0.03);
}

#[test]
fn time_scales_are_those_of_astropy() {
    let [mut tt, mut gps, mut tdb] = std::array::from_fn(|_| Worst::default());
    let rows = rows::<String>("time.csv");
    assert!(
        rows.iter().filter(|row| row[0].contains(":60")).count() >= 6,
        "leap seconds are among the times"
    );
    for row in rows {
        let time = clock::parse_utc(&row[0]).unwrap();
        let tt_ns: i64 = row[1].parse().unwrap();
        let [gps_s, tdb_minus_tt_s]: [f64; 2] = [2, 3].map(|cell: usize| row[cell].parse().unwrap());
        let since_j2000_ns =
            time.to_tai_duration().total_nanoseconds() + 32_184_000_000 - 3_155_716_800_000_000_000;
        tt.see((since_j2000_ns - i128::from(tt_ns)).abs() as f64, || row[0].clone());
        gps.see((clock::gps_s(time) - gps_s).abs(), || row[0].clone());
        tdb.see((clock::tdb_minus_tt_s(clock::tt_j2000_s(time)) - tdb_minus_tt_s).abs(), || row[0].clone());
    }
    // astropy represents a time to well below a nanosecond: only rounding remains.
    tt.check("TT, ns", 1.0);
    // The file has six decimals.
    gps.check("GPS time, s", 1e-6);
    // Seven terms are accurate to 10 µs (USNO Circular 179).
    tdb.check("TDB - TT, s", 1.5e-5);
}
