//! Holes in what particles fill.

use crate::schemes::Observation;

/// Cells of the grid per spacing.
const CELLS: f64 = 3.0;

/// Cells that a grid may have at most: a byte each.
const MOST: f64 = 1e8;

/// The volume of the largest void. A point is empty if it is farther than a spacing from every particle, so that a
/// particle more has room there. Empty points that hang together, and from which no empty way leads out of the box around
/// all particles, are a void, which reaches half a spacing further than they, to the edges of the volumes of the
/// particles around it. It is found on a grid of a third of the smallest spacing.
#[derive(Clone)]
pub struct Void {
    /// Periods of space in m by axis, infinite where it is open.
    pub periods: Vec<f64>,
    /// Indices in memory of the particles that count, with the spacing of each in m.
    pub particles: Vec<(u32, f64)>,
}

impl Void {
    /// In m^D; not a number if the particles are too far apart for a grid.
    pub(super) fn record(&self, now: &mut Observation) -> f64 {
        let all: Vec<u32> = self.particles.iter().map(|(a, _)| *a).collect();
        let (places, bodies) = (now.values("position", &all), now.scheme().bodies());
        let is_there =
            |a: u32| now.scheme().body_of(now.state(), a as usize) == Some(bodies[a as usize]);
        let dimension = now.scheme().dimension();
        let both = places.chunks_exact(dimension).zip(&self.particles);
        let present = both.filter(|(_, (a, _))| is_there(*a));
        let present: Vec<_> = present.map(|(place, (_, spacing))| (place, *spacing)).collect();
        largest_void(&present, &self.periods)
    }
}

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    /// Farther than a spacing from every particle.
    Empty,
    /// Near a particle.
    Filled,
    /// Empty, with a way out.
    Outside,
    /// Empty, and of a void.
    Inside,
    /// Of the largest void, or near a particle and counted with it.
    Counted,
}

/// Cells of a box, along three axes of which unused ones have one cell.
struct Grid {
    lower: [f64; 3],
    pitch: [f64; 3],
    counts: [usize; 3],
    wraps: [bool; 3],
    /// How many axes there are.
    dimension: usize,
    cells: Vec<Cell>,
}

/// The volume in m^D of the largest void between particles, each with its spacing in m.
fn largest_void(particles: &[(&[f64], f64)], periods: &[f64]) -> f64 {
    let Some(finest) = particles.iter().map(|(_, spacing)| *spacing).reduce(f64::min) else {
        return 0.0;
    };
    let Some(mut grid) = Grid::around(particles, finest / CELLS, periods) else { return f64::NAN };
    for (place, spacing) in particles {
        grid.fill(place, *spacing);
    }
    grid.open();
    let mut largest = (0, 0);
    for cell in 0..grid.cells.len() {
        if grid.cells[cell] == Cell::Empty {
            let size = grid.follow(vec![cell], [Cell::Empty, Cell::Inside], |_, _| ());
            largest = largest.max((size, cell));
        }
    }
    let of_cell: f64 = grid.pitch[..grid.dimension].iter().product();
    grid.grown(largest.1, 0.5 * finest) as f64 * of_cell
}

impl Grid {
    /// An empty grid of about this pitch in m around all particles, with cells to spare along axes that do not wrap.
    fn around(particles: &[(&[f64], f64)], pitch: f64, periods: &[f64]) -> Option<Self> {
        let (mut lower, mut pitches, mut counts) = ([0.0; 3], [pitch; 3], [1; 3]);
        let mut wraps = [false; 3];
        for (axis, period) in periods.iter().enumerate() {
            let along = particles.iter().map(|(place, spacing)| (place[axis], 2.0 * spacing));
            let low = along.clone().fold(f64::INFINITY, |low, (x, spare)| low.min(x - spare));
            let high = along.fold(f64::NEG_INFINITY, |high, (x, spare)| high.max(x + spare));
            wraps[axis] = period.is_finite();
            let length = if wraps[axis] { *period } else { high - low };
            let count = (length / pitch).ceil();
            if !(1.0..=MOST).contains(&count) {
                return None;
            }
            (lower[axis], pitches[axis], counts[axis]) = (low, length / count, count as usize);
        }
        let cells = counts.iter().map(|&count| count as f64).product::<f64>();
        (cells <= MOST).then(|| Self {
            lower,
            pitch: pitches,
            counts,
            wraps,
            dimension: periods.len(),
            cells: vec![Cell::Empty; cells as usize],
        })
    }

    /// The cell at whole numbers along the axes, if there is one.
    fn index(&self, at: [isize; 3]) -> Option<usize> {
        let mut index = 0;
        for axis in (0..3).rev() {
            let count = self.counts[axis] as isize;
            let own = if self.wraps[axis] { at[axis].rem_euclid(count) } else { at[axis] };
            if !(0..count).contains(&own) {
                return None;
            }
            index = index * self.counts[axis] + own as usize;
        }
        Some(index)
    }

    /// The numbers of a cell along the axes.
    fn numbers(&self, cell: usize) -> [isize; 3] {
        let [x, y, _] = self.counts;
        [cell % x, cell / x % y, cell / (x * y)].map(|number| number as isize)
    }

    /// Calls `visit` with the cells whose middles are within `reach` in m of a place.
    fn near(&mut self, place: &[f64], reach: f64, mut visit: impl FnMut(&mut Cell)) {
        let (mut first, mut last) = ([0; 3], [0; 3]);
        for (axis, x) in place.iter().enumerate() {
            let middle = (x - self.lower[axis]) / self.pitch[axis] - 0.5;
            let half = reach / self.pitch[axis];
            first[axis] = (middle - half).ceil() as isize;
            last[axis] = (middle + half).floor() as isize;
        }
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    let at = [x, y, z];
                    let offset = place.iter().enumerate().map(|(axis, own)| {
                        self.lower[axis] + (at[axis] as f64 + 0.5) * self.pitch[axis] - own
                    });
                    let is_near = offset.map(|x| x * x).sum::<f64>() <= reach * reach;
                    if let (true, Some(index)) = (is_near, self.index(at)) {
                        visit(&mut self.cells[index]);
                    }
                }
            }
        }
    }

    /// Fills what is within `reach` in m of a particle.
    fn fill(&mut self, place: &[f64], reach: f64) {
        self.near(place, reach, |cell| *cell = Cell::Filled);
    }

    /// Follows the empty ways that lead into the box from outside.
    fn open(&mut self) {
        let is_outer = |cell: &usize| {
            let at = self.numbers(*cell);
            (0..self.dimension).any(|axis| {
                !self.wraps[axis] && (at[axis] == 0 || at[axis] as usize == self.counts[axis] - 1)
            })
        };
        let outer = (0..self.cells.len()).filter(is_outer).collect();
        self.follow(outer, [Cell::Empty, Cell::Outside], |_, _| ());
    }

    /// Turns the cells of one kind that hang together with some, these included, into another, and calls `visit` with each.
    /// How many there are.
    fn follow(
        &mut self,
        mut next: Vec<usize>,
        [from, to]: [Cell; 2],
        mut visit: impl FnMut(&mut Self, usize),
    ) -> usize {
        let mut count = 0;
        next.retain(|&cell| self.turn(cell, [from, to]));
        while let Some(cell) = next.pop() {
            count += 1;
            visit(self, cell);
            let at = self.numbers(cell);
            for axis in 0..self.dimension {
                for step in [-1, 1] {
                    let mut beside = at;
                    beside[axis] += step;
                    next.extend(self.index(beside).filter(|&cell| self.turn(cell, [from, to])));
                }
            }
        }
        count
    }

    /// Turns a cell of one kind into another; whether it was of that kind.
    fn turn(&mut self, cell: usize, [from, to]: [Cell; 2]) -> bool {
        let is_one = self.cells[cell] == from;
        if is_one {
            self.cells[cell] = to;
        }
        is_one
    }

    /// How many cells there are in the void that one belongs to, and within `reach` in m around it.
    fn grown(&mut self, cell: usize, reach: f64) -> usize {
        let mut edge = 0;
        let core = self.follow(vec![cell], [Cell::Inside, Cell::Counted], |grid, cell| {
            let at = grid.numbers(cell);
            let place: [f64; 3] = std::array::from_fn(|axis| {
                grid.lower[axis] + (at[axis] as f64 + 0.5) * grid.pitch[axis]
            });
            let dimension = grid.dimension;
            grid.near(&place[..dimension], reach, |cell| {
                if *cell == Cell::Filled {
                    *cell = Cell::Counted;
                    edge += 1;
                }
            });
        });
        core + edge
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice of spacing 1 in a box of `sides`, without what `is_hollow`.
    fn lattice(sides: &[usize], is_hollow: impl Fn(&[f64]) -> bool) -> Vec<Vec<f64>> {
        let sites = (0..sides.iter().product()).map(|mut number: usize| {
            let site = sides.iter().map(|side| {
                let own = number % side;
                number /= side;
                own as f64 + 0.5
            });
            site.collect::<Vec<f64>>()
        });
        sites.filter(|site| !is_hollow(site)).collect()
    }

    fn void_of(sites: &[Vec<f64>], periods: &[f64]) -> f64 {
        let particles: Vec<_> = sites.iter().map(|site| (site.as_slice(), 1.0)).collect();
        largest_void(&particles, periods)
    }

    fn distance(site: &[f64], middle: &[f64]) -> f64 {
        site.iter().zip(middle).map(|(x, m)| (x - m).powi(2)).sum::<f64>().sqrt()
    }

    const OPEN: [f64; 3] = [f64::INFINITY; 3];

    #[test]
    fn a_full_lattice_has_no_void_and_neither_has_one_without_a_particle() {
        for sides in [&[9, 9][..], &[9, 9, 9]] {
            let dimension = sides.len();
            assert_eq!(void_of(&lattice(sides, |_| false), &OPEN[..dimension]), 0.0);
            let one = lattice(sides, |site| distance(site, &[4.5; 3]) < 0.1);
            assert_eq!(void_of(&one, &OPEN[..dimension]), 0.0);
        }
    }

    #[test]
    fn a_void_has_the_volume_of_the_particles_that_are_missing() {
        // Its edge is half a spacing from the particles around it, and the lattice knows it to half a spacing.
        for (sides, middle, radius) in
            [(&[30, 26][..], [15.0, 13.0, 0.0], 8.0), (&[20, 21, 22], [10.0, 10.0, 11.0], 6.0)]
        {
            let dimension = sides.len();
            let sites = lattice(sides, |site| distance(site, &middle) < radius);
            let missing = sides.iter().product::<usize>() - sites.len();
            let found = void_of(&sites, &OPEN[..dimension]);
            let ball = |r: f64| match dimension {
                2 => std::f64::consts::PI * r * r,
                _ => 4.0 / 3.0 * std::f64::consts::PI * r.powi(3),
            };
            assert!((found - ball(radius)).abs() < ball(radius + 0.5) - ball(radius), "{found}");
            assert!((found - missing as f64).abs() < ball(radius + 0.5) - ball(radius));
        }
    }

    #[test]
    fn what_is_open_to_the_outside_is_no_void() {
        let cup = lattice(&[20, 20], |site| (site[0] - 10.0).abs() < 4.0 && site[1] > 8.0);
        assert_eq!(void_of(&cup, &OPEN[..2]), 0.0);
        // With a lid it is one: 8 x 11 sites are missing.
        let mut closed = cup;
        closed.extend((0..8).map(|k| vec![6.5 + f64::from(k), 19.5]));
        let found = void_of(&closed, &OPEN[..2]);
        assert!((found - 88.0).abs() < 0.5 * 2.0 * (8.0 + 11.0), "{found}");
    }

    #[test]
    fn a_void_across_the_seam_of_a_period_is_one() {
        let middle = [0.0, 10.0];
        let wrapped = |site: &[f64]| {
            let x = if site[0] > 10.0 { site[0] - 20.0 } else { site[0] };
            distance(&[x, site[1]], &middle) < 5.0
        };
        let sites = lattice(&[20, 20], wrapped);
        let across = void_of(&sites, &[20.0, f64::INFINITY]);
        let within = lattice(&[20, 20], |site| distance(site, &[10.0, 10.0]) < 5.0);
        let within = void_of(&within, &[20.0, f64::INFINITY]);
        assert!(across > 70.0, "{across}");
        // The grid meets the lattice elsewhere: a cell around the edge at most.
        assert!(
            (across - within).abs() < 2.0 * std::f64::consts::PI * 5.0 / CELLS,
            "{across} {within}"
        );
    }

    #[test]
    fn particles_that_are_too_far_apart_have_no_number() {
        assert!(void_of(&[vec![0.0, 0.0], vec![1e6, 1e6]], &OPEN[..2]).is_nan());
        assert_eq!(void_of(&[], &OPEN[..2]), 0.0);
    }
}
