//! Interleaving is a renumbering: each pixel and each light has one place, and each place one of them.

use proptest::prelude::*;
use stochastic_light_culling::{Interleave, PixelRectangle};
use support::generators;

proptest! {
    #![proptest_config(generators::cases(300))]

    #[test]
    fn pixels_are_renumbered(width in 1..90_u32, height in 1..90_u32, w in 1..10_u32) {
        prop_assume!(w <= width.min(height));
        let interleave = Interleave::new([width, height], w).unwrap();
        let image = PixelRectangle { min: [0, 0], max: [width, height] };
        for pixel in image.pixels() {
            let (subregion, local) = interleave.split_pixel(pixel);
            let size = interleave.subregion_size(subregion);
            prop_assert!(subregion < interleave.subregions());
            prop_assert!(local[0] < size[0] && local[1] < size[1]);
            prop_assert_eq!(interleave.join_pixel(subregion, local), pixel);
        }
        // As many places as pixels, so that the map, one to one as it is, misses none.
        let places: u32 = (0..interleave.subregions())
            .map(|s| interleave.subregion_size(s).iter().product::<u32>())
            .sum();
        prop_assert_eq!(places, width * height);
    }

    #[test]
    fn lights_are_renumbered(lights in 0..5000_u32, w in 1..10_u32) {
        let interleave = Interleave::new([64, 64], w).unwrap();
        for light in 0..lights {
            let (subregion, local) = interleave.split_light(light);
            prop_assert!(subregion < interleave.subregions());
            prop_assert!(local < interleave.lights_in(subregion, lights));
            prop_assert_eq!(interleave.join_light(subregion, local), light);
        }
        let places: u32 = (0..interleave.subregions()).map(|s| interleave.lights_in(s, lights)).sum();
        prop_assert_eq!(places, lights);
    }

    #[test]
    fn a_tile_of_a_subregion_spans_its_pixels(
        w in 1..9_u32,
        subregion in any::<prop::sample::Index>(),
        min in (0..5_u32, 0..5_u32),
        size in (1..6_u32, 1..6_u32),
    ) {
        let interleave = Interleave::new([100, 100], w).unwrap();
        let subregion = subregion.index(interleave.subregions() as usize) as u32;
        let local = PixelRectangle { min: [min.0, min.1], max: [min.0 + size.0, min.1 + size.1] };
        let joined = interleave.join_pixels(subregion, local);
        for pixel in local.pixels().map(|pixel| interleave.join_pixel(subregion, pixel)) {
            prop_assert!(joined.pixels().any(|of_tile| of_tile == pixel));
        }
        prop_assert_eq!(joined.min, interleave.join_pixel(subregion, local.min));
        prop_assert_eq!(joined.max[0] - joined.min[0], (size.0 - 1) * w + 1);
    }
}

/// No panic, and nothing inside the image, for what is outside it.
#[test]
fn places_that_do_not_exist_are_outside() {
    let interleave = Interleave::new([64, 48], 7).unwrap();
    for subregion in [0, 48, 49, u32::MAX] {
        for local in [[u32::MAX; 2], [1 << 30, u32::MAX / 7]] {
            let [x, y] = interleave.join_pixel(subregion, local);
            assert!(x >= 64 && y >= 48);
            let max = local;
            let joined = interleave.join_pixels(subregion, PixelRectangle { min: max, max });
            assert!(joined.max.into_iter().all(|n| n >= 64));
        }
        let light = interleave.join_light(subregion, u32::MAX);
        assert!(light >= u32::MAX / 2);
        assert!(interleave.lights_in(subregion, u32::MAX) <= u32::MAX / 49 + 1);
    }
}
