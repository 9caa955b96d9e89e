//! Steps of a fluid with a solid in it, and of the two by themselves: `cargo bench -p piola --bench coupled`.
//!
//! Water over a soft plate in a tank, in 2D and 3D. By itself the fluid has the plate as a wall that stands still, with the same
//! particles, and the solid has none around it. The plate is soft enough to take one step a step of the fluid. One of eight
//! layers is thicker than the support, so that its two sides need no particles of their own; those of three and four layers
//! have half of the water under them, and two wall particles of the fluid for each one. All take the same steps, with the
//! look at each state that runs take. Best of some steps in turns, on all threads.
//!
//! Then a thick gel of fine particles on shallow water with fast waves, which is most of the work: in steps of the water, and
//! in as many of them as the gel may take at once.

use std::time::Instant;

use piola::case::{self, LoadOptions, Session};

/// How often each is timed, in turns.
const TURNS: usize = 15;

/// Steps that are timed together.
const STEPS: u32 = 6;

/// What of the case there is.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Both,
    Fluid,
    Solid,
}

/// The layers of a plate that is thicker than the support.
const THICK: usize = 8;

/// The case, with `across` particles over the width of the tank and `layers` of them in the plate.
fn case([dimension, across, layers]: [usize; 3], part: Part) -> String {
    let vector = |x: f64, y: f64, z: f64| match dimension {
        2 => format!("[{x}, {z}]"),
        _ => format!("[{x}, {y}, {z}]"),
    };
    let (dx, up) = (1.0 / across as f64, if dimension == 2 { "y" } else { "z" });
    let (slab, shell) = (layers as f64 * dx, 4.0 * dx);
    // How high water is over the plate and under it, and where the tank ends.
    let is_thick = layers >= THICK;
    let [over, under] = if is_thick { [0.5, 0.0] } else { [0.25, 0.25] };
    let (floor, bottom) = (-slab - under, if is_thick { -slab } else { -slab - under - shell });
    let lattice = format!("spacing = {dx}\nlattice = {{ on = 'cells' }}\n");
    let water =
        "material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 10.0 }\n";
    let rubber = "material = { kind = 'neo_hookean', density = 1000.0, young_modulus = 2e4, poisson_ratio = 0.3 }\n";
    let shape = |name: &str, min: String, max: String| {
        format!(
            "[[body]]\nname = '{name}'\nshape = {{ kind = 'box', min = {min}, max = {max} }}\n{lattice}"
        )
    };
    let plate = shape("plate", vector(0.0, 0.0, -slab), vector(1.0, 1.0, 0.0));
    let held = ["x = '0'", "y = '0'", "z = '0'"][..dimension].join(", ");
    let mut text = format!("version = 1\ntitle = 'Water on a plate'\ndimension = {dimension}\n");
    if part != Part::Solid {
        let pressure = format!("{water}initial = {{ pressure = '500 - 1000 * {up}' }}\n");
        text += &shape("water", vector(0.0, 0.0, 0.0), vector(1.0, 1.0, over));
        text += &pressure;
        if !is_thick {
            text += &shape("below", vector(0.0, 0.0, floor), vector(1.0, 1.0, -slab));
            text += &pressure;
        }
        text += &format!(
            "[[body]]\nname = 'tank'\nshape = {{ kind = 'difference', from = {{ kind = 'box', min = {}, max = {} }}, \
             remove = [{{ kind = 'box', min = {}, max = {} }}] }}\n{lattice}{water}wall = {{ slip = 'free' }}\n",
            vector(-shell, -shell, bottom),
            vector(1.0 + shell, 1.0 + shell, 0.75),
            vector(0.0, 0.0, if is_thick { -1.0 } else { floor }),
            vector(1.0, 1.0, 1.0),
        );
    }
    text += &plate;
    text += &match part {
        Part::Both => format!(
            "{rubber}system = 'plate'\n[scheme]\nkind = 'transport_velocity'\nfree_surface = true\n\
             [[system]]\nname = 'plate'\nscheme = {{ kind = 'total_lagrangian' }}\nslip = 'free'\n"
        ),
        Part::Fluid => format!(
            "{water}wall = {{ slip = 'free' }}\n[scheme]\nkind = 'transport_velocity'\nfree_surface = true\n"
        ),
        Part::Solid => format!("{rubber}[scheme]\nkind = 'total_lagrangian'\n"),
    };
    if part != Part::Fluid {
        text += &format!(
            "[[boundary]]\nname = 'held'\nbody = 'plate'\n\
             where = {{ kind = 'plane', point = {}, normal = {} }}\nvelocity = {{ {held} }}\n",
            if is_thick { vector(0.0, 0.0, -slab + 0.5 * dx) } else { vector(0.5 * dx, 0.0, 0.0) },
            if is_thick { vector(0.0, 0.0, -1.0) } else { vector(-1.0, 0.0, 0.0) }
        );
    }
    // As long as the stable step of the fluid, with 1.3 spacings as its smoothing length.
    let step = 0.25 * 1.3 * dx / 12.0;
    text + &format!("[time]\nend = 1.0\nstep = {step}\n[output]\nevery = 10.0\n")
}

/// A gel of a density on a tenth as much water, with the end of the run in s and the key of the step, if it is fixed.
fn gel(density: f64, step: &str) -> String {
    let lattice = "lattice = { on = 'cells' }";
    let water = "material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 100.0 }";
    format!(
        "version = 1\ntitle = 'Gel on water'\ndimension = 2\n[domain]\nperiodic = {{ x = [0.0, 1.0] }}\n\
         [[body]]\nname = 'water'\nshape = {{ kind = 'box', min = [0.0, 0.0], max = [1.0, 0.2] }}\nspacing = 0.02\n{lattice}\n{water}\n\
         [[body]]\nname = 'floor'\nshape = {{ kind = 'box', min = [0.0, -0.08], max = [1.0, 0.0] }}\nspacing = 0.02\n{lattice}\n{water}\n\
         wall = {{ slip = 'free' }}\n\
         [[body]]\nname = 'gel'\nsystem = 'gel'\nshape = {{ kind = 'box', min = [0.0, 0.2], max = [1.0, 1.0] }}\nspacing = '0.02 / 3'\n{lattice}\n\
         material = {{ kind = 'neo_hookean', density = {density}, young_modulus = 2e4, poisson_ratio = 0.3 }}\n\
         initial = {{ velocity = ['0', '-0.01 * y'] }}\n\
         [scheme]\nkind = 'transport_velocity'\n\
         [[system]]\nname = 'gel'\nscheme = {{ kind = 'total_lagrangian' }}\nslip = 'free'\n[time]\nend = 1.0\n{step}"
    )
}

/// What the gel saves by steps of its own.
fn slow_solids() {
    println!(
        "\n| density over that of water | steps of the fluid in one | s a simulated second | in steps of the fluid | saved |"
    );
    println!("|--:|--:|--:|--:|--:|");
    for ratio in [1.1, 2.0, 4.0] {
        let mut several = session(&gel(1000.0 * ratio, ""));
        let plan = several.plan();
        let count = plan.own_steps.first().map_or(1, |(_, count)| *count);
        let step = format!("step = {}\n", plan.step / count as f64);
        let mut single = session(&gel(1000.0 * ratio, &step));
        let mut best = [f64::INFINITY; 2];
        for _ in 0..TURNS {
            best[0] = best[0].min(several.plan().seconds);
            best[1] = best[1].min(single.plan().seconds);
        }
        let [with, without] = best;
        let saved = 100.0 * (1.0 - with / without);
        println!("| {ratio} | {count} | {with:.1} | {without:.1} | {saved:.0} % |");
    }
}

fn session(text: &str) -> Session {
    let case = case::parse(text, "case.toml", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

fn main() {
    println!("| D | layers | particles | both, ms | fluid, ms | solid, ms | both over the sum |");
    println!("|--:|--:|--:|--:|--:|--:|--:|");
    let sizes = [[2, 100], [2, 200], [3, 40]];
    let all =
        [THICK, 4, 3].map(|layers| sizes.map(|[dimension, across]| [dimension, across, layers]));
    for of @ [dimension, _, layers] in all.into_iter().flatten() {
        let parts = [Part::Both, Part::Fluid, Part::Solid];
        let mut sessions = parts.map(|part| session(&case(of, part)));
        let plan = sessions[0].plan();
        assert!(plan.own_steps.iter().all(|(_, count)| *count == 1), "{:?}", plan.own_steps);
        let particles: usize = plan.bodies.iter().map(|body| body.particles).sum();
        let mut best = [f64::INFINITY; 3];
        for turn in 1..=TURNS as u32 {
            for (best, session) in best.iter_mut().zip(&mut sessions) {
                let start = Instant::now();
                session.run_until(f64::from(turn * STEPS) * plan.step).expect("it runs");
                *best = best.min(1e3 * start.elapsed().as_secs_f64() / f64::from(STEPS));
            }
        }
        let [both, fluid, solid] = best;
        println!(
            "| {dimension} | {layers} | {particles} | {both:.2} | {fluid:.2} | {solid:.2} | {:.2} |",
            both / (fluid + solid)
        );
    }
    slow_solids();
}
