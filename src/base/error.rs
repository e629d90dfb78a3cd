use core::fmt;

use glam::{Mat3, Vec3};

/// An argument that a constructor rejects, with its value.
///
/// ```
/// use stochastic_light_culling::{Camera, Error, Ggx, TileGrid, glam::Mat4};
///
/// let error = Ggx::new(7.0).expect_err("too rough");
/// assert!(matches!(error, Error::Number { value: 7.0, .. }));
/// assert!(error.to_string().starts_with("roughness α is 7, but must be in (0, 1]"));
///
/// assert!(matches!(TileGrid::new([0, 9], 16), Err(Error::Size { .. })));
/// // The identity is not a perspective projection.
/// let camera = Camera::new(Mat4::IDENTITY, Mat4::IDENTITY);
/// assert!(matches!(camera, Err(Error::Matrix { .. })));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A number that is NaN or outside its valid range.
    Number {
        /// What the number stands for.
        quantity: &'static str,
        /// The number.
        value: f32,
        /// Its valid range.
        valid: &'static str,
    },
    /// A vector that is not finite, or that has no direction where one is needed.
    Vector {
        /// What the vector stands for.
        quantity: &'static str,
        /// The vector.
        value: Vec3,
        /// What it must be.
        valid: &'static str,
    },
    /// A size, an index or a count outside its valid range.
    Size {
        /// What the pair stands for.
        quantity: &'static str,
        /// The pair: width and height, or x and y.
        value: [u32; 2],
        /// What it must be.
        valid: &'static str,
    },
    /// A length or a number of items outside its valid range.
    Count {
        /// What is counted.
        quantity: &'static str,
        /// The number of them.
        value: usize,
        /// What it must be.
        valid: &'static str,
    },
    /// A matrix that is not of the required kind.
    Matrix {
        /// What the matrix stands for.
        quantity: &'static str,
        /// The element, or the deviation, that shows it.
        element: f32,
        /// What it must be.
        valid: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number {
                quantity,
                value,
                valid,
            } => write!(f, "{quantity} is {value}, but must be {valid}"),
            Self::Vector {
                quantity,
                value,
                valid,
            } => write!(f, "{quantity} is {value}, but must be {valid}"),
            Self::Count {
                quantity,
                value,
                valid,
            } => write!(f, "{quantity} is {value}, but must be {valid}"),
            Self::Size {
                quantity,
                value: [x, y],
                valid,
            } => write!(f, "{quantity} is {x}×{y}, but must be {valid}"),
            Self::Matrix {
                quantity,
                element,
                valid,
            } => write!(f, "{quantity} is not usable: {valid}, found {element}"),
        }
    }
}

impl core::error::Error for Error {}

/// Returns `value` if it lies in `range`, which NaN never does.
pub(crate) fn number_in(
    quantity: &'static str,
    value: f32,
    valid: &'static str,
    range: impl core::ops::RangeBounds<f32>,
) -> Result<f32, Error> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(Error::Number {
            quantity,
            value,
            valid,
        })
    }
}

/// Returns `value` if all its components are finite.
pub(crate) fn finite(quantity: &'static str, value: Vec3) -> Result<Vec3, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Vector {
            quantity,
            value,
            valid: "finite",
        })
    }
}

/// Returns the largest deviation of an element of RᵀR from the identity if it is at most `tolerance`.
pub(crate) fn orthonormal(
    quantity: &'static str,
    matrix: Mat3,
    tolerance: f32,
) -> Result<f32, Error> {
    let gram = matrix.transpose() * matrix - Mat3::IDENTITY;
    let largest = |column: Vec3| column.abs().max_element();
    let deviation = largest(gram.x_axis)
        .max(largest(gram.y_axis))
        .max(largest(gram.z_axis));
    if gram.is_finite() && deviation <= tolerance {
        Ok(deviation)
    } else {
        Err(Error::Matrix {
            quantity,
            element: deviation,
            valid: "its columns must be orthonormal; deviation of RᵀR from the identity",
        })
    }
}
