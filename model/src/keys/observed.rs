//! What is computed besides the motion, and what acts on it from instant to instant.

use super::{
    KIND, Key, ON_COORDINATE, ON_JOINT, Range, Table, Value, flag, kind, name, number, orientation, plain,
    reference, text,
};

const BODY: Key = reference("body", "the body");
const POINT: Key = Key { meaning: "", ..super::POINT };
const AXES: Key = orientation("Euler parameters of the output's axes").default("the body's axes");
const FORCE: Key = reference("force", "the spring or link");

/// `[[output]]`.
pub static OUTPUT: Table = Table {
    name: "output",
    meaning: "What a generated mechanism computes only if it is asked for.",
    keys: &[name("name; it heads the columns of results"), KIND],
    kinds: &[
        kind(
            "pose",
            "position of the point (m, global) and Euler parameters of the axes",
            &[BODY, POINT, AXES],
        ),
        kind(
            "velocity",
            "velocity of the point (m/s, global) and angular velocity (rad/s, by these axes)",
            &[BODY, POINT, AXES],
        ),
        kind(
            "acceleration",
            "acceleration of the point (m/s², global) and angular acceleration (rad/s², by these axes)",
            &[BODY, POINT, AXES],
        ),
        kind(
            "inertial",
            "what an inertial sensor at the point reads: specific force Aᵀ(r̈ − g) (m/s²) and angular rate (rad/s), \
             both by these axes",
            &[BODY, POINT, AXES],
        ),
        kind(
            "reaction",
            "force (N) and torque (N·m) of the joint on its second body, about the second body's point, in the first \
             body's joint frame (f, g, h); without friction, springs, motors, armatures and drivers",
            &[reference("joint", "the joint")],
        ),
        kind(
            "driver",
            "torque or force of the driver along its coordinate (N·m or N)",
            &[reference("driver", "the driver")],
        ),
        kind(
            "coupler",
            "torque or force of the coupler along its second coordinate (N·m or N); along the first it acts with \
             `−ratio` times as much",
            &[reference("coupler", "the coupler")],
        ),
        kind(
            "spring",
            "torque or force of the spring along its coordinate (N·m or N), and how far that is from its free value \
             (rad or m)",
            &[FORCE],
        ),
        kind(
            "link",
            "force with which the link pushes its ends apart, its spring's and its damper's (N), and its length (m)",
            &[FORCE],
        ),
        kind("energy", "kinetic and potential energy (J)", &[]),
        kind("power", "power of all non-conservative forces, and of drivers and driven bodies (W)", &[]),
    ],
};

const EACH: Value = Value::Either(&[Value::Number(""), Value::List(16, "")]);
const STEP: Range = Range::NotNegative("the size of a step of the converter, or 0 for none");

/// `[[controller]]`.
pub static CONTROLLER: Table = Table {
    name: "controller",
    meaning: "A law from outputs to inputs, at its own period.",
    keys: &[
        name("name, for messages"),
        KIND,
        Key::new(
            "outputs",
            Value::Texts(1, 16),
            "what it sees, by the names of the columns of a run's table: joint coordinates (`\"pan\"`, `\"table.x\"`), \
             their rates (`\"pan rate\"`), numbers of outputs (`\"camera.wz\"`); at most 16",
        )
        .required()
        .example("outputs = [\"...\"]: joint coordinates, their rates, numbers of outputs"),
        Key::new(
            "inputs",
            Value::Texts(1, 16),
            "names of the inputs that it sets; at most 16, and each is set by one controller",
        )
        .required()
        .example("inputs = [\"...\"], names of [inputs]"),
        plain(
            "frequency_hz",
            "Hz",
            "how often it samples; a fraction of whole numbers, such as `\"1000/3\"`",
        )
        .within(Range::Positive(""))
        .default("required")
        .example("frequency_hz = 1000, or period = 0.001"),
        plain("period", "s", "the same, in place of `frequency_hz`").within(Range::Positive("")),
        plain("delay", "s", "from a sample to its effect; not more than a period").default("0"),
        Key::new("setpoint", EACH, "what the outputs are to be: a number for all or an array, one for each")
            .default("0"),
        Key::new("limits", Value::Numbers(2, ""), "`[least, largest]` of each input").default("none"),
        Key::new(
            "output_step",
            EACH,
            "the step to whole multiples of which outputs are rounded before the law sees them: a number for all or an \
             array, one for each; 0 for none",
        )
        .within(STEP)
        .default("0"),
        number("input_step", "", "the same of inputs, after the limits").within(STEP).default("0"),
    ],
    kinds: &[
        kind(
            "pid",
            "u = kp e + ki ∫e + kd ė of one output to one input; the integral a sum of rectangles that waits at a \
             limit, the derivative a difference",
            &[
                number("kp", "", "gain of the error; one of the three must be there")
                    .default("0")
                    .example("kp = ..., and ki and kd as far as they are not 0"),
                number("ki", "", "1/s").default("0"),
                number("kd", "", "s").default("0"),
            ],
        ),
        kind(
            "state_feedback",
            "u = K e",
            &[Key::new("gains", Value::Rows, "a row for each input, in it a number for each output")
                .required()
                .example("gains = [[...]]: a row for each input, in it a number for each output")],
        ),
        kind(
            "transfer_function",
            "(b0 + b1/z + …) / (a0 + a1/z + …) of one output to one input",
            &[
                Key::new("numerator", Value::List(17, ""), "`[b0, b1, …]`")
                    .required()
                    .example("numerator = [...], powers of 1/z"),
                Key::new("denominator", Value::List(17, ""), "`[a0, a1, …]` with a0 ≠ 0")
                    .required()
                    .example("denominator = [...], powers of 1/z"),
            ],
        ),
    ],
};

/// `[[event]]`.
pub static EVENT: Table = Table {
    name: "event",
    meaning: "A crossing of a level, which runs list.",
    keys: &[
        name("name, in the list"),
        text(
            "of",
            "what crosses, by the name of its column in a run's table: a joint coordinate (`\"pan\"`, `\"table.x\"`), \
             its rate (`\"pan rate\"`), a number of an output (`\"camera.wz\"`); or a formula \
             ([grammar](#numbers-names-and-directions)) of such names, parameters and numbers: \
             `\"pan rate * arm - camera.wz\"`",
        )
        .required()
        .example("of = \"...\": a joint coordinate, a rate (\"joint rate\"), or a number of an output"),
        text("minus", "what is subtracted from it, likewise")
            .default("none")
            .example("minus = \"...\", the name of a column of a run's table"),
        number("level", "", "the level").default("0"),
        Key::new(
            "direction",
            Value::Word(&[
                ("rising", "from below the level"),
                ("falling", "from above the level"),
                ("both", "all crossings"),
            ]),
            "which crossings count: `\"rising\"`, `\"falling\"` or `\"both\"`",
        )
        .default("\"both\""),
        flag("stop", "whether the run ends at the first one"),
    ],
    kinds: &[],
};

const NOT_NEGATIVE: Range = Range::NotNegative("");

/// `[[contact]]`.
pub static CONTACT: Table = Table {
    name: "contact",
    meaning: "Rigid stops and dry friction that sticks, along a joint coordinate.",
    keys: &[
        name("name, an identifier unlike those of parameters and inputs"),
        Key { meaning: "where it acts", ..ON_JOINT },
        ON_COORDINATE,
        number("lower", "rad or m", "the lower stop").default("none"),
        number("upper", "rad or m", "the upper stop").default("none").example(
            "upper = ..., in rad or m, lower = ..., friction = ..., in N.m or N, or friction_coefficient = ...",
        ),
        number(
            "restitution",
            "",
            "the part of its rate with which the coordinate rebounds from a stop, 0 to 1",
        )
        .default("required with stops")
        .example("restitution = ..., from 0 to 1: the part of its rate with which the joint rebounds"),
        number("friction", "N.m or N", "the kinetic level of dry friction").within(NOT_NEGATIVE).default("0"),
        number("static_friction", "N.m or N", "the static level, not below the kinetic one")
            .default("that of `friction`"),
        number(
            "friction_coefficient",
            "",
            "times the size of the force that the joint transmits (its reaction), and about an axis times `radius`: \
             what is added to the kinetic level",
        )
        .within(NOT_NEGATIVE)
        .default("0"),
        number(
            "static_friction_coefficient",
            "",
            "the same of the static level, not below the kinetic one",
        )
        .default("that of `friction_coefficient`"),
        number("radius", "m", "of the bearing")
            .within(Range::Positive(""))
            .default("required with a coefficient about an axis"),
    ],
    kinds: &[],
};
