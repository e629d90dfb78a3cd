//! The ring by the GPU is the ring by the CPU, whichever way its lights are listed.

use common::frame::Shaded;
use gpu::{Error, Gpu, Method};
use stochastic_light_culling::{GpuBuffer, Seed, glam::Vec3};

#[path = "../examples/ring/comparison.rs"]
mod comparison;
#[path = "../examples/ring/shading.rs"]
mod shading;
#[path = "../examples/ring/stage.rs"]
mod stage;

use comparison::{Comparison, Picture};
use shading::Lighting;
use stage::{Request, Stage};

/// Small, and of a size that neither tiles nor subregions divide.
const REQUEST: Request = Request {
    alpha: 0.1,
    f0: 0.9,
    vpls: 4096,
    delta: 0.001,
    size: [150, 83],
    seed: 1,
    interleave: 4,
};

fn picture(lighting: &Lighting, method: Method) -> Picture {
    let picture = lighting.compiled(method, |compiled| lighting.picture(compiled));
    picture.unwrap().0
}

/// At the threshold, rounding may accept a light or not: one in a hundred thousand.
#[track_caller]
fn assert_same(picture: &Picture, reference: &Shaded) {
    let Comparison {
        relative_error,
        unlike,
        accepted,
    } = Comparison::new(picture, reference);
    println!(
        "RMSE {relative_error:.1e} of the mean; {unlike} pixels accept other lights, of {accepted} pairs"
    );
    assert!(relative_error <= 1e-3, "{relative_error}");
    assert!(
        unlike as u64 <= accepted / 100_000 + 1,
        "{unlike} of {accepted}"
    );
    assert!(accepted > 1000);
}

#[test]
fn the_ring_is_that_of_the_cpu() {
    let gpu = Gpu::new().unwrap();
    for alpha in [0.1, 0.02] {
        let stage = Stage::new(Request { alpha, ..REQUEST }).unwrap();
        let ([glossy, diffuse], _) = stage.by_cpu().unwrap();
        let lightings = [
            Lighting::glossy(&gpu, &stage),
            Lighting::diffuse(&gpu, &stage),
        ];
        for (lighting, reference) in lightings.into_iter().zip([glossy, diffuse]) {
            let lighting = lighting.unwrap();
            let by_tiles = picture(&lighting, Method::Tiles);
            assert_same(&by_tiles, &reference);
            let by_lists = picture(&lighting, Method::Lists);
            assert_same(&by_lists, &reference);
            // Two runs give the same bits, whichever workgroup is first.
            assert_eq!(picture(&lighting, Method::Tiles), by_tiles);
        }
    }
}

/// All lights reach all tiles, eight times as many as a shared list holds, or there is no room for any list in memory.
#[test]
fn no_light_is_lost_where_lists_are_full() {
    let gpu = Gpu::new().unwrap();
    let stage = Stage::new(Request {
        delta: 1e-7,
        interleave: 1,
        size: [40, 24],
        ..REQUEST
    })
    .unwrap();
    let ([_, diffuse], _) = stage.by_cpu().unwrap();
    let mut lighting = Lighting::diffuse(&gpu, &stage).unwrap();
    let listed = diffuse.evaluated.iter().max().unwrap();
    assert!(*listed > 4 * 512, "{listed}");
    assert_same(&picture(&lighting, Method::Tiles), &diffuse);
    assert_same(&picture(&lighting, Method::Lists), &diffuse);
    let needed: Vec<u32> = gpu.read(lighting.frame.buffer(GpuBuffer::Needed)).unwrap();
    assert!(lighting.record.room < needed[0]);
    // Too much to ask of the buffer that there is.
    let asked = lighting.record.with_lists(2, needed[0]).unwrap();
    assert!(matches!(
        lighting.frame.set_record(&asked),
        Err(Error::Refused(_))
    ));
    lighting
        .frame
        .replace(GpuBuffer::Lists, &vec![0_u32; needed[0] as usize])
        .unwrap();
    for room in [0, needed[0] / 2, needed[0] - 1, needed[0]] {
        let record = lighting.record.with_lists(2, room).unwrap();
        lighting.frame.set_record(&record).unwrap();
        assert_same(&picture(&lighting, Method::Lists), &diffuse);
    }
}

/// The mean of 64 seeds is the light of all lights, within three standard errors, in all and in four quarters.
#[test]
fn pictures_are_right_on_average() {
    const SEEDS: u32 = 64;
    let gpu = Gpu::new().unwrap();
    let stage = Stage::new(Request {
        delta: 0.02,
        size: [96, 54],
        ..REQUEST
    })
    .unwrap();
    let [glossy, diffuse] = stage.expected();
    let lightings = [
        Lighting::glossy(&gpu, &stage),
        Lighting::diffuse(&gpu, &stage),
    ];
    for (lighting, expected) in lightings.into_iter().zip([glossy, diffuse]) {
        let lighting = lighting.unwrap();
        let sums = lighting.compiled(Method::Tiles, |compiled| {
            let of_seed = |seed| {
                lighting.reseed(Seed(1000 + seed))?;
                let (picture, _) = lighting.picture(compiled)?;
                Ok(quarters(picture.iter().map(|(irradiance, _)| *irradiance)))
            };
            (0..SEEDS).map(of_seed).collect::<Result<Vec<_>, _>>()
        });
        let sums = sums.unwrap();
        let expected = quarters(expected.into_iter());
        for (i, expected) in expected.into_iter().enumerate() {
            let samples = sums.iter().map(|sums| sums[i]);
            let mean = samples.clone().sum::<f64>() / f64::from(SEEDS);
            let squared: f64 = samples.map(|sum| (sum - mean).powi(2)).sum();
            let error = (squared / f64::from(SEEDS * (SEEDS - 1))).sqrt();
            println!("{mean:.5} ± {error:.5}, expected {expected:.5}");
            assert!(
                (mean - expected).abs() <= 3.0 * error,
                "{mean} ± {error}, expected {expected}"
            );
            // Noisy enough to be a test, and not so noisy that anything would pass.
            assert!(
                (1e-4..0.05).contains(&(error / expected)),
                "{error} of {expected}"
            );
        }
    }
}

/// The mean irradiance of the picture and of each quarter.
fn quarters(irradiance: impl Iterator<Item = Vec3>) -> [f64; 5] {
    let mut sums = [0.0; 5];
    for (i, rgb) in irradiance.enumerate() {
        let (x, y) = (i % 96, i / 96);
        let sum = f64::from(rgb.element_sum());
        sums[0] += sum / (96.0 * 54.0);
        sums[1 + x / 48 + 2 * (y / 27)] += sum / (48.0 * 27.0);
    }
    sums
}
