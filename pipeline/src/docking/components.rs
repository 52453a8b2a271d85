//! Connected regions of a binary image and what their shape says.

use imageproc::image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};

/// A connected region, in pixels of its image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Component {
    /// Its label: 1, 2, 3, … in the order in which rows meet the regions.
    pub(crate) label: u32,
    /// Number of pixels.
    pub(crate) area: u32,
    /// First and last column.
    pub(crate) columns: (u32, u32),
    /// First and last row.
    pub(crate) rows: (u32, u32),
    /// Mean column and row.
    pub(crate) centroid: (f64, f64),
    /// How much the region is a cross, 0 to 1: |Σ r² exp(4 i θ)| / Σ r² about its centroid. A cross of thin bars has 1,
    /// its outline too, a square or a disk about 0.
    pub(crate) fourfold: f64,
    /// Angle of the fourfold shape from the columns' direction, towards increasing rows, −45° to 45°, rad.
    pub(crate) angle_rad: f64,
}

impl Component {
    /// Columns and rows that it spans.
    pub(crate) fn extent(&self) -> (f64, f64) {
        (f64::from(self.columns.1 - self.columns.0) + 1.0, f64::from(self.rows.1 - self.rows.0) + 1.0)
    }

    /// The middle of the rectangle that it spans.
    pub(crate) fn middle(&self) -> (f64, f64) {
        (f64::from(self.columns.0 + self.columns.1) / 2.0, f64::from(self.rows.0 + self.rows.1) / 2.0)
    }
}

/// The white regions of a binary image (8-connected), and which pixel belongs to which (0: none).
pub(crate) fn find(binary: &GrayImage) -> (Vec<Component>, imageproc::definitions::Image<Luma<u32>>) {
    let labels = connected_components(binary, Connectivity::Eight, Luma([0]));
    let count = labels.pixels().map(|p| p.0[0]).max().unwrap_or(0) as usize;
    let mut found: Vec<Component> = (0..count)
        .map(|i| Component {
            label: i as u32 + 1,
            area: 0,
            columns: (u32::MAX, 0),
            rows: (u32::MAX, 0),
            centroid: (0.0, 0.0),
            fourfold: 0.0,
            angle_rad: 0.0,
        })
        .collect();
    for (x, y, label) in labels.enumerate_pixels() {
        let Some(component) = (label.0[0] as usize).checked_sub(1).and_then(|i| found.get_mut(i)) else {
            continue;
        };
        component.area += 1;
        component.columns = (component.columns.0.min(x), component.columns.1.max(x));
        component.rows = (component.rows.0.min(y), component.rows.1.max(y));
        component.centroid.0 += f64::from(x);
        component.centroid.1 += f64::from(y);
    }
    for component in &mut found {
        let n = f64::from(component.area.max(1));
        component.centroid = (component.centroid.0 / n, component.centroid.1 / n);
    }
    let mut moments = vec![(0.0, 0.0, 0.0); count];
    for (x, y, label) in labels.enumerate_pixels() {
        let Some(i) = (label.0[0] as usize).checked_sub(1) else { continue };
        let (dx, dy) = (f64::from(x) - found[i].centroid.0, f64::from(y) - found[i].centroid.1);
        let (dx2, dy2) = (dx * dx, dy * dy);
        let r2 = dx2 + dy2;
        if r2 > 0.0 {
            // r² cos 4θ and r² sin 4θ without an angle.
            moments[i].0 += (dx2 * dx2 - 6.0 * dx2 * dy2 + dy2 * dy2) / r2;
            moments[i].1 += 4.0 * dx * dy * (dx2 - dy2) / r2;
            moments[i].2 += r2;
        }
    }
    for (component, (cos, sin, r2)) in found.iter_mut().zip(moments) {
        if r2 > 0.0 {
            component.fourfold = libm::hypot(cos, sin) / r2;
            component.angle_rad = libm::atan2(sin, cos) / 4.0;
        }
    }
    (found, labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_regions_have_their_places_and_areas() {
        let binary = GrayImage::from_fn(20, 10, |x, y| {
            let first = (2..5).contains(&x) && (1..3).contains(&y);
            let second = (10..20).contains(&x) && y == 8;
            Luma([if first || second { 255 } else { 0 }])
        });
        let (found, labels) = find(&binary);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].area, found[0].centroid), (6, (3.0, 1.5)));
        assert_eq!((found[1].columns, found[1].extent()), ((10, 19), (10.0, 1.0)));
        assert_eq!(labels.get_pixel(3, 2).0[0], found[0].label);
    }

    #[test]
    fn a_turned_cross_is_fourfold_and_a_square_is_not() {
        let angle: f64 = 0.2;
        let (sin, cos) = libm::sincos(angle);
        let cross = GrayImage::from_fn(101, 101, |x, y| {
            let (dx, dy) = (f64::from(x) - 50.0, f64::from(y) - 50.0);
            let (u, v) = (dx * cos + dy * sin, -dx * sin + dy * cos);
            let bar = |along: f64, across: f64| along.abs() <= 40.0 && across.abs() <= 4.0;
            Luma([if bar(u, v) || bar(v, u) { 255 } else { 0 }])
        });
        let (found, _) = find(&cross);
        assert!(found[0].fourfold > 0.85, "{}", found[0].fourfold);
        // Half a pixel at the end of an arm.
        assert!((found[0].angle_rad - angle).abs() < 0.5 / 40.0, "{}", found[0].angle_rad);
        let square = GrayImage::from_fn(60, 60, |x, y| {
            Luma([if (10..50).contains(&x) && (10..50).contains(&y) { 255 } else { 0 }])
        });
        assert!(find(&square).0[0].fourfold < 0.3);
    }

    #[test]
    fn an_image_without_regions_has_none() {
        assert!(find(&GrayImage::new(5, 5)).0.is_empty());
        assert!(find(&GrayImage::new(0, 0)).0.is_empty());
    }
}
