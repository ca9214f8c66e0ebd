//! Scenarios of a mechanism that is compiled or interpreted in this process, with the bits of the program that rustc
//! compiles.

use crate::child::sensitive::{Sensitive, plain};
use crate::child::{Job, Scenarios, packs, whole};
use gyro_jit::{Compiled, Interpreted, check, simulate};
use gyro_model::Model;
use gyro_runner::motion::COLUMNS;
use gyro_sim::lanes::f64x8;
use gyro_sim::{Dual, Scalar};
use std::sync::Arc;

/// A mechanism whose scenarios are run in this process. Clones share its code, one for each thread.
#[derive(Clone, Debug)]
pub struct InProcess {
    /// Its model file, of which the rules for parameters are.
    pub model: Arc<Model>,
    /// The mechanism.
    pub mechanism: Compiled<f64>,
    /// What is known of its runs, where each scenario is a whole run; without it they run in the lanes of packs.
    pub runs: Option<gyro_jit::Runs>,
}

impl InProcess {
    /// What runs the scenarios of a job.
    pub fn scenarios(self, job: &'static Job) -> Scenarios {
        let Self { model, mechanism, runs } = self;
        let is_sensitive = !job.keep.by.is_empty();
        let own = if is_sensitive { plain(job) } else { job };
        let duals = with::<Dual<f64, { COLUMNS }>>(mechanism.interpreted());
        let one = {
            let mechanism = mechanism.clone();
            move |parameters: &[f64]| {
                let mut mechanism = mechanism.clone();
                mechanism.set_parameters(parameters);
                mechanism
            }
        };
        let Some(runs) = runs else {
            let check = move |parameters: &[f64]| {
                check(&model, parameters).map_err(|refused| {
                    let name = &model.parameters[usize::from(refused.parameter)].name;
                    format!("the mechanism cannot have this value of `{name}`")
                })
            };
            let inner = packs::begin(own, one.clone(), with::<f64x8>(mechanism.interpreted()), check);
            return match is_sensitive {
                true => Scenarios::new(job, Sensitive::new(job, inner, one, duals)),
                false => Scenarios::new(job, inner),
            };
        };
        let built = one.clone();
        let inner = whole::begin(
            own,
            Box::new(move |parameters, plan, start, tell| {
                simulate(&mut built(parameters), runs, plan, start, tell)
            }),
        );
        match is_sensitive {
            true => Scenarios::new(job, Sensitive::new(job, inner, one, duals)),
            false => Scenarios::new(job, inner),
        }
    }
}

/// The mechanism with other parameters.
fn with<T: Scalar>(mechanism: Interpreted<T>) -> impl Fn(&[T]) -> Interpreted<T> {
    move |parameters| {
        let mut mechanism = mechanism.clone();
        mechanism.set_parameters(parameters);
        mechanism
    }
}
