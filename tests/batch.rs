//! Lights that are made ready sixteen at a time are, bit by bit, those made ready one by one.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, BatchBuilder, BoundStrategy, Bounded, Camera, ConstantLobe,
    Dielectric, Direction, Ellipsoid, Focal, Fresnel, Ggx, GgxLobe, LambertLobe, LightBatch, Lobe,
    LtcLobe, MaskingShadowing, NoFresnel, Orthographic, OwnBound, Paper, PhongLobe, Project,
    Projected, Projection, Roulette, Schlick, Seed, Sphere, SphericalGaussian, Spheroid, SpotLobe,
    Tight, Triaxial, Vpl, Xi, glam::Vec3,
};
use support::{
    generators::{self, cases, log_uniform},
    parts::{Coat, Parts, Windowed, parts},
    reference::MaskedAlone,
};

#[derive(Clone, Debug)]
struct Frame {
    roulette: Roulette,
    camera: Camera,
    parallel: Camera<Orthographic>,
    lights: Vec<Parts>,
    /// How many of the lights are added first, before the others.
    first: usize,
}

fn frame() -> impl Strategy<Value = Frame> {
    let delta = prop_oneof![
        10 => log_uniform(1e-6, 1e3).prop_map(|x| x as f32),
        2 => log_uniform(1e-45, 1e-6).prop_map(|x| x as f32),
        1 => Just(f32::from_bits(1)),
        1 => Just(f32::MAX),
    ];
    let lights = prop::collection::vec(parts(), 0..150);
    let views = (generators::view(), generators::orthographic_view());
    (delta, views, lights, 0..150_usize).prop_map(|(delta, (view, parallel), lights, first)| {
        let parallel = Camera::orthographic(parallel.from_world, parallel.projection);
        Frame {
            roulette: Roulette::new(delta).unwrap(),
            camera: Camera::new(view.from_world, view.projection).unwrap(),
            parallel: parallel.unwrap(),
            first: first.min(lights.len()),
            lights,
        }
    })
}

/// All fields of a shape, bounds included, such that different bits are different.
fn bits(shape: &impl Projected) -> String {
    format!("{shape:?}")
}

impl Frame {
    /// Whether `add` adds to a batch, of the lights in two parts, the shapes that are `expected`: `None`
    /// for a light that reaches nowhere.
    fn same<P: Projection, T: Projected>(
        &self,
        camera: &Camera<P>,
        expected: &[Option<T>],
        add: impl Fn(&BatchBuilder<P>, std::ops::Range<usize>, &mut LightBatch<T>),
    ) -> Result<(), TestCaseError> {
        let expected: Vec<_> = (0..)
            .zip(expected)
            .filter_map(|(number, shape)| Some((number, bits(shape.as_ref()?))))
            .collect();
        for lanes in [16, 8, 4] {
            let builder = BatchBuilder::new(&self.roulette, camera).with_lanes(lanes);
            let mut batch = LightBatch::new();
            // Twice, for what the first leaves behind.
            for _ in 0..2 {
                batch.clear();
                add(&builder, 0..self.first, &mut batch);
                add(&builder, self.first..self.lights.len(), &mut batch);
                let found = batch.iter().map(|(number, shape)| (number, bits(&shape)));
                prop_assert_eq!(&found.collect::<Vec<_>>(), &expected);
                prop_assert_eq!(batch.len(), expected.len());
            }
        }
        Ok(())
    }

    /// Whether a batch holds the shapes that each light has by itself, bounded by `strategy`.
    fn same_lights<L, B>(
        &self,
        strategy: B,
        lobe: impl Fn(&Parts) -> L,
    ) -> Result<(), TestCaseError>
    where
        L: Lobe + 'static,
        B: BoundStrategy<L, Shape: Project>,
    {
        self.same_lights_in(&self.camera, strategy, lobe)
    }

    fn same_lights_in<P: Projection, L, B>(
        &self,
        camera: &Camera<P>,
        strategy: B,
        lobe: impl Fn(&Parts) -> L,
    ) -> Result<(), TestCaseError>
    where
        L: Lobe + 'static,
        B: BoundStrategy<L, Shape: Project>,
    {
        let lights: Vec<_> = self.lights.iter().map(|p| p.vpl(lobe(p))).collect();
        let expected: Vec<_> = lights
            .iter()
            .map(|(light, xi)| light.bound_by(strategy, &self.roulette, *xi))
            .map(|bound| Project::project(&bound, camera))
            .collect();
        self.same(camera, &expected, |builder, range, batch| {
            let indexed = (range.start as u32..).zip(&lights[range]);
            let lights = indexed.map(|(i, (light, xi))| (i, light, *xi));
            builder.add_by(strategy, lights, batch);
        })
    }

    fn same_ggx<F: Fresnel, G: MaskingShadowing>(
        &self,
        lobe: impl Fn(&Parts) -> GgxLobe<F, G> + Copy,
    ) -> Result<(), TestCaseError> {
        self.same_lights(Paper, lobe)?;
        self.same_lights(Triaxial, lobe)?;
        self.same_lights(Tight, lobe)?;
        self.same_lights(OwnBound, lobe)
    }

    /// Of bounds that are kept, before cameras of both projections.
    fn same_placed<B: Project + 'static>(&self, bounds: &[B]) -> Result<(), TestCaseError> {
        self.same_placed_in(&self.camera, bounds)?;
        self.same_placed_in(&self.parallel, bounds)
    }

    fn same_placed_in<P: Projection, B: Project + 'static>(
        &self,
        camera: &Camera<P>,
        bounds: &[B],
    ) -> Result<(), TestCaseError> {
        let scale = |light: &Parts| self.roulette.scale(light.flux, light.xi);
        let placed = self.lights.iter().zip(bounds);
        let expected: Vec<_> = placed
            .map(|(light, bound)| bound.placed(light.position, scale(light)))
            .map(|bound| Project::project(&bound, camera))
            .collect();
        self.same(camera, &expected, |builder, range, batch| {
            let placed = (range.start as u32..).zip(&self.lights[range.clone()]);
            let placed = placed.zip(&bounds[range]);
            let placed =
                placed.map(|((index, light), bound)| (index, bound, light.position, scale(light)));
            builder.add_placed(placed, batch);
        })
    }
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn glossy_lights(frame in frame()) {
        frame.same_ggx(|light| light.ggx(NoFresnel))?;
        frame.same_ggx(|light| light.ggx(Schlick::new(light.share).unwrap()))?;
        frame.same_ggx(|light| light.ggx(Dielectric::new(0.5 + light.share).unwrap()))?;
        frame.same_ggx(|light| light.ggx(light.conductor()).separable())?;
        frame.same_ggx(|light| light.ggx(Coat(light.share)).with_masking::<MaskedAlone>())?;
    }

    #[test]
    fn anisotropic_lights(frame in frame()) {
        let ggx = |light: &Parts| {
            // Now and then of the same roughness along and across.
            let across = if light.share > 0.9 { light.roughness } else { light.share.max(1e-3) };
            AnisotropicGgx::new(light.roughness, across).unwrap()
        };
        let tangent = |light: &Parts| {
            Direction::new(light.lit.normal.any_orthonormal_vector()).unwrap()
        };
        frame.same_lights(Triaxial, |light| {
            AnisotropicGgxLobe::new(ggx(light), light.conductor(), light.incidence(), tangent(light))
                .unwrap()
        })?;
        frame.same_lights(Triaxial, |light| {
            AnisotropicGgxLobe::new(ggx(light), NoFresnel, light.incidence(), tangent(light))
                .unwrap()
                .separable()
        })?;
    }

    #[test]
    fn other_lights(frame in frame()) {
        // From a pencil to all directions.
        let spot = |light: &Parts| {
            let outer = std::f32::consts::PI * light.roughness;
            SpotLobe::new(light.share * outer, outer, light.lit.normal).unwrap()
        };
        frame.same_lights(Tight, spot)?;
        let lambert = |light: &Parts| LambertLobe::new(light.share, light.lit.normal).unwrap();
        frame.same_lights(Paper, lambert)?;
        frame.same_lights(Tight, lambert)?;
        frame.same_lights(Paper, |_| ConstantLobe)?;
        frame.same_lights(Tight, |light| {
            // From flat to as narrow as may be.
            let exponent = PhongLobe::MAX_EXPONENT * light.roughness.powi(4);
            PhongLobe::new(light.share, exponent, light.incidence()).unwrap()
        })?;
        let gaussian = |light: &Parts| {
            let sharpness = SphericalGaussian::MAX_SHARPNESS * light.roughness.powi(4);
            SphericalGaussian::new(light.lit.normal, sharpness, light.share).unwrap()
        };
        frame.same_lights(Tight, gaussian)?;
        frame.same_lights(Focal, gaussian)?;
        frame.same_lights(Tight, |light| {
            LtcLobe::new(Ggx::new(light.roughness).unwrap(), NoFresnel, light.incidence())
        })?;
        frame.same_lights(OwnBound, |light| Windowed(light.lit.normal))?;
    }

    /// What comes before the projection does not know of it.
    #[test]
    fn lights_before_parallel_rays(frame in frame()) {
        let spot = |light: &Parts| {
            let outer = std::f32::consts::PI * light.roughness;
            SpotLobe::new(light.share * outer, outer, light.lit.normal).unwrap()
        };
        frame.same_lights_in(&frame.parallel, Tight, spot)?;
        frame.same_lights_in(&frame.parallel, Tight, |light| light.ggx(NoFresnel))?;
        frame.same_lights_in(&frame.parallel, Paper, |_| ConstantLobe)?;
    }

    #[test]
    fn bounds_that_are_kept(frame in frame()) {
        let spheroids: Vec<Spheroid> = frame
            .lights
            .iter()
            .map(|light| light.ggx(light.conductor()).unit_bound_by(Paper))
            .collect();
        frame.same_placed(&spheroids)?;
        let spheres: Vec<Sphere> = spheroids.iter().map(Spheroid::enclosing_sphere).collect();
        frame.same_placed(&spheres)?;
        let ellipsoids: Vec<Ellipsoid> = frame
            .lights
            .iter()
            .map(|light| light.ggx(NoFresnel).unit_bound())
            .collect();
        frame.same_placed(&ellipsoids)?;
        // Not around the origin.
        let moved = spheroids.iter().zip(&frame.lights);
        let moved: Vec<_> = moved.map(|(bound, light)| bound.placed(light.position, 0.5)).collect();
        frame.same_placed(&moved)?;
        let moved: Vec<Ellipsoid> = moved.into_iter().map(Ellipsoid::from).collect();
        frame.same_placed(&moved)?;
    }
}

#[test]
fn nothing_comes_of_nothing() {
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..9.0).unwrap();
    let builder = BatchBuilder::new(&Roulette::new(0.1).unwrap(), &camera);
    let mut batch = LightBatch::new();
    builder.add::<LambertLobe>([], &mut batch);
    let xi = Xi::new(0.5).unwrap();
    let lobe = LambertLobe::new(0.5, Direction::Y).unwrap();
    let dark = Vpl::new(Vec3::ZERO, 0.0, lobe).unwrap();
    builder.add([(0, &dark, xi), (1, &dark, xi)], &mut batch);
    assert!(batch.is_empty() && batch.iter().next().is_none());
}

#[test]
fn later_frames_allocate_nothing() {
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..9.0).unwrap();
    let lobe = LambertLobe::new(0.5, Direction::Y).unwrap();
    let light = |i| Vpl::new(Vec3::new(0.0, 1.0, -0.1 * i as f32), 1.0, lobe).unwrap();
    let lights: Vec<_> = (0..1000).map(light).collect();
    let mut batch = LightBatch::new();
    let mut draw_frame = || {
        let builder = BatchBuilder::new(&Roulette::new(0.1).unwrap(), &camera);
        let lights = (0..).zip(&lights);
        let lights = lights.map(|(i, light)| (i, light, Seed(0).frame(0).xi(i)));
        batch.clear();
        builder.add(lights, &mut batch);
    };
    let first = allocation_counter::measure(&mut draw_frame);
    assert!(first.count_total > 0);
    let second = allocation_counter::measure(&mut draw_frame);
    assert_eq!(second.count_total, 0);
}
