//! The surface that a fluid and a solid share: wall particles of the fluid that a solid carries.
//!
//! The wall particles fill the solid at the spacing of the fluid, whatever that of the solid is. Each is
//! carried by the particles of the solid around its reference position,
//!
//! ```text
//! x_w = sum_b N_wb x_b,   sum_b N_wb = 1,   sum_b N_wb X_b = X_w
//! ```
//!
//! and what the fluid does to it goes to the same particles with the same weights, `f_b = sum_w N_wb f_w`.
//! As the weights reproduce linear functions, `sum_w f_w = sum_b f_b` and
//! `sum_w x_w x f_w = sum_b x_b x f_b`: nothing of momentum is lost between the two spacings, and as
//! `v_w = sum_b N_wb v_b` no power either. Where the spacings are the
//! same, a particle of the solid that stands at `X_w` is the only one.
//! This is theory (81).

use nalgebra::{DMatrix, DVector};
use piola_formulas::tensor;
use thiserror::Error;

use crate::coordinates;
use crate::neighbors::{Domain, NeighborError, search};
use crate::{Tensor, Vector};

/// What of its own spacing a particle of the solid may be away from a wall particle that it carries alone.
const SAME_PLACE: f64 = 1e-6;

/// How far a wall particle is carried from, in spacings of the solid, or of the fluid where that is
/// coarser: as far as the nearest particles across a cell.
const REACH: [f64; 2] = [1.8, 1.2];

/// The least singular value of scaled moments that is no round-off.
const LEAST: f64 = 1e-8;

/// What the distance of two particles that carry a wall particle is multiplied by where the solid has come apart, or has
/// flowed so far that who was around whom at the start says nothing: another wall particle would find room between.
const TORN: f64 = 2.0;

/// Largest ratio of the spacings of fluid and solid, either way.
pub const MOST_RATIO: f64 = 3.0;

/// A fluid and a solid that cannot be coupled.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InterfaceError {
    /// The solid has no particles across which it deforms.
    #[error(
        "the solid has too few particles around {at} m to tell how its surface deforms \
         there: it needs at least two layers, and three where it bends",
        at = coordinates(position)
    )]
    Thin {
        /// Where, in m.
        position: Vec<f64>,
    },
    /// One of the two is much coarser.
    #[error(
        "the spacing of the solid, {solid:.3e} m, and that of the fluid, {fluid:.3e} m, differ by more \
         than a factor of 3"
    )]
    Spacings {
        /// Spacing of the solid in m.
        solid: f64,
        /// Spacing of the fluid in m.
        fluid: f64,
    },
    /// The particles around cannot be found.
    #[error(transparent)]
    Neighbors(#[from] NeighborError),
}

/// One particle of the solid that carries a wall particle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Carrier<const D: usize> {
    /// Index in memory of the solid.
    particle: u32,
    /// `N_wb`.
    weight: f64,
    /// `dN_wb / dX` in 1/m, with which the deformation gradient at the wall particle is found.
    slope: Vector<D>,
}

impl<const D: usize> Carrier<D> {
    /// Its weight for a point at an offset in m from the wall particle where the solid begins.
    fn weight_at(&self, offset: &Vector<D>) -> f64 {
        self.weight + self.slope.dot(offset)
    }
}

/// Who carries which wall particle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interface<const D: usize> {
    /// The wall particles, by their number in the fluid, and their reference positions in m.
    walls: Vec<u32>,
    reference: Vec<Vector<D>>,
    /// Where the carriers of each begin, and where the last ones end.
    starts: Vec<usize>,
    /// Where those of each end that have a weight: one that carries alone stands in front of the others.
    ends: Vec<usize>,
    carriers: Vec<Carrier<D>>,
}

impl<const D: usize> Interface<D> {
    /// Couples the `walls` of a fluid, numbers with bodies and reference positions, with the particles of a solid
    /// by reference positions and bodies: those of one body carry the walls of that body. Spacings are those of fluid and solid in m.
    ///
    /// # Errors
    /// [`InterfaceError`] where the solid cannot carry them.
    pub fn new(
        walls: &[(u32, u32, Vector<D>)],
        solid: (&[Vector<D>], &[u32]),
        [of_fluid, of_solid]: [f64; 2],
        domain: &Domain<D>,
    ) -> Result<Self, InterfaceError> {
        // Round-off of a ratio of three is none of a larger one.
        let most = MOST_RATIO * (1.0 + 1e-9);
        if !(of_fluid <= most * of_solid && of_solid <= most * of_fluid) {
            return Err(InterfaceError::Spacings { solid: of_solid, fluid: of_fluid });
        }
        // Of finer solids, particles that carry one alone would leave those between them without a load.
        let is_same = (of_fluid - of_solid).abs() <= SAME_PLACE * of_solid;
        let same_place = if is_same { SAME_PLACE * of_solid } else { -1.0 };
        let reach = (REACH[0] * of_solid).max(REACH[1] * of_fluid);
        let all: Vec<Vector<D>> =
            walls.iter().map(|(.., x)| *x).chain(solid.0.iter().copied()).collect();
        let list = search(&all, &vec![reach; all.len()], domain)?;
        let mut built = Self {
            walls: Vec::new(),
            reference: Vec::new(),
            starts: vec![0],
            ends: Vec::new(),
            carriers: Vec::new(),
        };
        for (row, (number, body, position)) in walls.iter().enumerate() {
            let around = list.row(row).iter().filter_map(|&other| {
                let particle = (other as usize).checked_sub(walls.len())?;
                let way = domain.separation(position, &solid.0[particle]);
                (solid.1[particle] == *body).then_some((particle as u32, way))
            });
            let around: Vec<(u32, Vector<D>)> = around.collect();
            let own = carriers(&around, reach, same_place).ok_or_else(|| InterfaceError::Thin {
                position: position.iter().copied().collect(),
            })?;
            let first = built.carriers.len();
            built.carriers.extend(own);
            let own = &mut built.carriers[first..];
            own.sort_by_key(|carrier| carrier.weight == 0.0);
            built.ends.push(first + own.partition_point(|carrier| carrier.weight != 0.0));
            built.walls.push(*number);
            built.reference.push(*position);
            built.starts.push(built.carriers.len());
        }
        Ok(built)
    }

    /// The wall particles by their number in the fluid.
    pub fn walls(&self) -> &[u32] {
        &self.walls
    }

    /// The particle of the solid that carries most of wall particle `row`.
    pub fn carrier(&self, row: usize) -> u32 {
        let own = &self.carriers[self.starts[row]..self.starts[row + 1]];
        let most = own.iter().max_by(|one, other| one.weight.total_cmp(&other.weight));
        most.map_or(0, |carrier| carrier.particle)
    }

    /// The mean of a number of the solid's particles (indices in memory) by their weights for wall particle `row`.
    pub fn mean(&self, row: usize, of: impl Fn(usize) -> f64) -> f64 {
        let own = &self.carriers[self.starts[row]..self.starts[row + 1]];
        own.iter().map(|carrier| of(carrier.particle as usize) * carrier.weight).sum()
    }

    /// The sum of a function of the solid's particles (indices in memory) over those that carry wall
    /// particle `row`.
    #[inline]
    pub fn carried(&self, row: usize, of: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        self.weighted(row).map(|it| of(it.particle as usize) * it.weight).sum()
    }

    /// The carriers of wall particle `row` that have a weight.
    #[inline]
    fn weighted(&self, row: usize) -> impl Iterator<Item = &Carrier<D>> {
        self.carriers[self.starts[row]..self.ends[row]].iter()
    }

    /// The same for a point that is at an `offset` in m from the wall particle where the solid begins.
    #[inline]
    pub fn carried_at(
        &self,
        row: usize,
        offset: &Vector<D>,
        of: impl Fn(usize) -> Vector<D>,
    ) -> Vector<D> {
        let own = &self.carriers[self.starts[row]..self.starts[row + 1]];
        own.iter().map(|it| of(it.particle as usize) * it.weight_at(offset)).sum()
    }

    /// Where wall particle `row` is, in m, for displacements of the solid's particles in m: those of particles
    /// beyond a periodic bound are as good as others.
    #[inline]
    pub fn place(&self, row: usize, displacement: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        self.reference[row] + self.carried(row, displacement)
    }

    /// The same for a point that is at an `offset` in m from the wall particle where the solid begins.
    #[inline]
    pub fn place_at(
        &self,
        row: usize,
        offset: &Vector<D>,
        displacement: impl Fn(usize) -> Vector<D>,
    ) -> Vector<D> {
        self.reference[row] + offset + self.carried_at(row, offset, displacement)
    }

    /// The deformation gradient at wall particle `row` for displacements of the solid's particles in m.
    #[inline]
    pub fn deformation(&self, row: usize, displacement: impl Fn(usize) -> Vector<D>) -> Tensor<D> {
        let mut gradient = Tensor::<D>::zeros();
        for carrier in &self.carriers[self.starts[row]..self.starts[row + 1]] {
            let moved = displacement(carrier.particle as usize);
            for axis in 0..D {
                let mut column = gradient.column_mut(axis);
                column += moved * carrier.slope[axis];
            }
        }
        Tensor::identity() + gradient
    }

    /// Whether those that carry wall particle `row` are not around each other as they were: one of them is twice as far
    /// from the one that carries most, or they are turned inside out. Positions are those at the start.
    pub fn is_torn(
        &self,
        row: usize,
        (domain, reference): (&Domain<D>, &[Vector<D>]),
        displacement: impl Fn(usize) -> Vector<D>,
    ) -> bool {
        let lead = self.carrier(row) as usize;
        let moved = displacement(lead);
        let own = &self.carriers[self.starts[row]..self.starts[row + 1]];
        let is_far = |carrier: &Carrier<D>| {
            let other = carrier.particle as usize;
            let began = domain.separation(&reference[lead], &reference[other]);
            let now = began + displacement(other) - moved;
            now.norm_squared() > TORN * TORN * began.norm_squared()
        };
        own.iter().any(is_far) || tensor::determinant(&self.deformation(row, &displacement)) <= 0.0
    }

    /// Adds what acts on wall particle `row` to the particles of the solid that carry it.
    #[inline]
    pub fn bear(&self, row: usize, force: &Vector<D>, forces: &mut [Vector<D>]) {
        for carrier in self.weighted(row) {
            forces[carrier.particle as usize] += force * carrier.weight;
        }
    }

    /// The same for a point that is at an `offset` in m from the wall particle where the solid begins.
    #[inline]
    pub fn bear_at(
        &self,
        row: usize,
        offset: &Vector<D>,
        force: &Vector<D>,
        forces: &mut [Vector<D>],
    ) {
        for carrier in &self.carriers[self.starts[row]..self.starts[row + 1]] {
            forces[carrier.particle as usize] += force * carrier.weight_at(offset);
        }
    }

    /// Bytes that it holds.
    pub fn memory(&self) -> usize {
        size_of_val(self.walls.as_slice())
            + size_of_val(self.starts.as_slice())
            + size_of_val(self.ends.as_slice())
            + size_of_val(self.carriers.as_slice())
    }
}

/// The carriers of a point among the particles `around` it, with their way from there: those of the linear
/// function that fits best with the weights `(1 - |r|^2 / R^2)^2`, and of which the value at the point and
/// the gradient are taken. `None` where they do not determine one.
fn carriers<const D: usize>(
    around: &[(u32, Vector<D>)],
    reach: f64,
    same_place: f64,
) -> Option<Vec<Carrier<D>>> {
    let basis = |way: &Vector<D>| {
        DVector::from_fn(D + 1, |k, _| if k == 0 { 1.0 } else { way[k - 1] / reach })
    };
    let weight = |way: &Vector<D>| (1.0 - way.norm_squared() / (reach * reach)).max(0.0).powi(2);
    let mut moments = DMatrix::<f64>::zeros(D + 1, D + 1);
    for (_, way) in around {
        let basis = basis(way);
        moments += &basis * basis.transpose() * weight(way);
    }
    let fit = moments.svd(true, true);
    if fit.singular_values.min() < LEAST * fit.singular_values.max().max(f64::MIN_POSITIVE) {
        return None;
    }
    let inverse = fit.pseudo_inverse(0.0).ok()?;
    let alone = around.iter().position(|(_, way)| way.norm() <= same_place);
    let carriers = around.iter().enumerate().map(|(k, (particle, way))| {
        let shape = &inverse * basis(way) * weight(way);
        Carrier {
            particle: *particle,
            weight: match alone {
                Some(alone) => f64::from(u8::from(alone == k)),
                None => shape[0],
            },
            slope: Vector::from_fn(|i, _| shape[i + 1] / reach),
        }
    });
    Some(carriers.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wall particles of spacing `dx` in a bent strip of particles of spacing 0.1.
    fn interface(dx: f64) -> (Interface<2>, Vec<Vector<2>>, Vec<Vector<2>>) {
        let grid = |dx: f64| -> Vec<Vector<2>> {
            let count = |length: f64| (length / dx).round() as usize;
            let place = |i, j| Vector::from([(i as f64 + 0.5) * dx, (j as f64 + 0.5) * dx]);
            let rows = 0..count(0.6);
            rows.flat_map(|j| (0..count(1.2)).map(move |i| place(i, j))).collect()
        };
        let (solid, walls) = (grid(0.1), grid(dx));
        let numbered: Vec<_> = (7..).zip(&walls).map(|(number, x)| (number, 3, *x)).collect();
        let domain = Domain::new([None; 2]).expect("open");
        let built = Interface::new(&numbered, (&solid, &vec![3; solid.len()]), [dx, 0.1], &domain)
            .expect("thick enough");
        (built, solid, walls)
    }

    #[test]
    fn nothing_of_force_moment_and_power_is_lost_between_spacings() {
        for dx in [0.05, 0.1, 0.2, 0.3] {
            let (interface, solid, walls) = interface(dx);
            let bent = |x: &Vector<2>| Vector::from([x[0] - 0.3 * x[1] * x[0], x[1] + x[0] * x[0]]);
            let places: Vec<Vector<2>> = solid.iter().map(bent).collect();
            let velocities: Vec<Vector<2>> =
                solid.iter().map(|x| Vector::from([x[1].sin(), x[0].cos()])).collect();
            let mut borne = vec![Vector::<2>::zeros(); solid.len()];
            let cross = |x: &Vector<2>, f: &Vector<2>| x[0] * f[1] - x[1] * f[0];
            let (mut force, mut moment, mut power) = (Vector::<2>::zeros(), 0.0, 0.0);
            for (row, wall) in walls.iter().enumerate() {
                let pull = Vector::from([1.0 + wall[1], wall[0] * wall[0] - 0.4]);
                interface.bear(row, &pull, &mut borne);
                force += pull;
                moment += cross(&interface.carried(row, |b| places[b]), &pull);
                power += interface.carried(row, |b| velocities[b]).dot(&pull);
            }
            let sum: Vector<2> = borne.iter().sum();
            assert!((sum - force).norm() < 1e-12 * force.norm(), "{dx}");
            let of_solid: f64 = places.iter().zip(&borne).map(|(x, f)| cross(x, f)).sum();
            assert!((of_solid - moment).abs() < 1e-11 * moment.abs(), "{dx}: {of_solid} {moment}");
            let of_solid: f64 = velocities.iter().zip(&borne).map(|(v, f)| v.dot(f)).sum();
            assert!((of_solid - power).abs() < 1e-11 * power.abs().max(1.0), "{dx}");
        }
    }

    #[test]
    fn a_linear_motion_is_followed_exactly_and_its_gradient_found() {
        let gradient = Tensor::from([[1.1, 0.2], [-0.4, 0.9]]);
        for dx in [0.05, 0.1, 0.3] {
            let (interface, solid, walls) = interface(dx);
            for (row, wall) in walls.iter().enumerate() {
                let displacement = |b: usize| gradient * solid[b] - solid[b];
                let place = interface.place(row, displacement);
                assert!((place - gradient * wall).norm() < 1e-12);
                let found = interface.deformation(row, displacement);
                assert!((found - gradient).norm() < 1e-10, "{found}");
            }
        }
        let (same, ..) = interface(0.1);
        assert!(same.carriers.iter().all(|it| it.weight == 0.0 || it.weight == 1.0));
    }

    /// A uniform motion takes all around a wall particle apart by its stretches: twice the distance is too far, half of it
    /// is not, and what is turned round but keeps its distances is found by the determinant.
    #[test]
    fn what_has_come_apart_or_is_inside_out_is_found() {
        let domain = Domain::<2>::new([None; 2]).expect("open");
        let motions = [
            ([[1.99, 0.0], [0.0, 0.5]], false),
            ([[2.01, 0.0], [0.0, 0.5]], true),
            ([[0.0, -1.0], [1.0, 0.0]], false),
            ([[-1.0, 0.0], [0.0, 1.0]], true),
        ];
        for dx in [0.05, 0.1, 0.2] {
            let (interface, solid, walls) = interface(dx);
            for (rows, expected) in motions {
                let gradient = Tensor::<2>::from_fn(|i, j| rows[i][j]);
                let displacement = |b: usize| gradient * solid[b] - solid[b];
                for row in 0..walls.len() {
                    let found = interface.is_torn(row, (&domain, &solid), displacement);
                    assert_eq!(found, expected, "{dx} {rows:?}");
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_coupled_is_refused() {
        let domain = Domain::<2>::new([None; 2]).expect("open");
        let line: Vec<Vector<2>> =
            (0..9).map(|i| Vector::from([0.1 * f64::from(i), 0.0])).collect();
        let walls = [(0, 3, Vector::from([0.4, 0.0]))];
        let error =
            Interface::new(&walls, (&line, &[3; 9]), [0.1, 0.1], &domain).expect_err("one layer");
        assert!(matches!(error, InterfaceError::Thin { .. }), "{error}");
        for spacings in [[0.31, 0.1], [0.1, 0.31]] {
            let error = Interface::new(&walls, (&line, &[3; 9]), spacings, &domain)
                .expect_err("too far apart");
            assert!(matches!(error, InterfaceError::Spacings { .. }), "{error}");
        }
    }
}
