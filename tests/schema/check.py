"""The JSON schema of model files, read by a validator that others wrote: it admits every good model file, random ones too, and
refuses what it can know to be wrong.

    check.py PAGES    PAGES: the example `pages` of tests/pages, which prints random model files
"""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

from jsonschema.validators import validator_for

ROOT = Path(__file__).parent / "../.."
RANDOM = 200
GOOD = ["models", "tests/models", "embedded/models", "examples"]
# Mistakes in keys, types and words; the others are the reader's to find.
REFUSED = [
    "empty-page",
    "joint-kind-keys",
    "unknown-keys",
    "misplaced-keys",
    "wrong-types",
    "names",
    "tables",
    "point-masses",
    "motions",
]


def files(folder):
    return [(path.stem, path.read_text()) for path in sorted((ROOT / folder).rglob("*.toml"))]


def parsed(text):
    """The model file, or None if it is not TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None


def random_page(pages, seed):
    command = [pages, "--print", "--seed", str(seed), "--count", "1"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main(pages):
    schema = json.loads((ROOT / "schema/model.schema.json").read_text())
    kind = validator_for(schema)
    kind.check_schema(schema)
    validator = kind(schema)

    good = [page for folder in GOOD for page in files(folder)]
    good += [(name, text.replace('"NAME"', '"name"')) for name, text in files("cli/templates")]
    good += [(f"random {seed}", random_page(pages, seed)) for seed in range(RANDOM)]
    mistakes = [
        f"{name}: {error.message[:200]}" for name, text in good for error in validator.iter_errors(tomllib.loads(text))
    ]
    assert not mistakes, "\n".join(mistakes)
    assert len(good) > 250, len(good)

    bad = {name: parsed(text) for name, text in files("tests/bad-models")}
    refused = [name for name, page in bad.items() if page is not None and not validator.is_valid(page)]
    missed = [name for name in REFUSED if name not in refused]
    assert not missed, f"{missed} of {refused}"
    assert len(refused) >= 25, f"{len(refused)} of {len(bad)}: {refused}"
    print(f"{len(good)} good model files are admitted, {len(refused)} bad ones refused")


main(*sys.argv[1:])
