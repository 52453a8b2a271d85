//! Report as JUnit XML for continuous integration, with one test case per figure.
use files::{Failure, ReplaceableFile};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use crate::report::{FigureReport, FigureVerdict, GateReport};

/// Name of the documents, which identifies them.
const DOCUMENT_NAME: &str = "boresight gate";

/// A document of an earlier gate: a pipeline that runs again replaces it.
pub const JUNIT_DOCUMENTS: ReplaceableFile<'_> =
    ReplaceableFile { description: "an earlier JUnit report of a gate", matches: &is_document };

fn is_document(beginning: &[u8]) -> bool {
    let text = String::from_utf8_lossy(beginning);
    text.contains(&format!("<testsuites name=\"{DOCUMENT_NAME}\""))
}

/// Returns the report as a JUnit document. Figures that are worse or gone are failures, as are changed
/// figures unless the change was accepted; figures with too little data are skipped.
///
/// # Errors
/// [`Failure::Usage`] when the report cannot be written as XML.
pub fn junit(report: &GateReport) -> Result<String, Failure> {
    let mut suite = TestSuite::new(format!("gate {}", report.name));
    for (name, figure) in &report.figures {
        let mut status = match figure.verdict {
            FigureVerdict::NoWorse | FigureVerdict::Better => TestCaseStatus::success(),
            FigureVerdict::Changed if report.accepted.is_some() => TestCaseStatus::success(),
            FigureVerdict::Worse | FigureVerdict::Gone | FigureVerdict::Changed => {
                TestCaseStatus::non_success(NonSuccessKind::Failure)
            }
            FigureVerdict::TooLittleData => TestCaseStatus::skipped(),
        };
        // For a success these calls have no effect, and nothing is written.
        status.set_message(message(name, figure));
        status.set_type(figure.verdict.words());
        let mut case = TestCase::new(name.as_str(), status);
        case.set_classname(format!("boresight.gate.{}", report.name));
        case.set_system_out(message(name, figure));
        suite.add_test_case(case);
    }
    written(suite)
}

/// Returns a JUnit document for a comparison that could not be made: one test case, which is an error.
///
/// # Errors
/// [`Failure::Usage`] when the document cannot be written as XML.
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
    let mut document = Report::new(DOCUMENT_NAME);
    document.add_test_suite(suite);
    document
        .to_string()
        .map_err(|error| Failure::Usage(format!("the report cannot be written as JUnit XML: {error}")))
}

/// Describes a figure in one sentence. A difference is stated where both results have the figure.
fn message(name: &str, figure: &FigureReport) -> String {
    let mut text = format!(
        "{name}: {}; {}; {}",
        figure.verdict.words(),
        value_of("baseline", figure.baseline),
        value_of("result", figure.result)
    );
    if let Some(difference) = figure.difference {
        text.push_str(&format!("; difference {difference}"));
        if let (Some(low), Some(high)) = (figure.low, figure.high) {
            text.push_str(&format!(" (95 %: {low} to {high})"));
        }
        text.push_str(&format!("; adjusted p {}", figure.adjusted_p));
    }
    match figure.smallest_visible {
        Some(size) => text.push_str(&format!("; smallest visible worsening {size}")),
        None => text.push_str("; no worsening would be found with so little data"),
    }
    text
}

/// Describes the value of the figure in a baseline or in a result.
fn value_of(whose: &str, value: Option<f64>) -> String {
    value.map_or_else(|| format!("no value in the {whose}"), |value| format!("{whose} {value}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::report;

    fn suite(text: &str) -> TestSuite {
        let report = Report::deserialize_from_str(text).unwrap();
        assert_eq!(report.name.as_ref().map(|name| name.as_str()), Some(DOCUMENT_NAME));
        assert!(is_document(text.as_bytes()));
        assert_eq!(report.test_suites.len(), 1, "{text}");
        report.test_suites[0].clone()
    }

    #[test]
    fn a_figure_that_shuts_the_gate_is_a_failure_and_one_without_data_is_skipped() {
        let report = report(&[
            ("worse", FigureVerdict::Worse),
            ("gone", FigureVerdict::Gone),
            ("same", FigureVerdict::NoWorse),
            ("better", FigureVerdict::Better),
            ("few", FigureVerdict::TooLittleData),
        ]);
        let suite = suite(&junit(&report).unwrap());
        assert_eq!(suite.name.as_str(), "gate made by hand");
        assert_eq!((suite.tests, suite.failures, suite.errors, suite.skipped), (5, 2, 0, 1));
        for (case, name) in suite.test_cases.iter().zip(["worse", "gone", "same", "better", "few"]) {
            assert_eq!(case.name.as_str(), name);
            assert_eq!(
                case.classname.as_ref().map(|name| name.as_str()),
                Some("boresight.gate.made by hand")
            );
            let is_as_reported = match &case.status {
                TestCaseStatus::Success { .. } => ["same", "better"].contains(&name),
                TestCaseStatus::NonSuccess { kind, ty, .. } => {
                    *kind == NonSuccessKind::Failure && ty.as_ref().map(|ty| ty.as_str()) == Some(name)
                }
                TestCaseStatus::Skipped { .. } => name == "few",
            };
            assert!(is_as_reported, "{case:?}");
        }
    }

    #[test]
    fn a_failure_describes_the_change_in_a_sentence() {
        let report = report(&[("hit_rate", FigureVerdict::Worse)]);
        let expected = "hit_rate: worse; baseline 0.75; result 0.5; difference -0.25 (95 %: -0.375 to -0.125); \
                        adjusted p 0.03125; no worsening would be found with so little data";
        let suite = suite(&junit(&report).unwrap());
        let case = &suite.test_cases[0];
        let TestCaseStatus::NonSuccess { message, .. } = &case.status else { panic!("{case:?}") };
        assert_eq!(message.as_ref().map(|message| message.as_str()), Some(expected));
        assert_eq!(case.system_out.as_ref().map(|text| text.as_str()), Some(expected));
    }

    #[test]
    fn a_figure_that_is_gone_has_no_difference() {
        let mut report = report(&[("hit_rate", FigureVerdict::Gone)]);
        let figure = report.figures.get_mut("hit_rate").unwrap();
        (figure.result, figure.difference, figure.smallest_visible) = (None, None, Some(0.25));
        let expected =
            "hit_rate: gone; baseline 0.75; no value in the result; smallest visible worsening 0.25";
        assert_eq!(message("hit_rate", figure), expected);
    }

    #[test]
    fn a_comparison_that_could_not_be_made_is_an_error() {
        let text = junit_of_failure(&Failure::Usage("the seeds <are> odd".to_owned())).unwrap();
        let suite = suite(&text);
        assert_eq!((suite.tests, suite.failures, suite.errors), (1, 0, 1));
        let TestCaseStatus::NonSuccess { kind, message, ty, .. } = &suite.test_cases[0].status else {
            panic!("{text}")
        };
        assert_eq!(*kind, NonSuccessKind::Error);
        assert_eq!(message.as_ref().map(|message| message.as_str()), Some("the seeds <are> odd"));
        assert_eq!(ty.as_ref().map(|ty| ty.as_str()), Some("cannot compare"));
    }
}
