//! `cargo xtask verify --stability`: how much the solves of trees lose on extreme configurations, beside the dense
//! runtime-assembled model.

use crate::failure::Failure;
use crate::progress::Spinner;
use crate::side_by_side::side_by_side;
use crate::{chain, files, places, scene};
use chacha20::ChaCha8Rng;
use gyro_assembled::Dense;
use gyro_codegen::{Functions, Kernel};
use gyro_model::{Model, Number, Parameter, Rational};
use gyro_sim::{Dynamics, Mechanism};
use gyro_verifier::field::Precision;
use gyro_verifier::module::Module;
use gyro_verifier::rounding::{KERNELS, Trial, relative_error, trial};
use rand::{RngExt, SeedableRng};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::path::PathBuf;

/// A relative error beyond which a solve has failed.
const FAILURE: f64 = 1e-3;

/// Configurations for each of which a module of its own is generated, in terms of all.
const FOLDED_ONE_IN: usize = 40;

const SEED: u64 = 20_261_121;

const HEAD: &str = "# Stability: what the solves lose on extreme configurations

Measured by `cargo xtask verify --stability COUNT`, COUNT configurations of each kind. Of each mechanism all
masses, inertias and joint points are made parameters; then configurations are drawn at random, and every function that
gives accelerations is compared with itself in 384 bits (`cargo xtask verify` has proved it equal to the textbook). The
error of a configuration is the largest error of a result in terms of the largest result; a failure is an error above
1e-3. All get the same state in `f64`, the reference too, so an error is the function's own. *Dense*: the dense form of
the [runtime-assembled model](glossary.md#runtime-assembled-model), eq. (17) by LU with pivoting, on the same states; it
has no u̇, so beside functions that give u̇, whose errors are in terms of the largest of u̇ and v̇, the table shows its
error in v̇.

Parameters may take any value, so of small trees only the form that cancels nothing is accurate enough to be taken.
Where the numbers are folded into a module, the shortest form that is as accurate for these numbers is: in the last
table of each mechanism a module is generated for each configuration, for every fortieth of them. *In joint frames*: the
modules that go from base inertial parameters, in frames that suit the joints.

";

/// Which configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Nominal,
    Masses(i32),
    Inertias,
    FastSpin,
    LongArms,
    Aligned,
    Violated,
    GimbalLock,
    Everything,
}

const KINDS: [(Kind, &str); 10] = [
    (Kind::Nominal, "as in the model file, any angle, up to 100 rad/s"),
    (Kind::Masses(6), "mass ratios to 1e±6"),
    (Kind::Masses(12), "mass ratios to 1e±12"),
    (Kind::Inertias, "each moment of inertia times 1e±3"),
    (Kind::FastSpin, "the last body at 1e6 rad/s"),
    (Kind::LongArms, "joint points up to 10 m off"),
    (Kind::Aligned, "angles of 0, ±90 and 180 degrees"),
    (Kind::Violated, "constraints violated by up to 1e-2"),
    (Kind::GimbalLock, "the second angle at ±90 degrees, all but the last body 1e-6 of nominal"),
    (Kind::Everything, "all of it"),
];

/// The whole report in Markdown; without model files, of the paper's gyroscope and of a chain of four bodies with
/// skewed axes.
pub(crate) fn report(pages: &[PathBuf], configurations: usize) -> Result<String, Failure> {
    let mut text = HEAD.replace("COUNT", &configurations.to_string());
    for model in models(pages)? {
        text += &table(&model, configurations)?;
        text += &table_of_folded(&model, configurations.div_ceil(FOLDED_ONE_IN))?;
    }
    Ok(text)
}

fn models(pages: &[PathBuf]) -> Result<Vec<Model>, Failure> {
    if pages.is_empty() {
        let chain = gyro_model::read("chain.toml", &chain::model_file(4))
            .map_err(|e| Failure::Usage(e.to_string()))?;
        let root = files::workspace().ok_or_else(places::no_model_file)?;
        return Ok(vec![scene::read(&root.join("models/gyroscope.toml"))?, chain]);
    }
    pages.iter().map(|page| scene::read(page)).collect()
}

/// The model with its masses, inertias and joint points as parameters.
fn freed(model: &Model) -> Model {
    let mut freed = model.clone();
    let mut parameters = std::mem::take(&mut freed.parameters);
    let mut free = |name: String, number: &mut Number| {
        if let Number::Exact(value) = number {
            let index = parameters.len();
            parameters.push(Parameter { name, value: value.clone() });
            *number = Number::Parameter { index, negated: false };
        }
    };
    let moving = model.coordinate_bodies();
    for (k, body) in freed.bodies.iter_mut().enumerate().filter(|(k, _)| moving.contains(k)) {
        free(format!("mass_{k}"), &mut body.mass);
        body.inertia.iter_mut().enumerate().for_each(|(n, moment)| free(format!("inertia_{k}_{n}"), moment));
    }
    for (k, joint) in freed.joints.iter_mut().enumerate() {
        for (side, end) in [("first", &mut joint.first), ("second", &mut joint.second)] {
            let point = end.point.iter_mut().enumerate();
            point.for_each(|(n, number)| free(format!("{side}_{k}_{n}"), number));
        }
    }
    freed.parameters = parameters;
    freed
}

/// Errors of one configuration: of the kernels, and of the dense form.
type Errors = ([f64; KERNELS.len()], f64);

/// A freed model with its generated module.
struct Subject {
    model: Model,
    module: Module,
}

impl Subject {
    fn new(model: &Model) -> Result<Self, Failure> {
        let model = freed(model);
        let generated = gyro_codegen::generate_functions("model.toml", &model, &Functions::of_solvers())
            .map_err(|e| Failure::Usage(e.to_string()))?;
        let module = Module::read(&model, &generated.code, &generated.constants)
            .map_err(|refusal| Failure::Run(refusal.to_string()))?;
        if module.joints.is_none() {
            let words = format!("{} is not an open tree: it has no joint coordinates", model.name);
            return Err(Failure::Usage(words));
        }
        Ok(Self { model, module })
    }

    /// Errors of some configurations of the kind at this place of [`KINDS`].
    fn errors(&self, place: usize, configurations: usize) -> Vec<Errors> {
        let of = |n: usize| self.draw(place, (n, configurations))?.errors(&self.module);
        side_by_side(configurations, of).into_iter().flatten().collect()
    }

    /// The same of modules with the numbers of each configuration.
    fn folded_errors(&self, original: &Model, place: usize, configurations: usize) -> Vec<Folded> {
        let of = |n: usize| self.draw(place, (n, configurations))?.folded_errors(original);
        side_by_side(configurations, of).into_iter().flatten().collect()
    }

    /// One of so many configurations of a kind.
    fn draw(&self, place: usize, (n, configurations): (usize, usize)) -> Option<Configuration> {
        let layout = self.module.joints.as_ref()?;
        let sizes = (layout.n_coordinates, layout.n_rates);
        let mut random = ChaCha8Rng::seed_from_u64(SEED + (place * configurations + n) as u64);
        Some(Configuration::draw(&self.model, &self.module, KINDS[place].0, sizes, &mut random))
    }
}

fn table(model: &Model, configurations: usize) -> Result<String, Failure> {
    let _spinner = Spinner::new(format!("trying configurations of {}", model.name));
    let subject = Subject::new(model)?;
    let mut text = format!(
        "## {}\n\n| configurations | kernel | median | worst | failures | dense: median | worst | failures |\n|---|---|---|---|---|---|---|---|\n",
        model.name
    );
    for (place, (_, words)) in KINDS.into_iter().enumerate() {
        let errors = subject.errors(place, configurations);
        let dense = Column::of(errors.iter().map(|(_, dense)| *dense).collect());
        for (k, kernel) in KERNELS.iter().enumerate() {
            let own = Column::of(errors.iter().map(|(own, _)| own[k]).collect());
            let words = if k == 0 { words } else { "" };
            let _ = writeln!(text, "| {words} | {kernel} | {own} | {dense} |");
        }
    }
    text.push('\n');
    Ok(text)
}

/// Of `joint_accelerations` of modules with the numbers of each configuration: its errors, and how many of the modules
/// take a form in joint frames, from base inertial parameters.
fn table_of_folded(model: &Model, configurations: usize) -> Result<String, Failure> {
    let _spinner = Spinner::new(format!("generating {} with numbers", model.name));
    let subject = Subject::new(model)?;
    let mut text = format!(
        "## {}, its numbers folded\n\n| configurations | in joint frames | median | worst | failures | dense: median | worst | failures |\n|---|---|---|---|---|---|---|---|\n",
        model.name
    );
    for (place, (_, words)) in KINDS.into_iter().enumerate() {
        let found = subject.folded_errors(model, place, configurations);
        let of = |column: fn(&Folded) -> f64| Column::of(found.iter().map(column).collect());
        let (own, dense) = (of(|folded| folded.own), of(|folded| folded.dense));
        let n_in_frames = found.iter().filter(|folded| folded.is_in_joint_frames).count();
        let _ = writeln!(text, "| {words} | {n_in_frames} of {} | {own} | {dense} |", found.len());
    }
    text.push('\n');
    Ok(text)
}

/// What became of a configuration with a module of its own.
struct Folded {
    /// Error of u̇.
    own: f64,
    dense: f64,
    is_in_joint_frames: bool,
}

/// A mechanism with its parameters, and a state.
struct Configuration {
    model: Model,
    joints: Vec<f64>,
    violation: Vec<f64>,
}

impl Configuration {
    fn draw(
        model: &Model,
        module: &Module,
        kind: Kind,
        (n_x, n_u): (usize, usize),
        random: &mut ChaCha8Rng,
    ) -> Self {
        let is = |wanted: Kind| kind == wanted || kind == Kind::Everything;
        let mut model = model.clone();
        let moving = model.coordinate_bodies();
        let exponent = match kind {
            Kind::Masses(ratio) => f64::from(ratio) / 2.0,
            Kind::Everything => 3.0,
            _ => 0.0,
        };
        for (place, &body) in moving.iter().enumerate() {
            let mut factor = 10.0_f64.powf(exponent * random.random_range(-1.0..1.0));
            if is(Kind::GimbalLock) && place + 1 < moving.len() {
                factor *= 1e-6;
            }
            let body = model.bodies[body].clone();
            scale(&mut model, &body.mass, factor);
            for moment in &body.inertia {
                let own =
                    if is(Kind::Inertias) { 10.0_f64.powf(random.random_range(-3.0..3.0)) } else { 1.0 };
                scale(&mut model, moment, factor * own);
            }
        }
        if is(Kind::LongArms) {
            for joint in model.joints.clone() {
                for number in joint.first.point.iter().chain(&joint.second.point) {
                    set(&mut model, number, random.random_range(-10.0..10.0));
                }
            }
        }
        let mut joints = module.joint_start.clone();
        for (k, x) in joints[..n_x].iter_mut().enumerate() {
            *x = random.random_range(-PI..PI);
            if is(Kind::Aligned) {
                *x = [0.0, FRAC_PI_2, -FRAC_PI_2, PI][random.random_range(0..4)];
            }
            if is(Kind::GimbalLock) && k == 1 {
                *x = [FRAC_PI_2, -FRAC_PI_2][random.random_range(0..2)];
            }
        }
        joints[n_x..n_x + n_u].iter_mut().for_each(|u| *u = random.random_range(-100.0..100.0));
        if is(Kind::FastSpin) {
            joints[n_x + n_u - 1] = 1e6;
        }
        let size = if is(Kind::Violated) { 1e-2 } else { 0.0 };
        let violation = module.start.iter().map(|_| size * random.random_range(-1.0..1.0)).collect();
        Self { model, joints, violation }
    }

    /// The same with numbers in the place of the parameters that [`freed`] has added to those of `original`.
    fn folded(mut self, original: &Model) -> Self {
        let parameters = self.model.parameters.split_off(original.parameters.len());
        let fold = |number: &mut Number| {
            if let Number::Parameter { index, .. } = number
                && let Some(parameter) = index.checked_sub(original.parameters.len()).map(|k| &parameters[k])
            {
                *number = Number::Exact(parameter.value.clone());
            }
        };
        for body in &mut self.model.bodies {
            std::iter::once(&mut body.mass).chain(&mut body.inertia).for_each(fold);
        }
        for joint in &mut self.model.joints {
            joint.first.point.iter_mut().chain(&mut joint.second.point).for_each(fold);
        }
        self
    }

    /// Of a module with the numbers of this configuration.
    fn folded_errors(self, original: &Model) -> Option<Folded> {
        let folded = self.folded(original);
        let functions = Functions::named(["maximal", "reactions"]).ok()?;
        let generated = gyro_codegen::generate_functions("model.toml", &folded.model, &functions).ok()?;
        let module = Module::read(&folded.model, &generated.code, &generated.constants).ok()?;
        let forms = &generated.data_sheet.function(Kernel::JointAccelerations)?.forms;
        let is_in_joint_frames = forms.iter().any(|form| form.is_taken && form.name.contains("joint frames"));
        let (errors, dense) = folded.errors(&module)?;
        let place = KERNELS.iter().position(|kernel| *kernel == Kernel::JointAccelerations.name())?;
        Some(Folded { own: errors[place], dense, is_in_joint_frames })
    }

    fn errors(&self, module: &Module) -> Option<Errors> {
        let precision = Precision::new();
        let Trial { state, errors, accelerations } =
            trial(&self.model, module, &precision, &self.joints, &self.violation)?;
        let dense = Dense::<f64>::new(&self.model).ok()?;
        let mut y = dense.start();
        y.as_mut_slice().copy_from_slice(&state);
        let mut out = dense.acceleration_buffer();
        dense.accelerations(0.0, &y, &mut out);
        let computed: &[f64] = out.as_ref();
        Some((errors, relative_error(&accelerations, &computed[..accelerations.len()], &[])))
    }
}

fn parameter<'m>(model: &'m mut Model, number: &Number) -> Option<&'m mut Parameter> {
    let Number::Parameter { index, .. } = number else { return None };
    model.parameters.get_mut(*index)
}

fn set(model: &mut Model, number: &Number, value: f64) {
    if let (Some(parameter), Some(value)) = (parameter(model, number), Rational::from_float(value)) {
        parameter.value = value;
    }
}

fn scale(model: &mut Model, number: &Number, factor: f64) {
    if let (Some(parameter), Some(factor)) = (parameter(model, number), Rational::from_float(factor)) {
        // What the kernels are given is an `f64`: let the reference have the same.
        let value = gyro_model::to_f64(&(&parameter.value * factor));
        parameter.value = Rational::from_float(value).unwrap_or_default();
    }
}

/// Some errors in three numbers.
struct Column {
    median: f64,
    worst: f64,
    failures: usize,
}

impl Column {
    fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let at = |place: usize| errors.get(place).copied().unwrap_or(f64::NAN);
        Self {
            median: at(errors.len() / 2),
            worst: at(errors.len().saturating_sub(1)),
            failures: errors.iter().filter(|error| error.is_nan() || **error > FAILURE).count(),
        }
    }
}

impl std::fmt::Display for Column {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1e} | {:.1e} | {}", self.median, self.worst, self.failures)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the configuration.
    const MEDIAN: f64 = 3e-15;

    /// The worst in terms of the dense form's.
    const WORST: f64 = 2.0;

    #[test]
    #[ignore = "takes long: `.ci/steps` runs it"]
    fn no_kind_of_configuration_takes_the_digits_of_the_kernels() {
        for model in models(&[]).unwrap() {
            check(&Subject::new(&model).unwrap());
        }
    }

    /// Of modules with numbers, whose joint dynamics are in joint frames and from base inertial parameters.
    #[test]
    #[ignore = "takes long: `.ci/steps` runs it"]
    fn joint_frames_and_base_parameters_take_no_digits() {
        let chain = models(&[]).unwrap().pop().unwrap();
        let subject = Subject::new(&chain).unwrap();
        let mut n_in_frames = 0;
        for (place, (_, words)) in KINDS.into_iter().enumerate().step_by(3) {
            for folded in subject.folded_errors(&chain, place, 1) {
                assert!(folded.own <= MEDIAN.max(WORST * folded.dense), "{words}: {:e}", folded.own);
                n_in_frames += usize::from(folded.is_in_joint_frames);
            }
        }
        assert!(n_in_frames >= 2, "{n_in_frames}");
    }

    fn check(subject: &Subject) {
        for (place, (kind, words)) in KINDS.into_iter().enumerate() {
            let errors = subject.errors(place, 24);
            assert!(errors.len() >= 20, "{words}: {}", errors.len());
            let dense = Column::of(errors.iter().map(|(_, dense)| *dense).collect());
            for (k, kernel) in KERNELS.iter().enumerate() {
                let column = Column::of(errors.iter().map(|(own, _)| own[k]).collect());
                let words = format!("{}, {words}, {kernel}: {column}, dense {dense}", subject.model.name);
                assert_eq!(column.failures, 0, "{words}");
                // In gimbal lock with light rings half the digits are a maximal state's own to lose.
                let is_lost = kind == Kind::GimbalLock && *kernel != "joint_accelerations";
                // The multipliers follow from accelerations that are right in terms of the largest.
                let is_balance = kind == Kind::Everything && *kernel == "corrected_solution";
                let allowed = if is_lost || is_balance { MEDIAN.max(WORST * dense.median) } else { MEDIAN };
                assert!(column.median <= allowed, "{words}");
                if kind != Kind::Everything {
                    assert!(column.worst <= WORST * dense.worst, "{words}");
                }
            }
        }
    }
}
