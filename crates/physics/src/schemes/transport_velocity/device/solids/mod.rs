//! Hypoelastic solids on a device.

mod passes;

use piola_device::{DeviceError, Dialect, Machine, Pass, own, through};
use piola_formulas::pairs::solid::{ForceConstants, MATTER, RateConstants};

use self::passes::{rate_width, tension_width};
use super::super::inspect::step_limits;
use super::super::solids::{Counted, Stress, hold};
use super::super::stages::Pass as Stage;
use super::super::{Common, Hypoelastic, Solid, TransportVelocity};
use super::passes::{Plan, WALL};
use super::{OfMatter, STATE};
use crate::parallel::Team;
use crate::schemes::device::{Listed, Room, sighted, solid};
use crate::schemes::ledger::Total;
use crate::schemes::look::Most;
use crate::schemes::{DeviceRefusal, Health, StepLimit};

/// Numbers that a look over the state takes of a particle.
const FIGURES: usize = 8;

/// Most materials whose laws stand in one pass.
const MOST_MATERIALS: usize = 16;

/// Columns of the material state, with their numbers.
const MATERIAL: [(&str, usize); 4] =
    [("deviatoric_stress", 6), ("plastic_strain", 1), ("temperature", 1), ("internal_energy", 1)];

/// What the passes of hypoelastic solids depend on.
pub(in super::super) struct SolidPlan<const D: usize> {
    plan: Plan<D>,
    /// The materials that differ, and which of them each body has; walls have any.
    materials: Vec<Solid>,
    material_of: Vec<usize>,
    /// Whether pressures follow from densities.
    is_algebraic: bool,
    /// Whether gradients are corrected.
    corrects: bool,
    rate_constants: RateConstants,
    counted: Counted,
    rate_kind: (u8, bool),
    force_constants: ForceConstants,
    force_kind: (bool, u8),
    /// Rows of the particles that move as prescribed.
    held: Listed<D>,
}

impl<const D: usize> OfMatter<D> for SolidPlan<D> {
    type Kind = Hypoelastic<D>;

    const STATE: &'static [[&'static str; 2]] = &{
        let [a, b, c, d, e, f] = STATE;
        [
            a,
            b,
            c,
            d,
            e,
            f,
            ["deviatoric_stress", "deviatoric_stress_before"],
            ["plastic_strain", "plastic_strain_before"],
            ["temperature", "temperature_before"],
            ["internal_energy", "internal_energy_before"],
        ]
    };
    const FIGURES: usize = FIGURES;

    fn of(system: &TransportVelocity<D, Hypoelastic<D>>) -> Result<Self, DeviceRefusal> {
        let (common, matter) = (&system.common, &system.matter);
        // Those of walls are not asked for.
        let mut is_solid = vec![false; matter.materials().len()];
        for (body, is_wall) in common.particles.body.iter().zip(&common.is_wall) {
            is_solid[*body as usize] |= !is_wall;
        }
        let mut materials: Vec<Solid> = Vec::new();
        let mut find = |(solid, is_solid): (&Solid, bool)| {
            let known = materials.iter().position(|known| known == solid || !is_solid);
            known.unwrap_or_else(|| {
                materials.extend(is_solid.then_some(*solid));
                materials.len().saturating_sub(1)
            })
        };
        let material_of = matter.materials().iter().zip(is_solid).map(&mut find).collect();
        if materials.len() > MOST_MATERIALS {
            return Err(DeviceRefusal::Stage {
                what: "a case with more than 16 different materials of solids".into(),
                instead: "let some bodies share a material",
            });
        }
        let mut plan = system.device_plan()?;
        let of = |name, width| through("numbers", name, width);
        plan.copied = MATERIAL.iter().map(|(name, width)| of(name, *width)).collect();
        plan.copied.push(of("bulk", 2));
        plan.copies = vec![own("matter", MATTER), own("waves", 2)];
        if plan.are_several {
            plan.copied.push(of("label", 1));
            plan.copies.push(own("continuum", 1));
        }
        if plan.farthest.is_some() {
            plan.copied.push(of("begin", D));
            plan.copies.push(own("start", D));
        }
        let (rate_constants, counted, rate_kind) = matter.rate_law(common);
        let (force_constants, force_kind) = matter.force_law(common);
        Ok(Self {
            plan,
            materials,
            material_of,
            is_algebraic: common.settings.is_algebraic(),
            corrects: matter.corrects(),
            rate_constants,
            counted,
            rate_kind,
            force_constants,
            force_kind,
            held: Listed::new(&[], &[], matter.held(), [], |number| common.mass[number]),
        })
    }

    fn plan(&self) -> &Plan<D> {
        &self.plan
    }

    fn room(&self, system: &TransportVelocity<D, Hypoelastic<D>>) -> Room {
        let (common, rows) = (&system.common, self.held.len());
        let count = common.particles.len();
        let mut scratch = vec![
            ("matter", MATTER * count),
            ("waves", 2 * count),
            ("rate", rate_width(D) * count),
            ("tension", tension_width(D) * count),
        ];
        if self.corrects {
            scratch.push(("correction", D * D * count));
        }
        let bodies = || common.particles.body.iter().map(|body| *body as usize);
        let waves = |body: usize| {
            let solid = &system.matter.materials()[body];
            [solid.state.wave_speed, solid.bulk_modulus()]
        };
        let mut filled = vec![("bulk", bodies().flat_map(waves).collect())];
        if self.materials.len() > 1 {
            let number = |body: usize| self.material_of[body] as f64;
            filled.push(("material", bodies().map(number).collect()));
        }
        if self.plan.are_several {
            filled.push(("label", self.labels(common)));
        }
        if self.plan.farthest.is_some() {
            let begin = common.particles.position.iter();
            filled.push(("begin", begin.flat_map(|place| place.iter().copied()).collect()));
        }
        if rows > 0 {
            scratch.extend([("shown", 2 * D * rows), ("given", D * rows)]);
            let mut held = vec![0.0; D * count];
            for entry in system.matter.held().iter() {
                held[D * entry.particle + entry.component] = 1.0;
            }
            filled.push(("held", held));
        }
        Room { scratch, filled }
    }

    fn indices(&self) -> Option<(&'static str, &[u32])> {
        (self.held.len() > 0).then_some(("listed", &*self.held.particles))
    }

    fn passes(&self, dialect: Dialect) -> Vec<Pass> {
        let plan = &self.plan;
        let space = &plan.space();
        let mut all = plan.passes::<Self::Kind>(dialect, space);
        all.extend([
            self.state(dialect),
            self.rates(dialect, space),
            self.advance(dialect),
            self.tension(dialect),
            self.forces(dialect, space),
            self.look(dialect),
        ]);
        if self.corrects {
            all.push(self.correct(dialect, space));
        }
        if plan.normals > 0 {
            all.extend([self.walls(dialect, space), self.reactions(dialect, space)]);
        }
        if self.held.len() > 0 {
            all.push(solid::show(dialect, &[("position", D), ("velocity", D)]));
            all.extend([solid::give::<D>(dialect, "velocity"), self.hold(dialect)]);
        }
        all
    }

    fn passes_of(&self, stage: Stage<Stress>) -> &'static [&'static str] {
        match stage {
            Stage::Prescribe => &["show", "take"],
            Stage::Own(Stress::Correct) => &["correct"],
            Stage::Own(Stress::Tension) => &["tension"],
            Stage::Own(Stress::Hold) => &["hold"],
            _ => self.plan.passes_of(stage),
        }
    }

    fn prescribe(
        &mut self,
        machine: &mut Machine,
        time: f64,
    ) -> Result<Option<Total>, DeviceError> {
        let held = &mut self.held;
        if held.len() == 0 {
            return Ok(None);
        }
        for (row, shown) in held.shown(machine, 2 * D)?.chunks_exact(2 * D).enumerate() {
            held.position[row].copy_from_slice(&shown[..D]);
            held.velocity[row].copy_from_slice(&shown[D..]);
        }
        let Listed { prescribed, position, velocity, mass, .. } = held;
        let matter = |row: usize| Some((row, mass[row]));
        let totals = hold(prescribed, time, matter, position, velocity);
        let total = Team::default().sum_in_order(totals);
        held.give(machine, &held.velocity)?;
        Ok(Some(total))
    }

    fn judge(
        &self,
        machine: &mut Machine,
        count: usize,
        limits: &mut Vec<StepLimit>,
    ) -> Result<Health, DeviceError> {
        let all: [(f64, usize); FIGURES] = machine.largest(count)?;
        let (health, [signal, acceleration]) = sighted(&all, [0.0; 2]);
        let fastest = Most { value: health.largest_speed, particle: health.largest_speed_particle };
        step_limits(self.plan.smoothing_length, 0.0, [signal, fastest, acceleration], limits);
        let escaped = all[FIGURES - 1];
        Ok(Health { first_escaped: (escaped.0 > 0.0).then_some(escaped.1), ..health })
    }
}

impl<const D: usize> SolidPlan<D> {
    /// The continuum of each particle.
    fn labels(&self, common: &Common<D>) -> Vec<f64> {
        let both = common.particles.body.iter().zip(&common.is_wall);
        both.map(|(body, is_wall)| if *is_wall { WALL } else { f64::from(*body) }).collect()
    }
}
