"""What moves a joint of a compiled MJCF model: its actuators, or another joint."""

from collections.abc import Iterator

import mujoco
import numpy as np

from ocs_design.robot.remarks import Remarks

_ON_JOINT = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


def effort_limit(model: mujoco.MjModel, joint: int) -> float:
    """Largest torque or force that a joint's actuators give [N m or N]; inf if none states one."""
    efforts = list(_actuator_efforts(model, joint))
    total = sum(efforts) if efforts else np.inf
    if model.jnt_actfrclimited[joint]:
        total = min(total, float(np.abs(model.jnt_actfrcrange[joint]).max()))
    return total if total > 0.0 else np.inf


def _actuator_efforts(model: mujoco.MjModel, joint: int) -> Iterator[float]:
    for actuator in range(model.nu):
        if int(model.actuator_trntype[actuator]) not in _ON_JOINT:
            continue
        if model.actuator_trnid[actuator, 0] == joint:
            gear = abs(float(model.actuator_gear[actuator, 0]))
            yield gear * _largest_force(model, actuator)


def _largest_force(model: mujoco.MjModel, actuator: int) -> float:
    """In front of the gear: the stated range, or that of a motor's control."""
    if model.actuator_forcelimited[actuator]:
        return float(np.abs(model.actuator_forcerange[actuator]).max())
    is_motor = (
        model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
        and model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
    )
    if is_motor and model.actuator_ctrllimited[actuator]:
        gain = abs(float(model.actuator_gainprm[actuator, 0]))
        return gain * float(np.abs(model.actuator_ctrlrange[actuator]).max())
    return np.inf


def leader_of(
    model: mujoco.MjModel, joint: int, remarks: Remarks
) -> tuple[str, float, float] | None:
    """(joint, multiplier, offset) if a linear joint equality makes this joint follow another.

    MuJoCo holds `q1 - ref1 = a0 + a1 (q2 - ref2) + ...`; curves are not followed.
    """
    for index in np.flatnonzero(model.eq_type == mujoco.mjtEq.mjEQ_JOINT):
        leader = int(model.eq_obj2id[index])
        if model.eq_obj1id[index] != joint or leader < 0 or not model.eq_active0[index]:
            continue
        constant, slope, *curved = model.eq_data[index, :5]
        if np.any(curved):
            remarks.add("joints that follow another by a curve, read as free", _name(model, joint))
            continue
        offset = constant + _reference(model, joint) - slope * _reference(model, leader)
        return _name(model, leader), float(slope), float(offset)
    return None


def _reference(model: mujoco.MjModel, joint: int) -> float:
    return float(model.qpos0[model.jnt_qposadr[joint]])


def _name(model: mujoco.MjModel, joint: int) -> str:
    name: str = model.joint(joint).name
    return name
