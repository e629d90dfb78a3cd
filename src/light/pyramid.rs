use core::ops::{Add, Mul};

use crate::base::Error;
use crate::num::power;

/// The mip levels of a map: each texel of a level holds what a square of texels of the map adds up to.
///
/// With [`ClusterSums`](crate::ClusterSums) as texels it is a reflective shadow map, from which
/// [`sample`](Self::sample) draws clusters. Anything else that adds up, such as the flux of each colour, has a
/// pyramid of its own, and is read at the same places.
///
/// Level 0 is the map. A texel of the next level is the sum of 2×2 texels, and the last level has one texel, the
/// sum of all. So a mean over the 4ˡ texels beneath is the texel over 4ˡ, which rounds nothing, and clusters
/// merge exactly. A map of any size is taken as the corner of a square of 2ⁿ×2ⁿ texels, of which the rest are
/// empty and not stored: level l has ⌈width/2ˡ⌉ × ⌈height/2ˡ⌉ texels, and no row or column is dropped.
///
/// The memory is the caller's. A [`pyramid_len`] of texels holds all levels, and is used again each frame.
///
/// ```
/// use stochastic_light_culling::{MipPyramid, pyramid_len};
///
/// // A map of 3×2 texels, row by row, with room for levels of 2×1 and of 1×1 texels.
/// let mut texels = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
/// texels.resize(pyramid_len([3, 2])?, 0.0);
/// let pyramid = MipPyramid::build([3, 2], &mut texels)?;
/// assert_eq!(pyramid.levels(), 3);
/// assert_eq!(*pyramid.total(), 21.0);
/// assert_eq!(pyramid.level(1), Some(([2, 1], &[12.0, 9.0][..])));
/// // Between the centers of two texels, and of all there are at the top.
/// assert_eq!(pyramid.mean_at([1.0 / 3.0, 0.25], 0.0), 1.5);
/// assert_eq!(pyramid.sum_at([0.9, 0.1], 2.0), 21.0);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MipPyramid<'a, T> {
    layout: Layout,
    texels: &'a [T],
}

/// The largest width and height of a map, as of a texture of most GPUs.
const MAX_SIDE: u32 = 16_384;
/// The levels of the largest map.
const MAX_LEVELS: usize = 15;

/// Where the levels of a pyramid are.
#[derive(Clone, Copy, Debug)]
struct Layout {
    size: [u32; 2],
    levels: u32,
    /// Of each level its first texel; then, and for levels that there are not, the number of all texels.
    starts: [usize; MAX_LEVELS + 1],
}

/// How many texels all levels of a [`MipPyramid`] have together, for a map of `size` = width and height: a third
/// more than the map, and few besides.
///
/// # Errors
///
/// [`Error::Size`] if a side is zero or above 16,384.
pub fn pyramid_len(size: [u32; 2]) -> Result<usize, Error> {
    Layout::new(size).map(|layout| layout.len())
}

impl Layout {
    fn new(size: [u32; 2]) -> Result<Self, Error> {
        if !size.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(Error::Size {
                quantity: "size of a map",
                value: size,
                valid: "from 1 to 16384 each way",
            });
        }
        let [width, height] = size;
        let levels = 1 + width.max(height).next_power_of_two().trailing_zeros();
        let mut layout = Self {
            size,
            levels,
            starts: [0; MAX_LEVELS + 1],
        };
        let mut start = 0;
        for level in 0..layout.starts.len() {
            layout.starts[level] = start;
            if (level as u32) < levels {
                let [width, height] = layout.size_of(level as u32);
                start += width as usize * height as usize;
            }
        }
        Ok(layout)
    }

    fn len(&self) -> usize {
        self.starts[MAX_LEVELS]
    }

    fn top(&self) -> u32 {
        self.levels - 1
    }

    fn size_of(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(1 << level))
    }

    /// The place of a texel that the level has.
    #[inline]
    fn place(&self, level: u32, [x, y]: [u32; 2]) -> usize {
        let [width, _] = self.size_of(level);
        self.starts[level as usize] + y as usize * width as usize + x as usize
    }

    /// The texels whose mean is read at `position` and `level`, with their weights.
    fn taps(&self, position: [f32; 2], level: f32) -> [(usize, f32); 8] {
        let (lower, share) = self.split_level(level);
        let mut taps = [(0, 0.0); 8];
        for (i, share) in [1.0 - share, share].into_iter().enumerate() {
            let level = (lower + i as u32).min(self.top());
            // Texels hold sums over 4ˡ texels.
            let weight = share * quarter_power(level);
            for (j, (place, bilinear)) in self.nearest_four(position, level).into_iter().enumerate()
            {
                taps[4 * i + j] = (place, weight * bilinear);
            }
        }
        taps
    }

    /// The level below `level`, and how far it is from there to the next.
    fn split_level(&self, level: f32) -> (u32, f32) {
        // Zero for NaN.
        let level = level.max(0.0).min(self.top() as f32);
        let lower = level as u32;
        (lower, level - lower as f32)
    }

    /// The texels around `position`, and their bilinear weights. Beyond the edge are those at the edge.
    fn nearest_four(&self, position: [f32; 2], level: u32) -> [(usize, f32); 4] {
        let size = self.size_of(level);
        let axis = |axis: usize| {
            let position = position[axis];
            // Zero for NaN.
            let position = if position > 0.0 {
                position.min(1.0)
            } else {
                0.0
            };
            let across = self.size[axis] as f32 / (1_u32 << level) as f32;
            // From the center of the first texel, shifted by one so that it is not negative.
            let shifted = position * across + 0.5;
            let second = (shifted as u32).min(size[axis]);
            let share = (shifted - second as f32).min(1.0);
            let clamped = |texel: u32| texel.min(size[axis] - 1);
            let first = clamped(second.saturating_sub(1));
            [(first, 1.0 - share), (clamped(second), share)]
        };
        let (columns, rows) = (axis(0), axis(1));
        let mut nearest = [(0, 0.0); 4];
        for (i, (y, row)) in rows.into_iter().enumerate() {
            for (j, (x, column)) in columns.into_iter().enumerate() {
                nearest[2 * i + j] = (self.place(level, [x, y]), row * column);
            }
        }
        nearest
    }
}

/// 4⁻ˡ for l ≤ 14, exactly.
fn quarter_power(level: u32) -> f32 {
    f32::from_bits((127 - 2 * level) << 23)
}

impl<'a, T: Copy + Add<Output = T>> MipPyramid<'a, T> {
    /// Fills in the levels above a map of `size` = width and height, which is at the start of `texels` row by
    /// row.
    ///
    /// The levels follow one after another, each row by row. What is in `texels` after the map does not matter.
    /// Takes time linear in the number of texels, and does not allocate.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if a side is zero or above 16,384, [`Error::Count`] if there are fewer `texels` than
    /// [`pyramid_len`] says.
    pub fn build(size: [u32; 2], texels: &'a mut [T]) -> Result<Self, Error> {
        let layout = Layout::new(size)?;
        let count = texels.len();
        let Some(texels) = texels.get_mut(..layout.len()) else {
            return Err(Error::Count {
                quantity: "number of texels",
                value: count,
                valid: "that of all levels, as pyramid_len says",
            });
        };
        for level in 1..layout.levels {
            let [width, height] = layout.size_of(level);
            let [below_width, below_height] = layout.size_of(level - 1);
            let (below, above) = texels.split_at_mut(layout.starts[level as usize]);
            let below = &below[layout.starts[level as usize - 1]..];
            let row = |y: u32| &below[(y * below_width) as usize..][..below_width as usize];
            let sum_of_row = |row: &[T], x: u32| {
                let left = row[2 * x as usize];
                row.get(2 * x as usize + 1)
                    .map_or(left, |right| left + *right)
            };
            let rows = above.chunks_exact_mut(width as usize);
            for (y, sums) in (0..height).zip(rows) {
                let upper = row(2 * y);
                let lower = (2 * y + 1 < below_height).then(|| row(2 * y + 1));
                for (x, sum) in (0..width).zip(sums) {
                    *sum = sum_of_row(upper, x);
                    if let Some(lower) = lower {
                        *sum = *sum + sum_of_row(lower, x);
                    }
                }
            }
        }
        Ok(Self { layout, texels })
    }

    /// Width and height of the map.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.layout.size
    }

    /// The number of levels: 1 + ⌈log₂ max(width, height)⌉.
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.layout.levels
    }

    /// Width and height of a level, and its texels row by row; `None` above the top.
    #[must_use]
    pub fn level(&self, level: u32) -> Option<([u32; 2], &'a [T])> {
        if level >= self.layout.levels {
            return None;
        }
        let [start, end] = [level, level + 1].map(|level| self.layout.starts[level as usize]);
        Some((self.layout.size_of(level), &self.texels[start..end]))
    }

    /// The sum of all texels of the map.
    #[must_use]
    pub fn total(&self) -> &'a T {
        &self.texels[self.layout.len() - 1]
    }

    /// The mean of the map's texels around `position`, as far around as `level` says: with trilinear weights, as
    /// a GPU reads a mip map.
    ///
    /// `position` is in \[0, 1\]² over the map, from its first texel's corner to its last one's. A level is read
    /// between the centers of its texels, and beyond the outermost centers as there. The square without texels
    /// that a map lacks to a power of two counts as empty.
    ///
    /// Numbers beyond the ends count as the ends, and NaN as zero.
    #[must_use]
    pub fn mean_at(&self, position: [f32; 2], level: f32) -> T
    where
        T: Mul<f32, Output = T>,
    {
        let [first, rest @ ..] = self.layout.taps(position, level);
        let weighted = |(place, weight): (usize, f32)| self.texels[place] * weight;
        let mut sum = weighted(first);
        for tap in rest {
            sum = sum + weighted(tap);
        }
        sum
    }

    /// What a square of 4ˡ texels around `position` adds up to, l = `level`: 4ˡ times
    /// [`mean_at`](Self::mean_at), or 4ˡ/M times the mean of a density over \[0, 1\]² for a map of M texels
    /// [Tokuyoshi 2016, Sec. 3.3].
    #[must_use]
    pub fn sum_at(&self, position: [f32; 2], level: f32) -> T
    where
        T: Mul<f32, Output = T>,
    {
        let (lower, share) = self.layout.split_level(level);
        self.mean_at(position, level) * power(4.0, lower as f32 + share)
    }

    /// The mean at `position` and `level` of a number that `value` gives for texels.
    #[inline]
    pub(super) fn mean_of(&self, value: impl Fn(&T) -> f64, position: [f32; 2], level: f32) -> f64 {
        let mut sum = 0.0;
        for (place, weight) in self.layout.taps(position, level) {
            sum += value(&self.texels[place]) * f64::from(weight);
        }
        sum
    }

    /// The texel at a place of a level, or none beyond the edge of the level.
    #[inline]
    pub(super) fn texel(&self, level: u32, [x, y]: [u32; 2]) -> Option<&'a T> {
        let [width, height] = self.layout.size_of(level);
        if x < width && y < height {
            Some(&self.texels[self.layout.place(level, [x, y])])
        } else {
            None
        }
    }
}
