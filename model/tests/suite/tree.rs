//! Trees of bodies: their order, what closes loops, what only rods hold; and starts with driven coordinates.

use std::fmt::Write as _;

use gyro_model::{
    Attachment, CoordinateUse, Driver, JointCoordinate, Kinematics, Model, Motion, Number, Rational, Tree,
    analyse, read,
};

/// A model file of so many moving bodies on the ground, body 0, and joints of kinds between bodies.
fn page(n_bodies: usize, joints: &[(&str, [usize; 2])]) -> Model {
    let mut page = "format = 1\nname = \"graph\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
    for body in 1..=n_bodies {
        let _ = writeln!(page, "[[body]]\nname = \"b{body}\"\nmass = 1\ninertia = [1, 1, 1]");
    }
    for (index, (kind, [first, second])) in joints.iter().enumerate() {
        let frame = match *kind {
            "spherical" | "rod" => "",
            "point_on_line" => ", axis = [0, 0, 1], zero = [1, 0, 0]",
            _ => "axis = [0, 0, 1]\nzero = [1, 0, 0]\n",
        };
        let (shared, own) = if frame.starts_with(',') { ("", frame) } else { (frame, "") };
        let more = match *kind {
            "rod" => "length = 1\n",
            "screw" => "lead = 0.01\n",
            _ => "",
        };
        let point = if *kind == "rod" { ", point = [1, 0, 0]" } else { "" };
        let _ = writeln!(
            page,
            "[[joint]]\nname = \"j{index}\"\nkind = \"{kind}\"\n{shared}{more}first = {{ body = \"b{first}\"{own} }}\n\
             second = {{ body = \"b{second}\"{point} }}"
        );
    }
    read("graph", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn order(tree: &Tree) -> Vec<(usize, Option<usize>)> {
    let joint = |attachment| match attachment {
        Attachment::Joint { joint, .. } => Some(joint),
        Attachment::Free | Attachment::Constrained => None,
    };
    tree.links.iter().map(|link| (link.body, joint(link.attachment))).collect()
}

#[test]
fn joints_are_followed_breadth_first_in_the_order_of_the_page() {
    let model = page(3, &[("revolute", [1, 2]), ("spherical", [3, 0]), ("cylindrical", [0, 1])]);
    let tree = Tree::of(&model);
    assert_eq!(order(&tree), [(3, Some(1)), (1, Some(2)), (2, Some(0))]);
    assert!(tree.is_open());
    assert!(matches!(tree.links[0].attachment, Attachment::Joint { reversed: true, parent: 0, .. }));
}

#[test]
fn a_point_on_a_line_carries_only_what_nothing_else_does() {
    let model = page(2, &[("point_on_line", [0, 2]), ("spherical", [0, 1]), ("universal", [1, 2])]);
    let tree = Tree::of(&model);
    assert_eq!(order(&tree), [(1, Some(1)), (2, Some(2))]);
    assert_eq!(tree.loop_joints, [0]);
    let model = page(2, &[("point_on_line", [0, 2]), ("spherical", [0, 1])]);
    assert_eq!(order(&Tree::of(&model)), [(1, Some(1)), (2, Some(0))]);
    assert!(Tree::of(&model).is_open());
}

#[test]
fn bodies_on_rods_float_and_carry_others() {
    let model = page(3, &[("rod", [0, 3]), ("rod", [0, 2]), ("revolute", [2, 3]), ("spherical", [0, 1])]);
    let tree = Tree::of(&model);
    assert_eq!(order(&tree), [(1, Some(3)), (2, None), (3, Some(2))]);
    assert_eq!((tree.floating.clone(), tree.loop_joints.clone()), (vec![2], vec![0, 1]));
    assert!(tree.unreached.is_empty() && !tree.is_open());
}

/// Charts are counted along the tree, by all who read it: friction changes which joint of a loop is cut, and nothing
/// where none is.
#[test]
fn an_open_tree_is_the_same_whatever_acts_on_its_joints() {
    let mut model = page(3, &[("revolute", [0, 1]), ("revolute", [0, 2]), ("revolute", [3, 1])]);
    model.joints[2].damping = model.bodies[1].mass.clone();
    assert_eq!(model.use_of_coordinates(2), CoordinateUse::Rate);
    assert_eq!(order(&Tree::of_coordinates(&model)), order(&Tree::of(&model)));
    assert_eq!(order(&Tree::of(&model)), [(1, Some(0)), (2, Some(1)), (3, Some(2))]);
}

/// A body hangs on what is nearest to the root; a screw is cut where one angle of the tree says how far it has turned,
/// and else stays in the tree.
#[test]
fn a_nut_hangs_on_its_guide() {
    let cut = |joints: &[(&str, [usize; 2])], n| {
        let mut model = page(n, joints);
        model.joints[0].damping = model.bodies[1].mass.clone();
        Tree::of_coordinates(&model).loop_joints
    };
    let rail = [("revolute", [0, 1]), ("revolute", [1, 2]), ("prismatic", [0, 2])];
    assert_eq!(cut(&rail, 2), [1]);
    let press = [("revolute", [0, 1]), ("screw", [1, 2]), ("prismatic", [0, 2])];
    assert_eq!(cut(&press, 2), [1]);
    let arm = [("revolute", [0, 1]), ("revolute", [1, 2]), ("screw", [2, 3]), ("prismatic", [0, 3])];
    assert!(!cut(&arm, 3).contains(&2));
}

/// Of the joints of a loop one is cut of whose coordinates least is asked, and of these one with many freedoms.
#[test]
fn forces_are_kept_off_the_joint_that_is_cut() {
    let mut model = page(
        3,
        &[("revolute", [0, 1]), ("cylindrical", [1, 2]), ("spherical", [2, 3]), ("revolute", [0, 3])],
    );
    let cut = |model: &Model| Tree::of_coordinates(model).loop_joints;
    assert_eq!(cut(&model), [2]);
    model.joints[2].damping = model.bodies[1].mass.clone();
    assert_eq!(cut(&model), [1]);
    (0..4).for_each(|joint| model.joints[joint].damping = model.bodies[1].mass.clone());
    assert_eq!(cut(&model), [2]);
}

/// Each coordinate of each kind, driven alone in an open tree: it starts where its driver is and moves as it does.
#[test]
fn driven_coordinates_of_trees_start_with_their_drivers() {
    for kind in ["revolute", "universal", "cylindrical", "prismatic", "planar", "screw", "point_on_line"] {
        let mut model = page(2, &[(kind, [1, 0]), ("revolute", [1, 2])]);
        if kind == "universal" {
            model.joints[0].second.axis = model.joints[0].first.zero.clone();
            model.joints[0].second.zero = model.joints[0].first.axis.clone();
        }
        for coordinate in 0..model.joints[0].kind.coordinates().len() {
            let mut driven = model.clone();
            let number = |x: f64| Number::Exact(Rational::from_float(x).expect("finite"));
            let motion = Motion::Polynomial(vec![number(8.25), number(-0.5), number(3.0)]);
            let coordinate = JointCoordinate { joint: 0, coordinate };
            driven.drivers.push(Driver { name: "drive".to_owned(), coordinate, motion });
            let start = driven.assemble().unwrap_or_else(|error| panic!("{kind}: {error}"));
            assert_eq!(start.joints[0].position[coordinate.coordinate], 8.25, "{kind}");
            assert_eq!(start.joints[0].rate[coordinate.coordinate], -0.5, "{kind}");
            let kinematics = Kinematics::at(&driven, 0.0);
            let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
            assert!(kinematics.phi(&start.q, &near).amax() <= 1e-14, "{kind}");
            let v = nalgebra::DVector::from_column_slice(&start.v);
            let rate = kinematics.jacobian(&start.q, &near) * v - kinematics.nu(&start.q, &near);
            assert!(rate.amax() <= 1e-14, "{kind}: {rate}");
            let analysis = analyse(&driven).expect("a mechanism");
            assert_eq!(
                (analysis.redundant.len(), analysis.degrees_of_freedom),
                (0, model_freedom(&model) - 1)
            );
        }
    }
}

fn model_freedom(model: &Model) -> usize {
    analyse(model).expect("a mechanism").degrees_of_freedom
}

/// What three legs carry floats; two legs, or three of which one does not slide, carry it as other joints do.
#[test]
fn a_platform_on_legs_floats() {
    let legs = |n: usize| {
        let mut joints = Vec::new();
        for leg in 0..n {
            let (cylinder, piston) = (2 + 2 * leg, 3 + 2 * leg);
            joints.push(("universal", [0, cylinder]));
            joints.push(("prismatic", [cylinder, piston]));
            joints.push(("spherical", [piston, 1]));
        }
        page(1 + 2 * n, &joints)
    };
    let floating = |model: &Model| Tree::of_coordinates(model).floating;
    assert_eq!(floating(&legs(3)), [1]);
    assert_eq!(Tree::of_coordinates(&legs(3)).loop_joints, [2, 5, 8]);
    assert!(floating(&legs(2)).is_empty());
    assert!(Tree::of(&legs(3)).floating.is_empty());
    let mut welded = legs(3);
    welded.joints[4].kind = gyro_model::JointKind::Fixed;
    assert!(floating(&welded).is_empty());
}
