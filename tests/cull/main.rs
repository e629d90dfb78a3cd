//! Culling many lights against many tiles gives what the test of one light against one tile gives.
#![cfg(feature = "cull")]

mod grid;
mod limits;
mod lists;
mod workloads;
