//! Round holes in the box of the strong form, whose edge is free of stress: theory (64).
//!
//! Ghosts lie at the sites of the lattice inside. With the foot of one on the edge, r the way from the
//! centre to the foot of length one, and the image of the ghost as far behind the foot as it lies before,
//! displacements and stresses of the image are fitted to the particles around it, and
//!
//! ```text
//! u_g = u(image) - 2 s a(foot),   P_g = P(image) (I - 2 r (x) r),   P(foot) r = 0
//! ```

use nalgebra::DMatrix;

use super::super::Mixture;
use super::super::TotalLagrangianError;
use super::edges::ON_EDGE;
use super::slopes::{Tangents, solve, step};
use crate::geometry::Particles;
use crate::operators::{Ghost, Share};
use crate::{Tensor, Vector};

/// How far values at images are fitted, in spacings.
const VALUE_REACH: f64 = 3.0;

/// How far derivatives along the edge are fitted, in spacings.
const SLOPE_REACH: f64 = 4.2;

/// Fits whose moments are worse conditioned have no sense.
const MOST_CONDITION: f64 = 1e6;

/// A round hole with an edge that is free of stress, in a body of the strong form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole<const D: usize> {
    /// Its centre in m.
    pub center: Vector<D>,
    /// Its radius in m.
    pub radius: f64,
}

/// A ghost in a hole.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Inside<const D: usize> {
    pub position: Vector<D>,
    /// The nearest particle, whose weight, support and material it has.
    pub like: usize,
    /// Twice the way to the edge, in m.
    twice: f64,
    /// From the centre to the foot, of length one.
    normal: Vector<D>,
    /// Its own axes, the first of them the normal, in columns.
    frame: Tensor<D>,
    /// What values at the image are made of.
    image: Vec<(u32, f64)>,
    /// What derivatives at the foot are made of, 1/m.
    slope: Vec<(u32, Vector<D>)>,
}

/// The foot of a ghost on the edge of a hole at the last evaluation.
#[derive(Clone, Debug)]
pub(in super::super) struct Foot<const D: usize> {
    pub inside: Inside<D>,
    /// Derivatives of the stress by the gradient, in the axes of the foot.
    pub tangent: Tangents<D>,
}

impl<const D: usize> Inside<D> {
    /// The ghost of displacements, with the number of the datum that is the slope at the foot.
    pub fn of_displacement(&self, datum: u32) -> Ghost<D> {
        let even = |weight: f64| [Tensor::identity() * weight; D];
        Ghost {
            like: self.like as u32,
            position: self.position,
            sources: self.image.iter().map(|&(b, weight)| (b, even(weight))).collect(),
            data: vec![(datum, even(-self.twice))],
        }
    }

    /// The ghost of stresses.
    pub fn of_stress(&self) -> Ghost<D> {
        let turn = Tensor::identity() - self.normal * self.normal.transpose() * 2.0;
        let share = |weight: f64| -> Share<D> { [turn * weight; D] };
        Ghost {
            like: self.like as u32,
            position: self.position,
            sources: self.image.iter().map(|&(b, weight)| (b, share(weight))).collect(),
            data: Vec::new(),
        }
    }

    /// The gradient of a field at the foot, in its own axes.
    fn gradient(&self, field: &[Vector<D>]) -> Tensor<D> {
        let sum: Tensor<D> =
            self.slope.iter().map(|(b, slope)| field[*b as usize] * slope.transpose()).sum();
        self.frame.transpose() * sum * self.frame
    }
}

impl<const D: usize> Foot<D> {
    pub fn new(inside: Inside<D>, mixture: &Mixture<D>) -> Self {
        Self { inside, tangent: mixture.tangent(&Tensor::zeros()) }
    }

    /// The slope at which the edge is free of stress, from one that is near.
    pub fn slope(&mut self, mixture: &Mixture<D>, u: &[Vector<D>], near: Vector<D>) -> Vector<D> {
        let frame = self.inside.frame;
        let mut gradient = self.inside.gradient(u);
        gradient.set_column(0, &(frame.transpose() * near));
        let found = solve(mixture, gradient, &[Some((0, 0)); D], |_, _| 0.0);
        self.tangent = mixture.tangent(&found);
        frame * found.column(0)
    }

    /// Its rate at the last slope.
    pub fn slope_rate(&self, v: &[Vector<D>]) -> Vector<D> {
        let mut rate = self.inside.gradient(v);
        rate.set_column(0, &Vector::zeros());
        let own = |i: usize, j: usize| -> f64 {
            let entries = (0..D * D).map(|entry| (entry / D, entry % D));
            entries.map(|(k, l)| self.tangent[k][l][(i, j)] * rate[(k, l)]).sum()
        };
        let change = step(&self.tangent, &[Some((0, 0)); D], |i, j, _| -own(i, j));
        let change = change.unwrap_or_else(|| Tensor::from_element(f64::NAN));
        self.inside.frame * change.column(0)
    }
}

/// Particles that lie on the edges of holes, with the normals there.
pub(super) fn rims<const D: usize>(
    particles: &Particles<D>,
    holes: &[Hole<D>],
) -> Vec<(usize, Vector<D>)> {
    let mut rims = Vec::new();
    for (a, x) in particles.position.iter().enumerate() {
        for hole in holes {
            let way = x - hole.center;
            if (way.norm() - hole.radius).abs() < ON_EDGE * particles.spacing[a] {
                rims.push((a, way.normalize()));
            }
        }
    }
    rims
}

/// The sites of the lattice of particles that lie in holes, within `reach` m of a particle.
///
/// # Errors
/// Particles that do not lie on a lattice, and holes too small for it.
pub(super) fn sites<const D: usize>(
    particles: &Particles<D>,
    holes: &[Hole<D>],
    reach: f64,
) -> Result<Vec<Inside<D>>, TotalLagrangianError> {
    let mut found: Vec<Inside<D>> = Vec::new();
    if holes.is_empty() {
        return Ok(found);
    }
    let edges = cell(particles);
    let [low, high] = bounds(particles);
    let (least, most) =
        (low.add_scalar(-ON_EDGE * edges.max()), high.add_scalar(ON_EDGE * edges.max()));
    let layers = edges.map(|edge| (reach / edge).floor() as i64);
    for (like, x) in particles.position.iter().enumerate() {
        for offset in offsets::<D>(&layers) {
            let way = edges.component_mul(&offset);
            let place = x + way;
            let is_outside =
                (0..D).any(|axis| place[axis] < least[axis] || place[axis] > most[axis]);
            if is_outside || way.norm() >= reach {
                continue;
            }
            let hole = holes.iter().find(|hole| {
                (place - hole.center).norm() < hole.radius - ON_EDGE * particles.spacing[like]
            });
            let Some(hole) = hole else { continue };
            let slack = ON_EDGE * edges.max();
            match found.iter_mut().find(|it| (it.position - place).norm() < slack) {
                Some(known) => {
                    let before = (particles.position[known.like] - place).norm();
                    if way.norm() < before - slack {
                        known.like = like;
                    }
                }
                None => found.push(inside(particles, hole, place, like)?),
            }
        }
    }
    Ok(found)
}

/// Edges of the cells of the lattice that particles lie on.
fn cell<const D: usize>(particles: &Particles<D>) -> Vector<D> {
    Vector::from_fn(|axis, _| {
        let mut places: Vec<f64> = particles.position.iter().map(|x| x[axis]).collect();
        places.sort_by(f64::total_cmp);
        let slack = 1e3 * ON_EDGE * particles.spacing[0];
        let gaps = places.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > slack);
        let least = gaps.fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { particles.spacing[0] }
    })
}

fn bounds<const D: usize>(particles: &Particles<D>) -> [Vector<D>; 2] {
    let all = || particles.position.iter();
    let none = Vector::from_element(f64::INFINITY);
    [all().fold(none, |low, x| low.inf(x)), all().fold(-none, |high, x| high.sup(x))]
}

/// All ways of at most this many layers along each axis.
fn offsets<const D: usize>(layers: &nalgebra::SVector<i64, D>) -> Vec<Vector<D>> {
    let mut all = vec![Vector::<D>::zeros()];
    for axis in 0..D {
        let along = -layers[axis]..=layers[axis];
        all = along
            .flat_map(|step| {
                let moved = all.iter().map(move |way| {
                    let mut way = *way;
                    way[axis] = step as f64;
                    way
                });
                moved.collect::<Vec<_>>()
            })
            .collect();
    }
    all
}

fn inside<const D: usize>(
    particles: &Particles<D>,
    hole: &Hole<D>,
    position: Vector<D>,
    like: usize,
) -> Result<Inside<D>, TotalLagrangianError> {
    let too_small = || TotalLagrangianError::Hole {
        center: hole.center.iter().copied().collect(),
        radius: hole.radius,
    };
    let way = position - hole.center;
    let distance = way.norm();
    if !(distance > ON_EDGE * particles.spacing[like]) {
        return Err(too_small());
    }
    let (normal, spacing) = (way / distance, particles.spacing[like]);
    let foot = hole.center + normal * hole.radius;
    let image = hole.center + normal * (2.0 * hole.radius - distance);
    let values = fit(particles, &image, VALUE_REACH * spacing).ok_or_else(too_small)?;
    let slopes = fit(particles, &foot, SLOPE_REACH * spacing).ok_or_else(too_small)?;
    let first = Vector::from_fn(|i, _| f64::from(u8::from(i == 0)));
    let across = first - normal;
    // A reflection that makes the first axis the normal, which isotropic laws do not notice.
    let frame = match across.norm_squared() {
        square if square > f64::EPSILON => {
            Tensor::identity() - across * across.transpose() * (2.0 / square)
        }
        _ => Tensor::identity(),
    };
    Ok(Inside {
        position,
        like,
        twice: 2.0 * (hole.radius - distance),
        normal,
        frame,
        image: values.iter().map(|&(b, value, _)| (b, value)).collect(),
        slope: slopes.iter().map(|&(b, _, slope)| (b, slope)).collect(),
    })
}

/// The coefficients of the value and of the gradient at a place, by moving least squares of linear
/// functions over the particles within a radius; none where these do not span the space.
fn fit<const D: usize>(
    particles: &Particles<D>,
    place: &Vector<D>,
    radius: f64,
) -> Option<Vec<(u32, f64, Vector<D>)>> {
    let size = D + 1;
    let row = |way: &Vector<D>, k: usize| if k == 0 { 1.0 } else { way[k - 1] };
    let near: Vec<(u32, f64, Vector<D>)> = (0u32..)
        .zip(&particles.position)
        .map(|(b, x)| (b, (x - place) / radius))
        .filter(|(_, way)| way.norm_squared() < 1.0)
        .map(|(b, way)| (b, (1.0 - way.norm_squared()).powi(2), way))
        .collect();
    let mut moments = DMatrix::<f64>::zeros(size, size);
    for (_, weight, way) in &near {
        for k in 0..size {
            for l in 0..size {
                moments[(k, l)] += weight * row(way, k) * row(way, l);
            }
        }
    }
    let scale = moments[(0, 0)];
    let inverse =
        moments.try_inverse().filter(|inverse| inverse.amax() * scale < MOST_CONDITION)?;
    let coefficient = |way: &Vector<D>, weight: f64, k: usize| -> f64 {
        weight * (0..size).map(|l| inverse[(k, l)] * row(way, l)).sum::<f64>()
    };
    let all = near.iter().map(|(b, weight, way)| {
        let slope = Vector::from_fn(|axis, _| coefficient(way, *weight, axis + 1) / radius);
        (*b, coefficient(way, *weight, 0), slope)
    });
    Some(all.collect())
}
