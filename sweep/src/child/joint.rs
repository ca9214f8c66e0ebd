//! Scenarios of open trees in joint coordinates: what is kept is read off the joint state.

use super::Job;
use crate::keep::Quantity;
use crate::plan::Target;
use gyro_runner::Start;
use gyro_sim::{JointPlace, JointSpace, Real, Scalar};

/// Where the numbers of a study stand in a joint state.
pub(super) struct Layout {
    /// Each kept quantity's.
    columns: Vec<usize>,
    /// Of each target that is a start, its index and place.
    starts: Vec<(usize, usize)>,
    /// The joint state where nothing varies.
    start: Vec<f64>,
}

impl Layout {
    /// For a mechanism with the parameters as they are where they do not vary.
    pub(super) fn new<M: JointSpace<Scalar: Real>>(mechanism: &M, job: &Job) -> Self {
        let position = |index| element(mechanism, index).expect("a coordinate of the joint state");
        let rate = |index| rate_element(mechanism, index).expect("a rate of the joint state");
        let column = |quantity: &Quantity| match *quantity {
            Quantity::Position(index) => position(index),
            Quantity::Rate(index) => rate(index),
            other => unreachable!("{other:?} is not of the joint state"),
        };
        let start = |(target, of): (usize, &Target)| match *of {
            Target::Start(joint, k) => Some((target, position(flat(mechanism, joint, k)))),
            Target::StartRate(joint, k) => Some((target, rate(flat(mechanism, joint, k)))),
            _ => None,
        };
        Self {
            columns: job.keep.columns.iter().map(column).collect(),
            starts: job.plan.targets.iter().enumerate().filter_map(start).collect(),
            start: joint_start(mechanism, &job.start).as_ref().iter().map(|x| x.to_f64()).collect(),
        }
    }

    /// The place of a kept quantity.
    pub(super) fn column(&self, index: usize) -> usize {
        self.columns[index]
    }

    /// The place of a target that is a start.
    pub(super) fn start_of(&self, target: usize) -> Option<usize> {
        self.starts.iter().find(|(own, _)| *own == target).map(|(_, place)| *place)
    }

    /// The joint state in which a scenario starts.
    pub(super) fn write_start(&self, values: &[f64], x: &mut Vec<f64>) {
        x.clone_from(&self.start);
        self.starts.iter().for_each(|(target, place)| x[*place] = values[*target]);
    }
}

/// The joint state of a maximal start.
pub(super) fn joint_start<M: JointSpace<Scalar: Real>>(mechanism: &M, start: &Start) -> M::Joints {
    let (mut y, mut x) = (mechanism.start(), mechanism.joint_start());
    let known = start.positions.iter().chain(&start.velocities).copied().chain(start.others());
    write_start(start, known.map(Scalar::constant), y.as_mut());
    mechanism.to_joints(Scalar::constant(0.0), &y, &mut x);
    x
}

/// Writes a maximal state: what is known of it are positions, velocities, states and turn references; work is between.
pub(super) fn write_start<T>(start: &Start, known: impl Iterator<Item = T>, y: &mut [T]) {
    let others = y.len() - start.n_others();
    let moving = start.positions.len() + start.velocities.len();
    let places = (0..moving).chain(others..y.len());
    places.zip(known).for_each(|(place, value)| y[place] = value);
}

/// A joint's coordinate among the coordinates of all joints.
pub(super) fn flat<M: JointSpace>(mechanism: &M, joint: usize, coordinate: usize) -> usize {
    let joints = mechanism.description().joints;
    joints[..joint].iter().map(|joint| joint.coordinates.len()).sum::<usize>() + coordinate
}

/// Where a scalar coordinate, by its index among those of all joints, stands in x.
fn element<M: JointSpace>(mechanism: &M, index: usize) -> Option<usize> {
    find(mechanism, index, |place| place.n_coordinates())
}

/// Where its rate stands in the joint state.
fn rate_element<M: JointSpace>(mechanism: &M, index: usize) -> Option<usize> {
    let before = mechanism.joint_layout().n_coordinates();
    find(mechanism, index, |place| place.n_rates()).map(|at| before + at)
}

fn find<M: JointSpace>(mechanism: &M, index: usize, length: impl Fn(&JointPlace) -> usize) -> Option<usize> {
    let mut at = 0;
    for place in mechanism.joint_layout().places {
        if let JointPlace::Scalar { joint, coordinate } = *place
            && flat(mechanism, joint.into(), coordinate.into()) == index
        {
            return Some(at);
        }
        at += length(place);
    }
    None
}
