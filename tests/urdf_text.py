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
    """A shape that collides, such as `<box size="1 1 1"/>`."""
    origin = f'<origin xyz="{xyz}" rpy="{rpy}"/>'
    return f"<collision>{origin}<geometry>{geometry}</geometry></collision>"


def link(name: str, *inside: str) -> str:
    return f'<link name="{name}">{"".join(inside)}</link>'


def joint(name: str, parent: str, child: str, *inside: str, kind: str = "revolute") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{''.join(inside)}</joint>"
    )


def topped(base: str, top: str, xyz: str, axis: str = "0 0 1") -> bytes:
    """A link `base` and another one on a joint at that place, with what is inside of them."""
    place = f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>'
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    return robot(link("base", base), link("top", top), joint("j", "base", "top", place, limit))


LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'
TWO_LINKS = robot(
    link("trunk", inertial(2.0)), link("leg", inertial()), joint("hip", "trunk", "leg", LIMIT)
)
