//! The tangent stiffness of a state, in products and in blocks.

use std::sync::Arc;

use num_dual::Dual64;
use piola_formulas::hyperelastic::Tangent as MaterialTangent;
use piola_formulas::tensor;

use super::super::Discrete;
use super::faces::Spring;
use super::passes::Passes;
use crate::operators::{DirectedSupport, DualGradient, dual_row, one_by_one};
use crate::parallel::Team;
use crate::solve::Tangent;
use crate::{Tensor, Vector, parallel};

/// `K = d2E/du2` of one set of displacements, theory (51), Dual-support (29) and (40), and what
/// follower pressures and the inertia of an implicit step add to it.
///
/// Its block between two particles is a sum over the supports that hold both. With the coefficient
/// `g_p` of each particle of a support in the displacement gradient, `-sum_b G_cb` for its owner c,
///
/// ```text
/// K_pq = g_p . (V dP/dF + 2 I (x) M) . g_q + I (z_pq - g_p . y_q - g_q . y_p)
/// ```
///
/// with `M = sum_b c_cb X_cb (x) X_cb`, `y_b = 2 c_cb X_cb`, `z_bb = 2 c_cb`, and for the owner
/// what makes sums over p vanish. The displacement of an image is that of a particle with signs s, so that
/// its rows and columns are those of the particle, times s.
#[derive(Clone)]
pub struct Stiffness<const D: usize> {
    discrete: Arc<Discrete<D>>,
    support: DirectedSupport<D>,
    gradient: DualGradient<D>,
    /// `dP/dF` of each particle in Pa.
    tangents: Vec<MaterialTangent<D>>,
    /// Derivative of the pressing force on a particle by its deformation gradient, by entry, N;
    /// empty without pressure.
    pressed: Vec<[[Vector<D>; D]; D]>,
    /// Held faces, and those of each particle.
    springs: Arc<Vec<Spring<D>>>,
    springs_of: Vec<Vec<u32>>,
    /// Multiple of the mass on the diagonal in 1/s^2: 0 in statics.
    inertia: f64,
    passes: Passes<D>,
    /// Who computes together.
    team: Team,
    /// The owner of each support.
    owners: Vec<Member<D>>,
    /// The images of each particle, by slot.
    images: Vec<Vec<u32>>,
    /// A field and its product, with what belongs to images.
    field: Vec<Vector<D>>,
    product: Vec<Vector<D>>,
}

/// A particle, or an image, as a member of a support.
#[derive(Clone)]
struct Member<const D: usize> {
    /// Its slot: behind those of particles are images.
    number: u32,
    /// Coefficient in the displacement gradient, 1/m.
    g: Vector<D>,
    /// `2 c X`, N; minus the sum of the others' for the owner.
    y: Vector<D>,
    /// `2 c`, N/m; the sum of the others' for the owner.
    z: f64,
}

impl<const D: usize> Stiffness<D> {
    /// The stiffness of a body, for now at rest.
    pub fn new(discrete: Arc<Discrete<D>>) -> Self {
        let count = discrete.len();
        let passes = Passes::new(&discrete.operator);
        let (support, gradient) = discrete.operator.lists();
        let slots = discrete.operator.positions().len();
        let mut images = vec![Vec::new(); if slots > count { count } else { 0 }];
        for slot in count..slots {
            images[discrete.operator.source(slot).0].push(slot as u32);
        }
        let mut stiffness = Self {
            discrete,
            support,
            gradient,
            tangents: vec![[[Tensor::zeros(); D]; D]; count],
            pressed: Vec::new(),
            springs: Arc::default(),
            springs_of: vec![Vec::new(); count],
            inertia: 0.0,
            passes,
            team: Team::default(),
            owners: Vec::new(),
            images,
            field: vec![Vector::zeros(); slots],
            product: vec![Vector::zeros(); slots],
        };
        stiffness.owners = (0..count).map(|c| stiffness.sum_of_members(c)).collect();
        stiffness.load(&vec![Vector::zeros(); slots], &[]);
        stiffness
    }

    /// Shares the work with a team, by these passes.
    pub(super) fn share(&mut self, passes: &Passes<D>, team: &Team) {
        (self.passes, self.team) = (passes.clone(), team.clone());
    }

    /// The number of the connected part that each particle belongs to.
    pub(super) fn parts(&self) -> Vec<u32> {
        self.support.list.parts()
    }

    /// Bytes of what it is made of.
    pub(super) fn memory(&self) -> usize {
        let images: usize = self.images.iter().map(|own| size_of_val(own.as_slice())).sum();
        self.support.memory()
            + self.gradient.memory()
            + self.passes.memory()
            + size_of_val(self.tangents.as_slice())
            + size_of_val(self.pressed.as_slice())
            + size_of_val(self.owners.as_slice())
            + size_of_val(self.field.as_slice())
            + size_of_val(self.product.as_slice())
            + images
    }

    /// Adds what holds faces of cells.
    pub(super) fn hold(&mut self, springs: &Arc<Vec<Spring<D>>>) {
        self.springs = springs.clone();
        for (index, spring) in springs.iter().enumerate() {
            self.springs_of[spring.owner as usize].push(index as u32);
        }
    }

    /// Puts a multiple of the mass on the diagonal, in 1/s^2.
    pub(super) fn accelerate(&mut self, inertia: f64) {
        self.inertia = inertia;
    }

    /// The multiple of the mass on the diagonal in 1/s^2.
    pub(super) fn inertia(&self) -> f64 {
        self.inertia
    }

    /// What inertia adds to the block of particle a on the diagonal.
    #[inline]
    fn inertial(&self, a: usize) -> Tensor<D> {
        Tensor::identity() * (self.inertia * self.discrete.solid.mass[a])
    }

    /// The slots of a particle: its own, and those of its images.
    fn slots(&self, a: usize) -> impl Iterator<Item = usize> + '_ {
        let images = self.images.get(a).map_or([].as_slice(), Vec::as_slice);
        std::iter::once(a).chain(images.iter().map(|&slot| slot as usize))
    }

    /// Adds a block between two slots to that between their particles, in the row of the first.
    fn add_folded(
        &self,
        p: usize,
        q: u32,
        block: &Tensor<D>,
        add: &mut dyn FnMut(u32, &Tensor<D>),
    ) {
        if self.images.is_empty() {
            return add(q, block);
        }
        let [(_, left), (source, right)] =
            [p, q as usize].map(|slot| self.discrete.operator.source(slot));
        add(source as u32, &block.component_mul(&(left * right.transpose())));
    }

    /// Takes in displacements in m, those of images behind, and the force `p N_a` of follower pressures on each particle
    /// per area ratio in N, empty without pressure.
    pub fn load(&mut self, displacement: &[Vector<D>], pressing: &[Vector<D>]) {
        let discrete = &*self.discrete;
        self.team.fill(&mut self.tangents, |first, tangents| {
            for (offset, tangent) in tangents.iter_mut().enumerate() {
                let a = first + offset;
                let gradient = discrete.displacement_gradient(displacement, a);
                *tangent = discrete.solid.mixture(a).tangent(&gradient);
            }
        });
        self.pressed.resize(pressing.len(), [[Vector::zeros(); D]; D]);
        self.team.fill(&mut self.pressed, |first, pressed| {
            for (offset, slopes) in pressed.iter_mut().enumerate() {
                let a = first + offset;
                let gradient = discrete.displacement_gradient(displacement, a);
                *slopes = pressing_slopes(&(gradient + Tensor::identity()), &pressing[a]);
            }
        });
    }

    /// The particle at an entry of the support of c.
    #[inline]
    fn member(&self, c: usize, number: u32, entry: usize) -> Member<D> {
        let discrete = &*self.discrete;
        let z = 2.0 * discrete.operator.hourglass(c) * self.gradient.weight(entry as u32);
        let separation = self.support.separation(discrete.operator.positions(), c, number);
        let g = Vector::from(*self.gradient.coefficient(entry as u32));
        Member { number, g, y: separation * z, z }
    }

    /// Coefficient of the owner of a support in its displacement gradient, 1/m.
    #[inline]
    fn own_coefficient(&self, c: usize) -> Vector<D> {
        -self.discrete.operator.sum(c)
    }

    /// The owner of a support, from its members.
    fn sum_of_members(&self, c: usize) -> Member<D> {
        let list = &self.support.list;
        let (mut y, mut z) = (Vector::zeros(), 0.0);
        for (&b, entry) in list.row(c).iter().zip(list.range(c)) {
            let other = self.member(c, b, entry);
            y -= other.y;
            z += other.z;
        }
        Member { number: c as u32, g: self.own_coefficient(c), y, z }
    }

    /// `g . (V dP/dF + 2 I (x) M)` of the support of c: entry `[k][L]` multiplies `g_L` of a second
    /// particle in the column k of the block.
    fn contracted(&self, c: usize, g: &Vector<D>) -> [[Vector<D>; D]; D] {
        let volume = self.discrete.solid.particles.volume[c];
        let operator = &self.discrete.operator;
        let hourglass = operator.shape(c) * g * (2.0 * operator.hourglass(c));
        let mut all = [[Vector::zeros(); D]; D];
        for (k, row) in all.iter_mut().enumerate() {
            for (l, entry) in row.iter_mut().enumerate() {
                *entry = self.tangents[c][k][l] * g * volume;
                entry[k] += hourglass[l];
            }
        }
        all
    }

    /// Adds what the support of c couples its member p with.
    fn add_support(&self, c: usize, p: &Member<D>, add: &mut dyn FnMut(u32, &Tensor<D>)) {
        let list = &self.support.list;
        let contracted = self.contracted(c, &p.g);
        let is_owner = |member: &Member<D>| member.number as usize == c;
        let mut block_with = |q: &Member<D>| {
            let z = match (is_owner(p), is_owner(q)) {
                _ if p.number == q.number => p.z,
                (true, false) => -q.z,
                (false, true) => -p.z,
                _ => 0.0,
            };
            let hourglass = z - p.g.dot(&q.y) - q.g.dot(&p.y);
            let mut block = block_of(&contracted, &q.g);
            (0..D).for_each(|i| block[(i, i)] += hourglass);
            self.add_folded(p.number as usize, q.number, &block, add);
        };
        block_with(&self.owners[c]);
        for (&b, entry) in list.row(c).iter().zip(list.range(c)) {
            block_with(&self.member(c, b, entry));
        }
    }

    /// Shows the stiffness of each held face of c in the row of the particle at a position in the
    /// rows of these faces: the owner comes first, then its support in order.
    fn see_springs(&self, c: usize, position: usize, see: &mut dyn FnMut(&Spring<D>, &Tensor<D>)) {
        for &index in &self.springs_of[c] {
            let spring = &self.springs[index as usize];
            let n = spring.direction;
            see(spring, &(n * n.transpose() * (spring.stiffness * spring.row[position].1)));
        }
    }

    /// Position of the particle at an entry of the support of c in the rows of its faces.
    fn position(&self, c: usize, entry: u32) -> usize {
        entry as usize - self.support.list.range(c).start + 1
    }

    /// Adds half of what pressure couples particle a with, and half of the transpose.
    fn add_pressure(&self, a: usize, add: &mut dyn FnMut(u32, &Tensor<D>)) {
        let list = &self.support.list;
        let own = block_of(&self.pressed[a], &self.own_coefficient(a));
        add(a as u32, &(0.5 * (own + own.transpose())));
        let row = list.row(a).iter().zip(self.gradient.coefficients(list.range(a)));
        for (&b, g) in row {
            let block = 0.5 * block_of(&self.pressed[a], &Vector::from(*g));
            self.add_folded(a, b, &block, add);
        }
        for slot in self.slots(a) {
            for (&b, &entry) in dual_row(&self.support, slot) {
                let g = Vector::from(*self.gradient.coefficient(entry));
                let block = 0.5 * block_of(&self.pressed[b as usize], &g).transpose();
                self.add_folded(slot, b, &block, add);
            }
        }
    }
}

impl<const D: usize> Tangent<D> for Stiffness<D> {
    fn coupled(&self, a: usize) -> Vec<u32> {
        let support = &self.support;
        let mut all = vec![a as u32];
        all.extend_from_slice(support.list.row(a));
        for slot in self.slots(a) {
            for &c in support.dual.row(slot) {
                all.push(c);
                all.extend_from_slice(support.list.row(c as usize));
            }
        }
        if !self.images.is_empty() {
            let source = |slot: &mut u32| {
                *slot = self.discrete.operator.source(*slot as usize).0 as u32;
            };
            all.iter_mut().for_each(source);
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    fn add_row(&self, a: usize, add: &mut dyn FnMut(u32, &Tensor<D>)) {
        let add_springs = |add: &mut dyn FnMut(u32, &Tensor<D>), c: usize, position: usize| {
            self.see_springs(c, position, &mut |spring, block| {
                spring.row.iter().for_each(|&(b, r)| add(b, &(block * r)));
            });
        };
        self.add_support(a, &self.owners[a], add);
        add_springs(add, a, 0);
        for slot in self.slots(a) {
            for (&c, &entry) in dual_row(&self.support, slot) {
                let c = c as usize;
                self.add_support(c, &self.member(c, slot as u32, entry as usize), add);
                add_springs(add, c, self.position(c, entry));
            }
        }
        if !self.pressed.is_empty() {
            self.add_pressure(a, add);
        }
        if self.inertia > 0.0 {
            add(a as u32, &self.inertial(a));
        }
    }

    /// The same two passes as the forces', with the linear stress `dP/dF : A`: the hourglass force
    /// is linear as it is.
    fn apply(&mut self, direction: &[Vector<D>], product: &mut [Vector<D>]) {
        let Self { discrete, tangents, passes, .. } = self;
        let (discrete, tangents) = (&**discrete, &*tangents);
        let tension = |a: usize, gradient: &Tensor<D>| {
            let mut stress = Tensor::zeros();
            for (k, row) in tangents[a].iter().enumerate() {
                for (l, slope) in row.iter().enumerate() {
                    stress += slope * gradient[(k, l)];
                }
            }
            stress * discrete.solid.particles.volume[a]
        };
        let count = direction.len();
        parallel::copy(&mut self.field[..count], direction);
        discrete.continue_field(&mut self.field);
        passes.forces(&discrete.operator, &self.field, one_by_one(tension), &mut self.product);
        discrete.fold(&mut self.product);
        parallel::copy(product, &self.product[..count]);
        let (pressed, inertia) = (&self.pressed, self.inertia);
        let gradient = if pressed.is_empty() { &[] } else { passes.gradients() };
        parallel::for_each_chunk(product, |first, product| {
            for (offset, product) in product.iter_mut().enumerate() {
                let a = first + offset;
                *product = -*product;
                *product += direction[a] * (inertia * discrete.solid.mass[a]);
                if let Some(slopes) = pressed.get(a) {
                    for (k, row) in slopes.iter().enumerate() {
                        for (l, slope) in row.iter().enumerate() {
                            *product += slope * gradient[a][(k, l)];
                        }
                    }
                }
            }
        });
        self.springs.iter().for_each(|spring| spring.add_product(direction, product));
    }

    fn diagonal(&self) -> Vec<Tensor<D>> {
        let mut blocks = vec![Tensor::zeros(); self.discrete.len()];
        self.team.fill(&mut blocks, |first, blocks| {
            for (offset, block) in blocks.iter_mut().enumerate() {
                let a = first + offset;
                if self.images.get(a).is_some_and(|images| !images.is_empty()) {
                    // A particle and its images may be members of the same supports.
                    self.add_row(a, &mut |b, part| {
                        if b as usize == a {
                            *block += part;
                        }
                    });
                    continue;
                }
                *block = self.own_block(a, &self.owners[a]) + self.inertial(a);
                self.see_springs(a, 0, &mut |spring, row| *block += row * spring.row[0].1);
                for (&c, &entry) in dual_row(&self.support, a) {
                    let c = c as usize;
                    let position = self.position(c, entry);
                    *block += self.own_block(c, &self.member(c, a as u32, entry as usize));
                    self.see_springs(c, position, &mut |spring, row| {
                        *block += row * spring.row[position].1;
                    });
                }
                if let Some(slopes) = self.pressed.get(a) {
                    *block += block_of(slopes, &self.own_coefficient(a));
                }
            }
        });
        blocks
    }

    fn is_symmetric(&self) -> bool {
        self.pressed.is_empty()
    }
}

impl<const D: usize> Stiffness<D> {
    /// What the support of c adds to the block of its member p on the diagonal.
    fn own_block(&self, c: usize, p: &Member<D>) -> Tensor<D> {
        let block = block_of(&self.contracted(c, &p.g), &p.g);
        block + Tensor::identity() * (p.z - 2.0 * p.g.dot(&p.y))
    }
}

/// `block_ik = sum_L slopes[k][L]_i g_L`.
#[inline]
fn block_of<const D: usize>(slopes: &[[Vector<D>; D]; D], g: &Vector<D>) -> Tensor<D> {
    let mut block = Tensor::zeros();
    for (k, row) in slopes.iter().enumerate() {
        for (l, slope) in row.iter().enumerate() {
            for i in 0..D {
                block[(i, k)] += slope[i] * g[l];
            }
        }
    }
    block
}

/// Derivatives of `cof(F) w` by the entries of F.
fn pressing_slopes<const D: usize>(f: &Tensor<D>, w: &Vector<D>) -> [[Vector<D>; D]; D] {
    let mut slopes = [[Vector::zeros(); D]; D];
    if w.amax() == 0.0 {
        return slopes;
    }
    for (k, row) in slopes.iter_mut().enumerate() {
        for (l, slope) in row.iter_mut().enumerate() {
            let mut seeded = f.map(Dual64::from_re);
            seeded[(k, l)] = seeded[(k, l)].derivative();
            *slope = tensor::cofactor(&seeded).map(|entry| entry.eps) * w;
        }
    }
    slopes
}
