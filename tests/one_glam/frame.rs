//! One light before an engine's camera: the engine's types go in, and the same types come out.

use stochastic_light_culling::{
    Camera, DepthInterval, Direction, Error, Ggx, GgxLobe, Incidence, NoFresnel, Roulette,
    TileGrid, Vpl, Xi,
};

use super::{Mat3, Mat4, Vec2, Vec3, directx};

/// Number of tiles that the light touches.
///
/// # Errors
///
/// None, for these numbers.
pub fn touched_tiles() -> Result<usize, Error> {
    let eye = Vec3::new(0.0, 2.0, 9.0);
    let view = Mat4::from_translation(-eye);
    let projection = directx::perspective_infinite_reverse(1.0, 1.5, 0.1);
    let camera = Camera::new(view, projection)?;
    let rotation: Mat3 = camera.rotation();
    let eye_in_camera_space: Vec3 = camera.to_camera_space(eye);
    assert_eq!(rotation, Mat3::from_diagonal(Vec3::new(1.0, 1.0, -1.0)));
    assert_eq!(eye_in_camera_space, Vec3::ZERO);

    let incidence = Incidence::head_on(Direction::new(Vec3::Y)?);
    let lobe = GgxLobe::new(Ggx::new(0.3)?, NoFresnel, incidence);
    let light = Vpl::new(Vec3::X, 1.0, lobe)?;
    let position: Vec3 = light.position();
    let (to_eye, distance_squared): (Vec3, f32) = light.direction_to(eye);
    assert!((position + to_eye * distance_squared.sqrt()).abs_diff_eq(eye, 1e-5));

    let bound = light.bound(&Roulette::new(0.01)?, Xi::new(0.5)?);
    let (center, semi_axes): (Vec3, Vec3) = (bound.center(), bound.semi_axes());
    assert!(center.y > 0.0 && semi_axes.min_element() > 0.0);

    let projected = bound
        .project(&camera)
        .expect("light with flux reaches somewhere");
    let grid = TileGrid::new([960, 640], 16)?;
    let tile = camera.tile(&grid, [30, 20]);
    let (min, max): (Vec2, Vec2) = (tile.min(), tile.max());
    assert!(min.cmplt(max).all());
    let depths = DepthInterval::new(1.0, 20.0)?;
    Ok(grid
        .tiles()
        .filter(|tile| projected.touches(&camera.tile(&grid, *tile), &depths))
        .count())
}
