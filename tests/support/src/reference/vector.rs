//! Three numbers.

use std::ops::{Add, Mul, Neg, Sub};

use stochastic_light_culling::glam::Vec3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector(pub [f64; 3]);

impl Vector {
    pub const ZERO: Self = Self([0.0; 3]);

    pub fn dot(self, other: Self) -> f64 {
        (0..3).map(|i| self.0[i] * other.0[i]).sum()
    }

    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    pub fn unit(self) -> Self {
        self * (1.0 / self.length())
    }

    /// A unit vector at right angles.
    pub fn orthogonal(self) -> Self {
        let least = (0..3)
            .min_by(|i, j| self.0[*i].abs().total_cmp(&self.0[*j].abs()))
            .unwrap();
        let mut axis = Self::ZERO;
        axis.0[least] = 1.0;
        self.cross(axis).unit()
    }

    /// Turned by `angle` towards `other`, a unit vector at right angles.
    pub fn turned(self, other: Self, angle: f64) -> Self {
        self * angle.cos() + other * angle.sin()
    }

    pub fn to_f32(self) -> Vec3 {
        Vec3::from_array(self.0.map(|x| x as f32))
    }
}

impl From<Vec3> for Vector {
    fn from(v: Vec3) -> Self {
        Self(v.to_array().map(f64::from))
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}
