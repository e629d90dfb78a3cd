use glam::Vec3;

use super::ltc_lobes::LtcMembers;
use super::{Cap, Caps, LobeFamily, LtcLobe, Majorant, ReceiverLobe};
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
            round_up((sqrt_f64(square) + f64::from(own)) as f32, LENGTH_ROUNDINGS)
        })
    }
}

impl ReceiverLobe for LtcLobe {
    type Family = LtcFamily;

    fn family(&self) -> LtcFamily {
        let exact = self.lanes().rows();
        let rows = exact.map(|row| Vec3::from(Vector3::<f32>::narrow(row)));
        let squares = exact.map(Vector3::length_squared);
        let [_, determinant, third] = squares;
        let sum: f64 = squares.iter().sum();
        let apart = exact[1] - Vector3::<f32>::from(rows[1]).widen();
        let round = |length: f64| round_up(length as f32, LENGTH_ROUNDINGS);
        LtcFamily {
            normals: Cap::of_axis(self.normal()),
            amplitude: self.amplitude(),
            rows,
            // The second row alone is rounded.
            deviations: [0.0, round(apart.length())],
            norms: [round(sqrt_f64(third)), round(sqrt_f64(sum))],
            least_image: round_down((2.0 * determinant / sum) as f32, LENGTH_ROUNDINGS),
        }
    }
}

impl LobeFamily for LtcFamily {
    fn union(mut families: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let lit = families.clone().filter(|family| !family.is_empty());
        let Some(normals) = Cap::union(lit.clone().map(|family| family.normals)) else {
            return families.next();
        };
        let number = lit.clone().count() as f32;
        let rows = lit.clone().fold([Vec3::ZERO; 3], |mut rows, family| {
            for (row, own) in rows.iter_mut().zip(family.rows) {
                *row += own / number;
            }
            rows
        });
        let most = |[a, b]: [f32; 2], [c, d]: [f32; 2]| [a.max(c), b.max(d)];
        let around = lit.map(|family| Self {
            deviations: family.deviations_from(rows),
            ..family
        });
        let rest = around.reduce(|a, b| Self {
            amplitude: a.amplitude.max(b.amplitude),
            deviations: most(a.deviations, b.deviations),
            norms: most(a.norms, b.norms),
            least_image: a.least_image.min(b.least_image),
            ..a
        })?;
        Some(Self {
            normals,
            rows,
            ..rest
        })
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
