//! Materials whose energy depends on the volume ratio alone.
