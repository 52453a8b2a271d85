//! Files common to a docking run and a rendered dataset: images, telemetry and truth.

use contract::docking::{DockingSetup, Field, FieldTelemetry};
use files::{Failure, FileError, ImageFormat, RunDirectory, TableWriter};
use run::world::Dataset;
use scenario::run_file::RunFile;
use sim::docking::FieldTruth;

use super::DockingMission;
use crate::rows::{FieldRow, FieldTelemetryLine, FieldTelemetryWriter, FieldTruthRow, SetupFile};
use crate::scenario::DockingScenario;
use crate::video::{AviCoding, AviWriter, Y4mWriter, write_field};

/// Quality of Motion-JPEG, whose error is below the noise of a field.
const JPEG_QUALITY: u8 = 95;

/// Format in which the images of fields are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldImages {
    /// One grey PNG per field.
    Png,
    /// One uncompressed AVI of complete frames, two fields each.
    Avi,
    /// One Motion-JPEG AVI of complete frames, two fields each: a tenth of the size, with small losses.
    MotionJpeg,
    /// One Y4M of complete frames, two fields each.
    Y4m,
}

impl FieldImages {
    /// Maximum number of fields in one file, for images of this size; `None` if there is no limit.
    pub fn max_fields(self, setup: &DockingSetup) -> Option<u64> {
        let camera = setup.cameras.first()?;
        let frames = AviCoding::Grey.max_frames((camera.columns, camera.rows))?;
        (self == Self::Avi).then_some(2 * frames)
    }

    /// Path of the images in a run directory.
    pub fn file_pattern(self) -> &'static str {
        match self {
            Self::Png => "frames/",
            Self::Avi | Self::MotionJpeg => "fields.avi",
            Self::Y4m => "fields.y4m",
        }
    }
}

impl std::str::FromStr for FieldImages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "png" => Ok(Self::Png),
            "avi" => Ok(Self::Avi),
            "mjpeg" => Ok(Self::MotionJpeg),
            "y4m" => Ok(Self::Y4m),
            _ => Err(format!("`{text}` is not a format of docking fields; expected png, avi, mjpeg or y4m")),
        }
    }
}

/// A video file.
enum Video {
    Avi(Box<AviWriter>),
    Y4m(Box<Y4mWriter>),
}

impl Video {
    /// Creates the video file of a run directory; `None` if images are stored separately, or not at all.
    fn create(
        directory: &RunDirectory,
        images: Option<FieldImages>,
        setup: &DockingSetup,
        rate_hz: f64,
    ) -> Result<Option<Self>, FileError> {
        let Some((images, camera)) = images.zip(setup.cameras.first()) else { return Ok(None) };
        let (path, size) = (directory.path().join(images.file_pattern()), (camera.columns, camera.rows));
        let avi =
            |coding| AviWriter::create(&path, coding, size, rate_hz).map(|avi| Self::Avi(Box::new(avi)));
        match images {
            FieldImages::Png => return Ok(None),
            FieldImages::Avi => avi(AviCoding::Grey),
            FieldImages::MotionJpeg => avi(AviCoding::MotionJpeg { quality: JPEG_QUALITY }),
            FieldImages::Y4m => Y4mWriter::create(&path, size, rate_hz).map(|y4m| {
                let y4m = y4m.with_pixel_size(camera.pixel_width_um, camera.pixel_height_um);
                Self::Y4m(Box::new(y4m))
            }),
        }
        .map(Some)
    }

    fn write(&mut self, field: &Field) -> Result<(), FileError> {
        match self {
            Self::Avi(avi) => avi.write(field),
            Self::Y4m(y4m) => y4m.write(field),
        }
    }

    fn finish(self) -> Result<(), FileError> {
        match self {
            Self::Avi(avi) => avi.finish(),
            Self::Y4m(y4m) => y4m.finish(),
        }
    }
}

/// Files common to a run and a rendered dataset: all except outcomes and score.
pub struct FieldDataset<'a> {
    directory: &'a RunDirectory,
    telemetry: FieldTelemetryWriter,
    truth: TableWriter<FieldTruthRow>,
    is_png: bool,
    video: Option<Video>,
}

impl<'a> FieldDataset<'a> {
    pub(crate) fn create(
        run_file: &RunFile<DockingScenario>,
        setup: &DockingSetup,
        directory: &'a RunDirectory,
        images: Option<FieldImages>,
    ) -> Result<Self, Failure> {
        run_file.write(&directory.run())?;
        let scenario = &run_file.scenario;
        SetupFile::new(setup, &scenario.docking).write(&directory.setup())?;
        Ok(Self {
            directory,
            telemetry: FieldTelemetryWriter::create(&directory.telemetry())?,
            truth: TableWriter::create(&directory.truth_fields())?,
            is_png: images == Some(FieldImages::Png),
            video: Video::create(directory, images, setup, scenario.television.frame_rate_hz)?,
        })
    }
}

impl Dataset<DockingMission> for FieldDataset<'_> {
    fn add(&mut self, field: &Field, telemetry: FieldTelemetry, truth: FieldTruth) -> Result<(), FileError> {
        let number = field.number();
        let is_png = self.is_png;
        if is_png {
            write_field(&self.directory.frame(number, ImageFormat::Png), field)?;
        }
        if let Some(video) = &mut self.video {
            video.write(field)?;
        }
        self.telemetry.line(&FieldTelemetryLine::from_row(&FieldRow {
            field: number,
            file: is_png.then(|| RunDirectory::frame_name(number, ImageFormat::Png)),
            lines: field.lines(),
            telemetry,
        }))?;
        self.truth.write([FieldTruthRow::from(&truth)])
    }

    fn finish(self) -> Result<(), FileError> {
        self.truth.finish()?;
        self.video.map_or(Ok(()), Video::finish)?;
        self.telemetry.finish()
    }
}
