//! The lights that everything comes from.

use stochastic_light_culling::glam::Vec3;

use super::Spot;

/// A light of the scene. What it emits is in W/sr or candela: pictures are exposed by what they show.
#[derive(Clone, Copy, Debug)]
pub enum Lamp {
    /// In all directions, with photons for a square window alone: what its shadow map covers.
    Window(Spot),
    /// In all directions.
    Point { position: Vec3, intensity: Vec3 },
    /// In a cone around a unit `axis`: the whole `intensity` within one angle, none beyond another.
    Cone {
        position: Vec3,
        axis: Vec3,
        cosines: Cosines,
        intensity: Vec3,
    },
    /// Parallel, as from the sun.
    Parallel {
        to_light: Vec3,
        /// Of a surface that faces it, in W/m² or lux.
        irradiance: Vec3,
    },
}

/// The cosines of the two angles of a cone.
#[derive(Clone, Copy, Debug)]
pub struct Cosines {
    pub inner: f32,
    pub outer: f32,
}

impl Cosines {
    /// The share of the intensity at a `cosine` to the axis, as glTF's extension KHR_lights_punctual
    /// recommends it.
    fn falloff(self, cosine: f32) -> f32 {
        let share = (cosine - self.outer) / (self.inner - self.outer).max(1e-3);
        let share = share.clamp(0.0, 1.0);
        share * share
    }
}

/// What arrives of a lamp at a point that nothing shades.
pub struct Arriving {
    /// Of unit length.
    pub to_light: Vec3,
    pub distance: f32,
    /// Of a surface that faces the lamp.
    pub irradiance: Vec3,
}

impl Lamp {
    /// The lamp moved across its direction from `target`, level, by `moved` times its distance from there.
    pub fn moved_aside(mut self, target: Vec3, moved: f32) -> Self {
        let aside = |to_light: Vec3| moved * to_light.cross(Vec3::Y).normalize_or(Vec3::X);
        match &mut self {
            Self::Parallel { to_light, .. } => {
                *to_light = (*to_light + aside(*to_light)).normalize();
            }
            Self::Window(Spot { position, .. })
            | Self::Point { position, .. }
            | Self::Cone { position, .. } => {
                let to_light = *position - target;
                *position += aside(to_light) * to_light.length();
            }
        }
        self
    }

    /// What arrives at `point`; `None` where the lamp does not shine.
    pub fn arriving(&self, point: Vec3) -> Option<Arriving> {
        let (position, intensity) = match *self {
            Self::Parallel {
                to_light,
                irradiance,
            } => {
                return Some(Arriving {
                    to_light,
                    distance: f32::INFINITY,
                    irradiance,
                });
            }
            Self::Window(spot) => (spot.position, spot.intensity),
            Self::Point {
                position,
                intensity,
            }
            | Self::Cone {
                position,
                intensity,
                ..
            } => (position, intensity),
        };
        let to_light = (position - point).try_normalize()?;
        let distance = position.distance(point);
        let irradiance = intensity * self.share(-to_light) / (distance * distance);
        (irradiance.max_element() > 0.0).then_some(Arriving {
            to_light,
            distance,
            irradiance,
        })
    }

    /// Where it is, unless it is infinitely far away.
    pub fn position(&self) -> Option<Vec3> {
        match *self {
            Self::Window(spot) => Some(spot.position),
            Self::Point { position, .. } | Self::Cone { position, .. } => Some(position),
            Self::Parallel { .. } => None,
        }
    }

    /// The share of its intensity that it sends in a unit `direction`.
    pub fn share(&self, direction: Vec3) -> f32 {
        match self {
            Self::Cone { axis, cosines, .. } => cosines.falloff(axis.dot(direction)),
            Self::Window(_) | Self::Point { .. } | Self::Parallel { .. } => 1.0,
        }
    }

    /// The same lamp, `factor` times as bright.
    pub fn brighter(self, factor: f32) -> Self {
        let mut lamp = self;
        match &mut lamp {
            Self::Window(spot) => spot.intensity *= factor,
            Self::Point { intensity, .. } | Self::Cone { intensity, .. } => *intensity *= factor,
            Self::Parallel { irradiance, .. } => *irradiance *= factor,
        }
        lamp
    }
}
