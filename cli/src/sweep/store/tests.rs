use super::*;

#[test]
fn two_sweeps_do_not_write_to_one_file() {
    let folder = std::env::temp_dir().join(format!("gyro-store-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let head = Head {
        format: 1,
        name: "s".to_owned(),
        study: String::new(),
        path: "s.toml".to_owned(),
        program: String::new(),
        job: String::new(),
        commit: String::new(),
        seed: 1,
        scenarios: 2,
        block: 1,
        width: 1,
        shard: [0, 1],
    };
    let block = |first| Block { first, count: 1, numbers: vec![0.5], errors: Vec::new() }.encode();
    let mut store = Store::create(&folder, &head).unwrap();
    store.append(&block(0), 1).unwrap();
    let refused = Store::resume(&folder, &head).unwrap_err();
    assert!(refused.words().contains("another sweep writes to"), "{refused:?}");
    drop(store);
    let mut store = Store::resume(&folder, &head).unwrap();
    assert_eq!(store.written, 1);
    store.append(&block(1), 1).unwrap();
    drop(store);
    assert_eq!(Store::resume(&folder, &head).unwrap().written, 2);
    std::fs::remove_dir_all(&folder).unwrap();
}
