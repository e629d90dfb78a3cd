//! The smallest ellipsoids around GGX lobes, over three coordinates.
//!
//! Made by `examples/tabulate.rs`, which also proves that they enclose (`tests/certificate`).

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
pub(crate) const STRIDE: usize = 8;

const BYTES: &[u8] = include_bytes!("table.bin");
pub(crate) const KNOTS: usize = ROUGHNESSES * INCIDENCES * REFLECTANCES;

pub(crate) static TABLE: [[f32; STRIDE]; KNOTS] = {
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
}

/// The ellipsoid at a knot, which the certificate is of.
#[allow(dead_code, reason = "the crate itself only interpolates")]
pub(crate) fn knot([i, j, k]: [usize; 3]) -> [f32; NUMBERS] {
    let [a, b, c, d, e, f, ..] = TABLE[(i * INCIDENCES + j) * REFLECTANCES + k];
    [a, b, c, d, e, f]
}
