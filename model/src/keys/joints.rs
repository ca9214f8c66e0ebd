//! Joints, and what ties and moves their coordinates.

use super::{
    KIND, Key, ON_COORDINATE, ON_JOINT, Range, Table, Value, flag, kind, name, number, orientation, plain,
    reference, table, vector,
};

/// Of an angle.
const DEGREES: &str = "degrees";

const AXIS: Key = vector("axis", "", "direction of the joint's axis, unless an end has its own")
    .default("required here or in the ends");
const ZERO: Key = vector(
    "zero",
    "",
    "direction from which the angle is measured, unless an end has its own; only its part across the axis counts",
)
.default("required here or in the ends");
const DAMPING: Key = number(
    "damping",
    "N.m.s/rad or N.s/m",
    "viscous damping c ≥ 0: the torque or force on the second body is −c times the rate; spherical joints and those \
     with one coordinate. Its former name, `friction`, is read with a remark: that of a contact is Coulomb's",
)
.within(Range::NotNegative("it would drive the joint"))
.default("0")
.formerly("friction");
const ARMATURE: Key = number(
    "armature",
    "kg.m2 or kg",
    "inertia ≥ 0 that turns or slides with the joint's coordinate alone, as the rotor of a motor does behind a gear \
     (rotor times the square of the gear's ratio): kinetic energy ½ J q̇². Revolute, prismatic and screw joints. The \
     gyroscopic effect of the rotor is neglected",
)
.within(Range::NotNegative("it would gain energy as it is slowed down"))
.default("0");
const LEAD: Key = number(
    "lead",
    "m/rad",
    "screw: advance of the second body along the axis, not 0; negative for a left-handed thread",
)
.within(Range::NotZero("a screw that does not advance is of kind \"revolute\""))
.default("required")
.example("lead = ..., in m/rad, or pitch = ..., in m a turn");
const PITCH: Key = plain("pitch", "m a turn", "the same, in place of `lead`");
const LENGTH: Key = number("length", "m", "rod: distance of the two points, greater than 0")
    .within(Range::Positive("kind = \"spherical\" makes two points coincide"))
    .required();
const RATE: Key = Key::new(
    "rate",
    Value::Either(&[Value::Number("rad/s or m/s"), Value::List(3, "rad/s or m/s")]),
    "start: the rate of the joint's coordinate, a number, or a list of the rates of several in the order of the kind's \
     table; spherical: angular velocity of the second body relative to the first, in the second body's frame, three \
     numbers",
)
.default("see [the start](#the-start)");
const ROUGH: Key =
    flag("rough", "`true`: what is given of the start is a guess, which the assembly may change");
const ORIENTATION: Key =
    orientation("start, spherical: Euler parameters of the second body's frame in the first body's frame")
        .default("[1, 0, 0, 0]");

const fn angle(name: &'static str) -> Key {
    number(name, "rad", "start: an angle of the joint; may exceed a turn").default("0")
}

const fn degrees(name: &'static str) -> Key {
    plain(name, DEGREES, "the same, in place of the key without `_deg`")
}

const fn displacement(name: &'static str) -> Key {
    number(name, "m", "start: a displacement of the joint").default("0")
}

const ANGLE: Key = angle("angle");
const ANGLE_DEG: Key = degrees("angle_deg");
const DISPLACEMENT: Key = displacement("displacement");

/// `[[joint]]`.
pub static JOINT: Table = Table {
    name: "joint",
    meaning: "A joint between two bodies.",
    keys: &[
        name("name"),
        Key { meaning: "see [the kinds](#the-kinds-of-joint)", ..KIND },
        table("first", &JOINT_END, "the first end: a table with the keys below").required(),
        table("second", &JOINT_END, "the second end, likewise").required(),
        vector("point", "m", "joint point of both ends, unless an end has its own").default("[0, 0, 0]"),
    ],
    kinds: &[
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
        kind(
            "cylindrical",
            "axes lie on one line",
            &[AXIS, ZERO, ANGLE, ANGLE_DEG, DISPLACEMENT, RATE, ROUGH],
        ),
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
    ],
};

/// `first` and `second` of a joint.
pub static JOINT_END: Table = Table {
    name: "end of a joint",
    meaning: "A joint as seen from one of its bodies.",
    keys: &[
        reference("body", "name of the body"),
        vector("point", "m", "joint point, from the mass centre in the body's frame").default("[0, 0, 0]"),
        vector(
            "axis",
            "",
            "direction of the joint's axis in the body's frame; not for spherical joints and rods, nor for the second \
             end of a point on a line",
        )
        .default("required here or in the joint"),
        vector(
            "zero",
            "",
            "direction from which the angle is measured; only its part across the axis counts; for the same ends as \
             `axis`",
        )
        .default("required here or in the joint"),
    ],
    kinds: &[],
};

/// `[[coupler]]`.
pub static COUPLER: Table = Table {
    name: "coupler",
    meaning: "Second coordinate = ratio · first coordinate + offset: a gear, a belt, a rack.",
    keys: &[
        name("name"),
        table(
            "first",
            &COUPLER_END,
            "the first coordinate, a table of `joint` and, unless the joint has just one, `coordinate`",
        )
        .required()
        .example("first = { joint = \"...\" }"),
        table("second", &COUPLER_END, "the second coordinate, likewise")
            .required()
            .example("second = { joint = \"...\" }"),
        number("ratio", "", "ratio, not 0, of the two units")
            .within(Range::NotZero("it would couple nothing"))
            .required()
            .example("ratio = ...: second = ratio * first + offset"),
        number("offset", "rad or m", "offset").default("0"),
    ],
    kinds: &[],
};

/// `first` and `second` of a coupler.
pub static COUPLER_END: Table = Table {
    name: "joint coordinate",
    meaning: "A coordinate of a joint.",
    keys: &[Key { meaning: "name of the joint", ..ON_JOINT }, ON_COORDINATE],
    kinds: &[],
};

/// `[[driver]]`.
pub static DRIVER: Table = Table {
    name: "driver",
    meaning: "A joint coordinate that is prescribed in time.",
    keys: &[
        name("name"),
        Key { meaning: "name of the joint", ..ON_JOINT },
        ON_COORDINATE,
        Key::new("motion", Value::Motion("rad or m"), "a motion")
            .required()
            .example("motion = { sinusoid = { amplitude = 0.1, frequency_hz = 2 } }, or another motion"),
    ],
    kinds: &[],
};
