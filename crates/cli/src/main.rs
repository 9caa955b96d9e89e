//! The program `piola`.

fn main() {}
