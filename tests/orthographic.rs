//! Tiles of an orthographic view are boxes: a light is found in those that it touches, in few others, and in several
//! views a frame without any memory of their own.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Camera, ConstantLobe, Culler, DepthInterval, Error, LightBatch, LightLists,
    Orthographic, PixelRectangle, ProjectedSphere, Projection, Roulette, Seed, Sphere, TileDepths,
    TileGrid, TileRectangle, Vpl,
    glam::{DMat3, DVec3, Vec3},
};
use support::generators;
use support::reference::camera::View;

/// By how much a tile misses, in radii of the unit sphere: below 1 it is touched, above 1 it is not.
fn miss(matrix: DMat3, center: DVec3, tile: &TileRectangle, depths: &DepthInterval) -> f64 {
    let low = tile.min().extend(depths.near()).as_dvec3();
    let high = tile.max().extend(depths.far()).as_dvec3();
    let inverse = matrix.inverse();
    let (middle, rows) = (inverse * center, inverse.transpose());
    let reach = DVec3::new(
        rows.x_axis.length(),
        rows.y_axis.length(),
        rows.z_axis.length(),
    );
    let apart = ((low - middle).max(middle - high) / reach).max_element();
    if apart > 1.0 {
        return apart;
    }
    // The part of the tile within the bounds of the shape, after M.
    let (low, high) = (low.max(middle - reach), high.min(middle + reach));
    let images = (0..8).map(|corner| {
        let end = |axis: usize| [low, high][corner >> axis & 1][axis];
        matrix * DVec3::new(end(0), end(1), end(2))
    });
    let (low, high) = images.fold((DVec3::MAX, DVec3::MIN), |(low, high), image| {
        (low.min(image), high.max(image))
    });
    apart.max(center.distance(center.clamp(low, high)))
}

/// Of 64×64 tiles, and depths about that of the shape, in shares of the view's depth.
fn tile(
    camera: &Camera<Orthographic>,
    (x, y): (u32, u32),
    depth: f64,
    [before, behind]: [f64; 2],
) -> (TileRectangle, DepthInterval) {
    let pixels = PixelRectangle {
        min: [x, y],
        max: [x + 1, y + 1],
    };
    let [near, far] = [depth * (1.0 - before), depth * (1.0 + behind)].map(|depth| depth as f32);
    let depths = DepthInterval::new(near.min(far).max(0.0), far.max(near).max(0.0));
    (
        camera.tile_rectangle([64, 64], pixels),
        depths.expect("in order"),
    )
}

fn camera(view: &View) -> Camera<Orthographic> {
    Camera::orthographic(view.from_world, view.projection).unwrap()
}

proptest! {
    #![proptest_config(generators::cases(4000))]

    /// The test in f64 on the same M decides the same, but for a rim of rounding.
    #[test]
    fn test_is_no_looser_than_its_bounds_and_its_box(
        ellipsoid in generators::ellipsoid(),
        view in generators::orthographic_view(),
        depth in 0.1..3.0,
        position in (0..64_u32, 0..64_u32),
        room in prop::array::uniform2(-0.3..0.3),
    ) {
        let depth = depth / f64::from(view.projection.z_axis.z).abs();
        let view = view.aimed_at(ellipsoid.center(), depth);
        let camera = camera(&view);
        let (rectangle, interval) = tile(&camera, position, depth, room);
        let stretch = ellipsoid.project(&camera).unwrap();
        let exact = miss(stretch.matrix().as_dmat3(), stretch.center().as_dvec3(), &rectangle, &interval);
        let touched = stretch.touches(&rectangle, &interval);
        let rim = 1e-4 * (1.0 + exact + f64::from(stretch.center().length()));
        prop_assert!(touched || exact > 1.0 - rim, "rejected at {exact}");
        prop_assert!(!touched || exact < 1.0 + rim, "accepted at {exact}");
    }

    /// The distance of a sphere from a box decides.
    #[test]
    fn test_of_a_sphere_is_exact(
        center in generators::position(),
        radius in generators::log_uniform(1e-3, 1e3),
        view in generators::orthographic_view(),
        depth in 0.1..3.0,
        position in (0..64_u32, 0..64_u32),
        room in prop::array::uniform2(-0.3..0.3),
    ) {
        let depth = depth / f64::from(view.projection.z_axis.z).abs();
        let view = view.aimed_at(center, depth);
        let camera = camera(&view);
        let (rectangle, interval) = tile(&camera, position, depth, room);
        let sphere = Sphere::new(center, radius as f32).unwrap().project(&camera).unwrap();
        let low = rectangle.min().extend(interval.near()).as_dvec3();
        let high = rectangle.max().extend(interval.far()).as_dvec3();
        let middle = sphere.center().as_dvec3();
        let distance = middle.distance(middle.clamp(low, high));
        let radius = f64::from(sphere.radius_squared()).sqrt();
        let rim = 1e-6 * (radius + distance + middle.length());
        for touched in [sphere.touches(&rectangle, &interval), sphere.touches_exactly(&rectangle, &interval)] {
            prop_assert!(touched || distance > radius - rim, "rejected at {distance} of {radius}");
            prop_assert!(!touched || distance < radius + rim, "accepted at {distance} of {radius}");
        }
    }
}

/// What views of one kind share.
struct Shared<P: Projection> {
    batch: LightBatch<ProjectedSphere<P>>,
    culler: Culler<ProjectedSphere<P>>,
}

impl<P: Projection> Shared<P> {
    fn new() -> Self {
        Self {
            batch: LightBatch::new(),
            culler: Culler::new(),
        }
    }

    fn cull(
        &mut self,
        camera: &Camera<P>,
        lights: &[Vpl<ConstantLobe>],
        (grid, tiles, lists): &mut (TileGrid, TileDepths, LightLists),
        frame: u32,
    ) -> Result<(), Error> {
        let [near, far] = [0.02, 0.98].map(|value| camera.depth(value));
        let slices = DepthInterval::new(near, far)?.uniform_slices(4);
        tiles.set_view(grid, camera)?;
        for tile in grid.tiles() {
            tiles.set(tile, slices.clone());
        }
        // The same ξ in all views.
        let seed = Seed(1).frame(frame);
        let with_xi = (0..).zip(lights).map(|(i, light)| (i, light, seed.xi(i)));
        self.batch.clear();
        BatchBuilder::new(&Roulette::new(0.05)?, camera).add(with_xi, &mut self.batch);
        self.culler.cull(&self.batch, tiles, lists)?;
        Ok(())
    }
}

/// Four faces of a cube and three cascades, in two batches and two cullers, jittered.
#[test]
fn several_views_allocate_nothing_after_the_first_frame() -> Result<(), Error> {
    let lights = (0..900)
        .map(|i| Vpl::point(Vec3::new((i % 30) as f32, 1.0, (i / 30) as f32), 1.0))
        .collect::<Result<Vec<_>, _>>()?;
    let (eye, size) = (Vec3::new(15.0, 2.0, 15.0), [480, 480]);
    let mut faces = Vec::new();
    for ahead in [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z] {
        let right_angle = std::f32::consts::FRAC_PI_2;
        let camera = Camera::look_at(eye, eye + ahead, Vec3::Y, right_angle, 1.0, 0.1..100.0)?;
        faces.push(camera);
    }
    let mut cascades = Vec::new();
    for height in [5.0, 10.0, 20.0] {
        let down = eye + Vec3::NEG_Y;
        cascades.push(Camera::orthographic_look_at(
            eye,
            down,
            Vec3::Z,
            height,
            1.0,
            -9.0..9.0,
        )?);
    }
    let grid = TileGrid::new(size, 16)?;
    let kept = |tiles| (grid, tiles, LightLists::new());
    let mut of_faces = Vec::new();
    for camera in &faces {
        of_faces.push(kept(TileDepths::new(&grid, camera, 4)?));
    }
    let mut of_cascades = Vec::new();
    for camera in &cascades {
        of_cascades.push(kept(TileDepths::new(&grid, camera, 4)?));
    }
    let (mut to_faces, mut to_cascades) = (Shared::new(), Shared::new());
    let mut draw = |frame: u32| -> Result<(), Error> {
        let jitter = [
            0.5 - (frame % 5) as f32 / 5.0,
            (frame % 3) as f32 / 3.0 - 0.5,
        ];
        for (camera, view) in faces.iter().zip(&mut of_faces) {
            to_faces.cull(&camera.jittered(size, jitter)?, &lights, view, frame)?;
        }
        for (camera, view) in cascades.iter().zip(&mut of_cascades) {
            to_cascades.cull(&camera.jittered(size, jitter)?, &lights, view, frame)?;
        }
        Ok(())
    };
    let first = allocation_counter::measure(|| draw(0).expect("in range"));
    assert!(first.count_total > 0, "nothing is counted");
    for frame in 1..10 {
        let later = allocation_counter::measure(|| draw(frame).expect("in range"));
        assert_eq!(later.count_total, 0, "frame {frame}");
    }
    assert!(of_cascades.iter().all(|(.., lists)| !lists.is_empty()));
    assert!(of_faces.iter().all(|(.., lists)| !lists.is_empty()));
    Ok(())
}
