//! Pairs of lists that do not change.

use std::borrow::Cow;
use std::cell::Cell;
use std::marker::PhantomData;

use piola_device::{DeviceError, Machine};
use piola_formulas::kernels::Needs;
use piola_formulas::pairs::{self, Of, Record};
use piola_formulas::{Lanes as _, Lanes4, WIDTH};

use super::gather::{Among, Pairs};

/// Neighbours of a block.
///
/// A sum over neighbours keeps one partial sum a lane, and as this number is fixed so is the
/// order of all sums, however wide the registers of the machine are.
pub const LANES: usize = 8;

/// A number of each neighbour of a block.
pub type Lanes = [f64; LANES];

/// Where the neighbours of a particle stand, and how many there are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    first: u32,
    count: u32,
}

/// How large rows of neighbours are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowSizes {
    /// The number of rows.
    pub rows: usize,
    /// Neighbours in all of them, with what fills up groups.
    pub entries: usize,
    /// Bytes of all of them.
    pub bytes: usize,
}

/// The neighbours of particles that do not change, with what is known of each pair, in blocks of
/// [`LANES`] neighbours, number by number, so that one operation acts on several.
///
/// The last block of a row is filled up with its last neighbour and zeros, so that loops over lanes have a
/// fixed length and need no condition: whatever is multiplied with one of the numbers vanishes there, and
/// what is divided by is the distance to a real neighbour.
#[derive(Clone, Debug)]
pub struct FrozenRows<R> {
    neighbors: Vec<[u32; LANES]>,
    /// Those of a block stand together.
    numbers: Vec<Lanes>,
    rows: Vec<Row>,
    record: PhantomData<R>,
}

/// What columns of a device have of such rows.
pub struct Columns<'a> {
    /// The first block of each row.
    pub first: Vec<u32>,
    /// The number of neighbours of each row.
    pub count: Vec<u32>,
    /// The neighbours.
    pub neighbors: &'a [u32],
    /// What is known of pairs, without what is zero in all of them.
    pub numbers: Cow<'a, [f64]>,
}

impl Columns<'_> {
    /// Bytes of all of them.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.first)
            + size_of_val(&*self.count)
            + size_of_val(self.neighbors)
            + size_of_val(&*self.numbers)
    }

    /// Copies them to a device.
    ///
    /// # Errors
    /// When its memory does not suffice, or there are more pairs than it counts.
    pub fn add(&self, machine: &mut Machine, rows: &piola_device::Rows) -> Result<(), DeviceError> {
        let count = self.neighbors.len();
        if i32::try_from(count).is_err() {
            return Err(DeviceError::TooMany { what: "pairs of particles", count });
        }
        machine.add_indices(rows.first, &self.first)?;
        machine.add_indices(rows.count, &self.count)?;
        machine.add_indices(rows.neighbors, self.neighbors)?;
        machine.add(rows.numbers, &self.numbers)
    }
}

impl<R: Record> FrozenRows<R> {
    /// The rows of particles, each of neighbours and what is known of the pair.
    pub fn new<I: IntoIterator<Item = (u32, Of<R, f64>)>>(rows: impl Iterator<Item = I>) -> Self {
        let (mut neighbors, mut numbers, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for row in rows {
            let (first, mut count) = (neighbors.len() as u32, 0);
            for (neighbor, pair) in row {
                let lane = count as usize % LANES;
                if lane == 0 {
                    neighbors.push([neighbor; LANES]);
                    numbers.resize(numbers.len() + R::NUMBERS, [0.0; LANES]);
                }
                if let Some(block) = neighbors.last_mut() {
                    block[lane..].fill(neighbor);
                }
                let own = numbers.len() - R::NUMBERS;
                let own = Cell::from_mut(&mut numbers[own..]).as_slice_of_cells();
                let next = Cell::new(0);
                R::map([&pair], &|[number]: [f64; 1]| {
                    let lanes = &own[next.replace(next.get() + 1)];
                    let mut all: Lanes = lanes.get();
                    all[lane] = number;
                    lanes.set(all);
                    number
                });
                count += 1;
            }
            ranges.push(Row { first, count });
        }
        Self { neighbors, numbers, rows: ranges, record: PhantomData }
    }

    /// Some of the rows, of which `place` says where neighbours stand now.
    pub fn part(&self, rows: impl Iterator<Item = usize>, place: impl Fn(u32) -> u32) -> Self {
        let blocks = |row: &Row| {
            let first = row.first as usize;
            first..first + (row.count as usize).div_ceil(LANES)
        };
        let (mut neighbors, mut numbers, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for row in rows.map(|row| &self.rows[row]) {
            let own = blocks(row);
            ranges.push(Row { first: neighbors.len() as u32, count: row.count });
            neighbors.extend(self.neighbors[own.clone()].iter().map(|block| block.map(&place)));
            numbers.extend_from_slice(&self.numbers[own.start * R::NUMBERS..own.end * R::NUMBERS]);
        }
        Self { neighbors, numbers, rows: ranges, record: PhantomData }
    }

    /// The rows as columns of a device of these names, and what is in them.
    pub fn columns(&self, names: [&'static str; 4]) -> (piola_device::Frozen<R>, Columns<'_>) {
        let is_used = |number: &usize| {
            let own = self.numbers.iter().skip(*number).step_by(R::NUMBERS);
            own.flatten().any(|value| *value != 0.0)
        };
        let used: Vec<usize> = (0..R::NUMBERS).filter(is_used).collect();
        let numbers = match used.len() == R::NUMBERS {
            true => Cow::Borrowed(self.numbers.as_flattened()),
            false => {
                let blocks = self.numbers.chunks_exact(R::NUMBERS);
                blocks.flat_map(|block| used.iter().flat_map(|&number| block[number])).collect()
            }
        };
        let [first, count, neighbors, of_pairs] = names;
        let place = |number| used.iter().position(|used| *used == number);
        let kept = (0..R::NUMBERS).map(place).collect();
        let rows = piola_device::Rows { first, count, neighbors, numbers: of_pairs, kept };
        let columns = Columns {
            first: self.rows.iter().map(|row| row.first).collect(),
            count: self.rows.iter().map(|row| row.count).collect(),
            neighbors: self.neighbors.as_flattened(),
            numbers,
        };
        (piola_device::Frozen::new(rows), columns)
    }

    /// Number of neighbours in a row.
    pub fn length(&self, row: usize) -> usize {
        self.rows[row].count as usize
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// How large they are: a pass over pairs reads all of it.
    pub fn sizes(&self) -> RowSizes {
        let entries = LANES * self.neighbors.len();
        RowSizes { rows: self.rows.len(), entries, bytes: self.memory() }
    }

    /// The same without what is known of pairs, for passes that ask who is a neighbour.
    pub fn index_sizes(&self) -> RowSizes {
        let sizes = self.sizes();
        RowSizes { bytes: sizes.bytes - size_of_val(self.numbers.as_slice()), ..sizes }
    }

    /// Bytes of all rows, which a pass over pairs reads.
    pub fn memory(&self) -> usize {
        size_of_val(self.neighbors.as_slice())
            + size_of_val(self.numbers.as_slice())
            + size_of_val(self.rows.as_slice())
    }

    /// What is known of some neighbours of a block, of which `pick` takes each number.
    #[inline(always)]
    fn pair<T: piola_formulas::Number>(
        &self,
        block: usize,
        pick: impl Fn(&Lanes) -> T,
    ) -> Of<R, T> {
        let numbers = &self.numbers[block * R::NUMBERS..][..R::NUMBERS];
        let next = Cell::new(0);
        R::map([&R::zero::<f64>()], &|_: [f64; 1]| pick(&numbers[next.replace(next.get() + 1)]))
    }
}

impl<R: Record> Pairs for FrozenRows<R> {
    type Pair = pairs::Frozen<R>;
    type Row<'a> = Row;
    type Block = Row;
    const IS_STREAMED: bool = true;

    #[inline(always)]
    fn row(&self, a: usize, among: Among) -> Row {
        match among {
            Among::Passive => Row::default(),
            _ => self.rows[a],
        }
    }

    /// A row is all that there is, and nothing has to be found of it.
    #[inline(always)]
    fn next(&self, row: &mut Row, _needs: Needs, block: &mut Row) -> usize {
        *block = std::mem::take(row);
        block.count as usize
    }

    #[inline(always)]
    fn four(&self, row: &Row, first: usize) -> ([u32; WIDTH], Of<Self::Pair, Lanes4>) {
        let (block, half) = (row.first as usize + first / LANES, first / WIDTH % (LANES / WIDTH));
        let pair = self.pair(block, |lanes| Lanes4::load(lanes.as_chunks().0[half]));
        let left = (row.count as usize).saturating_sub(first).min(WIDTH);
        (self.neighbors[block].as_chunks().0[half], (pair, Lanes4::load(COUNTS[left])))
    }

    #[inline(always)]
    fn one(&self, row: &Row, k: usize) -> (usize, Of<Self::Pair, f64>) {
        let (block, lane) = (row.first as usize + k / LANES, k % LANES);
        let pair = self.pair(block, |lanes| lanes[lane]);
        (self.neighbors[block][lane] as usize, (pair, 1.0))
    }
}

/// What counts of four lanes of which this many are left.
const COUNTS: [[f64; WIDTH]; WIDTH + 1] =
    [[0.0; WIDTH], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; WIDTH]];
