//! Friction in proportion to reactions that depend on all forces, friction among them.

use super::{Cart, Mass, Random, fine, random_cart};
use crate::contact::Error;
use crate::contact::{Contact, Forced, Hybrid, Phase};
use crate::{Dop853, Kutta4, Ode, Tsit5};
use core::array::from_fn;
use core::ops::Range;

/// A cart with a slider, each in a guide whose reaction follows the state and both forces.
#[derive(Clone, Copy)]
struct Guided {
    cart: Cart,
    bias: [[f64; 3]; 2],
    slopes: [[[f64; 3]; 2]; 2],
}

impl Guided {
    fn reaction(&self, k: usize, y: &[f64; 4], forces: &[f64]) -> [f64; 3] {
        from_fn(|i| {
            let own = self.bias[k][i] * (1.0 + 0.3 * y[k]);
            forces.iter().zip(&self.slopes[k]).fold(own, |sum, (force, slope)| sum + force * slope[i])
        })
    }
}

impl Ode for Guided {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.cart.derivative(model, t, y, dy);
    }
}

impl Forced for Guided {
    const HAS_REACTIONS: bool = true;

    fn rates(&self, model: &()) -> Range<usize> {
        self.cart.rates(model)
    }

    fn forced(&self, model: &(), t: f64, y: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        self.cart.forced(model, t, y, forces, dy);
    }

    fn reactions(&self, (): &(), _: f64, y: &[f64; 4], forces: &[f64], out: &mut [[f64; 3]]) {
        for (k, out) in out.iter_mut().enumerate() {
            *out = self.reaction(k, y, forces);
        }
    }
}

#[test]
fn friction_has_its_level_under_the_reactions_that_it_makes() {
    let mut random = Random(31);
    let (mut caught, mut slipping) = (0, 0);
    for case in 0..20 {
        let (cart, start) = random_cart(&mut random);
        let guided = Guided {
            cart,
            bias: from_fn(|_| from_fn(|_| random.between(-1.0, 1.0))),
            slopes: from_fn(|_| from_fn(|_| from_fn(|_| random.between(-0.5, 0.5)))),
        };
        let friction: [[[f64; 2]; 2]; 2] = from_fn(|_| {
            let [level, coefficient] = [random.between(0.0, 0.4), random.between(0.1, 0.5)];
            let more = random.between(1.0, 1.4);
            [[level, level * more], [coefficient, coefficient * more]]
        });
        let contacts: [Contact<f64>; 2] = from_fn(|k| {
            let [levels, coefficients] = friction[k];
            let contact = Contact::new(k, k + 2).with_friction(levels[0], levels[1]).unwrap();
            let contact = contact.with_loaded_friction(coefficients[0], coefficients[1]).unwrap();
            contact.with_stops([-0.5, 0.5], 0.3).unwrap()
        });
        let mut motion = Hybrid::new(guided, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
        while motion.time() < 3.0 {
            motion.step_towards(&(), 3.0).unwrap();
            let (forces, y) = (motion.forces(&()), *motion.state());
            for (k, phase) in motion.phases().iter().enumerate() {
                let reaction = guided.reaction(k, &y, &forces);
                let load = libm::sqrt(reaction.iter().map(|r| r * r).sum());
                let [levels, coefficients] = friction[k];
                let [kinetic, at_rest] = [0, 1].map(|i| levels[i] + coefficients[i] * load);
                let (rate, force) = (y[k + 2], forces[k]);
                let is = |expected: f64| (force - expected).abs() < 1e-12;
                let bound = at_rest + 1e-9;
                let is_consistent = match phase {
                    Phase::Free => false,
                    Phase::Up => rate >= 0.0 && is(-kinetic),
                    Phase::Down => rate <= 0.0 && is(kinetic),
                    Phase::Sticks => rate == 0.0 && force.abs() <= bound,
                    Phase::AtLower => rate == 0.0 && y[k] == -0.5 && force >= -bound,
                    Phase::AtUpper => rate == 0.0 && y[k] == 0.5 && force <= bound,
                    Phase::Slides => false,
                };
                assert!(is_consistent, "case {case} at {}: {k} {phase:?} {y:?} {forces:?}", motion.time());
                slipping += u32::from(matches!(phase, Phase::Up | Phase::Down));
            }
        }
        caught += motion.record().caught;
        let mut fixed = Hybrid::new(guided, contacts, Kutta4::new(&start), 0.0, &start);
        for _ in 0..15_000 {
            fixed.step(&(), 2e-4).unwrap();
        }
        for k in 0..2 {
            let difference = fixed.state()[k] - motion.state()[k];
            assert!(difference.abs() < 5e-3, "case {case}: {:?} {:?}", fixed.state(), motion.state());
        }
    }
    assert!(caught > 15 && slipping > 500, "{caught} {slipping}");
}

/// A mass in a guide whose reaction follows friction the more, the further it goes: by so much for each metre.
struct Wedged(Mass<fn(f64, f64, f64) -> f64>, f64);

impl Ode for Wedged {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.0.derivative(model, t, y, dy);
    }
}

impl Forced for Wedged {
    const HAS_REACTIONS: bool = true;

    fn rates(&self, model: &()) -> Range<usize> {
        self.0.rates(model)
    }

    fn forced(&self, model: &(), t: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        self.0.forced(model, t, y, forces, dy);
    }

    fn reactions(&self, (): &(), _: f64, y: &[f64; 2], forces: &[f64], out: &mut [[f64; 3]]) {
        out[0] = [9.0 + self.1 * y[0] * forces[0], 0.0, 0.0];
    }
}

#[test]
fn a_motion_into_a_jam_ends_there_by_name() {
    // Half of the friction times the way comes back, at two metres all of it; here friction relieves the guide.
    let contact = Contact::new(0, 1).with_loaded_friction(0.5, 0.5).unwrap();
    let wedged = |by| Wedged(Mass(|_, _, _| 20.0), by);
    let start = [0.0, 100.0];
    let mut motion =
        Hybrid::new(wedged(1.0), [contact], Tsit5::new(&start), 0.0, &start).with_control(fine());
    let error = motion.advance_to(&(), 10.0).unwrap_err();
    let Error::Jammed { t, index: 0, gain } = error else { panic!("{error:?}") };
    let [x, rate] = *motion.state();
    assert!(t == motion.time() && (x - 2.0).abs() < 1e-9 && gain >= 1.0, "{error:?} {x}");
    assert!(rate > 90.0, "{rate}");
    let mut fixed = Hybrid::new(wedged(1.0), [contact], Kutta4::new(&start), 0.0, &start);
    let error = (0..10_000).find_map(|_| fixed.step(&(), 1e-3).err());
    assert!(matches!(error, Some(Error::Jammed { index: 0, .. })), "{error:?}");
    // Where it adds to the load it grows without bound towards the jam, and what is slow enough stops before.
    let start = [0.0, 10.0];
    let mut motion =
        Hybrid::new(wedged(-1.0), [contact], Tsit5::new(&start), 0.0, &start).with_control(fine());
    motion.advance_to(&(), 10.0).unwrap();
    let place = motion.state()[0];
    // ½ v² + 20 x = −9 ln(1 − ½ x)
    let left = 50.0 + 20.0 * place + 9.0 * libm::log(1.0 - 0.5 * place);
    assert!(motion.phases() == &[Phase::Sticks] && left.abs() < 1e-6, "{place}: {left:e}");
}

#[test]
fn coefficients_are_ordered_and_finite() {
    let contact = Contact::new(0, 1);
    for [kinetic, at_rest] in
        [[-0.1, 0.1], [0.2, 0.1], [0.1, f64::INFINITY], [f64::NAN, 0.1], [0.1, f64::NAN]]
    {
        assert_eq!(contact.with_loaded_friction(kinetic, at_rest), None);
    }
}
