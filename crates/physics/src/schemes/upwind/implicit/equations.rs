//! The equations of an implicit step as Newton's method sees them.

use num_dual::Dual64;
use piola_formulas::pairs::upwind::Divergence;
use piola_formulas::tensor;
use piola_formulas::volumetric::VolumetricResponse;

use super::super::Upwind;
use super::Implicit;
use super::stage::{Fields, Stage};
use super::tangent::Response;
use crate::parallel::{Team, larger};
use crate::solve::{
    Equations, LinearError, LinearReport, Reduction, Tangent, Trial, gmres, most_steps,
};
use crate::{Tensor, Vector, parallel};

/// Steps of GMRES with the factors of an earlier state, above which the next iteration factorises
/// anew.
const MANY_STEPS: usize = 12;
/// Roundings of the largest term of a sum that its residual may have.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// The equations of one step in its unknowns: velocities in m/s, and, where they are unknowns,
/// volume ratios times the wave speed of the reference. The residual is in kg m/s.
pub struct StepEquations<'a, const D: usize> {
    pub(super) scheme: &'a Upwind<D>,
    pub(super) parts: &'a mut Implicit<D>,
}

impl<const D: usize> Implicit<D> {
    pub(super) fn stage<'a>(&'a self, scheme: &'a Upwind<D>) -> Stage<'a, D> {
        Stage {
            scheme,
            weight: self.weight,
            base: &self.base,
            keeps_ratio: self.settings.keeps_ratio,
        }
    }
}

impl<const D: usize> StepEquations<'_, D> {
    fn velocities(&self) -> usize {
        self.parts.solver.reduction().unknowns()
    }

    /// Fills all that follows from the unknowns x, unless that is what was done last.
    pub(super) fn evaluate(&mut self, x: &[f64]) {
        let scheme = self.scheme;
        let Implicit { solver, held, fields, base, weight, settings, evaluated, team, .. } =
            &mut *self.parts;
        if evaluated.as_ref().is_some_and(|known| known == x) {
            return;
        }
        let reduction = solver.reduction();
        let (velocities, ratios) = x.split_at(reduction.unknowns());
        reduction.expand(velocities, held, &mut fields.velocity);
        for (a, scaled) in ratios.iter().enumerate() {
            fields.ratio[a] = scaled / scheme.reference[a].wave_speed;
        }
        let keeps_ratio = settings.keeps_ratio;
        let own = team.share_of(scheme.particles.len());
        Stage { scheme, weight: *weight, base, keeps_ratio }.fill(fields, own);
        let known = evaluated.get_or_insert_default();
        known.clear();
        known.extend_from_slice(x);
    }

    /// The unknowns of velocities, with the volume ratios that follow from these.
    pub(super) fn start_at(&mut self, velocity: &[Vector<D>]) -> Vec<f64> {
        let (split, count) = (self.velocities(), self.scheme.particles.len());
        let keeps_ratio = self.parts.settings.keeps_ratio;
        let mut x = vec![0.0; split + if keeps_ratio { count } else { 0 }];
        self.parts.solver.reduction().collect(velocity, &mut x[..split]);
        if keeps_ratio {
            let mut held = vec![Vector::zeros(); count];
            let reduction = self.parts.solver.reduction();
            reduction.expand(&x[..split], &self.parts.held, &mut held);
            let stage = self.parts.stage(self.scheme);
            for a in 0..count {
                let gradient = stage.velocity_gradient(&held, a);
                let (unknowns, _) = stage.unknowns(a, &held[a], &gradient);
                x[split + a] = unknowns.ratio * self.scheme.reference[a].wave_speed;
            }
        }
        x
    }

    /// What the terms of the momentum at the state that was evaluated last amount to, with what is
    /// rounding: what residuals are measured against.
    pub(super) fn measure(&mut self) {
        let (scheme, parts) = (self.scheme, &*self.parts);
        let own = parts.team.share_of(scheme.particles.len());
        let [terms, rounding] = parts.team.sums::<[f64; 2]>(own.len(), |row, sums| {
            let a = own.start + row;
            let (mass, reference) = (scheme.mass(a), &scheme.reference[a]);
            let local = &parts.fields.locals[a];
            let force = parts.fields.exchanges[a].force + parts.outside[a];
            sums[0] += (parts.base[a].velocity * mass).norm_squared();
            sums[0] += (force * parts.weight).norm_squared();
            let modulus = reference.density * reference.wave_speed * reference.wave_speed;
            let pressure = modulus.max(local.side.pressure.abs());
            let largest = mass * reference.wave_speed + parts.weight * parts.area[a] * pressure;
            sums[1] += largest * largest;
        });
        self.parts.size =
            terms.sqrt() + ROUNDINGS * rounding.sqrt() / parts.settings.newton.tolerance;
    }

    /// The particle whose equations are met worst at the state that was evaluated last.
    pub(super) fn worst(&self) -> usize {
        let (parts, stage) = (&*self.parts, self.parts.stage(self.scheme));
        let reduction = parts.solver.reduction();
        let mut left = vec![Vector::zeros(); self.scheme.particles.len()];
        parts.team.fill(&mut left, |first, left| {
            for (offset, left) in left.iter_mut().enumerate() {
                let a = first + offset;
                *left = stage.left(&parts.fields, a, &parts.outside[a]).0;
            }
        });
        let size = |(a, left)| (a, (left - reduction.held_part(a, &left)).norm_squared());
        let sizes = left.into_iter().enumerate().map(size);
        sizes.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most }).0
    }

    /// The tangent `-dr/dx` at x times a direction, by dual numbers through the equations themselves.
    pub fn product(&mut self, x: &[f64], direction: &[f64], product: &mut [f64]) {
        self.evaluate(x);
        let mut dual = self.dual_fields();
        let (parts, stage) = (&*self.parts, self.parts.stage(self.scheme));
        let (fields, reduction) = (&parts.fields, parts.solver.reduction());
        let (outside, team) = (&parts.outside, &parts.team);
        apply(&stage, (fields, &mut dual), (reduction, team), outside, direction, product);
        self.parts.dual = Some(dual);
    }

    /// Room for dual numbers, which only products of that kind take.
    fn dual_fields(&mut self) -> Box<Fields<Dual64, D>> {
        let count = self.scheme.particles.len();
        self.parts.dual.take().unwrap_or_else(|| Box::new(Fields::new(count)))
    }

    /// That product by the blocks of the matrix: without the pressure dissipation, and for volume
    /// ratios that are no unknowns.
    ///
    /// # Errors
    /// Where the matrix cannot be factorised.
    pub fn assembled_product(
        &mut self,
        x: &[f64],
        direction: &[f64],
        product: &mut [f64],
    ) -> Result<(), LinearError> {
        self.linearise(0.0, x, false)?;
        let count = self.scheme.particles.len();
        let (mut full, mut image) = (vec![Vector::zeros(); count], vec![Vector::zeros(); count]);
        self.parts.solver.reduction().expand_free(direction, &mut full);
        self.parts.matrix.apply(&full, &mut image);
        self.parts.solver.reduction().restrict(&image, product);
        Ok(())
    }

    /// The unknowns that the step starts from.
    pub fn start(&self) -> Vec<f64> {
        self.parts.start.clone()
    }
}

/// The tangent times a direction at the state of the first of the fields; the second are scratch. Each of a team makes the
/// rows of its own particles.
fn apply<const D: usize>(
    stage: &Stage<'_, D>,
    (fields, dual): (&Fields<f64, D>, &mut Fields<Dual64, D>),
    (reduction, team): (&Reduction<D>, &Team),
    outside: &[Vector<D>],
    direction: &[f64],
    product: &mut [f64],
) {
    let (split, count) = (reduction.unknowns(), outside.len());
    let mut moved = vec![Vector::zeros(); count];
    reduction.expand_free(&direction[..split], &mut moved);
    for a in 0..count {
        dual.velocity[a] = fields.velocity[a].zip_map(&moved[a], Dual64::new);
        if stage.keeps_ratio {
            let speed = stage.scheme.reference[a].wave_speed;
            dual.ratio[a] = Dual64::new(fields.ratio[a], direction[split + a] / speed);
        }
    }
    stage.fill(dual, team.share_of(count));
    let dual = &*dual;
    team.fill(&mut moved, |first, moved| {
        for (offset, moved) in moved.iter_mut().enumerate() {
            let a = first + offset;
            *moved = stage.left(dual, a, &outside[a]).0.map(|entry| -entry.eps);
        }
    });
    reduction.restrict(&moved, &mut product[..split]);
    team.fill(&mut product[split..], |first, product| {
        for (offset, product) in product.iter_mut().enumerate() {
            let a = first + offset;
            let (_, ratio) = stage.left(dual, a, &outside[a]);
            *product = -ratio.eps * scale(stage, a);
        }
    });
}

/// What makes the equation of a volume ratio one of momentum, kg m/s.
fn scale<const D: usize>(stage: &Stage<'_, D>, a: usize) -> f64 {
    stage.scheme.mass(a) * stage.scheme.reference[a].wave_speed
}

/// Solves for velocities and volume ratios as if there were no pressure dissipation: with the volume
/// ratios eliminated what is left is the system in velocities, which `solve` solves, theory (57).
fn precondition<const D: usize>(
    stage: &Stage<'_, D>,
    fields: &Fields<f64, D>,
    responses: &[Response<D>],
    (reduction, team): (&Reduction<D>, &Team),
    right: &[f64],
    solution: &mut [f64],
    solve: impl FnOnce(&[f64], &mut [f64]),
) {
    let (split, count, scheme) = (reduction.unknowns(), responses.len(), stage.scheme);
    // Momentum that the change of the pressures by the ratios alone brings.
    let stress: Vec<Tensor<D>> = (0..count)
        .map(|a| {
            let ratio = right[split + a] / scale(stage, a);
            let stiffness = scheme.law(a).tangent(fields.locals[a].ratio);
            fields.locals[a].side.cofactor * (-stiffness * ratio)
        })
        .collect();
    let mut momentum: Vec<Vector<D>> = vec![Vector::zeros(); count];
    team.fill(&mut momentum, |first, momentum| {
        for (offset, momentum) in momentum.iter_mut().enumerate() {
            let a = first + offset;
            let own = stress[a] * scheme.areas.diagonal(a);
            *momentum = (own + stage.sum(&Divergence, a, |b| stress[b])) * stage.weight;
        }
    });
    let mut corrected = vec![0.0; split];
    reduction.restrict(&momentum, &mut corrected);
    corrected.iter_mut().zip(right).for_each(|(corrected, right)| *corrected += right);
    solve(&corrected, &mut solution[..split]);
    reduction.expand_free(&solution[..split], &mut momentum);
    team.fill(&mut solution[split..], |first, solution| {
        for (offset, solution) in solution.iter_mut().enumerate() {
            let a = first + offset;
            let gradient = stage.velocity_gradient(&momentum, a);
            let followed = responses[a].ratio.dot(&gradient) * scheme.reference[a].wave_speed;
            *solution = right[split + a] / scheme.mass(a) + followed;
        }
    });
}

impl<const D: usize> Equations for StepEquations<'_, D> {
    fn unknowns(&self) -> usize {
        self.parts.start.len()
    }

    #[inline(never)]
    fn trial(&mut self, _time: f64, x: &[f64]) -> Trial {
        self.evaluate(x);
        let parts = &*self.parts;
        let is_broken = |a: usize| {
            let local = &parts.fields.locals[a];
            let f = parts.base[a].deformation + local.gradient * parts.weight;
            !(local.ratio > 0.0 && local.ratio.is_finite() && tensor::determinant(&f) > 0.0)
        };
        let count = self.scheme.particles.len();
        let broken = parallel::sum(count, |a| f64::from(u8::from(is_broken(a))));
        let broken = if broken > 0.0 { (0..count).find(|&a| is_broken(a)) } else { None };
        Trial { potential: None, broken }
    }

    #[inline(never)]
    fn residual(&mut self, _time: f64, x: &[f64], residual: &mut [f64]) -> f64 {
        self.evaluate(x);
        let (scheme, split) = (self.scheme, self.velocities());
        let Implicit { solver, fields, base, weight, settings, outside, left, size, team, .. } =
            &mut *self.parts;
        let keeps_ratio = settings.keeps_ratio;
        let stage = Stage { scheme, weight: *weight, base, keeps_ratio };
        team.fill(left, |first, left| {
            for (offset, left) in left.iter_mut().enumerate() {
                let a = first + offset;
                *left = stage.left(fields, a, &outside[a]).0;
            }
        });
        solver.reduction().restrict(left, &mut residual[..split]);
        team.fill(&mut residual[split..], |first, residual| {
            for (offset, residual) in residual.iter_mut().enumerate() {
                let a = first + offset;
                *residual = stage.left(fields, a, &outside[a]).1 * scale(&stage, a);
            }
        });
        let norm = |part: &[f64]| parallel::sum(part.len(), |k| part[k] * part[k]).sqrt();
        let largest = larger(norm(&residual[..split]), norm(&residual[split..]));
        if largest == 0.0 { 0.0 } else { largest / *size }
    }

    #[inline(never)]
    fn linearise(&mut self, _time: f64, x: &[f64], _definite: bool) -> Result<(), LinearError> {
        self.evaluate(x);
        let scheme = self.scheme;
        let known = self.parts.steps_with_factors;
        let Implicit { solver, fields, base, weight, settings, matrix, responses, .. } =
            &mut *self.parts;
        let keeps_ratio = settings.keeps_ratio;
        let stage = Stage { scheme, weight: *weight, base, keeps_ratio };
        stage.fill_responses(fields, responses);
        matrix.fill(|a, add| stage.add_row(fields, responses, a, add));
        // Factors of an earlier iteration serve as long as GMRES gets on well with them.
        match known {
            Some(steps) if steps <= MANY_STEPS => Ok(()),
            _ => solver.load(matrix, false),
        }
    }

    #[inline(never)]
    fn solve(
        &mut self,
        right: &[f64],
        tolerance: f64,
        solution: &mut [f64],
    ) -> Result<LinearReport, LinearError> {
        let report = match self.parts.settings.keeps_ratio {
            true => self.solve_with_ratios(right, tolerance, solution)?,
            false => {
                let Implicit { solver, matrix, .. } = &mut *self.parts;
                solver.solve(matrix, right, tolerance, solution)?
            }
        };
        self.parts.steps_with_factors = Some(report.steps);
        self.parts.linear_steps += report.steps;
        Ok(report)
    }
}

impl<const D: usize> StepEquations<'_, D> {
    fn solve_with_ratios(
        &mut self,
        right: &[f64],
        tolerance: f64,
        solution: &mut [f64],
    ) -> Result<LinearReport, LinearError> {
        let mut dual = self.dual_fields();
        let reduction = self.parts.solver.reduction().clone();
        let Implicit { solver, base, weight, fields, responses, outside, team, .. } =
            &mut *self.parts;
        let shared = (&reduction, &*team);
        let stage = Stage { scheme: self.scheme, weight: *weight, base, keeps_ratio: true };
        let outcome = gmres(
            |direction, product| {
                apply(&stage, (fields, &mut dual), shared, outside, direction, product);
            },
            |right, solution| {
                precondition(&stage, fields, responses, shared, right, solution, |r, s| {
                    solver.precondition(r, s);
                });
            },
            right,
            tolerance,
            most_steps(right.len()),
        );
        self.parts.dual = Some(dual);
        let steps = outcome.accept(solution)?;
        Ok(LinearReport { steps, shift: 0.0, indefinite: false })
    }
}
