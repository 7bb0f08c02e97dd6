"""How the links of a URDF hang together, and what must hold for them to be one robot."""

from collections.abc import Iterable, Mapping, Sequence

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.links import Children, Connection, Link
from ocs_design.robot.remarks import listed


def unique(names: Iterable[str], what: str) -> None:
    """Refuse names that occur twice."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise RobotError(f"two {what}s are named {name!r}", hint="rename one of them")
        seen.add(name)


def children_by_parent(links: Mapping[str, Link], connections: Sequence[Connection]) -> Children:
    """The joints below each link, in file order; every link has at most one parent."""
    children: dict[str, list[Connection]] = {}
    above: dict[str, Connection] = {}
    for connection in connections:
        for link in (connection.parent, connection.child):
            if link not in links:
                raise RobotError(
                    f"joint {connection.name!r} names a link that is not in the file: {link!r}",
                    hint=f"correct the name or add the link; there are {_quoted(links)}",
                )
        if connection.child in above:
            raise RobotError(
                f"link {connection.child!r} is the child of two joints, "
                f"{above[connection.child].name!r} and {connection.name!r}: a loop",
                hint="a URDF is a tree: cut the loop by removing one of the two joints",
            )
        above[connection.child] = connection
        children.setdefault(connection.parent, []).append(connection)
    return children


def find_root(links: Mapping[str, Link], children: Children) -> str:
    """The one link without a parent, from which all others can be reached."""
    below = {connection.child for siblings in children.values() for connection in siblings}
    roots = [name for name in links if name not in below]
    if len(roots) > 1:
        raise RobotError(
            f"the file holds {len(roots)} separate trees, with the roots {_quoted(roots)}",
            hint="join them with a fixed joint, or remove what is not part of the robot",
        )
    reached = _reachable(roots, children)
    lost = [name for name in links if name not in reached]
    if lost:
        raise RobotError(
            f"the links {_quoted(lost)} form a loop of joints",
            hint="a URDF is a tree: cut the loop by removing one of its joints",
        )
    return roots[0]


def free_base(root: str, links: Mapping[str, Link], children: Children) -> str:
    """The link that flies: the root, or what a `floating` joint hangs on a massless root."""
    while True:
        siblings = children.get(root, ())
        weighs = links[root].mass_properties is not None
        if weighs or len(siblings) != 1 or not siblings[0].held:
            return root
        root = siblings[0].child


def _reachable(roots: Sequence[str], children: Children) -> set[str]:
    reached: set[str] = set()
    stack = list(roots)
    while stack:
        name = stack.pop()
        reached.add(name)
        stack.extend(connection.child for connection in children.get(name, ()))
    return reached


def _quoted(names: Iterable[str]) -> str:
    return listed([repr(name) for name in names])
