"""Pieces of one module in place, as meshes in the frame of the left wheel.

The wheel's axis is z, the floor of its housing is at -z with the motor behind it; y points down.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import cos, pi, sin

import numpy as np

from ocs_design.actuation.fasteners import BoltedJoint, Fastening
from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.device.bodies import carrier_placement, wheel_placement
from ocs_design.device.device import Device
from ocs_design.device.joints import foot_screws
from ocs_design.device.solids import shaft_cut
from ocs_design.export.device_parts import (
    foot_holes,
    pedestal_kinds,
    printed_parts,
    ring_fixture,
    wheel_pieces,
)
from ocs_design.export.meshes import Mesh, merged, part_mesh, solid_mesh
from ocs_design.parts.carrier_plate import plate_bodies
from ocs_design.parts.foot import cage_placement
from ocs_design.parts.housing import FIRST_EAR, LID_SCREWS, guard_ring
from ocs_design.parts.motor_mount import DriveSolid
from ocs_design.parts.printed import LID_SCREW, ear_axis
from ocs_design.parts.solids import ORIGIN, Part, Revolution, hollow_cylinder, revolved

SECTIONS = 64
"""Chords of a full circle."""

_APART = 0.25
"""Vertical gap between exploded pieces, relative to the housing's radius."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of the module, or equal screws of it.

    Attributes:
        key: "drum", "lid", "foot", "cage", "motor", "gear", names of the wheel's pieces; or the
            data of screws.
        mesh: mesh in place in the wheel's frame [m].
        drop: downward shift in the exploded view [m]; None: it is moved along the axis instead.
        aside: additional shift along the axis [m]: pedestals of several shapes share one place.
        shared: whether the device has it once, for all modules.
        count: number of equal pieces in the mesh, if they are not screws.
        modules: number of modules that have it; None: all.
    """

    key: str | Fastening
    mesh: Mesh
    drop: float | None = None
    aside: float = 0.0
    shared: bool = False
    count: int = 1
    modules: int | None = None

    @property
    def fastening(self) -> Fastening | None:
        """Data of screws; None for other pieces."""
        return self.key if isinstance(self.key, Fastening) else None

    def moved(self, offset: FloatArray) -> "Piece":
        """The piece shifted by an offset [m]."""
        return replace(self, mesh=self.mesh.moved(offset))


def placed_parts(device: Device) -> Mapping[str, tuple[Part[float], Placement]]:
    """Wheel, printed parts, motor and gear of one module by name, each with its placement.

    Motor and gear are cylinders with their mass, the motor with its shaft; a gear of two wheels is
    two cylinders, named after each wheel.
    """
    parts = {
        name.removeprefix("flywheel_"): (part, ORIGIN)
        for name, part in wheel_pieces(device.flywheel).items()
    }
    if device.wheels_alone:
        return parts
    foot, cage = device.foot, device.mount.cage
    if device.guard_wall:
        parts["guard"] = guard_ring(foot.housing), ORIGIN
    places = {"foot": foot.placement}
    if cage is not None:
        places["cage"] = cage_placement(foot, cage)
    for part in printed_parts(device):
        parts[part.name] = (part, places.get(part.name, ORIGIN))
    for kind, mass in (("gear", device.motor.gear_mass), ("motor", device.motor.mass)):
        solids = [solid for solid in device.drive_solids if solid.name == kind]
        bodies = [_drive_bodies(device, solid) for solid in solids]
        volume = sum(body.volume() for both in bodies for body in both)
        for name, solid, both in zip((kind, f"{kind}_2"), solids, bodies, strict=False):
            place = Placement(np.eye(3), np.array([0.0, -solid.up, 0.0]))
            parts[name] = (Part(name, mass / volume, both), place)
    return parts


def _drive_bodies(device: Device, solid: DriveSolid) -> tuple[Revolution, ...]:
    """Motor or gear as a cylinder, and the shaft in front of a motor.

    A shaft of unknown length is drawn through the hub. None is drawn if the wheel is screwed to the
    rotor and no source gives a shaft.
    """
    body = hollow_cylinder(0.0, solid.radius, solid.low, solid.high)
    mounting, web = device.motor.mounting, device.flywheel.web
    if solid.name != "motor" or mounting is None or not mounting.shaft_diameter:
        return (body,)
    length, _ = shaft_cut(device)
    if mounting.shaft_length is None and web is not None and mounting.rotor is None:
        length = web.hub.height / 2.0 - solid.high
    if length <= 0.0:
        return (body,)
    end = solid.high + length
    return body, hollow_cylinder(0.0, mounting.shaft_diameter / 2.0, solid.high, end)


def module_pieces(device: Device) -> tuple[Piece, ...]:
    """Pieces in the order of disassembly along the axis, the motor's end first.

    Wheels alone have no other pieces.
    """
    parts = {
        name: Piece(name, part_mesh(part, SECTIONS).placed(place))
        for name, (part, place) in placed_parts(device).items()
    }
    wheel = [parts.pop(name.removeprefix("flywheel_")) for name in wheel_pieces(device.flywheel)]
    if device.wheels_alone:
        return tuple(wheel)
    foot, mount = device.foot, device.mount
    floor = -foot.housing.half_height
    behind, inside, on_wheel = list[Piece](), list[Piece](), list[Piece]()
    for ring in mount.screwed:
        along = ring.along if ring.from_wheel else floor + ring.along
        screws = _ring(ring.fastening, ring.circle.radius, -pi / 2.0, along, ring.towards)
        held = on_wheel if ring.fastening.joint is BoltedJoint.WHEEL else inside
        (behind if ring.towards > 0.0 else held).append(screws)
    back, guard = ([parts.pop(name)] if name in parts else [] for name in ("cage", "guard"))
    # A motor with a ring on its bell sits in the drum.
    within = [parts.pop("motor")] if mount.bell is not None else []
    drum, lid, base = (parts.pop(name) for name in ("drum", "lid", "foot"))
    ears = ear_axis(foot.housing.radius, LID_SCREW)
    lid_screws = _ring(LID_SCREWS, ears, FIRST_EAR, foot.housing.half_height)
    return (
        *(*behind, *back, *parts.values(), *_foot_screws(device), *_pieces_below(device)),
        *(base, drum, *inside, *within, *guard, *wheel, *on_wheel, lid, lid_screws),
    )


def bonding_pieces(device: Device) -> tuple[Piece, ...]:
    """Ring, motor and the fixture that holds both while the glue sets; none without a ring.

    The motor's front faces down; y points down.
    """
    fixture, bell = ring_fixture(device), device.mount.bell
    if fixture is None or bell is None:
        return ()
    level = np.array([0.0, 0.0, bell.fixture_floor + bell.front])
    front = Placement(np.diag([1.0, -1.0, -1.0]), level)
    down = Placement(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]), np.zeros(3))
    parts = {"ring_fixture": (fixture, down)}
    for name in ("motor", "flywheel"):
        part, place = placed_parts(device)[name]
        parts[name] = part, down @ front @ place
    return tuple(
        Piece(name, part_mesh(part, SECTIONS).placed(place))
        for name, (part, place) in parts.items()
    )


def _ring(
    fastening: Fastening, radius: float, first: float, along: float, towards: float = -1.0
) -> Piece:
    """Screws on a circle, with the undersides of their heads at `along` [m].

    The first is at the angle `first` from the x axis [rad]; with `towards` 1 their tips point
    outward, with -1 to the motor.
    """
    screw_mesh, flip = _screw(fastening), np.diag([1.0, -towards, -towards])
    meshes = []
    for index in range(fastening.count):
        angle = first + 2.0 * pi * index / fastening.count
        place = np.array([radius * cos(angle), radius * sin(angle), along])
        meshes.append(screw_mesh.placed(Placement(flip, place)))
    return Piece(fastening, merged(meshes))


def _foot_screws(device: Device) -> Iterator[Piece]:
    """Screws of the foot, from above through its slots into its support."""
    foot = device.foot
    feet = [foot_screws(device, module) for module in device.modules]
    holes = foot_holes(device)
    for fastening in dict.fromkeys(feet):
        module = device.modules[feet.index(fastening)]
        if module.name in holes:
            # The holes are fixed, and the foot is turned over them.
            places = list(holes[module.name])
            place = (wheel_placement(module) @ carrier_placement(module)).inverse()
            under = float(module.position[2]) - foot.wheel_height
        else:
            # A leaning foot is not turned: the ends of its slots match the pedestal's holes.
            off = foot.slot_radius * sin(pi / 4.0)
            places, place = [(off, off), (-off, -off)], foot.placement
            under = 0.0
        screw_mesh, level = _screw(fastening), under + fastening.thickness
        screws = [screw_mesh.moved(np.array([x, y, level])) for x, y in places]
        apart = -_APART * foot.housing.radius
        yield Piece(
            fastening, merged(screws).placed(place), drop=apart, modules=feet.count(fastening)
        )


def _pieces_below(device: Device) -> Iterator[Piece]:
    """Plate, mast and sleeves, or a pedestal of each kind, and their screws."""
    foot, plate = device.foot, device.plate
    apart, free_from = _APART * foot.housing.radius, np.inf
    if plate is not None:
        on_trunk = Placement(np.eye(3), np.array(plate.position))
        place = wheel_placement(device.modules[0]).inverse() @ on_trunk
        lowest = 1.5 * apart + max(plate.screw_lengths)
        head = Placement(np.eye(3), np.array([0.0, 0.0, plate.clamped]))
        for fastening in plate.fastenings:
            bolt = _screw(fastening)
            holes = zip(plate.screw_places, plate.screw_lengths, strict=True)
            heads = [bolt.placed(at @ head) for at, length in holes if length == fastening.length]
            yield Piece(fastening, merged(heads).placed(place), drop=apart, shared=True)
        bodies: dict[str, list[Mesh]] = {}
        for part, at in plate_bodies(plate):
            bodies.setdefault(part.name, []).append(part_mesh(part, SECTIONS).placed(place @ at))
        if sleeves := bodies.pop("sleeve", []):
            down = lowest + apart
            yield Piece("sleeves", merged(sleeves), drop=down, shared=True, count=len(sleeves))
        for name, meshes in bodies.items():
            count = len(plate.rows) if name == "plate" else 1
            yield Piece(name, merged(meshes), drop=lowest, shared=True, count=count)
    for kind in pedestal_kinds(device):
        pedestal, fastening = kind.alike[0], kind.screws
        place = foot.placement @ pedestal.seat.inverse()
        flange = merged(
            [_screw(fastening).moved(np.array([x, y, pedestal.base])) for x, y in pedestal.holes]
        )
        screws, mesh = (mesh.placed(place) for mesh in (flange, part_mesh(kind.part, SECTIONS)))
        along = np.concatenate([screws.vertices[:, 2], mesh.vertices[:, 2]])
        aside = min(0.0, free_from - apart - float(along.max()))
        free_from = aside + float(along.min())
        make_piece = partial(Piece, aside=aside, modules=len(kind.alike))
        yield make_piece(fastening, screws, drop=apart)
        yield make_piece(kind.name, mesh, drop=2.0 * apart)


def _screw(fastening: Fastening) -> Mesh:
    """A screw with its head above z = 0 and its tip below."""
    screw, length = fastening.screw, fastening.length
    thread, head, top = screw.diameter / 2.0, screw.head_diameter / 2.0, screw.head_height
    profile = [(0.0, -length), (thread, -length), (thread, 0.0), (head, 0.0), (head, top)]
    return solid_mesh(revolved([*profile, (0.0, top)]), 24)
