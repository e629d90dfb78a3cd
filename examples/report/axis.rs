//! An axis of a figure: linear or logarithmic, chosen as the program runs.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// From the least to the greatest number that it shows.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
}

impl Scale {
    /// Around `numbers`, with a little room; without any, from 1 to 10. A logarithmic scale leaves out
    /// what has no logarithm, a linear one starts at zero or below.
    pub fn around(numbers: impl Iterator<Item = f64>, is_log: bool) -> Self {
        let shown = numbers.filter(|x| x.is_finite() && (!is_log || *x > 0.0));
        let start = if is_log { f64::INFINITY } else { 0.0 };
        let (low, high) = shown.fold((start, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        if low > high {
            return Self {
                low: 1.0,
                high: 10.0,
                is_log,
            };
        }
        let scale = Self { low, high, is_log };
        let [from, to] = [low, high].map(|x| scale.place(x));
        let room = 0.04 * (to - from).max(if is_log { 0.3 } else { 1e-9 });
        let from = if !is_log && low == 0.0 {
            0.0
        } else {
            from - room
        };
        Self {
            low: scale.number(from),
            high: scale.number(to + room),
            is_log,
        }
    }

    fn place(&self, x: f64) -> f64 {
        if self.is_log { x.log10() } else { x }
    }

    fn number(&self, place: f64) -> f64 {
        if self.is_log {
            10_f64.powf(place)
        } else {
            place
        }
    }

    /// Whether `x` can be shown.
    pub fn has(&self, x: f64) -> bool {
        (self.low..=self.high).contains(&x)
    }

    /// How far along the axis `x` is, from 0 to 1.
    pub fn share(&self, x: f64) -> f64 {
        let [low, high, at] = [self.low, self.high, x].map(|x| self.place(x));
        (at - low) / (high - low)
    }

    /// The number at a tick, in the notation of all ticks of the axis: powers of ten if it has many of them.
    pub fn tick(&self, x: f64) -> String {
        let is_plain = 1e-3 <= self.low && self.high < 1e5 && self.high < 1e3 * self.low;
        if !self.is_log || is_plain {
            return short(x);
        }
        let power = (x.log10() + 1e-9).floor();
        let digit = short(x / 10_f64.powf(power));
        let factor = if digit == "1" {
            String::new()
        } else {
            format!("{digit}·")
        };
        let power: String = power.to_string().chars().map(superscript).collect();
        format!("{factor}10{power}")
    }

    /// `x`, or the nearest number that can be shown.
    pub fn nearest(&self, x: f64) -> f64 {
        x.clamp(self.low, self.high)
    }
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        start + (self.share(*value) * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let most = hint.max_num_points().clamp(2, 12);
        let (low, high) = (self.place(self.low), self.place(self.high));
        if self.is_log {
            let decades: Vec<i32> = (low.floor() as i32..=high.ceil() as i32).collect();
            let digits: &[f64] = match (high - low) as usize {
                0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
                1 => &[1.0, 2.0, 5.0],
                _ => &[1.0],
            };
            let step = decades.len() / most + 1;
            let decades = decades.into_iter().step_by(step);
            return decades
                .flat_map(|decade| digits.iter().map(move |digit| digit * 10_f64.powi(decade)))
                .filter(|x| self.has(*x))
                .collect();
        }
        let rough = (high - low) / most as f64;
        let decade = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|digit| digit * decade)
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(10.0 * decade);
        let first = (low / step).ceil() as i64;
        let last = (high / step).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

/// A number as an axis or a table shows it: three digits, without a trail of zeros.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e6).contains(&x.abs()) {
        return format!("{x:.2e}").replace(".00e", "e").replace("0e", "e");
    }
    let decimals = (2 - x.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').into()
    } else {
        text
    }
}

fn superscript(digit: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match digit.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '⁻',
    }
}
