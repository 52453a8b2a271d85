//! Connected regions of a binary image, with measures of their shape.

use imageproc::image::GrayImage;

/// Connected region, in pixels of its image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Component {
    /// Number of pixels.
    pub(crate) area: u32,
    /// First and last column.
    pub(crate) columns: (u32, u32),
    /// First and last row.
    pub(crate) rows: (u32, u32),
    /// Mean column and row.
    pub(crate) centroid: (f64, f64),
    /// Similarity to a cross, 0 to 1: |Σ r² exp(4 i θ)| / Σ r² about the centroid. A cross of thin bars and
    /// its outline have 1, a square or a disk about 0.
    pub(crate) fourfold: f64,
    /// Angle of the fourfold shape from the columns' direction, towards increasing rows, −45° to 45°, rad.
    pub(crate) angle_rad: f64,
}

impl Component {
    const EMPTY: Self = Self {
        area: 0,
        columns: (u32::MAX, 0),
        rows: (u32::MAX, 0),
        centroid: (0.0, 0.0),
        fourfold: 0.0,
        angle_rad: 0.0,
    };

    /// Returns the numbers of columns and rows that the region spans.
    pub(crate) fn extent(&self) -> (f64, f64) {
        (f64::from(self.columns.1 - self.columns.0) + 1.0, f64::from(self.rows.1 - self.rows.0) + 1.0)
    }

    /// Returns the centre of the region's bounding rectangle.
    pub(crate) fn middle(&self) -> (f64, f64) {
        (f64::from(self.columns.0 + self.columns.1) / 2.0, f64::from(self.rows.0 + self.rows.1) / 2.0)
    }
}

/// Horizontal run of white pixels: row, first and last column, and index of its region.
struct Run {
    row: u32,
    columns: (u32, u32),
    region: usize,
}

/// Finds the white regions of a binary image (8-connected) for which `is_wanted` returns true. `is_wanted` is
/// called before the fourfold shape is computed, which is the most expensive part and is done only for the
/// regions selected. Regions are in the order in which the rows meet them.
///
/// Joins the runs of the rows (Rosenfeld and Pfaltz 1966): a field has far fewer runs than pixels.
pub(crate) fn find(binary: &GrayImage, is_wanted: impl Fn(&Component) -> bool) -> Vec<Component> {
    let mut runs = runs(binary);
    let count = join(&mut runs);
    let mut found = vec![Component::EMPTY; count];
    for Run { row, columns: (first, last), region } in &runs {
        let component = &mut found[*region];
        let n = last - first + 1;
        component.area += n;
        component.columns = (component.columns.0.min(*first), component.columns.1.max(*last));
        component.rows = (component.rows.0.min(*row), component.rows.1.max(*row));
        component.centroid.0 += f64::from(n) * f64::from(first + last) / 2.0;
        component.centroid.1 += f64::from(n) * f64::from(*row);
    }
    let mut wanted = Vec::with_capacity(count);
    for component in &mut found {
        let n = f64::from(component.area.max(1));
        component.centroid = (component.centroid.0 / n, component.centroid.1 / n);
        wanted.push(is_wanted(component));
    }
    let mut moments = vec![(0.0, 0.0, 0.0); count];
    for Run { row, columns: (first, last), region } in runs.iter().filter(|run| wanted[run.region]) {
        let centroid = found[*region].centroid;
        let moments = &mut moments[*region];
        let dy = f64::from(*row) - centroid.1;
        let dy2 = dy * dy;
        for x in *first..=*last {
            let dx = f64::from(x) - centroid.0;
            let dx2 = dx * dx;
            let r2 = dx2 + dy2;
            if r2 > 0.0 {
                // r² cos 4θ and r² sin 4θ, without computing θ.
                moments.0 += (dx2 * dx2 - 6.0 * dx2 * dy2 + dy2 * dy2) / r2;
                moments.1 += 4.0 * dx * dy * (dx2 - dy2) / r2;
                moments.2 += r2;
            }
        }
    }
    for (component, (cos, sin, r2)) in found.iter_mut().zip(moments) {
        if r2 > 0.0 {
            component.fourfold = libm::hypot(cos, sin) / r2;
            component.angle_rad = libm::atan2(sin, cos) / 4.0;
        }
    }
    found
        .into_iter()
        .zip(wanted)
        .filter(|(_, is_wanted)| *is_wanted)
        .map(|(component, _)| component)
        .collect()
}

/// Returns the runs of white pixels, row by row, each as a separate region.
fn runs(binary: &GrayImage) -> Vec<Run> {
    let width = binary.width() as usize;
    let mut runs = Vec::new();
    if width == 0 {
        return runs;
    }
    for (row, pixels) in binary.as_raw().chunks_exact(width).enumerate() {
        let mut first = None;
        for (column, value) in pixels.iter().chain([&0]).enumerate() {
            match (first, *value != 0) {
                (None, true) => first = Some(column),
                (Some(start), false) => {
                    let columns = (start as u32, column as u32 - 1);
                    runs.push(Run { row: row as u32, columns, region: runs.len() });
                    first = None;
                }
                _ => {}
            }
        }
    }
    runs
}

/// Assigns one region to runs that touch, corners included. Regions are numbered in the order of their first
/// runs. Returns the number of regions.
fn join(runs: &mut [Run]) -> usize {
    // `region` is at first the index of an earlier run of the same region; the first run of a region has its
    // own index.
    fn root(runs: &mut [Run], mut i: usize) -> usize {
        while runs[i].region != i {
            let next = runs[i].region;
            runs[i].region = runs[next].region;
            i = next;
        }
        i
    }
    let mut above = 0;
    for here in 0..runs.len() {
        let (row, (first, last)) = (runs[here].row, runs[here].columns);
        // Skips runs that touch neither this run nor later ones: runs of earlier rows, and runs of the row
        // above that end before this run begins.
        while above < here
            && (runs[above].row + 1 < row
                || (runs[above].row + 1 == row && runs[above].columns.1 + 1 < first))
        {
            above += 1;
        }
        let mut other = above;
        while other < here && runs[other].row + 1 == row && runs[other].columns.0 <= last + 1 {
            let (a, b) = (root(runs, other), root(runs, here));
            runs[a.max(b)].region = a.min(b);
            other += 1;
        }
    }
    let mut count = 0;
    let mut numbers = vec![0; runs.len()];
    // The first run of a region precedes its other runs, so its number is set before they need it.
    for i in 0..runs.len() {
        let first = root(runs, i);
        if first == i {
            numbers[i] = count;
            count += 1;
        } else {
            numbers[i] = numbers[first];
        }
    }
    for (run, number) in runs.iter_mut().zip(numbers) {
        run.region = number;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use imageproc::image::Luma;

    fn all(binary: &GrayImage) -> Vec<Component> {
        find(binary, |_| true)
    }

    /// Against imageproc's labels, on an image of many entangled regions.
    #[test]
    fn the_regions_are_those_of_a_labelled_image() {
        use imageproc::region_labelling::{Connectivity, connected_components};
        for seed in 0..6u32 {
            let binary = GrayImage::from_fn(83, 61, |x, y| {
                let mixed = (x * 7919 + y * 104_729 + seed * 31_337).wrapping_mul(2_654_435_761);
                Luma([if (mixed >> 16) % 100 < 25 + 8 * seed { 255 } else { 0 }])
            });
            let labels = connected_components(&binary, Connectivity::Eight, Luma([0]));
            let count = labels.pixels().map(|p| p.0[0]).max().unwrap_or(0) as usize;
            let mut areas = vec![0u32; count];
            labels.pixels().filter(|p| p.0[0] > 0).for_each(|p| areas[p.0[0] as usize - 1] += 1);
            let mut mine: Vec<u32> = all(&binary).iter().map(|component| component.area).collect();
            areas.sort_unstable();
            mine.sort_unstable();
            assert_eq!(mine, areas);
        }
    }

    #[test]
    fn two_regions_have_their_positions_and_areas() {
        let binary = GrayImage::from_fn(20, 10, |x, y| {
            let first = (2..5).contains(&x) && (1..3).contains(&y);
            let second = (10..20).contains(&x) && y == 8;
            Luma([if first || second { 255 } else { 0 }])
        });
        let found = all(&binary);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].area, found[0].centroid), (6, (3.0, 1.5)));
        assert_eq!((found[1].columns, found[1].extent()), ((10, 19), (10.0, 1.0)));
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
        let found = all(&cross);
        assert!(found[0].fourfold > 0.85, "{}", found[0].fourfold);
        // Half a pixel at the end of an arm.
        assert!((found[0].angle_rad - angle).abs() < 0.5 / 40.0, "{}", found[0].angle_rad);
        let square = GrayImage::from_fn(60, 60, |x, y| {
            Luma([if (10..50).contains(&x) && (10..50).contains(&y) { 255 } else { 0 }])
        });
        assert!(all(&square)[0].fourfold < 0.3);
    }

    #[test]
    fn an_image_without_regions_has_none() {
        assert!(all(&GrayImage::new(5, 5)).is_empty());
        assert!(all(&GrayImage::new(0, 0)).is_empty());
    }
}
