//! A mechanism as a functional mock-up unit, FMI 3.0: model exchange and co-simulation.
//!
//! What an FMU holds but for the archive around it: the model description, the C sources with what they are to be
//! compiled with, and a page of documentation.

mod dependencies;
mod variables;

use crate::names::Names;
use crate::reserved::c_name;
use crate::runtime::UNIT;
use crate::text::Writer as Text;
use crate::{Error, Precision};
use gyro_codegen::Scheduled;
use gyro_model::Model;
use gyro_program::{Kernel, Space};
use quick_xml::Writer;
use quick_xml::events::BytesText;
use std::fmt::Write as _;
use std::io;
pub(crate) use variables::states;
use variables::{Variable, base_units, number, variables};

/// What the model file does not say.
#[derive(Clone, Debug)]
pub struct Settings {
    /// By which an importer knows that binary and description belong together: a digest of the module, for instance.
    pub token: String,
    /// What co-simulation integrates by: the name of a method with an error estimate.
    pub method: &'static str,
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

const HEADERS: [(&str, &str); 3] = [
    ("fmi3PlatformTypes.h", include_str!("../c/fmi/fmi3PlatformTypes.h")),
    ("fmi3FunctionTypes.h", include_str!("../c/fmi/fmi3FunctionTypes.h")),
    ("fmi3Functions.h", include_str!("../c/fmi/fmi3Functions.h")),
];

/// Writes a mechanism as an FMU: what was generated of the model, with the functions `joint_outputs` and
/// `output_derivatives` where the model has outputs.
///
/// # Errors
/// A mechanism without joint coordinates, or without these functions.
pub fn fmu(model: &Model, scheduled: &Scheduled, settings: &Settings) -> Result<Fmu, Error> {
    let text = Text::new(&model.name, model, scheduled, Precision::F64);
    if !text.has_solver() {
        return Err(Error("it has no joint coordinates, which an FMU integrates".to_owned()));
    }
    let c = text.written();
    let unit = Unit::of(model, scheduled, settings)?;
    let name = &text.names.prefix;
    let source = |file: &str| format!("{SOURCES}/{file}");
    let sources = vec![source("fmi3.c"), source(&format!("{name}.c"))];
    let wrapper = unit.wrapper(&text.names);
    let mut files = vec![
        ("modelDescription.xml".to_owned(), written(|xml| unit.description(xml))?),
        (source("buildDescription.xml"), written(|xml| unit.build(xml))?),
        (sources[0].clone(), wrapper),
        (sources[1].clone(), c.source),
        (source(&format!("{name}.h")), c.header),
        ("documentation/index.html".to_owned(), unit.documentation()),
    ];
    files.extend(HEADERS.map(|(file, text)| (source(file), text.to_owned())));
    Ok(Fmu { identifier: name.to_string(), files, sources })
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
    fn of(model: &'a Model, scheduled: &Scheduled, settings: &'a Settings) -> Result<Self, Error> {
        let has_outputs = !settings.outputs.is_empty();
        let computes = |kernels: &[Kernel]| kernels.iter().all(|of| scheduled.origins.contains_key(of));
        if has_outputs && !computes(&[Kernel::JointOutputs]) {
            return Err(Error("outputs without the function joint_outputs".to_owned()));
        }
        let has_jacobian = computes(&[Kernel::JointJacobian]);
        let has_slopes = has_jacobian
            && (!has_outputs
                || computes(&[
                    Kernel::OutputsByState,
                    Kernel::OutputsByAccelerations,
                    Kernel::OutputsByInputs,
                ]));
        Ok(Self {
            model,
            settings,
            variables: variables(model, scheduled, settings)?,
            n_work: usize::from(model.has_work()),
            has_loops: scheduled.len(Space::Closure) > 0,
            has_slopes,
            has_jacobian,
        })
    }

    /// The C around the functions.
    fn wrapper(&self, names: &Names<'_>) -> String {
        let flag = u8::from;
        let mut text = format!("/* {} as a unit of FMI 3.0: around its functions. */\n\n", self.model.name);
        let _ = write!(text, "#include \"{}.h\"\n#include \"fmi3Functions.h\"\n\n", names.prefix);
        let lines = [
            ("TOKEN", format!("\"{}\"", self.settings.token)),
            ("METHOD", names.upper(self.settings.method)),
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
        text + &names.applied(&UNIT.concat())
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
                let identifier = c_name(name);
                let common = [
                    ("modelIdentifier", identifier.as_ref()),
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
                    self.variables.iter().try_for_each(|variable| variable.write(xml))
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
                xml.create_element("Unit").with_attribute(("name", unit)).write_inner_content(|xml| {
                    let Some(base) = base_units(unit) else { return Ok(()) };
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

    /// What is computed of what.
    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let with = |kind: &'static str, is_it: &dyn Fn(&Variable) -> bool, xml: &mut Xml| {
            self.variables.iter().filter(|of| is_it(of)).try_for_each(|of| {
                let depends: Vec<String> = of.depends.references().map(|known| known.to_string()).collect();
                xml.create_element(kind)
                    .with_attribute(("valueReference", of.reference.to_string().as_str()))
                    .with_attribute(("dependencies", depends.join(" ").as_str()))
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
        let name = &c_name(&self.model.name);
        xml.create_element("fmiBuildDescription").with_attribute(("fmiVersion", "3.0")).write_inner_content(
            |xml| {
                xml.create_element("BuildConfiguration")
                    .with_attribute(("modelIdentifier", name.as_ref()))
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
