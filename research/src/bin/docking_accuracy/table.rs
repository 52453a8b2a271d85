//! Errors of poses, and their table.

use std::error::Error;
use std::fmt;
use std::fmt::Write as _;
use std::path::Path;

use contract::docking::Pose;
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::bound::Bound;

pub(crate) const HEADING: &str = "\
Errors: range, % of it; lateral, mm (root mean square of d1 and d2, per axis); φ1, φ2, degrees (per axis).
rms over all answers; p68: the value that 68 % of the absolute errors are below (σ of a normal law, outliers apart).
best: the pipeline on the frame alone; near: its best estimator begun where OpenCV is begun; paper: the paper's formulas.
bound: Cramér–Rao, 1 plate, marks and cross, 2 without the plate's rim, levels and blur known in both; 3 as posed, levels and
blur unknown, the yardstick; best/3: times the yardstick. NEES: mean over the answers, divided by 6.
row         method  answered       rms: range %  lateral mm  φ1,2 °       p68: range %  lateral mm  φ1,2 °    NEES/6";

/// Truth of a frame, and the answer of a method.
pub(crate) struct Answer {
    pub(crate) truth: Pose,
    pub(crate) pose: Option<Pose>,
    pub(crate) covariance: Option<Matrix6<f64>>,
}

impl Answer {
    /// Error of (d1, d2, d3, φ1, φ2, φ3), m and rad.
    fn error(&self) -> Option<Vector6<f64>> {
        let estimate = self.pose?;
        let d = estimate.position_m - self.truth.position_m;
        let phi = estimate.phi_rad - self.truth.phi_rad;
        Some(Vector6::new(d.x, d.y, d.z, phi.x, phi.y, phi.z))
    }

    fn range_error(&self) -> Option<f64> {
        let range_m = self.truth.position_m.norm();
        Some((self.pose?.position_m.norm() - range_m) / range_m)
    }

    /// Normalised estimation error squared of the six parameters, not divided by 6.
    fn nees(&self) -> Option<f64> {
        let error = self.error()?;
        Some(error.dot(&(self.covariance?.try_inverse()? * error)))
    }
}

/// Writes the errors frame by frame: range and NEES, and the errors in units of the bound, to help find
/// outliers.
pub(crate) fn write_errors(
    path: &Path,
    methods: &[(&str, &[Answer])],
    bounds: &[Bound],
) -> Result<(), Box<dyn Error>> {
    let mut text = String::from(
        "method,frame,range_percent,lateral_mm,phi12_deg,range_per_bound,lateral_per_bound,phi12_per_bound,nees\n",
    );
    for (method, answers) in methods {
        for (frame, (answer, bound)) in answers.iter().zip(bounds).enumerate() {
            let (Some(error), Some(range)) = (answer.error(), answer.range_error()) else {
                writeln!(text, "{method},{frame},,,,,,,")?;
                continue;
            };
            let lateral = (0.5 * (error[0] * error[0] + error[1] * error[1])).sqrt();
            let angle = (0.5 * (error[3] * error[3] + error[4] * error[4])).sqrt();
            writeln!(
                text,
                "{method},{frame},{:.6},{:.5},{:.6},{:.3},{:.3},{:.3},{:.2}",
                100.0 * range,
                1e3 * lateral,
                angle.to_degrees(),
                range / bound.range.sqrt(),
                lateral / bound.lateral_m2.sqrt(),
                angle / bound.angle_rad2.sqrt(),
                answer.nees().unwrap_or(f64::NAN),
            )?;
        }
    }
    std::fs::write(path, text)?;
    Ok(())
}

/// Range, %; lateral, mm; φ1,2, degrees.
type Figures = [f64; 3];

/// Line of the table.
pub(crate) struct Line {
    row: &'static str,
    method: &'static str,
    answered: Option<(usize, usize)>,
    rms: Figures,
    p68: Option<Figures>,
    nees: Option<f64>,
}

impl Line {
    pub(crate) fn from_answers(row: &'static str, method: &'static str, answers: &[Answer]) -> Self {
        let mut errors: [Vec<f64>; 3] = Default::default();
        for answer in answers {
            let (Some(error), Some(range)) = (answer.error(), answer.range_error()) else { continue };
            errors[0].push(100.0 * range);
            errors[1].extend([1e3 * error[0], 1e3 * error[1]]);
            errors[2].extend([error[3].to_degrees(), error[4].to_degrees()]);
        }
        let answered = Some((errors[0].len(), answers.len()));
        let nees: Vec<f64> = answers.iter().filter_map(Answer::nees).collect();
        let nees = (!nees.is_empty()).then(|| nees.iter().sum::<f64>() / (6 * nees.len()) as f64);
        Self {
            row,
            method,
            answered,
            rms: errors.each_ref().map(|e| rms(e)),
            p68: Some(errors.map(p68)),
            nees,
        }
    }

    pub(crate) fn from_bounds(row: &'static str, method: &'static str, bounds: &[Bound]) -> Self {
        let mean =
            |of: &dyn Fn(&Bound) -> f64| (bounds.iter().map(of).sum::<f64>() / bounds.len() as f64).sqrt();
        let rms =
            [100.0 * mean(&|b| b.range), 1e3 * mean(&|b| b.lateral_m2), mean(&|b| b.angle_rad2).to_degrees()];
        Self { row, method, answered: None, rms, p68: None, nees: None }
    }

    /// Ratio of a method's figures to those of a bound.
    pub(crate) fn over(&self, bound: &Line) -> Self {
        let rms = std::array::from_fn(|i| self.rms[i] / bound.rms[i]);
        Self { row: self.row, method: "best/3", answered: None, rms, p68: None, nees: None }
    }
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

fn p68(errors: Vec<f64>) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let place = (0.6827 * sizes.len() as f64) as usize;
    sizes.get(place).copied().unwrap_or(f64::NAN)
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let figures = |figures: &Figures| {
            if figures[0].is_nan() {
                return format!("{:>12} {:>11} {:>8}", "-", "-", "-");
            }
            format!("{:>12.4} {:>11.3} {:>8.4}", figures[0], figures[1], figures[2])
        };
        let answered = self.answered.map_or_else(String::new, |(n, of)| format!("{n}/{of}"));
        write!(f, "{:<11} {:<7} {:>8}       {}", self.row, self.method, answered, figures(&self.rms))?;
        if let Some(p68) = &self.p68 {
            write!(f, "       {}", figures(p68))?;
        }
        self.nees.map_or(Ok(()), |nees| write!(f, "{nees:>10.2}"))
    }
}

/// Reads the poses that a script wrote: `frame` and six columns, empty if the script has no answer.
pub(crate) fn read_poses(path: &Path, count: usize) -> Result<Vec<Option<Pose>>, Box<dyn Error>> {
    let mut poses = vec![None; count];
    for record in csv::Reader::from_path(path)?.records() {
        let record = record?;
        let frame: usize = record.get(0).unwrap_or("").parse()?;
        let numbers: Vec<f64> = record.iter().skip(1).filter_map(|cell| cell.parse().ok()).collect();
        if let (Some(pose), [d1, d2, d3, phi1, phi2, phi3]) = (poses.get_mut(frame), numbers.as_slice()) {
            *pose = Some(Pose {
                position_m: Vector3::new(*d1, *d2, *d3),
                phi_rad: Vector3::new(*phi1, *phi2, *phi3),
            });
        }
    }
    Ok(poses)
}
