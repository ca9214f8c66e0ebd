//! Linearisation: A, B, C and D against differences of the motion, of open and of closed mechanisms, and of a
//! reference.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::DoubleWishbone;
use gyro_runner::Input;
use gyro_runner::motion::{COLUMNS, Element, MotionBuilder, OperatingPoint, Tree, TreeWithJacobian};
use gyro_sim::{CloseLoops, Dual, JointLayout, JointPlace, JointSpace, Mechanism, Partition};
use gyro_sim_suite::{Random, compiled, interpreted};

/// Central differences of fourth order.
fn slope(step: f64, f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * step));
    (0..a.len()).map(|k| (8.0 * (c[k] - b[k]) - (d[k] - a[k])) / (12.0 * step)).collect()
}

/// What an element of the linearised state is of (x, u) near x₀, and of its derivative likewise: both are linear.
fn element(layout: &JointLayout<'_>, x0: &[f64], of: Element, x: &[f64]) -> f64 {
    let place = match of {
        Element::Position { place, .. } | Element::Turn { place, .. } | Element::Rate { place, .. } => place,
    };
    let before = || layout.places.iter().take_while(|other| **other != place);
    let from: usize = before().map(|place| place.n_coordinates()).sum();
    match of {
        Element::Position { component, .. } => x[from + component],
        Element::Turn { component, .. } => {
            let lengths = if matches!(place, JointPlace::Body { .. }) { 3 } else { 0 };
            let [p, q] = [x0, x].map(|x| <[f64; 4]>::try_from(&x[from + lengths..][..4]).unwrap());
            let vector = [
                p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2],
                p[0] * q[2] - p[2] * q[0] - p[3] * q[1] + p[1] * q[3],
                p[0] * q[3] - p[3] * q[0] - p[1] * q[2] + p[2] * q[1],
            ];
            2.0 * vector[component]
        }
        Element::Rate { component, .. } => {
            let rates: usize = before().map(|place| place.n_rates()).sum();
            x[layout.n_coordinates() + rates + component]
        }
    }
}

/// How far A, B, C and D are off differences of the motion from states nearby: of the largest of each.
fn check<M>(page: &str, shipped: &M, builder: &dyn MotionBuilder<M>)
where
    M: Partition<Scalar = f64> + JointSpace + Clone,
{
    let mut random = Random::new(11);
    let (layout, n_inputs) = (shipped.joint_layout(), shipped.description().inputs.len());
    let mut worst = [0.0_f64; 2];
    for case in 0..4 {
        let mut mechanism = shipped.clone();
        let mut x = random_state(&mechanism, &mut random);
        // Assembled at its start, closed by a driver only then.
        let t = if layout.closure_rows.is_empty() { random.signed() } else { 0.0 };
        CloseLoops::new(&mechanism).correct(&mechanism, t, &mut x).unwrap();
        let inputs: Vec<Input> = (0..n_inputs).map(|index| Input::constant(index, random.signed())).collect();
        for input in &inputs {
            mechanism.set_input(input.index, input.at(t));
        }
        let (mut y, angles) = (mechanism.start(), angles(&mechanism, &x));
        mechanism.to_maximal(t, &x, &mut y);
        let at = OperatingPoint { t, y: &y, angles: &angles, inputs: &inputs };
        let linear = builder.linearise(&mechanism, &at).expect("it has joint coordinates");
        // The state may have been told by other Euler parameters, of the other sign.
        let mut x0 = x.clone();
        mechanism.to_joints(t, &y, &mut x0);
        let of = |mechanism: &M, x: &M::Joints| {
            let (mut dx, mut y, mut outputs) = (x.clone(), mechanism.start(), mechanism.buffers().outputs);
            mechanism.joint_derivative(t, x, &mut dx);
            mechanism.to_maximal(t, x, &mut y);
            mechanism.outputs(t, &y, &mut outputs);
            let [z, dz] = [x, &dx].map(|x| {
                let element = |e: &Element| element(layout, x0.as_ref(), *e, x.as_ref());
                linear.elements.iter().take(linear.state.len()).map(element).collect::<Vec<_>>()
            });
            [z, dz, outputs.as_ref().to_vec()].concat()
        };
        let n = linear.state.len();
        let mut compare = |along: &[f64], n_columns: usize, matrices: [&[f64]; 2], slopes: &[f64]| {
            for (which, matrix) in matrices.into_iter().enumerate() {
                let expected = if which == 0 { &slopes[n..2 * n] } else { &slopes[2 * n..] };
                let found = (0..expected.len()).map(|row| {
                    let row = &matrix[row * n_columns..][..n_columns];
                    row.iter().zip(along).map(|(a, b)| a * b).sum::<f64>()
                });
                let largest =
                    expected.iter().chain(matrix).fold(1e-3, |largest: f64, x| largest.max(x.abs()));
                let error = found.zip(expected).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max);
                worst[which] = worst[which].max(error);
                assert!(error < 1e-6, "{page}, state {case}, matrix {which}: off by {error:e}");
            }
        };
        for _ in 0..4 {
            let direction: Vec<f64> = x.as_ref().iter().map(|_| random.signed()).collect();
            let slopes = slope(1e-3, |step| {
                let mut moved = x0.clone();
                moved.as_mut().iter_mut().zip(&direction).for_each(|(x, d)| *x += step * d);
                CloseLoops::new(&mechanism).correct(&mechanism, t, &mut moved).unwrap();
                of(&mechanism, &moved)
            });
            compare(&slopes[..n], n, [&linear.by_state, &linear.outputs_by_state], &slopes);
        }
        let direction: Vec<f64> = inputs.iter().map(|_| random.signed()).collect();
        let slopes = slope(1.0, |step| {
            let mut moved = mechanism.clone();
            for (input, direction) in inputs.iter().zip(&direction) {
                moved.set_input(input.index, input.at(t) + step * direction);
            }
            of(&moved, &x0)
        });
        compare(&direction, n_inputs, [&linear.by_inputs, &linear.outputs_by_inputs], &slopes);
    }
    println!("{page}: A and B off by {:.1e}, C and D by {:.1e}", worst[0], worst[1]);
}

/// Of any rates; of an open mechanism in any pose, of a closed one in that of its start.
fn random_state<M: JointSpace<Scalar = f64>>(mechanism: &M, random: &mut Random) -> M::Joints {
    let (layout, mut state) = (mechanism.joint_layout(), mechanism.joint_start());
    let (x, u) = state.as_mut().split_at_mut(layout.n_coordinates());
    u[..layout.n_rates()].iter_mut().for_each(|u| *u = 3.0 * random.signed());
    if layout.closure_rows.is_empty() {
        let mut rest = x;
        for place in layout.places {
            let (own, others) = rest.split_at_mut(place.n_coordinates());
            let n_lengths = own.len() % 4;
            own[..n_lengths].iter_mut().for_each(|x| *x = random.signed());
            if own.len() > n_lengths {
                own[n_lengths..].copy_from_slice(&random.unit());
            }
            rest = others;
        }
    }
    state
}

/// The angle of each coordinate, joint after joint, as far as it stands in the state.
fn angles<M: JointSpace<Scalar = f64>>(mechanism: &M, x: &M::Joints) -> Vec<f64> {
    let joints = mechanism.description().joints;
    let mut angles = vec![0.0; joints.iter().map(|joint| joint.coordinates.len()).sum()];
    let mut from = 0;
    for place in mechanism.joint_layout().places {
        if let JointPlace::Scalar { joint, coordinate } = *place {
            let before: usize = joints[..usize::from(joint)].iter().map(|j| j.coordinates.len()).sum();
            angles[before + usize::from(coordinate)] = x.as_ref()[from];
        }
        from += place.n_coordinates();
    }
    angles
}

#[test]
fn linearisations_are_limits_of_differences() {
    check("motor", &compiled("motor"), &TreeWithJacobian(interpreted::<Dual<f64, COLUMNS>>("motor")));
    for page in [
        "motor",
        "pendulum",
        "carried",
        "double-wishbone",
        "stewart-platform",
        "carried-four-bar",
        "driven-four-bar",
    ] {
        check(page, &compiled(page), &Tree(interpreted::<Dual<f64, COLUMNS>>(page)));
    }
}

/// A and C of the wishbone against differences of its reference, which shares nothing with the generator. The start is
/// no equilibrium, so A depends on which coordinates are independent: what it says of the reference's motion counts.
#[test]
fn the_wishbone_s_linearisation_is_that_of_its_reference() {
    let page = "double-wishbone";
    let (mechanism, builder) = (compiled::<f64>(page), Tree(interpreted::<Dual<f64, COLUMNS>>(page)));
    let (y, reference) = (mechanism.start(), DoubleWishbone::default());
    let start = [reference.height, reference.angle, 0.0, 0.0];
    let outputs = mechanism.description().outputs;
    let shown = ["wheel.rx", "wheel.ry", "wheel.rz"].map(|name| {
        let is_named = |o: &gyro_sim::OutputInfo<'_>| format!("{}.{}", o.name, o.suffix) == name;
        outputs.iter().position(is_named).unwrap()
    });
    let energies: Vec<usize> = (0..outputs.len()).filter(|&k| outputs[k].name == "energy").collect();
    let linear = builder
        .linearise(&mechanism, &OperatingPoint { t: 0.0, y: &y, angles: &[], inputs: &[] })
        .expect("it has joint coordinates");
    let joint = |element: &Element| match *element {
        Element::Position { place: JointPlace::Scalar { joint, .. }, .. } => Some(usize::from(joint)),
        _ => None,
    };
    let independent: Vec<usize> = linear.elements.iter().filter_map(joint).collect();
    assert_eq!(independent.len(), 2, "{linear:?}");
    for along in 0..4 {
        let slopes = slope(1e-3, |step| {
            let mut state = start;
            state[along] += step;
            let at = reference.instant(state);
            let part = |k: usize| independent.iter().map(move |&joint| at.joints[joint][k]);
            let motion = part(0).chain(part(1)).chain(part(1)).chain(part(2));
            motion.chain(at.wheel).chain([at.energy]).collect()
        });
        let (z, rest) = slopes.split_at(4);
        let (dz, read) = rest.split_at(4);
        let times = |matrix: &[f64], row: usize| -> f64 {
            matrix[4 * row..][..4].iter().zip(z).map(|(a, b)| a * b).sum()
        };
        let compare = |what: &str, found: f64, expected: f64| {
            let error = (found - expected).abs() / expected.abs().max(1.0);
            println!("along {along}, {what}: {found} for {expected}");
            assert!(error < 1e-8, "along {along}, {what}: {found} for {expected}");
        };
        (0..4).for_each(|row| compare("rate", times(&linear.by_state, row), dz[row]));
        for (&row, &expected) in shown.iter().zip(read) {
            compare("wheel", times(&linear.outputs_by_state, row), expected);
        }
        let energy = energies.iter().map(|&row| times(&linear.outputs_by_state, row)).sum();
        compare("energy", energy, read[3]);
    }
}
