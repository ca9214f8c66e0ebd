//! Runs random model files with rigid contacts by `gyro simulate`, built beside this program, each for a limited time:
//! `scenes [--joints] [--print] FIRST COUNT [SECONDS]`. Bodies are thrown upon each other; with `--joints` contacts are
//! on joint coordinates, of loops too, and motions in joint coordinates, in maximal ones and by `rodas4` are compared.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use serde_json::Value;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// In which ways model files with contacts on joint coordinates are run.
const WAYS: [&[&str]; 3] = [&[], &["--coordinates", "maximal"], &["--integrator", "rodas4"]];

fn main() {
    let numbers: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let number = |k: usize, otherwise| numbers.get(k).copied().unwrap_or(otherwise);
    let (first, count, limit) = (number(0, 0), number(1, 60), Duration::from_secs(number(2, 30)));
    let has = |option: &str| std::env::args().any(|argument| argument == option);
    let text = if has("--joints") { gyro_pages::rubbing } else { gyro_pages::scene };
    if has("--print") {
        return (first..first + count).for_each(|seed| println!("{}", text(seed)));
    }
    let here = std::env::current_exe().expect("this program");
    let gyro = here.parent().and_then(Path::parent).expect("a folder of builds").join("gyro");
    let folder = std::env::temp_dir().join(format!("scenes-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("t.csv"), gyro_pages::TABLE).expect("a table");
    let mut fine = 0;
    for seed in first..first + count {
        let page = folder.join(format!("scene_{seed}.toml"));
        fs::write(&page, text(seed)).expect("a model file");
        let mut around = vec!["--t-end", "0.5", "--tolerance", "1e-9"];
        if !has("--joints") {
            around.clear();
        }
        let ways = if has("--joints") { &WAYS[..] } else { &WAYS[..1] };
        let run = |way: &&[&str]| Run::of((&gyro, &folder, &page), &[&around[..], way].concat(), limit);
        let runs: Vec<Run> = ways.iter().map(run).collect();
        let apart = runs.iter().map(|run| run.apart(&runs[0])).fold(0.0, f64::max);
        let is_fine = runs.iter().all(|run| run.drift.is_some_and(|drift| drift < 1e-8)) && apart < 1e-5;
        fine += usize::from(is_fine);
        let told = runs.iter().map(|run| run.told.as_str()).collect::<Vec<_>>().join("; ");
        println!(
            "{seed}: {told}{}",
            if apart > 1e-5 { format!("; apart by {apart:.1e}") } else { String::new() }
        );
    }
    println!("{fine} of {count} are fine");
    let _ = fs::remove_dir_all(&folder);
}

/// What has become of a run.
struct Run {
    drift: Option<f64>,
    joints: Vec<f64>,
    told: String,
}

impl Run {
    fn of((gyro, folder, page): (&PathBuf, &Path, &PathBuf), args: &[&str], limit: Duration) -> Self {
        let written = |name: &str| Stdio::from(File::create(folder.join(name)).expect("a file"));
        let begun = Instant::now();
        let mut run = Command::new(gyro)
            .args(["simulate", "--quiet", "--no-prove", "--json"])
            .arg(page)
            .args(args)
            .arg("--out")
            .arg(folder)
            .stdout(written("out"))
            .stderr(written("err"))
            .spawn()
            .expect("gyro is built");
        while run.try_wait().expect("a run").is_none() && begun.elapsed() < limit {
            std::thread::sleep(Duration::from_millis(5));
        }
        let _ = run.kill();
        let took = begun.elapsed();
        let status = run.wait().expect("a run");
        let [out, err] =
            ["out", "err"].map(|name| fs::read_to_string(folder.join(name)).expect("what it wrote"));
        let summary: Value = serde_json::from_str(&out).unwrap_or_default();
        let drift = summary["energy_drift"].as_f64().filter(|_| status.success());
        let joints = summary["joints"].as_object().into_iter().flat_map(|joints| joints.values());
        let numbers = |joint: &Value| match &joint["position"] {
            Value::Array(all) => all.iter().filter_map(Value::as_f64).collect(),
            one => one.as_f64().into_iter().collect::<Vec<f64>>(),
        };
        let told = match drift {
            Some(drift) => format!("energy {drift:.1e}, {} steps", summary["steps"]),
            None if took >= limit => "too long".to_owned(),
            None => err.lines().filter(|line| line.starts_with("error")).take(1).collect(),
        };
        let told = format!("{:.1} s, {told}", took.as_secs_f64());
        Self { drift, joints: joints.flat_map(numbers).collect(), told }
    }

    /// By how much the places at the end differ.
    fn apart(&self, other: &Self) -> f64 {
        self.joints.iter().zip(&other.joints).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}
