use crate::base::Direction;

/// Where light arrives: at a surface with `normal` from `incoming`. Both point away from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Incidence {
    /// n, the surface normal.
    pub normal: Direction,
    /// ω_i, the direction that light comes from.
    pub incoming: Direction,
}

impl Incidence {
    /// Incidence along the `normal`.
    #[must_use]
    pub const fn head_on(normal: Direction) -> Self {
        Self {
            normal,
            incoming: normal,
        }
    }
}
