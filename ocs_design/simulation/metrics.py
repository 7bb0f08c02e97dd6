"""Figures of a run, and whether its start and its integration were sound.

Faults that show in the figures themselves, a momentum error or wheels that are too fast, are left
to `verdict`.
"""

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.export.physics import lowest_point
from ocs_design.requirement.boundary import Z
from ocs_design.simulation.batch import Recording
from ocs_design.simulation.run import UPRIGHT_TILT, Metrics, Series
from ocs_design.simulation.world import World

UPRIGHT_HEIGHT = 0.5
"""Smallest height of the trunk of a robot that stands, over its standing height."""

_NO_TURNING_RATE = np.radians(1.0)
"""Turning rate below which a flight counts as one without any turning [rad/s]."""

_SETTLED_ANGLE = np.radians(1.0)
"""Largest angle from its final attitude at which a trunk has settled [rad]."""


def series_of(recording: Recording, index: int, world: World) -> Series:
    """Time series of one world of a recording."""
    instants = slice(recording.lengths[index])
    attitude, speed = recording.attitude[instants, index], recording.wheel_speed[instants, index]
    roll, pitch = quaternions.tilt(attitude)
    limits = world.limits
    torque = recording.wheel_torque[instants, index]
    lowest, highest = (None, None) if limits is None else limits.torque_range(speed)
    power, current = None, None
    if limits is not None and limits.voltage is not None:
        # A held torque draws the most power at one end of its step.
        # A run that became unstable ends with huge speeds.
        with np.errstate(invalid="ignore", over="ignore"):
            first = limits.bus_power(speed, torque)
            last = limits.bus_power(np.vstack([speed[1:], speed[-1:]]), torque)
        power = np.where(np.abs(last) > np.abs(first), last, first)
        current = power / limits.voltage
    return Series(
        time=recording.time[instants],
        com=recording.com[instants, index],
        roll=roll,
        pitch=np.unwrap(pitch),
        yaw=np.unwrap(quaternions.heading(attitude)),
        rate=recording.rate[instants, index],
        wheel_speed=speed,
        wheel_torque=torque,
        torque_lowest=lowest,
        torque_highest=highest,
        contact=recording.contact[instants, index].astype(np.float64),
        wheels=world.wheels,
        bus_power=power,
        bus_current=current,
    )


def measure(recording: Recording, index: int, world: World) -> Metrics | None:
    """Figures of one world of a recording; None if it did not reach its end."""
    if not recording.stable[index]:
        return None
    series = series_of(recording, index, world)
    end = len(series.time) - 1

    # Instants in free flight, at least one; for a robot that never left the ground, its last one.
    lift_off = int(recording.lift_off[index])
    touching = np.flatnonzero(series.contact[lift_off:]) if lift_off >= 0 else np.empty(0, int)
    first = lift_off if lift_off >= 0 else end
    last = first + int(touching[0]) if touching.size else end
    flight, after = slice(first, last + 1), slice(last, None)
    driven = flight if world.stands is None else after
    attitude, comes_down = recording.attitude[: end + 1, index], bool(touching.size)
    turned = _angle_about(world.counted, attitude)
    roll, pitch = series.roll, series.pitch
    if world.settles is not None:
        comes_down, last = True, int(np.argmin(np.abs(series.time - world.settles)))
        flight = driven = slice(0, end + 1)
        after = slice(last, None)
        attitude = quaternions.product(attitude, quaternions.conjugate(world.body.upright))
        roll, pitch = quaternions.tilt(attitude)
        pitch = np.unwrap(pitch)

    # Roll and pitch have settled once they stay near their final values.
    deviation = np.maximum(np.abs(roll - roll[-1]), np.abs(pitch - pitch[-1]))
    moving = np.flatnonzero(deviation[after] > _SETTLED_ANGLE)
    settled = last + (int(moving[-1]) + 1 if moving.size else 0)

    _, x, y, _ = attitude[end]
    is_upright = 1.0 - 2.0 * (x * x + y * y) > np.cos(UPRIGHT_TILT)
    is_high = recording.height[end, index] > UPRIGHT_HEIGHT * world.standing_height
    # Nutation of `J w_dot = -w x h A W`, about the axes of the two smallest inertias.
    body = world.body
    momentum = (
        body.spin_inertia * np.linalg.norm(series.wheel_speed[driven] @ body.axes.T, axis=1).max()
    )
    smallest = np.linalg.eigvalsh(body.actuated_inertia)[:2]
    # Only wheels with a component about z can stop the trunk about the vertical.
    turning = np.hypot(*series.rate[last, :2])
    if body.controlled[2]:
        turning = np.hypot(turning, series.rate[last, 2])
    return Metrics(
        lift_off_time=float(series.time[first]) if lift_off >= 0 else None,
        rise=float(series.com[flight, 2].max() - series.com[first, 2]),
        touchdown_time=float(series.time[last]) if comes_down else None,
        touchdown_roll=float(roll[last]),
        touchdown_pitch=_within_half_turn(pitch[last]),
        touchdown_rate=float(turning),
        turned_angle=float(turned[last] - turned[first]),
        heading_drift=_within_half_turn(series.yaw[last] - series.yaw[first]),
        peak_wheel_speed=float(np.abs(series.wheel_speed[driven]).max()),
        final_wheel_speed=float(np.abs(series.wheel_speed[-1]).max()),
        peak_wheel_torque=float(np.abs(series.wheel_torque[driven]).max()),
        momentum_error=_momentum_error(recording, index, flight, world),
        upright_at_end=bool(is_upright and is_high),
        final_roll=float(roll[-1]),
        final_pitch=_within_half_turn(pitch[-1]),
        roll_swing=float(np.ptp(roll[after])),
        pitch_swing=float(np.ptp(pitch[after])),
        settling_time=float(series.time[settled] - series.time[last]),
        nutation=float(momentum / np.sqrt(smallest.prod()) * world.model.opt.timestep),
    )


def _angle_about(axis: FloatArray, attitude: FloatArray) -> FloatArray:
    """Angle about an axis across or along the vertical, whole turns counted [rad], shape (n,)."""
    if axis[2]:
        return np.unwrap(axis[2] * quaternions.heading(attitude))
    up = quaternions.vertical(attitude)
    return np.unwrap(np.arctan2(up @ np.cross(Z, axis), up[:, 2]))


def _momentum_error(recording: Recording, index: int, flown: slice, world: World) -> float:
    """Relative momentum error `|H(t) - H(0) - impulse|` (docs/validation.md, The momentum gate).

    H itself is near zero in most of these flights, as trunk and wheels turn against each other, so
    the scale is the largest momentum of the wheels plus that of the trunk with its legs locked.
    Gravity has no moment about the centre of mass. It has one about a pivot, where the anchor puts
    the centre of mass of the whole, and there its impulse counts as an external one. About an edge
    only that axis counts.
    """
    # Contacts are checked once per step, so a stage in between may feel the floor as a foot scrapes
    # off it or is about to touch it: the first and the last control step are left out.
    first = min(flown.start + 1, flown.stop - 1)
    flight = slice(first, max(flown.stop - 1, first + 1))
    momentum, impulse = recording.momentum[flight, index], recording.impulse[flight, index]
    unexplained = momentum - momentum[0] - (impulse - impulse[0])
    if world.body.edge is not None:
        edge = quaternions.matrix(recording.attitude[0, index]) @ world.body.edge
        unexplained = unexplained @ np.outer(edge, edge)
    wheels = world.body.spin_inertia * np.abs(recording.wheel_speed[flight, index]).max()
    turning = recording.rate[flight, index] @ world.body.inertia
    scale = wheels + np.linalg.norm(turning, axis=1).max()
    least_scale = _NO_TURNING_RATE * np.trace(world.body.inertia) / 3.0
    return float(np.linalg.norm(unexplained, axis=1).max() / max(scale, least_scale))


def _within_half_turn(angle: float) -> float:
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)


DEPTH_LIMIT = 0.01
"""Deepest start below the floor, over the standing height: contact springs throw it out."""

GROWTH_LIMIT = 1e-3
"""Largest growth of any motion of the joint drives per step. Motions that neither grow nor decay,
six of which belong to the floating base, are computed to within 1e-8."""


def objection(world: World) -> str:
    """Why a run of this world could not be judged, and the cure; empty if it can."""
    if not (np.isfinite(world.qpos).all() and np.isfinite(world.qvel).all()):
        return "not judged: the start is not finite; look for absurdly large numbers in the files"
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    mujoco.mj_forward(world.model, data)
    depth = -lowest_point(world.model, data)
    if depth > DEPTH_LIMIT * world.standing_height:
        return (
            f"not judged: at the start the robot reaches {1e3 * depth:.3g} mm into the floor; "
            f"release it that much higher, or less tilted"
        )
    growth = drive_growth(world.model, data)
    if growth > GROWTH_LIMIT:
        step = 1e3 * world.model.opt.timestep
        return (
            f"not judged: the joint drives are unstable at a time step of {step:.3g} ms: a motion "
            f"grows by {100.0 * growth:.3g} % per step; lower their gains, or give the links "
            f"inertia (`ocs-design inspect` names those with next to none)"
        )
    return ""


def breakdown(recording: Recording, index: int) -> str:
    """Why a run ended early, and the cure; empty if it did not."""
    if recording.stable[index]:
        return ""
    code = int(recording.warning[index])
    cause = f": MuJoCo stopped at {_WARNINGS[code]}" if code in _WARNINGS else ""
    return (
        f"not judged: the simulation became unstable{cause}; run `ocs-design inspect` and look for "
        "links with next to no inertia and for implausible values"
    )


_WARNINGS = {
    int(mujoco.mjtWarning.mjWARN_INERTIA): "a nearly singular inertia",
    int(mujoco.mjtWarning.mjWARN_CONTACTFULL): "more contacts than it has room for",
    int(mujoco.mjtWarning.mjWARN_CNSTRFULL): "more constraints than it has room for",
    int(mujoco.mjtWarning.mjWARN_BADQPOS): "a position that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADQVEL): "a speed that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADQACC): "an acceleration that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADCTRL): "a command that is not a number",
}


def drive_growth(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Growth per step of the fastest growing motion of drives and joint friction, in free flight.

    `M q'' = -K q - D q'`, linearised about the pose in `data`. A step of fourth-order Runge-Kutta
    multiplies a motion `exp(l t)` by `R(l dt)`, `R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24` (Hairer and
    Wanner, Solving ODEs II, section IV.2).
    """
    # Stiffness and damping of every degree of freedom, from its drive and its joint.
    damping = np.array(model.dof_damping, dtype=np.float64)
    stiffness = np.zeros(model.nv)
    stiffness[model.jnt_dofadr] = model.jnt_stiffness
    driven = model.actuator_biastype == int(mujoco.mjtBias.mjBIAS_AFFINE)
    dofs = model.jnt_dofadr[model.actuator_trnid[driven, 0]]
    np.subtract.at(stiffness, dofs, model.actuator_biasprm[driven, 1])
    np.subtract.at(damping, dofs, model.actuator_biasprm[driven, 2])
    mass, n = np.empty((model.nv, model.nv)), model.nv
    mujoco.mj_fullM(model, data, mass)
    motion = np.zeros((2 * n, 2 * n))
    motion[:n, n:] = np.eye(n)
    motion[n:] = -np.linalg.solve(mass, np.hstack([np.diag(stiffness), np.diag(damping)]))
    z = np.linalg.eigvals(motion) * model.opt.timestep
    growth = np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))))
    return float(growth.max() - 1.0)
