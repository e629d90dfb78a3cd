//! The buffers of the kernels.

use super::{GpuFrame, GpuLight, GpuProjected};
use crate::base::Error;

/// A buffer that kernels bind, in group 0.
///
/// [`GpuFrame::bytes`] says how large it must be, and [`GpuFrame::check`] whether it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum GpuBuffer {
    /// A uniform buffer with a [`GpuFrame`]. Binding 0.
    Frame = 0,
    /// A [`GpuLight`] for each light. Binding 1; read.
    Lights = 1,
    /// A [`GpuProjected`] for each light. Binding 2; written by the kernel of bounds.
    Projected = 2,
    /// The random number ξ of each light, an `f32`. Binding 3; written by the kernel of bounds.
    Xis = 3,
    /// The edges of tiles, pairs of `f32`: [`GpuFrame::edges`]. Binding 4; read.
    Edges = 4,
    /// The depth intervals of each tile of each subregion, pairs of `f32`; one whose first number is the greater has no
    /// surfaces. Binding 5; written by the kernel of depths, or by the caller.
    Intervals = 5,
    /// Where the list of each interval begins and ends, pairs of `u32`. Binding 6; written by the kernel of lists.
    Ranges = 6,
    /// The indices of the lights of all lists, `u32`. Binding 7; written by the kernel of lists.
    Lists = 7,
    /// How many indices all lists together have, whether there was room or not: one `u32`, which must be zero before the
    /// kernel of lists runs. Binding 8.
    Needed = 8,
}

impl GpuBuffer {
    /// All buffers, in the order of their bindings.
    pub const ALL: [Self; 9] = [
        Self::Frame,
        Self::Lights,
        Self::Projected,
        Self::Xis,
        Self::Edges,
        Self::Intervals,
        Self::Ranges,
        Self::Lists,
        Self::Needed,
    ];

    /// The number of its binding.
    #[must_use]
    pub fn binding(self) -> u32 {
        self as u32
    }

    /// What it is, in a message.
    fn bytes_are_of(self) -> &'static str {
        match self {
            Self::Frame => "bytes in the buffer of the frame",
            Self::Lights => "bytes in the buffer of lights",
            Self::Projected => "bytes in the buffer of projected lights",
            Self::Xis => "bytes in the buffer of ξ",
            Self::Edges => "bytes in the buffer of the tiles' edges",
            Self::Intervals => "bytes in the buffer of depth intervals",
            Self::Ranges => "bytes in the buffer of ranges",
            Self::Lists => "bytes in the buffer of lists",
            Self::Needed => "bytes in the buffer of the number of listed lights",
        }
    }
}

impl GpuFrame {
    /// The least size of `buffer` in bytes. Never zero, since nothing binds an empty buffer.
    #[must_use]
    pub fn bytes(&self, buffer: GpuBuffer) -> u64 {
        const PAIR: usize = 8;
        let [columns, rows] = self.tiles.map(u64::from);
        let (count, size) = match buffer {
            GpuBuffer::Frame => (1, size_of::<Self>()),
            GpuBuffer::Lights => (u64::from(self.lights), size_of::<GpuLight>()),
            GpuBuffer::Projected => (u64::from(self.lights), size_of::<GpuProjected>()),
            GpuBuffer::Xis => (u64::from(self.lights), 4),
            GpuBuffer::Edges => (u64::from(self.interleave) * (columns + rows), PAIR),
            GpuBuffer::Intervals | GpuBuffer::Ranges => (self.lists(), PAIR),
            GpuBuffer::Lists => (u64::from(self.room), 4),
            GpuBuffer::Needed => (1, 4),
        };
        count.max(1) * size as u64
    }

    /// Checks that a buffer of `bytes` bytes is large enough. For callers that keep buffers from frame to frame: shaders
    /// do not notice, and the picture would be wrong.
    ///
    /// # Errors
    ///
    /// [`Error::Count`] if it is not.
    pub fn check(&self, buffer: GpuBuffer, bytes: u64) -> Result<(), Error> {
        if bytes >= self.bytes(buffer) {
            return Ok(());
        }
        Err(Error::Count {
            quantity: buffer.bytes_are_of(),
            value: usize::try_from(bytes).unwrap_or(usize::MAX),
            valid: "at least `GpuFrame::bytes`",
        })
    }
}
