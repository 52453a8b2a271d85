//! UTC in files: ISO 8601, to the nanosecond.

use hifitime::Epoch;

/// An epoch as `2012-04-25T13:02:07.250000000Z`; `None` when UTC has no such name that [`parse_utc`] would read
/// back to the same epoch: inside a leap second, or in a year that is not 1 to 9999.
pub fn format_utc(epoch: Epoch) -> Option<String> {
    let (year, month, day, hour, minute, second, nanosecond) = epoch.to_gregorian_utc();
    let text = format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{nanosecond:09}Z");
    (parse_utc(&text) == Ok(epoch)).then_some(text)
}

const EXPECTED: &str = "a UTC time such as 2012-04-25T13:02:07.25Z (up to 9 decimals)";

/// Reads a UTC time in ISO 8601: `YYYY-MM-DDThh:mm:ss`, up to 9 decimals of the second, `Z` or nothing after it,
/// a blank allowed for the `T`.
///
/// # Errors
/// What was expected. Second 60 is refused: a leap second cannot be held by the epoch type, which would take it
/// for the second before.
pub fn parse_utc(text: &str) -> Result<Epoch, &'static str> {
    let text = text.strip_suffix('Z').unwrap_or(text);
    let (date, time) = text.split_once(['T', ' ']).ok_or(EXPECTED)?;
    let [year, month, day] = fields(date, '-', [4, 2, 2])?;
    let (clock, decimals) = match time.split_once('.') {
        Some((clock, decimals)) => (clock, decimals),
        None => (time, "0"),
    };
    let [hour, minute, second] = fields(clock, ':', [2, 2, 2])?;
    if second == 60 {
        return Err("a second from 0 to 59; leap seconds are not supported");
    }
    if !(1..=9).contains(&decimals.len()) {
        return Err(EXPECTED);
    }
    let nanosecond = number(&format!("{decimals:0<9}"), 9)?;
    if year == 0 || hour > 23 || minute > 59 || second > 59 {
        return Err(EXPECTED);
    }
    Epoch::maybe_from_gregorian_utc(
        year as i32,
        month as u8,
        day as u8,
        hour as u8,
        minute as u8,
        second as u8,
        nanosecond,
    )
    .map_err(|_| EXPECTED)
}

/// Three numbers of fixed widths.
fn fields(text: &str, separator: char, widths: [usize; 3]) -> Result<[u32; 3], &'static str> {
    let mut parts = text.split(separator);
    let mut next = |width| number(parts.next().ok_or(EXPECTED)?, width);
    let numbers = [next(widths[0])?, next(widths[1])?, next(widths[2])?];
    if parts.next().is_some() { Err(EXPECTED) } else { Ok(numbers) }
}

/// Exactly `width` digits, 9 at most.
fn number(text: &str, width: usize) -> Result<u32, &'static str> {
    if text.len() == width && text.bytes().all(|b| b.is_ascii_digit()) {
        text.parse().map_err(|_| EXPECTED)
    } else {
        Err(EXPECTED)
    }
}

#[cfg(test)]
mod tests {
    use hifitime::Unit;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_leap_second_is_refused_and_not_taken_for_the_second_before() {
        assert!(parse_utc("2012-06-30T23:59:60Z").is_err());
        assert!(parse_utc("2012-06-30T23:59:59Z").is_ok());
    }

    #[test]
    fn what_is_not_a_time_is_refused() {
        for text in [
            "",
            "2012-04-25",
            "2012-04-31T00:00:00",
            "2012-13-01T00:00:00",
            "2012-04-25T24:00:00",
            "2012-04-25T00:60:00",
            "2012-4-25T00:00:00",
            "2012-04-25T00:00:00.1234567890",
            "2012-04-25T00:00:00.",
            "2012-04-25T00:00:00.x",
            "2012-04-25T00:00:00+02:00",
            "0000-01-01T00:00:00",
            "２012-04-25T00:00:00",
        ] {
            assert!(parse_utc(text).is_err(), "{text}");
        }
    }

    #[test]
    fn short_forms_mean_the_same_time() {
        let time = parse_utc("2012-04-25T13:02:07.250000000Z");
        for text in ["2012-04-25T13:02:07.25Z", "2012-04-25 13:02:07.25"] {
            assert_eq!(parse_utc(text), time);
        }
    }

    proptest! {
        #[test]
        fn every_nanosecond_comes_back(seconds in 0_i64..1_900_000_000, nanoseconds in 0_i64..1_000_000_000) {
            let time = Epoch::from_gregorian_utc_at_midnight(1980, 1, 6)
                + Unit::Second * seconds + Unit::Nanosecond * nanoseconds;
            prop_assert_eq!(parse_utc(&format_utc(time).unwrap()), Ok(time));
        }

        #[test]
        fn no_text_makes_it_panic(text in "\\PC{0,40}") {
            let _ = parse_utc(&text);
        }
    }
}
