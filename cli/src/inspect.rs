//! `cargo xtask inspect`: what is generated from a model, what is left out, and what each element of the model costs.

use crate::args::InspectArgs;
use crate::failure::Failure;
use crate::progress::Spinner;
use crate::side_by_side::side_by_side;
use crate::variants::{Variant, variants};
use crate::verify::verify_quickly;
use crate::words::table;
use crate::{files, json, machine_code, nested, remarks, scene};
use gyro_codegen::{
    DataSheet, Elimination, Form, Function, Kernel, Module, Operations, Repetition, generate_by,
    generate_model, large,
};
use gyro_model::{Model, Row, RowOwner, Tree};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;

/// All that is shown of a model.
struct Inspection {
    model: Model,
    data_sheet: DataSheet,
    bytes: Option<BTreeMap<Kernel, u64>>,
    /// What the accelerations would take by a factorisation of all of eq. (17). Trees only.
    saddle: Option<usize>,
    elements: Vec<Element>,
}

/// What becomes of the functions without an element of the model, or with a free one.
struct Element {
    what: String,
    data_sheet: Result<DataSheet, String>,
}

/// Generates the model and its variants and prints what came of it.
pub(crate) fn inspect(args: &InspectArgs) -> Result<(), Failure> {
    let mut model = scene::read(&args.model)?;
    model.functions.get_or_insert_with(|| vec!["solvers".to_owned()]);
    let page = files::shown(&args.model);
    remarks::report_redundant(&model, &args.model.display().to_string(), false)?;
    let spinner = Spinner::new(format!("generating {} and its variants", model.name));
    let failure = |e: gyro_codegen::Error| Failure::Usage(format!("{}: {e}", args.model.display()));
    let module = generate_model(&page, &model).map_err(failure)?;
    verify_quickly(&model, &module)?;
    // A factorisation of all of eq. (17) is for trees that have no rows beside their joints' own.
    let is_beside = |row: &Row| matches!(row.owner, RowOwner::Coupler(_) | RowOwner::Driver(_));
    let saddle = Tree::of(&model).is_open() && !model.rows().iter().any(is_beside);
    let saddle =
        saddle.then(|| generate_by(Elimination::Saddle, &page, &model)).transpose().map_err(failure)?;
    let variants = variants(&model);
    let elements = side_by_side(variants.len(), |k| Element::of(&page, &variants[k]));
    drop(spinner);
    let bytes = if args.no_compile { None } else { bytes(&module)? };
    let saddle = saddle.and_then(|module| total(&module.data_sheet, Kernel::Accelerations));
    let inspection = Inspection { model, data_sheet: module.data_sheet, bytes, saddle, elements };
    let text = if args.json { format!("{:#}\n", inspection.to_json()) } else { inspection.to_text() };
    // Nobody is left to be told if standard output is closed.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Ok(())
}

fn bytes(module: &Module) -> Result<Option<BTreeMap<Kernel, u64>>, Failure> {
    let kernels: Vec<Kernel> = module.data_sheet.functions.iter().map(|function| function.kernel).collect();
    let bytes = machine_code::bytes(&nested::library(module, &kernels)?);
    if bytes.is_none() {
        remarks::warn("the machine code is not measured: `nm` is not installed");
    }
    Ok(bytes)
}

impl Element {
    fn of(page: &str, variant: &Variant) -> Self {
        let sheet = |model: &Model| {
            generate_model(page, model).map(|module| module.data_sheet).map_err(|error| error.to_string())
        };
        Self {
            what: variant.what.clone(),
            data_sheet: variant.model.as_ref().map_err(Clone::clone).and_then(sheet),
        }
    }

    fn row(&self, whole: &DataSheet, kernels: &[Kernel]) -> Vec<String> {
        let cell = |total: &dyn Fn(&DataSheet) -> Option<usize>| {
            let Ok(sheet) = &self.data_sheet else { return "cannot be assembled".to_owned() };
            match (total(whole), total(sheet)) {
                (Some(with), Some(without)) if with == without => without.to_string(),
                (Some(with), Some(without)) => format!("{without} ({:+})", without as i64 - with as i64),
                (_, without) => without.map_or("none".to_owned(), |without| without.to_string()),
            }
        };
        let of_kernels = kernels.iter().map(|&kernel| cell(&|sheet| total(sheet, kernel)));
        let of_all = cell(&|sheet| Some(total_of_all(sheet)));
        [self.what.clone()].into_iter().chain(of_kernels).chain([of_all]).collect()
    }

    fn to_json(&self, whole: &DataSheet) -> Value {
        let sheet = match &self.data_sheet {
            Ok(sheet) => sheet,
            Err(why) => return json!({ "what": self.what, "error": why }),
        };
        let functions: Map<String, Value> = (sheet.functions.iter())
            .map(|function| {
                let now = function.operations.total();
                let before = total(whole, function.kernel);
                let change = before.map(|before| now as i64 - before as i64);
                (function.kernel.name().to_owned(), json!({ "operations": now, "change": change }))
            })
            .collect();
        json!({ "what": self.what, "degrees_of_freedom": sheet.degrees_of_freedom(), "functions": functions })
    }
}

/// What the table of elements shows: the kernels of a run.
const KERNELS: [Kernel; 6] = [
    Kernel::Accelerations,
    Kernel::JointAccelerations,
    Kernel::CorrectedAccelerations,
    Kernel::NewtonStep,
    Kernel::SolveVelocities,
    Kernel::Outputs,
];

fn total(sheet: &DataSheet, kernel: Kernel) -> Option<usize> {
    sheet.function(kernel).map(|function| function.operations.total())
}

fn total_of_all(sheet: &DataSheet) -> usize {
    sheet.functions.iter().map(|function| function.operations.total()).sum()
}

impl Inspection {
    fn to_text(&self) -> String {
        let sheet = &self.data_sheet;
        let mut text = format!("{}\n\n", sheet.mechanism);
        let (coordinates, rows, constraints) = (sheet.coordinates(), sheet.rows, sheet.constraints());
        text += &facts(&[
            ("bodies with coordinates", sheet.bodies.join(", ")),
            ("coordinates", coordinates.to_string()),
            (
                "constraint equations",
                format!("{constraints}: {rows} joint rows, {} normalisations", sheet.bodies.len()),
            ),
            ("redundant rows dropped", self.model.dropped().count().to_string()),
            ("degrees of freedom", sheet.degrees_of_freedom().to_string()),
            ("unknowns of eq. (17)", sheet.unknowns().to_string()),
            ("non-zeros of Φ_q", format!("{} of {}", sheet.phi_q, constraints * coordinates)),
            ("non-zeros of (Φ_r, Φ_π')", format!("{} of {}", sheet.phi_pi, rows * 6 * sheet.bodies.len())),
        ]);
        text += "\nleft out\n";
        sheet.left_out.iter().chain(&sheet.spared).for_each(|what| text += &format!("  {what}\n"));
        if !sheet.kinks.is_empty() {
            text += "\nnot smooth\n";
            sheet.kinks.iter().for_each(|place| text += &format!("  {place}\n"));
        }
        text += "\noperations (+ − × ÷) of each function after each pass: every expression written out where it is used, equal ones\n\
                 computed once, products with reciprocals as quotients (what is emitted); its results that are always zero";
        text += if self.bytes.is_some() { "; bytes of machine code\n" } else { "\n" };
        text += &table(&self.function_rows());
        text += &self.loops();
        text += &self.choices();
        text += &self.element_table();
        text
    }

    fn function_rows(&self) -> Vec<Vec<String>> {
        let head = ["function", "written out", "shared", "emitted", "functions", "zeros", "bytes"];
        let n_columns = head.len() - usize::from(self.bytes.is_none());
        let mut rows = vec![head[..n_columns].iter().map(|&word| word.to_owned()).collect::<Vec<_>>()];
        for function in &self.data_sheet.functions {
            let bytes = self.bytes.iter().map(|bytes| bytes.get(&function.kernel));
            let bytes = bytes.map(|bytes| bytes.map_or(String::new(), u64::to_string));
            let cells = [
                function.kernel.name().to_owned(),
                large(function.passes.written_out),
                function.passes.shared.to_string(),
                function.passes.emitted.to_string(),
                function.operations.functions.to_string(),
                format!("{} of {}", function.zeros, function.results),
            ];
            rows.push(cells.into_iter().chain(bytes).collect());
        }
        rows
    }

    /// Which functions are written as loops over tables of constants, with operations as written and as done.
    fn loops(&self) -> String {
        let functions = self.data_sheet.functions.iter();
        let rows = functions.filter_map(|function| {
            let Repetition { loops, copies, written, operations } = function.repetition?;
            let numbers = [loops, copies, written, operations.total()].map(|n| n.to_string());
            Some([function.kernel.name().to_owned()].into_iter().chain(numbers).collect::<Vec<_>>())
        });
        let head = ["", "loops", "copies", "operations of the text", "operations done"].map(str::to_owned);
        let rows: Vec<_> = [head.to_vec()].into_iter().chain(rows).collect();
        if rows.len() == 1 {
            return String::new();
        }
        format!("\nwritten as loops over tables of constants\n{}", table(&rows))
    }

    /// What was compared, and what the normal form did.
    fn choices(&self) -> String {
        let mut text = String::new();
        for function in self.data_sheet.functions.iter().filter(|function| !function.forms.is_empty()) {
            let _ = writeln!(text, "\nways of writing {}", function.kernel.name());
            let row = |form: &Form| {
                let taken = if form.is_taken { "taken" } else { "" };
                let Operations { functions, .. } = form.operations;
                vec![
                    form.name.clone(),
                    form.operations.total().to_string(),
                    functions.to_string(),
                    taken.to_owned(),
                ]
            };
            let head = ["", "operations", "functions"].map(str::to_owned).to_vec();
            let rows: Vec<_> = [head].into_iter().chain(function.forms.iter().map(row)).collect();
            text += &table(&rows);
            for reduction in &function.reductions {
                let (what, before, after) = (reduction.what, reduction.before, reduction.after);
                let _ = writeln!(text, "  normal form of {what}: {before} before, {after} after");
            }
        }
        if let Some((ours, saddle)) = total(&self.data_sheet, Kernel::Accelerations).zip(self.saddle) {
            let _ = writeln!(
                text,
                "\naccelerations through the null space of the joints: {ours}; by a factorisation of all of eq. (17): {saddle}"
            );
        }
        text
    }

    fn element_table(&self) -> String {
        let has = |kernel: &Kernel| self.data_sheet.function(*kernel).is_some();
        let kernels: Vec<Kernel> = KERNELS.into_iter().filter(has).collect();
        let names = kernels.iter().map(|kernel| kernel.name());
        let head = ["the same model"].into_iter().chain(names).chain(["all functions"]);
        let whole = kernels.iter().filter_map(|&kernel| total(&self.data_sheet, kernel));
        let whole = whole.chain([total_of_all(&self.data_sheet)]).map(|total| total.to_string());
        let mut rows = vec![head.map(str::to_owned).collect()];
        rows.push(["as it is".to_owned()].into_iter().chain(whole).collect());
        rows.extend(self.elements.iter().map(|element| element.row(&self.data_sheet, &kernels)));
        format!(
            "\noperations of the model without an element, or with numbers as parameters\n{}",
            table(&rows)
        )
    }

    fn to_json(&self) -> Value {
        let sheet = &self.data_sheet;
        let functions: Vec<Value> =
            sheet.functions.iter().map(|function| function_json(function, self.bytes.as_ref())).collect();
        json!({
            "model": sheet.mechanism,
            "bodies": sheet.bodies,
            "coordinates": sheet.coordinates(),
            "constraints": sheet.constraints(),
            "joint_rows": sheet.rows,
            "degrees_of_freedom": sheet.degrees_of_freedom(),
            "unknowns": sheet.unknowns(),
            "non_zeros": {
                "phi_q": [sheet.phi_q, sheet.constraints() * sheet.coordinates()],
                "phi_pi": [sheet.phi_pi, sheet.rows * 6 * sheet.bodies.len()],
            },
            "redundant": json::redundant(&self.model),
            "left_out": sheet.left_out,
            "spared": sheet.spared,
            "not_smooth": sheet.kinks,
            "functions": functions,
            "saddle": self.saddle,
            "elements": self.elements.iter().map(|element| element.to_json(sheet)).collect::<Vec<_>>(),
        })
    }
}

/// What there is of each thing, one to a line.
fn facts(facts: &[(&str, String)]) -> String {
    facts.iter().map(|(what, value)| format!("  {what:<24}  {value}\n")).collect()
}

fn function_json(function: &Function, bytes: Option<&BTreeMap<Kernel, u64>>) -> Value {
    let operations = |operations: &Operations| {
        json!({
            "additions": operations.additions,
            "multiplications": operations.multiplications,
            "divisions": operations.divisions,
            "total": operations.total(),
            "functions": operations.functions,
        })
    };
    let form = |form: &Form| json!({ "name": form.name, "operations": operations(&form.operations), "is_taken": form.is_taken });
    let passes = function.passes;
    json!({
        "name": function.kernel.name(),
        "computes": function.kernel.computes(),
        "operations": operations(&function.operations),
        "passes": { "written_out": passes.written_out, "shared": passes.shared, "emitted": passes.emitted },
        "results": function.results,
        "zeros": function.zeros,
        "forms": function.forms.iter().map(form).collect::<Vec<_>>(),
        "normal_form": function.reductions.iter().map(|r| json!({ "what": r.what, "before": r.before, "after": r.after })).collect::<Vec<_>>(),
        "loops": function.repetition.map(|r| json!({ "loops": r.loops, "copies": r.copies, "operations": r.written })),
        "machine_code_bytes": bytes.and_then(|bytes| bytes.get(&function.kernel)),
    })
}
