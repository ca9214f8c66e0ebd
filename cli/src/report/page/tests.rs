use super::*;

#[test]
fn a_page_reads_the_same_in_both_forms() {
    let mut page = Page::default();
    page.heading(1, "A < B");
    page.text("See [the index](index.md) and `x = [1]`, **now**.");
    page.table(&["a", "b"], vec![vec!["1 | 2".into(), "-".into()]]);
    page.figure("f.svg".into(), "Seen", "<svg></svg>\n".into());
    page.frame("other.html", "Moving");
    let (markdown, html) = (page.markdown(), page.html("T"));
    assert_eq!(
        markdown,
        "# A < B\n\nSee [the index](index.md) and `x = [1]`, **now**.\n\n| a | b |\n|---|---|\n| 1 \\| 2 | - |\n\n\
         ![Seen](images/f.svg)\n\n*Seen*\n"
    );
    for part in [
        "<h1>A &lt; B</h1>",
        "<a href=\"index.html\">the index</a> and <code>x = [1]</code>, <b>now</b>.",
        "<td>1 | 2</td>",
        "<figure>\n<svg></svg>\n<figcaption>Seen</figcaption>",
        "<iframe src=\"other.html\" title=\"Moving\"></iframe>",
    ] {
        assert!(html.contains(part), "{part} in {html}");
    }
}
