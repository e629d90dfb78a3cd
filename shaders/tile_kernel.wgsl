// Tile kernel: the method of the paper in one pass. A workgroup parts the depths of its tile in two, lists the lights of
// each part in shared memory, and shades its pixels by these lists [Tokuyoshi & Harada 2017, Sec. 6]. Needs `kernel.wgsl`
// and what that says of shading.
//
// Any number of lights may touch a tile. When the lists might not have room for the next lights, the pixels are shaded by
// what is listed, and the lists begin anew. Lists are in the order of the lights, so the sums of two runs are the same bits.

/// Room for lights in each list. At least SLC_THREADS.
const SLC_LIST_ROOM: u32 = 512u;

/// A bit for each thread whose light touches the nearer part, then one for the farther part.
var<workgroup> slc_hits: array<atomic<u32>, 2u * SLC_WORDS>;
/// The list of the nearer part, then that of the farther part.
var<workgroup> slc_shared_lists: array<u32, 2u * SLC_LIST_ROOM>;
var<workgroup> slc_listed: vec2u;

/// One workgroup for each tile of each subregion.
@compute @workgroup_size(16, 16)
fn slc_cull_and_shade(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let subregion = group.z;
    let pixel = slc_join_pixel(slc_this.interleave, subregion, group.xy * SLC_TILE_SIZE + local.xy);
    let is_inside = all(pixel < slc_this.image_size);
    var surface: SlcSurface;
    var depth = 0.0;
    if is_inside {
        surface = slc_surface(pixel);
        depth = slc_depth(surface);
    }
    let halves = slc_modified_half_z(depth, thread);
    let tile = slc_tile(subregion, group.xy);
    let own = select(0u, 1u, depth > halves.middle);

    // Without surfaces there is nothing to light.
    let lights = select(slc_lights_in(slc_this.interleave, subregion, slc_this.lights), 0u, halves.near.x > halves.near.y);
    var sum = vec4f(0.0);
    var next = 0u;
    while next < lights {
        var listed = vec2u(0u);
        while next < lights && max(listed.x, listed.y) + SLC_THREADS <= SLC_LIST_ROOM {
            listed = slc_list_in_order(thread, subregion, next, lights, tile, halves, listed);
            next += SLC_THREADS;
        }
        if depth > 0.0 {
            let count = select(listed.x, listed.y, own == 1u);
            for (var i = 0u; i < count; i++) {
                let light = slc_shared_lists[own * SLC_LIST_ROOM + i];
                sum += slc_reflected(surface, slc_light(light), light, slc_xis[light]);
            }
        }
        // Before the lists begin anew.
        workgroupBarrier();
    }
    if is_inside {
        slc_store(pixel, surface, sum);
    }
}

/// Appends those of the next SLC_THREADS lights that touch the tile to the lists, which hold so many already; returns how
/// many they hold then.
fn slc_list_in_order(
    thread: u32,
    subregion: u32,
    first: u32,
    lights: u32,
    tile: SlcTile,
    halves: SlcHalves,
    listed: vec2u,
) -> vec2u {
    if thread < 2u * SLC_WORDS {
        atomicStore(&slc_hits[thread], 0u);
    }
    workgroupBarrier();
    let light = slc_join_light(slc_this.interleave, subregion, first + thread);
    var is_hit = vec2<bool>(false);
    if first + thread < lights {
        let shape = slc_projected[light];
        let outline = slc_outline(shape, tile);
        is_hit.x = slc_may_light(shape, tile, outline, halves.near);
        is_hit.y = slc_may_light(shape, tile, outline, halves.far);
        let bit = 1u << (thread % 32u);
        if is_hit.x {
            atomicOr(&slc_hits[thread / 32u], bit);
        }
        if is_hit.y {
            atomicOr(&slc_hits[SLC_WORDS + thread / 32u], bit);
        }
    }
    workgroupBarrier();
    let place = listed + vec2u(slc_hits_before(0u, thread), slc_hits_before(SLC_WORDS, thread));
    if is_hit.x {
        slc_shared_lists[place.x] = light;
    }
    if is_hit.y {
        slc_shared_lists[SLC_LIST_ROOM + place.y] = light;
    }
    if thread == SLC_THREADS - 1u {
        slc_listed = place + select(vec2u(0u), vec2u(1u), is_hit);
    }
    return workgroupUniformLoad(&slc_listed);
}

/// How many bits of the threads before this one are set, in the words from `first` on.
fn slc_hits_before(first: u32, thread: u32) -> u32 {
    var count = countOneBits(atomicLoad(&slc_hits[first + thread / 32u]) & ((1u << (thread % 32u)) - 1u));
    for (var word = 0u; word < thread / 32u; word++) {
        count += countOneBits(atomicLoad(&slc_hits[first + word]));
    }
    return count;
}
