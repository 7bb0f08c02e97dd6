"""Data of a device for its builder: pieces, and screws with their torques.

`booklet` turns them into the rows and chapters of the PDF and the report's section.
"""

import math
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from math import pi, sqrt

from ocs_design.actuation.fasteners import CLASSES, BoltedJoint, Fastening
from ocs_design.common.units import significant
from ocs_design.device.device import Device
from ocs_design.device.joints import balance_of, burst_of
from ocs_design.export.assembly.placed import Piece, bonding_pieces, module_pieces
from ocs_design.export.device_parts import places, trunk_holes
from ocs_design.export.formats import Documented, Subject
from ocs_design.parts.foot import FootHold
from ocs_design.parts.guard import Containment
from ocs_design.parts.joints import FRICTION, TIGHTENING_FACTOR, joint_preload, tightening_torque
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
        preload: of each screw [N].
        torque: tightening torque [N m].
        rule: limit that sets the torque.
        engagement: minimum length of engaged thread [m].
        washers: whether there is a washer under each head.
    """

    fastening: Fastening
    preload: float
    torque: float
    rule: str
    engagement: float
    washers: bool = False

    @property
    def with_washers(self) -> str:
        """Words on the washers under the heads; empty if there are none."""
        return f", a washer {WASHER} under each head" if self.washers else ""


def tightened(
    fastening: Fastening, *, on_slot: FootHold | None = None, deepest: float = math.inf
) -> Tightened:
    """Screws with their tightening torque; for the wheel's metal joint, that of the joint model.

    For other screws, of class 8.8, the preload is the smallest of: 90 % of the screw's yield
    strength (VDI 2230); half of the force that shears off a thread in aluminium, or a third of it
    in a print, on half of the thread's cylinder; under a head on a print, the force that presses on
    it with half its yield strength; and on a foot's slots that of `on_slot`, where the fastening
    includes any washers. A print's shear strength is its tensile strength over sqrt(3). No thread
    is deeper than `deepest` [m].
    """
    screw, joint = fastening.screw, fastening.joint
    engagement = min(fastening.engagement, deepest)
    washers = on_slot is not None and on_slot.washers
    sheared = pi * screw.diameter * engagement / 2.0
    if joint is BoltedJoint.WHEEL:
        strength = fastening.strength
        filled = min(1.0, engagement / (CLASSES[strength].depth * screw.diameter))
        preload, torque = (
            filled * full(screw, strength) for full in (joint_preload, tightening_torque)
        )
        share = preload / (sheared * ALUMINIUM_SHEAR)
        rule = f"the joint, as computed; {share:.0%} of the load that strips a thread in 6061-T6"
        return Tightened(fastening, preload, torque, rule, engagement)
    limits = [(screw.preload, "class 8.8 at 90 % of yield (VDI 2230, friction 0.12)")]
    if joint.on_print:
        pressed, where = PRESSURE_SHARE * PETG.strength * screw.head_area, "head on PETG"
        if on_slot is not None:
            pressed = on_slot.preload
            where = f"{'washer' if washers else 'head'} beside a slot in PETG"
        limits.append((pressed, f"{where} at half its yield strength"))
    if joint.in_print:
        stripped = STRIP_SHARE * sheared * PETG.strength / sqrt(3.0)
        limits.append((stripped, "thread in PETG at a third of the load that strips it"))
    else:
        stripped = THREAD_SHARE * sheared * ALUMINIUM_SHEAR
        limits.append((stripped, "thread in aluminium at half the load that strips it"))
    preload, rule = min(limits)
    return Tightened(fastening, preload, screw.torque(preload), rule, engagement, washers)


@dataclass(frozen=True)
class Slipping:
    """Screws of a motor's mount whose friction does not hold its torque.

    Attributes:
        fastening: the screws.
        held: torque that they hold at their least preload [N m].
        play: angle by which the motor turns in the play of their holes, back and forth [rad].
    """

    fastening: Fastening
    held: float
    play: float


def slipping(device: Device) -> tuple[Slipping, ...]:
    """Screws of the motor's mount that slip under its torque."""
    slipping_screws = []
    for ring in device.mount.screwed:
        fastening, radius = ring.fastening, ring.circle.radius
        if fastening.joint is BoltedJoint.WHEEL:
            continue
        least = tightened(fastening).preload / TIGHTENING_FACTOR
        friction_torque = FRICTION * fastening.count * least * radius
        if friction_torque < (device.motor.torque_limit or 0.0):
            play = fastening.screw.clearance_hole - fastening.screw.diameter
            slipping_screws.append(Slipping(fastening, friction_torque, play / radius))
    return tuple(slipping_screws)


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
