use super::*;
use crate::files::tests::Folder;

const ALL: [Known; 3] = [Known::Place, Known::Mark("// ours"), Known::Record];

fn refusal(outcome: Result<bool, Failure>) -> String {
    match outcome {
        Err(Failure::Usage(words)) => words,
        other => panic!("{other:?}"),
    }
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_file_is_written_once_and_leaves_no_neighbour() {
    for known in ALL {
        let folder = Folder::new();
        let path = folder.0.join("x.rs");
        assert!(write(&path, "// ours, one", known).unwrap());
        assert!(!write(&path, "// ours, one", known).unwrap());
        assert!(write(&path, "// ours, two", known).unwrap());
        assert_eq!(text(&path), "// ours, two");
        let hidden = usize::from(known == Known::Record);
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1 + hidden, "{known:?}");
    }
}

#[test]
fn what_somebody_else_wrote_stays() {
    for known in &ALL[1..] {
        let folder = Folder::new();
        let path = folder.0.join("x.csv");
        fs::write(&path, "mine").unwrap();
        assert!(refusal(write(&path, "// ours", *known)).contains("--out"), "{known:?}");
        assert_eq!(text(&path), "mine");
        fs::write(&path, "").unwrap();
        assert!(write(&path, "// ours", *known).unwrap(), "nothing is lost with an empty file");
    }
}

#[test]
fn what_was_edited_since_stays() {
    let folder = Folder::new();
    let path = folder.0.join("x.csv");
    write(&path, "t,x\n", Known::Record).unwrap();
    fs::write(&path, "t,x\n1,2\n").unwrap();
    assert!(refusal(write(&path, "t,y\n", Known::Record)).contains("not as this tool has written it"));
    remove(&path);
    assert_eq!(text(&path), "t,x\n1,2\n");
    fs::write(&path, "t,x\n").unwrap();
    remove(&path);
    assert!(!path.exists());
}

#[test]
fn inputs_stay_under_all_their_names() {
    let folder = Folder::new();
    let input = folder.0.join("input.csv");
    write(&input, "// ours", Known::Record).unwrap();
    note_input(&input);
    let mut names = vec![input.clone(), folder.0.join(".").join("input.csv")];
    let up = folder.0.join("..").join(folder.0.file_name().unwrap()).join("input.csv");
    names.push(up);
    #[cfg(unix)]
    {
        for name in ["soft.csv", "hard.csv"] {
            names.push(folder.0.join(name));
        }
        std::os::unix::fs::symlink(&input, folder.0.join("soft.csv")).unwrap();
        fs::hard_link(&input, folder.0.join("hard.csv")).unwrap();
    }
    for (name, known) in names.iter().flat_map(|name| ALL.map(|known| (name, known))) {
        assert!(refusal(write(name, "new", known)).contains("read by this run"), "{}", name.display());
    }
    assert_eq!(text(&input), "// ours");
}

#[test]
#[cfg(unix)]
fn links_are_followed_and_what_is_no_file_is_refused() {
    let folder = Folder::new();
    let (target, link) = (folder.0.join("target.rs"), folder.0.join("link.rs"));
    fs::write(&target, "// ours, one").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    assert!(write(&link, "// ours, two", Known::Mark("// ours")).unwrap());
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(text(&target), "// ours, two");
    fs::remove_file(&target).unwrap();
    assert!(refusal(write(&link, "x", Known::Place)).contains("leads nowhere"));
    for (path, known) in [&folder.0, Path::new("/dev/null")].into_iter().flat_map(|p| ALL.map(|k| (p, k))) {
        assert!(refusal(write(path, "x", known)).contains("no ordinary file"));
    }
}
