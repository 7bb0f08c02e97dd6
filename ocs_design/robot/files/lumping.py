"""From links and joints to moving bodies: what is rigidly joined becomes one."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ocs_design.robot.files.links import Children, Link
from ocs_design.robot.mass_properties import MassProperties, combine
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.tree import Body, Joint, Placement, Shape


@dataclass
class _Lump:
    """A body in the making."""

    name: str
    parent: int
    placement: Placement
    joint: Joint | None
    links: dict[str, Placement] = field(default_factory=dict)
    link_masses: dict[str, float] = field(default_factory=dict)
    parts: list[MassProperties] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)

    def add(self, link: Link, place: Placement) -> None:
        """Join a link that stands at `place` in the body's frame."""
        weighed = link.mass_properties or MassProperties.zero()
        self.links[link.name] = place
        self.link_masses[link.name] = weighed.mass
        self.parts.append(weighed.moved(place.rotation, place.position))
        self.shapes.extend(_moved(shape, place) for shape in link.shapes)

    def body(self) -> Body:
        """The finished body."""
        return Body(
            self.name,
            self.parent,
            self.placement,
            self.joint,
            combine(self.parts),
            self.links,
            self.link_masses,
            tuple(self.shapes),
        )


def lump(
    root: str, links: Mapping[str, Link], children: Children, remarks: Remarks
) -> tuple[Body, ...]:
    """Moving bodies from `root` down, depth first in file order, parents before children."""
    lumps = [_Lump(root, -1, Placement.identity(), None)]
    lumps[0].add(links[root], Placement.identity())
    home = {root: (0, Placement.identity())}
    # A stack of our own: chains of thousands of links would exhaust Python's.
    stack = list(reversed(children.get(root, ())))
    while stack:
        connection = stack.pop()
        index, place = home[connection.parent]
        place = place @ connection.placement
        if connection.held:
            remarks.add(f"{connection.held} joints, held at zero", connection.name)
        if connection.joint is not None:
            lumps.append(_Lump(connection.child, index, place, connection.joint))
            index, place = len(lumps) - 1, Placement.identity()
        place = place @ connection.child_in_joint
        lumps[index].add(links[connection.child], place)
        home[connection.child] = (index, place)
        stack.extend(reversed(children.get(connection.child, ())))
    return tuple(each.body() for each in lumps)


def _moved(shape: Shape, place: Placement) -> Shape:
    position = place.rotation @ shape.position + place.position
    return replace(shape, position=position, rotation=place.rotation @ shape.rotation)
