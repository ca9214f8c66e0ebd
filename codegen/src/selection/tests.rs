use super::*;

#[test]
fn names_bring_their_group_and_what_it_needs() {
    let named = |names: &[&str]| Functions::named(names.iter().copied()).expect("known names");
    assert!(!named(&[]).has(Group::Joint));
    for name in ["joint", "joint_accelerations", "to_maximal", "corrected_accelerations"] {
        assert!(named(&[name]).has(Group::Joint) && !named(&[name]).has(Group::Jacobian), "{name}");
    }
    assert!(named(&["joint_jacobian"]).has(Group::Joint));
    assert_eq!(named(&["joint", "all"]), Functions::all());
    assert_eq!(named(&["corrected_multipliers"]), named(&["joint", "corrected", "reactions"]));
    assert_eq!(Functions::all().without(Group::Joint), named(&["maximal", "projection", "partition"]));
    assert_eq!(named(&["phi", "outputs"]), named(&[]));
    for group in Group::all() {
        let needed = Functions::of([group]);
        assert!(Group::all().filter(|&g| needed.has(g)).all(|g| Functions::of([g]).has(Group::Mechanism)));
        let closed = Group::all().filter(|&g| needed.has(g)).flat_map(Group::with_needs);
        assert_eq!(Functions::of(closed), needed, "{group:?} brings all that it needs");
    }
}

#[test]
fn unknown_names_are_met_with_the_known_ones() {
    let words = |name: &str| Functions::named([name]).expect_err("an unknown name").to_string();
    let found = words("joint_acelerations");
    assert!(found.contains("did you mean `joint_accelerations`?"), "{found}");
    assert!(words("jacobians").contains("did you mean `jacobian`?"));
    let found = words("xyz");
    assert!(!found.contains("did you mean"), "{found}");
    assert!(
        found.contains("derivatives, regressor, solvers, all") && found.contains("newton_step"),
        "{found}"
    );
}
