//! Flat plates and boxes of them: the shape of the target, in metres in its body frame.

use contract::OutOfRange;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::facet::Facet;
use super::surface::SurfaceConfig;

/// Rectangular plate without thickness, opaque from either side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateConfig {
    /// Centre in the target's body frame, m, each −200 to 200.
    #[schemars(inner(range(min = -200, max = 200)))]
    pub centre_m: [f64; 3],
    /// Outward direction of the front, body frame, of any length except 0.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub normal: [f64; 3],
    /// Direction of the height, body frame, of any length except 0, not along the normal; its component along
    /// the normal is removed.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub up: [f64; 3],
    /// Extent across `up`, m, above 0, at most 200.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 200))]
    pub width_m: f64,
    /// Extent along `up`, m, above 0, at most 200.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 200))]
    pub height_m: f64,
    /// Reflectance of the front.
    pub front: SurfaceConfig,
    /// Reflectance of the back; black if absent.
    #[serde(default)]
    pub back: Option<SurfaceConfig>,
}

/// Box with edges along the axes of the body frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxConfig {
    /// Centre in the target's body frame, m, each −200 to 200.
    #[serde(default)]
    #[schemars(inner(range(min = -200, max = 200)))]
    pub centre_m: [f64; 3],
    /// Extent along x, y and z, m, each above 0, at most 200.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0, "maximum": 200 }))]
    pub size_m: [f64; 3],
    /// Outer reflectance of the six faces.
    pub surface: SurfaceConfig,
}

impl PlateConfig {
    /// Returns the checked plate.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub(super) fn plate(&self) -> Result<Facet, OutOfRange> {
        self.front.check("target.plates[].front")?;
        self.back.map_or(Ok(()), |back| back.check("target.plates[].back"))?;
        let unit = |vector: Vector3<f64>| vector.try_normalize(1e-9);
        let none = |field, value: [f64; 3], expected| OutOfRange::new(field, format!("{value:?}"), expected);
        let normal = unit(self.normal.into())
            .ok_or_else(|| none("target.plates[].normal", self.normal, "a nonzero vector"))?;
        let up =
            unit(self.up.into()).and_then(|up| unit(up - normal * normal.dot(&up))).ok_or_else(|| {
                none("target.plates[].up", self.up, "a nonzero vector that is not parallel to the normal")
            })?;
        Ok(Facet {
            centre: self.centre_m.into(),
            right: up.cross(&normal),
            up,
            normal,
            half_width: 0.5 * self.width_m,
            half_height: 0.5 * self.height_m,
            triangle: None,
            front: self.front,
            back: self.back,
        })
    }
}

/// Volume of a box with edges along the axes of the body frame, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Brick {
    centre: Vector3<f64>,
    half_size: Vector3<f64>,
}

impl Brick {
    /// Returns the eight corners, body frame, m: bit 0 of the index is set at the larger x, bit 1 at the
    /// larger y, bit 2 at the larger z.
    pub(super) fn corners_m(&self) -> [Vector3<f64>; 8] {
        let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        std::array::from_fn(|i| {
            let signs = Vector3::new(side(i & 1), side(i & 2), side(i & 4));
            self.centre + self.half_size.component_mul(&signs)
        })
    }

    /// Returns true if a point of the body frame, m, is inside the box or on its surface.
    pub(super) fn contains(&self, point: &Vector3<f64>) -> bool {
        (self.half_size - (point - self.centre).abs()).min() >= 0.0
    }
}

impl BoxConfig {
    /// Returns the volume of the box.
    pub(super) fn brick(&self) -> Brick {
        Brick { centre: self.centre_m.into(), half_size: 0.5 * Vector3::from(self.size_m) }
    }

    /// Returns the six faces.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub(super) fn plates(&self) -> Result<[Facet; 6], OutOfRange> {
        self.surface.check("target.boxes[].surface")?;
        let face = |axis: usize, side: f64| {
            let unit = |axis: usize| Vector3::ith(axis % 3, 1.0);
            let (normal, up) = (unit(axis) * side, unit(axis + 2));
            Facet {
                centre: Vector3::from(self.centre_m) + normal * (0.5 * self.size_m[axis]),
                right: up.cross(&normal),
                up,
                normal,
                half_width: 0.5 * self.size_m[(axis + 1) % 3],
                half_height: 0.5 * self.size_m[(axis + 2) % 3],
                triangle: None,
                front: self.surface,
                back: None,
            }
        };
        Ok([face(0, 1.0), face(0, -1.0), face(1, 1.0), face(1, -1.0), face(2, 1.0), face(2, -1.0)])
    }
}
