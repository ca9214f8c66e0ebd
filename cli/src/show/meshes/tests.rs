use super::*;
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

fn refused(bytes: &[u8], name: &str) -> String {
    whole(bytes.to_vec(), Path::new(name)).expect_err(name).to_string()
}

#[test]
fn what_a_file_claims_is_looked_at() {
    for nested in [201, 200_000] {
        let text = format!("<COLLADA>{}{}</COLLADA>", "<a>".repeat(nested), "</a>".repeat(nested));
        assert_eq!(refused(text.as_bytes(), "deep.DAE"), "its elements are nested deeper than 200");
    }
    let flat =
        format!("<?xml version=\"1.0\"?><COLLADA><!-- {} -->{}</COLLADA>", "a>b", "<a/><b></b>".repeat(1000));
    assert!(whole(flat.into_bytes(), Path::new("flat.dae")).is_ok());
    let claim = b"<COLLADA><triangles count=\"4000000000\"/></COLLADA>";
    assert_eq!(refused(claim, "many.dae"), "it claims a count of 4000000000, more than it has characters");
    let names = b"<COLLADA><Name_array count=\"1\">a</Name_array></COLLADA>";
    assert_eq!(refused(names, "names.dae"), "<Name_array> is not read: skeletons are no surfaces");

    let binary = |count: u32, triangles: usize| {
        [&[0; 80][..], &count.to_le_bytes(), &vec![0; 50 * triangles]].concat()
    };
    assert_eq!(refused(&binary(u32::MAX, 1), "one.stl"), "it claims 4294967295 triangles and has 1");
    assert_eq!(refused(&binary(3, 2), "two.STL"), "it claims 3 triangles and has 2");
    for (count, triangles) in [(0, 0), (2, 2), (2, 3)] {
        assert!(whole(binary(count, triangles), Path::new("good.stl")).is_ok());
    }
}

/// No file makes the reader panic, or take more than what the file is worth.
#[test]
fn broken_files_are_errors() {
    let folder = std::env::temp_dir().join(format!("gyro-meshes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let pieces = [
        "<COLLADA>",
        "<a>",
        "</a>",
        "<mesh>",
        "<triangles count=\"4000000000\">",
        "<p>0 1 99999999</p>",
        "solid x\n",
        "facet normal 0 0 1\n",
        "vertex 1 2 nan\n",
        "endloop\n",
        "v 1e999 0 0\n",
        "v 0 0 1\n",
        "f 1 2 99999999999\n",
        "f -5 1 1\n",
        "f 1 1 1\n",
        "\0",
    ];
    let mut dice = ChaCha8Rng::seed_from_u64(8);
    for case in 0..400 {
        let path = folder.join(["x.dae", "x.stl", "x.obj", "x.STL"][case % 4]);
        let mut bytes: Vec<u8> = Vec::new();
        (0..dice.random_range(0..40))
            .for_each(|_| bytes.extend(pieces[dice.random_range(0..pieces.len())].bytes()));
        (0..dice.random_range(0..200)).for_each(|_| bytes.push(dice.random()));
        std::fs::write(&path, &bytes).expect("a file");
        let _ = mesh(&path);
    }
    std::fs::remove_dir_all(&folder).expect("the folder is there");
}
