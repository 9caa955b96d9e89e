//! Bodies turned into particles.

use std::sync::Arc;

use super::overlap::overlaps;
use super::start;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Body, Case};
use crate::case::source::{Located, Place};
use crate::geometry::{
    Facets, FillReport, GeometryError, LatticeKind, LatticeSpec, Outline, Particles, Placement,
    Shape, fill, from_mesh, from_points, surroundings,
};
use crate::neighbors::{Domain, refuse_coincident};
use crate::operators::{Packing, pack, relax};
use crate::{Tensor, Vector};

/// Points of a cloud that are closer than this fraction of the mean spacing are one point.
const COINCIDENT: f64 = 1e-6;

/// How one body was filled with particles.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyReport {
    /// Its name.
    pub name: String,
    /// Its particles.
    pub particles: usize,
    /// Sum of their quadrature volumes in m^D.
    pub volume: f64,
    /// The exact volume of its shape in m^D, if known.
    pub exact_volume: Option<f64>,
    /// The particle spacing along each axis in m.
    pub spacing: Vec<f64>,
    /// How many times smaller it is in the finest region: 1 without regions of finer spacing.
    pub finest: f64,
    /// How well its particles are packed, if they are.
    pub packing: Option<Packing>,
}

/// A vector of a case as one of `D` components; the reader has checked its length.
pub(super) fn vector<const D: usize>(components: &[f64]) -> Vector<D> {
    Vector::from_column_slice(components)
}

/// The particles of all bodies, and a report on each. A refused body is reported and left out,
/// so that the others are looked at too.
pub(super) fn particles<const D: usize>(
    case: &Case,
    domain: &Domain<D>,
) -> Result<(Particles<D>, Vec<BodyReport>), Vec<Problem>> {
    let mut all = Particles::default();
    let mut reports = Vec::new();
    let mut problems = Vec::new();
    for (number, body) in (0u32..).zip(&case.bodies) {
        let made = made(case, body, domain);
        let added = made.and_then(|(report, packing)| {
            let (particles, volume) = (report.particles.len(), report.total_volume);
            start::check(case, body, particles)?;
            all.append(report.particles, number).map_err(|error| refuse(case, body, &error)).map(
                |()| BodyReport {
                    name: body.name.value.clone(),
                    particles,
                    volume,
                    exact_volume: report.exact_volume,
                    spacing: report.actual_spacing.to_vec(),
                    finest: 1.0,
                    packing,
                },
            )
        });
        match added {
            Ok(report) => reports.push(report),
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() {
        problems = overlaps(case, domain, &all);
    }
    if problems.is_empty() { Ok((all, reports)) } else { Err(problems) }
}

/// The particles of a body in the order of creation, and how well they are packed if they are.
pub(super) fn made<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
) -> Result<(FillReport<D>, Option<Packing>), Problem> {
    let is_packed = body.lattice.kind == model::LatticeKind::Packed;
    match &body.shape.value {
        shape if is_packed && !shape.is_from_file() => {
            packed(case, body, domain).map(|(made, packing)| (made, Some(packing)))
        }
        shape => unpacked(case, body, domain, shape).map(|made| (made, None)),
    }
}

fn refuse(case: &Case, body: &Body, error: &GeometryError) -> Problem {
    let label = format!("body `{}`", body.name.value);
    case.problem_at(body.shape.place, error.to_string(), label, None)
}

/// A body of what a file has, or a program, at a place in the case.
fn cloud<const D: usize>(
    case: &Case,
    domain: &Domain<D>,
    (place, label): (Place, &str),
    read: Result<Particles<D>, GeometryError>,
) -> Result<FillReport<D>, Problem> {
    let refuse = |message: String| case.problem_at(place, message, label, None);
    let particles = read.map_err(|error| refuse(error.to_string()))?;
    let (count, total_volume) = (particles.len(), particles.volume.iter().sum::<f64>());
    if count == 0 {
        return Err(refuse("there are no points".to_owned()));
    }
    let mean = (total_volume / count as f64).powf(1.0 / D as f64);
    // The reader refuses points that are equal; nearly equal ones have no direction between them
    // either, and would make the step vanish.
    refuse_coincident(&particles.position, COINCIDENT * mean, domain)
        .map_err(|error| refuse(error.to_string()))?;
    let actual_spacing = [mean; D];
    let rotation = Tensor::identity();
    Ok(FillReport { particles, total_volume, exact_volume: None, actual_spacing, rotation })
}

/// A body that a lattice fills, displaced by up to `jitter` spacings.
pub(super) fn lattice<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
    jitter: f64,
) -> Result<FillReport<D>, Problem> {
    let (shape, spec) = lattice_of(case, body, domain)?;
    fill(&shape, &LatticeSpec { jitter, ..spec })
        .map_err(|error| refuse_spacing(case, body, &error))
}

/// A body from a file, of points at hand, or on a lattice.
fn unpacked<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
    shape: &model::Shape,
) -> Result<FillReport<D>, Problem> {
    match shape {
        model::Shape::Points { file } => {
            cloud(case, domain, (file.place, "this file"), from_points::<D>(file))
        }
        model::Shape::Cloud { name, cloud: given } => {
            // The reader has checked that they are of this dimension.
            let given = given.as_ref().and_then(|given| given.particles::<D>());
            cloud(case, domain, (name.place, "this cloud"), Ok(given.unwrap_or_default()))
        }
        model::Shape::Mesh { file, spec } => {
            cloud(case, domain, (file.place, "this file"), from_mesh::<D>(file, spec))
        }
        _ => lattice(case, body, domain, body.lattice.jitter)
            .and_then(|made| relaxed(case, body, domain, made)),
    }
}

/// A body whose particles are packed, and how well.
fn packed<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
) -> Result<(FillReport<D>, Packing), Problem> {
    let (shape, spec) = lattice_of(case, body, domain)?;
    if spec.periodic.contains(&true) {
        let message = "packed particles cannot cross a periodic boundary; use a lattice";
        let label = format!("body `{}`", *body.name);
        return Err(case.problem_at(body.shape.place, message, label, None));
    }
    if body.shape.has_seams() {
        let message = "packed particles stay away from all faces, also from those inside a union, where \
             its shapes meet; use a lattice, or one outline or surface around all of it";
        let label = format!("body `{}`", *body.name);
        return Err(case.problem_at(body.shape.place, message, label, None));
    }
    if spec.spacing.iter().any(|spacing| *spacing != spec.spacing[0]) {
        let (what, value) = ("packed particles have", spec.spacing.to_vec());
        return Err(refuse_spacing(case, body, &GeometryError::Uneven { what, value }));
    }
    pack(&shape, spec.spacing[0]).map_err(|error| {
        let label = format!("spacing of body `{}`", *body.name);
        case.problem_at(body.spacing.place, error.to_string(), label, None)
    })
}

/// What the user should know of packed bodies.
pub(super) fn packings(bodies: &[BodyReport]) -> Vec<String> {
    let told = |report: &BodyReport| {
        let packing = report.packing?;
        let Packing { steps, push, largest, rms, .. } = packing;
        let name = &report.name;
        if !packing.is_settled {
            return Some(format!(
                "the particles of the body `{name}` have not settled after {steps} steps of packing, the next of which would move one \
                 by {push:.1e} spacings: change the spacing a little, or use a lattice"
            ));
        }
        (largest > Packing::UNEVEN).then(|| {
            format!(
                "the density of the packed body `{name}` is up to {:.1} % off near its surface ({:.1} % in the mean square): \
                 make the spacing smaller, or round off what is sharper or thinner than three spacings",
                100.0 * largest,
                100.0 * rms
            )
        })
    };
    bodies.iter().filter_map(told).collect()
}

/// The sites of the lattice of a body that lie around it, at most `reach` m away.
pub(super) fn around<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
    reach: f64,
) -> Result<Particles<D>, Problem> {
    let (shape, spec) = lattice_of(case, body, domain)?;
    if body.lattice.kind == model::LatticeKind::Packed {
        return Err(refuse_spacing(case, body, &GeometryError::NoSurroundings));
    }
    surroundings(&shape, &spec, reach).map_err(|error| refuse_spacing(case, body, &error))
}

/// The corners of the box around places; turned inside out where there are none.
pub(super) fn box_around<'a, const D: usize>(
    places: impl IntoIterator<Item = &'a Vector<D>>,
) -> (Vector<D>, Vector<D>) {
    let ends = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    places.into_iter().fold(ends, |(least, most), x| (least.inf(x), most.sup(x)))
}

/// The body of fluid whose spacing another one has: that of another system, which is a wall to the fluid.
pub(super) fn lender<'a>(case: &'a Case, body: &Body) -> Option<&'a Body> {
    let lender = case.bodies.iter().find(|other| other.spacing.place == body.spacing.place);
    lender.filter(|other| other.name.value != body.name.value)
}

/// What to do about the size of a solid, to which a body of fluid has lent its spacing.
pub(super) fn wall_of_solid(lender: &Body) -> String {
    format!(
        "to the fluid `{}` the solid is a wall of the same spacing: make its sizes multiples of that",
        *lender.name
    )
}

fn refuse_spacing(case: &Case, body: &Body, error: &GeometryError) -> Problem {
    if matches!(error, GeometryError::TurnedPeriodic | GeometryError::NotRound) {
        return refuse(case, body, error);
    }
    if let Some(lender) = lender(case, body) {
        let label = format!("body `{}`", body.name.value);
        let help = wall_of_solid(lender);
        return case.problem_at(body.shape.place, error.to_string(), label, Some(help));
    }
    let label = format!("spacing of body `{}`", body.name.value);
    case.problem_at(body.spacing.place, error.to_string(), label, None)
}

/// The shape of a body and the lattice that fills it, without jitter.
fn lattice_of<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
) -> Result<(Shape<D>, LatticeSpec<D>), Problem> {
    let shape = shape(case, body, &body.shape)?;
    let (min, max) = shape.bounding_box();
    // Along a periodic axis a body that spans the box meets itself: its last layer is its first.
    let periodic = std::array::from_fn(|axis| {
        domain.periodic()[axis].is_some_and(|[low, high]| {
            let slack = 1e-9 * (high - low);
            min[axis] <= low + slack && max[axis] >= high - slack
        })
    });
    let spec = LatticeSpec {
        spacing: std::array::from_fn(|axis| body.spacing[axis]),
        kind: match body.lattice.kind {
            // What is packed starts from a square lattice.
            model::LatticeKind::Square | model::LatticeKind::Packed => LatticeKind::Square,
            model::LatticeKind::Hexagonal => LatticeKind::Hexagonal,
            model::LatticeKind::Concentric => LatticeKind::Concentric,
        },
        placement: match body.lattice.on {
            model::LatticeOrigin::Boundary => Placement::Boundary,
            model::LatticeOrigin::Cells => Placement::Cells,
        },
        periodic,
        jitter: 0.0,
        seed: body.lattice.seed,
    };
    Ok((shape, spec))
}

/// The particles of a lattice, moved apart as often as the case says.
fn relaxed<const D: usize>(
    case: &Case,
    body: &Body,
    domain: &Domain<D>,
    mut made: FillReport<D>,
) -> Result<FillReport<D>, Problem> {
    if body.lattice.relax == 0 {
        return Ok(made);
    }
    let shape = shape::<D>(case, body, &body.shape)?;
    let sites = lattice(case, body, domain, 0.0)?.particles;
    // Sites on faces, or half a spacing inside of them, hold those further inside back.
    let is_inside = |(x, spacing): (&Vector<D>, &f64)| shape.depth(x) > 0.75 * spacing;
    let free: Vec<bool> = sites.position.iter().zip(&sites.spacing).map(is_inside).collect();
    let steps = body.lattice.relax;
    let stays = |x: &Vector<D>| shape.contains(&domain.wrap(x));
    relax(&mut made.particles, &sites.position, &free, &stays, domain, steps).map_err(|error| {
        let label = format!("lattice of body `{}`", body.name.value);
        case.problem_at(body.spacing.place, error.to_string(), label, None)
    })?;
    Ok(made)
}

/// Parts of a body that have fewer layers of particles are told.
const THIN: f64 = 3.0;

/// Most pairs of facets that cross each other which are counted.
const MOST_CROSSINGS: usize = 1000;

/// The facets of a file, which is read once.
fn facets_of(surface: &model::Surface) -> Result<Arc<Facets>, GeometryError> {
    if let Some(facets) = surface.facets.get() {
        return Ok(facets.clone());
    }
    let facets = Arc::new(Facets::from_file(&surface.file, &surface.arrangement)?);
    Ok(surface.facets.get_or_init(|| facets).clone())
}

/// What the user should know of surfaces from files.
pub(super) fn surfaces(case: &Case) -> Vec<String> {
    let (mut told, mut seen) = (Vec::new(), Vec::new());
    let all = case.bodies.iter().flat_map(|body| body.shape.surfaces());
    for surface in all {
        let Some(facets) = surface.facets.get() else { continue };
        if seen.iter().any(|other| Arc::ptr_eq(other, facets)) {
            continue;
        }
        seen.push(facets.clone());
        let mut tell = |text: String| told.push(format!("`{}`: {text}", surface.file.display()));
        if !facets.soundness().is_sound() {
            tell(facets.soundness().to_string());
        }
        let pairs = match facets.crossings(MOST_CROSSINGS) {
            0 => continue,
            1 => "1 pair of facets intersects",
            MOST_CROSSINGS => &format!("at least {MOST_CROSSINGS} pairs of facets intersect"),
            count => &format!("{count} pairs of facets intersect"),
        };
        let first = facets.first_crossing();
        let first = first.map(|(spot, other)| format!(", first facet {other} and {spot}"));
        tell(format!("{pairs}{}", first.unwrap_or_default()));
    }
    for body in &case.bodies {
        let spacing = body.spacing.iter().copied().fold(0.0, f64::max);
        let mut shape = &body.shape.value;
        while let model::Shape::Turned { of, .. } = shape {
            shape = of;
        }
        let thinnest = match shape {
            // What is cut out of a body is no part of it.
            model::Shape::Surface(surface) => {
                let thinnest = surface.facets.get().and_then(|it| it.thinner_than(THIN * spacing));
                thinnest.map(|(thickness, spot)| {
                    (thickness, format!(" where it is thinnest, behind {spot}"))
                })
            }
            // That of a wall that does not hold has a warning of its own.
            model::Shape::Layer { thickness, .. }
                if body.wall.is_none() && *thickness < THIN * spacing =>
            {
                Some((*thickness, String::new()))
            }
            _ => None,
        };
        if let Some((thickness, place)) = thinnest {
            let layers = thickness / spacing;
            let thin = match layers < 0.05 {
                true => "has no thickness".to_owned(),
                false => format!("is {layers:.1} spacings thick"),
            };
            let other = match case.bodies.iter().any(|other| other.wall.is_some()) {
                true => ", or expect fluid on one side to interact with that on the other",
                false => "",
            };
            told.push(format!(
                "the body `{}` {thin}{place}, less than {THIN}: make the spacing \
                 smaller{other}",
                *body.name
            ));
        }
    }
    told
}

pub(super) fn shape<const D: usize>(
    case: &Case,
    body: &Body,
    located: &Located<model::Shape>,
) -> Result<Shape<D>, Problem> {
    let all = |shapes: &[Located<model::Shape>]| -> Result<Vec<Shape<D>>, Problem> {
        shapes.iter().map(|part| shape(case, body, part)).collect()
    };
    let built = match &located.value {
        model::Shape::Box { min, max } => Shape::cuboid(vector(min), vector(max)),
        model::Shape::Ball { center, radius } => Shape::ball(vector(center), *radius),
        model::Shape::Annulus { center, inner, outer } => {
            Shape::annulus(vector(center), *inner, *outer)
        }
        model::Shape::Cylinder { start, end, radius } => {
            Shape::cylinder(vector(start), vector(end), *radius)
        }
        model::Shape::Polygon { corners, ends } => {
            let corners = corners.iter().map(|corner| Vector::<2>::from(*corner)).collect();
            Shape::polygon(corners, *ends)
        }
        model::Shape::Outline { file, scale, shift, ends } => {
            Outline::read(file, *scale, (*shift).into()).and_then(|outline| outline.shape(*ends))
        }
        model::Shape::Surface(surface) => facets_of(surface).and_then(Shape::surface),
        model::Shape::Turned { of, angle, about, axis } => {
            shape(case, body, of)?.turned(*angle, vector(about), (*axis).into())
        }
        model::Shape::Layer { of, thickness, side } => {
            shape(case, body, of)?.layer(*thickness, *side)
        }
        model::Shape::Union(parts) => Shape::union(all(parts)?),
        model::Shape::Intersection(parts) => Shape::intersection(all(parts)?),
        model::Shape::Difference { from, remove } => {
            Shape::difference(shape(case, body, from)?, all(remove)?)
        }
        model::Shape::Points { .. } | model::Shape::Cloud { .. } | model::Shape::Mesh { .. } => {
            let help = "make it a body of its own".to_owned();
            return Err(case.problem_at(
                located.place,
                "points cannot be combined with other shapes",
                "inside another shape",
                Some(help),
            ));
        }
    };
    built.map_err(|error| {
        let label = format!("shape of body `{}`", body.name.value);
        case.problem_at(located.place, error.to_string(), label, None)
    })
}
