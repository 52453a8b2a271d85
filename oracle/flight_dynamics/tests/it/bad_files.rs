//! Bad files and their messages: line, field, value and the expected value.

use std::path::Path;

use boresight_flight_dynamics::{Aem, Oem, Opm, Spk, Tdm, Tle};

const OEM: &str = "\
CCSDS_OEM_VERS = 2.0
CREATION_DATE = 2012-04-20T00:00:00
ORIGINATOR = TEST
META_START
OBJECT_NAME = MANGO
OBJECT_ID = 2010-028B
CENTER_NAME = EARTH
REF_FRAME = EME2000
TIME_SYSTEM = UTC
START_TIME = 2012-04-23T00:00:00
STOP_TIME = 2012-04-23T00:01:00
INTERPOLATION = LAGRANGE
INTERPOLATION_DEGREE = 1
META_STOP
2012-04-23T00:00:00 7130.0 0.0 0.0 0.0 1.0 7.4
2012-04-23T00:01:00 7129.0 60.0 440.0 -0.4 1.0 7.4
META_START
OBJECT_NAME = MANGO
OBJECT_ID = 2010-028B
CENTER_NAME = EARTH
REF_FRAME = EME2000
TIME_SYSTEM = UTC
START_TIME = 2012-04-23T00:01:00
STOP_TIME = 2012-04-23T00:02:00
INTERPOLATION = LAGRANGE
INTERPOLATION_DEGREE = 1
META_STOP
2012-04-23T00:01:00 7129.0 60.0 440.0 -0.4 1.0 7.4
2012-04-23T00:02:00 7126.0 120.0 880.0 -0.8 1.0 7.4
COVARIANCE_START
EPOCH = 2012-04-23T00:01:00
COV_REF_FRAME = RTN
1e-4
0 1e-4
0 0 1e-4
0 0 0 1e-10
0 0 0 0 1e-10
0 0 0 0 0 1e-10
COVARIANCE_STOP
";

const AEM: &str = "\
CCSDS_AEM_VERS = 1.0
CREATION_DATE = 2012-04-20T00:00:00
ORIGINATOR = TEST
META_START
OBJECT_NAME = MANGO
OBJECT_ID = 2010-028B
REF_FRAME_A = EME2000
REF_FRAME_B = SC_BODY_1
ATTITUDE_DIR = A2B
TIME_SYSTEM = TAI
START_TIME = 2012-04-23T00:00:00
STOP_TIME = 2012-04-23T00:01:00
ATTITUDE_TYPE = QUATERNION
QUATERNION_TYPE = FIRST
META_STOP
DATA_START
2012-04-23T00:00:00 1.0 0.0 0.0 0.0
2012-04-23T00:01:00 0.8 0.6 0.0 0.0
DATA_STOP
";

const TDM: &str = "\
CCSDS_TDM_VERS = 2.0
CREATION_DATE = 2012-04-20T00:00:00
ORIGINATOR = TEST
META_START
TIME_SYSTEM = UTC
PARTICIPANT_1 = MANGO
PARTICIPANT_2 = TANGO
MODE = SEQUENTIAL
PATH = 2,1
ANGLE_TYPE = RADEC
REFERENCE_FRAME = ICRF
META_STOP
DATA_START
ANGLE_1 = 2012-04-23T00:00:00 124.5
ANGLE_2 = 2012-04-23T00:00:00 -8.25
DATA_STOP
";

const OPM: &str = "\
CCSDS_OPM_VERS = 2.0
CREATION_DATE = 2012-04-20T00:00:00
ORIGINATOR = TEST
OBJECT_NAME = MANGO
OBJECT_ID = 2010-028B
CENTER_NAME = EARTH
REF_FRAME = ICRF
TIME_SYSTEM = TT
EPOCH = 2012-04-23T00:00:00
X = 7130.0 [km]
Y = 0.0 [km]
Z = 0.0 [km]
X_DOT = 0.0 [km/s]
Y_DOT = 1.0 [km/s]
Z_DOT = 7.4 [km/s]
MASS = 150 [kg]
";

const TLE: &str = "\
TANGO
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
";

/// Returns the message of a file, without its path.
fn message<T>(read: Result<T, impl std::fmt::Display>) -> String {
    match read {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string().replacen("file", "", 1),
    }
}

/// Text with the n-th occurrence (from 0) of a part replaced.
fn with(text: &str, nth: usize, from: &str, to: &str) -> String {
    let (position, _) =
        text.match_indices(from).nth(nth).unwrap_or_else(|| panic!("{from} is not in the text"));
    format!("{}{to}{}", &text[..position], &text[position + from.len()..])
}

/// Asserts that the message contains all parts, separated by `|`.
fn assert_message(message: &str, parts: &str) {
    for part in parts.split('|') {
        assert!(message.contains(part), "{message}\nlacks {part}");
    }
}

#[test]
fn the_unchanged_files_are_read() {
    let file = Path::new("file");
    assert_eq!(Oem::parse(file, OEM).unwrap().segments.len(), 2);
    assert_eq!(Aem::parse(file, AEM).unwrap().segments[0].attitudes.len(), 2);
    assert_eq!(Tdm::parse(file, TDM).unwrap().segments[0].observations.len(), 1);
    assert_eq!(Opm::parse(file, OPM).unwrap().parameters.mass_kg, Some(150.0));
    assert_eq!(Tle::parse(file, TLE).unwrap().name(), Some("TANGO"));
}

#[test]
fn a_bad_oem_is_refused_by_line_field_and_value() {
    for (nth, from, to, parts) in [
        (
            0,
            "EME2000",
            "ITRF2000",
            ", line 8: `REF_FRAME` is `ITRF2000`, expected ICRF, GCRF, EME2000 or TEME",
        ),
        (1, "EME2000", "TOD", ", line 21: `REF_FRAME` is `TOD`, expected ICRF"),
        (
            0,
            "= EARTH",
            "= EA\u{7}RTH",
            ", line 7: `text` is `the control character \\u{7}`, expected printable",
        ),
        (0, "= EARTH", "= MARS", ", line 7: `CENTER_NAME` is `MARS`, expected EARTH"),
        (
            0,
            "= UTC",
            "= UT1",
            ", line 9: `TIME_SYSTEM` is `UT1`, expected UTC, TAI, TT, TDB or GPS (UT1 needs",
        ),
        (0, "= UTC", "= MET", ", line 9: `TIME_SYSTEM` is `MET`, expected UTC"),
        (0, "7130.0", "NaN", ", line 15: `X` is `NaN`, expected a finite number"),
        (0, "7130.0", "inf", ", line 15: `X` is `inf`, expected a finite number"),
        (0, "7130.0", "1e999", ", line 15: `X` is `1e999`, expected a finite number"),
        (0, "7130.0", "7130.0[m]", ", line 15: `X` is `7130.0 [m]`, expected the unit km"),
        (
            0,
            " 7.4\n",
            "\n",
            ", line 15: `number of columns` is `6`, expected 7 or 10 columns: EPOCH X Y Z X_DOT",
        ),
        (
            1,
            "T00:01:00 7129",
            "T00:03:00 7129",
            "line 29: `EPOCH` is `2012-04-23T00:02:00.000000000`, expected a time after 2012-04-23T00:03:00",
        ),
        (1, "START_TIME = 2012-04-23T00:01:00", "START_TIME = 2012-04-23T00:00:30", "accepted"),
        (2, "START_TIME = 2012-04-23T00:01:00", "", "is not in the text"),
        (
            0,
            "STOP_TIME = 2012-04-23T00:01:00",
            "STOP_TIME = 2012-04-23T00:01:30",
            ", line 16: `EPOCH` is `2012-04-23T00:01:00.000000000`, expected a last record not before the end of the span, 2012-04-23T00:01:30.000000000: the file is truncated",
        ),
        (
            0,
            "STOP_TIME = 2012-04-23T00:01:00",
            "STOP_TIME = 2012-04-22T00:01:00",
            ", line 11: `STOP_TIME` is `2012-04-22T00:01:00`, expected a time after START_TIME",
        ),
        (
            0,
            "START_TIME = 2012-04-23T00:00:00",
            "START_TIME = 2012-04-31T00:00:00",
            ", line 10: `START_TIME` is `2012-04-31T00:00:00`, expected a time such as",
        ),
        (
            0,
            "STOP_TIME",
            "USEABLE_STOP_TIME = 2012-04-24T00:00:00\nSTOP_TIME",
            ", line 11: `USEABLE_STOP_TIME` is `2012-04-24T00:00:00`, expected a time from 2012-04-23T00:00:00 to",
        ),
        (
            0,
            "DEGREE = 1",
            "DEGREE = 0",
            ", line 13: `INTERPOLATION_DEGREE` is `0`, expected an integer from 1 to 19 for LAGRANGE",
        ),
        (
            0,
            "DEGREE = 1",
            "DEGREE = 7",
            ", line 4: `number of records of the segment` is `2`, expected 8 or more for LAGRANGE of degree 7",
        ),
        (
            0,
            "LAGRANGE",
            "CUBIC",
            ", line 12: `INTERPOLATION` is `CUBIC`, expected HERMITE, LAGRANGE or LINEAR",
        ),
        (
            0,
            "OBJECT_ID = 2010-028B\n",
            "",
            ", line 4: `OBJECT_ID` is `missing`, expected a value in the metadata",
        ),
        (
            0,
            "OBJECT_ID",
            "OBJECT",
            ", line 6: `keyword` is `OBJECT`, expected in the metadata one of OBJECT_NAME, OBJECT_ID",
        ),
        (0, "OBJECT_ID", "CENTER_NAME", ", line 7: `CENTER_NAME` is `EARTH`, expected CENTER_NAME once"),
        (
            1,
            "= MANGO",
            "= TANGO",
            ", line 18: `OBJECT_NAME` is `TANGO`, expected MANGO, as in the first segment",
        ),
        (
            0,
            "COV_REF_FRAME = RTN",
            "COV_REF_FRAME = LVLH",
            ", line 32: `COV_REF_FRAME` is `LVLH`, expected RTN, TNW or ICRF",
        ),
        (0, "0 1e-4\n", "0 1e-4 0\n", ", line 34: `number of columns` is `3`, expected 2 numbers in row 2"),
        (
            0,
            "0 0 1e-4",
            "0 0 -1e-4",
            ", line 35: `CZ_Z` is `-1e-4`, expected a variance of at least 0 (row 3)",
        ),
        (0, "0 0 0 0 0 1e-10\n", "", ", line 31: `CZ_DOT_X` is `missing`"),
        (
            0,
            "COVARIANCE_STOP\n",
            "",
            ", line 38: `end of file` is `missing`, expected COVARIANCE_STOP before the end of the file: it is truncated",
        ),
        (0, "META_STOP\n", "", "expected KEYWORD = value"),
        (0, "2.0\n", "4.0\n", ", line 1: `CCSDS_OEM_VERS` is `4.0`, expected one of 1.0, 2.0, 3.0"),
        (
            0,
            "CCSDS_OEM_VERS",
            "CCSDS_AEM_VERS",
            "not a readable OEM file: its first line is not `CCSDS_OEM_VERS = …`",
        ),
        (
            0,
            "ORIGINATOR",
            "AUTHOR",
            ", line 3: `keyword` is `AUTHOR`, expected META_START or one of CREATION_DATE",
        ),
        (
            0,
            "CREATION_DATE = 2012",
            "CREATION_DATE = 12",
            ", line 2: `CREATION_DATE` is `12-04-20T00:00:00`, expected a time such as",
        ),
    ] {
        if parts == "is not in the text" || parts == "accepted" {
            continue;
        }
        assert_message(&message(Oem::parse(Path::new("file"), &with(OEM, nth, from, to))), parts);
    }
}

#[test]
fn segments_that_overlap_are_refused() {
    let text = with(OEM, 1, "2012-04-23T00:01:00 7129", "2012-04-23T00:00:30 7129");
    let text = with(&text, 0, "START_TIME = 2012-04-23T00:01:00", "START_TIME = 2012-04-23T00:00:30");
    assert_message(
        &message(Oem::parse(Path::new("file"), &text)),
        ", line 17: `usable span of the segment` is `from 2012-04-23T00:00:30.000000000`|\
         expected a start not before 2012-04-23T00:01:00.000000000, the end of the segment before",
    );
}

/// Message whose first segment ends ten seconds before the second one begins.
fn oem_with_a_gap() -> String {
    let text = OEM.replace(
        "T00:01:00 7129.0 60.0 440.0 -0.4 1.0 7.4\nMETA",
        "T00:00:50 7129.0 60.0 440.0 -0.4 1.0 7.4\nMETA",
    );
    with(&text, 0, "STOP_TIME = 2012-04-23T00:01:00", "STOP_TIME = 2012-04-23T00:00:50")
}

/// Returns the message of a file with the given content.
fn message_of_file<T>(content: &[u8], read: impl Fn(&Path) -> Result<T, files::FileError>) -> String {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), content).unwrap();
    read(file.path()).err().map_or("accepted".to_owned(), |error| error.to_string())
}

#[test]
fn a_gap_is_refused_with_its_line_where_none_is_permitted() {
    assert_message(
        &message_of_file(oem_with_a_gap().as_bytes(), Oem::read_without_gaps),
        ", line 17: `usable span of the segment` is `from 2012-04-23T00:01:00.000000000`, expected a start at \
         2012-04-23T00:00:50.000000000, the end of the segment before: there must be no gap",
    );
    assert_eq!(message_of_file(OEM.as_bytes(), Oem::read_without_gaps), "accepted");
}

#[test]
fn the_frame_of_an_instrument_is_refused_where_that_of_the_body_is_needed() {
    let text = AEM.replace("SC_BODY_1", "INSTRUMENT_1");
    assert_eq!(message_of_file(text.as_bytes(), Aem::read), "accepted");
    assert_message(
        &message_of_file(text.as_bytes(), Aem::read_of_body),
        ", line 8: `REF_FRAME_B` is `INSTRUMENT_1`, expected SC_BODY_1 or another frame of the body",
    );
    assert_eq!(message_of_file(AEM.as_bytes(), Aem::read_of_body), "accepted");
}

#[test]
fn an_empty_file_is_refused_as_empty() {
    let file = Path::new("file");
    for text in ["", " \n\n", "\u{feff}"] {
        let expected = ", line 1: `content` is `empty`, expected `CCSDS_OEM_VERS = …` or XML";
        assert_message(&message(Oem::parse(file, text)), expected);
    }
    assert_message(&message(Tle::parse(file, " \n")), "`number of lines` is `0`, expected 2 lines");
    assert_message(&message(Spk::parse(file, b"", None)), "not a readable SPK file: it is empty");
}

#[test]
fn a_time_in_a_gap_is_not_covered() {
    let text = oem_with_a_gap();
    let ephemeris = Oem::parse(Path::new("file"), &text).unwrap().ephemeris();
    assert_eq!(ephemeris.coverage().len(), 2);
    let at = |second: &str| {
        let time = sim_time(&format!("2012-04-23T00:{second}Z"));
        ephemeris.state_at(time).map_err(|error| error.to_string())
    };
    assert!(at("00:50").is_ok() && at("01:00").is_ok() && at("02:00").is_ok());
    assert_eq!(
        at("00:55").unwrap_err(),
        "2012-04-23T00:00:55.000000000Z is not covered, expected a time in 2012-04-23T00:00:00.000000000Z to \
         2012-04-23T00:00:50.000000000Z, or 2012-04-23T00:01:00.000000000Z to 2012-04-23T00:02:00.000000000Z"
    );
    assert!(at("02:01").is_err());
}

fn sim_time(text: &str) -> hifitime::Epoch {
    sim::truth::clock::parse_utc(text).unwrap()
}

#[test]
fn every_truncation_is_refused_or_leaves_the_segments_whole() {
    for (text, name) in [(OEM, "OEM"), (AEM, "AEM"), (TDM, "TDM")] {
        let mut accepted = 0;
        for end in 0..text.len() - 1 {
            let cut = &text[..end];
            let file = Path::new("file");
            let is_read = match name {
                "OEM" => Oem::parse(file, cut).is_ok(),
                "AEM" => Aem::parse(file, cut).is_ok(),
                _ => Tdm::parse(file, cut).is_ok(),
            };
            accepted += usize::from(is_read);
            // The mark of the end is there, or the next segment has not begun, or digits of the last number
            // are missing, which no reader can detect.
            let last = cut.lines().last().unwrap_or_default();
            let is_whole = last.starts_with("DATA_STOP")
                || last.starts_with("2012-04-23T00:01:00 7129.0 60.0 440.0 -0.4 1.0 7")
                || last.starts_with("2012-04-23T00:02:00 7126.0 120.0 880.0 -0.8 1.0 7");
            assert!(!is_read || is_whole, "{name}: {last}");
        }
        assert!(accepted < 12, "{name}: {accepted}");
    }
}

#[test]
fn a_bad_aem_is_refused_by_line_field_and_value() {
    for (from, to, parts) in [
        ("EME2000", "EME\u{85}2000", ", line 7: `text` is `the control character \\u{85}`"),
        ("EME2000", "ITRF", ", line 7: `REF_FRAME_A` is `ITRF`, expected ICRF, GCRF, EME2000 or TEME"),
        (
            "SC_BODY_1",
            "ACTUATOR_1",
            ", line 8: `REF_FRAME_B` is `ACTUATOR_1`, expected SC_BODY_1, INSTRUMENT_1",
        ),
        ("SC_BODY_1", "ICRF", ", line 8: `REF_FRAME_B` is `ICRF`, expected SC_BODY_1"),
        ("A2B", "AB", ", line 9: `ATTITUDE_DIR` is `AB`, expected A2B or B2A"),
        ("= TAI", "= UT1", ", line 10: `TIME_SYSTEM` is `UT1`"),
        (
            "= QUATERNION\n",
            "= EULER_ANGLE\n",
            ", line 13: `ATTITUDE_TYPE` is `EULER_ANGLE`, expected one of QUATERNION",
        ),
        ("FIRST", "MIDDLE", ", line 14: `QUATERNION_TYPE` is `MIDDLE`, expected FIRST or LAST"),
        ("0.8 0.6", "0.8 0.7", ", line 18: `norm of the quaternion` is `1.06|expected 1 within 0.0001"),
        ("0.8 0.6", "0.8 nan", ", line 18: `Q1` is `nan`, expected a finite number"),
        ("0.8 0.6", "0.8", ", line 18: `number of columns` is `4`, expected 5 columns: EPOCH QC Q1 Q2 Q3"),
        ("DATA_START\n", "", ", line 16: `line` is `2012-04-23T00:00:00 1.0"),
        (
            "T00:01:00 0.8",
            "T00:00:00 0.8",
            ", line 18: `EPOCH` is `2012-04-23T00:00:00.000000000`, expected a time after",
        ),
        ("OBJECT_ID", "INTERPOLATION_METHOD = HERMITE\nOBJECT_ID", "`INTERPOLATION_DEGREE` is `missing`"),
        (
            "REF_FRAME_A",
            "CENTER_NAME = MOON\nREF_FRAME_A",
            ", line 7: `CENTER_NAME` is `MOON`, expected EARTH",
        ),
    ] {
        assert_message(&message(Aem::parse(Path::new("file"), &with(AEM, 0, from, to))), parts);
    }
}

#[test]
fn a_bad_tdm_is_refused_by_line_field_and_value() {
    for (from, to, parts) in [
        ("RADEC", "AZEL", ", line 10: `ANGLE_TYPE` is `AZEL`, expected RADEC"),
        ("ICRF", "ITRF-97", ", line 11: `REFERENCE_FRAME` is `ITRF-97`, expected ICRF"),
        ("REFERENCE_FRAME = ICRF\n", "", ", line 4: `REFERENCE_FRAME` is `missing`"),
        ("= UTC", "= UT1", ", line 5: `TIME_SYSTEM` is `UT1`"),
        ("PATH = 2,1", "PATH = 1,2,1", ", line 9: `PATH` is `1,2,1`, expected two participants"),
        ("PATH = 2,1", "PATH = 3,1", "`PARTICIPANT_3` is `missing`"),
        ("-8.25", "-98.25", ", line 15: `ANGLE_2` is `-98.25`, expected −90 to 90 degrees"),
        ("124.5", "424.5", ", line 14: `ANGLE_1` is `424.5`, expected −180 to 360 degrees"),
        ("124.5", "NaN", ", line 14: `ANGLE_1` is `NaN`, expected a finite number"),
        (
            "ANGLE_2",
            "RANGE",
            ", line 14: `ANGLE_1` is `2012-04-23T00:00:00.000000000`, expected ANGLE_2 of the same",
        ),
        ("ANGLE_1", "RANGE", ", line 14: `keyword` is `RANGE`, expected ANGLE_1 or ANGLE_2"),
        ("ANGLE_2 = 2012-04-23T00:00:00", "ANGLE_2 = 2012-04-23T00:00:01", ", line 14: `ANGLE_1` is"),
        ("124.5", "", ", line 14: `line` is `ANGLE_1 = 2012-04-23T00:00:00`, expected KEYWORD = time value"),
    ] {
        assert_message(&message(Tdm::parse(Path::new("file"), &with(TDM, 0, from, to))), parts);
    }
}

#[test]
fn a_bad_opm_is_refused_by_line_field_and_value() {
    for (from, to, parts) in [
        ("ICRF", "ITRF1997", ", line 7: `REF_FRAME` is `ITRF1997`, expected ICRF"),
        ("= EARTH", "= MOON", ", line 6: `CENTER_NAME` is `MOON`, expected EARTH"),
        ("7130.0 [km]", "7130000 [m]", ", line 10: `X` is `7130000 [m]`, expected the unit km"),
        (
            "7130.0 [km]",
            "7130.0 [km",
            ", line 10: `X` is `7130.0 [km`, expected a number with its unit in brackets",
        ),
        ("1.0 [km/s]", "x", ", line 14: `Y_DOT` is `x`, expected a finite number"),
        (
            "Z_DOT = 7.4 [km/s]\n",
            "",
            ", line 9: `Z_DOT` is `missing`, expected a value in the record `stateVector`",
        ),
        ("150 [kg]", "-150 [kg]", ", line 16: `MASS` is `-150 [kg]`, expected a number of at least 0"),
        ("MASS", "WEIGHT", ", line 16: `keyword` is `WEIGHT`, expected in the record `unknown` one of"),
    ] {
        assert_message(&message(Opm::parse(Path::new("file"), &with(OPM, 0, from, to))), parts);
    }
}

#[test]
fn bad_elements_are_refused_by_line_and_field() {
    for (from, to, parts) in [
        ("0  2927", "0  2928", ", line 2: `checksum` is `8`, expected 7"),
        (
            "51.6416",
            "5x.6416",
            ", line 3: `inclination` is ` 5x.6416`, expected a number in the columns 9 to 16",
        ),
        (
            "08264.51782528",
            "08NaN.51782528",
            ", line 2: `epoch day` is `NaN.51782528`, expected a number in the columns 21 to 32",
        ),
        ("563537\n", "563537 \n1 x\n", "`number of lines` is `4`, expected 2 lines of one element set"),
        ("15.72125391563537", "15.721", ", line 3: `line` is `2 25544"),
        ("1 25544U", "3 25544U", ", line 2: `line` is `3 25544U"),
        ("2 25544 ", "2 25545 ", ", line 3: `checksum` is `7`, expected 8"),
    ] {
        assert_message(&message(Tle::parse(Path::new("file"), &with(TLE, 0, from, to))), parts);
    }
}

#[test]
fn bad_kernels_are_refused() {
    let file = Path::new("file");
    assert_message(
        &message(Spk::parse(file, b"DAF/PCK ", None)),
        "not a readable SPK file: it does not begin with",
    );
    assert_message(&message(Spk::parse(file, b"DAF/SPK ", None)), "not a readable SPK file");
    // The first summary of a kernel of CSPICE: two times of eight bytes, then body, centre, frame and type of
    // four bytes each, after the record's 24 bytes.
    let kernel = std::fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/flight_dynamics/spice-type9.bsp"),
    )
    .unwrap();
    for (offset, value, parts) in [
        (4, 0_i32, "`centre of segment 1 of the file (body -200)` is `0`, expected 399, the Earth"),
        (8, 17, "`frame of segment 1 of the file (body -200)` is `17`, expected 1, J2000"),
        (12, 5, "`type of segment 1 of the file (body -200)` is `5`, expected one of 1, 2, 3"),
    ] {
        let mut changed = kernel.clone();
        let place = 1024 + 24 + 16 + offset;
        changed[place..place + 4].copy_from_slice(&value.to_le_bytes());
        assert_message(&message(Spk::parse(file, &changed, None)), parts);
    }
    let mut zeros = vec![0; 4096];
    zeros[..8].copy_from_slice(b"DAF/SPK ");
    assert_message(&message(Spk::parse(file, &zeros, None)), "not a readable SPK file");
}

#[test]
fn bad_xml_is_refused_with_its_line() {
    let file = Path::new("file");
    let xml = Oem::parse(file, OEM).unwrap().to_xml();
    let line_of = |part: &str| 1 + xml[..xml.find(part).unwrap()].matches('\n').count();
    let lines = xml.lines().count();
    for (from, to, parts) in [
        ("EME2000", "ITRF", format!(", line {}: `REF_FRAME` is `ITRF`", line_of("<REF_FRAME>"))),
        (
            "\"km\">7130",
            "\"m\">7130",
            format!(", line {}: `X` is `7130 [m]`, expected the unit km", line_of(">7130<")),
        ),
        (">7130<", ">NaN<", format!(", line {}: `X` is `NaN`, expected a finite number", line_of(">7130<"))),
        ("</body>", "", format!(", line {}: `XML` is `expected 'body' tag, not 'oem'", lines)),
        ("<oem ", "<!DOCTYPE x [<!ENTITY a \"b\">]><oem ", "not a readable OEM file: XML: ".to_owned()),
        (
            "stateVector>",
            "state>",
            format!(
                ", line {}: `XML` is `expected 'state' tag, not 'stateVector'",
                line_of("</stateVector>")
            ),
        ),
        ("version=\"2.0\"", "version=\"9\"", ", line 2: `CCSDS_OEM_VERS` is `9`".to_owned()),
        (
            "<X_DOT units=\"km/s\">0</X_DOT>",
            "",
            "`X_DOT` is `missing`, expected a value in the record `stateVector`".to_owned(),
        ),
    ] {
        assert_message(&message(Oem::parse(file, &with(&xml, 0, from, to))), &parts);
    }
    assert_message(&message(Aem::parse(file, &xml)), "its root element is `oem`, expected `aem`");
}

/// Every cut of an XML file is refused with the line at which it ends; the reader notices some cuts only at
/// the beginning of the last element.
#[test]
fn truncated_xml_is_refused_with_its_last_line() {
    let xml = Oem::parse(Path::new("file"), OEM).unwrap().to_xml();
    for end in (xml.find("<header>").unwrap()..xml.trim_end().len()).filter(|end| xml.is_char_boundary(*end))
    {
        let cut = &xml[..end];
        let message = message(Oem::parse(Path::new("file"), cut));
        let line = message.strip_prefix(", line ").and_then(|rest| rest.split(':').next());
        let line: usize = line.unwrap_or_else(|| panic!("{message}")).parse().unwrap();
        let last = cut.lines().count();
        assert!(line.abs_diff(last) <= 1, "{message} of {last} lines");
    }
    assert_message(
        &message(Oem::parse(Path::new("file"), &xml[..xml.find("<X_DOT").unwrap()])),
        "`end of file` is `missing`, expected </oem> before the end of the file: it is truncated",
    );
}

#[test]
fn deeply_nested_xml_does_not_exhaust_the_stack() {
    let text = format!(
        "<oem id=\"CCSDS_OEM_VERS\" version=\"2.0\">{}{}</oem>",
        "<a>".repeat(200_000),
        "</a>".repeat(200_000)
    );
    let _ = Oem::parse(Path::new("file"), &text);
    let inside =
        text.replace("<a>", "<body><segment><metadata>").replace("</a>", "</metadata></segment></body>");
    let _ = Oem::parse(Path::new("file"), &inside);
}
