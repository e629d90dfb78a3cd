//! Rows of numbers: a CSV file for programs, a table for people.

use std::path::Path;

use crate::axis::short;

/// A table with named columns.
pub struct Sheet {
    columns: &'static [&'static str],
    rows: Vec<Vec<Cell>>,
}

/// What stands in one place of a sheet.
#[derive(Clone, Debug)]
pub enum Cell {
    Text(String),
    Number(f64),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<f32> for Cell {
    /// The shortest decimal number that means this `f32`.
    fn from(number: f32) -> Self {
        Self::Number(number.to_string().parse().unwrap_or(f64::from(number)))
    }
}

impl From<u32> for Cell {
    fn from(number: u32) -> Self {
        Self::Number(number.into())
    }
}

impl Cell {
    /// With all digits that mean something, or as people read it.
    fn text(&self, is_short: bool) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(number) if !number.is_finite() => String::new(),
            Self::Number(number) if number.fract() == 0.0 && number.abs() < 1e9 => {
                number.to_string()
            }
            Self::Number(number) if is_short => short(*number),
            Self::Number(number) => {
                let digits = (7 - number.abs().log10().floor() as i32).clamp(0, 40) as usize;
                let text = format!("{number:.digits$}");
                text.trim_end_matches('0').trim_end_matches('.').into()
            }
        }
    }
}

impl Sheet {
    pub fn new(columns: &'static [&'static str]) -> Self {
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    /// Appends a row, which must have a cell for each column.
    pub fn push<const N: usize>(&mut self, cells: [Cell; N]) {
        assert_eq!(cells.len(), self.columns.len(), "a cell for each column");
        self.rows.push(cells.into());
    }

    /// Writes the sheet as CSV to `path`, all of it or nothing.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let unfinished = path.with_extension("csv.part");
        let write = || -> Result<(), csv::Error> {
            let mut writer = csv::Writer::from_path(&unfinished)?;
            writer.write_record(self.columns)?;
            for row in &self.rows {
                writer.write_record(row.iter().map(|cell| cell.text(false)))?;
            }
            writer.flush()?;
            Ok(std::fs::rename(&unfinished, path)?)
        };
        write().map_err(|reason| format!("cannot write {}: {reason}", path.display()))
    }

    /// The sheet as a table of Markdown, whose columns are straight in a terminal too.
    pub fn markdown(&self) -> String {
        let names = self
            .columns
            .iter()
            .map(|name| name.replace('_', " "))
            .collect();
        let rows = self
            .rows
            .iter()
            .map(|row| row.iter().map(|cell| cell.text(true)).collect());
        let lines: Vec<Vec<String>> = std::iter::once(names).chain(rows).collect();
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|i| {
                lines
                    .iter()
                    .map(|line| line[i].chars().count())
                    .max()
                    .unwrap_or(0)
                    .max(2)
            })
            .collect();
        let is_text = |i: usize| self.rows.iter().any(|row| matches!(row[i], Cell::Text(_)));
        let written = |line: &Vec<String>| -> String {
            let cells = line
                .iter()
                .zip(&widths)
                .enumerate()
                .map(|(i, (text, &width))| {
                    if is_text(i) {
                        format!(" {text:<width$} |")
                    } else {
                        format!(" {text:>width$} |")
                    }
                });
            std::iter::once("|".to_owned()).chain(cells).collect()
        };
        let rule: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
        let mut rule = written(&rule);
        if !rule.is_empty() {
            let ends: Vec<usize> = rule.match_indices('|').map(|(at, _)| at).skip(1).collect();
            for (i, end) in ends.into_iter().enumerate() {
                if !is_text(i) {
                    rule.replace_range(end - 1..end, ":");
                }
            }
        }
        let mut text = vec![written(&lines[0]), rule];
        text.extend(lines[1..].iter().map(written));
        text.join("\n")
    }
}
