//! The exact test: a ball against the image of a tile.
//!
//! M takes the points z(x, y, 1) of a tile to z(x a + y b + d), a, b and d its columns: a frustum whose
//! apex is the eye and whose sections at each depth z are parallelograms. Let c be the centre of the
//! ball.
//!
//! # Nearest in a section
//!
//! The foot of c on the plane at depth z has the coordinates u* and v* along a and b, both linear in z.
//! The nearest point of the parallelogram is that of two intervals of u and v, which is where one
//! coordinate is clamped, then the other given the first, then the first again
//! [Ericson 2005, Sec. 5.1.9].
//!
//! # Nearest of all sections
//!
//! The squared distance g(z) is convex and consists of parabolas, one for each side or corner of the
//! parallelogram that may be nearest. With R the way from c to the nearest point z w, half the slope is
//! s = R·w, and half the curvature is ‖w‖² less the part along the side that the point may slide on.
//! Newton's step is exact as soon as it stays in its parabola: nine of ten lights are decided at the
//! depth of c, and almost all others one step on.
//!
//! # What decides
//!
//! The search only proposes. A point of the tile in the ball accepts; what rejects is a plane at right
//! angles to R, if all of the tile lies farther from c than the radius on its other side. With the
//! middles and half lengths of the intervals, half a dozen products say how far: the least of R·x over
//! the frustum is s z at one of both depths, s = R·(x a + y b + d) − |R·a| Δx − |R·b| Δy with x and y
//! in the middle. Any R will do, so no rounding of the search counts, and that of the plane, in `f64`,
//! is 10⁻⁷ of what the box test's in `f32` has been paid for: see `docs/rounding.md`.
//!
//! So far it is one function over a [`Double`], with which a culler takes the first look at many lights at
//! once. Where that leaves a light open, the search goes on for it alone.

use super::box_test::TileBounds;
use crate::num::Double;

/// More than halving an interval of `f64` numbers takes. Nearly all lights take one step or two, and one
/// that is not decided at last is kept.
const MOST_STEPS: u32 = 64;

/// A light as this test takes it: the columns of M, whose third row is (0, 0, m), and the ball.
#[derive(Clone, Copy, Debug)]
pub struct Image<N> {
    /// a and b, which have no depth, and d.
    pub a: [N; 2],
    pub b: [N; 2],
    pub d: [N; 3],
    pub center: [N; 3],
    /// Not less than the root of the next.
    pub radius: N,
    pub radius_squared: N,
}

impl<N: Double> Image<N> {
    /// A ball with nothing stretched.
    #[inline(always)]
    pub fn of_sphere(center: [N; 3], radius_squared: N) -> Self {
        let (zero, one) = (radius_squared.splat(0.0), radius_squared.splat(1.0));
        Self {
            a: [one, zero],
            b: [zero, one],
            d: [zero, zero, one],
            center,
            radius: radius_squared.sqrt() * (1.0 + 4.0 * f64::EPSILON),
            radius_squared,
        }
    }
}

/// A ball, and a tile's image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum<N> {
    light: Image<N>,
    slopes: [Interval<N>; 2],
    /// Of the tile, as far as the ball reaches.
    depths: Interval<N>,
    /// The depth of c.
    depth: N,
}

/// What is known once a point of the tile was looked at.
pub(crate) struct Verdict<N: Double> {
    /// Whether neither a point in the ball nor a plane between both has been found.
    pub is_open: N::Mask,
    /// Whether a plane has.
    pub is_apart: N::Mask,
}

impl<N: Double> Frustum<N> {
    /// The image of `tile` beside that of `light`.
    #[inline(always)]
    pub fn new(light: Image<N>, tile: TileBounds<N>) -> Self {
        let [near, far] = tile.depths;
        let per_m = near.splat(1.0) / light.d[2];
        let (depth, reach) = (light.center[2] * per_m, light.radius * per_m);
        Self {
            light,
            slopes: [Interval::new(tile.across), Interval::new(tile.down)],
            depths: Interval::new([(depth - reach).max(near), (depth + reach).min(far)]),
            depth,
        }
    }

    /// Whether the ball reaches no depth of the tile.
    #[inline(always)]
    pub fn is_out_of_reach(&self) -> N::Mask {
        self.depths.min.gt(self.depths.max)
    }

    /// What the nearest point at the depth of c tells, or at the nearest that the tile has.
    #[cfg(feature = "cull")]
    #[inline(always)]
    pub fn first_verdict(&self) -> Verdict<N> {
        let nearest = Section::new(self).nearest(self, self.first_depth());
        self.seen_along(nearest.way).verdict
    }

    #[inline(always)]
    fn first_depth(&self) -> N {
        self.depths.clamped(self.depth)
    }

    /// What a plane at right angles to R tells, and the point that R leads to.
    #[inline(always)]
    fn seen_along(&self, [r0, r1, r2]: [N; 3]) -> Seen<N> {
        let Image { a, b, d, .. } = self.light;
        let ([x, y], [c0, c1, c2]) = (self.slopes, self.light.center);
        let middle = [
            a[0] * x.middle + b[0] * y.middle + d[0],
            a[1] * x.middle + b[1] * y.middle + d[1],
        ];
        let along_sides = [r0 * a[0] + r1 * a[1], r0 * b[0] + r1 * b[1]];
        let slope = (r0 * middle[0] + r1 * middle[1] + r2 * d[2])
            - (along_sides[0].abs() * x.half + along_sides[1].abs() * y.half);
        let z = self.depths;
        // How far beyond c the tile begins, times ‖R‖.
        let begins = slope * z.middle - slope.abs() * z.half;
        let apart = begins - (r0 * c0 + r1 * c1 + r2 * c2);
        let squared = r0 * r0 + r1 * r1 + r2 * r2;
        let beyond = apart * apart.abs() - squared * self.light.radius_squared;
        let within = self.light.radius_squared - squared;
        let zero = squared.splat(0.0);
        Seen {
            slope,
            verdict: Verdict {
                // Both in one: which of them it is could not be guessed. No NaN rejects.
                is_open: zero.gt(within.max(beyond)),
                is_apart: beyond.gt(zero),
            },
        }
    }
}

/// What a way R from c tells of the tile.
struct Seen<N: Double> {
    /// s
    slope: N,
    verdict: Verdict<N>,
}

impl Frustum<f64> {
    /// Whether the ball touches the tile; true of what is not finite.
    #[inline(always)]
    pub fn meets_ball(&self) -> bool {
        if self.is_out_of_reach() {
            return false;
        }
        let section = Section::new(self);
        let mut tried = [f64::NEG_INFINITY, f64::INFINITY];
        let mut z = self.first_depth();
        for _ in 0..MOST_STEPS {
            let nearest = section.nearest(self, z);
            let Seen { slope, verdict } = self.seen_along(nearest.way);
            if !verdict.is_open {
                return !verdict.is_apart;
            }
            // The least is on the side to which g falls.
            if slope > 0.0 {
                tried[1] = z;
            } else {
                tried[0] = z;
            }
            let next = z - slope / self.curvature(&nearest, z);
            z = self.between(tried, next);
        }
        true
    }

    /// The depth to try after those at both ends of `tried`, between which the least lies: `next`, or
    /// the middle if that leads out.
    #[inline(always)]
    fn between(&self, tried: [f64; 2], next: f64) -> f64 {
        let next = self.depths.clamped(next);
        if tried[0] < next && next < tried[1] {
            next
        } else {
            self.depths.clamped(0.5 * (tried[0] + tried[1]))
        }
    }

    /// Half the second derivative of g at `z`, on the side of a parabola's end that `nearest` is on.
    #[inline(always)]
    fn curvature(&self, nearest: &Nearest<f64>, z: f64) -> f64 {
        let [r0, r1, _] = nearest.way;
        let w = [
            (r0 + self.light.center[0]) / z,
            (r1 + self.light.center[1]) / z,
        ];
        let beside = |[e0, e1]: [f64; 2]| {
            let area = w[0] * e1 - w[1] * e0;
            area * area / (e0 * e0 + e1 * e1)
        };
        let slides = [nearest.u, nearest.v].map(|[nearest, free]| nearest == free);
        let in_plane = match slides {
            [true, true] => 0.0,
            [true, false] => beside(self.light.a),
            [false, true] => beside(self.light.b),
            [false, false] => w[0] * w[0] + w[1] * w[1],
        };
        in_plane + self.light.d[2] * self.light.d[2]
    }
}

/// Coordinates u and v along a and b in the sections, all of which are parallel.
struct Section<N> {
    /// u* = `foot[0][0]` − z `foot[0][1]`, and v*.
    foot: [[N; 2]; 2],
    /// By how much the nearest u grows as v falls, and v as u falls.
    u_per_v: N,
    v_per_u: N,
}

impl<N: Double> Section<N> {
    #[inline(always)]
    fn new(frustum: &Frustum<N>) -> Self {
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
    fn nearest(&self, frustum: &Frustum<N>, z: N) -> Nearest<N> {
        // No array is mapped: where N is a vector, that is a call, through memory.
        let at_depth = |[at_eye, per_depth]: [N; 2]| at_eye - per_depth * z;
        let (u_foot, v_foot) = (at_depth(self.foot[0]), at_depth(self.foot[1]));
        let [across, down] = frustum.slopes;
        let (us, vs) = (
            [across.min * z, across.max * z],
            [down.min * z, down.max * z],
        );
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
        let (u_apart, v_apart) = (u - u_foot, v - v_foot);
        Nearest {
            way: [
                u_apart * a0 + v_apart * b0,
                u_apart * a1 + v_apart * b1,
                d[2] * z - center[2],
            ],
            u: [u, u_free],
            v: [v, v_free],
        }
    }
}

/// The point of a section that is nearest to c.
struct Nearest<N> {
    /// R, from c.
    way: [N; 3],
    /// u and v, and where they would be if their intervals had no ends.
    u: [N; 2],
    v: [N; 2],
}

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
