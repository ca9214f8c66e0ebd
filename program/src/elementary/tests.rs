use super::*;

#[test]
fn rows_are_those_of_their_functions() {
    for (place, function) in Function::ALL.into_iter().enumerate() {
        let Properties { name, in_c: [double, single], arity, parity, at_zero } = function.properties();
        assert_eq!(Some(place), function.place(), "{name}");
        assert_eq!(name, format!("{function:?}").to_lowercase());
        // C's name of the logarithm is another one.
        let in_c = if name == "ln" { "log" } else { name };
        assert!(double.ends_with(in_c) && single.ends_with(&format!("{in_c}f")), "{name}");
        assert!((1..=2).contains(&arity), "{name}");
        // What is odd is zero at zero.
        assert!(arity == 2 || parity != Parity::Odd || at_zero == Some(0), "{name}");
        assert_eq!(Function::named(name), Some(function));
    }
}
