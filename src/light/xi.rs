use crate::base::{Error, number_in};

/// The random number ξ in (0, 1] of a light in one frame, shared by all points that the light may reach.
///
/// Zero is excluded, since the light would reach infinitely far.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Xi(f32);

impl Xi {
    /// Wraps a random number of the caller's own.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `xi` is outside (0, 1] or NaN.
    pub fn new(xi: f32) -> Result<Self, Error> {
        number_in("random number ξ", xi, "in (0, 1]", f32::from_bits(1)..=1.0).map(Self)
    }

    /// The number ξ.
    #[must_use]
    pub fn get(self) -> f32 {
        self.0
    }
}

/// A sequence of random numbers: another seed gives other numbers for all frames.
///
/// ```
/// use stochastic_light_culling::Seed;
///
/// let [first, second] = [0, 1].map(|frame| Seed(7).frame(frame));
/// assert_eq!(first.xi(41), first.xi(41));
/// assert_ne!(first.xi(41), second.xi(41));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Seed(pub u32);

/// A frame of a sequence of random numbers. It gives each light its ξ, without any state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameSeed {
    /// Hashed frame and seed, both odd: a product with an even number loses bits, and with zero all of them.
    key: [u32; 2],
}

impl Seed {
    /// The random numbers of the frame with this index.
    #[inline]
    #[must_use]
    pub fn frame(self, frame: u32) -> FrameSeed {
        // The third word is arbitrary, but not small.
        let [first, second] = stirred(
            congruential(frame),
            congruential(self.0),
            congruential(0x9E37_79B9),
        );
        FrameSeed {
            key: [first | 1, second | 1],
        }
    }
}

impl FrameSeed {
    /// The ξ of the light with the index `light`, the same in each call.
    ///
    /// It is a multiple of 2⁻³², rounded to `f32`, from the hash of [Jarzynski & Olano 2020, "pcg3d"]. Frame and
    /// seed are hashed before, since otherwise some seeds show a lattice, and so do equal frames and seeds.
    #[inline]
    #[must_use]
    pub fn xi(self, light: u32) -> Xi {
        let [first, second] = self.key;
        let [bits, _] = stirred(congruential(light), first, second);
        // The sum has up to 33 bits. Its conversion rounds once, and the power of two is exact.
        Xi((u64::from(bits) + 1) as f32 * (1.0 / 4_294_967_296.0))
    }
}

/// The linear congruential generator, the first step of pcg3d.
#[inline]
fn congruential(word: u32) -> u32 {
    word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
}

/// The steps of pcg3d after [`congruential`]; returns the first two of the three hashed words.
#[inline]
fn stirred(mut x: u32, mut y: u32, mut z: u32) -> [u32; 2] {
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    [x, y]
}
