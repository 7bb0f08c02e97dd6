"""Whether a tree can be a robot: what cannot be is an error, what is odd is a remark.

Bodies are judged after lumping: links by themselves are often dummies that hold no mass, or all.
"""

import numpy as np

from ocs_design.exceptions import RobotError
from ocs_design.robot.mass_properties import physical_defect
from ocs_design.robot.remarks import Remarks, listed
from ocs_design.robot.tree import Body, Tree


def check_plausible(tree: Tree, remarks: Remarks) -> None:
    """Refuse a massless base or a robot that no matter could make; remark on odd bodies."""
    _check_base(tree.bodies[0])
    _check_whole(tree)
    for body in tree.bodies:
        defect = physical_defect(body.mass_properties)
        if defect is not None:
            remarks.add(f"link {body.name!r} {defect}; its numbers are used as they are")
    for body in _massless_ends(tree):
        remarks.add("moving links without mass at the end of a chain", body.name)


def _check_base(base: Body) -> None:
    if base.mass_properties.mass != 0.0:
        return
    links = listed([repr(name) for name in base.links])
    raise RobotError(
        f"the floating base has no mass: no <inertial> with a mass in {links}",
        hint=f"give link {base.name!r} its mass and inertia; if it only holds the robot in the "
        "world, remove it together with its joint, or make that joint floating; "
        "see docs/howto-inertials.md",
    )


def _check_whole(tree: Tree) -> None:
    whole = tree.locked_mass_properties({}, tree.bodies[0].name)
    defect = physical_defect(whole)
    if defect is None and np.linalg.eigvalsh(whole.inertia)[0] <= 0.0:
        defect = "has no inertia about one of its axes"
    if defect is not None:
        worst = listed([repr(each.name) for each in tree.bodies if _is_defective(each)])
        raise RobotError(
            f"the robot as a whole {defect}",
            hint="correct the inertias in the file" + (f", first of {worst}" if worst else ""),
        )


def _is_defective(body: Body) -> bool:
    return physical_defect(body.mass_properties) is not None


def _massless_ends(tree: Tree) -> list[Body]:
    """Bodies without mass that carry nothing with mass: the first of each such chain."""
    carried = [body.mass_properties.mass for body in tree.bodies]
    for index in range(len(tree.bodies) - 1, 0, -1):
        carried[tree.bodies[index].parent] += carried[index]
    return [
        body
        for body, mass in zip(tree.bodies, carried, strict=True)
        if mass == 0.0 and carried[body.parent] > 0.0
    ]
