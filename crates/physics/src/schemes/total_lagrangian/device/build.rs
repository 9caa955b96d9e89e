//! From a solid to its passes and columns on a device, or what has none there.

use piola_device::{Device, Dialect, Language, Layout, Machine, Pass, Rows};

use super::super::fields::Made;
use super::super::{Discrete, FIGURES as BEHIND, LEDGER, Matrices, TotalLagrangian};
use super::OnDevice;
use super::listed::Followed;
use super::passes::{DUALS, FIGURES, FOLDS, Plan, SUPPORTS};
use crate::operators::{AdjointPairs, Columns, FrozenRows, ReferencePairs};
use crate::parallel::chunk;
use crate::schemes::device::{
    DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Gravity, Room, StateColumn,
    StateColumns, fits, solid, staged,
};

/// Most mixtures whose stresses stand in one pass.
const MOST_MIXTURES: usize = 16;

/// Columns that may be in single precision: rows, and what is computed of them. Neighbours read tensions.
const LAYOUT: Layout = Layout {
    narrow: &["coefficients", "dual_coefficients", "tension", "gradient", "gradient_rate"],
    planes: &["tension"],
};

/// Columns of the state with the names of their copies.
const STATE: [[&str; 2]; 3] = [
    ["displacement", "displacement_before"],
    ["velocity", "velocity_before"],
    ["kick", "kick_before"],
];

/// What the stages of a step start on a device.
const STAGES: [(&str, &[&str]); 8] = [
    ("drift", &["kick_and_drift", "follow"]),
    ("load", &["carry_displacements", "carry_velocities"]),
    ("rates_of_strain", &["rates"]),
    ("strains", &["strains"]),
    ("forces", &["forces", "fold_forces"]),
    ("external", &["external", "show", "take", "powers"]),
    ("kick", &["kick_velocities"]),
    ("look", &["rates_of_moment", "look"]),
];

impl<const D: usize> TotalLagrangian<D> {
    /// What has no steps on a device, with what a case has to be like instead.
    fn device_refusal(&self) -> Option<DeviceRefusal> {
        let mixtures = &self.solid.mixtures;
        let features = [
            (self.statics.is_some(), "a solid in statics or implicit steps", "take explicit steps"),
            (self.matrices.edges().is_some(), "the strong form", "choose `form = \"adjoint\"`"),
            (!self.rigid.is_empty(), "a rigid body", "leave it out"),
            (!self.loads.springs.is_empty(), "a spring", "leave it out"),
            (
                !mixtures.iter().all(|mixture| mixture.is_held()),
                "a material that is free across, as in plane stress,",
                "choose `plane = \"strain\"`",
            ),
            (
                mixtures.len() > MOST_MIXTURES,
                "a joint of bodies with more than 16 mixtures of materials",
                "do not join them",
            ),
        ];
        let found = features.into_iter().find(|(is_there, ..)| *is_there);
        found.map(|(_, what, instead)| DeviceRefusal::Stage { what: what.into(), instead })
    }

    /// The steps of the solid on a device.
    pub(in super::super) fn solid_to_device(
        &self,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        let (discrete, method) = (self.on_devices()?, method.unless_kicked()?);
        match &discrete.operator.pairs {
            ReferencePairs::Plain(pairs) => self.on((device, method), discrete, pairs),
            ReferencePairs::Consistent(pairs) => self.on((device, method), discrete, pairs),
        }
    }

    /// The gradients, if all of it has steps on a device.
    fn on_devices(&self) -> Result<&Discrete<D>, DeviceRefusal> {
        match (&self.matrices, self.device_refusal()) {
            (Matrices::Adjoint(discrete), None) => Ok(discrete),
            (_, Some(refusal)) => Err(refusal),
            _ => Err(DeviceRefusal::Formulation(self.description.name)),
        }
    }

    fn device_plan(&self, discrete: &Discrete<D>) -> Plan<D> {
        let (solid, dissipation) = (&self.solid, &self.dissipation);
        let is_viscous = dissipation.is_viscous();
        Plan {
            mixtures: solid.mixtures.clone(),
            moduli_at_rest: solid.moduli_at_rest.clone(),
            is_stabilised: (0..solid.len()).any(|a| discrete.operator.hourglass(a) != 0.0),
            viscosity: is_viscous.then_some(dissipation.viscosity),
            is_quadratic: dissipation.artificial_viscosity[1] > 0.0,
            damping: dissipation.damping,
            is_pulled: !self.loads.body_forces.is_empty(),
            has_images: self.has_images,
            is_pressed: !self.loads.pressed.is_empty(),
        }
    }

    /// The stages of its steps on a device.
    pub(in super::super) fn solid_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        let (discrete, method) = (self.on_devices()?, method.unless_kicked()?);
        let dialect = method.dialect(language, LAYOUT);
        let passes = match &discrete.operator.pairs {
            ReferencePairs::Plain(pairs) => self.passes(dialect, discrete, pairs),
            ReferencePairs::Consistent(pairs) => self.passes(dialect, discrete, pairs),
        };
        Ok(staged(&passes, &STAGES))
    }

    fn passes<const N: usize>(
        &self,
        dialect: Dialect,
        discrete: &Discrete<D>,
        pairs: &AdjointPairs<D, N>,
    ) -> Vec<Pass> {
        let (supports, _) = pairs.gradients.columns(SUPPORTS);
        let (duals, _) = pairs.forces.columns(DUALS);
        let folds = FrozenRows::new(std::iter::empty::<[_; 0]>());
        self.device_plan(discrete).passes(dialect, &supports, &duals, &folds.columns(FOLDS).0)
    }

    fn on<const N: usize>(
        &self,
        (device, method): (Device, DeviceMethod),
        discrete: &Discrete<D>,
        pairs: &AdjointPairs<D, N>,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        let (solid, operator) = (&*self.solid, &*discrete.operator);
        let (count, images) = (solid.len(), operator.all_images());
        let followed = Followed::new(self, &discrete.planes);
        let plan = self.device_plan(discrete);
        let mut mirrored = vec![Vec::new(); if images.is_empty() { 0 } else { count }];
        for (slot, image) in (count as u32..).zip(images) {
            mirrored[image.source as usize].push((slot, image.sign.into()));
        }
        let folds = FrozenRows::new(mirrored.into_iter());
        let (supports, of_supports) = pairs.gradients.columns(SUPPORTS);
        let (duals, of_duals) = pairs.forces.columns(DUALS);
        let (folds, of_folds) = folds.columns(FOLDS);
        let rows: [(&Rows, &Columns<'_>); 3] =
            [(&supports.rows, &of_supports), (&duals.rows, &of_duals), (&folds.rows, &of_folds)];
        let columns = StateColumn::all(Made::FIELDS, [D, count], &STATE);
        let room = Room {
            scratch: self.scratch::<N>(&plan, followed.listed.len()),
            filled: self.filled::<N>(&plan, discrete),
        };
        let of_rows = rows.iter().map(|(rows, columns)| (rows.numbers, columns.bytes()));
        // Displacements and velocities of images, with their copies.
        let beyond = ("images", 4 * images.len() * D * size_of::<f64>());
        let all = StateColumns::bytes(&columns).chain(room.bytes()).chain([beyond]);
        let layout = method.layout(LAYOUT);
        fits(&device, layout.narrow, all.chain(of_rows))?;
        let passes = |dialect| plan.passes(dialect, &supports, &duals, &folds);
        let mut machine = Machine::new(device, None, layout, passes, chunk(count))?;
        let tail = LEDGER.length(D) + BEHIND;
        let state = StateColumns::new(columns, tail);
        state.make(&mut machine, |name| if name == "kick" { 0 } else { images.len() * D })?;
        room.make(&mut machine)?;
        rows.iter().try_for_each(|(rows, columns)| columns.add(&mut machine, rows))?;
        machine.add_indices("listed", &followed.listed.particles)?;
        let sources: Vec<u32> = images.iter().map(|image| image.source).collect();
        let slots: Vec<u32> = (0..images.len()).map(|image| (count + image) as u32).collect();
        machine.add_indices("image_source", &sources)?;
        machine.add_indices("image_slot", &slots)?;
        Ok(Box::new(OnDevice {
            plan,
            machine,
            state,
            stages: self.stages.clone(),
            solid: self.solid.clone(),
            loads: self.loads.clone(),
            followed,
            images: images.to_vec(),
            stable: self.stable,
            gravity: Gravity::default(),
            is_evaluated: false,
            is_soft: false,
        }))
    }

    /// Columns of work with their lengths.
    fn scratch<const N: usize>(&self, plan: &Plan<D>, rows: usize) -> Vec<(&'static str, usize)> {
        let (count, slots) = (self.solid.len(), self.force.len());
        let mut all = vec![
            ("gradient", count * D * D),
            ("tension", slots * N * D * D),
            ("force", slots * D),
            ("terms", count * plan.terms().max(FIGURES)),
            ("shown", rows * solid::width(&plan.shown())),
            ("given", rows * D),
            ("moved", rows * 2 * D),
        ];
        if plan.viscosity.is_some() {
            all.push(("gradient_rate", count * D * D));
        }
        if plan.is_pulled {
            all.push(("gravity", count * D));
        }
        all
    }

    /// Columns that do not change.
    fn filled<const N: usize>(
        &self,
        plan: &Plan<D>,
        discrete: &Discrete<D>,
    ) -> Vec<(&'static str, Vec<f64>)> {
        let (solid, operator) = (&*self.solid, &*discrete.operator);
        let (count, particles) = (solid.len(), &solid.particles);
        let own = (0..self.force.len()).flat_map(|slot| {
            let all = operator.own_coefficients(slot);
            (0..N * D).map(move |k| all[k / D][k % D])
        });
        let place = particles.position.iter().flat_map(|place| place.iter().copied());
        let mut all: Vec<(&'static str, Vec<f64>)> = vec![
            ("mass", solid.mass.clone()),
            ("volume", particles.volume.clone()),
            ("own_coefficients", own.collect()),
            ("reference", place.collect()),
        ];
        if plan.mixtures.len() > 1 {
            all.push(("mixture", solid.mixture.iter().map(|&own| f64::from(own)).collect()));
        }
        if plan.is_stabilised {
            all.push(("hourglass", (0..count).map(|a| operator.hourglass(a)).collect()));
            let entries = |a: usize| (0..D * D).map(move |k| operator.shape(a)[(k / D, k % D)]);
            all.push(("shape", (0..count).flat_map(entries).collect()));
        }
        if plan.viscosity.is_some() {
            let of = |a: usize| {
                let own = self.dissipation.at(solid, a);
                [own.linear, own.quadratic, self.dissipation.reference(solid, a)]
            };
            all.push(("viscous", (0..count).flat_map(of).collect()));
        }
        if plan.has_images {
            let images = operator.all_images();
            all.push(("image_sign", images.iter().flat_map(|image| image.sign).collect()));
            let data = images.iter().flat_map(|image| image.data.as_flattened().to_vec());
            all.push(("image_data", data.collect()));
        }
        all
    }
}
