//! Conformance checks of docking pipelines.

use super::{Conformance, Input};
use crate::Frame;
use crate::docking::{
    Digitiser, Docking, DockingOutcome, DockingSetup, DockingSolution, Field, FieldTelemetry, Lines, Motion,
    MotionReport,
};

/// Function of column, row and full scale that returns the digital number of a pixel.
type Pattern = fn(usize, usize, u16) -> u16;

impl Conformance for Docking {
    fn inputs(setup: &DockingSetup) -> Vec<Input<Self>> {
        let Some(camera) = setup.cameras.first() else { return Vec::new() };
        let full_scale = (u32::MAX >> (32 - u32::from(setup.bit_depth))) as u16;
        let columns = camera.columns;
        let inputs: [(&'static str, u64, Lines, f64, Pattern); 10] = [
            ("an all-zero first field", 0, Lines::Even, 0.0, |_, _, _| 0),
            ("a flat field", 1, Lines::Odd, 0.02, |_, _, full| full / 3),
            ("a saturated field", 2, Lines::Even, 0.04, |_, _, full| full),
            ("a checkerboard", 3, Lines::Odd, 0.06, |x, y, full| if (x + y) % 2 == 0 { full } else { 0 }),
            ("a ramp", 4, Lines::Even, 0.08, |x, _, full| (x % (usize::from(full) + 1)) as u16),
            (
                "two fields of the same parity",
                6,
                Lines::Even,
                0.12,
                |_, y, full| if y % 40 < 20 { full } else { 0 },
            ),
            (
                "a progressive frame",
                7,
                Lines::All,
                0.14,
                |x, y, full| if x / 9 % 2 == y / 9 % 2 { full } else { 0 },
            ),
            ("a repeated time", 8, Lines::Even, 0.14, |x, _, full| if x % 50 < 5 { full } else { full / 5 }),
            (
                "a field hours later",
                9,
                Lines::Odd,
                20_000.0,
                |x, y, full| if x.abs_diff(y) < 4 { full } else { 0 },
            ),
            ("an earlier field", 10, Lines::Even, 0.2, |_, _, full| full / 7),
        ];
        let fields = inputs.into_iter().map(|(name, number, lines, time_s, dn)| {
            let rows = lines.rows(camera.rows);
            let image = (0..columns * rows).map(|i| dn(i % columns, i / columns, full_scale)).collect();
            let field = Frame::new(number, columns, rows, setup.bit_depth, image, None)
                .and_then(|image| Field::new(image, lines, camera.rows))
                .expect("the image is made with the camera's own size");
            // The later fields use the last camera, because the lens may change at any time.
            let camera = if number < 8 { 0 } else { setup.cameras.len() - 1 };
            (name, field, FieldTelemetry { time_s, camera, digitiser: Digitiser::default() })
        });
        fields.collect()
    }

    fn violation(outcome: &DockingOutcome, _: &DockingSetup) -> Option<String> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        match &outcome.solution {
            DockingSolution::Measured(measurement) | DockingSolution::Doubtful { measurement, .. } => {
                let best = &measurement.best;
                let poses = [Some(best.pose), measurement.paper];
                if !poses
                    .iter()
                    .flatten()
                    .all(|pose| finite(pose.position_m.as_slice()) && finite(pose.phi_rad.as_slice()))
                {
                    return Some(format!("a pose is not finite: {measurement:?}"));
                }
                if !finite(best.covariance.as_slice()) || best.covariance.diagonal().min() < 0.0 {
                    return Some(format!(
                        "a covariance is not finite or has a negative variance: {:?}",
                        best.covariance
                    ));
                }
            }
            DockingSolution::RangeOnly { range_m, sigma_m } => {
                if !(finite(&[*range_m, *sigma_m]) && *range_m > 0.0 && *sigma_m >= 0.0) {
                    return Some(format!(
                        "a range is not finite and above 0, or its σ not finite and at least 0: {range_m} \
                         m, {sigma_m} m"
                    ));
                }
            }
            DockingSolution::NoSolution(_) => {}
        }
        if outcome.motion.as_ref().is_some_and(|report| report.motions().next().is_none()) {
            return Some("a motion report contains no motion".to_owned());
        }
        let mut motions = outcome.motion.iter().flat_map(MotionReport::motions);
        if let Some(motion) = motions.find(|motion| !is_finite_motion(motion)) {
            return Some(format!("a motion is not finite: {motion:?}"));
        }
        let wish = outcome.digitiser.as_ref().and_then(|wish| wish.check().err());
        wish.map(|error| format!("the requested setting of the digitiser is out of range: {error}"))
    }
}

fn is_finite_motion(motion: &Motion) -> bool {
    let parts: [&[f64]; 8] = [
        &[motion.time_s],
        motion.pose.position_m.as_slice(),
        motion.pose.phi_rad.as_slice(),
        motion.velocity_m_s.as_slice(),
        motion.phi_rate_rad_s.as_slice(),
        motion.position_covariance.as_slice(),
        motion.attitude_covariance.as_slice(),
        motion.cross_covariance.as_slice(),
    ];
    parts.into_iter().flatten().all(|value| value.is_finite())
}
