//! What is wrong with the facets of a file, and what of it can be mended.

use std::collections::{HashMap, HashSet};

use super::triangle::area;
use super::{SurfaceError, Triangle};
use crate::Vector;
use crate::coordinates;

/// A place of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Number of the facet, from 1, in the order of the file.
    pub facet: usize,
    /// The place in m.
    pub place: Vector<3>,
}

/// What was found when facets were read, and where first in the order of the file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Soundness {
    /// Pieces that have no edge in common.
    pub pieces: usize,
    /// Edges that facets do not go along as often one way as the other: those of holes.
    pub open_edges: usize,
    /// The first of them.
    pub first_open: Option<Spot>,
    /// Facets that were the other way round than those beside them, or than all should be, and have been flipped.
    pub flipped: usize,
    /// The first of them.
    pub first_flipped: Option<Spot>,
    /// Facets that were there twice or without an area, and have been left out.
    pub left_out: usize,
    /// The first of them.
    pub first_left_out: Option<Spot>,
}

impl Soundness {
    /// Whether the surface has no holes.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0
    }

    /// Whether nothing is wrong.
    pub fn is_sound(&self) -> bool {
        self.is_closed() && self.flipped == 0 && self.left_out == 0
    }
}

/// An edge of a facet by the numbers of its ends, the smaller one first, and whether the facet has them in that order.
fn edges(corners: [u32; 3]) -> [((u32, u32), bool); 3] {
    [0, 1, 2].map(|k| {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        if from < to { ((from, to), true) } else { ((to, from), false) }
    })
}

/// Refuses corners that are no place.
pub(super) fn check(triangles: &[(Triangle, u32)]) -> Result<(), SurfaceError> {
    for (triangle, facet) in triangles {
        if let Some(corner) = triangle.iter().find(|x| !x.iter().all(|x| x.is_finite())) {
            let facet = *facet as usize;
            return Err(SurfaceError::NotFinite { facet, corner: (*corner).into() });
        }
    }
    Ok(())
}

/// Triangles with the numbers of their facets, what was found, and the volume that they enclose in m^3.
type Mended = (Vec<(Triangle, u32)>, Soundness, f64);

/// A triangle of a file.
struct Kept {
    triangle: Triangle,
    /// The number of its facet.
    facet: u32,
    /// Whether it is the other way round than in the file.
    is_flipped: bool,
}

impl Kept {
    fn flip(&mut self) {
        self.triangle.swap(1, 2);
        self.is_flipped = !self.is_flipped;
    }

    fn spot(&self) -> Spot {
        spot(&self.triangle, self.facet)
    }
}

/// The middle of a triangle.
fn spot([a, b, c]: &Triangle, facet: u32) -> Spot {
    Spot { facet: facet as usize, place: (a + b + c) / 3.0 }
}

/// How many facets triangles are of, and the first of them.
fn counted(mut spots: Vec<Spot>) -> (usize, Option<Spot>) {
    spots.sort_by_key(|spot| spot.facet);
    (spots.chunk_by(|one, other| one.facet == other.facet).count(), spots.first().copied())
}

/// Whichever comes first in the file.
fn first(known: Option<Spot>, other: Spot) -> Option<Spot> {
    known.filter(|known| known.facet <= other.facet).or(Some(other))
}

/// The facets without those that are there twice or have no area, all of each piece the same way round, as most of its area
/// was, and such that they enclose a volume, which is returned in m^3.
pub(super) fn mended(triangles: Vec<(Triangle, u32)>) -> Result<Mended, SurfaceError> {
    let mut soundness = Soundness::default();
    let mut numbers = HashMap::<[u64; 3], u32>::new();
    let (mut known, mut left_out) = (HashSet::new(), Vec::new());
    let (mut kept, mut corners) = (Vec::new(), Vec::new());
    for (triangle, facet) in triangles {
        let own = triangle.map(|corner| {
            // Both zeros are one.
            let bits = corner.map(|x| (x + 0.0).to_bits()).into();
            let next = numbers.len() as u32;
            *numbers.entry(bits).or_insert(next)
        });
        // Facets on each other that face each other are where two pieces touch.
        let least = (0..3).min_by_key(|&k| own[k]).unwrap_or_default();
        let ordered = [0, 1, 2].map(|k| own[(least + k) % 3]);
        let is_point = own[0] == own[1] || own[1] == own[2] || own[2] == own[0];
        if is_point || !known.insert(ordered) {
            left_out.push(spot(&triangle, facet));
            continue;
        }
        kept.push(Kept { triangle, facet, is_flipped: false });
        corners.push(own);
    }
    orient(&mut kept, &corners, &mut soundness);
    // Facets whose corners are in line have edges that others need.
    kept.retain(|it| {
        let has_area = area(&it.triangle).norm() > 0.0;
        if !has_area {
            left_out.push(it.spot());
        }
        has_area
    });
    let Some(origin) = kept.first().map(|it| it.triangle[0]) else {
        return Err(SurfaceError::NoFacets);
    };
    let six = |it: &Kept| {
        let [a, b, c] = it.triangle.map(|corner| corner - origin);
        a.dot(&b.cross(&c))
    };
    let volume = kept.iter().map(six).sum::<f64>() / 6.0;
    if volume < 0.0 {
        kept.iter_mut().for_each(Kept::flip);
    }
    let flipped = kept.iter().filter(|it| it.is_flipped).map(Kept::spot);
    (soundness.flipped, soundness.first_flipped) = counted(flipped.collect());
    (soundness.left_out, soundness.first_left_out) = counted(left_out);
    let facets = kept.into_iter().map(|it| (it.triangle, it.facet)).collect();
    Ok((facets, soundness, volume.abs()))
}

/// Flips the facets that are the other way round than those beside them, and counts pieces and open edges.
fn orient(kept: &mut [Kept], corners: &[[u32; 3]], soundness: &mut Soundness) {
    // What goes along each edge: the numbers of a facet and of the edge in it, together for each edge.
    let mut along: Vec<((u32, u32), u32, usize, bool)> = (0u32..)
        .zip(corners)
        .flat_map(|(facet, own)| {
            let edges = edges(*own).into_iter().enumerate();
            edges.map(move |(k, (edge, way))| (edge, facet, k, way))
        })
        .collect();
    along.sort_unstable();
    // Of each edge of a facet the facet on its other side, if there is one, and whether both go along it the same way.
    let mut beside = vec![[None; 3]; corners.len()];
    for group in along.chunk_by(|one, other| one.0 == other.0) {
        if let [(_, one, i, its_way), (_, two, j, way)] = *group {
            beside[one as usize][i] = Some((two as usize, its_way == way));
            beside[two as usize][j] = Some((one as usize, its_way == way));
        }
    }
    // Of each facet, whether it goes the other way round than the first one of its piece.
    let mut is_other = vec![None; corners.len()];
    for first in 0..corners.len() {
        if is_other[first].is_some() {
            continue;
        }
        is_other[first] = Some(false);
        soundness.pieces += 1;
        let (mut piece, mut next) = (vec![first], 0);
        while let Some(&facet) = piece.get(next) {
            next += 1;
            let own = is_other[facet] == Some(true);
            for (other, is_same) in beside[facet].into_iter().flatten() {
                if is_other[other].is_none() {
                    // Neighbours go along their common edge in opposite ways.
                    is_other[other] = Some(own != is_same);
                    piece.push(other);
                }
            }
        }
        let area_of = |wanted: bool| -> f64 {
            let all = piece.iter().filter(|&&facet| is_other[facet] == Some(wanted));
            all.map(|&facet| area(&kept[facet].triangle).norm()).sum()
        };
        let wrong = area_of(true) <= area_of(false);
        for &facet in piece.iter().filter(|&&facet| is_other[facet] == Some(wrong)) {
            kept[facet].flip();
        }
    }
    let is_open = |group: &&[((u32, u32), u32, usize, bool)]| {
        let ways = group.iter().map(|(_, facet, _, way)| *way != kept[*facet as usize].is_flipped);
        2 * ways.filter(|way| *way).count() != group.len()
    };
    let middle = |&(_, facet, k, _): &((u32, u32), u32, usize, bool)| {
        let Kept { mut triangle, facet, is_flipped } = kept[facet as usize];
        if is_flipped {
            triangle.swap(1, 2);
        }
        Spot { facet: facet as usize, place: (triangle[k] + triangle[(k + 1) % 3]) * 0.5 }
    };
    for group in along.chunk_by(|one, other| one.0 == other.0).filter(is_open) {
        soundness.open_edges += 1;
        soundness.first_open = group.iter().map(middle).fold(soundness.first_open, first);
    }
}

impl std::fmt::Display for Spot {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "facet {} at {} m", self.facet, coordinates(self.place.as_slice()))
    }
}

impl std::fmt::Display for Soundness {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut all = Vec::new();
        if self.open_edges > 0 {
            let edges = match self.open_edges {
                1 => "1 edge has no facet on its other side".to_owned(),
                count => format!("{count} edges have no facet on their other side"),
            };
            let first = self.first_open.map(|spot| format!(", first an edge of {spot}"));
            all.push(format!("it has holes: {edges}{}", first.unwrap_or_default()));
        }
        let first = |spot: Option<Spot>| spot.map(|it| format!(", first {it}")).unwrap_or_default();
        let only = |spot: Option<Spot>| spot.map(|it| format!(", {it}")).unwrap_or_default();
        match self.flipped {
            0 => (),
            1 => all.push(format!(
                "1 facet with reversed orientation was flipped{}",
                only(self.first_flipped)
            )),
            count => all.push(format!(
                "{count} facets with reversed orientation were flipped{}",
                first(self.first_flipped)
            )),
        }
        match self.left_out {
            0 => (),
            1 => all.push(format!(
                "1 facet that is a duplicate or has no area was left out{}",
                only(self.first_left_out)
            )),
            count => all.push(format!(
                "{count} facets that are duplicates or have no area were left out{}",
                first(self.first_left_out)
            )),
        }
        out.write_str(&all.join("; "))
    }
}
