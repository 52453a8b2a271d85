//! Units whose verdict differs from that in the baseline.
use score::UnitVerdict;
use serde::Serialize;

/// Kind of change of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FlipKind {
    /// A unit that was right in the baseline and is not in the result; for a case: fewer of its frames are
    /// right.
    Lost,
    /// A unit that is right in the result and was not in the baseline; for a case: more of its frames are
    /// right.
    Won,
    /// A unit that is wrong or missed in another way.
    Other,
}

/// A unit whose verdict changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Flip {
    /// Number of the frame, field or case.
    pub number: u64,
    /// Group of the unit.
    pub group: String,
    /// Kind of the change.
    pub kind: FlipKind,
    /// Verdict in the baseline.
    pub baseline: String,
    /// Cause in the baseline.
    pub baseline_cause: Option<String>,
    /// Verdict in the result.
    pub result: String,
    /// Cause in the result.
    pub result_cause: Option<String>,
}

/// All units whose verdict changed, ordered by number.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Flips {
    /// Number of lost units.
    pub lost: u64,
    /// Number of won units.
    pub won: u64,
    /// Number of units that changed in another way.
    pub other: u64,
    /// The changed units.
    pub units: Vec<Flip>,
}

impl Flips {
    /// Returns the changes between units that correspond one by one.
    pub(crate) fn from_verdicts(baseline: &[UnitVerdict], result: &[UnitVerdict]) -> Self {
        let mut flips = Self { lost: 0, won: 0, other: 0, units: Vec::new() };
        for (before, after) in baseline.iter().zip(result) {
            if (&before.verdict, &before.cause) == (&after.verdict, &after.cause) {
                continue;
            }
            let kind = match goodness(&after.verdict).cmp(&goodness(&before.verdict)) {
                std::cmp::Ordering::Less => FlipKind::Lost,
                std::cmp::Ordering::Greater => FlipKind::Won,
                std::cmp::Ordering::Equal => FlipKind::Other,
            };
            match kind {
                FlipKind::Lost => flips.lost += 1,
                FlipKind::Won => flips.won += 1,
                FlipKind::Other => flips.other += 1,
            }
            flips.units.push(Flip {
                number: before.number,
                group: before.group.clone(),
                kind,
                baseline: before.verdict.clone(),
                baseline_cause: before.cause.clone(),
                result: after.verdict.clone(),
                result_cause: after.cause.clone(),
            });
        }
        flips
    }
}

/// Returns the number of a unit's frames that are right, from its verdict: 1 or 0 for a frame, the count in
/// `37 of 40` for a case.
fn goodness(verdict: &str) -> u64 {
    match verdict {
        "correct" | "success" => 1,
        other => other.split_once(" of ").and_then(|(count, _)| count.parse().ok()).unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::unit;

    #[test]
    fn flips_are_counted_by_the_new_verdict_of_the_unit() {
        let baseline = [
            unit(0, "correct", None),
            unit(1, "correct", None),
            unit(2, "missed", Some("not_linked")),
            unit(3, "missed", Some("not_linked")),
            unit(4, "37 of 40", None),
        ];
        let result = [
            unit(0, "correct", None),
            unit(1, "wrong", Some("taken_for_star")),
            unit(2, "correct", None),
            unit(3, "missed", Some("below_threshold")),
            unit(4, "35 of 40", None),
        ];
        let flips = Flips::from_verdicts(&baseline, &result);
        assert_eq!((flips.lost, flips.won, flips.other), (2, 1, 1));
        assert_eq!(flips.units.iter().map(|flip| flip.number).collect::<Vec<_>>(), [1, 2, 3, 4]);
        assert_eq!(flips.units[0].result_cause.as_deref(), Some("taken_for_star"));
    }

    #[test]
    fn verdict_words_of_both_worlds_and_of_studies_map_to_success() {
        for (verdict, expected) in [
            ("correct", 1),
            ("success", 1),
            ("wrong", 0),
            ("missed", 0),
            ("no solution", 0),
            ("37 of 40", 37),
            ("0 of 40", 0),
        ] {
            assert_eq!(goodness(verdict), expected, "{verdict}");
        }
    }

    #[test]
    fn a_flip_reports_both_verdicts_and_both_causes() {
        let before = [unit(7, "wrong", Some("taken_for_star"))];
        let flips = Flips::from_verdicts(&before, &[unit(7, "missed", Some("not_linked"))]);
        assert_eq!((flips.lost, flips.won, flips.other), (0, 0, 1));
        assert_eq!(
            flips.units,
            [Flip {
                number: 7,
                group: "day 1".to_owned(),
                kind: FlipKind::Other,
                baseline: "wrong".to_owned(),
                baseline_cause: Some("taken_for_star".to_owned()),
                result: "missed".to_owned(),
                result_cause: Some("not_linked".to_owned()),
            }]
        );
        assert!(Flips::from_verdicts(&before, &before).units.is_empty());
    }
}
