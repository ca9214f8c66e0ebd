//! Generates and proves many random model files, or model files given as files:
//! `pages [--seed N] [--count N] [--print] [--read] [--module] [FILE...]`.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use gyro_verifier::{Depth, verify};
use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (mut seed, mut count, mut files) = (0, 100, Vec::new());
    let (mut prints, mut reads, mut writes) = (false, false, false);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|n| n.parse::<u64>().ok()).expect("a number follows");
        match argument.as_str() {
            "--seed" => seed = number(),
            "--count" => count = number(),
            "--print" => prints = true,
            "--read" => reads = true,
            "--module" => writes = true,
            _ => files.push(argument),
        }
    }
    if reads {
        // A model file that is refused panics while its start is planted.
        let refused = |seed: &u64| catch_unwind(|| gyro_pages::page(*seed)).is_err();
        let refused: Vec<u64> = (seed..seed + count).filter(refused).collect();
        return println!("{} of {count} model files are not correct: {refused:?}", refused.len());
    }
    if prints {
        return (seed..seed + count).for_each(|seed| println!("{}", gyro_pages::page(seed)));
    }
    if writes {
        return (seed..seed + count).for_each(|seed| println!("{}", module(seed)));
    }
    if !files.is_empty() {
        return files.iter().for_each(|file| println!("{file}: {}", of_file(Path::new(file))));
    }
    let mut fates = BTreeMap::<String, Vec<u64>>::new();
    let start = Instant::now();
    for seed in seed..seed + count {
        let begun = Instant::now();
        let fate = catch_unwind(|| fate(&gyro_pages::page(seed), &mut gyro_pages::load));
        let fate = fate.unwrap_or_else(|_| "a panic".to_owned());
        if fate != PROVED {
            println!("{seed}: {fate}");
        }
        if Instant::now().duration_since(begun) > SLOW {
            println!("{seed} was slow");
        }
        fates.entry(kind(&fate)).or_default().push(seed);
    }
    println!("{count} model files in {:.0} s", start.elapsed().as_secs_f64());
    for (kind, seeds) in fates {
        println!("{:6} {kind}: {:?}", seeds.len(), &seeds[..seeds.len().min(8)]);
    }
}

/// A model file that takes longer is named.
const SLOW: Duration = Duration::from_secs(10);

const PROVED: &str = "proved";

/// The module of a model file, proved or not.
fn module(seed: u64) -> String {
    let model = gyro_model::read_with("page.toml", &gyro_pages::page(seed), &mut gyro_pages::load);
    let model = model.unwrap_or_else(|problems| panic!("{problems}"));
    gyro_codegen::generate_functions("page.toml", &model, &gyro_codegen::Functions::all())
        .unwrap_or_else(|error| panic!("{error}"))
        .code
}

fn of_file(path: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut load = |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|error| error.to_string());
    let (text, start) = (std::fs::read_to_string(path).expect("a model file"), Instant::now());
    format!("{} ({:.1} s)", fate(&text, &mut load), start.elapsed().as_secs_f64())
}

/// What becomes of a model file.
fn fate(text: &str, load: &mut dyn FnMut(&str) -> Result<String, String>) -> String {
    let start = Instant::now();
    let model = match gyro_model::read_with("page.toml", text, load) {
        Ok(model) => model,
        Err(problems) => return format!("not read: {problems}"),
    };
    let module = match gyro_codegen::generate_functions("page.toml", &model, &gyro_codegen::Functions::all())
    {
        Ok(module) => module,
        Err(error) => return format!("not generated: {error}"),
    };
    let generated = start.elapsed();
    let report = verify(&model, &module.code, &module.constants, Depth::Quick);
    if start.elapsed() > SLOW {
        let words = (generated.as_secs_f64(), start.elapsed().as_secs_f64(), module.code.len());
        println!("slow: generated in {:.1} s, proved after {:.1} s, {} bytes", words.0, words.1, words.2);
    }
    if report.is_proved() {
        return PROVED.to_owned();
    }
    let text = report.to_string();
    let wrong: Vec<_> = text.lines().filter(|line| !line.contains("degree <")).collect();
    format!("not proved: {}", wrong.join("\n    "))
}

/// A fate without its numbers, to count those of a kind.
fn kind(fate: &str) -> String {
    let last = fate.lines().take(2).map(str::trim).collect::<Vec<_>>().join(" ");
    last.chars().filter(|c| !c.is_ascii_digit()).take(150).collect()
}
