"""Batches from Python beside Rust's lanes: `python lanes.py [MODEL]`, from an environment with the package, with cargo.

Accelerations and steps of 10 000 states, of the engine that compiles in this process, of lanes that cargo compiled for
any processor of this kind (on x86-64 registers of 128 bits), and of lanes with all that this processor has. They take
turns; of each the median of its rounds counts, and of ratios the median of theirs.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

import gyro_sim as gyro

MODEL = Path(__file__).resolve().parents[1] / "studies/models/misaligned-gyroscope.toml"
STATES, ROUNDS, STEPS = 10_000, 41, 10
KINDS = ("in this process", "lanes, any processor", "lanes, this processor")


def seconds(call) -> float:
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def tell(what: str, calls, each: int) -> None:
    for call in calls:
        call()
    rounds = 1e9 / each * np.array([[seconds(call) for call in calls] for _ in range(ROUNDS)])
    medians, ratios = np.median(rounds, axis=0), np.median(rounds[:, :1] / rounds, axis=0)
    for kind, cost, ratio in zip(KINDS, medians, ratios):
        words = "" if kind == KINDS[0] else f", ratio {ratio:.2f}"
        print(f"{what}, {kind}: {cost:.1f} ns{words}")


def main() -> None:
    model = sys.argv[1] if len(sys.argv) > 1 else MODEL
    mechanisms = [gyro.load(model) for _ in KINDS]
    for mechanism, native in zip(mechanisms[1:], (False, True)):
        mechanism.compile(native=native)
    n_x, start = len(mechanisms[0].coordinate_names), mechanisms[0].start()
    states = start + 0.1 * np.random.default_rng(0).normal(size=(STATES, len(start)))
    x, u = states[:, :n_x].copy(), states[:, n_x:].copy()
    out, room = np.empty_like(u), np.empty_like(states)
    accelerations = [lambda m=m: m.joint_accelerations(x, u, None, out) for m in mechanisms]
    tell("accelerations of a state", accelerations, STATES)
    steppers = [mechanism.stepper(1e-4, states, substeps=STEPS) for mechanism in mechanisms]
    tell("a step of a state", [lambda s=s: s.step(None, room) for s in steppers], STATES * STEPS)


if __name__ == "__main__":
    main()
