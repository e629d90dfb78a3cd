use bytemuck::Pod;
use pollster::block_on;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BackendOptions, Backends, Buffer, BufferDescriptor, BufferUsages, Device, DeviceDescriptor,
    ErrorFilter, Features, Instance, InstanceDescriptor, Limits, MapMode, PollType,
    PowerPreference, Queue, RequestAdapterOptions,
};

use crate::Error;

/// A device that runs compute shaders.
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    name: String,
    /// Of a timestamp. `None` without them.
    pub(crate) nanoseconds_per_tick: Option<f32>,
}

/// What a buffer may be used for: everything that kernels, uploads and reads do with it.
const USAGES: BufferUsages = BufferUsages::STORAGE
    .union(BufferUsages::UNIFORM)
    .union(BufferUsages::COPY_SRC)
    .union(BufferUsages::COPY_DST);

impl Gpu {
    /// Opens the fastest adapter with the default limits of WebGPU; a software driver if there is no other.
    ///
    /// # Errors
    ///
    /// [`Error::Adapter`] if there is none, or if it has less than these limits.
    pub fn new() -> Result<Self, Error> {
        Self::with_limits(Limits::default())
    }

    /// Opens the fastest adapter that has at least `limits`.
    ///
    /// # Errors
    ///
    /// [`Error::Adapter`] if there is none.
    pub fn with_limits(limits: Limits) -> Result<Self, Error> {
        let refused = |error: &dyn std::fmt::Display| Error::Adapter(error.to_string());
        let instance = Instance::new(InstanceDescriptor {
            backends: Backends::VULKAN,
            backend_options: BackendOptions::default(),
            ..InstanceDescriptor::new_without_display_handle()
        });
        let options = RequestAdapterOptions {
            power_preference: PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter =
            block_on(instance.request_adapter(&options)).map_err(|error| refused(&error))?;
        let timestamps = adapter.features() & Features::TIMESTAMP_QUERY;
        let descriptor = DeviceDescriptor {
            required_features: timestamps,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) =
            block_on(adapter.request_device(&descriptor)).map_err(|error| refused(&error))?;
        Ok(Self {
            nanoseconds_per_tick: (!timestamps.is_empty()).then(|| queue.get_timestamp_period()),
            name: adapter.get_info().name,
            device,
            queue,
        })
    }

    /// The name of the adapter.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A buffer with `records`. One that would be empty has zeros for one record, since nothing binds an empty one.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] if the device has no room for it.
    pub fn upload<T: Pod>(&self, records: &[T]) -> Result<Buffer, Error> {
        if records.is_empty() {
            return self.zeroed::<T>(1);
        }
        let descriptor = BufferInitDescriptor {
            label: Some(std::any::type_name::<T>()),
            contents: bytemuck::cast_slice(records),
            usage: USAGES,
        };
        self.checked(|| self.device.create_buffer_init(&descriptor))
    }

    /// A buffer of zeros for `count` records, and for one if `count` is zero.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] if the device has no room for it.
    pub fn zeroed<T: Pod>(&self, count: usize) -> Result<Buffer, Error> {
        let descriptor = BufferDescriptor {
            label: Some(std::any::type_name::<T>()),
            size: (count.max(1) * size_of::<T>()) as u64,
            usage: USAGES,
            mapped_at_creation: false,
        };
        self.checked(|| self.device.create_buffer(&descriptor))
    }

    /// The contents of `buffer` as records, when all that was submitted before is done.
    ///
    /// # Errors
    ///
    /// [`Error::Device`] if the device is lost.
    pub fn read<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, Error> {
        let lost = |error: &dyn std::fmt::Display| Error::Device(error.to_string());
        let staging = self.checked(|| {
            self.device.create_buffer(&BufferDescriptor {
                label: Some("read"),
                size: buffer.size(),
                usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        })?;
        self.checked(|| {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
            self.queue.submit([encoder.finish()]);
        })?;
        staging.map_async(MapMode::Read, .., |_| {});
        self.device
            .poll(PollType::wait_indefinitely())
            .map_err(|error| lost(&error))?;
        let bytes = staging.get_mapped_range(..).map_err(|error| lost(&error))?;
        Ok(bytemuck::pod_collect_to_vec(&bytes[..]))
    }

    /// Calls `make`, and returns what the interface has to say against it as an error.
    pub(crate) fn checked<T>(&self, make: impl FnOnce() -> T) -> Result<T, Error> {
        let scopes = [
            ErrorFilter::Validation,
            ErrorFilter::OutOfMemory,
            ErrorFilter::Internal,
        ]
        .map(|filter| self.device.push_error_scope(filter));
        let made = make();
        let mut errors = Vec::new();
        for scope in scopes.into_iter().rev() {
            errors.extend(block_on(scope.pop()));
        }
        match errors.first() {
            Some(error) => Err(Error::Invalid(error.to_string())),
            None => Ok(made),
        }
    }
}
