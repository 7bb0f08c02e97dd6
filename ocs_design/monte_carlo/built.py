"""A simulated world as it was built: other masses, axes, motors and feet than the law believes."""

import copy
from dataclasses import replace

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.export.naming import PREFIX
from ocs_design.monte_carlo.sample import Sample
from ocs_design.robot.spec.frames import quaternion
from ocs_design.simulation import quaternions
from ocs_design.simulation.imperfections import AirDrag, Imperfections
from ocs_design.simulation.scene import FLYWHEELS
from ocs_design.simulation.world import World

_TURNS_WITH_INCIDENCE = np.array([-1.0, 1.0])
"""About z of B: a larger incidence turns the left axis clockwise as seen from above."""


def built(world: World, sample: Sample, flight: int, air: AirDrag) -> World:
    """The same flight of one built robot.

    Args:
        world: as designed, with its wheels active.
        sample: see `Sample`.
        flight: its number, for the noise.
        air: drag of a wheel, the same for all.
    """
    model = copy.copy(world.model)
    _scale_masses(model, 1.0 + sample.only("mass_error"))
    base = quaternions.matrix(world.chain.end)
    _alter_trunk(model, world.addresses.trunk, base, sample)
    _turn_axes(model, base[:, 2], sample.of("incidence_error"))
    model.geom_friction[:, 0] = sample.only("contact_friction")
    # The real motor's limits are those of its drive; friction adds to them when it brakes.
    motors = list(world.addresses.motors)
    model.actuator_ctrllimited[motors] = model.actuator_forcelimited[motors] = 0
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return replace(world, model=model, imperfections=_imperfections(world, sample, flight, air))


def _scale_masses(model: mujoco.MjModel, factor: float) -> None:
    """Of the robot; the device is made and weighed with more care."""
    own = [
        index for index in range(1, model.nbody) if not model.body(index).name.startswith(PREFIX)
    ]
    model.body_mass[own] *= factor
    model.body_inertia[own] *= factor


def _alter_trunk(model: mujoco.MjModel, trunk: int, base: FloatArray, sample: Sample) -> None:
    """Second moments of mass and centre of mass along the axes of B.

    The matrix of second moments `S = tr(I)/2 - I` is scaled from both sides, so that an inertia
    stays one that some distribution of mass has, however far it is off.
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
    # MuJoCo takes a short cut where the inertial frame is the body's own.
    model.body_sameframe[trunk] = 0


def _turn_axes(model: mujoco.MjModel, vertical: FloatArray, errors: FloatArray) -> None:
    """Incidence of both wheels; `vertical` is z of B in the trunk's body."""
    for name, error in zip(FLYWHEELS, errors * _TURNS_WITH_INCIDENCE, strict=True):
        body = model.body(name).id
        turn = quaternions.from_axis_angle(vertical, error)
        model.body_quat[body] = quaternions.product(turn, model.body_quat[body])


def _imperfections(world: World, sample: Sample, flight: int, air: AirDrag) -> Imperfections:
    law, constant = world.law, 1.0 + sample.of("torque_constant_error")
    voltage = 1.0 + sample.only("bus_voltage_error")
    resistance = 1.0 + sample.of("resistance_error")
    return Imperfections(
        attitude_bias=sample.of("attitude_bias"),
        gyro_bias=sample.of("gyro_bias"),
        attitude_noise=sample.only("attitude_noise"),
        gyro_noise=sample.only("gyro_noise"),
        stream=sample.noise(flight),
        torque_gain=constant,
        # V = R i + k_t w (docs/theory.md, The motor).
        no_load_speed=law.no_load_speed * voltage / constant,
        line_slope=law.line_slope * resistance / constant**2,
        torque_limit=law.torque_limit * constant,
        coulomb=sample.of("coulomb_friction"),
        viscous=sample.of("viscous_friction"),
        air=air,
        air_factor=sample.only("air_drag"),
        delay=round(sample.only("torque_delay") / world.model.opt.timestep),
    )
