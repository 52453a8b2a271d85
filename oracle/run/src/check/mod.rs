//! What a check of a scenario says beside its errors.

pub(crate) mod derived;
pub(crate) mod slips;
