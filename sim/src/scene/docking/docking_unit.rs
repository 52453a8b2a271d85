//! The docking unit: a ring that stands on the station's end, with the receiving cone inside and blocks on it.

use std::f64::consts::PI;

use contract::docking::Outline;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Part;
use super::checks::{FARTHEST_M, check_reflectance, check_source};
use super::shapes::{COARSE_SAGITTA_M, Circle, FINE_SAGITTA_M, block, flat, hollow, wall};
use crate::SimError;
use crate::error::require;

/// Sides of walls and cone: 64 leave a circle of 0.66 m by 0.5 mm, seen from the side only.
const SIDES: usize = 64;
/// The floor of the cone, as a share of its opening.
const FLOOR_SHARE: f64 = 0.15;

/// `[docking_unit]`: ring, recessed flange and receiving cone about an axis parallel to y3.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingUnitTable {
    /// Where the figures are from, or `assumed: why`.
    pub source: String,
    /// Where the axis meets the disk's plane (y1, y2), m.
    pub axis_m: [f64; 2],
    /// How far the front of the ring lies behind the disk's plane, m, 0 or more.
    pub depth_m: f64,
    /// Outer radius of the ring, m, more than the inner one.
    pub outer_radius_m: f64,
    /// Inner radius of the ring, m, more than that of the cone.
    pub inner_radius_m: f64,
    /// How far the flange between ring and cone lies behind the front of the ring, m, positive.
    pub recess_m: f64,
    /// Radius of the cone's opening, m, positive.
    pub cone_radius_m: f64,
    /// How far the floor of the cone lies behind the front of the ring, m, more than the recess.
    pub cone_depth_m: f64,
    /// Lambertian reflectance of the ring, 0 to 1.
    pub ring_reflectance: f64,
    /// Lambertian reflectance of flange and cone, 0 to 1.
    pub cone_reflectance: f64,
    /// Blocks on the ring (latches, sensors); none where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blocks: Option<BlockRing>,
}

/// `[docking_unit.blocks]`: equal blocks on the middle of the ring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockRing {
    /// How many, 1 to 32.
    pub count: usize,
    /// Angle of the first, degrees from +y1 towards +y2, −360 to 360.
    pub first_angle_deg: f64,
    /// Size along the radius, across it and along y3, m, positive; along the radius less than the ring is wide.
    pub size_m: [f64; 3],
    /// Lambertian reflectance, 0 to 1.
    pub reflectance: f64,
}

impl DockingUnitTable {
    pub(super) fn check(&self) -> Result<(), SimError> {
        check_source("docking_unit.source", &self.source)?;
        for y_m in self.axis_m {
            require("docking_unit.axis_m", y_m, "-1000 to 1000", |y| y.abs() <= FARTHEST_M)?;
        }
        require("docking_unit.depth_m", self.depth_m, "0 to 1000", |h| (0.0..=FARTHEST_M).contains(&h))?;
        require("docking_unit.cone_radius_m", self.cone_radius_m, "0.01 or more", |r| r >= 0.01)?;
        require("docking_unit.inner_radius_m", self.inner_radius_m, "more than cone_radius_m", |r| {
            r > self.cone_radius_m
        })?;
        require(
            "docking_unit.outer_radius_m",
            self.outer_radius_m,
            "more than inner_radius_m, at most 100",
            |r| r > self.inner_radius_m && r <= 100.0,
        )?;
        require("docking_unit.recess_m", self.recess_m, "greater than 0", |x| x > 0.0)?;
        require("docking_unit.cone_depth_m", self.cone_depth_m, "more than recess_m, at most 100", |x| {
            x > self.recess_m && x <= 100.0
        })?;
        check_reflectance("docking_unit.ring_reflectance", self.ring_reflectance)?;
        check_reflectance("docking_unit.cone_reflectance", self.cone_reflectance)?;
        self.blocks.map_or(Ok(()), |blocks| blocks.check(self.outer_radius_m - self.inner_radius_m))
    }

    /// The parts from back to front. `base_m` is how far the station's face, on which the ring stands, lies behind the
    /// disk's plane.
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
            facets,
            casts_shadow,
            visible: true,
        };
        let mut parts = vec![
            // It stops the light that comes in through the flange, which would else go on to the station behind.
            part("docking cone", cone, true),
            // The flange shades the cone, and the ring both.
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
    fn check(&self, ring_width_m: f64) -> Result<(), SimError> {
        require("docking_unit.blocks.count", self.count as f64, "1 to 32", |n| (1.0..=32.0).contains(&n))?;
        require("docking_unit.blocks.first_angle_deg", self.first_angle_deg, "-360 to 360", |a| {
            a.abs() <= 360.0
        })?;
        let [along_m, across_m, height_m] = self.size_m;
        require(
            "docking_unit.blocks.size_m",
            along_m,
            "along the radius greater than 0, less than the ring is wide",
            |x| x > 0.0 && x < ring_width_m,
        )?;
        for side_m in [across_m, height_m] {
            require("docking_unit.blocks.size_m", side_m, "greater than 0, at most 1", |x| {
                x > 0.0 && x <= 1.0
            })?;
        }
        check_reflectance("docking_unit.blocks.reflectance", self.reflectance)
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
