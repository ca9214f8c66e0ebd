//! Bodies, with what they are made of, how they move and what they look like.

use super::{Key, Table, Value, flag, name, number, orientation, plain, table, tables, text, vector};

const UNLESS: &str = "required, unless fixed and folded, or driven, or there are point masses";
const FIXED: Value = Value::Either(&[Value::Flag, Value::Word(&[("constrained", "by six rows")])]);
const INERTIA: Value = Value::Either(&[Value::Numbers(3, "kg.m2"), Value::Rows, Value::Table(&ELEMENTS)]);

/// `[[body]]`.
pub static BODY: Table = Table::new(
    "body",
    "A rigid body. Its frame has its origin at the mass centre.",
    &[
        name("name"),
        Key::new(
            "fixed",
            FIXED,
            "`true`: held, and folded into the formulas; or `\"constrained\"`, see below",
        )
        .eg("fixed = true, or fixed = \"constrained\" for coordinates of its own and six constraint rows")
        .or("false"),
        flag("free", "`true`: floats, the root of a tree to which no joint leads from another root"),
        table("driven", &DRIVEN, "table: its motion is [prescribed](#motions) and folded into the formulas")
            .eg("driven = { translation = [...], rotations = [...] }, see docs/model-format.md"),
        number("mass", "kg", "mass").positive("").or(UNLESS),
        Key::new("inertia", INERTIA, "inertia tensor about the mass centre in the body's frame")
            .eg("inertia = [xx, yy, zz], in kg.m2, about the mass centre")
            .or("likewise"),
        flag("as_written", "`true`: the inertia may be one that no rigid body has, see below"),
        tables(
            &POINT_MASS,
            "one `[[body.point_mass]]` a point mass, see below; not of fixed and driven bodies",
        )
        .eg("[[body.point_mass]] on a line of its own above each point mass"),
        vector("position", "m", "mass centre, global frame: of fixed and free bodies, or a guess, see below")
            .or("[0, 0, 0]"),
        orientation("Euler parameters, likewise").or("[1, 0, 0, 0]"),
        vector("velocity", "m/s", "start: velocity of the mass centre, global frame, likewise")
            .or("[0, 0, 0]"),
        vector("angular_velocity", "rad/s", "start: absolute angular velocity in the body's own frame")
            .or("see [the start](#the-start)"),
        plain("assembly_weight", "", "how strongly the assembly of the start holds the body near its guess")
            .positive("")
            .or("1"),
        tables(
            &SHAPE,
            "one `[[body.shape]]` a shape of what the body looks like in pictures ([show.md](show.md)), and of what can touch \
             others",
        )
        .eg("[[body.shape]] on a line of its own, then box = [x, y, z], cylinder = [radius, length], \
                 sphere = radius or mesh = \"file.stl\""),
    ],
);

/// `[[body.point_mass]]`.
pub static POINT_MASS: Table = Table::new(
    "point_mass",
    "A mass at a point of a body.",
    &[
        number("mass", "kg", "mass; a negative one takes away: a hole").required(),
        vector("at", "m", "where it is in the body's frame").required().eg("at = [0.1, 0, 0], in m"),
    ],
);

/// Elements of an inertia tensor.
pub static ELEMENTS: Table = Table::new(
    "inertia",
    "Elements of the tensor: `xy` is −∫ x y dm.",
    &[
        number("xx", "kg.m2", "about x").required().eg("xx = ..."),
        number("yy", "kg.m2", "about y").required().eg("yy = ..."),
        number("zz", "kg.m2", "about z").required().eg("zz = ..."),
        number("xy", "kg.m2", "−∫ x y dm").or("0"),
        number("xz", "kg.m2", "−∫ x z dm").or("0"),
        number("yz", "kg.m2", "−∫ y z dm").or("0"),
    ],
);

/// The whole motion of a body.
pub static DRIVEN: Table = Table::new(
    "driven body",
    "The body's whole motion, prescribed in time.",
    &[
        Key::new(
            "translation",
            Value::Motions(3, "m"),
            "displacement of the mass centre from `position`, global frame",
        )
        .eg("translation = [0, 0, 0], each a motion in m")
        .or("[0, 0, 0]"),
        Key::new(
            "rotations",
            Value::Tables(&ROTATION),
            "list of tables of `axis` and `angle`, a motion in rad, see below",
        )
        .eg("rotations = [{ axis = [1, 0, 0], angle = ... }], the angle a motion in rad")
        .or("[]"),
    ],
);

/// One of the rotations of a driven body.
pub static ROTATION: Table = Table::new(
    "rotation",
    "A rotation about an axis that the ones before it have turned.",
    &[
        vector("axis", "", "a direction").required().eg("axis = [1, 0, 0]"),
        Key::new("angle", Value::Motion("rad"), "a motion").required().eg("angle = ..., a motion in rad"),
    ],
);

const SCALE: Value = Value::Either(&[Value::Number(""), Value::Numbers(3, "")]);

/// `[[body.shape]]`.
pub static SHAPE: Table = Table::new("shape", "A box, a cylinder, a sphere and the like, or a mesh.", &[
    text("name", "by which a `[[contact]]` names it").or("none"),
    vector("box", "m", "edges along x, y and z").positive(""),
    Key::new("cylinder", Value::Numbers(2, "m"), "radius and length; its axis is z").positive(""),
    number("sphere", "m", "radius").positive(""),
    Key::new("capsule", Value::Numbers(2, "m"), "radius, and length between the centres of its round ends; its axis is z")
        .positive(""),
    vector("ellipsoid", "m", "half of its length along x, y and z").positive(""),
    Key::new("torus", Value::Numbers(2, "m"), "radius of its rim's centre line, and that of the rim; its axis is z")
        .positive(""),
    Key::new("plane", Value::Numbers(2, "m"), "edges of what is drawn of it; it has no end, and z points away from it")
        .positive(""),
    Key::new("vertices", Value::Rows, "corners of a convex body, or the one point that touches: rows of three numbers, m"),
    text("mesh", "path of an `.stl`, `.obj` or `.dae` file, relative to the folder of the model file")
        .eg("mesh = \"file.stl\""),
    Key::new("scale", SCALE, "of a mesh: what its coordinates are multiplied by, one number or three").or("1"),
    text("color", "one of the 148 names that CSS has for colours, or `\"#rrggbb\"`")
        .eg("color = \"steelblue\", or any other of the names that CSS has for colours, or color = \"#4682b4\"")
        .or("the page's"),
    vector("position", "m", "its centre (a mesh's origin), in the body's frame").or("[0, 0, 0]"),
    orientation("Euler parameters in the body's frame").or("[1, 0, 0, 0]"),
]);
