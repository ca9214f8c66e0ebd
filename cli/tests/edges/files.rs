//! Files of every kind that is read, changed at random.

use super::{Folder, double, fault, written};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

const HINGE: &str = "format = 1\nname = \"hinge\"\n[simulation]\nt_end = 0.02\nsample_every = 0.01\n[inputs]\nu = 0\n\
    [[body]]\nname = \"wall\"\nfixed = true\n[[body]]\nname = \"rod\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\n\
    [[joint]]\nname = \"h\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = { body = \"wall\" }\n\
    second = { body = \"rod\", point = [0, 0.5, 0] }\nrate = 1\n[[force]]\nname = \"m\"\nkind = \"motor\"\n\
    joint = \"h\"\nvalue = \"u\"\n";

const STUDY: &str = "format = 1\nmodel = \"hinge.toml\"\nrun = { coordinates = \"joint\", tolerance = 1e-6, \
    integrator = \"dop853\", every = 0.01, t_end = 0.02 }\nkeep = { final = [\"h\"], extremes = [\"h\"] }\n\
    scenarios = 2\nseed = 3\nvary = [ { start = \"h\", values = [0.1, 0.2] }, { input = \"u\", uniform = [0, 1] } ]\n";

const OBJ: &str = "o tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 3//1 2//1\nf 1//1 2//1 4//1\n\
    f 2//1 3//1 4//1\nf -4//1 -1//1 -2//1\n";

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
    endfacet\nendsolid a\n";

const DAE: &str = "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" \
    version=\"1.4.1\"><asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis></asset><library_geometries>\
    <geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"f\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array>\
    <technique_common><accessor source=\"#f\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>\
    <param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\
    <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\">\
    <input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>\
    </library_geometries><library_visual_scenes><visual_scene id=\"s\"><node><instance_geometry url=\"#g\"/></node>\
    </visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";

const URDF: &str = "<?xml version=\"1.0\"?>\n<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial>\
    <origin xyz=\"0 0 0.1\" rpy=\"0.1 0 0\"/><mass value=\"2\"/><inertia ixx=\"0.1\" ixy=\"0.01\" ixz=\"0\" iyy=\"0.1\" \
    iyz=\"0\" izz=\"0.1\"/></inertial><visual><geometry><box size=\"1 2 3\"/></geometry></visual></link>\
    <link name=\"c\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>\
    <joint name=\"j\" type=\"revolute\"><origin xyz=\"0 0 1\" rpy=\"0 0 1.5708\"/><axis xyz=\"1 0 0\"/><parent link=\"a\"/>\
    <child link=\"b\"/><limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/><dynamics damping=\"0.1\"/></joint>\
    <joint name=\"k\" type=\"prismatic\"><axis xyz=\"0 0 1\"/><parent link=\"b\"/><child link=\"c\"/>\
    <mimic joint=\"j\" multiplier=\"0.5\" offset=\"0.1\"/><limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/>\
    </joint></robot>\n";

const TABLE: &str = "t,u\n0,0\n0.005,1.5\n0.01,-2e-1\n1,0\n";

/// Bytes with which each of these formats has its troubles.
const TOKENS: [&str; 18] = [
    "<a>",
    "</a>",
    "<!--",
    "]]>",
    "&amp;",
    "&#0;",
    "\"",
    "'",
    "\0",
    "\r\n",
    ",",
    ";",
    "\u{feff}",
    "é",
    "[[",
    "{",
    "= ",
    "count=\"4294967295\"",
];

/// One to four changes.
fn changed(random: &mut ChaCha8Rng, bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..random.random_range(1..=2) {
        let at = random.random_range(0..=bytes.len());
        let end = (at + random.random_range(0..40)).min(bytes.len());
        match random.random_range(0..8) {
            0 => bytes.truncate(at.max(1)),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let again: Vec<u8> = bytes[at..end].repeat(random.random_range(1..300));
                bytes.splice(at..at, again);
            }
            3 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.random_range(0..8)),
            4 => {
                let token = TOKENS[random.random_range(0..TOKENS.len())];
                bytes.splice(at..at, token.repeat(random.random_range(1..3)).into_bytes());
            }
            5 => bytes.iter_mut().skip(at).take(4).for_each(|byte| *byte = random.random()),
            // The next number is another one.
            _ => {
                let Some(from) = bytes[at..].iter().position(u8::is_ascii_digit).map(|k| at + k) else {
                    continue;
                };
                let digits =
                    bytes[from..].iter().take_while(|byte| byte.is_ascii_digit() || **byte == b'.').count();
                bytes.splice(from..from + digits, written(double(random)).into_bytes());
            }
        }
    }
    bytes
}

/// A binary file of triangles.
fn binary() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(2_u32.to_le_bytes());
    for last in [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0_f32]] {
        // The normal, and three corners.
        for number in [[1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], last].as_flattened() {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn files_of_every_kind_are_read_or_refused() {
    let folder = Folder::new("files");
    let meshed = |file: &str| {
        let shape = format!("[[body.shape]]\nmesh = \"{file}\"\n[[joint]]");
        HINGE.replacen("[[joint]]", &shape, 1)
    };
    let how = ["--engine", "jit", "--json", "--quiet", "--budget", "2000"];
    let with_table = [&["simulate", "hinge.toml", "--input", "u=u.csv"], &how[..]].concat();
    let alone = [&["simulate", "hinge.toml"], &how[..]].concat();
    let kinds: [(&str, Vec<u8>, Vec<&str>); 9] = [
        ("hinge.toml", HINGE.into(), alone),
        ("u.csv", TABLE.into(), with_table),
        ("study.toml", STUDY.into(), vec!["sweep", "study.toml", "--out", "out", "--quiet"]),
        ("robot.urdf", URDF.into(), vec!["import", "robot.urdf", "--out", "robot.toml"]),
        ("m.obj", OBJ.into(), vec!["show", "obj.toml", "--out", "page.html"]),
        ("m.stl", STL.into(), vec!["show", "stl.toml", "--out", "page.html"]),
        ("n.stl", binary(), vec!["show", "binary.toml", "--out", "page.html"]),
        ("m.dae", DAE.into(), vec!["show", "dae.toml", "--out", "page.html"]),
        (
            "robot.urdf",
            URDF.into(),
            vec!["import", "robot.urdf", "--density", "500", "--as-written", "--limits"],
        ),
    ];
    let common = [("u.csv", TABLE.to_owned()), ("hinge.toml", HINGE.to_owned())];
    let shaped =
        [("obj.toml", "m.obj"), ("stl.toml", "m.stl"), ("binary.toml", "n.stl"), ("dae.toml", "m.dae")];
    for (kind, (name, whole, args)) in kinds.iter().enumerate() {
        let [mut good, mut refused] = [0; 2];
        for index in 0..41 {
            let mut random = ChaCha8Rng::seed_from_u64(40_080 + kind as u64);
            random.set_stream(index);
            let _ = std::fs::remove_dir_all(&folder.0);
            std::fs::create_dir(&folder.0).unwrap();
            common.iter().for_each(|(name, text)| folder.write(name, text));
            shaped.iter().for_each(|(name, file)| folder.write(name, meshed(file)));
            // The first is as it is, and is good.
            let bytes = if index == 0 { whole.clone() } else { changed(&mut random, whole) };
            folder.write(name, &bytes);
            let before = folder.files();
            let output = folder.gyro(args);
            let told = || format!("{name}, case {index}, {args:?}\n{}", String::from_utf8_lossy(&bytes));
            if let Some(fault) = fault(output.as_ref()) {
                panic!("{fault}\n{}", told());
            }
            let output = output.unwrap();
            let is_good = output.status.success();
            assert!(is_good || index > 0, "{}\n{}", String::from_utf8_lossy(&output.stderr), told());
            if output.status.code() == Some(2) {
                assert_eq!(folder.files(), before, "what is refused leaves nothing: {}", told());
            }
            (good, refused) = (good + u32::from(is_good), refused + u32::from(!is_good));
        }
        println!("{name}, {:?}: {good} read, {refused} refused", args[0]);
    }
}
