//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a body may
//! leave unread as `ANY_name`.

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
        ode(model, type_name),
        mechanism(model, type_name, joints.is_some()),
        partition(model, type_name, has.choice, joints),
        equations(model, type_name),
        projection(type_name),
        joints.map(|joints| joint_space(model, type_name, joints)).unwrap_or_default(),
        joints
            .filter(|_| has.jacobian)
            .map(|joints| joint_jacobian(model, type_name, joints))
            .unwrap_or_default(),
        ports(model, type_name),
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

fn ode(model: &Model, name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Ode for {name}<T> {{
            type Scalar = T;
            type State = [T; {}];
            fn start(&self) -> Self::State {{ HOLE_start }}
            fn derivative(&self, ANY_t: T, ANY_y: &Self::State, dy: &mut Self::State) {{ HOLE_derivative }}
        }}",
        n_state(model)
    )
}

/// A function that gives a buffer of zeros, one for each pair.
fn buffers(pairs: &[(&str, &str, &str)]) -> String {
    lines(pairs.iter().map(|(function, ty, count)| {
        format!("fn {function}(&self) -> Self::{ty} {{ [T::constant(0.0); {count}] }}")
    }))
}

/// A function that fills `out`, for each pair of name and type.
fn fillings(pairs: &[(&str, &str)]) -> String {
    lines(pairs.iter().map(|(function, ty)| {
        format!(
            "fn {function}(&self, ANY_t: T, ANY_y: &Self::State, ANY_out: &mut Self::{ty}) {{ HOLE_{function} }}"
        )
    }))
}

/// A function that gives an entry of a table by its index, or something else beyond its end.
fn lookup(signature: &str, argument: &str, entry: &str, entries: &[String], otherwise: &str) -> String {
    let table = signature.rsplit(' ').next().unwrap_or_default().to_owned();
    let function = signature.trim_end_matches(&table);
    format!(
        "{function} {{
            const {table}: [{entry}; {}] = [{}];
            {table}.get({argument}).copied().{otherwise}
        }}",
        entries.len(),
        list(entries),
    )
}

fn name_lookup(function: &str, argument: &str, table: &str, entries: &[&String]) -> String {
    let entries: Vec<_> = entries.iter().map(|name| format!("{name:?}")).collect();
    let signature = format!("fn {function}(&self, {argument}: usize) -> &str {table}");
    lookup(&signature, argument, "&str", &entries, "unwrap_or_default()")
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
    if turns.is_empty() {
        return String::new();
    }
    format!("fn turn_references(&self) -> &[u16] {{ &[{}] }}", list(places))
}

fn mechanism(model: &Model, name: &str, is_tree: bool) -> String {
    let corrected = "fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
        HOLE_corrected_derivative
    }";
    let corrected = if is_tree { corrected } else { "" };
    let (n, n_rows) = (model.coordinate_bodies().len(), model.rows().len());
    let [rows, constraints, readings] = [n_rows, n_rows + n, n_readings(model)].map(|n| n.to_string());
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for {name}<T> {{
            type Rows = [T; {rows}];
            type Constraints = [T; {constraints}];
            type Readings = [T; {readings}];
            {}
            {corrected}
            {}
            fn energy(&self, ANY_t: T, ANY_y: &Self::State) -> gyro_sim::Energy<T> {{ HOLE_energy }}
            {}
            {}
        }}",
        buffers(&[
            ("rows", "Rows", &rows),
            ("constraints", "Constraints", &constraints),
            ("readings", "Readings", &readings)
        ]),
        fillings(&[("phi", "Constraints"), ("velocity_residual", "Rows")]),
        fillings(&[("read_joints", "Readings")]),
        descriptions(model),
    )
}

/// Names, rows and sizes.
fn descriptions(model: &Model) -> String {
    let slots = model.coordinate_bodies();
    let bodies: Vec<_> = slots.iter().map(|&b| &model.bodies[b].name).collect();
    let couplers: Vec<_> = model.couplers.iter().map(|c| &c.name).collect();
    let drivers: Vec<_> = model.drivers.iter().map(|d| &d.name).collect();
    let joint = |name: &str, coordinates: &str| {
        format!("gyro_sim::JointInfo {{ name: {name:?}, coordinates: &[{coordinates}] }}")
    };
    let joints: Vec<_> = model.joints.iter().map(|j| joint(&j.name, &coordinates(j.kind))).collect();
    let row = |owner: &str, is_length: bool| {
        format!("gyro_sim::RowInfo {{ owner: {owner}, is_length: {is_length} }}")
    };
    let rows = model.rows();
    let rows: Vec<_> = rows.iter().map(|r| row(&owner(model, r.owner), r.unit == RowUnit::Length)).collect();
    let work = if model.has_work() {
        format!("fn work(&self, y: &Self::State) -> T {{ y[{}] }}", 13 * slots.len())
    } else {
        "fn work(&self, _y: &Self::State) -> T { T::constant(0.0) }".to_owned()
    };
    format!(
        "{}
        fn n_bodies(&self) -> usize {{ {} }}
        fn n_joints(&self) -> usize {{ {} }}
        {} {} {} {} {}
        fn size(&self) -> T {{ T::constant({:?}) }}
        {work}",
        turn_references(model),
        slots.len(),
        model.joints.len(),
        name_lookup("body_name", "body", "BODIES", &bodies),
        lookup(
            "fn joint(&self, joint: usize) -> gyro_sim::JointInfo<'_> JOINTS",
            "joint",
            "gyro_sim::JointInfo<'static>",
            &joints,
            &format!("unwrap_or({})", joint("", "")),
        ),
        name_lookup("coupler_name", "coupler", "COUPLERS", &couplers),
        name_lookup("driver_name", "driver", "DRIVERS", &drivers),
        lookup(
            "fn row(&self, row: usize) -> gyro_sim::RowInfo ROWS",
            "row",
            "gyro_sim::RowInfo",
            &rows,
            &format!("unwrap_or({})", row("gyro_sim::Owner::Body(0)", false)),
        ),
        model.size(),
    )
}

fn partition(model: &Model, name: &str, choice: Choice, joints: Option<&JointLayout>) -> String {
    match choice {
        Choice::Charts => by_charts(name),
        Choice::Pivoting => by_pivoting(model, name, joints),
    }
}

const SOLVED: &str = "::core::result::Result<(), gyro_sim::Error>";

fn by_charts(name: &str) -> String {
    let solves = ["newton_step", "solve_velocities"];
    let unrolled = lines(solves.map(|solve| {
        format!(
            "fn {solve}_on(&self, ANY_t: T, ANY_charts: &Self::Vectors, ANY_y: &mut Self::State) {{ HOLE_{solve} }}"
        )
    }));
    let chosen = lines(solves.map(|solve| {
        format!(
            "fn {solve}(&self, t: T, choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                gyro_sim::Charted::{solve}_on(self, t, &gyro_sim::charts::one_hot(choice), y);
                Ok(())
            }}"
        )
    }));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Charted for {name}<T> {{
            type Vectors = [[T; 4]; INT_charts];
            fn chart_vectors(&self, ANY_y: &Self::State) -> Self::Vectors {{ HOLE_chart_vectors }}
            {unrolled}
        }}
        impl<T: gyro_sim::Real> gyro_sim::Partition for {name}<T> {{
            type Independent = gyro_sim::charts::Charts<INT_charts>;
            fn independent(&self, _t: T, y: &Self::State) -> Self::Independent {{
                gyro_sim::charts::best(&gyro_sim::Charted::chart_vectors(self, y))
            }}
            fn follow(&self, _t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {{
                gyro_sim::charts::follow(&gyro_sim::Charted::chart_vectors(self, y), choice)
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
        }}",
        buffers(&[
            ("velocities", "Velocities", &velocities),
            ("phi_q_values", "PhiQ", "INT_phi_q"),
            ("phi_pi_values", "PhiPi", "INT_phi_pi"),
            ("accelerations_buffer", "Accelerations", "INT_accelerations"),
        ]),
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

fn projection(name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Projection for {name}<T> {{
            fn project(
                &self, ANY_t: T, ANY_y: &Self::State, ANY_rows: &Self::Rows, ANY_out: &mut Self::Velocities,
            ) {{ HOLE_project }}
        }}"
    )
}

fn joint_space(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n_solution = 6 * model.coordinate_bodies().len() + model.rows().len();
    let (n_state, n_rates) = (joints.n_state(), joints.n_rates);
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for {name}<T> {{
            type Joints = [T; {n_state}];
            type Rates = [T; {n_rates}];
            type Solution = [T; {n_solution}];
            fn joint_start(&self) -> Self::Joints {{ HOLE_joint_start }}
            {}
            fn joint_accelerations(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Rates) {{
                HOLE_joint_accelerations
            }}
            fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {{ HOLE_joint_derivative }}
            fn to_maximal(&self, ANY_t: T, ANY_x: &Self::Joints, y: &mut Self::State) {{ HOLE_to_maximal }}
            fn to_joints(&self, ANY_t: T, ANY_y: &Self::State, x: &mut Self::Joints) {{ HOLE_to_joints }}
            {}
            {}
            {}
        }}",
        buffers(&[
            ("rates", "Rates", &n_rates.to_string()),
            ("solution", "Solution", &n_solution.to_string()),
        ]),
        fillings(&[("joint_accelerations_at", "Rates"), ("corrected_accelerations", "Velocities")]),
        multipliers("corrected_multipliers", "Velocities"),
        fillings(&[("corrected_solution", "Solution")]),
    )
}

fn joint_jacobian(model: &Model, name: &str, joints: &JointLayout) -> String {
    let (n_state, n_inputs) = (joints.n_state().pow(2), joints.n_state() * model.inputs.len());
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointJacobian for {name}<T> {{
            type Jacobian = [T; {n_state}];
            type InputJacobian = [T; {n_inputs}];
            {}
            fn joint_jacobian(
                &self, ANY_t: T, ANY_x: &Self::Joints, dfdx: &mut Self::Jacobian, dfdt: &mut Self::Joints,
            ) {{
                HOLE_joint_jacobian
            }}
            fn joint_input_jacobian(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::InputJacobian) {{
                HOLE_joint_input_jacobian
            }}
        }}",
        buffers(&[
            ("joint_jacobian_buffer", "Jacobian", &n_state.to_string()),
            ("input_jacobian_buffer", "InputJacobian", &n_inputs.to_string()),
        ]),
    )
}

/// Numbers of all outputs: name, suffix, unit.
fn columns(model: &Model) -> Vec<(&str, &'static str, &'static str)> {
    let of = |output: &'_ gyro_model::Output| output.kind.columns().to_vec();
    let outputs = model.outputs.iter();
    outputs.flat_map(|o| of(o).into_iter().map(|(suffix, unit)| (o.name.as_str(), suffix, unit))).collect()
}

fn ports(model: &Model, name: &str) -> String {
    let info = |(name, suffix, unit): (&str, &str, &str)| {
        format!("gyro_sim::OutputInfo {{ name: {name:?}, suffix: {suffix:?}, unit: {unit:?} }}")
    };
    let infos: Vec<_> = columns(model).into_iter().map(info).collect();
    let inputs: Vec<_> = model.inputs.iter().map(|input| &input.name).collect();
    let count = infos.len().to_string();
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Ports for {name}<T> {{
            type Outputs = [T; {count}];
            {} {}
            fn n_outputs(&self) -> usize {{ {count} }}
            {}
            fn n_inputs(&self) -> usize {{ {} }}
            {} {}
        }}",
        buffers(&[("outputs_buffer", "Outputs", &count)]),
        fillings(&[("outputs", "Outputs")]),
        lookup(
            "fn output(&self, index: usize) -> gyro_sim::OutputInfo<'_> OUTPUTS",
            "index",
            "gyro_sim::OutputInfo<'static>",
            &infos,
            &format!("unwrap_or({})", info(("", "", ""))),
        ),
        inputs.len(),
        name_lookup("input_name", "index", "INPUTS", &inputs),
        setter("fn set_input", &model.inputs, ("self", "", "")),
    )
}
