//! Contacts of mechanisms with loops: the energy that [`Mechanism::energy`] has is that of before, less what impacts
//! have taken, which is computed from impulses alone.

use gyro_codegen::{Effort, Functions};
use gyro_jit::Compiled;
use gyro_sim::contact::{Contact, Hybrid, JointInputs, Phase};
use gyro_sim::{CloseLoops, Control, Dop853, JointPlace, JointSpace, Mechanism};

/// The crank-rocker of the gallery, with a motor in each of its pivots for the reactions of their stops.
fn four_bar() -> Compiled<f64> {
    let text = include_str!("../../../models/four-bar.toml");
    let motor = |joint: &str| {
        format!(
            "[[force]]\nname = \"at_{joint}\"\nkind = \"motor\"\njoint = \"{joint}\"\nvalue = \"{joint}_torque\"\n"
        )
    };
    let inputs = "[inputs]\ncrank_pivot_torque = 0\nrocker_pivot_torque = 0\n";
    let (head, bodies) = text.split_once("[[body]]").unwrap();
    let text = format!("{head}{inputs}\n[[body]]{bodies}\n{}{}", motor("crank_pivot"), motor("rocker_pivot"));
    let model = gyro_model::read("four-bar-with-motors.toml", &text).unwrap();
    gyro_jit::compile::<f64>(&model, &Functions::usual(), Effort::Quick).unwrap()
}

/// Index of a joint's coordinate and of its rate in the joint state.
fn places(mechanism: &Compiled<f64>, name: &str) -> [usize; 2] {
    let joint = mechanism.description().joints.iter().position(|joint| joint.name == name).unwrap();
    let layout = mechanism.joint_layout();
    let mut place = [0, layout.n_coordinates()];
    for there in layout.places {
        if matches!(there, JointPlace::Scalar { joint: owner, .. } if usize::from(*owner) == joint) {
            return place;
        }
        place = [place[0] + there.n_coordinates(), place[1] + there.n_rates()];
    }
    panic!("{name} has no coordinate");
}

fn energy(mechanism: &Compiled<f64>, t: f64, x: &Vec<f64>) -> f64 {
    let mut y = mechanism.start();
    mechanism.to_maximal(t, x, &mut y);
    mechanism.energy(t, &y).total()
}

#[test]
fn bars_of_a_loop_that_hit_stops_keep_a_ledger_of_energy() {
    let mechanism = four_bar();
    let start = mechanism.joint_start();
    let [crank, rocker] = ["crank_pivot", "rocker_pivot"].map(|name| places(&mechanism, name));
    for (e, comes_to_rest) in [([1.0, 1.0], false), ([0.7, 0.7], true), ([0.9, 0.2], false)] {
        let at = |k: usize, place: [usize; 2], range: [f64; 2]| {
            let x = start[place[0]];
            Contact::new(place[0], place[1]).with_stops([x + range[0], x + range[1]], e[k]).unwrap()
        };
        let ranges = [[-1.0, 1.3], [-0.2, 9.0]];
        let contacts = [at(0, crank, ranges[0]), at(1, rocker, ranges[1])];
        let equations = JointInputs { inputs: [0, 1] };
        let control = Control::default().with_tolerance(1e-12);
        let correction = CloseLoops::new(&mechanism);
        let mut motion =
            Hybrid::with_correction(equations, contacts, Dop853::new(&start), correction, 0.0, &start)
                .with_control(control);
        let before = energy(&mechanism, 0.0, &start);
        let (mut worst, mut rested) = (0.0_f64, false);
        while motion.time() < 5.0 {
            motion.step_towards(&mechanism, 5.0).unwrap();
            let now = energy(&mechanism, motion.time(), motion.state());
            worst = worst.max((now + motion.record().lost - before).abs());
            for (k, phase) in motion.phases().iter().enumerate() {
                let [x, rate] = [crank, rocker][k].map(|place| motion.state()[place]);
                let end = start[[crank, rocker][k][0]] + ranges[k][usize::from(*phase == Phase::AtUpper)];
                assert!(!phase.is_held() || (x, rate) == (end, 0.0), "{phase:?} {x} {rate}");
            }
            rested |= motion.phases().iter().any(|phase| matches!(phase, Phase::AtLower | Phase::AtUpper));
        }
        assert!(worst < 1e-11 * before, "{e:?}: {worst:e} J of {before} J");
        assert!(motion.record().impacts > 10, "{e:?}: {:?}", motion.record());
        assert_eq!(rested, comes_to_rest, "{e:?}");
    }
}
