use super::*;

#[test]
fn arrays_are_read_number_for_number_and_emptied() {
    let text = "/// Times.\nconst KNOTS_0: [f64; 3] = [0.0, -1e-3,\n    2.5,\n];\nconst B: [f64; 1] = [1.0];\n\
                const PIECES_0: [[f64; 2]; 1] = [[1.0, 2.0]]; fn f() {}\n";
    let (found, emptied) = arrays(text).unwrap();
    let expected = [
        Array { name: "KNOTS_0", line: 2, rows: vec![vec![0.0], vec![-1e-3], vec![2.5]] },
        Array { name: "PIECES_0", line: 6, rows: vec![vec![1.0, 2.0]] },
    ];
    assert_eq!(found, expected);
    let rest = "/// Times.\nconst KNOTS_0: [f64; 3] = [\n\n];\nconst B: [f64; 1] = [1.0];\n\
                const PIECES_0: [[f64; 2]; 1] = []; fn f() {}\n";
    assert_eq!(emptied, rest);
}

#[test]
fn what_is_no_decimal_is_refused() {
    for element in [
        "1",
        "--1.0",
        "+1.0",
        "1.0 + 2.0",
        "1.0f32",
        "x",
        "[[1.0]]",
        "",
        "1.0 1.0",
        "inf",
        "1.0 /* */",
        "1e999",
    ] {
        let text = format!("const KNOTS_0: [f64; 3] = [0.5, {element}, 1.5];");
        assert!(arrays(&text).is_err(), "{element}");
    }
    assert!(arrays("const KNOTS_0: [f64; 3] = [0.5, 1.5").is_err());
}
