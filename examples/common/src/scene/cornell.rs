//! The built-in Cornell box, its tall block of polished metal.

use stochastic_light_culling::glam::{Mat3, Vec3};

use super::mesh::{Material, Mesh};
use super::{Focus, Scene, Viewpoint, Wanted};

pub fn scene(wanted: &Wanted) -> Scene {
    let mut mesh = Mesh::default();
    let [white, red, green] = [[0.73, 0.71, 0.68], [0.63, 0.065, 0.05], [0.14, 0.45, 0.09]]
        .map(|albedo| mesh.add_material(Material::diffuse(albedo.into())));
    let metal = mesh.add_material(Material::metal(Vec3::new(0.95, 0.93, 0.88)));

    room(&mut mesh, white, red, green);
    block(
        &mut mesh,
        white,
        Vec3::new(0.35, 0.0, 0.36),
        [0.6, 0.6, 0.6],
        -0.29,
    );
    block(
        &mut mesh,
        metal,
        Vec3::new(-0.34, 0.0, -0.3),
        [0.6, 1.2, 0.6],
        0.38,
    );

    let light = Vec3::new(0.45, 1.95, 0.85);
    let tall_block = Focus {
        center: Vec3::new(-0.34, 0.6, -0.3),
        radius: 1.1,
        irradiance: Vec3::splat(0.08),
    };
    let viewpoint = Viewpoint::around(Vec3::new(0.0, 1.0, 0.0), 1.3, Vec3::Z, 0.6);
    Scene {
        mesh,
        lamps: tall_block.lamps(wanted, light),
        viewpoint: viewpoint.changed(wanted),
        note: None,
    }
}

/// Floor, ceiling, back and side walls of the room \[−1, 1\] × \[0, 2\] × \[−1, 1\], open to +z.
fn room(mesh: &mut Mesh, white: usize, red: usize, green: usize) {
    let corner = |[x, y, z]: [f32; 3]| Vec3::new(x, y + 1.0, z);
    let walls = [
        (
            white,
            [
                [-1., -1., 1.],
                [1., -1., 1.],
                [1., -1., -1.],
                [-1., -1., -1.],
            ],
        ),
        (
            white,
            [[-1., 1., -1.], [1., 1., -1.], [1., 1., 1.], [-1., 1., 1.]],
        ),
        (
            white,
            [
                [-1., -1., -1.],
                [1., -1., -1.],
                [1., 1., -1.],
                [-1., 1., -1.],
            ],
        ),
        (
            red,
            [
                [-1., -1., 1.],
                [-1., -1., -1.],
                [-1., 1., -1.],
                [-1., 1., 1.],
            ],
        ),
        (
            green,
            [[1., -1., -1.], [1., -1., 1.], [1., 1., 1.], [1., 1., -1.]],
        ),
    ];
    for (material, corners) in walls {
        mesh.add_quad(corners.map(corner), material);
    }
}

/// A block of `size` that stands on `base`, turned about the vertical.
fn block(mesh: &mut Mesh, material: usize, base: Vec3, size: [f32; 3], angle: f32) {
    let half = 0.5 * Vec3::from(size);
    let turn = Mat3::from_rotation_y(angle);
    for (out, right) in [
        (Vec3::X, Vec3::Y),
        (Vec3::Y, Vec3::Z),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_X, Vec3::Z),
        (Vec3::NEG_Y, Vec3::X),
        (Vec3::NEG_Z, Vec3::Y),
    ] {
        let up = out.cross(right);
        let corner = |x: f32, y: f32| {
            let on_cube = out + x * right + y * up;
            base + turn * (on_cube * half + half.y * Vec3::Y)
        };
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        mesh.add_quad(corners.map(|(x, y)| corner(x, y)), material);
    }
}
