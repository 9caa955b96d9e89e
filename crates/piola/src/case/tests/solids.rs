//! Elastic solids in a case file.

use super::*;
use crate::case::model::{Material, PlaneState, Preset, StepControl, SupportSize};
use crate::schemes::total_lagrangian::Form;
use crate::schemes::{ImplicitRule, Newmark};

const GOOD: &str = "\
version = 1
title = \"A block\"
dimension = 2

[[body]]
name = \"block\"
shape = { kind = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] }
spacing = 0.1
material = { kind = \"neo_hookean\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }

[scheme]
kind = \"dual_support\"

[time]
end = 0.01
";

fn said(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    read_with(&GOOD.replacen(from, to, 1), &[]).expect_err(to).to_string()
}

#[test]
fn what_is_not_given_is_what_serves_most() {
    let case = read_with(GOOD, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let Scheme::TotalLagrangian(settings) = &case.scheme.value else { panic!("{:?}", case.scheme) };
    assert_eq!(*settings.support, SupportSize::Spacings(2.05));
    assert_eq!((&settings.gradients, settings.hourglass), (&None, None));
    assert_eq!(case.time.integrator.value, "kick_drift_kick");
    let Material::Hyperelastic { law, plane, .. } = &case.bodies[0].material.value else {
        panic!("{:?}", case.bodies[0].material)
    };
    assert_eq!((law.name(), *plane), ("neo_hookean", PlaneState::Strain));
    assert!((law.small_strain().young_modulus() / 1e6 - 1.0).abs() < 1e-12);
}

/// The reference has in words what presets choose.
#[test]
fn the_reference_says_what_presets_choose() {
    let page = crate::case::reference::markdown();
    for preset in Preset::ALL {
        let name = preset.description().name;
        let own = page.split(&format!("### `kind = \"{name}\"`")).nth(1).expect("a section");
        let usual = |key: &str| {
            let row = own.lines().find(|line| line.starts_with(&format!("| `{key}` |")));
            row.and_then(|row| row.split(" | ").nth(3)).expect("a default").to_owned()
        };
        let radii = [(Form::Adjoint, 2), (Form::Strong, 1), (Form::Strong, 2)]
            .map(|(form, dimension)| preset.support(form, dimension).to_string());
        assert!(radii.iter().all(|radius| usual("support").contains(radius)), "{name}: {radii:?}");
        let hourglass = [(false, true), (true, false), (true, true)]
            .map(|(is_plain, is_rough)| preset.hourglass(is_plain, is_rough).to_string());
        let said = usual("hourglass");
        assert!(hourglass.iter().all(|value| said.contains(value)), "{name}: {hourglass:?}");
        for is_plain in [false, true] {
            let tractions = format!("{:?}", preset.tractions(is_plain)).to_lowercase();
            assert!(usual("tractions").contains(&tractions), "{name}: {tractions}");
        }
    }
}

#[test]
fn every_way_to_give_the_stiffness_is_the_same() {
    let modulus = |keys: &str| {
        let text = GOOD.replace("young_modulus = 1e6, poisson_ratio = 0.3", keys);
        let case = read_with(&text, &[]).unwrap_or_else(|problems| panic!("{problems}"));
        let Material::Hyperelastic { law, .. } = &case.bodies[0].material.value else {
            panic!("{keys}")
        };
        law.small_strain()
    };
    let (young, nu) = (1e6, 0.3);
    let shear = young / 2.6;
    let lambda = young * nu / (1.3 * 0.4);
    let bulk = young / (3.0 * 0.4);
    for keys in [
        format!("bulk_modulus = {bulk:?}, shear_modulus = {shear:?}"),
        format!("lame_lambda = {lambda:?}, shear_modulus = {shear:?}"),
    ] {
        let found = modulus(&keys);
        assert!((found.mu / shear - 1.0).abs() < 1e-12, "{keys}");
        assert!((found.lambda / lambda - 1.0).abs() < 1e-12, "{keys}");
    }
}

#[test]
fn what_does_not_fit_is_refused_with_what_does() {
    let stiffness = "young_modulus = 1e6, poisson_ratio = 0.3";
    for (from, to, parts) in [
        (stiffness, "young_modulus = 1e6", ["`young_modulus` do not give", "with `poisson_ratio`"]),
        (stiffness, "plane = \"stress\"", ["needs a stiffness", "`lame_lambda` with"]),
        (stiffness, "young_modulus = 1e6, poisson_ratio = 0.5", ["`poisson_ratio`", "below 0.5"]),
        (stiffness, "young_modulus = 1e6, wave_speed = 3.0", ["wave_speed", "young_modulus"]),
        ("neo_hookean\", ", "linear\", ", ["does not know this material", "neo_hookean"]),
        ("dual_support\"", "upwind\"\nsmoothing_length = 1", ["does not know this", "gamma_law"]),
        (
            "dual_support\"",
            "dual_support\"\nsupport = 2\nneighbors = 12",
            ["both set the size", "remove one"],
        ),
        (
            "spacing = 0.1",
            "spacing = 0.1\ninitial = { pressure = 3 }",
            ["starts with a pressure", "initial.pressure"],
        ),
    ] {
        let message = said(from, to);
        for part in parts {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
    let rubber = "kind = \"ogden\", density = 1e3, moduli = [1e5, -1e4], exponents = [2], \
                  bulk_modulus = 1e7 }";
    let good =
        "kind = \"neo_hookean\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3 }";
    assert!(said(good, rubber).contains("there are 2 and 1"));
}

#[test]
fn a_lattice_has_the_areas_of_its_box() {
    let text = GOOD.replace("spacing = 0.1", "spacing = [0.1, 0.2]");
    let case = read_with(&text, &["body.block.lattice={jitter=0.3}"]).expect("a good case");
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    // A cloud whose areas did not close its volume would have been refused; particles that carry
    // areas are on their sites, and corrected gradients exist.
    assert!(session.plan().warnings.is_empty());
}

/// The block, held at its left side, in statics.
fn in_statics() -> String {
    let held = "\n[[boundary]]\nname = \"wall\"\n\
                where = { kind = \"plane\", point = [0.0, 0.0], normal = [-1.0, 0.0] }\n\
                displacement = { x = \"0\", y = \"0\" }\n";
    GOOD.replace("end = 0.01\n", "end = 1.0\nintegrator = \"static\"\n") + held
}

#[test]
fn statics_has_its_own_steps_and_prescribes_displacements() {
    let text = in_statics();
    let case = read_with(&text, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.time.step.value, StepControl::AtMost(0.1));
    let held = &case.boundaries[0];
    assert!(held.displacement.iter().all(Option::is_some));
    assert!(held.velocity.iter().all(Option::is_none));
    let case = read_with(&text, &["time.step=0.25", "time.on_failure='retry'"]);
    assert_eq!(case.expect("a good case").time.step.value, StepControl::AtMost(0.25));

    for (from, to, parts) in [
        ("integrator", "cfl = 0.5\nintegrator", ["`cfl` has no meaning in statics", "remove it"]),
        ("displacement", "velocity", ["`velocity` has no meaning", "nothing moves"]),
        ("displacement = { x = \"0\", y = \"0\" }\n", "", ["`displacement`, or `roller`", "add"]),
        (
            "displacement",
            "roller = { normal = [0.0, 0.0] }\ndisplacement",
            ["`normal` must have a direction", "no direction"],
        ),
        ("displacement", "tied = [\"z\"]\ndisplacement", ["no component `z` in 2D", "unknown"]),
        (
            "displacement",
            "tied = [\"w\"]\ndisplacement",
            ["`tied` cannot be `w`", "did you mean `x`"],
        ),
        ("displacement", "tied = [\"x\", \"x\"]\ndisplacement", ["`x` is tied twice", "remove it"]),
        ("static\"", "kick_drift_kick\"\ntolerance = 1e-9", ["`tolerance` has no", "no equations"]),
        ("\"static\"", "\"kick_drift_kick\"", ["`displacement` has no meaning", "without the"]),
        (
            "dual_support\"",
            "upwind\"\nsmoothing_length = 1.0",
            [
                "`static` cannot move the scheme `upwind`",
                "a scheme that it moves: `total_lagrangian`",
            ],
        ),
    ] {
        assert!(text.contains(from), "{from}");
        let message = read_with(&text.replacen(from, to, 1), &[]).expect_err(to).to_string();
        for part in parts {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}

#[test]
fn implicit_steps_are_of_any_size_and_take_their_own_weights() {
    let with = |time: &str| GOOD.replace("end = 0.01\n", &format!("end = 0.01\n{time}\n"));
    let rule = |time: &str| {
        let case = read_with(&with(time), &[]).unwrap_or_else(|problems| panic!("{problems}"));
        (case.time.rule.expect("a rule"), case.time.step.value)
    };
    let (newmark, step) = rule("integrator = \"newmark\"\nstep = 0.002");
    assert_eq!(newmark, ImplicitRule::Newmark(Newmark::AVERAGE_ACCELERATION));
    assert_eq!(step, StepControl::AtMost(0.002));
    let (damped, step) = rule("integrator = \"newmark\"\ngamma = 0.6\nbeta = 0.3\ncfl = 20.0");
    assert_eq!(Ok(damped), Newmark::new(0.3, 0.6).map(ImplicitRule::Newmark));
    assert_eq!(step, StepControl::Cfl(20.0));
    let hht = rule("integrator = \"hht_alpha\"\nalpha = 0.1\nstep = 0.002").0;
    assert_eq!(hht, ImplicitRule::Newmark(Newmark::hilber_hughes_taylor(0.1)));
    let general = "integrator = \"generalised_alpha\"\nstep = 0.002\non_failure = \"retry\"";
    assert_eq!(rule(general).0, ImplicitRule::Newmark(Newmark::generalised_alpha(0.8)));

    for (time, parts) in [
        ("integrator = \"newmark\"", ["`step` is missing", "multiples of the stable"]),
        ("integrator = \"newmark\"\nstep = 0.1\ngamma = 0.7", ["2 beta >= gamma", "`beta = 0.35`"]),
        ("integrator = \"newmark\"\nstep = 0.1\nalpha = 0.1", ["`alpha` has no meaning", "remove"]),
        ("integrator = \"hht_alpha\"\nstep = 0.1\nalpha = 0.5", ["`alpha`", "0.5"]),
        ("spectral_radius = 0.5", ["`spectral_radius` has no meaning", "with this integrator"]),
    ] {
        let message = read_with(&with(time), &[]).expect_err(time).to_string();
        for part in parts {
            assert!(message.contains(part), "{time}: {message}");
        }
    }
    let text = with("integrator = \"newmark\"\nstep = 0.1");
    let message =
        read_with(&text.replacen("dual_support\"", "upwind\"\nsmoothing_length = 1.0", 1), &[]);
    let message = message.expect_err("upwind").to_string();
    assert!(message.contains("`newmark` cannot move the scheme `upwind`"), "{message}");
}

#[test]
fn a_body_that_is_free_to_move_is_refused_where_statics_is_asked_for() {
    let text = in_statics().replace("x = \"0\", y = \"0\"", "x = \"0\"");
    let case = read_with(&text, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let Err(problems) = Session::new(&case) else { panic!("it can shift along y") };
    let message = problems.to_string();
    for part in ["shift along y", "statics needs a body that is held", "\"static\""] {
        assert!(message.contains(part), "{message}");
    }
    // A second piece of the same body, which only the first one's support holds in words.
    let whole = "shape = { kind = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] }";
    let text = in_statics().replace(
        whole,
        "shape = { kind = \"union\", of = [{ kind = \"box\", min = [0.0, 0.0], max = [1.0, 1.0] }, \
         { kind = \"box\", min = [2.0, 0.0], max = [3.0, 1.0] }] }",
    );
    let message = built(&text).err().expect("nothing holds the second piece");
    for part in ["nothing connects particle", "at (2, 0) with the rest", "free to shift"] {
        assert!(message.contains(part), "{message}");
    }
}

/// The case as a session that is ready to run, or what is wrong with it.
fn built(text: &str) -> Result<Box<Session>, String> {
    let case = read_with(text, &[]).map_err(|problems| problems.to_string())?;
    Session::new(&case).map(Box::new).map_err(|problems| problems.to_string())
}

#[test]
fn rollers_ties_and_pressures_hold_and_load_the_block() {
    let more = |text: &str| in_statics() + text;
    let top = "where = { kind = \"plane\", point = [0.0, 1.0], normal = [0.0, 1.0] }";
    let tied = more(&format!("\n[[boundary]]\nname = \"platen\"\n{top}\ntied = [\"y\"]\n"));
    // The corner at the wall is held in y: it cannot be tied too.
    let message = built(&tied).err().expect("a corner in both");
    for part in ["`platen` ties component y of particle", "(0, 1)", "leave the particle out"] {
        assert!(message.contains(part), "{message}");
    }
    let free = tied.replace("x = \"0\", y = \"0\"", "x = \"0\"");
    let message = built(&free).err().expect("free along y");
    assert!(message.contains("shift along y"), "{message}");
    let roller = "\n[[boundary]]\nname = \"slope\"\nwhere = { kind = \"ball\", \
                  center = [1.0, 0.0], radius = 0.01 }\nroller = { normal = [1.0, 2.0] }\n";
    built(&(free + roller)).unwrap_or_else(|message| panic!("{message}"));

    let pressure =
        |at: &str| format!("\n[[load]]\nkind = \"pressure\"\n{at}\npressure = \"1e4 * t\"\n");
    built(&more(&pressure(top))).unwrap_or_else(|message| panic!("{message}"));
    built(&more(&pressure("where = { kind = \"all\" }"))).unwrap_or_else(|m| panic!("{m}"));
    let inside = pressure("where = { kind = \"ball\", center = [0.5, 0.5], radius = 0.2 }");
    let message = built(&more(&inside)).err().expect("no surface there");
    assert!(message.contains("none of the particles of this region lies on"), "{message}");
    let upwind = more(&pressure(top))
        .replace("dual_support\"", "upwind\"\nsmoothing_length = 1.0")
        .replace("integrator = \"static\"", "");
    let message = built(&upwind).err().expect("upwind");
    assert!(message.contains("has no load of the kind `pressure`"), "{message}");
}

#[test]
fn bodies_may_touch_and_not_overlap() {
    let second = |y: f64| {
        let body = GOOD.find("[[body]]").expect("a body")..GOOD.find("[scheme]").expect("a scheme");
        let top = format!("min = [0.5, {y}], max = [1.5, {}]", y + 1.0);
        let other =
            GOOD[body].replace("block", "top").replace("min = [0.0, 0.0], max = [1.0, 1.0]", &top);
        built(&GOOD.replace("[scheme]", &format!("{other}[scheme]"))).map(|_| ())
    };
    assert_eq!(second(1.0), Ok(()));
    assert_eq!(second(0.96), Ok(()), "less than half a spacing deep");
    let said = second(0.9).expect_err("a layer of particles in the other body");
    assert!(said.contains("the bodies `block` and `top` overlap: particle 121 of `top`"), "{said}");
    assert_eq!(said.matches("overlap").count(), 1, "{said}");
    // Its lattice is that of the other body no more.
    assert!(second(0.43).is_err_and(|said| said.contains("overlap")));
}

/// Bodies of one solid that touch, and are not joined, would pass through each other without a word.
#[test]
fn bodies_that_touch_and_are_not_joined_are_warned_of() {
    let warned = |keys: &str, lattice: &str, [x, y]: [f64; 2], top: &str| {
        let law = if keys.contains("upwind") { "linear" } else { "neo_hookean" };
        let lattice = format!("spacing = 0.1\nlattice = {{ on = \"{lattice}\" }}");
        let text = GOOD.replace("kind = \"dual_support\"", keys).replace("neo_hookean", law);
        let text = text.replace("spacing = 0.1", &lattice);
        let (body, rest) = text.split_once("[scheme]").expect("a scheme");
        let (_, block) = body.split_once("[[body]]").expect("a body");
        let place = format!("min = [{x}, {y}], max = [{}, {}]", x + 1.0, y + 1.0);
        let other =
            block.replace("block", "top").replace("min = [0.0, 0.0], max = [1.0, 1.0]", &place);
        let (head, _) = other.split_once("material").expect("a material");
        let other = if top.is_empty() { other.clone() } else { format!("{head}{top}\n") };
        let case = read_with(&format!("{body}[[body]]{other}[scheme]{rest}"), &[]);
        let case = case.unwrap_or_else(|problems| panic!("{problems}"));
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        let warnings = session.plan().warnings;
        let start = "the bodies `block` and `top` touch at the start";
        let found = warnings.iter().find(|text| text.starts_with(start));
        assert!(found.is_none_or(|text| !(text.contains("joined") && law == "linear")));
        found.is_some()
    };
    let upwind = "kind = \"upwind\"\nsmoothing_length = 0.7";
    let joined = "kind = \"total_lagrangian\"";
    let separate = "kind = \"total_lagrangian\"\njoined = false";
    for keys in [upwind, separate] {
        for lattice in ["cells", "boundary"] {
            for shift in [0.0, 0.03, 0.05] {
                assert!(warned(keys, lattice, [shift, 1.0], ""), "{keys} {lattice} {shift}");
            }
            assert!(!warned(keys, lattice, [0.0, 1.2], ""), "{keys} {lattice}");
        }
    }
    assert!(!warned(joined, "boundary", [0.0, 1.0], ""), "they share particles");
    assert!(warned(joined, "cells", [0.0, 1.0], ""), "they share none");
    let plain = "kind = \"total_lagrangian\"\ngradients = \"plain\"";
    let rigid = "material = { kind = \"rigid\", density = 1e3 }";
    assert!(!warned(plain, "boundary", [0.0, 1.0], rigid), "the block is clamped to it");
    // A tenth is half a spacing along y.
    let wide = "kind = \"total_lagrangian\"\njoined = false";
    let text = GOOD
        .replace("kind = \"dual_support\"", wide)
        .replace("spacing = 0.1", "spacing = [0.1, 0.2]");
    let (body, rest) = text.split_once("[scheme]").expect("a scheme");
    let (head, block) = body.split_once("[[body]]").expect("a body");
    let other = block
        .replace("block", "right")
        .replace("min = [0.0, 0.0], max = [1.0, 1.0]", "min = [1.1, 0.0], max = [2.1, 1.0]");
    let case = read_with(&format!("{head}[[body]]{block}[[body]]{other}[scheme]{rest}"), &[]);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let warnings = session.plan().warnings;
    assert!(!warnings.iter().any(|text| text.contains("touch")), "{warnings:?}");
}

/// A load on a plane is the product of traction and area, wherever the particles lie in their cells,
/// and what holds the body carries it.
#[test]
fn loads_are_those_of_the_surface_on_any_lattice() {
    let top = "where = { kind = \"plane\", point = [0.0, 1.0], normal = [0.0, 1.0] }";
    let probe = "\n[[probe]]\nname = \"hold\"\nkind = \"sum\"\nfield = \"reaction\"\n";
    let linear = in_statics().replace("neo_hookean", "linear_elastic") + probe;
    for lattice in ["boundary", "cells"] {
        for load in [
            "kind = \"traction\"\ntraction = [\"0\", \"-100\"]",
            "kind = \"pressure\"\npressure = 100",
        ] {
            let text = linear
                .replace("spacing = 0.1", &format!("spacing = 0.1\nlattice.on = \"{lattice}\""));
            let text = text + &format!("\n[[load]]\n{top}\n{load}\n");
            let session = built(&text).unwrap_or_else(|message| panic!("{message}"));
            let stop = std::sync::atomic::AtomicBool::new(false);
            let finished = session.run(&stop, &mut |_| {}).expect("nothing is written");
            let Some(crate::observe::Series::Curve { values, .. }) =
                finished.quantity("hold.reaction.y")
            else {
                panic!("{lattice} {load}")
            };
            let carried = *values.last().expect("a value at the end");
            // Strains of 1e-4 turn the surface a little.
            assert!((carried / 100.0 - 1.0).abs() < 1e-3, "{lattice} {load}: {carried} N");
        }
    }
}

#[test]
fn fluids_and_solids_of_one_scheme_show_what_they_have() {
    let fluid = "kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0";
    let solid =
        "kind = \"hypoelastic\", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3";
    let read = |material: &str, field: &str| {
        let text = GOOD.replace("dual_support", "transport_velocity").replace(
            &GOOD[GOOD.find("kind = \"neo").unwrap()..GOOD.find(" }\n\n").unwrap()],
            material,
        );
        let probe = "[[probe]]\nname = \"most\"\nkind = \"extremum\"\nof = \"largest\"\nfield = ";
        read_with(&format!("{text}\n{probe}\"{field}\"\n"), &[]).map_err(|found| found.to_string())
    };
    for (own, other, field) in [(solid, fluid, "von_mises"), (fluid, solid, "summed_density")] {
        let other = read(other, field).expect_err(field);
        assert!(other.contains(&format!("has no field `{field}` for ")), "{other}");
        read(own, field).unwrap_or_else(|problems| panic!("{problems}"));
    }
}

/// A strain energy of one's own is read with the parameters, and what is none is refused where it stands.
#[test]
fn a_strain_energy_can_be_written_out() {
    let written = |energy: &str| {
        let start = GOOD.find("material = {").unwrap();
        let end = start + GOOD[start..].find('\n').unwrap();
        let material = format!(
            "material = {{ kind = \"hyperelastic\", density = 1000.0, energy = \"{energy}\" }}"
        );
        let text = format!("{}{material}{}", &GOOD[..start], &GOOD[end..]);
        read_with(&text, &["parameters={ mu = 2e5, kappa = 1e6 }"])
    };
    for energy in [
        "mu/2 * (I1b - 3) + kappa/2 * (J - 1)^2",
        "kappa/2*(J-1)^2 + mu/2*J^(-2/3)*I1",
        "mu * exp(ln(I1b) / 2)^2 / 2 + kappa / 2 * (sqrt(J^2) - 1)^2",
        "-mu*15*ln(1-(I1b-3)/30) + kappa/2 * (J - 1)^(1 + 1) + sin(0)",
    ] {
        let case = written(energy).unwrap_or_else(|problems| panic!("{problems}"));
        let Material::Hyperelastic { law, .. } = &case.bodies[0].material.value else {
            panic!("{energy}")
        };
        let small = law.small_strain();
        assert!((small.mu / 2e5 - 1.0).abs() < 1e-9, "{energy}: {small:?}");
        assert!((small.bulk_modulus() / 1e6 - 1.0).abs() < 1e-9, "{energy}: {small:?}");
    }
    for (energy, parts) in [
        ("mu/2 * (I1b - 3) + kapa/2 * (J - 1)^2", ["`kapa` is not known", "did you mean `kappa`?"]),
        ("mu/2 * (I1 - 3)", ["this cannot be an energy: there is a stress of", "removes it"]),
        ("mu/2 * sin(I1b)", ["`sin` cannot be applied to an invariant", "exp, ln, log and sqrt"]),
        ("mu/2 * x", ["`x` cannot be used here: an energy depends on the strain", "I1, I2, J"]),
        ("-mu/2 * (I1b - 3)", ["the shear modulus of small strains is", "change of shape"]),
        ("mu/2 * (I1b - 3)", ["nothing resists a change of volume", "add a term"]),
        ("pow(I1b - 3, 2) + x", ["`x` cannot be used here", "I1, I2, J"]),
        ("kappa * ln(J - 1)", ["at rest (I1 = I2 = 3, J = 1) the energy is", "J/m^3"]),
        ("mu * (I1b - 3", ["this bracket is never closed", "add a `)`"]),
    ] {
        let problems = written(energy).unwrap_err().to_string();
        parts.iter().for_each(|part| assert!(problems.contains(part), "{problems}"));
    }
}
