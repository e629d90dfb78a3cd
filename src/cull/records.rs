//! Cache lines of numbers, and the records of shapes in them.
//!
//! A *line* holds sixteen numbers. The record of a shape is a line, or half of one: the fields from which the others
//! follow. Vectors of lanes are read from records and written to them by transposing.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::lanes::{LANES, Lanes, load};
use crate::num::{F32Lanes, Single};
use crate::project::Projected;

/// One cache line of numbers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Line(pub Lanes);

impl Line {
    pub const ZERO: Self = Self([0.0; LANES]);
}

/// The number of records in a line.
const fn per_line<P: Projected>() -> usize {
    LANES / P::STORED
}

/// The number of lines that have room for `count` records.
pub(super) const fn lines_for<P: Projected>(count: usize) -> usize {
    count.div_ceil(per_line::<P>())
}

/// The record at `place`. `None` past the last line.
#[inline(always)]
pub(super) fn record<P: Projected>(lines: &[Line], place: usize) -> Option<&[f32]> {
    let line = lines.get(place / per_line::<P>())?;
    Some(&line.0[place % per_line::<P>() * P::STORED..][..P::STORED])
}

/// The record at `place`, to write it.
#[inline(always)]
pub(super) fn record_mut<P: Projected>(lines: &mut [Line], place: usize) -> &mut [f32] {
    let line = &mut lines[place / per_line::<P>()];
    &mut line.0[place % per_line::<P>() * P::STORED..][..P::STORED]
}

/// The fields of the shape that has this record.
#[inline(always)]
pub(super) fn fields_of_record<P: Projected>(record: &[f32]) -> P::Fields<f32> {
    let mut fields = P::fields_of(0.0);
    fields.as_mut()[..P::STORED].copy_from_slice(record);
    P::complete(&mut fields);
    fields
}

/// Transposes as many records as a vector has lanes: the fields of the shapes whose records `record` gives for each
/// lane.
#[inline(always)]
pub(super) fn load_records<'a, S: Simd, P: Projected>(
    simd: S,
    record: impl Fn(usize) -> &'a [f32],
) -> P::Fields<F32Lanes<S>> {
    let zero = F32Lanes::new(simd, 0.0);
    let (lanes, mut vectors) = (S::f32s::LEN, [zero; LANES]);
    if lanes <= P::STORED {
        for lane in 0..lanes {
            let record = record(lane);
            for part in 0..P::STORED / lanes {
                let part_of_record = &record[part * lanes..][..lanes];
                vectors[part * lanes + lane] = zero.load(part_of_record);
            }
        }
    } else {
        for (i, vector) in vectors[..P::STORED].iter_mut().enumerate() {
            let mut numbers = [0.0; LANES];
            for (j, numbers) in numbers[..lanes].chunks_exact_mut(P::STORED).enumerate() {
                numbers.copy_from_slice(record(i * (lanes / P::STORED) + j));
            }
            *vector = zero.load(&numbers);
        }
    }
    let vectors = rotate(vectors, P::STORED, lanes.ilog2());
    let mut fields = P::fields_of(zero);
    for (field, vector) in fields.as_mut()[..P::STORED].iter_mut().zip(vectors) {
        *field = vector;
    }
    P::complete(&mut fields);
    fields
}

/// Transposes as many lines as a vector has lanes: the numbers of those that `line` gives for each lane.
#[inline(always)]
pub(super) fn load_lines<'a, S: Simd>(
    simd: S,
    line: impl Fn(usize) -> &'a Line,
) -> Lanes<F32Lanes<S>> {
    let lanes = S::f32s::LEN;
    let mut vectors = [F32Lanes::new(simd, 0.0); LANES];
    for lane in 0..lanes {
        for part in 0..LANES / lanes {
            vectors[part * lanes + lane] = load(simd, &line(lane).0, part);
        }
    }
    rotate(vectors, LANES, lanes.ilog2())
}

/// Writes a record for each lane of `fields`, the inverse of [`load_records`]: those of the lanes in `chosen` to the
/// places from `first` on. The rest of as many as there are lanes may change too.
#[inline(always)]
pub(super) fn store_records<S: Simd, P: Projected>(
    simd: S,
    fields: impl Iterator<Item = F32Lanes<S>>,
    chosen: S::mask32s,
    lines: &mut [Line],
    first: usize,
) {
    let lanes = S::f32s::LEN;
    let mut vectors = [F32Lanes::new(simd, 0.0); LANES];
    for (vector, field) in vectors[..P::STORED].iter_mut().zip(fields) {
        *vector = field;
    }
    let vectors = rotate(vectors, P::STORED, lanes.min(P::STORED).ilog2());
    // Vectors may begin in the middle of a line.
    let (line, first) = (first / per_line::<P>(), first % per_line::<P>());
    let lines = &mut lines[line..][..lines_for::<P>(first + lanes)];
    // Most vectors are full.
    if chosen.all_true() {
        if lanes > P::STORED && first == 0 {
            for (line, vector) in lines.iter_mut().zip(vectors) {
                vector.0.store_slice(&mut line.0[..lanes]);
            }
        } else {
            for lane in 0..lanes {
                store_record::<S, P>(record_mut::<P>(lines, first + lane), &vectors, lane);
            }
        }
        return;
    }
    // Each record is overwritten by the next one unless it is chosen.
    let (mut end, bits) = (first, chosen.to_bitmask());
    for lane in 0..lanes {
        store_record::<S, P>(record_mut::<P>(lines, end), &vectors, lane);
        end += (bits >> lane & 1) as usize;
    }
}

/// Stores the record of a lane from `vectors` that are transposed.
#[inline(always)]
fn store_record<S: Simd, P: Projected>(
    record: &mut [f32],
    vectors: &Lanes<F32Lanes<S>>,
    lane: usize,
) {
    let lanes = S::f32s::LEN;
    if lanes <= P::STORED {
        for (part, numbers) in record.chunks_exact_mut(lanes).enumerate() {
            vectors[part * lanes + lane].0.store_slice(numbers);
        }
    } else {
        let per_vector = lanes / P::STORED;
        let numbers = vectors[lane / per_vector].0.as_slice();
        record.copy_from_slice(&numbers[lane % per_vector * P::STORED..][..P::STORED]);
    }
}

/// Rotates the bits of the index of each number by `steps` to the left. The first `count` vectors hold the numbers, in
/// squares of as many vectors as a vector has lanes, or in one part of a square. The index is that in a square or
/// such a part.
///
/// By as many steps as the index of a lane has bits, this transposes a square, or takes records to fields. By as many
/// as the index of a field has, it takes fields to records.
#[inline(always)]
fn rotate<S: Simd>(
    mut vectors: Lanes<F32Lanes<S>>,
    count: usize,
    steps: u32,
) -> Lanes<F32Lanes<S>> {
    for _ in 0..steps {
        vectors = shuffle(vectors, count);
    }
    vectors
}

/// Interleaves the upper half of each square, or part of a square, with its lower half.
#[inline(always)]
fn shuffle<S: Simd>(vectors: Lanes<F32Lanes<S>>, count: usize) -> Lanes<F32Lanes<S>> {
    let (mut shuffled, side) = (vectors, S::f32s::LEN.min(count));
    for first in (0..count).step_by(side) {
        for i in first..first + side / 2 {
            let (low, high) = vectors[i].0.interleave(vectors[i + side / 2].0);
            shuffled[2 * i - first] = F32Lanes(low);
            shuffled[2 * i + 1 - first] = F32Lanes(high);
        }
    }
    shuffled
}
