//! Times a function, and compares it with what is exact.

use std::hint::black_box;
use std::time::Instant;

use super::Case;

/// What was measured of a function.
pub struct Row {
    pub name: &'static str,
    pub kind: &'static str,
    pub ns: f64,
    pub error: f64,
}

pub struct Bench {
    pub cases: Vec<Case>,
    pub rows: Vec<Row>,
    is_quick: bool,
}

impl Bench {
    pub fn new(count: u32, is_quick: bool) -> Self {
        Self {
            cases: (0..count).map(Case::new).collect(),
            rows: Vec::new(),
            is_quick,
        }
    }

    /// Times `function` of what `prepare` makes of each case, and compares with `exact` if that says.
    pub fn add<T, U>(
        &mut self,
        (kind, name): (&'static str, &'static str),
        prepare: impl Fn(&Case) -> T,
        function: impl Fn(&T) -> U,
        error: impl Fn(&Case, U) -> f64,
    ) {
        let inputs: Vec<T> = self.cases.iter().map(prepare).collect();
        let errors = self
            .cases
            .iter()
            .zip(&inputs)
            .map(|(case, input)| error(case, function(input)));
        let error = errors.filter(|error| !error.is_nan()).fold(0.0, f64::max);
        let ns = nanoseconds(&inputs, function, self.is_quick);
        self.rows.push(Row {
            name,
            kind,
            ns,
            error,
        });
    }
}

/// The least time per input of several rounds.
fn nanoseconds<T, U>(inputs: &[T], function: impl Fn(&T) -> U, is_quick: bool) -> f64 {
    let round = || {
        let start = Instant::now();
        for input in inputs {
            black_box(function(black_box(input)));
        }
        1e9 * start.elapsed().as_secs_f64() / inputs.len() as f64
    };
    (0..if is_quick { 10 } else { 200 })
        .map(|_| round())
        .fold(f64::INFINITY, f64::min)
}

pub fn off(computed: f32, exact: f64) -> f64 {
    // Beyond, f32 has few digits or none.
    if exact.abs() < 1e-30 {
        f64::NAN
    } else {
        (f64::from(computed) / exact - 1.0).abs()
    }
}
