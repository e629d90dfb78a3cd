use glam::Vec3;

use crate::base::{Direction, Error, finite};
use crate::light::Vpl;
use crate::lobe::Lobe;

/// The half-space n·(x − q) > 0 above a surface, which light reflected by the surface can reach.
///
/// It complements a bound, most of which extend below the surface: a light whose half-space or whose bound
/// does not touch a tile does not light it.
///
/// ```
/// use stochastic_light_culling::{Camera, DepthInterval, Direction, HalfSpace, TileGrid, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let view = camera.tile(&TileGrid::new([1, 1], 1)?, [0, 0]);
/// // A wall at depth 5 that faces the eye lights only what is in front of it.
/// let wall = HalfSpace::new(Vec3::new(0.0, 0.0, -5.0), Direction::Z)?.project(&camera);
/// assert!(wall.touches(&view, &DepthInterval::new(1.0, 4.0)?));
/// assert!(!wall.touches(&view, &DepthInterval::new(6.0, 9.0)?));
/// assert!((wall.offset() + 5.0).abs() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    position: Vec3,
    normal: Direction,
}

impl HalfSpace {
    /// Creates the half-space on the side of `normal` = n of the plane through `position` = q.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `position` is not finite.
    pub fn new(position: Vec3, normal: Direction) -> Result<Self, Error> {
        Ok(Self {
            position: finite("position of a half-space", position)?,
            normal,
        })
    }

    /// The point q of the plane.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// The normal n, which points into the half-space.
    #[must_use]
    pub fn normal(&self) -> Direction {
        self.normal
    }
}

impl<L: Lobe> Vpl<L> {
    /// The half-space above the surface of the light, outside of which it lights nothing. `None` if its lobe
    /// has no [horizon](Lobe::horizon_normal).
    pub fn half_space(&self) -> Option<HalfSpace> {
        let normal = self.lobe().horizon_normal()?;
        Some(HalfSpace {
            position: self.position(),
            normal,
        })
    }
}
