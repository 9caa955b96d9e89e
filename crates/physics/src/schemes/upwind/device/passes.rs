//! The passes of an evaluation, and of a stage of a Runge-Kutta method, as text.

use nalgebra::SMatrix;
use piola_device::{
    Among, Dialect, Frozen, Gather, Order, Pass, Traced, Use, local, own, spread, through,
};
use piola_formulas::pairs::AreaPair;
use piola_formulas::pairs::upwind::{
    Exchange, ExchangeSum, Reconstructed, Side, Slope, Slopes, UpwindSide, UpwindSlope,
};
use piola_formulas::pairs::{Periods, Record};
use piola_formulas::volumetric::{Prestressed, VolumetricLaw};
use piola_formulas::{Number, riemann, tensor};

use super::super::local::{Constants, Unknowns, side};
use super::super::pairs::{Body, rates};
use super::super::reconstruction::solved;
use super::super::{Settings, WaveSpeed};
use crate::Vector;
use crate::schemes::blend::BlendStage;
use crate::schemes::device::solid;
use crate::schemes::device::{Recorded, are_finite, entries, one, square, take, tensor as taken};
use crate::schemes::momentum::{moments, momentum_components};

type Tensor<const D: usize> = SMatrix<Traced, D, D>;

/// The columns of pairs.
pub(super) const PAIRS: [&str; 4] = ["pairs", "pair_count", "pair_neighbors", "areas"];

/// The columns of the state: name, copy, rate, and numbers of a particle.
pub(super) const fn state<const D: usize>() -> [([&'static str; 3], usize); 4] {
    [
        (["position", "position_before", "position_rate"], D),
        (["velocity", "velocity_before", "velocity_rate"], D),
        (["volume_ratio", "volume_ratio_before", "volume_ratio_rate"], 1),
        (
            ["deformation_gradient", "deformation_gradient_before", "deformation_gradient_rate"],
            D * D,
        ),
    ]
}

/// Numbers that a look over the state takes of a particle.
pub(super) const FIGURES: usize = 8;

/// What the processor is shown of a particle on which something acts.
pub(super) const fn shown<const D: usize>() -> [(&'static str, usize); 3] {
    [("velocity_rate", D), ("position", D), ("velocity", D)]
}

/// The sums of an evaluation: power and force of body forces, and the powers of both dissipations.
pub(super) fn terms(dimension: usize) -> usize {
    3 + momentum_components(dimension).len()
}

/// How a step is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// By a Runge-Kutta method of these stages.
    RungeKutta(&'static [BlendStage]),
    /// By kicks and drifts, where nothing dissipates.
    Kicks,
}

/// What the passes depend on.
pub(super) struct Plan<const D: usize> {
    pub settings: Settings,
    pub periods: Periods<D>,
    /// The law of each body.
    pub laws: Vec<VolumetricLaw>,
    /// Whether body forces pull.
    pub is_pulled: bool,
    /// How a step is made.
    pub method: Method,
    /// Where places are counted from in what neighbours see, in single precision: of places only differences are taken.
    pub origin: Option<Vector<D>>,
}

/// A tensor of numbers that stand as those of a state do, column by column.
fn by_columns<const D: usize>(numbers: &mut &[Traced]) -> Tensor<D> {
    taken::<D>(numbers).transpose()
}

/// A record from the front of some numbers.
fn record<R: Record>(numbers: &mut &[Traced]) -> R::Of<Traced> {
    let (own, rest) = numbers.split_at(R::NUMBERS);
    *numbers = rest;
    piola_device::filled::<R>(own)
}

impl<const D: usize> Plan<D> {
    /// All passes of the plan.
    pub fn passes(&self, dialect: Dialect, pairs: &Frozen<AreaPair<D>>) -> Vec<Pass> {
        let mut all = vec![
            self.sides(dialect),
            self.pairs(dialect, pairs),
            solid::show(dialect, &shown::<D>()),
            solid::give::<D>(dialect, "velocity_rate"),
            self.impose(dialect),
            self.look(dialect),
        ];
        if self.settings.reconstruction {
            all.push(self.slopes(dialect, pairs));
        }
        match self.method {
            Method::RungeKutta(stages) => {
                let blends = stages.iter().map(|stage| self.advance(dialect, *stage));
                all.extend(blends);
            }
            Method::Kicks => {
                all.extend([solid::kick::<D>(dialect, "velocity_rate"), self.drift(dialect)])
            }
        }
        all
    }

    /// What is read to tell bodies apart.
    fn of_body(&self) -> Option<Use> {
        (self.laws.len() > 1).then_some(own("body", 1))
    }

    /// What the law of a particle makes of something.
    fn by_law(&self, body: Option<Traced>, of: impl Fn(VolumetricLaw) -> Traced) -> Traced {
        let first = of(self.laws[0]);
        let Some(body) = body else { return first };
        (1..self.laws.len()).fold(first, |before, number| {
            Traced::select(body.above(number as f64 - 0.5), of(self.laws[number]), before)
        })
    }

    /// What each particle shows its neighbours.
    fn sides(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            own("position", D),
            own("velocity", D),
            own("volume_ratio", 1),
            own("deformation_gradient", D * D),
            own("reference", D),
            own("density", 1),
            own("wave_speed", 1),
            own("prestress", 1),
        ];
        reads.extend(self.of_body());
        let writes = [own("side", UpwindSide::<D>::NUMBERS)];
        local(dialect, "sides", &[], &reads, &writes, |mut x| {
            let (position, velocity) = (take(&mut x), take(&mut x));
            let (ratio, deformation) = (one(&mut x), by_columns(&mut x));
            let unknowns = Unknowns { velocity, ratio, position, deformation };
            let place: Recorded<D> = take(&mut x);
            let constants = Constants { place, density: one(&mut x), wave_speed: one(&mut x) };
            let prestress = one(&mut x);
            let pressure = self.by_law(x.first().copied(), |law| {
                Prestressed { law, reference_ratio: prestress }.pressure_at(ratio)
            });
            let mut side = side(self.settings.wave_speed, constants, pressure, &unknowns);
            if let Some(origin) = self.origin {
                let origin = origin.map(Traced::from);
                side.position -= origin;
                side.reference -= origin;
            }
            piola_device::flat::<UpwindSide<D>>(&side)
        })
    }

    /// Slopes for the reconstruction.
    fn slopes(&self, dialect: Dialect, pairs: &Frozen<AreaPair<D>>) -> Pass {
        let sides = [own("side", UpwindSide::<D>::NUMBERS)];
        let writes = [own("slope", UpwindSlope::<D>::NUMBERS)];
        Gather::<UpwindSlope<D>, _>::new(dialect, "slopes", pairs, Among::All, Order::Lanes)
            .term(&Slopes(self.periods), &sides, Among::All)
            .close(&[], &[own("inverse", D * D)], &writes, |moments, mut x| {
                let inverse: Tensor<D> = taken(&mut x);
                let slope: Slope<Traced, D> = solved(moments, &inverse);
                piola_device::flat::<UpwindSlope<D>>(&slope)
            })
    }

    /// Forces, rates of the deformation and dissipation.
    fn pairs(&self, dialect: Dialect, pairs: &Frozen<AreaPair<D>>) -> Pass {
        let gather =
            Gather::<ExchangeSum<D>, _>::new(dialect, "exchange", pairs, Among::All, Order::Lanes);
        let (side, slope) = (UpwindSide::<D>::NUMBERS, UpwindSlope::<D>::NUMBERS);
        let sides = [own("side", side)];
        let both = [own("side", side), own("slope", slope)];
        macro_rules! plain {
            ($velocity:literal, $pressure:literal) => {
                gather.term(&Exchange::<D, $velocity, $pressure>(self.periods), &sides, Among::All)
            };
        }
        macro_rules! reconstructed {
            ($velocity:literal, $pressure:literal) => {{
                let law = Exchange::<D, $velocity, $pressure>(self.periods);
                gather.term(&Reconstructed(law), &both, Among::All)
            }};
        }
        let settings = &self.settings;
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        let gather = match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => plain!(false, false),
            (true, false, false) => plain!(true, false),
            (false, true, false) => plain!(false, true),
            (true, true, false) => plain!(true, true),
            (true, false, true) => reconstructed!(true, false),
            (false, true, true) => reconstructed!(false, true),
            (true, true, true) => reconstructed!(true, true),
        };
        let mut reads = vec![
            own("side", side),
            own("position", D),
            own("velocity", D),
            own("volume", 1),
            own("mass", 1),
            own("diagonal", D),
        ];
        reads.extend(self.is_pulled.then_some(own("gravity", D)));
        let [[_, _, position], [_, _, velocity], [_, _, ratio], [_, _, deformation]] =
            state::<D>().map(|(names, _)| names);
        let writes = [
            own(position, D),
            own(velocity, D),
            own(ratio, 1),
            own(deformation, D * D),
            spread("terms", terms(D)),
        ];
        gather.close(&[], &reads, &writes, |sums, mut x| {
            let me: Side<Traced, D> = record::<UpwindSide<D>>(&mut x);
            // Sides may be in single precision.
            let me = Side { position: take(&mut x), velocity: take(&mut x), ..me };
            let (volume, mass) = (one(&mut x), one(&mut x));
            let diagonal = take(&mut x);
            let gravity = if self.is_pulled { take(&mut x) } else { Recorded::zeros() };
            let found = rates(settings, &me, sums, &Body { volume, mass, diagonal, gravity });
            let force: Recorded<D> = gravity * mass;
            let (all, count) = moments(&me.position, &force);
            let [by_velocity, by_pressure] = found.dissipation;
            let mut results: Vec<Traced> = me.velocity.iter().copied().collect();
            results.extend(&found.acceleration);
            results.push(found.volume_ratio);
            results.extend(entries(&found.deformation.transpose()));
            results.push(force.dot(&me.velocity));
            results.extend(&all[..count]);
            results.extend([by_velocity, -by_pressure]);
            results
        })
    }

    /// Components of velocities that are prescribed.
    fn impose(&self, dialect: Dialect) -> Pass {
        let writes = [through("component", "velocity", 1)];
        local(dialect, "impose", &[], &[own("value", 1)], &writes, |x| x.to_vec())
    }

    /// A stage of a Runge-Kutta method.
    fn advance(&self, dialect: Dialect, stage: BlendStage) -> Pass {
        let columns = state::<D>();
        let all =
            |which: usize| columns.iter().map(move |(names, width)| own(names[which], *width));
        let reads: Vec<Use> = all(1).chain(all(2)).chain(all(0)).collect();
        let writes: Vec<Use> = all(0).collect();
        let count: usize = columns.iter().map(|(_, width)| *width).sum();
        local(dialect, stage.name, &["step"], &reads, &writes, |x| {
            let (step, x) = (x[0], &x[1..]);
            let of = |k: usize| {
                let (old, rate, new) = (x[k], x[count + k], x[2 * count + k]);
                stage.blend.value(step, old, rate, new)
            };
            (0..count).map(of).collect()
        })
    }

    /// All the rest moves on, the volume ratio by the change of the determinant.
    fn drift(&self, dialect: Dialect) -> Pass {
        let reads = [
            own("position", D),
            own("position_rate", D),
            own("volume_ratio", 1),
            own("deformation_gradient", D * D),
            own("deformation_gradient_rate", D * D),
        ];
        let writes =
            [own("position", D), own("volume_ratio", 1), own("deformation_gradient", D * D)];
        local(dialect, "drift", &["step"], &reads, &writes, |mut x| {
            let step = one(&mut x);
            let (position, rate): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
            let (ratio, before): (_, Tensor<D>) = (one(&mut x), by_columns(&mut x));
            let after = before + by_columns::<D>(&mut x) * step;
            let change = tensor::determinant(&after) - tensor::determinant(&before);
            let mut all: Vec<Traced> = (position + rate * step).iter().copied().collect();
            all.push(ratio + change);
            all.extend(entries(&after.transpose()));
            all
        })
    }

    /// What a look takes of a particle: whether something is not finite; the square of the speed, the speed of waves, the
    /// negative volume ratio and the mismatch; the negative time of crossing, the speed of waves and that of the shock over
    /// the reference speed.
    fn look(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            own("position", D),
            own("velocity", D),
            own("volume_ratio", 1),
            own("deformation_gradient", D * D),
            own("density", 1),
            own("prestress", 1),
            own("nearest", 1),
        ];
        reads.extend(self.of_body());
        let writes = [spread("terms", FIGURES)];
        local(dialect, "look", &[], &reads, &writes, |mut x| {
            let is_finite = are_finite(&x[..2 * D + 1 + D * D]);
            let _: Recorded<D> = take(&mut x);
            let velocity: Recorded<D> = take(&mut x);
            let (evolved, gradient): (_, Tensor<D>) = (one(&mut x), by_columns(&mut x));
            let (density, prestress, nearest) = (one(&mut x), one(&mut x), one(&mut x));
            let determinant = tensor::determinant(&gradient);
            let ratio = Traced::select(determinant.less(evolved), determinant, evolved);
            let smallest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(&gradient));
            let tangent = self.by_law(x.first().copied(), |law| {
                Prestressed { law, reference_ratio: prestress }.tangent_at(evolved)
            });
            let acoustic = (tangent * density.recip()).sqrt();
            let wave_speed = riemann::referential_wave_speed(acoustic, determinant, smallest);
            let one = Traced::from(1.0);
            let shock = match self.settings.wave_speed {
                WaveSpeed::Constant => one,
                WaveSpeed::Stretch => one / smallest.sqrt(),
            };
            let (zero, least) = (Traced::from(0.0), Traced::from(f64::NEG_INFINITY));
            let (is_whole, is_something) = (ratio.above(0.0), |it: Traced| it.at_most(it));
            // What is not a number is not seen, and what has collapsed has no waves.
            let seen =
                |value: Traced| Traced::select(is_finite & is_something(value), value, least);
            let of_whole = |value, otherwise| Traced::select(is_whole, value, otherwise);
            let figures = [
                square(&velocity),
                of_whole(wave_speed, zero),
                -ratio,
                (evolved - determinant).abs(),
                of_whole(-nearest / wave_speed, least),
                of_whole(wave_speed, zero),
                of_whole(shock, one),
            ];
            let broken = Traced::select(is_finite, least, one);
            [broken].into_iter().chain(figures.map(seen)).collect()
        })
    }
}
