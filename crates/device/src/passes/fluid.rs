//! A weakly compressible fluid.
//!
//! The continuity equation, pressure, viscosity, the diffusion of the density and the opening
//! that shifting needs, all in one pass over neighbours. Sums are taken in eight lanes, neighbour k
//! in lane k mod 8, which are added by halves, as the schemes of piola do it. On a GPU eight threads
//! work on a particle.

use std::fmt::Write;

use piola_formulas::kernels::{QuinticSpline, ScaledKernel};
use piola_formulas::{Number, fluid};

use super::Rows;
use crate::law::Law;
use crate::text::{Language, Precision};

/// What a particle shows its neighbours: position in m, velocity in m/s, density in kg/m^3, pressure in
/// Pa.
pub const SIDE: [&str; 8] = ["x", "y", "z", "u", "v", "w", "density", "pressure"];

/// What it gets from them: acceleration in m/s^2, rate of the density in kg/(m^3 s), and
/// `sum V_b grad W_ab` in 1/m.
pub const SUMS: [&str; 7] = ["force_x", "force_y", "force_z", "rate", "open_x", "open_y", "open_z"];

const LANES: usize = 8;

/// The constants of a fluid of particles of one mass.
#[derive(Clone, Copy, Debug)]
pub struct Fluid {
    kernel: ScaledKernel<QuinticSpline, 3>,
    softening: f64,
    mass: f64,
    density: f64,
    wave_speed: f64,
    viscosity: f64,
    diffusivity: f64,
    /// Strength `alpha h c` of the artificial viscosity in m^2/s.
    artificial: f64,
    step: f64,
}

impl Fluid {
    /// Water of a wave speed of 20 m/s, by particles of a spacing in m with the smoothing length
    /// `0.9` of it, so that a particle has about 80 neighbours.
    pub fn water(spacing: f64) -> Self {
        let (h, density, wave_speed) = (0.9 * spacing, 1000.0, 20.0);
        Self {
            kernel: ScaledKernel::new(h),
            softening: fluid::softening(h),
            mass: density * spacing * spacing * spacing,
            density,
            wave_speed,
            viscosity: 1e-2,
            diffusivity: fluid::pressure_diffusivity(0.5, h, wave_speed),
            artificial: 0.02 * h * wave_speed,
            step: 0.05 * h / wave_speed,
        }
    }

    /// What particle a gets from b.
    #[inline(always)]
    pub fn exchange<T: Number>(&self, a: &[T], b: &[T]) -> [T; 7] {
        let r: [T; 3] = std::array::from_fn(|i| a[i] - b[i]);
        let jump: [T; 3] = std::array::from_fn(|i| a[3 + i] - b[3 + i]);
        let dot = |p: &[T; 3], q: &[T; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let square = dot(&r, &r);
        let slope = self.kernel.derivative_over_r(square.sqrt());
        let weighted = slope * self.mass;
        let approach = dot(&jump, &r);
        let scale = fluid::exchange_scale(a[6] + b[6], square, self.softening);
        let viscous = fluid::diffusion(self.viscosity, square, weighted, scale);
        let artificial = fluid::artificial_viscosity(T::from(self.artificial), approach, scale);
        let spread = fluid::diffusion(self.diffusivity, square, weighted, scale);
        let inverse = b[6].recip();
        let load = a[7] / (a[6] * a[6]) + b[7] * inverse * inverse + artificial;
        let pressure = weighted * load;
        let opening = weighted * inverse;
        [
            jump[0] * viscous - r[0] * pressure,
            jump[1] * viscous - r[1] * pressure,
            jump[2] * viscous - r[2] * pressure,
            weighted * approach + spread * (a[6] - b[6]),
            r[0] * opening,
            r[1] * opening,
            r[2] * opening,
        ]
    }

    /// What a particle shows after a step with these sums.
    #[inline(always)]
    pub fn advance<T: Number>(&self, side: &[T], sums: &[T]) -> [T; 8] {
        let velocity: [T; 3] = std::array::from_fn(|i| side[3 + i] + sums[i] * self.step);
        let position: [T; 3] = std::array::from_fn(|i| side[i] + velocity[i] * self.step);
        let density = side[6] + sums[3] * self.step;
        let [x, y, z] = position;
        let [u, v, w] = velocity;
        [x, y, z, u, v, w, density, fluid::pressure(density, self.density, self.wave_speed)]
    }

    /// The sums of a particle.
    pub fn sums<T: Number>(&self, sides: &[[T; 8]], row: &[u32], a: usize) -> [T; 7] {
        let mut lanes = [[T::zero(); 7]; LANES];
        for (k, &b) in row.iter().enumerate() {
            let terms = self.exchange(&sides[a], &sides[b as usize]);
            for (sum, term) in lanes[k % LANES].iter_mut().zip(terms) {
                *sum += term;
            }
        }
        for half in [4, 2, 1] {
            let (lower, upper) = lanes.split_at_mut(half);
            for (lower, upper) in lower.iter_mut().zip(upper) {
                lower.iter_mut().zip(upper).for_each(|(sum, term)| *sum += *term);
            }
        }
        lanes[0]
    }

    /// Sums of some particles, from the first on.
    pub fn fill<T: Number>(
        &self,
        sides: &[[T; 8]],
        rows: &Rows,
        first: usize,
        sums: &mut [[T; 7]],
    ) {
        for (offset, sums) in sums.iter_mut().enumerate() {
            *sums = self.sums(sides, rows.row(first + offset), first + offset);
        }
    }

    /// [`Self::exchange`] recorded.
    pub fn exchange_law(&self) -> Law {
        let of = |particle: &str| SIDE.map(|column| format!("{particle}_{column}"));
        Law::record("fluid_exchange", [of("a"), of("b")].concat(), |x| {
            SUMS.iter().map(|name| name.to_string()).zip(self.exchange(&x[..8], &x[8..])).collect()
        })
    }

    /// [`Self::advance`] recorded.
    pub fn advance_law(&self) -> Law {
        let inputs = SIDE.iter().chain(&SUMS).copied();
        Law::record("fluid_advance", inputs, |x| {
            let names = SIDE.iter().map(|column| format!("new_{column}"));
            names.zip(self.advance(&x[..8], &x[8..])).collect()
        })
    }

    /// The text of both passes.
    pub fn text(&self, language: Language, precision: Precision) -> String {
        let mut text = language.prologue(precision);
        for law in [self.exchange_law(), self.advance_law()] {
            text += &law.text(language, precision);
        }
        let _ = write!(
            text,
            "typedef struct ALIGNED {{ real {}; }} Side;\n\
             typedef struct {{ real {}; }} Sums;\n",
            SIDE.join(", "),
            SUMS.join(", ")
        );
        let of = |prefix: &str| SIDE.map(|column| format!("{prefix}{column}")).join(", ");
        let call = format!(
            "real {};\n        fluid_exchange({}, {}, {});\n",
            SUMS.map(|sum| format!("d_{sum}")).join(", "),
            of("me."),
            of("other."),
            SUMS.map(|sum| format!("&d_{sum}")).join(", ")
        );
        text += &match language {
            Language::Cuda => by_threads(&call),
            _ => by_lanes(&call),
        };
        let _ = write!(
            text,
            "KERNEL void fluid_step(const int n, GLOBAL const Sums *sums, GLOBAL Side *side)\n{{\n    \
             EACH(a, n) {{\n        const Side me = side[a];\n        const Sums sum = sums[a];\n        \
             Side next;\n        fluid_advance({}, {}, {});\n        side[a] = next;\n    }}\n}}\n",
            of("me."),
            SUMS.map(|name| format!("sum.{name}")).join(", "),
            of("&next."),
        );
        text
    }
}

/// Eight threads a particle, each with the sums of a lane.
fn by_threads(call: &str) -> String {
    let each = |line: &dyn Fn(&str) -> String| SUMS.iter().map(|sum| line(sum)).collect::<String>();
    let zero = each(&|sum| format!("    real {sum} = 0;\n"));
    let add = each(&|sum| format!("        {sum} += d_{sum};\n"));
    let total =
        each(&|sum| format!("        {sum} += __shfl_down_sync(0xffffffff, {sum}, step, 8);\n"));
    let write = each(&|sum| format!("    sums[a].{sum} = {sum};\n"));
    format!(
        "KERNEL void fluid_sums(const int n, GLOBAL const int *__restrict__ first, \
         GLOBAL const int *__restrict__ neighbor, GLOBAL const Side *__restrict__ side, \
         GLOBAL Sums *__restrict__ sums)\n{{\n    \
         const int thread = blockIdx.x * blockDim.x + threadIdx.x;\n    \
         const int a = thread / 8, lane = thread % 8;\n    \
         const int end = a < n ? first[a + 1] : 0;\n    \
         const Side me = side[a < n ? a : 0];\n{zero}    \
         for (int k = a < n ? first[a] + lane : 0; k < end; k += 8) {{\n        \
         const Side other = side[neighbor[k]];\n        {call}{add}    }}\n    \
         for (int step = 4; step > 0; step /= 2) {{\n{total}    }}\n    \
         if (a >= n || lane > 0) return;\n{write}}}\n"
    )
}

/// One thread a particle, which has all lanes.
fn by_lanes(call: &str) -> String {
    let each = |line: &dyn Fn(&str) -> String| SUMS.iter().map(|sum| line(sum)).collect::<String>();
    let add = each(&|sum| format!("            lanes[k % 8].{sum} += d_{sum};\n"));
    let zero = SUMS.map(|_| "0").join(", ");
    let total =
        each(&|sum| format!("                lanes[lane].{sum} += lanes[lane + step].{sum};\n"));
    let call = call.replace("\n        ", "\n            ");
    format!(
        "KERNEL void fluid_sums(const int n, GLOBAL const int *first, GLOBAL const int *neighbor, \
         GLOBAL const Side *side, GLOBAL Sums *sums)\n{{\n    EACH(a, n) {{\n        \
         Sums lanes[8] = {{{}}};\n        const Side me = side[a];\n        \
         for (int k = 0; k < first[a + 1] - first[a]; ++k) {{\n            \
         const Side other = side[neighbor[first[a] + k]];\n            {call}{add}        }}\n        \
         for (int step = 4; step > 0; step /= 2) {{\n            \
         for (int lane = 0; lane < step; ++lane) {{\n{total}            }}\n        }}\n        \
         sums[a] = lanes[0];\n    }}\n}}\n",
        [(); 8].map(|()| format!("{{{zero}}}")).join(", ")
    )
}
