// Lobe and bound of a spot light: `SpotLobe` of the crate. Needs `num.wgsl`, `lobe.wgsl` and `bound.wgsl`.
//
// A light's record has the axis as its normal and 1 − cos of the half angles of the inner and the outer cone as its
// `fresnel`: `SpotLobe::versines`. `src/bound/spot.rs` derives the three ellipsoids.

/// 1/(4π) · clamp((cosγ − cosγ_o)/(cosγ_i − cosγ_o), 0, 1)². 1 − cosγ is ½‖ω_o − u‖², which loses no digits near the axis.
fn slc_spot(axis: vec3f, versines: vec2f, outgoing: vec3f) -> f32 {
    let apart = outgoing - axis;
    let share = (versines.y - 0.5 * dot(apart, apart)) / max(versines.y - versines.x, 1.0e-30);
    let transition = clamp(share, 0.0, 1.0);
    return transition * transition * SLC_CONSTANT;
}

/// The least 1 − cosγ_o: narrower lobes are bounded as this one.
const SLC_LEAST_OUTER: f32 = 4.7683716e-7;
/// Where the tangent touches that bounds l/(1 + l).
const SLC_TOUCHED: f32 = 0.3;
/// The narrowest transition for which the ball is computed. Its ball is larger than what it is compared with.
const SLC_LEAST_TRANSITION: f32 = 1.0e-6;

/// An ellipsoid of revolution, in units of the range on the axis: the distance of its centre from the light, its
/// semi-axis along the axis, and those across it.
struct SlcRevolved {
    center: f32,
    along: f32,
    across: f32,
}

/// The ellipsoid around a spot light's lobe, the smallest or nearly. Empty if the outer cone is.
fn slc_tight_spot(axis: vec3f, versines: vec2f) -> SlcBound {
    if versines.y <= 0.0 {
        return slc_empty_bound();
    }
    let inner = versines.x;
    let outer = max(versines.y, SLC_LEAST_OUTER);
    var bound = SlcRevolved();
    if outer <= 1.0 && inner <= 1.0 / 3.0 {
        bound = slc_spot_from_light(inner, outer);
    } else {
        bound = slc_spot_from_tip(inner, outer);
        let ball = slc_spot_ball(inner, outer);
        if outer > 1.0 && ball.along * (ball.across * ball.across) < bound.along * (bound.across * bound.across) {
            bound = ball;
        }
    }
    return slc_revolved(axis, bound.center, bound.along, bound.across, 0.2820948);
}

/// The ellipsoid with the light as a pole, for `inner` ≤ 1/3 and `outer` ≤ 1.
fn slc_spot_from_light(inner: f32, outer: f32) -> SlcRevolved {
    // The best ring as a share of `outer`.
    let best = outer * ((outer * 6.337904e-3 - 7.309715e-2) * outer + 2.5015324e-1);
    let ring = max(best, inner);
    let cosine = 1.0 - ring;
    let cosine_squared = cosine * cosine;
    let sine_squared = ring * (2.0 - ring);
    // 1/k of a stationary ring, and of the smallest ellipsoid around a cone.
    let numerator = 2.0 * outer - ring * (2.0 * outer + 4.0 - ring * (outer + 5.0) + 2.0 * (ring * ring));
    var inverse = numerator / (cosine_squared * (outer - 2.0 * ring + 1.0));
    var length = 1.0;
    if inner > best {
        inverse = max(inverse, 2.0 * sine_squared / cosine_squared);
    } else {
        length = (outer - ring) / (outer - inner);
    }
    let twice_along = length * (cosine + sine_squared / (cosine * inverse));
    let along = max(twice_along, 1.0) * 0.5;
    return SlcRevolved(along, along, along * sqrt(inverse));
}

/// The ellipsoid with the tip as a pole, through the rim.
fn slc_spot_from_tip(inner: f32, outer: f32) -> SlcRevolved {
    let cosine = max(1.0 - inner, 0.0);
    let wide = max(outer - 1.0, 0.0);
    let d = cosine + wide;
    // The tangent of c₁ + wl/(1 + l), and the larger root of the derivative of (1 + wl − dl²) times it.
    let slope = wide * (1.0 / ((1.0 + SLC_TOUCHED) * (1.0 + SLC_TOUCHED)));
    let start = slope * (SLC_TOUCHED * SLC_TOUCHED) + cosine;
    let constant = wide * start + slope;
    let half_linear = wide * slope - d * start;
    let root = sqrt(half_linear * half_linear + d * slope * constant * 3.0);
    let length = constant / max(root - half_linear, 1.0e-30);
    let product = (1.0 + length * (wide - d * length)) * (length * slope + start);
    let along = clamp(max(1.0 - (1.0 + cosine) * 0.5 / (1.0 + product), 0.75 * inner), 0.5, 1.0);
    let inverse = max(2.0 - inner, 1.0e-30) / max(2.0 * along - inner, 1.0e-30);
    return SlcRevolved(1.0 - along, along, along * sqrt(inverse));
}

/// The ball around the lobe, for `outer` > 1.
fn slc_spot_ball(inner: f32, outer: f32) -> SlcRevolved {
    let wide = max(outer - 1.0, 0.0);
    let rest = sqrt(wide * wide + 8.0) - wide;
    let center = (1.0 + wide * rest * 0.25) * 0.5 / max(outer - inner, SLC_LEAST_TRANSITION);
    let radius = center * sqrt(1.0 + 4.0 * wide / rest);
    return SlcRevolved(center, radius, radius);
}
