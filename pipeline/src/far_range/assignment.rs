//! Minimum-cost assignment between two sets in which most pairs are forbidden.

use pathfinding::kuhn_munkres::kuhn_munkres_min;
use pathfinding::matrix::Matrix;

/// Allowed pair with its cost, finite and not negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AllowedPair {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) cost: f64,
}

/// Returns the column assigned to each row, or `None`: the largest number of links that the allowed pairs
/// permit and, among the assignments with that number, the one of least total cost (Kuhn–Munkres with an
/// infinite cost for every other pair; section 2.2).
///
/// The allowed pairs form connected components, since a cluster is linked only to nearby ones. Each component
/// is solved separately, which is exact and replaces one large cubic problem by many tiny ones. The worst
/// case, one component of n × m clusters, costs O(n³).
///
/// Costs are rounded to integers at 2⁻³⁰ of the largest of their component: sums of integers are exact, and
/// the result does not depend on the order of additions.
pub(super) fn assign(rows: usize, columns: usize, pairs: &[AllowedPair]) -> Vec<Option<usize>> {
    let mut column_of_row = vec![None; rows];
    // In each component: as many links as possible, and among those the least sum of costs.
    for component in components(rows, columns, pairs) {
        match component.as_slice() {
            [only] => column_of_row[only.row] = Some(only.column),
            several => solve(several, &mut column_of_row),
        }
    }
    column_of_row
}

/// Returns the pairs of each connected component, in the order of the components' first pairs.
fn components(rows: usize, columns: usize, pairs: &[AllowedPair]) -> Vec<Vec<AllowedPair>> {
    // Union-find over the rows, followed by the columns.
    let mut parent: Vec<usize> = (0..rows + columns).collect();
    fn root(parent: &mut [usize], mut node: usize) -> usize {
        while parent[node] != node {
            parent[node] = parent[parent[node]];
            node = parent[node];
        }
        node
    }
    for pair in pairs {
        let (a, b) = (root(&mut parent, pair.row), root(&mut parent, rows + pair.column));
        parent[a] = b;
    }
    let mut component_of_root = vec![None; rows + columns];
    let mut components: Vec<Vec<AllowedPair>> = Vec::new();
    for &pair in pairs {
        let slot = &mut component_of_root[root(&mut parent, pair.row)];
        let index = *slot.get_or_insert_with(|| {
            components.push(Vec::new());
            components.len() - 1
        });
        components[index].push(pair);
    }
    components
}

/// Solves one component and stores its links.
fn solve(pairs: &[AllowedPair], column_of_row: &mut [Option<usize>]) {
    let distinct = |of: fn(&AllowedPair) -> usize| {
        let mut all: Vec<usize> = pairs.iter().map(of).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let (rows, columns) = (distinct(|pair| pair.row), distinct(|pair| pair.column));
    // The library requires at most as many rows as columns.
    let transposed = rows.len() > columns.len();
    let (short, long) = if transposed { (&columns, &rows) } else { (&rows, &columns) };

    const RESOLUTION: f64 = (1u32 << 30) as f64;
    let largest = pairs.iter().fold(0.0, |most, pair| f64::max(most, pair.cost));
    let scale = if largest > 0.0 { RESOLUTION / largest } else { 0.0 };
    // Larger than the cost of all links of the component, so an additional forbidden pair never pays.
    let forbidden = (short.len() as i64 + 1) * ((1 << 30) + 1);
    let mut costs = Matrix::new(short.len(), long.len(), forbidden);
    let place = |of: &[usize], value: usize| of.binary_search(&value).unwrap_or_else(|place| place);
    for pair in pairs {
        let (s, l) = if transposed { (pair.column, pair.row) } else { (pair.row, pair.column) };
        costs[(place(short, s), place(long, l))] = (pair.cost * scale).round() as i64;
    }
    let (_, chosen) = kuhn_munkres_min(&costs);
    for (s, l) in chosen.into_iter().enumerate() {
        if costs[(s, l)] < forbidden {
            let (row, column) = if transposed { (long[l], short[s]) } else { (short[s], long[l]) };
            column_of_row[row] = Some(column);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pair(row: usize, column: usize, cost: f64) -> AllowedPair {
        AllowedPair { row, column, cost }
    }

    /// Returns the largest number of links and its least cost, by exhaustive search.
    fn brute_force(row: usize, rows: usize, used: u32, pairs: &[AllowedPair]) -> (usize, f64) {
        if row == rows {
            return (0, 0.0);
        }
        let mut best = brute_force(row + 1, rows, used, pairs);
        for p in pairs.iter().filter(|p| p.row == row && used >> p.column & 1 == 0) {
            let (links, cost) = brute_force(row + 1, rows, used | 1 << p.column, pairs);
            let with = (links + 1, cost + p.cost);
            if with.0 > best.0 || (with.0 == best.0 && with.1 < best.1) {
                best = with;
            }
        }
        best
    }

    #[test]
    fn nothing_links_to_nothing() {
        assert_eq!(assign(0, 0, &[]), []);
        assert_eq!(assign(2, 0, &[]), [None, None]);
        assert_eq!(assign(0, 3, &[]), []);
    }

    #[test]
    fn the_least_total_wins_over_the_least_pair() {
        let pairs = [pair(0, 0, 1.0), pair(0, 1, 2.0), pair(1, 0, 2.0), pair(1, 1, 9.0)];
        assert_eq!(assign(2, 2, &pairs), [Some(1), Some(0)]);
    }

    #[test]
    fn two_links_are_better_than_a_cheap_one() {
        let pairs = [pair(0, 0, 0.0), pair(0, 1, 5.0), pair(1, 0, 5.0)];
        assert_eq!(assign(2, 2, &pairs), [Some(1), Some(0)]);
    }

    #[test]
    fn the_loser_of_a_contest_stays_unlinked() {
        assert_eq!(assign(2, 1, &[pair(0, 0, 2.0), pair(1, 0, 1.0)]), [None, Some(0)]);
        assert_eq!(assign(1, 2, &[pair(0, 0, 2.0), pair(0, 1, 1.0)]), [Some(1)]);
    }

    #[test]
    fn equal_and_zero_costs_are_solved() {
        let pairs = [pair(0, 0, 0.0), pair(0, 1, 0.0), pair(1, 0, 0.0), pair(1, 1, 0.0)];
        assert_eq!(assign(2, 2, &pairs).iter().flatten().count(), 2);
    }

    #[test]
    fn a_chain_of_thousands_is_solved_in_pieces() {
        let pairs: Vec<_> = (0..5000).map(|i| pair(i, 4999 - i, 1.0)).collect();
        assert!(assign(5000, 5000, &pairs).iter().enumerate().all(|(i, c)| *c == Some(4999 - i)));
    }

    proptest! {
        #[test]
        fn the_cost_is_that_of_brute_force_and_no_forbidden_pair_is_linked(
            rows in 1usize..6, columns in 1usize..6,
            cells in proptest::collection::vec(proptest::option::weighted(0.6, 0.0..20.0f64), 25),
        ) {
            let pairs: Vec<AllowedPair> = (0..rows)
                .flat_map(|r| (0..columns).map(move |c| (r, c)))
                .filter_map(|(r, c)| cells[r * 5 + c].map(|cost| pair(r, c, cost)))
                .collect();
            let got = assign(rows, columns, &pairs);
            let mut used = vec![false; columns];
            let (mut links, mut cost) = (0, 0.0);
            for (row, column) in got.iter().enumerate().filter_map(|(r, c)| c.map(|c| (r, c))) {
                let found = pairs.iter().find(|p| p.row == row && p.column == column);
                prop_assert!(found.is_some(), "({}, {}) is forbidden", row, column);
                prop_assert!(!std::mem::replace(&mut used[column], true));
                links += 1;
                cost += found.map_or(0.0, |p| p.cost);
            }
            let (most, least) = brute_force(0, rows, 0, &pairs);
            prop_assert_eq!(links, most);
            // Rounding of five costs below 20 to 2⁻³⁰ of the largest.
            prop_assert!((cost - least).abs() < 1e-6, "{} and {}", cost, least);
        }
    }
}
