"""Takes a user's MJCF robot out of its world: no floor, no other bodies, nothing that fixes it."""

import mujoco

from ocs_design.robot.mjcf.assets import delete_geom
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.spec.keyframes import put_keyframes, take_keyframes

_FREE = mujoco.mjtJoint.mjJNT_FREE


def free_base(spec: mujoco.MjSpec, base: str, remarks: Remarks) -> None:
    """Leave only the robot in the model, with a free base.

    Args:
        spec: the user's model.
        base: name of the robot's root body, a child of the world.
        remarks: takes what was left out.
    """
    strangers = [body for body in spec.worldbody.bodies if body.name != base]
    held = [joint for joint in spec.body(base).joints if joint.type != _FREE]
    is_free = len(spec.body(base).joints) > len(held)
    keyframes = [] if is_free and not strangers else take_keyframes(spec)
    for geom in list(spec.worldbody.geoms):
        remarks.add("fixed geoms of the model's world, left out", geom.name or "one without a name")
        delete_geom(spec, geom)
    for body in strangers:
        remarks.add("bodies beside the robot, left out", body.name)
        spec.delete(body)
    _look_away(spec)
    if not is_free:
        for joint in held:
            _delete_joint(spec, joint)
        spec.body(base).add_freejoint()
    put_keyframes(spec, keyframes)


def _look_away(spec: mujoco.MjSpec) -> None:
    """Fix cameras and lights that follow what was left out, with which nothing could compile."""
    there = {body.name for body in spec.bodies}
    for each in [*spec.cameras, *spec.lights]:
        if each.targetbody and each.targetbody not in there:
            each.targetbody, each.mode = "", mujoco.mjtCamLight.mjCAMLIGHT_FIXED


def _delete_joint(spec: mujoco.MjSpec, joint: mujoco.MjsJoint) -> None:
    """Delete a joint with what acts on it, measures it or ties it, which could not compile."""
    kind, name = mujoco.mjtObj.mjOBJ_JOINT, joint.name
    for actuator in [each for each in spec.actuators if each.target == name]:
        spec.delete(actuator)
    for sensor in [s for s in spec.sensors if (s.objtype, s.objname) == (kind, name)]:
        spec.delete(sensor)
    for tie in [e for e in spec.equalities if e.objtype == kind and name in {e.name1, e.name2}]:
        spec.delete(tie)
    spec.delete(joint)
