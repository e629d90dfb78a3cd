//! The isosurface in the table's coordinates, as `src/bound/smallest.rs` has it.

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

/// Of a half vector: ζ, `a` as there, the half angle's cosine t = a√(L/N), N and Nμ_o/√L.
pub struct Point<T> {
    pub z: [T; 3],
    pub a: T,
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
        let t = (self.rl * a).over_root(n);
        let c2 = self.c.square() * 2.0 - one;
        let (m11, m22) = (m1.square(), m2.square());
        let z1 = m3.square() - alpha2 * (m11 + c2 * m22);
        let z2 = m1 * m3 * 2.0 + self.alpha * self.s * self.c * m22 * 2.0;
        let z3 = m2 * a * 2.0;
        Point {
            z: [z1, z2, z3],
            a,
            t,
            n,
            e,
        }
    }
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
