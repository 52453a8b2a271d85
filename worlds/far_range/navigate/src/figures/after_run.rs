//! The navigation as a step after a run, in studies and gates.

use std::path::Path;

use far_range::FarRangeScenario;
use far_range::rows::read_telemetry;
use files::{Failure, FileError};
use hifitime::Epoch;
use run::{NavigationFigure, WorldNavigation, register_navigation};
use scenario::run_file::ScenarioFile;
use score::FigureTerms;

use crate::campaign::Campaign;
use crate::estimator::{EVERY_S, Estimator, navigate, requested_estimates};
use crate::figures::{navigation_figures, navigation_terms};
use crate::knowledge::KnowledgeConfig;
use crate::measurements::MeasurementSource;
use crate::result::TABLE_FILE;
use crate::row::read_navigation;

/// Registers the navigation of far-range runs for the rest of the process.
pub fn register() {
    register_navigation(WorldNavigation { world: FarRangeScenario::WORLD, figures, terms });
}

/// Navigates on a run and returns the figures. Measurements without a usable line of sight determine no
/// orbit; the run counts with all its times.
fn figures(directory: &Path, estimator: &str) -> Result<Vec<NavigationFigure>, Failure> {
    let unknown = || Failure::Usage(format!("unknown estimator `{estimator}`"));
    let estimator = Estimator::parse(estimator).ok_or_else(unknown)?;
    match estimated(directory, estimator) {
        Err(Failure::File(FileError::Value { .. }) | Failure::Contract(_)) => {
            let of = requested_estimates(directory, EVERY_S)?;
            Ok(vec![NavigationFigure { name: "navigation_estimate_rate", value: Some(0.0), count: 0, of }])
        }
        other => other,
    }
}

fn estimated(directory: &Path, estimator: Estimator) -> Result<Vec<NavigationFigure>, Failure> {
    let source = MeasurementSource::default();
    let campaign = Campaign::open(directory, &KnowledgeConfig::default(), &source)?;
    let result = navigate(&campaign, estimator, EVERY_S)?;
    navigation_figures(&campaign, &result)
}

/// Returns the figures of the stored navigation of a run, per frame; none without `navigation.csv`.
fn terms(directory: &Path) -> Result<Vec<FigureTerms>, Failure> {
    let table = directory.join(TABLE_FILE);
    if !table.is_file() {
        return Ok(Vec::new());
    }
    let telemetry = read_telemetry(&directory.join("telemetry.csv"))?;
    let times: Vec<Epoch> = telemetry.iter().map(|row| row.telemetry.time).collect();
    Ok(navigation_terms(&read_navigation(&table)?, &times))
}
