//! Outlines of the scene's assemblies and positions of the target's features in a field: the source of labels.

use contract::PixelPoint;
use nalgebra::Vector3;
use render::vector::{MaskPainter, RowSpans};
use scene::docking::{Assembly, Part};
use truth::SimError;
use truth::approach::target_from_camera;

use super::simulator::{DockingSimulator, FieldState};

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

/// Feature of the target.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetFeature {
    /// Name: `disk_centre`, `cross_centre`, `cross_right`, `cross_top`, `cross_left`, `cross_bottom`, and
    /// `mark_0` and so on in the order of the target's file.
    pub name: String,
    /// Position in the target frame, m.
    pub position_m: Vector3<f64>,
}

/// Image of a feature of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureImage {
    /// Position, px of the camera, also for a field; `None` behind the camera or far outside the picture.
    pub position: Option<PixelPoint>,
    /// True if a part of the scene lies between the camera and the feature.
    pub is_hidden: bool,
}

impl DockingSimulator {
    /// Returns the features of the target: the centre of the disk, the centre and the ends of the cross (front
    /// face; right is +y1, top is +y2), the centres of the marks.
    pub fn target_features(&self) -> Vec<TargetFeature> {
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
        let fixed = fixed.map(|(name, position)| TargetFeature {
            name: name.to_owned(),
            position_m: Vector3::from(position),
        });
        let marks = self.model.marks.iter().enumerate().map(|(index, corners)| {
            let centre = corners
                .iter()
                .fold(Vector3::zeros(), |sum, [y1, y2]| sum + 0.25 * Vector3::new(*y1, *y2, 0.0));
            TargetFeature { name: format!("mark_{index}"), position_m: centre }
        });
        fixed.into_iter().chain(marks).collect()
    }

    /// Returns the images of points of the target frame, m, in a field.
    pub fn feature_images(&self, state: &FieldState, points_m: &[Vector3<f64>]) -> Vec<FeatureImage> {
        let pose = &state.state.pose;
        let image = |point_m: &Vector3<f64>| FeatureImage {
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
