//! What is wrong with the facets of a file, and what of it can be mended.

use std::collections::HashMap;

use super::tree::area;
use super::{SurfaceError, Triangle};

/// What was found when facets were read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Soundness {
    /// Sides that belong to one facet only: those of holes.
    pub open_sides: usize,
    /// Sides that belong to more than two facets.
    pub shared_sides: usize,
    /// Facets that were the other way round than those beside them, and have been turned.
    pub turned: usize,
    /// Facets that were there twice or without an area, and have been left out.
    pub left_out: usize,
}

impl Soundness {
    /// Whether the surface has no holes.
    pub fn is_closed(&self) -> bool {
        self.open_sides == 0
    }
}

/// A side of a facet by the numbers of its ends, the smaller one first, and whether the facet has them in that order.
fn sides(corners: [u32; 3]) -> [((u32, u32), bool); 3] {
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

/// The facets without those that are there twice or have no area, all of each piece the same way round: as most of its area
/// was.
pub(super) fn mended(triangles: Vec<Triangle>) -> Result<(Vec<Triangle>, Soundness), SurfaceError> {
    let mut soundness = Soundness::default();
    let mut numbers = HashMap::<[u64; 3], u32>::new();
    let mut known = HashMap::<[u32; 3], ()>::new();
    let (mut kept, mut corners) = (Vec::new(), Vec::new());
    for triangle in triangles {
        let own = triangle.map(|corner| {
            // Both zeros are one.
            let bits = corner.map(|x| (x + 0.0).to_bits()).into();
            let next = numbers.len() as u32;
            *numbers.entry(bits).or_insert(next)
        });
        let mut sorted = own;
        sorted.sort_unstable();
        if !(area(&triangle).norm() > 0.0) || known.insert(sorted, ()).is_some() {
            soundness.left_out += 1;
            continue;
        }
        kept.push(triangle);
        corners.push(own);
    }
    if kept.is_empty() {
        return Err(SurfaceError::NoFacets);
    }
    turn(&mut kept, &corners, &mut soundness);
    Ok((kept, soundness))
}

/// Turns the facets that are the other way round than those beside them.
fn turn(kept: &mut [Triangle], corners: &[[u32; 3]], soundness: &mut Soundness) {
    let mut beside = HashMap::<(u32, u32), Vec<(u32, bool)>>::new();
    for (facet, own) in (0u32..).zip(corners) {
        for (side, way) in sides(*own) {
            beside.entry(side).or_default().push((facet, way));
        }
    }
    soundness.open_sides = beside.values().filter(|facets| facets.len() == 1).count();
    soundness.shared_sides = beside.values().filter(|facets| facets.len() > 2).count();
    // Of each facet, whether it goes the other way round than the first one of its piece.
    let mut is_other = vec![None; corners.len()];
    for first in 0..corners.len() {
        if is_other[first].is_some() {
            continue;
        }
        is_other[first] = Some(false);
        let (mut piece, mut next) = (vec![first], 0);
        while let Some(&facet) = piece.get(next) {
            next += 1;
            let own = is_other[facet] == Some(true);
            for (side, way) in sides(corners[facet]) {
                let [one, two] = beside[&side][..] else { continue };
                let (other, its_way) = if one.0 as usize == facet { two } else { one };
                let other = other as usize;
                if is_other[other].is_none() {
                    // Neighbours go along their common side in turns.
                    is_other[other] = Some(own != (its_way == way));
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
            soundness.turned += 1;
        }
    }
}

/// A number of facets in words.
pub(super) fn facets(count: usize) -> String {
    if count == 1 { "1 facet".to_owned() } else { format!("{count} facets") }
}

impl std::fmt::Display for Soundness {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut all = Vec::new();
        if self.open_sides > 0 {
            all.push(format!("it has holes: {} sides belong to one facet only", self.open_sides));
        }
        if self.shared_sides > 0 {
            all.push(format!("{} sides belong to more than two facets", self.shared_sides));
        }
        if self.turned > 0 {
            all.push(format!(
                "{} the other way round than those beside were turned",
                facets(self.turned)
            ));
        }
        if self.left_out > 0 {
            all.push(format!(
                "{} that are there twice or have no area were left out",
                facets(self.left_out)
            ));
        }
        out.write_str(&all.join("; "))
    }
}
