//! The arguments of `simulate`.

use clap::{Args, ValueEnum};
use gyro_model::{Direction, Rational, parse_decimal};
use gyro_runner::{Between, Coordinates, Correction, Integrator, When, listed};
use std::path::PathBuf;

/// Simulate a model
///
/// Prints a summary and writes a CSV file and plots. Settings that no option gives are taken from the table
/// `simulation` of the model file, and what that does not give is chosen: joint coordinates where there are any, and
/// error control. The summary says what was chosen. If an option is given twice, the last one counts. All times are in
/// seconds.
#[derive(Clone, Debug, Default, Args)]
#[command(
    args_override_self = true,
    after_help = "Examples:
  {program} simulate models/gyroscope.toml
  {program} simulate models/gyroscope.toml --t-end 10
  {program} simulate models/gyroscope.toml --method direct --step 2e-4 --out /tmp/direct
  {program} simulate models/four-bar.toml --verify
  {program} simulate models/four-bar.toml --coordinates maximal --method rk4 --step 1e-4
  {program} simulate models/gyroscope.toml --linearize 0.5 --json
  {program} simulate my-gimbal.toml --set rotor_mass=0.085 --json
  {program} simulate my-gimbal.toml --input motor=torque.csv --input brake=0.01
  {program} simulate examples/pendulum.toml --event hinge=0 --event \"hinge rate>0:stop\"

Exit codes: 0 success; 1 the run failed; 2 the request was invalid; 3 the run completed, but its result is worthless"
)]
pub struct SimulateArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Engine that computes the motion [default: in-process]
    #[arg(long, value_enum)]
    pub(crate) engine: Option<Engine>,
    /// How long generated code is searched for short forms
    #[arg(long, value_enum, default_value_t = Effort::Full)]
    pub(crate) effort: Effort,
    /// Do not prove the functions that run; in this process they are proved beside the run
    #[arg(long)]
    pub(crate) no_prove: bool,
    /// Length of the run
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) t_end: Option<f64>,
    /// Largest step of steps of fixed length; intervals are divided into equal steps
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) step: Option<f64>,
    /// Interval between corrections of the dependent coordinates, at steps of fixed length in maximal coordinates
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) correct_every: Option<f64>,
    /// The integrator, as --integrator; or a short word for a correction: partitioned (partition) or direct (none)
    #[arg(long, value_name = "NAME", value_parser = method)]
    pub(crate) method: Option<MethodName>,
    /// The integrator: rk4 (fixed steps), tsit5, dop853, or rodas4 for stiff scenes [default: the model file's; else
    /// rk4 with --step or --correct-every, and dop853 or, where the scene is stiff, rodas4 without]
    #[arg(long, value_name = "NAME", value_parser = integrator)]
    pub(crate) integrator: Option<Integrator>,
    /// Error tolerance of each step, relative and absolute; steps are then as long as it allows [default: the model
    /// file's; else 1e-9 unless steps are fixed, by rk4, --step or --correct-every]
    #[arg(long, value_name = "TOL", value_parser = tolerance, allow_hyphen_values = true, conflicts_with = "step")]
    pub(crate) tolerance: Option<f64>,
    /// What is integrated: positions and Euler parameters of all bodies, or joint coordinates (generated code
    /// only) [default: the model file's; else maximal with an option of corrections, and joint where there are any]
    #[arg(long, value_name = "maximal|joint", value_parser = coordinates)]
    pub(crate) coordinates: Option<Coordinates>,
    /// How constraints are enforced in maximal coordinates: partition, closed-form (generated code with joint
    /// coordinates), mass-weighted, baumgarte=RATE, none [default: the model file's, else partition]
    #[arg(long, value_name = "NAME", value_parser = correction)]
    pub(crate) correction: Option<Correction>,
    /// When constraints are corrected: steps=K or violation=SIZE [default: --correct-every; every step under error
    /// control]
    #[arg(long, value_name = "WHEN", value_parser = when, overrides_with = "correct_every")]
    pub(crate) correct_when: Option<When>,
    /// Maximum number of steps [default: 10 million under error control]. A run with fixed steps that would take more
    /// than an hour needs a budget
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u64).range(1..), allow_hyphen_values = true)]
    pub(crate) budget: Option<u64>,
    /// Run a second time with a finer step or tolerance and report how far the result can be trusted
    #[arg(long)]
    pub(crate) verify: bool,
    /// End the run at this time, 0 for the start, and print the linearisation of the joint coordinates there, with
    /// loops of independent ones: A, B, eigenvalues, frequencies and damping ratios
    #[arg(long, value_name = "S", value_parser = seconds_or_none, allow_hyphen_values = true, conflicts_with = "t_end")]
    pub(crate) linearize: Option<f64>,
    /// Number type of the run
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    pub(crate) precision: Precision,
    /// Interval between samples [default: the model file's, at fixed steps on the nearest whole number of corrections]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) every: Option<f64>,
    /// Value of one of the model's parameters; may be given several times. The start is assembled again
    #[arg(long, value_name = "PARAMETER=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, Rational)>,
    /// Value of one of the model's inputs, once for each input: a number, or a CSV file with two columns, time and
    /// value. Between rows the input is held, linear or smooth (a natural cubic spline): as said before the file's
    /// name, or in the model file, else linear; before the first and after the last row it is held. A step of fixed
    /// length uses the value at its start; under error control steps end where the input is not smooth. Inputs that
    /// are not set keep the model file's value
    #[arg(long, value_name = "NAME=[held:|linear:|smooth:]FILE.csv|NUMBER", value_parser = set_input)]
    pub(crate) input: Vec<(String, InputSetting)>,
    /// List when a number crosses a level, beside the [[event]] of the model file: what crosses is a column of the
    /// run's table, or a formula of columns and parameters such as `pan rate - 2*tilt`; `=` for any direction, `>` for
    /// upwards, `<` for downwards; with `:stop` the run ends there. Crossings are those of the interpolated motion, to
    /// rounding; missed may be two that are less than an eighth of a step apart (docs/events.md). May be given several
    /// times
    #[arg(long, value_name = "FORMULA{=|>|<}LEVEL[:stop]", value_parser = event)]
    pub(crate) event: Vec<EventSetting>,
    /// Refuse a model with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
    /// Folder for the CSV file and the plots [default: out/NAME; none with --json]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else: the last sample, what its numbers are, and the files
    /// with all samples
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Generated code in this process: compiled at once, or interpreted where this program has no compiler
    #[value(alias = "jit")]
    InProcess,
    /// Generated code as a program that rustc compiles: the same results to the last bit, after many seconds
    Generated,
    /// The runtime-assembled model, to compare with: in its careful form for trees of revolute, spherical and fixed
    /// joints, else in the paper's plain dense one
    Assembled,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Effort {
    /// Few forms of each function: generated sooner, seldom much slower
    Quick,
    /// All forms
    #[default]
    Full,
}

/// What `--method` names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MethodName {
    By(Integrator),
    Kept(Correction),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Precision {
    F32,
    #[default]
    F64,
}

impl SimulateArgs {
    /// The engine that was asked for.
    pub(crate) fn engine(&self) -> Engine {
        self.engine.unwrap_or(Engine::InProcess)
    }

    /// The integrator that was asked for.
    pub(crate) fn integrator(&self) -> Option<Integrator> {
        self.integrator.or(match self.method {
            Some(MethodName::By(integrator)) => Some(integrator),
            _ => None,
        })
    }

    /// The correction that was asked for.
    pub(crate) fn correction(&self) -> Option<Correction> {
        self.correction.or(match self.method {
            Some(MethodName::Kept(correction)) => Some(correction),
            _ => None,
        })
    }
}

impl Engine {
    /// Whether it computes what the generator derives.
    pub(crate) fn is_generated(self) -> bool {
        self != Self::Assembled
    }

    /// Its name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::InProcess => "in-process",
            Self::Generated => "generated",
            Self::Assembled => "assembled",
        }
    }
}

impl Precision {
    /// The Rust type.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

impl From<Effort> for gyro_codegen::Effort {
    fn from(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self::Quick,
            Effort::Full => Self::Full,
        }
    }
}

/// What `--input` sets an input to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum InputSetting {
    /// A constant value.
    Number(f64),
    /// A CSV file of times and values, and what is between them if that is said.
    File(PathBuf, Option<Between>),
    /// Times and values, from a program that is not a command line.
    #[cfg_attr(not(feature = "jit"), expect(dead_code, reason = "only programs give them"))]
    Rows(Vec<[f64; 2]>),
}

/// What `--event` looks for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EventSetting {
    /// As it was written.
    pub(crate) text: String,
    /// What crosses, a formula of columns.
    pub(crate) of: String,
    pub(crate) level: Rational,
    pub(crate) direction: Direction,
    pub(crate) stops: bool,
}

fn event(text: &str) -> Result<EventSetting, String> {
    let expected = "a column or a formula of some, =, > or <, and a level were expected, such as hinge=0.5 or \"hinge rate>0:stop\"";
    let at = text.find(['=', '<', '>']).ok_or(expected)?;
    let direction = match &text[at..=at] {
        ">" => Direction::Rising,
        "<" => Direction::Falling,
        _ => Direction::Both,
    };
    let (of, level) = (text[..at].trim(), &text[at + 1..]);
    let (level, stops) = level.strip_suffix(":stop").map_or((level, false), |level| (level, true));
    if of.is_empty() {
        return Err(expected.to_owned());
    }
    let level = parse_decimal(level.trim())
        .ok_or_else(|| format!("`{}` is not a decimal number, such as -0.08 or 8e-2", level.trim()))?;
    Ok(EventSetting { text: text.to_owned(), of: of.to_owned(), level, direction, stops })
}

fn set_input(text: &str) -> Result<(String, InputSetting), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("NAME=FILE.csv or NAME=NUMBER was expected, such as motor=torque.csv or motor=0.02")?;
    let (name, value) = (name.trim().to_owned(), value.trim());
    match value.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((name, InputSetting::Number(number))),
        Ok(_) => Err(format!("`{value}` is not a finite number")),
        Err(_) if value.is_empty() => Err(format!("a value is missing after `{name}=`")),
        Err(_) => {
            let (file, between) = table(value);
            Ok((name, InputSetting::File(file, between)))
        }
    }
}

/// The file of a table, perhaps with a word and a colon before it.
pub(crate) fn table(text: &str) -> (PathBuf, Option<Between>) {
    let known = [("held", Between::Held), ("linear", Between::Linear), ("smooth", Between::Smooth)];
    let found = text.split_once(':').and_then(|(word, file)| {
        let (_, between) = known.iter().find(|(known, _)| *known == word.trim())?;
        Some((PathBuf::from(file.trim()), Some(*between)))
    });
    found.unwrap_or_else(|| (PathBuf::from(text), None))
}

fn method(text: &str) -> Result<MethodName, String> {
    match text {
        "partitioned" => Ok(MethodName::Kept(Correction::Partition)),
        "direct" => Ok(MethodName::Kept(Correction::None)),
        _ => text
            .parse()
            .map(MethodName::By)
            .map_err(|()| format!("{}, partitioned or direct was expected", names().join(", "))),
    }
}

fn integrator(text: &str) -> Result<Integrator, String> {
    text.parse().map_err(|()| format!("{} was expected", listed(|_| true)))
}

fn names() -> Vec<&'static str> {
    Integrator::ALL.iter().map(|method| method.name()).collect()
}

fn coordinates(text: &str) -> Result<Coordinates, String> {
    text.parse().map_err(|()| "maximal or joint was expected".to_owned())
}

fn correction(text: &str) -> Result<Correction, String> {
    let expected =
        "partition, closed-form, mass-weighted, baumgarte=RATE or none was expected, such as baumgarte=100";
    text.parse().map_err(|()| expected.to_owned())
}

fn when(text: &str) -> Result<When, String> {
    text.parse()
        .map_err(|()| "steps=K or violation=SIZE was expected, such as steps=5 or violation=1e-10".to_owned())
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("a number above 0 and at most 1 was expected, such as 1e-9".to_owned()),
    }
}

fn seconds_or_none(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("0 or a positive number of seconds was expected, such as 0.5".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number of seconds was expected, such as 1e-4".to_owned()),
    }
}

fn setting(text: &str) -> Result<(String, Rational), String> {
    let (name, value) =
        text.split_once('=').ok_or("PARAMETER=VALUE was expected, such as rotor_mass=0.08")?;
    let exact = parse_decimal(value)
        .ok_or_else(|| format!("`{}` is not a decimal number, such as -0.08 or 8e-2", value.trim()))?;
    Ok((name.trim().to_owned(), exact))
}
