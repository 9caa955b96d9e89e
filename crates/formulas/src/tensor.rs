//! Small tensors.
