"""From a robot file to a robot: trunk, legs, posture and mass properties."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ocs_design.exceptions import RobotError
from ocs_design.robot.doubts.doubts import doubts_of
from ocs_design.robot.files.loader import load
from ocs_design.robot.mass_properties import MassProperties, physical_defect
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance.base_frame import BASE_FRAME, with_base_frame
from ocs_design.robot.stance.leg_geometry import convention_warnings
from ocs_design.robot.stance.legs import find_legs
from ocs_design.robot.stance.posture import resolve_posture, unknown_name
from ocs_design.robot.stance.trunk import find_trunk
from ocs_design.robot.tree import Tree


def read_robot(
    source: str | Path,
    *,
    trunk: str | None = None,
    posture: str | None = None,
    joints: Mapping[str, float] | None = None,
    package_paths: Mapping[str, Path] | None = None,
) -> Robot:
    """Read a robot and measure it in its nominal posture.

    Args:
        source: URDF, xacro or MJCF file, gzipped or not; `-` for standard input.
        trunk: link that carries the device; None: found (see `find_trunk`).
        posture: `zero`, `stand` or a posture named in the file; None: see `resolve_posture`.
        joints: values of single joints [rad or m] that replace the posture's.
        package_paths: folder of each package that `package://` addresses name.
    """
    loaded = load(source, package_paths=package_paths)
    tree = loaded.tree
    legs = find_legs(tree)
    if trunk is None:
        found = find_trunk(tree, legs)
        tree, mount, told = with_base_frame(tree, found, legs)
        base = found if mount is None else BASE_FRAME
    else:
        base, mount = _checked_trunk(tree, trunk), None
        told = tuple(convention_warnings(tree, base, legs))
    chosen = resolve_posture(tree, base, legs, posture, joints or {})
    weighed = tree.locked_mass_properties(chosen.values, base)
    _check_physical(weighed)
    doubts = doubts_of(tree, base, legs, chosen.values, weighed)
    warnings = (*tree.warnings, *told, *chosen.warnings, *doubts)
    return Robot(
        name=tree.name,
        source=loaded.source,
        sha256=loaded.sha256,
        format=loaded.format,
        content=loaded.content,
        tree=tree,
        trunk=base,
        floating_base=tree.bodies[0].name,
        posture=chosen.values,
        posture_name=chosen.name,
        mass_properties=weighed,
        legs=legs,
        standing_height=chosen.standing_height,
        warnings=tuple(dict.fromkeys(warnings)),
        mount=mount,
    )


def _checked_trunk(tree: Tree, trunk: str) -> str:
    if trunk not in tree.body_of_link:
        raise unknown_name("link", trunk, tree.body_of_link)
    return trunk


def _check_physical(weighed: MassProperties) -> None:
    """Refuse a robot that cannot exist or that nothing can turn."""
    hint = (
        "correct the <inertial> elements of the links; `inspect` lists what is odd about them; "
        "see docs/howto-inertials.md"
    )
    if weighed.mass == 0.0:
        raise RobotError("the robot has no mass: no link has an <inertial>", hint=hint)
    defect = physical_defect(weighed)
    if defect is not None:
        raise RobotError(f"the robot as a whole {defect}", hint=hint)
    if np.linalg.eigvalsh(weighed.inertia)[0] <= 0.0:
        raise RobotError("the robot as a whole has no inertia about one of its axes", hint=hint)
