"""Reads an MJCF model into a tree of moving bodies, through MuJoCo's own compiler.

Several joints of one body act one after the other, each about its own anchor; see MuJoCo's
documentation, chapter Modeling, `body/joint`.

Masses, frames and joints are those of the compiled model, so that defaults, included files, units
and inertias from geoms are exactly MuJoCo's.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.common.wording import some_of
from ocs_design.robot.links import Connection, Link, Warnings, check_number_of_links, make_tree
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.mjcf_spec import mujoco_refusal, mujoco_warnings_to, parse_mjcf
from ocs_design.robot.mujoco_bodies import GEOM_TYPES, JOINT_TYPES
from ocs_design.robot.tree import LARGEST_NUMBER, Joint, Shape, ShapeKind, Tree, joint_motion


def find_base(model: mujoco.MjModel, named: Sequence[str], warnings: Warnings) -> int:
    """Index of the floating base: the child of the world that is the robot.

    A robot differs from the objects around it by its actuators, or by joints besides a free
    joint. If no child of the world has those, it is the one with joints, then the one that moves
    at all, then the only one. In a world where nothing is free, the robot's own joints to the
    world, if any, are dropped.

    Args:
        model: compiled.
        named: links that the user named; the robot is the one that the first of them is part of.
        warnings: receives what else moves.

    Raises:
        RobotError: there is none, or several may be the robot and no link is named.
    """
    roots = [
        body
        for body in range(1, model.nbody)
        if model.body_parentid[body] == 0 and model.body_mocapid[body] < 0
    ]
    if not roots:
        raise RobotError("the model has no bodies", hint="check that this is the robot's file")
    moved = model.body_rootid[model.jnt_bodyid]
    moving = set(moved.tolist())
    jointed = set(moved[model.jnt_bodyid != moved].tolist())
    free = set(moved[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE].tolist())
    # Children with an actuated joint; muscles and tendons count.
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_tendon(model, data)
    mujoco.mj_transmission(model, data)
    degrees = data.moment_colind[data.actuator_moment != 0.0]
    driven = set(model.body_rootid[model.dof_bodyid[degrees]].tolist())
    kinds = (driven | (jointed & free), jointed, moving, set(roots))
    candidates = next(
        matching for kind in kinds if (matching := [root for root in roots if root in kind])
    )
    known = {model.body(body).name: int(model.body_rootid[body]) for body in range(1, model.nbody)}
    named_roots = [known[name] for name in named if known.get(name) in roots]
    if len(candidates) > 1 and not named_roots:
        names = [model.body(body).name for body in candidates]
        what = "move on their own" if moving else "are in the file"
        raise RobotError(
            f"it is not clear which is the robot: {len(names)} things {what}: {some_of(names)}",
            hint=f"say which: {'; or '.join(f'--trunk {name}' for name in names[:3])}. The others "
            "are left out; a robot must be one child of the world, with all its parts below it",
        )
    base = (named_roots or candidates)[0]
    if base not in free:
        warnings.add("no body has a free joint: taken as the floating base", model.body(base).name)
    for body in roots:
        if body != base and body in moving:
            warnings.add("not part of the robot, left out", model.body(body).name)
    return base


_ON_JOINT = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


def effort_limit(model: mujoco.MjModel, joint: int) -> float:
    """Largest torque or force of a joint's actuators [N m or N]; inf if none specifies one."""
    efforts = []
    for actuator in np.flatnonzero(model.actuator_trnid[:, 0] == joint):
        if int(model.actuator_trntype[actuator]) not in _ON_JOINT:
            continue
        # Before the gear: the specified range, or that of a motor's control.
        force = np.inf
        is_motor = (
            model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
            and model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
        )
        if model.actuator_forcelimited[actuator]:
            force = float(np.abs(model.actuator_forcerange[actuator]).max())
        elif is_motor and model.actuator_ctrllimited[actuator]:
            gain = abs(float(model.actuator_gainprm[actuator, 0]))
            force = gain * float(np.abs(model.actuator_ctrlrange[actuator]).max())
        efforts.append(abs(float(model.actuator_gear[actuator, 0])) * force)
    total = sum(efforts) if efforts else np.inf
    if model.jnt_actfrclimited[joint]:
        total = min(total, float(np.abs(model.jnt_actfrcrange[joint]).max()))
    return total if total > 0.0 else np.inf


def leader_of(
    model: mujoco.MjModel, joint: int, warnings: Warnings
) -> tuple[str, float, float] | None:
    """(joint, multiplier, offset) if a linear joint equality makes this joint follow another.

    MuJoCo holds `q1 - ref1 = a0 + a1 (q2 - ref2) + ...`; curves are not followed.
    """
    for index in np.flatnonzero(model.eq_type == mujoco.mjtEq.mjEQ_JOINT):
        leader = int(model.eq_obj2id[index])
        if model.eq_obj1id[index] != joint or not model.eq_active0[index]:
            continue
        constant, slope, *curved = model.eq_data[index, :5]
        if leader < 0 or np.any(curved):
            how = "are held by an equality" if leader < 0 else "follow another by a curve"
            warnings.add(f"joints that {how}, read as free", model.joint(joint).name)
            continue
        offset = constant + _reference(model, joint) - slope * _reference(model, leader)
        return model.joint(leader).name, float(slope), float(offset)
    return None


def _reference(model: mujoco.MjModel, joint: int) -> float:
    """Value of a joint at which its body is where the file places it [rad or m]."""
    return float(model.qpos0[model.jnt_qposadr[joint]])


_KINDS = {int(theirs): kind for kind, theirs in JOINT_TYPES.items()}


def connections_to(model: mujoco.MjModel, body: int, warnings: Warnings) -> Iterator[Connection]:
    """Connections of a body to its parent: one for each of its joints, or a rigid one."""
    name = model.body(body).name
    parent = model.body(int(model.body_parentid[body])).name
    place = Placement(rotation_from_quaternion(model.body_quat[body]), model.body_pos[body])
    first = int(model.body_jntadr[body])
    joints = []
    for index in range(first, first + int(model.body_jntnum[body])):
        if int(model.jnt_type[index]) in _KINDS:
            joints.append(index)
        else:
            warnings.add("ball joints, held at their reference", model.joint(index).name)
    if not joints:
        yield Connection(name, parent, name, place)
    for index in joints:
        degree = int(model.jnt_dofadr[index])
        is_limited = bool(model.jnt_limited[index])
        lower, upper = model.jnt_range[index] if is_limited else (-np.inf, np.inf)
        joint = Joint(
            model.joint(index).name,
            _KINDS[int(model.jnt_type[index])],
            np.array(model.jnt_axis[index]),
            float(lower),
            float(upper),
            effort=effort_limit(model, index),
            damping=float(np.ravel(model.dof_damping[degree])[0]),
            friction=float(model.dof_frictionloss[degree]),
            armature=float(model.dof_armature[degree]),
            mimic=leader_of(model, index, warnings),
        )
        anchor = Placement(np.eye(3), model.jnt_pos[index])
        # MuJoCo's joints do not displace their body at `ref`; those of the tree at zero.
        at_zero = joint_motion(joint, -_reference(model, index))
        child = name if index == joints[-1] else f"{name}:{joint.name}"
        yield Connection(
            joint.name,
            parent,
            child,
            place @ anchor @ at_zero,
            joint,
            child_in_joint=anchor.inverse(),
        )
        parent, place = child, Placement.identity()


_MEASURES = {ShapeKind.BOX: 3, ShapeKind.SPHERE: 1, ShapeKind.CYLINDER: 2, ShapeKind.CAPSULE: 2}
_PRIMITIVES = {int(GEOM_TYPES[kind]): kind for kind in _MEASURES}
UNBOUNDED = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))
"""Geoms of the ground, which belong to no link."""


def shapes_of(model: mujoco.MjModel, body: int) -> Iterator[Shape]:
    """Shapes of a body in its frame; meshes and ellipsoids as the boxes around them."""
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        kind = int(model.geom_type[geom])
        if kind in UNBOUNDED:
            continue
        place = Placement(rotation_from_quaternion(model.geom_quat[geom]), model.geom_pos[geom])
        if kind in _PRIMITIVES:
            shape = _PRIMITIVES[kind]
            size = model.geom_size[geom, : _MEASURES[shape]]
        else:
            shape, size = ShapeKind.BOX, model.geom_aabb[geom, 3:]
            place = place @ Placement(np.eye(3), model.geom_aabb[geom, :3])
        yield Shape(
            shape,
            tuple(float(length) for length in size),
            place.position,
            place.rotation,
            model.body(body).name,
            bool(model.geom_contype[geom] or model.geom_conaffinity[geom]),
        )


_TRAVEL_JOINTS = {int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_SLIDE)}
"""Joints that let a base travel; one that only turns is that of an arm."""

_LOOP_TYPES = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))
_LOOP_WARNING = (
    "closed chains are cut open at their connect or weld; the legs move as if open, and the loop "
    "is not enforced"
)
_TIE_WARNING = "connect or weld ties to something else, released, and its mass left out"


def read_mjcf(content: bytes, folder: Path | None, named: Sequence[str] = ()) -> Tree:
    """The robot of an MJCF model; everything else in its world is left out.

    Args:
        content: the file, unzipped.
        folder: to which includes and meshes are relative; None for the current folder.
        named: links that the user named, to find the robot among other bodies of the model.
    """
    warnings = Warnings()
    try:
        with mujoco_warnings_to(warnings):
            spec, missing_geoms = parse_mjcf(content, folder or Path.cwd(), warnings)
            model = spec.compile()
    except ValueError as error:
        raise mujoco_refusal(error) from error
    except RecursionError as error:
        raise RobotError(
            "the model's bodies are nested too deeply", hint="a thousand levels are too many"
        ) from error
    check_number_of_links(model.nbody)
    # Numbers that MuJoCo compiles but that are useless for computing.
    for kind, quantity in _NUMBERS:
        numbers = np.asarray(getattr(model, f"{kind}_{quantity}"))
        if not (np.abs(numbers) <= LARGEST_NUMBER).all():
            raise RobotError(
                f"the {quantity} of a {kind} is not finite or far too large",
                hint="lengths are in metres, masses in kilograms, angles in radians or degrees",
            )
    base = find_base(model, named, warnings)
    links: dict[str, Link] = {}
    children: dict[str, list[Connection]] = {}
    for body in np.flatnonzero(model.body_rootid == base).tolist():
        name = model.body(body).name
        # Meshes that are not there.
        missing_meshes = (
            Shape(ShapeKind.MESH, (1.0, 1.0, 1.0), np.zeros(3), np.eye(3), name, collides)
            for body_spec, collides in missing_geoms
            if body_spec.name == name
        )
        moments = np.diag(model.body_inertia[body])
        principal = MassProperties(float(model.body_mass[body]), np.zeros(3), moments)
        axes = rotation_from_quaternion(model.body_iquat[body])
        properties = principal.moved(axes, model.body_ipos[body])
        if model.body_gravcomp[body] != 0.0:
            warnings.add("bodies without gravity (gravcomp), simulated with gravity", name)
        links[name] = Link(name, properties, (*shapes_of(model, body), *missing_meshes))
        for connection in connections_to(model, body, warnings) if body != base else ():
            children.setdefault(connection.parent, []).append(connection)
            # Before the last of several joints there are links without mass.
            links.setdefault(connection.child, Link(connection.child, None))
    loops = []
    for index in np.flatnonzero(np.isin(model.eq_type, _LOOP_TYPES)):
        # Bodies, or the world (0), that are tied together.
        ends = np.array([model.eq_obj1id[index], model.eq_obj2id[index]])
        if model.eq_objtype[index] == mujoco.mjtObj.mjOBJ_SITE:
            ends = model.site_bodyid[ends]
        roots = set(model.body_rootid[ends].tolist())
        one, other = (model.body(int(end)).name for end in ends)
        if base in roots:
            name = model.eq(index).name or f"{one} to {other}"
            warnings.add(_LOOP_WARNING if roots == {base} else _TIE_WARNING, name)
        if roots == {base}:
            loops.append((one, other))
    tree = make_tree(spec.modelname, model.body(base).name, links, children, warnings)
    # Each keyframe has values of the tree's joints among others.
    addresses = {name: int(model.jnt_qposadr[model.joint(name).id]) for name in tree.joints}
    keyframes = {
        model.key(index).name or f"keyframe_{index}": {
            name: float(model.key_qpos[index, address]) for name, address in addresses.items()
        }
        for index in range(model.nkey)
    }
    return replace(
        tree,
        named_postures=keyframes,
        floats=bool(set(model.jnt_type[model.jnt_bodyid == base].tolist()) & _TRAVEL_JOINTS),
        loops=tuple(loops),
    )


_NUMBERS = (
    *product(("body",), ("pos", "quat", "ipos", "iquat", "mass", "inertia")),
    *product(("geom",), ("pos", "quat", "size", "aabb")),
    *(("jnt", "pos"), ("jnt", "axis"), ("key", "qpos")),
)
"""Numbers of a compiled model used in computations: kind of element, and quantity."""
