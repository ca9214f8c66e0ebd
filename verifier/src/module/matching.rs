//! Compares a module with what it must look like, token by token, and takes out what is computed.

use crate::refusal::Refusal;
use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::iter::Peekable;

/// The body of a function, where the expected text has `{ HOLE_name }`.
#[derive(Clone, Debug)]
pub struct Hole {
    /// The braces with what is in them.
    pub body: Group,
    /// Names of the arguments that the expected text leaves to choice, `ANY_t` for `t` or any name of what is not read,
    /// `_t`.
    pub arguments: Vec<String>,
    /// The function's documentation.
    pub doc: String,
}

/// What stood in the places that the expected text leaves open.
#[derive(Debug, Default)]
pub struct Matched {
    /// Function bodies by name.
    pub holes: BTreeMap<String, Hole>,
    /// Numbers by name, where the expected text has `INT_name`: the same number everywhere.
    pub numbers: BTreeMap<String, usize>,
    /// The documentation of the file, a line each.
    pub data_sheet: Vec<String>,
    /// All other documentation, with its line.
    pub docs: Vec<(usize, String)>,
    arguments: Vec<String>,
    doc: String,
    /// How many groups the walk is in.
    depth: usize,
}

impl Matched {
    /// Walks both texts at once. Documentation and commas at the end of a list are passed over.
    pub fn walk(&mut self, expected: TokenStream, found: TokenStream, end: usize) -> Result<(), Refusal> {
        let mut found = found.into_iter().peekable();
        let mut last = end;
        for token in expected {
            self.skip_docs(&mut found);
            // Long names are written in a list of lines, with a comma at the end.
            if token.to_string() == ">" {
                found.next_if(|token| token.to_string() == ",");
            }
            let Some(next) = found.next() else {
                return Err(Refusal::new(last, format!("`{token}` is missing")));
            };
            last = next.span().end().line;
            self.token(token, next)?;
        }
        self.skip_docs(&mut found);
        if found.peek().is_some_and(|token| token.to_string() == ",") {
            found.next();
        }
        match found.next() {
            Some(extra) => Err(Refusal::at(extra.span(), format!("`{}` is too much", shortened(&extra)))),
            None => Ok(()),
        }
    }

    fn token(&mut self, expected: TokenTree, found: TokenTree) -> Result<(), Refusal> {
        match (&expected, &found) {
            (TokenTree::Group(expected), TokenTree::Group(group))
                if expected.delimiter() == group.delimiter() =>
            {
                match hole_name(expected) {
                    Some(name) => {
                        self.hole(name, group);
                        Ok(())
                    }
                    None => {
                        self.depth += 1;
                        self.walk(expected.stream(), group.stream(), group.span_close().end().line)?;
                        self.depth -= 1;
                        Ok(())
                    }
                }
            }
            (TokenTree::Ident(open), _) if open.to_string().starts_with("INT_") => {
                self.number(&open.to_string(), &found)
            }
            (TokenTree::Ident(open), TokenTree::Ident(name)) if open.to_string().starts_with("ANY_") => {
                self.argument(&open.to_string(), name)
            }
            _ if expected.to_string() == found.to_string() => {
                if expected.to_string() == "fn" {
                    self.arguments.clear();
                }
                Ok(())
            }
            _ => Err(Refusal::at(
                found.span(),
                format!("expected `{}`, found `{}`", shortened(&expected), shortened(&found)),
            )),
        }
    }

    fn hole(&mut self, name: String, body: &Group) {
        let hole = Hole {
            body: body.clone(),
            arguments: std::mem::take(&mut self.arguments),
            doc: std::mem::take(&mut self.doc),
        };
        self.holes.insert(name, hole);
    }

    fn number(&mut self, name: &str, found: &TokenTree) -> Result<(), Refusal> {
        let refuse = |message| Err(Refusal::at(found.span(), message));
        let Ok(number) = found.to_string().parse::<usize>() else {
            return refuse(format!("expected a count, found `{}`", shortened(found)));
        };
        match *self.numbers.entry(name.trim_start_matches("INT_").to_owned()).or_insert(number) {
            known if known != number => refuse(format!("expected the count {known}, found {number}")),
            _ => Ok(()),
        }
    }

    fn argument(&mut self, open: &str, found: &Ident) -> Result<(), Refusal> {
        let (name, found_name) = (open.trim_start_matches("ANY_"), found.to_string());
        if found_name != name && !found_name.starts_with('_') {
            return Err(Refusal::at(
                found.span(),
                format!("expected the argument `{name}`, found `{found_name}`"),
            ));
        }
        self.arguments.push(found_name);
        Ok(())
    }

    /// Passes over `#[doc = "..."]`, and over that of the file, and remembers them.
    fn skip_docs(&mut self, found: &mut Peekable<impl Iterator<Item = TokenTree> + Clone>) {
        // A copy of what is to come is taken only where a `#` stands: one for each token would take a square of them.
        while found
            .peek()
            .is_some_and(|token| matches!(token, TokenTree::Punct(mark) if mark.as_char() == '#'))
        {
            let mut ahead = found.clone();
            let Some(sign) = ahead.next_if(|token| token.to_string() == "#") else { return };
            let is_of_file = ahead.next_if(|token| token.to_string() == "!").is_some();
            if is_of_file && self.depth > 0 {
                return;
            }
            let Some(TokenTree::Group(attribute)) = ahead.next() else { return };
            let Some(text) = documentation(&attribute) else { return };
            if is_of_file {
                self.data_sheet.push(text.trim().to_owned());
            } else {
                self.docs.push((sign.span().start().line, text.clone()));
                self.doc = text;
            }
            *found = ahead;
        }
    }
}

/// The text of `[doc = "text"]`.
fn documentation(attribute: &Group) -> Option<String> {
    let mut tokens = attribute.stream().into_iter();
    let is_doc = tokens.next()?.to_string() == "doc" && tokens.next()?.to_string() == "=";
    let text = syn::parse2::<syn::LitStr>(tokens.collect()).ok()?;
    is_doc.then(|| text.value())
}

/// `name` of `{ HOLE_name }`.
fn hole_name(group: &Group) -> Option<String> {
    let mut tokens = group.stream().into_iter();
    let TokenTree::Ident(name) = tokens.next()? else { return None };
    let is_alone = group.delimiter() == Delimiter::Brace && tokens.next().is_none();
    name.to_string().strip_prefix("HOLE_").filter(|_| is_alone).map(str::to_owned)
}

/// Enough of a token for a message.
fn shortened(token: &TokenTree) -> String {
    let text = token.to_string();
    if text.chars().count() <= 60 { text } else { text.chars().take(57).chain("...".chars()).collect() }
}
