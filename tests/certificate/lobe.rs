//! The isosurface in the table's coordinates, as `src/bound/smallest.rs` has it.

use super::interval::Interval;
use super::jet::Jet;
use super::real::Real;

/// A lobe by α, the cosines and sines of θ and δ, √L and α/√L.
pub struct Lobe<T> {
    pub alpha: T,
    pub c: T,
    pub s: T,
    pub cd: T,
    pub sd: T,
    pub rl: T,
    pub aol: T,
}

/// Of a half vector: ζ, the half angle's cosine, N and Nμ_o/√L.
pub struct Point<T> {
    pub z: [T; 3],
    pub t: T,
    pub n: T,
    pub e: T,
}

impl<T: Real> Lobe<T> {
    pub fn point(&self, n: T, [m1, m2, m3]: [T; 3]) -> Point<T> {
        let one = T::constant(1.0);
        let alpha2 = self.alpha.square();
        let a = self.cd * m3 - self.sd * m1;
        let e = a * m3 * 2.0 - self.cd * n;
        let t = (self.rl * a / n.sqrt()).within(0.0, 1.0);
        let c2 = self.c.square() * 2.0 - one;
        let (m11, m22) = (m1.square(), m2.square());
        let z1 = m3.square() - alpha2 * (m11 + c2 * m22);
        let z2 = m1 * m3 * 2.0 + self.alpha * self.s * self.c * m22 * 2.0;
        let z3 = m2 * a * 2.0;
        Point {
            z: [z1, z2, z3],
            t,
            n,
            e,
        }
    }
}
/// (1 − t)⁵.
pub fn fifth_of_rest(t: Interval) -> Interval {
    let r = (Interval::at(1.0) - t).within(0.0, 1.0);
    let p = |x: f64| {
        let x = Interval::at(x);
        x.square().square() * x
    };
    Interval::new(p(r.low).low.max(0.0), p(r.high).high)
}
pub fn fifth_of_rest_jet(t: Jet) -> Jet {
    let r = (Interval::at(1.0) - t.value).within(0.0, 1.0);
    let s = r.square();
    t.chain(fifth_of_rest, -s.square() * 5.0, s * r * 20.0)
}
/// F0 = z⁴.
pub fn f0(z: Interval) -> Interval {
    z.square().square().within(0.0, 1.0)
}
/// F/F(μ), which as a function of F0 is monotone.
pub fn phi(f0: Interval, et: Interval, ec: Interval) -> Interval {
    let ratio = |f: f64, t: f64, c: f64| {
        let f = Interval::at(f);
        let r = Interval::at(1.0) - f;
        (f + r * Interval::at(t)) / (f + r * Interval::at(c))
    };
    Interval::new(
        ratio(f0.low, et.low, ec.high)
            .low
            .min(ratio(f0.high, et.low, ec.high).low)
            .max(0.0),
        ratio(f0.low, et.high, ec.low)
            .high
            .max(ratio(f0.high, et.high, ec.low).high),
    )
}
/// ‖y‖² of the point sζ.
pub fn level<T: Real>(s: T, z: [T; 3], k: &[T; 6]) -> T {
    let y1 = (s * z[0] - k[0]) / k[2];
    let y2 = (s * z[1] - k[1] - k[3] * y1) / k[4];
    let y3 = s * z[2] / k[5];
    y1.square() + y2.square() + y3.square()
}
/// G2/G1, a smooth function a little below the horizon too.
pub fn masked<T: Real>(l: &Lobe<T>, p: &Point<T>) -> T {
    let one = T::constant(1.0);
    let root = ((one - l.alpha.square()) * p.e.square() + (l.aol * p.n).square()).sqrt();
    (one + l.cd) * p.e / (p.e + l.cd * root)
}
