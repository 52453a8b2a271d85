//! Selection of the target by motion segmentation (section 2.3, Eqs. 11 to 13).

use contract::PixelPoint;

/// Cluster as an input of motion segmentation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClusterMotion {
    /// Centre in the current frame, c_i.
    pub(super) centre: PixelPoint,
    /// Centre in the previous frame, c_prev(i); `None` when the cluster is not linked.
    pub(super) previous: Option<PixelPoint>,
    /// True if the cluster may be the target: neither a star nor a hotspot.
    pub(super) is_candidate: bool,
}

/// Returns the target (an index into `movers`): the linked candidate whose displacement Δp_i (Eq. 11) differs
/// most from the average over all linked clusters, including stars and hotspots (Eqs. 12 and 13). If several
/// differ equally, returns the first. Returns `None` without a linked candidate.
pub(super) fn select_target(movers: &[ClusterMotion]) -> Option<usize> {
    let displacement = |mover: &ClusterMotion| mover.previous.map(|previous| mover.centre.distance(previous));
    let linked: Vec<f64> = movers.iter().filter_map(displacement).collect();
    let average = linked.iter().sum::<f64>() / linked.len().max(1) as f64;
    let mut best: Option<(usize, f64)> = None;
    for (i, mover) in movers.iter().enumerate().filter(|(_, mover)| mover.is_candidate) {
        if let Some(displacement) = displacement(mover) {
            let difference = (displacement - average).abs();
            if best.is_none_or(|(_, most)| difference > most) {
                best = Some((i, difference));
            }
        }
    }
    best.map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mover(displacement: f64, is_candidate: bool) -> ClusterMotion {
        let previous = Some(PixelPoint::new(100.0, 50.0));
        ClusterMotion { centre: PixelPoint::new(100.0 + displacement, 50.0), previous, is_candidate }
    }

    #[test]
    fn the_candidate_that_differs_most_from_the_average_is_the_target() {
        // Stars move by 10 px, a candidate by 9 px and the target by 1 px.
        let movers = [mover(10.0, false), mover(9.0, true), mover(10.0, false), mover(1.0, true)];
        assert_eq!(select_target(&movers), Some(3));
    }

    #[test]
    fn the_average_is_over_all_linked_clusters() {
        // With an average over only the candidates (0 and 4), both would differ by 2, and the first would
        // win. Over all clusters (0, 4, 0, 0) the average is 1, and the second wins.
        let movers = [mover(0.0, true), mover(4.0, true), mover(0.0, false), mover(0.0, false)];
        assert_eq!(select_target(&movers), Some(1));
    }

    #[test]
    fn stars_hotspots_and_unlinked_clusters_are_no_targets() {
        let unlinked = ClusterMotion { previous: None, ..mover(50.0, true) };
        assert_eq!(select_target(&[mover(50.0, false), unlinked, mover(1.0, true)]), Some(2));
        assert_eq!(select_target(&[mover(50.0, false), unlinked]), None);
        assert_eq!(select_target(&[]), None);
    }

    #[test]
    fn one_candidate_alone_is_the_target() {
        assert_eq!(select_target(&[mover(3.0, true)]), Some(0));
    }
}
