//! Laws as text in C and what is close to it.

use std::fmt::Write;

use piola_formulas::functions::{self, ROOT_OF_HALF};

use crate::law::Law;
use crate::record::{Binary, Operation, Unary};

/// A language that laws are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99.
    C,
    /// OpenCL C 1.2.
    OpenCl,
    /// CUDA C++.
    Cuda,
}

/// The numbers of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 64 bits.
    Double,
    /// 32 bits. Exponentials, logarithms and circular functions are those of the machine.
    Single,
}

impl Precision {
    /// The name of its numbers in text, in which `real` may be another one: see [`Language::prologue`].
    pub(crate) fn token(self) -> &'static str {
        match self {
            Self::Double => "real",
            Self::Single => "work",
        }
    }

    /// Bytes a number.
    pub fn bytes(self) -> usize {
        match self {
            Self::Double => 8,
            Self::Single => 4,
        }
    }

    fn type_name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Single => "float",
        }
    }

    pub(crate) fn literal(self, value: f64) -> String {
        let text = match self {
            Self::Double => format!("{value:?}"),
            Self::Single => format!("{:?}f", value as f32),
        };
        match text.trim_end_matches('f').trim_start_matches('-') {
            "in" | "inf" if value > 0.0 => "P_INFINITY".into(),
            "in" | "inf" => "(-P_INFINITY)".into(),
            "NaN" => "P_NAN".into(),
            _ if text.starts_with('-') => format!("({text})"),
            _ => text,
        }
    }
}

const C: &str = "#include <math.h>
#include <string.h>
#define LAW static inline
#define KERNEL
#define GLOBAL
#define EACH(a, n) for (int a = 0; a < (n); ++a)
#define ALIGNED(bytes)
#define P_INFINITY INFINITY
#define P_NAN NAN
LAW float p_float(unsigned bits) { float x; memcpy(&x, &bits, 4); return x; }
LAW unsigned p_whole(float x) { unsigned bits; memcpy(&bits, &x, 4); return bits; }
";

const OPEN_CL: &str = "#pragma OPENCL FP_CONTRACT OFF
#define LAW static inline
#define KERNEL __kernel
#define GLOBAL __global
#define EACH(a, n) const int a = get_global_id(0); if (a < (n))
#define ALIGNED(bytes) __attribute__((aligned(bytes)))
#define P_INFINITY INFINITY
#define P_NAN NAN
#define p_float(bits) as_float((uint)(bits))
#define p_whole(x) as_uint(x)
";

/// Threads a block; a multiple of those of a warp.
pub(crate) const BLOCK: u32 = 128;

const CUDA: &str = "#define LAW static __device__ __forceinline__
#define WHOLE_WARP 0xffffffffu
#define KERNEL extern \"C\" __global__
#define GLOBAL
#define EACH(a, n) const int a = blockIdx.x * blockDim.x + threadIdx.x; if (a < (n))
#define ALIGNED(bytes) __align__(bytes)
#define P_INFINITY __longlong_as_double(0x7ff0000000000000)
#define P_NAN __longlong_as_double(0x7ff8000000000000)
#define p_float(bits) __uint_as_float(bits)
#define p_whole(x) __float_as_uint(x)
";

/// The helpers that take a double precision number apart.
fn bits(language: Language) -> String {
    let (to, from, prologue) = match language {
        Language::Cuda => ("__longlong_as_double", "__double_as_longlong", ""),
        Language::OpenCl => ("as_double", "as_long", ""),
        Language::C => (
            "p_number",
            "p_bits",
            "LAW double p_number(long long bits) { double x; memcpy(&x, &bits, 8); return x; }\n\
             LAW long long p_bits(double x) { long long bits; memcpy(&bits, &x, 8); return bits; }\n",
        ),
    };
    let long = if language == Language::OpenCl { "long" } else { "long long" };
    format!(
        "{prologue}\
         LAW double p_two_to(double k) {{ return {to}((({long})k + 1023) << 52); }}\n\
         LAW {long} p_steps(double x) {{ return ({long})((unsigned {long}){from}(x) - {ROOT_OF_HALF:#x}) >> 52; }}\n\
         LAW double p_exponent(double x) {{ return (double)p_steps(x); }}\n\
         LAW double p_mantissa(double x) {{ return {to}((unsigned {long}){from}(x) - ((unsigned {long})p_steps(x) << 52)); }}\n"
    )
}

/// The functions of the prologue.
const FUNCTIONS: [&str; 8] = ["exp", "expm1", "log", "log1p", "pow", "sin", "cos", "atan2"];

/// One of them as a law.
fn function(name: &str) -> Law {
    let inputs: &[&str] = match name {
        "pow" => &["x", "y"],
        "atan2" => &["y", "x"],
        _ => &["x"],
    };
    Law::record(format!("p_{name}"), inputs.iter().copied(), |x| {
        let value = match name {
            "exp" => functions::exp(x[0]),
            "expm1" => functions::exp_m1(x[0]),
            "log" => functions::ln(x[0]),
            "log1p" => functions::ln_1p(x[0]),
            "pow" => functions::power(x[0], x[1]),
            "sin" => functions::sin(x[0]),
            "cos" => functions::cos(x[0]),
            _ => functions::atan2(x[0], x[1]),
        };
        vec![("value".into(), value)]
    })
}

impl Language {
    /// What stands before all laws: types, names of what differs between languages, and in double
    /// precision the functions of numbers.
    pub fn prologue(self, precision: Precision) -> String {
        let mut text = match self {
            Self::C => C,
            Self::OpenCl => OPEN_CL,
            Self::Cuda => CUDA,
        }
        .to_string();
        if self == Self::Cuda {
            // With pairs of moving particles in single precision, registers suffice for so many blocks on a multiprocessor;
            // with fewer of them more time goes by until neighbours are read.
            let _ = writeln!(text, "#define EIGHT_BLOCKS __launch_bounds__({BLOCK}, 8)");
        }
        let _ = writeln!(
            text,
            "typedef {} real;\ntypedef float work;\ntypedef struct ALIGNED(16) {{ real x, y; }} Pair;\n\
             typedef struct ALIGNED(8) {{ work x, y; }} WorkPair;\n\
             typedef struct ALIGNED(16) {{ work x, y, z, w; }} WorkQuad;\n\
             #define p_counts(x) p_float((unsigned)({})rint(x))\n\
             #define p_way(here, there) ((work)(int)(p_whole(here) - p_whole(there)))",
            precision.type_name(),
            if self == Self::OpenCl { "long" } else { "long long" },
        );
        if precision == Precision::Double {
            text += &bits(self);
            for name in FUNCTIONS {
                text += &function(name).function(self, precision);
            }
        }
        text
    }
}

impl Law {
    /// The law as a function in a language, which stands behind its
    /// [prologue](Language::prologue): it takes numbers by value and pointers to results.
    pub fn text(&self, language: Language, precision: Precision) -> String {
        self.function(language, precision)
    }

    /// A law of one result called `value` returns it.
    fn function(&self, language: Language, precision: Precision) -> String {
        let returns = self.outputs == ["value"];
        let real = precision.token();
        let inputs = self.inputs.iter().map(|name| format!("{real} {name}"));
        let pointers = self.outputs.iter().map(|name| format!("{real} *{name}"));
        let arguments: Vec<String> = match returns {
            true => inputs.collect(),
            false => inputs.chain(pointers).collect(),
        };
        let mut writer = Writer { law: self, language, precision, text: String::new() };
        writer.body();
        let mut text = format!(
            "/* {} operations */\nLAW {} {}({})\n{{\n{}",
            self.operations(),
            if returns { real } else { "void" },
            self.name,
            arguments.join(", "),
            writer.text
        );
        let writer = Writer { text: String::new(), ..writer };
        for (name, place) in self.outputs.iter().zip(&self.results) {
            let _ = match returns {
                true => writeln!(text, "    return {};", writer.name(*place)),
                false => writeln!(text, "    *{name} = {};", writer.name(*place)),
            };
        }
        text + "}\n"
    }
}

struct Writer<'a> {
    law: &'a Law,
    language: Language,
    precision: Precision,
    text: String,
}

impl Writer<'_> {
    fn body(&mut self) {
        let mut finished = vec![false; self.law.tape.loops.len()];
        for place in self.law.places().filter(|place| self.law.inside[*place as usize].is_none()) {
            match self.law.tape.operations[place as usize] {
                Operation::Final(number, _) => {
                    if !std::mem::replace(&mut finished[number as usize], true) {
                        self.repeat(number);
                    }
                }
                _ => self.statement(place, "    "),
            }
        }
    }

    fn repeat(&mut self, number: u32) {
        let law = self.law;
        let body = &law.tape.loops[number as usize];
        for (i, start) in body.start.iter().enumerate() {
            let _ = writeln!(
                self.text,
                "    {} s{number}_{i} = {};",
                self.precision.token(),
                self.name(*start)
            );
        }
        let _ = writeln!(
            self.text,
            "    for (int k{number} = 0; k{number} < {}; ++k{number}) {{",
            body.most
        );
        let until = format!("        if ({}) break;\n", self.name(body.until));
        let is_outside = law.inside[body.until as usize] != Some(number);
        if is_outside {
            self.text += &until;
        }
        let inside = |place: &u32| law.inside[*place as usize] == Some(number);
        for place in law.places().filter(inside) {
            self.statement(place, "        ");
            if place == body.until {
                self.text += &until;
            }
        }
        for (i, next) in body.next.iter().enumerate() {
            let _ = writeln!(
                self.text,
                "        const {} n{number}_{i} = {};",
                self.precision.token(),
                self.name(*next)
            );
        }
        for i in 0..body.next.len() {
            let _ = writeln!(self.text, "        s{number}_{i} = n{number}_{i};");
        }
        self.text += "    }\n";
    }

    /// What stands for the result of an operation.
    fn name(&self, place: u32) -> String {
        match self.law.tape.operations[place as usize] {
            Operation::Input(number) => self.law.inputs[number as usize].clone(),
            Operation::Constant(bits) => self.precision.literal(f64::from_bits(bits)),
            Operation::State(number, i) | Operation::Final(number, i) => format!("s{number}_{i}"),
            _ => format!("t{place}"),
        }
    }

    fn statement(&mut self, place: u32, indent: &str) {
        let name = |at: u32| self.name(at);
        let real = self.precision.token();
        let (kind, value) = match self.law.tape.operations[place as usize] {
            Operation::Input(_)
            | Operation::Constant(_)
            | Operation::State(..)
            | Operation::Final(..) => return,
            Operation::Unary(Unary::Negate, a) => (real, format!("-{}", name(a))),
            Operation::Unary(function, a) => {
                (real, format!("{}({})", self.function_name(in_c(function)), name(a)))
            }
            Operation::Binary(function, a, b) => {
                let sign = match function {
                    Binary::Add => "+",
                    Binary::Subtract => "-",
                    Binary::Multiply => "*",
                    Binary::Divide => "/",
                    Binary::Power | Binary::Atan2 => "",
                };
                let call = |function: &str| {
                    format!("{}({}, {})", self.function_name(function), name(a), name(b))
                };
                let value = match function {
                    Binary::Power => call("pow"),
                    Binary::Atan2 => call("atan2"),
                    _ => format!("{} {sign} {}", name(a), name(b)),
                };
                (real, value)
            }
            Operation::Select(mask, yes, no) => {
                (real, format!("{} ? {} : {}", name(mask), name(yes), name(no)))
            }
            Operation::Less(a, b) => ("int", format!("{} < {}", name(a), name(b))),
            Operation::AtMost(a, b) => ("int", format!("{} <= {}", name(a), name(b))),
            Operation::And(a, b) => ("int", format!("{} & {}", name(a), name(b))),
            Operation::Or(a, b) => ("int", format!("{} | {}", name(a), name(b))),
            Operation::Not(a) => ("int", format!("!{}", name(a))),
        };
        let _ = writeln!(self.text, "{indent}const {kind} t{place} = {value};");
    }

    /// The name of a function of the prologue or of the machine.
    fn function_name(&self, name: &str) -> String {
        let is_of_machine = matches!(name, "fabs" | "sqrt");
        match (self.language, self.precision) {
            (_, Precision::Double) if !is_of_machine => format!("p_{name}"),
            (Language::C | Language::Cuda, Precision::Single) => format!("{name}f"),
            _ => name.into(),
        }
    }
}

/// The name of a function in C.
fn in_c(function: Unary) -> &'static str {
    match function {
        Unary::Negate => unreachable!("it is an operator"),
        Unary::Abs => "fabs",
        Unary::Sqrt => "sqrt",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Exp => "exp",
        Unary::ExpM1 => "expm1",
        Unary::Ln => "log",
        Unary::Ln1p => "log1p",
        Unary::TwoTo => "two_to",
        Unary::Exponent => "exponent",
        Unary::Mantissa => "mantissa",
    }
}
