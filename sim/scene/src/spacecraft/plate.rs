//! Flat plates and boxes of them: the shape of the target, in metres in its body frame.

use contract::OutOfRange;
use nalgebra::{Vector2, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::polygon::Polygon;
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

/// Checked plate: `right`, `up` and `normal` are orthonormal and right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plate {
    pub centre: Vector3<f64>,
    pub right: Vector3<f64>,
    pub up: Vector3<f64>,
    pub normal: Vector3<f64>,
    pub half_width: f64,
    pub half_height: f64,
    pub front: SurfaceConfig,
    pub back: Option<SurfaceConfig>,
}

impl PlateConfig {
    /// Returns the checked plate.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub(super) fn plate(&self) -> Result<Plate, OutOfRange> {
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
        Ok(Plate {
            centre: self.centre_m.into(),
            right: up.cross(&normal),
            up,
            normal,
            half_width: 0.5 * self.width_m,
            half_height: 0.5 * self.height_m,
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
    pub(super) fn plates(&self) -> Result<[Plate; 6], OutOfRange> {
        self.surface.check("target.boxes[].surface")?;
        let face = |axis: usize, side: f64| {
            let unit = |axis: usize| Vector3::ith(axis % 3, 1.0);
            let (normal, up) = (unit(axis) * side, unit(axis + 2));
            Plate {
                centre: Vector3::from(self.centre_m) + normal * (0.5 * self.size_m[axis]),
                right: up.cross(&normal),
                up,
                normal,
                half_width: 0.5 * self.size_m[(axis + 1) % 3],
                half_height: 0.5 * self.size_m[(axis + 2) % 3],
                front: self.surface,
                back: None,
            }
        };
        Ok([face(0, 1.0), face(0, -1.0), face(1, 1.0), face(1, -1.0), face(2, 1.0), face(2, -1.0)])
    }
}

impl Plate {
    /// Returns true if the ray from `eye` along `ray` meets the plate from either side.
    pub(super) fn is_hit_by(&self, eye: &Vector3<f64>, ray: &Vector3<f64>) -> bool {
        let (towards, along) = (self.centre - eye, ray.dot(&self.normal));
        let reach = towards.dot(&self.normal) / along;
        let off = ray * reach - towards;
        // A ray in the plate's plane gives NaN and meets nothing.
        reach > 0.0
            && off.dot(&self.right).abs() <= self.half_width
            && off.dot(&self.up).abs() <= self.half_height
    }

    /// Upper bound of the distance of the plate's corners from the origin of the body frame, m.
    pub(super) fn reach(&self) -> f64 {
        self.centre.norm() + libm::hypot(self.half_width, self.half_height)
    }

    /// Returns the reversed plate: `front` becomes its front, and its former front becomes its back.
    pub(super) fn turned(&self, front: SurfaceConfig) -> Self {
        Self { right: -self.right, normal: -self.normal, front, back: Some(self.front), ..*self }
    }

    /// Outline in the plate's plane: coordinates right and up from the centre.
    pub(super) fn outline(&self) -> Polygon {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(i, j)| Vector2::new(i * self.half_width, j * self.half_height))
            .to_vec()
    }

    /// Converts a point of the plate's plane to the body frame.
    pub(super) fn point_in_body_frame(&self, point: &Vector2<f64>) -> Vector3<f64> {
        self.centre + self.right * point.x + self.up * point.y
    }

    /// Converts a point of the body frame to the plate's axes: right, up and height above the front.
    pub(super) fn local(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let offset = point - self.centre;
        Vector3::new(offset.dot(&self.right), offset.dot(&self.up), offset.dot(&self.normal))
    }
}
