//! State of the target's image in the cluster of a correct measurement.

use contract::PixelPoint;
use sim::truth::ObjectTruth;

use crate::scoring::cluster_members::{other_electrons, target, transmitted_electrons};

/// Fraction of electrons up to which an image counts as the target's only, and as whole.
const SMALL_SHARE: f64 = 0.02;

/// State of the target's image in the cluster of a correct measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageState {
    /// The image is complete and almost undisturbed: less than 2 % of the target's electrons are cut off, and
    /// at most 2 % of the electrons belong to other objects.
    Whole,
    /// At least 2 % of the target's electrons are outside the transmitted regions.
    Cut,
    /// More than 2 % of the transmitted electrons are those of other objects that belong to the cluster or
    /// touch the target's image, whether or not the regions cut the image.
    Merged,
}

impl ImageState {
    /// All states, in the order of the tables.
    pub(crate) const ALL: [Self; 3] = [Self::Whole, Self::Cut, Self::Merged];

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Cut => "cut",
            Self::Merged => "merged",
        }
    }

    /// Returns the state of the target in the cluster at `position`; `None` without a target.
    pub(crate) fn from_objects(position: PixelPoint, objects: &[ObjectTruth]) -> Option<Self> {
        let target = target(objects)?;
        let others = other_electrons(position, target, objects);
        Some(if others > SMALL_SHARE * (transmitted_electrons(target) + others) {
            Self::Merged
        } else if target.cut >= SMALL_SHARE {
            Self::Cut
        } else {
            Self::Whole
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{CENTRE, hot_pixel_at, star_at, target_with};

    fn state(cut: f64, others: &[ObjectTruth]) -> &'static str {
        let mut objects = others.to_vec();
        objects.push(ObjectTruth { cut, ..target_with(1000.0) });
        ImageState::from_objects(CENTRE, &objects).unwrap().code()
    }

    #[test]
    fn an_image_is_cut_from_two_percent_on() {
        assert_eq!((state(0.0199, &[]), state(0.02, &[]), state(0.9, &[])), ("whole", "cut", "cut"));
        assert_eq!(ImageState::from_objects(CENTRE, &[]), None);
    }

    /// Two objects with reaches of 1.5 px touch up to a distance of 3 px; 20.4/1020.4 is 2 %.
    #[test]
    fn an_image_is_merged_when_others_have_more_than_two_percent_of_its_electrons() {
        let star = |x_px: f64, electrons| star_at(7, PixelPoint::new(CENTRE.x + x_px, CENTRE.y), electrons);
        assert_eq!((state(0.0, &[star(2.9, 20.0)]), state(0.0, &[star(2.9, 21.0)])), ("whole", "merged"));
        assert_eq!(state(0.0, &[star(3.1, 5000.0)]), "whole");
        assert_eq!(state(0.0, &[star(2.9, 15.0), hot_pixel_at(3, CENTRE, 15.0)]), "merged");
        // Cut-off electrons of other objects do not disturb the target. If the target is cut, the same
        // electrons disturb it more.
        assert_eq!(state(0.0, &[ObjectTruth { cut: 1.0, ..star(1.0, 500.0) }]), "whole");
        assert_eq!(state(0.5, &[star(2.9, 15.0)]), "merged");
    }
}
