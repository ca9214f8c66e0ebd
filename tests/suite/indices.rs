//! The constants of generated modules say where joint coordinates, rates, inputs, outputs and parameters stand.

use gyro_sim::{JointPlace, JointSpace, Mechanism};
use gyro_sim_suite::own::all_joints::{AllJoints, index};
use gyro_sim_suite::{model, own, shipped};

/// Where the coordinate of a joint and its rate stand.
fn places<M: JointSpace>(mechanism: &M, joint: &str, coordinate: u16) -> (usize, usize) {
    let (layout, joints) = (mechanism.joint_layout(), mechanism.description().joints);
    let wanted = joints.iter().position(|j| j.name == joint).expect("a joint of the model file");
    let is_it = |place: &&JointPlace| match **place {
        JointPlace::Scalar { joint, coordinate: c } => usize::from(joint) == wanted && c == coordinate,
        JointPlace::Orientation { joint } => usize::from(joint) == wanted,
        JointPlace::Body { .. } | JointPlace::Turn { .. } | JointPlace::State { .. } => false,
    };
    let before = || layout.places.iter().take_while(|place| !is_it(place));
    let x: usize = before().map(|place| place.n_coordinates()).sum();
    let u: usize = before().map(|place| place.n_rates()).sum();
    (x, layout.n_coordinates() + u)
}

#[test]
fn joints_of_every_kind_are_where_the_constants_say() {
    use index::{joint, joint_rate};
    let mechanism = AllJoints::<f64>::default();
    for (name, coordinate, found) in [
        ("rail", 0, (joint::RAIL, joint_rate::RAIL)),
        ("spindle", 0, (joint::SPINDLE, joint_rate::SPINDLE)),
        ("tube", 1, (joint::displacement::TUBE, joint_rate::displacement::TUBE)),
        ("hooke", 0, (joint::first_angle::HOOKE, joint_rate::first_angle::HOOKE)),
        ("hooke", 1, (joint::second_angle::HOOKE, joint_rate::second_angle::HOOKE)),
        ("table", 0, (joint::x::TABLE, joint_rate::x::TABLE)),
        ("table", 1, (joint::y::TABLE, joint_rate::y::TABLE)),
        ("table", 2, (joint::angle::TABLE, joint_rate::angle::TABLE)),
    ] {
        assert_eq!(found, places(&mechanism, name, coordinate), "{name}, coordinate {coordinate}");
    }
}

#[test]
fn orientations_and_free_bodies_are_where_the_constants_say() {
    use own::spherical::index as spherical;
    let joint = &model("spherical").joints[0].name;
    let mechanism = own::spherical::Spherical::<f64>::default();
    assert_eq!(joint, "tip");
    let found = (spherical::joint::orientation::TIP, spherical::joint_rate::orientation::TIP);
    assert_eq!(found, places(&mechanism, joint, 0));
    use shipped::free_body::index as free;
    assert_eq!((free::body::BODY, free::body_rate::BODY), (0, 7));
}

#[test]
fn inputs_outputs_and_parameters_are_where_the_constants_say() {
    let mut mechanism = AllJoints::<f64>::default();
    let outputs = mechanism.description().outputs;
    let first = |name: &str| outputs.iter().position(|output| output.name == name).expect("an output");
    assert_eq!(index::output::PUCK_VELOCITY, first("puck_velocity"));
    assert_eq!(index::output::POWERS, first("powers"));
    assert_eq!(AllJoints::<f64>::PARAMETERS[index::parameter::ROD_LENGTH], "rod_length");
    assert!(mechanism.set_input(index::input::MOTOR, 0.25));
    assert_eq!(mechanism.motor, 0.25);
}
