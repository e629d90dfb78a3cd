//! Colours of receivers, which a lobe does not have.

use stochastic_light_culling::{BlockEstimates, Estimate, PointBlock, glam::Vec3};

/// What each pixel of a block reflects, a channel after the other.
pub type Sums = [[f32; PointBlock::LEN]; 3];

/// The colours that receivers reflect light in.
pub trait Palette: Sync {
    /// Adds to `sums` what the receivers of `pixels` reflect of a light with this `tint`.
    fn add(
        &self,
        pixels: &[usize],
        estimates: &BlockEstimates,
        reflected: &[f32; PointBlock::LEN],
        tint: Vec3,
        sums: &mut Sums,
    );

    /// What the receiver of `pixel` reflects of a light with this `tint`.
    fn colored(&self, pixel: usize, estimate: &Estimate, reflected: f32, tint: Vec3) -> Vec3;
}

/// Receivers that reflect all colours alike.
#[derive(Clone, Copy, Debug)]
pub struct White;

impl Palette for White {
    #[inline(always)]
    fn add(
        &self,
        _: &[usize],
        _: &BlockEstimates,
        reflected: &[f32; PointBlock::LEN],
        tint: Vec3,
        sums: &mut Sums,
    ) {
        for (sums, tint) in sums.iter_mut().zip(tint.to_array()) {
            for (sum, reflected) in sums.iter_mut().zip(reflected) {
                *sum += reflected * tint;
            }
        }
    }

    #[inline(always)]
    fn colored(&self, _: usize, _: &Estimate, reflected: f32, tint: Vec3) -> Vec3 {
        reflected * tint
    }
}
