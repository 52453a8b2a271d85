//! A report as JUnit XML, which continuous integration reads: a test case a figure.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::report::{FigureReport, FigureVerdict, GateReport};
use crate::failure::Failure;

/// The report as a JUnit document: figures that are worse or gone are failures, those with too little data are skipped.
///
/// # Errors
/// [`Failure::Usage`] when it cannot be written as XML.
pub fn junit(report: &GateReport) -> Result<String, Failure> {
    let mut suite = TestSuite::new(format!("gate {}", report.name));
    for (name, figure) in &report.figures {
        let mut status = match figure.verdict {
            FigureVerdict::NoWorse | FigureVerdict::Better => TestCaseStatus::success(),
            FigureVerdict::Worse | FigureVerdict::Gone => {
                TestCaseStatus::non_success(NonSuccessKind::Failure)
            }
            FigureVerdict::TooLittleData => TestCaseStatus::skipped(),
        };
        // Of a success both are nothing, and nothing is written.
        status.set_message(message(name, figure));
        status.set_type(figure.verdict.words());
        let mut case = TestCase::new(name.as_str(), status);
        case.set_classname(format!("boresight.gate.{}", report.name));
        case.set_system_out(message(name, figure));
        suite.add_test_case(case);
    }
    written(suite)
}

/// A comparison that could not be made, as a JUnit document: one test case, which is an error.
///
/// # Errors
/// [`Failure::Usage`] when it cannot be written as XML.
pub fn junit_of_failure(failure: &Failure) -> Result<String, Failure> {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_message(failure.to_string());
    status.set_type("cannot compare");
    let mut case = TestCase::new("comparison", status);
    case.set_classname("boresight.gate");
    let mut suite = TestSuite::new("gate");
    suite.add_test_case(case);
    written(suite)
}

fn written(suite: TestSuite) -> Result<String, Failure> {
    let mut document = Report::new("boresight gate");
    document.add_test_suite(suite);
    document
        .to_string()
        .map_err(|error| Failure::Usage(format!("the report cannot be written as JUnit XML: {error}")))
}

/// A figure in a sentence.
fn message(name: &str, figure: &FigureReport) -> String {
    let shown = |value: Option<f64>| value.map_or_else(|| "nothing".to_owned(), |value| value.to_string());
    format!(
        "{name}: {}; {} in the baseline, {} in the result, difference {} (95 %: {} to {}), adjusted p {}, smallest visible {}",
        figure.verdict.words(),
        shown(figure.baseline),
        shown(figure.result),
        shown(figure.difference),
        shown(figure.low),
        shown(figure.high),
        figure.adjusted_p,
        shown(figure.smallest_visible),
    )
}
