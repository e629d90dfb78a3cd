//! Random numbers without state: each is a hash of what it is for.

use stochastic_light_culling::Seed;

/// What a number is drawn for. From frames that no picture will reach.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum Purpose {
    JitterX = 0xffff_fff0,
    JitterY,
    Shuffle,
    ReflectionX,
    ReflectionY,
}

/// A number in (0, 1] for the thing `index`.
pub fn uniform(index: u32, purpose: Purpose, seed: u32) -> f32 {
    let frame = purpose as u32;
    Seed(seed).frame(frame).hashed_xi(index).get()
}
