//! Errors of poses, and how they are shown.

use std::error::Error;
use std::fmt;
use std::path::Path;

use contract::docking::Pose;
use nalgebra::Vector3;

use crate::bound::Bound;

pub(crate) const HEADING: &str = "\
Errors: range, % of it; lateral, mm (root mean square of d1 and d2, per axis); φ1, φ2, degrees (per axis).
rms over all answers; p68: the value that 68 % of the absolute errors are below (σ of a normal law, outliers apart).
bound: Cramér–Rao, plate, marks and cross; no rim: of marks and cross alone.
row         method  answered       rms: range %  lateral mm  φ1,2 °       p68: range %  lateral mm  φ1,2 °";

/// The truth of a frame, and what a method says.
pub(crate) struct Answer {
    pub(crate) truth: Pose,
    pub(crate) estimate: Option<Pose>,
}

/// Range %, lateral mm, φ1,2 degrees.
type Figures = [f64; 3];

/// A line of the table.
pub(crate) struct Line {
    row: &'static str,
    method: &'static str,
    answered: Option<(usize, usize)>,
    rms: Figures,
    p68: Option<Figures>,
}

impl Line {
    pub(crate) fn of_answers(row: &'static str, method: &'static str, answers: &[Answer]) -> Self {
        let mut errors: [Vec<f64>; 3] = Default::default();
        for (truth, estimate) in answers.iter().filter_map(|a| Some((&a.truth, a.estimate.as_ref()?))) {
            let d = estimate.position_m - truth.position_m;
            let phi = estimate.phi_rad - truth.phi_rad;
            let range_m = truth.position_m.norm();
            errors[0].push(100.0 * (estimate.position_m.norm() - range_m) / range_m);
            errors[1].extend([1e3 * d.x, 1e3 * d.y]);
            errors[2].extend([phi.x.to_degrees(), phi.y.to_degrees()]);
        }
        let answered = Some((errors[0].len(), answers.len()));
        Self { row, method, answered, rms: errors.each_ref().map(|e| rms(e)), p68: Some(errors.map(p68)) }
    }

    pub(crate) fn of_bounds(row: &'static str, method: &'static str, bounds: &[Bound]) -> Self {
        let mean =
            |of: &dyn Fn(&Bound) -> f64| (bounds.iter().map(of).sum::<f64>() / bounds.len() as f64).sqrt();
        let rms =
            [100.0 * mean(&|b| b.range), 1e3 * mean(&|b| b.lateral_m2), mean(&|b| b.angle_rad2).to_degrees()];
        Self { row, method, answered: None, rms, p68: None }
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
        self.p68.as_ref().map_or(Ok(()), |p68| write!(f, "       {}", figures(p68)))
    }
}

/// Reads the poses of a script: `frame` and six columns, empty where it has no answer.
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
