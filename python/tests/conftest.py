"""What the tests share."""

from pathlib import Path

import pytest

import gyro_sim as gyro

ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / "models"

PENDULUM = """
format = 1
name = "pendulum"
gravity = [0, -9.81, 0]

[parameters]
length = 0.5

[inputs]
torque = 0

[[body]]
name = "wall"
fixed = true

[[body]]
name = "rod"
mass = 1
inertia = [0.0833, 1e-4, 0.0833]

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "wall" }
second = { body = "rod", point = [0, "length", 0] }
angle_deg = 90

[[force]]
name = "motor"
kind = "motor"
joint = "hinge"
value = "torque"

[[output]]
name = "hinge_load"
kind = "reaction"
joint = "hinge"
"""


@pytest.fixture
def pendulum():
    return gyro.loads(PENDULUM, "pendulum.toml")


@pytest.fixture
def gimbal():
    return gyro.load(MODELS / "gyroscope.toml")
