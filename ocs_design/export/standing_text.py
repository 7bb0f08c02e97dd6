"""What stands still of a module, to look at, as text of URDF and SDF."""

from collections.abc import Iterable

import numpy as np

from ocs_design.export.standing import Visual
from ocs_design.export.templates import fill, numbers
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.tree import ShapeKind


def visuals_urdf(visuals: Iterable[Visual]) -> str:
    """Elements of a link."""
    return "".join(
        fill("visual.urdf", {**_common(each), "name": each.name, "geometry": _geometry_urdf(each)})
        for each in visuals
    )


def visuals_sdf(visuals: Iterable[Visual]) -> str:
    """Elements of a link, each with a name of its own; meshes have no place in them."""
    return "".join(
        fill(
            "visual.sdf",
            {
                **_common(each),
                "name": f"{each.name}_{index}",
                "geometry": _geometry_sdf(each),
                "transparency": numbers(1.0 - each.color[3]),
            },
        )
        for index, each in enumerate(visuals)
    )


def _common(visual: Visual) -> dict[str, str]:
    place = visual.place
    return {
        "position": numbers(place.position),
        "rpy": numbers(rpy_from_rotation(place.rotation)),
        "color": numbers(visual.color),
    }


def _geometry_urdf(visual: Visual) -> str:
    match visual.kind:
        case ShapeKind.BOX:
            return f'<box size="{_edges(visual)}"/>'
        case ShapeKind.CYLINDER:
            radius, length = _radius_and_length(visual)
            return f'<cylinder radius="{radius}" length="{length}"/>'
    return f'<mesh filename="{visual.mesh}"/>'


def _geometry_sdf(visual: Visual) -> str:
    if visual.kind is ShapeKind.BOX:
        return f"<box><size>{_edges(visual)}</size></box>"
    radius, length = _radius_and_length(visual)
    return f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"


def _edges(box: Visual) -> str:
    return numbers(2.0 * np.array(box.size))


def _radius_and_length(cylinder: Visual) -> tuple[str, str]:
    radius, half = cylinder.size
    return numbers(radius), numbers(2.0 * half)
