//! The far range on the page of the monitor.

mod report;

use std::any::Any;
use std::path::Path;

use ::monitor::camera;
use ::monitor::feed::{Measurements, MonitorContext, MonitoredWorld, Serve, frames, optional};
use ::monitor::ground::GroundTrack;
use ::monitor::plan::Plan;
use ::monitor::session::Session;
use ::monitor::session::picture::Stretch;
use far_range::rows::{FrameCluster, FrameTruthRow, ObjectTruthRow, read_measurements};
use far_range::{FarRangeMission, SceneTruth};
use files::{Failure, TableReader};
use hifitime::Epoch;
use run::WorldScenario as _;
use serde_json::{Value, json};
use sim::truth::ObjectTruth;

use self::report::{FarRangeReporter, range_and_rate};

/// Playback rate of a sequence, frames per second; the true cadence is many seconds per frame.
const RATE_HZ: f64 = 25.0;
/// Smallest half width of the corridor, m/s.
const MARGIN_M_S: f64 = 0.1;
/// Number of plotted points of the relative orbit.
const ORBIT_POINTS: u64 = 3000;

/// Takes a mission of this world.
pub(crate) fn cast(mission: Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>> {
    let mission = mission.downcast::<FarRangeMission>()?;
    Ok(Box::new(Monitored(*mission)))
}

/// A mission that the page shows.
struct Monitored(FarRangeMission);

impl MonitoredWorld for Monitored {
    fn context(&self, measurements: &Measurements) -> Result<MonitorContext, Failure> {
        let scenario = self.0.scenario();
        Ok(MonitorContext {
            ground: Some(GroundTrack::Chaser(Box::new(scenario.trajectory()?))),
            stretch: Stretch::from_range(scenario.sensor.bias_dn, scenario.sensor.full_scale_dn()),
            frames: frames::<FrameTruthRow>(measurements, FarRangeMission::FACTS.truth_file)?,
        })
    }

    fn time(&self, frame: u64) -> Option<Epoch> {
        self.0.simulator().schedule().frame(frame).map(|(_, time)| time)
    }

    fn overview(&self, measurements: &Measurements, context: &MonitorContext) -> Result<[Value; 2], Failure> {
        let scenario = self.0.scenario();
        let schedule = self.0.simulator().schedule();
        let trajectory = scenario.trajectory()?;
        let frames = &context.frames;
        let at = |frame| schedule.frame(frame).map(|(_, time)| time);
        let plan = Plan::new("km", frames, MARGIN_M_S, |frame| {
            at(frame).map(|time| range_and_rate(&trajectory, time))
        });
        let radius_km = at(frames.start).map(|time| trajectory.states_at(time).target.position_km.norm());
        let step = ((frames.end - frames.start) / ORBIT_POINTS).max(1);
        let orbit: Vec<(u64, [f64; 3])> = frames
            .clone()
            .step_by(usize::try_from(step).unwrap_or(usize::MAX))
            .filter_map(|frame| {
                at(frame).map(|time| (frame, trajectory.states_at(time).chaser_rtn_km().into()))
            })
            .collect();
        // The camera took no images between one day and the next: no line spans that time.
        let begins: Vec<u64> = schedule.sequences().map(|day| day.frames.start).collect();
        let session = json!({
            "world": FarRangeMission::CODE,
            "title": scenario.title,
            "seed": scenario.seed,
            "mode": measurements.mode(),
            "rate_hz": RATE_HZ,
            "cameras": [camera("", &scenario.camera)],
            "plan": plan,
            "begins": begins,
            "orbit_rtn_km": orbit,
            "orbit_radius_km": radius_km,
            "notes": [],
        });
        Ok([session, json!({ "facets": [] })])
    }

    fn feed(
        &self,
        measurements: &Measurements,
        context: &MonitorContext,
        session: &Session,
    ) -> Result<(), Failure> {
        let Some(ground) = &context.ground else { return Ok(()) };
        let Some(start) = self.time(0) else { return Ok(()) };
        let trajectory = &self.0.scenario().trajectory()?;
        let reporter = FarRangeReporter { camera: &self.0.scenario().camera, trajectory, ground, start };
        match measurements {
            Measurements::Live { factory, frames, jobs } => {
                run::sequence::follow(&self.0, frames.clone(), *jobs, factory.downcast()?, |processed| {
                    let SceneTruth { frame: truth, objects } = &processed.truth;
                    session.wait_for_goal(truth.frame)?;
                    let report = reporter.report(truth, objects, Some(&processed.outcome));
                    let picture = context.stretch.picture(&processed.image);
                    session.publish(&report, Value::Null, Some(picture))
                })
            }
            Measurements::Replay(directory) => replay(directory, &reporter, session),
        }
    }

    fn paint(&self, context: &MonitorContext, serve: Serve<'_>) -> Result<(), Failure> {
        let mut camera = self.0.simulator().camera()?;
        serve(&mut |order| Ok(context.stretch.picture(&camera.expose(order.frame)?.frame)))
    }
}

fn replay(directory: &Path, reporter: &FarRangeReporter<'_>, session: &Session) -> Result<(), Failure> {
    let mut objects = TableReader::<ObjectTruthRow>::open(&directory.join("truth/objects.parquet"))?;
    let mut clusters = optional(&directory.join("clusters.parquet"))
        .map(|path| TableReader::<FrameCluster>::open(&path))
        .transpose()?;
    let mut answers =
        read_measurements(&directory.join("measurements.csv"), reporter.camera)?.into_iter().peekable();
    for row in TableReader::<FrameTruthRow>::open(&directory.join("truth/frames.parquet"))? {
        let (number, truths) = row?;
        session.wait_for_goal(number)?;
        let objects: Vec<ObjectTruth> = objects.rows_of(number)?.into_iter().map(|row| row.0).collect();
        let found = clusters.as_mut().map(|table| table.rows_of(number)).transpose()?.unwrap_or_default();
        let answer = answers.next_if(|(answered, _)| *answered == number).map(|(_, mut outcome)| {
            outcome.clusters = found.into_iter().map(|row| row.cluster).collect();
            outcome
        });
        for truth in truths.iter().take(1) {
            let report = reporter.report(&truth.0, &objects, answer.as_ref());
            session.publish(&report, Value::Null, None)?;
        }
    }
    Ok(())
}
