//! Groups of frames, and counts of causes.

use indexmap::IndexMap;

/// Name of the group of frames in which the pipeline starts up.
pub const WARM_UP: &str = "warm-up";

/// Counts the occurrences of each word, in the order of `words`, without the words that do not occur.
pub fn counts(words: &[&str], occurrences: impl Iterator<Item = &'static str>) -> IndexMap<String, u64> {
    let mut counts: IndexMap<String, u64> = words.iter().map(|word| ((*word).to_owned(), 0)).collect();
    for word in occurrences {
        *counts.entry(word.to_owned()).or_default() += 1;
    }
    counts.retain(|_, count| *count > 0);
    counts
}
