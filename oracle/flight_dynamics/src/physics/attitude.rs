//! Physics of the nodes of an attitude: neighbours must be a turn that a spacecraft can make.

use std::path::Path;

use files::FileError;
use nalgebra::Vector4;

use super::findings::{Findings, place};

/// Smallest deviation of a node from its neighbours that counts, rad: 15°.
const MIN_DEVIATION_RAD: f64 = 0.261_8;
/// Angular acceleration above which a single node is wrong, rad/s²: 5 °/s².
const MAX_ACCELERATION_RAD_S2: f64 = 0.087_3;
/// Rate of a turn above which a step between two steady attitudes is an error, rad/s: 20 °/s.
const MAX_STEP_RATE_RAD_S: f64 = 0.349;
/// Angle between neighbours above which the direction of the turn is ambiguous, rad: 120°.
const AMBIGUOUS_RAD: f64 = 2.094;
/// Deviation after a repair in which a slip is recognised, rad: 5°.
const REPAIRED_RAD: f64 = 0.087_3;
/// Jump of the attitude at a border of segments without a remark, rad: 5°.
const BORDER_RAD: f64 = 0.087_3;

/// Attitude at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointingNode {
    /// Seconds since an epoch of the caller.
    pub(crate) time_s: f64,
    /// Quaternion in the axes of the file, scalar first, normalised.
    pub(crate) wxyz: Vector4<f64>,
    /// Line of the node.
    pub(crate) line: u64,
}

/// Order or sign of the components of a quaternion that differs from that of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    ScalarFirstForLast,
    ScalarLastForFirst,
    Conjugate,
}

impl Order {
    const ALL: [Self; 3] = [Self::ScalarFirstForLast, Self::ScalarLastForFirst, Self::Conjugate];

    fn repair(self, wxyz: &Vector4<f64>) -> Vector4<f64> {
        let [w, x, y, z] = (*wxyz).into();
        match self {
            Self::ScalarFirstForLast => Vector4::new(x, y, z, w),
            Self::ScalarLastForFirst => Vector4::new(z, w, x, y),
            Self::Conjugate => Vector4::new(w, -x, -y, -z),
        }
    }

    fn in_words(self) -> &'static str {
        match self {
            Self::Conjugate => "the quaternion of the inverse rotation",
            _ => "the components of the quaternion are in another order",
        }
    }

    /// Returns the order that brings a quaternion to another one, if one of them does.
    fn find(wxyz: &Vector4<f64>, expected: &Vector4<f64>) -> Option<Self> {
        Self::ALL.into_iter().find(|order| angle(&order.repair(wxyz), expected) < REPAIRED_RAD)
    }
}

/// Largest difference between the sizes of components that have been exchanged.
const EXCHANGED: f64 = 0.03;

/// Returns true if two quaternions have components of the same sizes, in another order or with other signs.
fn has_exchanged_components(a: &Vector4<f64>, b: &Vector4<f64>) -> bool {
    let sorted = |wxyz: &Vector4<f64>| {
        let mut sizes: [f64; 4] = wxyz.abs().into();
        sizes.sort_by(f64::total_cmp);
        Vector4::from(sizes)
    };
    (sorted(a) - sorted(b)).amax() < EXCHANGED
}

/// Returns the angle of the turn between two attitudes, rad, 0 to π.
fn angle(a: &Vector4<f64>, b: &Vector4<f64>) -> f64 {
    let dot = a.dot(b);
    let b = if dot < 0.0 { -b } else { *b };
    4.0 * libm::atan2((a - b).norm(), (a + b).norm())
}

/// Returns the attitude midway in the turn from `a` to `b`, by the fraction of time.
fn between(a: &Vector4<f64>, b: &Vector4<f64>, fraction: f64) -> Vector4<f64> {
    let b = if a.dot(b) < 0.0 { -b } else { *b };
    let mix = a * (1.0 - fraction) + b * fraction;
    mix / mix.norm().max(f64::MIN_POSITIVE)
}

/// Checks the nodes of a segment: returns the findings.
///
/// # Errors
/// [`FileError::Value`] with the line of a node that its neighbours contradict, and of a step that no
/// spacecraft makes.
pub(crate) fn check_pointing(path: &Path, nodes: &[PointingNode]) -> Result<Vec<String>, FileError> {
    let mut findings = Findings::default();
    let isolated = nodes.windows(3).filter(|window| is_isolated(window)).count();
    // In a fast and steady turn every node looks isolated.
    if isolated > 0 && 3 * isolated <= nodes.len() {
        for window in nodes.windows(3) {
            report_isolated(path, window, &mut findings);
        }
    }
    for window in nodes.windows(2) {
        report_step(path, window, &mut findings);
    }
    report_ambiguous(path, nodes, &mut findings);
    findings.into_result()
}

/// Returns the deviation of the middle node from the turn of its neighbours, and that turn, rad.
fn deviation(window: &[PointingNode]) -> Option<(f64, f64, Vector4<f64>)> {
    let [before, node, after] = window else { return None };
    let fraction = (node.time_s - before.time_s) / (after.time_s - before.time_s);
    let expected = between(&before.wxyz, &after.wxyz, fraction);
    Some((angle(&node.wxyz, &expected), angle(&before.wxyz, &after.wxyz), expected))
}

fn is_isolated(window: &[PointingNode]) -> bool {
    deviation(window).is_some_and(|(off, turn, _)| off > MIN_DEVIATION_RAD + turn)
}

fn report_isolated(path: &Path, window: &[PointingNode], findings: &mut Findings) {
    let ([before, node, after], Some((off, _, expected))) = (window, deviation(window)) else { return };
    if !is_isolated(window) {
        return;
    }
    let is_exchanged = has_exchanged_components(&node.wxyz, &expected);
    let shortest_s = (node.time_s - before.time_s).min(after.time_s - node.time_s);
    let value = format!("{:.2}° off the attitudes before and after", off.to_degrees());
    // There and back with constant acceleration needs at least 4 times the deviation over the square of the
    // time.
    if is_exchanged || 4.0 * off / (shortest_s * shortest_s) > MAX_ACCELERATION_RAD_S2 {
        let slip = if is_exchanged {
            "its components are in another order or have other signs"
        } else {
            "this attitude, or its time, is wrong"
        };
        let expected = format!("an attitude between them; likely slip: {slip}");
        findings.refuse(FileError::value(path, place(Some(node.line)), "quaternion", value, expected));
    } else {
        findings.remark(path, Some(node.line), &format!("the quaternion is {value}"));
    }
}

/// Reports a step between two nodes that is a slip or faster than a spacecraft turns.
fn report_step(path: &Path, pair: &[PointingNode], findings: &mut Findings) {
    let [before, node] = pair else { return };
    let turn = angle(&before.wxyz, &node.wxyz);
    let rate = turn / (node.time_s - before.time_s);
    if turn < 2.0 * MIN_DEVIATION_RAD || rate < 0.1 * MAX_STEP_RATE_RAD_S {
        return;
    }
    let order = Order::find(&node.wxyz, &before.wxyz);
    let value = format!("a turn by {:.2}° at {:.2} °/s", turn.to_degrees(), rate.to_degrees());
    if rate > MAX_STEP_RATE_RAD_S {
        let slip = order.map_or("one of the two attitudes, or their times, are wrong", Order::in_words);
        let expected = format!("a turn at less than 20 °/s since the node before; likely slip: {slip}");
        findings.refuse(FileError::value(path, place(Some(node.line)), "quaternion", value, expected));
    } else if let Some(order) = order {
        let text = format!("the quaternion is {value} since the node before; {}?", order.in_words());
        findings.remark(path, Some(node.line), &text);
    }
}

/// Reports the largest turn between neighbours if its direction is ambiguous.
fn report_ambiguous(path: &Path, nodes: &[PointingNode], findings: &mut Findings) {
    let mut worst = (0.0, None);
    for pair in nodes.windows(2) {
        let [before, node] = pair else { continue };
        let turn = angle(&before.wxyz, &node.wxyz);
        if turn > AMBIGUOUS_RAD && turn > worst.0 {
            worst = (turn, Some(node.line));
        }
    }
    if let (turn, Some(line)) = worst {
        let text = format!(
            "the attitude turns by {:.1}° since the node before, so that the direction of the turn is \
             ambiguous; nodes closer in time are needed",
            turn.to_degrees()
        );
        findings.remark(path, Some(line), &text);
    }
}

/// Checks the jump of the attitude between two segments that meet: returns a remark.
pub(crate) fn check_pointing_border(
    path: &Path,
    before: &PointingNode,
    after: &PointingNode,
) -> Option<String> {
    let jump = angle(&before.wxyz, &after.wxyz);
    let mut findings = Findings::default();
    if after.time_s - before.time_s < 1e-6 && jump > BORDER_RAD {
        let text = format!("at the start of the segment the attitude jumps by {:.2}°", jump.to_degrees());
        findings.remark(path, Some(after.line), &text);
    }
    findings.remarks.pop()
}
