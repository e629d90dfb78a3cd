//! 3-vectors and 3×3 matrices over any [`Real`].

use core::ops::{Add, Div, Mul, Neg, Sub};

use glam::{Mat3, Vec3};

use super::real::{Double, Real, Single};

/// A 3-vector. Its operations and their order are those of glam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector3<N> {
    pub x: N,
    pub y: N,
    pub z: N,
}

impl<N: Real> Vector3<N> {
    #[inline(always)]
    pub fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }

    /// Puts `v` into as many lanes as `like` has.
    #[inline(always)]
    pub fn splat(like: N, v: Vector3<N::Element>) -> Self {
        Self::new(like.splat(v.x), like.splat(v.y), like.splat(v.z))
    }

    /// The zero vector in as many lanes as `like` has.
    #[inline(always)]
    pub fn zero(like: N) -> Self {
        let zero = like.zero();
        Self::new(zero, zero, zero)
    }

    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let [x, y, z] = N::select_all(mask, [yes.x, yes.y, yes.z], [no.x, no.y, no.z]);
        Self::new(x, y, z)
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// The componentwise product.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    #[inline(always)]
    pub fn length_squared(self) -> N {
        self.dot(self)
    }

    #[inline(always)]
    pub fn length(self) -> N {
        self.dot(self).sqrt()
    }

    #[inline(always)]
    pub fn element_sum(self) -> N {
        self.x + self.y + self.z
    }

    #[inline(always)]
    pub fn min_element(self) -> N {
        self.x.min(self.y.min(self.z))
    }

    #[inline(always)]
    pub fn max_element(self) -> N {
        self.x.max(self.y.max(self.z))
    }

    /// The component between the other two.
    #[inline(always)]
    pub fn median(self) -> N {
        let (least, most) = (self.x.min(self.y), self.x.max(self.y));
        most.min(least.max(self.z))
    }

    /// Whether all three components are zero, of either sign.
    #[inline(always)]
    pub fn is_zero(self) -> N::Mask {
        let zero = self.x.zero();
        self.x.eq(zero) & self.y.eq(zero) & self.z.eq(zero)
    }

    /// Whether all three components are finite.
    #[inline(always)]
    pub fn is_finite(self) -> N::Mask {
        self.x.is_finite() & self.y.is_finite() & self.z.is_finite()
    }
}

impl<D: Double> Vector3<D> {
    /// Σ factorᵢ·vectorᵢ
    #[inline(always)]
    pub fn combine<const K: usize>(terms: [(D, Self); K]) -> Self {
        let mut sum = Self::zero(terms[0].0);
        for (factor, vector) in terms {
            sum = sum + vector * factor;
        }
        sum
    }
}

impl<N: Single> Vector3<N> {
    /// The dot product, as [`Single::times_plus`] rounds it.
    #[inline(always)]
    pub fn near_dot(self, other: Self) -> N {
        let sum = self.y.times_plus(other.y, self.x * other.x);
        self.z.times_plus(other.z, sum)
    }

    #[inline(always)]
    pub fn widen(self) -> Vector3<N::Double> {
        Vector3::new(self.x.widen(), self.y.widen(), self.z.widen())
    }

    #[inline(always)]
    pub fn narrow(double: Vector3<N::Double>) -> Self {
        Self::new(
            N::narrow(double.x),
            N::narrow(double.y),
            N::narrow(double.z),
        )
    }

    /// Two unit vectors that are perpendicular to this unit vector and to each other, as
    /// [`Vec3::any_orthonormal_pair`] computes them.
    #[inline(always)]
    pub fn any_orthonormal_pair(self) -> (Self, Self) {
        let Self { x, y, z } = self;
        let one = z.splat(1.0);
        let sign = one.copysign(z);
        let a = -one / (sign + z);
        let b = x * y * a;
        (
            Self::new(sign * x * x * a + 1.0, sign * b, -sign * x),
            Self::new(b, sign + y * y * a, -y),
        )
    }
}

impl<N: Real> Add for Vector3<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<N: Real> Sub for Vector3<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<N: Real> Neg for Vector3<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<N: Real> Mul<N> for Vector3<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<N: Real> Div<N> for Vector3<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, divisor: N) -> Self {
        Self::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl From<Vec3> for Vector3<f32> {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<[f64; 3]> for Vector3<f64> {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl From<Vector3<f32>> for Vec3 {
    #[inline(always)]
    fn from(v: Vector3<f32>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

/// A 3×3 matrix, by its columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix3<N> {
    pub x: Vector3<N>,
    pub y: Vector3<N>,
    pub z: Vector3<N>,
}

impl<N: Real> Matrix3<N> {
    #[inline(always)]
    pub fn new(x: Vector3<N>, y: Vector3<N>, z: Vector3<N>) -> Self {
        Self { x, y, z }
    }

    /// Puts `m` into as many lanes as `like` has.
    #[inline(always)]
    pub fn splat(like: N, m: Matrix3<N::Element>) -> Self {
        Self::new(
            Vector3::splat(like, m.x),
            Vector3::splat(like, m.y),
            Vector3::splat(like, m.z),
        )
    }

    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            Vector3::select(mask, yes.x, no.x),
            Vector3::select(mask, yes.y, no.y),
            Vector3::select(mask, yes.z, no.z),
        )
    }

    #[inline(always)]
    pub fn transpose(self) -> Self {
        let Self { x, y, z } = self;
        Self::new(
            Vector3::new(x.x, y.x, z.x),
            Vector3::new(x.y, y.y, z.y),
            Vector3::new(x.z, y.z, z.z),
        )
    }
}

impl<N: Real> Mul<Vector3<N>> for Matrix3<N> {
    type Output = Vector3<N>;

    #[inline(always)]
    fn mul(self, v: Vector3<N>) -> Vector3<N> {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

impl<N: Real> Mul for Matrix3<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self * other.x, self * other.y, self * other.z)
    }
}

impl From<Mat3> for Matrix3<f32> {
    #[inline(always)]
    fn from(m: Mat3) -> Self {
        Self::new(m.x_axis.into(), m.y_axis.into(), m.z_axis.into())
    }
}

impl From<Matrix3<f32>> for Mat3 {
    #[inline(always)]
    fn from(m: Matrix3<f32>) -> Self {
        Self::from_cols(m.x.into(), m.y.into(), m.z.into())
    }
}

/// a·b in `f64`, in which the products are exact and the sums are rounded.
#[inline]
pub(crate) fn dot_f64(a: Vec3, b: Vec3) -> f64 {
    Vector3::from(a).widen().dot(Vector3::from(b).widen())
}

/// a·b, exact but for one rounding to `f64`, however much its terms cancel. The rounding errors of the sums
/// are added at the end.
#[inline(always)]
pub(crate) fn exact_dot<N: Single>(a: Vector3<N>, b: Vector3<N>) -> N::Double {
    let products = a.widen().times(b.widen());
    let (sum, first) = sum_with_error(products.x, products.y);
    let (sum, second) = sum_with_error(sum, products.z);
    sum + (first + second)
}

/// a + b in `f64`, and its rounding error [Knuth 1969, Sec. 4.2.2].
#[inline(always)]
fn sum_with_error<D: Double>(a: D, b: D) -> (D, D) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}
