//! Sweeps by the program itself: whatever runs them, and however often they are interrupted, their bytes are the same.
//!
//! They compile programs, so they are run by themselves: `cargo test --package gyro-cli --test sweep -- --ignored`.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "sweep/contacts.rs"]
mod contacts;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// A folder that goes with its test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("gyro-sweep-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A study of a model of the workspace.
    fn study(&self, model: &str, text: &str) -> PathBuf {
        let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(model);
        let path = self.0.join("study.toml");
        fs::write(&path, format!("format = 1\nmodel = {:?}\n{text}", model.to_str().unwrap())).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn gyro(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
    command.arg("sweep").args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn ran(arguments: &[&str]) -> Output {
    let output = gyro(arguments).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {words}");
    output
}

/// The files of a folder, the hidden record left out.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(&path).unwrap()))
        .filter(|(name, _)| !name.starts_with('.'))
        .collect();
    files.sort();
    files
}

fn same(one: &Path, other: &Path) {
    let (one, other) = (files(one), files(other));
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for ((name, one), (_, other)) in one.iter().zip(&other) {
        assert!(one == other, "{name} differs");
    }
}

/// Scenarios of about a hundredth of a millisecond, in packs; some of the last grid point cannot be.
const PACKS: &str = r#"
scenarios = 60_000
seed = 5
run = { coordinates = "joint", tolerance = 1e-6, integrator = "dop853", t_end = 0.1, every = 0.05 }
keep = { final = ["alpha", "beta rate"], extremes = "beta", passages = [{ of = "beta", below = -1e-3 }], quantiles = "alpha" }
vary = [
  { parameter = ["offset_x", "offset_y", "offset_z"], within = 2e-5 },
  { parameter = "product_xy", values = [0, 1e-5] },
]
"#;

/// Whole runs with a start assembled for each, and starts that cannot be.
const WHOLE: &str = r#"
scenarios = 40
block = 4
sampling = "sobol"
run = { coordinates = "maximal", t_end = 0.05, step = 1e-3, every = 0.01 }
keep = { final = ["alpha", "energy"], series = ["beta"] }
vary = [
  { parameter = "rotor_mass", uniform = [-0.01, 0.09] },
  { start = "beta", values = [0, 0.1] },
  { start = "phi rate", uniform = [90, 110] },
]
"#;

#[test]
#[ignore = "compiles programs"]
fn killed_twenty_times_it_ends_with_the_same_bytes() {
    let folder = Folder::new();
    let study = folder.study("models/gyroscope-misalignments.toml", PACKS);
    let (study, whole, killed) = (study.to_str().unwrap(), folder.0.join("whole"), folder.0.join("killed"));
    let arguments =
        |out: &'_ Path| vec![study.to_owned(), "--out".to_owned(), out.to_str().unwrap().to_owned()];
    let whole_arguments = arguments(&whole);
    ran(&whole_arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let blocks = killed.join("scenarios.blocks");
    let size = || fs::metadata(&blocks).map_or(0, |data| data.len());
    let total = fs::metadata(whole.join("scenarios.blocks")).unwrap().len();
    let mut random: u64 = 0x9e37_79b9_7f4a_7c15;
    let (mut kills, mut cut) = (0, 0);
    while kills < 20 {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Somewhere in the next fifteenth of what is left, which may be within a block or its file's first line.
        let until = size() + (total - size()) / 15 * (random >> 33) / (1 << 31);
        let mut command = gyro(&[study, "--resume", "--out", killed.to_str().unwrap()]);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let has_ended = loop {
            if child.try_wait().unwrap().is_some() {
                break true;
            }
            if size() > until {
                break false;
            }
            std::thread::sleep(Duration::from_micros(random >> 54));
        };
        assert!(!has_ended, "it ended before it was killed");
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        // What a full disk or a power cut leaves of the last block.
        if kills % 3 == 0 {
            let file = fs::OpenOptions::new().write(true).open(&blocks).unwrap();
            file.set_len(size() - 1 - (random >> 40) % 700).unwrap();
            cut += 1;
        }
    }
    assert_eq!(cut, 6);
    ran(&[study, "--resume", "--out", killed.to_str().unwrap()]);
    same(&whole, &killed);
}

/// Files that may not become longer than this stand for a disk that is full; then there is room again.
#[test]
#[ignore = "compiles programs"]
#[cfg(unix)]
fn out_of_disk_it_says_so_and_goes_on_to_the_same_bytes() {
    let folder = Folder::new();
    let study = folder.study("models/gyroscope-misalignments.toml", &PACKS.replace("60_000", "3_000"));
    let (study, whole, full) = (study.to_str().unwrap(), folder.0.join("whole"), folder.0.join("full"));
    ran(&[study, "--out", whole.to_str().unwrap()]);
    let longest = files(&whole).iter().map(|(_, bytes)| bytes.len()).max().unwrap();
    let mut failures = 0;
    // Cargo, which looks after the program first, writes a list of files of some 8 kB.
    for kilobytes in [20, 40, 80, 150, 300, 400, 600] {
        let script = format!("trap '' XFSZ; ulimit -f {}; exec \"$@\"", 2 * kilobytes);
        let mut command = Command::new("dash");
        command.args([
            "-c",
            &script,
            "dash",
            env!("CARGO_BIN_EXE_gyro"),
            "sweep",
            study,
            "--resume",
            "--out",
        ]);
        let output = command.arg(&full).output().unwrap();
        let words = String::from_utf8_lossy(&output.stderr);
        if kilobytes * 1024 >= longest {
            break;
        }
        assert_eq!(output.status.code(), Some(1), "{kilobytes} kB: {words}");
        assert!(words.contains("cannot be written") && words.contains("--resume goes on"), "{words}");
        assert_eq!(words.lines().filter(|line| line.starts_with("error")).count(), 1, "{words}");
        failures += 1;
    }
    assert!(failures > 4, "{failures}");
    ran(&[study, "--resume", "--out", full.to_str().unwrap()]);
    same(&whole, &full);
}

#[test]
#[ignore = "compiles programs"]
fn threads_and_shards_do_not_change_a_byte() {
    for (model, text) in
        [("models/gyroscope-misalignments.toml", PACKS), ("models/gyroscope-parameters.toml", WHOLE)]
    {
        let folder = Folder::new();
        let study = folder.study(model, &text.replace("60_000", "2_000"));
        let study = study.to_str().unwrap();
        let place = |name: &str| folder.0.join(name).to_str().unwrap().to_owned();
        ran(&[study, "--threads", "1", "--out", &place("one")]);
        ran(&[study, "--threads", "3", "--engine", "generated", "--out", &place("three")]);
        same(&folder.0.join("one"), &folder.0.join("three"));
        let parts: Vec<String> = (1..=7).map(|k| place(&format!("part-{k}"))).collect();
        for (k, part) in (1..).zip(&parts) {
            ran(&[study, "--shard", &format!("{k}/7"), "--out", part]);
        }
        let merge = |parts: &[String], out: &str| {
            let mut command = gyro(&["merge"]);
            command.args(parts.iter().rev()).args(["--out", out]).output().unwrap()
        };
        assert!(merge(&parts, &place("merged")).status.success());
        same(&folder.0.join("one"), &folder.0.join("merged"));
        let lacking = merge(&parts[1..], &place("lacking"));
        let words = String::from_utf8_lossy(&lacking.stderr);
        assert!(words.contains("parts 1 to 7 were expected"), "{words}");
        let table = fs::read_to_string(folder.0.join("one/scenarios.csv")).unwrap();
        let failed = table.lines().filter(|line| !line.starts_with('#') && !line.ends_with(',')).count();
        assert!(failed > 5 && failed < table.lines().count() / 2 + 10, "{failed}");
    }
}

#[test]
#[ignore = "compiles programs"]
fn parts_are_merged_wherever_their_study_is() {
    let folder = Folder::new();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/gyroscope-parameters.toml");
    fs::create_dir(folder.0.join("studies")).unwrap();
    fs::copy(model, folder.0.join("model.toml")).unwrap();
    let study = folder.0.join("studies/study.toml");
    fs::write(&study, format!("format = 1\nmodel = \"../model.toml\"\n{WHOLE}")).unwrap();
    let run = |arguments: &[&str]| {
        let output = gyro(arguments).current_dir(&folder.0).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    run(&["studies/study.toml", "--out", "one"]);
    run(&["studies/study.toml", "--shard", "1/2", "--out", "part-1"]);
    run(&["studies/study.toml", "--shard", "2/2", "--out", "part-2"]);
    run(&["merge", "part-1", "part-2", "--out", "all"]);
    same(&folder.0.join("one"), &folder.0.join("all"));
}

#[test]
#[ignore = "compiles programs"]
fn a_scenario_by_itself_is_the_row_of_the_table() {
    let folder = Folder::new();
    let study = folder.study("models/gyroscope-parameters.toml", WHOLE);
    let (study, out) = (study.to_str().unwrap(), folder.0.join("out"));
    ran(&[study, "--out", out.to_str().unwrap()]);
    let table = fs::read_to_string(out.join("scenarios.csv")).unwrap();
    let row = table.lines().find(|line| line.starts_with("79,")).unwrap();
    let expected: Vec<f64> = row.split(',').skip(4).take(2).map(|cell| cell.parse().unwrap()).collect();
    ran(&[study, "--only", "79", "--out", out.to_str().unwrap()]);
    let path = out.join("scenario-79/gyroscope_parameters.csv");
    let track = fs::read_to_string(path).unwrap();
    let names: Vec<&str> = track.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = track.lines().last().unwrap().split(',').collect();
    for (name, expected) in ["alpha [rad]", "energy [J]"].iter().zip(expected) {
        let column = names.iter().position(|other| other == name).unwrap();
        assert_eq!(last[column].parse::<f64>().unwrap(), expected, "{name}");
    }
    // It is there already, and of another study it is not gone on with.
    let again = gyro(&[study, "--out", out.to_str().unwrap()]).output().unwrap();
    assert!(String::from_utf8_lossy(&again.stderr).contains("--resume goes on with it"));
    fs::write(study, fs::read_to_string(study).unwrap() + "# changed\n").unwrap();
    let other = gyro(&[study, "--resume", "--out", out.to_str().unwrap()]).output().unwrap();
    assert!(String::from_utf8_lossy(&other.stderr).contains("is of another study"));
}

/// Whether a step of Kutta's method shrinks both motions of `B β'' + c β' + k β = 0`, and by how much at least it
/// shrinks or grows them.
fn is_stable(stiffness: f64, damping: f64, h: f64) -> (bool, f64) {
    // Of models/stiff-bearing.toml, with the rotor's 80 g an eighth of a millimetre off centre.
    let off_centre = 80e-3 * 0.000_125 * 0.000_125;
    let (momentum, across, about) = (1e-3, 80e-7 + off_centre, 60e-7 + off_centre);
    let (half, square) = (damping / (2.0 * about), (stiffness + momentum * momentum / across) / about);
    let inner = half * half - square;
    let roots = match inner > 0.0 {
        true => [[-half - inner.sqrt(), 0.0], [-square / (half + inner.sqrt()), 0.0]],
        false => [[-half, (-inner).sqrt()], [-half, -(-inner).sqrt()]],
    };
    // 1 + z (1 + z/2 (1 + z/3 (1 + z/4))), Hairer and Wanner, Solving ODEs II, IV.2.
    let growth = |[re, im]: [f64; 2]| {
        let z = [h * re, h * im];
        let [a, b] = (1..=4).rev().fold([1.0, 0.0], |[a, b], k| {
            let k = f64::from(k);
            [1.0 + (z[0] * a - z[1] * b) / k, (z[0] * b + z[1] * a) / k]
        });
        a.hypot(b)
    };
    let worst = roots.map(growth).into_iter().fold(0.0, f64::max);
    (worst < 1.0, (worst - 1.0).abs())
}

/// The numbers of the rows of a table, NaN where there is none.
fn rows(table: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(table).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect()
}

fn studied(name: &str, folder: &Folder) -> Vec<Vec<f64>> {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies").join(format!("{name}.toml"));
    let out = folder.0.join("out");
    ran(&[study.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    rows(&out.join("scenarios.csv"))
}

#[test]
#[ignore = "compiles programs"]
fn every_point_of_the_stability_map_is_where_theory_has_it() {
    /// Over the study's thousand steps less than this is told apart from one.
    const NEAR: f64 = 5e-3;
    let rows = studied("stiff-bearing", &Folder::new());
    let mut judged = 0;
    for row in &rows {
        let (is_stable, distance) = is_stable(row[1], row[2], 2e-4);
        if distance > NEAR {
            let has_stayed = row[3].abs() < 0.01 && row[4].abs() < 0.01;
            assert_eq!(has_stayed, is_stable, "stiffness {}, damping {}", row[1], row[2]);
            judged += 1;
        }
    }
    assert_eq!(rows.len(), 1681);
    assert!(judged > 1500, "{judged} are far enough from the limit");
}

#[test]
#[ignore = "compiles programs"]
fn the_top_sleeps_above_the_limit_of_theory() {
    let inertia = 3e-4 + 0.5 * 0.04 * 0.04;
    let limit = (4.0 * inertia * 0.5 * 9.81 * 0.04_f64).sqrt() / 5e-4;
    for row in studied("sleeping-top", &Folder::new()) {
        let (spin, lowest) = (row[1], row[2]);
        // Leaning by twice the start's milliradian lowers the centre by 0.08 um. Within a tenth of the limit it falls
        // so slowly that four seconds do not tell.
        if (spin - limit).abs() > 0.1 {
            assert_eq!(0.04 - lowest > 1e-4, spin < limit, "{spin} rad/s: {lowest} m");
        }
    }
}

/// Of a linkage, whose start is assembled anew for each scenario: derivatives of the first row against differences of
/// the other rows.
#[test]
#[ignore = "compiles programs"]
fn derivatives_of_a_linkage_are_differences_of_its_rows() {
    let (middle, apart) = ([0.2, 0.5, 6.2], 1e-3);
    let shifted = (0..3).flat_map(|target| [-2.0, -1.0, 1.0, 2.0].map(|parts| (target, parts)));
    let mut points = vec![middle];
    for (target, parts) in shifted {
        let mut point = middle;
        point[target] += parts * apart;
        points.push(point);
    }
    // Lists multiply: a study varies the lengths, another the rate.
    let (parameters, rates): (Vec<_>, Vec<_>) =
        points.iter().map(|[crank, coupler, rate]| (vec![*crank, *coupler], *rate)).unzip();
    let study = |rows: &[Vec<f64>], rate: &[f64]| {
        format!(
            r#"
run = {{ coordinates = "joint", tolerance = 1e-11, integrator = "dop853", t_end = 0.3, every = 0.02 }}
[keep]
final = ["pen.rx", "rocker_pivot", "knee rate z", "energy"]
extremes = "rocker_pivot"
passages = [{{ of = "crank_pivot", above = 2 }}]
series = ["rocker_pivot", "energy"]
sensitivities = true
[[vary]]
parameter = ["crank", "coupler"]
values = {rows:?}
[[vary]]
start = "crank_pivot rate"
values = {rate:?}
"#
        )
    };
    let folder = Folder::new();
    let run = |text: &str, name: &str| {
        let study = folder.study("studies/models/coupler-curve.toml", text);
        let out = folder.0.join(name);
        ran(&[study.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        [rows(&out.join("scenarios.csv")), rows(&out.join("series.csv"))]
    };
    let [lengths, series_of_lengths] = run(&study(&parameters[..9], &rates[..1]), "lengths");
    let rates = [&rates[..1], &rates[9..]].concat();
    let [of_rate, series_of_rate] = run(&study(&parameters[..1], &rates), "rates");
    // Of each of the two rough joints the table says how far it was moved.
    let (numbers, moved) = (7, 2);
    let mut judged = 0;
    for (target, table, first) in [(0, &lengths, 1), (1, &lengths, 5), (2, &of_rate, 1)] {
        for number in 0..numbers {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| table[first + k][4 + number]);
            let expected = (8.0 * (c - b) - (d - a)) / (12.0 * apart);
            let found = table[0][4 + numbers + moved + 3 * number + target];
            assert!(
                (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                "{number}, {target}: {found} {expected}"
            );
            judged += usize::from(expected.abs() > 1e-6);
        }
    }
    assert!(judged > 15, "{judged}");
    // Series: 16 samples of each scenario; k, t, two numbers, their derivatives by what varies in this study.
    let samples = 16;
    judged = 0;
    for (target, table, first) in
        [(0, &series_of_lengths, 1), (1, &series_of_lengths, 5), (2, &series_of_rate, 1)]
    {
        assert_eq!(table[samples - 1][..2], [0.0, 0.3]);
        for (sample, number) in (0..samples).flat_map(|sample| [(sample, 0), (sample, 1)]) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| table[(first + k) * samples + sample][2 + number]);
            let expected = (8.0 * (c - b) - (d - a)) / (12.0 * apart);
            let found = table[sample][4 + 3 * number + target];
            assert!(
                (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                "sample {sample} of {number}, {target}: {found} {expected}"
            );
            judged += usize::from(expected.abs() > 1e-6);
        }
    }
    assert!(judged > 60, "{judged}");
}

/// Tables of a study are, between their rows, what `simulate --input` makes of them.
#[test]
#[ignore = "compiles programs"]
fn tables_are_between_their_rows_as_inputs_are() {
    let folder = Folder::new();
    let model =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/arm/arm.toml")).unwrap();
    fs::write(folder.0.join("arm.toml"), model).unwrap();
    fs::write(folder.0.join("u.csv"), "0,0\n0.1,2\n0.2,-1\n0.4,1\n").unwrap();
    let words = ["linear", "held", "smooth"];
    let study = folder.0.join("study.toml");
    let text = "format = 1\nmodel = \"arm.toml\"\n\
        run = { t_end = 0.3, tolerance = 1e-9, integrator = \"dop853\" }\nkeep = { final = \"energy\" }\n\
        vary = [{ input = \"motor\", tables = [\"linear:u.csv\", \"held:u.csv\", \"smooth:u.csv\"] }]\n";
    fs::write(&study, text).unwrap();
    ran(&[study.to_str().unwrap(), "--out", folder.0.join("out").to_str().unwrap()]);
    let found = rows(&folder.0.join("out/scenarios.csv"));
    for (row, word) in found.iter().zip(words) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
        let input = format!("motor={word}:{}", folder.0.join("u.csv").display());
        let out = folder.0.join(word);
        command.args(["simulate", folder.0.join("arm.toml").to_str().unwrap(), "--input", &input]);
        command.args(["--t-end", "0.3", "--tolerance", "1e-9", "--integrator", "dop853", "--out"]).arg(&out);
        assert!(command.output().unwrap().status.success());
        let table = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
        let table = table.into_iter().find(|path| path.extension().is_some_and(|e| e == "csv")).unwrap();
        let text = fs::read_to_string(table).unwrap();
        let place = text.lines().next().unwrap().split(',').position(|name| name == "energy [J]").unwrap();
        let last: f64 = text.lines().last().unwrap().split(',').nth(place).unwrap().parse().unwrap();
        assert_eq!(row[2], last, "{word}");
    }
    assert!(found[0][2] != found[1][2] && found[1][2] != found[2][2]);
}

/// Each scenario has the controllers of its own parameters, as `simulate --set` has them.
#[test]
#[ignore = "compiles programs"]
fn scenarios_have_the_controllers_of_their_parameters() {
    let folder = Folder::new();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/controlled-gyroscope.toml");
    let model = fs::read_to_string(model).unwrap();
    let gained =
        model.replace("kp = -2e-3", "kp = \"gain\"").replace("setpoint = 0.02", "setpoint = \"aim\"");
    let gained = gained.replace("[inputs]", "[parameters]\ngain = -2e-3\naim = 0.02\n\n[inputs]");
    fs::write(folder.0.join("closed.toml"), gained).unwrap();
    let study = folder.0.join("study.toml");
    let text = "format = 1\nmodel = \"closed.toml\"\nrun = { t_end = 0.2, tolerance = 1e-8, integrator = \"dop853\" }\n\
        keep = { final = [\"alpha\", \"beta rate\"] }\n\
        vary = [{ parameter = [\"gain\", \"aim\"], values = [[-2e-3, 0.02], [-1e-3, 0.02], [-1e-3, 0.03]] }]\n";
    fs::write(&study, text).unwrap();
    ran(&[study.to_str().unwrap(), "--out", folder.0.join("out").to_str().unwrap()]);
    let found = rows(&folder.0.join("out/scenarios.csv"));
    for (k, row) in found.iter().enumerate() {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
        let out = folder.0.join(format!("{k}"));
        command.args(["simulate", folder.0.join("closed.toml").to_str().unwrap()]);
        command.args(["--set", &format!("gain={}", row[1]), "--set", &format!("aim={}", row[2])]);
        command.args(["--t-end", "0.2", "--tolerance", "1e-8", "--integrator", "dop853", "--out"]).arg(&out);
        assert!(command.output().unwrap().status.success());
        let text = fs::read_to_string(out.join("controlled_gyroscope.csv")).unwrap();
        let place =
            |name: &str| text.lines().next().unwrap().split(',').position(|other| other == name).unwrap();
        let last: Vec<f64> =
            text.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(row[3..5], [last[place("alpha [rad]")], last[place("beta rate [rad/s]")]], "{k}");
    }
    assert!(found[0][3] != found[1][3] && found[1][3] != found[2][3]);
}
