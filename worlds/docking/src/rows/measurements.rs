//! `measurements.csv` of a docking run: outcomes of the built-in or an external pipeline, one row per field.

use std::path::Path;

use contract::docking::{
    DockingOutcome, DockingSolution, FailedCheck, Features, FieldMeasurement, NoPose, PoseEstimate,
};
use files::{Atom, CsvLine, CsvReader, CsvRow, CsvWriter, FileError, optional, origin, table};
use nalgebra::{Matrix6, Vector3, Vector6};

use super::covariance::{self, CELLS};
use super::pose::{self, POSE, PoseCells};

const SIGMA: [&str; 6] =
    ["sigma_d1_m", "sigma_d2_m", "sigma_d3_m", "sigma_phi1_deg", "sigma_phi2_deg", "sigma_phi3_deg"];
/// Columns of a range without a pose, and of its standard deviation.
const RANGE: [&str; 2] = ["range_m", "sigma_range_m"];
const COVARIANCE: [&str; CELLS] = [
    "cov_d1_d1_m2",
    "cov_d1_d2_m2",
    "cov_d1_d3_m2",
    "cov_d1_phi1_m_deg",
    "cov_d1_phi2_m_deg",
    "cov_d1_phi3_m_deg",
    "cov_d2_d2_m2",
    "cov_d2_d3_m2",
    "cov_d2_phi1_m_deg",
    "cov_d2_phi2_m_deg",
    "cov_d2_phi3_m_deg",
    "cov_d3_d3_m2",
    "cov_d3_phi1_m_deg",
    "cov_d3_phi2_m_deg",
    "cov_d3_phi3_m_deg",
    "cov_phi1_phi1_deg2",
    "cov_phi1_phi2_deg2",
    "cov_phi1_phi3_deg2",
    "cov_phi2_phi2_deg2",
    "cov_phi2_phi3_deg2",
    "cov_phi3_phi3_deg2",
];

table! {
    /// A row of `measurements.csv`.
    pub struct FieldMeasurementLine: csv {
        /// number of the field; ascending, each once
        field: u64,
        /// `measured`; `range_only`; `doubtful: residuals`, `doubtful: features`, `doubtful: motion`,
        /// `doubtful: unconfirmed`, `doubtful: repeated`: measured, but not to be relied on; or the reason
        /// for no solution: `empty_field`, `saturated_field`, `no_target`, `ambiguous_target`,
        /// `out_of_field`, `too_few_features`, `inconsistent`, `failed`, `failed: ` and a reason
        status: String,
        /// pose; empty unless `measured` or doubtful
        pose: Option<PoseCells> = POSE,
        /// standard deviations; all six or none
        sigma: Option<[f64; 6]> = optional(SIGMA),
        /// d3 of `range_only`
        range_m: Option<f64> = optional([RANGE[0]]),
        /// standard deviation of d3 of `range_only`
        sigma_range_m: Option<f64> = optional([RANGE[1]]),
        /// upper triangle of the covariance; all or none; without it the errors are assumed to be
        /// uncorrelated
        covariance: Option<[f64; CELLS]> = optional(COVARIANCE),
        /// pose by the paper's formulas; all six or none
        paper: Option<PoseCells> =
            optional(["paper_d1_m", "paper_d2_m", "paper_d3_m", "paper_phi1_deg", "paper_phi2_deg", "paper_phi3_deg"]),
    }
}

/// Status of a row with a pose.
const MEASURED: &str = "measured";
/// Status of a row with a range but no pose.
const RANGE_ONLY: &str = "range_only";
/// Expected values in the message for an unknown status.
const STATUS: &str = "`measured`, `range_only`, `doubtful: residuals`, `doubtful: features`, `doubtful: motion`, `doubtful: unconfirmed`, `doubtful: repeated`, `empty_field`, `saturated_field`, `no_target`, `ambiguous_target`, \
                      `out_of_field`, `too_few_features`, `inconsistent`, `failed`, or `failed: ` and a reason";

/// Factors that convert metres and radians to metres and degrees.
fn scale() -> Vector6<f64> {
    let degrees = 1.0_f64.to_degrees();
    Vector6::new(1.0, 1.0, 1.0, degrees, degrees, degrees)
}

/// Writer of the table, row by row.
pub type FieldMeasurementWriter = CsvWriter<FieldMeasurementLine>;

impl FieldMeasurementLine {
    /// Returns the row of the outcome of one field. Features and motion have separate tables.
    pub fn from_outcome(field: u64, outcome: &DockingOutcome) -> Self {
        let (status, range) = match &outcome.solution {
            DockingSolution::Measured(_) => (MEASURED.to_owned(), None),
            DockingSolution::Doubtful { doubt, .. } => (doubt.to_string(), None),
            DockingSolution::RangeOnly { range_m, sigma_m } => {
                (RANGE_ONLY.to_owned(), Some((*range_m, *sigma_m)))
            }
            DockingSolution::NoSolution(reason) => (reason.to_string(), None),
        };
        let measurement = outcome.any_measurement();
        let best = measurement.map(|measurement| &measurement.best);
        let sigma = |covariance: &Matrix6<f64>| {
            covariance.diagonal().map(|variance| variance.max(0.0).sqrt()).component_mul(&scale()).into()
        };
        Self {
            field,
            status,
            pose: best.map(|best| PoseCells(best.pose)),
            sigma: best.map(|best| sigma(&best.covariance)),
            range_m: range.map(|(range_m, _)| range_m),
            sigma_range_m: range.map(|(_, sigma_m)| sigma_m),
            covariance: best.map(|best| covariance::to_cells(&best.covariance, &scale())),
            paper: measurement.and_then(|measurement| measurement.paper).map(PoseCells),
        }
    }
}

/// Returns the outcome as it would be read back from the file, without features and motion: angles are
/// converted twice, which may change their last bit. The score of a run is computed from these outcomes,
/// which makes it bit-identical to a score of the files.
pub fn outcome_as_filed(outcome: &DockingOutcome) -> DockingOutcome {
    let as_filed = |measurement: &FieldMeasurement| {
        Box::new(FieldMeasurement {
            best: PoseEstimate {
                pose: pose::as_filed(&measurement.best.pose),
                covariance: covariance::as_filed(&measurement.best.covariance, &scale()),
            },
            paper: measurement.paper.as_ref().map(pose::as_filed),
        })
    };
    let solution = match &outcome.solution {
        DockingSolution::Measured(measurement) => DockingSolution::Measured(as_filed(measurement)),
        DockingSolution::Doubtful { measurement, doubt } => {
            DockingSolution::Doubtful { measurement: as_filed(measurement), doubt: *doubt }
        }
        other => other.clone(),
    };
    DockingOutcome { solution, features: Features::default(), motion: None, digitiser: None }
}

/// Reads the table: the outcome of each field, without features and motion. Field numbers ascend, with gaps
/// allowed.
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell.
pub fn read_field_measurements(path: &Path) -> Result<Vec<(u64, DockingOutcome)>, FileError> {
    let table = CsvReader::open_with::<FieldMeasurementLine>(path, &origin::COLUMNS)?;
    table.read_rows(|row, previous: Option<&(u64, DockingOutcome)>| {
        let field = row.cell("field")?;
        row.check_ascends("field", field, previous.map(|(field, _)| *field))?;
        let solution = solution(row)?;
        Ok((field, DockingOutcome { solution, features: Features::default(), motion: None, digitiser: None }))
    })
}

fn solution(row: &CsvRow<'_>) -> Result<DockingSolution, FileError> {
    let status = row.text("status");
    match status.trim() {
        MEASURED => Ok(DockingSolution::Measured(measurement(row)?)),
        RANGE_ONLY => {
            row.check_empty(POSE)?;
            let range_m = row.cell(RANGE[0])?;
            if range_m <= 0.0 {
                return Err(row.error(RANGE[0], "greater than 0"));
            }
            let has_sigma = !row.text(RANGE[1]).trim().is_empty();
            let sigma_m = if has_sigma { row.cell(RANGE[1])? } else { 0.0 };
            if sigma_m < 0.0 {
                return Err(row.error(RANGE[1], "0 or greater"));
            }
            Ok(DockingSolution::RangeOnly { range_m, sigma_m })
        }
        text if let Ok(doubt) = text.parse::<FailedCheck>() => {
            Ok(DockingSolution::Doubtful { measurement: measurement(row)?, doubt })
        }
        _ => {
            // The text after `failed: ` is kept verbatim.
            let reason = NoPose::parse(status.trim_start()).ok_or_else(|| row.error("status", STATUS))?;
            row.check_empty(POSE)?;
            row.check_empty(RANGE)?;
            Ok(DockingSolution::NoSolution(reason))
        }
    }
}

/// Reads the measurement of a row with a pose.
fn measurement(row: &CsvRow<'_>) -> Result<Box<FieldMeasurement>, FileError> {
    row.check_empty(RANGE)?;
    let line = FieldMeasurementLine::read(row)?;
    let PoseCells(pose) = line.pose.ok_or_else(|| row.error(POSE[0], f64::EXPECTED))?;
    if pose.position_m == Vector3::zeros() {
        return Err(row.error(POSE[2], "a camera that is not inside the target"));
    }
    let best = PoseEstimate { pose, covariance: covariance(row, &line)? };
    Ok(Box::new(FieldMeasurement { best, paper: line.paper.map(|cells| cells.0) }))
}

/// Returns the covariance of a row. Without covariance cells, it is the diagonal matrix of the standard
/// deviations; without standard deviations, it is zero, which means unknown.
fn covariance(row: &CsvRow<'_>, line: &FieldMeasurementLine) -> Result<Matrix6<f64>, FileError> {
    row.check_sigmas(SIGMA, line.sigma)?;
    if let Some(covariance) = covariance::from_cells(row, COVARIANCE, line.covariance, &scale())? {
        return Ok(covariance);
    }
    let sigmas = Vector6::from(line.sigma.unwrap_or_default()).component_div(&scale());
    Ok(Matrix6::from_diagonal(&sigmas.component_mul(&sigmas)))
}

#[cfg(test)]
mod tests {
    use contract::docking::Pose;
    use std::fs;

    use tempfile::tempdir;

    use super::*;

    fn read(text: &str) -> Result<Vec<(u64, DockingOutcome)>, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("measurements.csv");
        fs::write(&path, text).unwrap();
        read_field_measurements(&path)
    }

    fn outcome(solution: DockingSolution) -> DockingOutcome {
        DockingOutcome { solution, features: Features::default(), motion: None, digitiser: None }
    }

    fn measured_outcome() -> DockingOutcome {
        let pose = Pose {
            position_m: Vector3::new(0.1, -0.2, 7.0),
            phi_rad: Vector3::new(0.011, -0.013, 1.0 / 7.0),
        };
        let root = Matrix6::from_fn(|i, j| if i == j { 0.01 } else { 0.001 * (i + j) as f64 });
        let best = PoseEstimate { pose, covariance: root * root.transpose() };
        let paper = Some(Pose { position_m: Vector3::new(0.1, -0.2, 7.1), ..pose });
        outcome(DockingSolution::Measured(Box::new(FieldMeasurement { best, paper })))
    }

    fn doubtful_outcome(doubt: FailedCheck) -> DockingOutcome {
        let DockingSolution::Measured(measurement) = measured_outcome().solution else {
            unreachable!("it is measured")
        };
        outcome(DockingSolution::Doubtful { measurement, doubt })
    }

    fn write(path: &Path, answers: &[(u64, DockingOutcome)]) {
        let mut writer = FieldMeasurementWriter::create(path).unwrap();
        answers.iter().for_each(|(field, outcome)| {
            writer.line(&FieldMeasurementLine::from_outcome(*field, outcome)).unwrap()
        });
        writer.finish().unwrap();
    }

    #[test]
    fn every_status_round_trips_as_filed() {
        let answers: Vec<(u64, DockingOutcome)> = [
            measured_outcome(),
            outcome(DockingSolution::RangeOnly { range_m: 312.5, sigma_m: 2.0 }),
            DockingOutcome::without_pose(NoPose::TooFewFeatures),
            doubtful_outcome(FailedCheck::Residuals),
            doubtful_outcome(FailedCheck::Repeated),
            DockingOutcome::without_pose(NoPose::Failed("out of film, twice".to_owned())),
        ]
        .into_iter()
        .enumerate()
        .map(|(i, outcome)| (2 * i as u64, outcome))
        .collect();
        let directory = tempdir().unwrap();
        let path = directory.path().join("a.csv");
        write(&path, &answers);
        let read = read_field_measurements(&path).unwrap();
        assert_eq!(read[1..3], answers[1..3]);
        for ((_, read), (_, written)) in read.iter().zip(&answers) {
            assert_eq!(*read, outcome_as_filed(written));
        }
        let (met, meant) = (read[0].1.measurement().unwrap(), measured_outcome());
        let meant = meant.measurement().unwrap();
        assert_eq!(met.best.pose.position_m, meant.best.pose.position_m);
        assert!((met.best.pose.phi_rad - meant.best.pose.phi_rad).norm() < 1e-16);
        assert!((met.best.covariance - meant.best.covariance).norm() < 1e-18);
        assert_eq!(met.paper.unwrap().position_m, meant.paper.unwrap().position_m);
    }

    const HEADER: &str = "field,status,d1_m,d2_m,d3_m,phi1_deg,phi2_deg,phi3_deg";

    #[test]
    fn eight_columns_are_enough_and_then_the_covariance_is_zero() {
        let answers = read(&format!("{HEADER}\n3,measured,0.1,0,5,0,0,90\n9,no_target,,,,,,\n")).unwrap();
        let best = &answers[0].1.measurement().unwrap().best;
        assert_eq!(best.pose.phi_rad.z, std::f64::consts::FRAC_PI_2);
        assert_eq!(best.covariance, Matrix6::zeros());
        assert_eq!(answers[1], (9, DockingOutcome::without_pose(NoPose::NoTarget)));
    }

    #[test]
    fn standard_deviations_alone_make_a_diagonal() {
        let header = format!("{HEADER},{}", SIGMA.join(","));
        let answers = read(&format!("{header}\n3,measured,0,0,5,0,0,0,0.1,0.1,0.2,180,180,180\n")).unwrap();
        let covariance = answers[0].1.measurement().unwrap().best.covariance;
        assert!((covariance[(2, 2)] - 0.04).abs() < 1e-16 && covariance[(0, 1)] == 0.0);
        assert!((covariance[(5, 5)].sqrt() - std::f64::consts::PI).abs() < 1e-15);
    }

    #[test]
    fn each_bad_cell_is_named_by_line_and_column() {
        let header = format!("{HEADER},range_m,sigma_range_m,{}", SIGMA.join(","));
        for (row, column) in [
            ("0,measured,,0,5,0,0,0,,,,,,,,", "d1_m"),
            ("0,measured,0,0,inf,0,0,0,,,,,,,,", "d3_m"),
            ("0,measured,0,0,0,0,0,0,,,,,,,,", "d3_m"),
            ("0,measured,0,0,5,0,0,0,5,,,,,,,", "range_m"),
            ("0,measured,0,0,5,0,0,0,,,1,1,,1,1,1", "sigma_d3_m"),
            ("0,measured,0,0,5,0,0,0,,,1,1,-1,1,1,1", "sigma_d3_m"),
            ("0,range_only,,,,,,,,,,,,,,", "range_m"),
            ("0,range_only,,,,,,,9,-1,,,,,,", "sigma_range_m"),
            ("0,range_only,,,5,,,,9,1,,,,,,", "d3_m"),
            ("0,Measured,0,0,5,0,0,0,,,,,,,,", "status"),
            ("0,ok,,,,,,,,,,,,,,", "status"),
            ("0,doubtful,0,0,5,0,0,0,,,,,,,,", "status"),
            ("0,doubtful: mood,0,0,5,0,0,0,,,,,,,,", "status"),
            ("0,doubtful: motion,,0,5,0,0,0,,,,,,,,", "d1_m"),
            ("0,doubtful: motion,0,0,5,0,0,0,5,,,,,,,", "range_m"),
            ("0,no_target,,,5,,,,,,,,,,,", "d3_m"),
            ("0,range_only,,,,,,,0,1,,,,,,", "range_m"),
            ("0,,0,0,5,0,0,0,,,,,,,,", "status"),
            ("x,no_target,,,,,,,,,,,,,,", "field"),
        ] {
            let message = read(&format!("{header}\n{row}\n")).unwrap_err().to_string();
            assert!(
                message.contains("line 2") && message.contains(&format!("`{column}`")),
                "{row}: {message}"
            );
        }
    }

    #[test]
    fn a_far_range_table_is_recognised_by_its_columns() {
        let message = read("frame,status,x_px,y_px\n1,no_target,,\n").unwrap_err().to_string();
        assert!(message.contains("unknown column `frame`"), "{message}");
    }
}
