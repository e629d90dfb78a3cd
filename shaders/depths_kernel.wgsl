// Depths kernel: the depth intervals of tiles, for the kernel of lists. Needs `kernel.wgsl` and, of what that says of
// shading, `SlcSurface`, `slc_surface` and `slc_depth`.
//
// A tile with two or more intervals gets those of Modified HalfZ, and one with one gets all of its depths.

@group(0) @binding(5) var<storage, read_write> slc_new_intervals: array<vec2f>;

/// One workgroup for each tile of each subregion.
@compute @workgroup_size(16, 16)
fn slc_part_depths(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let subregion = group.z;
    let pixel = slc_join_pixel(slc_this.interleave, subregion, group.xy * SLC_TILE_SIZE + local.xy);
    var depth = 0.0;
    if all(pixel < slc_this.image_size) {
        depth = slc_depth(slc_surface(pixel));
    }
    let halves = slc_modified_half_z(depth, thread);
    if thread >= slc_this.intervals {
        return;
    }
    var interval = slc_no_depths();
    if thread == 0u {
        let far = select(halves.near.y, halves.far.y, slc_this.intervals == 1u && halves.far.x <= halves.far.y);
        interval = vec2f(halves.near.x, far);
    } else if thread == 1u {
        interval = halves.far;
    }
    slc_new_intervals[slc_first_list(subregion, group.xy) + thread] = interval;
}
