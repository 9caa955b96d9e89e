//! Rigid bodies that cannot be, and what is said of them.

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::SpaceTime;
use piola::case::{self, LoadOptions};
use piola::schemes::total_lagrangian::{
    Part, RigidBody, TotalLagrangian, TotalLagrangianError, TotalLagrangianInput,
};

use crate::rigid::input;

#[test]
fn bodies_of_which_no_motion_is_known_are_refused() {
    let start = || input([0.4, 0.4], [4, 4], |_| Vector::zeros());
    let refused = |input: TotalLagrangianInput<2>, part: &str| {
        let error = TotalLagrangian::new(input).err().unwrap_or_else(|| panic!("{part}"));
        assert!(error.to_string().contains(part), "{error}");
        error
    };
    let mut line = start();
    line.rigid[0].particles = vec![0, 1, 2];
    line.rigid[0].pivot = Some(Vector::zeros());
    refused(line, "is flat");
    let mut twice = start();
    twice.rigid.push(RigidBody {
        name: "other".into(),
        particles: (3..9).collect(),
        ..RigidBody::default()
    });
    refused(twice, "belongs to another rigid body");
    let mut pivot = start();
    pivot.rigid[0].pivot = Some(Vector::zeros());
    refused(pivot, "free to move");
    let mut spin = start();
    spin.rigid[0].angular_velocity = vec![(0, Arc::new(1.0))];
    refused(spin, "component");
    let mut displaced = start();
    displaced.displacement[0][0] = 0.1;
    let error = refused(displaced, "initial displacement");
    assert!(matches!(error, TotalLagrangianError::Combination { part: Part::Rigid, .. }));
    // A row in space has no inertia about itself; one prescribed axis leaves two that nutate.
    let faults: [(Vec<u32>, usize, &str); 2] =
        [((0..3).collect(), 0, "lies on a line"), ((0..27).collect(), 1, "two, or all, or none")];
    for (particles, axes, expected) in faults {
        let mut space = input([0.2; 3], [2; 3], |_| Vector::zeros());
        space.rigid[0].particles = particles;
        let prescribed = (0..axes).map(|axis| (axis, Arc::new(1.0) as Arc<dyn SpaceTime>));
        space.rigid[0].angular_velocity = prescribed.collect();
        let error = TotalLagrangian::new(space).err().unwrap();
        assert!(error.to_string().contains(expected), "{error}");
    }
}

#[test]
fn what_a_rigid_body_cannot_do_is_named_in_its_place() {
    let good = r#"
version = 1
title = "A rigid plate"
dimension = 2
[[body]]
name = "plate"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.1
material = { kind = "rigid", density = 10.0 }
[[body]]
name = "soft"
shape = { kind = "box", min = [2.0, 0.0], max = [3.0, 0.5] }
spacing = 0.1
material = { kind = "linear_elastic", density = 10.0, young_modulus = 1.0, poisson_ratio = 0.0 }
[scheme]
kind = "total_lagrangian"
[[boundary]]
name = "hinge"
body = "plate"
where = { kind = "all" }
velocity = { x = "0", y = "0" }
pivot = [0.0, 0.0]
angular_velocity = { z = "0.1" }
[time]
end = 0.1
"#;
    let said = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        let read = case::parse(&good.replacen(from, to, 1), "case.toml", &LoadOptions::default());
        let refused = read.and_then(|case| case::Session::new(&case).map(|_| ()));
        refused.expect_err(to).to_string()
    };
    case::parse(good, "case.toml", &LoadOptions::default())
        .unwrap_or_else(|error| panic!("{error}"));
    let plane = "{ kind = \"plane\", point = [0.0, 0.0], normal = [-1.0, 0.0] }";
    let faults = [
        ("{ kind = \"all\" }", plane, "a rigid body moves as one"),
        ("body = \"plate\"", "body = \"soft\"", "only a rigid body has an angular velocity"),
        ("{ z = \"0.1\" }", "{ x = \"0.1\" }", "has no meaning in 2D"),
        (", y = \"0\" }", " }", "has a pivot that is free to move"),
        ("end = 0.1", "end = 0.1\nstep = 0.1\nintegrator = \"newmark\"", "it is moved by kicks"),
        ("end = 0.1", "end = 0.1\nintegrator = \"tvd_rk2\"", "tvd_rk2"),
        ("density = 10.0 }", "density = 10.0, young_modulus = 1.0 }", "young_modulus"),
    ];
    for (from, to, expected) in faults {
        let said = said(from, to);
        assert!(said.contains(expected) && said.contains("case.toml:"), "for {to}\n{said}");
    }
}
