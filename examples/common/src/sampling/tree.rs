//! A light tree [Conty Estevez & Kulla 2018], with eight children a node.

use fearless_simd::{Level, Simd, dispatch};
use rayon::prelude::*;
use stochastic_light_culling::{Receiver, Seed, glam::Vec3};

use super::group::{Cluster, Group, WIDTH};
use super::pixels::{Drawing, Drawn, shade_drawn};
use super::{Profile, Profiled};
use crate::frame::{Frame, GlossyLight};

/// Deeper than any tree of 2³² lights.
const DEPTH: usize = 11;

/// The lights of each subregion as a tree.
pub struct LightTrees {
    trees: Vec<Tree>,
}

struct Tree {
    /// The nodes of each level, the leaves first: each node is a group, and the groups below it are those of its clusters.
    levels: Vec<Vec<Group>>,
    /// The lights in the order of the leaves.
    lights: Vec<u32>,
}

impl LightTrees {
    /// The lights of a frame come sorted along a curve, which makes neighbours of those that shine on the same places.
    pub fn new(frame: &Frame, lights: &[GlossyLight]) -> Self {
        let interleave = &frame.interleave;
        let tree = |subregion| {
            let count = interleave.lights_in(subregion, lights.len() as u32);
            let indices = (0..count).map(|local| interleave.join_light(subregion, local));
            Tree::new(lights, indices.collect())
        };
        let subregions = 0..interleave.subregions();
        Self {
            trees: subregions.into_par_iter().map(tree).collect(),
        }
    }
}

impl Tree {
    fn new(all: &[GlossyLight], lights: Vec<u32>) -> Self {
        let mut clusters: Vec<Cluster> = lights
            .iter()
            .map(|light| Cluster::of_light(&all[*light as usize]))
            .collect();
        let mut levels = Vec::new();
        while !clusters.is_empty() {
            levels.push(clusters.chunks(WIDTH).map(Group::new).collect::<Vec<_>>());
            if clusters.len() <= WIDTH {
                break;
            }
            clusters = clusters.chunks(WIDTH).map(Cluster::union).collect();
        }
        Self { levels, lights }
    }

    /// Draws lights: those that are as important as `delta` for certain, and others with the probability of their
    /// importance over `delta`.
    ///
    /// A node that is as important as `delta` is split: each of its children is looked at. Of a lesser one at most one
    /// light is drawn, on the way down by the importance of children. Lesser nodes have a part of a line each, as long as
    /// they are probable. Those are drawn whose part holds one of the numbers ξ, 1 + ξ, 2 + ξ and so on.
    #[inline(always)]
    fn draw(
        &self,
        (point, profile): (Vec3, &Profile),
        least_distance_squared: f32,
        (delta, xi): (f32, f64),
        drawn: &mut Drawn,
    ) {
        let Some(top) = self.levels.len().checked_sub(1) else {
            return;
        };
        let mut stack = [Node::default(); DEPTH * WIDTH];
        // The root is split, whatever its importance.
        stack[0].level = top;
        let (mut height, mut line) = (1, 0.0);
        while height > 0 {
            height -= 1;
            let Node { level, place, part } = stack[height];
            let group = &self.levels[level][place];
            let importances = group.importances(point, profile, least_distance_squared);
            let (mut from, scale) = match part {
                None => (line, f64::from(1.0 / delta)),
                Some([from, to]) => {
                    let sum: f64 = importances.iter().copied().map(f64::from).sum();
                    (from, if sum > 0.0 { (to - from) / sum } else { 0.0 })
                }
            };
            for (child, importance) in importances.into_iter().enumerate() {
                let probability = f64::from(importance) * scale;
                let place = place * WIDTH + child;
                let part = if part.is_none() && probability >= 1.0 {
                    None
                } else {
                    let to = from + probability;
                    let part = [from, to];
                    from = to;
                    if (part[0] - xi).ceil() >= (to - xi).ceil() {
                        continue;
                    }
                    Some(part)
                };
                if level == 0 {
                    let weight = part.map_or(1.0, |[from, to]| 1.0 / (to - from));
                    drawn.push(self.lights[place], weight as f32);
                } else {
                    let level = level - 1;
                    stack[height] = Node { level, place, part };
                    height += 1;
                }
            }
            if part.is_none() {
                line = from;
            }
        }
    }
}

/// A node that lights are looked for in.
#[derive(Clone, Copy, Default)]
struct Node {
    level: usize,
    place: usize,
    /// Of the line. None if it is split.
    part: Option<[f64; 2]>,
}

/// The radiance that each of `receivers` reflects to the eye, by the lights that it draws of `trees`: all
/// with an estimated contribution of `delta` or more, and others by roulette.
pub fn shade_by_tree<R: Profiled>(
    frame: &Frame,
    lights: &[GlossyLight],
    trees: &LightTrees,
    receivers: &[Option<Receiver<R>>],
    delta: f32,
    seed: Seed,
) -> Vec<Vec3> {
    let level = Level::try_detect().unwrap_or(Level::baseline());
    let draw = |drawing: &Drawing, receiver: &Receiver<R>, drawn: &mut Drawn| {
        let tree = &trees.trees[drawing.subregion as usize];
        let xi = f64::from(drawing.xi(seed).get());
        let profile = receiver.lobe.profile();
        let (at, least) = ((receiver.position, &profile), frame.least_distance_squared);
        dispatch!(level, simd => draw_in_lanes(simd, tree, at, least, (delta, xi), drawn));
    };
    let sum = |_: &Drawing, drawn: &[u32], weights: &[f32], reflected: &[f32]| {
        let each = drawn.iter().zip(weights).zip(reflected);
        each.map(|((light, weight), reflected)| weight * reflected * lights[*light as usize].tint)
            .sum()
    };
    shade_drawn(frame, lights, receivers, draw, sum)
}

/// Compiled for the vectors of this processor.
#[inline(always)]
fn draw_in_lanes<S: Simd>(
    _: S,
    tree: &Tree,
    at: (Vec3, &Profile),
    least_distance_squared: f32,
    numbers: (f32, f64),
    drawn: &mut Drawn,
) {
    tree.draw(at, least_distance_squared, numbers, drawn);
}
