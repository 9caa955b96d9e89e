//! Neighbour lists of moving particles, kept over many steps.

use rayon::prelude::*;

use super::{Domain, NeighborError, search, spatial_order};
use crate::parallel::CHUNK;
use crate::{Vector, parallel};

/// Candidates for the neighbours of moving particles: all that were closer than the support
/// radius and a skin when the list was made. It holds as long as no particle has moved by more
/// than half of the skin.
///
/// Particles have a *number*, which never changes, and a *place* in memory, which is renewed with
/// the list so that neighbours stay close. Rows name places, but stand in the order of numbers:
/// a sum over those in a row that are inside the support is the same to the bit, whenever the
/// list was made. Particles that are `passive` see only the others, and stand last in their rows.
pub struct SkinList<const D: usize> {
    domain: Domain<D>,
    support: f64,
    skin: f64,
    passive: Vec<bool>,
    /// Particles that nobody sees, by number; empty if there are none.
    excluded: Vec<bool>,
    /// Whether the list has to be made anew, whoever moved.
    stale: bool,
    /// Number of the particle at each place, and the reverse.
    numbers: Vec<u32>,
    places: Vec<u32>,
    /// Positions by place, inside the bounds of the domain: now, and when the list was made.
    positions: Vec<Vector<D>>,
    made_at: Vec<Vector<D>>,
    /// Row `k` is `entries[offsets[k]..offsets[k + 1]]`, from `passive_from[k]` on passive.
    offsets: Vec<usize>,
    passive_from: Vec<usize>,
    entries: Vec<u32>,
    builds: u64,
}

impl<const D: usize> SkinList<D> {
    /// A list of particles at `positions` in m, by number, with one support radius and skin in m.
    ///
    /// # Errors
    /// Those of [`search`] for the support with its skin.
    pub fn new(
        positions: &[Vector<D>],
        passive: Vec<bool>,
        support: f64,
        skin: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let numbers: Vec<u32> = (0..positions.len() as u32).collect();
        let mut list = Self {
            domain,
            support,
            skin,
            passive,
            excluded: Vec::new(),
            stale: false,
            places: numbers.clone(),
            numbers,
            positions: vec![Vector::zeros(); positions.len()],
            made_at: Vec::new(),
            offsets: Vec::new(),
            passive_from: Vec::new(),
            entries: Vec::new(),
            builds: 0,
        };
        list.update(|number| positions[number])?;
        Ok(list)
    }

    /// Takes new positions in m by number, and makes the list anew where it no longer holds.
    ///
    /// # Errors
    /// Those of [`search`]; the list then is as it was.
    pub fn update(
        &mut self,
        position: impl Fn(usize) -> Vector<D> + Sync,
    ) -> Result<(), NeighborError> {
        self.take(&position);
        let (positions, made_at, domain) = (&self.positions, &self.made_at, &self.domain);
        let moved = |k: usize| domain.separation(&made_at[k], &positions[k]).norm_squared();
        if self.builds > 0
            && !self.stale
            && parallel::maximum(positions.len(), 0.0, moved) <= 0.25 * self.skin * self.skin
        {
            return Ok(());
        }
        self.build()?;
        self.take(&position);
        self.made_at.clone_from(&self.positions);
        self.builds += 1;
        self.stale = false;
        Ok(())
    }

    /// Sets which particles are passive, and which neither see nor are seen, by number, from the
    /// next update on.
    pub fn exclude(&mut self, passive: Vec<bool>, excluded: Vec<bool>) {
        (self.passive, self.excluded, self.stale) = (passive, excluded, true);
    }

    fn take(&mut self, position: &(impl Fn(usize) -> Vector<D> + Sync)) {
        let (numbers, domain) = (&self.numbers, &self.domain);
        parallel::for_each_chunk(&mut self.positions, |first, rows| {
            for (row, &number) in rows.iter_mut().zip(&numbers[first..]) {
                *row = domain.wrap(&position(number as usize));
            }
        });
    }

    /// Renews the places and lists the candidates of the current positions.
    fn build(&mut self) -> Result<(), NeighborError> {
        let reach = self.support + self.skin;
        let order = spatial_order(&self.positions, reach)?;
        let ordered: Vec<_> = order.iter().map(|&place| self.positions[place as usize]).collect();
        let list = search(&ordered, &vec![reach; ordered.len()], &self.domain)?;
        self.numbers = order.iter().map(|&place| self.numbers[place as usize]).collect();
        for (place, &number) in self.numbers.iter().enumerate() {
            self.places[number as usize] = place as u32;
        }
        let (numbers, passive) = (&self.numbers, &self.passive);
        let is_passive = |place: u32| passive[numbers[place as usize] as usize];
        let excluded = &self.excluded;
        let is_out = |place: u32| {
            excluded.get(numbers[place as usize] as usize).is_some_and(|excluded| *excluded)
        };
        let list = match passive.contains(&true) {
            true => {
                list.retain(|a, b| !(is_passive(a) && is_passive(b)) && !is_out(a) && !is_out(b))
            }
            false => list,
        };
        let key =
            |place: u32| u64::from(is_passive(place)) << 32 | u64::from(numbers[place as usize]);
        (self.offsets, self.entries) = list.into_arrays();
        sort_rows(&self.offsets, &mut self.entries, key);
        self.passive_from = (self.offsets.windows(2))
            .map(|ends| {
                let row = &self.entries[ends[0]..ends[1]];
                ends[0] + row.partition_point(|&place| !is_passive(place))
            })
            .collect();
        Ok(())
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Number of the particle at each place.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Place of each particle.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Positions in m by place, inside the bounds of the domain.
    pub fn positions(&self) -> &[Vector<D>] {
        &self.positions
    }

    /// Whether the particle at a place is passive.
    pub fn is_passive(&self, place: usize) -> bool {
        self.passive[self.numbers[place] as usize]
    }

    /// Candidates of the particle at `place` that are not passive.
    #[inline]
    pub fn active_row(&self, place: usize) -> &[u32] {
        &self.entries[self.offsets[place]..self.passive_from[place]]
    }

    /// Candidates of the particle at `place` that are passive.
    #[inline]
    pub fn passive_row(&self, place: usize) -> &[u32] {
        &self.entries[self.passive_from[place]..self.offsets[place + 1]]
    }

    /// How often the list was made.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// The space that the particles live in.
    pub fn domain(&self) -> &Domain<D> {
        &self.domain
    }

    /// Support radius in m.
    pub fn support(&self) -> f64 {
        self.support
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        let particle = 2 * size_of::<Vector<D>>() + 2 * size_of::<usize>() + 2 * size_of::<u32>();
        self.len() * particle + self.entries.len() * size_of::<u32>()
    }
}

/// Sorts each row by a key, on all threads.
fn sort_rows(offsets: &[usize], entries: &mut [u32], key: impl Fn(u32) -> u64 + Sync) {
    let mut parts = Vec::new();
    let mut rest = entries;
    for ends in offsets.windows(CHUNK + 1).step_by(CHUNK).chain(last_window(offsets)) {
        let (part, after) = rest.split_at_mut(ends[ends.len() - 1] - ends[0]);
        parts.push((ends, part));
        rest = after;
    }
    parts.into_par_iter().for_each(|(ends, part)| {
        for row in ends.windows(2) {
            part[row[0] - ends[0]..row[1] - ends[0]].sort_unstable_by_key(|&place| key(place));
        }
    });
}

/// The ends of the rows after the last whole chunk.
fn last_window(offsets: &[usize]) -> Option<&[usize]> {
    let whole = (offsets.len() - 1) / CHUNK * CHUNK;
    (whole + 1 < offsets.len()).then(|| &offsets[whole..])
}
