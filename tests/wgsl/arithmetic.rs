//! Single precision, as well or as badly done as WGSL allows.
//!
//! A sum, a difference or a product is one of the two numbers around the exact one. A quotient errs by up to 2.5 units in
//! the last place, an inverse square root by 2, and a square root is a quotient of 1 by that. Sums and products of several
//! are taken in any order. Subnormal numbers may be flushed. Whatever is not finite, and a divisor outside of what the
//! table covers, is an error of the shader. (Contraction leaves a rounding out, which is no worse.)

use fastrand::Rng;

pub enum Arithmetic {
    /// Each operation rounds to nearest, from left to right, and divisions come last.
    Nearest,
    /// Each operation errs by what is allowed: upward with this probability, and else downward.
    Allowed { rng: Rng, upward: f64 },
}

/// The next number above a finite one.
fn above(x: f32) -> f32 {
    match x {
        0.0 => f32::from_bits(1),
        x if x > 0.0 => f32::from_bits(x.to_bits() + 1),
        x => f32::from_bits(x.to_bits() - 1),
    }
}

/// The least number that is not below `x`.
fn rounded_up(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        above(nearest)
    } else {
        nearest
    }
}

/// The greatest number that is not above `x`.
fn rounded_down(x: f64) -> f32 {
    -rounded_up(-x)
}

/// The distance of the numbers about `x`.
fn unit_in_the_last_place(x: f64) -> f64 {
    let exponent = ((x.to_bits() >> 52) & 0x7FF) as i32 - 1023;
    2.0_f64.powi(exponent.max(-126) - 23)
}

impl Arithmetic {
    /// Errs in any way: all upward, all downward, or each as it comes.
    pub fn drawn(mut rng: Rng) -> Self {
        let upward = [0.0, 0.5, 0.5, 1.0][rng.usize(0..4)];
        Self::Allowed { rng, upward }
    }

    fn is_upward(&mut self) -> bool {
        match self {
            Self::Nearest => false,
            Self::Allowed { rng, upward } => rng.f64() < *upward,
        }
    }

    /// A number that is correctly rounded from `exact`, in either direction.
    pub fn rounded(&mut self, exact: f64) -> f32 {
        self.within(exact, 0.0)
    }

    /// A number within `ulps` of `exact`, or next to it.
    fn within(&mut self, exact: f64, ulps: f64) -> f32 {
        let is_upward = self.is_upward();
        let Self::Allowed { rng, .. } = self else {
            return finite(exact as f32);
        };
        // Within a quotient's error, the outermost numbers; else the two around the exact one.
        let off = ulps * unit_in_the_last_place(exact);
        let [low, high] = if ulps > 0.0 {
            [rounded_up(exact - off), rounded_down(exact + off)]
        } else {
            [rounded_down(exact), rounded_up(exact)]
        };
        let number = if is_upward { high } else { low };
        let is_flushed = number.abs() < f32::MIN_POSITIVE && rng.bool();
        finite(if is_flushed { 0.0 } else { number })
    }

    /// A place below `count`: the last but in any order.
    fn place(&mut self, count: usize) -> usize {
        match self {
            Self::Nearest => 0,
            Self::Allowed { rng, .. } => rng.usize(0..count),
        }
    }

    /// Σ terms, in any order.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = f32>) -> f32 {
        let mut terms: Vec<f32> = terms.into_iter().collect();
        while terms.len() > 1 {
            let a = terms.remove(self.place(terms.len()));
            let place = self.place(terms.len());
            terms[place] = self.rounded(f64::from(a) + f64::from(terms[place]));
        }
        terms[0]
    }

    /// Π factors/Π divisors, in any order.
    pub fn product(&mut self, mut factors: Vec<f32>, mut divisors: Vec<f32>) -> f32 {
        while factors.len() + divisors.len() > 1 {
            let is_division = factors.len() == 1 || (!divisors.is_empty() && self.place(2) == 1);
            if !is_division {
                let a = factors.remove(self.place(factors.len()));
                let place = self.place(factors.len());
                factors[place] = self.rounded(f64::from(a) * f64::from(factors[place]));
            } else if divisors.len() > 1 && self.place(2) == 1 {
                let a = divisors.remove(self.place(divisors.len()));
                let place = self.place(divisors.len());
                divisors[place] = self.rounded(f64::from(a) * f64::from(divisors[place]));
            } else {
                let divisor = divisors.remove(self.place(divisors.len()));
                let place = self.place(factors.len());
                factors[place] = self.quotient(factors[place], divisor);
            }
        }
        factors[0]
    }

    fn quotient(&mut self, a: f32, b: f32) -> f32 {
        let covered = 2.0_f32.powi(-126)..=2.0_f32.powi(126);
        assert!(covered.contains(&b.abs()), "a division by {b}");
        self.within(f64::from(a) / f64::from(b), 2.5)
    }

    pub fn inverse_square_root(&mut self, x: f32) -> f32 {
        assert!(x > 0.0, "the inverse square root of {x}");
        self.within(1.0 / f64::from(x).sqrt(), 2.0)
    }

    pub fn square_root(&mut self, x: f32) -> f32 {
        assert!(x >= 0.0, "the square root of {x}");
        if matches!(self, Self::Nearest) || x == 0.0 {
            return x.sqrt();
        }
        let inverse = self.inverse_square_root(x);
        self.quotient(1.0, inverse)
    }
}

fn finite(x: f32) -> f32 {
    assert!(x.is_finite(), "an overflow");
    x
}

#[test]
fn errors_are_what_wgsl_allows_and_no_more() {
    let mut allowed = Arithmetic::Allowed {
        rng: Rng::with_seed(1),
        upward: 0.5,
    };
    let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    let mut rng = Rng::with_seed(2);
    for _ in 0..100_000 {
        let [x, y] = [(); 2].map(|()| 0.5 + rng.f32());
        let exact = [
            f64::from(x) + f64::from(y),
            f64::from(x) / f64::from(y),
            1.0 / f64::from(x).sqrt(),
            f64::from(x).sqrt(),
        ];
        let computed = [
            allowed.sum([x, y]),
            allowed.product(vec![x], vec![y]),
            allowed.inverse_square_root(x),
            allowed.square_root(x),
        ];
        for i in 0..4 {
            let off = (f64::from(computed[i]) - exact[i]) / unit_in_the_last_place(exact[i]);
            found[i] = [found[i][0].min(off), found[i][1].max(off)];
        }
    }
    // A root is off by twice as many units where its inverse is just below a power of two, and it just above one.
    let most = [1.0, 2.5, 2.0, 6.5];
    for ([least, greatest], most) in found.into_iter().zip(most) {
        assert!(-most <= least && least < -0.6 * most, "{least} of {most}");
        assert!(
            greatest <= most && 0.6 * most < greatest,
            "{greatest} of {most}"
        );
    }
    let mut nearest = Arithmetic::Nearest;
    assert_eq!(nearest.sum([0.1, 0.2, 0.3]), 0.1 + 0.2 + 0.3);
    assert_eq!(nearest.product(vec![0.1, 0.3], vec![0.7]), 0.1 * 0.3 / 0.7);
}
