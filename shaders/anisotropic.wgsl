// Lobe: an anisotropic GGX lobe, without a Fresnel factor. Needs `num.wgsl` and `lobe.wgsl`.
//
// Its bound is made on the CPU, once for a static light: `GpuBound` of `AnisotropicGgxLobe::unit_bound`.

/// D G2/(4μ) with height-correlated masking, for α along the `tangent` and across it, `roughness` = (α_x, α_y):
/// `AnisotropicGgxLobe` of the crate. The tangent need not be at right angles to the normal. `slc_schlick` and its like give F.
fn slc_anisotropic_ggx(light: SlcLight, tangent: vec3f, roughness: vec2f, outgoing: vec3f) -> f32 {
    let outgoing_cosine = dot(light.normal, outgoing);
    if outgoing_cosine <= 0.0 || light.cosine <= 0.0 {
        return 0.0;
    }
    let bitangent = normalize(cross(light.normal, tangent));
    let to_surface = transpose(mat3x3f(cross(bitangent, light.normal), bitangent, light.normal));
    let incoming = to_surface * light.incoming;
    let seen = to_surface * outgoing;
    // √(α_x² x² + α_y² y² + z²) of both directions.
    let incident_root = length(vec3f(roughness * incoming.xy, light.cosine));
    let outgoing_root = length(vec3f(roughness * seen.xy, outgoing_cosine));
    let sum = outgoing_cosine * incident_root + light.cosine * outgoing_root;
    let masking = outgoing_cosine * 0.5 / max(sum, 1.0e-36);

    let half_vector = to_surface * (light.incoming + outgoing);
    if half_vector.z <= 0.0 {
        return 0.0;
    }
    let scaled = vec3f(half_vector.xy / roughness, half_vector.z);
    let spread = max(dot(scaled, scaled) / max(dot(half_vector, half_vector), 1.0e-36), 1.0);
    return SLC_FRAC_1_PI / (roughness.x * roughness.y) / spread / spread * masking;
}
