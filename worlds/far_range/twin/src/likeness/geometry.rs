//! Geometry of the cameras that both sets of frames give.

use camera_fit::CameraFit;
use camera_fit::adjustment::Term;

use super::difference::{Likeness, NotCompared, Unit};
use super::estimate::Estimate;

/// Compares the terms of two fitted cameras.
///
/// # Errors
/// In the second list: the terms that one of the sets does not determine.
pub(crate) fn likenesses(camera: &CameraFit, twin: &CameraFit) -> (Vec<Likeness>, Vec<NotCompared>) {
    let (mut figures, mut missing) = (Vec::new(), Vec::new());
    for term in Term::ALL {
        let (code, name, unit) = description(term);
        match (estimate(camera, term), estimate(twin, term)) {
            (Some(first), Some(second)) if term == Term::FocalLength => {
                figures.push(Likeness::of_difference(code, name, unit, relative(first, second)));
            }
            (Some(first), Some(second)) => figures.push(Likeness::new(code, name, unit, [first, second])),
            _ => missing.push(NotCompared { name, reason: "the stars do not determine it".to_owned() }),
        }
    }
    (figures, missing)
}

fn description(term: Term) -> (&'static str, &'static str, Unit) {
    match term {
        Term::FocalLength => ("focal_length", "focal length", Unit::Percent),
        Term::PrincipalX => ("principal_x", "principal point x", Unit::Pixels),
        Term::PrincipalY => ("principal_y", "principal point y", Unit::Pixels),
        Term::Radial1 => ("k1", "k1 in the corner", Unit::Pixels),
        Term::Radial2 => ("k2", "k2 in the corner", Unit::Pixels),
        Term::Radial3 => ("k3", "k3 in the corner", Unit::Pixels),
        Term::Tangential1 => ("p1", "p1 in the corner", Unit::Pixels),
        Term::Tangential2 => ("p2", "p2 in the corner", Unit::Pixels),
    }
}

/// Returns a term in its unit; `None` if the stars do not determine it. A coefficient of distortion is stated
/// as the displacement that it causes at half the diagonal of the detector from the principal point.
fn estimate(fit: &CameraFit, term: Term) -> Option<Estimate> {
    let (_, sigma, is_determined) = fit.sigmas.iter().find(|(of, _, _)| *of == term)?;
    let half_diagonal_px = 0.5 * libm::hypot(fit.camera.columns as f64, fit.camera.rows as f64);
    let power = match term {
        Term::FocalLength | Term::PrincipalX | Term::PrincipalY => 0.0,
        Term::Tangential1 | Term::Tangential2 => 2.0,
        Term::Radial1 => 3.0,
        Term::Radial2 => 5.0,
        Term::Radial3 => 7.0,
    };
    let factor = libm::pow(half_diagonal_px, power);
    is_determined.then(|| Estimate::known(factor * term.parameter(&fit.camera), factor * sigma))
}

/// Returns the relative difference of two focal lengths, percent.
fn relative(camera: Estimate, twin: Estimate) -> Estimate {
    let sigma = libm::hypot(camera.sigma / camera.value, twin.sigma / twin.value);
    Estimate::known(100.0 * (twin.value / camera.value - 1.0), 100.0 * sigma)
}
