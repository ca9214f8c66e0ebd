use super::*;

fn x() -> Number {
    Number::Parameter { index: 0, negated: false }
}

fn at(number: &Number, x: i64) -> Option<Rational> {
    number.evaluate(&|_| Rational::from_integer(x.into()), &|_| Rational::one())
}

#[test]
fn what_is_known_is_folded() {
    let of = Number::integer;
    assert_eq!(of(2) + of(3), of(5));
    assert_eq!(of(1).over(of(4)).and_then(|quarter| quarter.over(of(2))), of(1).over(of(8)));
    assert_eq!((x() + of(0), x() * of(1), x() * of(0)), (x(), x(), of(0)));
    assert_eq!((-x(), of(-1) * x()), (Number::Parameter { index: 0, negated: true }, -x()));
    assert_eq!((x().power(0), x().power(1), of(2).power(-3)), (Some(of(1)), Some(x()), of(1).over(of(8))));
    assert_eq!((x().over(of(0)), of(0).power(-1), of(0).over(x())), (None, None, Some(of(0))));
}

/// (x² − 3) / (x − 2), with its weight: four names and numbers, one of them squared.
#[test]
fn a_computation_is_evaluated_where_it_is_defined() {
    let top = x().power(2).expect("positive") - Number::integer(3);
    let number = top.over(x() - Number::integer(2)).expect("not by zero");
    assert_eq!(at(&number, 5), Some(Rational::new(22.into(), 3.into())));
    assert_eq!(at(&number, 2), None);
    assert_eq!((number.weight(), number.divisors().len(), number.leaves().len()), (5, 1, 4));
    assert!(number.has_parameters() && !Number::integer(1).has_parameters());
}
