//! The text of a loop over neighbours.

use std::fmt::Write;

use super::loops::{COUNTS, Loop, POSITION, Pairs, Term, counted};
use super::{Among, Order, Rows};
use crate::law::Law;
use crate::pass::{Arguments, At, Pass, Use, own};
use crate::text::{Language, Precision};

/// Columns of numbers by slot, of who is passive by number, and of neighbours.
const NUMBERS: &str = "numbers";
const PASSIVE: &str = "passive";
const ENTRIES: &str = "entries";

impl Among {
    /// The columns that say where rows begin and how long they are.
    fn rows(self) -> &'static [[&'static str; 2]] {
        const ROWS: [[&str; 2]; 2] = [["first", "active"], ["passive_first", "passive_count"]];
        match self {
            Self::Active => &ROWS[..1],
            Self::Passive => &ROWS[1..],
            Self::All => &ROWS,
        }
    }

    /// What holds for the column `passive` of those that are meant.
    fn condition(self) -> &'static str {
        match self {
            Self::Active => "== 0",
            Self::Passive => "!= 0",
            Self::All => ">= 0",
        }
    }
}

impl Loop {
    /// The pass.
    pub(super) fn write(
        self,
        close: &Law,
        scalars: &[&'static str],
        [columns, writes]: [&[Use]; 2],
    ) -> Pass {
        let arguments = self.arguments(scalars, columns, writes);
        let mut text = self.laws(close);
        let name = self.name;
        let is_moving = matches!(self.pairs, Pairs::Moving { .. });
        let is_single = self.dialect.of_pairs() == Precision::Single;
        let is_crowded = self.has_lanes() && is_single && is_moving;
        let bounds = if is_crowded { "EIGHT_BLOCKS " } else { "" };
        let _ = writeln!(text, "KERNEL void {bounds}{name}({})\n{{", arguments.text());
        self.write_head(&mut text);
        self.write_sums(&mut text);
        self.write_close(close, scalars, [columns, writes], &mut text);
        let (threads, work) =
            (if self.has_lanes() { 8 } else { 1 }, self.work(close, columns, writes));
        Pass { name, text, asks: arguments.asks, threads, work }
    }

    /// Columns that are read of the particle itself before its neighbours: those that sums depend on.
    fn mine(&self) -> Vec<&Use> {
        let mut mine: Vec<&Use> = Vec::new();
        let started = self.start.iter().flat_map(|(_, columns)| columns);
        let of_terms = self.terms.iter().flat_map(Term::taken);
        for column in of_terms.chain(started) {
            if !mine.iter().any(|known| known.is_of(column)) {
                mine.push(column);
            }
        }
        mine
    }

    fn arguments(&self, scalars: &[&'static str], columns: &[Use], writes: &[Use]) -> Arguments {
        let mut arguments = Arguments::new(self.dialect);
        scalars.iter().for_each(|name| arguments.scalar(name));
        match &self.pairs {
            Pairs::Moving { dimension, .. } => {
                [NUMBERS, PASSIVE, ENTRIES].iter().for_each(|name| arguments.indices(name));
                for term in &self.terms {
                    term.among.rows().iter().flatten().for_each(|name| arguments.indices(name));
                }
                arguments.numbers(&self.place(*dimension), true);
            }
            Pairs::Frozen(rows) => {
                let Rows { first, count, neighbors, numbers, .. } = rows;
                [first, count, neighbors].iter().for_each(|name| arguments.indices(name));
                arguments.numbers(&own(numbers, 1), true);
            }
        }
        let others = self.terms.iter().flat_map(|term| &term.others);
        for column in self.mine().into_iter().chain(others).chain(columns) {
            if let At::Through(index) = column.at {
                arguments.indices(index);
            }
            arguments.numbers(column, true);
        }
        self.only.iter().for_each(|only| arguments.numbers(&own(only, 1), true));
        writes.iter().for_each(|write| arguments.numbers(write, false));
        arguments
    }

    /// The laws, as functions.
    fn laws(&self, close: &Law) -> String {
        let (mut text, dialect, name) = (String::new(), self.dialect, self.name);
        let laws = self.terms.iter().map(|term| &term.law);
        let laws = laws.chain(self.start.iter().map(|(law, _)| law));
        laws.for_each(|law| text += &law.text(dialect.language, dialect.of_pairs()));
        text += &close.text(dialect.language, Precision::Double);
        if let (Pairs::Moving { separation, .. }, Precision::Double) =
            (&self.pairs, dialect.of_pairs())
        {
            let own = Law { name: format!("{name}_separation"), ..(**separation).clone() };
            text += &own.text(dialect.language, Precision::Double);
        }
        text
    }

    /// Whether a term adds something to a sum.
    fn is_added_to(&self, sum: usize) -> bool {
        !self.terms.iter().all(|term| term.passes_on(sum))
    }

    /// The column of places of which pairs are made.
    pub(super) fn place(&self, dimension: usize) -> Use {
        match self.dialect.of_pairs() {
            Precision::Double => own(POSITION, dimension),
            Precision::Single => own(COUNTS, counted(dimension)),
        }
    }

    /// Loads the place of a row.
    fn load_place(&self, dimension: usize, row: &str, of: &str, indent: &str) -> String {
        let place = self.place(dimension);
        self.dialect.load(place.column, row, &axes(of, place.width), indent)
    }

    /// Who works on which particle, and what is read of it.
    fn write_head(&self, text: &mut String) {
        let passive = match &self.pairs {
            Pairs::Moving { over, .. } => {
                Some(format!("{PASSIVE}[{NUMBERS}[a]] {}", over.condition()))
            }
            Pairs::Frozen(_) => None,
        };
        let only = self.only.map(|only| format!("{only}[a] > 0.5"));
        let wanted: Vec<String> = passive.into_iter().chain(only).collect();
        *text += &match self.has_lanes() {
            true => format!(
                "    const int thread = blockIdx.x * blockDim.x + threadIdx.x;\n    \
                 const int lane = thread % 8;\n    \
                 const int a = thread / 8 < n ? thread / 8 : 0;\n    \
                 const int is_on = {};\n    {{\n",
                [&["thread / 8 < n".to_string()], &*wanted].concat().join(" && ")
            ),
            false if wanted.is_empty() => "    EACH(a, n) {\n".into(),
            false => format!("    EACH(a, n) if ({}) {{\n", wanted.join(" && ")),
        };
        if let Pairs::Moving { dimension, .. } = self.pairs {
            *text += &self.load_place(dimension, "a", "here", "    ");
        }
        self.mine().into_iter().for_each(|column| self.load(text, "    ", column, "my_", "a"));
    }

    /// The loops over neighbours.
    fn write_sums(&self, text: &mut String) {
        let (sums, work) = (&self.sums[0], self.dialect.of_pairs().token());
        let is_laned = self.order == Order::Lanes && !self.has_lanes();
        for (i, sum) in sums.iter().enumerate() {
            let _ = match is_laned && self.is_added_to(i) {
                true => writeln!(text, "    {work} l{sum}[8] = {{0, 0, 0, 0, 0, 0, 0, 0}};"),
                false => writeln!(text, "    {work} {sum} = 0;"),
            };
        }
        if let Some((law, columns)) = &self.start {
            let inputs = columns.iter().flat_map(|column| column.names("my_"));
            let pointers = sums.iter().map(|sum| format!("&{sum}"));
            let _ = writeln!(text, "    {}({});", law.name, join(inputs.chain(pointers)));
        }
        for term in &self.terms {
            match &self.pairs {
                Pairs::Moving { .. } => {
                    for rows in term.among.rows() {
                        self.write_term(term, *rows, sums, text);
                    }
                }
                Pairs::Frozen(Rows { first, count, .. }) => {
                    self.write_term(term, [first, count], sums, text);
                }
            }
        }
        for (_, sum) in sums.iter().enumerate().filter(|(i, _)| self.is_added_to(*i)) {
            let _ = match (is_laned, self.order) {
                (true, _) => writeln!(
                    text,
                    "    const {work} {sum} = ((l{sum}[0] + l{sum}[4]) + (l{sum}[2] + l{sum}[6])) + \
                     ((l{sum}[1] + l{sum}[5]) + (l{sum}[3] + l{sum}[7]));"
                ),
                (false, Order::Lanes) => writeln!(
                    text,
                    "    {sum} += __shfl_down_sync(WHOLE_WARP, {sum}, 4, 8);\n    \
                     {sum} += __shfl_down_sync(WHOLE_WARP, {sum}, 2, 8);\n    \
                     {sum} += __shfl_down_sync(WHOLE_WARP, {sum}, 1, 8);"
                ),
                (false, Order::Single | Order::Fold) => Ok(()),
            };
        }
    }

    /// What is made of the sums.
    fn write_close(
        &self,
        close: &Law,
        scalars: &[&'static str],
        [columns, writes]: [&[Use]; 2],
        text: &mut String,
    ) {
        let sums = &self.sums[0];
        if self.has_lanes() {
            *text += "    if (!is_on || lane > 0) return;\n";
        }
        let mine = self.mine();
        let is_late = |column: &&Use| !mine.iter().any(|known| known.is_of(column));
        columns
            .iter()
            .filter(is_late)
            .for_each(|column| self.load(text, "    ", column, "my_", "a"));
        let outputs: Vec<String> = writes.iter().flat_map(|write| write.names("new_")).collect();
        let inputs = sums.iter().cloned().chain(scalars.iter().map(|name| name.to_string()));
        let inputs = inputs.chain(columns.iter().flat_map(|column| column.names("my_")));
        let pointers = outputs.iter().map(|name| format!("&{name}"));
        let _ = writeln!(
            text,
            "    real {};\n    {}({});",
            outputs.join(", "),
            close.name,
            join(inputs.chain(pointers))
        );
        writes.iter().for_each(|write| write.write(self.dialect, "new_", "    ", text));
        *text += "    }\n}\n";
    }

    /// Whether eight threads work on a particle.
    fn has_lanes(&self) -> bool {
        self.dialect.language == Language::Cuda && self.order != Order::Fold
    }

    /// What is known of the pair of a particle and its neighbour `b`, number `k` of its row.
    fn write_pair(&self, text: &mut String) {
        // Some threads go on beyond the end of their row, see `write_term`.
        let is_beyond = self.has_lanes() && self.order == Order::Single;
        let guard =
            |value: String| if is_beyond { format!("k < end ? {value} : 0") } else { value };
        match &self.pairs {
            Pairs::Moving { dimension, units, .. }
                if self.dialect.of_pairs() == Precision::Single =>
            {
                *text += &self.load_place(*dimension, "b", "there", "        ");
                for (axis, unit) in units.iter().enumerate() {
                    let unit = Precision::Single.literal(*unit);
                    let _ = writeln!(
                        text,
                        "        const work way_{axis} = p_way(here_{axis}, there_{axis}) * {unit};"
                    );
                }
            }
            Pairs::Moving { dimension, halves, .. } => {
                let [here, there, way] = ["here", "there", "way"].map(|of| axes(of, *dimension));
                *text += &self.load_place(*dimension, "b", "there", "        ");
                let apart = here.iter().zip(&there).zip(&way);
                let apart = apart.map(|((here, there), way)| format!("{way} = {here} - {there}"));
                let _ = writeln!(text, "        real {};", join(apart));
                // Few pairs reach across the end of a periodic axis.
                let beyond = way.iter().zip(halves).filter_map(|(way, half)| {
                    Some(format!("fabs({way}) > {}", Precision::Double.literal((*half)?)))
                });
                let beyond: Vec<String> = beyond.collect();
                if !beyond.is_empty() {
                    let places = here.iter().chain(&there).cloned();
                    let places = places.chain(way.iter().map(|way| format!("&{way}")));
                    let (name, places) = (self.name, join(places));
                    let beyond = beyond.join(" || ");
                    let _ = writeln!(text, "        if ({beyond}) {name}_separation({places});");
                }
            }
            Pairs::Frozen(Rows { numbers, kept, .. }) => {
                let (width, real) = (kept.iter().flatten().count(), self.dialect.token(numbers));
                text.push_str("        const unsigned block = from + k / 8;\n");
                for (number, place) in kept.iter().enumerate() {
                    let _ = match place {
                        Some(place) => {
                            let (row, first) = (8 * width, 8 * place);
                            let at = format!("{numbers}[(size_t)block * {row} + {first} + k % 8]");
                            writeln!(text, "        const {real} pair_{number} = {};", guard(at))
                        }
                        None => writeln!(text, "        const {real} pair_{number} = 0;"),
                    };
                }
            }
        }
    }

    fn write_term(
        &self,
        term: &Term,
        [first, count]: [&str; 2],
        sums: &[String],
        text: &mut String,
    ) {
        let (is_gpu, work) = (self.has_lanes(), self.dialect.of_pairs().token());
        // Where the neighbour of a place in the row stands.
        let entry = |k: &str| match &self.pairs {
            Pairs::Moving { .. } => format!("{ENTRIES}[from + {k}]"),
            Pairs::Frozen(rows) => format!("{}[from * 8 + {k}]", rows.neighbors),
        };
        let is_on = if is_gpu { format!("is_on ? {count}[a] : 0") } else { format!("{count}[a]") };
        let _ = writeln!(text, "    {{\n    const unsigned from = {first}[a], end = {is_on};");
        let _ = match (is_gpu, self.order) {
            (true, Order::Lanes) => writeln!(
                text,
                "    for (unsigned k = lane, next = k < end ? {} : 0; k < end; k += 8) {{",
                entry("k")
            ),
            // All threads of a warp go on until the longest of its rows has ended.
            (true, Order::Single) => writeln!(
                text,
                "    for (unsigned row = 0; __any_sync(WHOLE_WARP, row < end); row += 8) {{\n        \
                 const unsigned k = row + lane;"
            ),
            (_, _) => writeln!(text, "    for (unsigned k = 0; k < end; ++k) {{"),
        };
        let _ = match (is_gpu, self.order) {
            // The place of the next neighbour is read ahead: what is read of it waits for nothing else.
            (true, Order::Lanes) => writeln!(
                text,
                "        const unsigned b = next;\n        \
                 next = k + 8 < end ? {} : 0;",
                entry("k + 8")
            ),
            (true, _) => {
                writeln!(text, "        const unsigned b = k < end ? {} : a;", entry("k"))
            }
            _ => writeln!(text, "        const unsigned b = {};", entry("k")),
        };
        self.write_pair(text);
        for column in &term.others {
            self.load(text, "        ", column, "its_", "b");
        }
        let slots = vec!["(real)a".to_string(), "(real)b".to_string()];
        let [mine, others] = self.shown(term);
        let is_single = is_gpu && self.order == Order::Single;
        let kept = |(i, sum): (usize, &String)| match (is_gpu, self.order) {
            (false, Order::Lanes) if self.is_added_to(i) => format!("l{sum}[k % 8]"),
            _ if is_single => "0".into(),
            _ => sum.clone(),
        };
        let kept: Vec<String> = sums.iter().enumerate().map(kept).collect();
        let given: Vec<String> = match is_single {
            true => sums.iter().map(|sum| format!("t{sum}")).collect(),
            false => kept.clone(),
        };
        if is_single {
            let _ = writeln!(text, "        {work} {};", given.join(", "));
        }
        let inputs = [self.pair_names(), slots, mine, others, kept].concat();
        let pointers = given.iter().map(|sum| format!("&{sum}"));
        let call = join(inputs.into_iter().chain(pointers));
        let _ = writeln!(text, "        {}({call});", term.law.name);
        if is_single {
            text.push_str("        for (int j = 0; j < 8; ++j) {\n");
            for (i, (sum, given)) in sums.iter().zip(&given).enumerate() {
                if term.passes_on(i) {
                    continue;
                }
                let _ = writeln!(
                    text,
                    "            {{ const {work} t = __shfl_sync(WHOLE_WARP, {given}, j, 8); \
                     if (row + j < end) {sum} += t; }}"
                );
            }
            text.push_str("        }\n");
        }
        text.push_str("    }\n    }\n");
    }

    /// Loads a row of a column.
    fn load(&self, text: &mut String, indent: &str, column: &Use, prefix: &str, row: &str) {
        let row = match column.at {
            At::Through(index) => format!("{index}[{row}]"),
            At::Own | At::Spread => row.to_string(),
        };
        *text += &self.dialect.load(column.column, &row, &column.names(prefix), indent);
    }

    /// What both particles of a pair show to a law. In single precision [differences](crate::pass::difference) of columns in
    /// double precision are taken before, so that those of the particle itself are zero.
    fn shown(&self, term: &Term) -> [Vec<String>; 2] {
        let [mut mine, mut others] = term.shown();
        if self.dialect.of_pairs() == Precision::Double {
            return [mine, others];
        }
        let mut first = 0;
        for column in &term.mine {
            if column.is_difference && !self.dialect.is_narrow(column.column) {
                let own = &mut mine[first..first + column.width];
                for (my, i) in own.iter_mut().zip(term.other(column)) {
                    others[i] = format!("(work)({} - {my})", others[i]);
                    *my = "0".into();
                }
            }
            first += column.width;
        }
        [mine, others]
    }
}

/// Names of the numbers of a place.
fn axes(of: &str, dimension: usize) -> Vec<String> {
    (0..dimension).map(|axis| format!("{of}_{axis}")).collect()
}

fn join(all: impl Iterator<Item = String>) -> String {
    all.collect::<Vec<_>>().join(", ")
}
