"""Keeps keyframes right while a model changes: each value goes with the name of its joint."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import mujoco

from ocs_design.arrays import FloatArray
from ocs_design.robot.mjcf.spec import compiled


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A state of a model, by name.

    Attributes:
        name: of the keyframe. time: [s].
        positions, velocities: coordinates of each joint by its name.
        controls: by the actuator's name.
        activations: by the actuator's name, empty for those without state.
    """

    name: str
    time: float
    positions: Mapping[str, FloatArray]
    velocities: Mapping[str, FloatArray]
    controls: Mapping[str, FloatArray]
    activations: Mapping[str, FloatArray]


def take_keyframes(spec: mujoco.MjSpec) -> Sequence[Keyframe]:
    """Take all keyframes out of a model."""
    if not spec.keys:
        return ()
    model = compiled(spec)
    found = [_read(model, index) for index in range(model.nkey)]
    for key in list(spec.keys):
        spec.delete(key)
    return found


def put_keyframes(spec: mujoco.MjSpec, keyframes: Iterable[Keyframe]) -> None:
    """Put keyframes into a model; joints that are new stand at zero, those gone are forgotten."""
    for keyframe in keyframes:
        model = compiled(spec)
        data = mujoco.MjData(model)
        _write(model, data, keyframe)
        spec.add_key(
            name=keyframe.name,
            time=keyframe.time,
            qpos=data.qpos,
            qvel=data.qvel,
            act=data.act,
            ctrl=data.ctrl,
        )


def _read(model: mujoco.MjModel, index: int) -> Keyframe:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, index)
    joints = [data.joint(i) for i in range(model.njnt)]
    actuators = [data.actuator(i) for i in range(model.nu)]
    return Keyframe(
        model.key(index).name,
        float(model.key_time[index]),
        {joint.name: joint.qpos.copy() for joint in joints},
        {joint.name: joint.qvel.copy() for joint in joints},
        {actuator.name: actuator.ctrl.copy() for actuator in actuators},
        {actuator.name: _activation(model, data, actuator.id).copy() for actuator in actuators},
    )


def _write(model: mujoco.MjModel, data: mujoco.MjData, keyframe: Keyframe) -> None:
    for joint in (data.joint(i) for i in range(model.njnt)):
        if joint.name in keyframe.positions:
            joint.qpos[:] = keyframe.positions[joint.name]
            joint.qvel[:] = keyframe.velocities[joint.name]
    for actuator in (data.actuator(i) for i in range(model.nu)):
        if actuator.name in keyframe.controls:
            actuator.ctrl[:] = keyframe.controls[actuator.name]
            _activation(model, data, actuator.id)[:] = keyframe.activations[actuator.name]


def _activation(model: mujoco.MjModel, data: mujoco.MjData, actuator: int) -> FloatArray:
    """The part of `data.act` that belongs to an actuator; empty without state."""
    first, count = model.actuator_actadr[actuator], model.actuator_actnum[actuator]
    activation: FloatArray = data.act[first : first + count] if count else data.act[:0]
    return activation
