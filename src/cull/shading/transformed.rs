//! Transformed cosines that are made sixteen at a time.

use fearless_simd::{Level, Simd, dispatch};

use crate::base::Direction;
use crate::cull::culler::widest;
use crate::cull::lanes::{LANES, Lanes, load, parts, store};
use crate::lobe::{
    Fresnel, Ggx, GgxSurfaces, Incidence, LTC_NUMBERS, LobeNumbers, LtcLobe, LtcLobes,
};
use crate::num::F32Lanes;

impl LtcLobe {
    /// Makes the lobes that [`new`](Self::new) makes, with the same bits, sixteen at a time: of the lights of a frame,
    /// or of its receivers, in six tenths of the time.
    ///
    /// It takes up to sixteen surfaces ahead of the lobe that is asked for.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Direction, Ggx, Incidence, LtcLobe, Receiver, ReceiverBlock, Schlick, glam::Vec3,
    /// };
    ///
    /// let (ggx, gold) = (Ggx::new(0.2)?, Schlick::new(0.9)?);
    /// let eye = Vec3::new(0.0, 2.0, 0.0);
    /// let positions = || (0..16).map(|x| Vec3::new(x as f32, 0.0, 0.0));
    /// let surfaces = positions().flat_map(|position| {
    ///     let incoming = Direction::new(eye - position).ok()?;
    ///     Some((ggx, gold, Incidence { normal: Direction::Y, incoming }))
    /// });
    /// let lobes = LtcLobe::many(surfaces);
    /// let mut receivers = positions().zip(lobes).map(|(position, lobe)| Receiver { position, lobe });
    /// let block = ReceiverBlock::take(&mut receivers).expect("there are sixteen");
    /// assert_eq!(block.points().len(), 16);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn many<F: Fresnel>(
        surfaces: impl IntoIterator<Item = (Ggx, F, Incidence)>,
    ) -> impl Iterator<Item = Self> {
        Many {
            surfaces: surfaces.into_iter(),
            level: widest(),
            normals: [Direction::Z; LANES],
            made: [[0.0; LANES]; LTC_NUMBERS],
            reflected: [0.0; LANES],
            next: 0,
            len: 0,
        }
    }
}

/// Numbers of a surface: n, ω_i, α and F at normal and at grazing incidence.
const TAKEN: usize = 9;

/// Surfaces, and the lobes of some of them that are made.
struct Many<I> {
    surfaces: I,
    level: Level,
    normals: [Direction; LANES],
    /// The numbers of the lobes, and ρ.
    made: [Lanes; LTC_NUMBERS],
    reflected: Lanes,
    /// The lane of the next lobe.
    next: usize,
    len: usize,
}

impl<F: Fresnel, I: Iterator<Item = (Ggx, F, Incidence)>> Many<I> {
    fn make(&mut self) {
        let mut taken = [[0.0; LANES]; TAKEN];
        (self.next, self.len) = (0, 0);
        for (ggx, fresnel, incidence) in self.surfaces.by_ref().take(LANES) {
            let surface = GgxSurfaces::new(ggx, fresnel, incidence);
            for (lanes, number) in taken.iter_mut().zip(surface.numbers()) {
                lanes[self.len] = number;
            }
            self.normals[self.len] = incidence.normal;
            self.len += 1;
        }
        let (level, made, reflected) = (self.level, &mut self.made, &mut self.reflected);
        dispatch!(level, simd => make_in_lanes(simd, &taken, made, reflected));
    }
}

impl<F: Fresnel, I: Iterator<Item = (Ggx, F, Incidence)>> Iterator for Many<I> {
    type Item = LtcLobe;

    #[inline]
    fn next(&mut self) -> Option<LtcLobe> {
        if self.next == self.len {
            self.make();
            if self.len == 0 {
                return None;
            }
        }
        let lane = self.next;
        self.next += 1;
        let mut numbers: LobeNumbers<f32> = [0.0; _];
        for (number, lanes) in numbers.iter_mut().zip(&self.made) {
            *number = lanes[lane];
        }
        let made = LtcLobes::from_numbers(&numbers);
        let (normal, reflected) = (self.normals[lane], self.reflected[lane]);
        Some(LtcLobe::from_lanes(normal, &made, reflected))
    }
}

/// Makes the lobes of the surfaces that are `taken`.
#[inline(always)]
fn make_in_lanes<S: Simd>(
    simd: S,
    taken: &[Lanes; TAKEN],
    made: &mut [Lanes; LTC_NUMBERS],
    reflected: &mut Lanes,
) {
    for part in 0..parts::<S>() {
        let mut numbers = [F32Lanes::new(simd, 0.0); TAKEN];
        for (vector, lanes) in numbers.iter_mut().zip(taken) {
            *vector = load(simd, lanes, part);
        }
        let (lobes, of_lobes) = GgxSurfaces::of_numbers(numbers).lobes();
        for (lanes, vector) in made.iter_mut().zip(lobes.numbers()) {
            store(lanes, part, vector);
        }
        store(reflected, part, of_lobes);
    }
}
