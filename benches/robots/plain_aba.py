"""The articulated-body algorithm in the frames of the URDF file, unrolled by CasADi: the table's "plain ABA".

Featherstone (2008), chapter 7, joint by joint, with 3 x 3 blocks; constants are folded, common subexpressions shared,
and nothing is regrouped. `unrolled` gives a function of (q, v, tau); a floating base has q = (position, quaternion x y
z w) and v = (velocity, angular velocity) of its joint's frame in that frame, as Pinocchio has it.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

GRAVITY = 9.81


@dataclass
class Joint:
    """A joint with the body on it; the list of joints of model.hpp has the same numbers."""

    parent: int  # 0 is the world, joints count from 1
    kind: str  # revolute, prismatic, floating
    axis: np.ndarray
    rotation: np.ndarray  # of the joint's frame in the parent's
    translation: np.ndarray
    mass: float
    centre: np.ndarray
    inertia: np.ndarray  # about the mass centre


def constant(numbers):
    """Numbers as a sparse matrix, with what rounding has left of 0 and 1 made exact."""
    numbers = np.array(numbers, float)
    numbers[abs(numbers) < 1e-12] = 0
    near = abs(abs(numbers) - 1) < 1e-15
    numbers[near] = np.sign(numbers[near])
    return ca.sparsify(ca.SX(ca.DM(numbers)))


def cross(a, b):
    return ca.cross(ca.densify(a), ca.densify(b))


def dot(a, b):
    return ca.dot(ca.densify(a), ca.densify(b))


def tilde(a):
    return ca.sparsify(ca.vertcat(ca.horzcat(0, -a[2], a[1]), ca.horzcat(a[2], 0, -a[0]), ca.horzcat(-a[1], a[0], 0)))


def symmetric(matrix):
    """The same matrix, its lower triangle shared with its upper one."""
    full = ca.densify(matrix)
    for row in range(full.shape[0]):
        for column in range(row):
            full[row, column] = full[column, row]
    return ca.sparsify(full)


def turn(axis, angle):
    """The rotation about an axis, of a coordinate axis without what is zero or one."""
    c, s = ca.cos(angle), ca.sin(angle)
    (along,) = np.nonzero(axis)
    if len(along) == 1 and axis[along[0]] == 1:
        x, y, z = along[0], (along[0] + 1) % 3, (along[0] + 2) % 3
        rotation = ca.SX(3, 3)
        rotation[x, x] = 1
        rotation[y, y] = rotation[z, z] = c
        rotation[y, z], rotation[z, y] = -s, s
        return rotation
    k = tilde(constant(axis))
    return ca.SX.eye(3) + s * k + (1 - c) * (k @ k)


def of_quaternion(x, y, z, w):
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        ca.horzcat(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        ca.horzcat(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )


class Body:
    """What a sweep leaves at a body. Motions are pairs (linear, angular), forces (force, moment), at its frame."""

    def __init__(self, joint, q, v):
        fixed, place = constant(joint.rotation), constant(joint.translation)
        axis, zero = constant(joint.axis), ca.SX(3, 1)
        self.screw = None
        if joint.kind == "floating":
            self.rotation, self.place = fixed @ of_quaternion(*(q[k] for k in range(3, 7))), q[:3]
            self.joint_velocity = (v[:3], v[3:6])
            return
        if joint.kind == "revolute":
            self.rotation, self.place, self.screw = fixed @ turn(joint.axis, q), place, (zero, axis)
        else:
            self.rotation, self.place, self.screw = fixed, place + fixed @ (axis * q), (axis, zero)
        self.joint_velocity = (self.screw[0] * v, self.screw[1] * v)

    def transported(self, motion):
        """A motion of the parent as one of the parent's part at this body's joint, in this body's axes."""
        linear, angular = motion
        return self.rotation.T @ (linear + cross(angular, self.place)), self.rotation.T @ angular

    def move(self, parent):
        """Velocity, and what the velocities make of the acceleration."""
        if parent is None:
            self.velocity, self.bias = self.joint_velocity, (ca.SX(3, 1), ca.SX(3, 1))
            return
        (l0, w0), (l1, w1) = self.transported(parent.velocity), self.joint_velocity
        l, w = self.velocity = l0 + l1, w0 + w1
        self.bias = cross(w, l1) + cross(l, w1), cross(w, w1)

    def weigh(self, joint):
        """The inertia in blocks, force by linear acceleration first, and the force that the velocities take."""
        arm = np.array([[0, -joint.centre[2], joint.centre[1]], [joint.centre[2], 0, -joint.centre[0]],
                        [-joint.centre[1], joint.centre[0], 0]])
        self.a = constant(joint.mass * np.eye(3))
        self.b = constant(-joint.mass * arm)
        self.d = constant(joint.inertia - joint.mass * arm @ arm)
        l, w = self.velocity
        momentum, moment = self.a @ l + self.b @ w, self.b.T @ l + self.d @ w
        self.force = cross(w, momentum), cross(w, moment) + cross(l, momentum)

    def fold(self, parent, tau):
        """Solves the joint for its acceleration and adds what is left to the parent."""
        sl, sw = self.screw
        self.u = ul, uw = self.a @ sl + self.b @ sw, self.b.T @ sl + self.d @ sw
        self.inverse = 1 / (dot(sl, ul) + dot(sw, uw))
        self.rest = tau - dot(sl, self.force[0]) - dot(sw, self.force[1])
        if parent is None:
            return
        kl, kw = ul * self.inverse, uw * self.inverse
        a, b, d = symmetric(self.a - kl @ ul.T), self.b - kl @ uw.T, symmetric(self.d - kw @ uw.T)
        cl, cw = self.bias
        fl = self.force[0] + a @ cl + b @ cw + ul * (self.inverse * self.rest)
        fw = self.force[1] + b.T @ cl + d @ cw + uw * (self.inverse * self.rest)
        turn, arm = self.rotation, ca.sparsify(tilde(self.place))
        a, b, d = symmetric(turn @ a @ turn.T), turn @ b @ turn.T, symmetric(turn @ d @ turn.T)
        moved = b - a @ arm
        parent.a, parent.b = parent.a + a, parent.b + moved
        parent.d = parent.d + symmetric(arm @ moved - b.T @ arm + d)
        fl, fw = turn @ fl, turn @ fw
        parent.force = parent.force[0] + fl, parent.force[1] + fw + cross(self.place, fl)

    def accelerate(self, parent):
        """The joint's acceleration, and the body's."""
        (l0, w0), (cl, cw) = self.transported(parent), self.bias
        l, w = l0 + cl, w0 + cw
        qdd = self.inverse * (self.rest - dot(self.u[0], l) - dot(self.u[1], w))
        self.acceleration = l + self.screw[0] * qdd, w + self.screw[1] * qdd
        return qdd

    def float(self, tau, gravity):
        """The acceleration of a floating base by L D L^T."""
        m = ca.densify(ca.vertcat(ca.horzcat(self.a, self.b), ca.horzcat(self.b.T, self.d)))
        x = ca.vertcat(-self.force[0], -self.force[1]) + tau
        x, l, d = [x[k] for k in range(6)], np.zeros((6, 6), object), [0] * 6
        for row in range(6):
            for column in range(row):
                done = sum(l[row, k] * l[column, k] * d[k] for k in range(column))
                l[row, column] = (m[row, column] - done) / d[column]
            d[row] = m[row, row] - sum(l[row, k] * l[row, k] * d[k] for k in range(row))
        for row in range(6):
            x[row] = x[row] - sum(l[row, k] * x[k] for k in range(row))
        x = [value / pivot for value, pivot in zip(x, d)]
        for row in reversed(range(6)):
            x[row] = x[row] - sum(l[k, row] * x[k] for k in range(row + 1, 6))
        self.acceleration = ca.vertcat(*x[:3]), ca.vertcat(*x[3:])
        return ca.vertcat(self.acceleration[0] - self.rotation.T @ gravity, self.acceleration[1])


def unrolled(joints, name="plain_aba"):
    """A function (q, v, tau) -> accelerations."""
    floats = [joint.kind == "floating" for joint in joints]
    n_v = sum(6 if float else 1 for float in floats)
    q, v, tau = ca.SX.sym("q", n_v + sum(floats)), ca.SX.sym("v", n_v), ca.SX.sym("tau", n_v)
    bodies, rates, at = [None], [None], 0
    for joint, floating in zip(joints, floats):
        n, extra = (6, 1) if floating else (1, 0)
        first = at + sum(floats[: len(bodies) - 1])
        body = Body(joint, q[first : first + n + extra], v[at : at + n])
        body.move(bodies[joint.parent])
        body.weigh(joint)
        bodies.append(body)
        rates.append(slice(at, at + n))
        at += n
    for index in reversed(range(1, len(bodies))):
        if bodies[index].screw is not None:
            bodies[index].fold(bodies[joints[index - 1].parent], tau[rates[index]])
    gravity = ca.sparsify(ca.SX(ca.DM([0, 0, GRAVITY])))
    out = ca.SX(n_v, 1)
    for body, joint, rate in zip(bodies[1:], joints, rates[1:]):
        if body.screw is None:
            out[rate] = body.float(tau[rate], gravity)
        else:
            parent = bodies[joint.parent]
            out[rate] = body.accelerate((gravity, ca.SX(3, 1)) if parent is None else parent.acceleration)
    return ca.Function(name, [q, v, tau], [ca.cse(ca.densify(out))])


def operations(function):
    """Sums, differences, products, quotients, squares, doubles and reciprocals; sines and cosines not among them."""
    counted = {ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_DIV, ca.OP_SQ, ca.OP_TWICE, ca.OP_INV}
    return sum(function.instruction_id(k) in counted for k in range(function.n_instructions()))
