//! All devices that have OpenCL: GPUs of any maker, and processors by pocl.
//!
//! The library is looked for when devices are listed or opened.
#![expect(unsafe_code, reason = "buffers and kernels are used as only their text describes")]

use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

use opencl3::command_queue::CommandQueue;
use opencl3::context::Context;
use opencl3::device::{CL_DEVICE_TYPE_ALL, CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT, Device as Id};
use opencl3::error_codes::{
    CL_BUILD_PROGRAM_FAILURE, CL_INVALID_BUFFER_SIZE, CL_MEM_OBJECT_ALLOCATION_FAILURE,
    CL_OUT_OF_HOST_MEMORY, CL_OUT_OF_RESOURCES, ClError, DLOPEN_RUNTIME_LOAD_FAILED,
};
use opencl3::memory::{Buffer, CL_MEM_READ_WRITE, ClMem};
use opencl3::platform::{Platform, get_platforms};
use opencl3::types::CL_BLOCKING;

use crate::device::{Found, Given};
use crate::error::DeviceError;
use crate::text::Precision;

type Outcome<T> = Result<T, DeviceError>;

fn refused(what: &str) -> impl Fn(ClError) -> DeviceError {
    move |error| DeviceError::Refused {
        what: what.into(),
        reason: format!("{error} ({})", error.0),
    }
}

/// All devices, asked once and by one thread: pocl 3.1 fails where two ask at once. Platforms that can't
/// list theirs have none.
fn list() -> &'static Outcome<Vec<(Id, Found)>> {
    static LIST: OnceLock<Outcome<Vec<(Id, Found)>>> = OnceLock::new();
    LIST.get_or_init(|| {
        let platforms = get_platforms().map_err(|error| match error.0 {
            DLOPEN_RUNTIME_LOAD_FAILED => DeviceError::NoOpenCl,
            _ => DeviceError::NoPlatform { reason: format!("{error} ({})", error.0) },
        })?;
        let of = |platform: &Platform| platform.get_devices(CL_DEVICE_TYPE_ALL).unwrap_or_default();
        let ids = platforms.iter().flat_map(of).map(Id::new);
        let list: Vec<(Id, Found)> = ids.enumerate().map(found).collect();
        match list.is_empty() {
            true => Err(DeviceError::NoPlatform { reason: "no platform has one".into() }),
            false => Ok(list),
        }
    })
}

fn found((number, device): (usize, Id)) -> (Id, Found) {
    let found = Found {
        name: format!("opencl:{number}"),
        description: device.name().unwrap_or_else(|error| error.to_string()),
        memory: device.global_mem_size().unwrap_or(0),
        has_double: device.double_fp_config().is_ok_and(|config| config != 0),
    };
    (device, found)
}

/// All devices.
pub(crate) fn devices() -> Outcome<Vec<Found>> {
    let list = list().as_ref().map_err(DeviceError::clone)?;
    Ok(list.iter().map(|(_, found)| found.clone()).collect())
}

/// Memory of a device.
pub(crate) type Memory<T> = Buffer<T>;

/// An opened device.
#[derive(Clone, Debug)]
pub(crate) struct Device {
    found: Found,
    context: Arc<Context>,
    queue: Arc<CommandQueue>,
    options: &'static str,
}

impl Device {
    pub fn open(number: usize) -> Outcome<Self> {
        let list = list().as_ref().map_err(DeviceError::clone)?;
        let no_device = || DeviceError::NoPlatform { reason: format!("none of number {number}") };
        let (id, found) = list.get(number).cloned().ok_or_else(no_device)?;
        let what = format!("open `{}`", found.name);
        let open = refused(&what);
        let context = Context::from_device(&id).map_err(&open)?;
        let queue = CommandQueue::create_default(&context, 0).map_err(&open)?;
        // Quotients and roots in double precision are always exact.
        let options = match id.single_fp_config() {
            Ok(config) if config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT != 0 => {
                "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
            }
            _ => "-cl-std=CL1.2",
        };
        Ok(Self { found, context: Arc::new(context), queue: Arc::new(queue), options })
    }

    pub fn found(&self) -> &Found {
        &self.found
    }

    pub fn compile(&self, text: &str, of_pairs: Precision) -> Outcome<Program> {
        let mut program = opencl3::program::Program::create_from_source(&self.context, text)
            .map_err(refused("take a text"))?;
        let devices = self.context.devices();
        let options = if of_pairs == Precision::Double { self.options } else { "" };
        program.build(devices, options).map_err(|error| match error.0 {
            CL_BUILD_PROGRAM_FAILURE => DeviceError::Compile {
                log: program.get_build_log(devices[0]).unwrap_or_else(|error| error.to_string()),
            },
            _ => refused("compile a text")(error),
        })?;
        Ok(Program { program: Arc::new(program), device: self.clone() })
    }

    pub fn zeros<T: Copy + Default>(&self, length: usize) -> Outcome<Memory<T>> {
        let bytes = length.saturating_mul(size_of::<T>());
        let failed = |error: ClError| match error.0 {
            CL_MEM_OBJECT_ALLOCATION_FAILURE
            | CL_OUT_OF_RESOURCES
            | CL_OUT_OF_HOST_MEMORY
            | CL_INVALID_BUFFER_SIZE => DeviceError::Memory { bytes },
            _ => refused(&format!("give {bytes} bytes"))(error),
        };
        // SAFETY: no memory of the processor is given.
        let buffer = unsafe {
            Buffer::create(&self.context, CL_MEM_READ_WRITE, length, std::ptr::null_mut())
        };
        let mut buffer = buffer.map_err(failed)?;
        // SAFETY: this many bytes were asked for.
        unsafe { self.queue.enqueue_fill_buffer(&mut buffer, &[T::default()], 0, bytes, &[]) }
            .map_err(failed)?;
        Ok(buffer)
    }

    pub fn write<T>(&self, memory: &mut Memory<T>, numbers: &[T]) -> Outcome<()> {
        // SAFETY: the caller has compared lengths, and the call returns when the numbers are copied.
        unsafe { self.queue.enqueue_write_buffer(memory, CL_BLOCKING, 0, numbers, &[]) }
            .map(drop)
            .map_err(refused("take numbers"))
    }

    pub fn read<T>(&self, memory: &Memory<T>, numbers: &mut [T]) -> Outcome<()> {
        // SAFETY: as above.
        unsafe { self.queue.enqueue_read_buffer(memory, CL_BLOCKING, 0, numbers, &[]) }
            .map(drop)
            .map_err(refused("give numbers back"))
    }

    pub fn copy<T>(&self, from: &Memory<T>, to: &mut Memory<T>, length: usize) -> Outcome<()> {
        let bytes = length * size_of::<T>();
        // SAFETY: the caller has compared lengths.
        unsafe { self.queue.enqueue_copy_buffer(from, to, 0, 0, bytes, &[]) }
            .map(drop)
            .map_err(refused("copy numbers"))
    }

    pub fn time(&self, mut work: impl FnMut() -> Outcome<()>) -> Outcome<f64> {
        let finish = || self.queue.finish().map_err(refused("finish its work"));
        finish()?;
        let start = Instant::now();
        work()?;
        finish()?;
        Ok(1e3 * start.elapsed().as_secs_f64())
    }
}

/// A compiled text.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    program: Arc<opencl3::program::Program>,
    device: Device,
}

impl Program {
    pub fn kernel(&self, name: &str) -> Outcome<Kernel> {
        let what = format!("find the kernel `{name}`");
        let failed = refused(&what);
        let kernel = opencl3::kernel::Kernel::create(&self.program, name).map_err(&failed)?;
        let device = self.device.context.default_device();
        let most = kernel.get_work_group_size(device).map_err(failed)?;
        let queue = self.device.queue.clone();
        Ok(Kernel { kernel: Arc::new(Mutex::new(kernel)), most, queue })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    /// Its arguments are set one by one before it starts.
    kernel: Arc<Mutex<opencl3::kernel::Kernel>>,
    /// The largest block.
    most: usize,
    queue: Arc<CommandQueue>,
}

impl Kernel {
    pub fn start<'a>(
        &self,
        threads: usize,
        block: u32,
        arguments: impl Iterator<Item = Outcome<Given<'a, Memory<f64>, Memory<f32>, Memory<u32>>>>,
    ) -> Outcome<()> {
        let kernel = self.kernel.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, argument) in (0..).zip(arguments) {
            // SAFETY: these are the numbers and buffers that the text names.
            let set = unsafe {
                match argument? {
                    Given::Count(number) => kernel.set_arg(index, number),
                    Given::Number(number) => kernel.set_arg(index, number),
                    Given::Single(number) => kernel.set_arg(index, number),
                    Given::Indices(column) => kernel.set_arg(index, &column.get()),
                    Given::Doubles(column) => kernel.set_arg(index, &column.get()),
                    Given::Singles(column) => kernel.set_arg(index, &column.get()),
                }
            };
            set.map_err(|error| refused(&format!("take argument {index} of a kernel"))(error))?;
        }
        let block = self.most.min(block as usize).max(1);
        let all = threads.div_ceil(block) * block;
        let none = std::ptr::null();
        // SAFETY: the passes of this crate give a kernel the columns that its text names, with a row for
        // each thread that looks at one.
        unsafe { self.queue.enqueue_nd_range_kernel(kernel.get(), 1, none, &all, &block, &[]) }
            .map(drop)
            .map_err(refused("start a kernel"))
    }
}
