use bytemuck::Pod;

use crate::{Dispatch, Error, Gpu};

/// A function over records, in WGSL: `fn(input: INPUT) -> OUTPUT { body }`.
///
/// The sizes of the two types of Rust must be the distances of elements in arrays of the types of WGSL: a `vec3f` takes
/// 16 bytes there.
#[derive(Clone, Copy, Debug)]
pub struct Map<'a> {
    /// The texts that the function is joined to: functions and structures, in any order, without bindings 0 to 2.
    pub sources: &'a [&'a str],
    /// The type of `input`, such as `vec4f`.
    pub input: &'a str,
    /// The type of the result.
    pub output: &'a str,
    /// Statements with a `return`.
    pub body: &'a str,
}

const THREADS: usize = 64;
/// The most workgroups along an axis.
const MOST: usize = 65535;

impl Gpu {
    /// The results of `map` for each of `inputs`.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] if the text does not compile, or the sizes of the types are not those of WGSL. [`Error::Device`]
    /// if the device is lost.
    pub fn map<I: Pod, O: Pod>(&self, map: &Map, inputs: &[I]) -> Result<Vec<O>, Error> {
        let Map {
            sources,
            input,
            output,
            body,
        } = map;
        let entry = format!(
            "
            @group(0) @binding(0) var<storage, read> mapped_inputs: array<{input}>;
            @group(0) @binding(1) var<storage, read_write> mapped_outputs: array<{output}>;
            @group(0) @binding(2) var<storage, read_write> mapped_lengths: array<u32, 2>;
            fn mapped(input: {input}) -> {output} {{ {body} }}
            @compute @workgroup_size({THREADS})
            fn map_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {{
                let i = id.y * groups.x * {THREADS}u + id.x;
                if i == 0u {{ mapped_lengths = array(arrayLength(&mapped_inputs), arrayLength(&mapped_outputs)); }}
                if i < arrayLength(&mapped_inputs) {{ mapped_outputs[i] = mapped(mapped_inputs[i]); }}
            }}"
        );
        let kernel = self.kernel(&[sources, &[entry.as_str()][..]].concat(), "map_all")?;
        let [given, made, lengths] = [
            self.upload(inputs)?,
            self.zeroed::<O>(inputs.len())?,
            self.zeroed::<u32>(2)?,
        ];
        let groups = inputs.len().max(1).div_ceil(THREADS);
        let rows = groups.div_ceil(MOST);
        let workgroups = [groups.div_ceil(rows) as u32, rows as u32, 1];
        let buffers = [(0, &given), (1, &made), (2, &lengths)];
        self.run(&[Dispatch {
            kernel: &kernel,
            buffers: &buffers,
            workgroups,
        }])?;
        let expected = [inputs.len().max(1) as u32; 2];
        let found = self.read::<u32>(&lengths)?;
        if found != expected {
            let message =
                format!("{expected:?} records of {input} and {output} are {found:?} in WGSL");
            return Err(Error::Invalid(message));
        }
        let mut results = self.read(&made)?;
        results.truncate(inputs.len());
        Ok(results)
    }
}
