"""A cart that balances a pendulum: the linearised mechanism, a linear-quadratic regulator, and the mechanism itself."""

import numpy as np
from scipy.linalg import solve_continuous_are

import gyro_sim as gyro

CART = """
format = 1
name = "balance"
gravity = [0, -9.81, 0]

[inputs]
push = 0

[[body]]
name = "rail"
fixed = true

[[body]]
name = "cart"
mass = 1
inertia = [1e-3, 1e-3, 1e-3]

[[body]]
name = "bob"
mass = 0.5
inertia = [1e-3, 1e-3, 1e-3]

[[joint]]
name = "slide"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "rail" }
second = { body = "cart" }

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "cart" }
second = { body = "bob", point = [0, 0.4, 0] }

[[force]]
name = "motor"
kind = "motor"
joint = "slide"
value = "push"
"""

cart = gyro.loads(CART, "balance.toml")
upright = np.array([0.0, np.pi, 0.0, 0.0])  # slide, hinge and their rates
A, B, C, D = cart.linearize(upright)
Q, R = np.diag([10.0, 1.0, 1.0, 1.0]), np.array([[0.1]])
K = np.linalg.solve(R, B.T @ solve_continuous_are(A, B, Q, R))
print("poles:", np.sort_complex(np.linalg.eigvals(A - B @ K)).round(2))
assert (np.linalg.eigvals(A - B @ K).real < 0).all() and (np.linalg.eigvals(A).real > 0).any()

# 100 times a second the controller reads the state of the nonlinear mechanism and holds a force.
stepper = cart.stepper(0.01, upright + [0.2, 0.3, 0.0, 0.0], substeps=10)
state, largest = stepper.state, 0.0
while stepper.t < 8:
    push = -K @ (state - upright)
    largest = max(largest, abs(push[0]))
    state = stepper.step(push)
print(f"after 8 s: cart at {state[0]:.1e} m, pendulum {state[1] - np.pi:.1e} rad off; largest force {largest:.1f} N")
assert np.abs(state - upright).max() < 1e-2
