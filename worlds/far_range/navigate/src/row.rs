//! `navigation.csv`: estimated and true relative orbit at each requested time.

use std::path::Path;

use files::{CsvLine, CsvReader, CsvRow, FieldDeclaration, FileError, Table, optional, parse_utc, table};
use hifitime::Epoch;
use nalgebra::{Matrix6, Vector6};

/// Columns of the correlations: the lower triangle without its diagonal, row by row, of position and velocity
/// along R, T, N.
const CORRELATIONS: [&str; 15] = [
    "rho_t_r",
    "rho_n_r",
    "rho_n_t",
    "rho_v_r_r",
    "rho_v_r_t",
    "rho_v_r_n",
    "rho_v_t_r",
    "rho_v_t_t",
    "rho_v_t_n",
    "rho_v_t_v_r",
    "rho_v_n_r",
    "rho_v_n_t",
    "rho_v_n_n",
    "rho_v_n_v_r",
    "rho_v_n_v_t",
];

table! {
    /// A row of `navigation.csv`. Axes are those of the target; the orbit is that of the chaser with respect
    /// to the target; errors are estimated minus true.
    #[derive(Debug, Clone, PartialEq)]
    pub struct NavigationRow: csv {
        /// time of the estimate, UTC; ascending
        time_utc: String,
        /// `estimated`; or the reason for no estimate, in which case only the truth is stated:
        /// `no_measurements`, `no_initial_orbit`, `no_chaser_orbit`, `no_convergence`, `failed: ` and a
        /// reason
        status: String,
        /// true position along R, T, N, m
        true_position_m: [f64; 3] = ["true_r_m", "true_t_m", "true_n_m"],
        /// error of the position along R, T, N, m
        position_error_m: Option<[f64; 3]> = ["error_r_m", "error_t_m", "error_n_m"],
        /// standard deviation of the position along R, T, N, m
        position_sigma_m: Option<[f64; 3]> = ["sigma_r_m", "sigma_t_m", "sigma_n_m"],
        /// error of the velocity in the rotating frame along R, T, N, m/s
        velocity_error_m_s: Option<[f64; 3]> = ["error_v_r_m_s", "error_v_t_m_s", "error_v_n_m_s"],
        /// standard deviation of the velocity along R, T, N, m/s
        velocity_sigma_m_s: Option<[f64; 3]> = ["sigma_v_r_m_s", "sigma_v_t_m_s", "sigma_v_n_m_s"],
        /// correlations of the errors of position and velocity
        state_correlations: Option<[f64; 15]> = optional(CORRELATIONS),
        /// true mean relative elements, m
        true_elements_m: [f64; 6] =
            ["true_a_da_m", "true_a_dlambda_m", "true_a_dex_m", "true_a_dey_m", "true_a_dix_m", "true_a_diy_m"],
        /// error of the mean relative elements, m
        elements_error_m: Option<[f64; 6]> = [
            "error_a_da_m", "error_a_dlambda_m", "error_a_dex_m", "error_a_dey_m", "error_a_dix_m", "error_a_diy_m"
        ],
        /// standard deviation of the mean relative elements, m
        elements_sigma_m: Option<[f64; 6]> = [
            "sigma_a_da_m", "sigma_a_dlambda_m", "sigma_a_dex_m", "sigma_a_dey_m", "sigma_a_dix_m", "sigma_a_diy_m"
        ],
        /// squared error of position and velocity, normalised by their covariance (NEES, six dimensions)
        nees_state: Option<f64>,
        /// squared error of the position, normalised by its covariance (NEES, three dimensions)
        nees_position: Option<f64>,
        /// squared error of the elements, normalised by their covariance (NEES, six dimensions)
        nees_elements: Option<f64>,
    }
}

impl NavigationRow {
    /// Status of a row with an estimate.
    pub const ESTIMATED: &'static str = "estimated";

    /// Returns the time of the estimate; `None` for a text that is not UTC, which no read row has.
    pub fn time(&self) -> Option<Epoch> {
        parse_utc(&self.time_utc).ok()
    }

    /// Returns the error of position, m, and velocity, m/s; `None` without an estimate.
    pub(crate) fn state_error(&self) -> Option<Vector6<f64>> {
        let ([r, t, n], [vr, vt, vn]) = self.position_error_m.zip(self.velocity_error_m_s)?;
        Some(Vector6::new(r, t, n, vr, vt, vn))
    }

    /// Returns the covariance of position, m, and velocity, m/s, along R, T, N; `None` without an estimate or
    /// its correlations.
    pub(crate) fn state_covariance(&self) -> Option<Matrix6<f64>> {
        let ([r, t, n], [vr, vt, vn]) = self.position_sigma_m.zip(self.velocity_sigma_m_s)?;
        let sigmas = Vector6::new(r, t, n, vr, vt, vn);
        let listed = self.state_correlations?;
        let correlations = Matrix6::from_fn(|row, column| {
            let (high, low) = (row.max(column), row.min(column));
            if high == low {
                return 1.0;
            }
            listed.get(high * (high - 1) / 2 + low).copied().unwrap_or_default()
        });
        Some(correlations.component_mul(&(sigmas * sigmas.transpose())))
    }

    /// Returns the correlations of a covariance in the order of the columns.
    pub(crate) fn correlations(covariance: &Matrix6<f64>) -> [f64; 15] {
        let sigmas = covariance.diagonal().map(f64::sqrt);
        let correlations = covariance.component_div(&(sigmas * sigmas.transpose()));
        let mut listed = [0.0; 15];
        let below = (0..6).flat_map(|row| (0..row).map(move |column| (row, column)));
        for (number, index) in listed.iter_mut().zip(below) {
            *number = correlations.get(index).copied().unwrap_or_default();
        }
        listed
    }

    /// Returns the true distance between chaser and target, m.
    pub fn true_range_m(&self) -> f64 {
        let [r, t, n] = self.true_position_m;
        (r * r + t * t + n * n).sqrt()
    }

    /// Returns the estimated minus the true distance, m; `None` without an estimate.
    pub fn range_error_m(&self) -> Option<f64> {
        let errors = self.position_error_m?;
        let sum: f64 = self
            .true_position_m
            .iter()
            .zip(errors)
            .map(|(truth, error)| (truth + error) * (truth + error))
            .sum();
        Some(sum.sqrt() - self.true_range_m())
    }
}

/// Reads a `navigation.csv`.
///
/// # Errors
/// [`FileError`] with line and column of the first invalid cell.
pub fn read_navigation(path: &Path) -> Result<Vec<NavigationRow>, FileError> {
    CsvReader::open::<NavigationRow>(path)?.read_rows(|row, _| read_row(row))
}

/// [`read_navigation`] with the line of each row; a table without rows is an error.
pub(crate) fn read_navigation_lines(path: &Path) -> Result<Vec<(u64, NavigationRow)>, FileError> {
    CsvReader::open::<NavigationRow>(path)?.read_all(|row, _| read_row(row))
}

fn read_row(row: &CsvRow<'_>) -> Result<NavigationRow, FileError> {
    let read = NavigationRow::read(row)?;
    parse_utc(&read.time_utc).map_err(|expected| row.error("time_utc", expected))?;
    Ok(read)
}

/// Returns the columns of the table of this crate, by file name.
pub fn tables() -> [(&'static str, Vec<FieldDeclaration>); 1] {
    [("navigation.csv", NavigationRow::declarations())]
}
