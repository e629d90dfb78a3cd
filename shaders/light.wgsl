// Light: the random number ξ of a light in a frame, and Russian roulette. Needs `num.wgsl`.

/// A frame of a sequence of random numbers: `FrameSeed` of the crate.
struct SlcFrameSeed {
    /// Hashed frame and seed, both odd.
    frame_key: vec2u,
    /// The hashed seed, both odd.
    key: vec2u,
    /// Hashed from the seed alone.
    offset: u32,
    frame: u32,
}

/// The random numbers of the frame with this index: `Seed(seed).frame(frame)`.
fn slc_frame(seed: u32, frame: u32) -> SlcFrameSeed {
    return SlcFrameSeed(
        slc_hashed(vec3u(frame, seed, 0x9E3779B9u)) | vec2u(1u),
        slc_hashed(vec3u(seed, 0x7F4A7C15u, 0xBF58476Du)) | vec2u(1u),
        slc_hashed(vec3u(seed, 0x1CE4E5B9u, 0x94D049BBu)).x,
        frame,
    );
}

/// A seed for a subregion of interleaved sampling: `Seed(seed).subregion(subregion)`.
fn slc_subregion_seed(seed: u32, subregion: u32) -> u32 {
    return slc_hashed(vec3u(subregion, seed, 0xD1B54A33u)).x;
}

/// ξ of a light, hashed from light and seed, and moved by the golden ratio from frame to frame:
/// `FrameSeed::xi`.
fn slc_xi(seed: SlcFrameSeed, light: u32) -> f32 {
    let bits = slc_stirred(vec3u(light, seed.key)).x;
    return slc_xi_of_bits(bits + seed.frame * 0x9E3779B9u);
}

/// ξ of the light with this rank, spread evenly over neighbouring ranks: `FrameSeed::xi_of_rank`.
fn slc_xi_of_rank(seed: SlcFrameSeed, rank: u32) -> f32 {
    return slc_xi_of_bits(reverseBits(rank) + seed.offset + seed.frame * 0x6945004Fu);
}

/// ξ of a light, hashed from light, frame and seed: `FrameSeed::hashed_xi`.
fn slc_hashed_xi(seed: SlcFrameSeed, light: u32) -> f32 {
    return slc_xi_of_bits(slc_stirred(vec3u(slc_congruential(vec3u(light)).x, seed.frame_key)).x);
}

/// (`bits` + 1)·2⁻³² in (0, 1], rounded to nearest, ties to even.
///
/// A conversion of the 32 bits may round either way, so the number is assembled from its bits.
fn slc_xi_of_bits(bits: u32) -> f32 {
    let number = bits + 1u;
    if number == 0u {
        return 1.0;
    }
    let zeros = countLeadingZeros(number);
    let normalized = number << zeros;
    let kept = normalized >> 8u;
    let dropped = normalized & 0xFFu;
    let is_up = dropped > 0x80u || (dropped == 0x80u && (kept & 1u) == 1u);
    // `kept` brings the leading bit, which adds one to the exponent, and so does a carry out of it.
    return bitcast<f32>(((125u - zeros) << 23u) + kept + select(0u, 1u, is_up));
}

/// pcg3d [Jarzynski & Olano 2020]: the first two of three hashed words.
fn slc_hashed(words: vec3u) -> vec2u {
    return slc_stirred(slc_congruential(words));
}

/// The linear congruential generator, the first step of pcg3d.
fn slc_congruential(words: vec3u) -> vec3u {
    return words * 1664525u + vec3u(1013904223u);
}

/// The steps of pcg3d after `slc_congruential`; returns the first two of the three hashed words.
fn slc_stirred(words: vec3u) -> vec2u {
    var v = words;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    return v.xy;
}

/// Pays for √(Φ/(δξ)): three roots, a product and a quotient.
const SLC_SCALE_ULPS: f32 = 24.0;

/// The scale √(Φ/(δξ)) of a light's unit bound, rounded up: `Roulette::scale`. Zero for Φ = 0, and else from
/// 10⁻¹⁸ to 10³⁰.
fn slc_scale(flux: f32, delta: f32, xi: f32) -> f32 {
    if flux <= 0.0 {
        return 0.0;
    }
    let radius = sqrt(flux) / (sqrt(xi) * sqrt(delta));
    return clamp(slc_round_up(radius, SLC_SCALE_ULPS), 1.0e-18, 1.0e30);
}

/// Whether a light of this intensity is accepted: p = min(I/(δl²), 1) ≥ ξ. `Roulette::accepts`.
fn slc_accepts(intensity: f32, distance_squared: f32, delta: f32, xi: f32) -> bool {
    return intensity > 0.0 && xi * (distance_squared * delta) <= intensity;
}

/// The estimate of the radiance: L/p = max(L, δ) of an accepted light, 0 of any other. `Roulette::estimate`
/// [Tokuyoshi & Harada 2017, Eq. 3]. A distance of zero must not be asked for.
fn slc_estimate(intensity: f32, distance_squared: f32, delta: f32, xi: f32) -> f32 {
    if !slc_accepts(intensity, distance_squared, delta, xi) {
        return 0.0;
    }
    return max(intensity / distance_squared, delta);
}
