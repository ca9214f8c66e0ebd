//! Values of expressions, found by their ids. Expressions that are looked up together were made together, so values
//! stand in pages of neighbours: a look-up takes two reads and no hash.

use crate::expr::graph::ExprId;
use std::ops::Index;

/// Values of a page.
const PAGE: usize = 256;

/// Values of some expressions.
#[derive(Debug)]
pub struct ByExpr<T> {
    pages: Vec<Option<Box<[Option<T>]>>>,
}

impl<T> Default for ByExpr<T> {
    fn default() -> Self {
        Self { pages: Vec::new() }
    }
}

impl<T> ByExpr<T> {
    pub fn get(&self, id: ExprId) -> Option<&T> {
        let page = self.pages.get(id.place() / PAGE)?.as_ref()?;
        page[id.place() % PAGE].as_ref()
    }

    pub fn contains(&self, id: ExprId) -> bool {
        self.get(id).is_some()
    }

    pub fn insert(&mut self, id: ExprId, value: T) {
        *self.slot(id) = Some(value);
    }

    /// The value, which is the default one if there is none yet.
    pub fn or_default(&mut self, id: ExprId) -> &mut T
    where
        T: Default,
    {
        self.slot(id).get_or_insert_default()
    }

    fn slot(&mut self, id: ExprId) -> &mut Option<T> {
        let page = id.place() / PAGE;
        if page >= self.pages.len() {
            self.pages.resize_with(page + 1, || None);
        }
        let page = self.pages[page].get_or_insert_with(|| (0..PAGE).map(|_| None).collect());
        &mut page[id.place() % PAGE]
    }
}

impl<T> Index<ExprId> for ByExpr<T> {
    type Output = T;

    fn index(&self, id: ExprId) -> &T {
        self.get(id).expect("it has a value")
    }
}

impl<T> Extend<(ExprId, T)> for ByExpr<T> {
    fn extend<I: IntoIterator<Item = (ExprId, T)>>(&mut self, values: I) {
        values.into_iter().for_each(|(id, value)| self.insert(id, value));
    }
}

impl<T> FromIterator<(ExprId, T)> for ByExpr<T> {
    fn from_iter<I: IntoIterator<Item = (ExprId, T)>>(values: I) -> Self {
        let mut all = Self::default();
        all.extend(values);
        all
    }
}
