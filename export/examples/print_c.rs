//! Writes header and source of model files: `cargo run -p gyro-export --example print_c -- OUT MODEL... [--f32]`
#![expect(clippy::print_stdout, reason = "it is a program")]

use gyro_export::Precision;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_single = arguments.iter().any(|argument| argument == "--f32");
    arguments.retain(|argument| argument != "--f32");
    let precision = if is_single { Precision::F32 } else { Precision::F64 };
    let out = arguments.remove(0);
    std::fs::create_dir_all(&out)?;
    for page in arguments {
        let text = std::fs::read_to_string(&page)?;
        let folder = Path::new(&page).parent().unwrap_or(Path::new("."));
        let mut load = |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let mut model = gyro_model::read_with(&page, &text, &mut load).map_err(|e| format!("{e}"))?;
        model.functions.get_or_insert_with(|| vec!["all".to_owned()]);
        let module = gyro_codegen::generate_model(&page, &model)?;
        let exported = gyro_export::c(&page, &model, &module.scheduled, precision);
        for (extension, text) in [("h", &exported.header), ("c", &exported.source)] {
            std::fs::write(Path::new(&out).join(format!("{}.{extension}", module.name)), text)?;
        }
        println!("{}", module.name);
    }
    Ok(())
}
