//! The smallest ellipsoids around GGX lobes, over three coordinates, and their interpolation.
//!
//! Made by `examples/tabulate.rs`, which also proves that they enclose (`tests/certificate`).

use glam::Vec4;

/// Knots along √α, evenly over \[0, 1\].
pub(crate) const ROUGHNESSES: usize = 9;
/// Knots along tan(θ_i/2) + tan(δ/2), evenly over \[0, 2\].
pub(crate) const INCIDENCES: usize = 21;
/// Knots along ∜F0, evenly over \[∜[`LEAST_F0`], 1\].
pub(crate) const REFLECTANCES: usize = 7;
/// What F0 over the F of grazing light is at least taken to be.
pub(crate) const LEAST_F0: f32 = 1.0 / 256.0;
/// [`LEAST_F0`] over what F rises by from there.
pub(crate) const LEAST_SHARE: f32 = LEAST_F0 / (1.0 - LEAST_F0);
/// ∜[`LEAST_F0`].
pub(crate) const LEAST_ROOT: f32 = 0.25;

/// c₁, c₂, A₁₁, A₂₁, A₂₂ and A₃₃ of the ellipsoid {c + A y : ‖y‖ ≤ 1}, in the module's coordinates.
pub(crate) const NUMBERS: usize = 6;
/// With two zeros, so that a knot fills vector registers.
const STRIDE: usize = 8;

const BYTES: &[u8] = include_bytes!("table.bin");
const KNOTS: usize = ROUGHNESSES * INCIDENCES * REFLECTANCES;

static TABLE: [[f32; STRIDE]; KNOTS] = {
    let mut table = [[0.0; STRIDE]; KNOTS];
    assert!(BYTES.len() == 4 * NUMBERS * KNOTS);
    let mut i = 0;
    while i < NUMBERS * KNOTS {
        let bytes = [
            BYTES[4 * i],
            BYTES[4 * i + 1],
            BYTES[4 * i + 2],
            BYTES[4 * i + 3],
        ];
        table[i / NUMBERS][i % NUMBERS] = f32::from_le_bytes(bytes);
        i += 1;
    }
    table
};

/// A coordinate of the table, counted in knots: `scale` times what is left of it after `first`.
#[derive(Clone, Copy)]
pub(crate) struct Axis {
    pub first: f32,
    pub scale: f32,
    /// The last knot that has a next one.
    pub last: f32,
}

impl Axis {
    /// √α
    pub const ROUGHNESS: Self = Self::new(0.0, 1.0, ROUGHNESSES);
    /// tan(θ_i/2) + tan(δ/2)
    pub const INCIDENCE: Self = Self::new(0.0, 2.0, INCIDENCES);
    /// ∜F0
    pub const REFLECTANCE: Self = Self::new(LEAST_ROOT, 1.0, REFLECTANCES);

    const fn new(first: f32, last: f32, knots: usize) -> Self {
        Self {
            first,
            scale: (knots - 1) as f32 / (last - first),
            last: (knots - 2) as f32,
        }
    }

    /// A knot that `x` is at or past, and how far `x` is from there to the next.
    #[inline]
    fn split(self, x: f32) -> (usize, f32) {
        let x = (x - self.first) * self.scale;
        let whole = (x - 0.5).max(0.0).min(self.last) + WHOLE;
        (low_bits(whole, self.last as usize), x - (whole - WHOLE))
    }
}

/// 1.5·2²³, next to which there are but whole numbers: a sum with it is rounded to one, which its lowest
/// bits hold. That takes less than a conversion.
pub(crate) const WHOLE: f32 = 12_582_912.0;

/// What [`WHOLE`] was added to, but `last` at most: so that no index is out of bounds.
#[inline]
fn low_bits(whole: f32, last: usize) -> usize {
    usize::from(whole.to_bits() as u16).min(last)
}

/// The ellipsoid at a knot, which the certificate is of.
#[allow(dead_code, reason = "the crate itself only interpolates")]
pub(crate) fn knot([i, j, k]: [usize; 3]) -> [f32; NUMBERS] {
    let [a, b, c, d, e, f, ..] = TABLE[(i * INCIDENCES + j) * REFLECTANCES + k];
    [a, b, c, d, e, f]
}

#[derive(Clone, Copy)]
struct Knot(Vec4, Vec4);

impl Knot {
    #[inline]
    fn at(i: usize) -> Self {
        let [a, b, c, d, e, f, ..] = TABLE[i];
        Self(Vec4::new(a, b, c, d), Vec4::new(e, f, 0.0, 0.0))
    }

    #[inline]
    fn towards(self, other: Self, t: f32) -> Self {
        Self(
            self.0 + (other.0 - self.0) * t,
            self.1 + (other.1 - self.1) * t,
        )
    }
}

/// The ellipsoid at √α = `roughness`, tan(θ_i/2) + tan(δ/2) = `incidence`, and ∜F0 = `reflectance`,
/// or at F0 = 1 without one, as [`between`] has it.
#[inline]
pub(crate) fn ellipsoid(roughness: f32, incidence: f32, reflectance: Option<f32>) -> [Vec4; 2] {
    let (i, u) = Axis::ROUGHNESS.split(roughness);
    let (j, v) = Axis::INCIDENCE.split(incidence);
    let first = (i * INCIDENCES + j) * REFLECTANCES;
    if let Some(reflectance) = reflectance {
        let (k, w) = Axis::REFLECTANCE.split(reflectance);
        between(first + k, [u, v], Some(w))
    } else {
        between(first + REFLECTANCES - 1, [u, v], None)
    }
}

const TOWARDS_INCIDENCE: usize = REFLECTANCES;
const TOWARDS_ROUGHNESS: usize = INCIDENCES * REFLECTANCES;

/// The number of the knot (i, j, k) in the table, from a sum with [`WHOLE`].
#[cfg(feature = "cull")]
#[inline]
pub(crate) fn first_knot(number: f32) -> usize {
    low_bits(number, KNOTS - 1 - TOWARDS_ROUGHNESS - TOWARDS_INCIDENCE)
}

/// What is found from the `first` knot towards the next ones, by these shares of the way along
/// √α, tan(θ_i/2) + tan(δ/2), and ∜F0 if that is not at its last knot: (c₁, c₂, A₁₁, A₂₁) and
/// (A₂₂, A₃₃, 0, 0).
#[inline]
pub(crate) fn between(first: usize, [u, v]: [f32; 2], w: Option<f32>) -> [Vec4; 2] {
    let at = |i: usize| match w {
        Some(w) => Knot::at(i).towards(Knot::at(i + 1), w),
        None => Knot::at(i),
    };
    let [a, b] = [at(first), at(first + TOWARDS_INCIDENCE)];
    let next = first + TOWARDS_ROUGHNESS;
    let [c, d] = [at(next), at(next + TOWARDS_INCIDENCE)];
    let Knot(first, second) = a.towards(b, v).towards(c.towards(d, v), u);
    [first, second]
}
