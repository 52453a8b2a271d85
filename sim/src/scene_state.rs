//! State of the scene at one instant: chaser, target, camera, light.

use contract::{Body, CameraFrame, Direction, Icrs, PixelPoint, Rotation, Target};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use optics::Projection;
use scene::{Appearance, CameraMotion, Lighting, Source, moon::LitMoon};
use truth::{ObjectKind, Observer, SimError, States, Switch, clock, shadow};

use crate::Simulator;

/// State of the scene at one instant.
pub(crate) struct SceneState {
    pub(crate) states: States,
    pub(crate) observer: Observer,
    pub(crate) body_from_icrs: Rotation<Body, Icrs>,
    pub(crate) camera_from_icrs: Rotation<CameraFrame, Icrs>,
    pub(crate) line_of_sight: Direction<Icrs>,
    pub(crate) sunlit_fraction: f64,
    pub(crate) phase_rad: f64,
    /// Target, and the pixel position of its body frame's origin; `None` behind the camera.
    pub(crate) target: Source,
    pub(crate) target_position: Option<PixelPoint>,
    pub(crate) target_from_icrs: Option<Rotation<Target, Icrs>>,
    pub(crate) appearance: Appearance,
    /// Moon; `None` without the Solar System.
    pub(crate) moon: Option<LitMoon>,
}

impl SceneState {
    /// Computes the state of the scene at `time`, with the attitude of frame `number`.
    pub(crate) fn compute_at(simulator: &Simulator, time: Epoch, number: u64) -> Result<Self, SimError> {
        let states = simulator.trajectory.states_at(time);
        simulator.target.check_separation(simulator.trajectory.relative_path(), &states, number)?;
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
        // The target moves with the chaser: light time cancels aberration, so the target appears in its
        // geometric direction.
        let target_position = simulator.projection.project(&(camera_from_icrs * line_of_sight));
        let target = Source {
            kind: ObjectKind::Target,
            id: 0,
            position: target_position.unwrap_or_default(),
            ends: [target_position.unwrap_or_default(); 2],
            astrometric: Some(line_of_sight),
            // In the umbra the target has neither flux nor magnitude.
            magnitude,
            electrons_per_s: magnitude.map_or(0.0, |m| simulator.radiometry.sunlit(m)),
        };
        let moon = match simulator.solar_system {
            Switch::On => LitMoon::new(clock::tdb_j2000_s(time), &states.chaser, &observer),
            Switch::Off => None,
        };
        Ok(Self {
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
            moon,
        })
    }

    /// Rotation of the camera during the exposure centred on this instant; also sets the target's positions
    /// at the start and the end.
    pub(crate) fn motion(
        &mut self,
        simulator: &Simulator,
        time: Epoch,
        exposure_s: f64,
        number: u64,
    ) -> Result<CameraMotion, SimError> {
        let mut camera = CameraMotion::still(self.camera_from_icrs);
        if simulator.attitude.motion_smear() == Switch::On {
            for (end, side) in [-0.5, 0.5].into_iter().enumerate() {
                let states = simulator.trajectory.states_at(time + side * exposure_s * Unit::Second);
                camera.ends[end] = simulator.camera_from_body * simulator.attitude.truth(&states, number);
                let line_of_sight = Direction::from_vector(states.line_of_sight_km())?;
                if let Some(position) = simulator.projection.project(&(camera.ends[end] * line_of_sight)) {
                    self.target.ends[end] = position;
                }
            }
        }
        Ok(camera)
    }

    /// Pixel position of a point of the target's body frame, m; each point is projected in its individual
    /// direction.
    pub(crate) fn project(&self, point_m: &Vector3<f64>, projection: &Projection) -> Option<PixelPoint> {
        let turned_m = self.target_from_icrs.map_or(*point_m, |turn| turn.inverse().rotate(point_m));
        let from_chaser_km = self.states.line_of_sight_km() + turned_m / 1000.0;
        projection.project(&(self.camera_from_icrs * Direction::from_vector(from_chaser_km).ok()?))
    }
}
