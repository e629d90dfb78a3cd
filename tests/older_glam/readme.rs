//! The programs of the README and of the guide, again.
#![doc = include_str!("../../README.md")]
#![doc = include_str!("../../docs/guide.md")]
