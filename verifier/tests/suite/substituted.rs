//! Coordinates that a gear or a driver determines are not in the joint state: functions put together by hand from those
//! of the mechanism and of the tree without gear and driver.

use crate::layouts::{places, stated};
use crate::loops::{Composed, add, of_state};
use crate::support::{Page, generate_text, page};
use gyro_model::JointCoordinate;
use gyro_program::Kernel;
use gyro_verifier::joints::{Freedom, JointLayout};
use gyro_verifier::module::Module;
use gyro_verifier::program::{Id, Node, Source};
use gyro_verifier::proof::{Claim, Decider, Statements, Verdict};

const SEED: u64 = 29;

const CLAIMS: [Claim; 4] = [
    Claim(Kernel::ToMaximal),
    Claim(Kernel::ToJoints),
    Claim(Kernel::JointAccelerations),
    Claim(Kernel::JointDerivative),
];

/// Two bodies on revolute joints, where the angle of one determines that of the other, or time does.
struct Substituted {
    page: Page,
    /// Without coupler and driver.
    tree: Page,
    /// The joint whose angle is in the state.
    kept: usize,
    /// u̇ as an element of (s̈, ẇ'), or as the difference of two.
    rate: (usize, Option<usize>),
    /// The other angle and its rate.
    other: fn(&mut Composed<'_>, [Id; 2]) -> [Id; 2],
}

fn gear() -> Substituted {
    let text = std::fs::read_to_string("../tests/models/gear.toml").expect("a model file");
    let (head, rest) = text.split_once("[[coupler]]").expect("a coupler");
    let (_, forces) = rest.split_once("[[force]]").expect("forces");
    let tree = generate_text("tree.toml", &format!("{head}[[force]]{forces}"));
    // θ₂ = 0.3 − 2.5 θ₁
    let other: fn(&mut Composed<'_>, [Id; 2]) -> [Id; 2] = |c, [x, u]| {
        let (ratio, offset) = (c.number("-2.5"), c.number("0.3"));
        let [x, u] = [x, u].map(|number| c.push(Node::Mul(ratio, number)));
        [c.push(Node::Add(x, offset)), u]
    };
    Substituted { page: page("gear"), tree, kept: 0, rate: (5, None), other }
}

fn driven_shaft() -> Substituted {
    let text = std::fs::read_to_string("../tests/models/driven-shaft.toml").expect("a model file");
    let (head, _) = text.split_once("[[driver]]").expect("a driver");
    let tree = generate_text("tree.toml", head);
    // θ₁ = from + 31.4 t
    let other: fn(&mut Composed<'_>, [Id; 2]) -> [Id; 2] = |c, _| {
        let (from, rate) = (c.push(Node::Read(Source::Parameter(0))), c.number("31.4"));
        let t = c.push(Node::Read(Source::Time));
        let turned = c.push(Node::Mul(rate, t));
        [c.push(Node::Add(from, turned)), rate]
    };
    Substituted { page: page("driven-shaft"), tree, kept: 1, rate: (11, Some(5)), other }
}

impl Substituted {
    /// The mechanism's module, whose joint state has the kept angle, its rate and the work.
    fn module(&self) -> Module {
        let stated = stated(&self.tree, &places(&self.tree.model), "");
        let tree = Module::read(&self.tree.model, &stated, &self.tree.constants).expect("the emitted subset");
        let mut module = Module::read(&self.page.model, &self.page.code, &self.page.constants)
            .expect("the emitted subset");
        let equations = module.clone();
        let angle = JointCoordinate { joint: self.kept, coordinate: 0 };
        let layout = JointLayout::new(&self.page.model, &[Freedom::Scalar(angle)], Vec::new());
        module.joints = Some(layout.expect("a layout"));
        add(&mut module, "to_maximal", Vec::new(), |c| self.to_maximal(c, &tree));
        add(&mut module, "joint_accelerations", Vec::new(), |c| {
            let state = self.to_maximal(c, &tree);
            let accelerations = c.call(&equations, "accelerations", of_state(&state));
            vec![self.rate(c, &accelerations)]
        });
        add(&mut module, "joint_derivative", Vec::new(), |c| {
            let state = self.to_maximal(c, &tree);
            let accelerations = c.call(&equations, "accelerations", of_state(&state));
            let derivative = c.call(&equations, "derivative", |source| match source {
                Source::State(k) => Some(state[k]),
                Source::Acceleration(k) => Some(accelerations[k]),
                _ => None,
            });
            let rate = c.push(Node::Read(Source::Acceleration(0)));
            vec![c.joint(1), rate, derivative[26]]
        });
        add(&mut module, "to_joints", vec![0, 1, 2], |c| {
            let buffer = c.joint(0);
            let of_tree = c.call(&tree, "to_joints", |source| match source {
                Source::Joint(k) if k == self.kept => Some(buffer),
                _ => None,
            });
            vec![of_tree[self.kept], of_tree[2 + self.kept], of_tree[4]]
        });
        module
    }

    /// That of the tree at both angles, with those that are turn references.
    fn to_maximal(&self, c: &mut Composed<'_>, tree: &Module) -> Vec<Id> {
        let kept = [c.joint(0), c.joint(1)];
        let other = (self.other)(c, kept);
        let work = c.joint(2);
        let mut joints = [kept[0], other[0], kept[1], other[1], work];
        if self.kept == 1 {
            joints = [other[0], kept[0], other[1], kept[1], work];
        }
        let state = c.call(tree, "to_maximal", |source| match source {
            Source::Joint(k) => Some(joints[k]),
            _ => None,
        });
        let turns = self.page.model.turn_references().into_iter().map(|turn| joints[turn.joint]);
        state[..26].iter().copied().chain([work]).chain(turns).collect()
    }

    fn rate(&self, c: &mut Composed<'_>, velocities: &[Id]) -> Id {
        let (first, second) = self.rate;
        match second {
            Some(second) => c.push(Node::Sub(velocities[first], velocities[second])),
            None => velocities[first],
        }
    }
}

#[test]
fn couplers_and_drivers_are_substituted() {
    for (name, mechanism) in [("gear", gear()), ("driven shaft", driven_shaft())] {
        let (module, model) = (mechanism.module(), &mechanism.page.model);
        assert!(model.has_work() && !model.turn_references().is_empty());
        let prime = Statements::new(model, &module, &CLAIMS).prime(SEED.into(), &[]);
        let decider: Decider<'_, 9> = Decider::new(model, prime.expect("room for all roots"));
        let proves = |module: &Module, claim| matches!(decider.decide(module, claim, 1, SEED), Verdict::Proved { error_log10, .. } if error_log10 < -30.0);
        for claim in CLAIMS {
            assert!(proves(&module, claim), "{name}: {claim:?}");
        }
        // A turn reference of which the joint state has no angle is that angle all the same.
        let last = module.programs["to_maximal"].results.len() - 1;
        let angle = if name == "gear" { last } else { 27 };
        for function in ["to_maximal", "joint_derivative"] {
            let mut wrong = module.clone();
            let program = wrong.programs.get_mut(function).expect("a function");
            let place = if function == "to_maximal" { angle } else { 2 };
            program.results[place] = program.push(Node::Neg(program.results[place]), 1);
            let claim = if function == "to_maximal" {
                Claim(Kernel::ToMaximal)
            } else {
                Claim(Kernel::JointDerivative)
            };
            assert!(!proves(&wrong, claim), "{name}: {function}");
        }
    }
}
