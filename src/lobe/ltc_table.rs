//! The table of linearly transformed cosines that are fitted to GGX lobes, and of the albedos of these lobes.
//!
//! `examples/tabulate` makes it. Each element is a `u16` that counts 65535ths of the largest value, which
//! moves no matrix by more than 2·10⁻⁵ of its largest element. A and E count 66 at least, which keeps every
//! matrix invertible. Both parts together take 49,152 bytes.

/// The number of knots along each coordinate.
pub(crate) const KNOTS: usize = 64;
/// The largest value of each element of a matrix: A, B, D and E. D is not positive.
pub(crate) const MATRIX_SCALES: [f64; 4] = [1.0, 1.25, -2.0, 2.0];
/// The count of the largest value.
const COUNTS: f64 = 65535.0;

/// The elements of a matrix, over √α and √(1 − μ).
const MATRIX_ELEMENTS: usize = 4;
/// n_A and f_A, over √α and tan(θ/2) + tan(δ/2).
const ALBEDOS: usize = 2;

/// First the matrices, then the albedos. The second coordinate changes fastest.
#[rustfmt::skip]
static BYTES: &[u8; 2 * KNOTS * KNOTS * (MATRIX_ELEMENTS + ALBEDOS)] = include_bytes!("ltc.bin");

/// The elements A, B, D and E, interpolated linearly at √α = `root` and √(1 − μ) = `incidence`.
pub(crate) fn matrix(root: f64, incidence: f64) -> [f64; 4] {
    let mut elements = interpolated::<MATRIX_ELEMENTS>(0, root, incidence);
    for (element, scale) in elements.iter_mut().zip(MATRIX_SCALES) {
        *element *= scale;
    }
    elements
}

/// The albedos n_A and f_A, interpolated linearly at √α = `root` and tan(θ/2) + tan(δ/2) = 2·`incidence`.
pub(crate) fn albedos(root: f64, incidence: f64) -> [f64; 2] {
    interpolated::<ALBEDOS>(MATRIX_ELEMENTS * KNOTS * KNOTS, root, incidence)
}

/// Interpolates `K` elements of the part that starts at the element `start`, as shares of their largest
/// values. Both coordinates are in \[0, 1\], to which they are clamped.
fn interpolated<const K: usize>(start: usize, x: f64, y: f64) -> [f64; K] {
    let ((i, u), (j, v)) = (knot_and_rest(x), knot_and_rest(y));
    let mut sum = [0.0; K];
    for (i, u) in [(i, 1.0 - u), (i + 1, u)] {
        // Two knots side by side.
        let first = 2 * (start + (i * KNOTS + j) * K);
        let (near, far) = BYTES[first..first + 4 * K].split_at(2 * K);
        for (knot, v) in [(near, 1.0 - v), (far, v)] {
            let weight = u * v * (1.0 / COUNTS);
            for (sum, bytes) in sum.iter_mut().zip(knot.chunks_exact(2)) {
                *sum += weight * f64::from(u16::from_le_bytes([bytes[0], bytes[1]]));
            }
        }
    }
    sum
}

/// The knot at or below `share` of the whole range, the last but one at most, and the rest.
fn knot_and_rest(share: f64) -> (usize, f64) {
    let at = share.clamp(0.0, 1.0) * (KNOTS - 1) as f64;
    let knot = (at as usize).min(KNOTS - 2);
    (knot, at - knot as f64)
}
