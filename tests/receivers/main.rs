//! Culling against the receivers of tiles.
#![cfg(feature = "cull")]

mod lists;
mod scene;
