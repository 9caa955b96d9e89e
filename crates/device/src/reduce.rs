//! Sums and largest values over particles, in the order of the processor's.
//!
//! A chunk is summed by one thread, particle by particle; the sums of chunks are added up elsewhere. What is
//! largest does not depend on an order, so that many threads look for it in a chunk.

use crate::pass::{Ask, Pass};
use crate::work::Work;

/// Sums of the components of a column that stand apart: component s of chunk c is
/// `chunk_sums[s * chunks + c]`. A row is a component of a chunk.
pub const SUMS: &str = "sums_of_chunks";

/// Largest values of the components of such a column and their first particles, of every
/// [`STRIDE`]th particle of a chunk. A row is one of these of a component of a chunk. What is not a
/// number is infinite.
pub const LARGEST_OF_STRIDES: &str = "largest_of_strides";

/// The same by component and chunk: `largest[2 (s * chunks + c)]`, and the particle behind it.
pub const LARGEST: &str = "largest_of_chunks";

/// Threads that look for what is largest in a chunk.
pub const STRIDE: usize = 32;

/// The kernels of [`SUMS`], [`LARGEST_OF_STRIDES`] and [`LARGEST`], for chunks of this many particles.
pub fn passes(chunk: usize) -> [Pass; 3] {
    let sums = format!(
        "KERNEL void {SUMS}(const int n, const real count, const real chunks, GLOBAL const real *terms, \
         GLOBAL real *chunk_sums)\n{{\n    EACH(a, n) {{\n        const int many = (int)chunks;\n        \
         const int component = a / many, part = a % many, all = (int)count;\n        \
         const int begin = part * {chunk};\n        \
         const int end = begin + {chunk} < all ? begin + {chunk} : all;\n        \
         GLOBAL const real *row = terms + component * (long)all;\n        real sum = 0;\n        int k = begin;\n        \
         for (; k + 32 <= end; k += 32) {{\n            real ahead[32];\n            \
         for (int i = 0; i < 32; ++i) ahead[i] = row[k + i];\n            \
         for (int i = 0; i < 32; ++i) sum += ahead[i];\n        }}\n        \
         for (; k < end; ++k) sum += row[k];\n        chunk_sums[a] = sum;\n    }}\n}}\n"
    );
    let strides = format!(
        "KERNEL void {LARGEST_OF_STRIDES}(const int n, const real count, const real chunks, \
         GLOBAL const real *terms, GLOBAL real *largest_parts)\n{{\n    EACH(a, n) {{\n        \
         const int many = (int)chunks * {STRIDE}, all = (int)count;\n        \
         const int component = a / many, part = a % many;\n        \
         const int begin = part / {STRIDE} * {chunk};\n        \
         const int end = begin + {chunk} < all ? begin + {chunk} : all;\n        \
         GLOBAL const real *row = terms + component * (long)all;\n        \
         real most = -P_INFINITY, which = begin;\n        \
         for (int k = begin + part % {STRIDE}; k < end; k += {STRIDE}) {{\n            \
         const real x = row[k];\n            const real value = x == x ? x : P_INFINITY;\n            \
         if (value > most) {{ most = value; which = k; }}\n        }}\n        \
         largest_parts[2 * a] = most;\n        largest_parts[2 * a + 1] = which;\n    }}\n}}\n"
    );
    let largest = format!(
        "KERNEL void {LARGEST}(const int n, GLOBAL const real *largest_parts, GLOBAL real *largest)\n{{\n    \
         EACH(a, n) {{\n        GLOBAL const real *parts = largest_parts + 2 * {STRIDE} * (long)a;\n        \
         real most = parts[0], which = parts[1];\n        \
         for (int k = 1; k < {STRIDE}; ++k) {{\n            \
         const real value = parts[2 * k], place = parts[2 * k + 1];\n            \
         const int is_first = value > most || (value == most && place < which);\n            \
         if (is_first) {{ most = value; which = place; }}\n        }}\n        \
         largest[2 * a] = most;\n        largest[2 * a + 1] = which;\n    }}\n}}\n"
    );
    let pass = |name, text, asks: &[Ask]| {
        let asks = [Ask::Rows].iter().chain(asks).copied().collect();
        Pass { name, text, asks, threads: 1, work: Work::default() }
    };
    let (count, chunks) = (Ask::Scalar("count"), Ask::Scalar("chunks"));
    let [terms, parts] = ["terms", "largest_parts"].map(Ask::Numbers);
    [
        pass(SUMS, sums, &[count, chunks, terms, Ask::Numbers("chunk_sums")]),
        pass(LARGEST_OF_STRIDES, strides, &[count, chunks, terms, parts]),
        pass(LARGEST, largest, &[parts, Ask::Numbers("largest")]),
    ]
}
