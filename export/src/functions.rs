//! Functions of a module as C, statement for statement.
//!
//! Blocks in which rustc wants long functions cut are left away: a C compiler has no need of them, and names are unique
//! within a function.

use crate::Error;
use crate::expressions::{number, place, value};
use crate::module::{Module, arguments, whole};
use crate::names::Names;
use quote::ToTokens;
use std::iter;
use syn::{Block, Expr, ExprCall, ExprForLoop, ImplItemFn, Item, Local, Pat, ReturnType, Stmt, Type};

/// A function in C.
#[derive(Debug)]
pub(crate) struct Function {
    /// What the module says of it, without Rust's marks.
    pub(crate) doc: String,
    /// Its head, without what ends it.
    pub(crate) head: String,
    /// Its statements, a line each.
    pub(crate) body: Vec<String>,
    pub(crate) name: String,
    /// What it takes beside the mechanism.
    pub(crate) arguments: Vec<Argument>,
}

/// An argument of a function: an array, or a number if it has no size.
#[derive(Debug)]
pub(crate) struct Argument {
    pub(crate) name: String,
    pub(crate) size: Option<usize>,
    pub(crate) is_written: bool,
}

/// Writes a function.
pub(crate) fn function(module: &Module, names: &Names, of: &ImplItemFn) -> Result<Function, Error> {
    let rust_name = of.sig.ident.to_string();
    let mut writer = Writer { names, lines: Vec::new(), indent: 1 };
    let mut parameters = vec![format!("const {} *m", names.prefix)];
    let mut taken = Vec::new();
    for (name, ty) in arguments(of) {
        let (name, shape) = (names.variable(&name), shape(module, ty)?);
        parameters.push(shape.parameter(names, &name));
        taken.push(shape.argument(name));
    }
    if let ReturnType::Type(_, ty) = &of.sig.output {
        let shape = match &**ty {
            ty if ty.to_token_stream().to_string().contains("Energy") => {
                Shape { is_written: true, sizes: vec![2] }
            }
            ty => Shape { is_written: true, ..shape(module, ty)? },
        };
        parameters.push(shape.parameter(names, "out"));
        taken.push(shape.argument("out".to_owned()));
    }
    writer.block(&of.block, &Tail::Result)?;
    let all = iter::once("m").chain(taken.iter().map(|argument| argument.name.as_str()));
    let unused = all.filter(|name| !writer.lines.iter().any(|line| mentions(line, name)));
    let mut body: Vec<String> = unused.map(|name| format!("    (void){name};")).collect();
    body.extend(writer.lines);
    let name = names.own(&rust_name);
    Ok(Function {
        doc: doc(of),
        head: format!("void {name}({})", parameters.join(", ")),
        body,
        name: rust_name,
        arguments: taken,
    })
}

/// Whether a line has a name as a word.
fn mentions(line: &str, name: &str) -> bool {
    line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).any(|word| word == name)
}

/// The first sentence of a function's documentation.
fn doc(function: &ImplItemFn) -> String {
    let lines = function.attrs.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(doc) if doc.path.is_ident("doc") => match &doc.value {
            Expr::Lit(literal) => match &literal.lit {
                syn::Lit::Str(text) => Some(text.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    let text = lines.collect::<Vec<_>>().join(" ");
    let plain = text.replace("[`gyro_sim::JointSpace::joint_accelerations`]", "the accelerations");
    let plain = plain.replace("[`gyro_sim::Dynamics::accelerations`]", "the accelerations");
    plain.replace("[`gyro_sim::CorrectedDynamics::corrected_accelerations`]", "the accelerations")
}

/// An argument: a number if it has no sizes.
struct Shape {
    is_written: bool,
    sizes: Vec<usize>,
}

impl Shape {
    fn argument(&self, name: String) -> Argument {
        let size = (!self.sizes.is_empty()).then(|| self.sizes.iter().product());
        Argument { name, size, is_written: self.is_written }
    }

    fn parameter(&self, names: &Names, name: &str) -> String {
        let real = names.own("real");
        // What points at rows of constants cannot be passed rows of variables before C23.
        let constant = if self.is_written || self.sizes.len() > 1 { "" } else { "const " };
        match self.sizes.as_slice() {
            [] => format!("{real} {name}"),
            [0] => format!("{constant}{real} *{name}"),
            sizes => {
                let sizes: String = sizes.iter().map(|size| format!("[{size}]")).collect();
                format!("{constant}{real} {name}{sizes}")
            }
        }
    }
}

fn shape(module: &Module, ty: &Type) -> Result<Shape, Error> {
    match ty {
        Type::Reference(reference) => {
            Ok(Shape { is_written: reference.mutability.is_some(), ..shape(module, &reference.elem)? })
        }
        Type::Array(array) => {
            let inner = shape(module, &array.elem)?;
            Ok(Shape { is_written: false, sizes: [vec![whole(&array.len)?], inner.sizes].concat() })
        }
        Type::Path(path) => match path.path.segments.last().map(|segment| segment.ident.to_string()) {
            Some(name) if name == "T" => Ok(Shape { is_written: false, sizes: vec![] }),
            Some(name) if module.sizes.contains_key(&name) => {
                Ok(Shape { is_written: false, sizes: vec![module.size(&name)] })
            }
            _ => Err(Error::unknown("the type of an argument", ty)),
        },
        _ => Err(Error::unknown("the type of an argument", ty)),
    }
}

/// What the value at the end of a block is.
enum Tail {
    /// The function's result.
    Result,
    /// Names that are handed on.
    Names,
}

struct Writer<'a> {
    names: &'a Names,
    lines: Vec<String>,
    indent: usize,
}

/// The widest line.
const WIDTH: usize = 110;

impl Writer<'_> {
    /// A line, broken at spaces where it is too long.
    fn line(&mut self, text: &str) {
        let indent = "    ".repeat(self.indent);
        let mut line = indent.clone();
        for (n, word) in text.split(' ').enumerate() {
            if n > 0 && line.len() + 1 + word.len() > WIDTH {
                self.lines.push(std::mem::replace(&mut line, format!("{indent}    ")));
            } else if n > 0 {
                line.push(' ');
            }
            line += word;
        }
        self.lines.push(line);
    }

    fn block(&mut self, block: &Block, tail: &Tail) -> Result<(), Error> {
        block.stmts.iter().try_for_each(|statement| self.statement(statement, tail))
    }

    fn statement(&mut self, statement: &Stmt, tail: &Tail) -> Result<(), Error> {
        match statement {
            Stmt::Local(local) => self.local(local),
            Stmt::Item(Item::Const(table)) => {
                let lines = table_of(self.names, table, "    ")?;
                self.lines.extend(lines.iter().map(|line| format!("    {line}")));
                Ok(())
            }
            Stmt::Expr(Expr::ForLoop(repeated), _) => self.repeated(repeated),
            Stmt::Expr(Expr::Assign(assigned), _) => self.assigned(&assigned.left, &assigned.right),
            Stmt::Expr(Expr::Call(call), Some(_)) => self.solved(call),
            Stmt::Expr(Expr::MethodCall(call), Some(_)) if call.method == "copy_from_slice" => {
                self.copied(&call.receiver, &call.args[0])
            }
            Stmt::Expr(expr, None) => match (tail, expr) {
                (Tail::Names, Expr::Tuple(_)) => Ok(()),
                (Tail::Result, Expr::Array(array)) => self.stored("out", array),
                (Tail::Result, Expr::Struct(energy)) => {
                    for (n, field) in energy.fields.iter().enumerate() {
                        let value = value(self.names, &field.expr)?;
                        self.line(&format!("out[{n}] = {value};"));
                    }
                    Ok(())
                }
                _ => Err(Error::unknown("the end of a block", expr)),
            },
            Stmt::Expr(..) | Stmt::Item(_) | Stmt::Macro(_) => Err(Error::unknown("a statement", statement)),
        }
    }

    fn local(&mut self, local: &Local) -> Result<(), Error> {
        let Some(init) = &local.init else { return Err(Error::unknown("a binding", local)) };
        let real = self.names.own("real");
        match (&local.pat, &*init.expr) {
            // A part of a long function.
            (Pat::Tuple(_), Expr::Block(block)) => self.block(&block.block, &Tail::Names),
            (Pat::Tuple(_), Expr::Call(apart)) => match apart.args.first() {
                Some(Expr::Closure(closure)) => match &*closure.body {
                    Expr::Block(block) => self.block(&block.block, &Tail::Names),
                    _ => Err(Error::unknown("a part of a function", local)),
                },
                _ => Err(Error::unknown("a part of a function", local)),
            },
            (Pat::Ident(name), _) if name.ident == "k" => Ok(()),
            (Pat::Ident(name), Expr::Repeat(_)) => {
                let (sizes, zeros) = zeroed(&init.expr)?;
                self.line(&format!("{real} {}{sizes} = {zeros};", name.ident));
                Ok(())
            }
            (Pat::Ident(name), Expr::MethodCall(call)) if call.method == "spline" => {
                let tables: Vec<String> = call
                    .args
                    .iter()
                    .map(|table| table.to_token_stream().to_string().replace("& ", "").to_lowercase())
                    .collect();
                let (knots, pieces) = (self.names.own(&tables[0]), self.names.own(&tables[1]));
                let (time, spline) = (value(self.names, &call.receiver)?, self.names.own("spline"));
                self.line(&format!("{real} {}[3];", name.ident));
                let n = format!("(int)(sizeof {pieces} / sizeof *{pieces})");
                self.line(&format!("{spline}({knots}, {pieces}, {n}, {time}, {});", name.ident));
                Ok(())
            }
            (Pat::Ident(name), expr) if name.mutability.is_none() => {
                let value = value(self.names, expr)?;
                self.line(&format!("const {real} {} = {value};", name.ident));
                Ok(())
            }
            _ => Err(Error::unknown("a binding", local)),
        }
    }

    fn repeated(&mut self, repeated: &ExprForLoop) -> Result<(), Error> {
        let unknown = || Error::unknown("a loop", repeated);
        let (range, is_backward) = match &*repeated.expr {
            Expr::MethodCall(call) if call.method == "rev" => (&*call.receiver, true),
            range => (range, false),
        };
        let range = match range {
            Expr::Paren(inner) => &*inner.expr,
            range => range,
        };
        let Expr::Range(range) = range else { return Err(unknown()) };
        let count = whole(range.end.as_deref().ok_or_else(unknown)?)?;
        self.line(&match is_backward {
            true => format!("for (int i = {count} - 1; i >= 0; i--) {{"),
            false => format!("for (int i = 0; i < {count}; i++) {{"),
        });
        self.indent += 1;
        self.block(&repeated.body, &Tail::Names)?;
        self.indent -= 1;
        self.line("}");
        Ok(())
    }

    fn assigned(&mut self, left: &Expr, right: &Expr) -> Result<(), Error> {
        let place = place(self.names, left)?;
        if let Expr::Array(array) = right {
            return self.stored(&place, array);
        }
        let value = value(self.names, right)?;
        self.line(&format!("{place} = {value};"));
        Ok(())
    }

    /// All elements of an array, or of an array of arrays.
    fn stored(&mut self, place: &str, array: &syn::ExprArray) -> Result<(), Error> {
        for (n, element) in array.elems.iter().enumerate() {
            match element {
                Expr::Array(row) => self.stored(&format!("{place}[{n}]"), row)?,
                element => {
                    let value = value(self.names, element)?;
                    self.line(&format!("{place}[{n}] = {value};"));
                }
            }
        }
        Ok(())
    }

    /// A function that this one needs: `gyro_sim::Dynamics::accelerations(self, t, y, &mut accelerations)`.
    fn solved(&mut self, call: &ExprCall) -> Result<(), Error> {
        let Expr::Path(path) = &*call.func else { return Err(Error::unknown("a call", call)) };
        let segments: Vec<String> = path.path.segments.iter().map(|s| s.ident.to_string()).collect();
        let ["gyro_sim", _, function] = segments.iter().map(String::as_str).collect::<Vec<_>>()[..] else {
            return Err(Error::unknown("a call", call));
        };
        let arguments: Result<Vec<String>, Error> = call
            .args
            .iter()
            .map(|argument| match argument {
                Expr::Reference(reference) => place(self.names, &reference.expr),
                Expr::Path(path) if path.path.is_ident("self") => Ok("m".to_owned()),
                argument => place(self.names, argument),
            })
            .collect();
        let function = self.names.own(function);
        self.line(&format!("{function}({});", arguments?.join(", ")));
        Ok(())
    }

    /// `out.copy_from_slice(&solved[..n])`.
    fn copied(&mut self, to: &Expr, from: &Expr) -> Result<(), Error> {
        let unknown = || Error::unknown("a copy", from);
        let Expr::Reference(reference) = from else { return Err(unknown()) };
        let Expr::Index(indexed) = &*reference.expr else { return Err(unknown()) };
        let Expr::Range(range) = &*indexed.index else { return Err(unknown()) };
        let n = whole(range.end.as_deref().ok_or_else(unknown)?)?;
        let (to, from) = (place(self.names, to)?, place(self.names, &indexed.expr)?);
        self.line(&format!("for (int i = 0; i < {n}; i++) {to}[i] = {from}[i];"));
        Ok(())
    }
}

/// The sizes of an array of zeros, and its initialiser.
fn zeroed(expr: &Expr) -> Result<(String, String), Error> {
    let Expr::Repeat(repeat) = expr else { return Ok((String::new(), "0".to_owned())) };
    let (sizes, zeros) = zeroed(&repeat.expr)?;
    // C has no arrays without elements.
    Ok((format!("[{}]{sizes}", whole(&repeat.len)?.max(1)), format!("{{{zeros}}}")))
}

/// A table of constants, a row to a line.
pub(crate) fn table_of(names: &Names, table: &syn::ItemConst, indent: &str) -> Result<Vec<String>, Error> {
    let mut sizes = String::new();
    let mut ty = &*table.ty;
    while let Type::Array(array) = ty {
        sizes += &format!("[{}]", whole(&array.len)?);
        ty = &array.elem;
    }
    let Expr::Array(rows) = &*table.expr else { return Err(Error::unknown("a table", table)) };
    let name = table.ident.to_string();
    let is_of_module = name.starts_with("KNOTS") || name.starts_with("PIECES");
    let name = if is_of_module { names.own(&name.to_lowercase()) } else { name };
    let mut lines = vec![format!("static const double {name}{sizes} = {{")];
    for row in &rows.elems {
        let row = match row {
            Expr::Array(row) => {
                let row: Result<Vec<String>, Error> = row.elems.iter().map(number).collect();
                format!("{{{}}}", row?.join(", "))
            }
            row => number(row)?,
        };
        lines.push(format!("{indent}{row},"));
    }
    lines.push("};".to_owned());
    Ok(lines)
}
