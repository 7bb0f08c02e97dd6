"""Small URDFs for tests, as bytes."""


def robot(*elements: str) -> bytes:
    return f'<robot name="test">{"".join(elements)}</robot>'.encode()


def inertial(mass: float | str = 1.0, moments: str = "0.1 0.1 0.1", xyz: str = "0 0 0") -> str:
    ixx, iyy, izz = moments.split()
    return (
        f'<inertial><origin xyz="{xyz}"/><mass value="{mass}"/>'
        f'<inertia ixx="{ixx}" iyy="{iyy}" izz="{izz}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def solid(geometry: str, xyz: str = "0 0 0", rpy: str = "0 0 0") -> str:
    """Collision shape, such as `<box size="1 1 1"/>`."""
    origin = f'<origin xyz="{xyz}" rpy="{rpy}"/>'
    return f"<collision>{origin}<geometry>{geometry}</geometry></collision>"


def link(name: str, *inside: str) -> str:
    return f'<link name="{name}">{"".join(inside)}</link>'


def joint(name: str, parent: str, child: str, *inside: str, kind: str = "revolute") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{''.join(inside)}</joint>"
    )


def hinge(name: str, parent: str, child: str, xyz: str, axis: str = "0 1 0") -> str:
    """Joint with a range of nearly half a turn both ways."""
    return joint(name, parent, child, f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>', WIDE)


def leg(name, hip, thigh, shank, parent="trunk", words=("thigh", "shank", "foot")):
    """Two hinges about y; `thigh` and `shank` are the vectors along them at zero [m]."""
    upper, lower, foot = (f"{name}_{word}" for word in words)
    text = [" ".join(f"{0.5 * x}" for x in part) for part in (thigh, shank)]
    ends = [" ".join(map(str, part)) for part in (hip, thigh, shank)]
    return (
        link(upper, inertial(0.2, "3e-4 3e-4 3e-4", text[0])),
        link(lower, inertial(0.1, "2e-4 2e-4 2e-4", text[1])),
        link(foot),
        hinge(f"{name}_a", parent, upper, ends[0]),
        hinge(f"{name}_b", upper, lower, ends[1]),
        joint(f"{name}_c", lower, foot, f'<origin xyz="{ends[2]}"/>', kind="fixed"),
    )


def topped(base: str, top: str, xyz: str, axis: str = "0 0 1") -> bytes:
    """A link `base` and a link `top` on a joint at `xyz`, with their contents."""
    place = f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>'
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    return robot(link("base", base), link("top", top), joint("j", "base", "top", place, limit))


WIDE = '<limit lower="-3.1" upper="3.1" effort="3" velocity="4"/>'
LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'
TWO_LINKS = robot(
    link("trunk", inertial(2.0)), link("leg", inertial()), joint("hip", "trunk", "leg", LIMIT)
)
