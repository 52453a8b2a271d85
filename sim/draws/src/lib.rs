//! Random draws identified by an address, independent of any history.
//!
//! A stream is identified by (seed, case, frame, effect, index): an address gives identical numbers
//! regardless of earlier draws, on any thread and any machine. The generator is xoshiro256++ (Blackman &
//! Vigna 2019), keyed by SplitMix64 (Steele, Lea & Flood 2014) over the words of the address. Both are
//! portable and named, so the numbers are part of Boresight's contract: a change of the numbers is a change
//! of results.

mod generator_lanes;
mod streams;

pub use generator_lanes::{GeneratorLanes, LANES};
pub use streams::{Effect, Seed, Stream, Streams, normal, uniform};
