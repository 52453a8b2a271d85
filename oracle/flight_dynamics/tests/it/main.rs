//! Files of flight dynamics: bad files and their messages, round trips.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

mod bad_files;
mod other_tools;
mod physics;
mod round_trips;
