"""What of a module stands still, to look at: housing, foot, motor, its cage and its gear.

Shapes without mass and contact, in the frame of the module's wheel. Masses are the carrier's.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TypeAlias

import numpy as np

from ocs_design.design import Device, Module
from ocs_design.drive_solids import DriveSolid, drive_solids, motor_mount
from ocs_design.export.workshop import printed_foot
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import housing_parts
from ocs_design.parts.mesh import Mesh, part_mesh
from ocs_design.parts.part import Part
from ocs_design.robot.tree import Placement, ShapeKind
from ocs_design.sizing.cage import Cage
from ocs_design.sizing.foot import BASE_THICKNESS, PLATE_THICKNESS

HOUSING_MESH, FOOT_MESH = Path("meshes/ocs_housing.stl"), Path("meshes/ocs_foot.stl")
CAGE_MESH = Path("meshes/ocs_cage.stl")
"""In metres, beside every exported robot file: drum with lid in the frame of the left wheel, foot
and cage in their own."""

Color: TypeAlias = tuple[float, float, float, float]

SHELL: Color = (0.25, 0.45, 0.75, 0.3)
PRINT: Color = (0.25, 0.45, 0.75, 1.0)
MOTOR: Color = (0.15, 0.15, 0.17, 1.0)
GEAR: Color = (0.75, 0.6, 0.3, 1.0)
_COLORS = {"housing": SHELL, "foot": PRINT, "cage": SHELL, "motor": MOTOR, "gear": GEAR}

SECTIONS = 64
"""Of a full circle: a quarter of those that are printed."""


@dataclass(frozen=True, eq=False)
class Visual:
    """A shape to look at.

    Attributes:
        name: what it is: housing, foot, cage, motor or gear.
        kind, size: see `ShapeKind`: box, cylinder or mesh.
        place: of the shape's frame in that of the module's wheel.
        mesh: of `standing_meshes`; None for the other kinds.
    """

    name: str
    kind: ShapeKind
    size: tuple[float, ...]
    place: Placement
    mesh: Path | None = None

    @property
    def color(self) -> Color:
        """Red, green, blue and opacity, 0..1."""
        return _COLORS[self.name]


def standing_meshes(device: Device) -> Mapping[Path, Mesh]:
    """The meshes that `standing_visuals` name; none where nothing stands still."""
    if device.carrier.mass == 0.0:
        return {}
    return _meshes(printed_foot(device), motor_mount(device).cage)


def standing_visuals(device: Device, module: Module) -> tuple[Visual, ...]:
    """Housing, foot and cage as meshes, and motor and gear where their sizes are known."""
    if device.carrier.mass == 0.0:
        return ()
    foot, turn = printed_foot(device), standing_turn(module)
    return (
        _mesh("housing", HOUSING_MESH, turn),
        _mesh("foot", FOOT_MESH, turn @ foot.placement),
        *_cage(device, foot, turn),
        *_drive(device, turn),
    )


def plain_standing_visuals(device: Device, module: Module) -> tuple[Visual, ...]:
    """The same of boxes and cylinders, for files that stand alone."""
    if device.carrier.mass == 0.0:
        return ()
    foot, turn = printed_foot(device), standing_turn(module)
    return (
        _cylinder("housing", foot.housing.radius, foot.housing.half_height, turn),
        *_plain_foot(foot, turn),
        *_plain_cage(device, turn),
        *_drive(device, turn),
    )


def standing_turn(module: Module) -> Placement:
    """Of what stands still in the wheel's frame, the motor on the side of the other module.

    Both modules are of the same parts: the right one is turned by half a turn about the vertical,
    and so the mirror image of the left.
    """
    if module.name == "left":
        return Placement.identity()
    return Placement(np.diag([-1.0, 1.0, -1.0]), np.zeros(3))


@lru_cache(maxsize=1)
def _meshes(foot: Foot, cage: Cage | None) -> Mapping[Path, Mesh]:
    """Every robot file asks for them."""
    drum, lid = housing_parts(foot.housing)
    # As one, for faces that they share would be seen through the shell.
    housing = Part("housing", drum.density, drum.joined + lid.joined, drum.cut + lid.cut)
    parts = {HOUSING_MESH: housing, FOOT_MESH: foot_part(foot)}
    if cage is not None:
        parts[CAGE_MESH] = cage_part(cage)
    return {path: part_mesh(part, SECTIONS) for path, part in parts.items()}


def _drive(device: Device, turn: Placement) -> Iterator[Visual]:
    """Motor and gear as cylinders."""
    for solid in drive_solids(device):
        if solid.name != "cage":
            yield _solid(solid, turn)


def _cage(device: Device, foot: Foot, turn: Placement) -> Iterator[Visual]:
    cage = motor_mount(device).cage
    if cage is not None:
        yield _mesh("cage", CAGE_MESH, turn @ cage_placement(foot, cage))


def cage_placement(foot: Foot, cage: Cage) -> Placement:
    """Of its frame in the wheel's: the floor away from the plate."""
    return _shifted(0.0, 0.0, -foot.back - cage.length)


def _plain_cage(device: Device, turn: Placement) -> Iterator[Visual]:
    for solid in drive_solids(device):
        if solid.name == "cage":
            yield _solid(solid, turn)


def _solid(solid: DriveSolid, turn: Placement) -> Visual:
    middle = turn @ _shifted(0.0, -solid.up, (solid.low + solid.high) / 2.0)
    return _cylinder(solid.name, solid.radius, (solid.high - solid.low) / 2.0, middle)


def _plain_foot(foot: Foot, turn: Placement) -> Iterator[Visual]:
    """Base, and plate with its round top."""
    half_base, half_plate = BASE_THICKNESS / 2.0, PLATE_THICKNESS / 2.0
    base = turn @ foot.placement @ _shifted(0.0, 0.0, half_base)
    yield _cylinder("foot", foot.base_radius, half_base, base)
    half_height, behind = (foot.wheel_height - BASE_THICKNESS) / 2.0, half_plate - foot.back
    plate = turn @ _shifted(0.0, half_height, behind)
    yield Visual("foot", ShapeKind.BOX, (foot.half_width, half_height, half_plate), plate)
    top = turn @ _shifted(0.0, 0.0, behind)
    yield _cylinder("foot", foot.half_width, half_plate, top)


def _cylinder(name: str, radius: float, half_length: float, place: Placement) -> Visual:
    return Visual(name, ShapeKind.CYLINDER, (radius, half_length), place)


def _mesh(name: str, path: Path, place: Placement) -> Visual:
    return Visual(name, ShapeKind.MESH, (1.0, 1.0, 1.0), place, path)


def _shifted(x: float, y: float, z: float) -> Placement:
    return Placement(np.eye(3), np.array([x, y, z]))
