use super::*;

const CODE: &str = "
00000400 <Reset>:
 400:\tbl\t410 <main>
 404:\tb.n\t404 <Reset+0x4>

00000410 <main>:
 410:\tpush\t{r7, lr}
 412:\tbne.n\t418 <main+0x8>
 414:\tbl\t420 <deep>
 418:\tb.w\t430 <flat>

00000420 <deep>:
 420:\tbl\t430 <flat>
 424:\tbx\tlr

00000430 <flat>:
 430:\tvldr\td1, [pc, #8]\t@ 440 <flat+0x10>
 434:\tbx\tlr
";

fn sizes(deep: u64) -> BTreeMap<u64, u64> {
    BTreeMap::from([(0x410, 16), (0x420, deep), (0x430, 40)])
}

#[test]
fn the_longest_path_counts() {
    let graph = Graph::new(CODE, &sizes(100));
    assert_eq!(graph.longest("Reset"), Ok(8 + 16 + 100 + 40));
    assert_eq!(graph.longest("flat"), Ok(40));
    assert!(graph.indirect().is_empty());
}

#[test]
fn recursion_pointers_and_unknown_functions_are_found() {
    let recursive = CODE.replace("430:\tvldr\td1, [pc, #8]\t@ 440 <flat+0x10>", "430:\tbl\t410 <main>");
    assert!(Graph::new(&recursive, &sizes(0)).longest("Reset").unwrap_err().contains("is recursive"));
    let to_itself = |branch| CODE.replace("430:\tvldr\td1, [pc, #8]\t@ 440 <flat+0x10>", branch);
    let direct = to_itself("432:\tbl\t430 <flat>");
    assert!(Graph::new(&direct, &sizes(0)).longest("Reset").unwrap_err().contains("is recursive"));
    let a_loop = to_itself("432:\tbne.n\t430 <flat>");
    assert!(Graph::new(&a_loop, &sizes(0)).longest("Reset").is_ok());
    let filled = format!("{CODE} 464:\tbmi.n\t410 <main>\n");
    assert!(Graph::new(&filled, &sizes(0)).longest("Reset").is_ok());
    let pointer = CODE.replace("424:\tbx\tlr", "424:\tblx\tr3");
    assert_eq!(Graph::new(&pointer, &sizes(0)).indirect(), ["deep"]);
    assert!(Graph::new(CODE, &BTreeMap::new()).longest("main").unwrap_err().contains("not known"));
}
