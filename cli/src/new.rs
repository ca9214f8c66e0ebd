//! `gyro new`: a commented start of a model file.

use crate::args::{NewArgs, Template};
use crate::failure::Failure;
use crate::folder;
use crate::invocation::program;
use crate::write::unwritable;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

impl Template {
    fn text(self) -> &'static str {
        match self {
            Self::Pendulum => include_str!("../templates/pendulum.toml"),
            Self::Cart => include_str!("../templates/cart.toml"),
            Self::FourBar => include_str!("../templates/four-bar.toml"),
            Self::Gimbal => include_str!("../templates/gimbal.toml"),
            Self::Arm => include_str!("../templates/arm.toml"),
        }
    }
}

/// Writes the file, and says what to do with it.
pub(crate) fn new(args: &NewArgs) -> Result<(), Failure> {
    let name = format!("{}.toml", args.name);
    let path = args.out.as_ref().map_or_else(|| PathBuf::from(&name), |out| folder::file(out, &name));
    let text = args.template.text().replace("\"NAME\"", &format!("{:?}", args.name));
    // Only the name can be wrong.
    if let Err(mistakes) = gyro_model::read("", &text) {
        let mistake = &mistakes.mistakes()[0];
        return Err(Failure::Usage(format!("{}: {}; {}", mistake.message, mistake.label, mistake.help)));
    }
    create(&path, &text)?;
    let (program, model) = (program(), path.display());
    let words = format!(
        "wrote {model}\n\nNext:\n  {program} check {model}\n  {program} simulate {model}\n  \
         {program} generate {model}\n\nThe first says what the mechanism is, the second simulates it and plots the \
         motion to out/{},\nthe third writes its equations of motion as Rust.\n",
        args.name
    );
    // Nobody is left to be told if standard output is closed.
    let _ = std::io::stdout().write_all(words.as_bytes());
    Ok(())
}

/// Writes a file that must not be there yet.
fn create(path: &Path, text: &str) -> Result<(), Failure> {
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::Usage(format!(
            "{} exists already, and nothing is overwritten: choose another name, or another place with --out",
            path.display()
        )),
        _ => unwritable(path, "written", &error),
    })
}
