//! Particles in layers around a centre or an axis, which follow a round face as no lattice does.

use std::f64::consts::PI;

use super::shape::Round;
use super::{Placement, ball_volume};
use crate::Vector;

/// The golden angle: points that follow each other on a spiral turned by it lie evenly.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// Particles in layers.
pub(super) struct Concentric<const D: usize> {
    pub position: Vec<Vector<D>>,
    /// The part of the shape that belongs to each particle, in m^D: an even share of its layer.
    pub volume: Vec<f64>,
    /// The same of the whole layer, where half of it lies beyond a face.
    pub weight: Vec<f64>,
    /// Thickness of the layers in m, along an axis of the cylinder the largest distance of two rings.
    pub spacing: f64,
}

/// Where layers of a thickness lie between two ends: their middles, and the ends of what of each is inside.
struct Layers {
    first: f64,
    count: usize,
    width: f64,
    ends: [f64; 2],
}

impl Layers {
    /// Those of the nearest thickness of which a whole number fits.
    fn between(ends: [f64; 2], wanted: f64, placement: Placement) -> Self {
        let extent = ends[1] - ends[0];
        let whole = (extent / wanted).round().max(1.0);
        let width = extent / whole;
        let (first, more) = match placement {
            Placement::Boundary => (ends[0], 1),
            Placement::Cells => (ends[0] + 0.5 * width, 0),
        };
        Self { first, count: whole as usize + more, width, ends }
    }

    /// The middle of a layer, its own ends, and the ends of what of it is inside; nothing is on the other side of a
    /// centre.
    fn layer(&self, number: usize) -> (f64, [f64; 2], [f64; 2]) {
        let middle = self.first + number as f64 * self.width;
        let [low, high] = [middle - 0.5 * self.width, middle + 0.5 * self.width];
        let inside = [low.max(self.ends[0]), high.min(self.ends[1])];
        (middle, [low, high], inside)
    }
}

/// Fills what is round: rings of a disc and around the axis of a cylinder, shells of a ball, pairs in 1D.
///
/// Layers are as thick as the spacing, or as near to that as a whole number of them allows, and particles of a layer
/// as far from each other. In 2D those of a ring are exactly even, and mirror images of each other in the x axis;
/// shells have theirs on a spiral, whose areas are equal.
pub(super) fn concentric<const D: usize>(
    round: &Round<D>,
    wanted: f64,
    placement: Placement,
) -> Concentric<D> {
    let layers = Layers::between(round.radii, wanted, placement);
    // A shell that is thinner than a spacing has no more particles for that.
    let along = layers.width.max(0.5 * wanted);
    let mut all = Concentric {
        position: Vec::new(),
        volume: Vec::new(),
        weight: Vec::new(),
        spacing: layers.width,
    };
    match &round.axis {
        None => {
            let measure = |ends: [f64; 2]| {
                let within = |radius: f64| ball_volume(D, radius.max(0.0));
                within(ends[1]) - within(ends[0])
            };
            for number in 0..layers.count {
                let (radius, whole, inside) = layers.layer(number);
                let count = room(sphere(D, radius) / along.powi(D as i32 - 1));
                for a in 0..count {
                    all.position.push(round.center + around::<D>(a, count, number) * radius);
                    all.volume.push(measure(inside) / count as f64);
                    all.weight.push(measure(whole) / count as f64);
                }
            }
        }
        Some((direction, length)) => {
            let slices = Layers::between([0.0, *length], wanted, placement);
            let across = perpendicular(direction);
            let of_disc = |ends: [f64; 2]| PI * (ends[1].powi(2) - ends[0].max(0.0).powi(2));
            all.spacing = all.spacing.max(slices.width);
            for slice in 0..slices.count {
                let (height, _, [low, high]) = slices.layer(slice);
                for number in 0..layers.count {
                    let (radius, whole, inside) = layers.layer(number);
                    let count = room(2.0 * PI * radius / along);
                    let foot = round.center + direction * height;
                    for a in 0..count {
                        let turn = angle(a, count, number + slice);
                        let way = across[0] * turn.cos() + across[1] * turn.sin();
                        all.position.push(foot + way * radius);
                        all.volume.push(of_disc(inside) * (high - low) / count as f64);
                        all.weight.push(of_disc(whole) * slices.width / count as f64);
                    }
                }
            }
        }
    }
    all
}

/// As many particles as there is room for in a layer: one in the centre.
fn room(room: f64) -> usize {
    room.round().max(1.0) as usize
}

/// The measure in m^(D-1) of a sphere.
fn sphere(dimension: usize, radius: f64) -> f64 {
    match dimension {
        1 if radius == 0.0 => 1.0,
        1 => 2.0,
        2 => 2.0 * PI * radius,
        _ => 4.0 * PI * radius * radius,
    }
}

/// The angle in rad of one of some particles of a ring; those of every other ring stand in the gaps of what they
/// would be otherwise.
fn angle(a: usize, count: usize, ring: usize) -> f64 {
    2.0 * PI * (a as f64 + 0.5 * (ring % 2) as f64) / count as f64
}

/// The direction from the centre to one of some particles of a layer.
fn around<const D: usize>(a: usize, count: usize, layer: usize) -> Vector<D> {
    let mut way = Vector::zeros();
    match D {
        1 => way[0] = if a == 0 { 1.0 } else { -1.0 },
        2 => {
            let turn = angle(a, count, layer);
            (way[0], way[1]) = (turn.cos(), turn.sin());
        }
        _ => {
            let height = 1.0 - (2 * a + 1) as f64 / count as f64;
            let (angle, radius) = (GOLDEN * a as f64, (1.0 - height * height).sqrt());
            (way[0], way[1], way[2]) = (radius * angle.cos(), radius * angle.sin(), height);
        }
    }
    way
}

/// Two unit vectors at right angles to a direction and to each other.
fn perpendicular<const D: usize>(direction: &Vector<D>) -> [Vector<D>; 2] {
    let mut axis = Vector::zeros();
    axis[direction.iamin()] = 1.0;
    let first = (axis - direction * direction[direction.iamin()]).normalize();
    // The cross product, which vectors of any dimension do not have.
    let second = Vector::from_fn(|i, _| {
        let (j, k) = ((i + 1) % D, (i + 2) % D);
        direction[j] * first[k] - direction[k] * first[j]
    });
    [first, second]
}
