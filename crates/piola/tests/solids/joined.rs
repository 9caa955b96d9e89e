//! Bodies that share particles, and planes that are no mirrors.

use piola::case::{self, LoadOptions, Session};

/// Two blocks that share an edge, of which the lower one is held.
const BLOCKS: &str = r#"
version = 1
title = "Two blocks"
dimension = 2

[[body]]
name = "lower"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.1
lattice = { on = "boundary" }
material = { kind = "linear_elastic", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.25 }

[[body]]
name = "upper"
shape = { kind = "box", min = [0.0, 0.5], max = [1.0, 1.0] }
spacing = 0.1
lattice = { on = "boundary" }
material = { kind = "linear_elastic", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.25 }

[scheme]
kind = "total_lagrangian"
SUPPORT

[[boundary]]
name = "floor"
where = { kind = "plane", point = [0.0, 0.0], normal = [0.0, -1.0] }
body = "lower"
displacement = { y = "0" }

[[boundary]]
name = "side"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
displacement = { x = "0" }

[[load]]
name = "pull"
kind = "traction"
where = { kind = "plane", point = [0.0, 1.0], normal = [0.0, 1.0] }
body = "upper"
traction = ["0", "0.01 * t"]

[time]
integrator = "static"
end = 1.0
step = 1.0

[[probe]]
name = "top"
kind = "particle"
at = [1.0, 1.0]
fields = ["displacement"]

[[probe]]
name = "least"
kind = "extremum"
of = "smallest"
field = "stress.yy"

[[probe]]
name = "most"
kind = "extremum"
of = "largest"
field = "stress.yy"
"#;

fn refusal(text: &str) -> String {
    let case = case::parse(text, "case.toml", &LoadOptions::default());
    let found = case.and_then(|case| Session::new(&case));
    found.err().map_or_else(String::new, |problems| problems.to_string())
}

/// The patch test over an interface: the stress is the load everywhere, and the top rises as Hooke's law has it
/// in plane strain.
#[test]
fn joined_blocks_bear_a_homogeneous_stress() {
    for support in ["", "neighbors = 12", "weights = 'volume'"] {
        let text = BLOCKS.replace("SUPPORT", support);
        let names =
            ["least.stress.yy", "most.stress.yy", "top.displacement.y", "top.displacement.x"];
        let found = super::statics::mirrors::values(&text, &names);
        let strain = 0.01 * (1.0 - 0.25_f64.powi(2));
        let expected = [0.01, 0.01, strain, -strain / 3.0];
        for ((name, found), expected) in names.iter().zip(&found).zip(expected) {
            assert!(
                (found - expected).abs() < 1e-9,
                "{support}: {name} is {found}, not {expected}"
            );
        }
    }
}

#[test]
fn a_plane_that_is_no_mirror_is_refused() {
    let plain = BLOCKS.replace("SUPPORT", "gradients = \"plain\"");
    let side = "normal = [-1.0, 0.0] }\n";
    let with = |text: &str| plain.replace(side, &format!("{side}mirror = true\n{text}"));
    assert_eq!(refusal(&with("")), "");
    let again = "\n[[boundary]]\nname = \"again\"\nmirror = true\ndisplacement = { x = \"0\" }\n\
                 where = { kind = \"plane\", point = [0.0, 0.0], normal = [-1.0, 0.0] }\n\n[[load]]\n";
    for (text, parts) in [
        (with("").replace("[[load]]\n", again), "two mirrors lie across x"),
        (with("body = \"upper\"\n"), "is not moved across it as all of it is"),
        (with("").replace("{ x = \"0\" }", "{ x = \"0.1 * y\" }"), "is not moved across it"),
        (
            with("").replace("SUPPORT", "").replace("gradients", "neighbors = 12\ngradients"),
            "`neighbors`",
        ),
        (
            plain.replace("0.25 }", "0.25 }\ninitial = { displacement = [\"x\", \"0\"] }"),
            "initial values cannot be combined with statics",
        ),
    ] {
        let message = refusal(&text);
        assert!(message.contains(parts), "{parts}: {message}");
    }
}
