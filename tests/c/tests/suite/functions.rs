//! The elementary functions that exported C brings along have the bits of those that Rust calls.

use crate::program::{compiled, folder, model_and_module};
use chacha20::ChaCha8Rng;
use gyro_codegen::tape::Operation;
use gyro_export::Precision;
use gyro_program::elementary::Function;
use gyro_sim::{Elementary, Real};
use rand::{RngExt, SeedableRng};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::process::{Command, Stdio};

const PAGE: &str = "tests/models/friction.toml";

/// Pairs of numbers come in, and the functions' values go out, one after the other.
const MAIN: &str = "
#include <stdio.h>

int main(void)
{
    static real x[2], out[N];
    while (fread(x, sizeof x, 1, stdin) == 1) {
CALLS        fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
";

/// A number type of C.
trait Number: Real {
    const PRECISION: Precision;
    const NAME: &'static str;
    fn of_bits(bits: u64) -> Self;
    fn bytes(self) -> Vec<u8>;
    fn of_bytes(bytes: &[u8]) -> Self;
}

impl Number for f64 {
    const PRECISION: Precision = Precision::F64;
    const NAME: &'static str = "double";
    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits)
    }
    fn bytes(self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }
    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_le_bytes(bytes.try_into().expect("eight bytes"))
    }
}

impl Number for f32 {
    const PRECISION: Precision = Precision::F32;
    const NAME: &'static str = "float";
    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }
    fn bytes(self) -> Vec<u8> {
        self.to_le_bytes().to_vec()
    }
    fn of_bytes(bytes: &[u8]) -> Self {
        Self::from_le_bytes(bytes.try_into().expect("four bytes"))
    }
}

/// What Rust computes by this name.
fn called(function: Function) -> Elementary {
    match function {
        Function::Sqrt => Elementary::Sqrt,
        Function::Sin => Elementary::Sin,
        Function::Cos => Elementary::Cos,
        Function::Tanh => Elementary::Tanh,
        Function::Atan2 => Elementary::Atan2,
        Function::Exp => Elementary::Exp,
        Function::Ln => Elementary::Ln,
        Function::Abs => Elementary::Abs,
        Function::Floor => Elementary::Floor,
        Function::When => Elementary::When,
        Function::Unless => Elementary::Unless,
        Function::Curve { .. } => unreachable!("it is none of all"),
    }
}

/// The source of a mechanism that calls all functions, one after the other in the place of those that it has, with a
/// program that calls them, too.
fn source(precision: Precision, real: &str) -> (String, [String; 2]) {
    let (model, mut module) = model_and_module(PAGE, None);
    let mut next = Function::ALL.into_iter().cycle();
    let kernels = module.scheduled.kernels.values_mut();
    for operation in kernels.flat_map(|kernel| &mut kernel.tape.outside.operations) {
        if let Operation::Call(called, _) = operation {
            *called = next.next().expect("it goes round");
        }
    }
    let exported = gyro_export::c(PAGE, &model, &module.scheduled, precision);
    let mut calls = String::new();
    for (place, function) in Function::ALL.into_iter().enumerate() {
        let name = function.properties().in_c[precision as usize];
        assert!(exported.source.contains(&format!("{name}(")), "{name} is called");
        let operands = ["x[0]", "x[0], x[1]"][function.arity() - 1];
        writeln!(calls, "        out[{place}] = {name}({operands});").expect("a string");
    }
    let main = MAIN.replace("real", real).replace("[N]", &format!("[{}]", Function::ALL.len()));
    let main = main.replace("CALLS", &calls);
    (model.name, [exported.header, exported.source + &main])
}

/// Numbers of every size and sign, what is usual, and what is special.
fn arguments<T: Number>() -> Vec<[T; 2]> {
    let mut dice = ChaCha8Rng::seed_from_u64(31);
    let special = [0.0, 1.0, 0.5, 5e-324, 1e-45, f64::MIN_POSITIVE, 1e-40, 1.2e-38, f64::MAX, 3.4e38];
    let limits = [709.78, 709.79, 708.4, 745.13, 745.14, 88.72, 88.73, 87.34, 103.97, 103.98, f64::INFINITY];
    let special: Vec<T> =
        special.iter().chain(&limits).flat_map(|&x| [x, -x]).chain([f64::NAN]).map(T::constant).collect();
    let mut pairs: Vec<[T; 2]> = special.iter().flat_map(|&x| special.iter().map(move |&y| [x, y])).collect();
    for _ in 0..100_000 {
        pairs.push([(); 2].map(|()| T::of_bits(dice.random())));
        for largest in [1.0, 30.0, 110.0, 760.0] {
            pairs.push([(); 2].map(|()| T::constant(dice.random_range(-largest..largest))));
        }
        // Near one, where logarithms are small, and halves, where whole numbers begin.
        let near = T::constant(1.0 + dice.random_range(-1e-3..1e-3));
        pairs.push([near, T::constant(f64::from(dice.random_range(-9..9)) / 2.0)]);
        pairs.push([T::constant(f64::from(dice.random_range(-9..9)) / 2.0), near]);
    }
    pairs
}

fn check<T: Number>() {
    let (name, [header, source]) = source(T::PRECISION, T::NAME);
    let folder = folder(&name, "functions", T::PRECISION, "here");
    let file = format!("{name}.c");
    fs::write(folder.join(format!("{name}.h")), header).expect("a file");
    fs::write(folder.join(&file), source).expect("a file");
    let Some(program) = compiled(&folder, (PAGE, "functions"), &[&file], &[]) else { return };
    let arguments = arguments::<T>();
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let bytes: Vec<u8> = arguments.as_flattened().iter().flat_map(|x| x.bytes()).collect();
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("it reads all");
    let found: Vec<T> = output.stdout.chunks_exact(size_of::<T>()).map(T::of_bytes).collect();
    assert_eq!(found.len(), arguments.len() * Function::ALL.len());
    for (operands, found) in arguments.iter().zip(found.chunks_exact(Function::ALL.len())) {
        for (function, c) in Function::ALL.into_iter().zip(found) {
            let rust = T::call(called(function), *operands);
            let is_same = rust.bytes() == c.bytes() || rust.to_f64().is_nan() && c.to_f64().is_nan();
            let name = function.name();
            assert!(is_same, "{name} of {operands:?} is {rust:?} in Rust and {c:?} in C");
        }
    }
}

#[test]
fn elementary_functions_in_c_have_the_bits_of_rust() {
    check::<f64>();
    check::<f32>();
}
