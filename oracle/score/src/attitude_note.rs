//! Words for the attitude that lines of sight are based on.

/// Figure that counts the detections with a line of sight, of all detections.
pub const LINE_OF_SIGHT_RATE: &str = "line_of_sight_rate";

/// Returns the attitude that the lines of sight of a run are based on: `own`, `telemetry`, `true`; `own and
/// …` if measurements differ, `none` if no measurement has a line of sight. `own` is true if there are
/// detections with a line of sight of the pipeline, `centroids` if there are detections with only a centroid;
/// `granted` is the attitude granted to the latter. Returns `None` without detections.
pub fn attitude_word(own: bool, centroids: bool, granted: Option<&str>) -> Option<String> {
    let own_code = own.then_some("own");
    let words: Vec<&str> = own_code.into_iter().chain(granted.filter(|_| centroids)).collect();
    match (words.is_empty(), centroids) {
        (true, false) => None,
        (true, true) => Some("none".to_owned()),
        _ => Some(words.join(" and ")),
    }
}

/// Returns a note for readers of figures of the direction about an [`attitude_word`]; `None` if all lines of
/// sight are those of the pipeline.
pub fn attitude_note(word: Option<&str>) -> Option<String> {
    match word? {
        "own" => None,
        "none" => Some(
            "No measurement has a line of sight: no figures of the direction (docs/score.md).".to_owned(),
        ),
        word => Some(format!(
            "Errors of the direction by the attitude `{word}`, not only by the pipeline's own (docs/score.md)."
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_attitude_of_a_run_is_reported_in_a_word() {
        for (own, centroids, granted, word) in [
            (true, false, Some("true"), Some("own")),
            (true, false, None, Some("own")),
            (false, true, Some("telemetry"), Some("telemetry")),
            (false, true, None, Some("none")),
            (true, true, Some("true"), Some("own and true")),
            (true, true, None, Some("own")),
            (false, false, Some("true"), None),
        ] {
            assert_eq!(attitude_word(own, centroids, granted).as_deref(), word);
            let note = attitude_note(word);
            assert_eq!(note.is_none(), matches!(word, None | Some("own")));
            assert!(note.is_none_or(|note| word == Some("none") || note.contains(&format!("`{}`", word.unwrap()))));
        }
    }
}
