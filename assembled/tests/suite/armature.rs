//! Armatures against rotors that are bodies: one that turns on the ground, coupled to the joint, has the same energy.

use crate::support::{assert_close, read_text};
use gyro_assembled::{Careful, Dense, Recursive};
use gyro_model::Model;
use gyro_sim::Dynamics;

/// Two bodies of order one, solved densely.
const ROUNDING: f64 = 1e-10;

/// An arm of two joints with these keys, and more.
fn arm(kinds: [&str; 2], keys: [&str; 2], more: &str) -> Model {
    let [first, second] = kinds;
    let [of_first, of_second] = keys;
    read_text(&format!(
        "format = 1
name = \"arm\"
gravity = [0, 0, -9.81]
[[body]]
name = \"ground\"
fixed = true
[[body]]
name = \"upper\"
mass = 1.5
inertia = {{ xx = 0.02, yy = 0.03, zz = 0.025, xy = 1e-3, xz = -2e-3, yz = 1e-3 }}
[[body]]
name = \"lower\"
mass = 0.8
inertia = [0.01, 0.012, 0.007]
[[joint]]
name = \"shoulder\"
kind = \"{first}\"
{of_first}
axis = [0, 3, 4]
zero = [1, 0, 0]
first = {{ body = \"ground\" }}
second = {{ body = \"upper\", point = [-0.2, 0.1, 0] }}
rate = 2
[[joint]]
name = \"elbow\"
kind = \"{second}\"
{of_second}
axis = [1, 2, 2]
zero = [0, 1, -1]
first = {{ body = \"upper\", point = [0.3, 0, 0.1] }}
second = {{ body = \"lower\", point = [0, -0.2, 0.1] }}
rate = -3
{more}"
    ))
}

/// A rotor on the ground that turns as the joint does; its mass is of no matter.
fn rotor(joint: &str, inertia: f64) -> String {
    format!(
        "[[body]]\nname = \"{joint}_rotor\"\nmass = 1\ninertia = [{inertia}, {inertia}, {inertia}]\n\
         [[joint]]\nname = \"{joint}_shaft\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
         first = {{ body = \"ground\" }}\nsecond = {{ body = \"{joint}_rotor\" }}\nrough = true\n\
         [[coupler]]\nname = \"{joint}_gear\"\nfirst = {{ joint = \"{joint}\" }}\n\
         second = {{ joint = \"{joint}_shaft\" }}\nratio = 1\n"
    )
}

/// The first twelve accelerations: those of the bodies of the arm.
fn accelerations<M: Dynamics<Scalar = f64>>(mechanism: &M) -> (Vec<f64>, f64) {
    let y = mechanism.start();
    let mut found = mechanism.acceleration_buffer();
    mechanism.accelerations(0.0, &y, &mut found);
    (found.as_ref()[..12].to_vec(), mechanism.energy(0.0, &y).kinetic)
}

#[test]
fn an_armature_is_a_rotor_that_the_ground_carries() {
    let (shoulder, elbow) = (0.4, 0.15);
    let keys = [format!("armature = {shoulder}"), format!("armature = {elbow}")];
    let keys = keys.each_ref().map(String::as_str);
    let more = rotor("shoulder", shoulder) + &rotor("elbow", elbow);
    for kinds in [["revolute", "revolute"], ["prismatic", "revolute"], ["revolute", "prismatic"]] {
        let of_bodies = arm(kinds, ["", ""], &more);
        let (expected, energy) = accelerations(&Dense::<f64>::new(&of_bodies).expect("a dense form"));
        let with = arm(kinds, keys, "");
        let mut found = vec![accelerations(&Dense::<f64>::new(&with).expect("a dense form"))];
        found.push(accelerations(&Recursive::<f64>::new(&with).expect("a recursive form")));
        if kinds == ["revolute", "revolute"] {
            found.push(accelerations(&Careful::<f64>::new(&with).expect("a careful form")));
        }
        for (found, kinetic) in found {
            assert_close("accelerations", &found, &expected, 1.0, ROUNDING);
            assert_close("energy", &[kinetic], &[energy], 1.0, ROUNDING);
        }
        let (without, _) =
            accelerations(&Dense::<f64>::new(&arm(kinds, ["", ""], "")).expect("a dense form"));
        let change = without.iter().zip(&expected).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(change > 1e-2, "armatures matter: {change}");
    }
}
