//! Grids, batches and lists with numbers from bits: what culling in vectors makes of them is what the scalar
//! functions make of each light and tile.

use std::fmt::Debug;

use stochastic_light_culling::{
    AnyCamera, BatchBuilder, Bounded, BoxTest, Camera, Culler, Decision, DepthInterval, Direction,
    Ellipsoid, Ggx, GgxLobe, Incidence, LambertLobe, LightBatch, LightLists, Lobe, NoFresnel,
    Project, ProjectedBound, Projection, RadianceEstimator, Receiver, ReceiverBlock, Roulette,
    Seed, ShadedPoint, ShadingBatch, Sphere, TileDepths, TileGrid, TileRectangle, Vpl,
    WeightedList, Xi, glam::Mat3,
};
use support::with_camera;

use crate::bits::Bits;
use crate::probe::{PLACES, SCALES};

pub fn everything(bits: &mut Bits, cameras: &[AnyCamera]) {
    let camera = &cameras[usize::from(bits.byte()) % cameras.len()];
    refused_grids(bits);
    with_camera!(camera, camera => in_view(bits, camera));
}

fn in_view<P: Projection>(bits: &mut Bits, camera: &Camera<P>) {
    let Some(grid) = Grid::new(bits, camera) else {
        return;
    };
    match bits.byte() % 4 {
        0 => {
            let shape = Ellipsoid::new(bits.vector(), Mat3::IDENTITY, bits.vector());
            if let Ok(shape) = shape {
                grid.lists_bounds(bits, shape);
            }
        }
        1 => {
            if let Ok(shape) = Sphere::new(bits.vector(), bits.number()) {
                grid.lists_bounds(bits, shape);
            }
        }
        2 => {
            let [normal, incoming] = [(); 2].map(|()| Direction::new(bits.vector()));
            if let (Ok(normal), Ok(incoming), Ok(ggx)) = (normal, incoming, Ggx::new(bits.number()))
            {
                let lobe = GgxLobe::new(ggx, NoFresnel, Incidence { normal, incoming });
                grid.lists_lights(bits, lobe);
            }
        }
        _ => {
            let (albedo, normal) = (bits.number(), Direction::new(bits.vector()));
            if let Ok(lobe) = normal.and_then(|normal| LambertLobe::new(albedo, normal)) {
                grid.lists_lights(bits, lobe);
            }
        }
    }
}

/// More tiles than there may be, or none: refused before anything is allocated or asked for.
fn refused_grids(bits: &mut Bits) {
    let (size, intervals) = ([bits.size(), bits.size()], bits.size());
    let [columns, rows, slices] = [size[0], size[1], intervals].map(u128::from);
    let slots = columns * rows * slices;
    if slots == 0 || slots > 1 << 27 || columns.max(rows) > 1 << 16 {
        let never = |_| -> TileRectangle { unreachable!("there is no such tile") };
        assert!(TileDepths::from_rectangles(size, intervals, never).is_err());
    }
}

/// Tiles before a camera.
struct Grid<'a, P> {
    camera: &'a Camera<P>,
    tiles: TileDepths,
    /// Tile by tile what was put into `tiles`.
    seen: Vec<(TileRectangle, Vec<Option<DepthInterval>>)>,
}

impl<'a, P: Projection> Grid<'a, P> {
    fn new(bits: &mut Bits, camera: &'a Camera<P>) -> Option<Self> {
        let image = [24, 8].map(|most| 1 + u32::from(bits.byte()) % most);
        let grid = TileGrid::new(image, 1 + u32::from(bits.byte()) % 3).ok()?;
        let rectangle = |tile| camera.tile_rectangle(image, grid.pixels(tile));
        let intervals = 1 + u32::from(bits.byte()) % 3;
        let mut tiles = TileDepths::from_rectangles(grid.size(), intervals, rectangle).ok()?;
        let few = [(); 4].map(|()| bits.number());
        let mut seen = Vec::new();
        for (tile, which) in grid.tiles().zip(0_usize..) {
            let [a, b] = [few[which % 4], few[(which / 3) % 4]];
            let given = [
                DepthInterval::new(a, b).ok(),
                DepthInterval::around([a, b, 1.0]),
                None,
                DepthInterval::around(few),
            ];
            let given = &given[which % 2..][..intervals as usize];
            tiles.set(tile, given.iter().copied());
            for depth in few {
                let holds = |interval: &Option<DepthInterval>| {
                    interval.is_some_and(|seen| seen.near() <= depth && depth <= seen.far())
                };
                let first = given.iter().position(holds).map(|which| which as u32);
                assert_eq!(tiles.interval_of(tile, depth), first);
            }
            seen.push((rectangle(tile), given.to_vec()));
        }
        Some(Self {
            camera,
            tiles,
            seen,
        })
    }

    /// Copies of a bound from nowhere to everywhere.
    fn lists_bounds<B>(&self, bits: &mut Bits, bound: B)
    where
        B: Project + 'static,
        B::Projected<P>: BoxTest + PartialEq + Debug,
    {
        let places = PLACES.into_iter();
        let places = places.flat_map(|place| SCALES.map(|scale| (place, scale)));
        let numbered = (0..).zip(places.clone());
        let given = numbered.map(|(number, (place, scale))| (number, &bound, place, scale));
        let mut batch = LightBatch::new();
        let roulette = roulette(bits);
        builder(bits, &roulette, self.camera).add_placed(given, &mut batch);
        let shapes = places.map(|(place, scale)| bound.placed(place, scale).project(self.camera));
        self.lists(bits, &batch, shapes);
    }

    /// Lights from the dimmest to the brightest.
    fn lists_lights<L>(&self, bits: &mut Bits, lobe: L)
    where
        L: Bounded<Shape: Project> + Copy + 'static,
        ProjectedBound<L, P>: BoxTest + PartialEq + Debug,
    {
        let (roulette, xi) = (roulette(bits), Xi::new(bits.number()));
        let xi = xi.unwrap_or(Seed(3).frame(2).xi(1));
        let places = PLACES.into_iter();
        let lights: Vec<_> = places
            .flat_map(|place| [0.0, 1e-45, 1.0, f32::MAX].map(|flux| (place, flux)))
            .map(|(place, flux)| Vpl::new(place, flux, lobe).expect("finite"))
            .collect();
        let given = (0..).zip(&lights);
        let given = given.map(|(number, light)| (number, light, xi));
        let mut batch = LightBatch::new();
        builder(bits, &roulette, self.camera).add(given, &mut batch);
        estimates(bits, &roulette, xi, &lights);
        let shapes = lights.iter();
        let shapes = shapes.map(|light| light.bound(&roulette, xi).project(self.camera));
        self.lists(bits, &batch, shapes);
    }

    /// Each tile's lists are of those shapes that touch it.
    fn lists<T>(
        &self,
        bits: &mut Bits,
        batch: &LightBatch<T>,
        shapes: impl Iterator<Item = Option<T>>,
    ) where
        T: BoxTest + PartialEq + Debug,
    {
        let shapes: Vec<(u32, T)> = (0..)
            .zip(shapes)
            .filter_map(|(number, shape)| Some((number, shape?)))
            .collect();
        assert_eq!(batch.iter().collect::<Vec<_>>(), shapes);
        let (mut lists, lanes) = (LightLists::new(), bits.byte());
        let cullers = [
            Culler::new(),
            Culler::with_lanes(lanes.into()),
            Culler::new().without_blocks(),
        ];
        for (exact, mut culler) in cullers
            .into_iter()
            .flat_map(|culler| [(false, culler.clone()), (true, culler.with_exact_test())])
        {
            let counters = culler.cull(batch, &self.tiles, &mut lists).expect("few");
            assert_eq!(counters.pairs, lists.len() as u64);
            for (index, (rectangle, intervals)) in self.seen.iter().enumerate() {
                let columns = self.tiles.size()[0] as usize;
                let tile = [index % columns, index / columns].map(|n| n as u32);
                for (interval, depths) in (0..).zip(intervals) {
                    let touching = shapes.iter().filter(|(_, shape)| match depths {
                        Some(depths) if exact => shape.touches_exactly(rectangle, depths),
                        Some(depths) => shape.touches(rectangle, depths),
                        None => false,
                    });
                    let numbers = touching.map(|(number, _)| number);
                    assert!(numbers.eq(lists.of(tile, interval)), "{depths:?}");
                }
            }
            // Of a tile that there may not be.
            let _ = lists.of([bits.size(), bits.size()], bits.size());
        }
    }
}

/// Lights at points from bits, and at their own places, are accepted as by scalar functions.
fn estimates<L: Lobe + Copy>(bits: &mut Bits, roulette: &Roulette, xi: Xi, lights: &[Vpl<L>]) {
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|light| (light, xi)));
    let estimator = RadianceEstimator::new(roulette).with_lanes(bits.byte().into());
    let list: Vec<u32> = (0..lights.len() as u32).collect();
    let points = [bits.vector(), bits.vector()].into_iter().chain(PLACES);
    let points: Vec<ShadedPoint> = points.map(Into::into).collect();
    let mut found = Vec::new();
    let lists = points.iter().map(|point| (*point, &list[..]));
    estimator.at_points(&batch, lists, |_, estimate| {
        found.push((estimate.light, estimate.radiance.to_bits()));
    });
    let scalar = |point: &ShadedPoint, light: u32| {
        let vpl = &lights[light as usize];
        let (direction, squared) = vpl.direction_to(point.position);
        let radiance = roulette.estimate(vpl.radiant_intensity(direction), squared, xi);
        (radiance > 0.0).then_some((light, radiance.to_bits()))
    };
    let expected = points
        .iter()
        .flat_map(|point| list.iter().filter_map(|light| scalar(point, *light)));
    assert_eq!(found, expected.collect::<Vec<_>>());

    // As receivers of each other's light they reflect what is no NaN, for none is infinite.
    let lobes = lights.iter().map(Vpl::lobe).cycle();
    let receivers = points.iter().zip(lobes).map(|(point, lobe)| Receiver {
        position: point.position,
        lobe: *lobe,
    });
    let receivers: Vec<_> = receivers.collect();
    reflect(&estimator, &batch, &list[..], &receivers);
    let estimator = RadianceEstimator::aware(roulette).with_lanes(bits.byte().into());
    reflect(&estimator, &batch, &list[..], &receivers);
    let weights: Vec<f32> = list.iter().map(|_| bits.number()).collect();
    let estimator = RadianceEstimator::listed().with_lanes(bits.byte().into());
    let list = WeightedList {
        lights: &list,
        weights: &weights,
    };
    reflect(&estimator, &batch, list, &receivers);
}

/// Receivers reflect what is no NaN, as long as what arrives is finite.
fn reflect<L: Lobe + Copy, D: Decision>(
    estimator: &RadianceEstimator<D>,
    batch: &ShadingBatch<L>,
    list: D::List<'_>,
    receivers: &[Receiver<L>],
) {
    if let Some(block) = ReceiverBlock::take(&mut receivers.iter().copied()) {
        estimator.reflected_at_block(batch, list, &block, |estimates, reflected| {
            for (radiance, reflected) in estimates.radiance.iter().zip(reflected) {
                assert!(radiance.is_infinite() || *reflected >= 0.0, "{reflected}");
                assert!(*radiance >= 0.0, "{radiance}");
            }
        });
    }
    let lists = receivers.iter().map(|receiver| (*receiver, list));
    estimator.fold_reflected_at_points(batch, lists, (), |(), _, estimate, reflected| {
        let radiance = estimate.radiance;
        assert!(radiance.is_infinite() || reflected >= 0.0, "{reflected}");
        assert!(radiance > 0.0, "{radiance}");
    });
}

fn roulette(bits: &mut Bits) -> Roulette {
    Roulette::new(bits.number()).unwrap_or(Roulette::new(1.0).expect("positive"))
}

fn builder<P: Projection>(
    bits: &mut Bits,
    roulette: &Roulette,
    camera: &Camera<P>,
) -> BatchBuilder<P> {
    BatchBuilder::new(roulette, camera).with_lanes(bits.byte().into())
}
