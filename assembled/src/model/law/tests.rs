use super::*;

/// Every input is 7, and there are no formulas.
struct Inputs;

impl Read<f64> for Inputs {
    fn value(&self, amount: &Amount<f64>) -> f64 {
        match amount {
            Amount::Constant(value) => *value,
            Amount::Input(_, sign) => 7.0 * sign,
            Amount::Formula(_) => f64::NAN,
        }
    }

    fn slope(&self, _: &Amount<f64>, _: Seen) -> f64 {
        f64::NAN
    }
}

/// By hand from [`gyro_model::ForceKind`], at a coordinate and a rate; a depth of 4 and a softness of 3 have a root
/// of 5.
#[test]
fn laws_are_as_the_page_means_them() {
    let of = Amount::Constant;
    let value = &Inputs;
    let stop = |side, limit| Law::Stop {
        limit: of(limit),
        side,
        stiffness: of(10.0),
        damping: of(2.0),
        softness: of(3.0),
    };
    let (spring, coulomb) =
        (Law::Spring { stiffness: of(2.0), free: of(0.5) }, Law::Coulomb { level: of(0.5), rate: of(2.0) });
    for (law, x, rate, force, potential) in [
        (spring, 1.5, 9.0, -2.0, 1.0),
        (Law::Damper { damping: of(3.0) }, 9.0, -2.0, 6.0, 0.0),
        (coulomb, 9.0, 2.0, -0.5 * 0.761_594_155_955_764_9, 0.0),
        (stop(StopSide::Upper, 1.0), 5.0, 10.0, -45.0 - 18.0, 0.0),
        (stop(StopSide::Upper, 9.0), 5.0, 10.0, -5.0 - 2.0, 0.0),
        (stop(StopSide::Lower, 1.0), -3.0, 10.0, 45.0 - 18.0, 0.0),
        (Law::Motor { value: Amount::Input(0, -1.0) }, 9.0, 9.0, -7.0, 0.0),
    ] {
        assert!((law.force(value, || x, rate) - force).abs() < 1e-14, "{law:?}");
        assert!((law.potential(value, || x) - potential).abs() < 1e-14, "{law:?}");
        assert_eq!(law.is_conservative(), potential != 0.0, "{law:?}");
    }
}
