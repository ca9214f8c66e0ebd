use super::*;
use gyro_mechanisms::heavy_top::HeavyTop;
use gyro_sim::{ByDuals, Jacobian, Joint};

type Duals = HeavyTop<Dual<f64, COLUMNS>>;

/// A top has no loop to reduce by, but an orientation: A by turns and rates against differences along turns.
#[test]
fn orientations_are_linearised_by_turns() {
    let (top, duals) = (HeavyTop::<f64>::default(), Duals::default());
    let p = [0.5, -0.1, 0.7, (1.0_f64 - 0.25 - 0.01 - 0.49).sqrt()];
    let x = [p[0], p[1], p[2], p[3], 0.3, -2.0, 5.0];
    let (mut by_state, mut by_time, mut slope) = (vec![0.0; 49], x, x);
    top.joint_derivative(0.0, &x, &mut slope);
    let form: ByDuals<_, _, _, Vec<f64>, COLUMNS> = ByDuals::new(Joint, duals, duals.joint_start());
    form.jacobian(&top, 0.0, &x, &mut by_state, &mut by_time);
    let all = Linear { state: x.to_vec(), slope: slope.to_vec(), by_state, ..Linear::default() };
    let found = reduced(&top, &duals, &x, &all);
    let place = JointPlace::Orientation { joint: 0 };
    assert_eq!(found.elements[2], Element::Turn { place, component: 2 });
    assert_eq!(found.elements[3], Element::Rate { place, component: 0 });
    assert_eq!(found.state, [0.0, 0.0, 0.0, 0.3, -2.0, 5.0]);
    // Turned by twice the vector's length, to second order, then as fast as these rates say.
    let moved = |z: &[f64; 6]| {
        let [a, b, c] = [z[0] / 2.0, z[1] / 2.0, z[2] / 2.0];
        let w = (1.0 - a * a - b * b - c * c).sqrt();
        [
            p[0] * w - p[1] * a - p[2] * b - p[3] * c,
            p[1] * w + p[0] * a - p[3] * b + p[2] * c,
            p[2] * w + p[3] * a + p[0] * b - p[1] * c,
            p[3] * w - p[2] * a + p[1] * b + p[0] * c,
            x[4] + z[3],
            x[5] + z[4],
            x[6] + z[5],
        ]
    };
    // The rate of the vector 2 Im(p̄₀ p), and the rates' rates.
    let slopes = |z: &[f64; 6]| {
        let mut d = x;
        top.joint_derivative(0.0, &moved(z), &mut d);
        [
            2.0 * (p[0] * d[1] - p[1] * d[0] - p[2] * d[3] + p[3] * d[2]),
            2.0 * (p[0] * d[2] - p[2] * d[0] - p[3] * d[1] + p[1] * d[3]),
            2.0 * (p[0] * d[3] - p[3] * d[0] - p[1] * d[2] + p[2] * d[1]),
            d[4],
            d[5],
            d[6],
        ]
    };
    let here = slopes(&[0.0; 6]);
    for (k, (slope, here)) in found.slope.iter().zip(here).enumerate() {
        assert!((slope - here).abs() < 1e-12, "{k}: {found:?}");
        let along = |step: f64| slopes(&core::array::from_fn(|l| if l == k { step } else { 0.0 }));
        let [far, near, beyond, past] = [-2e-3, -1e-3, 1e-3, 2e-3].map(along);
        for row in 0..6 {
            let expected = (8.0 * (beyond[row] - near[row]) - (past[row] - far[row])) / 12e-3;
            let error = found.by_state[6 * row + k] - expected;
            assert!(error.abs() < 1e-8 * expected.abs().max(1.0), "{row} {k}: {error:e}");
        }
    }
}
