//! Programs about a model beside its picture: charts, measurements, contracts, proofs.

pub mod bench;
pub mod chart;
pub mod contract;
pub mod debug;
pub mod probe;
pub mod verify;
