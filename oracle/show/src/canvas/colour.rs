//! Colours of the pictures.

/// An opaque colour: red, green, blue.
pub(crate) type Rgb = [u8; 3];

/// Behind panels and text.
pub(crate) const BACKGROUND: Rgb = [24, 24, 28];
/// Pixels that the camera did not transmit.
pub(crate) const NO_DATA: Rgb = [17, 19, 27];
/// Headings and values.
pub(crate) const WHITE: Rgb = [238, 238, 238];
/// Names of values in tables.
pub(crate) const GREY: Rgb = [150, 154, 162];
/// Outlines under marks and text.
pub(crate) const BLACK: Rgb = [0, 0, 0];

/// Marks in orange, such as the target.
pub(crate) const ORANGE: Rgb = [255, 176, 64];
/// Marks in blue, such as stars.
pub(crate) const BLUE: Rgb = [96, 200, 255];
/// Marks in violet, such as planets.
pub(crate) const VIOLET: Rgb = [212, 140, 240];
/// Marks in red, such as hot pixels.
pub(crate) const RED: Rgb = [255, 92, 104];
/// Marks in yellow; partial measurements.
pub(crate) const YELLOW: Rgb = [236, 222, 96];
/// Measurements of the pipeline.
pub(crate) const GREEN: Rgb = [110, 236, 130];
/// Transmitted regions.
pub(crate) const SLATE: Rgb = [122, 134, 158];

/// All colours other than the greys of a frame.
pub(crate) const ACCENTS: [Rgb; 10] =
    [BACKGROUND, NO_DATA, GREY, ORANGE, BLUE, VIOLET, RED, YELLOW, GREEN, SLATE];

/// Blends `over` onto `under` with a coverage of 0 to 255.
pub(crate) fn blend(under: Rgb, over: Rgb, coverage: u8) -> Rgb {
    let part = u32::from(coverage);
    let mix =
        |under: u8, over: u8| ((u32::from(under) * (255 - part) + u32::from(over) * part + 127) / 255) as u8;
    let ([ur, ug, ub], [or, og, ob]) = (under, over);
    [mix(ur, or), mix(ug, og), mix(ub, ob)]
}
