"""The document's own code, as it stands there."""

import re

from conftest import ROOT


def test_the_code_of_the_document_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    text = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    assert len(blocks) > 5
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert names["many"].shape == (10_000, 3) and names["states"].shape == (4096, 6)
    assert abs(names["state"][0]) < 10
