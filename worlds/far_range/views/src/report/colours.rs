//! Colours of the causes.

use ::report::page::colours::colour_at;
use far_range::scoring::Cause;

/// Returns the colour of a cause by its code.
pub(super) fn colour_of(cause: &str) -> &'static str {
    colour_at(Cause::ALL.iter().position(|known| known.code() == cause))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_cause_has_a_colour_of_its_own() {
        let codes: Vec<&str> = Cause::ALL.map(Cause::code).to_vec();
        let colours: BTreeSet<&str> = codes.iter().map(|code| colour_of(code)).collect();
        assert_eq!(colours.len(), codes.len());
    }
}
