//! Tests of the navigators against an independent simulator.

mod batch;
mod conformance;
mod sequential;
mod simulator;
mod witness;
