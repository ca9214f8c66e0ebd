"""Accelerations, derivatives, linearisation and steps."""

import shutil
import warnings

import numpy as np
import pytest
from conftest import MODELS

import gyro_sim as gyro

SEED = np.random.default_rng(7)


def test_a_pendulum_falls_as_the_textbook_says(pendulum):
    (x,), (u,) = np.split(pendulum.start(), 2)
    assert x == pytest.approx(np.pi / 2) and u == 0
    inertia = 0.0833 + 0.25
    accelerations = pendulum.joint_accelerations([x], [u], [2.0])
    assert accelerations == pytest.approx((2.0 - 9.81 * 0.5 * np.sin(x)) / inertia, rel=1e-12)
    pendulum.set(length=0.25)
    changed = pendulum.joint_accelerations([x], [u])
    assert changed == pytest.approx(-9.81 * 0.25 * np.sin(x) / (0.0833 + 0.0625), rel=1e-12)
    assert pendulum.coordinate_names == ["hinge"] and pendulum.rate_names == ["hinge rate"]


def test_results_are_written_where_one_says(gimbal):
    x, u = np.split(gimbal.start(), 2)
    out = np.empty(3)
    assert gimbal.joint_accelerations(x, u, out=out) is out
    assert (out == gimbal.joint_accelerations(list(x), list(u))).all()
    for wrong in [np.empty(4), np.empty(3, dtype=np.float32), np.empty(6)[::2], [0.0, 0.0, 0.0]]:
        with pytest.raises(gyro.RequestError, match="out: an array of float64"):
            gimbal.joint_accelerations(x, u, out=wrong)
    for wrong in [x[:2], np.zeros((2, 2)), np.zeros((1, 1, 3))]:
        with pytest.raises(gyro.RequestError, match=r"\(3,\) was expected"):
            gimbal.joint_accelerations(wrong, u)
    with pytest.raises(gyro.RequestError, match="as many rows"):
        gimbal.joint_accelerations(np.zeros((2, 3)), np.zeros((3, 3)))


@pytest.mark.parametrize("rows", [0, 1, 2, 3, 255, 1001])
def test_batches_have_the_bits_of_single_states(pendulum, gimbal, rows):
    for mechanism in (pendulum, gimbal):
        n = len(mechanism.coordinate_names)
        x, u = SEED.normal(size=(rows, n)), SEED.normal(size=(rows, n))
        inputs = SEED.normal(size=(rows, len(mechanism.inputs))) if mechanism.inputs else None
        batch = mechanism.joint_accelerations(x, u, inputs)
        assert batch.shape == (rows, n)
        for k in range(rows):
            own = None if inputs is None else inputs[k]
            assert (mechanism.joint_accelerations(x[k], u[k], own) == batch[k]).all(), k
        # Other orders and types are converted, and inputs are forgotten.
        assert (mechanism.joint_accelerations(np.asfortranarray(x), u[:, ::-1][:, ::-1], inputs) == batch).all()
        still = mechanism.joint_accelerations(x, u)
        if rows:
            assert (mechanism.joint_accelerations(x[0], u[0]) == still[0]).all()


def test_scipy_integrates_it(gimbal):
    integrate = pytest.importorskip("scipy.integrate")
    run = gimbal.simulate(0.1, tolerance=1e-11, coordinates="joint")
    solved = integrate.solve_ivp(gimbal.f, (0, 0.1), gimbal.start(), method="DOP853", rtol=1e-11, atol=1e-11)
    assert np.abs(solved.y[:3, -1] - [run[name][-1] for name in ("alpha", "beta", "phi")]).max() < 1e-9
    assert np.abs(solved.y[:, -1] - run.state(0.1)).max() < 1e-6


def test_linearisation_agrees_with_differences(pendulum):
    state = np.array([0.3, -0.2])
    A, B, C, D = pendulum.linearize(state)
    assert A.shape == (2, 2) and B.shape == (2, 1) and C.shape[1] == 2 and D.shape == (len(C), 1)
    h = 1e-6
    for column in range(2):
        step = h * np.eye(2)[column]
        slope = (pendulum.f(0.0, state + step) - pendulum.f(0.0, state - step)) / (2 * h)
        assert np.allclose(A[:, column], slope, atol=1e-8)
    slope = (pendulum.f(0.0, state, [h]) - pendulum.f(0.0, state, [-h])) / (2 * h)
    assert np.allclose(B[:, 0], slope, atol=1e-8)
    assert pendulum.linear_states() == ["hinge", "hinge_rate"]


@pytest.mark.filterwarnings("ignore::gyro_sim.RunWarning")
def test_loops_are_linearised_in_independent_coordinates():
    linkage = gyro.load(MODELS / "four-bar-revolute.toml")
    run = linkage.simulate(0.1, tolerance=1e-9)
    A, B, C, D = linkage.linearize(run.state(0.1), t=0.1)
    assert A.shape == (2 * linkage.degrees_of_freedom,) * 2


def test_states_of_runs_are_those_of_samples(gimbal):
    run = gimbal.simulate(0.1, tolerance=1e-9, every=0.05)
    assert (run.state(0.05)[:3] == [run[name][1] for name in gimbal.coordinate_names]).all()
    assert (run.state(0.0) == gimbal.start()).all()
    with pytest.raises(gyro.RequestError, match="no sample at t = 0.07"):
        run.state(0.07)


def test_free_bodies_have_states():
    body = gyro.load(MODELS / "free-body.toml")
    run = body.simulate(0.1, tolerance=1e-9)
    state = run.state(0.0)
    assert state.shape == (13,) and np.allclose(state, body.start())
    assert len(body.coordinate_names) == 7 and len(body.rate_names) == 6


def test_what_sticks_in_all_joints_of_a_loop_runs():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyro.RunWarning)
        text = (MODELS / "four-bar-revolute.toml").read_text()
        for joint in ("crank_pivot", "elbow", "knee", "rocker_pivot"):
            text += f'[[contact]]\nname = "at_{joint}"\njoint = "{joint}"\nfriction = 0.1\n'
        linkage = gyro.loads(text)
        angles = [linkage.simulate(1, tolerance=1e-10, coordinates=by)["elbow"][-1] for by in ("joint", "maximal")]
        assert abs(angles[0] - angles[1]) < 1e-8


def test_steps_are_kuttas(pendulum):
    stepper = pendulum.stepper(1e-3)
    x = stepper.state
    for k in range(10):
        torque = np.array([0.1 * k])
        f = lambda t, x: pendulum.f(t, x, torque)
        k1 = f(0, x)
        k2 = f(0, x + 0.5e-3 * k1)
        k3 = f(0, x + 0.5e-3 * k2)
        k4 = f(0, x + 1e-3 * k3)
        x = x + 1e-3 / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        assert np.allclose(stepper.step(torque), x, rtol=1e-14, atol=1e-15)
    assert stepper.t == pytest.approx(0.01) and "0.01 s" in repr(stepper)
    out = np.empty(2)
    assert stepper.step(out=out) is out
    stepper.restart(pendulum.start())
    assert stepper.t == 0 and (stepper.state == pendulum.start()).all()


def test_a_step_has_a_length(pendulum):
    for dt in (0.0, -1e-3, np.nan, np.inf):
        with pytest.raises(gyro.RequestError, match="positive number of seconds"):
            pendulum.stepper(dt)


@pytest.mark.parametrize("rows", [1, 2, 3, 300, 301])
def test_many_advance_as_each_alone(pendulum, rows):
    states, inputs = SEED.normal(size=(rows, 2)), SEED.normal(size=(rows, 1))
    many = pendulum.stepper(1e-2, states, substeps=3)
    for _ in range(3):
        found = many.step(inputs)
    assert found.shape == states.shape
    for k in {0, rows // 2, rows - 1}:
        alone = pendulum.stepper(1e-2, states[k], substeps=3)
        for _ in range(3):
            alone.step(inputs[k])
        assert (alone.state == found[k]).all()
    # Inputs stay until others are given.
    kept = pendulum.stepper(1e-2, states, substeps=3)
    kept.step(inputs)
    kept.step()
    assert (kept.step() == found).all()
    many.restart(states)
    assert (many.step()[0] == pendulum.stepper(1e-2, states[0], substeps=3).step()).all()


@pytest.mark.skipif(shutil.which("cargo") is None, reason="there is no cargo")
def test_batches_are_compiled_by_cargo(pendulum, gimbal):
    for mechanism in (pendulum, gimbal):
        n = len(mechanism.coordinate_names)
        x, u, states = SEED.normal(size=(999, n)), SEED.normal(size=(999, n)), SEED.normal(size=(999, 2 * n))
        inputs = SEED.normal(size=(999, len(mechanism.inputs)))
        found = mechanism.joint_accelerations(x, u, inputs), mechanism.stepper(1e-3, states).step(inputs)
        for native in (False, True):
            mechanism.compile(native=native)
            again = mechanism.joint_accelerations(x, u, inputs), mechanism.stepper(1e-3, states).step(inputs)
            for one, other in zip(found, again):
                # What the processor fuses is rounded once less.
                assert np.allclose(one, other, rtol=1e-11, atol=1e-11) if native else (one == other).all()
    pendulum.compile(native=False)
    pendulum.set(length=0.3)
    again = gyro.loads(pendulum.source[0])
    again.set(length=0.3)
    x, u = SEED.normal(size=(5, 1)), SEED.normal(size=(5, 1))
    assert (pendulum.joint_accelerations(x, u) == again.joint_accelerations(x, u)).all()


def test_who_compiles_without_cargo_is_told(pendulum, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CARGO", raising=False)
    monkeypatch.setenv("GYRO_CACHE", str(tmp_path))
    with pytest.raises(gyro.RunError, match="rustup.rs; all else works without it"):
        pendulum.compile()
    assert pendulum.joint_accelerations([[0.0]], [[0.0]]).shape == (1, 1)


def test_modules_are_generated_and_proved(pendulum):
    text = pendulum.generate()
    assert text.startswith("// @generated") and "pub struct Pendulum<T>" in text
    proof = pendulum.verify(quick=True)
    assert proof and proof.is_proved and proof.details["mechanism"] == "pendulum" and "proved" in str(proof)


def test_sensitivities_agree_with_differences(pendulum):
    times, state = np.linspace(0, 0.5, 6), pendulum.start()
    states, slopes = pendulum.sensitivities(times, ["length"], state=state)
    assert states.shape == (6, 2) and slopes.shape == (6, 2, 1)
    h, near = 1e-5, []
    for length in (0.5 + h, 0.5 - h):
        pendulum.set(length=length)
        near.append(pendulum.sensitivities(times, [], state=state)[0])
    assert np.allclose(slopes[:, :, 0], (near[0] - near[1]) / (2 * h), atol=1e-6)
    run = gyro.loads(pendulum.source[0]).simulate(0.5, tolerance=1e-11)
    assert np.allclose(states[-1], run.state(0.5), atol=1e-9)
    with pytest.raises(gyro.RequestError, match="no parameter `width`"):
        pendulum.sensitivities(times, ["width"])
