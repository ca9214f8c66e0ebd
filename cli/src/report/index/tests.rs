use super::*;
use crate::files::tests::Folder;

#[test]
fn pages_that_are_there_are_linked() {
    let row = |name: &str| [name, "", "", "", "", "", "", "1", "0"].map(str::to_owned).to_vec();
    let rows = || vec![row("gyroscope"), row("torsion")];
    let all = page(rows(), Vec::new(), "m", false).markdown();
    assert!(all.contains("[torsion](torsion.md)") && !all.contains("out/report"), "{all}");
    let some = page(rows(), Vec::new(), "m", true).markdown();
    assert!(some.contains("| gyroscope |") && some.contains("| torsion |"), "{some}");
    assert!(some.contains("`out/report`") && !some.contains("](torsion.md)"), "{some}");
}

#[test]
fn a_scene_s_rows_are_replaced_and_others_kept() {
    let folder = Folder::new();
    let path = folder.0.join("x.csv");
    let rows = |list: &[(&str, &str)]| {
        list.iter().map(|(a, b)| vec![(*a).to_owned(), (*b).to_owned()]).collect::<Vec<_>>()
    };
    merged(&path, &["scene", "value"], "b", rows(&[("b", "1"), ("b", "2")])).unwrap();
    merged(&path, &["scene", "value"], "a", rows(&[("a", "3")])).unwrap();
    let found = merged(&path, &["scene", "value"], "b", rows(&[("b", "4, 5")])).unwrap();
    assert_eq!(found, rows(&[("a", "3"), ("b", "4, 5")]));
    // Another head is another version.
    assert_eq!(merged(&path, &["scene", "x", "y"], "c", vec![]).unwrap().len(), 0);
}
