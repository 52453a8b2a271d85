//! Outlines of the scene's assemblies and positions of the target's features in a field: the source of
//! labels.

use nalgebra::Vector3;
use render::vector::{MaskPainter, RowSpans};
use scene::NamedPoint;
use scene::docking::{Assembly, Part};
use truth::SimError;
use truth::approach::target_from_camera;

use super::simulator::{DockingSimulator, FieldState};
use crate::PointImage;

/// Pixels of an assembly in the image of a field: rows are those of the field, also beyond the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblySilhouette {
    /// The assembly.
    pub assembly: Assembly,
    /// Pixels whose centres the assembly covers, as if no other assembly hid it.
    pub whole: RowSpans,
    /// Those of these pixels that no other assembly hides.
    pub visible: RowSpans,
}

impl DockingSimulator {
    /// Returns the features of the target: the centre of the disk, the centre and the ends of the cross
    /// (front face; right is +y1, top is +y2), the centres of the marks.
    pub fn target_features(&self) -> Vec<NamedPoint> {
        let cross = &self.model.cross;
        let (length, height) = (cross.half_length_m, cross.height_m);
        let fixed = [
            ("disk_centre", [0.0, 0.0, 0.0]),
            ("cross_centre", [0.0, 0.0, height]),
            ("cross_right", [length, 0.0, height]),
            ("cross_top", [0.0, length, height]),
            ("cross_left", [-length, 0.0, height]),
            ("cross_bottom", [0.0, -length, height]),
        ];
        let fixed = fixed.map(|(name, position)| NamedPoint {
            name: name.to_owned(),
            position_m: Vector3::from(position),
        });
        let marks = self.model.marks.iter().enumerate().map(|(index, corners)| {
            let centre = corners
                .iter()
                .fold(Vector3::zeros(), |sum, [y1, y2]| sum + 0.25 * Vector3::new(*y1, *y2, 0.0));
            NamedPoint { name: format!("mark_{index}"), position_m: centre }
        });
        fixed.into_iter().chain(marks).collect()
    }

    /// Returns the images of points of the target frame, m, in a field.
    pub fn feature_images(&self, state: &FieldState, points_m: &[Vector3<f64>]) -> Vec<PointImage> {
        let pose = &state.state.pose;
        let image = |point_m: &Vector3<f64>| PointImage {
            position: self.eyes.get(state.camera).and_then(|eye| eye.image_of(pose, point_m)),
            is_hidden: self.geometry.is_hidden(pose, point_m),
        };
        points_m.iter().map(image).collect()
    }

    /// Returns a painter of masks in the image of a field.
    ///
    /// # Errors
    /// None after [`DockingSimulator::new`], which made the same checks.
    pub fn mask_painter(&self, state: &FieldState) -> Result<MaskPainter, SimError> {
        MaskPainter::new(&self.cameras[state.camera].camera, state.lines)
    }

    /// Returns the silhouettes of target, docking unit and station in a field, by the order of the scene: a
    /// part never lies in front of a later part.
    pub fn silhouettes(&self, state: &FieldState, painter: &mut MaskPainter) -> Vec<AssemblySilhouette> {
        let assemblies = [Assembly::Target, Assembly::DockingUnit, Assembly::Station];
        let mut silhouettes = assemblies.map(|assembly| AssemblySilhouette {
            assembly,
            whole: RowSpans::default(),
            visible: RowSpans::default(),
        });
        let mut in_front = RowSpans::default();
        for part in self.scene.parts.iter().rev().filter(|part| part.visible) {
            let pixels = part_mask(part, state, painter);
            for silhouette in silhouettes.iter_mut().filter(|s| s.assembly == part.assembly) {
                silhouette.whole = silhouette.whole.union(&pixels);
                silhouette.visible = silhouette.visible.union(&pixels.without(&in_front));
            }
            in_front = in_front.union(&pixels);
        }
        silhouettes.to_vec()
    }
}

/// Returns the pixels of the facets of a part that face the camera.
fn part_mask(part: &Part, state: &FieldState, painter: &mut MaskPainter) -> RowSpans {
    let pose = &state.state.pose;
    let camera_from_target = target_from_camera(pose).transpose();
    let in_camera = |ring: &Vec<Vector3<f64>>| -> Vec<Vector3<f64>> {
        ring.iter().map(|corner| camera_from_target * (corner - pose.position_m)).collect()
    };
    for facet in &part.facets {
        let Some(corner) = facet.outer.first() else { continue };
        if facet.normal.dot(&(pose.position_m - corner)) > 0.0 {
            let holes: Vec<_> = facet.holes.iter().map(in_camera).collect();
            painter.add(&in_camera(&facet.outer), &holes);
        }
    }
    painter.finish()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use contract::Camera;
    use contract::docking::Lines;
    use render::vector::{Drawer, RadianceImage};
    use scene::docking::{DockingScene, Lighting};
    use sensor::television::{Interlace, TelevisionConfig};
    use truth::approach::{ApproachConfig, ConstantVelocityConfig};

    use super::*;
    use crate::docking::{CameraConfig, DockingSimulation, LensConfig, LightingConfig};

    /// Camera at rest, turned and off the axis, with a distortion of several pixels in the corner.
    fn simulator(position_m: [f64; 3]) -> DockingSimulator {
        let camera = Camera {
            columns: 384,
            rows: 288,
            focal_length_mm: 10.0,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 180.0,
            principal_y_px: 150.0,
            radial: [4e-7, 0.0, 0.0],
            tangential: [2e-6, -3e-6],
        };
        let simulation = DockingSimulation {
            seed: 7,
            start_utc: "2004-01-31T13:00:00Z".into(),
            target: "progress".into(),
            approach: ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
                position_m,
                velocity_m_s: [0.0; 3],
                phi_deg: [0.4, -0.7, 9.0],
                phi_rate_deg_s: [0.0; 3],
                duration_s: 1.0,
            }),
            cameras: vec![CameraConfig { name: "TV".into(), until_range_m: 0.0, camera }],
            lens: LensConfig::default(),
            lighting: LightingConfig::default(),
            television: TelevisionConfig { interlace: Interlace::TopFirst, ..TelevisionConfig::default() },
        };
        DockingSimulator::new(&simulation, Path::new(".")).unwrap()
    }

    /// Fraction of each camera pixel that an assembly covers and no other hides, by the renderer: the
    /// assembly is white and everything else is black.
    fn visible_coverage(
        simulator: &DockingSimulator,
        state: &FieldState,
        assembly: Assembly,
    ) -> RadianceImage {
        let mut scene = DockingScene { parts: simulator.scene().parts.clone() };
        for part in &mut scene.parts {
            let reflectance = if part.assembly == assembly { 1.0 } else { 0.0 };
            part.facets.iter_mut().for_each(|facet| facet.reflectance = reflectance);
        }
        let lighting = Lighting { sun: None, fill_radiance: 1.0, sky_radiance: 0.0, floodlight: None };
        let mut image = RadianceImage::default();
        let mut drawer = Drawer::new(&simulator.cameras[0].camera).unwrap();
        drawer.draw(&scene, &lighting, &state.state.pose, &mut image);
        image
    }

    /// Returns true for the pixels of a mask, row by row.
    fn pixels(mask: &RowSpans, columns: usize, rows: usize) -> Vec<bool> {
        let mut pixels = vec![false; columns * rows];
        for span in mask.within(columns as i32, rows as i32).spans() {
            let start = span.row as usize * columns;
            pixels[start + span.start as usize..start + span.end as usize].fill(true);
        }
        pixels
    }

    /// Masks and areas are independent: the former test the centre of each pixel, the latter sum areas.
    #[test]
    fn a_mask_holds_the_drawn_pixels() {
        for position_m in [[0.4, -0.3, 9.0], [0.1, 0.05, 2.5], [3.0, -2.0, 60.0]] {
            let simulator = simulator(position_m);
            for field in [0, 1] {
                let state = simulator.field_state(field).unwrap();
                let mut painter = simulator.mask_painter(&state).unwrap();
                let silhouettes = simulator.silhouettes(&state, &mut painter);
                for AssemblySilhouette { assembly, visible, .. } in &silhouettes {
                    let image = visible_coverage(&simulator, &state, *assembly);
                    let mask = pixels(visible, image.columns, state.lines.rows(image.rows));
                    let (mut area, mut count, mut seams) = (0.0, 0, 0);
                    for (index, is_mask) in mask.iter().enumerate() {
                        let row = state.lines.camera_row(index / image.columns);
                        let covered = image.radiance[row * image.columns + index % image.columns];
                        area += f64::from(covered);
                        count += usize::from(*is_mask);
                        // A pixel whose centre is inside may be covered by less than half, and never barely.
                        let is_clear = if *is_mask { covered > 0.02 } else { covered < 0.98 };
                        seams += usize::from(!is_clear);
                    }
                    // Where circles of few and of many sides meet, the scene has gaps of millimetres, which
                    // the renderer closes ("disjoint coverage") and a centre may meet.
                    assert!(seams <= 4, "{assembly:?} {position_m:?}: {seams} pixels");
                    // The roundings at both borders of each row average out.
                    let tolerance = 6.0 + 0.01 * area;
                    assert!((area - count as f64).abs() < tolerance, "{assembly:?} {area} {count}");
                }
            }
        }
    }

    /// The disk's centre lies behind the cross for a camera on the axis; the marks around it are in view.
    #[test]
    fn the_cross_hides_the_centre_of_the_disk() {
        let simulator = simulator([0.0, 0.0, 5.0]);
        let state = simulator.field_state(1).unwrap();
        assert_eq!(state.lines, Lines::Odd);
        let features = simulator.target_features();
        let points: Vec<_> = features.iter().map(|feature| feature.position_m).collect();
        let images = simulator.feature_images(&state, &points);
        let hidden: Vec<&str> = features
            .iter()
            .zip(&images)
            .filter(|(_, image)| image.is_hidden)
            .map(|(feature, _)| feature.name.as_str())
            .collect();
        assert_eq!(hidden, ["disk_centre"]);
        assert_eq!(features.len(), 6 + 12);
    }
}
