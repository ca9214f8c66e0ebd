//! A generated module behind the interface that the clock calls.
#![allow(warnings)]

use gyro_sim::{JointPlace, JointSpace, Mechanism};

mod robot;
type Robot = robot::NAME<f64>;
type Joints = <Robot as JointSpace>::Joints;
type Rates = <Robot as JointSpace>::Rates;

/// The robot with its motors' torques; inputs have the order of the joints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ours_make(tau: *const f64) -> *mut Robot {
    let mut robot = Box::new(Robot::default());
    let mut index = 0;
    while robot.set_input(index, unsafe { *tau.add(index) }) {
        index += 1;
    }
    Box::into_raw(robot)
}

/// Numbers in a joint state.
#[unsafe(no_mangle)]
pub extern "C" fn ours_state() -> i32 {
    (size_of::<Joints>() / 8) as i32
}

/// Writes for each place of the joint state the index of its joint, or -1 for a body; returns how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ours_layout(out: *mut i32) -> i32 {
    let robot = Robot::default();
    let places = robot.joint_layout().places;
    for (k, place) in places.iter().enumerate() {
        let joint = match place {
            JointPlace::Scalar { joint, .. } => i32::from(*joint),
            JointPlace::Body { .. } => -1,
            other => panic!("{other:?}"),
        };
        unsafe { *out.add(k) = joint };
    }
    places.len() as i32
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ours_run(
    robot: *const Robot,
    x: *const f64,
    _v: *const f64,
    _tau: *const f64,
    out: *mut f64,
) {
    unsafe { (*robot).joint_accelerations(0.0, &*x.cast::<Joints>(), &mut *out.cast::<Rates>()) }
}
