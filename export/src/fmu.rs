//! A mechanism as a functional mock-up unit, FMI 3.0: model exchange and co-simulation.
//!
//! What an FMU holds but for the archive around it: the model description, the C sources with what they are to be
//! compiled with, and a page of documentation.

use crate::module::{Module, Place};
use crate::names::Names;
use crate::{Error, Precision, text};
use gyro_model::{Model, to_f64};
use quick_xml::Writer;
use quick_xml::events::BytesText;
use std::fmt::Write as _;
use std::io;

/// A method of co-simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Order 5(4).
    Tsit5,
    /// Order 8(5, 3).
    Dop853,
    /// Order 4(3), implicit.
    Rodas4,
}

/// What the model file does not say.
#[derive(Clone, Debug)]
pub struct Settings {
    /// By which an importer knows that binary and description belong together: a digest of the module, for instance.
    pub token: String,
    /// What co-simulation integrates by.
    pub method: Method,
    /// Its tolerance, where the importer gives none.
    pub tolerance: f64,
    /// Units of the inputs, in their order.
    pub input_units: Vec<String>,
    /// Name and unit of each number of the outputs, in their order.
    pub outputs: Vec<(String, String)>,
}

/// What stands in the archive, but for binaries.
#[derive(Clone, Debug)]
pub struct Fmu {
    /// The model identifier: what binaries are called.
    pub identifier: String,
    /// Paths in the archive and what stands there.
    pub files: Vec<(String, String)>,
    /// The sources among the files that are compiled.
    pub sources: Vec<String>,
}

/// The folder of the sources.
const SOURCES: &str = "sources";
/// What the sources are to be compiled with, so that the bits are Rust's.
pub const OPTIONS: &[&str] = &["-std=c99", "-O2", "-ffp-contract=off"];

const WRAPPER: &str = include_str!("../c/fmi/fmi3.c");
const HEADERS: [(&str, &str); 3] = [
    ("fmi3PlatformTypes.h", include_str!("../c/fmi/fmi3PlatformTypes.h")),
    ("fmi3FunctionTypes.h", include_str!("../c/fmi/fmi3FunctionTypes.h")),
    ("fmi3Functions.h", include_str!("../c/fmi/fmi3Functions.h")),
];

/// Writes a module as an FMU. `code` is the text of the module that was generated of the model, with the functions
/// `joint_outputs` and `output_derivatives` where the model has outputs.
///
/// # Errors
/// A mechanism without joint coordinates; what else of the module cannot be written in C.
pub fn fmu(model: &Model, code: &str, settings: &Settings) -> Result<Fmu, Error> {
    let module = Module::read(code)?;
    if module.size("Joints") == 0 {
        return Err(Error("it has no joint coordinates, which an FMU integrates".to_owned()));
    }
    let c = text::written(model, &module, (&model.name, Precision::F64))?;
    let unit = Unit::of(model, &module, settings)?;
    let name = &model.name;
    let source = |file: &str| format!("{SOURCES}/{file}");
    let sources = vec![source("fmi3.c"), source(&format!("{name}.c"))];
    let names = Names::new(name, Precision::F64, &module.indices);
    let wrapper = unit.wrapper(&names);
    let mut files = vec![
        ("modelDescription.xml".to_owned(), written(|xml| unit.description(xml))?),
        (source("buildDescription.xml"), written(|xml| unit.build(xml))?),
        (sources[0].clone(), wrapper),
        (sources[1].clone(), c.source),
        (source(&format!("{name}.h")), c.header),
        ("documentation/index.html".to_owned(), unit.documentation()),
    ];
    files.extend(HEADERS.map(|(file, text)| (source(file), text.to_owned())));
    Ok(Fmu { identifier: name.clone(), files, sources })
}

/// A variable of the unit.
struct Variable {
    name: String,
    unit: Option<String>,
    causality: &'static str,
    variability: &'static str,
    initial: Option<&'static str>,
    start: Option<f64>,
    derivative: Option<usize>,
}

struct Unit<'a> {
    model: &'a Model,
    settings: &'a Settings,
    variables: Vec<Variable>,
    n_work: usize,
    has_loops: bool,
    has_slopes: bool,
    has_jacobian: bool,
}

type Xml = Writer<Vec<u8>>;

impl<'a> Unit<'a> {
    fn of(model: &'a Model, module: &Module, settings: &'a Settings) -> Result<Self, Error> {
        let states = states(model, module);
        let n_states = module.size("Joints");
        let starts = module.joint_start()?;
        if states.len() != n_states || starts.len() != n_states {
            return Err(Error(format!("a state of {n_states} numbers, of which {} are known", states.len())));
        }
        let has_outputs = !settings.outputs.is_empty();
        let computes = |names: &[&str]| names.iter().all(|name| module.computes(name));
        if has_outputs && !computes(&["joint_outputs"]) {
            return Err(Error("outputs without the function joint_outputs".to_owned()));
        }
        let has_jacobian = computes(&["joint_jacobian"]);
        let has_slopes = has_jacobian
            && (!has_outputs
                || computes(&["outputs_by_state", "outputs_by_accelerations", "outputs_by_inputs"]));
        let time = Variable {
            unit: Some("s".to_owned()),
            initial: None,
            start: None,
            ..Variable::new("time", "independent", "continuous")
        };
        let mut variables = vec![time];
        for ((name, unit), start) in states.iter().zip(starts) {
            variables.push(Variable {
                unit: Some(unit.clone()),
                initial: Some("exact"),
                start: Some(start),
                ..Variable::new(name, "output", "continuous")
            });
        }
        for (n, (name, unit)) in states.iter().enumerate() {
            variables.push(Variable {
                unit: Some(by_time(unit)),
                initial: Some("calculated"),
                derivative: Some(n + 1),
                ..Variable::new(&format!("der({name})"), "local", "continuous")
            });
        }
        for (input, unit) in model.inputs.iter().zip(&settings.input_units) {
            variables.push(Variable {
                unit: Some(unit.clone()),
                start: Some(to_f64(&input.value)),
                ..Variable::new(&input.name, "input", "continuous")
            });
        }
        for parameter in &model.parameters {
            variables.push(Variable {
                initial: Some("exact"),
                start: Some(to_f64(&parameter.value)),
                ..Variable::new(&parameter.name, "parameter", "tunable")
            });
        }
        for (name, unit) in &settings.outputs {
            variables.push(Variable {
                unit: Some(unit.clone()),
                initial: Some("calculated"),
                ..Variable::new(name, "output", "continuous")
            });
        }
        distinct(&mut variables);
        Ok(Self {
            model,
            settings,
            variables,
            n_work: usize::from(model.has_work()),
            has_loops: !module.closure_rows.is_empty(),
            has_slopes,
            has_jacobian,
        })
    }

    /// The C around the functions.
    fn wrapper(&self, names: &Names) -> String {
        let flag = u8::from;
        let method = match self.settings.method {
            Method::Tsit5 => "TSIT5",
            Method::Dop853 => "DOP853",
            Method::Rodas4 => "RODAS4",
        };
        let mut text = format!("/* {} as a unit of FMI 3.0: around its functions. */\n\n", self.model.name);
        let _ = write!(text, "#include \"{}.h\"\n#include \"fmi3Functions.h\"\n\n", self.model.name);
        let lines = [
            ("TOKEN", format!("\"{}\"", self.settings.token)),
            ("METHOD", names.upper(method)),
            ("TOLERANCE", format!("{:?}", self.settings.tolerance)),
            ("HAS_OUTPUTS", flag(!self.settings.outputs.is_empty()).to_string()),
            ("HAS_INPUTS", flag(!self.model.inputs.is_empty()).to_string()),
            ("HAS_PARAMETERS", flag(!self.model.parameters.is_empty()).to_string()),
            ("HAS_LOOPS", flag(self.has_loops).to_string()),
            ("HAS_SLOPES", flag(self.has_slopes).to_string()),
            ("N_WORK", self.n_work.to_string()),
        ];
        for (name, value) in lines {
            let _ = writeln!(text, "#define FMU_{name} {value}");
        }
        let _ = write!(text, "\ntypedef {} fmu_mechanism;\n\n", names.prefix);
        text + &names.applied(WRAPPER)
    }

    fn description(&self, xml: &mut Xml) -> io::Result<()> {
        let flag = |holds: bool| if holds { "true" } else { "false" };
        let name = self.model.name.as_str();
        xml.create_element("fmiModelDescription")
            .with_attributes([
                ("fmiVersion", "3.0"),
                ("modelName", name),
                ("instantiationToken", self.settings.token.as_str()),
                ("generationTool", concat!("gyro-sim ", env!("CARGO_PKG_VERSION"))),
                ("variableNamingConvention", "flat"),
            ])
            .write_inner_content(|xml| {
                let common = [
                    ("modelIdentifier", name),
                    ("canGetAndSetFMUState", "true"),
                    ("canSerializeFMUState", "true"),
                    ("providesDirectionalDerivatives", flag(self.has_slopes)),
                    ("providesAdjointDerivatives", flag(self.has_slopes)),
                ];
                xml.create_element("ModelExchange")
                    .with_attributes(common)
                    .with_attribute(("needsCompletedIntegratorStep", flag(self.has_loops)))
                    .write_empty()?;
                xml.create_element("CoSimulation")
                    .with_attributes(common)
                    .with_attribute(("canHandleVariableCommunicationStepSize", "true"))
                    .write_empty()?;
                self.units(xml)?;
                xml.create_element("LogCategories").write_inner_content(|xml| {
                    for category in ["logStatusError", "logStatusDiscard"] {
                        xml.create_element("Category").with_attribute(("name", category)).write_empty()?;
                    }
                    Ok(())
                })?;
                let run = &self.model.simulation;
                xml.create_element("DefaultExperiment")
                    .with_attributes([
                        ("startTime", "0"),
                        ("stopTime", number(run.t_end).as_str()),
                        ("tolerance", number(self.settings.tolerance).as_str()),
                        ("stepSize", number(run.sample_every).as_str()),
                    ])
                    .write_empty()?;
                xml.create_element("ModelVariables").write_inner_content(|xml| {
                    self.variables.iter().enumerate().try_for_each(|(n, variable)| variable.write(n, xml))
                })?;
                self.structure(xml)
            })?;
        Ok(())
    }

    fn units(&self, xml: &mut Xml) -> io::Result<()> {
        let mut units: Vec<&str> = self.variables.iter().filter_map(|of| of.unit.as_deref()).collect();
        units.sort_unstable();
        units.dedup();
        xml.create_element("UnitDefinitions").write_inner_content(|xml| {
            for unit in units {
                let base = base_units(unit);
                xml.create_element("Unit").with_attribute(("name", unit)).write_inner_content(|xml| {
                    let exponents = base.iter().filter(|(_, exponent)| *exponent != 0);
                    let exponents: Vec<(&str, String)> =
                        exponents.map(|(name, exponent)| (*name, exponent.to_string())).collect();
                    xml.create_element("BaseUnit")
                        .with_attributes(exponents.iter().map(|(name, exponent)| (*name, exponent.as_str())))
                        .write_empty()?;
                    Ok(())
                })?;
            }
            Ok(())
        })?;
        Ok(())
    }

    /// What is computed of what: every output and derivative of all states and inputs.
    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let with = |kind: &'static str, is_it: &dyn Fn(&Variable) -> bool, xml: &mut Xml| {
            self.variables.iter().enumerate().filter(|(_, of)| is_it(of)).try_for_each(|(n, _)| {
                xml.create_element(kind)
                    .with_attribute(("valueReference", n.to_string().as_str()))
                    .write_empty()
                    .map(|_| ())
            })
        };
        xml.create_element("ModelStructure").write_inner_content(|xml| {
            with("Output", &|of| of.causality == "output", xml)?;
            with("ContinuousStateDerivative", &|of| of.derivative.is_some(), xml)?;
            with("InitialUnknown", &|of| of.initial == Some("calculated"), xml)
        })?;
        Ok(())
    }

    fn build(&self, xml: &mut Xml) -> io::Result<()> {
        let name = self.model.name.as_str();
        xml.create_element("fmiBuildDescription").with_attribute(("fmiVersion", "3.0")).write_inner_content(
            |xml| {
                xml.create_element("BuildConfiguration")
                    .with_attribute(("modelIdentifier", name))
                    .write_inner_content(|xml| {
                        xml.create_element("SourceFileSet")
                            .with_attributes([
                                ("language", "C99"),
                                ("compiler", "gcc"),
                                ("compilerOptions", OPTIONS.join(" ").as_str()),
                            ])
                            .write_inner_content(|xml| {
                                for file in ["fmi3.c".to_owned(), format!("{name}.c")] {
                                    xml.create_element("SourceFile")
                                        .with_attribute(("name", file.as_str()))
                                        .write_empty()?;
                                }
                                Ok(())
                            })?;
                        xml.create_element("Library").with_attribute(("name", "m")).write_empty()?;
                        Ok(())
                    })?;
                Ok(())
            },
        )?;
        Ok(())
    }

    /// A page for whoever opens the archive.
    fn documentation(&self) -> String {
        let escape = |text: &str| quick_xml::escape::escape(text).into_owned();
        let mut rows = String::new();
        for of in &self.variables {
            let start = of.start.map(number).unwrap_or_default();
            let unit = of.unit.as_deref().unwrap_or_default();
            let _ = writeln!(
                rows,
                "<tr><td>{}</td><td>{}</td><td>{}</td><td>{start}</td></tr>",
                escape(&of.name),
                of.causality,
                escape(unit)
            );
        }
        let name = escape(&self.model.name);
        let derivatives =
            if self.has_jacobian { "Directional derivatives are generated, not differences." } else { "" };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}</title></head><body>\n\
             <h1>{name}</h1>\n<p>A mechanism in joint coordinates, written by gyro-sim: model exchange and co-simulation, \
             all numbers in SI units. Inputs are held over a communication step. {derivatives}</p>\n\
             <table>\n<tr><th>variable</th><th>causality</th><th>unit</th><th>start</th></tr>\n{rows}</table>\n\
             </body></html>\n"
        )
    }
}

impl Variable {
    fn new(name: &str, causality: &'static str, variability: &'static str) -> Self {
        let name = name.to_owned();
        Self { name, unit: None, causality, variability, initial: None, start: None, derivative: None }
    }

    fn write(&self, reference: usize, xml: &mut Xml) -> io::Result<()> {
        let reference = reference.to_string();
        let (start, derivative) = (self.start.map(number), self.derivative.map(|of| of.to_string()));
        let optional = [
            ("initial", self.initial),
            ("unit", self.unit.as_deref()),
            ("derivative", derivative.as_deref()),
            ("start", start.as_deref()),
        ];
        xml.create_element("Float64")
            .with_attributes([
                ("name", self.name.as_str()),
                ("valueReference", reference.as_str()),
                ("causality", self.causality),
                ("variability", self.variability),
            ])
            .with_attributes(optional.into_iter().filter_map(|(name, value)| Some((name, value?))))
            .write_empty()?;
        Ok(())
    }
}

/// Name and unit of each number of the joint state.
fn states(model: &Model, module: &Module) -> Vec<(String, String)> {
    const EULER: [&str; 4] = ["e0", "e1", "e2", "e3"];
    const AXES: [&str; 3] = ["x", "y", "z"];
    let of_place = |kind: &str, place: usize| {
        let found = module.indices.iter().find(|(path, at)| path[0] == kind && *at == place);
        found
            .and_then(|(path, _)| path.last())
            .map_or_else(|| format!("{kind}{place}"), |name| name.to_lowercase())
    };
    let (mut coordinates, mut rates) = (Vec::new(), Vec::new());
    for place in &module.places {
        let at = coordinates.len();
        let parts = |to: &mut Vec<(String, String)>, name: &str, parts: &[&str], unit: &str| {
            to.extend(parts.iter().map(|part| (format!("{name}.{part}"), unit.to_owned())));
        };
        match *place {
            Place::Scalar { joint, coordinate } => {
                let kinds = model.joints[joint].kind.coordinates();
                let kind = kinds[coordinate];
                let name = match kinds {
                    [_] => model.joints[joint].name.clone(),
                    _ => format!("{}.{}", model.joints[joint].name, kind.name()),
                };
                let [unit, rate] = if kind.is_angle() { ["rad", "rad/s"] } else { ["m", "m/s"] };
                rates.push((format!("{name}.rate"), rate.to_owned()));
                coordinates.push((name, unit.to_owned()));
            }
            Place::Orientation => {
                let name = of_place("joint", at);
                parts(&mut coordinates, &name, &EULER, "1");
                parts(&mut rates, &format!("{name}.angular velocity"), &AXES, "rad/s");
            }
            Place::Body => {
                let name = of_place("body", at);
                parts(&mut coordinates, &name, &AXES, "m");
                parts(&mut coordinates, &name, &EULER, "1");
                parts(&mut rates, &format!("{name}.velocity"), &AXES, "m/s");
                parts(&mut rates, &format!("{name}.angular velocity"), &AXES, "rad/s");
            }
        }
    }
    let work = model.has_work().then(|| ("work".to_owned(), "J".to_owned()));
    coordinates.into_iter().chain(rates).chain(work).collect()
}

/// Gives a variable whose name is taken a number.
fn distinct(variables: &mut [Variable]) {
    for n in 0..variables.len() {
        let name = variables[n].name.clone();
        let is_taken = |name: &String| variables[..n].iter().any(|before| before.name == *name);
        let numbered = (2..).map(|k: usize| format!("{name} {k}"));
        let chosen = std::iter::once(name.clone()).chain(numbered).find(|name| !is_taken(name));
        variables[n].name = chosen.expect("there is always a further number");
    }
}

/// The unit of a derivative by time.
fn by_time(unit: &str) -> String {
    match unit {
        "1" => "1/s".to_owned(),
        "J" => "W".to_owned(),
        _ => unit.strip_suffix("/s").map_or_else(|| format!("{unit}/s"), |unit| format!("{unit}/s^2")),
    }
}

/// A unit in powers of the base units of FMI.
fn base_units(unit: &str) -> [(&'static str, i32); 4] {
    // kg, m, s, rad
    let powers = |symbol: &str| match symbol {
        "kg" => [1, 0, 0, 0],
        "m" => [0, 1, 0, 0],
        "s" => [0, 0, 1, 0],
        "rad" => [0, 0, 0, 1],
        "N" => [1, 1, -2, 0],
        "J" => [1, 2, -2, 0],
        "W" => [1, 2, -3, 0],
        _ => [0; 4],
    };
    let mut sum = [0; 4];
    for (n, quotient) in unit.split('/').enumerate() {
        for factor in quotient.split('*') {
            let (symbol, exponent) = factor.split_once('^').unwrap_or((factor, "1"));
            let exponent: i32 = exponent.parse().unwrap_or(1);
            for (sum, power) in sum.iter_mut().zip(powers(symbol)) {
                *sum += if n == 0 { power * exponent } else { -power * exponent };
            }
        }
    }
    let [kg, m, s, rad] = sum;
    [("kg", kg), ("m", m), ("s", s), ("rad", rad)]
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn written(content: impl FnOnce(&mut Xml) -> io::Result<()>) -> Result<String, Error> {
    let failed = |e: io::Error| Error(format!("a document: {e}"));
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(quick_xml::events::Event::Decl(quick_xml::events::BytesDecl::new(
        "1.0",
        Some("UTF-8"),
        None,
    )))
    .map_err(failed)?;
    content(&mut xml).map_err(failed)?;
    xml.write_event(quick_xml::events::Event::Text(BytesText::new("\n"))).map_err(failed)?;
    String::from_utf8(xml.into_inner()).map_err(|e| Error(format!("a document: {e}")))
}
