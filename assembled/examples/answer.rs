//! The runtime-assembled model as a program beside which generated ones are measured: `answer MODEL FORM PRECISION`
//! answers requests on standard input. The command line makes it where it is not optimised itself.

use gyro_assembled::child;
use std::{env, fs, path::Path, process::ExitCode};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [_, file, form, precision] = &arguments[..] else {
        panic!("a word, a model file, a form and a precision were expected")
    };
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let text = fs::read_to_string(file).expect("the model file can be read");
    let mut load = |table: &str| fs::read_to_string(folder.join(table)).map_err(|e| e.to_string());
    let mut model =
        gyro_model::read_with(file, &text, &mut load).unwrap_or_else(|e| panic!("{}", e.render()));
    model.counts_work = true;
    child::main(&model, form, precision)
}
