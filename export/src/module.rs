//! A generated module as it is read back from its text: what stands in it, without what its functions compute.

use crate::Error;
use gyro_program::{Buffer, Group};
use quote::ToTokens;
use std::collections::BTreeMap;
use syn::{Expr, Fields, FnArg, ImplItem, ImplItemFn, Item, ItemImpl, ItemMod, Lit, Stmt, Type, UnOp};

/// What a module has.
#[derive(Default)]
pub(crate) struct Module {
    /// Sizes of the associated types: `State`, `Joints` and so on.
    pub(crate) sizes: BTreeMap<String, usize>,
    /// Functions that compute something, in the order of the text.
    pub(crate) functions: Vec<ImplItemFn>,
    /// Knots and pieces of tables.
    pub(crate) tables: Vec<syn::ItemConst>,
    /// Names of places: `["joint", "CRANK"]` and the place.
    pub(crate) indices: Vec<(Vec<String>, usize)>,
    /// What stands in a joint state.
    pub(crate) places: Vec<Place>,
    /// The rows of Φ that are the closure.
    pub(crate) closure_rows: Vec<usize>,
    /// Numbers that depend on parameters alone.
    pub(crate) n_derived: usize,
    /// Non-zeros of sparse matrices, by the name of the function that lists them.
    pub(crate) patterns: Vec<(String, Vec<[usize; 2]>)>,
    /// The order of rates in the factor of the mass matrix.
    pub(crate) mass_order: Vec<usize>,
}

/// Some coordinates of a joint state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Scalar { joint: usize, coordinate: usize },
    Orientation,
    Body,
    Turn { joint: usize, coordinate: usize },
}

impl Module {
    pub(crate) fn read(text: &str) -> Result<Self, Error> {
        let file = syn::parse_file(text).map_err(|e| Error(format!("the module cannot be read: {e}")))?;
        let mut module = Self::default();
        for item in file.items {
            match item {
                Item::Impl(item) => module.implementation(item)?,
                Item::Const(item) => module.tables.push(item),
                Item::Mod(item) if item.ident == "index" => module.index(&item, &[])?,
                Item::Struct(item) => {
                    if let Fields::Named(fields) = &item.fields {
                        for field in &fields.named {
                            if let (Some("derived"), Type::Array(array)) =
                                (field.ident.as_ref().map(ToString::to_string).as_deref(), &field.ty)
                            {
                                module.n_derived = whole(&array.len)?;
                            }
                        }
                    }
                }
                _ => {}
            }
        }
        Ok(module)
    }

    /// The size of an associated type; zero where the module has none.
    pub(crate) fn size(&self, name: &str) -> usize {
        self.sizes.get(name).copied().unwrap_or(0)
    }

    /// Whether it has a function that computes something.
    pub(crate) fn computes(&self, name: &str) -> bool {
        self.functions.iter().any(|function| function.sig.ident == name)
    }

    /// The numbers that `joint_start` returns: constants, each.
    pub(crate) fn joint_start(&self) -> Result<Vec<f64>, Error> {
        let function = self.functions.iter().find(|function| function.sig.ident == "joint_start");
        let last = function.and_then(|function| function.block.stmts.last());
        let Some(Stmt::Expr(Expr::Array(array), None)) = last else { return Ok(Vec::new()) };
        array.elems.iter().map(constant).collect()
    }

    fn implementation(&mut self, item: ItemImpl) -> Result<(), Error> {
        let of_trait = item.trait_.as_ref().and_then(|(path, _)| path.segments.last());
        let of_trait = of_trait.map(|segment| segment.ident.to_string());
        if of_trait.as_deref() == Some("Default") || is_of_parameters(&item) {
            return Ok(());
        }
        let of_partition = of_trait.as_deref() == Some("Partition");
        for item in item.items {
            match item {
                ImplItem::Type(item) if matches!(item.ty, Type::Array(_)) => {
                    let Type::Array(array) = &item.ty else { continue };
                    self.sizes.insert(item.ident.to_string(), whole(&array.len)?);
                }
                ImplItem::Fn(function) if !of_partition => self.function(function)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn function(&mut self, function: ImplItemFn) -> Result<(), Error> {
        let name = function.sig.ident.to_string();
        match name.as_str() {
            "description" | "frame_names" | "new" | "parameters" | "set_parameters" | "set_parameter"
            | "set_input" => {}
            "joint_layout" => self.layout(&function)?,
            "mass_order" => self.mass_order = numbers(&function)?,
            name if name.ends_with("_pattern") => {
                let numbers = numbers(&function)?;
                let pairs = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
                self.patterns.push((name.to_owned(), pairs));
            }
            // Buffers are the caller's.
            name if Group::all().flat_map(Buffer::of).any(|buffer| buffer.function == name) => {}
            _ => self.functions.push(function),
        }
        Ok(())
    }

    fn layout(&mut self, function: &ImplItemFn) -> Result<(), Error> {
        struct Found<'m>(&'m mut Module, Result<(), Error>);
        impl<'a> syn::visit::Visit<'a> for Found<'_> {
            fn visit_expr_struct(&mut self, literal: &'a syn::ExprStruct) {
                let name = literal.path.segments.last().map(|segment| segment.ident.to_string());
                let field = |name: &str| {
                    let found =
                        literal.fields.iter().find(|f| f.member.to_token_stream().to_string() == name);
                    found.map_or(Ok(0), |field| whole(&field.expr))
                };
                let place = match name.as_deref() {
                    Some(kind @ ("Scalar" | "Turn")) => field("joint").and_then(|joint| {
                        field("coordinate").map(|coordinate| match kind {
                            "Turn" => Place::Turn { joint, coordinate },
                            _ => Place::Scalar { joint, coordinate },
                        })
                    }),
                    Some("Orientation") => Ok(Place::Orientation),
                    Some("Body") => Ok(Place::Body),
                    _ => {
                        let rows = literal
                            .fields
                            .iter()
                            .find(|f| f.member.to_token_stream().to_string() == "closure_rows");
                        if let Some(rows) = rows {
                            let mut collected = Numbers::default();
                            syn::visit::Visit::visit_expr(&mut collected, &rows.expr);
                            self.0.closure_rows = collected.0;
                        }
                        syn::visit::visit_expr_struct(self, literal);
                        return;
                    }
                };
                match place {
                    Ok(place) => self.0.places.push(place),
                    Err(error) => self.1 = Err(error),
                }
            }
        }
        let mut found = Found(self, Ok(()));
        syn::visit::Visit::visit_block(&mut found, &function.block);
        found.1
    }

    fn index(&mut self, item: &ItemMod, above: &[String]) -> Result<(), Error> {
        for item in item.content.iter().flat_map(|(_, items)| items) {
            match item {
                Item::Const(constant) => {
                    let path = [above, &[constant.ident.to_string()]].concat();
                    self.indices.push((path, whole(&constant.expr)?));
                }
                Item::Mod(inner) => {
                    let above = [above, &[inner.ident.to_string()]].concat();
                    self.index(inner, &above)?;
                }
                _ => {}
            }
        }
        Ok(())
    }
}

fn is_of_parameters(item: &ItemImpl) -> bool {
    item.self_ty.to_token_stream().to_string().starts_with("Parameters <")
}

/// Arguments of a function but for itself: their names and types.
pub(crate) fn arguments(function: &ImplItemFn) -> impl Iterator<Item = (String, &Type)> {
    function.sig.inputs.iter().filter_map(|argument| match argument {
        FnArg::Typed(argument) => Some((argument.pat.to_token_stream().to_string(), &*argument.ty)),
        FnArg::Receiver(_) => None,
    })
}

/// A whole number that is written as a literal.
pub(crate) fn whole(expr: &Expr) -> Result<usize, Error> {
    if let Expr::Lit(literal) = expr
        && let Lit::Int(number) = &literal.lit
        && let Ok(number) = number.base10_parse()
    {
        return Ok(number);
    }
    Err(Error::unknown("a whole number", expr))
}

/// A number as it is written: `k(1.5)`, `k(-1.5)`.
fn constant(expr: &Expr) -> Result<f64, Error> {
    match expr {
        Expr::Call(call) if call.args.len() == 1 => constant(&call.args[0]),
        Expr::Unary(minus) if matches!(minus.op, UnOp::Neg(_)) => Ok(-constant(&minus.expr)?),
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(number) => number.base10_parse().map_err(|_| Error::unknown("a number", expr)),
            _ => Err(Error::unknown("a number", expr)),
        },
        _ => Err(Error::unknown("a number", expr)),
    }
}

#[derive(Default)]
struct Numbers(Vec<usize>);

impl<'a> syn::visit::Visit<'a> for Numbers {
    fn visit_lit_int(&mut self, number: &'a syn::LitInt) {
        self.0.extend(number.base10_parse::<usize>().ok());
    }
}

/// All whole numbers of a function.
fn numbers(function: &ImplItemFn) -> Result<Vec<usize>, Error> {
    let mut found = Numbers::default();
    syn::visit::Visit::visit_block(&mut found, &function.block);
    Ok(found.0)
}
