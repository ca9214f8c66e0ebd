"""Makes the contenders, lets them agree, counts and times them."""

import ctypes
import os
import re
import shutil
import statistics
import subprocess
import sysconfig
from dataclasses import dataclass
from pathlib import Path

import casadi as ca
import numpy as np
import pinocchio as pin

import plain_aba
from robots import ROBOTS, Order, joints, pinocchio_model, tidy, write_list

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SITE = Path(sysconfig.get_paths()["purelib"])
PREFIX = SITE / "cmeel.prefix"
SOURCES = PREFIX / "share" / "example-robot-data" / "robots"
STATES = 50
NATIVE = ["-O3", "-march=native"]
SHARED = ["-shared", "-fPIC"]
# Pinocchio's list of joints is longer than boost's default.
LONG_LISTS = ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
CXX = ["g++", "-std=c++17", "-DNDEBUG", "-w", *LONG_LISTS, f"-I{PREFIX}/include", f"-I{PREFIX}/include/eigen3"]
AGREES = 1e-9
OTHERS = ("plain", "casadi", "native")


@dataclass
class Row:
    """What a line of the table has."""

    name: str
    rates: int
    operations: dict
    seconds: dict | None = None
    agreement: float | None = None


def call(command, **options):
    subprocess.run([str(part) for part in command], check=True, **options)


def is_older(made, *sources):
    return not made.exists() or any(source.stat().st_mtime > made.stat().st_mtime for source in sources)


def say(words):
    print(words, file=os.sys.stderr, flush=True)


def tools(work):
    """What is compiled once: our program, the clock, and both uses of Pinocchio's headers (a few minutes)."""
    call(["cargo", "build", "--quiet", "--package", "gyro-cli"], cwd=ROOT)
    model = HERE / "model.hpp"
    if is_older(work / "libclock.so", HERE / "clock.c"):
        call(["gcc", *NATIVE, *SHARED, HERE / "clock.c", "-o", work / "libclock.so"])
    if is_older(work / "casadi_aba", HERE / "casadi.cpp", model):
        say("compiling Pinocchio with CasADi")
        library = SITE / "casadi"
        call([*CXX, "-O0", f"-I{library}/include", HERE / "casadi.cpp", "-o", work / "casadi_aba", f"-L{library}",
              "-lcasadi", f"-Wl,-rpath,{library}"])


def native(work):
    if is_older(work / "libnative.so", HERE / "native.cpp", HERE / "model.hpp"):
        say("compiling Pinocchio")
        call([*CXX, *NATIVE, *SHARED, HERE / "native.cpp", "-o", work / "libnative.so"])


def generate(robot, folder):
    """Our module; returns its operations."""
    gyro = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "gyro"
    toml, module = folder / "robot.toml", folder / "src" / "robot.rs"
    module.parent.mkdir(exist_ok=True)
    floating = ["--floating"] if robot.floats else []
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    call([gyro, "import", folder / "robot.urdf", "--out", toml, "--motors", "--force", *floating], **quiet)
    call([gyro, "generate", toml, "--out", module], **quiet)
    line = re.search(r"^//! \| joint_accelerations \|.*$", module.read_text(), re.MULTILINE)[0]
    return int(line.split("|")[6])


def compile_ours(robot, folder, work):
    """The module as a shared object, for this processor."""
    text = (folder / "src" / "robot.rs").read_text()
    name = re.search(r"^pub struct (\w+)<T>", text, re.MULTILINE)[1]
    (folder / "src" / "lib.rs").write_text((HERE / "ours.rs").read_text().replace("NAME", name))
    (folder / "Cargo.toml").write_text(
        f'[package]\nname = "ours"\nedition = "2024"\n\n[lib]\ncrate-type = ["cdylib"]\n\n[workspace]\n\n'
        f'[dependencies]\ngyro-sim = {{ path = "{ROOT}/gyro-sim", default-features = false }}\n\n'
        f'[profile.release]\nopt-level = 3\ncodegen-units = 1\npanic = "abort"\n'
    )
    flags = os.environ | {"RUSTFLAGS": "-C target-cpu=native", "CARGO_TARGET_DIR": str(work / "rust")}
    call(["cargo", "build", "--quiet", "--release"], cwd=folder, env=flags)
    shutil.copy(work / "rust" / "release" / "libours.so", folder / "libours.so")


def compile_casadi(source, function, target):
    """C that CasADi wrote, behind the interface of the clock."""
    interface = f"""
void run(void *self, const double *q, const double *v, const double *tau, double *out) {{
  const double *arg[] = {{q, v, tau}};
  double *res[] = {{out}};
  {function}(arg, res, 0, 0, 0);
}}
"""
    source.write_text(source.read_text() + interface)
    call(["gcc", *NATIVE, *SHARED, source, "-o", target, "-lm"])


class Contender:
    """A function of the clock's interface with its objects and states."""

    def __init__(self, function, selfs, q, v, tau):
        self.arrays = [np.ascontiguousarray(a) for a in (q, v, tau)]
        self.function = ctypes.cast(function, ctypes.c_void_p)
        self.selfs = (ctypes.c_void_p * STATES)(*selfs)
        self.out = np.zeros_like(self.arrays[2])

    def run(self, clock, repetitions):
        pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (*self.arrays, self.out)]
        sizes = [STATES, self.arrays[0].shape[1], self.arrays[2].shape[1]]
        return clock(self.function, self.selfs, *sizes, *pointers, repetitions)


def contenders(robot, folder, work, model):
    """All contenders by name, and how our states and accelerations are Pinocchio's."""
    rng = np.random.default_rng(1)
    q = np.array([pin.integrate(model, pin.neutral(model), rng.uniform(-2, 2, model.nv)) for _ in range(STATES)])
    v, tau = rng.uniform(-2, 2, (STATES, model.nv)), rng.uniform(-5, 5, (STATES, model.nv))
    tau[:, : 6 if robot.floats else 0] = 0  # motors are on joints
    ours = ctypes.CDLL(folder / "libours.so")
    ours.ours_make.restype = ctypes.c_void_p
    places = (ctypes.c_int32 * model.nv)()
    places = places[: ours.ours_layout(places)]
    order = Order(folder / "robot.urdf", folder / "robot.toml", model)
    states = np.array([order.state(places, ours.ours_state(), *at) for at in zip(q, v)])
    inputs = np.array([order.torques(t) for t in tau])
    selfs = [ours.ours_make(i.ctypes.data_as(ctypes.c_void_p)) for i in inputs]
    pinocchio = ctypes.CDLL(work / "libnative.so")
    pinocchio.native_make.restype = ctypes.c_void_p
    made = pinocchio.native_make(str(folder / "joints.txt").encode())
    plain, unrolled = (ctypes.CDLL(folder / name).run for name in ("libplain.so", "libcasadi.so"))
    found = {
        "ours": Contender(ours.ours_run, selfs, states, v, tau),
        "plain": Contender(plain, [None] * STATES, q, v, tau),
        "casadi": Contender(unrolled, [None] * STATES, q, v, tau),
        "native": Contender(pinocchio.native_run, [made] * STATES, q, v, tau),
    }

    def in_common(name):
        out = found[name].out
        return np.array([order.accelerations(places, o, *at) for o, *at in zip(out, q, v)]) if name == "ours" else out

    data = model.createData()
    expected = np.array([pin.aba(model, data, *at) for at in zip(q, v, tau)])
    return found, in_common, expected


def timed(found, clock, rounds):
    """Seconds a call, by rounds in turns."""
    repetitions = {name: 1 for name in found}
    for name, contender in found.items():
        while (seconds := contender.run(clock, repetitions[name])) < 0.02:
            repetitions[name] *= max(2, int(0.02 / max(seconds, 1e-6)))
    times = {name: [] for name in found}
    for _ in range(rounds):
        for name, contender in found.items():
            times[name].append(contender.run(clock, repetitions[name]) / repetitions[name] / STATES)
    return times


def measure(robot, work, only_operations, rounds):
    folder = work / robot.key
    folder.mkdir(exist_ok=True)
    say(robot.name)
    tidy(SOURCES / robot.file, folder / "robot.urdf")
    model = pinocchio_model(folder / "robot.urdf", robot.floats)
    tree = joints(model)
    write_list(tree, folder / "joints.txt")
    plain = plain_aba.unrolled(tree)
    operations = {"ours": generate(robot, folder), "plain": plain_aba.operations(plain)}
    command = [work / "casadi_aba", "joints.txt", "casadi.c"]
    operations["casadi"] = int(subprocess.check_output(command, cwd=folder))
    row = Row(robot.name, model.nv, operations)
    if only_operations:
        return row
    here = os.getcwd()
    os.chdir(folder)
    plain.generate("plain.c")
    os.chdir(here)
    compile_casadi(folder / "plain.c", "plain_aba", folder / "libplain.so")
    compile_casadi(folder / "casadi.c", "pinocchio_aba", folder / "libcasadi.so")
    compile_ours(robot, folder, work)
    found, in_common, expected = contenders(robot, folder, work, model)
    clock = ctypes.CDLL(work / "libclock.so").clock_run
    clock.restype = ctypes.c_double
    clock.argtypes = [ctypes.c_void_p] * 2 + [ctypes.c_int] * 3 + [ctypes.c_void_p] * 4 + [ctypes.c_int]
    row.seconds = timed(found, clock, rounds)
    sizes = np.linalg.norm(expected, axis=1)
    errors = {name: (np.linalg.norm(in_common(name) - expected, axis=1) / sizes).max() for name in found}
    row.agreement = errors["ours"]
    disagree = {name: error for name, error in errors.items() if not error < AGREES}
    if disagree:
        raise SystemExit(f"{robot.name}: accelerations that differ from Pinocchio's: {disagree}")
    return row


def ratio(row, name):
    """The median over the rounds of another's time over ours."""
    pairs = zip(row.seconds[name], row.seconds["ours"])
    return statistics.median(other / ours for other, ours in pairs)


def share(row):
    """Our operations over plain ABA's."""
    return row.operations["ours"] / row.operations["plain"]


def lines(rows):
    counts = "| robot (rates) | ours | plain ABA | Pinocchio → CasADi | ours ÷ plain |"
    times = " ours, ns | plain ABA C ÷ ours | Pinocchio → CasADi C ÷ ours | Pinocchio C++ ÷ ours | agreement |"
    is_timed = rows[0].seconds is not None
    yield counts + (times if is_timed else "")
    yield "|---|---|---|---|---|" + ("---|---|---|---|---|" if is_timed else "")
    for row in rows:
        counts = (row.operations[name] for name in ("ours", "plain", "casadi"))
        cells = [f"{row.name} ({row.rates})", *map(str, counts), f"{share(row):.2f}"]
        if is_timed:
            ns = 1e9 * statistics.median(row.seconds["ours"])
            others = [f"{ratio(row, name):.2f}" for name in OTHERS]
            cells += [f"{ns:.0f}", *others, f"{row.agreement:.0e}"]
        yield f"| {' | '.join(cells)} |"
    summary = f"Worst: {max(map(share, rows)):.2f} of the operations of plain ABA"
    if is_timed:
        least = [min(ratio(row, name) for row in rows) for name in OTHERS]
        summary += "; the others' times are at least {:.2f}, {:.2f} and {:.2f} of ours".format(*least)
    yield ""
    yield summary + "."


def write(work, robots, only_operations, rounds):
    tools(work)
    if not only_operations:
        native(work)
    rows = [measure(robot, work, only_operations, rounds) for robot in robots]
    text = "\n".join(lines(rows)) + "\n"
    (work / "table.md").write_text(text)
    print(text)
