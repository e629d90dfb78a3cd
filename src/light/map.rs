use super::ClusterSums;
use super::pyramid::MipPyramid;
use crate::base::{Error, number_in};
use crate::num::power;

/// How many clusters to draw from a reflective shadow map, and how far they overlap: filtered importance sampling
/// [Křivánek & Colbert 2008; Tokuyoshi 2016].
///
/// A light is drawn at a place of the map with a density p that is proportional to the flux there. It stands for
/// the flux around, as far as N lights of that density need to cover the map. For smooth p that is a mip level
/// of the pyramid, so that a cluster costs a few reads, whatever the number of texels in it.
///
/// ```
/// use stochastic_light_culling::{
///     ClusterSums, Direction, FilteredSampling, MipPyramid, Seed, SphericalGaussian, glam::Vec3, pyramid_len,
/// };
///
/// // A lit floor of 4 × 4 m, 64 × 64 texels of 1 mW.
/// let dull = SphericalGaussian::diffuse(0.5, Direction::Y)?;
/// let dark = SphericalGaussian::new(Direction::Y, 0.0, 0.0)?;
/// let mut texels = vec![ClusterSums::EMPTY; pyramid_len([64, 64])?];
/// for (i, texel) in texels[..64 * 64].iter_mut().enumerate() {
///     let place = Vec3::new((i % 64) as f32, 0.0, (i / 64) as f32) / 16.0;
///     *texel = ClusterSums::of_light(place, 1e-3, &dull, &dark)?;
/// }
/// let map = MipPyramid::build([64, 64], &mut texels)?;
///
/// // Sixteen clusters, each with a sixteenth of the flux, about a metre wide.
/// let (sampling, seed) = (FilteredSampling::new(16, 1.0)?, Seed(0).frame(0));
/// for i in 0..sampling.count() {
///     let sample = map.sample(&sampling, seed.point(i)).expect("the map has flux");
///     let light = map.cluster(&sample).diffuse();
///     assert!((light.lobe().integral() / (64.0 * 64.0 * 0.5e-3 / 16.0) - 1.0).abs() < 1e-5);
///     assert!((0.3..1.3).contains(&light.spread()), "{}", light.spread());
/// }
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredSampling {
    count: u32,
    overlap: f32,
}

impl FilteredSampling {
    /// For `count` = N clusters, each of which gathers `overlap` = K times as much flux as the N-th part that it
    /// stands for. With K = 1 clusters meet edge to edge; more blurs, and varies less from one choice of places
    /// to another.
    ///
    /// # Errors
    ///
    /// [`Error::Count`] if `count` is zero, [`Error::Number`] if `overlap` is not in (0, ∞).
    pub fn new(count: u32, overlap: f32) -> Result<Self, Error> {
        if count == 0 {
            return Err(Error::Count {
                quantity: "number of clusters N",
                value: 0,
                valid: "at least 1",
            });
        }
        let valid = f32::MIN_POSITIVE..=f32::MAX;
        let overlap = number_in("overlap K of clusters", overlap, "in (0, ∞)", valid)?;
        Ok(Self { count, overlap })
    }

    /// The number N of clusters.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The overlap K.
    #[must_use]
    pub fn overlap(&self) -> f32 {
        self.overlap
    }
}

/// Where a cluster is in a reflective shadow map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredSample {
    /// The middle of its square, in \[0, 1\]² over the map.
    pub position: [f32; 2],
    /// The mip level whose texels are as large as the square.
    pub level: f32,
    /// How many texels' worth of the mean there the cluster is: 1/(N p̄) in texels. With it all clusters have
    /// the same flux. It is 4ˡ/K where the bisection has met its aim.
    pub texels: f32,
}

/// Steps of the bisection. The level is then known to 0.004.
const BISECTIONS: u32 = 12;

/// A reflective shadow map [Dachsbacher & Stamminger 2005]: what each texel reflects of the light through it, as
/// [`ClusterSums::of_light`]. Texels that see nothing are [`ClusterSums::EMPTY`].
impl MipPyramid<'_, ClusterSums> {
    /// Draws a cluster from two independent numbers in \[0, 1), which [`FrameSeed::point`](crate::FrameSeed::point)
    /// spreads evenly. `None` if the map has no flux.
    ///
    /// Draw with the points 0 to N−1 of one seed. The flux of N clusters is that of the map, for any numbers.
    /// Other sums, such as that of positions, are the map's in the mean, but for what p differs from its mean p̄
    /// over a cluster.
    #[must_use]
    pub fn sample(&self, sampling: &FilteredSampling, numbers: [f32; 2]) -> Option<FilteredSample> {
        let position = self.position_by_flux(numbers)?;
        let level = self.level_of_share(position, sampling.overlap / sampling.count as f32);
        let total = self.total().flux();
        let mean = self.mean_of(ClusterSums::flux, position, level);
        // Above zero, since the texel at the position has flux and a weight, but for subnormal numbers.
        let texels = total / (f64::from(sampling.count) * mean.max(f64::MIN_POSITIVE));
        Some(FilteredSample {
            position,
            level,
            texels: texels.min(f32::MAX.into()) as f32,
        })
    }

    /// The sums of a cluster: the mean there, as many times as the cluster has texels. A pyramid of colours of
    /// the same map is read with [`mean_at`](Self::mean_at) in the same way.
    #[must_use]
    pub fn cluster(&self, sample: &FilteredSample) -> ClusterSums {
        self.mean_at(sample.position, sample.level)
            .scaled(sample.texels)
    }

    /// The place, in \[0, 1\]² over the map, that two numbers in \[0, 1) are warped to, such that evenly
    /// distributed numbers have a density that is proportional to the flux of texels. `None` if the map has no
    /// flux.
    ///
    /// From the top down the numbers select one of four texels, first its column, then its row, and are rescaled
    /// within its share [Clarberg et al. 2005]. So points that are spread evenly remain so. Numbers below 0 count
    /// as 0, and so does NaN; those from 1 on count as nearly 1.
    #[must_use]
    pub fn position_by_flux(&self, numbers: [f32; 2]) -> Option<[f32; 2]> {
        // False for NaN.
        let has_flux = self.total().flux() > 0.0;
        if !has_flux {
            return None;
        }
        let mut rest = numbers.map(|number| f64::from(number.max(0.0)).min(BELOW_ONE));
        let mut texel = [0; 2];
        for level in (0..self.levels() - 1).rev() {
            let flux = |x, y| {
                let child = [2 * texel[0] + x, 2 * texel[1] + y];
                self.texel(level, child).map_or(0.0, ClusterSums::flux)
            };
            let [left, right] = [0, 1].map(|x| [flux(x, 0), flux(x, 1)]);
            let is_right = choose(&mut rest[0], left[0] + left[1], right[0] + right[1]);
            let [upper, lower] = if is_right { right } else { left };
            let is_lower = choose(&mut rest[1], upper, lower);
            texel = [
                2 * texel[0] + u32::from(is_right),
                2 * texel[1] + u32::from(is_lower),
            ];
        }
        let size = self.size();
        let along = |axis: usize| {
            let position = (f64::from(texel[axis]) + rest[axis]) / f64::from(size[axis]);
            position as f32
        };
        Some([along(0), along(1)])
    }

    /// The mip level at which a square around `position` holds the share `share` = K/N of the map's flux, by
    /// bisection [Tokuyoshi 2016, Algorithm 1].
    ///
    /// Zero where a texel holds more already, and in an empty map; the top level where all there is holds less.
    /// The flux around a position need not grow with the level, so there may be others that do. NaN counts as a
    /// share of zero.
    #[must_use]
    pub fn level_of_share(&self, position: [f32; 2], share: f32) -> f32 {
        let aim = f64::from(share) * self.total().flux();
        let [mut least, mut most] = [0.0, (self.levels() - 1) as f32];
        for _ in 0..BISECTIONS {
            let level = 0.5 * (least + most);
            let mean = self.mean_of(ClusterSums::flux, position, level);
            if f64::from(power(4.0, level)) * mean < aim {
                least = level;
            } else {
                most = level;
            }
        }
        0.5 * (least + most)
    }
}

/// The largest number below 1.
const BELOW_ONE: f64 = 1.0 - 0.5 * f64::EPSILON;

/// Whether `number` in \[0, 1) selects the second of two texels with these fluxes. The number is rescaled to
/// \[0, 1) within its share. A texel without flux is not selected unless both have none.
fn choose(number: &mut f64, first: f64, second: f64) -> bool {
    let cut = first / (first + second).max(f64::MIN_POSITIVE);
    let is_second = *number >= cut && second > 0.0;
    let rest = if is_second {
        (*number - cut) / (1.0 - cut)
    } else {
        *number / cut
    };
    // Zero for NaN, of nothing over nothing.
    *number = if rest > 0.0 { rest.min(BELOW_ONE) } else { 0.0 };
    is_second
}
