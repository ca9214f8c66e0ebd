//! Mistakes in a page, each shown where it is: file, line, column, what was expected and what to write instead.

use std::fmt;
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::SimpleFile;
use codespan_reporting::term::termcolor::Buffer;
use codespan_reporting::term::{self, Chars, Config, Styles, StylesWriter};

/// All mistakes of one page, in the order of the page.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    file_name: String,
    text: String,
    mistakes: Vec<Diagnostic>,
}

/// One mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where it is, in bytes of the page's text.
    pub span: Range<usize>,
    /// What is wrong, or what was expected.
    pub message: String,
    /// A few words that are printed under the place itself.
    pub label: String,
    /// What to write instead.
    pub help: String,
    /// Other places that have to do with it.
    pub related: Vec<Related>,
}

/// A second place that a mistake refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// Where it is, in bytes of the page's text.
    pub span: Range<usize>,
    /// A few words that are printed under it.
    pub label: String,
}

impl Diagnostics {
    /// Sorts the mistakes by place.
    pub(crate) fn new(file_name: &str, text: &str, mut mistakes: Vec<Diagnostic>) -> Self {
        mistakes.sort_by(|a, b| {
            (a.span.start, a.span.end, &a.message).cmp(&(b.span.start, b.span.end, &b.message))
        });
        mistakes.dedup();
        Self { file_name: file_name.to_owned(), text: text.to_owned(), mistakes }
    }

    /// The mistakes in the order of the page.
    pub fn mistakes(&self) -> &[Diagnostic] {
        &self.mistakes
    }

    /// The mistakes as plain text for a terminal or a log, each with its `file:line:column`.
    pub fn render(&self) -> String {
        self.render_with(Buffer::no_color())
    }

    /// The same with ANSI colours.
    pub fn render_colored(&self) -> String {
        self.render_with(Buffer::ansi())
    }

    fn render_with(&self, mut buffer: Buffer) -> String {
        let config = Config { chars: Chars::ascii(), ..Config::default() };
        let styles = Styles::default();
        let file = SimpleFile::new(&self.file_name, &self.text);
        for mistake in &self.mistakes {
            let mut writer = StylesWriter::new(&mut buffer, &styles);
            term::emit_to_write_style(&mut writer, &config, &file, &self.report(mistake))
                .expect("spans lie within the text and a buffer in memory takes every write");
        }
        String::from_utf8_lossy(buffer.as_slice()).into_owned()
    }

    fn report(&self, mistake: &Diagnostic) -> Report<()> {
        let primary = Label::primary((), self.within(&mistake.span)).with_message(&mistake.label);
        let related =
            mistake.related.iter().map(|r| Label::secondary((), self.within(&r.span)).with_message(&r.label));
        Report::error()
            .with_message(&mistake.message)
            .with_labels(std::iter::once(primary).chain(related).collect())
            .with_notes(vec![mistake.help.clone()])
    }

    /// The span moved to character boundaries of the text.
    fn within(&self, span: &Range<usize>) -> Range<usize> {
        let boundary =
            |at: usize| (0..=at.min(self.text.len())).rev().find(|&k| self.text.is_char_boundary(k));
        let start = boundary(span.start).unwrap_or(0);
        start..boundary(span.end).unwrap_or(0).max(start)
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render())
    }
}

impl std::error::Error for Diagnostics {}
