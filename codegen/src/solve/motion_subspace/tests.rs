use super::*;
use crate::expr::definitions::Expansion;
use crate::expr::evaluate::{evaluate, random_state};
use crate::solve::articulated_body::Arm;

/// Products of a dozen numbers of order one.
const ROUNDING: f64 = 1e-12;

/// Two bodies one after the other, so that the second hangs on a parent that moves.
fn page(kind: &str, reversed: bool) -> String {
    let (first, second) = if reversed { ("b", "a") } else { ("a", "b") };
    let frame = if kind == "spherical" { "" } else { "axis = [1, 2, 2]\nzero = [0, 1, 0]" };
    let more = if kind == "screw" { "lead = 0.1" } else { "" };
    format!(
        "format = 1\nname = \"chain\"\n[[body]]\nname = \"a\"\nfree = true\nmass = 1\ninertia = [1, 1, 1]\n\
         [[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\n\
         [[joint]]\nname = \"j\"\nkind = \"{kind}\"\n{frame}\n{more}\n\
         first = {{ body = \"{first}\", point = [0.1, 0.2, 0.3] }}\nsecond = {{ body = \"{second}\", point = [0.3, -0.1, 0.2] }}\n"
    )
}

/// Free twists leave every row unchanged, each forced twist changes its own row alone, whatever the state.
fn check(kind: &str, reversed: bool) {
    let text = page(kind, reversed);
    let model = gyro_model::read("chain.toml", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let mut system = System::new(&model);
    let kinematics = Kinematics::derive(&mut system);
    let link = system.tree.links.iter().copied().find(|link| link.body == 1).expect("b hangs on a");
    let subspace = MotionSubspace::of(&mut system, &kinematics, link);
    assert_eq!(subspace.free.len() + subspace.forced.len(), 6, "{kind}");
    let arm = Arm::on_body(&mut system.graph, &subspace);
    let mut changes = Vec::new();
    for twist in subspace.free.iter().chain(&subspace.forced) {
        let centre = arm.twist(&mut system.graph, twist);
        for row in subspace.rows.clone() {
            let columns = &kinematics.phi_pi[row][6 * subspace.moving_body..6 * subspace.moving_body + 6];
            let gradient = SpatialVector {
                t: [columns[0], columns[1], columns[2]],
                rho: [columns[3], columns[4], columns[5]],
            };
            changes.push(gradient.dot(&mut system.graph, &centre));
        }
    }
    let changes = Expansion::new(&system.definitions).all(&mut system.graph, &changes);
    for seed in 0..10 {
        let values = evaluate(&system.graph, &changes, random_state(seed));
        for (index, value) in values.into_iter().enumerate() {
            let (twist, row) = (index / subspace.rows.len(), index % subspace.rows.len());
            let expected = if twist == subspace.free.len() + row { 1.0 } else { 0.0 };
            assert!(
                (value - expected).abs() <= ROUNDING,
                "{kind} {reversed} twist {twist} row {row}: {value}"
            );
        }
    }
}

#[test]
fn free_and_forced_twists_are_dual_to_the_rows_off_the_constraints() {
    let kinds = [
        "revolute",
        "spherical",
        "fixed",
        "universal",
        "cylindrical",
        "prismatic",
        "planar",
        "screw",
        "point_on_line",
    ];
    for kind in kinds {
        check(kind, false);
        check(kind, true);
    }
}
