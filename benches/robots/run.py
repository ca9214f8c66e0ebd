"""The robots' table: operations and times of forward dynamics beside CasADi and Pinocchio. See README.md.

    python3 benches/robots/run.py                 operations and times, as Markdown
    python3 benches/robots/run.py --operations    operations alone: a minute or two
    python3 benches/robots/run.py --only ur5,go2
"""

import argparse
import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "robots"
VENV = WORK / "venv"
PACKAGES = [
    "pin==4.1.0", "casadi==3.8.2", "example-robot-data==6.0.0", "cmeel-eigen==3.4.1", "numpy==2.4.6",
]


def install():
    """Installs the packages into a folder of their own, and goes on with their interpreter."""
    python = VENV / "bin" / "python"
    stamp = VENV / "installed"
    if not stamp.exists() or stamp.read_text() != "\n".join(PACKAGES):
        venv.create(VENV, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
        stamp.write_text("\n".join(PACKAGES))
    if Path(sys.prefix) != VENV:
        os.execv(python, [python, *sys.argv])


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--operations", action="store_true", help="count operations, compile and time nothing")
    options.add_argument("--only", metavar="ROBOT,...", help="some of the robots, by a part of their names")
    options.add_argument("--rounds", type=int, default=9, help="rounds of the times [default: 9]")
    options = options.parse_args()
    install()
    sys.dont_write_bytecode = True
    import table

    names = options.only.split(",") if options.only else [""]
    robots = [robot for robot in table.ROBOTS if any(name in robot.name for name in names)]
    table.write(WORK, robots, options.operations, options.rounds)


if __name__ == "__main__":
    main()
