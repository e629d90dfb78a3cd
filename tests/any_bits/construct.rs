//! Every public constructor, with arguments from bits.

use std::hint::black_box;

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnisotropicSphericalGaussian, Bounded, Camera, ClusterSums,
    Conductor, ConstantLobe, DepthInterval, Dielectric, Direction, DistanceWindow, Ellipsoid,
    Fresnel, FresnelMajorant, Ggx, GgxLobe, Incidence, Interleave, LambertLobe, Lobe, LtcLobe,
    NoFresnel, Paper, PhongLobe, PixelRectangle, Proxy, Roulette, Schlick, Seed, Sphere,
    SphericalGaussian, SpotLobe, Tight, TileGrid, TileRectangle, Triaxial, Vpl, Vsgl, Xi,
    glam::{Mat3, Mat4, Vec3, Vec4},
};
use support::adversary::{Light, Tile};
use support::reference::{self, Brdf, Masking, Vector};

use crate::bits::Bits;
use crate::culling;
use crate::probe::{self, Probed};

pub fn everything(bits: &mut Bits) {
    let cameras = cameras(bits);
    for camera in &cameras {
        probe::camera(camera);
    }
    match bits.byte() % 7 {
        0 => glossy(bits, &cameras),
        1 => shapes(bits, &cameras),
        2 => fresnel(bits),
        3 => sizes(bits),
        4 => culling::everything(bits, &cameras),
        5 => foreign(bits, &cameras),
        _ => others(bits, &cameras),
    }
}

fn directions(bits: &mut Bits) -> Option<[Direction; 2]> {
    let [a, b] = [(); 2].map(|()| Direction::new(bits.vector()).ok());
    let directions = [a?, b?];
    let _ = directions.map(probe::direction);
    Some(directions)
}

fn glossy(bits: &mut Bits, cameras: &[Camera]) {
    let (Ok(ggx), Some([normal, incoming])) = (Ggx::new(bits.number()), directions(bits)) else {
        return;
    };
    let incidence = Incidence { normal, incoming };
    probe::light(LtcLobe::new(ggx, NoFresnel, incidence), cameras);
    let elements = [(); 4].map(|()| bits.number());
    if let Ok(lobe) = LtcLobe::with_matrix(elements, bits.number(), incidence) {
        probe::light(lobe, cameras);
    }
    let tag = bits.byte();
    if let Ok(schlick) = Schlick::new(bits.number()) {
        let lobe = GgxLobe::new(ggx, schlick, Incidence { normal, incoming });
        probe::ggx_lobe(&lobe, cameras);
        probe::ggx_lobe(&lobe.separable(), cameras);
    }
    if tag < 64 {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, NoFresnel, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let Ok(dielectric) = Dielectric::new(bits.number()) {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, dielectric, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let Ok(conductor) = Conductor::new(bits.number(), bits.number()) {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, conductor, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let (Ok(grain), Ok(tangent)) = (
        AnisotropicGgx::new(ggx.roughness(), bits.number()),
        Direction::new(bits.vector()),
    ) {
        if let Ok(lobe) =
            AnisotropicGgxLobe::new(grain, NoFresnel, Incidence { normal, incoming }, tangent)
        {
            probe::grained_lobe(&lobe, cameras);
        }
    }
}

fn shapes(bits: &mut Bits, cameras: &[Camera]) {
    if let Ok(sphere) = Sphere::new(bits.vector(), bits.number()) {
        sphere.probe(cameras);
    }
    let rotation = match Direction::new(bits.vector()) {
        Ok(axis) if bits.byte() < 200 => {
            let (v, w) = axis.any_orthonormal_pair();
            Mat3::from_cols(*axis, v, w)
        }
        _ => bits.matrix(),
    };
    if let Ok(ellipsoid) = Ellipsoid::new(bits.vector(), rotation, bits.vector()) {
        probe::ellipsoid(&ellipsoid, cameras);
    }
}

fn fresnel(bits: &mut Bits) {
    let _ = Schlick::new(bits.number()).map(|f| probe::fresnel(&f));
    let _ = Dielectric::new(bits.number()).map(|f| probe::fresnel(&f));
    let _ = Conductor::new(bits.number(), bits.number()).map(|f| probe::fresnel(&f));
}

fn sizes(bits: &mut Bits) {
    let image = [bits.size(), bits.size()];
    if let Ok(grid) = TileGrid::new(image, bits.size()) {
        black_box((grid.size(), grid.tiles().next()));
        let tile = [bits.size(), bits.size()];
        let PixelRectangle { min, max } = grid.pixels(tile);
        assert!((0..2).all(|i| min[i] <= max[i] && max[i] <= image[i]));
        black_box(grid.tile_of(tile));
    }
    if let Ok(interleave) = Interleave::new(image, bits.size()) {
        let pixel = [0, 1].map(|i| bits.size() % image[i]);
        let (subregion, local) = interleave.split_pixel(pixel);
        assert_eq!(interleave.join_pixel(subregion, local), pixel);
        black_box((interleave.weight(), interleave.subregion_size(subregion)));
        let light = bits.size();
        let (subregion, local) = interleave.split_light(light);
        assert_eq!(interleave.join_light(subregion, local), light);
        black_box(interleave.lights_in(subregion, light));
        let [min, max] = [(); 2].map(|()| [bits.size(), bits.size()]);
        black_box(interleave.join_pixels(bits.size(), PixelRectangle { min, max }));
    }
}

fn others(bits: &mut Bits, cameras: &[Camera]) {
    if let Some([normal, _]) = directions(bits) {
        if let Ok(lobe) = LambertLobe::new(bits.number(), normal) {
            probe::lambert_lobe(&lobe, cameras);
        }
    }
    if let Some([normal, incoming]) = directions(bits) {
        let [albedo, exponent] = [(); 2].map(|()| bits.number());
        for lobe in [
            PhongLobe::new(albedo, exponent, Incidence { normal, incoming }),
            PhongLobe::about(albedo, exponent, normal),
        ]
        .into_iter()
        .flatten()
        {
            probe::direction(lobe.axis());
            probe::saved(&lobe);
            probe::light(lobe, cameras);
        }
    }
    if let Some([axis, _]) = directions(bits) {
        if let Ok(lobe) = SpotLobe::new(bits.number(), bits.number(), axis) {
            probe::saved(&lobe);
            for lobe in [lobe, lobe.hard_edged(), lobe.with_axis(-axis)] {
                assert!((0.0..=1.0).contains(&lobe.emitted_share()));
                probe::light(lobe, cameras);
            }
        }
        if let Ok(window) = DistanceWindow::new(bits.number()) {
            probe::saved(&window);
            let scale = bits.number();
            assert!((0.0..=1.0).contains(&window.factor(bits.number().abs())));
            assert!(scale.is_nan() || window.limit(SpotLobe::PEAK, scale) <= scale);
        }
        let _ = (Vpl::point(bits.vector(), bits.number()), bits.number());
    }
    gaussians(bits, cameras);
    if let (Ok(roulette), Ok(xi)) = (Roulette::new(bits.number()), Xi::new(bits.number())) {
        probe::roulette(&roulette, xi);
        let seed = Seed(bits.word()).subregion(bits.word());
        let (frame, light) = (seed.frame(bits.word()), bits.word());
        for xi in [
            frame.xi(light),
            frame.xi_of_rank(light),
            frame.hashed_xi(light),
        ] {
            probe::roulette(&roulette, xi);
        }
    }
    if let Ok(light) = Vpl::new(bits.vector(), bits.number(), ConstantLobe) {
        assert!(!light.radiant_intensity(Vec3::Z).is_nan());
        probe::light(ConstantLobe, cameras);
    }
    black_box(TileRectangle::new(bits.pair(), bits.pair()).is_ok());
    let depths = [(); 5].map(|()| bits.number());
    if let Ok(interval) = DepthInterval::new(depths[0], depths[1]) {
        for slice in interval.exponential_slices(bits.byte().into()) {
            assert!(slice.near() <= slice.far() && slice.far() <= interval.far());
        }
        black_box(interval.exponential_slices(u32::MAX).next());
    }
    for interval in DepthInterval::modified_half_z(depths).into_iter().flatten() {
        assert!(0.0 <= interval.near() && interval.near() <= interval.far());
    }
    black_box(DepthInterval::half_z(depths));
}

fn gaussians(bits: &mut Bits, cameras: &[Camera]) {
    let Some([axis, other]) = directions(bits) else {
        return;
    };
    let [sharpness, amplitude] = [(); 2].map(|()| bits.number());
    let mean = [(); 3].map(|()| bits.number().into());
    let incidence = Incidence {
        normal: axis,
        incoming: other,
    };
    let ggx = AnisotropicGgx::new(bits.number(), bits.number());
    let anisotropic = [
        AnisotropicSphericalGaussian::new(axis, other, [bits.number(), bits.number()], amplitude),
        ggx.and_then(|ggx| AnisotropicSphericalGaussian::specular(ggx, incidence, other)),
    ];
    let lobes = [
        SphericalGaussian::new(axis, sharpness, amplitude),
        SphericalGaussian::with_integral(other, bits.number(), amplitude),
        SphericalGaussian::from_mean_direction(mean, amplitude),
        SphericalGaussian::diffuse(amplitude, axis),
        Ggx::new(bits.number())
            .and_then(|ggx| SphericalGaussian::specular(ggx, amplitude, incidence)),
    ];
    for lobe in lobes.into_iter().flatten() {
        probe::direction(lobe.sample([bits.number(), bits.number()]));
        assert!(!lobe.density(bits.vector()).is_nan());
        for other in lobes.into_iter().flatten() {
            let product = lobe.product(&other);
            assert!(product.sharpness() <= SphericalGaussian::MAX_SHARPNESS);
            assert!(product.amplitude().is_finite() && product.integral() >= 0.0);
            probe::direction(product.axis());
        }
        for other in anisotropic.into_iter().flatten() {
            assert!(other.product_integral(&lobe) >= 0.0);
            assert!(other.value(bits.vector()) >= 0.0);
            assert!(other.scaled(bits.number()).amplitude() >= 0.0);
        }
        assert!((0.0..=1.0).contains(&lobe.share_above(other)));
        if let Ok(ggx) = Ggx::new(bits.number()) {
            let seen = GgxLobe::new(ggx, NoFresnel, incidence);
            assert!(seen.product_integral(&lobe) >= 0.0);
            assert!(seen.product_integral_by_asg(&lobe) >= 0.0);
        }
        if let Ok(light) = Vsgl::new(bits.vector(), bits.number(), lobe) {
            let point = bits.vector();
            assert!(light.scalar_irradiance(point) >= 0.0);
            probe::direction(light.incoming(point).axis());
            assert!(light.incoming(point).integral() >= 0.0);
        }
        let sums = ClusterSums::of_light(
            bits.vector(),
            bits.number(),
            &lobe,
            &lobes[0].unwrap_or(lobe),
        );
        if let Ok(sums) = sums {
            let light = (sums.scaled(bits.number()) + sums).glossy();
            assert!(light.lobe().integral() >= 0.0 && light.spread() >= 0.0);
            probe::direction(light.lobe().axis());
            assert!(light.position().is_finite());
        }
        probe::saved(&lobe);
        probe::light(lobe, cameras);
    }
}

/// A Fresnel factor that keeps no promise, and places that are none: what they come to
/// means nothing, but nothing panics.
fn foreign(bits: &mut Bits, cameras: &[Camera]) {
    #[derive(Clone, Copy, Debug)]
    struct Wild([f32; 5]);
    impl Fresnel for Wild {
        fn reflectance(&self, half_angle_cosine: f32) -> f32 {
            if half_angle_cosine < self.0[0] {
                self.0[1]
            } else {
                self.0[2]
            }
        }
        fn majorant(&self) -> FresnelMajorant {
            let [.., base, rise] = self.0;
            FresnelMajorant { base, rise }
        }
    }
    let wild = Wild([(); 5].map(|()| bits.number()));
    let (Ok(ggx), Some([normal, incoming])) = (Ggx::new(bits.number()), directions(bits)) else {
        return;
    };
    let lobe = GgxLobe::new(ggx, wild, Incidence { normal, incoming });
    black_box((
        lobe.value(*normal),
        lobe.extent(incoming),
        lobe.max_reflected(),
    ));
    let (place, scale) = (bits.vector(), bits.number());
    let placed = lobe.unit_bound_by(Paper).placed(place, scale);
    black_box((placed.enclosing_sphere(), placed.sphere_at_focus()));
    let bounds = [
        lobe.unit_bound_by(Tight),
        lobe.unit_bound_by(Triaxial),
        placed.into(),
    ];
    for bound in bounds.map(|bound| bound.placed(place, scale)) {
        black_box(Proxy::Icosphere.vertices(&bound).last());
        for stretch in cameras.iter().filter_map(|camera| bound.project(camera)) {
            let tile = TileRectangle::new(bits.pair(), bits.pair());
            let depths = DepthInterval::new(bits.number(), bits.number());
            if let (Ok(tile), Ok(depths)) = (tile, depths) {
                black_box(stretch.touches_exactly(&tile, &depths));
            }
        }
    }
}

/// A camera that always is, and those that the bits make.
fn cameras(bits: &mut Bits) -> Vec<Camera> {
    let usual = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 1.0, 1.5, 0.1..100.0);
    let looking = Camera::look_at(
        bits.vector(),
        bits.vector(),
        bits.vector(),
        bits.number(),
        bits.number(),
        bits.number()..bits.number(),
    );
    let view = match &looking {
        Ok(camera) if bits.byte() < 200 => {
            let mut view = Mat4::from_mat3(camera.rotation());
            view.w_axis = bits.vector().extend(1.0);
            view
        }
        _ => bits.matrix4(),
    };
    let mut projection = Mat4::from_cols(
        Vec4::new(bits.number(), 0.0, 0.0, 0.0),
        Vec4::new(0.0, bits.number(), 0.0, 0.0),
        bits.vector().extend(1.0),
        Vec4::new(0.0, 0.0, bits.number(), 0.0),
    );
    if bits.byte() < 32 {
        projection = bits.matrix4();
    }
    let given = Camera::new(view, projection);
    [usual, looking, given].into_iter().flatten().collect()
}

/// A light with its parameters from bits, where they lie in the domain, against a tile that it
/// reaches.
pub fn light_in_domain(bits: &mut Bits) {
    let (roughness, albedo, f0) = (bits.number(), bits.number(), bits.number());
    let (eta, kappa) = (bits.number(), bits.number());
    let fresnel = match bits.byte() % 6 {
        0 if Schlick::new(f0).is_ok() => reference::Fresnel::Schlick(f0),
        1 if Dielectric::new(eta).is_ok() => reference::Fresnel::Dielectric(eta),
        2 if Conductor::new(eta, kappa).is_ok() => reference::Fresnel::Conductor(eta, kappa),
        _ => reference::Fresnel::None,
    };
    let masking = if bits.byte() < 128 {
        Masking::HeightCorrelated
    } else {
        Masking::Separable
    };
    let brdf = match bits.byte() % 8 {
        0 if LambertLobe::new(albedo, Direction::Z).is_ok() => Brdf::Lambert { albedo },
        1 => Brdf::Constant,
        2 if SpotLobe::new(roughness, albedo, Direction::Z).is_ok() => {
            Brdf::spot([roughness, albedo])
        }
        2..5 => {
            let [along, across] = [roughness, bits.number()];
            let Ok(tangent) = Direction::new(bits.vector()) else {
                return;
            };
            if AnisotropicGgx::new(along, across).is_err() {
                return;
            }
            Brdf::Anisotropic {
                roughness: [along, across],
                tangent,
                fresnel,
                masking,
            }
        }
        5 => {
            // As the exact model needs it.
            let exponent = (16.0 * bits.number()).round() / 16.0;
            if PhongLobe::new(
                albedo,
                exponent,
                Incidence {
                    normal: Direction::Z,
                    incoming: Direction::Z,
                },
            )
            .is_err()
            {
                return;
            }
            Brdf::Phong { albedo, exponent }
        }
        6 => {
            let [amplitude, sharpness] = [albedo, bits.number()];
            if SphericalGaussian::new(Direction::Z, sharpness, amplitude).is_err() {
                return;
            }
            Brdf::SphericalGaussian {
                amplitude,
                sharpness,
            }
        }
        _ if Ggx::new(roughness).is_ok() => Brdf::Ggx {
            roughness,
            fresnel,
            masking,
        },
        _ => return,
    };
    let Some([normal, incoming]) = directions(bits) else {
        return;
    };
    let light = Light {
        brdf: brdf.laid_on(Vector::from(*normal)),
        normal,
        incoming,
        position: bits.vector(),
        flux: bits.number(),
        delta: bits.number(),
        xi: bits.number(),
    };
    let valid = light.position.is_finite()
        && light.flux.is_finite()
        && light.flux >= 0.0
        && Roulette::new(light.delta).is_ok()
        && Xi::new(light.xi).is_ok();
    if !valid {
        return;
    }
    let range = light.reach(light.peak().unit()).hi();
    let distance = Vector::from(light.position).length();
    if !(1e-12..1e12).contains(&range) || distance > 1e6 * range {
        return;
    }
    let bound = light.bound();
    let mut rng = Rng::with_seed(bits.seed());
    for _ in 0..8 {
        if let Some(tile) = Tile::draw(&mut rng, &light) {
            let lost = bound.that_lose_exactly(&tile);
            assert!(lost.is_empty(), "{lost:?} of {light:?} in {tile:?}");
        }
    }
}
