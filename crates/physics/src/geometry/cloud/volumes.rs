//! What of a body is whose.

use super::cells::{Piece, Solid, place};
use super::{CloudPoints, CloudSpec, CloudVolumes, Fault, Numbers};
use crate::Vector;
use crate::geometry::mesh::{Mesh, MeshFault};
use crate::geometry::{Particles, Surface};

/// Largest relative difference of volumes from a file from those of the cells.
const SAME: f64 = 1e-4;

/// Parts along an edge of the points by which the nearest node is found.
const PARTS: usize = 8;

/// The particles, with volumes, weights and spacings.
pub(super) fn particles<const D: usize>(
    mesh: &Mesh,
    solids: &[Solid<D>],
    numbers: &Numbers,
    spec: &CloudSpec,
) -> Result<Particles<D>, Fault> {
    let mut position = vec![Vector::zeros(); numbers.count];
    let mut volume = vec![0.0; numbers.count];
    // Share of the full angle that the body fills around a particle.
    let mut angle = vec![1.0; numbers.count];
    match spec.points {
        CloudPoints::Cells => {
            for (number, solid) in solids.iter().enumerate() {
                position[number] = centroid(solid);
                volume[number] = solid.measure;
            }
        }
        CloudPoints::Nodes => {
            angle.fill(0.0);
            let points = spread::<D>();
            for (node, own) in (0u32..).zip(&numbers.of_node) {
                own.iter().for_each(|&a| position[a as usize] = place(mesh, node));
            }
            let own = |node: u32| numbers.of_node[node as usize].map(|a| a as usize);
            for solid in solids {
                let nodes = mesh.cells[solid.cell].nodes();
                for piece in &solid.pieces {
                    match spec.volumes {
                        CloudVolumes::Nearest => {
                            nearest(&points, piece, nodes, &position, own, &mut volume)
                        }
                        _ => lump(piece, own, &mut volume),
                    }
                    for corner in piece.corners.iter().filter(|corner| corner.nodes.len() == 1) {
                        if let Some(a) = own(corner.nodes[0]) {
                            angle[a] += angle_at(piece, &corner.place);
                        }
                    }
                }
            }
        }
    }
    if let CloudVolumes::Array(name) = &spec.volumes {
        let exact = solids.iter().map(|solid| solid.measure).sum();
        volume = volumes(mesh, solids, numbers, name, exact)?;
    }
    let share = |angle: f64| if angle > 1.0 - 1e-9 { 1.0 } else { angle };
    let weight: Vec<f64> = volume.iter().zip(&angle).map(|(v, angle)| v / share(*angle)).collect();
    let spacing = match &spec.spacings {
        Some(name) => from_array(mesh, solids, numbers, name)?,
        None => weight.iter().map(|weight| weight.powf(1.0 / D as f64)).collect(),
    };
    Ok(Particles {
        spacing,
        body: vec![0; numbers.count],
        id: (0..numbers.count as u32).collect(),
        position,
        volume,
        weight,
        surface: Surface::default(),
    })
}

fn centroid<const D: usize>(solid: &Solid<D>) -> Vector<D> {
    let centre = |piece: &Piece<D>| -> Vector<D> {
        piece.corners.iter().map(|corner| corner.place).sum::<Vector<D>>() / (D + 1) as f64
    };
    let sum: Vector<D> = solid.pieces.iter().map(|piece| centre(piece) * piece.measure).sum();
    sum / solid.measure
}

/// Each corner of a piece takes the same, and hands it on to the nodes it is the mean of.
fn lump<const D: usize>(piece: &Piece<D>, own: impl Fn(u32) -> Option<usize>, volume: &mut [f64]) {
    for corner in &piece.corners {
        let share = piece.measure / (D + 1) as f64 / corner.nodes.len() as f64;
        for a in corner.nodes.iter().filter_map(|&node| own(node)) {
            volume[a] += share;
        }
    }
}

/// Points spread evenly over a piece go to the nearest node of the cell.
fn nearest<const D: usize>(
    points: &[[f64; 4]],
    piece: &Piece<D>,
    nodes: &[u32],
    position: &[Vector<D>],
    own: impl Fn(u32) -> Option<usize>,
    volume: &mut [f64],
) {
    let near: Vec<usize> = nodes.iter().filter_map(|&node| own(node)).collect();
    let places: Vec<Vector<D>> = piece.corners.iter().map(|corner| corner.place).collect();
    let part = piece.measure / points.len() as f64;
    for weights in points {
        let point: Vector<D> = places.iter().zip(weights).map(|(x, weight)| x * *weight).sum();
        let distance = |a: usize| (position[a] - point).norm_squared();
        let least = near.iter().map(|&a| distance(a)).fold(f64::INFINITY, f64::min);
        // Points half-way between nodes are shared.
        let is_closest = |a: &usize| distance(*a) <= least * (1.0 + 1e-9);
        let closest: Vec<usize> = near.iter().copied().filter(is_closest).collect();
        closest.iter().for_each(|&a| volume[a] += part / closest.len() as f64);
    }
}

/// Points of a simplex by their weights: centres of the like-turned parts of an even subdivision.
fn spread<const D: usize>() -> Vec<[f64; 4]> {
    let mut points = Vec::new();
    let weight = |steps: usize| (steps as f64 + 1.0 / (D + 1) as f64) / PARTS as f64;
    for number in 0..PARTS.pow(D as u32) {
        let mut left = PARTS - 1;
        let mut weights = [0.0; 4];
        let fits = (0..D).all(|k| {
            let steps = number / PARTS.pow(k as u32) % PARTS;
            weights[k] = weight(steps);
            let fits = steps <= left;
            left = left.saturating_sub(steps);
            fits
        });
        if fits {
            weights[D] = weight(left);
            points.push(weights);
        }
    }
    points
}

/// Share of the full angle of a piece at one of its corners.
fn angle_at<const D: usize>(piece: &Piece<D>, corner: &Vector<D>) -> f64 {
    use std::f64::consts::PI;
    let edges: Vec<Vector<D>> = piece
        .corners
        .iter()
        .map(|other| other.place - corner)
        .filter(|edge| edge.norm_squared() > 0.0)
        .map(|edge| edge.normalize())
        .collect();
    match (D, &edges[..]) {
        (1, _) => 0.5,
        (2, [a, b]) => a.dot(b).clamp(-1.0, 1.0).acos() / (2.0 * PI),
        (3, [a, b, c]) => {
            // The solid angle of three directions, by Van Oosterom and Strackee.
            let across =
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let volume: f64 = across.iter().zip(c.iter()).map(|(x, y)| x * y).sum();
            let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
            2.0 * volume.abs().atan2(below) / (4.0 * PI)
        }
        _ => 0.0,
    }
}

/// Volumes of an array, which sum to `exact` m^D.
fn volumes<const D: usize>(
    mesh: &Mesh,
    solids: &[Solid<D>],
    numbers: &Numbers,
    name: &str,
    exact: f64,
) -> Result<Vec<f64>, Fault> {
    let mut volume = from_array(mesh, solids, numbers, name)?;
    let sum: f64 = volume.iter().sum();
    if !((sum / exact - 1.0).abs() <= SAME) {
        return Err((None, MeshFault::Sum { name: name.to_owned(), sum, volume: exact }));
    }
    volume.iter_mut().for_each(|v| *v *= exact / sum);
    Ok(volume)
}

/// The numbers of an array for all particles, which must be positive.
fn from_array<const D: usize>(
    mesh: &Mesh,
    solids: &[Solid<D>],
    numbers: &Numbers,
    name: &str,
) -> Result<Vec<f64>, Fault> {
    let is_of_nodes = numbers.points == CloudPoints::Nodes;
    let (data, what, of) = match is_of_nodes {
        true => (&mesh.node_data, "node", "nodes"),
        false => (&mesh.cell_data, "cell", "cells"),
    };
    let Some(values) = data.get(name) else {
        let (name, known) = (name.to_owned(), super::sets::listed(data.keys()));
        return Err((None, MeshFault::NoArray { name, what: of, known }));
    };
    let mut found = vec![0.0; numbers.count];
    if is_of_nodes {
        for (own, value) in numbers.of_node.iter().zip(values) {
            own.iter().for_each(|&a| found[a as usize] = *value);
        }
    } else {
        solids.iter().zip(&mut found).for_each(|(solid, own)| *own = values[solid.cell]);
    }
    let bad = found.iter().enumerate().find(|(_, value)| !(**value > 0.0 && value.is_finite()));
    if let Some((a, &got)) = bad {
        let node = || numbers.of_node.iter().position(|own| *own == Some(a as u32));
        let number = match is_of_nodes {
            true => node().unwrap_or(a) as u64,
            false => mesh.cells[solids[a].cell].number,
        };
        return Err((None, MeshFault::NotPositive { name: name.to_owned(), what, number, got }));
    }
    Ok(found)
}
