use super::*;

fn shown(name: &str) -> String {
    let path = crate::files::root().join("models").join(name);
    let model = scene::read(&path).unwrap_or_else(|failure| panic!("{}", failure.words()));
    let start = model.assemble().expect("a start");
    head(&model) + &skeleton(&model, &start) + &closure(&model, &start)
}

#[test]
fn a_loop_is_drawn_as_a_tree_and_what_closes_it() {
    let text = shown("four-bar-revolute.toml");
    assert!(
        text.contains("4 bodies, 3 with coordinates, 4 joints, 1 closed loop, 1 degree of freedom"),
        "{text}"
    );
    assert_eq!(text.matches("(revolute").count(), 4, "{text}");
    assert!(text.contains("closes a loop") && text.contains("3 constraint rows dropped"), "{text}");
    let text = shown("gyroscope.toml");
    assert!(text.contains("   └─ "), "{text}");
}

#[test]
fn every_model_is_sketched() {
    for path in crate::places::listing(&crate::files::root().join("models")).expect("models") {
        if path.extension().is_some_and(|extension| extension == "toml") {
            let model = scene::read(&path).unwrap_or_else(|failure| panic!("{}", failure.words()));
            let picture = sketch::svg(&model, &model.assemble().expect("a start")).expect("a picture");
            let names = model.joints.iter().map(|joint| joint.name.as_str());
            let names: Vec<&str> = names.filter(|name| !picture.contains(name)).collect();
            assert!(picture.contains(sketch::MARK) && names.is_empty(), "{}: {names:?}", path.display());
        }
    }
}
