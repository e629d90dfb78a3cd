//! Arguments of any kind, read from bytes.

use stochastic_light_culling::glam::{Mat3, Mat4, Vec2, Vec3};

/// Numbers at which arithmetic changes its ways.
pub const SPECIAL: [f32; 12] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    0.0,
    -0.0,
    1e-45,
    -1e-45,
    1e-40,
    f32::MIN_POSITIVE,
    f32::MAX,
    f32::MIN,
    1.0,
];

/// Bytes, and after the last of them zeros.
#[derive(Clone, Debug)]
pub struct Bits<'a>(pub &'a [u8]);

impl Bits<'_> {
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        *first
    }

    pub fn word(&mut self) -> u32 {
        u32::from_le_bytes([(); 4].map(|()| self.byte()))
    }

    pub fn seed(&mut self) -> u64 {
        u64::from(self.word()) << 32 | u64::from(self.word())
    }

    /// A word, often a small one.
    pub fn size(&mut self) -> u32 {
        match self.byte() {
            tag if tag < 64 => self.word(),
            tag => u32::from(self.byte()) >> (tag % 8),
        }
    }

    /// Any `f32`: a bit pattern as it is, a special number, or one between 2⁻²⁴ and 2⁸, which is what
    /// most constructors take.
    pub fn number(&mut self) -> f32 {
        match self.byte() {
            tag if tag < 96 => f32::from_bits(self.word()),
            tag if tag < 128 => SPECIAL[usize::from(tag) % SPECIAL.len()],
            tag => {
                let [sign, mantissa] = [1 << 31, (1 << 23) - 1].map(|mask| self.word() & mask);
                let sign = if tag < 160 { sign } else { 0 };
                let exponent = 127 - 24 + u32::from(tag) % 32;
                f32::from_bits(sign | exponent << 23 | mantissa)
            }
        }
    }

    pub fn pair(&mut self) -> Vec2 {
        Vec2::from_array([(); 2].map(|()| self.number()))
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.number()))
    }

    pub fn matrix(&mut self) -> Mat3 {
        Mat3::from_cols_array(&[(); 9].map(|()| self.number()))
    }

    pub fn matrix4(&mut self) -> Mat4 {
        Mat4::from_cols_array(&[(); 16].map(|()| self.number()))
    }
}
