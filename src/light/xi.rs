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

    /// (`bits` + 1)·2⁻³², rounded to `f32`.
    #[inline]
    fn from_bits(bits: u32) -> Self {
        // The sum has up to 33 bits. Its conversion rounds once, and the power of two is exact.
        Self((u64::from(bits) + 1) as f32 * (1.0 / 4_294_967_296.0))
    }

    /// The number ξ.
    #[must_use]
    pub fn get(self) -> f32 {
        self.0
    }
}

/// A sequence of random numbers: another seed gives other numbers for all frames.
///
/// A picture is exact in the mean if the ξ of each light is uniform *by itself*: a pixel is a sum over lights,
/// a mean of frames is a sum over frames, and the expectation of a sum is the sum of the expectations. How the
/// ξ of different lights and frames go together changes the noise alone. There are three ways, each uniform
/// for every light and frame, over all seeds:
///
/// | | lights | frames | for |
/// |---|---|---|---|
/// | [`xi_of_rank`](FrameSeed::xi_of_rank) | spread: neighbours cut their ranges at evenly spaced places | spread | lights with ranks ([`rank_along_curve`](crate::rank_along_curve)); the least noise |
/// | [`xi`](FrameSeed::xi) | independent | spread | lights without ranks |
/// | [`hashed_xi`](FrameSeed::hashed_xi) | independent | independent | statistics that need independence |
///
/// ξ that are spread are not independent of each other. So do not use them for two purposes, such as two
/// coordinates of a point, and do not take the variance over a few frames for the variance over seeds.
///
/// ```
/// use stochastic_light_culling::Seed;
///
/// let [first, second] = [0, 1].map(|frame| Seed(7).frame(frame));
/// assert_eq!(first.xi(41), first.xi(41));
/// assert_ne!(first.xi(41), second.xi(41));
///
/// // The ranks 0 to 7 have one ξ in each eighth of (0, 1].
/// let mut eighths = [0, 1, 2, 3, 4, 5, 6, 7].map(|rank| {
///     (first.xi_of_rank(rank).get() * 8.0) as u32 % 8
/// });
/// eighths.sort_unstable();
/// assert_eq!(eighths, [0, 1, 2, 3, 4, 5, 6, 7]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Seed(pub u32);

/// A frame of a sequence of random numbers. It gives each light its ξ, without any state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameSeed {
    /// Hashed frame and seed.
    frame_key: Key,
    /// The hashed seed, the same in all frames.
    key: Key,
    /// Hashed from the seed alone.
    offset: u32,
    frame: u32,
}

/// Two words to hash with a third one. Both are odd: a product with an even number loses bits, and with zero
/// all of them.
type Key = [u32; 2];

/// The step from frame to frame of a light by itself, in units of 2⁻³²: 1 over the golden ratio. Of all steps
/// it spreads its multiples, modulo 1, most evenly.
const GOLDEN_STEP: u32 = 0x9E37_79B9;

/// The step from frame to frame of lights with ranks, in units of 2⁻³².
///
/// The ξ of 2ⁿ ranks together repeat after 2⁻ⁿ. So multiples of the step must be spread modulo 2⁻ⁿ too, which
/// those of the golden ratio are not: after 8 frames of 8 ranks, they leave a gap of 0.6 · 2⁻³. A search for
/// the step α that maximises the minimum of q‖2ⁿqα‖ over n ≤ 8 and q ≤ 64, where ‖·‖ is the distance from the
/// nearest integer, found 0.144. The golden ratio has 0.028, and 0.382 for n = 0 alone.
const RANKED_STEP: u32 = 0x6945_004F;

impl Seed {
    /// The random numbers of the frame with this index.
    #[inline]
    #[must_use]
    pub fn frame(self, frame: u32) -> FrameSeed {
        let Self(seed) = self;
        // The third words are arbitrary, but not small.
        let frame_key = hashed([frame, seed, 0x9E37_79B9]);
        let key = hashed([seed, 0x7F4A_7C15, 0xBF58_476D]);
        let [offset, _] = hashed([seed, 0x1CE4_E5B9, 0x94D0_49BB]);
        FrameSeed {
            frame_key: frame_key.map(|word| word | 1),
            key: key.map(|word| word | 1),
            offset,
            frame,
        }
    }

    /// A seed for a subregion of [`Interleave`](crate::Interleave), whose lights have ranks of their own.
    ///
    /// With one seed for all of them, the same ranks of all subregions would err alike, and so would the
    /// pixels side by side, which a denoiser cannot remove.
    #[inline]
    #[must_use]
    pub fn subregion(self, subregion: u32) -> Self {
        let [seed, _] = hashed([subregion, self.0, 0xD1B5_4A33]);
        Self(seed)
    }
}

impl FrameSeed {
    /// The ξ of the light with the index `light`, the same in each call: hashed from light and seed, and
    /// moved by the golden ratio from frame to frame.
    #[inline]
    #[must_use]
    pub fn xi(self, light: u32) -> Xi {
        // The index needs no generator of its own: the key is hashed, and moves it first.
        let [first, second] = self.key;
        let [bits, _] = stirred(light, first, second);
        Xi::from_bits(bits.wrapping_add(self.frame.wrapping_mul(GOLDEN_STEP)))
    }

    /// The ξ of the light with this rank: the bit-reversed rank [van der Corput 1935], moved by an offset from
    /// the seed, and by a constant step from frame to frame.
    ///
    /// Lights with ranks near each other have ξ that are evenly spaced: any 2ⁿ of them whose ranks begin at a
    /// multiple of 2ⁿ are 2⁻ⁿ apart. Give each light of a seed a rank of its own; those with equal ranks
    /// have equal ξ, which is still exact in the mean. When lights come and go, ranks may be computed anew;
    /// from frame to frame only lights that keep their rank are spread.
    #[inline]
    #[must_use]
    pub fn xi_of_rank(self, rank: u32) -> Xi {
        let bits = rank.reverse_bits().wrapping_add(self.offset);
        Xi::from_bits(bits.wrapping_add(self.frame.wrapping_mul(RANKED_STEP)))
    }

    /// The ξ of the light with the index `light`, hashed from light, frame and seed.
    ///
    /// The hash is that of [Jarzynski & Olano 2020, "pcg3d"]. Frame and seed are hashed before, since
    /// otherwise some seeds show a lattice, and so do equal frames and seeds.
    #[inline]
    #[must_use]
    pub fn hashed_xi(self, light: u32) -> Xi {
        let [first, second] = self.frame_key;
        let [bits, _] = stirred(congruential(light), first, second);
        Xi::from_bits(bits)
    }

    /// A point in \[0, 1)² that is spread evenly together with those of other indices: of Sobol's sequence, with
    /// its bits flipped by a hash of frame and seed [Sobol' 1967; Kollig & Keller 2002].
    ///
    /// Any 2ⁿ points whose indices begin at a multiple of 2ⁿ have one in each of 2ⁿ equal rectangles, of any of
    /// the n + 1 shapes that halving the sides makes. Each point by itself is uniform over all seeds. The points
    /// of different frames are independent. So take the same frame again where nothing is to flicker.
    #[inline]
    #[must_use]
    pub fn point(self, index: u32) -> [f32; 2] {
        // The second coordinate is Pascal's triangle modulo 2 times the bits of the index, doubled row by row.
        let (mut second, mut column, mut bits) = (0, 1_u32 << 31, index);
        while bits != 0 {
            if bits & 1 == 1 {
                second ^= column;
            }
            column ^= column >> 1;
            bits >>= 1;
        }
        let [x, y] = self.frame_key;
        let flips = stirred(POINTS, x, y);
        below_one([index.reverse_bits() ^ flips[0], second ^ flips[1]])
    }

    /// A point in \[0, 1)² hashed from index, frame and seed: independent of other points, and of the ξ.
    #[inline]
    #[must_use]
    pub fn hashed_point(self, index: u32) -> [f32; 2] {
        let [first, second] = self.frame_key;
        below_one(stirred(congruential(index) ^ POINTS, first, second))
    }
}

/// What tells points from ξ.
const POINTS: u32 = 0x6A09_E667;

/// The 24 highest bits of each word, as a number in \[0, 1).
#[inline]
fn below_one(words: [u32; 2]) -> [f32; 2] {
    words.map(|word| (word >> 8) as f32 * (1.0 / 16_777_216.0))
}

/// pcg3d: the first two of three hashed words.
#[inline]
fn hashed(words: [u32; 3]) -> [u32; 2] {
    let [x, y, z] = words.map(congruential);
    stirred(x, y, z)
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
