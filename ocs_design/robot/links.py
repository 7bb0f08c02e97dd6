"""Merges the links and joints of a file into moving bodies, and checks that they can be a robot.

Bodies are judged after rigidly joined links are merged: a single link is often a dummy that has no
mass, or all of it.
"""

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement
from ocs_design.common.wording import some_of
from ocs_design.robot.mass import MassProperties, combine, physical_defect, solid_defect
from ocs_design.robot.tree import Body, Joint, Shape, Tree


class Warnings:
    """Warnings about a robot; equal warnings on several links or joints become one sentence."""

    def __init__(self) -> None:
        self._subjects: dict[str, list[str]] = {}

    def add(self, what: str, subject: str = "") -> None:
        """Warn of `what`, naming the link, joint or file concerned."""
        self._subjects.setdefault(what, []).append(subject)

    def sentences(self) -> tuple[str, ...]:
        """One sentence per warning, with the names and, if there are many, their number."""
        return tuple(
            f"{what}: {some_of(subjects)}" if subjects[0] else what
            for what, subjects in self._subjects.items()
        )


def unused_name(stem: str, suffix: str, taken: Container[str]) -> str:
    """Stem and suffix joined, with the first number between them that makes the name new."""
    name, number = stem + suffix, 2
    while name in taken:
        name, number = f"{stem}_{number}{suffix}", number + 1
    return name


MOST_LINKS = 2000
"""Largest number of links; public robots have up to 150, and time grows with the square."""


def check_number_of_links(count: int) -> None:
    """Refuse a file that is not a robot and would take minutes to compute.

    Raises:
        RobotError: there are too many.
    """
    if count > MOST_LINKS:
        raise RobotError(
            f"the file has {count} links, more than {MOST_LINKS}",
            hint="remove what is not part of the robot, or merge links that move as one",
        )


@dataclass(frozen=True, eq=False)
class Link:
    """Link of a URDF, or body of an MJCF model.

    Attributes:
        name: unique in the file.
        mass_properties: raw, in the link's frame; None if the file has none.
        shapes: in the link's frame.
    """

    name: str
    mass_properties: MassProperties | None
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True, eq=False)
class Connection:
    """Joint that attaches a link to another.

    Attributes:
        name: unique in the file.
        parent, child: links.
        placement: of the joint's frame in the parent's frame at zero.
        joint: None if the two are rigidly joined.
        child_in_joint: the child's frame in the joint's frame.
        held: the file's type of a joint that is locked because it has no single coordinate; else
            empty.
    """

    name: str
    parent: str
    child: str
    placement: Placement
    joint: Joint | None = None
    child_in_joint: Placement = field(default_factory=Placement.identity)
    held: str = ""


Children = Mapping[str, Sequence[Connection]]
"""Connections below each link, in file order."""


def make_tree(
    name: str, root: str, links: Mapping[str, Link], children: Children, warnings: Warnings
) -> Tree:
    """Tree of a robot whose base is the link `root`, with mass properties that can exist.

    Its warnings are those of `warnings`, to which this function adds.

    Raises:
        RobotError: the robot as a whole cannot exist.
    """
    bodies = resolve_mimics(merge_fixed_links(root, links, children, warnings), warnings)
    tree = Tree(name, bodies)
    check_mass_properties(tree, warnings)
    return replace(tree, warnings=warnings.sentences())


def merge_fixed_links(
    root: str, links: Mapping[str, Link], children: Children, warnings: Warnings
) -> tuple[Body, ...]:
    """Moving bodies from `root` down, depth first in file order, parents before children."""
    identity = Placement.identity()
    # For each body its name, parent, placement and joint; and its links with their frames in it.
    heads: list[tuple[str, int, Placement, Joint | None]] = [(root, -1, identity, None)]
    members = [[(links[root], identity)]]
    frame_of_link = {root: (0, identity)}
    # An explicit stack: chains of thousands of links would exhaust Python's.
    stack = list(reversed(children.get(root, ())))
    while stack:
        connection = stack.pop()
        index, place = frame_of_link[connection.parent]
        place = place @ connection.placement
        if connection.held:
            warnings.add(f"{connection.held} joints, held at zero", connection.name)
        if connection.joint is not None:
            heads.append((connection.child, index, place, connection.joint))
            members.append([])
            index, place = len(heads) - 1, identity
        place = place @ connection.child_in_joint
        members[index].append((links[connection.child], place))
        frame_of_link[connection.child] = (index, place)
        stack.extend(reversed(children.get(connection.child, ())))
    bodies = []
    for head, joined in zip(heads, members, strict=True):
        parts = [(link.mass_properties or MassProperties.zero(), frame) for link, frame in joined]
        shapes = (
            replace(
                shape,
                position=frame.point(shape.position),
                rotation=frame.rotation @ shape.rotation,
            )
            for link, frame in joined
            for shape in link.shapes
        )
        bodies.append(
            Body(
                *head,
                combine(part.moved(frame.rotation, frame.position) for part, frame in parts),
                {link.name: frame for link, frame in joined},
                {link.name: part.mass for (link, _), (part, _) in zip(joined, parts, strict=True)},
                tuple(shapes),
            )
        )
    return tuple(bodies)


def resolve_mimics(bodies: Sequence[Body], warnings: Warnings) -> tuple[Body, ...]:
    """The bodies, with every mimic tied to the joint at the end of its chain of leaders."""
    joints = {body.joint.name: body.joint for body in bodies if body.joint is not None}

    def resolved(joint: Joint) -> Joint:
        """The joint with its last leader, or free where there is none."""
        multiplier, offset, leader = 1.0, 0.0, joint
        seen = set[str]()
        while leader.mimic is not None:
            seen.add(leader.name)
            name, factor, shift = leader.mimic
            if name not in joints or name in seen:
                why = "each other in a circle" if name in seen else "a joint that does not move"
                warnings.add(f"joints that mimic {why}, read as free", joint.name)
                return replace(joint, mimic=None)
            multiplier, offset = multiplier * factor, offset + multiplier * shift
            leader = joints[name]
        return replace(joint, mimic=(leader.name, multiplier, offset))

    return tuple(
        body
        if body.joint is None or body.joint.mimic is None
        else replace(body, joint=resolved(body.joint))
        for body in bodies
    )


def check_mass_properties(tree: Tree, warnings: Warnings) -> None:
    """Refuse a massless base or a robot that cannot exist; warn of odd bodies.

    Raises:
        RobotError: the robot as a whole cannot exist.
    """
    base = tree.bodies[0]
    if base.mass_properties.mass == 0.0:
        links = some_of([repr(name) for name in base.links])
        raise RobotError(
            f"the floating base has no mass: no <inertial> with a mass in {links}",
            hint=f"give link {base.name!r} its mass and inertia; if it only holds the robot in the "
            "world, remove it together with its joint, or make that joint floating. For a first "
            "answer the whole robot's figures suffice: --mass and --inertia IXX,IYY,IZZ",
        )
    check_total_mass(tree.locked_mass_properties({}, base.name), tree)
    for body in tree.bodies:
        defect = physical_defect(body.mass_properties)
        if defect is not None:
            warnings.add(f"link {body.name!r} {defect}; its numbers are used as they are")
    # A chain without mass gives one warning, naming its first body.
    carried = [body.mass_properties.mass for body in tree.bodies]
    for index in range(len(tree.bodies) - 1, 0, -1):
        carried[tree.bodies[index].parent] += carried[index]
    for body, mass in zip(tree.bodies, carried, strict=True):
        if mass == 0.0 and carried[body.parent] > 0.0:
            warnings.add("moving links without mass at the end of a chain", body.name)


def check_total_mass(properties: MassProperties, tree: Tree) -> None:
    """Refuse a robot that cannot exist, or has no inertia to turn.

    Args:
        properties: mass properties of the whole robot, in any frame.
        tree: of the robot, to name the links at fault.
    """
    defect = solid_defect(properties)
    if defect is not None:
        worst = [body.name for body in tree.bodies if physical_defect(body.mass_properties)]
        first = f", first of {some_of([repr(name) for name in worst])}" if worst else ""
        raise RobotError(
            f"the robot as a whole {defect}",
            hint=f"correct the inertias in the file{first}: in kg m2, about each link's own centre "
            "of mass",
        )
