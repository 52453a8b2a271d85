//! Occultation of stars and planets.

use contract::{Direction, Icrs};
use scene::{Background, Outline, earth::EarthDisk, moon::LitMoon};
use truth::Observer;

use crate::Simulator;
use crate::scene_state::SceneState;

/// Bodies of a scene that can occult stars and planets: the Earth if its light is in the scene, the Moon, and
/// the target.
pub(crate) struct ForegroundBodies<'a> {
    observer: &'a Observer,
    earth: Option<EarthDisk>,
    moon: Option<&'a LitMoon>,
    target: Option<Outline<'a>>,
}

impl<'a> ForegroundBodies<'a> {
    /// Returns the occulting bodies at one instant.
    pub(crate) fn from_state(simulator: &'a Simulator, state: &'a SceneState) -> Self {
        let has_earth = simulator.background.as_ref().is_some_and(Background::has_earth);
        Self {
            observer: &state.observer,
            earth: has_earth.then(|| EarthDisk::from_observer(&state.states.chaser.position_km)),
            moon: state.moon.as_ref(),
            target: simulator.target.outline(&-state.states.line_of_sight_km(), state.target_from_icrs),
        }
    }

    /// Returns true if any of the bodies hides a distant source with this astrometric direction.
    pub(crate) fn hide(&self, astrometric: Direction<Icrs>) -> bool {
        let earth = self.earth.as_ref().filter(|earth| earth.is_near(&astrometric));
        let moon = self.moon.filter(|moon| moon.is_near(&astrometric));
        let target = self.target.as_ref().filter(|target| target.is_near(&astrometric));
        (earth.is_some() || moon.is_some() || target.is_some()) && {
            let apparent = self.observer.apparent_from_astrometric(astrometric);
            earth.is_some_and(|earth| earth.hides(&apparent))
                || moon.is_some_and(|moon| moon.hides(&apparent))
                || target.is_some_and(|target| target.hides(&apparent))
        }
    }
}
