//! Unstructured grids in VTK's legacy format, ASCII.

use super::words::Words;
use super::{Cell, CellKind, Fault, Mesh, MeshFault, node};

pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut words = Words::new(bytes);
    // `# vtk DataFile Version x.y`, and a title of any text.
    words.word();
    words.end_line();
    words.end_line();
    let format = words.some("ASCII")?;
    if format.eq_ignore_ascii_case("BINARY") {
        let what = "a binary file of VTK's legacy format".to_owned();
        let help = "write it as ASCII, or as .vtu";
        return Err(words.fault(MeshFault::Unsupported { what, help }));
    }
    if !format.eq_ignore_ascii_case("ASCII") {
        return Err(words.unexpected(format, "ASCII"));
    }
    words.take("DATASET")?;
    words.take("UNSTRUCTURED_GRID")?;
    let mut grid = Grid::default();
    while let Some(keyword) = words.word() {
        grid.section(&keyword.to_ascii_uppercase(), &mut words)?;
    }
    grid.finish()
}

/// What has been read so far.
#[derive(Default)]
struct Grid {
    mesh: Mesh,
    /// Ends of the cells in the list of their nodes.
    ends: Vec<usize>,
    nodes: Vec<f64>,
    lines: Vec<u64>,
    kinds: Vec<u64>,
    data: Vec<(String, Vec<f64>, bool)>,
    /// Whether data are those of cells, and how many there are.
    of: Option<(bool, usize)>,
}

impl Grid {
    fn section(&mut self, keyword: &str, words: &mut Words<'_>) -> Result<(), Fault> {
        match keyword {
            "POINTS" => self.points(words),
            "CELLS" => self.cells(words),
            "CELL_TYPES" => {
                for _ in 0..words.number::<u64>("the number of cells")? {
                    self.kinds.push(words.number("the type of a cell")?);
                }
                Ok(())
            }
            "POINT_DATA" => self.start_data(false, words),
            "CELL_DATA" => self.start_data(true, words),
            "METADATA" => {
                // To the next line that is empty.
                loop {
                    words.end_line();
                    if words.is_at_end() || words.rest_of_line().is_empty() {
                        return Ok(());
                    }
                }
            }
            "FIELD" => self.field(words),
            _ => self.attribute(keyword, words),
        }
    }

    fn points(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let count = words.number::<u64>("the number of points")?;
        words.some("the type of numbers")?;
        for _ in 0..count {
            let mut place = [0.0; 3];
            for x in &mut place {
                *x = words.real("a coordinate")?;
            }
            self.mesh.nodes.push(place);
        }
        Ok(())
    }

    /// Rows of a count and the nodes; since version 5 a list of ends and one of nodes.
    fn cells(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let count = words.number::<u64>("the number of cells")?;
        let size = words.number::<u64>("the length of the list of cells")?;
        if words.peek().is_some_and(|word| word.eq_ignore_ascii_case("OFFSETS")) {
            words.word();
            words.some("the type of numbers")?;
            for place in 0..count {
                let end = words.number("the end of a cell")?;
                if place > 0 {
                    self.ends.push(end);
                }
            }
            words.take("CONNECTIVITY")?;
            words.some("the type of numbers")?;
            for _ in 0..size {
                self.nodes.push(words.number("the number of a node")?);
            }
            return Ok(());
        }
        for _ in 0..count {
            let length = words.number::<u64>("the number of nodes of a cell")?;
            self.lines.push(words.line());
            for _ in 0..length {
                self.nodes.push(words.number("the number of a node")?);
            }
            self.ends.push(self.nodes.len());
        }
        Ok(())
    }

    fn start_data(&mut self, of_cells: bool, words: &mut Words<'_>) -> Result<(), Fault> {
        let got = words.number("the number of values")?;
        let expected = if of_cells { self.ends.len() } else { self.mesh.nodes.len() };
        if got != expected {
            let what = (if of_cells { "CELL_DATA" } else { "POINT_DATA" }).to_owned();
            return Err(words.fault(MeshFault::Count { what, got, expected }));
        }
        self.of = Some((of_cells, got));
        Ok(())
    }

    fn field(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        words.some("the name of a field")?;
        for _ in 0..words.number::<u64>("the number of arrays")? {
            let name = words.some("the name of an array")?;
            if name.eq_ignore_ascii_case("METADATA") {
                self.section("METADATA", words)?;
                continue;
            }
            let components = words.number::<u64>("the number of components")?;
            let count = words.number::<u64>("the number of values")?;
            let kind = words.some("the type of numbers")?;
            if kind.eq_ignore_ascii_case("string") {
                let what = format!("the string array `{name}`");
                return Err(words.fault(MeshFault::Unsupported { what, help: "leave it out" }));
            }
            self.array(name, components, count, words)?;
        }
        Ok(())
    }

    fn attribute(&mut self, keyword: &str, words: &mut Words<'_>) -> Result<(), Fault> {
        let components = match keyword {
            "SCALARS" | "GLOBAL_IDS" | "PEDIGREE_IDS" => 1,
            "VECTORS" | "NORMALS" => 3,
            "TENSORS" => 9,
            _ => return Err(words.unexpected(keyword, "a section of an unstructured grid")),
        };
        let name = words.some("the name of an array")?;
        words.some("the type of numbers")?;
        let mut components = components;
        if keyword == "SCALARS" {
            if words.peek().is_some_and(|word| word.parse::<u64>().is_ok()) {
                components = words.number("the number of components")?;
            }
            words.take("LOOKUP_TABLE")?;
            words.some("the name of a table")?;
        }
        let count = self.of.map_or(0, |(_, count)| count as u64);
        self.array(name, components, count, words)
    }

    fn array(
        &mut self,
        name: &str,
        components: u64,
        count: u64,
        words: &mut Words<'_>,
    ) -> Result<(), Fault> {
        let mut values = Vec::new();
        // Without components nothing would be read, however many values there are.
        for _ in 0..if components == 0 { 0 } else { count } {
            for component in 0..components {
                let value = words.number::<f64>("a value")?;
                if component == 0 {
                    values.push(value);
                }
            }
        }
        if let Some((of_cells, count)) = self.of
            && components == 1
            && values.len() == count
        {
            self.data.push((name.to_owned(), values, of_cells));
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Mesh, Fault> {
        let count = self.ends.len();
        let lines = (!self.lines.is_empty()).then_some(&self.lines[..]);
        add_cells(&mut self.mesh, &self.ends, &self.nodes, &self.kinds, lines)?;
        for (name, values, of_cells) in self.data {
            let expected = if of_cells { count } else { self.mesh.nodes.len() };
            if values.len() == expected {
                self.mesh.add_data(&name, values, of_cells);
            }
        }
        Ok(self.mesh)
    }
}

/// Adds cells by the ends of their stretches of a list of nodes.
pub(super) fn add_cells(
    mesh: &mut Mesh,
    ends: &[usize],
    nodes: &[f64],
    kinds: &[u64],
    lines: Option<&[u64]>,
) -> Result<(), Fault> {
    let count = |what: &str, got: usize, expected: usize| {
        (None, MeshFault::Count { what: what.to_owned(), got, expected })
    };
    if kinds.len() != ends.len() {
        return Err(count("the list of cell types", kinds.len(), ends.len()));
    }
    let mut start = 0;
    for (number, (&end, &kind)) in (0u64..).zip(ends.iter().zip(kinds)) {
        let line = lines.and_then(|lines| lines.get(number as usize)).copied();
        let (kind, order) = CellKind::of_vtk(kind).map_err(|fault| (line, fault))?;
        let own = nodes.get(start..end).unwrap_or(&[]);
        if own.len() != kind.nodes() {
            let what = format!("the list of nodes of cell {number}");
            let fault = MeshFault::Count { what, got: own.len(), expected: kind.nodes() };
            return Err((line, fault));
        }
        let mut known = [0; 8];
        for (place, known) in known.iter_mut().enumerate().take(own.len()) {
            let wanted = own[order.map_or(place, |order| order[place])];
            *known = node(wanted, mesh.nodes.len(), number).map_err(|fault| (line, fault))?;
        }
        mesh.cells.push(Cell::new(kind, number, line.unwrap_or(0), &known));
        start = end;
    }
    Ok(())
}
