"""Parts of a device as manufactured: the wheel's pieces, metal supports and printed parts."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import compress
from math import copysign, sqrt

import numpy as np

from ocs_design.actuation.fasteners import Fastening
from ocs_design.device.device import Device
from ocs_design.parts.bell import fixture_part
from ocs_design.parts.cage import cage_part
from ocs_design.parts.carrier_plate import CarrierPlate, block_part, mast_part, plate_part
from ocs_design.parts.foot import foot_part
from ocs_design.parts.housing import guard_ring, housing_parts
from ocs_design.parts.pedestal import Pedestal, pedestal_part
from ocs_design.parts.solids import Part
from ocs_design.parts.wheel import Flywheel, wheel_parts

BLOCK = "block"
"""Name, in files and pictures, of the block shaped to the trunk."""


def wheel_pieces(flywheel: Flywheel) -> Mapping[str, Part]:
    """Pieces of the wheel by file name; a one-piece wheel is named flywheel."""
    pieces = wheel_parts(flywheel.shape)
    if len(pieces) == 1:
        return {"flywheel": pieces[0]}
    return {f"flywheel_{piece.name}": piece for piece in pieces}


def plate_pieces(device: Device) -> Mapping[str, Part]:
    """The plate under the feet, its mast and the mast's block, by file name."""
    plate = device.plate
    if plate is None:
        return {}
    if plate.mast is None:
        return {"plate": plate_part(plate)}
    # The plates on a mast's arms are alike, so one is enough.
    pieces = {"plate": plate_part(plate.single_plates[0]), "mast": mast_part(plate, plate.mast)}
    return pieces if plate.relief is None else {**pieces, BLOCK: block_part(plate, plate.relief)}


def ring_fixture(device: Device) -> Part | None:
    """Fixture that centres a ring on its bell while the glue sets; None without a bonded ring."""
    bell, wheel = device.mount.bell, device.flywheel
    return None if bell is None else fixture_part(bell, wheel.outer_radius, wheel.height)


def metal_pieces(device: Device) -> Mapping[str, Part]:
    """Plate under the feet, mast, block and guard ring by file name, if there are any."""
    if not device.guard_wall:
        return plate_pieces(device)
    return {**plate_pieces(device), "guard_ring": guard_ring(device.foot.housing)}


def foot_holes(device: Device) -> Mapping[str, tuple[tuple[float, float], ...]]:
    """Places of each foot's screws in B, x and y [m], by the name of its module.

    They are at 45 degrees to the lateral direction, on the wheel axis's side of it. Modules that
    are not upright have none.
    """
    offset, holes = device.foot.slot_radius / sqrt(2.0), {}
    stands = device.layout.stands(device.incidence)
    for module in compress(device.modules, stands):
        slope = copysign(1.0, float(module.axis[0] * module.axis[1]))
        x, y, _ = module.position.tolist()
        ends = offset, -offset
        holes[module.name] = tuple((x + slope * end, y + end) for end in ends)
    return holes


def trunk_holes(plate: CarrierPlate) -> list[tuple[float, float]]:
    """Places of the plate's screws in B [m]: x and y on top of the trunk, y and z on its back."""
    x, y = plate.position[:2] if plate.mast is None else plate.position[1:]
    return [(x + along, y + across) for along, across in plate.trunk]


def places(holes: Iterable[tuple[float, float]]) -> list[str]:
    """Coordinates of holes as text [mm]."""
    return [f"({1e3 * x:.1f}, {1e3 * y:.1f})" for x, y in holes]


@dataclass(frozen=True, eq=False)
class PedestalKind:
    """Pedestals of one shape; `name` is the name of their file."""

    name: str
    alike: tuple[Pedestal, ...]

    @property
    def part(self) -> Part:
        """One pedestal as printed and drilled."""
        return pedestal_part(self.alike[0])

    @property
    def screws(self) -> Fastening:
        """Screws that fasten one pedestal to the trunk."""
        return replace(self.alike[0].base_screws, piece=self.name)


def pedestal_kinds(device: Device) -> tuple[PedestalKind, ...]:
    """Pedestals grouped by shape."""
    kinds: dict[tuple[float, ...], tuple[Pedestal, ...]] = {}
    for pedestal in device.pedestals:
        figures = [pedestal.lean, pedestal.middle, pedestal.thickness, pedestal.base]
        shape = tuple(np.round(figures, 9).tolist())
        kinds[shape] = (*kinds.get(shape, ()), pedestal)
    if len(kinds) == 1:
        return (PedestalKind("pedestal", device.pedestals),)
    return tuple(PedestalKind(f"pedestal_{kind[0].module}", kind) for kind in kinds.values())


def printed_parts(device: Device) -> tuple[Part, ...]:
    """Drum, lid and foot of one wheel, and the cage of a back-mounted motor.

    They have the motor's holes if these are known and fit.
    """
    foot, cage = device.foot, device.mount.cage
    caged = () if cage is None else (cage_part(cage),)
    return (*housing_parts(foot.housing), foot_part(foot), *caged)


def printed_pieces(device: Device) -> Mapping[str, Part]:
    """Housing, foot and cage, pedestals, and the fixture of a bonded ring, by file name.

    Wheels alone get a housing but no cage.

    Raises:
        PartError: they cannot be made.
    """
    pieces = {f"housing_{part.name}": part for part in printed_parts(device)}
    pieces |= {kind.name: kind.part for kind in pedestal_kinds(device)}
    fixture = ring_fixture(device)
    return pieces if fixture is None else {**pieces, fixture.name: fixture}
