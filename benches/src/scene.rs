//! The paper's scene as everyone who computes it sees it.

use gyro_assembled::{Careful, Dense, Recursive};
use gyro_mechanisms::gyroscope::Gyroscope;
use gyro_mechanisms::gyroscope_maximal::GyroscopeMaximal;
use gyro_sim::{Dynamics, Kinematics, Projection, Rk4};
use gyro_yardstick::{Floor, STEP};

/// Steps to the state at which kernels are measured: 0.37 s, where nothing is zero.
const STEPS: u32 = 3700;

/// The rotor's mass centre from the gimbal centre, m.
const OFFSET: f64 = 0.000_125;

/// Of accelerations, over the largest of its state.
const AGREEMENT: f64 = 1e-12;

/// Everyone, and the state in everyone's coordinates.
#[derive(Debug)]
pub struct Scene {
    pub(crate) floor: Floor,
    pub(crate) generated: Gyroscope<f64>,
    pub(crate) careful: Careful<f64>,
    pub(crate) recursive: Recursive<f64>,
    /// The ground folded: 33 unknowns.
    pub(crate) dense: Dense<f64>,
    pub(crate) generated_maximal: GyroscopeMaximal<f64>,
    /// The paper's own form: 45 unknowns.
    pub(crate) dense_maximal: Dense<f64>,
    /// α, β, φ and their rates.
    pub(crate) joints: [f64; 6],
    pub(crate) maximal: [f64; 39],
    /// With the base as a constrained body.
    pub(crate) with_base: [f64; 52],
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

impl Scene {
    /// The scene, with the accelerations of all checked against the floor's.
    ///
    /// # Panics
    /// If anyone disagrees.
    pub fn new() -> Self {
        let folded = model("gyroscope.toml", include_str!("../../models/gyroscope.toml"));
        let whole = model("gyroscope-maximal.toml", include_str!("../../models/gyroscope-maximal.toml"));
        let expectation = "shipped models can be assembled";
        let joints = in_the_middle(&Floor::paper());
        let maximal = maximal(&joints);
        let scene = Self {
            floor: Floor::paper(),
            generated: Gyroscope::default(),
            careful: Careful::new(&folded).expect(expectation),
            recursive: Recursive::new(&folded).expect(expectation),
            dense: Dense::new(&folded).expect(expectation),
            generated_maximal: GyroscopeMaximal::default(),
            dense_maximal: Dense::new(&whole).expect(expectation),
            joints,
            maximal,
            with_base: with_base(&maximal),
        };
        scene.check();
        scene
    }

    /// At the state and at poses and rates that the scene never reaches.
    fn check(&self) {
        let elsewhere = [[0.3, -1.2, 2.0, 1.5, -0.7, 30.0], [-2.0, 0.9, 0.1, -8.0, 5.0, -12.0]];
        for joints in [&self.joints, &elsewhere[0], &elsewhere[1]] {
            let maximal = maximal(joints);
            let expected = self.floor.accelerations(joints);
            agree("generated", joints, expected, &accelerations(&self.generated, &maximal, 0));
            agree("careful", joints, expected, &accelerations(&self.careful, &maximal.to_vec(), 0));
            agree("recursive", joints, expected, &accelerations(&self.recursive, &maximal.to_vec(), 0));
            agree("dense", joints, expected, &accelerations(&self.dense, &maximal.to_vec(), 0));
            let with_base = with_base(&maximal);
            let found = accelerations(&self.generated_maximal, &with_base, 6);
            agree("generated, maximal", joints, expected, &found);
            let found = accelerations(&self.dense_maximal, &with_base.to_vec(), 6);
            agree("dense, maximal", joints, expected, &found);
        }
    }
}

fn model(name: &str, page: &str) -> gyro_model::Model {
    gyro_model::read(name, page).expect("shipped models are free of mistakes")
}

/// The state of the floor after [`STEPS`].
fn in_the_middle(floor: &Floor) -> [f64; 6] {
    let mut y = gyro_yardstick::START;
    let mut rk4 = Rk4::new(&y);
    (0..STEPS).for_each(|step| rk4.step(floor, &(), f64::from(step) * STEP, STEP, &mut y));
    y
}

/// The maximal state that a state of the joints means.
fn maximal([alpha, beta, phi, alpha_rate, beta_rate, phi_rate]: &[f64; 6]) -> [f64; 39] {
    let half = |angle: &f64| (angle / 2.0).sin_cos();
    let ((sa, ca), (sb, cb), (sp, cp)) = (half(alpha), half(beta), half(phi));
    let outer = [ca, 0.0, sa, 0.0];
    let inner = product(outer, [cb, 0.0, 0.0, sb]);
    let rotor = product(inner, [cp, sp, 0.0, 0.0]);
    let (s, c) = beta.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    let inner_rate = [alpha_rate * s, alpha_rate * c, *beta_rate];
    // Turned back by φ about x.
    let across = [
        cos_phi * inner_rate[1] + sin_phi * inner_rate[2],
        cos_phi * inner_rate[2] - sin_phi * inner_rate[1],
    ];
    let centre = turned(inner, [OFFSET, 0.0, 0.0]);
    let velocity = turned(inner, [0.0, OFFSET * beta_rate, -OFFSET * alpha_rate * c]);
    let mut y = [0.0; 39];
    y[3..7].copy_from_slice(&outer);
    y[10..14].copy_from_slice(&inner);
    y[14..17].copy_from_slice(&centre);
    y[17..21].copy_from_slice(&rotor);
    y[25] = *alpha_rate;
    y[30..33].copy_from_slice(&inner_rate);
    y[33..36].copy_from_slice(&velocity);
    y[36..39].copy_from_slice(&[inner_rate[0] + phi_rate, across[0], across[1]]);
    y
}

/// The same with the base at the origin as the first body.
fn with_base(maximal: &[f64; 39]) -> [f64; 52] {
    let mut y = [0.0; 52];
    y[3] = 1.0;
    y[7..28].copy_from_slice(&maximal[..21]);
    y[34..].copy_from_slice(&maximal[21..]);
    y
}

/// The product of Euler parameters.
fn product(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// A vector in global components.
fn turned(p: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let [_, x, y, z] = product(product(p, [0.0, v[0], v[1], v[2]]), [p[0], -p[1], -p[2], -p[3]]);
    [x, y, z]
}

fn accelerations<M: Kinematics<Scalar = f64> + Dynamics + Projection>(
    mechanism: &M,
    y: &M::State,
    from: usize,
) -> Vec<f64> {
    let mut out = mechanism.acceleration_buffer();
    mechanism.accelerations(0.0, y, &mut out);
    out.as_ref()[from..from + 18].to_vec()
}

/// The accelerations of the joints from those of the bodies: α̈ is the outer ring's about y, β̈ the inner ring's about
/// z, and the rotor's about x is φ̈ with the derivative of α̇ s.
fn agree(who: &str, joints: &[f64; 6], expected: [f64; 3], bodies: &[f64]) {
    let (s, c) = joints[1].sin_cos();
    let (alpha, beta) = (bodies[4], bodies[11]);
    let phi = bodies[15] - (alpha * s + joints[3] * joints[4] * c);
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (found, expected) in [alpha, beta, phi].iter().zip(expected) {
        let error = (found - expected).abs() / largest;
        assert!(error <= AGREEMENT, "{who} at {joints:?}: {found} where the floor has {expected}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_sim::Mechanism;

    #[test]
    fn everyone_agrees_with_the_floor() {
        Scene::new();
    }

    #[test]
    fn the_maximal_state_meets_the_constraints() {
        let scene = Scene::new();
        let (mut phi, mut rates) = (scene.generated.buffers().constraints, scene.generated.buffers().rows);
        scene.generated.phi(0.0, &scene.maximal, &mut phi);
        scene.generated.velocity_residual(0.0, &scene.maximal, &mut rates);
        assert!(phi.iter().all(|x| x.abs() < 1e-15), "{phi:?}");
        assert!(rates.iter().all(|x| x.abs() < 1e-13), "{rates:?}");
    }

    #[test]
    fn a_wrong_acceleration_is_noticed() {
        let joints = [0.3, -1.2, 2.0, 1.5, -0.7, 30.0];
        let mut bodies = accelerations(&Gyroscope::default(), &maximal(&joints), 0);
        let expected = Floor::paper().accelerations(&joints);
        bodies[4] *= 1.0 + 1e-9;
        assert!(std::panic::catch_unwind(|| agree("nobody", &joints, expected, &bodies)).is_err());
    }
}
