//! Rasterisation of a window of a frame.

use contract::Window;

use super::stretch::{Greys, White};
use crate::canvas::colour::{NO_DATA, Rgb};
use crate::layout::view::Placement;
use crate::panel::{Panel, Pixels, Reduction};

/// Returns the pixels of a window, stretched and scaled for a placement, row by row.
pub(crate) fn raster(panel: &Panel, window: Window, placement: &Placement, white: White) -> Vec<Rgb> {
    let shades = Shades::new(panel, window, white);
    let columns = spans(placement.width, placement.zoom, window.columns);
    let rows = spans(placement.height, placement.zoom, window.rows);
    let mut pixels = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        pixels.extend(columns.iter().map(|column| match panel.reduction {
            Reduction::Brightest => shades.brightest(column, row),
            Reduction::Mean => shades.mean(column, row),
        }));
    }
    pixels
}

/// Greys of a window's pixels; `None` for a pixel that was not transmitted.
struct Shades {
    columns: usize,
    greys: Vec<Option<u8>>,
}

impl Shades {
    fn new(panel: &Panel, window: Window, white: White) -> Self {
        let Pixels { columns, dn, full_scale_dn, .. } = &panel.pixels;
        let mut transmitted = vec![panel.regions.is_none(); window.columns * window.rows];
        for region in panel.regions.iter().flatten() {
            for (y, row) in transmitted.chunks_mut(window.columns.max(1)).enumerate() {
                let inside = (region.y..region.y + region.rows).contains(&(window.y + y));
                for (x, pixel) in row.iter_mut().enumerate().filter(|_| inside) {
                    *pixel |= (region.x..region.x + region.columns).contains(&(window.x + x));
                }
            }
        }
        let row = |y: usize| {
            let first = (window.y + y) * columns + window.x;
            dn.get(first..first + window.columns).unwrap_or_default().iter().copied()
        };
        let values: Vec<Option<u16>> = (0..window.rows)
            .flat_map(row)
            .zip(transmitted)
            .map(|(dn, is_there)| is_there.then_some(dn))
            .collect();
        let mut samples: Vec<u16> = values.iter().copied().flatten().collect();
        let greys = Greys::new(panel.stretch, white, *full_scale_dn, &mut samples);
        Self {
            columns: window.columns,
            greys: values.into_iter().map(|dn| dn.map(|dn| greys.grey(dn))).collect(),
        }
    }

    /// Returns the grey of a pixel, whose column and row count from the window's first.
    fn grey_at(&self, x: usize, y: usize) -> Option<u8> {
        self.greys.get(y * self.columns + x).copied().flatten()
    }

    fn brightest(&self, columns: &Span, rows: &Span) -> Rgb {
        let of_row = |(y, _)| columns.cells().filter_map(move |(x, _)| self.grey_at(x, y));
        rows.cells().flat_map(of_row).max().map_or(NO_DATA, |grey| [grey; 3])
    }

    fn mean(&self, columns: &Span, rows: &Span) -> Rgb {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (y, high) in rows.cells() {
            for (x, wide) in columns.cells() {
                if let Some(grey) = self.grey_at(x, y) {
                    sum += high * wide * f64::from(grey);
                    weights += high * wide;
                }
            }
        }
        if weights > 0.0 { [(sum / weights).round() as u8; 3] } else { NO_DATA }
    }
}

/// Interval along one side of the window that one pixel of the picture covers, px of the window.
struct Span {
    from: f64,
    to: f64,
    /// Number of pixels along this side of the window.
    limit: usize,
}

/// Returns the intervals of a side of `count` pixels of the picture.
fn spans(count: usize, zoom: f64, limit: usize) -> Vec<Span> {
    let span = |i: usize| match zoom >= 1.0 {
        // The entire pixel under the middle of the picture's pixel.
        true => {
            let from = ((i as f64 + 0.5) / zoom).floor();
            Span { from, to: from + 1.0, limit }
        }
        false => Span { from: i as f64 / zoom, to: (i as f64 + 1.0) / zoom, limit },
    };
    (0..count).map(span).collect()
}

impl Span {
    /// Returns the pixels of the frame in this interval, each with the covered fraction.
    fn cells(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let last = (self.to.ceil() as usize).min(self.limit);
        let part = |cell: usize| self.to.min(cell as f64 + 1.0) - self.from.max(cell as f64);
        (self.from.floor() as usize..last)
            .map(move |cell| (cell, part(cell)))
            .filter(|(_, part)| *part > 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::PlateScale;
    use crate::panel::stretch::Stretch;

    fn panel(columns: usize, rows: usize, dn: Vec<u16>, reduction: Reduction) -> Panel {
        let pixels = Pixels { columns, rows, dn, full_scale_dn: 255 };
        Panel {
            view: pixels.full_window(),
            pixels,
            regions: None,
            close_up: None,
            stretch: Stretch::Full,
            reduction,
            scale: PlateScale { focal_length_px: 1000.0, range_m: None },
            marks: Vec::new(),
            title: String::new(),
            short_title: String::new(),
            verdict: None,
            tables: Vec::new(),
            caption: Vec::new(),
        }
    }

    fn rastered(panel: &Panel, room: (usize, usize)) -> Vec<u8> {
        let placement = Placement::fit(panel.view, room, 9);
        raster(panel, panel.view, &placement, White::Sky).into_iter().map(|[red, ..]| red).collect()
    }

    #[test]
    fn enlarged_pixels_are_squares() {
        let panel = panel(2, 1, vec![10, 20], Reduction::Mean);
        assert_eq!(rastered(&panel, (4, 4)), [10, 10, 20, 20, 10, 10, 20, 20]);
    }

    #[test]
    fn reduced_pixels_are_the_brightest_or_the_mean_by_area() {
        let dn = vec![0, 100, 0, 40, 0, 0];
        assert_eq!(rastered(&panel(6, 1, dn.clone(), Reduction::Brightest), (3, 1)), [100, 40, 0]);
        assert_eq!(rastered(&panel(6, 1, dn.clone(), Reduction::Mean), (3, 1)), [50, 20, 0]);
        // Means over two and a half pixels each: (0 + 100 + 0/2)/2.5, (0/2 + 40 + 0)/2.5.
        let five = panel(5, 1, dn.into_iter().take(5).collect(), Reduction::Mean);
        assert_eq!(rastered(&five, (2, 1)), [40, 16]);
    }

    #[test]
    fn untransmitted_pixels_have_a_separate_colour_and_no_part_in_the_stretch() {
        let regions = Some(vec![Window { x: 1, y: 0, columns: 2, rows: 1 }]);
        let mut panel = Panel { regions, ..panel(4, 1, vec![0, 50, 60, 255], Reduction::Brightest) };
        panel.stretch = Stretch::Linear;
        let placement = Placement::fit(panel.view, (4, 1), 9);
        let pixels = raster(&panel, panel.view, &placement, White::Sky);
        assert_eq!(pixels, [NO_DATA, [0; 3], [255; 3], NO_DATA]);
    }
}
