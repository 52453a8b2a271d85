//! Scene in front of the camera during an exposure: of a whole frame, of each field of an interlaced frame,
//! or of the first and the last row of a rolling shutter.

use std::collections::BTreeSet;

use hifitime::{Epoch, Unit};
use optics::Psf;
use scene::{BackgroundField, CameraMotion, Source, planets};
use sensor::{InterlaceConfig, RollingShutterConfig};
use truth::{ObjectKind, SimError, Switch, clock};

use crate::Simulator;
use crate::foreground::ForegroundBodies;
use crate::scene_state::SceneState;

/// Scene in front of the camera during an exposure.
pub(crate) struct SceneView {
    time: Epoch,
    /// Positions and attitudes at `time`, the middle of the exposure.
    pub(crate) state: SceneState,
    camera: CameraMotion,
    /// Target, stars, planets and the Moon, each kind in order of number.
    pub(crate) sources: Vec<Source>,
    pub(crate) background: Option<BackgroundField>,
}

/// Scenes from which a frame is drawn.
pub(crate) enum FrameViews {
    /// The scene at the middle of the frame.
    Single,
    /// The scenes at the middle of each field, with the same sources in the same order as at the middle of
    /// the frame.
    Fields(InterlaceConfig, Box<[SceneView; 2]>),
    /// The scenes at mid-exposure of the first and of the last row of a rolling shutter, with the same
    /// sources in the same order as at the middle of the frame.
    Rows(Box<[SceneView; 2]>),
}

impl SceneView {
    /// Returns the view at `time`, the middle of frame `number`, with positions and attitudes from `state`,
    /// and the scenes to draw.
    pub(crate) fn for_frame(
        simulator: &Simulator,
        psf: &Psf,
        time: Epoch,
        state: SceneState,
        exposure_s: f64,
        number: u64,
    ) -> Result<(Self, FrameViews), SimError> {
        let mut middle = Self::without_sources(simulator, time, state, exposure_s, number)?;
        let sensor = simulator.sensor.config();
        let (_, rows) = simulator.projection.detector();
        let rolling_offsets_s = |rolling: RollingShutterConfig| rolling.offsets_s(rows);
        let offsets_s = match sensor.interlace {
            Some(interlace) => Some(interlace.offsets_s()),
            None => sensor.rolling_shutter.map(rolling_offsets_s),
        };
        let Some([first_s, second_s]) = offsets_s else {
            middle.find_sources(simulator, psf, exposure_s);
            return Ok((middle, FrameViews::Single));
        };
        let (mut first, mut second) = (
            middle.at_offset(simulator, first_s, exposure_s, number)?,
            middle.at_offset(simulator, second_s, exposure_s, number)?,
        );
        // An object at the edge may contribute at only one of the times: each view searches the area of all
        // three.
        let cameras = [middle.camera, first.camera, second.camera];
        for view in [&mut middle, &mut first, &mut second] {
            cameras.iter().for_each(|other| view.camera.widen_to(other));
            view.find_sources(simulator, psf, exposure_s);
        }
        retain_common([&mut middle.sources, &mut first.sources, &mut second.sources]);
        let views = Box::new([first, second]);
        Ok(match sensor.interlace {
            Some(interlace) => (middle, FrameViews::Fields(interlace, views)),
            None => (middle, FrameViews::Rows(views)),
        })
    }

    /// Returns the view of an exposure `offset_s` after this one, before its sources are found.
    fn at_offset(
        &self,
        simulator: &Simulator,
        offset_s: f64,
        exposure_s: f64,
        number: u64,
    ) -> Result<Self, SimError> {
        let time = self.time + offset_s * Unit::Second;
        let state = SceneState::compute_at(simulator, time, number)?;
        Self::without_sources(simulator, time, state, exposure_s, number)
    }

    /// Writes the background of every pixel, electrons per second, row by row; returns false if there is
    /// none.
    pub(crate) fn background_e_per_s(&self, out: &mut Vec<f64>) -> bool {
        if let Some(background) = &self.background {
            background.electrons_per_s(out);
        }
        self.background.is_some()
    }

    /// Creates the view of an exposure about `time`, before its sources are found.
    fn without_sources(
        simulator: &Simulator,
        time: Epoch,
        mut state: SceneState,
        exposure_s: f64,
        number: u64,
    ) -> Result<Self, SimError> {
        let camera = state.motion(simulator, time, exposure_s, number)?;
        Ok(Self { time, state, camera, sources: Vec::new(), background: None })
    }

    /// Finds all sources and the background that contribute electrons on the detector during the exposure.
    fn find_sources(&mut self, simulator: &Simulator, psf: &Psf, exposure_s: f64) {
        let Self { time, state, camera, sources, background } = self;
        if let Some(vibration) = &simulator.vibration {
            camera.widen_by(vibration.reach());
        }
        let reach_px = |rate_e_per_s: f64| psf.reach_px(rate_e_per_s * exposure_s, Psf::FLOOR_E);
        if state.target_position.is_some() {
            sources.push(state.target);
        }
        simulator.stars.add_visible(&state.observer, camera, &simulator.projection, reach_px, sources);
        if simulator.solar_system == Switch::On {
            planets::add_visible(
                clock::tdb_j2000_s(*time),
                &state.observer,
                camera,
                &simulator.projection,
                &simulator.radiometry,
                reach_px,
                sources,
            );
        }
        let screens = ForegroundBodies::from_state(simulator, state);
        sources.retain(|source| {
            let far = matches!(source.kind, ObjectKind::Star | ObjectKind::Planet);
            !(far && source.astrometric.is_some_and(|astrometric| screens.hide(astrometric)))
        });
        if let Some(moon) = &state.moon {
            sources.extend(moon.source(camera, &simulator.projection, &simulator.radiometry, reach_px));
        }
        *background = simulator.background.as_ref().map(|background| {
            let (position_km, sun_km) = (&state.states.chaser.position_km, &state.observer.sun_km());
            background.field(*time, position_km, sun_km, state.camera_from_icrs)
        });
    }
}

/// Keeps the sources that occur in all three lists, each list in its order. A source missing from one list
/// contributes nothing in any of the exposures, because each list was searched for all sources near enough;
/// or it is hidden at one of the three times: a star exactly at the limb of the hiding body is then omitted
/// from both fields, in image and truth.
fn retain_common(mut lists: [&mut Vec<Source>; 3]) {
    let names =
        |list: &Vec<Source>| list.iter().map(|source| (source.kind, source.id)).collect::<BTreeSet<_>>();
    let known = lists.each_ref().map(|list| names(list));
    for list in &mut lists {
        list.retain(|source| known.iter().all(|names| names.contains(&(source.kind, source.id))));
    }
}
