//! Outputs and frames of a joint state against the outputs that the dense runtime-assembled model has at its maximal
//! state.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_sim::{Description, Frames, JointOutputs, JointPlace, Mechanism};
use gyro_sim_suite::generated::manipulator::Manipulator;
use gyro_sim_suite::{Engine, Random, dense, model};

const STATES: usize = 200;

/// Relative to the largest number: 3e-13 is seen of outputs, which have reactions among them, and 4e-15 of frames.
const OUTPUTS: f64 = 1e-11;
const FRAMES: f64 = 1e-13;

/// A joint state, its Euler parameters unit vectors; the work is left at zero.
fn random_state<M: JointOutputs<Scalar = f64>>(mechanism: &M, random: &mut Random) -> M::Joints {
    let layout = mechanism.joint_layout();
    let mut x = Vec::new();
    for place in layout.places {
        match place {
            JointPlace::Scalar { .. } => x.push(3.0 * random.signed()),
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
        (Manipulator::<f64>::default(), model("manipulator"), Random::new(11));
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
                let mut faster = x;
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
