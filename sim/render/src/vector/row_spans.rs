//! Sets of pixels as runs in rows, also beyond the picture: much smaller than images, and exact.

use std::ops::Range;

/// Consecutive pixels of a row of an image; rows and columns may be negative, beyond the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Span {
    /// Row of the pixels.
    pub row: i32,
    /// First column.
    pub start: i32,
    /// Column after the last one.
    pub end: i32,
}

/// Set of pixels: disjoint spans in ascending order of row and column, none of which touch.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RowSpans {
    spans: Vec<Span>,
}

impl RowSpans {
    /// Creates the union of spans in any order.
    pub fn from_spans(mut spans: Vec<Span>) -> Self {
        spans.retain(|span| span.start < span.end);
        spans.sort_unstable();
        let mut merged: Vec<Span> = Vec::with_capacity(spans.len());
        for span in spans {
            match merged.last_mut() {
                Some(last) if last.row == span.row && span.start <= last.end => {
                    last.end = last.end.max(span.end);
                }
                _ => merged.push(span),
            }
        }
        Self { spans: merged }
    }

    /// Returns the spans.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// Returns the pixels of either set.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self::from_spans([&self.spans[..], &other.spans].concat())
    }

    /// Returns the pixels of this set that are not in another.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        let mut left = Vec::with_capacity(self.spans.len());
        for span in &self.spans {
            let mut start = span.start;
            let first = other.spans.partition_point(|hole| (hole.row, hole.end) <= (span.row, span.start));
            for hole in &other.spans[first..] {
                if hole.row != span.row || hole.start >= span.end {
                    break;
                }
                left.push(Span { start, end: hole.start, ..*span });
                start = hole.end;
            }
            left.push(Span { start, ..*span });
        }
        Self::from_spans(left)
    }

    /// Returns the pixels inside a picture of this size, whose first pixel is in row 0 and column 0.
    #[must_use]
    pub fn within(&self, columns: i32, rows: i32) -> Self {
        let in_rows = self.spans.iter().filter(|span| (0..rows).contains(&span.row));
        let cut = |span: &Span| Span { start: span.start.max(0), end: span.end.min(columns), ..*span };
        Self::from_spans(in_rows.map(cut).collect())
    }

    /// Returns the number of pixels.
    pub fn count(&self) -> u64 {
        self.spans.iter().map(|span| u64::from(span.start.abs_diff(span.end))).sum()
    }

    /// Returns the columns and the rows of the smallest rectangle around the pixels; `None` without pixels.
    pub fn bounds(&self) -> Option<[Range<i32>; 2]> {
        let (top, bottom) = (self.spans.first()?.row, self.spans.last()?.row + 1);
        let left = self.spans.iter().map(|span| span.start).min()?;
        let right = self.spans.iter().map(|span| span.end).max()?;
        Some([left..right, top..bottom])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: i32 = 12;

    /// Twenty spans, different for every seed.
    fn random_spans(seed: u32) -> Vec<Span> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as i32 % SIDE
        };
        (0..20).map(|_| Span { row: next(), start: next(), end: next() }).collect()
    }

    fn pixels(spans: &[Span]) -> Vec<bool> {
        let holds = |row, column| spans.iter().any(|s| s.row == row && (s.start..s.end).contains(&column));
        (0..SIDE * SIDE).map(|i| holds(i / SIDE, i % SIDE)).collect()
    }

    /// Operations on spans equal those on the pixels one by one.
    #[test]
    fn spans_are_sets_of_pixels() {
        for seed in 0..300 {
            let (one, other) = (random_spans(seed), random_spans(seed + 1000));
            let (a, b) = (RowSpans::from_spans(one.clone()), RowSpans::from_spans(other.clone()));
            assert_eq!(pixels(a.spans()), pixels(&one));
            let (p, q) = (pixels(&one), pixels(&other));
            let union: Vec<bool> = p.iter().zip(&q).map(|(p, q)| *p || *q).collect();
            let left: Vec<bool> = p.iter().zip(&q).map(|(p, q)| *p && !q).collect();
            assert_eq!(pixels(a.union(&b).spans()), union);
            assert_eq!(pixels(a.without(&b).spans()), left);
            assert_eq!(a.count(), p.iter().filter(|pixel| **pixel).count() as u64);
        }
    }

    #[test]
    fn a_set_is_cut_at_the_picture() {
        let span = |row, start, end| Span { row, start, end };
        let set = RowSpans::from_spans(vec![span(-1, 2, 4), span(0, -3, 2), span(1, 3, 9), span(5, 0, 1)]);
        assert_eq!(set.bounds(), Some([-3..9, -1..6]));
        let cut = set.within(5, 5);
        assert_eq!(cut.spans(), [span(0, 0, 2), span(1, 3, 5)]);
        assert_eq!((cut.count(), RowSpans::default().bounds()), (4, None));
    }
}
