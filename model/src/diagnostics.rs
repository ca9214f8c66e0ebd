//! Mistakes in a model file, each shown where it is: file, line, column, what was expected and what to write instead.

use std::fmt;
use std::ops::Range;

mod painted;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term::{self, Chars, Config};
use painted::Painted;

/// All mistakes of one model file, in the order of the model file.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    file_name: String,
    text: String,
    mistakes: Vec<Diagnostic>,
    /// Where the lines of the text begin.
    starts: Vec<usize>,
}

/// Mistakes that are shown; of the others only the number.
const SHOWN: usize = 30;

/// Bytes of the longest line that is shown whole. Of a longer one only the part around the place is shown.
const LONGEST_LINE: usize = 400;

/// Bytes of such a line before and after the place.
const BEFORE: usize = 60;
const AFTER: usize = 100;

/// Characters of the longest message that is shown whole.
const LONGEST_MESSAGE: usize = 800;

/// One mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where it is, in bytes of the model file's text.
    pub span: Range<usize>,
    /// What is wrong, or what was expected.
    pub message: String,
    /// A label, printed under the place itself.
    pub label: String,
    /// What to write instead.
    pub help: String,
    /// Other places that are involved.
    pub related: Vec<Related>,
}

/// A second place that a mistake refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// Where it is, in bytes of the model file's text.
    pub span: Range<usize>,
    /// A label, printed under it.
    pub label: String,
}

impl Diagnostics {
    /// The mistakes of a text, sorted by place.
    pub fn new(file_name: &str, text: &str, mut mistakes: Vec<Diagnostic>) -> Self {
        mistakes.sort_by(|a, b| {
            (a.span.start, a.span.end, &a.message).cmp(&(b.span.start, b.span.end, &b.message))
        });
        mistakes.dedup();
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        // As many bytes, so that places stay where they are.
        let text = text.replace(|c: char| c.is_ascii_control() && !c.is_ascii_whitespace(), "?");
        Self { file_name: file_name.to_owned(), text, mistakes, starts }
    }

    /// The mistakes in the order of the model file.
    pub fn mistakes(&self) -> &[Diagnostic] {
        &self.mistakes
    }

    /// The file that they are in.
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// Line and column, in characters, of a place given in bytes; both count from one.
    pub fn place(&self, at: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= at).max(1);
        let before = self.text.get(self.starts[line - 1]..at).unwrap_or_default();
        (line, before.chars().count() + 1)
    }

    /// The mistakes as plain text for a terminal or a log, each with its `file:line:column`: the first thirty, and how
    /// many more there are.
    pub fn render(&self) -> String {
        self.render_with(Painted::plain())
    }

    /// The same with ANSI colours.
    pub fn render_colored(&self) -> String {
        self.render_with(Painted::colored())
    }

    fn render_with(&self, mut painted: Painted) -> String {
        let config = Config { chars: Chars::ascii(), ..Config::default() };
        for mistake in self.mistakes.iter().take(SHOWN) {
            let file = Excerpt { page: self, at: mistake.span.start };
            term::emit_to_write_style(&mut painted, &config, &file, &file.report(mistake))
                .expect("spans lie within the text and a buffer in memory takes every write");
        }
        let mut text = painted.text();
        match self.mistakes.len().saturating_sub(SHOWN) {
            0 => {}
            1 => text.push_str("error: and 1 more mistake\n"),
            more => text.push_str(&format!("error: and {more} more mistakes\n")),
        }
        text
    }
}

/// The model file as the message about one place shows it.
struct Excerpt<'a> {
    page: &'a Diagnostics,
    /// The place, in bytes.
    at: usize,
}

impl Excerpt<'_> {
    fn report(&self, mistake: &Diagnostic) -> Report<()> {
        let primary = Label::primary((), self.within(&mistake.span)).with_message(cut(&mistake.label));
        let is_shown = |other: &&Related| {
            let line = self.line(self.index(other.span.start));
            (line.start..=line.end).contains(&other.span.start)
        };
        let related = mistake.related.iter().filter(is_shown);
        let related = related.map(|r| Label::secondary((), self.within(&r.span)).with_message(cut(&r.label)));
        Report::error()
            .with_message(cut(&mistake.message))
            .with_labels(std::iter::once(primary).chain(related).collect())
            .with_notes(vec![cut(&mistake.help)])
    }

    /// The span moved to character boundaries of what is shown.
    fn within(&self, span: &Range<usize>) -> Range<usize> {
        let shown = |at: usize| {
            let line = self.line(self.index(at));
            boundary(&self.page.text, at).clamp(line.start, line.end)
        };
        let start = shown(span.start);
        start..shown(span.end).max(start)
    }

    /// The line that a byte is in.
    fn index(&self, at: usize) -> usize {
        self.page.starts.partition_point(|&start| start <= at).saturating_sub(1)
    }

    /// The bytes of a line, its end included.
    fn whole_line(&self, index: usize) -> Range<usize> {
        let starts = &self.page.starts;
        let start = starts.get(index).copied().unwrap_or(self.page.text.len());
        start..starts.get(index + 1).copied().unwrap_or(self.page.text.len())
    }

    /// The bytes of a line that are shown.
    fn line(&self, index: usize) -> Range<usize> {
        let line = self.whole_line(index);
        if line.len() <= LONGEST_LINE {
            return line;
        }
        let around = self.at.clamp(line.start, line.end);
        let first = around.saturating_sub(BEFORE).max(line.start);
        let last = (around + AFTER).min(line.end);
        boundary(&self.page.text, first)..boundary(&self.page.text, last)
    }
}

impl<'a> Files<'a> for Excerpt<'_> {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(&self.page.file_name)
    }

    fn source(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(&self.page.text)
    }

    fn line_index(&'a self, (): (), byte_index: usize) -> Result<usize, Error> {
        Ok(self.index(byte_index))
    }

    fn column_number(&'a self, (): (), line_index: usize, byte_index: usize) -> Result<usize, Error> {
        let start = self.whole_line(line_index).start;
        let before = self.page.text.get(start..byte_index.max(start)).unwrap_or_default();
        Ok(before.chars().count() + 1)
    }

    fn line_range(&'a self, (): (), line_index: usize) -> Result<Range<usize>, Error> {
        Ok(self.line(line_index))
    }
}

/// The last character boundary up to a byte.
fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&k| text.is_char_boundary(k)).unwrap_or(0)
}

/// A message, shortened if it is too long. A terminal would obey control characters of a name.
fn cut(message: &str) -> String {
    let (message, dots) = match message.char_indices().nth(LONGEST_MESSAGE) {
        None => (message, ""),
        Some((end, _)) => (&message[..end], "..."),
    };
    let shown = message.chars().map(|c| match c.is_control() && c != '\n' {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    });
    shown.chain([dots.to_owned()]).collect()
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render())
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests;
