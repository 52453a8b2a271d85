//! Tests of the navigators against an independent simulator.

mod batch;
mod sequential;
mod simulator;
mod witness;
