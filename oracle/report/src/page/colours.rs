//! Colours of causes: a world gives each of its causes one, the same in every chart.

/// Distinct colours; the first are for the most frequent causes.
pub const PALETTE: [&str; 18] = [
    "#9aa3ac", "#5b6570", "#3f4a8a", "#b9a3d8", "#c9415a", "#7d8a1f", "#f0a3b0", "#3aa6b0", "#e0752d",
    "#8a5a1f", "#d9b23c", "#8d6bc4", "#d36bb0", "#6d2b3a", "#2f7fc1", "#2f9e69", "#a9c96a", "#c8cdd2",
];

/// Returns the colour of the cause at `place` in its world's list; the first colour for a cause that is not
/// in the list.
pub fn colour_at(place: Option<usize>) -> &'static str {
    place.and_then(|place| PALETTE.get(place)).or(PALETTE.first()).copied().unwrap_or("#9aa3ac")
}
