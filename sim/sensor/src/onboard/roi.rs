//! Regions of interest: the camera keeps fixed rectangles around bright pixels and drops all other pixels.
//!
//! The camera of the far-range paper (sections 3 and 4) sends regions of fixed size. It scans by rows and
//! meets an object at its topmost bright row, so the region's position depends on the top of the object: an
//! object taller than the region keeps its top and loses its bottom. This truncates the object in y, not in
//! x, and biases the declination. A scan by columns truncates in x.

use contract::bounds::{self, require};
use contract::{Camera, OutOfRange, Window};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::downlink::region_bytes;
use crate::RawImage;

/// Order in which the camera scans its pixels. It determines the order of the regions, and which pixel of an
/// object is found first and placed at the anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScanOrder {
    /// Order by rows from the top, each row from the left.
    #[default]
    Rows,
    /// Order by columns from the left, each column from the top.
    Columns,
}

impl ScanOrder {
    /// Sort key of a pixel, given by column and row.
    fn key(self, (x, y): (usize, usize)) -> (usize, usize) {
        match self {
            Self::Rows => (y, x),
            Self::Columns => (x, y),
        }
    }
}

/// Regions of interest of a fixed size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoiConfig {
    /// Maximum number of regions in a frame, 1 to 10000. If there are more objects, those with the brightest
    /// pixels are kept.
    #[schemars(range(min = 1, max = 10000))]
    pub count: usize,
    /// Number of columns of a region, 1 to the columns of the detector.
    #[schemars(range(min = 1, max = Camera::MAX_SIDE_PX))]
    pub columns: usize,
    /// Number of rows of a region, 1 to the rows of the detector.
    #[schemars(range(min = 1, max = Camera::MAX_SIDE_PX))]
    pub rows: usize,
    /// Column of the region in which the first bright pixel of an object lies, from 0, below `columns`.
    #[schemars(range(max = Camera::MAX_SIDE_PX))]
    pub anchor_column: usize,
    /// Row of the region in which the first bright pixel of an object lies, from 0, below `rows`.
    #[schemars(range(max = Camera::MAX_SIDE_PX))]
    pub anchor_row: usize,
    /// Threshold above which a pixel is bright, DN, 0 to 65535.
    pub threshold_dn: u16,
    /// Order of the scan.
    #[serde(default)]
    pub scan: ScanOrder,
}

impl RoiConfig {
    /// Checks all values for a detector of `columns` × `rows`.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self, columns: usize, rows: usize) -> Result<(), OutOfRange> {
        bounds::check(self, "roi")?;
        for (path, side, limit, expected) in [
            ("roi.columns", self.columns, columns, "1 to the detector's columns"),
            ("roi.rows", self.rows, rows, "1 to the detector's rows"),
            ("roi.anchor_column", self.anchor_column, self.columns - 1, "0 to roi.columns − 1"),
            ("roi.anchor_row", self.anchor_row, self.rows - 1, "0 to roi.rows − 1"),
        ] {
            require(path, side as f64, expected, |_| side <= limit)?;
        }
        Ok(())
    }

    /// Maximum size of a frame in telemetry, bytes, with a converter of `bit_depth` bits: `count` regions,
    /// counted as in [`super::downlink_bytes`].
    pub fn budget_bytes(&self, bit_depth: u8) -> usize {
        self.count * region_bytes(self.columns, self.rows, bit_depth)
    }
}

/// Finds the regions of a frame by the camera's method. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct RoiExtractor {
    config: RoiConfig,
    /// Flags of the pixels that belong to an object already found; all false between frames.
    taken: Vec<bool>,
    /// Bright pixels of the image, column and row, in the order of the scan.
    bright: Vec<(usize, usize)>,
    /// Pixels of the current object, column and row.
    pixels: Vec<(usize, usize)>,
}

/// Object found by the scan.
#[derive(Debug, Clone, Copy)]
struct Blob {
    first: (usize, usize),
    peak_dn: u16,
}

/// Number of pixels of a whole image that are searched as one run.
const RUN: usize = 64;

impl RoiExtractor {
    /// Creates the extractor for a detector of `columns` × `rows`.
    ///
    /// # Errors
    /// Those of [`RoiConfig::check`].
    pub fn new(config: &RoiConfig, columns: usize, rows: usize) -> Result<Self, OutOfRange> {
        config.check(columns, rows)?;
        Ok(Self {
            config: config.clone(),
            taken: vec![false; columns * rows],
            bright: Vec::new(),
            pixels: Vec::new(),
        })
    }

    /// Threshold above which a pixel is bright, DN.
    pub fn threshold_dn(&self) -> u16 {
        self.config.threshold_dn
    }

    /// Returns the regions of an image, in the order of the scan.
    ///
    /// A bright pixel that belongs to no object found before starts a new object: the bright pixels connected
    /// to it by edges or corners. The region is positioned with this first pixel at the anchor, and is
    /// shifted, not shrunk, if it would extend beyond the image. Regions of neighbouring objects may overlap.
    /// If there are too many regions, those with the brightest peaks are kept; among equal peaks, the region
    /// found first.
    pub fn extract(&mut self, image: &RawImage) -> Vec<Window> {
        let runs = image.dn().chunks(RUN).enumerate().map(|(i, run)| (i * RUN, run));
        self.extract_from(image, runs)
    }

    /// Performs [`RoiExtractor::extract`] on an image that is dark outside `runs`. Each run is the index of
    /// its first pixel and its digital numbers; runs are in the order of the image.
    pub fn extract_from<'a>(
        &mut self,
        image: &RawImage,
        runs: impl Iterator<Item = (usize, &'a [u16])>,
    ) -> Vec<Window> {
        let mut blobs = self.blobs(image, runs);
        if blobs.len() > self.config.count {
            // A stable sort: equal peaks stay in the order of the scan.
            blobs.sort_by_key(|blob| std::cmp::Reverse(blob.peak_dn));
            blobs.truncate(self.config.count);
            blobs.sort_by_key(|blob| self.config.scan.key(blob.first));
        }
        blobs.iter().map(|blob| self.window_at(blob.first, image.size())).collect()
    }

    fn window_at(&self, first: (usize, usize), size: (usize, usize)) -> Window {
        let RoiConfig { columns, rows, anchor_column, anchor_row, .. } = self.config;
        Window {
            x: first.0.saturating_sub(anchor_column).min(size.0.saturating_sub(columns)),
            y: first.1.saturating_sub(anchor_row).min(size.1.saturating_sub(rows)),
            columns: columns.min(size.0),
            rows: rows.min(size.1),
        }
    }

    /// Finds all objects, in the order of the scan.
    fn blobs<'a>(&mut self, image: &RawImage, runs: impl Iterator<Item = (usize, &'a [u16])>) -> Vec<Blob> {
        let (columns, rows) = image.size();
        self.taken.resize(columns * rows, false);
        let mut bright = std::mem::take(&mut self.bright);
        self.find_bright(columns, runs, &mut bright);
        let mut blobs = Vec::new();
        for &(x, y) in &bright {
            if !self.taken[y * columns + x] {
                blobs.push(self.take_blob(image, (x, y)));
            }
        }
        for &(x, y) in &bright {
            self.taken[y * columns + x] = false;
        }
        self.bright = bright;
        blobs
    }

    /// Fills `bright` with the pixels above the threshold, in the order of the scan.
    fn find_bright<'a>(
        &self,
        columns: usize,
        runs: impl Iterator<Item = (usize, &'a [u16])>,
        bright: &mut Vec<(usize, usize)>,
    ) {
        let RoiConfig { threshold_dn, scan, .. } = self.config;
        bright.clear();
        for (first, run) in runs {
            // Nearly all runs are dark.
            if run.iter().fold(0, |peak, &dn| peak.max(dn)) <= threshold_dn {
                continue;
            }
            let above = run.iter().enumerate().filter(|&(_, &dn)| dn > threshold_dn);
            bright.extend(above.map(|(i, _)| ((first + i) % columns, (first + i) / columns)));
        }
        // The pixels were found row by row.
        if scan != ScanOrder::Rows {
            bright.sort_unstable_by_key(|&pixel| scan.key(pixel));
        }
    }

    /// Collects the bright pixels connected to `first`.
    fn take_blob(&mut self, image: &RawImage, first: (usize, usize)) -> Blob {
        let (columns, rows) = image.size();
        let dn = image.dn();
        let mut peak_dn = 0;
        self.taken[first.1 * columns + first.0] = true;
        self.pixels.clear();
        self.pixels.push(first);
        let mut next = 0;
        while let Some(&(x, y)) = self.pixels.get(next) {
            next += 1;
            peak_dn = peak_dn.max(dn[y * columns + x]);
            for near_y in y.saturating_sub(1)..(y + 2).min(rows) {
                for near_x in x.saturating_sub(1)..(x + 2).min(columns) {
                    let index = near_y * columns + near_x;
                    if dn[index] > self.config.threshold_dn && !self.taken[index] {
                        self.taken[index] = true;
                        self.pixels.push((near_x, near_y));
                    }
                }
            }
        }
        Blob { first, peak_dn }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RawImage;

    fn config() -> RoiConfig {
        RoiConfig {
            count: 10,
            columns: 8,
            rows: 6,
            anchor_column: 4,
            anchor_row: 1,
            threshold_dn: 100,
            scan: ScanOrder::Rows,
        }
    }

    /// Image of 100 × 50 with bright rectangles (x, y, columns, rows, DN).
    fn image(blobs: &[(usize, usize, usize, usize, u16)]) -> RawImage {
        let mut dn = vec![50; 5000];
        for &(x, y, columns, rows, value) in blobs {
            for row in y..y + rows {
                dn[row * 100 + x..row * 100 + x + columns].fill(value);
            }
        }
        RawImage::from_dn(100, 50, 12, dn)
    }

    fn windows(config: &RoiConfig, blobs: &[(usize, usize, usize, usize, u16)]) -> Vec<Window> {
        RoiExtractor::new(config, 100, 50).unwrap().extract(&image(blobs))
    }

    fn window(x: usize, y: usize) -> Window {
        Window { x, y, columns: 8, rows: 6 }
    }

    #[test]
    fn a_small_object_is_whole() {
        let found = windows(&config(), &[(30, 20, 3, 3, 200)]);
        assert_eq!(found, [window(26, 19)]);
        assert!((30..33).all(|x| (20..23).all(|y| found[0].contains(x, y))));
    }

    #[test]
    fn a_tall_object_loses_its_bottom_and_nothing_else() {
        let found = windows(&config(), &[(30, 20, 3, 9, 200)]);
        assert_eq!(found, [window(26, 19)]);
        let kept = |y| (30..33).all(|x| found[0].contains(x, y));
        assert!((20..25).all(kept) && !(25..29).any(kept));
    }

    /// The first pixel found is the leftmost of the topmost row: the anchor leaves room on both sides.
    #[test]
    fn a_round_object_is_not_cut_in_x() {
        let found = windows(&config(), &[(32, 20, 2, 1, 200), (31, 21, 4, 1, 200), (30, 22, 6, 7, 200)]);
        assert_eq!(found, [window(28, 19)]);
        assert!((30..36).all(|x| found[0].contains(x, 22)));
    }

    /// A scan by columns equals a scan by rows of the transposed image.
    #[test]
    fn a_scan_by_columns_meets_the_left_side_first_and_cuts_on_the_right() {
        let by_columns = RoiConfig { scan: ScanOrder::Columns, anchor_column: 1, anchor_row: 3, ..config() };
        let found = windows(&by_columns, &[(30, 20, 9, 3, 200), (20, 30, 1, 1, 300)]);
        // The left object comes first, although it is lower; of a wide object the first seven columns are
        // kept.
        assert_eq!(found, [window(19, 27), window(29, 17)]);
        let kept = |x| (20..23).all(|y| found[1].contains(x, y));
        assert!((30..37).all(kept) && !(37..39).any(kept));

        let blobs = [(30, 20, 9, 3, 200), (2, 3, 4, 1, 900), (6, 4, 1, 1, 300), (20, 30, 1, 1, 300)];
        let turned = blobs.map(|(x, y, columns, rows, dn)| (y, x, rows, columns, dn));
        let by_rows = RoiConfig { columns: 6, rows: 8, anchor_column: 3, anchor_row: 1, ..config() };
        let back = |w: &Window| Window { x: w.y, y: w.x, columns: w.rows, rows: w.columns };
        let expected: Vec<Window> = windows(&by_rows, &turned).iter().map(back).collect();
        assert_eq!(windows(&by_columns, &blobs), expected);
        assert_eq!(expected.len(), 3);
    }

    #[test]
    fn of_too_many_objects_those_kept_stand_in_the_order_of_a_scan_by_columns() {
        let config = RoiConfig { count: 2, scan: ScanOrder::Columns, ..config() };
        let found = windows(&config, &[(10, 25, 1, 1, 300), (50, 10, 1, 1, 200), (30, 20, 1, 1, 900)]);
        assert_eq!(found, [window(6, 24), window(26, 19)]);
    }

    /// The budget equals the size that the downlink counts when all regions are present.
    #[test]
    fn the_budget_is_that_of_a_frame_with_all_its_regions() {
        for (bit_depth, columns, rows) in [(12, 8, 6), (12, 7, 5), (8, 3, 3), (16, 1, 1)] {
            let config = RoiConfig { columns, rows, anchor_column: 0, anchor_row: 0, ..config() };
            let mut dn = vec![0; 5000];
            (0..20).for_each(|i| dn[10 * 100 * (i / 10) + 10 * (i % 10)] = 200);
            let image = RawImage::from_dn(100, 50, bit_depth, dn);
            let found = RoiExtractor::new(&config, 100, 50).unwrap().extract(&image);
            assert_eq!(found.len(), 10);
            let frame = crate::onboard::downlink(&image, 0, Some(found)).unwrap();
            assert_eq!(config.budget_bytes(bit_depth), crate::onboard::downlink_bytes(&frame));
        }
        // Ten regions of 8 bytes and 48 pixels of 12 bits.
        assert_eq!(config().budget_bytes(12), 10 * (8 + 72));
    }

    #[test]
    fn pixels_that_touch_at_a_corner_are_one_object() {
        assert_eq!(
            windows(&config(), &[(30, 20, 1, 1, 200), (31, 21, 1, 1, 200), (30, 22, 1, 1, 300)]).len(),
            1
        );
        assert_eq!(windows(&config(), &[(30, 20, 1, 1, 200), (32, 20, 1, 1, 200)]).len(), 2);
    }

    #[test]
    fn of_too_many_objects_the_brightest_are_kept_in_the_order_of_the_scan() {
        let config = RoiConfig { count: 2, ..config() };
        let found = windows(&config, &[(10, 5, 1, 1, 300), (50, 10, 1, 1, 200), (30, 20, 1, 1, 900)]);
        assert_eq!(found, [window(6, 4), window(26, 19)]);
        let found = windows(&config, &[(10, 5, 1, 1, 300), (50, 10, 1, 1, 300), (30, 20, 1, 1, 300)]);
        assert_eq!(found, [window(6, 4), window(46, 9)]);
    }

    #[test]
    fn at_a_border_a_region_is_shifted_and_keeps_its_size() {
        let found = windows(&config(), &[(0, 0, 1, 1, 200), (99, 0, 1, 1, 200), (99, 49, 1, 1, 200)]);
        assert_eq!(found, [window(0, 0), window(92, 0), window(92, 44)]);
    }

    #[test]
    fn the_threshold_itself_is_not_bright() {
        assert!(windows(&config(), &[(30, 20, 3, 3, 100)]).is_empty());
        assert_eq!(windows(&config(), &[(30, 20, 3, 3, 101)]).len(), 1);
    }

    #[test]
    fn frames_are_independent_of_earlier_frames() {
        let mut extractor = RoiExtractor::new(&config(), 100, 50).unwrap();
        let first = extractor.extract(&image(&[(30, 20, 3, 9, 200)]));
        assert_eq!(extractor.extract(&image(&[])), []);
        assert_eq!(extractor.extract(&image(&[(30, 20, 3, 9, 200)])), first);
    }

    #[test]
    fn a_frame_that_is_bright_all_over_is_one_object() {
        assert_eq!(windows(&config(), &[(0, 0, 100, 50, 200)]), [window(0, 0)]);
    }

    #[test]
    fn a_region_larger_than_the_detector_is_refused() {
        let error = RoiExtractor::new(&RoiConfig { columns: 101, ..config() }, 100, 50).unwrap_err();
        assert!(error.to_string().contains("roi.columns"));
        assert!(RoiConfig { anchor_row: 6, ..config() }.check(100, 50).is_err());
    }
}
