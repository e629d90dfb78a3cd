//! The README's programs, again.
#![doc = include_str!("../../README.md")]
