//! Hotspots of the detector (section 2.2, after Eq. 10).

use std::collections::BTreeSet;

use contract::bounds::require;
use contract::{OutOfRange, PixelPoint};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::detect::Blob;
use super::track::Track;

/// Method to distinguish hotspots from a target that hardly moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum HotspotConfig {
    /// Hotspots are clusters tracked over more than `n_min` frames with a mean velocity below
    /// `v_min_px_per_s`.
    ///
    /// With a camera that points at the target, this can remove the target. With Eq. 10 as printed (no
    /// `n_max`), it does so after one orbit, when the target is back at its first pixel and its mean velocity
    /// is nearly 0.
    Automatic {
        /// Number of frames N_min over which a cluster must have been tracked, 0 to 1000000.
        #[serde(default = "default_n_min")]
        #[schemars(range(min = 0, max = 1000000))]
        n_min: u32,
        /// Mean velocity v_min below which a cluster is a hotspot, px/s, 0 to 1000; the paper's typical value
        /// is 0.001.
        #[serde(default = "default_v_min")]
        #[schemars(range(min = 0, max = 1000))]
        v_min_px_per_s: f64,
        /// Number of last steps over which the mean velocity is computed, above `n_min`, at most 10000;
        /// `null`: Eq. 10 as printed, the mean over the whole track.
        #[serde(default = "default_n_max")]
        #[schemars(range(min = 1, max = 10000))]
        n_max: Option<u32>,
        /// True if the pixel of a hotspot remains marked until the end of the sequence. Otherwise a hot pixel
        /// that once drops below the threshold is a candidate again until it has been tracked for `n_min`
        /// frames.
        #[serde(default = "default_keep_pixels")]
        keep_pixels: bool,
    },
    /// No search for hotspots; recommended with target pointing when no list is known.
    Off,
    /// Only known hotspots.
    List {
        /// Pixels as (column, row), with the first pixel at (0, 0).
        #[schemars(extend("items" = {
            "type": "array",
            "items": { "type": "integer", "minimum": 0, "maximum": 16383 },
            "minItems": 2,
            "maxItems": 2,
        }))]
        pixels: Vec<(u32, u32)>,
    },
}

fn default_n_min() -> u32 {
    20
}

fn default_v_min() -> f64 {
    0.001
}

fn default_n_max() -> Option<u32> {
    Some(40)
}

fn default_keep_pixels() -> bool {
    true
}

impl Default for HotspotConfig {
    fn default() -> Self {
        Self::Automatic {
            n_min: default_n_min(),
            v_min_px_per_s: default_v_min(),
            n_max: default_n_max(),
            keep_pixels: default_keep_pixels(),
        }
    }
}

impl HotspotConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        if let Self::Automatic { n_min, n_max: Some(n_max), .. } = *self {
            let expected = "greater than hotspots.n_min, at most 10000";
            require("hotspots.n_max", f64::from(n_max), expected, |_| n_max > n_min)?;
        }
        Ok(())
    }

    /// Returns the number of steps over which a mean velocity is computed; `None` means all steps.
    pub(super) fn n_max(&self) -> Option<u32> {
        match self {
            Self::Automatic { n_max, .. } => *n_max,
            Self::Off | Self::List { .. } => None,
        }
    }
}

/// Hotspots at a frame: the configuration and the marked pixels.
#[derive(Debug)]
pub(super) struct Hotspots {
    config: HotspotConfig,
    /// Marked pixels as (row, column), sorted to limit a search to a few rows.
    marked: BTreeSet<(i64, i64)>,
}

/// Largest distance of the centre of a hotspot's cluster from its pixel, even when neighbours exceed I1, px.
const MARK_RADIUS_PX: f64 = 1.0;

/// Largest size of a hotspot's cluster, pixels: a hot pixel and its neighbours. A larger cluster on a marked
/// pixel is another object that passes over it.
const MARK_MAX_PIXELS: u32 = 9;

impl Hotspots {
    pub(super) fn new(config: HotspotConfig) -> Self {
        let marked = match &config {
            HotspotConfig::List { pixels } => {
                pixels.iter().map(|&(x, y)| (i64::from(y), i64::from(x))).collect()
            }
            HotspotConfig::Automatic { .. } | HotspotConfig::Off => BTreeSet::new(),
        };
        Self { config, marked }
    }

    /// Returns true if a cluster is on a marked pixel.
    pub(super) fn is_marked(&self, blob: &Blob) -> bool {
        if blob.pixels > MARK_MAX_PIXELS {
            return false;
        }
        let (x, y) = nearest_pixel(blob.centre);
        let near = |&(row, column): &(i64, i64)| {
            blob.centre.distance(PixelPoint::new(column as f64, row as f64)) <= MARK_RADIUS_PX
        };
        (y - 1..=y + 1).any(|row| self.marked.range((row, x - 1)..=(row, x + 1)).any(near))
    }

    /// Returns true if a track is a hotspot by its history: N > N_min and ‖v‖ < v_min. Marks its pixel if the
    /// configuration keeps pixels.
    pub(super) fn is_hotspot(&mut self, track: &Track) -> bool {
        let HotspotConfig::Automatic { n_min, v_min_px_per_s, keep_pixels, .. } = self.config else {
            return false;
        };
        let is_hotspot = track.length > n_min && track.speed_px_per_s() < v_min_px_per_s;
        if is_hotspot && keep_pixels {
            let (x, y) = nearest_pixel(track.centre);
            self.marked.insert((y, x));
        }
        is_hotspot
    }
}

fn nearest_pixel(point: PixelPoint) -> (i64, i64) {
    (point.x.round() as i64, point.y.round() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blob(x: f64, y: f64, pixels: u32) -> Blob {
        Blob { centre: PixelPoint::new(x, y), size: 1.0, pixels }
    }

    fn track(length: u32, speed: f64) -> Track {
        let mut track = Track::new(&blob(10.2, 20.0, 1), false);
        (track.length, track.velocity_px_per_s) = (length, [speed, 0.0]);
        track
    }

    fn automatic(keep_pixels: bool) -> Hotspots {
        Hotspots::new(HotspotConfig::Automatic { n_min: 5, v_min_px_per_s: 0.001, n_max: None, keep_pixels })
    }

    #[test]
    fn a_hotspot_is_old_and_still() {
        let mut hotspots = automatic(false);
        assert!(hotspots.is_hotspot(&track(6, 0.0009)));
        assert!(!hotspots.is_hotspot(&track(5, 0.0009)), "N must be greater than N_min");
        assert!(!hotspots.is_hotspot(&track(6, 0.001)), "the velocity must be smaller than v_min");
    }

    #[test]
    fn the_pixel_of_a_hotspot_stays_marked_on_request() {
        for keep in [true, false] {
            let mut hotspots = automatic(keep);
            hotspots.is_hotspot(&track(6, 0.0));
            assert_eq!(hotspots.is_marked(&blob(10.0, 20.0, 1)), keep);
        }
    }

    #[test]
    fn a_list_marks_its_pixels_and_their_neighbourhood() {
        let hotspots = Hotspots::new(HotspotConfig::List { pixels: vec![(10, 20)] });
        assert!(hotspots.is_marked(&blob(10.0, 20.0, 1)));
        assert!(hotspots.is_marked(&blob(10.6, 20.6, 3)));
        assert!(!hotspots.is_marked(&blob(10.8, 20.8, 3)));
        assert!(!hotspots.is_marked(&blob(20.0, 10.0, 1)), "column and row must not be exchanged");
    }

    #[test]
    fn a_large_cluster_over_a_hot_pixel_is_no_hotspot() {
        let hotspots = Hotspots::new(HotspotConfig::List { pixels: vec![(10, 20)] });
        assert!(!hotspots.is_marked(&blob(10.0, 20.0, 10)));
    }

    #[test]
    fn off_and_a_list_judge_no_track() {
        for config in [HotspotConfig::Off, HotspotConfig::List { pixels: Vec::new() }] {
            assert!(!Hotspots::new(config).is_hotspot(&track(1000, 0.0)));
        }
    }

    #[test]
    fn a_memory_shorter_than_the_required_history_is_refused() {
        let config =
            |n_max| HotspotConfig::Automatic { n_min: 20, v_min_px_per_s: 0.001, n_max, keep_pixels: true };
        assert!(config(Some(20)).check().is_err());
        assert!(config(Some(21)).check().is_ok() && config(None).check().is_ok());
    }
}
