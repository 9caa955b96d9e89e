//! NVIDIA GPUs, by the driver and the run-time compiler of CUDA.
//!
//! Both libraries are looked for when a device is opened. The only unsafe code of piola is here: the
//! questions whether they are there, and the start of a kernel, whose arguments nobody checks.
#![expect(unsafe_code, reason = "a kernel is started with arguments that only its text describes")]

use std::sync::Arc;

use cudarc::driver::{
    CudaContext, CudaFunction, CudaModule, CudaSlice, CudaStream, DeviceRepr, DriverError,
    LaunchConfig, PushKernelArg, ValidAsZeroBits, sys::CUevent_flags,
};
use cudarc::nvrtc::{CompileOptions, compile_ptx_with_opts};

/// Why a device cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CudaError {
    /// The driver is not installed.
    #[error("there is no CUDA driver (libcuda) on this machine: install that of the GPU")]
    NoDriver,
    /// The compiler is not installed.
    #[error(
        "there is no NVRTC (libnvrtc) on this machine: install it (pip install nvidia-cuda-nvrtc) and put \
         its folder into LD_LIBRARY_PATH"
    )]
    NoCompiler,
    /// The driver refused something.
    #[error("the CUDA driver could not {what}: {reason}")]
    Driver {
        /// What was tried.
        what: String,
        /// What the driver says.
        reason: String,
    },
    /// A text does not compile.
    #[error("NVRTC refuses a text:\n{log}")]
    Compile {
        /// What the compiler says.
        log: String,
    },
}

fn driver_error(what: &str) -> impl Fn(DriverError) -> CudaError {
    move |error| CudaError::Driver { what: what.into(), reason: format!("{error:?}") }
}

/// Whether the driver can be loaded.
pub fn has_driver() -> bool {
    // SAFETY: it only opens the library, whose start-up code is that of the driver.
    unsafe { cudarc::driver::sys::is_culib_present() }
}

/// Whether the compiler can be loaded.
pub fn has_compiler() -> bool {
    // SAFETY: as above.
    unsafe { cudarc::nvrtc::sys::is_culib_present() }
}

/// Names of all devices; none without a driver.
pub fn devices() -> Vec<String> {
    if !has_driver() {
        return Vec::new();
    }
    let count = CudaContext::device_count().unwrap_or(0).max(0) as usize;
    let name = |number| CudaContext::new(number).and_then(|device| device.name());
    (0..count).map(|number| name(number).unwrap_or_else(|error| format!("{error:?}"))).collect()
}

/// Compiles a text to PTX for an architecture such as `compute_90`, without contraction of products and
/// sums and with exact roots and quotients: what equal bits need.
///
/// # Errors
/// When there is no compiler, or it refuses the text.
pub fn compile(text: &str, architecture: &'static str) -> Result<Module, CudaError> {
    if !has_compiler() {
        return Err(CudaError::NoCompiler);
    }
    let options = CompileOptions {
        fmad: Some(false),
        prec_div: Some(true),
        prec_sqrt: Some(true),
        ftz: Some(false),
        arch: Some(architecture),
        ..CompileOptions::default()
    };
    compile_ptx_with_opts(text, options).map(Module).map_err(|error| CudaError::Compile {
        log: match error {
            cudarc::nvrtc::CompileError::CompileError { log, .. } => {
                log.to_string_lossy().into_owned()
            }
            other => format!("{other:?}"),
        },
    })
}

/// A compiled text.
#[derive(Clone, Debug)]
pub struct Module(cudarc::nvrtc::Ptx);

impl Module {
    /// Its PTX.
    pub fn text(&self) -> String {
        self.0.to_src()
    }
}

/// An opened device.
#[derive(Clone, Debug)]
pub struct Device {
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
}

/// Numbers on a device.
pub type Column<T> = CudaSlice<T>;

/// What a kernel takes.
#[derive(Debug)]
#[non_exhaustive]
pub enum Argument<'a> {
    /// A whole number.
    Count(i32),
    /// Whole numbers.
    Indices(&'a Column<u32>),
    /// Double precision numbers.
    Doubles(&'a Column<f64>),
    /// Single precision numbers.
    Singles(&'a Column<f32>),
}

/// A pass that is ready to run.
#[derive(Clone, Debug)]
pub struct Kernel {
    function: CudaFunction,
    stream: Arc<CudaStream>,
}

impl Device {
    /// The device of a number.
    ///
    /// # Errors
    /// When there is no driver or no such device.
    pub fn open(number: usize) -> Result<Self, CudaError> {
        if !has_driver() {
            return Err(CudaError::NoDriver);
        }
        let context =
            CudaContext::new(number).map_err(driver_error(&format!("open device {number}")))?;
        let stream = context.default_stream();
        Ok(Self { context, stream })
    }

    /// Its name.
    ///
    /// # Errors
    /// When the driver does not answer.
    pub fn name(&self) -> Result<String, CudaError> {
        self.context.name().map_err(driver_error("name the device"))
    }

    /// The architecture that text for it is compiled for: the newest one known here that it can run.
    ///
    /// # Errors
    /// When the driver does not answer.
    pub fn architecture(&self) -> Result<&'static str, CudaError> {
        let capability = self
            .context
            .compute_capability()
            .map_err(driver_error("ask what the device can do"))?;
        Ok(match capability {
            (9.., _) => "compute_90",
            (8, _) => "compute_80",
            _ => "compute_75",
        })
    }

    /// Loads the kernels of a module.
    ///
    /// # Errors
    /// When the driver refuses the module, or a kernel is not in it.
    pub fn load<const N: usize>(
        &self,
        module: &Module,
        kernels: [&str; N],
    ) -> Result<[Kernel; N], CudaError> {
        let loaded: Arc<CudaModule> =
            self.context.load_module(module.0.clone()).map_err(driver_error("load a module"))?;
        let mut functions = Vec::with_capacity(N);
        for name in kernels {
            let function = loaded
                .load_function(name)
                .map_err(driver_error(&format!("find the kernel `{name}`")))?;
            functions.push(Kernel { function, stream: self.stream.clone() });
        }
        Ok(functions.try_into().expect("there is one for each name"))
    }

    /// Copies numbers to the device.
    ///
    /// # Errors
    /// When its memory does not suffice.
    pub fn upload<T: DeviceRepr>(&self, numbers: &[T]) -> Result<Column<T>, CudaError> {
        let what = format!("take {} bytes", size_of_val(numbers));
        self.stream.clone_htod(numbers).map_err(driver_error(&what))
    }

    /// Room for some numbers.
    ///
    /// # Errors
    /// When its memory does not suffice.
    pub fn zeros<T: DeviceRepr + ValidAsZeroBits>(
        &self,
        count: usize,
    ) -> Result<Column<T>, CudaError> {
        let what = format!("take {} bytes", count * size_of::<T>());
        self.stream.alloc_zeros(count).map_err(driver_error(&what))
    }

    /// Copies numbers from the device.
    ///
    /// # Errors
    /// When a kernel before it failed.
    pub fn download<T: DeviceRepr>(&self, numbers: &Column<T>) -> Result<Vec<T>, CudaError> {
        self.stream.clone_dtoh(numbers).map_err(driver_error("give numbers back"))
    }

    /// Copies numbers within the device.
    ///
    /// # Errors
    /// When the driver refuses.
    pub fn copy<T: DeviceRepr>(
        &self,
        from: &Column<T>,
        to: &mut Column<T>,
    ) -> Result<(), CudaError> {
        self.stream.memcpy_dtod(from, to).map_err(driver_error("copy numbers"))
    }

    /// Milliseconds that the device needs for what a function starts.
    ///
    /// # Errors
    /// Those of the function, and when the driver cannot measure.
    pub fn time(&self, mut work: impl FnMut() -> Result<(), CudaError>) -> Result<f64, CudaError> {
        let event = || {
            self.stream
                .record_event(Some(CUevent_flags::CU_EVENT_DEFAULT))
                .map_err(driver_error("record an event"))
        };
        let start = event()?;
        work()?;
        let end = event()?;
        start.elapsed_ms(&end).map(f64::from).map_err(driver_error("measure a time"))
    }
}

impl Kernel {
    /// Starts it with so many threads in blocks of a size.
    ///
    /// Its text says which arguments it takes and how long they have to be; here that is not checked.
    ///
    /// # Errors
    /// When the driver refuses to start it.
    pub fn start(
        &self,
        threads: usize,
        block: u32,
        arguments: &[Argument<'_>],
    ) -> Result<(), CudaError> {
        let mut launch = self.stream.launch_builder(&self.function);
        for argument in arguments {
            match argument {
                Argument::Count(number) => launch.arg(number),
                Argument::Indices(column) => launch.arg(*column),
                Argument::Doubles(column) => launch.arg(*column),
                Argument::Singles(column) => launch.arg(*column),
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
        unsafe { launch.launch(grid) }.map_err(driver_error("start a kernel"))?;
        Ok(())
    }

    /// Registers a thread, bytes a thread outside of them, and blocks of a size that a multiprocessor
    /// holds.
    ///
    /// # Errors
    /// When the driver does not answer.
    pub fn resources(&self, block: u32) -> Result<[i32; 3], CudaError> {
        let ask = || {
            let blocks =
                self.function.occupancy_max_active_blocks_per_multiprocessor(block, 0, None)?;
            Ok([self.function.num_regs()?, self.function.local_size_bytes()?, blocks as i32])
        };
        ask().map_err(driver_error("describe a kernel"))
    }
}
