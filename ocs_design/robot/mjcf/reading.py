"""Reads a MJCF model into a tree of moving bodies, through MuJoCo's own compiler.

Masses, frames and joints are those of the compiled model, so that defaults, included files, units
and inertias from geoms count exactly as MuJoCo counts them.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.links import Connection, Link, check_number_of_links
from ocs_design.robot.files.lumping import lump
from ocs_design.robot.files.mimics import resolve_mimics
from ocs_design.robot.files.plausibility import check_plausible
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.mjcf.base import bodies_of, find_base
from ocs_design.robot.mjcf.joints import connections_to
from ocs_design.robot.mjcf.shapes import shapes_of
from ocs_design.robot.mjcf.spec import mujoco_refusal, parse_mjcf
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.rotations import rotation_from_quaternion
from ocs_design.robot.spec.warnings import mujoco_warnings_to
from ocs_design.robot.tree import LARGEST_NUMBER, Tree

_LOOPS = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))


def read_mjcf(content: bytes, folder: Path | None) -> Tree:
    """The robot of a MJCF model; what else stands in its world is left out.

    Args:
        content: the file, unzipped.
        folder: that includes and meshes are relative to; None for the current folder.
    """
    remarks = Remarks()
    try:
        with mujoco_warnings_to(remarks):
            spec = parse_mjcf(content, folder or Path.cwd(), remarks)
            model = spec.compile()
    except ValueError as error:
        raise mujoco_refusal(error) from error
    except RecursionError as error:
        raise RobotError(
            "the model's bodies are nested too deeply", hint="a thousand levels are too many"
        ) from error
    check_number_of_links(model.nbody)
    _check_numbers(model)
    tree = _tree(model, spec.modelname, remarks)
    check_plausible(tree, remarks)
    return replace(tree, named_postures=_keyframes(model, tree), warnings=remarks.sentences())


_NUMBERS = {
    "body": ("pos", "quat", "ipos", "iquat", "mass", "inertia"),
    "geom": ("pos", "quat", "size", "aabb"),
    "jnt": ("pos", "axis"),
    "key": ("qpos",),
}
"""Of a compiled model, by what they are of."""


def _check_numbers(model: mujoco.MjModel) -> None:
    """Refuse numbers that MuJoCo compiles but that nothing can be computed from."""
    named = [(kind, each) for kind, quantities in _NUMBERS.items() for each in quantities]
    for kind, quantity in named:
        numbers = np.asarray(getattr(model, f"{kind}_{quantity}"))
        if not (np.abs(numbers) <= LARGEST_NUMBER).all():
            raise RobotError(
                f"the {quantity} of a {kind} is not finite or beyond all measure",
                hint="metres, kilograms and radians or degrees are meant",
            )


def _tree(model: mujoco.MjModel, name: str, remarks: Remarks) -> Tree:
    base = find_base(model, remarks)
    links: dict[str, Link] = {}
    children: dict[str, list[Connection]] = {}
    for body in bodies_of(model, base):
        link = _link(model, body)
        links[link.name] = link
        for connection in connections_to(model, body, remarks) if body != base else ():
            children.setdefault(connection.parent, []).append(connection)
            # In front of the last of several joints stand links without mass.
            links.setdefault(connection.child, Link(connection.child, None))
    for index in np.flatnonzero(np.isin(model.eq_type, _LOOPS)):
        remarks.add(
            "loops closed by connect or weld, not enforced", model.eq(index).name or str(index)
        )
    bodies = lump(model.body(base).name, links, children, remarks)
    return Tree(name, resolve_mimics(bodies, remarks))


def _link(model: mujoco.MjModel, body: int) -> Link:
    principal = MassProperties(
        float(model.body_mass[body]), np.zeros(3), np.diag(model.body_inertia[body])
    )
    axes = rotation_from_quaternion(model.body_iquat[body])
    return Link(
        model.body(body).name,
        principal.moved(axes, model.body_ipos[body]),
        tuple(shapes_of(model, body)),
    )


def _keyframes(model: mujoco.MjModel, tree: Tree) -> Mapping[str, Mapping[str, float]]:
    """Values of the tree's joints in each keyframe."""
    addresses = {name: int(model.jnt_qposadr[model.joint(name).id]) for name in tree.joints}
    return {
        model.key(index).name or f"keyframe_{index}": {
            name: float(model.key_qpos[index, address]) for name, address in addresses.items()
        }
        for index in range(model.nkey)
    }
