//! Files that piola writes, read back by other means than those that wrote them.

mod particle_files;
mod tables;
