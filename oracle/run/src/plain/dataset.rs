//! Files of a plain world besides the outcomes: setup, list of the images, truth.

use std::path::Path;
use std::str::FromStr;

use config::toml_file;
use contract::Frame;
use files::{
    AtomicFile, CsvReader, CsvWriter, Failure, FileError, ImageFormat, RunDirectory, TableWriter,
    locate_image, read_image, table,
};

use super::{Plain, PlainWorld};
use crate::world::{Dataset, OpenDataset};

/// Image format of plain worlds: grey PNG of 8 or 16 bits.
#[derive(Debug, Clone, Copy)]
pub struct PngImages;

impl PngImages {
    /// Name of the format.
    pub const WORD: &'static str = "png";
}

impl FromStr for PngImages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || format!("`{text}` is not a format of these images; expected {}", Self::WORD);
        if text == Self::WORD { Ok(Self) } else { Err(refused()) }
    }
}

table! {
    /// A row of `telemetry.csv`.
    struct ImageLine: csv {
        /// number of the frame; ascending
        frame: u64,
        /// path of the image below the directory; empty when none was saved
        file: String,
        /// bits of the converter
        bit_depth: u32,
    }
}

/// Writes the files common to a run and a rendered dataset.
pub struct PlainDataset<P: PlainWorld> {
    telemetry: CsvWriter<ImageLine>,
    truth: TableWriter<P::Truth>,
    has_images: bool,
}

impl<P: PlainWorld> PlainDataset<P> {
    /// Writes the files that do not depend on frames, and begins the tables.
    pub(super) fn create(
        world: &Plain<P>,
        directory: &RunDirectory,
        images: Option<PngImages>,
    ) -> Result<Self, Failure> {
        world.run_file.write(&directory.run())?;
        let setup = directory.path().join(P::SETUP_FILE);
        let text = toml::to_string(&world.setup).map_err(|error| FileError::format(&setup, "TOML", error))?;
        AtomicFile::with_text(&setup, &text)?.commit_new()?;
        Ok(Self {
            telemetry: CsvWriter::create(&directory.telemetry())?,
            truth: TableWriter::create(&directory.truth_frames())?,
            has_images: images.is_some(),
        })
    }
}

impl<P: PlainWorld> Dataset<Plain<P>> for PlainDataset<P> {
    fn add(&mut self, frame: &Frame, (): (), truth: P::Truth) -> Result<(), FileError> {
        let name = || RunDirectory::frame_name(frame.number(), ImageFormat::Png);
        self.telemetry.line(&ImageLine {
            frame: frame.number(),
            file: if self.has_images { name() } else { String::new() },
            bit_depth: u32::from(frame.bit_depth()),
        })?;
        self.truth.write([truth])
    }

    fn finish(self) -> Result<(), FileError> {
        self.truth.finish()?;
        self.telemetry.finish()
    }
}

/// Opens a dataset: the setup, and the images that `telemetry.csv` lists, in its order.
pub(super) fn open<P: PlainWorld>(directory: &Path) -> Result<OpenDataset<Plain<P>>, Failure> {
    let path = directory.join(P::SETUP_FILE);
    let text = toml_file::read_text(&path).map_err(|source| FileError::io(&path, "read", source))?;
    let setup: P::Setup = toml_file::parse(&path, &text)?;
    let table = directory.join("telemetry.csv");
    let root = directory.canonicalize().map_err(|source| FileError::io(directory, "open", source))?;
    let lines = CsvReader::open::<ImageLine>(&table)?.read_all(|row, previous: Option<&ImageLine>| {
        let line = <ImageLine as files::CsvLine>::read(row)?;
        row.check_ascends("frame", line.frame, previous.map(|previous| previous.frame))?;
        Ok(line)
    })?;
    let mut images = Vec::with_capacity(lines.len());
    for (line, ImageLine { frame, file, bit_depth }) in lines {
        let named = Some(file.as_str()).filter(|file| !file.is_empty());
        let path = locate_image(directory, &root, named).map_err(|reason| FileError::MissingImage {
            path: table.clone(),
            line,
            frame,
            file: file.clone(),
            reason,
        })?;
        images.push((frame, u8::try_from(bit_depth).unwrap_or(0), path));
    }
    let count = Some(images.len() as u64);
    let read = |(frame, bit_depth, path): (u64, u8, std::path::PathBuf)| {
        Ok((read_image(&path, None)?.into_frame(&path, frame, bit_depth, None)?, ()))
    };
    Ok(OpenDataset { setup, config: (), count, images: Box::new(images.into_iter().map(read)) })
}
