//! Stand-off cross in front of the disk, on its post.

use contract::OutOfRange;
use contract::bounds::require;
use contract::docking::StandOffCross;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::check_source;
use super::shapes::{cylinder, flat, wall};
use super::{Assembly, Part};

/// Number of sides of the post.
const POST_SIDES: usize = 16;

/// `[cross]`: two perpendicular bars of equal size along y1 and y2, on a post that stands on the disk's
/// centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrossTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Height b of the front face above the disk's plane, m, more than the thickness, at most 10.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 10))]
    pub height_m: f64,
    /// Distance from the centre to the end of a bar, m, more than the width, at most 10.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 10))]
    pub half_length_m: f64,
    /// Width of a bar, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub width_m: f64,
    /// Thickness of a bar along y3, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub thickness_m: f64,
    /// Lambertian reflectance of the bars, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub reflectance: f64,
    /// Radius of the post, m, positive, at most half the width of a bar.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub post_radius_m: f64,
    /// Lambertian reflectance of the post, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub post_reflectance: f64,
}

impl CrossTable {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        check_source("cross.source", &self.source)?;
        let Self { height_m, half_length_m, width_m, thickness_m, post_radius_m, .. } = *self;
        require("cross.height_m", height_m, "more than thickness_m, at most 10", |b| b > thickness_m)?;
        require("cross.half_length_m", half_length_m, "more than width_m, at most 10", |l| l > width_m)?;
        let expected = "greater than 0, at most half of width_m";
        require("cross.post_radius_m", post_radius_m, expected, |r| r <= width_m / 2.0)
    }

    /// Returns post, edges of the bars, and their common front face, back to front. The edges are a separate
    /// part because, seen from the side, the front face hides the edge of one bar behind the other bar.
    pub(super) fn parts(&self) -> [Part; 3] {
        let back_m = self.height_m - self.thickness_m;
        let outline = self.outline();
        let post = cylinder(
            Vector3::zeros(),
            Vector3::new(0.0, 0.0, back_m),
            self.post_radius_m,
            POST_SIDES,
            self.post_reflectance,
        );
        // The ends of the post are hidden by the plate and the bars.
        let post = post.into_iter().take(POST_SIDES).collect();
        let part = |name: &str, facets| Part {
            name: name.to_owned(),
            assembly: Assembly::Target,
            facets,
            casts_shadow: true,
            visible: true,
        };
        // Back to front.
        [
            part("post", post),
            part("cross edges", wall(&outline, back_m, self.height_m, self.reflectance)),
            part("cross", vec![flat(&outline, &[], self.height_m, self.reflectance)]),
        ]
    }

    pub(super) fn model(&self) -> StandOffCross {
        StandOffCross {
            height_m: self.height_m,
            half_length_m: self.half_length_m,
            width_m: self.width_m,
            thickness_m: self.thickness_m,
            post_width_m: 2.0 * self.post_radius_m,
        }
    }

    /// Twelve corners of the union of the two bars, counter-clockwise from the end of the bar along +y1.
    fn outline(&self) -> [[f64; 2]; 12] {
        let (l, w) = (self.half_length_m, self.width_m / 2.0);
        [
            [l, -w],
            [l, w],
            [w, w],
            [w, l],
            [-w, l],
            [-w, w],
            [-l, w],
            [-l, -w],
            [-w, -w],
            [-w, -l],
            [w, -l],
            [w, -w],
        ]
    }
}
