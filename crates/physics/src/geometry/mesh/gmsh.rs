//! Meshes of Gmsh, versions 4.1 and 2.2 of its format, ASCII.

use std::collections::{BTreeMap, HashMap};

use super::words::Words;
use super::{Cell, CellKind, Fault, Mesh, MeshFault};

/// What has been read so far.
#[derive(Default)]
struct Reader {
    mesh: Mesh,
    /// Number of a node in the mesh by its number in the file, and likewise of cells.
    nodes: HashMap<u64, u32>,
    cells: HashMap<u64, u32>,
    /// Names of physical groups by dimension and number.
    names: BTreeMap<(u64, u64), String>,
    /// Physical groups of an entity by its dimension and number.
    groups: HashMap<(u64, i64), Vec<u64>>,
    has_nodes: bool,
}

pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut words = Words::new(bytes);
    let mut reader = Reader::default();
    words.take("$MeshFormat")?;
    let version = words.some("the version of the format")?;
    let is_new = match version {
        "4.1" => true,
        "2" | "2.0" | "2.1" | "2.2" => false,
        _ => {
            let what = format!("version {} of Gmsh's format", version.escape_debug());
            let help = "save the mesh as version 4.1 or 2.2 (Mesh.MshFileVersion)";
            return Err(words.fault(MeshFault::Unsupported { what, help }));
        }
    };
    if words.number::<u64>("0 for ASCII")? != 0 {
        let what = "a binary mesh of Gmsh".to_owned();
        let help = "save it as ASCII (Mesh.Binary = 0)";
        return Err(words.fault(MeshFault::Unsupported { what, help }));
    }
    words.number::<u64>("the size of a number")?;
    words.take("$EndMeshFormat")?;
    while let Some(section) = words.word() {
        match section {
            "$PhysicalNames" => reader.names(&mut words)?,
            "$Entities" => reader.entities(&mut words)?,
            "$Nodes" if is_new => reader.blocks_of_nodes(&mut words)?,
            "$Nodes" => reader.nodes(&mut words)?,
            "$Elements" if is_new => reader.blocks_of_cells(&mut words)?,
            "$Elements" => reader.cells(&mut words)?,
            "$NodeData" => reader.data(&mut words, false)?,
            "$ElementData" => reader.data(&mut words, true)?,
            "$PartitionedEntities" => {
                let what = "a mesh in partitions".to_owned();
                let help = "save it as a whole";
                return Err(words.fault(MeshFault::Unsupported { what, help }));
            }
            other if other.starts_with('$') => skip(&mut words, other)?,
            other => return Err(words.unexpected(other, "a section, which starts with `$`")),
        }
    }
    if !reader.has_nodes {
        return Err((None, MeshFault::Missing { what: "section $Nodes".into() }));
    }
    Ok(reader.mesh)
}

/// Passes over a section.
fn skip(words: &mut Words<'_>, section: &str) -> Result<(), Fault> {
    let end = format!("$End{}", &section[1..]);
    while words.some("the end of a section, `$End...`")? != end {}
    Ok(())
}

impl Reader {
    fn names(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        for _ in 0..words.number::<u64>("the number of names")? {
            let dimension = words.number("the dimension of a group")?;
            let tag = words.number("the number of a group")?;
            let name = words.rest_of_line().trim_matches('"').to_owned();
            self.names.insert((dimension, tag), name);
        }
        words.take("$EndPhysicalNames")
    }

    /// The name of a physical group, its number if it has none.
    fn name(&self, dimension: u64, tag: u64) -> String {
        self.names.get(&(dimension, tag)).cloned().unwrap_or_else(|| tag.to_string())
    }

    fn entities(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let mut counts = [0u64; 4];
        for count in &mut counts {
            *count = words.number("the number of entities")?;
        }
        for (dimension, count) in (0u64..).zip(counts) {
            for _ in 0..count {
                let tag: i64 = words.number("the number of an entity")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    words.real("a bound of an entity")?;
                }
                let mut groups = Vec::new();
                for _ in 0..words.number::<u64>("the number of groups of an entity")? {
                    // The sign is the direction.
                    groups.push(words.number::<i64>("the number of a group")?.unsigned_abs());
                }
                if dimension > 0 {
                    for _ in 0..words.number::<u64>("the number of bounds of an entity")? {
                        words.number::<i64>("the number of an entity")?;
                    }
                }
                self.groups.insert((dimension, tag), groups);
            }
        }
        words.take("$EndEntities")
    }

    fn blocks_of_nodes(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let blocks = words.number::<u64>("the number of blocks")?;
        for _ in 0..3 {
            words.number::<u64>("the number of nodes, the smallest and the largest of them")?;
        }
        for _ in 0..blocks {
            let dimension = words.number::<u64>("the dimension of a block")?;
            words.number::<i64>("the number of an entity")?;
            let is_parametric = words.number::<u64>("0 or 1")? != 0;
            let mut numbers = Vec::new();
            for _ in 0..words.number::<u64>("the number of nodes of a block")? {
                numbers.push(words.number("the number of a node")?);
            }
            for number in numbers {
                self.node(number, words)?;
                for _ in 0..if is_parametric { dimension.min(3) } else { 0 } {
                    words.real("a parameter of a node")?;
                }
            }
        }
        words.take("$EndNodes")
    }

    fn nodes(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        for _ in 0..words.number::<u64>("the number of nodes")? {
            let number = words.number("the number of a node")?;
            self.node(number, words)?;
        }
        words.take("$EndNodes")
    }

    fn node(&mut self, number: u64, words: &mut Words<'_>) -> Result<(), Fault> {
        let mut place = [0.0; 3];
        for x in &mut place {
            *x = words.real("a coordinate")?;
        }
        self.has_nodes = true;
        if self.nodes.insert(number, self.mesh.nodes.len() as u32).is_some() {
            return Err(words.fault(MeshFault::Twice { what: "node", number }));
        }
        self.mesh.nodes.push(place);
        Ok(())
    }

    fn blocks_of_cells(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let blocks = words.number::<u64>("the number of blocks")?;
        for _ in 0..3 {
            words.number::<u64>("the number of elements, the smallest and the largest of them")?;
        }
        for _ in 0..blocks {
            let dimension = words.number("the dimension of a block")?;
            let entity = words.number("the number of an entity")?;
            let kind = words.number("the type of an element")?;
            let kind = CellKind::of_gmsh(kind).map_err(|fault| words.fault(fault))?;
            let groups = self.groups.get(&(dimension, entity)).cloned().unwrap_or_default();
            let names: Vec<String> = groups.iter().map(|tag| self.name(dimension, *tag)).collect();
            for _ in 0..words.number::<u64>("the number of elements of a block")? {
                let number = words.number("the number of an element")?;
                self.cell(kind, number, &names, words)?;
            }
        }
        words.take("$EndElements")
    }

    fn cells(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        for _ in 0..words.number::<u64>("the number of elements")? {
            let number = words.number("the number of an element")?;
            let kind = words.number("the type of an element")?;
            let kind = CellKind::of_gmsh(kind).map_err(|fault| words.fault(fault))?;
            let mut names = Vec::new();
            for place in 0..words.number::<u64>("the number of tags of an element")? {
                let tag = words.number::<i64>("a tag of an element")?.unsigned_abs();
                if place == 0 && tag != 0 {
                    names.push(self.name(kind.dimension() as u64, tag));
                }
            }
            self.cell(kind, number, &names, words)?;
        }
        words.take("$EndElements")
    }

    fn cell(
        &mut self,
        kind: CellKind,
        number: u64,
        names: &[String],
        words: &mut Words<'_>,
    ) -> Result<(), Fault> {
        let mut nodes = [0; 8];
        for node in nodes.iter_mut().take(kind.nodes()) {
            let wanted = words.number::<u64>("the number of a node")?;
            let unknown = MeshFault::UnknownNode { cell: number, node: wanted as f64 };
            *node = *self.nodes.get(&wanted).ok_or_else(|| words.fault(unknown))?;
        }
        let index = self.mesh.cells.len() as u32;
        let again = self.cells.insert(number, index);
        if let Some(first) = again {
            // A cell of several groups is written once for each of them in version 2.
            if self.mesh.cells[first as usize].nodes() != &nodes[..kind.nodes()] {
                return Err(words.fault(MeshFault::Twice { what: "element", number }));
            }
            self.cells.insert(number, first);
        } else {
            self.mesh.cells.push(Cell::new(kind, number, words.line(), &nodes));
        }
        for name in names {
            self.mesh.put(name.clone(), again.unwrap_or(index));
        }
        Ok(())
    }

    /// Values at nodes or in cells; those of one number are kept.
    fn data(&mut self, words: &mut Words<'_>, is_of_cells: bool) -> Result<(), Fault> {
        let mut name = String::new();
        for place in 0..words.number::<u64>("the number of string tags")? {
            let first = words.some("a string tag")?;
            // A text may have blanks.
            let rest = words.rest_of_line();
            if place == 0 {
                name = format!("{first} {rest}").trim().trim_matches('"').to_owned();
            }
        }
        for _ in 0..words.number::<u64>("the number of real tags")? {
            words.real("a real tag")?;
        }
        let mut tags = Vec::new();
        for _ in 0..words.number::<u64>("the number of integer tags")? {
            tags.push(words.number::<u64>("an integer tag")?);
        }
        let &[_, components, count, ..] = &tags[..] else {
            let (got, expected) = (tags.len(), 3);
            let what = format!("the list of integer tags of `{name}`");
            return Err(words.fault(MeshFault::Count { what, got, expected }));
        };
        let known = if is_of_cells { &self.cells } else { &self.nodes };
        let length = if is_of_cells { self.mesh.cells.len() } else { self.mesh.nodes.len() };
        let mut values = vec![f64::NAN; length];
        for _ in 0..count {
            let number = words.number::<u64>("the number of a node or an element")?;
            let index = known.get(&number).copied();
            for component in 0..components {
                let value = words.real("a value")?;
                if let (0, Some(index)) = (component, index) {
                    values[index as usize] = value;
                }
            }
        }
        if components == 1 {
            let data = match is_of_cells {
                true => &mut self.mesh.cell_data,
                false => &mut self.mesh.node_data,
            };
            data.insert(name, values);
        }
        words.take(if is_of_cells { "$EndElementData" } else { "$EndNodeData" })
    }
}
