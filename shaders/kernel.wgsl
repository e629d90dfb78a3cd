// Kernel: what the kernels share. Needs `frame.wgsl` and `touch.wgsl`, and those that they need.
//
// The buffers are those of `GpuBuffer`, in group 0. A shader that shades declares what it reads and writes, from binding 16
// on or in another group, and defines
//
//     struct SlcSurface { … }                          what a pixel sees
//     fn slc_surface(pixel: vec2u) -> SlcSurface       reads that
//     fn slc_depth(surface: SlcSurface) -> f32         its depth; zero for sky
//     fn slc_reflected(surface: SlcSurface, light: SlcLight, index: u32, xi: f32) -> vec4f
//                                                      what it reflects of a light, or zero: a term of the sum
//     fn slc_store(pixel: vec2u, surface: SlcSurface, sum: vec4f)
//                                                      writes the sum over the lights of the pixel
//
// A shader that bounds defines `fn slc_unit_bound(light: SlcLight) -> SlcBound`.

@group(0) @binding(0) var<uniform> slc_this: SlcFrame;
@group(0) @binding(1) var<storage, read> slc_lights: array<SlcLight>;
@group(0) @binding(2) var<storage, read> slc_projected: array<SlcProjected>;
@group(0) @binding(3) var<storage, read> slc_xis: array<f32>;
@group(0) @binding(4) var<storage, read> slc_edges: array<vec2f>;
@group(0) @binding(5) var<storage, read> slc_intervals: array<vec2f>;
@group(0) @binding(6) var<storage, read> slc_ranges: array<vec2u>;
@group(0) @binding(7) var<storage, read> slc_lists: array<u32>;

/// The side of a tile in pixels of its subregion.
const SLC_TILE_SIZE: u32 = 16u;
/// Threads of a workgroup, one for each pixel of a tile.
const SLC_THREADS: u32 = 256u;
/// Words with a bit for each thread.
const SLC_WORDS: u32 = 8u;
/// Begins the range of a list for which there was no room.
const SLC_NO_ROOM: u32 = 0xFFFFFFFFu;

/// A depth interval that holds nothing.
fn slc_no_depths() -> vec2f {
    return vec2f(SLC_FAR, -SLC_FAR);
}

/// A light, whose flux makes up for the lights that its subregion leaves out.
fn slc_light(index: u32) -> SlcLight {
    var light = slc_lights[index];
    light.flux *= f32(slc_this.interleave * slc_this.interleave);
    return light;
}

/// The number of the list of the first interval of a tile.
fn slc_first_list(subregion: u32, tile: vec2u) -> u32 {
    let tiles = slc_this.tiles;
    return ((subregion * tiles.y + tile.y) * tiles.x + tile.x) * slc_this.intervals;
}

/// The slopes of a tile.
fn slc_tile(subregion: u32, tile: vec2u) -> SlcTile {
    let width = slc_this.interleave;
    let tiles = slc_this.tiles;
    let across = slc_edges[(subregion % width) * tiles.x + tile.x];
    let down = slc_edges[width * tiles.x + (subregion / width) * tiles.y + tile.y];
    return SlcTile(vec2f(across.x, down.x), vec2f(across.y, down.y));
}

/// Whether a light may touch a tile at these depths, for the `slc_outline` of the two.
fn slc_may_light(shape: SlcProjected, tile: SlcTile, outline: vec4f, depths: vec2f) -> bool {
    if depths.x > depths.y {
        return false;
    }
    let near = max(depths.x - slc_depth_margin(slc_this.camera, depths.x), 0.0);
    let widened = vec2f(near, depths.y + slc_depth_margin(slc_this.camera, depths.y));
    return slc_bounds_meet(shape, tile, widened) && !slc_misses(shape, outline, widened);
}

/// What the pixels of a tile see, parted at the middle of its depths.
struct SlcHalves {
    /// The depths that are not greater than the middle.
    near: vec2f,
    far: vec2f,
    middle: f32,
}

/// The least and the greatest depth of all pixels, of the nearer and of the farther ones, as bits, whose order is that of
/// positive numbers.
var<workgroup> slc_least: array<atomic<u32>, 3>;
var<workgroup> slc_greatest: array<atomic<u32>, 3>;
var<workgroup> slc_middle: f32;
var<workgroup> slc_halves: vec4f;

/// Modified HalfZ: parts the depths of a tile at the middle of their interval; each part has the smallest interval that
/// holds it [Stewart 2015]. `DepthInterval::modified_half_z` of the crate.
///
/// Each thread of a workgroup brings the `depth` of its pixel, zero if it has none.
fn slc_modified_half_z(depth: f32, thread: u32) -> SlcHalves {
    let is_surface = depth > 0.0 && depth < SLC_FAR;
    let bits = bitcast<u32>(depth);
    if thread < 3u {
        atomicStore(&slc_least[thread], bitcast<u32>(SLC_FAR));
        atomicStore(&slc_greatest[thread], 0u);
    }
    workgroupBarrier();
    if is_surface {
        atomicMin(&slc_least[0], bits);
        atomicMax(&slc_greatest[0], bits);
    }
    workgroupBarrier();
    if thread == 0u {
        let whole = slc_depths_of_part(0u);
        slc_middle = clamp(0.5 * whole.x + 0.5 * whole.y, min(whole.x, whole.y), max(whole.x, whole.y));
    }
    let middle = workgroupUniformLoad(&slc_middle);
    if is_surface {
        let part = select(1u, 2u, depth > middle);
        atomicMin(&slc_least[part], bits);
        atomicMax(&slc_greatest[part], bits);
    }
    workgroupBarrier();
    if thread == 0u {
        slc_halves = vec4f(slc_depths_of_part(1u), slc_depths_of_part(2u));
    }
    let halves = workgroupUniformLoad(&slc_halves);
    return SlcHalves(halves.xy, halves.zw, middle);
}

/// The interval of all depths, of the nearer ones or of the farther ones.
fn slc_depths_of_part(part: u32) -> vec2f {
    let greatest = atomicLoad(&slc_greatest[part]);
    if greatest == 0u {
        return slc_no_depths();
    }
    return vec2f(bitcast<f32>(atomicLoad(&slc_least[part])), bitcast<f32>(greatest));
}
