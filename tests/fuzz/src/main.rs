//! Feeds mutated model files to the reader and the generator, and tampered modules to the verifier, for a fixed time.
//!
//! ```text
//! cargo run --package gyro-fuzz -- --seconds 60            a minute, from a seed that is printed
//! cargo run --package gyro-fuzz -- --seed 7 --case 1234    one case again, with its input
//! ```
//!
//! What must hold of any input: no panic, no overflow of the stack, an answer within [`supervise::PATIENCE`], no more
//! than [`supervise::MEMORY_KB`] of memory, and a place in every refusal. Cases run in processes of their own, so that
//! one which does not come back is found too. Case number and seed determine the input.
#![allow(clippy::print_stdout, reason = "a program that prints what it finds")]

mod case;
mod corpus;
mod supervise;
mod text;
mod tree;

use std::env;
use std::process::ExitCode;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// What the command line asks for.
struct Request {
    seconds: u64,
    seed: u64,
    /// Only this case, in this process.
    case: Option<u64>,
    /// Every so-manieth case from a first one, in this process: what a child does.
    child: Option<[u64; 2]>,
}

fn request() -> Result<Request, String> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.as_secs());
    let mut request = Request { seconds: 60, seed: now, case: None, child: None };
    let mut words = env::args().skip(1);
    while let Some(word) = words.next() {
        let mut number = || {
            let value = words.next().and_then(|value| value.parse().ok());
            value.ok_or_else(|| format!("{word}: a whole number was expected"))
        };
        match word.as_str() {
            "--seconds" => request.seconds = number()?,
            "--seed" => request.seed = number()?,
            "--case" => request.case = Some(number()?),
            "--child" => request.child = Some([number()?, number()?]),
            other => return Err(format!("{other}: --seconds, --seed or --case was expected")),
        }
    }
    Ok(request)
}

fn main() -> ExitCode {
    let request = match request() {
        Ok(request) => request,
        Err(words) => {
            eprintln!("error: {words}");
            return ExitCode::from(2);
        }
    };
    let corpus = corpus::Corpus::read();
    if let Some([first, stride]) = request.child {
        case::run_all(&corpus, request.seed, first, stride);
        return ExitCode::SUCCESS;
    }
    if let Some(index) = request.case {
        let case = case::Case::new(&corpus, request.seed, index);
        println!("{case}");
        println!("{}", case.run());
        return ExitCode::SUCCESS;
    }
    println!("seed {}", request.seed);
    supervise::supervise(request.seed, Duration::from_secs(request.seconds))
}
