//! What the examples share.
#![allow(
    missing_docs,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    clippy::must_use_candidate,
    clippy::return_self_not_must_use,
    reason = "public to the examples alone, where names say it"
)]

pub mod command;
pub mod finish;
pub mod folder;
pub mod frame;
pub mod picture;
pub mod progress;
pub mod reflect;
pub mod room;
pub mod sampling;
pub mod scene;
