//! The neighbours inside the support, picked from the candidates of a list.

use multiversion::multiversion;

use super::LANES;
use super::block::all_of;
use super::frozen::RowSizes;
use crate::neighbors::{SkinList, shorter_way};
use crate::{Vector, parallel};

/// For each particle those candidates of a [`SkinList`] that are inside the support at its current
/// positions, in the order of the list, filled up to whole groups with the last of them.
///
/// They are picked once for all the sums at these positions: a choice costs as much as the terms
/// of a simple sum.
#[derive(Clone, Debug, Default)]
pub(super) struct InsideRows {
    /// Rows one after the other, from the start of each chunk of particles on.
    places: Vec<u32>,
    rows: Vec<Row>,
}

/// Where a row stands.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    start: usize,
    /// How many are not passive, in the groups that stand first, and how many are passive.
    active: u32,
    passive: u32,
}

/// Entries of a row beyond its candidates: what fills up the groups of both kinds.
const ROOM: usize = 2 * LANES;

/// The part of space in which neighbours are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach<const D: usize> {
    /// Square of the support radius in m^2.
    pub limit: f64,
    /// Periods in m, infinite along open axes.
    pub periods: [f64; D],
    /// Between these bounds in m a particle has no neighbour across a periodic one.
    pub within: [[f64; 2]; D],
}

impl<const D: usize> Reach<D> {
    /// Whether neighbours of a particle may lie across a periodic bound.
    #[inline]
    pub fn wraps(&self, position: &Vector<D>) -> bool {
        let is_within = |(x, [low, high]): (&f64, &[f64; 2])| low <= x && x <= high;
        !position.iter().zip(&self.within).all(is_within)
    }
}

impl InsideRows {
    /// Picks the rows anew.
    pub fn pick<const D: usize>(&mut self, list: &SkinList<D>, reach: &Reach<D>) {
        self.rows.resize(list.owned(), Row::default());
        self.places.resize(list.entries() + ROOM * list.owned(), 0);
        parallel::for_each_span(
            &mut self.places,
            &mut self.rows,
            &|row| start(list, row),
            |first, places, rows| pick(list, reach, first, places, rows),
        );
    }

    /// Takes out those pairs of an active and a one-sided passive particle, by place, that do not see each
    /// other.
    pub fn retain<const D: usize>(
        &mut self,
        list: &SkinList<D>,
        is_sided: impl Fn(usize) -> bool + Sync,
        sees: impl Fn(usize, usize) -> bool + Sync,
    ) {
        let filter = |first: usize, places: &mut [u32], rows: &mut [Row]| {
            let from = start(list, first);
            for (offset, row) in rows.iter_mut().enumerate() {
                let (place, begin) = (first + offset, row.start - from);
                if is_sided(place) {
                    let own = &mut places[begin..];
                    row.active = compact(own, row.active, |other| sees(other, place));
                } else if row.passive > 0 {
                    let own = &mut places[begin + (row.active as usize).next_multiple_of(LANES)..];
                    let stays = |other| !is_sided(other) || sees(place, other);
                    row.passive = compact(own, row.passive, stays);
                }
            }
        };
        let starts = |row: usize| start(list, row);
        parallel::for_each_span(&mut self.places, &mut self.rows, &starts, filter);
    }

    /// The neighbours of a particle that are not passive, in whole groups, and how many they are.
    #[inline]
    pub fn active(&self, place: usize) -> (&[u32], usize) {
        let row = &self.rows[place];
        let length = row.active as usize;
        (&self.places[row.start..][..length.next_multiple_of(LANES)], length)
    }

    /// The passive neighbours of a particle, as [`Self::active`] has the others.
    #[inline]
    pub fn passive(&self, place: usize) -> (&[u32], usize) {
        let row = &self.rows[place];
        let length = row.passive as usize;
        let start = row.start + (row.active as usize).next_multiple_of(LANES);
        (&self.places[start..][..length.next_multiple_of(LANES)], length)
    }

    /// How large the rows of some particles are.
    pub fn sizes(&self, is_counted: impl Fn(usize) -> bool) -> RowSizes {
        let own = || (0..self.rows.len()).filter(|&place| is_counted(place));
        let of = |place: usize| self.active(place).0.len() + self.passive(place).0.len();
        let (rows, entries) = (own().count(), own().map(of).sum());
        let bytes = rows * size_of::<Row>() + entries * size_of::<u32>();
        RowSizes { rows, entries, bytes }
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.places.as_slice()) + size_of_val(self.rows.as_slice())
    }
}

/// Moves the first `count` places that stay to the front, in their order, and fills up their last group.
/// Returns how many they are.
fn compact(places: &mut [u32], count: u32, stays: impl Fn(usize) -> bool) -> u32 {
    let mut kept = 0;
    for k in 0..count as usize {
        let place = places[k];
        if stays(place as usize) {
            places[kept] = place;
            kept += 1;
        }
    }
    if let Some(last) = kept.checked_sub(1) {
        let last = places[last];
        places[kept..kept.next_multiple_of(LANES)].fill(last);
    }
    kept as u32
}

/// Where there is room for a row.
fn start<const D: usize>(list: &SkinList<D>, row: usize) -> usize {
    list.offset(row) + ROOM * row
}

/// Picks the rows of some particles.
#[multiversion(targets("x86_64+avx2+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn pick<const D: usize>(
    list: &SkinList<D>,
    reach: &Reach<D>,
    first: usize,
    places: &mut [u32],
    rows: &mut [Row],
) {
    let positions = list.positions();
    let from = start(list, first);
    let mut length = 0;
    for (offset, row) in rows.iter_mut().enumerate() {
        let place = first + offset;
        let here = &positions[place];
        let wraps = reach.wraps(here);
        *row = Row { start: from + length, active: 0, passive: 0 };
        for (candidates, kept) in
            [(list.active_row(place), &mut row.active), (list.passive_row(place), &mut row.passive)]
        {
            if !candidates.is_empty() {
                let room = &mut places[length..];
                let count = match wraps {
                    true => keep::<D, true>(here, candidates, positions, reach, room),
                    false => keep::<D, false>(here, candidates, positions, reach, room),
                };
                *kept = count as u32;
                length += count.next_multiple_of(LANES);
            }
        }
    }
}

/// Writes those candidates that are inside the support to the front of `kept`, which has room for
/// all of them and a group, fills up their last group, and returns how many they are.
#[inline(always)]
fn keep<const D: usize, const WRAPS: bool>(
    here: &Vector<D>,
    candidates: &[u32],
    positions: &[Vector<D>],
    reach: &Reach<D>,
    kept: &mut [u32],
) -> usize {
    let mut length = 0;
    let (groups, rest) = candidates.as_chunks::<LANES>();
    for places in groups {
        length += keep_group::<D, WRAPS>(here, places, positions, reach, &mut kept[length..]);
    }
    if let Some(last) = rest.last() {
        // The last one fills the group up, and is taken back as often as it was kept for that.
        let mut places = [*last; LANES];
        places[..rest.len()].copy_from_slice(rest);
        let front = length;
        length += keep_group::<D, WRAPS>(here, &places, positions, reach, &mut kept[length..]);
        let filled = LANES - rest.len();
        if length > front && kept[length - 1] == *last {
            length -= filled;
        }
    }
    if let Some(last) = length.checked_sub(1) {
        let last = kept[last];
        *window(&mut kept[length..]) = [last; LANES];
    }
    length
}

/// Writes those of a group that are inside the support to the front of `kept`, and returns how many
/// they are.
#[inline(always)]
fn keep_group<const D: usize, const WRAPS: bool>(
    here: &Vector<D>,
    places: &[u32; LANES],
    positions: &[Vector<D>],
    reach: &Reach<D>,
    kept: &mut [u32],
) -> usize {
    let others = all_of(positions, places);
    let mut squares = [0.0; LANES];
    for axis in 0..D {
        let mut distances = [0.0; LANES];
        for lane in 0..LANES {
            distances[lane] = here[axis] - others[lane][axis];
        }
        for lane in 0..LANES {
            let distance = match WRAPS {
                true => shorter_way(distances[lane], reach.periods[axis]),
                false => distances[lane],
            };
            squares[lane] += distance * distance;
        }
    }
    let is_inside = squares.map(|square| u8::from(square < reach.limit));
    // Every candidate is written and kept by the step of the counter, as a branch would be
    // guessed wrong every third time.
    let window = window(kept);
    let mut more = 0;
    for lane in 0..LANES {
        window[more % LANES] = places[lane];
        more += usize::from(is_inside[lane]);
    }
    more
}

/// The first entries of what there is room for.
#[inline(always)]
fn window(kept: &mut [u32]) -> &mut [u32; LANES] {
    kept.first_chunk_mut().expect("there is room for a group beyond the candidates")
}
