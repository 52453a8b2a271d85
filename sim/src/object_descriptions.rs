//! Truth of the objects in a frame.

use contract::Window;
use optics::Stamp;
use scene::Source;
use sensor::{Charge, CosmicRayHit, ExposureInterval};
use truth::{ObjectKind, ObjectTruth};

use crate::Simulator;

/// Truth of objects, with the stamps that frames reuse.
#[derive(Debug)]
pub(crate) struct ObjectDescriptions {
    /// Stamps of the hot pixels.
    hot: Vec<Stamp>,
    /// Stamp of a cosmic-ray hit: drawn when it strikes and again when it is described, because hits may be
    /// numerous.
    hit: Stamp,
    /// Image of an object whose wells overflow.
    bloomed: Stamp,
}

impl ObjectDescriptions {
    pub(crate) fn new() -> Self {
        Self { hot: Vec::new(), hit: Stamp::new(), bloomed: Stamp::new() }
    }

    /// Appends the hot pixels to the sources of a frame. The sensor itself collects their electrons; the
    /// stamps only describe them.
    pub(crate) fn add_hot_pixels(
        &mut self,
        simulator: &Simulator,
        interval: &ExposureInterval,
        sources: &mut Vec<Source>,
    ) {
        let (columns, _) = simulator.projection.detector();
        let hot_pixels = simulator.sensor.hot_pixels();
        self.hot.resize_with(hot_pixels.len(), Stamp::new);
        for (pixel, stamp) in hot_pixels.iter().zip(&mut self.hot) {
            stamp.set_pixel(pixel.x, pixel.y, simulator.sensor.hot_electrons(pixel, interval));
            sources.push(detector_source(ObjectKind::HotPixel, pixel.y * columns + pixel.x, stamp));
        }
    }

    /// Adds cosmic-ray hits to the charge and to the sources of a frame.
    pub(crate) fn add_hits(
        &mut self,
        simulator: &Simulator,
        hits: &[CosmicRayHit],
        charge: &mut Charge<'_>,
        sources: &mut Vec<Source>,
    ) {
        for (id, hit) in hits.iter().enumerate() {
            draw_hit(simulator, hit, &mut self.hit);
            charge.add_cosmic_ray_hit(&self.hit);
            sources.push(detector_source(ObjectKind::CosmicRay, id, &self.hit));
        }
    }

    /// Returns the truth of every object with signal on the detector. `sources` are those of the scene, then
    /// the hot pixels, then the hits; `windows` are the regions that the camera keeps.
    pub(crate) fn describe(
        &mut self,
        simulator: &Simulator,
        frame: u64,
        sources: &[Source],
        hits: &[CosmicRayHit],
        charge: &Charge<'_>,
        windows: Option<&[Window]>,
    ) -> Vec<ObjectTruth> {
        let mut objects = Vec::with_capacity(sources.len());
        let of_scene = charge.expected().objects();
        for (index, source) in sources.iter().enumerate() {
            let place_of_hit = index.checked_sub(of_scene.len() + self.hot.len());
            let stamp = match place_of_hit.and_then(|place| hits.get(place)) {
                Some(hit) => {
                    draw_hit(simulator, hit, &mut self.hit);
                    &self.hit
                }
                None => of_scene.get(index).unwrap_or_else(|| &self.hot[index - of_scene.len()]),
            };
            let bloomed = &mut self.bloomed;
            objects.extend(object_truth(simulator, frame, source, stamp, bloomed, charge, windows));
        }
        objects
    }
}

/// Returns the truth of an object with this stamp; `None` without signal on the detector. `bloomed` is a
/// buffer.
fn object_truth(
    simulator: &Simulator,
    frame: u64,
    source: &Source,
    stamp: &Stamp,
    bloomed: &mut Stamp,
    charge: &Charge<'_>,
    windows: Option<&[Window]>,
) -> Option<ObjectTruth> {
    let sensor = &simulator.sensor;
    let (columns, rows) = charge.expected().size();
    let (x, y) = (nearest_pixel(source.position.x, columns), nearest_pixel(source.position.y, rows));
    let background_e = charge.expected().background_near(x, y);
    let readout_noise_e = sensor.readout_noise_e();
    let truth = stamp.truth(background_e, readout_noise_e, sensor.config().saturation_e());
    if truth.electrons <= 0.0 {
        return None;
    }
    let (stamp, bloom_px) = if sensor.bloom_stamp(stamp, truth.peak_electrons, background_e, bloomed) {
        let noise_e = (background_e + readout_noise_e * readout_noise_e).sqrt();
        (&*bloomed, (bloomed.height_px(noise_e) - truth.radius_px).max(0.0))
    } else {
        (stamp, 0.0)
    };
    Some(ObjectTruth {
        frame,
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
        cut: windows.map_or(0.0, |windows| stamp.cut(windows)),
    })
}

/// Returns the pixel of the detector nearest to a coordinate.
fn nearest_pixel(at_px: f64, size: usize) -> usize {
    (at_px.round().max(0.0) as usize).min(size.saturating_sub(1))
}

/// Draws the charge of a cosmic-ray hit, as the pixels collect it.
fn draw_hit(simulator: &Simulator, hit: &CosmicRayHit, stamp: &mut Stamp) {
    if let Some(rays) = &simulator.cosmic_rays {
        rays.stamp(hit, stamp);
        simulator.sensor.mask_dead_pixels(stamp);
    }
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
