use std::fmt;

/// Why nothing was dispatched, or nothing could be read.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// There is no Vulkan driver, or none with what the shaders need; with what the system says.
    Adapter(String),
    /// A shader, or what is bound to it, is not valid; with what the compiler or the interface says.
    Invalid(String),
    /// What the crate refuses, such as a buffer that is too small.
    Refused(stochastic_light_culling::Error),
    /// The device was lost, or ran out of time.
    Device(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adapter(message) => {
                write!(
                    f,
                    "no GPU that can run these shaders, and no software Vulkan driver: {message}"
                )
            }
            Self::Invalid(message) => write!(f, "not valid on this GPU: {message}"),
            Self::Refused(error) => error.fmt(f),
            Self::Device(message) => write!(f, "the GPU gave up: {message}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<stochastic_light_culling::Error> for Error {
    fn from(error: stochastic_light_culling::Error) -> Self {
        Self::Refused(error)
    }
}
