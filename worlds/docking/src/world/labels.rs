//! Labels of fields: target, docking unit and station, with the target's features as keypoints.

use ::labels::{
    FrameLabels, ImageCamera, KeypointLabel, LabelClass, LabelSet, LabelView, ModelExtent, ObjectLabel,
    ObjectPose, RowSampling,
};
use contract::PixelPoint;
use contract::docking::{Lines, Pose};
use files::Failure;
use nalgebra::{UnitQuaternion, Vector3};
use run::world::WorldScenario as _;
use sim::PointImage;
use sim::docking::FieldState;
use sim::scene::NamedPoint;
use sim::scene::docking::Assembly;
use sim::truth::approach::target_from_camera;

use super::mission::DockingMission;

/// Assemblies in the order of their classes, with their names.
const CLASSES: [(Assembly, &str); 3] =
    [(Assembly::Target, "target"), (Assembly::DockingUnit, "docking_unit"), (Assembly::Station, "station")];

/// Camera with the rows of its fields: a field of the even rows and one of the odd rows are two cameras,
/// whose principal points differ by half a row.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FieldView {
    camera: usize,
    lines: Lines,
}

/// Returns the classes and cameras.
pub(super) fn label_set(mission: &DockingMission) -> LabelSet {
    let run_file = &mission.run_file;
    let mut classes = Vec::with_capacity(CLASSES.len());
    for (assembly, name) in CLASSES {
        classes.push(LabelClass {
            name: name.to_owned(),
            keypoints: features(mission, assembly).into_iter().map(|feature| feature.name).collect(),
            model: ModelExtent::from_vertices(&vertices_m(mission, assembly)),
        });
    }
    LabelSet {
        description: format!(
            "Boresight {}, scenario {}, seed {}",
            run_file.version, run_file.name, run_file.scenario.seed
        ),
        classes,
        views: views(mission).into_iter().filter_map(|view| label_view(mission, view)).collect(),
        note: None,
    }
}

/// Returns the labels of a field, in the rows of its image.
///
/// # Errors
/// A [`Failure`] when the field does not exist.
pub(super) fn field_labels(mission: &DockingMission, field: u64) -> Result<FrameLabels, Failure> {
    let simulator = &mission.simulator;
    let state = simulator.field_state(field)?;
    let view = FieldView { camera: state.camera, lines: state.lines };
    let mut painter = simulator.mask_painter(&state)?;
    let silhouettes = simulator.silhouettes(&state, &mut painter);
    let rows = sampling(mission, view);
    let size = (mission.setup.cameras.get(view.camera).map_or(0, |camera| camera.columns), rows.rows);
    let mut objects = Vec::with_capacity(CLASSES.len());
    for (class, (assembly, _)) in CLASSES.into_iter().enumerate() {
        let Some(silhouette) = silhouettes.iter().find(|found| found.assembly == assembly) else { continue };
        let anchor = anchor(mission, &state, assembly).and_then(|point| painter.pixel_of(point));
        let label = ObjectLabel::in_picture(class, size, &silhouette.whole, &silhouette.visible, anchor);
        objects.extend(label.map(|label| ObjectLabel {
            keypoints: keypoints(mission, &state, &features(mission, assembly), rows, size),
            pose: Some(object_pose(&state.state.pose)),
            ..label
        }));
    }
    let view = views(mission).iter().position(|known| *known == view).unwrap_or(0);
    Ok(FrameLabels { number: field, view, objects })
}

/// Returns the cameras of all fields.
fn views(mission: &DockingMission) -> Vec<FieldView> {
    let interlace = mission.scenario().television.interlace;
    let lines: &[Lines] = match interlace.lines(0) {
        Lines::All => &[Lines::All],
        Lines::Even | Lines::Odd => &[Lines::Even, Lines::Odd],
    };
    let mut views = Vec::new();
    for camera in 0..mission.setup.cameras.len() {
        views.extend(lines.iter().map(|lines| FieldView { camera, lines: *lines }));
    }
    views
}

fn label_view(mission: &DockingMission, view: FieldView) -> Option<LabelView> {
    let FieldView { camera, lines } = view;
    let name = match lines {
        Lines::All => format!("camera-{camera}"),
        Lines::Even | Lines::Odd => format!("camera-{camera}-{}", lines.code()),
    };
    let rows = sampling(mission, view);
    Some(LabelView { name, camera: ImageCamera::new(mission.setup.cameras.get(camera)?, rows) })
}

fn sampling(mission: &DockingMission, FieldView { camera, lines }: FieldView) -> RowSampling {
    let camera_rows = mission.setup.cameras.get(camera).map_or(0, |camera| camera.rows);
    RowSampling { first: lines.camera_row(0), step: lines.step(), rows: lines.rows(camera_rows) }
}

/// Returns the features that are the keypoints of an assembly.
fn features(mission: &DockingMission, assembly: Assembly) -> Vec<NamedPoint> {
    match assembly {
        Assembly::Target => mission.simulator.target_features(),
        Assembly::DockingUnit | Assembly::Station => Vec::new(),
    }
}

/// Returns the corners of an assembly, target frame, m.
fn vertices_m(mission: &DockingMission, assembly: Assembly) -> Vec<Vector3<f64>> {
    let parts = mission.simulator.scene().parts.iter();
    let of_assembly = parts.filter(|part| part.visible && part.assembly == assembly);
    of_assembly.flat_map(|part| part.facets.iter().flat_map(|facet| facet.outer.iter().copied())).collect()
}

/// Returns the image of the middle of an assembly, px of the camera: it labels an assembly that is smaller
/// than a pixel.
fn anchor(mission: &DockingMission, state: &FieldState, assembly: Assembly) -> Option<PixelPoint> {
    let model = &mission.setup.target;
    let on_axis = |[y1, y2]: [f64; 2], depth_m: f64| Vector3::new(y1, y2, -depth_m);
    let point_m = match assembly {
        Assembly::Target => Vector3::zeros(),
        Assembly::DockingUnit => on_axis(model.docking_unit.centre_m, model.docking_unit.depth_m),
        Assembly::Station => on_axis(model.station.centre_m, model.station.depth_m),
    };
    let images = mission.simulator.feature_images(state, &[point_m]);
    images.first().and_then(|image| image.position)
}

/// Returns the labels of features.
fn keypoints(
    mission: &DockingMission,
    state: &FieldState,
    features: &[NamedPoint],
    rows: RowSampling,
    size: (usize, usize),
) -> Vec<KeypointLabel> {
    let points_m: Vec<Vector3<f64>> = features.iter().map(|feature| feature.position_m).collect();
    let images = mission.simulator.feature_images(state, &points_m);
    let label = |image: &PointImage| {
        let in_rows = |point: PixelPoint| PixelPoint::new(point.x, rows.image_row(point.y));
        KeypointLabel::new(image.position.map(in_rows), image.is_hidden, size)
    };
    images.iter().map(label).collect()
}

/// Returns the pose of the target frame in the camera frame: x = Aᵀ (y − d).
fn object_pose(pose: &Pose) -> ObjectPose {
    let camera_from_target = target_from_camera(pose).transpose();
    let quaternion = UnitQuaternion::from_matrix(&camera_from_target);
    ObjectPose::from_quaternion(quaternion, -(camera_from_target * pose.position_m))
}
