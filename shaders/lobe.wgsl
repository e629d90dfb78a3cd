// Lobe: what a light reflects into a direction. Needs `num.wgsl`.
//
// A value is f·max(μ_o, 0) in sr⁻¹ towards `outgoing`, a unit vector: `Lobe::value` of the crate. A light's
// radiant intensity is its flux times that.

/// A light, 64 bytes: the record `GpuLight` of the crate.
struct SlcLight {
    position: vec3f,
    /// Φ in W.
    flux: f32,
    /// n
    normal: vec3f,
    /// μ = ω_i·n in [0, 1], rounded once. Zero if the surface is lit from behind. A dot product of the two vectors would
    /// lose its digits at grazing incidence.
    cosine: f32,
    /// ω_i
    incoming: vec3f,
    /// α
    roughness: f32,
    /// The parameters of the Fresnel factor: F0, or η, or η and κ. The first is ρ of Lambert's lobe.
    fresnel: vec2f,
    /// The base and the rise of a Fresnel factor above it, base + rise (1 − cosθ_h)⁵: `Fresnel::majorant`.
    majorant: vec2f,
}

/// The constant lobe, 1/(4π).
const SLC_CONSTANT: f32 = 0.07957747;

/// Lambert's lobe, ρ/π max(ω_o·n, 0).
fn slc_lambert(albedo: f32, normal: vec3f, outgoing: vec3f) -> f32 {
    return albedo * SLC_FRAC_1_PI * max(dot(normal, outgoing), 0.0);
}

/// The root √(kμ² + α²), k = 1 − α², of Smith's masking function.
fn slc_masking_root(roughness: f32, cosine: f32) -> f32 {
    return sqrt((1.0 - roughness) * (1.0 + roughness) * cosine * cosine + roughness * roughness);
}

/// G1(μ)/(4μ) of a light, which is finite at grazing incidence.
fn slc_masking_over_four_cosines(light: SlcLight) -> f32 {
    return 0.5 / (light.cosine + slc_masking_root(light.roughness, light.cosine));
}

/// D towards the half vector along `half_vector`, which may have any length [Trowbridge & Reitz 1975].
///
/// The sine comes from a cross product, since 1 − cos² would cancel about the peak.
fn slc_ndf(roughness: f32, half_vector: vec3f, normal: vec3f) -> f32 {
    let cosine = dot(half_vector, normal);
    if cosine <= 0.0 {
        return 0.0;
    }
    let across = cross(half_vector, normal);
    let squared = roughness * roughness;
    let length_squared = max(dot(half_vector, half_vector), 1.0e-36);
    let spread = (squared * (cosine * cosine) + dot(across, across)) / length_squared;
    let share = squared / max(spread, squared);
    return share * share * (SLC_FRAC_1_PI / squared);
}

/// A GGX lobe without a Fresnel factor, with height-correlated masking [Heitz 2014, Eq. 99]: D G2/(4μ).
fn slc_ggx(light: SlcLight, outgoing: vec3f) -> f32 {
    let outgoing_cosine = dot(light.normal, outgoing);
    if outgoing_cosine <= 0.0 || light.cosine <= 0.0 {
        return 0.0;
    }
    let incident_root = slc_masking_root(light.roughness, light.cosine);
    let outgoing_root = slc_masking_root(light.roughness, outgoing_cosine);
    let sum = outgoing_cosine * incident_root + light.cosine * outgoing_root;
    // Both terms can underflow.
    let masking = outgoing_cosine * 0.5 / max(sum, 1.0e-36);
    return slc_ndf(light.roughness, light.incoming + outgoing, light.normal) * masking;
}

/// A GGX lobe with Schlick's Fresnel factor: `GgxLobe<Schlick>` of the crate.
fn slc_ggx_schlick(light: SlcLight, outgoing: vec3f) -> f32 {
    return slc_schlick(light.fresnel.x, slc_half_angle_cosine(light, outgoing)) * slc_ggx(light, outgoing);
}

/// cosθ_h = ω_i·ω_h = ½‖ω_i + ω_o‖
fn slc_half_angle_cosine(light: SlcLight, outgoing: vec3f) -> f32 {
    return min(0.5 * length(light.incoming + outgoing), 1.0);
}

/// F0 + (1 − F0)(1 − cosθ_h)⁵ [Schlick 1994, Eq. 15].
fn slc_schlick(f0: f32, half_angle_cosine: f32) -> f32 {
    return f0 + (1.0 - f0) * slc_fifth_power(1.0 - half_angle_cosine);
}

/// A GGX lobe with the Fresnel factor of a dielectric: `GgxLobe<Dielectric>` of the crate.
fn slc_ggx_dielectric(light: SlcLight, outgoing: vec3f) -> f32 {
    return slc_dielectric(light.fresnel.x, slc_half_angle_cosine(light, outgoing)) * slc_ggx(light, outgoing);
}

/// A GGX lobe with the Fresnel factor of a conductor: `GgxLobe<Conductor>` of the crate.
fn slc_ggx_conductor(light: SlcLight, outgoing: vec3f) -> f32 {
    return slc_conductor(light.fresnel, slc_half_angle_cosine(light, outgoing)) * slc_ggx(light, outgoing);
}

/// F of a dielectric with the relative refractive index η = `index`, for unpolarised light.
///
/// With w = √(η² − s²), where c and s are cosine and sine of the half angle, the amplitudes are (1 − η²)/(c + w)²,
/// and that times (cw − s²)/(cw + s²): nothing cancels but where it does not count.
fn slc_dielectric(index: f32, half_angle_cosine: f32) -> f32 {
    let c = half_angle_cosine;
    let w_squared = slc_index_squared_less_sine_squared(index, c);
    if w_squared <= 0.0 {
        return 1.0;
    }
    let w = sqrt(w_squared);
    let s_squared = (1.0 - c) * (1.0 + c);
    let amplitude = ((1.0 - index) / (c + w)) * ((1.0 + index) / (c + w));
    let polarisation = (c * w - s_squared) / (c * w + s_squared);
    return min(0.5 * amplitude * amplitude * (1.0 + polarisation * polarisation), 1.0);
}

/// F of a conductor with the refractive index η and the extinction coefficient κ, `index` = (η, κ), for unpolarised
/// light.
///
/// As that of a dielectric, with w = a + ib = √((η + iκ)² − s²).
fn slc_conductor(index: vec2f, half_angle_cosine: f32) -> f32 {
    let eta = index.x;
    let kappa = index.y;
    let c = half_angle_cosine;
    let s_squared = (1.0 - c) * (1.0 + c);
    // w² = real + 2i ab. The larger of a and b is a root, the other follows, so that neither cancels.
    let real = slc_index_squared_less_sine_squared(eta, c) - kappa * kappa;
    let product = eta * kappa;
    let modulus = sqrt(real * real + 4.0 * (product * product));
    // Not less than the root of the product, whose square may vanish.
    let larger = max(sqrt(0.5 * (modulus + abs(real))), sqrt(product));
    let smaller = product / max(larger, 1.0e-30);
    let a = select(smaller, larger, real > 0.0);
    let b = select(larger, smaller, real > 0.0);

    let sum = (a + c) * (a + c) + b * b;
    let less = (1.0 - eta) * (1.0 - eta) + kappa * kappa;
    let more = (1.0 + eta) * (1.0 + eta) + kappa * kappa;
    let perpendicular = (less / sum) * (more / sum);
    let minus = c * a - s_squared;
    let plus = c * a + s_squared;
    let cb = c * b;
    let polarisation = (minus * minus + cb * cb) / (plus * plus + cb * cb);
    return min(0.5 * perpendicular * (1.0 + polarisation), 1.0);
}

/// η² − s². Its error is a few roundings of the smaller of s² and c², which matters at the critical angle.
fn slc_index_squared_less_sine_squared(index: f32, c: f32) -> f32 {
    if c * c > 0.5 {
        return index * index - (1.0 - c) * (1.0 + c);
    }
    return c * c + (index - 1.0) * (index + 1.0);
}
