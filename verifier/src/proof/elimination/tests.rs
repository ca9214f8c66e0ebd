use super::*;
use crate::field::Exact;

fn numbers(values: &[i64]) -> Vec<Exact> {
    values.iter().map(|&value| Exact::integer((), value)).collect()
}

fn first(rest: &[Exact]) -> Option<usize> {
    rest.iter().position(|x| !x.is_zero())
}

#[test]
fn vectors_are_split_into_a_combination_and_a_rest() {
    let matrix = [numbers(&[0, 2, 1, 4]), numbers(&[1, 1, 0, 3])];
    let eliminated = Eliminated::new((), &matrix, first).expect("independent rows");
    assert!(eliminated.independence(()).iter().all(Field::is_zero));
    let (rest, factors) = eliminated.split((), &numbers(&[5, -1, -3, 3]));
    assert_eq!((rest, factors), (numbers(&[0; 4]), numbers(&[-3, 5])));
    let (rest, _) = eliminated.split((), &numbers(&[5, -1, -3, 4]));
    assert!(!rest.iter().all(Field::is_zero));
}

#[test]
fn systems_are_solved() {
    let matrix = [numbers(&[0, 2, 1, 4]), numbers(&[1, 1, 0, 3]), numbers(&[1, 0, 0, 1])];
    let eliminated = Eliminated::new((), &matrix, first).expect("independent rows");
    let vector = eliminated.solution((), &numbers(&[7, -2, 5]));
    let product = |row: &Vec<Exact>| {
        row.iter().zip(&vector).fold(Exact::integer((), 0), |sum, (a, b)| sum.add(&a.mul(b)))
    };
    assert_eq!(matrix.iter().map(product).collect::<Vec<_>>(), numbers(&[7, -2, 5]));
}

#[test]
fn rows_that_depend_on_each_other_have_no_pivots() {
    let matrix = [numbers(&[1, 2, 3]), numbers(&[0, 1, 1]), numbers(&[2, 5, 7])];
    assert!(Eliminated::new((), &matrix, first).is_none());
}
