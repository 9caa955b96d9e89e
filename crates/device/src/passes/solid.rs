//! A total Lagrangian solid.
//!
//! One explicit step on lists that stay: the displacement gradient of every particle from its
//! neighbours, its stress by an elastic law, the adjoint force, and the kick. The sums are those of
//! the scheme `total_lagrangian` without hourglass control: theory (44), (48) and (49), in the order of the
//! rows.

use std::fmt::Write;

use piola_formulas::Number;
use piola_formulas::hyperelastic::{HyperelasticLaw, HyperelasticResponse, LameConstants};

use super::Rows;
use crate::law::Law;
use crate::laws::{ENTRIES, matrix};
use crate::text::{Language, Precision};

const AXES: [&str; 3] = ["x", "y", "z"];

/// What a step of a solid needs to know.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its law.
    pub law: HyperelasticLaw,
    /// Step in s.
    pub step: f64,
}

/// What stays of a body: lists and their coefficients.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// Neighbours; the list is symmetric, rows ascend.
    pub rows: Rows,
    /// `G_ab` of each entry in 1/m.
    pub coefficients: Vec<[f64; 3]>,
    /// `G_ba` of each entry in 1/m.
    pub reverse: Vec<[f64; 3]>,
    /// `sum_b G_ab` in 1/m.
    pub total: Vec<[f64; 3]>,
    /// Volume in m^3.
    pub volume: Vec<f64>,
    /// `1/m` in 1/kg.
    pub inverse_mass: Vec<f64>,
}

impl Solid {
    /// Rubber by the neo-Hookean law.
    pub fn rubber() -> Self {
        Self {
            law: HyperelasticLaw::neo_hookean(LameConstants { lambda: 4.5e6, mu: 5e5 }),
            step: 2e-5,
        }
    }

    /// `(u_b - u_a) (x) G_ab`, row by row.
    #[inline(always)]
    pub fn gradient_terms<T: Number>(me: &[T], other: &[T], g: &[T]) -> [T; 9] {
        std::array::from_fn(|k| (other[k / 3] - me[k / 3]) * g[k % 3])
    }

    /// The tension `V P` in J of a displacement gradient, row by row.
    #[inline(always)]
    pub fn tension<T: Number>(&self, gradient: &[T], volume: T) -> [T; 9] {
        let stress = self.law.stress(&matrix(gradient));
        std::array::from_fn(|k| stress[(k / 3, k % 3)] * volume)
    }

    /// `T g` in N.
    #[inline(always)]
    pub fn force_terms<T: Number>(tension: &[T], g: &[T]) -> [T; 3] {
        std::array::from_fn(|i| {
            tension[3 * i] * g[0] + tension[3 * i + 1] * g[1] + tension[3 * i + 2] * g[2]
        })
    }

    /// Velocity and displacement after a step.
    #[inline(always)]
    pub fn kick<T: Number>(&self, v: &[T], u: &[T], force: &[T], inverse_mass: T) -> [T; 6] {
        let impulse = inverse_mass * self.step;
        let v: [T; 3] = std::array::from_fn(|i| v[i] + force[i] * impulse);
        std::array::from_fn(|k| if k < 3 { v[k] } else { u[k - 3] + v[k - 3] * self.step })
    }

    /// Tensions of some particles, from the first on.
    pub fn fill_tensions<T: Number>(
        &self,
        body: &Body,
        displacement: &[[T; 3]],
        first: usize,
        tensions: &mut [[T; 9]],
    ) {
        for (offset, tension) in tensions.iter_mut().enumerate() {
            let a = first + offset;
            let mut gradient = [T::zero(); 9];
            for (&b, g) in body.rows.row(a).iter().zip(&body.coefficients[body.rows.range(a)]) {
                let other = &displacement[b as usize];
                let terms = Self::gradient_terms(&displacement[a], other, &g.map(T::from));
                gradient.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            }
            *tension = self.tension(&gradient, T::from(body.volume[a]));
        }
    }

    /// Velocities and displacements of some particles after a step, from the first on.
    pub fn advance<T: Number>(
        &self,
        body: &Body,
        tensions: &[[T; 9]],
        first: usize,
        states: &mut [([T; 3], [T; 3])],
    ) {
        for (offset, (velocity, displacement)) in states.iter_mut().enumerate() {
            let a = first + offset;
            let mut force = Self::force_terms(&tensions[a], &body.total[a].map(T::from));
            for (&b, g) in body.rows.row(a).iter().zip(&body.reverse[body.rows.range(a)]) {
                let terms = Self::force_terms(&tensions[b as usize], &g.map(T::from));
                force.iter_mut().zip(terms).for_each(|(sum, term)| *sum -= term);
            }
            let inverse_mass = T::from(body.inverse_mass[a]);
            let [p, q, r, x, y, z] = self.kick(velocity, displacement, &force, inverse_mass);
            (*velocity, *displacement) = ([p, q, r], [x, y, z]);
        }
    }

    /// [`Self::gradient_terms`] recorded.
    pub fn gradient_law(&self) -> Law {
        let inputs = ["a_", "b_", "g_"].map(|p| AXES.map(|axis| format!("{p}{axis}"))).concat();
        Law::record("gradient_terms", inputs, |x| {
            let terms = Self::gradient_terms(&x[..3], &x[3..6], &x[6..]);
            ENTRIES.iter().map(|e| format!("d_{e}")).zip(terms).collect()
        })
    }

    /// [`Self::tension`] recorded.
    pub fn tension_law(&self) -> Law {
        let inputs = ENTRIES.iter().map(|e| format!("a_{e}")).chain(["volume".to_string()]);
        Law::record(format!("{}_tension", self.law.name()), inputs, |x| {
            let tension = self.tension(&x[..9], x[9]);
            ENTRIES.iter().map(|e| format!("t_{e}")).zip(tension).collect()
        })
    }

    /// [`Self::force_terms`] recorded.
    pub fn force_law(&self) -> Law {
        let inputs = ENTRIES.iter().map(|e| format!("t_{e}"));
        Law::record("force_terms", inputs.chain(AXES.map(|axis| format!("g_{axis}"))), |x| {
            let force = Self::force_terms(&x[..9], &x[9..]);
            AXES.map(|axis| format!("f_{axis}")).into_iter().zip(force).collect()
        })
    }

    /// [`Self::kick`] recorded.
    pub fn kick_law(&self) -> Law {
        let inputs = ["v_", "u_", "f_"].map(|p| AXES.map(|axis| format!("{p}{axis}"))).concat();
        Law::record("kick", inputs.into_iter().chain(["inverse_mass".to_string()]), |x| {
            let state = self.kick(&x[..3], &x[3..6], &x[6..9], x[9]);
            let names =
                ["new_v_", "new_u_"].map(|p| AXES.map(|axis| format!("{p}{axis}"))).concat();
            names.into_iter().zip(state).collect()
        })
    }

    /// The text of both passes, one thread a particle.
    pub fn text(&self, language: Language, precision: Precision) -> String {
        let mut text = language.prologue(precision);
        let tension = self.tension_law();
        for law in [&self.gradient_law(), &tension, &self.force_law(), &self.kick_law()] {
            text += &law.text(language, precision);
        }
        let restrict = if language == Language::Cuda { " __restrict__ " } else { "" };
        let of = |prefix: &str| ENTRIES.map(|entry| format!("{prefix}{entry}")).join(", ");
        let lines =
            |line: &dyn Fn(&str) -> String| ENTRIES.iter().map(|e| line(e)).collect::<String>();
        let _ = write!(
            text,
            "typedef struct ALIGNED {{ real x, y, z, unused; }} Point;\n\
             typedef struct ALIGNED {{ real {entries}, unused[{unused}]; }} Tensor;\n\
             KERNEL void solid_tensions(const int n, GLOBAL const int *{restrict}first, \
             GLOBAL const int *{restrict}length, GLOBAL const int *{restrict}neighbor, \
             GLOBAL const real *{restrict}g_x, GLOBAL const real *{restrict}g_y, \
             GLOBAL const real *{restrict}g_z, GLOBAL const Point *{restrict}displacement, \
             GLOBAL const real *{restrict}volume, GLOBAL Tensor *{restrict}tension)\n{{\n    \
             EACH(a, n) {{\n        const Point me = displacement[a];\n{zero}        \
             const int row = first[a / 32] * 32 + a % 32;\n        \
             for (int k = 0; k < length[a]; ++k) {{\n            \
             const int e = row + k * 32;\n            \
             const Point other = displacement[neighbor[e]];\n            real {terms};\n            \
             gradient_terms(me.x, me.y, me.z, other.x, other.y, other.z, g_x[e], g_y[e], g_z[e], \
             {pointers});\n{add}        }}\n        Tensor result;\n        \
             {law}({sums}, volume[a], {results});\n        tension[a] = result;\n    }}\n}}\n",
            entries = ENTRIES.join(", "),
            unused = if precision == Precision::Double { 1 } else { 3 },
            zero = lines(&|e| format!("        real a_{e} = 0;\n")),
            terms = of("d_"),
            pointers = of("&d_"),
            add = lines(&|e| format!("            a_{e} += d_{e};\n")),
            law = tension.name,
            sums = of("a_"),
            results = of("&result."),
        );
        let _ = write!(
            text,
            "KERNEL void solid_step(const int n, GLOBAL const int *{restrict}first, \
             GLOBAL const int *{restrict}length, GLOBAL const int *{restrict}neighbor, \
             GLOBAL const real *{restrict}g_x, GLOBAL const real *{restrict}g_y, \
             GLOBAL const real *{restrict}g_z, GLOBAL const Tensor *{restrict}tension, \
             GLOBAL const Point *{restrict}total, GLOBAL const real *{restrict}inverse_mass, \
             GLOBAL Point *{restrict}velocity, GLOBAL Point *{restrict}displacement)\n{{\n    \
             EACH(a, n) {{\n        const Tensor mine = tension[a];\n        \
             const Point g = total[a];\n        real f_x, f_y, f_z;\n        \
             force_terms({mine}, g.x, g.y, g.z, &f_x, &f_y, &f_z);\n        \
             const int row = first[a / 32] * 32 + a % 32;\n        \
             for (int k = 0; k < length[a]; ++k) {{\n            \
             const int e = row + k * 32;\n            \
             const Tensor other = tension[neighbor[e]];\n            real d_x, d_y, d_z;\n            \
             force_terms({other}, g_x[e], g_y[e], g_z[e], &d_x, &d_y, &d_z);\n            \
             f_x -= d_x;\n            f_y -= d_y;\n            f_z -= d_z;\n        }}\n        \
             Point v = velocity[a], u = displacement[a];\n        \
             kick(v.x, v.y, v.z, u.x, u.y, u.z, f_x, f_y, f_z, inverse_mass[a], \
             &v.x, &v.y, &v.z, &u.x, &u.y, &u.z);\n        \
             velocity[a] = v;\n        displacement[a] = u;\n    }}\n}}\n",
            mine = of("mine."),
            other = of("other."),
        );
        text
    }
}
