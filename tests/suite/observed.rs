//! Outputs and frames of a joint state against the outputs that the dense runtime-assembled model has at its maximal
//! state.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_jit::Compiled;
use gyro_sim::{Description, Frames, JointOutputs, JointPlace, JointSpace, Mechanism, OutputDerivatives};
use gyro_sim_suite::{Engine, Random, compiled, dense, model};

const STATES: usize = 200;

/// Relative to the largest number: 3e-14 is seen of outputs, which have reactions among them, and 9e-16 of Jacobians.
const OUTPUTS: f64 = 1e-11;
const FRAMES: f64 = 1e-13;

/// A joint state, its Euler parameters unit vectors; the work is left at zero.
fn random_state<M: JointOutputs<Scalar = f64>>(mechanism: &M, random: &mut Random) -> M::Joints {
    let layout = mechanism.joint_layout();
    let mut x = Vec::new();
    for place in layout.places {
        match place {
            JointPlace::Scalar { .. } | JointPlace::Turn { .. } | JointPlace::State { .. } => {
                x.push(3.0 * random.signed())
            }
            JointPlace::Orientation { .. } => x.extend(random.unit()),
            JointPlace::Body { .. } => {
                x.extend(random.vector(1.0));
                x.extend(random.unit());
            }
        }
    }
    x.extend((0..layout.n_rates()).map(|_| 3.0 * random.signed()));
    let mut state = mechanism.joint_start();
    state.as_mut()[..x.len()].copy_from_slice(&x);
    state
}

/// The numbers of an output.
fn of<'o>(description: &Description<'_>, outputs: &'o [f64], name: &str) -> &'o [f64] {
    let mut places = (0..outputs.len()).filter(|&k| description.outputs[k].name == name);
    let (first, n) = (places.next().expect("an output of this name"), 1 + places.count());
    &outputs[first..first + n]
}

fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = found.iter().chain(expected).fold(f64::MIN_POSITIVE, |largest, x| x.abs().max(largest));
    found.iter().zip(expected).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / largest
}

/// What the runtime-assembled model gives at the maximal state.
fn at<M: JointOutputs<Scalar = f64>>(mechanism: &M, dense: &Engine, t: f64, x: &M::Joints) -> Vec<f64> {
    let mut y = mechanism.start();
    mechanism.to_maximal(t, x, &mut y);
    let mut outputs = dense.buffers().outputs;
    dense.outputs(t, &y.as_ref().to_vec(), &mut outputs);
    outputs
}

#[test]
fn outputs_and_frames_of_a_joint_state_are_those_of_its_maximal_state() {
    let (mut mechanism, model, mut random) =
        (compiled::<f64>("manipulator"), model("manipulator"), Random::new(11));
    assert_eq!(mechanism.frame_names(), ["palm", "fingertip"]);
    let n_x = mechanism.joint_layout().n_coordinates();
    let n_u = mechanism.joint_layout().n_rates();
    let (mut worst_output, mut worst_jacobian, mut worst_bias) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..STATES {
        let (t, torque) = (random.signed(), random.signed());
        let mut dense = dense(&model);
        assert!(mechanism.set_input(0, torque) && dense.set_input(0, torque));
        let x = random_state(&mechanism, &mut random);
        let expected = at(&mechanism, &dense, t, &x);
        let mut outputs = mechanism.buffers().outputs;
        mechanism.joint_outputs(t, &x, &mut outputs);
        worst_output = worst_output.max(difference(outputs.as_ref(), &expected));

        let mut buffers = mechanism.frame_buffers();
        mechanism.frame_jacobians(t, &x, &mut buffers.jacobians);
        mechanism.frame_biases(t, &x, &mut buffers.biases);
        let mut rates = mechanism.joint_buffers().rates;
        mechanism.joint_accelerations(t, &x, &mut rates);
        let frames = buffers.jacobians.chunks(6 * n_u).zip(buffers.biases.chunks(6));
        for (name, (jacobian, bias)) in mechanism.frame_names().iter().zip(frames) {
            // Velocities are linear in the rates.
            for rate in 0..n_u {
                let mut faster = x.clone();
                faster[n_x + rate] += 1.0;
                let faster = at(&mechanism, &dense, t, &faster);
                let [faster, slower] =
                    [&faster, &expected].map(|outputs| of(dense.description(), outputs, name));
                let column: Vec<f64> = faster.iter().zip(slower).map(|(a, b)| a - b).collect();
                let found: Vec<f64> = jacobian.iter().skip(rate).step_by(n_u).copied().collect();
                let scale = slower.iter().fold(1.0, |largest: f64, x| x.abs().max(largest));
                let off = found.iter().zip(&column).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
                worst_jacobian = worst_jacobian.max(off / scale);
            }
            let row = |row: usize| {
                let along = &jacobian[row * n_u..][..n_u];
                bias[row] + along.iter().zip(&rates).map(|(a, b)| a * b).sum::<f64>()
            };
            let found: Vec<f64> = (0..6).map(row).collect();
            let name = format!("{name}_acceleration");
            worst_bias = worst_bias.max(difference(&found, of(dense.description(), &expected, &name)));
        }
    }
    println!("outputs {worst_output:.1e}, J {worst_jacobian:.1e}, J u\u{307} + b {worst_bias:.1e}");
    assert!(worst_output < OUTPUTS && worst_jacobian < FRAMES && worst_bias < OUTPUTS);
}

/// Five points; the error is the fourth power of the step times a fifth derivative.
fn slope(step: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * step));
    (0..a.len()).map(|k| (a[k] - d[k] + 8.0 * (c[k] - b[k])) / (12.0 * step)).collect()
}

const STEP: f64 = 1e-3;

/// Relative to the largest output: 1e-10 is seen.
const SLOPES: f64 = 1e-8;

#[test]
fn derivatives_of_outputs_are_their_differences() {
    let (mut mechanism, mut random) = (compiled::<f64>("manipulator"), Random::new(12));
    let n_x = mechanism.joint_layout().n_coordinates();
    let n = n_x + mechanism.joint_layout().n_rates();
    let accelerations = |mechanism: &Compiled<f64>, t: f64, x: &_| {
        let mut rates = mechanism.joint_buffers().rates;
        mechanism.joint_accelerations(t, x, &mut rates);
        rates
    };
    let outputs = |mechanism: &Compiled<f64>, t: f64, x: &_| {
        let mut outputs = mechanism.buffers().outputs;
        mechanism.joint_outputs(t, x, &mut outputs);
        outputs.to_vec()
    };
    let mut worst = 0.0_f64;
    for _ in 0..20 {
        let t = random.signed();
        let (torque, payload) = (random.signed(), 1.0 + 0.3 * random.signed());
        assert!(mechanism.set_input(0, torque) && mechanism.set_parameter(0, payload));
        let x = random_state(&mechanism, &mut random);
        let (rates, mut slopes) = (accelerations(&mechanism, t, &x), mechanism.output_slopes());
        mechanism.outputs_by_state(t, &x, &rates, &mut slopes.by_state);
        mechanism.outputs_by_accelerations(t, &x, &rates, &mut slopes.by_accelerations);
        mechanism.outputs_by_inputs(t, &x, &rates, &mut slopes.by_inputs);
        mechanism.outputs_by_parameters(t, &x, &rates, &mut slopes.by_parameters);
        let size = outputs(&mechanism, t, &x).iter().fold(1.0, |largest: f64, x| x.abs().max(largest));
        // A column, and what comes through the accelerations.
        let mut hold = |(column, n, k): (&[f64], usize, usize), of_rates: &[f64], differences: &[f64]| {
            for (row, by_rates) in slopes.by_accelerations.chunks(of_rates.len()).enumerate() {
                let through: f64 = by_rates.iter().zip(of_rates).map(|(a, b)| a * b).sum();
                worst = worst.max((column[row * n + k] + through - differences[row]).abs() / size);
            }
        };
        for k in 0..n {
            let at = |h: f64| {
                let mut moved = x.clone();
                moved[k] += h;
                moved
            };
            let of_rates = slope(STEP, |h| accelerations(&mechanism, t, &at(h)).to_vec());
            let differences = slope(STEP, |h| outputs(&mechanism, t, &at(h)));
            hold((&slopes.by_state, n, k), &of_rates, &differences);
        }
        let with_input = |h: f64| {
            let mut other = mechanism.clone();
            assert!(other.set_input(0, torque + h));
            other
        };
        let of_rates = slope(STEP, |h| accelerations(&with_input(h), t, &x).to_vec());
        let differences = slope(STEP, |h| outputs(&with_input(h), t, &x));
        hold((&slopes.by_inputs, 1, 0), &of_rates, &differences);
        let with_payload = |h: f64| {
            let mut other = mechanism.clone();
            assert!(other.set_parameter(0, payload + h));
            other
        };
        let of_rates = slope(STEP, |h| accelerations(&with_payload(h), t, &x).to_vec());
        let differences = slope(STEP, |h| outputs(&with_payload(h), t, &x));
        hold((&slopes.by_parameters, 1, 0), &of_rates, &differences);
    }
    println!("derivatives of outputs {worst:.1e}");
    assert!(worst < SLOPES, "{worst:.1e}");
}
