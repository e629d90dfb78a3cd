//! Lobes other than GGX, of any numbers.

use std::hint::black_box;

use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicSphericalGaussian, AnyCamera, Bounded, ClusterSums, ConstantLobe,
    DepthInterval, DistanceWindow, EvenNoise, FilteredSampling, Fresnel, FresnelMajorant, Ggx,
    GgxLobe, Incidence, LambertLobe, Lobe, MipPyramid, NoFresnel, Paper, PhongLobe, Proxy,
    RadianceEstimator, Roulette, Seed, ShadedPoint, ShadingBatch, SphericalGaussian, SpotLobe,
    Tight, TileRectangle, Triaxial, Vpl, Vsgl, Xi, glam::Vec3,
};
use support::with_camera;

use crate::bits::Bits;
use crate::construct::directions;
use crate::probe;

pub fn others(bits: &mut Bits, cameras: &[AnyCamera]) {
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
            let cut = lobe.unit_bound_cut_at(bits.number());
            assert!(cut.is_empty() == lobe.is_empty() && !cut.semi_axes().is_nan());
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
        let even = EvenNoise::new(bits.number());
        if let Ok(even) = even.and_then(|even| even.with_range(bits.number(), bits.number())) {
            probe::saved(&even);
            let (scale, [least, most]) = (even.delta_scale(bits.number()), even.range());
            assert!(least <= scale && scale <= most, "{scale}");
        }
        let mut radiances = [(); 4].map(|()| bits.number());
        if let Ok(even) = EvenNoise::of_tiles(&mut radiances) {
            probe::saved(&even);
            let [least, most] = even.range();
            assert!(even.typical().is_normal() && (1.0 / 4096.0..=1.0).contains(&least));
            assert_eq!(most, 64.0);
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

fn gaussians(bits: &mut Bits, cameras: &[AnyCamera]) {
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
            cluster(bits, &light, cameras);
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
            map(bits, sums);
        }
        probe::saved(&lobe);
        probe::light(lobe, cameras);
    }
}

/// A cluster, bounded and evaluated.
fn cluster(bits: &mut Bits, light: &Vsgl, cameras: &[AnyCamera]) {
    let (Ok(roulette), Ok(xi)) = (Roulette::new(bits.number()), Xi::new(bits.number())) else {
        return;
    };
    probe::ellipsoid(&light.bound(&roulette, xi), cameras);
    let mut batch = ShadingBatch::new();
    batch.push_vsgl(light, xi);
    let (position, normal) = (bits.vector(), bits.vector());
    let points = [
        ShadedPoint { position, normal },
        light.position().into(),
        Vec3::ZERO.into(),
    ];
    let lists = points.iter().map(|point| (*point, &[0][..]));
    RadianceEstimator::new(&roulette).at_points(&batch, lists, |_, estimate| {
        assert!(estimate.radiance > 0.0 && estimate.sharpness >= 0.0);
        probe::direction(estimate.incoming().axis());
        assert!(estimate.incoming().integral() >= 0.0);
    });
}

/// A map with the light in some of its texels, and clusters of it.
fn map(bits: &mut Bits, light: ClusterSums) {
    let size = [bits.byte(), bits.byte()].map(|side| u32::from(side % 6));
    let mut texels = [ClusterSums::EMPTY; 60];
    texels[usize::from(bits.byte()) % 25] = light;
    let numbers = [bits.number(), bits.number()];
    let sampling = FilteredSampling::new(u32::from(bits.byte()), bits.number());
    if let (Ok(map), Ok(sampling)) = (MipPyramid::build(size, &mut texels), sampling) {
        black_box(map.sum_at(numbers, bits.number()).glossy());
        if let Some(sample) = map.sample(&sampling, numbers) {
            let cluster = map.cluster(&sample).glossy();
            assert!(cluster.lobe().integral() >= 0.0 && cluster.spread() >= 0.0);
            assert!(sample.level >= 0.0 && sample.texels >= 0.0);
        }
    }
}

/// A Fresnel factor that keeps no promise, and places that are none: what they come to
/// means nothing, but nothing panics.
pub fn foreign(bits: &mut Bits, cameras: &[AnyCamera]) {
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
        for camera in cameras {
            let tile = TileRectangle::new(bits.pair(), bits.pair());
            let depths = DepthInterval::new(bits.number(), bits.number());
            if let (Ok(tile), Ok(depths)) = (tile, depths) {
                black_box(with_camera!(camera, camera => {
                    bound.project(camera).map(|test| test.touches_exactly(&tile, &depths))
                }));
            }
        }
    }
}
