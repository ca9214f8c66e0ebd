use super::*;
use crate::spinner::Spinner;

#[test]
fn errors_name_time_part_and_number() {
    let spinner = Spinner::<f64>::default();
    for (error, words) in [
        (
            Error::NotFinite { t: 0.25, index: 5 },
            "at t = 0.25 s the orientation of body `rotor` is no longer",
        ),
        (Error::NotFinite { t: 0.25, index: 9 }, "at t = 0.25 s the velocity of body `rotor` is no longer"),
        (
            Error::NoConvergence { t: 0.5, violation: 3e-3, owner: Owner::Joint(0) },
            "at t = 0.5 s the constraints of joint `axle` cannot be met: 3e-3 remains",
        ),
        (
            Error::Singular { t: 1.0, pivot: 0.0, owner: Some(Owner::Joint(0)) },
            "at t = 1 s the dependent coordinates cannot be solved for: a pivot is 0e0; the mechanism is in a singular \
             pose, where the constraints of joint `axle` depend on others",
        ),
        (
            Error::Singular { t: 1.0, pivot: 0.0, owner: None },
            "at t = 1 s the dependent coordinates cannot be solved for: a pivot is 0e0; the mechanism is in a singular \
             pose, or",
        ),
        (
            Error::Jump { t: 1.0, change: 0.5, limit: 1e-2, owner: Owner::Driver(0) },
            "at t = 1 s the constraints of driver `crank` can be met only by a change of 5e-1 where 1e-2 is safe",
        ),
        (
            Error::NoConvergence { t: 0.5, violation: 3e-3, owner: Owner::Coupler(0) },
            "at t = 0.5 s the constraints of coupler or constraint `gear` cannot be met: 3e-3 remains",
        ),
    ] {
        let found = describe(&spinner, error);
        assert!(found.starts_with(words), "{found}");
        assert!(!found.contains("try"), "{found}");
    }
}

#[test]
fn contacts_that_cannot_go_on_are_named() {
    for (error, words) in [
        (
            contact::Error::Jammed { t: 0.5, index: 2, gain: 1.25 },
            "at t = 0.5 s friction on body `rotor` may jam: a unit of it adds up to 1.2500e0 to itself",
        ),
        (
            contact::Error::Jammed { t: 0.5, index: 2, gain: 0.0 },
            "at t = 0.5 s no motion is consistent with stops and friction, among them those on body `rotor`",
        ),
    ] {
        let found = describe(&Spinner::<f64>::default(), error);
        assert!(found.starts_with(words), "{found}");
    }
}

#[test]
fn elements_of_a_joint_state_are_named_by_its_layout() {
    let layout = JointLayout {
        places: &[
            JointPlace::Orientation { joint: 0 },
            JointPlace::Body { body: 0 },
            JointPlace::Scalar { joint: 0, coordinate: 0 },
        ],
        closure_rows: &[],
    };
    for (index, words) in [
        (0, "the position of joint `axle`"),
        (3, "the position of joint `axle`"),
        (4, "the position of body `rotor`"),
        (10, "the position of body `rotor`"),
        (11, "the position of joint `axle`"),
        (12, "the rate of joint `axle`"),
        (15, "the rate of body `rotor`"),
        (20, "the rate of body `rotor`"),
        (21, "the rate of joint `axle`"),
        (22, "the work done"),
    ] {
        let error = Error::NotFinite { t: 0.25, index };
        let found = describe_in(&Spinner::<f64>::default(), Some(&layout), error);
        assert!(found.starts_with(&format!("at t = 0.25 s {words} is no longer")), "{index}: {found}");
    }
}
