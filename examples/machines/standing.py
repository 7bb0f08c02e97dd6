"""Bodies of machines that stand, without the wheels that they were built with.

    python examples/machines/standing.py

prints what the specifications beside this file state: the device that the tool sizes is put in the
place of the wheels as built, so each wheel and its motor are taken out of the machine first, the
motor as a point in the middle of its wheel. Sources: docs/machines.md.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

GRAVITY = 9.81


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body.

    Attributes:
        mass: [kg]. com: centre of mass [m], shape (3,).
        inertia: about it [kg m^2], shape (3, 3).
    """

    mass: float
    com: NDArray[np.float64]
    inertia: NDArray[np.float64]

    @classmethod
    def of(cls, mass: float, com: ArrayLike, inertia: ArrayLike) -> "Body":
        """A body of a diagonal inertia."""
        return cls(mass, np.asarray(com, dtype=float), np.diag(np.asarray(inertia, dtype=float)))

    def __add__(self, other: "Body") -> "Body":
        mass = self.mass + other.mass
        com = (self.mass * self.com + other.mass * other.com) / mass
        inertia = np.zeros((3, 3))
        for body in (self, other):
            arm = body.com - com
            own = body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
            inertia = inertia + body.inertia + own
        return Body(mass, com, inertia)

    def __sub__(self, other: "Body") -> "Body":
        return self + Body(-other.mass, other.com, -other.inertia)


@dataclass(frozen=True, eq=False)
class Machine:
    """A machine that stands.

    Attributes:
        body: without wheels and their motors, from the ground up, z upwards.
        wheels: places of their middles [m], shape (n, 3).
    """

    body: Body
    wheels: NDArray[np.float64]

    @property
    def pivot(self) -> NDArray[np.float64]:
        """Where it stands, from the body's centre of mass [m], shape (3,)."""
        return -self.body.com

    @property
    def positions(self) -> NDArray[np.float64]:
        """Places of the wheels from the body's centre of mass [m], shape (n, 3)."""
        return self.wheels - self.body.com


def wheelbot() -> Machine:
    """Wheelbot v2.5 (s00_config.m of its simulation; the motor's mass is T-Motor's)."""
    low, middle, high = 0.053, 0.053 + 0.055, 0.053 + 2.0 * 0.055
    chassis = Body.of(0.75, (0.0, 0.0, middle), (0.001746, 0.00181, 0.001585))
    wheel = Body.of(0.3, (0.0, 0.0, low), (0.000259, 0.000503, 0.000259))
    motor = Body.of(0.180, (0.0, 0.0, high), np.zeros(3))
    return Machine(chassis + wheel - motor, np.array([[0.0, 0.0, high]]))


def mini_wheelbot() -> Machine:
    """Mini Wheelbot (sysid_nonlinear.py of its library).

    Its ring of brass is bonded around the motor's rotor, so that only the stator stays in the body,
    which is counted twice.
    """
    low, middle, high = 0.032, 0.032 + 0.065, 0.032 + 2.0 * 0.065
    body = Body.of(0.312, (0.0, 0.0, middle), (220e-6, 300e-6, 190e-6))
    wheel = Body.of(0.129, (0.0, 0.0, low), (53e-6, 100e-6, 53e-6))
    return Machine(body + wheel, np.array([[0.0, 0.0, high]]))


def aalborg_cubli() -> Machine:
    """Cubli of Aalborg University (chapters 4, 6 and 11 of the report of group 630).

    The inertia of its frame is known about the edge alone; its motor's mass is not known.
    """
    mass, to_frame, to_wheel = 0.548, 0.08498, 0.096
    own = 4.8e-3 - mass * to_frame**2
    return Machine(
        Body.of(mass, (0.0, 0.0, to_frame), (own, own, own)), np.array([[0.0, 0.0, to_wheel]])
    )


REX_HOPPER = Body(
    8.1969,
    np.array([0.0, 0.0, 0.45 + 0.0057]),
    np.array(
        [
            [0.094486, -0.000759, -0.003665],
            [-0.000759, 0.052991, -0.000289],
            [-0.003665, -0.000289, 0.090413],
        ]
    ),
)
"""Revision 10 on its leg stretched to 0.45 m: all links of its MJCF together."""


def rex_hopper(*, yaw: bool = True) -> Machine:
    """REx Hopper without the two wheels for roll and pitch.

    Args:
        yaw: whether the third wheel, which is for yaw, stays in.
    """
    places = np.array([[0.0566, 0.1372, 0.45], [0.0566, -0.1372, 0.45]])
    body = REX_HOPPER
    for place in places:
        # Spin and transverse inertia of a wheel under 45 degrees, about roll, pitch and yaw.
        across = (6.60959e-3 + 3.3873e-3) / 2.0
        body = body - Body.of(0.78203, place, (across, across, 3.3873e-3))
        body = body - Body.of(0.731, place, np.zeros(3))
    if not yaw:
        place = np.array([-0.076, 0.0, 0.45 + 0.086])
        body = body - Body.of(0.329528, place, (4.3238e-4, 4.3238e-4, 8.2888e-4))
        body = body - Body.of(0.354, place, np.zeros(3))
        places = np.concatenate([places, place[None]])
    return Machine(body, places)


MACHINES = {
    "wheelbot": wheelbot(),
    "mini_wheelbot": mini_wheelbot(),
    "aalborg_cubli": aalborg_cubli(),
    "rex_hopper": rex_hopper(),
    "rex_hopper_flight": rex_hopper(yaw=False),
}


@dataclass(frozen=True)
class Push:
    """The largest push that someone who walks takes without stepping aside.

    Attributes:
        mass: [kg]. height_of_mass: of the centre of mass [m].
        shift: of the centre of pressure under the foot, which the ankle makes [m].
    """

    mass: float
    height_of_mass: float
    shift: float = 0.02

    @property
    def impulse(self) -> float:
        """m sqrt(g / l) times the shift [N s]: how far the extrapolated centre of mass may go."""
        return self.mass * sqrt(GRAVITY / self.height_of_mass) * self.shift


def main() -> None:
    """Print bodies, places and pivots."""
    for name, machine in MACHINES.items():
        body = machine.body
        print(f"{name}: mass {body.mass:.4f} kg, inertia [kg m2]")
        print(np.array2string(body.inertia, precision=7, suppress_small=True))
        for what, rows in (("wheel", machine.positions), ("pivot", machine.pivot[None])):
            for row in rows:
                print(f"  {what} at {', '.join(f'{1e3 * x:.1f}' for x in row)} mm")


if __name__ == "__main__":
    main()
