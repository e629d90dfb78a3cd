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
//! Newton's step is exact as soon as it stays in its parabola: nine of ten lights are decided where c
//! itself is deep, and almost all others one step on.
//!
//! # What decides
//!
//! The search only proposes. A point of the tile in the ball accepts; what rejects is a plane at right
//! angles to R, if all of the tile lies farther from c than the radius on its other side. With the
//! middles and half lengths of the intervals, half a dozen products say how far: the least of R·x over
//! the frustum is s z at one of both depths, s = R·(x a + y b + d) − |R·a| Δx − |R·b| Δy with x and y
//! in the middle. Any R will do, so no rounding of the search counts, and that of the plane, in `f64`,
//! is 10⁻⁷ of what the box test's in `f32` has been paid for: see `ARCHITECTURE.md`.

#![allow(
    clippy::inline_always,
    reason = "so that a culler has it compiled for its own processor"
)]

use glam::Vec3;

use crate::math;

/// More than halving an interval of `f64` numbers takes. Nearly all lights take one step or two, and one
/// that is not decided at last is kept.
const MOST_STEPS: u32 = 64;

/// A ball, and a tile's image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum {
    center: [f64; 3],
    radius_squared: f64,
    /// a and b, which have no depth, and d.
    a: [f64; 2],
    b: [f64; 2],
    d: [f64; 3],
    slopes: [Interval; 2],
    /// Of the tile, as far as the ball reaches.
    depths: Interval,
    /// Of c.
    depth: f64,
}

impl Frustum {
    /// The image of the tile with these slopes across and down, and these depths, under the matrix with
    /// columns `axes`, whose third row is (0, 0, m); and the ball around `center`.
    #[inline(always)]
    pub fn new(
        axes: [Vec3; 3],
        [across, down, depths]: [[f32; 2]; 3],
        center: Vec3,
        [radius, radius_squared]: [f32; 2],
    ) -> Self {
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let ([[a0, a1, _], [b0, b1, _], d], center) = (axes.map(wide), wide(center));
        let per_m = 1.0 / d[2];
        let (depth, reach) = (center[2] * per_m, f64::from(radius) * per_m);
        let [near, far] = depths.map(f64::from);
        Self {
            center,
            radius_squared: radius_squared.into(),
            a: [a0, a1],
            b: [b0, b1],
            d,
            slopes: [across, down].map(|[min, max]| Interval::new(min.into(), max.into())),
            depths: Interval::new(greater(depth - reach, near), lesser(depth + reach, far)),
            depth,
        }
    }

    /// The tile itself, and a ball.
    #[inline(always)]
    pub fn around_sphere(center: Vec3, radius_squared: f32, sides: [[f32; 2]; 3]) -> Self {
        let radius = math::round_up(math::sqrt(radius_squared), 4);
        Self::new(Vec3::AXES, sides, center, [radius, radius_squared])
    }

    /// Whether the ball touches the tile; true of what is not finite.
    #[inline(always)]
    pub fn meets_ball(&self) -> bool {
        if self.depths.min > self.depths.max {
            return false;
        }
        let plane = Plane::new(self);
        let mut tried = [f64::NEG_INFINITY, f64::INFINITY];
        let mut z = self.depths.clamped(self.depth);
        for _ in 0..MOST_STEPS {
            let nearest = plane.nearest(self, z);
            let [squared, slope, apart] = self.seen_along(nearest.way);
            let beyond = apart * apart.abs() - squared * self.radius_squared;
            // Both in one: which of them it is could not be guessed. No NaN rejects.
            let (is_open, is_apart) = (
                greater(self.radius_squared - squared, beyond) < 0.0,
                beyond > 0.0,
            );
            if !is_open {
                return !is_apart;
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

    /// Of R: ‖R‖², s, and how far beyond c along it the tile begins, times ‖R‖.
    #[inline(always)]
    fn seen_along(&self, [r0, r1, r2]: [f64; 3]) -> [f64; 3] {
        let ([a0, a1], [b0, b1], [d0, d1, m]) = (self.a, self.b, self.d);
        let ([x, y], [c0, c1, c2]) = (self.slopes, self.center);
        let middle = [
            a0 * x.middle + b0 * y.middle + d0,
            a1 * x.middle + b1 * y.middle + d1,
        ];
        let along_sides = [r0 * a0 + r1 * a1, r0 * b0 + r1 * b1];
        let s = (r0 * middle[0] + r1 * middle[1] + r2 * m)
            - (along_sides[0].abs() * x.half + along_sides[1].abs() * y.half);
        let z = self.depths;
        let begins = s * z.middle - s.abs() * z.half;
        let squared = r0 * r0 + r1 * r1 + r2 * r2;
        [squared, s, begins - (r0 * c0 + r1 * c1 + r2 * c2)]
    }

    /// Half the second derivative of g at `z`, on the side of a parabola's end that `nearest` is on.
    #[inline(always)]
    fn curvature(&self, nearest: &Nearest, z: f64) -> f64 {
        let [r0, r1, _] = nearest.way;
        let w = [(r0 + self.center[0]) / z, (r1 + self.center[1]) / z];
        let beside = |[e0, e1]: [f64; 2]| {
            let area = w[0] * e1 - w[1] * e0;
            area * area / (e0 * e0 + e1 * e1)
        };
        let in_plane = match nearest.slides {
            [true, true] => 0.0,
            [true, false] => beside(self.a),
            [false, true] => beside(self.b),
            [false, false] => w[0] * w[0] + w[1] * w[1],
        };
        in_plane + self.d[2] * self.d[2]
    }
}

/// Coordinates u and v along a and b.
struct Plane {
    /// u* = `foot[0][0]` − z `foot[0][1]`, and v*.
    foot: [[f64; 2]; 2],
    /// By how much the nearest u grows as v falls, and v as u falls.
    u_per_v: f64,
    v_per_u: f64,
}

impl Plane {
    #[inline(always)]
    fn new(frustum: &Frustum) -> Self {
        let (a, b) = (frustum.a, frustum.b);
        let ([d0, d1, _], [c0, c1, _]) = (frustum.d, frustum.center);
        let area = |e: [f64; 2], f: [f64; 2]| e[0] * f[1] - e[1] * f[0];
        let dot = |e: [f64; 2], f: [f64; 2]| e[0] * f[0] + e[1] * f[1];
        let per_area = 1.0 / area(a, b);
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
    fn nearest(&self, frustum: &Frustum, z: f64) -> Nearest {
        let [u_foot, v_foot] = self.foot.map(|[at_eye, per_depth]| at_eye - per_depth * z);
        let [us, vs] = frustum
            .slopes
            .map(|slopes| [slopes.min * z, slopes.max * z]);
        let u_free = u_foot + self.u_per_v * (v_foot - clamped(v_foot, vs));
        let u = clamped(u_free, us);
        let v_free = v_foot + self.v_per_u * (u_foot - u);
        let v = clamped(v_free, vs);
        let ([a0, a1], [b0, b1]) = (frustum.a, frustum.b);
        let (u_apart, v_apart) = (u - u_foot, v - v_foot);
        Nearest {
            way: [
                u_apart * a0 + v_apart * b0,
                u_apart * a1 + v_apart * b1,
                frustum.d[2] * z - frustum.center[2],
            ],
            slides: [u == u_free, v == v_free],
        }
    }
}

/// The point of a section that is nearest to c.
struct Nearest {
    /// R, from c.
    way: [f64; 3],
    /// Whether it is at no end of u, and of v.
    slides: [bool; 2],
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    min: f64,
    max: f64,
    middle: f64,
    half: f64,
}

impl Interval {
    #[inline(always)]
    fn new(min: f64, max: f64) -> Self {
        Self {
            min,
            max,
            middle: 0.5 * (min + max),
            half: 0.5 * (max - min),
        }
    }

    #[inline(always)]
    fn clamped(&self, x: f64) -> f64 {
        clamped(x, [self.min, self.max])
    }
}

#[inline(always)]
fn clamped(x: f64, [min, max]: [f64; 2]) -> f64 {
    lesser(greater(x, min), max)
}

/// The greater of both, `otherwise` where x is NaN: one instruction, unlike `f64::max`.
#[inline(always)]
fn greater(x: f64, otherwise: f64) -> f64 {
    if x > otherwise { x } else { otherwise }
}

/// The lesser of both, `otherwise` where x is NaN.
#[inline(always)]
fn lesser(x: f64, otherwise: f64) -> f64 {
    if x < otherwise { x } else { otherwise }
}
