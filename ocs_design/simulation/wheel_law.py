"""The wheel law of the paper, within the motors' limits, for a batch of worlds at once.

While the robot stands, the wheels are braked down so that they can take up momentum again.

`tau_fb = -I_r (K_p e + K_d e_dot) - w x (I_r w)`, `u = C^T tau_fb` (paper, section 3.3), with what
docs/theory.md adds: the motor torque acts on the wheel and its reaction on the trunk; the
wheels' own momentum is compensated; the pseudo-inverse gives the commanded torque where the
paper's transpose gives it scaled by `C C^T`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import RESERVE, Drive, power_less_friction
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.requirement.froude import Scale
from ocs_design.robot.robot import Robot
from ocs_design.simulation import quaternions
from ocs_design.sizing.trajectory.gyrostat import OUT_OF_REACH, Gyrostat


def clipped(
    torque: FloatArray,
    speed: FloatArray,
    *,
    gain: FloatArray,
    line_slope: FloatArray,
    no_load_speed: FloatArray,
    torque_limit: FloatArray,
    speed_max: FloatArray | float = np.inf,
) -> FloatArray:
    """Torques cut to current limit, voltage line and top speed at the end of the control step.

    Both taken at the end, at `W + tau * gain`, are backward Euler: the exact line as the period
    goes to zero, stable for any motor, and a wheel just keeps from passing its top speed. They cut
    driving torque and leave braking.

    Args:
        torque: asked for [N m]. speed: of the wheels now [rad/s].
        gain: change of speed in a control step per torque [rad/s/(N m)].
        line_slope, no_load_speed, torque_limit, speed_max: see `MotorLimits`.
    """
    give = gain + line_slope
    highest = np.minimum((no_load_speed - speed) / give, (speed_max - speed) / gain)
    lowest = np.maximum((-no_load_speed - speed) / give, (-speed_max - speed) / gain)
    driven = np.minimum(np.maximum(torque, lowest), highest)
    return np.minimum(np.maximum(driven, -torque_limit), torque_limit)


def bus_power(
    torque: FloatArray,
    speed: FloatArray,
    *,
    copper: FloatArray | float,
    efficiency: FloatArray | float,
) -> FloatArray:
    """Power of all motors of a world at the bus [W], shape (n,): R i^2, and what the shafts take.

    A gear's loss is drawn where its motor drives and lost where it brakes.

    Args:
        torque, speed: of the wheels [N m, rad/s], shape (n, wheels).
        copper, efficiency: see `MotorLimits`.
    """
    shaft = torque * speed
    taken = np.maximum(shaft / efficiency, shaft * efficiency)
    power: FloatArray = (copper * torque**2 + taken).sum(axis=-1)
    return power


def within_supply(
    torque: FloatArray,
    speed: FloatArray,
    *,
    gain: FloatArray,
    copper: FloatArray,
    efficiency: FloatArray,
    power_max: FloatArray,
) -> FloatArray:
    """Torques of a world, all scaled down alike until the supply can give or take their power.

    Held torques speed wheels up and let them take more and more: a control step draws most at its
    end and feeds back most at its start. With all torques times f, the power at the end is convex
    in f and zero at f = 0; each of its parts is `a f^2 + b f`, which is P at 2 P / (b + root).

    Args:
        torque: that the motors could give [N m], (..., wheels).
        speed: of the wheels now [rad/s], broadcast to that.
        gain: change of speed in a control step per torque [rad/s/(N m)], shape (..., 1).
        copper, efficiency, power_max: see `MotorLimits`, shape (..., 1).
    """
    limit, shaft = np.minimum(power_max[..., 0], _ENDLESS), torque * speed
    heat = (copper * torque**2).sum(axis=-1)
    factor = np.ones_like(heat)
    for _ in range(torque.shape[-1] + 1):
        # A motor that brakes at the start may drive at the end: each change takes another look.
        ends = factor[..., None] * gain * torque**2 + shaft
        share = np.where(ends > 0.0, 1.0 / efficiency, efficiency)
        square = heat + (share * gain * torque**2).sum(axis=-1)
        factor = np.minimum(factor, _reaching(limit, square, (share * shaft).sum(axis=-1)))
    share = np.where(shaft > 0.0, 1.0 / efficiency, efficiency)
    given = (share * shaft).sum(axis=-1)
    # Beyond the larger root, more torque burns what it brakes in the windings.
    root = np.sqrt(np.maximum(given**2 - 4.0 * heat * limit, 0.0))
    feeds = factor * (heat * factor + given) < -limit
    least = 2.0 * limit / np.where(feeds, root - given, 1.0)
    scaled: FloatArray = torque * np.where(feeds, np.minimum(factor, least), factor)[..., None]
    return scaled


def _reaching(limit: FloatArray, square: FloatArray, linear: FloatArray) -> FloatArray:
    """Factor f up to which `square f^2 + linear f` is within a limit; inf: all."""
    depth = linear + np.sqrt(linear**2 + 4.0 * square * limit)
    return np.where(depth > 0.0, 2.0 * limit / np.where(depth > 0.0, depth, 1.0), np.inf)


_ENDLESS = 1e100
"""Stands for a power without limit: its products with others are finite [W]."""


USED = 0.99
"""Share of voltage and of the supply's power that the law uses: what else turns the wheels within a
control step, as the trunk hits the ground, changes speed and power by less than the rest."""


@dataclass(frozen=True)
class MotorLimits:
    """Limits of a motor at its wheel (docs/theory.md, What a motor can do).

    Attributes:
        no_load_speed: where the line ends that friction leaves [rad/s]; inf: not limited.
        line_slope: speed lost per torque on the voltage line, w_0 / tau_s [rad/s/(N m)]; 0 where no
            stall torque is given: full torque up to w_0.
        torque_limit: at the current limit [N m]; inf: not limited.
        speed_max: mechanical [rad/s]; inf: not limited.
        copper: heat in the winding over the squared torque, R / (N eta k_t)^2 [W/(N m)^2].
        efficiency: of the gear.
        power_max: of the supply, for all motors together, without what their friction takes at the
            most [W]; inf: not limited.
        voltage: of the supply [V]; None: the winding or the supply is not known.
    """

    no_load_speed: float
    line_slope: float
    torque_limit: float
    speed_max: float = np.inf
    copper: float = 0.0
    efficiency: float = 1.0
    power_max: float = np.inf
    voltage: float | None = None

    @classmethod
    def of(cls, motor: Drive, supply: Supply | None = None, wheels: int = 1) -> "MotorLimits":
        """The limits of a catalogue or assumed motor.

        Args:
            motor: see `Drive`.
            supply: that feeds all motors; None: nothing is known of it.
            wheels: how many motors it feeds.
        """
        limit = np.inf if motor.torque_limit is None else motor.torque_limit
        top = np.inf if motor.speed_max is None else motor.speed_max
        line = cls(motor.no_load_speed, 0.0, limit, top)
        if motor.stall_torque is not None and np.isinf(motor.no_load_speed):
            line = cls(np.inf, 0.0, min(limit, motor.stall_torque), top)
        elif motor.stall_torque is not None:
            line = replace(
                line,
                no_load_speed=motor.line_left * motor.no_load_speed,
                line_slope=motor.no_load_speed / motor.stall_torque,
            )
        if supply is None or motor.resistance is None or motor.torque_constant is None:
            return line
        per_current = motor.gear_ratio * motor.gear_efficiency * motor.torque_constant
        return replace(
            line,
            copper=motor.resistance / per_current**2,
            efficiency=motor.gear_efficiency,
            power_max=power_less_friction(supply, wheels, motor, line.torque_limit / per_current),
            voltage=supply.voltage,
        )

    @property
    def is_finite(self) -> bool:
        """Whether the torque has a limit at every speed."""
        return bool(np.isfinite(self.torque_limit) or self.line_slope > 0.0)

    def reserved(self) -> "MotorLimits":
        """What a reference may take; the rest of voltage, current and speed is for the feedback."""
        return replace(
            self,
            no_load_speed=RESERVE * self.no_load_speed,
            torque_limit=RESERVE * self.torque_limit,
            speed_max=RESERVE * self.speed_max,
            power_max=RESERVE * self.power_max,
        )

    def torque_range(self, speed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest torque at each wheel speed [rad/s], shapes as that [N m].

        On the voltage line, within the current limit; none that drives the wheel beyond its top
        speed.
        """
        # No slope: all or nothing on either side of the line's end.
        with np.errstate(divide="ignore", invalid="ignore"):
            highest = np.nan_to_num((self.no_load_speed - speed) / self.line_slope, posinf=np.inf)
            lowest = np.nan_to_num((-self.no_load_speed - speed) / self.line_slope, neginf=-np.inf)
        highest = np.where(speed < self.speed_max, highest, np.minimum(highest, 0.0))
        lowest = np.where(speed > -self.speed_max, lowest, np.maximum(lowest, 0.0))
        limit = self.torque_limit
        return np.clip(lowest, -limit, limit), np.clip(highest, -limit, limit)

    def utilisation(self, speed: FloatArray, torque: FloatArray) -> float:
        """The largest share of bus voltage, current, power or top speed that a motion takes.

        At most 1 for what motor and supply can do: `|W + slope * tau| <= w_0`, `|tau| <= tau_L`,
        `|W| <= speed_max` and a power of all wheels together of at most `power_max` either way.
        """
        voltage = np.abs(speed + self.line_slope * torque).max() / self.no_load_speed
        current = np.abs(torque).max() / self.torque_limit
        power = 0.0
        if np.isfinite(self.power_max):
            power = np.abs(self.bus_power(speed, torque)).max() / self.power_max
        return float(max(voltage, current, np.abs(speed).max() / self.speed_max, power))

    def bus_power(self, speed: FloatArray, torque: FloatArray) -> FloatArray:
        """Power of all motors at the bus [W], see `bus_power`."""
        return bus_power(torque, speed, copper=self.copper, efficiency=self.efficiency)


class Allocation(StrEnum):
    """How a torque on the trunk is shared between the wheels."""

    PSEUDO_INVERSE = "pseudo-inverse"
    TRANSPOSE = "transpose"


@dataclass(frozen=True)
class Gains:
    """Gains of the attitude error per unit of inertia: `stiffness` [1/s^2], `damping` [1/s]."""

    stiffness: float
    damping: float


@dataclass(frozen=True, eq=False)
class WheelLaw(Table):
    """The law's constants for n worlds of m wheels each; every array has the worlds first.

    Attributes:
        momentum_map: `[I_tot, h A]`, from trunk rate and wheel speeds to momentum,
            shape (n, 3, 3 + m).
        torque_map: from roll and pitch acceleration and the gyroscopic torque to motor torques,
            shape (n, m, 5).
        heading_map: from yaw acceleration to motor torques, shape (n, m); zero where the wheels do
            not span all three axes.
        stiffness, damping: `Gains`, shape (n,).
        standing_stiffness, standing_damping: in their place on the ground, shape (n,).
        line_slope, torque_limit, speed_max: see `MotorLimits`, shape (n,).
        copper, efficiency: likewise. no_load_speed, power_max: that the law uses [rad/s, W], (n,).
        wheel_response: see `Gyrostat`, shape (n,).
    """

    momentum_map: FloatArray
    torque_map: FloatArray
    heading_map: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    no_load_speed: FloatArray
    line_slope: FloatArray
    torque_limit: FloatArray
    speed_max: FloatArray
    copper: FloatArray
    efficiency: FloatArray
    power_max: FloatArray
    wheel_response: FloatArray
    standing_stiffness: FloatArray
    standing_damping: FloatArray

    @classmethod
    def of(
        cls,
        body: Gyrostat,
        gains: Gains,
        limits: MotorLimits,
        allocation: Allocation,
        *,
        balances: bool = False,
    ) -> "WheelLaw":
        """The law of one world (n = 1); `balances`: the wheels hold the attitude in stance too."""
        momentum_map = np.hstack([body.inertia, body.spin_inertia * body.axes])
        shared = body.axes.T / body.reaction if allocation is Allocation.TRANSPOSE else body.sharing
        # `J w_dot = -g A tau - w x H`, g the reaction (see `Gyrostat`), solved for tau.
        J = body.actuated_inertia
        from_tilt, from_gyroscopic, from_yaw = J[:, :2], np.eye(3), J[:, 2]
        if np.linalg.matrix_rank(body.axes, OUT_OF_REACH) < len(J):
            # The wheels cannot push about z, so its row is no command but says which yaw
            # acceleration comes with the other two.
            yaw = J[:, 2:] / J[2, 2]
            from_tilt = J[:, :2] - yaw @ J[2:, :2]
            from_gyroscopic = np.eye(3) - yaw @ np.array([[0.0, 0.0, 1.0]])
            from_yaw = np.zeros(3)
        torque_map = -shared @ np.hstack([from_tilt, from_gyroscopic])
        return cls(
            momentum_map[None],
            torque_map[None],
            (-shared @ from_yaw)[None],
            np.array([gains.stiffness]),
            np.array([gains.damping]),
            np.array([USED * limits.no_load_speed]),
            np.array([limits.line_slope]),
            np.array([limits.torque_limit]),
            np.array([limits.speed_max]),
            np.array([limits.copper]),
            np.array([limits.efficiency]),
            np.array([USED * limits.power_max]),
            np.array([body.wheel_response]),
            np.array([gains.stiffness if balances else 0.0]),
            np.array([gains.damping]),
        )

    @classmethod
    def off(cls, wheels: int) -> "WheelLaw":
        """No torque, in one world."""
        one, none = np.ones(1), np.zeros(1)
        maps = np.zeros((1, 3, 3 + wheels)), np.zeros((1, wheels, 5)), np.zeros((1, wheels))
        return cls(*maps, none, none, one, one, none, one, none, one, np.inf * one, one, none, none)

    @property
    def is_off(self) -> bool:
        """Whether none of the motors ever pushes."""
        return not self.torque_limit.any()

    def torque(
        self,
        vertical: FloatArray,
        rate: FloatArray,
        wheel_speed: FloatArray,
        target: "Target",
        period: float,
        *,
        attitude: FloatArray | None = None,
    ) -> FloatArray:
        """Motor torque on each wheel [N m], shape (n, m).

        Args:
            vertical: the world's upward direction in B, unit vectors (n, 3).
            rate: of the trunk in B [rad/s], (n, 3).
            wheel_speed: relative to the trunk [rad/s], (n, m).
            target: where the trunk should be.
            period: for which the torque will be held [s].
            attitude: quaternions (n, 4), where the target has a regulated plan.
        """
        error = tilt_error(vertical, target.vertical)
        slip = target.rate - rate
        stiffness = np.where(target.stands, self.standing_stiffness, self.stiffness)
        damping = np.where(target.stands, self.standing_damping, self.damping)
        change = damping[:, None] * slip
        wanted = stiffness[:, None] * error + change[:, :2] + target.acceleration[:, :2]
        yaw = change[:, 2:] + target.acceleration[:, 2:]
        gyroscopic = self.gyroscopic(rate, wheel_speed)
        torque = np.einsum(
            "nij,nj->ni", self.torque_map, np.concatenate([wanted, gyroscopic], axis=1)
        )
        asked = torque + self.heading_map * yaw + target.torque
        if target.plan is not None and attitude is not None:
            planned = target.plan.torque(attitude, rate, wheel_speed)
            asked = np.where(target.plan.holds[:, None], planned, asked)
        if target.shared is not None:
            asked = np.einsum("nij,nj->ni", target.shared, asked)
        return self.within_supply(
            self.within_motors(asked, wheel_speed, period), wheel_speed, period
        )

    def within_motors(
        self, torque: FloatArray, wheel_speed: FloatArray, period: float
    ) -> FloatArray:
        """Torques cut to what each motor can give, see `clipped`; shapes as of `torque`."""
        return clipped(
            torque,
            wheel_speed,
            gain=(self.wheel_response * period)[:, None],
            line_slope=self.line_slope[:, None],
            no_load_speed=self.no_load_speed[:, None],
            torque_limit=self.torque_limit[:, None],
            speed_max=self.speed_max[:, None],
        )

    def within_supply(
        self, torque: FloatArray, wheel_speed: FloatArray, period: float
    ) -> FloatArray:
        """Torques of the motors cut to what the supply can give, see the function of that name."""
        if np.isinf(self.power_max).all():
            return torque
        return within_supply(
            torque,
            wheel_speed,
            gain=(self.wheel_response * period)[:, None],
            copper=self.copper[:, None],
            efficiency=self.efficiency[:, None],
            power_max=self.power_max[:, None],
        )

    def gyroscopic(self, rate: FloatArray, wheel_speed: FloatArray) -> FloatArray:
        """`w x (I_tot w + h A W)` [N m], shape (n, 3), or (k, 3) of k states of a single world."""
        momentum = np.einsum(
            "nij,nj->ni", self.momentum_map, np.concatenate([rate, wheel_speed], axis=1)
        )
        return _cross(rate, momentum)


@dataclass(frozen=True, eq=False)
class RegulatedPlan(Table):
    """Planned states of n worlds at one instant, and the gains that keep a trunk on them.

    Attributes:
        attitude: quaternions (n, 4). rate: in B [rad/s], (n, 3). wheel_speed: [rad/s], (n, m).
        wheel_torque: of the motors [N m], (n, m).
        gains: see `Trajectory`, (n, m, 6 + m).
        holds: whether a world follows such a plan now, (n,).
    """

    attitude: FloatArray
    rate: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    gains: FloatArray
    holds: NDArray[np.bool_]

    def torque(self, attitude: FloatArray, rate: FloatArray, speed: FloatArray) -> FloatArray:
        """Planned torque less the gains times the errors [N m], shape (n, m)."""
        off = quaternions.product(quaternions.conjugate(self.attitude), attitude)
        error = np.concatenate(
            [quaternions.rotation_vector(off), rate - self.rate, speed - self.wheel_speed], axis=1
        )
        taken_off: FloatArray = np.einsum("nij,nj->ni", self.gains, error)
        return self.wheel_torque - taken_off


@dataclass(frozen=True, eq=False)
class Target:
    """Attitude and rate that n trunks should have at one instant.

    Attributes:
        vertical: the world's upward direction in B, unit vectors (n, 3). The heading
            is free.
        rate, acceleration: in B [rad/s, rad/s^2], shape (n, 3); about yaw they count where the
            wheels span all three axes.
        torque: of the motors, on top of what the acceleration and the gyroscopic torque of the
            moment ask for [N m], shape (n, m).
        stands: whether the feet are on the ground, shape (n,). Three legs and more then hold the
            attitude and the wheels only damp: whatever the stance leans by, wheels that push
            against it run up to their top speed and are of no use any more.
        plan: that worlds follow with gains of their own in place of all this; None: none does.
        shared: what each motor gives of what all are asked for, shape (n, m, m), where drives have
            stopped (`shared_by_others`); None: all run.
    """

    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    stands: NDArray[np.bool_]
    plan: RegulatedPlan | None = None
    shared: FloatArray | None = None

    def landed(self, contact: NDArray[np.bool_]) -> "Target":
        """Target with the worlds at rest whose feet are on the ground, as plans end there."""
        left, plan = ~contact[:, None], self.plan
        return Target(
            self.vertical,
            self.rate * left,
            self.acceleration * left,
            self.torque * left,
            self.stands | contact,
            None if plan is None else replace(plan, holds=plan.holds & ~contact),
        )


@dataclass(frozen=True)
class StoppedDrive:
    """A drive that stops in flight: its motor gives no torque, and its wheel runs on.

    Attributes:
        wheel: which, from 0. instant: from lift-off or release [s].
        detection: from then until the law knows of it [s].
    """

    wheel: int
    instant: float
    detection: float


def tilt_error(vertical: FloatArray, target: FloatArray) -> FloatArray:
    """Turn about roll and pitch that takes the trunk to its target [rad], in B, shape (n, 2).

    The attitude error in SO(3) after the target is turned about the vertical to the heading that
    the trunk has: two wheels cannot command yaw, and a heading that drifts must not twist roll and
    pitch. What is left is the swing of the swing-twist split: the smallest turn that brings the
    vertical, as seen from the trunk, to where the target sees it.

    Args:
        vertical: the world's upward direction as seen from the trunk, unit vectors (n, 3).
        target: the same as the target sees it, (n, 3).
    """
    axis = _cross(target, vertical)
    sine = np.sqrt((axis * axis).sum(axis=1))
    angle = np.arctan2(sine, (target * vertical).sum(axis=1))
    # Added, not taken for a largest: no branch, and representable in single precision too.
    error: FloatArray = axis[:, :2] * (angle / (sine + 1e-30))[:, None]
    return error


def _cross(left: FloatArray, right: FloatArray) -> FloatArray:
    """Row-wise cross product, shape (n, 3); on small batches five times as fast as `np.cross`."""
    a, b, c = left.T
    x, y, z = right.T
    result = np.empty_like(left)
    result[:, 0] = b * z - c * y
    result[:, 1] = c * x - a * z
    result[:, 2] = a * y - b * x
    return result


SETTLING = 0.25
"""Time on the ground before braking starts, of Solo12 [s]."""

BRAKING = 0.5
"""Time constant of the wheels' speed, of Solo12 [s]."""

SUPPORT = 0.05
"""Largest torque of a wheel over weight times standing height: the feet stay down."""


@dataclass(frozen=True)
class Desaturation:
    """How the wheels of one world are braked while it stands.

    The law damps the trunk meanwhile: the feet take up what the wheels let go.

    Attributes:
        settling: on the ground before it starts [s].
        damping: torque per wheel speed [N m s/rad]. torque_max: [N m].
    """

    settling: float
    damping: float
    torque_max: float

    @classmethod
    def of(
        cls, robot: Robot, standing: float, spin_inertia: float, gravity: float
    ) -> "Desaturation":
        """Settings with times scaled to the robot, and a torque that its weight outdoes."""
        time = Scale.of(robot).time(STANDARD_GRAVITY)
        return cls(
            SETTLING * time,
            spin_inertia / (BRAKING * time),
            SUPPORT * robot.mass * gravity * standing,
        )


def braking(
    speed: FloatArray,
    stood: FloatArray,
    *,
    settling: FloatArray,
    damping: FloatArray,
    torque_max: FloatArray,
) -> FloatArray:
    """Torque that brakes wheels while the robot stands [N m], shape (n, wheels).

    Args:
        speed: of the wheels [rad/s], shape (n, wheels).
        stood: time on the ground [s], shape (n, 1).
        settling, damping, torque_max: see `Desaturation`, shape (n, 1).
    """
    wanted = np.minimum(np.maximum(-damping * speed, -torque_max), torque_max)
    return np.where(stood >= settling, wanted, 0.0)


class WheelBrake:
    """Braking of the wheels of n worlds, with the time that each has stood."""

    def __init__(self, own: Sequence[Desaturation | None], period: float) -> None:
        """Brakes of worlds that decide every `period` [s]."""
        idle = Desaturation(np.inf, 0.0, 0.0)
        rows = [idle if each is None else each for each in own]
        self._settling = np.array([[each.settling] for each in rows])
        self._damping = np.array([[each.damping] for each in rows])
        self._largest = np.array([[each.torque_max] for each in rows])
        self._stood, self._period = np.zeros(len(rows)), period

    def added(self, target: Target, speed: FloatArray, contact: NDArray[np.bool_]) -> Target:
        """The target with the braking torque on top.

        Args:
            target: of the first n worlds. speed: of their wheels [rad/s], shape (n, m).
            contact: whether each has just touched the floor, shape (n,).
        """
        n = len(speed)
        self._stood[:n] = np.where(contact, self._stood[:n] + self._period, 0.0)
        torque = braking(
            speed,
            self._stood[:n, None],
            settling=self._settling[:n],
            damping=self._damping[:n],
            torque_max=self._largest[:n],
        )
        return replace(target, torque=target.torque + torque)
