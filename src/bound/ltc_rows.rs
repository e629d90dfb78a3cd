//! The inequalities behind the bound of a transformed cosine, by the shape of M.
//!
//! `examples/tabulate` makes them, and a test proves that each holds (`tests/ltc_bound.rs`). Each is valid for any
//! M; the choice only matters to the volume.

/// The number of steps along each of two coordinates.
pub(crate) const STEPS: usize = 56;
/// The steps to a doubling, as a power of two.
const STEPS_OF_TWO: u32 = 3;

/// The numbers of a row: α₁, α₂, the components of û along e₁ and e₃, ν, q, and the largest share of 1/T and
/// 1/m₂₂² that α₃ takes.
pub(crate) const NUMBERS: usize = 7;

/// The index of a row for each place, then the rows: 10 kB.
const BYTES: &[u8] = include_bytes!("ltc_rows.bin");
pub(crate) const PLACES: usize = STEPS * STEPS;
const ROWS: usize = (BYTES.len() - PLACES) / (4 * NUMBERS);

static TABLE: [[f32; NUMBERS + 1]; ROWS] = {
    let mut rows = [[0.0; NUMBERS + 1]; ROWS];
    assert!(BYTES.len() == PLACES + 4 * NUMBERS * ROWS && ROWS <= 256);
    let mut i = 0;
    while i < NUMBERS * ROWS {
        let at = PLACES + 4 * i;
        let bytes = [BYTES[at], BYTES[at + 1], BYTES[at + 2], BYTES[at + 3]];
        rows[i / NUMBERS][i % NUMBERS] = f32::from_le_bytes(bytes);
        i += 1;
    }
    rows
};

/// The row for m₁₁ = `along` and m₁₁|b| = `slant`, neither negative, with a zero after it.
#[inline(always)]
pub(super) fn row(along: f32, slant: f32) -> &'static [f32; NUMBERS + 1] {
    &TABLE[usize::from(BYTES[place(along, slant)]).min(ROWS - 1)]
}

/// The place of a row.
pub(crate) fn place(along: f32, slant: f32) -> usize {
    step(along) * STEPS + step(slant)
}

/// The logarithm of 1 + x in steps: exact at powers of two, and linear between.
fn step(x: f32) -> usize {
    let bits = (1.0 + x).to_bits().saturating_sub(1.0_f32.to_bits());
    ((bits >> (f32::MANTISSA_DIGITS - 1 - STEPS_OF_TWO)) as usize).min(STEPS - 1)
}
