//! Passes and columns on a device.

use std::collections::HashMap;

use piola_ranks::Exact;

use crate::device::{Argument, Column, Device, Kernel};
use crate::dialect::{Dialect, Layout};
use crate::error::DeviceError;
use crate::lists::Lists;
use crate::pass::{Ask, Pass};
use crate::reduce;
use crate::text::{BLOCK, Precision};

/// Numbers in single precision.
fn singles(numbers: &[f64]) -> Vec<f32> {
    numbers.iter().map(|number| *number as f32).collect()
}

/// Who asks for neighbours.
const MOVES: &str = "particles that move past each other have lists";

/// A device with the passes of a formulation and the columns that they work on, by name, beside those of
/// [`Lists`], if particles move past each other.
#[derive(Debug)]
pub struct Machine {
    device: Device,
    kernels: HashMap<&'static str, (Kernel, Pass)>,
    numbers: HashMap<&'static str, Column<f64>>,
    singles: HashMap<&'static str, Column<f32>>,
    layout: Layout,
    indices: HashMap<&'static str, Column<u32>>,
    lists: Option<Lists>,
    /// Particles a chunk of sums.
    chunk: usize,
}

impl Machine {
    /// Compiles passes for a device, with those that sum over chunks of this many particles. If the layout has columns in
    /// single precision, what is computed of pairs is in it, too.
    ///
    /// # Errors
    /// When the device's compiler refuses their text.
    pub fn new(
        device: Device,
        lists: Option<Lists>,
        layout: Layout,
        passes: impl FnOnce(Dialect) -> Vec<Pass>,
        chunk: usize,
    ) -> Result<Self, DeviceError> {
        let passes = passes(Dialect { language: device.language(), layout })
            .into_iter()
            .chain(reduce::passes(chunk));
        let passes: Vec<Pass> = passes.collect();
        let mut text = device.language().prologue(Precision::Double);
        passes.iter().for_each(|pass| text += &pass.text);
        let program = device.compile(&text, layout.of_pairs())?;
        let mut kernels = HashMap::new();
        for pass in passes {
            kernels.insert(pass.name, (program.kernel(pass.name)?, pass));
        }
        let (numbers, singles, indices) = (HashMap::new(), HashMap::new(), HashMap::new());
        Ok(Self { device, kernels, numbers, singles, layout, indices, lists, chunk })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Makes a column of these numbers.
    ///
    /// # Errors
    /// When the memory does not suffice.
    pub fn add(&mut self, name: &'static str, numbers: &[f64]) -> Result<(), DeviceError> {
        match self.layout.is_narrow(name) {
            true => drop(self.singles.insert(name, self.device.upload(&singles(numbers))?)),
            false => drop(self.numbers.insert(name, self.device.upload(numbers)?)),
        }
        Ok(())
    }

    /// Makes a column of these indices.
    ///
    /// # Errors
    /// When the memory does not suffice.
    pub fn add_indices(&mut self, name: &'static str, indices: &[u32]) -> Result<(), DeviceError> {
        self.indices.insert(name, self.device.upload(indices)?);
        Ok(())
    }

    /// Makes a column of zeros.
    ///
    /// # Errors
    /// When the memory does not suffice.
    pub fn add_zeros(&mut self, name: &'static str, length: usize) -> Result<(), DeviceError> {
        match self.layout.is_narrow(name) {
            true => drop(self.singles.insert(name, self.device.zeros(length)?)),
            false => drop(self.numbers.insert(name, self.device.zeros(length)?)),
        }
        Ok(())
    }

    /// A column in double precision.
    ///
    /// # Panics
    /// When there is none of that name: whoever asks has added it.
    pub fn column(&self, name: &str) -> &Column<f64> {
        &self.numbers[name]
    }

    /// Makes neighbour lists anew from a column of positions by number.
    ///
    /// # Errors
    /// When the device refuses.
    ///
    /// # Panics
    /// When there are no lists: whoever asks has given them.
    pub fn build(&mut self, positions: &str) -> Result<(), DeviceError> {
        self.lists.as_mut().expect(MOVES).build(&self.numbers[positions])
    }

    /// Sets which particles are passive, and which of them neither see others nor are seen, see
    /// [`Lists::exclude`].
    ///
    /// # Errors
    /// When the device refuses.
    pub fn exclude(&mut self, passive: &[bool], excluded: &[bool]) -> Result<(), DeviceError> {
        self.lists.as_mut().expect(MOVES).exclude(passive, excluded)
    }

    /// Picks neighbours at a column of positions by slot.
    ///
    /// # Errors
    /// When the device refuses.
    ///
    /// # Panics
    /// When there are no lists: whoever asks has given them.
    pub fn pick(&mut self, positions: &str) -> Result<(), DeviceError> {
        self.lists.as_mut().expect(MOVES).pick(&self.numbers[positions])
    }

    /// Replaces the numbers of a column.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn write(&mut self, name: &'static str, numbers: &[f64]) -> Result<(), DeviceError> {
        match (self.numbers.get_mut(name), self.singles.get_mut(name)) {
            (Some(column), _) => self.device.write(column, numbers),
            (_, Some(column)) => self.device.write(column, &singles(numbers)),
            (None, None) => self.add(name, numbers),
        }
    }

    /// Copies a column to another one.
    ///
    /// # Errors
    /// When the device refuses.
    ///
    /// # Panics
    /// When one of them is missing: whoever copies has added both.
    pub fn copy(&mut self, from: &'static str, to: &'static str) -> Result<(), DeviceError> {
        let mut taken = self.numbers.remove(to).expect("whoever copies has added both columns");
        let done = self.device.copy(self.column(from), &mut taken);
        self.numbers.insert(to, taken);
        done
    }

    /// Starts a pass over this many rows.
    ///
    /// # Errors
    /// When the device refuses.
    ///
    /// # Panics
    /// When the pass, a scalar or a column is missing: that is a fault of whoever declared the pass.
    pub fn start(
        &self,
        pass: &str,
        rows: usize,
        scalars: &[(&str, f64)],
    ) -> Result<(), DeviceError> {
        let (kernel, pass) = &self.kernels[pass];
        let missing = |what: &str| -> ! { panic!("the pass `{}` asks for `{what}`", pass.name) };
        let argument = |ask: &Ask| match *ask {
            Ask::Rows => Argument::Count(rows as i32),
            Ask::Scalar(name) => {
                let given = scalars.iter().find(|(known, _)| *known == name);
                Argument::Number(given.unwrap_or_else(|| missing(name)).1)
            }
            Ask::Numbers(name) => {
                let of_lists = || self.lists.as_ref().filter(|_| name == "made_at");
                let column = self.numbers.get(name).or_else(|| Some(of_lists()?.made_at()));
                Argument::Doubles(column.unwrap_or_else(|| missing(name)))
            }
            Ask::Height(name, width) => {
                let length = match self.layout.is_narrow(name) {
                    true => self.singles.get(name).map(Column::len),
                    false => self.numbers.get(name).map(Column::len),
                };
                Argument::Count((length.unwrap_or_else(|| missing(name)) / width) as i32)
            }
            Ask::Singles(name) => {
                Argument::Singles(self.singles.get(name).unwrap_or_else(|| missing(name)))
            }
            Ask::Indices(name) => {
                let of_lists = || self.lists.as_ref()?.indices(name);
                let column = self.indices.get(name).or_else(of_lists);
                Argument::Indices(column.unwrap_or_else(|| missing(name)))
            }
        };
        let arguments: Vec<Argument<'_>> = pass.asks.iter().map(argument).collect();
        kernel.start(rows * pass.threads, BLOCK, &arguments)
    }

    /// Sums of the first components of the column `terms` over this many particles, in the order of the
    /// processor: chunk by chunk, then over chunks.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn sums(&mut self, components: usize, count: usize) -> Result<Vec<f64>, DeviceError> {
        let chunks = count.div_ceil(self.chunk);
        self.need("chunk_sums", components * chunks)?;
        let scalars = [("count", count as f64), ("chunks", chunks as f64)];
        self.start(reduce::SUMS, components * chunks, &scalars)?;
        let mut parts = vec![0.0; components * chunks];
        self.device.read(self.column("chunk_sums"), &mut parts)?;
        // As on the processor: what chunks have is summed without rounding.
        let sum = |parts: &[f64]| {
            let mut sum = Exact::default();
            parts.iter().for_each(|part| sum.add(*part));
            sum.total()
        };
        Ok(parts.chunks_exact(chunks).map(sum).collect())
    }

    /// The largest of each of the first `N` components of the column `terms` over this many particles, at least
    /// negative infinity, with its first particle. What is not a number is infinite.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn largest<const N: usize>(
        &mut self,
        count: usize,
    ) -> Result<[(f64, usize); N], DeviceError> {
        let chunks = count.div_ceil(self.chunk);
        self.need("largest_parts", 2 * reduce::STRIDE * N * chunks)?;
        self.need("largest", 2 * N * chunks)?;
        let scalars = [("count", count as f64), ("chunks", chunks as f64)];
        self.start(reduce::LARGEST_OF_STRIDES, reduce::STRIDE * N * chunks, &scalars)?;
        self.start(reduce::LARGEST, N * chunks, &[])?;
        let mut parts = vec![0.0; 2 * N * chunks];
        self.device.read(self.column("largest"), &mut parts)?;
        let mut all = [(f64::NEG_INFINITY, 0); N];
        for (most, parts) in all.iter_mut().zip(parts.chunks_exact(2 * chunks)) {
            for part in parts.chunks_exact(2) {
                if part[0] > most.0 {
                    *most = (part[0], part[1] as usize);
                }
            }
        }
        Ok(all)
    }

    /// Makes room for this many numbers in a column.
    fn need(&mut self, name: &'static str, length: usize) -> Result<(), DeviceError> {
        match self.numbers.get(name) {
            Some(column) if column.len() >= length => Ok(()),
            _ => self.add_zeros(name, length),
        }
    }
}
