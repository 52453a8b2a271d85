//! One frame in one function: truth → scene → optics → sensor → on board.

use contract::{Frame, OutOfRange, Telemetry, Window};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use optics::{ImagePoint, Stamp};
use render::draw::ExpectedImage;
use render::painter::Painter;
use scene::{CameraMotion, Source, planets};
use sensor::onboard::{RoiExtractor, downlink_in};
use sensor::{CosmicRayHit, ExposureInterval, FlatSamplers, FrameCharge, Sensor, SparseImage};
use truth::{FrameTruth, ObjectKind, ObjectTruth, SimError, Switch, Visibility, clock, shadow};

use crate::Simulator;
use crate::foreground::ForegroundBodies;
use crate::scene_state::SceneState;
use crate::scene_view::{FrameViews, SceneView};

/// Maximum number of points in the image of a source: those of its body multiplied by those of its trail.
const POINTS: usize = 1 << 18;
/// Maximum number of points in the image of the Moon: a disk of 1150 px has a point in every pixel.
const MOON_POINTS: usize = 1 << 20;
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

/// Selection of the drawn pixels in a frame of which a camera keeps only regions, or only values above a
/// floor. The kept pixels are bit-identical in both cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PixelSelection {
    /// Pixels that the camera examines: all above the threshold of its regions or its floor, and all in its
    /// regions.
    #[default]
    Needed,
    /// All pixels.
    All,
}

/// Camera of a [`Simulator`], with the buffers that frames reuse; one per thread.
#[derive(Debug)]
pub struct SimulatedCamera<'a> {
    simulator: &'a Simulator,
    painter: Painter,
    image: ExpectedImage,
    samplers: FlatSamplers,
    raw: SparseImage,
    pixel_selection: PixelSelection,
    regions: Option<RoiExtractor>,
    /// Background of an interlaced scene, electrons per second, pixel by pixel: of the first field, and of
    /// the second.
    backgrounds: [Vec<f64>; 2],
    /// Stamps of the hot pixels.
    hot: Vec<Stamp>,
    /// Stamp of a cosmic-ray hit: drawn when it strikes and again when it is described, because hits may be
    /// numerous.
    hit_stamp: Stamp,
    /// Image of an object in the scene of the first and of the second field.
    halves: [Stamp; 2],
    /// Image of an object whose wells overflow.
    bloomed: Stamp,
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
        let (columns, rows) = simulator.projection.detector();
        let regions = simulator.roi.as_ref().map(|roi| RoiExtractor::new(roi, columns, rows)).transpose()?;
        Ok(Self {
            simulator,
            painter: Painter::new(simulator.psf.clone()),
            image: simulator.sensor.new_expected(),
            samplers: FlatSamplers::new(),
            raw: simulator.sensor.new_sparse(),
            pixel_selection: PixelSelection::Needed,
            regions,
            backgrounds: [Vec::new(), Vec::new()],
            hot: Vec::new(),
            hit_stamp: Stamp::new(),
            halves: [Stamp::new(), Stamp::new()],
            bloomed: Stamp::new(),
            spare: None,
        })
    }

    /// Returns this camera with another selection of drawn pixels, for frames of which it keeps regions.
    pub fn with_pixel_selection(self, pixel_selection: PixelSelection) -> Self {
        Self { pixel_selection, ..self }
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
        let (group, time) = simulator
            .schedule
            .frame(number)
            .ok_or_else(|| OutOfRange::new("frame", number, "a frame of the schedule"))?;
        let lag_s = simulator.shutter.lag_s();
        let watched = SceneState::compute_at(simulator, time - lag_s * Unit::Second, number)?;
        let exposure_s = self.exposure_s(&watched, time - lag_s * Unit::Second);
        // A control without lag uses the state at the time of the frame.
        let state = if lag_s == 0.0 { watched } else { SceneState::compute_at(simulator, time, number)? };
        let (mut view, drawn) =
            SceneView::for_frame(simulator, self.painter.psf(), time, state, exposure_s, number)?;
        let interval =
            ExposureInterval { seed: simulator.seed, middle_s: clock::tt_j2000_s(time), exposure_s };
        let hits = simulator.cosmic_rays.as_ref().map_or_else(Vec::new, |rays| {
            let rate = rays.rate_per_cm2_s(time, &view.state.states.chaser.position_km);
            rays.hits(&simulator.seed, number, exposure_s, rate)
        });
        let FrameContents { objects, smear_e_per_px, windows } =
            self.draw(&mut view, &drawn, number, &interval, &hits)?;

        let state = view.state;
        let truth = FrameTruth {
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
            background_e_per_s: view.background.map_or(0.0, |field| field.mean_e_per_s()),
            smear_e_per_px,
            target_from_icrs: state.target_from_icrs,
            target_position: state.target_position,
            target_visibility: Visibility::from_snr(
                objects
                    .first()
                    .filter(|object| object.kind == ObjectKind::Target)
                    .map_or(0.0, |target| target.snr),
            ),
        };
        let telemetry = simulator.knowledge.telemetry(
            &simulator.attitude,
            &simulator.trajectory,
            time,
            number,
            exposure_s,
        );
        let frame = downlink_in(self.spare.take(), self.raw.raw(), number, windows)?;
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

    /// Draws the expected image and the digital numbers, and returns the truth of every object with signal on
    /// the detector.
    fn draw(
        &mut self,
        view: &mut SceneView,
        drawn: &FrameViews,
        number: u64,
        interval: &ExposureInterval,
        hits: &[CosmicRayHit],
    ) -> Result<FrameContents, SimError> {
        let Self { simulator, painter, image, backgrounds, hot, hit_stamp, halves, bloomed, .. } = self;
        let sensor = &simulator.sensor;
        let (columns, rows) = image.size();
        let hot_pixels = sensor.hot_pixels();
        hot.resize_with(hot_pixels.len(), Stamp::new);
        let draw_hit = |hit: &CosmicRayHit, stamp: &mut Stamp| {
            if let Some(rays) = &simulator.cosmic_rays {
                rays.stamp(hit, stamp);
                sensor.mask_dead_pixels(stamp);
            }
        };

        image.clear(sensor.sky_electrons(interval.exposure_s));
        let [background, later] = backgrounds;
        match drawn {
            FrameViews::Single => {
                if let Some(background) = &view.background {
                    image.set_smooth(background.smooth(), interval.exposure_s);
                }
            }
            FrameViews::Fields(interlace, fields) => {
                let [first, second] = &**fields;
                if first.background_e_per_s(background) && second.background_e_per_s(later) {
                    interlace.weave(background, later, columns);
                    image.set_field(Some(background), interval.exposure_s);
                }
            }
        }
        let mut paint = |view: &SceneView, index: usize, stamp: &mut Stamp| {
            let source = &view.sources[index];
            let transmission = simulator.vignetting.transmission(source.position);
            let electrons = source.electrons_per_s * interval.exposure_s * transmission;
            let resolve = |along: usize, body: &mut Vec<ImagePoint>| match (source.kind, &view.state.moon) {
                (ObjectKind::Target, _) => {
                    let project = |point_m: &Vector3<f64>| view.state.project(point_m, &simulator.projection);
                    view.state.appearance.image(&project, POINTS / along, body);
                }
                (ObjectKind::Moon, Some(moon)) => {
                    let limit = MOON_POINTS / along;
                    moon.image(view.state.camera_from_icrs, &simulator.projection, limit, body);
                }
                _ => body.push(ImagePoint { position: source.position, share: 1.0 }),
            };
            painter.paint(source, electrons, resolve, (columns, rows), stamp);
        };
        for index in 0..view.sources.len() {
            let drawn = image.add_painted(|stamp| match drawn {
                FrameViews::Single => paint(view, index, stamp),
                FrameViews::Fields(interlace, fields) => {
                    let [first, second] = &**fields;
                    paint(first, index, &mut halves[0]);
                    paint(second, index, &mut halves[1]);
                    stamp.weave(&halves[0], &halves[1], |row| interlace.is_first(row));
                }
            });
            view.sources[index].position = drawn.centre();
        }
        let sources = &mut view.sources;
        let mut charge = sensor.collect(image, interval);
        for (pixel, stamp) in hot_pixels.iter().zip(&mut *hot) {
            // The sensor itself collects these electrons; this stamp only describes them.
            stamp.set_pixel(pixel.x, pixel.y, sensor.hot_electrons(pixel, interval));
            sources.push(detector_source(ObjectKind::HotPixel, pixel.y * columns + pixel.x, stamp));
        }
        for (id, hit) in hits.iter().enumerate() {
            draw_hit(hit, hit_stamp);
            charge.add_cosmic_ray_hit(hit_stamp);
            sources.push(detector_source(ObjectKind::CosmicRay, id, hit_stamp));
        }

        let Self { samplers, raw, regions, pixel_selection, .. } = self;
        let frame_charge = FrameCharge { charge: &charge, seed: simulator.seed, frame: number };
        let windows = match regions {
            Some(regions) => {
                Some(extract_regions(sensor, &frame_charge, regions, *pixel_selection, samplers, raw)?)
            }
            None => {
                match simulator.zero_suppression_dn {
                    Some(floor_dn) => {
                        read_out_above(sensor, floor_dn, &frame_charge, *pixel_selection, samplers, raw)?;
                        raw.suppress(floor_dn);
                    }
                    None => sensor.read_out(&charge, &simulator.seed, number, samplers, raw.full_image())?,
                }
                None
            }
        };

        let readout_noise_e = sensor.readout_noise_e();
        let saturation_e = sensor.config().saturation_e();
        let mut objects = Vec::with_capacity(sources.len());
        let drawn = charge.expected().objects().iter().chain(&*hot);
        let drawn = drawn.map(Ok).chain(hits.iter().map(Err));
        for (source, stamp) in sources.iter().zip(drawn) {
            let stamp = stamp.unwrap_or_else(|hit| {
                draw_hit(hit, hit_stamp);
                &*hit_stamp
            });
            let pixel = |at: f64, size: usize| (at.round().max(0.0) as usize).min(size.saturating_sub(1));
            let (x, y) = (pixel(source.position.x, columns), pixel(source.position.y, rows));
            let background_e = charge.expected().background_near(x, y);
            let truth = stamp.truth(background_e, readout_noise_e, saturation_e);
            if truth.electrons <= 0.0 {
                continue;
            }
            let blooms = sensor.bloom_stamp(stamp, truth.peak_electrons, background_e, bloomed);
            let stamp = if blooms { &*bloomed } else { stamp };
            let bloom_px = if blooms {
                let noise_e = (background_e + readout_noise_e * readout_noise_e).sqrt();
                (bloomed.height_px(noise_e) - truth.radius_px).max(0.0)
            } else {
                0.0
            };
            objects.push(ObjectTruth {
                frame: number,
                kind: source.kind,
                id: source.id,
                position: source.position,
                astrometric: source.astrometric,
                magnitude: source.magnitude,
                electrons: truth.electrons,
                peak_electrons: truth.peak_electrons,
                snr: truth.snr,
                radius_px: truth.radius_px,
                bloom_px,
                cut: windows.as_ref().map_or(0.0, |windows| stamp.cut(windows)),
            });
        }
        Ok(FrameContents { objects, smear_e_per_px: charge.smear_e_per_px(), windows })
    }
}

/// Camera's result for a frame.
struct FrameContents {
    objects: Vec<ObjectTruth>,
    /// Electrons that the frame transfer adds to a pixel, averaged over all pixels.
    smear_e_per_px: f64,
    /// Regions that are kept; `None`: the whole image.
    windows: Option<Vec<Window>>,
}

/// Reads out the pixels of a frame that the camera examines, and finds the regions that it keeps.
fn extract_regions(
    sensor: &Sensor,
    frame_charge: &FrameCharge<'_>,
    regions: &mut RoiExtractor,
    selection: PixelSelection,
    samplers: &mut FlatSamplers,
    raw: &mut SparseImage,
) -> Result<Vec<Window>, SimError> {
    read_out_above(sensor, regions.threshold_dn(), frame_charge, selection, samplers, raw)?;
    let windows = regions.extract_from(raw.raw(), raw.runs());
    sensor.read_out_windows(&windows, frame_charge, samplers, raw);
    Ok(windows)
}

/// Reads out the pixels of a frame above a floor, or all pixels.
fn read_out_above(
    sensor: &Sensor,
    floor_dn: u16,
    frame_charge: &FrameCharge<'_>,
    selection: PixelSelection,
    samplers: &mut FlatSamplers,
    raw: &mut SparseImage,
) -> Result<(), SimError> {
    sensor.read_out_above(floor_dn, frame_charge, samplers, raw)?;
    if selection == PixelSelection::All {
        let (columns, rows) = raw.raw().size();
        sensor.read_out_windows(&[Window { x: 0, y: 0, columns, rows }], frame_charge, samplers, raw);
    }
    Ok(())
}

/// Source for a signal that the detector itself generates, described by its stamp.
fn detector_source(kind: ObjectKind, id: usize, stamp: &Stamp) -> Source {
    Source {
        kind,
        id: id as u32,
        position: stamp.centre(),
        ends: [stamp.centre(); 2],
        astrometric: None,
        magnitude: None,
        electrons_per_s: 0.0,
    }
}
