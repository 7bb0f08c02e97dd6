"""What two wheels turn, worked out the long way: for checks of the selection.

Moments are taken about B's origin, module by module, and moved to the common centre of mass.
"""

import numpy as np
from naive_module import room_taken, round_thing


def inertia_on(problem, drive, rims, angle):
    """Of robot and both modules about roll and pitch through the common centre, braked."""
    whole = _tensor(problem, drive, rims, angle)
    return np.stack([whole[0, 0], whole[1, 1]])


def coupling_on(problem, drive, rims, angle):
    """Roll momentum per pitch rate, and the reverse, of what has no momentum of yaw."""
    whole = _tensor(problem, drive, rims, angle)
    yaw_rate = -whole[2, 1] / whole[2, 2]
    return whole[0, 1] + whole[0, 2] * yaw_rate


def _tensor(problem, drive, rims, angle):
    """Of robot and both modules about their common centre, braked, shape (3, 3, n)."""
    module = round_thing(*drive.wheel(rims)) + drive.standing(rims)
    mass, along, up, across, axis, upright, aslant = module
    robot, place = problem.robot, problem.place
    size = rims.outer, rims.height, drive.motor, drive.gear, drive.thick
    reach, standing = room_taken(*size)
    x, y, z = (o + d * reach for o, d in zip(place.origins[0], place.outward[0], strict=True))
    z = z + standing if place.upright else z
    sine, cosine = np.sin(angle), np.cos(angle)
    zero = np.zeros_like(sine + mass)
    # Of the left module, and of the right one, about B's origin: masses times coordinates.
    first, second = np.zeros((3, *zero.shape)), np.zeros((3, 3, *zero.shape))
    for side in (1.0, -1.0):
        first += np.stack(
            [mass * x + along * sine, side * (mass * y + along * cosine), mass * z + up]
        )
        xx = mass * x**2 + 2.0 * x * along * sine + across * cosine**2 + axis * sine**2
        yy = mass * y**2 + 2.0 * y * along * cosine + across * sine**2 + axis * cosine**2
        zz = mass * z**2 + 2.0 * z * up + upright
        xy = mass * x * y + x * along * cosine + y * along * sine + (axis - across) * sine * cosine
        xz = mass * x * z + x * up + z * along * sine + aslant * sine
        yz = mass * y * z + y * up + z * along * cosine + aslant * cosine
        rows = [[xx, side * xy, xz], [side * xy, yy, side * yz], [xz, side * yz, zz]]
        second += np.array([[entry + zero for entry in row] for row in rows])
    whole = robot.mass + 2.0 * mass
    center = (robot.mass * np.asarray(robot.com)[:, None] + first) / whole
    held = np.asarray(robot.inertia)
    held = np.trace(held) / 2.0 * np.eye(3) - held + robot.mass * np.outer(robot.com, robot.com)
    moments = held[:, :, None] + second - whole * center[:, None] * center[None]
    return np.trace(moments) * np.eye(3)[:, :, None] - moments


def let_go(inertia, coupling, shares, chord):
    """An axis that the wheels do not reach follows the other one, if it ends level in a degree."""
    follows = np.abs(coupling) / inertia * chord <= np.radians(1.0)
    free = (shares <= 1e-9) & follows
    less = np.where(free, coupling**2 / inertia, 0.0)[::-1]
    return inertia - less, np.where(free.any(axis=0), 0.0, coupling)


def wheels_of(half):
    """Of the left and the right wheel, from half the difference and half the sum."""
    return np.stack([half[1] + half[0], half[1] - half[0]])


def compliance_of(inertia, coupling, shares):
    """A' J^-1 A, rows and columns by wheel."""
    determinant = inertia[0] * inertia[1] - coupling**2
    inverse = np.array([[inertia[1], -coupling], [-coupling, inertia[0]]]) / determinant
    axes = np.array([[shares[0], -shares[0]], [shares[1], shares[1]]])
    return np.einsum("ian,ijn,jbn->abn", axes, inverse, axes)
