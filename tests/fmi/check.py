"""Exported units of FMI 3.0, tried by importers that others wrote: FMPy and ecospy.

    python tests/fmi/check.py PROGRAM      the program `gyro`; see .ci/fmu for what is to be installed

Of each mechanism: the archive is valid, its sources compile without a warning, and both kinds follow the
runtime-assembled model, which shares no code with them; derivatives are those of differences; a state that was kept
gives the same bits again; what makes no sense is refused.
"""

import csv
import ctypes
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import ecospy
import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.validation import validate_fmu

ROOT = Path(__file__).resolve().parents[2]
# Model file, or what `new` makes it of; integrator of co-simulation; what of a hundredth of a second an importer's solver
# can take at once; parameters and inputs that are set before a run.
MECHANISMS = [
    ("models/gyroscope.toml", "dop853", 1.0, {}),
    ("models/driven-gyroscope.toml", "dop853", 1.0, {}),
    ("models/four-bar.toml", "dop853", 1.0, {}),
    ("cart", "dop853", 1.0, {"stiffness": 55.0, "length": 0.45, "push": 1.5}),
    ("arm", "dop853", 1.0, {"payload": 0.35, "shoulder_torque": -4.0, "elbow_torque": 0.75}),
    ("examples/arm/arm.toml", "dop853", 1.0, {"motor": -2.0}),
    ("models/gyroscope-stiff.toml", "rodas4", 0.01, {}),
]
# Laws, states, curves and constraints: each in co-simulation at a fine tolerance, against `simulate`.
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
LAWS = sorted([*(EXAMPLES / "laws").glob("*.toml"), *(EXAMPLES / "rolling").glob("*.toml")])
END, SAMPLE = 1.0, 0.01


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, f"{command}: {done.stderr}"
    return done.stdout


def reference(gyro, model, settings, folder):
    """The table of a run of the runtime-assembled model, in maximal coordinates; settings are options with their values."""
    options = "--engine assembled --integrator dop853 --tolerance 1e-11 --budget 100000000".split()
    run(gyro, "simulate", model, *options, *settings, "--t-end", END, "--every", SAMPLE, "--out", folder)
    (table,) = folder.glob("*.csv")
    with table.open() as lines:
        rows = list(csv.reader(lines))
    names = [name.rsplit(" [", 1)[0] for name in rows[0]]
    return dict(zip(names, np.array(rows[1:], dtype=float).T))


def difference(found, expected, names):
    """The largest difference over the largest magnitude of each variable."""
    worst = 0.0
    for name in names:
        scale = max(1.0, np.abs(expected[name]).max())
        worst = max(worst, np.abs(found[name] - expected[name]).max() / scale)
    return worst


def compiles(archive, folder):
    """The sources alone, as the archive says that they are to be compiled."""
    with zipfile.ZipFile(archive) as content:
        content.extractall(folder)
    build = ElementTree.parse(folder / "sources/buildDescription.xml").getroot().find("BuildConfiguration")
    files = build.find("SourceFileSet")
    sources = [folder / "sources" / file.get("name") for file in files]
    warnings = ["-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror"]
    options = files.get("compilerOptions").split()
    run("cc", *options, *warnings, "-fPIC", "-shared", "-o", folder / "again.so", *sources, "-lm")


def instance(kind, archive, description, folder):
    part = description.modelExchange if kind is FMU3Model else description.coSimulation
    unit = kind(
        guid=description.instantiationToken,
        unzipDirectory=folder,
        modelIdentifier=part.modelIdentifier,
        instanceName="unit",
    )
    unit.instantiate()
    unit.enterInitializationMode(startTime=0.0)
    unit.exitInitializationMode()
    return unit


def derivatives(archive, description, folder):
    """Directional and adjoint derivatives against central differences."""
    unit = instance(FMU3Model, archive, description, folder)
    by_name = {variable.name: variable for variable in description.modelVariables}
    states = [variable.derivative for variable in by_name.values() if variable.derivative is not None]
    unknowns = [variable for variable in by_name.values() if variable.derivative is not None]
    moved = [variable.valueReference for variable in states]
    unknowns += [v for v in by_name.values() if v.causality == "output" and v.valueReference not in moved]
    unknowns = [variable.valueReference for variable in unknowns]
    inputs = [v.valueReference for v in by_name.values() if v.causality == "input"]
    unit.enterContinuousTimeMode()
    count = len(moved)
    start = (ctypes.c_double * count)()
    unit.getContinuousStates(start, count)
    start = np.array(start) + 0.01 * np.cos(np.arange(count))

    def value(at, pressed):
        unit.setContinuousStates((ctypes.c_double * count)(*at), count)
        if inputs:
            unit.setFloat64(inputs, pressed)
        return np.array(unit.getFloat64(unknowns))

    pressed = 0.3 * np.ones(len(inputs))
    value(start, pressed)
    knowns = moved + inputs
    matrix, slopes = [], []
    for k, known in enumerate(knowns):
        exact = np.array(unit.getDirectionalDerivative(unknowns, [known], [1.0]))
        matrix.append(exact)
        h = 1e-6
        at, also = np.eye(len(knowns))[k, :count] * h, np.eye(len(knowns))[k, count:] * h
        slopes.append((value(start + at, pressed + also) - value(start - at, pressed - also)) / (2 * h))
        value(start, pressed)
    matrix, slopes = np.array(matrix), np.array(slopes)
    told = {of.variable.valueReference: of.dependencies for of in description.outputs + description.derivatives}
    told = np.array([[known in [v.valueReference for v in told[unknown]] for unknown in unknowns] for known in knowns])
    assert not matrix[~told].any(), "a slope by what an unknown is said not to depend on"
    assert told.mean() < 0.95, "all is said to depend on all"
    # Differences are as inexact as the largest slope of an unknown makes them.
    worst = (np.abs(matrix - slopes) / np.maximum(1.0, np.abs(matrix).max(axis=0))).max()
    seed = np.cos(np.arange(len(unknowns)))
    adjoint = np.array(unit.getAdjointDerivative(unknowns, knowns, list(seed), nSensitivity=len(knowns)))
    expected = matrix @ seed
    assert np.allclose(adjoint, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
    unit.terminate()
    unit.freeInstance()
    return worst


def keeps_its_state(archive, description, folder):
    """A state that was kept and brought back, also as bytes, goes on with the same bits."""
    unit = instance(FMU3Slave, archive, description, folder)
    names = [variable.valueReference for variable in description.modelVariables if variable.causality == "output"]
    for k in range(10):
        unit.doStep(k * SAMPLE, SAMPLE)
    kept = unit.getFMUState()
    content = unit.serializeFMUState(kept)
    ends = []
    for again in range(3):
        for k in range(10, 30):
            unit.doStep(k * SAMPLE, SAMPLE)
        ends.append(list(unit.getFloat64(names)))
        unit.setFMUState(kept if again == 0 else unit.deserializeFMUState(content))
    unit.freeFMUState(kept)
    assert ends[0] == ends[1] == ends[2], "a state that was kept gives other numbers"
    unit.terminate()
    unit.freeInstance()


def refuses(archive, description, folder):
    """Calls that make no sense are errors, and the unit is as it was."""
    def fails(what, call):
        try:
            call()
        except Exception:
            return
        raise AssertionError(f"{what} was not refused")

    unit = instance(FMU3Slave, archive, description, folder)
    state = next(v.derivative for v in description.modelVariables if v.derivative is not None).valueReference
    before = unit.getFloat64([state])
    fails("a number that is not finite", lambda: unit.setFloat64([state], [float("nan")]))
    fails("a variable that is not there", lambda: unit.getFloat64([10_000]))
    fails("setting the time", lambda: unit.setFloat64([0], [1.0]))
    fails("a step of no length", lambda: unit.doStep(0.0, 0.0))
    fails("a step from elsewhere", lambda: unit.doStep(3.0, SAMPLE))
    fails("a step that is not finite", lambda: unit.doStep(0.0, float("inf")))
    fails("other types", lambda: unit.getInt32([state]))
    fails("continuous time in co-simulation", lambda: unit.enterContinuousTimeMode())
    assert list(unit.getFloat64([state])) == list(before)
    unit.doStep(0.0, SAMPLE)
    unit.terminate()
    fails("a step after the end", lambda: unit.doStep(SAMPLE, SAMPLE))
    unit.freeInstance()


def cosimulated(archive, values, expected, names):
    """A second importer."""
    structure = ecospy.EcosSimulationStructure()
    structure.add_model("unit", str(archive))
    structure.add_parameter_set("set", {f"unit::{name}": value for name, value in values.items()})
    with ecospy.EcosSimulation(structure=structure, step_size=SAMPLE) as simulation:
        simulation.init(parameter_set="set")
        simulation.step(round(END / SAMPLE))
        assert abs(simulation.get_time() - END) < SAMPLE / 2
        worst = 0.0
        for name in names:
            value = simulation.get_real(f"unit::{name}")
            scale = max(1.0, np.abs(expected[name]).max())
            worst = max(worst, abs(value - expected[name][-1]) / scale)
        simulation.terminate()
    return worst


def check(gyro, model, integrator, share, values, folder):
    if not model.endswith(".toml"):
        made = folder / f"{model}.toml"
        run(gyro, "new", model, "--template", model, "--out", made)
        model = made
    archive = folder / f"{Path(model).stem}.fmu"
    run(gyro, "export", "fmu", model, "--out", archive, "--integrator", integrator)
    content = archive.read_bytes()
    archive.unlink()
    run(gyro, "export", "fmu", model, "--out", archive, "--integrator", integrator)
    assert archive.read_bytes() == content, "two exports differ"
    problems = validate_fmu(str(archive))
    assert not problems, problems
    unpacked = folder / "unpacked"
    compiles(archive, unpacked)

    description = fmpy.read_model_description(str(archive))
    option = {v.name: "--input" if v.causality == "input" else "--set" for v in description.modelVariables}
    settings = [word for name, value in values.items() for word in (option[name], f"{name}={value}")]
    expected = reference(gyro, model, settings, folder / "reference")
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]
    names = [name for name in outputs if name in expected]
    assert len(names) * 2 >= len(outputs), f"{names} of {outputs}"
    figures = []
    for kind, every in (("ModelExchange", round(1 / share)), ("CoSimulation", 1)):
        found = fmpy.simulate_fmu(
            str(archive), fmi_type=kind, stop_time=END, output_interval=SAMPLE / every, relative_tolerance=1e-9,
            output=names, start_values=values,
        )
        # An event has rows of its own: of each time the last one counts.
        at = np.searchsorted(found["time"], expected["t"] + 1e-9) - 1
        assert np.abs(found["time"][at] - expected["t"]).max() < 1e-9
        found = {name: found[name][at] for name in names}
        figures.append(difference(found, expected, names))
    figures.append(cosimulated(archive, values, expected, names))
    figures.append(derivatives(archive, description, str(unpacked)))
    keeps_its_state(archive, description, str(unpacked))
    refuses(archive, description, str(unpacked))
    exchange, steps, second, slopes = figures
    print(f"{Path(model).name}: model exchange {exchange:.1e}, co-simulation {steps:.1e}, ecospy {second:.1e}, slopes {slopes:.1e}")
    assert exchange < 1e-5 and steps < 1e-7 and second < 1e-7 and slopes < 1e-6, figures


def follows(gyro, model, folder):
    """The unit of a model gives the table of `simulate` of all its states, the work among them, and outputs, to 1e-9."""
    archive = folder / f"{model.stem}.fmu"
    run(gyro, "export", "fmu", model, "--count-work", "--out", archive)
    assert not validate_fmu(str(archive))
    description = fmpy.read_model_description(str(archive))
    end = float(description.defaultExperiment.stopTime)
    every = end / 100
    options = ["--integrator", "dop853", "--tolerance", "1e-12", "--every", repr(every), "--out", folder / "run"]
    run(gyro, "simulate", model, *options)
    with (folder / "run" / f"{model.stem}.csv").open() as lines:
        rows = list(csv.reader(lines))
    titles = [title.rsplit(" [", 1)[0] for title in rows[0]]
    expected = dict(zip(titles, np.array(rows[1:], dtype=float).T))
    outputs = [variable.name for variable in description.modelVariables if variable.causality == "output"]
    assert not [name for name in outputs if name not in expected], outputs
    found = fmpy.simulate_fmu(
        str(archive), fmi_type="CoSimulation", stop_time=end, output_interval=every, relative_tolerance=1e-13, output=outputs
    )
    assert np.abs(found["time"] - expected["t"]).max() < 1e-9 * end
    worst = difference(found, expected, outputs)
    print(f"{model.name}: {worst:.1e} in {len(outputs)} outputs")
    assert worst < 1e-9, worst


def main():
    gyro = Path(sys.argv[1]).resolve()
    for model, integrator, share, values in MECHANISMS:
        with tempfile.TemporaryDirectory() as folder:
            check(gyro, model, integrator, share, values, Path(folder))
    for model in LAWS:
        with tempfile.TemporaryDirectory() as folder:
            follows(gyro, model, Path(folder))
    print("all well")


if __name__ == "__main__":
    main()
