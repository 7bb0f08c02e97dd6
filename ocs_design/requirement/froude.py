"""Defaults for any robot: the paper's maneuvers and rim limits for Solo12, Froude-scaled.

Legged robots move alike if v^2 / (g L) is the same (Alexander and Jayes, J. Zool. 201, 1983):
lengths scale with the standing height L of the trunk, times with sqrt(L / g), speeds with
sqrt(g L), and the torque for the same turn with I / T^2.
"""

from dataclasses import dataclass
from math import pi, radians, sqrt

from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import Actuation, Balance, StandUp
from ocs_design.requirement.pushes import Disturbance, Shove
from ocs_design.requirement.turns import Catch, Drop, Flip, TurnTo
from ocs_design.robot.robot import Robot

LUNAR_GRAVITY = 1.62
"""Gravity of the paper's back-flip [m/s^2], which is scaled to the robot but stays on the Moon."""

WHEEL_SPEED_MAX = 7200.0 * pi / 30.0
"""Wheel speed limit without a motor [rad/s]: that of Solo12's Antigravity 4004 KV300 at 24 V."""

RIM_MASS_SHARE = 0.1
"""Largest mass of one rim as a share of the robot's."""

STRESS_SAFETY = 2.0
"""Yield strength over hoop stress at the highest speed, by default."""


SOLO12_HEIGHT = 0.272
"""Height of Solo12's trunk above its soles [m], standing at 80 % of its stretched legs. These four
figures are from examples/solo12.urdf."""

SOLO12_GYRATION_RADIUS = 0.144559814
"""Radius of gyration of the standing Solo12 [m] (`MassProperties.gyration_radius`)."""

SOLO12_ROLL_INERTIA, SOLO12_PITCH_INERTIA = 0.0320385239, 0.0550873600
"""Inertias of the standing Solo12 about its centre of mass [kg m^2]."""


@dataclass(frozen=True)
class FroudeScale:
    """Size of a robot relative to Solo12; all ratios are 1 for Solo12 itself.

    Attributes:
        length: ratio of standing heights; of radii of gyration for a robot without legs.
        roll_inertia, pitch_inertia: ratios of the robots' inertias.
    """

    length: float
    roll_inertia: float
    pitch_inertia: float

    @classmethod
    def of(cls, robot: Robot) -> "FroudeScale":
        """The scale of `robot`."""
        if robot.standing_height is None:
            length = _ratio(robot.mass_properties.gyration_radius, SOLO12_GYRATION_RADIUS)
        else:
            length = _ratio(robot.standing_height, SOLO12_HEIGHT)
        return cls(
            length,
            roll_inertia=_ratio(robot.inertia[0, 0], SOLO12_ROLL_INERTIA),
            pitch_inertia=_ratio(robot.inertia[1, 1], SOLO12_PITCH_INERTIA),
        )

    def time(self, gravity: float) -> float:
        """Ratio of times, sqrt(L / g)."""
        return sqrt(self.length * STANDARD_GRAVITY / gravity)

    def speed(self, gravity: float) -> float:
        """Ratio of speeds, sqrt(g L)."""
        return sqrt(self.length * gravity / STANDARD_GRAVITY)

    @property
    def rim(self) -> float:
        """Ratio of a rim's lengths that scales its spin inertia like the back-flip's demand.

        At the same wheel speed the demand scales with I_yy / T, and the spin inertia of similar
        rims with the fifth power of their lengths. Robots of the same height differ tenfold in
        mass: scaled by height alone, the limits would be too tight for a heavy robot by default.
        """
        return float(f"{(self.pitch_inertia / sqrt(self.length)) ** 0.2:.6g}")


@dataclass(frozen=True)
class Gains:
    """Gains of the attitude error per unit of inertia: `stiffness` [1/s^2], `damping` [1/s]."""

    stiffness: float
    damping: float


PAPER_GAINS = Gains(stiffness=60.0, damping=12.0)
"""K_p and K_d of Solo12, from which those of other robots are scaled unless specified."""


def wheel_gains(robot: Robot, *, kp: float | None = None, kd: float | None = None) -> Gains:
    """Gains as specified, or those of Solo12 with times Froude-scaled to the robot.

    `K_p ~ 1/T^2`, `K_d ~ 1/T`.
    """
    time = FroudeScale.of(robot).time(STANDARD_GRAVITY)
    return Gains(kp or PAPER_GAINS.stiffness / time**2, kd or PAPER_GAINS.damping / time)


def _ratio(figure: float, reference: float) -> float:
    """`figure / reference` to six digits: postures are solved to nine, and Solo12 must give 1."""
    return float(f"{figure / reference:.6g}")


def standing_height(robot: Robot) -> float:
    """Height of the trunk above the ground [m]; scaled from Solo12's for a robot without legs."""
    if robot.standing_height is not None:
        return robot.standing_height
    return SOLO12_HEIGHT * FroudeScale.of(robot).length


def default_maneuvers(
    robot: Robot, gravity: float = STANDARD_GRAVITY
) -> tuple[Disturbance, Drop, Flip]:
    """The paper's three tests, unchanged for Solo12 and scaled for every other robot.

    The device does all three at one incidence; the paper turns its modules to 0 deg by hand for the
    back-flip.

    Args:
        robot: to scale to.
        gravity: of the first two [m/s^2]; the back-flip is on the Moon.
    """
    scale = FroudeScale.of(robot)
    drop = Drop(name="drop", gravity=gravity, height=1.0 * scale.length, pitch=radians(30.0))
    back_flip = Flip(
        name="back-flip",
        gravity=LUNAR_GRAVITY,
        jump_height=1.0 * scale.length,
        angle=-2.0 * pi,
        duration=2.0 * sqrt(scale.length),
    )
    return _disturbance(scale, gravity), drop, back_flip


def jump_for(
    duration: float | None, height: float | None, default: float, share: float, gravity: float
) -> tuple[float, float]:
    """Duration of a turn and height of its jump [s, m], from whichever of the two is given."""
    if duration is None:
        height = default if height is None else height
        return share * sqrt(8.0 * height / gravity), height
    return duration, gravity * (duration / share) ** 2 / 8.0 if height is None else height


def example_maneuvers(robot: Robot, gravity: float = STANDARD_GRAVITY) -> tuple[Maneuver, ...]:
    """One maneuver of each kind that is not among the paper's tests, as a starting point.

    A shove: the torque of the first test on the standing robot, for twice as long. A quarter turn
    in yaw, on the Moon, and a catch. A balance and a stand-up on the line below the trunk's middle.

    Args:
        robot: to scale to. gravity: of all but the turn [m/s^2].
    """
    scale = FroudeScale.of(robot)
    like, time = _disturbance(scale, gravity), scale.time(gravity)
    quarter, jump = jump_for(3.0 * scale.time(STANDARD_GRAVITY), None, 0.0, 0.9, LUNAR_GRAVITY)
    stop, hop = jump_for(0.5 * time, None, 0.0, 0.9, gravity)
    rate = (0.2 / time, 0.5 / time, 0.0)
    below, forward = (0.0, 0.0, -standing_height(robot)), (0.0, 1.0, 0.0)
    return (
        Shove(
            name="shove",
            gravity=gravity,
            torque=like.torque,
            duration=2.0 * like.duration,
            settling=0.5 * time,
        ),
        TurnTo(
            name="turn", gravity=LUNAR_GRAVITY, yaw=pi / 2.0, duration=quarter, jump_height=jump
        ),
        Catch(name="catch", gravity=gravity, rate=rate, duration=stop, jump_height=hop),
        Balance(
            name="balance",
            gravity=gravity,
            pivot=below,
            edge=forward,
            pitch=radians(5.0),
            duration=1.5 * time,
        ),
        StandUp(
            name="stand up",
            gravity=gravity,
            pivot=below,
            edge=forward,
            pitch=radians(45.0),
            duration=time,
            actuation=Actuation.BRAKE,
        ),
    )


def default_envelope(robot: Robot) -> Envelope:
    """Default limits of a rim: Solo12's 100 mm by 10 mm, scaled with the demand, not rounded."""
    length = FroudeScale.of(robot).rim
    return Envelope(
        outer_radius_max=0.050 * length,
        inner_radius_min=0.005 * length,
        height_max=0.010 * length,
        height_min=0.002 * length,
        wall_min=0.002 * length,
        mass_max=RIM_MASS_SHARE * robot.mass,
        stress_safety=STRESS_SAFETY,
    )


def _disturbance(scale: FroudeScale, gravity: float) -> Disturbance:
    """A torque whose change of the rates is that of the paper's on Solo12, over the ratio of times.

    The paper gives no lift-off speed; 2.4 m/s up is assumed
    (docs/validation.md, Scenarios).
    """
    time, speed = scale.time(gravity), scale.speed(gravity)
    return Disturbance(
        name="disturbance",
        gravity=gravity,
        takeoff_velocity=(0.5 * speed, 2.4 * speed),
        torque=(0.2 * scale.roll_inertia / time**2, 0.8 * scale.pitch_inertia / time**2, 0.0),
        onset=0.1 * time,
        duration=0.05 * time,
    )
