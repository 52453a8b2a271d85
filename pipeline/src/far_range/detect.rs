//! Detection of clusters of bright pixels (section 2.1, Eqs. 1 and 2).

use contract::{Frame, PixelPoint, Window};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::threshold::Thresholds;

/// Weights of the pixels of a cluster in Eqs. 1 and 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Weights {
    /// Intensity I in [0, 1], as printed. The background under the cluster also contributes and pulls the
    /// centre towards the middle of the set of pixels: a bias wherever the set is not symmetric.
    #[default]
    Intensity,
    /// Intensity above the frame's median, at least 0.
    AboveBackground,
}

/// Cluster: connected pixels (8 neighbours), each above I1 and at least one above I2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Blob {
    /// Centre of brightness c (Eq. 1).
    pub(super) centre: PixelPoint,
    /// Weighted size s (Eq. 2), in units of full scale.
    pub(super) size: f64,
    /// Number of pixels.
    pub(super) pixels: u32,
}

/// Detector of clusters. Its buffers are reused, so a frame of the same size as the previous one needs no
/// allocation.
#[derive(Debug, Default)]
pub(super) struct Detector {
    /// Flags of pixels in a cluster of this frame, one bit per pixel.
    marked: Vec<u64>,
    /// Pixels of all clusters of the frame, one cluster after the other. Also the queue of the fill.
    members: Vec<u32>,
    blobs: Vec<Blob>,
    /// Index into `members` of the first pixel of each cluster.
    first_members: Vec<usize>,
    bright: BrightChunks,
}

/// Chunks of a frame that contain a bright pixel.
#[derive(Debug, Default)]
struct BrightChunks {
    /// Flags of the chunks, one bit per chunk, lowest bit of a word first.
    words: Vec<u64>,
    /// Number of pixels at full scale.
    saturated: usize,
}

/// Number of chunks per word.
const OF_A_WORD: usize = u64::BITS as usize;

impl BrightChunks {
    /// Finds the chunks with a pixel above `above_dn` or at full scale.
    fn find(&mut self, frame: &Frame, above_dn: u16) {
        let full_scale = frame.full_scale_dn();
        let count = frame.dn().len().div_ceil(CHUNK);
        self.words.clear();
        self.words.resize(count.div_ceil(OF_A_WORD), 0);
        let from_dn = above_dn.saturating_add(1).min(full_scale);
        let (dn, columns) = (frame.dn(), frame.columns());
        pulp::Arch::new().dispatch(FindBright {
            words: &mut self.words,
            dn,
            columns,
            windows: frame.windows(),
            from_dn,
        });
        let of_full_scale = |chunk: &[u16]| chunk.iter().filter(|&&dn| dn >= full_scale).count();
        self.saturated = self.chunks(frame).map(|(_, chunk)| of_full_scale(chunk)).sum();
    }

    /// Returns the index of the first pixel and the pixels of each bright chunk, in the order of the frame.
    fn chunks<'a>(&'a self, frame: &'a Frame) -> impl Iterator<Item = (usize, &'a [u16])> {
        let dn = frame.dn();
        self.words.iter().enumerate().filter(|(_, word)| **word != 0).flat_map(move |(i, &word)| {
            // Each word is the previous one without its lowest set bit.
            std::iter::successors(Some(word), |word| Some(word & word.wrapping_sub(1)))
                .take_while(|word| *word != 0)
                .map(move |word| {
                    let first = (i * OF_A_WORD + word.trailing_zeros() as usize) * CHUNK;
                    (first, &dn[first..(first + CHUNK).min(dn.len())])
                })
        })
    }
}

/// Search for the bright chunks of an image, on the widest registers of the machine.
struct FindBright<'a> {
    words: &'a mut [u64],
    dn: &'a [u16],
    columns: usize,
    /// Transmitted regions; all other pixels are 0. `None` if all pixels were transmitted.
    windows: Option<&'a [Window]>,
    from_dn: u16,
}

impl pulp::WithSimd for FindBright<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { words, dn, columns, windows, from_dn } = self;
        let Some(windows) = windows else {
            for (word, dn) in words.iter_mut().zip(dn.chunks(OF_A_WORD * CHUNK)) {
                let (chunks, rest) = dn.as_chunks::<CHUNK>();
                for (i, chunk) in chunks.iter().enumerate() {
                    *word |= u64::from(holds_from(from_dn, chunk)) << i;
                }
                if !rest.is_empty() {
                    *word |= u64::from(holds_from(from_dn, rest)) << chunks.len();
                }
            }
            return;
        };
        for window in windows {
            for y in window.y..window.y + window.rows {
                let first = y * columns + window.x;
                for chunk in first / CHUNK..=(first + window.columns - 1) / CHUNK {
                    let pixels = &dn[chunk * CHUNK..((chunk + 1) * CHUNK).min(dn.len())];
                    words[chunk / OF_A_WORD] |= u64::from(holds_from(from_dn, pixels)) << (chunk % OF_A_WORD);
                }
            }
        }
    }
}

/// Returns true if any of the pixels is `dn` or more. Compares all of them at once, without an early exit.
#[inline(always)]
fn holds_from(dn: u16, pixels: &[u16]) -> bool {
    pixels.iter().fold(false, |any, &pixel| any | (pixel >= dn))
}

/// Number of pixels compared at once in the search for pixels above I2; a multiple of any vector's length.
const CHUNK: usize = 32;

/// Number of pixels compared at once within a bright chunk. If any of them is above the threshold, they are
/// tested one by one.
const GROUP_PIXELS: usize = 8;

impl Detector {
    /// Scans a frame for the following [`Detector::detect`] with the same thresholds. Returns the number of
    /// pixels at full scale.
    pub(super) fn find_bright(&mut self, frame: &Frame, thresholds: Thresholds) -> usize {
        self.bright.find(frame, thresholds.high_dn);
        self.bright.saturated
    }

    /// Returns the clusters of the scanned frame, in the order of their first bright pixel row by row. Keeps
    /// at most `max_clusters`, those of the largest weighted size.
    ///
    /// Pixels outside the frame's windows are 0 and therefore never above a threshold. `base_dn` is
    /// subtracted from every pixel before weighting (0 for [`Weights::Intensity`]); a cluster without any
    /// remaining weight is dropped.
    pub(super) fn detect(
        &mut self,
        frame: &Frame,
        thresholds: Thresholds,
        base_dn: f64,
        max_clusters: usize,
    ) -> &[Blob] {
        self.blobs.clear();
        self.first_members.clear();
        for &index in &self.members {
            self.marked[index as usize / 64] = 0;
        }
        self.members.clear();
        self.marked.resize(frame.dn().len().div_ceil(64), 0);
        let bright = std::mem::take(&mut self.bright);
        for (first, chunk) in bright.chunks(frame) {
            for (first, few) in (first..).step_by(GROUP_PIXELS).zip(chunk.chunks(GROUP_PIXELS)) {
                if !holds_from(thresholds.high_dn.saturating_add(1), few) {
                    continue;
                }
                for (index, &dn) in (first..).zip(few) {
                    if dn > thresholds.high_dn && !self.is_marked(index) {
                        let first = self.members.len();
                        if let Some(blob) = self.take(frame, index, thresholds.low_dn, base_dn) {
                            self.blobs.push(blob);
                            self.first_members.push(first);
                        }
                    }
                }
            }
        }
        self.bright = bright;
        if self.blobs.len() > max_clusters {
            let kept = largest(&self.blobs, max_clusters);
            self.first_members = kept.iter().map(|&i| self.first_members[i]).collect();
            self.blobs = kept.iter().map(|&i| self.blobs[i]).collect();
        }
        &self.blobs
    }

    /// Returns the pixels of cluster `i` of the last frame, as indices into its image.
    pub(super) fn members(&self, i: usize) -> &[u32] {
        let first = self.first_members[i];
        &self.members[first..first + self.blobs[i].pixels as usize]
    }

    /// Returns the pixels of all clusters of the last frame, including dropped ones, as indices into its
    /// image.
    pub(super) fn pixels_in_clusters(&self) -> impl Iterator<Item = usize> {
        self.members.iter().map(|&index| index as usize)
    }

    /// Returns true if a pixel of the last frame belongs to any cluster, including dropped ones.
    pub(super) fn is_in_cluster(&self, index: usize) -> bool {
        self.is_marked(index)
    }

    /// Collects the pixels connected to `seed` through pixels above `low_dn`, without recursion: the list of
    /// members is also the queue. Returns their cluster by Eqs. 1 and 2, or `None` when none of the pixels is
    /// above `base_dn`.
    fn take(&mut self, frame: &Frame, seed: usize, low_dn: u16, base_dn: f64) -> Option<Blob> {
        let (columns, rows) = (frame.columns(), frame.rows());
        let (dn, full_scale) = (frame.dn(), frame.full_scale_dn());
        let first = self.members.len();
        let mut next = first;
        let (mut sum, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
        self.mark(seed);
        while let Some(&index) = self.members.get(next) {
            next += 1;
            // Uses 32 bits, because a 64-bit division takes longer.
            let (x, y) = ((index % columns as u32) as usize, (index / columns as u32) as usize);
            let weight = (f64::from(dn[index as usize].min(full_scale)) - base_dn).max(0.0);
            sum += weight;
            sum_x += weight * x as f64;
            sum_y += weight * y as f64;
            let (left, right) = (x.saturating_sub(1), (x + 2).min(columns));
            for row in y.saturating_sub(1)..(y + 2).min(rows) {
                let first = row * columns + left;
                for (neighbour, &dn) in (first..).zip(&dn[first..row * columns + right]) {
                    if dn > low_dn && !self.is_marked(neighbour) {
                        self.mark(neighbour);
                    }
                }
            }
        }
        (sum > 0.0).then(|| Blob {
            centre: PixelPoint::new(sum_x / sum, sum_y / sum),
            size: sum / f64::from(full_scale),
            pixels: (self.members.len() - first) as u32,
        })
    }

    fn is_marked(&self, index: usize) -> bool {
        self.marked[index / 64] >> (index % 64) & 1 == 1
    }

    fn mark(&mut self, index: usize) {
        self.marked[index / 64] |= 1 << (index % 64);
        // An index fits in 32 bits below 16384² pixels.
        self.members.push(index as u32);
    }
}

/// Returns the indices of the `max_clusters` largest clusters, in the order of the frame.
fn largest(blobs: &[Blob], max_clusters: usize) -> Vec<usize> {
    let mut by_size: Vec<usize> = (0..blobs.len()).collect();
    // Among equal sizes, the first cluster in the frame is kept.
    by_size.sort_by(|&a, &b| blobs[b].size.total_cmp(&blobs[a].size).then(a.cmp(&b)));
    by_size.truncate(max_clusters);
    by_size.sort_unstable();
    by_size
}

/// Returns the number of transmitted pixels. With overlapping windows, it is limited to the number of pixels
/// of the image.
pub(super) fn transmitted_pixels(frame: &Frame) -> usize {
    let all = frame.columns() * frame.rows();
    frame.windows().map_or(all, |windows| {
        windows.iter().map(|window| window.columns * window.rows).sum::<usize>().min(all)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns a 12-bit frame drawn in characters: '.' 0, digits hundreds of DN, '#' full scale.
    fn drawn(rows: &[&str]) -> Frame {
        let dn = rows
            .iter()
            .flat_map(|row| row.chars())
            .map(|c| match c {
                '.' => 0,
                '#' => 4095,
                digit => 100 * digit.to_digit(10).unwrap() as u16,
            })
            .collect();
        Frame::new(0, rows[0].len(), rows.len(), 12, dn, None).unwrap()
    }

    const THRESHOLDS: Thresholds = Thresholds { low_dn: 100, high_dn: 400 };

    fn detect(frame: &Frame) -> Vec<Blob> {
        detect_with(&mut Detector::default(), frame, 0.0, 100)
    }

    fn detect_with(detector: &mut Detector, frame: &Frame, base_dn: f64, max_clusters: usize) -> Vec<Blob> {
        detector.find_bright(frame, THRESHOLDS);
        detector.detect(frame, THRESHOLDS, base_dn, max_clusters).to_vec()
    }

    #[test]
    fn the_brightness_centre_is_eq_1() {
        let blobs = detect(&drawn(&["......", ".36...", "......"]));
        assert_eq!(blobs.len(), 1);
        // (1 · 300 + 2 · 600) / 900.
        assert!((blobs[0].centre.x - 5.0 / 3.0).abs() < 1e-15 && (blobs[0].centre.y - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_weighted_size_is_eq_2() {
        let blobs = detect(&drawn(&["......", ".36...", "......"]));
        assert!((blobs[0].size - 900.0 / 4095.0).abs() < 1e-15);
        assert_eq!(blobs[0].pixels, 2);
    }

    #[test]
    fn equal_intensities_give_the_geometric_centre() {
        let blobs = detect(&drawn(&["55", "55"]));
        assert_eq!(blobs[0].centre, PixelPoint::new(0.5, 0.5));
    }

    #[test]
    fn a_cluster_needs_one_pixel_above_the_second_threshold() {
        assert_eq!(detect(&drawn(&["333", "343", "333"])), []);
    }

    #[test]
    fn pixels_at_the_first_threshold_are_left_out() {
        assert_eq!(detect(&drawn(&["111", "151", "111"]))[0].pixels, 1);
    }

    #[test]
    fn corners_connect_and_gaps_do_not() {
        assert_eq!(detect(&drawn(&["5..", ".5.", "..5"])).len(), 1);
        assert_eq!(detect(&drawn(&["5.5", "...", "5.5"])).len(), 4);
    }

    #[test]
    fn the_ends_of_rows_do_not_touch() {
        assert_eq!(detect(&drawn(&["...5", "5...", "...."])).len(), 2);
    }

    #[test]
    fn the_background_pulls_an_asymmetric_cluster_and_can_be_taken_off() {
        let frame = drawn(&["22222", "29222", "22222"]);
        let mut detector = Detector::default();
        let printed = detect_with(&mut detector, &frame, 0.0, 100)[0];
        let above = detect_with(&mut detector, &frame, 200.0, 100)[0];
        assert!(printed.centre.x > 1.5);
        assert_eq!(above.centre, PixelPoint::new(1.0, 1.0));
    }

    #[test]
    fn a_cluster_below_its_background_is_dropped() {
        assert_eq!(detect_with(&mut Detector::default(), &drawn(&["5"]), 600.0, 100), []);
    }

    #[test]
    fn a_detector_forgets_the_last_frame() {
        let mut detector = Detector::default();
        let frame = drawn(&["5..", "...", "..#"]);
        let first = detect_with(&mut detector, &frame, 0.0, 100);
        assert_eq!(detect_with(&mut detector, &frame, 0.0, 100), first);
        assert_eq!(detect_with(&mut detector, &drawn(&["5"]), 0.0, 100).len(), 1);
    }

    #[test]
    fn too_many_clusters_leave_the_largest_in_their_order() {
        let frame = drawn(&["5.9.7.8"]);
        let mut detector = Detector::default();
        let kept: Vec<f64> =
            detect_with(&mut detector, &frame, 0.0, 2).iter().map(|blob| blob.centre.x).collect();
        assert_eq!(kept, [2.0, 6.0]);
    }

    #[test]
    fn a_frame_that_is_one_cluster_is_filled_without_recursion() {
        let frame = Frame::new(0, 1000, 1000, 12, vec![4000; 1_000_000], None).unwrap();
        let blobs = detect(&frame);
        assert_eq!(blobs.len(), 1);
        assert!(blobs[0].centre.distance(PixelPoint::new(499.5, 499.5)) < 1e-6);
    }

    #[test]
    fn saturated_pixels_are_counted() {
        let frame = drawn(&["##.", "9.#"]);
        // For every threshold, including full scale.
        for high_dn in [0, 400, 4094, 4095, u16::MAX] {
            let thresholds = Thresholds { low_dn: 0, high_dn };
            assert_eq!(Detector::default().find_bright(&frame, thresholds), 3);
        }
    }

    /// Only the chunks of its windows are examined in a frame with windows; all other pixels are 0.
    #[test]
    fn windows_and_a_frame_with_the_same_pixels_give_the_same_clusters() {
        let windows: Vec<Window> =
            [(0, 0, 9, 4), (60, 2, 20, 8), (70, 5, 20, 8), (130, 31, 20, 8), (0, 39, 150, 1)]
                .map(|(x, y, columns, rows)| Window { x, y, columns, rows })
                .to_vec();
        let dn: Vec<u16> = (0..150 * 40)
            .map(|i| {
                let is_sent = windows.iter().any(|window| window.contains(i % 150, i / 150));
                if is_sent { [0, 150, 4095, 300, 500, 0, 0][i * i / 7 % 7] } else { 0 }
            })
            .collect();
        let whole = Frame::new(0, 150, 40, 12, dn.clone(), None).unwrap();
        let windowed = Frame::new(0, 150, 40, 12, dn, Some(windows)).unwrap();
        let mut detector = Detector::default();
        let blobs = detect_with(&mut detector, &whole, 0.0, 1000);
        let saturated = detector.find_bright(&whole, THRESHOLDS);
        assert!(blobs.len() > 10 && saturated > 0);
        assert_eq!(detect_with(&mut detector, &windowed, 0.0, 1000), blobs);
        assert_eq!(detector.find_bright(&windowed, THRESHOLDS), saturated);
    }

    proptest! {
        /// Reference: labels spread from pixel to neighbour until nothing changes.
        #[test]
        fn clusters_are_the_connected_components(
            columns in 1usize..12,
            dn in proptest::collection::vec(prop_oneof![Just(0u16), Just(200), Just(500)], 1..140),
        ) {
            let rows = dn.len() / columns;
            prop_assume!(rows > 0);
            let dn = dn[..rows * columns].to_vec();
            let mut label: Vec<usize> = (0..dn.len()).collect();
            let touches = |a: usize, b: usize| {
                (a % columns).abs_diff(b % columns) <= 1 && (a / columns).abs_diff(b / columns) <= 1
            };
            for _ in 0..dn.len() {
                for a in 0..dn.len() {
                    for b in 0..dn.len() {
                        if dn[a] > 100 && dn[b] > 100 && touches(a, b) {
                            label[a] = label[a].min(label[b]);
                        }
                    }
                }
            }
            let mut expected: Vec<u32> = (0..dn.len())
                .filter(|&l| (0..dn.len()).any(|i| label[i] == l && dn[i] > 400))
                .map(|l| (0..dn.len()).filter(|&i| label[i] == l && dn[i] > 100).count() as u32)
                .collect();
            let frame = Frame::new(0, columns, rows, 12, dn, None).unwrap();
            let mut got: Vec<u32> = detect(&frame).iter().map(|blob| blob.pixels).collect();
            expected.sort_unstable();
            got.sort_unstable();
            prop_assert_eq!(got, expected);
        }
    }
}
