//! Line and point charts, and what they show.

mod draw;

use std::path::Path;

/// Panels, as wide in all as a page shows without shrinking them.
pub struct Figure {
    pub title: String,
    /// What was measured, and where.
    pub subtitle: String,
    pub panels: Vec<Panel>,
}

impl Figure {
    /// Writes the figure to `path`, all of it or nothing.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let unfinished = path.with_extension("svg.part");
        self.draw(&unfinished)
            .map_err(|error| error.to_string())
            .and_then(|()| std::fs::rename(&unfinished, path).map_err(|error| error.to_string()))
            .map_err(|reason| format!("cannot write {}: {reason}", path.display()))
    }
}

pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
}

#[derive(Clone, Debug)]
pub struct Axis {
    /// With the unit.
    pub label: String,
    pub is_log: bool,
}

impl Axis {
    pub fn linear(label: &str) -> Self {
        Self {
            label: label.into(),
            is_log: false,
        }
    }

    pub fn log(label: &str) -> Self {
        Self {
            label: label.into(),
            is_log: true,
        }
    }
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub look: Look,
    pub points: Vec<Point>,
}

#[derive(Clone, Debug)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Where the true value is, as far as is known.
    pub range: Option<[f64; 2]>,
    /// What is written beside it.
    pub label: String,
}

impl Point {
    pub fn new(x: f64, y: f64) -> Self {
        Self {
            x,
            y,
            range: None,
            label: String::new(),
        }
    }

    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    pub fn labelled(self, label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..self
        }
    }
}

/// Colours that remain different to most eyes [Okabe & Ito 2008], and lines that differ in print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    pub color: usize,
    pub line: Line,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    Solid,
    Dashed,
    /// Points alone.
    None,
}
