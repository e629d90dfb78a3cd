use glam::Vec3;

use crate::base::Error;

/// Ranks `points` along a Hilbert curve through their bounding cube: points that lie near each other have
/// ranks near each other.
///
/// `ranks[i]` becomes the rank of `points[i]`. Every rank below the number of points occurs once. For
/// [`FrameSeed::xi_of_rank`](crate::FrameSeed::xi_of_rank), a point should tell where a light shines: the
/// center of its bound at ξ = 1, or else its position.
///
/// The curve visits 2²² cells. Points in the same cell keep their order, and so do all points if the cube is
/// infinitely larger or smaller than `f32` can tell. A coordinate that is NaN counts as the least one of all
/// points, and an infinite one as the least or the greatest. Takes time linear in the number of points, about
/// eight nanoseconds a point, and does not allocate: `scratch` is memory to work in, of two words a point.
///
/// ```
/// use stochastic_light_culling::{glam::Vec3, rank_along_curve};
///
/// let points = [[0.0, 0.1], [9.0, 9.0], [9.0, 8.9], [0.1, 0.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
/// let (mut ranks, mut scratch) = ([0; 4], [0; 8]);
/// rank_along_curve(&points, &mut ranks, &mut scratch)?;
/// assert!(ranks[0].abs_diff(ranks[3]) == 1 && ranks[1].abs_diff(ranks[2]) == 1);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::Count`] if `ranks` has another length than `points`, if `scratch` has less than twice that
/// length, or if there are more than 2³² − 1 points.
pub fn rank_along_curve(
    points: &[Vec3],
    ranks: &mut [u32],
    scratch: &mut [u64],
) -> Result<(), Error> {
    let count = u32::try_from(points.len()).map_err(|_| Error::Count {
        quantity: "number of points",
        value: points.len(),
        valid: "at most 2³² − 1",
    })?;
    if ranks.len() != points.len() {
        return Err(Error::Count {
            quantity: "number of ranks",
            value: ranks.len(),
            valid: "the number of points",
        });
    }
    if scratch.len() / 2 < points.len() {
        return Err(Error::Count {
            quantity: "number of words to work in",
            value: scratch.len(),
            valid: "at least twice the number of points",
        });
    }

    let (keys, sorted) = scratch.split_at_mut(points.len());
    let cube = Cube::around(points);
    let mut starts = [[0; BUCKETS]; 2];
    for (key, point) in keys.iter_mut().zip(points) {
        *key = u64::from(octants(cube.cell(*point)));
    }
    for (index, key) in (0..count).zip(&mut *keys) {
        let place = place_of(*key as u32) >> (3 * CELL_BITS - 2 * DIGIT_BITS);
        *key = u64::from(place) << 32 | u64::from(index);
        for (digit, starts) in starts.iter_mut().enumerate() {
            starts[bucket(*key, digit)] += 1;
        }
    }
    for starts in &mut starts {
        let mut start = 0;
        for bucket in starts {
            start += core::mem::replace(bucket, start);
        }
    }

    // A radix sort. Its last pass needs the places alone.
    let [low, high] = &mut starts;
    for key in keys {
        sorted[take(&mut low[bucket(*key, 0)]) as usize] = *key;
    }
    for key in &sorted[..points.len()] {
        ranks[*key as u32 as usize] = take(&mut high[bucket(*key, 1)]);
    }
    Ok(())
}

/// Bits of a coordinate of a cell.
const CELL_BITS: u32 = 8;
/// Bits of a digit of the radix sort, which has two.
const DIGIT_BITS: u32 = 11;
const BUCKETS: usize = 1 << DIGIT_BITS;

/// The `digit`-th digit of a key, which is a place along the curve above an index.
#[inline]
fn bucket(key: u64, digit: usize) -> usize {
    (key >> (32 + digit as u32 * DIGIT_BITS)) as usize % BUCKETS
}

/// Returns `next`, and increments it.
#[inline]
fn take(next: &mut u32) -> u32 {
    let taken = *next;
    *next += 1;
    taken
}

/// An axis-aligned cube, divided into cells.
struct Cube {
    min: Vec3,
    /// Cells per length.
    scale: f32,
}

impl Cube {
    fn around(points: &[Vec3]) -> Self {
        // Not `f32::MAX`, of which differences overflow.
        let far = Vec3::splat(0.5 * f32::MAX);
        let (mut min, mut max) = (far, -far);
        for point in points {
            // Of two numbers, `<` chooses the one that is not NaN.
            min = Vec3::select(point.cmplt(min), *point, min);
            max = Vec3::select(point.cmpgt(max), *point, max);
        }
        let (min, max) = (min.max(-far), max.min(far));
        Self {
            min,
            scale: 255.0 / (max - min).max_element().max(f32::MIN_POSITIVE),
        }
    }

    /// The coordinates of the cell with `point`, below 2⁸.
    #[inline]
    fn cell(&self, point: Vec3) -> [u32; 3] {
        const LAST: f32 = ((1 << CELL_BITS) - 1) as f32;
        // The unit in the last place is 1 there, so that adding it rounds to an integer in the low bits.
        const LARGE: f32 = (1 << 23) as f32;
        ((point - self.min) * self.scale).to_array().map(|x| {
            // Zero for NaN.
            let x = if x > 0.0 { x } else { 0.0 };
            let x = if x < LAST { x } else { LAST };
            (x + LARGE).to_bits() % (1 << CELL_BITS)
        })
    }
}

/// The octants that hold a cell, from the whole cube's down, of three bits each.
#[inline]
fn octants(cell: [u32; 3]) -> u32 {
    let [x, y, z] = cell.map(spread);
    x | y << 1 | z << 2
}

/// The place along the curve of the cell in these octants, of as many bits.
#[inline]
fn place_of(octants: u32) -> u32 {
    let (mut place, mut state) = (0, 0);
    // Two levels of the octree at a time.
    let mut shift = 3 * CELL_BITS;
    while shift > 0 {
        shift -= 6;
        let step = STEPS[state][(octants >> shift) as usize % 64];
        place = place << 6 | u32::from(step % 64);
        state = usize::from(step / 64) % PADDED_STATES;
    }
    place
}

/// Moves the `i`-th of eight bits to the place 3·i.
#[inline]
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 8) & 0x0000_f00f;
    let bits = (bits | bits << 4) & 0x000c_30c3;
    (bits | bits << 2) & 0x0024_9249
}

/// The curve enters an octant at one of eight corners, and leaves it along one of three axes.
const STATES: usize = 24;
/// A power of two, so that an index needs no check.
const PADDED_STATES: usize = 32;

/// For each state and the octants of two levels: the place of these among 64, and 64 times the next state.
const STEPS: [[u16; 64]; PADDED_STATES] = {
    let mut steps = [[0; 64]; PADDED_STATES];
    let mut state = 0;
    while state < STATES {
        let mut octants = 0;
        while octants < 64 {
            let (first, middle) = step(state as u32, octants >> 3);
            let (second, next) = step(middle, octants & 7);
            steps[state][octants as usize] = (next << 6 | first << 3 | second) as u16;
            octants += 1;
        }
        state += 1;
    }
    steps
};

/// The place of `octant` among the eight that the curve visits from `state`, and the state inside it
/// [Hamilton & Rau-Chaplin 2008, "Compact Hilbert indices"].
const fn step(state: u32, octant: u32) -> (u32, u32) {
    let (corner, axis) = (state % 8, state / 8);
    let gray = rotated(octant ^ corner, 2 - axis);
    let place = gray ^ gray >> 1 ^ gray >> 2;
    let entry = match place {
        0 => 0,
        _ => gray_code((place - 1) & !1),
    };
    let turns = match place {
        0 => 0,
        _ if place % 2 == 0 => (place - 1).trailing_ones(),
        _ => place.trailing_ones(),
    };
    let corner = corner ^ rotated(entry, axis + 1);
    let axis = (axis + turns + 1) % 3;
    (place, axis * 8 + corner)
}

const fn gray_code(place: u32) -> u32 {
    place ^ place >> 1
}

/// Rotates three bits up by `by` ≤ 3.
const fn rotated(bits: u32, by: u32) -> u32 {
    (bits << by | bits >> (3 - by)) & 7
}

#[cfg(test)]
#[expect(
    clippy::large_stack_arrays,
    reason = "without an allocator there is no heap"
)]
mod tests {
    use super::*;

    /// Consecutive places are cells side by side, and each cell is visited once.
    #[test]
    fn the_curve_is_continuous() {
        let mut cells = [[u32::MAX; 3]; 1 << 12];
        for cell in 0..1 << 12 {
            let cell = [cell % 16, cell / 16 % 16, cell / 256];
            cells[place_of(octants(cell)) as usize] = cell;
        }
        assert_eq!(place_of(0), 0);
        for pair in cells.windows(2) {
            let apart: u32 = (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).sum();
            assert_eq!(apart, 1, "{pair:?}");
        }
    }

    /// The curve continues from one cube of sixteen cells to the next at all levels.
    #[test]
    fn ends_meet() {
        // The first and the last cell of each cube, along the curve.
        let mut ends = [[[u32::MAX; 3]; 2]; 1 << 12];
        for block in 0..1 << 12_u32 {
            let corner = [block % 16, block / 16 % 16, block / 256].map(|x| 16 * x);
            for offset in 0..1 << 12_u32 {
                let [x, y, z] = [offset % 16, offset / 16 % 16, offset / 256];
                let cell = [corner[0] + x, corner[1] + y, corner[2] + z];
                let place = place_of(octants(cell));
                match place % 4096 {
                    0 => ends[place as usize / 4096][0] = cell,
                    4095 => ends[place as usize / 4096][1] = cell,
                    _ => {}
                }
            }
        }
        for pair in ends.windows(2) {
            let (before, after) = (pair[0][1], pair[1][0]);
            let apart: u32 = (0..3).map(|k| before[k].abs_diff(after[k])).sum();
            assert_eq!(apart, 1, "{before:?} {after:?}");
        }
    }
}
