//! Chains against the laws they must obey, and against the gyroscope's own equations.

use gyro_reference::{
    BaseMotion, BodyState, Chain, ChainSample, DoubleDouble, Gyroscope, Link, Sinusoid, moving_base,
};

/// Step of the numerical derivatives, s; of eighth order, they err by the ninth derivative times its eighth
/// power.
const STEP: f64 = 1e-4;

/// Coefficients of f(t ± k STEP) in the derivative of eighth order.
const STENCIL: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Rounding of samples over the step, relative to the largest term.
const DIFFERENCE: f64 = 1e-10;

type Vector = [f64; 3];

fn wave(amplitude: f64, angular_frequency: f64, phase: f64) -> Sinusoid {
    Sinusoid { amplitude, angular_frequency, phase }
}

/// Every term of the equations in one chain: skew axes, offsets and inertias, turning and sliding, springs
/// and dampers, and a base that turns about two axes and moves along three.
fn everything() -> Chain<3> {
    let base = BaseMotion {
        translation: [wave(0.1, 3.0, 0.4), wave(0.2, 5.0, 0.0), wave(-0.3, 7.0, 1.0)],
        rotations: vec![([1.0, 0.0, 0.0], wave(0.7, 2.0, 0.2)), ([0.0, 1.0, 2.0], wave(0.9, 3.0, -0.5))],
    };
    let first = Link {
        before: [0.1, -0.2, 0.3],
        own: [-0.3, 0.1, 0.2],
        mass: 1.5,
        inertia: [0.3, 0.25, 0.2, 0.02, -0.03, 0.01],
        damping: 0.2,
        rate: 2.0,
        ..Link::turning([1.0, 2.0, -1.0])
    };
    let second = Link {
        before: [0.4, 0.1, -0.1],
        own: [0.05, -0.2, 0.1],
        mass: 0.7,
        inertia: [0.02, 0.03, 0.025, 0.001, 0.002, -0.003],
        stiffness: 200.0,
        free: 0.05,
        damping: 0.4,
        start: 0.1,
        rate: -0.5,
        ..Link::sliding([0.0, 1.0, 1.0])
    };
    let third = Link {
        before: [-0.1, 0.3, 0.2],
        own: [0.1, 0.2, -0.1],
        mass: 0.4,
        inertia: [0.01, 0.012, 0.02, -0.002, 0.001, 0.0],
        stiffness: 0.8,
        free: -0.3,
        start: 0.5,
        rate: 12.0,
        ..Link::turning([1.0, 0.0, 0.0])
    };
    Chain { gravity: [1.0, -9.0, 3.0], base, links: [first, second, third] }
}

/// Samples at `t` and at four steps to either side, ascending.
fn around<const N: usize>(chain: &Chain<N>, t: f64) -> [ChainSample<N>; 9] {
    let times: Vec<f64> = (-4..=4).map(|k| t + f64::from(k) * STEP).collect();
    chain.solve(&times).try_into().expect("nine times")
}

fn slope<const N: usize, const M: usize>(
    samples: &[ChainSample<N>; 9],
    value: impl Fn(&ChainSample<N>) -> [f64; M],
) -> [f64; M] {
    std::array::from_fn(|i| {
        let step = (samples[8].t - samples[0].t) / 8.0;
        let pairs = STENCIL
            .iter()
            .zip(1..)
            .map(|(coefficient, k)| coefficient * (value(&samples[4 + k])[i] - value(&samples[4 - k])[i]));
        pairs.sum::<f64>() / step
    })
}

fn assert_near<const M: usize>(found: [f64; M], expected: [f64; M], scale: f64, what: &str) {
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() < DIFFERENCE * scale, "{what}: {found:?} but {expected:?}");
    }
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn times(a: &[Vector; 3], v: Vector) -> Vector {
    a.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn tensor_times([xx, yy, zz, xy, xz, yz]: [f64; 6], v: Vector) -> Vector {
    times(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], v)
}

/// Momentum and angular momentum about the origin of `links` from `k` outwards.
fn momenta<const N: usize>(chain: &Chain<N>, sample: &ChainSample<N>, k: usize) -> [f64; 6] {
    let parts = chain.links[k..].iter().zip(&sample.bodies[k..]).map(|(link, body)| {
        let linear = body.velocity.map(|x| link.mass * x);
        let own = times(&body.rotation, tensor_times(link.inertia, body.angular_velocity));
        (linear, add(cross(body.position, linear), own))
    });
    let zero = [0.0; 3];
    let (linear, angular) = parts.fold((zero, zero), |sum, part| (add(sum.0, part.0), add(sum.1, part.1)));
    [linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]]
}

/// Weight of the links from `k` outwards and its moment about the origin, plus what joint `k` exerts with its
/// spring and damper.
fn loads<const N: usize>(
    chain: &Chain<N>,
    sample: &ChainSample<N>,
    k: usize,
    parent: &[Vector; 3],
) -> [f64; 6] {
    let link = &chain.links[k];
    let size = link.axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along = -link.stiffness * (sample.positions[k] - link.free) - link.damping * sample.rates[k];
    let applied = times(parent, link.axis.map(|x| along * x / size));
    let reaction = &sample.reactions[k];
    let (mut force, mut torque) = (times(parent, reaction.force), times(parent, reaction.torque));
    match link.freedom {
        gyro_reference::Freedom::Turn => torque = add(torque, applied),
        gyro_reference::Freedom::Slide => force = add(force, applied),
    }
    let body = &sample.bodies[k];
    let joint = add(body.position, times(&body.rotation, link.own));
    torque = add(torque, cross(joint, force));
    for (link, body) in chain.links[k..].iter().zip(&sample.bodies[k..]) {
        let weight = chain.gravity.map(|x| link.mass * x);
        (force, torque) = (add(force, weight), add(torque, cross(body.position, weight)));
    }
    [force[0], force[1], force[2], torque[0], torque[1], torque[2]]
}

fn largest<const M: usize>(values: [f64; M]) -> f64 {
    values.iter().fold(1e-12, |largest, x| x.abs().max(largest))
}

/// Newton's and Euler's laws for every part of the chain that a joint carries, with derivatives taken
/// numerically: all that a mistake in the equations of motion or in a reaction would break.
fn check_momenta(chain: &Chain<3>, samples: &[ChainSample<3>; 9]) {
    let here = &samples[4];
    for k in 1..3 {
        let expected = loads(chain, here, k, &here.bodies[k - 1].rotation);
        let found = slope(samples, |sample| momenta(chain, sample, k));
        let scale = largest(expected).max(largest(momenta(chain, here, k)) * 100.0);
        assert_near(found, expected, scale, &format!("momentum from link {k} at {}", here.t));
    }
}

/// Velocities and angular velocities are the derivatives of positions and rotation matrices.
fn check_kinematics(samples: &[ChainSample<3>; 9]) {
    let rotated = |body: &BodyState, v: Vector| times(&body.rotation, v);
    for k in 0..3 {
        let body = samples[4].bodies[k];
        let velocity = slope(samples, |sample| sample.bodies[k].position);
        assert_near(velocity, body.velocity, 10.0, "velocity");
        for v in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            let turning = slope(samples, |sample| rotated(&sample.bodies[k], v));
            assert_near(turning, rotated(&body, cross(body.angular_velocity, v)), 100.0, "turning");
        }
    }
    assert_near(slope(samples, |sample| sample.positions), samples[4].rates, 100.0, "rates");
    assert_near(slope(samples, |sample| sample.rates), samples[4].accelerations, 1e4, "accelerations");
}

/// A sensor reads the acceleration of its own point, less gravity, in its own frame; and the base's power is
/// its work's rate.
fn check_sensor(chain: &Chain<3>, samples: &[ChainSample<3>; 9]) {
    let point = [0.2, -0.3, 0.1];
    let here = &samples[4];
    let velocity = |sample: &ChainSample<3>| {
        let body = &sample.bodies[2];
        add(body.velocity, times(&body.rotation, cross(body.angular_velocity, point)))
    };
    let reading = chain.inertial_reading(here, 2, point);
    let felt = add(times(&here.bodies[2].rotation, reading.specific_force), chain.gravity);
    assert_near(felt, slope(samples, velocity), 1e4, "specific force");
    assert_eq!(reading.angular_rate, here.bodies[2].angular_velocity);
    assert_near(slope(samples, |sample| [sample.base_work]), [here.base_power], 10.0, "power");
}

/// The reaction has no part along the coordinate: the equation of motion.
fn check_free_axes(chain: &Chain<3>, sample: &ChainSample<3>) {
    for (link, reaction) in chain.links.iter().zip(&sample.reactions) {
        let along = match link.freedom {
            gyro_reference::Freedom::Turn => reaction.torque,
            gyro_reference::Freedom::Slide => reaction.force,
        };
        let part: f64 = along.iter().zip(link.axis).map(|(a, b)| a * b).sum();
        let size = largest(reaction.force) + largest(reaction.torque);
        assert!(part.abs() < 1e-14 * size, "{part:e} of {reaction:?}");
    }
}

fn check_laws(chain: &Chain<3>, t: f64) {
    let samples = around(chain, t);
    check_kinematics(&samples);
    check_momenta(chain, &samples);
    check_sensor(chain, &samples);
    check_free_axes(chain, &samples[4]);
}

#[test]
fn laws_of_motion_hold_for_everything_at_once() {
    check_laws(&everything(), 0.3);
    check_laws(&everything(), 1.0);
}

#[test]
fn laws_of_motion_hold_for_the_gyroscope_on_its_moving_base() {
    check_laws(&moving_base::rolling(), 0.2);
    check_laws(&moving_base::rolling_and_pitching(), 0.2);
    check_laws(&moving_base::rolling_fast(), 0.2);
}

/// The first joint's balance needs the base's rotation: at rest it is known.
#[test]
fn the_base_carries_the_whole_gyroscope() {
    let chain = moving_base::resting();
    let samples = around(&chain, 0.2);
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let expected = loads(&chain, &samples[4], 0, &identity);
    let found = slope(&samples, |sample| momenta(&chain, sample, 0));
    assert_near(found, expected, 1.0, "momentum of all");
}

#[test]
fn energy_comes_from_the_base_and_goes_into_the_dampers() {
    /// Rounding of gain and works.
    const RELATIVE: f64 = 1e-15;
    let carried = [moving_base::rolling(), moving_base::rolling_and_pitching(), moving_base::rolling_fast()];
    let check = |chain: Chain<3>| {
        for sample in chain.solve(&[0.1, 0.35]) {
            let (gain, work) = (sample.energy_gain, sample.base_work + sample.damping_work);
            let size = sample.base_work.abs() + sample.damping_work.abs();
            assert!(size > 1e-9, "the base does something");
            assert!((gain - work).abs() < RELATIVE * size, "{gain:e} {work:e} at {}", sample.t);
        }
    };
    std::thread::scope(|scope| {
        for chain in [everything()].into_iter().chain(carried) {
            scope.spawn(|| check(chain));
        }
    });
}

/// Kane's equations of the gyroscope, written for a base at rest.
#[test]
fn a_base_at_rest_gives_the_gyroscope() {
    let offsets = Gyroscope::combined_offsets();
    let mut chain = moving_base::resting();
    let vector = |v: [DoubleDouble; 3]| v.map(DoubleDouble::to_f64);
    (chain.links[2].before, chain.links[2].own) = (vector(offsets.ring_offset), vector(offsets.rotor_offset));
    for link in &mut chain.links {
        link.damping = 1e-6;
    }
    let gyroscope = Gyroscope { friction: ["1e-6".parse().unwrap(); 3], ..offsets };
    for (found, expected) in chain.solve(&[0.2, 1.0]).iter().zip(gyroscope.solve(&[0.2, 1.0])) {
        let [t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy] = expected.values();
        assert_eq!(found.t, t);
        assert_eq!(found.positions, [alpha, beta, phi]);
        assert_eq!(found.rates, [alpha_rate, beta_rate, phi_rate]);
        assert_eq!(found.energy, energy);
    }
}

#[test]
fn the_joint_frame_of_a_wrench_is_right_handed() {
    let wrench = gyro_reference::Wrench { force: [1.0, 2.0, 3.0], torque: [4.0, 5.0, 6.0] };
    // h = y, f = z, so that g = h × f = x.
    assert_eq!(wrench.in_joint_frame([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]), [3.0, 1.0, 2.0, 6.0, 4.0, 5.0]);
}
