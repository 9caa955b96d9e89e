//! What can go wrong with a device.

/// Why a device cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// There is no device of a name.
    #[error("there is no device `{name}`: {there}")]
    Unknown {
        /// The name.
        name: String,
        /// The devices that there are, and why others are not.
        there: String,
    },
    /// The driver of NVIDIA is not installed.
    #[error("there is no CUDA driver (libcuda) on this machine: install that of the GPU")]
    NoDriver,
    /// The compiler of NVIDIA is not installed.
    #[error(
        "there is no NVRTC (libnvrtc) on this machine: install it (pip install nvidia-cuda-nvrtc) and put \
         its folder into LD_LIBRARY_PATH"
    )]
    NoCompiler,
    /// The loader of OpenCL is not installed.
    #[error(
        "there is no OpenCL (libOpenCL) on this machine: install the driver of the GPU, or pocl \
         (Debian: pocl-opencl-icd and ocl-icd-libopencl1), which computes on the processor"
    )]
    NoOpenCl,
    /// OpenCL is there, but no driver of it.
    #[error(
        "OpenCL finds no device ({reason}): install the driver of the GPU, or pocl (Debian: pocl-opencl-icd), \
         which computes on the processor"
    )]
    NoPlatform {
        /// What OpenCL says.
        reason: String,
    },
    /// The memory does not suffice.
    #[error(
        "the device has no memory for {bytes} more bytes: take fewer particles or a device with more"
    )]
    Memory {
        /// What was asked for.
        bytes: usize,
    },
    /// The driver refused something.
    #[error(
        "the device could not {what}: {reason}; is its driver up to date, and the device free?"
    )]
    Refused {
        /// What was tried.
        what: String,
        /// What the driver says.
        reason: String,
    },
    /// A text does not compile.
    #[error("the device's compiler refuses a text:\n{log}")]
    Compile {
        /// What the compiler says.
        log: String,
    },
    /// A column is too short for what shall be copied.
    #[error("a column of {length} numbers can't take or give {count}")]
    Length {
        /// Numbers of the column.
        length: usize,
        /// Numbers to be copied.
        count: usize,
    },
    /// There is more than whole numbers of 32 bits can count.
    #[error(
        "{count} {what} are more than a device counts: take fewer particles or a shorter support"
    )]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// A column is used on a device of another kind than it was made on.
    #[error("a column belongs to another device: make it on the one that uses it")]
    Mixed,
}
