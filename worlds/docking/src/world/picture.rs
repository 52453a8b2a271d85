//! Summary of the warps of the picture: what the camera file does not state.

use contract::Camera;
use contract::docking::{DockingOutcome, DockingSetup, FieldTelemetry, PictureWarp};
use indexmap::IndexMap;
use run::AnswerSummary;

/// Smallest displacement in the picture's corner that is worth a word, px.
const MIN_SHOWN_PX: f64 = 0.05;

/// Fields with a warp, and the last one of each camera.
#[derive(Debug, Default)]
pub(super) struct PictureWarps {
    fields: u64,
    warped: u64,
    last: IndexMap<usize, PictureWarp>,
}

impl PictureWarps {
    pub(super) fn add(&mut self, telemetry: &FieldTelemetry, outcome: &DockingOutcome) {
        self.fields += 1;
        if let Some(warp) = outcome.features.warp {
            self.warped += 1;
            self.last.insert(telemetry.camera, warp);
        }
    }

    /// Returns the summary, if the picture of a camera is warped in more than half of the fields.
    pub(super) fn summary(&self, setup: &DockingSetup) -> Option<AnswerSummary> {
        if 2 * self.warped <= self.fields {
            return None;
        }
        let mut cameras = Vec::new();
        for (index, warp) in &self.last {
            let words = describe(warp, setup.cameras.get(*index)?);
            if !words.is_empty() {
                cameras.push(format!("camera {index}: {}", words.join(", ")));
            }
        }
        (!cameras.is_empty()).then(|| AnswerSummary {
            key: "picture",
            counts: IndexMap::from([("fields", self.fields), ("warped", self.warped)]),
            text: format!(
                "the picture differs from the camera file in {} of {} fields (the covariance contains it): {}",
                self.warped,
                self.fields,
                cameras.join("; ")
            ),
        })
    }
}

/// Returns the warps in words, each with its size in the picture.
fn describe(warp: &PictureWarp, camera: &Camera) -> Vec<String> {
    let (half_columns, half_rows) = (0.5 * camera.columns as f64, 0.5 * camera.rows as f64);
    let mut words = Vec::new();
    let corner = warp.radial * (half_columns * half_columns + half_rows * half_rows);
    if (corner * half_columns).abs() > MIN_SHOWN_PX {
        words.push(format!(
            "radial distortion of {:.2} % in the corner (radial[0] {:+.1e})",
            100.0 * corner,
            warp.radial
        ));
    }
    let bend_px = warp.bend * half_rows * half_rows;
    if bend_px.abs() > MIN_SHOWN_PX {
        words.push(format!("first and last rows displaced by {bend_px:.1} px along the row"));
    }
    if (warp.shear * half_rows).abs() > MIN_SHOWN_PX {
        words.push(format!("columns inclined by {:.2} px per 100 rows", 100.0 * warp.shear));
    }
    if (warp.stretch * half_rows).abs() > MIN_SHOWN_PX {
        let (percent, sense) = (
            100.0 * warp.stretch.abs(),
            if warp.stretch > 0.0 { "farther apart" } else { "closer together" },
        );
        words.push(format!("rows {percent:.2} % {sense} than the pixels' width and height state"));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The camera of the docking scenario's narrow lens, rounded.
    fn camera() -> Camera {
        Camera {
            columns: 768,
            rows: 576,
            focal_length_mm: 24.0,
            pixel_width_um: 8.0,
            pixel_height_um: 8.0,
            principal_x_px: 383.5,
            principal_y_px: 287.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    #[test]
    fn each_warp_has_its_size_in_the_picture() {
        // The corner is 480 px from the middle.
        let warp = PictureWarp { radial: 4.34e-8, bend: 3.4e-5, shear: -0.005, stretch: 0.02 };
        assert_eq!(
            describe(&warp, &camera()),
            [
                "radial distortion of 1.00 % in the corner (radial[0] +4.3e-8)",
                "first and last rows displaced by 2.8 px along the row",
                "columns inclined by -0.50 px per 100 rows",
                "rows 2.00 % farther apart than the pixels' width and height state",
            ]
        );
    }

    #[test]
    fn a_warp_too_small_to_see_has_no_word() {
        let warp = PictureWarp { radial: 1e-12, bend: 1e-9, shear: 1e-5, stretch: 1e-5 };
        assert!(describe(&warp, &camera()).is_empty());
    }
}
