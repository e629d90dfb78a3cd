//! What bounds many lobes at once within a cap of directions.
//!
//! A family stands for all the lobes of a tile, or of a block of tiles: axes within a chord of a mean axis, and
//! ranges of the other numbers. Its majorant is an upper bound of every member towards every direction of a cap.
//!
//! # Nesting
//!
//! If a family is the [union](LobeFamily::union) of others, and a cap holds another, the greater pair has the
//! greater majorant, but for rounding. That takes more than nested sets: a chord of the greater must be at least
//! the distance of the two axes and the chord of the lesser together. So lights that a block of tiles rejects
//! would be rejected by each of its tiles.

use core::fmt::Debug;

use super::{Cap, Caps, Lobe};
use crate::num::Single;

/// What is known of a lobe, or of many, within a cap of directions, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Majorant<N> {
    /// An upper bound of the value towards every direction.
    pub greatest: N,
    /// An estimate of the value, at most [`greatest`](Self::greatest). Positive where that is.
    pub typical: N,
}

impl<N: Single> Majorant<N> {
    /// The same for both.
    #[inline(always)]
    pub fn exactly(value: N) -> Self {
        Self {
            greatest: value,
            typical: value,
        }
    }
}

/// A lobe that receivers may have: many of them have a common bound.
pub trait ReceiverLobe: Lobe + Clone {
    /// What stands for many such lobes.
    type Family: LobeFamily;

    /// The family of this lobe alone.
    #[must_use]
    fn family(&self) -> Self::Family;
}

/// What stands for many lobes, such as those of the receivers in a tile.
pub trait LobeFamily: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Sums of axes, and ranges of the other numbers. By default those of no lobe.
    #[doc(hidden)]
    type Sum: Copy + Default;

    /// Mean axes, and ranges of the other numbers.
    #[doc(hidden)]
    type Mean;

    /// How far members are from mean axes: zero if there are none.
    #[doc(hidden)]
    type Reach: Copy + Default;

    /// The family of all members of `families`. `None` if there are none.
    ///
    /// The iterator is walked twice: once for mean axes, once for the chords around them.
    #[must_use]
    fn union(families: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        families.clone().next()?;
        let mut sum = Self::Sum::default();
        for family in families.clone() {
            family.add_to(&mut sum);
        }
        let (mean, mut reach) = (Self::mean(&sum), Self::Reach::default());
        for family in families {
            family.widen(&mean, &mut reach);
        }
        Some(Self::around(&mean, &reach))
    }

    /// Adds this family to a sum.
    #[doc(hidden)]
    fn add_to(&self, sum: &mut Self::Sum);

    /// The mean of a sum.
    #[doc(hidden)]
    fn mean(sum: &Self::Sum) -> Self::Mean;

    /// Extends `reach` until it holds this family, which is in the sum of the mean.
    #[doc(hidden)]
    fn widen(&self, mean: &Self::Mean, reach: &mut Self::Reach);

    /// The family of all members within reach of a mean.
    #[doc(hidden)]
    fn around(mean: &Self::Mean, reach: &Self::Reach) -> Self;

    /// Computes the majorant of all members within the cap in each lane.
    #[doc(hidden)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N>;

    /// An upper bound of the value of every member towards every direction of `cap`, as
    /// [`Lobe::maximum_within`] is of one lobe.
    #[must_use]
    fn greatest_within(&self, cap: &Cap) -> f32 {
        self.majorant_in_lanes(&cap.lanes()).greatest
    }
}

/// The family of receivers of which nothing is known but where they are: the value is 1.
///
/// With it, the radiance that arrives counts, whatever a surface reflects of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Blind;

impl LobeFamily for Blind {
    type Sum = ();
    type Mean = ();
    type Reach = ();

    fn add_to(&self, (): &mut ()) {}

    fn mean((): &()) {}

    fn widen(&self, (): &(), (): &mut ()) {}

    fn around((): &(), (): &()) -> Self {
        Self
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        Majorant::exactly(cap.splat(1.0))
    }
}
