// Lobe and bound of a spherical Gaussian: `SphericalGaussian` of the crate. Needs `num.wgsl`, `lobe.wgsl` and
// `bound.wgsl`.
//
// A light's record has the axis as its normal, and sharpness λ and amplitude c as its `fresnel`.

/// c e^{λ(cosγ − 1)}. 1 − cosγ is ½‖ω_o − ξ‖², which loses no digits near the axis.
fn slc_gaussian(axis: vec3f, sharpness: f32, amplitude: f32, outgoing: vec3f) -> f32 {
    let apart = outgoing - axis;
    return amplitude * slc_exponential(-0.5 * sharpness * dot(apart, apart));
}

/// eˣ for x ≤ 0, to a few units in the last place: `exp` may be off by 3 + 2|x| of them. Zero below −87, where eˣ is
/// subnormal.
fn slc_exponential(x: f32) -> f32 {
    if x < -87.0 {
        return 0.0;
    }
    // n ln 2 in two parts. The difference from the first, which has few bits, is exact, and is clamped to stay one.
    let n = floor(x * 1.442695 + 0.5);
    let rest = clamp(x - n * 0.693359375, -1.0, 1.0) + n * 2.1219444e-4;
    return exp(rest) * bitcast<f32>(u32(127 + i32(n)) << 23u);
}

/// Pays for the rounding of the polynomials, and leaves room for the proof that they enclose.
const SLC_FIT_ULPS: f32 = 2048.0;

/// Nearly the smallest ellipsoid around a spherical Gaussian: its front, its rear and its squared semi-axis across are
/// polynomials in w = 1/(1 + λ/2), which `src/bound/spherical_gaussian.rs` explains. Empty if the amplitude is zero.
fn slc_tight_gaussian(axis: vec3f, sharpness: f32, amplitude: f32) -> SlcBound {
    if amplitude <= 0.0 {
        return slc_empty_bound();
    }
    let w = 1.0 / (1.0 + 0.5 * sharpness);
    let u = 0.5 * sharpness * w;
    let front = 1.0 + u * (((0.3028 * w - 0.1291) * w - 0.1709) * w + 0.084);
    let rear_fit = (((-5.4278 * w + 23.6406) * w - 35.9794) * w + 20.754) * w - 0.9873;
    let rear = w * w * w * w * (1.0 + u * rear_fit);
    let across_fit = ((((0.6901 * w - 1.9974) * w + 2.1405) * w - 0.5452) * w + 0.3361) * w + 0.3834;
    let across = sqrt(w * across_fit);
    return slc_revolved(
        axis,
        0.5 * (front - rear),
        slc_round_up(0.5 * (front + rear), SLC_FIT_ULPS),
        slc_round_up(across, SLC_FIT_ULPS),
        sqrt(amplitude),
    );
}
