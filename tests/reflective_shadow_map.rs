//! Reflective shadow maps: pyramids of sums over maps of any size, and clusters drawn from them.

use proptest::prelude::*;
use stochastic_light_culling::{
    ClusterSums, Direction, Error, FilteredSampling, Ggx, Incidence, Lobe, MipPyramid, Seed,
    SphericalGaussian, glam::Vec3, pyramid_len,
};
use support::generators::{self, cases, log_uniform};

/// A pyramid of numbers, written from its definition: squares of 2ˡ texels, those beyond the map empty.
struct Model {
    size: [usize; 2],
    texels: Vec<f64>,
}

impl Model {
    fn top(&self) -> u32 {
        let side = self.size[0].max(self.size[1]);
        (0..32)
            .find(|level| side <= 1 << level)
            .expect("a short side")
    }

    /// The mean of the square (x, y) of a level; squares beyond the edge are the outermost ones.
    fn square(&self, level: u32, x: i64, y: i64) -> f64 {
        let side = 1_usize << level;
        let inside = |at: i64, axis: usize| {
            let last = (self.size[axis] - 1) / side;
            usize::try_from(at).unwrap_or(0).min(last)
        };
        let (x, y) = (inside(x, 0) * side, inside(y, 1) * side);
        let mut sum = 0.0;
        for row in y..(y + side).min(self.size[1]) {
            for column in x..(x + side).min(self.size[0]) {
                sum += self.texels[row * self.size[0] + column];
            }
        }
        sum / (side * side) as f64
    }

    fn bilinear(&self, [x, y]: [f64; 2], level: u32) -> f64 {
        let side = f64::from(1 << level);
        let [u, v] = [(x, 0), (y, 1)].map(|(at, axis)| at * self.size[axis] as f64 / side - 0.5);
        let mut sum = 0.0;
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = |at: f64, step: i64| 1.0 - (at - (at.floor() + step as f64)).abs();
            let square = self.square(level, u.floor() as i64 + dx, v.floor() as i64 + dy);
            sum += weight(u, dx) * weight(v, dy) * square;
        }
        sum
    }

    fn mean_at(&self, position: [f64; 2], level: f64) -> f64 {
        let level = level.min(f64::from(self.top()));
        let lower = level.floor();
        let at = |level: f64| self.bilinear(position, (level as u32).min(self.top()));
        at(lower) * (1.0 - (level - lower)) + at(lower + 1.0) * (level - lower)
    }
}

/// A map of `size` with room for its levels.
fn with_levels<T: Copy>(size: [u32; 2], map: impl IntoIterator<Item = T>, rest: T) -> Vec<T> {
    let mut texels: Vec<T> = map.into_iter().collect();
    assert_eq!(texels.len(), (size[0] * size[1]) as usize);
    texels.resize(pyramid_len(size).unwrap(), rest);
    texels
}

fn map_of_numbers() -> impl Strategy<Value = ([u32; 2], Vec<f64>)> {
    [1_u32..40, 1_u32..40].prop_flat_map(|size| {
        let number = prop_oneof![1 => Just(0.0), 4 => log_uniform(1e-3, 1e3)];
        let count = (size[0] * size[1]) as usize;
        (Just(size), prop::collection::vec(number, count))
    })
}

/// A light, or nothing, in each texel.
fn map_of_lights() -> impl Strategy<Value = ([u32; 2], Vec<ClusterSums>)> {
    let light = (
        generators::position(),
        log_uniform(1e-3, 1e3),
        generators::lit(),
        generators::roughness(),
    )
        .prop_map(|(position, flux, lit, roughness)| {
            let incidence = Incidence {
                normal: lit.normal,
                incoming: lit.incoming,
            };
            let dull = SphericalGaussian::diffuse(0.5, lit.normal).unwrap();
            let ggx = Ggx::new(roughness).unwrap();
            let glossy = SphericalGaussian::specular(ggx, 0.3, incidence).unwrap();
            ClusterSums::of_light(position, flux as f32, &dull, &glossy).unwrap()
        });
    let texel = prop_oneof![1 => Just(ClusterSums::EMPTY), 3 => light];
    [1_u32..24, 1_u32..24].prop_flat_map(move |size| {
        let count = (size[0] * size[1]) as usize;
        (Just(size), prop::collection::vec(texel.clone(), count))
    })
}

proptest! {
    #![proptest_config(cases(256))]

    /// Trilinear reads, against the definition, in maps of any size.
    #[test]
    fn reads_are_trilinear_means(
        (size, numbers) in map_of_numbers(),
        position in [0.0..=1.0_f32, 0.0..=1.0_f32],
        level in 0.0..7.0_f32,
    ) {
        let mut texels = with_levels(size, numbers.iter().map(|x| *x as f32), f32::NAN);
        let pyramid = MipPyramid::build(size, &mut texels).unwrap();
        let rounded = numbers.iter().map(|x| f64::from(*x as f32));
        let model = Model { size: size.map(|n| n as usize), texels: rounded.collect() };
        prop_assert_eq!(pyramid.levels(), model.top() + 1);
        let exact = model.mean_at(position.map(f64::from), level.into());
        let found = f64::from(pyramid.mean_at(position, level));
        // A position is rounded to 2⁻²⁴·40 texels, over which a mean changes by no more than the largest texel.
        let largest = numbers.iter().fold(0.0, |a: f64, b| a.max(*b));
        prop_assert!((found - exact).abs() <= 1e-5 * largest + 1e-5 * exact, "{found} {exact}");
        let level = level.min(model.top() as f32);
        let sum = f64::from(pyramid.sum_at(position, level));
        prop_assert!((sum - found * 4_f64.powf(level.into())).abs() <= 1e-5 * sum);
    }

    /// Each level adds up to the map, and the top is all there is, wherever it is read.
    #[test]
    fn every_level_is_the_whole((size, lights) in map_of_lights(), at in [0.0..=1.0_f32, 0.0..=1.0_f32]) {
        let all: ClusterSums = lights.iter().copied().sum();
        let mut texels = with_levels(size, lights.iter().copied(), ClusterSums::EMPTY);
        let map = MipPyramid::build(size, &mut texels).unwrap();
        let same = |found: ClusterSums| {
            let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * a.abs();
            let lights = [(all.diffuse(), found.diffuse()), (all.glossy(), found.glossy())];
            lights.into_iter().all(|(a, b)| {
                let far = a.position().length();
                close(a.lobe().integral(), b.lobe().integral())
                    && close(a.lobe().sharpness(), b.lobe().sharpness())
                    && (a.position() - b.position()).length() <= 3e-7 * far
                    && (a.spread() - b.spread()).abs() <= 1e-5 * a.spread() + 2e-7 * far
            })
        };
        for level in 0..map.levels() {
            let (level_size, texels) = map.level(level).unwrap();
            prop_assert_eq!(level_size, size.map(|side| side.div_ceil(1 << level)));
            prop_assert!(same(texels.iter().copied().sum()), "level {level}");
        }
        prop_assert!(map.level(map.levels()).is_none());
        prop_assert!(same(*map.total()));
        prop_assert!(same(map.sum_at(at, f32::INFINITY)));
    }

    /// The flux of clusters is that of the map, whatever the map, the number of clusters and the points.
    #[test]
    fn clusters_have_all_the_flux(
        (size, lights) in map_of_lights(),
        count in 1_u32..50,
        overlap in log_uniform(0.1, 10.0),
        seed in any::<u32>(),
    ) {
        let mut texels = with_levels(size, lights, ClusterSums::EMPTY);
        let map = MipPyramid::build(size, &mut texels).unwrap();
        let sampling = FilteredSampling::new(count, overlap as f32).unwrap();
        let seed = Seed(seed).frame(0);
        let clusters = (0..count).map(|i| map.sample(&sampling, seed.hashed_point(i)));
        if map.total().flux() == 0.0 {
            prop_assert!(clusters.clone().all(|sample| sample.is_none()));
            return Ok(());
        }
        let share = map.total().flux() / f64::from(count);
        for sample in clusters {
            let sample = sample.unwrap();
            prop_assert!(sample.position.iter().all(|x| (0.0..=1.0).contains(x)));
            prop_assert!((0.0..=(map.levels() - 1) as f32).contains(&sample.level));
            let flux = map.cluster(&sample).flux();
            prop_assert!((flux / share - 1.0).abs() < 1e-5, "{flux} of {share}");
        }
    }
}

/// A smooth map with bright spots and holes, of a size that is no power of two, its texels in a plane and half
/// of their flux glossy on the left.
fn smooth_map([width, height]: [u32; 2]) -> Vec<ClusterSums> {
    let dull = SphericalGaussian::diffuse(0.5, Direction::Z).unwrap();
    let polished = SphericalGaussian::with_integral(Direction::Z, 200.0, 0.8).unwrap();
    let dark = SphericalGaussian::new(Direction::Z, 0.0, 0.0).unwrap();
    let texel = |[x, y]: [u32; 2]| {
        let (u, v) = (
            (x as f32 + 0.5) / width as f32,
            (y as f32 + 0.5) / height as f32,
        );
        let spot = (-40.0 * ((u - 0.3).powi(2) + (v - 0.6).powi(2))).exp();
        let hole = (u - 0.7).hypot(v - 0.3) > 0.15;
        let flux = if hole { 1e-4 * (0.2 + 5.0 * spot) } else { 0.0 };
        let glossy = if u < 0.5 { &polished } else { &dark };
        ClusterSums::of_light(Vec3::new(u, v, 0.0), flux, &dull, glossy).unwrap()
    };
    let rows = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    rows.map(texel).collect()
}

/// The energy of clusters, diffuse and glossy apart, and their first moments, against the lights' own.
#[test]
fn clusters_have_the_lights_energy_and_place() {
    let size = [150, 97];
    let lights = smooth_map(size);
    let all: ClusterSums = lights.iter().copied().sum();
    let mut texels = with_levels(size, lights, ClusterSums::EMPTY);
    let map = MipPyramid::build(size, &mut texels).unwrap();
    for (count, overlap) in [(256, 1.0), (1024, 1.0), (1024, 4.0)] {
        let sampling = FilteredSampling::new(count, overlap).unwrap();
        let seed = Seed(3).frame(0);
        let samples: Vec<_> = (0..count)
            .map(|i| map.sample(&sampling, seed.point(i)).unwrap())
            .collect();
        let clusters: ClusterSums = samples.iter().map(|sample| map.cluster(sample)).sum();
        // The part of the map's side that a cluster is wide: 1/32 for 1024 of them. What they are off by is what the
        // density differs from its mean over a cluster, at the edges of spots, holes and materials.
        let width = (overlap / count as f32).sqrt();
        let relative = |a: f32, b: f32| (a / b - 1.0).abs();
        let [found, exact] = [&clusters, &all].map(|sums| [sums.diffuse(), sums.glossy()]);
        for (found, exact) in found.into_iter().zip(exact) {
            let energy = relative(found.lobe().integral(), exact.lobe().integral());
            assert!(energy < 0.32 * width, "{energy} at {count}, {overlap}");
            let place = (found.position() - exact.position()).length();
            assert!(
                place < 0.32 * width * exact.spread(),
                "{place} at {count}, {overlap}"
            );
            let spread = relative(found.spread(), exact.spread());
            assert!(spread < 0.64 * width, "{spread} at {count}, {overlap}");
        }
        // All of it as the paper weights them, 4ˡ/K times the mean.
        let as_printed: f64 = samples
            .iter()
            .map(|sample| map.sum_at(sample.position, sample.level).flux())
            .sum();
        let share = as_printed / f64::from(overlap) / all.flux() - 1.0;
        assert!(share.abs() < 1e-4, "{share} at {count}, {overlap}");
    }
}

/// Places are drawn as often as their texels have flux.
#[test]
fn density_is_proportional_to_flux() {
    const COUNT: u32 = 1 << 18;
    let size = [5, 3];
    let flux = [
        1.0, 2.0, 0.0, 4.0, 0.5, 0.0, 0.0, 7.0, 0.0, 3.0, 1e-3, 0.0, 2.0, 1.0, 6.0,
    ];
    let lobe = SphericalGaussian::with_integral(Direction::Z, 1.0, 1.0).unwrap();
    let dark = SphericalGaussian::new(Direction::Z, 0.0, 0.0).unwrap();
    let texel = |flux: &f32| ClusterSums::of_light(Vec3::ZERO, *flux, &lobe, &dark).unwrap();
    let mut texels = with_levels(size, flux.iter().map(texel), ClusterSums::EMPTY);
    let map = MipPyramid::build(size, &mut texels).unwrap();
    let count_in_texels = |points: &mut dyn Iterator<Item = [f32; 2]>| {
        let mut counts = [0.0_f64; 15];
        let mut sums = [[0.0; 2]; 15];
        for point in points {
            let [x, y] = map.position_by_flux(point).unwrap();
            let [x, y] = [f64::from(x) * 5.0, f64::from(y) * 3.0];
            let texel = (y.min(2.999) as usize) * 5 + x.min(4.999) as usize;
            counts[texel] += 1.0;
            sums[texel][0] += x.fract();
            sums[texel][1] += y.fract();
        }
        (counts, sums)
    };
    let total: f32 = flux.iter().sum();
    let seed = Seed(5).frame(0);
    let (hashed, sums) = count_in_texels(&mut (0..COUNT).map(|i| seed.hashed_point(i)));
    let (spread, _) = count_in_texels(&mut (0..COUNT).map(|i| seed.point(i)));
    for i in 0..15 {
        let p = f64::from(flux[i] / total);
        let expected = p * f64::from(COUNT);
        // Texels without flux, but for the rounding of a position on their edge.
        let off = (hashed[i] - expected).abs();
        // Five standard deviations: 6·10⁻⁷.
        assert!(
            off <= 5.0 * (expected * (1.0 - p)).sqrt() + 2.0,
            "{i}: {off}"
        );
        // Spread points are off by some along the edges of the rectangle that goes to a texel.
        let off = (spread[i] - expected).abs();
        assert!(off <= 12.0, "{i}: {off} of {expected}");
        if hashed[i] > 1000.0 {
            for sum in sums[i] {
                let middle = sum / hashed[i];
                assert!(
                    (middle - 0.5).abs() < 1.5 / hashed[i].sqrt(),
                    "{i}: {middle}"
                );
            }
        }
    }
}

/// Points that are spread: one in each box of a net.
#[test]
fn points_are_a_net() {
    for seed in 0..20 {
        let frame = Seed(seed).frame(seed / 3);
        for start in [0, 64, 1 << 20, u32::MAX - 63] {
            for halvings in 0..=6 {
                let mut boxes = [false; 64];
                for i in start..=start + 63 {
                    let [x, y] = frame.point(i);
                    let [columns, rows] = [1 << halvings, 1 << (6 - halvings)];
                    let place = (x * columns as f32) as usize * rows + (y * rows as f32) as usize;
                    assert!(!boxes[place], "{seed} {start} {halvings}");
                    boxes[place] = true;
                }
            }
        }
    }
}

/// The level grows with the share, down to the texel and up to the whole.
#[test]
fn levels_hold_their_share() {
    let size = [256, 256];
    let lobe = SphericalGaussian::with_integral(Direction::Z, 1.0, 1.0).unwrap();
    let texel = ClusterSums::of_light(Vec3::ZERO, 1.0, &lobe, &lobe).unwrap();
    let mut even = with_levels(size, vec![texel; 65536], ClusterSums::EMPTY);
    let map = MipPyramid::build(size, &mut even).unwrap();
    for log in 0..=8 {
        // A share of 4^(log − 8) is a square of 4^log texels of an even map.
        let level = map.level_of_share([0.4, 0.7], 0.25_f32.powi(8 - log));
        assert!((level - log as f32).abs() < 0.005, "{level} for {log}");
    }
    assert!(map.level_of_share([0.4, 0.7], 0.0) < 0.002);
    assert!(map.level_of_share([0.4, 0.7], 5.0) > 7.995);
    assert!(map.level_of_share([0.4, 0.7], f32::NAN) < 0.002);

    // A single bright texel is a cluster by itself: a point light.
    let mut one = with_levels(size, vec![ClusterSums::EMPTY; 65536], ClusterSums::EMPTY);
    one[256 * 9 + 77] = texel;
    let map = MipPyramid::build(size, &mut one).unwrap();
    let sampling = FilteredSampling::new(16, 1.0).unwrap();
    for i in 0..16 {
        let sample = map.sample(&sampling, Seed(0).frame(0).point(i)).unwrap();
        let [x, y] = sample.position.map(|x| (x * 256.0) as u32);
        assert_eq!([x, y], [77, 9]);
        assert!(sample.level < 0.002, "{}", sample.level);
        assert_eq!(map.cluster(&sample).glossy().spread(), 0.0);
    }
}

#[test]
fn empty_dark_and_opposite_texels() {
    let lobe = |axis| SphericalGaussian::with_integral(axis, 30.0, 0.5).unwrap();
    let [up, down] = [Direction::Z, -Direction::Z].map(lobe);
    let sampling = FilteredSampling::new(4, 1.0).unwrap();

    // Nothing, and light without flux.
    let dark = ClusterSums::of_light(Vec3::ONE, 0.0, &up, &up).unwrap();
    for texel in [ClusterSums::EMPTY, dark] {
        let mut texels = with_levels([3, 2], [texel; 6], ClusterSums::EMPTY);
        let map = MipPyramid::build([3, 2], &mut texels).unwrap();
        assert!(map.sample(&sampling, [0.5; 2]).is_none());
        assert!(map.position_by_flux([0.5; 2]).is_none());
        assert!(map.sum_at([0.5; 2], 1.0).glossy().lobe().is_empty());
        assert!(map.level_of_share([0.5; 2], 0.25) < 0.001);
    }

    // Opposite lobes side by side: no mean direction, and all the flux.
    let side = [(-0.1, &up), (0.1, &down)];
    let light = |(x, lobe)| ClusterSums::of_light(Vec3::X * x, 1.0, lobe, lobe).unwrap();
    let mut texels = with_levels([2, 1], side.map(light), ClusterSums::EMPTY);
    let map = MipPyramid::build([2, 1], &mut texels).unwrap();
    let one = FilteredSampling::new(1, 1.0).unwrap();
    let cluster = map.cluster(&map.sample(&one, [0.9, 0.1]).unwrap()).glossy();
    assert!(cluster.lobe().sharpness() < 1e-3, "{cluster:?}");
    assert!((cluster.lobe().integral() - 1.0).abs() < 1e-5);
    assert!((cluster.spread() - 0.1).abs() < 1e-4);

    // Numbers that are none count as zero.
    let first = map.position_by_flux([0.0; 2]).unwrap();
    for numbers in [[f32::NAN; 2], [-1.0, f32::NEG_INFINITY]] {
        assert_eq!(map.position_by_flux(numbers).unwrap(), first);
        assert_eq!(map.mean_at(numbers, f32::NAN), map.mean_at([0.0; 2], 0.0));
    }
    let last = map.position_by_flux([2.0, f32::INFINITY]).unwrap();
    assert_eq!(last, [1.0, 1.0]);
}

#[test]
fn bad_input_is_refused() {
    for size in [[0, 1], [1, 0], [16385, 1], [u32::MAX, u32::MAX]] {
        assert!(matches!(pyramid_len(size), Err(Error::Size { value, .. }) if value == size));
        assert!(MipPyramid::build(size, &mut [1.0; 9]).is_err());
    }
    assert_eq!(pyramid_len([1, 1]), Ok(1));
    assert_eq!(pyramid_len([16384, 1]), Ok(2 * 16384 - 1));
    let short = MipPyramid::build([2, 2], &mut [1.0; 4]).unwrap_err();
    assert!(matches!(short, Error::Count { value: 4, .. }));
    for overlap in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(FilteredSampling::new(8, overlap).is_err());
    }
    assert!(matches!(
        FilteredSampling::new(0, 1.0),
        Err(Error::Count { .. })
    ));
}
