//! Devices behind one interface: NVIDIA GPUs by CUDA, all others by OpenCL.
//!
//! A device does what it is told one after the other; only what gives numbers back waits for it.

use crate::error::DeviceError;
use crate::text::{Language, Precision};
use crate::{cuda, opencl};

type Outcome<T> = Result<T, DeviceError>;

/// A device of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Its name here, such as `cuda:0` or `opencl:1`.
    pub name: String,
    /// Its own name.
    pub description: String,
    /// Its memory in bytes.
    pub memory: u64,
    /// Whether it has double precision.
    pub has_double: bool,
}

impl std::fmt::Display for Found {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let precision = if self.has_double { "double" } else { "single" };
        let gibibytes = self.memory as f64 / f64::from(1 << 30);
        write!(f, "{} ({}, {gibibytes:.1} GiB, {precision} precision)", self.name, self.description)
    }
}

/// All devices of this machine.
pub fn devices() -> Vec<Found> {
    [cuda::devices(), opencl::devices()].into_iter().flat_map(Result::unwrap_or_default).collect()
}

/// Why there are no devices of a kind, for kinds of which there are none.
pub fn missing() -> Vec<DeviceError> {
    [cuda::devices(), opencl::devices()].into_iter().filter_map(Result::err).collect()
}

/// That there is no device of a name, with those that there are.
fn unknown(name: &str) -> DeviceError {
    let list = |found: Outcome<Vec<Found>>| match found {
        Ok(found) => {
            let found: Vec<String> = found.iter().map(Found::to_string).collect();
            format!("there is {}", found.join(", "))
        }
        Err(reason) => reason.to_string(),
    };
    let there = [list(cuda::devices()), list(opencl::devices())].join("; ");
    DeviceError::Unknown { name: name.into(), there }
}

/// Numbers that columns are made of.
pub trait Element: Copy + Default + cuda::Element + Send + Sync + 'static {}
impl Element for u32 {}
impl Element for f64 {}
impl Element for f32 {}

/// Numbers on a device.
#[derive(Debug)]
pub struct Column<T> {
    memory: Memory<T>,
    length: usize,
}

#[derive(Debug)]
enum Memory<T> {
    Cuda(cuda::Memory<T>),
    OpenCl(opencl::Memory<T>),
}

impl<T> Column<T> {
    /// How many numbers it has.
    pub fn len(&self) -> usize {
        self.length
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Fails where it has less than `count` numbers.
    pub(crate) fn holds(&self, count: usize) -> Outcome<()> {
        match count <= self.length {
            true => Ok(()),
            false => Err(DeviceError::Length { length: self.length, count }),
        }
    }
}

/// What a kernel takes.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Argument<'a> {
    /// A whole number.
    Count(i32),
    /// A number in double precision.
    Number(f64),
    /// A number in single precision.
    Single(f32),
    /// Whole numbers.
    Indices(&'a Column<u32>),
    /// Double precision numbers.
    Doubles(&'a Column<f64>),
    /// Single precision numbers.
    Singles(&'a Column<f32>),
}

/// An argument as one kind of device takes it.
pub(crate) enum Given<'a, D, F, I> {
    Count(&'a i32),
    Number(&'a f64),
    Single(&'a f32),
    Indices(&'a I),
    Doubles(&'a D),
    Singles(&'a F),
}

/// Arguments for one kind of device.
macro_rules! given {
    ($arguments:expr, $kind:ident) => {
        $arguments.iter().map(|argument| {
            Ok(match argument {
                Argument::Count(number) => Given::Count(number),
                Argument::Number(number) => Given::Number(number),
                Argument::Single(number) => Given::Single(number),
                Argument::Indices(Column { memory: Memory::$kind(column), .. }) => {
                    Given::Indices(column)
                }
                Argument::Doubles(Column { memory: Memory::$kind(column), .. }) => {
                    Given::Doubles(column)
                }
                Argument::Singles(Column { memory: Memory::$kind(column), .. }) => {
                    Given::Singles(column)
                }
                _ => return Err(DeviceError::Mixed),
            })
        })
    };
}

/// An opened device.
#[derive(Clone, Debug)]
pub struct Device(Body);

#[derive(Clone, Debug)]
enum Body {
    Cuda(cuda::Device),
    OpenCl(opencl::Device),
}

impl Device {
    /// The device of a name, as [`devices`] lists them.
    ///
    /// # Errors
    /// When there is no such device, with those that there are, or it can't be opened.
    pub fn open(name: &str) -> Outcome<Self> {
        let number = |list: Outcome<Vec<Found>>| {
            list.ok().and_then(|list| list.iter().position(|found| found.name == name))
        };
        if let Some(number) = number(cuda::devices()) {
            return cuda::Device::open(number).map(Body::Cuda).map(Self);
        }
        match number(opencl::devices()) {
            Some(number) => opencl::Device::open(number).map(Body::OpenCl).map(Self),
            None => Err(unknown(name)),
        }
    }

    /// The language of its text.
    pub fn language(&self) -> Language {
        match &self.0 {
            Body::Cuda(_) => Language::Cuda,
            Body::OpenCl(_) => Language::OpenCl,
        }
    }

    /// What it is.
    pub fn found(&self) -> &Found {
        match &self.0 {
            Body::Cuda(device) => device.found(),
            Body::OpenCl(device) => device.found(),
        }
    }

    /// Its memory in bytes.
    pub fn memory(&self) -> u64 {
        self.found().memory
    }

    /// Its own name.
    pub fn description(&self) -> String {
        self.found().description.clone()
    }

    /// Compiles a text in its [language](Self::language). In double precision products and sums are not contracted, and
    /// roots and quotients are exact: what equal bits need. With pairs in single precision roots and quotients are those that
    /// the device is fast at, and CUDA contracts.
    ///
    /// # Errors
    /// When there is no compiler, or it refuses the text.
    pub fn compile(&self, text: &str, of_pairs: Precision) -> Outcome<Program> {
        Ok(Program(match &self.0 {
            Body::Cuda(device) => ProgramBody::Cuda(device.compile(text, of_pairs)?),
            Body::OpenCl(device) => ProgramBody::OpenCl(device.compile(text, of_pairs)?),
        }))
    }

    /// Copies numbers to new memory of the device.
    ///
    /// # Errors
    /// When its memory does not suffice.
    pub fn upload<T: Element>(&self, numbers: &[T]) -> Outcome<Column<T>> {
        let mut column = self.zeros(numbers.len())?;
        self.write(&mut column, numbers)?;
        Ok(column)
    }

    /// Room for some numbers, which are zero.
    ///
    /// # Errors
    /// When its memory does not suffice.
    pub fn zeros<T: Element>(&self, length: usize) -> Outcome<Column<T>> {
        // No driver gives room for nothing.
        let memory = match &self.0 {
            Body::Cuda(device) => Memory::Cuda(device.zeros(length.max(1))?),
            Body::OpenCl(device) => Memory::OpenCl(device.zeros(length.max(1))?),
        };
        Ok(Column { memory, length })
    }

    /// Copies numbers to the front of a column.
    ///
    /// # Errors
    /// When the column is shorter, or the driver refuses.
    pub fn write<T: Element>(&self, column: &mut Column<T>, numbers: &[T]) -> Outcome<()> {
        column.holds(numbers.len())?;
        match (&self.0, &mut column.memory) {
            _ if numbers.is_empty() => Ok(()),
            (Body::Cuda(device), Memory::Cuda(memory)) => device.write(memory, numbers),
            (Body::OpenCl(device), Memory::OpenCl(memory)) => device.write(memory, numbers),
            _ => Err(DeviceError::Mixed),
        }
    }

    /// Copies the front of a column, as much as there is room for.
    ///
    /// # Errors
    /// When the column is shorter, or a kernel before it failed.
    pub fn read<T: Element>(&self, column: &Column<T>, numbers: &mut [T]) -> Outcome<()> {
        column.holds(numbers.len())?;
        match (&self.0, &column.memory) {
            _ if numbers.is_empty() => Ok(()),
            (Body::Cuda(device), Memory::Cuda(memory)) => device.read(memory, numbers),
            (Body::OpenCl(device), Memory::OpenCl(memory)) => device.read(memory, numbers),
            _ => Err(DeviceError::Mixed),
        }
    }

    /// All numbers of a column.
    ///
    /// # Errors
    /// When a kernel before it failed.
    pub fn download<T: Element>(&self, column: &Column<T>) -> Outcome<Vec<T>> {
        let mut numbers = vec![T::default(); column.length];
        self.read(column, &mut numbers)?;
        Ok(numbers)
    }

    /// Copies a column to the front of another one within the device.
    ///
    /// # Errors
    /// When the other is shorter, or the driver refuses.
    pub fn copy<T: Element>(&self, from: &Column<T>, to: &mut Column<T>) -> Outcome<()> {
        to.holds(from.length)?;
        match (&self.0, &from.memory, &mut to.memory) {
            _ if from.is_empty() => Ok(()),
            (Body::Cuda(device), Memory::Cuda(from), Memory::Cuda(to)) => device.copy(from, to),
            (Body::OpenCl(device), Memory::OpenCl(memory), Memory::OpenCl(to)) => {
                device.copy(memory, to, from.length)
            }
            _ => Err(DeviceError::Mixed),
        }
    }

    /// Milliseconds that the device needs for what a function starts: by its own clock on CUDA, by
    /// that of the processor on OpenCL.
    ///
    /// # Errors
    /// Those of the function, and when the driver cannot measure.
    pub fn time(&self, work: impl FnMut() -> Outcome<()>) -> Outcome<f64> {
        match &self.0 {
            Body::Cuda(device) => device.time(work),
            Body::OpenCl(device) => device.time(work),
        }
    }
}

/// A compiled text.
#[derive(Clone, Debug)]
pub struct Program(ProgramBody);

#[derive(Clone, Debug)]
enum ProgramBody {
    Cuda(cuda::Program),
    OpenCl(opencl::Program),
}

impl Program {
    /// A kernel of it.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn kernel(&self, name: &str) -> Outcome<Kernel> {
        Ok(Kernel(match &self.0 {
            ProgramBody::Cuda(program) => KernelBody::Cuda(program.kernel(name)?),
            ProgramBody::OpenCl(program) => KernelBody::OpenCl(program.kernel(name)?),
        }))
    }
}

/// A pass that is ready to run.
#[derive(Clone, Debug)]
pub struct Kernel(KernelBody);

#[derive(Clone, Debug)]
enum KernelBody {
    Cuda(cuda::Kernel),
    OpenCl(opencl::Kernel),
}

impl Kernel {
    /// Starts it with at least this many threads in blocks of a size, or of the largest that an OpenCL
    /// device takes.
    ///
    /// Its text says which arguments it takes and how long they have to be; here that is not checked.
    ///
    /// # Errors
    /// When the driver refuses to start it.
    pub fn start(&self, threads: usize, block: u32, arguments: &[Argument<'_>]) -> Outcome<()> {
        match &self.0 {
            _ if threads == 0 => Ok(()),
            KernelBody::Cuda(kernel) => kernel.start(threads, block, given!(arguments, Cuda)),
            KernelBody::OpenCl(kernel) => kernel.start(threads, block, given!(arguments, OpenCl)),
        }
    }

    /// On CUDA registers a thread, bytes a thread outside of them, and blocks of a size that a
    /// multiprocessor holds.
    ///
    /// # Errors
    /// When the driver does not answer.
    pub fn resources(&self, block: u32) -> Outcome<Option<[i32; 3]>> {
        match &self.0 {
            KernelBody::Cuda(kernel) => kernel.resources(block).map(Some),
            KernelBody::OpenCl(_) => Ok(None),
        }
    }
}
