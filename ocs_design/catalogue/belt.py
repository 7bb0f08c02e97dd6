"""A timing belt over two pulleys: what its geometry makes of mass, inertia and torque.

Nothing here is measured. Pulleys are solid discs of the pitch diameter, a flange's thickness
wider than the belt on either side; the belt is the shortest that clears them. Webbed pulleys are
lighter.
"""

import math
from dataclasses import dataclass

from ocs_design.drive.gear import GearRoom

FLANGE = 1e-3
"""Thickness of one of a pulley's two flanges [m]."""

CLEARANCE = 5e-3
"""Least distance between the pitch circles of the two pulleys [m]."""

TEETH_IN_MESH = 6
"""On the smaller pulley, below which a fifth of the working tension is lost per tooth
(SDP/SI, Handbook of timing belts, section 13.3)."""

LOSS_PER_TOOTH = 0.2


@dataclass(frozen=True)
class BeltStage:
    """A belt and its two pulleys.

    Attributes:
        motor_teeth, wheel_teeth: of the pulleys on the motor and on the wheel.
        pitch: of the teeth [m].
        width: of the belt [m].
        belt_density: mass of the belt per length [kg/m].
        pulley_density: of the pulleys' material [kg/m^3].
        working_tension: that the belt stands for good, at its width [N].
    """

    motor_teeth: int
    wheel_teeth: int
    pitch: float
    width: float
    belt_density: float
    pulley_density: float
    working_tension: float

    @property
    def ratio(self) -> float:
        """N, motor speed over wheel speed."""
        return self.wheel_teeth / self.motor_teeth

    @property
    def motor_radius(self) -> float:
        """Pitch radius of the motor's pulley [m]."""
        return self.pitch * self.motor_teeth / (2.0 * math.pi)

    @property
    def wheel_radius(self) -> float:
        """Pitch radius of the wheel's pulley [m]."""
        return self.pitch * self.wheel_teeth / (2.0 * math.pi)

    @property
    def mass(self) -> float:
        """Of belt and pulleys [kg]."""
        pulleys = self._pulley_mass(self.motor_radius) + self._pulley_mass(self.wheel_radius)
        return pulleys + self.belt_mass

    @property
    def belt_mass(self) -> float:
        """Of the shortest belt with whole teeth that clears the pulleys [kg]."""
        teeth = math.ceil(self._least_length() / self.pitch)
        return teeth * self.pitch * self.belt_density

    @property
    def inertia(self) -> float:
        """Of pulleys and belt, seen at the wheel [kg m^2].

        The motor's pulley turns N times as fast; the belt runs at the wheel's speed times its
        pulley's radius.
        """
        motor = self._pulley_mass(self.motor_radius) * self.motor_radius**2 / 2.0
        wheel = self._pulley_mass(self.wheel_radius) * self.wheel_radius**2 / 2.0
        return wheel + self.ratio**2 * motor + self.belt_mass * self.wheel_radius**2

    @property
    def torque_max(self) -> float:
        """At the wheel, at the working tension and with the teeth that mesh [N m]."""
        missing = max(0, TEETH_IN_MESH - self.teeth_in_mesh)
        share = max(0.0, 1.0 - LOSS_PER_TOOTH * missing)
        return share * self.working_tension * self.wheel_radius

    @property
    def teeth_in_mesh(self) -> int:
        """Whole teeth of the smaller pulley that the belt wraps."""
        wrap = math.pi - 2.0 * self._slope()
        return int(min(self.motor_teeth, self.wheel_teeth) * wrap / (2.0 * math.pi))

    def wheel_speed_max(self, belt_speed_max: float) -> float:
        """At which the belt runs at `belt_speed_max` [m/s]; [rad/s]."""
        return belt_speed_max / self.wheel_radius

    @property
    def room(self) -> GearRoom:
        """That it takes, the motor's axis beside the wheel's, its mass without axle and bearings.

        The pulleys are where they are as wide as their flanges, with no gap on either side.
        """
        motor = self._pulley_mass(self.motor_radius)
        moment = motor * self._least_distance() + self.belt_mass * self._least_distance() / 2.0
        return GearRoom(
            depth=self.width + 2.0 * FLANGE,
            offset=self._least_distance(),
            wheel_radius=self.wheel_radius,
            motor_radius=self.motor_radius,
            center=moment / self.mass,
        )

    def _pulley_mass(self, radius: float) -> float:
        return self.pulley_density * math.pi * radius**2 * (self.width + 2.0 * FLANGE)

    def _least_distance(self) -> float:
        return self.motor_radius + self.wheel_radius + CLEARANCE

    def _slope(self) -> float:
        """Angle of the free spans to the line between the axes [rad]."""
        return math.asin(abs(self.wheel_radius - self.motor_radius) / self._least_distance())

    def _least_length(self) -> float:
        """Of the belt about the pitch circles at their least distance [m].

        `2 C cos s + pi (R + r) + 2 s (R - r)`, `sin s = (R - r) / C`.
        """
        slope, sum_of_radii = self._slope(), self.motor_radius + self.wheel_radius
        difference = abs(self.wheel_radius - self.motor_radius)
        free = 2.0 * self._least_distance() * math.cos(slope)
        return free + math.pi * sum_of_radii + 2.0 * slope * difference
