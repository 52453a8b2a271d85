//! Labels of a rendered sequence: written apart from the images, with the truth.

use files::{Failure, RunDirectory};
use labels::{LabelCounts, LabelFormats, LabelWriter};

use crate::frame_jobs::{FrameJobs, process_in_order};
use crate::world::World;

/// Writes the labels of frames to `truth/labels/`; `done` is called after each frame. Returns the numbers
/// of labels, and the paths of the tables below `directory`.
///
/// # Errors
/// A [`Failure`] when a file cannot be written, or the world has no labels.
pub(super) fn write_labels<W: World>(
    world: &W,
    directory: &RunDirectory,
    frame_jobs: &FrameJobs<W::Images>,
    formats: &LabelFormats,
    done: impl Fn(),
) -> Result<(LabelCounts, Vec<String>), Failure> {
    let set = world.label_set()?;
    set.check(formats)?;
    let mut writer = LabelWriter::create(&directory.truth_labels(), set, formats)?;
    let images = writer.images();
    let make = |(): &mut (), frame| {
        let labels = world.frame_labels(frame)?;
        images.write(&labels)?;
        Ok(labels)
    };
    let (frames, bytes) = (frame_jobs.frames.clone(), world.exposure_bytes() as u64);
    process_in_order(
        frames,
        frame_jobs.jobs,
        bytes,
        || Ok(()),
        make,
        |labels| {
            writer.add(&labels)?;
            done();
            Ok(())
        },
    )?;
    let counts = writer.counts();
    let tables = writer.finish()?;
    Ok((counts, tables.iter().map(|table| format!("truth/labels/{}", table.display())).collect()))
}
