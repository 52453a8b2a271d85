//! Check that a range can be reached from earlier ones: a target that was near and is lost cannot be far.

/// Upper limit of the speed of any approach, m/s.
const MAX_SPEED_M_S: f64 = 10.0;

/// Largest relative difference of two measurements of the same range.
const MAX_STEP: f64 = 0.2;

/// Number of measurements in agreement that outweighs any memory.
const DECISIVE_VOTES: u32 = 10;

/// Range on which measurements agree.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RangeHypothesis {
    time_s: f64,
    range_m: f64,
    /// Number of measurements in agreement, up to [`DECISIVE_VOTES`].
    support: u32,
}

impl RangeHypothesis {
    fn new(time_s: f64, range_m: f64) -> Self {
        Self { time_s, range_m, support: 1 }
    }

    fn admits(&self, time_s: f64, range_m: f64) -> bool {
        let reach_m = MAX_STEP * self.range_m + MAX_SPEED_M_S * (time_s - self.time_s);
        (range_m - self.range_m).abs() <= reach_m
    }

    fn agree(&mut self, time_s: f64, range_m: f64) {
        *self = Self { time_s, range_m, support: (self.support + 1).min(DECISIVE_VOTES) };
    }
}

/// Accepted range, and a contrary range that may replace it.
///
/// A contradicting measurement is refused until as many measurements agree on the contrary range as had
/// agreed on the accepted one. Thus one wrong measurement gives way to the next correct one, and a range seen
/// for long is not given up for a few wrong ones.
#[derive(Debug, Clone, Default)]
pub(crate) struct RangeMemory {
    believed: Option<RangeHypothesis>,
    contrary: Option<RangeHypothesis>,
}

impl RangeMemory {
    /// Adds a measurement. Returns true if the measurement may be reported.
    pub(crate) fn admit(&mut self, time_s: f64, range_m: f64) -> bool {
        let Some(believed) = self.believed.as_mut().filter(|hypothesis| time_s >= hypothesis.time_s) else {
            // Nothing was seen before, or a new sequence begins.
            *self = Self { believed: Some(RangeHypothesis::new(time_s, range_m)), contrary: None };
            return true;
        };
        if believed.admits(time_s, range_m) {
            believed.agree(time_s, range_m);
            self.contrary = None;
            return true;
        }
        let contrary = match self.contrary {
            Some(mut contrary) if contrary.admits(time_s, range_m) => {
                contrary.agree(time_s, range_m);
                contrary
            }
            _ => RangeHypothesis::new(time_s, range_m),
        };
        self.contrary = Some(contrary);
        let is_outweighed = contrary.support >= believed.support;
        if is_outweighed {
            *self = Self { believed: Some(contrary), contrary: None };
        }
        is_outweighed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Admission of ranges a fiftieth of a second apart.
    fn admitted(ranges_m: &[f64]) -> Vec<bool> {
        let mut memory = RangeMemory::default();
        ranges_m.iter().enumerate().map(|(i, range_m)| memory.admit(0.02 * i as f64, *range_m)).collect()
    }

    #[test]
    fn one_wrong_answer_among_right_ones_is_refused() {
        assert_eq!(admitted(&[150.0, 150.1, 149.9, 36.0, 149.8]), [true, true, true, false, true]);
    }

    #[test]
    fn one_wrong_answer_at_the_beginning_gives_way() {
        assert_eq!(admitted(&[36.0, 150.1, 149.9]), [true, true, true]);
        assert_eq!(admitted(&[36.0, 36.1, 149.9, 149.8, 149.7]), [true, true, false, true, true]);
    }

    #[test]
    fn ten_that_agree_outweigh_any_memory() {
        let mut ranges = vec![36.0; 100];
        ranges.extend([150.0; 11]);
        let told = admitted(&ranges);
        assert!(told[100..109].iter().all(|answer| !answer) && told[109] && told[110], "{told:?}");
    }

    #[test]
    fn a_sequence_that_begins_anew_has_no_memory() {
        let mut memory = RangeMemory::default();
        assert!(memory.admit(10.0, 5.0) && memory.admit(10.02, 5.0));
        assert!(memory.admit(0.0, 400.0));
        // A change of range that the camera can travel in a minute is no contradiction.
        assert!(memory.admit(60.0, 20.0));
    }
}
