"""Sampled quantities, and the simulated world of a robot that has them."""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray, stacked_columns
from ocs_design.device.bodies import PREFIX
from ocs_design.device.device import Device
from ocs_design.device.layout import Layout
from ocs_design.requirement.boundary import Push
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.uncertainty import (
    Distribution,
    UncertaintySection,
    complete_uncertainty,
    parts_of,
    spreads,
)
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.robot import Robot
from ocs_design.simulation.imperfections import AirDrag, Imperfections
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.schedule import FLIGHT_CONFIRMATION
from ocs_design.simulation.target import StoppedDrive
from ocs_design.simulation.world import World

KEYS = tuple(spreads())


STOPPED, SHARE = STOP_QUANTITIES = ("stopped_drive", "stopped_at")
"""Number of the drive that stops, from 1, and share of the flight at which it stops."""


def quantities(layout: Layout, *, one_stops: bool = False) -> tuple[str, ...]:
    """Names of all numbers sampled for a device with this layout, in order.

    `one_stops`: whether a drive stops in every flight. That is sampled last, so that all other
    values stay the same.
    """
    parts = ((key, part) for key in KEYS for part in parts_of(key, layout.names))
    names = tuple(f"{key}.{part}" if part else key for key, part in parts)
    return (*names, *STOP_QUANTITIES) if one_stops else names


@dataclass(frozen=True)
class Uncertainty:
    """The distribution of every key of `[reality]`, for the wheels of one layout.

    Attributes:
        spreads: by key. layout: of the device.
        detection: time until the law knows of a stopped drive, if one stops in every flight [s];
            None: all run.
    """

    spreads: Mapping[str, Distribution]
    layout: Layout
    detection: float | None = None

    @classmethod
    def of(
        cls,
        specified: UncertaintySection,
        robot: Robot,
        device: Device,
        detection: float | None = None,
    ) -> "Uncertainty":
        """Specified distributions, with defaults for the rest."""
        complete = complete_uncertainty(specified, standing_height(robot), device.motor)
        return cls({key: getattr(complete, key) for key in KEYS}, device.layout, detection)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all sampled numbers, in order."""
        return quantities(self.layout, one_stops=self.detection is not None)

    def written(self) -> Mapping[str, str]:
        """Distributions as text by key (SI); different sets have different texts."""
        texts = {key: spread.written() for key, spread in self.spreads.items()}
        if self.detection is None:
            return texts
        return {**texts, STOPPED: f"any one, at any instant, known after {self.detection!r}"}


def key_of(name: str) -> str:
    """The key of `[reality]` from which one of `quantities` is sampled."""
    return name.partition(".")[0]


@dataclass(frozen=True, eq=False)
class Sample:
    """Sampled values of one robot.

    Attributes:
        seed, index: determine the values, independently of other samples.
        uncertainty: that it was drawn from.
        values: SI, in the order of `Uncertainty.names`, shape (numbers,).
    """

    seed: int
    index: int
    uncertainty: Uncertainty
    values: FloatArray

    @classmethod
    def draw(cls, uncertainty: Uncertainty, seed: int, index: int) -> "Sample":
        """Sample `index` of `seed`, from its own counter-based generator."""
        names = quantities(uncertainty.layout)
        generator = np.random.Generator(np.random.Philox(_sequence(seed, index)))
        values = [
            uncertainty.spreads[key_of(name)].at(part)
            for name, part in zip(names, generator.random(len(names)).tolist(), strict=True)
        ]
        if uncertainty.detection is not None:
            which, when = generator.random(len(STOP_QUANTITIES)).tolist()
            values += [1.0 + int(which * len(uncertainty.layout)), when]
        return cls(seed, index, uncertainty, np.array(values))

    @property
    def by_name(self) -> Mapping[str, float]:
        """The values by name."""
        return dict(zip(self.uncertainty.names, self.values.tolist(), strict=True))

    def stopped(self, world: World) -> StoppedDrive | None:
        """The drive that stops in a flight; None: all run."""
        detection = self.uncertainty.detection
        if detection is None:
            return None
        wheel, instant = int(self.only(STOPPED)) - 1, self.only(SHARE) * world.flight_time
        return StoppedDrive(wheel, instant, detection)

    @cached_property
    def _by_key(self) -> Mapping[str, FloatArray]:
        """All parts of each key."""
        keys = np.array([key_of(name) for name in self.uncertainty.names])
        return {key: self.values[keys == key] for key in keys.tolist()}

    def of(self, key: str) -> FloatArray:
        """All parts of a key of `[reality]`, shape (parts,)."""
        return self._by_key[key]

    def only(self, key: str) -> float:
        """Value of a key that has no parts."""
        return float(self.of(key)[0])

    def noise(self, flight: int) -> np.random.SeedSequence:
        """Seed of the noise of a flight, by the flight's number."""
        return _sequence(self.seed, self.index, flight)


def _sequence(seed: int, *key: int) -> np.random.SeedSequence:
    return np.random.SeedSequence(seed, spawn_key=key)


PUSH_OFF_END = 5e-3
"""Duration of the push that gives a sample its rate at take-off, once lift-off is certain [s]."""


def sampled_world(
    world: World,
    sample: Sample,
    flight: int,
    *,
    air: AirDrag,
    limits: MotorLimits,
    period: float,
) -> World:
    """World of one flight of a sampled robot.

    Args:
        world: as designed, with its wheels active.
        flight: its number, for the noise.
        air: drag of a wheel, the same for all.
        limits: of a motor as designed, before friction is subtracted. The law uses these limits
            here, as it would if the drive itself supplied the current for friction.
        period: of the wheel law [s].
    """
    model = copy.copy(world.model)
    # The robot's masses only; the device is made and weighed with more care.
    robot_bodies = [
        index for index in range(1, model.nbody) if not model.body(index).name.startswith(PREFIX)
    ]
    model.body_mass[robot_bodies] *= 1.0 + sample.only("mass_error")
    model.body_inertia[robot_bodies] *= 1.0 + sample.only("mass_error")
    base = quaternions.matrix(world.chain.end)
    _alter_trunk(model, world.addresses.trunk, base, sample)
    feet, errors = (
        base @ sample.uncertainty.layout.feet(world.body.axes),
        sample.of("incidence_error"),
    )
    for body, foot, error in zip(world.addresses.flywheels, feet.T, errors, strict=True):
        turn = quaternions.from_axis_angle(foot, error)
        model.body_quat[body] = quaternions.product(turn, model.body_quat[body])
    model.geom_friction[:, 0] = sample.only("contact_friction")
    # The drives below apply the real motor's limits; friction can exceed them in braking.
    motors = list(world.addresses.motors)
    model.actuator_ctrllimited[motors] = model.actuator_forcelimited[motors] = 0
    mujoco.mj_setConst(model, mujoco.MjData(model))

    # Sampled friction is subtracted only once, from the motor's torque.
    law = replace(world.law, limits=stacked_columns([limits.usable]))
    constant = 1.0 + sample.of("torque_constant_error")
    voltage = 1.0 + sample.only("bus_voltage_error")
    resistance = 1.0 + sample.of("resistance_error")
    # V = R i + k_t w (docs/theory.md, The motor).
    real = MotorLimits(
        no_load_speed=limits.no_load_speed * voltage / constant,
        line_slope=limits.line_slope * resistance / constant**2,
        torque_limit=limits.torque_limit * constant,
        speed_max=np.array([np.inf]),
        copper=limits.copper * resistance / constant**2,
        efficiency=np.array([limits.efficiency]),
        power_max=np.array([limits.power_max]),
        voltage=None if limits.voltage is None else limits.voltage * voltage,
    )
    imperfections = Imperfections(
        attitude_bias=sample.of("attitude_bias"),
        gyro_bias=sample.of("gyro_bias"),
        attitude_noise=sample.only("attitude_noise"),
        gyro_noise=sample.only("gyro_noise"),
        stream=sample.noise(flight),
        torque_gain=constant,
        limits=replace(real, voltage=None),
        coulomb=sample.of("coulomb_friction"),
        viscous=sample.of("viscous_friction"),
        air=air,
        air_factor=sample.only("air_drag"),
        delay=round(sample.only("torque_delay") / world.model.opt.timestep),
    )
    pushes = world.pushes
    if world.takes_off:
        impulse = world.body.actuated_inertia[:, :2] @ sample.of("takeoff_rate")
        pushes = (
            *pushes,
            Push(impulse / PUSH_OFF_END, max(FLIGHT_CONFIRMATION, period), PUSH_OFF_END),
        )
    return replace(
        world,
        model=model,
        law=law,
        limits=real if world.limits else None,
        imperfections=imperfections,
        pushes=pushes,
        stopped=sample.stopped(world),
    )


def _alter_trunk(model: mujoco.MjModel, trunk: int, base: FloatArray, sample: Sample) -> None:
    """Shift the trunk's centre of mass and scale its inertia as sampled, along the axes of B.

    The matrix of second moments `S = tr(I)/2 - I` is scaled from both sides, so that the inertia
    stays physically possible, however large the error.
    """
    model.body_ipos[trunk] += base @ sample.of("com_error")
    error = sample.of("inertia_error")
    if error.any():
        principal = quaternions.matrix(model.body_iquat[trunk])
        inertia = principal * model.body_inertia[trunk] @ principal.T
        stretch = base * np.sqrt(1.0 + error) @ base.T
        moments = stretch @ (0.5 * np.trace(inertia) * np.eye(3) - inertia) @ stretch
        values, axes = np.linalg.eigh(np.trace(moments) * np.eye(3) - moments)
        model.body_inertia[trunk] = values
        model.body_iquat[trunk] = quaternion(axes * np.linalg.det(axes))
    # MuJoCo takes a short cut if the inertial frame is the body's own.
    model.body_sameframe[trunk] = 0
