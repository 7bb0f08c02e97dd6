"""Visual shapes of a module's carrier, all that stands still: housing, foot, motor, cage, gear.

They have neither mass nor contact, and stand in the frame of the module's wheel.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, sin
from pathlib import Path

import numpy as np

from ocs_design.common.frames import Placement
from ocs_design.device.bodies import DeviceBody, carrier_placement
from ocs_design.device.device import Device, Module
from ocs_design.device.solids import drive_solids, foot_of, motor_mount
from ocs_design.export.meshes import Color, Mesh, merged, part_mesh
from ocs_design.parts.cage import Cage, cage_part
from ocs_design.parts.carrier_plate import plate_bodies
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import guard_ring, housing_parts
from ocs_design.parts.pedestal import Pedestal, drilled
from ocs_design.parts.solids import Part
from ocs_design.robot.tree import ShapeKind

WHEEL_MESH = "meshes/ocs_flywheel.stl"
"""Mesh of the wheel beside every exported robot file."""

HOUSING_MESH, FOOT_MESH = Path("meshes/ocs_housing.stl"), Path("meshes/ocs_foot.stl")
CAGE_MESH = Path("meshes/ocs_cage.stl")
"""Meshes in metres beside every exported robot file: drum with lid in the frame of the left wheel,
foot and cage in their own."""

PLATE_MESH = Path("meshes/ocs_plate.stl")
"""The plate under the feet with its sleeves, in its own frame, likewise."""

PEDESTAL_MESH = Path("meshes/ocs_pedestals.stl")
"""All pedestals under the feet, in the base frame B, likewise."""

SHELL: Color = (0.25, 0.45, 0.75, 0.3)
PRINT: Color = (0.25, 0.45, 0.75, 1.0)
MOTOR: Color = (0.15, 0.15, 0.17, 1.0)
GEAR: Color = (0.75, 0.6, 0.3, 1.0)
ALUMINIUM: Color = (0.78, 0.79, 0.8, 1.0)
_COLORS = {"housing": SHELL, "foot": PRINT, "cage": SHELL, "motor": MOTOR, "gear": GEAR}
_COLORS["plate"] = ALUMINIUM
_COLORS["pedestal"] = PRINT

_SECTIONS = 64
"""Chords of a full circle: a quarter of those that are printed."""


@dataclass(frozen=True, eq=False)
class Visual:
    """Shape without mass and contact.

    Attributes:
        name: housing, foot, cage, motor, gear, plate or pedestal.
        kind, size: see `ShapeKind`: box, cylinder or mesh.
        place: of the shape's frame in that of the module's wheel.
        mesh: of `still_meshes`; None for the other kinds.
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


def still_meshes(device: Device) -> Mapping[Path, Mesh]:
    """Meshes of carrier, plate and pedestals that visuals name; none of a weightless carrier."""
    found: dict[Path, Mesh] = {}
    if device.carrier.mass > 0.0:
        found |= _carrier_meshes(foot_of(device), motor_mount(device).cage)
    if device.plate is not None:
        found[PLATE_MESH] = merged(
            [part_mesh(part, _SECTIONS).placed(at) for part, at in plate_bodies(device.plate)]
        )
    if device.pedestals:
        found[PEDESTAL_MESH] = merged(
            [
                part_mesh(drilled(each), _SECTIONS).placed(each.placement)
                for each in device.pedestals
            ]
        )
    return found


@lru_cache(maxsize=1)
def _carrier_meshes(foot: Foot, cage: Cage | None) -> Mapping[Path, Mesh]:
    """Meshes by their files; every robot file asks for them."""
    drum, lid = housing_parts(foot.housing)
    # As one, for faces that they share would be seen through the shell.
    housing = Part("housing", drum.density, drum.joined + lid.joined, drum.cut + lid.cut)
    parts = {HOUSING_MESH: housing, FOOT_MESH: foot_part(foot)}
    if cage is not None:
        parts[CAGE_MESH] = cage_part(cage)
    meshes = {path: part_mesh(part, _SECTIONS) for path, part in parts.items()}
    if foot.housing.guard_wall:
        ring = part_mesh(guard_ring(foot.housing), _SECTIONS)
        meshes[HOUSING_MESH] = merged([meshes[HOUSING_MESH], ring])
    return meshes


def plate_visuals(device: Device) -> tuple[Visual, ...]:
    """What is under the feet as a mesh, in its own frame; none where they stand on the trunk."""
    here = _shifted(0.0, 0.0, 0.0)
    plate = () if device.plate is None else (_mesh("plate", PLATE_MESH, here),)
    return (*plate, _mesh("pedestal", PEDESTAL_MESH, here)) if device.pedestals else plate


def plain_plate_visuals(device: Device) -> tuple[Visual, ...]:
    """What is under the feet of boxes and cylinders, for files that stand alone."""
    plate = device.plate
    if plate is None:
        return tuple(box for each in device.pedestals for box in _plain_pedestal(each))
    half, arm = plate.thickness / 2.0, plate.across / 2.0
    sleeves = (
        _cylinder(
            "plate", plate.sleeve_radius, length / 2.0, place @ _shifted(0.0, 0.0, -length / 2.0)
        )
        for place, length in zip(plate.screw_places, plate.sleeves, strict=True)
        if length > 0.0
    )
    bodies = (
        body
        for row, level in zip(plate.rows, plate.heights, strict=True)
        # The y axis that way, and z as it is.
        for x, y in directions(plate.arms).tolist()
        for turn in (np.array([[y, x, 0.0], [-x, y, 0.0], [0.0, 0.0, 1.0]]),)
        for outward in (_shifted(row, 0.0, level + half) @ Placement(turn, np.zeros(3)),)
        for body in (
            Visual("plate", ShapeKind.BOX, (plate.neck, arm, half), outward @ _shifted(0, arm, 0)),
            _cylinder("plate", plate.radius, half, outward @ _shifted(0, plate.across, 0)),
        )
    )
    tubes, mast = [], plate.mast
    if mast is not None:
        wide, tall = mast.side / 2.0, (mast.high - mast.low) / 2.0
        upright = _shifted(mast.face - wide, 0.0, mast.low + tall)
        tubes.append(Visual("plate", ShapeKind.BOX, (wide, wide, tall), upright))
        long = (mast.back + plate.neck) / 2.0
        for level in plate.heights:
            place = _shifted(mast.back - long, 0.0, level - wide)
            tubes.append(Visual("plate", ShapeKind.BOX, (long, wide, wide), place))
    return (*bodies, *sleeves, *tubes)


def _plain_pedestal(pedestal: Pedestal) -> Iterator[Visual]:
    """Boxes for base, seat and brace, whose slopes stand for the lean's."""
    place, half, end = pedestal.placement, pedestal.width / 2.0, pedestal.length / 2.0
    thick, lean = pedestal.thickness / 2.0, pedestal.lean
    long = end + pedestal.flange
    base = _shifted(0.0, end, pedestal.base / 2.0)
    yield Visual("pedestal", ShapeKind.BOX, (half, long, pedestal.base / 2.0), place @ base)
    seat = Placement(pedestal.seat.rotation, np.array([0.0, 0.0, pedestal.base]))
    own = seat @ _shifted(0.0, end, -thick)
    yield Visual("pedestal", ShapeKind.BOX, (half, end, thick), place @ own)
    # From the far end of the seat to that of the base, at half the lean off the upright.
    tall, turn = 2.0 * end * sin(lean / 2.0), (pi - lean) / 2.0
    c, s = -cos(turn), sin(turn)
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    foot = Placement(rotation, np.array([0.0, 2.0 * end, pedestal.base]))
    brace = foot @ _shifted(0.0, tall / 2.0, thick)
    yield Visual("pedestal", ShapeKind.BOX, (half, tall / 2.0, thick), place @ brace)


def carrier_visuals(device: Device, module: Module) -> tuple[Visual, ...]:
    """Housing, foot and cage as meshes, and motor and gear where their sizes are known."""
    if device.carrier.mass == 0.0:
        return ()
    foot, turn, cage = foot_of(device), carrier_placement(module), motor_mount(device).cage
    visuals = [
        _mesh("housing", HOUSING_MESH, turn),
        _mesh("foot", FOOT_MESH, turn @ foot.placement),
    ]
    if cage is not None:
        visuals.append(_mesh("cage", CAGE_MESH, turn @ cage_placement(foot, cage)))
    return (*visuals, *_drive(device, turn, {"motor", "gear"}))


def plain_carrier_visuals(device: Device, module: Module) -> tuple[Visual, ...]:
    """Carrier of boxes and cylinders, for files that stand alone."""
    if device.carrier.mass == 0.0:
        return ()
    foot, turn = foot_of(device), carrier_placement(module)
    half_base, half_plate = float(foot.base) / 2.0, device.foot_plate / 2.0
    half_height, behind = (foot.wheel_height - foot.base) / 2.0, half_plate - foot.back
    base = turn @ foot.placement @ _shifted(0.0, 0.0, half_base)
    plate, top = turn @ _shifted(0.0, half_height, behind), turn @ _shifted(0.0, 0.0, behind)
    return (
        _cylinder("housing", foot.housing.radius, foot.housing.half_height, turn),
        _cylinder("foot", foot.base_radius, half_base, base),
        # The plate's stem, and its disc.
        Visual("foot", ShapeKind.BOX, (foot.stem, half_height, half_plate), plate),
        _cylinder("foot", foot.half_width, half_plate, top),
        *_drive(device, turn, {"cage"}),
        *_drive(device, turn, {"motor", "gear"}),
    )


def still_visuals(device: Device, body: DeviceBody) -> tuple[Visual, ...]:
    """Shapes of a body that stands still, of meshes where there are any."""
    if body.module is None:
        return plate_visuals(device)
    return carrier_visuals(device, body.module)


def plain_visuals(device: Device, body: DeviceBody) -> tuple[Visual, ...]:
    """Shapes of such a body as boxes and cylinders, for files that stand alone."""
    if body.module is None:
        return plain_plate_visuals(device)
    return plain_carrier_visuals(device, body.module)


def cage_placement(foot: Foot, cage: Cage) -> Placement:
    """Frame of the cage in the wheel's: its floor away from the foot's plate."""
    return _shifted(0.0, 0.0, -foot.back - cage.length)


def _drive(device: Device, turn: Placement, names: Collection[str]) -> Iterator[Visual]:
    """Motor, gear and cage as cylinders, those of these names."""
    for solid in drive_solids(device):
        if solid.name in names:
            middle = turn @ _shifted(0.0, -solid.up, (solid.low + solid.high) / 2.0)
            yield _cylinder(solid.name, solid.radius, (solid.high - solid.low) / 2.0, middle)


def _cylinder(name: str, radius: float, half_length: float, place: Placement) -> Visual:
    return Visual(name, ShapeKind.CYLINDER, (radius, half_length), place)


def _mesh(name: str, path: Path, place: Placement) -> Visual:
    return Visual(name, ShapeKind.MESH, (1.0, 1.0, 1.0), place, path)


def _shifted(x: float, y: float, z: float) -> Placement:
    return Placement(np.eye(3), np.array([x, y, z]))
