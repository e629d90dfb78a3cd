//! The table of linearly transformed cosines that are fitted to GGX lobes, and of the albedos of these lobes.
//!
//! `examples/tabulate` makes it. Each element is a `u16` that counts 65535ths of the largest value, which
//! moves no matrix by more than 2·10⁻⁵ of its largest element. A and E count 66 at least, which keeps every
//! matrix invertible. Both parts together take 49,152 bytes.

/// The number of knots along each coordinate.
pub(crate) const KNOTS: usize = 64;
/// The largest value of each element of a matrix: A, B, D and E. D is not positive.
pub(crate) const MATRIX_SCALES: [f64; 4] = [1.0, 1.25, -2.0, 2.0];
/// The least roughness α of a matrix that is looked up, and the least product αμ.
pub(crate) const LEAST_ROUGHNESS: f32 = 3e-5;
pub(crate) const LEAST_WIDTH: f32 = 2.4e-5;
/// The count of the largest value.
const COUNTS: f64 = 65535.0;

/// The elements of a matrix, over √α and √(1 − μ).
const MATRIX_ELEMENTS: usize = 4;
/// n_A and f_A, over √α and tan(θ/2) + tan(δ/2).
const ALBEDOS: usize = 2;

/// First the matrices, then the albedos. The second coordinate changes fastest.
#[rustfmt::skip]
const BYTES: &[u8; 2 * KNOTS * KNOTS * (MATRIX_ELEMENTS + ALBEDOS)] = include_bytes!("ltc.bin");

/// The counts of A, B, D and E at each knot.
pub(crate) type Matrices = [[u16; MATRIX_ELEMENTS]; KNOTS * KNOTS];

pub(crate) static MATRICES: Matrices = knots_from(0);
static ALBEDO_PAIRS: [[u16; ALBEDOS]; KNOTS * KNOTS] = knots_from(MATRIX_ELEMENTS * KNOTS * KNOTS);

/// The knots of the part that starts at the element `start`.
const fn knots_from<const K: usize>(start: usize) -> [[u16; K]; KNOTS * KNOTS] {
    let mut knots = [[0; K]; KNOTS * KNOTS];
    let mut i = 0;
    while i < K * KNOTS * KNOTS {
        let at = 2 * (start + i);
        knots[i / K][i % K] = u16::from_le_bytes([BYTES[at], BYTES[at + 1]]);
        i += 1;
    }
    knots
}

/// The elements A, B, D and E, interpolated linearly at √α = `root` and √(1 − μ) = `incidence`.
#[inline]
pub(crate) fn matrix(root: f64, incidence: f64) -> [f64; MATRIX_ELEMENTS] {
    matrix_of(&MATRICES, root, incidence)
}

/// As [`matrix`], of these knots.
#[inline(always)]
pub(crate) fn matrix_of(knots: &Matrices, root: f64, incidence: f64) -> [f64; MATRIX_ELEMENTS] {
    let mut elements = interpolated(knots, knot_and_rest(root), knot_and_rest(incidence));
    for (element, scale) in elements.iter_mut().zip(MATRIX_SCALES) {
        *element *= scale;
    }
    elements
}

/// The albedos n_A and f_A, less what the fit gives away, interpolated linearly at √α = `root` and
/// tan(θ/2) + tan(δ/2) = 2·`incidence`.
#[inline]
pub(crate) fn albedos(root: f64, incidence: f64) -> [f64; ALBEDOS] {
    interpolated(&ALBEDO_PAIRS, knot_and_rest(root), knot_and_rest(incidence))
}

/// Interpolates `K` elements, as shares of their largest values.
#[inline(always)]
fn interpolated<const K: usize>(
    knots: &[[u16; K]; KNOTS * KNOTS],
    (i, u): (usize, f64),
    (j, v): (usize, f64),
) -> [f64; K] {
    let mut sum = [0.0; K];
    for (i, u) in [(i, 1.0 - u), (i + 1, u)] {
        for (j, v) in [(j, 1.0 - v), (j + 1, v)] {
            let weight = u * v * (1.0 / COUNTS);
            for (sum, count) in sum.iter_mut().zip(knots[i * KNOTS + j]) {
                *sum += weight * f64::from(count);
            }
        }
    }
    sum
}

/// The knot at or below `share` of the whole range, the last but one at most, and the rest. The share is clamped to
/// \[0, 1\].
#[inline(always)]
fn knot_and_rest(share: f64) -> (usize, f64) {
    let at = share.clamp(0.0, 1.0) * (KNOTS - 1) as f64;
    let knot = (at as usize).min(KNOTS - 2);
    (knot, at - knot as f64)
}
