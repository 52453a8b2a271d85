//! Thermal blankets on the station's end: rings of irregular tiles with dark gaps between them.

use std::f64::consts::PI;

use contract::OutOfRange;
use contract::bounds::require;
use draws::{Effect, Seed, Stream, uniform};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Facet;
use super::checks::check_source;
use super::docking_unit::DockingUnitTable;
use super::shapes::{Circle, flat};

/// Maximum number of tiles; each tile is drawn in every image.
const MAX_TILES: f64 = 1000.0;
/// Maximum angular shift of the seam between two tiles of a ring, as a share of a tile's width.
const SEAM_SHIFT: f64 = 0.12;

/// `[station.blankets]`: rings of tiles about the centre of the station's face, from the rim inwards. The
/// area of the docking unit has no tiles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlanketsTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Seed of the layout: positions of seams, widths of gaps, reflectances.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Number of rings, 1 to 20.
    #[schemars(range(min = 1, max = 20))]
    pub rings: usize,
    /// Width of a ring, m, positive; all rings fit inside the rim.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub ring_width_m: f64,
    /// Mean width of a tile along its ring, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub tile_width_m: f64,
    /// Mean gap around a tile, m, 0 or more, less than a quarter of a tile.
    #[schemars(range(min = 0, max = 100))]
    pub gap_m: f64,
    /// Share of missing tiles, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub missing_fraction: f64,
    /// Distance of the tiles in front of the station's face, m, positive, less than the height of the docking
    /// unit above the face.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub thickness_m: f64,
    /// Smallest and largest Lambertian reflectance, 0 to 1.
    #[schemars(inner(range(min = 0, max = 1)))]
    pub reflectance: [f64; 2],
}

impl BlanketsTable {
    /// Checks every number. `face` is the circle inside the rim, `depth_m` behind the disk's plane.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub(super) fn check(
        &self,
        face: &Circle,
        depth_m: f64,
        unit: &DockingUnitTable,
    ) -> Result<(), OutOfRange> {
        check_source("station.blankets.source", &self.source)?;
        require(
            "station.blankets.ring_width_m",
            self.ring_width_m,
            "greater than 0, all rings inside the rim",
            |w| w * self.rings as f64 <= face.radius_m,
        )?;
        require(
            "station.blankets.tile_width_m",
            self.tile_width_m,
            "greater than 0, and large enough for at most 1000 tiles",
            |w| 2.0 * PI * face.radius_m / w * self.rings as f64 <= MAX_TILES,
        )?;
        let least_m = self.ring_width_m.min(self.tile_width_m);
        require("station.blankets.gap_m", self.gap_m, "0 or more, less than a quarter of a tile", |gap| {
            gap < least_m / 4.0
        })?;
        require(
            "station.blankets.thickness_m",
            self.thickness_m,
            "greater than 0, less than the height of the docking unit above the face",
            |t| t < depth_m - unit.depth_m,
        )?;
        let [least, greatest] = self.reflectance;
        require("station.blankets.reflectance", least, "0 to 1, the smaller value first", |rho| {
            rho <= greatest
        })
    }

    /// Returns the tiles on `face`, which lies `depth_m` behind the disk's plane.
    pub(super) fn facets(&self, face: &Circle, depth_m: f64, unit: &DockingUnitTable) -> Vec<Facet> {
        let y3_m = self.thickness_m - depth_m;
        let mut facets = Vec::new();
        for ring in 0..self.rings {
            let outer_m = face.radius_m - self.ring_width_m * ring as f64;
            let inner_m = outer_m - self.ring_width_m;
            // At least three tiles per ring, so each spans less than half a turn.
            let count = (PI * (inner_m + outer_m) / self.tile_width_m).round().max(3.0) as usize;
            for i in 0..count {
                let Some((tile, reflectance)) = self.tile([inner_m, outer_m], ring, i, count) else {
                    continue;
                };
                let tile = tile.map(|[y1, y2]| [face.centre_m[0] + y1, face.centre_m[1] + y2]);
                if distance(&tile, unit.axis_m) > unit.outer_radius_m {
                    facets.push(flat(&tile, &[], y3_m, reflectance));
                }
            }
        }
        facets
    }

    /// Returns the corners of a tile, counter-clockwise and relative to the face's centre, and its
    /// reflectance; `None` if the tile is missing. The whole tile lies between the two radii and between its
    /// seams.
    fn tile(
        &self,
        [inner_m, outer_m]: [f64; 2],
        ring: usize,
        i: usize,
        count: usize,
    ) -> Option<([[f64; 2]; 6], f64)> {
        let streams = Seed { seed: self.seed, case: 0 }.streams(0, Effect::Blankets);
        let index = |i: usize| (ring as u64) << 32 | i as u64;
        // One random stream per tile, shared with the seam at the tile's start.
        let seam = |stream: &mut Stream, i: usize| {
            let mut shift = || SEAM_SHIFT * (2.0 * uniform(stream) - 1.0);
            let pitch = 2.0 * PI / count as f64;
            let turn = PI * ring as f64 / 7.0;
            [shift(), shift()].map(|shift| turn + pitch * (i as f64 + shift))
        };
        let mut stream = streams.stream_at(index(i));
        let begin = seam(&mut stream, i);
        let mut end = seam(&mut streams.stream_at(index((i + 1) % count)), (i + 1) % count);
        if i + 1 == count {
            end = end.map(|angle| angle + 2.0 * PI);
        }
        let present = uniform(&mut stream) >= self.missing_fraction;
        let [least, greatest] = self.reflectance;
        let reflectance = least + (greatest - least) * uniform(&mut stream);
        // Each side recedes by a quarter to three quarters of a gap, so two adjacent sides recede by one gap
        // on average.
        let mut side_m = || self.gap_m * (0.25 + 0.5 * uniform(&mut stream));
        let (inner_m, outer_m) = (inner_m + side_m(), outer_m - side_m());
        let (first_m, last_m) = (side_m(), side_m());
        let half_span = |radius: usize| (end[radius] - begin[radius]) / 4.0;
        // The inner side is two chords tangent to the inner circle; the outer side is two chords with their
        // ends on the outer circle.
        let inner_m = inner_m / libm::cos(half_span(0));
        let corner = |radius_m: f64, angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            [radius_m * cos, radius_m * sin]
        };
        let arc = |radius_m: f64, radius: usize| {
            let (first, last) = (begin[radius] + first_m / radius_m, end[radius] - last_m / radius_m);
            [first, 0.5 * (first + last), last].map(|angle| corner(radius_m, angle))
        };
        let [a, b, c] = arc(outer_m, 1);
        let [d, e, f] = arc(inner_m, 0);
        (present && inner_m < outer_m).then_some(([a, b, c, f, e, d], reflectance))
    }
}

/// Distance from a polygon to a point outside it, m.
fn distance(polygon: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let distances = edges.map(|(a, b)| {
        let (along, to) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
        let length2 = along[0] * along[0] + along[1] * along[1];
        let share = ((along[0] * to[0] + along[1] * to[1]) / length2).clamp(0.0, 1.0);
        libm::hypot(to[0] - share * along[0], to[1] - share * along[1])
    });
    distances.fold(f64::INFINITY, f64::min)
}
