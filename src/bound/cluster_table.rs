//! The table of the bound of clusters: nearly smallest ellipsoids of revolution, over two coordinates.
//!
//! `examples/tabulate` makes it. `tests/cluster_bound.rs` proves that its ellipsoids enclose.

/// The number of knots of each coordinate, evenly spaced in \[0, 1\].
pub(crate) const KNOTS: usize = 9;

/// The number of elements of a knot: how far the ellipsoid extends ahead of the light and behind it, and its
/// squared semi-axis across over w = 1/(1 + λ/2).
pub(crate) const NUMBERS: usize = 3;

const BYTES: &[u8] = include_bytes!("cluster.bin");

/// The numbers of a knot of √w and √(A/l_max²), the first changing faster, and a zero.
pub(crate) static TABLE: [[f32; NUMBERS + 1]; KNOTS * KNOTS] = {
    let mut table = [[0.0; NUMBERS + 1]; KNOTS * KNOTS];
    assert!(BYTES.len() == 2 * NUMBERS * table.len());
    let mut i = 0;
    while i < NUMBERS * table.len() {
        let count = u16::from_le_bytes([BYTES[2 * i], BYTES[2 * i + 1]]);
        table[i / NUMBERS][i % NUMBERS] = count as f32 * UNIT;
        i += 1;
    }
    table
};

/// The unit of the elements, 2⁻¹².
pub(crate) const UNIT: f32 = 1.0 / 4096.0;
