//! Makes the images of golden/docking with Mitsuba in the given directory: `golden_docking FOLDER [CASE]`.
//! Called by golden/docking/make.py, which keeps the reason; existing images are replaced.
#![allow(clippy::unwrap_used, reason = "a tool of the developers: it stops at the first thing that is wrong")]

#[path = "../../../tests/it/golden_docking/cases.rs"]
mod docking_cases;

use std::path::PathBuf;

use boresight::files::write_radiance;
use boresight::mitsuba::{MitsubaError, MitsubaOptions, MitsubaRenderer};
use sim::mitsuba::Settings;

fn main() -> Result<(), MitsubaError> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().expect("usage: golden_docking FOLDER"));
    let only = arguments.next();
    let (cases, target) = docking_cases::load();
    target.check().map_err(sim::SimError::from)?;
    let scene = target.scene();
    for case in &cases.case {
        if only.as_ref().is_some_and(|only| *only != case.name) {
            continue;
        }
        let settings = Settings { samples: cases.samples, crop: Some(case.crop(&cases)) };
        let renderer = MitsubaRenderer::new(MitsubaOptions { settings, ..MitsubaOptions::default() })?;
        let image = renderer.radiance(&scene, &case.lighting(&cases), &case.pose(), &case.camera(&cases))?;
        let path = folder.join(&case.name).with_extension("exr");
        // The writers refuse to replace a file, but replacing files is the purpose of this program.
        let _ = std::fs::remove_file(&path);
        write_radiance(&path, &image)?;
        println!("{}: {} x {} px", case.name, image.columns, image.rows);
    }
    Ok(())
}
