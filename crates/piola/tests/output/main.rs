//! Files that piola writes, read back by other means than those that wrote them.

mod folders;
mod image;
mod particle_files;
mod pictures;
mod plots;
mod tables;
