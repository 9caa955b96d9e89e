//! Solids that touch walls or each other: what keeps them apart.
//!
//! A surface is known by points of it, one for each face that a wall particle of the fluid is the first behind, with the
//! normal there. A point i of one body meets the plane through the points j of another that are around it, with weights of
//! the distance s along the plane and of how they face each other, and is held off where it is behind that
//! plane by some depth `d > 0`, theory (85):
//!
//! ```text
//! d = -sum_j w_ij (x_i - x_j) . n_j / sum_j w_ij,   n = sum_j w_ij n_j / |sum_j w_ij n_j|
//! w_ij = (1 - s_ij^2/dx^2)^2 (n_i . n_j)^2 e_ij
//! F_i = A/2 max(0, k rho c^2 d/dx - z rho c v . n) n - min(mu |F_n|, A rho c |v_t|) v_t/|v_t|
//! ```
//!
//! At an edge, where the particle of point j is behind another face, through `x_m` with the normal `n_m`, `e_ij` falls from 1 at
//! half a spacing before that face to 0 on it: what slides along one face of an edge is not held by the other one. It is the
//! product over all such faces, and 1 elsewhere.
//!
//! The points j get what is opposite, with the same weights. Both bodies take part as i and as j, which is why there is
//! a half. A is the area of a point, c the wave speed of the fluid, with which `rho c^2 / dx` is as
//! stiff as a step of the fluid allows with some margin.

use super::Solid;
use crate::neighbors::{Domain, search};
use crate::schemes::transport_velocity::{TransportVelocity, WallSelection};
use crate::{Vector, parallel};

/// How far in spacings the points of a surface make a plane along it.
const ALONG: f64 = 1.0;

/// How far in spacings in front of a plane and behind it points are seen.
const ACROSS: f64 = 1.5;

/// How far in spacings bodies move before points are looked for anew.
const SKIN: f64 = 0.5;

/// What of a spacing a wall particle is less than behind its face: the first layer, wherever the lattice begins.
const BEHIND: f64 = 1.0 - 1e-6;

/// Cosine of the angle between the normals of surfaces beyond which they do not meet.
const FACING: f64 = -0.1;

/// Cosine of the angle between two normals of one particle below which they are of the two sides of a thin part.
const OPPOSITE: f64 = -0.9;

/// What holds back a point that creeps, in `A/2 rho c` times its velocity: what a step of the fluid allows with some
/// margin, as the particles of a surface weigh `rho dx^D` and steps are about `0.3 dx/c`.
const GRIP: f64 = 2.0;

/// How deep in spacings a point may be behind a plane before it has gone through.
const THROUGH: f64 = 1.0;

/// Largest factors of stiffness and of damping that steps of the fluid can take.
pub const MOST_STIFFNESS: f64 = 4.0;
/// See [`MOST_STIFFNESS`].
pub const MOST_DAMPING: f64 = 2.0;

/// How a solid is kept apart from others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// What `rho c^2` is multiplied by.
    pub stiffness: f64,
    /// The factor z of what is lost, a pure number.
    pub damping: f64,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
}

impl Default for ContactLaw {
    fn default() -> Self {
        Self { stiffness: 1.0, damping: 0.5, friction: 0.0 }
    }
}

impl ContactLaw {
    /// That between two solids.
    fn with(&self, other: &Self) -> Self {
        Self {
            stiffness: self.stiffness.min(other.stiffness),
            damping: 0.5 * (self.damping + other.damping),
            friction: 0.5 * (self.friction + other.friction),
        }
    }
}

/// Whose a point is, and what of it: walls and solids are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// A particle (index among the [walls](Contact::walls)) of a wall of the fluid, with one of its faces.
    Wall { wall: usize, face: usize },
    /// A row of the interface of a solid, with one of its faces.
    Solid { solid: usize, row: usize, face: usize },
}

impl Origin {
    /// The solid that it is of.
    fn solid(&self) -> Option<usize> {
        match self {
            Self::Wall { .. } => None,
            Self::Solid { solid, .. } => Some(*solid),
        }
    }
}

/// A point of a surface at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point<const D: usize> {
    place: Vector<D>,
    normal: Vector<D>,
}

/// A point that has points of other bodies around it.
#[derive(Clone, Debug)]
struct Near<const D: usize> {
    point: u32,
    others: Vec<u32>,
    /// Those that make a plane at the point, with their weights.
    weights: Vec<(u32, f64)>,
    /// The plane, if the point is behind it.
    behind: Option<Plane<D>>,
}

/// The plane that some points make at another one.
#[derive(Clone, Copy, Debug)]
struct Plane<const D: usize> {
    normal: Vector<D>,
    /// How far the point is behind it in m.
    depth: f64,
    /// Sum of the weights, and that without how points face each other.
    total: f64,
    covered: f64,
}

/// What touches what.
#[derive(Clone, Debug, Default)]
pub(super) struct Contact<const D: usize> {
    /// The wall particles of the fluid, by number, that have points.
    walls: WallSelection,
    origins: Vec<Origin>,
    /// The points of the same particle, by index: the first, and the one after the last.
    together: Vec<[usize; 2]>,
    /// What stands between a wall particle and its surface where solids begin.
    offsets: Vec<Vector<D>>,
    /// Its normal there.
    normals: Vec<Vector<D>>,
    points: Vec<Point<D>>,
    /// Where points were when those around them were looked for.
    seen: Vec<Vector<D>>,
    near: Vec<Near<D>>,
    /// Whether the normal of a point is asked for.
    is_asked: Vec<bool>,
    /// Density of the solid behind each point in kg/m^3, infinite of walls.
    densities: Vec<f64>,
    /// The largest depth in m, with the point of a solid that has a part in it.
    deepest: Option<(f64, usize)>,
}

impl<const D: usize> Contact<D> {
    /// Finds the points of surfaces.
    pub fn new(fluid: &TransportVelocity<D>, solids: &[Solid<D>]) -> Self {
        let mut made = Self::default();
        let behind = BEHIND * fluid.spacing();
        let mut add = |number: u32, density: f64, origin: &dyn Fn(usize) -> Origin| {
            let Some(faces) = fluid.faces_of(number).filter(|it| it.depth() < behind) else {
                return false;
            };
            let first = made.origins.len();
            let all = faces.normals().iter().zip(faces.depths());
            for (face, (normal, depth)) in all.enumerate() {
                made.together.push([first, first + faces.normals().len()]);
                made.origins.push(origin(face));
                made.offsets.push(normal * *depth);
                made.normals.push(*normal);
                made.densities.push(density);
            }
            true
        };
        let mut walls = Vec::new();
        for number in fluid.own_walls() {
            let wall = walls.len();
            if add(number, f64::INFINITY, &|face| Origin::Wall { wall, face }) {
                walls.push(number);
            }
        }
        for (solid, own) in solids.iter().enumerate() {
            for (row, &number) in own.interface.walls().iter().enumerate() {
                add(number, own.density(row), &|face| Origin::Solid { solid, row, face });
            }
        }
        made.walls = WallSelection::new(walls);
        made
    }

    /// The wall particles of the fluid, by number, that have points.
    pub fn walls(&self) -> &WallSelection {
        &self.walls
    }

    /// The solid and the row of a point that has gone through another surface, at the last look.
    pub fn through(&self, spacing: f64) -> Option<(usize, usize)> {
        let (depth, point) = self.deepest?;
        match self.origins[point] {
            Origin::Solid { solid, row, .. } if depth > THROUGH * spacing => Some((solid, row)),
            _ => None,
        }
    }

    /// Takes points where they are now, looks for those around them if they have moved far enough, and finds which are
    /// behind a plane of others.
    ///
    /// `place` and `normal` take the origin of a point, and what stands between its wall particle and its surface
    /// where solids begin or the normal there.
    pub fn update(
        &mut self,
        domain: &Domain<D>,
        spacing: f64,
        place: impl Fn(&Origin, &Vector<D>) -> Vector<D> + Sync,
        normal: impl Fn(&Origin, &Vector<D>) -> Vector<D> + Sync,
    ) {
        let mut points = std::mem::take(&mut self.points);
        points
            .resize(self.origins.len(), Point { place: Vector::zeros(), normal: Vector::zeros() });
        let (origins, offsets) = (&self.origins, &self.offsets);
        parallel::for_each_chunk(&mut points, |first, points| {
            for (i, point) in (first..).zip(points) {
                point.place = place(&origins[i], &offsets[i]);
            }
        });
        self.look_around(domain, spacing, &points);
        if !self.near.is_empty() {
            let Self { origins, normals, is_asked, .. } = &*self;
            parallel::for_each_chunk(&mut points, |first, points| {
                for (i, point) in (first..).zip(points).filter(|(i, _)| is_asked[*i]) {
                    point.normal = normal(&origins[i], &normals[i]);
                }
            });
        }
        self.points = points;
        let mut near = std::mem::take(&mut self.near);
        parallel::for_each_item(&mut near, |_, near| self.find_plane(near, domain, spacing));
        self.near = near;
        self.deepest = None;
        for Near { point, weights, behind, .. } in &self.near {
            let Some(Plane { depth, .. }) = *behind else { continue };
            let both = [*point as usize, weights[0].0 as usize];
            let of_solid = both.into_iter().find(|k| self.origins[*k].solid().is_some());
            if let Some(point) = of_solid
                && self.deepest.is_none_or(|(deepest, _)| depth > deepest)
            {
                self.deepest = Some((depth, point));
            }
        }
    }

    /// Looks for what is around points, if they have moved far enough since.
    fn look_around(&mut self, domain: &Domain<D>, spacing: f64, points: &[Point<D>]) {
        let far = (0.5 * SKIN * spacing).powi(2);
        let moved = |i: usize| domain.separation(&self.seen[i], &points[i].place).norm_squared();
        if self.seen.len() == points.len() && parallel::maximum(points.len(), 0.0, moved) <= far {
            return;
        }
        self.seen.clear();
        self.seen.extend(points.iter().map(|point| domain.wrap(&point.place)));
        self.near.clear();
        self.is_asked.clear();
        self.is_asked.resize(points.len(), false);
        let reach = ALONG.hypot(ACROSS) + SKIN;
        let reach = vec![reach * spacing; self.seen.len()];
        // Points that are not finite belong to a state that is refused.
        let Ok(list) = search(&self.seen, &reach, domain) else { return };
        for (i, origin) in self.origins.iter().enumerate() {
            let is_other = |&&j: &&u32| self.origins[j as usize].solid() != origin.solid();
            let others: Vec<u32> = list.row(i).iter().filter(is_other).copied().collect();
            if others.is_empty() {
                continue;
            }
            self.is_asked[i] = true;
            for &j in &others {
                let [first, end] = self.together[j as usize];
                self.is_asked[first..end].fill(true);
            }
            let weights = Vec::with_capacity(others.len());
            self.near.push(Near { point: i as u32, others, weights, behind: None });
        }
    }

    /// Finds the plane that a point is behind.
    fn find_plane(&self, near: &mut Near<D>, domain: &Domain<D>, spacing: f64) {
        let Near { point, others, weights, behind } = near;
        let me = &self.points[*point as usize];
        weights.clear();
        *behind = None;
        let (mut covered, mut total, mut depth) = (0.0, 0.0, 0.0);
        let mut normal = Vector::zeros();
        for &j in others.iter() {
            let other = &self.points[j as usize];
            let way = domain.separation(&other.place, &me.place);
            let (height, facing) = (way.dot(&other.normal), me.normal.dot(&other.normal));
            let aside = way.norm_squared() - height * height;
            let share = 1.0 - aside / (ALONG * spacing).powi(2);
            if share <= 0.0 || height.abs() >= ACROSS * spacing || facing > FACING {
                continue;
            }
            let tile = share * share * self.before_edges(j as usize, me, domain, spacing);
            let weight = tile * facing * facing;
            if weight <= 0.0 {
                continue;
            }
            weights.push((j, weight));
            covered += tile;
            total += weight;
            depth -= weight * height;
            normal += other.normal * weight;
        }
        let Some(normal) = normal.try_normalize(1e-6 * total) else { return };
        depth /= total;
        if depth > 0.0 {
            *behind = Some(Plane { normal, depth, total, covered });
        }
    }

    /// Whether points at hand are so close to some of other bodies that they see each other, or nearly.
    pub fn is_near(&self, domain: &Domain<D>, spacing: f64) -> bool {
        self.near.iter().any(|near| {
            let me = &self.points[near.point as usize];
            near.others.iter().any(|&j| {
                let other = &self.points[j as usize];
                let way = domain.separation(&other.place, &me.place);
                let is_close =
                    way.norm_squared() < (ALONG.powi(2) + ACROSS.powi(2)) * spacing * spacing;
                is_close && me.normal.dot(&other.normal) <= FACING
            })
        })
    }

    /// Hands out the forces between points at hand: `velocity` and `bear` take the origin of a point and what stands
    /// between its wall particle and its surface where solids begin, and `bear` a force in N.
    pub fn forces(
        &self,
        (spacing, wave_speed): (f64, f64),
        law: impl Fn(usize) -> ContactLaw,
        velocity: impl Fn(&Origin, &Vector<D>) -> Vector<D>,
        mut bear: impl FnMut(&Origin, &Vector<D>, &Vector<D>),
    ) {
        let area = spacing.powi(D as i32 - 1);
        let velocity = |k: usize| velocity(&self.origins[k], &self.offsets[k]);
        let mut bear =
            |k: usize, force: &Vector<D>| bear(&self.origins[k], &self.offsets[k], force);
        for Near { point, weights, behind, .. } in &self.near {
            let Some(Plane { normal, depth, total, covered }) = *behind else { continue };
            let i = *point as usize;
            let both = [i, weights[0].0 as usize].map(|point| (point, self.origins[point].solid()));
            let of_solids = || both.into_iter().filter_map(|(k, solid)| Some((k, solid?)));
            let laws = of_solids().map(|(_, solid)| law(solid));
            let Some(law) = laws.reduce(|one, other| one.with(&other)) else { continue };
            let ContactLaw { stiffness, damping, friction } = law;
            let density = of_solids().map(|(k, _)| self.densities[k]).fold(f64::INFINITY, f64::min);
            let share = 0.5 * area * f64::min(covered, 1.0) * density * wave_speed;
            let mut motion = Vector::zeros();
            weights.iter().for_each(|(j, weight)| motion += velocity(*j as usize) * *weight);
            let velocity = velocity(i) - motion / total;
            let across = velocity.dot(&normal);
            let push = stiffness * wave_speed * depth / spacing - damping * across;
            let push = (share * push).max(0.0);
            let along = velocity - normal * across;
            let slip = along.norm();
            let drag = (friction * push).min(GRIP * share * slip);
            let drag = if slip > 0.0 { drag / slip } else { 0.0 };
            let force = normal * push - along * drag;
            bear(i, &force);
            for &(j, weight) in weights {
                bear(j as usize, &(force * (-weight / total)));
            }
        }
    }

    /// How much of point `j` is there beside another point: all but next to an edge.
    fn before_edges(&self, j: usize, me: &Point<D>, domain: &Domain<D>, spacing: f64) -> f64 {
        let [first, end] = self.together[j];
        let own = self.points[j].normal;
        let is_edge = |edge: &&Point<D>| edge.normal.dot(&own) > OPPOSITE;
        let others = (first..end).filter(|&m| m != j).map(|m| &self.points[m]).filter(is_edge);
        let before = others.map(|edge| {
            let beyond = domain.separation(&edge.place, &me.place).dot(&edge.normal);
            (-2.0 * beyond / spacing).clamp(0.0, 1.0)
        });
        before.product()
    }

    /// Bytes that it holds.
    pub fn memory(&self) -> usize {
        let near = self.near.iter();
        let near = near.map(|it| size_of_val(it) + it.others.len() * (4 + size_of::<(u32, f64)>()));
        self.walls.memory()
            + size_of_val(self.origins.as_slice())
            + size_of_val(self.points.as_slice())
            + 3 * size_of_val(self.seen.as_slice())
            + near.sum::<usize>()
    }
}
