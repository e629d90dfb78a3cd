//! From a lobe to the tiles that it touches.

use stochastic_light_culling::{
    Camera, Conductor, DepthInterval, Direction, Error, Ggx, GgxLobe, Incidence,
    ProjectedEllipsoid, Roulette, Seed, TileGrid, Vpl, glam::Vec3,
};

pub const SIZE: [u32; 2] = [128, 128];

pub fn camera() -> Result<Camera, Error> {
    let (eye, target) = (Vec3::new(0.0, 2.0, 9.0), Vec3::Y);
    Camera::look_at(eye, target, Vec3::Y, 1.0, 1.0, 0.1..100.0)
}

pub fn grid() -> Result<TileGrid, Error> {
    TileGrid::new(SIZE, 16)
}

pub fn depths() -> Result<DepthInterval, Error> {
    DepthInterval::new(7.0, 11.0)
}

/// A light on a metal floor, which a photon of 0.1 W reached from the upper left.
pub fn stretch(light: u32) -> Result<Option<ProjectedEllipsoid>, Error> {
    let incoming = Direction::new(Vec3::new(-1.0, 1.0, 0.0))?;
    let gold = Conductor::new(0.16, 3.5)?;
    let lobe = GgxLobe::new(
        Ggx::new(0.1)?,
        gold,
        Incidence {
            normal: Direction::Y,
            incoming,
        },
    );
    let light_there = Vpl::new(Vec3::ZERO, 0.1, lobe)?;
    let bound = light_there.bound(&Roulette::new(0.01)?, Seed(0).frame(0).xi(light));
    Ok(bound.project(&camera()?))
}

/// How many tiles a light touches.
pub fn touched() -> Result<usize, Error> {
    let (camera, grid, depths) = (camera()?, grid()?, depths()?);
    let Some(stretch) = stretch(0)? else {
        return Ok(0);
    };
    let touches = |tile: &[u32; 2]| {
        let rectangle = camera.tile_rectangle(SIZE, grid.pixels(*tile));
        stretch.touches(&rectangle, &depths)
    };
    Ok(grid.tiles().filter(touches).count())
}

/// Some tiles, but not all; and what is no roughness is refused.
pub fn touches_as_it_must() -> bool {
    matches!(touched(), Ok(1..64)) && Ggx::new(2.0).is_err()
}
