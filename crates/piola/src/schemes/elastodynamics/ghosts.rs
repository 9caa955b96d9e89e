//! Ghosts beyond the edges of the strong form, as particles and data of the edges.

use super::edges::{Edge, ON_EDGE};
use crate::geometry::Particles;
use crate::operators::Ghost;
use crate::{Tensor, Vector};

/// A particle reflected across some edges.
struct Reflected<const D: usize> {
    position: Vector<D>,
    /// Of displacements, by component.
    sign: [f64; D],
    data: Vec<(u32, Tensor<D>)>,
    /// Of stresses.
    stress_sign: Tensor<D>,
    stress_data: Vec<(u32, Tensor<D>)>,
}

/// The ghosts of displacements and those of stresses within `reach` m of the edges, theory (64), at
/// the places that particles have.
///
/// An image across an edge is an image again across the edges of other axes, and across the opposite
/// one where covers reach that far.
pub(super) fn ghosts<const D: usize>(
    particles: &Particles<D>,
    edges: &[Edge<D>],
    reach: f64,
) -> [Vec<Ghost<D>>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    for a in 0..particles.len() {
        let mut words: Vec<Vec<usize>> = vec![Vec::new()];
        for axis in 0..D {
            let of_axis = words_of_axis(particles, edges, axis, a, reach);
            let before = words.len();
            for word in of_axis {
                for index in 0..before {
                    words.push([words[index].as_slice(), &word].concat());
                }
            }
        }
        for word in &words[1..] {
            let made = reflected(particles, edges, a, word);
            let (source, position) = (a as u32, made.position);
            let sign = Tensor::from_fn(|i, _| made.sign[i]);
            all[0].push(Ghost { source, position, sign, data: made.data });
            let (sign, data) = (made.stress_sign, made.stress_data);
            all[1].push(Ghost { source, position, sign, data });
        }
    }
    all
}

/// The reflections of a particle across the two edges of one axis, one after the other, that lie within
/// reach.
fn words_of_axis<const D: usize>(
    particles: &Particles<D>,
    edges: &[Edge<D>],
    axis: usize,
    a: usize,
    reach: f64,
) -> Vec<Vec<usize>> {
    let own: Vec<usize> = (0..edges.len()).filter(|&edge| edges[edge].axis == axis).collect();
    let place_of = |edge: usize| particles.position[edges[edge].feet[a] as usize][axis];
    let beyond = |edge: usize, place: f64| match edges[edge].is_upper {
        true => place - place_of(edge),
        false => place_of(edge) - place,
    };
    let mut words = Vec::new();
    for first in 0..own.len() {
        let (mut word, mut turn) = (Vec::new(), first);
        let mut place = particles.position[a][axis];
        loop {
            let next = 2.0 * place_of(own[turn]) - place;
            let stays = (next - place).abs() <= 2.0 * ON_EDGE * particles.spacing[a];
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

/// A particle reflected across edges in turn, those of lower axes first.
fn reflected<const D: usize>(
    particles: &Particles<D>,
    edges: &[Edge<D>],
    a: usize,
    word: &[usize],
) -> Reflected<D> {
    let Some((&last, before)) = word.split_last() else {
        return Reflected {
            position: particles.position[a],
            sign: [1.0; D],
            data: Vec::new(),
            stress_sign: Tensor::from_element(1.0),
            stress_data: Vec::new(),
        };
    };
    let edge = &edges[last];
    let (axis, is_held) = (edge.axis, edge.is_held);
    let mut made = reflected(particles, edges, a, before);
    let foot = edge.feet[a];
    let across: Vec<usize> = before.iter().copied().filter(|&it| edges[it].axis < axis).collect();
    // What the edge says where the image of the foot is.
    let at = reflected(particles, edges, foot as usize, &across);
    let slot = edge.slots.get(&foot).copied().unwrap_or_default();
    let place = made.position[axis];
    made.position[axis] = 2.0 * particles.position[foot as usize][axis] - place;
    let way = made.position[axis] - place;

    let turn = Tensor::<D>::from_fn(|i, _| if is_held[i] { -1.0 } else { 1.0 });
    made.data.iter_mut().for_each(|(_, share)| share.component_mul_assign(&turn));
    let twice = Tensor::<D>::from_fn(|i, _| if is_held[i] { 2.0 } else { 0.0 });
    made.data.extend(at.data.iter().map(|(slot, share)| (*slot, share.component_mul(&twice))));
    // The slope is seen by the derivative across the edge alone.
    let own = Tensor::from_fn(|i, j| match (is_held[i], j == axis) {
        (true, _) => 2.0 * at.sign[i],
        (false, true) => way * at.sign[i],
        (false, false) => 0.0,
    });
    made.data.push((slot, own));
    (0..D).for_each(|i| made.sign[i] *= turn[(i, 0)]);

    // Across the edge stresses are even where it is held and odd about the load elsewhere; along it the
    // other way round.
    let parity = Tensor::<D>::from_fn(|i, j| if is_held[i] == (j == axis) { 1.0 } else { -1.0 });
    made.stress_data.iter_mut().for_each(|(_, share)| share.component_mul_assign(&parity));
    let load =
        Tensor::from_fn(|i, j| if !is_held[i] && j == axis { 2.0 * at.sign[i] } else { 0.0 });
    made.stress_data.push((slot, load));
    made.stress_sign.component_mul_assign(&parity);
    made
}
