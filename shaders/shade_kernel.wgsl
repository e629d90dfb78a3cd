// Shade kernel: shades pixels by the lists of their tiles' depth intervals. Needs `kernel.wgsl` and what that says of
// shading.

/// One workgroup for each tile of each subregion.
@compute @workgroup_size(16, 16)
fn slc_shade(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let subregion = group.z;
    let pixel = slc_join_pixel(slc_this.interleave, subregion, group.xy * SLC_TILE_SIZE + local.xy);
    if any(pixel >= slc_this.image_size) {
        return;
    }
    let surface = slc_surface(pixel);
    let depth = slc_depth(surface);
    var sum = vec4f(0.0);
    if depth > 0.0 {
        let range = slc_range_of(subregion, group.xy, depth);
        let count = slc_list_length(range, subregion);
        for (var i = 0u; i < count; i++) {
            let light = slc_listed_light(range, subregion, i);
            sum += slc_reflected(surface, slc_light(light), light, slc_xis[light]);
        }
    }
    slc_store(pixel, surface, sum);
}

/// The range of the list of the lights that may reach a surface at this depth of a tile. All lights if the tile's
/// intervals do not hold the depth.
fn slc_range_of(subregion: u32, tile: vec2u, depth: f32) -> vec2u {
    let list = slc_first_list(subregion, tile);
    // Computed anew, the depth may differ. Lists have lights for twice as much.
    let margin = 0.5 * slc_depth_margin(slc_this.camera, depth);
    for (var interval = 0u; interval < slc_this.intervals; interval++) {
        let depths = slc_intervals[list + interval];
        if depths.x - margin <= depth && depth <= depths.y + margin {
            return slc_ranges[list + interval];
        }
    }
    return vec2u(SLC_NO_ROOM);
}

/// The number of lights in a list.
fn slc_list_length(range: vec2u, subregion: u32) -> u32 {
    if range.x == SLC_NO_ROOM {
        return slc_lights_in(slc_this.interleave, subregion, slc_this.lights);
    }
    return range.y - range.x;
}

/// The index of the i-th light in a list.
fn slc_listed_light(range: vec2u, subregion: u32, i: u32) -> u32 {
    if range.x == SLC_NO_ROOM {
        return slc_join_light(slc_this.interleave, subregion, i);
    }
    return slc_lists[range.x + i];
}
