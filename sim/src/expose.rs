//! Truth → scene → optics → sensor → on board: one frame, in one function.

use std::collections::BTreeSet;

use contract::{Body, CameraFrame, Direction, Frame, Icrs, PixelPoint, Rotation, Target, Telemetry};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;

use crate::draw::ExpectedImage;
use crate::onboard::{RoiExtractor, downlink};
use crate::optics::{ImagePoint, Projection, Psf, Stamp};
use crate::painter::Painter;
use crate::scene::{Appearance, BackgroundField, CameraMotion, Lighting, Source, planets};
use crate::sensor::{FlatLaws, InterlaceConfig, Opening, RawImage, Switch, Track};
use crate::truth::{FrameTruth, ObjectKind, ObjectTruth, Observer, States, Visibility, clock, shadow};
use crate::{SimError, Simulator};

/// One frame with all that belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposure {
    /// The image as it arrives on the ground.
    pub frame: Frame,
    /// What the spacecraft tells about it.
    pub telemetry: Telemetry,
    /// The truth about the frame.
    pub truth: FrameTruth,
    /// The truth about every object in it: the target, then stars, planets, hot pixels and tracks of particles, each by
    /// number.
    pub objects: Vec<ObjectTruth>,
}

/// A camera of a [`Simulator`], with the buffers that frames reuse. One a thread.
#[derive(Debug)]
pub struct SimulatedCamera<'a> {
    simulator: &'a Simulator,
    painter: Painter,
    image: ExpectedImage,
    laws: FlatLaws,
    raw: RawImage,
    regions: Option<RoiExtractor>,
    /// Background of the scene, electrons a second, pixel by pixel; in the second place that of the second field.
    backgrounds: [Vec<f64>; 2],
    stamps: Vec<Stamp>,
    /// The image of an object as the scene was in the first and in the second field.
    halves: [Stamp; 2],
    /// The image of an object whose wells overflow.
    bloomed: Stamp,
}

/// Where everything is at one moment.
struct Moment {
    states: States,
    observer: Observer,
    body_from_icrs: Rotation<Body, Icrs>,
    camera_from_icrs: Rotation<CameraFrame, Icrs>,
    line_of_sight: Direction<Icrs>,
    sunlit_fraction: f64,
    phase_rad: f64,
    /// The target, and where the origin of its body frame is in the image; `None` behind the camera.
    target: Source,
    target_position: Option<PixelPoint>,
    target_from_icrs: Option<Rotation<Target, Icrs>>,
    appearance: Appearance,
}

impl Moment {
    /// Where a point of the target's body frame, m, is in the image: each point in its own direction.
    fn place_of(&self, point_m: &Vector3<f64>, projection: &Projection) -> Option<PixelPoint> {
        let turned_m = self.target_from_icrs.map_or(*point_m, |turn| turn.inverse().rotate(point_m));
        let from_chaser_km = self.states.line_of_sight_km() + turned_m / 1000.0;
        projection.project(&(self.camera_from_icrs * Direction::from_vector(from_chaser_km).ok()?))
    }
}

/// What the camera sees while its shutter is open.
struct View {
    /// In the middle of the opening.
    moment: Moment,
    camera: CameraMotion,
    /// Target, stars and planets, each by number.
    sources: Vec<Source>,
    background: Option<BackgroundField>,
}

impl View {
    /// The background of every pixel, electrons a second; `false` when there is none of it.
    fn look_around(&self, out: &mut Vec<f64>) -> bool {
        if let Some(background) = &self.background {
            background.electrons_per_s(out);
        }
        self.background.is_some()
    }
}

/// What is drawn of a frame.
enum Drawn {
    /// The scene in the middle of the frame.
    Whole,
    /// The scenes in the middle of either field, with the same sources, in the same order, as the middle of the frame.
    Fields(InterlaceConfig, Box<[View; 2]>),
}

impl<'a> SimulatedCamera<'a> {
    pub(crate) fn new(simulator: &'a Simulator) -> Result<Self, SimError> {
        let (columns, rows) = simulator.projection.detector();
        let regions = simulator.roi.as_ref().map(|roi| RoiExtractor::new(roi, columns, rows)).transpose()?;
        Ok(Self {
            simulator,
            painter: Painter::new(simulator.psf.clone()),
            image: simulator.sensor.new_expected(),
            laws: FlatLaws::new(),
            raw: simulator.sensor.new_raw(),
            regions,
            backgrounds: [Vec::new(), Vec::new()],
            stamps: Vec::new(),
            halves: [Stamp::new(), Stamp::new()],
            bloomed: Stamp::new(),
        })
    }

    /// Makes frame number `number`: the same bits whatever was made before.
    ///
    /// # Errors
    /// [`SimError::Parameter`] when the schedule has no such frame.
    pub fn expose(&mut self, number: u64) -> Result<Exposure, SimError> {
        let simulator = self.simulator;
        let (group, time) = simulator.schedule.frame(number).ok_or_else(|| SimError::Parameter {
            field: "frame",
            value: number.to_string(),
            expected: "a frame of the schedule",
        })?;
        let exposure_s = self.exposure_s(time, number)?;
        let (mut view, drawn) = self.views(time, exposure_s, number)?;
        let opening = Opening { seed: simulator.seed, middle_s: clock::tt_j2000_s(time), exposure_s };
        let tracks = simulator.cosmic_rays.as_ref().map_or_else(Vec::new, |rays| {
            let rate = rays.rate_per_cm2_s(time, &view.moment.states.chaser.position_km);
            rays.tracks(&simulator.seed, number, exposure_s, rate)
        });
        let mut objects = self.draw(&mut view, &drawn, number, &opening, &tracks)?;
        let windows = self.regions.as_mut().map(|regions| regions.extract(&self.raw));
        if let Some(windows) = &windows {
            for (object, stamp) in objects.iter_mut().zip(&self.stamps) {
                object.cut = stamp.cut(windows);
            }
        }

        let moment = view.moment;
        let truth = FrameTruth {
            frame: number,
            group: group.to_owned(),
            time,
            exposure_s,
            body_from_icrs: moment.body_from_icrs,
            camera_from_icrs: moment.camera_from_icrs,
            position_km: moment.states.chaser.position_km,
            velocity_km_s: moment.states.chaser.velocity_km_s,
            line_of_sight: moment.line_of_sight,
            range_km: moment.states.range_km(),
            sun: moment.observer.sun(),
            phase_deg: moment.phase_rad.to_degrees(),
            shadow: shadow::classify(moment.sunlit_fraction),
            sunlit_fraction: moment.sunlit_fraction,
            background_e_per_s: view.background.map_or(0.0, |field| field.mean_e_per_s()),
            target_from_icrs: moment.target_from_icrs,
            target_position: moment.target_position,
            target_visibility: Visibility::of_snr(
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
        let frame = downlink(&self.raw, number, windows)?;
        Ok(Exposure { frame, telemetry, truth, objects })
    }

    /// The noise-free expectation of the last frame made, electrons a pixel (dark current and hot pixels included), before
    /// saturation.
    pub fn expected(&self) -> &ExpectedImage {
        &self.image
    }

    /// Where everything is at `time`, with the attitude of frame `number`.
    fn moment(&self, time: Epoch, number: u64) -> Result<Moment, SimError> {
        let simulator = self.simulator;
        let states = simulator.trajectory.at(time);
        let body_from_icrs = simulator.attitude.truth(&states, number);
        let camera_from_icrs = simulator.camera_from_body * body_from_icrs;
        let observer = Observer::new(time, states.chaser.position_km, states.chaser.velocity_km_s)?;

        let line_of_sight_km = states.line_of_sight_km();
        let line_of_sight = Direction::from_vector(line_of_sight_km)?;
        let earth_to_sun_km = states.chaser.position_km + observer.sun_km();
        let sunlit_fraction = shadow::sunlit_fraction(&states.target.position_km, &earth_to_sun_km);
        let lighting = Lighting {
            chaser_km: -line_of_sight_km,
            sun_km: earth_to_sun_km - states.target.position_km,
            sunlit_fraction,
        };
        let target_from_icrs = simulator.target.attitude(&states);
        let appearance = simulator.target.appearance(&lighting, target_from_icrs);
        let magnitude = appearance.magnitude();
        // The target moves with the chaser: light time cancels aberration, so it is seen where it is.
        let target_position = simulator.projection.project(&(camera_from_icrs * line_of_sight));
        let target = Source {
            kind: ObjectKind::Target,
            id: 0,
            position: target_position.unwrap_or_default(),
            ends: [target_position.unwrap_or_default(); 2],
            astrometric: Some(line_of_sight),
            // In the umbra there is no light, and no magnitude.
            magnitude,
            electrons_per_s: magnitude.map_or(0.0, |m| simulator.radiometry.sunlit(m)),
        };
        Ok(Moment {
            states,
            observer,
            body_from_icrs,
            camera_from_icrs,
            line_of_sight,
            sunlit_fraction,
            phase_rad: lighting.phase_rad(),
            target,
            target_position,
            target_from_icrs,
            appearance,
        })
    }

    /// What the camera sees about the middle of a frame, and what of it is drawn.
    fn views(&self, time: Epoch, exposure_s: f64, number: u64) -> Result<(View, Drawn), SimError> {
        let mut middle = self.view(time, exposure_s, number)?;
        let Some(interlace) = self.simulator.sensor.config().interlace else {
            self.look(&mut middle, time, exposure_s);
            return Ok((middle, Drawn::Whole));
        };
        let times = interlace.offsets_s().map(|offset_s| time + offset_s * Unit::Second);
        let mut first = self.view(times[0], exposure_s, number)?;
        let mut second = self.view(times[1], exposure_s, number)?;
        // An object at the edge may have light in one field alone: all look out as far as any of them sees.
        let cameras = [middle.camera, first.camera, second.camera];
        for (view, time) in [(&mut middle, time), (&mut first, times[0]), (&mut second, times[1])] {
            cameras.iter().for_each(|other| view.camera.widen_to(other));
            self.look(view, time, exposure_s);
        }
        keep_common([&mut middle.sources, &mut first.sources, &mut second.sources]);
        Ok((middle, Drawn::Fields(interlace, Box::new([first, second]))))
    }

    /// The camera with its shutter open about `time`, before it has looked.
    fn view(&self, time: Epoch, exposure_s: f64, number: u64) -> Result<View, SimError> {
        let mut moment = self.moment(time, number)?;
        let camera = self.motion(&mut moment, time, exposure_s, number)?;
        Ok(View { moment, camera, sources: Vec::new(), background: None })
    }

    /// Finds all that has light on the detector while the shutter is open.
    fn look(&self, view: &mut View, time: Epoch, exposure_s: f64) {
        let simulator = self.simulator;
        let View { moment, camera, sources, background } = view;
        let reach_px =
            |rate_e_per_s: f64| self.painter.psf().reach_px(rate_e_per_s * exposure_s, Psf::FLOOR_E);
        if moment.target_position.is_some() {
            sources.push(moment.target);
        }
        simulator.stars.look(&moment.observer, camera, &simulator.projection, reach_px, sources);
        if simulator.planets == Switch::On {
            planets::look(
                clock::tdb_j2000_s(time),
                &moment.observer,
                camera,
                &simulator.projection,
                &simulator.radiometry,
                reach_px,
                sources,
            );
        }
        *background = simulator.background.as_ref().map(|background| {
            let (position_km, sun_km) = (&moment.states.chaser.position_km, &moment.observer.sun_km());
            background.field(time, position_km, sun_km, moment.camera_from_icrs)
        });
    }

    /// How the camera turns during the exposure about the middle `moment`, and where its target is at both ends.
    fn motion(
        &self,
        moment: &mut Moment,
        time: Epoch,
        exposure_s: f64,
        number: u64,
    ) -> Result<CameraMotion, SimError> {
        let simulator = self.simulator;
        let mut camera = CameraMotion::still(moment.camera_from_icrs);
        if simulator.attitude.motion_smear() == Switch::On {
            for (end, side) in [-0.5, 0.5].into_iter().enumerate() {
                let states = simulator.trajectory.at(time + side * exposure_s * Unit::Second);
                camera.ends[end] = simulator.camera_from_body * simulator.attitude.truth(&states, number);
                let line_of_sight = Direction::from_vector(states.line_of_sight_km())?;
                if let Some(position) = simulator.projection.project(&(camera.ends[end] * line_of_sight)) {
                    moment.target.ends[end] = position;
                }
            }
        }
        Ok(camera)
    }

    /// The exposure time that the shutter control chooses: it follows the brightest object on the detector, as it
    /// was a lag before the exposure.
    fn exposure_s(&self, time: Epoch, number: u64) -> Result<f64, SimError> {
        let simulator = self.simulator;
        let time = time - simulator.shutter.lag_s() * Unit::Second;
        let moment = self.moment(time, number)?;
        let (columns, rows) = simulator.projection.detector();
        let target = moment.target_position.filter(|position| position.is_on_detector(columns, rows));
        // A body that spans pixels has a lower peak than a point of its light.
        let peak_share = self.painter.psf().peak_share();
        let place = |point_m: &Vector3<f64>| moment.place_of(point_m, &simulator.projection);
        let spread = moment.appearance.peak_share(&place, peak_share) / peak_share;
        let mut brightest = simulator.stars.brightest(
            &moment.observer,
            moment.camera_from_icrs,
            &simulator.projection,
            target.map_or(0.0, |_| moment.target.electrons_per_s * spread),
        );
        if simulator.planets == Switch::On {
            brightest = planets::brightest(
                clock::tdb_j2000_s(time),
                &moment.observer,
                moment.camera_from_icrs,
                &simulator.projection,
                &simulator.radiometry,
                brightest,
            );
        }
        let peak = (brightest > 0.0).then_some(brightest * peak_share);
        Ok(simulator.shutter.exposure_s(peak))
    }

    /// Draws the expected image and the digital numbers, keeps a stamp of every object that has light on the detector,
    /// and tells its truth.
    fn draw(
        &mut self,
        view: &mut View,
        drawn: &Drawn,
        number: u64,
        opening: &Opening,
        tracks: &[Track],
    ) -> Result<Vec<ObjectTruth>, SimError> {
        let Self { simulator, painter, image, backgrounds, laws, raw, stamps, halves, bloomed, .. } = self;
        let sensor = &simulator.sensor;
        let (columns, rows) = image.size();
        let hot_pixels = sensor.hot_pixels();
        let detected = view.sources.len() + hot_pixels.len() + tracks.len();
        stamps.resize_with(stamps.len().max(detected), Stamp::new);
        let (lit, own) = stamps.split_at_mut(view.sources.len());
        let (hot, struck) = own.split_at_mut(hot_pixels.len());

        image.clear(sensor.sky_electrons(opening.exposure_s));
        let [background, later] = backgrounds;
        let has_background = match drawn {
            Drawn::Whole => view.look_around(background),
            Drawn::Fields(interlace, fields) => {
                let [first, second] = &**fields;
                let has_background = first.look_around(background) && second.look_around(later);
                if has_background {
                    interlace.weave(background, later, columns);
                }
                has_background
            }
        };
        image.set_field(has_background.then_some(background), opening.exposure_s);
        let mut paint = |view: &View, index: usize, stamp: &mut Stamp| {
            let source = &view.sources[index];
            let transmission = simulator.vignetting.transmission(source.position);
            let electrons = source.electrons_per_s * opening.exposure_s * transmission;
            let resolve = |most: usize, body: &mut Vec<ImagePoint>| {
                if source.kind == ObjectKind::Target {
                    let place = |point_m: &Vector3<f64>| view.moment.place_of(point_m, &simulator.projection);
                    view.moment.appearance.image(&place, most, body);
                } else {
                    body.push(ImagePoint { position: source.position, share: 1.0 });
                }
            };
            painter.paint(source, electrons, resolve, (columns, rows), stamp);
        };
        for (index, stamp) in lit.iter_mut().enumerate() {
            match drawn {
                Drawn::Whole => paint(view, index, stamp),
                Drawn::Fields(interlace, fields) => {
                    let [first, second] = &**fields;
                    paint(first, index, &mut halves[0]);
                    paint(second, index, &mut halves[1]);
                    stamp.weave(&halves[0], &halves[1], |row| interlace.is_first(row));
                }
            }
            view.sources[index].position = stamp.centre();
            image.add(stamp);
            sensor.respond(stamp);
        }
        let sources = &mut view.sources;
        let mut charge = sensor.collect(image, opening);
        for (pixel, stamp) in hot_pixels.iter().zip(hot) {
            // The sensor itself collects it; here it is only described.
            stamp.set_pixel(pixel.x, pixel.y, sensor.hot_electrons(pixel, opening));
            sources.push(of_the_detector(ObjectKind::HotPixel, pixel.y * columns + pixel.x, stamp));
        }
        if let Some(rays) = &simulator.cosmic_rays {
            for (id, (track, stamp)) in tracks.iter().zip(struck).enumerate() {
                rays.stamp(track, stamp);
                sensor.strike(&mut charge, stamp);
                sources.push(of_the_detector(ObjectKind::CosmicRay, id, stamp));
            }
        }

        let mut objects = Vec::with_capacity(detected);
        for (i, source) in sources.iter().enumerate() {
            let stamp = &mut stamps[i];
            let pixel = |at: f64, size: usize| (at.round().max(0.0) as usize).min(size.saturating_sub(1));
            let (x, y) = (pixel(source.position.x, columns), pixel(source.position.y, rows));
            let background_e = charge.expected().background_at(x, y);
            let truth = stamp.truth(background_e, sensor.read_noise_e());
            if truth.electrons <= 0.0 {
                continue;
            }
            let mut radius_px = truth.radius_px;
            if sensor.bloom_stamp(stamp, background_e, bloomed) {
                radius_px = bloomed.truth(background_e, sensor.read_noise_e()).radius_px;
                std::mem::swap(stamp, bloomed);
            }
            // The stamps of the objects stand in the order of the objects.
            stamps.swap(i, objects.len());
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
                radius_px,
                cut: 0.0,
            });
        }
        sensor.read_out(&charge, &simulator.seed, number, laws, raw)?;
        Ok(objects)
    }
}

/// What the detector makes by itself, as a source that is described by its stamp.
fn of_the_detector(kind: ObjectKind, id: usize, stamp: &Stamp) -> Source {
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

/// Keeps the sources that are in all three lists, each in its order. What is missing in one has no light in any of the
/// exposures: each list was asked for all that comes near enough.
fn keep_common(mut lists: [&mut Vec<Source>; 3]) {
    let names =
        |list: &Vec<Source>| list.iter().map(|source| (source.kind, source.id)).collect::<BTreeSet<_>>();
    let known = lists.each_ref().map(|list| names(list));
    for list in &mut lists {
        list.retain(|source| known.iter().all(|names| names.contains(&(source.kind, source.id))));
    }
}
