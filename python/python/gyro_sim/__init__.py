"""Equations of motion of mechanisms: derived from a model file, compiled in this process, simulated.

>>> import gyro_sim as gyro
>>> gimbal = gyro.load("gyroscope.toml")
>>> run = gimbal.simulate(1.0, tolerance=1e-9)
>>> run.t, run["alpha"], run.rate("alpha")

All units are SI: m, kg, s, rad, N, N m, J.
"""

from __future__ import annotations

import errno
import os
import warnings
from pathlib import Path

from . import _native
from ._mechanism import Mechanism, Proof, StateSpace
from ._native import Stepper
from ._run import Run, Verdict
from .errors import GyroError, Mistake, ModelError, RequestError, RunError, RunWarning, _in_python

__version__: str = _native.version

__all__ = [
    "GyroError",
    "Mechanism",
    "Mistake",
    "ModelError",
    "Proof",
    "RequestError",
    "Run",
    "RunError",
    "RunWarning",
    "StateSpace",
    "Stepper",
    "Verdict",
    "from_urdf",
    "load",
    "loads",
]


def load(path: str | os.PathLike[str]) -> Mechanism:
    """The mechanism of a model file; tables of motions are looked for beside it.

    Raises ModelError, which lists every mistake of the file with its line and what to write instead.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise RequestError(f"{path} is not UTF-8 text: byte {error.start} belongs to no character") from None
    return _loaded(text, str(path), path.parent)


def loads(text: str, name: str = "<text>", folder: str | os.PathLike[str] = ".") -> Mechanism:
    """The mechanism of the text of a model file, called `name` in messages; tables are in `folder`."""
    return _loaded(text, name, Path(folder))


def from_urdf(
    path: str | os.PathLike[str],
    *,
    floating: bool = False,
    motors: bool = False,
    limits: bool = False,
    armature: float | None = None,
    wrenches: list[str] | None = None,
    frames: list[str] | None = None,
    as_written: bool = False,
    density: float | None = None,
    ignore: list[str] | None = None,
) -> Mechanism:
    """The mechanism of a robot in the Unified Robot Description Format.

    floating: the root link floats instead of being fixed to the ground.
    motors: each joint has a motor whose torque (N m) or force (N) is the input `JOINT_motor`.
    limits: joints have stops at their limits.
    armature: inertia of each joint's drive behind its gear, kg m2 or kg.
    wrenches: links on which a force and a torque act, inputs `LINK_force_x` to `LINK_torque_z`.

    frames: links whose frames are outputs, `LINK_pose` and `LINK_velocity`; `["all"]` for all that move.
    as_written: inertias that no body has, and angles and axes close to round ones, are taken as they are.
    density: of shapes (kg/m3), from which mass and inertia are taken where the file has none, or none of a body.
    ignore: names of elements to be left out, though the robot may be another mechanism without them.

    What of the robot has no counterpart is warned of, in one warning (RunWarning). The text of the model file is
    `mechanism.source[0]`.
    """
    flags = {"floating": floating, "motors": motors, "limits": limits, "as_written": as_written}
    options = [f"--{name.replace('_', '-')}" for name, wanted in flags.items() if wanted]
    if armature is not None:
        options += ["--armature", repr(float(armature))]
    if density is not None:
        options += ["--density", repr(float(density))]
    for name, words in (("wrenches", wrenches), ("frames", frames), ("ignore", ignore)):
        if words:
            options += [f"--{name}", ",".join(words)]
    if not Path(path).exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))
    text, remarks = _native.convert_urdf(os.fspath(path), options)
    if remarks:
        told = "\n  ".join(_in_python(remark) for remark in remarks)
        warnings.warn(f"what differs from the robot:\n  {told}", RunWarning, stacklevel=2)
    return _loaded(text, str(Path(path).with_suffix(".toml")), Path(path).parent)


def _loaded(text: str, file: str, folder: Path) -> Mechanism:
    mechanism = Mechanism(text, file, folder)
    for remark in mechanism.remarks:
        warnings.warn(remark, RunWarning, stacklevel=3)
    return mechanism
