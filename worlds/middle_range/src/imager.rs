//! Imager: frames of the body at known ranges.

use contract::{Camera, CameraFrame, Direction, Frame, OutOfRange, PixelPoint};
use draws::Seed;
use files::Failure;
use nalgebra::Vector3;
use optics::Projection;
use render::draw::ExpectedImage;
use sensor::{ExposureInterval, FrameCharge, Sensor};

use crate::rows::Truth;
use crate::scenario::MiddleRangeScenario;

/// Samples of a pixel along each side.
const SAMPLES: usize = 4;

/// Ratio of the two periods in which the camera wanders, the golden section: the path does not close.
const WANDER_RATIO: f64 = 1.618;
/// Frames in which the camera wanders once about the body along the columns.
const WANDER_FRAMES: f64 = 60.0;

/// Camera and body of a scenario.
pub(crate) struct Imager {
    scenario: MiddleRangeScenario,
    projection: Projection,
    sensor: Sensor,
}

/// Body at the time of a frame, in the camera's frame, in units of its distance.
struct Sphere {
    /// Direction of its centre.
    towards: Vector3<f64>,
    /// Radius over distance.
    sine: f64,
    /// Direction of the Sun from the body.
    sun: Vector3<f64>,
}

impl Imager {
    /// Prepares camera and detector of a checked scenario.
    pub(crate) fn new(scenario: &MiddleRangeScenario) -> Result<Self, OutOfRange> {
        let Camera { columns, rows, .. } = scenario.camera;
        let unusable =
            |error: truth::SimError| OutOfRange::new("sensor", error, "a camera that can be simulated");
        Ok(Self {
            projection: Projection::new(&scenario.camera).map_err(unusable)?,
            sensor: Sensor::new(&scenario.sensor, columns, rows).map_err(unusable)?,
            scenario: scenario.clone(),
        })
    }

    /// Range of a frame, km: d₀ (d₁/d₀)^(n/(N−1)).
    pub(crate) fn range_km(&self, frame: u64) -> f64 {
        let approach = &self.scenario.approach;
        let last = approach.frames.saturating_sub(1).max(1) as f64;
        approach.from_km * libm::pow(approach.to_km / approach.from_km, frame as f64 / last)
    }

    /// Directions from the camera to the body and from the body to the Sun, in the camera's frame.
    #[cfg(feature = "monitor")]
    pub(crate) fn directions(&self, frame: u64) -> ([f64; 3], [f64; 3]) {
        let Sphere { towards, sun, .. } = self.sphere(frame);
        (towards.into(), sun.into())
    }

    fn sphere(&self, frame: u64) -> Sphere {
        let (approach, body) = (&self.scenario.approach, &self.scenario.body);
        let turn = std::f64::consts::TAU * frame as f64 / WANDER_FRAMES;
        let wander = approach.wander_deg.to_radians() / std::f64::consts::SQRT_2;
        let (x, y) = (wander * libm::sin(turn), wander * libm::cos(turn / WANDER_RATIO));
        // The Sun is the phase angle away from the camera as seen from the body, at an angle in the image.
        let (sin_phase, cos_phase) = libm::sincos(body.phase_deg.to_radians());
        let (sin_angle, cos_angle) = libm::sincos(body.sun_angle_deg.to_radians());
        Sphere {
            towards: Vector3::new(libm::tan(x), libm::tan(y), 1.0).normalize(),
            sine: body.radius_m / (1000.0 * self.range_km(frame)),
            sun: Vector3::new(sin_phase * cos_angle, sin_phase * sin_angle, -cos_phase),
        }
    }

    /// Makes a frame with an exposure time, and its truth.
    pub(crate) fn expose(&self, frame: u64, exposure_s: f64) -> Result<(Frame, Truth), Failure> {
        let sphere = self.sphere(frame);
        let centre = self.projection.project(&Direction::<CameraFrame>::from_unit(sphere.towards));
        let (across, _) = self.projection.plate_scale_px_per_rad();
        let radius_px = across * libm::tan(libm::asin(sphere.sine));
        let mut image = self.sensor.new_expected();
        image.clear(self.sensor.sky_electrons(exposure_s));
        let peak_electrons = match centre {
            Some(centre) => self.paint(&mut image, &sphere, centre, radius_px, exposure_s),
            None => 0.0,
        };
        let (columns, rows) = (self.scenario.camera.columns, self.scenario.camera.rows);
        let is_inside = |at: f64, length: usize| at >= radius_px && at + radius_px <= length as f64 - 1.0;
        let truth = Truth {
            frame,
            range_km: self.range_km(frame),
            centre,
            radius_px,
            phase_deg: self.scenario.body.phase_deg,
            exposure_s,
            peak_electrons,
            is_whole: centre.is_some_and(|at| is_inside(at.x, columns) && is_inside(at.y, rows)),
        };
        Ok((self.read_out(&mut image, frame, exposure_s)?, truth))
    }

    /// Adds the light of the body to its pixels, each the mean of its samples; returns that of the brightest.
    fn paint(
        &self,
        image: &mut ExpectedImage,
        sphere: &Sphere,
        centre: PixelPoint,
        radius_px: f64,
        exposure_s: f64,
    ) -> f64 {
        let (columns, rows) = image.size();
        // Off the axis the disk is an ellipse, longer by the square of the inverse cosine.
        let reach = 2.0 + 1.2 * radius_px / (sphere.towards.z * sphere.towards.z);
        let span = |at: f64, length: usize| {
            let (low, high) = ((at - reach).floor().max(0.0), (at + reach).ceil().min(length as f64 - 1.0));
            low as usize..(high + 1.0).max(low) as usize
        };
        let full_e = self.scenario.body.electrons_per_s * exposure_s;
        let mut peak_e = 0.0_f64;
        for y in span(centre.y, rows) {
            for x in span(centre.x, columns) {
                let electrons = full_e * self.mean_radiance(sphere, x, y);
                if electrons > 0.0 {
                    image.add_pixel(x, y, electrons);
                    peak_e = peak_e.max(electrons);
                }
            }
        }
        peak_e
    }

    /// Mean over the samples of a pixel of the radiance, 1 on a surface that faces the Sun.
    fn mean_radiance(&self, sphere: &Sphere, x: usize, y: usize) -> f64 {
        let place = |i: usize| (i as f64 + 0.5) / SAMPLES as f64 - 0.5;
        let mut sum = 0.0;
        for row in 0..SAMPLES {
            for column in 0..SAMPLES {
                let point = PixelPoint::new(x as f64 + place(column), y as f64 + place(row));
                if let Some(ray) = self.projection.unproject(point) {
                    sum += sphere.radiance(ray.vector());
                }
            }
        }
        sum / (SAMPLES * SAMPLES) as f64
    }

    fn read_out(&self, image: &mut ExpectedImage, frame: u64, exposure_s: f64) -> Result<Frame, Failure> {
        let seed = Seed { seed: self.scenario.seed, case: 0 };
        let mut raw = self.sensor.new_raw();
        let interval = ExposureInterval { seed, middle_s: frame as f64, exposure_s };
        let charge = self.sensor.collect(image, &interval);
        let collected = FrameCharge { charge: &charge, seed, frame };
        self.sensor.read_out(&collected, &mut self.sensor.new_sampler(), &mut raw)?;
        let (columns, rows) = raw.size();
        Ok(Frame::new(frame, columns, rows, raw.bit_depth(), raw.dn().to_vec(), None)?)
    }
}

impl Sphere {
    /// Radiance along a ray of unit length from the camera: the cosine of the angle between normal and Sun at
    /// the nearer intersection, 0 beside the body and on its night side.
    fn radiance(&self, ray: &Vector3<f64>) -> f64 {
        // |t r − c|² = s²: t = r·c − √((r·c)² − 1 + s²), in units of the distance.
        let along = ray.dot(&self.towards);
        let square = along * along - 1.0 + self.sine * self.sine;
        if square < 0.0 || along < 0.0 {
            return 0.0;
        }
        let normal = (ray * (along - square.sqrt()) - self.towards) / self.sine;
        normal.dot(&self.sun).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenario::run_file::ScenarioFile;
    use std::path::Path;

    fn imager(edit: impl FnOnce(&mut MiddleRangeScenario)) -> Imager {
        let mut scenario = MiddleRangeScenario::parse(Path::new(""), crate::STARTING_POINT).unwrap();
        edit(&mut scenario);
        scenario.check().unwrap();
        Imager::new(&scenario).unwrap()
    }

    /// The mean of n·s over the disk of a Lambert sphere at full phase is 2/3 from afar, and to first order
    /// more by half its radius over its distance: √(1 − u²) + u² R/d at u radii from the centre.
    #[test]
    fn a_full_sphere_has_two_thirds_of_the_light_of_a_disk() {
        let imager = imager(|scenario| {
            scenario.body.phase_deg = 0.0;
            scenario.approach.wander_deg = 0.0;
        });
        let frame = imager.scenario.approach.frames - 1;
        let sphere = imager.sphere(frame);
        let centre = imager.projection.project(&Direction::from_unit(sphere.towards)).unwrap();
        let (_, truth) = imager.expose(frame, 0.01).unwrap();
        let mut image = imager.sensor.new_expected();
        image.clear(0.0);
        imager.paint(&mut image, &sphere, centre, truth.radius_px, 1.0);
        let light: f64 = image.iter().sum();
        let (across, along) = imager.projection.plate_scale_px_per_rad();
        let area = std::f64::consts::PI * truth.radius_px * truth.radius_px * along / across;
        let disk = imager.scenario.body.electrons_per_s * area;
        let expected = 2.0 / 3.0 + 0.5 * sphere.sine;
        assert!((light / disk - expected).abs() < 0.002, "{} and {expected}", light / disk);
    }

    #[test]
    fn a_frame_depends_on_number_and_exposure_alone() {
        let (a, b) = (imager(|_| ()), imager(|_| ()));
        b.expose(3, 0.5).unwrap();
        let alone = a.expose(7, 0.02).unwrap();
        assert_eq!(alone, b.expose(7, 0.02).unwrap());
        assert_ne!(alone.0, a.expose(7, 0.03).unwrap().0);
    }
}
