//! Random studies: in whatever parts, blocks and lanes they run, and whenever they are killed, the bytes are the same.
//!
//! They compile two programs, so they are run by themselves: `cargo test --package gyro-cli --test sweep_random --
//! --ignored`. `GYRO_STUDIES=100` runs more of them. Results name the commit, and whether files have changed since:
//! none may change while they run.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Numbers that look random, from a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[usize::try_from(self.below(of.len() as u64)).unwrap()]
    }

    fn is(&mut self) -> bool {
        self.below(2) == 0
    }
}

/// Names of files as people give them.
const NAMES: [&str; 10] = [
    "study",
    "a study",
    "étude",
    "100 %",
    "it's",
    "quo\"ted",
    "-dash",
    "#hash, comma",
    "{braces}",
    "a\nline",
];

/// The text of a study of `models/gyroscope-misalignments.toml`.
fn study(random: &mut Random) -> String {
    let is_whole = random.below(4) == 0;
    let most = if is_whole { 6 } else { 60 };
    let mut text = format!("scenarios = {}\nseed = {}\n", 1 + random.below(most), random.next());
    let _ = writeln!(text, "block = {}", 1 + random.below(40));
    let mut has_grid = random.is();
    if random.is() {
        has_grid = false;
        text += "sampling = \"saltelli\"\n";
    } else if random.is() {
        text += "sampling = \"sobol\"\n";
    }
    let how = match (is_whole, random.below(3)) {
        // In maximal coordinates there are no lanes.
        (true, _) => "coordinates = \"maximal\", step = 1e-3",
        (_, 0) => "coordinates = \"joint\", step = 2e-4",
        (_, 1) => "coordinates = \"joint\", tolerance = 1e-6, integrator = \"tsit5\"",
        _ => "coordinates = \"joint\", tolerance = 1e-6, integrator = \"dop853\", budget = 40",
    };
    let _ = writeln!(text, "run = {{ {how}, t_end = 0.02, every = 0.005 }}");
    let mut kept = vec!["final = [\"alpha\", \"beta rate\"]"];
    let others = [
        "extremes = \"beta\"",
        "passages = [{ of = \"beta\", below = -1e-5 }, { of = \"alpha\", above = 9 }]",
        "quantiles = [\"alpha\"]",
        "series = [\"beta\", \"phi\"]",
    ];
    kept.extend(others.into_iter().filter(|_| random.is()));
    if !is_whole && random.below(4) == 0 {
        kept.push("sensitivities = true");
    }
    let _ = writeln!(text, "[keep]\n{}", kept.join("\n"));
    let draws = [
        "parameter = [\"offset_x\", \"offset_y\"]\nwithin = 2e-5",
        // Some of these are of no rotor.
        "parameter = \"product_xy\"\nnormal = [0, 4e-6]\ntruncated = [-3e-5, 3e-5]",
        "parameter = [\"imbalance_y\", \"imbalance_z\"]\ncovariance = [[1e-12, 2e-13], [2e-13, 1e-12]]",
        "start = \"beta\"\nuniform = [-0.1, 0.1]",
        "start = \"phi rate\"\nlog_uniform = [50, 150]",
    ];
    let mut is_drawn = false;
    for draw in draws {
        if random.is() {
            is_drawn = true;
            let _ = writeln!(text, "[[vary]]\n{draw}");
        }
    }
    if !is_drawn {
        let _ = writeln!(text, "[[vary]]\nparameter = \"offset_z\"\nwithin = 1e-5");
    }
    if has_grid {
        let grid =
            random.one(&["values = [0, 0.05, 0.1]", "grid = [-0.1, 0.1, 2]", "log_grid = [1e-3, 1e-1, 4]"]);
        let _ = writeln!(text, "[[vary]]\nstart = \"alpha\"\n{grid}");
    }
    text
}

fn gyro() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
    command.args(["--quiet", "sweep"]).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn ran(command: &mut Command, what: &str) {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}\n{what}", String::from_utf8_lossy(&output.stderr));
}

/// The files of a folder, the hidden record left out.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_hidden = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with('.');
    let mut files: Vec<_> = entries
        .filter(|path| !is_hidden(path))
        .map(|path| (path.file_name().unwrap().into(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

fn same(one: &Path, other: &Path, what: &str) {
    let (one, other) = (files(one), files(other));
    assert_eq!(one.iter().map(|f| &f.0).collect::<Vec<_>>(), other.iter().map(|f| &f.0).collect::<Vec<_>>());
    for ((name, one), (_, other)) in one.iter().zip(&other) {
        assert!(one == other, "{} differs\n{what}", name.display());
    }
}

/// Lines of a table that are not comments have all as many cells.
fn is_a_table(path: &Path, what: &str) {
    let text = fs::read_to_string(path).unwrap();
    let body: String =
        text.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect();
    let mut widths = Vec::new();
    for line in body.lines() {
        let mut is_quoted = false;
        let commas = line.chars().filter(|c| {
            is_quoted ^= *c == '"';
            *c == ',' && !is_quoted
        });
        widths.push(commas.count());
    }
    assert!(widths.len() > 1 && widths.iter().all(|width| *width == widths[0]), "{widths:?}\n{what}");
}

#[test]
#[ignore = "compiles programs"]
fn whatever_runs_them_the_bytes_are_the_same() {
    let studies = std::env::var("GYRO_STUDIES").map_or(12, |n| n.parse().unwrap());
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/gyroscope-misalignments.toml");
    for seed in 0..studies {
        let mut random = Random(seed);
        random.next();
        let folder = std::env::temp_dir().join(format!("gyro-random-{}-{seed}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join(format!("{}.toml", random.one(&NAMES)));
        let text = format!("format = 1\nmodel = {:?}\n{}", model.to_str().unwrap(), study(&mut random));
        let what = format!("study {seed}, {path:?}:\n{text}");
        fs::write(&path, &text).unwrap();
        let sweep = |threads: u64, out: &str| {
            let mut command = gyro();
            command.arg(&path).args(["--threads", &threads.to_string(), "--out"]).arg(folder.join(out));
            command
        };
        ran(&mut sweep(1, "one"), &what);
        is_a_table(&folder.join("one/scenarios.csv"), &what);
        ran(sweep(2 + random.below(5), "many").args(["--engine", "generated"]), &what);
        same(&folder.join("one"), &folder.join("many"), &what);
        let parts = 2 + random.below(6);
        let names: Vec<PathBuf> = (1..=parts).map(|k| folder.join(format!("part {k}"))).collect();
        for (k, part) in (1..).zip(&names) {
            let mut command = gyro();
            ran(command.arg(&path).args(["--shard", &format!("{k}/{parts}"), "--out"]).arg(part), &what);
        }
        ran(gyro().arg("merge").args(&names).arg("--out").arg(folder.join("merged")), &what);
        same(&folder.join("one"), &folder.join("merged"), &what);
        for _ in 0..3 {
            let mut child = sweep(2, "killed").arg("--resume").stderr(Stdio::null()).spawn().unwrap();
            std::thread::sleep(Duration::from_millis(random.below(1500)));
            let _ = child.kill();
            child.wait().unwrap();
        }
        ran(sweep(1, "killed").arg("--resume"), &what);
        same(&folder.join("one"), &folder.join("killed"), &what);
        fs::remove_dir_all(&folder).unwrap();
    }
}
