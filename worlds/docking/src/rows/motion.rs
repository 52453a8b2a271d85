//! `motion.csv`: the motion that a pipeline reports at the end of each portion. Figures 5 and 6 of the
//! docking paper are these rows plotted against time.

use std::path::Path;

use contract::docking::{Motion, MotionReport, Pose};
use files::{CsvLine, CsvReader, CsvRow, CsvWriter, FileError, optional, table};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::covariance::{self, CELLS, upper_triangle};
use super::pose::{self, angle_as_filed};
use crate::scoring::ApproachParameters;

const SIGMA: [&str; 7] = [
    "sigma_rho_m",
    "sigma_u_m_s",
    "sigma_alpha_deg",
    "sigma_beta_deg",
    "sigma_phi1_deg",
    "sigma_phi2_deg",
    "sigma_phi3_deg",
];
const POSITION: [&str; CELLS] = upper_triangle!("d1" "d2" "d3" "d1_rate" "d2_rate" "d3_rate");
const ATTITUDE: [&str; CELLS] = upper_triangle!("phi1" "phi2" "phi3" "phi1_rate" "phi2_rate" "phi3_rate");

table! {
    /// A row of `motion.csv`.
    pub struct MotionLine: csv {
        /// number of the field with which the motion is reported; ascending
        field: u64,
        /// `best` or `paper`; `paper` follows the `best` row of its field, or stands without it if the best
        /// estimator gave no motion; `best` when empty
        estimator: String = optional(["estimator"]),
        /// time, s since the beginning of the sequence
        time_s: f64,
        /// number of measured fields in the portion
        fields: Option<u32> = optional(["fields"]),
        /// ρ, u, α, β and φ, the parameters of figures 5 and 6 of the docking paper
        shown: [f64; 7] = ["rho_m", "u_m_s", "alpha_deg", "beta_deg", "phi1_deg", "phi2_deg", "phi3_deg"],
        /// standard deviations of ρ, u, α, β and φ; all or none
        sigma: Option<[f64; 7]> = optional(SIGMA),
        /// position, velocity and rates of φ; all or none
        state: Option<[f64; 9]> = optional([
    "d1_m",
    "d2_m",
    "d3_m",
    "d1_rate_m_s",
    "d2_rate_m_s",
    "d3_rate_m_s",
    "phi1_rate_deg_s",
    "phi2_rate_deg_s",
    "phi3_rate_deg_s",
]),
        /// upper triangle of the covariance of (d, d'), in m and s; all or none
        position_covariance: Option<[f64; CELLS]> = optional(POSITION),
        /// upper triangle of the covariance of (φ, φ'), in degrees and s; all or none
        attitude_covariance: Option<[f64; CELLS]> = optional(ATTITUDE),
        /// covariance of (d, φ), in m and degrees; all or none
        cross_covariance: Option<[f64; 9]> = optional([
    "cov_d1_phi1",
    "cov_d1_phi2",
    "cov_d1_phi3",
    "cov_d2_phi1",
    "cov_d2_phi2",
    "cov_d2_phi3",
    "cov_d3_phi1",
    "cov_d3_phi2",
    "cov_d3_phi3",
]),
    }
}

/// Name of the pipeline's best estimator, also assumed for an empty cell.
const BEST: &str = "best";
/// Name of the estimator that uses the paper's formulas.
const PAPER: &str = "paper";

/// Factors that convert radians to degrees, for six values that are all angles.
fn degrees() -> Vector6<f64> {
    Vector6::repeat(1.0_f64.to_degrees())
}

/// Writer of the table, row by row.
pub type MotionWriter = CsvWriter<MotionLine>;

impl MotionLine {
    /// Returns the rows of the report of a field: one for each estimator that gave a motion.
    pub fn from_report(field: u64, report: &MotionReport) -> Vec<Self> {
        let mut rows = Vec::new();
        for (estimator, motion) in [(BEST, &report.best), (PAPER, &report.paper)] {
            if let Some(motion) = motion {
                rows.push(line(field, estimator, motion));
            }
        }
        rows
    }
}

fn line(field: u64, estimator: &str, motion: &Motion) -> MotionLine {
    let shown = ApproachParameters::from_motion(&motion.pose, &motion.velocity_m_s);
    let phi_deg = shown.phi_rad.map(f64::to_degrees);
    let (d, v) = (&motion.pose.position_m, &motion.velocity_m_s);
    let phi_rate = motion.phi_rate_rad_s.map(f64::to_degrees);
    // Cells are stored row by row; the matrix is stored column by column.
    let cross: [[f64; 3]; 3] = motion.cross_covariance.map(f64::to_degrees).transpose().into();
    let [[c11, c12, c13], [c21, c22, c23], [c31, c32, c33]] = cross;
    MotionLine {
        field,
        estimator: estimator.to_owned(),
        time_s: motion.time_s,
        fields: Some(motion.fields),
        shown: [
            shown.rho_m,
            shown.u_m_s,
            shown.alpha_rad.to_degrees(),
            shown.beta_rad.to_degrees(),
            phi_deg.x,
            phi_deg.y,
            phi_deg.z,
        ],
        sigma: ApproachParameters::sigmas(motion).map(|mut sigmas| {
            sigmas.iter_mut().skip(2).for_each(|sigma| *sigma = sigma.to_degrees());
            sigmas
        }),
        state: Some([d.x, d.y, d.z, v.x, v.y, v.z, phi_rate.x, phi_rate.y, phi_rate.z]),
        position_covariance: Some(covariance::to_cells(&motion.position_covariance, &Vector6::repeat(1.0))),
        attitude_covariance: Some(covariance::to_cells(&motion.attitude_covariance, &degrees())),
        cross_covariance: Some([c11, c12, c13, c21, c22, c23, c31, c32, c33]),
    }
}

/// Returns the report as it would be read back from the file, like [`super::outcome_as_filed`].
pub fn report_as_filed(report: &MotionReport) -> MotionReport {
    let motion = |motion: &Motion| Motion {
        pose: pose::as_filed(&motion.pose),
        phi_rate_rad_s: motion.phi_rate_rad_s.map(angle_as_filed),
        position_covariance: covariance::as_filed(&motion.position_covariance, &Vector6::repeat(1.0)),
        attitude_covariance: covariance::as_filed(&motion.attitude_covariance, &degrees()),
        cross_covariance: motion.cross_covariance.map(angle_as_filed),
        ..*motion
    };
    MotionReport { best: report.best.as_ref().map(motion), paper: report.paper.as_ref().map(motion) }
}

/// Reads the table: the motion report of each field that has one. Field numbers ascend.
///
/// For a row without state columns, the position is computed from ρ, α and β, and the velocity is assumed to
/// be along the line of sight. For a row without covariances, the covariances reproduce the standard
/// deviations and contain no other information (they are singular).
///
/// # Errors
/// A [`FileError`] that names line and column of the first invalid cell.
pub fn read_motion(path: &Path) -> Result<Vec<(u64, MotionReport)>, FileError> {
    let mut table = CsvReader::open::<MotionLine>(path)?;
    let mut reports: Vec<(u64, MotionReport)> = Vec::new();
    while let Some(row) = table.next_row()? {
        let line = MotionLine::read(&row)?;
        let motion = Some(motion(&row, &line)?);
        let report = match line.estimator.trim() {
            "" | BEST => MotionReport { best: motion, paper: None },
            PAPER => {
                if let Some((_, report)) = reports.last_mut().filter(|(last, _)| *last == line.field) {
                    if report.paper.is_some() {
                        return Err(row.error("estimator", "each estimator once per field"));
                    }
                    report.paper = motion;
                    continue;
                }
                MotionReport { best: None, paper: motion }
            }
            _ => return Err(row.error("estimator", "`best`, or `paper` after `best`")),
        };
        row.check_ascends("field", line.field, reports.last().map(|(field, _)| *field))?;
        reports.push((line.field, report));
    }
    Ok(reports)
}

fn motion(row: &CsvRow<'_>, line: &MotionLine) -> Result<Motion, FileError> {
    let [rho, u, alpha, beta, phi1, phi2, phi3] = line.shown;
    if rho <= 0.0 {
        return Err(row.error("rho_m", "greater than 0"));
    }
    let (alpha, beta) = (alpha.to_radians(), beta.to_radians());
    row.check_sigmas(SIGMA, line.sigma)?;
    let towards = Vector3::new(
        libm::cos(alpha) * libm::sin(beta),
        libm::sin(alpha),
        libm::cos(alpha) * libm::cos(beta),
    );
    let (position_m, velocity_m_s, phi_rate_rad_s) = match line.state {
        None => (towards * rho, towards * u, Vector3::zeros()),
        Some([d1, d2, d3, v1, v2, v3, w1, w2, w3]) => (
            Vector3::new(d1, d2, d3),
            Vector3::new(v1, v2, v3),
            Vector3::new(w1, w2, w3).map(f64::to_radians),
        ),
    };
    if position_m == Vector3::zeros() {
        return Err(row.error("d3_m", "a camera that is not inside the target"));
    }
    let sigmas = line.sigma.unwrap_or_default();
    let position = covariance::from_cells(row, POSITION, line.position_covariance, &Vector6::repeat(1.0))?;
    let attitude = covariance::from_cells(row, ATTITUDE, line.attitude_covariance, &degrees())?;
    let cross = line.cross_covariance.unwrap_or_default();
    Ok(Motion {
        time_s: line.time_s,
        pose: Pose { position_m, phi_rad: Vector3::new(phi1, phi2, phi3).map(f64::to_radians) },
        velocity_m_s,
        phi_rate_rad_s,
        position_covariance: position
            .unwrap_or_else(|| covariance_from_sigmas(rho, alpha, beta, &towards, &sigmas)),
        attitude_covariance: attitude.unwrap_or_else(|| {
            let variance = |sigma: f64| sigma.to_radians() * sigma.to_radians();
            let [_, _, _, _, s1, s2, s3] = sigmas;
            Matrix6::from_diagonal(&Vector6::new(variance(s1), variance(s2), variance(s3), 0.0, 0.0, 0.0))
        }),
        cross_covariance: Matrix3::from_row_slice(&cross.map(f64::to_radians)),
        fields: line.fields.unwrap_or(0),
    })
}

/// Returns a covariance of position and velocity that reproduces the standard deviations of ρ, u, α and β,
/// without correlation.
fn covariance_from_sigmas(
    rho: f64,
    alpha: f64,
    beta: f64,
    towards: &Vector3<f64>,
    sigmas: &[f64; 7],
) -> Matrix6<f64> {
    let (sin_a, cos_a) = (libm::sin(alpha), libm::cos(alpha));
    let (sin_b, cos_b) = (libm::sin(beta), libm::cos(beta));
    // The derivatives ∂d/∂ρ, ∂d/∂α, ∂d/∂β, each multiplied by its standard deviation.
    let along = [
        towards * sigmas[0],
        Vector3::new(-sin_a * sin_b, cos_a, -sin_a * cos_b) * (rho * sigmas[2].to_radians()),
        Vector3::new(cos_a * cos_b, 0.0, -cos_a * sin_b) * (rho * sigmas[3].to_radians()),
    ];
    let mut covariance = Matrix6::zeros();
    let position: Matrix3<f64> = along.iter().map(|v| v * v.transpose()).sum();
    covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&position);
    let rate = towards * sigmas[1];
    covariance.fixed_view_mut::<3, 3>(3, 3).copy_from(&(rate * rate.transpose()));
    covariance
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::tempdir;

    use super::*;

    fn read(text: &str) -> Result<Vec<(u64, MotionReport)>, FileError> {
        let directory = tempdir().unwrap();
        let path = directory.path().join("motion.csv");
        fs::write(&path, text).unwrap();
        read_motion(&path)
    }

    fn motion(range_m: f64) -> Motion {
        let root = Matrix6::from_fn(|i, j| if i == j { 0.01 } else { 0.0005 * (i + 2 * j) as f64 });
        Motion {
            time_s: 12.34,
            pose: Pose {
                position_m: Vector3::new(0.3, -0.2, range_m),
                phi_rad: Vector3::new(0.01, 0.02, -0.03),
            },
            velocity_m_s: Vector3::new(0.01, 0.0, -0.2),
            phi_rate_rad_s: Vector3::new(0.0, 1e-4, 0.0),
            position_covariance: root * root.transpose(),
            attitude_covariance: root.transpose() * root * 0.01,
            cross_covariance: Matrix3::from_fn(|i, j| 1e-6 * (3 * i + j) as f64),
            fields: 9,
        }
    }

    #[test]
    fn reports_of_both_estimators_round_trip() {
        let reports = [
            (9, MotionReport { best: Some(motion(5.0)), paper: Some(motion(5.1)) }),
            (19, MotionReport { best: Some(motion(4.9)), paper: None }),
            (29, MotionReport { best: None, paper: Some(motion(4.8)) }),
            (39, MotionReport { best: None, paper: Some(motion(4.7)) }),
        ];
        let directory = tempdir().unwrap();
        let path = directory.path().join("motion.csv");
        let mut writer = MotionWriter::create(&path).unwrap();
        let lines = reports.iter().flat_map(|(field, report)| MotionLine::from_report(*field, report));
        lines.for_each(|line| writer.line(&line).unwrap());
        writer.finish().unwrap();
        let read = read_motion(&path).unwrap();
        assert_eq!(read.iter().map(|(field, _)| *field).collect::<Vec<_>>(), [9, 19, 29, 39]);
        assert!(read[1].1.paper.is_none());
        for ((_, read), (_, written)) in read.iter().zip(&reports) {
            assert_eq!(*read, report_as_filed(written));
        }
        let (met, meant) = (read[0].1.paper.as_ref().unwrap(), motion(5.1));
        assert_eq!((met.time_s, met.fields, met.velocity_m_s), (12.34, 9, meant.velocity_m_s));
        assert_eq!(met.pose.position_m, meant.pose.position_m);
        assert_eq!(met.position_covariance, meant.position_covariance);
        // Angles change their unit, which causes a rounding error.
        assert!((met.pose.phi_rad - meant.pose.phi_rad).norm() < 1e-16);
        assert!((met.attitude_covariance - meant.attitude_covariance).norm() < 1e-18);
        assert!((met.cross_covariance - meant.cross_covariance).norm() < 1e-18);
    }

    const HEADER: &str = "field,time_s,rho_m,u_m_s,alpha_deg,beta_deg,phi1_deg,phi2_deg,phi3_deg";

    #[test]
    fn the_approach_parameters_suffice_and_round_trip() {
        let text = format!(
            "{HEADER},{}\n9,0.2,5,-0.1,3,-4,0.1,0.2,0.3,0.01,0.002,0.1,0.2,0.3,0.4,0.5\n",
            SIGMA.join(",")
        );
        let reports = read(&text).unwrap();
        let best = reports[0].1.best.as_ref().unwrap();
        let shown = ApproachParameters::from_motion(&best.pose, &best.velocity_m_s);
        let met = [shown.rho_m, shown.u_m_s, shown.alpha_rad.to_degrees(), shown.beta_rad.to_degrees()];
        for (met, meant) in met.iter().zip([5.0, -0.1, 3.0, -4.0]) {
            assert!((met - meant).abs() < 1e-13, "{met} and {meant}");
        }
        let sigmas = ApproachParameters::sigmas(best).unwrap();
        for (i, (met, meant)) in sigmas.iter().zip([0.01, 0.002, 0.1, 0.2, 0.3, 0.4, 0.5]).enumerate() {
            let in_files = if i < 2 { *met } else { met.to_degrees() };
            assert!((in_files - meant).abs() < 1e-12, "sigma {i}: {in_files} and {meant}");
        }
    }

    #[test]
    fn each_bad_cell_is_named_by_line_and_column() {
        let header = format!("{HEADER},estimator,d1_m");
        for (row, column) in [
            ("9,0.2,0,-0.1,3,-4,0.1,0.2,0.3,best,", "rho_m"),
            ("9,x,5,-0.1,3,-4,0.1,0.2,0.3,best,", "time_s"),
            ("9,0.2,5,,3,-4,0.1,0.2,0.3,best,", "u_m_s"),
            ("9,0.2,5,-0.1,3,-4,0.1,0.2,0.3,worst,", "estimator"),
            ("9,0.2,5,-0.1,3,-4,0.1,0.2,0.3,best,1", "d2_m"),
        ] {
            let message = read(&format!("{header}\n{row}\n")).unwrap_err().to_string();
            assert!(
                message.contains("line 2") && message.contains(&format!("`{column}`")),
                "{row}: {message}"
            );
        }
        let row = |field: u64, estimator: &str| format!("{field},0.2,5,-0.1,3,-4,0.1,0.2,0.3,{estimator},");
        for (rows, column) in [
            ([row(9, "paper"), row(9, "paper")], "estimator"),
            ([row(9, "paper"), row(9, "best")], "field"),
            ([row(9, "paper"), row(8, "paper")], "field"),
        ] {
            let message = read(&format!("{header}\n{}\n", rows.join("\n"))).unwrap_err().to_string();
            assert!(message.contains("line 3") && message.contains(&format!("`{column}`")), "{message}");
        }
        let missing = read("field,time_s\n").unwrap_err().to_string();
        assert!(missing.contains("column `rho_m` is missing"), "{missing}");
    }
}
