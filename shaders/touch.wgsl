// Touch: the box test of a projected ellipsoid against a tile. Needs `num.wgsl` and `project.wgsl`.
//
// M takes the tile's rectangle, at depth 1, to a parallelogram. The bounding rectangle of that, scaled by all
// depths that tile and ellipsoid have in common, has an axis-aligned bounding box. The test rejects a tile if
// the point of the box that is nearest to the centre lies outside the unit sphere
// [Tokuyoshi & Harada 2017, Sec. 5.2]. The slopes and depths of the ellipsoid are compared first.

/// The slopes x/z and y/z of a tile: `TileRectangle` of the crate.
struct SlcTile {
    min: vec2f,
    max: vec2f,
}

/// Longest distance whose square is compared. The unit sphere is nearer.
const SLC_LARGEST_DISTANCE: f32 = 1.0e9;

/// Whether the ellipsoid may touch the tile at the depths from `depths.x` to `depths.y`: false only if it does not.
///
/// A tile with several ranges of depths computes the outline once, after the first range that meets the bounds.
fn slc_touches(ellipsoid: SlcProjected, tile: SlcTile, depths: vec2f) -> bool {
    return slc_bounds_meet(ellipsoid, tile, depths)
        && !slc_misses(ellipsoid, slc_outline(ellipsoid, tile), depths);
}

/// Whether the bounds of the ellipsoid meet the tile: its slopes and depths, six comparisons.
fn slc_bounds_meet(ellipsoid: SlcProjected, tile: SlcTile, depths: vec2f) -> bool {
    let slopes = ellipsoid.slopes;
    return all(slopes.xz <= tile.max) && all(tile.min <= slopes.yw)
        && ellipsoid.near <= depths.y && depths.x <= ellipsoid.far;
}

/// The least and the greatest x of the image of the tile at depth 1, and the same of y.
fn slc_outline(ellipsoid: SlcProjected, tile: SlcTile) -> vec4f {
    let left = ellipsoid.x_and_y_axes.xy * tile.min.x;
    let right = ellipsoid.x_and_y_axes.xy * tile.max.x;
    let bottom = ellipsoid.x_and_y_axes.zw * tile.min.y;
    let top = ellipsoid.x_and_y_axes.zw * tile.max.y;
    let low = min(left, right) + min(bottom, top) + ellipsoid.z_axis.xy;
    let high = max(left, right) + max(bottom, top) + ellipsoid.z_axis.xy;
    return vec4f(low.x, high.x, low.y, high.y);
}

/// Whether the box of an outline, at the depths that both tile and ellipsoid have, misses the unit sphere. The depths
/// must meet those of the ellipsoid.
fn slc_misses(ellipsoid: SlcProjected, outline: vec4f, depths: vec2f) -> bool {
    let near = max(depths.x, ellipsoid.near);
    let far = min(depths.y, ellipsoid.far);
    let box_min = vec3f(min(outline.xz * near, outline.xz * far), ellipsoid.z_axis.z * near);
    let box_max = vec3f(max(outline.yw * near, outline.yw * far), ellipsoid.z_axis.z * far);
    let nearest = min(max(ellipsoid.center, box_min), box_max);
    let apart = min(abs(ellipsoid.center - nearest), vec3f(SLC_LARGEST_DISTANCE));
    return dot(apart, apart) > 1.0;
}
