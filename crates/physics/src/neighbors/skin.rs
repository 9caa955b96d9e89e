//! Neighbour lists of moving particles, kept over many steps.

use std::borrow::Cow;
use std::mem::take;

use super::list::Rows;
use super::order::{Key, order_along};
use super::search::{Candidates, RankedSearch, check_points};
use super::{Domain, NeighborError, shorter_way};
use crate::parallel::Team;
use crate::{Vector, parallel};

/// Positions in m and numbers of particles.
type Points<'a, const D: usize> = (Cow<'a, [Vector<D>]>, Cow<'a, [u32]>);

/// Candidates for the neighbours of moving particles: all that were closer than the support
/// radius and a skin when the list was made. It holds as long as no particle has moved by more
/// than half of the skin.
///
/// Particles have a *number*, which never changes, and a *place* in memory, which is renewed with
/// the list so that neighbours stay close. Rows name places, but stand in the order of numbers:
/// a sum over those in a row that are inside the support is the same to the bit, whenever the
/// list was made. Particles that are `passive` see only the others, and stand last in their rows.
///
/// One of several ranks has rows of its own particles alone, which have the first places; behind them are copies of the
/// particles of others that stand in these rows. All ranks make their lists at the same time, of all positions.
pub struct SkinList<const D: usize> {
    domain: Domain<D>,
    support: f64,
    skin: f64,
    passive: Vec<bool>,
    /// Place of each number in the order of rows: those that are not passive first, which are as
    /// many as `active`.
    ranks: Vec<u32>,
    active: u32,
    /// Particles that no others see, by number; empty if there are none.
    excluded: Vec<bool>,
    /// Whether the list has to be made anew, whoever moved.
    stale: bool,
    /// Who computes together.
    team: Team,
    /// Number of the particle at each place, and place of each own particle.
    numbers: Vec<u32>,
    places: Vec<u32>,
    /// Positions by place, inside the bounds of the domain: now, and when the list was made.
    positions: Vec<Vector<D>>,
    made_at: Vec<Vector<D>>,
    /// Makes rows of own particles, and has them.
    search: RankedSearch<D>,
    /// Entries of each row that are not passive.
    seen: Vec<u32>,
    builds: u64,
    scratch: Scratch<D>,
}

/// What the next list is made with.
#[derive(Default)]
struct Scratch<const D: usize> {
    keys: Vec<Key>,
    /// Positions in m, numbers and ranks of particles in the new order, and the place of each rank in it.
    points: Vec<Vector<D>>,
    numbers: Vec<u32>,
    ranks: Vec<u32>,
    ranked: Vec<u32>,
}

impl<const D: usize> SkinList<D> {
    /// A list of particles at `positions` in m, by number, with one support radius and skin in m.
    ///
    /// # Errors
    /// Those of [`search`](fn@super::search::search) for the support with its skin.
    pub fn new(
        positions: &[Vector<D>],
        passive: Vec<bool>,
        support: f64,
        skin: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let numbers: Vec<u32> = (0..positions.len() as u32).collect();
        let mut ranks = Vec::new();
        let active = rank(&passive, &mut ranks);
        let mut list = Self {
            domain,
            support,
            skin,
            passive,
            ranks,
            active,
            excluded: Vec::new(),
            stale: false,
            team: Team::default(),
            places: numbers.clone(),
            numbers,
            positions: vec![Vector::zeros(); positions.len()],
            made_at: Vec::new(),
            search: RankedSearch::default(),
            seen: Vec::new(),
            builds: 0,
            scratch: Scratch::default(),
        };
        list.update(&mut vec![(); positions.len()], |number, ()| positions[number])?;
        Ok(list)
    }

    /// Takes new positions in m, and makes the list anew where it no longer holds: `take(number,
    /// row)` is the position of a particle, and fills the row at its place, too. False when
    /// everything is where it was.
    ///
    /// # Errors
    /// Those of [`search`](fn@super::search::search); the list then is as it was, or has no neighbours.
    pub fn update<T: Send>(
        &mut self,
        rows: &mut [T],
        take: impl Fn(usize, &mut T) -> Vector<D> + Sync,
    ) -> Result<bool, NeighborError> {
        let own = self.take(rows, &take);
        let [most] = self.team.largest([own]);
        if self.builds > 0 && !self.stale && most <= 0.25 * self.skin * self.skin {
            if most >= 0.0 {
                self.fetch_positions();
            }
            return Ok(most >= 0.0);
        }
        // Until it is made, the list does not belong to the positions.
        self.stale = true;
        let built = self.build();
        if built.is_ok() {
            self.take(rows, &take);
            self.made_at.clone_from(&self.positions);
            self.builds += 1;
            self.stale = false;
        }
        self.fetch_positions();
        built.map(|()| true)
    }

    /// Takes the positions of copies from those who have the particles.
    fn fetch_positions(&mut self) {
        let owned = self.owned();
        self.team.refresh(&mut self.positions, owned, 1);
    }

    /// The list of one of several ranks, which is made at the first update.
    pub(crate) fn part(&self, team: Team, count: usize) -> Self {
        let mut search = RankedSearch::default();
        search.rows.clear(count);
        let numbers = (0..count as u32).map(|row| row + team.first() as u32);
        Self {
            domain: self.domain,
            support: self.support,
            skin: self.skin,
            passive: self.passive.clone(),
            ranks: self.ranks.clone(),
            active: self.active,
            excluded: self.excluded.clone(),
            stale: true,
            numbers: numbers.collect(),
            places: (0..count as u32).collect(),
            positions: vec![Vector::zeros(); count],
            made_at: Vec::new(),
            search,
            seen: vec![0; count],
            builds: 0,
            team,
            scratch: Scratch::default(),
        }
    }

    /// Sets which particles are passive, and which neither see nor are seen, by number, from the
    /// next update on.
    pub fn exclude(&mut self, passive: &[bool], excluded: &[bool]) {
        self.active = rank(passive, &mut self.ranks);
        self.passive.clear();
        self.passive.extend_from_slice(passive);
        self.excluded.clear();
        self.excluded.extend_from_slice(excluded);
        self.stale = true;
    }

    /// Takes positions, and returns the square in m^2 of the longest way from where the list was
    /// made, of those who moved; it is negative where none did.
    fn take<T: Send>(
        &mut self,
        rows: &mut [T],
        take: &(impl Fn(usize, &mut T) -> Vector<D> + Sync),
    ) -> f64 {
        let (numbers, domain, made_at) = (&self.numbers, &self.domain, &self.made_at);
        let periods = domain.periods();
        let positions = &mut self.positions[..self.places.len()];
        parallel::maximum_of_chunks(positions, rows, -1.0, |first, positions, rows| {
            let (mut has_moved, mut most) = (false, 0.0);
            for (k, (kept, row)) in positions.iter_mut().zip(rows).enumerate() {
                let position = domain.wrap(&take(numbers[first + k] as usize, row));
                has_moved |= *kept != position;
                *kept = position;
                let mut square = 0.0;
                if let Some(made_at) = made_at.get(first + k) {
                    for axis in 0..D {
                        let way = shorter_way(position[axis] - made_at[axis], periods[axis]);
                        square += way * way;
                    }
                }
                most = parallel::larger(most, square);
            }
            if has_moved { most } else { -1.0 }
        })
    }

    /// Renews the places and lists the candidates of the current positions.
    fn build(&mut self) -> Result<(), NeighborError> {
        let (mut scratch, mut search) = (take(&mut self.scratch), take(&mut self.search));
        let built = self.build_with(&mut scratch, &mut search);
        if search.rows.is_empty() {
            search.rows.clear(self.owned());
        }
        (self.scratch, self.search) = (scratch, search);
        built
    }

    fn build_with(
        &mut self,
        scratch: &mut Scratch<D>,
        search: &mut RankedSearch<D>,
    ) -> Result<(), NeighborError> {
        let (reach, owned, first) = (self.support + self.skin, self.owned(), self.team.first());
        let (own, (positions, all)) = (first..first + owned, self.around(reach)?);
        let Scratch { keys, points, numbers, ranks, ranked } = scratch;
        // Those that no others see come last and are not looked for: many may be in one place. Own ones come first.
        let class = |at: usize| {
            let number = all[at] as usize;
            let is_out = self.excluded.get(number).is_some_and(|is_out| *is_out);
            2 * u8::from(is_out) + u8::from(!own.contains(&number))
        };
        order_along(&positions, reach, class, keys)?;
        let seen = keys.partition_point(|key| key.0 < 2);
        let seeing = keys.partition_point(|key| key.0 == 0);
        let order = || keys.iter().map(|key| key.2 as usize);
        points.clear();
        points.extend(order().map(|at| positions[at]));
        numbers.clear();
        numbers.extend(order().map(|at| all[at]));
        ranks.clear();
        ranks.extend(numbers.iter().map(|&number| self.ranks[number as usize]));
        ranked.clear();
        ranked.resize(self.ranks.len(), 0);
        for (place, &rank) in ranks.iter().enumerate() {
            ranked[rank as usize] = place as u32;
        }
        let (both, rows) = ([ranks.as_slice(), ranked.as_slice()], [seeing, self.active as usize]);
        let made = search.make(&points[..seen], (reach, &self.domain), both, rows);
        if !self.team.all(made.is_ok()) {
            // What was made here belongs to places that nobody takes.
            search.rows.clear(owned);
            return Err(made.err().unwrap_or(NeighborError::OtherRank));
        }
        search.rows.extend(owned);
        let is_active = |&at: &u32| ranks[at as usize] < self.active;
        let seen_of = |row: usize| search.rows.row(row).partition_point(is_active) as u32;
        self.seen.clear();
        self.seen.extend((0..owned).map(seen_of));
        let copies = Self::copies(&self.team, owned, numbers, &mut search.rows);
        self.numbers.clear();
        self.numbers.extend_from_slice(&numbers[..seeing]);
        self.numbers.extend_from_slice(&numbers[seen..][..owned - seeing]);
        self.numbers.extend(copies.iter().map(|(_, at)| numbers[*at]));
        for (place, &number) in self.numbers[..owned].iter().enumerate() {
            self.places[number as usize - first] = place as u32;
        }
        self.positions.resize(self.numbers.len(), Vector::zeros());
        let wanted: Vec<(usize, usize)> =
            copies.iter().map(|&(rank, at)| (rank, numbers[at] as usize)).collect();
        self.team.renew(&wanted, |number| self.places[number - first]);
        Ok(())
    }

    /// Positions in m and numbers of own particles and of all others in a box around them that is wider by `reach` m: no
    /// one else can be their neighbour.
    fn around(&self, reach: f64) -> Result<Points<'_, D>, NeighborError> {
        if self.team.is_alone() {
            return Ok((Cow::Borrowed(&self.positions), Cow::Borrowed(&self.numbers)));
        }
        let own: Vec<_> = self.places.iter().map(|&at| self.positions[at as usize]).collect();
        let mut corners = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::<D>::repeat);
        for point in &own {
            corners = [corners[0].inf(point), corners[1].sup(point)];
        }
        let all = self.team.rows_of_all(own);
        if all.len() != self.ranks.len() {
            return Err(NeighborError::OtherRank);
        }
        check_points(&all)?;
        let (center, periods) = ((corners[0] + corners[1]) / 2.0, self.domain.periods());
        // With more than rounding takes.
        let rounding = (corners[0].abs() + corners[1].abs()) * (4.0 * f64::EPSILON);
        let half = (corners[1] - corners[0]).add_scalar(2.0 * reach) / 2.0 + rounding;
        let is_near = |point: &Vector<D>| {
            let way = |axis: usize| shorter_way(point[axis] - center[axis], periods[axis]);
            (0..D).all(|axis| way(axis).abs() <= half[axis])
        };
        // Own ones are there, however far apart they are.
        let owned = self.owned();
        let is_own = |number: u32| self.team.own(number as usize, owned).is_some();
        let near = (0..).zip(&all).filter(|(number, point)| is_own(*number) || is_near(point));
        let (numbers, positions): (Vec<u32>, Vec<_>) = near.unzip();
        Ok((Cow::Owned(positions), Cow::Owned(numbers)))
    }

    /// What `rows`, which say where others stand in the order of `numbers`, name of other ranks: the rank and where it
    /// stands there, rank by rank. From then on rows name the places of the copies behind own particles.
    fn copies(
        team: &Team,
        owned: usize,
        numbers: &[u32],
        rows: &mut Rows<Candidates<D>>,
    ) -> Vec<(usize, usize)> {
        if team.is_alone() {
            return Vec::new();
        }
        let mut is_named = vec![false; numbers.len()];
        rows.each_mut().for_each(|at| is_named[*at as usize] = true);
        let others = numbers.iter().zip(is_named).enumerate().filter(|(_, (number, is_named))| {
            *is_named && team.own(**number as usize, owned).is_none()
        });
        let mut copies: Vec<(usize, usize)> =
            others.map(|(at, (number, _))| (team.owner(*number as usize), at)).collect();
        copies.sort_unstable();
        let mut places: Vec<u32> = (0..numbers.len() as u32).collect();
        for (place, (_, at)) in (owned as u32..).zip(&copies) {
            places[*at] = place;
        }
        rows.each_mut().for_each(|at| *at = places[*at as usize]);
        copies
    }

    /// Who computes together.
    pub fn team(&self) -> &Team {
        &self.team
    }

    /// Number of own particles, which have the first places.
    pub fn owned(&self) -> usize {
        self.places.len()
    }

    /// Number of particles, with the copies of those of other ranks.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Number of particles of all ranks.
    pub fn all_count(&self) -> usize {
        self.ranks.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Number of the particle at each place.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Place of each own particle, in the order of numbers.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Positions in m by place, inside the bounds of the domain.
    pub fn positions(&self) -> &[Vector<D>] {
        &self.positions
    }

    /// Whether the particle at a place is passive.
    #[inline]
    pub fn is_passive(&self, place: usize) -> bool {
        self.passive[self.numbers[place] as usize]
    }

    /// Number of candidates of all particles.
    pub fn entries(&self) -> usize {
        self.search.rows.entries()
    }

    /// Candidates of the particle at `place`.
    pub fn row(&self, place: usize) -> &[u32] {
        self.search.rows.row(place)
    }

    /// Number of candidates of all particles before `place`.
    #[inline]
    pub fn offset(&self, place: usize) -> usize {
        self.search.rows.offset(place)
    }

    /// Candidates of the particle at `place` that are not passive.
    #[inline]
    pub fn active_row(&self, place: usize) -> &[u32] {
        &self.row(place)[..self.seen[place] as usize]
    }

    /// Candidates of the particle at `place` that are passive.
    #[inline]
    pub fn passive_row(&self, place: usize) -> &[u32] {
        &self.row(place)[self.seen[place] as usize..]
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
        let Scratch { keys, points, numbers, ranks, ranked } = &self.scratch;
        let words = [numbers, ranks, ranked, &self.numbers, &self.places, &self.seen];
        let places = [&self.positions, &self.made_at, points];
        words.map(Vec::capacity).iter().sum::<usize>() * size_of::<u32>()
            + places.map(Vec::capacity).iter().sum::<usize>() * size_of::<Vector<D>>()
            + keys.capacity() * size_of::<Key>()
            + self.search.memory()
    }
}

/// Finds the place of each number in the order of rows, and returns how many are not passive.
fn rank(passive: &[bool], ranks: &mut Vec<u32>) -> u32 {
    let active = passive.iter().filter(|&&is_passive| !is_passive).count() as u32;
    let mut next = [0, active];
    let rank = |&is_passive: &bool| {
        let next = &mut next[usize::from(is_passive)];
        *next += 1;
        *next - 1
    };
    ranks.clear();
    ranks.extend(passive.iter().map(rank));
    active
}
