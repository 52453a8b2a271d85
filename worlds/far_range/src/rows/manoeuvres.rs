//! `truth/manoeuvres.csv`: the chaser's manoeuvres as planned, as executed and as reported.

use std::path::Path;

use files::{FileError, format_utc, table, write_csv};
use nalgebra::Vector3;
use sim::truth::ManoeuvreTruth;

table! {
    /// A row of `truth/manoeuvres.csv`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ManoeuvreRow: csv {
        /// number of the manoeuvre, from 0, in order of time
        manoeuvre: u64,
        /// first instant, UTC; of an impulse, its instant
        start_utc: String,
        /// last instant, UTC; of an impulse, its instant
        end_utc: String,
        /// duration, s; 0 for an impulse. The acceleration is constant
        duration_s: f64,
        /// planned change of velocity along the chaser's R, T, N, m/s
        planned_m_s: [f64; 3] = ["planned_dv_r_m_s", "planned_dv_t_m_s", "planned_dv_n_m_s"],
        /// executed change of velocity along the chaser's R, T, N, m/s
        executed_m_s: [f64; 3] = ["executed_dv_r_m_s", "executed_dv_t_m_s", "executed_dv_n_m_s"],
        /// size of the executed change of velocity relative to the planned one, minus 1; 0 for no change
        size_error: f64,
        /// angle between the planned and the executed change of velocity, degrees
        direction_error_deg: f64,
        /// time from which telemetry reports the manoeuvre, UTC
        reported_utc: String,
        /// reported change of velocity along the chaser's R, T, N, m/s
        reported_m_s: [f64; 3] = ["reported_dv_r_m_s", "reported_dv_t_m_s", "reported_dv_n_m_s"],
    }
}

impl ManoeuvreRow {
    /// Returns the row of the manoeuvre with a number.
    fn from_truth(number: usize, truth: &ManoeuvreTruth) -> Self {
        let [start_utc, end_utc] = truth.ends().map(format_utc);
        let (planned, executed) =
            (Vector3::from(truth.planned_dv_rtn_m_s), Vector3::from(truth.executed_dv_rtn_m_s));
        let angle_rad = libm::atan2(planned.cross(&executed).norm(), planned.dot(&executed));
        Self {
            manoeuvre: number as u64,
            start_utc,
            end_utc,
            duration_s: truth.duration_s,
            planned_m_s: truth.planned_dv_rtn_m_s,
            executed_m_s: truth.executed_dv_rtn_m_s,
            size_error: if planned.norm() > 0.0 { executed.norm() / planned.norm() - 1.0 } else { 0.0 },
            direction_error_deg: angle_rad.to_degrees(),
            reported_utc: format_utc(truth.report.reported),
            reported_m_s: truth.report.dv_rtn_m_s,
        }
    }
}

/// Writes the table.
///
/// # Errors
/// [`FileError::OutputTaken`] if the file exists; [`FileError::Io`] if it cannot be written.
pub fn write_manoeuvres(path: &Path, manoeuvres: &[ManoeuvreTruth]) -> Result<(), FileError> {
    let rows = manoeuvres.iter().enumerate().map(|(number, truth)| ManoeuvreRow::from_truth(number, truth));
    write_csv(path, &rows.collect::<Vec<_>>())
}
