use super::Ellipsoids;
use crate::num::{Matrix3, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the rounding of axis, frame and centre, in units of u times longest over shortest semi-axis.
const AXES_TILT_ROUNDINGS: f32 = 16.0;
/// Pays for the rounding of the semi-axes and of the reach.
const SEMI_AXIS_ROUNDINGS: u16 = 64;

/// An ellipsoid of revolution in each lane, for lobes that extend by 1 along their axis. The light is inside.
#[derive(Clone, Copy)]
pub(super) struct Revolved<N> {
    /// The distance of the centre from the light, along the axis.
    pub center: N,
    pub along: N,
    pub across: N,
}

impl<N: Single> Revolved<N> {
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let [center, along, across] = N::select_all(
            mask,
            [yes.center, yes.along, yes.across],
            [no.center, no.along, no.across],
        );
        Self {
            center,
            along,
            across,
        }
    }

    /// The ellipsoid along `axis` for a lobe that extends by `reach` > 0, rounded outward.
    #[inline(always)]
    pub fn along(self, axis: Vector3<N>, reach: N) -> Ellipsoids<N> {
        let (v, w) = axis.any_orthonormal_pair();
        let semi_axes = Vector3::new(self.along, self.across, self.across);
        // By how far the rounding of axis, frame and centre moves a point, over the shortest semi-axis.
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let moved = longest * (AXES_TILT_ROUNDINGS * UNIT_ROUNDOFF) / shortest;
        Ellipsoids {
            light: None,
            offset: axis * (self.center * reach),
            axes: Matrix3::new(axis, v, w),
            semi_axes: semi_axes * (reach * (moved + 1.0)).round_up(SEMI_AXIS_ROUNDINGS),
        }
    }
}
