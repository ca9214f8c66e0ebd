//! What takes long of contacts.

use gyro_sim::contact::{Contact, Forced, Hybrid};
use gyro_sim::{Control, Dop853, Ode};

/// A pendulum of one kilogram and one metre in a field of one newton.
struct Pendulum;

impl Ode for Pendulum {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.forced(model, t, y, &[0.0], dy);
    }
}

impl Forced for Pendulum {
    fn rates(&self, _: &()) -> std::ops::Range<usize> {
        1..2
    }

    fn forced(&self, _: &(), _: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        *dy = [y[1], forces[0] - libm::sin(y[0])];
    }
}

fn energy(y: &[f64; 2]) -> f64 {
    let half = libm::sin(0.5 * y[0]);
    0.5 * y[1] * y[1] + 2.0 * half * half
}

#[test]
#[ignore = "a million impacts, twice: minutes, optimised"]
fn a_million_impacts_of_a_pendulum_keep_what_restitution_leaves() {
    for e in [1.0, 1.0 - 1e-6] {
        let contact = Contact::new(0, 1).with_stops([0.0, f64::INFINITY], e).unwrap();
        let start = [1.0, 0.0];
        let control = Control { budget: u64::MAX, ..Control::default().with_tolerance(1e-15) };
        let mut motion =
            Hybrid::new(Pendulum, [contact], Dop853::new(&start), 0.0, &start).with_control(control);
        while motion.record().impacts < 1_000_000 {
            motion.step_towards(&(), f64::MAX).unwrap();
        }
        let found = energy(motion.state());
        let exact = found / (energy(&start) * libm::exp(2e6 * libm::log(e))) - 1.0;
        let ledger = (found + motion.record().lost) / energy(&start) - 1.0;
        println!("e = {e}: {exact:e} from what restitution leaves, {ledger:e} from the record");
        assert!(exact.abs() < 1e-9 && ledger.abs() < 1e-9);
    }
}
