//! What must hold of everything that a constructor has accepted.

use std::hint::black_box;

use stochastic_light_culling::{
    AnisotropicGgxLobe, AnyCamera, Bounded, Camera, Cap, DepthInterval, Direction, Ellipsoid,
    Fresnel, GgxLobe, GpuEllipsoid, GpuSphere, HalfSpace, LambertLobe, Lobe, MaskingShadowing,
    PixelRectangle, Projection, Proxy, Roulette, Shape, Sphere, Spheroid, Tight, TileRectangle,
    TileTest, Triaxial, Vpl, Xi,
    glam::{Mat3, Vec2, Vec3},
    stretch_matrix, stretch_rotation,
};
use support::with_camera;

const IMAGE: [u32; 2] = [640, 480];

/// Where shapes are put and by how much they are scaled: the ends of `f32`, and between.
pub const PLACES: [Vec3; 4] = [
    Vec3::ZERO,
    Vec3::new(1.0, -2.0, 3.0),
    Vec3::splat(1e-45),
    Vec3::new(f32::MAX, f32::MIN, 1e30),
];
pub const SCALES: [f32; 6] = [0.0, 1e-45, f32::MIN_POSITIVE, 1.0, 1e30, f32::MAX];

#[track_caller]
fn number(x: f32) {
    assert!(!x.is_nan());
}

#[track_caller]
fn vector(v: Vec3) {
    assert!(!v.is_nan(), "{v}");
}

#[track_caller]
fn matrix(m: Mat3) {
    assert!(!m.is_nan(), "{m}");
}

/// What a lobe's bound is, and how to look into it.
pub trait Probed: Shape + std::fmt::Debug {
    fn probe(&self, cameras: &[AnyCamera]);
}

impl Probed for Sphere {
    fn probe(&self, cameras: &[AnyCamera]) {
        vector(self.center());
        number(self.radius());
        for camera in cameras {
            with_camera!(camera, camera => if let Some(test) = self.project(camera) {
                vector(test.center());
                number(test.radius_squared());
                black_box(bytemuck::bytes_of(&GpuSphere::from(&test)));
                touching(&test, camera);
            });
        }
    }
}

impl Probed for Ellipsoid {
    fn probe(&self, cameras: &[AnyCamera]) {
        ellipsoid(self, cameras);
    }
}

impl Probed for Spheroid {
    fn probe(&self, cameras: &[AnyCamera]) {
        vector(self.focus());
        direction(self.axis());
        number(self.radius());
        number(self.long_semi_axis());
        self.sphere_at_focus().probe(cameras);
        self.enclosing_sphere().probe(cameras);
        ellipsoid(&Ellipsoid::from(*self), cameras);
    }
}

pub fn ellipsoid(ellipsoid: &Ellipsoid, cameras: &[AnyCamera]) {
    vector(ellipsoid.center());
    matrix(ellipsoid.rotation());
    vector(ellipsoid.semi_axes());
    for proxy in [Proxy::Icosahedron, Proxy::Icosphere] {
        proxy
            .vertices(ellipsoid)
            .for_each(|vertex| assert!(vertex.is_finite(), "{vertex}"));
    }
    for camera in cameras {
        with_camera!(camera, camera => {
            if let Some(test) = ellipsoid.project(camera) {
                matrix(test.matrix());
                vector(test.center());
                black_box(bytemuck::bytes_of(&GpuEllipsoid::new(&test, 7)));
                touching(&test, camera);
            }
            black_box(stretch_rotation(stretch_matrix(ellipsoid, camera)));
        });
    }
}

/// Tile tests do not panic, whatever the tile.
fn touching<P: Projection>(test: &impl TileTest, camera: &Camera<P>) {
    let all = PixelRectangle {
        min: [0; 2],
        max: IMAGE,
    };
    let rectangles = [
        Some(camera.tile_rectangle(IMAGE, all)),
        TileRectangle::new(Vec2::splat(-1e12), Vec2::splat(1e12)).ok(),
        TileRectangle::new(Vec2::splat(1e-45), Vec2::splat(1e-45)).ok(),
    ];
    let depths = [(0.0, 0.0), (0.0, f32::MAX), (1e-45, 1e-45), (1.0, 2.0)];
    for rectangle in rectangles.into_iter().flatten() {
        for (near, far) in depths {
            let depths = DepthInterval::new(near, far).expect("in order");
            black_box(test.touches_exactly(&rectangle, &depths));
        }
    }
}

pub fn direction(direction: Direction) {
    vector(*direction);
    assert!((direction.length() - 1.0).abs() < 1e-6, "{direction:?}");
    vector(*-direction);
}

pub fn fresnel(fresnel: &impl Fresnel) {
    for cosine in [0.0, 1e-45, 1e-20, 1e-7, 0.1, 0.5, 0.99, 1.0 - 6e-8, 1.0] {
        for factor in [fresnel.reflectance(cosine), fresnel.maximum(cosine)] {
            assert!((0.0..=1.0).contains(&factor), "{factor} at {cosine}");
        }
    }
    let majorant = fresnel.majorant();
    assert!(
        majorant.base >= 1e-30 && majorant.rise >= 0.0,
        "{majorant:?}"
    );
}

/// What is saved is what is read.
pub fn saved<T>(value: &T)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let text = serde_json::to_string(value).expect("made of plain numbers");
    let read: T = serde_json::from_str(&text).expect("of what a constructor has accepted");
    assert_eq!(&read, value, "{text}");
}

pub fn ggx_lobe<F, G>(lobe: &GgxLobe<F, G>, cameras: &[AnyCamera])
where
    F: Fresnel + std::fmt::Debug + PartialEq + serde::Serialize + serde::de::DeserializeOwned,
    G: MaskingShadowing + std::fmt::Debug + PartialEq,
{
    saved(lobe);
    assert!((0.0..=1.0).contains(&lobe.incident_cosine()));
    assert!((0.0..=1.0).contains(&lobe.max_fresnel()));
    assert!((0.0..=1.0).contains(&lobe.max_reflected()));
    for towards in [lobe.normal(), lobe.mirror_direction(), -lobe.incoming()] {
        number(lobe.extent(towards));
    }
    direction(lobe.mirror_direction());
    matrix(lobe.rotation());
    let away = *lobe.mirror_direction();
    values(lobe, &[away, -away]);
    light(*lobe, cameras);
    ellipsoid(&lobe.unit_bound_by(Triaxial), cameras);
    everywhere(&lobe.unit_bound_by(Tight), cameras);
}

pub fn lambert_lobe(lobe: &LambertLobe, cameras: &[AnyCamera]) {
    saved(lobe);
    light(*lobe, cameras);
    everywhere(&lobe.unit_bound_by(Tight), cameras);
}

fn everywhere(bound: &impl Probed, cameras: &[AnyCamera]) {
    bound.probe(cameras);
    for position in PLACES {
        for scale in SCALES {
            bound.placed(position, scale).probe(cameras);
        }
    }
}

pub fn grained_lobe<F>(lobe: &AnisotropicGgxLobe<F>, cameras: &[AnyCamera])
where
    F: Fresnel + std::fmt::Debug + PartialEq + serde::Serialize + serde::de::DeserializeOwned,
{
    saved(lobe);
    let away = *lobe.mirror_direction();
    for direction in PLACES.into_iter().chain([away, Vec3::NAN]) {
        number(lobe.ggx().ndf(direction));
        number(lobe.ggx().masking(direction));
    }
    values(lobe, &[away, -away]);
    values(&lobe.separable(), &[away, -away]);
    light(*lobe, cameras);
    light(lobe.separable(), cameras);
}

/// A lobe's light, from the dimmest to the brightest.
pub fn light<L: Bounded<Shape: Probed> + std::fmt::Debug + Copy>(lobe: L, cameras: &[AnyCamera]) {
    values(&lobe, &[]);
    everywhere(&lobe.unit_bound(), cameras);
    for position in PLACES {
        for flux in [0.0, 1e-45, 1.0, f32::MAX] {
            let light = Vpl::new(position, flux, lobe).expect("finite");
            for delta in [1e-45, 1.0, f32::MAX] {
                let roulette = Roulette::new(delta).expect("positive");
                let xi = Xi::new(1e-45).expect("positive");
                light.bound(&roulette, xi).probe(cameras);
            }
            number(light.radiant_intensity(Vec3::Z));
        }
    }
}

fn values(lobe: &impl Lobe, more: &[Vec3]) {
    let axes = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let grazing = [Vec3::new(1.0, 1e-45, 0.0), Vec3::new(0.6, 0.0, 0.8)];
    for outgoing in axes.chain(grazing).chain(more.iter().copied()) {
        let value = lobe.value(outgoing);
        assert!(value.is_finite() && value >= 0.0, "{value} to {outgoing}");
        let axis = Direction::new(outgoing).expect("not zero");
        for chord in [0.0, 1e-45, 1e-3, 2.0] {
            let most = lobe.maximum_within(&Cap::new(axis, chord).expect("in range"));
            // The lobe's own rounding.
            assert!(value * 0.999 <= most, "{value} above {most} to {outgoing}");
        }
    }
}

pub fn roulette(roulette: &Roulette, xi: Xi) {
    for intensity in [0.0, 1e-45, 1.0, f32::MAX] {
        number(roulette.scale(intensity, xi));
        number(roulette.radius(intensity, xi));
        for squared in [1e-45, 1.0, f32::MAX] {
            let probability = roulette.probability(intensity, squared);
            assert!((0.0..=1.0).contains(&probability), "{probability}");
            number(roulette.estimate(intensity, squared, xi));
            number(roulette.weight(intensity, squared, xi));
        }
    }
}

pub fn any_camera(camera: &AnyCamera) {
    with_camera!(camera, camera => self::camera(camera));
}

pub fn camera<P: Projection>(camera: &Camera<P>)
where
    Camera<P>: serde::Serialize + serde::de::DeserializeOwned,
{
    saved(camera);
    for pixels in [[0.5, -0.25], [f32::MAX, 1e-45]] {
        if let Ok(camera) = camera.jittered(IMAGE, pixels) {
            vector(camera.point_in_pixel(IMAGE, [0, 479], 1.0));
        }
    }
    for position in PLACES {
        touching(
            &HalfSpace::new(position, Direction::Z)
                .unwrap()
                .project(camera),
            camera,
        );
    }
    matrix(camera.rotation());
    for point in PLACES {
        vector(camera.to_camera_space(point));
    }
    if camera.to_camera_space(Vec3::ZERO).abs().max_element() < 1e38 {
        for point in &PLACES[..3] {
            vector(camera.to_world_space(*point));
        }
    }
    for depth in [0.0, 0.5, 1.0] {
        number(camera.depth(depth));
    }
    for pixel in [[0, 0], [320, 11], [639, 479]] {
        vector(camera.point_in_pixel(IMAGE, pixel, 2.0));
        let max = pixel.map(|n| n + 1);
        let tile = camera.tile_rectangle(IMAGE, PixelRectangle { min: pixel, max });
        vector(tile.min().extend(0.0));
        vector(tile.max().extend(0.0));
    }
}
