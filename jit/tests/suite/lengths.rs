//! Nothing that is computed of a joint state depends on the lengths of its Euler parameters, but their own rates, which
//! are in proportion to them. The lengths change by powers of two, which no operation rounds: all bits stay.

use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions};
use gyro_jit::Compiled;
use gyro_model::Model;
use gyro_sim::{
    Control, Dop853, DynamicsDerivatives, Frames, InverseDynamics, Joint, JointJacobian, JointOutputs,
    JointSpace, Kutta4, MassMatrix, Mechanism, OutputDerivatives, ParameterJacobian, Regressor, Rodas4,
    Solver, Tsit5,
};
use rand::{RngExt, SeedableRng};

/// What a function gives.
struct Found {
    name: &'static str,
    numbers: Vec<f64>,
    /// Whether its rows are those of a joint state, and its columns, as many as here, derivatives by one.
    rows_of_state: bool,
    columns: Option<usize>,
}

/// All functions of a joint state.
fn all(m: &Compiled<f64>, x: &Vec<f64>, u_dot: &Vec<f64>) -> Vec<Found> {
    let mut found = Vec::new();
    let mut add = |name, numbers: Vec<f64>, rows_of_state, columns| {
        found.push(Found { name, numbers, rows_of_state, columns });
    };
    let joint = m.joint_buffers();
    let filled = |mut out: Vec<f64>, fill: &dyn Fn(&mut Vec<f64>)| {
        if !out.is_empty() {
            fill(&mut out);
        }
        out
    };
    let t = 0.3;
    add(
        "joint_accelerations",
        filled(joint.rates.clone(), &|out| m.joint_accelerations(t, x, out)),
        false,
        None,
    );
    add("joint_derivative", filled(x.clone(), &|out| m.joint_derivative(t, x, out)), true, None);
    let y = filled(m.start(), &|out| m.to_maximal(t, x, out));
    let energy = m.energy(t, &y);
    add("energy", vec![energy.kinetic, energy.potential], false, None);
    add("outputs", filled(m.buffers().outputs, &|out| m.outputs(t, &y, out)), false, None);
    add("to_maximal", y, false, None);
    add("loop_closure", filled(joint.closure.clone(), &|out| m.loop_closure(t, x, out)), false, None);
    add("closure_distances", filled(joint.closure, &|out| m.closure_distances(t, x, out)), false, None);
    let mut closed = x.clone();
    if !m.joint_layout().closure_rows.is_empty() {
        m.close_positions(t, &mut closed);
        m.close_velocities(t, &mut closed);
    }
    add("close", closed, true, None);
    let mut jacobian = m.jacobian_buffers();
    if m.has_jacobian() {
        let mut by_time = x.clone();
        m.joint_jacobian(t, x, &mut jacobian.jacobian, &mut by_time);
        m.joint_input_jacobian(t, x, &mut jacobian.input_jacobian);
        add("joint_jacobian", jacobian.jacobian, true, Some(x.len()));
        add("joint_jacobian by time", by_time, true, None);
        add("joint_input_jacobian", jacobian.input_jacobian, true, None);
        let by_parameters = filled(m.parameter_buffer(), &|out| m.joint_parameter_jacobian(t, x, out));
        add("joint_parameter_jacobian", by_parameters, true, None);
    }
    add("joint_outputs", filled(m.buffers().outputs, &|out| m.joint_outputs(t, x, out)), false, None);
    let slopes = m.output_slopes();
    let n = m.joint_layout().n_coordinates() + m.joint_layout().n_rates();
    add(
        "outputs_by_state",
        filled(slopes.by_state, &|out| m.outputs_by_state(t, x, u_dot, out)),
        false,
        Some(n),
    );
    let by = filled(slopes.by_accelerations, &|out| m.outputs_by_accelerations(t, x, u_dot, out));
    add("outputs_by_accelerations", by, false, None);
    add(
        "outputs_by_inputs",
        filled(slopes.by_inputs, &|out| m.outputs_by_inputs(t, x, u_dot, out)),
        false,
        None,
    );
    let by = filled(slopes.by_parameters, &|out| m.outputs_by_parameters(t, x, u_dot, out));
    add("outputs_by_parameters", by, false, None);
    let frames = m.frame_buffers();
    add("frame_jacobians", filled(frames.jacobians, &|out| m.frame_jacobians(t, x, out)), false, None);
    add("frame_biases", filled(frames.biases, &|out| m.frame_biases(t, x, out)), false, None);
    if m.joint_layout().closure_rows.is_empty() {
        let rates = || joint.rates.clone();
        add("inverse_dynamics", filled(rates(), &|out| m.inverse_dynamics(t, x, u_dot, out)), false, None);
        add("bias_forces", filled(rates(), &|out| m.bias_forces(t, x, out)), false, None);
        add("gravity_forces", filled(rates(), &|out| m.gravity_forces(t, x, out)), false, None);
        add("mass_matrix", filled(m.mass_buffer(), &|out| m.mass_matrix(t, x, out)), false, None);
        add("mass_factor", filled(m.mass_buffer(), &|out| m.mass_factor(t, x, out)), false, None);
        let inverse = filled(m.inverse_buffer(), &|out| m.inverse_derivatives(t, x, u_dot, out));
        add("inverse_derivatives", inverse, false, None);
        let forward = filled(m.forward_buffer(), &|out| m.forward_derivatives(t, x, out));
        add("forward_derivatives", forward, false, None);
        add("regressor", filled(m.regressor_buffer(), &|out| m.regressor(t, x, u_dot, out)), false, None);
    }
    found
}

/// How many functions of a model were compared; none if it has no Euler parameters in joint coordinates.
fn check(name: &str, model: &Model, functions: &Functions, seed: u64) -> usize {
    let m = gyro_jit::compile::<f64>(model, functions, Effort::Quick).expect("a mechanism");
    let layout = *m.joint_layout();
    let mut dice = ChaCha8Rng::seed_from_u64(seed);
    let (mut x, mut factors) = (m.joint_start(), vec![1.0; m.joint_start().len()]);
    let n_motion = layout.n_coordinates() + layout.n_rates();
    x[..n_motion].iter_mut().for_each(|x| *x += dice.random_range(-0.3..0.3));
    let u_dot: Vec<f64> = (0..layout.n_rates()).map(|_| dice.random_range(-1.0..1.0)).collect();
    let mut at = 0;
    for place in layout.places {
        if let Some(euler) = place.euler() {
            let factor = 2.0_f64.powi(if dice.random_bool(0.5) { 3 } else { -2 });
            factors[at + euler..at + euler + 4].fill(factor);
        }
        at += place.n_coordinates();
    }
    if factors.iter().all(|factor| *factor == 1.0) {
        return 0;
    }
    let longer: Vec<f64> = x.iter().zip(&factors).map(|(x, factor)| x * factor).collect();
    let (one, other) = (all(&m, &x, &u_dot), all(&m, &longer, &u_dot));
    for (one, other) in one.iter().zip(&other) {
        for (place, (a, b)) in one.numbers.iter().zip(&other.numbers).enumerate() {
            let n_columns = match one.columns {
                Some(n) => n,
                None if one.rows_of_state => one.numbers.len() / x.len(),
                None => 1,
            };
            let row = if one.rows_of_state { factors[place / n_columns.max(1)] } else { 1.0 };
            let column = one.columns.map_or(1.0, |n| factors[place % n]);
            let expected = a * row / column;
            let is_same = *b == expected || (b.is_nan() && expected.is_nan());
            assert!(is_same, "{name}: {} [{place}]: {b:e} instead of {expected:e}", one.name);
        }
    }
    one.iter().filter(|found| found.numbers.iter().any(|x| x.is_finite() && *x != 0.0)).count()
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn lengths_of_euler_parameters_mean_nothing() {
    let functions = Functions::all();
    let (mut n_models, mut n_functions) = (0, 0);
    let n_pages = std::env::var("GYRO_PAGES").map_or(24, |n| n.parse().expect("a number of pages"));
    for seed in 40_000..40_000 + n_pages {
        let text = gyro_pages::page(seed);
        let model =
            gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a correct model file");
        let compared = check(&format!("model file {seed}"), &model, &functions, seed);
        (n_models, n_functions) = (n_models + u64::from(compared > 0), n_functions + compared);
    }
    println!("{n_models} models, {n_functions} functions");
    assert!(n_models > n_pages / 4 && n_functions > 8 * n_models as usize, "{n_models} {n_functions}");
}

/// A symmetric top that spins about a point of its own axis, in steady precession: heavy-top of `models`, at 200 rad/s.
const TOP: &str = r#"
format = 1
name = "top"
gravity = [0, 0, -9.81]
[[body]]
name = "ground"
fixed = true
[[body]]
name = "top"
mass = 0.5
inertia = [3e-4, 3e-4, 5e-4]
[[joint]]
name = "tip"
kind = "spherical"
first = { body = "ground" }
second = { body = "top", point = [0, 0, -0.04] }
orientation = [3, 1, 0, 0]
rate = [0, 1.198258752558553310933, 200]
"#;

/// A free body that turns about its middle axis.
const SPINNER: &str = r#"
format = 1
name = "spinner"
[[body]]
name = "sat"
free = true
mass = 1
inertia = [0.1, 0.2, 0.25]
angular_velocity = [1, 60, 2]
[[output]]
name = "tip"
kind = "pose"
body = "sat"
point = [1, 0, 0]
"#;

fn compiled(text: &str) -> Compiled<f64> {
    let model = gyro_model::read("scene", text).unwrap_or_else(|error| panic!("{error}"));
    gyro_jit::compile(&model, &Functions::of_solvers(), Effort::Quick).expect("a mechanism")
}

/// By how much the length of Euler parameters at the start of the joint state differs from one.
fn excess(p: &[f64]) -> f64 {
    (p.iter().map(|e| e * e).sum::<f64>().sqrt() - 1.0).abs()
}

fn energy(m: &Compiled<f64>, x: &Vec<f64>) -> f64 {
    let mut y = m.start();
    m.to_maximal(0.0, x, &mut y);
    m.energy(0.0, &y).total()
}

/// The drift of energy that a Runge–Kutta step of order 4 has where A(p/|p|) is the rotation: 4.35e-5 in 1000 s, by a
/// program of its own; here a fiftieth of the time.
#[test]
fn a_top_keeps_its_energy_and_its_length() {
    let (top, seconds) = (compiled(TOP), 20.0);
    let start = top.joint_start();
    let mut rk4 = Solver::new(Joint, Kutta4::new(&start), 0.0, &start);
    rk4.advance(&top, 1e-3, 20_000).expect("a smooth motion");
    let drift = (energy(&top, rk4.state()) / energy(&top, &start) - 1.0).abs();
    let expected = 4.35e-5 * seconds / 1000.0;
    println!("{drift:e} of {expected:e}");
    assert!(drift < 1.3 * expected && drift > 0.7 * expected, "{drift:e} instead of {expected:e}");
    assert!(excess(&rk4.state()[..4]) < 1e-15);
    let mut tsit5 = Solver::new(Joint, Tsit5::new(&start), 0.0, &start).with_control(Control {
        relative: 1e-6,
        absolute: 1e-6,
        ..Control::default()
    });
    tsit5.advance_to(&top, seconds).expect("a smooth motion");
    let drift = (energy(&top, tsit5.state()) / energy(&top, &start) - 1.0).abs();
    println!("{drift:e} by tsit5");
    assert!(excess(&tsit5.state()[..4]) < 1e-15);
}

#[test]
fn the_tip_of_a_spinner_stays_where_it_is() {
    let spinner = compiled(SPINNER);
    let start = spinner.joint_start();
    let mut rk4 = Solver::new(Joint, Kutta4::new(&start), 0.0, &start);
    let (mut y, mut outputs) = (spinner.start(), spinner.buffers().outputs);
    for _ in 0..100 {
        rk4.advance(&spinner, 5e-3, 100).expect("a smooth motion");
        spinner.to_maximal(0.0, rk4.state(), &mut y);
        spinner.outputs(0.0, &y, &mut outputs);
        let away = (0..3).map(|k| (outputs[k] - y[k]).powi(2)).sum::<f64>().sqrt();
        assert!((away - 1.0).abs() < 1e-14, "{away}");
    }
}

/// A run by steps of a length.
type Make<'m> = &'m dyn Fn(f64) -> Vec<f64>;

/// All methods keep their order, from a start of any length.
#[test]
fn methods_keep_their_order() {
    let top = compiled(TOP);
    let mut start = top.joint_start();
    start[..4].iter_mut().for_each(|e| *e *= 3.0);
    let t_end = 0.064;
    let n = |h: f64| (t_end / h).round() as u32;
    let by_rk4 = |h: f64| {
        let mut solver = Solver::new(Joint, Kutta4::new(&start), 0.0, &start);
        solver.advance(&top, h, n(h)).expect("a smooth motion");
        solver.state().clone()
    };
    let by_tsit5 = |h: f64| {
        let mut solver = Solver::new(Joint, Tsit5::new(&start), 0.0, &start);
        solver.advance(&top, h, n(h)).expect("a smooth motion");
        solver.state().clone()
    };
    let by_dop853 = |h: f64| {
        let mut solver = Solver::new(Joint, Dop853::new(&start), 0.0, &start);
        solver.advance(&top, h, n(h)).expect("a smooth motion");
        solver.state().clone()
    };
    let by_rodas4 = |h: f64| {
        let jacobian = top.jacobian_buffers().jacobian;
        let mut solver = Solver::new(Joint, Rodas4::new(&start, jacobian), 0.0, &start);
        solver.advance(&top, h, n(h)).expect("a smooth motion");
        solver.state().clone()
    };
    let truth = by_dop853(2.5e-4);
    let error = |x: &[f64]| x[..4].iter().zip(&truth).fold(0.0, |e: f64, (a, b)| e.max((a - b).abs()));
    let methods: [(&str, i32, f64, Make<'_>); 4] = [
        ("rk4", 4, 1e-3, &by_rk4),
        ("tsit5", 5, 1e-3, &by_tsit5),
        ("dop853", 8, 4e-3, &by_dop853),
        ("rodas4", 4, 1e-3, &by_rodas4),
    ];
    for (name, order, h, make) in methods {
        let [coarse, fine] = [h, 0.5 * h].map(|h| error(&make(h)));
        let found = (coarse / fine).log2();
        println!("{name}: {coarse:e} {fine:e}, order {found}");
        assert!(fine > 1e-13 && found > f64::from(order) - 0.4, "{name}: order {found}, {fine:e}");
    }
}
