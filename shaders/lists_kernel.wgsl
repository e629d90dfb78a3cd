// Lists kernel: for each depth interval of each tile, the lights that may touch it, in memory: `LightLists` of the crate.
// Needs `kernel.wgsl`.
//
// A workgroup counts the lights of its tile's intervals, reserves room for all of them at once, and lists them in the
// order of the lights. Lists for which there is no room begin with SLC_NO_ROOM; `slc_list_length` and
// `slc_listed_light` take them to hold all lights.

@group(0) @binding(6) var<storage, read_write> slc_new_ranges: array<vec2u>;
@group(0) @binding(7) var<storage, read_write> slc_new_lists: array<u32>;
@group(0) @binding(8) var<storage, read_write> slc_needed: atomic<u32>;

const SLC_MOST_INTERVALS: u32 = 32u;

/// For each interval, how many lights it has.
var<workgroup> slc_interval_counts: array<atomic<u32>, SLC_MOST_INTERVALS>;
/// For each interval, where its next light goes, if there is room.
var<workgroup> slc_interval_ends: array<u32, SLC_MOST_INTERVALS>;
/// For each interval, a bit for each thread whose light touches it.
var<workgroup> slc_interval_hits: array<atomic<u32>, SLC_MOST_INTERVALS * SLC_WORDS>;
var<workgroup> slc_has_room: u32;

/// One workgroup for each tile of each subregion.
@compute @workgroup_size(256)
fn slc_list_lights(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let subregion = group.z;
    let tile = slc_tile(subregion, group.xy);
    let list = slc_first_list(subregion, group.xy);
    let lights = slc_lights_in(slc_this.interleave, subregion, slc_this.lights);
    let intervals = min(slc_this.intervals, SLC_MOST_INTERVALS);
    if thread < intervals {
        atomicStore(&slc_interval_counts[thread], 0u);
    }
    workgroupBarrier();
    for (var first = 0u; first < lights; first += SLC_THREADS) {
        let hits = slc_intervals_hit(subregion, first + thread, lights, tile, list, intervals);
        for (var rest = hits; rest != 0u; rest &= rest - 1u) {
            atomicAdd(&slc_interval_counts[firstTrailingBit(rest)], 1u);
        }
    }
    workgroupBarrier();
    if thread == 0u {
        slc_has_room = slc_reserve(list, intervals);
    }
    if workgroupUniformLoad(&slc_has_room) == 0u {
        return;
    }
    for (var first = 0u; first < lights; first += SLC_THREADS) {
        for (var word = thread; word < intervals * SLC_WORDS; word += SLC_THREADS) {
            atomicStore(&slc_interval_hits[word], 0u);
        }
        workgroupBarrier();
        let hits = slc_intervals_hit(subregion, first + thread, lights, tile, list, intervals);
        for (var rest = hits; rest != 0u; rest &= rest - 1u) {
            let word = firstTrailingBit(rest) * SLC_WORDS + thread / 32u;
            atomicOr(&slc_interval_hits[word], 1u << (thread % 32u));
        }
        workgroupBarrier();
        let light = slc_join_light(slc_this.interleave, subregion, first + thread);
        for (var rest = hits; rest != 0u; rest &= rest - 1u) {
            let interval = firstTrailingBit(rest);
            slc_new_lists[slc_interval_ends[interval] + slc_interval_hits_before(interval, thread)] = light;
        }
        workgroupBarrier();
        if thread < intervals {
            slc_interval_ends[thread] += slc_interval_hits_before(thread, SLC_THREADS);
        }
        workgroupBarrier();
    }
}

/// The intervals of a tile that a light may touch, a bit for each.
fn slc_intervals_hit(subregion: u32, place: u32, lights: u32, tile: SlcTile, list: u32, intervals: u32) -> u32 {
    if place >= lights {
        return 0u;
    }
    let shape = slc_projected[slc_join_light(slc_this.interleave, subregion, place)];
    let outline = slc_outline(shape, tile);
    var hits = 0u;
    for (var interval = 0u; interval < intervals; interval++) {
        if slc_may_light(shape, tile, outline, slc_intervals[list + interval]) {
            hits |= 1u << interval;
        }
    }
    return hits;
}

/// Reserves room for the lists of a tile, and writes their ranges. Returns 1 if there is room, else 0.
fn slc_reserve(list: u32, intervals: u32) -> u32 {
    var total = 0u;
    for (var interval = 0u; interval < intervals; interval++) {
        total += atomicLoad(&slc_interval_counts[interval]);
    }
    // A sum that would not fit stays at the most there is.
    var start = atomicLoad(&slc_needed);
    loop {
        let sum = start + min(total, 0xFFFFFFFFu - start);
        let exchanged = atomicCompareExchangeWeak(&slc_needed, start, sum);
        if exchanged.exchanged {
            break;
        }
        start = exchanged.old_value;
    }
    let has_room = start <= slc_this.room && total <= slc_this.room - start;
    for (var interval = 0u; interval < intervals; interval++) {
        let count = atomicLoad(&slc_interval_counts[interval]);
        var range = vec2u(0u);
        if count > 0u && has_room {
            range = vec2u(start, start + count);
        } else if count > 0u {
            range = vec2u(SLC_NO_ROOM);
        }
        slc_interval_ends[interval] = start;
        slc_new_ranges[list + interval] = range;
        start += count;
    }
    return select(0u, 1u, has_room);
}

/// How many of the threads before this one have a light that touches the interval.
fn slc_interval_hits_before(interval: u32, thread: u32) -> u32 {
    let first = interval * SLC_WORDS;
    var count = 0u;
    for (var word = 0u; word < thread / 32u; word++) {
        count += countOneBits(atomicLoad(&slc_interval_hits[first + word]));
    }
    if thread % 32u != 0u {
        let bits = atomicLoad(&slc_interval_hits[first + thread / 32u]);
        count += countOneBits(bits & ((1u << (thread % 32u)) - 1u));
    }
    return count;
}
