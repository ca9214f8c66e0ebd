use super::*;

#[test]
fn tables_have_two_columns_and_perhaps_a_header() {
    let expected = vec![[0.0, 1.5], [0.25, -2e-3]];
    for text in ["0,1.5\n0.25,-2e-3\n", "t [s],torque [N*m]\n# from the bench\n 0 , 1.5\n\n.25,-0.002"] {
        assert_eq!(rows(text).unwrap(), expected, "{text}");
    }
}

#[test]
fn bad_tables_are_refused_with_their_line() {
    for (text, message) in [
        ("", "it has no rows"),
        ("t,value\n", "it has no rows"),
        ("t,value\n0,1\n1,2,3\n", "line 3: found 3 columns: two were expected"),
        ("0;1\n", "it has no rows"),
        ("t;value\n0;1\n", "line 2: found 1 column: two were expected"),
        ("0,1\n1,high\n", "line 2: found `high` in place of a finite number"),
        ("0,1\ninf,1\n", "line 2: found `inf` in place of a finite number"),
        ("0,1\n\n1,high\n", "line 3: found `high`"),
        ("0,1\n# held\n0,2\n", "line 3: the time 0.0 is not after 0.0: times must increase"),
    ] {
        let found = rows(text).unwrap_err();
        assert!(found.starts_with(message), "{text:?}: {found}");
    }
}
