//! Whether bodies have come apart in the numbers: gaps between what were first neighbours, and pieces.

use super::{Common, Hypoelastic};
use crate::neighbors::{NeighborError, search};

/// First neighbours of the start are those within this many spacings, and particles hang together
/// within that.
const FIRST: f64 = 1.2;
const LINK: f64 = 1.5;

/// Pairs of particles of solids that are first neighbours at the start.
#[derive(Default)]
pub(super) struct Bonds {
    pairs: Vec<[u32; 2]>,
}

impl Bonds {
    /// The pairs of one body that are nearest at the start.
    ///
    /// # Errors
    /// When the search refuses the positions.
    pub fn new<const D: usize>(common: &Common<D>) -> Result<Self, NeighborError> {
        let (particles, is_wall) = (&common.particles, &common.is_wall);
        let domain = common.support.list().domain();
        let reach: Vec<f64> = particles.spacing.iter().map(|spacing| FIRST * spacing).collect();
        let list = search(&particles.position, &reach, domain)?;
        let mut pairs = Vec::new();
        for a in (0..particles.len()).filter(|&a| !is_wall[a]) {
            let of_body = |b: &&u32| particles.body[**b as usize] == particles.body[a];
            let later = list.row(a).iter().filter(|&&b| b as usize > a).filter(of_body);
            pairs.extend(later.map(|&b| [a as u32, b]));
        }
        Ok(Self { pairs })
    }
}

impl<const D: usize> Hypoelastic<D> {
    /// The largest gap between particles that were first neighbours at the start, in spacings.
    ///
    /// It is the diameter of the empty ball around the middle between the two: their distance, unless another particle
    /// of their body, in the support of one of the two, is nearer to the middle. Shifting and flow move particles past each other in matter that is whole.
    pub(super) fn largest_gap(&self, common: &Common<D>, state: &[f64]) -> f64 {
        let list = common.support.list();
        let reach =
            common.support.kernel().support_radius(common.support.smoothing_length()).powi(2);
        let at = common.columns(state);
        let position = |a: u32| at.position[a as usize];
        let largest = self.bonds.pairs.iter().fold(0.0, |largest: f64, &[a, b]| {
            let across = list.domain().separation(&position(a), &position(b));
            let square = across.norm_squared();
            if square <= largest {
                return largest;
            }
            let middle = position(a) + across * 0.5;
            // The list has more than those within reach, depending on when it was made.
            let near = |end: u32| {
                let row = list.active_row(list.places()[end as usize] as usize).iter();
                let numbers = row.map(|&place| list.numbers()[place as usize]);
                let way = move |c: u32| list.domain().separation(&position(end), &position(c));
                numbers.filter(move |&c| way(c).norm_squared() < reach)
            };
            let of_body =
                |c: &u32| common.particles.body[*c as usize] == common.particles.body[a as usize];
            near(a)
                .chain(near(b))
                .filter(of_body)
                .fold(square, |least, c| {
                    let way = list.domain().separation(&middle, &position(c));
                    least.min(4.0 * way.norm_squared())
                })
                .max(largest)
        });
        largest.sqrt() / common.particles.spacing[0]
    }
}

/// The number of pieces that hang together by links of up to 1.5 spacings inside of their body.
pub(super) fn piece_count<const D: usize>(common: &Common<D>, state: &[f64]) -> f64 {
    let list = common.support.list();
    let at = common.columns(state);
    let position = |a: usize| at.position[a];
    let square = (LINK * common.particles.spacing[0]).powi(2);
    let mut root: Vec<u32> = (0..common.particles.len() as u32).collect();
    let mut pieces = common.is_wall.iter().filter(|is_wall| !**is_wall).count();
    // Candidates of the list are all that are near, at any state since it was made.
    for (place, &number) in list.numbers().iter().enumerate() {
        let a = number as usize;
        if common.is_wall[a] {
            continue;
        }
        for &other in list.active_row(place) {
            let b = list.numbers()[other as usize] as usize;
            let is_linked = b > a
                && common.particles.body[a] == common.particles.body[b]
                && list.domain().separation(&position(a), &position(b)).norm_squared() <= square;
            if is_linked {
                let (one, two) = (root_of(&mut root, a), root_of(&mut root, b));
                if one != two {
                    root[one.max(two)] = one.min(two) as u32;
                    pieces -= 1;
                }
            }
        }
    }
    pieces as f64
}

/// The particle that stands for the piece of another, with shorter ways to it from then on.
fn root_of(root: &mut [u32], mut a: usize) -> usize {
    while root[a] as usize != a {
        root[a] = root[root[a] as usize];
        a = root[a] as usize;
    }
    a
}
