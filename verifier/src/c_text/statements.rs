//! Statements of the C subset, run as they are read.

use super::Stored;
use super::tokens::Token;
use crate::nodes::Nodes;
use crate::program::Id;
use crate::refusal::Refusal;
use std::collections::HashMap;

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Held {
    Value(Id),
    Time,
    /// Elements that were written, or a table of constants.
    Array(HashMap<Vec<usize>, Id>),
    Curve {
        table: usize,
        time: Id,
    },
    /// An argument.
    Given,
}

/// Runs one function.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    pub(super) nodes: &'a mut Nodes,
    /// Named places.
    pub(super) numbers: &'a HashMap<String, usize>,
    pub(super) prefix: &'a str,
    tokens: &'a [Token],
    at: usize,
    pub(super) held: HashMap<String, Held>,
    pub(super) stored: Vec<Stored>,
    /// The round of the loop.
    pub(super) round: Option<usize>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(nodes: &'a mut Nodes, numbers: &'a HashMap<String, usize>, prefix: &'a str) -> Self {
        let (held, stored) = (HashMap::new(), Vec::new());
        Self { nodes, numbers, prefix, tokens: &[], at: 0, held, stored, round: None }
    }

    /// From the function's name to the end of its body; gives what it stores, in order.
    pub(super) fn function(mut self, tokens: &'a [Token]) -> Result<Vec<Stored>, Refusal> {
        self.tokens = tokens;
        self.at = 2;
        while !self.takes(")") {
            let name = self.word()?;
            match name.as_str() {
                "t" => self.held.insert(name, Held::Time),
                "y" | "x" | "accelerations" | "rows" | "charts" | "out" | "dy" | "dx" | "lambda" | "dfdx"
                | "dfdt" => self.held.insert(name, Held::Given),
                _ => None,
            };
        }
        self.expect("{")?;
        while !self.takes("}") {
            self.statement()?;
        }
        Ok(self.stored)
    }

    pub(super) fn peek(&self, ahead: usize) -> &str {
        self.tokens.get(self.at + ahead).map_or("", |token| &token.text)
    }

    pub(super) fn word(&mut self) -> Result<String, Refusal> {
        let token = self.tokens.get(self.at).ok_or_else(|| self.refused("the end of the text"))?;
        self.at += 1;
        Ok(token.text.clone())
    }

    pub(super) fn takes(&mut self, word: &str) -> bool {
        let is_there = self.peek(0) == word;
        self.at += usize::from(is_there);
        is_there
    }

    pub(super) fn expect(&mut self, word: &str) -> Result<(), Refusal> {
        if self.takes(word) {
            return Ok(());
        }
        Err(self.refused(&format!("no `{word}` where one is due: `{}`", self.peek(0))))
    }

    pub(super) fn refused(&self, what: &str) -> Refusal {
        let last = self.at.min(self.tokens.len()).saturating_sub(1);
        let line = self.tokens.get(last).map_or(1, |token| token.line);
        Refusal::new(line, format!("the C text has {what} that is not of the subset that is written"))
    }

    fn statement(&mut self) -> Result<(), Refusal> {
        let real = format!("{}_real", self.prefix);
        match self.peek(0) {
            // `(void)t;`
            "(" => {
                self.at += 4;
                self.expect(";")
            }
            "static" => self.table(),
            "for" => self.repeated(),
            "const" if self.peek(1) == real => {
                self.at += 2;
                let name = self.word()?;
                self.expect("=")?;
                let value = self.sum()?;
                self.held.insert(name, Held::Value(value));
                self.expect(";")
            }
            word if word == real => {
                self.at += 1;
                let name = self.word()?;
                while !self.takes(";") {
                    self.at += 1;
                    if self.at >= self.tokens.len() {
                        return Err(self.refused("a declaration"));
                    }
                }
                self.held.insert(name, Held::Array(HashMap::new()));
                Ok(())
            }
            _ if self.peek(1) == "(" => self.call(),
            _ => self.assignment(),
        }
    }

    /// `static const double PARTS_0[2][3] = {{...}, ...};`
    fn table(&mut self) -> Result<(), Refusal> {
        self.at += 3;
        let name = self.word()?;
        while self.peek(0) != "=" {
            self.word()?;
        }
        self.expect("=")?;
        let (mut elements, mut place) = (HashMap::new(), Vec::new());
        loop {
            if self.takes("{") {
                place.push(0);
            } else if self.takes("}") {
                place.pop();
                if place.is_empty() {
                    break;
                }
            } else if self.takes(",") {
                *place.last_mut().ok_or_else(|| self.refused("a table"))? += 1;
            } else {
                let value = self.sum()?;
                elements.insert(place.clone(), value);
            }
        }
        self.held.insert(name, Held::Array(elements));
        self.expect(";")
    }

    /// `for (int i = 0; i < 6; i++)` and its reverse, `for (int i = 6 - 1; i >= 0; i--)`.
    fn repeated(&mut self) -> Result<(), Refusal> {
        let head: Vec<String> = (0..18).map(|ahead| self.peek(ahead).to_owned()).collect();
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        let (count, length, is_backward) = match head[..] {
            ["for", "(", "int", "i", "=", "0", ";", "i", "<", count, ";", "i", "++", ")", ..] => {
                (count, 14, false)
            }
            ["for", "(", "int", "i", "=", count, "-", "1", ";", "i", ">=", "0", ";", "i", "--", ")", ..] => {
                (count, 16, true)
            }
            _ => return Err(self.refused("a loop")),
        };
        let count: usize = count.parse().map_err(|_| self.refused("a loop"))?;
        self.at += length;
        let start = self.at;
        let rounds: Vec<usize> = if is_backward { (0..count).rev().collect() } else { (0..count).collect() };
        for round in rounds {
            (self.at, self.round) = (start, Some(round));
            if self.takes("{") {
                while !self.takes("}") {
                    self.statement()?;
                }
            } else {
                self.statement()?;
            }
        }
        self.round = None;
        Ok(())
    }

    /// What another function computes first, or a table's curve.
    fn call(&mut self) -> Result<(), Refusal> {
        let function = self.word()?;
        let mut arguments: Vec<Vec<Token>> = vec![Vec::new()];
        let mut depth = 0;
        loop {
            let token = self.tokens.get(self.at).ok_or_else(|| self.refused("a call"))?.clone();
            self.at += 1;
            depth += i32::from(token.text == "(") - i32::from(token.text == ")");
            if depth == 0 {
                break;
            }
            match (depth, token.text.as_str()) {
                (1, "(") => {}
                (1, ",") => arguments.push(Vec::new()),
                _ => arguments.last_mut().expect("there is one").push(token),
            }
        }
        self.expect(";")?;
        let names: Vec<&str> = arguments
            .iter()
            .map(|argument| if let [one] = &argument[..] { one.text.as_str() } else { "" })
            .collect();
        let own = function.strip_prefix(self.prefix).and_then(|name| name.strip_prefix('_'));
        let pieces = |name: &str| name.rsplit_once("_pieces_").and_then(|(_, n)| n.parse().ok());
        match (own, &names[..]) {
            (Some("spline"), [_, table, _, "t", curve]) => {
                let table = pieces(table).ok_or_else(|| self.refused("a table"))?;
                let time = self.nodes.push(crate::program::Node::Read(crate::program::Source::Time));
                self.held.insert((*curve).to_owned(), Held::Curve { table, time });
            }
            (
                Some("accelerations" | "corrected_accelerations" | "joint_accelerations"),
                ["m", "t", "y" | "x", "accelerations" | "rates"],
            ) => {
                self.held.insert(names[3].to_owned(), Held::Given);
            }
            _ => return Err(self.refused("a call")),
        }
        Ok(())
    }

    fn assignment(&mut self) -> Result<(), Refusal> {
        let line = self.tokens.get(self.at).map_or(1, |token| token.line);
        let array = self.word()?;
        let place = self.indices()?;
        self.expect("=")?;
        let value = self.sum()?;
        self.expect(";")?;
        match self.held.get_mut(&array) {
            Some(Held::Array(elements)) => {
                elements.insert(place, value);
            }
            Some(Held::Given) => {
                self.stored.push(Stored { array, place, value, line });
            }
            _ => return Err(self.refused("a place to store to")),
        }
        Ok(())
    }
}
