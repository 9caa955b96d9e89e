//! What is added up over particles.

use std::cell::RefCell;

use piola_ranks::Exact;

/// What rows have together: sums, or the largest of them.
pub trait Reduce: Copy + Send + Sync {
    /// Nothing yet.
    const ZERO: Self;

    /// Adds what later rows have.
    fn add(&mut self, other: &Self);
}

/// Numbers that are added up.
pub trait Sums: Reduce {
    /// How many there are.
    const NUMBERS: usize;

    /// Shows each of them, in a fixed order.
    fn each(&mut self, see: &mut impl FnMut(&mut f64));
}

impl Reduce for f64 {
    const ZERO: Self = 0.0;

    #[inline]
    fn add(&mut self, other: &Self) {
        *self += other;
    }
}

impl Sums for f64 {
    const NUMBERS: usize = 1;

    fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
        see(self);
    }
}

impl<T: Reduce, const N: usize> Reduce for [T; N] {
    const ZERO: Self = [T::ZERO; N];

    #[inline]
    fn add(&mut self, other: &Self) {
        self.iter_mut().zip(other).for_each(|(sum, part)| sum.add(part));
    }
}

impl<T: Sums, const N: usize> Sums for [T; N] {
    const NUMBERS: usize = N * T::NUMBERS;

    fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
        self.iter_mut().for_each(|part| part.each(see));
    }
}

thread_local! {
    /// Room for the sums of this thread, so that none is allocated in a step.
    static ROOM: RefCell<Vec<Vec<Exact>>> = const { RefCell::new(Vec::new()) };
}

/// Sums without rounding, whose parts may come in any order and from anywhere.
pub struct ExactSums {
    /// As many as there are numbers; none as long as nothing was added.
    sums: Vec<Exact>,
}

impl ExactSums {
    /// Nothing yet.
    pub const NONE: Self = Self { sums: Vec::new() };

    /// Adds a part.
    pub fn add<T: Sums>(&mut self, part: &T) {
        if T::NUMBERS == 0 {
            return;
        }
        let (mut part, mut sums) = (*part, self.parts::<T>().iter_mut());
        part.each(&mut |number| {
            if let (Some(sum), true) = (sums.next(), *number != 0.0) {
                sum.add(*number);
            }
        });
    }

    /// The sum of each number, for those of others.
    pub fn parts<T: Sums>(&mut self) -> &mut [Exact] {
        if self.sums.is_empty() {
            self.sums = ROOM.with_borrow_mut(Vec::pop).unwrap_or_default();
            self.sums.resize_with(T::NUMBERS, Exact::default);
        }
        &mut self.sums
    }

    /// The sums, rounded once.
    pub fn total<T: Sums>(&self) -> T {
        let (mut total, mut sums) = (T::ZERO, self.sums.iter());
        total.each(&mut |number| *number = sums.next().map_or(0.0, Exact::total));
        total
    }
}

impl Drop for ExactSums {
    fn drop(&mut self) {
        let mut sums = std::mem::take(&mut self.sums);
        if sums.capacity() > 0 {
            sums.clear();
            ROOM.with_borrow_mut(|room| room.push(sums));
        }
    }
}
