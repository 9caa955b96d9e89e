//! The cantilevers of Dual-support 6.1 and 6.3.

use piola::Vector;
use piola::boundaries::PrescribedDisplacement;
use piola::neighbors::Domain;
use piola::operators::{DirectedSupport, nearest_radii};
use piola::schemes::total_lagrangian::{
    Discrete, Gradients, Material, Settings, StaticState, Statics, StaticsInput,
};
use piola::solve::LoadSteps;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

use super::{forces, growing, moved, select};
use crate::clouds::Cloud;
use crate::support::lattice;

const YOUNG: f64 = 30e9;
const POISSON: f64 = 0.3;
const LENGTHS: [f64; 3] = [8.0, 3.0, 2.0];

/// Dual-support (53) and (54): Timoshenko's cantilever of height 3 under a shear force of -1000 N
/// per unit of thickness, y from the axis.
fn timoshenko(x: &[f64; 3]) -> [f64; 2] {
    let (load, length, height) = (-1000.0, LENGTHS[0], LENGTHS[1]);
    let rigidity = 6.0 * YOUNG * height * height * height / 12.0;
    let (x, y) = (x[0], x[1] - 0.5 * height);
    let quarter = 0.25 * height * height;
    [
        load * y / rigidity * ((6.0 * length - 3.0 * x) * x + (2.0 + POISSON) * (y * y - quarter)),
        -load / rigidity
            * (3.0 * POISSON * y * y * (length - x)
                + (4.0 + 5.0 * POISSON) * quarter * x
                + (3.0 * length - x) * x * x),
    ]
}

/// Nodes of a disordered mesh of tetrahedra with 24 neighbours each.
fn beam(intervals: [usize; 3]) -> (Cloud<3>, Discrete<3>) {
    let mut cloud = Cloud::block(LENGTHS, intervals, 0.1);
    // Whole cells as kernel weights: with the shares of the nodes, which are small on the boundary,
    // so few particles are 10 % too soft.
    cloud.particles.weight = lattice(LENGTHS, intervals).weight;
    let radii =
        nearest_radii(&cloud.particles, &cloud.particles.body, 24, &Domain::open()).unwrap();
    let support =
        DirectedSupport::new(&cloud.particles, Kernel::QuinticSpline, radii, Domain::open());
    let constants = LameConstants::from_young(YOUNG, POISSON).unwrap();
    let law = HyperelasticLaw::linear_elastic(constants);
    let law = Reduced::new(law, StressState::ThreeDimensional).unwrap();
    let gradients = Gradients::PatchConsistent { areas: cloud.areas.clone() };
    let settings = Settings { gradients, hourglass: 0.005, ..Settings::default() };
    let materials = vec![Material { density: 7850.0, law }];
    let particles = cloud.particles.clone();
    let body = Discrete::new(particles, support.unwrap(), &settings, materials).unwrap();
    (cloud, body)
}

fn solve(
    body: &Discrete<3>,
    loads: &[Vector<3>],
    prescribed: Vec<PrescribedDisplacement<3>>,
) -> StaticState<3> {
    let input = StaticsInput { tractions: forces(loads), prescribed, ..StaticsInput::default() };
    let mut statics = Statics::new(body.clone().into(), input).unwrap();
    statics.solve(&LoadSteps::Given(vec![1.0])).unwrap().remove(0)
}

/// Shear traction of (55) on the nodes of the free end, `-P/(2 I) (D^2/4 - y^2)`, consistent with
/// linear fields between them: integrated over the triangles of the face.
fn shear(cloud: &Cloud<3>, intervals: [usize; 3]) -> Vec<Vector<3>> {
    let height = LENGTHS[1];
    let inertia = height * height * height / 12.0;
    let traction = |y: f64| 1000.0 / (2.0 * inertia) * (0.25 * height * height - y * y);
    let mut loads = vec![Vector::<3>::zeros(); cloud.particles.len()];
    let node =
        |j: usize, k: usize| intervals[0] + (intervals[0] + 1) * (j + (intervals[1] + 1) * k);
    for j in 0..intervals[1] {
        for k in 0..intervals[2] {
            let (low, high) = (node(j, k), node(j + 1, k + 1));
            for third in [node(j + 1, k), node(j, k + 1)] {
                integrate(cloud, [low, third, high], &traction, &mut loads);
            }
        }
    }
    loads
}

/// By the centres of 64 parts of a triangle: what that leaves of a cubic, 2e-4, is far below all
/// that is asserted.
fn integrate(
    cloud: &Cloud<3>,
    nodes: [usize; 3],
    traction: &impl Fn(f64) -> f64,
    loads: &mut [Vector<3>],
) {
    let [a, b, c] = nodes.map(|node| cloud.particles.position[node]);
    let area = 0.5 * (b - a).cross(&(c - a)).norm();
    let parts = 8;
    for i in 0..parts {
        for j in 0..parts - i {
            for up in [true, false] {
                if !up && i + j + 1 >= parts {
                    continue;
                }
                let third = if up { 1.0 / 3.0 } else { 2.0 / 3.0 };
                let second = (i as f64 + third) / parts as f64;
                let last = (j as f64 + third) / parts as f64;
                let weights = [1.0 - second - last, second, last];
                let y = a[1] * weights[0] + b[1] * weights[1] + c[1] * weights[2];
                let force = traction(y - 0.5 * LENGTHS[1]) * area / (parts * parts) as f64;
                for (node, weight) in nodes.iter().zip(weights) {
                    loads[*node][1] += force * weight;
                }
            }
        }
    }
}

/// Error of displacements, Dual-support (56), and hourglass over strain energy.
fn bending(intervals: [usize; 3]) -> (f64, f64) {
    let (cloud, body) = beam(intervals);
    let wall = select(&cloud, |x| x[0] == 0.0);
    let mut prescribed: Vec<PrescribedDisplacement<3>> = (0..2)
        .map(|component| {
            let value = growing(move |x| timoshenko(&x)[component]);
            PrescribedDisplacement::component("wall", wall.clone(), component, value)
        })
        .collect();
    prescribed.push(moved(wall[0] as usize, 2, 0.0));
    let state = solve(&body, &shear(&cloud, intervals), prescribed);
    let (mut error, mut size) = (0.0, 0.0);
    for (a, u) in state.displacement.iter().enumerate() {
        let x = cloud.particles.position[a];
        let exact = timoshenko(&x.into());
        let volume = cloud.particles.volume[a];
        // Across, the plate narrows and widens as it is bent, which the plane solution leaves out.
        error += volume * ((u[0] - exact[0]).powi(2) + (u[1] - exact[1]).powi(2));
        size += volume * (exact[0].powi(2) + exact[1].powi(2));
    }
    ((error / size).sqrt(), state.energies[1] / state.energies[0])
}

#[test]
fn the_bending_of_a_cantilever_converges() {
    // 264 and 720 particles, 0.0297 and 0.0077 where this was written.
    let (coarse, coarse_hourglass) = bending([10, 5, 3]);
    let (fine, fine_hourglass) = bending([14, 7, 5]);
    assert!(coarse < 0.03 && fine < 0.02 && fine < coarse, "{coarse} {fine}");
    assert!(coarse_hourglass < 1e-3 && fine_hourglass < 1e-3);
}

#[test]
fn the_bending_of_fine_cantilevers_converges() {
    // 2016 and 11 115 particles, 0.0054 and 0.0034 where this was written.
    for (intervals, most) in [([20, 11, 7], 0.012), ([38, 18, 14], 0.006)] {
        let (error, hourglass) = bending(intervals);
        assert!(error < most && hourglass < 1e-3, "{intervals:?} {error} {hourglass}");
    }
}

/// Dual-support 6.3: 1 MPa along the beam, energy 800 J and 2.6667e-4 m at its end.
#[test]
fn a_cantilever_in_tension_is_exact() {
    let (cloud, body) = beam([10, 5, 3]);
    let wall = select(&cloud, |x| x[0] == 0.0);
    let loads: Vec<Vector<3>> = (cloud.particles.position.iter().zip(&cloud.areas))
        .map(|(x, area)| match x[0] == LENGTHS[0] {
            true => Vector::<3>::new(1e6 * area[0], 0.0, 0.0),
            false => Vector::<3>::zeros(),
        })
        .collect();
    let zero = || growing(|_| 0.0);
    let mut prescribed = vec![PrescribedDisplacement::component("wall", wall, 0, zero())];
    let corner = |y: f64| select(&cloud, |x| x[0] == 0.0 && x[1] == y && x[2] == 0.0);
    prescribed.extend(
        (1..3).map(|i| PrescribedDisplacement::component("corner", corner(0.0), i, zero())),
    );
    prescribed.push(PrescribedDisplacement::component("no turn", corner(3.0), 2, zero()));
    let state = solve(&body, &loads, prescribed);
    assert!((state.energies[0] / 800.0 - 1.0).abs() < 1e-8, "{:?}", state.energies);
    assert!(state.energies[1] < 1e-10, "{:?}", state.energies);
    let end = cloud.particles.position.iter().zip(&state.displacement);
    for (_, u) in end.filter(|(x, _)| x[0] == LENGTHS[0]) {
        assert!((u[0] * 30e9 / 8e6 - 1.0).abs() < 1e-8, "{u}");
    }
}
