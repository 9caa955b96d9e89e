//! The passes of a step as text.

use nalgebra::SMatrix;
use piola_device::{
    Among, Dialect, Frozen, Gather, Order, Pass, Traced, Use, difference, local, own, spread,
    through,
};
use piola_formulas::pairs::total_lagrangian::{Forces, Gradients};
use piola_formulas::pairs::{Components, Each, One, Square};
use piola_formulas::viscous::Viscous;
use piola_formulas::{Number, tensor};

use super::super::Mixture;
use crate::operators::stabilised;
use crate::schemes::device::solid;
use crate::schemes::device::{
    Recorded, are_finite, by_kind, entries, one, square, take, tensor as taken,
};
use crate::schemes::momentum::{moments, momentum_components};

type Tensor<const D: usize> = SMatrix<Traced, D, D>;

/// The columns of frozen rows.
pub(super) const SUPPORTS: [&str; 4] = ["support", "support_count", "supporting", "coefficients"];
pub(super) const DUALS: [&str; 4] = ["dual", "dual_count", "dual_neighbors", "dual_coefficients"];
pub(super) const FOLDS: [&str; 4] = ["fold", "fold_count", "folded", "fold_signs"];

/// What planes give to images, axis by axis, the lower one first.
pub(super) const DATA: [&str; 6] =
    ["lower_x", "upper_x", "lower_y", "upper_y", "lower_z", "upper_z"];

/// Numbers that a look over the state takes of a particle.
pub(super) const FIGURES: usize = 8;

/// What the passes depend on.
pub(super) struct Plan<const D: usize> {
    pub mixtures: Vec<Mixture<D>>,
    /// Moduli of the slowest and the fastest wave at rest of each mixture, Pa.
    pub moduli_at_rest: Vec<[f64; 2]>,
    pub is_stabilised: bool,
    /// Viscosity in Pa s, if stresses depend on rates, and whether a part of it is quadratic.
    pub viscosity: Option<f64>,
    pub is_quadratic: bool,
    pub damping: f64,
    /// Whether body forces pull.
    pub is_pulled: bool,
    pub has_images: bool,
    pub is_pressed: bool,
}

/// Rows of the pairs of gradients, and of forces, with N coefficients.
pub(super) type Supports<const D: usize, const N: usize> = Frozen<Each<Components<D>, N>>;
pub(super) type Duals<const D: usize, const N: usize> = Frozen<(Each<Components<D>, N>, One)>;

impl<const D: usize> Plan<D> {
    /// All passes of the plan.
    pub fn passes<const N: usize>(
        &self,
        dialect: Dialect,
        supports: &Supports<D, N>,
        duals: &Duals<D, N>,
        folds: &Frozen<Components<D>>,
    ) -> Vec<Pass> {
        let mut all = vec![
            self.kick_and_drift(dialect),
            solid::kick::<D>(dialect, "kick"),
            self.strains(dialect, supports),
            self.forces(dialect, duals),
            self.external(dialect),
            self.look(dialect),
            solid::show(dialect, &self.shown()),
            solid::give::<D>(dialect, "kick"),
            self.follow(dialect),
        ];
        if self.viscosity.is_some() {
            all.push(self.rates(dialect, "rates", supports, Order::Lanes));
        }
        if self.is_quadratic {
            all.push(self.rates(dialect, "rates_of_moment", supports, Order::Single));
        }
        if self.has_images {
            all.extend(["displacement", "velocity"].map(|field| self.carry(dialect, field)));
            all.push(self.fold(dialect, folds));
        }
        if self.terms() > 0 {
            all.push(self.powers(dialect));
        }
        all
    }

    /// Velocities change by accelerations, and places by the velocities.
    fn kick_and_drift(&self, dialect: Dialect) -> Pass {
        let reads = [own("displacement", D), own("velocity", D), own("kick", D)];
        let writes = [own("displacement", D), own("velocity", D)];
        local(dialect, "kick_and_drift", &["duration", "step"], &reads, &writes, |mut x| {
            let (duration, step) = (one(&mut x), one(&mut x));
            let displacement: Recorded<D> = take(&mut x);
            let (velocity, kick): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
            let velocity = velocity + kick * duration;
            (displacement + velocity * step).iter().chain(&velocity).copied().collect()
        })
    }

    /// Values of images, of those of the particles that they mirror and of data of planes.
    fn carry(&self, dialect: Dialect, field: &'static str) -> Pass {
        let name = if field == "velocity" { "carry_velocities" } else { "carry_displacements" };
        let reads =
            [through("image_source", field, D), own("image_sign", D), own("image_data", 2 * D)];
        let writes = [through("image_slot", field, D)];
        local(dialect, name, &DATA[..2 * D], &reads, &writes, |mut x| {
            let data: Vec<Traced> = (0..2 * D).map(|_| one(&mut x)).collect();
            let (source, sign): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
            let carried = |i: usize| x[2 * i] * data[2 * i] + x[2 * i + 1] * data[2 * i + 1];
            (0..D).map(|i| sign[i] * source[i] + carried(i)).collect()
        })
    }

    /// What acts on images acts on the particles that they mirror.
    fn fold(&self, dialect: Dialect, folds: &Frozen<Components<D>>) -> Pass {
        let force = [own("force", D)];
        Gather::<Components<D>, _>::new(dialect, "fold_forces", folds, Among::All, Order::Fold)
            .start(&force, |mut x| take(&mut x))
            .fold(&[], &force, Among::All, |meeting, sums| {
                for i in 0..D {
                    sums[i] += meeting.pair.0[i] * meeting.other[i];
                }
            })
            .close(&[], &[], &force, |sums, _| sums.iter().copied().collect())
    }

    /// Rates of displacement gradients. A look sums them one after the other.
    fn rates<const N: usize>(
        &self,
        dialect: Dialect,
        name: &'static str,
        supports: &Supports<D, N>,
        order: Order,
    ) -> Pass {
        let velocity = [difference("velocity", D)];
        Gather::<Each<Square<D>, N>, _>::new(dialect, name, supports, Among::All, order)
            .term(&Gradients::<D, N>, &velocity, Among::All)
            .close(&[], &[], &[own("gradient_rate", D * D)], |sums, _| entries(&sums[0]))
    }

    /// What is read of the viscosities of a particle.
    fn of_viscosity(&self) -> Vec<Use> {
        match self.viscosity {
            Some(_) => vec![own("viscous", 3), own("gradient_rate", D * D)],
            None => Vec::new(),
        }
    }

    /// The viscosities, what they are counted from, and the rate of the gradient.
    fn viscous(&self, x: &mut &[Traced]) -> Option<(Viscous<Traced>, Traced, Tensor<D>)> {
        let viscosity = self.viscosity?;
        let viscous = Viscous { viscosity, linear: one(x), quadratic: one(x) };
        Some((viscous, one(x), taken(x)))
    }

    /// What is read to tell mixtures apart.
    fn of_mixture(&self) -> Option<Use> {
        (self.mixtures.len() > 1).then_some(own("mixture", 1))
    }

    /// What the mixture of a particle makes of something.
    fn by_mixture<const K: usize>(
        &self,
        x: &mut &[Traced],
        of: impl Fn(usize) -> [Traced; K],
    ) -> [Traced; K] {
        let mixture = self.of_mixture().map(|_| one(x));
        by_kind(self.mixtures.len(), mixture, of)
    }

    /// Displacement gradients, and what forces gather.
    fn strains<const N: usize>(&self, dialect: Dialect, supports: &Supports<D, N>) -> Pass {
        let mut reads = vec![own("volume", 1)];
        reads.extend(self.of_viscosity());
        reads.extend(self.is_stabilised.then_some(own("hourglass", 1)));
        reads.extend(self.is_stabilised.then_some(own("shape", D * D)));
        reads.extend(self.of_mixture());
        let writes = [own("gradient", D * D), own("tension", N * D * D)];
        let displacement = [difference("displacement", D)];
        Gather::<Each<Square<D>, N>, _>::new(dialect, "strains", supports, Among::All, Order::Lanes)
            .term(&Gradients::<D, N>, &displacement, Among::All)
            .close(&[], &reads, &writes, |sums, mut x| {
                let (gradient, volume) = (sums[0], one(&mut x));
                let viscous = self.viscous(&mut x);
                let hourglass = self.is_stabilised.then(|| (one(&mut x), taken::<D>(&mut x)));
                // As rows of a fixed length, of which a tensor has at most three times three.
                let stress = self.by_mixture::<9>(&mut x, |number| {
                    let own = entries(&self.mixtures[number].held_stress(&gradient));
                    std::array::from_fn(|k| own.get(k).copied().unwrap_or(Traced::from(0.0)))
                });
                let mut stress = Tensor::<D>::from_row_slice(&stress[..D * D]);
                if let Some((viscous, _, rate)) = viscous {
                    stress += viscous.stress(&gradient, &rate);
                }
                let tension = stress * volume;
                let mut plain = [Tensor::<D>::zeros(); N];
                plain[0] = tension;
                let derivatives = match hourglass {
                    None => plain,
                    Some((coefficient, shape)) => {
                        let stiffness = coefficient * 2.0;
                        let all = stabilised(sums, tension, &shape, stiffness);
                        let has_none = stiffness.abs().at_most(Traced::from(0.0));
                        let pick =
                            |n: usize, k: usize| Traced::select(has_none, plain[n][k], all[n][k]);
                        std::array::from_fn(|n| Tensor::<D>::from_fn(|i, j| pick(n, i + D * j)))
                    }
                };
                entries(&gradient).into_iter().chain(derivatives.iter().flat_map(entries)).collect()
            })
    }

    /// Internal forces on particles, and behind them on images.
    fn forces<const N: usize>(&self, dialect: Dialect, duals: &Duals<D, N>) -> Pass {
        let sides = [own("tension", N * D * D), difference("displacement", D)];
        let reads = [own("tension", N * D * D), own("own_coefficients", N * D)];
        Gather::<Components<D>, _>::new(dialect, "forces", duals, Among::All, Order::Lanes)
            .term(&Forces::<D, N>, &sides, Among::All)
            .close(&[], &reads, &[own("force", D)], |sums, mut x| {
                let tension: [Tensor<D>; N] = std::array::from_fn(|_| taken(&mut x));
                let mut force = *sums;
                for tension in &tension {
                    force += tension * take::<D>(&mut x);
                }
                force.iter().copied().collect()
            })
    }

    /// What is read of body forces.
    fn of_pull(&self) -> Option<Use> {
        self.is_pulled.then_some(own("gravity", D))
    }

    fn pull(&self, x: &mut &[Traced]) -> Recorded<D> {
        if self.is_pulled { take(x) } else { Recorded::zeros() }
    }

    /// Accelerations by forces between particles, by body forces and by damping.
    fn external(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![own("force", D), own("mass", 1), own("velocity", D)];
        reads.extend(self.of_pull());
        local(dialect, "external", &[], &reads, &[own("kick", D)], |mut x| {
            let (force, mass): (Recorded<D>, _) = (take(&mut x), one(&mut x));
            let velocity: Recorded<D> = take(&mut x);
            let pull = self.pull(&mut x);
            let damped = velocity * Traced::from(self.damping);
            (force / mass + pull - damped).iter().copied().collect()
        })
    }

    /// What the processor is shown of a particle on which something acts.
    pub fn shown(&self) -> Vec<(&'static str, usize)> {
        let gradient = self.is_pressed.then_some(("gradient", D * D));
        [("kick", D)].into_iter().chain(gradient).collect()
    }

    /// Displacements and velocities of the particles on which something acts, some of which are prescribed.
    fn follow(&self, dialect: Dialect) -> Pass {
        let reads = [own("moved", 2 * D)];
        let writes = [through("listed", "displacement", D), through("listed", "velocity", D)];
        local(dialect, "follow", &[], &reads, &writes, |x| x.to_vec())
    }

    /// How many sums there are of powers: of body forces and of damping power, growth and force; the power of viscosity;
    /// of what bodies beyond planes do power and force.
    pub fn terms(&self) -> usize {
        let components = momentum_components(D).len();
        let driven = usize::from(self.is_pulled) + usize::from(self.damping > 0.0);
        driven * (2 + components)
            + usize::from(self.viscosity.is_some())
            + usize::from(self.has_images) * (1 + components)
    }

    /// What all particles have in the ledger.
    fn powers(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            own("reference", D),
            own("displacement", D),
            own("velocity", D),
            own("mass", 1),
            own("kick", D),
            own("force", D),
        ];
        reads.extend(self.of_pull());
        if self.viscosity.is_some() {
            reads.extend(self.of_viscosity());
            reads.extend([own("gradient", D * D), own("volume", 1)]);
        }
        let writes = [spread("terms", self.terms())];
        local(dialect, "powers", &[], &reads, &writes, |mut x| {
            let (reference, displacement): (Recorded<D>, Recorded<D>) =
                (take(&mut x), take(&mut x));
            let (velocity, mass): (Recorded<D>, _) = (take(&mut x), one(&mut x));
            let (kick, internal): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
            let pull = self.pull(&mut x);
            let position = reference + displacement;
            let mut terms = Vec::new();
            let mut drive = |force: &Recorded<D>, growth: Option<Traced>| {
                let (all, count) = moments(&position, force);
                terms.push(force.dot(&velocity));
                terms.extend(growth);
                terms.extend_from_slice(&all[..count]);
            };
            if self.is_pulled {
                drive(&(pull * mass), Some(mass * pull.dot(&kick)));
            }
            if self.damping > 0.0 {
                drive(&(velocity * (mass * -self.damping)), Some(mass * velocity.dot(&kick)));
            }
            if self.has_images {
                drive(&internal, None);
            }
            if let Some((viscous, _, rate)) = self.viscous(&mut x) {
                let gradient: Tensor<D> = taken(&mut x);
                terms.push(-(viscous.stress(&gradient, &rate).dot(&rate) * one(&mut x)));
            }
            terms
        })
    }

    /// What a look takes of a particle: whether something is not finite; the square of the speed, the speed of waves and
    /// the negative volume ratio, and that nothing has two ratios; stiffening, thickening and softening.
    fn look(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            own("displacement", D),
            own("velocity", D),
            own("kick", D),
            own("gradient", D * D),
        ];
        reads.extend(self.of_viscosity());
        reads.extend(self.of_mixture());
        let writes = [spread("terms", FIGURES)];
        local(dialect, "look", &[], &reads, &writes, |mut x| {
            let is_finite = are_finite(&x[..3 * D]);
            let _: Recorded<D> = take(&mut x);
            let velocity: Recorded<D> = take(&mut x);
            let _: Recorded<D> = take(&mut x);
            let gradient: Tensor<D> = taken(&mut x);
            let zero = Traced::from(0.0);
            let thickening = match self.viscous(&mut x) {
                Some((viscous, reference, rate)) => {
                    viscous.of_waves(&gradient, self.is_quadratic.then_some(&rate)) / reference
                }
                None => zero,
            };
            let [wave_speed, stiffening, softening] = self.by_mixture(&mut x, |number| {
                let (mixture, at_rest) = (&self.mixtures[number], self.moduli_at_rest[number]);
                let [slowest, fastest] = match mixture.is_linear() {
                    true => at_rest.map(Traced::from),
                    false => mixture.held_wave_moduli(&gradient),
                };
                let positive = Traced::select(fastest.above(0.0), fastest, zero);
                let of_waves = (positive / mixture.density()).sqrt();
                [of_waves, fastest / at_rest[1], -slowest / at_rest[0]]
            });
            let ratio = tensor::determinant(&(gradient + Tensor::<D>::identity()));
            let least = Traced::from(f64::NEG_INFINITY);
            // What is not a number is not seen.
            let seen =
                |value: Traced| Traced::select(is_finite & value.at_most(value), value, least);
            let broken = Traced::select(is_finite, least, Traced::from(1.0));
            let figures =
                [square(&velocity), wave_speed, -ratio, zero, stiffening, thickening, softening];
            [broken].into_iter().chain(figures.map(seen)).collect()
        })
    }
}
