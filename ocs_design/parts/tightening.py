"""Tightening of a module's screws, and the torque that those of its motor hold."""

import math
from dataclasses import dataclass
from math import pi, sqrt

from ocs_design.actuation.fasteners import CLASSES, USUAL_CLASS, BoltedJoint, Fastening, Screw
from ocs_design.parts.foot import FootHold
from ocs_design.parts.joints import (
    FRICTION,
    TIGHTENING_FACTOR,
    joint_preload,
    tightening_torque,
)
from ocs_design.parts.motor_mount import MotorMount
from ocs_design.parts.printed import PETG, PRESSURE_SHARE, WASHER

STRIP_SHARE = 1.0 / 3.0
"""Preload of a screw in a print relative to the load that strips its thread: prints shear along
layers, and creep."""

ALUMINIUM_SHEAR = 207e6
"""Shear strength of 6061-T6 [Pa] (ASM), assumed for motor bells and trunks of unknown alloy."""

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


def dowel_force(held: Screw, through: float, into: float | None = None) -> float:
    """Shear that a screw carries as a dowel in a print, whose hole around it is filled [N].

    Johansen's mechanisms of a rigid, plastic dowel (EN 1995-1-1, section 8.2, without its factors
    for timber and without friction): the print presses on it with at most `PRESSURE_SHARE` of its
    yield strength, and it bends with its plastic moment, `f_y d^3 / 6`, of class 8.8.

    Args:
        held: the screw.
        through: length in the print under its head [m].
        into: length in the print behind that [m]; None: it is screwed into metal.
    """
    line = PRESSURE_SHARE * PETG.strength * held.diameter
    moment = CLASSES[USUAL_CLASS].yields * held.stressed_diameter**3 / 6.0
    if into is None:
        turned = sqrt(2.0 + 4.0 * moment / (line * through**2)) - 1.0
        return min(line * through * min(turned, 1.0), 2.0 * sqrt(moment * line))
    both = sqrt(3.0 * through**2 + 2.0 * through * into + 3.0 * into**2) - through - into
    hinged = (
        length / 3.0 * (sqrt(4.0 + 12.0 * moment / (line * length**2)) - 1.0)
        for length in (through, into)
    )
    rigid = min(through, into, both / 2.0, *hinged)
    return min(line * rigid, sqrt(2.0 * moment * line))


@dataclass(frozen=True)
class MotorGrip:
    """Hold of one ring of screws between motor and foot against the motor's torque.

    Attributes:
        fastening: the screws.
        radius: of their circle [m].
    """

    fastening: Fastening
    radius: float

    @property
    def friction(self) -> float:
        """Torque held by friction at their least preload [N m]."""
        least = tightened(self.fastening).preload / TIGHTENING_FACTOR
        return FRICTION * self.fastening.count * least * self.radius

    @property
    def filled(self) -> float:
        """Torque held by the screws as dowels, with epoxy around them in their holes [N m]."""
        held = self.fastening
        into = held.engagement if held.joint.in_print else None
        force = dowel_force(held.screw, held.thickness, into)
        return held.count * force * self.radius

    @property
    def play(self) -> float:
        """Angle by which the motor turns in the play of unfilled holes, back and forth [rad]."""
        screw = self.fastening.screw
        return (screw.clearance_hole - screw.diameter) / self.radius


def motor_grips(mount: MotorMount) -> tuple[MotorGrip, ...]:
    """Rings of screws through which a motor's torque goes to its foot."""
    return tuple(
        MotorGrip(ring.fastening, ring.circle.radius)
        for ring in mount.screwed
        if ring.fastening.joint is not BoltedJoint.WHEEL
    )
