"""From the kinematic tree to MuJoCo's MjSpec, body by body.

MuJoCo's own URDF reader loses the root link's mass and refuses links without inertia before it
joins them; the tree has them joined already.
"""

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from ocs_design.robot.remarks import Remarks
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.spec.inertia import inertial
from ocs_design.robot.spec.meshes import MeshLibrary
from ocs_design.robot.spec.visuals import oversized_visuals
from ocs_design.robot.tree import Body, Joint, JointKind, Shape, ShapeKind, Tree

VISUAL_GROUP = 2
"""Geoms to look at; viewers show it."""
HIDDEN_GROUP = 3
"""Collision geoms of bodies that have something better to look at; viewers hide it."""

_JOINT_TYPES = {
    JointKind.REVOLUTE: mujoco.mjtJoint.mjJNT_HINGE,
    JointKind.PRISMATIC: mujoco.mjtJoint.mjJNT_SLIDE,
}
GEOM_TYPES = {
    ShapeKind.BOX: mujoco.mjtGeom.mjGEOM_BOX,
    ShapeKind.SPHERE: mujoco.mjtGeom.mjGEOM_SPHERE,
    ShapeKind.CYLINDER: mujoco.mjtGeom.mjGEOM_CYLINDER,
    ShapeKind.CAPSULE: mujoco.mjtGeom.mjGEOM_CAPSULE,
    ShapeKind.MESH: mujoco.mjtGeom.mjGEOM_MESH,
}


def body_names(tree: Tree) -> tuple[str, ...]:
    """Name in MuJoCo of each body: its own, but for `world`, which MuJoCo keeps for itself."""
    taken = {body.name for body in tree.bodies}
    substitute = "world_link"
    while substitute in taken:
        substitute += "_"
    return tuple(substitute if body.name == "world" else body.name for body in tree.bodies)


def spec_from_tree(tree: Tree, remarks: Remarks, *, visuals: bool) -> mujoco.MjSpec:
    """The tree with a free root.

    Args:
        tree: a URDF's, or one made by hand.
        remarks: takes what had to be changed for MuJoCo.
        visuals: whether to load what is only to look at.
    """
    spec = mujoco.MjSpec()
    spec.modelname = tree.name
    spec.compiler.degree = False
    left_out = oversized_visuals(tree) if visuals else frozenset()
    meshes = MeshLibrary(spec, left_out)
    made: list[mujoco.MjsBody] = []
    for name, body in zip(body_names(tree), tree.bodies, strict=True):
        parent = spec.worldbody if body.parent < 0 else made[body.parent]
        made.append(_add_body(parent, name, body, remarks))
        _add_geoms(made[-1], body.shapes if visuals else _colliding(body.shapes), meshes)
    _add_mimics(spec, tree)
    for path, why in meshes.unreadable.items():
        remarks.add(f"meshes left out ({why})", path.name)
    for path in sorted(left_out):
        remarks.add("meshes too large to be shown in the MuJoCo model, left out", path.name)
    return spec


def _add_body(parent: mujoco.MjsBody, name: str, body: Body, remarks: Remarks) -> mujoco.MjsBody:
    mass = inertial(body.mass_properties)
    if mass.remark is not None:
        remarks.add(mass.remark, body.name)
    made = parent.add_body(
        name=name,
        pos=body.placement.position,
        quat=quaternion(body.placement.rotation),
        mass=mass.mass,
        ipos=mass.position,
        iquat=mass.quaternion,
        inertia=mass.moments,
        explicitinertial=True,
    )
    if body.joint is None:
        made.add_freejoint()
    else:
        _add_joint(made, body.joint)
    return made


def _add_joint(body: mujoco.MjsBody, joint: Joint) -> None:
    limits = np.array([joint.lower, joint.upper])
    limited = bool(np.isfinite(limits).any())
    body.add_joint(
        name=joint.name,
        type=_JOINT_TYPES[joint.kind],
        axis=joint.axis,
        limited=limited,
        # MuJoCo has no one-sided limits.
        range=np.clip(limits, -mujoco.mjMAXVAL, mujoco.mjMAXVAL) if limited else (0.0, 0.0),
        damping=(joint.damping, 0.0, 0.0),
        frictionloss=joint.friction,
        armature=joint.armature,
    )


def _add_geoms(body: mujoco.MjsBody, shapes: Sequence[Shape], meshes: MeshLibrary) -> None:
    drawn = [shape for shape in shapes if shape.kind is not ShapeKind.MESH or meshes.name_of(shape)]
    wanted, shown = (sum(not shape.collides for shape in each) for each in (shapes, drawn))
    # Where something to look at is missing, what touches stands in for it.
    group_of_touching = HIDDEN_GROUP if wanted and shown == wanted else 0
    for shape in drawn:
        geom = body.add_geom(
            type=GEOM_TYPES[shape.kind],
            pos=shape.position,
            quat=quaternion(shape.rotation),
        )
        if shape.color is not None:
            geom.rgba = shape.color
        if shape.kind is ShapeKind.MESH:
            geom.meshname = meshes.name_of(shape)
        else:
            geom.size = [*shape.size, 0.0, 0.0][:3]
        if not shape.collides:
            geom.contype = geom.conaffinity = 0
        geom.group = group_of_touching if shape.collides else VISUAL_GROUP


def _colliding(shapes: Iterable[Shape]) -> tuple[Shape, ...]:
    return tuple(shape for shape in shapes if shape.collides)


def _add_mimics(spec: mujoco.MjSpec, tree: Tree) -> None:
    for name, joint in tree.joints.items():
        if joint.mimic is None or joint.mimic[0] not in tree.joints:
            continue
        leader, multiplier, offset = joint.mimic
        spec.add_equality(
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=name,
            name2=leader,
            data=[offset, multiplier, *[0.0] * 10],
        )
