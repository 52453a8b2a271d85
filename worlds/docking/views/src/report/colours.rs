//! Colours of the causes.

use ::report::page::colours::colour_at;
use contract::docking::FailedCheck;
use docking::scoring::{GrossError, MissCause};

/// Colours of the failed tests of a doubtful pose.
const DOUBTS: [&str; 5] = ["#fff0b8", "#fbdc76", "#f2c230", "#b58a00", "#7a5d00"];

/// Returns the colour of a cause or of a failed test by its code.
pub(super) fn colour_of(cause: &str) -> &'static str {
    let doubt = FailedCheck::ALL.iter().position(|known| known.code() == cause);
    if let Some(colour) = doubt.and_then(|place| DOUBTS.get(place)) {
        return colour;
    }
    let mut codes = MissCause::CODES.into_iter().chain(GrossError::ALL.map(GrossError::code));
    colour_at(codes.position(|known| known == cause))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_cause_has_a_colour_of_its_own() {
        let codes: Vec<&str> = [
            MissCause::CODES.to_vec(),
            GrossError::ALL.map(GrossError::code).to_vec(),
            FailedCheck::ALL.map(FailedCheck::code).to_vec(),
        ]
        .concat();
        let colours: BTreeSet<&str> = codes.iter().map(|code| colour_of(code)).collect();
        assert_eq!(colours.len(), codes.len());
    }
}
