//! The laws of pixels that have a mean of their own each: tables on a grid of means.
//!
//! Poisson(λ) is Poisson(λₖ) plus an independent n from Poisson(λ − λₖ), where λₖ is the next lower mean of a fixed grid.
//! The grid is so fine that n is nearly always 0: then the digital number is one of the table of λₖ. For n of 1 and 2
//! there are tables of their own; the few others go to the direct sampler, at the pixel's own address.

use super::alias::AliasTable;
use super::flat_laws::table;
use super::pixel_law::PixelLaw;
use super::poisson_digits::few;
use crate::randomness::Stream;

/// Tables of the means of the grid, made when first met: at most 3072 of [`OwnMeans::WIDEST`] digital numbers, 25 MB.
#[derive(Debug, Clone, Default)]
pub(super) struct OwnMeans {
    /// By the mean in quarters of an electron, then by n.
    tables: Vec<Option<AliasTable>>,
}

/// The grid ends here, electrons.
const END_E: f64 = 256.0;
/// Tables of a mean: with 0, 1 and 2 electrons more.
const OF_A_MEAN: usize = 3;

impl OwnMeans {
    /// Digital numbers in a table at most.
    const WIDEST: f64 = 1024.0;

    /// The means from which on pixels of a law have no grid, electrons; 0 where its tables would be wide.
    pub(super) fn end_e(law: &PixelLaw) -> f64 {
        if law.width_dn(END_E) <= Self::WIDEST { END_E } else { 0.0 }
    }

    /// A digital number of a pixel with a mean from 0 to less than [`OwnMeans::end_e`] electrons, from a uniform word: its
    /// upper half decides n, its lower half the digital number. `own` is the stream of the pixel's own address.
    #[inline(always)]
    pub(super) fn draw(
        &mut self,
        law: &PixelLaw,
        mean_e: f64,
        word: u64,
        own: impl FnOnce() -> Stream,
    ) -> u16 {
        let quarters = (mean_e * 4.0) as u32;
        let n = few(mean_e - 0.25 * f64::from(quarters), (word >> 32) as u32);
        if n < OF_A_MEAN
            && let Some(Some(table)) = self.tables.get(quarters as usize * OF_A_MEAN + n)
        {
            return table.draw(word as u32);
        }
        self.draw_on(law, quarters, n, word as u32, own())
    }

    /// The same when there is no table, or not yet.
    #[cold]
    fn draw_on(&mut self, law: &PixelLaw, quarters: u32, n: usize, word: u32, mut own: Stream) -> u16 {
        let node_e = 0.25 * f64::from(quarters);
        if n >= OF_A_MEAN {
            return law.sample_more(node_e, n as f64, &mut own);
        }
        let index = quarters as usize * OF_A_MEAN + n;
        if index >= self.tables.len() {
            self.tables.resize(index + 1, None);
        }
        self.tables[index].get_or_insert_with(|| table(law, node_e, n as u32)).draw(word)
    }
}

#[cfg(test)]
mod tests {
    use super::super::SensorConfig;
    use super::super::config::tests::twelve_bit;
    use super::super::pixel_law::tests::{chi_square_p, chi_square_tail, counts_of, from_zero};
    use super::*;
    use crate::randomness::{Effect, Seed};

    /// A gain of 1 e⁻/DN and a low read noise, so that single electrons are seen.
    fn law() -> PixelLaw {
        PixelLaw::new(&SensorConfig { gain_e_per_dn: 1.0, read_noise_e: 1.2, ..twelve_bit() })
    }

    #[test]
    fn pixels_of_their_own_means_follow_the_law_of_the_direct_sampler() {
        let (law, mut tables) = (law(), OwnMeans::default());
        for (frame, mean_e) in
            [0.0, 0.1, 0.3, 1.0, 17.99, 63.99, 64.0, 65.49, 201.7, 255.99].into_iter().enumerate()
        {
            let streams = Seed { seed: 23, case: 0 }.streams(frame as u64, Effect::PixelNoise);
            let n = 300_000;
            let drawn = counts_of((0..n).map(|place| {
                usize::from(tables.draw(&law, mean_e, streams.word(place), || streams.at(n + place)))
            }));
            let p = chi_square_p(&drawn, &from_zero(&law.probabilities(mean_e, 0)));
            assert!(p > 1e-4, "mean {mean_e}: p = {p}");
            let mut stream = streams.at(2 * n);
            let sampled = counts_of((0..n).map(|_| usize::from(law.sample(mean_e, 0.0, &mut stream))));
            let (mut chi2, mut bins) = (0.0, 0.0);
            for (a, b) in drawn.iter().zip(&sampled).filter(|(a, b)| *a + *b >= 20) {
                chi2 += (*a as f64 - *b as f64) * (*a as f64 - *b as f64) / (a + b) as f64;
                bins += 1.0;
            }
            let p = chi_square_tail(chi2, bins);
            assert!(p > 1e-4, "mean {mean_e}: p = {p} against the sampler");
        }
    }

    #[test]
    fn what_is_kept_changes_nothing() {
        let (law, mut kept) = (law(), OwnMeans::default());
        let streams = Seed { seed: 24, case: 0 }.streams(0, Effect::PixelNoise);
        let mean_e = |place: u64| place as f64 * 0.0937;
        let draw = |tables: &mut OwnMeans, place: u64| {
            tables.draw(&law, mean_e(place), streams.word(place), || streams.at(place))
        };
        let all: Vec<u16> = (0..2700).map(|place| draw(&mut kept, place)).collect();
        for place in (0..2700).step_by(61) {
            assert_eq!(draw(&mut OwnMeans::default(), place), all[place as usize]);
        }
        assert!(kept.tables.len() <= 3072);
    }

    #[test]
    fn wide_tables_are_not_made() {
        assert_eq!(OwnMeans::end_e(&law()), END_E);
        let wide = SensorConfig { gain_e_per_dn: 0.05, ..twelve_bit() };
        assert_eq!(OwnMeans::end_e(&PixelLaw::new(&wide)), 0.0);
    }
}
