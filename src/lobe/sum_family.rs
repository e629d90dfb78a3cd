use super::sum::weighted_majorant;
use super::{Caps, LobeFamily, LobeSum, Majorant, ReceiverLobe};
use crate::num::{Real, Single};

/// What stands for many [`LobeSum`]s: a family of each lobe, and the greatest weights.
///
/// Its majorant is the weighted sum of both, which nests as they do. A lobe of weight zero is no member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SumFamily<A, B> {
    families: (A, B),
    weights: [f32; 2],
}

impl<A: ReceiverLobe, B: ReceiverLobe> ReceiverLobe for LobeSum<A, B> {
    type Family = SumFamily<A::Family, B::Family>;

    #[inline(always)]
    fn family(&self) -> Self::Family {
        let (first, second) = self.lobes();
        SumFamily {
            families: (first.family(), second.family()),
            weights: self.weights(),
        }
    }
}

impl<A: LobeFamily, B: LobeFamily> LobeFamily for SumFamily<A, B> {
    /// The sums of both, and the greatest weights.
    type Sum = (A::Sum, B::Sum, [f32; 2]);
    /// The means of both, and the greatest weights.
    type Mean = (A::Mean, B::Mean, [f32; 2]);
    type Reach = (A::Reach, B::Reach);

    #[inline(always)]
    fn add_to(&self, (of_first, of_second, weights): &mut Self::Sum) {
        let (first, second) = &self.families;
        add_weighted((first, self.weights[0]), of_first, &mut weights[0]);
        add_weighted((second, self.weights[1]), of_second, &mut weights[1]);
    }

    fn mean((first, second, weights): &Self::Sum) -> Self::Mean {
        (A::mean(first), B::mean(second), *weights)
    }

    #[inline(always)]
    fn widen(&self, (of_first, of_second, _): &Self::Mean, reach: &mut Self::Reach) {
        let (first, second) = &self.families;
        if self.weights[0] > 0.0 {
            first.widen(of_first, &mut reach.0);
        }
        if self.weights[1] > 0.0 {
            second.widen(of_second, &mut reach.1);
        }
    }

    fn around((first, second, weights): &Self::Mean, reach: &Self::Reach) -> Self {
        Self {
            families: (A::around(first, &reach.0), B::around(second, &reach.1)),
            weights: *weights,
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let (first, second) = &self.families;
        let majorants = [first.majorant_in_lanes(cap), second.majorant_in_lanes(cap)];
        weighted_majorant(
            majorants,
            [cap.splat(self.weights[0]), cap.splat(self.weights[1])],
        )
    }
}

/// Adds a family with its weight to a sum. One of weight zero is no member.
#[inline(always)]
fn add_weighted<F: LobeFamily>((family, weight): (&F, f32), sum: &mut F::Sum, greatest: &mut f32) {
    if weight > 0.0 {
        family.add_to(sum);
        *greatest = Real::max(weight, *greatest);
    }
}
