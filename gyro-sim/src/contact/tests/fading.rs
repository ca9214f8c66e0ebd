//! Stops that let go as the push on them fades.

use super::{Mass, Random, fine};
use crate::Dop853;
use crate::contact::{Contact, Hybrid, Phase};

/// At the time at which it lets go no force is left that could tell what is small.
#[test]
fn a_push_that_fades_lets_go_when_it_has_gone() {
    let mut random = Random(5);
    for case in 0..200 {
        let (size, fade) = (random.between(0.1, 10.0), random.between(0.3, 2.0));
        let end = random.between(0.1, 2.0);
        let start = [end, 0.0];
        let stop = Contact::new(0, 1).with_stops([-1e3, end], 0.0).unwrap();
        let push = Mass(|t: f64, _, _| size * libm::sin(1.0 - fade * t));
        let mut mass = Hybrid::new(push, [stop], Dop853::new(&start), 0.0, &start).with_control(fine());
        mass.step_towards(&(), 1e-3).unwrap();
        assert_eq!(mass.phases(), &[Phase::AtUpper], "case {case}");
        while mass.record().released == 0 {
            mass.step_towards(&(), 1.0 / fade + 0.1).unwrap();
            assert!(mass.time() < 1.0 / fade + 0.1, "case {case}");
        }
        assert!((mass.time() - 1.0 / fade).abs() < 1e-12, "case {case}: {} for {}", mass.time(), 1.0 / fade);
    }
}
