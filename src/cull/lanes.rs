//! Sixteen lights side by side, processed by vectors of any width.

use fearless_simd::{Simd, SimdBase, SimdMask};

use crate::num::{F32Lanes, MAX_LANES};
use crate::project::Projected;
use crate::view::ViewBounds;

/// The number of lights in a chunk: the lanes of the widest vectors.
pub(super) const LANES: usize = MAX_LANES;

/// One value for each of sixteen lights.
pub(super) type Lanes<T = f32> = [T; LANES];

/// The number of vectors of this width in a chunk.
pub(super) const fn parts<S: Simd>() -> usize {
    LANES / S::f32s::LEN
}

/// The `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, lanes: &Lanes, part: usize) -> F32Lanes<S> {
    F32Lanes(S::f32s::from_slice(
        simd,
        &lanes[part * S::f32s::LEN..][..S::f32s::LEN],
    ))
}

/// Stores the `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn store<S: Simd>(lanes: &mut Lanes, part: usize, vector: F32Lanes<S>) {
    let part = &mut lanes[part * S::f32s::LEN..][..S::f32s::LEN];
    vector.0.store_slice(part);
}

/// The `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn load_indices<S: Simd>(simd: S, lanes: &Lanes<u32>, part: usize) -> S::u32s {
    S::u32s::from_slice(simd, &lanes[part * S::u32s::LEN..][..S::u32s::LEN])
}

/// The mask of the first `count` lanes, or of all.
#[inline(always)]
pub(super) fn mask_of_first<S: Simd>(simd: S, count: usize) -> S::mask32s {
    S::mask32s::from_bitmask(simd, (1 << count.min(S::f32s::LEN)) - 1)
}

/// The numbers from `first` on.
#[inline(always)]
pub(super) fn numbers_from<S: Simd>(simd: S, first: usize) -> S::u32s {
    const ZERO_AND_SO_ON: Lanes<u32> = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
    load_indices(simd, &ZERO_AND_SO_ON, 0) + first as u32
}

/// The same range in each lane.
#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, [min, max]: [f32; 2]) -> [F32Lanes<S>; 2] {
    [F32Lanes::new(simd, min), F32Lanes::new(simd, max)]
}

/// The same bounds in each lane.
#[inline(always)]
pub(super) fn splat_bounds<S: Simd>(simd: S, bounds: &ViewBounds<f32>) -> ViewBounds<F32Lanes<S>> {
    ViewBounds {
        across: splat(simd, bounds.across),
        down: splat(simd, bounds.down),
        depths: splat(simd, bounds.depths),
    }
}

/// One cache line of numbers, such as the fields of a shape, padded with zeros.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Record(pub Lanes);

impl Record {
    pub fn new<P: Projected>(fields: &P::Fields<f32>) -> Self {
        let mut record = Self([0.0; LANES]);
        for (to, field) in record.0.iter_mut().zip(fields.as_ref()) {
            *to = *field;
        }
        record
    }

    pub fn fields<P: Projected>(&self) -> P::Fields<f32> {
        let mut fields = P::fields_of(0.0);
        for (field, from) in fields.as_mut().iter_mut().zip(self.0) {
            *field = from;
        }
        fields
    }
}

/// Transposes as many records as a vector has lanes: the fields of the shapes that `record` gives for each lane.
#[inline(always)]
pub(super) fn load_records<'a, S: Simd, P: Projected>(
    simd: S,
    record: impl Fn(usize) -> &'a Record,
) -> P::Fields<F32Lanes<S>> {
    let mut fields = P::fields_of(F32Lanes::new(simd, 0.0));
    for (field, vector) in fields.as_mut().iter_mut().zip(load_lines(simd, record)) {
        *field = vector;
    }
    fields
}

/// Transposes as many records as a vector has lanes, whatever they hold: the numbers of those that `record` gives
/// for each lane.
#[inline(always)]
pub(super) fn load_lines<'a, S: Simd>(
    simd: S,
    record: impl Fn(usize) -> &'a Record,
) -> Lanes<F32Lanes<S>> {
    let mut vectors = [F32Lanes::new(simd, 0.0); LANES];
    for lane in 0..S::f32s::LEN {
        for part in 0..parts::<S>() {
            vectors[part * S::f32s::LEN + lane] = load(simd, &record(lane).0, part);
        }
    }
    transpose(vectors)
}

/// Writes a record for each lane of `fields`, the inverse of [`load_records`]: those of the lanes in `chosen` to
/// the front of `records`. The rest of as many as there are lanes may change too.
#[inline(always)]
pub(super) fn store_records<S: Simd>(
    simd: S,
    fields: impl Iterator<Item = F32Lanes<S>>,
    chosen: S::mask32s,
    records: &mut [Record],
) {
    let mut vectors = [F32Lanes::new(simd, 0.0); LANES];
    for (vector, field) in vectors.iter_mut().zip(fields) {
        *vector = field;
    }
    let vectors = transpose(vectors);
    let records = &mut records[..S::f32s::LEN];
    // Most vectors are full.
    if chosen.all_true() {
        for (lane, record) in records.iter_mut().enumerate() {
            store_record(record, &vectors, lane);
        }
        return;
    }
    // Each record is overwritten by the next one unless it is chosen.
    let (mut end, bits) = (0, chosen.to_bitmask());
    for lane in 0..S::f32s::LEN {
        store_record(&mut records[end], &vectors, lane);
        end += (bits >> lane & 1) as usize;
    }
}

/// Stores the record of a lane from `vectors` that are transposed.
#[inline(always)]
fn store_record<S: Simd>(record: &mut Record, vectors: &Lanes<F32Lanes<S>>, lane: usize) {
    for part in 0..parts::<S>() {
        store(&mut record.0, part, vectors[part * S::f32s::LEN + lane]);
    }
}

/// Transposes squares of as many vectors as a vector has lanes. The first square comes first.
#[inline(always)]
fn transpose<S: Simd>(vectors: Lanes<F32Lanes<S>>) -> Lanes<F32Lanes<S>> {
    // A perfect shuffle of the elements of a square, once for each bit of the index of a lane.
    let shuffled = shuffle(shuffle(vectors));
    match S::f32s::LEN {
        4 => shuffled,
        8 => shuffle(shuffled),
        _ => shuffle(shuffle(shuffled)),
    }
}

/// Interleaves the upper half of each square with its lower half.
#[inline(always)]
fn shuffle<S: Simd>(vectors: Lanes<F32Lanes<S>>) -> Lanes<F32Lanes<S>> {
    let (mut shuffled, half) = (vectors, S::f32s::LEN / 2);
    for part in 0..parts::<S>() {
        let first = part * S::f32s::LEN;
        for i in first..first + half {
            let (low, high) = vectors[i].0.interleave(vectors[i + half].0);
            shuffled[2 * i - first] = F32Lanes(low);
            shuffled[2 * i + 1 - first] = F32Lanes(high);
        }
    }
    shuffled
}

/// Moves the numbers that are `chosen` to the first lanes.
#[inline(always)]
pub(super) fn compress<S: Simd>(numbers: F32Lanes<S>, chosen: S::mask32s) -> S::f32s {
    numbers.0.compress(chosen)
}

/// Writes those of `numbers` that are `chosen` to the front of `out`. The rest of it may change too. Returns
/// how many are chosen.
///
/// Does not branch on which lanes are chosen, since it would often be mispredicted.
#[inline(always)]
pub(super) fn write_chosen<S: Simd>(
    numbers: S::u32s,
    chosen: S::mask32s,
    out: &mut [u32],
) -> usize {
    let bits = chosen.to_bitmask();
    if S::u32s::LEN > 4 {
        numbers
            .compress(chosen)
            .store_slice(&mut out[..S::u32s::LEN]);
        return bits.count_ones() as usize;
    }
    // SSE2 has no instruction to compress. Each number is overwritten by the next one unless it is chosen.
    let mut end = 0;
    for (lane, number) in numbers.as_slice().iter().enumerate() {
        out[end] = *number;
        end += (bits >> lane & 1) as usize;
    }
    end
}
