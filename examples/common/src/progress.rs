//! Progress of a slow step.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar on standard error, if that is a terminal, for a step of `length` parts.
pub fn progress(step: &'static str, length: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} %")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(step)
}
