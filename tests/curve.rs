//! Ranks along the Hilbert curve: each once, neighbours near each other, and bad points defined.

use proptest::prelude::*;
use stochastic_light_culling::{Error, glam::Vec3, rank_along_curve};

fn ranks(points: &[Vec3]) -> Vec<u32> {
    let (mut ranks, mut scratch) = (vec![7; points.len()], vec![7; 2 * points.len()]);
    rank_along_curve(points, &mut ranks, &mut scratch).expect("buffers fit");
    ranks
}

/// Points along the curve.
fn sorted(points: &[Vec3]) -> Vec<Vec3> {
    let mut sorted = points.to_vec();
    for (point, rank) in points.iter().zip(ranks(points)) {
        sorted[rank as usize] = *point;
    }
    sorted
}

fn in_order(count: usize) -> Vec<u32> {
    (0..count as u32).collect()
}

fn any_point() -> impl Strategy<Value = Vec3> {
    let number = prop_oneof![
        4 => -10.0..10.0_f32,
        1 => any::<u32>().prop_map(f32::from_bits),
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY), Just(f32::MAX)],
    ];
    proptest::array::uniform3(number).prop_map(Vec3::from)
}

proptest! {
    #[test]
    fn each_rank_occurs_once(points in proptest::collection::vec(any_point(), 0..300)) {
        let mut ranks = ranks(&points);
        ranks.sort_unstable();
        prop_assert_eq!(ranks, in_order(points.len()));
    }

    /// No place and no size of a scene is better than another.
    #[test]
    fn neither_place_nor_size_matters(log_scale in -60..60_i32, offset in proptest::array::uniform3(-16..16_i8)) {
        let points = cloud(500);
        let scale = (log_scale as f32).exp2();
        let offset = Vec3::from(offset.map(f32::from));
        // Multiples of 2⁻¹² whose sums are exact.
        let points: Vec<Vec3> = points.iter().map(|p| (*p * 4096.0).round() / 4096.0).collect();
        let moved: Vec<Vec3> = points.iter().map(|p| (*p + offset) * scale).collect();
        prop_assert_eq!(ranks(&points), ranks(&moved));
    }
}

/// Points in the unit cube.
fn cloud(count: u32) -> Vec<Vec3> {
    let mut rng = fastrand::Rng::with_seed(3);
    (0..count)
        .map(|_| Vec3::new(rng.f32(), rng.f32(), rng.f32()))
        .collect()
}

/// The way along the curve through points of a cube is not much longer than the shortest, which is about
/// 0.7·n^⅔ for n points in a unit cube. In random order it is 15 times as long.
#[test]
fn the_way_along_the_curve_is_short() {
    let points = sorted(&cloud(4096));
    let way: f32 = points
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    let shortest = 0.7 * 4096_f32.cbrt().powi(2);
    assert!(way < 1.5 * shortest, "{way} {shortest}");
}

#[test]
fn points_at_one_place_keep_their_order() {
    for point in [
        Vec3::ZERO,
        Vec3::new(-3.0, 1e30, 1e-40),
        Vec3::NAN,
        Vec3::INFINITY,
        Vec3::MAX,
    ] {
        assert_eq!(ranks(&[point; 100]), in_order(100), "{point}");
    }
    assert_eq!(ranks(&[]), []);
}

/// A coordinate that is not a number counts as the least one, and moves no other point.
#[test]
fn bad_points_leave_the_others_alone() {
    let points = cloud(200);
    let least = points.iter().copied().reduce(Vec3::min).unwrap();
    for (bad, like) in [
        (Vec3::NAN, least),
        (Vec3::new(f32::NAN, 0.5, 0.5), Vec3::new(least.x, 0.5, 0.5)),
        (Vec3::new(0.5, 0.5, f32::NAN), Vec3::new(0.5, 0.5, least.z)),
    ] {
        let with = |point| {
            let mut points = points.clone();
            points.insert(77, point);
            ranks(&points)
        };
        assert_eq!(with(bad), with(like), "{bad}");
    }
}

#[test]
fn buffers_that_do_not_fit_are_refused() {
    let points = cloud(10);
    let refused = |ranks: usize, scratch: usize| {
        let result = rank_along_curve(&points, &mut vec![0; ranks], &mut vec![0; scratch]);
        matches!(result, Err(Error::Count { .. }))
    };
    assert!(refused(9, 20) && refused(11, 22) && refused(10, 19) && refused(0, 0));
    assert!(!refused(10, 20) && !refused(10, 100));
}
