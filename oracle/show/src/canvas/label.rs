//! Labels beside marks, placed where they cover nothing.

use super::colour::BLACK;
use super::text::Font;
use crate::canvas::{Area, Canvas};
use crate::layout::view::Placement;
use crate::panel::Mark;

/// Largest number of labels in one panel; more would be unreadable.
const MOST: usize = 24;
/// Distance from a mark to its label, px.
const GAP: f64 = 3.0;

/// Largest side of a region that frames a single mark, px of the picture.
const MAX_FRAMED_SIDE_PX: f64 = 80.0;

/// Returns the area of a mark in a panel.
pub(crate) fn bounds(mark: &Mark, placement: &Placement) -> Area {
    let (x, y) = placement.inner(mark.at);
    let reach = mark.shape.reach(placement.zoom);
    Area { left: x - reach, top: y - reach, width: 2.0 * reach, height: 2.0 * reach }
}

/// Writes the labels of marks into a panel. Each label stands beside its mark and the small transmitted
/// regions around it, where it overlaps no mark, no small region, no other label and no area of `taken`; it
/// is left out if there is no such position. Earlier marks have precedence.
pub(crate) fn write(
    canvas: &mut Canvas,
    placement: &Placement,
    marks: &[Mark],
    regions: &[Area],
    taken: &[Area],
) {
    let small = |region: &&Area| region.width.max(region.height) < MAX_FRAMED_SIDE_PX;
    let shown = || marks.iter().filter(|mark| placement.shows(mark.at));
    let areas = shown().map(|mark| bounds(mark, placement));
    let mut taken: Vec<Area> =
        taken.iter().copied().chain(regions.iter().filter(small).copied()).chain(areas).collect();
    let named = shown().filter_map(|mark| Some((mark, mark.label.as_ref()?)));
    for (mark, label) in named.take(MOST) {
        let (width, height) = (Font::Label.width(label) as f64, Font::Label.height() as f64);
        let own = bounds(mark, placement);
        let around = regions.iter().filter(small).filter(|region| region.meets(&own));
        let around = around.fold(own, |all, region| all.with(region));
        let (right, below) = (around.left + around.width + GAP, around.top + around.height);
        let (middle_x, middle_y) = (around.left + 0.5 * around.width, around.top + 0.5 * around.height);
        let corners = [
            (right, middle_y - 0.5 * height),
            (around.left - GAP - width, middle_y - 0.5 * height),
            (middle_x - 0.5 * width, below),
            (middle_x - 0.5 * width, around.top - height),
        ];
        let areas = corners.map(|(left, top)| Area { left: left.round(), top: top.round(), width, height });
        let is_free = |area: &Area| {
            area.is_inside(placement.width, placement.height) && !taken.iter().any(|other| other.meets(area))
        };
        let Some(area) = areas.into_iter().find(is_free) else { continue };
        let (left, top) = (area.left as usize, area.top as usize);
        canvas.text(left + 1, top + 1, label, Font::Label, BLACK);
        canvas.text(left, top, label, Font::Label, mark.class.rgb());
        taken.push(area);
    }
}
