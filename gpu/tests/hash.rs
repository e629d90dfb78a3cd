//! ξ and interleaving are integers' work: the same on a GPU as on the CPU, bit for bit.

use fastrand::Rng;
use gpu::{Gpu, Map};
use stochastic_light_culling::{Interleave, Seed, wgsl};

#[test]
fn every_xi_has_the_bits_of_the_crate() {
    let gpu = Gpu::new().unwrap();
    let map = Map {
        sources: &[wgsl::NUM, wgsl::LIGHT],
        input: "vec4u",
        output: "vec4u",
        body: "
            let seed = slc_frame(input.x, input.y);
            let xis = vec3f(slc_xi(seed, input.z), slc_xi_of_rank(seed, input.z), slc_hashed_xi(seed, input.z));
            return vec4u(bitcast<vec3u>(xis), slc_subregion_seed(input.x, input.w));",
    };
    let mut rng = Rng::with_seed(1);
    let mut word = || match rng.u8(0..8) {
        0 => 0,
        1 => u32::MAX,
        2 => rng.u32(0..1000),
        _ => rng.u32(..),
    };
    let inputs: Vec<_> = (0..1 << 20).map(|_| [(); 4].map(|()| word())).collect();
    let found: Vec<[u32; 4]> = gpu.map(&map, &inputs).unwrap();
    for (input, found) in inputs.iter().zip(found) {
        let [seed, frame, light, subregion] = *input;
        let Seed(of_subregion) = Seed(seed).subregion(subregion);
        let frame = Seed(seed).frame(frame);
        let xis = [
            frame.xi(light),
            frame.xi_of_rank(light),
            frame.hashed_xi(light),
        ];
        let [a, b, c] = xis.map(|xi| xi.get().to_bits());
        assert_eq!(found, [a, b, c, of_subregion], "{input:?}");
    }
}

/// Sums that carry into the exponent, and halves that go to even: all bits about powers of two.
#[test]
fn every_xi_is_rounded_to_nearest() {
    let gpu = Gpu::new().unwrap();
    let map = Map {
        sources: &[wgsl::NUM, wgsl::LIGHT],
        input: "u32",
        output: "f32",
        body: "return slc_xi_of_bits(input);",
    };
    let about = |shift: u32| {
        (0..2048_u32).map(move |i| (1_u32 << shift).wrapping_add(i).wrapping_sub(1024))
    };
    let halves = |shift: u32| (0..1024_u32).map(move |i| (0xFFFF_FC00 + i) >> shift);
    let inputs: Vec<u32> = (0..32)
        .flat_map(|shift| about(shift).chain(halves(shift)))
        .collect();
    let found: Vec<f32> = gpu.map(&map, &inputs).unwrap();
    for (bits, found) in inputs.into_iter().zip(found) {
        let exact = (f64::from(bits) + 1.0) / 4_294_967_296.0;
        assert_eq!(found, exact as f32, "{bits}");
    }
}

#[test]
fn interleaving_is_that_of_the_crate() {
    let gpu = Gpu::new().unwrap();
    let map = Map {
        sources: &[wgsl::VIEW],
        input: "vec4u",
        output: "array<vec4u, 3>",
        body: "
            let pixel = slc_split_pixel(input.x, input.yz);
            let light = slc_split_light(input.x, input.w);
            let joined = slc_join_pixel(input.x, pixel.subregion, pixel.local);
            return array<vec4u, 3>(
                vec4u(pixel.subregion, pixel.local, slc_lights_in(input.x, pixel.subregion, input.w)),
                vec4u(light, joined),
                vec4u(slc_join_light(input.x, light.x, light.y), 0u, 0u, 0u),
            );",
    };
    let mut rng = Rng::with_seed(2);
    let inputs: Vec<_> = (0..100_000)
        .map(|_| {
            [
                rng.u32(1..32),
                rng.u32(0..4096),
                rng.u32(0..4096),
                rng.u32(0..1 << 20),
            ]
        })
        .collect();
    let found: Vec<[[u32; 4]; 3]> = gpu.map(&map, &inputs).unwrap();
    for (input, [pixel, places, [light, ..]]) in inputs.into_iter().zip(found) {
        let [width, x, y, lights] = input;
        let interleave = Interleave::new([4096; 2], width).unwrap();
        let (subregion, [local_x, local_y]) = interleave.split_pixel([x, y]);
        let count = interleave.lights_in(subregion, lights);
        assert_eq!(pixel, [subregion, local_x, local_y, count], "{input:?}");
        let (of_light, local) = interleave.split_light(lights);
        assert_eq!(places, [of_light, local, x, y], "{input:?}");
        assert_eq!(light, lights, "{input:?}");
    }
}
