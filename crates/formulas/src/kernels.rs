//! Smoothing kernels.
