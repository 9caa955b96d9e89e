//! Bodies: shapes, lattices, materials and initial state; and regions.

use std::sync::Arc;

use super::*;
use nalgebra::{Rotation3, Unit, Vector3};
use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

use crate::case::expression::Expression;
use crate::case::model::{
    Body, Initial, Lattice, LatticeKind, LatticeOrigin, Material, PlaneState, Region, Shape,
    Stiffness, Surface,
};
use crate::geometry::{Arrangement, CloudPoints, CloudSpec, CloudVolumes, LayerSide};

/// The keys that give the stiffness of a material, of which one is needed.
const STIFFNESSES: [&str; 3] = ["bulk_modulus", "wave_speed", "young_modulus"];

impl Reader<'_, '_> {
    pub(super) fn body(&mut self, record: &Record) -> Option<Body> {
        let shape = record.record("shape").and_then(|shape| self.shape(shape));
        let material = self.body_material(record);
        let lattice = record.record("lattice").and_then(|lattice| self.lattice(lattice));
        let initial = record.record("initial").and_then(|initial| self.initial(initial));
        let spacing = self.spacing(record, shape.as_ref());
        Some(Body {
            name: record.text("name")?,
            shape: shape?,
            spacing: spacing?,
            lattice: lattice?,
            material: material?,
            initial: initial?,
            wall: record.record("wall").and_then(fluids::wall),
            opening: match record.record("opening") {
                Some(opening) => {
                    self.meaningless(
                        record,
                        "initial",
                        "in the buffer of an opening, which begins as the fluid",
                    );
                    Some(self.opening(opening)?)
                }
                None => None,
            },
            system: None,
        })
    }

    /// The spacing, which a body that is read from a file does without.
    fn spacing(
        &mut self,
        record: &Record,
        shape: Option<&Located<Shape>>,
    ) -> Option<Located<Vec<f64>>> {
        if record.has("spacing") {
            return record.numbers("spacing");
        }
        if shape?.value.is_from_file() {
            return Some(Located::new(Vec::new(), record.place));
        }
        // A misspelt key has been reported as such.
        let meant = "did you mean `spacing`?";
        if self.context.problems.iter().any(|problem| problem.help.as_deref() == Some(meant)) {
            return None;
        }
        let message = "[[body]] needs the key `spacing`: distance between particles";
        self.refuse(Problem::new(record.place, message, "`spacing` is missing"))
    }

    fn mesh(&mut self, record: &Record) -> Option<Shape> {
        let points = match record.text("points")?.as_str() {
            "cells" => CloudPoints::Cells,
            _ => CloudPoints::Nodes,
        };
        let array = record.text("array");
        let volumes = match (record.text("volumes")?.as_str(), array) {
            ("array", Some(name)) => CloudVolumes::Array(name.value),
            ("array", None) => {
                let message = "`volumes = \"array\"` needs the key `array`";
                let place = record.key_place("volumes").unwrap_or(record.place);
                return self.refuse(Problem::new(place, message, "of which array?"));
            }
            (kind, _) => {
                self.meaningless(record, "array", "without `volumes = \"array\"`");
                if kind == "nearest" { CloudVolumes::Nearest } else { CloudVolumes::Cells }
            }
        };
        let spacings = record.text("spacings").map(|name| name.value);
        let part = record.text("part").map(|name| name.value);
        let file = self.file(record, "file")?;
        Some(Shape::Mesh { file, spec: CloudSpec { points, volumes, spacings, part } })
    }

    fn lattice(&mut self, record: &Record) -> Option<Lattice> {
        let kind = record.text("kind")?;
        if kind.as_str() == "packed" {
            for key in ["on", "jitter", "seed", "relax"] {
                self.meaningless(record, key, "for packed particles");
            }
        }
        Some(Lattice {
            kind: match kind.as_str() {
                "hexagonal" => LatticeKind::Hexagonal,
                "concentric" => LatticeKind::Concentric,
                "packed" => LatticeKind::Packed,
                _ => LatticeKind::Square,
            },
            on: match record.text("on")?.as_str() {
                "cells" => LatticeOrigin::Cells,
                _ => LatticeOrigin::Boundary,
            },
            jitter: number(record, "jitter")?,
            seed: record.whole("seed")?.value,
            relax: record.whole("relax")?.value,
        })
    }

    fn shape(&mut self, record: &Record) -> Option<Located<Shape>> {
        let shape = match record.kind {
            "box" => {
                let (min, max) = self.corners(record)?;
                Shape::Box { min, max }
            }
            "ball" => {
                Shape::Ball { center: vector(record, "center")?, radius: number(record, "radius")? }
            }
            "annulus" => {
                let (inner, outer) = (record.number("inner")?, record.number("outer")?);
                if inner.value >= outer.value {
                    let message = format!(
                        "the outer radius {} must be larger than the inner radius {}",
                        outer.value, inner.value
                    );
                    return self.refuse(Problem::new(outer.place, message, "too small"));
                }
                let center = vector(record, "center")?;
                Shape::Annulus { center, inner: inner.value, outer: outer.value }
            }
            "cylinder" => {
                let (start, end) = (vector(record, "start")?, record.numbers("end")?);
                if start == end.value {
                    let message = "`start` and `end` of a cylinder must differ";
                    return self.refuse(Problem::new(end.place, message, "the same as `start`"));
                }
                Shape::Cylinder { start, end: end.value, radius: number(record, "radius")? }
            }
            "polygon" => {
                let corners = record.list("corners").iter();
                let corners: Option<Vec<_>> = corners.map(|it| it.value.as_pair()).collect();
                Shape::Polygon { corners: corners?, ends: self.ends_along_z(record)? }
            }
            "outline" => {
                let shift = record.ends("move").map_or([0.0; 2], |shift| shift.value);
                Shape::Outline {
                    file: self.file(record, "file")?,
                    scale: number(record, "scale")?,
                    shift,
                    ends: self.ends_along_z(record)?,
                }
            }
            "surface" => {
                let axis = match record.has("axis") {
                    true => self.unit(record, "axis")?,
                    false => vec![0.0, 0.0, 1.0],
                };
                let axis = Unit::new_normalize(Vector3::from_column_slice(&axis));
                let rotation = Rotation3::from_axis_angle(&axis, number(record, "angle")?);
                let shift = vector(record, "move").unwrap_or_else(|| vec![0.0; 3]);
                let shift = Vector3::from_column_slice(&shift);
                let arrangement = Arrangement { scale: number(record, "scale")?, rotation, shift };
                let file = self.file(record, "file")?;
                let known = self
                    .surfaces
                    .iter()
                    .find(|known| *known.file == *file && known.arrangement == arrangement);
                let facets = known.map_or_else(Arc::default, |known| known.facets.clone());
                let surface = Surface { file, arrangement, facets };
                self.surfaces.push(surface.clone());
                Shape::Surface(surface)
            }
            "turned" => {
                let of = record.record("of").and_then(|of| self.shape(of));
                let about = record.numbers("about");
                let axis = match (self.dimension, record.has("axis")) {
                    (3, true) => self.unit(record, "axis")?.try_into().ok()?,
                    (3, false) => {
                        let message = "a turned shape in 3D needs the key `axis`: a direction";
                        let problem = Problem::new(record.place, message, "`axis` is missing");
                        return self.refuse(problem);
                    }
                    _ => {
                        self.meaningless(record, "axis", "in 2D, where it is z");
                        [0.0, 0.0, 1.0]
                    }
                };
                let about = about.map_or_else(|| vec![0.0; self.dimension], |about| about.value);
                Shape::Turned { of: Box::new(of?), angle: number(record, "angle")?, about, axis }
            }
            "layer" => {
                let of = record.record("of").and_then(|of| self.shape(of))?;
                if of.is_composed() {
                    let message = "a layer follows the boundary of one shape, not of several or of another layer";
                    let help = "make a layer of each shape, and combine the layers";
                    return self.refuse(Problem::new(of.place, message, "this shape").help(help));
                }
                let side = match record.text("side")?.as_str() {
                    "inside" => LayerSide::Inside,
                    _ => LayerSide::Outside,
                };
                Shape::Layer { of: Box::new(of), thickness: number(record, "thickness")?, side }
            }
            "union" => Shape::Union(self.shapes(record, "of")?),
            "intersection" => Shape::Intersection(self.shapes(record, "of")?),
            "difference" => {
                let from = record.record("from").and_then(|from| self.shape(from));
                let remove = self.shapes(record, "remove");
                Shape::Difference { from: Box::new(from?), remove: remove? }
            }
            "points" => self.points(record)?,
            "mesh" => self.mesh(record)?,
            _ => return None,
        };
        Some(Located::new(shape, record.place))
    }

    /// The points of a file, or those that stand for a name.
    fn points(&mut self, record: &Record) -> Option<Shape> {
        let name = record.text("file")?;
        let Some(own) = name.value.strip_prefix(MARK) else {
            return Some(Shape::Points { file: self.file(record, "file")? });
        };
        let Some(known) = self.setting.clouds else {
            return Some(Shape::Cloud { name, cloud: None });
        };
        let Some(cloud) = known.get(own).cloned() else {
            let message = format!("there is no cloud `{}`", name.value);
            let problem = Problem::new(name.place, message, "unknown cloud");
            let help =
                "write the name of a CSV file; clouds are given by a program that uses the library";
            return self.refuse(problem.help(help));
        };
        if cloud.dimension() != self.dimension {
            let (got, expected) = (cloud.dimension(), self.dimension);
            let message =
                format!("the cloud `{}` is in {got}D and the case in {expected}D", name.value);
            return self.refuse(Problem::new(name.place, message, "not of this dimension"));
        }
        Some(Shape::Cloud { name, cloud: Some(cloud) })
    }

    /// The ends along z of what is drawn in the plane: in 3D two, in 2D none.
    fn ends_along_z(&mut self, record: &Record) -> Option<Option<[f64; 2]>> {
        let ends = record.ends("z").map(|ends| ends.value);
        if self.dimension == 3 && ends.is_none() {
            let message =
                format!("a shape of kind `{}` in 3D needs the key `z`: its two ends", record.kind);
            return self.refuse(Problem::new(record.place, message, "`z` is missing"));
        }
        if self.dimension == 2 {
            self.meaningless(record, "z", "in 2D");
        }
        Some(ends)
    }

    pub(super) fn shapes(&mut self, record: &Record, key: &str) -> Option<Vec<Located<Shape>>> {
        let shapes: Vec<_> = record.records(key).map(|shape| self.shape(shape)).collect();
        shapes.into_iter().collect()
    }

    pub(super) fn corners(&mut self, record: &Record) -> Option<(Vec<f64>, Vec<f64>)> {
        let (min, max) = (record.numbers("min")?, record.numbers("max")?);
        let axis = min.iter().zip(max.iter()).position(|(min, max)| min >= max);
        if let Some(axis) = axis {
            let message = format!(
                "`max` must be above `min` in every component, but {} is not above {} in {}",
                max[axis],
                min[axis],
                AXES[axis.min(2)]
            );
            return self.refuse(Problem::new(max.place, message, "not above `min`"));
        }
        Some((min.value, max.value))
    }

    pub(super) fn region(&mut self, record: &Record) -> Option<Located<Region>> {
        let region = match record.kind {
            "all" => Region::All,
            "plane" => {
                let (point, normal) = (vector(record, "point"), self.unit(record, "normal"));
                Region::Plane { point: point?, normal: normal? }
            }
            "half_space" => {
                let (point, normal) = (vector(record, "point"), self.unit(record, "normal"));
                Region::HalfSpace { point: point?, normal: normal? }
            }
            "box" => {
                let (min, max) = self.corners(record)?;
                Region::Box { min, max }
            }
            "ball" => Region::Ball {
                center: vector(record, "center")?,
                radius: number(record, "radius")?,
            },
            "set" => Region::Set { name: record.text("name")?.value },
            _ => return None,
        };
        Some(Located::new(region, record.place))
    }

    /// A direction, scaled to length 1.
    pub(super) fn unit(&mut self, record: &Record, key: &str) -> Option<Vec<f64>> {
        let direction = record.numbers(key)?;
        let largest = direction.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if largest == 0.0 {
            let message = format!("`{key}` must have a direction, got zeros only");
            return self.refuse(Problem::new(direction.place, message, "no direction"));
        }
        // Scaled by the largest component first, so that no square overflows or vanishes.
        let scaled: Vec<f64> = direction.iter().map(|value| value / largest).collect();
        let length = scaled.iter().map(|value| value * value).sum::<f64>().sqrt();
        Some(scaled.into_iter().map(|value| value / length).collect())
    }

    fn initial(&mut self, record: &Record) -> Option<Initial> {
        if self.names.current.preset().is_none() {
            self.meaningless(record, "displacement", "in this scheme");
        }
        let components = |key: &str| match record.has(key) {
            true => record.expressions(key),
            false => Some(vec![Expression::constant(0.0); self.dimension]),
        };
        Some(Initial {
            place: record.place,
            velocity: components("velocity")?,
            displacement: components("displacement")?,
            pressure: record.expression("pressure")?,
        })
    }

    pub(super) fn material(&mut self, record: &Record) -> Option<Located<Material>> {
        if HyperelasticLaw::NAMES.contains(&record.kind) {
            return self.elastic_solid(record);
        }
        if record.kind == "hypoelastic" {
            return self.hypoelastic(record);
        }
        if record.kind == "rigid" {
            let material = Material::Rigid { density: number(record, "density")? };
            return Some(Located::new(material, record.place));
        }
        let stiffness = self.stiffness(record);
        let density = number(record, "density")?;
        let stiffness = stiffness?;
        let is_fluid = record.kind == "weakly_compressible";
        let gamma = match is_fluid {
            true => 1.0,
            false => self.volumetric_law(record, 1.0)?.tangent(1.0),
        };
        let modulus = stiffness.modulus(density, gamma, self.dimension);
        if !(modulus > 0.0 && modulus.is_finite()) {
            let message =
                format!("these values give a modulus of {modulus} Pa, which is impossible");
            let place = first_place(record, &STIFFNESSES);
            return self.refuse(Problem::new(place, message, "out of range"));
        }
        let material = match is_fluid {
            true => {
                let viscosity = number(record, "viscosity")?;
                Material::WeaklyCompressible { density, stiffness, viscosity }
            }
            false => Material::Volumetric { density, law: self.volumetric_law(record, modulus)? },
        };
        Some(Located::new(material, record.place))
    }

    /// The volumetric law of a record, of a modulus in Pa.
    fn volumetric_law(&mut self, record: &Record, modulus: f64) -> Option<VolumetricLaw> {
        let law = match record.kind {
            "linear" => VolumetricLaw::linear(modulus),
            "gamma_law" => VolumetricLaw::gamma_law(modulus, number(record, "gamma")?),
            _ => return None,
        };
        match law {
            Ok(law) => Some(law),
            Err(error) => {
                self.refuse(Problem::new(record.place, error.to_string(), "out of range"))
            }
        }
    }

    fn stiffness(&mut self, record: &Record) -> Option<Stiffness> {
        let is_linear = record.kind == "linear";
        let names = if is_linear { &STIFFNESSES[..] } else { &STIFFNESSES[..2] };
        let mut given: Vec<&str> = names.iter().copied().filter(|name| record.has(name)).collect();
        given.sort_by_key(|name| record.key_place(name));
        if let [_, second, ..] = given[..] {
            let place = record.key_place(second).unwrap_or(record.place);
            let message = format!("`{}` and `{second}` both give the stiffness", given[0]);
            return self.refuse(
                Problem::new(place, message, "the second way to give it")
                    .help("remove one of them"),
            );
        }
        if !given.contains(&"young_modulus") {
            for key in ["poisson_ratio", "plane"] {
                self.meaningless(record, key, "without `young_modulus`");
            }
        }
        match given.first() {
            None => {
                let message = "the material needs a stiffness";
                let help = if is_linear {
                    "give `bulk_modulus`, `wave_speed`, or `young_modulus` with `poisson_ratio`"
                } else {
                    "give `bulk_modulus` or `wave_speed`"
                };
                self.refuse(Problem::new(record.place, message, "no stiffness").help(help))
            }
            Some(&"bulk_modulus") => number(record, "bulk_modulus").map(Stiffness::BulkModulus),
            Some(&"wave_speed") => number(record, "wave_speed").map(Stiffness::WaveSpeed),
            Some(_) => self.young(record),
        }
    }

    fn young(&mut self, record: &Record) -> Option<Stiffness> {
        if self.dimension == 3 {
            self.meaningless(record, "plane", "in 3D");
        }
        let plane = plane(record).unwrap_or(PlaneState::Stress);
        let modulus = number(record, "young_modulus");
        let is_free = plane == PlaneState::Stress && self.dimension < 3;
        let poisson_ratio = match record.number("poisson_ratio") {
            Some(ratio) => self.poisson_ratio(ratio, is_free)?,
            None if record.has("poisson_ratio") => return None,
            // A bar without stress across has the modulus E, whatever its Poisson's ratio.
            None if is_free && self.dimension == 1 => 0.0,
            None => {
                let place = first_place(record, &["young_modulus"]);
                let message = "`young_modulus` needs `poisson_ratio` beside it";
                return self.refuse(Problem::new(place, message, "`poisson_ratio` is missing"));
            }
        };
        Some(Stiffness::Young { modulus: modulus?, poisson_ratio, plane })
    }

    fn poisson_ratio(&mut self, ratio: Located<f64>, is_free: bool) -> Option<f64> {
        let value = ratio.value;
        if value > -1.0 && (value < 0.5 || value == 0.5 && is_free) {
            return Some(value);
        }
        if value == 0.5 {
            let message =
                "with `poisson_ratio` 0.5 the material is incompressible and its modulus infinite";
            let problem = Problem::new(ratio.place, message, "must be below 0.5");
            return self
                .refuse(problem.help("use a smaller value, for example 0.49, or `bulk_modulus`"));
        }
        let upper = if is_free { "at most" } else { "below" };
        let message = format!("`poisson_ratio` must be above -1 and {upper} 0.5, got {value}");
        self.refuse(Problem::new(ratio.place, message, format!("must be above -1 and {upper} 0.5")))
    }
}

/// What the directions do that the case does not have, if the file says it.
pub(super) fn plane(record: &Record) -> Option<PlaneState> {
    Some(match record.text("plane")?.as_str() {
        "strain" => PlaneState::Strain,
        _ => PlaneState::Stress,
    })
}

pub(super) fn number(record: &Record, key: &str) -> Option<f64> {
    record.number(key).map(|number| number.value)
}

fn vector(record: &Record, key: &str) -> Option<Vec<f64>> {
    record.numbers(key).map(|numbers| numbers.value)
}
