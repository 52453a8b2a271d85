//! Identification of stars with the uploaded list (section 2.1, Eqs. 3 and 4).

use contract::{CameraFrame, Icrs, ListedStar, PixelPoint, Rotation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::detect::Blob;
use crate::CameraModel;

/// Parameters of the identification of clusters as stars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct IdentificationConfig {
    /// Largest distance between a predicted star and its cluster, px, 0 to 1000. If too small, stars are lost
    /// by the errors of attitude, mounting and aberration (0.3 px); if too large, the target is mistaken for
    /// a star near it.
    #[schemars(range(min = 0, max = 1000))]
    pub radius_px: f64,
    /// Magnitude of the faintest stars of the list that are used, visual, −30 to 30.
    #[schemars(range(min = -30, max = 30))]
    pub max_magnitude: f64,
}

impl Default for IdentificationConfig {
    fn default() -> Self {
        Self { radius_px: 3.0, max_magnitude: 30.0 }
    }
}

impl IdentificationConfig {}

/// Listed star with its predicted position in the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PredictedStar {
    pub(super) star: ListedStar,
    pub(super) position: PixelPoint,
}

/// Star list, limited to the magnitudes used, and the cone that contains the field of view.
#[derive(Debug)]
pub(super) struct StarList {
    stars: Vec<ListedStar>,
    /// Sine of the declination and index of each star, from south to north.
    by_declination: Vec<(f64, u32)>,
    cos_cone: f64,
}

/// Margin on the cone's cosine, so rounding excludes no star at the corners.
const CONE_MARGIN: f64 = 1e-4;

/// Margin on the sine of a declination, far larger than its rounding error.
const ROUNDING: f64 = 1e-9;

/// Returns the sine of the declination and the index of each star, from south to north.
///
/// Sorts in two steps, into belts of equal area and within each belt, because a full sky is sorted for every
/// case of a study.
fn by_declination(stars: &[ListedStar]) -> Vec<(f64, u32)> {
    let belts = stars.len().clamp(1, 1 << 14);
    let sine = |star: &ListedStar| star.direction.vector().z;
    let belt = |star: &ListedStar| ((0.5 * (sine(star) + 1.0) * belts as f64) as usize).min(belts - 1);
    // Index of the first star of each belt.
    let mut next = vec![0; belts + 1];
    stars.iter().for_each(|star| next[belt(star) + 1] += 1);
    (0..belts).for_each(|i| next[i + 1] += next[i]);
    let mut sorted = vec![(0.0, 0); stars.len()];
    for (star, place) in stars.iter().zip(0..) {
        let at = &mut next[belt(star)];
        sorted[*at] = (sine(star), place);
        *at += 1;
    }
    let mut first = 0;
    for end in next.into_iter().take(belts) {
        sorted[first..end].sort_by(|a, b| a.0.total_cmp(&b.0));
        first = end;
    }
    sorted
}

impl StarList {
    pub(super) fn new(stars: &[ListedStar], max_magnitude: f64, model: &CameraModel) -> Self {
        let bright_enough = |star: &&ListedStar| star.magnitude <= max_magnitude;
        let stars: Vec<_> = stars.iter().filter(bright_enough).copied().collect();
        let by_declination = by_declination(&stars);
        Self { stars, by_declination, cos_cone: (model.cos_half_field() - CONE_MARGIN).max(0.0) }
    }

    /// Returns the listed star with this number.
    pub(super) fn by_id(&self, id: u32) -> Option<ListedStar> {
        self.stars.iter().find(|star| star.id == id).copied()
    }

    /// Returns the listed stars in front of the camera and inside Ω, with their pixel positions (Eq. 4).
    /// Aberration is neglected: 0.3 px is a fraction of any sensible radius.
    pub(super) fn predict(
        &self,
        camera_from_icrs: &Rotation<CameraFrame, Icrs>,
        model: &CameraModel,
    ) -> Vec<PredictedStar> {
        let matrix = camera_from_icrs.matrix();
        // The z component in the camera frame is the cosine of the angle to the boresight: one product
        // rejects most stars.
        let boresight = matrix.row(2).transpose();
        let mut near: Vec<_> = self
            .in_declination_band(boresight.z)
            .iter()
            .filter_map(|&(_, place)| Some((place, self.stars.get(place as usize)?)))
            .filter(|(_, star)| boresight.dot(star.direction.vector()) >= self.cos_cone)
            .collect();
        near.sort_unstable_by_key(|(place, _)| *place);
        near.into_iter()
            .filter_map(|(_, &star)| {
                let position = model.project_vector(&(matrix * star.direction.vector()))?;
                model.is_on_detector(position).then_some(PredictedStar { star, position })
            })
            .collect()
    }

    /// Returns the stars within the range of declinations covered by the cone about a direction whose
    /// declination has the sine `z`.
    fn in_declination_band(&self, z: f64) -> &[(f64, u32)] {
        let (cos_cone, sin_cone) = (self.cos_cone, (1.0 - self.cos_cone * self.cos_cone).max(0.0).sqrt());
        let (middle, half) = (z * cos_cone, (1.0 - z * z).max(0.0).sqrt() * sin_cone + ROUNDING);
        // A cone that contains a pole covers all declinations up to that pole.
        let from = if z <= -cos_cone { f64::NEG_INFINITY } else { middle - half };
        let to = if z >= cos_cone { f64::INFINITY } else { middle + half };
        let before = |limit: f64| self.by_declination.partition_point(|&(sine, _)| sine < limit);
        self.by_declination.get(before(from)..before(to)).unwrap_or_default()
    }
}

/// Returns for each cluster the index into `predicted` of the star that it is identified as.
///
/// Pairs within the radius are assigned nearest first; at equal distance the brighter star wins, then the
/// smaller number. A cluster is at most one star, and a star at most one cluster. Clusters for which
/// `excluded` is true are not identified.
pub(super) fn identify(
    blobs: &[Blob],
    excluded: &[bool],
    predicted: &[PredictedStar],
    radius_px: f64,
) -> Vec<Option<usize>> {
    let mut pairs = Vec::new();
    for (i, (blob, _)) in blobs.iter().zip(excluded).enumerate().filter(|(_, (_, excluded))| !**excluded) {
        for (k, candidate) in predicted.iter().enumerate() {
            // Compares columns before the distance, because most pairs are far apart.
            if (candidate.position.x - blob.centre.x).abs() <= radius_px {
                let distance = candidate.position.distance(blob.centre);
                if distance <= radius_px {
                    pairs.push((distance, i, k));
                }
            }
        }
    }
    pairs.sort_by(|a, b| {
        let (star_a, star_b) = (&predicted[a.2].star, &predicted[b.2].star);
        a.0.total_cmp(&b.0)
            .then(star_a.magnitude.total_cmp(&star_b.magnitude))
            .then(star_a.id.cmp(&star_b.id))
            .then(a.1.cmp(&b.1))
    });
    let mut star_of_blob = vec![None; blobs.len()];
    let mut taken = vec![false; predicted.len()];
    for (_, i, k) in pairs {
        if star_of_blob[i].is_none() && !taken[k] {
            star_of_blob[i] = Some(k);
            taken[k] = true;
        }
    }
    star_of_blob
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera_model::tests::argon;
    use contract::{Angle, Direction};

    fn star(id: u32, ra_deg: f64, dec_deg: f64, magnitude: f64) -> ListedStar {
        let direction = Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg));
        ListedStar { id, direction, magnitude }
    }

    /// Returns an attitude with the boresight along +x of ICRS, columns towards increasing right ascension,
    /// rows towards north.
    fn camera_from_icrs() -> Rotation<CameraFrame, Icrs> {
        use nalgebra::Vector3;
        Rotation::from_axes(&Vector3::y(), &Vector3::z(), &Vector3::x())
    }

    fn predict(stars: &[ListedStar]) -> Vec<PredictedStar> {
        StarList::new(stars, 7.0, &argon()).predict(&camera_from_icrs(), &argon())
    }

    fn blob(x: f64, y: f64) -> Blob {
        Blob { centre: PixelPoint::new(x, y), size: 1.0, pixels: 1 }
    }

    fn predicted(id: u32, x: f64, y: f64, magnitude: f64) -> PredictedStar {
        PredictedStar { star: star(id, 0.0, 0.0, magnitude), position: PixelPoint::new(x, y) }
    }

    #[test]
    fn a_star_is_predicted_by_eq_4() {
        let got = predict(&[star(1, 1.0, 0.0, 3.0)]);
        // f tan 1° = 20.187 mm / 8.6 µm · 0.017455 = 40.97 px to the right, with less than 0.01 px of
        // distortion.
        assert!((got[0].position.x - (395.0 + 40.97)).abs() < 0.01, "{got:?}");
        assert!((got[0].position.y - 288.0).abs() < 1e-9);
    }

    #[test]
    fn only_stars_that_can_be_seen_are_predicted() {
        let stars = [
            star(1, 0.0, 0.0, 7.0),
            star(2, 0.0, 0.0, 7.1),   // too faint
            star(3, 180.0, 0.0, 1.0), // behind
            star(4, 12.0, 0.0, 1.0),  // beside the field
            star(5, 0.0, 9.0, 1.0),   // above it, inside the cone of the corners
            star(6, -9.0, 6.6, 1.0),  // just inside a corner
        ];
        let ids: Vec<u32> = predict(&stars).iter().map(|p| p.star.id).collect();
        assert_eq!(ids, [1, 6]);
    }

    /// Boresights from pole to pole, with stars on a grid of one and a half degrees over the whole sky.
    #[test]
    fn no_star_is_passed_over_and_their_order_is_the_lists() {
        let model = argon();
        let stars: Vec<_> = (0..29_000)
            .map(|i| star(i, 1.5 * f64::from(i % 240), f64::from(i / 240) * 1.5 - 90.0, 3.0))
            .collect();
        let list = StarList::new(&stars, 7.0, &model);
        for (dec_deg, turn_deg) in [-90.0, -85.0, -79.0, -40.0, 0.0, 13.0, 66.0, 78.3, 84.0, 90.0_f64]
            .into_iter()
            .zip([0.0, 20.0, 45.0, 90.0, 300.0, 170.0, 200.0, 250.0, 33.0, 80.0_f64])
        {
            let boresight = Direction::from_ra_dec(Angle::from_degrees(311.0), Angle::from_degrees(dec_deg));
            let z = *boresight.vector();
            let any = if z.z.abs() < 0.5 { nalgebra::Vector3::z() } else { nalgebra::Vector3::x() };
            let (x, y) = (any.cross(&z).normalize(), z.cross(&any.cross(&z).normalize()));
            let (sin, cos) = libm::sincos(turn_deg.to_radians());
            let attitude = Rotation::from_axes(&(cos * x + sin * y), &(cos * y - sin * x), &z);
            let all: Vec<u32> = stars
                .iter()
                .filter(|star| {
                    let there = attitude.matrix() * star.direction.vector();
                    there.z > 0.5
                        && model.project_vector(&there).is_some_and(|place| model.is_on_detector(place))
                })
                .map(|star| star.id)
                .collect();
            let got: Vec<u32> = list.predict(&attitude, &model).iter().map(|found| found.star.id).collect();
            assert!(all.len() > 80, "{dec_deg}: {}", all.len());
            assert_eq!(got, all, "{dec_deg}");
        }
    }

    #[test]
    fn the_nearest_pair_is_taken_first() {
        // The right cluster is nearer to the star; the left one stays unmarked.
        let got = identify(
            &[blob(10.0, 10.0), blob(12.0, 10.0)],
            &[false; 2],
            &[predicted(7, 11.5, 10.0, 5.0)],
            3.0,
        );
        assert_eq!(got, [None, Some(0)]);
    }

    #[test]
    fn one_cluster_between_two_stars_is_the_nearer_then_the_brighter() {
        let at = |x1: f64, x2: f64| [predicted(1, x1, 10.0, 5.0), predicted(2, x2, 10.0, 4.0)];
        assert_eq!(identify(&[blob(10.0, 10.0)], &[false], &at(9.5, 11.0), 3.0), [Some(0)]);
        assert_eq!(identify(&[blob(10.0, 10.0)], &[false], &at(9.0, 11.0), 3.0), [Some(1)]);
    }

    #[test]
    fn nothing_is_marked_beyond_the_radius_or_when_excluded() {
        let stars = [predicted(1, 10.0, 10.0, 5.0)];
        assert_eq!(identify(&[blob(10.0, 13.1)], &[false], &stars, 3.0), [None]);
        assert_eq!(identify(&[blob(10.0, 10.0)], &[true], &stars, 3.0), [None]);
    }
}
