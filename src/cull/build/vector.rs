//! Vectors of three numbers in each lane, with glam's and `math`'s operations in their order: a lane has
//! the bits that the scalar functions give.

use core::ops::{Add, Mul, Sub};

use fearless_simd::{Simd, SimdBase, SimdFloat};
use glam::{Mat3, Vec3};

use crate::cull::wide_lanes::Wide;
use crate::math;
use crate::tile::Number;

/// A [`Vec3`] in each lane.
#[derive(Clone, Copy)]
pub(super) struct Vectors<S: Simd> {
    pub x: S::f32s,
    pub y: S::f32s,
    pub z: S::f32s,
}

impl<S: Simd> Vectors<S> {
    #[inline(always)]
    pub fn new(x: S::f32s, y: S::f32s, z: S::f32s) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn from_array([x, y, z]: [S::f32s; 3]) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn to_array(self) -> [S::f32s; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> S::f32s {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn element_sum(self) -> S::f32s {
        self.x + self.y + self.z
    }

    #[inline(always)]
    pub fn min_element(self) -> S::f32s {
        self.x.min(self.y.min(self.z))
    }

    #[inline(always)]
    pub fn max_element(self) -> S::f32s {
        self.x.max(self.y.max(self.z))
    }

    #[inline(always)]
    pub fn median(self) -> S::f32s {
        let (least, most) = (self.x.min(self.y), self.x.max(self.y));
        most.min(least.max(self.z))
    }

    /// Whether all three are.
    #[inline(always)]
    pub fn is_finite(self) -> S::mask32s {
        self.x.is_finite() & self.y.is_finite() & self.z.is_finite()
    }

    #[inline(always)]
    pub fn widened(self) -> [Wide<S>; 3] {
        [Wide::new(self.x), Wide::new(self.y), Wide::new(self.z)]
    }
}

impl<S: Simd> Add for Vectors<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<S: Simd> Add<Vec3> for Vectors<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Vec3) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<S: Simd> Sub for Vectors<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<S: Simd> Sub<Vec3> for Vectors<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Vec3) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<S: Simd> Mul<S::f32s> for Vectors<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: S::f32s) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

/// `matrix` times a vector in each lane.
#[inline(always)]
pub(super) fn product<S: Simd>(matrix: Mat3, v: Vectors<S>) -> Vectors<S> {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    Vectors::new(
        v.x * x.x + v.y * y.x + v.z * z.x,
        v.x * x.y + v.y * y.y + v.z * z.y,
        v.x * x.z + v.y * y.z + v.z * z.z,
    )
}

/// [`math::dot`].
#[inline(always)]
pub(super) fn dot<S: Simd>(a: [Wide<S>; 3], b: [Wide<S>; 3]) -> Wide<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// [`math::dot`] with the same vector in each lane.
#[inline(always)]
pub(super) fn dot_with<S: Simd>(a: [f64; 3], b: [Wide<S>; 3]) -> Wide<S> {
    b[0] * a[0] + b[1] * a[1] + b[2] * a[2]
}

/// [`math::cross`].
#[inline(always)]
pub(super) fn cross<S: Simd>(a: [Wide<S>; 3], b: [Wide<S>; 3]) -> [Wide<S>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// [`math::length`].
#[inline(always)]
pub(super) fn length<S: Simd>(v: [Wide<S>; 3]) -> Wide<S> {
    dot(v, v).sqrt()
}

/// [`math::round_up`].
#[inline(always)]
pub(super) fn round_up<S: Simd>(x: S::f32s, roundings: u16) -> S::f32s {
    x * math::round_up(1.0, roundings)
}

/// [`math::fifth_power`].
#[inline(always)]
pub(super) fn fifth_power<S: Simd>(x: S::f32s) -> S::f32s {
    let squared = x * x;
    squared * squared * x
}
