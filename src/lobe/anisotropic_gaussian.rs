use core::f64::consts::PI;

use glam::Vec3;

use super::spherical_gaussian::{direction_along, solid_angle};
use super::{AnisotropicGgx, Incidence, SphericalGaussian, SurfaceAxes, unit};
use crate::base::{Direction, Error, number_in};
use crate::num::{Vector3, exponential, sqrt_f64};

/// An anisotropic spherical Gaussian (ASG): c max(ω·ξ_z, 0) exp(−η_x(ω·ξ_x)² − η_y(ω·ξ_y)²)
/// [Xu et al. 2013; Tokuyoshi 2016, Sec. 4.2].
///
/// ξ_x, ξ_y and ξ_z are orthonormal; ξ_z is the axis. The bandwidths η_x and η_y say how narrow the lobe is
/// along ξ_x and ξ_y. An SG of sharpness λ is nearly the ASG with η_x = η_y = λ/2.
///
/// An ASG approximates what a microsurface reflects towards a viewer ([`specular`](Self::specular)): at a
/// slant such a lobe is narrower across the plane of incidence than along it.
///
/// ```
/// use stochastic_light_culling::{
///     AnisotropicGgx, AnisotropicSphericalGaussian, Direction, Incidence, SphericalGaussian, glam::Vec3,
/// };
///
/// let incidence = Incidence {
///     normal: Direction::Z,
///     incoming: Direction::new(Vec3::new(-3.0, 0.0, 1.0))?,
/// };
/// let ggx = AnisotropicGgx::new(0.1, 0.1)?;
/// let lobe = AnisotropicSphericalGaussian::specular(ggx, incidence, Direction::X)?;
/// let [along, across] = lobe.bandwidths();
/// assert!(across > 9.0 * along);
///
/// // The light of a smaller source around the axis, and of a larger one.
/// let light = |sharpness| SphericalGaussian::with_integral(lobe.axis(), sharpness, 1.0);
/// assert!(lobe.product_integral(&light(1000.0)?) > lobe.product_integral(&light(10.0)?));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnisotropicSphericalGaussian {
    /// ξ_x, ξ_y and ξ_z
    axes: [Direction; 3],
    bandwidths: [f32; 2],
    amplitude: f32,
}

impl AnisotropicSphericalGaussian {
    /// The largest bandwidth, 2³⁸: that of a microsurface of the least roughness, at normal incidence.
    pub const MAX_BANDWIDTH: f32 = 274_877_906_944.0;

    /// Creates the ASG about `axis` = ξ_z, with ξ_x along the part of `tangent` that is perpendicular to it,
    /// with the `bandwidths` \[η_x, η_y\], and with the `amplitude` c.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `tangent` is parallel to `axis` to within 10⁻⁶ radians; [`Error::Number`] if a
    /// bandwidth is outside \[0, [`MAX_BANDWIDTH`](Self::MAX_BANDWIDTH)\], `amplitude` is negative or
    /// infinite, or one of them is NaN.
    pub fn new(
        axis: Direction,
        tangent: Direction,
        bandwidths: [f32; 2],
        amplitude: f32,
    ) -> Result<Self, Error> {
        let [first, second] = bandwidths;
        let bandwidth = |bandwidth| {
            let valid = 0.0..=Self::MAX_BANDWIDTH;
            number_in("ASG bandwidth η", bandwidth, "in [0, 2³⁸]", valid)
        };
        let [x, y, _] = orthonormal_axes(axis, tangent)?;
        Ok(Self {
            axes: [x, y, axis],
            bandwidths: [bandwidth(first)?, bandwidth(second)?],
            amplitude: number_in("ASG amplitude", amplitude, "in [0, ∞)", 0.0..=f32::MAX)?,
        })
    }

    /// Approximates by an ASG of unit amplitude how the light that a GGX microsurface sends to a viewer
    /// depends on the direction ω that the light comes from: D(ω_h)/D(n), with ω_h the half vector.
    ///
    /// `incidence` has the direction to the viewer; `tangent` is that of α_x, and is arbitrary where
    /// α_x = α_y. The axis is the mirror direction. Let J be the derivative of ω_h by ω there: ½ in the plane
    /// of incidence and 1/(2μ) across it, turned by the azimuth of that plane. Then the bandwidths are the
    /// eigenvalues of Jᵀ diag(1/α_x², 1/α_y²) J, and ξ_x and ξ_y are its eigenvectors. Bandwidths above
    /// [`MAX_BANDWIDTH`](Self::MAX_BANDWIDTH) are lowered to that. The ASG is zero everywhere if the viewer is
    /// not above the surface.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `tangent` is parallel to the normal to within 10⁻⁶ radians.
    pub fn specular(
        ggx: AnisotropicGgx,
        incidence: Incidence,
        tangent: Direction,
    ) -> Result<Self, Error> {
        let Incidence { normal, incoming } = incidence;
        let surface = orthonormal_axes(normal, tangent)?.map(|axis| unit(Vector3::from(axis)));
        let [along, across, up] = surface;
        let view = unit(Vector3::from(incoming));
        let cosine = view.dot(up);
        let mirror = incoming.mirrored(normal);
        let is_visible = cosine > 0.0;
        // In the frame of the surface: the cosine and sine of the azimuth of the plane of incidence.
        let (x, y) = (view.dot(along), view.dot(across));
        let sine = sqrt_f64(x * x + y * y);
        let (c, s) = if sine > 1e-12 {
            (-x / sine, -y / sine)
        } else {
            (1.0, 0.0)
        };
        // Least cosine for which the bandwidths stay finite; they are lowered anyway.
        let cosine = cosine.max(1e-12);
        let [p, q] = ggx.roughness().map(|alpha| {
            let alpha = f64::from(alpha);
            1.0 / (alpha * alpha)
        });
        // Jᵀ diag(p, q) J in the axes in and across the plane of incidence.
        let first = 0.25 * (p * c * c + q * s * s);
        let mixed = 0.25 * (q - p) * c * s / cosine;
        let second = 0.25 * (p * s * s + q * c * c) / (cosine * cosine);
        let eigen = Eigen::of(first, mixed, second);
        // ξ_x for the azimuth alone: in the plane of incidence, at right angles to the mirror direction.
        let plane = along * c + across * s;
        let axis = unit(Vector3::from(mirror));
        let aside = up.cross(plane);
        let inward = aside.cross(axis);
        let x = inward * eigen.cosine + aside * eigen.sine;
        let x = x - axis * axis.dot(x);
        let x = direction_along(x, x.length()).unwrap_or(tangent);
        let bandwidths = eigen
            .values
            .map(|value| value.min(Self::MAX_BANDWIDTH.into()) as f32);
        let amplitude = if is_visible { 1.0 } else { 0.0 };
        Self::new(mirror, x, bandwidths, amplitude)
    }

    /// The same ASG with its amplitude multiplied by `factor`, which counts as zero if it is negative or NaN.
    /// An amplitude above the largest `f32` is that.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        let factor = factor.max(0.0);
        let amplitude = f64::from(self.amplitude) * f64::from(factor);
        Self {
            amplitude: amplitude.min(f32::MAX.into()) as f32,
            ..self
        }
    }

    /// The axis ξ_z.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axes[2]
    }

    /// The axes ξ_x and ξ_y.
    #[must_use]
    pub fn tangents(&self) -> [Direction; 2] {
        let [x, y, _] = self.axes;
        [x, y]
    }

    /// The bandwidths \[η_x, η_y\].
    #[must_use]
    pub fn bandwidths(&self) -> [f32; 2] {
        self.bandwidths
    }

    /// The amplitude c, the value towards the axis.
    #[must_use]
    pub fn amplitude(&self) -> f32 {
        self.amplitude
    }

    /// The value towards the unit vector `direction`. Zero at right angles to the axis and beyond, and for
    /// NaN.
    #[must_use]
    pub fn value(&self, direction: Vec3) -> f32 {
        let bandwidths = self.bandwidths.map(f64::from);
        let shape = self.shape(Vector3::from(direction).widen(), bandwidths);
        (f64::from(self.amplitude) * shape) as f32
    }

    /// The value of the ASG with the same axes, other `bandwidths` and unit amplitude.
    fn shape(&self, direction: Vector3<f64>, [first, second]: [f64; 2]) -> f64 {
        let [x, y, z] = self
            .axes
            .map(|axis| Vector3::from(axis).widen().dot(direction));
        if z > 0.0 {
            // Finite for directions that are not.
            z.min(1.0) * exponential(-(first * x * x + second * y * y))
        } else {
            0.0
        }
    }

    /// Approximates ∫ v(ω) g(ω) dω, where v is this ASG and g the SG `gaussian`
    /// [Xu et al. 2013; Tokuyoshi 2016, Sec. 4.2].
    ///
    /// With ν = λ/2 it is π c_v c_g/√((η_x+ν)(η_y+ν)) times the shape of the ASG with the bandwidths
    /// ην/(η+ν) at the SG's axis. It is within 5 % for η ≥ 5 and an SG whose axis is up to 0.3 radians off, unless the
    /// product is below a twentieth of its largest. It
    /// is far too small, down to zero, where the SG's axis is near the ASG's horizon or below it, although
    /// a broad SG still meets the lobe. Broad lobes, for which the formula has no bound, are limited by the
    /// integrals π c_v c_g and A(λ) c_v c_g of either of the two.
    #[must_use]
    pub fn product_integral(&self, gaussian: &SphericalGaussian) -> f32 {
        let half = 0.5 * f64::from(gaussian.sharpness());
        let [first, second] = self.bandwidths.map(f64::from);
        let sums = [first + half, second + half];
        // Zero for two flat lobes.
        let product = (sums[0] * sums[1]).max(f64::MIN_POSITIVE);
        let narrowed = [first, second].map(|bandwidth| {
            let sum = (bandwidth + half).max(f64::MIN_POSITIVE);
            bandwidth * half / sum
        });
        let shape = self.shape(Vector3::from(gaussian.axis()).widen(), narrowed);
        let most = PI.min(solid_angle(f64::from(gaussian.sharpness())));
        let integral = (PI / sqrt_f64(product) * shape).min(most);
        let amplitude = f64::from(self.amplitude) * f64::from(gaussian.amplitude());
        (amplitude * integral).min(f32::MAX.into()) as f32
    }
}

/// The unit vectors along the part of `tangent` that is perpendicular to `axis`, across both, and along
/// `axis`.
fn orthonormal_axes(axis: Direction, tangent: Direction) -> Result<[Direction; 3], Error> {
    let SurfaceAxes { axes, sine } = SurfaceAxes::new(Vector3::from(axis), tangent.into());
    if sine < 1e-6 {
        return Err(Error::Vector {
            quantity: "tangent",
            value: *tangent,
            valid: "not parallel to the axis",
        });
    }
    Ok(axes.map(|axis| Direction::from_unit(Vector3::narrow(axis).into())))
}

/// The eigenvalues of a symmetric matrix with positive determinant, and the cosine and sine of the angle of
/// the first eigenvector.
struct Eigen {
    values: [f64; 2],
    cosine: f64,
    sine: f64,
}

impl Eigen {
    /// Of the matrix with `first` and `second` on its diagonal and `mixed` off it. The eigenvector of the
    /// smaller eigenvalue lies along (h − D, −2m) and (2m, −h − D), where D = `first` − `second` and
    /// h = √(D² + 4m²); the one that does not cancel is used.
    fn of(first: f64, mixed: f64, second: f64) -> Self {
        let difference = first - second;
        let h = sqrt_f64(difference * difference + 4.0 * mixed * mixed);
        let larger = 0.5 * (first + second + h);
        // The determinant over the larger; both terms of it are finite.
        let smaller = (first * (second / larger) - mixed * (mixed / larger)).max(0.0);
        let (x, y) = if difference <= 0.0 {
            (h - difference, -2.0 * mixed)
        } else {
            (2.0 * mixed, -h - difference)
        };
        let length = sqrt_f64(x * x + y * y);
        if length > 0.0 {
            Self {
                values: [smaller, larger],
                cosine: x / length,
                sine: y / length,
            }
        } else {
            // A circle has no axes of its own.
            Self {
                values: [smaller, larger],
                cosine: 1.0,
                sine: 0.0,
            }
        }
    }
}
