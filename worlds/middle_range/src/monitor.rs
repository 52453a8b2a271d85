//! The world on the page of the monitor.

use std::any::Any;
use std::path::Path;

use ::monitor::camera;
use ::monitor::feed::{Measurements, MonitorContext, MonitoredWorld, Serve, frames};
use ::monitor::plan::Plan;
use ::monitor::report::{CameraPose, Fact, FrameReport, ImageLayout, Parameter, Phase, Shape};
use ::monitor::session::Session;
use ::monitor::session::picture::Stretch;
use contract::Camera;
use files::{Failure, format_utc};
use hifitime::{Epoch, Unit};
use run::plain::{Plain, PlainWorld, Scored, read_scored};
use run::{WorldFrames as _, WorldScenario as _};
use serde_json::{Value, json};

use crate::rows::{Answer, Truth};
use crate::world::MiddleRange;

/// Rate at which the page plays the frames, Hz.
const RATE_HZ: f64 = 4.0;
/// Smallest half width of the corridor, m/s: the scenario states no times, and a frame counts as a second.
const MARGIN_M_S: f64 = 0.5;

/// Takes a mission of this world.
pub(crate) fn cast(mission: Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>> {
    let mission = mission.downcast::<Plain<MiddleRange>>()?;
    Ok(Box::new(Monitored(*mission)))
}

struct Monitored(Plain<MiddleRange>);

impl Monitored {
    /// Time of a frame, one second after another: the scenario states none.
    fn time_of(frame: u64) -> Epoch {
        Epoch::from_gregorian_utc_at_midnight(2000, 1, 1) + frame as f64 * Unit::Second
    }

    /// Range, km, and range rate, m/s, of a frame.
    fn range_and_rate(&self, frame: u64) -> [f64; 2] {
        let world = self.0.world();
        [world.range_km(frame), 1000.0 * (world.range_km(frame + 1) - world.range_km(frame))]
    }

    /// Returns the bodies in the axes of the camera, about the body, km.
    fn model(&self, frame: u64) -> Value {
        let world = self.0.world();
        let (towards, sun) = world.directions(frame);
        let position = towards.map(|component| -component * world.range_km(frame));
        json!({
            "world": Plain::<MiddleRange>::CODE,
            "truth": CameraPose { position, axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] },
            "radius_km": 1e-3 * self.0.scenario().body.radius_m,
            "sun": sun,
        })
    }

    fn report(&self, truth: &Truth, answer: Option<&Answer>) -> FrameReport {
        let Camera { columns, rows, .. } = self.0.scenario().camera;
        let row = |name, label, unit, decimals, measured, sigma, truth| Parameter {
            section: "Body",
            name,
            label,
            unit,
            decimals,
            measured,
            sigma,
            truth,
        };
        let centre = answer.and_then(|answer| answer.centre);
        let radius_px = answer.and_then(|answer| answer.radius_px);
        let range_km = answer.and_then(|answer| answer.range_km);
        let sigma_km = answer.and_then(|answer| answer.sigma_range_km);
        let disk = |kind: &str, at: Option<[f64; 2]>, radius: Option<f64>| {
            at.zip(radius).map(|(at, radius)| Shape::new("circle", kind, at, radius)).into_iter().collect()
        };
        let true_centre = truth.centre.map(|at| [at.x, at.y]);
        FrameReport {
            frame: truth.frame,
            time_utc: format_utc(Self::time_of(truth.frame)),
            elapsed_s: truth.frame as f64,
            group: String::new(),
            image: ImageLayout { columns, rows, first_row: 0, row_step: 1, camera_rows: rows },
            status: if range_km.is_some() { "measured" } else { "no_limb" }.to_owned(),
            parameters: vec![
                row("x_px", "x", "px", 2, centre.map(|[x, _]| x), None, true_centre.map(|[x, _]| x)),
                row("y_px", "y", "px", 2, centre.map(|[_, y]| y), None, true_centre.map(|[_, y]| y)),
                row("radius_px", "Radius", "px", 2, radius_px, None, Some(truth.radius_px)),
                row("range_km", "Range", "km", 4, range_km, sigma_km, Some(truth.range_km)),
            ],
            facts: vec![Fact { label: "Exposure", value: format!("{:.3} ms", 1000.0 * truth.exposure_s) }],
            overlay: disk("target", centre, radius_px),
            truth_overlay: disk("target", true_centre, Some(truth.radius_px)),
            phase: Phase { measured: None, truth: self.range_and_rate(truth.frame) },
            ground: None,
            model: self.model(truth.frame),
        }
    }
}

impl MonitoredWorld for Monitored {
    fn context(&self, measurements: &Measurements) -> Result<MonitorContext, Failure> {
        let sensor = &self.0.scenario().sensor;
        Ok(MonitorContext {
            ground: None,
            stretch: Stretch::from_range(sensor.bias_dn, sensor.full_scale_dn()),
            frames: frames::<Truth>(measurements, Plain::<MiddleRange>::FACTS.truth_file)?,
        })
    }

    fn time(&self, frame: u64) -> Option<Epoch> {
        (frame < self.0.frame_count()).then(|| Self::time_of(frame))
    }

    fn overview(&self, measurements: &Measurements, context: &MonitorContext) -> Result<[Value; 2], Failure> {
        let scenario = self.0.scenario();
        let plan = Plan::new("km", &context.frames, MARGIN_M_S, |frame| Some(self.range_and_rate(frame)));
        let session = json!({
            "world": Plain::<MiddleRange>::CODE,
            "title": scenario.title,
            "seed": scenario.seed,
            "mode": measurements.mode(),
            "rate_hz": RATE_HZ,
            "cameras": [camera("", &scenario.camera)],
            "plan": plan,
            "begins": [],
            "notes": ["The scenario states no times: a frame counts as a second."],
        });
        Ok([session, json!({ "facets": [] })])
    }

    fn feed(
        &self,
        measurements: &Measurements,
        context: &MonitorContext,
        session: &Session,
    ) -> Result<(), Failure> {
        match measurements {
            Measurements::Live { factory, frames, jobs } => {
                run::sequence::follow(&self.0, frames.clone(), *jobs, factory.downcast()?, |processed| {
                    session.wait_for_goal(processed.truth.frame)?;
                    let report = self.report(&processed.truth, processed.outcome.as_ref().ok());
                    let picture = context.stretch.picture(&processed.image);
                    session.publish(&report, json!(processed.truth.exposure_s), Some(picture))
                })
            }
            Measurements::Replay(directory) => self.replay(directory, session),
        }
    }

    fn paint(&self, context: &MonitorContext, serve: Serve<'_>) -> Result<(), Failure> {
        serve(&mut |order| {
            let (frame, _) = self.0.world().expose(order.frame, &order.settings.as_f64())?;
            Ok(context.stretch.picture(&frame))
        })
    }
}

impl Monitored {
    fn replay(&self, directory: &Path, session: &Session) -> Result<(), Failure> {
        for Scored { truth, answer } in
            read_scored::<MiddleRange>(directory, &directory.join("measurements.csv"))?
        {
            session.wait_for_goal(truth.frame)?;
            session.publish(&self.report(&truth, answer.as_ref()), json!(truth.exposure_s), None)?;
        }
        Ok(())
    }
}
