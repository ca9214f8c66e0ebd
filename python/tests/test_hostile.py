"""Arguments that are not as they should be, other threads and processes, and Ctrl-C."""

import _thread
import multiprocessing
import pickle
import threading

import numpy as np
import pytest
from conftest import MODELS, PENDULUM

import gyro_sim as gyro

RANDOM = np.random.default_rng(11)


def unaligned(array):
    """The same numbers at an address that is no multiple of 8."""
    room = np.empty(array.nbytes + 1, dtype=np.uint8)
    moved = room[1:].view(np.float64).reshape(array.shape)
    moved[...] = array
    assert not moved.flags.aligned and moved.flags.c_contiguous
    return moved


@pytest.mark.parametrize(
    "changed",
    [
        unaligned,
        np.asfortranarray,
        lambda x: x.astype(">f8"),
        lambda x: np.repeat(x, 2, axis=-1)[..., ::2],
        lambda x: x[..., ::-1].copy()[..., ::-1],
        lambda x: np.ma.masked_array(x),
        lambda x: x.tolist(),
    ],
)
def test_arrays_of_any_layout_have_the_same_results(gimbal, changed):
    x, u = RANDOM.normal(size=(5, 3)), RANDOM.normal(size=(5, 3))
    expected = gimbal.joint_accelerations(x, u)
    assert (gimbal.joint_accelerations(changed(x), changed(u)) == expected).all()
    assert (gimbal.joint_accelerations(changed(x[0]), changed(u[0])) == expected[0]).all()
    assert (gimbal.stepper(1e-3, changed(np.hstack([x, u]))).step() == gimbal.stepper(1e-3, np.hstack([x, u])).step()).all()


@pytest.mark.parametrize("dtype", [np.float32, np.float16, np.int64, np.int8, np.bool_])
def test_numbers_of_other_types_are_converted(gimbal, dtype):
    x, u = np.array([0, 1, 0]).astype(dtype), np.array([1, 0, 1]).astype(dtype)
    assert (gimbal.joint_accelerations(x, u) == gimbal.joint_accelerations(x.astype(float), u.astype(float))).all()


@pytest.mark.parametrize("wrong", [np.zeros(3, complex), np.array(["a", "b", "c"]), np.array([None] * 3), "abc", None])
def test_what_is_no_real_number_is_refused(gimbal, wrong):
    for call in [
        lambda: gimbal.joint_accelerations(wrong, np.zeros(3)),
        lambda: gimbal.f(0.0, wrong),
        lambda: gimbal.stepper(1e-3, np.zeros(6)).restart(wrong),
    ]:
        with pytest.raises(gyro.RequestError, match="real numbers were expected"):
            call()


def test_results_are_not_written_where_they_must_not_be(gimbal):
    x, u = np.zeros(3), np.ones(3)
    still = np.zeros(3)
    still.flags.writeable = False
    with pytest.raises(gyro.RequestError, match="can be written to"):
        gimbal.joint_accelerations(x, u, out=still)
    for shared in (x, u):
        with pytest.raises(gyro.RequestError, match="no memory in common"):
            gimbal.joint_accelerations(x, u, out=shared)
    with pytest.raises(gyro.RequestError, match="an array of float64 in C order"):
        gimbal.joint_accelerations(x, u, out=unaligned(np.zeros(3)))
    assert (x == 0).all() and (u == 1).all() and (still == 0).all()
    # Arguments may be of arrays that cannot be written to.
    assert (gimbal.joint_accelerations(still, u) == gimbal.joint_accelerations(x, u)).all()


def test_a_step_that_cannot_be_told_is_not_taken(gimbal):
    stepper = gimbal.stepper(1e-3)
    for wrong in [np.zeros(5), np.zeros(6, np.float32), unaligned(np.zeros(6)), "abc"]:
        with pytest.raises(gyro.RequestError, match="out:"):
            stepper.step(out=wrong)
    with pytest.raises(gyro.RequestError, match="the model file has none"):
        stepper.step([1.0])
    assert stepper.t == 0 and (stepper.state == gimbal.start()).all()


def test_nothing_gives_nothing(gimbal, pendulum):
    assert gimbal.joint_accelerations(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0, 3)
    assert gimbal.stepper(1e-3, np.zeros((0, 6))).step().shape == (0, 6)
    states, slopes = pendulum.sensitivities([], ["length"])
    assert states.shape == (0, 2) and slopes.shape == (0, 2, 1)


def test_what_is_not_finite_is_passed_on_or_refused(gimbal, pendulum):
    x, u = RANDOM.normal(size=(4, 3)), RANDOM.normal(size=(4, 3))
    expected = gimbal.joint_accelerations(x, u)
    x[1, 1] = np.nan
    found = gimbal.joint_accelerations(x, u)
    assert np.isnan(found[1]).any() and (found[[0, 2, 3]] == expected[[0, 2, 3]]).all()
    for value in (np.nan, np.inf):
        with pytest.raises(gyro.RequestError):
            pendulum.set(length=value)
        with pytest.raises(gyro.RequestError):
            pendulum.simulate(0.1, inputs={"torque": value})
        with pytest.raises(gyro.RequestError):
            pendulum.simulate(value)
        with pytest.raises(gyro.RequestError):
            pendulum.simulate(0.1, tolerance=value)
        with pytest.raises(gyro.RequestError, match="increasing times"):
            pendulum.sensitivities([0.0, value], ["length"])
    assert pendulum.parameters == {"length": 0.5}
    with pytest.raises(gyro.RequestError, match="no sample at t = nan s, the nearest is at 0 s"):
        pendulum.simulate(0.1).state(np.nan)


def test_names_and_numbers_that_there_are_not(pendulum, tmp_path):
    for substeps in (0, -1, 2**32):
        with pytest.raises(gyro.RequestError, match="a whole number from 1 on"):
            pendulum.stepper(1e-3, substeps=substeps)
    with pytest.raises(TypeError):
        pendulum.stepper(1e-3, substeps=2.5)
    with pytest.raises(FileNotFoundError):
        gyro.from_urdf(tmp_path / "none.urdf")
    with pytest.raises(KeyError, match="the run has 't', .*'hinge'"):
        pendulum.simulate(0.01).plot("hing")
    with pytest.raises(gyro.RequestError, match=r"x of shape \(2, 1\) and u of \(3, 1\)"):
        pendulum.joint_accelerations(np.zeros((2, 1)), np.zeros((3, 1)))


def test_a_pickle_has_the_text_that_was_read(tmp_path):
    file = tmp_path / "pendulum.toml"
    file.write_text(PENDULUM)
    mechanism = gyro.load(file)
    mechanism.set(length=0.3)
    kept = pickle.dumps(mechanism)
    file.write_text("no model file any more")
    again = pickle.loads(kept)
    assert again.parameters == {"length": 0.3}
    assert (again.joint_accelerations([0.1], [0.2]) == mechanism.joint_accelerations([0.1], [0.2])).all()
    with pytest.raises(gyro.ModelError):
        pickle.loads(kept.replace(b"revolute", b"revolted"))


def test_threads_share_a_mechanism(pendulum):
    x, u = RANDOM.normal(size=(3000, 1)), RANDOM.normal(size=(3000, 1))
    expected, wrong = pendulum.joint_accelerations(x, u), []

    def work(seed):
        for k in np.random.default_rng(seed).integers(len(x), size=200):
            if (pendulum.joint_accelerations(x[k], u[k]) != expected[k]).any():
                wrong.append(k)
            if k % 20 == 0 and (pendulum.joint_accelerations(x, u) != expected).any():
                wrong.append(-1)

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert not wrong


def of_a_child(mechanism, x, u, queue):
    queue.put((mechanism.joint_accelerations(x, u), mechanism.stepper(1e-3, np.hstack([x, u])).step()))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="processes are not forked here")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_has_its_own_threads(gimbal):
    x, u = RANDOM.normal(size=(3000, 3)), RANDOM.normal(size=(3000, 3))
    expected = gimbal.joint_accelerations(x, u), gimbal.stepper(1e-3, np.hstack([x, u])).step()
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=of_a_child, args=(gimbal, x, u, queue))
    child.start()
    try:
        found = queue.get(timeout=60)
    finally:
        child.kill()
    assert all((one == other).all() for one, other in zip(found, expected))


def interrupted(call):
    """Whether Ctrl-C ends a call."""
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    try:
        call()
    except KeyboardInterrupt:
        return True
    finally:
        timer.cancel()
    return False


@pytest.mark.filterwarnings("ignore::gyro_sim.RunWarning")
def test_ctrl_c_stops_every_long_call(gimbal, pendulum):
    stepper = pendulum.stepper(1e3, substeps=2**32 - 1)
    many = gimbal.stepper(1e3, np.tile(gimbal.start(), (1000, 1)), substeps=2**32 - 1)
    platform = gyro.load(MODELS / "stewart-platform.toml")
    pendulum.start()
    for call in [
        lambda: pendulum.simulate(1e9, step=1e-3, every=1e9, budget=10**13),
        stepper.step,
        many.step,
        lambda: pendulum.sensitivities([0.0, 1e9], ["length"]),
        platform.verify,
        platform.generate,
    ]:
        assert interrupted(call)
    # What was not taken did not happen.
    assert stepper.t == 0 and (stepper.state == pendulum.start()).all()
    assert many.t == 0 and (many.state == gimbal.start()).all()
