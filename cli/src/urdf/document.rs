//! The elements of an XML file, read as forgivingly as other readers of robots do: prefixes need no declaration, the
//! XML declaration may stand anywhere, comments may hold `--`, and unknown entities stay as they are.

use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};

/// All elements in the order of the file, under a nameless one; those in an element follow it directly.
#[derive(Debug)]
pub(super) struct Document(Vec<Element>);

#[derive(Debug)]
struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    line: u32,
    parent: usize,
    /// Index behind the last element inside.
    end: usize,
}

/// An element of a document.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<'d>(&'d Document, usize);

impl Document {
    /// # Errors
    /// The line and what is wrong there.
    pub(super) fn parse(text: &str) -> Result<Self, (u32, String)> {
        let mut reader = Reader::from_str(text);
        reader.config_mut().allow_dangling_amp = true;
        let mut elements = vec![Element::new(1, 0)];
        let (mut open, mut line, mut seen) = (0, 1, 0);
        loop {
            let at = usize::try_from(reader.buffer_position()).unwrap_or(text.len());
            line += lines(&text.as_bytes()[seen..at]);
            seen = at;
            let event = reader.read_event().map_err(|e| {
                let at = usize::try_from(reader.error_position()).unwrap_or(seen).clamp(seen, text.len());
                (line + lines(&text.as_bytes()[seen..at]), e.to_string())
            })?;
            let (start, is_open) = match event {
                Event::Start(start) => (start, true),
                Event::Empty(start) => (start, false),
                Event::End(_) => {
                    elements[open].end = elements.len();
                    open = elements[open].parent;
                    continue;
                }
                Event::Eof => break,
                _ => continue,
            };
            let mut element = Element::new(line, open);
            element.fill(&start).map_err(|words| (line, words))?;
            elements.push(element);
            let index = elements.len() - 1;
            elements[index].end = elements.len();
            open = if is_open { index } else { open };
        }
        if open > 0 {
            return Err((elements[open].line, format!("<{}> is not closed", elements[open].name)));
        }
        elements[0].end = elements.len();
        Ok(Self(elements))
    }

    /// The same without all elements of these names and what is in them.
    pub(super) fn without(self, names: &[String]) -> Self {
        let mut left: Vec<Element> = Vec::new();
        // For each old index the new one, and where the element that is left out ends.
        let (mut moved, mut end) = (Vec::new(), 0);
        for (index, element) in self.0.into_iter().enumerate() {
            if index > 0 && index >= end && names.contains(&element.name) {
                end = element.end;
            }
            moved.push(left.len());
            if index >= end {
                left.push(Element { parent: moved[element.parent], ..element });
            }
        }
        moved.push(left.len());
        left.iter_mut().for_each(|element| element.end = moved[element.end]);
        Self(left)
    }

    /// The first `<robot>` that is in no other element, or the first element of another name.
    pub(super) fn root(&self) -> Option<Node<'_>> {
        let outermost = Node(self, 0);
        outermost.child("robot").or_else(|| outermost.children().next())
    }

    /// All elements.
    pub(super) fn all(&self) -> impl Iterator<Item = Node<'_>> {
        Node(self, 0).descendants().skip(1)
    }
}

impl Element {
    fn new(line: u32, parent: usize) -> Self {
        Self { name: String::new(), attributes: Vec::new(), line, parent, end: 0 }
    }

    fn fill(&mut self, start: &BytesStart<'_>) -> Result<(), String> {
        start.name().as_ref().clone_into(&mut self.name);
        for attribute in start.attributes().with_checks(false) {
            let attribute = attribute.map_err(|e| format!("<{}>: {e}", self.name))?;
            let raw = &*attribute.value;
            let value = unescape(raw).map_or_else(|_| raw.to_owned(), Into::into);
            self.attributes.push((attribute.key.as_ref().to_owned(), value));
        }
        Ok(())
    }
}

impl<'d> Node<'d> {
    fn element(self) -> &'d Element {
        &self.0.0[self.1]
    }

    /// Its name as it is written, with a prefix if there is one.
    pub(super) fn name(self) -> &'d str {
        &self.element().name
    }

    pub(super) fn is(self, name: &str) -> bool {
        self.name() == name
    }

    pub(super) fn line(self) -> u32 {
        self.element().line
    }

    pub(super) fn attribute(self, name: &str) -> Option<&'d str> {
        let attributes = &self.element().attributes;
        attributes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    pub(super) fn children(self) -> impl Iterator<Item = Self> {
        let Self(document, index) = self;
        let last = self.element().end;
        let inside = move |index: usize| (index < last).then_some(index);
        let next = move |child: &usize| inside(document.0[*child].end);
        std::iter::successors(inside(index + 1), next).map(move |child| Self(document, child))
    }

    /// The first child of a name.
    pub(super) fn child(self, name: &str) -> Option<Self> {
        self.children().find(|child| child.is(name))
    }

    /// The element and all that is in it.
    pub(super) fn descendants(self) -> impl Iterator<Item = Self> {
        (self.1..self.element().end).map(move |index| Self(self.0, index))
    }

    /// The element and those that it is in, outwards.
    pub(super) fn ancestors(self) -> impl Iterator<Item = Self> {
        let outer = move |index: &usize| Some(self.0.0[*index].parent).filter(|outer| *outer > 0);
        std::iter::successors(Some(self.1), outer).map(move |index| Self(self.0, index))
    }
}

fn lines(text: &[u8]) -> u32 {
    u32::try_from(text.iter().filter(|byte| **byte == b'\n').count()).unwrap_or(u32::MAX)
}
