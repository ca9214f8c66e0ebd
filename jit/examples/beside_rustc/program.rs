//! What the program does that has the modules: comparing, and timing in turns.

use crate::pair;
use gyro_codegen::{Effort, Functions};
use gyro_model::Model;
use gyro_sim::{
    CorrectedDynamics, CorrectedSolution, Dynamics, JointSpace, Kinematics, Mechanism, Partition, Projection,
};
use gyro_verifier::{Clif, same_in_clif};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// Rounds of which the median counts, and how long each of them takes, s.
const ROUNDS: usize = 41;
const ROUND: f64 = 1e-3;

pub struct Program {
    is_timed: bool,
    n_models: usize,
    n_kernels: usize,
}

impl Program {
    pub fn new(is_timed: bool) -> Self {
        Self { is_timed, n_models: 0, n_kernels: 0 }
    }

    #[allow(dead_code, reason = "all mechanisms of a program may have joint coordinates")]
    pub fn check<M>(&mut self, name: &str, text: &str, folder: Option<&str>, rustc: M)
    where
        M: Clone
            + Mechanism<Scalar = f64>
            + Kinematics
            + Dynamics
            + CorrectedDynamics
            + Projection
            + Partition,
    {
        let model = model(name, text, folder);
        prove(name, &model);
        self.count(pair::check(name, &model, rustc.clone()));
        if self.is_timed {
            let ours = gyro_jit::compile::<f64>(&model, &Functions::of_solvers(), Effort::Full).unwrap();
            time(name, &rustc, &ours);
        }
    }

    pub fn check_with_joints<M>(&mut self, name: &str, text: &str, folder: Option<&str>, rustc: M)
    where
        M: Clone
            + Mechanism<Scalar = f64>
            + Kinematics
            + Dynamics
            + CorrectedSolution
            + Projection
            + Partition
            + JointSpace,
    {
        let model = model(name, text, folder);
        prove(name, &model);
        self.count(pair::check_with_joints(name, &model, rustc.clone()));
        if self.is_timed {
            let ours = gyro_jit::compile::<f64>(&model, &Functions::of_solvers(), Effort::Full).unwrap();
            let (x, mut rates) = (rustc.joint_start(), rustc.joint_buffers().rates);
            let (our_x, mut our_rates) = (ours.joint_start(), ours.joint_buffers().rates);
            line(
                name,
                "joint_accelerations",
                &mut || rustc.joint_accelerations(0.1, black_box(&x), &mut rates),
                &mut || ours.joint_accelerations(0.1, black_box(&our_x), &mut our_rates),
            );
            time(name, &rustc, &ours);
        }
    }

    fn count(&mut self, n_kernels: usize) {
        self.n_models += 1;
        self.n_kernels += n_kernels;
    }

    pub fn tell(&self) {
        println!("{} model files, {} kernels: the same bits", self.n_models, self.n_kernels);
    }
}

fn model(name: &str, text: &str, folder: Option<&str>) -> Model {
    let mut load = |table: &str| match folder {
        Some(folder) => std::fs::read_to_string(Path::new(folder).join(table)).map_err(|e| e.to_string()),
        None => gyro_pages::load(table),
    };
    gyro_model::read_with(name, text, &mut load).unwrap_or_else(|error| panic!("{error}"))
}

/// What Cranelift is given is read back and held against the module.
fn prove(name: &str, model: &Model) {
    let functions = Functions::of_solvers();
    let module = gyro_codegen::generate_functions("page.toml", model, &functions).unwrap();
    let scheduled = gyro_codegen::schedule(model, &functions, Effort::Full).unwrap();
    let (mut given, mut tables) = (Vec::new(), Vec::new());
    let mut told = |input: gyro_jit::Input<'_>| {
        given.push((input.kernel.name(), input.clif));
        tables = input.tables.to_vec();
    };
    gyro_jit::compile_scheduled::<f64>(model, scheduled, Some(&mut told)).unwrap();
    let clif: Vec<Clif<'_>> = given.iter().map(|(name, text)| Clif { name, text, tables: &tables }).collect();
    same_in_clif(model, (&module.code, &module.constants), &clif)
        .unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
}

fn time<M: Mechanism<Scalar = f64> + Dynamics>(name: &str, rustc: &M, ours: &gyro_jit::Compiled<f64>) {
    let (y, our_y) = (rustc.start(), ours.start());
    let (mut solved, mut our_solved) = (rustc.acceleration_buffer(), ours.acceleration_buffer());
    line(name, "accelerations", &mut || rustc.accelerations(0.1, black_box(&y), &mut solved), &mut || {
        ours.accelerations(0.1, black_box(&our_y), &mut our_solved)
    });
    let (mut phi, mut our_phi) = (rustc.buffers().constraints, ours.buffers().constraints);
    line(name, "phi", &mut || rustc.phi(0.1, black_box(&y), &mut phi), &mut || {
        ours.phi(0.1, black_box(&our_y), &mut our_phi)
    });
}

/// Times two functions in turns and prints both medians, and the median of the ratios.
fn line(name: &str, what: &str, rustc: &mut dyn FnMut(), ours: &mut dyn FnMut()) {
    let calls = |call: &mut dyn FnMut()| {
        let began = Instant::now();
        (0..100).for_each(|_| call());
        (ROUND / (began.elapsed().as_secs_f64() / 100.0)).max(1.0) as usize
    };
    let n = calls(rustc).min(calls(ours));
    let ns = |call: &mut dyn FnMut()| {
        (0..n / 8).for_each(|_| call());
        let began = Instant::now();
        (0..n).for_each(|_| call());
        1e9 * began.elapsed().as_secs_f64() / n as f64
    };
    let rounds: Vec<[f64; 2]> = (0..ROUNDS).map(|_| [ns(rustc), ns(ours)]).collect();
    let median = |of: fn(&[f64; 2]) -> f64| {
        let mut values: Vec<f64> = rounds.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[ROUNDS / 2]
    };
    println!(
        "{name}, {what}: rustc {:.1} ns, here {:.1} ns, ratio {:.3}",
        median(|[rustc, _]| *rustc),
        median(|[_, ours]| *ours),
        median(|[rustc, ours]| ours / rustc)
    );
}
