//! Folders of bias, dark and flat frames: which frames belong together.

use std::path::{Path, PathBuf};

use files::{Failure, FileError, PixelConversion, read_grey_image, read_image};
use sensor_fit::{FrameStack, SensorFrames};

use super::images::{has_extension, images};
use super::sensor::SensorArguments;
use crate::command::output::Output;

/// Largest number of pixels of all frames: 2 bytes each are held in memory.
const MAX_PIXELS: usize = 1_500_000_000;

/// Relative difference of exposure times that count as one: headers and names are rounded.
const SAME_TIME: f64 = 1e-3;

/// Form of the name of a folder, in messages.
const FOLDER_NAME: &str = "the exposure time in seconds, such as 0.5s or 20ms, for flats also with the relative light, \
                           such as 0.5s_x0.25";

/// A frame as read.
struct ReadFrame {
    path: PathBuf,
    size: [usize; 2],
    dn: Vec<u16>,
    bits: u8,
    /// Exposure time of its header, s.
    exposure_s: Option<f64>,
}

/// Reader of all frames: the first frame sets the size.
struct FrameReader<'a> {
    output: &'a Output,
    first: Option<(PathBuf, [usize; 2])>,
    bits: u8,
    pixels: usize,
}

/// Reads the frames of all folders.
pub(super) fn read_stacks(arguments: &SensorArguments, output: &Output) -> Result<SensorFrames, Failure> {
    let mut reader = FrameReader { output, first: None, bits: 8, pixels: 0 };
    let bias = arguments.bias.as_deref().map(|folder| reader.bias(folder)).transpose()?;
    let darks = arguments.dark.as_deref().map(|folder| reader.levels(folder, false)).transpose()?;
    let flats = arguments.flat.as_deref().map(|folder| reader.levels(folder, true)).transpose()?;
    let [columns, rows] = reader.first.as_ref().map_or([0, 0], |(_, size)| *size);
    Ok(SensorFrames {
        columns,
        rows,
        stored_bits: reader.bits,
        bias,
        darks: darks.unwrap_or_default(),
        flats: flats.unwrap_or_default(),
    })
}

impl FrameReader<'_> {
    /// Reads the frames of the shortest exposure.
    fn bias(&mut self, folder: &Path) -> Result<FrameStack, Failure> {
        let frames = self.frames(&images(folder)?)?;
        let time_s = frames.first().and_then(|frame| frame.exposure_s);
        for frame in &frames {
            if !is_same_time(frame.exposure_s.unwrap_or(0.0), time_s.unwrap_or(0.0)) {
                return Err(mixed_times(frame, time_s.unwrap_or(0.0), "that of the first bias frame"));
            }
        }
        Ok(stack(folder, time_s.unwrap_or(0.0), 0.0, frames))
    }

    /// Reads the frames of several levels: folders named by their times, or FITS with times in their headers.
    fn levels(&mut self, folder: &Path, is_flat: bool) -> Result<Vec<FrameStack>, Failure> {
        let folders = subfolders(folder)?;
        let mut stacks = if folders.is_empty() {
            self.levels_by_header(folder, is_flat)?
        } else {
            refuse_loose_images(folder, &folders)?;
            let read = folders.iter().map(|level| self.level_of_folder(level, is_flat));
            read.collect::<Result<Vec<_>, _>>()?
        };
        stacks.sort_by(|a, b| {
            (a.light * a.time_s, a.time_s)
                .partial_cmp(&(b.light * b.time_s, b.time_s))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        for pair in stacks.windows(2) {
            if let [a, b] = pair
                && is_same_time(a.time_s, b.time_s)
                && a.light == b.light
            {
                return Err(Failure::Usage(format!(
                    "{} and {}: the same exposure time of {} s, expected one folder per level",
                    a.name, b.name, a.time_s
                )));
            }
        }
        Ok(stacks)
    }

    /// Reads a folder that is named by its exposure time.
    fn level_of_folder(&mut self, folder: &Path, is_flat: bool) -> Result<FrameStack, Failure> {
        let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let parsed = time_and_light(&name)
            .filter(|(time_s, light)| if is_flat { *time_s > 0.0 } else { light.is_none() });
        let Some((time_s, light)) = parsed else {
            return Err(Failure::Usage(format!(
                "{}: the name of the folder is `{name}`, expected {FOLDER_NAME}",
                folder.display()
            )));
        };
        let frames = self.frames(&images(folder)?)?;
        for frame in &frames {
            if frame.exposure_s.is_some_and(|header_s| !is_same_time(header_s, time_s)) {
                return Err(mixed_times(frame, time_s, "that of the folder's name"));
            }
        }
        let light = if is_flat { light.unwrap_or(1.0) } else { 0.0 };
        Ok(stack(folder, time_s, light, frames))
    }

    /// Reads FITS of one folder, a stack per exposure time of their headers.
    fn levels_by_header(&mut self, folder: &Path, is_flat: bool) -> Result<Vec<FrameStack>, Failure> {
        let mut levels: Vec<(f64, Vec<ReadFrame>)> = Vec::new();
        for frame in self.frames(&images(folder)?)? {
            let Some(time_s) =
                frame.exposure_s.filter(|time_s| *time_s >= 0.0 && (!is_flat || *time_s > 0.0))
            else {
                return Err(Failure::Usage(format!(
                    "{}: no exposure time, expected a FITS header with EXPTIME or EXPOSURE, or a folder named by \
                     {FOLDER_NAME}",
                    frame.path.display()
                )));
            };
            match levels.iter_mut().find(|(level_s, _)| is_same_time(*level_s, time_s)) {
                Some((_, frames)) => frames.push(frame),
                None => levels.push((time_s, vec![frame])),
            }
        }
        let light = if is_flat { 1.0 } else { 0.0 };
        let named = |(time_s, frames)| {
            let mut stack = stack(folder, time_s, light, frames);
            stack.name = format!("{} ({time_s} s)", stack.name);
            stack
        };
        Ok(levels.into_iter().map(named).collect())
    }

    /// Reads frames, all of the size of the first.
    fn frames(&mut self, paths: &[PathBuf]) -> Result<Vec<ReadFrame>, Failure> {
        let progress = self.output.progress_of(paths.len() as u64, "images", "reading");
        let mut frames = Vec::with_capacity(paths.len());
        for path in paths {
            let frame = read_frame(path)?;
            let (first, size) = self.first.get_or_insert_with(|| (path.clone(), frame.size));
            if frame.size != *size {
                let ([columns, rows], [first_columns, first_rows]) = (frame.size, *size);
                return Err(Failure::Usage(format!(
                    "{}: is {columns} × {rows} pixels, expected {first_columns} × {first_rows} as {}: a sensor has \
                     one size",
                    path.display(),
                    first.display()
                )));
            }
            self.bits = self.bits.max(frame.bits);
            self.pixels += frame.dn.len();
            if self.pixels > MAX_PIXELS {
                return Err(Failure::Usage(format!(
                    "{}: the frames up to this one have {} pixels, expected at most {MAX_PIXELS}: use fewer frames",
                    path.display(),
                    self.pixels
                )));
            }
            frames.push(frame);
            progress.inc(1);
        }
        progress.finish_and_clear();
        Ok(frames)
    }
}

fn is_same_time(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() <= SAME_TIME * a_s.abs().max(b_s.abs())
}

fn mixed_times(frame: &ReadFrame, expected_s: f64, origin: &str) -> Failure {
    Failure::Usage(format!(
        "{}: its header has an exposure time of {} s, expected {expected_s} s, {origin}: a stack has one exposure \
         time",
        frame.path.display(),
        frame.exposure_s.unwrap_or(0.0)
    ))
}

fn stack(folder: &Path, time_s: f64, light: f64, frames: Vec<ReadFrame>) -> FrameStack {
    let names = frames.iter().map(|frame| frame.path.display().to_string()).collect();
    let frames = frames.into_iter().map(|frame| frame.dn).collect();
    FrameStack { name: folder.display().to_string(), time_s, light, names, frames }
}

/// Reads a grey image of whole digital numbers.
fn read_frame(path: &Path) -> Result<ReadFrame, Failure> {
    let refused = |found: &str| {
        Failure::Usage(format!(
            "{}: {found}, expected grey FITS, PNG, TIFF or OpenEXR with the numbers of the converter",
            path.display()
        ))
    };
    if has_extension(path, &["jpg", "jpeg"]) {
        return Err(refused("JPEG, whose compression changes the noise"));
    }
    if has_extension(path, &["fits", "fit", "fts", "exr"]) {
        let raw = read_image(path, None)?;
        let bits = raw.bit_depth.or(raw.stored_bits).unwrap_or(16);
        let exposure_s = raw.metadata.exposure_s.map(|(_, exposure_s)| exposure_s);
        let size = [raw.columns, raw.rows];
        return Ok(ReadFrame { path: path.to_owned(), size, dn: raw.dn, bits, exposure_s });
    }
    let image = read_grey_image(path)?;
    if image.conversion == PixelConversion::MeanOfColours {
        return Err(refused("a colour image, whose pixels are mixed"));
    }
    let dn: Vec<u16> = image.values.iter().map(|value| *value as u16).collect();
    if dn.iter().zip(&image.values).any(|(dn, value)| f32::from(*dn) != *value) {
        return Err(refused("values that are not whole numbers of 16 bits"));
    }
    let bits = if image.full_scale <= 255.0 { 8 } else { 16 };
    Ok(ReadFrame { path: path.to_owned(), size: [image.columns, image.rows], dn, bits, exposure_s: None })
}

/// Returns the folders in a folder, in order of their names.
fn subfolders(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let opened = std::fs::read_dir(folder);
    let entries =
        opened.map_err(|source| FileError::Io { path: folder.to_owned(), doing: "open", source })?;
    let mut folders = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| FileError::io(folder, "read", source))?;
        if entry.path().is_dir() && !entry.file_name().to_string_lossy().starts_with('.') {
            folders.push(entry.path());
        }
    }
    folders.sort();
    Ok(folders)
}

/// Refuses images beside folders: their exposure is ambiguous.
fn refuse_loose_images(folder: &Path, folders: &[PathBuf]) -> Result<(), Failure> {
    match (images(folder), folders.first()) {
        (Ok(paths), Some(beside)) => {
            let loose = paths.first().map_or_else(String::new, |path| path.display().to_string());
            Err(Failure::Usage(format!(
                "{loose}: an image beside the folder {}, expected it in a folder named by {FOLDER_NAME}",
                beside.display()
            )))
        }
        _ => Ok(()),
    }
}

/// Parses the name of a folder: exposure time, s, and relative light.
fn time_and_light(name: &str) -> Option<(f64, Option<f64>)> {
    let (time, light) = match name.split_once("_x") {
        Some((time, light)) => (time, Some(light.parse::<f64>().ok()?)),
        None => (name, None),
    };
    let time_s = match time.strip_suffix("ms") {
        Some(number) => number.trim().parse::<f64>().ok()? / 1000.0,
        None => time.strip_suffix('s')?.trim().parse::<f64>().ok()?,
    };
    let is_valid = (0.0..=1e5).contains(&time_s) && light.is_none_or(|light| light > 0.0 && light <= 1e9);
    is_valid.then_some((time_s, light))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_folders_have_time_and_light() {
        for (name, expected) in [
            ("0.5s", Some((0.5, None))),
            ("20ms", Some((0.02, None))),
            ("1e-3s_x0.25", Some((0.001, Some(0.25)))),
            ("0s", Some((0.0, None))),
        ] {
            assert_eq!(time_and_light(name), expected, "{name}");
        }
        for name in ["0.5", "half", "-1s", "1s_x0", "1s_x", "s", "nans", "infs", "1s_xnan"] {
            assert_eq!(time_and_light(name), None, "{name}");
        }
    }
}
