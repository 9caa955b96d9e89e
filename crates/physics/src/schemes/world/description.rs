//! What a run of several systems shows: what each of them does, together.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use crate::fields::{FieldDescription, FieldKind, Life};
use crate::schemes::{Accounts, SchemeDescription};

/// The mechanisms by which others work on a solid, and the ways by which momentum enters from there: the fluid, and
/// walls and solids that it touches.
pub(super) const SHARED: [&str; 2] = ["interface", "contact"];

/// The mechanism by which solids work on the fluid, and that of the fluid which has it with the work of all walls.
pub(super) const INTERFACE: &str = "interface";
pub(super) const WALLS: &str = "walls";

/// What walls and other solids do to a solid in a fluid where they touch, theory (85).
pub(super) const CONTACT: FieldDescription = FieldDescription {
    life: Life::Derived(1),
    ..FieldDescription::new(
        "contact_force",
        "N",
        FieldKind::Vector,
        "force of walls and other solids that a solid touches",
    )
};

/// The combinations that have been asked for. A description is a constant of the program elsewhere, and
/// there are as few of these as there are combinations in the cases that it reads.
static KNOWN: LazyLock<Mutex<BTreeMap<String, &'static SchemeDescription>>> =
    LazyLock::new(Mutex::default);

impl SchemeDescription {
    /// What a fluid shows with the solids in it, each by the name of its system. Names of energies, mechanisms
    /// and figures of solids have that of their system in front; fields of the same name are one. The fluid has the
    /// work of solids apart from that of walls, and all of them how many steps of their own were one of the run.
    pub fn with_solids(&'static self, solids: &[(String, &'static Self)]) -> &'static Self {
        let of = |scheme: &Self| format!("{}/{}", scheme.name, scheme.matter.unwrap_or_default());
        let mut key = of(self);
        solids.iter().for_each(|(name, solid)| key += &format!(" {name}:{}", of(solid)));
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known.entry(key).or_insert_with(|| Box::leak(Box::new(joined(self, solids))))
    }
}

fn joined(
    fluid: &SchemeDescription,
    solids: &[(String, &'static SchemeDescription)],
) -> SchemeDescription {
    let named = |system: &str, name: &str| -> &'static str {
        Box::leak(format!("{system}.{name}").into_boxed_str())
    };
    let mut fields: Vec<FieldDescription> = Vec::new();
    let all = std::iter::once(fluid).chain(solids.iter().map(|(_, solid)| *solid));
    for field in all.clone().flat_map(|system| system.fields) {
        let own = FieldDescription {
            life: match field.life {
                Life::Kept => Life::Kept,
                // It is a column of one system at most, and of none of all.
                _ => Life::Derived(field.stages()),
            },
            number: fields.len(),
            ..*field
        };
        match fields.iter_mut().find(|known| known.name == field.name) {
            Some(known) if known.stages() < own.stages() => known.life = own.life,
            Some(_) => (),
            None => fields.push(own),
        }
    }
    fields.push(FieldDescription { number: fields.len(), ..CONTACT });
    let join =
        |of: fn(&SchemeDescription) -> &[&'static str], shares: bool, own: &[&'static str]| {
            let mut names: Vec<&'static str> = [of(fluid), own].concat();
            for (system, solid) in solids {
                names.extend(of(solid).iter().map(|name| named(system, name)));
                names.extend(SHARED.iter().filter(|_| shares).map(|name| named(system, name)));
            }
            Box::leak(names.into_boxed_slice())
        };
    let mut figures: Vec<(&str, &str)> = fluid.figures.to_vec();
    figures.push(("fluid_steps", "1"));
    for (system, solid) in solids {
        figures.extend(solid.figures.iter().map(|(name, unit)| (named(system, name), *unit)));
        figures.push((named(system, "steps"), "1"));
    }
    SchemeDescription {
        name: "world",
        matter: None,
        offers: &[],
        fields: Box::leak(fields.into_boxed_slice()),
        energies: join(|system| system.energies, false, &[]),
        ledger: Accounts {
            mechanisms: join(|system| system.ledger.mechanisms, true, &[INTERFACE]),
            impulses: join(|system| system.ledger.impulses, true, &[]),
            is_kicked: false,
        },
        figures: Box::leak(figures.into_boxed_slice()),
    }
}
