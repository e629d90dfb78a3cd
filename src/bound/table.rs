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

/// The knot before `x`, which counts knots, and how far `x` is from there to the next.
#[inline]
fn split(x: f32, knots: u16) -> (usize, f32) {
    // The conversion saturates, and takes NaN to zero.
    let knot = (x as i32).clamp(0, i32::from(knots) - 2);
    (knot as usize, x - knot as f32)
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
/// or at F0 = 1 without one.
#[inline]
pub(crate) fn ellipsoid(
    roughness: f32,
    incidence: f32,
    reflectance: Option<f32>,
) -> [f32; NUMBERS] {
    let (i, u) = split(roughness * (ROUGHNESSES - 1) as f32, ROUGHNESSES as u16);
    let (j, v) = split(
        incidence * (0.5 * (INCIDENCES - 1) as f32),
        INCIDENCES as u16,
    );
    let row = (i * INCIDENCES + j) * REFLECTANCES;
    let next = row + INCIDENCES * REFLECTANCES;
    let [a, b, c, d] = if let Some(reflectance) = reflectance {
        const SCALE: f32 = (REFLECTANCES - 1) as f32 / (1.0 - LEAST_ROOT);
        let (k, w) = split((reflectance - LEAST_ROOT) * SCALE, REFLECTANCES as u16);
        let at = |row: usize| Knot::at(row + k).towards(Knot::at(row + k + 1), w);
        [
            at(row),
            at(row + REFLECTANCES),
            at(next),
            at(next + REFLECTANCES),
        ]
    } else {
        let at = |row: usize| Knot::at(row + REFLECTANCES - 1);
        [
            at(row),
            at(row + REFLECTANCES),
            at(next),
            at(next + REFLECTANCES),
        ]
    };
    let Knot(first, second) = a.towards(b, v).towards(c.towards(d, v), u);
    [first.x, first.y, first.z, first.w, second.x, second.y]
}
