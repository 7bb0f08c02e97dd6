"""Data of a device for its builder: pieces, and screws with their torques.

`booklet` turns them into the rows and chapters of the PDF and the report's section.
"""

import math
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from math import pi, sqrt

from ocs_design.actuation.fasteners import CLASSES, IN_PLASTIC, Fastening
from ocs_design.common.units import significant
from ocs_design.device.joints import burst_of, foot_hold
from ocs_design.device.solids import motor_mount
from ocs_design.export.assembly.placed import Piece, bonding_pieces, holds_wheel, module_pieces
from ocs_design.export.device_parts import places, trunk_holes
from ocs_design.export.formats import Documented, Subject
from ocs_design.parts.foot import FootHold
from ocs_design.parts.guard import Containment
from ocs_design.parts.joints import joint_preload, tightening_torque
from ocs_design.parts.printed import PETG, PRESSURE_SHARE, WASHER

STRIP_SHARE = 1.0 / 3.0
"""Preload of a screw in a print relative to the load that strips its thread: prints shear along
layers, and creep."""

ALUMINIUM_SHEAR = 207e6
"""Shear strength of 6061-T6 [Pa] (ASM), assumed for motor bells and trunks of unknown alloy."""

LEAST_DRILL = 0.8e-3
"""Hole diameter below which steel is ground instead of drilled [m]."""

THREAD_SHARE = 0.5
"""Preload of a screw in aluminium relative to the load that strips its thread."""


@dataclass(frozen=True)
class Tightened:
    """Screws with their tightening torque.

    Attributes:
        fastening: the screws.
        torque: tightening torque [N m].
        rule: limit that sets the torque.
        engagement: minimum length of engaged thread [m].
        on_print: whether the screws go through a print and their heads press on it.
        washers: whether there is a washer under each head.
    """

    fastening: Fastening
    torque: float
    rule: str
    engagement: float
    on_print: bool = False
    washers: bool = False

    @property
    def with_washers(self) -> str:
        """Words on the washers under the heads; empty if there are none."""
        return f", a washer {WASHER} under each head" if self.washers else ""


def tightened(
    fastening: Fastening,
    *,
    on_metal: bool,
    head_on_print: bool = True,
    on_slot: FootHold | None = None,
    deepest: float = math.inf,
) -> Tightened:
    """Screws with their tightening torque; for the wheel's metal joints, that of the joint model.

    For other screws, of class 8.8, the preload is the smallest of: 90 % of the screw's yield
    strength (VDI 2230); half of the force that shears off a thread in aluminium, or a third of it
    in a print, on half of the thread's cylinder; under a head on a print, the force that presses on
    it with half its yield strength; and on a foot's slots that of `on_slot`, where the fastening
    includes any washers. A print's shear strength is its tensile strength over sqrt(3). No thread
    is deeper than `deepest` [m].
    """
    screw = fastening.screw
    engagement = min(fastening.engagement, deepest)
    washers = on_slot is not None and on_slot.washers
    sheared = pi * screw.diameter * engagement / 2.0
    if on_metal:
        strength = fastening.strength
        held = min(1.0, engagement / (CLASSES[strength].depth * screw.diameter))
        share = held * joint_preload(screw, strength) / (sheared * ALUMINIUM_SHEAR)
        rule = f"the joint, as computed; {share:.0%} of the load that strips a thread in 6061-T6"
        return Tightened(fastening, held * tightening_torque(screw, strength), rule, engagement)
    limits = [(screw.preload, "class 8.8 at 90 % of yield (VDI 2230, friction 0.12)")]
    if head_on_print:
        pressed = PRESSURE_SHARE * PETG.strength * screw.head_area
        where = "head on PETG"
        if on_slot is not None:
            pressed = on_slot.preload
            where = f"{'washer' if washers else 'head'} beside a slot in PETG"
        limits.append((pressed, f"{where} at half its yield strength"))
    if fastening.depth >= IN_PLASTIC:
        stripped = STRIP_SHARE * sheared * PETG.strength / sqrt(3.0)
        limits.append((stripped, "thread in PETG at a third of the load that strips it"))
    else:
        stripped = THREAD_SHARE * sheared * ALUMINIUM_SHEAR
        limits.append((stripped, "thread in aluminium at half the load that strips it"))
    preload, rule = min(limits)
    return Tightened(fastening, screw.torque(preload), rule, engagement, head_on_print, washers)


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
    def numbers(self) -> dict[str, int]:
        """Numbers of the pieces by their names, the fixture's last."""
        names = dict.fromkeys(piece.name for piece in (*self.pieces, *self.bonding))
        return {name: number for number, name in enumerate(names, start=1)}

    @cached_property
    def screws(self) -> dict[str, Tightened]:
        """Screws by their purpose."""
        on_wheel = {
            each.fastening.purpose for each in motor_mount(self.device).screwed if holds_wheel(each)
        }
        return {
            piece.name: tightened(
                piece.fastening,
                on_metal=piece.name in on_wheel,
                head_on_print=not piece.shared,
                on_slot=foot_hold(self.device) if piece.name.startswith("foot on") else None,
                deepest=self.device.plate.thickness
                if self.device.plate is not None and piece.name.startswith("foot on plate")
                else math.inf,
            )
            for piece in self.pieces
            if piece.fastening is not None
        }

    @cached_property
    def top_speed(self) -> float | None:
        """Top speed of the wheel with its motor, voltage and gear [rad/s]; None: not limited."""
        speed = self.device.motor.top_speed
        return speed if math.isfinite(speed) else None

    @cached_property
    def burst(self) -> Containment | None:
        """Containment of a wheel that bursts at top speed; None if the speed is not known."""
        return None if self.top_speed is None else burst_of(self.device)

    def number(self, name: str) -> str:
        """Reference to a piece's number in the pictures; empty if it has none."""
        number = self.numbers.get(name)
        return "" if number is None else f" ({number})"

    @property
    def late(self) -> tuple[str, ...]:
        """Screws that are tightened after balancing: those of lid and trunk."""
        return tuple(
            name
            for name in self.screws
            if name.startswith(("lid", "foot on", "plate on", "mast on", "pedestal"))
        )

    def screwed(self, name: str) -> str:
        """Step that tightens a set of equal screws."""
        found = self.screws[name]
        held = found.fastening
        joint = "Lid on drum" if name.startswith("lid") else short(name).capitalize()
        lock = "no threadlocker"
        if held.depth < IN_PLASTIC:
            lock = "medium-strength threadlocker"
            if found.on_print:
                lock += ", a drop on the tips only, because it attacks the print"
        plate, where = self.device.plate, ""
        fastenings = () if plate is None else plate.fastenings
        # Places of these screws on the trunk [mm] if their lengths differ.
        if (
            plate is not None
            and len(fastenings) > 1
            and name in {each.purpose for each in fastenings}
        ):
            own = zip(places(trunk_holes(plate)), plate.screw_lengths, strict=True)
            where = f"; those at {', '.join(at for at, length in own if length == held.length)}"
        return (
            f"{joint}: {held.count} x {held.designation}{self.number(name)}{found.with_washers}, "
            f"{significant(found.torque, 2)} N m, crosswise in two rounds; {lock}{where}."
        )


@lru_cache(maxsize=1)
def assembly_of(subject: Subject) -> Assembly:
    """Assembly of the subject's device, for the booklet and for the report."""
    own = {each.name: getattr(subject, each.name) for each in fields(Assembly)}
    return Assembly(**own)


def short(purpose: str) -> str:
    """Purpose of screws without its notes."""
    return purpose.split(";", maxsplit=1)[0].split(", ", maxsplit=1)[0]
