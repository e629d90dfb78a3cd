//! The exact test: a ball against the image of a tile.
//!
//! # Image of a tile
//!
//! M takes the points z(x, y, 1) of a tile to z(x a + y b + d), where a, b and d are the columns of M. The
//! image of the tile is a frustum. Its apex is the image of the eye, and its section at each depth z is a
//! parallelogram. Let c be the centre of the ball.
//!
//! The points of a tile with parallel rays go to x a + y b + z d: a frustum whose apex is infinitely far, with the same
//! parallelogram at each depth. Its coordinates were clipped to the bounds of the shape.
//!
//! # Nearest point of a section
//!
//! The projection of c to the plane at depth z has the coordinates u* and v* along a and b, both linear in z.
//! The parallelogram is given by an interval of u and one of v. Its point nearest to c is found by clamping
//! one coordinate, then the other for this value of the first, then the first again
//! [Ericson 2005, Sec. 5.1.9].
//!
//! # Nearest point of all sections
//!
//! The squared distance g(z) is convex and piecewise quadratic, with a piece for each side or corner of the
//! parallelogram that can be nearest. Let R be the vector from c to the nearest point z w. Half the slope of
//! g is s = R·w, or R·d with parallel rays, where w is d in what follows. Half the curvature is ‖w‖² less the part along the side on which the point can slide.
//! Newton's method is exact once a step stays within a piece: nine of ten lights are decided at the depth of
//! c, and almost all others one step later.
//!
//! # Decision
//!
//! The search only proposes R. A light is accepted if a point of the tile lies in the ball. It is rejected
//! if a plane normal to R separates the tile from the ball, that is, if R·x − R·c > ‖R‖ r for all x of the
//! frustum. The least R·x is s z at the near or the far depth, with
//! s = R·(x a + y b + d) − |R·a| Δx − |R·b| Δy, where x and y are the middles of the intervals and Δx and Δy
//! their half lengths. With parallel rays it is the least R·(x a + y b), plus the least R·d z. Any R is valid, so the rounding of the search does not count. The rounding of the
//! plane, in `f64`, is 10⁻⁷ of the budget for the box test in `f32`: see `docs/rounding.md`.
//!
//! The search is generic over [`Double`], so that a culler decides many lights at once: all by the first step,
//! and those that stay undecided by the whole search.

use core::marker::PhantomData;

use crate::num::Double;
use crate::view::{Projection, ViewBounds};

/// Budget for the root of a squared radius, in units of `f64::EPSILON`.
const RADIUS_ROUNDINGS: f64 = 4.0;

/// Upper limit of the steps of the search: more than bisection of an interval of `f64` needs. Nearly all
/// lights take one or two. A light that is undecided after the last is accepted.
const MAX_STEPS: u32 = 64;

/// A projected shape in the form that this test takes: the columns of M, whose third row is (0, 0, m), and
/// the ball.
#[derive(Clone, Copy, Debug)]
pub struct Image<N> {
    /// The first column; its third component is zero.
    pub a: [N; 2],
    /// The second column; its third component is zero.
    pub b: [N; 2],
    /// The third column.
    pub d: [N; 3],
    /// c, the centre of the ball.
    pub center: [N; 3],
    /// Not less than the root of `radius_squared`.
    pub radius: N,
    pub radius_squared: N,
}

impl<N: Double> Image<N> {
    /// A sphere in camera space: M is the identity.
    #[inline(always)]
    pub fn of_sphere(center: [N; 3], radius_squared: N) -> Self {
        let (zero, one) = (radius_squared.splat(0.0), radius_squared.splat(1.0));
        Self {
            a: [one, zero],
            b: [zero, one],
            d: [zero, zero, one],
            center,
            radius: radius_squared.sqrt() * (1.0 + RADIUS_ROUNDINGS * f64::EPSILON),
            radius_squared,
        }
    }
}

/// The image of a tile, a frustum, and the ball that it is tested against.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum<N, P> {
    light: Image<N>,
    /// The slopes x/z and y/z of the tile, or its coordinates x and y.
    slopes: [Interval<N>; 2],
    /// The depths that both the tile and the ball have.
    depths: Interval<N>,
    /// The depth of c.
    depth: N,
    projection: PhantomData<P>,
}

/// The result of one step of the search.
pub(crate) struct Verdict<N: Double> {
    /// Whether the step found neither a point of the tile in the ball nor a plane that separates them.
    pub is_undecided: N::Mask,
    /// Whether the step found a plane that separates them.
    pub is_separated: N::Mask,
}

impl<N: Double, P: Projection> Frustum<N, P> {
    /// The image of `tile` under the map of `light`, and the ball of `light`.
    #[inline(always)]
    pub fn new(light: Image<N>, tile: ViewBounds<N>) -> Self {
        let [near, far] = tile.depths;
        let per_m = near.splat(1.0) / light.d[2];
        let (depth, reach) = (light.center[2] * per_m, light.radius * per_m);
        Self {
            light,
            slopes: [Interval::new(tile.across), Interval::new(tile.down)],
            depths: Interval::new([(depth - reach).max(near), (depth + reach).min(far)]),
            depth,
            projection: PhantomData,
        }
    }

    /// Whether the tile and the ball have no depth in common.
    #[inline(always)]
    pub fn is_out_of_reach(&self) -> N::Mask {
        self.depths.min.gt(self.depths.max)
    }

    /// The first step of the search, at the depth of c clamped to the depths of the tile.
    #[cfg(feature = "cull")]
    #[inline(always)]
    pub fn first_verdict(&self) -> Verdict<N> {
        let nearest = Section::new(self).nearest(self, self.first_depth());
        self.separation(nearest.offset).verdict
    }

    #[inline(always)]
    fn first_depth(&self) -> N {
        self.depths.clamped(self.depth)
    }

    /// Tests the plane normal to R, and the point of the tile at c + R.
    #[inline(always)]
    fn separation(&self, [r0, r1, r2]: [N; 3]) -> Separation<N> {
        let Image { a, b, d, .. } = self.light;
        let ([x, y], [c0, c1, c2]) = (self.slopes, self.light.center);
        let mut middle = [
            a[0] * x.middle + b[0] * y.middle,
            a[1] * x.middle + b[1] * y.middle,
        ];
        if P::IS_PERSPECTIVE {
            middle = [middle[0] + d[0], middle[1] + d[1]];
        }
        let along_sides = [r0 * a[0] + r1 * a[1], r0 * b[0] + r1 * b[1]];
        let along_depth = r2 * d[2];
        let halves = along_sides[0].abs() * x.half + along_sides[1].abs() * y.half;
        let z = self.depths;
        let of_depths = |slope: N| slope * z.middle - slope.abs() * z.half;
        let (slope, least) = if P::IS_PERSPECTIVE {
            let slope = (r0 * middle[0] + r1 * middle[1] + along_depth) - halves;
            (slope, of_depths(slope))
        } else {
            let slope = r0 * d[0] + r1 * d[1] + along_depth;
            let of_section = (r0 * middle[0] + r1 * middle[1]) - halves;
            (slope, of_section + of_depths(slope))
        };
        // The signed distance along R from c to the tile, times ‖R‖.
        let distance = least - (r0 * c0 + r1 * c1 + r2 * c2);
        let squared = r0 * r0 + r1 * r1 + r2 * r2;
        let beyond = distance * distance.abs() - squared * self.light.radius_squared;
        let within = self.light.radius_squared - squared;
        let zero = squared.splat(0.0);
        Separation {
            slope,
            verdict: Verdict {
                // One comparison, since a branch on either would be mispredicted. NaN does not reject.
                is_undecided: zero.gt(within.max(beyond)),
                is_separated: beyond.gt(zero),
            },
        }
    }
}

/// The result of a test along R.
struct Separation<N: Double> {
    /// s, half the slope of g.
    slope: N,
    verdict: Verdict<N>,
}

impl<N: Double, P: Projection> Frustum<N, P> {
    /// Whether the ball touches the tile. True if a number is not finite.
    #[inline(always)]
    pub fn meets_ball(&self) -> N::Mask {
        let section = Section::new(self);
        let infinity = self.depth.splat(f64::INFINITY);
        let mut bracket = [-infinity, infinity];
        let mut z = self.first_depth();
        let mut is_undecided = !self.is_out_of_reach();
        let mut meets = is_undecided & !is_undecided;
        for _ in 0..MAX_STEPS {
            let nearest = section.nearest(self, z);
            let Separation { slope, verdict } = self.separation(nearest.offset);
            meets = meets | (is_undecided & !(verdict.is_undecided | verdict.is_separated));
            is_undecided = is_undecided & verdict.is_undecided;
            if !N::any(is_undecided) {
                return meets;
            }
            // The minimum is on the side to which g falls.
            let falls_to_eye = slope.is_positive();
            bracket = N::select_all(falls_to_eye, [bracket[0], z], [z, bracket[1]]);
            let next = z - slope / self.curvature(&nearest, z);
            z = self.next_depth(bracket, next);
        }
        meets | is_undecided
    }

    /// The next depth of the search: `next`, or the middle of `bracket` if `next` lies outside it.
    #[inline(always)]
    fn next_depth(&self, bracket: [N; 2], next: N) -> N {
        let next = self.depths.clamped(next);
        let is_inside = next.gt(bracket[0]) & bracket[1].gt(next);
        let middle = self.depths.clamped((bracket[0] + bracket[1]) * 0.5);
        N::select(is_inside, next, middle)
    }

    /// Half the second derivative of g at `z`, in the piece that `nearest` belongs to.
    #[inline(always)]
    fn curvature(&self, nearest: &Nearest<N>, z: N) -> N {
        let [r0, r1, _] = nearest.offset;
        let w = if P::IS_PERSPECTIVE {
            [
                (r0 + self.light.center[0]) / z,
                (r1 + self.light.center[1]) / z,
            ]
        } else {
            [self.light.d[0], self.light.d[1]]
        };
        // The square of the part of w across a side.
        let across = |[e0, e1]: [N; 2]| {
            let area = w[0] * e1 - w[1] * e0;
            area * area / (e0 * e0 + e1 * e1)
        };
        let [u_is_free, v_is_free] = [nearest.u, nearest.v].map(|[clamped, free]| clamped.eq(free));
        let of_side = N::select(u_is_free, across(self.light.a), across(self.light.b));
        let of_side_or_corner =
            N::select(u_is_free | v_is_free, of_side, w[0] * w[0] + w[1] * w[1]);
        let in_plane = N::select(u_is_free & v_is_free, z.zero(), of_side_or_corner);
        in_plane + self.light.d[2] * self.light.d[2]
    }
}

/// The coordinates u and v along a and b, which are the same for all sections.
struct Section<N> {
    /// The coefficients of u* = `foot[0][0]` − z `foot[0][1]`, and of v*.
    foot: [[N; 2]; 2],
    /// The growth of the nearest u where v falls.
    u_per_v: N,
    /// The growth of the nearest v where u falls.
    v_per_u: N,
}

impl<N: Double> Section<N> {
    #[inline(always)]
    fn new<P>(frustum: &Frustum<N, P>) -> Self {
        let Image {
            a, b, d, center, ..
        } = frustum.light;
        let ([d0, d1, _], [c0, c1, _]) = (d, center);
        let area = |e: [N; 2], f: [N; 2]| e[0] * f[1] - e[1] * f[0];
        let dot = |e: [N; 2], f: [N; 2]| e[0] * f[0] + e[1] * f[1];
        let per_area = d0.splat(1.0) / area(a, b);
        let (ab, aa, bb) = (dot(a, b), dot(a, a), dot(b, b));
        let (c, d) = ([c0, c1], [d0, d1]);
        Self {
            foot: [
                [area(c, b) * per_area, area(d, b) * per_area],
                [area(a, c) * per_area, area(a, d) * per_area],
            ],
            u_per_v: ab / aa,
            v_per_u: ab / bb,
        }
    }

    /// The point of the section at depth `z` that is nearest to c.
    #[inline(always)]
    fn nearest<P: Projection>(&self, frustum: &Frustum<N, P>, z: N) -> Nearest<N> {
        // No `array::map`, which is a call through memory if N is a vector.
        let at_depth = |[at_eye, per_depth]: [N; 2]| at_eye - per_depth * z;
        let (u_foot, v_foot) = (at_depth(self.foot[0]), at_depth(self.foot[1]));
        let [across, down] = frustum.slopes;
        let (us, vs) = if P::IS_PERSPECTIVE {
            (
                [across.min * z, across.max * z],
                [down.min * z, down.max * z],
            )
        } else {
            ([across.min, across.max], [down.min, down.max])
        };
        let u_free = u_foot + self.u_per_v * (v_foot - clamped(v_foot, vs));
        let u = clamped(u_free, us);
        let v_free = v_foot + self.v_per_u * (u_foot - u);
        let v = clamped(v_free, vs);
        let Image {
            a: [a0, a1],
            b: [b0, b1],
            d,
            center,
            ..
        } = frustum.light;
        let (du, dv) = (u - u_foot, v - v_foot);
        Nearest {
            offset: [du * a0 + dv * b0, du * a1 + dv * b1, d[2] * z - center[2]],
            u: [u, u_free],
            v: [v, v_free],
        }
    }
}

/// The point of a section that is nearest to c.
struct Nearest<N> {
    /// R, from c to the point.
    offset: [N; 3],
    /// u, and its value before the last clamp.
    u: [N; 2],
    /// v, and its value before the last clamp.
    v: [N; 2],
}

/// An interval, with its middle and half its length.
#[derive(Clone, Copy, Debug)]
struct Interval<N> {
    min: N,
    max: N,
    middle: N,
    half: N,
}

impl<N: Double> Interval<N> {
    #[inline(always)]
    fn new([min, max]: [N; 2]) -> Self {
        Self {
            min,
            max,
            middle: (min + max) * 0.5,
            half: (max - min) * 0.5,
        }
    }

    #[inline(always)]
    fn clamped(&self, x: N) -> N {
        clamped(x, [self.min, self.max])
    }
}

#[inline(always)]
fn clamped<N: Double>(x: N, [min, max]: [N; 2]) -> N {
    x.max(min).min(max)
}
