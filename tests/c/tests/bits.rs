//! Exported C computes the bits of the Rust that it was written from: functions at random states, and trajectories.

use gyro_c_tests as modules;
use gyro_export::Precision;
use gyro_sim::integrate::Method;
use gyro_sim::{
    CloseLoops, Control, CorrectedDynamics, Dop853, Dynamics, Error, Joint, JointJacobian, JointSpace,
    Kutta4, Mechanism, Rodas4, Solver, Tsit5,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

/// Of gcc and clang alike.
const FLAGS: [&str; 8] =
    ["-std=c99", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror"];

/// A mechanism as a program in C; none without a C compiler.
fn program(page: &str, precision: Precision) -> Option<PathBuf> {
    if gyro_sim::fused::IS_FUSED {
        eprintln!("skipped: this build fuses products and sums, unlike the feature `deterministic`");
        return None;
    }
    let path = Path::new("../..").join(page);
    let text = fs::read_to_string(&path).expect("a model file");
    let mut load = |table: &str| fs::read_to_string(path.with_file_name(table)).map_err(|e| e.to_string());
    let model = gyro_model::read_with(page, &text, &mut load).expect("no mistakes");
    let functions = match &model.functions {
        Some(names) => gyro_codegen::Functions::named(names.iter().map(String::as_str)).expect("known"),
        None => gyro_codegen::Functions::of_solvers(),
    };
    let module = gyro_codegen::generate_functions(page, &model, &functions).expect("a module");
    let exported = gyro_export::c(&model, &module.code, precision).expect("C");
    let name = if precision == Precision::F64 { model.name.clone() } else { format!("{}_f32", model.name) };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder");
    let own = |text: &str| {
        let text = text.replace("const gyro *", "const \u{1} *").replace("static gyro m", "static \u{1} m");
        let upper = format!("{}_", model.name.to_uppercase());
        let text = text.replace("gyro.h", "\u{1}.h").replace("GYRO_", &upper);
        text.replace("gyro_", &format!("{}_", model.name)).replace('\u{1}', &model.name)
    };
    let files = [
        (format!("{}.h", model.name), exported.header),
        (format!("{}.c", model.name), exported.source),
        ("driver.c".to_owned(), own(include_str!("driver.c"))),
    ];
    for (file, text) in &files {
        fs::write(folder.join(file), text).expect("a file");
    }
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let mut command = Command::new(compiler);
    command.current_dir(&folder).args(FLAGS).args([&files[1].0, "driver.c", "-o", "program", "-lm"]);
    match command.output() {
        Ok(output) => {
            let words = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{page}: the C compiler says\n{words}");
            Some(folder.join("program"))
        }
        Err(error) => {
            eprintln!("skipped: there is no C compiler: {error}");
            None
        }
    }
}

/// What the program writes.
fn told(program: &Path, argument: &str, numbers: &[f64]) -> Vec<f64> {
    let mut child = Command::new(program)
        .arg(argument)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("it reads all");
    assert!(output.status.success(), "{argument}: {:?}", output.status);
    output.stdout.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect()
}

fn same(what: &str, rust: &[f64], c: &[f64]) {
    assert_eq!(rust.len(), c.len(), "{what}: how many numbers");
    for (n, (rust, c)) in rust.iter().zip(c).enumerate() {
        let is_same = rust.to_bits() == c.to_bits() || rust.is_nan() && c.is_nan();
        assert!(is_same, "{what}: number {n} is {rust:e} in Rust and {c:e} in C");
    }
}

/// Functions at random states, near the constraints or not.
fn kernels<M>(program: &Path, mechanism: &M, set: &[f64])
where
    M: Dynamics<Scalar = f64> + CorrectedDynamics + JointSpace,
{
    const STATES: usize = 20;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut given, mut expected) = ([set, &[STATES as f64]].concat(), Vec::new());
    for _ in 0..STATES {
        let t = random.random_range(0.0..2.0);
        let (mut y, mut x) = (mechanism.start(), mechanism.joint_start());
        for number in y.as_mut().iter_mut().chain(x.as_mut()) {
            *number += random.random_range(-0.5..0.5);
        }
        given.push(t);
        given.extend(y.as_ref().iter().chain(x.as_ref()));
        let (mut rates, mut dx) = (mechanism.joint_buffers().rates, x.clone());
        mechanism.joint_accelerations(t, &x, &mut rates);
        mechanism.joint_derivative(t, &x, &mut dx);
        expected.extend(rates.as_ref().iter().chain(dx.as_ref()));
        let mut maximal = y.clone();
        mechanism.to_maximal(t, &x, &mut maximal);
        dx.as_mut().fill(0.0);
        mechanism.to_joints(t, &y, &mut dx);
        let energy = mechanism.energy(t, &y);
        expected.extend(maximal.as_ref().iter().chain(dx.as_ref()));
        expected.extend([energy.kinetic, energy.potential]);
        let mut buffers = mechanism.buffers();
        mechanism.outputs(t, &y, &mut buffers.outputs);
        mechanism.phi(t, &y, &mut buffers.constraints);
        mechanism.velocity_residual(t, &y, &mut buffers.rows);
        mechanism.read_joints(t, &y, &mut buffers.readings);
        expected.extend(buffers.outputs.as_ref());
        expected.extend(buffers.constraints.as_ref());
        expected.extend(buffers.rows.as_ref());
        expected.extend(buffers.readings.as_ref());
        mechanism.derivative(t, &y, &mut maximal);
        expected.extend(maximal.as_ref());
        mechanism.corrected_derivative(t, &y, &mut maximal);
        expected.extend(maximal.as_ref());
    }
    same("functions", &expected, &told(program, "kernels", &given));
}

/// How a run is asked for.
#[derive(Clone, Copy)]
struct Run {
    method: &'static str,
    tolerance: f64,
    end: f64,
    /// Steps of fixed length; none under error control.
    steps: f64,
    samples: f64,
}

type Running<M, A> = Solver<Joint, <M as JointSpace>::Joints, f64, A, CloseLoops<M>>;

fn run<M, A>(
    program: &Path,
    mechanism: &M,
    set: &[f64],
    (method, run): (A, Run),
    advance: impl Fn(&mut Running<M, A>, &M) -> Result<(), Error>,
) where
    M: JointSpace<Scalar = f64>,
    A: Method<Joint, M>,
{
    let mut x = mechanism.joint_start();
    let control = Control::default().with_tolerance(run.tolerance);
    let loops = CloseLoops::new(mechanism);
    let mut solver = Solver::with_correction(Joint, method, loops, 0.0, &x).with_control(control);
    let (mut expected, mut sample, mut outcome) = (Vec::new(), 0.0, Ok(()));
    while outcome.is_ok() && sample < run.samples {
        let at = run.end * (sample + 1.0) / run.samples;
        if solver.time() >= at {
            outcome = solver.interpolate(mechanism, at, &mut x);
            expected.extend(x.as_ref());
            sample += 1.0;
        } else {
            outcome = advance(&mut solver, mechanism);
        }
    }
    expected.push(status(&outcome));
    expected.extend(solver.state().as_ref());
    let statistics = solver.statistics();
    let counts = [statistics.accepted, statistics.rejected, statistics.work.evaluations, statistics.leaps];
    expected.extend(counts.map(|count| count as f64));
    let given = [set, &[run.tolerance, run.end, run.steps, run.samples]].concat();
    let what = format!("method {} at {:e}", run.method, run.tolerance);
    same(&what, &expected, &told(program, run.method, &given));
}

/// The number of what came of a run, as the header has it.
fn status(outcome: &Result<(), Error>) -> f64 {
    match outcome {
        Ok(()) => 0.0,
        Err(Error::NotFinite { .. }) => 1.0,
        Err(Error::NoConvergence { .. }) => 2.0,
        Err(Error::Singular { .. }) => 3.0,
        Err(Error::Jump { .. }) => 4.0,
        Err(Error::StepTooShort { .. }) => 5.0,
        Err(Error::TooManySteps { .. }) => 6.0,
        Err(Error::Stiff { .. }) => 7.0,
        Err(Error::Setting { .. }) => 8.0,
        Err(Error::InvalidEndTime { .. }) => 9.0,
        Err(Error::Tolerance { .. }) => 10.0,
    }
}

/// One second in 50 samples: by steps of fixed length and under error control.
fn trajectories<M>(program: &Path, mechanism: &M, set: &[f64])
where
    M: JointSpace<Scalar = f64>,
{
    let x = mechanism.joint_start();
    let fixed = Run { method: "0", tolerance: 1e-8, end: 1.0, steps: 1000.0, samples: 50.0 };
    run(program, mechanism, set, (Kutta4::new(&x), fixed), |solver, m| solver.step(m, 1.0 / 1000.0));
    for tolerance in [1e-5, 1e-9] {
        let controlled = Run { method: "1", tolerance, end: 1.0, steps: 0.0, samples: 50.0 };
        run(program, mechanism, set, (Tsit5::new(&x), controlled), |solver, m| solver.step_towards(m, 1.0));
        let controlled = Run { method: "2", ..controlled };
        run(program, mechanism, set, (Dop853::new(&x), controlled), |solver, m| solver.step_towards(m, 1.0));
    }
}

/// The same by the implicit method.
fn implicit<M>(program: &Path, mechanism: &M, set: &[f64])
where
    M: JointJacobian<Scalar = f64>,
{
    let x = mechanism.joint_start();
    let method = Rodas4::new(&x, mechanism.jacobian_buffers().jacobian);
    let controlled = Run { method: "3", tolerance: 1e-7, end: 1.0, steps: 0.0, samples: 50.0 };
    run(program, mechanism, set, (method, controlled), |solver, m| solver.step_towards(m, 1.0));
}

/// One test for a mechanism: its page, its type, what is set, and what besides is compared.
macro_rules! mechanism {
    ($name:ident, $ty:ident, $page:literal, [$($parameter:expr),*], [$($input:expr),*] $(, $more:ident)*) => {
        #[test]
        fn $name() {
            let Some(program) = program($page, Precision::F64) else { return };
            let mut mechanism = modules::$name::$ty::<f64>::default();
            let (parameters, inputs): (&[f64], &[f64]) = (&[$($parameter),*], &[$($input),*]);
            for (place, value) in parameters.iter().enumerate() {
                assert!(mechanism.set_parameter(place, *value));
            }
            for (place, value) in inputs.iter().enumerate() {
                assert!(mechanism.set_input(place, *value));
            }
            let set = [parameters, inputs].concat();
            kernels(&program, &mechanism, &set);
            trajectories(&program, &mechanism, &set);
            $($more(&program, &mechanism, &set);)*
        }
    };
}

mechanism!(gyroscope, Gyroscope, "models/gyroscope.toml", [], [], implicit);
mechanism!(driven_gyroscope, DrivenGyroscope, "models/driven-gyroscope.toml", [], [], implicit);
mechanism!(four_bar, FourBar, "models/four-bar.toml", [], [], implicit);
mechanism!(cam, Cam, "tests/models/cam.toml", [], []);
mechanism!(
    gyroscope_parameters,
    GyroscopeParameters,
    "models/gyroscope-parameters.toml",
    [9.5, 0.09, 0.0002, 2.5e-6, 1.25e-6],
    [],
    implicit
);
mechanism!(gyroscope_stiff, GyroscopeStiff, "models/gyroscope-stiff.toml", [], [], implicit);
mechanism!(arm, Arm, "examples/arm/arm.toml", [1.25], [0.75], implicit);
mechanism!(cart_pendulum, CartPendulum, "examples/cart-pendulum/cart-pendulum.toml", [44.0], [], implicit);
