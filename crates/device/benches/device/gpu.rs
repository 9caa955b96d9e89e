//! The passes on a GPU.

use piola_device::passes::fluid::Fluid;
use piola_device::passes::solid::{Body, Solid};
use piola_device::passes::{Rows, Sliced};
use piola_device::{Argument, Column, Device, DeviceError, Kernel, Precision};

use super::cloud;
use super::processor::{self, FLUID_RADIUS, SOLID_RADIUS, SPACING, State};

type Outcome<T> = Result<T, DeviceError>;

/// Measurements of which the best counts.
const REPEATS: usize = 10;

/// Numbers on the device in one of the precisions.
enum Numbers {
    Double(Column<f64>),
    Single(Column<f32>),
}

impl Numbers {
    fn of(device: &Device, precision: Precision, numbers: &[f64]) -> Outcome<Self> {
        Ok(match precision {
            Precision::Double => Self::Double(device.upload(numbers)?),
            Precision::Single => {
                let numbers: Vec<f32> = numbers.iter().map(|x| *x as f32).collect();
                Self::Single(device.upload(&numbers)?)
            }
        })
    }

    fn zeros(device: &Device, precision: Precision, count: usize) -> Outcome<Self> {
        Ok(match precision {
            Precision::Double => Self::Double(device.zeros(count)?),
            Precision::Single => Self::Single(device.zeros(count)?),
        })
    }

    fn argument(&self) -> Argument<'_> {
        match self {
            Self::Double(column) => Argument::Doubles(column),
            Self::Single(column) => Argument::Singles(column),
        }
    }

    fn download(&self, device: &Device) -> Outcome<Vec<f64>> {
        Ok(match self {
            Self::Double(column) => device.download(column)?,
            Self::Single(column) => device.download(column)?.into_iter().map(f64::from).collect(),
        })
    }
}

/// A kernel with what it is started with, and the bytes that it has to move at least and asks for.
struct Pass<'a> {
    name: &'a str,
    kernel: &'a Kernel,
    threads: usize,
    arguments: Vec<Argument<'a>>,
    least: f64,
    asked: f64,
}

impl Pass<'_> {
    fn start(&self, block: u32) -> Outcome<()> {
        self.kernel.start(self.threads, block, &self.arguments)
    }

    /// Prints the best time for some sizes of blocks, and returns the best of all.
    fn measure(&self, device: &Device, pairs: f64, copy: f64) -> Outcome<f64> {
        let mut best = f64::INFINITY;
        for block in [64, 128, 256] {
            self.start(block)?;
            let mut time = f64::INFINITY;
            for _ in 0..REPEATS {
                time = time.min(device.time(|| self.start(block))?);
            }
            let [registers, local, blocks] = self.kernel.resources(block)?.unwrap_or_default();
            let rate = self.least / time * 1e-9;
            println!(
                "| {} | {block} | {time:.3} | {:.3} | {rate:.2} | {:.0} | {:.2} | {registers} | {local} | {:.0} |",
                self.name,
                1e6 * time / pairs,
                100.0 * rate / copy,
                self.asked / time * 1e-9,
                100.0 * f64::from(blocks) * f64::from(block) / 2048.0,
            );
            best = best.min(time);
        }
        Ok(best)
    }
}

/// Rate in TB/s, reads and writes counted, at which the device copies its own memory.
fn copy_rate(device: &Device) -> Outcome<f64> {
    let count = 1 << 27;
    let (from, mut to) = (device.zeros::<f64>(count)?, device.zeros::<f64>(count)?);
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        best = best.min(device.time(|| device.copy(&from, &mut to))?);
    }
    Ok(16.0 * count as f64 / best * 1e-9)
}

/// Bits that differ, and the largest difference over the largest number.
fn compare(what: &str, got: &[f64], expected: &[f64]) {
    let differing = got.iter().zip(expected).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let error = got.iter().zip(expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    println!(
        "{what}: {differing} of {} numbers differ, largest difference {:.2e} of the largest number",
        got.len(),
        error / largest
    );
}

fn flat<const N: usize>(rows: &[[f64; N]], padding: usize) -> Vec<f64> {
    rows.iter()
        .flat_map(|row| row.iter().copied().chain(std::iter::repeat_n(0.0, padding)))
        .collect()
}

/// All comparisons and measurements.
pub fn measure(device: &Device, small: usize, large: usize) -> Outcome<()> {
    let copy = copy_rate(device)?;
    println!("{}, copies {copy:.2} TB/s", device.description());
    fluid_bits(device, small, 100)?;
    fluid_bits(device, large, 3)?;
    solid_bits(device, small, 100)?;
    solid_bits(device, large, 3)?;
    println!(
        "| pass | block | ms | ns a pair | TB/s at least | % of copy | TB/s asked of caches | registers | \
         local bytes | occupancy % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for precision in [Precision::Double, Precision::Single] {
        fluid_times(device, precision, large, copy)?;
        solid_times(device, precision, large, copy)?;
    }
    Ok(())
}

/// A fluid on the device.
struct GpuFluid {
    rows: Rows,
    sides: Vec<[f64; 8]>,
    kernels: [Kernel; 2],
    first: Column<u32>,
    neighbors: Column<u32>,
    side: Numbers,
    sums: Numbers,
    bytes: f64,
}

impl GpuFluid {
    fn new(device: &Device, precision: Precision, side: usize) -> Outcome<Self> {
        let positions = cloud::cube(side, SPACING);
        let rows = cloud::neighbors(&positions, FLUID_RADIUS * SPACING);
        let sides = processor::sides(&positions);
        let program = device.compile(&Fluid::water(SPACING).text(device.language(), precision))?;
        Ok(Self {
            kernels: [program.kernel("fluid_sums")?, program.kernel("fluid_step")?],
            first: device.upload(&rows.offsets)?,
            neighbors: device.upload(&rows.neighbors)?,
            side: Numbers::of(device, precision, &flat(&sides, 0))?,
            sums: Numbers::zeros(device, precision, 7 * sides.len())?,
            bytes: precision.bytes() as f64,
            rows,
            sides,
        })
    }

    fn count(&self) -> Argument<'_> {
        Argument::Count(self.sides.len() as i32)
    }

    fn sums_pass(&self) -> Pass<'_> {
        let (count, pairs) = (self.sides.len() as f64, self.rows.neighbors.len() as f64);
        Pass {
            name: if self.bytes > 4.0 { "fluid sums, double" } else { "fluid sums, single" },
            kernel: &self.kernels[0],
            threads: 8 * self.sides.len(),
            arguments: vec![
                self.count(),
                Argument::Indices(&self.first),
                Argument::Indices(&self.neighbors),
                self.side.argument(),
                self.sums.argument(),
            ],
            least: 4.0 * pairs + count * (4.0 + 15.0 * self.bytes),
            asked: pairs * (4.0 + 8.0 * self.bytes),
        }
    }

    fn step_pass(&self) -> Pass<'_> {
        let count = self.sides.len() as f64;
        let bytes = count * 23.0 * self.bytes;
        Pass {
            name: if self.bytes > 4.0 { "fluid step, double" } else { "fluid step, single" },
            kernel: &self.kernels[1],
            threads: self.sides.len(),
            arguments: vec![self.count(), self.sums.argument(), self.side.argument()],
            least: bytes,
            asked: bytes,
        }
    }

    fn advance(&self, steps: usize) -> Outcome<()> {
        for _ in 0..steps {
            self.sums_pass().start(128)?;
            self.step_pass().start(128)?;
        }
        Ok(())
    }
}

fn fluid_bits(device: &Device, side: usize, steps: usize) -> Outcome<()> {
    let fluid = GpuFluid::new(device, Precision::Double, side)?;
    fluid.advance(steps)?;
    let got = fluid.side.download(device)?;
    let law = Fluid::water(SPACING);
    let expected = processor::fluid_steps::<f64>(&law, &fluid.rows, &fluid.sides, steps);
    let expected = flat(&expected, 0);
    let what = format!("fluid, {} particles, {steps} steps", fluid.sides.len());
    compare(&format!("{what}, double, processor's f64"), &got, &expected);
    let single = GpuFluid::new(device, Precision::Single, side)?;
    single.advance(steps)?;
    let got = single.side.download(device)?;
    // Numbers of one kind have one scale.
    for (name, columns) in [("positions", 0..3), ("velocities", 3..6), ("pressures", 7..8)] {
        let of = |all: &[f64]| -> Vec<f64> {
            all.chunks(8).flat_map(|row| row[columns.clone()].to_vec()).collect()
        };
        compare(&format!("{what}, single, {name}"), &of(&got), &of(&expected));
    }
    Ok(())
}

fn fluid_times(device: &Device, precision: Precision, side: usize, copy: f64) -> Outcome<()> {
    let fluid = GpuFluid::new(device, precision, side)?;
    let pairs = fluid.rows.neighbors.len() as f64;
    println!("| {:.1} neighbours | | | | | | | | | |", pairs / fluid.sides.len() as f64);
    fluid.sums_pass().measure(device, pairs, copy)?;
    fluid.step_pass().measure(device, pairs, copy)?;
    Ok(())
}

/// A solid on the device.
struct GpuSolid {
    body: Body,
    states: Vec<State<f64>>,
    sliced: Sliced,
    kernels: [Kernel; 2],
    indices: [Column<u32>; 3],
    coefficients: [Numbers; 3],
    reverse: [Numbers; 3],
    velocity: Numbers,
    displacement: Numbers,
    tension: Numbers,
    total: Numbers,
    volume: Numbers,
    inverse_mass: Numbers,
    bytes: f64,
}

impl GpuSolid {
    fn new(device: &Device, precision: Precision, side: usize) -> Outcome<Self> {
        let positions = cloud::cube(side, SPACING);
        let body =
            cloud::body(&positions, SOLID_RADIUS * SPACING, SPACING * SPACING * SPACING, 1000.0);
        let states = processor::states(&positions);
        let sliced = body.rows.sliced();
        let program = device.compile(&Solid::rubber().text(device.language(), precision))?;
        let numbers = |numbers: &[f64]| Numbers::of(device, precision, numbers);
        let arranged = |coefficients: &[[f64; 3]], axis: usize| {
            numbers(&body.rows.arranged(&sliced, 0.0, |entry| coefficients[entry][axis]))
        };
        let all = |c: &[[f64; 3]]| Ok([arranged(c, 0)?, arranged(c, 1)?, arranged(c, 2)?]);
        let velocity: Vec<[f64; 3]> = states.iter().map(|(v, _)| *v).collect();
        let displacement: Vec<[f64; 3]> = states.iter().map(|(_, u)| *u).collect();
        let neighbors = body.rows.arranged(&sliced, 0, |entry| body.rows.neighbors[entry]);
        let width = if precision == Precision::Double { 10 } else { 12 };
        Ok(Self {
            kernels: [program.kernel("solid_tensions")?, program.kernel("solid_step")?],
            indices: [
                device.upload(&sliced.first)?,
                device.upload(&sliced.length)?,
                device.upload(&neighbors)?,
            ],
            coefficients: all(&body.coefficients)?,
            reverse: all(&body.reverse)?,
            velocity: numbers(&flat(&velocity, 1))?,
            displacement: numbers(&flat(&displacement, 1))?,
            tension: Numbers::zeros(device, precision, width * states.len())?,
            total: numbers(&flat(&body.total, 1))?,
            volume: numbers(&body.volume)?,
            inverse_mass: numbers(&body.inverse_mass)?,
            bytes: precision.bytes() as f64,
            sliced,
            states,
            body,
        })
    }

    /// What both passes begin with.
    fn lists<'a>(&'a self, coefficients: &'a [Numbers; 3]) -> Vec<Argument<'a>> {
        let mut arguments = vec![Argument::Count(self.states.len() as i32)];
        arguments.extend(self.indices.iter().map(Argument::Indices));
        arguments.extend(coefficients.iter().map(Numbers::argument));
        arguments
    }

    fn tension_pass(&self) -> Pass<'_> {
        let (count, entries) = (self.states.len() as f64, self.sliced.entries as f64);
        let mut arguments = self.lists(&self.coefficients);
        arguments.extend([&self.displacement, &self.volume, &self.tension].map(Numbers::argument));
        let width = if self.bytes > 4.0 { 10.0 } else { 12.0 };
        let lists = entries * (4.0 + 3.0 * self.bytes);
        Pass {
            name: if self.bytes > 4.0 {
                "solid tensions, double"
            } else {
                "solid tensions, single"
            },
            kernel: &self.kernels[0],
            threads: self.states.len(),
            arguments,
            least: lists + count * (8.0 + (5.0 + width) * self.bytes),
            asked: lists + entries * 4.0 * self.bytes,
        }
    }

    fn step_pass(&self) -> Pass<'_> {
        let (count, entries) = (self.states.len() as f64, self.sliced.entries as f64);
        let mut arguments = self.lists(&self.reverse);
        let columns =
            [&self.tension, &self.total, &self.inverse_mass, &self.velocity, &self.displacement];
        arguments.extend(columns.map(Numbers::argument));
        let width = if self.bytes > 4.0 { 10.0 } else { 12.0 };
        let lists = entries * (4.0 + 3.0 * self.bytes);
        Pass {
            name: if self.bytes > 4.0 { "solid step, double" } else { "solid step, single" },
            kernel: &self.kernels[1],
            threads: self.states.len(),
            arguments,
            least: lists + count * (8.0 + (21.0 + width) * self.bytes),
            asked: lists + entries * width * self.bytes,
        }
    }

    fn advance(&self, steps: usize) -> Outcome<()> {
        for _ in 0..steps {
            self.tension_pass().start(128)?;
            self.step_pass().start(128)?;
        }
        Ok(())
    }

    fn motion(&self, device: &Device) -> Outcome<Vec<f64>> {
        let mut all = self.velocity.download(device)?;
        all.extend(self.displacement.download(device)?);
        Ok(all.chunks(4).flat_map(|point| point[..3].to_vec()).collect())
    }
}

fn solid_bits(device: &Device, side: usize, steps: usize) -> Outcome<()> {
    let gpu = GpuSolid::new(device, Precision::Double, side)?;
    gpu.advance(steps)?;
    let got = gpu.motion(device)?;
    let law = Solid::rubber();
    let plain = processor::solid_steps::<f64>(&law, &gpu.body, &gpu.states, steps);
    let of = |states: &[State<f64>]| -> Vec<f64> {
        let velocities = states.iter().flat_map(|(v, _)| *v);
        velocities.chain(states.iter().flat_map(|(_, u)| *u)).collect()
    };
    let plain = of(&plain);
    let what = format!("solid, {} particles, {steps} steps", gpu.states.len());
    compare(&format!("{what}, double"), &got, &plain);
    let single = GpuSolid::new(device, Precision::Single, side)?;
    single.advance(steps)?;
    let got = single.motion(device)?;
    let half = plain.len() / 2;
    compare(&format!("{what}, single, velocities"), &got[..half], &plain[..half]);
    compare(&format!("{what}, single, displacements"), &got[half..], &plain[half..]);
    Ok(())
}

fn solid_times(device: &Device, precision: Precision, side: usize, copy: f64) -> Outcome<()> {
    let solid = GpuSolid::new(device, precision, side)?;
    let pairs = solid.body.rows.neighbors.len() as f64;
    println!("| {:.1} neighbours | | | | | | | | | |", pairs / solid.states.len() as f64);
    solid.tension_pass().measure(device, pairs, copy)?;
    solid.step_pass().measure(device, pairs, copy)?;
    Ok(())
}
