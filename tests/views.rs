//! Tiles of a camera: as one asks for them one by one, and renewed from frame to frame.
#![cfg(feature = "cull")]

use stochastic_light_culling::{
    Camera, DepthInterval, Direction, Error, Ggx, GgxLobe, Incidence, Interleave, LambertLobe,
    NoFresnel, PhongLobe, TileDepths, TileGrid, Vpl, glam::Vec3,
};

fn camera(fov: f32) -> Result<Camera, Error> {
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, fov, 1.5, 0.1..100.0)
}

#[test]
fn tiles_of_a_grid_are_those_of_its_pixels() -> Result<(), Error> {
    let (camera, grid) = (camera(1.0)?, TileGrid::new([100, 70], 16)?);
    let tiles = TileDepths::new(&grid, &camera, 2)?;
    assert_eq!((tiles.size(), tiles.depths().len()), ([7, 5], 2 * 7 * 5));
    for [x, y] in grid.tiles() {
        let tile = camera.tile(&grid, [x, y]);
        assert_eq!(tile, camera.tile_rectangle([100, 70], grid.pixels([x, y])));
        let [across, down] = [tiles.columns()[x as usize], tiles.rows()[y as usize]];
        assert_eq!([across[0], down[0]], tile.min().to_array());
        assert_eq!([across[1], down[1]], tile.max().to_array());
    }
    Ok(())
}

#[test]
fn tiles_of_a_subregion_hold_its_pixels() -> Result<(), Error> {
    let (camera, interleave) = (camera(1.0)?, Interleave::new([64, 48], 4)?);
    let grid = TileGrid::new(interleave.subregion_size(6), 8)?;
    for tile in grid.tiles() {
        let around = camera.interleaved_tile(&interleave, 6, &grid, tile);
        for pixel in grid.pixels(tile).pixels() {
            let pixel = interleave.join_pixel(6, pixel);
            let point = camera.point_in_pixel([64, 48], pixel, 1.0).truncate();
            assert!(around.min().cmple(point).all() && point.cmple(around.max()).all());
        }
    }
    Ok(())
}

#[test]
fn views_are_renewed_without_allocating() -> Result<(), Error> {
    let (wide, narrow) = (camera(1.2)?, camera(0.4)?);
    let (large, small) = (TileGrid::new([160, 96], 16)?, TileGrid::new([128, 80], 16)?);
    let mut tiles = TileDepths::new(&large, &wide, 2)?;
    tiles.set([3, 2], [DepthInterval::new(1.0, 2.0)?]);
    let allocated = allocation_counter::measure(|| {
        tiles.set_view(&small, &narrow).expect("smaller");
        tiles.set_view(&large, &narrow).expect("as large as before");
    });
    assert_eq!(allocated.count_total, 0);
    // No depths are left of the frame before, and all is as if it were made anew.
    assert!(tiles.is_empty());
    assert_eq!(tiles, TileDepths::new(&large, &narrow, 2)?);

    // What is refused leaves the tiles as they were.
    let before = tiles.clone();
    assert!(
        tiles
            .set_view(&TileGrid::new([1 << 17, 1], 1)?, &wide)
            .is_err()
    );
    assert_eq!(tiles, before);
    Ok(())
}

#[test]
fn depths_are_read_as_they_were_set() -> Result<(), Error> {
    let (camera, grid) = (camera(1.0)?, TileGrid::new([32, 16], 16)?);
    let mut tiles = TileDepths::new(&grid, &camera, 2)?;
    tiles.set([1, 0], [DepthInterval::new(3.0, 4.0)?]);
    let missing = [f32::INFINITY, f32::NEG_INFINITY];
    assert_eq!(tiles.depths(), [missing, missing, [3.0, 4.0], missing]);
    Ok(())
}

#[test]
fn lights_know_the_half_space_that_they_light() -> Result<(), Error> {
    let position = Vec3::new(0.0, 1.0, -5.0);
    let incidence = Incidence {
        normal: Direction::Y,
        incoming: Direction::new(Vec3::new(1.0, 1.0, 0.0))?,
    };
    let metal = GgxLobe::new(Ggx::new(0.2)?, NoFresnel, incidence);
    assert_eq!(
        (metal.incidence(), metal.fresnel()),
        (incidence, &NoFresnel)
    );
    let of_metal = Vpl::new(position, 1.0, metal)?.half_space();
    let of_chalk = Vpl::new(position, 1.0, LambertLobe::new(0.5, Direction::Y)?)?.half_space();
    assert!(of_metal.is_some() && of_metal == of_chalk);
    let half_space = of_metal.expect("above the surface");
    assert_eq!(
        (half_space.position(), half_space.normal()),
        (position, Direction::Y)
    );

    let spot = Vpl::new(position, 1.0, PhongLobe::about(1.0, 9.0, Direction::Y)?)?;
    assert_eq!(spot.half_space(), None);
    Ok(())
}
