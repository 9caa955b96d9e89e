//! What of a body belongs to which particle: volumes and areas sum to those of the body.

use piola::geometry::{CloudSpec, CloudVolumes, Particles, from_mesh};
use piola::neighbors::Domain;
use piola::operators::{DirectedSupport, DualGradient, Face, Trace, nearest_radii};
use piola::{Tensor, Vector};
use piola_formulas::kernels::Kernel;

use crate::{CELLS, MIXED, NODES, data, from_bytes};

fn volume<const D: usize>(particles: &Particles<D>) -> f64 {
    particles.volume.iter().sum()
}

/// Areas close the volume: they sum to zero, and times the places to the volume.
fn closes<const D: usize>(particles: &Particles<D>, areas: &[Vector<D>]) {
    let sum: Vector<D> = areas.iter().sum();
    let moment: Tensor<D> =
        areas.iter().zip(&particles.position).map(|(area, x)| area * x.transpose()).sum();
    let misfit = (moment / volume(particles) - Tensor::identity()).amax();
    assert!(sum.amax() < 1e-13 && misfit < 1e-13, "{sum} {misfit}");
}

#[test]
fn nodes_share_volumes_and_faces_exactly() {
    for (name, expected) in [("triangles-41.msh", 2.0), ("quads.msh", 2.0)] {
        let particles = from_mesh::<2>(&data(name), &NODES).unwrap();
        assert!((volume(&particles) - expected).abs() < 1e-12, "{name}");
        closes(&particles, &particles.surface.areas(particles.len()));
    }
    let particles = from_mesh::<3>(&data("tets-41.msh"), &NODES).unwrap();
    assert!((volume(&particles) - 2.0).abs() < 1e-12);
    closes(&particles, &particles.surface.areas(particles.len()));
    // Bent faces too.
    let particles = from_bytes::<3>(MIXED.as_bytes(), &NODES).unwrap();
    closes(&particles, &particles.surface.areas(particles.len()));
}

/// First moments of volumes are those of the body, as the shares are those of linear functions.
#[test]
fn shares_of_nodes_have_the_centroid_of_the_body() {
    let particles = from_mesh::<3>(&data("tets-41.msh"), &NODES).unwrap();
    let sum: Vector<3> =
        particles.position.iter().zip(&particles.volume).map(|(x, v)| x * *v).sum();
    assert!((sum / 2.0 - Vector::<3>::new(1.0, 0.5, 0.5)).amax() < 1e-12, "{sum}");
}

#[test]
fn faces_of_cells_close_the_volume_by_their_trace() {
    let check = |particles: Particles<3>, count: usize| {
        let domain = Domain::open();
        let radii = nearest_radii(&particles, &particles.body, count, &domain).unwrap();
        let support =
            DirectedSupport::new(&particles, Kernel::QuinticSpline, radii, domain).unwrap();
        let plain = DualGradient::plain(&particles, &support).unwrap();
        let face = |face: &piola::geometry::BoundaryFace<3>| Face {
            owner: face.particles[0],
            place: face.place,
            area: face.area,
        };
        let faces = particles.surface.faces.iter().map(face).collect();
        let trace = Trace::new(faces, &particles, &support, &plain);
        let areas = trace.areas(particles.len());
        let sum: Vector<3> = areas.iter().sum();
        let moment: Tensor<3> =
            areas.iter().zip(&particles.position).map(|(area, x)| area * x.transpose()).sum();
        let misfit = (moment / volume(&particles) - Tensor::identity()).amax();
        assert!(sum.amax() < 1e-11 && misfit < 1e-11, "{sum} {misfit}");
    };
    check(from_mesh::<3>(&data("tets-41.msh"), &CELLS).unwrap(), 24);
}

/// Bent faces of four corners are parts of their own, so that the sum over faces of area times
/// centre is the volume.
#[test]
fn bent_faces_are_summed_exactly() {
    let particles = from_bytes::<3>(MIXED.as_bytes(), &CELLS).unwrap();
    assert_eq!(particles.len(), 3);
    let faces = &particles.surface.faces;
    let moment: Tensor<3> = faces.iter().map(|face| face.area * face.place.transpose()).sum();
    let sum: Vector<3> = faces.iter().map(|face| face.area).sum();
    let misfit = (moment / volume(&particles) - Tensor::identity()).amax();
    assert!(sum.amax() < 1e-14 && misfit < 1e-13, "{sum} {misfit}");
    // Four outer faces of the hexahedron besides its bent top, two of the wedge besides its slant,
    // which the pyramid has, four triangles of that.
    assert!(faces.len() > 10, "{}", faces.len());
}

/// On a regular mesh whole cells are the kernel weights, as on a lattice.
#[test]
fn weights_of_nodes_are_whole_cells() {
    let mut mesh = String::from(
        "# vtk DataFile Version 3.0\nsquares\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 16 double\n",
    );
    let number = |i: usize, j: usize| i + 4 * j;
    for j in 0..4 {
        (0..4).for_each(|i| mesh += &format!("{i} {j} 0\n"));
    }
    mesh += "CELLS 9 45\n";
    for j in 0..3 {
        for i in 0..3 {
            let [a, b, c, d] =
                [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            mesh += &format!("4 {a} {b} {c} {d}\n");
        }
    }
    mesh += "CELL_TYPES 9\n9 9 9 9 9 9 9 9 9\n";
    for volumes in [CloudVolumes::Cells, CloudVolumes::Nearest] {
        let spec = CloudSpec { volumes, ..NODES };
        let particles = from_bytes::<2>(mesh.as_bytes(), &spec).unwrap();
        for (a, x) in particles.position.iter().enumerate() {
            let is_end = |x: f64| x == 0.0 || x == 3.0;
            let half = |x: f64| if is_end(x) { 0.5 } else { 1.0 };
            assert!((particles.volume[a] - half(x[0]) * half(x[1])).abs() < 1e-12);
            assert!((particles.weight[a] - 1.0).abs() < 1e-12 && particles.spacing[a] > 0.999);
        }
    }
}

#[test]
fn what_is_nearest_sums_to_the_body_and_differs_from_equal_shares() {
    let nearest = CloudSpec { volumes: CloudVolumes::Nearest, ..NODES };
    let (a, b) = (
        from_mesh::<3>(&data("tets-41.msh"), &nearest).unwrap(),
        from_mesh::<3>(&data("tets-41.msh"), &NODES).unwrap(),
    );
    assert!((volume(&a) - 2.0).abs() < 1e-12);
    let differ = a.volume.iter().zip(&b.volume).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(differ > 1e-3 * a.volume[0], "{differ}");
}

/// Sums over faces are exact for polynomials of the fourth degree.
#[test]
fn sums_over_faces_are_exact() {
    let particles = from_mesh::<3>(&data("tets-41.msh"), &NODES).unwrap();
    let (mut sum, mut moment) = (0.0, 0.0);
    for face in particles.surface.faces.iter().filter(|face| face.place[0] > 2.0 - 1e-9) {
        for sample in face.samples() {
            let value = sample.place[1].powi(3);
            sum += sample.area.norm() * value;
            for (particle, share) in sample.shares {
                moment +=
                    sample.area.norm() * value * share * particles.position[particle as usize][1];
            }
        }
    }
    assert!((sum - 0.25).abs() < 1e-12 && (moment - 0.2).abs() < 1e-12, "{sum} {moment}");
}
