//! `measurements.csv`: outcomes of the built-in or an external pipeline, one row per frame.

use std::borrow::Cow;
use std::path::Path;

use contract::{
    AttitudeSource, Camera, CameraFrame, Covariance2, Direction, Icrs, Measurement, NoSolution, OutOfRange,
    Outcome, PixelPoint, Rotation, Solution,
};
use files::{Atom, CsvLine, CsvReader, CsvRow, CsvWriter, FileError, optional, origin, table};

const POSITION: [&str; 2] = ["x_px", "y_px"];
const LINE_OF_SIGHT: [&str; 3] = ["los_j2000_x", "los_j2000_y", "los_j2000_z"];
const POSITION_COVARIANCE: [&str; 3] = ["sigma_x_px", "sigma_y_px", "correlation_xy"];
const LOG_ODDS: [&str; 1] = ["log_odds"];
const LINE_OF_SIGHT_COVARIANCE: [&str; 3] = ["sigma_ra_deg", "sigma_dec_deg", "correlation_ra_dec"];

table! {
    /// A row of `measurements.csv`.
    pub struct MeasurementLine: csv {
        /// number of the frame; ascending, each once
        frame: u64,
        /// `detected`; or the reason for no solution, in which case the position must be empty: `no_target`,
        /// `no_previous_frame`, `empty_frame`, `saturated_frame`, `failed`, `failed: ` and a reason
        status: String,
        /// centre of the target's image, on the detector (−0.5 to columns − 0.5, rows − 0.5)
        position: Option<PixelPoint> = POSITION,
        /// line of sight, unit vector within 1e-5; all three or none. Without it, the direction has no
        /// figures unless an attitude is supplied for the score
        line_of_sight: Option<Direction<Icrs>> = optional(LINE_OF_SIGHT),
        /// attitude of the camera, norm 1 within 1e-5; not scored
        camera_from_icrs: Option<Rotation<CameraFrame, Icrs>> =
            optional(["q_cam_j2000_w", "q_cam_j2000_x", "q_cam_j2000_y", "q_cam_j2000_z"]),
        /// source of the attitude: `stars`, `too_few_stars`, `no_stars`, `no_match`
        attitude: String = optional(["attitude"]),
        /// number of identified stars; empty if the pipeline does not report it
        n_stars: Option<u32> = optional(["n_stars"]),
        /// standard deviations of the centre along columns and rows, px, more than 0, and their correlation,
        /// above −1 and below 1; all three or none, and none unless `detected`
        position_covariance: Option<[f64; 3]> = optional(POSITION_COVARIANCE),
        /// standard deviations of the line of sight, degrees, and their correlation, with the same ranges,
        /// for its angles across columns ("RA") and rows ("Dec") in the camera, including the error of the
        /// attitude; none without a line of sight
        line_of_sight_covariance: Option<[f64; 3]> = optional(LINE_OF_SIGHT_COVARIANCE),
        /// natural logarithm of the odds p/(1 − p) that this is the target, with the probability p by the
        /// pipeline; none unless `detected`
        log_odds: Option<f64> = optional(LOG_ODDS),
    }
}

/// Status of a row with a target.
const DETECTED: &str = "detected";
/// Expected values in the message for an unknown status.
const STATUS: &str = "`detected`, `no_target`, `no_previous_frame`, `empty_frame`, `saturated_frame`, `failed`, or `failed: ` and a reason";

/// Writer of the table, row by row.
pub type MeasurementWriter = CsvWriter<MeasurementLine>;

impl MeasurementLine {
    /// Returns the row of the outcome of one frame. Its clusters have a separate table
    /// ([`crate::rows::FrameCluster`]).
    pub fn from_outcome(frame: u64, outcome: &Outcome) -> Self {
        let measurement = outcome.measurement();
        Self {
            frame,
            status: match &outcome.solution {
                Solution::Detected(_) => DETECTED.to_owned(),
                Solution::NoSolution(reason) => reason.to_string(),
            },
            position: measurement.map(|measurement| measurement.position),
            line_of_sight: measurement.and_then(|measurement| measurement.line_of_sight),
            camera_from_icrs: outcome.camera_from_icrs,
            attitude: outcome.attitude_source.map_or("", AttitudeSource::code).to_owned(),
            n_stars: outcome.n_stars,
            position_covariance: measurement
                .and_then(|measurement| measurement.position_covariance)
                .map(|covariance| [covariance.sigma_x(), covariance.sigma_y(), covariance.correlation()]),
            line_of_sight_covariance: measurement
                .and_then(|measurement| measurement.line_of_sight_covariance)
                .map(|covariance| covariance.degrees()),
            log_odds: measurement.and_then(|measurement| measurement.log_odds),
        }
    }
}

/// Returns the outcome as it would be read back from the file: the standard deviations of its line of sight
/// are converted twice, which may change their last bit. The score of a run is computed from these outcomes,
/// which makes it bit-identical to a score of the file.
pub fn outcome_as_filed(outcome: &Outcome) -> Cow<'_, Outcome> {
    let Solution::Detected(measurement) = &outcome.solution else { return Cow::Borrowed(outcome) };
    let Some(covariance) = measurement.line_of_sight_covariance else { return Cow::Borrowed(outcome) };
    // Standard deviations that underflow to 0 in the file have no covariance there.
    let line_of_sight_covariance = Covariance2::from_degrees(covariance.degrees()).ok();
    let solution = Solution::Detected(Measurement { line_of_sight_covariance, ..*measurement });
    Cow::Owned(Outcome { solution, ..outcome.clone() })
}

/// Reads the table: the outcome of each frame of `camera`, without clusters. Frame numbers ascend, with gaps
/// allowed. Values that the protocol of external pipelines rejects are rejected here too.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell.
pub fn read_measurements(path: &Path, camera: &Camera) -> Result<Vec<(u64, Outcome)>, FileError> {
    CsvReader::open_with::<MeasurementLine>(path, &origin::COLUMNS)?.read_rows(
        |row, previous: Option<&(u64, Outcome)>| {
            let reason = reason(row)?;
            let line = MeasurementLine::read(row)?;
            row.check_ascends("frame", line.frame, previous.map(|(frame, _)| *frame))?;
            Ok((line.frame, outcome(row, line, reason, camera)?))
        },
    )
}

/// Returns the reason why a row has no target; `None` for a detection.
fn reason(row: &CsvRow<'_>) -> Result<Option<NoSolution>, FileError> {
    let status = row.text("status");
    // Spaces next to a comma are allowed; line feeds and other control characters are not.
    if status.trim_matches(' ') == DETECTED {
        return Ok(None);
    }
    // The text after `failed: ` is kept verbatim.
    let reason =
        NoSolution::parse(status.trim_start_matches(' ')).ok_or_else(|| row.error("status", STATUS))?;
    let of_a_target =
        [POSITION.as_slice(), &LINE_OF_SIGHT, &POSITION_COVARIANCE, &LINE_OF_SIGHT_COVARIANCE, &LOG_ODDS];
    row.check_empty(of_a_target.into_iter().flatten().copied())?;
    Ok(Some(reason))
}

/// Returns the covariance in the cells of three columns, if present.
fn covariance(
    row: &CsvRow<'_>,
    [sigma_x, sigma_y, correlation]: [&'static str; 3],
    stated: Option<Result<Covariance2, OutOfRange>>,
) -> Result<Option<Covariance2>, FileError> {
    stated.transpose().map_err(|wrong| {
        let column = match wrong.path.as_str() {
            "sigma_x" => sigma_x,
            "sigma_y" => sigma_y,
            _ => correlation,
        };
        row.error(column, wrong.expected)
    })
}

fn outcome(
    row: &CsvRow<'_>,
    line: MeasurementLine,
    reason: Option<NoSolution>,
    &Camera { columns, rows, .. }: &Camera,
) -> Result<Outcome, FileError> {
    let attitude_source = match line.attitude.trim() {
        "" => None,
        code => Some(AttitudeSource::parse(code).ok_or_else(|| {
            row.error("attitude", "`stars`, `too_few_stars`, `no_stars`, `no_match` or an empty cell")
        })?),
    };
    let solution = match reason {
        Some(reason) => Solution::NoSolution(reason),
        None => {
            let position = line.position.ok_or_else(|| row.error(POSITION[0], f64::EXPECTED))?;
            if !position.is_on_detector(columns, rows) {
                let is_x = !PixelPoint::new(position.x, 0.0).is_on_detector(columns, rows);
                let (column, count) = if is_x { (POSITION[0], columns) } else { (POSITION[1], rows) };
                let expected = format!(
                    "a position on the detector of {columns} × {rows} pixels, -0.5 to {}",
                    count as f64 - 0.5
                );
                return Err(row.error(column, expected));
            }
            let of_position = line
                .position_covariance
                .map(|[x, y, correlation]| Covariance2::from_sigmas(x, y, correlation));
            let of_line_of_sight = line.line_of_sight_covariance.map(Covariance2::from_degrees);
            if of_line_of_sight.is_some() && line.line_of_sight.is_none() {
                let expected = "an empty cell, because the row has no line of sight";
                return Err(row.error(LINE_OF_SIGHT_COVARIANCE[0], expected));
            }
            Solution::Detected(Measurement {
                position,
                position_covariance: covariance(row, POSITION_COVARIANCE, of_position)?,
                line_of_sight: line.line_of_sight,
                line_of_sight_covariance: covariance(row, LINE_OF_SIGHT_COVARIANCE, of_line_of_sight)?,
                log_odds: line.log_odds,
            })
        }
    };
    Ok(Outcome {
        solution,
        camera_from_icrs: line.camera_from_icrs,
        attitude_source,
        n_stars: line.n_stars,
        clusters: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use contract::Direction;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use tempfile::tempdir;

    use super::*;

    /// Camera of Table 1 of the far-range paper.
    fn camera() -> Camera {
        Camera {
            columns: 752,
            rows: 580,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 395.0,
            principal_y_px: 288.0,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [0.0; 2],
        }
    }

    fn read(text: &str) -> Result<Vec<(u64, Outcome)>, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("measurements.csv");
        fs::write(&path, text).unwrap();
        read_measurements(&path, &camera())
    }

    fn check_refused(text: &str, line: &str, column: &str) {
        let message = read(text).unwrap_err().to_string();
        assert!(message.contains(line) && message.contains(&format!("`{column}`")), "{message}");
    }

    #[test]
    fn four_columns_are_enough() {
        let outcomes = read("frame,status,x_px,y_px\n3,detected,1.5,2\n9,no_target,,\n").unwrap();
        assert_eq!(outcomes[0].1.measurement().unwrap().position, PixelPoint::new(1.5, 2.0));
        assert_eq!(outcomes[1], (9, Outcome::without_solution(NoSolution::NoTarget)));
    }

    #[test]
    fn each_bad_cell_is_named_by_line_and_column() {
        let header = "frame,status,x_px,y_px,los_j2000_x,los_j2000_y,los_j2000_z,attitude,n_stars";
        let check = |row: &str, column| check_refused(&format!("{header}\n{row}\n"), "line 2", column);
        check("1,detected,,2,,,,,", "x_px");
        check("1,detected,1,NaN,,,,,", "y_px");
        check("1,detected,1,2,1,1,0,,", "los_j2000_x");
        check("1,detected,1,2,1,,0,,", "los_j2000_y");
        check("1,detected,1,2,,,,sun,", "attitude");
        check("1,detected,1,2,,,,,-3", "n_stars");
        check("1,,1,2,,,,,", "status");
        check("-1,detected,1,2,,,,,", "frame");
        check_refused("frame,status,x_px,y_px\n1,no_target,,\n1,no_target,,\n", "line 3", "frame");
    }

    #[test]
    fn a_covariance_is_read_in_the_units_of_its_columns() {
        let header = "frame,status,x_px,y_px,los_j2000_x,los_j2000_y,los_j2000_z,sigma_x_px,sigma_y_px,correlation_xy,\
                      sigma_ra_deg,sigma_dec_deg,correlation_ra_dec";
        let outcomes = read(&format!(
            "{header}\n1,detected,1,2,0,0,1,0.25,0.5,-0.5,180,90,0\n2,detected,1,2,,,,,,,,,\n"
        ))
        .unwrap();
        let measurement = outcomes[0].1.measurement().unwrap();
        assert_eq!(measurement.position_covariance.unwrap().matrix(), [0.0625, -0.0625, 0.25]);
        let [ra, both, dec] = measurement.line_of_sight_covariance.unwrap().matrix();
        let pi = std::f64::consts::PI;
        assert_eq!((ra, both, dec), (pi * pi, 0.0, pi * pi / 4.0));
        assert_eq!(outcomes[1].1.measurement(), Some(&Measurement::new(PixelPoint::new(1.0, 2.0), None)));
    }

    #[test]
    fn an_invalid_covariance_is_refused_by_its_column() {
        let header = "frame,status,x_px,y_px,sigma_x_px,sigma_y_px,correlation_xy,los_j2000_x,los_j2000_y,los_j2000_z,\
                      sigma_ra_deg,sigma_dec_deg,correlation_ra_dec";
        let check = |row: &str, column| check_refused(&format!("{header}\n1,{row}\n"), "line 2", column);
        check("detected,1,2,0,1,0,,,,,,", "sigma_x_px");
        check("detected,1,2,1,-1,0,,,,,,", "sigma_y_px");
        check("detected,1,2,1,inf,0,,,,,,", "sigma_y_px");
        check("detected,1,2,1,1,1,,,,,,", "correlation_xy");
        check("detected,1,2,1,1,-1,,,,,,", "correlation_xy");
        check("detected,1,2,1,1,,,,,,,", "correlation_xy");
        check("detected,1,2,,1,0,,,,,,", "sigma_x_px");
        check("detected,1,2,,,,0,0,1,1,0,0", "sigma_dec_deg");
        check("detected,1,2,,,,0,0,1,1e-323,1,0", "sigma_ra_deg");
        check("detected,1,2,,,,0,0,1,1,1,1.5", "correlation_ra_dec");
        check("detected,1,2,,,,0,0,1,1,,0", "sigma_dec_deg");
        check("detected,1,2,,,,,,,1,1,0", "sigma_ra_deg");
        check("no_target,,,1,1,0,,,,,,", "sigma_x_px");
        check("no_target,,,,,,,,,,,0", "correlation_ra_dec");
    }

    /// Same rules as in the protocol of external pipelines: otherwise an unknown status would count as a
    /// miss, and a position off the detector as a detection.
    #[test]
    fn forbidden_answers_of_an_external_pipeline_are_refused() {
        let check = |row: &str, column| {
            check_refused(&format!("frame,status,x_px,y_px\n1,no_target,,\n{row}\n"), "line 3", column)
        };
        check("2,Detected,1,2", "status");
        for status in ["ok", "Detected", "no target", "no_target ", "failed:", "failure", "none"] {
            check(&format!("2,{status},,"), "status");
        }
        check("2,detected,4000,4", "x_px");
        check("2,detected,4,4000", "y_px");
        check("2,detected,-0.51,4", "x_px");
        check("2,no_target,4,4", "x_px");
        assert!(read("frame,status,x_px,y_px\n1, detected,-0.5,579.5\n2,failed,,\n").is_ok());
    }

    #[test]
    fn a_misspelt_column_is_refused() {
        let message = read("frame,status,x_px,y_px,los_j2000_X\n").unwrap_err().to_string();
        assert!(message.contains("did you mean `los_j2000_x`"), "{message}");
    }

    fn any_outcome() -> impl Strategy<Value = Outcome> {
        let reason = prop_oneof![
            Just(NoSolution::EmptyFrame),
            Just(NoSolution::SaturatedFrame),
            Just(NoSolution::NoPreviousFrame),
            Just(NoSolution::NoTarget),
            "\\PC{0,20}".prop_map(NoSolution::Failed),
        ];
        let vector = || prop::array::uniform3(0.1..3.0_f64).prop_map(Vector3::from);
        let covariance = || {
            let sigma = || 1e-9..1e3_f64;
            let stated = (sigma(), sigma(), -0.999..0.999_f64);
            prop::option::of(stated.prop_map(|(x, y, rho)| Covariance2::from_sigmas(x, y, rho).unwrap()))
        };
        let detected =
            (-0.5..750.5_f64, any::<f64>(), covariance(), prop::option::of((vector(), covariance())))
                .prop_map(|(x, y, position_covariance, los)| {
                    let line_of_sight = los.map(|(vector, _)| Direction::from_vector(vector).unwrap());
                    Solution::Detected(Measurement {
                        position: PixelPoint::new(x, if (-0.5..=579.5).contains(&y) { y } else { -0.0 }),
                        position_covariance,
                        log_odds: position_covariance.map(|covariance| covariance.sigma_x() - 7.5),
                        line_of_sight,
                        line_of_sight_covariance: los.and_then(|(_, covariance)| covariance),
                    })
                });
        let solution = prop_oneof![detected, reason.prop_map(Solution::NoSolution)];
        let source = prop::option::of(prop_oneof![
            Just(AttitudeSource::Stars),
            Just(AttitudeSource::RescaledStars),
            Just(AttitudeSource::TooFewStars),
            Just(AttitudeSource::NoStars),
            Just(AttitudeSource::NoMatch),
        ]);
        (solution, prop::option::of(vector()), source, prop::option::of(any::<u32>())).prop_map(
            |(solution, axis, attitude_source, n_stars)| Outcome {
                solution,
                camera_from_icrs: axis.map(Rotation::from_rotation_vector),
                attitude_source,
                n_stars,
                clusters: Vec::new(),
            },
        )
    }

    proptest! {
        #[test]
        fn every_bit_round_trips(outcomes in prop::collection::vec(any_outcome(), 0..6)) {
            let directory = tempdir().unwrap();
            let path = directory.path().join("measurements.csv");
            let mut writer = MeasurementWriter::create(&path).unwrap();
            let rows: Vec<_> = (0..).map(|n: u64| n * 7).zip(outcomes).collect();
            rows.iter().for_each(|(frame, outcome)| writer.line(&MeasurementLine::from_outcome(*frame, outcome)).unwrap());
            writer.finish().unwrap();
            let filed = |(frame, outcome): &(u64, Outcome)| (*frame, outcome_as_filed(outcome).into_owned());
            let filed: Vec<_> = rows.iter().map(filed).collect();
            prop_assert_eq!(read_measurements(&path, &camera()).unwrap(), filed);
        }
    }
}
