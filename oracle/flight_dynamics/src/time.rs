//! Time systems of CCSDS messages, and their time code.

use hifitime::{Duration, Epoch};
use sim::truth::clock;

const NS_PER_S: i128 = 1_000_000_000;
const NS_PER_DAY: i128 = 86_400 * NS_PER_S;
/// TT − TAI, ns, by definition.
const TT_MINUS_TAI_NS: i128 = 32_184_000_000;
/// TAI − GPS time, ns, by definition.
const TAI_MINUS_GPS_NS: i128 = 19 * NS_PER_S;
/// J2000.0 (2000-01-01 12:00) as a count from 1900-01-01 00:00 in the same system, ns.
const J2000_NS: i128 = 3_155_716_800 * NS_PER_S;
/// Years that a time may have: those of UTC with integer leap seconds, and of timestamps in nanoseconds.
const YEARS: std::ops::RangeInclusive<i64> = 1972..=2261;

/// Form of a time, for messages.
pub(crate) const TIME_FORM: &str =
    "a time such as 2012-04-25T12:18:54.5 or 2012-116T12:18:54.5, from 1972 to 2261";

/// Time system of a message.
///
/// UT1 is refused: its difference to UTC is measured, and its table is not a part of Boresight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeSystem {
    /// Coordinated Universal Time; second 60 exists where a leap second was inserted.
    Utc,
    /// International Atomic Time.
    Tai,
    /// Terrestrial Time, TAI + 32.184 s.
    Tt,
    /// Barycentric Dynamical Time, accurate to 10 µs ([`clock::tdb_minus_tt_s`]).
    Tdb,
    /// Time of the Global Positioning System, TAI − 19 s.
    Gps,
}

impl TimeSystem {
    /// Time systems that are read.
    pub const ALL: [Self; 5] = [Self::Utc, Self::Tai, Self::Tt, Self::Tdb, Self::Gps];

    /// Returns the keyword of CCSDS.
    pub fn code(self) -> &'static str {
        match self {
            Self::Utc => "UTC",
            Self::Tai => "TAI",
            Self::Tt => "TT",
            Self::Tdb => "TDB",
            Self::Gps => "GPS",
        }
    }

    /// Parses a keyword, in capitals or not; `None` for another time system.
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|system| system.code().eq_ignore_ascii_case(code))
    }

    /// Parses a time in this system, calendar date or day of the year, with or without `Z`. Digits beyond
    /// nanoseconds are ignored. `None` for another form and for a time that does not exist.
    pub fn parse_time(self, text: &str) -> Option<Epoch> {
        let civil = Civil::parse(text)?;
        if self == Self::Utc {
            return clock::parse_utc(&civil.utc_text()).ok();
        }
        if civil.second > 59 {
            return None;
        }
        let count_ns = civil.count_ns();
        let tai_ns = match self {
            Self::Utc | Self::Tai => count_ns,
            Self::Tt => count_ns - TT_MINUS_TAI_NS,
            Self::Tdb => {
                let j2000_ns = count_ns - J2000_NS;
                // TDB − TT is almost constant over its own 2 ms.
                count_ns - tdb_minus_tt_ns(j2000_ns) - TT_MINUS_TAI_NS
            }
            Self::Gps => count_ns + TAI_MINUS_GPS_NS,
        };
        Some(Epoch::from_tai_duration(Duration::from_total_nanoseconds(tai_ns)))
    }

    /// Formats a time in this system as calendar date with nine decimals and without `Z`.
    pub fn format_time(self, time: Epoch) -> String {
        if self == Self::Utc {
            let mut text = clock::format_utc(time);
            text.pop();
            return text;
        }
        let tai_ns = time.to_tai_duration().total_nanoseconds();
        let count_ns = match self {
            Self::Utc | Self::Tai => tai_ns,
            Self::Tt => tai_ns + TT_MINUS_TAI_NS,
            Self::Tdb => {
                let tt_ns = tai_ns + TT_MINUS_TAI_NS;
                tt_ns + tdb_minus_tt_ns(tt_ns - J2000_NS)
            }
            Self::Gps => tai_ns - TAI_MINUS_GPS_NS,
        };
        let (days, in_day) = (count_ns.div_euclid(NS_PER_DAY), count_ns.rem_euclid(NS_PER_DAY));
        let (year, month, day) = date_of_days(days as i64);
        let (seconds, nanosecond) = (in_day / NS_PER_S, in_day % NS_PER_S);
        format!(
            "{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}.{nanosecond:09}",
            seconds / 3600,
            seconds / 60 % 60,
            seconds % 60
        )
    }
}

/// TDB − TT, ns, at a count since J2000.0, ns.
fn tdb_minus_tt_ns(j2000_ns: i128) -> i128 {
    libm::round(clock::tdb_minus_tt_s(j2000_ns as f64 * 1e-9) * 1e9) as i128
}

/// Date and time of day, as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Civil {
    year: i64,
    month: i64,
    day: i64,
    hour: i64,
    minute: i64,
    second: i64,
    nanosecond: i128,
}

impl Civil {
    fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix('Z').unwrap_or(text);
        let (date, time) = text.split_once('T')?;
        let (year, date) = date.split_once('-')?;
        let year = digits(year, 4)?;
        if !YEARS.contains(&year) {
            return None;
        }
        let (month, day) = match date.split_once('-') {
            Some((month, day)) => (digits(month, 2)?, digits(day, 2)?),
            None => month_and_day(year, digits(date, 3)?)?,
        };
        if !(1..=12).contains(&month) || !(1..=month_length(year, month)).contains(&day) {
            return None;
        }
        let mut parts = time.split(':');
        let (hour, minute) = (digits(parts.next()?, 2)?, digits(parts.next()?, 2)?);
        let seconds = parts.next()?;
        let (second, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
        let second = digits(second, 2)?;
        if parts.next().is_some() || hour > 23 || minute > 59 || second > 60 {
            return None;
        }
        if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let nanosecond = fraction
            .bytes()
            .chain(std::iter::repeat(b'0'))
            .take(9)
            .fold(0, |sum: i128, digit| 10 * sum + i128::from(digit - b'0'));
        Some(Self { year, month, day, hour, minute, second, nanosecond })
    }

    /// Returns the text that [`clock::parse_utc`] reads.
    fn utc_text(&self) -> String {
        let Self { year, month, day, hour, minute, second, nanosecond } = self;
        format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{nanosecond:09}Z")
    }

    /// Count from 1900-01-01 00:00 in a system without leap seconds, ns.
    fn count_ns(&self) -> i128 {
        let seconds = 3600 * self.hour + 60 * self.minute + self.second;
        let days = days_of_date(self.year, self.month, self.day);
        i128::from(days) * NS_PER_DAY + i128::from(seconds) * NS_PER_S + self.nanosecond
    }
}

/// Parses exactly `count` decimal digits.
fn digits(text: &str, count: usize) -> Option<i64> {
    (text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit())).then(|| text.parse().ok())?
}

fn month_length(year: i64, month: i64) -> i64 {
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    match month {
        2 if is_leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Month and day of a day of the year, which is counted from 1.
fn month_and_day(year: i64, day_of_year: i64) -> Option<(i64, i64)> {
    let mut day = day_of_year;
    for month in 1..=12 {
        let length = month_length(year, month);
        if day <= length {
            return (day >= 1).then_some((month, day));
        }
        day -= length;
    }
    None
}

/// Days from 1900-01-01 to a date of the Gregorian calendar.
fn days_of_date(year: i64, month: i64, day: i64) -> i64 {
    let before = year - 1;
    let leap_days = |year: i64| year / 4 - year / 100 + year / 400;
    let years = 365 * (year - 1900) + leap_days(before) - leap_days(1899);
    years + (1..month).map(|month| month_length(year, month)).sum::<i64>() + day - 1
}

/// Date of a number of days since 1900-01-01.
fn date_of_days(days: i64) -> (i64, i64, i64) {
    let mut year = 1900 + days / 366;
    while days_of_date(year + 1, 1, 1) <= days {
        year += 1;
    }
    let day_of_year = days - days_of_date(year, 1, 1) + 1;
    let (month, day) = month_and_day(year, day_of_year).unwrap_or((12, 31));
    (year, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_instant_has_the_same_time_in_every_system() {
        // 2012-06-30 23:59:60.25 UTC is inside the leap second; TAI − UTC was 34 s before it.
        let time = TimeSystem::Utc.parse_time("2012-06-30T23:59:60.25").unwrap();
        for (system, text) in [
            (TimeSystem::Utc, "2012-06-30T23:59:60.250000000"),
            (TimeSystem::Tai, "2012-07-01T00:00:34.250000000"),
            (TimeSystem::Tt, "2012-07-01T00:01:06.434000000"),
            (TimeSystem::Gps, "2012-07-01T00:00:15.250000000"),
        ] {
            assert_eq!(system.format_time(time), text);
            assert_eq!(system.parse_time(text), Some(time), "{text}");
        }
    }

    #[test]
    fn tdb_differs_from_tt_by_its_series() {
        for text in ["2012-04-10T00:00:00.000000000", "2012-11-05T00:00:00.000000000"] {
            let tdb = TimeSystem::Tdb.parse_time(text).unwrap();
            let tt = TimeSystem::Tt.parse_time(text).unwrap();
            let difference_s = (tt - tdb).to_seconds();
            let expected_s = clock::tdb_minus_tt_s(clock::tt_j2000_s(tt));
            assert!((difference_s - expected_s).abs() < 2e-9, "{difference_s} {expected_s}");
            assert!(difference_s.abs() > 1e-3);
            assert_eq!(TimeSystem::Tdb.format_time(tdb), text);
        }
    }

    #[test]
    fn days_of_the_year_are_dates() {
        for (day, date) in
            [("2012-060T00:00:00Z", "2012-02-29T00:00:00"), ("2013-365T01:02:03.4", "2013-12-31T01:02:03.4")]
        {
            assert_eq!(TimeSystem::Tai.parse_time(day), TimeSystem::Tai.parse_time(date));
            assert!(TimeSystem::Tai.parse_time(day).is_some());
        }
    }

    #[test]
    fn times_that_do_not_exist_are_refused() {
        for text in [
            "",
            "T",
            "2012-04-25",
            "2012-13-01T00:00:00",
            "2013-02-29T00:00:00",
            "2013-366T00:00:00",
            "2012-000T00:00:00",
            "2012-04-25T24:00:00",
            "2012-04-25T00:60:00",
            "2012-04-25T00:00:60",
            "1971-04-25T00:00:00",
            "2262-04-25T00:00:00",
            "2012-04-25T00:00:0x",
            "2012-04-25T00:00:00.1e3",
            "+012-04-25T00:00:00",
            "2012-04-25T00:00:00ZZ",
            "2012-04-25 00:00:00",
            "2012-04-25T00:00:00+01:00",
        ] {
            for system in TimeSystem::ALL {
                assert_eq!(system.parse_time(text), None, "{text}");
            }
        }
    }

    proptest! {
        #[test]
        fn every_time_comes_back(seconds in -8.0e8_f64..8.0e9, nanoseconds in 0_i64..1_000_000_000) {
            let time = clock::from_tt_j2000_s(seconds.floor()) + Duration::from_nanoseconds(nanoseconds as f64);
            for system in TimeSystem::ALL {
                let text = system.format_time(time);
                let back = system.parse_time(&text).unwrap();
                prop_assert!((back - time).abs() <= Duration::from_nanoseconds(1.0), "{text}");
            }
        }
    }
}
