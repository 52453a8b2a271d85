//! Labels of frames: the target with its named points.

use ::labels::{
    FrameLabels, ImageCamera, KeypointLabel, LabelClass, LabelSet, LabelView, ModelExtent, ObjectLabel,
    ObjectPose, RowSampling,
};
use files::Failure;
use run::world::WorldScenario as _;
use sim::scene::TargetShape;
use sim::{PointImage, Simulator, TargetView};

use super::mission::FarRangeMission;

/// Returns the class of the target and the camera.
pub(super) fn label_set(mission: &FarRangeMission) -> LabelSet {
    let (run_file, target) = (&mission.run_file, mission.simulator.target());
    let camera = &run_file.scenario.camera;
    let rows = RowSampling { first: 0, step: 1, rows: camera.rows };
    let note = match target.shape() {
        TargetShape::Point => Some(
            "labels: the target is a beacon, a point without extent: its mask and its box are the pixel of its \
             position",
        ),
        TargetShape::Sphere | TargetShape::Body => None,
    };
    LabelSet {
        description: format!(
            "Boresight {}, scenario {}, seed {}",
            run_file.version, run_file.name, run_file.scenario.seed
        ),
        classes: vec![LabelClass {
            name: "target".to_owned(),
            keypoints: target.named_points().into_iter().map(|point| point.name).collect(),
            model: ModelExtent::from_vertices(&target.corners_m()),
        }],
        views: vec![LabelView { name: "camera".to_owned(), camera: ImageCamera::new(camera, rows) }],
        note: note.map(str::to_owned),
    }
}

/// Returns the labels of a frame, at the middle of its exposure.
///
/// # Errors
/// A [`Failure`] when the frame does not exist.
pub(super) fn frame_labels(mission: &FarRangeMission, frame: u64) -> Result<FrameLabels, Failure> {
    let camera = &mission.scenario().camera;
    let mut painter = Simulator::mask_painter(camera)?;
    let view = mission.simulator.target_view(frame, &mut painter)?;
    let size = (camera.columns, camera.rows);
    let anchor = view.origin.and_then(|origin| painter.pixel_of(origin));
    // Nothing is nearer than the target: its whole silhouette is visible.
    let label = ObjectLabel::in_picture(0, size, &view.silhouette, &view.silhouette, anchor);
    let objects = label.map(|label| ObjectLabel {
        keypoints: view.points.iter().map(|point| keypoint(point, size)).collect(),
        pose: pose(&view),
        ..label
    });
    Ok(FrameLabels { number: frame, view: 0, objects: objects.into_iter().collect() })
}

fn keypoint(point: &PointImage, size: (usize, usize)) -> KeypointLabel {
    KeypointLabel::new(point.position, point.is_hidden, size)
}

fn pose(view: &TargetView) -> Option<ObjectPose> {
    let rotation = view.camera_from_target.as_ref()?;
    Some(ObjectPose::from_quaternion(*rotation.quaternion(), view.position_m))
}
