//! Closed mesh of triangles as the shape of the target: its keys, its file, and the checks of both.
//!
//! The readers ([`obj`], [`glb`]) return triangles with the names of their materials; [`closure`] checks the
//! surface; [`material`] maps the materials of the file to reflectances.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod closure;
mod glb;
mod material;
mod obj;
#[cfg(test)]
mod tests;

use std::path::Path;

use config::regular_file;
use contract::OutOfRange;
use contract::bounds::require;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::TargetAttitudeConfig;

use super::facet::Facet;
use super::surface::SurfaceConfig;
use material::FileMaterial;

/// Maximum number of triangles of a mesh.
const MAX_TRIANGLES: usize = 10_000;
/// Maximum number of materials of a file.
const MAX_MATERIALS: usize = 1000;
/// Maximum size of a file of a mesh, bytes.
const MAX_BYTES: u64 = 1 << 26;
/// Allowed difference between the stated and the actual radius, as a share of the stated one.
const RADIUS_TOLERANCE: f64 = 0.01;
/// Share of the squared radius up to which the area of a triangle counts as zero.
const MIN_AREA: f64 = 1e-14;
/// Maximum number of names in a message.
const NAMES: usize = 8;

/// Closed mesh of triangles from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshConfig {
    /// File of the mesh, relative to the scenario: Wavefront OBJ (`.obj`) or binary glTF 2.0 (`.glb`). Its
    /// axes are those of the body frame. At most 10,000 triangles.
    pub path: String,
    /// Material library (MTL) of an OBJ file, relative to the scenario. Without it, `materials` must give
    /// every material that the file names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material_path: Option<String>,
    /// Length of one unit of the file, m, 1e-6 to 1000: 0.001 for a file in millimetres. glTF is in metres.
    #[serde(default = "metre")]
    #[schemars(range(min = 1e-6, max = 1000))]
    pub unit_m: f64,
    /// Distance of the farthest corner from the origin of the body frame, m, 0.01 to 200. The mesh must agree
    /// within 1 %, so that a wrong unit is found.
    #[schemars(range(min = 0.01, max = 200))]
    pub radius_m: f64,
    /// Attitude of the body frame; if absent, along R, T, N of the target's orbit.
    #[serde(default)]
    pub attitude: TargetAttitudeConfig,
    /// Reflectance of triangles without a material; absent: every triangle must have one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<SurfaceConfig>,
    /// Reflectances of materials, in place of those of the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<MaterialConfig>,
}

/// Reflectance of a material of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialConfig {
    /// Name of the material in the file of the mesh.
    pub name: String,
    /// Its reflectance.
    pub surface: SurfaceConfig,
}

fn metre() -> f64 {
    1.0
}

/// Triangles of a file with their materials.
#[derive(Debug, Clone, Default)]
struct FileMesh {
    /// Corners, units of the file, counter-clockwise as seen from outside.
    triangles: Vec<[Vector3<f64>; 3]>,
    /// Index of each triangle's material; `None` without a material.
    material_of: Vec<Option<usize>>,
    materials: Vec<FileMaterial>,
}

/// Fault of a file: its description, and the expected property.
#[derive(Debug, Clone, PartialEq)]
struct MeshFault {
    fault: String,
    expected: &'static str,
}

impl MeshFault {
    fn new(fault: impl Into<String>, expected: &'static str) -> Self {
        Self { fault: fault.into(), expected }
    }

    /// Returns an error for more materials than a file may have.
    fn check_materials(count: usize) -> Result<(), Self> {
        if count <= MAX_MATERIALS {
            return Ok(());
        }
        Err(Self::new(format!("with more than {MAX_MATERIALS} materials"), "at most 1000 materials"))
    }
}

impl MeshConfig {
    /// Reads and checks the mesh; relative paths start from `folder`. The largest facets come first.
    ///
    /// # Errors
    /// [`OutOfRange`] for a file that cannot be read, and for the first fault of the mesh or its materials.
    pub(super) fn load(&self, folder: &Path) -> Result<Vec<Facet>, OutOfRange> {
        self.attitude.check()?;
        let refuse = |fault: MeshFault| {
            OutOfRange::new("target.path", format!("{}, {}", self.path, fault.fault), fault.expected)
        };
        let mesh = self.read(folder)?;
        if mesh.triangles.is_empty() {
            return Err(refuse(MeshFault::new("without triangles", "a closed mesh of triangles")));
        }
        if mesh.triangles.len() > MAX_TRIANGLES {
            let fault = format!("a mesh of {} triangles", mesh.triangles.len());
            return Err(refuse(MeshFault::new(fault, "at most 10000 triangles: simplify it")));
        }
        let corners = mesh.triangles.iter().flatten();
        if let Some(corner) = corners.clone().find(|corner| !corner.iter().all(|value| value.is_finite())) {
            let fault = format!("with a corner at {}", shown(corner));
            return Err(refuse(MeshFault::new(fault, "finite coordinates")));
        }
        closure::check(&mesh.triangles).map_err(refuse)?;
        let radius_m = corners.map(|corner| corner.norm()).fold(0.0, f64::max) * self.unit_m;
        let expected = format!(
            "the distance of the farthest corner from the origin within 1 %: it is {radius_m:.6} m with \
             unit_m = {}",
            self.unit_m
        );
        require("target.radius_m", self.radius_m, expected, |stated| {
            (stated - radius_m).abs() <= RADIUS_TOLERANCE * stated
        })?;
        self.facets(&mesh)
    }

    /// Reads the files.
    fn read(&self, folder: &Path) -> Result<FileMesh, OutOfRange> {
        let bytes = |key: &str, path: &str| {
            regular_file::read(&folder.join(path), MAX_BYTES)
                .map_err(|error| OutOfRange::new(key, format!("{path} ({error})"), "a file that can be read"))
        };
        let refuse = |key: &str, path: &str, fault: MeshFault| {
            OutOfRange::new(key, format!("{path}, {}", fault.fault), fault.expected)
        };
        let of_mesh = |fault| refuse("target.path", &self.path, fault);
        let extension = Path::new(&self.path).extension().map(|extension| extension.to_ascii_lowercase());
        match extension.as_ref().and_then(|extension| extension.to_str()) {
            Some("obj") => {
                let library = match &self.material_path {
                    None => None,
                    Some(path) => Some(
                        obj::read_materials(&bytes("target.material_path", path)?)
                            .map_err(|fault| refuse("target.material_path", path, fault))?,
                    ),
                };
                obj::read(&bytes("target.path", &self.path)?, library).map_err(of_mesh)
            }
            Some("glb") => {
                if let Some(path) = &self.material_path {
                    return Err(OutOfRange::new(
                        "target.material_path",
                        path,
                        "no value: glTF holds its materials",
                    ));
                }
                glb::read(&bytes("target.path", &self.path)?).map_err(of_mesh)
            }
            _ => Err(OutOfRange::new(
                "target.path",
                &self.path,
                "a file named .obj (Wavefront OBJ) or .glb (binary glTF 2.0, with all data in one file)",
            )),
        }
    }

    /// Returns the facets, largest first, with their reflectances. Triangles without area are dropped.
    fn facets(&self, mesh: &FileMesh) -> Result<Vec<Facet>, OutOfRange> {
        for (i, given) in self.materials.iter().enumerate() {
            given.surface.check("target.materials[].surface").map_err(|error| error.in_entry(i))?;
            if !mesh.materials.iter().any(|material| material.name == given.name) {
                let expected = match &mesh.materials[..] {
                    [] => format!("no entry: {} has no materials", self.path),
                    materials => format!("a material of {}: {}", self.path, names(materials)),
                };
                return Err(OutOfRange::new(format!("target.materials[{i}].name"), &given.name, expected));
            }
        }
        let mut surfaces = Vec::with_capacity(mesh.materials.len());
        for (index, material) in mesh.materials.iter().enumerate() {
            let is_used = mesh.material_of.contains(&Some(index));
            surfaces.push(if is_used { Some(self.surface_of(material)?) } else { None });
        }
        if let Some(surface) = &self.surface {
            surface.check("target.surface")?;
        }
        let least_area = MIN_AREA * (self.radius_m / self.unit_m) * (self.radius_m / self.unit_m);
        let mut facets = Vec::with_capacity(mesh.triangles.len());
        for (triangle, material) in mesh.triangles.iter().zip(&mesh.material_of) {
            let [a, b, c] = *triangle;
            if 0.5 * (b - a).cross(&(c - a)).norm() <= least_area {
                continue;
            }
            let surface = match material {
                Some(index) => surfaces.get(*index).copied().flatten(),
                None => self.surface,
            };
            let surface = surface.ok_or_else(|| {
                let value = format!("absent, and a triangle at {} has no material", shown(&a));
                OutOfRange::new("target.surface", value, "the reflectance of triangles without a material")
            })?;
            facets.extend(Facet::triangle(triangle.map(|corner| corner * self.unit_m), surface));
        }
        facets.sort_by(|one, other| other.area().total_cmp(&one.area()));
        Ok(facets)
    }

    /// Returns the reflectance of a material: that of the scenario, or else that of the file.
    fn surface_of(&self, material: &FileMaterial) -> Result<SurfaceConfig, OutOfRange> {
        if let Some(given) = self.materials.iter().find(|given| given.name == material.name) {
            return Ok(given.surface);
        }
        material.surface.clone().map_err(|problem| {
            let value = format!("{}, material {:?}: {problem}", self.path, material.name);
            let expected = "a material that is opaque, unlit from within and of one colour, or an entry of \
                            target.materials with this name";
            OutOfRange::new("target.path", value, expected)
        })
    }
}

/// Returns the names of materials for a message.
fn names(materials: &[FileMaterial]) -> String {
    let some: Vec<String> =
        materials.iter().take(NAMES).map(|material| format!("{:?}", material.name)).collect();
    let more = if materials.len() > NAMES { ", …" } else { "" };
    format!("{}{more}", some.join(", "))
}

/// Returns the coordinates of a corner for a message, units of the file.
fn shown(corner: &Vector3<f64>) -> String {
    format!("({}, {}, {})", corner.x, corner.y, corner.z)
}
