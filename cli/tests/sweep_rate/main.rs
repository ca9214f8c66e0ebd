//! What a sweep costs beside its kernels: programs run in turns, and processor time, instructions and time are
//! compared.
//!
//! They measure, so they are run by themselves and optimised: `cargo test --release --package gyro-cli --test
//! sweep_rate -- --ignored --nocapture --test-threads 1`. `GYRO_ROUNDS=21` runs more rounds. Nothing is asserted of a
//! time.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "it is read by people")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Instant, SystemTime};

const STUDY: &str = r#"
run = { coordinates = "joint", tolerance = 1e-6, integrator = "dop853", t_end = 0.1, every = 0.1 }
keep = { final = ["alpha", "beta"] }
vary = [
  { parameter = ["offset_x", "offset_y", "offset_z"], within = 2e-5 },
  { parameter = ["imbalance_y", "imbalance_z"], within = 2e-6 },
  { parameter = ["lean_y", "lean_z"], within = 1e-3 },
]
"#;

/// A folder that goes with its test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gyro-rate-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A study of so many gyroscopes.
    fn study(&self, scenarios: u64) -> PathBuf {
        let model = root().join("studies/models/misaligned-gyroscope.toml");
        let path = self.0.join(format!("{scenarios}.toml"));
        let text =
            format!("format = 1\nmodel = {:?}\nscenarios = {scenarios}\n{STUDY}", model.to_str().unwrap());
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A sweep that starts anew; words before `--out` are added to it.
#[derive(Clone)]
struct Sweep<'a> {
    folder: &'a Folder,
    words: Vec<&'a str>,
}

impl Sweep<'_> {
    fn command(&self, scenarios: u64, more: &[&str], out: &str) -> Command {
        let out = self.folder.0.join(out);
        let _ = fs::remove_dir_all(&out);
        let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
        command.args(["--quiet", "sweep"]).arg(self.folder.study(scenarios));
        command.args(&self.words).args(more).arg("--out").arg(out).stdout(Stdio::null());
        command
    }
}

fn ran(mut child: Child) {
    assert!(child.wait().unwrap().success());
}

/// Processor time of all programs that have ended, s: those that this one started, and those that they started.
fn processor() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap();
    let mut fields = text.rsplit(')').next().unwrap().split_whitespace();
    // In hundredths of a second, as Linux gives it on all machines.
    let spent: f64 = fields.by_ref().skip(13).take(2).map(|field| field.parse::<f64>().unwrap()).sum();
    spent / 100.0
}

fn spent(command: &mut Command) -> f64 {
    let before = processor();
    ran(command.spawn().unwrap());
    processor() - before
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let n = numbers.len();
    0.5 * (numbers[(n - 1) / 2] + numbers[n / 2])
}

fn rounds() -> usize {
    std::env::var("GYRO_ROUNDS").map_or(7, |n| n.parse().unwrap())
}

/// How busy the machine is, and with how many processors.
fn load() -> String {
    let load = fs::read_to_string("/proc/loadavg").unwrap();
    let cores = std::thread::available_parallelism().unwrap();
    format!("load {} on {cores} processors", load.split(' ').next().unwrap())
}

/// The folder of what `gyro` has just compiled for the study.
fn runtime() -> PathBuf {
    let cache = std::env::var_os("GYRO_CACHE").expect("cargo sets it: see .cargo/config.toml");
    let used = |path: &PathBuf| fs::metadata(path.join("used")).and_then(|mark| mark.modified()).ok();
    let versions = fs::read_dir(root().join(cache)).unwrap().map(|entry| entry.unwrap().path());
    let newest = versions.max_by_key(|path| used(path).unwrap_or(SystemTime::UNIX_EPOCH));
    newest.unwrap().canonicalize().unwrap()
}

/// Compiles the kernels alone as `gyro sweep` compiles its program, beside that.
fn kernels(folder: &Folder, is_native: bool) -> PathBuf {
    let runtime = runtime();
    let programs = fs::read_dir(runtime.join("programs")).unwrap().map(|entry| entry.unwrap().path());
    let of_gyroscope = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.starts_with("misaligned_gyroscope-") && path.join("src/mechanism.rs").is_file()
    };
    let modified = |path: &PathBuf| fs::metadata(path.join("src/main.rs")).unwrap().modified().unwrap();
    let program = programs.filter(of_gyroscope).max_by_key(modified).unwrap();
    let package = folder.0.join("kernels");
    fs::create_dir_all(package.join("src")).unwrap();
    fs::copy(program.join("src/mechanism.rs"), package.join("src/mechanism.rs")).unwrap();
    fs::write(package.join("src/main.rs"), include_str!("kernels.rs")).unwrap();
    fs::copy(program.join("Cargo.lock"), package.join("Cargo.lock")).unwrap();
    let name = program.file_name().unwrap().to_str().unwrap().to_owned();
    let manifest = fs::read_to_string(program.join("Cargo.toml")).unwrap();
    let manifest = manifest.replace(&name, "kernels").replace("../..", runtime.to_str().unwrap());
    fs::write(package.join("Cargo.toml"), manifest).unwrap();
    let mut command = Command::new(env!("CARGO"));
    command.args(["build", "--quiet", "--release", "--offline", "--target-dir"]).arg(folder.0.join("build"));
    if is_native {
        command.args(["--config", "build.rustflags=['-Ctarget-cpu=native']"]);
    }
    // As when `gyro` compiles: nothing of this test's own build.
    command.current_dir(&package).env_remove("CARGO_BUILD_TARGET").env_remove("RUSTFLAGS");
    ran(command.spawn().unwrap());
    folder.0.join("build/release/kernels")
}

/// Processor time of a scenario, µs, as the difference of many and few: by the kernels alone; in a sweep; and in one
/// that writes its tables. Rounds are in turns; medians, and those of the quotients within a round.
fn processor_times(is_native: bool) {
    const MANY: u64 = 1 << 20;
    const FEW: u64 = 1 << 15;
    let folder = Folder::new(if is_native { "native" } else { "baseline" });
    let words = if is_native { vec!["--threads", "1", "--native"] } else { vec!["--threads", "1"] };
    let sweep = Sweep { folder: &folder, words };
    ran(sweep.command(FEW, &[], "first").spawn().unwrap());
    let kernels = kernels(&folder, is_native);
    let mut measured: [Vec<f64>; 3] = [const { Vec::new() }; 3];
    let before = load();
    for _ in 0..rounds() {
        let each = |many: f64, few: f64| 1e6 * (many - few) / (MANY - FEW) as f64;
        let bare = |n: u64| spent(Command::new(&kernels).arg(n.to_string()).stdout(Stdio::null()));
        // Half of a study: a part has no tables.
        let part = |n: u64| spent(&mut sweep.command(2 * n, &["--shard", "1/2"], "part"));
        let whole = |n: u64| spent(&mut sweep.command(n, &[], "whole"));
        measured[0].push(each(bare(MANY), bare(FEW)));
        measured[1].push(each(part(MANY), part(FEW)));
        measured[2].push(each(whole(MANY), whole(FEW)));
    }
    let [bare, part, whole] = &measured;
    let quotient = median(bare.iter().zip(part).map(|(bare, part)| bare / part).collect());
    let rest = median(bare.iter().zip(whole).map(|(bare, whole)| whole - bare).collect());
    let [bare, part, whole] = measured.each_ref().map(|all| median(all.clone()));
    let what = if is_native { "--native" } else { "baseline" };
    println!(
        "{what}: kernels {bare:.2} us, sweep {part:.2} us, with tables {whole:.2} us of processor time a scenario; \
         rate \
         {quotient:.3} of the kernels' own; machinery with tables {rest:.2} us ({} rounds, {before})",
        rounds()
    );
}

#[test]
#[ignore = "measures"]
fn rate_of_a_sweep_beside_its_kernels() {
    processor_times(false);
}

#[test]
#[ignore = "measures"]
fn rate_of_a_native_sweep_beside_its_kernels() {
    processor_times(true);
}

/// Instructions of a scenario, by valgrind, which a busy machine does not change.
#[test]
#[ignore = "measures"]
fn instructions_of_a_sweep_beside_its_kernels() {
    const MANY: u64 = 12_288;
    const FEW: u64 = 4096;
    let folder = Folder::new("counted");
    let sweep = Sweep { folder: &folder, words: vec!["--threads", "1"] };
    ran(sweep.command(FEW, &[], "first").spawn().unwrap());
    let kernels = kernels(&folder, false);
    let counted = |command: &Command| -> f64 {
        let profiles = folder.0.join("profiles");
        fs::create_dir_all(&profiles).unwrap();
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--quiet", "--tool=callgrind", "--trace-children=yes"]);
        valgrind.args(["--trace-children-skip=*cargo*,*rustc*,*git*"]);
        valgrind.arg(format!("--callgrind-out-file={}/%p", profiles.display()));
        valgrind.arg(command.get_program()).args(command.get_args()).stdout(Stdio::null());
        ran(valgrind.spawn().unwrap());
        let files = fs::read_dir(&profiles).unwrap().map(|entry| entry.unwrap().path());
        let total = |path: PathBuf| -> f64 {
            let text = fs::read_to_string(path).unwrap();
            let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
            total.unwrap().trim().parse().unwrap()
        };
        let all = files.map(total).sum();
        fs::remove_dir_all(&profiles).unwrap();
        all
    };
    let each = |of: &dyn Fn(u64) -> Command| (counted(&of(MANY)) - counted(&of(FEW))) / (MANY - FEW) as f64;
    let bare = each(&|n| {
        let mut command = Command::new(&kernels);
        command.arg(n.to_string());
        command
    });
    let part = each(&|n| sweep.command(2 * n, &["--shard", "1/2"], "part"));
    let whole = each(&|n| sweep.command(n, &[], "whole"));
    println!(
        "kernels {bare:.0}, sweep {part:.0}, with tables {whole:.0} instructions a scenario; \
         rate {:.3} of the kernels' own",
        bare / part
    );
}

/// Two threads of one sweep beside two sweeps of one thread at once, each of one half; differences of many and few
/// scenarios, so that the start of a sweep does not count.
#[test]
#[ignore = "measures"]
fn two_threads_beside_two_programs() {
    const MANY: u64 = 3 << 18;
    const FEW: u64 = 3 << 14;
    let folder = Folder::new("threads");
    let sweep = Sweep { folder: &folder, words: Vec::new() };
    ran(sweep.command(1024, &[], "first").spawn().unwrap());
    let timed = |commands: Vec<Command>| {
        let (began, before) = (Instant::now(), processor());
        let children: Vec<Child> = commands.into_iter().map(|mut command| command.spawn().unwrap()).collect();
        children.into_iter().for_each(ran);
        [began.elapsed().as_secs_f64(), processor() - before]
    };
    // One of three parts: as much as two of six. Parts have no tables.
    let both = |n: u64| timed(vec![sweep.command(n, &["--threads", "2", "--shard", "1/3"], "both")]);
    let halves = |n: u64| {
        let half = |k, out| sweep.command(n, &["--threads", "1", "--shard", k], out);
        timed(vec![half("1/6", "first"), half("4/6", "second")])
    };
    let each = |run: &dyn Fn(u64) -> [f64; 2]| {
        let (many, few) = (run(MANY), run(FEW));
        [many[0] - few[0], many[1] - few[1]]
    };
    let before = load();
    let mut quotients: [Vec<f64>; 2] = [const { Vec::new() }; 2];
    for _ in 0..rounds() {
        // In both orders, as the machine may get busier meanwhile.
        let (a, b, c, d) = (each(&both), each(&halves), each(&halves), each(&both));
        for (k, quotients) in quotients.iter_mut().enumerate() {
            quotients.push((b[k] + c[k]) / (a[k] + d[k]));
        }
    }
    let [wall, processor] = quotients.map(median);
    println!(
        "two threads: rate {wall:.3} of two programs', by processor time {processor:.3} \
         ({} rounds, {before}, after {})",
        rounds(),
        load()
    );
}
