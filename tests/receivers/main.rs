//! Culling against the receivers of tiles.
#![cfg(feature = "cull")]

mod case;
mod frames;
mod lists;
mod scene;
mod unbiased;
