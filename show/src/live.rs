//! A mechanism that is computed in the page.

use serde::Serialize;
use serde_json::Value;

/// A mechanism as WebAssembly, and how the page's first run is computed with it.
#[derive(Clone, Debug, Serialize)]
pub struct Live {
    /// The table that the run time of exported modules reads.
    pub about: Value,
    /// The module.
    #[serde(skip)]
    pub module: Vec<u8>,
    /// What integrates: `tsit5`, `dop853` or `rodas4`.
    pub method: &'static str,
    /// Its tolerance, relative and absolute.
    pub tolerance: f64,
    /// Parameters, as the first run has them.
    pub parameters: Vec<Setting>,
    /// Inputs, as they are at the start.
    pub inputs: Vec<Setting>,
    /// How parameters change what is drawn.
    pub slopes: Vec<Slope>,
    /// What the first run has and the page computes without: it says so.
    pub without: Vec<String>,
}

/// Something that can be set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit, if one is known.
    pub unit: String,
}

/// How a number of a [`crate::Mechanism`] changes with a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// Where the number is: a JSON pointer (RFC 6901).
    pub path: String,
    /// Its value with the parameters of the first run.
    pub base: f64,
    /// Index of the parameter.
    pub parameter: usize,
    /// Its derivative.
    pub slope: f64,
}
