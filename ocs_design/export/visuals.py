"""Visual shapes of a module's fixed parts: housing, foot, motor, cage and gear.

They have neither mass nor contact, and are placed in the frame of the module's wheel.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, sin
from pathlib import Path

import numpy as np

from ocs_design.common.frames import Placement
from ocs_design.device.bodies import STEEL, carrier_placement
from ocs_design.device.device import Device, Module
from ocs_design.export.meshes import Color, Mesh, merged, part_mesh
from ocs_design.parts.cage import Cage, cage_part
from ocs_design.parts.carrier_plate import CarrierPlate, plate_bodies
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.foot import Foot, cage_placement, foot_part
from ocs_design.parts.housing import guard_ring, housing_parts
from ocs_design.parts.pedestal import Pedestal, pedestal_part
from ocs_design.parts.solids import ORIGIN, Part
from ocs_design.robot.tree import ShapeKind

WHEEL_MESH = "meshes/ocs_flywheel.stl"
"""Mesh of the wheel beside every exported robot file."""

_MESHES = {
    name: Path(f"meshes/ocs_{name}{'s' if name == 'pedestal' else ''}.stl")
    for name in ("housing", "foot", "cage", "plate", "pedestal")
}
"""Meshes in metres beside every exported robot file.

Drum with lid are in the frame of the left wheel; foot, cage and plate, with its sleeves, in their
own; all pedestals in the base frame B.
"""

SHELL: Color = (0.25, 0.45, 0.75, 0.3)
PRINT: Color = (0.25, 0.45, 0.75, 1.0)
MOTOR: Color = (0.15, 0.15, 0.17, 1.0)
GEAR: Color = (0.75, 0.6, 0.3, 1.0)
ALUMINIUM: Color = (0.78, 0.79, 0.8, 1.0)
_DRIVE = {"motor": MOTOR, "gear": GEAR}
_COLORS = {**_DRIVE, "housing": SHELL, "cage": SHELL}
_COLORS |= {"foot": PRINT, "pedestal": PRINT, "plate": ALUMINIUM}

_SECTIONS = 64
"""Chords per full circle: a quarter of those of printed parts."""


@dataclass(frozen=True, eq=False)
class Visual:
    """Shape without mass and contact.

    Attributes:
        name: housing, foot, cage, motor, gear, plate or pedestal.
        kind, size: box, cylinder or mesh; see `ShapeKind`.
        place: placement of the shape's frame in that of the module's wheel.
    """

    name: str
    kind: ShapeKind
    size: tuple[float, ...]
    place: Placement

    @property
    def color(self) -> Color:
        """Red, green, blue and opacity, 0..1."""
        return _COLORS[self.name]

    @property
    def mesh(self) -> Path | None:
        """Path of its mesh in `still_meshes`; None for the other kinds."""
        return _MESHES[self.name] if self.kind is ShapeKind.MESH else None


def still_meshes(device: Device) -> Mapping[Path, Mesh]:
    """Meshes of carrier, plate and pedestals used by visuals; none for a massless carrier."""
    meshes: dict[str, Mesh] = {}
    if not device.wheels_alone:
        meshes |= _carrier_meshes(device.foot, device.mount.cage)
    under = {
        "plate": () if device.plate is None else plate_bodies(device.plate),
        "pedestal": (
            (pedestal_part(pedestal), pedestal.placement) for pedestal in device.pedestals
        ),
    }
    for name, bodies in under.items():
        if placed := [part_mesh(part, _SECTIONS).placed(at) for part, at in bodies]:
            meshes[name] = merged(placed)
    return {_MESHES[name]: mesh for name, mesh in meshes.items()}


@lru_cache(maxsize=1)
def _carrier_meshes(foot: Foot, cage: Cage | None) -> Mapping[str, Mesh]:
    """Meshes by part, cached because every robot file uses them."""
    drum, lid = housing_parts(foot.housing)
    # Merged, because shared faces would be visible through the shell.
    housing = Part("housing", drum.density, drum.joined + lid.joined, drum.cut + lid.cut)
    parts = (housing, foot_part(foot), *(() if cage is None else (cage_part(cage),)))
    meshes = {part.name: part_mesh(part, _SECTIONS) for part in parts}
    if foot.housing.guard_wall:
        ring = part_mesh(guard_ring(foot.housing), _SECTIONS)
        meshes["housing"] = merged([meshes["housing"], ring])
    return meshes


def still_visuals(device: Device, module: Module | None) -> tuple[Visual, ...]:
    """Shapes of a module's fixed parts, or, with None, of the supports of all feet.

    Housing, foot, cage, plate and pedestals are meshes; motor and gear are cylinders if their
    sizes are known.
    """
    if module is None:
        under = {"plate": device.plate, "pedestal": device.pedestals}
        return tuple(_mesh(name, ORIGIN) for name, supports in under.items() if supports)
    if device.wheels_alone:
        return ()
    foot, turn, cage = device.foot, carrier_placement(module), device.mount.cage
    visuals = [_mesh("housing", turn), _mesh("foot", turn @ foot.placement)]
    if cage is not None:
        visuals.append(_mesh("cage", turn @ cage_placement(foot, cage)))
    return (*visuals, *_drive(device, turn, {"motor", "gear"}))


def plain_visuals(device: Device, module: Module | None) -> tuple[Visual, ...]:
    """Boxes and cylinders for the fixed parts, for files without meshes; see `still_visuals`."""
    if module is None:
        plates = () if device.plate is None else _plain_plate(device.plate)
        boxes = (box for pedestal in device.pedestals for box in _plain_pedestal(pedestal))
        return (*plates, *boxes)
    if device.wheels_alone:
        return ()
    foot, turn = device.foot, carrier_placement(module)
    half_base, half_plate = float(foot.base) / 2.0, device.foot_plate / 2.0
    half_height, behind = (foot.wheel_height - foot.base) / 2.0, half_plate - foot.back
    base = turn @ foot.placement @ _shifted(0.0, 0.0, half_base)
    plate, top = turn @ _shifted(0.0, half_height, behind), turn @ _shifted(0.0, 0.0, behind)
    return (
        _cylinder("housing", foot.housing.radius, foot.housing.half_height, turn),
        _cylinder("foot", foot.base_radius, half_base, base),
        # The plate's stem, and its disc.
        _box("foot", (foot.stem, half_height, half_plate), plate),
        _cylinder("foot", foot.half_width, half_plate, top),
        *_drive(device, turn, {"cage"}),
        *_drive(device, turn, {"motor", "gear"}),
    )


def _plain_plate(plate: CarrierPlate) -> Iterator[Visual]:
    """Discs and arms of the plates, sleeves, and the mast's tubes."""
    half, arm = plate.thickness / 2.0, plate.across / 2.0
    for row, level in zip(plate.rows, plate.heights, strict=True):
        for x, y in directions(plate.arms).tolist():
            # Rotates the y axis in that direction and keeps z.
            turn = np.array([[y, x, 0.0], [-x, y, 0.0], [0.0, 0.0, 1.0]])
            outward = _shifted(row, 0.0, level + half) @ Placement(turn, np.zeros(3))
            yield _box("plate", (plate.neck, arm, half), outward @ _shifted(0, arm, 0))
            yield _cylinder("plate", plate.radius, half, outward @ _shifted(0, plate.across, 0))
    for place, length in zip(plate.screw_places, plate.sleeves, strict=True):
        if length > 0.0:
            below = place @ _shifted(0.0, 0.0, -length / 2.0)
            yield _cylinder("plate", plate.sleeve_radius, length / 2.0, below)
    mast = plate.mast
    if mast is not None:
        wide, tall, long = mast.side / 2.0, (mast.high - mast.low) / 2.0, mast.back + plate.neck
        upright = _shifted(mast.face - wide, 0.0, mast.low + tall)
        yield _box("plate", (wide, wide, tall), upright)
        if plate.relief is not None:
            (low, high), thick = plate.block, float(plate.relief.heights.mean()) / 2.0
            middle = _shifted(mast.face + thick, 0.0, (low + high) / 2.0)
            yield _box("plate", (thick, wide, (high - low) / 2.0), middle)
        for level in plate.heights:
            place = _shifted(mast.back - long / 2.0, 0.0, level - wide)
            yield _box("plate", (long / 2.0, wide, wide), place)


def _plain_pedestal(pedestal: Pedestal) -> Iterator[Visual]:
    """Boxes for base, seat and brace, whose slopes represent the lean."""
    place, half, end = pedestal.placement, pedestal.width / 2.0, pedestal.length / 2.0
    thick, lean = pedestal.thickness / 2.0, pedestal.lean
    base = _shifted(0.0, end, pedestal.base / 2.0)
    yield _box("pedestal", (half, end + pedestal.flange, pedestal.base / 2.0), place @ base)
    seat = Placement(pedestal.seat.rotation, np.array([0.0, 0.0, pedestal.base]))
    middle = seat @ _shifted(0.0, end, -thick)
    yield _box("pedestal", (half, end, thick), place @ middle)
    # From the far end of the seat to that of the base, at half the lean off the upright.
    tall, turn = 2.0 * end * sin(lean / 2.0), (pi - lean) / 2.0
    c, s = -cos(turn), sin(turn)
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    foot = Placement(rotation, np.array([0.0, 2.0 * end, pedestal.base]))
    brace = foot @ _shifted(0.0, tall / 2.0, thick)
    yield _box("pedestal", (half, tall / 2.0, thick), place @ brace)


def piece_color(device: Device, name: str) -> Color:
    """Colour of one of `placed_parts`: steel for those neither printed nor bought."""
    web = device.flywheel.web
    if name == "hub" and web is not None and web.material.startswith("aluminium"):
        return ALUMINIUM
    printed = name in {"drum", "lid", "foot", "cage"}
    return PRINT if printed else _DRIVE.get(name.removesuffix("_2"), STEEL)


def _drive(device: Device, turn: Placement, names: Collection[str]) -> Iterator[Visual]:
    """Motor, gear and cage as cylinders, if they are in `names`."""
    for solid in device.drive_solids:
        if solid.name in names:
            middle = turn @ _shifted(0.0, -solid.up, (solid.low + solid.high) / 2.0)
            yield _cylinder(solid.name, solid.radius, (solid.high - solid.low) / 2.0, middle)


def _box(name: str, half_sizes: tuple[float, float, float], place: Placement) -> Visual:
    return Visual(name, ShapeKind.BOX, half_sizes, place)


def _cylinder(name: str, radius: float, half_length: float, place: Placement) -> Visual:
    return Visual(name, ShapeKind.CYLINDER, (radius, half_length), place)


def _mesh(name: str, place: Placement) -> Visual:
    return Visual(name, ShapeKind.MESH, (1.0, 1.0, 1.0), place)


def _shifted(x: float, y: float, z: float) -> Placement:
    return Placement(np.eye(3), np.array([x, y, z]))
