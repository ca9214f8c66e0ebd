#!/usr/bin/env bash
# Builds the wheel, installs it into a fresh virtual environment, and runs its tests and its examples there.
#   python/build.sh            everything below target/python
#   python/build.sh --wheel    the wheel alone: target/python/wheels
#   python/build.sh --dev      the same in the profile of development, of which a clone has most already
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$here/../target/python
python=${PYTHON:-python3}
mkdir -p "$work"

[ -x "$work/build/bin/maturin" ] || { "$python" -m venv "$work/build" && "$work/build/bin/pip" install --quiet 'maturin>=1.9,<2'; }
rm -rf "$work/wheels"
profile=release
[ "${1:-}" != --dev ] || profile=dev
(cd "$here" && "$work/build/bin/maturin" build --profile $profile --locked --quiet --interpreter "$python" --out "$work/wheels")
ls -l "$work"/wheels/*.whl
[ "${1:-}" != --wheel ] || exit 0

rm -rf "$work/fresh"
"$python" -m venv "$work/fresh"
wheel=$(echo "$work"/wheels/*.whl)
"$work/fresh/bin/pip" install --quiet "$wheel[test]"
# Not from the sources: what is imported is what was installed.
cd "$work"
export MPLBACKEND=agg
fresh/bin/python -m pytest --quiet -p no:cacheprovider "$here/tests"
for example in "$here"/examples/*.py; do
    printf -- '-- %s\n' "${example##*/}"
    fresh/bin/python "$example"
done
