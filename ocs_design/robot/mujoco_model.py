"""The robot as a MuJoCo model: floating, at rest, with nothing around it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement
from ocs_design.robot.links import Warnings, unused_name
from ocs_design.robot.mjcf_spec import compiled, delete_geom, parse_mjcf
from ocs_design.robot.mujoco_bodies import body_names, drop_refused_meshes, spec_from_tree
from ocs_design.robot.robot import Leg, Robot, RobotFormat
from ocs_design.robot.source import STANDARD_INPUT

_FOOT_SHARE = 0.02
"""Radius of a foot that is only a point, over its leg's length."""


def add_missing_feet(spec: mujoco.MjSpec, model: mujoco.MjModel, robot: Robot) -> None:
    """Add a small sphere, named after the foot's link, to each foot without collision geometry.

    Args:
        spec: to change.
        model: compiled from it.
        robot: from which it was built.
    """
    names = body_names(robot.tree)
    collides = (model.geom_contype | model.geom_conaffinity) != 0
    for leg in robot.legs:
        name = names[leg.body]
        welded = model.body_weldid == model.body_weldid[model.body(name).id]
        if np.any(collides & welded[model.geom_bodyid]):
            continue
        # The tree's body frame is at the joint; in the model it is the link's.
        link = robot.tree.bodies[leg.body].links[robot.tree.bodies[leg.body].name].inverse()
        spec.body(name).add_geom(
            name=foot_geom_name(leg),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[leg.foot_radius or _FOOT_SHARE * leg.length, 0.0, 0.0],
            pos=link.point(leg.foot),
            # By the file's defaults, geoms may be visual only.
            contype=1,
            conaffinity=1,
        )


def foot_geom_name(leg: Leg) -> str:
    """Name of the sphere that a foot without collision geometry gets."""
    return f"ocs_foot_{leg.name}"


def exclude_neighbours(spec: mujoco.MjSpec, model: mujoco.MjModel, robot: Robot) -> None:
    """Exclude contacts between bodies that touch in the nominal posture.

    Collision geometry of neighbouring links overlaps in most robot files; contacts there would only
    disturb the robot. Arguments as for `add_missing_feet`.
    """
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_collision(model, data)
    touching = {tuple(sorted(pair)) for pair in model.geom_bodyid[data.contact.geom].tolist()}
    for first, second in sorted(touching):
        spec.add_exclude(bodyname1=model.body(first).name, bodyname2=model.body(second).name)


def posture_qpos(model: mujoco.MjModel, robot: Robot) -> FloatArray:
    """Coordinates of a model with the robot's joints at its nominal posture, shape (nq,)."""
    qpos: FloatArray = model.qpos0.copy()
    for name, value in robot.posture.items():
        qpos[model.joint(name).qposadr] = value
    return qpos


def reduce_to_hulls(spec: mujoco.MjSpec, model: mujoco.MjModel) -> None:
    """Reduce each colliding mesh to the vertices of its convex hull.

    A humanoid's meshes take 70 MB of each compiled model, and every world has one. Contacts stay
    the same; the appearance does not.

    Args:
        spec: to change.
        model: compiled from it.
    """
    fitted = {geom.meshname for geom in spec.geoms if geom.type != mujoco.mjtGeom.mjGEOM_MESH}
    for mesh in list(spec.meshes):
        index = model.mesh(mesh.name).id
        # A box or capsule fitted to a mesh would differ if fitted to its hull.
        if mesh.name not in fitted and model.mesh_graphadr[index] >= 0:
            name = unused_name(mesh.name, "", {other.name for other in spec.meshes})
            # The hull's graph begins with the numbers of its vertices and faces, then for each
            # vertex where its edges begin, then the index of each vertex among the mesh's.
            graph = model.mesh_graph[model.mesh_graphadr[index] :]
            indices = graph[2 + graph[0] : 2 + 2 * graph[0]]
            corners = model.mesh_vert[model.mesh_vertadr[index] + indices].astype(np.float64)
            # MuJoCo rotates meshes into their principal axes.
            rotation = np.empty(9)
            mujoco.mju_quat2Mat(rotation, model.mesh_quat[index])
            placed: FloatArray = corners @ rotation.reshape(3, 3).T + model.mesh_pos[index]
            spec.add_mesh(
                name=name,
                uservert=placed.ravel(),
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
            )
            for geom in spec.geoms:
                if geom.meshname == mesh.name:
                    geom.meshname = name
            if [other.file for other in spec.meshes].count(mesh.file) == 1:
                spec.assets.pop(mesh.file, None)
            spec.delete(mesh)


@dataclass(frozen=True, eq=False)
class Keyframe:
    """State of a model, by the names of its joints and actuators.

    Attributes:
        name: of the keyframe. time: [s].
        positions, velocities: coordinates of each joint, by its name.
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
    """Remove all keyframes from a model, and return them."""
    if not spec.keys:
        return ()
    model = compiled(spec)
    keyframes = []
    for index in range(model.nkey):
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, index)
        joints = [data.joint(i) for i in range(model.njnt)]
        actuators = [data.actuator(i) for i in range(model.nu)]
        keyframe = Keyframe(
            model.key(index).name,
            float(model.key_time[index]),
            {joint.name: joint.qpos.copy() for joint in joints},
            {joint.name: joint.qvel.copy() for joint in joints},
            {actuator.name: actuator.ctrl.copy() for actuator in actuators},
            {actuator.name: _activation(model, data, actuator.id).copy() for actuator in actuators},
        )
        keyframes.append(keyframe)
    for key in list(spec.keys):
        spec.delete(key)
    return keyframes


def put_keyframes(spec: mujoco.MjSpec, keyframes: Iterable[Keyframe]) -> None:
    """Put keyframes into a model; new joints are at zero, and removed ones are dropped."""
    for keyframe in keyframes:
        model = compiled(spec)
        data = mujoco.MjData(model)
        for joint in (data.joint(i) for i in range(model.njnt)):
            if joint.name in keyframe.positions:
                joint.qpos[:] = keyframe.positions[joint.name]
                joint.qvel[:] = keyframe.velocities[joint.name]
        for actuator in (data.actuator(i) for i in range(model.nu)):
            if actuator.name in keyframe.controls:
                actuator.ctrl[:] = keyframe.controls[actuator.name]
                _activation(model, data, actuator.id)[:] = keyframe.activations[actuator.name]
        spec.add_key(
            name=keyframe.name,
            time=keyframe.time,
            qpos=data.qpos,
            qvel=data.qvel,
            act=data.act,
            ctrl=data.ctrl,
        )


def _activation(model: mujoco.MjModel, data: mujoco.MjData, actuator: int) -> FloatArray:
    """The part of `data.act` that belongs to an actuator; empty without state."""
    first, count = model.actuator_actadr[actuator], model.actuator_actnum[actuator]
    activation: FloatArray = data.act[first : first + count] if count else data.act[:0]
    return activation


_FREE = mujoco.mjtJoint.mjJNT_FREE


def free_base(spec: mujoco.MjSpec, base: str, warnings: Warnings) -> None:
    """Leave only the robot in the model, with a free base.

    Args:
        spec: the user's model.
        base: name of the robot's root body, a child of the world.
        warnings: receives what was left out.
    """
    other_bodies = [body for body in spec.worldbody.bodies if body.name != base]
    base_joints = [joint for joint in spec.body(base).joints if joint.type != _FREE]
    is_free = len(spec.body(base).joints) > len(base_joints)
    world_tendons = [
        tendon
        for tendon in spec.tendons
        if any(wrap.target and wrap.target.parent == spec.worldbody for wrap in tendon.path)
    ]
    keyframes = [] if is_free and not (other_bodies or world_tendons) else take_keyframes(spec)
    for rope in world_tendons:
        warnings.add("tendons to the world, left out", rope.name or "one without a name")
        _delete_users(spec, mujoco.mjtObj.mjOBJ_TENDON, rope.name)
        spec.delete(rope)
    for geom in list(spec.worldbody.geoms):
        name = geom.name or "one without a name"
        warnings.add("fixed geoms of the model's world, left out", name)
        delete_geom(spec, geom)
    for body in other_bodies:
        warnings.add("other bodies than the robot, left out", body.name)
        spec.delete(body)
    # The reader has warned of ties between the robot and the world.
    for tie in [equality for equality in spec.equalities if equality.type in TIES]:
        of_sites = tie.objtype == mujoco.mjtObj.mjOBJ_SITE
        names = (tie.name1, tie.name2)
        ends = [spec.site(name).parent.name for name in names] if of_sites else names
        # A body that is not named is the world.
        if {"", "world"}.intersection(ends):
            spec.delete(tie)
    # Cameras and lights that track something left out would not compile.
    body_names = {body.name for body in spec.bodies}
    for element in [*spec.cameras, *spec.lights]:
        if element.targetbody and element.targetbody not in body_names:
            element.targetbody, element.mode = "", mujoco.mjtCamLight.mjCAMLIGHT_FIXED
    if not is_free:
        for joint in base_joints:
            _delete_users(spec, mujoco.mjtObj.mjOBJ_JOINT, joint.name)
            spec.delete(joint)
        spec.body(base).add_freejoint()
    put_keyframes(spec, keyframes)


def _delete_users(spec: mujoco.MjSpec, kind: mujoco.mjtObj, name: str) -> None:
    """Delete what acts on a joint or tendon, measures or ties it, as it would not compile."""
    for actuator in [actuator for actuator in spec.actuators if actuator.target == name]:
        spec.delete(actuator)
    for sensor in [s for s in spec.sensors if (s.objtype, s.objname) == (kind, name)]:
        spec.delete(sensor)
    of_kind = [equality for equality in spec.equalities if equality.objtype == kind]
    for tie in [equality for equality in of_kind if name in {equality.name1, equality.name2}]:
        spec.delete(tie)


TIES = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)
"""Equalities that hold a body at a position on another body."""


def write_out_orientations(spec: mujoco.MjSpec) -> None:
    """Turn Euler angles and other notations into quaternions, the only form that a spec writes."""
    quaternion = mujoco.mjtOrientation.mjORIENTATION_QUAT
    for element in (*spec.bodies, *spec.frames, *spec.geoms, *spec.sites):
        if element.alt.type != quaternion:
            rules = element.compiler
            element.quat = spec.resolve_orientation(rules.degree, rules.eulerseq, element.alt)
            element.alt.type = quaternion


def write_out_inertials(spec: mujoco.MjSpec) -> None:
    """Write each body's compiled mass properties into the spec.

    The model's own rules, such as a total mass to which all bodies are scaled, must not affect
    bodies that are added later.
    """
    model = compiled(spec)
    for body in spec.bodies[1:]:
        if model.body_mass[body.id] > 0.0:
            body.explicitinertial = True
            body.mass, body.inertia = model.body_mass[body.id], model.body_inertia[body.id]
            body.ipos, body.iquat = model.body_ipos[body.id], model.body_iquat[body.id]
            body.fullinertia = [np.nan] * 6
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    spec.compiler.settotalmass = -1.0
    spec.compiler.boundmass = spec.compiler.boundinertia = 0.0
    spec.compiler.balanceinertia = False


@dataclass(frozen=True, eq=False)
class BuiltModel:
    """MuJoCo model of a robot.

    Attributes:
        spec: to be completed (floor, actuators, device) and compiled; contains its meshes' bytes.
        warnings: differences between MuJoCo's copy and the robot's file, one sentence each.
    """

    spec: mujoco.MjSpec
    warnings: tuple[str, ...]


def build_spec(robot: Robot, *, visuals: bool = True) -> BuiltModel:
    """The robot with a free base, without a floor, with MuJoCo's default contacts.

    Bodies and joints have the names of the file's links (of each moving body's first link) and
    joints. An MJCF robot keeps its own model: actuators, sensors, contacts, keyframes.

    Args:
        robot: as read.
        visuals: whether the model will be shown; if not, visual shapes are left out, and meshes
            are reduced to their convex hulls, which is all that MuJoCo uses for contact.
    """
    warnings = Warnings()
    spec = plain_spec(robot, warnings, visuals=visuals)
    # MuJoCo 4.0.0's sparse Newton solver is wrong.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    model = compile_spec(spec, robot, warnings)
    if not visuals:
        reduce_to_hulls(spec, model)
    add_missing_feet(spec, model, robot)
    exclude_neighbours(spec, compiled(spec), robot)
    return BuiltModel(spec, warnings.sentences())


def plain_spec(robot: Robot, warnings: Warnings, *, visuals: bool) -> mujoco.MjSpec:
    """The robot as its file describes it, with a free base.

    Args:
        robot: as read.
        warnings: receives what was changed for MuJoCo.
        visuals: whether to load visual shapes; an MJCF robot keeps them in any case.
    """
    if robot.format is not RobotFormat.MJCF:
        return spec_from_tree(robot.tree, warnings, visuals=visuals)
    folder = Path.cwd() if robot.source == STANDARD_INPUT else Path(robot.source).absolute().parent
    # The reader has already warned of oddities in the file itself.
    spec, _ = parse_mjcf(robot.content, folder, Warnings())
    write_out_orientations(spec)
    write_out_inertials(spec)
    free_base(spec, robot.floating_base, warnings)
    return spec


def compile_spec(spec: mujoco.MjSpec, robot: Robot, warnings: Warnings) -> mujoco.MjModel:
    """Compiled model of a spec of `plain_spec`, without the meshes that MuJoCo refuses."""
    try:
        return compiled(spec)
    except RobotError:
        if robot.format is RobotFormat.MJCF:
            raise
        drop_refused_meshes(spec, warnings)
        return compiled(spec)


def trunk_body(spec: mujoco.MjSpec, robot: Robot) -> tuple[mujoco.MjsBody, Placement]:
    """The trunk's body in a spec of `build_spec`, and the base frame B in that body's frame."""
    if robot.format is RobotFormat.MJCF:
        # The tree merges welded bodies; in the user's model they are still separate.
        if robot.mount is not None:
            return spec.body(robot.mount.link), robot.mount.placement
        return spec.body(robot.trunk), Placement.identity()
    index = robot.tree.body_of_link[robot.trunk]
    body = robot.tree.bodies[index]
    return spec.body(body_names(robot.tree)[index]), body.links[robot.trunk]
