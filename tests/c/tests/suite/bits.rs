//! Exported C computes the bits of the Rust that it was written from: functions at random states, and trajectories.

use crate::target::{Program, Target};
use chacha20::ChaCha8Rng;
use gyro_c_tests as modules;
use gyro_export::Precision;
use gyro_sim::integrate::Method;
use gyro_sim::{
    CloseLoops, Control, CorrectedDynamics, Dop853, Dynamics, Error, Joint, JointJacobian, JointSpace,
    Kutta4, Mechanism, Real, Rodas4, Solver, Tsit5,
};
use rand::{RngExt, SeedableRng};
use std::io::Write;
use std::process::Stdio;

/// A number type of C.
trait Number: Real {
    const PRECISION: Precision;
    fn bytes(self) -> Vec<u8>;
    fn of_bytes(bytes: &[u8]) -> Self;
}

impl Number for f64 {
    const PRECISION: Precision = Precision::F64;
    fn bytes(self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }
    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_le_bytes(bytes.try_into().expect("eight bytes"))
    }
}

impl Number for f32 {
    const PRECISION: Precision = Precision::F32;
    fn bytes(self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }
    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_le_bytes(bytes.try_into().expect("four bytes"))
    }
}

fn numbers<T: Number>(numbers: &[f64]) -> Vec<T> {
    numbers.iter().map(|x| T::constant(*x)).collect()
}

/// The program of a mechanism; none where there is nothing to compare.
fn program<T: Number>(target: Target, page: &str) -> Option<Program> {
    if gyro_sim::fused::IS_FUSED {
        eprintln!("skipped: this build fuses products and sums, unlike the feature `deterministic`");
        return None;
    }
    target.program(page, T::PRECISION)
}

/// What the program writes.
fn told<T: Number>(program: &Program, argument: &str, numbers: &[T]) -> Vec<T> {
    let mut child = program
        .command(argument)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.bytes()).collect();
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("it reads all");
    assert!(output.status.success(), "{argument}: {:?}", output.status);
    output.stdout.chunks_exact(size_of::<T>()).map(T::of_bytes).collect()
}

fn same<T: Number>(what: &str, rust: &[T], c: &[T]) {
    assert_eq!(rust.len(), c.len(), "{what}: how many numbers");
    for (n, (rust, c)) in rust.iter().zip(c).enumerate() {
        let is_same = rust.bytes() == c.bytes() || rust.to_f64().is_nan() && c.to_f64().is_nan();
        assert!(is_same, "{what}: number {n} is {rust:?} in Rust and {c:?} in C");
    }
}

/// Functions at random states, near the constraints or not.
fn kernels<T, M>(program: &Program, mechanism: &M, set: &[T])
where
    T: Number,
    M: Dynamics<Scalar = T> + CorrectedDynamics + JointSpace,
{
    const STATES: usize = 20;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut given, mut expected) = ([set, &[T::constant(STATES as f64)]].concat(), Vec::new());
    for _ in 0..STATES {
        let mut between = |low: f64, high: f64| T::constant(random.random_range(low..high));
        let t = between(0.0, 2.0);
        let (mut y, mut x) = (mechanism.start(), mechanism.joint_start());
        for number in y.as_mut().iter_mut().chain(x.as_mut()) {
            *number = *number + between(-0.5, 0.5);
        }
        given.push(t);
        given.extend(y.as_ref().iter().chain(x.as_ref()));
        let (mut rates, mut dx) = (mechanism.joint_buffers().rates, x.clone());
        mechanism.joint_accelerations(t, &x, &mut rates);
        mechanism.joint_derivative(t, &x, &mut dx);
        expected.extend(rates.as_ref().iter().chain(dx.as_ref()));
        let mut maximal = y.clone();
        mechanism.to_maximal(t, &x, &mut maximal);
        dx.as_mut().fill(T::constant(0.0));
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

type Running<T, M, A> = Solver<Joint, <M as JointSpace>::Joints, T, A, CloseLoops<M>>;

fn run<T, M, A>(
    program: &Program,
    mechanism: &M,
    set: &[T],
    (method, run): (A, Run),
    advance: impl Fn(&mut Running<T, M, A>, &M) -> Result<(), Error>,
) where
    T: Number,
    M: JointSpace<Scalar = T>,
    A: Method<Joint, M>,
{
    let mut x = mechanism.joint_start();
    let control = Control::default().with_tolerance(T::constant(run.tolerance).to_f64());
    let loops = CloseLoops::new(mechanism);
    let k = T::constant;
    let mut solver = Solver::with_correction(Joint, method, loops, k(0.0), &x).with_control(control);
    let (mut expected, mut sample, mut outcome) = (Vec::new(), 0.0, Ok(()));
    while outcome.is_ok() && sample < run.samples {
        let at = k(run.end) * (k(sample) + k(1.0)) / k(run.samples);
        if solver.time() >= at {
            outcome = solver.interpolate(mechanism, at, &mut x);
            expected.extend(x.as_ref());
            sample += 1.0;
        } else {
            outcome = advance(&mut solver, mechanism);
        }
    }
    expected.push(k(status(&outcome)));
    expected.extend(solver.state().as_ref());
    let statistics = solver.statistics();
    let counts = [statistics.accepted, statistics.rejected, statistics.work.evaluations, statistics.leaps];
    expected.extend(counts.map(|count| k(count as f64)));
    let given = [set, &[run.tolerance, run.end, run.steps, run.samples].map(k)].concat();
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
fn trajectories<T, M>(program: &Program, mechanism: &M, set: &[T])
where
    T: Number,
    M: JointSpace<Scalar = T>,
{
    let x = mechanism.joint_start();
    let fixed = Run { method: "0", tolerance: 1e-8, end: 1.0, steps: 1000.0, samples: 50.0 };
    run(program, mechanism, set, (Kutta4::new(&x), fixed), |solver, m| {
        solver.step(m, T::constant(1.0) / T::constant(1000.0))
    });
    for tolerance in [1e-5, if T::PRECISION == Precision::F64 { 1e-9 } else { 1e-6 }] {
        let controlled = Run { method: "1", tolerance, end: 1.0, steps: 0.0, samples: 50.0 };
        run(program, mechanism, set, (Tsit5::new(&x), controlled), |solver, m| {
            solver.step_towards(m, T::constant(1.0))
        });
        let controlled = Run { method: "2", ..controlled };
        run(program, mechanism, set, (Dop853::new(&x), controlled), |solver, m| {
            solver.step_towards(m, T::constant(1.0))
        });
    }
}

/// The same by the implicit method.
fn implicit<T, M>(program: &Program, mechanism: &M, set: &[T])
where
    T: Number,
    M: JointJacobian<Scalar = T>,
{
    let x = mechanism.joint_start();
    let method = Rodas4::new(&x, mechanism.jacobian_buffers().jacobian);
    let controlled = Run { method: "3", tolerance: 1e-5, end: 1.0, steps: 0.0, samples: 50.0 };
    run(program, mechanism, set, (method, controlled), |solver, m| solver.step_towards(m, T::constant(1.0)));
}

/// The tests of a mechanism: its page, its type and number type, what is set, and what besides is compared.
macro_rules! mechanism {
    ($name:ident, $module:ident::$ty:ident<$number:ty>, $page:expr, $parameters:expr, $inputs:expr $(, $more:ident)*) => {
        mod $name {
            use super::*;

            fn check(target: Target) {
                let Some(program) = program::<$number>(target, $page) else { return };
                let mut mechanism = modules::$module::$ty::<$number>::default();
                let (parameters, inputs) = (numbers(&$parameters), numbers(&$inputs));
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

            #[test]
            fn here() {
                check(Target::Here);
            }

            #[test]
            #[ignore = "needs the tools of embedded/setup.sh"]
            fn on_a_cortex_m7() {
                check(Target::CortexM7);
            }

            #[test]
            #[ignore = "needs the tools of embedded/setup.sh"]
            fn in_webassembly() {
                check(Target::WebAssembly);
            }
        }
    };
}

const NONE: [f64; 0] = [];

mechanism!(a_tree, gyroscope::Gyroscope<f64>, "models/gyroscope.toml", NONE, NONE, implicit);
mechanism!(
    driven,
    driven_gyroscope::DrivenGyroscope<f64>,
    "models/driven-gyroscope.toml",
    NONE,
    NONE,
    implicit
);
mechanism!(a_loop, four_bar::FourBar<f64>, "models/four-bar.toml", NONE, NONE, implicit);
mechanism!(a_loop_in_f32, four_bar::FourBar<f32>, "models/four-bar.toml", NONE, NONE, implicit);
mechanism!(tables, cam::Cam<f64>, "tests/models/cam.toml", NONE, NONE);
mechanism!(electric, electric::Electric<f64>, "tests/models/electric.toml", [1.75], [0.4], implicit);
mechanism!(curves, curves::Curves<f64>, "tests/models/curves.toml", NONE, NONE, implicit);
mechanism!(curves_in_f32, curves::Curves<f32>, "tests/models/curves.toml", NONE, NONE, implicit);
mechanism!(tables_in_f32, cam::Cam<f32>, "tests/models/cam.toml", NONE, NONE);
mechanism!(
    parameters,
    gyroscope_parameters::GyroscopeParameters<f64>,
    "models/gyroscope-parameters.toml",
    [9.5, 0.09, 0.0002, 2.5e-6, 1.25e-6],
    NONE,
    implicit
);
mechanism!(stiff, gyroscope_stiff::GyroscopeStiff<f64>, "models/gyroscope-stiff.toml", NONE, NONE, implicit);
mechanism!(inputs, arm::Arm<f64>, "examples/arm/arm.toml", [1.25], [0.75], implicit);
mechanism!(inputs_in_f32, arm::Arm<f32>, "examples/arm/arm.toml", [1.25], [0.75], implicit);
mechanism!(
    motor_and_spring,
    cart::Cart<f64>,
    concat!(env!("OUT_DIR"), "/cart.toml"),
    [44.0, 0.45, 0.42],
    [1.5],
    implicit
);
mechanism!(
    motors,
    robot_arm::RobotArm<f64>,
    concat!(env!("OUT_DIR"), "/robot_arm.toml"),
    [0.3, 0.42, 0.33],
    [2.5, -0.75],
    implicit
);
