//! Which way up the target is: cross and marks look the same after a quarter turn, the docking unit does not.

use contract::docking::TargetModel;

use super::docking_unit::{DiskEdge, Side};
use super::self_check;
use crate::docking::cross_and_circle::cross::CrossFit;
use crate::docking::cross_and_circle::marks::Plane;
use crate::docking::preprocessing::view::{Lens, View};

/// What a field says of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Uprightness {
    /// The docking unit is where it should be.
    Upright,
    /// It is plainly seen on another side, and not where it should be.
    Turned,
    /// It is not in the field, or not seen.
    Unknown,
}

/// Share of its directions in which the docking unit's edge is seen at its place.
const SEEN: f64 = 0.4;

/// The same for a place where it should not be: what else stands on the station has edges too.
const SEEN_ELSEWHERE: f64 = 0.7;

/// The same for an arc, whose edge the unit's own shadow may cover.
const SEEN_ARC: f64 = 0.5;

/// Least share of its circle that must be in the image elsewhere: half of the half that lies towards the target.
const MIN_ARC: f64 = 0.15;

/// What a field shows, `nominal` being what was found where the docking unit should be.
pub(crate) fn assess(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    cross: &CrossFit,
    plane: &Plane,
    nominal: &DiskEdge,
) -> Uprightness {
    if nominal.share > SEEN {
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

/// Fields that outweigh any number of others.
const ENOUGH: i32 = 10;

/// Longest time for which what was seen holds without being seen again, s.
const MEMORY_S: f64 = 10.0;

/// What the fields so far said: near the target, the docking unit is outside the image.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Orientation {
    /// Upright fields less turned ones, −[`ENOUGH`] to [`ENOUGH`].
    votes: i32,
    time_s: Option<f64>,
}

impl Orientation {
    /// Takes what a field of the target says; whether the target is to be taken for turned.
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
        self.votes = (self.votes + vote).clamp(-ENOUGH, ENOUGH);
        self.votes < 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Uprightness::{Turned, Unknown, Upright};

    #[test]
    fn what_was_seen_farther_away_holds_where_nothing_can_be_seen() {
        let mut orientation = Orientation::default();
        assert!(orientation.is_turned(0.0, Turned) && orientation.is_turned(0.02, Turned));
        assert!((2..200).all(|i| orientation.is_turned(0.02 * f64::from(i), Unknown)));
        let mut orientation = Orientation::default();
        assert!(!orientation.is_turned(0.0, Upright) && !orientation.is_turned(0.02, Unknown));
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
