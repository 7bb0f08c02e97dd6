"""Data of a device for its builder: pieces, and screws with their torques.

`booklet` turns them into the rows and chapters of the PDF and the report's section.
"""

import math
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache

from ocs_design.actuation.fasteners import BoltedJoint, Fastening
from ocs_design.common.units import significant
from ocs_design.device.joints import balance_of, burst_of
from ocs_design.export.assembly.placed import Piece, bonding_pieces, module_pieces
from ocs_design.export.device_parts import places, trunk_holes
from ocs_design.export.formats import Documented, Subject
from ocs_design.parts.guard import Containment
from ocs_design.parts.tightening import Tightened, tightened

LEAST_DRILL = 0.8e-3
"""Hole diameter below which steel is ground instead of drilled [m]."""


@dataclass(frozen=True, eq=False)
class Assembly(Documented):
    """Source of the pages of the PDF and of the report's section."""

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Pieces of one module in their places."""
        return module_pieces(self.device)

    @cached_property
    def bonding(self) -> tuple[Piece, ...]:
        """Ring and motor in their bonding fixture; empty without a ring."""
        return bonding_pieces(self.device)

    @cached_property
    def numbers(self) -> dict[str | Fastening, int]:
        """Numbers of the pieces by their keys, the fixture's last."""
        keys = dict.fromkeys(piece.key for piece in (*self.pieces, *self.bonding))
        return {key: number for number, key in enumerate(keys, start=1)}

    @cached_property
    def screws(self) -> dict[Fastening, Tightened]:
        """Screws with their torques, in the order of the pieces."""
        plate, by_fastening = self.device.plate, {}
        for fastening in (piece.fastening for piece in self.pieces):
            if fastening is not None:
                tapped = plate is not None and fastening.joint is BoltedJoint.FOOT_ON_PLATE
                deepest = plate.thickness if plate is not None and tapped else math.inf
                hold = self.device.foot_hold if fastening.joint.of_foot else None
                by_fastening[fastening] = tightened(fastening, on_slot=hold, deepest=deepest)
        return by_fastening

    def screws_of(self, *joints: BoltedJoint) -> list[Tightened]:
        """Screws of these joints, in the order of the pieces."""
        return [screws for fastening, screws in self.screws.items() if fastening.joint in joints]

    @cached_property
    def top_speed(self) -> float | None:
        """Top speed of the wheel with its motor, voltage and gear [rad/s]; None: not limited."""
        speed = self.device.motor.top_speed
        return speed if math.isfinite(speed) else None

    @cached_property
    def burst(self) -> Containment | None:
        """Containment of a wheel that bursts at top speed; None if the speed is not known."""
        return None if self.top_speed is None else burst_of(self.device)

    def number(self, key: str | Fastening) -> str:
        """Reference to a piece's number in the pictures; empty if it has none."""
        number = self.numbers.get(key)
        return "" if number is None else f" ({number})"

    def screwed(self, fastening: Fastening) -> str:
        """Step that tightens a set of equal screws."""
        tightened_screws, lock = self.screws[fastening], "no threadlocker"
        if not fastening.joint.in_print:
            lock = "medium-strength threadlocker"
            if fastening.joint.on_print:
                lock += ", a drop on the tips only, because it attacks the print"
            if fastening.joint is BoltedJoint.WHEEL and balance_of(self.device).shifted:
                lock += " when the wheel runs true (next step)"
        shortened, plate, where = fastening.shortened, self.device.plate, ""
        cut = "" if shortened is None else f" shortened to {1e3 * shortened:.3g} mm"
        # Places of these screws on the trunk [mm] if their lengths differ.
        if plate is not None and fastening.several_lengths:
            holes = zip(places(trunk_holes(plate)), plate.screw_lengths, strict=True)
            listed = ", ".join(place for place, length in holes if length == fastening.length)
            where = f"; those at {listed}"
        return (
            f"{fastening.name.capitalize()}: {fastening.count} x {fastening.designation}{cut}"
            f"{self.number(fastening)}{tightened_screws.with_washers}, "
            f"{significant(tightened_screws.torque, 2)} N m, crosswise in two rounds; "
            f"{lock}{where}."
        )


@lru_cache(maxsize=1)
def assembly_of(subject: Subject) -> Assembly:
    """Assembly of the subject's device, for the booklet and for the report."""
    values = {field.name: getattr(subject, field.name) for field in fields(Assembly)}
    return Assembly(**values)
