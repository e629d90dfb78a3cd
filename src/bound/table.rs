//! The table of the tight bound: nearly smallest ellipsoids around GGX lobes, over three coordinates.
//!
//! `examples/tabulate` makes it, and proves that its ellipsoids enclose the lobes (`tests/support`, `certificate`).

/// The number of knots of √α, evenly spaced in \[0, 1\].
pub(crate) const ROUGHNESSES: usize = 9;
/// The number of knots of tan(θ_i/2) + tan(δ/2), evenly spaced in \[0, 2\].
pub(crate) const INCIDENCES: usize = 21;
/// The number of knots of ∜F0, evenly spaced in \[∜[`LEAST_F0`], 1\].
pub(crate) const REFLECTANCES: usize = 7;
/// Lower clamp of the quotient of F0 and F at grazing incidence.
pub(crate) const LEAST_F0: f32 = 1.0 / 256.0;
/// [`LEAST_F0`] over the rise of F from there, 1 − [`LEAST_F0`].
pub(crate) const LEAST_SHARE: f32 = LEAST_F0 / (1.0 - LEAST_F0);
/// ∜[`LEAST_F0`].
pub(crate) const LEAST_ROOT: f32 = 0.25;

/// The number of elements of a knot: c₁, c₂, A₁₁, A₂₁, A₂₂ and A₃₃ of the ellipsoid {c + A y : ‖y‖ ≤ 1} in
/// the coordinates ζ of `tight`.
pub(crate) const NUMBERS: usize = 6;
/// The distance between knots: [`NUMBERS`] and two zeros, so that a knot fills vector registers.
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

/// A coordinate of the table. Counted in knots, a value x is (x − `first`)·`scale`.
#[derive(Clone, Copy)]
pub(crate) struct Axis {
    pub first: f32,
    pub scale: f32,
    /// The last knot but one, which starts the last interval.
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

/// The ellipsoid at a knot, for `certificate` in `tests/support`.
#[allow(dead_code, reason = "the crate itself only interpolates")]
pub(crate) fn knot([i, j, k]: [usize; 3]) -> [f32; NUMBERS] {
    let [a, b, c, d, e, f, ..] = TABLE[(i * INCIDENCES + j) * REFLECTANCES + k];
    [a, b, c, d, e, f]
}
