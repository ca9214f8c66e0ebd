//! Packs of lanes against as many scalar runs: pairs of kernels that do the same work on the same states.

use crate::Kernel;
use crate::kernels::{CORRECTIONS, STEPS_PER_CORRECTION};
use gyro_mechanisms::gyroscope::Gyroscope;
use gyro_sim::lanes::{self, Lanes, f32x8, f64x4, f64x8};
use gyro_sim::{
    CorrectedDynamics, Dynamics, Joint, JointSpace, Mechanism, Partition, Partitioned, Real, Rk4, Scalar,
    charts::Charts,
};
use gyro_yardstick::STEP;
use std::hint::black_box;

/// The scalar runs, then the pack.
pub type Pair<'a> = [Kernel<'a>; 2];

/// All pairs: single kernels, and whole runs; what computes the same is together.
pub fn pairs() -> (Vec<Pair<'static>>, Vec<Pair<'static>>) {
    let packs = [of::<f64x4>("f64x4"), of::<f64x8>("f64x8"), of::<f32x8>("f32x8")];
    let (kernels, runs): (Vec<_>, Vec<_>) = packs.into_iter().unzip();
    (together(kernels), together(runs))
}

/// The first of all lists, then the second of all, and so on.
fn together<T>(lists: Vec<Vec<T>>) -> Vec<T> {
    let mut items: Vec<_> = lists.into_iter().flat_map(|list| list.into_iter().enumerate()).collect();
    items.sort_by_key(|(place, _)| *place);
    items.into_iter().map(|(_, item)| item).collect()
}

fn of<T>(side: &'static str) -> (Vec<Pair<'static>>, Vec<Pair<'static>>)
where
    T: Lanes + 'static,
    T::Lane: 'static,
{
    let scenarios = Scenarios::<T>::new(side);
    let kernels = vec![
        scenarios.joint_accelerations(),
        Scenarios::<T>::at(side, ALL_ROUND).joint_accelerations_all_round(),
        scenarios.corrected_derivative(),
        scenarios.accelerations(),
        scenarios.newton_step(),
        scenarios.solve_velocities(),
    ];
    (kernels, vec![scenarios.second_in_joint_coordinates(), scenarios.second()])
}

/// The paper's scene in a state of its own in each lane.
struct Scenarios<T: Lanes> {
    side: &'static str,
    joints: Vec<[T::Lane; 6]>,
    packed_joints: [T; 6],
    states: Vec<[T::Lane; 39]>,
    packed: [T; 39],
}

/// In the middle of the paper's second, or nearly so.
const MIDDLE: [f64; 6] = [0.037, 0.0008, 37.0, 0.1, -0.05, 100.0];

/// The inner ring far round.
const ALL_ROUND: [f64; 6] = [2.0, 37.0, 37.0, 0.1, -0.05, 100.0];

impl<T> Scenarios<T>
where
    T: Lanes + 'static,
    T::Lane: 'static,
{
    fn new(side: &'static str) -> Self {
        Self::at(side, MIDDLE)
    }

    fn at(side: &'static str, state: [f64; 6]) -> Self {
        let scene = Gyroscope::<T::Lane>::default();
        let joint = |lane: usize| state.map(|x| T::Lane::constant(x * (1.0 + 0.01 * lane as f64)));
        let joints: Vec<_> = (0..T::COUNT).map(joint).collect();
        let maximal = |x: &[T::Lane; 6]| {
            let mut y = scene.start();
            scene.to_maximal(T::Lane::constant(0.0), x, &mut y);
            y
        };
        let states: Vec<_> = joints.iter().map(maximal).collect();
        let packed_joints = std::array::from_fn(|k| T::from_lanes(|lane| joints[lane][k]));
        let packed = std::array::from_fn(|k| T::from_lanes(|lane| states[lane][k]));
        Self { side, joints, packed_joints, states, packed }
    }

    fn pair(
        &self,
        what: &'static str,
        alone: impl FnMut() + 'static,
        together: impl FnMut() + 'static,
    ) -> Pair<'static> {
        [Kernel::new(what, self.side, None, alone), Kernel::new(what, self.side, None, together)]
    }

    fn joint_accelerations(&self) -> Pair<'static> {
        self.joint_accelerations_named("joint accelerations in joint coordinates")
    }

    fn joint_accelerations_all_round(&self) -> Pair<'static> {
        self.joint_accelerations_named("the same at angles all round")
    }

    fn joint_accelerations_named(&self, what: &'static str) -> Pair<'static> {
        self.pair(
            what,
            for_each(self.joints.clone(), Gyroscope::<T::Lane>::default().joint_buffers().rates, |x, out| {
                Gyroscope::default().joint_accelerations(T::Lane::constant(0.0), x, out);
            }),
            for_each(vec![self.packed_joints], Gyroscope::<T>::default().joint_buffers().rates, |x, out| {
                Gyroscope::default().joint_accelerations(T::constant(0.0), x, out);
            }),
        )
    }

    fn corrected_derivative(&self) -> Pair<'static> {
        self.pair(
            "derivative of a corrected state",
            for_each(self.states.clone(), self.states[0], |y, out| {
                Gyroscope::default().corrected_derivative(T::Lane::constant(0.0), y, out);
            }),
            for_each(vec![self.packed], self.packed, |y, out| {
                Gyroscope::default().corrected_derivative(T::constant(0.0), y, out);
            }),
        )
    }

    fn accelerations(&self) -> Pair<'static> {
        self.pair(
            "derivative of any state",
            for_each(self.states.clone(), self.states[0], |y, out| {
                Gyroscope::default().derivative(T::Lane::constant(0.0), y, out);
            }),
            for_each(vec![self.packed], self.packed, |y, out| {
                Gyroscope::default().derivative(T::constant(0.0), y, out);
            }),
        )
    }

    fn newton_step(&self) -> Pair<'static> {
        let (alone, together) = (self.charts(), self.packed_charts());
        self.pair(
            "Newton step of the positions",
            for_each(self.states.clone(), self.states[0], move |y, out| {
                *out = *y;
                let stepped = Gyroscope::default().newton_step(T::Lane::constant(0.0), &alone, out);
                stepped.expect("a tree can always be solved");
            }),
            for_each(vec![self.packed], self.packed, move |y, out| {
                *out = *y;
                let stepped = Gyroscope::default().newton_step(T::constant(0.0), &together, out);
                stepped.expect("a tree can always be solved");
            }),
        )
    }

    fn solve_velocities(&self) -> Pair<'static> {
        let (alone, together) = (self.charts(), self.packed_charts());
        self.pair(
            "solve of the velocities",
            for_each(self.states.clone(), self.states[0], move |y, out| {
                *out = *y;
                let solved = Gyroscope::default().solve_velocities(T::Lane::constant(0.0), &alone, out);
                solved.expect("a tree can always be solved");
            }),
            for_each(vec![self.packed], self.packed, move |y, out| {
                *out = *y;
                let solved = Gyroscope::default().solve_velocities(T::constant(0.0), &together, out);
                solved.expect("a tree can always be solved");
            }),
        )
    }

    /// The best charts of the first state; all are close to each other.
    fn charts(&self) -> Charts<T::Lane, 3> {
        Gyroscope::default().independent(T::Lane::constant(0.0), &self.states[0])
    }

    fn packed_charts(&self) -> Charts<T, 3> {
        Gyroscope::default().independent(T::constant(0.0), &self.packed)
    }

    fn second_in_joint_coordinates(&self) -> Pair<'static> {
        self.pair(
            "the paper's second in joint coordinates",
            for_each(self.joints.clone(), self.joints[0], |start, x| {
                *x = *start;
                joint_second(&Gyroscope::default(), x);
            }),
            for_each(vec![self.packed_joints], self.packed_joints, |start, x| {
                *x = *start;
                joint_second(&Gyroscope::default(), x);
            }),
        )
    }

    fn second(&self) -> Pair<'static> {
        self.pair(
            "the paper's second, corrected",
            for_each(self.states.clone(), self.states[0], |start, y| {
                *y = *start;
                second(&Gyroscope::default(), y);
            }),
            for_each(vec![self.packed], self.packed, |start, y| {
                *y = *start;
                second_of_lanes(&Gyroscope::default(), y);
            }),
        )
    }
}

/// Calls this with each of the inputs.
fn for_each<S, O>(inputs: Vec<S>, mut out: O, call: impl Fn(&S, &mut O)) -> impl FnMut() {
    move || inputs.iter().for_each(|input| call(black_box(input), black_box(&mut out)))
}

/// Runge and Kutta's method, a scalar or a pack.
fn joint_second<M: JointSpace>(scene: &M, x: &mut M::Joints) {
    let mut rk4 = Rk4::new(x);
    for step in 0..CORRECTIONS * STEPS_PER_CORRECTION {
        rk4.step(&Joint, scene, time(step), M::Scalar::constant(STEP), x);
    }
}

fn second<M: Partition<Scalar: Real> + CorrectedDynamics>(scene: &M, y: &mut M::State) {
    let mut solver = Partitioned::new(scene, y);
    for interval in 0..CORRECTIONS {
        let t = time(interval * STEPS_PER_CORRECTION);
        let advanced = solver.advance(scene, t, M::Scalar::constant(STEP), STEPS_PER_CORRECTION, y);
        advanced.expect("the paper's scene runs");
    }
}

fn second_of_lanes<M: Partition + CorrectedDynamics>(scene: &M, y: &mut M::State) {
    let mut solver = lanes::Partitioned::new(scene, y);
    for interval in 0..CORRECTIONS {
        let t = time(interval * STEPS_PER_CORRECTION);
        solver.advance(scene, t, M::Scalar::constant(STEP), STEPS_PER_CORRECTION, y);
    }
    assert_eq!(solver.failures().count(), 0, "the paper's scene runs");
}

fn time<T: Scalar>(step: u32) -> T {
    T::constant(f64::from(step) * STEP)
}
