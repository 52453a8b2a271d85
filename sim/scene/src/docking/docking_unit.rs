//! Docking unit: a ring on the station's end, with the receiving cone inside it and blocks on it.

use std::f64::consts::PI;

use contract::OutOfRange;
use contract::bounds::require;
use contract::docking::Outline;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::check_source;
use super::shapes::{COARSE_SAGITTA_M, Circle, FINE_SAGITTA_M, block, flat, hollow, wall};
use super::{Assembly, Part};

/// Number of sides of walls and cone: a polygon of 64 sides deviates from a circle of radius 0.66 m by 0.5
/// mm, visible only from the side.
const SIDES: usize = 64;
/// Radius of the cone's floor, as a share of the radius of its opening.
const FLOOR_SHARE: f64 = 0.15;

/// `[docking_unit]`: ring, recessed flange and receiving cone about an axis parallel to y3.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingUnitTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Point (y1, y2) where the axis meets the disk's plane, m.
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub axis_m: [f64; 2],
    /// Distance of the ring's front behind the disk's plane, m, 0 or more.
    #[schemars(range(min = 0, max = 1000))]
    pub depth_m: f64,
    /// Outer radius of the ring, m, larger than the inner radius.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub outer_radius_m: f64,
    /// Inner radius of the ring, m, larger than the radius of the cone.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub inner_radius_m: f64,
    /// Distance of the flange between ring and cone behind the ring's front, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub recess_m: f64,
    /// Radius of the cone's opening, m, positive.
    #[schemars(range(min = 0.01, max = 100))]
    pub cone_radius_m: f64,
    /// Distance of the cone's floor behind the ring's front, m, more than the recess.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub cone_depth_m: f64,
    /// Lambertian reflectance of the ring, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub ring_reflectance: f64,
    /// Lambertian reflectance of flange and cone, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub cone_reflectance: f64,
    /// Blocks on the ring (latches, sensors); none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blocks: Option<BlockRing>,
}

/// `[docking_unit.blocks]`: equal blocks along the middle of the ring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockRing {
    /// Number of blocks, 1 to 32.
    #[schemars(range(min = 1, max = 32))]
    pub count: usize,
    /// Angle of the first block, degrees from +y1 towards +y2, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub first_angle_deg: f64,
    /// Size along the radius, across the radius and along y3, m, positive; the size along the radius is less
    /// than the width of the ring.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0, "maximum": 100 }))]
    pub size_m: [f64; 3],
    /// Lambertian reflectance, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub reflectance: f64,
}

impl DockingUnitTable {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        check_source("docking_unit.source", &self.source)?;
        let Self { outer_radius_m, inner_radius_m, recess_m, cone_radius_m, cone_depth_m, .. } = *self;
        let (path, expected) = ("docking_unit.inner_radius_m", "more than cone_radius_m");
        require(path, inner_radius_m, expected, |r| r > cone_radius_m)?;
        let (path, expected) = ("docking_unit.outer_radius_m", "more than inner_radius_m, at most 100");
        require(path, outer_radius_m, expected, |r| r > inner_radius_m)?;
        let (path, expected) = ("docking_unit.cone_depth_m", "more than recess_m, at most 100");
        require(path, cone_depth_m, expected, |x| x > recess_m)?;
        self.blocks.map_or(Ok(()), |blocks| blocks.check(outer_radius_m - inner_radius_m))
    }

    /// Returns the parts from back to front. `base_m` is the distance behind the disk's plane of the
    /// station's face, on which the ring stands.
    pub(super) fn parts(&self, base_m: f64) -> Vec<Part> {
        let circle = |radius_m| Circle { centre_m: self.axis_m, radius_m };
        let (front_m, flange_m) = (-self.depth_m, -self.depth_m - self.recess_m);
        let floor_m = -self.depth_m - self.cone_depth_m;
        let floor = circle(FLOOR_SHARE * self.cone_radius_m);
        let opening = circle(self.cone_radius_m);
        let inner = circle(self.inner_radius_m);
        let outer = circle(self.outer_radius_m);

        let mut cone = hollow((opening, flange_m), (floor, floor_m), SIDES, self.cone_reflectance);
        cone.push(flat(&floor.polygon(SIDES), &[], floor_m, self.ring_reflectance));
        let mut flange = hollow((inner, front_m), (inner, flange_m), SIDES, self.cone_reflectance);
        flange.push(flat(
            &inner.polygon(SIDES),
            &[&opening.polygon_within(COARSE_SAGITTA_M)],
            flange_m,
            self.cone_reflectance,
        ));
        let ring = flat(
            &outer.polygon_within(FINE_SAGITTA_M),
            &[&inner.polygon_within(FINE_SAGITTA_M)],
            front_m,
            self.ring_reflectance,
        );
        let part = |name: &str, facets, casts_shadow| Part {
            name: name.to_owned(),
            assembly: Assembly::DockingUnit,
            facets,
            casts_shadow,
            visible: true,
        };
        let mut parts = vec![
            // The cone blocks sunlight that enters through the flange and would otherwise reach the station
            // behind.
            part("docking cone", cone, true),
            // The flange casts shadows on the cone, and the ring on both.
            part("docking flange", flange, true),
            part("docking wall", wall(&outer.polygon(SIDES), -base_m, front_m, self.ring_reflectance), true),
            part("docking ring", vec![ring], true),
        ];
        if let Some(blocks) = &self.blocks {
            let radius_m = (self.inner_radius_m + self.outer_radius_m) / 2.0;
            parts.push(part("docking blocks", blocks.facets(self.axis_m, radius_m, front_m), true));
        }
        parts
    }

    pub(super) fn model(&self) -> Outline {
        Outline { centre_m: self.axis_m, radius_m: self.outer_radius_m, depth_m: self.depth_m }
    }
}

impl BlockRing {
    fn check(&self, ring_width_m: f64) -> Result<(), OutOfRange> {
        let (path, [along_m, across_m, height_m]) = ("docking_unit.blocks.size_m", self.size_m);
        let expected = "a radial size greater than 0 and less than the width of the ring";
        require(path, along_m, expected, |x| x < ring_width_m)?;
        [across_m, height_m]
            .into_iter()
            .try_for_each(|side_m| require(path, side_m, "greater than 0, at most 1", |x| x <= 1.0))
    }

    fn facets(&self, axis_m: [f64; 2], radius_m: f64, front_m: f64) -> Vec<super::Facet> {
        (0..self.count)
            .flat_map(|i| {
                let angle = self.first_angle_deg.to_radians() + 2.0 * PI * i as f64 / self.count as f64;
                let (sin, cos) = libm::sincos(angle);
                let centre_m =
                    [axis_m[0] + radius_m * cos, axis_m[1] + radius_m * sin, front_m + self.size_m[2] / 2.0];
                block(centre_m, self.size_m, angle, self.reflectance)
            })
            .collect()
    }
}
