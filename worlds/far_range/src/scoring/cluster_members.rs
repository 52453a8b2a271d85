//! Association of clusters of bright pixels with objects of the truth.

use contract::PixelPoint;
use sim::truth::{ObjectKind, ObjectTruth, Visibility};

/// Smallest reach of an object, px: the image of a point source spreads over neighbouring pixels, and the
/// centre of a faint object is not measured more accurately.
const MIN_REACH_PX: f64 = 1.5;

/// Fraction of an object's radius within which the centroid of its image lies, whichever part of the image is
/// cut off: the centroid of half a disk of radius R is 4R/(3π) = 0.42 R from the centre of the disk.
const CENTRE_SHARE: f64 = 0.5;

/// Reach of an object's visible image from its centre: max(`radius_px`, 1.5), px. Along columns the image
/// extends `bloom_px` farther.
fn reach_px(object: &ObjectTruth) -> f64 {
    // `max` ignores a NaN.
    object.radius_px.max(MIN_REACH_PX)
}

/// Returns the distance of two positions, px, with up to `bloom_px` along the columns ignored: the distance
/// of a position from a vertical line.
fn distance_px(a: PixelPoint, b: PixelPoint, bloom_px: f64) -> f64 {
    // `max` ignores a NaN.
    libm::hypot(a.x - b.x, ((a.y - b.y).abs() - bloom_px.max(0.0)).max(0.0))
}

/// Returns the electrons that are transmitted to the ground: a pipeline cannot use those outside the
/// transmitted regions.
pub(super) fn transmitted_electrons(object: &ObjectTruth) -> f64 {
    object.electrons * (1.0 - object.cut)
}

/// Returns the objects that a cluster with its centre at `position` can belong to: those that it holds and
/// that are at least partly transmitted.
pub(super) fn members(position: PixelPoint, objects: &[ObjectTruth]) -> impl Iterator<Item = &ObjectTruth> {
    objects.iter().filter(move |object| holds(position, object) && transmitted_electrons(object) > 0.0)
}

/// Returns true if a cluster with its centre at `position` holds the object: the cluster is within
/// max(`radius_px`/2, 1.5) px of the object's centre or, where full wells overflowed, of the line that
/// extends `bloom_px`/2 from the centre up and down its column.
pub(super) fn holds(position: PixelPoint, object: &ObjectTruth) -> bool {
    distance_px(position, object.position, CENTRE_SHARE * object.bloom_px)
        <= (CENTRE_SHARE * object.radius_px).max(MIN_REACH_PX)
}

/// Returns true if a cluster with its centre at `position` is on the visible image of the object, that is,
/// within its reach.
pub(super) fn covers(position: PixelPoint, object: &ObjectTruth) -> bool {
    distance_px(position, object.position, object.bloom_px) <= reach_px(object)
}

/// Returns the object that a cluster with its centre at `position` belongs to: of the objects that the
/// cluster holds, the one with the most transmitted electrons; `None` if it holds no object.
pub fn brightest_member(position: PixelPoint, objects: &[ObjectTruth]) -> Option<&ObjectTruth> {
    brightest(members(position, objects))
}

/// Returns true if the images of two objects touch, so that they may form one cluster.
pub(super) fn touch(a: &ObjectTruth, b: &ObjectTruth) -> bool {
    distance_px(a.position, b.position, a.bloom_px + b.bloom_px) <= reach_px(a) + reach_px(b)
}

/// Returns the target of a frame, if the truth contains it.
pub(super) fn target(objects: &[ObjectTruth]) -> Option<&ObjectTruth> {
    objects.iter().find(|object| object.kind == ObjectKind::Target)
}

/// Returns the object whose image may have merged with the target's: of all other objects that touch the
/// target and are not invisible, the one with the most transmitted electrons.
pub(super) fn merged_with<'a>(target: &ObjectTruth, objects: &'a [ObjectTruth]) -> Option<&'a ObjectTruth> {
    brightest(objects.iter().filter(|other| {
        other.kind != ObjectKind::Target
            && Visibility::from_snr(other.snr) != Visibility::Invisible
            && transmitted_electrons(other) > 0.0
            && touch(target, other)
    }))
}

/// Returns the transmitted electrons of all objects, except the target, that the cluster at `position` holds
/// or whose images touch the target's.
pub(super) fn other_electrons(position: PixelPoint, target: &ObjectTruth, objects: &[ObjectTruth]) -> f64 {
    objects
        .iter()
        .filter(|other| other.kind != ObjectKind::Target)
        .filter(|other| holds(position, other) || touch(target, other))
        .map(transmitted_electrons)
        .sum()
}

/// Returns the object with the most transmitted electrons; the first of several equal ones.
pub(super) fn brightest<'a>(objects: impl Iterator<Item = &'a ObjectTruth>) -> Option<&'a ObjectTruth> {
    objects.reduce(
        |best, other| {
            if transmitted_electrons(other) > transmitted_electrons(best) { other } else { best }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{CENTRE, star_at, target_with};

    fn beside(x_px: f64, y_px: f64) -> PixelPoint {
        PixelPoint::new(CENTRE.x + x_px, CENTRE.y + y_px)
    }

    #[test]
    fn an_object_outside_all_regions_belongs_to_no_cluster() {
        let cut = ObjectTruth { cut: 1.0, ..star_at(1, CENTRE, 1000.0) };
        assert_eq!(brightest_member(CENTRE, std::slice::from_ref(&cut)), None);
        assert_eq!(merged_with(&target_with(100.0), &[cut]), None);
    }

    #[test]
    fn of_equals_the_first_is_the_brightest() {
        let stars = [1, 2, 3].map(|id| star_at(id, CENTRE, if id == 1 { 10.0 } else { 20.0 }));
        assert_eq!(brightest(stars.iter()).map(|star| star.id), Some(2));
    }

    /// A star that blooms 40 px up and down from the centre.
    fn bleeding() -> ObjectTruth {
        ObjectTruth { radius_px: 6.0, bloom_px: 34.0, ..star_at(3, CENTRE, 1e6) }
    }

    #[test]
    fn an_object_beside_a_long_column_does_not_belong_to_it() {
        for (x_px, y_px, belongs) in
            [(0.0, 19.9, true), (2.9, -17.0, true), (0.0, 20.1, false), (3.1, 0.0, false), (8.0, 10.0, false)]
        {
            let place = beside(x_px, y_px);
            assert_eq!(brightest_member(place, &[bleeding()]).is_some(), belongs, "{x_px}, {y_px}");
            let neighbour = star_at(4, place, 500.0);
            assert_eq!(
                brightest_member(place, &[bleeding(), neighbour]).unwrap().id,
                if belongs { 3 } else { 4 }
            );
        }
    }

    #[test]
    fn a_column_touches_objects_above_it_and_none_beside_it() {
        let at = |x_px: f64, y_px: f64| ObjectTruth { position: beside(x_px, y_px), ..target_with(500.0) };
        assert!(touch(&at(0.0, 41.4), &bleeding()) && !touch(&at(0.0, 41.6), &bleeding()));
        assert!(touch(&at(-7.4, 30.0), &bleeding()) && !touch(&at(8.0, 30.0), &bleeding()));
        // Two adjacent columns whose ends meet.
        let above = ObjectTruth { position: beside(5.0, -78.0), ..bleeding() };
        assert!(touch(&above, &bleeding()) && covers(beside(5.0, -40.0), &above));
    }
}
