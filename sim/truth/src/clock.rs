//! Time scales: UTC as input and output, TT and TDB as numbers.
//!
//! Instants are hifitime's `Epoch`. This module works around three properties of hifitime: its UTC text reads
//! second 60 as second 59 (its issue 417); its conversion from TAI to UTC steps at a leap second too early,
//! by TAI − UTC; its TDB uses the platform's sine. Here UTC is read and written by the rule itself (only the
//! table of leap seconds is hifitime's), and TDB uses `libm`.
//!
//! Every `Epoch` created here is in TAI, so adding a duration to it adds SI seconds, also across a leap
//! second; hifitime adds to an epoch in UTC without counting leap seconds.

use contract::OutOfRange;
use hifitime::leap_seconds::{LatestLeapSeconds, LeapSecond};
use hifitime::{Duration, Epoch, TimeScale};

const NS_PER_S: i128 = 1_000_000_000;
/// TT − TAI, ns, by definition.
const TT_MINUS_TAI_NS: i128 = 32_184_000_000;
/// J2000.0 (2000-01-01 12:00) as a count from 1900-01-01 00:00 in the same scale, ns.
const J2000_NS: i128 = 3_155_716_800 * NS_PER_S;
/// Origin of POSIX time (1970-01-01 00:00) as a count from 1900-01-01 00:00 in the same scale, ns.
const UNIX_ORIGIN_NS: i128 = 2_208_988_800 * NS_PER_S;
/// Origin of GPS time (1980-01-06 00:00 UTC) as a count of TAI from 1900-01-01 00:00 TAI, ns.
const GPS_ORIGIN_TAI_NS: i128 = 2_524_953_619 * NS_PER_S;
/// Seconds in a Julian century.
const CENTURY_S: f64 = 36_525.0 * 86_400.0;

/// Parses a UTC instant in ISO 8601: `2012-04-25T12:18:54.5Z`, to the nanosecond.
///
/// The scale must be given: `Z` or ` UTC` at the end; the separator is `T` or a space. Second 60 is accepted
/// where a leap second was inserted, and rejected elsewhere. No leap second is assumed after the last known
/// one (2016-12-31).
///
/// # Errors
/// [`OutOfRange`] if the text has another form, the date does not exist, or the year is before 1972 (when TAI
/// − UTC was not an integer number of seconds) or after 2261 (the last year that timestamps in nanoseconds
/// reach).
pub fn parse_utc(text: &str) -> Result<Epoch, OutOfRange> {
    let refuse = |expected| OutOfRange::new("time", text, expected);
    let civil = Civil::parse(text)
        .ok_or_else(|| refuse("a UTC time such as 2012-04-25T12:18:54.5Z, from 1972 to 2261"))?;
    let label_ns = civil.label_ns().ok_or_else(|| refuse("an existing date and time"))?;
    if civil.second < 60 {
        return Ok(epoch_of_tai(label_ns + tai_minus_utc_ns(label_ns)));
    }
    // Second 60 continues from 59: its label is that of the following second, and its TAI is one second less.
    let inserted_before = label_ns - i128::from(civil.nanosecond);
    if leap_seconds().any(|leap| leap_label_ns(&leap) == inserted_before) {
        Ok(epoch_of_tai(label_ns + tai_minus_utc_ns(label_ns) - NS_PER_S))
    } else {
        Err(refuse("second 60 only at an inserted leap second"))
    }
}

/// Parses a time as [`parse_utc`] does, with errors that name `path`, the path in the scenario.
///
/// # Errors
/// See [`parse_utc`].
pub fn parse_utc_field(path: &str, text: &str) -> Result<Epoch, OutOfRange> {
    parse_utc(text).map_err(|error| OutOfRange { path: path.to_owned(), ..error })
}

/// Formats an instant as UTC in ISO 8601 with nine decimals and `Z`; inside a leap second the second is 60.
///
/// Before 1972, when UTC was defined differently, the text is TAI − 10 s.
pub fn format_utc(time: Epoch) -> String {
    let tai_ns = tai_ns(time);
    let (offset_ns, inside_leap) = utc_at(tai_ns);
    let label_ns = tai_ns - offset_ns - if inside_leap { NS_PER_S } else { 0 };
    // Input and output have the same scale: hifitime computes only the calendar date.
    let label = Epoch::from_utc_duration(Duration::from_total_nanoseconds(label_ns));
    let (year, month, day, hour, minute, second, nanosecond) = label.to_gregorian_utc();
    let second = second + u8::from(inside_leap);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{nanosecond:09}Z")
}

/// Nanoseconds of UTC since 1970-01-01 in days of 86,400 s: the time of POSIX, and of timestamps in Parquet.
/// Instants inside a leap second have no separate number; they have the number of the end of the leap second,
/// so that time does not step back.
///
/// Before 1972 see [`format_utc`]; saturates before 1677 and after 2262.
pub fn unix_ns(time: Epoch) -> i64 {
    let tai_ns = tai_ns(time);
    let (offset_ns, inside_leap) = utc_at(tai_ns);
    let unix_ns = tai_ns - offset_ns - UNIX_ORIGIN_NS;
    let unix_ns = if inside_leap { unix_ns - unix_ns.rem_euclid(NS_PER_S) } else { unix_ns };
    unix_ns.clamp(i64::MIN.into(), i64::MAX.into()) as i64
}

/// Returns the instant of a [`unix_ns`] number.
pub fn from_unix_ns(unix_ns: i64) -> Epoch {
    let label_ns = i128::from(unix_ns) + UNIX_ORIGIN_NS;
    epoch_of_tai(label_ns + tai_minus_utc_ns(label_ns))
}

/// Julian date in UTC, days; constant inside a leap second, like [`unix_ns`].
pub(super) fn jd_utc(time: Epoch) -> f64 {
    // Input and output have the same scale.
    let label_ns = i128::from(unix_ns(time)) + UNIX_ORIGIN_NS;
    Epoch::from_utc_duration(Duration::from_total_nanoseconds(label_ns)).to_jde_utc_days()
}

/// Returns [`unix_ns`] in integer milliseconds, rounded down: the time of JavaScript's dates.
pub fn unix_ms(time: Epoch) -> i64 {
    unix_ns(time).div_euclid(1_000_000)
}

/// TT since J2000.0, s (resolution of the number: 0.2 µs).
pub fn tt_j2000_s(time: Epoch) -> f64 {
    seconds(tai_ns(time) + TT_MINUS_TAI_NS - J2000_NS)
}

/// Returns the instant of a TT count since J2000.0, s, rounded to the nanosecond; saturates outside
/// hifitime's range.
pub fn from_tt_j2000_s(tt_j2000_s: f64) -> Epoch {
    epoch_of_tai(nanoseconds(tt_j2000_s) + J2000_NS - TT_MINUS_TAI_NS)
}

/// TDB since J2000.0, s, computed with [`tdb_minus_tt_s`].
pub fn tdb_j2000_s(time: Epoch) -> f64 {
    let tt = tt_j2000_s(time);
    tt + tdb_minus_tt_s(tt)
}

/// TDB − TT at the geocentre, s, at a TT since J2000.0 in s.
///
/// The seven largest terms of Fairhead & Bretagnon (1990) as given by Kaplan, USNO Circular 179 (2005), Eq.
/// 2.6: accurate to 10 µs from 1600 to 2200. The Earth moves 0.3 m in 10 µs.
pub fn tdb_minus_tt_s(tt_j2000_s: f64) -> f64 {
    let t = tt_j2000_s / CENTURY_S;
    0.001657 * libm::sin(628.3076 * t + 6.2401)
        + 0.000022 * libm::sin(575.3385 * t + 4.2970)
        + 0.000014 * libm::sin(1256.6152 * t + 6.1969)
        + 0.000005 * libm::sin(606.9777 * t + 4.0212)
        + 0.000005 * libm::sin(52.9691 * t + 0.4444)
        + 0.000002 * libm::sin(21.3299 * t + 5.5431)
        + 0.000010 * t * libm::sin(628.3076 * t + 4.2490)
}

/// GPS time: seconds since 1980-01-06 00:00 UTC without leap seconds (TAI − 19 s).
pub fn gps_s(time: Epoch) -> f64 {
    seconds(tai_ns(time) - GPS_ORIGIN_TAI_NS)
}

/// Returns the instant of a GPS time in s since 1980-01-06 00:00 UTC, rounded to the nanosecond.
pub fn from_gps_s(gps_s: f64) -> Epoch {
    epoch_of_tai(nanoseconds(gps_s) + GPS_ORIGIN_TAI_NS)
}

/// Calendar fields of a UTC time as written.
struct Civil {
    year: i32,
    month: u8,
    day: u8,
    hour: u8,
    minute: u8,
    second: u8,
    nanosecond: u32,
}

impl Civil {
    fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix('Z').or_else(|| text.strip_suffix(" UTC"))?;
        let (date, time) = text.split_once(['T', ' '])?;
        let (year, rest) = date.split_once('-')?;
        let (month, day) = rest.split_once('-')?;
        let (hour, rest) = time.split_once(':')?;
        let (minute, rest) = rest.split_once(':')?;
        let (second, fraction) = rest.split_once('.').map_or((rest, None), |(s, f)| (s, Some(f)));
        let year = i32::from(digits(year, 4)?);
        let nanosecond = match fraction {
            None => 0,
            Some(f) if (1..=9).contains(&f.len()) && f.bytes().all(|b| b.is_ascii_digit()) => {
                format!("{f:0<9}").parse().ok()?
            }
            Some(_) => return None,
        };
        let two = |text| digits(text, 2).and_then(|n| u8::try_from(n).ok());
        let civil = Self {
            year,
            month: two(month)?,
            day: two(day)?,
            hour: two(hour)?,
            minute: two(minute)?,
            second: two(second)?,
            nanosecond,
        };
        (1972..=2261).contains(&civil.year).then_some(civil)
    }

    /// Count of UTC from 1900-01-01, ns, with days of 86,400 s: a UTC duration in hifitime. `None` for a date
    /// or time that does not exist; leap seconds are checked by the caller.
    fn label_ns(&self) -> Option<i128> {
        let last_minute = self.hour == 23 && self.minute == 59;
        if self.hour > 23 || self.second > 60 || (self.second == 60 && !last_minute) {
            return None;
        }
        let minute = Epoch::maybe_from_gregorian(
            self.year,
            self.month,
            self.day,
            self.hour,
            self.minute,
            0,
            0,
            TimeScale::UTC,
        )
        .ok()?;
        Some(
            minute.duration.total_nanoseconds()
                + i128::from(self.second) * NS_PER_S
                + i128::from(self.nanosecond),
        )
    }
}

/// Parses exactly `count` decimal digits.
fn digits(text: &str, count: usize) -> Option<u16> {
    (text.len() == count && text.bytes().all(|b| b.is_ascii_digit())).then(|| text.parse().ok())?
}

/// Leap seconds since 1972, oldest first; the first entry is the 10 s of 1972-01-01.
fn leap_seconds() -> impl Iterator<Item = LeapSecond> {
    LatestLeapSeconds::default().filter(|leap| leap.announced_by_iers)
}

/// Midnight (UTC) from which an entry of the table applies, as a UTC label, ns.
fn leap_label_ns(leap: &LeapSecond) -> i128 {
    leap.timestamp_tai_s as i128 * NS_PER_S
}

/// TAI − UTC from an entry of the table on, ns.
fn leap_offset_ns(leap: &LeapSecond) -> i128 {
    leap.delta_at as i128 * NS_PER_S
}

fn tai_minus_utc_ns(label_ns: i128) -> i128 {
    leap_seconds()
        .take_while(|leap| leap_label_ns(leap) <= label_ns)
        .last()
        .map_or(10 * NS_PER_S, |leap| leap_offset_ns(&leap))
}

/// TAI − UTC at a count of TAI, ns, and true if the instant is inside a leap second.
fn utc_at(tai_ns: i128) -> (i128, bool) {
    let mut offset_ns = 10 * NS_PER_S;
    for leap in leap_seconds() {
        let midnight_tai_ns = leap_label_ns(&leap) + leap_offset_ns(&leap);
        if tai_ns < midnight_tai_ns {
            return (offset_ns, leap_offset_ns(&leap) > offset_ns && tai_ns >= midnight_tai_ns - NS_PER_S);
        }
        offset_ns = leap_offset_ns(&leap);
    }
    (offset_ns, false)
}

/// TAI since 1900-01-01 00:00 TAI, ns.
fn tai_ns(time: Epoch) -> i128 {
    match time.time_scale {
        TimeScale::UTC => {
            let label_ns = time.duration.total_nanoseconds();
            label_ns + tai_minus_utc_ns(label_ns)
        }
        // hifitime would use the platform's sine. TDB − TT is almost constant over its own 2 ms.
        TimeScale::TDB | TimeScale::ET => {
            let tdb_ns = time.duration.total_nanoseconds();
            let difference_ns = nanoseconds(tdb_minus_tt_s(seconds(tdb_ns)));
            tdb_ns - difference_ns + J2000_NS - TT_MINUS_TAI_NS
        }
        _ => time.to_tai_duration().total_nanoseconds(),
    }
}

fn epoch_of_tai(tai_ns: i128) -> Epoch {
    Epoch::from_tai_duration(Duration::from_total_nanoseconds(tai_ns))
}

fn seconds(ns: i128) -> f64 {
    ns.div_euclid(NS_PER_S) as f64 + ns.rem_euclid(NS_PER_S) as f64 * 1e-9
}

fn nanoseconds(seconds: f64) -> i128 {
    let whole = seconds.floor();
    // The cast saturates, and NaN becomes 0.
    (whole as i64 as i128) * NS_PER_S + ((seconds - whole) * 1e9).round() as i128
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tt_minus_utc_label_s(text: &str) -> f64 {
        let label = Civil::parse(text).unwrap().label_ns().unwrap() - J2000_NS;
        tt_j2000_s(parse_utc(text).unwrap()) - seconds(label)
    }

    #[test]
    fn tt_is_ahead_of_utc_by_a_second_more_after_the_leap_second_of_june_2012() {
        // 0.2 µs: the resolution of a count of seconds since J2000 in f64.
        assert!((tt_minus_utc_label_s("2012-06-30T23:59:59Z") - 66.184).abs() < 2e-7);
        assert!((tt_minus_utc_label_s("2012-07-01T00:00:00Z") - 67.184).abs() < 2e-7);
        assert!((tt_minus_utc_label_s("2000-01-01T12:00:00Z") - 64.184).abs() < 2e-7);
        assert!((tt_minus_utc_label_s("2026-01-01T00:00:00 UTC") - 69.184).abs() < 2e-7);
    }

    #[test]
    fn a_leap_second_lasts_one_second_and_is_printed_as_second_60() {
        let before = parse_utc("2012-06-30T23:59:59.25Z").unwrap();
        let inside = parse_utc("2012-06-30T23:59:60.25Z").unwrap();
        let after = parse_utc("2012-07-01T00:00:00.25Z").unwrap();
        assert_eq!(inside - before, Duration::from_total_nanoseconds(NS_PER_S));
        assert_eq!(after - inside, Duration::from_total_nanoseconds(NS_PER_S));
        assert_eq!(format_utc(inside), "2012-06-30T23:59:60.250000000Z");
    }

    #[test]
    fn every_text_round_trips_over_a_leap_second() {
        let start = parse_utc("2012-06-30T23:59:00.000000001Z").unwrap();
        for s in 0..120 {
            let time = start + Duration::from_total_nanoseconds(s * NS_PER_S);
            let text = format_utc(time);
            assert_eq!(parse_utc(&text).unwrap(), time, "{text}");
            let expected = if s <= 60 {
                format!("2012-06-30T23:59:{s:02}.000000001Z")
            } else {
                format!("2012-07-01T00:00:{:02}.000000001Z", s - 61)
            };
            assert_eq!(text, expected);
        }
    }

    #[test]
    fn hifitime_still_steps_utc_early() {
        // Known bug of hifitime 4.3.1, which format_utc avoids: 20 s before the leap second its UTC has
        // already stepped back.
        let time = parse_utc("2012-06-30T23:59:40Z").unwrap();
        assert_eq!(time.to_gregorian_utc(), (2012, 6, 30, 23, 59, 39, 0));
        assert_eq!(format_utc(time), "2012-06-30T23:59:40.000000000Z");
    }

    #[test]
    fn second_60_is_refused_where_no_leap_second_was_inserted() {
        for text in [
            "2012-04-25T12:18:60Z",
            "2012-12-31T23:59:60Z",
            "2012-06-30T22:59:60Z",
            "2013-06-30T23:59:60Z",
            "1971-12-31T23:59:60Z",
            "2012-06-30T23:59:61Z",
        ] {
            assert!(parse_utc(text).is_err(), "{text} was read");
        }
    }

    #[test]
    fn an_invalid_utc_time_is_refused() {
        for text in [
            "",
            "Z",
            "2012-04-25",
            "2012-04-25T12:18:54",
            "2012-04-25T12:18:54+00:00",
            "2012-04-25T12:18:54 TAI",
            "2012-4-25T12:18:54Z",
            "2012-02-30T12:18:54Z",
            "2013-02-29T00:00:00Z",
            "2012-13-01T00:00:00Z",
            "2012-00-01T00:00:00Z",
            "2012-01-00T00:00:00Z",
            "2012-04-25T24:00:00Z",
            "2012-04-25T12:60:00Z",
            "2012-04-25T12:18:54.Z",
            "2012-04-25T12:18:54.0123456789Z",
            "2012-04-25T12:18:-1Z",
            "1969-04-25T12:18:54Z",
            "2262-01-01T00:00:00Z",
            "٢٠١٢-04-25T12:18:54Z",
        ] {
            assert!(parse_utc(text).is_err(), "{text} was read");
        }
    }

    #[test]
    fn nanoseconds_survive() {
        let text = "2012-04-25T12:18:54.123456789Z";
        assert_eq!(format_utc(parse_utc(text).unwrap()), text);
        assert_eq!(
            parse_utc("2012-04-25T12:18:54.5Z").unwrap(),
            parse_utc("2012-04-25 12:18:54.50 UTC").unwrap()
        );
    }

    #[test]
    fn milliseconds_since_1970_are_those_of_posix() {
        // From `date --utc --date=TEXT +%s`; inside a leap second, the value at its end.
        for (text, ms) in [
            ("2012-04-23T00:00:00Z", 1_335_139_200_000),
            ("2012-04-25T12:18:54.123999999Z", 1_335_356_334_123),
            ("2012-06-30T23:59:59.5Z", 1_341_100_799_500),
            ("2012-06-30T23:59:60.5Z", 1_341_100_800_000),
            ("2012-07-01T00:00:00.5Z", 1_341_100_800_500),
            ("2026-01-01T00:00:00Z", 1_767_225_600_000),
        ] {
            assert_eq!(unix_ms(parse_utc(text).unwrap()), ms, "{text}");
        }
    }

    #[test]
    fn time_in_nanoseconds_round_trips_over_a_leap_second_and_does_not_step_back() {
        let start = parse_utc("2016-12-31T23:58:00.5Z").unwrap();
        let mut before = i64::MIN;
        for half_seconds in 0..480 {
            let time = start + Duration::from_total_nanoseconds(half_seconds * NS_PER_S / 2);
            let unix_ns = unix_ns(time);
            assert!(unix_ns >= before, "{}", format_utc(time));
            before = unix_ns;
            let text = format_utc(time);
            if text.contains(":60.") {
                assert_eq!(format_utc(from_unix_ns(unix_ns)), "2017-01-01T00:00:00.000000000Z");
            } else {
                assert_eq!(from_unix_ns(unix_ns), time, "{text}");
            }
        }
    }

    #[test]
    fn the_julian_date_is_that_of_the_calendar_up_to_a_leap_second() {
        let at = |text| jd_utc(parse_utc(text).unwrap());
        assert_eq!(at("2000-01-01T12:00:00Z"), 2_451_545.0);
        // A second is 1.2e-5 days, and the resolution of the number is 5e-10 days.
        assert!((at("2016-12-31T23:59:50Z") - (2_457_754.5 - 10.0 / 86_400.0)).abs() < 1e-9);
        assert_eq!(at("2016-12-31T23:59:60.5Z"), 2_457_754.5);
    }

    #[test]
    fn gps_time_starts_in_1980_and_is_fifteen_seconds_ahead_of_utc_in_april_2012() {
        assert_eq!(gps_s(parse_utc("1980-01-06T00:00:00Z").unwrap()), 0.0);
        // The telemetry constant of the far-range paper (GPS − 630763213 s) is 2000-01-01 12:00:00 UTC:
        // 13 leap seconds after 1980.
        assert_eq!(format_utc(from_gps_s(630_763_213.0)), "2000-01-01T12:00:00.000000000Z");
        let april = parse_utc("2012-04-25T00:00:00Z").unwrap();
        // 11,798 days since 1980-01-06.
        assert_eq!(gps_s(april), 11_798.0 * 86_400.0 + 15.0);
        assert_eq!(from_gps_s(gps_s(april)), april);
    }

    #[test]
    fn an_epoch_of_any_scale_is_the_same_instant() {
        let tai = parse_utc("2012-06-30T23:59:58Z").unwrap();
        let tt = tt_j2000_s(tai);
        for scale in [TimeScale::UTC, TimeScale::TT, TimeScale::GPST] {
            let utc_label = Duration::from_total_nanoseconds(
                Civil::parse("2012-06-30T23:59:58Z").unwrap().label_ns().unwrap(),
            );
            let time = if scale == TimeScale::UTC {
                Epoch::from_utc_duration(utc_label)
            } else {
                tai.to_time_scale(scale)
            };
            assert_eq!(tt_j2000_s(time), tt, "{scale}");
        }
        let tdb = Epoch::from_duration(
            Duration::from_total_nanoseconds(nanoseconds(tdb_j2000_s(tai))),
            TimeScale::TDB,
        );
        // 0.2 µs: resolution of the count in f64.
        assert!((tt_j2000_s(tdb) - tt).abs() < 3e-7);
        assert_eq!(
            from_tt_j2000_s(1_000.5),
            from_tt_j2000_s(1_000.0) + Duration::from_total_nanoseconds(NS_PER_S / 2)
        );
    }
}
