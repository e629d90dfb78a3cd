use crate::base::Direction;

/// How light arrives at a surface: its normal, and the direction to where the light comes from. Both point
/// away from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Incidence {
    /// The surface normal n.
    pub normal: Direction,
    /// The direction ω_i that light comes from.
    pub incoming: Direction,
}

impl Incidence {
    /// Normal incidence: light that arrives along `normal`.
    #[must_use]
    pub const fn head_on(normal: Direction) -> Self {
        Self {
            normal,
            incoming: normal,
        }
    }
}
