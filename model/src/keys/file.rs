//! The whole file, how it is run, and motions.

use super::{
    BODY, CONSTRAINT, CONTACT, CONTROLLER, COUPLER, CURVE, DRIVER, ELEMENT, EVENT, FORCE, FORMULA, JOINT,
    Key, OUTPUT, ROLLING, STATE, Table, Value, flag, name, number, plain, table, tables, text, vector, word,
};

/// The whole model file.
pub static FILE: Table = Table::new(
    "model file",
    "A mechanism for gyro-sim. All units are SI.",
    &[
        plain("format", "", "version of the format: 1").required().eg("format = 1 at the top"),
        name("name of the mechanism and of the generated module")
            .eg("name = \"some_name\", the name of the generated module"),
        Key::new(
            "gravity",
            GRAVITY,
            "acceleration of gravity, global frame; or the table of a central body, below",
        )
        .eg("gravity = [0, 0, -9.81], in m/s2, if the z axis points up, or gravity = { mu = ... }")
        .or("[0, 0, 0]"),
        flag("count_work", "whether the state carries the work of what stores no energy, see below")
            .or("true"),
        table("simulation", &SIMULATION, "how a run is made, see below")
            .eg("[simulation] on a line of its own, then t_end = 1"),
        table("generate", &GENERATE, "which [functions](library.md#only-what-is-asked-for) the module has")
            .eg("[generate] on a line of its own, then functions = [\"joint\"]")
            .or("the usual ones"),
        Key::new(
            "parameters",
            Value::Entries(&Value::Number("")),
            "names with their numbers, or with expressions",
        )
        .eg("[parameters] on a line of its own, then name = number")
        .or("none"),
        Key::new(
            "inputs",
            INPUTS,
            "names with their numbers until the caller sets them, or `value` and `between`",
        )
        .eg("[inputs] on a line of its own, then name = number")
        .or("none"),
        tables(&BODY, "one `[[body]]` a body")
            .required()
            .eg("[[body]] on a line of its own, then the keys of the body")
            .or("at least one that moves"),
        tables(&JOINT, "one `[[joint]]` a joint"),
        tables(&COUPLER, "one `[[coupler]]` a gear, belt or other coupling of two joint coordinates"),
        tables(&CONSTRAINT, "one `[[constraint]]` a row of one's own among joint coordinates or their rates"),
        tables(&DRIVER, "one `[[driver]]` a joint coordinate that is prescribed in time"),
        tables(
            &FORCE,
            "one `[[force]]` a spring, damper, friction, stop, motor, link, load, potential or dissipation",
        ),
        tables(&ROLLING, "one `[[rolling]]` a wheel, ball, roller or skate on a surface"),
        tables(&ELEMENT, "one `[[element]]` a motor, cylinder, propeller or the like, ready made"),
        tables(&CURVE, "one `[[curve]]` a curve of a table, or of points, that formulas call"),
        tables(&FORMULA, "one `[[formula]]` a formula that has a name"),
        tables(&STATE, "one `[[state]]` a quantity that a differential equation tells"),
        tables(&OUTPUT, "one `[[output]]` a thing that is computed besides the motion"),
        tables(&CONTROLLER, "one `[[controller]]` a sampled controller, which runs close a loop with"),
        tables(&EVENT, "one `[[event]]` a level whose crossings runs list"),
        tables(
            &CONTACT,
            "one `[[contact]]` rigid stops and friction that sticks, on a joint coordinate; or what acts where bodies touch",
        ),
    ],
);

const GRAVITY: Value = Value::Either(&[Value::Numbers(3, "m/s2"), Value::Table(&ATTRACTION)]);
const INPUTS: Value = Value::Entries(&Value::Either(&[Value::Plain(""), Value::Table(&INPUT)]));

/// The attraction of a central body.
pub static ATTRACTION: Table = Table::new(
    "central gravity",
    "The attraction of a point mass: a body of mass m whose mass centre is at r from `centre` is pulled there by \
     m `mu` / r².",
    &[
        number("mu", "m3/s2", "gravitational parameter of what attracts")
            .required()
            .positive("")
            .eg("mu = 3.986004418e14, in m3/s2, the earth's"),
        vector("centre", "m", "where it is, global frame").or("[0, 0, 0]"),
    ],
);

/// How a run is made.
pub static SIMULATION: Table = Table::new(
    "simulation",
    "How a run is made unless told otherwise.",
    &[
        plain("t_end", "s", "length of the run").positive("").or("1"),
        plain("step", "s", "steps of method `\"rk4\"` are at most so long").positive("").or("1e-3"),
        plain("correct_every", "s", "interval between corrections at steps of fixed length")
            .positive("")
            .or("5 steps"),
        plain("sample_every", "s", "interval between samples").positive("").or("`t_end` / 1000"),
        word("coordinates", COORDINATES, "what is integrated").or("chosen"),
        word("method", METHODS, "the integrator").or("chosen"),
        plain("tolerance", "", "error tolerated in each step, relative and absolute; not with `\"rk4\"`")
            .or("1e-9"),
        text("correction", "how constraints are kept in maximal coordinates, see below").or("\"partition\""),
    ],
);

const COORDINATES: &[(&str, &str)] =
    &[("joint", ""), ("maximal", "positions and Euler parameters of all bodies")];
const METHODS: &[(&str, &str)] = &[
    ("rk4", "in steps of fixed length"),
    ("tsit5", "under error control, as those that follow"),
    ("dop853", ""),
    ("rodas4", ""),
    ("partitioned", "of earlier files: the correction of that name"),
    ("direct", "of earlier files: the correction `\"none\"`"),
];

/// What the module has.
pub static GENERATE: Table = Table::new(
    "generate",
    "What the generated module has.",
    &[Key::new("functions", Value::Texts(0, usize::MAX), "functions by their names or by groups")
        .eg("functions = [\"joint\", \"jacobian\"]")],
);

/// An input with more than its value.
pub static INPUT: Table = Table::new(
    "input",
    "An input with more than its value.",
    &[
        plain("value", "", "the value until the caller sets another").required().eg("value = 0"),
        word("between", BETWEEN, "what the input is between the rows of a table").or("\"linear\""),
    ],
);

const BETWEEN: &[(&str, &str)] = &[("linear", ""), ("held", "the row before"), ("smooth", "a cubic spline")];

/// A motion that is no constant.
pub static MOTION: Table = Table::new(
    "motion",
    "A motion has one of `polynomial`, `sinusoid`, `sum`, `product` and `table`.",
    &[
        Key::new(
            "polynomial",
            Value::List(usize::MAX, ""),
            "`[c0, c1, c2, ...]`: c0 + c1 t + c2 t² + …, t in s",
        )
        .eg("polynomial = [c0, c1, c2], for c0 + c1 t + c2 t^2"),
        table("sinusoid", &SINUSOID, "table: `amplitude` · sin(`angular_frequency` · t + `phase`)")
            .eg("sinusoid = { amplitude = 0.1, frequency_hz = 2 }"),
        Key::new("sum", Value::Motions(0, ""), "list of motions, which are added")
            .eg("sum = [motion, motion]"),
        Key::new("product", Value::Motions(0, ""), "list of motions, which are multiplied")
            .eg("product = [motion, motion]"),
        text("table", "name of a CSV file, looked for from the folder of the model file")
            .eg("table = \"file.csv\""),
        Key::new("columns", Value::Texts(2, 2), "of a table: the names of its columns of time and value")
            .eg("columns = [\"t\", \"angle\"]: time and value")
            .or("its two columns"),
        word("between", &[("smooth", ""), ("linear", "")], "of a table: the curve between its rows")
            .or("\"smooth\""),
    ],
);

/// A sinusoid.
pub static SINUSOID: Table = Table::new(
    "sinusoid",
    "amplitude · sin(angular_frequency · t + phase).",
    &[
        number("amplitude", "rad or m", "amplitude").required(),
        number("angular_frequency", "rad/s", "angular frequency")
            .eg("angular_frequency = ..., in rad/s, or frequency_hz = ...")
            .or("required"),
        plain("frequency_hz", "Hz", "frequency, in place of `angular_frequency`"),
        number("phase", "rad", "phase").or("0"),
        plain("phase_deg", "degrees", "the same, in place of `phase`"),
    ],
);
