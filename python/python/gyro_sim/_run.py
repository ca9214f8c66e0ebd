"""Runs and what can be said of them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterator

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from . import _native

    Array = NDArray[np.float64]


# Names of columns and of the states of a linearisation differ in these.
_PLAIN = str.maketrans(" .", "__")


@dataclass(frozen=True)
class Verdict:
    """How far a run can be trusted, by comparison with another one of the same mechanism."""

    grade: str
    """"good", "usable", "worthless" or "not judged", with `details["reason"]`."""
    relative_error: float | None
    """The largest error over the size of its motion."""
    errors: dict[str, float]
    """Estimated error of each coordinate: rad, m."""
    rate_errors: dict[str, float]
    """Estimated error of each rate: rad/s, m/s."""
    advice: list[str]
    """What to try."""
    companion: str
    """What the run was compared with."""
    text: str
    """All of it as a table."""
    details: dict[str, Any]
    """The object that `simulate --verify --json` prints."""

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        if self.relative_error is None:
            return f"<Verdict {self.grade}>"
        return f"<Verdict {self.grade}: errors up to {self.relative_error:.2g} of the motion>"


class Run:
    """A run: samples of all that moves.

    `run.t` is time, `run["alpha"]` a coordinate, input, output or energy, `run.rate("alpha")` a rate: each an array
    of shape (samples,). `run.names` has all names, `run.units` their units.
    """

    def __init__(self, native: _native.Run, mechanism: _native.Mechanism) -> None:
        self._native = native
        self._mechanism = mechanism
        columns = native.columns()
        self._values: dict[str, Array] = {name: values for name, _, values in columns}
        self.units: dict[str, str] = {name: unit for name, unit, _ in columns}
        """Unit of each quantity, "1" for a number without one."""

    @property
    def t(self) -> Array:
        """Times of the samples, s; shape (samples,)."""
        return self._values["t"]

    @property
    def names(self) -> list[str]:
        """What there is to be asked for by run[name]."""
        return list(self._values)

    def __getitem__(self, name: str) -> Array:
        """A quantity at each sample, in its unit; shape (samples,). "hinge rate" may be written "hinge_rate"."""
        if name in self._values:
            return self._values[name]
        for column, values in self._values.items():
            if column.translate(_PLAIN) == name.translate(_PLAIN):
                return values
        raise KeyError(f"{name!r}: the run has {', '.join(map(repr, self._values))}")

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self.t)

    def rate(self, name: str) -> Array:
        """The rate of a coordinate, rad/s or m/s; shape (samples,)."""
        return self[f"{name} rate"]

    def formula(self, text: str) -> Array:
        """The values of a formula, such as "0.5*cos(hinge) + hinge rate^2", at each sample; shape (samples,).

        It may name time, `t`, parameters, coordinates, rates, numbers of outputs, and curves and formulas of the model
        file. Raises RequestError if it has mistakes.
        """
        return self._native._formula(text)

    @cached_property
    def outputs(self) -> dict[str, Array]:
        """The outputs of the model file by name, each of shape (samples,); parts of one as "name.x"."""
        return {name: self._values[name] for name, _ in self._native.outputs()}

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What the run was and what it cost: integrator, steps, evaluations, violations, energy drift."""
        summary: dict[str, Any] = json.loads(self._native.summary())
        del summary["files"]
        return summary

    @property
    def warnings(self) -> list[str]:
        """What the run says of itself that is not good."""
        from .errors import _in_python

        return [_in_python(words) for words in self._native.warnings()]

    @cached_property
    def verdict(self) -> Verdict:
        """How far the run can be trusted. It is made again when this is first asked for, and compared with a finer one."""
        from .errors import _in_python

        found = json.loads(self._native.verdict())
        return Verdict(
            grade=found["grade"],
            relative_error=found["relative_error"],
            errors=found["estimated_errors"],
            rate_errors=found["estimated_rate_errors"],
            advice=[_in_python(words) for words in found["advice"]],
            companion=found["companion"],
            text=_in_python(found.pop("text")),
            details=found,
        )

    def state(self, t: float) -> Array:
        """The joint state (x, u) at the sample of a time, s: what `linearize` and `f` take; shape (n,).

        There has to be a sample at that time: `simulate(every=…)` says when samples are.
        """
        near = int(np.argmin(np.abs(self.t - t)))
        if not abs(self.t[near] - t) <= 1e-9 * max(abs(self.t[-1]), 1e-300):
            from .errors import RequestError

            raise RequestError(
                f"there is no sample at t = {t} s, the nearest is at {self.t[near]:.12g} s: choose the interval of samples "
                "with simulate(every=…)"
            )
        return self._mechanism._state_of(self._native, near)

    def to_pandas(self) -> Any:
        """All quantities as a pandas DataFrame with the time as its index; units are in `df.attrs["units"]`."""
        import pandas

        columns = {name: values for name, values in self._values.items() if name != "t"}
        frame = pandas.DataFrame(columns, index=pandas.Index(self.t, name="t"))
        frame.attrs["units"] = dict(self.units)
        return frame

    def plot(self, *names: str) -> Any:
        """Draws quantities over time with matplotlib, those of one unit together; the joints' unless some are named.

        Returns the figure.
        """
        import matplotlib.pyplot as plt

        chosen = list(names) or [name for name in self._values if f"{name} rate" in self._values]
        curves = {name: self[name] for name in chosen}
        units = dict.fromkeys(self.units[name] for name in curves)
        figure, axes = plt.subplots(len(units) or 1, 1, sharex=True, squeeze=False)
        for axis, unit in zip(axes[:, 0], units):
            for name, values in curves.items():
                if self.units[name] == unit:
                    axis.plot(self.t, values, label=name)
            axis.set_ylabel(unit)
            axis.legend()
        axes[-1, 0].set_xlabel("t, s")
        return figure

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        summary = self.summary
        tolerance = summary["tolerance"]
        how = f"tolerance {tolerance:g}" if tolerance else f"step {summary['step']:g} s"
        return (
            f"<Run of {summary['model']}: {len(self)} samples to t = {self.t[-1]:g} s, {summary['integrator']}, {how}, "
            f"{summary['coordinates']} coordinates, {summary['steps']} steps>"
        )
