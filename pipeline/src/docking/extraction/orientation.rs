//! Upright orientation of the target. Cross and marks are unchanged by a quarter turn, the docking unit is
//! not. Without the docking unit in the image the roll is known but for quarter turns, and is taken to be
//! within 45° of upright.

use contract::docking::TargetModel;

use super::docking_unit::{DiskEdge, Side};
use super::self_check;
use crate::docking::cross_and_circle::cross::CrossFit;
use crate::docking::cross_and_circle::marks::Plane;
use crate::docking::preprocessing::view::{Lens, View};

/// Evidence of one field for the target's orientation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Uprightness {
    /// The docking unit is on its nominal side.
    Upright,
    /// The docking unit is clearly seen on another side, and not on its nominal side.
    Turned,
    /// The docking unit is outside the field or not seen.
    Unknown,
}

/// Smallest share of directions in which the docking unit's edge must be seen on its nominal side.
const MIN_EDGE_SHARE: f64 = 0.4;

/// Smallest share of directions in which the docking unit's edge must be seen on another side. Higher than
/// [`MIN_EDGE_SHARE`], because other structures on the station have edges too.
const SEEN_ELSEWHERE: f64 = 0.7;

/// Smallest share of directions for an arc on another side, whose edge the unit's shadow may cover.
const SEEN_ARC: f64 = 0.5;

/// Smallest share of the circle on another side that must be in the image: half of the half that faces the
/// target.
const MIN_ARC: f64 = 0.15;

/// Judges the orientation in a field. `nominal` is the edge found on the docking unit's nominal side.
pub(crate) fn assess(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    cross: &CrossFit,
    plane: &Plane,
    nominal: &DiskEdge,
) -> Uprightness {
    if nominal.share > MIN_EDGE_SHARE {
        return Uprightness::Upright;
    }
    let is_elsewhere = Side::OTHERS
        .into_iter()
        .map(|side| self_check::docking_unit(view, lens, model, cross, plane, side))
        .any(|edge| {
            let seen = if edge.circle.is_some() { SEEN_ELSEWHERE } else { SEEN_ARC };
            edge.in_field > MIN_ARC && edge.share > seen && edge.share > 2.0 * nominal.share
        });
    if is_elsewhere { Uprightness::Turned } else { Uprightness::Unknown }
}

/// Number of votes that outweighs any number of contrary fields.
const DECISIVE_VOTES: i32 = 10;

/// Largest roll of a target whose docking unit has not been seen, rad: 20°. Below it a
/// target turned by a quarter has 70° or more, which is outside the domain of the method.
const MAX_UNCONFIRMED_ROLL: f64 = 20.0 / 180.0 * std::f64::consts::PI;

/// Longest time for which an orientation remains valid without new evidence, s.
const MEMORY_S: f64 = 10.0;

/// Orientation by the fields so far. Kept because the docking unit is outside the image near the target.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Orientation {
    /// Number of upright fields minus number of turned fields, −[`DECISIVE_VOTES`] to [`DECISIVE_VOTES`].
    votes: i32,
    time_s: Option<f64>,
}

impl Orientation {
    /// Adds the evidence of a field. Returns true if the target is considered turned.
    pub(crate) fn is_turned(&mut self, time_s: f64, seen: Uprightness) -> bool {
        if self.time_s.is_some_and(|before| !(0.0..=MEMORY_S).contains(&(time_s - before))) {
            *self = Self::default();
        }
        self.time_s = Some(time_s);
        let vote = match seen {
            Uprightness::Upright => 1,
            Uprightness::Turned => -1,
            Uprightness::Unknown => 0,
        };
        self.votes = (self.votes + vote).clamp(-DECISIVE_VOTES, DECISIVE_VOTES);
        self.votes < 0
    }

    /// Returns true if a roll, rad, may be that of a target turned by a quarter: it is large, and the docking
    /// unit has not been seen on its nominal side.
    pub(crate) fn is_ambiguous(&self, roll_rad: f64) -> bool {
        self.votes <= 0 && roll_rad.abs() > MAX_UNCONFIRMED_ROLL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Uprightness::{Turned, Unknown, Upright};

    #[test]
    fn an_orientation_measured_earlier_holds_where_none_can_be_measured() {
        let mut orientation = Orientation::default();
        assert!(orientation.is_turned(0.0, Turned) && orientation.is_turned(0.02, Turned));
        assert!((2..200).all(|i| orientation.is_turned(0.02 * f64::from(i), Unknown)));
        let mut orientation = Orientation::default();
        assert!(!orientation.is_turned(0.0, Upright) && !orientation.is_turned(0.02, Unknown));
    }

    #[test]
    fn a_large_roll_is_ambiguous_until_the_docking_unit_is_seen() {
        let mut orientation = Orientation::default();
        orientation.is_turned(0.0, Unknown);
        assert!(orientation.is_ambiguous(0.6) && orientation.is_ambiguous(-0.6));
        assert!(!orientation.is_ambiguous(0.3));
        orientation.is_turned(0.02, Upright);
        assert!(!orientation.is_ambiguous(0.6));
    }

    #[test]
    fn a_single_field_does_not_turn_an_upright_target() {
        let mut orientation = Orientation::default();
        assert!((0..20).all(|i| !orientation.is_turned(0.02 * f64::from(i), Upright)));
        assert!(!orientation.is_turned(0.5, Turned));
    }

    #[test]
    fn a_sequence_that_begins_anew_has_no_memory() {
        let mut orientation = Orientation::default();
        assert!(orientation.is_turned(5.0, Turned));
        assert!(!orientation.is_turned(0.0, Unknown));
        assert!(orientation.is_turned(0.1, Turned));
        assert!(!orientation.is_turned(30.0, Unknown));
    }
}
