//! One frame in one function: truth → scene → optics → sensor → on board.

use contract::{Frame, OutOfRange, Telemetry};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use optics::Stamp;
use render::draw::ExpectedImage;
use scene::{CameraMotion, planets};
use sensor::onboard::downlink_in;
use sensor::{CosmicRayHit, ExposureInterval, FrameCharge};
use truth::{FrameTruth, ObjectKind, ObjectTruth, SimError, Switch, Visibility, clock, shadow};

use crate::Simulator;
use crate::foreground::ForegroundBodies;
use crate::frame_readout::{FrameReadout, PixelSelection};
use crate::object_descriptions::ObjectDescriptions;
use crate::scene_painter::{MOON_POINTS, ScenePainter};
use crate::scene_state::SceneState;
use crate::scene_view::SceneView;

/// Fraction of the Moon's flux below which the shutter control omits a pixel: a hundredth of the flux of a
/// pixel in a disk of 1150 px.
const MOON_FLOOR: f64 = 1e-8;

/// Frame with its telemetry and its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposure {
    /// Image as received on the ground.
    pub frame: Frame,
    /// Telemetry of the frame.
    pub telemetry: Telemetry,
    /// Truth of the frame.
    pub truth: FrameTruth,
    /// Truth of every object in the frame: the target, then stars, planets, the Moon, hot pixels and
    /// cosmic-ray hits, each by number.
    pub objects: Vec<ObjectTruth>,
}

/// Camera of a [`Simulator`], with the buffers that frames reuse; one per thread.
#[derive(Debug)]
pub struct SimulatedCamera<'a> {
    simulator: &'a Simulator,
    painter: ScenePainter,
    image: ExpectedImage,
    readout: FrameReadout,
    descriptions: ObjectDescriptions,
    /// Frame that is no longer needed, for reuse.
    spare: Option<Frame>,
}

impl Simulator {
    /// Creates a camera of this simulation: one per thread, reused from frame to frame.
    ///
    /// # Errors
    /// None after [`Simulator::new`], which made the same checks.
    pub fn camera(&self) -> Result<SimulatedCamera<'_>, SimError> {
        SimulatedCamera::new(self)
    }
}

impl<'a> SimulatedCamera<'a> {
    pub(crate) fn new(simulator: &'a Simulator) -> Result<Self, SimError> {
        Ok(Self {
            simulator,
            painter: ScenePainter::new(simulator.psf.clone()),
            image: simulator.sensor.new_expected(),
            readout: FrameReadout::new(simulator)?,
            descriptions: ObjectDescriptions::new(),
            spare: None,
        })
    }

    /// Returns this camera with another selection of drawn pixels, for frames of which it keeps regions.
    pub fn with_pixel_selection(mut self, pixel_selection: PixelSelection) -> Self {
        self.readout.pixel_selection = pixel_selection;
        self
    }

    /// Provides the memory of a frame that is no longer needed for the next frame. The result is
    /// bit-identical, and the time for fresh memory is saved.
    pub fn reuse(&mut self, frame: Frame) {
        self.spare = Some(frame);
    }

    /// Makes frame number `number`. The result is bit-identical whichever frames were made before.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the schedule has no such frame.
    pub fn expose(&mut self, number: u64) -> Result<Exposure, SimError> {
        let simulator = self.simulator;

        // Truth: the time of the frame, and the exposure time that the shutter control chooses with the state
        // before it. A control without lag uses the state at the time of the frame.
        let (group, time) = simulator
            .schedule
            .frame(number)
            .ok_or_else(|| OutOfRange::new("frame", number, "a frame of the schedule"))?;
        let lag_s = simulator.shutter.lag_s();
        let watched = SceneState::compute_at(simulator, time - lag_s * Unit::Second, number)?;
        let exposure_s = self.exposure_s(&watched, time - lag_s * Unit::Second);
        let state = if lag_s == 0.0 { watched } else { SceneState::compute_at(simulator, time, number)? };

        // Scene: all sources and the background in front of the camera during the exposure.
        let (mut view, drawn) =
            SceneView::for_frame(simulator, self.painter.psf(), time, state, exposure_s, number)?;

        // Optics: the expected photoelectrons of every pixel.
        self.image.clear(simulator.sensor.sky_electrons(exposure_s));
        self.painter.add_background(&view, &drawn, exposure_s, &mut self.image);
        self.painter.add_sources(simulator, &mut view, &drawn, exposure_s, &mut self.image);

        // Sensor: the charge of every pixel.
        let interval =
            ExposureInterval { seed: simulator.seed, middle_s: clock::tt_j2000_s(time), exposure_s };
        let hits = cosmic_ray_hits(simulator, &view, time, exposure_s, number);
        let mut charge = simulator.sensor.collect(&mut self.image, &interval);
        self.descriptions.add_hot_pixels(simulator, &interval, &mut view.sources);
        self.descriptions.add_hits(simulator, &hits, &mut charge, &mut view.sources);

        // On board: the digital numbers of the pixels that the camera keeps.
        let frame_charge = FrameCharge { charge: &charge, seed: simulator.seed, frame: number };
        let windows = self.readout.read_out(simulator, &frame_charge)?;

        // Ground truth, telemetry and the frame as received.
        let (sources, kept) = (&view.sources, windows.as_deref());
        let objects = self.descriptions.describe(simulator, number, sources, &hits, &charge, kept);
        let smear_e_per_px = charge.smear_e_per_px();
        let truth = frame_truth(&view, number, group, time, exposure_s, smear_e_per_px, &objects);
        let knowledge = &simulator.knowledge;
        let telemetry =
            knowledge.telemetry(&simulator.attitude, &simulator.trajectory, time, number, exposure_s);
        let frame = downlink_in(self.spare.take(), self.readout.raw(), number, windows)?;
        Ok(Exposure { frame, telemetry, truth, objects })
    }

    /// Noise-free expectation of the last frame made, electrons per pixel (including dark current and hot
    /// pixels), before saturation.
    pub fn expected(&self) -> &ExpectedImage {
        &self.image
    }

    /// Exposure time that the shutter control chooses. It follows the brightest object on the detector at an
    /// instant that precedes the exposure by a lag.
    fn exposure_s(&self, state: &SceneState, time: Epoch) -> f64 {
        let simulator = self.simulator;
        let (columns, rows) = simulator.projection.detector();
        let target = state.target_position.filter(|position| position.is_on_detector(columns, rows));
        // A body that spans pixels has a lower peak than a point source of equal flux.
        let peak_share = self.painter.psf().peak_share();
        let project = |point_m: &Vector3<f64>| state.project(point_m, &simulator.projection);
        let spread = state.appearance.peak_share(&project, peak_share) / peak_share;
        let screens = ForegroundBodies::from_state(simulator, state);
        let mut brightest = simulator.stars.brightest(
            &state.observer,
            state.camera_from_icrs,
            &simulator.projection,
            target.map_or(0.0, |_| state.target.electrons_per_s * spread),
            |astrometric| screens.hide(astrometric),
        );
        if simulator.solar_system == Switch::On {
            brightest = planets::brightest(
                clock::tdb_j2000_s(time),
                &state.observer,
                state.camera_from_icrs,
                &simulator.projection,
                &simulator.radiometry,
                brightest,
                |astrometric| screens.hide(astrometric),
            );
        }
        let peak = (brightest * peak_share).max(self.moon_peak_e_per_s(state));
        simulator.shutter.exposure_s((peak > 0.0).then_some(peak))
    }

    /// Electrons per second in the brightest pixel of the Moon, from its image without the camera's motion; 0
    /// if the Moon is not in the field.
    fn moon_peak_e_per_s(&self, state: &SceneState) -> f64 {
        let simulator = self.simulator;
        let Some(moon) = &state.moon else { return 0.0 };
        let still = CameraMotion::still(state.camera_from_icrs);
        let Some(source) = moon.source(&still, &simulator.projection, &simulator.radiometry, |_| 0.0) else {
            return 0.0;
        };
        let (mut points, mut stamp) = (Vec::new(), Stamp::new());
        moon.image(still.middle, &simulator.projection, MOON_POINTS, &mut points);
        let detector = simulator.projection.detector();
        self.painter.psf().clone().stamp_extended(&points, 1.0, MOON_FLOOR, detector, &mut stamp);
        stamp.truth(0.0, 0.0, f64::INFINITY).peak_electrons * source.electrons_per_s
    }
}

/// Returns the cosmic rays that strike the detector during an exposure.
fn cosmic_ray_hits(
    simulator: &Simulator,
    view: &SceneView,
    time: Epoch,
    exposure_s: f64,
    number: u64,
) -> Vec<CosmicRayHit> {
    let Some(rays) = &simulator.cosmic_rays else { return Vec::new() };
    let rate = rays.rate_per_cm2_s(time, &view.state.states.chaser.position_km);
    rays.hits(&simulator.seed, number, exposure_s, rate)
}

/// Returns the truth of a frame with these objects.
fn frame_truth(
    view: &SceneView,
    number: u64,
    group: &str,
    time: Epoch,
    exposure_s: f64,
    smear_e_per_px: f64,
    objects: &[ObjectTruth],
) -> FrameTruth {
    let state = &view.state;
    let target = objects.first().filter(|object| object.kind == ObjectKind::Target);
    FrameTruth {
        frame: number,
        group: group.to_owned(),
        time,
        exposure_s,
        body_from_icrs: state.body_from_icrs,
        camera_from_icrs: state.camera_from_icrs,
        position_km: state.states.chaser.position_km,
        velocity_km_s: state.states.chaser.velocity_km_s,
        line_of_sight: state.line_of_sight,
        range_km: state.states.range_km(),
        sun: state.observer.sun(),
        phase_deg: state.phase_rad.to_degrees(),
        shadow: shadow::classify(state.sunlit_fraction),
        sunlit_fraction: state.sunlit_fraction,
        background_e_per_s: view.background.as_ref().map_or(0.0, |field| field.mean_e_per_s()),
        smear_e_per_px,
        target_from_icrs: state.target_from_icrs,
        target_position: state.target_position,
        target_visibility: Visibility::from_snr(target.map_or(0.0, |target| target.snr)),
    }
}
