//! Check for frames that cannot be processed at all.

use contract::{Frame, Telemetry};

use crate::CameraModel;

/// Returns the reason why a frame and its telemetry cannot be processed; `None` if they can.
pub(super) fn unusable_reason(frame: &Frame, telemetry: &Telemetry, model: &CameraModel) -> Option<String> {
    let (columns, rows) = model.size_px();
    if (frame.columns(), frame.rows()) != (columns, rows) {
        return Some(format!(
            "the frame has {} × {} pixels, expected {columns} × {rows}, the size of the camera",
            frame.columns(),
            frame.rows()
        ));
    }
    let norm = telemetry.body_from_icrs.quaternion().norm();
    let is_unit = (norm - 1.0).abs() < 1e-4;
    (!is_unit).then(|| format!("the telemetry's attitude has norm {norm}, expected 1"))
}
