// Bound: ellipsoids around the surface up to which a light is accepted. Needs `num.wgsl` and `lobe.wgsl`.
//
// Bounds are those of a light at the origin with the scale 1; `slc_placed` gives them the place of a light and
// its scale √(Φ/(δξ)). For each, all points within reach of the light are inside, whatever the rounding.

/// An ellipsoid {light + offset + axes·(semi_axes·y) : ‖y‖ ≤ 1}. Empty if its semi-axes are zero.
struct SlcBound {
    light: vec3f,
    /// From the light to the centre. Kept apart, so that nothing is lost far from the origin.
    offset: vec3f,
    /// Unit vectors.
    axes: mat3x3f,
    semi_axes: vec3f,
}

/// Pays for the rounding of axes and centre, in units of the longest over the shortest semi-axis.
const SLC_TILT_ULPS: f32 = 64.0;
/// Pays for the rounding of the semi-axes of an ellipsoid of revolution, and of a sphere's radius.
const SLC_SEMI_AXIS_ULPS: f32 = 128.0;
/// Pays for the rounding of the cosine of the largest half angle.
const SLC_SMALLEST_COSINE_ULPS: f32 = 64.0;
/// Pays for the rounding of a value of F.
const SLC_REFLECTANCE_ULPS: f32 = 256.0;
/// Lower clamp of Fresnel maxima.
const SLC_LEAST_REFLECTED: f32 = 1.0e-30;
/// Below this sine of incidence the plane of incidence is any plane through the normal.
const SLC_LEAST_SINE: f32 = 9.536743e-7;

/// The bound of a light that reaches nothing.
fn slc_empty_bound() -> SlcBound {
    let axes = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    return SlcBound(vec3f(0.0), vec3f(0.0), axes, vec3f(0.0));
}

/// The bound of a light at `position` with this `scale`. Empty if the scale is zero.
fn slc_placed(unit: SlcBound, position: vec3f, scale: f32) -> SlcBound {
    return SlcBound(position, unit.offset * scale, unit.axes, unit.semi_axes * scale);
}

/// A sphere around the point `offset` from the light.
fn slc_sphere(offset: vec3f, radius: f32) -> SlcBound {
    var bound = slc_empty_bound();
    bound.offset = offset;
    bound.semi_axes = vec3f(slc_round_up(radius, SLC_SEMI_AXIS_ULPS));
    return bound;
}

/// The sphere of radius √(1/(4π)) around a light with the constant lobe.
fn slc_paper_constant() -> SlcBound {
    return slc_sphere(vec3f(0.0), 0.28209479);
}

/// An ellipsoid of revolution, for a lobe that extends by `reach` along its `axis`: the distance of its centre from the
/// light, its semi-axis along the axis and those across it are in units of that.
fn slc_revolved(axis: vec3f, center: f32, along: f32, across: f32, reach: f32) -> SlcBound {
    let side = slc_any_orthogonal(axis);
    let ratio = max(along, across) / min(along, across);
    let grown = slc_round_up(reach * (1.0 + ratio * (SLC_TILT_ULPS * SLC_ULP)), SLC_SEMI_AXIS_ULPS);
    return SlcBound(
        vec3f(0.0),
        axis * (center * reach),
        mat3x3f(axis, cross(side, axis), side),
        vec3f(along, across, across) * grown,
    );
}

/// The smallest sphere around Lambert's lobe. Its centre is (1/3)^¾ R above the light, and its radius is
/// (4/27)^¼ R, with R² = ρ/π [Tokuyoshi & Harada 2017, Sec. 6].
fn slc_paper_lambert(albedo: f32, normal: vec3f) -> SlcBound {
    let reach = sqrt(albedo) * 0.5641896;
    return slc_sphere(normal * (reach * 0.43869134), reach * 0.6204032);
}

/// The plane of incidence of a light.
struct SlcPlaneOfIncidence {
    /// ω_u
    mirror: vec3f,
    /// ω_w, perpendicular to the plane
    across: vec3f,
    /// √(1 − μ²)
    sine: f32,
}

/// ω_u = 2μn − ω_i
fn slc_mirror_direction(light: SlcLight) -> vec3f {
    return light.normal * (2.0 * light.cosine) - light.incoming;
}

fn slc_plane_of_incidence(light: SlcLight) -> SlcPlaneOfIncidence {
    let mirror = slc_mirror_direction(light);
    let product = cross(light.normal, light.incoming);
    let sine = length(product);
    if sine < SLC_LEAST_SINE {
        return SlcPlaneOfIncidence(mirror, slc_any_orthogonal(mirror), sine);
    }
    // Near normal incidence the product is mostly rounding. What is along ω_u would tilt the axes.
    let across = normalize(product - mirror * dot(mirror, product));
    return SlcPlaneOfIncidence(mirror, across, sine);
}

/// A unit vector that is perpendicular to this unit vector [Duff et al. 2017].
fn slc_any_orthogonal(v: vec3f) -> vec3f {
    let sign = select(-1.0, 1.0, v.z >= 0.0);
    let a = -1.0 / (sign + v.z);
    return vec3f(v.x * v.y * a, sign + v.y * v.y * a, -v.y);
}

/// The cosine of the largest half angle above the surface, rounded down.
fn slc_smallest_half_angle_cosine(light: SlcLight) -> f32 {
    let sine = length(cross(light.normal, light.incoming));
    return slc_round_down(light.cosine / sqrt(2.0 * (1.0 + sine)), SLC_SMALLEST_COSINE_ULPS);
}

/// An upper bound of F over all half angles above the surface, from F at the largest one and at normal incidence, of which
/// either is the largest [Tokuyoshi & Harada 2017, supplemental Eq. 6].
fn slc_max_fresnel(grazing: f32, steepest: f32) -> f32 {
    let most = slc_round_up(max(grazing, steepest), SLC_REFLECTANCE_ULPS);
    return clamp(most, SLC_LEAST_REFLECTED, 1.0);
}

/// F_max of a light with Schlick's Fresnel factor.
fn slc_max_schlick(light: SlcLight) -> f32 {
    let f0 = light.fresnel.x;
    return slc_max_fresnel(slc_schlick(f0, slc_smallest_half_angle_cosine(light)), f0);
}

/// F_max of a light with the Fresnel factor of a dielectric.
fn slc_max_dielectric(light: SlcLight) -> f32 {
    let index = light.fresnel.x;
    let grazing = slc_dielectric(index, slc_smallest_half_angle_cosine(light));
    return slc_max_fresnel(grazing, slc_dielectric(index, 1.0));
}

/// F_max of a light with the Fresnel factor of a conductor.
fn slc_max_conductor(light: SlcLight) -> f32 {
    let index = light.fresnel;
    let grazing = slc_conductor(index, slc_smallest_half_angle_cosine(light));
    return slc_max_fresnel(grazing, slc_conductor(index, 1.0));
}

/// The spheroid with r² = F_max G1(μ)/(4πμ) around a GGX lobe, for `max_fresnel` = F_max
/// [Tokuyoshi & Harada 2017, Eqs. 9–12]. Empty if the surface is lit from behind.
fn slc_paper_ggx(light: SlcLight, max_fresnel: f32) -> SlcBound {
    if light.cosine <= 0.0 {
        return slc_empty_bound();
    }
    let radius = sqrt(max_fresnel * slc_masking_over_four_cosines(light) * SLC_FRAC_1_PI);
    let alpha = light.roughness;
    // Semi-axis and distance of the centre, in units of r.
    let long = (1.0 + alpha * alpha) / (2.0 * alpha);
    let distance = (1.0 - alpha) * (1.0 + alpha) / (2.0 * alpha);
    return slc_revolved(slc_mirror_direction(light), distance, long, 1.0, radius);
}
