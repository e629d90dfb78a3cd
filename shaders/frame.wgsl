// Frame: what all kernels of a frame share. Needs `num.wgsl`, `lobe.wgsl`, `light.wgsl`, `bound.wgsl`, `project.wgsl`
// and `view.wgsl`.

/// What all kernels of a frame share, 128 bytes: the record `GpuFrame` of the crate.
struct SlcFrame {
    camera: SlcCamera,
    image_size: vec2u,
    /// Columns and rows of tiles in the largest subregion, which all subregions have.
    tiles: vec2u,
    /// w of the interleaving.
    interleave: u32,
    /// The number of lights.
    lights: u32,
    /// The number of depth intervals of a tile.
    intervals: u32,
    /// For how many indices the buffer of lists has room.
    room: u32,
    /// δ
    delta: f32,
    least_distance_squared: f32,
    seed: u32,
    frame: u32,
}

/// Pays for depths that were computed in another kernel, or on a CPU, and for the rounding of points, in units of depths
/// along the corner of the view and of the eye's coordinates.
const SLC_DEPTH_INTERVAL_ULPS: f32 = 24.0;

/// ξ of a light in this frame, by its rank among the lights of its subregion.
fn slc_xi_of_light(frame: SlcFrame, light: u32) -> f32 {
    let place = slc_split_light(frame.interleave, light);
    return slc_xi_of_rank(slc_frame(slc_subregion_seed(frame.seed, place.x), frame.frame), place.y);
}

/// The depth of a point of world space.
fn slc_depth_of_point(camera: SlcCamera, point: vec3f) -> f32 {
    return dot(camera.forward, point - camera.anchor) + camera.image.z;
}

/// The depth of a value of the depth buffer: `Camera::depth`. Zero, for sky, where it is not a positive number: at an
/// infinite far plane. At a finite one it is the depth of that plane.
fn slc_depth_of_value(camera: SlcCamera, value: f32) -> f32 {
    let divisor = value + camera.depth_offset;
    // The quotient would be too large.
    if abs(divisor) <= abs(camera.depth_numerator) * 1.0e-30 {
        return 0.0;
    }
    return max(camera.depth_numerator / divisor, 0.0);
}

/// By how much the depth of the point that is shaded may differ from `depth`.
fn slc_depth_margin(camera: SlcCamera, depth: f32) -> f32 {
    let eye = abs(camera.anchor);
    let scale = depth * (camera.secant * SLC_ULP) + (eye.x + eye.y + eye.z) * SLC_ULP;
    return scale * SLC_DEPTH_INTERVAL_ULPS;
}

/// The way from a light to a point.
struct SlcWay {
    /// ω_o, of unit length; zero where the two coincide.
    direction: vec3f,
    /// l², at least `least_distance_squared` of the frame.
    distance_squared: f32,
}

/// The way from a light to a point, from 10⁻¹⁵ to 10¹⁵ apart: `Vpl::direction_to`.
fn slc_way(frame: SlcFrame, light: SlcLight, point: vec3f) -> SlcWay {
    let way = point - light.position;
    let squared = dot(way, way);
    return SlcWay(way * inverseSqrt(max(squared, 1.0e-30)), max(squared, frame.least_distance_squared));
}
