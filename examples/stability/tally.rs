//! What is counted of a set of cases.

use crate::quantities::Quantities;

#[derive(Clone, Copy, Debug, Default)]
pub struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    pub fn add(&mut self, x: f64) {
        self.merge(Self { sum: x, count: 1 });
    }

    pub fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }

    /// `None` of nothing.
    pub fn get(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Pairs of a light and a tile that it reaches.
    pub cases: u64,
    /// Those that the crate does not find to touch, by any of its bounds.
    pub lost: u64,
    /// The same of the direct port, of the lights that it knows: a mean of 0 and 1.
    pub port_lost: Mean,
    pub port_lost_cases: u64,
    /// Of the tested volume over the exact one, less 1, where r is at least 10⁻³ of the light's
    /// distances from the eye and from the world's origin.
    pub inflation: Mean,
    /// The same where the reach r/α is.
    pub inflation_by_reach: Mean,
    /// The same as `inflation`, wherever the world's origin is.
    pub inflation_any_origin: Mean,
    pub errors: Quantities<f64>,
    pub port_errors: Quantities<f64>,
}

impl Tally {
    pub fn merge(&mut self, other: &Self) {
        self.cases += other.cases;
        self.lost += other.lost;
        self.port_lost.merge(other.port_lost);
        self.port_lost_cases += other.port_lost_cases;
        self.inflation.merge(other.inflation);
        self.inflation_by_reach.merge(other.inflation_by_reach);
        self.inflation_any_origin.merge(other.inflation_any_origin);
        self.add_errors([other.errors, other.port_errors]);
    }

    pub fn add_errors(&mut self, [ours, ported]: [Quantities<f64>; 2]) {
        for i in 0..ours.len() {
            self.errors[i] = self.errors[i].max(ours[i]);
            self.port_errors[i] = self.port_errors[i].max(ported[i]);
        }
    }

    /// All of `tallies` together.
    pub fn of<'a>(tallies: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut whole = Self::default();
        for tally in tallies {
            whole.merge(tally);
        }
        whole
    }
}
