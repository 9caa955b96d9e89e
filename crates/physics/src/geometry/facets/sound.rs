//! What is wrong with the facets of a file, and what of it can be mended.

use std::collections::{HashMap, HashSet};

use super::triangle::area;
use super::{SurfaceError, Triangle};

/// What was found when facets were read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Soundness {
    /// Pieces that have no edge in common.
    pub pieces: usize,
    /// Edges that facets do not go along as often one way as the other: those of holes.
    pub open_edges: usize,
    /// Facets that were the other way round than those beside them, or than all should be, and have been flipped.
    pub flipped: usize,
    /// Facets that were there twice or without an area, and have been left out.
    pub left_out: usize,
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
pub(super) fn check(triangles: &[Triangle]) -> Result<(), SurfaceError> {
    for (number, triangle) in (1..).zip(triangles) {
        if let Some(corner) = triangle.iter().find(|x| !x.iter().all(|x| x.is_finite())) {
            return Err(SurfaceError::NotFinite { facet: number, corner: (*corner).into() });
        }
    }
    Ok(())
}

/// The facets without those that are there twice or have no area, all of each piece the same way round, as most of its area
/// was, and such that they enclose a volume, which is returned in m^3.
pub(super) fn mended(
    triangles: Vec<Triangle>,
) -> Result<(Vec<Triangle>, Soundness, f64), SurfaceError> {
    let mut soundness = Soundness::default();
    let mut numbers = HashMap::<[u64; 3], u32>::new();
    let mut known = HashSet::new();
    let (mut kept, mut corners) = (Vec::new(), Vec::new());
    for triangle in triangles {
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
            soundness.left_out += 1;
            continue;
        }
        kept.push(triangle);
        corners.push(own);
    }
    orient(&mut kept, &corners, &mut soundness);
    // Facets whose corners are in line have edges that others need.
    let count = kept.len();
    kept.retain(|triangle| area(triangle).norm() > 0.0);
    soundness.left_out += count - kept.len();
    let Some(origin) = kept.first().map(|triangle| triangle[0]) else {
        return Err(SurfaceError::NoFacets);
    };
    let six = |triangle: &Triangle| {
        let [a, b, c] = triangle.map(|corner| corner - origin);
        a.dot(&b.cross(&c))
    };
    let volume = kept.iter().map(six).sum::<f64>() / 6.0;
    if volume < 0.0 {
        kept.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        soundness.flipped = kept.len() - soundness.flipped.min(kept.len());
    }
    Ok((kept, soundness, volume.abs()))
}

/// Flips the facets that are the other way round than those beside them, and counts pieces and open edges.
fn orient(kept: &mut [Triangle], corners: &[[u32; 3]], soundness: &mut Soundness) {
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
    let mut is_flipped = vec![false; corners.len()];
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
            all.map(|&facet| area(&kept[facet]).norm()).sum()
        };
        let wrong = area_of(true) <= area_of(false);
        for &facet in piece.iter().filter(|&&facet| is_other[facet] == Some(wrong)) {
            kept[facet].swap(1, 2);
            is_flipped[facet] = true;
            soundness.flipped += 1;
        }
    }
    let is_open = |group: &&[((u32, u32), u32, usize, bool)]| {
        let ways = group.iter().map(|(_, facet, _, way)| *way != is_flipped[*facet as usize]);
        2 * ways.filter(|way| *way).count() != group.len()
    };
    let all = along.chunk_by(|one, other| one.0 == other.0);
    soundness.open_edges = all.filter(is_open).count();
}

/// A number of facets in words.
fn facets(count: usize) -> String {
    if count == 1 { "1 facet".to_owned() } else { format!("{count} facets") }
}

impl std::fmt::Display for Soundness {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut all = Vec::new();
        if self.open_edges > 0 {
            all.push(format!(
                "it has holes: {} edges have no facet on their other side",
                self.open_edges
            ));
        }
        if self.flipped > 0 {
            all.push(format!("{} with reversed orientation were flipped", facets(self.flipped)));
        }
        if self.left_out > 0 {
            all.push(format!(
                "{} that are duplicates or have no area were left out",
                facets(self.left_out)
            ));
        }
        out.write_str(&all.join("; "))
    }
}
