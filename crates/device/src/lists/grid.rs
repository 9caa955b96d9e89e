//! Cells over the particles.

/// Cells are wider than asked by this share, so that rounding never puts two points closer than
/// the width asked for two cells apart, as on the processor.
const MARGIN: f64 = 1e-5;
/// Cells along an axis that a coordinate tells apart.
const MOST: f64 = 1_073_741_824.0;
/// Threads that look for bounds, first of all particles, then of what those found.
pub(super) const PARTS: [usize; 2] = [16384, 128];

/// A table of cells, the number of which along each axis is a power of two. A cell stands where the last
/// bits of its coordinates put it: space that does not fit is folded into the table, so that one
/// particle far away makes neither the table large nor cells wide.
#[derive(Debug)]
pub(super) struct Grid {
    width: f64,
    periodic: Vec<Option<[f64; 2]>>,
    /// The largest number of bits of a cell's place.
    most_bits: u32,
    bits: u32,
    /// Bounds that threads have found.
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Grid {
    /// Cells at least `width` m wide, at most four a particle.
    pub(super) fn new(count: usize, width: f64, periodic: &[Option<[f64; 2]>]) -> Self {
        let bounds = vec![0.0; PARTS[1] * periodic.len()];
        Self {
            width: width * (1.0 + MARGIN),
            periodic: periodic.to_vec(),
            most_bits: (4 * count).max(64).ilog2(),
            bits: 0,
            lower: bounds.clone(),
            upper: bounds,
        }
    }

    /// The largest number of cells.
    pub(super) fn most(&self) -> usize {
        1 << self.most_bits
    }

    /// The number of cells.
    pub(super) fn cells(&self) -> usize {
        1 << self.bits
    }

    /// Lays it between bounds that `read` gets in parts: origin, cells a metre, number of cells of a
    /// periodic axis, and bits, axis by axis.
    pub(super) fn fit<E>(
        &mut self,
        read: impl FnOnce(&mut [f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<[f64; 12], E> {
        read(&mut self.lower, &mut self.upper)?;
        let dimension = self.periodic.len();
        let (mut axes, mut bits) = ([0.0; 12], [0_u32; 3]);
        for (axis, bounds) in self.periodic.iter().enumerate() {
            let of = |all: &[f64], choose: fn(f64, f64) -> f64, from| {
                all.iter().skip(axis).step_by(dimension).copied().fold(from, choose)
            };
            let (origin, inverse, cells, needed) = if let &Some([lower, upper]) = bounds {
                let cells = ((upper - lower) / self.width).floor().clamp(1.0, MOST);
                (lower, cells / (upper - lower), cells, cells)
            } else {
                let lower = of(&self.lower, f64::min, f64::INFINITY);
                let upper = of(&self.upper, f64::max, f64::NEG_INFINITY);
                let needed = ((upper - lower) / self.width).floor() + 1.0;
                // What is too far to be told apart must not be where the others are.
                let origin = if needed < MOST { lower } else { 0.0 };
                (origin, 1.0 / self.width, 0.0, needed.clamp(1.0, MOST))
            };
            // Without a coordinate that is a number there are no bounds.
            let origin = if origin.is_finite() { origin } else { 0.0 };
            bits[axis] = (needed as u32).next_power_of_two().ilog2();
            axes[4 * axis..][..3].copy_from_slice(&[origin, inverse, cells]);
        }
        while bits.iter().sum::<u32>() > self.most_bits {
            let largest = (0..3).max_by_key(|axis| bits[*axis]).unwrap_or(0);
            bits[largest] -= 1;
        }
        (0..dimension).for_each(|axis| axes[4 * axis + 3] = f64::from(bits[axis]));
        self.bits = bits.iter().sum();
        Ok(axes)
    }
}
