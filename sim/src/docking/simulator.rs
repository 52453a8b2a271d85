//! Docking simulation, checked and prepared, and the computation of a field.

use std::path::Path;

use config::{exact_toml, regular_file};
use contract::OutOfRange;
use contract::bounds::require;
use contract::docking::{Digitiser, DockingSetup, FieldTelemetry, Lines, TargetModel};
use draws::Seed;
use hifitime::{Duration, Epoch};
use optics::ImageBlur;
use render::vector::{Drawer, RadianceImage};
use scene::docking::{DockingScene, Lighting, TargetFile};
use sensor::television::{BIT_DEPTH, Caption, FieldLabel, Television, TelevisionConfig, VideoField};
use truth::SimError;
use truth::approach::{Approach, ApproachState};
use truth::clock::{format_utc, parse_utc_field};

use super::config::CameraConfig;
use super::geometry::{Eye, TargetGeometry};
use super::lighting::LightingConfig;
use super::truth::FieldTruth;
use super::{DockingSimulation, glint};

/// Maximum size of a target file, bytes.
const MAX_TARGET_BYTES: u64 = 4 << 20;
/// Maximum number of fields whose camera position is checked in advance. In longer approaches the checked
/// fields are evenly spaced, and the other fields are checked when they are made.
const MAX_CHECKED_FIELDS: usize = 100_000;
/// Maximum number of marks of a target: bits of a mask in the truth table.
const MAX_MARKS: usize = 64;

/// Docking simulation that was checked and prepared; shared by all threads.
#[derive(Debug, Clone)]
pub struct DockingSimulator {
    seed: Seed,
    start: Epoch,
    approach: Approach,
    pub(super) cameras: Vec<CameraConfig>,
    pub(super) eyes: Vec<Eye>,
    blur_sigma_px: f64,
    lighting: LightingConfig,
    television: TelevisionConfig,
    pub(super) model: TargetModel,
    pub(super) scene: DockingScene,
    pub(super) geometry: TargetGeometry,
    field_count: u64,
}

/// State of the scene at the time of a field: the input of the drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldState {
    /// Number of the field.
    pub field: u64,
    /// Time of the field, s since the beginning.
    pub time_s: f64,
    /// Time of the field.
    pub time: Epoch,
    /// Camera rows that the field holds.
    pub lines: Lines,
    /// Index of the camera that takes the field, 0-based.
    pub camera: usize,
    /// Pose and rates.
    pub state: ApproachState,
    /// Lighting of the scene.
    pub lighting: Lighting,
}

/// Field with its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldExposure {
    /// Video signal.
    pub video: VideoField,
    /// Truth of the field.
    pub truth: FieldTruth,
}

impl FieldExposure {
    /// Telemetry of the field for a pipeline, if the field is digitised with these settings.
    pub fn telemetry(&self, digitiser: Digitiser) -> FieldTelemetry {
        FieldTelemetry { time_s: self.truth.time_s, camera: self.truth.camera, digitiser }
    }
}

/// Buffers that fields reuse, one workspace per thread.
#[derive(Debug, Clone)]
pub struct DockingWorkspace {
    drawers: Vec<Drawer>,
    radiance: RadianceImage,
    blur: ImageBlur,
    television: Television,
}

impl DockingWorkspace {
    /// Radiance of the last drawn field: every row of the camera, before the lens's blur and without glints.
    pub fn radiance(&self) -> &RadianceImage {
        &self.radiance
    }
}

impl DockingSimulator {
    /// Checks and prepares a simulation; the target's path is relative to `folder`.
    ///
    /// # Errors
    /// [`SimError`] for the first invalid value, or a target file that cannot be used.
    pub fn new(simulation: &DockingSimulation, folder: &Path) -> Result<Self, SimError> {
        simulation.check()?;
        let target = target_file(&simulation.target, folder)?;
        target.check().map_err(|error| SimError::TargetFile {
            target: simulation.target.clone(),
            problem: error.to_string(),
        })?;
        let (model, mut scene) = (target.model(), target.scene());
        if model.marks.len() > MAX_MARKS {
            return Err(SimError::TargetFile {
                target: simulation.target.clone(),
                problem: format!("it has {} marks, expected at most {MAX_MARKS}", model.marks.len()),
            });
        }
        // Appended in front of all other parts: shades are nearer to the Sun than the shaded parts, and
        // invisible to cameras.
        scene.parts.extend(simulation.lighting.shade_parts()?);
        let approach = Approach::new(&simulation.approach, target.contact.camera_to_disk_m)?;
        let fields = (approach.duration_s() * simulation.television.field_rate_hz() + 1e-6).floor();
        require("television.frame_rate_hz (fields)", fields, "at most 1e8", |n| n <= 1e8)?;
        let eyes = simulation
            .cameras
            .iter()
            .map(|camera| Eye::new(&camera.camera))
            .collect::<Result<Vec<_>, SimError>>()?;
        let simulator = Self {
            seed: Seed { seed: simulation.seed, case: 0 },
            start: parse_utc_field("start_utc", &simulation.start_utc)?,
            approach,
            cameras: simulation.cameras.clone(),
            eyes,
            blur_sigma_px: simulation.lens.blur_sigma_px,
            lighting: simulation.lighting.clone(),
            television: simulation.television.clone(),
            geometry: TargetGeometry::new(&model, &scene),
            model,
            scene,
            field_count: fields as u64 + 1,
        };
        let last = simulator.field_count - 1;
        let step = (simulator.field_count / MAX_CHECKED_FIELDS as u64) as usize + 1;
        (0..last).step_by(step).chain([last]).try_for_each(|field| simulator.state(field).map(drop))?;
        Ok(simulator)
    }

    /// Returns the seconds since the beginning, the pose and the rates of a field.
    ///
    /// # Errors
    /// [`OutOfRange`] for a camera inside the target.
    fn state(&self, field: u64) -> Result<(f64, ApproachState), OutOfRange> {
        let time_s = field as f64 / self.television.field_rate_hz();
        let state = self.approach.state_at(time_s);
        let place_m = &state.pose.position_m;
        if self.geometry.is_unobstructed(place_m) {
            return Ok((time_s, state));
        }
        let value = format!("({:.3}, {:.3}, {:.3}) m at field {field}", place_m.x, place_m.y, place_m.z);
        Err(OutOfRange::new("approach", value, "a camera in front of the target and of all parts around it"))
    }

    /// Number of fields from the beginning to the end of the approach.
    pub fn field_count(&self) -> u64 {
        self.field_count
    }

    /// Field rate, Hz.
    pub fn field_rate_hz(&self) -> f64 {
        self.television.field_rate_hz()
    }

    /// Drawn scene, including shades.
    pub fn scene(&self) -> &DockingScene {
        &self.scene
    }

    /// Setup that a pipeline receives before the first field.
    pub fn setup(&self) -> DockingSetup {
        DockingSetup {
            cameras: self.cameras.iter().map(|camera| camera.camera.clone()).collect(),
            bit_depth: BIT_DEPTH,
            target: self.model.clone(),
        }
    }

    /// Creates the buffers of a thread.
    ///
    /// # Errors
    /// None after [`DockingSimulator::new`], which made the same checks.
    pub fn workspace(&self) -> Result<DockingWorkspace, SimError> {
        let drawers =
            self.cameras.iter().map(|camera| Drawer::new(&camera.camera)).collect::<Result<Vec<_>, _>>()?;
        let (columns, rows) =
            self.cameras.first().map_or((0, 0), |camera| (camera.camera.columns, camera.camera.rows));
        Ok(DockingWorkspace {
            drawers,
            radiance: RadianceImage { columns, rows, radiance: vec![0.0; columns * rows] },
            blur: ImageBlur::new(self.blur_sigma_px),
            television: Television::new(&self.television, self.seed, columns, rows),
        })
    }

    /// State of the scene at the time of a field.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the field does not exist.
    pub fn field_state(&self, field: u64) -> Result<FieldState, SimError> {
        if field >= self.field_count {
            return Err(OutOfRange::new("field", field, "a field of the approach").into());
        }
        let (time_s, state) = self.state(field)?;
        let range_m = state.range_m();
        // The last camera is in use down to a range of 0.
        let camera = self.cameras.iter().position(|camera| range_m >= camera.until_range_m).unwrap_or(0);
        Ok(FieldState {
            field,
            time_s,
            // Rounded to integer nanoseconds, because hifitime's product truncates them.
            time: self.start + Duration::from_total_nanoseconds((time_s * 1e9).round() as i128),
            lines: self.television.interlace.lines(field),
            camera,
            lighting: self.lighting.lighting_at(time_s, &state.pose),
            state,
        })
    }

    /// Draws a field and makes its video signal. The result is bit-identical whichever fields were made
    /// before.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the field does not exist.
    pub fn expose(&self, workspace: &mut DockingWorkspace, field: u64) -> Result<FieldExposure, SimError> {
        let field_state = self.field_state(field)?;
        workspace.drawers[field_state.camera].draw(
            &self.scene,
            &field_state.lighting,
            &field_state.state.pose,
            &mut workspace.radiance,
        );
        Ok(self.transmit(workspace, &field_state))
    }

    /// Makes the video signal of a field from an image drawn elsewhere from
    /// [`DockingSimulator::field_state`].
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the field does not exist; [`SimError::Contract`] if the image differs in
    /// size from the camera.
    pub fn expose_image(
        &self,
        workspace: &mut DockingWorkspace,
        field: u64,
        image: &RadianceImage,
    ) -> Result<FieldExposure, SimError> {
        let field_state = self.field_state(field)?;
        let (columns, rows) = (workspace.radiance.columns, workspace.radiance.rows);
        if (image.columns, image.rows, image.radiance.len()) != (columns, rows, columns * rows) {
            let got = image.radiance.len();
            return Err(contract::ContractError::ImageSize { columns, rows, got }.into());
        }
        workspace.radiance.radiance.copy_from_slice(&image.radiance);
        Ok(self.transmit(workspace, &field_state))
    }

    /// Makes the field and its truth from the radiance in the workspace.
    fn transmit(&self, workspace: &mut DockingWorkspace, field_state: &FieldState) -> FieldExposure {
        let (eye, pose) = (&self.eyes[field_state.camera], &field_state.state.pose);
        let sun = field_state.lighting.sun.map(|sun| sun.towards);
        let sun_image = sun.and_then(|sun| self.geometry.sun_image(eye, pose, &sun));
        let utc = format_utc(field_state.time);
        let (range_m, range_rate_m_s) = (field_state.state.range_m(), field_state.state.range_rate_m_s());
        let label = FieldLabel {
            number: field_state.field,
            time_s: field_state.time_s,
            lines: field_state.lines,
            sun: sun_image,
            caption: Caption {
                clock: utc.get(11..19).unwrap_or(""),
                camera: &self.cameras[field_state.camera].name,
                range_m,
                range_rate_m_s,
            },
        };
        let RadianceImage { columns, rows, radiance } = &workspace.radiance;
        let mut signal = Vec::new();
        workspace.blur.blur(radiance, *columns, field_state.lines, &mut signal);
        let glints = field_state
            .lighting
            .sun
            .map_or_else(Vec::new, |sun| eye.glints(&self.lighting.glints, &sun, pose));
        for image in &glints {
            glint::add(image, self.blur_sigma_px, &mut signal, *columns, field_state.lines);
        }
        let video_truth = workspace.television.transmit(&label, &mut signal);
        let (cross_centre, disk_centre, circle_radius_px) = self.geometry.centres(eye, pose);
        let truth = FieldTruth {
            field: field_state.field,
            time_s: field_state.time_s,
            time: field_state.time,
            lines: field_state.lines,
            camera: field_state.camera,
            pose: *pose,
            velocity_m_s: field_state.state.velocity_m_s,
            phi_rate_rad_s: field_state.state.phi_rate_rad_s,
            range_m,
            range_rate_m_s,
            passive_pitch_rad: field_state.state.passive_pitch_rad(),
            passive_yaw_rad: field_state.state.passive_yaw_rad(),
            sun,
            floodlight: field_state.lighting.floodlight.is_some(),
            cross_centre,
            disk_centre,
            circle_radius_px,
            marks_in_field: self.geometry.marks_in_field(eye, pose),
            marks_shadowed: self.geometry.marks_shadowed(&field_state.lighting),
            marks_dark: self.geometry.marks_dark(&field_state.lighting),
            marks_hidden: self.geometry.marks_hidden(pose),
            plate_lit: self.geometry.plate_lit(&field_state.lighting),
            cross_in_field: self.geometry.cross_in_field(eye, pose),
            target_in_field: self.geometry.target_in_field(eye, pose),
            sun_image: sun_image.map(|sun| sun.centre),
            sun_visible: sun_image.map_or(0.0, |sun| sun.visible),
            glints_shining: glints.iter().fold(0, |bits, glint| bits | 1 << glint.index),
            glint: glints.into_iter().max_by(|a, b| a.light.total_cmp(&b.light)),
            video: video_truth,
        };
        FieldExposure {
            video: VideoField::new(field_state.field, *columns, *rows, field_state.lines, signal)
                .expect("the blur keeps the rows of the field"),
            truth,
        }
    }
}

/// Reads a built-in target by its name, or the file at a path.
fn target_file(target: &str, folder: &Path) -> Result<TargetFile, SimError> {
    if let Some(built_in) = TargetFile::built_in(target) {
        return Ok(built_in);
    }
    let refused = |problem: String| SimError::TargetFile { target: target.to_owned(), problem };
    let text = regular_file::read_text(&folder.join(target), MAX_TARGET_BYTES).map_err(|error| {
        let names: Vec<_> = TargetFile::built_in_names().collect();
        refused(format!("{error}; built-in targets are {}", names.join(", ")))
    })?;
    exact_toml::from_str(&text).map_err(|error| refused(error.to_string()))
}

#[cfg(test)]
mod tests;
