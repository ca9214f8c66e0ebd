use super::*;
use nalgebra::Rotation3;

fn turned(moments: [f64; 3], mass: f64) -> Inertial {
    let turn = Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    let tensor = Matrix3::from_diagonal(&Vector3::from(moments));
    let pose = IsometryMatrix3::from_parts(nalgebra::Translation3::identity(), turn);
    Inertial { mass, centre: Vector3::zeros(), tensor }.seen(&pose)
}

fn moments(elements: Elements) -> [f64; 3] {
    let mut moments: [f64; 3] = tensor(elements).symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    moments
}

/// Moments, what they become and what is said: of a box, a lamina, one with a rounded digit, one that breaks the
/// triangle inequality by 3 % of the largest, a rod and a point.
#[test]
fn inertias_are_mended_by_as_little_as_makes_them_a_bodys() {
    for (given, expected, remark) in [
        ([1.0, 2.0, 2.5], [1.0, 2.0, 2.5], ""),
        ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], ""),
        ([1.0, 2.0, 3.000_003], [1.0, 2.000_000_000, 3.0], "mended by"),
        ([1.0, 2.0, 3.1], [1.05, 2.05, 3.1], "mended by"),
        ([0.0, 2.0, 2.0], [4e-6, 2.0, 2.0], "a millimetre thick"),
        ([0.0, 0.0, 0.0], [4e-6, 4e-6, 4e-6], "a millimetre thick, a change of 4e-6 kg.m2"),
        ([1e-20, 3e-20, -2e-20], [4e-6, 4e-6, 4e-6], "a millimetre thick"),
    ] {
        let (elements, said) = turned(given, 2.0).elements(false).expect("a body");
        assert!(is_inertia(elements), "{given:?}");
        for (found, expected) in moments(elements).into_iter().zip(expected) {
            assert!((found - expected).abs() < 5e-6, "{given:?}: {found} for {expected}");
        }
        let said = said.unwrap_or_default();
        assert!(said.contains(remark) && said.is_empty() == remark.is_empty(), "{given:?}: {said}");
    }
    for given in [[1.0, 1.0, 3.0], [-0.5, 2.0, 2.0]] {
        let words = turned(given, 2.0).elements(false).expect_err("no body");
        assert!(words.contains("are no body's"), "{words}");
    }
}

#[test]
fn decimals_come_back() {
    assert_eq!(rounded(0.1 + 0.2), 0.3);
    assert_eq!(rounded(0.7 + 0.1), 0.8);
    let aligned = Inertial {
        mass: 1.0,
        centre: Vector3::zeros(),
        tensor: Matrix3::from_diagonal(&Vector3::new(0.7, 0.1, 0.8)),
    };
    assert_eq!(aligned.elements(false).expect("a lamina"), ([0.7, 0.1, 0.8, 0.0, 0.0, 0.0], None));
}
