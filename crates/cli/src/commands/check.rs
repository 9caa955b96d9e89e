//! `piola check`: what a run will do.

use piola::case::{BANDWIDTH, Case, LATENCY, Plan, PlannedRank, Undamped};
use piola::operators::Packing;
use piola::schemes::{Particle, Phase, Traffic};

use super::{assemble, read, use_threads};
use crate::arguments::{CheckArguments, StageForm};
use crate::exit::{Exit, Fault};
use crate::summary::own_steps;
use crate::text::{bytes, count, duration, large, significant};
use crate::{table, terminal};

/// Particles with bad support that are listed.
const LISTED: usize = 10;

/// Reads and builds a case and prints its plan.
pub fn check(arguments: &CheckArguments) -> Result<Exit, Fault> {
    use_threads(arguments.case.threads);
    let case = read(&arguments.case)?;
    let mut session = assemble(&arguments.case.file.case, &case)?;
    let text = match arguments.stages {
        Some(form) => {
            let evaluations = session.evaluations_in_step();
            stages(&session.scheme().phases(), evaluations, form)
        }
        None => plan_text(&case, &session.plan()),
    };
    terminal::print(&text)?;
    Ok(Exit::Success)
}

/// The stages of a step.
fn stages(phases: &[&Phase], evaluations: Option<u64>, form: StageForm) -> String {
    if phases.is_empty() {
        return "the scheme of this case does not list its stages\n".to_owned();
    }
    if form == StageForm::Dot {
        return phases.iter().map(|phase| phase.dot()).collect();
    }
    let header =
        ["part", "stage", "own", "neighbours", "memory", "reads", "gathers", "writes", "shows"];
    let mut rows: Vec<Vec<String>> = vec![header.map(str::to_owned).into()];
    let row = |names: [&str; 2], traffic: &Traffic, columns: [&[&str]; 4]| {
        let names = names.map(str::to_owned);
        let bytes = [traffic.own, traffic.gathered, traffic.least];
        let bytes = bytes.map(|bytes| bytes.round().to_string());
        names.into_iter().chain(bytes).chain(columns.map(grouped)).collect()
    };
    for phase in phases {
        for (number, ((stage, _), traffic)) in phase.stages.iter().zip(&phase.traffic).enumerate() {
            let name = if number == 0 { phase.name } else { "" };
            let columns = [stage.reads, stage.gathers, stage.writes, stage.shows];
            rows.push(row([name, stage.name], traffic, columns));
        }
    }
    if let Some(evaluations) = evaluations {
        let times = evaluations as f64 / phases[0].particles.max(1) as f64;
        let all = Traffic::sum(phases.iter().flat_map(|phase| &phase.traffic));
        let all = Traffic {
            own: times * all.own,
            gathered: times * all.gathered,
            least: times * all.least,
        };
        rows.push(row(["step", ""], &all, [&[]; 4]));
    }
    let lines = table::align(&rows, terminal::stdout_width(), &[5, 6, 8, 7]).join("\n");
    format!(
        "Bytes per particle: read and written of the particle itself, read of neighbours with their lists, and what \
         memory carries at least.\n\n{lines}\n"
    )
}

/// Names with what those before a point share written once: `side.(velocity density) rates`.
fn grouped(columns: &[&str]) -> String {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for column in columns {
        let (group, name) = column.split_once('.').unwrap_or(("", column));
        match groups.iter_mut().find(|(known, _)| *known == group) {
            Some((_, names)) => names.push(name),
            None => groups.push((group, vec![name])),
        }
    }
    let text = groups.iter().map(|(group, names)| match group.is_empty() {
        true => names.join(" "),
        false if names.len() == 1 => format!("{group}.{}", names[0]),
        false => format!("{group}.({})", names.join(" ")),
    });
    text.collect::<Vec<_>>().join(" ")
}

/// The plan of a case as `piola check` prints it.
pub fn plan_text(case: &Case, plan: &Plan) -> String {
    let rows: Vec<Vec<String>> = plan_rows(case, plan).into_iter().map(Vec::from).collect();
    format!("{}\n\n{}\n", heading(case), table::align(&rows, None, &[]).join("\n"))
}

/// The plan as lines of a name and what it says; the name is empty where a line belongs to the one above.
pub fn plan_rows(case: &Case, plan: &Plan) -> Vec<[String; 2]> {
    let mut rows: Vec<[String; 2]> = Vec::new();
    let mut section = |name: &str, lines: Vec<String>| {
        for (number, line) in lines.into_iter().enumerate() {
            let name = if number == 0 { name } else { "" };
            rows.push([name.to_owned(), line]);
        }
    };
    section("bodies", bodies(plan));
    let neighbors = &plan.neighbors;
    section(
        "neighbours",
        vec![format!(
            "{} on average, from {} to {}",
            significant(neighbors.mean, 3),
            neighbors.least,
            neighbors.most
        )],
    );
    section("support", support(&plan.poorly_supported));
    section("step limits", limits(plan));
    let first = significant(plan.step, 3);
    section("first step", vec![format!("{first} s ({})", plan.limiter)]);
    let end = significant(*case.time.end, 6);
    section(
        "steps",
        vec![format!("{} to t = {end} s, if all are as long as the first", plan.steps)],
    );
    if !plan.own_steps.is_empty() {
        section("own steps", vec![format!("{} in the first step", own_steps(&plan.own_steps))]);
    }
    section("undamped", plan.undamped.iter().map(undamped).collect());
    section(
        "wall time",
        vec![format!(
            "{} without output, at {} particle evaluations per second",
            duration(plan.seconds),
            large(plan.evaluations_per_second)
        )],
    );
    section("memory", vec![bytes(plan.memory)]);
    section("ranks", ranks(plan));
    section("output", plan.outputs.clone());
    section("note", plan.notes.clone());
    section("warning", plan.warnings.clone());
    rows
}

/// What each rank has, and what is to be expected of all.
fn ranks(plan: &Plan) -> Vec<String> {
    if plan.ranks.is_empty() {
        return Vec::new();
    }
    let cells = |(number, rank): (usize, &PlannedRank)| {
        let share = &rank.share;
        let partners = count(share.partners as u64, "rank");
        vec![
            format!("{number}:"),
            count(share.particles as u64, "particle"),
            format!("and copies of {} of {partners},", share.copies),
            format!("{} an evaluation,", bytes(share.bytes)),
            format!("{} a step,", bytes(rank.step_bytes)),
            format!("load {},", significant(share.load, 3)),
            format!("efficiency {}", significant(rank.efficiency, 3)),
        ]
    };
    let rows: Vec<Vec<String>> = plan.ranks.iter().enumerate().map(cells).collect();
    let mut lines = table::align(&rows, None, &[]);
    lines.push(format!(
        "efficiency {} of all, predicted for ranks with as many threads each as this one, {} us a message and {} GB/s; \
         that of a rank is the share of its own time in which it computes",
        significant(plan.efficiency, 3),
        LATENCY * 1e6,
        BANDWIDTH * 1e-9
    ));
    lines
}

fn heading(case: &Case) -> String {
    let id = case.id.as_ref().map(|id| format!("{id}: ")).unwrap_or_default();
    let variant = case.variant.as_ref().map(|name| format!(", variant {name}")).unwrap_or_default();
    format!("{id}{} ({}D{variant})", case.title, case.dimension)
}

fn bodies(plan: &Plan) -> Vec<String> {
    let unit = match plan.bodies.first().map(|body| body.spacing.len()) {
        Some(1) => "m",
        Some(2) => "m^2",
        _ => "m^3",
    };
    let rows: Vec<Vec<String>> = plan
        .bodies
        .iter()
        .map(|body| {
            let spacing = body.spacing.iter().map(|spacing| significant(*spacing, 4));
            let exact = body.exact_volume.map(|exact| {
                let off = 100.0 * (body.volume / exact - 1.0);
                // Round-off of the sum is no difference.
                let off = if off.abs() < 1e-9 { 0.0 } else { off };
                format!(", the shape's is {} ({:+} %)", significant(exact, 6), round(off))
            });
            vec![
                body.name.clone(),
                count(body.particles as u64, "particle"),
                format!(
                    "spacing {} m{}",
                    spacing.collect::<Vec<_>>().join(" x "),
                    finest(body.finest)
                ),
                format!(
                    "volume {} {unit}{}",
                    significant(body.volume, 6),
                    exact.unwrap_or_default()
                ),
                body.packing.as_ref().map(packed).unwrap_or_default(),
            ]
        })
        .collect();
    let mut lines = table::align(&rows, None, &[]);
    if plan.bodies.len() > 1 {
        let all: usize = plan.bodies.iter().map(|body| body.particles).sum();
        lines.push(format!("{all} particles in all"));
    }
    lines
}

/// What is said of packed particles.
fn packed(packing: &Packing) -> String {
    format!(
        "packed in {}; density within {} % near the surface, rms {} %",
        count(packing.steps as u64, "step"),
        significant(100.0 * packing.largest, 3),
        significant(100.0 * packing.rms, 3)
    )
}

/// What is said of regions of finer spacing.
fn finest(times: f64) -> String {
    if times > 1.0 { format!(", to 1/{times} of it") } else { String::new() }
}

/// Three significant digits, as a number so that its sign can be shown.
fn round(value: f64) -> f64 {
    significant(value, 3).parse().unwrap_or(value)
}

fn support(poor: &[Particle]) -> Vec<String> {
    if poor.is_empty() {
        return vec!["all particles have enough neighbours".to_owned()];
    }
    let mut lines =
        vec![format!("{} with too few neighbours:", count(poor.len() as u64, "particle"))];
    lines.extend(poor.iter().take(LISTED).map(place));
    if poor.len() > LISTED {
        lines.push(format!("... and {} more", poor.len() - LISTED));
    }
    lines
}

fn limits(plan: &Plan) -> Vec<String> {
    let rows: Vec<Vec<String>> = plan
        .limits
        .iter()
        .map(|limit| {
            let step = format!("{} s", significant(limit.step, 3));
            vec![limit.name.to_owned(), step, place(&limit.particle)]
        })
        .collect();
    table::align(&rows, None, &[])
}

fn undamped(fastest: &Undamped) -> String {
    // What is within rounding of one is one.
    let share =
        |factor: f64| round(100.0 * if (factor - 1.0).abs() < 1e-12 { 0.0 } else { factor - 1.0 });
    format!(
        "the fastest oscillation of the particles has a period of {} s; the integrator changes its \
         energy by {:+} % per period, to {} of its initial value at the end",
        significant(fastest.period, 3),
        share(fastest.by_period),
        significant(fastest.by_end, 3)
    )
}

fn place(particle: &Particle) -> String {
    let position = particle.reference.iter().map(|x| significant(*x, 5));
    format!("particle {} at ({}) m", particle.id, position.collect::<Vec<_>>().join(", "))
}
