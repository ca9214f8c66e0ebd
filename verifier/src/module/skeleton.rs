//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a
//! body may leave unread as `ANY_name`.

use crate::joints::JointLayout;
use gyro_model::{
    CoordinateKind, JointKind, Model, Number, Parameter, ParameterRule, RowOwner, RowUnit, Spline, to_f64,
};
use std::fmt::Display;

/// How the coordinate partition is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// One special Euler parameter for each joint.
    Charts,
    /// Full pivoting at run time.
    Pivoting,
}

/// What the description leaves to choice.
#[derive(Clone, Copy, Debug)]
pub struct Has {
    /// How the coordinate partition is chosen.
    pub choice: Choice,
    /// The Jacobian of the joint form.
    pub jacobian: bool,
    /// A function of what depends on parameters alone.
    pub set_up: bool,
}

/// The expected text.
pub fn text(
    model: &Model,
    type_name: &str,
    tables: &[Spline],
    has: Has,
    joints: Option<&JointLayout>,
) -> String {
    [
        constants(tables),
        definition(model, type_name, has.set_up),
        mechanism(model, type_name, joints.is_some()),
        partition(model, type_name, has.choice, joints),
        equations(model, type_name),
        joints.map(|joints| joint_space(model, type_name, joints, has.jacobian)).unwrap_or_default(),
    ]
    .concat()
}

/// `gyroscope_maximal` to `GyroscopeMaximal`; a name that Rust or the module needs otherwise gets an underscore.
pub fn type_name(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let name: String = words.map(|word| word[..1].to_uppercase() + &word[1..]).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { name + "_" } else { name }
}

fn list<T: Display>(items: impl IntoIterator<Item = T>) -> String {
    items.into_iter().map(|item| item.to_string()).collect::<Vec<_>>().join(", ")
}

fn lines<T: Display>(items: impl IntoIterator<Item = T>) -> String {
    items.into_iter().map(|item| item.to_string()).collect::<Vec<_>>().join(" ")
}

fn names<'a>(items: impl IntoIterator<Item = &'a String>) -> String {
    list(items.into_iter().map(|name| format!("{name:?}")))
}

/// The tables, whose numbers are read elsewhere.
fn constants(tables: &[Spline]) -> String {
    lines(tables.iter().enumerate().map(|(k, table)| {
        let (knots, pieces) = (table.knots.len(), table.pieces.len());
        format!("const KNOTS_{k}: [f64; {knots}] = []; const PIECES_{k}: [[f64; 4]; {pieces}] = [];")
    }))
}

/// `match` that sets one of some fields, or its refusal where there are none; what comes before and after it.
fn setter(signature: &str, fields: &[Parameter], (of, before, after): (&str, &str, &str)) -> String {
    if fields.is_empty() {
        return format!("{signature}(&mut self, _index: usize, _value: T) -> bool {{ false }}");
    }
    let arm = |(k, field): (usize, &Parameter)| format!("{k} => {{ {of}.{} = value; }}", field.name);
    let arms = lines(fields.iter().enumerate().map(arm));
    format!(
        "{signature}(&mut self, index: usize, value: T) -> bool {{
            {before}
            match index {{ {arms} _ => return false, }}
            {after}
            true
        }}"
    )
}

fn definition(model: &Model, name: &str, has_set_up: bool) -> String {
    let (parameters, inputs) = (&model.parameters, &model.inputs);
    let public =
        |fields: &[Parameter]| fields.iter().map(|f| format!("pub {}: T", f.name)).collect::<Vec<_>>();
    let default = |f: &Parameter| format!("{}: T::constant({:?})", f.name, to_f64(&f.value));
    let defaults = |fields: &[Parameter]| fields.iter().map(default).collect::<Vec<_>>();
    let (declared_inputs, default_inputs) = (public(inputs), defaults(inputs));
    let count = parameters.len();
    let names = names(parameters.iter().map(|p| &p.name));
    let set_one = "pub fn set_parameter";
    if parameters.is_empty() {
        let marker = "scalar: ::core::marker::PhantomData";
        let (declared, first) = if inputs.is_empty() {
            (format!("{marker}<T>"), marker.to_owned())
        } else {
            (list(declared_inputs), list(default_inputs))
        };
        let set_one = setter(set_one, parameters, ("", "", ""));
        return format!(
            "#[derive(Clone, Copy, Debug, PartialEq)]
            pub struct {name}<T> {{ {declared} }}
            impl<T: gyro_sim::Scalar> ::core::default::Default for {name}<T> {{
                fn default() -> Self {{ Self {{ {first} }} }}
            }}
            impl<T: gyro_sim::Scalar> {name}<T> {{
                pub const PARAMETERS: [&'static str; {count}] = [{names}];
                {set_one}
            }}",
        );
    }
    let with_values = |own: &str, values: &str, inputs: Vec<String>| {
        list([own, values].map(str::to_owned).into_iter().filter(|field| !field.is_empty()).chain(inputs))
    };
    let [declared_values, first_values, set_up, set_up_values] = if has_set_up {
        [
            "derived: [T; INT_derived]",
            "derived: [T::constant(0.0); INT_derived]",
            "fn set_up(&self, ANY_out: &mut [T; INT_derived]) { HOLE_set_up }",
            "let mut derived = self.derived; self.set_up(&mut derived); self.derived = derived;",
        ]
    } else {
        [""; 4]
    };
    let fields = with_values("parameters: Parameters<T>", declared_values, declared_inputs);
    let first = with_values("parameters", first_values, default_inputs);
    let (declared, values) = (list(public(parameters)), list(defaults(parameters)));
    let around = ("parameters", "let mut parameters = self.parameters;", "self.set_parameters(parameters);");
    let set_one = setter(set_one, parameters, around);
    let own = list(parameters.iter().map(|p| format!("self.{}", p.name)));
    let rules = list(model.parameter_rules().iter().map(|rule| rule_of_parameters(model, rule)));
    format!(
        "#[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters<T> {{ {declared} }}
        impl<T: gyro_sim::Scalar> ::core::default::Default for Parameters<T> {{
            fn default() -> Self {{ Self {{ {values} }} }}
        }}
        impl<T: gyro_sim::Real> Parameters<T> {{
            pub fn check(&self) -> ::core::result::Result<(), gyro_sim::admissible::Inadmissible> {{
                gyro_sim::admissible::check(&[{own}], &[{rules}])
            }}
        }}
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct {name}<T> {{ {fields} }}
        impl<T: gyro_sim::Scalar> ::core::default::Default for {name}<T> {{
            fn default() -> Self {{ Self::new(Parameters::default()) }}
        }}
        impl<T: gyro_sim::Scalar> {name}<T> {{
            pub const PARAMETERS: [&'static str; {count}] = [{names}];
            pub fn new(parameters: Parameters<T>) -> Self {{
                let mut mechanism = Self {{ {first} }};
                mechanism.set_parameters(parameters);
                mechanism
            }}
            pub fn parameters(&self) -> &Parameters<T> {{ &self.parameters }}
            pub fn set_parameters(&mut self, parameters: Parameters<T>) {{
                self.parameters = parameters;
                {set_up_values}
            }}
            {set_one}
            {set_up}
        }}",
    )
}

/// A rule that parameters must satisfy, as `gyro_sim::admissible` has it.
fn rule_of_parameters(model: &Model, rule: &ParameterRule<'_>) -> String {
    let number = |number: &Number| {
        let inside = match number {
            Number::Parameter { index, negated: false } => format!("Given({index})"),
            Number::Parameter { index, negated: true } => format!("Negated({index})"),
            number => format!("Fixed({:?})", model.value(number)),
        };
        format!("gyro_sim::admissible::Number::{inside}")
    };
    let several = |numbers: &[Number]| format!("[{}]", list(numbers.iter().map(number)));
    let inside = match rule {
        ParameterRule::Positive(one) => format!("Positive({})", number(one)),
        ParameterRule::NotNegative(one) => format!("NotNegative({})", number(one)),
        ParameterRule::NotZero(numbers) => format!("NotZero(&{})", several(numbers)),
        ParameterRule::NotParallel(axis, zero) => {
            format!("NotParallel({}, {})", several(*axis), several(*zero))
        }
        ParameterRule::Inertia(elements) => format!("Inertia({})", several(*elements)),
    };
    format!("gyro_sim::admissible::Rule::{inside}")
}

/// Number of elements of the state.
pub fn n_state(model: &Model) -> usize {
    let n = model.coordinate_bodies().len();
    13 * n + usize::from(model.has_work()) + model.turn_references().len()
}

/// A function that gives buffers of zeros, a field for each pair.
fn buffers(function: &str, of: &str, fields: &[(&str, &str)]) -> String {
    let zeros = |(field, count): &(&str, &str)| format!("{field}: [T::constant(0.0); {count}]");
    let fields = list(fields.iter().map(zeros));
    format!("fn {function}(&self) -> gyro_sim::{of}<Self> {{ gyro_sim::{of} {{ {fields} }} }}")
}

/// A function that fills `out`, for each pair of name and type.
fn fillings(pairs: &[(&str, &str)]) -> String {
    lines(pairs.iter().map(|(function, ty)| {
        format!(
            "fn {function}(&self, ANY_t: T, ANY_y: &Self::State, ANY_out: &mut Self::{ty}) {{ HOLE_{function} }}"
        )
    }))
}

fn coordinates(kind: JointKind) -> String {
    if kind == JointKind::Spherical {
        return "gyro_sim::Coordinate::Orientation".to_owned();
    }
    let name = |is_angle| if is_angle { "Angle" } else { "Length" };
    list(kind.coordinates().iter().map(|c| format!("gyro_sim::Coordinate::{}", name(c.is_angle()))))
}

fn owner(model: &Model, owner: RowOwner) -> String {
    let (kind, index) = match owner {
        RowOwner::Body(body) => {
            let before = model.coordinate_bodies().iter().filter(|&&other| other < body).count();
            ("Body", before)
        }
        RowOwner::Joint(joint) => ("Joint", joint),
        RowOwner::Coupler(coupler) => ("Coupler", coupler),
        RowOwner::Driver(driver) => ("Driver", driver),
    };
    format!("gyro_sim::Owner::{kind}({index})")
}

/// How many numbers are read off all joints: of an angle three, of a length two, of an orientation seven.
pub fn n_readings(model: &Model) -> usize {
    model.joints.iter().map(|joint| n_readings_of(joint.kind)).sum()
}

fn n_readings_of(kind: JointKind) -> usize {
    match kind {
        JointKind::Spherical => 7,
        _ => n_readings_of_all(kind.coordinates()),
    }
}

fn n_readings_of_all(coordinates: &[CoordinateKind]) -> usize {
    coordinates.iter().map(|c| if c.is_angle() { 3 } else { 2 }).sum()
}

/// Where the angle of each turn reference is among the readings.
fn turn_references(model: &Model) -> String {
    let turns = model.turn_references();
    let places = turns.iter().map(|turn| {
        let before: usize = model.joints[..turn.joint].iter().map(|joint| n_readings_of(joint.kind)).sum();
        let own = &model.joints[turn.joint].kind.coordinates()[..turn.coordinate];
        (before + n_readings_of_all(own)).to_string()
    });
    list(places)
}

fn mechanism(model: &Model, name: &str, is_tree: bool) -> String {
    let corrected = "fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
        HOLE_corrected_derivative
    }";
    let corrected = if is_tree { corrected } else { "" };
    let (n, n_rows, n_outputs) = (model.coordinate_bodies().len(), model.rows().len(), columns(model).len());
    let sizes = [n_rows, n_rows + n, n_readings(model), n_outputs].map(|n| n.to_string());
    let [rows, constraints, readings, outputs] = &sizes;
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for {name}<T> {{
            type Scalar = T;
            type State = [T; {}];
            type Rows = [T; {rows}];
            type Constraints = [T; {constraints}];
            type Readings = [T; {readings}];
            type Outputs = [T; {outputs}];
            fn description(&self) -> &gyro_sim::Description<'_> {{
                const DESCRIPTION: gyro_sim::Description<'static> = {};
                &DESCRIPTION
            }}
            {}
            fn start(&self) -> Self::State {{ HOLE_start }}
            fn derivative(&self, ANY_t: T, ANY_y: &Self::State, dy: &mut Self::State) {{ HOLE_derivative }}
            {corrected}
            {}
            fn energy(&self, ANY_t: T, ANY_y: &Self::State) -> gyro_sim::Energy<T> {{ HOLE_energy }}
            {}
            {}
        }}",
        n_state(model),
        description(model),
        buffers(
            "buffers",
            "Buffers",
            &[("rows", rows), ("constraints", constraints), ("readings", readings), ("outputs", outputs)],
        ),
        fillings(&[("phi", "Constraints"), ("velocity_residual", "Rows")]),
        fillings(&[("read_joints", "Readings"), ("outputs", "Outputs")]),
        setter("fn set_input", &model.inputs, ("self", "", "")),
    )
}

/// Names, rows and sizes.
fn description(model: &Model) -> String {
    let bodies = names(model.coordinate_bodies().iter().map(|&body| &model.bodies[body].name));
    let couplers = names(model.couplers.iter().map(|coupler| &coupler.name));
    let drivers = names(model.drivers.iter().map(|driver| &driver.name));
    let inputs = names(model.inputs.iter().map(|input| &input.name));
    let joints = list(model.joints.iter().map(|joint| {
        let (name, coordinates) = (&joint.name, coordinates(joint.kind));
        format!("gyro_sim::JointInfo {{ name: {name:?}, coordinates: &[{coordinates}] }}")
    }));
    let rows = list(model.rows().iter().map(|row| {
        let (owner, is_length) = (owner(model, row.owner), row.unit == RowUnit::Length);
        format!("gyro_sim::RowInfo {{ owner: {owner}, is_length: {is_length} }}")
    }));
    let outputs = list(columns(model).into_iter().map(|(name, suffix, unit)| {
        format!("gyro_sim::OutputInfo {{ name: {name:?}, suffix: {suffix:?}, unit: {unit:?} }}")
    }));
    let (size, has_work, turns) = (model.size(), model.has_work(), turn_references(model));
    format!(
        "gyro_sim::Description {{
            size: {size:?},
            bodies: &[{bodies}],
            joints: &[{joints}],
            couplers: &[{couplers}],
            drivers: &[{drivers}],
            rows: &[{rows}],
            has_work: {has_work},
            turn_references: &[{turns}],
            inputs: &[{inputs}],
            outputs: &[{outputs}]
        }}"
    )
}

fn partition(model: &Model, name: &str, choice: Choice, joints: Option<&JointLayout>) -> String {
    match choice {
        Choice::Charts => by_charts(model, name),
        Choice::Pivoting => by_pivoting(model, name, joints),
    }
}

const SOLVED: &str = "::core::result::Result<(), gyro_sim::Error>";

fn by_charts(model: &Model, name: &str) -> String {
    let state = n_state(model);
    let solves = ["newton_step", "solve_velocities"];
    let unrolled = lines(solves.map(|solve| {
        format!(
            "fn {solve}_on(
                &self, ANY_t: T, ANY_charts: &[[T; 4]; INT_charts], ANY_y: &mut [T; {state}]
            ) {{ HOLE_{solve} }}"
        )
    }));
    let chosen = lines(solves.map(|solve| {
        format!(
            "fn {solve}(&self, t: T, choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                self.{solve}_on(t, &gyro_sim::charts::one_hot(choice), y);
                Ok(())
            }}"
        )
    }));
    format!(
        "impl<T: gyro_sim::Scalar> {name}<T> {{
            fn chart_vectors(&self, ANY_y: &[T; {state}]) -> [[T; 4]; INT_charts] {{ HOLE_chart_vectors }}
            {unrolled}
        }}
        impl<T: gyro_sim::Lanes> gyro_sim::Partition for {name}<T> {{
            type Independent = gyro_sim::charts::Charts<T, INT_charts>;
            fn independent(&self, _t: T, y: &Self::State) -> Self::Independent {{
                gyro_sim::charts::best(&self.chart_vectors(y))
            }}
            fn follow(&self, _t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {{
                gyro_sim::charts::follow(&self.chart_vectors(y), choice)
            }}
            {chosen}
        }}"
    )
}

fn by_pivoting(model: &Model, name: &str, joints: Option<&JointLayout>) -> String {
    let n = model.coordinate_bodies().len();
    let (n_constraints, n_positions) = (model.rows().len() + n, 7 * n);
    let solves = lines(["newton_step", "solve_velocities"].map(|solve| {
        format!(
            "fn {solve}(&self, t: T, choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                gyro_sim::pivoting::{solve}(self, t, choice, y)
            }}"
        )
    }));
    // Trees have no singular poses.
    let clearance = if joints.is_some() {
        String::new()
    } else {
        format!(
            "fn clearance(&self, t: T, y: &Self::State) -> ::core::option::Option<gyro_sim::Clearance<T>> {{
                ::core::option::Option::Some(
                    gyro_sim::pivoting::clearance::<_, {n_constraints}, {n_positions}>(self, t, y)
                )
            }}"
        )
    };
    format!(
        "impl<T: gyro_sim::Real> gyro_sim::Partition for {name}<T> {{
            type Independent = gyro_sim::pivoting::Pivots<{n_constraints}, {n_positions}>;
            fn independent(&self, t: T, y: &Self::State) -> Self::Independent {{
                gyro_sim::pivoting::independent(self, t, y)
            }}
            fn follow(&self, t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {{
                gyro_sim::pivoting::follow(self, t, y, choice)
            }}
            fn is_met(&self, t: T, y: &Self::State, phi: &Self::Constraints) -> bool {{
                gyro_sim::pivoting::is_met(self, t, y, phi)
            }}
            {solves}
            {clearance}
        }}"
    )
}

fn equations(model: &Model, name: &str) -> String {
    let velocities = (6 * model.coordinate_bodies().len()).to_string();
    let patterns =
        lines(["phi_q", "phi_pi"].map(|matrix| {
            format!("fn {matrix}_pattern(&self) -> &[(u16, u16)] {{ HOLE_{matrix}_pattern }}")
        }));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Equations for {name}<T> {{
            type Velocities = [T; {velocities}];
            type PhiQ = [T; INT_phi_q];
            type PhiPi = [T; INT_phi_pi];
            type Accelerations = [T; INT_accelerations];
            {} {patterns} {} {}
            fn project(
                &self, ANY_t: T, ANY_y: &Self::State, ANY_rows: &Self::Rows, ANY_out: &mut Self::Velocities,
            ) {{ HOLE_project }}
        }}",
        buffers(
            "terms",
            "Terms",
            &[
                ("velocities", &velocities),
                ("phi_q", "INT_phi_q"),
                ("phi_pi", "INT_phi_pi"),
                ("accelerations", "INT_accelerations"),
            ],
        ),
        fillings(&[
            ("phi_q", "PhiQ"),
            ("phi_pi", "PhiPi"),
            ("nu", "Rows"),
            ("gamma", "Rows"),
            ("applied_force", "Velocities"),
            ("accelerations", "Accelerations"),
        ]),
        multipliers("multipliers", "Accelerations"),
    )
}

fn multipliers(name: &str, accelerations: &str) -> String {
    format!(
        "fn {name}(
            &self, ANY_t: T, ANY_y: &Self::State, ANY_accelerations: &Self::{accelerations}, lambda: &mut Self::Rows,
        ) {{ HOLE_{name} }}"
    )
}

fn joint_space(model: &Model, name: &str, joints: &JointLayout, has_jacobian: bool) -> String {
    let n_solution = 6 * model.coordinate_bodies().len() + model.rows().len();
    let (n_state, n_rates) = (joints.n_state(), joints.n_rates);
    let sizes = [n_state * n_state, n_state * model.inputs.len()];
    let [(jacobian, no_slopes), (input_jacobian, no_input_slopes)] = if has_jacobian {
        sizes.map(|n| (format!("[T; {n}]"), format!("[T::constant(0.0); {n}]")))
    } else {
        sizes.map(|_| ("()".to_owned(), "()".to_owned()))
    };
    let jacobians = "fn joint_jacobian(
            &self, ANY_t: T, ANY_x: &Self::Joints, dfdx: &mut Self::Jacobian, dfdt: &mut Self::Joints,
        ) {
            HOLE_joint_jacobian
        }
        fn joint_input_jacobian(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::InputJacobian) {
            HOLE_joint_input_jacobian
        }";
    let jacobians = if has_jacobian { jacobians } else { "" };
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for {name}<T> {{
            type Joints = [T; {n_state}];
            type Rates = [T; {n_rates}];
            type Solution = [T; {n_solution}];
            type Jacobian = {jacobian};
            type InputJacobian = {input_jacobian};
            fn joint_buffers(&self) -> gyro_sim::JointBuffers<Self> {{
                gyro_sim::JointBuffers {{
                    rates: [T::constant(0.0); {n_rates}],
                    solution: [T::constant(0.0); {n_solution}],
                    jacobian: {no_slopes},
                    input_jacobian: {no_input_slopes}
                }}
            }}
            fn joint_start(&self) -> Self::Joints {{ HOLE_joint_start }}
            fn joint_accelerations(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Rates) {{
                HOLE_joint_accelerations
            }}
            fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {{ HOLE_joint_derivative }}
            fn to_maximal(&self, ANY_t: T, ANY_x: &Self::Joints, y: &mut Self::State) {{ HOLE_to_maximal }}
            fn to_joints(&self, ANY_t: T, ANY_y: &Self::State, x: &mut Self::Joints) {{ HOLE_to_joints }}
            {}
            {}
            {}
            {jacobians}
        }}",
        fillings(&[("joint_accelerations_at", "Rates"), ("corrected_accelerations", "Velocities")]),
        multipliers("corrected_multipliers", "Velocities"),
        fillings(&[("corrected_solution", "Solution")]),
    )
}

/// Numbers of all outputs: name, suffix, unit.
fn columns(model: &Model) -> Vec<(&str, &'static str, &'static str)> {
    let of = |output: &'_ gyro_model::Output| output.kind.columns().to_vec();
    let outputs = model.outputs.iter();
    outputs.flat_map(|o| of(o).into_iter().map(|(suffix, unit)| (o.name.as_str(), suffix, unit))).collect()
}
