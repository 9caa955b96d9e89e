//! Derivatives of states in equilibrium by constants of materials.

use piola::case::{self, LoadOptions, SensitivityError, Session};
use piola::schemes::{NoSensitivity, Sensitivity};

/// Lengths of the edges of the block in m.
const EDGES: [f64; 3] = [1.0, 0.6, 0.4];

/// A block that is held on rollers behind its lower faces, of a material and with what else there is.
fn block(dimension: usize, material: &str, scheme: &str, rest: &str) -> String {
    let mut text = format!(
        "version = 1\ntitle = \"A block\"\ndimension = {dimension}\n\
         [[body]]\nname = \"block\"\nshape = {{ kind = \"box\", min = {:?}, max = {:?} }}\n\
         spacing = 0.2\nmaterial = {{ density = 1000, {material} }}\n\
         [scheme]\n{scheme}\n[output]\nevery = 1.0\n{rest}\n",
        &[0.0; 3][..dimension],
        &EDGES[..dimension],
    );
    for (axis, name) in ["x", "y", "z"].iter().enumerate().take(dimension) {
        text += &held(dimension, axis, false, name, "0");
    }
    text
}

/// A face across an axis, with the displacement along it.
fn held(dimension: usize, axis: usize, is_upper: bool, name: &str, value: &str) -> String {
    let component = ["x", "y", "z"][axis];
    format!(
        "[[boundary]]\nname = \"{name}\"\nwhere = {}\ndisplacement = {{ {component} = \"{value}\" }}\n",
        face(dimension, axis, is_upper)
    )
}

fn face(dimension: usize, axis: usize, is_upper: bool) -> String {
    let mut normal = [0.0; 3];
    normal[axis] = if is_upper { 1.0 } else { -1.0 };
    let point = if is_upper { EDGES } else { [0.0; 3] };
    let [point, normal] = [point, normal].map(|vector| format!("{:?}", &vector[..dimension]));
    format!("{{ kind = \"plane\", point = {point}, normal = {normal} }}")
}

fn body_force(dimension: usize) -> String {
    let along = if dimension == 1 { "\"40 * x * t\"" } else { "\"40 * y * t\"" };
    let components = &[along, "\"-30 * x * t\"", "\"20 * t\""][..dimension];
    format!("[[load]]\nkind = \"body_force\"\nacceleration = [{}]\n", components.join(", "))
}

const STATIC: &str = "[time]\nintegrator = \"static\"\nend = 1.0\nstep = 0.25\ntolerance = 1e-12\n";

fn started(text: &str, set: &[String]) -> Session {
    let options = LoadOptions { overrides: set.to_vec(), ..LoadOptions::default() };
    let case = case::parse(text, "block.toml", &options).unwrap_or_else(|error| panic!("{error}"));
    Session::new(&case).unwrap_or_else(|error| panic!("{error}"))
}

fn ended(text: &str, set: &[String]) -> Session {
    let mut session = started(text, set);
    session.run_until(1.0).expect("there are no files");
    session
}

fn columns(session: &mut Session) -> [Vec<f64>; 2] {
    ["displacement", "reaction"].map(|name| session.column(name).expect("solids have it").values)
}

fn sensitivity(session: &mut Session, constant: &str) -> Sensitivity {
    let key = format!("body.block.material.{constant}");
    session.sensitivity(&key).unwrap_or_else(|error| panic!("{error}"))
}

/// The quotient of differences of four runs, of the fourth order.
fn quotient(text: &str, constant: &str, value: f64) -> [Vec<f64>; 2] {
    let step = 1e-3 * value.abs();
    let [far_below, below, above, far_above] = [-2.0, -1.0, 1.0, 2.0].map(|steps| {
        let set = format!("body.block.material.{constant}={:?}", value + steps * step);
        columns(&mut ended(text, &[set]))
    });
    [0, 1].map(|k| {
        let inner = above[k].iter().zip(&below[k]).map(|(next, last)| 8.0 * (next - last));
        let outer = far_above[k].iter().zip(&far_below[k]).map(|(next, last)| next - last);
        inner.zip(outer).map(|(inner, outer)| (inner - outer) / (12.0 * step)).collect()
    })
}

/// The bound is a part of the largest number.
fn assert_close(found: &[f64], expected: &[f64], bound: f64, what: &str) {
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let error = (found - expected).abs();
        assert!(error <= bound * largest, "{what}: {found:e} against {expected:e} of {largest:e}");
    }
}

/// Checks the derivatives by constants `name=value`. Runs stop at 1e-12 of the forces, which over the step of
/// the quotients and with a condition of some hundred is 1e-7; what these leave out is of the fourth power
/// of their step. Linear equations are solved to 1e-10.
fn check(text: &str, constants: &[&str], what: &str) {
    let mut session = ended(text, &[]);
    for constant in constants {
        let (name, value) = constant.split_once('=').expect("name=value");
        let Sensitivity { displacement, reaction } = sensitivity(&mut session, name);
        let [moved, held] = quotient(text, name, value.parse().expect("a number"));
        assert_close(&displacement, &moved, 1e-6, &format!("displacement by {name}, {what}"));
        assert_close(&reaction, &held, 1e-6, &format!("reaction by {name}, {what}"));
    }
}

/// All laws, with hourglass energy and without, in all dimensions, free and held across, under loads and
/// prescribed displacements that deform the block unevenly.
#[test]
fn derivatives_are_the_limits_of_differences() {
    let young = ["young_modulus=1.7e5", "poisson_ratio=0.23"];
    let bulk = ["bulk_modulus=1.1e5", "shear_modulus=0.6e5"];
    let lame = ["lame_lambda=1.1e5", "shear_modulus=0.6e5"];
    let mooney = ["c10=2.1e4", "c01=0.9e4", "bulk_modulus=1.3e5"];
    let ogden = ["moduli.0=3e4", "moduli.1=-1.1e4", "bulk_modulus=1.5e5"];
    let (stress, strain) = ("plane = \"stress\"", "plane = \"strain\"");
    let all: [(usize, &str, &[&str], &str, f64); 10] = [
        (2, "saint_venant_kirchhoff", &young, stress, 0.3),
        (2, "linear_elastic", &young, strain, 0.3),
        (2, "neo_hookean", &young, stress, 0.0),
        (3, "neo_hookean_logarithmic", &young, "", 0.3),
        (1, "neo_hookean", &young, stress, 0.0),
        (2, "neo_hookean", &bulk, stress, 0.3),
        (2, "neo_hookean_logarithmic", &lame, stress, 0.0),
        (2, "mooney_rivlin", &mooney, stress, 0.3),
        (3, "mooney_rivlin", &mooney, "", 0.3),
        (2, "ogden", &ogden, stress, 0.3),
    ];
    for (dimension, kind, constants, plane, hourglass) in all {
        let given = match kind {
            "ogden" => {
                "moduli = [3e4, -1.1e4], exponents = [1.7, -2.2], bulk_modulus = 1.5e5".to_owned()
            }
            _ => constants.join(", "),
        };
        let comma = if plane.is_empty() { "" } else { ", " };
        let material = format!("kind = \"{kind}\", {given}{comma}{plane}");
        let scheme = format!("kind = \"dual_support\"\nhourglass = {hourglass:?}");
        let head = held(dimension, 0, true, "head", "0.3 * t");
        let rest = format!("{STATIC}{}{head}", body_force(dimension));
        let text = block(dimension, &material, &scheme, &rest);
        check(&text, constants, &format!("{material} in {dimension}D"));
    }
}

const RUBBER: &str = "kind = \"neo_hookean\", young_modulus=1.7e5, poisson_ratio=0.23";

/// A pressure that follows the surface makes the tangent unsymmetric; both solvers.
#[test]
fn follower_pressure_is_in_the_tangent() {
    for solver in ["direct", "krylov"] {
        let pressure = format!(
            "{STATIC}linear_solver = \"{solver}\"\n[[load]]\nkind = \"pressure\"\nwhere = {}\n\
             pressure = \"2e4 * x * t\"\n",
            face(2, 1, true)
        );
        let text = block(2, RUBBER, "kind = \"dual_support\"", &pressure);
        check(&text, &["young_modulus=1.7e5", "poisson_ratio=0.23"], solver);
    }
}

/// Planes with images of the body beyond them, by Krylov's method.
#[test]
fn mirrors_and_krylovs_method_are_known() {
    let scheme =
        "kind = \"total_lagrangian\"\ngradients = \"plain\"\nsupport = 1.6\nhourglass = 0.2";
    let time = format!("{STATIC}linear_solver = \"krylov\"\n");
    let rest = format!("{time}{}{}", body_force(2), held(2, 0, true, "head", "0.3 * t"));
    let text = block(2, RUBBER, scheme, &rest)
        .replace("displacement = { x = \"0\" }", "displacement = { x = \"0\" }\nmirror = true");
    assert!(text.contains("mirror"));
    check(&text, &["young_modulus=1.7e5", "poisson_ratio=0.23"], "mirrors");
}

/// All stiffness of a linear body is in proportion to Young's modulus, that of hourglass energy included: under
/// dead loads `du/dE = -u/E` and the reactions stay, under prescribed displacements these stay and
/// `dr/dE = r/E`. The bound is the tolerance of the runs with a condition of some hundred.
#[test]
fn a_linear_body_is_known_exactly() {
    let material = "kind = \"linear_elastic\", young_modulus = 1.7e5, poisson_ratio = 0.23";
    let by_arc = STATIC.replace("static", "arc_length").replace("end = 1.0", "end = 0.5");
    let moved = held(3, 0, true, "head", "1e-2 * y * t");
    let loads = body_force(3);
    for (time, rest, is_loaded) in
        [(STATIC, &loads, true), (&by_arc, &loads, true), (STATIC, &moved, false)]
    {
        let text = block(3, material, "kind = \"dual_support\"", &format!("{time}{rest}"));
        let mut session = started(&text, &[]);
        session.step().unwrap();
        let found = sensitivity(&mut session, "young_modulus");
        let [displacement, reaction] = columns(&mut session);
        let [u, r] = if is_loaded { [-1.0 / 1.7e5, 0.0] } else { [0.0, 1.0 / 1.7e5] };
        for (found, column, factor) in
            [(&found.displacement, &displacement, u), (&found.reaction, &reaction, r)]
        {
            let largest = column.iter().fold(0.0_f64, |largest, x| largest.max(x.abs())) / 1.7e5;
            assert!(largest > 0.0);
            for (found, value) in found.iter().zip(column) {
                let error = (found - factor * value).abs();
                assert!(error <= 1e-9 * largest, "{found:e}, {:e} of {largest:e}", factor * value);
            }
        }
    }
}

/// A block of the neo-Hookean law (40) of theory in uniaxial stress. With stretches l along and a across,
/// `mu (a^2 - 1) + lambda ln(l a^2) = 0`, and the stress is `mu (l - 1/l) + lambda ln(l a^2)/l`. The bound is
/// the tolerance of the run with a condition of some hundred.
#[test]
fn a_stretched_cube_is_known_exactly() {
    let (e, nu, l) = (1.7e5, 0.23, 1.3_f64);
    let material = format!(
        "kind = \"neo_hookean_logarithmic\", young_modulus = {e:?}, poisson_ratio = {nu:?}"
    );
    let rest = format!(
        "{STATIC}{}[[probe]]\nname = \"force\"\nkind = \"sum\"\nfield = \"reaction\"\nwhere = {}\n\
         [[probe]]\nname = \"mean\"\nkind = \"mean\"\nfield = \"displacement\"\nwhere = {}\n\
         [[probe]]\nname = \"corner\"\nkind = \"particle\"\nat = [1.0, 0.6, 0.4]\n\
         relative_to = [0.0, 0.0, 0.0]\nfields = [\"stress\", \"position\"]\n\
         [[probe]]\nname = \"largest\"\nkind = \"extremum\"\nof = \"largest\"\nfield = \"displacement.y\"\n",
        held(3, 0, true, "head", "0.3 * t"),
        face(3, 0, true),
        face(3, 1, true),
    );
    let mut session = ended(&block(3, &material, "kind = \"dual_support\"", &rest), &[]);
    let (lambda, mu) = (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)));
    let mut a = 0.9_f64;
    for _ in 0..20 {
        let missing = mu * (a * a - 1.0) + lambda * (l * a * a).ln();
        a -= missing / (2.0 * mu * a + 2.0 * lambda / a);
    }
    let log = (l * a * a).ln();
    // Of the first constant of Lame and of the shear modulus.
    let by_nu = [
        e * (1.0 + 2.0 * nu * nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)).powi(2),
        -e / (2.0 * (1.0 + nu).powi(2)),
    ];
    for (constant, unit, [dlambda, dmu]) in
        [("young_modulus", 1.0 / e, [lambda / e, mu / e]), ("poisson_ratio", 1.0, by_nu)]
    {
        let across = -(dmu * (a * a - 1.0) + dlambda * log) / (2.0 * (mu * a + lambda / a));
        let stress = dmu * (l - 1.0 / l) + dlambda * log / l + lambda * 2.0 / (a * l) * across;
        let found = sensitivity(&mut session, constant);
        let position = session.column("position").unwrap().values;
        let displacement = session.column("displacement").unwrap().values;
        for (k, value) in found.displacement.iter().enumerate() {
            let expected = if k % 3 == 0 { 0.0 } else { across * (position[k] - displacement[k]) };
            assert!((value - expected).abs() < 1e-9 * unit, "{constant} {k}: {value} {expected}");
        }
        let probes = session.probe_sensitivities(&found);
        let names: Vec<&str> = probes.iter().map(|(name, _)| name.as_str()).collect();
        let columns = ["force.reaction", "mean.displacement", "corner.position"];
        let columns =
            columns.iter().flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}.{axis}")));
        assert_eq!(names, columns.collect::<Vec<_>>());
        let area = EDGES[1] * EDGES[2];
        assert!((probes[0].1 - area * stress).abs() < 1e-9 * e * unit, "{probes:?}");
        for (number, expected) in [
            (3, 0.0),
            (4, across * EDGES[1]),
            (6, 0.0),
            (7, across * EDGES[1]),
            (8, across * EDGES[2]),
        ] {
            assert!((probes[number].1 - expected).abs() < 1e-9 * unit, "{probes:?} {expected}");
        }
    }
}

/// A bar of St. Venant and Kirchhoff's law is compressed along its path through the limit of its load, where
/// the stretch l is the root of a third. With the stress `E l (l^2 - 1)/2` held,
/// `dl/dE = -l (l^2 - 1)/(E (3 l^2 - 1))`. Conjugate gradients end at an indefinite tangent, and what they have then is
/// refused. The bound is the tolerance over the least slope of the stress that is met.
#[test]
fn limit_points_are_passed() {
    let e = 1.7e5;
    let material = "kind = \"saint_venant_kirchhoff\", young_modulus = 1.7e5, poisson_ratio = 0.23, \
                    plane = \"stress\"";
    for (solver, end) in [("direct", 0.9), ("krylov", 0.75)] {
        let rest = format!(
            "[time]\nintegrator = \"arc_length\"\nend = {end}\nstep = 0.05\ntolerance = 1e-12\n\
             linear_solver = \"{solver}\"\n[[load]]\nkind = \"traction\"\nwhere = {}\ntraction = [\"-1e5 * t\"]\n",
            face(1, 0, true)
        );
        let mut session = started(&block(1, material, "kind = \"dual_support\"", &rest), &[]);
        let (mut stable, mut unstable) = (0, 0);
        let mut goes_on = true;
        while goes_on {
            goes_on = session.step().unwrap();
            let [displacement, _] = columns(&mut session);
            let tip = (0..displacement.len())
                .max_by(|&a, &b| displacement[a].abs().total_cmp(&displacement[b].abs()))
                .unwrap();
            let l = 1.0 + displacement[tip];
            let found = session.sensitivity("body.block.material.young_modulus");
            if 3.0 * l * l > 1.0 {
                stable += 1
            } else {
                unstable += 1
            }
            if solver == "krylov" && unstable > 0 {
                let refused = found.unwrap_err().to_string();
                assert!(refused.contains("needs the `direct` solver"), "{refused}");
                break;
            }
            let expected = -l * (l * l - 1.0) / (e * (3.0 * l * l - 1.0));
            let found = found.unwrap().displacement[tip];
            assert!((found / expected - 1.0).abs() < 1e-8, "{l}: {found:e} against {expected:e}");
        }
        assert!(stable > 0 && unstable > 0, "{solver}: {stable} {unstable}");
    }
}

/// Of two bodies that do not touch, each follows its own constants.
#[test]
fn a_body_does_not_follow_the_constants_of_another() {
    let material = "kind = \"linear_elastic\", young_modulus = 1.7e5, poisson_ratio = 0.23";
    let other = "[[body]]\nname = \"other\"\nshape = { kind = \"box\", min = [3.0, 0.0], max = [4.0, 0.6] }\n\
                 spacing = 0.2\nmaterial = { kind = \"neo_hookean\", density = 500, bulk_modulus = 1e5, \
                 shear_modulus = 1e5 }\n\
                 [[boundary]]\nname = \"wall\"\nbody = \"other\"\n\
                 where = { kind = \"plane\", point = [3.0, 0.0], normal = [-1.0, 0.0] }\n\
                 displacement = { x = \"0\" }\n";
    let rest = format!("{STATIC}{}{other}", body_force(2));
    let mut session = ended(&block(2, material, "kind = \"dual_support\"", &rest), &[]);
    let own = session.particles_of(Some(0));
    let displacement = columns(&mut session)[0].clone();
    let by_own = sensitivity(&mut session, "young_modulus");
    let by_other = session.sensitivity("body.1.material.shear_modulus").unwrap();
    assert_eq!(session.sensitivity("body.other.material.shear_modulus").unwrap(), by_other);
    let largest = displacement.iter().fold(0.0_f64, |largest, u| largest.max(u.abs()));
    for (k, u) in displacement.iter().enumerate() {
        if own.contains(&(k / 2)) {
            assert_eq!([by_other.displacement[k], by_other.reaction[k]], [0.0; 2]);
            let error = by_own.displacement[k] + u / 1.7e5;
            assert!(error.abs() < 1e-9 * largest / 1.7e5, "{error:e}");
        } else {
            assert_eq!([by_own.displacement[k], by_own.reaction[k]], [0.0; 2]);
        }
    }
    assert!(by_other.displacement.iter().any(|value| *value != 0.0));
}

/// Asking changes no bit of the steps to come, whatever the solver keeps; at rest there is nothing to
/// follow a constant.
#[test]
fn asking_changes_nothing() {
    for (kind, solver) in
        [("neo_hookean", "direct"), ("neo_hookean", "krylov"), ("linear_elastic", "krylov")]
    {
        let material = RUBBER.replace("neo_hookean", kind);
        let rest = format!("{STATIC}linear_solver = \"{solver}\"\n{}", body_force(2));
        let text = block(2, &material, "kind = \"dual_support\"", &rest);
        let (mut asked, mut other) = (started(&text, &[]), started(&text, &[]));
        let at_rest = sensitivity(&mut asked, "poisson_ratio");
        assert!(at_rest.displacement.iter().chain(&at_rest.reaction).all(|value| *value == 0.0));
        while asked.step().unwrap() {
            let first = sensitivity(&mut asked, "young_modulus");
            assert_eq!(sensitivity(&mut asked, "young_modulus"), first);
        }
        while other.step().unwrap() {}
        assert_eq!(columns(&mut asked), columns(&mut other), "{kind} {solver}");
        let tables =
            [asked, other].map(|session| session.tables().lock().energy.numbers().to_vec());
        assert_eq!(tables[0], tables[1]);
    }
}

#[test]
fn what_has_no_derivative_is_refused_with_its_key() {
    let text = block(2, RUBBER, "kind = \"dual_support\"", STATIC);
    let mut session = ended(&text, &[]);
    let mut advised = |key: &str, advice: &str| {
        let refused = session.sensitivity(key).unwrap_err();
        let expected = format!("there is no derivative with respect to `{key}`: {advice}");
        assert_eq!(refused.to_string(), expected);
    };
    let known =
        "expected `body.block.material.young_modulus` or `body.block.material.poisson_ratio`";
    advised(
        "body.block.material.young_moduls",
        "did you mean `body.block.material.young_modulus`?",
    );
    ["parameters.e", "body.other.material.c10", ""].into_iter().for_each(|key| advised(key, known));

    let key = "body.block.material.young_modulus";
    let refused = |text: &str, expected: NoSensitivity| {
        let refused = started(text, &[]).sensitivity(key).unwrap_err();
        assert!(refused.to_string().contains(&format!("with respect to `{key}`")), "{refused}");
        assert_eq!(refused, SensitivityError::None { key: key.to_owned(), source: expected });
    };
    let moving = text.replace(STATIC, "[time]\nend = 1e-3\ncfl = 0.3\n");
    let moving = moving.replace("displacement = ", "velocity = ");
    refused(&moving, NoSensitivity::NotStatic);
    refused(
        &moving.replace("cfl = 0.3", "integrator = \"newmark\"\nstep = 1e-3"),
        NoSensitivity::NotStatic,
    );
    let joined = format!(
        "{text}[[body]]\nname = \"upper\"\nshape = {{ kind = \"box\", min = [0.0, 0.6], max = [1.0, 1.0] }}\n\
         spacing = 0.2\nmaterial = {{ density = 1000, {RUBBER} }}\n"
    );
    refused(&joined.replace("dual_support", "total_lagrangian"), NoSensitivity::Joined);

    // A load that does not begin at zero has moved nothing before the first step.
    let load = format!("{STATIC}{}", body_force(2).replace(" * t", ""));
    let mut loaded = started(&block(2, RUBBER, "kind = \"dual_support\"", &load), &[]);
    let refused = loaded.sensitivity(key).unwrap_err();
    assert!(refused.to_string().contains("take a step first"), "{refused}");
    loaded.step().unwrap();
    assert!(loaded.sensitivity(key).is_ok());

    let energy = RUBBER.split(',').next().unwrap().replace("neo_hookean", "hyperelastic")
        + ", energy = \"4e4 * (I1b - 3) + 1e5 * (J - 1)^2\"";
    let refused = started(&text.replace(RUBBER, &energy), &[]).sensitivity(key).unwrap_err();
    assert!(refused.to_string().contains("elastic constants of named laws"), "{refused}");
}
