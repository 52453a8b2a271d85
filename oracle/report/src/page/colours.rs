//! Colours of causes, the same in every chart.
use contract::docking::FailedCheck;
use score::Cause;
use score::docking::{GrossError, MissCause};

/// One colour per cause of a world; the most frequent causes have the most distinct colours.
const PALETTE: [&str; 18] = [
    "#9aa3ac", "#5b6570", "#3f4a8a", "#b9a3d8", "#c9415a", "#7d8a1f", "#f0a3b0", "#3aa6b0", "#e0752d",
    "#8a5a1f", "#d9b23c", "#8d6bc4", "#d36bb0", "#6d2b3a", "#2f7fc1", "#2f9e69", "#a9c96a", "#c8cdd2",
];

/// Colours of the failed tests of a doubtful pose.
const DOUBTS: [&str; 5] = ["#fff0b8", "#fbdc76", "#f2c230", "#b58a00", "#7a5d00"];

/// Returns the colour of a cause by its code.
pub(crate) fn colour_of(cause: &str) -> &'static str {
    let far_range = |cause: &str| Cause::ALL.iter().position(|of| of.code() == cause);
    if let Some(place) = far_range(cause) {
        return PALETTE[place];
    }
    if let Some(place) = FailedCheck::ALL.iter().position(|of| of.code() == cause) {
        return DOUBTS[place];
    }
    // Docking shares some causes with the far range; its other causes take the remaining colours.
    let codes = || MissCause::CODES.into_iter().chain(GrossError::ALL.map(GrossError::code));
    let shared: Vec<usize> = codes().filter_map(far_range).collect();
    let left = (0..PALETTE.len()).filter(|place| !shared.contains(place));
    let own = codes().filter(|code| far_range(code).is_none());
    own.zip(left).find(|(code, _)| *code == cause).map_or(PALETTE[0], |(_, place)| PALETTE[place])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn causes_of_a_world_have_colours_of_their_own() {
        let distinct = |codes: Vec<&str>| {
            let colours: std::collections::BTreeSet<_> = codes.iter().map(|code| colour_of(code)).collect();
            assert_eq!(colours.len(), codes.len());
        };
        distinct(Cause::ALL.map(Cause::code).to_vec());
        let doubts = FailedCheck::ALL.map(FailedCheck::code);
        distinct(
            MissCause::CODES.into_iter().chain(GrossError::ALL.map(GrossError::code)).chain(doubts).collect(),
        );
    }
}
