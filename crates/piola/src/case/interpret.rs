//! From checked tables to the typed case: names that refer to each other, values that must agree.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use piola_device::Precision;

use self::sweeps::run_traits;
use super::catalogue;
use super::decode::{AXES, Context};
use super::diagnostics::Problem;
use super::functions::{Arrays, Clouds, Functions, MARK};
use super::model::{
    Body, Case, Checkpoint, Domain, Level, PaperSetting, Parameter, Preset, Scheme, StepControl,
    Time, Variant,
};
use super::record::{Datum, Record};
use super::source::{Located, Place};
use super::suggest::suggestion;
use crate::output::{DIGITS, significant};
use crate::time::IntegratorKind;

mod bodies;
mod checks;
mod fields;
mod fluids;
mod interpolation;
mod members;
mod observers;
mod physics;
mod plastic;
mod solids;
mod sweeps;
mod systems;
mod time;
mod waves;

/// Which of the settings of a case file is read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a> {
    /// Name of the variant or of the member of a sweep, `None` for the base case.
    pub variant: Option<&'a str>,
    /// The setting whose overrides are applied.
    pub level: Level,
    /// Folder of the case file. `None` where the text is from elsewhere: files are not looked for.
    pub folder: Option<&'a Path>,
    /// Whether the case is not as its author wrote it, by overrides of the command line: what it says
    /// about the run may then be left out where it does not fit any more.
    pub is_changed: bool,
    /// Functions that the case may name. `None` in a record, which does not hold them: any name will do there, and
    /// nothing is run.
    pub functions: Option<&'a Functions>,
    /// Clouds of points that the case may name, as functions.
    pub clouds: Option<&'a Clouds>,
    /// Arrays of initial values that the case may name, as functions.
    pub arrays: Option<&'a Arrays>,
}

impl Setting<'_> {
    /// Whether it is the case itself.
    fn is_plain(&self) -> bool {
        self.variant.is_none() && self.level == Level::Case
    }
}

/// Reads the whole case. `None` where something is refused, which is reported in `context` then.
pub(super) fn case(
    record: &Record,
    context: &mut Context<'_>,
    setting: Setting<'_>,
) -> Option<Case> {
    let dimension = context.dimension?;
    let mut reader = Reader {
        context,
        dimension,
        setting,
        names: Names::default(),
        late: Late::default(),
        surfaces: Vec::new(),
        missing: HashSet::new(),
    };
    reader.collect_names(record);
    // Without a scheme nothing is known of what the rest of the case may say.
    let described = record.record("scheme")?;
    let scheme = reader.scheme(described);
    let is_solid = reader.names.current.is_solid;
    reader.names.current = systems::Known::of("", described.kind, is_solid, scheme.as_ref());
    let systems = reader.systems(record);
    if systems.iter().any(|(system, _)| system.record("scheme").is_none()) {
        return None;
    }
    let domain = reader.domain(record.record("domain"));
    let bodies = record.records("body").enumerate().map(|(number, body)| {
        let system = reader.names.system_of[number];
        // Of the bodies of an unknown system nothing else is said.
        (system.is_some() || !body.has("system")).then_some(())?;
        reader.enter(system);
        Some(Body { system, ..reader.body(body)? })
    });
    let bodies: Vec<_> = bodies.collect();
    reader.enter(None);
    let time = reader.clock(record);
    reader.names.is_static = time.as_ref().is_some_and(|time| {
        IntegratorKind::from_name(&time.integrator).is_some_and(IntegratorKind::is_static)
    });
    let end = time.as_ref().map(|time| *time.end);
    let systems: Vec<_> = (systems.into_iter().enumerate())
        .map(|(number, (record, scheme))| {
            reader.enter(Some(number));
            reader.system(record, scheme, time.as_ref())
        })
        .collect();
    let checkpoint = match record.record("checkpoint") {
        Some(record) => Reader::checkpoint(record),
        None => Some(Checkpoint::default()),
    };
    let loads = record.records("load").map(|load| {
        reader.enter_system_of(load);
        reader.load(load)
    });
    let loads: Vec<_> = loads.collect();
    let boundaries = record.records("boundary").map(|boundary| {
        reader.enter_system_of(boundary);
        reader.names_its_body(boundary, "boundary");
        reader.boundary(boundary)
    });
    let boundaries: Vec<_> = boundaries.collect();
    let bodies: Option<Vec<_>> = bodies.into_iter().collect();
    let boundaries: Option<Vec<_>> = boundaries.into_iter().collect();
    if let (Some(bodies), Some(boundaries)) = (&bodies, &boundaries) {
        reader.fits_system(bodies);
        let others = (0..reader.names.systems.len()).map(Some);
        for system in std::iter::once(None).chain(others) {
            reader.enter(system);
            reader.fits_scheme(bodies, boundaries, system);
        }
    }
    reader.enter(None);
    if let (Some(bodies), Some(scheme)) = (&bodies, &scheme) {
        reader.one_cloud(bodies, scheme);
    }
    let probes = record.records("probe").map(|probe| {
        reader.enter_system_of(probe);
        reader.names_its_body(probe, "probe");
        reader.probe(probe)
    });
    let probes: Vec<_> = probes.collect();
    reader.enter_all();
    let probes: Option<Vec<_>> = probes.into_iter().collect();
    if let (Some(probes), Some(time)) = (&probes, &time) {
        reader.tangents_exist(probes, time);
    }
    if let (Some(probes), Some(bodies)) = (&probes, &bodies) {
        reader.probes_suit(probes, bodies);
    }
    let output = reader.output(record, end);
    let pictures: Vec<_> =
        record.records("picture").map(|picture| reader.picture(picture, end)).collect();
    let known_probes = probes.as_deref().filter(|_| record.is_whole("probe"));
    let plots: Vec<_> =
        record.records("plot").map(|plot| reader.plot(plot, known_probes)).collect();
    let variants: Vec<_> = record.records("variant").map(|it| reader.variant(it)).collect();
    let sweeps: Vec<_> = record.records("sweep").map(|sweep| reader.sweep(sweep)).collect();
    let sweeps: Option<Vec<_>> = sweeps.into_iter().collect();
    reader.not_too_many_members(sweeps.as_deref().unwrap_or(&[]));
    let known = checks::Known { probes: known_probes, sweeps: sweeps.as_deref(), end };
    let checks: Vec<_> = record.records("check").map(|check| reader.check(check, known)).collect();
    let coarse = record.record("coarse").map(|coarse| strings(coarse, "set")).unwrap_or_default();
    let paper = record.record("paper").map(|paper| PaperSetting {
        set: strings(paper, "set"),
        is_long: paper.boolean("long").unwrap_or(false),
    });
    reader.say_what_is_late(end.unwrap_or_default());
    let parameters = reader.context.parameters.iter();
    Some(Case {
        id: record.text("id").map(|id| id.value),
        title: record.text("title")?.value,
        is_long: record.boolean("long")?,
        dimension,
        parameters: parameters
            .map(|(name, value)| Some(Parameter { name: name.clone(), value: (*value)? }))
            .collect::<Option<_>>()?,
        domain: domain?,
        bodies: bodies?,
        scheme: scheme?,
        systems: systems.into_iter().collect::<Option<_>>()?,
        time: time?,
        checkpoint: checkpoint?,
        device: (record.record("compute").and_then(|compute| compute.text("device")))
            .filter(|device| **device != "processor"),
        precision: reader.precision(record),
        ranks: (record.record("compute").and_then(|compute| compute.whole("ranks")))
            .filter(|ranks| **ranks > 1),
        loads: loads.into_iter().collect::<Option<_>>()?,
        boundaries: boundaries?,
        probes: probes?,
        output: output?,
        pictures: pictures.into_iter().collect::<Option<_>>()?,
        plots: plots.into_iter().collect::<Option<_>>()?,
        coarse,
        paper,
        variants: variants.into_iter().collect::<Option<_>>()?,
        sweeps: sweeps?,
        checks: checks.into_iter().collect::<Option<_>>()?,
        more_in_reserve: 0,
        variant: setting.variant.map(str::to_owned),
        level: setting.level,
        is_changed: setting.is_changed,
        remarks: context.remarks.clone(),
        as_run: String::new(),
        sources: context.sources.into(),
    })
}

/// Reads tables one after the other and reports what does not fit together.
struct Reader<'r, 'c> {
    context: &'r mut Context<'c>,
    dimension: usize,
    setting: Setting<'r>,
    names: Names,
    late: Late,
    /// Surfaces from files: the same one is read once.
    surfaces: Vec<super::model::Surface>,
    /// Files that are not there: of each it is said once.
    missing: HashSet<PathBuf>,
}

/// What a run is too short for.
#[derive(Default)]
struct Late {
    pictures: Vec<f64>,
    checks: Vec<f64>,
}

/// The names that other tables refer to.
#[derive(Default)]
struct Names {
    bodies: Vec<String>,
    variants: Vec<String>,
    /// The system that is being read, and the main one.
    current: systems::Known,
    main: systems::Known,
    /// The others, and to which of them each body belongs.
    systems: Vec<systems::Known>,
    system_of: Vec<Option<usize>>,
    is_static: bool,
}

impl Names {
    /// The formulation that is being read, with its matter.
    fn described(&self) -> catalogue::Described {
        self.current.described()
    }
}

impl Reader<'_, '_> {
    fn report(&mut self, problem: Problem) {
        self.context.report(problem);
    }

    fn refuse<T>(&mut self, problem: Problem) -> Option<T> {
        self.report(problem);
        None
    }

    /// Collects the names of bodies and variants, and checks the names of all named tables.
    fn collect_names(&mut self, record: &Record) {
        self.names.bodies = self.unique_names(record, "body", &[]);
        self.systems_of_bodies(record);
        let bodies = record.records("body").filter(|body| !body.has("system"));
        let materials = bodies.filter_map(|body| body.record("material"));
        self.names.current.is_solid =
            materials.into_iter().any(|material| material.kind == "hypoelastic");
        self.names.variants = self.unique_names(record, "variant", &["base"]);
        self.unique_names(record, "sweep", &[]);
        self.unique_names(record, "probe", &["energy", "momentum", "step", "run"]);
        self.unique_names(record, "boundary", &[]);
        self.unique_names(record, "plot", &[]);
    }

    fn unique_names(&mut self, record: &Record, key: &str, reserved: &[&str]) -> Vec<String> {
        let mut seen = HashSet::new();
        let mut names = Vec::new();
        for name in record.records(key).map(|table| table.text("name")) {
            let Some(Located { value: name, place }) = name else {
                names.push(String::new());
                continue;
            };
            let is_plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
            if !name.chars().all(is_plain) {
                let message = format!("the name `{name}` cannot be used in paths and columns");
                self.report(
                    Problem::new(place, message, "not a plain name")
                        .help("use letters, digits, `-` and `_` only"),
                );
            } else if reserved.contains(&name.as_str()) {
                let message = format!("the name `{name}` has a meaning already");
                self.report(Problem::new(place, message, "taken").help("choose another name"));
            } else if !seen.insert(name.clone()) {
                let message = format!("two tables `[[{key}]]` have the name `{name}`");
                self.report(Problem::new(place, message, "the second one"));
            }
            names.push(name);
        }
        names
    }

    /// The body that the key `body` names. Reports an unknown one.
    fn body_of(&mut self, record: &Record) -> Option<Located<usize>> {
        let name = record.text("body")?;
        let index = self.names.bodies.iter().position(|known| *known == name.value);
        if index.is_none() {
            let message = format!("there is no body `{}`", name.value);
            let help = suggestion(&name.value, self.names.bodies.iter().map(String::as_str));
            self.report(Problem::new(name.place, message, "unknown body").help(help));
        }
        Some(Located::new(index?, name.place))
    }

    /// A file, relative to the folder of the case file.
    fn file(&mut self, record: &Record, key: &str) -> Option<Located<PathBuf>> {
        let name = record.text(key)?;
        let Some(folder) = self.setting.folder else {
            return Some(name.map(PathBuf::from));
        };
        let path = folder.join(&name.value);
        if !path.is_file() {
            let message = format!("there is no file {}", path.display());
            if !self.missing.insert(path) {
                return None;
            }
            let problem = Problem::new(name.place, message, "not found");
            return self.refuse(problem.help("paths are relative to the folder of the case file"));
        }
        Some(Located::new(path, name.place))
    }

    /// Remarks on what lies after the end of the run.
    fn say_what_is_late(&mut self, end: f64) {
        let Late { pictures, checks } = std::mem::take(&mut self.late);
        let shown = |time: &f64| significant(*time, DIGITS);
        for (what, consequence, mut times) in [
            ("pictures", "they are left out", pictures),
            ("checks", "they cannot be evaluated", checks),
        ] {
            times.sort_by(f64::total_cmp);
            times.dedup();
            let Some(first) = times.first() else { continue };
            let times = match times.last().filter(|last| *last > first) {
                Some(last) => format!("from {} to {} s", shown(first), shown(last)),
                None => format!("at {} s", shown(first)),
            };
            let end = shown(&end);
            self.context
                .remarks
                .push(format!("the run ends at {end} s, before the {what} {times}: {consequence}"));
        }
    }

    fn domain(&mut self, record: Option<&Record>) -> Option<Domain> {
        let mut periodic = vec![None; self.dimension];
        let axes = record.map_or(&[][..], |record| record.axes("periodic"));
        for (axis, ends) in periodic.iter_mut().zip(axes) {
            let read = |item: &Located<Datum>| Some(Located::new(item.as_pair()?, item.place));
            *axis = ends.as_ref().and_then(read);
        }
        Some(Domain { periodic })
    }

    fn checkpoint(record: &Record) -> Option<Checkpoint> {
        let every_steps = record.whole("every_steps").map(|steps| steps.value);
        let every = record.number("every").map(|time| time.value);
        let every_wall = record.number("every_wall").map(|time| time.value);
        let by_wall = every_steps.is_none() && every.is_none();
        Some(Checkpoint {
            every_steps,
            every,
            every_wall: every_wall.or(Checkpoint::default().every_wall.filter(|_| by_wall)),
            keep: record.whole("keep")?.value,
            at_end: record.boolean("at_end")?,
        })
    }

    fn variant(&mut self, record: &Record) -> Option<Variant> {
        Some(Variant {
            name: record.text("name")?,
            title: record.text("title").map(|title| title.value),
            set: strings(record, "set"),
            coarse: strings(record, "coarse"),
            traits: run_traits(record)?,
        })
    }

    fn scheme(&mut self, record: &Record) -> Option<Located<Scheme>> {
        let scheme = match record.kind {
            "transport_velocity" => Scheme::TransportVelocity(self.transport_velocity(record)?),
            interpolation::NAME => Scheme::Interpolation(interpolation::settings(record)?),
            name => match Preset::from_name(name) {
                Some(preset) => Scheme::TotalLagrangian(self.total_lagrangian(record, preset)?),
                None => Scheme::Upwind(physics::upwind(record)?),
            },
        };
        Some(Located::new(scheme, record.place))
    }

    /// The precision of a device.
    fn precision(&mut self, record: &Record) -> Precision {
        let Some(compute) = record.record("compute") else { return Precision::Double };
        let name = |key: &str| compute.text(key).map(|text| text.value);
        let is_single = name("precision").is_some_and(|name| name == "single");
        if is_single && name("device").is_none_or(|name| name == "processor") {
            self.meaningless(
                compute,
                "precision",
                "without a `device`: the processor computes in double precision",
            );
        }
        if is_single { Precision::Single } else { Precision::Double }
    }

    /// Reports that a key has no meaning beside others, if it is there.
    fn meaningless(&mut self, record: &Record, key: &str, why: &str) {
        if let Some(place) = record.key_place(key) {
            let message = format!("`{key}` has no meaning {why}");
            self.report(Problem::new(place, message, "no meaning here").help("remove it"));
        }
    }
}

fn strings(record: &Record, key: &str) -> Vec<String> {
    record.texts(key).into_iter().map(|text| text.value).collect()
}

/// The place of the first of some keys that the file has.
fn first_place(record: &Record, keys: &[&str]) -> Place {
    keys.iter().find_map(|key| record.key_place(key)).unwrap_or(record.place)
}
