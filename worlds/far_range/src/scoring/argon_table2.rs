//! Figures published in the far-range paper.

use super::{Score, names};

/// Rows of the paper's Table 2, in percent: the days 1 to 5, then all days.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table2 {
    /// Number of images.
    pub images: [u32; 6],
    /// Images with a detected target, as a fraction of all images.
    pub hit_rate: [f64; 6],
    /// RA error < 0.024°, as a fraction of the images with a detected target.
    pub ra_within_1px: [f64; 6],
    /// RA error < 0.048°, as a fraction of the images with a detected target.
    pub ra_within_2px: [f64; 6],
    /// Dec error < 0.024°, as a fraction of the images with a detected target.
    pub dec_within_1px: [f64; 6],
    /// Dec error < 0.048°, as a fraction of the images with a detected target.
    pub dec_within_2px: [f64; 6],
}

/// Table 2 of Benninghoff, Tzschichholz, Boge and Gaias, far-range image processing for an uncooperative
/// target: the ARGON experiment of PRISMA, 23–27 April 2012.
pub const ARGON_TABLE_2: Table2 = Table2 {
    images: [1634, 2978, 3319, 5415, 2731, 16077],
    hit_rate: [94.92, 94.99, 92.22, 92.63, 96.41, 93.86],
    ra_within_1px: [83.50, 83.95, 85.63, 87.30, 84.96, 85.53],
    ra_within_2px: [92.33, 93.14, 95.46, 96.31, 96.92, 95.24],
    dec_within_1px: [85.36, 85.54, 64.62, 16.79, 7.93, 44.88],
    dec_within_2px: [91.94, 93.21, 81.80, 40.65, 34.49, 63.05],
};

impl Table2 {
    /// Returns the rates of Table 2 by the names of their figures, in percent.
    pub fn rates(&self) -> [(&'static str, [f64; 6]); 5] {
        [
            (names::HIT_RATE, self.hit_rate),
            (names::RA_WITHIN_1PX, self.ra_within_1px),
            (names::RA_WITHIN_2PX, self.ra_within_2px),
            (names::DEC_WITHIN_1PX, self.dec_within_1px),
            (names::DEC_WITHIN_2PX, self.dec_within_2px),
        ]
    }

    /// Returns the differences of the 30 cells of a score from this table, in percentage points; `None`
    /// unless the score has five groups and a value in every cell.
    pub fn distance(&self, score: &Score) -> Option<Table2Distance> {
        if score.groups.len() != 5 {
            return None;
        }
        let groups = score.groups.values().map(|group| &group.figures);
        let columns: Vec<_> = groups.chain([&score.figures]).collect();
        let mut distance = Table2Distance { mean_points: 0.0, worst_points: 0.0 };
        for (name, rates) in self.rates() {
            for (column, rate) in columns.iter().zip(rates) {
                let points = (100.0 * column.get(name)?.value? - rate).abs();
                distance.mean_points += points / 30.0;
                distance.worst_points = distance.worst_points.max(points);
            }
        }
        Some(distance)
    }
}

/// Distance of a score from a published table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table2Distance {
    /// Mean absolute difference of the cells, percentage points.
    pub mean_points: f64,
    /// Largest absolute difference of the cells, percentage points.
    pub worst_points: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::GroupScore;
    use indexmap::IndexMap;
    use score::Figure;

    /// The mean of the days, weighted by their images, must equal the last column: a check of the
    /// transcription.
    #[test]
    fn the_days_add_up_to_the_whole() {
        let table = ARGON_TABLE_2;
        assert_eq!(table.images[..5].iter().sum::<u32>(), table.images[5]);
        let all = |weights: [f64; 5], rates: [f64; 6]| {
            let sum: f64 = weights.iter().zip(rates).map(|(weight, rate)| weight * rate).sum();
            (sum / weights.iter().sum::<f64>() - rates[5]).abs()
        };
        let images = std::array::from_fn(|day| f64::from(table.images[day]));
        let detected = std::array::from_fn(|day| f64::from(table.images[day]) * table.hit_rate[day]);
        // The tolerance covers the rounding of both sides to two decimals.
        assert!(all(images, table.hit_rate) < 0.01);
        for rates in [table.ra_within_1px, table.ra_within_2px, table.dec_within_1px, table.dec_within_2px] {
            assert!(all(detected, rates) < 0.01, "{rates:?}");
        }
    }

    /// A score whose cells are those of the table plus `off` for a figure and a column, in percentage points.
    fn score(off: impl Fn(&str, usize) -> f64) -> Score {
        let figure = |points: f64| {
            let value = Some(points / 100.0);
            Figure { value, count: 0, of: 1, effective: 1.0, low: None, high: None, limit_deg: None }
        };
        let figures = |column: usize| {
            let of = |(name, rates): (&str, [f64; 6])| {
                (name.to_owned(), figure(rates[column] + off(name, column)))
            };
            ARGON_TABLE_2.rates().map(of).into_iter().collect::<IndexMap<_, _>>()
        };
        let group = |day| GroupScore {
            frames: 1,
            figures: figures(day),
            misses: IndexMap::new(),
            wrong: IndexMap::new(),
            wrong_taken: IndexMap::new(),
        };
        Score {
            warm_up_frames: 0,
            scenario: "argon".to_owned(),
            seed: 1,
            version: "0.1.0".to_owned(),
            inject: None,
            attitude: None,
            frames: 5,
            figures: figures(5),
            groups: (0..5).map(|day| (format!("day {day}"), group(day))).collect(),
            misses: IndexMap::new(),
            wrong: IndexMap::new(),
            wrong_taken: IndexMap::new(),
            consistency: Vec::new(),
            threshold_curve: Vec::new(),
        }
    }

    #[test]
    fn the_distance_is_the_mean_and_the_worst_of_thirty_cells() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let own = ARGON_TABLE_2.distance(&score(|_, _| 0.0)).unwrap();
        assert!(near(own.mean_points, 0.0) && near(own.worst_points, 0.0), "{own:?}");
        // Two cells differ: one is too low, and one in the column of all days is too high.
        let off = |name: &str, column: usize| match (name, column) {
            (names::HIT_RATE, 2) => -6.0,
            (names::DEC_WITHIN_2PX, 5) => 1.5,
            _ => 0.0,
        };
        let distance = ARGON_TABLE_2.distance(&score(off)).unwrap();
        assert!(near(distance.mean_points, 0.25) && near(distance.worst_points, 6.0), "{distance:?}");
    }

    #[test]
    fn a_score_of_other_days_or_with_an_empty_cell_has_no_distance() {
        let mut four = score(|_, _| 0.0);
        four.groups.pop();
        assert_eq!(ARGON_TABLE_2.distance(&four), None);
        let mut empty = score(|_, _| 0.0);
        empty.figures[names::HIT_RATE].value = None;
        assert_eq!(ARGON_TABLE_2.distance(&empty), None);
    }

    /// The script that fits the scenario contains the same table, without its last column.
    #[test]
    fn the_calibration_has_the_same_table_and_at_most_twelve_free_parameters() {
        let script = include_str!("../../../../scenarios/argon_calibrate.py");
        for (name, rates) in ARGON_TABLE_2.rates() {
            let cells = rates[..5].iter().map(|rate| format!("{rate:.2}")).collect::<Vec<_>>().join(", ");
            assert!(script.contains(&format!("\"{name}\": [{cells}]")), "{name}: {cells}");
        }
        let parameters =
            script.split("PARAMETERS = [").nth(1).and_then(|rest| rest.split("\n]").next()).unwrap();
        let count = parameters.lines().filter(|line| line.trim_start().starts_with('(')).count();
        assert!((1..=12).contains(&count), "{count} parameters");
    }
}
