"""What standing up costs a reaction wheel, as a turn in free flight that costs it the same.

    python examples/machines/standing.py

A machine on a foot, tilted by theta_0 and at rest, with the inertia I about its foot and the moment
of gravity G sin(theta), pushes with a constant torque tau of its wheel until it coasts upright:

    I theta_ddot = G sin(theta) - tau

Energy gives where the push may end, G (cos theta_0 - cos theta_1) + tau (theta_0 - theta_1) being
what the coasting takes, G (1 - cos theta_1):

    theta_1 = theta_0 - G (1 - cos theta_0) / tau

The push lasts T, and the wheel has then taken the momentum tau T, whatever its inertia. Without
gravity, a turn from rest to rest with tau one way for T and the other way for T takes the same
torque and the same momentum out of the motor: by tau T^2 / I in 2 T.
"""

from dataclasses import dataclass
from math import cos, degrees, pi, sin, sqrt

from scipy.integrate import quad


@dataclass(frozen=True)
class Standing:
    """A machine that stands on a foot.

    Attributes:
        name: of the machine.
        inertia: I, about the foot, wheel braked [kg m^2].
        gravity_moment: G, weight times height of the centre of mass [N m].
        tilt: theta_0, from which it gets up [rad].
        torque: tau, of its wheel or wheels about the axis of the tilt [N m].
    """

    name: str
    inertia: float
    gravity_moment: float
    tilt: float
    torque: float

    @property
    def push_time(self) -> float:
        """T [s].

        Raises:
            ValueError: the torque does not even hold the machine.
        """
        if self.torque <= self.gravity_moment * sin(self.tilt):
            raise ValueError(f"{self.name}: gravity is stronger than the wheel")
        # With theta = theta_0 - u^2 the rate at the start, zero, is no singularity.
        fallen = self.gravity_moment * (1.0 - cos(self.tilt)) / self.torque
        return float(quad(self._time_per_u, 0.0, sqrt(fallen))[0])

    @property
    def momentum(self) -> float:
        """That the wheel takes [N m s]."""
        return self.torque * self.push_time

    @property
    def turn(self) -> tuple[float, float]:
        """Angle [rad] and duration [s] of the turn without gravity that costs the same."""
        time = self.push_time
        return self.torque * time**2 / self.inertia, 2.0 * time

    def _time_per_u(self, u: float) -> float:
        gravity = self.gravity_moment * (cos(self.tilt) - cos(self.tilt - u * u))
        work = self.torque * u * u + gravity
        return 2.0 * u / sqrt(2.0 * work / self.inertia) if u > 0.0 else self._start

    @property
    def _start(self) -> float:
        """Limit of the integrand at u = 0."""
        net = self.torque - self.gravity_moment * sin(self.tilt)
        return 2.0 * sqrt(self.inertia / (2.0 * net))


GRAVITY = 9.81
SHARE = 0.9
"""Of each motor's torque limit that the push takes; the tool itself plans with 0.95."""


def wheelbot() -> Standing:
    """Wheelbot v2.5 about its roll axis (s00_config.m of its simulation)."""
    wheel, chassis, flywheel = 0.3, 0.75, 0.3  # kg
    low, middle, high = 0.053, 0.053 + 0.055, 0.053 + 2.0 * 0.055  # m
    own = 0.000259 + 0.001746  # kg m^2; the flywheel's spin is its own affair
    return Standing(
        name="Wheelbot v2.5",
        inertia=wheel * low**2 + chassis * middle**2 + flywheel * high**2 + own,
        gravity_moment=GRAVITY * (wheel * low + chassis * middle + flywheel * high),
        tilt=36.0 * pi / 180.0,
        torque=SHARE * 1.2,
    )


def aalborg_cubli() -> Standing:
    """The Cubli of Aalborg University (chapters 4, 6 and 11 of the report of group 630)."""
    frame, wheel, to_frame, to_wheel = 0.548, 0.222, 0.08498, 0.096
    return Standing(
        name="Aalborg Cubli",
        inertia=4.8e-3 + wheel * to_wheel**2,
        gravity_moment=9.82 * (frame * to_frame + wheel * to_wheel),
        tilt=0.17,
        torque=SHARE * 4.0 * 0.0335,
    )


def rex_hopper(own_inertia: float) -> Standing:
    """REx Hopper, revision 10, on its leg stretched to 0.45 m, two wheels at 45 degrees.

    Args:
        own_inertia: of the whole about its centre of mass on this axis [kg m^2].
    """
    mass, height = 8.1969, 0.45 + 0.0057
    return Standing(
        name="REx Hopper",
        inertia=own_inertia + mass * height**2,
        gravity_moment=mass * GRAVITY * height,
        tilt=14.0 * pi / 180.0,
        torque=SHARE * 11.24 * 2.0 * sin(pi / 4.0),
    )


REX_HOPPER_INERTIA = (0.094486, 0.052991)
"""Of revision 10 about roll and pitch, all links of its MJCF together [kg m^2]."""


def main() -> None:
    """Print the turns that the specifications beside this file ask for."""
    roll, pitch = REX_HOPPER_INERTIA
    print("machine         from  push     momentum   the same turn")
    for machine in (wheelbot(), aalborg_cubli(), rex_hopper(roll), rex_hopper(pitch)):
        angle, duration = machine.turn
        print(
            f"{machine.name:14} {degrees(machine.tilt):4.1f} deg  {machine.push_time:.4f} s  "
            f"{machine.momentum:.4f} N m s  {degrees(angle):.3f} deg in {duration:.5f} s"
        )


if __name__ == "__main__":
    main()
