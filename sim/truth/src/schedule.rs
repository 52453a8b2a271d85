//! Times of the frames.

use std::collections::BTreeSet;
use std::ops::Range;

use contract::{OutOfRange, bounds};
use hifitime::{Duration, Epoch, TimeScale};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clock::parse_utc_field;

/// Maximum number of frames in a scenario.
pub const MAX_FRAMES: u64 = 100_000_000;

/// Group of frames at a constant cadence: a day, or a part of an approach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupConfig {
    /// Name, not empty, unique among the groups.
    pub name: String,
    /// Mid-exposure of the first frame, UTC, for example 2012-04-23T09:00:00Z.
    pub start_utc: String,
    /// Interval between frames, s, 0.001 to 1e6; rounded to the nanosecond.
    #[schemars(range(min = 0.001, max = 1e6))]
    pub cadence_s: f64,
    /// Number of frames, at least 1; at most 100000000 for all groups together.
    #[schemars(range(min = 1, max = MAX_FRAMES))]
    pub count: u64,
}

impl GroupConfig {
    /// Checks this group without reference to the other groups.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        if self.name.trim().is_empty() {
            return Err(OutOfRange::new("schedule[].name", "empty", "a name"));
        }
        parse_utc_field("schedule[].start_utc", &self.start_utc)?;
        bounds::check(self, "schedule[]")
    }
}

/// Frames of one group, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence<'a> {
    /// Name of the group.
    pub name: &'a str,
    /// Numbers of the group's frames in the scenario.
    pub frames: Range<u64>,
}

/// All frames of a scenario, numbered from 0. Times are exact to the nanosecond; nothing is stored per frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    groups: Vec<Group>,
}

#[derive(Debug, Clone, PartialEq)]
struct Group {
    name: String,
    frames: Range<u64>,
    start: Epoch,
    cadence_ns: i128,
}

impl Group {
    fn time(&self, frame: u64) -> Epoch {
        let nanoseconds = i128::from(frame - self.frames.start) * self.cadence_ns;
        self.start + Duration::from_total_nanoseconds(nanoseconds)
    }
}

impl Schedule {
    /// Checks the groups and numbers their frames.
    ///
    /// # Errors
    /// [`OutOfRange`] if a group is invalid by itself, a name is used twice, a group does not begin after the
    /// last frame of the preceding group, there are too many frames, or there is no group.
    pub fn new(configs: &[GroupConfig]) -> Result<Self, OutOfRange> {
        let mut names = BTreeSet::new();
        let mut groups: Vec<Group> = Vec::with_capacity(configs.len());
        let mut first_frame = 0;
        for (index, config) in configs.iter().enumerate() {
            config.check().map_err(|error| error.in_entry(index))?;
            if !names.insert(config.name.as_str()) {
                return Err(
                    OutOfRange::new("schedule[].name", config.name.clone(), "a unique name").in_entry(index)
                );
            }
            // Counted in TAI: in UTC, adding seconds across a leap second would lose one second.
            let start =
                parse_utc_field("schedule[].start_utc", &config.start_utc)?.to_time_scale(TimeScale::TAI);
            if let Some(before) = groups.last()
                && start <= before.time(before.frames.end - 1)
            {
                let value = format!("{} (group `{}`)", config.start_utc, config.name);
                let expected = "after the last frame of the previous group";
                return Err(OutOfRange::new("schedule[].start_utc", value, expected).in_entry(index));
            }
            let frames = first_frame..first_frame + config.count;
            first_frame = frames.end;
            if first_frame > MAX_FRAMES {
                let value = format!("{first_frame} in total");
                return Err(
                    OutOfRange::new("schedule[].count", value, "at most 100000000 in total").in_entry(index)
                );
            }
            let cadence_ns = (config.cadence_s * 1e9).round() as i128;
            groups.push(Group { name: config.name.clone(), frames, start, cadence_ns });
        }
        if groups.is_empty() {
            return Err(OutOfRange::new("schedule", "empty", "at least one group"));
        }
        Ok(Self { groups })
    }

    /// Number of frames; at least 1.
    pub fn frame_count(&self) -> u64 {
        self.groups.last().map_or(0, |group| group.frames.end)
    }

    /// Shortest interval between frames, s; infinite for a single frame.
    pub fn shortest_interval_s(&self) -> f64 {
        let last = |group: &Group| group.time(group.frames.end - 1);
        let within = self.groups.iter().filter(|group| group.frames.end - group.frames.start > 1);
        let within = within.map(|group| group.cadence_ns as f64 / 1e9);
        let between = self.groups.iter().zip(self.groups.iter().skip(1));
        let between = between.map(|(before, after)| (after.start - last(before)).to_seconds());
        within.chain(between).fold(f64::INFINITY, f64::min)
    }

    /// Mid-exposure times of the first and the last frame.
    pub fn ends(&self) -> Option<[Epoch; 2]> {
        Some([self.frame(0)?.1, self.frame(self.frame_count().checked_sub(1)?)?.1])
    }

    /// Name of the group and mid-exposure of frame `n`; `None` past the last frame.
    pub fn frame(&self, n: u64) -> Option<(&str, Epoch)> {
        let group = &self.groups[self.group_of(n)?];
        Some((&group.name, group.time(n)))
    }

    /// Index of the group of frame `n`; `None` past the last frame.
    pub fn group_of(&self, n: u64) -> Option<usize> {
        let index = self.groups.partition_point(|group| group.frames.end <= n);
        (index < self.groups.len()).then_some(index)
    }

    /// Returns the groups in order.
    pub fn sequences(&self) -> impl ExactSizeIterator<Item = Sequence<'_>> {
        self.groups.iter().map(|group| Sequence { name: &group.name, frames: group.frames.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(name: &str, start_utc: &str, cadence_s: f64, count: u64) -> GroupConfig {
        GroupConfig { name: name.into(), start_utc: start_utc.into(), cadence_s, count }
    }

    fn days() -> Vec<GroupConfig> {
        vec![
            group("day 1", "2012-04-23T09:00:00Z", 15.0, 1634),
            group("day 2", "2012-04-24T06:00:00Z", 15.0, 2978),
        ]
    }

    #[test]
    fn frames_are_numbered_through_the_groups() {
        let schedule = Schedule::new(&days()).unwrap();
        assert_eq!(schedule.frame_count(), 4612);
        assert_eq!(schedule.group_of(1633), Some(0));
        let (name, time) = schedule.frame(1634).unwrap();
        assert_eq!((name, time), ("day 2", parse_utc_field("t", "2012-04-24T06:00:00Z").unwrap()));
        assert_eq!(schedule.frame(4611).map(|(name, _)| name), Some("day 2"));
        assert_eq!(schedule.frame(4612), None);
        assert_eq!(schedule.group_of(u64::MAX), None);
    }

    #[test]
    fn sequences_cover_every_frame_once() {
        let schedule = Schedule::new(&days()).unwrap();
        let sequences: Vec<_> = schedule.sequences().map(|s| (s.name, s.frames)).collect();
        assert_eq!(sequences, [("day 1", 0..1634), ("day 2", 1634..4612)]);
    }

    #[test]
    fn times_do_not_gather_rounding() {
        // 0.1 s is not a binary fraction: a sum of ten million terms would have an error of 1e-4 s.
        let schedule = Schedule::new(&[group("a", "2012-04-23T00:00:00Z", 0.1, 10_000_001)]).unwrap();
        let (_, last) = schedule.frame(10_000_000).unwrap();
        let start = parse_utc_field("t", "2012-04-23T00:00:00Z").unwrap();
        assert_eq!(
            (last.to_tai_duration() - start.to_tai_duration()).total_nanoseconds(),
            1_000_000_000_000_000
        );
    }

    #[test]
    fn a_leap_second_takes_its_time() {
        let schedule = Schedule::new(&[group("a", "2012-06-30T23:59:58Z", 1.0, 4)]).unwrap();
        let midnight = parse_utc_field("t", "2012-07-01T00:00:00Z").unwrap();
        assert_eq!(schedule.frame(3).unwrap().1, midnight);
    }

    #[test]
    fn the_largest_schedule_allocates_nothing_per_frame() {
        let schedule = Schedule::new(&[group("a", "2012-04-23T00:00:00Z", 0.001, MAX_FRAMES)]).unwrap();
        assert!(schedule.frame(MAX_FRAMES - 1).is_some());
    }

    #[test]
    fn wrong_groups_are_refused_by_name() {
        let check = |configs: &[GroupConfig], name: &str| {
            let message = Schedule::new(configs).unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        };
        let start = "2012-04-23T09:00:00Z";
        check(&[], "schedule");
        check(&[group(" ", start, 15.0, 1)], "name");
        check(&[group("a", start, 15.0, 0)], "count");
        check(&[group("a", start, 15.0, u64::MAX)], "schedule[0].count");
        check(&[group("a", start, 0.0, 1)], "cadence_s");
        check(&[group("a", start, f64::NAN, 1)], "cadence_s");
        check(
            &[group("a", start, 15.0, 1), group("a", "2012-04-24T00:00:00Z", 15.0, 1)],
            "schedule[1].name is a,",
        );
        // The second group begins at the last frame of the first.
        check(&[group("a", start, 15.0, 2), group("b", "2012-04-23T09:00:15Z", 15.0, 1)], "group `b`");
        let half = MAX_FRAMES / 2 + 1;
        check(&[group("a", start, 0.001, half), group("b", "2013-01-01T00:00:00Z", 1.0, half)], "in total");
    }
}
