//! Joints, and what ties and moves their coordinates.

use super::{
    KIND, Key, ON_COORDINATE, ON_JOINT, POINT, Table, Value, flag, kind, name, number, orientation, plain,
    reference, table, text, vector,
};

const AXIS: Key = vector("axis", "", "direction of the axis in the body's frame").or(HERE);
const ZERO: Key =
    vector("zero", "", "direction from which the angle is measured, in the body's frame").or(HERE);
const HERE: &str = "required of the joint or its ends";
const DAMPING: Key = number("damping", "N.m.s/rad or N.s/m", "viscous damping, see below")
    .not_negative("it would drive the joint")
    .or("0")
    .formerly("friction");
const ARMATURE: Key =
    number("armature", "kg.m2 or kg", "inertia of a rotor that turns with the coordinate, see below")
        .not_negative("it would gain energy as it is slowed down")
        .or("0");
const LEAD: Key = number("lead", "m/rad", "advance along the axis; negative of a left-handed thread")
    .not_zero("a screw that does not advance is of kind \"revolute\"")
    .eg("lead = ..., in m/rad, or pitch = ..., in m a turn")
    .or("required");
const PITCH: Key = plain("pitch", "m a turn", "the same, in place of `lead`");
const LENGTH: Key = number("length", "m", "distance of the two points")
    .positive("kind = \"spherical\" makes two points coincide")
    .required();
const RATES: Value = Value::Either(&[Value::Number("rad/s or m/s"), Value::List(3, "rad/s or m/s")]);
const RATE: Key =
    Key::new("rate", RATES, "start: the rate of the coordinate, or a list of the rates of several")
        .or("see [the start](#the-start)");
const ROUGH: Key =
    flag("rough", "`true`: what is given of the start is a guess, which the assembly may change");
const ORIENTATION: Key =
    orientation("start: Euler parameters of the second body in the first body's frame").or("[1, 0, 0, 0]");

const fn angle(name: &'static str) -> Key {
    number(name, "rad", "start: an angle of the joint; may exceed a turn").or("0")
}

const fn degrees(name: &'static str) -> Key {
    plain(name, "degrees", "the same, in place of the key without `_deg`")
}

const fn displacement(name: &'static str) -> Key {
    number(name, "m", "start: a displacement of the joint").or("0")
}

const ANGLE: Key = angle("angle");
const ANGLE_DEG: Key = degrees("angle_deg");
const DISPLACEMENT: Key = displacement("displacement");

/// `[[joint]]`.
pub static JOINT: Table = Table::new(
    "joint",
    "A joint between two bodies.",
    &[
        name("name"),
        Key { meaning: "see [the kinds](#the-kinds-of-joint)", ..KIND },
        table("first", &JOINT_END, "the first end: a table with the keys below").required(),
        table("second", &JOINT_END, "the second end").required(),
        Key { meaning: "of an end that has no own, as `axis` and `zero`", ..POINT },
    ],
)
.of_kinds(&[
    kind(
        "revolute",
        "points coincide, axes are parallel",
        &[AXIS, ZERO, DAMPING, ARMATURE, ANGLE, ANGLE_DEG, RATE, ROUGH],
    ),
    kind("spherical", "points coincide", &[DAMPING, ORIENTATION, RATE, ROUGH]),
    kind("fixed", "points and joint frames coincide", &[AXIS, ZERO]),
    kind(
        "universal",
        "points coincide, axes are at right angles",
        &[
            AXIS,
            ZERO,
            angle("first_angle"),
            degrees("first_angle_deg"),
            angle("second_angle"),
            degrees("second_angle_deg"),
            RATE,
            ROUGH,
        ],
    ),
    kind("cylindrical", "axes lie on one line", &[AXIS, ZERO, ANGLE, ANGLE_DEG, DISPLACEMENT, RATE, ROUGH]),
    kind(
        "prismatic",
        "axes lie on one line and do not turn against each other",
        &[AXIS, ZERO, DAMPING, ARMATURE, DISPLACEMENT, RATE, ROUGH],
    ),
    kind(
        "planar",
        "axes are parallel, the second point stays in the plane through the first across its axis",
        &[AXIS, ZERO, displacement("x"), displacement("y"), ANGLE, ANGLE_DEG, RATE, ROUGH],
    ),
    kind(
        "screw",
        "axes lie on one line, `displacement = lead · angle`",
        &[AXIS, ZERO, DAMPING, ARMATURE, LEAD, PITCH, ANGLE, ANGLE_DEG, RATE, ROUGH],
    ),
    kind(
        "point_on_line",
        "the second point stays on the first body's axis",
        &[AXIS, ZERO, DAMPING, DISPLACEMENT, RATE, ROUGH],
    ),
    kind("rod", "the points stay at a distance of `length`", &[LENGTH]),
]);

/// `first` and `second` of a joint.
pub static JOINT_END: Table = Table::new(
    "end of a joint",
    "A joint as seen from one of its bodies.",
    &[
        reference("body", "name of the body"),
        Key { meaning: "joint point, from the mass centre in the body's frame", ..POINT },
        AXIS,
        ZERO,
    ],
);

/// `[[coupler]]`.
pub static COUPLER: Table = Table::new(
    "coupler",
    "Second coordinate = ratio · first coordinate + offset, a gear, a belt, a rack; or = a formula, a cam.",
    &[
        name("name"),
        table("first", &COUPLER_END, "the first coordinate, a table of `joint` and `coordinate`")
            .or("required but with `formula`"),
        table("second", &COUPLER_END, "the second coordinate").required(),
        number("ratio", "", "ratio, of the two units")
            .not_zero("it would couple nothing")
            .or("required but with `formula`")
            .eg("ratio = ...: second = ratio * first + offset"),
        number("offset", "rad or m", "offset").or("0"),
        text(
            "formula",
            "what the second coordinate is to be: a [formula](laws.md) of other joint coordinates",
        )
        .eg("formula = \"...\", of other joint coordinates, in place of first, ratio and offset")
        .or("none"),
    ],
);

/// `first` and `second` of a coupler.
pub static COUPLER_END: Table =
    Table::new("joint coordinate", "A coordinate of a joint.", &[ON_JOINT, ON_COORDINATE]);

/// `[[constraint]]`.
pub static CONSTRAINT: Table = Table::new(
    "constraint",
    "A row of one's own: a formula of joint coordinates that is zero, or one that is linear in their rates.",
    &[
        name("name"),
        text("zero", "what is to be zero: a [formula](laws.md) of joint coordinates")
            .eg("zero = \"...\", or rate = \"...\"")
            .or("required but with `rate`"),
        text("rate", "what is to be zero: a [formula](laws.md) of joint coordinates, linear in their rates")
            .or("none"),
    ],
);

/// `[[driver]]`.
pub static DRIVER: Table = Table::new(
    "driver",
    "A joint coordinate that is prescribed in time.",
    &[
        name("name"),
        ON_JOINT,
        ON_COORDINATE,
        Key::new("motion", Value::Motion("rad or m"), "a motion")
            .required()
            .eg("motion = { sinusoid = { amplitude = 0.1, frequency_hz = 2 } }, or another motion"),
    ],
);
