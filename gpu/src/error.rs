use std::fmt;

/// Why nothing was dispatched, or nothing could be read.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// There is no Vulkan driver, or none with what the shaders need; with what the system says.
    Adapter(String),
    /// A shader, or what is bound to it, is not valid; with what the compiler or the interface says.
    Invalid(String),
    /// A buffer holds fewer bytes than what is asked of it.
    Size {
        /// What the buffer is for.
        buffer: &'static str,
        /// Its size in bytes.
        bytes: u64,
        /// The least size in bytes that it needs.
        needed: u64,
    },
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
            Self::Size {
                buffer,
                bytes,
                needed,
            } => {
                write!(
                    f,
                    "the buffer of {buffer} has {bytes} bytes, and needs {needed}"
                )
            }
            Self::Device(message) => write!(f, "the GPU gave up: {message}"),
        }
    }
}

impl std::error::Error for Error {}
