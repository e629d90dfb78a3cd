//! The built-in ring: a gold band on a floor, lit from the side so that its inside focuses light.

use std::f32::consts::{FRAC_PI_2, TAU};

use stochastic_light_culling::glam::{Vec2, Vec3};

use super::mesh::{Material, Mesh, Triangle};
use super::{Focus, Scene, Viewpoint, Wanted};

const INNER_RADIUS: f32 = 1.0;
const THICKNESS: f32 = 0.12;
const HEIGHT: f32 = 0.55;
const EDGE_RADIUS: f32 = 0.015;
/// How many straight pieces the band is made of, and each rounded edge of its profile.
const PIECES: usize = 256;
const EDGE_PIECES: usize = 6;

pub fn scene(wanted: &Wanted) -> Scene {
    let mut mesh = Mesh::default();
    let floor = mesh.add_material(Material::diffuse(Vec3::new(0.62, 0.6, 0.58)));
    let gold = mesh.add_material(Material::metal(Vec3::new(1.0, 0.78, 0.37)));
    let corner = |x: f32, z: f32| Vec3::new(20.0 * x, 0.0, 20.0 * z);
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    mesh.add_quad(corners.map(|(x, z)| corner(x, z)), floor);
    mesh.triangles.extend(band(gold));

    let focus = Focus {
        center: Vec3::new(0.0, 0.5 * HEIGHT, 0.0),
        radius: 1.15,
        irradiance: Vec3::splat(0.05),
    };
    let light = Vec3::new(4.6, 4.4, 2.4);
    let to_eye = Vec3::new(0.0, 0.8, 0.6);
    let viewpoint = Viewpoint::around(Vec3::new(0.0, 0.1, 0.0), 1.5, to_eye, 0.6);
    Scene {
        mesh,
        lamps: focus.lamps(wanted, light),
        viewpoint: viewpoint.changed(wanted),
        note: None,
    }
}

/// The band: its profile, turned about the y axis.
fn band(material: usize) -> Vec<Triangle> {
    let profile = profile();
    let mut triangles = Vec::new();
    for piece in 0..PIECES {
        let angles = [piece, piece + 1].map(|i| TAU * (i % PIECES) as f32 / PIECES as f32);
        for (i, near) in profile.iter().enumerate() {
            let far = &profile[(i + 1) % profile.len()];
            // Corners a, b along the profile at the first angle, c, d at the second.
            let [a, c] = angles.map(|angle| turned(near, angle));
            let [b, d] = angles.map(|angle| turned(far, angle));
            for [p, q, r] in [[a, b, d], [a, d, c]] {
                triangles.push(Triangle {
                    corners: [p.0, q.0, r.0],
                    normals: [p.1, q.1, r.1],
                    material,
                });
            }
        }
    }
    triangles
}

/// The outline of the band, a rectangle with rounded edges: points (distance from the axis, height)
/// and normals.
fn profile() -> Vec<(Vec2, Vec2)> {
    let (inner, outer) = (
        INNER_RADIUS + EDGE_RADIUS,
        INNER_RADIUS + THICKNESS - EDGE_RADIUS,
    );
    let (low, high) = (EDGE_RADIUS, HEIGHT - EDGE_RADIUS);
    let edges = [(outer, high), (inner, high), (inner, low), (outer, low)];
    let mut points = Vec::new();
    for (i, (x, y)) in edges.into_iter().enumerate() {
        for piece in 0..=EDGE_PIECES {
            let angle = FRAC_PI_2 * (i as f32 + piece as f32 / EDGE_PIECES as f32);
            let normal = Vec2::from_angle(angle);
            points.push((Vec2::new(x, y) + EDGE_RADIUS * normal, normal));
        }
    }
    points
}

fn turned((point, normal): &(Vec2, Vec2), angle: f32) -> (Vec3, Vec3) {
    let (sine, cosine) = angle.sin_cos();
    let turn = |v: &Vec2| Vec3::new(v.x * cosine, v.y, v.x * sine);
    (turn(point), turn(normal))
}
