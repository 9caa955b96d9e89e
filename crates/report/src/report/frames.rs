//! The particles of some instants of a run, chosen so that they fit into a page.

use std::path::{Path, PathBuf};

use super::packed;
use crate::vtp_reader::{Array, ParticleFile, ParticleFileError};
use piola_physics::fields::{FieldKind, component_name};

/// What is shown of the particles of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Number of particles in the files.
    pub particles: usize,
    /// Every how many of them is shown.
    pub stride: usize,
    /// Number of files.
    pub files: usize,
    /// Subtracted from the positions, in m, one number an axis.
    pub centre: Vec<f64>,
    /// The fields, in the order of their data.
    pub fields: Vec<Field>,
    /// Numbers of the particles shown.
    pub ids: Vec<u32>,
    /// The body of each.
    pub bodies: Vec<u32>,
    /// The instants, in order.
    pub frames: Vec<Frame>,
    /// A sentence for each file that could not be used.
    pub faults: Vec<String>,
}

/// One field of the particles.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// Names of its components, one empty name for a scalar.
    pub components: Vec<String>,
}

/// One instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Simulated time in s.
    pub time: f64,
    /// Positions, then the fields, component by component: [`packed`], as text.
    pub data: String,
}

/// How much may be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of all numbers before zlib.
    pub bytes: usize,
    /// Instants.
    pub frames: usize,
    /// Instants below which particles are left out rather than instants.
    pub kept_frames: usize,
}

impl Limits {
    /// Those of a report. Zlib and the writing of bytes as text lengthen data by a third at most:
    /// the text is no longer than 8 MiB.
    pub const REPORT: Self = Self { bytes: 6 << 20, frames: 200, kept_frames: 12 };
}

/// Reads the particle files `paths`, which are in the order of time, of a run in `dimension`
/// dimensions. If they are too many or too large, instants are left out first, then particles.
/// A damaged file is left out with a sentence.
pub fn read(paths: &[PathBuf], dimension: usize, limits: Limits) -> Frames {
    let mut faults = Vec::new();
    let mut frames = Frames { dimension: dimension.clamp(1, 3), ..Frames::default() };
    for (number, path) in paths.iter().enumerate() {
        match frames.plan(path, paths.len() - number, limits) {
            Ok(wanted) => {
                // The first sound file tells what all have in common.
                for place in evenly(paths.len() - number, wanted) {
                    let path = &paths[number + place];
                    match frames.one(path) {
                        Ok(frame) => frames.frames.push(frame),
                        Err(error) => faults.push(sentence(path, &error)),
                    }
                }
                break;
            }
            Err(error) => faults.push(sentence(path, &error)),
        }
    }
    frames.files = paths.len();
    frames.faults = shortened(faults);
    frames
}

/// `wanted` of the numbers below `count`, as evenly as whole numbers allow, with both ends.
pub fn evenly(count: usize, wanted: usize) -> Vec<usize> {
    match (count, wanted) {
        (0, _) | (_, 0) => Vec::new(),
        (_, 1) => vec![count - 1],
        _ if wanted >= count => (0..count).collect(),
        _ => (0..wanted).map(|i| (i * (count - 1) + (wanted - 1) / 2) / (wanted - 1)).collect(),
    }
}

/// A particle file with those of its arrays that are shown.
struct Opened {
    file: ParticleFile,
    fields: Vec<Shown>,
}

/// A field of a file, with the places of its numbers in a row of three dimensions.
struct Shown {
    array: Array,
    kind: FieldKind,
    numbers: Vec<usize>,
}

fn opened(path: &Path, dimension: usize) -> Result<Opened, ParticleFileError> {
    let file = ParticleFile::open(path)?;
    let fields = file.arrays.iter().filter(|array| !["id", "body"].contains(&array.name.as_str()));
    let fields = fields.map(|array| {
        let kind = match array.components {
            1 => FieldKind::Scalar,
            3 => FieldKind::Vector,
            6 => FieldKind::Symmetric,
            _ => FieldKind::Tensor,
        };
        let numbers = match kind {
            FieldKind::Scalar => vec![0],
            FieldKind::Vector => (0..dimension).collect(),
            FieldKind::Symmetric => (0..6).collect(),
            FieldKind::Tensor => {
                (0..dimension * dimension).map(|i| i / dimension * 3 + i % dimension).collect()
            }
        };
        Shown { array: array.clone(), kind, numbers }
    });
    let fields = fields.collect();
    Ok(Opened { file, fields })
}

impl Frames {
    /// Takes what all instants have in common from the file `path`, and returns how many of
    /// `instants` there is room for.
    fn plan(
        &mut self,
        path: &Path,
        instants: usize,
        limits: Limits,
    ) -> Result<usize, ParticleFileError> {
        let Opened { mut file, fields } = opened(path, self.dimension)?;
        let numbers: usize = fields.iter().map(|field| field.numbers.len()).sum();
        let bytes_of_one = (self.dimension + numbers) * packed::BYTES_OF_NUMBER;
        let whole = (bytes_of_one * file.count).max(1);
        let most = limits.frames.min(instants);
        let wanted = (limits.bytes / whole).max(limits.kept_frames).min(most);
        self.particles = file.count;
        self.stride = (whole * wanted).div_ceil(limits.bytes.max(1)).max(1);
        // The last particle counts as a whole stride, so that one more may have to go.
        while file.count.div_ceil(self.stride) * bytes_of_one * wanted > limits.bytes
            && self.stride < file.count
        {
            self.stride += 1;
        }
        self.ids = integers(&mut file, "id", self.stride)?;
        self.bodies = integers(&mut file, "body", self.stride)?;
        let points = file.points.clone();
        let points = file.rows(&points, self.stride)?;
        self.centre = (0..self.dimension).map(|axis| middle(&points, axis)).collect();
        self.fields = fields.iter().map(|field| self.field(field)).collect();
        Ok(wanted)
    }

    fn field(&self, field: &Shown) -> Field {
        let numbers = 0..field.numbers.len();
        Field {
            name: field.array.name.clone(),
            unit: field.array.unit.clone(),
            components: numbers
                .map(|number| component_name(field.kind, number, self.dimension))
                .collect(),
        }
    }

    fn one(&self, path: &Path) -> Result<Frame, ParticleFileError> {
        let Opened { mut file, fields } = opened(path, self.dimension)?;
        let differs = |what: &str| ParticleFileError::Damaged {
            path: path.into(),
            what: format!("its {what} are not those of the first file"),
        };
        if !fields.iter().map(|field| self.field(field)).eq(self.fields.iter().cloned()) {
            return Err(differs("fields"));
        }
        if file.count != self.particles || integers(&mut file, "id", self.stride)? != self.ids {
            return Err(differs("particles"));
        }
        let mut bytes = Vec::new();
        let points = file.points.clone();
        let rows = file.rows(&points, self.stride)?;
        for (axis, centre) in self.centre.iter().enumerate() {
            packed::push(&mut bytes, rows.chunks_exact(3).map(|row| row[axis] - centre));
        }
        for Shown { array, numbers, .. } in fields {
            let rows = file.rows(&array, self.stride)?;
            for number in numbers {
                let values = rows.chunks_exact(array.components).map(|row| row[number]);
                packed::push(&mut bytes, values);
            }
        }
        Ok(Frame { time: file.time, data: packed::text(&bytes) })
    }
}

/// The middle between the smallest and the largest finite coordinate of `points`; 0 if there is
/// none, or if it is beyond all measure.
fn middle(points: &[f64], axis: usize) -> f64 {
    let finite = points.chunks_exact(3).map(|row| row[axis]).filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let middle = 0.5 * low + 0.5 * high;
    if middle.abs() < 1e30 { middle } else { 0.0 }
}

/// An array of whole numbers; zeros if the file has none of this name.
fn integers(
    file: &mut ParticleFile,
    name: &str,
    stride: usize,
) -> Result<Vec<u32>, ParticleFileError> {
    let Some(array) = file.array(name).filter(|array| array.components == 1).cloned() else {
        return Ok(vec![0; file.count.div_ceil(stride.max(1))]);
    };
    // The cast saturates.
    Ok(file.rows(&array, stride)?.into_iter().map(|value| value as u32).collect())
}

/// What the page says of a file that was left out, without the folder, which may move.
fn sentence(path: &Path, error: &ParticleFileError) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match error {
        ParticleFileError::Io { source, .. } => format!("{name} cannot be read: {source}"),
        ParticleFileError::Damaged { what, .. } => format!("{name} is damaged: {what}"),
    }
}

/// At most ten sentences, and how many more there are.
fn shortened(mut sentences: Vec<String>) -> Vec<String> {
    const MOST: usize = 10;
    let more = sentences.len().saturating_sub(MOST);
    sentences.truncate(MOST);
    if more > 0 {
        sentences.push(format!("{more} more files could not be used"));
    }
    sentences
}

#[cfg(test)]
mod tests;
