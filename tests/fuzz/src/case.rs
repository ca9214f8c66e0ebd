//! One case: an input made from the corpus, and what becomes of it.

use crate::corpus::{Corpus, Emitted, TABLE};
use crate::{text, tree};
use chacha20::ChaCha8Rng;
use gyro_model::{Model, read_with};
use gyro_verifier::{Depth, verify};
use rand::{RngExt, SeedableRng};
use std::cell::RefCell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};

/// What is fed to whom.
pub enum Case {
    /// A model file and the table that all its motions name; it is generated and proved too if it is good and small.
    Page { text: String, table: String },
    /// A model file's module, and its constants, not as they were written.
    Module { page: String, module: String, constants: String },
}

/// Bodies of the largest model file that is generated: what is larger takes seconds, which others make better use of.
const GENERATED: usize = 3;

/// What became of a good model file whose module the verifier calls wrong.
pub const REFUTED: &str = "generated and refuted";

impl Case {
    pub fn new(corpus: &Corpus, seed: u64, index: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(index);
        if random.random_bool(0.1) {
            let emitted = &corpus.modules[random.random_range(0..corpus.modules.len())];
            return tampered(&mut random, emitted);
        }
        let page = &corpus.pages[random.random_range(0..corpus.pages.len())].1;
        let as_tree = if random.random_bool(0.6) { tree::changed(&mut random, page) } else { None };
        let text = as_tree.unwrap_or_else(|| text::changed(&mut random, page));
        let table =
            if random.random_bool(0.8) { TABLE.to_owned() } else { text::changed(&mut random, TABLE) };
        Self::Page { text, table }
    }

    /// What became of it, in a word.
    ///
    /// # Panics
    /// If something does not hold that must hold of every input.
    pub fn run(&self) -> &'static str {
        match self {
            Self::Page { text, table } => match read(text, table) {
                None => "refused",
                Some(model) if model.coordinate_bodies().len() > GENERATED => "read",
                Some(model) => generate(&model),
            },
            Self::Module { page, module, constants } => {
                let model = read(page, TABLE).expect("a shipped model file is good");
                let report = verify(&model, module, constants, Depth::Quick);
                let lines = module.lines().count().max(constants.lines().count()).max(1);
                let is_placed = |line: usize| (1..=lines).contains(&line);
                assert!(report.refusals.iter().all(|r| is_placed(r.line)), "{report}");
                // A comment, or a space, may be anything.
                if report.is_proved() { "proved" } else { "not proved" }
            }
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Page { text, table } => write!(f, "--- model file\n{text}\n--- table\n{table}\n---"),
            Self::Module { module, constants, .. } => {
                write!(f, "--- module\n{module}\n--- constants\n{constants}\n---")
            }
        }
    }
}

fn tampered(random: &mut ChaCha8Rng, emitted: &Emitted) -> Case {
    let page = emitted.page.clone();
    let [module, constants] = emitted.module();
    if random.random_bool(0.7) {
        Case::Module { page, module: text::changed(random, module), constants: constants.clone() }
    } else {
        Case::Module { page, module: module.clone(), constants: text::changed(random, constants) }
    }
}

/// The model of a model file, if it is good.
fn read(text: &str, table: &str) -> Option<Model> {
    match read_with("fuzz.toml", text, &mut |_| Ok(table.to_owned())) {
        Ok(model) => {
            let start = model.assemble().expect("an accepted model file has a start");
            assert!(start.q.iter().chain(&start.v).all(|x| x.is_finite()), "the start is finite");
            Some(model)
        }
        Err(mistakes) => {
            let rendered = mistakes.render();
            assert!(!mistakes.mistakes().is_empty() && rendered.contains("fuzz.toml:"), "{rendered}");
            assert!(rendered.len() < 200_000, "messages of {} bytes", rendered.len());
            None
        }
    }
}

fn generate(model: &Model) -> &'static str {
    match gyro_codegen::generate_functions("fuzz.toml", model, &gyro_codegen::Functions::all()) {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            "read, not generated"
        }
        Ok(module) => {
            let report = verify(model, &module.code, &module.constants, Depth::Quick);
            if !report.is_refuted() {
                return "generated";
            }
            eprintln!("{report}");
            REFUTED
        }
    }
}

thread_local! {
    /// Where the last panic was, and its message.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs cases until the process is ended. Before each its number is printed, after it what became of it.
pub fn run_all(corpus: &Corpus, seed: u64, first: u64, stride: u64) {
    panic::set_hook(Box::new(|info| PANIC.set(info.to_string().replace('\n', " "))));
    for index in (first..).step_by(usize::try_from(stride).unwrap_or(1)) {
        println!("begin {index}");
        let outcome = panic::catch_unwind(AssertUnwindSafe(|| Case::new(corpus, seed, index).run()));
        match outcome {
            Ok(word) => println!("end {word}"),
            Err(_) => println!("panic {}", PANIC.take().chars().take(600).collect::<String>()),
        }
    }
}
