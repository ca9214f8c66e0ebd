"""What calls from Python cost: `python measure.py`, from an environment with the package. The least of several rounds."""

from __future__ import annotations

import time
import timeit
from pathlib import Path

import numpy as np

import gyro_sim as gyro

MODEL = Path(__file__).resolve().parents[1] / "models/gyroscope.toml"
STATES, CROWD = 10_000, 4096


def nanoseconds(call, number: int) -> float:
    return 1e9 * min(timeit.repeat(call, number=number, repeat=15)) / number


def main() -> None:
    began = time.perf_counter()
    gimbal = gyro.load(MODEL)
    start = gimbal.start()
    print(f"model file to the first state: {1e3 * (time.perf_counter() - began):.0f} ms")
    x, u = np.split(start, 2)
    out = np.empty(3)
    many_x, many_u = np.tile(x, (STATES, 1)), np.random.default_rng(0).normal(size=(STATES, 3))
    many_out = np.empty((STATES, 3))
    stepper, crowd = gimbal.stepper(1e-4), gimbal.stepper(1e-4, np.tile(start, (CROWD, 1)))
    states = np.empty((CROWD, 6))
    batch = nanoseconds(lambda: gimbal.joint_accelerations(many_x, many_u, None, many_out), 20) / STATES
    for what, cost in [
        ("joint_accelerations of one state", nanoseconds(lambda: gimbal.joint_accelerations(x, u), 10_000)),
        ("the same into out", nanoseconds(lambda: gimbal.joint_accelerations(x, u, None, out), 10_000)),
        ("f of one state", nanoseconds(lambda: gimbal.f(0.0, start), 10_000)),
        ("a step (rk4) of one state", nanoseconds(lambda: stepper.step(), 10_000)),
        (f"joint_accelerations of {STATES} states, each", batch),
        (f"a step of {CROWD} states, each", nanoseconds(lambda: crowd.step(None, states), 10) / CROWD),
        ("the paper's second at 1e-9", nanoseconds(lambda: gimbal.simulate(1.0, tolerance=1e-9, coordinates="joint", every=1.0), 10)),
    ]:
        print(f"{what:44} {cost:12.1f} ns")


if __name__ == "__main__":
    main()
