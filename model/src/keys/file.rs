//! The whole file, how it is run, and motions.

use super::{
    BODY, CONTACT, CONTROLLER, COUPLER, DRIVER, EVENT, FORCE, JOINT, Key, OUTPUT, Range, Table, Value, flag,
    name, number, plain, table, tables, text, vector,
};

/// The whole model file.
pub static FILE: Table = Table {
    name: "model file",
    meaning: "A mechanism for gyro-sim. All units are SI.",
    keys: &[
        plain("format", "", "version of the format: 1").required().example("format = 1 at the top"),
        name("name of the mechanism and of the generated module")
            .example("name = \"some_name\", the name of the generated module"),
        vector("gravity", "m/s2", "acceleration of gravity, global frame").default("[0, 0, 0]"),
        flag(
            "count_work",
            "whether the state of a mechanism with friction, motors, loads or drivers carries the work that they do, \
             for the balance of energy (no output needs it). `simulate` and `report` count it in any case",
        )
        .default("true"),
        table("simulation", &SIMULATION, "table of the settings below")
            .example("[simulation] on a line of its own, then t_end = 1"),
        table(
            "generate",
            &GENERATE,
            "table with `functions`, an array of names: the functions of the module, by group or by name \
             ([library.md](library.md#only-what-is-asked-for))",
        )
        .default("the usual ones")
        .example("[generate] on a line of its own, then functions = [\"joint\"]"),
        Key::new(
            "parameters",
            Value::Entries(&Value::Number("")),
            "table of names with their default numbers, or expressions of other parameters",
        )
        .default("none")
        .example("[parameters] on a line of its own, then name = number"),
        Key::new(
            "inputs",
            Value::Entries(&Value::Either(&[Value::Plain(""), Value::Table(&INPUT)])),
            "table of names with the numbers they have until the caller sets them, or tables of `value` and `between`",
        )
        .default("none")
        .example("[inputs] on a line of its own, then name = number"),
        tables(&BODY, "one `[[body]]` a body")
            .required()
            .default("at least one that moves")
            .example("[[body]] on a line of its own, then the keys of the body"),
        tables(&JOINT, "one `[[joint]]` a joint"),
        tables(&COUPLER, "one `[[coupler]]` a gear, belt or other coupling of two joint coordinates"),
        tables(&DRIVER, "one `[[driver]]` a joint coordinate that is prescribed in time"),
        tables(&FORCE, "one `[[force]]` a spring, damper, friction, stop, motor, link or load"),
        tables(&OUTPUT, "one `[[output]]` a thing that is computed besides the motion"),
        tables(&CONTROLLER, "one `[[controller]]` a sampled controller, which runs close a loop with"),
        tables(&EVENT, "one `[[event]]` a level whose crossings runs list"),
        tables(&CONTACT, "one `[[contact]]` rigid stops and friction that sticks, on a joint coordinate"),
    ],
    kinds: &[],
};

/// How a run is made.
pub static SIMULATION: Table = Table {
    name: "simulation",
    meaning: "How a run is made unless told otherwise.",
    keys: &[
        plain("t_end", "s", "length of the run").within(Range::Positive("")).default("1"),
        plain(
            "step",
            "s",
            "steps of fixed length are at most so long: those of method `\"rk4\"`. It is no reason to take them",
        )
        .within(Range::Positive(""))
        .default("1e-3"),
        plain(
            "correct_every",
            "s",
            "interval between corrections at steps of fixed length; no time of a run is longer than 1e15 s",
        )
        .within(Range::Positive(""))
        .default("5 steps"),
        plain(
            "sample_every",
            "s",
            "interval between samples; at steps of fixed length, without `--every`, the nearest whole number of \
             corrections (or of steps, without corrections) is taken",
        )
        .within(Range::Positive(""))
        .default("`t_end` / 1000"),
        Key::new(
            "coordinates",
            Value::Word(&[
                ("joint", "joint coordinates"),
                ("maximal", "positions and Euler parameters of all bodies"),
            ]),
            "what is integrated: `\"joint\"`, or `\"maximal\"`, positions and Euler parameters of all bodies",
        )
        .default("chosen"),
        Key::new(
            "method",
            Value::Word(&[
                ("rk4", "in steps of fixed length"),
                ("tsit5", "under error control"),
                ("dop853", "under error control"),
                ("rodas4", "under error control"),
                ("partitioned", "of earlier files: the correction `\"partition\"`"),
                ("direct", "of earlier files: the correction `\"none\"`"),
            ]),
            "the integrator: `\"rk4\"` in steps of fixed length, `\"tsit5\"`, `\"dop853\"` or `\"rodas4\"` under error \
             control",
        )
        .default("chosen"),
        plain("tolerance", "", "error tolerated in each step, relative and absolute; not with `\"rk4\"`")
            .default("1e-9"),
        text(
            "correction",
            "how constraints are kept in maximal coordinates: `\"partition\"` (the paper's eqs. (18) to (20)), \
             `\"closed-form\"`, `\"mass-weighted\"`, `\"baumgarte=RATE\"` or `\"none\"` (eq. (17) alone)",
        )
        .default("\"partition\""),
    ],
    kinds: &[],
};

/// What the module has.
pub static GENERATE: Table = Table {
    name: "generate",
    meaning: "What the generated module has.",
    keys: &[Key::new("functions", Value::Texts(0, usize::MAX), "functions by their names or by groups")
        .example("functions = [\"joint\", \"jacobian\"]")],
    kinds: &[],
};

/// An input with more than its value.
pub static INPUT: Table = Table {
    name: "input",
    meaning: "An input with more than its value.",
    keys: &[
        plain("value", "", "the value until the caller sets another").required().example("value = 0"),
        Key::new(
            "between",
            Value::Word(&[
                ("linear", "straight lines"),
                ("held", "the value of the row before"),
                ("smooth", "the natural cubic spline through the rows"),
            ]),
            "what the input is between the rows of a table",
        )
        .default("\"linear\""),
    ],
    kinds: &[],
};

/// A motion that is no constant.
pub static MOTION: Table = Table {
    name: "motion",
    meaning: "A motion has one of `polynomial`, `sinusoid`, `sum`, `product` and `table`.",
    keys: &[
        Key::new(
            "polynomial",
            Value::List(usize::MAX, ""),
            "`[c0, c1, c2, ...]`: c0 + c1 t + c2 t² + …, t in s",
        )
        .example("polynomial = [c0, c1, c2], for c0 + c1 t + c2 t^2"),
        table("sinusoid", &SINUSOID, "table: `amplitude` · sin(`angular_frequency` · t + `phase`)")
            .example("sinusoid = { amplitude = 0.1, frequency_hz = 2 }"),
        Key::new("sum", Value::Motions(0, ""), "list of motions, which are added")
            .example("sum = [motion, motion]"),
        Key::new("product", Value::Motions(0, ""), "list of motions, which are multiplied")
            .example("product = [motion, motion]"),
        text(
            "table",
            "name of a CSV file, looked for from the folder of the model file; an ordinary file of at most 64 MB",
        )
        .example("table = \"file.csv\""),
        Key::new(
            "columns",
            Value::Texts(2, 2),
            "of a table: the names of its columns of time and value, such as `[\"t\", \"angle\"]`",
        )
        .default("its two columns")
        .example("columns = [\"t\", \"angle\"]: time and value"),
        Key::new(
            "between",
            Value::Word(&[
                ("smooth", "the natural cubic spline"),
                ("linear", "straight lines, on which the velocity jumps at a row"),
            ]),
            "of a table: what is between its rows, `\"smooth\"` or `\"linear\"`",
        )
        .default("\"smooth\""),
    ],
    kinds: &[],
};

/// A sinusoid.
pub static SINUSOID: Table = Table {
    name: "sinusoid",
    meaning: "amplitude · sin(angular_frequency · t + phase).",
    keys: &[
        number("amplitude", "rad or m", "amplitude").required(),
        number("angular_frequency", "rad/s", "angular frequency")
            .default("required")
            .example("angular_frequency = ..., in rad/s, or frequency_hz = ..."),
        plain("frequency_hz", "Hz", "frequency, in place of `angular_frequency`"),
        number("phase", "rad", "phase").default("0"),
        plain("phase_deg", "degrees", "the same, in place of `phase`"),
    ],
    kinds: &[],
};
