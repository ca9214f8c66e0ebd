"""Loading and running."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import MODELS, PENDULUM, ROOT

import gyro_sim as gyro


def test_the_papers_second(gimbal):
    run = gimbal.simulate(1.0, tolerance=1e-9, coordinates="joint")
    assert run.t[0] == 0 and run.t[-1] == 1
    assert run["alpha"].shape == run.t.shape and run["alpha"].dtype == np.float64
    # The closed form: precession at m g d / H = 0.1 rad/s.
    assert abs(run["alpha"][-1] - 0.1) < 2e-3
    assert run.rate("alpha").shape == run.t.shape
    assert run.units["alpha rate"] == "rad/s"
    assert run.summary["integrator"] == "dop853" and run.summary["coordinates"] == "joint"
    assert "gyroscope" in repr(run) and "1e-09" in repr(run)


def test_a_verdict_says_how_good_a_run_is(gimbal):
    verdict = gimbal.simulate(0.1, tolerance=1e-9).verdict
    assert verdict.grade == "good"
    assert set(verdict.errors) == {"alpha", "beta", "phi"}
    assert verdict.relative_error < 1e-6
    assert "good" in str(verdict)


def test_outputs_and_inputs(pendulum):
    held = 9.81 * 0.5  # N m: what holds a rod of 1 kg level
    run = pendulum.simulate(0.1, step=1e-3, inputs={"torque": held})
    assert np.allclose(run["hinge"], np.pi / 2, atol=1e-12)
    assert np.allclose(run["torque"], held)
    assert run.outputs and all(name.startswith("hinge_load") for name in run.outputs)
    table = pendulum.simulate(0.2, step=1e-3, inputs={"torque": [[0, 0], [0.2, held]]})
    assert np.allclose(table["torque"], held * table.t / 0.2)
    assert table["hinge"][-1] < np.pi / 2


def test_parameters_are_set_and_kept(pendulum):
    before = pendulum.simulate(0.5, tolerance=1e-9)["hinge"][-1]
    pendulum.set(length=0.4)
    assert pendulum.parameters == {"length": 0.4}
    after = pendulum.simulate(0.5, tolerance=1e-9)["hinge"][-1]
    assert before != after
    again = pickle.loads(pickle.dumps(pendulum))
    assert again.parameters == {"length": 0.4} and again.name == "pendulum"
    assert pickle.loads(pickle.dumps(gyro.loads(PENDULUM)))._set_parameters == {}
    assert again.simulate(0.5, tolerance=1e-9)["hinge"][-1] == after


def test_mistakes_carry_file_line_and_cure():
    wrong = PENDULUM.replace('kind = "revolute"', 'kind = "revolut"')
    with pytest.raises(gyro.ModelError) as caught:
        gyro.loads(wrong, "wrong.toml")
    error = caught.value
    assert isinstance(error, ValueError) and error.file == "wrong.toml"
    assert wrong.splitlines()[error.line - 1] == 'kind = "revolut"'
    assert "revolute" in error.cure
    assert f"wrong.toml:{error.line}" in str(error)
    assert pickle.loads(pickle.dumps(error)).mistakes == error.mistakes


def test_what_cannot_be_done_is_refused_in_the_words_of_python(pendulum):
    for arguments, words in [
        ({"step": -1}, "a positive number of seconds"),
        ({"tolerance": 1e-9, "integrator": "rk4"}, "rk4 has no error estimate: give it a step"),
        ({"step": 1e-3, "tolerance": 1e-9}, "cannot be used with"),
        ({"integrator": "euler"}, "rk4, tsit5, dop853 or rodas4"),
        ({"inputs": {"torqe": 1}}, "torque"),
        ({"inputs": {"torque": [[0, 1], [0, 2]]}}, "times must increase"),
        ({"inputs": {"torque": [1, 2, 3]}}, "rows (time, value)"),
    ]:
        with pytest.raises(gyro.RequestError) as caught:
            pendulum.simulate(1.0, **arguments)
        assert words in str(caught.value), caught.value
        assert "--" not in str(caught.value), caught.value
    with pytest.raises(gyro.RequestError, match="length"):
        pendulum.set(lenght=0.4)
    with pytest.raises(gyro.RequestError, match="finite"):
        pendulum.set(length=float("nan"))
    with pytest.raises(KeyError, match="hinge"):
        pendulum.simulate(0.1, tolerance=1e-6)["hing"]


def test_formulas_of_runs(pendulum):
    height = pendulum.formula("-length*cos(hinge) + 0.5*t")
    run = pendulum.simulate(1.0, tolerance=1e-9)
    expected = -pendulum.parameters["length"] * np.cos(run["hinge"]) + 0.5 * run.t
    assert np.abs(height(run) - expected).max() < 1e-15
    assert np.array_equal(run.formula("hinge rate"), run.rate("hinge"))
    with pytest.raises(gyro.RequestError, match="hinge"):
        pendulum.formula("cos(hing)")
    with pytest.raises(gyro.RequestError):
        run.formula("1 +")


def test_a_run_that_fails_says_where(pendulum):
    with pytest.raises(gyro.RunError, match="t = "):
        pendulum.simulate(10.0, tolerance=1e-9, budget=3)


def test_redundant_rows_are_warned_of():
    with pytest.warns(gyro.RunWarning, match="are dropped"):
        gyro.load(MODELS / "slider-crank.toml")


def test_ctrl_c_stops_a_run(pendulum):
    # What a shell starts in the background ignores the signal.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    began = time.monotonic()
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        pendulum.simulate(1e7, step=1e-4, every=1e6, budget=10**12)
    assert time.monotonic() - began < 5


@pytest.mark.filterwarnings("ignore::gyro_sim.RunWarning")
def test_ctrl_c_stops_while_equations_are_derived():
    signal.signal(signal.SIGINT, signal.default_int_handler)
    platform = gyro.load(MODELS / "stewart-platform.toml")
    threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        platform.verify()
    assert time.monotonic() - began < 5


def test_other_threads_go_on_during_a_run(pendulum):
    count, done = 0, threading.Event()
    pendulum.simulate(0.1, step=1e-3)

    def run():
        pendulum.simulate(200.0, step=1e-4, every=100)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        count += 1
        time.sleep(1e-3)
    thread.join()
    assert count > 20


def test_robots_are_read(tmp_path):
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(
        """<robot name="arm"><link name="base"/>
        <link name="upper"><inertial><origin xyz="0 0 -0.5"/><mass value="1"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
    )
    with pytest.warns(gyro.RunWarning, match="limits makes stops") as told:
        arm = gyro.from_urdf(urdf, motors=True)
    assert len(told) == 1 and arm.source[0].startswith("# Written by gyro_sim.from_urdf from arm.urdf")
    assert arm.joints == ["shoulder"] and list(arm.inputs) == ["shoulder_motor"]
    accelerations = arm.joint_accelerations([0.0], [0.0], [1.0])
    assert np.allclose(accelerations, 1 / (0.1 + 0.25))


def test_frames_and_plots(gimbal):
    pandas = pytest.importorskip("pandas")
    run = gimbal.simulate(0.1, tolerance=1e-9)
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t"
    assert (frame["alpha"].to_numpy() == run["alpha"]).all() and frame.attrs["units"]["alpha"] == "rad"
    pytest.importorskip("matplotlib").use("agg")
    figure = run.plot("alpha", "beta rate")
    assert [axis.get_ylabel() for axis in figure.axes] == ["rad", "rad/s"]
    assert len(run.plot().axes[0].lines) == 3


WITHOUT_RUST = """
import shutil, sys, warnings
import numpy as np
import gyro_sim as gyro
warnings.simplefilter("ignore", gyro.RunWarning)
assert not shutil.which("cargo") and not shutil.which("rustc")
for file in sys.argv[1:]:
    run = gyro.load(file).simulate(0.01, step=1e-3)
    assert run.summary["engine"] == "in-process", run.summary
    print(np.array([run[name] for name in run.names]).tobytes().hex())
"""


@pytest.mark.filterwarnings("ignore::gyro_sim.RunWarning")
def test_no_rust_is_needed(tmp_path):
    files = [MODELS / f"{name}.toml" for name in ("gyroscope", "four-bar-revolute", "heavy-top", "free-body")]
    words = [sys.executable, "-c", WITHOUT_RUST, *map(str, files)]
    found = subprocess.run(words, env={"PATH": str(tmp_path)}, capture_output=True, text=True, check=True).stdout
    for file, bytes_of_run in zip(files, found.splitlines(), strict=True):
        run = gyro.load(file).simulate(0.01, step=1e-3)
        assert np.array([run[name] for name in run.names]).tobytes().hex() == bytes_of_run, file


def test_every_model_file_of_the_project_is_read():
    import warnings

    names = sorted(MODELS.glob("*.toml")) + [ROOT / "examples/pendulum.toml"]
    assert len(names) > 30
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyro.RunWarning)
        for name in names:
            assert gyro.load(name).name in repr(gyro.load(name))
