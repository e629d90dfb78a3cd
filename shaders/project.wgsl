// Project: a bound as a unit sphere in the space of a camera with a perspective. Needs `num.wgsl` and
// `bound.wgsl`.
//
// A linear map M takes the ellipsoid, in camera space, to a unit sphere. Its third row is (0, 0, m), and one of
// M₁₂ and M₂₁ is zero [Tokuyoshi & Harada 2017, Eqs. 16–17]. `src/project/ellipsoid.rs` derives M without
// differences that cancel, and `src/project/slopes.rs` the planes through the eye that touch the ellipsoid.

/// A camera with a perspective, 80 bytes: the record `GpuCamera` of the crate.
struct SlcCamera {
    /// The rows of the view's rotation V.
    right: vec3f,
    /// δ, by how far V is from orthonormal.
    deviation: f32,
    up: vec3f,
    /// The secant of the angle to the corner of the view.
    secant: f32,
    forward: vec3f,
    /// By how far the image of the anchor is off, in the unit of length.
    rounding: f32,
    /// A point a of world space close to the eye. Lights are taken relative to it, so that nothing is lost far
    /// from the origin.
    anchor: vec3f,
    /// A depth is `depth_numerator`/(value of the depth buffer + `depth_offset`).
    depth_numerator: f32,
    /// The place of the anchor in camera space, almost zero.
    image: vec3f,
    depth_offset: f32,
}

/// An ellipsoid projected to camera space, 64 bytes: the record `GpuProjected` of the crate.
///
/// Enlarged for rounding. One that holds nothing has a `near` greater than its `far`. One that is too large has M = 0
/// and touches every tile.
struct SlcProjected {
    /// M₁₁, M₂₁, M₁₂, M₂₂
    x_and_y_axes: vec4f,
    /// M₁₃, M₂₃, m
    z_axis: vec3f,
    /// The least and the greatest depth.
    near: f32,
    /// Mc′, the centre of the unit sphere.
    center: vec3f,
    far: f32,
    /// The least and the greatest x/z, and the same of y/z.
    slopes: vec4f,
}

/// Budget for c′ and M c′, in units of the sum of the coordinates of c′.
const SLC_CENTER_ULPS: f32 = 24.0;
/// Budget for the box of a tile, in units of the secant of the view and the greatest depth.
const SLC_BOX_ULPS: f32 = 16.0;
/// Budget for axes, centre and the elements of M, in units of the longest semi-axis.
const SLC_AXES_ULPS: f32 = 320.0;
/// Budget for a view that is not orthonormal, in units of its deviation and the longest semi-axis.
const SLC_AXES_DEVIATIONS: f32 = 12.0;
/// Budget for the image of the anchor, in units of its rounding on the CPU.
const SLC_ANCHOR_ROUNDINGS: f32 = 3.0;
/// Budget for the enlarged shortest semi-axis and the comparison of the box test.
const SLC_ENLARGED_ULPS: f32 = 24.0;
/// Lower clamp of the enlarged shortest semi-axis.
const SLC_LEAST_SEMI_AXIS: f32 = 1.0e-15;
/// Longest semi-axis and farthest coordinate of an ellipsoid whose image is computed.
const SLC_LARGEST_LENGTH: f32 = 1.0e15;
/// Budget for both ends of a range of depths.
const SLC_DEPTH_ULPS: f32 = 12.0;
/// Budget for both ends of a range of slopes, in units of the magnitudes of their terms.
const SLC_SLOPE_ULPS: f32 = 40.0;
/// Farthest center, in units of its distance to the near end, for which slopes are bounded. Its square is finite.
const SLC_FARTHEST_CENTER: f32 = 1.0e12;
/// Least A for which slopes are bounded.
const SLC_LEAST_SQUARE: f32 = 1.0e-30;

/// An ellipsoid that touches no tile.
fn slc_nothing() -> SlcProjected {
    return SlcProjected(
        vec4f(0.0), vec3f(0.0), SLC_FAR, vec3f(0.0), -SLC_FAR, vec4f(SLC_FAR, -SLC_FAR, SLC_FAR, -SLC_FAR),
    );
}

/// An ellipsoid that touches every tile.
fn slc_everywhere() -> SlcProjected {
    return SlcProjected(
        vec4f(0.0), vec3f(0.0), -SLC_FAR, vec3f(0.0), SLC_FAR, vec4f(-SLC_FAR, SLC_FAR, -SLC_FAR, SLC_FAR),
    );
}

/// Projects a bound to camera space: `Ellipsoid::project` of the crate.
fn slc_project(bound: SlcBound, camera: SlcCamera) -> SlcProjected {
    let semi_axes = bound.semi_axes;
    let shortest = min(semi_axes.x, min(semi_axes.y, semi_axes.z));
    let longest = max(semi_axes.x, max(semi_axes.y, semi_axes.z));
    if longest <= 0.0 {
        return slc_nothing();
    }
    let view = transpose(mat3x3f(camera.right, camera.up, camera.forward));
    // Far from the origin, the sum of light and offset would lose what the light is away from the anchor.
    let away_from_anchor = slc_kept(bound.light - camera.anchor);
    let center = view * (away_from_anchor + bound.offset) + camera.image;
    let away = abs(center.x) + abs(center.y) + abs(center.z);
    if max(longest, away) > SLC_LARGEST_LENGTH {
        return slc_everywhere();
    }

    let stretch = slc_triangular_stretch(view * bound.axes, semi_axes);
    let farthest_depth = max(center.z, 0.0) + longest;
    let rounding = (away * SLC_CENTER_ULPS + farthest_depth * (SLC_BOX_ULPS * camera.secant)) * SLC_ULP
        + camera.rounding * SLC_ANCHOR_ROUNDINGS;
    let tilt = longest * (SLC_AXES_ULPS * SLC_ULP + SLC_AXES_DEVIATIONS * camera.deviation);
    let enlarged = slc_round_up(shortest + rounding + tilt, SLC_ENLARGED_ULPS);
    let factor = 1.0 / max(enlarged, SLC_LEAST_SEMI_AXIS);

    var projected = SlcProjected();
    projected.x_and_y_axes = stretch.x_and_y_axes * factor;
    projected.z_axis = stretch.z_axis * factor;
    projected.center = slc_map(projected.x_and_y_axes, projected.z_axis, center);
    let z = projected.center.z;
    let depths = vec2f(z - 1.0, z + 1.0) / projected.z_axis.z;
    projected.near = depths.x - abs(depths.x) * (SLC_DEPTH_ULPS * SLC_ULP);
    projected.far = depths.y + abs(depths.y) * (SLC_DEPTH_ULPS * SLC_ULP);
    projected.slopes = slc_slopes(projected);
    return projected;
}

/// M times a point.
fn slc_map(x_and_y_axes: vec4f, z_axis: vec3f, point: vec3f) -> vec3f {
    let xy = x_and_y_axes.xy * point.x + x_and_y_axes.zw * point.y + z_axis.xy * point.z;
    return vec3f(xy, z_axis.z * point.z);
}

/// M times the shortest semi-axis.
struct SlcStretch {
    x_and_y_axes: vec4f,
    z_axis: vec3f,
}

/// M for the columns `axes` in camera space, from A = MᵀM and its inverse C, of which each element is a sum of squares or
/// bounded by two that are.
fn slc_triangular_stretch(axes: mat3x3f, semi_axes: vec3f) -> SlcStretch {
    let shortest = min(semi_axes.x, min(semi_axes.y, semi_axes.z));
    let longest = max(semi_axes.x, max(semi_axes.y, semi_axes.z));
    let median = max(min(semi_axes.x, semi_axes.y), min(max(semi_axes.x, semi_axes.y), semi_axes.z));
    let rows = transpose(axes);
    let inverse = vec3f(shortest) / semi_axes;
    let direct = semi_axes / longest;
    let inverse_x = inverse * rows[0];
    let inverse_y = inverse * rows[1];
    let a_xx = dot(inverse_x, inverse_x);
    let a_yy = dot(inverse_y, inverse_y);
    let a_xy = dot(inverse_x, inverse_y);
    let direct_z = direct * rows[2];
    let c_zz = dot(direct_z, direct_z);
    let c_xz_and_yz = vec2f(dot(direct * rows[0], direct_z), dot(direct * rows[1], direct_z));

    let depth_reach = sqrt(c_zz);
    // √(A_xx A_yy − A_xy²)
    let root = depth_reach * (shortest / median);
    // The longer of the images of the x and y axes comes first.
    let is_x_first = a_xx > a_yy;
    let first = sqrt(max(a_xx, a_yy));
    let mixed = a_xy / first;
    let second = root / first;
    // M₁₁, M₂₁, M₁₂, M₂₂
    let x_and_y_axes = select(vec4f(second, mixed, 0.0, first), vec4f(first, 0.0, mixed, second), is_x_first);
    let shear = (x_and_y_axes.xy * c_xz_and_yz.x + x_and_y_axes.zw * c_xz_and_yz.y) / c_zz;
    return SlcStretch(x_and_y_axes, vec3f(-shear, shortest / (longest * depth_reach)));
}

/// The slopes x/z and y/z between the planes through the eye that touch the ellipsoid, rounded outward. All slopes
/// where it does not lie ahead of the camera's plane.
fn slc_slopes(projected: SlcProjected) -> vec4f {
    let all = vec4f(-SLC_FAR, SLC_FAR, -SLC_FAR, SLC_FAR);
    let c = projected.center;
    if c.z <= 1.0 || max(max(abs(c.x), abs(c.y)), c.z) > SLC_FARTHEST_CENTER {
        return all;
    }
    // A
    let square = (c.z - 1.0) * (c.z + 1.0);
    if square < SLC_LEAST_SQUARE {
        return all;
    }
    let xx = projected.x_and_y_axes.x;
    let yx = projected.x_and_y_axes.y;
    let xy = projected.x_and_y_axes.z;
    let yy = projected.x_and_y_axes.w;
    let xz = projected.z_axis.x;
    let yz = projected.z_axis.y;
    let m = projected.z_axis.z;
    // The first two rows of m M⁻¹ are (g_x, h_x, K_x) and (h_y, g_y, K_y).
    let per_xx = 1.0 / xx;
    let per_yy = 1.0 / yy;
    let g_x = m * per_xx;
    let g_y = m * per_yy;
    let h_x = -(g_y * (xy * per_xx));
    let h_y = -(g_x * (yx * per_yy));
    let axis_x = vec2f(xy * (yz * per_yy) * per_xx, -(xz * per_xx));
    let axis_y = vec2f(yx * (xz * per_xx) * per_yy, -(yz * per_yy));
    return vec4f(
        slc_slopes_between(axis_x, vec2f(g_x, h_x), c.xy, c.z, square),
        slc_slopes_between(axis_y, vec2f(g_y, h_y), c.yx, c.z, square),
    );
}

/// K + (w c_z ± √(w² + (g² + h²) A))/A, w = g c_x + h c_y, for the terms `axis` of K, `row` = (g, h) and
/// `square` = A.
fn slc_slopes_between(axis: vec2f, row: vec2f, center: vec2f, depth: f32, square: f32) -> vec2f {
    let terms = row * center;
    let w = terms.x + terms.y;
    let middle = w * depth;
    let root = sqrt(w * w + dot(row, row) * square);
    let magnitude = abs(axis.x) + abs(axis.y) + ((abs(terms.x) + abs(terms.y)) * depth + root) / square;
    let rounding = magnitude * (SLC_SLOPE_ULPS * SLC_ULP);
    let k = axis.x + axis.y;
    return vec2f(k + (middle - root) / square - rounding, k + (middle + root) / square + rounding);
}
