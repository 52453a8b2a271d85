//! Reports of docking fields for the monitor.
use std::collections::BTreeMap;

use ::monitor::ground::GroundTrack;
use ::monitor::report::{CameraPose, Fact, FrameReport, ImageLayout, Parameter, Phase, Shape};
use contract::docking::{DockingOutcome, DockingSetup, DockingSolution, Lines, Motion, Pose};
use docking::DockingMission;
use docking::rows::FeatureRow;
use docking::scoring::ApproachParameters;
use files::format_utc;
use run::WorldScenario as _;
use serde_json::json;
use sim::docking::FieldTruth;
use sim::truth::approach::target_from_camera;

/// Arm length of a cross of unknown size, px of the image.
const PLAIN_ARM_PX: f64 = 14.0;
/// Half side of the box around a mark, px.
const MARK_PX: f64 = 6.0;

/// Makes the reports of consecutive fields; the result of a portion remains valid until the next portion.
pub(crate) struct DockingReporter<'a> {
    setup: &'a DockingSetup,
    names: Vec<String>,
    ground: Option<&'a GroundTrack>,
    portion: Option<Portion>,
}

/// Result at the end of the last portion, with the truth at that time.
struct Portion {
    shown: ApproachParameters,
    sigmas: Option<[f64; 7]>,
    truth: ApproachParameters,
}

impl<'a> DockingReporter<'a> {
    /// Creates a reporter for cameras with the given names.
    pub(crate) fn new(setup: &'a DockingSetup, names: Vec<String>, ground: Option<&'a GroundTrack>) -> Self {
        Self { setup, names, ground, portion: None }
    }

    /// Returns the report of the next field. `features` are the rows of `features.parquet`; `outcome` is
    /// `None` for a field that the pipeline did not report.
    pub(crate) fn report(
        &mut self,
        truth: &FieldTruth,
        outcome: Option<&DockingOutcome>,
        features: &[FeatureRow],
    ) -> FrameReport {
        if let Some(motion) = outcome.and_then(|outcome| outcome.motion.as_ref()?.best.as_ref()) {
            self.portion = Some(Portion {
                shown: ApproachParameters::from_motion(&motion.pose, &motion.velocity_m_s),
                sigmas: ApproachParameters::sigmas(motion),
                truth: true_at(truth, motion),
            });
        }
        let measured = outcome.and_then(DockingOutcome::any_measurement).map(|measured| &measured.best);
        let mut parameters = pose_parameters(
            &BEST,
            measured.map(|best| &best.pose),
            measured.map(|best| [0, 1, 2, 3, 4, 5].map(|i| best.covariance[(i, i)].max(0.0).sqrt())),
            &truth.pose,
        );
        if let Some(DockingOutcome { solution: DockingSolution::RangeOnly { range_m, sigma_m }, .. }) =
            outcome
        {
            parameters.push(Parameter {
                section: "Range from outline",
                name: "range_m",
                label: "d₃",
                unit: "m",
                decimals: 2,
                measured: Some(*range_m),
                sigma: Some(*sigma_m),
                truth: Some(truth.pose.position_m.z),
            });
        }
        parameters.extend(self.portion_parameters());
        let paper =
            outcome.and_then(DockingOutcome::measurement).and_then(|measured| measured.paper.as_ref());
        parameters.extend(pose_parameters(&PAPER, paper, None, &truth.pose));
        FrameReport {
            frame: truth.field,
            time_utc: format_utc(truth.time),
            elapsed_s: truth.time_s,
            group: String::new(),
            image: self.layout(truth),
            status: status(outcome),
            parameters,
            facts: self.facts(truth, features),
            overlay: self.recognised(features),
            truth_overlay: self.true_positions(truth),
            phase: Phase {
                measured: self.portion.as_ref().map(|portion| [portion.shown.rho_m, portion.shown.u_m_s]),
                truth: [truth.range_m, truth.range_rate_m_s],
            },
            ground: self.ground.and_then(|track| track.ground_at(truth.time)),
            // In the target frame, m.
            model: json!({
                "world": DockingMission::CODE,
                "camera": truth.camera,
                "measured": measured.map(|best| view(&best.pose)),
                "truth": view(&truth.pose),
                "sun": truth.sun.map(<[f64; 3]>::from),
            }),
        }
    }

    fn layout(&self, truth: &FieldTruth) -> ImageLayout {
        let (columns, camera_rows) =
            self.setup.cameras.get(truth.camera).map_or((0, 0), |camera| (camera.columns, camera.rows));
        ImageLayout {
            columns,
            rows: truth.lines.rows(camera_rows),
            first_row: usize::from(truth.lines == Lines::Odd),
            row_step: truth.lines.step(),
            camera_rows,
        }
    }

    fn facts(&self, truth: &FieldTruth, features: &[FeatureRow]) -> Vec<Fact> {
        let mut marks: BTreeMap<&str, usize> = BTreeMap::new();
        for mark in features.iter().filter(|feature| feature.kind == "mark") {
            *marks.entry(&mark.usage).or_default() += 1;
        }
        let used = marks.get("used").copied().unwrap_or(0);
        let camera = self.names.get(truth.camera).map_or("", String::as_str);
        vec![
            Fact { label: "Camera", value: camera.to_owned() },
            Fact { label: "Rows", value: truth.lines.code().to_owned() },
            Fact { label: "Marks used", value: format!("{used} of {}", self.setup.target.marks.len()) },
        ]
    }

    fn recognised(&self, features: &[FeatureRow]) -> Vec<Shape> {
        let model = &self.setup.target;
        let arm_px = features
            .iter()
            .find(|feature| feature.kind == "circle")
            .and_then(|circle| circle.radius_px)
            .map(|radius| radius * model.cross.half_length_m / model.mark_circle_radius_m);
        let shape = |feature: &FeatureRow| {
            let kind = feature.kind.as_str();
            match (kind, feature.radius_px) {
                ("mark", _) => {
                    Shape::new("box", &format!("mark {}", feature.usage), feature.position, MARK_PX)
                }
                (_, Some(radius)) => Shape::new("circle", kind, feature.position, radius),
                _ => Shape {
                    slope: feature.slope,
                    ..Shape::new("cross", kind, feature.position, arm_px.unwrap_or(PLAIN_ARM_PX))
                },
            }
        };
        features.iter().map(shape).collect()
    }

    fn true_positions(&self, truth: &FieldTruth) -> Vec<Shape> {
        let cross = truth.cross_centre.map(|p| Shape::new("cross", "truth", [p.x, p.y], PLAIN_ARM_PX));
        let circle = truth
            .disk_centre
            .zip(truth.circle_radius_px)
            .map(|(p, radius)| Shape::new("circle", "truth", [p.x, p.y], radius));
        let glint = truth.glint.as_ref().map(|glint| {
            let place = [glint.centre.x, glint.centre.y];
            Shape { label: "glint".to_owned(), ..Shape::new("box", "truth", place, MARK_PX) }
        });
        cross.into_iter().chain(circle).chain(glint).collect()
    }

    fn portion_parameters(&self) -> impl Iterator<Item = Parameter> {
        const ROWS: [(&str, &str, &str, u8); 4] = [
            ("rho_m", "ρ range", "m", 4),
            ("u_m_s", "u range rate", "m/s", 4),
            ("alpha_deg", "α passive pitch", "°", 3),
            ("beta_deg", "β passive yaw", "°", 3),
        ];
        let four = |shown: &ApproachParameters| {
            [shown.rho_m, shown.u_m_s, shown.alpha_rad.to_degrees(), shown.beta_rad.to_degrees()]
        };
        let measured = self.portion.as_ref().map(|portion| four(&portion.shown));
        let truth = self.portion.as_ref().map(|portion| four(&portion.truth));
        let sigmas = self.portion.as_ref().and_then(|portion| portion.sigmas);
        ROWS.into_iter().enumerate().map(move |(i, (name, label, unit, decimals))| Parameter {
            section: "Portion, best estimator",
            name,
            label,
            unit,
            decimals,
            measured: measured.map(|values| values[i]),
            sigma: sigmas.map(|values| if unit == "°" { values[i].to_degrees() } else { values[i] }),
            truth: truth.map(|values| values[i]),
        })
    }
}

/// Returns the truth at the time of the motion: the truth of the reporting field, extrapolated at constant
/// velocity.
fn true_at(truth: &FieldTruth, motion: &Motion) -> ApproachParameters {
    let seconds = motion.time_s - truth.time_s;
    let pose = Pose {
        position_m: truth.pose.position_m + truth.velocity_m_s * seconds,
        phi_rad: truth.pose.phi_rad + truth.phi_rate_rad_s * seconds,
    };
    ApproachParameters::from_motion(&pose, &truth.velocity_m_s)
}

/// A section of six parameters: its title, and the name and label of each parameter.
type Section = (&'static str, [(&'static str, &'static str); 6]);

const BEST: Section = (
    "Field, best estimator",
    [
        ("d1_m", "d₁"),
        ("d2_m", "d₂"),
        ("d3_m", "d₃"),
        ("phi1_deg", "φ₁ pitch"),
        ("phi2_deg", "φ₂ yaw"),
        ("phi3_deg", "φ₃ roll"),
    ],
);
const PAPER: Section = (
    "Field, paper's formulas",
    [
        ("paper_d1_m", "d₁"),
        ("paper_d2_m", "d₂"),
        ("paper_d3_m", "d₃"),
        ("paper_phi1_deg", "φ₁ pitch"),
        ("paper_phi2_deg", "φ₂ yaw"),
        ("paper_phi3_deg", "φ₃ roll"),
    ],
);

fn pose_parameters(
    (section, rows): &Section,
    pose: Option<&Pose>,
    sigmas: Option<[f64; 6]>,
    truth: &Pose,
) -> Vec<Parameter> {
    let six = |pose: &Pose| {
        let (d, phi) = (&pose.position_m, &pose.phi_rad);
        [d.x, d.y, d.z, phi.x.to_degrees(), phi.y.to_degrees(), phi.z.to_degrees()]
    };
    let (measured, truth) = (pose.map(six), six(truth));
    let row = |(i, &(name, label)): (usize, &(&'static str, &'static str))| {
        let is_angle = i >= 3;
        Parameter {
            section,
            name,
            label,
            unit: if is_angle { "°" } else { "m" },
            decimals: if is_angle { 3 } else { 4 },
            measured: measured.map(|values| values[i]),
            sigma: sigmas.map(|values| if is_angle { values[i].to_degrees() } else { values[i] }),
            truth: Some(truth[i]),
        }
    };
    rows.iter().enumerate().map(row).collect()
}

fn status(outcome: Option<&DockingOutcome>) -> String {
    match outcome.map(|outcome| &outcome.solution) {
        Some(DockingSolution::Measured(_)) => "measured".to_owned(),
        Some(DockingSolution::Doubtful { doubt, .. }) => doubt.to_string(),
        Some(DockingSolution::RangeOnly { .. }) => "range_only".to_owned(),
        Some(DockingSolution::NoSolution(reason)) => reason.to_string(),
        None => "not_reported".to_owned(),
    }
}

fn view(pose: &Pose) -> CameraPose {
    let axes = target_from_camera(pose);
    CameraPose {
        position: pose.position_m.into(),
        axes: [0, 1, 2].map(|axis| axes.column(axis).into_owned().into()),
    }
}
