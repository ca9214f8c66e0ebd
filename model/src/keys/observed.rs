//! What is computed besides the motion, and what acts on it from instant to instant.

use super::{
    BUSHING_END, KIND, Key, ON_COORDINATE, ON_JOINT, POINT, Table, Value, flag, kind, name, number,
    orientation, plain, reference, strength, table, text, word,
};

/// Of a frame in a body.
const FRAME: &[Key] = &[
    reference("body", ""),
    POINT,
    orientation("Euler parameters of the output's axes").or("the body's axes"),
];
const FORCE: &[Key] = &[reference("force", "")];

/// `[[output]]`.
pub static OUTPUT: Table = Table::new(
    "output",
    "What a generated mechanism computes only if it is asked for.",
    &[name("name; it heads the columns of results"), KIND],
)
.of_kinds(&[
    kind("pose", "position of the point (m, global) and Euler parameters of the axes", FRAME),
    kind(
        "velocity",
        "velocity of the point (m/s, global) and angular velocity (rad/s, by these axes)",
        FRAME,
    ),
    kind("acceleration", "their derivatives (m/s², global, and rad/s², by these axes)", FRAME),
    kind(
        "inertial",
        "what an inertial sensor reads: specific force Aᵀ(r̈ − g) (m/s²) and angular rate (rad/s)",
        FRAME,
    ),
    kind(
        "relative",
        "the second frame seen from the first, by its axes: place (m), direction cosines, velocity (m/s) and angular velocity (rad/s)",
        &[
            table("first", &BUSHING_END, "a table of `body`, `point` and `orientation`").required(),
            table("second", &BUSHING_END, "likewise").required(),
        ],
    ),
    kind(
        "reaction",
        "force (N) and torque (N·m) of the joint on its second body, see below",
        &[reference("joint", "")],
    ),
    kind(
        "driver",
        "torque or force of the driver along its coordinate (N·m or N)",
        &[reference("driver", "")],
    ),
    kind(
        "coupler",
        "torque or force of the coupler along its second coordinate (N·m or N), see below",
        &[reference("coupler", "")],
    ),
    kind(
        "constraint",
        "what the constraint acts with: its power is this times the rate of its formula, see below",
        &[reference("constraint", "")],
    ),
    kind("spring", "torque or force of the spring (N·m or N), and its deflection (rad or m)", FORCE),
    kind("link", "force with which the link pushes its ends apart (N), its length (m), and the rate of that (m/s)", FORCE),
    kind(
        "bushing",
        "where its second frame is, seen from the first (m and rad), and force or torque along each of these (N and N·m)",
        FORCE,
    ),
    kind(
        "formula",
        "the value of a formula, see [laws](laws.md)",
        &[text("of", "the formula").required().eg("of = \"...\"")],
    ),
    kind(
        "rate",
        "the time derivative of a formula, see below",
        &[text("of", "the formula").required().eg("of = \"hinge rate\"")],
    ),
    kind("energy", "kinetic and potential energy (J)", &[]),
    kind("power", "power of all non-conservative forces, and of drivers and driven bodies (W)", &[]),
]);

const FOLLOWED: Value = Value::Either(&[Value::Strength(""), Value::List(16, "")]);
const EACH: Value = Value::Either(&[Value::Number(""), Value::List(16, "")]);
const STEP: &str = "the size of a step of the converter, or 0 for none";

/// `[[controller]]`.
pub static CONTROLLER: Table = Table::new(
    "controller",
    "A law from outputs to inputs, at its own period.",
    &[
        name("name, for messages"),
        KIND,
        Key::new(
            "outputs",
            Value::Texts(1, 16),
            "what it sees: columns of a run's table, at most 16, see below",
        )
        .required()
        .eg("outputs = [\"...\"]: joint coordinates, their rates, numbers of outputs"),
        Key::new("inputs", Value::Texts(1, 16), "names of the inputs that it sets, at most 16")
            .required()
            .eg("inputs = [\"...\"], names of [inputs]"),
        plain("frequency_hz", "Hz", "how often it samples, a fraction of whole numbers")
            .positive("")
            .eg("frequency_hz = 1000, or period = 0.001")
            .or("required"),
        plain("period", "s", "the same, in place of `frequency_hz`").positive(""),
        plain("delay", "s", "from a sample to its effect; not more than a period").or("0"),
        Key::new(
            "setpoint",
            FOLLOWED,
            "what the outputs are to be: a number or a formula for all, or an array; formulas are computed at each \
             sample, and may name whatever is seen and inputs",
        )
        .or("0"),
        Key::new("limits", Value::Numbers(2, ""), "`[least, largest]` of each input").or("none"),
        Key::new("output_step", EACH, "the step to which outputs are rounded: a number for all or an array")
            .not_negative(STEP)
            .or("0"),
        number("input_step", "", "the same of inputs, after the limits").not_negative(STEP).or("0"),
    ],
)
.of_kinds(&[
    kind(
        "pid",
        "u = kp e + ki ∫e + kd ė of one output to one input, see below",
        &[
            number("kp", "", "").eg("kp = ..., and ki and kd as far as they are not 0").or("0"),
            number("ki", "1/s", "").or("0"),
            number("kd", "s", "at least one of the three").or("0"),
        ],
    ),
    kind(
        "state_feedback",
        "u = K e",
        &[Key::new("gains", Value::Rows, "a row for each input, in it a number for each output")
            .required()
            .eg("gains = [[...]]: a row for each input, in it a number for each output")],
    ),
    kind(
        "transfer_function",
        "(b0 + b1/z + …) / (a0 + a1/z + …) of one output to one input",
        &[
            Key::new("numerator", Value::List(17, ""), "`[b0, b1, …]`")
                .required()
                .eg("numerator = [...], powers of 1/z"),
            Key::new("denominator", Value::List(17, ""), "`[a0, a1, …]` with a0 ≠ 0")
                .required()
                .eg("denominator = [...], powers of 1/z"),
        ],
    ),
]);

const DIRECTIONS: &[(&str, &str)] = &[("rising", ""), ("falling", ""), ("both", "")];

/// `[[event]]`.
pub static EVENT: Table = Table::new(
    "event",
    "A crossing of a level, which runs list.",
    &[
        name("name, in the list"),
        text("of", "what crosses: a column of a run's table, or a formula, see below")
            .required()
            .eg("of = \"...\": a joint coordinate, a rate (\"joint rate\"), or a number of an output"),
        text("minus", "what is subtracted from it, likewise")
            .eg("minus = \"...\", the name of a column of a run's table")
            .or("none"),
        number("level", "", "the level").or("0"),
        word("direction", DIRECTIONS, "which crossings count").or("\"both\""),
        flag("stop", "whether the run ends at the first one"),
    ],
);

const JOINED: &[(&str, &str)] = &[
    ("smooth", "a natural cubic spline, two continuous derivatives"),
    ("monotone", "cubics that rise and fall as the points do, a continuous slope"),
    ("linear", "straight lines"),
    ("steps", "the point before"),
];
const BEYOND: &[(&str, &str)] =
    &[("line", "straight on"), ("hold", "the value at the end"), ("error", "no value: a run ends")];

/// `[[curve]]`.
pub static CURVE: Table = Table::new(
    "curve",
    "A function of one argument that formulas call by its name, see [laws](laws.md#curves): of a table, or of points.",
    &[
        name("name, unlike those of functions, joints, outputs, parameters, inputs and formulas"),
        text("table", "name of a CSV file, looked for from the folder of the model file")
            .eg("table = \"...\", a CSV file, or points = [[0, 0], [1, 2]]")
            .or("none"),
        Key::new("columns", Value::Texts(2, 2), "of a table: the names of its columns of argument and value")
            .eg("columns = [\"x\", \"y\"]: argument and value")
            .or("its two columns"),
        Key::new("points", Value::Rows, "in place of a table: a list of points `[argument, value]`")
            .eg("points = [[0, 0], [1, 2]]")
            .or("none"),
        word("between", JOINED, "what it is between its points").or("\"smooth\""),
        word("beyond", BEYOND, "what it is beyond its ends").or("\"line\""),
    ],
);

/// `[[formula]]`.
pub static FORMULA: Table = Table::new(
    "formula",
    "A formula that has a name, for use in others, see [laws](laws.md).",
    &[
        name("name, unlike those of joints, outputs, parameters and inputs"),
        text("of", "the formula").required().eg("of = \"...\""),
    ],
);

/// `[[state]]`.
pub static STATE: Table = Table::new(
    "state",
    "A quantity that a differential equation of first order tells, see [laws](laws.md).",
    &[
        name(
            "name, unlike those of joints, outputs, parameters and inputs; its column in the table of a run",
        ),
        Key::new(
            "start",
            Value::Either(&[Value::Number(""), Value::Word(&[("rest", "where its rate is zero")])]),
            "its value at the start",
        )
        .or("0"),
        strength("rate", "", "its rate: a formula of whatever forces may depend on, and of states")
            .required()
            .eg("rate = \"...\", a formula such as \"(u - R*i - k*hinge rate)/L\""),
    ],
);

/// A side of `[[contact]]`.
pub static CONTACT_SIDE: Table = Table::new(
    "contact_side",
    "A side of a contact.",
    &[reference("body", "name of the body"), text("shape", "name of one of its shapes").or("all of them")],
);

/// `[[contact]]`.
pub static CONTACT: Table = Table::new(
    "contact",
    "On a joint coordinate rigid stops and dry friction that sticks; or what acts where shapes of two bodies touch.",
    &[
        name("name, unlike those of parameters and inputs"),
        Key { is_required: false, ..ON_JOINT }.or("between bodies"),
        ON_COORDINATE,
        number("lower", "rad or m", "the lower stop").or("none"),
        number("upper", "rad or m", "the upper stop")
            .eg("upper = ..., in rad or m, lower = ..., friction = ..., in N.m or N, or friction_coefficient = ...")
            .or("none"),
        number("restitution", "", "the part of its rate with which what hits rebounds, 0 to 1; between bodies it makes them rigid")
            .eg("restitution = ..., from 0 to 1: the part of its rate with which the joint rebounds")
            .or("required with stops"),
        word(
            "impact_law",
            &[("newton", "`restitution` is of rates"), ("poisson", "`restitution` is of impulses")],
            "of rigid bodies",
        )
        .or("\"newton\""),
        number("friction", "N.m or N", "the kinetic level of dry friction").not_negative("").or("0"),
        number("static_friction", "N.m or N", "the static level, not below the kinetic one")
            .or("that of `friction`"),
        number(
            "friction_coefficient",
            "",
            "times the reaction of the joint: added to the kinetic level, see below; between bodies times the force that \
             presses them together",
        )
        .not_negative("")
        .or("0"),
        number("static_friction_coefficient", "", "the same of the static level")
            .or("that of `friction_coefficient`"),
        number("radius", "m", "of the bearing").positive("").or("required with a coefficient about an axis"),
        Key::new("between", Value::Tables(&CONTACT_SIDE), "two tables of `body` and, unless all of its shapes are meant, `shape`")
            .eg("between = [{ body = \"...\" }, { body = \"...\" }]")
            .or("on a joint"),
        number("stiffness", "N/m^exponent", "of the surfaces").positive("they would not touch")
            .or("required between bodies without `restitution`"),
        number("exponent", "", "1.5 for bodies that are round where they touch, 1 for a linear spring")
            .positive("the force would jump")
            .or("1.5"),
        number("damping", "s/m", "of Hunt and Crossley: the force is 1 + `damping` · closing speed times as large")
            .not_negative("it would drive the motion")
            .or("0"),
        number("stribeck_rate", "m/s", "at which friction has come down from its static level")
            .positive("friction would jump")
            .or("0.01"),
        number("rate", "m/s", "at which friction reaches 71 % of its level")
            .positive("friction would jump where the velocity changes sign")
            .or("0.001"),
    ],
);
