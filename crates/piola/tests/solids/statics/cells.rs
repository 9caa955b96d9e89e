//! Clouds of cell centres, which have no particle on the boundary.

use std::collections::BTreeMap;

use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{DirectedSupport, DualGradient, Face, Trace, nearest_radii};
use piola::schemes::dual_support::{
    Discrete, Gradients, Material, Settings, Statics, StaticsInput,
};
use piola::solve::{LoadSteps, Newton};
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::{HyperelasticLaw, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

use super::{constants, forces, moved};
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
    let radii = nearest_radii(&particles, 16, &Domain::open()).unwrap();
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

#[test]
fn the_patch_test_holds_on_cell_centres() {
    let (particles, support, trace) = bound([10, 5]);
    let law = HyperelasticLaw::neo_hookean(constants());
    let law = Reduced::<2>::new(law, StressState::PlaneStrain).unwrap();
    let areas = trace.areas(particles.len());
    let settings = Settings { gradients: Gradients::PatchConsistent { areas }, hourglass: 0.1 };
    let materials = vec![Material { density: 1.0, law }];
    let places = particles.position.clone();
    let body = Discrete::new(particles, support, &settings, materials).unwrap();
    let slope = some_gradient::<2>() + Tensor::<2>::identity() * 0.2;
    let stress = law.stress(&slope);
    let mut loads = vec![Vector::<2>::zeros(); body.len()];
    for (index, face) in trace.faces().iter().enumerate() {
        trace.spread(index, &(stress * face.area), &mut loads);
    }
    let held = [(0, 0), (0, 1), (9, 1)];
    let input = StaticsInput {
        tractions: forces(&loads),
        prescribed: held.iter().map(|&(a, i)| moved(a, i, (slope * places[a])[i])).collect(),
        newton: Newton { tolerance: 1e-11, ..Newton::default() },
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(&body, input).unwrap();
    let state = statics.solve(&LoadSteps::Given(vec![0.5, 1.0])).unwrap().remove(1);
    for (u, x) in state.displacement.iter().zip(&places) {
        assert!((u - slope * x).amax() < 1e-8, "{u}");
    }
    let (index, face) = (7, trace.faces()[7]);
    assert!((trace.value(index, &state.displacement) - slope * face.place).amax() < 1e-8);
}
