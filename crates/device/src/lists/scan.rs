//! Sums of all numbers before each.

use crate::device::{Argument, Column, Device, Kernel, Program};
use crate::error::DeviceError;

/// Numbers that a thread adds up.
const CHUNK: usize = 32;
const BLOCK: u32 = 64;

#[derive(Debug)]
pub(super) struct Scan {
    sums: Kernel,
    before: Kernel,
    /// Sums of chunks, of chunks of those, and so on.
    levels: Vec<Column<u32>>,
    zero: Column<u32>,
}

/// How many sums there are at each level; there is one at the last.
fn lengths(mut length: usize) -> impl Iterator<Item = usize> {
    let mut is_last = false;
    std::iter::from_fn(move || {
        let next = (!is_last).then(|| length.div_ceil(CHUNK));
        length = length.div_ceil(CHUNK);
        is_last = length <= 1;
        next
    })
}

impl Scan {
    /// For at most this many numbers.
    pub(super) fn new(
        device: &Device,
        program: &Program,
        most: usize,
    ) -> Result<Self, DeviceError> {
        Ok(Self {
            sums: program.kernel("list_sums")?,
            before: program.kernel("list_before")?,
            levels: lengths(most).map(|length| device.zeros(length)).collect::<Result<_, _>>()?,
            zero: device.zeros(1)?,
        })
    }

    /// Writes the sum of all before each of the first numbers of a column.
    pub(super) fn start(
        &self,
        count: &Column<u32>,
        length: usize,
        before: &Column<u32>,
    ) -> Result<(), DeviceError> {
        let number = |length: usize| Argument::Count(length as i32);
        let mut below = (count, length);
        for (level, threads) in self.levels.iter().zip(lengths(length)) {
            let arguments = [
                number(below.1),
                number(threads),
                Argument::Indices(below.0),
                Argument::Indices(level),
            ];
            self.sums.start(threads, BLOCK, &arguments)?;
            below = (level, threads);
        }
        // From the second level from above down to the numbers themselves.
        let depth = lengths(length).count();
        for level in (0..depth).rev() {
            let threads = lengths(length).nth(level).unwrap_or(1);
            let of = |level: usize| Argument::Indices(&self.levels[level]);
            let base = if level + 1 == depth { Argument::Indices(&self.zero) } else { of(level) };
            let (n, from, to) = match level.checked_sub(1) {
                Some(below) => (lengths(length).nth(below).unwrap_or(1), of(below), of(below)),
                None => (length, Argument::Indices(count), Argument::Indices(before)),
            };
            self.before.start(threads, BLOCK, &[number(n), number(threads), base, from, to])?;
        }
        Ok(())
    }

    /// The sum of all numbers of the last column of that length, or the largest number of 32 bits.
    pub(super) fn total(&self, device: &Device, length: usize) -> Result<usize, DeviceError> {
        let mut total = [0];
        device.read(&self.levels[lengths(length).count() - 1], &mut total)?;
        Ok(total[0] as usize)
    }
}
