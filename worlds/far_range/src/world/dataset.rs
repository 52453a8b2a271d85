//! Files common to a run and a rendered dataset: all except measurements and score.

use std::path::Path;

use contract::{Camera, CameraFrame, Direction, Frame, Telemetry};
use files::{
    Failure, FileError, FrameHeader, ImageFormat, RunDirectory, TableWriter, TanSip, format_utc, write_frame,
};
use hifitime::Epoch;
use run::world::Dataset;
use scenario::run_file::RunFile;
use sim::truth::{FrameTruth, ManoeuvreTruth, Observer};
use sim::{Exposure, Simulator};

use super::{FarRangeMission, SceneTruth};
use crate::rows::{
    CameraFile, FrameTruthRow, ObjectTruthRow, StarRow, TelemetryLine, TelemetryRow, TelemetryWriter,
    write_manoeuvres, write_stars,
};
use crate::scenario::FarRangeScenario;

/// Writes `run.toml`, `camera.toml`, `stars.csv`, `truth/manoeuvres.csv`, then frame by frame `telemetry.csv`
/// and the truth tables.
pub struct FrameDataset {
    telemetry: TelemetryWriter,
    frames: TableWriter<FrameTruthRow>,
    objects: TableWriter<ObjectTruthRow>,
    images: Option<ImageFormat>,
}

impl FrameDataset {
    /// Writes the files that do not depend on frames, and begins the tables.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub fn create(
        directory: &RunDirectory,
        run_file: &RunFile<FarRangeScenario>,
        stars: &[StarRow],
        star_epoch: Epoch,
        manoeuvres: &[ManoeuvreTruth],
        images: Option<ImageFormat>,
    ) -> Result<Self, Failure> {
        run_file.write(&directory.run())?;
        let scenario = &run_file.scenario;
        let camera = CameraFile {
            bit_depth: scenario.sensor.bit_depth,
            magnitude_limit: scenario.star_list.magnitude_limit,
            star_epoch_utc: Some(format_utc(star_epoch)),
            readout: Some(scenario.readout()),
            calibration: scenario.calibration(),
            zero_suppression_dn: scenario.zero_suppression_dn,
            camera: scenario.camera.clone(),
            mounting: scenario.mounting.nominal,
            far_range: scenario.far_range.clone(),
        };
        camera.write(&directory.camera())?;
        write_stars(&directory.stars(), stars)?;
        if !manoeuvres.is_empty() {
            write_manoeuvres(&directory.truth_manoeuvres(), manoeuvres)?;
        }
        Ok(Self {
            telemetry: TelemetryWriter::create(&directory.telemetry())?,
            frames: TableWriter::create(&directory.truth_frames())?,
            objects: TableWriter::create(&directory.truth_objects())?,
            images,
        })
    }
}

impl Dataset<FarRangeMission> for FrameDataset {
    /// Adds a frame to the tables. Its image is saved separately by [`save_image`], if images are kept.
    fn add(&mut self, frame: &Frame, telemetry: Telemetry, truth: SceneTruth) -> Result<(), FileError> {
        let number = frame.number();
        self.telemetry.line(&TelemetryLine::from(&TelemetryRow {
            frame: number,
            file: self.images.map(|format| RunDirectory::frame_name(number, format)),
            telemetry,
            windows: frame.windows().map(<[_]>::to_vec),
        }))?;
        self.frames.write([FrameTruthRow(truth.frame)])?;
        self.objects.write(truth.objects.into_iter().map(ObjectTruthRow))
    }

    fn finish(self) -> Result<(), FileError> {
        self.frames.finish()?;
        self.objects.finish()?;
        self.telemetry.finish()
    }
}

/// Saves the image of an exposure, as FITS with world coordinates derived from the truth, if SIP follows the
/// distortion of the camera.
///
/// # Errors
/// [`Failure`] when the file cannot be written, or no world coordinates can be fitted to the camera.
pub(crate) fn save_image(
    directory: &RunDirectory,
    format: ImageFormat,
    simulator: &Simulator,
    run_file: &RunFile<FarRangeScenario>,
    exposure: &Exposure,
) -> Result<(), Failure> {
    let path = directory.frame(exposure.frame.number(), format);
    write_image(&path, format, simulator, run_file, exposure)
}

/// Writes the image of an exposure to a file, as [`save_image`].
///
/// # Errors
/// Those of [`save_image`].
pub(crate) fn write_image(
    path: &Path,
    format: ImageFormat,
    simulator: &Simulator,
    run_file: &RunFile<FarRangeScenario>,
    exposure: &Exposure,
) -> Result<(), Failure> {
    let has_wcs = format == ImageFormat::Fits;
    let header = frame_header(simulator, run_file, exposure, has_wcs)?;
    write_frame(path, format, &exposure.frame, &header)?;
    Ok(())
}

/// Returns the metadata of an exposure, with world coordinates if they are requested and SIP follows the
/// distortion of the camera.
pub(super) fn frame_header(
    simulator: &Simulator,
    run_file: &RunFile<FarRangeScenario>,
    exposure: &Exposure,
    has_wcs: bool,
) -> Result<FrameHeader, Failure> {
    let truth = &exposure.truth;
    let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s)?;
    let wcs = if has_wcs {
        // Coordinates without the distortion are wrong by more than a hundred pixels at the corners.
        let wcs = world_coordinates(simulator, &run_file.scenario, truth, &observer)?;
        Some(wcs).filter(|wcs| wcs.sip.is_some())
    } else {
        None
    };
    Ok(FrameHeader {
        time: truth.time,
        exposure_s: truth.exposure_s,
        gain_e_per_dn: Some(run_file.scenario.sensor.gain_e_per_dn),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        configuration_hash: run_file.hash.clone(),
        observer_velocity_km_s: Some(observer.barycentric_velocity_km_s()),
        wcs,
    })
}

/// Returns the distance from the principal point, px, up to which SIP approximates a camera's distortion;
/// `None` if it covers the whole detector.
pub(super) fn sip_reach_px(simulator: &Simulator, camera: &Camera) -> Option<f64> {
    let principal = contract::PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
    let ahead = Direction::from_unit(*Direction::<CameraFrame>::z().vector());
    let reach_px = TanSip::reach_px(camera.columns, camera.rows, principal, ahead, |direction| {
        simulator.projection().project(&Direction::from_unit(*direction.vector()))
    });
    reach_px.ok().filter(|reach_px| reach_px.is_finite())
}

/// Fits the world coordinates of a frame, from astrometric directions (ICRS) to pixels, including aberration.
fn world_coordinates(
    simulator: &Simulator,
    scenario: &FarRangeScenario,
    truth: &FrameTruth,
    observer: &Observer,
) -> Result<TanSip, Failure> {
    let camera = &scenario.camera;
    let principal = contract::PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
    let boresight = truth.camera_from_icrs.inverse() * Direction::z();
    TanSip::fit(camera.columns, camera.rows, principal, boresight, |astrometric| {
        simulator
            .projection()
            .project(&(truth.camera_from_icrs * observer.apparent_from_astrometric(*astrometric)))
    })
    .map_err(|error| Failure::Usage(format!("frame {}: {error}", truth.frame)))
}
