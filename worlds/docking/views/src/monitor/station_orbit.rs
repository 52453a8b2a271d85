//! Orbit of the station, for the ground track.

use ::monitor::ground::{CircularOrbit, GroundTrack, sun_direction};
use nalgebra::Vector3;
use sim::docking::DockingSimulator;

/// Inclination of the station's orbit, degrees: that of the International Space Station.
const STATION_INCLINATION_DEG: f64 = 51.6;
/// Radius of the station's orbit, km, for the altitude in early 2004, about 370 km. Only the orbital period
/// depends on it.
const STATION_RADIUS_KM: f64 = 6748.0;
/// GM of the Earth, km³/s².
const GM_KM3_S2: f64 = sim::truth::EARTH_GM_KM3_S2;

/// Returns an orbit for a docking scenario, which defines none: a circular orbit with an inclination of
/// 51.6° and an altitude of about 370 km, on which the direction of the Sun at the start of the scenario
/// is that of the scene. The target is docked to at the aft end: y3 points backwards along the track, y2
/// to the zenith. Of the two possible nodes the one with the smaller right ascension is taken.
///
/// Returns `None` on the night side, where the scene has no Sun, and if no such orbit has the Sun in this
/// direction.
pub(super) fn station(simulator: &DockingSimulator) -> Option<GroundTrack> {
    let moment = simulator.field_state(0).ok()?;
    let towards = moment.lighting.sun?.towards.normalize();
    let sun = sun_direction(moment.time)?;
    let (sin_i, cos_i) = libm::sincos(STATION_INCLINATION_DEG.to_radians());
    // `towards` = (s1, s2, s3) along the target's axes y1, y2, y3. Normal of the orbit
    // N = (sin i sin Ω, −sin i cos Ω, cos i), and y1 = −N: N · sun = −s1.
    let sun_across = -towards.x;
    let equatorial = (sun.x * sun.x + sun.y * sun.y).sqrt();
    let sine = (sun_across - cos_i * sun.z) / (sin_i * equatorial);
    if sine.abs() > 1.0 {
        return None;
    }
    // N · sun = sin i · equatorial · sin(Ω − RA) + cos i · sun_z
    // The smaller of the two solutions, asin and π − asin.
    let raan = libm::atan2(sun.y, sun.x) + libm::asin(sine);
    let (sin_node, cos_node) = libm::sincos(raan);
    let normal = Vector3::new(sin_i * sin_node, -sin_i * cos_node, cos_i);
    let node = Vector3::new(cos_node, sin_node, 0.0);
    let quarter = normal.cross(&node);
    // Radial · sun = s2 and ahead · sun = −s3 give the angle in the orbital plane by which the spacecraft
    // is ahead of the Sun.
    let sun_angle = libm::atan2(sun.dot(&quarter), sun.dot(&node));
    let (sin_u, cos_u) = libm::sincos(sun_angle + libm::atan2(towards.z, towards.y));
    let rate_rad_s = (GM_KM3_S2 / (STATION_RADIUS_KM * STATION_RADIUS_KM * STATION_RADIUS_KM)).sqrt();
    Some(GroundTrack::Circular(CircularOrbit {
        epoch: moment.time,
        radial: node * cos_u + quarter * sin_u,
        ahead: quarter * cos_u - node * sin_u,
        radius_km: STATION_RADIUS_KM,
        rate_rad_s,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use docking::{DockingMission, DockingRenderer};
    use run::{ErasedWorld, ScenarioSource};

    #[test]
    fn the_sun_direction_agrees_with_the_scene() {
        run::register(&ErasedWorld::<DockingMission>::NEW);
        let source = ScenarioSource::read("docking").unwrap();
        let prepared = DockingMission::new(&source, DockingRenderer::Fast).unwrap();
        let simulator = prepared.simulator();
        let track = station(simulator).unwrap();
        let elevation = |time| track.position_km(time).normalize().dot(&sun_direction(time).unwrap());
        let moment = simulator.field_state(0).unwrap();
        let towards = moment.lighting.sun.unwrap().towards.normalize();
        // The tolerance covers the rounding of about ten products.
        assert!((elevation(moment.time) - towards.y).abs() < 1e-12);
        // From an altitude of 370 km the Sun is visible down to 19° below the horizontal. The scene is lit
        // until its end, so the orbit must be, too.
        let end = simulator.field_state(simulator.field_count() - 1).unwrap().time;
        assert!(elevation(end) > -0.32, "{}", elevation(end));
        let GroundTrack::Circular(orbit) = &track else { panic!("a circular orbit") };
        assert!((orbit.ahead.dot(&sun_direction(moment.time).unwrap()) + towards.z).abs() < 1e-12);
        let normal = orbit.radial.cross(&orbit.ahead);
        assert!((libm::acos(normal.z).to_degrees() - STATION_INCLINATION_DEG).abs() < 1e-9);
    }
}
