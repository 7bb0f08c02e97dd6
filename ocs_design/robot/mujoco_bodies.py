"""Builds MuJoCo's MjSpec from the kinematic tree, body by body, with inertias that it accepts.

MuJoCo refuses a moving body without mass, and one whose principal moments break the triangle
inequality in the last bit. Sizing does not use the inertias changed here.

MuJoCo's own URDF reader loses the root link's mass and refuses links without inertia before it
joins them; the tree has them joined already.
"""

from collections.abc import Mapping, Set
from itertools import accumulate, product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.links import Warnings, unused_name
from ocs_design.robot.mass import MassProperties, physical_defect
from ocs_design.robot.meshes import binary_stl_facets, check_mesh_file, load_with_trimesh
from ocs_design.robot.tree import Body, JointKind, Shape, ShapeKind, Tree


def quaternion(rotation: FloatArray) -> FloatArray:
    """The unit quaternion (w, x, y, z) of a rotation matrix (3, 3), shape (4,)."""
    wxyz = np.empty(4)
    mujoco.mju_mat2Quat(wxyz, np.ascontiguousarray(rotation, dtype=np.float64).ravel())
    return wxyz


VISUAL_BYTES = 16 * 2**20
"""Largest total size of visual meshes [bytes]; a .dae takes 0.1 s and 25 MB of memory per MB.

A CAD model exported with every screw as a trunk's visual has 30 MB and 350,000 facets, more than
everything else together.
"""


def oversized_visuals(tree: Tree) -> Set[Path]:
    """Visual mesh files that do not fit into `VISUAL_BYTES` when the smallest are taken first."""
    shapes = [shape for body in tree.bodies for shape in body.shapes]
    touching = {shape.mesh for shape in shapes if shape.collides}
    showing = {shape.mesh for shape in shapes if shape.mesh is not None} - touching
    sizes = sorted((path.stat().st_size, path) for path in showing if path is not None)
    totals = accumulate(size for size, _ in sizes)
    return frozenset(
        path for total, (_, path) in zip(totals, sizes, strict=True) if total > VISUAL_BYTES
    )


NEGLIGIBLE_MASS = 1e-9
"""Mass of a massless moving body in MuJoCo [kg]; its limit is 1e-15."""

NEGLIGIBLE_INERTIA = 1e-12
"""Smallest principal moment in MuJoCo [kg m^2]; its limit is 1e-15."""


def inertial(raw: MassProperties) -> tuple[Mapping[str, Any], str | None]:
    """Mass properties as arguments of `add_body`, and what had to be changed for MuJoCo, if any.

    They are changed as little as necessary; the warning is to be followed by the body's name.
    """
    moments, axes = np.linalg.eigh(raw.inertia)
    if np.linalg.det(axes) < 0.0:
        axes = axes * [-1.0, 1.0, 1.0]
    accepted = nearest_physical_moments(moments, NEGLIGIBLE_INERTIA)
    warning = None
    if physical_defect(raw) is not None:
        figures = ", ".join(f"{moment:.4g}" for moment in accepted)
        warning = f"simulated with the nearest possible principal moments ({figures} kg m^2)"
    elif raw.mass < NEGLIGIBLE_MASS:
        warning = f"moving links without mass, simulated with {NEGLIGIBLE_MASS:g} kg"
    return {
        "mass": max(raw.mass, NEGLIGIBLE_MASS),
        "ipos": raw.com,
        "iquat": quaternion(axes),
        "inertia": accepted,
        "explicitinertial": True,
    }, warning


def nearest_physical_moments(moments: FloatArray, floor: float) -> FloatArray:
    """The principal moments nearest to `moments` (ascending) that a rigid body can have.

    The least-squares change under `m >= floor` and `m0 + m1 >= m2`: a quadratic program so small
    that trying each active set solves it exactly.

    Args:
        moments: ascending [kg m^2], shape (3,).
        floor: smallest moment allowed [kg m^2].
    """
    physical = []
    for floored, triangle in product(range(4), (False, True)):
        # The least change that raises the first moments to the floor.
        shifted = np.array(moments, dtype=np.float64)
        shifted[:floored] = floor
        free = 3 - floored
        if triangle and free:
            excess = shifted[2] - shifted[0] - shifted[1]
            shifted[floored:2] += excess / free
            # MuJoCo compares to the last bit.
            shifted[2] = min(shifted[2] - excess / free, shifted[0] + shifted[1])
        if shifted.min() >= floor and shifted[0] + shifted[1] >= shifted.max():
            physical.append(shifted)
    return min(physical, key=lambda candidate: float(np.sum((candidate - moments) ** 2)))


_STL_MOST_FACETS = 200_000
"""Largest number of facets that MuJoCo reads from an STL."""


class MeshLibrary:
    """Meshes of a model: each file and scale once, except those that cannot be read.

    Attributes:
        unreadable: files that could not be read, in the order met.
    """

    def __init__(self, spec: mujoco.MjSpec, left_out: Set[Path] = frozenset()) -> None:
        """Fill `spec`; files in `left_out` are not opened."""
        self.unreadable: dict[Path, str] = {}
        self._left_out = left_out
        self._spec = spec
        self._assets: dict[Path, str] = {}
        self._meshes: dict[tuple[Path, tuple[float, ...]], str] = {}

    def name_of(self, shape: Shape) -> str | None:
        """Name in the model of a shape's mesh; None if MuJoCo cannot use it."""
        if shape.mesh is None or shape.mesh in self._left_out or shape.mesh in self.unreadable:
            return None
        path, key = shape.mesh, (shape.mesh, shape.size)
        if path not in self._assets:
            try:
                suffix, content = read_mesh(path)
            except Exception as error:  # Mesh readers fail in as many ways as meshes are broken.
                self.unreadable[path] = str(error) or type(error).__name__
                return None
            self._assets[path] = unused_name(path.stem, suffix, self._spec.assets)
            self._spec.assets[self._assets[path]] = content
        if key not in self._meshes:
            asset = self._assets[path]
            name = unused_name(Path(asset).stem, "", self._meshes.values())
            # Bodies have explicit inertials, and a shell needs no closed surface.
            shell = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            self._spec.add_mesh(name=name, file=asset, scale=shape.size, inertia=shell)
            self._meshes[key] = name
        return self._meshes[key]


def read_mesh(path: Path) -> tuple[str, bytes]:
    """Suffix and bytes of a mesh that MuJoCo reads; other formats become STL or OBJ in metres."""
    check_mesh_file(path)
    suffix = path.suffix.lower()
    if suffix == ".obj" or 0 < binary_stl_facets(path) <= _STL_MOST_FACETS:
        return suffix, path.read_bytes()
    mesh = load_with_trimesh(path)
    if len(mesh.faces) > _STL_MOST_FACETS:
        return ".obj", str(mesh.export(file_type="obj", include_normals=False)).encode()
    content = mesh.export(file_type="stl")
    assert isinstance(content, bytes)
    return ".stl", content


def drop_refused_meshes(spec: mujoco.MjSpec, warnings: Warnings) -> None:
    """Remove each mesh that MuJoCo cannot compile, with its geoms."""
    for mesh in list(spec.meshes):
        trial = mujoco.MjSpec()
        trial.assets[mesh.file] = spec.assets[mesh.file]
        trial.add_mesh(name=mesh.name, file=mesh.file, scale=mesh.scale, inertia=mesh.inertia)
        trial.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name)
        try:
            trial.compile()
        except ValueError:
            warnings.add("meshes that MuJoCo refuses, left out", mesh.file)
            for geom in [geom for geom in spec.geoms if geom.meshname == mesh.name]:
                spec.delete(geom)
            spec.delete(mesh)


VISUAL_GROUP = 2
"""Group of visual geoms; viewers show it."""

HIDDEN_GROUP = 3
"""Group of the collision geoms of bodies that have visual geoms; viewers hide it."""

JOINT_TYPES = {
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
    """Names of the bodies in MuJoCo: their own, except `world`, which MuJoCo reserves."""
    substitute = unused_name("world_link", "", {body.name for body in tree.bodies})
    return tuple(substitute if body.name == "world" else body.name for body in tree.bodies)


def spec_from_tree(tree: Tree, warnings: Warnings, *, visuals: bool) -> mujoco.MjSpec:
    """The tree as a MuJoCo model with a free root.

    Args:
        tree: of a URDF, or of a robot given by hand.
        warnings: receives what was changed for MuJoCo.
        visuals: whether to load visual shapes.
    """
    spec = mujoco.MjSpec()
    spec.modelname = tree.name
    spec.compiler.degree = False
    left_out = oversized_visuals(tree) if visuals else frozenset()
    meshes = MeshLibrary(spec, left_out)
    specs: list[mujoco.MjsBody] = []
    for name, body in zip(body_names(tree), tree.bodies, strict=True):
        parent = spec.worldbody if body.parent < 0 else specs[body.parent]
        specs.append(_add_body(parent, name, body, warnings))
        shapes = [shape for shape in body.shapes if visuals or shape.collides]
        drawn = [
            shape for shape in shapes if shape.kind is not ShapeKind.MESH or meshes.name_of(shape)
        ]
        visual_count, shown_count = (
            sum(not shape.collides for shape in group) for group in (shapes, drawn)
        )
        # If a visual mesh is missing, the collision geoms are shown instead.
        collision_group = HIDDEN_GROUP if visual_count and shown_count == visual_count else 0
        for shape in drawn:
            geom = specs[-1].add_geom(
                type=GEOM_TYPES[shape.kind], pos=shape.position, quat=quaternion(shape.rotation)
            )
            if shape.color is not None:
                geom.rgba = shape.color
            if shape.kind is ShapeKind.MESH:
                geom.meshname = meshes.name_of(shape)
            else:
                geom.size = [*shape.size, 0.0, 0.0][:3]
            if not shape.collides:
                geom.contype = geom.conaffinity = 0
            geom.group = collision_group if shape.collides else VISUAL_GROUP
    for name, joint in tree.joints.items():
        leader, multiplier, offset = joint.mimic or ("", 1.0, 0.0)
        if leader in tree.joints:
            spec.add_equality(
                type=mujoco.mjtEq.mjEQ_JOINT,
                objtype=mujoco.mjtObj.mjOBJ_JOINT,
                name1=name,
                name2=leader,
                data=[offset, multiplier, *[0.0] * 10],
            )
    for path, why in meshes.unreadable.items():
        warnings.add(f"meshes left out ({why})", path.name)
    for path in sorted(left_out):
        warnings.add("meshes too large to show in the MuJoCo model, left out", path.name)
    return spec


def _add_body(parent: mujoco.MjsBody, name: str, body: Body, warnings: Warnings) -> mujoco.MjsBody:
    mass_properties, warning = inertial(body.mass_properties)
    if warning is not None:
        warnings.add(warning, body.name)
    spec = parent.add_body(
        name=name,
        pos=body.placement.position,
        quat=quaternion(body.placement.rotation),
        **mass_properties,
    )
    joint = body.joint
    if joint is None:
        spec.add_freejoint()
        return spec
    limits = np.array([joint.lower, joint.upper])
    limited = bool(np.isfinite(limits).any())
    spec.add_joint(
        name=joint.name,
        type=JOINT_TYPES[joint.kind],
        axis=joint.axis,
        limited=limited,
        # MuJoCo has no one-sided limits.
        range=np.clip(limits, -mujoco.mjMAXVAL, mujoco.mjMAXVAL) if limited else (0.0, 0.0),
        damping=(joint.damping, 0.0, 0.0),
        frictionloss=joint.friction,
        armature=joint.armature,
    )
    return spec
