//! Functions that close loops, put together by hand from those of two modules: of the mechanism, and of the tree that
//! is left when its last joint is cut. What they compute is right by construction, and faults in them are found.

use crate::faults::{Fault, apply, faults};
use crate::layouts::{places, stated};
use crate::support::{Page, generate_text, page};
use chacha20::ChaCha8Rng;
use gyro_model::RowOwner;
use gyro_program::Kernel;
use gyro_verifier::field::Constant;
use gyro_verifier::joints::{Freedom, JointLayout};
use gyro_verifier::module::Module;
use gyro_verifier::program::{Id, Node, Program, Source};
use gyro_verifier::proof::{Claim, Decider, Statements, Verdict};
use rand::{RngExt, SeedableRng};

const SEED: u64 = 23;

/// Faults that each function is given.
const FAULTS: usize = 40;

/// What the functions of joint coordinates of a mechanism with loops are claimed to be.
const CLAIMS: [Claim; 7] = [
    Claim(Kernel::LoopClosure),
    Claim(Kernel::ClosePositions),
    Claim(Kernel::CloseVelocities),
    Claim(Kernel::ToMaximal),
    Claim(Kernel::ToJoints),
    Claim(Kernel::JointAccelerations),
    Claim(Kernel::JointDerivative),
];

/// A rate as a sum of velocities (s, w') of the bodies, each added or taken away.
type Rate = &'static [(bool, usize)];

/// A mechanism with a loop.
struct Loop {
    page: Page,
    /// The mechanism without its last joint.
    tree: Page,
    rates: &'static [Rate],
}

/// Four bars whose axes are all parallel.
fn four_bar() -> Loop {
    let page = page("four-bar-revolute");
    let text = std::fs::read_to_string("../models/four-bar-revolute.toml").expect("a model file");
    let (tree, _) = text.rsplit_once("[[joint]]").expect("a joint");
    const RATES: &[Rate] = &[&[(true, 5)], &[(true, 17)], &[(true, 11), (false, 5)]];
    Loop { page, tree: generate_text("tree.toml", tree), rates: RATES }
}

/// A body on a ball, which a rod holds too.
fn ball_and_rod(wall: &str) -> Loop {
    let tree = format!(
        "format = 1\nname = \"ball\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"wall\"\n{wall}\n\
         [[body]]\nname = \"part\"\nmass = 2\ninertia = [0.1, 0.2, 0.25]\n\
         [[joint]]\nname = \"ball\"\nkind = \"spherical\"\n\
         first = {{ body = \"wall\" }}\nsecond = {{ body = \"part\", point = [0.5, 0, 0.1] }}\n"
    );
    let rod = "[[joint]]\nname = \"rod\"\nkind = \"rod\"\nlength = 1.5\n\
         first = { body = \"wall\", point = [1, 1, 0] }\nsecond = { body = \"part\", point = [0, 0.25, -0.3] }\n";
    const RATES: &[Rate] = &[&[(true, 3)], &[(true, 4)], &[(true, 5)]];
    Loop {
        page: generate_text("closed.toml", &format!("{tree}{rod}")),
        tree: generate_text("tree.toml", &tree),
        rates: RATES,
    }
}

/// A wall that is shaken without being turned, so that it does work.
const SHAKEN: &str = "driven = { translation = [{ polynomial = [0, 1, 0.5] }, \
     { sinusoid = { amplitude = 0.25, angular_frequency = 2, phase_deg = 0 } }, 0], rotations = [] }";

/// A program in the making, of a module that gets it.
pub struct Composed<'m> {
    program: Program,
    constants: &'m mut Vec<Constant>,
}

impl Composed<'_> {
    pub fn push(&mut self, node: Node) -> Id {
        self.program.push(node, 1)
    }

    /// What a function of a module gives; some of what it reads is replaced.
    pub fn call(&mut self, module: &Module, function: &str, read: impl Fn(Source) -> Option<Id>) -> Vec<Id> {
        let offset = self.constants.len();
        self.constants.extend(module.constants.values.iter().cloned());
        let (mut places, program) = (Vec::<Id>::new(), &module.programs[function]);
        for node in &program.nodes {
            let place = match *node {
                Node::Constant(k) => self.push(Node::Constant(offset + k)),
                Node::Read(source) => read(source).unwrap_or_else(|| self.push(Node::Read(source))),
                node => self.push(node.with_operands(|id| places[id])),
            };
            places.push(place);
        }
        program.results.iter().map(|&id| places[id]).collect()
    }

    fn negated(&mut self, ids: &[Id]) -> Vec<Id> {
        ids.iter().map(|&id| self.push(Node::Neg(id))).collect()
    }

    /// The rates that velocities of bodies have.
    fn rates(&mut self, rates: &[Rate], velocities: &[Id]) -> Vec<Id> {
        let sum = |composed: &mut Self, rate: &Rate| {
            let (_, first) = rate[0];
            rate[1..].iter().fold(velocities[first], |sum, &(added, k)| {
                composed.push(if added {
                    Node::Add(sum, velocities[k])
                } else {
                    Node::Sub(sum, velocities[k])
                })
            })
        };
        rates.iter().map(|rate| sum(self, rate)).collect()
    }

    pub fn joint(&mut self, k: usize) -> Id {
        self.push(Node::Read(Source::Joint(k)))
    }

    /// A number of decimals.
    pub fn number(&mut self, decimals: &str) -> Id {
        let factor = gyro_model::parse_decimal(decimals).expect("a decimal");
        let literal = decimals.parse().expect("a decimal");
        self.constants.push(Constant { literal, factor, radicand: None });
        self.push(Node::Constant(self.constants.len() - 1))
    }

    fn sum(&mut self, ids: impl IntoIterator<Item = Id>) -> Id {
        ids.into_iter().reduce(|a, b| self.push(Node::Add(a, b))).expect("something to add")
    }
}

pub fn of_state(state: &[Id]) -> impl Fn(Source) -> Option<Id> {
    |source| if let Source::State(k) = source { Some(state[k]) } else { None }
}

impl Loop {
    /// The mechanism's module with joint coordinates.
    fn module(&self) -> Module {
        let Self { page, tree, rates } = self;
        let stated = stated(tree, &places(&tree.model), "");
        let tree_module = Module::read(&tree.model, &stated, &tree.constants).expect("the emitted subset");
        let mut module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
        let of_tree = tree_module.joints.as_ref().expect("a tree");
        let freedoms: Vec<Freedom> = of_tree.places.iter().map(|place| place.of).collect();
        let cut = page.model.rows_of(RowOwner::Joint(page.model.joints.len() - 1)).collect();
        let layout = JointLayout::new(&page.model, &freedoms, cut).expect("a layout");
        let equations = module.clone();
        let n = page.model.coordinate_bodies().len();
        add(&mut module, "joint_derivative", Vec::new(), |c| {
            let mut rates = c.call(&tree_module, "joint_derivative", |_| None);
            if layout.has_work {
                let state = c.call(&tree_module, "to_maximal", |_| None);
                let accelerations = c.call(&equations, "accelerations", of_state(&state));
                let derivative = c.call(&equations, "derivative", |source| match source {
                    Source::State(k) => Some(state[k]),
                    Source::Acceleration(k) => Some(accelerations[k]),
                    _ => None,
                });
                rates[layout.n_motion()] = derivative[13 * n];
            }
            rates
        });
        for function in ["to_maximal", "to_joints"] {
            add(&mut module, function, tree_module.programs[function].places.clone(), |c| {
                c.call(&tree_module, function, |_| None)
            });
        }
        add(&mut module, "loop_closure", Vec::new(), |c| {
            let state = c.call(&tree_module, "to_maximal", |_| None);
            let phi = c.call(&equations, "phi", of_state(&state));
            layout.closure_rows.iter().map(|&row| phi[row]).collect()
        });
        add(&mut module, "joint_accelerations", Vec::new(), |c| {
            let state = c.call(&tree_module, "to_maximal", |_| None);
            let accelerations = c.call(&equations, "accelerations", of_state(&state));
            c.rates(rates, &accelerations)
        });
        let u = layout.n_coordinates;
        add(&mut module, "close_velocities", (u..u + layout.n_rates).collect(), |c| {
            let change = projected(c, [&tree_module, &equations], "velocity_residual");
            let changes = c.rates(rates, &change);
            let sum = |(k, change)| {
                let rate = c.joint(u + k);
                c.sum([rate, change])
            };
            changes.into_iter().enumerate().map(sum).collect()
        });
        add(&mut module, "close_positions", (0..u).collect(), |c| {
            let change = projected(c, [&tree_module, &equations], "phi");
            let changes = c.rates(rates, &change);
            let mut x: Vec<Id> = (0..u).map(|k| c.joint(k)).collect();
            for place in &layout.places {
                let changes = &changes[place.u..];
                match place.of {
                    Freedom::Scalar(_) => x[place.x] = c.sum([x[place.x], changes[0]]),
                    _ => turn(c, &mut x[place.x..place.x + 4], &changes[..3]),
                }
            }
            x
        });
        module.joints = Some(layout);
        module
    }
}

pub fn add(
    module: &mut Module,
    function: &str,
    places: Vec<usize>,
    compose: impl FnOnce(&mut Composed) -> Vec<Id>,
) {
    let mut composed = Composed { program: Program::default(), constants: &mut module.constants.values };
    let results = compose(&mut composed);
    let program = Program { results, places, ..composed.program };
    module.programs.insert(function.to_owned(), program);
}

/// The motion (δr, δπ') by which rows vanish.
fn projected(composed: &mut Composed, [tree, equations]: [&Module; 2], rows: &str) -> Vec<Id> {
    let state = composed.call(tree, "to_maximal", |_| None);
    let rows = composed.call(equations, rows, of_state(&state));
    let changes = composed.negated(&rows);
    composed.call(equations, "project", |source| match source {
        Source::State(k) => Some(state[k]),
        Source::Change(k) => Some(changes[k]),
        _ => None,
    })
}

/// `p + ½ Gᵀ δ`.
fn turn(composed: &mut Composed, p: &mut [Id], change: &[Id]) {
    let one = {
        let square = composed.push(Node::Mul(p[0], p[0]));
        composed.push(Node::Div(square, square))
    };
    let two = composed.push(Node::Add(one, one));
    let mut product = |a: (bool, usize), k: usize| {
        let factor = if a.0 { p[a.1] } else { composed.push(Node::Neg(p[a.1])) };
        composed.push(Node::Mul(factor, change[k]))
    };
    const G: [[(bool, usize); 3]; 4] = [
        [(false, 1), (false, 2), (false, 3)],
        [(true, 0), (false, 3), (true, 2)],
        [(true, 3), (true, 0), (false, 1)],
        [(false, 2), (true, 1), (true, 0)],
    ];
    let turned = G.map(|row| [0, 1, 2].map(|k| product(row[k], k)));
    for (e, terms) in p.iter_mut().zip(turned) {
        let sum = composed.sum(terms);
        let half = composed.push(Node::Div(sum, two));
        *e = composed.sum([*e, half]);
    }
}

/// The loop's module with its decider.
fn with_decider<'l>(mechanism: &'l Loop, module: &Module) -> Decider<'l, 9> {
    let model = &mechanism.page.model;
    let prime = Statements::new(model, module, &CLAIMS).prime(SEED.into(), &[]);
    Decider::new(model, prime.expect("room for all roots"))
}

/// Whether some claims are proved with an error below 1e-30.
fn proves(decider: &Decider<'_, 9>, module: &Module, claims: &[Claim]) -> bool {
    claims.iter().all(|&claim| {
        let verdict = decider.decide(module, claim, 1, SEED);
        matches!(verdict, Verdict::Proved { error_log10, .. } if error_log10 < -30.0)
    })
}

/// Whether a claim determines what its functions give. Loops are closed by any step that makes up for Φ or its rate:
/// an elimination with other weights gives another such step.
fn is_unique(claim: Claim) -> bool {
    !matches!(claim, Claim(Kernel::ClosePositions) | Claim(Kernel::CloseVelocities))
}

fn is_of_results(fault: &Fault) -> bool {
    matches!(fault, Fault::SwappedResults(_) | Fault::LostFactor(_) | Fault::Store(_))
}

#[test]
fn functions_that_close_loops_are_proved_and_faults_in_them_found() {
    let (mut count, mut survivors) = (0, Vec::new());
    let mechanisms = [
        ("four-bar", four_bar()),
        ("ball and rod", ball_and_rod("fixed = true")),
        ("ball and rod on a wall that moves", ball_and_rod(SHAKEN)),
    ];
    for (name, mechanism) in mechanisms {
        let module = mechanism.module();
        let decider = with_decider(&mechanism, &module);
        let n_state = module.joints.as_ref().map_or(0, JointLayout::n_state);
        for claim in CLAIMS {
            assert!(proves(&decider, &module, &[claim]), "{name}: {claim:?}");
        }
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        for claim in [
            Claim(Kernel::LoopClosure),
            Claim(Kernel::ClosePositions),
            Claim(Kernel::CloseVelocities),
            Claim(Kernel::JointAccelerations),
        ] {
            let function = claim.functions()[0];
            let all: Vec<_> = faults(&module)
                .into_iter()
                .filter(|(name, fault)| name == function && (is_unique(claim) || is_of_results(fault)))
                .collect();
            for _ in 0..FAULTS {
                let (_, fault) = &all[random.random_range(0..all.len())];
                let Some(mutant) = apply(&module, function, fault) else { continue };
                // What is stored beyond the state is refused by the reader.
                if mutant.programs[function].places.iter().any(|&place| place >= n_state) {
                    continue;
                }
                count += 1;
                if proves(&decider, &mutant, &[claim])
                    && decider.agree([&module, &mutant], function, SEED) != Some(true)
                {
                    survivors.push(format!("{name}, {function}: {fault:?}"));
                }
            }
        }
    }
    assert!(survivors.is_empty(), "{} of {count}:\n{}", survivors.len(), survivors.join("\n"));
    assert!(count > 6 * FAULTS, "{count} are too few");
}

/// Accelerations by which loops stay closed, but which no force has a part in.
#[test]
fn accelerations_must_balance_forces() {
    let mechanism = four_bar();
    let mut module = mechanism.module();
    let decider = with_decider(&mechanism, &module);
    let equations = module.clone();
    add(&mut module, "joint_accelerations", Vec::new(), |c| {
        let state = c.call(&equations, "to_maximal", |_| None);
        let gamma = c.call(&equations, "gamma", of_state(&state));
        let accelerations = c.call(&equations, "project", |source| match source {
            Source::State(k) => Some(state[k]),
            Source::Change(k) => Some(gamma[k]),
            _ => None,
        });
        c.rates(mechanism.rates, &accelerations)
    });
    assert!(!proves(&decider, &module, &[Claim(Kernel::JointAccelerations)]));
}

/// A row that the coordinates satisfy by themselves closes no loop: with it the rows of J depend on each other.
#[test]
fn closure_rows_must_be_those_that_close_loops() {
    let mechanism = four_bar();
    let mut module = mechanism.module();
    let decider = with_decider(&mechanism, &module);
    module.joints.as_mut().expect("a layout").closure_rows[0] = 0;
    for claim in [Claim(Kernel::ToMaximal), Claim(Kernel::LoopClosure), Claim(Kernel::JointAccelerations)] {
        assert!(!proves(&decider, &module, &[claim]), "{claim:?}");
    }
}

/// Rates that keep loops closed must not be changed, though they would keep them closed in other ways too.
#[test]
fn rates_that_keep_loops_closed_are_kept() {
    let mechanism = four_bar();
    let mut module = mechanism.module();
    let decider = with_decider(&mechanism, &module);
    let u = module.joints.as_ref().expect("a layout").n_coordinates;
    // Rates that are zero keep them closed.
    add(&mut module, "close_velocities", (u..u + mechanism.rates.len()).collect(), |c| {
        let x = c.joint(0);
        let zero = c.push(Node::Sub(x, x));
        vec![zero; mechanism.rates.len()]
    });
    assert!(!proves(&decider, &module, &[Claim(Kernel::CloseVelocities)]));
}
