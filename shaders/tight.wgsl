// Bound: the tight ellipsoid around a GGX lobe, from the table of the crate. Needs `num.wgsl`, `lobe.wgsl` and
// `bound.wgsl`, and a buffer `slc_table` that the caller declares, filled with `wgsl::TABLE`:
//
//     @group(0) @binding(0) var<storage, read> slc_table: array<vec4f>;
//
// `src/bound/tight.rs` derives the coordinates, and says how the table is proved to enclose.

/// The knots of √α, of tan(θ/2) + tan(δ/2) and of ∜F0, where tan δ = α tan θ.
const SLC_KNOTS: vec3u = vec3u(9u, 21u, 7u);
/// What the table begins at.
const SLC_FIRST: vec3f = vec3f(0.0, 0.0, 0.25);
/// Knots per unit of a coordinate.
const SLC_PER_UNIT: vec3f = vec3f(8.0, 10.0, 8.0);
/// The least base over rise of a majorant that the table covers: 1/256 over 1 − 1/256.
const SLC_LEAST_SHARE: f32 = 0.003921569;

/// Pays for the rounding of the least base that the table covers.
const SLC_LEAST_BASE_ULPS: f32 = 4.0;
/// Pays for the rounding of base + rise (1 − μ)⁵.
const SLC_REFLECTED_ULPS: f32 = 256.0;
/// Pays for the rounding of the coordinates, of the interpolation and of the semi-axes.
const SLC_TIGHT_SEMI_AXIS_ULPS: f32 = 4096.0;
/// Keeps the cube of a quotient of maxima of F finite. The spheroid is smaller long before.
const SLC_LARGEST_QUOTIENT: f32 = 1.0e6;

/// An ellipsoid about the plane of incidence, in units of r.
struct SlcSection {
    /// The bound of F that r² = `reflected`·G1(μ)/(4πμ) has.
    reflected: f32,
    /// Along (ω_u, −ω_v).
    center: vec2f,
    /// The semi-axes in the plane, and the one across it.
    long: f32,
    short: f32,
    across: f32,
    /// Cosine and sine of the angle of the longer axis from ω_u.
    turn: vec2f,
}

/// Nearly the smallest ellipsoid around a GGX lobe above its surface: the table's, or the spheroid of the paper where that is
/// smaller. `max_fresnel` is F_max. Empty if the surface is lit from behind.
fn slc_tight_ggx(light: SlcLight, max_fresnel: f32) -> SlcBound {
    if light.cosine <= 0.0 {
        return slc_empty_bound();
    }
    let plane = slc_plane_of_incidence(light);
    let section = slc_smaller_section(light, plane.sine, max_fresnel);
    let radius = sqrt(section.reflected * slc_masking_over_four_cosines(light) * SLC_FRAC_1_PI);
    let u = plane.mirror;
    // −ω_v, towards the surface, to which the lobe tilts.
    let down = cross(u, plane.across);
    let shortest = min(section.short, section.across);
    let longest = max(section.long, section.across);
    let growth = 1.0 + longest / shortest * (SLC_TILT_ULPS * SLC_ULP);
    let semi_axes = vec3f(section.long, section.short, section.across)
        * (radius * slc_round_up(growth, SLC_TIGHT_SEMI_AXIS_ULPS));
    return SlcBound(
        vec3f(0.0),
        (u * section.center.x + down * section.center.y) * radius,
        mat3x3f(
            u * section.turn.x + down * section.turn.y,
            down * section.turn.x - u * section.turn.y,
            -plane.across,
        ),
        semi_axes,
    );
}

/// The smaller of the ellipsoid of the table and the paper's spheroid.
fn slc_smaller_section(light: SlcLight, sine: f32, max_fresnel: f32) -> SlcSection {
    let alpha = light.roughness;
    let rise = light.majorant.y;
    // A majorant with an F0 below the range of the table is raised to it.
    let base = max(light.majorant.x, slc_round_up(rise * SLC_LEAST_SHARE, SLC_LEAST_BASE_ULPS));
    let root = slc_masking_root(alpha, light.cosine);
    let half_incidence = sine / (1.0 + light.cosine);
    let half_delta = alpha * sine / (light.cosine + root);
    let knot = slc_interpolated(
        vec3f(sqrt(alpha), half_incidence + half_delta, sqrt(sqrt(base / (base + rise)))),
    );
    let grazing = slc_fifth_power(max(1.0 - light.cosine, 0.0));
    let reflected = slc_round_up(base + rise * grazing, SLC_REFLECTED_ULPS);

    let across = knot.across * root;
    let volume = knot.along * knot.aside * across;
    let long = (1.0 + alpha * alpha) * 0.5;
    let quotient = min(reflected / max_fresnel, SLC_LARGEST_QUOTIENT);
    if volume * volume * (quotient * quotient * quotient) > long * long {
        let center = vec2f((1.0 - alpha) * (1.0 + alpha) * 0.5 / alpha, 0.0);
        return SlcSection(max_fresnel, center, long / alpha, 1.0, 1.0, vec2f(1.0, 0.0));
    }
    let center = vec2f(knot.center.x / alpha, knot.center.y);
    return slc_section_of(reflected, center, knot.along / alpha, knot.slant, knot.aside, across);
}

/// The section with the conjugate semi-diameters (`along`, `slant`) and (0, `aside`).
///
/// The semi-axes are the singular values of the triangular matrix M with these columns. Let D be the difference on the
/// diagonal of M Mᵀ, m its element off the diagonal, and h = √(D² + 4m²) the difference of its eigenvalues. The
/// longer semi-axis lies along (D + h, 2m) and (2m, h − D); the one that does not cancel is used. The shorter one is
/// the determinant of M over the longer, which does not cancel.
fn slc_section_of(
    reflected: f32,
    center: vec2f,
    along: f32,
    slant: f32,
    aside: f32,
    across: f32,
) -> SlcSection {
    let first = along * along;
    let mixed = along * slant;
    let second = slant * slant + aside * aside;
    let difference = first - second;
    // For a circle the axes are arbitrary.
    let apart = max(abs(difference), 1.0e-15);
    let h = sqrt(apart * apart + 4.0 * (mixed * mixed));
    let long = sqrt((first + second + h) * 0.5);
    let larger = (apart + h) * 0.5;
    let turn = vec2f(larger, mixed) * inverseSqrt(larger * h);
    return SlcSection(
        reflected,
        center,
        long,
        along * aside / long,
        across,
        select(turn.yx, turn, difference >= 0.0),
    );
}

/// The numbers of a knot of the table: the centre, and the triangular matrix of the ellipsoid.
struct SlcKnot {
    center: vec2f,
    along: f32,
    slant: f32,
    aside: f32,
    across: f32,
}

/// The table, interpolated linearly at √α, tan(θ/2) + tan(δ/2) and ∜F0.
fn slc_interpolated(coordinates: vec3f) -> SlcKnot {
    let last = vec3f(SLC_KNOTS) - vec3f(2.0);
    let place = (coordinates - SLC_FIRST) * SLC_PER_UNIT;
    let whole = clamp(floor(place), vec3f(0.0), last);
    let share = place - whole;
    let knot = vec3u(whole);
    let first = (knot.x * SLC_KNOTS.y + knot.y) * SLC_KNOTS.z + knot.z;
    let next = first + SLC_KNOTS.y * SLC_KNOTS.z;
    let a = slc_between(slc_along_reflectance(first, share.z), slc_along_reflectance(first + SLC_KNOTS.z, share.z), share.y);
    let b = slc_between(slc_along_reflectance(next, share.z), slc_along_reflectance(next + SLC_KNOTS.z, share.z), share.y);
    let knots = slc_between(a, b, share.x);
    return SlcKnot(knots[0].xy, knots[0].z, knots[0].w, knots[1].x, knots[1].y);
}

/// Between a knot and the next along ∜F0.
fn slc_along_reflectance(knot: u32, share: f32) -> array<vec4f, 2> {
    let first = array<vec4f, 2>(slc_table[2u * knot], slc_table[2u * knot + 1u]);
    let second = array<vec4f, 2>(slc_table[2u * knot + 2u], slc_table[2u * knot + 3u]);
    return slc_between(first, second, share);
}

/// `a` at a `share` of 0, `b` at 1.
fn slc_between(a: array<vec4f, 2>, b: array<vec4f, 2>, share: f32) -> array<vec4f, 2> {
    return array<vec4f, 2>(a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share);
}
