//! Which objects of the truth a cluster of bright pixels holds.

use contract::PixelPoint;
use sim::truth::{ObjectKind, ObjectTruth, Visibility};

/// Least reach of an object, px: the image of a point spreads over its neighbours, and the centre of a faint one
/// is measured no better.
const MIN_REACH_PX: f64 = 1.5;

/// Share of an object's radius within which the brightness centre of its image lies, whatever part of it is cut away:
/// the centre of half a disk of radius R is 4R/(3π) = 0.42 R from the disk's.
const CENTRE_SHARE: f64 = 0.5;

/// How far the visible image of an object reaches from its centre: max(`radius_px`, 1.5), px.
pub(super) fn reach_px(object: &ObjectTruth) -> f64 {
    // `max` drops a NaN.
    object.radius_px.max(MIN_REACH_PX)
}

/// The electrons that arrive on the ground: those outside the transmitted regions cannot be chosen.
pub(super) fn transmitted_electrons(object: &ObjectTruth) -> f64 {
    object.electrons * (1.0 - object.cut)
}

/// Whether a cluster with its centre at `position` holds the object: it lies within max(`radius_px`/2, 1.5) px.
pub(super) fn holds(position: PixelPoint, object: &ObjectTruth) -> bool {
    position.distance(object.position) <= (CENTRE_SHARE * object.radius_px).max(MIN_REACH_PX)
}

/// The object that a cluster with its centre at `position` belongs to: of those that it holds, the one with the most
/// transmitted electrons; `None` when it holds none.
pub fn belonging_to(position: PixelPoint, objects: &[ObjectTruth]) -> Option<&ObjectTruth> {
    brightest(objects.iter().filter(|object| holds(position, object) && transmitted_electrons(object) > 0.0))
}

/// Whether the images of two objects touch, so that they may be one cluster.
pub(super) fn touch(a: &ObjectTruth, b: &ObjectTruth) -> bool {
    a.position.distance(b.position) <= reach_px(a) + reach_px(b)
}

/// The target of a frame, if the truth has one.
pub(super) fn target(objects: &[ObjectTruth]) -> Option<&ObjectTruth> {
    objects.iter().find(|object| object.kind == ObjectKind::Target)
}

/// The visible thing that the target's image may have merged with: of all other objects that touch it and are not
/// invisible, the one with the most transmitted electrons.
pub(super) fn merged_with<'a>(target: &ObjectTruth, objects: &'a [ObjectTruth]) -> Option<&'a ObjectTruth> {
    brightest(objects.iter().filter(|other| {
        other.kind != ObjectKind::Target
            && Visibility::of_snr(other.snr) != Visibility::Invisible
            && transmitted_electrons(other) > 0.0
            && touch(target, other)
    }))
}

/// The object with the most transmitted electrons; the first of equals.
pub(super) fn brightest<'a>(objects: impl Iterator<Item = &'a ObjectTruth>) -> Option<&'a ObjectTruth> {
    objects.reduce(
        |best, other| {
            if transmitted_electrons(other) > transmitted_electrons(best) { other } else { best }
        },
    )
}
