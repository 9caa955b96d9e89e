//! NVIDIA GPUs, by the driver and the run-time compiler of CUDA.
//!
//! Both libraries are looked for when a device is opened.
#![expect(unsafe_code, reason = "a kernel is started with arguments that only its text describes")]

use std::sync::Arc;

use cudarc::driver::result::{self, device};
use cudarc::driver::sys::{self, CUevent_flags};
use cudarc::driver::{
    CudaContext, CudaFunction, CudaModule, CudaSlice, CudaStream, DeviceRepr, DriverError,
    LaunchConfig, PushKernelArg, ValidAsZeroBits,
};
use cudarc::nvrtc::{CompileError, CompileOptions, Ptx, compile_ptx_with_opts};

use crate::device::{Found, Given};
use crate::error::DeviceError;
use crate::text::Precision;

type Outcome<T> = Result<T, DeviceError>;

fn refused(what: &str) -> impl Fn(DriverError) -> DeviceError {
    move |error| DeviceError::Refused { what: what.into(), reason: format!("{error:?}") }
}

/// Whether the driver can be loaded.
pub fn has_driver() -> bool {
    // SAFETY: it only opens the library, whose start-up code is that of the driver.
    unsafe { sys::is_culib_present() }
}

/// Whether the compiler can be loaded.
pub fn has_compiler() -> bool {
    // SAFETY: as above.
    unsafe { cudarc::nvrtc::sys::is_culib_present() }
}

/// All devices.
pub(crate) fn devices() -> Outcome<Vec<Found>> {
    if !has_driver() {
        return Err(DeviceError::NoDriver);
    }
    let ask = || {
        result::init()?;
        (0..device::get_count()?)
            .map(|number| {
                let device = device::get(number)?;
                Ok(Found {
                    name: format!("cuda:{number}"),
                    description: device::get_name(device)?,
                    // SAFETY: the device is that of the line above.
                    memory: unsafe { device::total_mem(device)? } as u64,
                    has_double: true,
                })
            })
            .collect::<Result<_, _>>()
    };
    ask().map_err(refused("list devices"))
}

/// Compiles a text to PTX for an architecture such as `compute_90`. In double precision products and sums are not contracted,
/// and roots and quotients are exact: what equal bits need.
///
/// # Errors
/// When there is no compiler, or it refuses the text.
pub fn compile(text: &str, of_pairs: Precision, architecture: &'static str) -> Outcome<Module> {
    if !has_compiler() {
        return Err(DeviceError::NoCompiler);
    }
    let is_exact = of_pairs == Precision::Double;
    let options = CompileOptions {
        fmad: Some(!is_exact),
        prec_div: Some(is_exact),
        prec_sqrt: Some(is_exact),
        ftz: Some(false),
        arch: Some(architecture),
        ..CompileOptions::default()
    };
    compile_ptx_with_opts(text, options).map(Module).map_err(|error| DeviceError::Compile {
        log: match error {
            CompileError::CompileError { log, .. } => log.to_string_lossy().into_owned(),
            other => format!("{other:?}"),
        },
    })
}

/// A compiled text that is not loaded.
#[derive(Clone, Debug)]
pub struct Module(Ptx);

impl Module {
    /// Its PTX.
    pub fn text(&self) -> String {
        self.0.to_src()
    }
}

/// What CUDA asks of numbers in its memory.
pub trait Element: DeviceRepr + ValidAsZeroBits {}
impl<T: DeviceRepr + ValidAsZeroBits> Element for T {}

/// Memory of a device.
pub(crate) type Memory<T> = CudaSlice<T>;

/// An opened device.
#[derive(Clone, Debug)]
pub(crate) struct Device {
    found: Found,
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
    /// The newest architecture known here that it can run.
    architecture: &'static str,
}

impl Device {
    pub fn open(number: usize) -> Outcome<Self> {
        let found = devices()?.into_iter().nth(number).ok_or(DeviceError::NoDriver)?;
        let what = format!("open `{}`", found.name);
        let open = refused(&what);
        let context = CudaContext::new(number).map_err(&open)?;
        let architecture = match context.compute_capability().map_err(&open)? {
            (9.., _) => "compute_90",
            (8, _) => "compute_80",
            _ => "compute_75",
        };
        let stream = context.default_stream();
        Ok(Self { found, context, stream, architecture })
    }

    pub fn found(&self) -> &Found {
        &self.found
    }

    pub fn compile(&self, text: &str, of_pairs: Precision) -> Outcome<Program> {
        let module = compile(text, of_pairs, self.architecture)?;
        let module = self.context.load_module(module.0).map_err(refused("load a program"))?;
        Ok(Program { module, stream: self.stream.clone() })
    }

    pub fn zeros<T: Element>(&self, length: usize) -> Outcome<Memory<T>> {
        self.stream.alloc_zeros(length).map_err(|error| {
            let bytes = length.saturating_mul(size_of::<T>());
            match error.0 {
                sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY => DeviceError::Memory { bytes },
                _ => refused(&format!("give {bytes} bytes"))(error),
            }
        })
    }

    pub fn write<T: Element>(&self, memory: &mut Memory<T>, numbers: &[T]) -> Outcome<()> {
        self.stream.memcpy_htod(numbers, memory).map_err(refused("take numbers"))
    }

    pub fn read<T: Element>(&self, memory: &Memory<T>, numbers: &mut [T]) -> Outcome<()> {
        let front = memory.slice(0..numbers.len());
        let copied = self.stream.memcpy_dtoh(&front, numbers);
        copied.and_then(|()| self.stream.synchronize()).map_err(refused("give numbers back"))
    }

    pub fn copy<T: Element>(&self, from: &Memory<T>, to: &mut Memory<T>) -> Outcome<()> {
        self.stream.memcpy_dtod(from, to).map_err(refused("copy numbers"))
    }

    pub fn time(&self, mut work: impl FnMut() -> Outcome<()>) -> Outcome<f64> {
        let event = || {
            self.stream
                .record_event(Some(CUevent_flags::CU_EVENT_DEFAULT))
                .map_err(refused("record an event"))
        };
        let start = event()?;
        work()?;
        let end = event()?;
        start.elapsed_ms(&end).map(f64::from).map_err(refused("measure a time"))
    }
}

/// A loaded text.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    module: Arc<CudaModule>,
    stream: Arc<CudaStream>,
}

impl Program {
    pub fn kernel(&self, name: &str) -> Outcome<Kernel> {
        let what = format!("find the kernel `{name}`");
        let function = self.module.load_function(name).map_err(refused(&what))?;
        Ok(Kernel { function, stream: self.stream.clone() })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    function: CudaFunction,
    stream: Arc<CudaStream>,
}

impl Kernel {
    pub fn start<'a>(
        &self,
        threads: usize,
        block: u32,
        arguments: impl Iterator<Item = Outcome<Given<'a, Memory<f64>, Memory<f32>, Memory<u32>>>>,
    ) -> Outcome<()> {
        let mut launch = self.stream.launch_builder(&self.function);
        for argument in arguments {
            match argument? {
                Given::Count(number) => launch.arg(number),
                Given::Number(number) => launch.arg(number),
                Given::Single(number) => launch.arg(number),
                Given::Indices(column) => launch.arg(column),
                Given::Doubles(column) => launch.arg(column),
                Given::Singles(column) => launch.arg(column),
            };
        }
        let blocks = threads.div_ceil(block as usize) as u32;
        let grid = LaunchConfig {
            grid_dim: (blocks, 1, 1),
            block_dim: (block, 1, 1),
            shared_mem_bytes: 0,
        };
        // SAFETY: the passes of this crate give a kernel the columns that its text names, with a row for
        // each thread that looks at one.
        unsafe { launch.launch(grid) }.map_err(refused("start a kernel"))?;
        Ok(())
    }

    /// Registers a thread, bytes a thread outside of them, and blocks of a size that a multiprocessor
    /// holds.
    pub fn resources(&self, block: u32) -> Outcome<[i32; 3]> {
        let ask = || {
            let blocks =
                self.function.occupancy_max_active_blocks_per_multiprocessor(block, 0, None)?;
            Ok([self.function.num_regs()?, self.function.local_size_bytes()?, blocks as i32])
        };
        ask().map_err(refused("describe a kernel"))
    }
}
