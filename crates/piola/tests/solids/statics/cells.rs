//! Clouds of cell centres, which have no particle on the boundary.

use std::collections::BTreeMap;

use piola::boundaries::PrescribedFaces;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{DirectedSupport, DualGradient, Face, Trace, nearest_radii};
use piola::schemes::InputError;
use piola::schemes::total_lagrangian::{
    Discrete, Gradients, Material, Settings, Statics, StaticsError, StaticsInput,
};
use piola::solve::{LinearMethod, LoadSteps, Newton};
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

use super::{constants, forces, growing, moved};
use crate::clouds::some_gradient;
use crate::support::jittered;

/// Centres of the triangles of a disordered mesh with their areas, and its outer edges.
fn triangles(intervals: [usize; 2]) -> (Particles<2>, Vec<Face<2>>) {
    let nodes = jittered([2.0, 1.0], intervals, 0.2).position;
    let mut cells = Vec::new();
    for cell in 0..intervals[0] * intervals[1] {
        let corner = cell % intervals[0] + cell / intervals[0] * (intervals[0] + 1);
        let (right, up) = (corner + 1, corner + intervals[0] + 1);
        cells.push([corner, right, up + 1]);
        cells.push([corner, up + 1, up]);
    }
    let mut particles = Particles::default();
    let mut edges: BTreeMap<[usize; 2], Vec<Face<2>>> = BTreeMap::new();
    for (number, cell) in cells.iter().enumerate() {
        let [a, b, c] = cell.map(|node| nodes[node]);
        let volume = 0.5 * (b - a).perp(&(c - a));
        particles.position.push((a + b + c) / 3.0);
        particles.volume.push(volume);
        particles.spacing.push(volume.sqrt());
        particles.body.push(0);
        particles.id.push(number as u32);
        for k in 0..3 {
            let [from, to] = [cell[k], cell[(k + 1) % 3]];
            let edge = nodes[to] - nodes[from];
            let face = Face {
                owner: number as u32,
                place: 0.5 * (nodes[from] + nodes[to]),
                area: Vector::<2>::new(edge[1], -edge[0]),
            };
            edges.entry([from.min(to), from.max(to)]).or_default().push(face);
        }
    }
    particles.weight.clone_from(&particles.volume);
    // Inner edges belong to two cells.
    let outer = edges.into_values().filter(|faces| faces.len() == 1).flatten();
    (particles, outer.collect())
}

fn bound(intervals: [usize; 2]) -> (Particles<2>, DirectedSupport<2>, Trace<2>) {
    let (particles, faces) = triangles(intervals);
    let radii = nearest_radii(&particles, &particles.body, 16, &Domain::open()).unwrap();
    let support =
        DirectedSupport::new(&particles, Kernel::QuinticSpline, radii, Domain::open()).unwrap();
    let plain = DualGradient::plain(&particles, &support).unwrap();
    let trace = Trace::new(faces, &particles, &support, &plain);
    (particles, support, trace)
}

#[test]
fn traces_are_exact_for_linear_fields_and_their_own_adjoints() {
    let (particles, _, trace) = bound([8, 4]);
    let slope = some_gradient::<2>();
    let field: Vec<Vector<2>> = particles.position.iter().map(|x| slope * x).collect();
    let force = Vector::<2>::new(2.0, -3.0);
    assert_eq!(trace.faces().len(), 2 * (8 + 4));
    for (index, face) in trace.faces().iter().enumerate() {
        let value = trace.value(index, &field);
        assert!((value - slope * face.place).norm() < 1e-14, "{value}");
        let mut forces = vec![Vector::<2>::zeros(); field.len()];
        trace.spread(index, &force, &mut forces);
        let work: f64 = forces.iter().zip(&field).map(|(f, u)| f.dot(u)).sum();
        assert!((work - force.dot(&value)).abs() < 1e-14);
    }
    // The theorem of Gauss for constants and linear fields.
    let areas = trace.areas(particles.len());
    let sum: Vector<2> = areas.iter().sum();
    assert!(sum.norm() < 1e-14);
    let moment: Tensor<2> =
        areas.iter().zip(&particles.position).map(|(area, x)| area * x.transpose()).sum();
    let volume: f64 = particles.volume.iter().sum();
    assert!((moment / volume - Tensor::<2>::identity()).amax() < 1e-13);
}

/// A homogeneous state by loads on all faces, held at three particles; and by holding the faces of
/// the left and the lower side, with loads on the others.
#[test]
fn the_patch_test_holds_on_cell_centres() {
    let (particles, support, trace) = bound([10, 5]);
    let law = HyperelasticLaw::neo_hookean(constants());
    let law = Reduced::<2>::new(law, StressState::PlaneStrain).unwrap();
    let areas = trace.areas(particles.len());
    let settings = Settings {
        gradients: Gradients::PatchConsistent { areas },
        hourglass: 0.1,
        ..Settings::default()
    };
    let materials = vec![Material { density: 1.0, law: law.clone() }];
    let places = particles.position.clone();
    let body = Discrete::new(particles, support, &settings, materials).unwrap();
    let slope = some_gradient::<2>() + Tensor::<2>::identity() * 0.2;
    let slope = 0.5 * (slope + slope.transpose());
    let stress = law.stress(&slope);
    let (mut all, mut others) = (vec![Vector::<2>::zeros(); body.len()], Vec::new());
    let (mut left, mut lower) = (Vec::new(), Vec::new());
    for (index, face) in trace.faces().iter().enumerate() {
        trace.spread(index, &(stress * face.area), &mut all);
        let normal = face.area.normalize();
        left.extend((normal[0] < -0.8).then_some(index as u32));
        lower.extend((normal[1] < -0.8).then_some(index as u32));
        others.extend((normal.min() > -0.8).then_some(index));
    }
    assert!(left.len() == 5 && lower.len() == 10);
    let mut loads = vec![Vector::<2>::zeros(); body.len()];
    for index in others {
        trace.spread(index, &(stress * trace.faces()[index].area), &mut loads);
    }
    let held = [(0, 0), (0, 1), (9, 1)];
    let faces = |name: &str, faces: &[u32], component: usize| PrescribedFaces {
        name: name.into(),
        faces: faces.to_vec(),
        direction: Vector::<2>::from_fn(|i, _| f64::from(u8::from(i == component))),
        value: growing(move |x| (slope * Vector::<2>::new(x[0], x[1]))[component]),
    };
    let points = StaticsInput {
        tractions: forces(&all),
        prescribed: held.iter().map(|&(a, i)| moved(a, i, (slope * places[a])[i])).collect(),
        ..StaticsInput::default()
    };
    let sides = |method| StaticsInput {
        tractions: forces(&loads),
        trace: Some(trace.clone()),
        prescribed_faces: vec![
            faces("left", &left, 0),
            faces("left", &left, 1),
            faces("lower", &lower, 0),
            faces("lower", &lower, 1),
        ],
        method,
        ..StaticsInput::default()
    };
    for input in [points, sides(LinearMethod::Direct), sides(LinearMethod::Krylov)] {
        let newton = Newton { tolerance: 1e-11, ..Newton::default() };
        let is_held = input.trace.is_some();
        let mut statics =
            Statics::new(body.clone().into(), StaticsInput { newton, ..input }).unwrap();
        let state = statics.solve(&LoadSteps::Given(vec![0.5, 1.0])).unwrap().remove(1);
        for (u, x) in state.displacement.iter().zip(&places) {
            assert!((u - slope * x).amax() < 1e-8, "{u} {:?}", state.solved);
        }
        let face = trace.faces()[7];
        assert!((trace.value(7, &state.displacement) - slope * face.place).amax() < 1e-8);
        if is_held {
            let reaction: Vector<2> = state.reactions.iter().map(|reaction| reaction.force).sum();
            let total: Vector<2> = loads.iter().sum();
            assert!((reaction + total).norm() < 1e-9 * total.norm(), "{reaction} {total}");
        }
    }
}

#[test]
fn faces_that_do_not_exist_or_do_not_hold_are_named() {
    let (particles, support, trace) = bound([4, 2]);
    let law = HyperelasticLaw::linear_elastic(constants());
    let law = Reduced::<2>::new(law, StressState::PlaneStrain).unwrap();
    let settings = Settings { gradients: Gradients::Plain, hourglass: 1.0, ..Settings::default() };
    let materials = vec![Material { density: 1.0, law }];
    let body = Discrete::new(particles, support, &settings, materials).unwrap();
    let refused = |faces: Vec<u32>, trace: Option<Trace<2>>| {
        let held = |direction| PrescribedFaces {
            name: "wall".into(),
            faces: faces.clone(),
            direction,
            value: growing(|_| 0.0),
        };
        let prescribed_faces = vec![held(Vector::<2>::x()), held(Vector::<2>::y())];
        let input = StaticsInput { trace, prescribed_faces, ..StaticsInput::default() };
        Statics::new(body.clone().into(), input).err().expect("it is refused")
    };
    let error = refused(vec![99], Some(trace.clone()));
    assert!(
        matches!(error, StaticsError::Input(InputError::Index { got: 99, count: 12, .. })),
        "{error}"
    );
    let error = refused(vec![0], None);
    assert!(
        matches!(error, StaticsError::Input(InputError::Index { got: 0, count: 0, .. })),
        "{error}"
    );
    let error = refused(vec![0], Some(trace));
    assert!(matches!(error, StaticsError::Free { .. }), "{error}");
}
