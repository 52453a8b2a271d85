//! Colours of the pictures.

/// An opaque colour: red, green, blue.
pub(super) type Rgb = [u8; 3];

/// Behind panels and text.
pub(super) const BACKGROUND: Rgb = [24, 24, 28];
/// Pixels that the camera did not transmit.
pub(super) const NO_DATA: Rgb = [17, 19, 27];
/// Headings and values.
pub(super) const WHITE: Rgb = [238, 238, 238];
/// Names of values.
pub(super) const GREY: Rgb = [150, 154, 162];
/// Outlines under marks and text.
pub(super) const BLACK: Rgb = [0, 0, 0];

/// The target.
pub(super) const ORANGE: Rgb = [255, 176, 64];
/// Stars; the circle of marks.
pub(super) const BLUE: Rgb = [96, 200, 255];
/// Planets and the Moon; the docking unit.
pub(super) const VIOLET: Rgb = [212, 140, 240];
/// Hot pixels; rejected marks.
pub(super) const RED: Rgb = [255, 92, 104];
/// Cosmic-ray hits; partial answers.
pub(super) const YELLOW: Rgb = [236, 222, 96];
/// Answers.
pub(super) const GREEN: Rgb = [110, 236, 130];
/// Transmitted regions.
pub(super) const SLATE: Rgb = [122, 134, 158];

/// Every colour that is not a grey of the frame.
pub(super) const ACCENTS: [Rgb; 10] =
    [BACKGROUND, NO_DATA, GREY, ORANGE, BLUE, VIOLET, RED, YELLOW, GREEN, SLATE];

/// `over` on `under`, with a coverage of 0 to 255.
pub(super) fn blend(under: Rgb, over: Rgb, coverage: u8) -> Rgb {
    let part = u32::from(coverage);
    let mix =
        |under: u8, over: u8| ((u32::from(under) * (255 - part) + u32::from(over) * part + 127) / 255) as u8;
    let ([ur, ug, ub], [or, og, ob]) = (under, over);
    [mix(ur, or), mix(ug, og), mix(ub, ob)]
}
