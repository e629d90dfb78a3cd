//! Lights that are made ready sixteen at a time are, bit by bit, those made ready one by one.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, BatchBuilder, BoundStrategy, Bounded, BoxTest, Camera,
    ConstantLobe, Dielectric, Direction, Ellipsoid, Focal, Fresnel, Ggx, GgxLobe, LambertLobe,
    LightBatch, Lobe, LtcLobe, MaskingShadowing, NoFresnel, OwnBound, Paper, PhongLobe, Project,
    ProjectedEllipsoid, ProjectedSphere, Roulette, Schlick, Seed, Sphere, SphericalGaussian,
    Spheroid, SpotLobe, Tight, Triaxial, Vpl, Xi, glam::Vec3,
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
    (delta, generators::view(), lights, 0..150_usize).prop_map(|(delta, view, lights, first)| {
        Frame {
            roulette: Roulette::new(delta).unwrap(),
            camera: Camera::new(view.from_world, view.projection).unwrap(),
            first: first.min(lights.len()),
            lights,
        }
    })
}

trait Bits {
    fn bits(&self) -> Vec<u32>;
}

impl Bits for ProjectedEllipsoid {
    fn bits(&self) -> Vec<u32> {
        let matrix = self.matrix().to_cols_array();
        let numbers = matrix.into_iter().chain(self.center().to_array());
        numbers.map(f32::to_bits).collect()
    }
}

impl Bits for ProjectedSphere {
    fn bits(&self) -> Vec<u32> {
        let numbers = self.center().to_array().into_iter();
        let numbers = numbers.chain([self.radius_squared()]);
        numbers.map(f32::to_bits).collect()
    }
}

impl Frame {
    /// Whether `add` adds to a batch, of the lights in two parts, the shapes that are `expected`: `None`
    /// for a light that reaches nowhere.
    fn same<T: BoxTest + Bits>(
        &self,
        expected: &[Option<T>],
        add: impl Fn(&BatchBuilder, std::ops::Range<usize>, &mut LightBatch<T>),
    ) -> Result<(), TestCaseError> {
        let expected: Vec<_> = (0..)
            .zip(expected)
            .filter_map(|(number, shape)| Some((number, shape.as_ref()?.bits())))
            .collect();
        for lanes in [16, 8, 4] {
            let builder = BatchBuilder::new(&self.roulette, &self.camera).with_lanes(lanes);
            let mut batch = LightBatch::new();
            // Twice, for what the first leaves behind.
            for _ in 0..2 {
                batch.clear();
                add(&builder, 0..self.first, &mut batch);
                add(&builder, self.first..self.lights.len(), &mut batch);
                let found = batch.iter().map(|(number, shape)| (number, shape.bits()));
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
        B: BoundStrategy<L, Shape: Project<Projected: BoxTest + Bits>>,
    {
        let lights: Vec<_> = self.lights.iter().map(|p| p.vpl(lobe(p))).collect();
        let expected: Vec<_> = lights
            .iter()
            .map(|(light, xi)| light.bound_by(strategy, &self.roulette, *xi))
            .map(|bound| Project::project(&bound, &self.camera))
            .collect();
        self.same(&expected, |builder, range, batch| {
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

    /// Of bounds that are kept.
    fn same_placed<B: Project<Projected: BoxTest + Bits> + 'static>(
        &self,
        bounds: &[B],
    ) -> Result<(), TestCaseError> {
        let scale = |light: &Parts| self.roulette.scale(light.flux, light.xi);
        let placed = self.lights.iter().zip(bounds);
        let expected: Vec<_> = placed
            .map(|(light, bound)| bound.placed(light.position, scale(light)))
            .map(|bound| Project::project(&bound, &self.camera))
            .collect();
        self.same(&expected, |builder, range, batch| {
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
