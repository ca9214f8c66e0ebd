//! Text with ANSI colours, or without.

use codespan_reporting::diagnostic::{LabelStyle, Severity};
use codespan_reporting::term::WriteStyle;
use std::io;

/// A text under way.
pub(super) struct Painted {
    bytes: Vec<u8>,
    is_colored: bool,
}

const BOLD: &str = "1";
const BLUE: &str = "34";

impl Painted {
    pub(super) fn plain() -> Self {
        Self { bytes: Vec::new(), is_colored: false }
    }

    pub(super) fn colored() -> Self {
        Self { bytes: Vec::new(), is_colored: true }
    }

    pub(super) fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }

    fn set(&mut self, codes: &[&str]) -> io::Result<()> {
        if self.is_colored {
            self.bytes.extend(format!("\x1b[{}m", codes.join(";")).into_bytes());
        }
        Ok(())
    }
}

fn color(severity: Severity) -> &'static str {
    match severity {
        Severity::Bug | Severity::Error => "31",
        Severity::Warning => "33",
        Severity::Note => "32",
        Severity::Help => "36",
    }
}

impl io::Write for Painted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl WriteStyle for Painted {
    fn set_header(&mut self, severity: Severity) -> io::Result<()> {
        self.set(&[BOLD, color(severity)])
    }

    fn set_header_message(&mut self) -> io::Result<()> {
        self.set(&[BOLD])
    }

    fn set_line_number(&mut self) -> io::Result<()> {
        self.set(&[BLUE])
    }

    fn set_note_bullet(&mut self) -> io::Result<()> {
        self.set(&[BLUE])
    }

    fn set_source_border(&mut self) -> io::Result<()> {
        self.set(&[BLUE])
    }

    fn set_label(&mut self, severity: Severity, style: LabelStyle) -> io::Result<()> {
        self.set(&[if style == LabelStyle::Primary { color(severity) } else { BLUE }])
    }

    fn reset(&mut self) -> io::Result<()> {
        self.set(&["0"])
    }
}
