//! Bodies, with what they are made of, how they move and what they look like.

use super::{Key, Range, Table, Value, flag, name, number, orientation, plain, table, tables, text, vector};

const UNLESS: &str = "required, unless fixed and folded, or driven, or there are point masses";

/// `[[body]]`.
pub static BODY: Table = Table {
    name: "body",
    meaning: "A rigid body. Its frame has its origin at the mass centre.",
    keys: &[
        name("name"),
        Key::new(
            "fixed",
            Value::Either(&[
                Value::Flag,
                Value::Word(&[("constrained", "by six rows on seven coordinates of its own")]),
            ]),
            "`true`: held, and folded into the formulas. `\"constrained\"`: held by six constraint rows on seven \
             coordinates of its own, the paper's eqs. (5) and (6)",
        )
        .default("false")
        .example("fixed = true, or fixed = \"constrained\" for coordinates of its own and six constraint rows"),
        flag(
            "free",
            "`true`: floats, the root of a tree to which no joint leads from a fixed, driven or other free body",
        ),
        table(
            "driven",
            &DRIVEN,
            "table: the body's whole motion is [prescribed in time](#motions) and folded into the formulas: it has no \
             coordinates",
        )
        .example("driven = { translation = [...], rotations = [...] }, see docs/model-format.md"),
        number("mass", "kg", "mass, greater than 0").within(Range::Positive("")).default(UNLESS),
        Key::new(
            "inertia",
            Value::Either(&[
                Value::Numbers(3, "kg.m2"),
                Value::Rows,
                Value::Table(&ELEMENTS),
            ]),
            "inertia tensor about the mass centre in the body's frame",
        )
        .default("likewise")
        .example("inertia = [xx, yy, zz], in kg.m2, about the mass centre"),
        flag(
            "as_written",
            "`true`: the inertia is taken although a principal moment exceeds the sum of the others, as no rigid \
             body's does (`import --as-written` writes it); it must be positive definite all the same",
        ),
        tables(
            &POINT_MASS,
            "one `[[body.point_mass]]` a point mass, below; not of fixed and driven bodies",
        )
        .example("[[body.point_mass]] on a line of its own above each point mass"),
        vector(
            "position",
            "m",
            "mass centre, global frame: of fixed and free bodies, where a driven one moves from, and a guess for \
             bodies that only rods hold",
        )
        .default("[0, 0, 0]"),
        orientation("Euler parameters, likewise, and a guess for bodies that hang on a point on a line")
            .default("[1, 0, 0, 0]"),
        vector(
            "velocity",
            "m/s",
            "start: velocity of the mass centre, global frame: of free bodies, and a guess for bodies that only rods \
             hold",
        )
        .default("[0, 0, 0]"),
        vector(
            "angular_velocity",
            "rad/s",
            "start: absolute angular velocity in the body's own frame; not for fixed and driven bodies",
        )
        .default("see [the start](#the-start)"),
        plain(
            "assembly_weight",
            "",
            "how strongly the assembly of the start holds the body near its guess, greater than 0: a larger one holds it \
             nearer",
        )
        .within(Range::Positive(""))
        .default("1"),
        tables(
            &SHAPE,
            "list of tables, `[[body.shape]]`: what the body looks like in pictures ([show.md](show.md)); nothing else \
             asks for it",
        )
        .default("")
        .example(
            "[[body.shape]] on a line of its own, then box = [x, y, z], cylinder = [radius, length], sphere = radius \
             or mesh = \"file.stl\"",
        ),
    ],
    kinds: &[],
};

/// `[[body.point_mass]]`.
pub static POINT_MASS: Table = Table {
    name: "point_mass",
    meaning: "A mass at a point of a body: the mass centre moves, what is given in the body's frame stays.",
    keys: &[
        number("mass", "kg", "mass; a negative one takes away: a hole").required(),
        vector("at", "m", "where it is in the body's frame").required().example("at = [0.1, 0, 0], in m"),
    ],
    kinds: &[],
};

/// Elements of an inertia tensor.
pub static ELEMENTS: Table = Table {
    name: "inertia",
    meaning: "Elements of the tensor: `xy` is −∫ x y dm.",
    keys: &[
        number("xx", "kg.m2", "about x").required().example("xx = ..."),
        number("yy", "kg.m2", "about y").required().example("yy = ..."),
        number("zz", "kg.m2", "about z").required().example("zz = ..."),
        number("xy", "kg.m2", "−∫ x y dm").default("0"),
        number("xz", "kg.m2", "−∫ x z dm").default("0"),
        number("yz", "kg.m2", "−∫ y z dm").default("0"),
    ],
    kinds: &[],
};

/// The whole motion of a body.
pub static DRIVEN: Table = Table {
    name: "driven body",
    meaning: "The body's whole motion, prescribed in time.",
    keys: &[
        Key::new(
            "translation",
            Value::Motions(3, "m"),
            "three motions: displacement of the mass centre from `position`, global frame",
        )
        .default("[0, 0, 0]")
        .example("translation = [0, 0, 0], each a motion in m"),
        Key::new(
            "rotations",
            Value::Tables(&ROTATION),
            "list of tables, each with an `axis` (a direction) and an `angle` (a motion in rad); they turn the body \
             from `orientation`, one after the other, each about an axis of the frame that the ones before it have \
             turned",
        )
        .default("[]")
        .example("rotations = [{ axis = [1, 0, 0], angle = ... }], the angle a motion in rad"),
    ],
    kinds: &[],
};

/// One of the rotations of a driven body.
pub static ROTATION: Table = Table {
    name: "rotation",
    meaning: "A rotation about an axis that the ones before it have turned.",
    keys: &[
        vector("axis", "", "a direction").required().example("axis = [1, 0, 0]"),
        Key::new("angle", Value::Motion("rad"), "a motion")
            .required()
            .example("angle = ..., a motion in rad"),
    ],
    kinds: &[],
};

const SIZE: Range = Range::Positive("");

/// `[[body.shape]]`.
pub static SHAPE: Table = Table {
    name: "shape",
    meaning: "A box, a cylinder, a sphere or a mesh.",
    keys: &[
        vector("box", "m", "edges along x, y and z").within(SIZE),
        Key::new("cylinder", Value::Numbers(2, "m"), "radius and length; its axis is z").within(SIZE),
        number("sphere", "m", "radius").within(SIZE),
        text(
            "mesh",
            "path of a file of triangles (`.stl`, `.obj` or COLLADA's `.dae`, which knows its unit), relative to the \
             folder of the model file; read by `show` and `check` alone",
        )
        .example("mesh = \"file.stl\""),
        Key::new(
            "scale",
            Value::Either(&[Value::Number(""), Value::Numbers(3, "")]),
            "of a mesh: what its coordinates are multiplied by, one number or three for x, y and z; a negative one \
             mirrors",
        )
        .default("1"),
        text("color", "in pictures: one of the 148 names that CSS has for colours, or `\"#rrggbb\"`")
            .default("the page's")
            .example(
                "color = \"steelblue\", or any other of the names that CSS has for colours, or color = \"#4682b4\"",
            ),
        vector("position", "m", "its centre (a mesh's origin), in the body's frame").default("[0, 0, 0]"),
        orientation("Euler parameters in the body's frame").default("[1, 0, 0, 0]"),
    ],
    kinds: &[],
};
