use super::super::tests::Random;
use super::*;

#[test]
fn what_contracts_is_solved_and_what_may_jam_is_told() {
    let mut random = Random(29);
    let (mut solved, mut jammed) = (0, 0);
    for case in 0..20_000 {
        let size_of_slopes = random.between(0.0, 4.0);
        let growth = Growth::<f64, 3> {
            coefficients: from_fn(|_| {
                if random.between(0.0, 1.0) < 0.2 { 0.0 } else { random.between(0.0, 1.0) }
            }),
            loads: from_fn(|_| from_fn(|_| random.between(-1.0, 1.0))),
            slopes: from_fn(|_| from_fn(|_| from_fn(|_| size_of_slopes * random.between(-1.0, 1.0)))),
        };
        let gains: [[f64; 3]; 3] =
            from_fn(|k| from_fn(|j| growth.coefficients[k] * size(&growth.slopes[k][j])));
        // The spectral radius by powers of the matrix.
        let mut vector = [1.0; 3];
        let mut radius = 0.0;
        for _ in 0..400 {
            let next: [f64; 3] = from_fn(|k| (0..3).map(|j| gains[k][j] * vector[j]).sum::<f64>() + 1e-300);
            radius = next.iter().copied().fold(0.0, f64::max);
            vector = next.map(|x| x / radius);
        }
        match growth.magnitudes() {
            Ok(found) => {
                solved += 1;
                assert!(radius < 1.0 + 1e-9, "case {case}: {radius}");
                for k in 0..3 {
                    let reaction: [f64; 3] = from_fn(|i| {
                        growth.loads[k][i] + (0..3).map(|j| growth.slopes[k][j][i] * found[j]).sum::<f64>()
                    });
                    let error = found[k] - growth.coefficients[k] * size(&reaction);
                    let largest = found.iter().copied().fold(1.0, f64::max);
                    assert!(found[k] >= 0.0 && error.abs() < 1e-12 * largest, "case {case}: {error:e}");
                }
            }
            Err(jam) => {
                jammed += 1;
                assert!(radius > 1.0 - 1e-9 && jam.gain >= radius - 1e-9, "case {case}: {radius} {jam:?}");
            }
        }
    }
    assert!(solved > 5000 && jammed > 5000, "{solved} {jammed}");
}
