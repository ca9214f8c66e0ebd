"""Mechanisms."""

from __future__ import annotations

import json
import operator
import os
import warnings
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Sequence, Union

import numpy as np

from . import _native
from ._native import Stepper
from ._run import Run
from .errors import RequestError, RunWarning

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Input = Union[float, ArrayLike]


class StateSpace(NamedTuple):
    """A linearisation of states s and outputs z near s0, i0: ds/dt = f0 + A (s - s0) + B (i - i0), with inputs i, and
    z = z0 + C (s - s0) + D (i - i0)."""

    A: Array
    B: Array
    C: Array
    D: Array


class Proof:
    """What was proved of the generated code of a mechanism, function by function."""

    def __init__(self, is_proved: bool, text: str, details: dict[str, Any]) -> None:
        self.is_proved = is_proved
        """Whether every function computes what the textbook says."""
        self.text = text
        self.details = details
        """The object that `verify --json` prints."""

    def __bool__(self) -> bool:
        return self.is_proved

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<Proof: {'all' if self.is_proved else 'not all'} is proved>"


class Mechanism(_native.Mechanism):
    """A mechanism, from `load`, `loads` or `from_urdf`.

    Its state in joint coordinates is (x, u): positions of the joints, `coordinate_names`, and their rates,
    `rate_names`. What needs them compiles when it is first called; calls from then on take microseconds.
    """

    def simulate(
        self,
        t_end: float | None = None,
        *,
        tolerance: float | None = None,
        step: float | None = None,
        every: float | None = None,
        integrator: str | None = None,
        coordinates: str | None = None,
        correction: str | None = None,
        correct_every: float | None = None,
        correct_when: str | None = None,
        budget: int | None = None,
        effort: str | None = None,
        inputs: Mapping[str, Input] | None = None,
    ) -> Run:
        """A run from the start of the model file to `t_end`, s. What is not given is as the model file has it; what that
        does not have is chosen, as by the command (`run.summary["chosen"]` says what and why): joint coordinates where
        there are any, dop853 at a tolerance of 1e-9, and rodas4 where that finds the mechanism to be stiff.

        tolerance: error tolerated in each step, relative and absolute; steps are as long as it allows.
        step: largest step, s, of steps of fixed length, by rk4 unless something else is asked for.
        every: interval between samples, s.
        integrator: "rk4", "tsit5", "dop853" or, for stiff mechanisms, "rodas4".
        coordinates: "joint" or "maximal".
        correction: "partition", "closed-form", "mass-weighted", "baumgarte=RATE" or "none".
        correct_every, correct_when: when that is, s; "steps=K" or "violation=SIZE".
        budget: most steps.
        effort: "full", or "quick" to try fewer forms of the equations, which are there sooner.
        inputs: by name a number, or rows (time, value), interpolated linearly and held beyond them; shape (rows, 2).

        Ctrl-C stops it. What is not good of the run is warned of (RunWarning); `run.verdict` tells how good it is.
        Raises RequestError for what cannot be done and RunError for a run that fails.
        """
        given = {
            "t-end": t_end,
            "tolerance": tolerance,
            "step": step,
            "every": every,
            "integrator": integrator,
            "coordinates": coordinates,
            "correction": correction,
            "correct-every": correct_every,
            "correct-when": correct_when,
            "budget": budget,
            "effort": effort,
        }
        options = [f"--{name}={_text(value)}" for name, value in given.items() if value is not None]
        run = Run(self._run(options, _tables(inputs)), self)
        for words in run.warnings:
            warnings.warn(words, RunWarning, stacklevel=2)
        return run

    def formula(self, text: str) -> Callable[[Run], Array]:
        """A function of runs that gives the values of a formula at each sample, as `Run.formula` does.

        Raises RequestError if the formula has mistakes.
        """
        self._check_formula(text)
        return operator.methodcaller("formula", text)

    def set(self, **parameters: float) -> None:
        """Sets parameters of the model file; the next run starts from an assembly with them. Units are the model file's."""
        self._set([(name, float(value)) for name, value in parameters.items()])

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters and their values."""
        return dict(self._parameters)

    @property
    def inputs(self) -> dict[str, float]:
        """The inputs and their values in the model file; arrays of inputs have this order."""
        return dict(self._inputs)

    @property
    def coordinate_names(self) -> list[str]:
        """What the numbers of x are: angles (rad), displacements (m), Euler parameters; then r (m), p of free bodies."""
        return self._coordinates()[0]

    @property
    def rate_names(self) -> list[str]:
        """What the numbers of u are: rates (rad/s, m/s), relative angular velocities; of free bodies velocities."""
        return self._coordinates()[1]

    def linearize(self, state: ArrayLike | None = None, *, t: float = 0.0, inputs: ArrayLike | None = None) -> StateSpace:
        """(A, B, C, D) about a joint state (x, u), such as `run.state(0.5)`; about the start without one.

        A is (n, n), B (n, inputs), C (outputs, n), D (outputs, inputs), in SI units. Of a mechanism with loops the
        state is the independent coordinates and rates; `linear_states` tells what its elements are.
        """
        return StateSpace(*self._linear(state, t, inputs)[4])

    def linear_states(self, state: ArrayLike | None = None, *, t: float = 0.0) -> list[str]:
        """Names of the elements of the linearised state."""
        return list(self._linear(state, t, None)[0])

    def _linear(self, state: ArrayLike | None, t: float, inputs: ArrayLike | None) -> Any:
        return self._linearized(t, self.start() if state is None else state, inputs)

    def stepper(self, dt: float, state: ArrayLike | None = None, *, substeps: int = 1) -> Stepper:
        """A motion in steps of `dt`, s, by Kutta's method of order 4 with `substeps` each; see Stepper.step.

        state: (x, u), or many of them, of shape (rows, n), which advance together on all cores; the start without one.
        """
        if not 1 <= operator.index(substeps) < 2**32:
            raise RequestError(f"substeps = {substeps}: a whole number from 1 on was expected")
        return self._steps(dt, self.start() if state is None else state, substeps)

    def compile(self, *, native: bool = True) -> None:
        """Has cargo compile what computes many states at once: from then on batches of `joint_accelerations`, and steppers
        of many states of a mechanism without loops that are made from then on, compute eight states at a time.

        native: with all instructions of this processor, fused multiplications among them, which round once: results of
            batches then differ from those of single states by rounding. Without, they are the same bits.

        It needs a Rust toolchain, takes seconds, and is kept in the user's cache. Whatever this library computes, it
        computes without it too. Raises RunError if there is no cargo.
        """
        self._compile(native)

    def sensitivities(
        self,
        times: ArrayLike,
        parameters: Sequence[str],
        *,
        step: float = 1e-3,
        state: ArrayLike | None = None,
        inputs: ArrayLike | None = None,
    ) -> tuple[Array, Array]:
        """A motion and its derivatives by parameters: states (times, n) and slopes (times, n, parameters).

        The generated functions are computed in dual numbers, by Kutta's method of order 4 in steps of at most `step`,
        s, from `state` (the start without one), which is held. times: increasing, s. Slopes are in the state's units
        per unit of the parameter.
        """
        state = self.start() if state is None else state
        states, slopes = self._sensitivities(times, list(parameters), step, state, inputs)
        return states, slopes.reshape(*states.shape, len(parameters))

    def verify(self, *, quick: bool = False) -> Proof:
        """Proves the generated code of all functions against the textbook; `quick` tests each claim at fewer points."""
        is_proved, text, details = self._proof(quick)
        return Proof(is_proved, text, json.loads(details))

    def __reduce__(self) -> Any:
        text, file, folder = self.source
        return _again, (text, file, os.fspath(folder), self._set_parameters)

    def __repr__(self) -> str:
        freedoms = self.degrees_of_freedom
        parts = [f"{freedoms} degree{'' if freedoms == 1 else 's'} of freedom", "joints " + ", ".join(self.joints)]
        if self.parameters:
            parts.append("parameters " + ", ".join(f"{name}={value:g}" for name, value in self.parameters.items()))
        if self.inputs:
            parts.append("inputs " + ", ".join(self.inputs))
        return f"<Mechanism {self.name}: {'; '.join(parts)}>"


def _again(text: str, file: str, folder: str, parameters: dict[str, float]) -> Mechanism:
    mechanism = Mechanism(text, file, folder)
    if parameters:
        mechanism.set(**parameters)
    return mechanism


def _text(value: object) -> str:
    return value if isinstance(value, str) else repr(value if isinstance(value, int) else float(value))  # type: ignore[arg-type]


def _tables(inputs: Mapping[str, Input] | None) -> list[tuple[str, list[list[float]]]]:
    tables = []
    for name, value in (inputs or {}).items():
        rows = np.asarray(value, dtype=float)
        if rows.ndim == 0:
            rows = np.array([[0.0, float(rows)]])
        if rows.ndim != 2 or rows.shape[1] != 2:
            raise RequestError(f"input {name}: a number was expected, or rows (time, value) of shape (rows, 2)")
        tables.append((name, rows.tolist()))
    return tables
