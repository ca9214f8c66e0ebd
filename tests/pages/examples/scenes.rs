//! Runs scenes of rigid contact by `gyro simulate`, built beside this program, each for a limited time:
//! `scenes [--print] FIRST COUNT [SECONDS]`.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn main() {
    let numbers: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let number = |k: usize, otherwise| numbers.get(k).copied().unwrap_or(otherwise);
    let (first, count, limit) = (number(0, 0), number(1, 60), Duration::from_secs(number(2, 30)));
    if std::env::args().any(|argument| argument == "--print") {
        return (first..first + count).for_each(|seed| println!("{}", gyro_pages::scene(seed)));
    }
    let here = std::env::current_exe().expect("this program");
    let gyro = here.parent().and_then(Path::parent).expect("a folder of builds").join("gyro");
    let folder = std::env::temp_dir().join(format!("scenes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut fine = 0;
    for seed in first..first + count {
        let page = folder.join(format!("scene_{seed}.toml"));
        std::fs::write(&page, gyro_pages::scene(seed)).expect("a model file");
        let written = |name: &str| Stdio::from(File::create(folder.join(name)).expect("a file"));
        let begun = Instant::now();
        let mut run = Command::new(&gyro)
            .args(["simulate", "--quiet", "--no-prove", "--json"])
            .args([&page])
            .arg("--out")
            .arg(&folder)
            .stdout(written("out"))
            .stderr(written("err"))
            .spawn()
            .expect("gyro is built");
        while run.try_wait().expect("a run").is_none() && begun.elapsed() < limit {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = run.kill();
        let took = begun.elapsed();
        let status = run.wait().expect("a run");
        let [out, err] =
            ["out", "err"].map(|name| std::fs::read_to_string(folder.join(name)).expect("what it wrote"));
        let told = |key: &str| {
            let rest = out.split_once(&format!("\"{key}\":"))?.1.trim_start();
            rest.split([',', '}', '\n']).next().and_then(|number| number.trim().parse::<f64>().ok())
        };
        let drift = told("energy_drift").filter(|_| status.success());
        fine += usize::from(drift.is_some_and(|drift| drift < 1e-8));
        let fate = match drift {
            Some(drift) => format!("energy {drift:.1e}, {} steps", told("steps").unwrap_or(f64::NAN)),
            None if took >= limit => "too long".to_owned(),
            None => err.lines().take(2).collect::<Vec<_>>().join(" "),
        };
        println!("{seed}: {:.1} s, {fate}", took.as_secs_f64());
    }
    println!("{fine} of {count} are fine");
    let _ = std::fs::remove_dir_all(&folder);
}
