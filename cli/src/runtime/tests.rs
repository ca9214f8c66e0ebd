use super::*;
use crate::files::tests::Folder;
use std::thread;

#[test]
fn the_sources_are_all_there_and_a_second_look_changes_nothing() {
    let cache = Folder::new();
    let folder = unpacked(&cache.0, ARCHIVE).unwrap();
    for file in ["gyro-sim/src/lib.rs", "runner/Cargo.toml", "Cargo.lock", ".cargo/config.toml"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let vendored = fs::read_dir(folder.join("vendor")).unwrap().count();
    let lock = fs::read_to_string(folder.join("Cargo.lock")).unwrap();
    assert_eq!(vendored, lock.matches("checksum = ").count(), "{lock}");
    fs::write(folder.join("build"), "kept").unwrap();
    assert_eq!(unpacked(&cache.0, ARCHIVE).unwrap(), folder);
    assert_eq!(fs::read_to_string(folder.join("build")).unwrap(), "kept");
}

#[test]
fn many_at_once_unpack_one_folder() {
    let cache = Folder::new();
    let folders: Vec<PathBuf> = thread::scope(|scope| {
        let started: Vec<_> = (0..8).map(|_| scope.spawn(|| unpacked(&cache.0, ARCHIVE).unwrap())).collect();
        started.into_iter().map(|one| one.join().unwrap()).collect()
    });
    assert!(folders.iter().all(|folder| *folder == folders[0]));
    assert_eq!(fs::read_dir(&cache.0).unwrap().count(), 1, "nothing half unpacked is left");
}

#[test]
fn what_nobody_uses_is_forgotten() {
    let cache = Folder::new();
    let (old, recent) = (cache.0.join("0.0.1-old"), cache.0.join("0.0.1-recent"));
    for (folder, age) in [(&old, 2 * FORGOTTEN), (&recent, FORGOTTEN / 2)] {
        fs::create_dir_all(folder).unwrap();
        let mark = File::create(folder.join(MARK)).unwrap();
        mark.set_modified(SystemTime::now() - age).unwrap();
    }
    let own = unpacked(&cache.0, ARCHIVE).unwrap();
    assert!(!old.exists() && recent.exists() && own.exists());
    assert_eq!(versions(&cache.0).len(), 2);
}

#[test]
fn a_damaged_archive_leaves_nothing() {
    let cache = Folder::new();
    assert!(unpacked(&cache.0, &ARCHIVE[..ARCHIVE.len() / 2]).is_err());
    assert_eq!(fs::read_dir(&cache.0).unwrap().count(), 0);
}
