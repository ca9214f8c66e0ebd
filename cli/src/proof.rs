//! Proofs beside runs: what runs in this process is proved by a second thread, from the start of the run on.

use crate::failure::Failure;
use crate::scene::Scene;
use crate::verify::judge;
use gyro_codegen::{Effort, Functions, Kernel, Module};
use gyro_jit::Input;
use gyro_model::Model;
use gyro_verifier::{Clif, Depth, Report, same_in_clif, with_proof};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How long a run that is over waits for its proof, which takes 0.1 to 3 s.
const PATIENCE: Duration = Duration::from_secs(3);

/// Of the generator and the verifier: expressions are walked by recursion.
const STACK: usize = 64 << 20;

/// A proof under way.
#[derive(Debug)]
pub(crate) struct Proof {
    began: Instant,
    /// Takes what is compiled, to be compared with what is proved.
    compiled: Sender<Compiled>,
    /// The text of the functions, then the same with what was proved in its head.
    news: Receiver<News>,
}

/// What Cranelift is given; nothing where kernels are interpreted.
#[derive(Debug, Default)]
pub(crate) struct Compiled {
    kernels: Vec<(Kernel, String)>,
    tables: Vec<f64>,
}

#[derive(Debug)]
enum News {
    Written(Box<Module>),
    Ended(Box<Result<(Report, Module), Failure>>),
}

/// What is known of the functions of a run when it is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Standing {
    /// With what is given to the compiler.
    Proved,
    /// Kernels are interpreted: what is proved is their text.
    TextProved,
    /// Something is undecided; a warning says what.
    Undecided,
    /// Nothing is wrong so far, after this many seconds.
    NotRefuted(f64),
}

impl Compiled {
    /// Hears of one kernel more.
    pub(crate) fn hear(&mut self, input: Input<'_>) {
        self.kernels.push((input.kernel, input.clif));
        self.tables = input.tables.to_vec();
    }
}

impl Proof {
    /// Begins to prove these functions of a scene.
    pub(crate) fn begin(scene: &Scene, functions: &Functions) -> Self {
        let (compiled, given) = channel();
        let (tell, news) = channel();
        let (page, name, effort) = (scene.page.clone(), scene.page_name.clone(), scene.effort);
        let functions = functions.clone();
        let prove = move || {
            // Nobody listens any more where a run has failed.
            let _ = prove((&page, &name), (&functions, effort), &given, &tell);
        };
        // Where there is no thread, nothing is heard of it, and that is what the summary says.
        let _ = thread::Builder::new().name("proof".to_owned()).stack_size(STACK).spawn(prove);
        Self { began: Instant::now(), compiled, news }
    }

    /// Tells what runs.
    pub(crate) fn compare_with(&self, compiled: Compiled) {
        // It may have ended by itself.
        let _ = self.compiled.send(compiled);
    }

    /// Waits for the end of the proof as long as a run waits; gives the text of the functions besides, with what was
    /// proved in its head.
    ///
    /// # Errors
    /// The functions are refuted, or what was compiled is not what was proved.
    pub(crate) fn settle(self) -> Result<(Standing, Option<Module>), Failure> {
        let deadline = Instant::now() + PATIENCE;
        let mut written = None;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.news.recv_timeout(left) {
                Ok(News::Written(module)) => written = Some(*module),
                Ok(News::Ended(end)) => {
                    let (report, module) = (*end)?;
                    judge(&report)?;
                    let standing = match report.is_proved() {
                        true if cfg!(feature = "jit") => Standing::Proved,
                        true => Standing::TextProved,
                        false => Standing::Undecided,
                    };
                    return Ok((standing, Some(module)));
                }
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    return Ok((Standing::NotRefuted(self.began.elapsed().as_secs_f64()), written));
                }
            }
        }
    }
}

impl Standing {
    /// In words that follow the engine's name.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Proved => "proved".to_owned(),
            Self::TextProved => "interpreted, proved as text".to_owned(),
            Self::Undecided => "not all proved".to_owned(),
            Self::NotRefuted(seconds) => format!("not refuted within {seconds:.1} s"),
        }
    }
}

/// Generates the text, proves it, and compares it with what is compiled.
fn prove(
    (page, name): (&Model, &str),
    (functions, effort): (&Functions, Effort),
    given: &Receiver<Compiled>,
    tell: &Sender<News>,
) -> Option<()> {
    let module = match gyro_codegen::generate_by_effort(name, page, functions, effort) {
        Ok(module) => module,
        Err(error) => return tell.send(News::Ended(Box::new(Err(Failure::Usage(error.to_string()))))).ok(),
    };
    tell.send(News::Written(Box::new(module.clone()))).ok()?;
    let (code, report) = with_proof(page, &module.code, &module.constants, Depth::Quick);
    // A run that fails gives nothing.
    let Compiled { kernels, tables } = given.recv().ok()?;
    let clif: Vec<Clif<'_>> =
        kernels.iter().map(|(kernel, text)| Clif { name: kernel.name(), text, tables: &tables }).collect();
    let same = match &clif[..] {
        [] => Ok(()),
        clif => same_in_clif(page, (&module.code, &module.constants), clif).map(|_| ()),
    };
    let end = same.map(|()| (report, Module { code, ..module })).map_err(|refusal| {
        Failure::Run(format!(
            "what is compiled is not what was proved; this is a mistake of gyro-jit: please report it with the model \
             file\n{refusal}"
        ))
    });
    tell.send(News::Ended(Box::new(end))).ok()
}

#[cfg(all(test, feature = "jit"))]
mod tests;
