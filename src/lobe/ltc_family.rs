use glam::Vec3;

use super::cap_union::{CapMean, CapReach, CapSum};
use super::ltc_majorant::{LtcMembers, rounding_of_rows};
use super::{Cap, Caps, LobeFamily, LtcLobe, Majorant, ReceiverLobe};
use crate::base::Direction;
use crate::num::{Single, Vector3, round_down, round_up, sqrt_f64};

/// Budget for lengths that are rounded to single precision.
const LENGTH_ROUNDINGS: u16 = 2;

/// What stands for many [`LtcLobe`]s: the mean of their matrices M⁻¹ and how far they are from it, a cap of normals, and
/// the greatest amplitude.
///
/// A matrix R at the distance ε of the mean R̄, in the norm of all elements, takes ω to no less than ‖R̄ω‖ − ε, and no
/// more than as much higher. So distances of matrices are what chords are of directions, and both add. They nest as
/// chords do: a union's ε is at least the distance of two means and the lesser ε together, and where the mean moves by
/// less than that, so do its images.
///
/// Empty lobes reflect nothing, so a union leaves them out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcFamily {
    normals: Cap,
    /// Zero if there is no member.
    amplitude: f32,
    /// The rows of R̄.
    rows: [Vec3; 3],
    /// The greatest distance of a third row from that of R̄, and of a matrix from R̄.
    deviations: [f32; 2],
    /// The greatest length of a third row, and the greatest norm of a matrix.
    norms: [f32; 2],
    /// The least ‖Rω‖ of all matrices and directions.
    least_image: f32,
}

impl LtcFamily {
    fn is_empty(&self) -> bool {
        self.amplitude <= 0.0
    }

    /// How far the matrices are from one with these rows.
    fn deviations_from(&self, rows: [Vec3; 3]) -> [f32; 2] {
        let mut squares = [0.0; 3];
        for (square, (own, row)) in squares.iter_mut().zip(self.rows.iter().zip(rows)) {
            let apart = Vector3::<f32>::from(*own).widen() - Vector3::<f32>::from(row).widen();
            *square = apart.length_squared();
        }
        let [x, y, z] = squares;
        let [of_row, of_all] = self.deviations;
        [(z, of_row), (x + y + z, of_all)].map(|(square, own)| {
            if square > 0.0 {
                round_up((sqrt_f64(square) + f64::from(own)) as f32, LENGTH_ROUNDINGS)
            } else {
                own
            }
        })
    }
}

/// The sum of families.
#[derive(Clone, Copy, Debug, Default)]
pub struct LtcSum {
    normals: CapSum,
    rows: [Vec3; 3],
    count: f32,
    /// All but normals, rows and deviations.
    family: LtcFamily,
}

impl Default for LtcFamily {
    /// The family of no lobe, to whose numbers any others are joined unchanged.
    fn default() -> Self {
        Self {
            normals: Cap::of_axis(Direction::Z),
            amplitude: 0.0,
            rows: [Vec3::ZERO; 3],
            deviations: [0.0; 2],
            norms: [0.0; 2],
            least_image: f32::MAX,
        }
    }
}

/// The greater of both, one by one.
fn most([a, b]: [f32; 2], [c, d]: [f32; 2]) -> [f32; 2] {
    [a.max(c), b.max(d)]
}

impl ReceiverLobe for LtcLobe {
    type Family = LtcFamily;

    fn family(&self) -> LtcFamily {
        let exact = self.lanes().rows();
        let rows = exact.map(|row| Vec3::from(Vector3::<f32>::narrow(row)));
        let squares = exact.map(Vector3::length_squared);
        let [first, determinant, third] = squares;
        let sum: f64 = squares.iter().sum();
        let rounding = rounding_of_rows(first, determinant);
        let least_image = (2.0 * determinant / sum - rounding).max(0.0);
        let [apart, apart_too, _] = [0, 1, 2].map(|i| {
            let rounded = Vector3::<f32>::from(rows[i]).widen();
            (exact[i] - rounded).length_squared()
        });
        let round = |length: f64| round_up(length as f32, LENGTH_ROUNDINGS);
        LtcFamily {
            normals: Cap::of_axis(self.normal()),
            amplitude: self.amplitude(),
            rows,
            // The third row alone is exact, here and in the value.
            deviations: [0.0, round(sqrt_f64(apart + apart_too) + rounding)],
            norms: [round(sqrt_f64(third)), round(sqrt_f64(sum))],
            least_image: round_down(least_image as f32, LENGTH_ROUNDINGS),
        }
    }
}

impl LobeFamily for LtcFamily {
    type Sum = LtcSum;
    /// A family without chords and deviations, and its normals.
    type Mean = (Self, CapMean);
    /// The reach of normals, and the deviations.
    type Reach = (CapReach, [f32; 2]);

    fn add_to(&self, sum: &mut LtcSum) {
        if self.is_empty() {
            return;
        }
        sum.normals.add(&self.normals);
        for (row, own) in sum.rows.iter_mut().zip(self.rows) {
            *row += own;
        }
        sum.count += 1.0;
        sum.family = Self {
            amplitude: sum.family.amplitude.max(self.amplitude),
            norms: most(sum.family.norms, self.norms),
            least_image: sum.family.least_image.min(self.least_image),
            ..sum.family
        };
    }

    fn mean(sum: &LtcSum) -> Self::Mean {
        let family = Self {
            rows: sum.rows.map(|row| row / sum.count.max(1.0)),
            ..sum.family
        };
        (family, sum.normals.mean())
    }

    fn widen(&self, (family, normals): &Self::Mean, reach: &mut Self::Reach) {
        if !self.is_empty() {
            normals.widen(&self.normals, &mut reach.0);
            reach.1 = most(reach.1, self.deviations_from(family.rows));
        }
    }

    fn around((family, normals): &Self::Mean, (of_normals, deviations): &Self::Reach) -> Self {
        Self {
            normals: normals.cap(of_normals),
            deviations: *deviations,
            ..*family
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let amplitude = cap.splat(self.amplitude);
        let members = LtcMembers {
            normals: self.normals.splat(amplitude),
            amplitude,
            rows: self.rows.map(
                #[inline(always)]
                |row| Vector3::splat(amplitude, row.into()).widen(),
            ),
            deviations: in_lanes(cap, self.deviations),
            norms: in_lanes(cap, self.norms),
            least_image: cap.splat(self.least_image).widen(),
        };
        members.majorant(cap)
    }
}

#[inline(always)]
fn in_lanes<N: Single>(cap: &Caps<N>, numbers: [f32; 2]) -> [N::Double; 2] {
    numbers.map(
        #[inline(always)]
        |number| cap.splat(number).widen(),
    )
}
