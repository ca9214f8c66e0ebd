//! Whatever is fed to the command line, the answer comes within seconds, and is an answer: a result, or an error that
//! leaves nothing behind.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod files;
mod known;
mod numbers;

use rand::{Rng, RngExt};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How long an answer may take on a machine that is busy with other things; almost all take hundredths of a second.
const PATIENCE: Duration = Duration::from_secs(60);

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gyro-edges-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), bytes).unwrap();
    }

    /// What lies in it.
    fn files(&self) -> Vec<String> {
        let names = fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// What the command line says of this, if it says it in time.
    fn gyro(&self, args: &[&str]) -> Option<Output> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
        command.args(args).current_dir(&self.0);
        // What it says is short, but for tables, which go to files.
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let [out, err] = [reader(child.stdout.take().unwrap()), reader(child.stderr.take().unwrap())];
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if begun.elapsed() > PATIENCE {
                child.kill().unwrap();
                child.wait().unwrap();
                return None;
            }
            thread::sleep(Duration::from_millis(2));
        };
        Some(Output { status, stdout: out.join().unwrap(), stderr: err.join().unwrap() })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn reader(mut pipe: impl std::io::Read + Send + 'static) -> thread::JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.read_to_end(&mut bytes).unwrap();
        bytes
    })
}

/// What is wrong with an answer.
fn fault(output: Option<&Output>) -> Option<String> {
    let Some(output) = output else { return Some("no answer in time".to_owned()) };
    let said = String::from_utf8_lossy(&output.stderr);
    match output.status.code() {
        // Good, failed on the way, refused, worthless, not judged.
        Some(0 | 3 | 4) => None,
        Some(1 | 2) if !said.contains("error") => Some(format!("no word of what is wrong: {said}")),
        Some(1 | 2) => None,
        code => Some(format!("code {code:?}: {said}")),
    }
    .or_else(|| said.contains("panicked").then(|| said.to_string()))
}

/// A number of an object that is none: JSON has null for it.
fn missing(value: &Value, path: &str) -> Option<String> {
    match value {
        Value::Array(all) => all.iter().find_map(|value| missing(value, path)),
        Value::Object(all) => all.iter().find_map(|(key, value)| missing(value, &format!("{path}.{key}"))),
        Value::Null => Some(path.to_owned()),
        _ => None,
    }
}

/// Any double: half of them of any bits, the others of sizes that people write, and those at the ends.
fn double(random: &mut impl Rng) -> f64 {
    const ENDS: [f64; 10] = [
        0.0,
        -0.0,
        f64::MIN_POSITIVE,
        5e-324,
        f64::MAX,
        f64::MIN,
        f64::EPSILON,
        f64::INFINITY,
        f64::NAN,
        -1.0,
    ];
    match random.random_range(0..10) {
        0..5 => f64::from_bits(random.random()),
        5..9 => {
            10_f64.powf(random.random_range(-20.0..20.0)) * if random.random_bool(0.3) { -1.0 } else { 1.0 }
        }
        _ => ENDS[random.random_range(0..ENDS.len())],
    }
}

/// As TOML and the command line write it.
fn written(number: f64) -> String {
    if number.is_nan() { "nan".to_owned() } else { format!("{number:?}") }
}
