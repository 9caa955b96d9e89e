//! Shapes: from numbers, and from files.

use super::*;

/// A shape, as an entry of a list.
pub(super) static ANY_SHAPE: Kind = Kind::Tagged(&SHAPE);

const ENDS_ALONG_Z: KeySpec = key(
    "z",
    Kind::Numbers(Length::Ends, Interval::ANY),
    "m",
    Derived("needed in 3D"),
    "the ends along z",
);
const SCALE: KeySpec = key(
    "scale",
    Kind::Number(Interval::POSITIVE),
    "m",
    Default("1.0"),
    "length of a unit of the file: 0.001 for millimetres",
);

pub(super) static SHAPE: TaggedSpec = TaggedSpec {
    title: "shape",
    meaning: "A region that particles fill.",
    common: &[],
    kinds: &[
        KindSpec {
            name: "box",
            meaning: "the box between two corners",
            dimensions: &[1, 2, 3],
            keys: CORNERS,
        },
        KindSpec {
            name: "ball",
            meaning: "a ball, in 2D a disc",
            dimensions: &[1, 2, 3],
            keys: ROUND,
        },
        KindSpec {
            name: "annulus",
            meaning: "the region between two radii: a ring in 2D, a hollow ball in 3D",
            dimensions: &[2, 3],
            keys: &[
                key("center", POINT, "m", Required, "centre"),
                key("inner", Kind::Number(Interval::POSITIVE), "m", Required, "inner radius"),
                key("outer", Kind::Number(Interval::POSITIVE), "m", Required, "outer radius"),
            ],
        },
        KindSpec {
            name: "cylinder",
            meaning: "a straight cylinder",
            dimensions: &[3],
            keys: &[
                key("start", POINT, "m", Required, "centre of one end"),
                key("end", POINT, "m", Required, "centre of the other end"),
                key("radius", Kind::Number(Interval::POSITIVE), "m", Required, "radius"),
            ],
        },
        KindSpec {
            name: "polygon",
            meaning: "what straight sides enclose in the plane of x and y; in 3D from one `z` to another",
            dimensions: &[2, 3],
            keys: &[
                key(
                    "corners",
                    Kind::List(&Kind::Numbers(Length::Pair, Interval::ANY)),
                    "m",
                    Required,
                    "x and y of the corners in order, clockwise or counter-clockwise",
                ),
                ENDS_ALONG_Z,
            ],
        },
        KindSpec {
            name: "outline",
            meaning: "the region enclosed by the closed loops of a drawing: the paths and polygons of an SVG, whose y axis is turned upwards, or a CSV file with the columns x and y, and `loop` where there are several; in 3D from one `z` to another. A loop inside another one is a hole",
            dimensions: &[2, 3],
            keys: &[
                FILE,
                SCALE,
                key(
                    "move",
                    Kind::Numbers(Length::Pair, Interval::ANY),
                    "m",
                    Derived("the origin"),
                    "position to which the origin of the file is then moved",
                ),
                ENDS_ALONG_Z,
            ],
        },
        KindSpec {
            name: "surface",
            meaning: "the region enclosed by a closed triangulated surface: STL, binary or ASCII, OBJ or PLY. Small holes and flipped or duplicate facets do no harm and are reported",
            dimensions: &[3],
            keys: &[
                FILE,
                SCALE,
                key(
                    "angle",
                    Kind::Number(Interval::ANY),
                    "rad",
                    Default("0.0"),
                    "angle by which it is then rotated about the origin of the file, counter-clockwise as seen from the tip of the axis",
                ),
                key(
                    "axis",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "1",
                    Derived("z"),
                    "the direction of the axis, of any length",
                ),
                key(
                    "move",
                    POINT,
                    "m",
                    Derived("the origin"),
                    "position to which the origin of the file is then moved",
                ),
            ],
        },
        KindSpec {
            name: "turned",
            meaning: "another shape, rotated; if it is the whole shape of a body, together with the lattice of the particles",
            dimensions: &[2, 3],
            keys: &[
                key("of", Kind::Tagged(&SHAPE), "", Required, "the shape"),
                key(
                    "angle",
                    Kind::Number(Interval::ANY),
                    "rad",
                    Required,
                    "angle by which it is rotated, counter-clockwise as seen from the tip of the axis: `10 * pi / 180` is 10 degrees",
                ),
                key("about", POINT, "m", Derived("the origin"), "a fixed point of the rotation"),
                key(
                    "axis",
                    Kind::Numbers(Length::Dimension, Interval::ANY),
                    "1",
                    Derived("z in 2D; needed in 3D"),
                    "the direction of the axis, of any length",
                ),
            ],
        },
        KindSpec {
            name: "layer",
            meaning: "the layer of a given thickness along the boundary of another shape: the wall of a vessel or the skin of a body from the same file. As a wall it keeps fluid behind that boundary, on the side where the layer is not; no fluid may touch its far face",
            dimensions: &[1, 2, 3],
            keys: &[
                key(
                    "of",
                    Kind::Tagged(&SHAPE),
                    "",
                    Required,
                    "the shape: any but a combination, points, a mesh or another layer",
                ),
                key("thickness", Kind::Number(Interval::POSITIVE), "m", Required, "its thickness"),
                key(
                    "side",
                    Kind::Name(LAYER_SIDES),
                    "",
                    Default("\"outside\""),
                    "on which side of the boundary of the shape it is",
                ),
            ],
        },
        KindSpec {
            name: "union",
            meaning: "points in any of several shapes",
            dimensions: &[1, 2, 3],
            keys: &[key("of", Kind::List(&Kind::Tagged(&SHAPE)), "", Required, "the shapes")],
        },
        KindSpec {
            name: "intersection",
            meaning: "points in all of several shapes",
            dimensions: &[1, 2, 3],
            keys: &[key("of", Kind::List(&Kind::Tagged(&SHAPE)), "", Required, "the shapes")],
        },
        KindSpec {
            name: "difference",
            meaning: "points in one shape and in none of several others",
            dimensions: &[1, 2, 3],
            keys: &[
                key("from", Kind::Tagged(&SHAPE), "", Required, "the shape to cut from"),
                key(
                    "remove",
                    Kind::List(&Kind::Tagged(&SHAPE)),
                    "",
                    Required,
                    "the shapes to cut away",
                ),
            ],
        },
        KindSpec {
            name: "points",
            meaning: "the points of a CSV file with the columns x, y, z (as many as there are dimensions) and volume",
            dimensions: &[1, 2, 3],
            keys: &[FILE],
        },
        KindSpec {
            name: "mesh",
            meaning: "the nodes or the cells of a finite-element mesh, with its boundary: Gmsh (`.msh` 4.1 or 2.2, ASCII) or an unstructured VTK grid (`.vtk` ASCII, `.vtu`) of straight-edged cells",
            dimensions: &[1, 2, 3],
            keys: MESH,
        },
    ],
};

const LAYER_SIDES: Choices = choices(&[
    choice("outside", "around the shape, with rounded edges"),
    choice("inside", "in the shape"),
]);

/// A file of a shape.
const FILE: KeySpec =
    key("file", Kind::File, "", Required, "the file, relative to the folder of the case file");

const MESH: &[KeySpec] = &[
    FILE,
    key("points", Kind::Name(CLOUD_POINTS), "", Default("\"nodes\""), "positions of the particles"),
    key(
        "volumes",
        Kind::Name(CLOUD_VOLUMES),
        "",
        Default("\"cells\""),
        "volumes of the particles, which always sum to that of the cells",
    ),
    key(
        "array",
        Kind::Text,
        "",
        Optional,
        "with `volumes = \"array\"`, the name of the node or cell array that contains them, in m^D",
    ),
    key(
        "spacings",
        Kind::Text,
        "",
        Derived("the edges of cubes with the volume of the kernel weights"),
        "the name of the node or cell array that contains the particle spacings in m, the unit of supports",
    ),
    key(
        "part",
        Kind::Text,
        "",
        Derived("all cells of the case's dimension"),
        "named set of cells that forms the body",
    ),
];
const CLOUD_POINTS: Choices =
    choices(&[choice("nodes", "at the nodes"), choice("cells", "at the centroids of the cells")]);
const CLOUD_VOLUMES: Choices = choices(&[
    choice("cells", "that of the cell; a node has an equal share of each of its cells"),
    choice(
        "nearest",
        "a node has the part of its cells that is nearest to it, as in a Voronoi diagram",
    ),
    choice("array", "values of an array of the file"),
]);

const POINT: Kind = Kind::Numbers(Length::Dimension, Interval::ANY);
pub(super) const CORNERS: &[KeySpec] = &[
    key("min", POINT, "m", Required, "lower corner"),
    key("max", POINT, "m", Required, "upper corner"),
];
pub(super) const ROUND: &[KeySpec] = &[
    key("center", POINT, "m", Required, "centre"),
    key("radius", Kind::Number(Interval::POSITIVE), "m", Required, "radius"),
];
pub(super) const FLAT: &[KeySpec] = &[
    key("point", POINT, "m", Required, "a point of the plane"),
    key("normal", POINT, "1", Required, "its normal, of any length"),
];
