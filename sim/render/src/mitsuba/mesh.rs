//! Facets as triangle meshes in the PLY format.

use std::collections::BTreeMap;

use contract::bounds::require;
use contract::docking::Pose;
use earcut::Earcut;
use nalgebra::Vector3;
use scene::docking::{DockingScene, Facet, Part, Sun};
use truth::SimError;

use super::Layer;

/// Distance of a shade behind the camera, m.
const BEHIND_CAMERA_M: f64 = 5.0;

/// Least sine of the Sun's elevation over the disk's plane. Below it a shade would have to be moved so far
/// that Mitsuba's 32-bit numbers blur its shadow, and surfaces that face a camera are hardly lit.
const MIN_SUN_ELEVATION_SINE: f64 = 0.02;

/// Facets of a part that have equal reflectance.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Name of the file that the scene expects, relative to the scene file.
    pub file: String,
    /// Name of the shape: index of the part, its name, index of the mesh in the part.
    pub id: String,
    /// Lambertian reflectance.
    pub reflectance: f64,
    /// File contents: binary little-endian PLY with 32-bit coordinates, m, target frame.
    pub ply: Vec<u8>,
}

/// Returns one mesh for each visible part and reflectance; in the layer of the Sun, also for each invisible
/// part that casts a shadow.
pub(super) fn meshes(scene: &DockingScene, layer: &Layer, pose: &Pose) -> Result<Vec<Mesh>, SimError> {
    let mut meshes = Vec::new();
    for (index, part) in scene.parts.iter().enumerate() {
        let behind_camera = match layer {
            Layer::Sun(sun) if !part.visible && part.casts_shadow => moved_behind(part, sun, pose),
            _ => None,
        };
        let part = match &behind_camera {
            Some(moved) => moved,
            None if part.visible => part,
            None => continue,
        };
        for (number, (reflectance, triangles)) in group_by_reflectance(part)?.into_iter().enumerate() {
            let name: String =
                part.name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            meshes.push(Mesh {
                file: format!("mesh-{:04}.ply", meshes.len()),
                id: format!("p{index}_{name}_{number}"),
                reflectance,
                ply: triangles.ply(),
            });
        }
    }
    Ok(meshes)
}

/// Moves an invisible shade towards the Sun until it is behind the camera. Its shadow does not move, and a
/// camera that points at the target does not see the shade. `None` if the Sun is not in front of the disk.
fn moved_behind(part: &Part, sun: &Sun, pose: &Pose) -> Option<Part> {
    let towards = sun.towards.normalize();
    if towards.z < MIN_SUN_ELEVATION_SINE {
        return None;
    }
    let lowest_m = part
        .facets
        .iter()
        .flat_map(|facet| &facet.outer)
        .map(|corner| corner.z)
        .fold(f64::INFINITY, f64::min);
    let missing_m = (pose.position_m.z + BEHIND_CAMERA_M - lowest_m).max(0.0);
    let way = towards * (missing_m / towards.z);
    let mut moved = part.clone();
    for facet in &mut moved.facets {
        for corner in facet.outer.iter_mut().chain(facet.holes.iter_mut().flatten()) {
            *corner += way;
        }
    }
    Some(moved)
}

fn group_by_reflectance(part: &Part) -> Result<Vec<(f64, Triangles)>, SimError> {
    // Non-negative numbers are ordered like their bits.
    let mut groups: BTreeMap<u64, Triangles> = BTreeMap::new();
    for facet in &part.facets {
        let in_range = |v: f64| (0.0..=1.0).contains(&v);
        require("reflectance of a facet", facet.reflectance, "0 to 1", in_range)?;
        // −0 and 0 count as one reflectance.
        groups.entry((facet.reflectance + 0.0).to_bits()).or_default().add(facet)?;
    }
    Ok(groups.into_iter().map(|(bits, triangles)| (f64::from_bits(bits), triangles)).collect())
}

#[derive(Debug, Default)]
struct Triangles {
    vertices: Vec<Vector3<f64>>,
    faces: Vec<[u32; 3]>,
}

impl Triangles {
    fn add(&mut self, facet: &Facet) -> Result<(), SimError> {
        let mut vertices = facet.outer.clone();
        let mut holes = Vec::new();
        for hole in &facet.holes {
            holes.push(vertices.len() as u32);
            vertices.extend(hole);
        }
        for vertex in &vertices {
            require("a vertex of a facet", vertex.sum(), "finite coordinates", |_| true)?;
        }
        require("the normal of a facet", facet.normal.norm(), "a unit vector", |v| (v - 1.0).abs() < 1e-6)?;

        // Two axes of the facet's plane, seen from the front, that are right-handed with its normal.
        let up = if facet.normal.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() };
        let u = up.cross(&facet.normal).normalize();
        let v = facet.normal.cross(&u);
        let flat: Vec<[f64; 2]> = vertices.iter().map(|point| [point.dot(&u), point.dot(&v)]).collect();
        let mut corners = Vec::new();
        Earcut::new().earcut_slice(&flat, &holes, &mut corners);

        let base = self.vertices.len() as u32;
        for triangle in corners.chunks_exact(3) {
            let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
            let [p, q, r] = [a, b, c].map(|i| flat[i as usize]);
            let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            // Mitsuba's surfaces reflect on the side from which their corners run counter-clockwise.
            let face = if twice_area > 0.0 { [a, b, c] } else { [a, c, b] };
            self.faces.push(face.map(|i| base + i));
        }
        self.vertices.extend(vertices);
        Ok(())
    }

    fn ply(&self) -> Vec<u8> {
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
             property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.vertices.len(),
            self.faces.len()
        );
        let mut bytes = header.into_bytes();
        for vertex in &self.vertices {
            for &coordinate in vertex {
                bytes.extend((coordinate as f32).to_le_bytes());
            }
        }
        for face in &self.faces {
            bytes.push(3);
            for index in face {
                bytes.extend(index.to_le_bytes());
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use scene::docking::Assembly;

    use super::*;

    const FILL: Layer = Layer::Fill { fill_radiance: 1.0, sky_radiance: 0.0 };

    fn pose() -> Pose {
        Pose { position_m: Vector3::new(0.1, 0.2, 20.0), phi_rad: Vector3::zeros() }
    }

    fn square(half: f64, reflectance: f64) -> Facet {
        let outer = vec![
            Vector3::new(-half, -half, 1.0),
            Vector3::new(half, -half, 1.0),
            Vector3::new(half, half, 1.0),
            Vector3::new(-half, half, 1.0),
        ];
        Facet { outer, holes: Vec::new(), normal: Vector3::z(), reflectance }
    }

    fn part(facets: Vec<Facet>, visible: bool) -> Part {
        Part { name: "a <b>".to_owned(), assembly: Assembly::Station, facets, casts_shadow: true, visible }
    }

    fn area_vector(triangles: &Triangles) -> Vector3<f64> {
        let corner = |i: u32| triangles.vertices[i as usize];
        let twice = triangles
            .faces
            .iter()
            .map(|&[a, b, c]| (corner(b) - corner(a)).cross(&(corner(c) - corner(a))))
            .sum::<Vector3<f64>>();
        0.5 * twice
    }

    #[test]
    fn the_triangles_have_the_area_of_the_facet_without_its_holes_and_face_as_it_does() {
        let mut facet = square(1.0, 0.5);
        for centre in [-0.5, 0.5] {
            let mut hole = square(0.25, 0.0).outer;
            hole.reverse();
            facet.holes.push(hole.into_iter().map(|p| p + Vector3::new(centre, 0.1, 0.0)).collect());
        }
        let mut triangles = Triangles::default();
        triangles.add(&facet).unwrap();
        // 4 m² less two holes of 0.25 m²; the rounding of some ten products.
        assert!((area_vector(&triangles) - 3.5 * facet.normal).norm() < 1e-12);

        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.5);
        let turned = |ring: &Vec<Vector3<f64>>| ring.iter().map(|p| turn * p).collect();
        let facet = Facet {
            outer: turned(&facet.outer),
            holes: facet.holes.iter().map(turned).collect(),
            normal: turn * facet.normal,
            reflectance: 0.5,
        };
        let mut triangles = Triangles::default();
        triangles.add(&facet).unwrap();
        assert!((area_vector(&triangles) - 3.5 * facet.normal).norm() < 1e-12);
    }

    #[test]
    fn a_visible_part_has_a_mesh_for_each_of_its_reflectances() {
        let facets = vec![square(1.0, 0.5), square(2.0, 0.04), square(3.0, 0.5)];
        let scene = DockingScene { parts: vec![part(facets.clone(), false), part(facets, true)] };
        let meshes = meshes(&scene, &FILL, &pose()).unwrap();
        let files: Vec<_> = meshes.iter().map(|m| (m.id.as_str(), m.file.as_str(), m.reflectance)).collect();
        assert_eq!(files, [("p1_a__b__0", "mesh-0000.ply", 0.04), ("p1_a__b__1", "mesh-0001.ply", 0.5)]);
        let text = String::from_utf8_lossy(&meshes[1].ply).into_owned();
        assert!(text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 8\n"), "{text}");
        let end = "end_header\n";
        let header = text.find(end).unwrap() + end.len();
        assert_eq!(meshes[1].ply.len(), header + 8 * 12 + 4 * 13);
    }

    #[test]
    fn an_unseen_shade_is_behind_the_camera_with_its_shadow_where_it_was() {
        let sun = Sun { towards: Vector3::new(0.48, -0.64, 0.6), irradiance: 1.0 };
        let shade = part(vec![square(0.5, 0.0)], false);
        let moved = moved_behind(&shade, &sun, &pose()).unwrap();
        let shadow = |corner: &Vector3<f64>| corner - sun.towards * (corner.z / sun.towards.z);
        for (before, after) in shade.facets[0].outer.iter().zip(&moved.facets[0].outer) {
            assert!((after.z - 25.0).abs() < 1e-12, "{after}");
            // Rounding of coordinates of some 20 m.
            assert!((shadow(before) - shadow(after)).norm() < 1e-13);
        }
        let scene = DockingScene { parts: vec![shade] };
        assert_eq!(meshes(&scene, &Layer::Sun(sun), &pose()).unwrap().len(), 1);
        assert_eq!(meshes(&scene, &FILL, &pose()).unwrap().len(), 0);
        let behind = Sun { towards: Vector3::new(0.8, 0.0, -0.6), ..sun };
        assert_eq!(meshes(&scene, &Layer::Sun(behind), &pose()).unwrap().len(), 0);
    }

    #[test]
    fn an_impossible_surface_is_refused() {
        let of = |facet: Facet| {
            let scene = DockingScene { parts: vec![part(vec![facet], true)] };
            meshes(&scene, &FILL, &pose()).unwrap_err().to_string()
        };
        let message = of(square(1.0, f64::NAN));
        assert!(message.contains("reflectance of a facet is NaN"), "{message}");
        let message = of(square(f64::INFINITY, 0.5));
        assert!(message.contains("vertex"), "{message}");
    }
}
