//! Header and source of a mechanism.

use crate::functions::{Function, functions};
use crate::kernels::{row_of, table_of};
use crate::names::Names;
use crate::{Exported, MARK, Precision, runtime};
use gyro_codegen::{JointPlace, Scheduled, shown_name};
use gyro_model::{Model, Parameter, RowOwner, RowUnit};
use gyro_program::{Group, Kernel, Space};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Writes header and source.
pub(crate) struct Writer<'a> {
    model: &'a Model,
    pub(crate) scheduled: &'a Scheduled,
    /// The model file's name.
    pub(crate) page: String,
    pub(crate) names: Names<'a>,
    functions: Vec<Function>,
}

/// The function that the constructor calls and nobody else.
const SETUP: &str = "parameter_setup";

/// What each kind of named places is.
const KINDS: [(&str, &str); 8] = [
    ("joint", "Coordinates of joints in the joint state, rad or m; of Euler parameters the first of four."),
    (
        "joint_rate",
        "Their rates in the joint state, rad/s or m/s; of an angular velocity the first of three.",
    ),
    ("body", "Free bodies in the joint state: r (m) and Euler parameters, the first of seven."),
    ("body_rate", "Their velocities (m/s) and angular velocities (rad/s, body's axes), the first of six."),
    ("state", "The model file's own states in the joint state."),
    ("input", "Inputs."),
    ("parameter", "Parameters."),
    ("output", "Outputs; of one that has several numbers the first."),
];

impl<'a> Writer<'a> {
    pub(crate) fn new(
        file_name: &str,
        model: &'a Model,
        scheduled: &'a Scheduled,
        precision: Precision,
    ) -> Self {
        let names = Names::new(model, scheduled, precision);
        let functions = functions(scheduled, &names);
        Self { model, scheduled, page: shown_name(file_name), names, functions }
    }

    /// Both.
    pub(crate) fn written(&self) -> Exported {
        Exported { header: self.header(), source: self.source() }
    }

    /// The functions that callers have.
    pub(crate) fn functions(&self) -> impl Iterator<Item = &Function> {
        self.functions.iter().filter(|function| function.name != SETUP)
    }

    fn has_loops(&self) -> bool {
        self.scheduled.len(Space::Closure) > 0
    }

    pub(crate) fn has_solver(&self) -> bool {
        self.scheduled.len(Space::Joints) > 0
    }

    pub(crate) fn has_jacobian(&self) -> bool {
        self.scheduled.groups.contains(&Group::Jacobian)
    }

    /// Rows and columns of the numbers of sparse matrices, by the functions that write these.
    fn patterns(&self) -> Vec<(Kernel, &'a [(usize, usize)])> {
        let patterns = [
            (Kernel::PhiQ, &self.scheduled.phi_q_pattern[..]),
            (Kernel::PhiPi, &self.scheduled.phi_pi_pattern[..]),
        ];
        let is_there = |kernel: Kernel| self.scheduled.groups.contains(&kernel.group());
        patterns.into_iter().filter(|(kernel, _)| is_there(*kernel)).collect()
    }

    fn header(&self) -> String {
        let guard = self.names.upper("h");
        let real = self.names.precision.real();
        let mut text = format!("{}\n#ifndef {guard}\n#define {guard}\n\n", self.head());
        text += "#include <stddef.h>\n#include <stdint.h>\n\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n";
        let _ = write!(text, "/* All numbers: SI units. */\ntypedef {real} {};\n\n", self.names.own("real"));
        text += &self.sizes();
        text += &self.indices();
        text += &self.definition();
        for (of, pattern) in self.patterns() {
            let (name, n) = (self.names.own(of.name()), pattern.len().max(1));
            let _ = write!(
                text,
                "\n/* Rows and columns of the numbers that {name} writes. */\n\
                 extern const uint16_t {name}_pattern[{n}][2];\n"
            );
        }
        text += "\n/* Functions of time t, s, and of a state. What they write must not overlap with what they read. */\n";
        for function in self.functions() {
            let _ = write!(text, "\n{}{};\n", comment(&function.doc), wrapped(&function.head));
        }
        if self.has_solver() {
            text += &self.applied(runtime::SOLVER_HEADER);
        }
        text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
    }

    fn head(&self) -> String {
        let text = format!(
            "The mechanism `{}`. C99; nothing is allocated, nothing is shared, all functions are re-entrant. Compiled \
             without contraction of products and sums (gcc and clang: -std=c99, or -ffp-contract=off) it computes the \
             same bits as the Rust module. Bodies with coordinates: {}.",
            self.model.name,
            self.names.bodies.join(", ")
        );
        format!("{MARK} from {}. Do not edit. */\n\n{}", self.page.replace("*/", "* /"), comment(&text))
    }

    fn sizes(&self) -> String {
        let sizes = [
            ("N_BODIES", self.names.bodies.len(), "bodies with coordinates"),
            (
                "N_STATE",
                self.scheduled.len(Space::State),
                "r and Euler parameters of all bodies, then (s, w'), then work, states and turns",
            ),
            ("N_ROWS", self.scheduled.len(Space::Rows), "rows of all joints"),
            ("N_CONSTRAINTS", self.scheduled.len(Space::Constraints), "these and the normalisations"),
            ("N_VELOCITIES", self.scheduled.len(Space::Velocities), "(s, w') of all bodies"),
            ("N_READINGS", self.scheduled.len(Space::Readings), "readings of joints"),
            (
                "N_JOINTS",
                self.scheduled.len(Space::Joints),
                "the joint state: coordinates, states among them, then rates, then work",
            ),
            ("N_RATES", self.scheduled.len(Space::Rates), "rates of joint coordinates"),
            ("N_CLOSURE", self.scheduled.len(Space::Closure), "rows that close loops"),
            ("N_OUTPUTS", self.scheduled.len(Space::Outputs), "outputs"),
            ("N_INPUTS", self.model.inputs.len(), "inputs"),
            ("N_PARAMETERS", self.model.parameters.len(), "parameters"),
        ];
        let lines: Vec<String> = sizes
            .iter()
            .map(|(name, size, what)| format!("    {} = {size} /* {what} */", self.names.upper(name)))
            .collect();
        let lines: Vec<String> = lines.iter().map(|line| line.replacen(" /*", ", /*", 1)).collect();
        format!("/* Sizes. */\nenum {{\n{}\n    {} = 0\n}};\n", lines.join("\n"), self.names.upper("first"))
    }

    fn indices(&self) -> String {
        let mut text = String::new();
        for (kind, what) in KINDS {
            let of_kind = self.names.of_kind(kind);
            let lines: Vec<String> =
                of_kind.map(|(index, name)| format!("    {name} = {}", index.place)).collect();
            if !lines.is_empty() {
                let _ = write!(text, "\n/* {what} */\nenum {{\n{}\n}};\n", lines.join(",\n"));
            }
        }
        text
    }

    /// The mechanism's type and what sets it.
    fn definition(&self) -> String {
        let (real, name) = (self.names.own("real"), &self.names.prefix);
        let fields = [
            ("parameters", self.model.parameters.len(), "changed by the setter alone"),
            ("derived", self.scheduled.n_results(Kernel::ParameterSetup), "what depends on parameters alone"),
            ("inputs", self.model.inputs.len(), "may be set at any time between steps"),
        ];
        let mut lines: Vec<String> = fields
            .iter()
            .filter(|(_, n, _)| *n > 0)
            .map(|(field, n, what)| format!("    {real} {field}[{n}]; /* {what} */"))
            .collect();
        if lines.is_empty() {
            lines.push("    char nothing; /* it has neither parameters nor inputs */".to_owned());
        }
        format!(
            "\n/* A mechanism with its parameters and inputs. */\ntypedef struct {{\n{}\n}} {name};\n\n\
             /* Its bytes, for callers that cannot read this header. */\nsize_t {name}_bytes(void);\n\n\
             /* Sets all parameters and inputs to those of the model file. */\nvoid {name}_init({name} *m);\n\n\
             /* Sets a parameter; returns whether there is one of this index, and the number is finite. */\n\
             int {name}_set_parameter({name} *m, int index, {real} value);\n\n\
             /* Sets an input; returns whether there is one of this index, and the number is finite. */\n\
             int {name}_set_input({name} *m, int index, {real} value);\n",
            lines.join("\n")
        )
    }

    /// A function for each curve that is called.
    fn curves(&self) -> String {
        let called: BTreeSet<u16> =
            self.scheduled.kernels.values().flat_map(|kernel| kernel.tape.curves()).collect();
        if called.is_empty() {
            return String::new();
        }
        let [real, curve] = ["real", "curve"].map(|name| self.names.own(name));
        let mut text = self.applied(runtime::CURVE);
        for n in called {
            let [knots, pieces] = ["knots", "pieces"].map(|name| self.names.own(&format!("{name}_{n}")));
            let size = format!("(int)(sizeof {pieces} / sizeof *{pieces})");
            let _ = write!(
                text,
                "\nstatic {real} {curve}_{n}(int order, {real} at)\n{{\n    return {curve}({knots}, {pieces}, {size}, \
                 order, at);\n}}\n"
            );
        }
        text
    }

    fn source(&self) -> String {
        let mut kernels = String::new();
        for (n, curve) in self.scheduled.curves.iter().enumerate() {
            let knots: Vec<String> = curve.knots.iter().map(|knot| format!("{knot:?}")).collect();
            let pieces: Vec<String> = curve.pieces.iter().map(|piece| row_of(piece)).collect();
            for (what, columns, rows) in [("knots", "", knots), ("pieces", "[4]", pieces)] {
                let declared = format!("{}[{}]{columns}", self.names.own(&format!("{what}_{n}")), rows.len());
                let _ = write!(kernels, "\n{}\n", table_of(&declared, &rows).join("\n"));
            }
        }
        if !self.scheduled.curves.is_empty() {
            kernels += &self.applied(runtime::SPLINE);
        }
        kernels += &self.curves();
        for (of, pattern) in self.patterns() {
            let pairs: Vec<String> =
                pattern.iter().map(|(row, column)| format!("{{{row}, {column}}}")).collect();
            let (name, n) = (self.names.own(of.name()), pattern.len().max(1));
            let pairs = if pairs.is_empty() { "{0, 0}".to_owned() } else { wrapped_list(&pairs) };
            let _ = write!(kernels, "\nconst uint16_t {name}_pattern[{n}][2] = {{{pairs}}};\n");
        }
        for function in &self.functions {
            let storage = if function.name == SETUP { "static " } else { "" };
            let head = wrapped(&format!("{storage}{}", function.head));
            let _ = write!(kernels, "\n{head}\n{{\n{}\n}}\n", function.body.join("\n"));
        }
        kernels += &self.set_up();
        let mut solver = String::new();
        if self.has_solver() {
            solver += "\n";
            solver += runtime::arithmetic(self.names.precision);
            let _ = writeln!(solver, "#define GYRO_SIZE {:?}", self.model.size());
            solver += &match self.has_loops() {
                true => "#define BLAMED(s, m, status) gyro_blame(s, m, status)\n\n".to_owned(),
                false => "#define BLAMED(s, m, status) ((void)(m), (status))\n\n".to_owned(),
            };
            runtime::SOLVER.iter().for_each(|part| solver += part);
            if self.has_jacobian() {
                solver += runtime::RODAS4;
            }
            let [before, rest @ ..] = runtime::CONTROL else { unreachable!("the control has parts") };
            solver += before;
            if self.has_loops() {
                solver += "\nstatic void gyro_push(gyro_solver *s, gyro_real t, gyro_real pivot);\n";
            }
            for (n, part) in rest.iter().enumerate() {
                solver += part;
                if n == 0 && self.has_loops() {
                    solver += runtime::POSES;
                }
            }
            solver = self.applied(&solver);
        }
        let elementary = runtime::elementary(&(kernels.clone() + &solver));
        let constant = match self.names.precision {
            Precision::F64 => "",
            Precision::F32 => "#define K(x) ((float)(x))\n",
        };
        let solver = match self.names.precision {
            Precision::F64 => solver,
            // The kernels have it already.
            Precision::F32 => {
                solver.replacen(&format!("#define K(x) (({})(x))\n", self.names.own("real")), "", 1)
            }
        };
        format!(
            "{}\n#include \"{}.h\"\n\n#include <float.h>\n#include <math.h>\n#include <string.h>\n\n{}{constant}{elementary}{kernels}{solver}",
            self.head(),
            self.names.prefix,
            CHECKS
        )
    }

    /// Parameters and inputs.
    fn set_up(&self) -> String {
        let name = &self.names.prefix;
        let real = self.names.own("real");
        let default =
            |parameter: &Parameter| self.names.precision.constant(gyro_model::to_f64(&parameter.value));
        let n_derived = self.scheduled.n_results(Kernel::ParameterSetup);
        let mut init = String::new();
        for (field, parameters) in [("parameters", &self.model.parameters), ("inputs", &self.model.inputs)] {
            for (n, parameter) in parameters.iter().enumerate() {
                let _ = writeln!(init, "    m->{field}[{n}] = {};", default(parameter));
            }
        }
        let derive = if n_derived == 0 {
            String::new()
        } else {
            format!(
                "\nstatic void {name}_derive({name} *m)\n{{\n    {real} derived[{n}];\n    {name}_{SETUP}(m, derived);\n    \
                 memcpy(m->derived, derived, sizeof derived);\n}}\n",
                n = n_derived
            )
        };
        if n_derived > 0 {
            let _ = writeln!(init, "    memset(m->derived, 0, sizeof m->derived);\n    {name}_derive(m);");
        }
        if init.is_empty() {
            init += "    m->nothing = 0;\n";
        }
        let setter = |what: &str, field: &str, n: usize, then: &str| {
            let body = if n == 0 {
                "    (void)m;\n    (void)index;\n    (void)value;\n    return 0;\n".to_owned()
            } else {
                format!(
                    "    if (index < 0 || index >= {n} || !isfinite(value))\n        return 0;\n    \
                     m->{field}[index] = value;\n{then}    return 1;\n"
                )
            };
            format!("\nint {name}_set_{what}({name} *m, int index, {real} value)\n{{\n{body}}}\n")
        };
        let then = if n_derived > 0 { format!("    {name}_derive(m);\n") } else { String::new() };
        format!(
            "{derive}\nsize_t {name}_bytes(void)\n{{\n    return sizeof({name});\n}}\n\n\
             void {name}_init({name} *m)\n{{\n{init}}}\n{}{}",
            setter("parameter", "parameters", self.model.parameters.len(), &then),
            setter("input", "inputs", self.model.inputs.len(), "")
        )
    }

    /// A text of the run time for this mechanism.
    fn applied(&self, template: &str) -> String {
        let text = template
            .replace("{GYRO_PLACES}", &format!("{{{}}}", self.places()))
            .replace("{GYRO_CLOSURE_ROWS}", &format!("{{{}}}", self.closure_rows()))
            .replace("gyro_derivative_of_solver", "gyro_joint_derivative")
            .replace("GYRO_SOLVER_N", "GYRO_N_JOINTS");
        let is_oriented =
            |place: &JointPlace| matches!(place, JointPlace::Orientation { .. } | JointPlace::Body { .. });
        let has_orientations = self.scheduled.joint.iter().any(|joint| joint.places.iter().any(is_oriented));
        let text = without(&text, "GYRO_HAS_LOOPS", self.has_loops());
        let text = without(&text, "GYRO_HAS_PLACES", self.has_loops() || has_orientations);
        let text = without(&text, "GYRO_HAS_ORIENTATIONS", has_orientations);
        let text = without(&text, "GYRO_HAS_JACOBIAN", self.has_jacobian());
        let text = text.replace("GYRO_HAS_JACOBIAN", if self.has_jacobian() { "1" } else { "0" });
        self.names.applied(&text)
    }

    fn places(&self) -> String {
        let places = self.scheduled.joint.iter().flat_map(|joint| &joint.places);
        let places = places.map(|place| match *place {
            JointPlace::Scalar { joint, coordinate } => {
                let kind = self.model.joints[joint].kind.coordinates()[coordinate];
                if kind.is_angle() { "GYRO_PLACE_ANGLE" } else { "GYRO_PLACE_LENGTH" }
            }
            JointPlace::Orientation { .. } => "GYRO_PLACE_ORIENTATION",
            JointPlace::Body { .. } => "GYRO_PLACE_BODY",
            JointPlace::Turn { .. } => "GYRO_PLACE_ANGLE",
            // It is never closed.
            JointPlace::State { .. } => "GYRO_PLACE_LENGTH",
        });
        places.collect::<Vec<_>>().join(", ")
    }

    fn closure_rows(&self) -> String {
        let rows = self.model.rows();
        let closure = self.scheduled.joint.iter().flat_map(|joint| &joint.closure_rows);
        let written = closure.map(|&row| {
            let row = &rows[row];
            let owner = match row.owner {
                RowOwner::Body(body) => &self.model.bodies[body].name,
                RowOwner::Joint(joint) => &self.model.joints[joint].name,
                RowOwner::Coupler(coupler) => &self.model.couplers[coupler].name,
                RowOwner::Driver(driver) => &self.model.drivers[driver].name,
            };
            format!("{{{}, \"{owner}\"}}", u8::from(row.unit == RowUnit::Length))
        });
        written.collect::<Vec<_>>().join(", ")
    }
}

/// What keeps a compiler from other roundings.
const CHECKS: &str = "\
#if defined(__FAST_MATH__)
#error \"-ffast-math changes the results\"
#endif
/* By methods 16 and 32 only types that are narrower than float are computed more precisely. */
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16 && FLT_EVAL_METHOD != 32
#error \"this compiler computes with excess precision: for x86 give -msse2 -mfpmath=sse\"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#endif
";

/// A text without what one of its conditions leaves out.
fn without(text: &str, condition: &str, holds: bool) -> String {
    let (begin, mut kept, mut depth, mut is_left_out) = (format!("#if {condition}"), String::new(), 0, false);
    for line in text.lines() {
        let is_inside = depth > 0;
        if line == begin {
            (depth, is_left_out) = (1, !holds);
        } else if is_inside && line == "#else" {
            is_left_out = holds;
        } else if is_inside && line == "#endif" {
            (depth, is_left_out) = (0, false);
        } else if !is_left_out {
            kept += line;
            kept.push('\n');
        }
    }
    kept
}

/// A comment of as many lines as it takes.
fn comment(text: &str) -> String {
    let mut lines = vec![String::from("/*")];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("it has a line");
        if last.chars().count() + word.chars().count() + 4 > 116 {
            lines.push(format!(" * {word}"));
        } else {
            *last += &format!(" {word}");
        }
    }
    lines.join("\n").replace("*/ ", "* / ") + " */\n"
}

/// The head of a function, broken behind commas.
fn wrapped(head: &str) -> String {
    let mut lines = vec![String::new()];
    for part in head.split_inclusive(", ") {
        let last = lines.last_mut().expect("it has a line");
        if last.len() + part.len() > 112 {
            *last = last.trim_end().to_owned();
            lines.push(format!("    {part}"));
        } else {
            *last += part;
        }
    }
    lines.join("\n")
}

fn wrapped_list(elements: &[String]) -> String {
    let rows = elements.chunks(12).map(|row| row.join(", "));
    format!("\n    {}\n", rows.collect::<Vec<_>>().join(",\n    "))
}
