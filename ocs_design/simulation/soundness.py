"""Starts that no step of the integrator follows, or that are no starts; runs that broke down.

What shows in the figures of a run, momentum and wheels that are too fast, is for the `verdict`.
"""

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.simulation.ground import lowest_point
from ocs_design.simulation.recording import Recording
from ocs_design.simulation.world import World

DEPTH_LIMIT = 0.01
"""Deepest start below the floor, over the standing height: springs of contact throw it out."""

GROWTH_LIMIT = 1e-3
"""Largest growth of any motion of the joint drives in a step. Motions that neither grow nor decay,
which the floating base has six of, are found to within 1e-8."""


def objection(world: World) -> str:
    """Why a run from here would say nothing, and the cure; empty if nothing is against it."""
    if not (np.isfinite(world.qpos).all() and np.isfinite(world.qvel).all()):
        return "not judged: the start is not finite; look for numbers beyond measure in the files"
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    mujoco.mj_forward(world.model, data)
    return _buried(world, data) or _unstable(world, data)


def breakdown(recording: Recording, index: int) -> str:
    """What ended a run before its time, and the cure; empty if nothing did."""
    if recording.stable[index]:
        return ""
    code = int(recording.warning[index])
    said = f": MuJoCo stopped at {_WARNINGS[code]}" if code in _WARNINGS else ""
    return (
        f"not judged: the simulation became unstable{said}; look for links with next to no inertia "
        f"and for figures that are hardly meant by `ocs-design inspect`"
    )


_WARNINGS = {
    int(mujoco.mjtWarning.mjWARN_INERTIA): "an inertia that is close to singular",
    int(mujoco.mjtWarning.mjWARN_CONTACTFULL): "more contacts than it has room for",
    int(mujoco.mjtWarning.mjWARN_CNSTRFULL): "more constraints than it has room for",
    int(mujoco.mjtWarning.mjWARN_BADQPOS): "a position that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADQVEL): "a speed that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADQACC): "an acceleration that is huge or not a number",
    int(mujoco.mjtWarning.mjWARN_BADCTRL): "a command that is not a number",
}


def _buried(world: World, data: mujoco.MjData) -> str:
    depth = -lowest_point(world.model, data)
    if depth <= DEPTH_LIMIT * world.standing_height:
        return ""
    return (
        f"not judged: at the start the robot reaches {1e3 * depth:.3g} mm into the floor; release "
        f"it so much higher, or less tilted"
    )


def _unstable(world: World, data: mujoco.MjData) -> str:
    growth = drive_growth(world.model, data)
    if growth <= GROWTH_LIMIT:
        return ""
    step = 1e3 * world.model.opt.timestep
    return (
        f"not judged: the joint drives are unstable at steps of {step:.3g} ms: a motion grows "
        f"by {100.0 * growth:.3g} % in each; lower their gains, or give the links inertia "
        f"(`ocs-design inspect` names those with next to none)"
    )


def drive_growth(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Growth per step of the fastest growing motion of drives and joint friction, in free flight.

    `M q'' = -K q - D q'`, linear about the pose in `data`. Runge-Kutta of order four takes a motion
    `exp(l t)` to `R(l dt)` times itself, `R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24` (Hairer and
    Wanner, Solving ODEs II, section IV.2).
    """
    stiffness, damping = _gains(model)
    mass, n = np.empty((model.nv, model.nv)), model.nv
    mujoco.mj_fullM(model, data, mass)
    motion = np.zeros((2 * n, 2 * n))
    motion[:n, n:] = np.eye(n)
    motion[n:] = -np.linalg.solve(mass, np.hstack([np.diag(stiffness), np.diag(damping)]))
    z = np.linalg.eigvals(motion) * model.opt.timestep
    stretched = np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))))
    return float(stretched.max() - 1.0)


def _gains(model: mujoco.MjModel) -> tuple[FloatArray, FloatArray]:
    """Of every degree of freedom: stiffness and damping by its drive and in itself."""
    damping = np.array(model.dof_damping, dtype=np.float64)
    stiffness = np.zeros(model.nv)
    stiffness[model.jnt_dofadr] = model.jnt_stiffness
    driven = model.actuator_biastype == int(mujoco.mjtBias.mjBIAS_AFFINE)
    dofs = model.jnt_dofadr[model.actuator_trnid[driven, 0]]
    np.subtract.at(stiffness, dofs, model.actuator_biasprm[driven, 1])
    np.subtract.at(damping, dofs, model.actuator_biasprm[driven, 2])
    return stiffness, damping
