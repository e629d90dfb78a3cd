// Outward rounding, by what WGSL allows an operation to be off.
//
// Its table names no direction of rounding: a sum, a difference or a product may be off by a whole unit in the
// last place, a quotient by 2.5, an inverse square root by 2, and a square root by 4.5. Operations may be
// reordered and contracted, and subnormal numbers flushed. Infinities and NaN need not exist, so no function
// here makes or takes any. `docs/rounding.md` counts each budget, in these units.

/// 2⁻²³, a unit in the last place of 1.
const SLC_ULP: f32 = 1.1920929e-7;

/// What no bound of a slope or a depth reaches: stands for infinity.
const SLC_FAR: f32 = 3.0e38;

/// 1/π
const SLC_FRAC_1_PI: f32 = 0.31830987;

/// Enlarges x ≥ 0 by more than `ulps` units in the last place. Two more pay for this product.
fn slc_round_up(x: f32, ulps: f32) -> f32 {
    return x * (1.0 + (ulps + 2.0) * SLC_ULP);
}

/// Reduces x ≥ 0 by more than `ulps` units in the last place.
fn slc_round_down(x: f32, ulps: f32) -> f32 {
    return x * (1.0 - (ulps + 2.0) * SLC_ULP);
}

/// `v` itself, whose components are less than SLC_FAR. A compiler that reorders sums takes none apart that is clamped.
fn slc_kept(v: vec3f) -> vec3f {
    return clamp(v, vec3f(-SLC_FAR), vec3f(SLC_FAR));
}

/// x⁵
fn slc_fifth_power(x: f32) -> f32 {
    let squared = x * x;
    return squared * squared * x;
}
