//! Ghosts beyond the edges of the strong form, as particles and data of the edges.

use super::edges::{Edge, ON_EDGE};
use super::holes::Inside;
use crate::geometry::Particles;
use crate::operators::{Ghost, Share};
use crate::{Tensor, Vector};

/// A particle or a ghost in a hole, reflected across some edges.
struct Reflected<const D: usize> {
    /// Of displacements, by component.
    sign: [f64; D],
    /// As a ghost of displacements, and as one of stresses.
    ghosts: [Ghost<D>; 2],
}

/// All places that edges reflect: particles, and behind them ghosts in holes.
pub(in super::super) struct Places<'a, const D: usize> {
    pub particles: &'a Particles<D>,
    pub inside: &'a [Inside<D>],
    /// Data of edges, behind which those of holes stand.
    pub slots: usize,
}

impl<const D: usize> Places<'_, D> {
    /// Number of places.
    pub fn len(&self) -> usize {
        self.particles.len() + self.inside.len()
    }

    /// Where place `a` is, in m.
    pub fn position(&self, a: usize) -> Vector<D> {
        match a.checked_sub(self.particles.len()) {
            None => self.particles.position[a],
            Some(number) => self.inside[number].position,
        }
    }

    /// What place `a` is made of.
    fn itself(&self, a: usize) -> Reflected<D> {
        let ghosts = match a.checked_sub(self.particles.len()) {
            None => {
                let (like, position) = (a as u32, self.particles.position[a]);
                let sources = vec![(like, [Tensor::identity(); D])];
                let ghost = Ghost { like, position, sources, data: Vec::new() };
                [ghost.clone(), ghost]
            }
            Some(number) => {
                let own = &self.inside[number];
                [own.of_displacement((self.slots + number) as u32), own.of_stress()]
            }
        };
        Reflected { sign: [1.0; D], ghosts }
    }
}

/// Multiplies derivatives along j of components i with entries (i, j) of `factors`.
fn multiplied<const D: usize>(share: &Share<D>, factors: &Tensor<D>) -> Share<D> {
    std::array::from_fn(|i| share[i] * Tensor::from_diagonal(&factors.row(i).transpose()))
}

fn multiply<const D: usize>(all: &mut [(u32, Share<D>)], factors: &Tensor<D>) {
    all.iter_mut().for_each(|(_, share)| *share = multiplied(share, factors));
}

/// The share whose coefficients are those of the gradient times entries of `factors`.
fn of_factors<const D: usize>(factors: &Tensor<D>) -> Share<D> {
    multiplied(&[Tensor::identity(); D], factors)
}

/// The ghosts of displacements and those of stresses in holes and within `reach` m of the edges, theory
/// (64), at the places that particles have.
///
/// An image across an edge is an image again across the edges of other axes, and across the opposite
/// one where covers reach that far.
pub(super) fn ghosts<const D: usize>(
    places: &Places<'_, D>,
    edges: &[Edge<D>],
    reach: f64,
) -> [Vec<Ghost<D>>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    for a in 0..places.len() {
        let mut words: Vec<Vec<usize>> = vec![Vec::new()];
        for axis in 0..D {
            let of_axis = words_of_axis(places, edges, axis, a, reach);
            let before = words.len();
            for word in of_axis {
                for index in 0..before {
                    words.push([words[index].as_slice(), &word].concat());
                }
            }
        }
        // Particles themselves are no ghosts.
        let first = usize::from(a < places.particles.len());
        for word in &words[first..] {
            let [of_displacement, of_stress] = reflected(places, edges, a, word).ghosts;
            all[0].push(of_displacement);
            all[1].push(of_stress);
        }
    }
    all
}

/// The reflections of a particle across the two edges of one axis, one after the other, that lie within
/// reach.
fn words_of_axis<const D: usize>(
    places: &Places<'_, D>,
    edges: &[Edge<D>],
    axis: usize,
    a: usize,
    reach: f64,
) -> Vec<Vec<usize>> {
    let own: Vec<usize> = (0..edges.len()).filter(|&edge| edges[edge].axis == axis).collect();
    let particles = places.particles;
    let spacing = particles.spacing
        [places.inside.get(a.wrapping_sub(particles.len())).map_or(a, |it| it.like)];
    let place_of = |edge: usize| particles.position[edges[edge].feet[a] as usize][axis];
    let beyond = |edge: usize, place: f64| match edges[edge].is_upper {
        true => place - place_of(edge),
        false => place_of(edge) - place,
    };
    let mut words = Vec::new();
    for first in 0..own.len() {
        let (mut word, mut turn) = (Vec::new(), first);
        let mut place = places.position(a)[axis];
        loop {
            let next = 2.0 * place_of(own[turn]) - place;
            let stays = (next - place).abs() <= 2.0 * ON_EDGE * spacing;
            if stays || !own.iter().all(|&edge| beyond(edge, next) < reach) {
                break;
            }
            word.push(own[turn]);
            words.push(word.clone());
            place = next;
            turn = (turn + 1) % own.len();
        }
    }
    words
}

/// A place reflected across edges in turn, those of lower axes first.
fn reflected<const D: usize>(
    places: &Places<'_, D>,
    edges: &[Edge<D>],
    a: usize,
    word: &[usize],
) -> Reflected<D> {
    let Some((&last, before)) = word.split_last() else { return places.itself(a) };
    let edge = &edges[last];
    let (axis, is_held) = (edge.axis, edge.is_held);
    let mut made = reflected(places, edges, a, before);
    let foot = edge.feet[a];
    let across: Vec<usize> = before.iter().copied().filter(|&it| edges[it].axis < axis).collect();
    // What the edge says where the image of the foot is.
    let at = reflected(places, edges, foot as usize, &across);
    let slot = edge.slots.get(&foot).copied().unwrap_or_default();
    let [of_displacement, of_stress] = &mut made.ghosts;
    let place = of_displacement.position[axis];
    let image = 2.0 * places.particles.position[foot as usize][axis] - place;
    let way = image - place;
    of_displacement.position[axis] = image;
    of_stress.position[axis] = image;

    let turn = Tensor::<D>::from_fn(|i, _| if is_held[i] { -1.0 } else { 1.0 });
    multiply(&mut of_displacement.sources, &turn);
    multiply(&mut of_displacement.data, &turn);
    let twice = Tensor::<D>::from_fn(|i, _| if is_held[i] { 2.0 } else { 0.0 });
    let known = at.ghosts[0].data.iter();
    of_displacement.data.extend(known.map(|(slot, share)| (*slot, multiplied(share, &twice))));
    // The slope is seen by the derivative across the edge alone.
    let own = Tensor::from_fn(|i, j| match (is_held[i], j == axis) {
        (true, _) => 2.0 * at.sign[i],
        (false, true) => way * at.sign[i],
        (false, false) => 0.0,
    });
    of_displacement.data.push((slot, of_factors(&own)));
    (0..D).for_each(|i| made.sign[i] *= turn[(i, 0)]);

    // Across the edge stresses are even where it is held and odd about the load elsewhere; along it the
    // other way round.
    let parity = Tensor::<D>::from_fn(|i, j| if is_held[i] == (j == axis) { 1.0 } else { -1.0 });
    multiply(&mut of_stress.sources, &parity);
    multiply(&mut of_stress.data, &parity);
    let load =
        Tensor::from_fn(|i, j| if !is_held[i] && j == axis { 2.0 * at.sign[i] } else { 0.0 });
    of_stress.data.push((slot, of_factors(&load)));
    made
}
