//! Scene file of Mitsuba 3.

use contract::bounds::require;
use contract::docking::Pose;
use contract::{Camera, OutOfRange};
use nalgebra::{Matrix3, Rotation3, Vector3};
use scene::docking::DockingScene;
use truth::SimError;
use truth::approach::target_from_camera;

use super::matrix::matrix;
use super::mesh::{Mesh, meshes};
use super::{Crop, Layer, Settings};

/// Input of Mitsuba: a scene file, and the meshes beside it to which it refers.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFiles {
    /// Text of the scene file.
    pub xml: String,
    /// Meshes of the scene.
    pub meshes: Vec<Mesh>,
    /// Rendered part of the camera's image.
    pub crop: Crop,
}

impl SceneFiles {
    /// Describes a scene under one layer of its light. For Mitsuba 3.9 in the variant `scalar_rgb`; the image
    /// has one channel of 32-bit radiances, each the mean over its pixel (box filter), in the units of
    /// [`scene::docking::Lighting`].
    ///
    /// # Errors
    /// [`SimError`] for numbers out of range, and for a camera that Mitsuba does not support: one with
    /// distortion, or with pixels that are not square.
    pub fn new(
        scene: &DockingScene,
        layer: &Layer,
        pose: &Pose,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Self, SimError> {
        camera.check()?;
        let crop = settings.check(camera)?;
        let sensor = sensor(pose, camera, settings, &crop)?;
        let meshes = meshes(scene, layer, pose)?;
        let hide_emitters = !matches!(layer, Layer::Fill { .. });
        let mut xml = format!(
            "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<scene version=\"3.0.0\">\n  <integrator type=\"path\">\n    \
             <integer name=\"max_depth\" value=\"{}\"/>\n    <boolean name=\"hide_emitters\" value=\"{hide_emitters}\"/>\n  \
             </integrator>\n",
            layer.max_depth()
        );
        xml.push_str(&sensor);
        xml.push_str(&layer.emitter());
        for Mesh { file, id, reflectance, .. } in &meshes {
            xml.push_str(&format!(
                "  <shape type=\"ply\" id=\"{id}\">\n    <string name=\"filename\" value=\"{file}\"/>\n    \
                 <boolean name=\"face_normals\" value=\"true\"/>\n    {}\n  </shape>\n",
                layer.surface(*reflectance)
            ));
        }
        xml.push_str("</scene>\n");
        Ok(Self { xml, meshes, crop })
    }
}

/// Camera of Mitsuba. Mitsuba's camera frame is x left, y up, z forward, and its first pixel covers 0 to 1.
/// Its principal point is this project's plus half a pixel, and its offset counts from the centre to the left
/// and up.
fn sensor(pose: &Pose, camera: &Camera, settings: &Settings, crop: &Crop) -> Result<String, OutOfRange> {
    let (fx, fy) = camera.focal_length_px();
    if camera.radial != [0.0; 3] || camera.tangential != [0.0; 2] {
        return Err(OutOfRange::new(
            "camera.radial, camera.tangential",
            format!("{:?}, {:?}", camera.radial, camera.tangential),
            "zeros: the renderer mitsuba has no distortion; set them to 0, or use the renderer fast",
        ));
    }
    // A relative difference of 10⁻⁹ is a millionth of a pixel at the border of the largest detector.
    if (fx / fy - 1.0).abs() > 1e-9 {
        return Err(OutOfRange::new(
            "camera.pixel_width_um, camera.pixel_height_um",
            format!("{}, {}", camera.pixel_width_um, camera.pixel_height_um),
            "equal numbers: the renderer mitsuba has square pixels only; use the renderer fast",
        ));
    }
    let numbers = pose.position_m.sum() + pose.phi_rad.sum();
    require("pose", numbers, "finite numbers", |_| true)?;

    let (columns, rows) = (camera.columns as f64, camera.rows as f64);
    let fov_deg = (2.0 * libm::atan(columns / (2.0 * fx))).to_degrees();
    let offset_x = (columns / 2.0 - (camera.principal_x_px + 0.5)) / columns;
    let offset_y = (rows / 2.0 - (camera.principal_y_px + 0.5)) / rows;
    let mitsuba_axes = Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 1.0));
    // Both factors reflect two axes, so the product is a rotation.
    let to_world = Rotation3::from_matrix_unchecked(target_from_camera(pose) * mitsuba_axes);

    let film: String = [
        ("width", camera.columns),
        ("height", camera.rows),
        ("crop_offset_x", crop.x),
        ("crop_offset_y", crop.y),
        ("crop_width", crop.columns),
        ("crop_height", crop.rows),
    ]
    .iter()
    .map(|(name, value)| format!("      <integer name=\"{name}\" value=\"{value}\"/>\n"))
    .collect();
    Ok(format!(
        "  <sensor type=\"perspective\">\n    <string name=\"fov_axis\" value=\"x\"/>\n    \
         <float name=\"fov\" value=\"{fov_deg}\"/>\n    \
         <float name=\"principal_point_offset_x\" value=\"{offset_x}\"/>\n    \
         <float name=\"principal_point_offset_y\" value=\"{offset_y}\"/>\n    \
         <float name=\"near_clip\" value=\"0.01\"/>\n    <float name=\"far_clip\" value=\"10000\"/>\n    \
         <transform name=\"to_world\"><matrix value=\"{}\"/></transform>\n    \
         <sampler type=\"multijitter\"><integer name=\"sample_count\" value=\"{}\"/>\
         <integer name=\"seed\" value=\"0\"/></sampler>\n    \
         <film type=\"hdrfilm\">\n{film}      <string name=\"pixel_format\" value=\"luminance\"/>\n      \
         <string name=\"component_format\" value=\"float32\"/>\n      <rfilter type=\"box\"/>\n    </film>\n  </sensor>\n",
        matrix(&to_world, &pose.position_m),
        settings.samples,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::docking::{Assembly, Facet, Lighting, Part, Sun};

    fn camera() -> Camera {
        Camera {
            columns: 768,
            rows: 576,
            focal_length_mm: 10.55,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 387.5,
            principal_y_px: 283.0,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    fn pose() -> Pose {
        Pose { position_m: Vector3::new(0.1, -0.2, 5.0), phi_rad: Vector3::zeros() }
    }

    fn scene() -> DockingScene {
        let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let outer = ring.map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
        let facet = Facet { outer, holes: Vec::new(), normal: Vector3::z(), reflectance: 0.5 };
        let part = Part {
            name: "plate".to_owned(),
            assembly: Assembly::Station,
            facets: vec![facet],
            casts_shadow: true,
            visible: true,
        };
        DockingScene { parts: vec![part] }
    }

    fn files(layer: &Layer, camera: &Camera, settings: &Settings) -> Result<SceneFiles, SimError> {
        SceneFiles::new(&scene(), layer, &pose(), camera, settings)
    }

    const SUN: Layer = Layer::Sun(Sun { towards: Vector3::new(0.0, 0.0, 1.0), irradiance: 2.0 });

    #[test]
    fn the_camera_of_ideal_docking_looks_at_the_target_with_its_left_on_the_target_s_left() {
        let xml = files(&SUN, &camera(), &Settings::default()).unwrap().xml;
        // x left is −y1, y up is y2, z forward is −y3.
        assert!(xml.contains("<matrix value=\"-1 0 0 0.1 0 1 0 -0.2 0 0 -1 5 0 0 0 1\"/>"), "{xml}");
    }

    /// Columns: (384 − 388)/768 = −1/192; rows: (288 − 283.5)/576 = 1/128.
    #[test]
    fn the_principal_point_is_half_a_pixel_on_and_its_offset_has_the_other_sign() {
        let xml = files(&SUN, &camera(), &Settings::default()).unwrap().xml;
        assert!(xml.contains(&format!("principal_point_offset_x\" value=\"{}\"", -1.0 / 192.0)), "{xml}");
        assert!(xml.contains("principal_point_offset_y\" value=\"0.0078125\""), "{xml}");
    }

    #[test]
    fn fill_is_light_of_the_surfaces_themselves() {
        let lighting = Lighting { sun: None, floodlight: None, fill_radiance: 0.25, sky_radiance: 0.125 };
        let layers = Layer::from_lighting(&lighting).unwrap();
        let xml = files(&layers[0], &camera(), &Settings::default()).unwrap().xml;
        assert!(
            xml.contains("<emitter type=\"area\"><rgb name=\"radiance\" value=\"0.125, 0.125, 0.125\"/>"),
            "{xml}"
        );
        assert!(
            xml.contains("\"max_depth\" value=\"1\"") && xml.contains("\"hide_emitters\" value=\"false\""),
            "{xml}"
        );
    }

    #[test]
    fn a_camera_that_mitsuba_has_not_is_refused_by_its_field() {
        let settings = Settings::default();
        let message =
            |camera: &Camera, settings: &Settings| files(&SUN, camera, settings).unwrap_err().to_string();
        let distorted = message(&Camera { radial: [1e-8, 0.0, 0.0], ..camera() }, &settings);
        assert!(distorted.contains("camera.radial") && distorted.contains("no distortion"), "{distorted}");
        let flat = message(&Camera { pixel_height_um: 9.9, ..camera() }, &settings);
        assert!(flat.contains("camera.pixel_height_um"), "{flat}");
        let samples = message(&camera(), &Settings { samples: 200, crop: None });
        assert!(samples.contains("samples is 200"), "{samples}");
        for crop in [
            Crop { x: 760, y: 0, columns: 9, rows: 1 },
            Crop { x: 0, y: 0, columns: 0, rows: 1 },
            Crop { x: usize::MAX, y: 0, columns: 2, rows: 1 },
        ] {
            let text = message(&camera(), &Settings { crop: Some(crop), ..settings });
            assert!(text.contains("crop"), "{text}");
        }
    }
}
