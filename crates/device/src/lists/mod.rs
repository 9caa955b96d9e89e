//! Neighbour lists that a device makes itself.

mod grid;
mod scan;

use grid::{Grid, PARTS};
use scan::Scan;

use crate::device::{Argument, Column, Device, Kernel, Program};
use crate::dialect::{Dialect, Layout};
use crate::error::DeviceError;
use crate::text::{BLOCK, Language, Precision};

type Outcome<T> = Result<T, DeviceError>;

/// The bit of a particle that is passive.
const PASSIVE: u32 = 1 << 31;
/// That of one which neither sees others nor is seen.
const EXCLUDED: u32 = 1 << 30;

/// Neighbours of moving particles, with the rule of the processor: a row has those inside the support
/// at the current positions in the order of their numbers, first those that are not passive, then the
/// passive ones, and a passive particle sees only the others. It does not depend on when the list
/// was made.
///
/// A list is made of candidates, which are closer than the support and a skin, and holds until a
/// particle has moved by more than half of the skin. Then particles have new *slots*, in
/// which close ones are close in memory.
#[derive(Debug)]
pub struct Lists {
    device: Device,
    kernels: Kernels,
    grid: Grid,
    scan: Scan,
    count: usize,
    support: f64,
    reach: f64,
    periods: Column<f64>,
    /// The bits of what particles are, by number; none of those that are not passive.
    passive: Column<u32>,
    numbers: Column<u32>,
    slots: Column<u32>,
    made_at: Column<f64>,
    /// Number, with these bits, by slot.
    keys: Column<u32>,
    bounds: [[Column<f64>; 2]; 2],
    axes: Column<f64>,
    /// Cell of each number, and numbers by cell.
    cells: Column<u32>,
    members: Column<u32>,
    /// How many a cell has, none between two builds, and how many before it.
    in_cell: Column<u32>,
    start: Column<u32>,
    /// How many candidates a slot has, and how many before it.
    in_row: Column<u32>,
    first: Column<u32>,
    passive_first: Column<u32>,
    active: Column<u32>,
    passive_count: Column<u32>,
    candidates: Column<u32>,
    entries: Column<u32>,
    /// Candidates of all particles.
    total: usize,
}

#[derive(Debug)]
struct Kernels {
    bounds: Kernel,
    cells: Kernel,
    put: Kernel,
    order: Kernel,
    candidates: Kernel,
    sort: Kernel,
    pick: Kernel,
}

impl Kernels {
    fn new(program: &Program) -> Outcome<Self> {
        Ok(Self {
            bounds: program.kernel("list_bounds")?,
            cells: program.kernel("list_cells")?,
            put: program.kernel("list_put")?,
            order: program.kernel("list_order")?,
            candidates: program.kernel("list_candidates")?,
            sort: program.kernel("list_sort")?,
            pick: program.kernel("list_pick")?,
        })
    }
}

/// Threads that share a row.
fn lanes(language: Language) -> usize {
    if language == Language::Cuda { 32 } else { 1 }
}

/// The text of lists in space of which these axes are periodic.
pub fn text(language: Language, periodic: &[bool]) -> String {
    // Ways are compared as on the processor: the shorter one along periodic axes, squares one by one.
    let mut square = String::new();
    for (axis, is_periodic) in periodic.iter().enumerate() {
        square += &format!("    double d{axis} = here[{axis}] - there[{axis}];\n");
        if *is_periodic {
            square += &format!("    d{axis} = list_shorter(d{axis}, period[{axis}]);\n");
        }
        square += &format!("    square += d{axis} * d{axis};\n");
    }
    let layout = Layout { planes: &["position"], ..Layout::default() };
    let dialect = Dialect { language, layout };
    let names: Vec<String> = (0..periodic.len()).map(|axis| format!("x{axis}")).collect();
    let mut places = dialect.load("position", "s", &names, "    ");
    for (axis, name) in names.iter().enumerate() {
        places += &format!("    there[{axis}] = {name};\n");
    }
    let tools = match language {
        Language::Cuda => {
            "#define RESTRICT __restrict__\n#define ADD(at, number) atomicAdd(at, number)\n\
             #define VOTES(is) __ballot_sync(0xffffffffu, is)\n#define COUNT(votes) __popc(votes)\n"
        }
        Language::OpenCl => {
            "#define RESTRICT restrict\n#define ADD(at, number) atomic_add(at, number)\n\
             #define VOTES(is) (unsigned)(is)\n#define COUNT(votes) (votes)\n"
        }
        Language::C => {
            "LAW unsigned p_add(unsigned *at, unsigned number) { const unsigned was = *at; *at += number; return was; }\n\
             #define RESTRICT restrict\n#define ADD(at, number) p_add(at, number)\n\
             #define VOTES(is) (unsigned)(is)\n#define COUNT(votes) (votes)\n"
        }
    };
    format!(
        "{}{tools}#define D {}\n#define LANES {}\n\
         LAW double list_shorter(const double way, const double period)\n{{\n    \
         const double half_way = 0.5 * period;\n    \
         const double down = way > half_way ? way - period : way;\n    \
         return way < -half_way ? way + period : down;\n}}\n\
         LAW double list_square(const double *here, const double *period, const double *there)\n{{\n    \
         double square = 0;\n{square}    return square;\n}}\n\
         LAW void list_place(GLOBAL const double *position, const int position_rows, const unsigned s, double *there)\n{{\n\
         {places}}}\n{}",
        language.prologue(Precision::Double),
        periodic.len(),
        lanes(language),
        include_str!("text.c"),
    )
}

impl Lists {
    /// Lists of particles, passive or not by number, for a support radius and a skin in m, in space of 1 to
    /// 3 axes, each open or periodic between bounds in m.
    ///
    /// # Errors
    /// When there are too many particles, the memory does not suffice, or the text does not compile.
    pub fn new(
        device: &Device,
        passive: &[bool],
        support: f64,
        skin: f64,
        periodic: &[Option<[f64; 2]>],
    ) -> Outcome<Self> {
        let count = passive.len();
        if count > i32::MAX as usize / 32 {
            return Err(DeviceError::TooMany { what: "particles", count });
        }
        let is_periodic: Vec<bool> = periodic.iter().map(Option::is_some).collect();
        let program = device.compile(&text(device.language(), &is_periodic), Precision::Double)?;
        let dimension = periodic.len();
        let reach = support + skin;
        let grid = Grid::new(count, reach, periodic);
        let periods: Vec<f64> = periodic
            .iter()
            .map(|bounds| bounds.map_or(f64::INFINITY, |[lower, upper]| upper - lower))
            .collect();
        let passive: Vec<u32> =
            passive.iter().map(|is_passive| if *is_passive { PASSIVE } else { 0 }).collect();
        let part = || -> Outcome<_> {
            let length = dimension * PARTS[0];
            Ok([device.zeros(length)?, device.zeros(length)?])
        };
        let many = |length| device.zeros::<u32>(length);
        Ok(Self {
            kernels: Kernels::new(&program)?,
            scan: Scan::new(device, &program, grid.most().max(count) + 1)?,
            passive: device.upload(&passive)?,
            numbers: many(count)?,
            slots: many(count)?,
            made_at: device.zeros(dimension * count)?,
            keys: many(count)?,
            bounds: [part()?, part()?],
            axes: device.zeros(12)?,
            cells: many(count)?,
            members: many(count)?,
            in_cell: many(grid.most() + 1)?,
            start: many(grid.most() + 1)?,
            in_row: many(count + 1)?,
            first: many(count + 1)?,
            passive_first: many(count)?,
            active: many(count)?,
            passive_count: many(count)?,
            candidates: many(0)?,
            entries: many(0)?,
            total: 0,
            device: device.clone(),
            periods: device.upload(&periods)?,
            grid,
            count,
            support,
            reach,
        })
    }

    /// Sets which particles are passive, and which of them neither see others nor are seen, by number,
    /// from the next build on.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn exclude(&mut self, passive: &[bool], excluded: &[bool]) -> Outcome<()> {
        let bits = passive.iter().zip(excluded).map(|kinds| match kinds {
            (_, true) => PASSIVE | EXCLUDED,
            (true, false) => PASSIVE,
            (false, false) => 0,
        });
        self.device.write(&mut self.passive, &bits.collect::<Vec<_>>())
    }

    /// Makes slots and candidates anew of positions in m by number, one particle after the other, inside
    /// the bounds of periodic axes. Rows are there after [`pick`](Self::pick).
    ///
    /// # Errors
    /// When there are too many candidates or too little memory for them, or the device fails.
    pub fn build(&mut self, position_by_number: &Column<f64>) -> Outcome<()> {
        position_by_number.holds(self.made_at.len())?;
        if self.count == 0 {
            return Ok(());
        }
        let position = Argument::Doubles(position_by_number);
        self.fit(position)?;
        let n = Argument::Count(self.count as i32);
        let (axes, cells) = (Argument::Doubles(&self.axes), Argument::Indices(&self.cells));
        let (in_cell, start) = (Argument::Indices(&self.in_cell), Argument::Indices(&self.start));
        let (members, keys) = (Argument::Indices(&self.members), Argument::Indices(&self.keys));
        let (slots, made_at) = (Argument::Indices(&self.slots), Argument::Doubles(&self.made_at));
        let kernels = &self.kernels;
        kernels.cells.start(self.count, BLOCK, &[n, axes, position, cells, in_cell])?;
        self.scan.start(&self.in_cell, self.grid.cells() + 1, &self.start)?;
        kernels.put.start(self.count, BLOCK, &[n, cells, start, in_cell, members])?;
        let (passive, numbers) =
            (Argument::Indices(&self.passive), Argument::Indices(&self.numbers));
        let order = [n, passive, cells, start, members, position, numbers, slots, keys, made_at];
        kernels.order.start(self.count, BLOCK, &order)?;
        self.search(0)?;
        self.scan.start(&self.in_row, self.count + 1, &self.first)?;
        self.total = self.scan.total(&self.device, self.count + 1)?;
        if self.total > i32::MAX as usize {
            return Err(DeviceError::TooMany { what: "pairs of particles", count: self.total });
        }
        if self.total > self.candidates.len() {
            // What is there is given back first.
            (self.candidates, self.entries) = (self.device.zeros(0)?, self.device.zeros(0)?);
            let room = self.total + self.total / 8;
            (self.candidates, self.entries) = (self.device.zeros(room)?, self.device.zeros(room)?);
        }
        self.search(1)?;
        let first = Argument::Indices(&self.first);
        let [candidates, entries] = [&self.candidates, &self.entries].map(Argument::Indices);
        let threads = self.count * lanes(self.device.language());
        self.kernels.sort.start(threads, BLOCK, &[n, first, entries, slots, candidates])
    }

    /// Lays the grid over the particles.
    fn fit(&mut self, position: Argument<'_>) -> Outcome<()> {
        let [[low, high], [lower, upper]] =
            self.bounds.each_ref().map(|pair| pair.each_ref().map(Argument::Doubles));
        let [many, few] = PARTS.map(|threads| Argument::Count(threads as i32));
        let n = Argument::Count(self.count as i32);
        let kernel = &self.kernels.bounds;
        kernel.start(PARTS[0], BLOCK, &[n, many, position, position, low, high])?;
        kernel.start(PARTS[1], BLOCK, &[many, few, low, high, lower, upper])?;
        let [lower, upper] = &self.bounds[1];
        let axes = self.grid.fit(|low, high| {
            self.device.read(lower, low)?;
            self.device.read(upper, high)
        })?;
        self.device.write(&mut self.axes, &axes)
    }

    /// Counts candidates, or writes their keys where rows will stand.
    fn search(&self, writes: i32) -> Outcome<()> {
        let index = Argument::Indices;
        let arguments = [
            Argument::Count(self.count as i32),
            Argument::Count(writes),
            Argument::Number(self.reach),
            Argument::Doubles(&self.periods),
            Argument::Doubles(&self.axes),
            index(&self.start),
            Argument::Doubles(&self.made_at),
            index(&self.keys),
            index(&self.in_row),
            index(&self.active),
            index(&self.first),
            index(&self.passive_first),
            index(&self.entries),
        ];
        self.kernels.candidates.start(self.count, BLOCK, &arguments)
    }

    /// Picks those inside the support at positions in m by slot, in [planes](Layout::planes).
    ///
    /// # Errors
    /// When positions are missing, or the device fails.
    pub fn pick(&mut self, position_by_slot: &Column<f64>) -> Outcome<()> {
        position_by_slot.holds(self.made_at.len())?;
        // A build that found no room for candidates has told where they would be.
        self.candidates.holds(self.total)?;
        let index = Argument::Indices;
        let arguments = [
            Argument::Count(self.count as i32),
            Argument::Number(self.support),
            Argument::Doubles(&self.periods),
            Argument::Doubles(position_by_slot),
            index(&self.first),
            index(&self.passive_first),
            index(&self.candidates),
            index(&self.active),
            index(&self.passive_count),
            index(&self.entries),
        ];
        let threads = self.count * lanes(self.device.language());
        self.kernels.pick.start(threads, BLOCK, &arguments)
    }

    /// The column of indices that passes know by a name: `numbers`, `slots`, those of rows, and `passive`,
    /// which is zero for particles that are not.
    pub(crate) fn indices(&self, name: &str) -> Option<&Column<u32>> {
        Some(match name {
            "numbers" => &self.numbers,
            "slots" => &self.slots,
            "passive" => &self.passive,
            "first" => &self.first,
            "active" => &self.active,
            "passive_first" => &self.passive_first,
            "passive_count" => &self.passive_count,
            "entries" => &self.entries,
            _ => return None,
        })
    }

    /// Number of the particle in each slot.
    pub fn numbers(&self) -> &Column<u32> {
        &self.numbers
    }

    /// Slot of each particle.
    pub fn slots(&self) -> &Column<u32> {
        &self.slots
    }

    /// Positions in m by slot that the candidates were looked for at.
    pub fn made_at(&self) -> &Column<f64> {
        &self.made_at
    }

    /// Where the row of each slot begins with those that are not passive.
    pub fn first(&self) -> &Column<u32> {
        &self.first
    }

    /// How many neighbours of each slot are not passive.
    pub fn active(&self) -> &Column<u32> {
        &self.active
    }

    /// Where the passive neighbours of each slot begin.
    pub fn passive_first(&self) -> &Column<u32> {
        &self.passive_first
    }

    /// How many neighbours of each slot are passive.
    pub fn passive_count(&self) -> &Column<u32> {
        &self.passive_count
    }

    /// Slots of neighbours, row after row, with room between rows.
    pub fn entries(&self) -> &Column<u32> {
        &self.entries
    }

    /// Candidates of all particles.
    pub fn candidates(&self) -> usize {
        self.total
    }
}
