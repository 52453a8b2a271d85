//! The embedded Hipparcos-2 (van Leeuwen 2007, A&A 474, 653; CDS I/311).
//!
//! `sim/data/make_hipparcos2.py` generates the bytes and describes their format; every printed digit of
//! hip2.dat is kept.

use super::hex::hex;
use super::{CatalogStar, radial_velocity};

/// The embedded catalogue: a header of 48 bytes and 29 bytes for each of 117,955 stars, little-endian, as
/// `sim/data/make_hipparcos2.py` describes.
pub static HIPPARCOS_BYTES: &[u8] = include_bytes!("../../../data/hipparcos2.bin");

const HEADER: usize = 48;
const SHA256: std::ops::Range<usize> = 16..48;
const RECORD: usize = 29;
/// Marker of a colour that the catalogue lacks.
const UNKNOWN: i64 = -32768;

/// SHA-256 of hip2.dat, in hexadecimal.
pub(super) fn sha256() -> String {
    hex(&HIPPARCOS_BYTES[SHA256])
}

/// All stars, in ascending order of HIP. The bytes are part of this crate, and a test reads every one of
/// them.
pub(super) fn stars() -> Vec<CatalogStar> {
    let (records, _) = HIPPARCOS_BYTES[HEADER..].as_chunks::<RECORD>();
    records.iter().map(star).collect()
}

fn star(record: &[u8; RECORD]) -> CatalogStar {
    let id = unsigned::<0, 3>(record) as u32;
    let colour = |value: i64| (value != UNKNOWN).then(|| scaled(value, 1e3));
    CatalogStar {
        id,
        ra_rad: scaled(unsigned::<3, 5>(record) as i64, 1e10),
        dec_rad: scaled(signed::<8, 5>(record), 1e10),
        parallax_mas: scaled(signed::<13, 3>(record), 1e2),
        pm_ra_mas_per_yr: scaled(signed::<16, 3>(record), 1e2),
        pm_dec_mas_per_yr: scaled(signed::<19, 3>(record), 1e2),
        radial_velocity_km_s: radial_velocity::radial_velocity_km_s(id).unwrap_or(0.0),
        hp_mag: scaled(signed::<22, 3>(record), 1e4),
        b_v: colour(signed::<25, 2>(record)),
        v_i: colour(signed::<27, 2>(record)),
    }
}

/// Returns the number whose printed digits are `integer`: a division by a power of ten is correctly rounded,
/// so the result equals the float that a parser of the text would return.
fn scaled(integer: i64, power_of_ten: f64) -> f64 {
    integer as f64 / power_of_ten
}

fn unsigned<const START: usize, const SIZE: usize>(record: &[u8; RECORD]) -> u64 {
    let mut bytes = [0; 8];
    bytes[..SIZE].copy_from_slice(&record[START..START + SIZE]);
    u64::from_le_bytes(bytes)
}

fn signed<const START: usize, const SIZE: usize>(record: &[u8; RECORD]) -> i64 {
    let unused = 64 - 8 * SIZE as u32;
    // Shifting up and down again extends the sign.
    (unsigned::<START, SIZE>(record) << unused) as i64 >> unused
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn the_header_agrees_with_the_decoder() {
        assert_eq!(&HIPPARCOS_BYTES[..8], b"BSHIP2\0\0");
        assert_eq!(HIPPARCOS_BYTES[8..12], 1_u32.to_le_bytes());
        assert_eq!(HIPPARCOS_BYTES[12..16], 117_955_u32.to_le_bytes());
        assert_eq!(HIPPARCOS_BYTES.len(), HEADER + 117_955 * RECORD);
        assert_eq!(sha256(), "c45d6325bd59dd691764af173a9702e543804a2b6c1d9fea59210e8332e50a4a");
    }

    #[test]
    fn every_star_is_within_the_bounds_of_the_catalogue() {
        let stars = stars();
        assert_eq!(stars.len(), 117_955);
        assert!(stars.windows(2).all(|pair| pair[0].id < pair[1].id));
        for star in &stars {
            assert!((1..=120_404).contains(&star.id));
            assert!((0.0..TAU).contains(&star.ra_rad), "{star:?}");
            assert!(star.dec_rad.abs() < TAU / 4.0, "{star:?}");
            assert!((-300.0..800.0).contains(&star.parallax_mas), "{star:?}");
            assert!(star.pm_ra_mas_per_yr.abs() < 7000.0, "{star:?}");
            assert!(star.pm_dec_mas_per_yr.abs() < 11_000.0, "{star:?}");
            assert!((-1.1..14.6).contains(&star.hp_mag), "{star:?}");
            assert!(star.b_v.is_none_or(|colour| (-0.5..5.5).contains(&colour)), "{star:?}");
            assert!(star.v_i.is_none_or(|colour| (-0.5..9.1).contains(&colour)), "{star:?}");
        }
    }

    /// Checks sums over the whole catalogue, computed from hip2.dat with Python's exact integers: a single
    /// wrong digit makes it fail.
    #[test]
    fn the_sums_over_all_stars_are_those_of_the_text() {
        let stars = stars();
        let sum = |digits: fn(&CatalogStar) -> f64| -> i64 {
            stars.iter().map(|star| digits(star).round() as i64).sum()
        };
        assert_eq!(sum(|star| star.ra_rad * 1e10), 3_735_854_018_218_210);
        assert_eq!(sum(|star| star.dec_rad * 1e10), -44_123_159_590_256);
        assert_eq!(sum(|star| star.parallax_mas * 1e2), 85_054_632);
        assert_eq!(sum(|star| star.pm_ra_mas_per_yr * 1e2), -15_679_473);
        assert_eq!(sum(|star| star.pm_dec_mas_per_yr * 1e2), -195_962_091);
        assert_eq!(sum(|star| star.hp_mag * 1e4), 9_994_236_344);
        assert_eq!(sum(|star| star.b_v.unwrap_or(0.0) * 1e3), 82_488_117);
        assert_eq!(sum(|star| star.v_i.unwrap_or(0.0) * 1e3), 89_051_190);
        assert_eq!(stars.iter().filter(|star| star.b_v.is_none()).count(), 1143);
    }

    /// Checks three lines of hip2.dat as printed.
    #[test]
    fn a_star_has_the_printed_numbers() {
        let stars = stars();
        let star = |id: u32| stars[stars.binary_search_by_key(&id, |star| star.id).unwrap()];
        let numbers = |star: CatalogStar| {
            [
                star.ra_rad,
                star.dec_rad,
                star.parallax_mas,
                star.pm_ra_mas_per_yr,
                star.pm_dec_mas_per_yr,
                star.hp_mag,
            ]
        };
        assert_eq!(numbers(star(1)), [0.0000159148, 0.0190068680, 4.55, -4.55, -1.19, 9.2043]);
        assert_eq!((star(1).b_v, star(1).v_i), (Some(0.482), Some(0.550)));
        assert_eq!(numbers(star(2)), [0.0000662767, -0.3403189126, 20.85, 182.88, -1.31, 9.4017]);
        assert_eq!(numbers(star(87937)), [4.7028598776, 0.0814769927, 548.31, -798.58, 10328.12, 9.4901]);
        assert_eq!((star(45).b_v, star(45).v_i), (None, None));
    }
}
