//! What is found while a model file is walked: mistakes, and the place of everything in the text.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;

use crate::diagnostics::{Diagnostic, Related};
use crate::validate::{Owner, Place, Problem};
use crate::{Curve, Formula, JointKind, Number, OutputKind, Rational, Seen};

/// Gets the text of a table by the path that the model file gives.
pub(super) type Load<'t> = dyn FnMut(&str) -> Result<String, String> + 't;

/// The state of a walk.
pub(super) struct Reader<'t> {
    text: &'t str,
    load: &'t mut Load<'t>,
    mistakes: Vec<Mistake>,
    /// What is not wrong, and yet worth a word.
    pub(super) remarks: Vec<String>,
    spans: HashMap<Place, Range<usize>>,
    broken: HashSet<Place>,
    /// Names of the model file's parameters; numbers may refer to them.
    pub(super) parameters: Vec<String>,
    /// Their values.
    pub(super) values: Vec<Rational>,
    /// Parameters that are computed from others.
    pub(super) derived: Vec<(String, Number)>,
    /// Names of the model file's inputs; forces may refer to them.
    pub(super) inputs: Vec<String>,
    /// Inputs of which the model file says that they have corners or steps, with where it says so.
    pub(super) corners: Vec<(usize, Range<usize>)>,
    /// Names of the model file's bodies, joints and so on, by what they are, as far as it states them correctly.
    pub(super) names: HashMap<&'static str, Vec<Option<String>>>,
    /// Numbers of the mechanism by the names that formulas have for them, once outputs are read.
    pub(super) visible: Vec<(String, Seen)>,
    /// What these outputs are.
    pub(super) outputs: Vec<OutputKind>,
    /// Curves that formulas may call.
    pub(super) curves: Vec<Curve>,
    /// Formulas that have a name.
    pub(super) formulas: Vec<(String, Formula)>,
    /// Where the values of ready elements are: what they stand for has these places, too.
    pub(super) elements: Vec<Range<usize>>,
    /// Kinds of its joints, likewise.
    pub(super) joint_kinds: Vec<Option<JointKind>>,
    /// Names of joints, couplers, drivers and outputs so far, with their places and what they are.
    taken: HashMap<String, (Range<usize>, &'static str)>,
}

struct Mistake {
    nature: Nature,
    diagnostic: Diagnostic,
}

/// How certain a mistake is while the model file has syntax errors.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Nature {
    /// Something written is wrong.
    Written,
    /// Something is missing or does not fit; a line that could not be read may be the cause.
    Absent,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, load: &'t mut Load<'t>) -> Self {
        Self {
            text,
            load,
            mistakes: Vec::new(),
            remarks: Vec::new(),
            spans: HashMap::new(),
            broken: HashSet::new(),
            parameters: Vec::new(),
            values: Vec::new(),
            derived: Vec::new(),
            inputs: Vec::new(),
            corners: Vec::new(),
            names: HashMap::new(),
            visible: Vec::new(),
            outputs: Vec::new(),
            curves: Vec::new(),
            formulas: Vec::new(),
            elements: Vec::new(),
            joint_kinds: Vec::new(),
            taken: HashMap::new(),
        }
    }

    /// Takes a name of something that stands in results and messages by its name alone: joints, couplers, drivers and
    /// outputs share their names.
    pub(super) fn take(&mut self, place: Place, span: &Range<usize>, name: &str, what: &'static str) {
        if matches!(what, "body" | "element" | "rolling" | "force" | "controller" | "event" | "contact") {
            return;
        }
        let earlier = self.taken.get(name).filter(|(_, kind)| *kind != what).cloned();
        if let Some((first, kind)) = earlier {
            let related = Related { span: first, label: format!("a {kind} here") };
            let words = [
                format!("`{name}` names a {kind} and a {what}").replace("a output", "an output"),
                "used again".to_owned(),
                "choose another name: joints, couplers, drivers and outputs share one set of names"
                    .to_owned(),
            ];
            self.clash(place, span.clone(), related, words);
        }
        self.taken.entry(name.to_owned()).or_insert_with(|| (span.clone(), what));
    }

    /// The names of all things of a kind.
    pub(super) fn named(&self, what: &str) -> &[Option<String>] {
        self.names.get(what).map_or(&[], Vec::as_slice)
    }

    /// Whether a formula may name something so, be it a number or what moves.
    pub(super) fn is_named(&self, name: &str) -> bool {
        let numbers =
            self.parameters.iter().chain(&self.inputs).chain(self.derived.iter().map(|(name, _)| name));
        let moving = self.visible.iter().map(|(name, _)| name);
        let formulas = self.formulas.iter().map(|(name, _)| name);
        numbers.chain(moving).chain(formulas).any(|known| known == name)
    }

    /// Whether there is a joint of this name.
    pub(super) fn has_joint(&self, name: &str) -> bool {
        self.named("joint").iter().any(|joint| joint.as_deref() == Some(name))
    }

    /// The text of a table.
    pub(super) fn load(&mut self, path: &str) -> Result<String, String> {
        (self.load)(path)
    }

    /// Where a part of a string is in the text: all of it if it is not written character by character.
    pub(super) fn within(&self, string: &Range<usize>, text: &str, part: &Range<usize>) -> Range<usize> {
        let written = self.text.get(string.clone()).unwrap_or_default();
        let is_plain = written.len() == text.len() + 2 && written.get(1..=text.len()) == Some(text);
        if !is_plain {
            return string.clone();
        }
        let start = string.start + 1;
        // Where a string breaks off is its closing quote.
        let end = (start + part.end).max(start + part.start + 1).min(string.end);
        start + part.start..end
    }

    /// Notes where a place is.
    pub(super) fn mark(&mut self, place: Place, span: Range<usize>) {
        self.spans.insert(place, span);
    }

    /// Reports that something written is wrong, and keeps its place from being judged again.
    pub(super) fn wrong(&mut self, place: Place, span: Range<usize>, [message, label, help]: [String; 3]) {
        self.broken.insert(place);
        self.push(Nature::Written, Diagnostic { span, message, label, help, related: Vec::new() });
    }

    /// Reports a key that nothing knows.
    pub(super) fn unknown(&mut self, span: Range<usize>, [message, label, help]: [String; 3]) {
        self.push(Nature::Written, Diagnostic { span, message, label, help, related: Vec::new() });
    }

    /// Keeps a place from being judged: a part of it had a mistake.
    pub(super) fn doubt(&mut self, place: Place) {
        self.broken.insert(place);
    }

    /// The same as [`Self::wrong`], with a second place in the text.
    pub(super) fn clash(&mut self, place: Place, span: Range<usize>, related: Related, words: [String; 3]) {
        self.wrong(place, span, words);
        if let Some(last) = self.mistakes.last_mut() {
            last.diagnostic.related.push(related);
        }
    }

    /// Reports that something is missing, at the place that should have it.
    pub(super) fn missing(&mut self, place: Place, words: [String; 3]) {
        self.missing_at(place, self.span(place), words);
    }

    /// The same at a part of the place.
    pub(super) fn missing_at(
        &mut self,
        place: Place,
        span: Range<usize>,
        [message, label, help]: [String; 3],
    ) {
        self.broken.insert(place);
        self.push(Nature::Absent, Diagnostic { span, message, label, help, related: Vec::new() });
    }

    /// Reports problems, save at places with a mistake of their own.
    pub(super) fn add_problems(&mut self, problems: Vec<Problem>) {
        for Problem { place, also, message, label, help } in problems {
            if self.is_broken(place) || also.as_ref().is_some_and(|(place, _)| self.is_broken(*place)) {
                continue;
            }
            let related = also.map(|(place, label)| Related { span: self.span(place), label });
            let related = related.into_iter().collect();
            let span = self.span(place);
            self.push(Nature::Absent, Diagnostic { span, message, label, help, related });
        }
    }

    /// Whether the bodies' names or the joints' references to them are in doubt, so that nothing can be said of how
    /// the bodies hang together.
    pub(super) fn names_are_broken(&self) -> bool {
        let names_bodies = |place: &Place| match place.owner {
            Owner::Page => matches!(place.key, "body" | "joint"),
            Owner::Body(_) => matches!(place.key, "name" | "fixed" | "free" | "driven"),
            Owner::Joint(_) => matches!(place.key, "first" | "second" | "kind"),
            Owner::End(..) => place.key == "body",
            _ => false,
        };
        self.broken.iter().any(names_bodies)
    }

    /// Whether the model file has a place.
    pub(super) fn is_written(&self, place: Place) -> bool {
        self.spans.contains_key(&place)
    }

    /// Whether a place had a mistake of its own.
    pub(super) fn is_doubted(&self, place: Place) -> bool {
        self.broken.contains(&place)
    }

    pub(super) fn is_clean(&self) -> bool {
        self.mistakes.is_empty()
    }

    /// The mistakes of a model file without syntax errors.
    pub(super) fn into_mistakes(self) -> Vec<Diagnostic> {
        self.mistakes.into_iter().map(|m| m.diagnostic).collect()
    }

    /// Syntax errors, with those mistakes that they cannot have caused: written ones on other lines.
    pub(super) fn into_certain(self, syntax: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let ends: Vec<usize> = self.text.match_indices('\n').map(|(at, _)| at).collect();
        let line = |at: usize| ends.partition_point(|&end| end < at);
        let bad: BTreeSet<usize> = syntax.iter().map(|d| line(d.span.start)).collect();
        let certain = self.mistakes.iter().filter(|m| {
            let span = &m.diagnostic.span;
            m.nature == Nature::Written && bad.range(line(span.start)..=line(span.end)).next().is_none()
        });
        let certain: Vec<Diagnostic> = certain.map(|m| m.diagnostic.clone()).collect();
        syntax.into_iter().chain(certain).collect()
    }

    /// What is wrong with an element is said once, not again of what it stands for.
    fn push(&mut self, nature: Nature, diagnostic: Diagnostic) {
        let is_within =
            |inner: &Range<usize>, outer: &Range<usize>| outer.start <= inner.start && inner.end <= outer.end;
        let place = self.elements.iter().find(|place| is_within(&diagnostic.span, place));
        let mut known = self.mistakes.iter().map(|mistake| &mistake.diagnostic.span);
        if place.is_some_and(|place| known.any(|known| is_within(known, place))) {
            return;
        }
        self.mistakes.push(Mistake { nature, diagnostic });
    }

    /// Where a place is, or the nearest thing around it that the model file has.
    pub(super) fn span(&self, place: Place) -> Range<usize> {
        let around = std::iter::successors(Some(place), |p| p.fallback());
        around.filter_map(|p| self.spans.get(&p)).next().cloned().unwrap_or_default()
    }

    /// Whether a place, or what stands for it, has a mistake of its own.
    fn is_broken(&self, place: Place) -> bool {
        let around = std::iter::successors(Some(place), |p| p.fallback());
        around.take_while(|p| !p.key.is_empty() || *p == place).any(|p| self.broken.contains(&p))
    }
}
